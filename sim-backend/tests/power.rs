//! Power audit of the explicit equations of motion: what goes in is stored or lost, at wild states and over a motion.
//!
//! d/dt (kinetic + potential + springs) = motors + friction + brakes + ground, and for every motor
//! d/dt (L I^2 / 2) = U I - R I^2 - k_M I w.

use crate::rig::{Rig, lola};
use config::Robot;
use config::brake::Brake;
use config::method::Integrator;
use environment::Environment;
use nalgebra::Vector3;

/// d/dt of a function of time and state along the motion, by central differences.
fn change(rig: &mut Rig, t: f64, dx: &[f64], f: impl Fn(&mut Rig, f64, &[f64]) -> f64) -> f64 {
    const STEP: f64 = 1e-5;
    let ahead = |e: f64| -> Vec<f64> { rig.x.iter().zip(dx).map(|(x, dx)| x + e * dx).collect() };
    let (after, before) = (ahead(STEP), ahead(-STEP));
    (f(rig, t + STEP, &after) - f(rig, t - STEP, &before)) / (2.0 * STEP)
}

/// Change of the stored energy, and the power that comes in, at the rig's state.
fn balance(rig: &mut Rig) -> (f64, f64, f64) {
    let t = 0.05;
    let x = rig.x.clone();
    let dx = rig.rate(t, &x);
    let stored = change(rig, t, &dx, Rig::energy);
    let flow = rig.flow(t, &x);
    let ground = rig.ground(t, &x, &dx);
    assert!(flow.friction <= 0.0 && flow.brakes <= 0.0 && flow.heat >= 0.0, "{flow:?}");
    (stored, flow.motors + flow.friction + flow.brakes + ground, ground)
}

#[test]
fn types_2_and_3_balance_in_the_air() {
    for depth in [2, 3] {
        for seed in 0..10 {
            let mut rig = Rig::new(depth).in_the_air().moving(0.3, 0.1).shaken(seed);
            let (stored, power, ground) = balance(&mut rig);
            assert!(ground.abs() < 1e-12);
            assert!(power.abs() > 1.0, "nothing happens: {power} W");
            assert!(
                (stored - power).abs() < 1e-5 * power.abs().max(100.0),
                "{depth}: {stored} for {power} W"
            );
        }
    }
}

#[test]
fn types_2_and_3_balance_on_the_ground() {
    for depth in [2, 3] {
        for seed in 0..10 {
            let mut rig = Rig::new(depth).moving(0.1, 0.1).shaken(seed);
            let (stored, power, ground) = balance(&mut rig);
            assert!(
                (stored - power).abs() < 1e-5 * power.abs().max(100.0),
                "{depth}: {stored} for {power} W"
            );
            assert!(ground.abs() > 1.0 || seed > 0, "feet in the air");
        }
    }
}

/// With the supply off, brakes, friction and windings only take.
#[test]
fn without_supply_everything_loses() {
    for depth in [2, 3] {
        for seed in 0..10 {
            let mut rig = Rig::new(depth).in_the_air().shaken(seed);
            rig.inputs.switches.powered = false;
            let (stored, power, _) = balance(&mut rig);
            assert!(
                (stored - power).abs() < 1e-5 * power.abs().max(100.0),
                "{depth}: {stored} for {power} W"
            );
            // Open terminals: what is left of the current only heats.
            let x = rig.x.clone();
            let dx = rig.rate(0.05, &x);
            let magnetic = change(&mut rig, 0.05, &dx, |rig, _, x| rig.magnetic(x));
            let flow = rig.flow(0.05, &x);
            let expected = -flow.heat;
            assert!((magnetic - expected).abs() < 1e-6 * expected.abs(), "{magnetic} for {expected} W");
            assert!(stored + magnetic < 0.0);
        }
    }
}

/// Momentum changes by what the ground does, about the centre of gravity: types 1 to 5, motors working.
#[test]
fn the_ground_changes_the_momentum() {
    for depth in 1..=5 {
        for seed in 0..3 {
            let mut rig = Rig::new(depth).moving(0.05, 0.1).shaken(seed);
            let (t, x) = (0.05, rig.x.clone());
            let dx = rig.rate(t, &x);
            let weight = Vector3::z() * (rig.plant.model().mass() * 9.81);
            let com = rig.cog(t, &x);
            let s = rig.snapshot(t);
            let (mut force, mut moment) = (-weight, Vector3::zeros());
            for (wrench, foot) in s.foot_wrench.iter().zip(s.feet) {
                let f = Vector3::from(wrench.force);
                force += f;
                moment +=
                    Vector3::from(wrench.moment) + (Vector3::new(foot[0], foot[1], foot[2]) - com).cross(&f);
            }
            assert!((force + weight).norm() > 10.0 || seed > 0, "feet in the air");
            for i in 0..3 {
                let p = change(&mut rig, t, &dx, |rig, t, x| rig.momentum(t, x).linear[i]);
                let l = change(&mut rig, t, &dx, |rig, t, x| rig.momentum(t, x).angular[i]);
                assert!((p - force[i]).abs() < 1e-5 * force.norm(), "type {depth}: {p} N for {force}");
                assert!(
                    (l - moment[i]).abs() < 1e-5 * moment.norm().max(100.0),
                    "type {depth}: {l} N m for {moment}"
                );
            }
        }
    }
}

