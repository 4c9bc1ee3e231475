//! Step adaptation: where and when the swing foot has to land so that the next support catches a body that was pushed
//! (Khadiv et al. 2016, Griffin et al. 2017).
//!
//! The divergent component xi = c + c'/w of a linear pendulum leaves a resting zero-moment point p as e^(w t). Up to the
//! landing p may be moved within the sole; what remains is met by a landing elsewhere, and earlier, or later if the body was pushed
//! over its stance foot and first has to come back.
//!
//! ```text
//! Variables    u   landing                                                     [m]  stance foot
//!              r   rest of the swing                                           [s]
//!              b   offset of xi from the landing at that time                  [m]  stance foot
//!              d   shift of the zero-moment point until then                   [m]  stance foot
//! Objective    |u - u_plan|^2 + OFFSET |b - b_plan|^2 + HASTE (r_plan - r)^2
//! Constraints  u + b = p + d + (xi - p - d) e^(w r)
//!              u, r, d in boxes
//! ```
//! Given r everything else is in closed form, axis by axis; r itself is found by a search between two ends.

use crate::planned_walk::PlannedWalk;
use crate::pose::PlanarPose;
use crate::sole::Sole;
use crate::steps::nu;
use config::gait;

/// Weight of the offset b.
const OFFSET: f64 = 30.0;
/// \[m^2/s^2\] Weight of a shorter or longer swing.
const HASTE: f64 = 0.01;
/// Shares of the sole's length and width, about its middle, in which the zero-moment point is counted on: a sole that presses in
/// a corner turns about it.
const COUNTED: [f64; 2] = [0.5, 0.8];
/// The same where the stabilizer alone is to compensate an error.
const ALONE: [f64; 2] = [0.7, 1.0];
/// Steps of the search for r: its bracket shrinks to a thousandth.
const NARROWINGS: usize = 16;

/// Divergent component of the body at an instant of a plan.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Divergence {
    /// \[1/s\] Rate of the pendulum.
    pub(crate) w: f64,
    /// \[m\] @planning frame Measured less planned.
    pub(crate) error: [f64; 2],
}

/// The foot that swings, or is about to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SwingFoot {
    /// \[m\] @planning frame
    pub(crate) place: [f64; 2],
    /// \[s\] Until it lifts off; 0 while it swings.
    pub(crate) loaded: f64,
}

/// A landing that catches the body, as far as one can.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Landing {
    /// Pose of the foot, @planning frame of the active plan.
    pub(crate) pose: PlanarPose,
    /// \[s\] Until then.
    pub(crate) rest: f64,
    /// The next support can compensate what is left.
    pub(crate) catches: bool,
    /// Both feet carry, and the one behind may yet bring the body back: such a step can wait.
    pub(crate) held: bool,
}

/// One axis of the problem.
#[derive(Clone, Copy)]
struct Axis {
    /// \[m\] Planned: divergent component now and at landing, zero-moment point that leads from one to the other, landing.
    xi: f64,
    end: f64,
    zmp: f64,
    landing: f64,
    /// \[m\] Measured less planned divergent component.
    error: f64,
    /// \[m\] How far the zero-moment point may be shifted, and where the foot may land; where it is now.
    shift: [f64; 2],
    room: [f64; 2],
    foot: f64,
}

impl Axis {
    /// The zero-moment point may be shifted as far again as another foot stands, `apart` \[m\] from the stance foot.
    fn reach(&mut self, apart: f64) {
        self.shift[usize::from(apart > 0.0)] += apart;
    }

    /// \[m\] Distance of xi from where the plan wanted it at landing, if it grew by `growth`; the zero-moment point has done
    /// what it can.
    fn missed(&self, growth: f64) -> f64 {
        let at = self.zmp + (self.xi - self.zmp + self.error) * growth - self.end;
        let [low, high] = self.shift.map(|d| d * (growth - 1.0));
        at - at.clamp(low, high)
    }

    /// \[m\] Change of the landing and of the offset that compensate it; the foot gets no farther than `reach`.
    fn split(&self, growth: f64, reach: f64) -> [f64; 2] {
        let missed = self.missed(growth);
        let [low, high] = self.room;
        let near = |x: f64| x.clamp(self.foot - reach, self.foot + reach).clamp(low, high);
        let moved = near(self.landing + missed * OFFSET / (1.0 + OFFSET)) - self.landing;
        [moved, missed - moved]
    }
}

