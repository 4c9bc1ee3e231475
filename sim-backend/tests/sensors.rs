//! Each error of the sensors alone, against its closed form; all of them off: the truth, bit for bit.

use std::f64::consts::TAU;

use config::Robot;
use config::sensors::{EncoderErrors, EncoderSide, ForceTorqueErrors, ImuErrors, PerJoint, SignalErrors};
use messages::{Sensors, Wrench};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use sim_backend::sensors::{ReadingFaults, SensorSet, Truth};

const CYCLE: f64 = 1e-3;
const HANGING: [Wrench; 2] = [
    Wrench { force: [0.0, 0.0, 24.0], moment: [0.1, -1.2, 0.0] },
    Wrench { force: [0.0; 3], moment: [0.0; 3] },
];

fn set(errors: &config::SensorErrors) -> SensorSet {
    let robot = Robot::load(&config::root(None).join("robots/lola")).unwrap();
    SensorSet::new(errors, &robot, &HANGING, 7, (CYCLE, 1))
}

/// A truth without zeros, but for a negative one.
fn truth() -> Truth {
    let row = |a: f64| std::array::from_fn(|j| if j < 24 { a + 0.01 * (j as f64).sin() } else { 0.0 });
    let wrench = |a: f64| Wrench { force: [a, -0.0, 300.0 * a], moment: [4.0 * a, -7.0, 0.3] };
    let o = UnitQuaternion::from_euler_angles(0.02, -0.05, 0.3);
    Truth {
        joint_angle: row(0.3),
        joint_speed: row(-1.0),
        motor_angle: row(0.31),
        motor_speed: row(-1.1),
        motor_current: row(5.0),
        contact: [wrench(1.0), wrench(0.7)],
        inertial: [wrench(0.1), wrench(0.2)],
        imu: messages::Imu {
            orientation: o.coords.into(),
            angular_velocity: [0.1, -0.2, 0.3],
            acceleration: [-0.5, 0.2, 9.7],
        },
    }
}

fn measure(set: &mut SensorSet, truth: &Truth) -> (Sensors, ReadingFaults) {
    let mut out = Sensors::default();
    let report = set.measure(truth, &mut out);
    (out, report)
}

/// One reading of fresh sensors.
fn once(errors: &config::SensorErrors, truth: &Truth) -> Sensors {
    measure(&mut set(errors), truth).0
}

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a}, not {b} within {tolerance}");
}

/// Mean and standard deviation of a signal over `n` cycles of a truth that stands still.
fn statistics(errors: &config::SensorErrors, n: usize, signal: impl Fn(&Sensors) -> f64) -> (f64, f64) {
    let (mut set, truth) = (set(errors), truth());
    let x: Vec<f64> = (0..n).map(|_| signal(&measure(&mut set, &truth).0)).collect();
    let mean = x.iter().sum::<f64>() / n as f64;
    (mean, (x.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n as f64).sqrt())
}

fn all(x: f64) -> PerJoint {
    PerJoint { all: Some(x), own: Vec::new() }
}

fn encoder(encoder: EncoderErrors) -> config::SensorErrors {
    config::SensorErrors { encoder, ..Default::default() }
}

fn feet(force_torque: ForceTorqueErrors) -> config::SensorErrors {
    config::SensorErrors { force_torque, ..Default::default() }
}

fn imu(imu: ImuErrors) -> config::SensorErrors {
    config::SensorErrors { imu, ..Default::default() }
}

