//! A mass lands on a contact point: what is left of an integrator's order (F7).
//!
//! In contact the mass swings as m z'' = -B z' - K z - m g with z from the height of touchdown, where the node begins to
//! rest: a damped oscillation in closed form. The mass is slow enough never to lift off again.

use ::contact::point::{self, ContactLaw};

use crate::search::slope;

use super::LimitRule::Within;
use super::{Bench, Findings, row, stepper};

const MASS: f64 = 60.0;
const LAW: ContactLaw = ContactLaw { stiffness: [2e5; 3], damping: [2e3; 3], friction: 0.6, recovery: 0.0 };
/// \[m/s\] Speed at touchdown.
const FALL: f64 = -0.1;
/// \[s\] From touchdown to the comparison.
const AFTER: f64 = 0.05;
/// \[m\] Height at which a node counts as touching.
const TOUCH: f64 = 1e-6;
/// \[m\] How far below that height the located step ends.
const LATE: f64 = 1e-9;
/// Heights of fall that are tried for every step, so that the touchdown is anywhere in its step.
const PHASES: usize = 40;

fn gravity() -> f64 {
    multibody::GRAVITY.z
}

/// Height over that of touchdown, and speed, `t` after it.
fn exact(t: f64) -> [f64; 2] {
    let (k, b) = (LAW.stiffness[2] / MASS, LAW.damping[2] / MASS);
    let (rest, decay) = (gravity() / k, 0.5 * b);
    let w = (k - decay * decay).sqrt();
    let (p, q) = (-rest, (FALL - decay * rest) / w);
    let (s, c) = (w * t).sin_cos();
    let e = (-decay * t).exp();
    [rest + e * (p * c + q * s), e * ((q * w - decay * p) * c - (p * w + decay * q) * s)]
}

fn rate(_: f64, x: &[f64], dx: &mut [f64]) {
    let a = point::solve(&LAW, [0.0, 0.0, x[2]], [0.0, 0.0, x[1]], x[0] + x[2]);
    (dx[0], dx[1], dx[2]) = (x[1], a.force[2] / MASS + gravity(), a.rate[2]);
}

/// Error of the height with `n` steps in all, begun `before` \[s\] ahead of touchdown; `located`: with a step that ends there.
fn error(runge_kutta: bool, n: usize, before: f64, located: bool) -> f64 {
    let fall = FALL - gravity() * before; // speed where it begins
    let height = TOUCH - fall * before - 0.5 * gravity() * before * before;
    let (mut method, mut x) = (stepper(3), [height, fall, 0.0]);
    let mut advance = |n: usize, seconds: f64, x: &mut [f64; 3]| {
        for _ in 0..n {
            let h = seconds / n as f64;
            if runge_kutta { method.runge_kutta_4(0.0, h, x, rate) } else { method.euler(0.0, h, x, rate) }
        }
    };
    if located {
        // A step of free fall is exact; it ends a little late, so that rounding does not lift the node off again.
        x = [TOUCH - LATE, FALL, 0.0];
        advance(n, AFTER, &mut x);
    } else {
        advance(n, AFTER + before, &mut x);
    }
    let from = if located { TOUCH - LATE } else { TOUCH };
    (x[0] - from - exact(AFTER)[0]).abs()
}

/// Order: slope of the mean error over the step.
fn measured(runge_kutta: bool, located: bool) -> f64 {
    let points = (if located { [6, 12, 25, 50, 100] } else { [50, 100, 200, 400, 800] }).map(|n| {
        let h = AFTER / n as f64;
        let of = |phase: usize| error(runge_kutta, n, h * (2.0 + phase as f64 / PHASES as f64), located);
        [h, (0..PHASES).map(of).sum::<f64>() / PHASES as f64]
    });
    slope(&points)
}

/// F7: every method of fixed steps is of first order across a touchdown; a step that ends there restores the fourth.
pub(super) fn order(_: &Bench) -> Findings {
    Ok(vec![
        row("F7", "", Within(0.1))
            .of("Runge-Kutta 4 across a touchdown: order", [1.0, measured(true, false)]),
        row("F7", "", Within(0.025))
            .of("Runge-Kutta 4 with a step that ends at touchdown: order", [4.0, measured(true, true)]),
        row("F7", "", Within(0.1))
            .of("explicit Euler across a touchdown: order", [1.0, measured(false, false)]),
    ])
}
