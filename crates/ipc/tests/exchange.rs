//! Records, wake-ups and queues between two ends in one process.

mod place;

use ipc::{IpcError, Mode, Run, Space};
use messages::topics::{EVENTS_PLANNER, PLAN, SENSORS};
use messages::{Event, Plan, Process, Sensors};
use place::RunDir;
use std::time::Duration;

#[test]
fn newest_record_is_read() {
    let dir = RunDir::new("newest");
    let _system = Space::create(dir.path()).unwrap();
    let lowlevel = Space::open(dir.path(), Process::Lowlevel).unwrap();
    let controller = Space::open(dir.path(), Process::Controller).unwrap();
    let mut writer = lowlevel.writer::<Sensors>(&SENSORS).unwrap();
    let mut reader = controller.reader::<Sensors>(&SENSORS).unwrap();
    assert!(reader.latest().is_none());
    let mut sensors = Sensors::default();
    for tick in 1..1000 {
        sensors.header.tick = tick;
        sensors.joint_angle[3] = tick as f64;
        writer.write(&sensors);
        if tick % 7 == 0 {
            let read = reader.latest().unwrap();
            assert_eq!((read.header.tick, read.joint_angle[3]), (tick, tick as f64));
            assert_eq!(read.header.epoch, 1);
            assert!(reader.newer().is_none());
        }
    }
}

#[test]
fn every_record_is_followed_and_losses_are_counted() {
    let dir = RunDir::new("follow");
    let _system = Space::create(dir.path()).unwrap();
    let planner = Space::open(dir.path(), Process::Planner).unwrap();
    let logger = Space::open(dir.path(), Process::Logger).unwrap();
    let mut writer = planner.writer::<Event>(&EVENTS_PLANNER).unwrap();
    let mut reader = logger.reader::<Event>(&EVENTS_PLANNER).unwrap();
    let mut event = Event::default();
    let mut write = |n: u64| {
        event.detail = n;
        writer.write(&event);
    };
    // In step with the writer, at any distance within the ring: everything, in order.
    let mut written = 0;
    let mut read = 0;
    for burst in [1, 2, 3, 10, 64, 1, 63] {
        for _ in 0..burst {
            written += 1;
            write(written);
        }
        while let Some(e) = reader.follow() {
            read += 1;
            assert_eq!(e.detail, read);
        }
        assert_eq!(read, written);
    }
    assert_eq!(reader.lost(), 0);
    // Far behind: what is left comes in order, what is missing is counted to the last one.
    for _ in 0..1000 {
        written += 1;
        write(written);
    }
    let mut seen = 0;
    while let Some(e) = reader.follow() {
        assert!(e.detail > read);
        read = e.detail;
        seen += 1;
    }
    assert_eq!(read, written);
    assert!(seen >= EVENTS_PLANNER.depth as u64 / 2, "only {seen} of the ring");
    assert_eq!(reader.lost() + seen, 1000);
}

#[test]
fn large_records_pass_whole() {
    let dir = RunDir::new("plan");
    let _system = Space::create(dir.path()).unwrap();
    let planner = Space::open(dir.path(), Process::Planner).unwrap();
    let controller = Space::open(dir.path(), Process::Controller).unwrap();
    let mut writer = planner.writer::<Plan>(&PLAN).unwrap();
    let mut reader = controller.reader::<Plan>(&PLAN).unwrap();
    let mut plan = Box::new(Plan::default());
    for id in 1..50 {
        plan.id = id;
        plan.start_tick = 7 * id;
        writer.write(&plan);
        let read = reader.newer().unwrap();
        assert_eq!((read.id, read.start_tick), (id, 7 * id));
    }
}

#[test]
fn a_restarted_writer_takes_over() {
    let dir = RunDir::new("restart");
    let _system = Space::create(dir.path()).unwrap();
    let controller = Space::open(dir.path(), Process::Controller).unwrap();
    let mut reader = controller.reader::<Sensors>(&SENSORS).unwrap();
    let mut follower = controller.reader::<Sensors>(&SENSORS).unwrap();
    let mut sensors = Sensors::default();
    // An orderly end gives the slot back, so there is no limit to these.
    for life in 1..20 {
        let lowlevel = Space::open(dir.path(), Process::Lowlevel).unwrap();
        let mut writer = lowlevel.writer::<Sensors>(&SENSORS).unwrap();
        assert_eq!(writer.epoch(), life);
        for tick in 1..5 {
            sensors.header.tick = tick;
            writer.write(&sensors);
            let read = reader.latest().unwrap().header;
            assert_eq!((read.tick, read.epoch), (tick, life));
            let read = follower.follow().unwrap().header;
            assert_eq!((read.tick, read.epoch), (tick, life));
            // A new writer in an old slot once made its last record look new again.
            assert!(reader.newer().is_none() && follower.follow().is_none());
        }
    }
    assert_eq!(follower.lost(), 0);
}

