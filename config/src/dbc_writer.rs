//! DBC files from a robot's file, for local controllers that have no frames of their own yet: `gangwerk robot frames NAME`.
//!
//! One line per local controller, point to point. Identifiers (hexadecimal, n: index of the local controller, k: of its
//! joint):
//!
//! | frame | classic CAN | CAN FD |
//! |---|---|---|
//! | targets | 100 + 4 n + k, controlwords 140 + 4 n | 100 + n |
//! | end of the cycle | 080 + 4 n | 080 + n |
//! | link sides | 180 + 4 n + k | 200 + n, with status and, if there is room, currents |
//! | motor sides | 1c0 + 4 n + k | 280 + n, with winding temperatures and error codes; of more than 4 joints 380 + n |
//! | currents, status, temperatures, error codes | 200, 240, 280, 2c0 + 4 n | |
//! | foot: force, moment | 300, 301 + 4 n; of a second one 302, 303 + 4 n | 300 right, 301 left |
//! | inertial sensor | 340 to 343 | 310 |

use std::fmt::Write as _;

use crate::dbc_words;
use crate::section::Section;

/// Most joints of a local controller on classic CAN: controlwords of 16 bits beside counter and mode in 8 bytes.
const CLASSIC_JOINTS: usize = 3;
/// Most joints on CAN FD: target and speed of 32 bits and a controlword each, beside 4 bytes of head, in 64 bytes.
const FD_JOINTS: usize = 6;
/// Most local controllers on classic CAN: room between two kinds of identifiers.
const CLASSIC_NODES: usize = 16;
/// \[byte\] Lengths of a CAN FD frame.
const FD_LENGTHS: [u32; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64];
/// \[ms\] Bus cycle for which the files are written; readers of traffic take it as the expected period of each frame.
const CYCLES: [&str; 2] = ["3.5", "1"];
/// Mark of a file that was written here, in its comment.
pub const WRITTEN_BY: &str = "Written by `gangwerk robot frames`";
const AXES: [&str; 3] = ["x", "y", "z"];
/// Sensors of a local controller besides its drives.
const SENSORS: [&str; 3] = ["right_foot", "left_foot", "imu"];

/// CAN with 8 bytes per frame, or CAN FD with up to 64.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameForm {
    /// Classic CAN.
    Classic,
    /// CAN FD; also the frames in shared memory and Sercos telegrams.
    Fd,
}

/// A local controller: what it drives and reads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LocalController {
    /// Name of the controller.
    pub name: String,
    /// Names of the controller's joints, in the order of their frames.
    pub joints: Vec<String>,
    /// Sensors of the controller: `right_foot`, `left_foot`, `imu`.
    pub sensors: Vec<String>,
}

impl LocalController {
    /// One `[[can.node]]`.
    pub(crate) fn build(node: &Section<'_, '_>) -> Self {
        let sensors = if node.has("sensors") { node.texts("sensors") } else { Vec::new() };
        for sensor in sensors.iter().filter(|sensor| !SENSORS.contains(&sensor.as_str())) {
            node.problem(
                "sensors",
                format!("there is no sensor `{sensor}`; there is {}", SENSORS.join(", ")),
            );
        }
        Self { name: node.text("name"), joints: node.texts("joints"), sensors }
    }
}

/// Text of a DBC file for a robot with these local controllers. `motor_side`: the drives report it, too.
///
/// Completeness of joints and sensors is checked by the reader, [`crate::dbc::read`].
///
/// # Errors
/// A local controller has more joints than its frames have room for.
pub fn dbc_text(
    robot: &str,
    nodes: &[LocalController],
    motor_side: bool,
    form: FrameForm,
) -> Result<String, String> {
    let most = match form {
        FrameForm::Classic => CLASSIC_JOINTS,
        FrameForm::Fd => FD_JOINTS,
    };
    if let Some(node) = nodes.iter().find(|node| node.joints.len() > most) {
        let (name, count) = (&node.name, node.joints.len());
        let bus = if form == FrameForm::Fd { "CAN FD" } else { "classic CAN" };
        return Err(format!("can.node: `{name}` has {count} joints; frames of {bus} have room for {most}"));
    }
    if form == FrameForm::Classic && nodes.len() > CLASSIC_NODES {
        return Err(format!("can.node: {} on classic CAN; at most {CLASSIC_NODES}", nodes.len()));
    }
    // In the order in which they are sent: commands to every controller, then the answers of each.
    let mut file = DbcFile { frames: Vec::new() };
    for (n, node) in nodes.iter().enumerate() {
        match form {
            FrameForm::Classic => file.command_classic(n as u32, node),
            FrameForm::Fd => file.command_fd(n as u32, node),
        }
    }
    for (n, node) in nodes.iter().enumerate() {
        match form {
            FrameForm::Classic => file.answer_classic(n as u32, node, motor_side),
            FrameForm::Fd => file.answer_fd(n as u32, node, motor_side),
        }
    }
    Ok(file.text(robot, nodes, form))
}

