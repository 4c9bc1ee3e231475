//! `gangwerk topic`: commands that reach a running robot and act, and looks at what it does.

#[path = "commands/gateway.rs"]
mod gateway;
#[path = "commands/joystick.rs"]
mod joystick;

use harness::{Running, Signal, Site, Stalls, doze, shared_turn, turn};
use ipc::{Reader, Space};
use messages::topics::{CONTROLLER_STATE, EVENTS_PLANNER, EVENTS_WATCHDOG, POWER, SIM_STATE};
use messages::{Command, ControllerState, Event, EventCode, GaitState, Power, Process, Record, SimState};
use realtime::clock;

const EXE: &str = harness::executable!();
/// \[s\] A machine that stood still for as long skipped cycles.
const STALL: f64 = 0.002;

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

/// An operator who lets the robot walk and stays.
fn walk(site: &Site) -> Running {
    let dir = site.run_dir().display().to_string();
    site.start(&["topic", "pub", "walk/velocity", "forward=0.278", "--dir", &dir])
}

/// A walking robot in real time, its operator, and what the planner tells.
fn walking(site: &Site) -> (Running, Running, Space) {
    site.scene("wait", 600.0, WAIT);
    let mut run = site.run("wait", &["--no-log"]);
    let space = run.space();
    let mut state = space.reader::<ControllerState>(&CONTROLLER_STATE).unwrap();
    until(&mut run, &mut state, |s| s.tick() > 3000 && s.gait == GaitState::Standing as u64);
    let operator = walk(site);
    until(&mut run, &mut state, |s| s.gait == GaitState::Walking as u64);
    (run, operator, space)
}

/// The robot comes to a stand because the lease is over, and says so.
fn stands_without_lease(run: &mut Running, space: &Space) {
    let mut events = space.reader::<Event>(&EVENTS_PLANNER).unwrap();
    let mut state = space.reader::<ControllerState>(&CONTROLLER_STATE).unwrap();
    until(run, &mut events, |e| e.code == EventCode::LeaseLost as u64);
    let end = until(run, &mut state, |s| s.gait == GaitState::Standing as u64);
    let mut sim = space.reader::<SimState>(&SIM_STATE).unwrap();
    let still = until(run, &mut sim, |s| s.tick() > end.tick() + 500);
    assert_eq!((still.fallen, still.power), (0, 1));
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
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    let (mut run, space) = standing(&site);
    let mut sim = space.reader::<SimState>(&SIM_STATE).unwrap();
    let mut state = space.reader::<ControllerState>(&CONTROLLER_STATE).unwrap();
    let before = until(&mut run, &mut sim, |_| true).position[0];
    let operator = walk(&site);
    until(&mut run, &mut state, |s| s.gait == GaitState::Walking as u64);
    let walked = until(&mut run, &mut sim, |s| s.position[0] > before + 1.0);
    assert_eq!((walked.fallen, walked.power), (0, 1));
    assert_eq!(site.topic(&["pub", "walk/stop"]).well().out, "walk/stop accepted by planner\n");
    let said = operator.end().well();
    assert!(said.out.starts_with("walk/velocity accepted by planner\n"), "{}", said.out);
    assert!(said.out.contains("stopped by somebody else: walk/stop"), "{}", said.out);
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
    let _turn = shared_turn();
    let site = Site::patient(EXE);
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
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    let (mut run, space) = standing(&site);
    let _operator = walk(&site);
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
    let said = site.topic(&["pub", "system/enable"]);
    assert!(said.code == Some(1) && said.err.contains("system/reset comes first"), "{said:#?}");
    let later = until(&mut run, &mut power, |p| p.header.tick > off.header.tick + 2000);
    assert_eq!(later.on, 0);
}

