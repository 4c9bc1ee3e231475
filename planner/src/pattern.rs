//! Walking pattern with fixed parameters: both feet and the torso over a sequence of steps (Daniali 2013, 4.2).
//!
//! What is printed there is over-determined, or leaves the feet sliding; here every course has as many coefficients as
//! conditions (construction B and section 2.7 of the errata), is continuous up to its acceleration and rests at both ends
//! of a walk. The thesis has the cycle; half steps out of standing and into it are the same courses between other points.
//!
//! | course | in double support | in single support |
//! |---|---|---|
//! | sole on the ground | rolls over the toe until it leaves, over the heel until it lies flat | flat |
//! | ankle of the swing foot | | two quartics through `l_ao`, `H_ao` at `T_o`, and sideways through `w_p` half-way |
//! | torso forward `x_h` | quintic, or the spline's cubic | uniform, or the spline's cubic |
//! | torso sideways `y_h` | from rest to rest | rests `w_m` outside of the stance foot |
//! | torso's height `z_h` | lowest at `T_min` | highest at `T_max` |

use crate::planned_walk::{LEAD, Margins};
use crate::pose::rotate;
use crate::segment::Horizon;
use crate::steps::{Stride, nu};
use crate::torso;
use crate::two_quartics::TwoQuartics;
use crate::walking_model::WalkingModel;
use config::Robot;
use config::pattern::{Pattern, TorsoForward, TorsoHeight};
use config::tables::PLAN_POINTS;
use curves::{Path, Sample};
use messages::{GaitState, LEFT, MAX_JOINTS, Plan};
use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;

/// \[s\] Knots nearer to one another are one.
const SAME: f64 = 1e-9;
/// \[m\] Footholds nearer to one another are the same.
const ALIKE: f64 = 1e-9;
/// Instants of a plan at which reach is looked at.
const POINTS: u32 = 200;

/// Trajectories of a pattern.
#[derive(Clone)]
pub(crate) struct PatternTrajectories {
    pub(crate) pattern: Pattern,
    /// \[m\] Height of the ankle over the sole: `l_an`.
    ankle: f64,
    /// Height of the torso at the begin of a step, at `T_min` and at `T_max`: value, velocity, acceleration.
    heights: [Sample<1>; 3],
    /// \[m\] Length of the steps of a walk that was looked at as a whole: at first that of the pattern.
    known: f64,
    robot: Arc<Robot>,
}

impl PatternTrajectories {
    /// For the feet of a robot, whose ankles are the origins of the links that carry the soles.
    pub(crate) fn new(pattern: &Pattern, robot: &Robot) -> Self {
        Self {
            pattern: *pattern,
            ankle: -robot.feet[0].sole[2],
            heights: torso_heights(pattern),
            known: pattern.length,
            robot: Arc::new(robot.clone()),
        }
    }

    /// What plans need besides their own cycles \[s\]: drives that play tables get them before, and play the last point twice.
    pub(crate) fn margins(&self, cycle: f64) -> Margins {
        let Some(tables) = &self.robot.tables else { return Margins::default() };
        Margins {
            lead: LEAD + tables.plan_lead(&self.robot.layout, cycle, PLAN_POINTS),
            tail: (2.0 * tables.period(&self.pattern) / cycle).ceil() as u64,
        }
    }

    /// True if the legs can take all poses of a plan. Only what is not alike a walk that was looked at before is looked at: the
    /// first step out of standing, whose foot comes from where the robot was found, and steps of another length.
    pub(crate) fn is_in_reach(&mut self, horizon: &Horizon<'_>, plan: &Plan) -> bool {
        let strides = horizon.strides;
        let Some(last) = strides.iter().rposition(|s| !self.is_alike(s, self.known)) else { return true };
        let whole = last + 1 == strides.len();
        let until = if whole { plan.end() } else { strides[last].end };
        let points = (f64::from(POINTS) * until / plan.end()).ceil();
        let mut angles = [0.0; MAX_JOINTS];
        let at = |i: u32| until * f64::from(i) / points;
        let reached =
            (0..=points as u32).all(|i| self.robot.angles_of_plan(plan, at(i), &mut angles).is_ok());
        let length = strides[0].parameters.length;
        if reached && whole && strides.len() > 1 && strides.iter().all(|s| self.is_alike(s, length)) {
            self.known = length;
        }
        reached
    }

