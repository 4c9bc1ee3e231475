//! Reference algorithm, which only tests call: from motor angles back to joint angles. A harmonic drive divides, a knee has a closed form
//! ([`Knee::joint_angle`](crate::Knee::joint_angle)), an ankle takes Newton's method on both of its motors.

use crate::{Ankle, OutOfDomain, Transmission};

/// \[rad\] Distance of the motor angles at which Newton's method ends.
const TOLERANCE: f64 = 1e-10;
/// Steps of Newton's method; from the guess of the last cycle it takes two or three.
const STEPS: usize = 30;
/// Halvings of a step that leads away, or out of the linkage's domain.
const HALVINGS: usize = 20;

impl Transmission {
    /// Joint angle \[rad\] of a motor angle \[rad\], where the transmission is on one joint.
    pub fn joint_angle(&self, angle: f64) -> Result<f64, OutOfDomain> {
        match self {
            Self::Harmonic { ratio } if (angle / ratio).is_finite() => Ok(angle / ratio),
            Self::Knee(knee) => knee.joint_angle(angle),
            Self::Harmonic { .. } => Err(OutOfDomain::NotFinite),
            Self::Ankle(_) => Err(OutOfDomain::NoAngle { residual: angle.abs() }),
        }
    }
}

impl Ankle {
    /// Adduction and flexion \[rad\] of the ankle that `pair` moves, from the knee's angle and both motors' \[rad\]; `guess`
    /// is near them, for example the angles of the last cycle.
    pub fn joint_angles(
        pair: [&Self; 2],
        knee: f64,
        motors: [f64; 2],
        guess: [f64; 2],
    ) -> Result<[f64; 2], OutOfDomain> {
        let mut q = guess;
        let mut now = Miss::at(pair, knee, motors, q)?;
        for _ in 0..STEPS {
            if now.size() <= TOLERANCE {
                return Ok(q);
            }
            let step = now.newton().ok_or(OutOfDomain::NoAngle { residual: now.size() })?;
            let tried = (0..HALVINGS).find_map(|i| {
                let t = 0.5_f64.powi(i as i32);
                let next = [q[0] - t * step[0], q[1] - t * step[1]];
                let miss = Miss::at(pair, knee, motors, next).ok()?;
                (miss.size() < now.size()).then_some((next, miss))
            });
            let Some((next, miss)) = tried else { break };
            (q, now) = (next, miss);
        }
        if now.size() <= TOLERANCE { Ok(q) } else { Err(OutOfDomain::NoAngle { residual: now.size() }) }
    }
}

/// By how much the motor angles of some joint angles miss those wanted, and the Jacobian of it.
struct Miss {
    f: [f64; 2],
    j: [[f64; 2]; 2],
}

impl Miss {
    fn at(pair: [&Ankle; 2], knee: f64, motors: [f64; 2], q: [f64; 2]) -> Result<Self, OutOfDomain> {
        let (a, b) = (pair[0].at([knee, q[0], q[1]], [0.0; 3])?, pair[1].at([knee, q[0], q[1]], [0.0; 3])?);
        let miss = Self {
            f: [a.angle - motors[0], b.angle - motors[1]],
            j: [[a.ratio[1], a.ratio[2]], [b.ratio[1], b.ratio[2]]],
        };
        if miss.size().is_finite() { Ok(miss) } else { Err(OutOfDomain::NotFinite) }
    }

    fn size(&self) -> f64 {
        self.f[0].hypot(self.f[1])
    }

    /// J⁻¹ f; none where both motors move the foot in the same direction.
    fn newton(&self) -> Option<[f64; 2]> {
        let ([[a, b], [c, d]], [f, g]) = (self.j, self.f);
        let det = a * d - b * c;
        let regular = det.abs() > 1e-9 * (a * a + b * b + c * c + d * d);
        regular.then(|| [(d * f - b * g) / det, (a * g - c * f) / det])
    }
}
