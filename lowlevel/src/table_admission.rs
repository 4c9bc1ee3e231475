//! Admission of tables: every point, and every cubic between points by its extremes, before a byte of them is sent.
//!
//! | what | bound |
//! |---|---|
//! | shape | 2 to 1024 points, 1 to 256 samples and at least a bus cycle apart |
//! | robot | its number of joints, and its counts |
//! | each cubic | range, speed and acceleration (with a load that helps) of its joint |
//! | beginning | where the joint rests, or at a point of the running table, where that one is |
//! | end | at rest, unless it is cyclic |

use config::{Robot, WITH_LOAD};
use drives::point_table::{Cubic, MOST_POINTS, MOST_SPACING, cubic, speed};
use messages::{Detail, JointTables, MAX_JOINTS, TableFault};

/// \[count\] Distance from where the joint is at the first point: half a count of each of both, and one of the encoder.
const BEGIN: f64 = 2.0;
/// \[rad/s\] Speed up to which a joint rests.
const REST: f64 = 1e-3;
/// \[count\] A point is rounded to the nearest count.
const HALF: f64 = 0.5;

/// A table that the drives play, or will.
#[derive(Clone)]
pub(crate) struct PlacedTables {
    pub(crate) tables: Box<JointTables>,
    /// \[1\] Its first point in the drives' memory, from 1.
    pub(crate) first: usize,
}

impl PlacedTables {
    pub(crate) fn empty() -> Self {
        Self { tables: Box::default(), first: 1 }
    }

    /// \[1\] Its last point.
    pub(crate) fn last(&self) -> usize {
        self.first + self.tables.points as usize - 1
    }

    /// Point at which it is when cycle `tick` begins, with so many samples in a cycle; none if it is over, an error between
    /// two points.
    pub(crate) fn point_at(&self, tick: u64, samples: f64) -> Result<Option<usize>, ()> {
        let t = &self.tables;
        let passed = tick.saturating_sub(t.start_tick) as f64 * samples / t.spacing as f64;
        let (i, n) = (passed.round(), t.points as usize);
        if t.cyclic == 0 && passed >= (n - 1) as f64 {
            return Ok(None);
        }
        if (passed - i).abs() * t.spacing as f64 > 1e-6 { Err(()) } else { Ok(Some(i as usize % n)) }
    }
}

/// What is wrong with a joint's table.
pub(crate) fn fault(joint: usize, point: usize, fault: TableFault) -> Detail {
    Detail::Table { joint, point, fault }
}

/// Shape, robot and end of new tables.
pub(crate) fn admit_whole(t: &JointTables, robot: &Robot, units: &[f64], samples: f64) -> Result<(), Detail> {
    let shaped = (2..=MOST_POINTS as u64).contains(&t.points)
        && (1..=u64::from(MOST_SPACING)).contains(&t.spacing)
        && t.spacing as f64 >= samples
        && t.cyclic <= 1;
    if !shaped {
        return Err(fault(0, 0, TableFault::Shape));
    }
    let joints = robot.joints.len();
    let other = (0..joints).find(|&j| t.joints != joints as u64 || t.unit[j] != units[j]);
    if let Some(j) = other {
        return Err(fault(j, 0, TableFault::Robot));
    }
    let last = t.points as usize - 1;
    match (0..joints).find(|&j| t.cyclic == 0 && t.of(j)[last] != t.of(j)[last - 1]) {
        Some(j) => Err(fault(j, last + 1, TableFault::End)),
        None => Ok(()),
    }
}

/// Place in the drives' memory beside the running table: in the other half of it, so that one as long as half of it has room
/// beside this one in turn, however short the running table is.
pub(crate) fn place(points: usize, running: Option<&PlacedTables>) -> Result<usize, Detail> {
    let Some(running) = running.filter(|r| r.first <= points) else { return Ok(1) };
    let last = running.last();
    let before = [last.max(MOST_POINTS / 2), last].into_iter().find(|before| before + points <= MOST_POINTS);
    before.map(|before| before + 1).ok_or_else(|| fault(0, 0, TableFault::Room))
}

