//! Vectors and matrices of three-space, as small as the inner loops need them.
//!
//! The kernels of this crate spend all their time on 3-vectors, 3 x 3 matrices and symmetric 3 x 3 matrices. These
//! three types are plain scalars in a row, every operation is inlined also at low optimisation, and nothing here is
//! known about robots. At the interface of the crate nalgebra's types are used.

use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use nalgebra::{Matrix3, Rotation3, Vector3};

/// A 3-vector.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct V3 {
    pub x: f64,
    pub y: f64,
    pub z: f64,
}

/// Two 3-vectors that undergo the same, component by component beside each other so that both fit one register: the
/// momentum and the moment of momentum of a body, say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Twin {
    pub x: [f64; 2],
    pub y: [f64; 2],
    pub z: [f64; 2],
}

/// A 3 x 3 matrix by its columns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Mat3 {
    pub x: V3,
    pub y: V3,
    pub z: V3,
}

/// A symmetric 3 x 3 matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Sym3 {
    pub xx: f64,
    pub yy: f64,
    pub zz: f64,
    pub xy: f64,
    pub xz: f64,
    pub yz: f64,
}

pub(crate) const ZERO: V3 = v3(0.0, 0.0, 0.0);

#[inline(always)]
pub(crate) const fn v3(x: f64, y: f64, z: f64) -> V3 {
    V3 { x, y, z }
}

impl V3 {
    #[inline(always)]
    pub(crate) fn dot(self, o: V3) -> f64 {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    #[inline(always)]
    pub(crate) fn cross(self, o: V3) -> V3 {
        v3(self.y * o.z - self.z * o.y, self.z * o.x - self.x * o.z, self.x * o.y - self.y * o.x)
    }

    #[inline(always)]
    pub(crate) fn array(self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }

    #[inline(always)]
    pub(crate) fn from_slice(s: &[f64]) -> V3 {
        v3(s[0], s[1], s[2])
    }
}

impl Twin {
    #[inline(always)]
    pub(crate) fn new(a: V3, b: V3) -> Twin {
        Twin { x: [a.x, b.x], y: [a.y, b.y], z: [a.z, b.z] }
    }

    #[inline(always)]
    pub(crate) fn first(&self) -> V3 {
        v3(self.x[0], self.y[0], self.z[0])
    }

    #[inline(always)]
    pub(crate) fn second(&self) -> V3 {
        v3(self.x[1], self.y[1], self.z[1])
    }

