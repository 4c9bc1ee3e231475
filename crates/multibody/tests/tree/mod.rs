//! Random trees and states for the tests: every kind of joint, oblique axes and placements, links joined rigidly.
#![allow(dead_code, reason = "every test file uses its own part")]

use multibody::{Inertia, JointKind, Model, ModelBuilder};
use nalgebra::{IsometryMatrix3, Matrix3, Rotation3, Vector3};

/// A reproducible stream of numbers (splitmix64).
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    /// Uniform in -1 .. 1.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    pub(crate) fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::new(self.unit(), self.unit(), self.unit()) * size
    }

    pub(crate) fn list(&mut self, n: usize, size: f64) -> Vec<f64> {
        (0..n).map(|_| self.unit() * size).collect()
    }

    pub(crate) fn rotation(&mut self) -> Rotation3<f64> {
        Rotation3::new(self.vector(2.0))
    }

    fn inertia(&mut self) -> Inertia {
        let (mass, r) = (1.5 + self.unit(), self.rotation());
        let sides = (self.vector(0.1) + Vector3::repeat(0.15)).map(|a| a * a);
        let moments = Vector3::new(sides.y + sides.z, sides.x + sides.z, sides.x + sides.y) * (mass / 12.0);
        let moments = r * Matrix3::from_diagonal(&moments) * r.inverse();
        Inertia { mass, center: self.vector(0.2), moments }
    }

    fn kind(&mut self) -> JointKind {
        let mut along = Vector3::zeros();
        along[self.below(3)] = self.unit().signum();
        match self.below(8) {
            0 => JointKind::Fixed,
            1 => JointKind::Prismatic(self.vector(1.0) + Vector3::z() * 0.1),
            2 => JointKind::Prismatic(along),
            3 => JointKind::Revolute(self.vector(1.0) + Vector3::z() * 0.1),
            _ => JointKind::Revolute(along),
        }
    }
}

/// A tree of `links` links behind its base.
pub(crate) fn random(dice: &mut Dice, links: usize) -> Model {
    builder(dice, links).build().expect("valid tree")
}

/// The tree of [`random`], to be continued.
pub(crate) fn builder(dice: &mut Dice, links: usize) -> ModelBuilder {
    let name = |k: usize| format!("link {k}");
    let mut builder = ModelBuilder::new(&name(0), dice.inertia());
    for k in 1..=links {
        let parent = dice.below(k);
        let rotation = if dice.below(2) == 0 { Rotation3::identity() } else { dice.rotation() };
        let placement = IsometryMatrix3::from_parts(dice.vector(0.4).into(), rotation);
        let (kind, inertia) = (dice.kind(), dice.inertia());
        builder
            .joint(&format!("joint {k}"), &name(parent), &name(k), &placement, kind, &inertia)
            .expect("valid joint");
    }
    builder
}

/// Any configuration: base anywhere in any attitude, joints within half a turn.
pub(crate) fn configuration(dice: &mut Dice, model: &Model) -> Vec<f64> {
    let mut q = dice.list(model.nq(), 3.0);
    let attitude = nalgebra::UnitQuaternion::from_rotation_matrix(&dice.rotation());
    q[3..7].copy_from_slice(attitude.coords.as_slice());
    q
}

/// Largest difference, over the largest entry of `b` (at least 1).
pub(crate) fn error(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let scale = b.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    a.iter()
        .zip(b)
        .map(|(x, y)| if x == y { 0.0 } else { (x - y).abs() / scale })
        .fold(0.0, |m, e| if e.is_nan() { f64::NAN } else { f64::max(m, e) })
}
