//! Records to frames and back, by the layout of a robot: [`FrameLayout`].

use crate::layout::{BusMessage, Carries, FrameLayout, MAX_NODES};
use crate::network::{NetworkCommand, NetworkState};
use messages::{BusFrames, ERROR_FLAG, Frame, JointMode, JointTargets, MAX_JOINTS, Sensors};

/// Command to the drives in one cycle.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DriveCommand {
    /// Angles and speeds.
    pub targets: JointTargets,
    /// \[1\] Controlwords of CiA 402.
    pub control: [u32; MAX_JOINTS],
    /// Joints (bits) whose controlword is sent in this cycle, where it is not sent in every one.
    pub due: u32,
    /// To all drives, where they know network management.
    pub network: Option<NetworkCommand>,
}

/// Replies of drives that play tables, beside their readings.
#[derive(Clone, Copy, Debug, Default)]
pub struct DriveReplies<'a> {
    /// Telegrams of their interpreters.
    pub telegrams: &'a [Frame],
    /// Drives (bits) that tell an error code.
    pub emergencies: u32,
    /// Drives (bits) that send a heartbeat.
    pub heartbeats: u32,
    /// State of each drive on the network; none of one that is operational.
    pub network: &'a [NetworkState],
}

impl DriveReplies<'_> {
    fn state(&self, j: usize) -> NetworkState {
        self.network.get(j).copied().unwrap_or_default()
    }

    /// True if a message is sent in this cycle. A drive that is not operational sends no process data.
    fn sends(&self, message: &BusMessage) -> bool {
        let mut signals = message.signals.iter().map(|s| s.carries);
        if message.cyclic {
            return !signals
                .any(|c| matches!(c, Carries::Status(j) if self.state(j) != NetworkState::Operational));
        }
        signals.any(|c| match c {
            Carries::Error(j) => self.emergencies >> j & 1 == 1,
            Carries::NetworkState(j) => self.heartbeats >> j & 1 == 1,
            _ => false,
        })
    }
}

/// Outcome of the frames of one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Received {
    /// \[1\] Messages of the layout that did not come, by node.
    pub missing: [u8; MAX_NODES],
    /// \[1\] Frames of another cycle.
    pub stale: u32,
    /// \[1\] Frames that came a second time.
    pub repeated: u32,
    /// \[1\] Frames whose length is not that of their message.
    pub wrong_length: u32,
    /// \[1\] Frames that the layout does not know in this direction.
    pub unknown: u32,
    /// \[1\] Error frames.
    pub errors: u32,
}

impl Received {
    /// Messages that did not come.
    pub fn missed(&self) -> u32 {
        self.missing.iter().map(|&n| u32::from(n)).sum()
    }

    /// Whether every message of a node came.
    pub fn complete(&self, node: usize) -> bool {
        self.missing[node] == 0
    }
}

/// Every message to the drives.
pub fn encode_targets(layout: &FrameLayout, command: &DriveCommand, frames: &mut BusFrames) {
    encode_command(layout, command, &[], frames);
}

/// The same, with telegrams to the drives' interpreters; they go out on each line before it is synchronized.
pub fn encode_command(
    layout: &FrameLayout,
    command: &DriveCommand,
    telegrams: &[Frame],
    frames: &mut BusFrames,
) {
    let t = &command.targets;
    frames.header = t.header;
    frames.count = 0;
    let due = |carries: Carries| match carries {
        Carries::Control(j) => command.due >> j & 1 == 1,
        Carries::NetworkCommand => command.network.is_some(),
        _ => false,
    };
    let sends = |m: &BusMessage| m.cyclic || m.signals.iter().any(|s| due(s.carries));
    encode(layout, true, t.header.tick, (telegrams, &sends), frames, |carries| match carries {
        Carries::Mode => t.mode as f64,
        Carries::Target(j) => t.angle[j],
        Carries::Feed(j) => t.speed[j],
        Carries::Control(j) => f64::from(command.control[j]),
        Carries::NetworkCommand => command.network.map_or(0.0, |command| f64::from(command as u8)),
        _ => 0.0, // all nodes; the rest is not sent in this direction: `config` refuses such a layout
    });
}

