//! Both methods for the centre of gravity plan the same walks, where the closed form holds, and one says so where it does not.

use crate::robot::checks::{implied_margin, seam, unrest, zmp_margin};
use crate::robot::{self, Robot};
use config::Gait;
use config::gait::CogMethod;
use messages::command::StepCommand;
use messages::{Command, EventCode, GaitState};

/// A gait of one mass on level ground.
fn gait(cog_method: CogMethod) -> Gait {
    let mut gait = robot::gait();
    (gait.model.cog_method, gait.model.leg_mass, gait.obstacles) = (cog_method, 0.0, None);
    gait
}

/// Stands up, walks as commanded, and stops.
fn walk(gait: &Gait, step: StepCommand) -> Robot {
    let mut r = Robot::new(gait);
    r.stand();
    r.step(&[Command::Step(step), Command::Start]);
    r.run(9.0);
    r.step(&[Command::Stop]);
    r.run(6.0);
    r
}

#[test]
fn both_methods_plan_the_same_walks() {
    let step = |length, side, turn| StepCommand { length, side, turn, duration: 0.9 };
    for command in [step(0.45, 0.0, 0.0), step(0.3, 0.0, 0.15), step(0.0, 0.1, 0.0)] {
        let [a, b] = CogMethod::ALL.map(|method| walk(&gait(method), command));
        assert!(a.events.is_empty() && b.events.is_empty(), "{:?} {:?}", a.events, b.events);
        assert!(a.plans.len() > 8 && a.plans.len() == b.plans.len());
        assert_eq!(b.plans.last().map(|p| p.state), Some(GaitState::Stopping as u64));
        let mut worst = 0.0f64;
        for (p, q) in a.plans.iter().zip(&b.plans) {
            assert_eq!((p.start_tick, p.step_count), (q.start_tick, q.step_count));
            for k in 0..200 {
                let t = p.end() * f64::from(k) / 200.0;
                let [r, s] = [p, q].map(|plan| plan.body.sample(t).position);
                worst = (0..3).map(|d| (r[d] - s[d]).abs()).fold(worst, f64::max);
            }
        }
        assert!(worst > 0.0 && worst < 5e-4, "{worst} m apart");
        let gait = gait(CogMethod::ClosedForm);
        for plan in &b.plans {
            assert!(
                zmp_margin(plan) > -1e-6 && implied_margin(plan, &gait) > -1e-3 && unrest(plan, &gait) < 1e-9
            );
        }
        assert!(b.plans.windows(2).all(|pair| seam(&pair[0], &pair[1]) < 1e-9));
    }
}

/// A gait that no file could hold: with three masses the closed form plans nothing, and the robot stands.
#[test]
fn the_closed_form_refuses_what_it_cannot_plan() {
    let mut gait = gait(CogMethod::ClosedForm);
    gait.model.leg_mass = 0.08;
    let r = walk(&gait, StepCommand { length: 0.3, side: 0.0, turn: 0.0, duration: 0.9 });
    assert!(r.plans.iter().all(|p| p.state == GaitState::Standing as u64));
    assert!(r.events.iter().any(|e| e.1 == EventCode::PlanKept), "{:?}", r.events);
}