#[test]
fn nothing_named_is_the_truth_bit_for_bit() {
    let truth = truth();
    let (out, report) = measure(&mut set(&config::SensorErrors::default()), &truth);
    let pairs = [
        (out.joint_angle, truth.joint_angle),
        (out.joint_speed, truth.joint_speed),
        (out.motor_angle, truth.motor_angle),
        (out.motor_speed, truth.motor_speed),
        (out.motor_current, truth.motor_current),
    ];
    for (out, truth) in pairs {
        assert_eq!(out.map(f64::to_bits), truth.map(f64::to_bits));
    }
    for i in 0..2 {
        assert_eq!(out.foot_wrench[i].force.map(f64::to_bits), truth.contact[i].force.map(f64::to_bits));
        assert_eq!(out.foot_wrench[i].moment.map(f64::to_bits), truth.contact[i].moment.map(f64::to_bits));
    }
    assert_eq!(out.imu.orientation.map(f64::to_bits), truth.imu.orientation.map(f64::to_bits));
    assert_eq!(out.imu.angular_velocity.map(f64::to_bits), truth.imu.angular_velocity.map(f64::to_bits));
    assert_eq!(out.imu.acceleration.map(f64::to_bits), truth.imu.acceleration.map(f64::to_bits));
    assert_eq!(report, ReadingFaults::default());
}

/// An error touches its own signal only: all others stay the truth bit for bit.
#[test]
fn an_error_leaves_the_other_signals_alone() {
    let truth = truth();
    let ideal = once(&config::SensorErrors::default(), &truth);
    let wrong = once(&encoder(EncoderErrors { counts: all(65536.0), ..Default::default() }), &truth);
    let same = Sensors { joint_angle: ideal.joint_angle, ..wrong };
    assert!(same == ideal && wrong != ideal);
    let rate = SignalErrors { noise: 0.1, ..Default::default() };
    let wrong = once(&imu(ImuErrors { rate, ..Default::default() }), &truth);
    let mut same = wrong;
    same.imu.angular_velocity = ideal.imu.angular_velocity;
    assert!(same == ideal && wrong != ideal);
    let wrong = once(&feet(ForceTorqueErrors { noise: [0.0, 1.0], ..Default::default() }), &truth);
    for i in 0..2 {
        assert_eq!(wrong.foot_wrench[i].force, ideal.foot_wrench[i].force);
        assert_ne!(wrong.foot_wrench[i].moment, ideal.foot_wrench[i].moment);
    }
}

/// Errata 1, V15: 2^16 counts, each 9.58737992429e-5 rad; the reading is the count below.
#[test]
fn encoders_count_downwards() {
    let errors = encoder(EncoderErrors { counts: all(65536.0), ..Default::default() });
    let mut truth = truth();
    for (j, q) in [0.0, 9.58737992429e-5 * 7.001, 9.58737992429e-5 * 7.999, -1e-9].into_iter().enumerate() {
        truth.joint_angle[j] = q;
    }
    let out = once(&errors, &truth);
    for (j, counts) in [0.0, 7.0, 7.0, -1.0].into_iter().enumerate() {
        close(out.joint_angle[j], counts * 9.58737992429e-5, 1e-15);
    }
    for j in 0..24 {
        let low = truth.joint_angle[j] - out.joint_angle[j];
        assert!((0.0..TAU / 65536.0).contains(&low), "{low}");
    }
    assert_eq!(out.joint_speed, truth.joint_speed);
}

#[test]
fn bias_of_one_joint() {
    let robot = Robot::load(&config::root(None).join("robots/lola")).unwrap();
    let bias = PerJoint { all: None, own: vec![("right_ankle_flexion".to_owned(), -0.05)] };
    let (truth, ankle) = (truth(), robot.joint("right_ankle_flexion").unwrap());
    let out = once(&encoder(EncoderErrors { bias, speed_by_difference: true, ..Default::default() }), &truth);
    for j in 0..24 {
        let expected = truth.joint_angle[j] - if j == ankle { 0.05 } else { 0.0 };
        assert_eq!(out.joint_angle[j], expected);
        assert_eq!(out.joint_speed[j], 0.0); // a bias moves no joint
    }
}

