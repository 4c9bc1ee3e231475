//! Logs on disk: what is written is read again, also after a cut, and differences show.

use messages::record::Wrench;
use messages::topics::{CONTROLLER_STATE, EVENTS_CONTROLLER, PLAN, SENSORS, SIM_STATE, STATS_CONTROLLER};
use messages::{ControllerState, CycleStats, Event, EventCode, Joints, Plan, Sensors, SimState};
use recording::{
    FootInfo, LinkFrame, LinkPoses, Log, LogEnd, RecordedPose, Recorder, RecordingError, RobotInfo, RunInfo,
    WallClock, payload_hashes,
};
use std::path::{Path, PathBuf};

const CYCLES: u64 = 400;

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("recording_{name}"))
}

fn robot() -> RobotInfo {
    let foot = |side: &str| FootInfo {
        link: format!("{side}_foot"),
        sole: [0.0, 0.0, -0.05],
        support: [-0.1, 0.2, -0.06, 0.06],
        sensor_link: format!("{side}_foot"),
        sensor: [0.0, 0.0, 0.02],
    };
    RobotInfo {
        odom: [0.5, 0.0, 0.0],
        name: "two_sticks".into(),
        joints: vec!["right_hip".into(), "left_hip".into()],
        urdf: "<robot name=\"two_sticks\"/>".into(),
        torso: "torso".into(),
        imu: [0.1, 0.0, 0.2],
        feet: [foot("right"), foot("left")],
    }
}

fn run() -> RunInfo {
    RunInfo { scene: "test".into(), config_hash: 0xabc, software: "0.1.0".into(), ..RunInfo::default() }
}

struct TwoSticks([LinkFrame; 3]);
impl TwoSticks {
    fn new() -> Self {
        let link = |name: &str, parent| LinkFrame { name: name.into(), parent, fixed: false };
        Self([link("torso", None), link("right_foot", Some(0)), link("left_foot", Some(0))])
    }
}
impl LinkPoses for TwoSticks {
    fn links(&self) -> &[LinkFrame] {
        &self.0
    }
    fn poses(&mut self, torso: &RecordedPose, _: &Joints, out: &mut [RecordedPose]) {
        out.copy_from_slice(&[
            *torso,
            torso.then(&RecordedPose::moved([0.0, -0.1, -0.9])),
            torso.then(&RecordedPose::moved([0.0, 0.1, -0.9])),
        ]);
    }
}

fn sensors(tick: u64) -> Sensors {
    let mut sensors = Sensors::default();
    sensors.header.tick = tick;
    sensors.header.stamp_ns = tick * 1_000_000;
    sensors.joint_angle[1] = (tick as f64).sin();
    sensors.foot_wrench[1].force = [1.0, 2.0, 300.0];
    let (s, c) = (0.1 * tick as f64).sin_cos();
    sensors.imu.orientation = [0.0, 0.0, s, c];
    sensors
}

/// What the stabilizer makes of it: the right sole turns with the torso, and is 0.001 m further in each cycle.
fn believed(tick: u64) -> ControllerState {
    let mut state =
        ControllerState { header: sensors(tick).header, plan_id: 1, ..ControllerState::default() };
    state.origin = [1.0, 2.0, 0.3];
    state.feet[0] = [0.001 * tick as f64, 0.1, 0.0, 0.2 * tick as f64];
    state.com = [0.0, 0.0, 0.9];
    state
}

fn state(tick: u64) -> SimState {
    let mut state = SimState { header: sensors(tick).header, ..SimState::default() };
    state.position = [0.001 * tick as f64, 0.0, 1.0];
    let (s, c) = (0.1 * tick as f64).sin_cos();
    state.orientation = [0.0, 0.0, s, c];
    state.foot_wrench[0] = Wrench { force: [0.0, 0.0, 500.0], moment: [0.0; 3] };
    state
}

fn write(path: &Path, change: impl Fn(u64, &mut Sensors)) {
    let mut recorder =
        Recorder::create(path, &robot(), &run()).unwrap().with_links(Box::new(TwoSticks::new()));
    // As every log of a run: a file in it ends the chunk that describes the channels.
    recorder.attach("config/system.toml", b"[system]").unwrap();
    for tick in 0..CYCLES {
        let mut s = sensors(tick);
        change(tick, &mut s);
        recorder.write(&SENSORS, &s).unwrap();
        recorder.write(&SIM_STATE, &state(tick)).unwrap();
        recorder.write(&CONTROLLER_STATE, &believed(tick)).unwrap();
        let mut stats = CycleStats::default();
        stats.lateness_ns[0] = std::process::id().into();
        recorder.write(&STATS_CONTROLLER, &stats).unwrap();
    }
    recorder.finish().unwrap();
}

