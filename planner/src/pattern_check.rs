//! Whether a robot can walk a pattern: reach of its legs, ranges and speeds of their joints, feet that collide, soles in
//! the ground. Checked on the walk itself, out of standing and into it, at every point of the drives' tables and at no fewer
//! than `LEAST_POINTS` of a stride.

use crate::footsteps::StepDemand;
use crate::origin::PlanOrigin;
use crate::pattern::PatternTrajectories;
use crate::planned_walk::PlannedWalk;
use crate::pose::PlanarPose;
use crate::skills::{Script, Skill};
use crate::sole::Sole;
use crate::steps::StepParameters;
use crate::walk::Builder;
use config::pattern::Pattern;
use config::tables::PLAN_POINTS;
use config::{Gait, LegError, Robot, TableDrives};
use curves::Sample;
use messages::{GaitState, LEFT, MAX_JOINTS, Plan, RIGHT};
use std::f64::consts::FRAC_PI_2;
use std::fmt;

/// Plans of the walk that is looked at.
const PLANS: usize = 5;
/// \[1\] Points of a stride that are looked at, at least: as many as the thesis's tables have.
const LEAST_POINTS: u64 = 300;
/// \[1\] Times as many are looked at then: between those points a joint can pass the end of its range by 4e-5 rad.
const FINER: f64 = 10.0;
/// \[m\] Sole below the ground that is rounding.
const ROUNDING: f64 = 1e-9;

/// Rule that a pattern breaks first, with value and bound.
#[derive(Clone, Debug, PartialEq)]
pub enum PatternFault {
    /// The gait has no `[pattern]`.
    NoPattern,
    /// The robot has no legs in closed form.
    NoLegs,
    /// A key of the file breaks an order.
    Order(&'static str, String),
    /// A leg cannot take its pose.
    Leg {
        /// Foot: 0 right, 1 left.
        foot: usize,
        /// Name of the joint, if one is the reason.
        joint: Option<String>,
        /// \[s\] Instant, from the begin of a walk out of standing.
        time: f64,
        /// Reason.
        why: LegError,
    },
    /// A joint would turn faster than its motor can.
    Speed {
        /// Its name.
        joint: String,
        /// \[s\] Instant.
        time: f64,
        /// \[rad/s\] Its speed.
        speed: f64,
        /// \[rad/s\] The limit.
        limit: f64,
    },
    /// The swinging foot would touch the other one.
    Collision {
        /// \[s\] Instant.
        time: f64,
        /// \[m\] Distance of the soles from side to side; negative: they overlap.
        distance: f64,
    },
    /// A sole would be in the ground.
    Ground {
        /// Foot: 0 right, 1 left.
        foot: usize,
        /// \[s\] Instant.
        time: f64,
        /// \[m\] How deep.
        depth: f64,
    },
}

impl fmt::Display for PatternFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = |foot: usize| if foot == RIGHT { "right" } else { "left" };
        if *self == Self::NoPattern {
            return write!(f, "the gait has no [pattern]; its walks depend on the robot's masses");
        }
        write!(f, "[pattern] cannot be walked: ")?;
        match self {
            Self::NoPattern => Ok(()),
            Self::NoLegs => write!(
                f,
                "the robot has no [leg.right] and [leg.left], and a pattern is solved in closed form"
            ),
            Self::Order(key, text) => write!(f, "{key} = {text}"),
            Self::Leg { foot, joint, time, why } => {
                write!(f, "{} leg, {time:.2} s after the begin: ", side(*foot))?;
                match (joint, why) {
                    (Some(name), LegError::JointLimit { value, range, .. }) => {
                        let [value, lo, hi] = [*value, range[0], range[1]].map(f64::to_degrees);
                        write!(
                            f,
                            "joint {name} would be at {value:.3} deg; its range is {lo:.3} to {hi:.3} deg"
                        )
                    }
                    _ => write!(f, "{why}"),
                }
            }
            Self::Speed { joint, time, speed, limit } => write!(
                f,
                "joint {joint} would turn with {speed:.3} rad/s {time:.2} s after the begin, and its limit is {limit:.3}; \
                 a longer T_c"
            ),
            Self::Collision { time, distance } => write!(
                f,
                "{time:.2} s after the begin the soles are {:.1} mm apart, and overlap lengthwise; more w_s or w_p",
                1e3 * distance
            ),
            Self::Ground { foot, time, depth } => write!(
                f,
                "{time:.2} s after the begin the {} sole would be {:.2} mm in the ground; more H_ao, less q_b, q_f",
                side(*foot),
                1e3 * depth
            ),
        }
    }
}

