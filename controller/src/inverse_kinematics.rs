//! Resolved motion rate control with null-space optimization (thesis 5.4): task velocities to joint speeds.
//!
//! Variables: q' of the free joints (those between torso and soles).
//! Objective: 1/2 q'^T W q' + alpha_N (grad H) q'    (5.38, sign corrected)
//! Constraints: J q' = x'.
//!
//! | symbol | name | unit | shape |
//! |---|---|---|---|
//! | x' | velocity of both soles relative to the CoG, and their rotation rate, torso axes | m/s, rad/s | 12 |
//! | J | task Jacobian | | 12 x joints |
//! | W | diagonal weights, zero rate for joints that are not free | 1 | joints |
//! | H | cost: distance to comfortable angles and to range limits | 1 | |
//!
//! Solved without forming the inverse (appendix F, signs corrected): (J W^-1 J^T) mu = x' - J z, q' = W^-1 J^T mu + z,
//! z = -alpha_N W^-1 (grad H)^T.

use config::robot::Joint;
use messages::MAX_JOINTS;
use nalgebra::{Cholesky, Const, SMatrix, SVector};

/// Task rows: position and rotation of the right sole, then of the left one.
pub(crate) const TASK: usize = 12;

/// Velocity of the task space.
pub type TaskVector = SVector<f64, TASK>;
/// Velocities of all joints \[rad/s\].
pub type JointVector = SVector<f64, MAX_JOINTS>;
/// d x / d q.
pub type TaskJacobian = SMatrix<f64, TASK, MAX_JOINTS>;

type Gram = SMatrix<f64, TASK, TASK>;

/// Weights, ranges and comfort of the joints.
#[derive(Clone)]
pub struct InverseKinematics {
    /// 1/W; zero for joints that are not free.
    inverse_weight: JointVector,
    /// Joints that are free: the products below leave the others out.
    free: Vec<usize>,
    ranges: [[f64; 2]; MAX_JOINTS],
    comfort: JointVector,
    null_space_gain: f64,
}

/// A factorised task: J, its weighted Gram matrix, and how near it is to singular.
pub struct Factorised {
    jacobian: TaskJacobian,
    gram: Cholesky<f64, Const<TASK>>,
    /// Damping was needed because the task is nearly singular (a straight knee).
    pub damped: bool,
}

impl InverseKinematics {
    /// `free` marks the joints that may be used; the others have speeds of their own.
    pub fn new(joints: &[Joint], free: &[bool], null_space_gain: f64) -> Self {
        let mut ik = Self {
            inverse_weight: JointVector::zeros(),
            free: (0..joints.len()).filter(|&j| free[j]).collect(),
            ranges: [[0.0, 1.0]; MAX_JOINTS],
            comfort: JointVector::zeros(),
            null_space_gain,
        };
        for (j, joint) in joints.iter().enumerate() {
            ik.inverse_weight[j] = if free[j] { 1.0 / joint.weight } else { 0.0 };
            ik.ranges[j] = joint.range;
            ik.comfort[j] = joint.comfort;
        }
        ik
    }

    /// Factorises J W^-1 J^T. Near a singularity the smallest damping that keeps it regular is added.
    pub fn factorise(&self, jacobian: &TaskJacobian) -> Factorised {
        let mut gram = Gram::zeros();
        for &j in &self.free {
            let column = jacobian.column(j);
            for k in 0..TASK {
                let a = self.inverse_weight[j] * column[k];
                for i in 0..TASK {
                    gram[(i, k)] += a * column[i];
                }
            }
        }
        // A straight knee shows as a vanishing pivot (measured: sigma_min of one leg is 0.195 q near q = 0).
        const FLOOR: f64 = 1e-5;
        let regular = Cholesky::new(gram).filter(|c| c.l_dirty().diagonal().min() > FLOOR.sqrt());
        let damped = regular.is_none();
        let gram = regular.or_else(|| Cholesky::new(gram + Gram::identity() * FLOOR)).unwrap_or_else(|| {
            // Not even semi-definite: NaN in the Jacobian. Nothing moves.
            Cholesky::new_unchecked(Gram::identity() * f64::INFINITY)
        });
        Factorised { jacobian: *jacobian, gram, damped }
    }

    /// Joint speeds for the task velocity `xd`; `given` are the speeds of the joints that are not free, `share` of the
    /// null-space motion is wanted (0 to 1). (5.38)
    pub fn speeds(
        &self,
        f: &Factorised,
        xd: &TaskVector,
        given: &JointVector,
        q: &[f64],
        share: f64,
    ) -> JointVector {
        let mut z = *given;
        let gain = share * self.null_space_gain;
        for j in 0..MAX_JOINTS.min(q.len()) {
            z[j] -= gain * self.inverse_weight[j] * self.gradient(j, q[j]);
        }
        let mut rest = *xd;
        for j in (0..q.len().min(MAX_JOINTS)).filter(|&j| z[j] != 0.0) {
            rest.axpy(-z[j], &f.jacobian.column(j), 1.0);
        }
        let mu = f.gram.solve(&rest);
        let mut speeds = z;
        for &j in &self.free {
            speeds[j] += self.inverse_weight[j] * f.jacobian.column(j).dot(&mu);
        }
        speeds
    }

