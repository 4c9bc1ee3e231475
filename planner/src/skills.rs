//! Skills: tasks longer than a step cycle (thesis 4.3.4). One is active; the next one may wait for its end.
//!
//! A skill has two hooks in step sequence planning: [`Skill::before`] the standard planner sets lengths of steps,
//! [`Skill::after`] it changes its result.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | r | way that is left to the stance foot | m |
//! | l_i | lengths of the coming steps, their sum r | m |
//! | N | number of them | 1 |

use crate::commands;
use crate::origin::PlanOrigin;
use crate::pose::PlanarPose;
use crate::sole::Sole;
use crate::steps::{StepParameters, Stride};

use crate::verdict::Blocked;
use config::Gait;
use messages::command::{DistanceCommand, PlatformCommand, VelocityCommand};
use messages::{Detail, EventCode, Reason};

/// \[m\] Remaining distance treated as zero.
const NOTHING: f64 = 1e-6;
/// Most steps that are prescribed: with them and the last one a plan has knots enough.
const MOST: usize = 4;
/// Steps of a plan that are walked before there is another one.
const HEAD: usize = 2;
/// Most steps that are looked ahead to the end of a way.
const LOOK: usize = 24;

/// Lengths of the coming steps that a skill prescribes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Script {
    lengths: [f64; MOST],
    len: usize,
    /// After them the feet are closed.
    pub complete: bool,
    /// \[m\] No foothold lies farther ahead of the stance foot, if the steps are others than these.
    pub wall: f64,
}

impl Script {
    /// Nothing prescribed.
    pub const NONE: Self = Self { lengths: [0.0; MOST], len: 0, complete: false, wall: f64::INFINITY };

    /// \[m\] Length of step `n`, if it is prescribed.
    pub fn length(&self, n: usize) -> Option<f64> {
        self.lengths[..self.len].get(n).copied()
    }

    /// Do the feet close with step `n`?
    pub fn closes(&self, n: usize) -> bool {
        self.complete && n >= self.len
    }

    /// Number of steps until the feet close, if that is in sight.
    pub fn left(&self) -> Option<usize> {
        self.complete.then_some(self.len)
    }

    fn push(&mut self, length: f64) {
        self.lengths[self.len] = length;
        self.len += 1;
    }
}

/// Course of a skill: along the x axis of a pose, so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkillCourse {
    /// Between the feet where it begins, in I_0.
    begin: PlanarPose,
    /// \[m\] Its length, negative backwards.
    length: f64,
    /// Largest step.
    cruise: StepParameters,
    /// \[m\] Change of length from step to step.
    change: f64,
    /// \[m\] Longest step out of standing and into it.
    ends: f64,
}

/// Skill: a task that is being done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Skill {
    /// Normal walking: nothing is modified.
    Walk,
    /// Fixed distance, from standing to standing.
    Distance(SkillCourse),
    /// Onto a platform or off it: the way to its edge, how far behind the last foothold before it the next one lies
    /// \[m\], height in I_0 of the ground before it and behind it \[m\], the edge itself on the way \[m\].
    Platform {
        /// To the last foothold before the edge.
        way: SkillCourse,
        /// \[m\] Length of the step over the edge.
        over: f64,
        /// \[m\] Position of the edge on the way.
        edge: f64,
        /// \[m\] Heights in I_0 of the ground before and behind it.
        ground: [f64; 2],
    },
}

/// Place of the speed among the fields of a distance.
const SPEED: u8 = 1;

/// Task to begin with from standing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SkillTask {
    /// See [`Skill::Distance`].
    Distance(DistanceCommand),
    /// See [`Skill::Platform`].
    Platform(PlatformCommand),
}

impl SkillTask {
    /// Checks that the gait is as fast as it asks.
    ///
    /// # Errors
    /// The limit of its speed, forward or back.
    pub(crate) fn check_speed(&self, gait: &Gait) -> Result<(), Reason> {
        let Self::Distance(d) = self else { return Ok(()) };
        match cruise(d, gait) {
            Err(Reason::Limit { low, high, .. }) => {
                let high = if d.distance < 0.0 { -low } else { high };
                Err(Reason::Limit { field: SPEED, low: 0.0, high })
            }
            _ => Ok(()),
        }
    }