/// Landing of step `k` of `walk` at its time `t` \[s\] that compensates the error of `body`; `foot` lands, `sole` is that of
/// the stance foot. None if the stabilizer alone can.
///
/// As long as the swing foot carries, both soles hold the body to the sides better than a step that begins sooner: only an
/// error ahead or back alone is answered then. If the zero-moment point under the foot that is about to lift off, until it does,
/// would bring the body back, the landing is `held`.
pub(crate) fn adapt(
    rules: &gait::Reaction,
    walk: &PlannedWalk,
    (k, t): (usize, f64),
    body: &Divergence,
    foot: &SwingFoot,
    sole: &Sole,
) -> Option<Landing> {
    let s = &walk.strides[k];
    let rest = s.end - t;
    if rest < rules.rest {
        return None;
    }
    let axes = |counted: [f64; 2]| axes(rules, walk, (k, t), body, foot.place, (sole, counted));
    let growth = (body.w * rest).exp();
    let stays = |a: &Axis, most: f64| a.error.abs() <= rules.error || a.missed(growth).abs() <= most;
    let alone = axes(ALONE);
    let carries = foot.loaded > 0.0;
    let stay = [0, 1].map(|d| stays(&alone[d], rules.tolerance[d]));
    if stay == [true; 2] || carries && stay != [false, true] {
        return None;
    }
    let held = carries && {
        // A shift until the lift-off alone counts less at landing than one that stays.
        let counts = (growth - (body.w * (s.end - s.lift)).exp()) / (growth - 1.0);
        let [mut along, _] = alone;
        along.reach(counts * s.foothold.relative(&s.takeoff).x);
        stays(&along, rules.tolerance[0])
    };
    let problem = Problem { rules, w: body.w, axes: axes(COUNTED), planned: rest, loaded: foot.loaded };
    let swung = (t - s.lift).max(0.0);
    let shortest = rules.rest.max(foot.loaded + rules.swing - swung).min(rest);
    let mut r = problem.best(shortest, rest);
    // A body that was pushed over its stance foot, and no more than that, may come back if the foot waits for it.
    let outward = -nu(s.stance) * problem.axes[1].error > rules.error;
    if outward && problem.caught(r) == [true, false] {
        let late = problem.best(rest, rest + rules.wait);
        r = if problem.caught(late) == [true; 2] { late } else { r };
    }
    Some(Landing { held, ..problem.landing(r, &s.foothold, &s.landing) })
}

/// A body that is about to leave a stand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Toppling {
    /// \[1/s\] Rate of the pendulum.
    pub(crate) w: f64,
    /// \[m\] @planning frame Its divergent component when the swing begins.
    pub(crate) xi: [f64; 2],
    /// \[m\] By how much it is ahead of a foot on which it rests.
    pub(crate) ahead: f64,
}

/// Landing of the first step out of a stand that catches `body`: `stance` carries it, at the pose `foothold`; the other foot
/// comes from `takeoff`, and would land `width` \[m\] beside it after a swing of `swing` \[s\].
pub(crate) fn step_out(
    rules: &gait::Reaction,
    body: &Toppling,
    (stance, sole): (usize, &Sole),
    [foothold, takeoff]: [&PlanarPose; 2],
    (width, swing): (f64, f64),
) -> Landing {
    let (xi, foot) = (foothold.local(body.xi), foothold.local([takeoff.x, takeoff.y]));
    let home = PlanarPose::new(0.0, nu(stance) * width, 0.0);
    let side = beside(rules, stance);
    // There is no plan to hold the body against: the zero-moment point begins in the middle of the sole, and all of xi is error.
    let axes = [0, 1].map(|d| {
        let landing = [home.x, home.y][d];
        // In both axes: with half of the length 0.57 instead of 0.64 N s/kg are survived forward.
        let half = COUNTED[1] * sole.half[d];
        Axis {
            xi: xi[d],
            end: landing + [body.ahead, 0.0][d],
            zmp: sole.center[d],
            landing,
            error: 0.0,
            shift: [-half, half],
            room: [rules.length, side][d],
            foot: foot[d],
        }
    });
    let problem = Problem { rules, w: body.w, axes, planned: swing, loaded: 0.0 };
    problem.landing(problem.best(rules.swing.min(swing), swing), foothold, &foothold.compose(&home))
}

