//! `gangwerk joystick` at a robot that runs: events of a gamepad walk her, and she stands whatever ends them. This machine's kernel need
//! not have a gamepad: events come through a pipe, as `/dev/input/event*` gives them (tests/vcan has a real one).

use super::{Site, Tick, WAIT, doze, shared_turn, until, walk};
use harness::{Running, Signal};
use ipc::{Reader, Space};
use messages::topics::{CONTROLLER_STATE, POWER, SIM_STATE};
use messages::{ControllerState, GaitState, Power, SimState};
use realtime::clock;
use std::fs::File;
use std::io::Write;
use std::path::PathBuf;

const EV_KEY: u16 = 1;
const EV_ABS: u16 = 3;
const ABS_X: u16 = 0;
const ABS_Y: u16 = 1;
const BTN_SOUTH: u16 = 0x130;
const BTN_EAST: u16 = 0x131;
const BTN_TL: u16 = 0x136;
/// Longest stop \[cycles\]: the step that is walked, one that closes, and coming to rest.
const STOP: u64 = 4000;

/// Time in which a button of a gamepad that was plugged in is taken for one that was held before, and some more \[s\].
const SETTLE: f64 = 0.6;

/// A pipe in place of a gamepad. Unplugged when dropped.
struct Pad(File);

impl Pad {
    fn path(site: &Site) -> PathBuf {
        site.path("gamepad")
    }

    /// Plugs it in; the same pipe again later.
    fn plug_in(site: &Site) -> Self {
        let path = Self::path(site);
        if !path.exists() {
            rustix::fs::mkfifoat(rustix::fs::CWD, &path, rustix::fs::Mode::RUSR | rustix::fs::Mode::WUSR)
                .unwrap();
        }
        // Both ways: it waits for nobody who reads.
        Self(File::options().read(true).write(true).open(path).unwrap())
    }

    /// One report: type, code, value of each event.
    fn report(&mut self, events: &[(u16, u16, i32)]) {
        let mut bytes = Vec::new();
        for &(kind, code, value) in events.iter().chain(&[(0, 0, 0)]) {
            bytes.extend([0; 16]);
            bytes.extend(kind.to_ne_bytes());
            bytes.extend(code.to_ne_bytes());
            bytes.extend(value.to_ne_bytes());
        }
        self.0.write_all(&bytes).unwrap();
    }

    fn hold(&mut self, held: bool) {
        self.report(&[(EV_KEY, BTN_TL, i32::from(held))]);
    }

    /// Left stick; forward is up.
    fn stick(&mut self, forward: f64, right: f64) {
        let value = |x: f64| (x * 32767.0) as i32;
        self.report(&[(EV_ABS, ABS_Y, value(-forward)), (EV_ABS, ABS_X, value(right))]);
    }
}

/// Random numbers; the seed is printed.
pub(super) struct Dice(u64);