    /// True if a step, or one that closes the feet, follows one of `length` \[m\] and is as long.
    fn is_alike(&self, s: &Stride, length: f64) -> bool {
        let [takeoff, landing] = [s.takeoff, s.landing].map(|pose| s.foothold.relative(&pose));
        let wide = |y: f64| (y.abs() - self.pattern.width).abs() < ALIKE;
        let ahead = s.parameters.length;
        (takeoff.x + length).abs() < ALIKE
            && (ahead == 0.0 || (ahead - length).abs() < ALIKE)
            && wide(takeoff.y)
            && wide(landing.y)
    }

    /// Writes the motion of feet and torso over the steps of `horizon`.
    pub(crate) fn lay(&self, model: &WalkingModel, horizon: &Horizon<'_>, plan: &mut Plan) {
        let walk = PatternWalk { of: self, model, horizon };
        plan.pitch_height = self.ankle;
        for foot in 0..2 {
            walk.lay_foot(foot, &mut plan.feet[foot]);
            walk.lay_pitch(foot, &mut plan.pitch[foot]);
        }
        torso::follow(&mut plan.torso, &horizon.from.torso, horizon.strides, horizon.end);
        walk.lay_body(plan);
        walk.lay_load(plan);
    }
}

/// One walk that is laid.
struct PatternWalk<'a> {
    of: &'a PatternTrajectories,
    model: &'a WalkingModel,
    horizon: &'a Horizon<'a>,
}

