//! Turn of one joint: the rotation from child to parent and the joint's axis.
//!
//! Body frames are laid so that all of them are parallel to the base when every coordinate is zero. Then nearly all
//! joints of a walking robot turn about x, y or z, and a change of frame is one plane rotation: 4 products in place of
//! 9. The kernels are written once over [`Turn`] and compiled for each kind of joint.

use crate::space::{Mat3, Sym3, Twin, V3, v3};

/// A joint in its present position: rotation `R` = parent_from_child, axis `e` (the same in both frames).
pub(crate) trait Turn: Copy {
    /// True for a joint that slides along `e`; then R = E.
    const SLIDES: bool = false;
    /// R v
    fn up(self, v: V3) -> V3;
    /// R v of both
    fn up_twin(self, t: Twin) -> Twin;
    /// R^T v
    fn down(self, v: V3) -> V3;
    /// R S R^T
    fn up_sym(self, s: Sym3) -> Sym3;
    /// R H R^T
    fn up_mat(self, h: Mat3) -> Mat3;
    /// A R
    fn chain(self, a: Mat3) -> Mat3;
    /// e . v
    fn part(self, v: V3) -> f64;
    /// v + e s
    fn plus(self, v: V3, s: f64) -> V3;
    /// v x e s
    fn across(self, v: V3, s: f64) -> V3;
    /// S e
    fn column(self, s: Sym3) -> V3;
    /// A e
    fn column_of(self, a: &Mat3) -> V3;
    /// A^T e
    fn row_of(self, a: &Mat3) -> V3;
}

/// Revolute about x.
#[derive(Clone, Copy)]
pub(crate) struct AboutX(pub f64, pub f64);
/// Revolute about y.
#[derive(Clone, Copy)]
pub(crate) struct AboutY(pub f64, pub f64);
/// Revolute about z.
#[derive(Clone, Copy)]
pub(crate) struct AboutZ(pub f64, pub f64);
/// Revolute about any unit vector.
#[derive(Clone, Copy)]
pub(crate) struct About<'a>(pub &'a Mat3, pub V3);
/// Prismatic along any unit vector.
#[derive(Clone, Copy)]
pub(crate) struct Along(pub V3);

/// Plane rotation: cosine and sine of a sum when the point (a, b) is turned by (c, s).
#[inline(always)]
fn turned(a: f64, b: f64, c: f64, s: f64) -> (f64, f64) {
    (c * a - s * b, s * a + c * b)
}

/// The 2 x 2 symmetric block [[a, m], [m, b]] under the plane rotation (c, s).
#[inline(always)]
fn turned_block(a: f64, b: f64, m: f64, c: f64, s: f64) -> (f64, f64, f64) {
    let (cc, ss, cs) = (c * c, s * s, c * s);
    let d = 2.0 * cs * m;
    (cc * a + ss * b - d, ss * a + cc * b + d, cs * (a - b) + (cc - ss) * m)
}

macro_rules! plane_turn {
    ($kind:ident, $k:ident, $i:ident, $j:ident, $kk:ident, $ii:ident, $jj:ident, $ij:ident, $ki:ident, $kj:ident) => {
        impl Turn for $kind {
            #[inline(always)]
            fn up(self, v: V3) -> V3 {
                let ($i, $j) = turned(v.$i, v.$j, self.0, self.1);
                V3 { $i, $j, ..v }
            }
            #[inline(always)]
            fn up_twin(self, t: Twin) -> Twin {
                let (a, b, c, s) = (t.$i, t.$j, self.0, self.1);
                let $i = [c * a[0] - s * b[0], c * a[1] - s * b[1]];
                let $j = [s * a[0] + c * b[0], s * a[1] + c * b[1]];
                Twin { $i, $j, ..t }
            }
            #[inline(always)]
            fn down(self, v: V3) -> V3 {
                let ($i, $j) = turned(v.$i, v.$j, self.0, -self.1);
                V3 { $i, $j, ..v }
            }
            #[inline(always)]
            fn up_sym(self, m: Sym3) -> Sym3 {
                let ($ii, $jj, $ij) = turned_block(m.$ii, m.$jj, m.$ij, self.0, self.1);
                let ($ki, $kj) = turned(m.$ki, m.$kj, self.0, self.1);
                Sym3 { $ii, $jj, $ij, $ki, $kj, ..m }
            }
            #[inline(always)]
            fn up_mat(self, h: Mat3) -> Mat3 {
                let (hi, hj) = (self.up(h.$i), self.up(h.$j));
                Mat3 { $i: hi * self.0 - hj * self.1, $j: hi * self.1 + hj * self.0, $k: self.up(h.$k) }
            }
            #[inline(always)]
            fn chain(self, a: Mat3) -> Mat3 {
                Mat3 { $i: a.$i * self.0 + a.$j * self.1, $j: a.$j * self.0 - a.$i * self.1, $k: a.$k }
            }
            #[inline(always)]
            fn part(self, v: V3) -> f64 {
                v.$k
            }
            #[inline(always)]
            fn plus(self, v: V3, s: f64) -> V3 {
                V3 { $k: v.$k + s, ..v }
            }
            #[inline(always)]
            fn across(self, v: V3, s: f64) -> V3 {
                // e_i, e_j, e_k right-handed: v x e_k = (v_j, -v_i, 0)
                let mut o = v3(0.0, 0.0, 0.0);
                o.$i = v.$j * s;
                o.$j = -v.$i * s;
                o
            }
            #[inline(always)]
            fn column(self, m: Sym3) -> V3 {
                let mut o = v3(0.0, 0.0, 0.0);
                o.$k = m.$kk;
                o.$i = m.$ki;
                o.$j = m.$kj;
                o
            }
            #[inline(always)]
            fn column_of(self, a: &Mat3) -> V3 {
                a.$k
            }
            #[inline(always)]
            fn row_of(self, a: &Mat3) -> V3 {
                v3(a.x.$k, a.y.$k, a.z.$k)
            }
        }
    };
}

