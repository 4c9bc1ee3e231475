//! Layouts of frames from DBC files: which signal carries what is said by its name.
//!
//! | signal | direction | carries |
//! |---|---|---|
//! | `counter` | both | low bits of the tick |
//! | `mode` | to the drives | 0 off, 1 hold, 2 track, 3 stop |
//! | `JOINT_target`, `JOINT_feed` | to the drives | angle \[rad\], speed \[rad/s\] |
//! | `JOINT_control` | to the drives | controlword of CiA 402 |
//! | `supply` | from the drives | 1 while the motor supply is on |
//! | `JOINT_angle`, `JOINT_speed` | from the drives | link side \[rad\], \[rad/s\] |
//! | `JOINT_motor`, `JOINT_mspeed` | from the drives | motor side by the gear ratio \[rad\], \[rad/s\] |
//! | `JOINT_current`, `JOINT_temp` | from the drives | \[A\], winding \[deg C\] |
//! | `JOINT_status`, `JOINT_error` | from the drives | statusword, error code of CiA 402 |
//! | `JOINT_letters`, `_index`, `_query`, `_float`, `_value` | both | telegram of the interpreter in a drive that plays tables |
//! | `nmt_command`, `nmt_node` | to the drives | network management: command, node; 0: all |
//! | `JOINT_network` | from the drives | network state, in a drive's heartbeat |
//! | `SIDE_force_AXIS`, `SIDE_moment_AXIS` | from the drives | ground on the foot, sensor frame \[N\], \[N m\] |
//! | `imu_quaternion_x` … `w`, `imu_rate_AXIS`, `imu_accel_AXIS` | from the drives | see `Imu` in `messages` |
//!
//! Node `PC` is lowlevel; every other node is a local controller on a line of its own. A message of the PC goes to the nodes
//! that receive its first signal. The last message to a node carries its counter alone: it ends the cycle.
//!
//! A message whose `GenMsgCycleTime` is 0 does not come in every cycle. A robot whose drives play tables has neither targets
//! nor `feed`, but an interpreter in every drive; force and inertial sensors may be missing there, all of them.

use std::path::Path;

use can_dbc::{AttributeValue, ByteOrder, Dbc, MessageId, MultiplexIndicator, ValueType};
use codec::interpreter;
use codec::layout::{BusMessage, BusSignal, Carries, FrameLayout, MAX_NODES};
use messages::{MAX_FRAMES, nearest};

use crate::error::{ConfigError, Problem};
use crate::file::{self, ConfigReader};

/// The node that is lowlevel.
const PC: &str = "PC";
/// Most messages of a layout.
const MAX_MESSAGES: usize = 256;
const AXES: [&str; 4] = ["x", "y", "z", "w"];
const SIDES: [&str; 2] = ["right", "left"];

/// Reads a layout for a robot with these joints.
pub(crate) fn load(
    path: &Path,
    joints: &[&str],
    reader: &mut ConfigReader,
) -> Result<FrameLayout, ConfigError> {
    let text = file::text(path, reader)?;
    read(&text, joints).map_err(|problems| ConfigError { file: path.to_owned(), problems })
}

/// A layout from the text of a DBC file, or all that is wrong with it.
pub fn read(text: &str, joints: &[&str]) -> Result<FrameLayout, Vec<Problem>> {
    let dbc = Dbc::try_from(text).map_err(|e| {
        vec![Problem { line: 0, key: String::new(), text: format!("this is not a DBC file: {e}") }]
    })?;
    let mut reader = DbcReader { text, joints, problems: Vec::new() };
    let layout = reader.layout(&dbc);
    if reader.problems.is_empty() { Ok(layout) } else { Err(reader.problems) }
}

struct DbcReader<'a> {
    text: &'a str,
    joints: &'a [&'a str],
    problems: Vec<Problem>,
}

