//! Local controllers: what they feed back, when they measure, what they put out.

use crate::rig::{Rig, lola};
use config::Robot;
use config::method::Integrator;
use drives::{
    Cascade, ControlLaw, Elasticity, Feedback, Friction, JointControl, Resolution, Sampled, Sampling,
    VoltageLaw,
};
use environment::Environment;
use sim_backend::drive::JointCubic;

const CASCADE: Cascade = Cascade {
    feedback: Feedback::Motor,
    position_gain: 80.0,
    speed_bandwidth: 600.0,
    current_bandwidth: 3000.0,
};

/// Lola without dry friction and limits, controlled like this.
fn controlled(law: ControlLaw, sampling: Sampling) -> Robot {
    let mut robot = lola();
    for d in &mut robot.drives {
        d.friction = Friction::Free;
        (d.current_limit, d.voltage_limit) = (1e9, 1e9);
        d.elasticity = d.elasticity.map(|e| Elasticity::linear(e.stiffness[0]));
        d.control = JointControl { law, sampling, resolution: Resolution::default() };
    }
    robot
}

fn fed_back(feedback: Feedback) -> Robot {
    controlled(ControlLaw::Cascade(Cascade { feedback, ..CASCADE }), Sampling::Continuous)
}

fn flying(robot: Robot, depth: u8) -> Rig {
    Rig::of(robot, depth, Environment::flat()).in_the_air().moving(0.02, 0.1)
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

#[test]
fn both_sides_of_a_rigid_gear_are_one() {
    let end = |feedback| {
        let mut rig = flying(fed_back(feedback), 2);
        rig.run(Integrator::SemiImplicit, 0.0, 0.02, 100);
        rig.x
    };
    assert_eq!(end(Feedback::Link), end(Feedback::Motor));
    assert_eq!(end(Feedback::LinkMotor), end(Feedback::Motor));
}

/// Behind elastic gears the three arrangements differ, and of each the implicit step tends to what Runge-Kutta finds.
#[test]
fn implicit_and_explicit_steps_know_the_same_laws() {
    let mut ends = Vec::new();
    for feedback in Feedback::ALL {
        let end = |integrator, steps| {
            let mut rig = flying(fed_back(feedback), 3);
            rig.run(integrator, 0.0, 0.02, steps);
            rig.x
        };
        let exact = end(Integrator::RungeKutta4, 800);
        let [coarse, fine] =
            [1000, 2000].map(|steps| distance(&end(Integrator::SemiImplicit, steps), &exact));
        assert!((1.8..2.2).contains(&(coarse / fine)), "{feedback:?}: {coarse}, {fine}");
        ends.push((exact, fine));
    }
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        let apart = distance(&ends[a].0, &ends[b].0);
        assert!(apart > 3.0 * ends[a].1, "arrangements {a} and {b}: {apart}");
    }
}

/// (5.40) at rest, the target a step away: U = C N e, and the current begins with U/L.
#[test]
fn voltage_law() {
    let law = VoltageLaw { position: 5.0, speed: 0.1 };
    let sampled = Sampled { delay: false, difference: false };
    let mut rig =
        Rig::of(controlled(ControlLaw::Voltage(law), Sampling::Cycle(sampled)), 3, Environment::flat());
    let step = 1e-3;
    rig.drives = rig.pose.iter().map(|q| JointCubic::resting(q + step)).collect();
    rig.plant.sample(1e-3, &rig.x, &rig.drives, &rig.inputs);
    let x = rig.x.clone();
    let rates = rig.rate(0.0, &x);
    for (k, at) in rig.plant.layout().current().enumerate() {
        let d = &rig.robot.drives[k];
        let q = |i: usize| d.joints.get(i).map_or(0.0, |j| rig.pose[*j]);
        let ratio = d.transmission.at([q(0), q(1), q(2)], [0.0; 3]).unwrap().ratio;
        let turn = step * ratio[..d.joints.len()].iter().sum::<f64>();
        let wanted = 5.0 * turn / d.motor.inductance;
        assert!(
            (rates[at] - wanted).abs() <= 1e-9 * wanted.abs().max(1.0),
            "{}: {}, {wanted}",
            d.name,
            rates[at]
        );
    }
}

/// What is computed at a sample acts at once, or one cycle later; between samples nothing changes it.
#[test]
fn a_sampled_law_holds_and_waits() {
    let currents = |delay: bool, samples: usize| {
        let sampling = Sampling::Cycle(Sampled { delay, difference: true });
        let mut rig = flying(controlled(ControlLaw::Cascade(CASCADE), sampling), 2);
        rig.drives = rig.pose.iter().map(|q| JointCubic::resting(q + 1e-3)).collect();
        for _ in 0..samples {
            rig.plant.sample(1e-3, &rig.x, &rig.drives, &rig.inputs);
        }
        rig.run(Integrator::SemiImplicit, 0.0, 1e-3, 10);
        let places = rig.plant.layout().current();
        rig.x[places].to_vec()
    };
    let most = |currents: Vec<f64>| currents.iter().fold(0.0_f64, |m, i| m.max(i.abs()));
    assert!(most(currents(false, 0)) < 1e-3, "nothing sampled, nothing put out");
    assert!(most(currents(true, 1)) < 1e-3, "the first output waits");
    assert!(most(currents(false, 1)) > 1.0);
    assert_eq!(currents(true, 2), currents(false, 1), "it comes a cycle later, the same");
}
