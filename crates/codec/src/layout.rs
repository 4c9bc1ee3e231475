//! Position of each number in the frames of the bus.
//!
//! A layout is data: `config` makes it from a robot's DBC file. Numbers are scaled integers of up to 32 bits, little endian
//! (Intel), value = raw × scale + offset; bit 0 is the lowest of byte 0.

use messages::MAX_JOINTS;

/// Room for local controllers: nodes, each on a line of its own.
pub const MAX_NODES: usize = 32;
/// Identifiers of 11 bits.
const IDS: usize = 0x800;
/// In the index: no message has this identifier.
const NOBODY: u16 = u16::MAX;

/// Meaning of a number. Joints, feet (right, left) and axes by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carries {
    /// \[1\] Low bits of the tick: tells a repeated or late frame from a new one.
    Counter,
    /// \[1\] To the drives: a [`JointMode`](messages::JointMode).
    Mode,
    /// \[rad\] To the drives: angle of a joint.
    Target(usize),
    /// \[rad/s\] To the drives: speed of a joint.
    Feed(usize),
    /// \[1\] To the drives: controlword of CiA 402.
    Control(usize),
    /// \[1\] 1 while the motor supply is on.
    Supply,
    /// \[rad\] Link side.
    Angle(usize),
    /// \[rad/s\] Link side.
    Speed(usize),
    /// \[rad\] Motor side, divided by the gear ratio.
    Motor(usize),
    /// \[rad/s\] Motor side, divided by the gear ratio.
    MotorSpeed(usize),
    /// \[A\]
    Current(usize),
    /// \[1\] Statusword of CiA 402.
    Status(usize),
    /// \[deg C\] Winding of the motor.
    Temperature(usize),
    /// \[1\] Error code of CiA 402; 0: none.
    Error(usize),
    /// \[N\] Foot and axis.
    Force(usize, usize),
    /// \[N m\] Foot and axis.
    Moment(usize, usize),
    /// \[1\] Part of the unit quaternion x, y, z, w.
    Orientation(usize),
    /// \[rad/s\] Axis of the torso.
    Rate(usize),
    /// \[m/s^2\] Axis of the torso.
    Acceleration(usize),
    /// \[1\] Part of a telegram of the interpreter in a joint's drive ([`crate::interpreter`]), either way.
    Interpreter(usize),
    /// \[1\] To the drives: a [`NetworkCommand`](crate::network::NetworkCommand).
    NetworkCommand,
    /// \[1\] To the drives: node that the command is for; 0: all.
    NetworkNode,
    /// \[1\] A [`NetworkState`](crate::network::NetworkState), in the heartbeat of a joint's drive.
    NetworkState(usize),
}

/// One number of a message.
#[derive(Clone, Debug, PartialEq)]
pub struct BusSignal {
    /// Its name in the DBC file.
    pub name: String,
    /// First bit.
    pub start: u32,
    /// \[bit\] @range 1..32
    pub bits: u32,
    /// Two's complement.
    pub signed: bool,
    /// Value of the lowest bit, in the unit of what it carries.
    pub scale: f64,
    /// Value of raw 0.
    pub offset: f64,
    /// Kind.
    pub carries: Carries,
}

/// One frame: of every cycle, or when there is something to say.
#[derive(Clone, Debug, PartialEq)]
pub struct BusMessage {
    /// Its name in the DBC file.
    pub name: String,
    /// Identifier, 11 bits; unique on its line.
    pub id: u32,
    /// \[byte\] Length of the payload.
    pub len: u32,
    /// Local controller that sends or receives it, and its line.
    pub node: usize,
    /// Whether lowlevel sends it.
    pub to_drives: bool,
    /// Whether it is sent in every cycle, and missed if it does not come.
    pub cyclic: bool,
    /// Its numbers.
    pub signals: Vec<BusSignal>,
}

