//! Drives of a robot: `[motor.NAME]` and `[gear.NAME]` are what is bought, `[[drive]]` what is built of it, one per joint.
//!
//! A robot without `[[drive]]` can be simulated as ideal drives only. With them, row i drives joint i: by a gear on that
//! joint, by a knee's roller screw, or as one of the two motors that share an ankle's joints.

use std::collections::BTreeMap;

use drives::{
    Ankle, AnkleGeometry, Elasticity, Friction, HarmonicFriction, JointControl, Knee, KneeGeometry, Motor,
    OutOfDomain, ScrewFriction, Transmission,
};
use messages::nearest;

use crate::brake::Brake;
use crate::joint::{Joint, joint_index};
use crate::joint_control;
use crate::section::{NOT_NEGATIVE, POSITIVE, Section};

/// One motor with everything between its terminals and its joints.
#[derive(Clone, Debug)]
pub struct Drive {
    /// Name of the motor.
    pub name: String,
    /// Name of its gear in the robot's file; empty for a linkage.
    pub gear: String,
    /// Motor angle as a function of the angles of `joints`.
    pub transmission: Transmission,
    /// Joints (indices) in the transmission's order: one, or knee, adduction and flexion.
    pub joints: Vec<usize>,
    /// Link that carries the stator.
    pub stator: String,
    /// \[1\] Unit vector of the rotor's axis in that link; motor angles count about it.
    pub axis: [f64; 3],
    /// \[kg m^2\] Inertia of rotor and whatever turns with it about its axis.
    pub rotor_inertia: f64,
    /// Electrical side.
    pub motor: Motor,
    /// \[V\] Largest voltage at the motor.
    pub voltage_limit: f64,
    /// \[A\] Largest current.
    pub current_limit: f64,
    /// Friction on the rotor.
    pub friction: Friction,
    /// Elasticity of the gear at its output; rigid if there is none.
    pub elasticity: Option<Elasticity>,
    /// Brake, if it has one.
    pub brake: Option<Brake>,
    /// \[A\], \[s\] Current that may flow for ever, and time constant of the winding's temperature, if they are known.
    pub winding: Option<[f64; 2]>,
    /// \[1\] Counts of the motor's encoder in a turn, if they are not those of the other drives.
    pub encoder_counts: Option<u32>,
    /// Joint control: the row's, or the robot's, or the scene's instead of both.
    pub control: JointControl,
}

/// `[motor.NAME]`.
#[derive(Clone, Copy)]
struct MotorType {
    motor: Motor,
    rotor_inertia: f64,
    voltage_limit: f64,
    winding: Option<[f64; 2]>,
    encoder_counts: Option<u32>,
}

/// `[gear.NAME]`: a harmonic drive.
#[derive(Clone, Copy)]
struct GearType {
    ratio: f64,
    friction: Friction,
    elasticity: Option<Elasticity>,
}

/// Transmission and friction of a row.
struct TransmissionRow {
    transmission: Transmission,
    joints: Vec<usize>,
    friction: Friction,
    elasticity: Option<Elasticity>,
}

/// Tolerance of the length of a unit vector.
const UNIT_TOLERANCE: f64 = 1e-6;
/// Angles per joint at which a linkage is tried over the joint's range.
const TRIED: usize = 17;

/// All drives of a robot: none, or one per joint.
pub(crate) fn drives(top: &Section<'_, '_>, joints: &[Joint]) -> Vec<Drive> {
    let motors = types(top, "motor", MotorType::build);
    let gears = types(top, "gear", GearType::build);
    let needed = top.has("drive") || top.has("joint_control");
    let control = if needed { top.table("joint_control", joint_control::build) } else { None };
    let control = control.unwrap_or(joint_control::NONE);
    let drives = top.tables("drive", |row| Drive::build(row, joints, &motors, &gears, control));
    if !drives.is_empty() {
        check_order(top, &drives, joints);
    }
    drives
}

