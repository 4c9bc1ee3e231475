//! `gangwerk topic`: commands that reach a running robot and act, and looks at what it does.

use harness::{Running, Site, doze};
use ipc::{Reader, Space};
use messages::topics::{CONTROLLER_STATE, EVENTS_WATCHDOG, POWER, SIM_STATE};
use messages::{ControllerState, Event, EventCode, GaitState, Power, Record, SimState};
use realtime::clock;

const EXE: &str = harness::executable!();

/// Lola stands up and waits for what she is told.
const WAIT: &str = "
[[command]]
time = 0.2
topic = \"walk/stand\"
";

/// A robot in simulated time that stands and waits, far longer than any test.
fn standing(site: &Site) -> (Running, Space) {
    site.scene("wait", 100_000.0, WAIT);
    let mut run = site.run("wait", &["--lockstep", "--no-log"]);
    let space = run.space();
    let mut state = space.reader::<ControllerState>(&CONTROLLER_STATE).unwrap();
    until(&mut run, &mut state, |s| s.tick() > 3000 && s.gait == GaitState::Standing as u64);
    (run, space)
}

trait Tick {
    fn tick(&self) -> u64;
}

impl<T: Record> Tick for T {
    fn tick(&self) -> u64 {
        self.header().tick
    }
}

/// The first record from now on of which `what` is true.
#[track_caller]
fn until<T: Record>(run: &mut Running, reader: &mut Reader<T>, what: impl Fn(&T) -> bool) -> T {
    let begun = clock::now();
    loop {
        while let Some(record) = reader.follow() {
            if what(record) {
                return *record;
            }
        }
        assert!(run.is_alive(), "the run ended: {}", run.err());
        assert!(clock::now() - begun < 30 * clock::SECOND, "it did not happen within 30 s: {}", run.err());
        doze(0.001);
    }
}

#[test]
fn walk_velocity_and_walk_stop_walk_and_stop() {
    let site = Site::new(EXE);
    let (mut run, space) = standing(&site);
    let mut sim = space.reader::<SimState>(&SIM_STATE).unwrap();
    let mut state = space.reader::<ControllerState>(&CONTROLLER_STATE).unwrap();
    let before = until(&mut run, &mut sim, |_| true).position[0];
    let said = site.topic(&["pub", "walk/velocity", "forward=0.278"]).well();
    assert_eq!(said.out, "walk/velocity taken by 1 process\n");
    until(&mut run, &mut state, |s| s.gait == GaitState::Walking as u64);
    let walked = until(&mut run, &mut sim, |s| s.position[0] > before + 1.0);
    assert_eq!((walked.fallen, walked.power), (0, 1));
    site.topic(&["pub", "walk/stop"]).well();
    until(&mut run, &mut state, |s| s.gait == GaitState::Standing as u64);
    let now = until(&mut run, &mut sim, |s| s.header.tick > walked.header.tick + 1000);
    let later = until(&mut run, &mut sim, |s| s.header.tick > now.header.tick + 20_000);
    let end = until(&mut run, &mut sim, |s| s.header.tick > later.header.tick + 2000);
    assert!(
        (end.position[0] - later.position[0]).abs() < 1e-3,
        "{} m, {} m",
        later.position[0],
        end.position[0]
    );
    assert_eq!((end.fallen, end.power), (0, 1));
}

#[test]
fn sim_push_pushes_for_as_long_as_it_says() {
    let site = Site::new(EXE);
    let (mut run, space) = standing(&site);
    let mut sim = space.reader::<SimState>(&SIM_STATE).unwrap();
    site.topic(&["pub", "sim/push", "force.y=40", "duration=0.2"]).well();
    let first = until(&mut run, &mut sim, |s| s.push != [0.0; 3]);
    assert_eq!(first.push, [0.0, 40.0, 0.0]);
    let after = until(&mut run, &mut sim, |s| s.header.tick > first.header.tick && s.push == [0.0; 3]);
    assert_eq!(after.header.tick - first.header.tick, 200);
    assert!((after.velocity[1] - first.velocity[1]).abs() > 1e-3, "a push of 8 N s is felt");
}

#[test]
fn an_emergency_stop_cuts_the_supply_in_the_cycle_that_hears_it() {
    let site = Site::new(EXE);
    let (mut run, space) = standing(&site);
    site.topic(&["pub", "walk/velocity", "forward=0.278"]).well();
    let mut state = space.reader::<ControllerState>(&CONTROLLER_STATE).unwrap();
    until(&mut run, &mut state, |s| s.gait == GaitState::Walking as u64);
    let mut power = space.reader::<Power>(&POWER).unwrap();
    let mut sim = space.reader::<SimState>(&SIM_STATE).unwrap();
    let mut events = space.reader::<Event>(&EVENTS_WATCHDOG).unwrap();
    site.topic(&["pub", "system/emergency_stop"]).well();
    let off = until(&mut run, &mut power, |p| p.on == 0);
    assert_eq!(off.reason, EventCode::EmergencyStop as u64);
    let dead = until(&mut run, &mut sim, |s| s.power == 0);
    assert_eq!(dead.header.tick, off.header.tick, "the power line falls in the same cycle");
    let event = until(&mut run, &mut events, |e| e.code == EventCode::PowerOff as u64);
    assert_eq!((event.header.tick, event.detail), (off.header.tick, EventCode::EmergencyStop as u64));
    // Latched: to enable without a reset is not enough.
    site.topic(&["pub", "system/enable"]).well();
    let later = until(&mut run, &mut power, |p| p.header.tick > off.header.tick + 2000);
    assert_eq!(later.on, 0);
}

#[test]
fn hz_and_echo_show_the_sensors_of_a_robot_in_real_time() {
    let site = Site::new(EXE);
    site.scene("wait", 60.0, WAIT);
    let mut run = site.run("wait", &["--no-log"]);
    let space = run.space();
    let mut sim = space.reader::<SimState>(&SIM_STATE).unwrap();
    until(&mut run, &mut sim, |s| s.time > 0.5);
    let said = site.topic(&["hz", "sensors"]).well();
    let rate: f64 = said.out.split_whitespace().nth(1).and_then(|word| word.parse().ok()).unwrap();
    assert!((980.0..=1005.0).contains(&rate), "{}", said.out);
    let said = site.topic(&["echo", "sensors", "--once"]).well();
    let field = |name: &str| {
        let line = said.out.lines().find_map(|line| line.strip_prefix(&format!("{name}:")));
        let numbers = line.unwrap_or_else(|| panic!("{name} of {}", said.out)).split_whitespace();
        numbers.map(|n| n.parse::<f64>().unwrap()).collect::<Vec<_>>()
    };
    assert!(field("header.tick")[0] > 500.0);
    assert!(field("joint_angle").len() >= 25);
    assert_eq!(field("power"), [1.0]);
    assert_eq!(field("imu.orientation").len(), 4);
    assert_eq!(said.out.matches("---").count(), 1, "only one record");
}
