//! Reactive step sequence planning: over small obstacles, not around them (thesis 4.3.3, algorithm 3).
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | a | how far ahead of the stance foot the last foothold before the obstacle may lie | m |
//! | b | how far ahead of it the first foothold behind the obstacle must lie | m |
//! | d | distance of a foothold from an obstacle | m |
//! | S_j | where the j-th of the coming footholds would lie without an obstacle | m |
//!
//! Steps until the obstacle all become longer or shorter by the same factor, whichever changes them less, so that one of
//! them ends at a; the step from there leads to b. Because a, b and the steps are looked at anew in every step, they
//! keep agreeing. What swings is lifted over the bounding box of what lies in its way, and its path is then held against
//! the triangles themselves.

use crate::obstacles::{Extent, KnownObstacles, Upright};
use crate::origin::PlanOrigin;
use crate::pose::PlanarPose;
use crate::sole::Sole;
use crate::steps::{ROUNDING, StepParameters, Stride, nu};
use crate::verdict::Blocked;
use crate::walking_model::WalkingModel;
use config::gait;
use messages::{Detail, EventCode};

/// Footholds that are looked ahead.
const LOOK: usize = 8;
/// \[m\] Least distance of a swinging foot from a triangle.
const TOUCH: f64 = 0.01;
/// \[m\] Height of a foot.
const FOOT_HEIGHT: f64 = 0.08;
/// Instants of a swing that are held against the triangles.
const INSTANTS: usize = 24;

/// The next step, with what is ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Adapted {
    /// \[m\] Its length.
    pub(crate) length: f64,
    /// An obstacle is near: steps take the time of those over obstacles.
    pub(crate) near: bool,
    /// Obstacle for which the step is shorter than it should be.
    pub(crate) blocked: Option<Blocked>,
}

/// Obstacles, and how they are stepped over.
#[derive(Clone)]
pub(crate) struct Reactive {
    pub(crate) known: KnownObstacles,
    pub(crate) rules: gait::Obstacles,
    /// \[m\] Longest step that is not over an obstacle.
    pub(crate) longest: f64,
}

impl Reactive {
    /// x of the sole frame at which the toes, or the heel, keep their distance from `x`.
    fn before(&self, x: f64, sole: &Sole) -> f64 {
        x - self.rules.distance - sole.center[0] - sole.half[0]
    }

    fn behind(&self, x: f64, sole: &Sole) -> f64 {
        x + self.rules.distance - sole.center[0] + sole.half[0]
    }

    /// The first obstacle ahead of a foot at `at`, together with those behind it that leave no room for a foot.
    fn ahead(&self, at: PlanarPose, strip: [f64; 2], sole: &Sole) -> Option<Extent> {
        let room = 2.0 * (sole.half[0] + self.rules.distance);
        let mut first: Option<Extent> = None;
        loop {
            let before = first;
            let own = self.known.extents(at, strip).filter(|e| self.behind(e.end, sole) > ROUNDING);
            for e in own {
                first = Some(match first {
                    Some(f) if e.begin < f.end + room && f.begin < e.end + room => f.union(&e),
                    Some(f) if f.begin <= e.begin => f,
                    _ => e,
                });
            }
            if first == before {
                return first;
            }
        }
    }

    /// Reason why a step over `e` cannot be made from ground at the height `ground`; `span` is its length.
    fn refusal(&self, e: &Extent, ground: f64, span: f64) -> Option<Blocked> {
        let millimetres = |x: f64| Detail::Millimetres((x * 1e3).round() as u64);
        if e.top - ground > self.rules.height {
            Some((EventCode::ObstacleTooHigh, millimetres(e.top - ground)))
        } else if span > self.rules.length + ROUNDING {
            Some((EventCode::ObstacleTooLong, millimetres(e.end - e.begin)))
        } else {
            None
        }
    }
}

impl Extent {
    fn union(&self, other: &Self) -> Self {
        Self {
            begin: self.begin.min(other.begin),
            end: self.end.max(other.end),
            top: self.top.max(other.top),
        }
    }
}

