//! Elasticity of a harmonic drive: torque over torsion, linear in three pieces, stiffer with load.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | Δφ | torsion: joint angle less motor angle over N, at the output | rad |
//! | T | torque; acts with -T on the joint, with +T/N on the rotor (errata 1, (2.70)) | N m |
//! | K_0, K_1, K_2 | stiffness of the pieces | N m/rad |
//! | T_1, T_2 | torques between them | N m |
//!
//! Source: (2.69) as in errata 1, F10: continuous and odd.

/// Torsion of a gear at its output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elasticity {
    /// \[N m/rad\] K_0, K_1, K_2.
    pub stiffness: [f64; 3],
    /// \[N m\] T_1 < T_2.
    pub knees: [f64; 2],
}

impl Elasticity {
    /// One stiffness \[N m/rad\] for all loads.
    pub fn linear(stiffness: f64) -> Self {
        Self { stiffness: [stiffness; 3], knees: [1.0, 2.0] }
    }

    /// φ_1, φ_2 \[rad\]: torsions at T_1, T_2.
    fn corners(&self) -> [f64; 2] {
        let ([k0, k1, _], [t1, t2]) = (self.stiffness, self.knees);
        let first = t1 / k0;
        [first, first + (t2 - t1) / k1]
    }

    /// The piece that a torsion lies in: its stiffness, and torsion and torque where it begins.
    fn piece(&self, size: f64) -> (f64, f64, f64) {
        let ([first, second], [t1, t2]) = (self.corners(), self.knees);
        if size < first {
            (self.stiffness[0], 0.0, 0.0)
        } else if size < second {
            (self.stiffness[1], first, t1)
        } else {
            (self.stiffness[2], second, t2)
        }
    }

    /// \[N m\] Torque at a torsion \[rad\].
    pub fn torque(&self, torsion: f64) -> f64 {
        let (k, from, t) = self.piece(torsion.abs());
        (t + k * (torsion.abs() - from)).copysign(torsion) // (2.69)
    }

    /// \[N m/rad\] Its derivative; at a corner that of the outer piece.
    pub fn tangent(&self, torsion: f64) -> f64 {
        self.piece(torsion.abs()).0
    }

    /// \[J\] Energy stored at a torsion \[rad\].
    pub fn energy(&self, torsion: f64) -> f64 {
        let ([k0, k1, k2], [t1, t2], [first, second]) = (self.stiffness, self.knees, self.corners());
        let a = torsion.abs();
        let (x0, x1, x2) = (a.min(first), (a - first).clamp(0.0, second - first), (a - second).max(0.0));
        0.5 * k0 * x0 * x0 + x1 * (t1 + 0.5 * k1 * x1) + x2 * (t2 + 0.5 * k2 * x2)
    }

    /// \[rad\] Torsion under a torque \[N m\].
    pub fn torsion(&self, torque: f64) -> f64 {
        let ([k0, k1, k2], [t1, t2], [first, second]) = (self.stiffness, self.knees, self.corners());
        let t = torque.abs();
        let a = if t < t1 {
            t / k0
        } else if t < t2 {
            first + (t - t1) / k1
        } else {
            second + (t - t2) / k2
        };
        a.copysign(torque)
    }
}
