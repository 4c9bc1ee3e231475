//! How punctual a bus cycle over CAN lines is, beside `cyclictest` in the same run.
//!
//! Both ends of the lines and nothing else: the near end does in each cycle what the joint loop does with its lines, the
//! far end answers each SYNC with all frames of its line. So what is measured is the cost of the lines themselves.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use codec::frames::{DriveCommand, decode_sensors, encode_sensors, encode_targets};
use codec::layout::FrameLayout;
use config::{BusAddress, Robot};
use fieldbus::{BusEnd, BusLines};
use messages::{BusFrames, Frame, MAX_FRAMES, Sensors};
use realtime::{Histogram, Period, ThreadSchedule, allocations, clock, prepare_thread};
use serde::Serialize;
use serde_json::json;

use crate::sheet::{Column, fixed, plain};
use crate::{Error, Given, Sheet, Study};

use realtime::cyclictest;

/// SCHED_FIFO priorities of near end and `cyclictest`, and of the far end.
const PRIORITY: [u8; 2] = [80, 79];
/// Cycles before counting begins: everything has been touched once.
const WARM_UP: u64 = 20;
/// Share of a cycle within which the answers are to be there; as the joint loop waits for its targets.
const ANSWER: (u64, u64) = (7, 10);
/// The far end looks this often whether to end.
const LOOK: Duration = Duration::from_millis(20);

/// Microseconds: p50, p99, p99.9, max.
const COLUMNS: &[Column] = &[
    plain("/0", "[us]"),
    fixed("/1/0", "p50", 1),
    fixed("/1/1", "p99", 1),
    fixed("/1/2", "p99.9", 1),
    fixed("/1/3", "max", 1),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Punctuality {
    /// The lines, classic CAN or CAN FD.
    #[arg(long, default_value = "can:vcan0-8")]
    pub bus: BusAddress,
    /// Whose frames they carry.
    #[arg(long, default_value = "lola")]
    pub robot: String,
    /// Bus cycle, in ms.
    #[arg(long, value_name = "MS", default_value_t = 3.5)]
    pub cycle: f64,
    /// How long, in s; cyclictest runs as long before, and again beside it.
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=3600))]
    pub seconds: u64,
}

/// What was found.
#[derive(Clone, Debug, Serialize)]
struct LineFindings {
    /// Whose frames.
    robot: String,
    /// \[s\] Bus cycle.
    cycle: f64,
    /// Cycles counted.
    cycles: u64,
    /// Whole periods skipped, because a cycle had not ended.
    skipped: u64,
    /// Cycles whose answers were not there after 70 % of it.
    late: u64,
    /// Frames that should have come, and those that had not by the next cycle.
    frames: [u64; 2],
    /// Frames that could not be sent, by near and far end.
    unsent: [u32; 2],
    /// Allocations and frees in the cycles, of near and far end.
    allocations: [[u64; 2]; 2],
    /// \[us\] Wake-up after its time: p50, p99, p99.9, max.
    lateness_us: [f64; 4],
    /// \[us\] Targets encoded and sent, up to the last SYNC: likewise.
    sent_us: [f64; 4],
    /// \[us\] From the last SYNC until the last answer was read: likewise; no more than 70 % of the cycle are waited for.
    answered_us: [f64; 4],
    /// \[us\] Lateness of `cyclictest` alone and beside this, at the same priority; or why it did not run.
    cyclictest_us: [Result<[u64; 4], String>; 2],
    /// What real time was asked for and not granted.
    missing: Vec<String>,
}

impl Study for Punctuality {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let BusAddress::Can { fd, interfaces } = &self.bus else {
            return Err(format!("--bus {}: must be can:INTERFACES or canfd:INTERFACES", self.bus).into());
        };
        if !(0.1..=1000.0).contains(&self.cycle) {
            return Err(format!("--cycle {}: must be 0.1 to 1000 ms", self.cycle).into());
        }
        let robot = Robot::load(&given.config.join("robots").join(&self.robot))?;
        let layout = if *fd { robot.layout } else { robot.classic? };
        let open = |end| BusLines::open(interfaces, &layout, *fd, end);
        let (near, far) = (open(BusEnd::Near)?, open(BusEnd::Far)?);
        Ok(sheet(&self.measure(near, far, &layout)?))
    }
}

