//! Archie's legs (thesis of 2013, tables 3.1 and 3.2) in cm, the thesis's unit, and random poses of them.
#![allow(dead_code, reason = "every test file uses its own part")]

use std::f64::consts::{FRAC_PI_2, PI};

use multibody::{ClosedFormLeg, DhRow};
use nalgebra::{Matrix3, Vector3};

pub(crate) const A1: f64 = 8.0;
pub(crate) const A2: f64 = 26.0;
pub(crate) const A3: f64 = 30.0;
pub(crate) const A6: f64 = 5.6;
pub(crate) const D3: f64 = 7.4;
pub(crate) const D6: f64 = 4.0;

/// Frame {6} in frame {0} of the robot standing upright.
pub(crate) const STANDING: Matrix3<f64> = Matrix3::new(0.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, -1.0, 0.0);

/// Tables 3.1 (side +1) and 3.2 (side -1).
pub(crate) fn rows(side: f64) -> [DhRow; 6] {
    let row = |a, alpha: f64, d, theta| DhRow { a, alpha, d, theta };
    [
        row(A1, side * FRAC_PI_2, 0.0, 0.0),
        row(A2, 0.0, 0.0, 0.0),
        row(A3, 0.0, -D3, 0.0),
        row(0.0, -side * FRAC_PI_2, 0.0, 0.0),
        row(0.0, -FRAC_PI_2, 0.0, FRAC_PI_2),
        row(side * A6, 0.0, D6, 0.0),
    ]
}

pub(crate) fn leg(side: f64) -> ClosedFormLeg {
    ClosedFormLeg::new(&rows(side)).expect("the rows of the thesis")
}

/// The posture of the other leg that is its mirror image (errata 3, 2.1).
pub(crate) fn mirrored([a, b, c, d, e, f]: [f64; 6]) -> [f64; 6] {
    [-a, -b, -c, -d, PI - e, -f]
}

/// Height of the hip over axis 1 and over axis 2 in the plane of the leg, from the angles.
pub(crate) fn heights(q: &[f64; 6]) -> (f64, f64) {
    let w = A2 * q[1].cos() + A3 * (q[1] + q[2]).cos();
    (A1 + w, w)
}

/// Angles between -1 and 1 turned into those of a leg: thesis's ranges where it has any, wide ones elsewhere: theta_1 60,
/// theta_2 60, knee 0 to 90, theta_4 and theta_6 90, theta_5 10 to 170 deg.
pub(crate) fn posture(side: f64, unit: [f64; 6]) -> [f64; 6] {
    let [a, b, c, d, e, f] = unit;
    let q = [60.0 * a, 60.0 * b, -side * 45.0 * (c + 1.0), 90.0 * d, 90.0 + 80.0 * e, 90.0 * f];
    q.map(f64::to_radians)
}

/// Largest difference of two sets of angles, whole turns apart or not \[rad\]; NaN stays NaN.
pub(crate) fn apart(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    let one = |(x, y): (&f64, &f64)| {
        let d = x - y;
        (d - 2.0 * PI * (d / (2.0 * PI)).round()).abs()
    };
    a.iter().zip(b).map(one).fold(0.0, |m, d| if d.is_nan() || m.is_nan() { f64::NAN } else { m.max(d) })
}

/// Largest differences of two poses: rotation, position.
pub(crate) fn off(a: &(Matrix3<f64>, Vector3<f64>), b: &(Matrix3<f64>, Vector3<f64>)) -> (f64, f64) {
    ((a.0 - b.0).amax(), (a.1 - b.1).amax())
}

/// A reproducible stream of numbers (splitmix64).
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    /// Uniform in -1 .. 1.
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn units(&mut self) -> [f64; 6] {
        std::array::from_fn(|_| self.unit())
    }
}
