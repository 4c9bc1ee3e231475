//! A pose in the plane: where a foot stands, where a planning frame lies.

/// Position and heading of a frame in another one.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct PlanarPose {
    /// \[m\] Forward.
    pub x: f64,
    /// \[m\] To the left.
    pub y: f64,
    /// \[rad\] Heading to the left, not wrapped.
    pub heading: f64,
}

impl PlanarPose {
    /// A pose from (x, y, heading).
    pub const fn new(x: f64, y: f64, heading: f64) -> Self {
        Self { x, y, heading }
    }

    /// The pose as (x, y, heading), the form records use.
    pub const fn array(&self) -> [f64; 3] {
        [self.x, self.y, self.heading]
    }

    /// Position of a point that is given in this frame.
    pub fn point(&self, p: [f64; 2]) -> [f64; 2] {
        let q = rotate(self.heading, p);
        [self.x + q[0], self.y + q[1]]
    }

    /// A point of the outer frame, seen from this one: the inverse of [`PlanarPose::point`].
    pub fn local(&self, p: [f64; 2]) -> [f64; 2] {
        rotate(-self.heading, [p[0] - self.x, p[1] - self.y])
    }

    /// A pose that is given in this frame, in the outer frame.
    pub fn compose(&self, inner: &Self) -> Self {
        let p = self.point([inner.x, inner.y]);
        Self { x: p[0], y: p[1], heading: self.heading + inner.heading }
    }

    /// A pose of the outer frame, seen from this one: the inverse of [`PlanarPose::compose`].
    pub fn relative(&self, outer: &Self) -> Self {
        let p = self.local([outer.x, outer.y]);
        Self { x: p[0], y: p[1], heading: outer.heading - self.heading }
    }
}

/// R(angle) v: `v` turned to the left.
pub(crate) fn rotate(angle: f64, v: [f64; 2]) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    [c * v[0] - s * v[1], s * v[0] + c * v[1]]
}
