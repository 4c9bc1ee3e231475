//! What the supervisor does when something hangs, dies, fills up or does not read: a robot in real time, and one thing wrong.

use harness::{Running, Site, WALK, doze, shared_turn, turn};
use ipc::{Reader, Space};
use messages::topics::{
    CONTROLLER_STATE, POWER, SIM_STATE, STATS_CONTROLLER, STATS_LOWLEVEL, STATS_PLANNER, STATS_SIM_BACKEND,
    STATS_WATCHDOG,
};
use messages::{ControllerState, CycleStats, GaitState, Power, Process, SimState};
use realtime::clock;
use rustix::process::{Pid, Resource, Rlimit, Signal, getrlimit, prlimit};
use std::fs::{self, File};
use std::io::{Read, Write};
use std::process::{Child, Command, Stdio};

const EXE: &str = harness::executable!();

/// Lola stands up and waits.
const WAIT: &str = "
[[command]]
time = 0.2
topic = \"walk/stand\"
";

/// A robot that has come to this simulated time \[s\] of a scene.
fn start(scene: &str, more: &[&str], time: f64) -> (Site, Running, Space) {
    let site = Site::patient(EXE);
    site.scene("hang", 1000.0, scene);
    let mut run = site.run("hang", more);
    let space = run.space();
    until(&mut run, &space, time);
    (site, run, space)
}

/// Ends with this exit code, and has said these words.
#[track_caller]
fn ends(run: Running, code: i32, words: &str) {
    let said = run.end();
    assert!(said.code == Some(code) && said.err.contains(words), "{code}, {words}: {said:#?}");
}

#[track_caller]
fn wait_for(run: &mut Running, what: &str, mut done: impl FnMut() -> bool) {
    let begun = clock::now();
    while !done() {
        assert!(run.is_alive(), "the run ended before {what}: {}", run.err());
        assert!(clock::now() < begun + 30 * clock::SECOND, "{what}: {}", run.err());
        doze(0.005);
    }
}

/// Waits until the run has said this.
#[track_caller]
fn wait_until_said(run: &mut Running, words: &str) {
    let begun = clock::now();
    while !run.err().contains(words) {
        assert!(run.is_alive() && clock::now() < begun + 30 * clock::SECOND, "{words}: {}", run.err());
        doze(0.005);
    }
}

/// Waits for this simulated time.
#[track_caller]
fn until(run: &mut Running, space: &Space, time: f64) {
    let mut sim: Reader<SimState> = space.reader(&SIM_STATE).unwrap();
    wait_for(run, "the time", || sim.latest().is_some_and(|s| s.time > time));
}

/// `gangwerk run` never ended with lowlevel stopped; with planner or logger stopped it ended with exit code 0.
#[test]
fn a_hung_process_is_named_and_ends_the_run() {
    let _turn = turn();
    for process in
        [Process::Lowlevel, Process::Planner, Process::Controller, Process::SimBackend, Process::Watchdog]
    {
        let (_site, run, space) = start(WAIT, &["--no-log"], 1.0);
        drop(space);
        let begun = clock::now();
        run.signal(process, Signal::STOP);
        let said = run.end();
        let seconds = (clock::now() - begun) as f64 * 1e-9;
        assert_eq!(said.code, Some(1), "{}: {said:#?}", process.name());
        let named = format!("{} hung during the run: no record of it for 2.", process.name());
        assert!(said.err.contains(&named), "{named}: {}", said.err);
        let others = said.err.lines().filter(|l| l.contains(" hung ") && !l.starts_with(process.name()));
        assert_eq!(others.count(), 0, "somebody else was blamed: {}", said.err);
        println!("{}: named, ended after {seconds:.1} s", process.name());
    }
}

#[test]
fn in_lockstep_the_one_for_whom_all_wait_is_named() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    site.edit("system.toml", "peer_timeout = 5.0", "peer_timeout = 1.0");
    site.scene("hang", 1000.0, WAIT);
    let mut run = site.run("hang", &["--lockstep", "--no-log"]);
    let space = run.space();
    until(&mut run, &space, 1.0);
    drop(space);
    run.signal(Process::Planner, Signal::STOP);
    ends(run, 1, "planner hung during the run: no record of it for 1.0 s");
}