/// All messages of a robot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameLayout {
    /// Names of the local controllers, in the order of their lines.
    pub nodes: Vec<String>,
    /// Of both directions; those of a node in the order they are sent.
    pub messages: Vec<BusMessage>,
    /// Message by line and identifier.
    index: Vec<u16>,
    /// Whether some message brings a motor side of the joint.
    pub(crate) motor_side: [bool; MAX_JOINTS],
    /// Messages of each joint's interpreter: from its drive, to its drive.
    interpreter: [[u16; MAX_JOINTS]; 2],
}

impl BusSignal {
    /// Raw number of a value: rounded to nearest and saturated; NaN becomes the raw number nearest to zero.
    pub fn raw(&self, value: f64) -> i64 {
        let (low, high) = self.range();
        // Away from zero by a half, then towards it; the cast saturates and maps NaN to 0.
        let x = (value - self.offset) / self.scale;
        ((x + 0.5_f64.copysign(x)) as i64).clamp(low, high)
    }

    /// Smallest and largest raw number.
    pub fn range(&self) -> (i64, i64) {
        if self.signed {
            (-(1 << (self.bits - 1)), (1 << (self.bits - 1)) - 1)
        } else {
            (0, (1 << self.bits) - 1)
        }
    }

    /// Value of a raw number.
    pub fn value(&self, raw: i64) -> f64 {
        raw as f64 * self.scale + self.offset
    }

    /// Writes a raw number over zeros.
    #[inline]
    pub fn put(&self, data: &mut [u8; 64], raw: i64) {
        let (at, shift) = self.word();
        let mask = (1u64 << self.bits) - 1;
        let word = u64::from_le_bytes(std::array::from_fn(|i| data[at + i]));
        data[at..at + 8].copy_from_slice(&(word | (raw as u64 & mask) << shift).to_le_bytes());
    }

    /// Reads a raw number.
    #[inline]
    pub fn get(&self, data: &[u8; 64]) -> i64 {
        let (at, shift) = self.word();
        let word = u64::from_le_bytes(std::array::from_fn(|i| data[at + i]));
        let unused = 64 - self.bits;
        let top = (word >> shift) << unused;
        if self.signed { (top as i64) >> unused } else { (top >> unused) as i64 }
    }

    /// Byte at which 8 bytes with the number begin, and the number's place in them: 32 bits never need more.
    #[inline]
    fn word(&self) -> (usize, u32) {
        let at = (self.start / 8).min(56);
        (at as usize, self.start - 8 * at)
    }
}

impl BusMessage {
    /// The number that says to which cycle the frame belongs.
    pub fn counter(&self) -> Option<&BusSignal> {
        self.signals.iter().find(|s| s.carries == Carries::Counter)
    }

    /// Whether it ends the cycle: what was sent before it takes effect, sensors are read.
    pub fn is_sync(&self) -> bool {
        self.to_drives && self.cyclic && self.signals.iter().all(|s| s.carries == Carries::Counter)
    }

    /// Joint whose drive's interpreter it is for or from.
    pub fn interpreter(&self) -> Option<usize> {
        self.signals.iter().find_map(|s| match s.carries {
            Carries::Interpreter(j) => Some(j),
            _ => None,
        })
    }

    /// Joint whose drive's heartbeat it is.
    pub fn heartbeat(&self) -> Option<usize> {
        self.signals.iter().find_map(|s| match s.carries {
            Carries::NetworkState(j) => Some(j),
            _ => None,
        })
    }

    /// True for a command of the network management.
    pub fn manages_network(&self) -> bool {
        self.signals.iter().any(|s| s.carries == Carries::NetworkCommand)
    }
}