impl Punctuality {
    /// Runs `cyclictest` alone, then both ends of the lines beside it.
    fn measure(&self, near: BusLines, far: BusLines, layout: &FrameLayout) -> Result<LineFindings, Error> {
        let beside = || cyclictest(None, PRIORITY[0], self.seconds);
        let alone = beside();
        let stop = AtomicBool::new(false);
        std::thread::scope(|scope| {
            // Each thread takes its priority by itself; cyclictest would inherit it.
            let other = scope.spawn(beside);
            let far = scope.spawn(|| answer(far, layout, &stop));
            let near = scope.spawn(|| drive(near, layout, self));
            let found = near.join();
            stop.store(true, Ordering::Relaxed);
            let (far, other) = (far.join(), other.join());
            let died = |_| "a thread has died";
            let (mut found, (allocated, unsent)) = (found.map_err(died)?, far.map_err(died)?);
            (found.allocations[1], found.unsent[1]) = (allocated, unsent);
            found.cyclictest_us = [alone, other.map_err(died)?];
            Ok(found)
        })
    }
}

fn sheet(f: &LineFindings) -> Sheet {
    let mut sheet = Sheet::titled(format!(
        "{}, cycle {} ms: {} cycles, {} skipped; {} with late answers; {} of {} frames lost, {} and {} unsent",
        f.robot,
        f.cycle * 1e3,
        f.cycles,
        f.skipped,
        f.late,
        f.frames[1],
        f.frames[0],
        f.unsent[0],
        f.unsent[1]
    ));
    let [near, far] = f.allocations;
    let text = |of: [u64; 2]| format!("{}, {}", of[0], of[1]);
    sheet.line(format!("allocations and frees: near end {}; far end {}", text(near), text(far)));
    // cyclictest beside what it measures; where it could not run, why.
    let mut rows = vec![
        json!(["wake-up after its time", f.lateness_us]),
        json!(["targets and SYNC sent", f.sent_us]),
        json!(["last SYNC to last answer", f.answered_us]),
    ];
    for (name, found) in [("beside it", &f.cyclictest_us[1]), ("alone", &f.cyclictest_us[0])] {
        match found {
            Ok(us) => rows.push(json!([format!("cyclictest {name}"), us.map(|us| us as f64)])),
            Err(why) => sheet.line(format!("cyclictest {name}: {why}")),
        }
    }
    sheet.table(COLUMNS, &rows);
    f.missing.iter().for_each(|missing| sheet.line(format!("degraded: {missing}")));
    sheet.facts(f);
    sheet
}