/// Kind of a number: bits (negative: signed), value of the lowest bit, value of raw 0, unit.
struct NumberKind(i32, f64, f64, &'static str);

/// A signed number over ±2^`power`.
fn signed(bits: i32, power: i32, unit: &'static str) -> NumberKind {
    NumberKind(-bits, f64::powi(2.0, power - bits + 1), 0.0, unit)
}

fn unsigned(bits: i32) -> NumberKind {
    NumberKind(bits, 1.0, 0.0, "")
}

/// Temperatures from -40 degrees on.
const TEMPERATURE: NumberKind = NumberKind(8, 1.0, -40.0, "degC");

struct DbcSignal {
    name: String,
    start: u32,
    number: NumberKind,
}

struct DbcFrame {
    id: u32,
    name: String,
    /// \[byte\]
    len: u32,
    /// Sender and receiver.
    ends: [String; 2],
    comment: &'static str,
    signals: Vec<DbcSignal>,
}

/// A frame being filled, from its first bit on.
struct FrameFilling {
    frame: DbcFrame,
    /// \[bit\] Behind the last signal.
    end: u32,
}

impl FrameFilling {
    fn put(&mut self, name: impl Into<String>, number: NumberKind) {
        let start = self.end;
        self.end += number.0.unsigned_abs();
        self.frame.signals.push(DbcSignal { name: name.into(), start, number });
    }

    /// For each joint what `of` names.
    fn each(&mut self, node: &LocalController, of: &str, number: impl Fn() -> NumberKind) {
        for joint in &node.joints {
            self.put(format!("{joint}_{of}"), number());
        }
    }

    fn axes(&mut self, what: &str, number: impl Fn() -> NumberKind) {
        for axis in AXES {
            self.put(format!("{what}_{axis}"), number());
        }
    }
}

struct DbcFile {
    frames: Vec<DbcFrame>,
}

const SYNC: &str =
    "Ends the cycle: what was sent before takes effect, sensors are read, and the answer is sent.";
const WRENCH: &str = "Ground on the foot, sensor frame.";

impl DbcFile {
    /// A frame with its counter; `form` decides how long that is, and the length of the frame.
    fn frame(
        &mut self,
        form: FrameForm,
        (id, name): (u32, String),
        (node, to_drives): (&LocalController, bool),
        comment: &'static str,
        fill: impl FnOnce(&mut FrameFilling),
    ) {
        let mut ends = ["PC".to_owned(), node.name.clone()];
        if !to_drives {
            ends.reverse();
        }
        let frame = DbcFrame { id, name, len: 0, ends, comment, signals: Vec::new() };
        let mut filling = FrameFilling { frame, end: 0 };
        filling.put("counter", unsigned(if form == FrameForm::Fd { 16 } else { 8 }));
        fill(&mut filling);
        let bytes = filling.end.div_ceil(8);
        filling.frame.len = match form {
            FrameForm::Classic => bytes,
            FrameForm::Fd => FD_LENGTHS.into_iter().find(|len| *len >= bytes).unwrap_or(bytes),
        };
        self.frames.push(filling.frame);
    }

    fn command_classic(&mut self, n: u32, node: &LocalController) {
        let form = FrameForm::Classic;
        for (k, joint) in (0..).zip(&node.joints) {
            let head = (0x100 + 4 * n + k, format!("{joint}_to"));
            self.frame(form, head, (node, true), "Target of one joint.", |frame| {
                frame.put(format!("{joint}_target"), signed(28, 3, "rad"));
                frame.put(format!("{joint}_feed"), signed(28, 7, "rad/s"));
            });
        }
        let comment = "Mode (0 off, 1 hold, 2 track, 3 stop) and controlwords of CiA 402.";
        self.frame(form, (0x140 + 4 * n, format!("node{n}_control")), (node, true), comment, |frame| {
            frame.put("mode", unsigned(8));
            frame.each(node, "control", || unsigned(16));
        });
        self.frame(form, (0x80 + 4 * n, format!("node{n}_sync")), (node, true), SYNC, |_| {});
    }

    fn answer_classic(&mut self, n: u32, node: &LocalController, motor_side: bool) {
        let form = FrameForm::Classic;
        let sides = [
            (0x180, "link", ["angle", "speed"], "Link side: absolute encoder."),
            (
                0x1c0,
                "shaft",
                ["motor", "mspeed"],
                "Motor side: incremental encoder, divided by the gear ratio.",
            ),
        ];
        // Angle and speed of one side fill a frame.
        for (k, joint) in (0..).zip(&node.joints) {
            for (base, side, [angle, speed], comment) in &sides[..1 + usize::from(motor_side)] {
                let head = (base + 4 * n + k, format!("{joint}_{side}"));
                self.frame(form, head, (node, false), comment, |frame| {
                    frame.put(format!("{joint}_{angle}"), signed(28, 3, "rad"));
                    frame.put(format!("{joint}_{speed}"), signed(28, 7, "rad/s"));
                });
            }
        }
        // Slower quantities of all drives share a frame each.
        let mut of_drives = |base: u32, name: &str, comment, fill: &dyn Fn(&mut FrameFilling)| {
            self.frame(form, (base + 4 * n, format!("node{n}_{name}")), (node, false), comment, fill);
        };
        of_drives(0x200, "current", "Motor currents.", &|frame| {
            frame.each(node, "current", || signed(16, 7, "A"));
        });
        of_drives(0x240, "status", "Motor supply, and statuswords of CiA 402.", &|frame| {
            frame.put("supply", unsigned(8));
            frame.each(node, "status", || unsigned(16));
        });
        of_drives(0x280, "health", "Windings.", &|frame| frame.each(node, "temp", || TEMPERATURE));
        of_drives(0x2c0, "error", "Error codes of CiA 402.", &|frame| {
            frame.each(node, "error", || unsigned(16));
        });
        for sensor in &node.sensors {
            self.sensor_classic(n, node, sensor);
        }
    }

    fn sensor_classic(&mut self, n: u32, node: &LocalController, sensor: &str) {
        let mut send = |id, name: String, comment, fill: &dyn Fn(&mut FrameFilling)| {
            self.frame(FrameForm::Classic, (id, name), (node, false), comment, fill);
        };
        if let Some(side) = sensor.strip_suffix("_foot") {
            let kinds = [("force", 11, "N"), ("moment", 8, "Nm")];
            // Two feet at one local controller: the second behind the first.
            let first = !(sensor == "left_foot" && node.sensors.iter().any(|other| other == "right_foot"));
            for (i, (what, power, unit)) in (if first { 0 } else { 2 }..).zip(kinds) {
                send(0x300 + 4 * n + i, format!("{sensor}_{what}"), WRENCH, &|frame| {
                    frame.axes(&format!("{side}_{what}"), || signed(18, power, unit));
                });
            }
            return;
        }
        for (i, pair) in (0..).zip([["x", "y"], ["z", "w"]]) {
            let comment = "Unit quaternion, world from torso.";
            send(0x340 + i, format!("imu_quaternion_{}", pair.concat()), comment, &|frame| {
                for part in pair {
                    frame.put(format!("imu_quaternion_{part}"), signed(28, 1, ""));
                }
            });
        }
        send(0x342, "imu_rate".into(), "Axes of the torso.", &|frame| {
            frame.axes("imu_rate", || signed(18, 4, "rad/s"));
        });
        let comment = "Specific force, axes of the torso: +9.81 upwards at rest.";
        send(0x343, "imu_accel".into(), comment, &|frame| frame.axes("imu_accel", || signed(18, 6, "m/s2")));
    }

    fn command_fd(&mut self, n: u32, node: &LocalController) {
        let form = FrameForm::Fd;
        let comment = "Mode (0 off, 1 hold, 2 track, 3 stop), targets, controlwords of CiA 402.";
        self.frame(form, (0x100 + n, format!("node{n}_targets")), (node, true), comment, |frame| {
            frame.put("mode", unsigned(8));
            frame.end = 32;
            for joint in &node.joints {
                frame.put(format!("{joint}_target"), signed(32, 2, "rad"));
                frame.put(format!("{joint}_feed"), signed(32, 5, "rad/s"));
            }
            frame.each(node, "control", || unsigned(16));
        });
        self.frame(form, (0x80 + n, format!("node{n}_sync")), (node, true), SYNC, |_| {});
    }

    fn answer_fd(&mut self, n: u32, node: &LocalController, motor_side: bool) {
        let form = FrameForm::Fd;
        // Link side and status: 10 bytes a joint; with the current 14, beside 4 of the head.
        let currents_fit = 4 + 14 * node.joints.len() <= 64;
        let comment = if currents_fit {
            "Motor supply, link side, currents, statuswords of CiA 402."
        } else {
            "Motor supply, link side, statuswords of CiA 402."
        };
        self.frame(form, (0x200 + n, format!("node{n}_joints")), (node, false), comment, |frame| {
            frame.put("supply", unsigned(8));
            frame.end = 32;
            for joint in &node.joints {
                frame.put(format!("{joint}_angle"), signed(32, 2, "rad"));
                frame.put(format!("{joint}_speed"), signed(32, 5, "rad/s"));
                if currents_fit {
                    frame.put(format!("{joint}_current"), signed(32, 11, "A"));
                }
            }
            frame.each(node, "status", || unsigned(16));
        });
        // The motor side, 8 bytes a joint, beside temperature and error code, 3; with the currents it has a frame of its own.
        let motors = |frame: &mut FrameFilling| {
            frame.end = 32;
            for joint in &node.joints {
                frame.put(format!("{joint}_motor"), signed(32, 2, "rad"));
                frame.put(format!("{joint}_mspeed"), signed(32, 5, "rad/s"));
            }
        };
        let comment = match (motor_side, currents_fit) {
            (true, true) => "Motor side divided by the gear ratio, windings, error codes of CiA 402.",
            (false, true) => "Windings, error codes of CiA 402.",
            (_, false) => "Currents, windings, error codes of CiA 402.",
        };
        if motor_side && !currents_fit {
            let comment = "Motor side divided by the gear ratio.";
            self.frame(form, (0x380 + n, format!("node{n}_motors")), (node, false), comment, motors);
        }
        self.frame(form, (0x280 + n, format!("node{n}_drives")), (node, false), comment, |frame| {
            frame.end = 32;
            if motor_side && currents_fit {
                motors(frame);
            }
            if !currents_fit {
                frame.each(node, "current", || signed(32, 11, "A"));
            }
            for joint in &node.joints {
                frame.put(format!("{joint}_temp"), TEMPERATURE);
                frame.put(format!("{joint}_error"), unsigned(16));
            }
        });
        for sensor in &node.sensors {
            self.sensor_fd(node, sensor);
        }
    }

    fn sensor_fd(&mut self, node: &LocalController, sensor: &str) {
        let id = 0x300 + [0, 1, 0x10][SENSORS.iter().position(|s| s == &sensor).unwrap_or(2)];
        let side = sensor.strip_suffix("_foot");
        let imu = "Unit quaternion world from torso; rate and specific force in axes of the torso.";
        let comment = if side.is_some() { WRENCH } else { imu };
        self.frame(FrameForm::Fd, (id, sensor.to_owned()), (node, false), comment, |frame| {
            frame.end = 32;
            if let Some(side) = side {
                frame.axes(&format!("{side}_force"), || signed(32, 15, "N"));
                frame.axes(&format!("{side}_moment"), || signed(32, 15, "Nm"));
            } else {
                frame.axes("imu_quaternion", || signed(32, 1, ""));
                frame.put("imu_quaternion_w", signed(32, 1, ""));
                frame.axes("imu_rate", || signed(32, 5, "rad/s"));
                frame.axes("imu_accel", || signed(32, 11, "m/s2"));
            }
        });
    }

    fn text(&self, robot: &str, nodes: &[LocalController], form: FrameForm) -> String {
        let mut out = String::from(
            "VERSION \"1\"\n\nNS_ :\n\tBA_\n\tBA_DEF_\n\tBA_DEF_DEF_\n\tCM_\n\tVAL_\n\nBS_:\n\nBU_: PC",
        );
        nodes.iter().for_each(|node| _ = write!(out, " {}", node.name));
        out.push('\n');
        for frame in &self.frames {
            let [from, to] = &frame.ends;
            let _ = write!(out, "\nBO_ {} {}: {} {from}\n", frame.id, frame.name, frame.len);
            frame.signals.iter().for_each(|signal| signal.write(to, &mut out));
        }
        let place = match form {
            FrameForm::Classic => "classic CAN",
            FrameForm::Fd => "CAN FD, and in shared memory and Sercos telegrams",
        };
        let _ = write!(
            out,
            "\nCM_ \"Frames of {robot} on {place}. One line per node, point to point. PC is the on-board computer \
             (lowlevel). Names of signals say what they carry: docs/can.md. {WRITTEN_BY}.\";\n"
        );
        for node in nodes {
            let all: Vec<&str> = node.joints.iter().chain(&node.sensors).map(String::as_str).collect();
            let _ = writeln!(out, "CM_ BU_ {} \"{}\";", node.name, all.join(", "));
        }
        self.attributes(form, &mut out);
        for frame in &self.frames {
            let _ = writeln!(out, "CM_ BO_ {} \"{}\";", frame.id, frame.comment);
        }
        self.words(&mut out);
        out
    }

    /// `BA_`: bus, form of the frames, period.
    fn attributes(&self, form: FrameForm, out: &mut String) {
        if form == FrameForm::Fd {
            let reserved = "\"reserved\",".repeat(10);
            let _ = write!(
                out,
                "BA_DEF_ \"BusType\" STRING ;\nBA_DEF_ BO_ \"VFrameFormat\" ENUM \"StandardCAN\",\"ExtendedCAN\",\
                 \"reserved\",\"J1939PG\",{reserved}\"StandardCAN_FD\",\"ExtendedCAN_FD\";\n"
            );
        }
        out.push_str("BA_DEF_ BO_ \"GenMsgCycleTime\" FLOAT 0 10000;\n");
        if form == FrameForm::Fd {
            out.push_str("BA_DEF_DEF_ \"BusType\" \"\";\nBA_DEF_DEF_ \"VFrameFormat\" \"StandardCAN\";\n");
        }
        let _ = writeln!(out, "BA_DEF_DEF_ \"GenMsgCycleTime\" {};", CYCLES[form as usize]);
        if form == FrameForm::Fd {
            out.push_str("BA_ \"BusType\" \"CAN FD\";\n");
            self.frames
                .iter()
                .for_each(|frame| _ = writeln!(out, "BA_ \"VFrameFormat\" BO_ {} 14;", frame.id));
        }
    }

    /// Comments and words of the signals that carry more than a number.
    fn words(&self, out: &mut String) {
        let mut words = String::new();
        for (id, signal) in self.frames.iter().flat_map(|f| f.signals.iter().map(|s| (f.id, s))) {
            let name = &signal.name;
            let Some((comment, values)) = dbc_words::of_signal(name) else { continue };
            if !comment.is_empty() {
                let _ = writeln!(out, "CM_ SG_ {id} {name} \"{comment}\";");
            }
            let _ = writeln!(words, "VAL_ {id} {name} {values} ;");
        }
        out.push_str(&words);
    }
}

impl DbcSignal {
    fn write(&self, receiver: &str, out: &mut String) {
        let NumberKind(bits, scale, offset, unit) = self.number;
        let (size, sign) = (bits.unsigned_abs(), if bits < 0 { '-' } else { '+' });
        let (low, high) = if bits < 0 {
            (-f64::powi(2.0, -bits - 1), f64::powi(2.0, -bits - 1) - 1.0)
        } else {
            (0.0, f64::powi(2.0, bits) - 1.0)
        };
        let (low, high) = (low * scale + offset, high * scale + offset);
        let (name, start) = (&self.name, self.start);
        let _ = writeln!(
            out,
            " SG_ {name} : {start}|{size}@1{sign} ({},{offset}) [{low}|{high}] \"{unit}\" {receiver}",
            decimal(scale)
        );
    }
}

/// A scale as CAN tools write it: two digits of exponent.
fn decimal(value: f64) -> String {
    if value >= 1e-4 {
        return value.to_string();
    }
    let text = format!("{value:e}");
    match text.split_once("e-") {
        Some((digits, exponent)) => format!("{digits}e-{exponent:0>2}"),
        None => text,
    }
}
