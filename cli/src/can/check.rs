//! `gangwerk can check RECORDING --against RUN.mcap`: the joint loop once more, without a bus and without a robot.
//!
//! The recorded frames go through [`JointLoop::receive`] and must give the logged `sensors` bit for bit; the logged
//! `joint_targets` go through [`JointLoop::send`] and must give the recorded frames to the drives.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};

use codec::frames::encode_sensors;
use codec::layout::FrameLayout;
use config::Setup;
use fieldbus::Capture;
use fieldbus::capture::FrameType;
use fieldbus::cycles::Cycles;
use fieldbus::owners::Owners;
use lowlevel::JointLoop;
use messages::topics::{JOINT_TARGETS, SENSORS};
use messages::{BusFrames, Frame, Header, JointTargets, Sensors};
use recording::Log;
use recording::cdr::CdrEncoder;

use super::file;

/// Inputs of the comparison.
#[derive(clap::Args)]
pub struct CheckOptions {
    /// A candump log, ASC, TRC or MCAP file of the bus, from the begin of the run on.
    pub recording: PathBuf,
    /// The log of the run.
    #[arg(long, value_name = "MCAP")]
    pub against: PathBuf,
    /// Leave broken lines of the recording out, and tell how many.
    #[arg(long)]
    pub lenient: bool,
}

/// Compares.
///
/// # Errors
/// Something cannot be read; or the first difference: tick, frame, signal.
pub fn run(config: &Path, order: &CheckOptions) -> Result<(), Box<dyn Error>> {
    let log = Log::open(&order.against)?;
    let mut setup = Setup::load(config, &log.run().scene)?;
    let capture = file::read(&order.recording, order.lenient)?;
    if !capture.frames.iter().any(|frame| matches!(frame.form, FrameType::Fd { .. })) {
        setup = setup.on_bus(true)?;
    }
    let outcome = Comparison::new(&setup, &capture, &log)?.run();
    let other = if setup.hash == log.run().config_hash {
        ""
    } else {
        "\nThe configuration is another one than that of the run; that may be the reason."
    };
    let Equal { cycles, of, answers, told } = outcome.map_err(|different| format!("{different}{other}"))?;
    if cycles == 0 {
        return Err("the recording ends before its first whole cycle: there is nothing to compare".into());
    }
    println!(
        "{cycles} of the log's {of} cycles: sensors of {answers} frames and {told} frames to the drives are the same, bit for bit"
    );
    Ok(())
}

/// Counts of equal frames and values.
struct Equal {
    cycles: u64,
    /// Cycles of the log.
    of: usize,
    answers: u64,
    told: u64,
}

struct Comparison<'a> {
    layout: &'a FrameLayout,
    capture: &'a Capture,
    cycles: Cycles,
    joints: JointLoop,
    sensors: Vec<Sensors>,
    targets: BTreeMap<u64, JointTargets>,
}

impl<'a> Comparison<'a> {
    fn new(setup: &'a Setup, capture: &'a Capture, log: &Log) -> Result<Self, Box<dyn Error>> {
        let layout = &setup.robot.layout;
        let cycles = Cycles::of(layout, &Owners::of(layout, capture), capture);
        if cycles.ticks() == 0 {
            let robot = &setup.robot.name;
            return Err(
                format!("there is no SYNC frame of {robot} in the recording: is it of this robot?").into()
            );
        }
        let sensors = log.records::<Sensors>(&SENSORS)?;
        if sensors.is_empty() {
            return Err("there is no record of `sensors` in the log".into());
        }
        let targets = log.records::<JointTargets>(&JOINT_TARGETS)?;
        let targets = targets.into_iter().map(|t| (t.header.tick, t)).collect();
        let joints = JointLoop::new(&setup.robot, &setup.system, setup.scene.cycle);
        Ok(Self { layout, capture, cycles, joints, sensors, targets })
    }