#[test]
fn broker_and_logger_are_started_again_while_the_robot_goes_on() {
    let _turn = turn();
    let (site, mut run, space) = start(WAIT, &[], 1.0);
    let before = run.pid(Process::Broker);
    run.kill(Process::Broker);
    run.signal(Process::Logger, Signal::STOP); // hangs: killed, and started again
    wait_for(&mut run, "another broker", || {
        let pid = fs::read_to_string(site.run_dir().join("broker.lock")).unwrap_or_default();
        pid.trim().parse().is_ok_and(|pid: u32| pid != before)
    });
    // Commands get through again.
    let mut state: Reader<ControllerState> = space.reader(&CONTROLLER_STATE).unwrap();
    wait_for(&mut run, "a second part of the log", || site.path("hang.2.mcap").exists());
    let dir = site.run_dir().display().to_string();
    let mut operator: Option<Running> = None;
    wait_for(&mut run, "a walk", || {
        if operator.as_mut().is_none_or(|o| !o.is_alive()) {
            operator = Some(site.start(&["topic", "pub", "walk/velocity", "forward=0.278", "--dir", &dir]));
        }
        doze(0.2);
        state.latest().is_some_and(|s| s.gait == GaitState::Walking as u64)
    });
    run.interrupt();
    let said = run.end();
    assert_eq!(said.code, Some(1), "a death is no success: {said:#?}");
    assert!(!said.err.contains("the planner is ended"), "the new broker passes a stop on: {}", said.err);
    for named in ["broker died during the run: signal 9", "logger hung during the run"] {
        assert!(said.err.contains(named), "{named}: {}", said.err);
    }
}

/// Waits until an operator is answered.
#[track_caller]
fn wait_for_an_answer(site: &Site, run: &mut Running) {
    let config = site.config("");
    wait_for(run, "an answer", || {
        let mut publish = Command::new(EXE);
        publish.args(["topic", "pub", "head/rest", "--dir"]).arg(site.run_dir()).arg("--config").arg(&config);
        publish.output().unwrap().status.success()
    });
}

/// The executable was replaced while she walked: the next death of the broker ended the run in mid-step.
#[test]
fn a_program_that_was_removed_starts_its_broker_again() {
    let _turn = turn();
    let copy = std::env::temp_dir().join(format!("gangwerk-copy-{}", std::process::id()));
    fs::copy(EXE, &copy).unwrap();
    let site = Site::patient(copy.to_str().unwrap());
    site.scene("hang", 1000.0, WAIT);
    let mut run = site.run("hang", &["--no-log"]);
    let space = run.space();
    until(&mut run, &space, 1.0);
    fs::remove_file(&copy).unwrap();
    run.kill(Process::Broker);
    wait_for_an_answer(&site, &mut run);
}

/// So did a machine that had no descriptor, thread or memory for another broker at that moment.
#[test]
fn a_broker_that_cannot_be_started_now_is_started_later() {
    let _turn = turn();
    let (site, mut run, _space) = start(WAIT, &["--no-log"], 1.0);
    let supervisor = Pid::from_raw(run.id() as i32);
    let few = Rlimit { current: Some(16), ..getrlimit(Resource::Nofile) };
    let enough = prlimit(supervisor, Resource::Nofile, few).unwrap();
    run.kill(Process::Broker);
    wait_until_said(&mut run, "broker does not start: Too many open files");
    prlimit(supervisor, Resource::Nofile, enough).unwrap();
    wait_for_an_answer(&site, &mut run);
}

/// Somebody who traces a process and does not look. To its parent it is one that SIGKILL does not end, as one that waits for a disk.
struct Tracer(Child);

impl Tracer {
    /// None: this user may trace nobody.
    fn of(pid: u32) -> Option<Self> {
        // PTRACE_SEIZE
        let script = "import ctypes, sys, time\n\
            done = ctypes.CDLL(None).ptrace(0x4206, int(sys.argv[1]), None, None)\n\
            print(done, flush=True)\n\
            time.sleep(1000)";
        let mut python = Command::new("python3");
        python.args(["-c", script, &pid.to_string()]).stdout(Stdio::piped());
        let mut tracer = Self(python.spawn().expect("python3 is there"));
        let mut done = [0];
        tracer.0.stdout.as_mut().unwrap().read_exact(&mut done).unwrap();
        if done != *b"0" {
            harness::left_out("a process that cannot be killed: ptrace is refused");
            return None;
        }
        Some(tracer)
    }
}

