//! Objects in time: they appear, move along a polyline of poses and vanish, but only while nothing touches them.
//!
//! Each object has a clock of its own. It stands still while the next change would reach something that touches the
//! object, or would put the object where a node of the robot is; so what is planned happens late, in the same order and
//! at the same speed, and never by a jump.

use crate::object::Pose;
use crate::query::Environment;

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

/// What happened to an object in [`Environment::advance`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// Its next change has to wait, because it is touched or would touch.
    Refused(usize),
    /// It goes on with its schedule.
    Resumed(usize),
    /// It is there from now on.
    Appeared(usize),
    /// It is not there any more.
    Vanished(usize),
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

    pub(crate) fn is_present(&self, time: f64) -> bool {
        self.appears <= time && time < self.vanishes
    }

    pub(crate) fn pose(&self, time: f64) -> Pose {
        let next = self.poses.partition_point(|(t, _)| *t <= time);
        match (self.poses.get(next.wrapping_sub(1)), self.poses.get(next)) {
            (Some((t0, from)), Some((t1, to))) => from.towards(to, (time - t0) / (t1 - t0)),
            (Some((_, last)), None) => *last,
            (None, _) => self.poses[0].1,
        }
    }
}

impl Environment {
    /// Moves every object to where its schedule has it at `time` \[s\], except those that `touched` says something
    /// touches, and those that would enclose one of the `nodes` \[m\] @world there. Returns what happened. An object
    /// that has to wait loses the whole step, so steps should be short: a bus cycle.
    pub fn advance(&mut self, time: f64, touched: &[bool], nodes: &[[f64; 3]]) -> &[Event] {
        self.events.clear();
        let step = (time - self.time).max(0.0);
        self.time += step;
        for (i, object) in self.objects.iter_mut().enumerate() {
            let clock = object.clock + step;
            let (present, pose) = (object.schedule.is_present(clock), object.schedule.pose(clock));
            let changes = present != object.present || (present && pose != *object.pose());
            if !changes {
                object.clock = clock;
                continue;
            }
            let held = object.present && touched.get(i).copied().unwrap_or(false);
            if held || (present && !object.moved_clear_of(nodes, pose)) {
                if !object.refused {
                    self.events.push(Event::Refused(i));
                }
                object.refused = true;
                continue;
            }
            if std::mem::take(&mut object.refused) {
                self.events.push(Event::Resumed(i));
            }
            if present != object.present {
                self.events.push(if present { Event::Appeared(i) } else { Event::Vanished(i) });
            }
            (object.clock, object.present) = (clock, present);
        }
        &self.events
    }
}
