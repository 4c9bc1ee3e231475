//! Points on the ground that say how a robot is balanced (thesis 3.3, with the corrections of the errata).
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | F, T | force of the ground, and its moment about the world's origin | N, N m | world |
//! | p | zero-moment point, in the plane of contact of height z (3.6) | m | world |
//! | F_a, T_a | sum of m a over the bodies of a foot, and its moment | N, N m | world |
//! | L' | rate of the angular momentum about the centre of gravity c (3.2) | N m | world |
//! | p* | where the zero-moment point must be for the robot to come to rest (3.18) | m | world |
//!
//! (3.6) holds for a reference in the plane of contact only, and (3.2) has the wrong sign in the print; here both are as
//! the errata have them.

use messages::Wrench;
use nalgebra::Vector3;
use recording::polygon::Point;

/// \[N\] Forces below this one have no point to act in.
pub(crate) const LEAST_FORCE: f64 = 1e-6;

/// A force \[N\] and its moment about the world's origin \[N m\], world axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// \[N\]
    pub force: Vector3<f64>,
    /// \[N m\]
    pub moment: Vector3<f64>,
}

impl Load {
    /// A wrench whose moment is about `at` \[m\].
    pub fn of(wrench: &Wrench, at: Vector3<f64>) -> Self {
        let force = Vector3::from(wrench.force);
        Self { force, moment: Vector3::from(wrench.moment) + at.cross(&force) }
    }

    /// Moment about `p` \[m\].
    pub(crate) fn moment_about(&self, p: &Vector3<f64>) -> Vector3<f64> {
        self.moment - p.cross(&self.force) // (3.5)
    }
}

impl std::ops::Add for Load {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, moment: self.moment + other.moment }
    }
}

impl std::ops::Sub for Load {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { force: self.force - other.force, moment: self.moment - other.moment }
    }
}

/// Zero-moment point at height `z`; none if the ground does not push.
pub fn zmp(ground: &Load, z: f64) -> Option<Point> {
    let t = ground.moment_about(&Vector3::new(0.0, 0.0, z));
    let f = ground.force.z;
    (f > LEAST_FORCE).then(|| [-t.y / f, t.x / f]) // (3.6)
}

/// Foot rotation indicator of a foot that alone carries the robot: where the ground would have to push for the foot to stay
/// at rest, everything above it moving as it does. `ground` is what the ground does, `inertia` F_a, T_a of this foot.
///
/// The ankle gives F_c - m g - F_a to the foot; a foot at rest would need the same with F_a = 0, so the ground would
/// have to do F_c - F_a. For a foot at rest it is the zero-moment point; for one that turns about an edge it lies
/// outside of the sole by the moment that turns it over the force.
pub(crate) fn foot_rotation(ground: &Load, inertia: &Load, z: f64) -> Option<Point> {
    zmp(&(*ground - *inertia), z)
}

/// L' (3.2) from the ground and `other` moments about the centre of gravity `com`.
pub(crate) fn momentum_rate(ground: &Load, com: &Vector3<f64>, other: &Vector3<f64>) -> Vector3<f64> {
    ground.moment_about(com) + other
}

/// Where the ground's force would have to act for the horizontal part of L' to vanish.
pub(crate) fn zero_rate(ground: &Load, com: &Vector3<f64>, other: &Vector3<f64>, z: f64) -> Option<Point> {
    let (f, down) = (ground.force, z - com.z);
    (f.z > LEAST_FORCE).then(|| [com.x + (down * f.x + other.y) / f.z, com.y + (down * f.y - other.x) / f.z])
}

/// p* (3.18) of the inverted pendulum of height c_z - z; none if the centre of gravity is not above the plane.
pub fn capture(com: &Vector3<f64>, velocity: &Vector3<f64>, z: f64) -> Option<Point> {
    let height = com.z - z;
    let time = (height / multibody::GRAVITY_ACCELERATION).sqrt();
    (height > 0.0).then(|| [com.x + velocity.x * time, com.y + velocity.y * time])
}

#[cfg(test)]
mod tests {
    use super::*;
    use recording::polygon::margin;

    const G: f64 = multibody::GRAVITY_ACCELERATION;
    const SQUARE: [Point; 4] = [[-0.1, -0.05], [0.2, -0.05], [0.2, 0.05], [-0.1, 0.05]];

    fn push(force: [f64; 3], at: [f64; 3]) -> Load {
        Load::of(&Wrench { force, moment: [0.0; 3] }, Vector3::from(at))
    }

    /// A block of 10 kg at rest, its centre of gravity 3 cm off the middle.
    #[test]
    fn a_block_at_rest_stands_on_the_point_below_its_centre_of_gravity() {
        let ground = push([0.0, 0.0, 10.0 * G], [0.03, 0.01, 0.0]);
        let (com, none) = (Vector3::new(0.03, 0.01, 0.4), Vector3::zeros());
        for p in [
            zmp(&ground, 0.0),
            zero_rate(&ground, &com, &none, 0.0),
            capture(&com, &none, 0.0),
            foot_rotation(&ground, &Load::default(), 0.0),
        ] {
            let p = p.unwrap();
            assert!((p[0] - 0.03).abs() < 1e-15 && (p[1] - 0.01).abs() < 1e-15);
            assert!((margin(&SQUARE, p).unwrap() - 0.04).abs() < 1e-15);
        }
        assert!(momentum_rate(&ground, &com, &none).norm() < 1e-13);
    }