impl DbcReader<'_> {
    fn layout(&mut self, dbc: &Dbc) -> FrameLayout {
        let nodes: Vec<String> = dbc.nodes.iter().map(|n| n.0.clone()).filter(|n| n != PC).collect();
        if nodes.is_empty() || nodes.len() > MAX_NODES || nodes.len() == dbc.nodes.len() {
            let text = format!("BU_: there must be `{PC}` and 1 to {MAX_NODES} local controllers");
            self.problem(0, "", text);
        }
        let mut messages = Vec::new();
        for message in &dbc.messages {
            self.message(dbc, message, &nodes, &mut messages);
        }
        for node in 0..nodes.len() {
            self.one_sync_at_the_end(&nodes[node], messages.iter().filter(|m| m.node == node));
        }
        self.everything_once(&messages);
        for (to_drives, from) in [(true, "to"), (false, "from")] {
            let count = messages.iter().filter(|m| m.to_drives == to_drives).count();
            if count > MAX_FRAMES || messages.len() > MAX_MESSAGES {
                self.problem(0, "", format!("{count} messages {from} the drives; at most {MAX_FRAMES}"));
            }
        }
        FrameLayout::new(nodes, messages)
    }

    /// A message, once for each node that sends or receives it.
    fn message(&mut self, dbc: &Dbc, m: &can_dbc::Message, nodes: &[String], into: &mut Vec<BusMessage>) {
        let line = self.line(&format!("BO_ {} ", m.id.raw()), 0);
        let to_drives = m.transmitter.as_deref() == Some(PC);
        // The other end is the sender, or of a message of the PC whoever receives its first signal.
        let first = m.signals.first().map(|s| s.receivers.as_slice()).unwrap_or_default();
        let ends = if to_drives { first } else { m.transmitter.as_slice() };
        let at: Vec<usize> = ends.iter().filter_map(|end| nodes.iter().position(|n| n == end)).collect();
        let MessageId::Standard(id) = m.id else {
            return self.problem(line, &m.name, "identifiers of 29 bits are not used here".into());
        };
        if at.is_empty() || at.len() < ends.len() {
            let text = format!(
                "sender and receiver are `{PC}` and a node of {}, in one order or the other",
                nodes.join(", ")
            );
            self.problem(line, &m.name, text);
        }
        if id >= 0x800 || m.size == 0 || m.size > 64 {
            self.problem(
                line,
                &m.name,
                format!("identifier {id}, {} bytes: below 2048, and 1 to 64", m.size),
            );
        }
        // Bits in use, so that no two signals share one.
        let mut used = [0u64; 8];
        let signals =
            m.signals.iter().filter_map(|s| self.signal(dbc, m, s, to_drives, &mut used)).collect::<Vec<_>>();
        let cyclic = !matches!(
            dbc.resolved_message_attribute(m.id, "GenMsgCycleTime"),
            Some(AttributeValue::Double(0.0) | AttributeValue::Uint(0) | AttributeValue::Int(0))
        );
        for node in at {
            if into.iter().any(|other| other.node == node && other.id == u32::from(id)) {
                self.problem(line, &m.name, format!("identifier {id} is taken on this line"));
            }
            into.push(BusMessage {
                name: m.name.clone(),
                id: id.into(),
                len: m.size as u32,
                node,
                to_drives,
                cyclic,
                signals: signals.clone(),
            });
        }
    }

    fn signal(
        &mut self,
        dbc: &Dbc,
        m: &can_dbc::Message,
        s: &can_dbc::Signal,
        to_drives: bool,
        used: &mut [u64; 8],
    ) -> Option<BusSignal> {
        let line = self.line(&format!("SG_ {} ", s.name), self.line(&format!("BO_ {} ", m.id.raw()), 0));
        let key = format!("{}.{}", m.name, s.name);
        let mut wrong = |text: String| self.problems.push(Problem { line, key: key.clone(), text });
        // Number formats that the flat table of the codec can hold.
        let plain = s.multiplexer_indicator == MultiplexIndicator::Plain;
        if s.byte_order != ByteOrder::LittleEndian || !plain {
            wrong("must be Intel (@1) and not multiplexed".into());
        }
        if dbc.extended_value_type_for_signal(m.id, &s.name).is_some() {
            wrong("must be an integer with a scale, not a floating point number".into());
        }
        if !(s.factor.is_finite() && s.factor > 0.0 && s.offset.is_finite()) {
            wrong(format!("({},{}): the factor must be above 0, both finite", s.factor, s.offset));
        }
        if s.size == 0 || s.size > 32 || s.start_bit + s.size > 8 * m.size {
            wrong(format!("{}|{}: 1 to 32 bits within {} bytes", s.start_bit, s.size, m.size));
            return None;
        }
        // Place: no overlap with another signal.
        for bit in s.start_bit as usize..(s.start_bit + s.size) as usize {
            if used[bit / 64] >> (bit % 64) & 1 == 1 {
                wrong(format!("bit {bit} belongs to another signal, too"));
                break;
            }
            used[bit / 64] |= 1 << (bit % 64);
        }
        let carries = match self.carries(&s.name, to_drives) {
            Ok(carries) => carries,
            Err(text) => {
                self.problems.push(Problem { line, key, text });
                return None;
            }
        };
        let signed = s.value_type == ValueType::Signed;
        if carries == Carries::Counter && (signed || s.factor != 1.0 || s.offset != 0.0) {
            self.problem(line, &key, "a counter is unsigned, with factor 1 and offset 0".into());
        }
        let (start, bits) = (s.start_bit as u32, s.size as u32);
        Some(BusSignal {
            name: s.name.clone(),
            start,
            bits,
            signed,
            scale: s.factor,
            offset: s.offset,
            carries,
        })
    }

    /// Meaning of a signal, by its name.
    fn carries(&self, name: &str, to_drives: bool) -> Result<Carries, String> {
        match (name, to_drives) {
            ("counter", _) => return Ok(Carries::Counter),
            ("mode", true) => return Ok(Carries::Mode),
            ("nmt_command", true) => return Ok(Carries::NetworkCommand),
            ("nmt_node", true) => return Ok(Carries::NetworkNode),
            ("supply", false) => return Ok(Carries::Supply),
            _ => {}
        }
        // Sensors: SENSOR_QUANTITY_AXIS.
        let axis = |axis: &str, most: usize| AXES[..most].iter().position(|a| *a == axis);
        let parts: Vec<&str> = name.split('_').collect();
        if let (&[what, kind, k], false) = (parts.as_slice(), to_drives) {
            let foot = SIDES.iter().position(|side| *side == what);
            let found = match (what, kind, foot) {
                ("imu", "quaternion", _) => axis(k, 4).map(Carries::Orientation),
                ("imu", "rate", _) => axis(k, 3).map(Carries::Rate),
                ("imu", "accel", _) => axis(k, 3).map(Carries::Acceleration),
                (_, "force", Some(foot)) => axis(k, 3).map(|k| Carries::Force(foot, k)),
                (_, "moment", Some(foot)) => axis(k, 3).map(|k| Carries::Moment(foot, k)),
                _ => None,
            };
            if let Some(found) = found {
                return Ok(found);
            }
        }
        // Joints, whose names have underscores themselves: JOINT_QUANTITY.
        let (joint, quantity) = name.rsplit_once('_').unwrap_or((name, ""));
        let make: fn(usize) -> Carries = match (quantity, to_drives) {
            ("target", true) => Carries::Target,
            ("feed", true) => Carries::Feed,
            ("control", true) => Carries::Control,
            ("angle", false) => Carries::Angle,
            ("speed", false) => Carries::Speed,
            ("motor", false) => Carries::Motor,
            ("mspeed", false) => Carries::MotorSpeed,
            ("current", false) => Carries::Current,
            ("status", false) => Carries::Status,
            ("temp", false) => Carries::Temperature,
            ("error", false) => Carries::Error,
            ("network", false) => Carries::NetworkState,
            ("letters" | "index" | "query" | "float" | "value", _) => Carries::Interpreter,
            _ => {
                let there = if to_drives {
                    "counter, mode, nmt_command, nmt_node, JOINT_target, JOINT_feed, JOINT_control, JOINT_letters, _index, _value"
                } else {
                    "counter, supply, JOINT_angle, _speed, _motor, _mspeed, _current, _status, _temp, _error, \
                     _network, _letters, _index, _value, right_force_x, left_moment_z, imu_quaternion_w, imu_rate_x, imu_accel_x and the like"
                };
                return Err(format!("nothing of that name goes this way; there is {there}"));
            }
        };
        let index = self.joints.iter().position(|j| *j == joint);
        index.map(make).ok_or_else(|| {
            let near =
                nearest(joint, self.joints).map_or(String::new(), |n| format!("; the nearest is `{n}`"));
            format!("the robot has no joint `{joint}`{near}")
        })
    }

    fn one_sync_at_the_end<'m>(&mut self, node: &str, messages: impl Iterator<Item = &'m BusMessage>) {
        let to: Vec<&BusMessage> = messages.filter(|m| m.to_drives).collect();
        let syncs = to.iter().filter(|m| m.is_sync()).count();
        if syncs != 1 || !to.last().is_some_and(|m| m.is_sync()) {
            let text =
                "the last message to it, and no other, must carry `counter` alone: it ends the cycle".into();
            self.problem(0, node, text);
        }
    }

    /// Completeness: every robot's signals come once, and nothing twice.
    fn everything_once(&mut self, messages: &[BusMessage]) {
        let mut all: Vec<(Carries, &str)> = Vec::new();
        for signal in messages.iter().flat_map(|m| &m.signals) {
            let many = matches!(
                signal.carries,
                Carries::Counter
                    | Carries::Mode
                    | Carries::Supply
                    | Carries::Interpreter(_)
                    | Carries::NetworkCommand
                    | Carries::NetworkNode
            );
            if !many && all.iter().any(|(other, _)| *other == signal.carries) {
                self.problem(0, &signal.name, "comes more than once".into());
            }
            all.push((signal.carries, &signal.name));
        }
        // What a walk cannot do without; currents, temperatures and motor sides may be missing.
        let joints = self.joints;
        let tables = all.iter().any(|(carries, _)| matches!(carries, Carries::Interpreter(_)));
        let sensors =
            |(carries, _): &(Carries, &str)| matches!(carries, Carries::Force(..) | Carries::Orientation(_));
        let senses = !tables || all.iter().any(sensors);
        for (j, joint) in joints.iter().enumerate().filter(|_| tables) {
            for (to_drives, way) in [(true, "to"), (false, "from")] {
                let telegrams =
                    messages.iter().filter(|m| m.to_drives == to_drives && m.interpreter() == Some(j));
                if telegrams.filter(|m| m.len == interpreter::LEN && !m.cyclic).count() != 1 {
                    let text = format!(
                        "one message {way} its drive must hold _letters, _index, _query, _float and _value in 8 \
                         bytes, with a GenMsgCycleTime of 0"
                    );
                    self.problem(0, joint, text);
                }
            }
        }
        let mut need = |carries: Carries, name: String| {
            if !all.iter().any(|(other, _)| *other == carries) {
                self.problem(0, &name, "is missing".into());
            }
        };
        for (j, joint) in joints.iter().enumerate() {
            if tables {
                need(Carries::Control(j), format!("{joint}_control"));
            } else {
                need(Carries::Target(j), format!("{joint}_target"));
                need(Carries::Feed(j), format!("{joint}_feed"));
            }
            need(Carries::Angle(j), format!("{joint}_angle"));
            need(Carries::Speed(j), format!("{joint}_speed"));
        }
        for k in (0..3).filter(|_| senses) {
            for (foot, side) in SIDES.iter().enumerate() {
                need(Carries::Force(foot, k), format!("{side}_force_{}", AXES[k]));
                need(Carries::Moment(foot, k), format!("{side}_moment_{}", AXES[k]));
            }
            need(Carries::Rate(k), format!("imu_rate_{}", AXES[k]));
            need(Carries::Acceleration(k), format!("imu_accel_{}", AXES[k]));
        }
        (0..4)
            .filter(|_| senses)
            .for_each(|k| need(Carries::Orientation(k), format!("imu_quaternion_{}", AXES[k])));
        need(Carries::Mode, "mode".into());
        need(Carries::Supply, "supply".into());
    }

    /// Number of the first line after line `after` that has `what`; 0 if none.
    fn line(&self, what: &str, after: usize) -> usize {
        self.text.lines().skip(after).position(|line| line.contains(what)).map_or(0, |i| after + i + 1)
    }

    fn problem(&mut self, line: usize, key: &str, text: String) {
        self.problems.push(Problem { line, key: key.into(), text });
    }
}
