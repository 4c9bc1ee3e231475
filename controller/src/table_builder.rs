//! Tables of points for drives that play them by themselves, filled from a path of the joints a few points each cycle.

use config::Robot;
use config::tables::POINTS_FILLED;
use messages::{Header, JointTables, Joints, MAX_JOINTS, MAX_POINTS};

/// Tables to be filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableOrder {
    /// \[1\] Number of the plan, ascending.
    pub plan: u64,
    /// \[1\] Cycle with which the drives begin: point 0 is where the joints are then. Its lead over the cycle in which the
    /// tables are complete is at least [`config::TableDrives::lead`].
    pub start_tick: u64,
    /// \[1\] @range 1..=256 Samples of the drives' controllers from point to point: m.
    pub spacing: u32,
    /// \[1\] @range 2..=1024 Points: N.
    pub points: usize,
    /// The last point is followed by the first one.
    pub cyclic: bool,
}

/// Result of a cycle of filling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filled {
    /// There is nothing to fill, or more to come.
    More,
    /// The tables are complete.
    Complete,
    /// The path is not finite for this joint at this point, from 1, or beyond what an encoder counts; nothing comes of these
    /// tables.
    NotFinite {
        /// Index in the robot's joint table.
        joint: usize,
        /// \[1\] From 1.
        point: usize,
    },
}

/// Builder of tables for one robot.
#[derive(Clone, Debug)]
pub struct TableBuilder {
    tables: Box<JointTables>,
    /// \[s\] Sampling period of the drives.
    sampling: f64,
    joints: usize,
    filled: usize,
    fills: bool,
}

impl TableBuilder {
    /// For a robot; none if its drives play no tables.
    pub fn new(robot: &Robot) -> Option<Self> {
        let sampling = f64::from(robot.tables.as_ref()?.sampling_us) * 1e-6;
        let joints = robot.joints.len();
        let mut tables = Box::<JointTables>::default();
        tables.joints = joints as u64;
        tables.unit[..joints]
            .iter_mut()
            .enumerate()
            .for_each(|(j, unit)| *unit = robot.layout.count(j).unwrap_or(f64::NAN));
        Some(Self { tables, sampling, joints, filled: 0, fills: false })
    }

    /// Begins to fill tables, instead of those before; false if the order is out of range.
    pub fn begin(&mut self, order: &TableOrder) -> bool {
        self.fills = (2..=MAX_POINTS).contains(&order.points) && (1..=256).contains(&order.spacing);
        self.filled = 0;
        let t = &mut self.tables;
        (t.plan, t.start_tick, t.spacing) = (order.plan, order.start_tick, order.spacing.into());
        (t.points, t.cyclic) = (order.points as u64, order.cyclic.into());
        self.fills
    }

    /// Fills some more points, by the angles \[rad\] that `path` has at a time \[s\] since the first point.
    pub fn fill(&mut self, mut path: impl FnMut(f64, &mut Joints)) -> Filled {
        if !self.fills {
            return Filled::More;
        }
        let points = self.tables.points as usize;
        let mut angles = [0.0; MAX_JOINTS];
        for point in self.filled..(self.filled + POINTS_FILLED).min(points) {
            path(point as f64 * self.tables.spacing as f64 * self.sampling, &mut angles);
            for j in 0..self.joints {
                let count = (angles[j] / self.tables.unit[j]).round();
                // False for NaN.
                if !(count.abs() <= f64::from(i32::MAX)) {
                    self.fills = false;
                    return Filled::NotFinite { joint: j, point: point + 1 };
                }
                self.tables.counts[j][point] = count as i32;
            }
            self.filled = point + 1;
        }
        self.fills = self.filled < points;
        if self.fills { Filled::More } else { Filled::Complete }
    }

    /// Stamps the tables.
    pub fn stamp(&mut self, header: Header) {
        self.tables.header = header;
    }

    /// The tables, whole once [`Filled::Complete`] was returned.
    pub fn tables(&self) -> &JointTables {
        &self.tables
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn builder() -> TableBuilder {
        let mut robot = Robot::load(&config::root(None).join("robots/archie")).unwrap();
        assert!(TableBuilder::new(&robot).is_none(), "a point in every cycle");
        robot.play_tables().unwrap();
        TableBuilder::new(&robot).unwrap()
    }

    const ORDER: TableOrder =
        TableOrder { plan: 3, start_tick: 500, spacing: 250, points: 300, cyclic: true };

    /// Thesis 6.2 at t = 0, right leg, counts from standing: the first points that the corrected pattern has there.
    #[test]
    fn first_points_of_the_static_walk_in_counts() {
        let mut b = builder();
        assert!(b.begin(&ORDER));
        let theta: [f64; 5] =
            [0.283186047715, -0.833790283634, 1.272847359397, -0.439057075763, 1.287610279080];
        let filled = b.fill(|_, q| {
            // Ankle adduction, ankle flexion, knee, hip flexion, hip adduction, hip rotation.
            (q[5], q[4], q[3], q[2], q[1]) =
                (theta[0], theta[1], theta[2], theta[3], theta[4] - std::f64::consts::FRAC_PI_2);
        });
        assert_eq!(filled, Filled::More);
        let first = [5, 4, 3, 2, 1, 0].map(|j| b.tables().counts[j][0]);
        assert_eq!(first, [2596, -7644, 11669, -4025, -2596, 0]);
    }

    #[test]
    fn some_points_each_cycle_at_their_times() {
        let mut b = builder();
        assert_eq!(b.fill(|_, _| unreachable!()), Filled::More, "nothing was ordered");
        assert!(b.begin(&ORDER));
        let (mut times, mut cycles) = (Vec::new(), 0);
        loop {
            cycles += 1;
            let before = times.len();
            let filled = b.fill(|t, q| {
                times.push(t);
                q[3] = 0.1 * t;
            });
            assert!(times.len() - before <= POINTS_FILLED);
            if filled == Filled::Complete {
                break;
            }
        }
        assert_eq!((times.len(), cycles), (300, 19));
        assert!(times.iter().enumerate().all(|(i, t)| (t - 0.08 * i as f64).abs() < 1e-12));
        let t = b.tables();
        let unit = std::f64::consts::TAU / (360.0 * 160.0);
        let worst =
            (0..300).map(|i| (f64::from(t.counts[3][i]) * unit - 0.008 * i as f64).abs()).fold(0.0, f64::max);
        assert!(worst <= 0.5 * unit, "{worst}");
        assert_eq!((t.plan, t.start_tick, t.points, t.cyclic, t.joints), (3, 500, 300, 1, 12));
    }

    #[test]
    fn orders_out_of_range_and_paths_that_are_not_finite_come_to_nothing() {
        let mut b = builder();
        for points in [1, 1025] {
            assert!(!b.begin(&TableOrder { points, ..ORDER }));
        }
        assert!(
            !b.begin(&TableOrder { spacing: 257, ..ORDER }) && !b.begin(&TableOrder { spacing: 0, ..ORDER })
        );
        for bad in [f64::NAN, f64::INFINITY, 1e9] {
            assert!(b.begin(&ORDER));
            let filled = b.fill(|t, q| q[7] = if t > 0.3 { bad } else { 0.0 });
            assert_eq!(filled, Filled::NotFinite { joint: 7, point: 5 });
            assert_eq!(b.fill(|_, _| unreachable!()), Filled::More, "{bad}");
        }
    }
}
