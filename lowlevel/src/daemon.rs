//! The process around the joint loop: `gangwerk lowlevel --run DIR`. It is the clock of all others.

use crate::bus::{self, WaitingDaemon};
use crate::joint_loop::LoopState;
use crate::{Fieldbus, JointLoop};
use config::Timeline;
use daemon::{Commands, Connect, Daemon};
use ipc::{Mode, Reader, Waiter, Writer};
use messages::cycle_inputs::Used;
use messages::topics::{
    BUS_TX, FRAMES_IN, FRAMES_OUT, JOINT_TABLES, JOINT_TARGETS, LOG_TICK, POWER, SENSORS, WATCHDOG_RESET,
};
use messages::{
    BusFrames, Detail, Event, EventCode, Header, JointTables, JointTargets, Live, Power, Process, Sensors,
    WatchdogReset,
};
use realtime::{CycleVerdict, Period, clock};
use std::error::Error;
use std::path::Path;
use std::time::Duration;

/// Share of a period after which the joint loop no longer waits for the targets of the same cycle.
const ANSWER: (u64, u64) = (7, 10);

/// Runs the joint loop until the scene is over or somebody asks to end. Returns true if the scene is over.
///
/// # Errors
/// The process cannot start, or, in lockstep, a peer fell silent.
pub fn main(dir: &Path, connect: Connect) -> Result<bool, Box<dyn Error>> {
    let mut d = Daemon::new(Process::Lowlevel, dir)?;
    let mut ports = LowlevelPorts {
        bus: bus::open(&d)?,
        sensors: d.space.writer(&SENSORS)?,
        frames_in: d.space.writer(&FRAMES_IN)?,
        frames_out: d.space.writer(&FRAMES_OUT)?,
        received: 0,
        reset: d.space.writer(&WATCHDOG_RESET)?,
        targets: d.space.reader(&JOINT_TARGETS)?,
        tables: d.space.reader(&JOINT_TABLES)?,
        power: d.space.reader(&POWER)?,
        logged: d.space.reader(&LOG_TICK)?,
        bell_sensors: d.bell(&SENSORS)?,
        bell_bus: d.bell(&BUS_TX)?,
        bell_reset: d.bell(&WATCHDOG_RESET)?,
        waiter: d.space.waiter(Process::Lowlevel)?,
        timeline: Timeline::new(&d.setup.scene, Process::Lowlevel),
        commands: connect(&d.space)?,
    };
    if ports.sensors.epoch() > 1 {
        ports.timeline.drop_rest(); // started again
    }
    let scene = &d.setup.scene;
    let last = if d.stays { u64::MAX } else { (scene.duration / scene.cycle).round() as u64 };
    let mut joints = JointLoop::new(&d.setup.robot, &d.setup.system, scene.cycle);
    if !ports.bus.start(&WaitingDaemon { daemon: &d, waiter: &ports.waiter })? {
        return Ok(false);
    }
    d.report(Header::default(), EventCode::Started, Detail::Nothing);
    let header = match d.mode {
        Mode::Lockstep => lockstep(&mut d, &mut ports, &mut joints, last)?,
        Mode::RealTime => {
            let header = real_time(&mut d, &mut ports, &mut joints, last);
            say_goodbye(&d, &mut ports, header);
            header
        }
    };
    d.report(header, EventCode::Ended, Detail::Nothing);
    Ok(header.tick >= last)
}

struct LowlevelPorts {
    bus: Box<dyn Fieldbus>,
    sensors: Writer<Sensors>,
    frames_in: Writer<BusFrames>,
    frames_out: Writer<BusFrames>,
    /// Cycles so far in which frames came.
    received: u64,
    reset: Writer<WatchdogReset>,
    targets: Reader<JointTargets>,
    tables: Reader<JointTables>,
    power: Reader<Power>,
    logged: Reader<Event>,
    bell_sensors: usize,
    bell_bus: usize,
    bell_reset: usize,
    waiter: Waiter,
    timeline: Timeline,
    commands: Commands,
}

/// Tables that the drives are to play, if there are new ones: the controller writes them before its targets.
fn take_tables(d: &mut Daemon, p: &mut LowlevelPorts, joints: &mut JointLoop) {
    if p.tables.refresh()
        && let Some(tables) = p.tables.held()
    {
        joints.take_tables(tables);
    }
    d.log.uses(2, &JOINT_TABLES, p.tables.held());
}

/// Commands of this cycle: the scene's that are due, then live ones.
fn take_commands(d: &mut Daemon, p: &mut LowlevelPorts, joints: &mut JointLoop, header: Header) {
    while let Some(live) = p.timeline.due(header.tick).map(Live::of_scene).or_else(|| p.commands.next()) {
        let verdict = joints.command(&live.command);
        p.commands.answer(&live, verdict);
        d.log.took(header, &live, &verdict);
    }
    d.log.left_out(header, p.commands.as_mut());
}

/// First half of a cycle; its header. What came and what is measured goes to those who wait for it first.
fn receive(
    d: &mut Daemon,
    p: &mut LowlevelPorts,
    joints: &mut JointLoop,
    tick: u64,
    stamp_ns: u64,
) -> Header {
    let frames = p.bus.receive();
    let sensors = joints.receive(tick, stamp_ns, frames);
    p.sensors.write(sensors);
    d.ring(p.bell_sensors);
    d.log.keep(&SENSORS, sensors);
    if let Some(frames) = frames {
        p.frames_in.write(frames);
        d.log.keep(&FRAMES_IN, frames);
        p.received += 1;
        d.log.now().used[1] = Used { epoch: p.frames_in.epoch(), tick: p.received };
    }
    sensors.header
}

