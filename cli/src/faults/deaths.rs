//! Processes of the chain that die or hang while the robot walks: F1 to F4, F7, F8, F31, F33, F36.

use harness::{Signal, Site, doze};
use messages::topics::PLANNER_TICK;
use messages::{EventCode, GaitState, Process};
use realtime::{ThreadSchedule, clock, prepare_side_thread};

use super::lab::{FaultObservation, Found, Lab, limits};
use super::robot::RobotUnderTest;
use super::scene::WAIT;

/// \[cycle\] Between a decision and the robot's power line, over the bus.
const LINE: u64 = 3;
/// \[cycle\] From a stop on, all joints rest so soon: the slowest joint's rate of braking at the speeds of this walk.
const AT_REST: u64 = 150;
/// \[ms\] After which a process counts as hung, with what it takes to look and to end it.
const HUNG: [f64; 2] = [1900.0, 3500.0];
/// \[cycle\] Time until a silent operator counts as dead, and period of the check.
const LEASE: u64 = 600;

fn rests(seen: FaultObservation, robot: &RobotUnderTest, reaction: Option<u64>) -> FaultObservation {
    let soon = robot.at_rest().zip(reaction).is_some_and(|(rest, at)| rest <= at + AT_REST);
    seen.demand(soon, format!("joints at rest {AT_REST} cycles later"))
}

fn one(seen: FaultObservation, robot: &mut RobotUnderTest) -> (Vec<FaultObservation>, Option<String>) {
    (vec![seen], robot.disturbance())
}

pub(super) fn planner_killed(lab: &mut Lab) -> Found {
    let mut robot = lab.killed(lab.patient(), Process::Planner, Signal::KILL)?;
    robot.wait(40.0, |_| false);
    let told = robot.told(Process::Controller, EventCode::PlannerSilent);
    let seen = FaultObservation::new("F1", format!("told; then {:?}", robot.last_gait()))
        .after(told, &robot)
        .within(u64::from(PLANNER_TICK.stale_after) + 2)
        .demand(robot.last_gait() == GaitState::Standing, "stands in the end")
        .demand(!robot.fell(), "does not fall");
    Ok(one(seen, &mut robot))
}

pub(super) fn controller_killed(lab: &mut Lab) -> Found {
    let mut robot = lab.killed(lab.patient(), Process::Controller, Signal::KILL)?;
    robot.watch(1.0);
    let missed = limits(&robot.setup).1;
    let stop = robot.told(Process::Lowlevel, EventCode::TargetsStale);
    let seen = FaultObservation::new("F2", "controlled stop")
        .after(stop, &robot)
        .within(missed + LINE)
        .demand(robot.power_off().is_none(), "the supply stays on");
    let seen = rests(seen, &robot, stop);
    Ok(one(seen, &mut robot))
}

pub(super) fn lowlevel_killed(lab: &mut Lab) -> Found {
    // The watchdog of the shipped configuration, not a patient one: its limit is what is tried.
    let mut robot = lab.killed(Site::new(&lab.exe), Process::Lowlevel, Signal::KILL)?;
    robot.watch(1.0);
    let off = robot.power_off();
    let reason = robot.powers.iter().find(|p| p.header.tick >= robot.tick() && p.on == 0);
    let named = reason.is_some_and(|p| p.reason == EventCode::ResetMissed as u64);
    let seen = FaultObservation::new("F3", "supply cut, `ResetMissed`")
        .after(off, &robot)
        .within(limits(&robot.setup).0 + LINE)
        .demand(named, "the watchdog says why");
    let seen = rests(seen, &robot, off);
    Ok(one(seen, &mut robot))
}

/// Cycles without a moved toggle after which the relay falls.
fn quiet(robot: &RobotUnderTest) -> u64 {
    u64::from(robot.setup.system.toggle_missed)
}

pub(super) fn watchdog_killed(lab: &mut Lab) -> Found {
    // As shipped, as in F3.
    let mut robot = lab.killed(Site::new(&lab.exe), Process::Watchdog, Signal::KILL)?;
    robot.watch(1.0);
    let off = robot.power_off();
    let seen = FaultObservation::new("F4", "relay fell").after(off, &robot).within(quiet(&robot) + LINE);
    let seen = rests(seen, &robot, off);
    Ok(one(seen, &mut robot))
}

pub(super) fn watchdog_stopped(lab: &mut Lab) -> Found {
    let mut robot = lab.walking(Site::new(&lab.exe), &["--no-log"])?;
    robot.run.pause(Process::Watchdog, 0.1 + quiet(&robot) as f64 * robot.setup.scene.cycle);
    robot.watch(1.5);
    let off = robot.power_off();
    let again = robot.after().iter().skip_while(|s| s.power == 1).any(|s| s.power == 1);
    let seen = FaultObservation::new("F7", "relay fell, stayed off")
        .after(off, &robot)
        .within(quiet(&robot) + LINE)
        .demand(!again, "off until reset and enable");
    Ok(one(seen, &mut robot))
}

