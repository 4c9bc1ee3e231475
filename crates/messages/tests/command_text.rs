//! The text form of commands and the check of their ranges.

use messages::Command;
use messages::command::{Domain, Priority, PushCommand, StepCommand, VelocityCommand};
use messages::command_text::{COMMANDS, FieldInfo};
use proptest::prelude::*;

/// The middle of a field's range, whole where it must be.
fn middle(f: &FieldInfo) -> f64 {
    let [low, high] = f.range;
    let middle = 0.5 * (low + high);
    if f.is_whole() { middle.floor() } else { middle }
}

fn refused(name: &str, text: &str) -> String {
    Command::parse(name, text).expect_err(&format!("{name} {text}"))
}

#[test]
fn text_becomes_the_command() {
    let velocity = Command::Velocity(VelocityCommand { forward: 0.5, left: 0.0, turn: -0.1 });
    assert_eq!(Command::parse("walk/velocity", "forward=0.5 turn=-0.1"), Ok(velocity));
    assert_eq!(Command::parse("walk/velocity", " turn=-1e-1,forward=.5, left=0\n"), Ok(velocity));
    let step = Command::Step(StepCommand { length: 0.3, side: 0.0, turn: 0.0, duration: 0.8 });
    assert_eq!(Command::parse("walk/step", "duration=0.8 length=0.3"), Ok(step));
    let push = Command::Push(PushCommand { force: [0.0, 200.0, 0.0], duration: 0.1 });
    assert_eq!(Command::parse("sim/push", "force.y=200 duration=0.1"), Ok(push));
    assert_eq!(Command::parse("system/emergency_stop", ""), Ok(Command::EmergencyStop));
}

#[test]
fn errors_say_what_to_do() {
    let has = |text: String, parts: &[&str]| {
        for part in parts {
            assert!(text.contains(part), "`{part}` is not in: {text}");
        }
    };
    has(refused("walk/velocty", "forward=1"), &["no topic `walk/velocty`", "did you mean walk/velocity?"]);
    has(refused("velocity", "forward=1"), &["did you mean walk/velocity?"]);
    has(refused("zzzzzzzzzz", ""), &["there is no topic `zzzzzzzzzz`; `gangwerk topic list` shows them all"]);
    has(
        refused("walk/velocity", "foward=1"),
        &["walk/velocity: there is no field `foward`; did you mean forward?"],
    );
    has(refused("walk/velocity", "forward"), &["`forward` is not of the form field=number"]);
    has(refused("walk/velocity", "forward=fast"), &["`fast` is not a number in [-2, 2] m/s"]);
    has(refused("walk/velocity", "forward=1 forward=1"), &["forward is given twice"]);
    has(refused("walk/velocity", ""), &["give it numbers", "forward=<m/s> left=<m/s> turn=<rad/s>"]);
    has(refused("walk/step", "length=0.3"), &["duration is missing: a number in [0.3, 5] s"]);
    has(refused("walk/step", "length=0.3 duration=9"), &["duration = 9 is outside of [0.3, 5] s"]);
    // Regression: three hundred digits.
    has(refused("walk/step", "length=0.3 duration=1e300"), &["duration = 1e300 is outside of [0.3, 5] s"]);
    has(refused("walk/stop", "now=1"), &["takes no numbers"]);
    for bad in ["NaN", "nan", "inf", "-inf", "1e999"] {
        has(
            refused("walk/velocity", &format!("forward={bad}")),
            &["forward", "not a finite number", "[-2, 2] m/s"],
        );
    }
}

/// Table, parser and address agree, for every command.
#[test]
fn the_table_is_complete() {
    let mut addresses = std::collections::BTreeSet::new();
    for info in COMMANDS {
        let command = info.example();
        assert_eq!(command.name(), info.name);
        let (domain, id) = command.address();
        assert!(addresses.insert((domain as u16, id)), "{} shares its address", info.name);
        assert!(info.name.starts_with(&format!("{}/", domain.name())), "{}", info.name);
        assert_eq!(Domain::try_from(domain as u16), Ok(domain));
        for f in info.fields {
            assert!(f.range[0] < f.range[1] && f.default.is_none_or(|d| d >= f.range[0] && d <= f.range[1]));
        }
        let middles: Vec<_> = info.fields.iter().map(|f| format!("{}={}", f.name, middle(f))).collect();
        assert_eq!(Command::parse(info.name, &middles.join(" ")).unwrap().name(), info.name);
    }
    assert_eq!(COMMANDS.len(), 22, "a new command needs its row");
    assert_eq!(Domain::try_from(8), Err(8));
    assert_eq!(Priority::try_from(3), Err(3));
    assert_eq!(Command::EmergencyStop.priority(), Priority::High);
}

#[test]
fn commands_to_the_head() {
    let command = Command::parse("head/fixate", "x=2 y=-0.5 z=1").unwrap();
    assert_eq!(command, Command::Fixate(messages::command::FixateCommand { point: [2.0, -0.5, 1.0] }));
    assert!(Command::parse("head/fixate", "x=2 y=nan z=1").unwrap_err().contains("not a finite number"));
    assert!(Command::parse("head/fixate", "x=2 y=1").unwrap_err().contains("z is missing"));
    assert!(Command::parse("head/joints", "pan=4").unwrap_err().contains("outside of [-3.2, 3.2]"));
}

#[test]
fn a_number_of_something_is_whole() {
    let error = Command::parse("stabilize/parameter", "number=1.5 value=2").unwrap_err();
    assert_eq!(error, "stabilize/parameter: number = 1.5 must be a whole number");
    let error = Command::parse("vision/gone", "id=1.5").unwrap_err();
    assert_eq!(error, "vision/gone: id = 1.5 must be a whole number");
}

/// Every number of every command, not only the first: just inside passes, everything else is refused by name.
#[test]
fn every_number_is_checked() {
    for info in COMMANDS {
        for (at, f) in info.fields.iter().enumerate() {
            let with = |x: f64| {
                let text = info
                    .fields
                    .iter()
                    .enumerate()
                    .map(|(i, g)| format!("{}={:?} ", g.name, if i == at { x } else { middle(g) }));
                Command::parse(info.name, &text.collect::<String>())
            };
            let [lo, hi] = f.range;
            assert!(with(lo).is_ok() && with(hi).is_ok(), "{} {}", info.name, f.name);
            for bad in
                [lo.next_down(), hi.next_up(), 1e308, -1e308, f64::INFINITY, f64::NEG_INFINITY, f64::NAN]
            {
                let error = with(bad).expect_err(f.name);
                assert!(
                    error.contains(info.name) && error.contains(f.name) && error.contains(f.unit),
                    "{error}"
                );
            }
        }
    }
}

proptest! {
    #[test]
    fn noise_never_panics(name in "\\PC{0,40}", text in "\\PC{0,80}") {
        prop_assert!(Command::parse(&name, "").is_err() || COMMANDS.iter().any(|c| c.name == name));
        let _ = Command::parse("walk/velocity", &text);
    }

    #[test]
    fn what_is_printed_is_read_back(forward in -2.0..2.0, left in -1.0..1.0, turn in -1.0..1.0) {
        let command = Command::Velocity(VelocityCommand { forward, left, turn });
        let text = format!("forward={forward:?} left={left:?} turn={turn:?}");
        prop_assert_eq!(Command::parse("walk/velocity", &text), Ok(command));
    }
}
