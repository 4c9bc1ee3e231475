//! Layout of the frames on the bus: what lowlevel and the far end agree on.
//!
//! | id | direction | payload (little endian) |
//! |---|---|---|
//! | 0x100 + node | to the drives | u16 counter, u8 mode, u8 joints, then per joint i32 angle, i32 speed |
//! | 0x200 + node | from the drives | u16 counter, u8 power, u8 joints, then per joint i32 angle, i32 speed, i32 current |
//! | 0x300 + foot | from the force sensors | u16 counter, u16 0, i32 force (3), i32 moment (3) |
//! | 0x310 | from the IMU | u16 counter, u16 0, i32 quaternion (4), i32 rate (3), i32 specific force (3) |
//!
//! Numbers are scaled integers, rounded to nearest and saturated: angle 2^-29 rad, speed 2^-26 rad/s, current 2^-20 A,
//! force and moment 2^-16 N and N m, quaternion 2^-30, rate 2^-26 rad/s, specific force 2^-20 m/s^2.
//! The counter is the low half of the tick: it tells a repeated frame from a new one.

use crate::bus::{BusFrames, Frame};
use crate::{JointMode, JointTargets, Sensors};

const ANGLE: f64 = (1u64 << 29) as f64;
const SPEED: f64 = (1u64 << 26) as f64;
const CURRENT: f64 = (1u64 << 20) as f64;
const FORCE: f64 = (1u64 << 16) as f64;
const UNIT: f64 = (1u64 << 30) as f64;
const ACCELERATION: f64 = (1u64 << 20) as f64;

const TARGET: u32 = 0x100;
const STATUS: u32 = 0x200;
const FOOT: u32 = 0x300;
const IMU: u32 = 0x310;

/// Which joints (indices) each local controller drives.
pub type Nodes = [Vec<usize>];

/// Builds one payload.
struct Payload {
    bytes: [u8; 64],
    len: usize,
}

impl Payload {
    fn new(counter: u64, a: u8, b: u8) -> Self {
        let mut bytes = [0; 64];
        bytes[..2].copy_from_slice(&(counter as u16).to_le_bytes());
        bytes[2] = a;
        bytes[3] = b;
        Self { bytes, len: 4 }
    }

    /// Appends `value * scale` as i32; Rust's float-to-int cast saturates and maps NaN to 0.
    fn put(&mut self, value: f64, scale: f64) {
        self.bytes[self.len..self.len + 4].copy_from_slice(&((value * scale).round() as i32).to_le_bytes());
        self.len += 4;
    }

    fn send(&self, id: u32, frames: &mut BusFrames) {
        frames.push(id, &self.bytes[..self.len]);
    }
}

/// The `i`-th scaled number of a payload.
fn number(frame: &Frame, i: usize, scale: f64) -> f64 {
    let at = 4 + 4 * i;
    let bytes = [frame.data[at], frame.data[at + 1], frame.data[at + 2], frame.data[at + 3]];
    f64::from(i32::from_le_bytes(bytes)) / scale
}

/// Whether a frame belongs to cycle `tick` and is as long as `numbers` scaled numbers make it.
fn is_current(frame: &Frame, tick: u64, numbers: usize) -> bool {
    frame.len as usize == 4 + 4 * numbers && frame.data[..2] == (tick as u16).to_le_bytes()
}

/// One target frame per node.
pub fn encode_targets(nodes: &Nodes, targets: &JointTargets, frames: &mut BusFrames) {
    frames.header = targets.header;
    frames.count = 0;
    for (node, joints) in nodes.iter().enumerate() {
        let mut p = Payload::new(targets.header.tick, targets.mode as u8, joints.len() as u8);
        for &j in joints {
            p.put(targets.angle[j], ANGLE);
            p.put(targets.speed[j], SPEED);
        }
        p.send(TARGET + node as u32, frames);
    }
}

/// Reads target frames of cycle `tick` into `targets`; returns how many nodes were addressed.
pub fn decode_targets(nodes: &Nodes, frames: &BusFrames, targets: &mut JointTargets) -> usize {
    targets.header = frames.header;
    let mut addressed = 0;
    for frame in frames.as_slice() {
        let Some(joints) = frame.id.checked_sub(TARGET).and_then(|n| nodes.get(n as usize)) else { continue };
        if !is_current(frame, frames.header.tick, 2 * joints.len()) {
            continue;
        }
        targets.mode = JointMode::from(u64::from(frame.data[2])) as u64;
        for (i, &j) in joints.iter().enumerate() {
            targets.angle[j] = number(frame, 2 * i, ANGLE);
            targets.speed[j] = number(frame, 2 * i + 1, SPEED);
        }
        addressed += 1;
    }
    addressed
}

