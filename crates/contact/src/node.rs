//! One node on the ground with any damping: open, sticking or sliding by case distinction (errata 1, F7).
//!
//! The velocity of the node is affine in the force on it, u = G lambda + c. The law asks for
//!
//! ```text
//! lambda_N >= 0,  u_N >= 0,  lambda_N u_N = 0                      (2.41)
//! |lambda_T| <= mu lambda_N,  |u_T| lambda_T = -mu lambda_N u_T    (2.42), corrected, with the direction
//! ```
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | G | velocity per force, symmetric positive definite: 3 x 3 block of B^-1 | m/(N s) | contact (t1, t2, n) |
//! | c | velocity of the free node relative to the ground | m/s | contact |
//! | lambda | force of the ground on the node | N | contact |
//! | u | velocity of the node relative to the ground | m/s | contact |
//! | t | direction of sliding, length 1 | 1 | tangents |

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

use crate::point::PointState;

/// Force on the node and what the node does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeAnswer {
    /// \[N\] lambda
    pub force: Vector3<f64>,
    /// Which case it is.
    pub state: PointState,
}

/// True if the law has exactly one solution for every c: G_NN > mu |G_NT| (errata 1, F7).
pub fn unique(g: &Matrix3<f64>, mu: f64) -> bool {
    g[(2, 2)] > mu * g[(0, 2)].hypot(g[(1, 2)])
}

/// Solves the law for one node. Where it has several solutions ([`unique`] is false), the first that holds of open,
/// stick, slip is the answer; `None` when the data hold no solution (G not positive definite, or not finite).
pub fn solve(g: &Matrix3<f64>, c: &Vector3<f64>, mu: f64) -> Option<NodeAnswer> {
    if c.z >= 0.0 {
        return Some(NodeAnswer { force: Vector3::zeros(), state: PointState::Open });
    }
    let force = -(g.cholesky()?.solve(c));
    if force.z > 0.0 && force.xy().norm() <= mu * force.z {
        return Some(NodeAnswer { force, state: PointState::Stick });
    }
    let hint = -force.xy().try_normalize(f64::MIN_POSITIVE).unwrap_or(Vector2::x());
    slide(g, c, mu, hint).map(|force| NodeAnswer { force, state: PointState::Slip })
}

/// Force on a node that slides under pressure (c_N < 0); `hint` is a direction to begin with, of length 1.
pub(crate) fn slide(g: &Matrix3<f64>, c: &Vector3<f64>, mu: f64, hint: Vector2<f64>) -> Option<Vector3<f64>> {
    let slip = Slip { h: g.fixed_view::<2, 2>(0, 0).into(), g: g.column(2).xy(), g_nn: g[(2, 2)], c, mu };
    slip.newton(hint).or_else(|| slip.search())
}

/// The sliding node: lambda = N (-mu t, 1) with u_N = 0 and u_T along t.
struct Slip<'a> {
    h: Matrix2<f64>,
    g: Vector2<f64>,
    g_nn: f64,
    c: &'a Vector3<f64>,
    mu: f64,
}

/// Sectors of the search for the sliding direction; a polynomial of degree 4 has at most 4 roots in the circle.
const SECTORS: usize = 48;
/// Steps of Newton's method before the search takes over.
const NEWTON: usize = 12;

