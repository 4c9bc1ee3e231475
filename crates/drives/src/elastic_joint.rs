//! A joint with an elastic gear under PD control of its torque: is it stable (thesis 5.5.2, figure 5.11)?
//!
//! ```text
//! J_J q_J'' + K (q_J - q_M) = 0                       (5.41)
//! J_M q_M'' + d q_M' + K (q_M - q_J) = tau            (5.42), with viscous friction d of the rotor
//! tau = K_p (q_d - q_a) + K_d (q'_d - q'_b)           a, b: sides that are measured (5.43), (5.45), (5.49)
//! ```
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | q_J, q_M | angles of link and motor; gear ratio 1: rotors and gains count on the link's side | rad |
//! | J_J, J_M | inertia of link, and of the rotor times N^2 | kg m^2 |
//! | K, d | stiffness of the gear, friction of the rotor | N m/rad, N m s/rad |
//! | K_p, K_d | gains | N m/rad, N m s/rad |
//! | T | time between two samples | s |
//! | a_0..a_4 | characteristic polynomial of s | |
//!
//! Conditions on the continuous loop are those of Hurwitz; of the sampled one the spectral radius of the step from one
//! sample to the next, exact for a torque that is held (errata 2.14).

use nalgebra::linalg::Schur;
use nalgebra::{Matrix4, SMatrix, SVector};

use crate::control::{Feedback, GearSide, Sampled};

/// The joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElasticJoint {
    /// \[N m/rad\] K.
    pub stiffness: f64,
    /// \[kg m^2\] J_J.
    pub link: f64,
    /// \[kg m^2\] J_M.
    pub rotor: f64,
    /// \[N m s/rad\] d.
    pub friction: f64,
}

/// Gains of the PD law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// \[N m/rad\] K_p.
    pub position: f64,
    /// \[N m s/rad\] K_d.
    pub speed: f64,
}

/// The joint from one sample to the next while its torque is held.
#[derive(Clone, Copy, Debug)]
pub struct HeldJoint {
    period: f64,
    free: Matrix4<f64>,
    by_torque: SVector<f64, 4>,
}

/// Rounds of the iteration for eigenvalues.
const ROUNDS: usize = 1000;

impl ElasticJoint {
    /// a_0 to a_4, the denominators of (5.44), (5.46), (5.50).
    pub fn characteristic(&self, feedback: Feedback, gains: Gains) -> [f64; 5] {
        let Self { stiffness: k, link: j, rotor: m, friction: d } = *self;
        let Gains { position: kp, speed: kd } = gains;
        let free = [0.0, k * d, k * (j + m), j * d, j * m];
        // The torque moves the motor as J_J s^2 + K, the link as K.
        let p = if feedback.position() == GearSide::Motor { j * kp } else { 0.0 };
        let v = if feedback.speed() == GearSide::Motor { j * kd } else { 0.0 };
        [k * kp, free[1] + k * kd, free[2] + p, free[3] + v, free[4]]
    }

    /// Determinants of second and third order: (5.47), (5.48); (5.51), (5.52).
    pub fn hurwitz(&self, feedback: Feedback, gains: Gains) -> [f64; 2] {
        let [a0, a1, a2, a3, a4] = self.characteristic(feedback, gains);
        let second = a1 * a2 - a3 * a0;
        [second, a3 * second - a4 * a1 * a1]
    }

    /// True if the continuous loop is stable: all coefficients and determinants are positive.
    pub fn is_stable(&self, feedback: Feedback, gains: Gains) -> bool {
        let positive = |x: &f64| *x > 0.0;
        self.characteristic(feedback, gains).iter().all(positive)
            && self.hurwitz(feedback, gains).iter().all(positive)
    }

    /// \[1/s\] Rate at which the continuous loop grows: the largest real part of its poles; NaN if they are not found.
    pub fn growth(&self, feedback: Feedback, gains: Gains) -> f64 {
        let a = self.characteristic(feedback, gains);
        // Companion matrix in a time in which the poles are near 1.
        let unit = (a[0] / a[4]).abs().powf(0.25).max(1e-9);
        let mut companion = Matrix4::zeros();
        for i in 0..4 {
            companion[(i, 3)] = -a[i] / a[4] / unit.powi(4 - i as i32);
            if i > 0 {
                companion[(i, i - 1)] = 1.0;
            }
        }
        let Some(schur) = Schur::try_new(companion, f64::EPSILON, ROUNDS) else { return f64::NAN };
        schur.complex_eigenvalues().iter().map(|s| unit * s.re).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The joint sampled with `period` T \[s\].
    pub fn held(&self, period: f64) -> HeldJoint {
        let Self { stiffness: k, link: j, rotor: m, friction: d } = *self;
        // States q_J, q_M, q_J', q_M', torque.
        let rates = SMatrix::<f64, 5, 5>::from_row_slice(&[
            0.0,
            0.0,
            1.0,
            0.0,
            0.0, //
            0.0,
            0.0,
            0.0,
            1.0,
            0.0, //
            -k / j,
            k / j,
            0.0,
            0.0,
            0.0, //
            k / m,
            -k / m,
            0.0,
            -d / m,
            1.0 / m, //
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
        ]);
        let step = (rates * period).exp();
        HeldJoint {
            period,
            free: step.fixed_view::<4, 4>(0, 0).into(),
            by_torque: step.fixed_view::<4, 1>(0, 4).into(),
        }
    }
}

impl HeldJoint {
    /// \[1\] Factor by which the sampled loop grows from sample to sample: stable below 1; NaN if it is not found.
    pub fn spectral_radius(&self, feedback: Feedback, gains: Gains, sampled: Sampled) -> f64 {
        let at = |side| usize::from(side == GearSide::Motor);
        let (angle, seen) = (at(feedback.position()), at(feedback.speed()));
        // States q_J, q_M, q_J', q_M', the angle of the last sample, the torque computed there.
        let mut torque = SVector::<f64, 6>::zeros();
        torque[angle] -= gains.position;
        if sampled.difference {
            torque[seen] -= gains.speed / self.period;
            torque[4] += gains.speed / self.period;
        } else {
            torque[2 + seen] -= gains.speed;
        }
        let mut acting = torque;
        if sampled.delay {
            acting.fill(0.0);
            acting[5] = 1.0;
        }
        let mut step = SMatrix::<f64, 6, 6>::zeros();
        step.fixed_view_mut::<4, 4>(0, 0).copy_from(&self.free);
        for i in 0..4 {
            for k in 0..6 {
                step[(i, k)] += self.by_torque[i] * acting[k];
            }
        }
        step[(4, seen)] = 1.0;
        step.set_row(5, &torque.transpose());
        let Some(schur) = Schur::try_new(step, f64::EPSILON, ROUNDS) else { return f64::NAN };
        schur.complex_eigenvalues().iter().map(|z| z.norm()).fold(0.0, f64::max)
    }

    /// True if the sampled loop is stable.
    pub fn is_stable(&self, feedback: Feedback, gains: Gains, sampled: Sampled) -> bool {
        self.spectral_radius(feedback, gains, sampled) < 1.0
    }
}