impl std::error::Error for PatternFault {}

impl PatternFault {
    /// The same with the gait that it is of: by its name in `config/gaits`.
    pub fn of_gait(&self, name: &str) -> String {
        format!("gaits/{name}.toml: {self}")
    }
}

/// A plan of a walk, and how much of it is walked.
pub struct WalkedPlan {
    /// The plan.
    pub plan: Box<Plan>,
    /// \[s\] Its begin in the walk.
    pub began: f64,
    /// \[s\] Until then, from its own begin.
    pub end: f64,
}

/// Plans of a walk as a pattern lays them: half a step out of standing, four steps, half a step into standing; from the
/// fourth plan on they are periodic. Whether the robot can walk them is not asked.
///
/// # Errors
/// The gait has no pattern, or one that is not in order; the robot has no legs in closed form.
pub fn walk_of(gait: &Gait, robot: &Robot) -> Result<Vec<WalkedPlan>, PatternFault> {
    let pattern = gait.pattern.as_ref().ok_or(PatternFault::NoPattern)?;
    let soles = robot.feet.each_ref().map(|foot| Sole::new(foot.support));
    plans(
        &mut Builder::new(gait, soles).with_pattern(PatternTrajectories::new(pattern, robot)),
        pattern,
        robot,
    )
}

/// Checks the pattern of `builder` on the walk of [`walk_of`].
///
/// # Errors
/// The first rule that is broken.
pub(crate) fn check(builder: &mut Builder, pattern: &Pattern, robot: &Robot) -> Result<(), PatternFault> {
    // Drives that get a point in every cycle need none of these tables: few points must not hide what is between them.
    let points = pattern.points * LEAST_POINTS.div_ceil(pattern.points.max(1));
    let spacing = 2.0 * pattern.step_time / points as f64;
    let plans = plans(builder, pattern, robot)?;
    for spacing in [spacing, spacing / FINER] {
        plans.iter().try_for_each(|walked| PlanVisit { robot, walked, spacing }.all())?;
    }
    match &robot.tables {
        Some(tables) => plans.iter().try_for_each(|walked| room(tables, pattern, &walked.plan)),
        None => Ok(()),
    }
}

/// Tables of two plans have room in a drive.
fn room(tables: &TableDrives, pattern: &Pattern, plan: &Plan) -> Result<(), PatternFault> {
    let points = tables.points(pattern, plan.end());
    if points <= PLAN_POINTS {
        return Ok(());
    }
    let n = pattern.points;
    let text = format!(
        "{n} gives {points} points to a plan of {:.2} s, and the drives have room for {PLAN_POINTS}: fewer, further apart",
        plan.end()
    );
    Err(PatternFault::Order("N", text))
}

fn plans(builder: &mut Builder, pattern: &Pattern, robot: &Robot) -> Result<Vec<WalkedPlan>, PatternFault> {
    if robot.legs.is_none() {
        return Err(PatternFault::NoLegs);
    }
    if let Some((key, text)) = pattern.disorder() {
        return Err(PatternFault::Order(key, text));
    }
    let mut walk = PlannedWalk::new();
    let wish = StepParameters { length: pattern.length, side: 0.0, turn: 0.0, duration: pattern.step_time };
    let mut from = standing(pattern, builder.model.soles[RIGHT].center[0]);
    let (mut state, mut began) = (GaitState::Starting, 0.0);
    let mut plans = Vec::with_capacity(PLANS);
    // Each plan is walked for a step, as the planner does; the last one to its end.
    for k in 1..=PLANS {
        let (skill, script) = (Skill::Walk, Script::NONE);
        let demand = StepDemand { from: &from, state, wish, share: 1.0, skill, script };
        builder.walk(&demand, &mut walk);
        let first = walk.strides[0];
        let end = if k == PLANS { walk.end_cycle as f64 * builder.model.cycle_s } else { first.end };
        plans.push(WalkedPlan { plan: walk.plan.clone(), began, end });
        began += end;
        let soles = walk.soles(end);
        from = PlanOrigin::on_plan(&walk, end, soles, 1 - first.stance, first.parameters, Some(first.width));
        state = GaitState::Walking;
    }
    Ok(plans)
}