#[test]
fn records_come_back() {
    let path = file("records.mcap");
    let mut recorder = Recorder::create(&path, &robot(), &run()).unwrap();
    let mut plan = Plan { id: 7, ..Plan::default() };
    plan.header.stamp_ns = 5;
    recorder.write(&PLAN, &plan).unwrap();
    let controller = ControllerState { zmp: [f64::NAN, 0.25], ..ControllerState::default() };
    recorder.write(&CONTROLLER_STATE, &controller).unwrap();
    let event = Event { code: EventCode::PlanActive as u64, ..Event::default() };
    recorder.write(&EVENTS_CONTROLLER, &event).unwrap();
    recorder.finish().unwrap();

    let log = Log::open(&path).unwrap();
    assert_eq!((log.robot(), log.run()), (&robot(), &run()));
    assert_eq!(log.records::<Plan>(&PLAN).unwrap(), [plan]);
    assert_eq!(log.records::<Event>(&EVENTS_CONTROLLER).unwrap(), [event]);
    let back = log.records::<ControllerState>(&CONTROLLER_STATE).unwrap();
    assert!(back[0].zmp[0].is_nan() && back[0].zmp[1] == 0.25);
}

#[test]
fn standard_messages_are_thinned_and_verbatim_ones_are_not() {
    let path = file("rates.mcap");
    write(&path, |_, _| {});
    let mut counts = std::collections::BTreeMap::new();
    let end =
        Log::open(&path).unwrap().each(|m| *counts.entry(m.channel.to_string()).or_insert(0) += 1).unwrap();
    assert_eq!(end, LogEnd::Complete);
    for channel in ["/joint_states", "/imu/data", "/foot/right/wrench", "/foot/left/wrench"] {
        assert_eq!(counts[channel], CYCLES / 10, "{channel}");
    }
    // The truth only once there is a cycle to speak of.
    for (channel, count) in [("/tf", 40), ("/markers", 40), ("/truth/tf", 40), ("/truth/markers", 40)] {
        assert_eq!(counts[channel], count, "{channel}");
    }
    assert_eq!(counts["/gangwerk/sensors"], CYCLES);
    assert_eq!((counts["/robot_description"], counts["/tf_static"]), (1, 1));
}

#[test]
fn the_tree_of_frames_leads_to_where_the_robot_believes_its_links_to_be() {
    let path = file("frames.mcap");
    write(&path, |_, _| {});
    let trees = Log::open(&path).unwrap().frames().unwrap();
    assert_eq!(trees.len() as u64, CYCLES / 10);
    for tree in trees {
        let tick = tree.stamp_ns / 1_000_000;
        let find = |name: &str| tree.transforms.iter().find(|t| t.child == name).unwrap();
        let (torso, foot, sole) = (find("torso"), find("right_foot"), find("r_sole"));
        let parents = [torso, foot, sole].map(|t| t.parent.as_str());
        assert_eq!(parents, [Log::ODOM, "torso", "right_foot"]);
        let found = torso.pose.then(&foot.pose).then(&sole.pose);
        // By hand: the planning frame is turned by 0.3 rad.
        let ([x, y, z, heading], (s, c)) = (believed(tick).feet[0], 0.3f64.sin_cos());
        let expected = [1.0 + c * x - s * y, 2.0 + s * x + c * y, z];
        for k in 0..3 {
            assert!((found.position[k] - expected[k]).abs() < 1e-12, "{tick}: {found:?}, {expected:?}");
        }
        assert!((found.heading() - heading - 0.3).sin().abs() < 1e-12, "{tick}: {found:?}");
    }
}

