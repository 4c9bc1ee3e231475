//! Foot trajectories: a swing is three phases horizontally and three vertically (thesis 4.5, figure 4.13).
//!
//! All of them are quintics from rest to rest; feet stay flat. Knots of both directions are merged, because a foot's
//! path has common knots for its four components.

use crate::foot_rollover::FootRollover;
use crate::origin::PlanOrigin;
use crate::pose::PlanarPose;
use crate::steps::{Heights, Stride};
use crate::walking_model::WalkingModel;
use config::gait;
use curves::{Path, Sample};
use messages::Plan;

/// Path of one foot: x, y, z \[m\] and heading \[rad\].
pub(crate) type FootPath = Path<4, FOOT_PIECES>;
/// Pieces of a foot's path.
pub(crate) const FOOT_PIECES: usize = 32;

/// Share of a swing after which the foot has reached its full height.
const RISEN: f64 = 0.4;
/// Share of a swing after which the foot is lowered.
const LOWERING: f64 = 0.6;
/// Share of a swing, at both ends, during which a foot that is lifted high does not move horizontally.
const UPRIGHT: f64 = 0.18;
/// Instants within a swing at which a trajectory has a knot.
pub const MARKS: usize = 6;

/// Instants of one swing \[s\].
#[derive(Clone, Copy, Debug)]
pub struct Swing {
    /// Lift-off.
    pub lift: f64,
    /// Landing.
    pub end: f64,
    depart: f64,
    arrive: f64,
    risen: f64,
    lowering: f64,
}

impl Swing {
    /// A swing between lift-off and landing.
    pub fn new(lift: f64, end: f64, step: &gait::StepSettings) -> Self {
        let h = end - lift;
        Self {
            lift,
            end,
            depart: lift + step.swing_lag.min(0.3 * h),
            arrive: end - step.swing_lead.min(0.3 * h),
            risen: lift + RISEN * h,
            lowering: lift + LOWERING * h,
        }
    }

    /// The same, moving horizontally only while the foot is high.
    pub fn upright(self) -> Self {
        let h = UPRIGHT * (self.end - self.lift);
        Self { depart: self.depart.max(self.lift + h), arrive: self.arrive.min(self.end - h), ..self }
    }

    /// \[s\] Instant at which the foot begins to come down.
    pub fn lowering(&self) -> f64 {
        self.lowering
    }

    /// All knots, ascending. The first is the lift-off, the last the landing.
    pub fn marks(&self) -> [f64; MARKS] {
        // `new` limits lag and lead to 0.3 of the swing, and UPRIGHT is less: so this order always holds.
        [self.lift, self.depart, self.risen, self.lowering, self.arrive, self.end]
    }

    /// The foot at `t`.
    pub(crate) fn at(&self, t: f64, from: &PlanarPose, to: &PlanarPose, heights: &Heights) -> Sample<4> {
        let (s, ds, dds) = ramp(t, self.depart, self.arrive);
        let apex = heights.takeoff.max(heights.landing) + heights.lift;
        let (ground, (z, dz, ddz)) = if t < self.lowering {
            (heights.takeoff, ramp(t, self.lift, self.risen))
        } else {
            (heights.landing, ramp(-t, -self.end, -self.lowering))
        };
        // Going down is going up backwards: the rate changes its sign.
        let dz = if t < self.lowering { dz } else { -dz };
        let height = apex - ground;
        let d = [to.x - from.x, to.y - from.y, to.heading - from.heading];
        Sample {
            position: [from.x + s * d[0], from.y + s * d[1], ground + z * height, from.heading + s * d[2]],
            velocity: [ds * d[0], ds * d[1], dz * height, ds * d[2]],
            acceleration: [dds * d[0], dds * d[1], ddz * height, dds * d[2]],
        }
    }
}

impl Stride {
    /// The swing of the step. One that is lifted higher than usual moves to the front later: it rises first.
    pub(crate) fn swing(&self, step: &gait::StepSettings) -> Swing {
        let swing = Swing::new(self.lift, self.end, step);
        if self.is_high(step) { swing.upright() } else { swing }
    }
}

/// Planner of the feet: footprints, pitch of the soles, toe joints.
#[derive(Clone)]
pub(crate) struct FootTrajectories {
    pub(crate) rollover: FootRollover,
}

