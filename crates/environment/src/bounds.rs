//! Axis-aligned boxes, B(O) of the thesis.

use nalgebra::Vector3;

/// A box from `lo` to `hi` \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// \[m\] Least coordinates.
    pub lo: Vector3<f64>,
    /// \[m\] Greatest coordinates.
    pub hi: Vector3<f64>,
}

impl Bounds {
    /// Around nothing: the neutral element of [`Bounds::with`].
    pub const NOTHING: Self = Self {
        lo: Vector3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        hi: Vector3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    /// Around all points \[m\].
    pub fn of(points: impl IntoIterator<Item = Vector3<f64>>) -> Self {
        points.into_iter().fold(Self::NOTHING, |b, p| b.with(&Self { lo: p, hi: p }))
    }

    /// Around both boxes.
    pub fn with(&self, other: &Self) -> Self {
        Self { lo: self.lo.inf(&other.lo), hi: self.hi.sup(&other.hi) }
    }

    /// \[m^2\] Squared distance from `p` \[m\] to the box; 0 inside.
    #[inline]
    pub(crate) fn distance_squared(&self, p: &Vector3<f64>) -> f64 {
        // Not f64::max, which looks for NaN.
        let larger = |a: f64, b: f64| if a > b { a } else { b };
        let mut sum = 0.0;
        for i in 0..3 {
            let d = larger(larger(self.lo[i] - p[i], p[i] - self.hi[i]), 0.0);
            sum += d * d;
        }
        sum
    }

    /// Do the boxes come nearer than `margin` \[m\] in every direction?
    pub fn near(&self, other: &Self, margin: f64) -> bool {
        (0..3).all(|i| self.lo[i] - margin <= other.hi[i] && other.lo[i] - margin <= self.hi[i])
    }

    /// \[m\] Extent.
    pub fn size(&self) -> Vector3<f64> {
        self.hi - self.lo
    }
}