impl Slip<'_> {
    /// (G_NN - mu g.t) (t x u_T), which has no poles in t, and its derivative when t turns.
    fn cross(&self, t: &Vector2<f64>) -> (f64, f64) {
        let s = Vector2::new(-t.y, t.x);
        let (a, b) = (self.g_nn - self.mu * self.g.dot(t), -self.c.z);
        let (c, ht, hs) = (self.c.xy(), self.h * t, self.h * s);
        let value = a * t.perp(&c) + b * (t.perp(&self.g) - self.mu * t.perp(&ht));
        let slope = a * s.perp(&c) - self.mu * self.g.dot(&s) * t.perp(&c)
            + b * (s.perp(&self.g) - self.mu * (s.perp(&ht) + t.perp(&hs)));
        (value, slope)
    }

    /// The force, if the node slides along t (and not against it) under pressure.
    fn force(&self, t: &Vector2<f64>) -> Option<Vector3<f64>> {
        let a = self.g_nn - self.mu * self.g.dot(t);
        let n = -self.c.z / a;
        let u = self.c.xy() + n * (self.g - self.mu * (self.h * t));
        let force = Vector3::new(-self.mu * n * t.x, -self.mu * n * t.y, n);
        (a > 0.0 && n.is_finite() && u.dot(t) >= 0.0).then_some(force)
    }

    fn newton(&self, mut t: Vector2<f64>) -> Option<Vector3<f64>> {
        for _ in 0..NEWTON {
            let (value, slope) = self.cross(&t);
            let turn = (-value / slope).clamp(-0.5, 0.5);
            let next = (t + turn * Vector2::new(-t.y, t.x)).normalize();
            if !next.x.is_finite() {
                return None;
            }
            t = next;
            // Steps converge quadratically: after one of 1e-7 what is left is rounding.
            if turn.abs() < 1e-7 {
                return self.force(&t);
            }
        }
        None
    }

    /// Brackets every root and bisects it; the first one that is a sliding node counts.
    fn search(&self) -> Option<Vector3<f64>> {
        let at = |angle: f64| Vector2::new(angle.cos(), angle.sin());
        let step = std::f64::consts::TAU / SECTORS as f64;
        for k in 0..SECTORS {
            let (mut lo, mut hi) = (step * k as f64, step * (k + 1) as f64);
            let start = self.cross(&at(lo)).0;
            if start.signum() == self.cross(&at(hi)).0.signum() {
                continue;
            }
            for _ in 0..60 {
                let middle = 0.5 * (lo + hi);
                let same = self.cross(&at(middle)).0.signum() == start.signum();
                *(if same { &mut lo } else { &mut hi }) = middle;
            }
            let found = self.force(&at(0.5 * (lo + hi)));
            if found.is_some() {
                return found;
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Rotation3, Unit};
    use proptest::prelude::*;

    /// Vector V6 of errata 1: B = diag(150, 200, 600), tilted plane.
    #[test]
    fn general_node_of_the_errata() {
        let axis = Unit::new_normalize(Vector3::new(1.0, 2.0, 0.0));
        let e = Rotation3::from_axis_angle(&axis, 0.3).into_inner();
        let inverse = Matrix3::from_diagonal(&Vector3::new(1.0 / 150.0, 1.0 / 200.0, 1.0 / 600.0));
        let case = |w: [f64; 3], kd: [f64; 3]| {
            let g = e.transpose() * inverse * e;
            let c = e.transpose() * (Vector3::from(w) - inverse * Vector3::from(kd));
            let answer = solve(&g, &c, 0.5).unwrap();
            (answer.state, answer.force, e * answer.force)
        };
        let (state, lambda, f) = case([0.02, -0.03, -0.1], [4.0, 3.0, 50.0]);
        assert_eq!(state, PointState::Stick);
        assert!((lambda - Vector3::new(-27.9502860856, 23.4751430428, 104.161889225)).norm() < 1e-9);
        assert!((f - Vector3::new(1.0, 9.0, 110.0)).norm() < 1e-10);
        let (state, lambda, f) = case([0.3, -0.2, -0.2], [4.0, 3.0, 50.0]);
        assert_eq!(state, PointState::Slip);
        assert!((lambda - Vector3::new(-48.1254904737, 34.2849789179, 118.17821479)).norm() < 1e-8);
        assert!((f - Vector3::new(-14.5563924194, 17.5004298908, 130.151678656)).norm() < 1e-8);
        assert_eq!(case([0.0, 0.1, 0.3], [4.0, 3.0, 50.0]).0, PointState::Open);
    }

    proptest! {
        /// The law in every case, for any symmetric positive definite G.
        #[test]
        fn the_law_holds_for_every_node(
            a in prop::array::uniform9(-1.0..1.0f64), c in prop::array::uniform3(-1.0..1.0f64), mu in 0.0..2.0f64,
        ) {
            let a = Matrix3::from_row_slice(&a);
            let g = a * a.transpose() + 0.05 * Matrix3::identity();
            let c = Vector3::from(c);
            let answer = solve(&g, &c, mu);
            prop_assert!(answer.is_some() || !unique(&g, mu));
            if let Some(NodeAnswer { force, .. }) = answer {
                let u = g * force + c;
                let (n, t) = (force.z, force.xy());
                let size = 1.0 + n.abs();
                prop_assert!(n >= 0.0 && u.z >= -1e-9 * size && (n * u.z).abs() < 1e-8 * size * size);
                prop_assert!(t.norm() <= mu * n * (1.0 + 1e-9) + 1e-9);
                let direction = u.xy().norm() * t + mu * n * u.xy();
                prop_assert!(direction.norm() < 1e-7 * size * size, "{direction} {force} {u}");
            }
        }

        /// What is not a number goes in, nothing comes out.
        #[test]
        fn nothing_comes_of_bad_data(k in 0..3usize) {
            let mut c = Vector3::new(0.1, 0.2, -0.3);
            c[k] = f64::NAN;
            let answer = solve(&Matrix3::identity(), &c, 0.5);
            prop_assert!(answer.is_none_or(|a| a.force.iter().all(|x| x.is_finite())));
        }
    }
}
