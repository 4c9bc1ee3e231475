//! Writes a log with something in every channel, and beside it the values that another reader must find there:
//! `cargo run -p recording --example peers_log -- DIR` makes `peers.mcap` and `peers.txt`, whose lines hold a channel
//! and all scalars of one message in the order of declaration; and the same of CAN lines, `traffic.mcap` and
//! `traffic.txt`. Used by `tests/peers/rosbags.sh`.

use messages::record::{Read, Visit};
use messages::topics::{ForType, with_type};
use messages::{Joints, Record, TOPICS, Topic};
use recording::traffic::{CanFrame, TrafficWriter};
use recording::{
    FootInfo, LinkFrame, LinkPoses, RecordedPose, Recorder, RecordingError, RobotInfo, RunInfo, channel_name,
};
use std::fmt::Write;
use std::path::Path;

const CYCLES: u64 = 30;

/// Numbers of all sizes that a reader can print and compare exactly.
struct Numbers(u64);
impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 16
    }
}
impl Read for Numbers {
    fn f64(&mut self) -> f64 {
        self.next() as f64 / 1e9 - 1e5
    }
    fn u64(&mut self) -> u64 {
        self.next()
    }
    fn u32(&mut self) -> u32 {
        self.next() as u32
    }
    fn u8(&mut self) -> u8 {
        self.next() as u8
    }
}

/// Lists every scalar of a record in the order of declaration.
struct Scalars(String);
impl Visit for Scalars {
    fn f64(&mut self, value: f64) {
        let _ = write!(self.0, " {value:?}");
    }
    fn u64(&mut self, value: u64) {
        let _ = write!(self.0, " {value}");
    }
    fn u32(&mut self, value: u32) {
        let _ = write!(self.0, " {value}");
    }
    fn i32(&mut self, value: i32) {
        let _ = write!(self.0, " {value}");
    }
    fn u8(&mut self, value: u8) {
        let _ = write!(self.0, " {value}");
    }
}

/// Writes one record of a topic.
struct WriteOne<'a> {
    recorder: &'a mut Recorder,
    tick: u64,
    expected: &'a mut String,
}
impl ForType<Result<(), RecordingError>> for WriteOne<'_> {
    fn call<T: Record>(self, topic: &'static Topic) -> Result<(), RecordingError> {
        let mut record = T::read(&mut Numbers(self.tick * 1000 + topic.name.len() as u64));
        record.header_mut().tick = self.tick;
        record.header_mut().stamp_ns = 1_000_000_000 + self.tick * 1_000_000;
        let mut scalars = Scalars(String::new());
        record.visit(&mut scalars);
        let _ = writeln!(self.expected, "{}{}", channel_name(topic.name), scalars.0);
        self.recorder.write(topic, &record)
    }
}

struct Hopper([LinkFrame; 3]);
impl LinkPoses for Hopper {
    fn links(&self) -> &[LinkFrame] {
        &self.0
    }
    fn poses(&mut self, base: &RecordedPose, _: &Joints, out: &mut [RecordedPose]) {
        out[0] = *base;
        out[1] = base.then(&RecordedPose::moved([0.0, -0.1, -0.9]));
        out[2] = base.then(&RecordedPose::moved([0.0, 0.1, -0.9]));
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let directory = std::env::args().nth(1).ok_or("usage: peers_log DIR")?;
    let directory = Path::new(&directory);
    let foot = |side: &str| FootInfo {
        link: format!("{side}_foot"),
        support: [-0.1, 0.2, -0.05, 0.05],
        sensor_link: format!("{side}_foot"),
        ..FootInfo::default()
    };
    let robot = RobotInfo {
        name: "hopper".into(),
        joints: vec!["right_leg".into(), "left_leg".into(), "neck".into()],
        urdf: "<robot name=\"hopper\"/>".into(),
        torso: "torso".into(),
        imu: [0.0; 3],
        feet: [foot("right"), foot("left")],
        odom: [0.0; 3],
    };
    let link = |name: &str, parent| LinkFrame { name: name.into(), parent, fixed: false };
    let hopper = Hopper([link("torso", None), link("right_foot", Some(0)), link("left_foot", Some(0))]);
    let mut recorder = Recorder::create(&directory.join("peers.mcap"), &robot, &RunInfo::default())?
        .with_links(Box::new(hopper));
    let mut expected = String::new();
    for tick in 0..CYCLES {
        for topic in TOPICS.iter().filter(|t| t.logged) {
            let write = WriteOne { recorder: &mut recorder, tick, expected: &mut expected };
            with_type(topic.name, write).unwrap_or(Ok(()))?;
        }
    }
    recorder.finish()?;
    std::fs::write(directory.join("peers.txt"), expected)?;
    traffic(directory)
}

/// Frames of all lengths on two lines.
fn traffic(directory: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let mut writer = TrafficWriter::create(&directory.join("traffic.mcap"))?;
    let mut expected = String::new();
    for k in 0..65u8 {
        let data: Vec<u8> = (0..k).map(|i| i.wrapping_mul(29).wrapping_add(k)).collect();
        let stamp_ns = 1_700_000_000_999_999_900 + u64::from(k);
        let line = ["vcan0", "can1"][usize::from(k % 2)];
        let (id, form) = (0x8000_0000 | u32::from(k) << 20, u8::from(k > 8));
        writer.write(&CanFrame {
            stamp_ns,
            line,
            id,
            form,
            flags: 5 * form,
            way: k % 3,
            len: k,
            data: &data,
        })?;
        let (seconds, rest) = (stamp_ns / 1_000_000_000, stamp_ns % 1_000_000_000);
        let _ =
            write!(expected, "/can/{line} {seconds} {rest} {line} {id} {form} {} {} {k}", 5 * form, k % 3);
        data.iter().for_each(|byte| {
            let _ = write!(expected, " {byte}");
        });
        expected.push('\n');
    }
    writer.finish()?;
    std::fs::write(directory.join("traffic.txt"), expected)?;
    Ok(())
}