/// F26: 16 bit at 1 kHz. Steps of 0.0959 rad/s; over a movement the error of the speed has the root mean square
/// delta/(T sqrt 6) = 0.0391 rad/s and comes close to delta/T, the thesis' 0.1 rad/s.
#[test]
fn speed_by_difference_has_the_noise_floor_of_its_counts() {
    let errors = EncoderErrors { counts: all(65536.0), speed_by_difference: true, ..Default::default() };
    let (mut set, mut truth) = (set(&encoder(errors)), truth());
    let step = 0.095_873_799_242_9;
    let (mut square, mut most, n) = (0.0, 0.0_f64, 20_000);
    let angle = |k: i32| 0.4 * (5.0 * f64::from(k) * CYCLE).sin();
    truth.joint_angle[0] = angle(-1);
    measure(&mut set, &truth);
    for k in 0..n {
        truth.joint_angle[0] = angle(k);
        let speed = measure(&mut set, &truth).0.joint_speed[0];
        close(speed / step, (speed / step).round(), 1e-6);
        let error = speed - (angle(k) - angle(k - 1)) / CYCLE;
        square += error * error / f64::from(n);
        most = most.max(error.abs());
    }
    close(square.sqrt(), step / 6.0_f64.sqrt(), 0.05 * step / 6.0_f64.sqrt());
    assert!(most <= step && most > 0.95 * 0.1, "{most}");
}

/// Motor encoders resolve a joint as much finer as the gear is slow; a robot without absolute encoders has only these.
#[test]
fn motor_side() {
    let motor_encoder = EncoderErrors { counts: all(2000.0 * 100.0), ..Default::default() };
    let mut errors = config::SensorErrors { motor_encoder, ..Default::default() };
    let truth = truth();
    let link = once(&errors, &truth);
    assert_eq!(link.joint_angle, truth.joint_angle);
    errors.side = EncoderSide::Motor;
    let motor = once(&errors, &truth);
    assert_eq!((motor.joint_angle, motor.motor_angle), (link.motor_angle, link.motor_angle));
    assert_eq!(motor.joint_speed, truth.motor_speed);
    for j in 0..24 {
        let count = motor.motor_angle[j] / (TAU / 200_000.0);
        close(count, count.round(), 1e-9);
        assert!((0.0..TAU / 200_000.0).contains(&(truth.motor_angle[j] - motor.motor_angle[j])));
    }
}

/// Errata 1, 4.13: at rest and level the sensor reads the ground; uncompensated also the hanging weight, tilted by phi
/// m g (1 - cos phi) and m g sin phi too much.
#[test]
fn weight_below_the_sensor() {
    let compensated = ForceTorqueErrors { inertia: true, bias_compensation: true, ..Default::default() };
    let raw = ForceTorqueErrors { inertia: true, ..Default::default() };
    let mut truth = truth();
    truth.inertial = HANGING;
    let out = once(&feet(compensated), &truth).foot_wrench;
    for k in 0..3 {
        close(out[0].force[k], truth.contact[0].force[k], 1e-12);
        close(out[0].moment[k], truth.contact[0].moment[k], 1e-12);
    }
    close(once(&feet(raw), &truth).foot_wrench[0].force[2], 300.0 - 24.0, 1e-12);
    let phi = 0.2_f64; // toe up: gravity leans backwards in the sensor
    truth.contact = [Wrench::default(); 2];
    truth.inertial[0].force = [24.0 * phi.sin(), 0.0, 24.0 * phi.cos()];
    let out = once(&feet(compensated), &truth).foot_wrench[0].force;
    close(out[0], -24.0 * phi.sin(), 1e-12);
    close(out[2], 24.0 * (1.0 - phi.cos()), 1e-12);
    let out = once(&feet(ForceTorqueErrors::default()), &truth).foot_wrench[0].force;
    assert_eq!(out, [0.0; 3]);
}

#[test]
fn only_inertia_asks_for_inertia() {
    assert!(!set(&feet(ForceTorqueErrors { noise: [1.0, 1.0], ..Default::default() })).needs_inertia());
    assert!(set(&feet(ForceTorqueErrors { inertia: true, ..Default::default() })).needs_inertia());
}