impl PatternWalk<'_> {
    fn pattern(&self) -> &Pattern {
        &self.of.pattern
    }

    /// \[s\] Instant of the plan at which step `k` is at `t` of the pattern, which may lie in the double support after it.
    fn instant(&self, k: usize, t: f64) -> f64 {
        let (s, p) = (&self.horizon.strides[k], self.pattern());
        let share = |from: f64, to: f64| (t - from) / (to - from);
        if t <= p.double_support {
            s.begin + share(0.0, p.double_support) * (s.lift - s.begin)
        } else if t <= p.step_time {
            s.lift + share(p.double_support, p.step_time) * (s.end - s.lift)
        } else {
            let settled = self.horizon.strides.get(k + 1).map_or(self.horizon.end, |next| next.lift);
            s.end + share(p.step_time, p.step_time + p.double_support) * (settled - s.end)
        }
    }

    /// True if step `k` puts the swing foot beside the other one.
    fn closes(&self, k: usize) -> bool {
        k + 1 == self.horizon.strides.len()
    }

    /// Torso against the stance foot of step `k`, at the begin and at the end of its single support: forward \[m\],
    /// velocity and acceleration. Steps shorter than `D_s` take the torso less far from the middle of the sole.
    fn torso_ahead(&self, k: usize) -> [[f64; 3]; 2] {
        let (s, p) = (&self.horizon.strides[k], self.pattern());
        let middle = self.model.soles[s.stance].center[0];
        let share = (s.parameters.length / p.length).clamp(0.0, 1.0);
        let starts = k == 0 && self.horizon.state == GaitState::Starting;
        let begin = if starts { middle } else { middle + share * (-p.start_behind - middle) };
        let end = middle + share * (p.end_ahead - middle);
        let single = s.end - s.lift;
        if p.forward == TorsoForward::Linear || starts || self.closes(k) {
            let v = (end - begin) / single;
            return [[begin, v, 0.0], [end, v, 0.0]];
        }
        // (4-13), (4-14) with the numerator that makes the velocity continuous, of equal steps of this length.
        let (double, cycle) = (s.lift - s.begin, s.end - s.begin);
        let way = s.parameters.length - end + begin;
        let n = s.parameters.length * (1.0 - double / cycle) - end + begin;
        let (v, a) = (way / double - n / single, 6.0 * n / (double * single));
        [[begin, v, -a], [end, v, a]]
    }

    /// Centre of gravity's place in a plan: here the torso's origin.
    fn lay_body(&self, plan: &mut Plan) {
        let Horizon { from, strides, end, .. } = *self.horizon;
        // Over the ground.
        let mut ground = Path::<2, 32>::resting(0.0, [from.body.position[0], from.body.position[1]]);
        let flat = |x: [f64; 3]| [x[0], x[1]];
        let mut last = Sample {
            position: flat(from.body.position),
            velocity: flat(from.body.velocity),
            acceleration: flat(from.body.acceleration),
        };
        for (k, s) in strides.iter().enumerate() {
            let side = -nu(s.stance) * self.pattern().shift;
            let at = |[x, v, a]: [f64; 3]| Sample {
                position: s.foothold.point([x, side]),
                velocity: rotate(s.foothold.heading, [v, 0.0]),
                acceleration: rotate(s.foothold.heading, [a, 0.0]),
            };
            let [lift, landing] = self.torso_ahead(k).map(at);
            ground.push(&last, &lift, s.lift);
            ground.push(&lift, &landing, s.end);
            last = landing;
        }
        let s = self.horizon.last();
        let mut feet = [s.foothold; 2];
        feet[1 - s.stance] = s.landing;
        ground.push(&last, &Sample::rest(self.model.standing_point(&feet)), end);
        // Up and down, and both as one path.
        let mut up = Path::<1, 32>::resting(0.0, [from.body.position[2]]);
        self.lay_height(&mut up);
        merge(&ground, &up, &mut plan.body);
    }

    /// Height of the torso's origin.
    fn lay_height(&self, up: &mut Path<1, 32>) {
        let Horizon { from, strides, end, state, .. } = *self.horizon;
        let p = self.pattern();
        let of = |x: [f64; 3]| [x[2]];
        let mut last = Sample {
            position: of(from.body.position),
            velocity: of(from.body.velocity),
            acceleration: of(from.body.acceleration),
        };
        let [start, low, high] = self.of.heights;
        let quintic = p.height == TorsoHeight::Quintic;
        for (k, s) in strides.iter().enumerate() {
            // Courses of a step that takes longer are stretched.
            let stretch = p.step_time / (s.end - s.begin);
            let stretched = |h: Sample<1>| Sample {
                position: h.position,
                velocity: [h.velocity[0] * stretch],
                acceleration: [h.acceleration[0] * stretch * stretch],
            };
            let starts = k == 0 && state == GaitState::Starting;
            if quintic || !starts {
                let low = stretched(low);
                up.push(&last, &low, self.instant(k, p.low_time));
                last = low;
            }
            let high = stretched(high);
            up.push(&last, &high, self.instant(k, p.high_time));
            last = high;
            // The spline has a knot where steps meet.
            if !quintic && k + 1 < strides.len() {
                let start = stretched(start);
                up.push(&last, &start, s.end);
                last = start;
            }
        }
        let settled = if quintic { self.instant(strides.len() - 1, p.step_time + p.low_time) } else { end };
        up.push(&last, &Sample::rest([p.heights[0]]), settled);
    }

    /// Footprint of a foot on the ground; of a swinging one what would be its sole if it did not pitch: ankle less `l_an`.
    fn lay_foot(&self, foot: usize, path: &mut Path<4, 32>) {
        let Horizon { from, strides, end, .. } = *self.horizon;
        let at = &from.feet[foot];
        let rest = |x: f64, y: f64, z: f64, heading: f64| Sample::rest([x, y, z, heading]);
        let mut last = rest(at.x, at.y, from.heights[foot], at.heading);
        path.restart(0.0, last.position);
        for (k, s) in strides.iter().enumerate().filter(|(_, s)| s.stance != foot) {
            path.push(&last, &last, s.lift);
            // Knots of both directions.
            let swing = self.swing(k);
            let (over, middle) = (swing.forward.middle(), swing.side.middle());
            let mut before = swing.at(s.lift);
            for t in [over.min(middle), over.max(middle), s.end] {
                if t - path.end() > SAME {
                    let next = swing.at(t);
                    path.push(&before, &next, t);
                    before = next;
                }
            }
            // The footprint in which it lands.
            last = rest(s.landing.x, s.landing.y, s.heights.landing, s.landing.heading);
        }
        path.push(&last, &last, end);
    }

    /// The swing of step `k`.
    fn swing(&self, k: usize) -> AnkleSwing {
        let (s, p) = (&self.horizon.strides[k], self.pattern());
        let [rear, front] = self.edges(1 - s.stance);
        // Ankle over its footprints, by rolling.
        let (leaves, lands) = (self.rolled(front, p.leave), self.rolled(rear, -self.landing_pitch(k)));
        let from = s.takeoff.point([leaves[0], 0.0]);
        let to = s.landing.point([lands[0], 0.0]);
        let (over, middle) = (self.instant(k, p.over_time), 0.5 * (s.lift + s.end));
        let [low, high] = [s.heights.takeoff + leaves[1], s.heights.landing + lands[1]];
        let top = s.heights.takeoff.max(s.heights.landing) + p.over_height - self.of.ankle;
        // The share of the way is that of a whole step, whose ankle passes l_ao.
        let whole = 2.0 * p.length - leaves[0] + lands[0];
        let share = (p.over_length - leaves[0]) / whole;
        AnkleSwing {
            from: [from[0], from[1], s.takeoff.heading],
            way: [to[0] - from[0], to[1] - from[1], s.landing.heading - s.takeoff.heading],
            out: rotate(s.foothold.heading, [0.0, nu(s.stance) * p.pass]),
            forward: TwoQuartics::new([s.lift, over, s.end], [0.0, share, 1.0]),
            side: TwoQuartics::new([s.lift, middle, s.end], [0.0, 1.0, 0.0]),
            up: TwoQuartics::new([s.lift, over, s.end], [low, top, high]),
        }
    }

    /// \[m\] Rear and front edge of a sole, seen from under the ankle.
    fn edges(&self, foot: usize) -> [f64; 2] {
        let sole = &self.model.soles[foot];
        [sole.center[0] - sole.half[0], sole.center[0] + sole.half[0]]
    }

    /// \[m\] Way of the ankle, forward and up, of a flat sole that rolls over an edge by `angle` \[rad\]: (4-3), (4-4).
    fn rolled(&self, edge: f64, angle: f64) -> [f64; 2] {
        let (s, c) = angle.sin_cos();
        let ankle = self.of.ankle;
        [ankle * s + edge * (1.0 - c), edge * s + ankle * c - ankle]
    }

    /// \[rad\] Pitch, toes up, with which the swing foot of step `k` lands; one that comes to stand lands flat.
    fn landing_pitch(&self, k: usize) -> f64 {
        if self.closes(k) { 0.0 } else { self.pattern().land }
    }

    /// Pitch of a sole: 0, `q_b` where it leaves the ground, `-q_f` where it lands, 0 (4-9), (4-10), from rest to rest.
    fn lay_pitch(&self, foot: usize, path: &mut Path<1, 24>) {
        let p = self.pattern();
        if p.leave == 0.0 && p.land == 0.0 {
            return;
        }
        let mut now = self.horizon.from.pitch[foot].position[0];
        path.restart(0.0, [now]);
        let mut turn = |to: f64, t: f64| {
            path.push(&Sample::rest([now]), &Sample::rest([to]), t);
            now = to;
        };
        let [first, second, third] = p.pitch_times;
        for (k, s) in self.horizon.strides.iter().enumerate() {
            if s.stance == foot {
                // The front foot comes to lie flat.
                turn(0.0, s.begin + (third - p.step_time) / p.double_support * (s.lift - s.begin));
                turn(0.0, s.end);
            } else {
                turn(0.0, self.instant(k, first));
                turn(p.leave, s.lift);
                turn(-self.landing_pitch(k), self.instant(k, second));
                turn(-self.landing_pitch(k), s.end);
            }
        }
    }

    /// Load of the left foot, and the zero-moment point under the feet that carry: with the torso from foot to foot.
    fn lay_load(&self, plan: &mut Plan) {
        let Horizon { from, strides, end, .. } = *self.horizon;
        let mut last = Sample::rest([from.load_left]);
        plan.load_left.restart(0.0, last.position);
        plan.zmp.push(0.0, from.zmp);
        for s in strides {
            let carries = Sample::rest([if s.stance == LEFT { 1.0 } else { 0.0 }]);
            plan.load_left.push(&last, &carries, s.lift);
            plan.load_left.push(&carries, &carries, s.end);
            last = carries;
            let middle = self.model.soles[s.stance].middle(&s.foothold);
            plan.zmp.push(s.lift, middle);
            plan.zmp.push(s.end, middle);
        }
        plan.load_left.push(&last, &Sample::rest([0.5]), end);
        let s = self.horizon.last();
        let middles = [s.foothold, s.landing].map(|pose| self.model.soles[s.stance].middle(&pose));
        plan.zmp.push(end, [0, 1].map(|d| 0.5 * (middles[0][d] + middles[1][d])));
    }
}

