//! Methods and models against each other: orders of convergence, limits of stiff gears and strong controllers, dry
//! friction that holds.

use crate::rig::{Rig, lola};
use config::Robot;
use config::method::Integrator;
use drives::{Elasticity, Friction};
use environment::Environment;

/// Lola without what has corners: no friction, springs of one stiffness, no limits of current and voltage.
fn smooth(stiffer: f64) -> Robot {
    let mut robot = lola();
    for d in &mut robot.drives {
        d.friction = Friction::Free;
        (d.current_limit, d.voltage_limit) = (1e9, 1e9);
        d.elasticity = d.elasticity.map(|e| Elasticity::linear(stiffer * e.stiffness[0]));
    }
    robot
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Order by three runs, each with twice the steps of the one before.
fn order(rig: impl Fn() -> Rig, integrator: Integrator, steps: u32) -> f64 {
    let end = |steps| {
        let mut rig = rig();
        rig.run(integrator, 0.0, 0.02, steps);
        rig.x
    };
    let [a, b, c] = [1, 2, 4].map(|n| end(n * steps));
    (distance(&a, &b) / distance(&b, &c)).log2()
}

/// Methods, their orders, and steps for a type: few enough that errors stand out of rounding, enough for its fastest part.
fn methods(depth: u8) -> [(Integrator, f64, u32); 3] {
    let steps = match depth {
        1 => 50,
        2 | 4 => 200,
        _ => 400,
    };
    [
        (Integrator::Euler, 1.0, 800),
        (Integrator::SemiImplicit, 1.0, 800),
        (Integrator::RungeKutta4, 4.0, steps),
    ]
}

/// In the air, nodes on their way back to rest.
#[test]
fn orders_of_convergence_in_the_air() {
    for depth in 1..=5 {
        let rig = || {
            let mut rig = Rig::of(smooth(1.0), depth, Environment::flat()).in_the_air().moving(0.02, 0.1);
            let layer = rig.plant.layout().layer();
            rig.x[layer].iter_mut().zip(1..).for_each(|(d, i)| *d = 1e-4 * f64::from(i).sin());
            rig
        };
        for (integrator, expected, steps) in methods(depth) {
            let order = order(rig, integrator, steps);
            assert!((order - expected).abs() < 0.2, "type {depth}, {integrator:?}: order {order}");
        }
    }
}

/// On the ground, from where the robot has settled: no node changes what it does.
#[test]
fn orders_of_convergence_on_the_ground() {
    for depth in 1..=3 {
        let on_ground = || Rig::of(smooth(1.0), depth, Environment::flat());
        let mut settled = on_ground();
        settled.run(Integrator::SemiImplicit, 0.0, 3.0, 15_000);
        let rig = || {
            let mut rig = on_ground().moving(0.001, 0.1);
            rig.x.copy_from_slice(&settled.x);
            rig
        };
        for (integrator, expected, steps) in methods(depth) {
            let order = order(rig, integrator, steps);
            assert!((order - expected).abs() < 0.2, "type {depth}, {integrator:?}: order {order}");
        }
    }
}

/// Type 3 becomes type 2 as its gears become stiff: a hundred times as stiff, about a hundredth of the difference.
#[test]
fn stiff_gears_are_rigid_gears() {
    let with = |depth, stiffer| {
        let mut rig = Rig::of(smooth(stiffer), depth, Environment::flat()).moving(0.003, 0.1);
        let gains: Vec<f64> = Rig::new(2).plant.train_mut().unwrap().speed_gains().collect();
        rig.plant.train_mut().unwrap().set_speed_gains(gains);
        rig.run(Integrator::RungeKutta4, 0.0, 0.02, 2000);
        let pose = rig.plant.layout().pose();
        rig.x[pose].to_vec()
    };
    let rigid = with(2, 1.0);
    let [soft, stiff, stiffest] = [1.0, 1e2, 1e4].map(|s| distance(&with(3, s), &rigid));
    assert!(soft > 1e-5, "{soft}");
    assert!((20.0..500.0).contains(&(soft / stiff)), "{soft} {stiff}");
    assert!((20.0..500.0).contains(&(stiff / stiffest)), "{stiff} {stiffest}");
}

/// Type 2 becomes type 1 as its controllers become strong: ten times the gain, a tenth of the difference.
#[test]
fn strong_controllers_are_prescribed_joints() {
    let with = |depth, stronger: f64| {
        let mut rig = Rig::of(smooth(1.0), depth, Environment::flat()).moving(0.003, 0.1);
        let train = rig.plant.train_mut().unwrap();
        let gains: Vec<f64> = train.speed_gains().map(|g| g * stronger).collect();
        train.set_speed_gains(gains);
        rig.run(Integrator::SemiImplicit, 0.0, 0.1, 10_000);
        rig.x[..7].to_vec()
    };
    let prescribed = with(1, 1.0);
    let [weak, strong, strongest] = [1e1, 1e2, 1e3].map(|s| distance(&with(2, s), &prescribed));
    for ratio in [weak / strong, strong / strongest] {
        assert!((5.0..20.0).contains(&ratio), "{weak} {strong} {strongest}");
    }
}

/// Standing for 10 s on gears that stick: their joints have speed 0, not nearly 0, and do not drift by a bit.
#[test]
fn joints_that_stick_stay_where_they_are() {
    let mut rig = Rig::new(2);
    let l = *rig.plant.layout();
    let resting =
        |x: &[f64]| -> Vec<usize> { (0..l.joints).filter(|j| x[l.speed()][6 + j] == 0.0).collect() };
    rig.run(Integrator::SemiImplicit, 0.0, 2.0, 2000);
    let before = rig.x.clone();
    rig.run(Integrator::SemiImplicit, 0.0, 10.0, 10_000);
    let held = resting(&before);
    assert!(held.len() >= 16, "{held:?}");
    assert_eq!(resting(&rig.x), held);
    for j in held {
        assert_eq!(rig.x[7 + j], before[7 + j], "joint {j} creeps");
    }
}

/// While everything slides, dry friction of the implicit step is that of the explicit one.
#[test]
fn sliding_gears_are_the_same_implicit_and_explicit() {
    let run = |integrator, steps, free: bool| {
        let mut robot = lola();
        if free {
            robot.drives.iter_mut().for_each(|d| d.friction = Friction::Free);
        }
        let mut rig = Rig::of(robot, 2, Environment::flat()).in_the_air();
        let l = *rig.plant.layout();
        for j in 0..l.joints {
            let speed = if j % 2 == 0 { 0.8 } else { -0.8 };
            rig.x[l.speed().start + 6 + j] = speed;
            let from = sim_backend::drive::JointMotion { angle: rig.pose[j], speed, acceleration: 0.0 };
            rig.drives[j] =
                sim_backend::drive::JointCubic::follow(from, rig.pose[j] + 0.01 * speed, speed, 0.01);
        }
        rig.run(integrator, 0.0, 0.01, steps);
        let speeds = rig.x[l.speed()][6..].iter().enumerate();
        assert!(speeds.clone().all(|(j, v)| (*v > 0.0) == (j % 2 == 0)), "one joint came to rest");
        rig.x
    };
    let exact = run(Integrator::RungeKutta4, 1000, false);
    let friction = distance(&run(Integrator::RungeKutta4, 1000, true), &exact);
    let [a, b] = [1000, 2000].map(|n| distance(&run(Integrator::SemiImplicit, n, false), &exact));
    let euler = distance(&run(Integrator::Euler, 2000, false), &exact);
    assert!(b < 0.01 * friction && (a / b - 2.0).abs() < 0.2, "{friction} {a} {b} {euler}");
}

/// The rotor behind an elastic gear is carried along by a stator that turns: the implicit step finds the motion of the
/// explicit one, and comes nearer in proportion to its length.
#[test]
fn elastic_gears_are_the_same_implicit_and_explicit() {
    let run = |integrator, steps| {
        let mut robot = lola();
        robot.drives.iter_mut().for_each(|d| d.friction = Friction::Free);
        let mut rig = Rig::of(robot, 3, Environment::flat()).in_the_air();
        let l = *rig.plant.layout();
        rig.x[l.speed()][3..6].copy_from_slice(&[2.0, -3.0, 1.0]);
        for j in 0..l.joints {
            rig.x[l.speed().start + 6 + j] = if j % 2 == 0 { 1.0 } else { -1.0 };
        }
        rig.run(integrator, 0.0, 0.02, steps);
        rig.x
    };
    let exact = run(Integrator::RungeKutta4, 4000);
    let [a, b, c] = [2000, 4000, 8000].map(|n| distance(&run(Integrator::SemiImplicit, n), &exact));
    assert!((a / b - 2.0).abs() < 0.2 && (b / c - 2.0).abs() < 0.2, "{a} {b} {c}");
}