#[test]
fn bells_wake_and_are_drained() {
    let dir = RunDir::new("bell");
    let _system = Space::create(dir.path()).unwrap();
    let lowlevel = Space::open(dir.path(), Process::Lowlevel).unwrap();
    let controller = Space::open(dir.path(), Process::Controller).unwrap();
    let waiter = controller.waiter(Process::Controller).unwrap();
    let bell = lowlevel.bell(&SENSORS).unwrap();
    assert!(!waiter.wait(Duration::from_millis(1)));
    for _ in 0..100_000 {
        bell.ring();
    }
    assert!(waiter.wait(Duration::from_secs(1)));
    assert!(!waiter.wait(Duration::from_millis(1)), "one wake-up for all rings before it");
}

#[test]
fn queues_keep_order_and_count_losses() {
    let dir = RunDir::new("queue");
    let _system = Space::create(dir.path()).unwrap();
    let planner = Space::open(dir.path(), Process::Planner).unwrap();
    let broker = Space::open(dir.path(), Process::Broker).unwrap();
    let waiter = broker.queue_waiter("broker").unwrap();
    let mut receiver = broker.queue_receiver("publish/0").unwrap();
    let mut one = planner.queue_sender("publish/0", "broker").unwrap();
    let mut two = planner.queue_sender("publish/0", "broker").unwrap();
    assert!(receiver.receive().is_none());
    assert!(one.send(b"hello"));
    assert!(two.send(b""));
    assert!(!one.send(&[0; 513]));
    assert!(waiter.wait(Duration::from_secs(1)));
    let mut got = Vec::new();
    while let Some(m) = receiver.receive() {
        got.push(m.to_vec());
    }
    got.sort();
    assert_eq!(got, [b"".to_vec(), b"hello".to_vec()]);
    for k in 0..10_000u64 {
        one.send(&k.to_le_bytes());
    }
    let mut seen = 0;
    let mut last = 0;
    while let Some(m) = receiver.receive() {
        last = u64::from_le_bytes(m.try_into().unwrap());
        seen += 1;
    }
    assert_eq!(last, 9999);
    // The one that was too long is counted too.
    assert_eq!(receiver.lost() + seen, 10_001);
}

#[test]
fn a_run_is_saved_and_loaded() {
    let dir = RunDir::new("run");
    let system = Space::create(dir.path()).unwrap();
    let run = Run {
        dir: system.dir().into(),
        mode: Mode::Lockstep,
        paced: true,
        scene: "walk_1kmh".into(),
        method: None,
        method_error: None,
        config: "/somewhere/config".into(),
        bus: "shm".into(),
        robot: true,
        stays: true,
        log: None,
        commit: "5c1f".into(),
        started: Some([17, 4]),
    };
    run.save().unwrap();
    assert_eq!(Run::load(system.dir()).unwrap(), run);
    let method = Some("type 2, semi_implicit x 4".into());
    let method_error = Some(0.41);
    let logged = Run {
        mode: Mode::RealTime,
        paced: false,
        method,
        method_error,
        log: Some("/tmp/a b.mcap".into()),
        ..run
    };
    logged.save().unwrap();
    assert_eq!(Run::load(system.dir()).unwrap(), logged);
    std::fs::write(system.dir().join("run"), "mode = fast\nscene = x\nmethod =\nconfig = y\nlog =\n")
        .unwrap();
    let error = Run::load(system.dir()).unwrap_err().to_string();
    assert!(error.contains("mode = fast"), "{error}");
}

#[test]
fn wrong_writer_and_wrong_type_are_refused() {
    let dir = RunDir::new("wrong");
    let _system = Space::create(dir.path()).unwrap();
    let planner = Space::open(dir.path(), Process::Planner).unwrap();
    let error = planner.writer::<Sensors>(&SENSORS).err().unwrap();
    assert_eq!(error.to_string(), "topic sensors is written by lowlevel, not by planner");
    let error = planner.reader::<Plan>(&SENSORS).err().unwrap();
    assert!(matches!(error, IpcError::Other(_)));
}

/// A reader that was stopped catches up on what it missed; one that is only slow takes the newest, and is not made slower.
#[test]
fn a_reader_that_was_stopped_takes_what_it_missed_in_order() {
    let dir = RunDir::new("in_order");
    let _system = Space::create(dir.path()).unwrap();
    let planner = Space::open(dir.path(), Process::Planner).unwrap();
    let logger = Space::open(dir.path(), Process::Logger).unwrap();
    let mut writer = planner.writer::<Event>(&EVENTS_PLANNER).unwrap();
    let mut reader = logger.reader::<Event>(&EVENTS_PLANNER).unwrap();
    let mut written = 0;
    let mut write = |count: u64| {
        for _ in 0..count {
            written += 1;
            writer.write(&Event { detail: written, ..Event::default() });
        }
    };
    assert!(!reader.refresh_in_order(3));
    let mut next = |expected: u64, late: bool| {
        assert!(reader.refresh_in_order(3));
        assert_eq!((reader.held().unwrap().detail, reader.is_behind()), (expected, late));
    };
    write(10);
    next(10, false); // the first one seen is the newest
    write(3);
    next(13, false); // slow
    write(10);
    for n in 14..23 {
        next(n, true);
    }
    next(23, false);
    write(20);
    // A writer that is as fast as this reader is not caught up with: twice as many are tried, then the newest counts.
    for n in 24..24 + 39 {
        next(n, true);
        write(1);
    }
    next(82, false);
    assert!(!reader.refresh_in_order(3));
}
