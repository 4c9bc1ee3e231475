//! The process around the watchdog: `gangwerk watchdog --run DIR`.
//!
//! Real time: a grid of its own, one cycle per bus cycle, so that it notices what no longer happens. The grid lies
//! between the heartbeat of one cycle and the latest of the next: a late one is not taken for a missing one. Lockstep:
//! woken by the joint loop's heartbeat, it answers each tick.

use crate::estop::EmergencyStop;
use crate::{Inputs, Supply, Watchdog, supply_event, verdict};
use config::Timeline;
use daemon::{Commands, Connect, Daemon};
use ipc::{Mode, Reader, StopLine, Writer};
use messages::topics::{POWER, WATCHDOG_RESET};
use messages::{Command, Detail, EventCode, Header, Live, Power, Process, WatchdogReset};
use realtime::{Period, ThreadSchedule, clock};
use std::error::Error;
use std::path::Path;

/// Commands looked at per cycle; the rest waits for the next.
const MAX_COMMANDS: usize = 16;
/// Share of a period after the joint loop's wake-up at which the watchdog looks.
const PHASE: (u64, u64) = (4, 10);
/// Share of a period after which a look is a late one.
const LATE: (u64, u64) = (1, 4);

/// Guards until asked to end.
///
/// # Errors
/// The process cannot start, or, in lockstep, the joint loop fell silent.
pub fn main(dir: &Path, connect: Connect) -> Result<(), Box<dyn Error>> {
    let mut d = Daemon::new(Process::Watchdog, dir)?;
    let mut guard = Guard {
        stop: listen(&d)?,
        reset: d.space.reader(&WATCHDOG_RESET)?,
        power: d.space.writer(&POWER)?,
        bell: d.bell(&POWER)?,
        timeline: Timeline::new(&d.setup.scene, Process::Watchdog),
        commands: connect(&d.space)?,
        watchdog: Watchdog::new(d.setup.system.watchdog_missed, d.setup.system.toggle_missed),
    };
    if guard.power.epoch() > 1 {
        // Started again: power stays off until somebody asks for it now.
        guard.timeline.drop_rest();
        guard.watchdog = guard.watchdog.restarted();
    }
    d.report(Header::default(), EventCode::Started, Detail::Nothing);
    match d.mode {
        Mode::Lockstep => lockstep(&mut d, &mut guard)?,
        Mode::RealTime => real_time(&mut d, &mut guard),
    }
    d.report(guard.now(), EventCode::Ended, Detail::Nothing);
    Ok(())
}

/// The emergency stop's own line and thread.
fn listen(d: &Daemon) -> Result<EmergencyStop, Box<dyn Error>> {
    let row = d.setup.system.emergency_stop;
    let schedule = match d.mode {
        Mode::RealTime => ThreadSchedule { priority: row.priority, core: row.core },
        Mode::Lockstep => ThreadSchedule::ORDINARY,
    };
    let (stop, granted) = EmergencyStop::listen(StopLine::bind(d.space.dir())?, schedule)?;
    for missing in &granted.missing {
        tracing::warn!("watchdog degraded: thread of the emergency stop: {missing}");
    }
    Ok(stop)
}

fn lockstep(d: &mut Daemon, guard: &mut Guard) -> Result<(), Box<dyn Error>> {
    let waiter = d.space.waiter(Process::Watchdog)?;
    while d.wait(&waiter, "lowlevel", || guard.reset.refresh())? {
        d.begin(clock::now());
        guard.cycle(d, 0, false);
        d.end(guard.now(), 0);
    }
    Ok(())
}

