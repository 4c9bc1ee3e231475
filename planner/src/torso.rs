//! Upper body: upright, and heading where the feet head on average (4.11)-(4.13).

use crate::steps::Stride;
use curves::{Path, Sample};
use std::f64::consts::FRAC_PI_2;

/// Inclinations phi_x, phi_y and heading alpha.
pub(crate) type TorsoPath = Path<3, 16>;

/// \[s\] Time in which an upper body that leans is brought upright. What it turns back by moves the centre of gravity on the way
/// it was pushed: 40 mm of divergent component in 0.4 s, after 0.17 N s/kg to the side.
const RIGHTING: f64 = 0.6;

/// Writes the path of the upper body: from `start`, at the end of each step half-way between the feet, at `end` at rest. One
/// that leans at first is brought upright within 0.6 s, whatever the steps are.
pub fn follow(path: &mut TorsoPath, start: &Sample<3>, strides: &[Stride], end: f64) {
    path.restart(0.0, start.position);
    let mut lean = Path::<3, 1>::resting(0.0, [FRAC_PI_2, FRAC_PI_2, 0.0]);
    if start.position[..2] != [FRAC_PI_2; 2] {
        lean.push(start, &Sample::rest([FRAC_PI_2, FRAC_PI_2, 0.0]), RIGHTING);
    }
    let middle = |s: &Stride| 0.5 * (s.foothold.heading + s.landing.heading);
    let mut last = *start;
    for (k, stride) in strides.iter().enumerate() {
        let mut next = Sample::rest([FRAC_PI_2, FRAC_PI_2, middle(stride)]);
        if let Some(after) = strides.get(k + 1) {
            // Half of the turns before and after, each spread over its step.
            let turn = |s: &Stride| (s.landing.heading - s.takeoff.heading) / 2.0 / (s.end - s.begin);
            next.velocity[2] = 0.5 * (turn(stride) + turn(after));
        }
        let leans = lean.sample(stride.end);
        next.position[..2].copy_from_slice(&leans.position[..2]);
        next.velocity[..2].copy_from_slice(&leans.velocity[..2]);
        next.acceleration[..2].copy_from_slice(&leans.acceleration[..2]);
        path.push(&last, &next, stride.end);
        last = next;
    }
    if strides.is_empty() {
        path.push(&last, &Sample::rest([FRAC_PI_2, FRAC_PI_2, start.position[2]]), end);
    }
}
