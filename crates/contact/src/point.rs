//! Decoupled viscoelastic contact points with Coulomb friction, solved exactly by case distinction.
//!
//! A point is a massless node on a spring and a damper: `B d' + K d = f` (2.37, corrected sign of f: the force of the
//! ground on the node, handed on to the foot). Stiffness and damping are taken in the contact frame (tangential,
//! tangential, normal), so normal and tangential directions do not mix and the law has a closed solution
//! (errata 1, F7): open, sticking or sliding.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | d | displacement of the node from its place on the undeformed sole | m | contact |
//! | w | velocity of that place relative to the ground | m/s | contact |
//! | g_N | height of the node above the ground | m | contact |
//! | lambda | force of the ground on the node | N | contact |

use crate::law::TOUCHING;

/// Stiffness, damping and friction of a contact point.
#[derive(Clone, Copy, Debug)]
pub struct ContactLaw {
    /// \[N/m\] K: tangential, tangential, normal.
    pub stiffness: [f64; 3],
    /// \[N s/m\] B: tangential, tangential, normal; the tangential ones are equal.
    pub damping: [f64; 3],
    /// \[1\] mu
    pub friction: f64,
    /// \[1/s\] Rate at which penetration left over from a finite step is taken back (errata 1, drift stabilization).
    pub recovery: f64,
}

/// State of a contact point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointState {
    /// No contact.
    Open,
    /// The node rests on the ground.
    Stick,
    /// The node slides.
    Slip,
}

/// Force on the node and rate of its displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointAnswer {
    /// \[N\] lambda
    pub force: [f64; 3],
    /// \[m/s\] d'
    pub rate: [f64; 3],
    /// Which case it was.
    pub state: PointState,
}

/// Solves the contact law for one node: lambda and d' from d, w and g_N.
pub fn solve(law: &ContactLaw, d: [f64; 3], w: [f64; 3], gap: f64) -> PointAnswer {
    let (k, b, mu) = (law.stiffness, law.damping, law.friction);
    let rate = |lambda: [f64; 3]| std::array::from_fn(|i| (lambda[i] - k[i] * d[i]) / b[i]); // (2.37)
    let open = PointAnswer { force: [0.0; 3], rate: rate([0.0; 3]), state: PointState::Open };
    if gap >= TOUCHING {
        return open;
    }
    // The force that stops the node: lambda* = K d - B w, the normal one also taking back the penetration.
    let w_n = w[2] + law.recovery * gap;
    let normal = k[2] * d[2] - b[2] * w_n;
    if normal <= 0.0 {
        return open;
    }
    let t = [k[0] * d[0] - b[0] * w[0], k[1] * d[1] - b[1] * w[1]];
    let size = (t[0] * t[0] + t[1] * t[1]).sqrt();
    if size <= mu * normal {
        let force = [t[0], t[1], normal];
        return PointAnswer { force, rate: rate(force), state: PointState::Stick };
    }
    let s = mu * normal / size;
    let force = [s * t[0], s * t[1], normal];
    PointAnswer { force, rate: rate(force), state: PointState::Slip }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Vector V5 of errata 1: b = 250, mu = 0.6; K d given directly (d = K d / k with k = 1000).
    #[test]
    fn isotropic_node_of_the_errata() {
        let law = ContactLaw { stiffness: [1000.0; 3], damping: [250.0; 3], friction: 0.6, recovery: 0.0 };
        let case = |w: [f64; 3], kd: [f64; 3]| solve(&law, kd.map(|x| x / 1000.0), w, -1e-9);
        let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(&b).all(|(x, y)| (x - y).abs() < 1e-9);

        let a = case([0.05, -0.02, -0.3], [5.0, 3.0, 40.0]);
        assert!(a.state == PointState::Stick && close(a.force, [-7.5, 8.0, 115.0]));
        let a = case([0.3, -0.2, -0.3], [5.0, 3.0, 40.0]);
        assert!(a.state == PointState::Slip && close(a.force, [-55.010818639, 41.6510483981, 115.0]));
        let velocity: [f64; 3] = std::array::from_fn(|i| [0.3, -0.2, -0.3][i] + a.rate[i]);
        assert!(close(velocity, [0.0599567254439, -0.0453958064075, 0.0]));
        let a = case([0.05, -0.02, 0.3], [5.0, 3.0, 40.0]);
        assert!(a.state == PointState::Open && close(a.force, [0.0; 3]));
        let a = case([0.0, 0.0, 0.1], [2.0, -1.0, 60.0]);
        assert!(a.state == PointState::Stick && close(a.force, [2.0, -1.0, 35.0]));
    }

    proptest! {
        /// Signorini and Coulomb, with the direction law, in every case (errata 1, F7).
        #[test]
        fn the_contact_law_holds(
            d in prop::array::uniform3(-0.01..0.01f64), w in prop::array::uniform3(-1.0..1.0f64),
            gap in -0.01..0.01f64, mu in 0.0..2.0f64, ratio in 0.1..2.0f64,
        ) {
            let law = ContactLaw { stiffness: [ratio * 6e4, ratio * 6e4, 6e4], damping: [ratio * 500.0, ratio * 500.0, 500.0],
                            friction: mu, recovery: 0.0 };
            let a = solve(&law, d, w, gap);
            let u: [f64; 3] = std::array::from_fn(|i| w[i] + a.rate[i]); // velocity of the node
            for i in 0..3 {
                let balance = law.damping[i] * a.rate[i] + law.stiffness[i] * d[i] - a.force[i];
                prop_assert!(balance.abs() < 1e-9); // (2.37)
            }
            let (normal, tangent) = (a.force[2], a.force[0].hypot(a.force[1]));
            if gap >= TOUCHING {
                prop_assert_eq!(a.force, [0.0; 3]);
            } else {
                prop_assert!(normal >= 0.0 && u[2] >= -1e-9 && (normal * u[2]).abs() < 1e-6);
                prop_assert!(tangent <= mu * normal * (1.0 + 1e-12) + 1e-9);
                let slip = u[0].hypot(u[1]);
                for i in 0..2 {
                    prop_assert!((slip * a.force[i] + mu * normal * u[i]).abs() < 1e-6);
                }
            }
        }
    }

    /// A point mass on one node settles where statics says and is carried by its weight.
    #[test]
    fn a_mass_settles_at_its_static_deflection() {
        let law = ContactLaw { stiffness: [2e4; 3], damping: [200.0; 3], friction: 0.6, recovery: 200.0 };
        let (m, h) = (10.0, 1e-4);
        let (mut z, mut v, mut d, mut force) = (0.001, 0.0, [0.0; 3], 0.0);
        for _ in 0..200_000 {
            let a = solve(&law, d, [0.0, 0.0, v], z + d[2]);
            force = a.force[2];
            z += h * v;
            v += h * (force / m - 9.81);
            for i in 0..3 {
                d[i] += h * a.rate[i];
            }
        }
        assert!((force - m * 9.81).abs() < 1e-6, "carries {force} N");
        assert!((d[2] - m * 9.81 / 2e4).abs() < 1e-9 && (z + d[2]).abs() < 1e-9, "d = {}, z = {z}", d[2]);
    }
}