fn real_time(d: &mut Daemon, guard: &mut Guard) {
    let period_ns = d.period_ns();
    let mut period = Period::new(clock::now() + period_ns, period_ns, u32::MAX);
    let (mut aligned, mut overrun) = (false, 0);
    while !d.stop.asked() {
        clock::sleep_until(period.planned());
        d.begin(period.planned());
        guard.reset.refresh();
        // After the look: whatever held it up is in this time. Whole periods slept through, and those of the cycle before.
        let late_ns = clock::now().saturating_sub(period.planned());
        let slept = late_ns / period_ns;
        let skipped = slept + overrun;
        guard.cycle(d, skipped, skipped > 0 || late_ns > period_ns * LATE.0 / LATE.1);
        let mut verdict = period.finish(clock::now());
        overrun = verdict.skipped().saturating_sub(slept);
        if let Some(reset) = guard.reset.held().filter(|_| !aligned) {
            let begun = reset.header.stamp_ns + period_ns * PHASE.0 / PHASE.1;
            period = Period::new(begun, period_ns, u32::MAX);
            verdict = period.finish(clock::now());
            (aligned, overrun) = (true, 0);
        }
        d.end(guard.now(), verdict.skipped());
    }
}

struct Guard {
    stop: EmergencyStop,
    reset: Reader<WatchdogReset>,
    power: Writer<Power>,
    bell: usize,
    timeline: Timeline,
    commands: Commands,
    watchdog: Watchdog,
}

impl Guard {
    /// One step with the newest heartbeat and the commands of this cycle: the scene's that are due, then live ones.
    /// `skipped` own cycles were missed before it; `late` in its cycle is one after a quarter of it.
    fn cycle(&mut self, d: &mut Daemon, skipped: u64, late: bool) {
        let mut lives = [Live::of_scene(Command::End); MAX_COMMANDS];
        let mut waiting = [Command::End; MAX_COMMANDS + 1];
        let mut count = 0;
        let now = self.now();
        let asker = self.stop.asked();
        if asker.is_some() {
            self.timeline.drop_rest();
        }
        while count < MAX_COMMANDS
            && let Some(live) = self.next_command(now.tick)
        {
            (lives[count], waiting[count]) = (live, live.command);
            count += 1;
        }
        let lives = &lives[..count];
        let before = self.watchdog.supply();
        if let Some(asker) = asker {
            // Last, so that no reset and enable of the same cycle undo it; in front there may be no room.
            waiting[count] = Command::EmergencyStop;
            count += 1;
            if before != Supply::Off(EventCode::EmergencyStop) {
                let detail = Detail::Caller { user: asker.uid, process: asker.pid };
                d.report(self.now(), EventCode::EmergencyStop, detail);
            }
        }
        let inputs = Inputs { reset: self.reset.held(), commands: &waiting[..count], skipped, late };
        (d.log.now().skipped, d.log.now().late) = (skipped, late.into());
        d.log.uses(0, &WATCHDOG_RESET, inputs.reset);
        let power = self.watchdog.step(&inputs);
        self.power.write(power);
        self.stop.written(power);
        d.log.keep(&POWER, power);
        d.ring(self.bell);
        let after = self.watchdog.supply();
        for live in lives {
            let verdict = verdict(&live.command, before, after);
            self.commands.answer(live, verdict);
            d.log.took(now, live, &verdict);
        }
        if asker.is_some() {
            d.log.took(now, &Live::of_scene(Command::EmergencyStop), &Ok(()));
        }
        d.log.left_out(now, self.commands.as_mut());
        if let Some((code, detail)) = supply_event(before, after) {
            d.report(self.now(), code, detail);
        }
    }

    /// The next command of this cycle: the scene's that are due, then live ones.
    ///
    /// After somebody's emergency stop the scene says no more: its reset and enable would undo what a person did.
    fn next_command(&mut self, tick: u64) -> Option<Live> {
        if let Some(scene) = self.timeline.due(tick) {
            return Some(Live::of_scene(scene));
        }
        let live = self.commands.next()?;
        if live.command == Command::EmergencyStop {
            self.timeline.drop_rest();
        }
        Some(live)
    }

    /// Tick and stamp of the newest heartbeat.
    fn now(&self) -> Header {
        self.reset.held().map_or(Header::default(), |r| r.header)
    }
}
