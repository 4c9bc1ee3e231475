//! Simulated time is the same however it is computed: one process or all, one core or two, today or again.
//!
//! Compared are the hashes of all payloads of every channel, but for those that speak of wall time (cycle statistics)
//! or of what a single process does not have: broker and logger, and what passes between processes.

use harness::{Said, Site, doze};
use ipc::Reader;
use messages::topics::SIM_STATE;
use messages::{Process, SimState};
use realtime::clock;
use recording::{Log, payload_hashes};
use rustix::process::Signal;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const EXE: &str = harness::executable!();

/// Standing up, three steps, a point to look at, an order that the head refuses, a push, a bus with faults.
const SCENE: &str = "
[[command]]
time = 0.2
topic = \"walk/stand\"
[[command]]
time = 2.4
topic = \"walk/velocity\"
forward = 0.278
[[command]]
time = 2.6
topic = \"head/fixate\"
x = 2.0
y = 1.0
z = 1.0
[[command]]
time = 4.0
topic = \"head/joints\"
pan = 2.0
[[push]]
time = 4.5
duration = 0.1
force = [0.0, 20.0, 0.0]
[[bus_fault]]
time = 3.0
duration = 1.0
kind = \"lost\"
share = 0.02
[[bus_fault]]
time = 3.5
duration = 0.2
kind = \"late\"
share = 0.1
cycles = 2
[[bus_fault]]
time = 4.0
duration = 0.005
kind = \"pulled\"
node = \"shank_right\"
";
const SECONDS: f64 = 6.0;

type Hashes = BTreeMap<String, u64>;

fn site() -> Site {
    let site = Site::new(EXE);
    site.scene("walk", SECONDS, SCENE);
    site
}

fn hashes(log: &Path) -> Hashes {
    let left_out = [
        "/gangwerk/cycle_stats/",
        "/gangwerk/cycle_inputs/",
        "/gangwerk/commands/",
        "/gangwerk/frames_",
        "/gangwerk/watchdog_reset",
        "/gangwerk/events/broker",
        "/gangwerk/events/logger",
        "/rosout", // speaks of these two, too
    ];
    payload_hashes(log, |channel| !left_out.iter().any(|name| channel.starts_with(name))).unwrap()
}

/// The scene was done, but for the order that the head refuses.
#[track_caller]
fn refused(said: &Said) {
    assert_eq!(said.code, Some(4), "{said:#?}");
}

/// The log of `gangwerk sim`.
fn sim(site: &Site) -> Hashes {
    let log = site.path("sim.mcap");
    refused(&site.gangwerk(&["sim", "walk", "--log", &log.display().to_string()]));
    hashes(&log)
}

/// The log of `gangwerk run --lockstep` on these cores.
fn run(site: &Site, cores: &[usize]) -> Hashes {
    let arguments = site.run_arguments("walk", &["--lockstep"]);
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    refused(&site.start_on(cores, &arguments).end());
    hashes(&site.path("walk.mcap"))
}

/// Names of the channels that are not the same in both.
fn different(a: &Hashes, b: &Hashes) -> Vec<String> {
    let names = a.keys().chain(b.keys()).cloned().collect::<std::collections::BTreeSet<_>>();
    names.into_iter().filter(|name| a.get(name) != b.get(name)).collect()
}

#[test]
fn one_process_and_all_processes_write_the_same_log_on_one_core_and_on_two() {
    let site = site();
    let alone = sim(&site);
    assert_eq!(different(&alone, &sim(&site)), [""; 0], "twice alone");
    for cores in [&[0][..], &[0, 1], &[0, 1]] {
        assert_eq!(
            different(&alone, &run(&site, cores)),
            [""; 0],
            "alone, and all processes on cores {cores:?}"
        );
    }
}

/// The model is chosen before the processes begin, and all of them get the same.
#[test]
fn a_scene_that_leaves_the_model_open_is_the_same_in_one_process_and_in_all() {
    let site = site();
    let text = std::fs::read_to_string(site.config("scenes/walk.toml")).unwrap();
    let auto = "depth = \"auto\"\ntolerance = { inclination = 0.05, trial = 0.5 }";
    let text = text.replace("depth = 1\nintegrator = \"euler\"\nsubsteps = 4", auto);
    std::fs::write(site.config("scenes/walk.toml"), text).unwrap();
    assert_eq!(different(&sim(&site), &run(&site, &[0, 1])), [""; 0]);
}

/// What the robot does never waits for who only passes on, looks or writes down: killed at three instants each, nobody acts
/// otherwise by a bit.
#[test]
fn without_broker_observer_or_logger_the_robot_does_the_same_bit_by_bit() {
    let site = site();
    let alone = sim(&site);
    let wanted = acts(&[site.path("sim.mcap")]);
    for (victim, time) in [Some(Process::Broker), None, Some(Process::Logger)].iter().zip([0.9, 3.1, 4.6]) {
        let mut run = site.run("walk", &["--lockstep"]);
        let space = run.space();
        let mut state: Reader<SimState> = space.reader(&SIM_STATE).unwrap();
        let observer =
            site.start(&["topic", "echo", "sensors", "--dir", &site.run_dir().display().to_string()]);
        while state.latest().is_none_or(|s| s.time < time) {
            assert!(run.is_alive(), "{}", run.err());
            doze(0.001);
        }
        match victim {
            Some(process) => run.kill(*process),
            None => observer.signal_supervisor(Signal::KILL),
        }
        let said = run.end();
        assert_eq!(said.code, Some(if victim.is_some() { 1 } else { 4 }), "a death is no success: {said:#?}");
        let parts = [site.path("walk.mcap"), site.path("walk.2.mcap")];
        if *victim == Some(Process::Logger) {
            // What was written before it died, and by the one after it.
            let found = acts(&parts);
            assert!(found.len() > wanted.len() / 2, "{} of {} records", found.len(), wanted.len());
            assert!(found.iter().all(|(at, payload)| wanted.get(at) == Some(payload)));
            assert!(found.keys().last() == wanted.keys().last(), "to the end");
        } else {
            assert_eq!(different(&alone, &hashes(&parts[0])), [""; 0], "{victim:?}");
        }
    }
}

