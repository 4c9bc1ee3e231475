//! Sensors: from the truth to readings (thesis 2.5).
//!
//! | part | where |
//! |---|---|
//! | joint encoders | [`encoder`] |
//! | force/torque sensors of the feet | [`force_torque`] |
//! | inertial measurement unit | [`imu`] |
//! | limited bandwidth | [`low_pass`] |
//! | noise, quantisation, range | [`converter`] |
//! | dead time | [`delay_line`] |
//! | what the force sensors carry | [`carried`] |
//! | random numbers | [`noise`] |
//!
//! A sensor that the scene does not name copies the truth, bit for bit, and computes nothing. Filters and dead times are
//! before the sampling, in the time of the integration's steps; noise and converters are after it, once per cycle.

pub mod carried;
pub mod converter;
pub mod delay_line;
pub mod encoder;
pub mod force_torque;
pub mod imu;
pub mod low_pass;
pub mod noise;

use config::Robot;
use config::sensors::EncoderSide;
use messages::{Joints, Sensors, Wrench};

use encoder::Encoders;
use force_torque::ForceTorqueSensor;
use imu::ImuSensor;
use noise::Noise;

/// Everything that sensors see, at the end of a cycle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Truth {
    /// \[rad\] Link side.
    pub joint_angle: Joints,
    /// \[rad/s\] Link side.
    pub joint_speed: Joints,
    /// \[rad\] Motor side, divided by the gear ratio.
    pub motor_angle: Joints,
    /// \[rad/s\] Motor side, divided by the gear ratio.
    pub motor_speed: Joints,
    /// \[A\] NaN where a drive has no current sensor.
    pub motor_current: Joints,
    /// \[N, N m\] @sensor frame: ground on the bodies below each sensor; right, left.
    pub contact: [Wrench; 2],
    /// \[N, N m\] @sensor frame: what moves and carries the bodies below each sensor, sum of m (a - g); right, left.
    pub inertial: [Wrench; 2],
    /// Orientation \[1\], angular velocity \[rad/s\] and specific force \[m/s^2\] of the upper body.
    pub imu: messages::Imu,
}

/// Faults of one cycle's readings. Anything but zeros deserves an event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ReadingFaults {
    /// Numbers that are not finite: they stand in the record as NaN, and their frames must not be sent.
    pub invalid: u32,
    /// Numbers beyond the range of their sensor: they stand in the record as its limit.
    pub clipped: u32,
}

/// All sensors of one robot.
#[derive(Clone, Debug)]
pub struct SensorSet {
    joints: usize,
    side: EncoderSide,
    link: Option<Encoders>,
    motor: Option<Encoders>,
    feet: Option<[ForceTorqueSensor; 2]>,
    imu: Option<ImuSensor>,
    /// True if a filter or a dead time asks for what is between two readings.
    analogue: bool,
    /// Steps of the integration in a cycle; of these observed since the last reading; none before the first one.
    steps: u32,
    observed: Option<u32>,
}

/// First stream of the noise of each sensor.
const STREAM_FEET: u64 = 0x100;
const STREAM_IMU: u64 = 0x200;

impl SensorSet {
    /// Sensors of `robot`, read once per `cycle` \[s\] of so many `steps` of the integration; noise from `seed`.
    ///
    /// `hanging`: wrench that carries the bodies below each force sensor while the robot hangs at rest with level feet,
    /// see [`carried::hanging`]; it is used where the scene asks for compensation of the bias.
    pub fn new(
        errors: &config::SensorErrors,
        robot: &Robot,
        hanging: &[Wrench; 2],
        seed: u64,
        (cycle, steps): (f64, u32),
    ) -> Self {
        let step = cycle / f64::from(steps);
        let encoders = |e: &config::sensors::EncoderErrors| {
            (*e != Default::default()).then(|| Encoders::new(e, robot, cycle, step))
        };
        let stream = |first: u64| move |i: u64| Noise::new(seed, first + i);
        let foot = |i: usize| {
            ForceTorqueSensor::new(
                &errors.force_torque,
                &hanging[i],
                step,
                stream(STREAM_FEET + 6 * i as u64),
            )
        };
        Self {
            joints: robot.joints.len().min(messages::MAX_JOINTS),
            side: errors.side,
            link: encoders(&errors.encoder),
            motor: encoders(&errors.motor_encoder),
            feet: (errors.force_torque != Default::default()).then(|| [foot(0), foot(1)]),
            imu: (errors.imu != Default::default())
                .then(|| ImuSensor::new(&errors.imu, cycle, step, stream(STREAM_IMU))),
            analogue: [
                errors.encoder.delay,
                errors.motor_encoder.delay,
                errors.force_torque.filter_time,
                errors.force_torque.delay,
                errors.imu.bandwidth,
                errors.imu.delay,
            ]
            .iter()
            .any(|x| *x > 0.0),
            steps,
            observed: None,
        }
    }

