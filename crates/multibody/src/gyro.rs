//! Kernels of one rotor: what its turning adds to the body that carries it. Symbols: [`crate::rotor`].

use crate::space::{Sym3, Twin, V3};

/// Most joints one rotor can be geared to.
pub(crate) const MOST_JOINTS: usize = 3;

/// A rotor as the kernels want it.
#[derive(Clone, Debug)]
pub(crate) struct Gyro {
    /// Place in the caller's list.
    pub index: usize,
    pub body: usize,
    pub j: f64,
    pub e: V3,
    /// Bodies moved by the joints it is geared to; none if it is free.
    pub geared: Vec<usize>,
    /// For every pair a, b <= a of `geared` the place of the pair's entry in the rows of the mass matrix.
    pub entries: Vec<[usize; 3]>,
}

/// Present motion of a rotor.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spin {
    pub ratio: [f64; MOST_JOINTS],
    /// Part of `phi''` at q'' = 0.
    pub bias: f64,
    pub s: f64,
    pub ds: f64,
    pub torque: f64,
}

impl Gyro {
    /// j e e^T
    pub(crate) fn inertia(&self) -> Sym3 {
        let V3 { x, y, z } = self.e;
        Sym3 { xx: x * x, yy: y * y, zz: z * z, xy: x * y, xz: x * z, yz: y * z } * self.j
    }

    /// Speed or acceleration of the rotor by the transmission, from those of the joints, given by body.
    #[inline(always)]
    pub(crate) fn through(&self, spin: &Spin, joint: impl Fn(usize) -> f64) -> f64 {
        self.geared.iter().zip(spin.ratio).map(|(&k, c)| c * joint(k)).sum()
    }

    /// Moment of momentum that the stator's inertia does not hold: of a free rotor all about its axis.
    #[inline(always)]
    pub(crate) fn momentum(&self, spin: &Spin, w: V3) -> V3 {
        let locked = if self.geared.is_empty() { self.e.dot(w) } else { 0.0 };
        self.e * (self.j * (spin.s + locked))
    }

    /// Adds the moment of momentum for unit speed of each joint that turns the rotor, in the stator's axes.
    #[inline(always)]
    pub(crate) fn add_momenta(&self, spin: &Spin, momenta: &mut [Twin]) {
        for (&k, c) in self.geared.iter().zip(spin.ratio) {
            momenta[k].add_second(self.e * (self.j * c));
        }
    }

    /// Adds the entries j c_a c_b of the mass matrix.
    #[inline(always)]
    pub(crate) fn add_entries(&self, spin: &Spin, m: &mut [f64]) {
        for &[a, b, at] in &self.entries {
            m[at] += self.j * spin.ratio[a] * spin.ratio[b];
        }
    }
}