impl Drop for Tracer {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The supervisor waited for a killed logger, which waited for its disk, and heard no Ctrl-C meanwhile.
#[test]
fn a_process_that_cannot_be_killed_holds_nobody_up() {
    let _turn = turn();
    let (_site, mut run, space) = start(WAIT, &[], 1.0);
    drop(space);
    let Some(_tracer) = Tracer::of(run.pid(Process::Logger)) else { return };
    run.signal(Process::Logger, Signal::STOP);
    wait_until_said(&mut run, "logger hung during the run");
    run.interrupt();
    ends(run, 1, "asked to end: the robot stops and stands first");
}

/// Nor did such a run end.
#[test]
fn a_process_that_cannot_be_killed_is_left_behind_at_the_end() {
    let _turn = turn();
    let (_site, run, space) = start(WAIT, &[], 1.0);
    drop(space);
    let Some(_tracer) = Tracer::of(run.pid(Process::Logger)) else { return };
    run.signal(Process::Logger, Signal::STOP);
    run.interrupt();
    doze(0.2);
    run.interrupt();
    ends(run, 1, "logger was killed and is not gone: it is left behind");
}

/// Ctrl-C was not heard before the robot was there: a logger that waited for its disk was given 20 s.
#[test]
fn ctrl_c_ends_a_run_that_is_still_starting() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    site.scene("hang", 1000.0, WAIT);
    assert!(Command::new("mkfifo").arg(site.path("hang.mcap")).status().unwrap().success());
    let mut run = site.run("hang", &[]);
    wait_for(&mut run, "the logger", || site.run_dir().join("logger.lock").exists());
    run.interrupt();
    ends(run, 130, "asked to end while starting");
}

/// A logger that had no time for a second lost most of it: the run is told so, and says so.
#[test]
fn missing_records_are_told_at_the_end() {
    let _turn = turn();
    let (site, run, space) = start(WAIT, &[], 1.0);
    drop(space);
    run.pause(Process::Logger, 1.0);
    site.topic(&["pub", "system/end"]).well();
    let said = run.end();
    assert!(said.err.contains("the log is not complete: "), "{}", said.err);
}

/// With the broker dead, Ctrl-C let the robot walk on for 8.6 s and then cut its supply in mid-step.
#[test]
fn ctrl_c_without_a_broker_ends_in_a_stand() {
    let _turn = turn();
    let (_site, mut run, space) = start(WALK, &["--no-log"], 5.0);
    run.signal(Process::Broker, Signal::STOP);
    run.interrupt();
    let (mut state, mut power): (Reader<ControllerState>, Reader<Power>) =
        (space.reader(&CONTROLLER_STATE).unwrap(), space.reader(&POWER).unwrap());
    let mut last = None;
    while run.is_alive() {
        if power.latest().is_some_and(|p| p.on == 1) {
            last = state.latest().map(|s| GaitState::from(s.gait));
        }
        doze(0.001);
    }
    let said = run.end();
    assert!(said.err.contains("the planner is ended"), "{}", said.err);
    assert_eq!(last, Some(GaitState::Standing), "{}", said.err);
}

#[test]
fn a_second_ctrl_c_is_an_emergency_stop() {
    let _turn = turn();
    let (_site, run, space) = start(WALK, &["--no-log"], 4.0);
    drop(space);
    run.signal(Process::Broker, Signal::STOP);
    run.interrupt();
    doze(0.2);
    run.interrupt();
    ends(run, 130, "power off at tick");
}

/// A paused terminal held up the end, `| head` aborted the supervisor.
#[test]
fn a_terminal_that_does_not_read_and_one_that_is_gone_hold_nothing_up() {
    let _turn = turn();
    for gone in [false, true] {
        let site = Site::patient(EXE);
        site.scene("hang", 1000.0, WAIT);
        let (reader, writer) = std::io::pipe().unwrap();
        if gone {
            drop(reader);
        } else {
            rustix::io::ioctl_fionbio(&writer, true).unwrap();
            while (&writer).write(&[b'x'; 512]).is_ok() {}
            rustix::io::ioctl_fionbio(&writer, false).unwrap();
            std::mem::forget(reader);
        }
        let mut run = site.run_into("hang", &["--no-log"], writer);
        let space = run.space();
        until(&mut run, &space, 1.0);
        site.topic(&["pub", "walk/velocity", "forward=0.278", "--for", "1"]).well(); // the gait changes: a line
        until(&mut run, &space, 2.5);
        assert!(run.is_alive());
        drop(space);
        run.interrupt();
        let begun = clock::now();
        let said = run.end();
        let seconds = (clock::now() - begun) as f64 * 1e-9;
        assert_eq!(said.code, Some(130), "gone: {gone}: {said:#?}");
        assert!(seconds < 14.0, "{seconds} s");
    }
}

