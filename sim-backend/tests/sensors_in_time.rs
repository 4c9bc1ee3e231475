//! Sensors in time: filters and dead times before the sampling.

use std::f64::consts::TAU;

use config::Robot;
use config::sensors::{EncoderErrors, ForceTorqueErrors, ImuErrors};
use messages::{Sensors, Wrench};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use sim_backend::sensors::{SensorSet, Truth};

const CYCLE: f64 = 1e-3;

/// Sensors of Lola with so many steps of the integration per cycle.
fn set(errors: &config::SensorErrors, steps: u32) -> SensorSet {
    let robot = Robot::load(&config::root(None).join("robots/lola")).unwrap();
    SensorSet::new(errors, &robot, &[Wrench::default(); 2], 7, (CYCLE, steps))
}

fn at_rest() -> Truth {
    let mut truth = Truth::default();
    truth.imu.orientation[3] = 1.0;
    truth
}

fn measure(set: &mut SensorSet, truth: &Truth) -> Sensors {
    let mut out = Sensors::default();
    set.measure(truth, &mut out);
    out
}

fn orientation(s: &Sensors) -> UnitQuaternion<f64> {
    let [x, y, z, w] = s.imu.orientation;
    UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z))
}

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a}, not {b} within {tolerance}");
}

#[test]
fn dead_time_and_period() {
    let errors = config::SensorErrors {
        encoder: EncoderErrors { delay: 0.002, ..Default::default() },
        force_torque: ForceTorqueErrors { delay: 0.001, ..Default::default() },
        imu: ImuErrors { period: 0.005, ..Default::default() },
        ..Default::default()
    };
    let (mut set, mut truth) = (set(&errors, 1), at_rest());
    for k in 0..20 {
        let x = f64::from(k);
        (truth.joint_angle[3], truth.contact[0].force[2], truth.imu.acceleration[0]) = (x, x, x);
        let out = measure(&mut set, &truth);
        assert_eq!(out.joint_angle[3], (x - 2.0).max(0.0));
        assert_eq!(out.foot_wrench[0].force[2], (x - 1.0).max(0.0));
        assert_eq!(out.imu.acceleration[0], f64::from(k / 5 * 5));
    }
}

/// Amplitude of the readings of a sine of amplitude 1 and `frequency` \[Hz\], once per [`CYCLE`], from the phases in which it
/// may meet the readings; `look` sets it and reads it.
fn amplitude(
    errors: &config::SensorErrors,
    frequency: f64,
    look: impl Fn(&mut Truth, f64) + Copy,
    read: impl Fn(&Sensors) -> f64,
) -> f64 {
    const STEPS: u32 = 50;
    let mut largest = 0.0_f64;
    for phase in 0..45 {
        let (mut set, mut truth) = (set(errors, STEPS), at_rest());
        let at = |step: u32, truth: &mut Truth| {
            let t = f64::from(step) * CYCLE / f64::from(STEPS);
            look(truth, (TAU * (frequency * t + f64::from(phase) / 45.0)).sin());
        };
        for step in 0..60 * STEPS {
            at(step, &mut truth);
            if step % STEPS == 0 {
                let reading = read(&measure(&mut set, &truth));
                largest = if step > 40 * STEPS { largest.max(reading.abs()) } else { largest };
            } else if set.is_analogue() {
                set.observe(&truth);
            }
        }
    }
    largest
}

/// Ripple that the sampling folds to another frequency is damped before, by 1/sqrt(1 + (w T)^2): of 1 kHz, which every
/// reading meets at the same phase, 0.157 is left behind a filter of 1 ms, and all of it behind none.
#[test]
fn filters_are_before_the_sampling() {
    let force = |truth: &mut Truth, x: f64| truth.contact[0].force[2] = x;
    let filtered = |time| {
        let force_torque = ForceTorqueErrors { filter_time: time, ..Default::default() };
        config::SensorErrors { force_torque, ..Default::default() }
    };
    for (time, frequency) in [(1e-3, 1000.0), (1e-3, 730.0), (0.4e-3, 1650.0), (3e-3, 2000.0)] {
        let expected = 1.0 / (1.0 + (TAU * frequency * time) * (TAU * frequency * time)).sqrt();
        let measured = amplitude(&filtered(time), frequency, force, |s| s.foot_wrench[0].force[2]);
        close(measured, expected, 0.02 * expected);
    }
    close(amplitude(&filtered(0.0), 1000.0, force, |s| s.foot_wrench[0].force[2]), 1.0, 0.02);
    let rate = |truth: &mut Truth, x: f64| truth.imu.angular_velocity[1] = x;
    let imu = ImuErrors { bandwidth: 100.0, ..Default::default() };
    let slow = config::SensorErrors { imu, ..Default::default() };
    let expected = 1.0 / 101.0_f64.sqrt();
    close(amplitude(&slow, 1000.0, rate, |s| s.imu.angular_velocity[1]), expected, 0.02 * expected);
}

/// Half a cycle of dead time is half a cycle, for every sensor.
#[test]
fn dead_times_need_not_be_whole_cycles() {
    let delay = 0.0003;
    let errors = config::SensorErrors {
        encoder: EncoderErrors { delay, ..Default::default() },
        motor_encoder: EncoderErrors { delay, ..Default::default() },
        force_torque: ForceTorqueErrors { delay, ..Default::default() },
        imu: ImuErrors { delay, ..Default::default() },
        ..Default::default()
    };
    let (steps, mut truth) = (4, at_rest());
    let mut set = set(&errors, steps);
    for step in 0..40 {
        let t = f64::from(step) * CYCLE / f64::from(steps);
        truth.joint_angle[3] = t;
        truth.motor_speed[4] = 2.0 * t;
        truth.contact[1].moment[0] = 3.0 * t;
        truth.imu.angular_velocity[2] = 4.0 * t;
        truth.imu.orientation =
            UnitQuaternion::from_scaled_axis(Vector3::new(0.1, 0.2, 5.0 * t)).coords.into();
        if step % steps != 0 {
            set.observe(&truth);
            continue;
        }
        let out = measure(&mut set, &truth);
        if step > 2 * steps {
            let then = t - delay;
            close(out.joint_angle[3], then, 1e-15);
            close(out.motor_speed[4], 2.0 * then, 1e-15);
            close(out.foot_wrench[1].moment[0], 3.0 * then, 1e-15);
            close(out.imu.angular_velocity[2], 4.0 * then, 1e-15);
            let there = UnitQuaternion::from_scaled_axis(Vector3::new(0.1, 0.2, 5.0 * then));
            assert!(orientation(&out).angle_to(&there) < 1e-7, "{}", orientation(&out).angle_to(&there));
        }
    }
}
