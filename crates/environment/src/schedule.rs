//! Plan of one object: when it is there, and where.

use crate::pose::Pose;

/// When an object is there, and where.
#[derive(Clone, Debug)]
pub struct Schedule {
    /// \[s\] First moment it is there.
    pub appears: f64,
    /// \[s\] First moment it is not there any more.
    pub vanishes: f64,
    /// Poses by time \[s\], ascending; at least one. Between them straight, before and after them at rest.
    poses: Vec<(f64, Pose)>,
}

impl Schedule {
    /// Always there, at `pose`.
    pub fn fixed(pose: Pose) -> Self {
        Self { appears: 0.0, vanishes: f64::INFINITY, poses: vec![(0.0, pose)] }
    }

    /// There from `appears` until `vanishes` \[s\]; at `first` at time 0, and from there straight from one of `then` to
    /// the next, poses by ascending time \[s\] above 0.
    pub fn new(appears: f64, vanishes: f64, first: Pose, then: &[(f64, Pose)]) -> Self {
        let mut poses = vec![(0.0, first)];
        poses.extend_from_slice(then);
        Self { appears, vanishes, poses }
    }

    /// It is not always there, or not always at the same place.
    pub fn changes(&self) -> bool {
        self.poses.len() > 1 || self.appears > 0.0 || self.vanishes.is_finite()
    }

    /// Presence at `time` \[s\].
    pub fn is_present(&self, time: f64) -> bool {
        self.appears <= time && time < self.vanishes
    }

    /// Its pose at `time` \[s\].
    pub fn pose(&self, time: f64) -> Pose {
        let next = self.poses.partition_point(|(t, _)| *t <= time);
        match (self.poses.get(next.wrapping_sub(1)), self.poses.get(next)) {
            (Some((t0, from)), Some((t1, to))) => from.towards(to, (time - t0) / (t1 - t0)),
            (Some((_, last)), None) => *last,
            (None, _) => self.poses[0].1,
        }
    }
}