/// A force that jumps, through the anti-aliasing filter: exact for the rise within one cycle.
#[test]
fn filter_of_the_force_sensor() {
    let time = 0.004_f64;
    let mut set = set(&feet(ForceTorqueErrors { filter_time: time, ..Default::default() }));
    let mut truth = Truth::default();
    truth.imu.orientation[3] = 1.0;
    measure(&mut set, &truth);
    truth.contact[1].force[2] = 600.0;
    for k in 1..40 {
        let fz = measure(&mut set, &truth).0.foot_wrench[1].force[2];
        let left = time / CYCLE * (CYCLE / time).exp_m1() * (-f64::from(k) * CYCLE / time).exp();
        close(fz, 600.0 * (1.0 - left), 1e-10);
    }
}

/// Noise of 10 000 readings: mean and deviation within four standard errors.
#[test]
fn noise_of_the_force_sensor() {
    let errors = feet(ForceTorqueErrors { noise: [1.0, 0.1], ..Default::default() });
    let (n, truth) = (10_000, truth());
    let root = (n as f64).sqrt();
    let (mean, deviation) = statistics(&errors, n, |s| s.foot_wrench[0].force[2]);
    close(mean, truth.contact[0].force[2], 4.0 / root);
    close(deviation, 1.0, 4.0 / (2.0_f64.sqrt() * root));
    let (mean, deviation) = statistics(&errors, n, |s| s.foot_wrench[1].moment[0]);
    close(mean, truth.contact[1].moment[0], 0.4 / root);
    close(deviation, 0.1, 0.4 / (2.0_f64.sqrt() * root));
}

#[test]
fn steps_and_range_of_the_force_sensor() {
    let errors =
        ForceTorqueErrors { step: [1.0, 0.1], force_range: [700.0, 700.0, 250.0], ..Default::default() };
    let mut truth = truth();
    truth.contact[1].force = [12.49, -12.51, -900.0];
    truth.contact[1].moment = [0.26, -0.24, 0.0];
    let (out, report) = measure(&mut set(&feet(errors)), &truth);
    assert_eq!(out.foot_wrench[1].force, [12.0, -13.0, -250.0]);
    assert_eq!(out.foot_wrench[0].force[2], 250.0);
    close(out.foot_wrench[1].moment[0], 0.3, 1e-12);
    close(out.foot_wrench[1].moment[1], -0.2, 1e-12);
    assert_eq!(report, ReadingFaults { invalid: 0, clipped: 2 });
}

fn orientation(s: &Sensors) -> UnitQuaternion<f64> {
    let [x, y, z, w] = s.imu.orientation;
    UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z))
}

/// A bias about the torso's x axis shows as an inclination of that size, whatever the heading; rate and acceleration
/// have none.
#[test]
fn bias_of_the_imu() {
    let errors = imu(ImuErrors { bias: [5e-3, 0.0, 0.0], ..Default::default() });
    let mut truth = truth();
    for heading in [0.0, 1.5, 3.1] {
        truth.imu.orientation = UnitQuaternion::from_euler_angles(0.0, 0.0, heading).coords.into();
        let out = once(&errors, &truth);
        let (roll, pitch, yaw) = orientation(&out).euler_angles();
        close(roll, 5e-3, 1e-15);
        close(pitch, 0.0, 1e-15);
        close(yaw, heading, 1e-14);
        assert_eq!(out.imu.angular_velocity, truth.imu.angular_velocity);
        assert_eq!(out.imu.acceleration, truth.imu.acceleration);
    }
}