    /// Checks that the robot can do it; otherwise code and detail of an event.
    ///
    /// # Errors
    /// Out of the limits of the gait; a platform too high, too far for one step or too near.
    pub(crate) fn check(&self, gait: &Gait, sole: &Sole) -> Result<(), Blocked> {
        let no = |code, x: f64| Err((code, Detail::Millimetres((x.abs() * 1e3).round() as u64)));
        match self {
            Self::Distance(d) => match cruise(d, gait) {
                Ok(Some(_)) if d.distance.is_finite() && d.acceleration > 0.0 => Ok(()),
                _ => no(EventCode::NoFoothold, d.distance),
            },
            Self::Platform(p) => {
                let Some(rules) = &gait.obstacles else { return no(EventCode::ObstacleTooHigh, p.height) };
                let toes = sole.center[0] + sole.half[0] + rules.distance;
                let over = 2.0 * (sole.half[0] + rules.distance);
                if !(p.height.abs() <= rules.height) {
                    no(EventCode::ObstacleTooHigh, p.height)
                } else if over > rules.length {
                    no(EventCode::ObstacleTooLong, over)
                } else if !(p.distance >= toes && p.distance.is_finite()) {
                    no(EventCode::NoFoothold, p.distance)
                } else {
                    Ok(())
                }
            }
        }
    }

    /// The skill that does it, from where the robot stands; `None` if it cannot.
    pub(crate) fn begin(&self, from: &PlanOrigin, gait: &Gait, sole: &Sole) -> Option<Skill> {
        self.check(gait, sole).ok()?;
        let [r, l] = from.feet;
        let middle = PlanarPose::new(0.5 * (r.x + l.x), 0.5 * (r.y + l.y), 0.5 * (r.heading + l.heading));
        let begin = from.frame.compose(&middle);
        match self {
            Self::Distance(d) => {
                let cruise = cruise(d, gait).ok()??;
                let change = d.acceleration * cruise.duration * cruise.duration;
                let ends = gait.step.first_length.min(change);
                let change = gait.step.change[0].min(change);
                Some(Skill::Distance(SkillCourse { begin, length: d.distance, cruise, change, ends }))
            }
            Self::Platform(p) => {
                // Its last foothold before the edge keeps the distance of one before an obstacle.
                let rules = gait.obstacles.as_ref()?;
                let length = p.distance - rules.distance - sole.center[0] - sole.half[0];
                let cruise = StepParameters {
                    length: gait.step.first_length,
                    ..StepParameters::on_the_spot(rules.duration)
                };
                Some(Skill::Platform {
                    way: SkillCourse {
                        begin,
                        length,
                        cruise,
                        change: gait.step.change[0],
                        ends: gait.step.first_length,
                    },
                    over: 2.0 * (sole.half[0] + rules.distance),
                    edge: p.distance,
                    ground: [from.height, from.height + p.height],
                })
            }
        }
    }
}

/// One active skill, and what comes next.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tasks {
    /// The active one.
    pub active: Skill,
    /// Task that begins when the robot stands.
    pub next: Option<SkillTask>,
    /// The active one is given up: the robot stops.
    pub aborted: bool,
}

impl Default for Tasks {
    fn default() -> Self {
        Self { active: Skill::Walk, next: None, aborted: false }
    }
}

impl Tasks {
    /// The next skill begins, normal walking if there is none; `false` if it cannot.
    pub(crate) fn begin(&mut self, from: &PlanOrigin, gait: &Gait, sole: &Sole) -> bool {
        let next = self.next.take();
        let skill = next.map(|task| task.begin(from, gait, sole));
        (self.active, self.aborted) = (skill.flatten().unwrap_or(Skill::Walk), false);
        skill != Some(None)
    }