/// Paced, a machine that is late slows the robot down: the same bits, in no less time than the scene has.
#[test]
fn paced_a_process_that_is_stopped_costs_time_and_nothing_else() {
    let site = site();
    let alone = sim(&site);
    let begun = clock::now();
    let mut run = site.run("walk", &["--lockstep", "--paced"]);
    drop(run.space()); // on a busy machine it takes a while until all are there
    for process in [Process::Planner, Process::Lowlevel, Process::SimBackend] {
        doze(1.0);
        run.signal(process, Signal::STOP);
        doze(0.3);
        run.signal(process, Signal::CONT);
    }
    refused(&run.end());
    let took = (clock::now() - begun) as f64 * 1e-9;
    assert!(took > SECONDS, "{took} s for {SECONDS} s");
    assert_eq!(different(&alone, &hashes(&site.path("walk.mcap"))), [""; 0]);
}

/// In whatever order the processes come, they wait for each other, and what they do is the same.
#[test]
fn any_order_of_starting_gives_the_same_walk() {
    let site = site();
    let alone = sim(&site);
    let mut order = Process::ALL.map(Process::name);
    let shipped = order.map(|name| format!("\"{name}\"")).join(", ");
    let mut before = shipped;
    for seed in 1..=4_u64 {
        // Fisher and Yates, by a linear congruential generator.
        let mut state = seed;
        for i in (1..order.len()).rev() {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            order.swap(i, (state >> 33) as usize % (i + 1));
        }
        let now = order.map(|name| format!("\"{name}\"")).join(", ");
        site.edit("system.toml", &before, &now);
        before = now;
        let mut changed = different(&alone, &run(&site, &[0, 1]));
        // It carries the time of the first record that its logger saw.
        changed.retain(|name| name != "/robot_description");
        assert_eq!(changed, [""; 0], "{before}");
    }
}

/// Records of what the chain did, by channel and time \[ns\].
fn acts(parts: &[PathBuf]) -> BTreeMap<(u64, String), Vec<u8>> {
    let mut found = BTreeMap::new();
    for part in parts {
        let end = Log::open(part).unwrap().each(|m| {
            if ["/gangwerk/joint_targets", "/gangwerk/sim_state"].contains(&m.channel) {
                found.insert((m.log_time_ns, m.channel.into()), m.payload.to_vec());
            }
        });
        end.unwrap();
    }
    found
}

/// What the comparison is worth: the whole chain is in it, and every cycle.
#[test]
fn the_log_that_is_compared_holds_every_cycle_of_the_chain() {
    let site = site();
    let alone = sim(&site);
    for topic in ["sensors", "plan", "joint_targets", "controller_state", "power", "sim_state"] {
        assert!(alone.contains_key(&format!("/gangwerk/{topic}")), "{topic} of {:?}", alone.keys());
    }
    for process in ["watchdog", "sim_backend", "planner", "controller", "lowlevel"] {
        assert!(
            alone.contains_key(&format!("/gangwerk/events/{process}")),
            "{process} of {:?}",
            alone.keys()
        );
    }
    let mut count = BTreeMap::<String, u64>::new();
    let log = Log::open(&site.path("sim.mcap")).unwrap();
    log.each(|message| *count.entry(message.channel.to_owned()).or_default() += 1).unwrap();
    for topic in ["sensors", "joint_targets", "controller_state", "power", "sim_state"] {
        assert_eq!(count[&format!("/gangwerk/{topic}")], (SECONDS * 1e3) as u64, "{topic}");
    }
}

/// The comparison sees a foot lifted by a millionth of a metre more.
#[test]
fn a_micrometre_of_swing_height_changes_the_log() {
    let (a, b) = (site(), site());
    b.edit("gaits/lola.toml", "swing_height = 0.055", "swing_height = 0.055001");
    let changed = different(&sim(&a), &run(&b, &[0, 1]));
    for topic in ["plan", "joint_targets", "sensors", "sim_state"] {
        assert!(changed.contains(&format!("/gangwerk/{topic}")), "{topic} of {changed:?}");
    }
}

/// And a push of a thousandth of a newton for a thousandth of a second.
#[test]
fn a_micronewtonsecond_changes_the_log() {
    let (a, b) = (site(), site());
    b.edit("scenes/walk.toml", "force = [0.0, 20.0, 0.0]", "force = [0.0, 20.001, 0.0]");
    b.edit("scenes/walk.toml", "duration = 0.1\n", "duration = 0.001\n");
    a.edit("scenes/walk.toml", "duration = 0.1\n", "duration = 0.001\n");
    let changed = different(&sim(&a), &sim(&b));
    for topic in ["joint_targets", "sensors", "sim_state"] {
        assert!(changed.contains(&format!("/gangwerk/{topic}")), "{topic} of {changed:?}");
    }
    assert!(!changed.contains(&"/gangwerk/power".to_owned()), "{changed:?}");
}