/// A torso that turns at a constant rate is seen late by the time constant 1/(2 pi f): 3.18 ms at 50 Hz.
#[test]
fn bandwidth_of_the_imu() {
    let mut set = set(&imu(ImuErrors { bandwidth: 50.0, ..Default::default() }));
    let omega = Vector3::new(0.4, -0.3, 0.5);
    let mut truth = truth();
    truth.imu.angular_velocity = omega.into();
    let mut out = Sensors::default();
    for k in 0..=200 {
        let o = UnitQuaternion::from_scaled_axis(omega * f64::from(k) * CYCLE);
        truth.imu.orientation = o.coords.into();
        out = measure(&mut set, &truth).0;
    }
    let late = UnitQuaternion::from_scaled_axis(omega * (0.2 - 1.0 / (TAU * 50.0)));
    assert!((late.inverse() * orientation(&out)).scaled_axis().norm() < 1e-12);
    assert!((Vector3::from(out.imu.angular_velocity) - omega).norm() < 1e-15);
}

#[test]
fn noise_of_the_imu() {
    let signal = |noise| SignalErrors { noise, ..Default::default() };
    let errors = imu(ImuErrors {
        orientation: signal(2e-4),
        rate: signal(1e-3),
        acceleration: signal(0.02),
        ..Default::default()
    });
    let (n, truth) = (10_000, truth());
    let true_orientation = orientation(&once(&config::SensorErrors::default(), &truth));
    let error = |s: &Sensors| (true_orientation.inverse() * orientation(s)).scaled_axis().y;
    let of = |signal: &dyn Fn(&Sensors) -> f64, expected: f64, sigma: f64| {
        let (mean, deviation) = statistics(&errors, n, signal);
        close(mean, expected, 4.0 * sigma / (n as f64).sqrt());
        close(deviation, sigma, 4.0 * sigma / (2.0 * n as f64).sqrt());
    };
    of(&error, 0.0, 2e-4);
    of(&|s| s.imu.angular_velocity[0], 0.1, 1e-3);
    of(&|s| s.imu.acceleration[2], 9.7, 0.02);
}

/// Near upright, angles come in steps of the step; rates and accelerations are rounded to theirs and limited.
#[test]
fn steps_and_range_of_the_imu() {
    let step = 1e-3;
    let errors = imu(ImuErrors {
        orientation: SignalErrors { step, ..Default::default() },
        rate: SignalErrors { step: 0.01, range: 3.5, ..Default::default() },
        acceleration: SignalErrors { step: 0.05, range: 19.62, ..Default::default() },
        ..Default::default()
    });
    let mut truth = truth();
    truth.imu.angular_velocity = [0.123, -0.127, 9.0];
    truth.imu.acceleration = [0.02, -0.03, -30.0];
    for angle in [0.0104, 0.0106, -0.0204] {
        truth.imu.orientation = UnitQuaternion::from_euler_angles(angle, 0.0, 0.0).coords.into();
        let (roll, _, _) = orientation(&once(&errors, &truth)).euler_angles();
        close(roll, (angle / step).round() * step, 1e-6); // the sine of half the angle comes in steps
    }
    // Far from upright: four components, each within a quarter of a step, turn by no more than a step.
    let mut most = 0.0_f64;
    for i in 0..500 {
        let o =
            UnitQuaternion::from_euler_angles(0.1 * f64::from(i), 0.37 * f64::from(i), 0.05 * f64::from(i));
        truth.imu.orientation = o.coords.into();
        most = most.max((o.inverse() * orientation(&once(&errors, &truth))).angle());
    }
    assert!(most <= step && most > 0.5 * step, "{most}");
    let (out, report) = measure(&mut set(&errors), &truth);
    close(out.imu.angular_velocity[0], 0.12, 1e-15);
    close(out.imu.angular_velocity[1], -0.13, 1e-15);
    assert_eq!(out.imu.angular_velocity[2], 3.5);
    assert_eq!(out.imu.acceleration, [0.0, -0.05, -19.62]);
    assert_eq!(report, ReadingFaults { invalid: 0, clipped: 2 });
}