/// Row i drives joint i.
fn check_order(top: &Section<'_, '_>, drives: &[Drive], joints: &[Joint]) {
    if drives.len() != joints.len() {
        let (is, wanted) = (drives.len(), joints.len());
        top.problem("drive", format!("there are {is} drives; it takes one per joint, {wanted}, or none"));
    }
    for (i, (drive, joint)) in drives.iter().zip(joints).enumerate() {
        let moved = if drive.joints.len() == 3 { &drive.joints[1..] } else { &drive.joints[..] };
        if !drive.joints.is_empty() && !moved.contains(&i) {
            let text = format!("drive[{i}], `{}`, must drive joint[{i}], `{}`", drive.name, joint.name);
            top.problem("drive", text);
        }
    }
}

/// The named tables below `key`; none if it is missing.
fn types<T>(top: &Section<'_, '_>, key: &str, build: impl Fn(&Section<'_, '_>) -> T) -> BTreeMap<String, T> {
    let all = |table: &Section<'_, '_>| {
        let named = |name: String| table.table(&name, &build).map(|t| (name, t));
        table.keys().into_iter().filter_map(named).collect()
    };
    if top.has(key) { top.table(key, all).unwrap_or_default() } else { BTreeMap::new() }
}

/// The type that `key` names.
fn named<T: Copy>(row: &Section<'_, '_>, key: &str, types: &BTreeMap<String, T>) -> Option<T> {
    let name = row.text(key);
    let found = types.get(&name).copied();
    if found.is_none() && !name.is_empty() {
        let names: Vec<&str> = types.keys().map(String::as_str).collect();
        let hint = nearest(&name, &names).map_or(String::new(), |n| format!("; the nearest is `{n}`"));
        row.problem(key, format!("there is no [{key}.{name}]{hint}"));
    }
    found
}

impl MotorType {
    /// Stand-in while a file is wrong.
    const NONE: Self = Self {
        motor: Motor { inductance: f64::NAN, resistance: f64::NAN, torque_constant: f64::NAN },
        rotor_inertia: f64::NAN,
        voltage_limit: f64::NAN,
        winding: Some([f64::NAN; 2]),
        encoder_counts: None,
    };

    fn build(table: &Section<'_, '_>) -> Self {
        Self {
            motor: Motor {
                inductance: table.number("inductance", "H", POSITIVE),
                resistance: table.number("resistance", "Ohm", POSITIVE),
                torque_constant: table.number("torque_constant", "N m/A", POSITIVE),
            },
            rotor_inertia: table.number("rotor_inertia", "kg m^2", POSITIVE),
            voltage_limit: table.number("voltage_limit", "V", POSITIVE),
            winding: table.has("continuous_current").then(|| {
                let current = table.number("continuous_current", "A", POSITIVE);
                [current, table.number("thermal_time", "s", POSITIVE)]
            }),
            encoder_counts: joint_control::encoder_counts(table),
        }
    }
}

impl GearType {
    fn build(table: &Section<'_, '_>) -> Self {
        let ratio = table.number("ratio", "", -1000.0..=1000.0);
        if ratio.abs() < 1.0 {
            table.problem(
                "ratio",
                format!("{ratio} is not allowed; a gear's ratio is at least 1, or at most -1"),
            );
        }
        let friction = if table.has("friction") { table.table("friction", harmonic_friction) } else { None };
        let elasticity = if table.has("elasticity") { table.table("elasticity", elasticity) } else { None };
        Self { ratio, friction: friction.unwrap_or(Friction::Free), elasticity }
    }
}

fn harmonic_friction(table: &Section<'_, '_>) -> Friction {
    Friction::Harmonic(HarmonicFriction {
        starting: table.number("starting", "N m", NOT_NEGATIVE),
        load: table.number("load", "", 0.0..=0.99),
        viscous: table.number("viscous", "N m s/rad", NOT_NEGATIVE),
        coupled: table.number("coupled", "s/rad", NOT_NEGATIVE),
    })
}

