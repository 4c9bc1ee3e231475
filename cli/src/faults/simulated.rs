//! Faults in simulated time, every process waiting for the others: F15 to F17, F39, F40.

use harness::{Signal, doze};
use messages::{EventCode, GaitState, Process};

use super::lab::{FaultObservation, Found, Lab};
use super::robot::RobotUnderTest;
use super::scene::bus;

const LOCKSTEP: [&str; 2] = ["--lockstep", "--no-log"];
/// \[cycle\] A shorted line is off in its first cycle; the supply goes off over the bus.
const SHORTED: u64 = 3;
/// \[s\] Between the faults of the bus, each a second long.
const APART: f64 = 1.6;

pub(super) fn bus_faults(lab: &mut Lab) -> Found {
    let first = lab.instant();
    let times = [first, first + APART, first + 2.0 * APART];
    let mut robot = RobotUnderTest::start(lab.patient(), &bus(times), &LOCKSTEP)?;
    let mut found = Vec::new();
    let told = [("F16", EventCode::FramesLost), ("F17", EventCode::FrameRefused)];
    for (time, (fault, code)) in times.into_iter().zip(told) {
        at(&mut robot, time)?;
        robot.until(time + 0.9 * APART)?;
        let seen =
            FaultObservation::new(fault, "walks on").after(robot.told(Process::Lowlevel, code), &robot);
        found.push(
            seen.demand(robot.told(Process::Lowlevel, code).is_some(), format!("{code:?}")).walks(&robot),
        );
    }
    at(&mut robot, times[2])?;
    robot.until(times[2] + 0.2)?;
    let off = robot.told(Process::Lowlevel, EventCode::BusOff);
    let seen =
        FaultObservation::new("F15", "`BusOff`, supply cut").after(robot.power_off(), &robot).within(SHORTED);
    found.push(seen.demand(off.is_some(), "BusOff"));
    Ok((found, None))
}

/// The records since this simulated time are those after the fault.
fn at(robot: &mut RobotUnderTest, time: f64) -> Result<(), String> {
    robot.until(time)?;
    robot.mark_at(time);
    Ok(())
}

pub(super) fn dead_peer(lab: &mut Lab) -> Found {
    let site = lab.patient();
    site.edit("system.toml", "peer_timeout = 5.0", "peer_timeout = 1.0");
    let robot = lab.walking(site, &LOCKSTEP)?;
    robot.run.kill(Process::SimBackend);
    let mut ms = 0.0;
    let said = robot.end(|robot| ms = robot.wall_ms())?;
    let seen = FaultObservation::new("F39", "the run ended").after_ms(ms);
    Ok((vec![seen.demand(said.code == Some(1), format!("exit code 1, not {:?}", said.code))], None))
}

pub(super) fn signals(lab: &mut Lab) -> Found {
    let mut seen = FaultObservation::new("F40", "stood, ended with 130");
    for signal in [Signal::INT, Signal::TERM, Signal::HUP] {
        let robot = lab.walking(lab.patient(), &LOCKSTEP)?;
        robot.run.signal_supervisor(signal);
        let dir = robot.site.path("");
        let (mut gait, mut fell) = (GaitState::Idle, true);
        let said = robot.end(|robot| (gait, fell) = (robot.last_gait(), robot.fell()))?;
        doze(0.05);
        seen = seen
            .demand(said.code == Some(130), format!("{signal:?}: exit code 130, not {:?}", said.code))
            .demand(gait == GaitState::Standing && !fell, format!("{signal:?}: stands before the end"))
            .demand(!dir.join("run").exists(), format!("{signal:?}: nothing left behind"));
    }
    Ok((vec![seen], None))
}
