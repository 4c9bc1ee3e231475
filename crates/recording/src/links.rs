//! Poses of the robot's links, written as the tree `/tf`; the kinematics are the caller's.

use messages::{Joints, Sensors};

/// Position \[m\] and unit quaternion (x, y, z, w) of a frame in another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedPose {
    /// \[m\]
    pub position: [f64; 3],
    /// \[1\] (x, y, z, w)
    pub orientation: [f64; 4],
}

/// A link and the one it hangs on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LinkFrame {
    /// Name in the URDF.
    pub name: String,
    /// Index of the parent link, which comes before this one; none: the floating base.
    pub parent: Option<usize>,
    /// Whether it never moves against that one.
    pub fixed: bool,
}

/// The kinematics behind `/tf`.
pub trait LinkPoses: Send {
    /// All links, parents before their children.
    fn links(&self) -> &[LinkFrame];

    /// Pose of every link with the base at `base` and joints at these angles \[rad\], in the same order.
    fn poses(&mut self, base: &RecordedPose, joint_angle: &Joints, out: &mut [RecordedPose]);

    /// Torque of every joint \[N m\], NaN where nothing is known of it; false: of none.
    fn torques(&mut self, _sensors: &Sensors, _out: &mut Joints) -> bool {
        false
    }
}

impl RecordedPose {
    /// The frame itself.
    pub const IDENTITY: Self = Self { position: [0.0; 3], orientation: [0.0, 0.0, 0.0, 1.0] };

    /// A frame moved by `position` and not turned.
    pub const fn moved(position: [f64; 3]) -> Self {
        Self { position, ..Self::IDENTITY }
    }

    /// This pose seen from `base`, both given in one frame: base^-1 * self.
    pub fn seen_from(&self, base: &Self) -> Self {
        let inverse = conjugate(base.orientation);
        let d: [f64; 3] = std::array::from_fn(|i| self.position[i] - base.position[i]);
        Self { position: turn(inverse, d), orientation: product(inverse, self.orientation) }
    }

    /// A point of this frame in the frame the pose is given in.
    pub fn place(&self, point: [f64; 3]) -> [f64; 3] {
        let p = turn(self.orientation, point);
        std::array::from_fn(|i| self.position[i] + p[i])
    }

    /// \[rad\] Direction of its x axis in the plane.
    pub fn heading(&self) -> f64 {
        let [x, y, z, w] = self.orientation;
        (2.0 * (x * y + w * z)).atan2(1.0 - 2.0 * (y * y + z * z))
    }

    /// A pose of this frame in the frame this pose is given in: self * inner.
    pub fn then(&self, inner: &Self) -> Self {
        Self {
            position: self.place(inner.position),
            orientation: product(self.orientation, inner.orientation),
        }
    }
}

fn conjugate([x, y, z, w]: [f64; 4]) -> [f64; 4] {
    [-x, -y, -z, w]
}

/// Hamilton product.
fn product([ax, ay, az, aw]: [f64; 4], [bx, by, bz, bw]: [f64; 4]) -> [f64; 4] {
    [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]
}

/// q v q*
fn turn(q: [f64; 4], [x, y, z]: [f64; 3]) -> [f64; 3] {
    let [x, y, z, _] = product(product(q, [x, y, z, 0.0]), conjugate(q));
    [x, y, z]
}
