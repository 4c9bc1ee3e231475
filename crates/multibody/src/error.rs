//! Faults of a robot's description.

use std::fmt;

/// Why no [`Model`](crate::Model) can be made, or a frame not be found. Every case ends with what to do next.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ModelError {
    /// The text is no URDF.
    Unreadable(String),
    /// A name in the caller's list is no joint of the URDF.
    UnknownJoint(String),
    /// A movable joint of the URDF is not in the caller's list.
    MissingJoint(String),
    /// A joint is listed twice, or two joints or links of the URDF share a name.
    Duplicate(String),
    /// A joint comes before the joint that carries it: (joint, the joint that must come first).
    Order(String, String),
    /// A link, named by a joint, a frame or as the base, does not exist.
    UnknownLink(String),
    /// A link hangs on two joints, so that the mechanism has a loop: (link, joint, joint).
    Loop(String, String, String),
    /// No chain of joints leads from the base to this link.
    Unreachable(String),
    /// Mass or inertia of a link, or of a moving body, cannot exist: (link, what is wrong).
    Inertia(String, String),
    /// A rotor cannot be where it is put: (rotor, what is wrong and what to do).
    Rotor(String, String),
    /// A type of joint that has no single coordinate: (joint, type).
    JointType(String, String),
    /// The axis of a joint has no direction, or a number is not finite: (joint or link).
    Geometry(String),
    /// A link or joint is not what it is to be used for: (name, what is wrong).
    Unsuitable(String, String),
}

impl std::error::Error for ModelError {}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(why) => write!(f, "URDF cannot be read: {why}; check it with `check_urdf`"),
            Self::UnknownJoint(j) => {
                write!(
                    f,
                    "joint `{j}` is in the joint order but not in the URDF (or is fixed there); correct its name"
                )
            }
            Self::MissingJoint(j) => {
                write!(
                    f,
                    "joint `{j}` of the URDF is movable but not in the joint order; add it, or make it fixed"
                )
            }
            Self::Duplicate(n) => {
                write!(
                    f,
                    "the name `{n}` occurs twice; names of joints, of links and of rotors must be unique"
                )
            }
            Self::Order(j, p) => {
                write!(f, "joint `{j}` comes before `{p}`, which carries it; list `{p}` first")
            }
            Self::UnknownLink(l) => write!(f, "link `{l}` does not exist in the model; correct the name"),
            Self::Loop(l, a, b) => write!(
                f,
                "link `{l}` is the child of both joint `{a}` and joint `{b}`: closed loops cannot be modelled; remove one joint"
            ),
            Self::Unreachable(l) => write!(
                f,
                "no chain of joints leads from the base to link `{l}`; take the root of the tree as base, and look for a loop"
            ),
            Self::Inertia(l, why) => write!(f, "inertia of link `{l}`: {why}; correct <inertial>"),
            Self::Unsuitable(name, why) => {
                write!(f, "`{name}` cannot be used: {why}; correct robot.toml or the URDF")
            }
            Self::Rotor(r, why) => write!(f, "rotor `{r}`: {why}"),
            Self::JointType(j, t) => write!(
                f,
                "joint `{j}` is of type {t}; allowed are revolute, continuous, prismatic, fixed; split it into such joints"
            ),
            Self::Geometry(n) => {
                write!(
                    f,
                    "`{n}` has a number that is not finite, or an axis of length zero; correct its origin or axis"
                )
            }
        }
    }
}
