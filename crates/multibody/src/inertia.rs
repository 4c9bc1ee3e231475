//! Mass, centre and moments of inertia of a rigid body, and whether they can exist.

use nalgebra::{IsometryMatrix3, Matrix3, Vector3};

/// Inertia of one rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// \[kg\]
    pub mass: f64,
    /// \[m\] Centre of gravity from the origin of the frame in question, in its axes.
    pub center: Vector3<f64>,
    /// \[kg m^2\] Moments about the centre of gravity, in the same axes.
    pub moments: Matrix3<f64>,
}

impl Inertia {
    /// Nothing: a link without `<inertial>`.
    pub const NONE: Inertia = Inertia {
        mass: 0.0,
        center: Vector3::new(0.0, 0.0, 0.0),
        moments: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    };

    /// From the moments about the origin of the frame (the I_o of (2.35)) in place of those about the centre.
    pub fn about_origin(mass: f64, center: Vector3<f64>, moments: Matrix3<f64>) -> Inertia {
        Inertia { mass, center, moments: moments - steiner(mass, &center) }
    }

    /// \[kg m^2\] Moments about the origin of the frame.
    pub(crate) fn moments_about_origin(&self) -> Matrix3<f64> {
        self.moments + steiner(self.mass, &self.center)
    }

    /// The same body seen from another frame.
    pub fn seen_from(&self, there_from_here: &IsometryMatrix3<f64>) -> Inertia {
        let r = there_from_here.rotation.matrix();
        Inertia {
            mass: self.mass,
            center: there_from_here.rotation * self.center + there_from_here.translation.vector,
            moments: r * self.moments * r.transpose(),
        }
    }

    /// Both bodies as one; both must be given in the same frame.
    pub fn with(&self, other: &Inertia) -> Inertia {
        let mass = self.mass + other.mass;
        if mass == 0.0 {
            return Inertia::NONE;
        }
        let center = (self.center * self.mass + other.center * other.mass) / mass;
        let about = |b: &Inertia| b.moments + steiner(b.mass, &(b.center - center));
        Inertia { mass, center, moments: about(self) + about(other) }
    }

    /// Fault of a link by itself: negative mass, moments without mass, or principal moments that no
    /// distribution of mass has (the largest exceeds the sum of the other two).
    pub(crate) fn fault(&self) -> Option<String> {
        let m = &self.moments;
        if !self.mass.is_finite() || m.iter().chain(self.center.iter()).any(|x| !x.is_finite()) {
            return Some("a number is not finite".into());
        }
        if self.mass < 0.0 {
            return Some(format!("mass is {} kg, must not be negative", self.mass));
        }
        if self.mass == 0.0 {
            return (m.norm() > 0.0).then(|| "mass is zero but moments are not".into());
        }
        let p = principal(m);
        let allowance = 1e-9 * p[2].abs();
        (p[0] < -allowance || p[2] > p[0] + p[1] + allowance).then(|| {
            format!(
                "principal moments {:.6e}, {:.6e}, {:.6e} kg m^2: none may be negative and the largest may not exceed the sum of the others",
                p[0], p[1], p[2]
            )
        })
    }

    /// Fault of a whole moving body: no mass, or no resistance to some rotation.
    pub(crate) fn fault_of_moving_body(&self) -> Option<String> {
        if self.mass <= 0.0 {
            return Some(format!("the moving body has mass {} kg, must be above zero", self.mass));
        }
        let p = principal(&self.moments);
        (p[0] <= 1e-12 * p[2]).then(|| {
            format!(
                "the moving body's smallest principal moment is {:.6e} kg m^2, must be above zero ({:.6e} is the largest)",
                p[0], p[2]
            )
        })
    }
}

/// m ((r.r) E - r r^T)
fn steiner(m: f64, r: &Vector3<f64>) -> Matrix3<f64> {
    (Matrix3::identity() * r.norm_squared() - r * r.transpose()) * m
}

/// \[kg m^2\] Smallest principal moment.
pub(crate) fn least(m: &Matrix3<f64>) -> f64 {
    principal(m)[0]
}

/// Principal moments in ascending order.
fn principal(m: &Matrix3<f64>) -> [f64; 3] {
    let mut p = [0.0; 3];
    p.copy_from_slice(m.symmetric_eigenvalues().as_slice());
    p.sort_by(f64::total_cmp);
    p
}
