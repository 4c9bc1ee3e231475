//! Robot file: soles, contact points, sensors, limits, bus, beside the URDF.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::Path;

use codec::layout::FrameLayout;
use drives::homing::HomeSwitch;
use messages::MAX_JOINTS;
use multibody::{Model, ModelError};

use crate::acceleration;
use crate::dbc;
use crate::dbc_writer::{FrameForm, LocalController, dbc_text};
pub use crate::drive::Drive;
use crate::drive::drives;
use crate::error::ConfigError;
use crate::file::{self, ConfigReader};
pub use crate::joint::Joint;
use crate::joint::joint_index;
use crate::leg::{self, Leg};
use crate::limbs::{Arms, Head};
use crate::protection::{Protection, homes};
use crate::section::{self, POSITIVE, Section};
use crate::tables::TableDrives;
use crate::urdf;

/// Stiffnesses up to that of steel.
const STIFFNESS: RangeInclusive<f64> = 1e-9..=1e13;

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
    /// Frames of the field bus; as read, those of CAN FD.
    pub layout: FrameLayout,
    /// Frames of classic CAN, or why there are none.
    pub classic: Result<FrameLayout, String>,
    /// Local controllers and DBC files that both come from.
    pub can: Can,
    /// Frames of drives that play tables of points, if the robot's can.
    table_layout: FrameLayout,
    /// Drives that play tables: [`Robot::play_tables`] makes them.
    pub tables: Option<TableDrives>,
    /// Local controllers (indices) that the robot can walk without: nobody stops it if one of them falls silent.
    pub spare: Vec<usize>,
    /// Camera head, if it has one.
    pub head: Option<Head>,
    /// Arms that swing, if it has them.
    pub arms: Option<Arms>,
    /// Right and left leg in closed form, if the file has their Denavit-Hartenberg rows; the URDF agrees with them.
    pub legs: Option<[Leg; 2]>,
    /// Drives, one per joint in the joints' order; empty for a robot of ideal drives.
    pub drives: Vec<Drive>,
    /// Limits at which the drives fail safe by themselves; only scenes with `[drives]` need it.
    pub protection: Option<Protection>,
    /// Home switches, by joint; none for a joint with an absolute encoder.
    pub homes: Vec<Option<HomeSwitch>>,
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
    /// Contact pads: link and position of the middle of the sole in it \[m\]; axes as the link's. May be none.
    pub pads: Vec<(String, [f64; 3])>,
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
    /// \[s\] Damping time alpha: damping B = alpha K.
    pub damping_time: f64,
    /// \[1\] Coulomb friction against the ground.
    pub friction: f64,
    /// Contact elements as blocks of rubber, for the models that resolve them.
    pub pads: Option<Pads>,
}

/// Contact pads, all equal: a block of bricks, bonded to its link at the top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pads {
    /// \[m\] x, y, z.
    pub size: [f64; 3],
    /// Bricks along x, y, z.
    pub bricks: [usize; 3],
    /// \[N/m^2\] Young's modulus.
    pub modulus: f64,
    /// \[1\] Poisson's ratio.
    pub poisson: f64,
}

impl Robot {
    /// Reads `robot.toml` in a robot's directory, and the URDF it names.
    pub fn load(directory: &Path) -> Result<Self, ConfigError> {
        Self::load_with(directory, &mut ConfigReader::default())
    }