/// Reads the frames of their header's cycle; what is missing stays as it was.
pub fn decode_targets(layout: &FrameLayout, frames: &BusFrames, command: &mut DriveCommand) -> Received {
    let t = &mut command.targets;
    t.header = frames.header;
    decode(layout, true, frames, |carries, value| match carries {
        Carries::Mode => t.mode = JointMode::from(value as u64) as u64,
        Carries::Target(j) => t.angle[j] = value,
        Carries::Feed(j) => t.speed[j] = value,
        Carries::Control(j) => command.control[j] = value as u32,
        _ => {}
    })
}

/// Every message from the drives.
pub fn encode_sensors(layout: &FrameLayout, sensors: &Sensors, frames: &mut BusFrames) {
    encode_answers(layout, sensors, &DriveReplies::default(), frames);
}

/// The same, with what else the drives say; telegrams come first: who has all messages of the cycle has these, too.
pub fn encode_answers(
    layout: &FrameLayout,
    sensors: &Sensors,
    replies: &DriveReplies<'_>,
    frames: &mut BusFrames,
) {
    let s = sensors;
    frames.header = s.header;
    frames.count = 0;
    replies.telegrams.iter().for_each(|frame| _ = frames.push(frame));
    let sends = |m: &BusMessage| replies.sends(m);
    encode(layout, false, s.header.tick, (&[], &sends), frames, |carries| match carries {
        Carries::Supply => s.power as f64,
        Carries::Angle(j) => s.joint_angle[j],
        Carries::Speed(j) => s.joint_speed[j],
        // Motor side and drives.
        Carries::Motor(j) => s.motor_angle[j],
        Carries::MotorSpeed(j) => s.motor_speed[j],
        Carries::Current(j) => s.motor_current[j],
        Carries::Status(j) => f64::from(s.drive_status[j]),
        Carries::Temperature(j) => s.temperature[j],
        Carries::Error(j) => f64::from(s.drive_error[j]),
        Carries::NetworkState(j) => f64::from(replies.state(j) as u8),
        // Ground and inertia.
        Carries::Force(foot, k) => s.foot_wrench[foot].force[k],
        Carries::Moment(foot, k) => s.foot_wrench[foot].moment[k],
        Carries::Orientation(k) => s.imu.orientation[k],
        Carries::Rate(k) => s.imu.angular_velocity[k],
        Carries::Acceleration(k) => s.imu.acceleration[k],
        _ => 0.0,
    });
}

/// Reads the frames of their header's cycle; what is missing stays as it was. Motor sides that no message brings are copies
/// of the link sides.
pub fn decode_sensors(layout: &FrameLayout, frames: &BusFrames, sensors: &mut Sensors) -> Received {
    let s = sensors;
    decode(layout, false, frames, |carries, value| match carries {
        Carries::Supply => s.power = value as u64,
        Carries::Angle(j) => {
            s.joint_angle[j] = value;
            if !layout.motor_side[j] {
                s.motor_angle[j] = value;
            }
        }
        Carries::Speed(j) => {
            s.joint_speed[j] = value;
            if !layout.motor_side[j] {
                s.motor_speed[j] = value;
            }
        }
        // Motor side and drives.
        Carries::Motor(j) => s.motor_angle[j] = value,
        Carries::MotorSpeed(j) => s.motor_speed[j] = value,
        Carries::Current(j) => s.motor_current[j] = value,
        Carries::Status(j) => s.drive_status[j] = value as u32,
        Carries::Temperature(j) => s.temperature[j] = value,
        Carries::Error(j) => s.drive_error[j] = value as u32,
        Carries::Force(foot, k) => s.foot_wrench[foot].force[k] = value,
        Carries::Moment(foot, k) => s.foot_wrench[foot].moment[k] = value,
        Carries::Orientation(k) => s.imu.orientation[k] = value,
        Carries::Rate(k) => s.imu.angular_velocity[k] = value,
        Carries::Acceleration(k) => s.imu.acceleration[k] = value,
        _ => {}
    })
}

