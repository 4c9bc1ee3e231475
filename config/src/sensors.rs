//! What a scene says about its sensors: `[sensors]`. Each error stands alone; what is not named is measured exactly.
//!
//! | table | sensor | thesis |
//! |---|---|---|
//! | `encoder` | absolute encoders at the joints | 2.5.1 |
//! | `motor_encoder` | incremental encoders on the motor shafts | 2.5.1 |
//! | `force_torque` | between ankle and foot | 2.5.2 |
//! | `imu` | on the upper body | 2.5.3 |
//!
//! Numbers that belong to joints are one number for all, or a table of joints in which `all` stands for the others:
//! `bits = { all = 17, right_ankle_flexion = 16 }`.

use std::ops::RangeInclusive;

use messages::nearest;

use crate::section::Section;

/// `[sensors]` of a scene. The default measures exactly.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SensorErrors {
    /// Encoders that the joint angles and speeds of the record come from.
    pub side: EncoderSide,
    /// Encoders on the link side; resolution per turn of the joint.
    pub encoder: EncoderErrors,
    /// Encoders on the motor side; resolution per turn of the joint: counts of the motor times gear ratio.
    pub motor_encoder: EncoderErrors,
    /// Both feet.
    pub force_torque: ForceTorqueErrors,
    /// Upper body.
    pub imu: ImuErrors,
}

/// Where joint angles are measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EncoderSide {
    /// At the joint.
    #[default]
    Link,
    /// On the motor's shaft, divided by the gear ratio: all there is where a robot has no absolute encoders.
    Motor,
}

/// Errors of the encoders of one side.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EncoderErrors {
    /// \[1\] Counts per turn of the joint; not quantised where a joint has none.
    pub counts: PerJoint,
    /// \[rad\] Static error of calibration, added to the angle.
    pub bias: PerJoint,
    /// Speed by finite differences of the measured angle over one cycle.
    pub speed_by_difference: bool,
    /// \[s\] Dead time.
    pub delay: f64,
}

/// Errors of the force/torque sensors. Zeros stand for "none".
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceTorqueErrors {
    /// Weight and inertia of the bodies below the sensor are measured, too.
    pub inertia: bool,
    /// Sensors are set to zero while the robot hangs with level feet.
    pub bias_compensation: bool,
    /// \[N, N m\] Offset that is read too much in each direction until the sensors are set to zero.
    pub offset: [f64; 2],
    /// \[s\] Time constant of the anti-aliasing filter.
    pub filter_time: f64,
    /// \[N, N m\] Standard deviation of the white noise of forces and of moments.
    pub noise: [f64; 2],
    /// \[N, N m\] Quantisation of forces and of moments.
    pub step: [f64; 2],
    /// \[N\] Largest force in x, y, z; infinite where there is no limit.
    pub force_range: [f64; 3],
    /// \[N m\] Largest moment about x, y, z; infinite where there is no limit.
    pub moment_range: [f64; 3],
    /// \[s\] Dead time.
    pub delay: f64,
}

impl Default for ForceTorqueErrors {
    fn default() -> Self {
        Self {
            inertia: false,
            bias_compensation: false,
            offset: [0.0; 2],
            filter_time: 0.0,
            noise: [0.0; 2],
            step: [0.0; 2],
            force_range: [f64::INFINITY; 3],
            moment_range: [f64::INFINITY; 3],
            delay: 0.0,
        }
    }
}

/// Errors of the inertial measurement unit. Zeros stand for "none".
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImuErrors {
    /// \[Hz\] Cut-off frequency of the first-order low pass of all three signals; 0: none.
    pub bandwidth: f64,
    /// \[rad\] Rotation vector from the torso to the misaligned sensor; on the orientation only.
    pub bias: [f64; 3],
    /// Of the orientation \[rad\].
    pub orientation: SignalErrors,
    /// Of the angular velocity \[rad/s\].
    pub rate: SignalErrors,
    /// Of the specific force \[m/s^2\].
    pub acceleration: SignalErrors,
    /// \[s\] Time between two readings, in whole cycles; 0: one in every cycle.
    pub period: f64,
    /// \[s\] Dead time.
    pub delay: f64,
}