/// Simulated time: each peer answers tick n before tick n + 1 begins; if it is paced, no sooner than its clock says. What a
/// machine loses it does not catch up on: the robot is slower for a moment.
fn lockstep(
    d: &mut Daemon,
    p: &mut LowlevelPorts,
    joints: &mut JointLoop,
    last: u64,
) -> Result<Header, Box<dyn Error>> {
    // The far end speaks first: its answer to no cycle is what the first one sees.
    let mut header = Header::default();
    if !p.bus.wait(&WaitingDaemon { daemon: d, waiter: &p.waiter }, 0)? {
        return Ok(header);
    }
    let mut next = clock::now();
    for tick in 1..=last {
        if d.paced {
            clock::sleep_until(next);
            // What is less than a cycle late is caught up with; more is lost.
            next = (next + d.period_ns()).max(clock::now());
        }
        d.begin(clock::now());
        header = receive(d, p, joints, tick, tick * d.period_ns());
        let targets = &mut p.targets;
        if !d.wait(&p.waiter, "controller", || targets.latest().is_some_and(|t| t.header.tick == tick))? {
            break;
        }
        take_tables(d, p, joints);
        take_commands(d, p, joints, header);
        let off = joints.state() == LoopState::Off;
        d.log.uses(0, &JOINT_TARGETS, p.targets.held());
        let (frames, reset) = joints.send(p.targets.held(), None);
        p.reset.write(reset);
        d.ring(p.bell_reset);
        let power = &mut p.power;
        if !d.wait(&p.waiter, "watchdog", || power.latest().is_some_and(|w| w.header.tick == tick))? {
            break;
        }
        p.bus.set_idle(off);
        p.bus.send(frames);
        p.frames_out.write(frames);
        d.log.keep(&FRAMES_OUT, frames);
        d.log.keep(&WATCHDOG_RESET, reset);
        d.ring(p.bell_bus);
        if !p.bus.wait(&WaitingDaemon { daemon: d, waiter: &p.waiter }, tick)? || !wait_for_log(d, p, tick)? {
            break;
        }
        report(d, p.bus.as_mut(), joints, header);
        d.end(header, 0);
    }
    Ok(header)
}

/// Nobody runs ahead of the log by more than half of the shortest ring that is logged in each cycle: nothing is lost.
fn wait_for_log(d: &Daemon, p: &mut LowlevelPorts, tick: u64) -> Result<bool, Box<dyn Error>> {
    let ahead = FRAMES_OUT.depth as u64 / 2;
    if !d.logged || tick <= ahead {
        return Ok(true);
    }
    let logged = &mut p.logged;
    d.wait(&p.waiter, "logger", || logged.latest().is_some_and(|e| e.header.tick + ahead >= tick))
}

/// The bus cycle is the clock.
fn real_time(d: &mut Daemon, p: &mut LowlevelPorts, joints: &mut JointLoop, last: u64) -> Header {
    let period_ns = d.period_ns();
    let answer_ns = period_ns * ANSWER.0 / ANSWER.1;
    let mut period = Period::new(clock::now() + period_ns, period_ns, d.setup.system.overrun_bucket);
    let (mut header, mut cause) = (Header::default(), None);
    for tick in 1..=last {
        if d.stop.asked() {
            break;
        }
        clock::sleep_until(period.planned());
        d.begin(period.planned());
        header = receive(d, p, joints, tick, clock::now());
        wait_for_targets(p, tick, period.planned() + answer_ns);
        take_tables(d, p, joints);
        take_commands(d, p, joints, header);
        let off = joints.state() == LoopState::Off;
        // A stop is latched until the supply was off; of what ended nothing, as joints at rest, nothing is kept.
        cause = cause.filter(|_| matches!(joints.state(), LoopState::Track | LoopState::Stop(_)));
        let targets = p.targets.latest();
        d.log.uses(0, &JOINT_TARGETS, targets);
        d.log.now().cause = cause.map_or(0, |cause| cause as u64);
        let (frames, reset) = joints.send(targets, cause);
        p.bus.set_idle(off);
        p.bus.send(frames);
        d.ring(p.bell_bus);
        p.reset.write(reset);
        p.frames_out.write(frames);
        d.log.keep(&FRAMES_OUT, frames);
        d.log.keep(&WATCHDOG_RESET, reset);
        report(d, p.bus.as_mut(), joints, header);
        let verdict = period.finish(clock::now());
        if let CycleVerdict::TooMany { .. } = verdict {
            cause = Some(EventCode::TooManyOverruns);
        }
        if verdict.skipped() > 0 {
            d.report(header, EventCode::Overrun, Detail::Count(verdict.skipped()));
        }
        d.end(header, verdict.skipped());
    }
    header
}

/// The last heartbeat says that it is the last one: the log tells an orderly end from a joint loop that fell silent.
fn say_goodbye(d: &Daemon, p: &mut LowlevelPorts, last: Header) {
    let header = Header { tick: last.tick + 1, ..last };
    p.reset.write(&WatchdogReset { header, trip: EventCode::Ended as u64, supply: 0 });
    d.ring(p.bell_reset);
}

/// Until the targets of this cycle are there, or it is too late for them.
fn wait_for_targets(p: &mut LowlevelPorts, tick: u64, until_ns: u64) {
    while p.targets.latest().is_none_or(|t| t.header.tick < tick) {
        let left = until_ns.saturating_sub(clock::now());
        if left == 0 {
            return;
        }
        p.waiter.wait(Duration::from_nanos(left));
    }
}

fn report(d: &mut Daemon, bus: &mut dyn Fieldbus, joints: &mut JointLoop, header: Header) {
    d.count_bus(joints.bus_counters());
    let events = joints.events();
    bus.report(events);
    for (code, detail) in events.drain() {
        d.report(header, code, detail);
    }
}