#[test]
fn a_log_of_real_time_begins_on_its_day_and_one_of_simulated_time_at_zero() {
    let clock =
        WallClock { unix_ns: 1_700_000_000_000_000_000, monotonic_ns: 5_000_000_000, host: "hal".into() };
    for (name, clock, first) in
        [("wall.mcap", Some(clock), 1_700_000_000_200_000_000), ("simulated.mcap", None, 0)]
    {
        let path = file(name);
        let about = RunInfo { commit: "5c1f".into(), seed: 7, cycle_ns: 1_000_000, clock, ..run() };
        let mut recorder = Recorder::create(&path, &robot(), &about).unwrap();
        // Without a stamp: nobody has seen a cycle yet.
        recorder.write(&EVENTS_CONTROLLER, &Event { code: 1, ..Event::default() }).unwrap();
        for tick in 1..100 {
            let mut s = sensors(tick);
            s.header.stamp_ns += 5_199_000_000;
            recorder.write(&SENSORS, &s).unwrap();
        }
        recorder.finish().unwrap();
        let log = Log::open(&path).unwrap();
        assert_eq!(log.run(), &about, "what the log says about itself");
        let mut times = Vec::new();
        log.each(|m| times.push(m.log_time_ns)).unwrap();
        assert!(times.is_sorted(), "{name}");
        let last = about.clock.as_ref().map_or(5_298_000_000, |clock| clock.unix_ns(5_298_000_000));
        assert_eq!((times[0], *times.last().unwrap()), (first, last), "{name}");
    }
}

#[test]
fn a_log_cut_anywhere_gives_all_whole_messages_before_the_cut() {
    let path = file("whole.mcap");
    write(&path, |_, _| {});
    let bytes = std::fs::read(&path).unwrap();
    let whole = Log::open(&path).unwrap().records::<Sensors>(&SENSORS).unwrap();
    let cut = file("cut.mcap");
    let first_message = bytes.len() / 20;
    let mut last = 0;
    for k in 0..97 {
        let n = first_message + (bytes.len() - first_message) * k / 97 + k % 13;
        std::fs::write(&cut, &bytes[..n]).unwrap();
        let log = Log::open(&cut).unwrap();
        let mut records = 0;
        let end = log.each_record(&SENSORS, |s: &Sensors| {
            assert_eq!(*s, whole[records]);
            records += 1;
        });
        assert!(matches!(end, Ok(LogEnd::Truncated(_))), "{n}: {end:?}");
        assert!(records >= last, "{n}: {records} < {last}");
        last = records;
    }
    assert!(last as u64 > CYCLES * 9 / 10, "{last}");
}

#[test]
fn a_log_cut_before_its_metadata_or_not_a_log_at_all_is_named() {
    let path = file("short.mcap");
    write(&path, |_, _| {});
    let bytes = std::fs::read(&path).unwrap();
    let cut = file("bad.mcap");
    for n in 0..200 {
        std::fs::write(&cut, &bytes[..n]).unwrap();
        let error = Log::open(&cut).unwrap_err();
        let expected = if n < 8 { "not an MCAP file" } else { "metadata" };
        assert!(error.to_string().contains(expected), "{n}: {error}");
    }
    std::fs::write(&cut, b"time,angle\n0,1\n0.001,2\n").unwrap();
    assert!(matches!(Log::open(&cut), Err(RecordingError::NotALog(..))));
    std::fs::remove_file(&cut).unwrap();
    assert!(matches!(Log::open(&cut), Err(RecordingError::Read(..))));
}

/// Start and length of the first chunk's content: after the magic, records of opcode (1 byte), length (8) and content.
fn first_chunk(bytes: &[u8]) -> (usize, usize) {
    const CHUNK: u8 = 6;
    let mut at = 8;
    loop {
        let (opcode, length) =
            (bytes[at], u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize);
        if opcode == CHUNK {
            return (at + 9, length);
        }
        at += 9 + length;
    }
}

#[test]
fn a_flipped_bit_in_a_chunk_is_damage() {
    let path = file("damaged.mcap");
    write(&path, |_, _| {});
    let mut bytes = std::fs::read(&path).unwrap();
    let (start, length) = first_chunk(&bytes);
    bytes[start + length / 2] ^= 0x10;
    std::fs::write(&path, &bytes).unwrap();
    let result = Log::open(&path).and_then(|log| log.each(|_| {}));
    assert!(matches!(result, Err(RecordingError::Damaged(..))), "{result:?}");
}

#[test]
fn equal_runs_have_equal_hashes_and_one_bit_changes_one_channel() {
    let (a, b, c) = (file("a.mcap"), file("b.mcap"), file("c.mcap"));
    write(&a, |_, _| {});
    write(&b, |_, _| {});
    write(&c, |tick, s| {
        if tick == 123 {
            s.motor_angle[31] = f64::from_bits(1);
        }
    });
    assert_eq!(std::fs::read(&a).unwrap(), std::fs::read(&b).unwrap(), "files of equal runs are equal");
    let hashes =
        |path| payload_hashes(path, |channel| !channel.starts_with("/gangwerk/cycle_stats/")).unwrap();
    assert_eq!(hashes(&a), hashes(&b));
    assert!(!hashes(&a).keys().any(|k| k.contains("cycle_stats")));
    let differing: Vec<_> =
        hashes(&a).into_iter().filter(|(k, v)| hashes(&c)[k] != *v).map(|(k, _)| k).collect();
    assert_eq!(differing, ["/gangwerk/sensors"]);
}

