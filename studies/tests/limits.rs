//! Every method fails where it was predicted to, and the program says so.

use studies::limits::{self, Finding, LimitRule};

#[test]
fn methods_fail_where_predicted_and_tell() {
    let findings = limits::run(&config::root(None)).expect("the robot of scene `stand`");
    let sheet = limits::sheet(&findings);
    println!("{}", sheet.text());
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/limits.md"))
        .unwrap_or_default();
    let wrong: Vec<_> = findings.iter().filter_map(|f| not_on_page(&page, f)).collect();
    assert!(wrong.is_empty(), "docs/limits.md: make its table anew: {wrong:#?}");
    let failed: Vec<_> =
        findings.iter().filter(|f| !f.ok()).map(|f| format!("{}: {}", f.id, f.regime)).collect();
    assert!(failed.is_empty(), "not as predicted, or not reported: {failed:#?}");
    assert!(sheet.json().to_string().contains("\"F26\""));
    let loose: Vec<_> = findings.iter().filter(|f| is_loose(f, &findings)).map(|f| &f.regime).collect();
    assert!(loose.is_empty(), "bounds that are more than ten times what is measured: {loose:#?}");
}

/// A bound that hides more than ten times what is measured: of a relative one, in any row of its kind. Two thousandths are what
/// bisections and rounding may leave.
fn is_loose(f: &Finding, all: &[Finding]) -> bool {
    match f.rule {
        LimitRule::Within(most) => {
            let kind = all.iter().filter(|g| g.id == f.id && g.rule == f.rule);
            most > 2e-3 && most > 10.0 * kind.map(|g| g.deviation().abs()).fold(0.0, f64::max)
        }
        LimitRule::AtMost => f.predicted > 0.0 && f.measured < 0.1 * f.predicted,
        LimitRule::AtLeast => false,
    }
}

/// Difference of the page from a finding, if any: no row, or numbers off by more than a thousandth, those of rounding errors by
/// more than ten times.
fn not_on_page(page: &str, f: &Finding) -> Option<String> {
    let regime = f.regime.replace('|', "\\|");
    let Some(row) = page.lines().find(|line| line.contains(&format!("| {regime} |"))) else {
        return Some(format!("no row: {regime}"));
    };
    let row = row.replace("\\|", "");
    let cells: Vec<&str> = row.split('|').map(str::trim).collect();
    let meets = |cell: &str, number: f64| {
        let written: f64 = cell.parse().unwrap_or(f64::NAN);
        let most = if number.abs() < 1e-7 { 9.0 * number.abs() + 1e-12 } else { 1e-3 * number.abs() + 1e-6 };
        (written - number).abs() <= most || written == number
    };
    let [predicted, measured] = [cells[3], cells[4]];
    (!meets(predicted, f.predicted) || !meets(measured, f.measured)).then(|| {
        format!("{regime}: {predicted}, {measured} on the page, {}, {} found", f.predicted, f.measured)
    })
}
