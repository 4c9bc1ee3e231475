//! The process around the watchdog: `gangwerk watchdog --run DIR`.
//!
//! Real time: a grid of its own, one cycle per bus cycle, so that it notices what no longer happens. Lockstep: woken by
//! the joint loop's sign of life, it answers each tick.

use crate::{Inputs, Watchdog, supply_event};
use config::{Setup, System, Timeline};
use ipc::{Bell, Mode, Reader, Run, Space, Waiter, Woken, Writer};
use messages::command::Domain;
use messages::topics::{EVENTS_WATCHDOG, POWER, STATS_WATCHDOG, WATCHDOG_RESET};
use messages::{Command, CycleStats, Event, EventCode, Header, Power, Process, WatchdogReset};
use realtime::{CycleMeter, Period, Schedule, Stop, clock, prepare_thread};
use std::error::Error;
use std::path::Path;
use std::time::Duration;

/// Where live commands come from: each call gives the next one that waits. Those of the scene come by tick.
pub type Commands = Box<dyn FnMut() -> Option<Command>>;

/// Cycles before counting begins: everything has been touched once.
const WARM_UP: u64 = 100;
/// Cycles from one record of statistics to the next.
const STATS_EVERY: u64 = 100;
/// Commands looked at per cycle; the rest waits for the next.
const MAX_COMMANDS: usize = 16;

/// Runs until asked to end. `connect` opens the source of commands in the space.
///
/// # Errors
/// The process cannot start, or, in lockstep, the joint loop fell silent.
pub fn main(
    dir: &Path,
    connect: impl FnOnce(&Space) -> Result<Commands, String>,
) -> Result<(), Box<dyn Error>> {
    let stop = Stop::on_signals()?;
    let run = Run::load(dir)?;
    let Setup { scene, system, hash, .. } = Setup::load(&run.config, &run.scene)?;
    let granted = prepare_thread(&schedule(&system, run.mode));
    for missing in &granted.missing {
        tracing::warn!("watchdog degraded: {missing}");
    }
    let space = run.enter(Process::Watchdog)?;
    let mut daemon = Daemon {
        ports: Ports::open(&space)?,
        timeline: Timeline::new(&scene, &[Domain::System]),
        commands: connect(&space)?,
        watchdog: Watchdog::new(system.watchdog_missed),
        meter: CycleMeter::new(0, granted.degraded(), hash),
        cycle: 0,
        stop,
    };
    if daemon.ports.power.epoch() > 1 {
        // Started again: power stays off until somebody asks for it now.
        daemon.timeline.skip_before(u64::MAX);
    }
    daemon.report(EventCode::Started, 0);
    let result = match run.mode {
        Mode::Lockstep => daemon.lockstep(&space, Duration::from_secs_f64(system.peer_timeout)),
        Mode::RealTime => {
            daemon.real_time((scene.cycle * 1e9) as u64, system.overrun_bucket);
            Ok(())
        }
    };
    daemon.report(EventCode::Ended, 0);
    result
}

fn schedule(system: &System, mode: Mode) -> Schedule {
    match (mode, system.process(Process::Watchdog)) {
        (Mode::RealTime, Some(row)) => Schedule { priority: row.priority, core: row.core },
        _ => Schedule::ORDINARY,
    }
}

struct Ports {
    reset: Reader<WatchdogReset>,
    power: Writer<Power>,
    bell: Bell,
    stats: Writer<CycleStats>,
    events: Writer<Event>,
}

impl Ports {
    fn open(space: &Space) -> Result<Self, ipc::IpcError> {
        Ok(Self {
            reset: space.reader(&WATCHDOG_RESET)?,
            power: space.writer(&POWER)?,
            bell: space.bell(&POWER)?,
            stats: space.writer(&STATS_WATCHDOG)?,
            events: space.writer(&EVENTS_WATCHDOG)?,
        })
    }
}

struct Daemon {
    ports: Ports,
    timeline: Timeline,
    commands: Commands,
    watchdog: Watchdog,
    meter: CycleMeter,
    cycle: u64,
    stop: Stop,
}

impl Daemon {
    fn real_time(&mut self, period_ns: u64, bucket: u32) {
        let mut period = Period::new(clock::now() + period_ns, period_ns, bucket);
        while !self.stop.asked() {
            clock::sleep_until(period.planned());
            self.meter.begin(period.planned(), clock::now());
            self.ports.reset.refresh();
            self.answer();
            let skipped = period.finish(clock::now()).skipped();
            self.end_cycle(skipped);
        }
    }

    fn lockstep(&mut self, space: &Space, patience: Duration) -> Result<(), Box<dyn Error>> {
        let waiter: Waiter = space.waiter(Process::Watchdog)?;
        loop {
            let reset = &mut self.ports.reset;
            match waiter.wait_until(patience, || self.stop.asked(), || reset.refresh()) {
                Woken::Stopped => return Ok(()),
                Woken::Silent => return Err(silent(self.ports.reset.held(), patience).into()),
                Woken::Ready => {
                    let now = clock::now();
                    self.meter.begin(now, now);
                    self.answer();
                    self.end_cycle(0);
                }
            }
        }
    }

    /// The commands of this cycle: the scene's that are due, then the live ones.
    fn gather(&mut self) -> ([Command; MAX_COMMANDS], usize) {
        let mut waiting = [Command::End; MAX_COMMANDS];
        let mut count = 0;
        let tick = self.ports.reset.held().map_or(0, |r| r.header.tick);
        while count < MAX_COMMANDS
            && let Some(command) = self.timeline.due(tick).or_else(&mut self.commands)
        {
            waiting[count] = command;
            count += 1;
        }
        (waiting, count)
    }

    /// One step with the newest input, and its output.
    fn answer(&mut self) {
        let (waiting, count) = self.gather();
        let before = self.watchdog.supply();
        let inputs = Inputs { reset: self.ports.reset.held(), commands: &waiting[..count] };
        let power = *self.watchdog.step(&inputs);
        self.ports.power.write(&power);
        self.ports.bell.ring();
        if let Some((code, detail)) = supply_event(before, self.watchdog.supply()) {
            self.report(code, detail);
        }
    }

    fn end_cycle(&mut self, skipped: u64) {
        self.meter.end(clock::now(), skipped);
        self.cycle += 1;
        if self.cycle == WARM_UP {
            self.ports.bell.connect();
            self.meter.arm();
        }
        if self.cycle.is_multiple_of(STATS_EVERY) {
            let header = self.now();
            let stats = self.meter.stats();
            stats.header = header;
            self.ports.stats.write(stats);
        }
    }

    fn report(&mut self, code: EventCode, detail: u64) {
        let header = self.now();
        self.ports.events.write(&Event { header, code: code as u64, detail });
    }

    /// Tick and stamp of the newest sign of life.
    fn now(&self) -> Header {
        self.ports.reset.held().map_or(Header { tick: 0, stamp_ns: 0, epoch: 0 }, |r| r.header)
    }
}

fn silent(last: Option<&WatchdogReset>, patience: Duration) -> String {
    let tick = last.map_or(0, |r| r.header.tick);
    format!(
        "lockstep: lowlevel did not go on after tick {tick} within {} s; is it running?",
        patience.as_secs()
    )
}
