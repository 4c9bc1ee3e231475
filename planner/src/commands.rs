//! Walking commands to step parameters, refused when out of `gait.limits` (thesis 4.6.1).
//!
//! Every comparison is written so that a number that is not finite fails it.

use crate::steps::Parameters;
use config::Gait;
use messages::command::{StepCommand, VelocityCommand};

/// What the operator wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Stay as it is, or stop.
    Rest,
    /// Take the standing pose.
    Stand,
    /// Walk.
    Walk,
}

/// Parameters within the limits, or none.
fn checked(p: Parameters, gait: &Gait) -> Option<Parameters> {
    let within = |x: f64, [lo, hi]: [f64; 2]| x >= lo && x <= hi;
    let l = &gait.limits;
    (within(p.length, l.length)
        && within(p.side, l.side)
        && within(p.turn, l.turn)
        && within(p.duration, l.duration))
    .then_some(p)
}

/// Step parameters as commanded; `None` if refused.
pub fn from_step(c: &StepCommand, gait: &Gait) -> Option<Parameters> {
    checked(Parameters { length: c.length, side: c.side, turn: c.turn, duration: c.duration }, gait)
}

/// Step parameters for a velocity: `Some(None)` for a stop, `None` if refused.
///
/// The duration comes from the table of forward speeds. Each step shifts the feet by L_y = v_y T and turns them by
/// w T; if one of them would be too much for a step, steps become shorter in time.
pub fn from_velocity(c: &VelocityCommand, gait: &Gait) -> Option<Option<Parameters>> {
    if !(c.forward.is_finite() && c.left.is_finite() && c.turn.is_finite()) {
        return None;
    }
    if c.forward == 0.0 && c.left == 0.0 && c.turn == 0.0 {
        return Some(None);
    }
    let [_, duration] = by_speed(c.forward.abs(), &gait.step.by_speed)?;
    let most = |rate: f64, limit: [f64; 2]| {
        let limit = if rate < 0.0 { limit[0] } else { limit[1] };
        if rate == 0.0 { f64::INFINITY } else { limit / rate }
    };
    let duration = duration
        .min(most(c.left, gait.limits.side))
        .min(most(c.turn, gait.limits.turn))
        .min(most(c.forward, gait.limits.length));
    let p = Parameters {
        length: c.forward * duration,
        side: c.left * duration,
        turn: c.turn * duration,
        duration,
    };
    checked(p, gait).map(Some)
}

/// Length and duration of steps at `speed`, linear between the rows of the table; `None` beyond its end.
fn by_speed(speed: f64, table: &[[f64; 3]]) -> Option<[f64; 2]> {
    let i = table.iter().position(|row| speed <= row[0])?;
    if i == 0 {
        return Some([table[0][1], table[0][2]]);
    }
    let (a, b) = (&table[i - 1], &table[i]);
    let s = (speed - a[0]) / (b[0] - a[0]);
    Some([1, 2].map(|k| a[k] + s * (b[k] - a[k])))
}