fn noisy() -> config::SensorErrors {
    config::SensorErrors {
        force_torque: ForceTorqueErrors { noise: [1.0, 0.1], ..Default::default() },
        imu: ImuErrors { rate: SignalErrors { noise: 1e-3, ..Default::default() }, ..Default::default() },
        ..Default::default()
    }
}

/// The same seed gives the same run; another one another; and an error that is switched on changes no other's noise.
#[test]
fn noise_is_repeatable_and_each_has_its_own() {
    let robot = Robot::load(&config::root(None).join("robots/lola")).unwrap();
    let truth = truth();
    let run = |errors: &config::SensorErrors, seed| {
        let mut set = SensorSet::new(errors, &robot, &HANGING, seed, (CYCLE, 1));
        (0..50).map(|_| measure(&mut set, &truth).0).collect::<Vec<_>>()
    };
    let first = run(&noisy(), 1);
    assert!(first == run(&noisy(), 1) && first != run(&noisy(), 2));
    let mut more = noisy();
    more.encoder.counts = all(65536.0);
    more.imu.orientation.noise = 1e-3;
    more.imu.acceleration.noise = 1e-3;
    more.force_torque.noise[1] = 0.0;
    for (a, b) in first.iter().zip(run(&more, 1)) {
        assert_eq!(a.imu.angular_velocity, b.imu.angular_velocity);
        assert_eq!(a.foot_wrench[0].force, b.foot_wrench[0].force);
    }
    // No two signals share their noise.
    let noise = |x: f64, exact: f64, sigma: f64| ((x - exact) / sigma).to_bits();
    let s = &first[0];
    let mut seen = vec![noise(s.imu.angular_velocity[0], 0.1, 1e-3)];
    for i in 0..2 {
        for k in 0..3 {
            seen.push(noise(s.foot_wrench[i].force[k], truth.contact[i].force[k], 1.0));
        }
    }
    seen.sort_unstable();
    seen.dedup();
    assert_eq!(seen.len(), 7);
}

/// What is not finite is counted and stands as NaN, with and without errors; filters and encoders recover from it.
#[test]
fn what_is_not_finite_is_reported() {
    let mut spoilt = noisy();
    spoilt.encoder = EncoderErrors { counts: all(65536.0), speed_by_difference: true, ..Default::default() };
    spoilt.force_torque.filter_time = 0.01;
    spoilt.imu.bandwidth = 50.0;
    for errors in [config::SensorErrors::default(), spoilt] {
        let mut set = set(&errors);
        let (good, mut bad) = (truth(), truth());
        bad.joint_angle[5] = f64::NAN;
        bad.contact[1].force[2] = f64::INFINITY;
        bad.imu.orientation = [f64::NAN; 4];
        bad.imu.acceleration[1] = f64::NAN;
        bad.motor_current[2] = f64::NAN; // no current sensor: allowed
        assert_eq!(measure(&mut set, &good).1, ReadingFaults::default());
        let (out, report) = measure(&mut set, &bad);
        assert!(report.invalid >= 7, "{report:?}");
        assert!(!out.joint_angle[5].is_finite() && !out.foot_wrench[1].force[2].is_finite());
        assert!(out.imu.orientation.iter().all(|x| x.is_nan()) && !out.imu.acceleration[1].is_finite());
        assert!(out.joint_angle[4].is_finite() && out.foot_wrench[0].force[2].is_finite());
        measure(&mut set, &good); // the difference to the reading before is still missing
        let (out, report) = measure(&mut set, &good);
        assert_eq!(report, ReadingFaults::default());
        close(out.imu.acceleration[1], good.imu.acceleration[1], 1e-12);
    }
    let mut nothing = truth();
    nothing.imu.orientation = [0.0; 4]; // no orientation at all
    let (out, report) = measure(&mut set(&imu(ImuErrors { bias: [0.1; 3], ..Default::default() })), &nothing);
    assert!(report.invalid == 4 && out.imu.orientation.iter().all(|x| x.is_nan()));
}
