//! Jacobians of frames, (2.8)-(2.11), written into the caller's matrix.
//!
//! Columns of the base: its velocity v and angular velocity w in base axes. The `J x r` of the thesis is meant column
//! by column, -r~ J (errata (2.8)-(2.11)).

use nalgebra::{Const, Dyn, Matrix, RawStorageMut};

use crate::body::JointKernel;
use crate::data::Data;
use crate::model::{Frame, Model};
use crate::space::{V3, ZERO};

/// A matrix with 6 rows, the caller's: owned or a view into a larger one.
type SixRows<S> = Matrix<f64, Const<6>, Dyn, S>;

impl Model {
    /// Jacobian of a frame, 6 x n_v: rows velocity of the origin, then angular velocity, world axes. Needs
    /// [`Model::forward_kinematics`].
    pub fn frame_jacobian<S>(&self, data: &Data, frame: &Frame, jacobian: &mut SixRows<S>)
    where
        S: RawStorageMut<f64, Const<6>, Dyn>,
    {
        assert_eq!(jacobian.ncols(), self.nv(), "columns of the Jacobian");
        let at = point(data, frame);
        self.joint_columns(data, frame.body, at, 6, jacobian);
        let base = &data.places[0];
        let d = at - base.r;
        for (k, e) in [base.a.x, base.a.y, base.a.z].into_iter().enumerate() {
            set(jacobian, k, e, ZERO);
            set(jacobian, k + 3, e.cross(d), e);
        }
    }

    /// Only the joints' columns of [`Model::frame_jacobian`], 6 x n: the motion against the base, in world axes.
    pub fn frame_jacobian_of_joints<S>(&self, data: &Data, frame: &Frame, jacobian: &mut SixRows<S>)
    where
        S: RawStorageMut<f64, Const<6>, Dyn>,
    {
        assert_eq!(jacobian.ncols(), self.n(), "columns of the Jacobian");
        self.joint_columns(data, frame.body, point(data, frame), 0, jacobian);
    }

    fn joint_columns<S>(&self, data: &Data, body: usize, at: V3, first: usize, jacobian: &mut SixRows<S>)
    where
        S: RawStorageMut<f64, Const<6>, Dyn>,
    {
        let mut on_path = body;
        for (k, (body, p)) in self.bodies.iter().zip(&data.places).enumerate().skip(1).rev() {
            let column = first + k - 1;
            if k != on_path {
                set(jacobian, column, ZERO, ZERO);
                continue;
            }
            on_path = body.parent;
            match body.kind {
                JointKernel::Along(_) => set(jacobian, column, p.e, ZERO),
                _ => set(jacobian, column, p.e.cross(at - p.r), p.e),
            }
        }
    }
}

fn point(data: &Data, frame: &Frame) -> V3 {
    let p = &data.places[frame.body];
    p.r + p.a * frame.r
}

#[inline(always)]
fn set<S>(jacobian: &mut SixRows<S>, column: usize, linear: V3, angular: V3)
where
    S: RawStorageMut<f64, Const<6>, Dyn>,
{
    let mut to = jacobian.column_mut(column);
    (to[0], to[1], to[2]) = (linear.x, linear.y, linear.z);
    (to[3], to[4], to[5]) = (angular.x, angular.y, angular.z);
}