fn elasticity(table: &Section<'_, '_>) -> Elasticity {
    Elasticity {
        stiffness: table.numbers("stiffness", "N m/rad", POSITIVE),
        knees: table.interval("knees", "N m", POSITIVE),
    }
}

impl Drive {
    fn build(
        row: &Section<'_, '_>,
        joints: &[Joint],
        motors: &BTreeMap<String, MotorType>,
        gears: &BTreeMap<String, GearType>,
        control: JointControl,
    ) -> Self {
        let own =
            if row.has("joint_control") { row.table("joint_control", joint_control::build) } else { None };
        let bought = named(row, "motor", motors).unwrap_or(MotorType::NONE);
        let train = TransmissionRow::build(row, joints, gears);
        let mut drive = Self {
            name: row.text("name"),
            gear: if row.has("gear") { row.text("gear") } else { String::new() },
            transmission: train.transmission,
            joints: train.joints,
            stator: row.text("stator"),
            axis: unit(row, "axis"),
            rotor_inertia: bought.rotor_inertia,
            motor: bought.motor,
            voltage_limit: bought.voltage_limit,
            current_limit: row.number("current_limit", "A", POSITIVE),
            friction: train.friction,
            elasticity: train.elasticity,
            brake: Brake::of(row),
            winding: bought.winding,
            encoder_counts: bought.encoder_counts,
            control,
        };
        drive.set_control(own.unwrap_or(control));
        drive
    }

    /// Controls it like this; where counts are asked for, an encoder with a number of its own keeps it.
    pub(crate) fn set_control(&mut self, control: JointControl) {
        self.control = control;
        if let Some(counts) = &mut self.control.resolution.encoder_counts {
            *counts = self.encoder_counts.unwrap_or(*counts);
        }
    }
}

impl TransmissionRow {
    /// Stand-in while a file is wrong.
    const NONE: Self = Self {
        transmission: Transmission::Harmonic { ratio: f64::NAN },
        joints: Vec::new(),
        friction: Friction::Free,
        elasticity: None,
    };

    fn build(row: &Section<'_, '_>, joints: &[Joint], gears: &BTreeMap<String, GearType>) -> Self {
        let kinds = ["gear", "knee", "ankle"];
        let given: Vec<&str> = kinds.into_iter().filter(|kind| row.has(kind)).collect();
        match given.as_slice() {
            ["gear"] => Self::gear(row, joints, gears),
            ["knee"] => row.table("knee", |table| Self::knee(table, joints)).unwrap_or(Self::NONE),
            ["ankle"] => row.table("ankle", |table| Self::ankle(table, joints)).unwrap_or(Self::NONE),
            _ => {
                row.problem("gear", "a drive takes exactly one of `gear`, `knee`, `ankle`");
                Self::NONE
            }
        }
    }

    fn gear(row: &Section<'_, '_>, joints: &[Joint], gears: &BTreeMap<String, GearType>) -> Self {
        let moved = index(row, "joint", joints);
        let Some(gear) = named(row, "gear", gears) else { return Self::NONE };
        if let Some(joint) = moved.map(|i| &joints[i]) {
            let (fastest, limit) = (joint.speed_limit * gear.ratio.abs(), gear.friction.speed_limit());
            if fastest >= limit {
                let name = &joint.name;
                let text = format!(
                    "its friction holds below {limit:.0} rad/s of the motor, but speed_limit of `{name}` asks for \
                     {fastest:.0}"
                );
                row.problem("gear", text);
            }
        }
        Self {
            transmission: Transmission::Harmonic { ratio: gear.ratio },
            joints: moved.into_iter().collect(),
            friction: gear.friction,
            elasticity: gear.elasticity,
        }
    }

