//! Random kills and stops: process, instant and duration drawn from a seed, one run each.
//!
//! Whatever was hurt: the supply does not come back by itself, and the robot walks on, stands, or its joints come to rest.

use messages::{GaitState, Process};

use super::lab::{Lab, Random};

use Process::{Broker, Controller, Logger, Lowlevel, Planner, Watchdog};

/// \[s\] For which a process is stopped.
const STOPS: [f64; 7] = [0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 1.0];
/// \[s\] After which the robot is judged.
const WATCHED: f64 = 2.5;

/// Actions of a trial, and their failures.
#[derive(Clone, Debug)]
pub struct LongTrial {
    /// Fault injected.
    pub what: String,
    /// Failures; empty if none.
    pub wrong: Vec<String>,
}

/// `count` trials with what they were, one after the other.
pub fn long(exe: &str, seed: u64, count: u32) -> impl Iterator<Item = LongTrial> {
    let mut lab = Lab { exe: exe.to_owned(), random: Random(seed) };
    (0..count).map(move |_| {
        let victim = lab.random.one_of(&[Planner, Controller, Lowlevel, Watchdog, Broker, Logger]);
        let stop = (lab.random.share() < 0.5).then(|| lab.random.one_of(&STOPS));
        let how = stop.map_or("killed".into(), |s| format!("stopped for {:.0} ms", s * 1e3));
        let what = format!("{} {how}", victim.name());
        let wrong = trial(&mut lab, victim, stop).unwrap_or_else(|error| vec![error]);
        LongTrial { what, wrong }
    })
}

fn trial(lab: &mut Lab, victim: Process, stop: Option<f64>) -> Result<Vec<String>, String> {
    let mut robot = lab.walking(lab.patient(), &[])?;
    match stop {
        Some(seconds) => robot.run.pause(victim, seconds),
        None => robot.run.kill(victim),
    }
    robot.watch(WATCHED);
    let mut wrong = Vec::new();
    let off = robot.after().iter().position(|s| s.power == 0);
    if off.is_some_and(|off| robot.after()[off..].iter().any(|s| s.power == 1)) {
        wrong.push("the supply came back by itself".into());
    }
    let goes_on = matches!(robot.gait(), GaitState::Walking | GaitState::Stopping | GaitState::Standing);
    let upright = goes_on && off.is_none() && !robot.fell();
    if !upright && robot.at_rest().is_none() {
        wrong.push(format!("neither goes on nor comes to rest: {:?}", robot.gait()));
    }
    Ok(wrong)
}
