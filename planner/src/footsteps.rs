//! Step sequence planning: which foot lands where and when (thesis 4.3).

use crate::pose::Pose;
use crate::reactive::Blocked;
use crate::steps::{Heights, MAX_STEPS, Parameters, Stride, next_foothold, next_width, nu};
use crate::walk::{Builder, Origin};
use messages::GaitState;

impl Builder {
    /// Footholds and times (thesis 4.3); what makes a step before the last ones shorter than it should be.
    pub(crate) fn sequence(
        &self,
        from: &Origin,
        state: GaitState,
        wish: &Parameters,
        share: f64,
        strides: &mut [Stride; MAX_STEPS],
    ) -> (usize, Option<Blocked>) {
        let mut last = Stride::NONE;
        let mut stance = from.stance;
        let mut foothold = from.feet[stance];
        let mut takeoff = from.feet[1 - stance];
        let mut heights =
            Heights { takeoff: from.heights[1 - stance], lift: self.step.swing_height, ..Heights::default() };
        let mut parameters = from.previous;
        let mut width = from.width;
        let mut n = 0;
        let mut blocked = None;
        let most = self.step.first_length;
        loop {
            let closing = if state == GaitState::Stopping { n > 0 } else { n > 2 };
            let closing = match self.script.length(n) {
                Some(_) => false,
                None => self.script.closes(n) || (closing && parameters.length.abs() <= most),
            };
            let closing = closing || n + 1 == MAX_STEPS;
            let ending = state == GaitState::Stopping || n >= 2;
            let nu = nu(stance);
            let landing = if closing {
                parameters = Parameters::on_the_spot(parameters.duration);
                width = self.step.width;
                foothold.compose(&Pose::new(0.0, nu * width, 0.0))
            } else {
                let rest = Parameters::on_the_spot(parameters.duration);
                parameters = if ending {
                    parameters.towards(&rest, &self.step, 1.0)
                } else {
                    parameters.towards(wish, &self.step, share)
                };
                if n == 0 && state == GaitState::Starting {
                    // Feet that stand side by side have no step before: a step that ends a walk may be as long.
                    parameters.length = wish.length.clamp(-most * share, most * share);
                }
                let wish = if ending { &rest } else { wish };
                let before = if n == 0 { from.previous.duration } else { last.parameters.duration };
                parameters = match self.script.length(n) {
                    Some(length) => Parameters { length, ..parameters },
                    None => {
                        let (free, why) = self.clear(from, &foothold, stance, before, &parameters, wish);
                        blocked = blocked.or(why);
                        free
                    }
                };
                let w_n = next_width(&parameters, width, nu, &self.step, &self.soles[stance]);
                let landing =
                    foothold.compose(&next_foothold(&parameters, width, w_n, nu, &self.soles[stance]));
                width = w_n;
                landing
            };
            let begin = last.end_cycle as f64 * self.cycle_s;
            let support = self.step.double_support * parameters.duration;
            let swing = parameters.duration - support;
            let support = if n == 0 && state == GaitState::Starting { self.step.start_time } else { support };
            let support = if n == 0 { support + from.early.map_or(0.0, |e| e.0) } else { support };
            let end_cycle = last.end_cycle + self.cycles(support + swing);
            last = Stride {
                parameters,
                stance,
                width,
                begin,
                lift: begin + support,
                end: end_cycle as f64 * self.cycle_s,
                end_cycle,
                foothold,
                takeoff,
                landing,
                heights,
            };
            strides[n] = last;
            n += 1;
            if closing {
                return (n, blocked.filter(|_| state != GaitState::Stopping));
            }
            takeoff = foothold;
            foothold = landing;
            heights = Heights { foothold: heights.landing, takeoff: heights.foothold, ..heights };
            stance = 1 - stance;
        }
    }

    /// The step `p` from `foothold`, made so that it does not end on an obstacle or at the wall of a skill, and why if
    /// it is shorter for that. `before` \[s\] is how long the step before took.
    fn clear(
        &self,
        from: &Origin,
        foothold: &Pose,
        stance: usize,
        before: f64,
        p: &Parameters,
        wish: &Parameters,
    ) -> (Parameters, Option<Blocked>) {
        let room = self.script.wall - foothold.x;
        let mut free = Parameters { length: p.length.min(room.max(0.0)), ..*p };
        let adapted = self.adapt(from.frame.compose(foothold), from.height, stance, &free, wish);
        free.length = adapted.length;
        if let (true, Some(r)) = (adapted.near, &self.reactive) {
            let slower = r.rules.duration.min(before + self.step.change_duration);
            free.duration = free.duration.max(slower);
        }
        (free, adapted.blocked)
    }
}