    fn knee(table: &Section<'_, '_>, joints: &[Joint]) -> Self {
        let moved = index(table, "joint", joints);
        let geometry = KneeGeometry {
            axis: unit(table, "axis"),
            joint: point(table, "joint_at"),
            pivot: point(table, "pivot"),
            attachment: point(table, "attachment"),
            lead: lead(table),
        };
        let made = Knee::new(&geometry).map(Transmission::Knee);
        Self::linkage(table, &made, moved.into_iter().collect(), joints)
    }

    fn ankle(table: &Section<'_, '_>, joints: &[Joint]) -> Self {
        let moved = ["knee", "adduction", "flexion"].map(|key| index(table, key, joints));
        let geometry = AnkleGeometry {
            adduction_axis: unit(table, "adduction_axis"),
            flexion_axis: unit(table, "flexion_axis"),
            ankle: point(table, "ankle_at"),
            foot: point(table, "foot_at"),
            screw_top: point(table, "screw_top"),
            screw_axis: unit(table, "screw_axis"),
            attachment: point(table, "attachment"),
            coupler: table.number("coupler", "m", 1e-3..=2.0),
            lead: lead(table),
            bevel: table.number("bevel", "", -100.0..=100.0),
            belt: table.number("belt", "", -100.0..=100.0),
            knee_share: table.number("knee_share", "", -1.0..=1.0),
        };
        let made = Ankle::new(&geometry).map(Transmission::Ankle);
        Self::linkage(table, &made, moved.into_iter().flatten().collect(), joints)
    }

    /// A linkage that works over the ranges of its joints.
    fn linkage(
        table: &Section<'_, '_>,
        made: &Result<Transmission, OutOfDomain>,
        moved: Vec<usize>,
        joints: &[Joint],
    ) -> Self {
        let [direct, indirect] = table.numbers("efficiency", "", 0.01..=1.0);
        let tried = (*made).and_then(|t| {
            if moved.len() == t.joints() { over_range(&t, &moved, joints).map(|()| t) } else { Ok(t) }
        });
        let transmission = tried.unwrap_or_else(|e| {
            if e != OutOfDomain::NotFinite {
                table.problem("attachment", format!("{e}, within range_deg of its joints"));
            }
            Self::NONE.transmission
        });
        let friction = Friction::Screw(ScrewFriction { direct, indirect });
        Self { transmission, joints: moved, friction, elasticity: None }
    }
}

/// Tries a linkage over the ranges of its joints.
fn over_range(transmission: &Transmission, moved: &[usize], joints: &[Joint]) -> Result<(), OutOfDomain> {
    let angle = |slot: usize, i: usize| {
        let [lo, hi] = moved.get(slot).map_or([0.0; 2], |j| joints[*j].range);
        lo + (hi - lo) * i as f64 / (TRIED - 1) as f64
    };
    let all = (0..TRIED).flat_map(|i| (0..TRIED).map(move |j| (i, j)));
    all.map(|(i, j)| if moved.len() == 1 { [angle(0, i), 0.0, 0.0] } else { [0.0, angle(1, i), angle(2, j)] })
        .try_for_each(|q| transmission.at(q, [0.0; 3]).map(|_| ()))
}

/// The joint that a key names.
fn index(at: &Section<'_, '_>, key: &str, joints: &[Joint]) -> Option<usize> {
    let names: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
    joint_index(at, key, &at.text(key), &names)
}

fn point(table: &Section<'_, '_>, key: &str) -> [f64; 3] {
    table.numbers(key, "m", -2.0..=2.0)
}

fn lead(table: &Section<'_, '_>) -> f64 {
    let lead = table.number("lead", "m/rev", -1.0..=1.0);
    if lead.abs() < 1e-6 {
        table.problem("lead", format!("{lead} is not allowed; a screw's lead is not zero"));
    }
    lead
}

fn unit(table: &Section<'_, '_>, key: &str) -> [f64; 3] {
    let v = table.numbers::<3>(key, "", -1.0..=1.0);
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    if (length - 1.0).abs() > UNIT_TOLERANCE {
        table.problem(key, format!("has the length {length:.6}; it takes a unit vector"));
    }
    v
}
