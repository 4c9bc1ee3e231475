//! Components of the simulated robot, `[components]` of a scene: what is computed. A type names a set of them (thesis
//! tables 2.4 and 2.5), of which a scene changes what it needs more or less of.
//!
//! | type | joints | gears | contact | currents, friction, rotors |
//! |---|---|---|---|---|
//! | 1 | follow their targets | | points | only rotors, which turn along |
//! | 2 | motors | stiff | points | yes |
//! | 3 | motors | elastic | points | yes |
//! | 4 | motors | stiff | pads | yes |
//! | 5 | motors | elastic | pads | yes |
//!
//! ```toml
//! depth = 2
//!
//! [components]
//! joints = "motors" # or "targets": they follow these
//! elastic = ["right_knee_flexion", "left_knee_flexion"] # drives with an elastic gear, of those whose file names a spring
//! currents = false # motors take the current of their voltage at once
//! friction = false # gears turn freely
//! rotors = false # only where joints follow their targets: rotors do not turn along
//! contact = "points" # or "pads", or ["pads", "points"]: right, left
//! locked = ["head_pan", "head_tilt"] # their links are one body in the start pose; their encoders read the target; not joints
//!                                    # that share a drive, as knees and ankles with linkages do
//! ```

use std::fmt;

use drives::Friction;

use crate::robot::Robot;
use crate::section::Section;

/// Set of components of a simulated robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Components {
    /// Cause of the joints' motion.
    pub joints: JointModel,
    /// Gears that are elastic, of those whose file names a spring.
    pub elastic: Selection,
    /// Motor currents have states of their own (2.57).
    pub currents: bool,
    /// Friction of the gears (2.61), (2.68).
    pub friction: bool,
    /// Rotors turn along with joints that follow their targets.
    pub rotors: bool,
    /// Contact elements of each foot; right, left.
    pub contact: [ContactModel; 2],
    /// Names of joints that do not move.
    pub locked: Vec<String>,
}

/// Cause of the joints' motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointModel {
    /// They follow their targets and have no dynamics of their own (2.80).
    FollowTargets,
    /// Motors with gears, friction and their local controllers (2.57) to (2.70).
    Motors,
}

/// Some of the drives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Selection {
    /// All of them, or none.
    All(bool),
    /// The drives of these names.
    Named(Vec<String>),
}

/// Contact elements under a foot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactModel {
    /// Independent points.
    Points,
    /// Pads of finite elements.
    Pads,
}

/// Changes that a scene makes to the components of its type.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ComponentChanges {
    /// Motion of the joints: by targets or by motors.
    pub joints: Option<JointModel>,
    /// Elastic gears: all of those that have a spring, none, or the drives of these names.
    pub elastic: Option<Selection>,
    /// Motor currents have states of their own.
    pub currents: Option<bool>,
    /// Gears have friction.
    pub friction: Option<bool>,
    /// Rotors turn along with joints that follow their targets.
    pub rotors: Option<bool>,
    /// Contact elements: points or pads, for both feet or for right and left.
    pub contact: Option<[ContactModel; 2]>,
    /// Joints that do not move.
    pub locked: Vec<String>,
}

const JOINT_MODELS: ([JointModel; 2], [&str; 2]) =
    ([JointModel::FollowTargets, JointModel::Motors], ["targets", "motors"]);
const CONTACT_MODELS: ([ContactModel; 2], [&str; 2]) =
    ([ContactModel::Points, ContactModel::Pads], ["points", "pads"]);

impl From<u8> for Components {
    /// Components of a type, 1 to 5.
    fn from(depth: u8) -> Self {
        let motors = depth > 1;
        Self {
            joints: if motors { JointModel::Motors } else { JointModel::FollowTargets },
            elastic: Selection::All(depth == 3 || depth == 5),
            currents: motors,
            friction: motors,
            rotors: true,
            contact: [if depth > 3 { ContactModel::Pads } else { ContactModel::Points }; 2],
            locked: Vec::new(),
        }
    }
}

impl Components {
    /// The same on points instead of pads.
    pub fn on_points(self) -> Self {
        Self { contact: [ContactModel::Points; 2], ..self }
    }

    /// The robot as far as it is computed: without the joints that are locked and their drives, without springs and
    /// friction that are left out, without drives if nothing of them is computed. Places of joints and drives change.
    pub fn of_robot(&self, robot: &Robot) -> Robot {
        let mut robot = robot.clone();
        if !self.rotors {
            robot.drives.clear();
        }
        for drive in &mut robot.drives {
            if !self.friction {
                drive.friction = Friction::Free;
            }
            let elastic = match &self.elastic {
                Selection::All(all) => *all,
                Selection::Named(names) => names.contains(&drive.name),
            };
            drive.elasticity = drive.elasticity.filter(|_| elastic);
        }
        let moving = self.moving(&robot);
        let place = |joint: usize| moving.iter().position(|&j| j == joint);
        robot.drives.retain(|drive| drive.joints.iter().all(|&j| place(j).is_some()));
        for drive in &mut robot.drives {
            drive.joints = drive.joints.iter().filter_map(|&j| place(j)).collect();
        }
        robot.joints = moving.iter().map(|&j| robot.joints[j].clone()).collect();
        robot
    }

    /// Joints of `robot` that move.
    pub fn moving(&self, robot: &Robot) -> Vec<usize> {
        (0..robot.joints.len()).filter(|&j| !self.locked.contains(&robot.joints[j].name)).collect()
    }
}