    pub(crate) fn load_with(directory: &Path, reader: &mut ConfigReader) -> Result<Self, ConfigError> {
        let path = directory.join("robot.toml");
        if !file::exists(&path)
            && let Some(robots) = directory.parent()
        {
            let known = file::folders(robots);
            let hint = if known.is_empty() {
                "check --config".into()
            } else {
                format!("there is {}", known.join(", "))
            };
            return Err(ConfigError::of_file(
                directory,
                format!("no robot, for it has no robot.toml; {hint}"),
            ));
        }
        let text = file::text(&path, reader)?;
        let name = directory.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let (mut robot, can) = section::read(&path, &text, |top| (Self::build(top, name), Can::build(top)))?;
        let limits = acceleration::least(&robot.drives, &robot.joints);
        robot.joints.iter_mut().zip(limits).for_each(|(joint, limit)| joint.acceleration = limit);
        let joints: Vec<&str> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
        // Frames: a file counts before what the local controllers would give.
        let of_robot = |text| ConfigError::of_file(&path, text);
        robot.layout = match &can.fd {
            Some(file) => dbc::load(&directory.join(file), &joints, reader)?,
            None => written(&robot.name, &can, FrameForm::Fd, &joints).map_err(of_robot)?,
        };
        robot.classic = match &can.classic {
            Some(file) => dbc::load(&directory.join(file), &joints, reader).map(Ok)?,
            None => written(&robot.name, &can, FrameForm::Classic, &joints),
        };
        if let Some(tables) = &can.tables {
            robot.table_layout = dbc::load(&directory.join(&tables.file), &joints, reader)?;
        }
        robot.spare = spare(&robot.layout, &can.spare).map_err(of_robot)?;
        robot.can = can;
        let urdf_path = directory.join(&robot.urdf);
        robot.urdf = file::text(&urdf_path, reader)?;
        urdf::compare(&robot, &path, &urdf_path)?;
        Ok(robot)
    }

    /// The same with drives that play tables of points, on every bus.
    ///
    /// # Errors
    /// Its drives cannot, or the file of their frames is one of targets in every cycle.
    pub fn play_tables(&mut self) -> Result<(), String> {
        let name = &self.name;
        let tables = self.can.tables.clone().ok_or_else(|| {
            format!("robot {name} has no [can.tables]: its drives take a point in every cycle")
        })?;
        if !self.table_layout.plays_tables() {
            let file = &tables.file;
            return Err(format!(
                "robot {name}, can.tables: {file} has no JOINT_letters, JOINT_index, JOINT_value"
            ));
        }
        self.layout = self.table_layout.clone();
        self.classic = Ok(self.table_layout.clone());
        self.tables = Some(tables);
        Ok(())
    }

    /// Rigid bodies of the URDF, with the joints in the robot's order.
    ///
    /// # Errors
    /// The URDF is no tree of these joints on the torso.
    pub fn model(&self) -> Result<Model, ModelError> {
        let order: Vec<&str> = self.joints.iter().map(|joint| joint.name.as_str()).collect();
        Model::from_urdf(&self.urdf, &self.torso, &order)
    }

    /// Index of a joint in every array of joints.
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint.name == name)
    }

    /// \[rad/s^2\] Most that the drives of joint `j` can accelerate it at these angles \[rad\] of all joints; infinite for a
    /// joint without a drive.
    pub fn acceleration(&self, j: usize, angles: &[f64]) -> f64 {
        acceleration::at(&self.drives, j, angles)
    }

    /// \[N\] Weight.
    pub fn weight(&self) -> f64 {
        self.total_mass * multibody::GRAVITY_ACCELERATION
    }

    /// Everything but the URDF's text: `urdf` is its file name here.
    fn build(top: &Section<'_, '_>, name: String) -> Self {
        let joints = top.tables("joint", Joint::build);
        let names: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
        if joints.is_empty() || joints.len() > MAX_JOINTS {
            top.problem("joint", format!("there are {} joints; a robot has 1 to {MAX_JOINTS}", joints.len()));
        }
        for (i, name) in names.iter().enumerate().filter(|(i, name)| names[..*i].contains(name)) {
            top.problem("joint", format!("joint[{i}]: the name `{name}` is taken already"));
        }
        let drives = drives(top, &joints);
        let feet = feet(top, &names);
        Self {
            name,
            urdf: top.text("urdf"),
            total_mass: top.number("total_mass", "kg", POSITIVE),
            torso: top.text("torso"),
            contact: top.table("contact", Contact::build).unwrap_or(Contact::NONE),
            imu: top.numbers("imu", "m", -2.0..=2.0),
            poses: poses(top, &joints),
            layout: FrameLayout::default(),
            classic: Ok(FrameLayout::default()),
            can: Can::default(),
            table_layout: FrameLayout::default(),
            tables: None,
            spare: Vec::new(),
            head: optional(top, "head", |table| Head::build(table, &joints)),
            arms: optional(top, "arms", |table| Arms::build(table, &joints)),
            legs: optional(top, "leg", |table| leg::build(table, &joints, &feet)),
            feet,
            protection: optional(top, "protection", |table| Some(Protection::build(table, &drives))),
            homes: homes(top, &joints),
            drives,
            joints,
        }
    }
}

