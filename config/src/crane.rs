//! Start of a scene in which the robot does not simply stand: `[crane]` and `[drives]`.
//!
//! ```toml
//! [crane] # holds the robot at the start, and is lowered by sim/lower; without it the robot stands
//! height = 0.1 # [m] of the soles over the ground
//! hook = 0.4 # [m] over the torso's origin, above the centre of gravity
//! rope = 1.0 # [m]
//! stiffness = 6e4 # [N/m]
//! damping = 2e3 # [N s/m]
//! speed = 0.05 # [m/s] of lowering
//!
//! [drives] # as they are at switch-on, protected; without it they know their angles, and nothing protects them
//! homing = true # joints with a home switch do not know their angles; without it they do
//! ```

use crate::section::Section;

/// Crane with a rope that holds the robot at the start of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crane {
    /// \[m\] Height of the soles over the ground at the start.
    pub height: f64,
    /// \[m\] Height of the hook over the torso's origin; it lies above the centre of gravity of the start pose.
    pub hook: f64,
    /// \[m\] Length of the rope without load.
    pub rope: f64,
    /// \[N/m\] Stiffness of the rope.
    pub stiffness: f64,
    /// \[N s/m\] Damping of the rope.
    pub damping: f64,
    /// \[m/s\] Speed of lowering and lifting.
    pub speed: f64,
}

impl Crane {
    pub(crate) fn build(table: &Section<'_, '_>) -> Self {
        Self {
            height: table.number("height", "m", 0.0..=2.0),
            hook: table.number("hook", "m", 0.0..=2.0),
            rope: table.number("rope", "m", 0.1..=20.0),
            stiffness: table.number("stiffness", "N/m", 1e3..=1e7),
            damping: table.number("damping", "N s/m", 0.0..=1e5),
            speed: table.number("speed", "m/s", 1e-9..=1.0),
        }
    }
}

/// The drives of a scene as they are at switch-on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DriveStart {
    /// Joints with a home switch do not know their angles.
    pub homing: bool,
}

impl DriveStart {
    pub(crate) fn build(table: &Section<'_, '_>) -> Self {
        Self { homing: table.flag("homing") }
    }
}