/// Swing of an ankle, less its height over a flat sole.
struct AnkleSwing {
    /// x, y \[m\] and heading \[rad\] at lift-off, and their way to the landing.
    from: [f64; 3],
    way: [f64; 3],
    /// \[m\] Outwards, at most.
    out: [f64; 2],
    /// Shares of the two.
    forward: TwoQuartics,
    side: TwoQuartics,
    /// \[m\]
    up: TwoQuartics,
}

impl AnkleSwing {
    /// The ankle at `t` \[s\].
    fn at(&self, t: f64) -> Sample<4> {
        let (forward, side, up) = (self.forward.at(t), self.side.at(t), self.up.at(t));
        let of = |d: usize| {
            let start = if d == 0 { self.from } else { [0.0; 3] };
            let [x, y, heading] = [0, 1, 2].map(|i| start[i] + forward[d] * self.way[i]);
            [x + side[d] * self.out[0], y + side[d] * self.out[1], up[d], heading]
        };
        Sample { position: of(0), velocity: of(1), acceleration: of(2) }
    }
}

/// One path of three dimensions from one over the ground and one upwards, which end at different times.
fn merge(ground: &Path<2, 32>, up: &Path<1, 32>, path: &mut Path<3, 96>) {
    let at = |t: f64| {
        let (g, u) = (ground.sample(t), up.sample(t));
        let both = |g: [f64; 2], u: [f64; 1]| [g[0], g[1], u[0]];
        Sample {
            position: both(g.position, u.position),
            velocity: both(g.velocity, u.velocity),
            acceleration: both(g.acceleration, u.acceleration),
        }
    };
    let mut last = at(0.0);
    path.restart(0.0, last.position);
    let ends = [&ground.ends[..ground.pieces as usize], &up.ends[..up.pieces as usize]];
    let mut next = [0; 2];
    while next[0] < ends[0].len() || next[1] < ends[1].len() {
        let t = [0, 1].map(|i| ends[i].get(next[i]).copied().unwrap_or(f64::INFINITY));
        let now = t[0].min(t[1]);
        for i in 0..2 {
            next[i] += usize::from(t[i] - now < SAME);
        }
        let knot = at(now);
        path.push(&last, &knot, now);
        last = knot;
    }
}