    /// Adds to the second.
    #[inline(always)]
    pub(crate) fn add_second(&mut self, v: V3) {
        self.x[1] += v.x;
        self.y[1] += v.y;
        self.z[1] += v.z;
    }
}

impl Add for V3 {
    type Output = V3;
    #[inline(always)]
    fn add(self, o: V3) -> V3 {
        v3(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl Sub for V3 {
    type Output = V3;
    #[inline(always)]
    fn sub(self, o: V3) -> V3 {
        v3(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl Neg for V3 {
    type Output = V3;
    #[inline(always)]
    fn neg(self) -> V3 {
        v3(-self.x, -self.y, -self.z)
    }
}

impl Mul<f64> for V3 {
    type Output = V3;
    #[inline(always)]
    fn mul(self, s: f64) -> V3 {
        v3(self.x * s, self.y * s, self.z * s)
    }
}

impl AddAssign for V3 {
    #[inline(always)]
    fn add_assign(&mut self, o: V3) {
        *self = *self + o;
    }
}

impl SubAssign for V3 {
    #[inline(always)]
    fn sub_assign(&mut self, o: V3) {
        *self = *self - o;
    }
}

impl From<V3> for Vector3<f64> {
    #[inline(always)]
    fn from(v: V3) -> Self {
        Vector3::new(v.x, v.y, v.z)
    }
}

impl From<Vector3<f64>> for V3 {
    #[inline(always)]
    fn from(v: Vector3<f64>) -> Self {
        v3(v.x, v.y, v.z)
    }
}

impl Mat3 {
    pub(crate) const IDENTITY: Mat3 =
        Mat3 { x: v3(1.0, 0.0, 0.0), y: v3(0.0, 1.0, 0.0), z: v3(0.0, 0.0, 1.0) };

    /// Rotation by the angle with this cosine and sine about the unit vector `e` (Rodrigues).
    pub(crate) fn about(e: V3, c: f64, s: f64) -> Mat3 {
        let k = 1.0 - c;
        Mat3 {
            x: v3(c + k * e.x * e.x, k * e.x * e.y + s * e.z, k * e.x * e.z - s * e.y),
            y: v3(k * e.x * e.y - s * e.z, c + k * e.y * e.y, k * e.y * e.z + s * e.x),
            z: v3(k * e.x * e.z + s * e.y, k * e.y * e.z - s * e.x, c + k * e.z * e.z),
        }
    }

    /// Rotation of a unit quaternion (x, y, z, w).
    #[inline(always)]
    pub(crate) fn from_quaternion(q: [f64; 4]) -> Mat3 {
        let [x, y, z, w] = q;
        let (x2, y2, z2) = (x + x, y + y, z + z);
        Mat3 {
            x: v3(1.0 - y * y2 - z * z2, x * y2 + w * z2, x * z2 - w * y2),
            y: v3(x * y2 - w * z2, 1.0 - x * x2 - z * z2, y * z2 + w * x2),
            z: v3(x * z2 + w * y2, y * z2 - w * x2, 1.0 - x * x2 - y * y2),
        }
    }

    #[inline(always)]
    pub(crate) fn transpose(self) -> Mat3 {
        Mat3 {
            x: v3(self.x.x, self.y.x, self.z.x),
            y: v3(self.x.y, self.y.y, self.z.y),
            z: v3(self.x.z, self.y.z, self.z.z),
        }
    }

    /// Transposed matrix times vector.
    #[inline(always)]
    pub(crate) fn t_mul(self, v: V3) -> V3 {
        v3(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }

    /// R S R^T
    #[inline(always)]
    pub(crate) fn congruent(self, s: Sym3) -> Sym3 {
        let t = self.transpose();
        let (a, b, c) = (s * t.x, s * t.y, s * t.z);
        Sym3 {
            xx: t.x.dot(a),
            yy: t.y.dot(b),
            zz: t.z.dot(c),
            xy: t.x.dot(b),
            xz: t.x.dot(c),
            yz: t.y.dot(c),
        }
    }
}

impl Mul<V3> for Mat3 {
    type Output = V3;
    #[inline(always)]
    fn mul(self, v: V3) -> V3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

impl Mul for Mat3 {
    type Output = Mat3;
    #[inline(always)]
    fn mul(self, o: Mat3) -> Mat3 {
        Mat3 { x: self * o.x, y: self * o.y, z: self * o.z }
    }
}

impl From<Mat3> for Rotation3<f64> {
    fn from(m: Mat3) -> Self {
        Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[m.x.into(), m.y.into(), m.z.into()]))
    }
}

impl From<Rotation3<f64>> for Mat3 {
    fn from(r: Rotation3<f64>) -> Self {
        let m = r.matrix();
        Mat3 {
            x: m.column(0).into_owned().into(),
            y: m.column(1).into_owned().into(),
            z: m.column(2).into_owned().into(),
        }
    }
}

impl Sym3 {
    pub(crate) fn from_matrix(m: &Matrix3<f64>) -> Sym3 {
        Sym3 { xx: m[(0, 0)], yy: m[(1, 1)], zz: m[(2, 2)], xy: m[(0, 1)], xz: m[(0, 2)], yz: m[(1, 2)] }
    }

    pub(crate) fn matrix(self) -> Matrix3<f64> {
        Matrix3::new(self.xx, self.xy, self.xz, self.xy, self.yy, self.yz, self.xz, self.yz, self.zz)
    }
}

impl Add for Sym3 {
    type Output = Sym3;
    #[inline(always)]
    fn add(self, o: Sym3) -> Sym3 {
        Sym3 {
            xx: self.xx + o.xx,
            yy: self.yy + o.yy,
            zz: self.zz + o.zz,
            xy: self.xy + o.xy,
            xz: self.xz + o.xz,
            yz: self.yz + o.yz,
        }
    }
}

impl AddAssign for Sym3 {
    #[inline(always)]
    fn add_assign(&mut self, o: Sym3) {
        *self = *self + o;
    }
}

impl Mul<f64> for Sym3 {
    type Output = Sym3;
    #[inline(always)]
    fn mul(self, s: f64) -> Sym3 {
        Sym3 {
            xx: self.xx * s,
            yy: self.yy * s,
            zz: self.zz * s,
            xy: self.xy * s,
            xz: self.xz * s,
            yz: self.yz * s,
        }
    }
}

impl Mul<V3> for Sym3 {
    type Output = V3;
    #[inline(always)]
    fn mul(self, v: V3) -> V3 {
        v3(
            self.xx * v.x + self.xy * v.y + self.xz * v.z,
            self.xy * v.x + self.yy * v.y + self.yz * v.z,
            self.xz * v.x + self.yz * v.y + self.zz * v.z,
        )
    }
}
