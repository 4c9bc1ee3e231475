//! Measurement: the whole robot walks in one process, and it is seen whether it makes the planned steps.

use std::path::Path;

use chain::Chain;
use chain::ending::Ending;
use config::pattern::Pattern;
use config::{Gait, Setup};
use messages::command::VelocityCommand;
use messages::{Command, GaitState, JointTargets, MAX_JOINTS, SimState};

use super::TILT;
use crate::{Error, undisturbed};

/// \[s\] The walk begins; the robot stands still at the end of a scene, after the last double support.
pub(super) const BEGIN: f64 = 3.0;
const STAND: f64 = 3.0;
/// Steps of a trial, with the half ones out of standing and into it.
pub(super) const STEPS: u32 = 4;
/// \[m/s\] Speed of the walk under the stabilizer, and its duration \[s\].
const SLOW: f64 = 0.0208;
const SLOW_WALK: f64 = 13.0;
/// \[N\] A foot that carries less is in the air.
const CARRIES: f64 = 5.0;
/// \[s\] A foot that makes a step is in the air for longer than one that slips when it is lifted.
const SWING: f64 = 0.3;

/// Archie's own walk, open loop, with this many steps and another pattern.
pub(super) fn open_loop(config: &Path, steps: u32, change: impl Fn(&mut Pattern)) -> Result<Setup, Error> {
    let mut setup = Setup::load(config, "archie_static")?;
    let mut pattern = setup.gait.pattern.ok_or("gait archie_static has no [pattern]")?;
    change(&mut pattern);
    repattern(&mut setup, pattern, steps);
    Ok(setup)
}

/// Walks a pattern for so many steps.
pub(super) fn repattern(setup: &mut Setup, pattern: Pattern, steps: u32) {
    let step = pattern.step_time;
    setup.gait = Gait::from(pattern);
    commands(setup, pattern.length / step, f64::from(steps) * step, 1.5 * step);
    setup.scene.duration += pattern.double_support;
}

/// The same robot under the stabilizer, with force sensors and an inertial sensor, at the same speed.
pub(super) fn stabilized(config: &Path) -> Result<Setup, Error> {
    let mut setup = Setup::load(config, "archie_walk")?;
    commands(&mut setup, SLOW, SLOW_WALK, 0.0);
    Ok(setup)
}

/// Stands up, walks with `speed` \[m/s\] until `duration` \[s\] later, told to stop `ahead` \[s\] of that.
fn commands(setup: &mut Setup, forward: f64, duration: f64, ahead: f64) {
    let velocity = VelocityCommand { forward, left: 0.0, turn: 0.0 };
    let end = BEGIN + duration;
    setup.scene.commands =
        vec![(0.2, Command::Stand), (BEGIN, Command::Velocity(velocity)), (end - ahead, Command::Stop)];
    setup.scene.duration = end + STAND;
}

/// What a walk came to.
#[derive(Clone, Debug)]
pub(super) struct Walked {
    /// How it ended: "done", "fell", ...; "pattern refused" if it did not begin.
    pub(super) ended: String,
    /// \[rad\] Largest tilt of the torso.
    pub(super) tilt: f64,
    /// \[s\] When it ended.
    pub(super) time: f64,
    /// Steps that were made.
    pub(super) landings: Vec<Foothold>,
    rests: bool,
}

/// Landing of a foot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Foothold {
    /// Foot: 0 right, 1 left.
    pub(super) foot: usize,
    /// \[m\] Sole frame.
    pub(super) place: [f64; 2],
    /// \[s\] Lifted, landed.
    pub(super) lifted: f64,
    pub(super) landed: f64,
    /// \[m\] Way of the swing.
    pub(super) way: f64,
}

impl Walked {
    /// True if the planned steps were made, upright, to a stand: as many as in the walk `told`.
    pub(super) fn walked(&self, told: &Self) -> bool {
        self.ended == "done" && self.rests && self.landings.len() >= told.landings.len()
    }
}

/// Steps as they are made.
#[derive(Default)]
struct Landings {
    lifted: [Option<f64>; 2],
    last: [[f64; 2]; 2],
    made: Vec<Foothold>,
}

