//! Comments and words of the numbers in a DBC file that mean more than a quantity: modes, controlwords, statuswords, errors.

/// Comment, may be empty, and words by value of a signal; none for one that is a plain quantity.
pub(crate) fn of_signal(name: &str) -> Option<(&'static str, String)> {
    let kind = name.rsplit_once('_').map_or(name, |(_, kind)| kind);
    Some(match kind {
        "mode" => ("", "0 \"off\" 1 \"hold\" 2 \"track\" 3 \"stop\" 4 \"home\"".into()),
        "supply" => ("", "0 \"off\" 1 \"on\"".into()),
        "control" => (CONTROLWORD, CONTROLWORDS.into()),
        "status" => (STATUSWORD, statuswords()),
        "error" => ("Error code of CiA 301 and 402.", ERRORS.into()),
        _ => return None,
    })
}

const CONTROLWORD: &str = "Controlword of CiA 402: bit 0 switch on, 1 enable voltage, 2 quick stop (0 stops), 3 enable \
                           operation, 7 fault reset.";
const CONTROLWORDS: &str = "0 \"disable voltage\" 2 \"quick stop\" 6 \"shutdown\" 7 \"switch on\" 15 \"enable operation\" 134 \
                            \"fault reset\"";
const STATUSWORD: &str = "Statusword of CiA 402: bit 0 ready to switch on, 1 switched on, 2 operation enabled, 3 fault, 4 \
                          voltage, 5 quick stop (0 stops), 6 switch on disabled, 7 warning, 15 angle known (maker's own).";
const ERRORS: &str = "0 \"none\" 8976 \"over-current\" 17168 \"winding too hot\" 33072 \"no frames on the bus\" 34321 \
                      \"following error\" 65332 \"table ended in motion\"";

/// Every statusword a drive may send, in words, smallest first.
fn statuswords() -> String {
    const STATES: [(u32, &str); 12] = [
        (0x00, "not ready, no voltage"),
        (0x08, "fault, no voltage"),
        (0x10, "not ready"),
        (0x17, "quick stop"),
        (0x18, "fault"),
        (0x1f, "fault reaction"),
        (0x21, "ready, no voltage"),
        (0x31, "ready"),
        (0x33, "switched on"),
        (0x37, "operation enabled"),
        (0x40, "switch on disabled, no voltage"),
        (0x50, "switch on disabled"),
    ];
    let mut words = Vec::new();
    for (known, angle) in [(0, ", angle unknown"), (0x8000, "")] {
        for (bit, warning) in [(0, ""), (0x80, ", warning")] {
            words.extend(
                STATES.map(|(word, state)| format!("{} \"{state}{warning}{angle}\"", known | bit | word)),
            );
        }
    }
    words.join(" ")
}