#[test]
fn what_was_flushed_survives_a_recorder_that_is_never_finished() {
    let path = file("flushed.mcap");
    let mut recorder = Recorder::create(&path, &robot(), &run()).unwrap();
    for tick in 0..50 {
        recorder.write(&SENSORS, &sensors(tick)).unwrap();
    }
    recorder.flush().unwrap();
    recorder.write(&SENSORS, &sensors(50)).unwrap();
    std::mem::forget(recorder); // as SIGKILL would
    let log = Log::open(&path).unwrap();
    assert_eq!(log.records::<Sensors>(&SENSORS).unwrap().len(), 50);
    assert!(matches!(log.each(|_| {}).unwrap(), LogEnd::Truncated(_)));
}

#[test]
fn a_full_disk_is_an_error_that_says_so() {
    let Ok(full) = std::fs::OpenOptions::new().write(true).open("/dev/full") else { return };
    let result = Recorder::to(Box::new(full), &robot(), &run()).and_then(|mut recorder| {
        recorder.write(&SENSORS, &sensors(0))?;
        recorder.flush()
    });
    let error = result.unwrap_err().to_string();
    assert!(error.contains("disk full"), "{error}");
}

/// Found by fuzzing: a length in a damaged record was believed, and up to 4 GB were asked for.
#[test]
fn a_string_that_claims_to_be_longer_than_its_record_is_damage() {
    let path = file("long_string.mcap");
    let record = |opcode: u8, body: &[u8]| [&[opcode][..], &(body.len() as u64).to_le_bytes(), body].concat();
    let long = u32::MAX.to_le_bytes();
    let bodies = [
        (0x03, [&[1, 0][..], &long].concat()),
        (0x04, [&[1, 0, 1, 0, 0, 0, 0, 0][..], &long].concat()),
        (0x09, [&[0; 16][..], &long].concat()),
        (0x0c, long.to_vec()),
        (0x0c, [&[0, 0, 0, 0, 4, 0, 0, 0][..], &long].concat()),
    ];
    for (opcode, body) in bodies {
        let bytes = [b"\x89MCAP0\r\n".to_vec(), record(0x01, &[0; 8]), record(opcode, &body)].concat();
        std::fs::write(&path, bytes).unwrap();
        let error = Log::open(&path).unwrap_err().to_string();
        assert!(error.contains("a string is longer than the record"), "{opcode:#x}: {error}");
    }
}

/// By its index a log is read as from its beginning. Its numbers are noise: a chunk that hardly shrinks is read in several parts.
#[test]
fn the_index_leads_to_every_record() {
    let path = file("indexed.mcap");
    let seed = std::cell::Cell::new(1u64);
    let noise = || {
        seed.set(seed.get().wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407));
        (seed.get() >> 11) as f64
    };
    write(&path, |_, sensors| {
        let all = [&mut sensors.joint_angle, &mut sensors.temperature];
        all.into_iter().flatten().for_each(|x| *x = noise());
    });
    // The whole log, read by another route.
    let mut indexed = recording::IndexedLog::open(&path).unwrap();
    assert!(indexed.is_complete() && indexed.other_layouts().is_empty());
    let sensors: Vec<Sensors> = Log::open(&path).unwrap().records(&SENSORS).unwrap();
    let of_chunks = |log: &mut recording::IndexedLog| -> Vec<u64> {
        (0..log.len())
            .flat_map(|n| {
                let chunk = log.chunk(n).unwrap();
                let ticks: Vec<u64> = chunk.payloads(&SENSORS).map(|(tick, _)| tick).collect();
                assert!(log.holds(n, &SENSORS) || ticks.is_empty());
                ticks
            })
            .collect()
    };
    let ticks: Vec<u64> = sensors.iter().map(|s| s.header.tick).collect();
    assert_eq!(of_chunks(&mut indexed), ticks);
    assert_eq!(indexed.span().unwrap(), Some((ticks[0], ticks[ticks.len() - 1])));
    // Each instant, in the order of time.
    for record in &sensors {
        let found = indexed.newest::<Sensors>(&SENSORS, record.header.tick, |_| true).unwrap();
        assert_eq!(found.map(|s| s.header), Some(record.header));
    }
}