    /// True if [`SensorSet::observe`] is to see the steps within a cycle.
    pub fn is_analogue(&self) -> bool {
        self.analogue
    }

    /// One more step of the integration within a cycle.
    pub fn observe(&mut self, truth: &Truth) {
        self.observed = self.observed.map(|steps| steps + 1);
        if let Some(encoders) = &mut self.link {
            encoders.observe([&truth.joint_angle, &truth.joint_speed]);
        }
        if let Some(encoders) = &mut self.motor {
            encoders.observe([&truth.motor_angle, &truth.motor_speed]);
        }
        if let Some(feet) = &mut self.feet {
            for (i, foot) in feet.iter_mut().enumerate() {
                foot.observe(&truth.contact[i], &truth.inertial[i]);
            }
        }
        if let Some(imu) = &mut self.imu {
            imu.observe(&truth.imu);
        }
    }

    /// True if the force sensors ask for [`Truth::inertial`]; it costs the caller an inverse dynamics.
    pub fn needs_inertia(&self) -> bool {
        self.feet.as_ref().is_some_and(|[right, _]| right.needs_inertia())
    }

    /// Writes the readings of one cycle into `out`; header, supply and counters of the record stay as they are. `truth` is
    /// that at its end; steps that nobody has observed were like it.
    pub fn measure(&mut self, truth: &Truth, out: &mut Sensors) -> ReadingFaults {
        let mut report = ReadingFaults::default();
        while self.analogue && self.observed.is_some_and(|steps| steps + 1 < self.steps) {
            self.observe(truth);
        }
        self.observed = Some(0);
        self.measure_joints(truth, out);
        out.foot_wrench = match &mut self.feet {
            Some(feet) => std::array::from_fn(|i| {
                feet[i].observe(&truth.contact[i], &truth.inertial[i]);
                feet[i].measure(&mut report.clipped)
            }),
            None => truth.contact,
        };
        out.imu = match &mut self.imu {
            Some(imu) => imu.measure(&truth.imu, &mut report.clipped),
            None => truth.imu,
        };
        report.invalid = self.invalid(out);
        report
    }

    fn measure_joints(&mut self, truth: &Truth, out: &mut Sensors) {
        let n = self.joints;
        read(
            &mut self.link,
            n,
            [&truth.joint_angle, &truth.joint_speed],
            [&mut out.joint_angle, &mut out.joint_speed],
        );
        read(
            &mut self.motor,
            n,
            [&truth.motor_angle, &truth.motor_speed],
            [&mut out.motor_angle, &mut out.motor_speed],
        );
        if self.side == EncoderSide::Motor {
            out.joint_angle[..n].copy_from_slice(&out.motor_angle[..n]);
            out.joint_speed[..n].copy_from_slice(&out.motor_speed[..n]);
        }
        out.motor_current[..n].copy_from_slice(&truth.motor_current[..n]);
    }

    /// Numbers that are not finite; a current may be missing.
    fn invalid(&self, s: &Sensors) -> u32 {
        let joints = [&s.joint_angle, &s.joint_speed, &s.motor_angle, &s.motor_speed];
        let joints = joints.into_iter().flat_map(|x| &x[..self.joints]);
        let feet = s.foot_wrench.iter().flat_map(|w| w.force.iter().chain(&w.moment));
        let imu = s.imu.orientation.iter().chain(&s.imu.angular_velocity).chain(&s.imu.acceleration);
        joints.chain(feet).chain(imu).filter(|x| !x.is_finite()).count() as u32
    }
}

/// Angles and speeds of one side; exact without encoders.
fn read(encoders: &mut Option<Encoders>, n: usize, truth: [&Joints; 2], out: [&mut Joints; 2]) {
    match encoders {
        Some(encoders) => {
            encoders.observe(truth);
            encoders.measure(out);
        }
        None => {
            for (out, truth) in out.into_iter().zip(truth) {
                out[..n].copy_from_slice(&truth[..n]);
            }
        }
    }
}