#[test]
fn hz_and_echo_show_the_sensors_of_a_robot_in_real_time() {
    let _turn = turn();
    let site = Site::patient(EXE);
    site.scene("wait", 60.0, WAIT);
    let mut run = site.run("wait", &["--no-log"]);
    let space = run.space();
    let mut sim = space.reader::<SimState>(&SIM_STATE).unwrap();
    until(&mut run, &mut sim, |s| s.time > 0.5);
    // Rate, and spread of the period. A machine that stands still for some milliseconds skips cycles: then once more; and where it
    // does so all the time, as many records are told as are counted here.
    let machine = Stalls::watch();
    let mut count = || {
        let before = sim.lost();
        let read = std::iter::from_fn(|| sim.follow().map(|_| ())).count() as u64;
        (clock::now(), read + sim.lost() - before)
    };
    let mut alike = false;
    let exact = (0..8).any(|_| {
        let (begun, _) = count();
        let out = site.topic(&["hz", "sensors"]).well().out;
        let (ended, records) = count();
        let counted = records as f64 / ((ended - begun) as f64 * 1e-9);
        println!("{counted:.1} records/s counted; {out}");
        let rate: f64 = out.split_whitespace().nth(1).and_then(|word| word.parse().ok()).unwrap();
        alike |= (0.98..1.02).contains(&(rate / counted)) && out.contains("period by the stamps: mean ");
        (980.0..=1005.0).contains(&rate)
            && out.contains("period by the stamps: mean 1.00")
            && out.contains(", std ")
    });
    assert!(exact || alike && machine.longest() > STALL, "none of eight rates is that of the bus");
    drop(machine);
    let said = site.topic(&["echo", "sensors", "--once"]).well();
    let field = |name: &str| {
        let line = said.out.lines().find_map(|line| line.strip_prefix(&format!("{name} ")));
        let numbers = line.unwrap_or_else(|| panic!("{name} of {}", said.out)).split_whitespace();
        numbers.map_while(|n| n.parse::<f64>().ok()).collect::<Vec<_>>()
    };
    assert!(field("header.tick")[0] > 500.0);
    assert_eq!(said.out.lines().filter(|line| line.starts_with("joint_angle.")).count(), 24, "{}", said.out);
    assert!(said.out.contains("joint_angle.right_knee_flexion 0."), "{}", said.out);
    assert!(
        said.out.lines().any(|l| l.starts_with("joint_angle.head_pan ") && l.ends_with(" rad")),
        "{}",
        said.out
    );
    assert_eq!(field("power"), [1.0]);
    assert_eq!(field("imu.orientation").len(), 4);
    assert_eq!(said.out.matches("---").count(), 1, "only one record");
    // Age of records of a robot in real time.
    let said = site.topic(&["delay", "sensors", "--seconds", "0.5"]).well();
    let mean: f64 =
        said.out.split("mean ").nth(1).and_then(|text| text.split(' ').next()?.parse().ok()).unwrap();
    assert!((0.0..50.0).contains(&mean), "{}", said.out);
}

/// Issue 10, C7: the operator's link was lost, and the robot walked on for ever.
#[test]
fn an_operator_who_is_killed_or_hangs_stops_the_walk() {
    let _turn = turn();
    for signal in [Signal::KILL, Signal::STOP] {
        let site = Site::patient(EXE);
        let (mut run, operator, space) = walking(&site);
        operator.signal_supervisor(signal);
        stands_without_lease(&mut run, &space);
        operator.signal_supervisor(Signal::KILL);
    }
}

/// The run goes on when its scene is over; whoever steers, by a stop before she was to walk, is not overruled by the scene.
#[test]
fn a_run_that_stays_goes_on_and_obeys_whoever_steers() {
    let walks = format!("{WAIT}[[command]]\ntime = 6.0\ntopic = \"walk/velocity\"\nforward = 0.278\n");
    let site = Site::patient(EXE);
    site.scene("stay", 7.0, &walks);
    for (steered, gait) in [(false, GaitState::Walking), (true, GaitState::Standing)] {
        let mut run = site.run("stay", &["--lockstep", "--paced", "--stay", "--no-log"]);
        let space = run.space();
        let mut state = space.reader::<ControllerState>(&CONTROLLER_STATE).unwrap();
        until(&mut run, &mut state, |s| s.tick() > 2500 && s.gait == GaitState::Standing as u64);
        if steered {
            site.topic(&["pub", "walk/stop", "-1"]).well();
        }
        let late = until(&mut run, &mut state, |s| s.tick() > 9000);
        assert_eq!(GaitState::from(late.gait), gait);
        run.interrupt();
        assert_eq!(run.end().code, Some(130), "ended by Ctrl-C");
    }
}

/// The lease ends by the clock of the process that walks: nobody has to tell it.
#[test]
fn a_broker_that_hangs_or_dies_stops_the_walk() {
    let _turn = turn();
    for signal in [Signal::STOP, Signal::KILL] {
        let site = Site::patient(EXE);
        let (mut run, operator, space) = walking(&site);
        run.signal(Process::Broker, signal);
        stands_without_lease(&mut run, &space);
        operator.signal_supervisor(Signal::KILL);
        run.signal(Process::Broker, Signal::KILL);
    }
}