/// A table that may be missing.
fn optional<T>(
    top: &Section<'_, '_>,
    key: &str,
    build: impl FnOnce(&Section<'_, '_>) -> Option<T>,
) -> Option<T> {
    if top.has(key) { top.table(key, build).flatten() } else { None }
}

impl Contact {
    /// Stand-in while a file is wrong.
    const NONE: Self = Self {
        normal_stiffness: f64::NAN,
        tangential_stiffness: f64::NAN,
        damping_time: f64::NAN,
        friction: f64::NAN,
        pads: None,
    };

    fn build(table: &Section<'_, '_>) -> Self {
        Self {
            pads: table.has("pads").then(|| table.table("pads", Pads::build)).flatten(),
            normal_stiffness: table.number("normal_stiffness", "N/m", STIFFNESS),
            tangential_stiffness: table.number("tangential_stiffness", "N/m", STIFFNESS),
            damping_time: table.number("damping_time", "s", POSITIVE),
            friction: table.number("friction", "", 0.0..=2.0),
        }
    }
}

impl Pads {
    fn build(table: &Section<'_, '_>) -> Self {
        Self {
            size: table.numbers("size", "m", 1e-4..=1.0),
            bricks: whole(table, "bricks"),
            modulus: table.number("modulus", "N/m^2", STIFFNESS),
            poisson: table.number("poisson", "", 0.0..=0.499),
        }
    }
}

/// Three whole numbers.
fn whole(table: &Section<'_, '_>, key: &str) -> [usize; 3] {
    let numbers: [f64; 3] = table.numbers(key, "", 1.0..=20.0);
    if numbers.iter().any(|n| n.fract() != 0.0 && n.is_finite()) {
        table.problem(key, format!("{numbers:?} are not all whole numbers"));
    }
    numbers.map(|n| n as usize)
}

impl Foot {
    /// Stand-in while a file is wrong.
    const NONE: Self = Self {
        link: String::new(),
        sole: [f64::NAN; 3],
        support: [f64::NAN; 4],
        sensor_link: String::new(),
        sensor: [f64::NAN; 3],
        points: Vec::new(),
        pads: Vec::new(),
        toe: None,
    };

    fn build(table: &Section<'_, '_>, joints: &[&str]) -> Self {
        let [back, front] = table.interval("support_x", "m", -1.0..=1.0);
        let [right, left] = table.interval("support_y", "m", -1.0..=1.0);
        let toe = table.has("toe").then(|| joint_index(table, "toe", &table.text("toe"), joints)).flatten();
        let point = |row: &Section<'_, '_>| (row.text("link"), row.numbers("at", "m", -1.0..=1.0));
        let points = table.tables("points", point);
        let pads = if table.has("pads") { table.tables("pads", point) } else { Vec::new() };
        if points.len() < 3 {
            table
                .problem("points", format!("there are {} contact points; it takes at least 3", points.len()));
        }
        Self {
            link: table.text("link"),
            sole: table.numbers("sole", "m", -1.0..=1.0),
            support: [back, front, right, left],
            sensor_link: table.text("sensor_link"),
            sensor: table.numbers("sensor", "m", -1.0..=1.0),
            points,
            pads,
            toe,
        }
    }
}

