//! Events as sentences: what happened, to what, and what to do next.

use crate::command::Domain;
use crate::command_text::{COMMANDS, CommandInfo};
use crate::event::EventCode;
use crate::event_detail::Detail;

/// Names of what the details of events count: those of the robot, as far as they are known.
#[derive(Clone, Debug, Default)]
pub struct Words {
    /// Joints, in the order of the robot's table.
    pub joints: Vec<String>,
    /// Nodes of the field bus.
    pub nodes: Vec<String>,
    /// Text of a drive's error code; empty if it has none.
    pub fault: Option<fn(u16) -> &'static str>,
}

impl Words {
    /// The sentence of an event: `motor supply off: emergency stop; make the robot safe; ...`.
    pub fn sentence(&self, code: u64, detail: u64) -> String {
        let Some(event) = EventCode::from_number(code) else {
            return format!("event {code} with detail {detail}, which this version does not know");
        };
        let [what, says, advice] = event.words();
        let detail = event.detail(detail);
        let inner = if let Detail::Cause(inner) = detail { Some(inner) } else { None };
        let unknown = inner == Some(EventCode::None);
        // What caused it says first what to do, and perhaps all of it.
        let first = inner.map_or("", |inner| inner.words()[2]);
        let then = if first.contains("system/reset") { "" } else { advice };
        let mut text = what.to_owned();
        if !says.is_empty() && !unknown {
            text += &format!(": {}", self.detail(says, detail));
        }
        [first, then]
            .iter()
            .filter(|advice| !advice.is_empty())
            .for_each(|advice| text += &format!("; {advice}"));
        text
    }

    /// Detail in words, by the place in braces.
    fn detail(&self, says: &str, detail: Detail) -> String {
        let named = |names: &[String], kind: &str, i: usize| {
            names.get(i).cloned().unwrap_or_else(|| format!("{kind} {i}"))
        };
        let joint = |i| named(&self.joints, "joint", i);
        let node = |i| named(&self.nodes, "node", i);
        let value = match detail {
            Detail::NodeCycles(i, cycles) => {
                return says.replace("{node}", &node(i)).replace("{cycles}", &cycles.to_string());
            }
            Detail::Cause(event) => event.words()[0].to_owned(),
            Detail::Joint(i) => joint(i),
            Detail::Node(i) => node(i),
            Detail::Message(id) if says == "{walk}" => command(Domain::Walk, id),
            Detail::Message(id) => command(Domain::Head, id),
            Detail::Caller { user, process } => format!("asked for by pid {process} of user {user}"),
            Detail::Limit(limit) => limit.text().into(),
            Detail::Frame(why) => why.text().into(),
            Detail::Stations(before, behind) => {
                let name = |i| if i == 0 { "the master".to_owned() } else { format!("station {i}") };
                format!("between {} and {}", name(before), name(behind))
            }
            Detail::Drive { joint: j, error } => {
                let text = self.fault.map_or("", |fault| fault(error));
                format!("{}: error {error:#06x} {text}", joint(j)).trim_end().to_owned()
            }
            Detail::Table { joint: j, point: 0, fault } => format!("{}: {}", joint(j), fault.text()),
            Detail::Table { joint: j, point, fault } => {
                format!("{}, from point {point} on: {}", joint(j), fault.text())
            }
            Detail::Steps { length, side, turn, duration } => {
                let m = |mm: i16| f64::from(mm) * 1e-3;
                format!(
                    "{} m forward, {} m to the left, {} rad to the left in {} s",
                    m(length),
                    m(side),
                    m(turn),
                    f64::from(duration) * 1e-3
                )
            }
            // A number that its kind does not have: of a later version.
            Detail::Number(n) if !says.contains("{n}") => {
                format!("for reason {n}, which this version does not know")
            }
            other => other.pack().to_string(),
        };
        match (says.find('{'), says.find('}')) {
            (Some(begin), Some(end)) => format!("{}{value}{}", &says[..begin], &says[end + 1..]),
            _ => says.to_owned(),
        }
    }
}

/// Name of a command.
fn command(domain: Domain, id: u64) -> String {
    let address = |info: &CommandInfo| info.example().address();
    let found = COMMANDS.iter().find(|info| address(info).0 == domain && u64::from(address(info).1) == id);
    found.map_or_else(|| format!("message {id}"), |info| info.name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words() -> Words {
        let names = |list: &[&str]| list.iter().map(|&name| name.to_owned()).collect();
        Words {
            joints: names(&["hip", "knee"]),
            nodes: names(&["torso", "shank"]),
            fault: Some(|_| "too hot"),
        }
    }

    /// `ControlLimited (3)` and `PowerOff (ResetMissed)` told nobody what to do.
    #[test]
    fn an_event_is_a_sentence_with_what_to_do() {
        let said = |code: EventCode, detail| words().sentence(code as u64, detail);
        assert_eq!(
            said(EventCode::ControlLimited, 3),
            "the stabilizer meets a limit: speed, acceleration or range of a joint; once in a while is normal; walk slower if it goes on"
        );
        // A cause is told with its own advice first, and no advice twice.
        let off = said(EventCode::PowerOff, EventCode::ResetMissed as u64);
        assert!(
            off.starts_with(
                "motor supply off: the joint loop was too late for the watchdog; `gangwerk doctor`"
            ),
            "{off}"
        );
        assert!(off.ends_with("; system/reset, then system/enable switch it on again"), "{off}");
        let stop = said(EventCode::PowerOff, EventCode::EmergencyStop as u64);
        assert_eq!(stop.matches("system/reset").count(), 1, "{stop}");
        let stop = said(EventCode::SafeStop, 0);
        assert!(stop.starts_with("controlled stop; secure the robot"), "{stop}");
        let steps = Detail::Steps { length: -120, side: 35, turn: -7, duration: 900 };
        let shortened = said(EventCode::CommandShortened, steps.pack());
        let now = "now -0.12 m forward, 0.035 m to the left, -0.007 rad to the left in 0.9 s";
        assert!(shortened.contains(now), "{shortened}");
        // Details by the names of the robot's parts.
        assert!(said(EventCode::FollowingError, 1).contains("target: knee;"));
        assert!(
            said(EventCode::DriveTripped, 1 | 0x4210 << 16).contains("a fault: knee: error 0x4210 too hot;")
        );
        assert!(said(EventCode::NodeBack, 1012).ends_with(": shank, after 12 cycles"));
        assert!(said(EventCode::FramesLost, 0).contains("bus: torso;"));
        assert!(said(EventCode::FrameRefused, 2).ends_with(": came a second time"));
        assert!(said(EventCode::RingBroken, 3).contains("between the master and station 3"));
        assert!(said(EventCode::EmergencyStop, 1000 << 32 | 77).contains("asked for by pid 77 of user 1000"));
        assert_eq!(words().sentence(9999, 1), "event 9999 with detail 1, which this version does not know");
    }

    /// Every code, with any detail and with nothing known of the robot.
    #[test]
    fn every_code_has_words_and_no_brace_is_left() {
        for words in [words(), Words::default()] {
            for code in EventCode::ALL {
                for detail in [0, 1, 7, 66, 1999, 0xFFFF_FFFF, u64::MAX] {
                    let text = words.sentence(code as u64, detail);
                    assert!(text.len() > 4 && !text.contains(['{', '}']), "{code:?}: {text}");
                    assert!(!text.contains(&format!("{code:?}")), "a name of the program in: {text}");
                }
            }
        }
    }

    #[test]
    fn numbers_of_codes_are_their_places() {
        assert!(EventCode::ALL.iter().enumerate().all(|(i, code)| *code as usize == i));
    }
}