/// Speed of each joint with which a table begins, in its own unit \[count/T\]: zero, or that of the running table, which has
/// to be at the same place.
pub(crate) fn beginning(
    t: &JointTables,
    running: Option<&PlacedTables>,
    samples: f64,
    joints: usize,
) -> Result<[f64; MAX_JOINTS], Detail> {
    let mut speeds = [0.0; MAX_JOINTS];
    let Some(r) = running else { return Ok(speeds) };
    let at = r.point_at(t.start_tick, samples).map_err(|()| fault(0, 0, TableFault::BetweenPoints))?;
    let old = &r.tables;
    for (j, v) in speeds.iter_mut().enumerate().take(joints) {
        let i = at.unwrap_or(old.points as usize - 1);
        if (f64::from(old.of(j)[i]) - f64::from(t.of(j)[0])).abs() > BEGIN {
            return Err(fault(j, 1, TableFault::Begin));
        }
        if at.is_some() {
            *v = speed(old.of(j), i, old.cyclic == 1) * t.spacing as f64 / old.spacing as f64;
        }
    }
    Ok(speeds)
}

/// The cubics from point `i` on, of all joints; `begin` are the speeds at the first point \[count/T\].
pub(crate) fn admit_point(
    t: &JointTables,
    robot: &Robot,
    i: usize,
    begin: &[f64],
    period: f64,
) -> Result<(), Detail> {
    let (cyclic, points) = (t.cyclic == 1, t.points as usize);
    if i + 1 == points && !cyclic {
        return Ok(());
    }
    for j in 0..robot.joints.len() {
        let of = t.of(j);
        let regular = cubic(of, i, cyclic);
        let first = (i == 0).then(|| {
            let end = [f64::from(of[1]), speed(of, 1, cyclic)];
            Cubic::between([f64::from(of[0]), begin[j]], end)
        });
        // A cyclic table comes by its first point again, with another speed.
        let later = Some(regular).filter(|_| first.is_none() || cyclic);
        for cubic in first.into_iter().chain(later) {
            admit_cubic(t, robot, (j, i), &cubic, period)?;
        }
    }
    Ok(())
}

/// One cubic of a joint, `period` \[s\] long.
fn admit_cubic(
    t: &JointTables,
    robot: &Robot,
    (j, i): (usize, usize),
    cubic: &Cubic,
    period: f64,
) -> Result<(), Detail> {
    let (joint, unit, extremes) = (&robot.joints[j], t.unit[j], cubic.extremes());
    let wrong = |what| Err(fault(j, i + 1, what));
    let [low, high] = extremes.position.map(|p| p * unit);
    if !(low >= joint.range[0] - HALF * unit && high <= joint.range[1] + HALF * unit) {
        return wrong(TableFault::Range);
    }
    if !(extremes.speed * unit / period <= joint.speed_limit) {
        return wrong(TableFault::Speed);
    }
    let acceleration = extremes.acceleration * unit / (period * period);
    if acceleration <= WITH_LOAD * joint.acceleration {
        return Ok(());
    }
    let angles: [f64; MAX_JOINTS] =
        std::array::from_fn(|k| t.of(k).get(i).map_or(0.0, |p| f64::from(*p) * t.unit[k]));
    if acceleration <= WITH_LOAD * robot.acceleration(j, &angles) {
        return Ok(());
    }
    wrong(TableFault::Acceleration)
}

/// First joint that does not rest where a table begins: its setpoint is `(angle, speed)` \[rad, rad/s\].
pub(crate) fn elsewhere(
    t: &JointTables,
    joints: usize,
    setpoint: impl Fn(usize) -> (f64, f64),
) -> Option<Detail> {
    let away = |j: &usize| {
        let (angle, speed) = setpoint(*j);
        !(speed.abs() <= REST) || !((angle / t.unit[*j] - f64::from(t.of(*j)[0])).abs() <= BEGIN)
    };
    (0..joints).find(away).map(|j| fault(j, 1, TableFault::Begin))
}
