//! Origin of a plan: motion of the robot at the instant at which the plan takes over.

use crate::planned_walk::PlannedWalk;
use crate::pose::{PlanarPose, rotate};
use crate::steps::StepParameters;
use curves::Sample;
use messages::{BodyPoint, ControllerState, LEFT, RIGHT};
use std::f64::consts::FRAC_PI_2;

/// Motion at the begin of a plan, in its own planning frame.
#[derive(Clone, Copy, Debug)]
pub struct PlanOrigin {
    /// Planning frame in I_0.
    pub frame: PlanarPose,
    /// \[m\] Its height there.
    pub height: f64,
    /// Foot that carries the first single support; the planning frame lies below it.
    pub stance: usize,
    /// Sole frames.
    pub feet: [PlanarPose; 2],
    /// \[m\] Heights of the soles, right, left: that of the stance foot is zero.
    pub heights: [f64; 2],
    /// The point of the body that plans lead: [`messages::BodyPoint`].
    pub body: Sample<3>,
    /// Zero-moment point.
    pub zmp: [f64; 2],
    /// Upper body: inclinations and heading.
    pub torso: Sample<3>,
    /// Pitch of the soles.
    pub pitch: [Sample<1>; 2],
    /// Toe joints.
    pub toes: [Sample<1>; 2],
    /// Load factor of the left foot.
    pub load_left: f64,
    /// Parameters of the step before.
    pub previous: StepParameters,
    /// \[m\] Width with which the stance foot was placed.
    pub width: f64,
    /// \[s, m\] By how much the stance foot has touched early, and where the zero-moment point shall be then: the first
    /// double support is that much longer.
    pub early: Option<(f64, [f64; 2])>,
}

impl PlanOrigin {
    /// The active plan `walk` at `t` \[s\] with the feet at `soles` (x, y, z, heading), seen from the planning frame below
    /// the new stance foot (gap 5). The width is that of the feet unless one is given.
    pub(crate) fn on_plan(
        walk: &PlannedWalk,
        t: f64,
        soles: [[f64; 4]; 2],
        stance: usize,
        previous: StepParameters,
        width: Option<f64>,
    ) -> Self {
        let plan = &*walk.plan;
        let feet = soles.map(|p| PlanarPose::new(p[0], p[1], p[3]));
        let (frame, ground) = (feet[stance], soles[stance][2]);
        let feet = feet.map(|f| frame.relative(&f));
        // The motion goes on without a jump: position, velocity and acceleration, in the new frame.
        let mut body = plan.body.sample(t);
        let at = frame.local([body.position[0], body.position[1]]);
        let v = rotate(-frame.heading, [body.velocity[0], body.velocity[1]]);
        let a = rotate(-frame.heading, [body.acceleration[0], body.acceleration[1]]);
        body.position = [at[0], at[1], body.position[2] - ground];
        body.velocity[..2].copy_from_slice(&v);
        body.acceleration[..2].copy_from_slice(&a);
        // So does the upper body, whose heading counts from that of the stance foot.
        let mut torso = plan.torso.sample(t);
        torso.position[2] -= frame.heading;
        let [x, y, heading] = plan.origin;
        Self {
            frame: PlanarPose::new(x, y, heading).compose(&frame),
            height: plan.height + ground,
            stance,
            feet,
            heights: soles.map(|p| p[2] - ground),
            body,
            zmp: frame.local(plan.zmp.sample(t).0),
            torso,
            pitch: [0, 1].map(|i| plan.pitch[i].sample(t)),
            toes: [0, 1].map(|i| plan.toes[i].sample(t)),
            load_left: plan.load_left.sample(t).position[0],
            previous,
            width: width.unwrap_or(feet[1 - stance].y.abs()),
            early: None,
        }
    }

    /// Standing on the feet at the end of the active plan `walk`, `cycle_s` \[s\] being the length of a cycle; the step before took
    /// `duration` \[s\].
    pub(crate) fn at_rest(walk: &PlannedWalk, cycle_s: f64, stance: usize, duration: f64) -> Self {
        let t = walk.end_cycle as f64 * cycle_s;
        Self::on_plan(walk, t, walk.soles(t), stance, StepParameters::on_the_spot(duration), None)
    }

    /// The robot before its first plan, and the heights of its soles over their mean; `None` if the
    /// measurement is not finite. `point` is what its plans lead.
    pub(crate) fn measured(state: &ControllerState, point: BodyPoint) -> Option<(Self, [f64; 2])> {
        let body = match point {
            BodyPoint::CentreOfGravity => state.com,
            BodyPoint::Torso => state.torso,
        };
        let all = state.feet.iter().flatten().chain(&body).chain(&state.origin);
        if !all.into_iter().all(|x| x.is_finite()) {
            return None;
        }
        let feet = state.feet.map(|f| PlanarPose::new(f[0], f[1], f[3]));
        let ground = 0.5 * (state.feet[0][2] + state.feet[1][2]);
        // The planning frame lies below the right foot, on the mean height of both soles.
        let frame = feet[RIGHT];
        let [x, y, heading] = state.origin;
        let at = frame.local([body[0], body[1]]);
        let feet = feet.map(|f| frame.relative(&f));
        let mean = 0.5 * (feet[0].heading + feet[1].heading);
        // At rest, both feet flat: whatever else is measured is noise.
        let from = Self {
            frame: PlanarPose::new(x, y, heading).compose(&frame),
            height: 0.0,
            stance: RIGHT,
            feet,
            heights: [0.0; 2],
            body: Sample::rest([at[0], at[1], body[2] - ground]),
            zmp: at,
            torso: Sample::rest([FRAC_PI_2, FRAC_PI_2, mean]),
            pitch: [Sample::rest([0.0]); 2],
            toes: [Sample::rest([0.0]); 2],
            load_left: 0.5,
            previous: StepParameters::on_the_spot(1.0),
            width: feet[LEFT].y.abs(),
            early: None,
        };
        Some((from, state.feet.map(|f| f[2] - ground)))
    }
}
