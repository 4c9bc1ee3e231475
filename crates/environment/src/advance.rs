//! Objects in time: they appear, move along a polyline of poses and vanish, but only while nothing touches them.
//!
//! Each object has a clock of its own. It stands still while the next change would reach something that touches the
//! object, or would put the object where a node of the robot is; so what is planned happens late, in the same order and
//! at the same speed, and never by a jump.

use crate::query::{Environment, ObjectEvent};

impl Environment {
    /// \[s\] By how much each object that moves is late, in their order.
    pub fn delays(&self) -> impl Iterator<Item = f64> {
        self.objects.iter().filter(|o| o.moves()).map(|o| self.time - o.clock)
    }

    /// Puts every object to where it is at `time` \[s\], those that move as late as `delays` \[s\] says of them in their order.
    pub fn place_at(&mut self, time: f64, delays: &[f64]) {
        self.time = time;
        for (object, delay) in self.objects.iter_mut().filter(|o| o.moves()).zip(delays) {
            object.clock = time - delay;
            object.present = object.schedule.is_present(object.clock);
            object.place(object.schedule.pose(object.clock));
        }
    }

    /// Moves every object to where its schedule has it at `time` \[s\], except those that `touched` says something
    /// touches, and those that would enclose one of the `nodes` \[m\] @world there. Returns what happened. An object
    /// that has to wait loses the whole step, so steps should be short: a bus cycle.
    pub fn advance(&mut self, time: f64, touched: &[bool], nodes: &[[f64; 3]]) -> &[ObjectEvent] {
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
            // Neither torn away from under a foot, nor put around one.
            let held = object.present && touched.get(i).copied().unwrap_or(false);
            if held || (present && !object.moved_clear_of(nodes, pose)) {
                if !object.refused {
                    self.events.push(ObjectEvent::Refused(i));
                }
                object.refused = true;
                continue;
            }
            // Nothing is in the way any more.
            if std::mem::take(&mut object.refused) {
                self.events.push(ObjectEvent::Resumed(i));
            }
            if present != object.present {
                self.events.push(if present { ObjectEvent::Appeared(i) } else { ObjectEvent::Vanished(i) });
            }
            (object.clock, object.present) = (clock, present);
        }
        &self.events
    }
}
