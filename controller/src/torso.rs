//! Orientation of the upper body: inclinations phi_x, phi_y and heading alpha (thesis 4.4.4).
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | phi_x | angle between vertical and torso x axis (pi/2 upright; pitch p about y adds +p) | rad |
//! | phi_y | angle between vertical and torso y axis (pi/2 upright; roll r about x adds -r) | rad |
//! | alpha | heading of the torso x axis | rad |
//!
//! The thesis's matrix (4.18)-(4.21), (D.5) is not a rotation when both inclinations differ from pi/2, and is called
//! A_TI though its columns are the torso axes in I. Here is the exact form of errata 2.3, world_from_torso.

use nalgebra::{Matrix3, Vector3};

/// phi_x, phi_y, alpha \[rad\].
pub(crate) type TorsoAngles = Vector3<f64>;

/// Rotation world_from_torso of the angles; `None` where the torso's z axis is not above the horizontal.
pub fn rotation(angles: &TorsoAngles) -> Option<Matrix3<f64>> {
    let (sx, cx) = angles.x.sin_cos();
    let cy = angles.y.cos();
    let (sa, ca) = angles.z.sin_cos();
    let d2 = (sx - cy) * (sx + cy);
    if !(sx > 0.0 && d2 > 0.0) {
        return None;
    }
    let d = d2.sqrt();
    Some(Matrix3::from_columns(&[
        Vector3::new(sx * ca, sx * sa, cx),
        Vector3::new((-cx * cy * ca - d * sa) / sx, (-cx * cy * sa + d * ca) / sx, cy),
        Vector3::new((-cx * d * ca + cy * sa) / sx, (-cx * d * sa - cy * ca) / sx, d),
    ]))
}

/// The angles of a rotation world_from_torso, (4.14)-(4.17) by atan2.
pub fn angles(world_from_torso: &Matrix3<f64>) -> TorsoAngles {
    let a = world_from_torso;
    Vector3::new(
        a[(0, 0)].hypot(a[(1, 0)]).atan2(a[(2, 0)]),
        a[(0, 1)].hypot(a[(1, 1)]).atan2(a[(2, 1)]),
        a[(1, 0)].atan2(a[(0, 0)]),
    )
}

/// M of (phi_x', phi_y', alpha') = M omega, omega in the world frame \[rad/s\] (errata 2.3).
pub(crate) fn rates_from_omega(world_from_torso: &Matrix3<f64>) -> Matrix3<f64> {
    let z = Vector3::z();
    let (ex, ey) = (world_from_torso.column(0).into_owned(), world_from_torso.column(1).into_owned());
    let (sx, sy) = (ex.x.hypot(ex.y), ey.x.hypot(ey.y));
    Matrix3::from_rows(&[
        (ex.cross(&z) / -sx).transpose(),
        (ey.cross(&z) / -sy).transpose(),
        (ex.cross(&Vector3::new(-ex.y, ex.x, 0.0)) / (sx * sx)).transpose(),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn vectors_of_the_errata() {
        let a = rotation(&Vector3::new(1.5, 1.6, 0.3)).unwrap();
        let expected = Matrix3::new(
            0.952943358423,
            -0.293415368162,
            -0.076199589003, //
            0.294779924585,
            0.955539015228,
            0.007070108776, //
            0.070737201668,
            -0.029199522301,
            0.997067518375,
        );
        assert!((a - expected).abs().max() < 1e-12);
        let deg = std::f64::consts::PI / 180.0;
        let b = rotation(&Vector3::new(85.0 * deg, 80.0 * deg, -0.7)).unwrap();
        assert!((b[(0, 0)] - 0.76193173185).abs() < 1e-11 && (b[(2, 2)] - 0.98094351871).abs() < 1e-11);
        let m = rates_from_omega(&a).try_inverse().unwrap();
        let expected = Matrix3::new(
            -0.2935411628006,
            -0.9553385389847,
            0.0, //
            0.9559486791313,
            -0.2955208407571,
            0.0, //
            1.469048747233e-4,
            -0.07091499646416,
            1.0,
        );
        assert!((m - expected).abs().max() < 1e-12);
    }

    #[test]
    fn is_a_rotation_and_inverts_over_the_whole_domain() {
        for i in 0..40 {
            for j in 0..40 {
                let x = Vector3::new(
                    0.6 + 0.05 * f64::from(i),
                    0.6 + 0.05 * f64::from(j),
                    0.3 * f64::from(i - 20),
                );
                let Some(a) = rotation(&x) else { continue };
                assert!((a.transpose() * a - Matrix3::identity()).abs().max() < 1e-14);
                let back = angles(&a);
                assert!((back - x).xy().norm() < 1e-12);
                assert!((back.z - x.z).sin().abs() < 1e-12);
            }
        }
    }

    #[test]
    fn lying_down_has_no_rotation() {
        assert!(rotation(&Vector3::new(FRAC_PI_2, 0.0, 0.0)).is_none());
        assert!(rotation(&Vector3::new(f64::NAN, 1.0, 0.0)).is_none());
    }

    #[test]
    fn small_pitch_and_roll_have_the_signs_of_the_table() {
        let pitch = nalgebra::Rotation3::from_axis_angle(&Vector3::y_axis(), 1e-6).into_inner();
        let roll = nalgebra::Rotation3::from_axis_angle(&Vector3::x_axis(), 1e-6).into_inner();
        assert!((angles(&pitch).x - FRAC_PI_2 - 1e-6).abs() < 1e-12);
        assert!((angles(&roll).y - FRAC_PI_2 + 1e-6).abs() < 1e-12);
    }
}