/// The near end: one cycle after the other.
fn drive(mut lines: BusLines, layout: &FrameLayout, order: &Punctuality) -> LineFindings {
    let granted = prepare_thread(&ThreadSchedule { priority: PRIORITY[0], core: None });
    let answers = layout.sent(false).count().min(MAX_FRAMES);
    let cycle_ns = (order.cycle * 1e-3 * 1e9) as u64;
    let [mut lateness, mut sent, mut answered] = [(); 3].map(|()| Histogram::new());
    let mut command = DriveCommand::default();
    let (mut tx, mut rx, mut sensors) = (BusFrames::default(), BusFrames::default(), Sensors::default());
    let begin = clock::now() + cycle_ns;
    let mut period = Period::new(begin, cycle_ns, u32::MAX);
    let (mut tick, mut late, mut lost, mut skipped_before) = (0, 0, 0, 0);
    let end = begin + WARM_UP * cycle_ns + order.seconds * clock::SECOND;
    while period.planned() < end || tick <= WARM_UP + 1 {
        clock::sleep_until(period.planned());
        let woken = clock::now();
        lines.receive(&mut rx);
        rx.header.tick = tick;
        let missed = decode_sensors(layout, &rx, &mut sensors).missed();
        tick += 1;
        rx.count = 0;
        command.targets.header.tick = tick;
        let begun = clock::now();
        encode_targets(layout, &command, &mut tx);
        lines.send(&tx);
        let synced = clock::now();
        let complete =
            collect(&mut lines, &mut rx, answers, period.planned() + cycle_ns * ANSWER.0 / ANSWER.1);
        let ended = clock::now();
        if tick == WARM_UP {
            allocations::arm();
            skipped_before = period.skipped();
        } else if tick > WARM_UP {
            lateness.record(woken.saturating_sub(period.planned()));
            sent.record(synced - begun);
            answered.record(ended - synced);
            late += u64::from(!complete);
            // Of the cycle before.
            lost += if tick > WARM_UP + 1 { u64::from(missed) } else { 0 };
        }
        period.finish(clock::now());
    }
    let allocated = allocations::counted();
    allocations::disarm();
    let cycles = tick - WARM_UP;
    let us = |histogram: &Histogram| histogram.percentiles().map(|ns| ns as f64 * 1e-3);
    LineFindings {
        robot: order.robot.clone(),
        cycle: order.cycle * 1e-3,
        cycles,
        skipped: period.skipped() - skipped_before,
        late,
        frames: [(cycles - 1) * answers as u64, lost],
        unsent: [lines.take_trouble().unsent, 0],
        allocations: [allocated, [0; 2]],
        lateness_us: us(&lateness),
        sent_us: us(&sent),
        answered_us: us(&answered),
        cyclictest_us: [const { Ok([0; 4]) }; 2],
        missing: granted.missing.clone(),
    }
}

/// Reads until all answers are there; `false`: it is too late for that.
fn collect(lines: &mut BusLines, rx: &mut BusFrames, answers: usize, until_ns: u64) -> bool {
    while rx.as_slice().len() < answers {
        let left = until_ns.saturating_sub(clock::now());
        if left == 0 {
            return false;
        }
        if lines.receive(rx) == 0 {
            // Lines are answered in their order: the last one is worth waking up for.
            lines.wait(Some(usize::MAX), Duration::from_nanos(left));
        }
    }
    true
}

/// The far end: every SYNC is answered with all frames of its line. Returns allocations and frees, and what could not be
/// sent.
fn answer(mut lines: BusLines, layout: &FrameLayout, stop: &AtomicBool) -> ([u64; 2], u32) {
    prepare_thread(&ThreadSchedule { priority: PRIORITY[1], core: None });
    let (mut rx, mut tx, mut sensors) = (BusFrames::default(), BusFrames::default(), Sensors::default());
    let mut cycles = 0;
    while !stop.load(Ordering::Relaxed) {
        lines.wait(None, LOOK);
        rx.count = 0;
        lines.receive(&mut rx);
        for frame in rx.as_slice() {
            let Some(counter) = sync(layout, frame) else { continue };
            if counter != sensors.header.tick || cycles == 0 {
                sensors.header.tick = counter;
                encode_sensors(layout, &sensors, &mut tx);
                cycles += 1;
                if cycles == WARM_UP {
                    allocations::arm();
                }
            }
            lines.send_on(frame.line, &tx);
        }
    }
    let allocated = allocations::counted();
    allocations::disarm();
    (allocated, lines.take_trouble().unsent)
}

/// The counter of a SYNC; none if it is another frame.
fn sync(layout: &FrameLayout, frame: &Frame) -> Option<u64> {
    let message = layout.find(frame.line, frame.id).map(|i| &layout.messages[i])?;
    let counter = message.counter().filter(|_| message.is_sync() && message.len == frame.len)?;
    Some(counter.get(&frame.data) as u64)
}