fn feet(top: &Section<'_, '_>, joints: &[&str]) -> [Foot; 2] {
    let foot = |table: &Section<'_, '_>, side| table.table(side, |foot| Foot::build(foot, joints));
    let feet =
        top.table("foot", |table| ["right", "left"].map(|side| foot(table, side).unwrap_or(Foot::NONE)));
    feet.unwrap_or([Foot::NONE, Foot::NONE])
}

/// Poses name every joint, in degrees, within its range.
fn poses(top: &Section<'_, '_>, joints: &[Joint]) -> BTreeMap<String, Vec<f64>> {
    let angle = |pose: &Section<'_, '_>, joint: &Joint| {
        let q = pose.number(&joint.name, "deg", -360.0..=360.0);
        let [lo, hi] = joint.range.map(f64::to_degrees);
        if q < lo - 1e-9 || q > hi + 1e-9 {
            pose.problem(
                &joint.name,
                format!("{q} lies outside of the joint's range_deg [{lo:.1}, {hi:.1}]"),
            );
        }
        q.to_radians()
    };
    let pose = |pose: &Section<'_, '_>| joints.iter().map(|joint| angle(pose, joint)).collect();
    let all = |table: &Section<'_, '_>| {
        let named = |name: String| table.table(&name, pose).map(|q| (name, q));
        table.keys().into_iter().filter_map(named).collect()
    };
    top.table("pose_deg", all).unwrap_or_default()
}

/// `[can]`: frames of the local controllers, in DBC files or made from what each of them drives and reads.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Can {
    /// DBC file of classic CAN, beside `robot.toml`.
    pub classic: Option<String>,
    /// DBC file of CAN FD.
    pub fd: Option<String>,
    /// Local controllers, in the order of their lines; needed where there is no file.
    pub nodes: Vec<LocalController>,
    /// The drives report the motor side, too.
    pub motor_side: bool,
    /// Drives that play tables, in scenes that want it.
    pub tables: Option<TableDrives>,
    /// Names of the local controllers that the robot can walk without.
    spare: Vec<String>,
}

impl Can {
    fn build(top: &Section<'_, '_>) -> Self {
        let build = |can: &Section<'_, '_>| {
            let file = |key| can.has(key).then(|| can.text(key));
            let nodes = if can.has("node") { can.tables("node", LocalController::build) } else { Vec::new() };
            Self {
                classic: file("classic"),
                fd: file("fd"),
                nodes,
                motor_side: can.has("motor_side") && can.flag("motor_side"),
                tables: can.has("tables").then(|| can.table("tables", TableDrives::build)).flatten(),
                spare: if can.has("spare") { can.texts("spare") } else { Vec::new() },
            }
        };
        top.table("can", build).unwrap_or_default()
    }
}

/// Frames of a robot that has no file of them.
fn written(robot: &str, can: &Can, form: FrameForm, joints: &[&str]) -> Result<FrameLayout, String> {
    if can.nodes.is_empty() {
        let key = if form == FrameForm::Fd { "fd" } else { "classic" };
        return Err(format!("can: needs `{key}`, a DBC file, or its local controllers as [[can.node]]"));
    }
    let text = dbc_text(robot, &can.nodes, can.motor_side, form)?;
    dbc::read(&text, joints).map_err(|problems| {
        let all: Vec<String> = problems.iter().map(|p| format!("{} {}", p.key, p.text)).collect();
        format!("can.node: the frames made from them: {}", all.join("; "))
    })
}

/// Local controllers by name.
fn spare(layout: &FrameLayout, names: &[String]) -> Result<Vec<usize>, String> {
    let node = |name: &String| {
        layout.nodes.iter().position(|node| node == name).ok_or_else(|| {
            let there = layout.nodes.join(", ");
            format!("can.spare: there is no local controller `{name}`; there is {there}")
        })
    };
    names.iter().map(node).collect()
}