    /// A block of height 2 c pushed at its top until it tips: a push of m g b/(2 c) brings the point to the edge at b,
    /// while it is at rest; from then on the zero-moment point stays there, and what is left over turns the block.
    #[test]
    fn a_tipping_block_has_its_zero_moment_point_on_the_edge() {
        let (m, b, c, d) = (10.0, 0.2, 0.4, 0.05); // edge at x = b
        let inertia = m / 3.0 * (b * b + c * c) + m * (b * b + c * c); // about the edge
        for (factor, outside) in [(1.0, 0.0), (1.5, 0.1)] {
            let f = factor * m * G * b / (2.0 * c);
            let alpha = (f * 2.0 * c - m * G * b).max(0.0) / inertia; // about +y, over the edge
            // Acceleration of the middle, at (-b, c) from the edge, from rest: alpha e_y x r = alpha (c, 0, b).
            let acceleration = Vector3::new(alpha * c, 0.0, alpha * b);
            let force = m * (acceleration + Vector3::new(0.0, 0.0, G)) - Vector3::new(f, 0.0, 0.0);
            let ground = push(force.into(), [b, d, 0.0]);
            let p = zmp(&ground, 0.0).unwrap();
            assert!((p[0] - b).abs() < 1e-12 && (p[1] - d).abs() < 1e-12, "{p:?}");
            // The whole block as the "foot": its indicator is where a block at rest would need the ground, at
            // f 2 c/(m g) from the middle, beyond the edge by I alpha over the force.
            let spin = Vector3::new(0.0, m / 3.0 * (b * b + c * c) * alpha, 0.0);
            let place = Vector3::new(0.0, d, c);
            let moving = Load { force: m * acceleration, moment: spin + place.cross(&(m * acceleration)) };
            let fri = foot_rotation(&ground, &moving, 0.0).unwrap();
            assert!((fri[0] - b - inertia * alpha / (m * G)).abs() < 1e-12, "{fri:?}");
            assert!((fri[0] - f * 2.0 * c / (m * G)).abs() < 1e-12 && (fri[0] - b - outside).abs() < 1e-12);
        }
    }

    /// A rod on a pivot without friction: what the pivot does makes L' = I phi'' with phi'' = m g l sin(phi)/(I + m l^2),
    /// and the force that would not turn it goes through its centre of gravity.
    #[test]
    fn a_pendulum_has_the_momentum_rate_of_its_equation_of_motion() {
        let (m, l, inertia, phi) = (5.0, 0.8, 0.3, 0.2_f64);
        let turn = m * G * l * phi.sin() / (inertia + m * l * l); // from rest, about +y
        let com = l * Vector3::new(phi.sin(), 0.0, phi.cos());
        let acceleration = Vector3::new(turn * com.z, 0.0, -turn * com.x);
        let ground = push((m * (acceleration + Vector3::new(0.0, 0.0, G))).into(), [0.0; 3]);
        let rate = momentum_rate(&ground, &com, &Vector3::zeros());
        assert!((rate.y - inertia * turn).abs() < 1e-12 && rate.x == 0.0, "{rate}");
        let p = zero_rate(&ground, &com, &Vector3::zeros(), 0.0).unwrap();
        let there = push(ground.force.into(), [p[0], p[1], 0.0]);
        assert!(momentum_rate(&there, &com, &Vector3::zeros()).norm() < 1e-12);
        // Another moment, as of a push, asks for another point.
        let other = Vector3::new(2.0, -3.0, 0.0);
        let p = zero_rate(&ground, &com, &other, 0.0).unwrap();
        let there = push(ground.force.into(), [p[0], p[1], 0.0]);
        assert!(momentum_rate(&there, &com, &other).xy().norm() < 1e-12);
    }

    /// Vectors of the errata: (3.6) as printed, with a reference 0.1 m above the ground, misses by 6 and 4 mm.
    #[test]
    fn the_plane_of_contact_counts() {
        let ground = push([6.0, -4.0, 100.0], [0.0, 0.02, 0.0]);
        for (z, expected) in [(0.0, [0.0, 0.02]), (0.1, [0.006, 0.016])] {
            let p = zmp(&ground, z).unwrap();
            assert!((p[0] - expected[0]).abs() < 1e-15 && (p[1] - expected[1]).abs() < 1e-15, "{p:?}");
        }
    }

    /// (3.17): with p held at p*, the pendulum comes to rest there; 1 mm beside it, it does not.
    #[test]
    fn a_pendulum_rests_over_its_capture_point() {
        let (com, speed) = (Vector3::new(0.05, -0.02, 0.9), Vector3::new(0.3, 0.1, 0.0));
        let p = capture(&com, &speed, 0.1).unwrap();
        let a = G / 0.8;
        for k in 0..2 {
            let end = |held: f64| {
                let (x, v, t) = (com[k] - held, speed[k], 3.0);
                let (grow, shrink) = ((a.sqrt() * t).exp(), (-a.sqrt() * t).exp());
                held + 0.5 * (x + v / a.sqrt()) * grow + 0.5 * (x - v / a.sqrt()) * shrink
            };
            assert!((end(p[k]) - p[k]).abs() < 1e-4);
            assert!((end(p[k] + 1e-3) - p[k]).abs() > 1.0);
        }
    }

    /// In the air there is no point, and nothing breaks.
    #[test]
    fn nothing_to_stand_on_is_no_point() {
        assert_eq!(zmp(&Load::default(), 0.0), None);
        assert_eq!(zero_rate(&Load::default(), &Vector3::zeros(), &Vector3::zeros(), 0.0), None);
        assert_eq!(capture(&Vector3::zeros(), &Vector3::zeros(), 0.5), None);
    }
}