/// Noise, quantisation and range of one signal, in its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignalErrors {
    /// Standard deviation of the white noise of each component.
    pub noise: f64,
    /// Quantisation.
    pub step: f64,
    /// Largest absolute value of each component; infinite where there is no limit, as for orientations.
    pub range: f64,
}

impl Default for SignalErrors {
    fn default() -> Self {
        Self { noise: 0.0, step: 0.0, range: f64::INFINITY }
    }
}

/// A number per joint, or one for all.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PerJoint {
    /// For joints that are not named.
    pub all: Option<f64>,
    /// By name of the joint.
    pub own: Vec<(String, f64)>,
}

/// \[1\] Most counts per turn of an encoder: 32 bit.
const MOST_COUNTS: f64 = 4_294_967_296.0;

impl SensorErrors {
    pub(crate) fn build(table: &Section<'_, '_>) -> Self {
        let sides = [EncoderSide::Link, EncoderSide::Motor];
        Self {
            side: optional(table, "side", |t, key| sides[t.word(key, &["link", "motor"])]),
            encoder: optional(table, "encoder", |t, key| {
                t.table(key, EncoderErrors::link).unwrap_or_default()
            }),
            motor_encoder: optional(table, "motor_encoder", |t, key| {
                t.table(key, EncoderErrors::motor).unwrap_or_default()
            }),
            force_torque: optional(table, "force_torque", |t, key| {
                t.table(key, ForceTorqueErrors::build).unwrap_or_default()
            }),
            imu: optional(table, "imu", |t, key| t.table(key, ImuErrors::build).unwrap_or_default()),
        }
    }

    /// What the joints named here are wrong about: key, text.
    pub(crate) fn unknown_joints(&self, robot: &str, joints: &[&str]) -> Vec<(String, String)> {
        let tables = [("encoder", "bits", &self.encoder), ("motor_encoder", "counts", &self.motor_encoder)];
        let named = tables.iter().flat_map(|(table, of_counts, e)| {
            let keys = [(*of_counts, &e.counts), ("bias_rad", &e.bias)];
            keys.into_iter()
                .flat_map(move |(key, per)| per.own.iter().map(move |(name, _)| (table, key, name)))
        });
        let mut problems = Vec::new();
        for (table, key, name) in named.filter(|(_, _, name)| !joints.contains(&name.as_str())) {
            let near = nearest(name, joints).unwrap_or("none");
            let text = format!("robot {robot} has no joint `{name}`; the nearest is `{near}`");
            problems.push((format!("sensors.{table}.{key}"), text));
        }
        problems
    }
}

impl EncoderErrors {
    fn link(table: &Section<'_, '_>) -> Self {
        let mut counts = PerJoint::build(table, "bits", "bit", 1.0..=32.0);
        for bits in counts.values() {
            if bits.fract() != 0.0 && !bits.is_nan() {
                table.problem("bits", format!("{bits} is not a whole number"));
            }
            *bits = bits.exp2(); // 2^Q counts: errata 1, V15
        }
        Self { counts, ..Self::any(table) }
    }

    fn motor(table: &Section<'_, '_>) -> Self {
        let mut counts = PerJoint::build(table, "counts", "counts per turn", 2.0..=MOST_COUNTS);
        if table.has("counts") || table.has("gear_ratio") {
            let ratio = if table.has("gear_ratio") {
                PerJoint::build(table, "gear_ratio", "", 1.0..=1e4)
            } else {
                table.problem("gear_ratio", "missing; counts are those of one turn of the motor");
                PerJoint::default()
            };
            counts = counts.times(&ratio);
        }
        Self { counts, ..Self::any(table) }
    }

    /// What both sides have.
    fn any(table: &Section<'_, '_>) -> Self {
        Self {
            counts: PerJoint::default(),
            bias: PerJoint::build(table, "bias_rad", "rad", -1.0..=1.0),
            speed_by_difference: table.flag("speed_by_difference"),
            delay: delay(table),
        }
    }
}