    /// Cycle by cycle, to the end of the shorter one.
    fn run(mut self) -> Result<Equal, String> {
        let mut equal = Equal { cycles: 0, of: self.sensors.len(), answers: 0, told: 0 };
        let (mut from, mut to) = (CdrEncoder::new(), CdrEncoder::new());
        for (i, logged) in std::mem::take(&mut self.sensors).iter().enumerate() {
            let tick = i as u64 + 1;
            if logged.header.tick != tick {
                return Err(format!("the log holds no `sensors` of cycle {tick}: records were lost"));
            }
            if tick >= self.cycles.ticks() {
                break;
            }
            let answers = self.cycles.answers(self.capture, tick - 1);
            let mut found = *self.joints.receive(tick, logged.header.stamp_ns, Some(&answers));
            found.header.epoch = logged.header.epoch;
            if from.encode(&found) != to.encode(logged) {
                return Err(self.sensors_differ(tick, &found, logged, &answers));
            }
            let newest = self.targets.range(..=tick).next_back().map(|(_, targets)| targets);
            let (frames, _) = self.joints.send(newest, None);
            let told = self.cycles.told(self.capture, tick);
            if let Some(different) =
                differs(self.layout, "the log's targets give", frames, "recorded is", &told)
            {
                return Err(format!("cycle {tick}, to the drives: {different}"));
            }
            equal.cycles += 1;
            equal.answers += answers.count;
            equal.told += told.count;
        }
        Ok(equal)
    }

    /// The frame and the signal in which recording and log differ.
    fn sensors_differ(&self, tick: u64, found: &Sensors, logged: &Sensors, answers: &BusFrames) -> String {
        let mut before = *logged;
        before.header = Header { tick: tick - 1, ..Header::default() };
        let mut expected = BusFrames::default();
        encode_sensors(self.layout, &before, &mut expected);
        let different = differs(self.layout, "the log says", &expected, "recorded is", answers);
        let frames_missed = if found.frames_missed == logged.frames_missed {
            String::new()
        } else {
            format!(
                "; frames missed: {} by the recording, {} by the log",
                found.frames_missed, logged.frames_missed
            )
        };
        let different =
            different.unwrap_or_else(|| "no frame differs, but what the joint loop made of them".into());
        format!("cycle {tick}, from the drives: {different}{frames_missed}")
    }
}

/// The first frame that is not the same in both, with its first signal that differs.
fn differs(layout: &FrameLayout, a_is: &str, a: &BusFrames, b_is: &str, b: &BusFrames) -> Option<String> {
    let same = |x: &Frame, y: &Frame| (x.line, x.id) == (y.line, y.id);
    for x in a.as_slice() {
        let name = describe(layout, x);
        let Some(y) = b.as_slice().iter().find(|y| same(x, y)) else {
            return Some(format!("{name} is missing in the recording"));
        };
        if (x.len, x.data) != (y.len, y.data) {
            return Some(format!("{name}: {}", signal_differs(layout, a_is, x, b_is, y)));
        }
    }
    let more = b.as_slice().iter().find(|y| !a.as_slice().iter().any(|x| same(x, y)));
    more.map(|y| format!("{} stands in the recording, but does not belong there", describe(layout, y)))
}

fn describe(layout: &FrameLayout, frame: &Frame) -> String {
    let node = layout.nodes.get(frame.line as usize).map_or("?", String::as_str);
    match layout.find(frame.line, frame.id) {
        Some(i) => format!("frame {:03X} {} of {node}", frame.id, layout.messages[i].name),
        None => format!("unknown frame {:03X} at {node}", frame.id),
    }
}

fn signal_differs(layout: &FrameLayout, a_is: &str, a: &Frame, b_is: &str, b: &Frame) -> String {
    if a.len != b.len {
        return format!("{a_is} {} bytes, {b_is} {}", a.len, b.len);
    }
    let message = layout.find(a.line, a.id).map(|i| &layout.messages[i]);
    let signal = message.and_then(|m| m.signals.iter().find(|s| s.get(&a.data) != s.get(&b.data)));
    match signal {
        Some(s) => {
            let value = |frame: &Frame| s.value(s.get(&frame.data));
            let unit = super::decoder::unit(s.carries);
            format!("signal {}: {a_is} {} {unit}, {b_is} {} {unit}", s.name, value(a), value(b))
        }
        None => "bits that belong to no signal differ".into(),
    }
}