impl FrameLayout {
    /// Of these nodes and messages, whose nodes and identifiers are in range and unique on each line.
    pub fn new(nodes: Vec<String>, messages: Vec<BusMessage>) -> Self {
        let mut index = vec![NOBODY; nodes.len() * IDS];
        let mut motor_side = [false; MAX_JOINTS];
        let mut interpreter = [[NOBODY; MAX_JOINTS]; 2];
        for (i, message) in messages.iter().enumerate() {
            index[message.node * IDS + message.id as usize % IDS] = i as u16;
            if let Some(j) = message.interpreter() {
                interpreter[usize::from(message.to_drives)][j] = i as u16;
            }
            for signal in &message.signals {
                if let Carries::Motor(j) = signal.carries {
                    motor_side[j] = true;
                }
            }
        }
        Self { nodes, messages, index, motor_side, interpreter }
    }

    /// Whether all messages fit into frames of classic CAN.
    pub fn is_classic(&self) -> bool {
        self.messages.iter().all(|m| m.len <= 8)
    }

    /// Index of the message with this identifier on a line.
    #[inline]
    pub fn find(&self, line: u32, id: u32) -> Option<usize> {
        let at = (id as usize) < IDS && (line as usize) < self.nodes.len();
        let i = if at { self.index[line as usize * IDS + id as usize] } else { NOBODY };
        (i != NOBODY).then_some(i as usize)
    }

    /// The only line on which an identifier is used; none if nobody or several use it.
    pub fn line_of(&self, id: u32) -> Option<u32> {
        let mut lines = (0..self.nodes.len() as u32).filter(|&line| self.find(line, id).is_some());
        lines.next().filter(|_| lines.next().is_none())
    }

    /// Messages of every cycle in one direction.
    pub fn sent(&self, to_drives: bool) -> impl Iterator<Item = &BusMessage> {
        self.messages.iter().filter(move |m| m.to_drives == to_drives && m.cyclic)
    }

    /// Message to or from the interpreter in the drive of joint `j`, if it has one.
    pub fn interpreter(&self, to_drives: bool, j: usize) -> Option<&BusMessage> {
        self.messages.get(usize::from(*self.interpreter[usize::from(to_drives)].get(j)?))
    }

    /// Whether drives play tables: then they have interpreters, and no targets come in every cycle.
    pub fn plays_tables(&self) -> bool {
        self.interpreter(true, 0).is_some()
    }

    /// \[rad\] One count of joint `j`'s motor, as its angle is read; none if nobody reads it.
    pub fn count(&self, j: usize) -> Option<f64> {
        let mut signals = self.messages.iter().filter(|m| !m.to_drives).flat_map(|m| &m.signals);
        signals.find(|s| s.carries == Carries::Angle(j)).map(|s| s.scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn signal(start: u32, bits: u32, signed: bool) -> BusSignal {
        BusSignal {
            name: "x".into(),
            start,
            bits,
            signed,
            scale: 0.5,
            offset: 10.0,
            carries: Carries::Counter,
        }
    }

    #[test]
    fn numbers_come_back_from_every_place() {
        for bits in 1..=32 {
            for start in 0..=512 - bits {
                for signed in [false, true] {
                    let s = signal(start, bits, signed);
                    let (low, high) = s.range();
                    for raw in [low, low / 2, 0, high / 3, high] {
                        let mut data = [0; 64];
                        s.put(&mut data, raw);
                        assert_eq!(s.get(&data), raw, "{bits} bits from {start}");
                        let ones: u32 = data.iter().map(|b| b.count_ones()).sum();
                        assert_eq!(ones, (raw as u64 & ((1 << bits) - 1)).count_ones());
                    }
                }
            }
        }
    }

    #[test]
    fn values_beyond_the_range_saturate_and_nan_is_the_nearest_to_zero() {
        let s = signal(0, 8, true);
        assert_eq!((s.raw(1e300), s.raw(-1e300), s.raw(f64::NAN)), (127, -128, 0));
        assert_eq!((s.value(127), s.raw(73.4), s.raw(73.2)), (73.5, 127, 126));
        assert_eq!(signal(0, 8, false).raw(f64::INFINITY), 255);
    }
}
