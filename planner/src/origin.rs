//! Origin of a plan: motion of the robot at the instant at which the plan takes over.

use crate::planned_walk::PlannedWalk;
use crate::pose::{PlanarPose, rotate};
use crate::sole::Sole;
use crate::steps::{StepParameters, Stride};
use crate::touchdown::lowered;
use curves::Sample;
use messages::{BodyPoint, ControllerState, LEFT, RIGHT};
use multibody::GRAVITY_ACCELERATION as GRAVITY;
use std::f64::consts::FRAC_PI_2;

/// \[rad\] Inclination up to which a robot that stands is upright: so much may be an error of measurement.
const LEVEL: f64 = 0.02;

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
    /// The step that the plan begins with, if it is given; none: it begins with a double support, and steps are free.
    pub inside: Option<RunningStep>,
}

/// Measurement that a plan begins from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measured<'a> {
    pub(crate) state: &'a ControllerState,
    /// \[m\] Zero-moment point.
    pub(crate) zmp: [f64; 2],
    /// \[s\] Time from the measurement to the begin of the plan.
    pub(crate) ahead: f64,
}

/// A step whose landing is decided.
#[derive(Clone, Copy, Debug)]
pub struct RunningStep {
    /// The step; what of it lies before the begin of the plan has negative times.
    pub stride: Stride,
    /// Footprint of the swing foot.
    pub swing: Sample<4>,
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
        let body = seen(&frame, ground, &plan.body.sample(t));
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
            inside: None,
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
        let all =
            state.feet.iter().flatten().chain(&body).chain(&state.origin).chain(&state.inclination_error);
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
        // At rest, both feet flat, upright but on a slope: whatever else is measured is noise.
        let lean = state.inclination_error;
        let leans = point == BodyPoint::CentreOfGravity && lean.iter().any(|x| x.abs() > LEVEL);
        let [x_lean, y_lean] = lean.map(|x| if leans { FRAC_PI_2 - x } else { FRAC_PI_2 });
        let from = Self {
            frame: PlanarPose::new(x, y, heading).compose(&frame),
            height: 0.0,
            stance: RIGHT,
            feet,
            heights: [0.0; 2],
            body: Sample::rest([at[0], at[1], body[2] - ground]),
            zmp: at,
            torso: Sample::rest([x_lean, y_lean, mean]),
            pitch: [Sample::rest([0.0]); 2],
            toes: [Sample::rest([0.0]); 2],
            load_left: 0.5,
            previous: StepParameters::on_the_spot(1.0),
            width: feet[LEFT].y.abs(),
            early: None,
            inside: None,
        };
        Some((from, state.feet.map(|f| f[2] - ground)))
    }

    /// The robot as it is measured, inside the single support of step `k` of the active plan `walk`, at `t` \[s\]; its foot lands at
    /// `landing` (@frame of that plan) after `cycles` of `cycle_s` \[s\].
    ///
    /// A robot whose joints are led errs by turning about its stance sole: the upper body leans, and everything else with it.
    /// So the plan begins leaning; joints go on where they are.
    /// Seen from the stance foot she has the height that it was put lower by: the plan lies that much lower.
    pub(crate) fn inside(
        walk: &PlannedWalk,
        (k, t): (usize, f64),
        Measured { state, zmp, ahead }: Measured<'_>,
        landing: &PlanarPose,
        (cycles, cycle_s): (u64, f64),
    ) -> Self {
        let (plan, s) = (&*walk.plan, &walk.strides[k]);
        let swing = 1 - s.stance;
        let body = fallen_on(state, zmp, s.heights.foothold, ahead);
        let torso = leaning(state, &plan.torso.sample(t), ahead);
        let rate = state.inclination_rate_error;
        // Swing foot: displaced as it is measured, and turned about the stance foot with everything else.
        let foot = plan.feet[swing].sample(t);
        let arm: [f64; 3] = std::array::from_fn(|d| state.feet[swing][d] - state.feet[s.stance][d]);
        let (sin, cos) = torso.position[2].sin_cos();
        let (roll, pitch) = (rate[1], -rate[0]);
        let omega = [cos * roll - sin * pitch, sin * roll + cos * pitch];
        let drift = [omega[1] * arm[2], -omega[0] * arm[2], omega[0] * arm[1] - omega[1] * arm[0]];
        let mut moved = foot;
        for d in 0..3 {
            moved.position[d] += state.feet[swing][d] - state.feet_desired[swing][d] + ahead * drift[d];
            moved.velocity[d] += drift[d];
        }

        // All of it seen from below the stance foot.
        let mut soles = walk.soles(t);
        soles[swing] = moved.position;
        let previous = s.parameters;
        let mut from = Self::on_plan(walk, t, soles, s.stance, previous, Some(s.width));
        let stance = soles[s.stance];
        let frame = PlanarPose::new(stance[0], stance[1], stance[3]);
        from.body = seen(&frame, stance[2], &body);
        from.zmp = frame.local(zmp);
        from.torso = torso;
        from.torso.position[2] -= frame.heading;
        from.height += lowered(state, s.stance);
        let stride = Stride {
            begin: s.begin - t,
            lift: s.lift - t,
            end: cycles as f64 * cycle_s,
            end_cycle: cycles,
            landing: frame.relative(landing),
            ..s.seen(&frame, stance[2])
        };
        let flat =
            |v: [f64; 4]| Sample { position: [v[0], v[1], v[2]], velocity: [0.0; 3], acceleration: [0.0; 3] };
        let turned = seen(
            &frame,
            stance[2],
            &Sample {
                velocity: [moved.velocity[0], moved.velocity[1], moved.velocity[2]],
                acceleration: [moved.acceleration[0], moved.acceleration[1], moved.acceleration[2]],
                ..flat(moved.position)
            },
        );
        let with = |a: [f64; 3], heading: f64| [a[0], a[1], a[2], heading];
        let swing = Sample {
            position: with(turned.position, moved.position[3] - frame.heading),
            velocity: with(turned.velocity, moved.velocity[3]),
            acceleration: with(turned.acceleration, moved.acceleration[3]),
        };
        from.inside = Some(RunningStep { stride, swing });
        from
    }

    /// The robot as it is measured, on both feet of the active plan `walk` at `t` \[s\], and the step with which it goes on, seen
    /// from below its stance foot; `sole` is that of either foot.
    pub(crate) fn on_both_feet(
        walk: &PlannedWalk,
        t: f64,
        Measured { state, zmp, ahead }: Measured<'_>,
        step: &Stride,
        sole: &Sole,
    ) -> Self {
        let (stance, soles) = (step.stance, walk.soles(t));
        let mut from = Self::on_plan(walk, t, soles, stance, step.parameters, None);
        let at = soles[stance];
        let frame = PlanarPose::new(at[0], at[1], at[3]);
        from.body = seen(&frame, at[2], &fallen_on(state, zmp, at[2], ahead));
        from.zmp = frame.local(zmp);
        let torso = leaning(state, &walk.plan.torso.sample(t), ahead);
        from.torso = torso;
        from.torso.position[2] -= frame.heading;
        from.height += lowered(state, stance);
        // Feet carry what lies over them.
        let [right, left] = [RIGHT, LEFT].map(|i| sole.middle(&from.feet[i]));
        let apart = [0, 1].map(|d| left[d] - right[d]);
        let share = (0..2).map(|d| (from.zmp[d] - right[d]) * apart[d]).sum::<f64>();
        from.load_left = (share / (apart[0] * apart[0] + apart[1] * apart[1])).clamp(0.0, 1.0);
        let (foot, z) = (from.feet[1 - stance], from.heights[1 - stance]);
        from.inside =
            Some(RunningStep { stride: *step, swing: Sample::rest([foot.x, foot.y, z, foot.heading]) });
        from
    }

    /// The step whose foot swings at the begin of the plan, if one does.
    pub(crate) fn swinging(&self) -> Option<&RunningStep> {
        // Compared as integers: the compiler looks at the number before it knows that there is one, and what lies there instead may
        // be subnormal.
        self.inside.as_ref().filter(|running| running.stride.lift.total_cmp(&0.0).is_le())
    }
}