/// Length of the first of steps that would end at S_1, S_2, ... (`ideal`), so that none ends between `a` and `b`;
/// `None` if it need not be another one. `longest` is the longest step over the obstacle, `most` any other.
fn fit(ideal: &[f64], a: f64, b: f64, longest: f64, most: f64) -> Option<f64> {
    // The first foothold that would not lie before the obstacle; behind it, in reach, nothing need change.
    let j = ideal.iter().position(|&s| s > a + ROUNDING)?;
    let first = ideal[0];
    let last = if j == 0 { 0.0 } else { ideal[j - 1] };
    if ideal[j] >= b - ROUNDING && ideal[j] - last <= longest {
        return None;
    }
    // Steps 1 .. j-1 longer, or, with none of them left, the step over the obstacle now.
    let (stretched, can) =
        if j == 0 { (b, b <= longest + ROUNDING) } else { (first * a / last, first * a / last <= most) };
    // Or steps 1 .. j shorter: one step more before the obstacle. The smaller change is made.
    let shrunk = first * a / ideal[j];
    let longer = stretched / first.max(1e-9);
    let shorter = first / shrunk.max(1e-9);
    Some(if can && longer <= shorter { stretched } else { shrunk.max(0.0) })
}

impl Reactive {
    /// The step `p` from the foot `stance` at `at` in I_0, its ground at the height `ground` there (lines 3 to 6).
    pub(crate) fn adapt(
        &self,
        model: &WalkingModel,
        at: PlanarPose,
        ground: f64,
        stance: usize,
        p: &StepParameters,
        wish: &StepParameters,
    ) -> Adapted {
        let free = Adapted { length: p.length, near: false, blocked: None };
        if self.known.is_empty() || !(p.length > ROUNDING) {
            return free;
        }
        // The first obstacle in the lanes of both feet, and the footholds before and behind it.
        let sole = &model.soles[stance];
        let lane = sole.half[1] + self.rules.distance;
        let lanes = [0.0, nu(stance) * model.step.width];
        let strip =
            [lanes[0].min(lanes[1]) + sole.center[1] - lane, lanes[0].max(lanes[1]) + sole.center[1] + lane];
        let Some(e) = self.ahead(at, strip, sole) else { return free };
        let (a, b) = (self.before(e.begin, sole), self.behind(e.end, sole));

        // S_j: what the coming steps would be without it. One that lies beyond them does not matter yet.
        let mut ideal = [0.0; LOOK];
        let (mut next, mut s) = (*p, 0.0);
        for x in &mut ideal {
            s += next.length.max(0.0);
            *x = s;
            next = next.towards(wish, &model.step, 1.0);
        }
        if ideal[LOOK - 1] <= a + ROUNDING {
            return free;
        }
        // An obstacle that cannot be stepped over is walked up to.
        if let Some(why) = self.refusal(&e, ground, b - a) {
            let length = p.length.min(a.max(0.0));
            let blocked = (p.length > a + ROUNDING).then_some(why);
            return Adapted { length, near: true, blocked };
        }
        let length = fit(&ideal, a, b, self.rules.length, self.longest).unwrap_or(p.length);
        Adapted { length, near: true, blocked: None }
    }

    /// Lifts swings over what lies in their way; the first obstacle that they would touch all the same.
    pub(crate) fn lift_over(
        &self,
        model: &WalkingModel,
        from: &PlanOrigin,
        strides: &mut [Stride],
    ) -> Option<Blocked> {
        if self.known.is_empty() {
            return None;
        }
        let mut blocked = None;
        for s in strides {
            let Some(top) = self.highest(model, from, s) else { continue };
            let ground = from.height + s.heights.takeoff.max(s.heights.landing);
            s.heights.lift = s.heights.lift.max(top + self.rules.clearance - ground);
            let too_high = top - ground > self.rules.height;
            if too_high || self.touches(model, from, s) {
                let code = if too_high { EventCode::ObstacleTooHigh } else { EventCode::NoFoothold };
                let height = Detail::Millimetres(((top - ground) * 1e3).round() as u64);
                blocked = blocked.or(Some((code, height)));
            }
        }
        blocked
    }