    /// The operator stops: nothing comes next, and what is being done is not done to its end.
    pub(crate) fn stop(&mut self) {
        (self.next, self.aborted) = (None, true);
    }

    /// The operator walks from now on; `false` while that would leave the robot half on a platform.
    pub(crate) fn walk(&mut self, standing: bool) -> bool {
        let free = standing || !matches!(self.active, Skill::Platform { .. });
        if free {
            *self = Self::default();
        }
        free
    }

    /// [`Skill::before`] of the active one.
    pub(crate) fn before(
        &self,
        from: &PlanOrigin,
        starting: bool,
        first: f64,
        wish: &mut StepParameters,
    ) -> Script {
        let mut as_commanded = *wish;
        let wish = if self.aborted { &mut as_commanded } else { wish };
        let script = self.active.before(from, starting, first, wish);
        if self.aborted { Script { wall: script.wall, ..Script::NONE } } else { script }
    }
}

/// Steps with which the distance is walked.
fn cruise(d: &DistanceCommand, gait: &Gait) -> Result<Option<StepParameters>, Reason> {
    let forward = d.speed.copysign(d.distance);
    commands::from_velocity(&VelocityCommand { forward, left: 0.0, turn: 0.0 }, gait)
}

impl SkillCourse {
    /// \[m\] r
    fn left(&self, from: &PlanOrigin) -> f64 {
        self.length - self.begin.relative(&from.frame).x
    }
}

impl Skill {
    /// Before the standard planner: what the steps shall be, and the lengths of the next ones. `first` \[m\] is the
    /// longest step of the gait out of standing and into it.
    pub fn before(&self, from: &PlanOrigin, starting: bool, first: f64, wish: &mut StepParameters) -> Script {
        let (way, over) = match self {
            Self::Walk => return Script::NONE,
            Self::Distance(way) => (way, None),
            Self::Platform { way, over, .. } => (way, Some(*over)),
        };
        *wish = way.cruise;
        let first = first.min(way.ends);
        let r = way.left(from);
        let sign = way.cruise.length.signum();
        let previous = if starting { (first - way.change).max(0.0) } else { from.previous.length * sign };
        // Along the way lengths count forward, whichever way she walks.
        let mut script = Script::NONE;
        script.complete = true;
        if r * sign > NOTHING {
            lengths(r * sign, previous, way, (first, MOST - usize::from(over.is_some())), &mut script);
            script.lengths[..script.len].iter_mut().for_each(|l| *l *= sign);
        }
        // Behind the last foothold of the way comes the step over the edge.
        if let Some(over) = over {
            script.wall = if r > -NOTHING { r.max(0.0) } else { f64::INFINITY };
            if r > -NOTHING && script.complete {
                script.push(over);
            }
        }
        script
    }

    /// After the standard planner: heights of the footholds.
    pub fn after(&self, from: &PlanOrigin, strides: &mut [Stride]) {
        let Self::Platform { way, edge, ground, .. } = self else { return };
        let mut before = None;
        for s in strides {
            if let Some((foothold, takeoff)) = before {
                (s.heights.foothold, s.heights.takeoff) = (foothold, takeoff);
            }
            let at = way.begin.relative(&from.frame.compose(&s.landing)).x;
            s.heights.landing = ground[usize::from(at > *edge)] - from.height;
            s.heights.of_skill = true;
            before = Some((s.heights.landing, s.heights.foothold));
        }
    }
}

