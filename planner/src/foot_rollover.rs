//! Foot rollover: toe joints and heel strike (thesis 4.5, (4.29), (4.30)).
//!
//! A foot path is the path of its *footprint*, flat. A positive pitch turns the foot about the front edge of that
//! footprint, a negative one about its rear edge, so an edge that touches the ground stays where it is: the rolling
//! condition is not a path of its own, it is how plans are read. A toe joint bends while the toe segment stays flat.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | peak | largest angle of a step, grows with its length (4.29), reached in the middle of the initial swing | rad |
//! | heel | pitch at landing, toes up, rolled flat in the loading response | rad |
//!
//! Values and slopes in between are those of least acceleration (4.30).

use crate::origin::PlanOrigin;
use crate::pose::PlanarPose;
use crate::steps::Stride;
use config::{Gait, gait, gait::Bend};
use curves::{Path, Sample, least_acceleration};
use messages::Plan;

/// A toe joint or the pitch of a sole over time.
pub(crate) type AnglePath<const N: usize> = Path<1, N>;

/// Share of a swing after which the heel is highest: the middle of the initial swing, its first third.
const PEAK: f64 = 1.0 / 6.0;
/// Shares of a swing at which a foot is level again, and at which it begins to turn its toes up.
const LEVEL: (f64, f64) = (0.6, 0.6);
/// Share of the double support after which a foot that landed on its heel lies flat.
const LOADING: f64 = 0.7;
/// Shares of a swing at which a foot that is lifted high has its toes down, and at which it is level again.
const TILTED: (f64, f64) = (0.3, 0.65);
/// Share of a swing after which the heel of the other foot is raised, in a step down.
const TIPTOE: f64 = 0.8;
/// \[rad\] Distance that a toe joint keeps from the end of its range.
const RESERVE: f64 = 0.02;

/// Rollover of the feet of one robot.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FootRollover {
    toes: Option<Bend>,
    heel: Option<Bend>,
    /// \[rad\] Pitch, toes down, of a foot that is lifted high, and toe joint of the foot from which the other one steps
    /// down; none: the robot stays on level ground.
    tilt: Option<f64>,
    /// \[rad\] Toe joints' angles at which the heel is highest, with their sign.
    range: [f64; 2],
}

impl FootRollover {
    /// `ranges` \[rad\] of the toe joints, right and left; a joint bends towards the farther end of its range.
    pub(crate) fn new(gait: &Gait, ranges: [Option<[f64; 2]>; 2]) -> Self {
        let farther = |[low, high]: [f64; 2]| if -low > high { low + RESERVE } else { high - RESERVE };
        Self {
            toes: gait.toes,
            heel: gait.heel_strike,
            tilt: gait.obstacles.map(|o| o.tilt),
            range: ranges.map(|r| r.map_or(0.0, farther)),
        }
    }

    /// Appends to the plan what both feet do in `strides`; after the last one the robot needs `settle` \[s\] to rest.
    pub(crate) fn lay(&self, from: &PlanOrigin, strides: &[Stride], settle: f64, plan: &mut Plan) {
        let flat = |k: usize, landing: f64| {
            landing + LOADING * strides.get(k).map_or(settle, |next| next.lift - next.begin)
        };
        let rest = Sample::rest([0.0]);
        for foot in 0..2 {
            let (mut toe, mut pitch) = (from.toes[foot], from.pitch[foot]);
            if foot == strides[0].stance && !rests(&pitch) {
                // It landed at the end of the plan before, and goes on rolling flat.
                plan.pitch[foot].push(&pitch, &rest, flat(0, 0.0));
                pitch = rest;
            }
            for (k, s) in strides.iter().enumerate().filter(|(_, s)| s.stance != foot) {
                // In a step down it stood on its toes while the other foot reached for the ground.
                if let Some(down) = k.checked_sub(1).map(|before| &strides[before]).filter(|s| s.descends()) {
                    toe = self.tiptoe(&mut plan.toes[foot], foot, down);
                }
                self.bend_toe(&mut plan.toes[foot], &toe, s);
                self.pitch(&mut plan.pitch[foot], &pitch, s, flat(k + 1, s.end));
                (toe, pitch) = (rest, rest);
            }
        }
    }

