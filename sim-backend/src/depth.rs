//! Modelling depth: three answers behind the five types of the thesis (tables 2.4 and 2.5).
//!
//! | type | joints | gears | contact |
//! |---|---|---|---|
//! | 1 | follow their targets | | points |
//! | 2 | motors | stiff | points |
//! | 3 | motors | elastic | points |
//! | 4 | motors | stiff | pads |
//! | 5 | motors | elastic | pads |

/// Modelling depth of a plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Depth {
    /// Cause of the joints' motion.
    pub joints: JointModel,
    /// Gears between motors and joints.
    pub gears: GearModel,
    /// Contact elements under the feet.
    pub contact: ContactModel,
}

/// Cause of the joints' motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointModel {
    /// They follow their targets and have no dynamics of their own (2.80).
    FollowTargets,
    /// Motors with gears, friction and their local controllers (2.57) to (2.70).
    Motors,
}

/// Gears between motors and joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GearModel {
    /// A rotor turns as its joints do.
    Stiff,
    /// The rotor turns by itself where the robot's file names a spring (2.69).
    Elastic,
}

/// Contact elements under the feet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactModel {
    /// Independent points.
    Points,
    /// Pads of finite elements.
    Pads,
}

impl Depth {
    /// Depth of a type, 1 to 5, as scenes name it.
    pub fn of_type(number: u8) -> Self {
        let joints = if number > 1 { JointModel::Motors } else { JointModel::FollowTargets };
        let gears = if number == 3 || number == 5 { GearModel::Elastic } else { GearModel::Stiff };
        let contact = if number > 3 { ContactModel::Pads } else { ContactModel::Points };
        Self { joints, gears, contact }
    }
}
