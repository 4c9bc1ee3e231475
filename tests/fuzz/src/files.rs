//! Readers that take a path: logs and scenes.

use crate::own_directory;
use messages::topics::SENSORS;
use messages::{Header, Sensors};
use recording::traffic::{CanFrame, TrafficWriter, read_traffic};
use recording::{Log, Recorder, RobotInfo, RunInfo, payload_hashes, repair};
use std::fs;

/// Everything that reads a log, and its repair, after which it is whole or refused.
pub(crate) fn mcap(bytes: &[u8]) {
    let path = own_directory().join("log.mcap");
    fs::write(&path, bytes).expect("a file in memory");
    if let Ok(log) = Log::open(&path) {
        let _ = log.each_attachment(|_, _| {});
        let _ = log.records::<Sensors>(&SENSORS);
        let _ = log.frames();
        let _ = payload_hashes(&path, |_| true);
    }
    let _ = read_traffic(&path, |_| {});
    if repair(&path).is_ok() {
        let again = repair(&path).expect("a repaired log is a log");
        assert_eq!(again.found, None, "once is enough");
    }
    let _ = fs::remove_file(own_directory().join("log.mcap.damaged"));
}

pub(crate) fn mcap_seeds() -> Vec<Vec<u8>> {
    let path = own_directory().join("seed.mcap");
    let mut log = Recorder::create(&path, &RobotInfo::default(), &RunInfo::default()).expect("a log");
    log.attach("note", b"kept").expect("room");
    for tick in 1..=3 {
        let header = Header { tick, stamp_ns: tick * 1_000_000, epoch: 1 };
        log.write(&SENSORS, &Sensors { header, ..Sensors::default() }).expect("room");
    }
    log.finish().expect("room");
    let run = fs::read(&path).expect("written");

    let mut traffic = TrafficWriter::create(&path).expect("a log");
    for id in 1..=3 {
        let frame =
            CanFrame { stamp_ns: 5, line: "vcan0", id, form: 0, flags: 0, way: 0, len: 2, data: &[1, 2] };
        traffic.write(&frame).expect("room");
    }
    traffic.finish().expect("room");
    let frames = fs::read(&path).expect("written");
    vec![run[..run.len() / 2].to_vec(), run, frames]
}

/// A scene as a user writes it.
pub(crate) fn scene(bytes: &[u8]) {
    // Objects are read from files: those of the shipped configuration only.
    if bytes.windows(2).any(|pair| pair == b"..") || bytes.contains(&b'/') || bytes.contains(&b'\\') {
        return;
    }
    let directory = own_directory().join("scenes");
    let _ = fs::create_dir_all(&directory);
    let path = directory.join("fuzzed.toml");
    fs::write(&path, bytes).expect("a file in memory");
    let _ = config::Scene::load(&path);
}

pub(crate) fn scene_seeds() -> Vec<Vec<u8>> {
    let names =
        ["bus_faults", "demo", "obstacle", "startup", "walk_auto", "walk_2kmh_sensors", "walk_tables"];
    let read = |name: &str| {
        let text =
            fs::read_to_string(config::root(None).join(format!("scenes/{name}.toml"))).expect("shipped");
        // Without comments and topics' slashes, see above.
        let lines = text.lines().filter(|line| !line.starts_with('#')).map(|line| format!("{line}\n"));
        lines.collect::<String>().replace('/', " ").into_bytes()
    };
    names.iter().map(|name| read(name)).collect()
}
