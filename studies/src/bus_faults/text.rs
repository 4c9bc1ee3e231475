//! The tables for people, in Markdown: docs/bus_faults.md holds them.

use super::{End, Report, Row};

/// The report as two tables.
pub fn table(r: &Report) -> String {
    let mut text = format!(
        "Faults of the bus while Lola walks 2 km/h, bus cycle {} ms, begun at {} instants of a stride; the latest of all.\n\n\
         | fault | noticed | stop or power off | joints at rest after that | supply off | log | end | upright |\n\
         |---|---|---|---|---|---|---|---|",
        r.cycle_s * 1e3,
        r.instants
    );
    for row in &r.rows {
        text += &line(row, r.instants);
    }
    text += "\n\n| burst, all frames of | 1 line of a knee: walks on | upright | all lines: walks on | upright |\n\
             |---|---|---|---|---|";
    for b in &r.bursts {
        let of = |n: usize| format!("{n}/{}", r.instants);
        text += &format!(
            "\n| {} cycles | {} | {} | {} | {} |",
            b.cycles,
            of(b.walked_on[1]),
            of(b.upright[1]),
            of(b.walked_on[0]),
            of(b.upright[0])
        );
    }
    text
}

fn line(row: &Row, instants: usize) -> String {
    let cycles = |n: Option<u64>| n.map_or("-".into(), |n| n.to_string());
    let end = match row.end {
        End::Walks => "walks on",
        End::Stands => "stopped, stands",
        End::FellBraked => "falls with its joints braked",
        End::Fell => "falls",
    };
    let unmet = if row.unmet.is_empty() { String::new() } else { format!(" **not met: {}**", row.unmet) };
    format!(
        "\n| {} | {} | {} | {} | {} | {} | {end}{unmet} | {}/{instants} |",
        row.fault,
        cycles(row.noticed_cycles),
        cycles(row.reacted_cycles),
        cycles(row.at_rest_cycles),
        cycles(row.power_off_cycles),
        row.log.join(", "),
        row.upright,
    )
}
