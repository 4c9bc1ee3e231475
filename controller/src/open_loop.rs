//! Open loop: joint targets from the plan alone, its legs solved in closed form (Daniali 2013, figure 4.30 and 5.10).
//!
//! Neither force nor inertial sensors are read, and nothing is corrected: what the ground and the weight do to the robot
//! stays. Joint targets are published as every controller does, so that limits, staleness and following errors are judged
//! in the same place.

use config::pattern::Pattern;
use config::{LegError, Robot};
use messages::{Header, Imu, JointTables, MAX_JOINTS, Plan, Sensors, Wrench};

use crate::plan_tables::PlanTables;

/// \[s\] Time in which joints that do not rest where the first plan begins come to it: less than it takes to stand up.
const ONSET: f64 = 1.5;
/// \[s\] Distance of the instants from which speeds are found: their error is 1e-9 rad/s.
const INSTANTS: f64 = 1e-4;

/// The open-loop control of one robot.
#[derive(Clone)]
pub(crate) struct OpenLoop {
    /// \[s\] Bus cycle.
    dt: f64,
    /// None: no plan has begun, or is to begin.
    onset: Option<Onset>,
    /// Tables of the plan to come, for drives that play them.
    tables: Option<PlanTables>,
}

/// Joints that come to the first plan.
#[derive(Clone, Copy)]
struct Onset {
    /// \[rad\] How far they rested from where it began.
    offset: [f64; MAX_JOINTS],
    /// Cycle with which it began.
    start_tick: u64,
}

/// Joint targets: angles \[rad\] and speeds \[rad/s\].
pub(crate) type OpenLoopTargets = ([f64; MAX_JOINTS], [f64; MAX_JOINTS]);

/// Foot, and why its leg cannot take its pose.
type Unreachable = (usize, LegError);

impl OpenLoop {
    /// For a robot that walks a pattern in bus cycles of `dt` \[s\].
    pub(crate) fn new(robot: &Robot, pattern: &Pattern, dt: f64) -> Self {
        Self { dt, onset: None, tables: PlanTables::new(robot, pattern, dt) }
    }

    /// Begins anew, with the next plan.
    pub(crate) fn reset(&mut self) {
        self.onset = None;
    }

    /// Joint targets for plan time `t` \[s\], a cycle after those `now` \[rad\].
    ///
    /// # Errors
    /// Foot and reason, where a leg cannot take its pose; the next cycle may go on.
    pub(crate) fn targets(
        &mut self,
        robot: &Robot,
        plan: &Plan,
        now: &[f64; MAX_JOINTS],
        t: f64,
    ) -> Result<OpenLoopTargets, Unreachable> {
        let onset = match self.onset {
            Some(onset) => onset,
            None => Onset::new(robot, plan, now)?,
        };
        self.onset = Some(onset);
        let at = |t: f64| onset.angles(robot, plan, now, t, self.dt);
        let (angle, before, after) = (at(t)?, at(t - INSTANTS)?, at(t + INSTANTS)?);
        Ok((angle, std::array::from_fn(|j| (after[j] - before[j]) / (2.0 * INSTANTS))))
    }

    /// Some more points of the tables of the plan that is `next`, if the drives play tables; the joints are at `now` \[rad\],
    /// at rest if no plan is followed yet. False if the plan cannot be followed.
    pub(crate) fn fill_tables(
        &mut self,
        robot: &Robot,
        next: Option<&Plan>,
        (header, follows): (&Header, bool),
        now: &[f64; MAX_JOINTS],
    ) -> bool {
        let Self { dt, onset, tables: Some(tables) } = self else { return true };
        let Some(plan) = next else {
            tables.pause();
            return true;
        };
        if tables.plan() != plan.id && !follows {
            *onset = Onset::new(robot, plan, now).ok();
        }
        let Some(onset) = onset else { return false };
        tables.fill(robot, plan, header, |t, angles| match onset.angles(robot, plan, now, t, *dt) {
            Ok(at) => *angles = at,
            Err(_) => angles.fill(f64::NAN),
        })
    }

    /// True if the drives play tables.
    pub(crate) fn plays_tables(&self) -> bool {
        self.tables.is_some()
    }

    /// Tables that were completed in this cycle.
    pub(crate) fn tables(&self) -> Option<&JointTables> {
        self.tables.as_ref().and_then(PlanTables::whole)
    }
}

impl Onset {
    /// Joints that rest at `now` \[rad\] before a plan, which begins at rest where it takes them to be.
    fn new(robot: &Robot, plan: &Plan, now: &[f64; MAX_JOINTS]) -> Result<Self, Unreachable> {
        let mut begin = *now;
        robot.angles_of_plan(plan, 0.0, &mut begin)?;
        Ok(Self { offset: std::array::from_fn(|j| now[j] - begin[j]), start_tick: plan.start_tick })
    }

    /// Angles \[rad\] at time `t` \[s\] of a plan; joints outside of the legs stay at `now`.
    fn angles(
        &self,
        robot: &Robot,
        plan: &Plan,
        now: &[f64; MAX_JOINTS],
        t: f64,
        dt: f64,
    ) -> Result<[f64; MAX_JOINTS], Unreachable> {
        let mut angles = *now;
        robot.angles_of_plan(plan, t.max(0.0), &mut angles)?;
        let since = plan.start_tick.saturating_sub(self.start_tick) as f64 * dt + t;
        let u = (since / ONSET).clamp(0.0, 1.0);
        let left = 1.0 - u * u * u * (10.0 - u * (15.0 - 6.0 * u));
        (0..robot.joints.len()).for_each(|j| angles[j] += left * self.offset[j]);
        Ok(angles)
    }
}

/// Sensor data of a robot that has encoders only: upright, and without load.
pub(crate) fn encoders_only(sensors: &Sensors) -> Sensors {
    let imu = Imu { orientation: [0.0, 0.0, 0.0, 1.0], angular_velocity: [0.0; 3], ..Imu::default() };
    Sensors { imu, foot_wrench: [Wrench::default(); 2], ..*sensors }
}