/// Status frames of all nodes, both force sensors and the IMU.
pub fn encode_sensors(nodes: &Nodes, sensors: &Sensors, frames: &mut BusFrames) {
    let tick = sensors.header.tick;
    frames.header = sensors.header;
    frames.count = 0;
    for (node, joints) in nodes.iter().enumerate() {
        let mut p = Payload::new(tick, sensors.power as u8, joints.len() as u8);
        for &j in joints {
            p.put(sensors.joint_angle[j], ANGLE);
            p.put(sensors.joint_speed[j], SPEED);
            p.put(sensors.motor_current[j], CURRENT);
        }
        p.send(STATUS + node as u32, frames);
    }
    for (foot, wrench) in sensors.foot_wrench.iter().enumerate() {
        let mut p = Payload::new(tick, 0, 0);
        for x in wrench.force.iter().chain(&wrench.moment) {
            p.put(*x, FORCE);
        }
        p.send(FOOT + foot as u32, frames);
    }
    let mut p = Payload::new(tick, 0, 0);
    for x in sensors.imu.orientation {
        p.put(x, UNIT);
    }
    for x in sensors.imu.angular_velocity {
        p.put(x, SPEED);
    }
    for x in sensors.imu.acceleration {
        p.put(x, ACCELERATION);
    }
    p.send(IMU, frames);
}

/// Reads the sensor frames of one cycle into `sensors`, values of missing frames stay; returns how many of the
/// expected frames were missing. Motor sides are taken as rigid copies of the link sides.
pub fn decode_sensors(nodes: &Nodes, frames: &BusFrames, sensors: &mut Sensors) -> usize {
    let tick = frames.header.tick;
    let mut missing = nodes.len() + 3;
    for frame in frames.as_slice() {
        let id = frame.id;
        if let Some(joints) = id.checked_sub(STATUS).and_then(|n| nodes.get(n as usize)) {
            if is_current(frame, tick, 3 * joints.len()) {
                for (i, &j) in joints.iter().enumerate() {
                    sensors.joint_angle[j] = number(frame, 3 * i, ANGLE);
                    sensors.joint_speed[j] = number(frame, 3 * i + 1, SPEED);
                    sensors.motor_angle[j] = sensors.joint_angle[j];
                    sensors.motor_speed[j] = sensors.joint_speed[j];
                    sensors.motor_current[j] = number(frame, 3 * i + 2, CURRENT);
                }
                sensors.power = u64::from(frame.data[2]);
                missing -= 1;
            }
        } else if (id == FOOT || id == FOOT + 1) && is_current(frame, tick, 6) {
            let wrench = &mut sensors.foot_wrench[(id - FOOT) as usize];
            wrench.force = std::array::from_fn(|i| number(frame, i, FORCE));
            wrench.moment = std::array::from_fn(|i| number(frame, 3 + i, FORCE));
            missing -= 1;
        } else if id == IMU && is_current(frame, tick, 10) {
            sensors.imu.orientation = std::array::from_fn(|i| number(frame, i, UNIT));
            sensors.imu.angular_velocity = std::array::from_fn(|i| number(frame, 4 + i, SPEED));
            sensors.imu.acceleration = std::array::from_fn(|i| number(frame, 7 + i, ACCELERATION));
            missing -= 1;
        }
    }
    missing
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nodes() -> Vec<Vec<usize>> {
        vec![vec![0, 1], vec![2, 3, 4]]
    }

    #[test]
    fn targets_survive_the_bus_within_half_a_unit() {
        let mut sent = JointTargets::default();
        sent.header.tick = 0x1_0007;
        sent.mode = JointMode::Track as u64;
        for j in 0..5 {
            sent.angle[j] = 0.3 * j as f64 - 1.1;
            sent.speed[j] = 2.0 - 0.7 * j as f64;
        }
        let (mut frames, mut got) = (BusFrames::default(), JointTargets::default());
        encode_targets(&nodes(), &sent, &mut frames);
        assert_eq!(decode_targets(&nodes(), &frames, &mut got), 2);
        assert_eq!((got.header.tick, got.mode), (sent.header.tick, sent.mode));
        for j in 0..5 {
            assert!((got.angle[j] - sent.angle[j]).abs() <= 0.5 / ANGLE);
            assert!((got.speed[j] - sent.speed[j]).abs() <= 0.5 / SPEED);
        }
    }

    #[test]
    fn numbers_beyond_the_scale_saturate_and_nan_becomes_zero() {
        let mut p = Payload::new(0, 0, 0);
        p.put(1e9, ANGLE);
        p.put(f64::NAN, ANGLE);
        let mut frames = BusFrames::default();
        p.send(1, &mut frames);
        assert!((number(&frames.frames[0], 0, ANGLE) - 4.0).abs() < 1e-8);
        assert_eq!(number(&frames.frames[0], 1, ANGLE), 0.0);
    }

    #[test]
    fn old_short_and_foreign_frames_count_as_missing() {
        let mut sensors = Sensors::default();
        sensors.header.tick = 9;
        sensors.joint_angle[3] = 0.5;
        let mut frames = BusFrames::default();
        encode_sensors(&nodes(), &sensors, &mut frames);
        let mut got = Sensors::default();
        assert_eq!(decode_sensors(&nodes(), &frames, &mut got), 0);
        assert_eq!(got.joint_angle[3], 0.5);
        frames.frames[1].data[0] ^= 1; // another cycle's counter
        frames.frames[2].len -= 1; // cut short
        frames.frames[3].id = 0x7ff; // nobody's
        assert_eq!(decode_sensors(&nodes(), &frames, &mut Sensors::default()), 3);
    }
}