impl ComponentChanges {
    pub(crate) fn build(table: &Section<'_, '_>) -> Self {
        let flag = |key: &str| table.has(key).then(|| table.flag(key));
        let contact = |i: usize| CONTACT_MODELS.0[i];
        Self {
            joints: table.has("joints").then(|| JOINT_MODELS.0[table.word("joints", &JOINT_MODELS.1)]),
            elastic: table.has("elastic").then(|| {
                if table.is_list("elastic") {
                    Selection::Named(table.texts("elastic"))
                } else {
                    Selection::All(table.flag("elastic"))
                }
            }),
            currents: flag("currents"),
            friction: flag("friction"),
            rotors: flag("rotors"),
            contact: table.has("contact").then(|| {
                if !table.is_list("contact") {
                    return [contact(table.word("contact", &CONTACT_MODELS.1)); 2];
                }
                let found = |word: &String| CONTACT_MODELS.1.iter().position(|w| w == word).map(contact);
                match table.texts("contact").iter().map(found).collect::<Vec<_>>()[..] {
                    [Some(right), Some(left)] => [right, left],
                    _ => {
                        table.problem("contact", "takes \"points\" or \"pads\", or two of them: right, left");
                        [ContactModel::Points; 2]
                    }
                }
            }),
            locked: if table.has("locked") { table.texts("locked") } else { Vec::new() },
        }
    }

    /// True if nothing is changed.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The components of a type with these changes.
    pub fn applied(&self, depth: u8) -> Components {
        let of_type = Components::from(depth);
        let joints = self.joints.unwrap_or(of_type.joints);
        // Joints that are given motors have all of them, but what is said otherwise.
        let motors = joints == JointModel::Motors;
        Components {
            joints,
            elastic: self.elastic.clone().unwrap_or(of_type.elastic),
            currents: self.currents.unwrap_or(motors),
            friction: self.friction.unwrap_or(motors),
            rotors: self.rotors.unwrap_or(true),
            contact: self.contact.unwrap_or(of_type.contact),
            locked: self.locked.clone(),
        }
    }

    /// Names of these changes that `robot` does not know, or that do not fit together, in words.
    pub fn problem(&self, depth: u8, robot: &Robot) -> Option<(&'static str, String)> {
        let all = self.applied(depth);
        let motors = all.joints == JointModel::Motors;
        if let Selection::Named(names) = &all.elastic {
            let has_spring = |name: &String| {
                robot.drives.iter().any(|drive| drive.name == *name && drive.elasticity.is_some())
            };
            if let Some(name) = names.iter().find(|name| !has_spring(name)) {
                return Some(("elastic", format!("`{name}` is no drive of {} with a spring", robot.name)));
            }
            if let Some(name) = names.iter().find(|name| self.locked.contains(name)) {
                return Some((
                    "elastic",
                    format!("`{name}` is locked, too: it has no gear that could give way"),
                ));
            }
        }
        for name in &self.locked {
            let Some(joint) = robot.joints.iter().position(|j| j.name == *name) else {
                return Some(("locked", format!("`{name}` is no joint of {}", robot.name)));
            };
            // A drive that moves several joints can't lose one of them.
            let shared = |d: &&crate::robot::Drive| d.joints.contains(&joint) && d.joints.len() > 1;
            if let Some(drive) = robot.drives.iter().find(shared) {
                let why =
                    format!("`{name}` shares the drive `{}` with others and cannot be locked", drive.name);
                return Some(("locked", why));
            }
        }
        let needs_motors = [
            ("elastic", self.elastic.is_some()),
            ("currents", self.currents.is_some()),
            ("friction", self.friction.is_some()),
        ];
        if let Some((key, _)) = needs_motors.iter().find(|(_, asked)| *asked && !motors) {
            return Some((key, "needs joints = \"motors\", or depth 2 to 5".to_owned()));
        }
        let without = motors && self.rotors == Some(false);
        without.then(|| ("rotors", "false needs joints that follow their targets".to_owned()))
    }
}

/// As in ", without currents, on pads/points": to be appended to the name of a type.
impl fmt::Display for ComponentChanges {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(joints) = self.joints {
            write!(f, ", joints by {}", JOINT_MODELS.1[joints as usize])?;
        }
        match &self.elastic {
            None => {}
            Some(Selection::All(all)) => write!(f, ", {} gears", if *all { "elastic" } else { "stiff" })?,
            Some(Selection::Named(names)) => write!(f, ", elastic {}", few(names, "gears"))?,
        }
        for (name, changed) in
            [("currents", self.currents), ("friction", self.friction), ("rotors", self.rotors)]
        {
            if let Some(with) = changed {
                write!(f, ", {} {name}", if with { "with" } else { "without" })?;
            }
        }
        if let Some([right, left]) = self.contact.map(|feet| feet.map(|c| CONTACT_MODELS.1[c as usize])) {
            write!(f, ", on {right}/{left}")?;
        }
        match &self.locked[..] {
            [] => Ok(()),
            locked => write!(f, ", locked {}", few(locked, "joints")),
        }
    }
}

/// Names, or the number of them if they are many.
fn few(names: &[String], what: &str) -> String {
    if names.len() > 2 { format!("{} {what}", names.len()) } else { names.join(" ") }
}