impl ForceTorqueErrors {
    fn build(table: &Section<'_, '_>) -> Self {
        let range = |key, unit| match table.has(key) {
            true => table.numbers(key, unit, 1e-3..=1e6),
            false => [f64::INFINITY; 3],
        };
        let pair = |key| optional(table, key, |t, key| t.numbers(key, "N, N m", 0.0..=1e4));
        let built = Self {
            inertia: table.flag("inertia"),
            bias_compensation: table.flag("bias_compensation"),
            offset: if table.has("offset") {
                table.numbers("offset", "N, N m", -500.0..=500.0)
            } else {
                [0.0; 2]
            },
            filter_time: optional(table, "filter_time", |t, key| t.number(key, "s", 0.0..=1.0)),
            noise: pair("noise"),
            step: pair("step"),
            force_range: range("force_range", "N"),
            moment_range: range("moment_range", "N m"),
            delay: delay(table),
        };
        if built.bias_compensation && !built.inertia {
            table.problem(
                "bias_compensation",
                "takes away the weight below the sensor: it needs inertia = true",
            );
        }
        built
    }
}

impl ImuErrors {
    fn build(table: &Section<'_, '_>) -> Self {
        let number = |key: String, unit: &str, most: f64| {
            optional(table, &key, |t, key| t.number(key, unit, 0.0..=most))
        };
        let signal = |name: &str, unit: &str, most: f64| SignalErrors {
            noise: number(format!("{name}_noise"), unit, most),
            step: number(format!("{name}_step"), unit, most),
            range: f64::INFINITY,
        };
        let ranged = |name: &str, unit: &str| {
            let key = format!("{name}_range");
            let range = if table.has(&key) { table.number(&key, unit, 1e-3..=1e6) } else { f64::INFINITY };
            SignalErrors { range, ..signal(name, unit, 1e3) }
        };
        Self {
            bandwidth: optional(table, "bandwidth", |t, key| t.number(key, "Hz", 1e-3..=1e5)),
            bias: optional(table, "bias_rad", |t, key| t.numbers(key, "rad", -1.0..=1.0)),
            orientation: signal("orientation", "rad", 0.1),
            rate: ranged("rate", "rad/s"),
            acceleration: ranged("acceleration", "m/s^2"),
            period: optional(table, "period", |t, key| t.number(key, "s", 0.0..=0.1)),
            delay: delay(table),
        }
    }
}

impl PerJoint {
    /// The number of a joint, if it has one.
    pub fn of(&self, joint: &str) -> Option<f64> {
        let own = self.own.iter().find(|(name, _)| name == joint).map(|(_, x)| *x);
        own.or(self.all)
    }

    pub(crate) fn build(table: &Section<'_, '_>, key: &str, unit: &str, range: RangeInclusive<f64>) -> Self {
        if !table.has(key) {
            return Self::default();
        }
        if !table.is_table(key) {
            return Self { all: Some(table.number(key, unit, range)), own: Vec::new() };
        }
        let rows = |joints: &Section<'_, '_>| {
            let mut per = Self::default();
            for name in joints.keys() {
                let x = joints.number(&name, unit, range.clone());
                if name == "all" { per.all = Some(x) } else { per.own.push((name, x)) }
            }
            per
        };
        table.table(key, rows).unwrap_or_default()
    }

    fn values(&mut self) -> impl Iterator<Item = &mut f64> {
        self.all.iter_mut().chain(self.own.iter_mut().map(|(_, x)| x))
    }

    /// Joint by joint; a joint that either of both lacks has no product.
    fn times(&self, other: &Self) -> Self {
        let product = |name: &str| Some(self.of(name)? * other.of(name)?);
        let names = self.own.iter().chain(&other.own).map(|(name, _)| name);
        let mut own: Vec<(String, f64)> = Vec::new();
        for name in names {
            if let Some(x) = product(name).filter(|_| !own.iter().any(|(known, _)| known == name)) {
                own.push((name.clone(), x));
            }
        }
        Self { all: self.all.zip(other.all).map(|(a, b)| a * b), own }
    }
}

/// Dead time \[s\]; none if it is not there.
fn delay(table: &Section<'_, '_>) -> f64 {
    optional(table, "delay", |t, key| t.number(key, "s", 0.0..=0.1))
}

/// Asks for a key only if it is there.
fn optional<T: Default>(
    table: &Section<'_, '_>,
    key: &str,
    read: impl FnOnce(&Section<'_, '_>, &str) -> T,
) -> T {
    if table.has(key) { read(table, key) } else { T::default() }
}
