//! Measures by which gains are judged.

use serde::Serialize;

use crate::joint_bench::ShaftState;

/// Share of a step that is its rise, and half width of the band in which it has settled.
const RISEN: f64 = 0.9;
const SETTLED: f64 = 0.05;

/// A step response, 1 being what was asked for.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Measures {
    /// \[1\]
    pub(super) overshoot: f64,
    /// \[s\] From 0 to 90 %; infinite if it does not come there.
    pub(super) rise_s: f64,
    /// \[s\] Until it stays within 5 %.
    pub(super) settling_s: f64,
    /// \[A\] Largest current.
    pub(super) current_a: f64,
    /// Whether that is the drive's limit.
    pub(super) saturates: bool,
    /// Whether it swings on instead of coming to rest.
    pub(super) oscillates: bool,
}

/// Answer to a torque on the link, motor side, as angles of the joint.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Loaded {
    /// \[rad\]
    pub(super) largest_rad: f64,
    /// \[rad\] Largest in the last tenth of the time.
    pub(super) rest_rad: f64,
    /// \[A\]
    pub(super) current_a: f64,
}

impl Measures {
    pub(super) fn of(states: &[ShaftState], y: impl Fn(&ShaftState) -> f64, limit: f64) -> Self {
        let rise = states.windows(2).find(|pair| y(&pair[1]) >= RISEN);
        // The instant between two samples.
        let at = |pair: &[ShaftState]| {
            let share = (RISEN - y(&pair[0])) / (y(&pair[1]) - y(&pair[0]));
            pair[0].time + share * (pair[1].time - pair[0].time)
        };
        let outside = states.iter().rev().find(|s| !((y(s) - 1.0).abs() <= SETTLED));
        let current = largest(states, |s| s.current);
        Self {
            overshoot: states.iter().map(|s| y(s) - 1.0).fold(0.0, f64::max),
            rise_s: rise.map_or(f64::INFINITY, at),
            settling_s: outside.map_or(0.0, |s| s.time),
            current_a: current,
            saturates: current >= 0.99 * limit,
            oscillates: falls(&states[3 * states.len() / 4..], &y) > SETTLED,
        }
    }
}

impl Loaded {
    pub(super) fn of(states: &[ShaftState], ratio: f64) -> Self {
        let last = &states[states.len() - states.len() / 10..];
        Self {
            largest_rad: largest(states, |s| s.angle / ratio),
            rest_rad: largest(last, |s| s.angle / ratio),
            current_a: largest(states, |s| s.current),
        }
    }
}

/// By how much a response falls behind what it had reached: nothing of one that creeps up to its end.
fn falls(states: &[ShaftState], y: impl Fn(&ShaftState) -> f64) -> f64 {
    let mut most = f64::NEG_INFINITY;
    let fallen = states.iter().map(|s| {
        most = most.max(y(s));
        most - y(s)
    });
    fallen.fold(0.0, f64::max)
}

fn largest(states: &[ShaftState], of: impl Fn(&ShaftState) -> f64) -> f64 {
    states.iter().map(|s| of(s).abs()).fold(0.0, f64::max)
}
