//! How a run ended, by its exit code and its figures: a fall, a lost supply and a refused command are no success, in one
//! process as in all.
//!
//! Regression: a robot that fell, or lay without supply, was planned for and reported as walking and standing, its simulation
//! stood still in mid-fall, and the command said 0.

use harness::{Running, Said, Signal, Site, doze};
use ipc::Reader;
use messages::topics::{CONTROLLER_STATE, EVENTS_PLANNER, SIM_STATE};
use messages::{ControllerState, Event, EventCode, GaitState, Process, SimState};
use recording::Log;
use serde_json::Value;

const EXE: &str = harness::executable!();

/// Lola walks, and this happens besides.
fn site(then: &str) -> Site {
    let site = Site::new(EXE);
    site.scene("walk", 12.0, &format!("{}{then}", harness::WALK));
    site
}

/// The scene in one process and in all, in simulated time: exit code, and what the figures say of the end.
fn both(site: &Site) -> [(Said, Value); 2] {
    let log = site.path("sim.mcap").display().to_string();
    let sim = site.gangwerk(&["sim", "walk", "--json", "--log", &log]);
    let run = site.run("walk", &["--lockstep", "--json"]).end();
    [sim, run].map(|said| {
        let figures = serde_json::from_str(&said.out).unwrap_or_else(|e| panic!("{e}: {said:#?}"));
        (said, figures)
    })
}

#[track_caller]
fn check(site: &Site, code: i32, by: &str, at: [f64; 2], refused: u64) {
    for (said, figures) in both(site) {
        assert_eq!(said.code, Some(code), "{said:#?}");
        assert_eq!(figures["ended_by"], by, "{figures:#}");
        let time = figures["ended_at"].as_f64().unwrap();
        assert!(time >= at[0] && time <= at[1], "{figures:#}");
        assert_eq!(figures["commands_refused"], refused, "{figures:#}");
        assert_eq!(figures["fell"], by == "fell", "{figures:#}");
    }
}

const PUSH: &str = "
[[push]]
time = 5.0
duration = 0.1
force = [0.0, 900.0, 0.0]
[[command]]
time = 7.0
topic = \"walk/velocity\"
forward = 0.2
";

#[test]
fn a_robot_that_falls_is_no_success_and_nothing_is_planned_for_it() {
    let site = site(PUSH);
    check(&site, 3, "fell", [5.0, 6.0], 1);
    for name in ["sim.mcap", "walk.mcap"] {
        let log = Log::open(&site.path(name)).unwrap();
        let states = log.records::<ControllerState>(&CONTROLLER_STATE).unwrap();
        let fell = states.iter().position(|s| s.gait == GaitState::Fallen as u64).expect("it fell");
        assert!(states[fell..].iter().all(|s| s.gait == GaitState::Fallen as u64 && s.not_standing == 1));
        assert!(states[fell + 2..].iter().all(|s| s.plan_id == 0), "{name}: a plan after the fall");
        let after = states[fell].header.tick + 1;
        let told = log.records::<Event>(&EVENTS_PLANNER).unwrap();
        let told: Vec<_> = told.iter().filter(|e| e.header.tick > after).map(|e| e.code).collect();
        let expected = [EventCode::NotStanding, EventCode::Ended].map(|code| code as u64);
        assert_eq!(told, expected, "{name}: what the planner says after the fall");
    }
    falls_to_the_ground(&Log::open(&site.path("sim.mcap")).unwrap());
}

/// Every record is true: position and velocity agree until the torso meets the ground, and then nothing moves.
fn falls_to_the_ground(log: &Log) {
    let states = log.records::<SimState>(&SIM_STATE).unwrap();
    let fell = states.iter().position(|s| s.fallen == 1).unwrap();
    let last = states.last().unwrap();
    assert!((last.time - states[fell].time) < 2.1, "the run ends 2 s after the fall");
    assert!(last.position[2] < 0.3 * states[0].position[2], "torso at {} m", last.position[2]);
    assert_eq!((last.velocity, last.angular_velocity), ([0.0; 3], [0.0; 3]));
    let norm = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let moving = states[fell..].windows(2).take_while(|w| w[1].velocity != [0.0; 3]);
    let mut cycles = 0;
    for w in moving {
        let moved = std::array::from_fn(|k| (w[1].position[k] - w[0].position[k]) / 1e-3);
        let mean = 0.5 * (norm(w[0].velocity) + norm(w[1].velocity));
        assert!((norm(moved) - mean).abs() < 0.05, "{} s: {moved:?} m/s, {mean} m/s", w[1].time);
        cycles += 1;
    }
    assert!(cycles > 50, "it went on falling for {cycles} cycles");
}