pub(super) fn planner_hangs(lab: &mut Lab) -> Found {
    let robot = lab.killed(lab.patient(), Process::Planner, Signal::STOP)?;
    let pid = robot.pid(Process::Planner);
    let gone =
        |_: &RobotUnderTest| pid.is_none_or(|pid| !std::path::Path::new(&format!("/proc/{pid}")).exists());
    let mut robot = robot;
    robot.wait(10.0, gone);
    let ms = robot.wall_ms();
    let mut disturbed = None;
    let said = robot.end(|robot| disturbed = robot.disturbance())?;
    let seen = FaultObservation::new("F8", "killed by the supervisor; the run ended")
        .after_ms(ms)
        .demand((HUNG[0]..HUNG[1]).contains(&ms), format!("after 2 s, not {ms:.0} ms"))
        .demand(said.code == Some(1), format!("exit code 1, not {:?}", said.code));
    Ok((vec![seen], disturbed))
}

pub(super) fn planner_crashes(lab: &mut Lab) -> Found {
    let robot = lab.walking(lab.patient(), &[])?;
    robot.run.signal(Process::Planner, Signal::ABORT);
    let (out, mut gait, mut told, mut disturbed) = (robot.site.path(""), None, None, None);
    let mut kept = false;
    let said = robot.end(|robot| {
        (gait, disturbed) = (Some(robot.last_gait()), robot.disturbance());
        told = robot.told(Process::Controller, EventCode::PlannerSilent);
        kept = record_of_crash(&out);
    })?;
    let mut seen = FaultObservation::new("F36", "as F1; the run ended as an error");
    (seen.cycles, seen.ms) = (told, told.map(|n| n as f64));
    let seen = seen
        .demand(gait == Some(GaitState::Standing), "stands in the end")
        .demand(said.code == Some(1), "exit code 1")
        .demand(kept, "a crash record of the planner is kept");
    Ok((vec![seen], disturbed))
}

/// Whether something named after a crash lies in the place of the log.
fn record_of_crash(out: &std::path::Path) -> bool {
    let entries = std::fs::read_dir(out).into_iter().flatten().flatten();
    let mut names = entries.map(|e| e.file_name().to_string_lossy().into_owned());
    names.any(|name| name.contains("crash"))
}

pub(super) fn operator_killed(lab: &mut Lab) -> Found {
    let mut robot = RobotUnderTest::start(lab.patient(), WAIT, &["--no-log"])?;
    robot.until(2.2)?;
    let dir = robot.site.run_dir().display().to_string();
    let operator = robot.site.start(&["topic", "pub", "walk/velocity", "forward=0.278", "--dir", &dir]);
    if !robot.wait(10.0, |robot| robot.gait() == GaitState::Walking) {
        return Err(format!("did not walk: {}", robot.run.err()));
    }
    robot.watch(0.3 + lab.random.share());
    robot.mark();
    operator.signal_supervisor(Signal::KILL);
    robot.wait(3.0, |robot| robot.told(Process::Planner, EventCode::LeaseLost).is_some());
    robot.wait(8.0, |robot| robot.gait() == GaitState::Standing);
    robot.watch(0.3);
    let seen = FaultObservation::new("F31", format!("{:?}", robot.gait()))
        .after(robot.told(Process::Planner, EventCode::LeaseLost), &robot)
        .within(LEASE)
        .demand(robot.gait() == GaitState::Standing, "stands")
        .demand(!robot.fell() && robot.power_off().is_none(), "on its feet, supply on");
    Ok(one(seen, &mut robot))
}

pub(super) fn spinner(lab: &mut Lab) -> Found {
    let mut robot = lab.walking(lab.patient(), &["--no-log"])?;
    let schedule = robot.setup.system.process(Process::Lowlevel).ok_or("no row of the joint loop")?;
    let place = ThreadSchedule { priority: schedule.priority, core: schedule.core };
    let spin = std::thread::spawn(move || {
        let granted = prepare_side_thread(&place);
        let until = clock::now() + clock::SECOND / 10;
        while clock::now() < until {
            std::hint::spin_loop();
        }
        granted.degraded()
    });
    doze(0.2);
    let degraded = spin.join().unwrap_or(true);
    robot.watch(1.0);
    let stop = robot.told(Process::Lowlevel, EventCode::SafeStop);
    let reaction = robot.power_off().into_iter().chain(stop).min();
    let how = if robot.power_off().is_some() { "supply off" } else { "controlled stop" };
    let seen = FaultObservation::new("F33", how)
        .after(reaction, &robot)
        .demand(!degraded, "this user may run at that priority")
        .demand(reaction.is_some(), "stops");
    Ok(one(seen, &mut robot))
}