plane_turn!(AboutX, x, y, z, xx, yy, zz, yz, xy, xz);
plane_turn!(AboutY, y, z, x, yy, zz, xx, xz, yz, xy);
plane_turn!(AboutZ, z, x, y, zz, xx, yy, xy, xz, yz);

impl Turn for About<'_> {
    #[inline(always)]
    fn up(self, v: V3) -> V3 {
        *self.0 * v
    }
    #[inline(always)]
    fn up_twin(self, t: Twin) -> Twin {
        Twin::new(*self.0 * t.first(), *self.0 * t.second())
    }
    #[inline(always)]
    fn down(self, v: V3) -> V3 {
        self.0.t_mul(v)
    }
    #[inline(always)]
    fn up_sym(self, s: Sym3) -> Sym3 {
        self.0.congruent(s)
    }
    #[inline(always)]
    fn up_mat(self, h: Mat3) -> Mat3 {
        *self.0 * h * self.0.transpose()
    }
    #[inline(always)]
    fn chain(self, a: Mat3) -> Mat3 {
        a * *self.0
    }
    #[inline(always)]
    fn part(self, v: V3) -> f64 {
        self.1.dot(v)
    }
    #[inline(always)]
    fn plus(self, v: V3, s: f64) -> V3 {
        v + self.1 * s
    }
    #[inline(always)]
    fn across(self, v: V3, s: f64) -> V3 {
        v.cross(self.1) * s
    }
    #[inline(always)]
    fn column(self, s: Sym3) -> V3 {
        s * self.1
    }
    #[inline(always)]
    fn column_of(self, a: &Mat3) -> V3 {
        *a * self.1
    }
    #[inline(always)]
    fn row_of(self, a: &Mat3) -> V3 {
        a.t_mul(self.1)
    }
}

impl Turn for Along {
    const SLIDES: bool = true;
    #[inline(always)]
    fn up(self, v: V3) -> V3 {
        v
    }
    #[inline(always)]
    fn up_twin(self, t: Twin) -> Twin {
        t
    }
    #[inline(always)]
    fn down(self, v: V3) -> V3 {
        v
    }
    #[inline(always)]
    fn up_sym(self, s: Sym3) -> Sym3 {
        s
    }
    #[inline(always)]
    fn up_mat(self, h: Mat3) -> Mat3 {
        h
    }
    #[inline(always)]
    fn chain(self, a: Mat3) -> Mat3 {
        a
    }
    #[inline(always)]
    fn part(self, v: V3) -> f64 {
        self.0.dot(v)
    }
    #[inline(always)]
    fn plus(self, v: V3, s: f64) -> V3 {
        v + self.0 * s
    }
    #[inline(always)]
    fn across(self, v: V3, s: f64) -> V3 {
        v.cross(self.0) * s
    }
    #[inline(always)]
    fn column(self, s: Sym3) -> V3 {
        s * self.0
    }
    #[inline(always)]
    fn column_of(self, a: &Mat3) -> V3 {
        *a * self.0
    }
    #[inline(always)]
    fn row_of(self, a: &Mat3) -> V3 {
        a.t_mul(self.0)
    }
}
