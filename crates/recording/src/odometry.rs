//! Believed poses for `/tf` and `/markers`, from sensors, stabilizer and plans.
//!
//! The frame is `odom`, I_0 of the plans: where the planning frame was at first. What the stabilizer says is in the planning
//! frame of the plan that it follows.

use std::collections::{BTreeMap, VecDeque};

use messages::plan::Step;
use messages::{ControllerState, Plan, Sensors};

use crate::links::RecordedPose;

/// Plans that are remembered: the stabilizer follows one of the newest.
const PLANS: usize = 16;
/// Cycles in which sensors or stabilizer were heard, and the other one not yet.
const WAITING: usize = 32;

/// Drawn part of a plan.
#[derive(Clone, Debug, Default)]
pub(crate) struct Planned {
    /// \[m\] Height of its frame.
    pub(crate) height: f64,
    /// Its steps.
    pub(crate) steps: Vec<Step>,
}

/// Puts together what belongs to one cycle, in whatever order it comes.
#[derive(Debug, Default)]
pub(crate) struct Odometry {
    plans: BTreeMap<u64, Planned>,
    sensors: VecDeque<Sensors>,
    states: VecDeque<ControllerState>,
}

impl Odometry {
    pub(crate) fn plan(&mut self, plan: &Plan) {
        let steps = plan.steps[..(plan.step_count as usize).min(plan.steps.len())].to_vec();
        self.plans.insert(plan.id, Planned { height: plan.height, steps });
        while self.plans.len() > PLANS {
            self.plans.pop_first();
        }
    }

    /// Sensors of a cycle, and the stabilizer's state if it was heard before.
    pub(crate) fn sensors(&mut self, sensors: &Sensors) -> Option<(Sensors, ControllerState)> {
        let tick = sensors.header.tick;
        if let Some(at) = self.states.iter().position(|s| s.header.tick == tick) {
            return self.states.remove(at).map(|state| (*sensors, state));
        }
        keep(&mut self.sensors, sensors);
        None
    }

    /// The other way round.
    pub(crate) fn state(&mut self, state: &ControllerState) -> Option<(Sensors, ControllerState)> {
        let tick = state.header.tick;
        if let Some(at) = self.sensors.iter().position(|s| s.header.tick == tick) {
            return self.sensors.remove(at).map(|sensors| (sensors, *state));
        }
        keep(&mut self.states, state);
        None
    }

    /// The plan that the stabilizer follows; none before the first one.
    pub(crate) fn planned(&self, state: &ControllerState) -> Planned {
        self.plans.get(&state.plan_id).cloned().unwrap_or_default()
    }
}

fn keep<T: Copy>(waiting: &mut VecDeque<T>, new: &T) {
    if waiting.len() == WAITING {
        waiting.pop_front();
    }
    waiting.push_back(*new);
}

/// odom_from_planning
pub fn planning_frame(state: &ControllerState, height: f64) -> RecordedPose {
    let [x, y, heading] = state.origin;
    frame([x, y, height, heading])
}

/// Frame with this origin \[m\] and heading \[rad\], upright.
pub fn frame([x, y, z, heading]: [f64; 4]) -> RecordedPose {
    RecordedPose { position: [x, y, z], orientation: about_z(heading) }
}

/// odom_from_torso: the inclination is the inertial measurement unit's, heading and place are those that the stabilizer
/// knows of the right sole, which is at `sole` in the torso frame.
pub fn torso(
    sensors: &Sensors,
    state: &ControllerState,
    height: f64,
    sole: &RecordedPose,
) -> Option<RecordedPose> {
    let norm = sensors.imu.orientation.iter().map(|x| x * x).sum::<f64>().sqrt();
    let imu = RecordedPose { position: [0.0; 3], orientation: sensors.imu.orientation.map(|x| x / norm) };
    let [x, y, z, heading] = state.feet[0];
    let seen = imu.then(sole);
    let turn = about_z(state.origin[2] + heading - seen.heading());
    let turned = RecordedPose { position: [0.0; 3], orientation: turn }.then(&imu);
    let at = planning_frame(state, height).place([x, y, z]);
    let lever = turned.place(sole.position);
    let torso = RecordedPose { position: std::array::from_fn(|k| at[k] - lever[k]), ..turned };
    let finite = torso.position.iter().chain(&torso.orientation).all(|x| x.is_finite());
    finite.then_some(torso)
}

fn about_z(angle: f64) -> [f64; 4] {
    let (sin, cos) = (0.5 * angle).sin_cos();
    [0.0, 0.0, sin, cos]
}
