//! Contact frame: two tangents and the normal of the ground at a node (errata 1, section 4.11).

use nalgebra::{Matrix3, Vector3};

/// E = (t1 t2 n), right-handed: t1 = n x e, normalised, with e the axis that is least aligned with n, t2 = n x t1.
///
/// `n` must have length 1. The tangents jump where the least aligned axis changes, so what is kept from step to step must
/// not be kept in this frame.
pub fn frame(n: &Vector3<f64>) -> Matrix3<f64> {
    let e = Vector3::ith(n.iamin(), 1.0);
    let t1 = n.cross(&e).normalize();
    Matrix3::from_columns(&[t1, n.cross(&t1), *n])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn level_ground() {
        assert_eq!(frame(&Vector3::z()).column(2), Vector3::z());
    }

    proptest! {
        #[test]
        fn is_a_rotation_that_ends_in_the_normal(n in prop::array::uniform3(-1.0..1.0f64)) {
            let n = Vector3::from(n);
            prop_assume!(n.norm() > 1e-3);
            let e = frame(&n.normalize());
            prop_assert!((e.transpose() * e - Matrix3::identity()).norm() < 1e-14);
            prop_assert!((e.determinant() - 1.0).abs() < 1e-14);
            prop_assert!((e.column(2) - n.normalize()).norm() < 1e-15);
        }
    }
}