impl Landings {
    fn see(&mut self, s: &SimState) {
        for foot in 0..2 {
            let [x, y, ..] = s.feet[foot];
            let carries = s.foot_wrench[foot].force[2] > CARRIES;
            match self.lifted[foot] {
                _ if s.time < BEGIN => self.last[foot] = [x, y],
                None if !carries => self.lifted[foot] = Some(s.time),
                Some(lifted) if carries => {
                    self.lifted[foot] = None;
                    if s.time - lifted > SWING {
                        let way = x - self.last[foot][0];
                        self.last[foot] = [x, y];
                        self.made.push(Foothold { foot, place: [x, y], lifted, landed: s.time, way });
                    }
                }
                _ => {}
            }
        }
    }
}

/// Walks through a scene, or until the robot tilts too much or is stopped.
pub(super) fn walk(setup: &Setup) -> Walked {
    walk_with(setup, &mut |_| (), &mut |_| ())
}

/// The same, with what the controller says altered on its way to the drives, and a look at each cycle.
pub(super) fn walk_with(
    setup: &Setup,
    alter: &mut dyn FnMut(&mut JointTargets),
    look: &mut dyn FnMut(&chain::Cycle),
) -> Walked {
    let mut walked =
        Walked { ended: String::new(), tilt: 0.0, time: 0.0, landings: Vec::new(), rests: false };
    let Ok(mut chain) = Chain::new(setup) else {
        return Walked { ended: "pattern refused".into(), ..walked };
    };
    let mut ending = Ending::default();
    let mut landings = Landings::default();
    for _ in 0..(setup.scene.duration / setup.scene.cycle) as u64 {
        let cycle = chain.step_altered(alter);
        look(cycle);
        let state = &cycle.sim_state;
        ending.refused += cycle.refused;
        cycle.events.iter().for_each(|&(_, code, detail)| ending.tell(state.time, code, detail));
        let gait = GaitState::from(cycle.controller_state.gait);
        ending.see(state.time, state.power == 1, gait);
        landings.see(state);
        walked.tilt = walked.tilt.max(tilt(state));
        (walked.rests, walked.time) = (gait.rests(), state.time);
        if undisturbed::ended(cycle) || !(walked.tilt < 2.0 * TILT) {
            break;
        }
    }
    walked.landings = landings.made;
    walked.ended = match ending.end().0.to_string() {
        _ if ending.refused > 0 => "command refused".into(),
        end if end == "done" && !(walked.tilt < TILT) => "tipped over".into(),
        end => end,
    };
    walked
}

/// \[rad\] Inclination of the torso.
fn tilt(state: &SimState) -> f64 {
    let [x, y, ..] = state.orientation;
    (1.0 - 2.0 * (x * x + y * y)).clamp(-1.0, 1.0).acos()
}

/// Drives that play their targets late, each by its own time.
pub(super) struct LateDrives {
    cycle: f64,
    now: u64,
    past: Vec<JointTargets>,
}

impl LateDrives {
    /// For lags up to `most` \[s\].
    pub(super) fn new(cycle: f64, most: f64) -> Self {
        Self { cycle, now: 0, past: vec![JointTargets::default(); (most / cycle) as usize + 3] }
    }

    /// Puts what each joint was told `lag` \[s\] ago in place of what it is told now; before the first one: the first.
    pub(super) fn delay(&mut self, targets: &mut JointTargets, lag: &[f64; MAX_JOINTS]) {
        let n = self.past.len() as u64;
        if self.now == 0 {
            self.past.fill(*targets);
        }
        self.past[(self.now % n) as usize] = *targets;
        for (j, lag) in lag.iter().enumerate().filter(|(_, lag)| **lag > 0.0) {
            let cycles = (lag / self.cycle).min((n - 2) as f64);
            let (whole, part) = (cycles as u64, cycles.fract());
            let at = |back: u64| &self.past[((self.now + n - back) % n) as usize];
            let (late, later) = (at(whole), at(whole + 1));
            targets.angle[j] = late.angle[j] + part * (later.angle[j] - late.angle[j]);
            targets.speed[j] = late.speed[j] + part * (later.speed[j] - late.speed[j]);
        }
        self.now += 1;
    }
}