/// Issue 10, C3: a velocity sent to a stalled broker from a connection that is closed by now started the walk 0.46 s after
/// the broker went on; so does nothing that waits in a stalled planner.
#[test]
fn a_command_that_waited_in_a_stalled_process_moves_nothing() {
    let _turn = turn();
    let site = Site::patient(EXE);
    site.scene("wait", 600.0, WAIT);
    let mut run = site.run("wait", &["--no-log"]);
    let space = run.space();
    let mut state = space.reader::<ControllerState>(&CONTROLLER_STATE).unwrap();
    until(&mut run, &mut state, |s| s.tick() > 3000 && s.gait == GaitState::Standing as u64);
    for process in [Process::Broker, Process::Planner] {
        let mut client = broker::StreamClient::connect(&site.run_dir(), "closed by now").unwrap();
        client.ping().unwrap();
        run.signal(process, Signal::STOP);
        client.send(&Command::parse("walk/velocity", "forward=0.4").unwrap()).unwrap();
        doze(0.3);
        if process == Process::Broker {
            drop(client);
        }
        run.signal(process, Signal::CONT);
        let now = until(&mut run, &mut state, |_| true).tick();
        while until(&mut run, &mut state, |_| true).tick() < now + 1500 {
            let s = until(&mut run, &mut state, |_| true);
            assert_eq!(s.gait, GaitState::Standing as u64, "after a stall of {}", process.name());
        }
    }
}

#[test]
fn a_refused_command_ends_topic_pub_with_the_reason_and_the_limit() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    let (run, _space) = standing(&site);
    let said = site.topic(&["pub", "walk/velocity", "forward=1.9"]);
    assert_eq!(said.code, Some(1), "{said:#?}");
    assert_eq!(said.err.trim(), "error: walk/velocity refused by planner: forward = 1.9 m/s: at most 0.943");
    // The joint loop decides these two; it accepted whatever it was told.
    for (command, why) in [
        ("joint/home", "refused by lowlevel: no joint waits for its angle"),
        ("joint/zero_force", "N on a foot, at most 90 N: the robot must hang"),
    ] {
        let said = site.topic(&["pub", command]);
        assert!(said.code == Some(1) && said.err.contains(why), "{said:#?}");
    }
    let said = site.topic(&["pub", "walk/velocity", "forward=0.278", "--for", "0.5"]).well();
    assert!(said.out.ends_with("walk/stop accepted by planner\n"), "{}", said.out);
    run.interrupt();
}

/// The same protocol from another language, written from its page of the documentation.
#[test]
fn the_python_client_speaks_to_the_broker() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    let key = "00112233445566778899aabbccddeeff".repeat(2);
    let path = site.config("keys");
    std::fs::write(&path, format!("console walk {key}\n")).unwrap();
    std::fs::set_permissions(&path, std::os::unix::fs::PermissionsExt::from_mode(0o600)).unwrap();
    site.edit("system.toml", "tcp_keys = \"\"", "tcp_keys = \"keys\"");
    let (mut run, _space) = standing(&site);
    let address = std::fs::read_to_string(site.run_dir().join("broker.tcp")).unwrap();
    let (host, port) = address.trim().rsplit_once(':').unwrap();
    let script = harness::root().join("tests/python_client.py");
    let said = std::process::Command::new("python3")
        .arg(script)
        .arg(site.run_dir())
        .args([host, port, "console", &key])
        .output()
        .expect("python3 is there");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(said.status.success(), "{}{}{}", text(&said.stdout), text(&said.stderr), run.err());
    // The same client in a shell.
    let console = |python: &str, dir: &std::path::Path, code: &str| {
        let mut shell = std::process::Command::new(EXE);
        shell.env("PYTHONPATH", harness::root().join("python"));
        shell.args(["console", "--python", python, "-c", code, "--dir"]).arg(dir);
        let said = shell.output().expect("the command is built");
        (said.status.code(), text(&said.stdout), text(&said.stderr))
    };
    let accepted = console("python3", &site.run_dir(), "print(robot.command('walk/stop'))");
    assert_eq!(accepted, (Some(0), "planner\n".into(), String::new()));
    let refused = "robot.command('walk/velocity', forward=1.9)";
    let (code, _, err) = console("python3", &site.run_dir(), refused);
    assert!(code == Some(1) && err.contains("Refused: walk/velocity refused by planner"), "{err}");
    let (code, _, err) = console("python3", &site.path("nowhere"), "1");
    assert!(code == Some(1) && err.contains("start one with `gangwerk run demo`"), "{err}");
    let (code, _, err) = console("false", &site.run_dir(), "1");
    assert!(code == Some(1) && err.contains("-m pip install ./python"), "{err}");
    assert!(run.is_alive());
}
