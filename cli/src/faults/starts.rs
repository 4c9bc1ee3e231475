//! Runs that must not start, and runs that must start all the same: F19, F22 to F25, F28, F34, F35, F37.

use harness::{Running, Said, Signal, Site, doze};
use messages::Process;
use realtime::clock;

use super::lab::{FaultObservation, Found, Lab};
use super::robot::RobotUnderTest;
use super::scene::WAIT;

/// \[ms\] In which no process is left after the supervisor's death.
const ENDED: f64 = 500.0;
/// \[s\] Of a short run.
const SHORT: f64 = 2.5;
/// \[s\] Since the machine is said to be up.
const UPTIME: &str = "300000000";

/// A short run of a standing robot under a wrapper; how long it took \[ms\] and what it said.
fn short(site: &Site, wrapper: &[&str], more: &[&str]) -> Result<(f64, Said), String> {
    site.scene("fault", SHORT, WAIT);
    let arguments = site.run_arguments("fault", more);
    let begun = clock::now();
    let run = site.start_under(wrapper, &arguments.iter().map(String::as_str).collect::<Vec<_>>());
    let said = run.try_end()?;
    Ok(((clock::now() - begun) as f64 * 1e-6, said))
}

/// Refused for the reason that was given to it: there is no record of a run that did not start, only what it says.
fn refused(fault: &'static str, reason: &str, (ms, said): (f64, Said)) -> Found {
    let seen = FaultObservation::new(fault, "refused")
        .after_ms(ms)
        .demand(said.code == Some(1), format!("exit code 1, not {:?}", said.code))
        .demand(said.err.contains(reason), format!("says `{reason}`, not {:?}", said.err));
    Ok((vec![seen], None))
}

pub(super) fn unknown_key(lab: &mut Lab) -> Found {
    let site = lab.patient();
    site.edit("gaits/lola.toml", "swing_height", "swing_heigth");
    refused("F22", "swing_heigth", short(&site, &[], &["--no-log"])?)
}

pub(super) fn few_descriptors(lab: &mut Lab) -> Found {
    refused("F34", "open files", short(&lab.patient(), &["prlimit", "--nofile=16"], &["--no-log"])?)
}

/// Runs a script in a mount namespace of its own, which then becomes the run.
fn in_mounts(script: &str) -> [String; 8] {
    ["unshare", "--mount", "--propagation", "private", "sh", "-c", script, "sh"].map(str::to_owned)
}

pub(super) fn full_memory(lab: &mut Lab) -> Found {
    let site = lab.patient();
    site.scene("fault", SHORT, WAIT);
    // The place of the run lies in /dev/shm: it moves to the small one, which is then filled.
    let (place, copy) =
        (site.path("").display().to_string(), format!("/tmp/gangwerk-faults-{}", std::process::id()));
    let script = format!(
        "cp -r {place} {copy} && mount -t tmpfs -o size=8m tmpfs /dev/shm && mv {copy} {place} && \
         {{ dd if=/dev/zero of=/dev/shm/fill bs=4k 2>/dev/null; exec \"$@\"; }}"
    );
    let wrapper = in_mounts(&script);
    refused(
        "F24",
        "No space left on device",
        short(&site, &wrapper.each_ref().map(String::as_str), &["--no-log"])?,
    )
}

pub(super) fn full_disk(lab: &mut Lab) -> Found {
    let site = lab.patient();
    let disk = site.path("disk").display().to_string();
    site.scene("fault", 5.0, WAIT);
    std::fs::create_dir_all(&disk).map_err(|e| e.to_string())?;
    let wrapper = in_mounts(&format!("mount -t tmpfs -o size=3m tmpfs {disk} && exec \"$@\""));
    let dir = site.run_dir().display().to_string();
    let arguments = ["run", "fault", "--dir", &dir, "--out", &disk, "--no-plots"];
    let run = site.start_under(&wrapper.each_ref().map(String::as_str), &arguments);
    let mut robot = RobotUnderTest::of(site, run)?;
    robot.until(0.5)?;
    robot.mark();
    let (mut upright, mut disturbed) = (false, None);
    let said = robot.end(|robot| {
        // The end of the scene cuts the supply, too.
        upright = !robot.fell() && robot.time() > 4.5;
        disturbed = robot.disturbance();
    })?;
    let seen = FaultObservation::new("F23", "stands to the end; exit code 1")
        .demand(upright, "the robot does not notice")
        .demand(said.code == Some(1), format!("exit code 1, not {:?}", said.code));
    Ok((vec![seen], disturbed))
}

