//! Footholds on ground of a known slope: each is as high as the slope says, however the robot turns on it.

use crate::robot::{self, Random, Robot};
use messages::Command;
use messages::command::StepCommand;

/// \[m\] How far a foothold may be from the plane.
const OFF: f64 = 1e-9;

#[test]
fn footholds_lie_on_the_plane() {
    let mut random = Random::new(93_001);
    for case in 0..20 {
        let slope = [random.range([-0.09, 0.09]), random.range([-0.09, 0.09])];
        let turn = random.range([-0.2, 0.2]);
        let mut r = Robot::new(&robot::gait());
        // Nothing is touched before its time.
        r.ground = f64::NEG_INFINITY;
        r.stand();
        r.state.ground_slope = slope;
        r.step(&[Command::Step(StepCommand { length: 0.2, side: 0.02, turn, duration: 1.0 })]);
        r.step(&[Command::Start]);
        r.run(9.0);
        assert!(r.plans.len() > 6, "case {case}: {} plans", r.plans.len());
        // From the second step on: the feet stood level before it.
        for plan in &r.plans[2..] {
            let at = plan.steps[0].end;
            let [right, left] = [0, 1].map(|i| plan.feet[i].sample(at).position);
            let (s, c) = plan.origin[2].sin_cos();
            let [dx, dy] = [left[0] - right[0], left[1] - right[1]];
            let rise = slope[0] * (c * dx - s * dy) + slope[1] * (s * dx + c * dy);
            let off = left[2] - right[2] - rise;
            assert!(off.abs() < OFF, "case {case}, plan {}: {off} m beside a rise of {rise} m", plan.id);
        }
    }
}