    /// Top of the bounding box of what lies between take-off and landing of a swing.
    fn highest(&self, model: &WalkingModel, from: &PlanOrigin, s: &Stride) -> Option<f64> {
        let sole = &model.soles[1 - s.stance];
        let margin = 0.5 * self.rules.distance;
        let ends = [s.takeoff, s.landing].map(|p| s.foothold.relative(&p));
        let range = |d: usize| {
            let of = |p: &PlanarPose| [p.x, p.y][d] + sole.center[d];
            let reach =
                sole.half[0].hypot(sole.half[1]).min(sole.half[d] + 0.5 * ends[1].heading.abs()) + margin;
            [of(&ends[0]).min(of(&ends[1])) - reach, of(&ends[0]).max(of(&ends[1])) + reach]
        };
        let [back, front] = range(0);
        let at = from.frame.compose(&s.foothold);
        let inside = |e: &Extent| e.end > back && e.begin < front;
        self.known.extents(at, range(1)).filter(inside).map(|e| e.top).reduce(f64::max)
    }

    /// Does the foot touch a triangle on its way, or where it lands?
    fn touches(&self, model: &WalkingModel, from: &PlanOrigin, s: &Stride) -> bool {
        let sole = &model.soles[1 - s.stance];
        let [x, y] = sole.center;
        let [a, b] = sole.half.map(|h| h + TOUCH);
        let swing = s.swing(&model.step);
        (1..=INSTANTS).any(|k| {
            let t = s.lift + (s.end - s.lift) * k as f64 / INSTANTS as f64;
            let p = swing.at(t, &s.takeoff, &s.landing, &s.heights).position;
            let z = from.height + p[2];
            let foot = Upright {
                at: from.frame.compose(&PlanarPose::new(p[0], p[1], p[3])),
                sides: [x - a, x + a, y - b, y + b],
                height: [z, z + FOOT_HEIGHT],
            };
            self.known.hit(&foot)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every way to the obstacle: the last foothold before it is at a, the next at or behind b, and no step is longer
    /// than it may be.
    #[test]
    fn steps_end_before_the_obstacle_and_lead_over_it() {
        for k in 0..400 {
            let (step, longest, most) = (0.34, 0.55, 0.6);
            let (mut a, mut b) = (0.01 * k as f64, 0.01 * k as f64 + 0.45);
            let mut count = 0;
            while b > 1e-6 {
                let ideal: [f64; LOOK] = std::array::from_fn(|j| step * (j + 1) as f64);
                let length = fit(&ideal, a, b, longest, most).unwrap_or(step);
                assert!((0.0..=most).contains(&length), "{k}: {length}");
                assert!(length <= a + 1e-6 || length >= b - 1e-6, "{k}: lands at {length} of [{a}, {b}]");
                (a, b) = (a - length, b - length);
                count += 1;
                assert!(count < 20, "{k}: never over it");
            }
        }
    }

    #[test]
    fn a_step_that_clears_by_itself_stays() {
        assert_eq!(fit(&[0.5, 1.0, 1.5], 0.52, 0.97, 0.55, 0.6), None);
        assert_eq!(fit(&[0.5, 1.0, 1.5], 2.0, 2.4, 0.55, 0.6), None);
    }

    #[test]
    fn factors_agree_from_step_to_step() {
        let mut a = 1.5;
        let ideal: [f64; LOOK] = std::array::from_fn(|j| 0.4 * (j + 1) as f64);
        let mut lengths = Vec::new();
        while a > 0.01 {
            let length = fit(&ideal, a, a + 0.45, 0.5, 0.6).unwrap();
            lengths.push(length);
            a -= length;
        }
        assert!(lengths.iter().all(|l| (l - lengths[0]).abs() < 1e-12), "{lengths:?}");
    }
}