    /// Toes down while a foot that is lifted high is still behind.
    pub(crate) fn tilt<const N: usize>(
        &self,
        step: &gait::StepSettings,
        strides: &[Stride],
        pitch: &mut [AnglePath<N>; 2],
    ) {
        let Some(tilt) = self.tilt else { return };
        let (level, down) = (Sample::rest([0.0]), Sample::rest([tilt]));
        for s in strides.iter().filter(|s| s.is_high(step)) {
            let path = &mut pitch[1 - s.stance];
            let at = |share: f64| s.lift + share * (s.end - s.lift);
            if path.end() > s.lift {
                continue; // it rolls by itself
            }
            if s.lift > path.end() {
                path.push(&level, &level, s.lift);
            }
            path.push(&level, &down, at(TILTED.0));
            path.push(&down, &level, at(TILTED.1));
        }
    }

    /// Raises the heel of the foot that carries while the other one reaches down; how it is left.
    fn tiptoe<const N: usize>(&self, path: &mut AnglePath<N>, foot: usize, s: &Stride) -> Sample<1> {
        let range = self.range[foot];
        let up = Sample::rest([range.signum() * self.tilt.unwrap_or(0.0).min(range.abs())]);
        let begin = s.lift + TIPTOE * (s.end - s.lift);
        let rest = Sample::rest([0.0]);
        if self.toes.is_none() || up.position[0] == 0.0 || path.end() > begin {
            return rest;
        }
        path.push(&rest, &rest, begin);
        path.push(&rest, &up, s.end);
        up
    }

    /// Appends the toe motion of the foot that swings in `s`.
    fn bend_toe<const N: usize>(&self, path: &mut AnglePath<N>, from: &Sample<1>, s: &Stride) {
        let swing = 1 - s.stance;
        let range = self.range[swing];
        let peak = self.toes.map_or(0.0, |b| b.at(advance(&s.takeoff, &s.foothold))).min(range.abs());
        up_and_down(path, from, s, (range.signum() * peak, range.abs()), s.end);
    }

    /// Appends the pitch of the foot that swings in `s`; `flat` \[s\] is when its sole lies flat again.
    fn pitch<const N: usize>(&self, path: &mut AnglePath<N>, from: &Sample<1>, s: &Stride, flat: f64) {
        let heel = self.heel.map_or(0.0, |b| b.at(advance(&s.foothold, &s.landing)));
        let swing = |share: f64| s.lift + share * (s.end - s.lift);
        up_and_down(path, from, s, (0.0, f64::INFINITY), swing(LEVEL.0));
        if heel > 0.0 {
            let rest = Some([Some(0.0); 3]);
            let times = [swing(LEVEL.1), s.end, flat];
            let given = [rest, Some([Some(-heel), None, None]), rest].map(Option::unwrap_or_default);
            append(path, &times, &given);
        }
    }
}

/// A joint is straight, or a sole level, and stays so.
fn rests(s: &Sample<1>) -> bool {
    [s.position[0], s.velocity[0], s.acceleration[0]].iter().all(|x| x.abs() < 1e-12)
}

/// \[m\] Way that `to` lies ahead of `from`.
fn advance(from: &PlanarPose, to: &PlanarPose) -> f64 {
    from.relative(to).x
}

/// From `from` at the begin of the double support to the peak and back to zero at `end`; beyond `most` a peak is
/// lowered, because a path of least acceleration goes on rising after it.
fn up_and_down<const N: usize>(
    path: &mut AnglePath<N>,
    from: &Sample<1>,
    s: &Stride,
    (peak, most): (f64, f64),
    end: f64,
) {
    if peak == 0.0 && rests(from) {
        return;
    }
    let times = [s.begin.max(path.end()), s.lift + PEAK * (s.end - s.lift), end];
    if times[1] <= times[0] {
        // A swing that is past its peak already.
        path.push(from, &Sample::rest([0.0]), end);
        return;
    }
    let first = [from.position[0], from.velocity[0], from.acceleration[0]].map(Some);
    let given = |peak: f64| [first, [Some(peak), None, None], [Some(0.0); 3]];
    let begun = path.pieces;
    append(path, &times, &given(peak));
    let highest = (1..32)
        .map(|k| path.sample(times[0] + (end - times[0]) * f64::from(k) / 32.0).position[0].abs())
        .fold(0.0, f64::max);
    if highest > most {
        path.pieces = begun;
        append(path, &times, &given(peak * most / highest));
    }
}

/// Appends a rest until the first knot and the pieces of least acceleration through all knots.
fn append<const N: usize>(path: &mut AnglePath<N>, times: &[f64; 3], given: &[[Option<f64>; 3]; 3]) {
    let Some(knots) = least_acceleration(times, given) else { return };
    if times[0] > path.end() {
        path.push(&knots[0], &knots[0], times[0]);
    }
    for k in 1..3 {
        path.push(&knots[k - 1], &knots[k], times[k]);
    }
}
