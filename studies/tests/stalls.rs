//! Processes of a walking robot are stopped and go on: nothing comes back by itself, nothing jumps, nobody is blamed wrongly.

use chain::Chain;
use config::{Setup, root};
use messages::{Command, EventCode, GaitState, Process};
use studies::stalls::{self, StallTrial};

/// Random instants for each process and duration; `gangwerk study stalls` takes more.
const INSTANTS: usize = 3;
/// \[1\] Speed of a joint and force on a foot, over those of the undisturbed walk.
const MOST: f64 = 1.2;

/// Longest stop \[cycles\] of each process that a walk survives as if nothing had been, by what `config/system.toml` allows:
/// missed periods of the watchdog, silence of the bus, missed targets, a plan to its end; a joint loop that is late twice is
/// without power.
fn bridged(process: &str) -> u64 {
    match process {
        "watchdog" => 49,
        "sim-backend" | "controller" => 20,
        "planner" => 1000,
        _ => 0,
    }
}

/// What may be reported of a stop, beside what a walk reports anyway: its true cause, and what a robot without control does.
fn deserved(trial: &StallTrial, code: EventCode) -> bool {
    use EventCode::*;
    let lost = trial.cycles > bridged(trial.process);
    let cause: &[EventCode] = match (trial.process, lost) {
        ("watchdog" | "lowlevel", true) => &[PowerOff],
        ("sim-backend", false) => &[FramesLost, NodeHeld, NodeBack],
        ("sim-backend", true) => &[FramesLost, NodeHeld, NodeBack, BusSilent, NodeStopped, DriveTripped],
        // What was held for some cycles is caught up, no faster than a joint may.
        ("controller", false) => &[TargetLimited],
        ("controller", true) => &[TargetsStale, PlanRefused],
        _ => &[],
    };
    let after: &[EventCode] =
        if lost { &[Fallen, Lifted, EarlyContact, SafeStop, PlanKept, NotStanding] } else { &[] };
    // Whoever hits the ground is slower at once than a reading may be.
    let impact: &[EventCode] = if trial.fell { &[FrameRefused, FramesLost] } else { &[] };
    [PlanActive, ControlLimited].contains(&code) || [cause, after, impact].iter().any(|of| of.contains(&code))
}

#[test]
fn who_was_stopped_goes_on_without_a_jump() {
    let trials =
        stalls::run(&root(None), "walk_1kmh", &stalls::MILLIS, INSTANTS, 7).expect("the scene walk_1kmh");
    println!("{}", stalls::sheet(&trials).text());
    assert_eq!(trials.len(), stalls::PROCESSES.len() * stalls::MILLIS.len() * INSTANTS);
    for t in &trials {
        let what = format!("{} stopped for {} cycles at {:.3} s", t.process, t.cycles, t.at);
        assert!(!t.came_back, "{what}: the supply came back by itself");
        assert!(t.joint_speed <= MOST, "{what}: a joint was {:.2} times as fast", t.joint_speed);
        let blamed: Vec<_> = t.events.iter().filter(|(_, code)| !deserved(t, *code)).collect();
        assert!(blamed.is_empty(), "{what}: {blamed:?}");
        let bridged = t.cycles <= bridged(t.process);
        assert!(!bridged || t.force <= MOST, "{what}: a foot carried {:.2} times as much", t.force);
        assert!(!bridged || !(t.fell || t.power_off), "{what}: fell {}, power off {}", t.fell, t.power_off);
    }
}

/// Regression: the planner went on walking for a robot whose joints the joint loop held.
#[test]
fn a_robot_whose_joints_were_stopped_is_halted_and_refuses_to_walk_until_its_supply_was_off() {
    let setup = Setup::load(&root(None), "walk_1kmh").unwrap();
    let mut chain = Chain::new(&setup).unwrap();
    (0..1500).for_each(|_| _ = chain.step());
    (0..100).for_each(|_| _ = chain.step_without(&[Process::Controller]));
    (0..10).for_each(|_| _ = chain.step());
    chain.command(&Command::Start);
    let c = chain.step();
    let gait = GaitState::from(c.controller_state.gait);
    assert_eq!((gait, c.controller_state.plan_id, c.refused), (GaitState::Halted, 0, 1));
    for command in [Command::EmergencyStop, Command::Reset, Command::Enable, Command::Stand] {
        chain.command(&command);
        (0..1000).for_each(|_| _ = chain.step());
    }
    let c = chain.step();
    assert_eq!(GaitState::from(c.controller_state.gait), GaitState::Standing, "armed again, it stands");
}
