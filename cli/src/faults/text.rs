//! The table for people.

use super::{Row, Verdict};

/// One line of a terminal.
pub fn line(row: &Row) -> String {
    let mark = match row.verdict {
        Verdict::Met => "met    ",
        Verdict::NotMet => "NOT MET",
        Verdict::NotApplicable => "n/a    ",
    };
    let mut text =
        format!("{mark} {:4} {} → {} → {} → {}", row.fault, row.name, row.expected, observed(row), time(row));
    for why in &row.repeated {
        text += &format!("\n             done again: {why}");
    }
    text
}

/// Observed behaviour, and what is missing of the expected.
fn observed(row: &Row) -> String {
    if row.unmet.is_empty() {
        row.observed.clone()
    } else {
        format!("{}; not: {}", row.observed, row.unmet.join("; "))
    }
}

fn time(row: &Row) -> String {
    match (row.cycles, row.ms) {
        (Some(cycles), Some(ms)) => format!("{cycles} cycles, {ms:.0} ms"),
        (None, Some(ms)) => format!("{ms:.0} ms"),
        _ => "-".into(),
    }
}

/// The table in Markdown, as docs/safety.md holds it.
pub fn markdown(rows: &[Row]) -> String {
    let mut text = String::from("| | fault | expected | observed | time | |\n|---|---|---|---|---|---|\n");
    for row in rows {
        let verdict = match row.verdict {
            Verdict::Met => "met",
            Verdict::NotMet => "**not met**",
            Verdict::NotApplicable => "not tried",
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