pub(super) fn long_up(lab: &mut Lab) -> Found {
    let wrapper = ["unshare", "--time", "--fork", "--kill-child", "--monotonic", UPTIME, "--"];
    let code = short(&lab.patient(), &wrapper, &["--no-log"])?.1.code;
    let seen = FaultObservation::new("F19", "stood up, ended by itself");
    Ok((vec![seen.demand(code == Some(0), format!("exit code 0, not {code:?}"))], None))
}

pub(super) fn no_rights(lab: &mut Lab) -> Found {
    let site = lab.patient();
    site.scene("fault", SHORT, WAIT);
    let arguments = site.run_arguments("fault", &["--no-log"]);
    let limits =
        "ulimit -l 64; ulimit -r 0; exec setpriv --bounding-set -sys_nice,-ipc_lock,-sys_resource \"$@\"";
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let run = site.start_under(&["sh", "-c", limits, "sh"], &arguments);
    let mut robot = RobotUnderTest::of(site, run)?;
    robot.until(1.5)?;
    let degraded = robot.degraded();
    let said = robot.end(|_| ())?;
    let seen = FaultObservation::new("F35", "runs, degraded")
        .demand(degraded, "says so")
        .demand(said.code == Some(0), format!("exit code 0, not {:?}", said.code));
    Ok((vec![seen], None))
}

/// The planner is killed as soon as it is there: the joint loop comes after it.
pub(super) fn death_at_start(lab: &mut Lab) -> Found {
    let site = lab.patient();
    site.scene("fault", SHORT, WAIT);
    let mut run: Running = site.run("fault", &["--no-log"]);
    let begun = clock::now();
    while !site.run_dir().join("planner.lock").exists() && run.is_alive() {
        doze(0.0005);
    }
    run.kill(Process::Planner);
    let code = run.try_end()?.code;
    let armed = site.run_dir().join("lowlevel.lock").exists();
    let seen = FaultObservation::new("F28", "the joint loop was never started")
        .after_ms((clock::now() - begun) as f64 * 1e-6)
        .demand(code == Some(1), format!("exit code 1, not {code:?}"))
        .demand(!armed, "never armed");
    Ok((vec![seen], None))
}

/// F37, and F25 after it.
pub(super) fn supervisor_killed(lab: &mut Lab) -> Found {
    let mut robot = lab.walking(lab.patient(), &["--no-log"])?;
    let pids: Vec<u32> = Process::ALL.iter().filter_map(|p| robot.pid(*p)).collect();
    robot.run.signal_supervisor(Signal::KILL);
    let lives = |pid: &u32| {
        let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
        !stat.is_empty() && !stat.contains(") Z ")
    };
    while pids.iter().any(lives) && robot.wall_ms() < 4.0 * ENDED {
        robot.look();
        doze(0.002);
    }
    let ms = robot.wall_ms();
    let ended = FaultObservation::new("F37", "all ended")
        .after_ms(ms)
        .demand(ms <= ENDED, format!("within {ENDED} ms"));
    let disturbed = robot.disturbance();
    let site = robot.into_site();
    let (ms, said) = short(&site, &[], &["--no-log"])?;
    let code = said.code;
    let left = site.shared_memory();
    let cold = FaultObservation::new("F25", "started, ended, nothing left")
        .after_ms(ms)
        .demand(code == Some(0), format!("exit code 0, not {code:?}"))
        .demand(left.is_empty(), format!("nothing left behind, not {left:?}"));
    Ok((vec![ended, cold], disturbed))
}
