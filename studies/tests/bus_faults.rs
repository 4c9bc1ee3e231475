//! Whatever happens to the bus while Lola walks: it is noticed and named in time, and the robot walks on or comes to rest.

use chain::Chain;
use config::Setup;
use config::bus_fault::{BusFault, FaultKind};
use messages::{Command, EventCode};
use studies::bus_faults::{self, TrialEnd};

/// Two instants of a stride: the page is made with more, `gangwerk study bus-faults`.
const INSTANTS: usize = 2;

#[test]
fn faults_are_named_and_answered_in_time() {
    let report = bus_faults::run(&config::root(None), bus_faults::SCENE, INSTANTS)
        .expect("the robot of scene `walk_2kmh`");
    println!("{}", report.sheet().markdown());
    let failed: Vec<_> = report.failed().map(|row| format!("{}: {}", row.fault, row.unmet)).collect();
    assert!(failed.is_empty(), "not as demanded: {failed:#?}");
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/bus_faults.md"))
        .unwrap_or_default();
    let missing: Vec<_> =
        report.rows.iter().map(|row| &row.fault).filter(|fault| !page.contains(*fault)).collect();
    assert!(missing.is_empty(), "docs/bus_faults.md lacks {missing:?}; make its table anew");
    assert!(report.rows.iter().all(|row| row.end != TrialEnd::Fell), "no joint moves when the robot falls");
    for burst in report.bursts.iter().filter(|burst| burst.cycles <= 10) {
        assert_eq!(burst.walked_on, [INSTANTS; 2], "walks on through {} cycles", burst.cycles);
    }
    assert!(report.sheet().json().to_string().contains("\"noticed_cycles\""));
}

/// Lola stands; a cable is shorted for a while. When the supply is on, by tick, and what was told of it.
fn supply_after_a_short(commands: &[(f64, Command)]) -> (Vec<bool>, Vec<EventCode>) {
    let mut setup = Setup::load(&config::root(None), "stand").unwrap();
    setup.scene.bus_faults =
        vec![BusFault { node: Some("arm_left".into()), ..BusFault::new(FaultKind::Shorted, 2.0, 0.1) }];
    // A scene that enables the motors itself is not armed at its beginning: this one is.
    setup.scene.commands.extend([(0.02, Command::Reset), (0.04, Command::Enable)]);
    setup.scene.commands.extend_from_slice(commands);
    let mut chain = Chain::new(&setup).unwrap();
    let mut told = Vec::new();
    let on = (0..4000).map(|_| {
        let c = chain.step();
        told.extend(
            c.events
                .iter()
                .map(|(_, code, _)| *code)
                .filter(|c| matches!(c, EventCode::BusOff | EventCode::BusActive)),
        );
        c.power.on == 1
    });
    (on.collect(), told)
}

/// The line is whole again after a tenth of a second, and its controller comes back only when it is told to.
#[test]
fn a_robot_whose_line_was_off_the_bus_is_back_by_a_reset_and_an_enable_edge_only() {
    let (on, told) = supply_after_a_short(&[]);
    assert!(on[1999] && on[2002..].iter().all(|on| !on), "off and latched, though the line is whole again");
    assert_eq!(told, [EventCode::BusOff]);
    let (on, told) = supply_after_a_short(&[(3.0, Command::Enable)]);
    assert!(on[2002..].iter().all(|on| !on), "an enable edge alone is none");
    assert_eq!(told, [EventCode::BusOff]);
    let (on, told) = supply_after_a_short(&[(3.0, Command::Reset), (3.3, Command::Enable)]);
    assert!(on[2002..3290].iter().all(|on| !on) && on[3310..].iter().all(|on| *on), "on again, and stays on");
    assert_eq!(told, [EventCode::BusOff, EventCode::BusActive]);
}