/// A gait file saved during the start gave two processes different gaits, and the robot walked.
#[test]
fn a_file_saved_during_the_start_reaches_all_processes_or_none() {
    let _turn = turn();
    let site = Site::patient(EXE);
    site.scene("hang", 1000.0, WAIT);
    let gait = site.config("gaits/lola.toml");
    let text = fs::read_to_string(&gait).unwrap();
    let mut run = site.run("hang", &["--no-log"]);
    // The planner has read it, the controller comes later.
    while !site.run_dir().join("planner.lock").exists() && run.is_alive() {
        doze(0.001);
    }
    fs::write(&gait, text + "\n# saved\n").unwrap();
    let space = run.space();
    until(&mut run, &space, 0.5);
    let hashes = [&STATS_WATCHDOG, &STATS_SIM_BACKEND, &STATS_PLANNER, &STATS_CONTROLLER, &STATS_LOWLEVEL]
        .map(|topic| space.reader::<CycleStats>(topic).unwrap().latest().unwrap().config_hash);
    assert!(hashes.iter().all(|h| *h == hashes[0]), "{hashes:x?}");
}

/// After 59 looks that ended by Ctrl-C a topic was closed to everybody.
#[test]
fn observers_that_are_killed_leave_room_for_others() {
    let _turn = turn();
    let (site, run, space) = start(WAIT, &["--no-log"], 0.5);
    let many = std::env::var("GANGWERK_OBSERVERS").ok().and_then(|n| n.parse().ok()).unwrap_or(150);
    let before = site.shared_memory().len();
    let dir = site.run_dir();
    for n in 0..many {
        let mut child = Command::new(EXE)
            .args(["topic", "echo", "sensors", "--dir"])
            .arg(&dir)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut byte = [0];
        let read = child.stdout.as_mut().unwrap().read(&mut byte).unwrap();
        if read == 0 {
            let mut text = String::new();
            child.stderr.as_mut().unwrap().read_to_string(&mut text).unwrap();
            panic!("observer {n}: {text}");
        }
        child.kill().unwrap();
        child.wait().unwrap();
    }
    let mut sim: Reader<SimState> = space.reader(&SIM_STATE).unwrap();
    assert!(sim.latest().is_some_and(|s| s.power == 1), "{}", run.err());
    // The supervisor clears the dead away once a second.
    let left = (0..100).map(|_| {
        doze(0.1);
        site.shared_memory().len()
    });
    let left = left.min().unwrap();
    println!("{many} observers: {before} objects before, {left} after");
    assert!(left <= before, "{left} objects in shared memory, {before} before");
}

/// What a run with a small disk does, in a mount namespace of its own: this test again, as a process of its own.
#[test]
fn inside_a_small_disk() {
    let Some(disk) = std::env::var_os("GANGWERK_SMALL_DISK") else { return };
    let site = Site::patient(EXE);
    site.scene("full", 4.0, WAIT);
    let dir = site.run_dir().display().to_string();
    let out = disk.to_str().unwrap();
    let said = site.gangwerk(&["run", "full", "--dir", &dir, "--out", out, "--no-plots"]);
    assert_eq!(said.code, Some(1), "{said:#?}");
    assert!(said.err.contains("the log is not complete"), "{said:#?}");
    assert!(said.out.contains("INCOMPLETE") || said.out.is_empty(), "{said:#?}");
    println!("the small disk was full");
}

/// A full disk ended with exit code 0 and figures of the first 1.9 s of 9.5 s.
#[test]
fn a_full_disk_is_no_success_and_its_figures_say_so() {
    let _turn = turn();
    let disk = std::env::temp_dir().join(format!("gangwerk-small-disk-{}", std::process::id()));
    fs::create_dir_all(&disk).unwrap();
    let script =
        "mount -t tmpfs -o size=3m tmpfs \"$1\" && exec \"$0\" --exact inside_a_small_disk --nocapture";
    let done = Command::new("unshare")
        .args(["--mount", "--propagation", "private", "sh", "-c", script])
        .arg(std::env::current_exe().unwrap())
        .arg(&disk)
        .env("GANGWERK_SMALL_DISK", &disk)
        .output();
    let _ = fs::remove_dir(&disk);
    let done = match done {
        Ok(done) => done,
        Err(e) => return harness::left_out(&format!("a full disk: {e}")),
    };
    let (out, err) = (String::from_utf8_lossy(&done.stdout), String::from_utf8_lossy(&done.stderr));
    if err.starts_with("unshare:") || err.starts_with("mount:") {
        return harness::left_out(&format!("a full disk: {err}"));
    }
    assert!(done.status.success() && out.contains("the small disk was full"), "{out} {err}");
}

#[test]
fn a_result_that_cannot_be_written_is_an_error_and_no_panic() {
    let site = Site::patient(EXE);
    site.scene("short", 0.05, "");
    let config = site.config("");
    let done = Command::new(EXE)
        .args(["sim", "short", "--json", "--config"])
        .arg(config)
        .stdout(File::options().write(true).open("/dev/full").unwrap())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(1), "{said}");
    assert!(said.contains("standard output") && !said.contains("panicked"), "{said}");
}
