//! Tables of the plan to come: filled in the cycles before its start, and published when they are whole.
//!
//! Point i lies i m T_s after the start; the last point stands twice, at rest, after the end of the plan. A plan takes over
//! from the one before where a step ends, which is a point of both.

use config::pattern::Pattern;
use config::tables::PLAN_POINTS;
use config::{Robot, TableDrives};
use messages::{Header, JointTables, Joints, Plan};

use crate::table_builder::{Filled, TableBuilder, TableOrder};

/// Tables for one robot that walks a pattern.
#[derive(Clone)]
pub(crate) struct PlanTables {
    drives: TableDrives,
    builder: TableBuilder,
    /// \[s\] Bus cycle.
    dt: f64,
    pattern: Pattern,
    /// Number of the plan that they are of.
    plan: u64,
    /// They were completed in this cycle.
    whole: bool,
}

impl PlanTables {
    /// For a robot; none if its drives play no tables.
    pub(crate) fn new(robot: &Robot, pattern: &Pattern, dt: f64) -> Option<Self> {
        let drives = robot.tables.clone()?;
        Some(Self {
            builder: TableBuilder::new(robot)?,
            dt,
            pattern: *pattern,
            plan: 0,
            whole: false,
            drives,
        })
    }

    /// Number of the plan that they are of; 0: none.
    pub(crate) fn plan(&self) -> u64 {
        self.plan
    }

    /// The tables, in the cycle in which they were completed.
    pub(crate) fn whole(&self) -> Option<&JointTables> {
        self.whole.then(|| self.builder.tables())
    }

    /// No plan is to come.
    pub(crate) fn pause(&mut self) {
        self.whole = false;
    }

    /// A cycle of filling tables of a plan by its `path`: angles \[rad\] at a time \[s\]. False if the plan has more points than
    /// there is room for, starts before its tables can be in the drives, or asks for what no joint can take.
    pub(crate) fn fill(
        &mut self,
        robot: &Robot,
        plan: &Plan,
        header: &Header,
        path: impl FnMut(f64, &mut Joints),
    ) -> bool {
        self.whole = false;
        if self.plan != plan.id {
            self.plan = plan.id;
            let points = self.drives.points(&self.pattern, plan.end());
            let lead = self.drives.plan_lead(&robot.layout, self.dt, points);
            let order = TableOrder {
                plan: plan.id,
                start_tick: plan.start_tick,
                spacing: self.drives.spacing(&self.pattern),
                points,
                cyclic: false,
            };
            if points > PLAN_POINTS || header.tick + lead > plan.start_tick || !self.builder.begin(&order) {
                return false;
            }
        }
        let filled = self.builder.fill(path);
        self.whole = filled == Filled::Complete;
        self.builder.stamp(*header);
        !matches!(filled, Filled::NotFinite { .. })
    }
}
