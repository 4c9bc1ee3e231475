//! Every method fails where it was predicted to, and the program says so.

use studies::limits;

#[test]
fn methods_fail_where_predicted_and_tell() {
    let findings = limits::run(&config::root(None)).expect("the robot of scene `stand`");
    let sheet = limits::sheet(&findings);
    println!("{}", sheet.text());
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/limits.md"))
        .unwrap_or_default();
    let missing =
        findings.iter().filter(|f| !page.contains(&f.regime.replace('|', "\\|"))).map(|f| &f.regime);
    assert_eq!(
        missing.collect::<Vec<_>>(),
        Vec::<&String>::new(),
        "docs/limits.md lacks rows; make its table anew"
    );
    let failed: Vec<_> =
        findings.iter().filter(|f| !f.ok()).map(|f| format!("{}: {}", f.id, f.regime)).collect();
    assert!(failed.is_empty(), "not as predicted, or not reported: {failed:#?}");
    assert!(sheet.json().to_string().contains("\"F26\""));
}
