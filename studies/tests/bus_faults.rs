//! Whatever happens to the bus while Lola walks: it is noticed and named in time, and the robot walks on or comes to rest.

use studies::bus_faults::{self, End};

/// Two instants of a stride: the page is made with more, `gangwerk study bus-faults`.
const INSTANTS: usize = 2;

#[test]
fn faults_are_named_and_answered_in_time() {
    let report = bus_faults::run(&config::root(None), INSTANTS).expect("the robot of scene `walk_2kmh`");
    println!("{}", bus_faults::table(&report));
    let failed: Vec<_> = report.failed().map(|row| format!("{}: {}", row.fault, row.unmet)).collect();
    assert!(failed.is_empty(), "not as demanded: {failed:#?}");
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/bus_faults.md"))
        .unwrap_or_default();
    let missing: Vec<_> =
        report.rows.iter().map(|row| &row.fault).filter(|fault| !page.contains(*fault)).collect();
    assert!(missing.is_empty(), "docs/bus_faults.md lacks {missing:?}; make its table anew");
    assert!(report.rows.iter().all(|row| row.end != End::Fell), "no joint moves when the robot falls");
    for burst in report.bursts.iter().filter(|burst| burst.cycles <= 10) {
        assert_eq!(burst.walked_on, [INSTANTS; 2], "walks on through {} cycles", burst.cycles);
    }
    assert!(serde_json::to_string(&report).is_ok_and(|json| json.contains("\"noticed_cycles\"")));
}