/// Both axes, and what may be changed.
struct Problem<'a> {
    rules: &'a gait::Reaction,
    /// \[1/s\] Rate of the pendulum.
    w: f64,
    axes: [Axis; 2],
    /// \[s\] Planned rest of the swing.
    planned: f64,
    /// \[s\] Until the foot lifts off.
    loaded: f64,
}

impl Problem<'_> {
    /// Change of the landing, and of the offset, of both axes if the foot lands after `r` \[s\].
    fn split(&self, r: f64) -> [[f64; 2]; 2] {
        self.axes.map(|a| a.split((self.w * r).exp(), self.rules.speed * (r - self.loaded)))
    }

    /// Which axes are caught then.
    fn caught(&self, r: f64) -> [bool; 2] {
        let [[_, x], [_, y]] = self.split(r);
        [x.abs() <= self.rules.tolerance[0], y.abs() <= self.rules.tolerance[1]]
    }

    /// The best rest of the swing between two ends. The objective is convex in it where boxes do not bind, and has one valley
    /// where they do.
    fn best(&self, low: f64, high: f64) -> f64 {
        least(low, high, |r| {
            let late = HASTE * (self.planned - r) * (self.planned - r);
            self.split(r).iter().map(|[u, b]| u * u + OFFSET * b * b).sum::<f64>() + late
        })
    }

    /// The landing after `r` \[s\], planned at `landing`.
    fn landing(&self, r: f64, foothold: &PlanarPose, landing: &PlanarPose) -> Landing {
        let [x, y] = self.split(r).map(|[moved, _]| moved);
        let local = foothold.relative(landing);
        let pose = foothold.compose(&PlanarPose { x: local.x + x, y: local.y + y, ..local });
        Landing { pose, rest: r, catches: self.caught(r) == [true; 2], held: false }
    }
}

/// Both axes of the stance foot.
fn axes(
    rules: &gait::Reaction,
    walk: &PlannedWalk,
    (k, t): (usize, f64),
    body: &Divergence,
    foot: [f64; 2],
    (sole, counted): (&Sole, [f64; 2]),
) -> [Axis; 2] {
    let s = &walk.strides[k];
    let at = &s.foothold;
    let xi = |t: f64| {
        let c = walk.plan.body.sample(t);
        at.local([c.position[0] + c.velocity[0] / body.w, c.position[1] + c.velocity[1] / body.w])
    };
    let (now, end) = (xi(t), xi(s.end));
    let growth = (body.w * (s.end - t)).exp();
    let landing = at.relative(&s.landing);
    let error = crate::pose::rotate(-at.heading, body.error);
    let foot = at.local(foot);
    let side = beside(rules, s.stance);
    [0, 1].map(|d| {
        let zmp = (end[d] - now[d] * growth) / (1.0 - growth);
        let half = counted[d] * sole.half[d];
        let planned = [landing.x, landing.y][d];
        // A plan may land outside of the box, and a zero-moment point be outside of the counted part: both stay where they are.
        let [low, high] = [rules.length, side][d];
        Axis {
            xi: now[d],
            end: end[d],
            zmp,
            landing: planned,
            error: error[d],
            shift: [(sole.center[d] - half - zmp).min(0.0), (sole.center[d] + half - zmp).max(0.0)],
            room: [low.min(planned), high.max(planned)],
            foot: foot[d],
        }
    })
}

/// \[m\] Room of a landing beside the foot `stance`: from, to.
fn beside(rules: &gait::Reaction, stance: usize) -> [f64; 2] {
    let [near, far] = rules.width;
    if nu(stance) > 0.0 { [near, far] } else { [-far, -near] }
}

/// Minimum of `cost` between two ends, if it has one valley: by golden section.
fn least(low: f64, high: f64, cost: impl Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let (mut low, mut high) = (low, high);
    let (mut a, mut b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut at_a, mut at_b) = (cost(a), cost(b));
    for _ in 0..NARROWINGS {
        if at_a <= at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - GOLDEN * (high - low);
            at_a = cost(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + GOLDEN * (high - low);
            at_b = cost(b);
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests;