    /// Joint speeds that realise a unit of each column of `u`, without null-space motion: J_W^# u.
    pub fn columns<const M: usize>(
        &self,
        f: &Factorised,
        u: &SMatrix<f64, TASK, M>,
    ) -> SMatrix<f64, MAX_JOINTS, M> {
        let mu = f.gram.solve(u);
        let mut speeds = SMatrix::zeros();
        for &j in &self.free {
            for m in 0..M {
                speeds[(j, m)] = self.inverse_weight[j] * f.jacobian.column(j).dot(&mu.column(m));
            }
        }
        speeds
    }

    /// dH/dq of one joint: quadratic towards the comfortable angle, and steeply away from the last 10 % of the range
    /// (thesis figure 5.5).
    fn gradient(&self, j: usize, q: f64) -> f64 {
        let [low, high] = self.ranges[j];
        let range = high - low;
        let margin = 0.1 * range;
        let comfort = (q - self.comfort[j]) / (range * range);
        let limit = if q > high - margin {
            (q - (high - margin)) / (margin * margin)
        } else if q < low + margin {
            (q - (low + margin)) / (margin * margin)
        } else {
            0.0
        };
        comfort + limit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joints(n: usize) -> Vec<Joint> {
        (0..n)
            .map(|j| Joint {
                name: format!("j{j}"),
                range: [-1.0, 1.0],
                speed_limit: 8.0,
                braking: 100.0,
                acceleration: f64::INFINITY,
                comfort: 0.1,
                weight: 1.0 + j as f64,
            })
            .collect()
    }

    fn jacobian(seed: u64) -> TaskJacobian {
        let mut state = seed;
        TaskJacobian::from_fn(|_, j| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            if j < 14 { (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5 } else { 0.0 }
        })
    }

    #[test]
    fn tracks_the_task_whatever_the_null_space_does() {
        let ik = InverseKinematics::new(&joints(14), &[true; 14], 3.0);
        let j = jacobian(1);
        let f = ik.factorise(&j);
        assert!(!f.damped);
        let xd = TaskVector::from_fn(|i, _| 0.1 * i as f64 - 0.4);
        let q: Vec<f64> = (0..14).map(|i| 0.12 * f64::from(i) - 0.9).collect();
        let speeds = ik.speeds(&f, &xd, &JointVector::zeros(), &q, 1.0);
        assert!((j * speeds - xd).norm() < 1e-11);
    }

    /// KKT conditions of the corrected (5.38), with errata 2.13 as the small example behind it.
    #[test]
    fn minimises_the_corrected_cost() {
        let ik = InverseKinematics::new(&joints(14), &[true; 14], 2.0);
        let j = jacobian(7);
        let f = ik.factorise(&j);
        let xd = TaskVector::repeat(0.2);
        let q = [0.95; 14];
        let speeds = ik.speeds(&f, &xd, &JointVector::zeros(), &q, 1.0);
        // W q' + alpha grad H must lie in the row space of J.
        let g = JointVector::from_fn(|i, _| {
            if i < 14 { (1.0 + i as f64) * speeds[i] + 2.0 * ik.gradient(i, q[i]) } else { 0.0 }
        });
        let jt = j.transpose();
        let mu = (j * jt).cholesky().unwrap().solve(&(j * g));
        assert!((g - jt * mu).norm() < 1e-10);
    }

    #[test]
    fn the_null_space_leads_away_from_the_limits() {
        let ik = InverseKinematics::new(&joints(14), &[true; 14], 1.0);
        let f = ik.factorise(&jacobian(3));
        let mut q = [0.0; 14];
        q[4] = 0.97;
        let speeds = ik.speeds(&f, &TaskVector::zeros(), &JointVector::zeros(), &q, 1.0);
        let slope: f64 = (0..14).map(|j| ik.gradient(j, q[j]) * speeds[j]).sum();
        assert!(slope < 0.0, "dH/dt = {slope}");
    }

    #[test]
    fn joints_that_are_not_free_keep_their_own_speed() {
        let mut free = [true; 14];
        free[5] = false;
        let ik = InverseKinematics::new(&joints(14), &free, 0.0);
        let j = jacobian(11);
        let f = ik.factorise(&j);
        let mut given = JointVector::zeros();
        given[5] = 0.7;
        let xd = TaskVector::repeat(0.1);
        let speeds = ik.speeds(&f, &xd, &given, &[0.0; 14], 1.0);
        assert_eq!(speeds[5], 0.7);
        assert!((j * speeds - xd).norm() < 1e-10);
    }

    #[test]
    fn a_singular_task_is_damped_and_says_so_and_nan_moves_nothing() {
        let ik = InverseKinematics::new(&joints(14), &[true; 14], 0.0);
        let mut j = jacobian(5);
        j.row_mut(2).fill(0.0);
        let f = ik.factorise(&j);
        assert!(f.damped);
        let speeds = ik.speeds(&f, &TaskVector::repeat(0.1), &JointVector::zeros(), &[0.0; 14], 1.0);
        assert!(speeds.iter().all(|s| s.is_finite()) && speeds.norm() < 10.0);
        j.fill(f64::NAN);
        let f = ik.factorise(&j);
        assert!(f.damped);
    }
}
