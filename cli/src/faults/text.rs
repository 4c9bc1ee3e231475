//! The table for people.

use super::{FaultRow, FaultVerdict};

/// One line of a terminal.
pub fn line(row: &FaultRow) -> String {
    let mark = match row.verdict {
        FaultVerdict::Met => "met    ",
        FaultVerdict::NotMet => "NOT MET",
        FaultVerdict::NotApplicable => "n/a    ",
    };
    let mut text =
        format!("{mark} {:4} {} → {} → {} → {}", row.fault, row.name, row.expected, observed(row), time(row));
    for why in &row.repeated {
        text += &format!("\n             done again: {why}");
    }
    text
}

/// Observed behaviour, and what is missing of the expected.
fn observed(row: &FaultRow) -> String {
    if row.unmet.is_empty() {
        row.observed.clone()
    } else {
        format!("{}; not: {}", row.observed, row.unmet.join("; "))
    }
}

fn time(row: &FaultRow) -> String {
    match (row.cycles, row.ms) {
        (Some(cycles), Some(ms)) => format!("{cycles} cycles, {ms:.0} ms"),
        (None, Some(ms)) => format!("{ms:.0} ms"),
        _ => "-".into(),
    }
}

/// The table in Markdown, as docs/safety.md holds it.
pub fn markdown(rows: &[FaultRow]) -> String {
    let mut text = String::from("| | fault | expected | observed | time | |\n|---|---|---|---|---|---|\n");
    for row in rows {
        let verdict = match row.verdict {
            FaultVerdict::Met => "met",
            FaultVerdict::NotMet => "**not met**",
            FaultVerdict::NotApplicable => "not tried",
        };
        let again = if row.repeated.is_empty() {
            String::new()
        } else {
            format!(", in run {}", row.repeated.len() + 1)
        };
        text += &format!(
            "| {} | {} | {} | {} | {} | {verdict}{again} |\n",
            row.fault,
            row.name,
            row.expected,
            observed(row).replace(['\n', '|'], " "),
            time(row)
        );
    }
    text
}