/// Outcome of the frames of their header's cycle, without reading any number.
pub fn look(layout: &FrameLayout, to_drives: bool, frames: &BusFrames) -> Received {
    decode(layout, to_drives, frames, |_, _| {})
}

/// Throws away what does not belong to the header's cycle.
pub fn keep_current(layout: &FrameLayout, to_drives: bool, frames: &mut BusFrames) {
    let mut kept = 0;
    for i in 0..frames.as_slice().len() {
        let frame = frames.frames[i];
        let message = layout.find(frame.line, frame.id).map(|m| &layout.messages[m]);
        let wanted = message.is_some_and(|m| {
            m.to_drives == to_drives && m.len == frame.len && is_current(m, &frame, frames.header.tick)
        });
        if wanted {
            frames.frames[kept] = frame;
            kept += 1;
        }
    }
    frames.count = kept as u64;
}

/// Whether a frame of this message is of cycle `tick`; one without counter always is.
fn is_current(message: &BusMessage, frame: &Frame, tick: u64) -> bool {
    let counter = message.counter();
    counter.is_none_or(|s| s.get(&frame.data) as u64 == tick & ((1 << s.bits) - 1))
}

/// True for messages that are sent in this cycle.
type Sends<'a> = &'a dyn Fn(&BusMessage) -> bool;

/// Appends the messages of one direction that are sent, in the order of the layout; before a line is synchronized, its telegrams.
fn encode(
    layout: &FrameLayout,
    to_drives: bool,
    tick: u64,
    (telegrams, sends): (&[Frame], Sends<'_>),
    frames: &mut BusFrames,
    value: impl Fn(Carries) -> f64,
) {
    for message in layout.messages.iter().filter(|m| m.to_drives == to_drives) {
        if !sends(message) {
            continue;
        }
        if !telegrams.is_empty() && message.is_sync() {
            let of_line = telegrams.iter().filter(|frame| frame.line as usize == message.node);
            of_line.for_each(|frame| _ = frames.push(frame));
        }
        let Some(frame) = frames.append() else { return }; // `config` refuses a layout with more
        (frame.line, frame.id, frame.len) = (message.node as u32, message.id, message.len);
        frame.data = [0; 64];
        for signal in &message.signals {
            let raw = match signal.carries {
                Carries::Counter => tick as i64, // its low bits
                other => signal.raw(value(other)),
            };
            signal.put(&mut frame.data, raw);
        }
    }
}

/// Reads the frames that belong to their header's tick, each message once.
fn decode(
    layout: &FrameLayout,
    to_drives: bool,
    frames: &BusFrames,
    mut take: impl FnMut(Carries, f64),
) -> Received {
    let mut received = Received::default();
    for message in layout.sent(to_drives) {
        received.missing[message.node] += 1;
    }
    let mut seen = [0u64; 4]; // 256 messages; `config` refuses more
    for frame in frames.as_slice() {
        if frame.id & ERROR_FLAG != 0 {
            received.errors += 1;
            continue;
        }
        let found = layout.find(frame.line, frame.id).filter(|&i| layout.messages[i].to_drives == to_drives);
        let Some(i) = found else {
            received.unknown += 1;
            continue;
        };
        let message = &layout.messages[i];
        if frame.len != message.len {
            received.wrong_length += 1;
            continue;
        }
        if !is_current(message, frame, frames.header.tick) {
            received.stale += 1;
            continue;
        }
        if message.cyclic {
            if seen[i / 64] >> (i % 64) & 1 == 1 {
                received.repeated += 1;
                continue;
            }
            seen[i / 64] |= 1 << (i % 64);
            received.missing[message.node] -= 1;
        }
        for signal in message.signals.iter().filter(|s| s.carries != Carries::Counter) {
            take(signal.carries, signal.value(signal.get(&frame.data)));
        }
    }
    received
}
