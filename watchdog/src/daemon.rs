//! The process around the watchdog: `gangwerk watchdog --run DIR`.
//!
//! Real time: a grid of its own, one cycle per bus cycle, so that it notices what no longer happens. The grid lies
//! shortly before the joint loop's cycles: that is where a late reset is told from a missing one soonest. Lockstep:
//! woken by the joint loop's sign of life, it answers each tick.

use crate::{Inputs, Watchdog, supply_event};
use config::Timeline;
use daemon::{Commands, Connect, Daemon};
use ipc::{Mode, Reader, Writer};
use messages::command::Domain;
use messages::topics::{POWER, WATCHDOG_RESET};
use messages::{Command, EventCode, Header, Power, Process, WatchdogReset};
use realtime::{Period, clock};
use std::error::Error;
use std::path::Path;

/// Commands looked at per cycle; the rest waits for the next.
const MAX_COMMANDS: usize = 16;
/// Share of a period after the joint loop's wake-up at which the watchdog looks.
const PHASE: (u64, u64) = (9, 10);

/// Guards until asked to end.
///
/// # Errors
/// The process cannot start, or, in lockstep, the joint loop fell silent.
pub fn main(dir: &Path, connect: Connect) -> Result<(), Box<dyn Error>> {
    let mut d = Daemon::new(Process::Watchdog, dir)?;
    let mut guard = Guard {
        reset: d.space.reader(&WATCHDOG_RESET)?,
        power: d.space.writer(&POWER)?,
        bell: d.bell(&POWER)?,
        timeline: Timeline::new(&d.setup.scene, &[Domain::System]),
        commands: connect(&d.space)?,
        watchdog: Watchdog::new(d.setup.system.watchdog_missed),
    };
    if guard.power.epoch() > 1 {
        // Started again: power stays off until somebody asks for it now.
        guard.timeline.skip_before(u64::MAX);
    }
    d.report(Header::default(), EventCode::Started, 0);
    match d.mode {
        Mode::Lockstep => lockstep(&mut d, &mut guard)?,
        Mode::RealTime => real_time(&mut d, &mut guard),
    }
    d.report(guard.now(), EventCode::Ended, 0);
    Ok(())
}

fn lockstep(d: &mut Daemon, guard: &mut Guard) -> Result<(), Box<dyn Error>> {
    let waiter = d.space.waiter(Process::Watchdog)?;
    while d.wait(&waiter, "lowlevel", || guard.reset.refresh())? {
        d.begin(clock::now());
        guard.cycle(d);
        d.end(guard.now(), 0);
    }
    Ok(())
}

fn real_time(d: &mut Daemon, guard: &mut Guard) {
    let period_ns = d.period_ns();
    let mut period = Period::new(clock::now() + period_ns, period_ns, u32::MAX);
    let mut aligned = false;
    while !d.stop.asked() {
        clock::sleep_until(period.planned());
        d.begin(period.planned());
        guard.reset.refresh();
        guard.cycle(d);
        let mut verdict = period.finish(clock::now());
        if let Some(reset) = guard.reset.held().filter(|_| !aligned) {
            let begun = reset.header.stamp_ns + period_ns * PHASE.0 / PHASE.1;
            period = Period::new(begun, period_ns, u32::MAX);
            verdict = period.finish(clock::now());
            aligned = true;
        }
        d.end(guard.now(), verdict.skipped());
    }
}

struct Guard {
    reset: Reader<WatchdogReset>,
    power: Writer<Power>,
    bell: usize,
    timeline: Timeline,
    commands: Commands,
    watchdog: Watchdog,
}

impl Guard {
    /// One step with the newest sign of life and the commands of this cycle: the scene's that are due, then live ones.
    fn cycle(&mut self, d: &mut Daemon) {
        let mut waiting = [Command::End; MAX_COMMANDS];
        let mut count = 0;
        let tick = self.now().tick;
        while count < MAX_COMMANDS
            && let Some(command) = self.timeline.due(tick).or_else(&mut self.commands)
        {
            waiting[count] = command;
            count += 1;
        }
        let before = self.watchdog.supply();
        let inputs = Inputs { reset: self.reset.held(), commands: &waiting[..count] };
        let power = self.watchdog.step(&inputs);
        self.power.write(power);
        d.ring(self.bell);
        if let Some((code, detail)) = supply_event(before, self.watchdog.supply()) {
            d.report(self.now(), code, detail);
        }
    }

    /// Tick and stamp of the newest sign of life.
    fn now(&self) -> Header {
        self.reset.held().map_or(Header::default(), |r| r.header)
    }
}