#[test]
fn a_robot_that_loses_its_supply_is_no_success() {
    // Standing: she stays on her feet, and does not take the walk that comes next.
    let site = Site::new(EXE);
    let tables = "
[[command]]
time = 0.2
topic = \"walk/stand\"
[[command]]
time = 2.5
topic = \"system/emergency_stop\"
[[command]]
time = 3.0
topic = \"walk/velocity\"
forward = 0.2
";
    site.scene("walk", 12.0, tables);
    check(&site, 4, "power_off: EmergencyStop", [2.49, 2.51], 1);
}

#[test]
fn a_command_that_is_refused_is_no_success() {
    let beyond = "[[command]]\ntime = 5.0\ntopic = \"head/joints\"\npan = 2.0\n";
    check(&site(beyond), 4, "done", [12.0, 12.0], 1);
}

#[test]
fn a_walk_to_the_end_of_its_scene_is_a_success() {
    check(&site(""), 0, "done", [12.0, 12.0], 0);
}

#[test]
fn who_ends_a_run_in_order_has_a_success() {
    let site = Site::new(EXE);
    site.scene("walk", 600.0, harness::WALK);
    let mut run: Running = site.run("walk", &["--lockstep", "--json"]);
    let space = run.space();
    let mut state: Reader<SimState> = space.reader(&SIM_STATE).unwrap();
    while state.latest().is_none_or(|s| s.time < 4.0) {
        assert!(run.is_alive(), "{}", run.err());
        doze(0.005);
    }
    site.topic(&["pub", "system/end"]).well();
    drop(space);
    let said = run.end().well();
    let figures: Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!((&figures["ended_by"], &figures["fell"]), (&"asked".into(), &false.into()), "{figures:#}");
}

/// A run in simulated time that has come to 4 s, walking.
fn walking(site: &Site) -> Running {
    site.scene("walk", 600.0, harness::WALK);
    let mut run = site.run("walk", &["--lockstep", "--no-log"]);
    let space = run.space();
    let mut state: Reader<SimState> = space.reader(&SIM_STATE).unwrap();
    while state.latest().is_none_or(|s| s.time < 4.0) {
        assert!(run.is_alive(), "{}", run.err());
        doze(0.005);
    }
    run
}

/// SIGTERM to the joint loop passed for the end of the scene.
#[test]
fn a_joint_loop_that_is_ended_in_mid_walk_is_no_success() {
    let site = Site::new(EXE);
    let run = walking(&site);
    run.signal(Process::Lowlevel, Signal::TERM);
    let said = run.end();
    assert_eq!(said.code, Some(1), "{said:#?}");
    assert!(said.err.contains("lowlevel died during the run: exit status: 130"), "{}", said.err);
}

/// Ctrl-Z stopped the supervisor, and she walked on without it.
#[test]
fn ctrl_z_and_ctrl_backslash_end_a_run_as_ctrl_c_does() {
    for key in [Signal::TSTP, Signal::QUIT] {
        let site = Site::new(EXE);
        let run = walking(&site);
        run.signal_supervisor(key);
        let said = run.end();
        assert_eq!(said.code, Some(130), "{key:?}: {said:#?}");
        assert!(said.err.contains("asked to end: the robot stops and stands first"), "{}", said.err);
    }
}

/// SIGXFSZ ended the supervisor without a word.
#[test]
fn a_limit_of_the_size_of_files_is_an_error_that_is_told() {
    let site = Site::new(EXE);
    site.scene("walk", 600.0, harness::WALK);
    let arguments = site.run_arguments("walk", &["--lockstep"]);
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let said = site.start_under(&["sh", "-c", "ulimit -f 64; exec \"$@\"", "sh"], &arguments).end();
    assert_eq!(said.code, Some(1), "{said:#?}");
    assert!(said.err.contains("error: "), "{said:#?}");
}

#[test]
fn the_codes_are_told_by_help() {
    let site = Site::new(EXE);
    for command in ["run", "sim"] {
        let said = site.gangwerk(&[command, "--help"]).well();
        assert!(said.out.contains("3    the robot fell"), "{}", said.out);
    }
}