/// The fewest steps from `previous` \[m\] to the end of a way of `r` \[m\], each at most as long as it may be: no longer
/// than those of the cruise, no more than a change away from the one before, and the last one short enough to stop.
/// Scaled to end exactly there. Without an end in sight, or where scaled ones would slow down too much, as long as lets her slow
/// down by one change after the other. At most `most_steps` are prescribed.
fn lengths(r: f64, previous: f64, way: &SkillCourse, (first, most_steps): (f64, usize), script: &mut Script) {
    let most = way.cruise.length.abs();
    let step = |i: usize, n: usize| {
        let up = previous + i as f64 * way.change;
        let down = first + (n - i) as f64 * way.change;
        most.min(up).min(down)
    };
    let sum = |n: usize| (1..=n).map(|i| step(i, n)).sum::<f64>();
    // Scaled steps may be more than a change shorter than the one before.
    let gentle = |n: usize| previous - r / sum(n) * step(1, n) <= way.change + NOTHING;
    if let Some(n) = (1..=LOOK).find(|&n| sum(n) >= r).filter(|&n| gentle(n)) {
        script.complete = n <= most_steps;
        let scale = r / sum(n);
        (1..=if script.complete { n } else { HEAD }).for_each(|i| script.push(scale * step(i, n)));
        return;
    }

    // Braking steps l, l - c, ... are m + 1, and the last one is shorter than c: l = left / (m + 1) + m c / 2.
    let c = way.change;
    let braking = |left: f64| {
        let m = (((1.0 + 8.0 * left / c).sqrt() - 1.0) / 2.0).floor();
        (left / (m + 1.0) + 0.5 * m * c, m as usize + 1)
    };
    let (length, n) = braking(r);
    script.complete = n <= most_steps && length <= most.min(previous + c);
    let (mut left, mut before) = (r, previous);
    for _ in 0..if script.complete { n } else { HEAD } {
        let length = most.min(before + c).min(braking(left).0);
        script.push(length);
        (left, before) = (left - length, length);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn way(length: f64, most: f64, change: f64) -> SkillCourse {
        let cruise = StepParameters { length: most, ..StepParameters::on_the_spot(1.0) };
        SkillCourse { begin: PlanarPose::default(), length, cruise, change, ends: f64::INFINITY }
    }

    /// All the way, step by step, as the planner asks.
    fn walk(r: f64, most: f64, change: f64, first: f64) -> Vec<f64> {
        let (mut left, mut previous, mut all) = (r, (first - change).max(0.0), Vec::new());
        while left > NOTHING {
            let mut script = Script::NONE;
            lengths(left, previous, &way(r, most, change), (first, MOST), &mut script);
            let l = script.lengths[0];
            all.push(l);
            (left, previous) = (left - l, l);
            assert!(all.len() < 500);
        }
        all
    }

    #[test]
    fn a_way_ends_exactly_and_changes_gently() {
        for k in 1..300 {
            let r = 0.02 * k as f64;
            let all = walk(r, 0.5, 0.12, 0.3);
            assert!((all.iter().sum::<f64>() - r).abs() < 1e-9);
            assert!(all[0] <= 0.3 + 1e-12 && all[all.len() - 1] <= 0.3 + 1e-12, "{all:?}");
            assert!(all.windows(2).all(|p| (p[1] - p[0]).abs() <= 0.12 + 1e-9), "{all:?}");
            assert!(all.iter().all(|l| *l <= 0.5 + 1e-12 && *l > 0.0), "{all:?}");
        }
    }

    /// Changes so small that the steps in which she slows down are more than are looked ahead.
    #[test]
    fn a_long_way_with_small_changes_ends_gently() {
        for k in 1..60 {
            let (r, change) = (0.2 * k as f64, 0.005 + 1e-3 * (k % 7) as f64);
            let all = walk(r, 0.4, change, change);
            assert!((all.iter().sum::<f64>() - r).abs() < NOTHING);
            let ends = [0.0].into_iter().chain(all.iter().copied()).chain([0.0]).collect::<Vec<_>>();
            assert!(ends.windows(2).all(|p| (p[1] - p[0]).abs() <= change + 2.0 * NOTHING), "{all:?}");
        }
    }

    /// The closed form: steps of l, of which n are needed, are all r / n long.
    #[test]
    fn steps_without_ramps_are_equal() {
        let all = walk(2.0, 0.3, 1.0, 0.3);
        assert_eq!(all.len(), 7);
        assert!(all.iter().all(|l| (l - 2.0 / 7.0).abs() < 1e-12), "{all:?}");
    }
}
