//! Hybrid position/force control (thesis 5.3): how the feet move so that they press as they shall.
//!
//! Per foot three coordinates are force controlled while it carries and position controlled while it swings:
//! height, roll, pitch (z, -s1, s0) against F_z, T_x, T_y.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | C | stiffness of one contact point | N/m |
//! | N | twist of both soles per unit of modification, torso held | 1 |
//! | G = K N | gain from modification to force, feet coupled through the moving CoG | N/m, N m/rad |
//! | Delta x_lambda | modification (z, roll, pitch) of each foot | m, rad, rad |
//!
//! Errata 2: G needs the same weighted inverse as the inverse kinematics does (5.30); the return to zero uses x_d0
//! (5.32); compression is positive, so the stiffness enters with a minus sign (5.28).

use config::gait::Control;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

/// Change of (F_z, T_x, T_y) about the sensor with (z, roll, pitch) of the sole frame, all points in contact (5.23).
///
/// `points` are the contact points relative to the sole frame, `sensor` the force sensor relative to it \[m\].
pub fn contact_stiffness(points: &[Vector3<f64>], sensor: Vector3<f64>, stiffness: f64) -> Matrix3<f64> {
    let mut k = Matrix3::zeros();
    for p in points {
        let compression = Vector3::new(-1.0, -p.y, p.x); // of this point, per (z, roll, pitch)
        let lever = Vector3::new(1.0, p.y - sensor.y, -(p.x - sensor.x)); // (F_z, T_x, T_y) per unit of force
        k += lever * compression.transpose() * stiffness;
    }
    k
}

/// Modifications of both feet: (z, roll, pitch) right, then left.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Modification {
    /// Delta x_lambda \[m, rad, rad\]
    pub value: Vector6<f64>,
    /// Its rate \[m/s, rad/s, rad/s\]
    pub rate: Vector6<f64>,
    /// Whether a limit held it back.
    pub limited: bool,
}

/// What the force controller is told in a cycle; vectors are (F_z, T_x, T_y) right, then left \[N, N m\].
#[derive(Clone, Copy, Debug)]
pub struct Forces {
    /// Desired, modified: lambda_d1.
    pub desired: Vector6<f64>,
    /// Rate of the planned ones.
    pub desired_rate: Vector6<f64>,
    /// Measured and filtered: lambda.
    pub measured: Vector6<f64>,
    /// Planned load factor of each foot.
    pub load: [f64; 2],
}

/// One cycle of `dt` \[s\]: the rate of the modification (5.32) and its integral (5.33), both limited.
///
/// `gain` is G with the stiffness of closed contacts for both feet: a foot in the air is position controlled, its
/// rows do not matter (errata 2 to (5.32)).
pub fn modify(
    control: &Control,
    gain: &Matrix6<f64>,
    forces: &Forces,
    last: &Modification,
    dt: f64,
) -> Modification {
    let k = Vector6::from_fn(|i, _| control.force_gain[i % 3]);
    let alpha = Vector6::from_fn(|i, _| force_share(control, forces, i / 3));
    let wanted = forces.desired_rate * control.force_feed_forward
        + k.component_mul(&(forces.desired - forces.measured)); // (5.26)
    let force_part = solve(gain, &alpha.component_mul(&wanted));
    let position_part = -last.value * control.position_gain;
    let mut next = *last;
    next.limited = false;
    for i in 0..6 {
        let wanted = force_part[i] + (1.0 - alpha[i]) * position_part[i]; // (5.32)
        let (limit, rate_limit) = (control.modification_limit[i % 3], control.modification_rate[i % 3]);
        let rate = wanted.clamp(-rate_limit, rate_limit);
        let value = (last.value[i] + rate * dt).clamp(-limit, limit); // (5.33)
        next.limited |= rate != wanted || value != last.value[i] + rate * dt;
        next.rate[i] = (value - last.value[i]) / dt;
        next.value[i] = value;
    }
    next
}

/// alpha_lambda of a foot: 0 position controlled, 1 force controlled. A foot is force controlled when it shall carry
/// and does: a blend over the measured normal force, 0 for a foot that the plan has in the air.
fn force_share(control: &Control, forces: &Forces, foot: usize) -> f64 {
    if forces.load[foot] <= 0.0 {
        return 0.0;
    }
    let [low, high] = control.force_blend;
    ((forces.measured[3 * foot] - low) / (high - low)).clamp(0.0, 1.0)
}

