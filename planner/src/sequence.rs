//! Step sequence planning: which foot lands where and when (thesis 4.3).

use crate::pose::Pose;
use crate::steps::{MAX_STEPS, Parameters, Stride, next_foothold, next_width, nu};
use crate::walk::{Builder, Origin};
use messages::GaitState;

impl Builder {
    /// Footholds and times (thesis 4.3).
    pub(crate) fn sequence(
        &self,
        from: &Origin,
        state: GaitState,
        wish: &Parameters,
        share: f64,
        strides: &mut [Stride; MAX_STEPS],
    ) -> usize {
        let mut last = Stride::NONE;
        let mut stance = from.stance;
        let mut foothold = from.feet[stance];
        let mut takeoff = from.feet[1 - stance];
        let mut parameters = from.previous;
        let mut width = from.width;
        let mut n = 0;
        let most = self.step.first_length;
        loop {
            let closing = if state == GaitState::Stopping { n > 0 } else { n > 2 };
            let closing = (closing && parameters.length.abs() <= most) || n + 1 == MAX_STEPS;
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
                    parameters.length = parameters.length.clamp(-most, most);
                }
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
            };
            strides[n] = last;
            n += 1;
            if closing {
                return n;
            }
            takeoff = foothold;
            foothold = landing;
            stance = 1 - stance;
        }
    }
}