impl Dice {
    pub(super) fn new() -> Self {
        let seed = std::env::var("SEED").ok().and_then(|s| s.parse().ok()).unwrap_or_else(clock::now);
        println!("SEED={seed}");
        Self(seed | 1)
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        low + (high - low) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// `gangwerk joystick` at that pipe.
fn joystick(site: &Site) -> Running {
    let (dir, pipe) = (site.run_dir().display().to_string(), Pad::path(site).display().to_string());
    site.start(&["joystick", "--dir", &dir, "--events", &pipe])
}

/// Waits until it has said so, for the `times`-th time.
#[track_caller]
pub(super) fn says(joystick: &mut Running, text: &str, times: usize) {
    let begun = clock::now();
    while joystick.out().matches(text).count() < times {
        let late = clock::now() - begun > 30 * clock::SECOND;
        assert!(
            !late && joystick.is_alive(),
            "not said {times} times: {text}\n{}{}",
            joystick.out(),
            joystick.err()
        );
        doze(0.002);
    }
}

/// A robot that runs, as fast as it can, and what it does.
pub(super) struct Robot {
    pub(super) run: Running,
    pub(super) state: Reader<ControllerState>,
    pub(super) sim: Reader<SimState>,
    pub(super) space: Space,
}

impl Robot {
    pub(super) fn standing(site: &Site) -> Self {
        Self::standing_in(site, &["--lockstep", "--no-log"])
    }

    /// The same, of a run with these options.
    pub(super) fn standing_in(site: &Site, options: &[&str]) -> Self {
        Self::standing_with(site, "", options)
    }

    /// The same among these objects.
    pub(super) fn standing_with(site: &Site, objects: &str, options: &[&str]) -> Self {
        site.scene("wait", 100_000.0, &format!("{objects}{WAIT}"));
        let mut run = site.run("wait", options);
        let space = run.space();
        let (state, sim) = (space.reader(&CONTROLLER_STATE).unwrap(), space.reader(&SIM_STATE).unwrap());
        let mut robot = Self { run, state, sim, space };
        until(&mut robot.run, &mut robot.state, |s| s.tick() > 3000 && s.gait == GaitState::Standing as u64);
        robot
    }

    pub(super) fn walks(&mut self) -> u64 {
        until(&mut self.run, &mut self.state, |s| s.gait == GaitState::Walking as u64).tick()
    }

    /// She comes to a stand. What an observer that is not scheduled misses is on neither side of the bound.
    #[track_caller]
    pub(super) fn stands(&mut self) {
        let begun = clock::now();
        let (mut before, mut slower) = (0, None);
        let stood = loop {
            assert!(clock::now() - begun < 30 * clock::SECOND, "she does not stand: {}", self.run.err());
            let Some(state) = self.state.follow() else {
                doze(0.001);
                continue;
            };
            match GaitState::from(state.gait) {
                GaitState::Starting | GaitState::Walking => slower = None,
                GaitState::Standing if slower.is_some() => break state.tick(),
                _ => slower = slower.or(Some(state.tick())),
            }
            before = state.tick();
        };
        let stop = before.saturating_sub(slower.unwrap_or(0));
        assert!(stop < STOP, "she stood at tick {stood}, after {stop} cycles and more");
        let sim = until(&mut self.run, &mut self.sim, |s| s.tick() > stood + 500);
        assert_eq!((sim.fallen, sim.power), (0, 1));
    }

    /// Nothing moves her for a while.
    #[track_caller]
    pub(super) fn stays(&mut self) {
        doze(0.3);
        while let Some(state) = self.state.follow() {
            assert_eq!(state.gait, GaitState::Standing as u64, "she moves at tick {}", state.tick());
        }
    }
}

#[test]
fn a_gamepad_walks_her_while_its_button_is_held() {
    let _turn = shared_turn();
    let (site, mut dice) = (Site::patient(super::EXE), Dice::new());
    let mut pad = Pad::plug_in(&site);
    // Held before anything runs: no press.
    pad.hold(true);
    pad.stick(0.9, 0.0);
    let mut stick = joystick(&site);
    says(&mut stick, "no robot runs in", 1);
    let mut robot = Robot::standing(&site);
    says(&mut stick, "robot: lola", 1);
    says(&mut stick, "release the dead-man button, and hold it again", 1);
    robot.stays();
    // A stick alone does nothing; nor does a button.
    pad.hold(false);
    pad.stick(1.0, 0.0);
    pad.report(&[(EV_KEY, BTN_SOUTH, 1)]);
    says(&mut stick, "walk: hold the dead-man button first", 1);
    robot.stays();

    // Released at random instants.
    for n in 1..=2 {
        pad.stick(dice.between(0.3, 1.0), dice.between(-0.3, 0.3));
        pad.hold(true);
        robot.walks();
        doze(dice.between(0.02, 0.3));
        pad.hold(false);
        robot.stands();
        says(&mut stick, "dead-man button released", n);
        says(&mut stick, "walk/stop accepted by planner", n);
    }
    // Unplugged; plugged in again with the button held it is no press.
    pad.hold(true);
    robot.walks();
    doze(dice.between(0.02, 0.3));
    drop(pad);
    robot.stands();
    says(&mut stick, "is gone", 1);
    let mut pad = Pad::plug_in(&site);
    pad.hold(true);
    pad.stick(0.8, 0.0);
    says(&mut stick, "gamepad: recorded events", 2);
    robot.stays();
    says(&mut stick, "release the dead-man button, and hold it again", 2);
    // Stopped as a hung program: the lease runs out, and what is held does not count when it goes on.
    pad.hold(false);
    doze(SETTLE);
    pad.hold(true);
    robot.walks();
    doze(dice.between(0.02, 0.3));
    stick.signal_supervisor(Signal::STOP);
    let begun = clock::now();
    robot.stands();
    let seconds = (clock::now() - begun) as f64 * 1e-9;
    assert!((0.3..2.0).contains(&seconds), "she stood {seconds} s after the last heartbeat");
    stick.signal_supervisor(Signal::CONT);
    pad.stick(dice.between(0.3, 1.0), 0.0);
    says(&mut stick, "release the dead-man button, and hold it again", 3);
    robot.stays();
    // Killed. Just after a standstill a press does not count.
    pad.hold(false);
    doze(SETTLE);
    pad.hold(true);
    robot.walks();
    doze(dice.between(0.02, 0.3));
    stick.signal_supervisor(Signal::KILL);
    robot.stands();

    // Another one outlives the robot, and ends in order.
    drop(pad);
    let mut pad = Pad::plug_in(&site);
    let mut stick = joystick(&site);
    says(&mut stick, "gamepad: recorded events", 1);
    says(&mut stick, "robot: lola", 1);
    pad.stick(0.5, 0.0);
    doze(SETTLE);
    pad.hold(true);
    robot.walks();
    robot.run.interrupt();
    let Robot { run, state, sim, space } = robot;
    drop((state, sim, space));
    assert_eq!(run.end().code, Some(130));
    says(&mut stick, "the robot is waited for", 1);
    stick.interrupt();
    let said = stick.end().well();
    let lines: Vec<&str> = said.out.lines().collect();
    assert!(lines.len() < 20, "a line per change, not per message: {}", said.out);
}

/// Without dead-man button and lease, while somebody else steers.
#[test]
fn the_emergency_stop_of_a_gamepad_needs_no_lease() {
    let _turn = shared_turn();
    let site = Site::patient(super::EXE);
    let mut pad = Pad::plug_in(&site);
    let mut stick = joystick(&site);
    let mut robot = Robot::standing(&site);
    says(&mut stick, "robot: lola", 1);
    let operator = walk(&site);
    let walking = robot.walks();
    // Nobody gets past the lease.
    pad.stick(-1.0, 0.0);
    pad.hold(true);
    says(&mut stick, "gangwerk topic pub", 1);
    pad.hold(false);
    let later = until(&mut robot.run, &mut robot.state, |s| s.tick() > walking + 5000);
    assert_eq!(later.gait, GaitState::Walking as u64, "she goes on");
    let mut power = robot.space.reader::<Power>(&POWER).unwrap();
    assert_eq!(until(&mut robot.run, &mut power, |_| true).on, 1);
    // Tapped: up again in the next report.
    pad.report(&[(EV_KEY, BTN_EAST, 1)]);
    pad.report(&[(EV_KEY, BTN_EAST, 0)]);
    until(&mut robot.run, &mut power, |p| p.on == 0);
    says(&mut stick, "emergency stop: power off at tick", 1);
    drop(operator);
}

/// Devices and layouts that cannot be: one error that says what to do.
#[test]
fn what_cannot_be_steered_with_is_refused() {
    let site = Site::new(super::EXE);
    let refused = |arguments: &[&str], words: &[&str]| {
        let said = site.gangwerk(&[&["joystick"], arguments].concat());
        assert_eq!(said.code, Some(1), "{said:?}");
        let one = said.err.starts_with("error: ") && words.iter().all(|word| said.err.contains(word));
        assert!(one && said.out.is_empty(), "{said:?}");
    };
    refused(&["--device", "/nowhere/event9"], &["/nowhere/event9", "cannot be opened", "plugged in?"]);
    refused(&["--device", "/dev/null"], &["/dev/null", "a device of /dev/input/event* is needed"]);
    site.edit("joystick.toml", "dead_zone = 0.12", "dead_zone = 1.2");
    refused(&[], &["joystick.toml: line", "dead_zone", "1.2 is not allowed", "from 0 to 0.9"]);
    let map = site.path("map.toml");
    std::fs::write(&map, "deadzone = 0.1\n").unwrap();
    refused(
        &["--map", map.to_str().unwrap()],
        &["map.toml", "deadzone: unknown key", "`dead_zone`", "buttons: missing"],
    );
}