/// G^-1 b with rows and columns scaled to comparable units; zero where G cannot be inverted.
fn solve(gain: &Matrix6<f64>, b: &Vector6<f64>) -> Vector6<f64> {
    const LENGTH: f64 = 0.1; // m: moments and angles against forces and heights (errata 2, gap 18)
    let s = Vector6::from_fn(|i, _| if i % 3 == 0 { 1.0 } else { 1.0 / LENGTH });
    let scaled = Matrix6::from_fn(|i, j| s[i] * gain[(i, j)] * s[j]);
    scaled.lu().solve(&b.component_mul(&s)).map_or(Vector6::zeros(), |x| x.component_mul(&s))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat_foot() -> Vec<Vector3<f64>> {
        [(-0.1, -0.05), (-0.1, 0.05), (0.15, -0.05), (0.15, 0.05)]
            .map(|(x, y)| Vector3::new(x, y, 0.0))
            .to_vec()
    }

    fn gain() -> Matrix6<f64> {
        let k = contact_stiffness(&flat_foot(), Vector3::zeros(), 1.5e5);
        let mut g = Matrix6::zeros();
        g.fixed_view_mut::<3, 3>(0, 0).copy_from(&k);
        g.fixed_view_mut::<3, 3>(3, 3).copy_from(&k);
        g
    }

    /// Errata 2.13.
    #[test]
    fn stiffness_and_solution_of_the_errata() {
        let k = contact_stiffness(&flat_foot(), Vector3::zeros(), 1.5e5);
        let expected = Matrix3::new(-6e5, 0.0, 1.5e4, 0.0, -1500.0, 0.0, 1.5e4, 0.0, -9750.0);
        assert!((k - expected).abs().max() < 1e-9);
        let b = Vector6::new(100.0, 5.0, -8.0, 0.0, 0.0, 0.0);
        let x = solve(&gain(), &b);
        let expected = Vector6::new(-0.000152, -0.00333333333333, 0.000586666666667, 0.0, 0.0, 0.0);
        assert!((x - expected).abs().max() < 1e-14);
    }

    /// (5.26): on the contact it assumes, each force error decays as exp(-K t), by itself.
    #[test]
    fn force_errors_decay_independently() {
        let control = Control { force_feed_forward: 0.0, ..crate::test_gains() };
        let g = gain();
        let mut forces = Forces {
            desired: Vector6::new(330.0, 4.0, -6.0, 270.0, 0.0, 0.0),
            desired_rate: Vector6::zeros(),
            measured: Vector6::new(300.0, 0.0, 0.0, 300.0, 0.0, 0.0),
            load: [0.5, 0.5],
        };
        let error = forces.desired - forces.measured;
        let mut m = Modification::default();
        for _ in 0..100 {
            m = modify(&control, &g, &forces, &m, 1e-3);
            assert!(!m.limited);
            forces.measured += g * m.rate * 1e-3;
        }
        for i in 0..6 {
            let expected = error[i] * (1.0 - 1e-3 * control.force_gain[i % 3]).powi(100);
            assert!((forces.desired[i] - forces.measured[i] - expected).abs() < 1e-9);
        }
    }

    #[test]
    fn a_foot_in_the_air_forgets_its_modification() {
        let control = crate::test_gains();
        let forces = Forces {
            desired: Vector6::zeros(),
            desired_rate: Vector6::zeros(),
            measured: Vector6::zeros(),
            load: [0.0, 1.0],
        };
        let mut m =
            Modification { value: Vector6::new(0.004, 0.01, -0.01, 0.0, 0.0, 0.0), ..Default::default() };
        for _ in 0..500 {
            m = modify(&control, &gain(), &forces, &m, 1e-3);
        }
        assert!(m.value[0].abs() < 0.004 * (-0.49 * control.position_gain).exp());
    }

    #[test]
    fn a_singular_gain_moves_nothing() {
        assert_eq!(solve(&Matrix6::zeros(), &Vector6::repeat(1.0)), Vector6::zeros());
    }
}
