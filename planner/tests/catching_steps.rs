//! Plans that begin inside a step, at the measured pose.

use crate::robot::{self, Robot};
use config::gait::Reaction;
use messages::command::StepCommand;
use messages::{Command, LEFT, RIGHT};

/// Lola's.
const RULES: Reaction = Reaction {
    length: [-0.4, 0.66],
    width: [0.15, 0.45],
    swing: 0.45,
    rest: 0.12,
    wait: 0.4,
    speed: 1.6,
    error: 0.022,
    tolerance: [0.06, 0.06],
};

/// The foot that stands was put down this much lower \[m\] than planned: so much lower lies the plan that catches her, and the other
/// foot is to land as low. What a sensor's error may be (8 mm) changes nothing.
#[test]
fn a_catching_step_lies_on_the_ground_to_which_the_stance_foot_was_lowered() {
    for (lowered, lies) in [(0.0, 0.0), (-0.006, 0.0), (-0.012, -0.012), (-0.04, -0.04), (0.03, 0.03)] {
        let mut r = Robot::new(&config::Gait { reaction: Some(RULES), ..robot::gait() });
        r.stand();
        r.step(&[Command::Step(StepCommand { length: 0.3, side: 0.0, turn: 0.0, duration: 1.0 })]);
        r.step(&[Command::Start]);
        // An error to the side of the swing foot, from the middle of a swing on.
        let swing = |r: &Robot| (r.state.feet[LEFT][2] > 0.03).then_some(LEFT);
        while r.time() < 0.1 || r.plans.len() < 6 || swing(&r).is_none() {
            r.step(&[]);
            r.state.feet_desired = r.state.feet;
        }
        let (made, height) = (r.plans.len(), r.active.height);
        r.state.modification[RIGHT][0] = lowered;
        r.state.dcm_error = [0.0, -0.08];
        while r.plans.last().is_some_and(|plan| plan.measured == 0) {
            r.step(&[]);
            r.state.feet_desired = r.state.feet;
            assert!(r.plans.len() <= made + 1, "no catching step: {:?}", r.events);
        }
        let plan = r.plans.last().unwrap();
        assert!((plan.height - height - lies).abs() < 1e-12, "{lowered}: {} m", plan.height - height);
        let landed = plan.feet[LEFT].sample(plan.steps[0].end).position[2];
        assert!(landed.abs() < 1e-9, "{lowered}: lands {landed} m over the stance foot");
    }
}
