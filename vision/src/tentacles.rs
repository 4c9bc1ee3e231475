//! Tentacles (thesis 6.1; von Hundelshausen et al. 2008): arcs of several curvatures ahead of the robot, each as long as nothing
//! stands in its way.
//!
//! A disc as wide as the robot goes along an arc from its middle, x ahead. Its middle after the angle phi about the arc's centre is
//! R (sin phi, 1 - cos phi) with R = 1/curvature; a point at the distance rho and the angle theta of the centre is met where
//! R^2 + rho^2 - 2 R rho cos(phi - theta) = clearance^2.

use std::f64::consts::{FRAC_PI_2, TAU};

/// Number of arcs.
pub const ARCS: usize = 17;
/// \[1/m\] Greatest curvature.
pub const SHARPEST: f64 = 1.2;
/// \[m\] Length of an arc that nothing stands in.
pub const LENGTH: f64 = 2.5;
/// \[1/m\] Below it an arc is a straight line.
const STRAIGHT: f64 = 1e-6;

/// Curvatures of all arcs \[1/m\], to the left above 0.
pub fn curvatures() -> [f64; ARCS] {
    std::array::from_fn(|k| SHARPEST * (2.0 * k as f64 / (ARCS - 1) as f64 - 1.0))
}

/// \[m\] Way of a disc of the radius `clearance` \[m\] along the arc of this curvature \[1/m\] until it meets one of the `points` \[m\], at
/// most [`LENGTH`], and no farther than a quarter of a turn. A point that is in the disc from the beginning counts if it is ahead.
pub fn free(curvature: f64, clearance: f64, points: &[[f64; 2]]) -> f64 {
    let longest = LENGTH.min(FRAC_PI_2 / curvature.abs());
    points.iter().map(|p| meets(curvature, clearance, *p)).fold(longest, f64::min)
}

/// \[m\] The same with one point; infinite if the arc passes it.
fn meets(curvature: f64, clearance: f64, [x, y]: [f64; 2]) -> f64 {
    if x.hypot(y) < clearance {
        return if x > 0.0 { 0.0 } else { f64::INFINITY };
    }
    if curvature.abs() < STRAIGHT {
        let reach = clearance * clearance - y * y;
        return if reach > 0.0 && x > 0.0 { x - reach.sqrt() } else { f64::INFINITY };
    }
    // As if it went to the left.
    let (radius, y) = (1.0 / curvature.abs(), y * curvature.signum());
    let (rho, theta) = (x.hypot(y - radius), x.atan2(radius - y));
    let cosine = (radius * radius + rho * rho - clearance * clearance) / (2.0 * radius * rho);
    if cosine.abs() > 1.0 || cosine.is_nan() {
        return f64::INFINITY;
    }
    radius * (theta - cosine.acos()).rem_euclid(TAU)
}

/// \[m, m\] Where the arc is after the way `s` \[m\].
pub fn place(curvature: f64, s: f64) -> [f64; 2] {
    if curvature.abs() < STRAIGHT {
        return [s, 0.0];
    }
    let phi = curvature * s;
    [phi.sin() / curvature, (1.0 - phi.cos()) / curvature]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const CLEARANCE: f64 = 0.45;
    const STEP: f64 = 1e-3;

    /// The same by walking along the arc in small steps.
    fn walked(curvature: f64, clearance: f64, points: &[[f64; 2]]) -> f64 {
        let (mut at, mut heading, mut way) = ([0.0; 2], 0.0_f64, 0.0);
        let is_met = |at: [f64; 2]| points.iter().any(|p| (p[0] - at[0]).hypot(p[1] - at[1]) < clearance);
        while way < LENGTH && heading.abs() < FRAC_PI_2 && !is_met(at) {
            let middle = heading + 0.5 * STEP * curvature;
            at = [at[0] + STEP * middle.cos(), at[1] + STEP * middle.sin()];
            (heading, way) = (heading + STEP * curvature, way + STEP);
        }
        way
    }

    proptest! {
        #[test]
        fn as_far_as_a_disc_that_is_walked_along(
            curvature in prop_oneof![-SHARPEST..SHARPEST, Just(0.0), Just(1e-7), Just(-1e-5)],
            points in prop::collection::vec([-3.0..3.0, -3.0..3.0], 0..6),
        ) {
            let apart = |p: &[f64; 2]| p[0].hypot(p[1]) > CLEARANCE + 2.0 * STEP;
            let outside: Vec<[f64; 2]> = points.into_iter().filter(apart).collect();
            let closed = free(curvature, CLEARANCE, &outside);
            // A point that is just grazed is met, or not, by a hair: between a wider disc and a narrower one.
            let [low, high] = [2.0, -2.0].map(|by| walked(curvature, CLEARANCE + by * STEP, &outside));
            prop_assert!((low - 2.0 * STEP..=high + 2.0 * STEP).contains(&closed), "{closed}: {low} to {high}");
        }
    }

    #[test]
    fn what_is_too_near_stops_what_goes_towards_it_alone() {
        assert_eq!(free(0.5, CLEARANCE, &[[0.1, 0.1]]), 0.0);
        assert_eq!(free(0.0, CLEARANCE, &[[-0.1, 0.1]]), LENGTH);
        assert_eq!(free(SHARPEST, CLEARANCE, &[]), FRAC_PI_2 / SHARPEST);
    }

    #[test]
    fn an_arc_is_where_its_length_says() {
        for curvature in curvatures() {
            let (mut at, mut heading) = ([0.0_f64; 2], 0.0_f64);
            for _ in 0..1000 {
                let middle = heading + 0.5e-3 * curvature;
                at = [at[0] + 1e-3 * middle.cos(), at[1] + 1e-3 * middle.sin()];
                heading += 1e-3 * curvature;
            }
            let there = place(curvature, 1.0);
            assert!((there[0] - at[0]).hypot(there[1] - at[1]) < 1e-6, "{curvature}: {there:?} {at:?}");
        }
    }
}