/// A second audit over time: joints swing in the air for 20 ms; energy comes from the motors alone.
#[test]
fn a_motion_in_the_air_keeps_the_books() {
    for (depth, h) in [(2, 1e-5), (3, 1e-5)] {
        let mut rig = Rig::new(depth).in_the_air().moving(0.2, 0.1);
        let steps = (0.02 / h) as u32;
        let before = rig.energy(0.0, &rig.x.clone());
        let mut given = 0.0;
        for i in 0..steps {
            let t = f64::from(i) * h;
            // Simpson's rule over two half steps.
            let mut power = [0.0; 3];
            for (k, p) in power.iter_mut().enumerate() {
                let now = t + 0.5 * h * k as f64;
                let flow = rig.flow(now, &rig.x);
                *p = flow.motors + flow.friction;
                if k < 2 {
                    rig.run(Integrator::RungeKutta4, now, now + 0.5 * h, 1);
                }
            }
            given += h / 6.0 * (power[0] + 4.0 * power[1] + power[2]);
        }
        let after = rig.energy(0.02, &rig.x.clone());
        assert!(given > 0.1, "{given} J");
        assert!(
            (after - before - given).abs() < 1e-6 * given,
            "type {depth}: {} of {given} J",
            after - before
        );
    }
}

/// In the air nothing acts but gravity: momentum about the centre of gravity is kept while motors work.
#[test]
fn motors_in_the_air_keep_the_momentum() {
    for (depth, steps) in [(1, 1000), (2, 1000), (3, 2000)] {
        let mut rig = Rig::new(depth).in_the_air().moving(0.2, 0.05);
        let l = rig.plant.layout().speed();
        rig.x[l.start..l.start + 6].copy_from_slice(&[0.3, -0.2, 0.5, 0.4, -0.3, 0.2]);
        let x = rig.x.clone();
        let (before, com) = (rig.momentum(0.0, &x), rig.cog(0.0, &x));
        rig.run(Integrator::RungeKutta4, 0.0, 0.05, steps);
        let x = rig.x.clone();
        let (after, end) = (rig.momentum(0.05, &x), rig.cog(0.05, &x));
        let m = rig.plant.model().mass();
        let lost = before.linear - Vector3::z() * (m * 9.81 * 0.05) - after.linear;
        assert!(lost.norm() < 1e-6, "type {depth}: {lost}");
        let turned = after.angular - before.angular;
        assert!(turned.norm() < 1e-6 * before.angular.norm(), "type {depth}: {turned}");
        let parabola = com + before.linear / m * 0.05 - Vector3::z() * (0.5 * 9.81 * 0.05 * 0.05);
        assert!((end - parabola).norm() < 1e-8, "type {depth}: {}", (end - parabola).norm());
        if depth > 1 {
            let moved = (x[7] - rig.pose[0]).abs();
            assert!(moved > 0.05, "the joints stood still: {moved} rad");
        }
    }
}

/// Lola with brakes that hold what the motors could hold.
fn braked() -> Robot {
    let mut robot = lola();
    for drive in &mut robot.drives {
        drive.brake = Some(Brake { torque: drive.motor.torque(drive.current_limit), delay: 0.0 });
    }
    robot
}

/// The supply fails in the air while all joints swing: brakes stop the motors, and nothing gains energy.
#[test]
fn brakes_stop_joints_in_the_air() {
    for depth in 2..=5 {
        let mut rig = Rig::of(braked(), depth, Environment::flat()).in_the_air().moving(0.2, 0.1);
        rig.run(Integrator::SemiImplicit, 0.0, 0.03, 60);
        (rig.inputs.switches.powered, rig.inputs.switches.braked) = (false, u64::MAX);
        let speed =
            |rig: &Rig| rig.motors(0.0, &rig.x).iter().fold(0.0, |most, (_, w)| f64::max(most, w.abs()));
        let x = rig.x.clone();
        let mut energy = rig.energy(0.0, &x) + rig.magnetic(&x);
        assert!(speed(&rig) > 100.0, "type {depth}: {} rad/s", speed(&rig));
        for _ in 0..30 {
            rig.run(Integrator::SemiImplicit, 0.0, 0.01, 20);
            let x = rig.x.clone();
            let now = rig.energy(0.0, &x) + rig.magnetic(&x);
            assert!(now < energy + 0.01, "type {depth}: {energy} J, then {now} J");
            energy = now;
        }
        assert!(speed(&rig) < 0.01, "type {depth}: {} rad/s", speed(&rig));
    }
}
