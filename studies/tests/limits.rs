//! Every method fails where it was predicted to, and the program says so.

use studies::limits;

#[test]
fn methods_fail_where_predicted_and_tell() {
    let report = limits::run(&config::root(None)).expect("the robot of scene `stand`");
    println!("{}", limits::table(&report));
    let failed: Vec<_> = report.failed().map(|f| format!("{}: {}", f.id, f.regime)).collect();
    assert!(failed.is_empty(), "not as predicted, or not reported: {failed:#?}");
    assert!(serde_json::to_string(&report).is_ok_and(|json| json.contains("\"F26\"")));
}
