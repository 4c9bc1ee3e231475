//! Step widths keep the feet apart (4.4), over as many random steps as errata 2.2.

use crate::robot::{self, Random};
use config::gait::{CommandLimits, StepSettings};
use planner::pose::PlanarPose;
use planner::sole::Sole;
use planner::steps::{StepParameters, next_foothold, next_width, nu};

/// Lateral gap \[m\], seen from the stance foot, between its sole and the one at `landing`.
fn gap(sole: &Sole, landing: &PlanarPose, nu: f64) -> f64 {
    let near =
        sole.corners(landing).iter().map(|c| nu * (c[1] - sole.center[1])).fold(f64::INFINITY, f64::min);
    near - sole.half[1]
}

/// Least gap over random steps, each with the width that `width` says.
fn least(width: impl Fn(&StepParameters, f64, f64, &StepSettings, &Sole) -> f64) -> f64 {
    let gait = robot::gait();
    let (step, sole) = (&gait.step, &Sole::new(robot::SUPPORT[0]));
    let CommandLimits { length, side, turn, .. } = gait.limits;
    let mut random = Random::new(4);
    let mut w_c = step.width;
    let mut least = f64::INFINITY;
    for k in 0..20_000 {
        let nu = nu(k % 2);
        let p = StepParameters {
            length: random.range(length),
            side: random.range(side),
            turn: random.range(turn),
            duration: 1.0,
        };
        let w_n = width(&p, w_c, nu, step, sole);
        least = least.min(gap(sole, &next_foothold(&p, w_c, w_n, nu, sole), nu));
        w_c = w_n;
    }
    least
}

#[test]
fn twenty_thousand_random_steps_keep_the_feet_apart() {
    let gait = robot::gait();
    let sole = Sole::new(robot::SUPPORT[0]);
    let required = gait.step.width_min - 2.0 * sole.half[1];
    let worst = least(next_width);
    assert!(worst > required - 1e-9, "{worst} m of {required} m");
    // The bound is met, not only kept: nothing is given away.
    assert!(worst < required + 1e-3, "{worst} m of {required} m");
    // With the width of level steps feet would overlap.
    assert!(least(|_, _, _, step, _| step.width) < -0.05);
}
