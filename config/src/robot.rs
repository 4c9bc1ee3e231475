//! What a URDF cannot say about a robot: soles, contact points, sensors, limits, bus.

use std::collections::BTreeMap;

/// A robot: its URDF and everything else that is data about it.
#[derive(Clone, Debug)]
pub struct Robot {
    /// Name of the robot's directory.
    pub name: String,
    /// Text of the URDF.
    pub urdf: String,
    /// \[kg\] Sum of all masses, which the URDF must meet within 1 g.
    pub total_mass: f64,
    /// Link that is the floating base: the upper body.
    pub torso: String,
    /// Joints in the order of every array of joints; parents come before their children.
    pub joints: Vec<Joint>,
    /// Right and left foot.
    pub feet: [Foot; 2],
    /// Viscoelastic contact elements.
    pub contact: Contact,
    /// \[m\] Origin of the inertial measurement unit in the torso frame; its axes are the torso's.
    pub imu: [f64; 3],
    /// Named joint poses \[rad\], complete, in joint order.
    pub poses: BTreeMap<String, Vec<f64>>,
    /// Local controllers of the field bus: the joints (indices) each one drives.
    pub nodes: Vec<Vec<usize>>,
}

/// One driven joint.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name in the URDF.
    pub name: String,
    /// \[rad\] Software range.
    pub range: [f64; 2],
    /// \[rad/s\]
    pub speed_limit: f64,
    /// \[rad/s^2\] How fast the joint may be brought to rest.
    pub braking: f64,
    /// \[rad\] Comfortable angle for redundancy resolution.
    pub comfort: f64,
    /// \[1\] Weight W of the joint's speed in the inverse kinematics (5.36).
    pub weight: f64,
}

/// One foot.
#[derive(Clone, Debug)]
pub struct Foot {
    /// Link that carries the sole frame.
    pub link: String,
    /// \[m\] Origin of the sole frame in that link; axes as the link's: x forward, y left, z up.
    pub sole: [f64; 3],
    /// \[m\] Support rectangle in the sole frame: x back, x front, y right, y left.
    pub support: [f64; 4],
    /// Link whose wrench the force/torque sensor measures.
    pub sensor_link: String,
    /// \[m\] Origin of the sensor frame in that link; axes as the link's.
    pub sensor: [f64; 3],
    /// Contact points: link and position in it \[m\].
    pub points: Vec<(String, [f64; 3])>,
    /// Index of the toe joint, if the foot has one.
    pub toe: Option<usize>,
}

/// Contact elements of the sole, one per contact point.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// \[N/m\] Normal stiffness of one point.
    pub normal_stiffness: f64,
    /// \[N/m\] Tangential stiffness of one point.
    pub tangential_stiffness: f64,
    /// \[s\] Damping B = alpha K.
    pub damping_time: f64,
    /// \[1\] Coulomb friction against the ground.
    pub friction: f64,
}