/// Standing as the pattern stands.
fn standing(p: &Pattern, ahead: f64) -> PlanOrigin {
    let rest = StepParameters::on_the_spot(p.step_time);
    PlanOrigin {
        frame: PlanarPose::default(),
        height: 0.0,
        stance: RIGHT,
        feet: [PlanarPose::default(), PlanarPose::new(0.0, p.width, 0.0)],
        heights: [0.0; 2],
        body: Sample::rest([ahead, 0.5 * p.width, p.heights[0]]),
        zmp: [ahead, 0.5 * p.width],
        torso: Sample::rest([FRAC_PI_2, FRAC_PI_2, 0.0]),
        pitch: [Sample::rest([0.0]); 2],
        toes: [Sample::rest([0.0]); 2],
        load_left: 0.5,
        previous: rest,
        width: p.width,
        early: None,
        inside: None,
    }
}

/// A plan that is looked at, point by point.
struct PlanVisit<'a> {
    robot: &'a Robot,
    walked: &'a WalkedPlan,
    /// \[s\]
    spacing: f64,
}

impl PlanVisit<'_> {
    /// As far as it is walked.
    fn all(&self) -> Result<(), PatternFault> {
        let end = self.walked.end;
        let n = (end / self.spacing).ceil() as usize;
        let mut last = None;
        for i in 0..=n {
            let t = (i as f64 * self.spacing).min(end);
            let angles = self.angles(t)?;
            if let Some((before, then)) = last {
                self.speeds(&angles, before, t, then)?;
            }
            self.soles(t)?;
            last = Some((angles, t));
        }
        Ok(())
    }

    fn angles(&self, t: f64) -> Result<[f64; MAX_JOINTS], PatternFault> {
        let mut angles = [0.0; MAX_JOINTS];
        let solved = self.robot.angles_of_plan(&self.walked.plan, t, &mut angles);
        solved.map(|()| angles).map_err(|(foot, why)| {
            let joint = match why {
                LegError::JointLimit { joint, .. } => Some(self.robot.joints[joint].name.clone()),
                _ => None,
            };
            PatternFault::Leg { foot, joint, time: self.walked.began + t, why }
        })
    }

    /// Mean speeds from one point to the next.
    fn speeds(
        &self,
        now: &[f64; MAX_JOINTS],
        before: [f64; MAX_JOINTS],
        t: f64,
        then: f64,
    ) -> Result<(), PatternFault> {
        for (j, joint) in self.robot.joints.iter().enumerate().filter(|_| t > then) {
            let speed = ((now[j] - before[j]) / (t - then)).abs();
            if !(speed <= joint.speed_limit) {
                let (joint, limit) = (joint.name.clone(), joint.speed_limit);
                return Err(PatternFault::Speed { joint, time: self.walked.began + t, speed, limit });
            }
        }
        Ok(())
    }

    /// Feet that do not touch one another, and soles that are not in the ground.
    fn soles(&self, t: f64) -> Result<(), PatternFault> {
        let mut reach = [[0.0; 2]; 2];
        let mut sides = [0.0; 2];
        for foot in 0..2 {
            let [rear, front, right, left] = self.robot.feet[foot].support;
            let (sole, pitch) = self.walked.plan.sole(foot, t, [rear, front]);
            let ([x, y, z, _], [angle]) = (sole.position, pitch.position);
            let depth = [rear, front].map(|edge| edge * angle.sin() - z).into_iter().fold(f64::MIN, f64::max);
            if !(depth <= ROUNDING) {
                return Err(PatternFault::Ground { foot, time: self.walked.began + t, depth });
            }
            reach[foot] = [x + rear * angle.cos(), x + front * angle.cos()];
            sides[foot] = y + if foot == RIGHT { left } else { right };
        }
        let overlap = reach[RIGHT][1].min(reach[LEFT][1]) - reach[RIGHT][0].max(reach[LEFT][0]);
        let distance = sides[LEFT] - sides[RIGHT];
        if overlap > 0.0 && !(distance > 0.0) {
            return Err(PatternFault::Collision { time: self.walked.began + t, distance });
        }
        Ok(())
    }
}