impl FootTrajectories {
    /// Writes the motion of both feet over the steps `strides`.
    pub(crate) fn lay(&self, model: &WalkingModel, from: &PlanOrigin, strides: &[Stride], plan: &mut Plan) {
        for foot in 0..2 {
            stand(&mut plan.feet[foot], 0.0, &from.feet[foot], from.heights[foot]);
        }
        let running = from.swinging().map_or(0, |inside| {
            let s = &strides[0];
            land(&mut plan.feet[1 - s.stance], &s.swing(&model.step), &inside.swing, s);
            1
        });
        for s in &strides[running..] {
            let path = &mut plan.feet[1 - s.stance];
            swing(path, &s.swing(&model.step), &s.takeoff, &s.landing, &s.heights);
        }
        self.rollover.lay(from, strides, model.step.start_time, plan);
        self.rollover.tilt(&model.step, strides, &mut plan.pitch);
    }
}

/// Quintic from 0 to 1 between `begin` and `end`, at rest on both sides: value and two derivatives.
pub fn ramp(t: f64, begin: f64, end: f64) -> (f64, f64, f64) {
    let h = end - begin;
    let u = ((t - begin) / h).clamp(0.0, 1.0);
    let v = 1.0 - u;
    (
        u * u * u * (10.0 - u * (15.0 - 6.0 * u)),
        30.0 * u * u * v * v / h,
        60.0 * u * v * (1.0 - 2.0 * u) / (h * h),
    )
}

/// A foot that stands: the beginning of every path.
pub fn stand(path: &mut FootPath, start: f64, at: &PlanarPose, ground: f64) {
    path.restart(start, [at.x, at.y, ground, at.heading]);
}

/// Appends a rest until lift-off and the swing to `to`.
pub fn swing(path: &mut FootPath, swing: &Swing, from: &PlanarPose, to: &PlanarPose, heights: &Heights) {
    let rest = Sample::rest([from.x, from.y, heights.takeoff, from.heading]);
    if swing.lift > path.end() {
        path.push(&rest, &rest, swing.lift);
    }
    let mut last = rest;
    for mark in &swing.marks()[1..MARKS - 1] {
        let next = swing.at(*mark, from, to, heights);
        path.push(&last, &next, *mark);
        last = next;
    }
    path.push(&last, &Sample::rest([to.x, to.y, heights.landing, to.heading]), swing.end);
}

/// \[s\] Shortest piece of a swing that goes on.
const PIECE: f64 = 0.03;

/// Goes on with the swing of `s`, whose foot moves as `from` at the begin of the path: up as far as there is time, and to
/// its landing.
fn land(path: &mut FootPath, swing: &Swing, from: &Sample<4>, s: &Stride) {
    let pick = |d: [usize; 3]| Sample {
        position: d.map(|i| from.position[i]),
        velocity: d.map(|i| from.velocity[i]),
        acceleration: d.map(|i| from.acceleration[i]),
    };
    // Horizontally one quintic, vertically one to each height that is still ahead.
    let (x, z) = (pick([0, 1, 3]), pick([2; 3]));
    let arrive = if swing.arrive > 0.5 * swing.end { swing.arrive } else { swing.end };
    let mut over_ground = Path::<3, 1>::resting(0.0, x.position);
    over_ground.push(&x, &Sample::rest([s.landing.x, s.landing.y, s.landing.heading]), arrive);
    let apex = s.heights.takeoff.max(s.heights.landing) + s.heights.lift;
    let mut height = Path::<3, 3>::resting(0.0, z.position);
    let mut last = z;
    for (time, to) in [(swing.risen, apex), (swing.lowering, apex), (swing.end, s.heights.landing)] {
        if time > height.end() + PIECE {
            let next = Sample::rest([to; 3]);
            height.push(&last, &next, time);
            last = next;
        }
    }
    // Both on common knots.
    let mut last = *from;
    for time in [swing.risen, swing.lowering, arrive, swing.end] {
        if time > path.end() + 1e-9 {
            let (x, z) = (over_ground.sample(time), height.sample(time));
            let of = |x: [f64; 3], z: [f64; 3]| [x[0], x[1], z[0], x[2]];
            let next = Sample {
                position: of(x.position, z.position),
                velocity: of(x.velocity, z.velocity),
                acceleration: of(x.acceleration, z.acceleration),
            };
            path.push(&last, &next, time);
            last = next;
        }
    }
}