/// Height of the torso at the begin of a step, at `T_min` and at `T_max`.
fn torso_heights(p: &Pattern) -> [Sample<1>; 3] {
    let [low, high] = p.heights;
    if p.height == TorsoHeight::Quintic {
        return [Sample::rest([f64::NAN]), Sample::rest([low]), Sample::rest([high])];
    }
    // The periodic cubic spline: its second derivatives at the knots from the continuity of the first ones.
    let knots = [p.start_height, low, high];
    let h = [p.low_time, p.high_time - p.low_time, p.step_time - p.high_time];
    let slope = [0, 1, 2].map(|i| (knots[(i + 1) % 3] - knots[i]) / h[i]);
    let mut matrix = Matrix3::zeros();
    let mut right = Vector3::zeros();
    for i in 0..3 {
        let before = (i + 2) % 3;
        matrix[(i, before)] += h[before];
        matrix[(i, i)] += 2.0 * (h[before] + h[i]);
        matrix[(i, (i + 1) % 3)] += h[i];
        right[i] = 6.0 * (slope[i] - slope[before]);
    }
    let second = matrix.lu().solve(&right).unwrap_or_else(|| Vector3::repeat(f64::NAN));
    [0, 1, 2].map(|i| Sample {
        position: [knots[i]],
        velocity: [slope[i] - h[i] * (2.0 * second[i] + second[(i + 1) % 3]) / 6.0],
        acceleration: [second[i]],
    })
}

#[cfg(test)]
mod tests;