/// Centre of gravity `ahead` \[s\] after its measurement: a pendulum over the measured zero-moment point until then.
fn fallen_on(state: &ControllerState, zmp: [f64; 2], ground: f64, ahead: f64) -> Sample<3> {
    let w2 = GRAVITY / (state.com[2] - ground);
    let mut body = Sample { position: state.com, velocity: state.com_velocity, acceleration: [0.0; 3] };
    for d in 0..2 {
        body.acceleration[d] = w2 * (state.com[d] - zmp[d]);
    }
    for d in 0..3 {
        body.position[d] += ahead * (body.velocity[d] + 0.5 * ahead * body.acceleration[d]);
        body.velocity[d] += ahead * body.acceleration[d];
    }
    body
}

/// Upper body, planned as `torso`, `ahead` \[s\] after the measurement: it leans as it is measured, and goes on leaning.
fn leaning(state: &ControllerState, torso: &Sample<3>, ahead: f64) -> Sample<3> {
    let (lean, rate) = (state.inclination_error, state.inclination_rate_error);
    let mut torso = *torso;
    for i in 0..2 {
        torso.position[i] -= lean[i] + ahead * rate[i];
        torso.velocity[i] -= rate[i];
    }
    torso
}

/// A motion seen from a frame on the ground \[m\].
fn seen(frame: &PlanarPose, ground: f64, s: &Sample<3>) -> Sample<3> {
    let at = frame.local([s.position[0], s.position[1]]);
    let back = |v: [f64; 3]| {
        let [x, y] = rotate(-frame.heading, [v[0], v[1]]);
        [x, y, v[2]]
    };
    Sample {
        position: [at[0], at[1], s.position[2] - ground],
        velocity: back(s.velocity),
        acceleration: back(s.acceleration),
    }
}
