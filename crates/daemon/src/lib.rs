//! Frame around the step of every cyclic process.
//!
//! Load the configuration, prepare the thread, enter shared memory, build everything: the last allocation. Then wait,
//! read the newest inputs, step, write; count; report what happened. [`Daemon`] is that frame; the process adds its
//! ports and its loop, and tells [`CycleLog`] what each cycle began with.

mod cycle_log;

pub use cycle_log::CycleLog;

use config::{BusAddress, Setup};

use ipc::{Bell, IpcError, Mode, Run, Space, Waiter, Woken, Writer};
use messages::topics::{Process, Topic};
use messages::{BusCounters, CommandSource, CycleStats, Detail, Event, EventCode, Header};
use realtime::{CycleMeter, Granted, Stop, ThreadSchedule, clock, prepare_thread};
use std::error::Error;
use std::path::Path;
use std::time::Duration;

/// Source of live commands and destination of their answers. Those of the scene come by tick.
pub type Commands = Box<dyn CommandSource>;

/// Opens the source of live commands in a space.
pub type Connect<'a> = Box<dyn FnOnce(&Space) -> Result<Commands, String> + 'a>;

/// Cycles of the running chain before counting begins: everything has been touched once, everybody is connected.
const WARM_UP: u64 = 100;
/// Cycles from one record of statistics to the next.
const STATS_EVERY: u64 = 100;

/// The frame of a cyclic process.
pub struct Daemon {
    /// Which process.
    pub process: Process,
    /// Lockstep or real time.
    pub mode: Mode,
    /// In lockstep: no faster than real time.
    pub paced: bool,
    /// The field bus.
    pub bus: BusAddress,
    /// Whether a simulated robot is at its far end.
    pub robot: bool,
    /// A run that goes on when the scene is over.
    pub stays: bool,
    /// Whether the run is logged.
    pub logged: bool,
    /// Scene, robot, gait, run-time system.
    pub setup: Setup,
    /// Shared memory of the run.
    pub space: Space,
    /// The request to end.
    pub stop: Stop,
    /// Inputs of each cycle.
    pub log: CycleLog,
    meter: CycleMeter,
    stats: Writer<CycleStats>,
    events: Writer<Event>,
    topic_of_events: &'static Topic,
    bells: Vec<Bell>,
    cycle: u64,
    granted: Granted,
}

impl Daemon {
    /// Everything up to the ports of the process.
    ///
    /// # Errors
    /// Problem, and what to do.
    pub fn new(process: Process, dir: &Path) -> Result<Self, Box<dyn Error>> {
        let stop = Stop::on_signals()?;
        let run = Run::load(dir)?;
        let method = run.method.as_deref().map(str::parse).transpose()?;
        let bus: BusAddress = run.bus.parse()?;
        let setup = Setup::load(&run.config, &run.scene)?.with_method(method)?.on_bus(bus.is_classic())?;
        // Real time needs priority and core; in lockstep neither is asked for.
        let row = setup.system.process(process).cloned();
        let schedule = match (run.mode, &row) {
            (Mode::RealTime, Some(row)) => ThreadSchedule { priority: row.priority, core: row.core },
            _ => ThreadSchedule::ORDINARY,
        };
        let granted = prepare_thread(&schedule);
        for missing in &granted.missing {
            tracing::warn!("{} degraded: {missing}", process.name());
        }
        // Building takes milliseconds: at the priority of a running joint loop it would stop that one for as long.
        granted.stand_back();
        let space = run.enter(process)?;
        let deadline = row.map_or(0, |row| row.deadline_ns);
        Ok(Self {
            meter: CycleMeter::new(deadline, granted.degraded(), setup.hash),
            stats: space.writer(topic(process, "cycle_stats")?)?,
            events: space.writer(topic(process, "events")?)?,
            topic_of_events: topic(process, "events")?,
            log: CycleLog::new(process, &space)?,
            bells: Vec::new(),
            cycle: 0,
            granted,
            bus,
            robot: run.robot,
            stays: run.stays,
            logged: run.log.is_some(),
            mode: run.mode,
            paced: run.paced,
            process,
            setup,
            space,
            stop,
        })
    }

    /// Bus cycle \[ns\].
    pub fn period_ns(&self) -> u64 {
        (self.setup.scene.cycle * 1e9).round() as u64
    }

    /// Timeout for a missing peer.
    pub fn patience(&self) -> Duration {
        Duration::from_secs_f64(self.setup.system.peer_timeout)
    }

    /// The bell of a topic; its index for [`Daemon::ring`]. Bells are connected to their hearers before counting begins.
    pub fn bell(&mut self, topic: &Topic) -> Result<usize, IpcError> {
        self.bells.push(self.space.bell(topic)?);
        Ok(self.bells.len() - 1)
    }

    /// Errors of the field bus so far, for the statistics.
    pub fn count_bus(&mut self, counters: BusCounters) {
        self.meter.count_bus(counters);
    }

    /// Rings a bell.
    pub fn ring(&self, bell: usize) {
        self.bells[bell].ring();
    }

    /// Waits until `ready`; `Ok(false)`: asked to end. In lockstep a silent peer is an error that names it; in real time
    /// it is waited for without end, as before the first cycle: its silence is seen by the age of what it wrote.
    pub fn wait(
        &self,
        waiter: &Waiter,
        peer: &str,
        mut ready: impl FnMut() -> bool,
    ) -> Result<bool, Box<dyn Error>> {
        loop {
            match waiter.wait_until(self.patience(), || self.stop.asked(), &mut ready) {
                Woken::Ready => return Ok(true),
                Woken::Stopped => return Ok(false),
                Woken::Silent if self.mode == Mode::RealTime => {}
                // Others may still be starting; the supervisor watches that.
                Woken::Silent if self.cycle == 0 => {}
                Woken::Silent => {
                    let seconds = self.patience().as_secs_f64();
                    let me = self.process.name();
                    return Err(format!(
                        "{me}: lockstep: {peer} did not answer within {seconds} s; is it running?"
                    )
                    .into());
                }
            }
        }
    }

    /// A cycle begins that the record with this header woke: in real time it was planned for when the bus cycle began.
    pub fn begin_woken(&mut self, by: Header) {
        let now = clock::now();
        let planned_ns = if self.mode == Mode::RealTime { by.stamp_ns } else { now };
        self.log.begin(now);
        self.meter.begin(planned_ns, now);
    }

    /// A cycle that was planned for `planned_ns` begins.
    pub fn begin(&mut self, planned_ns: u64) {
        let now = clock::now();
        self.log.begin(now);
        self.meter.begin(planned_ns, now);
    }

    /// The cycle `header` ends, and `skipped` wake-ups were missed.
    pub fn end(&mut self, header: Header, skipped: u64) {
        let now = clock::now();
        self.log.end(header, now);
        self.meter.end(now, skipped);
        // Before the first tick the processes that come later are not there yet, and bells connect to them.
        self.cycle += u64::from(header.tick > 0);
        if self.cycle == WARM_UP {
            self.bells.iter().for_each(Bell::connect);
            self.meter.arm();
        }
        if header.tick > 0 && self.cycle.is_multiple_of(STATS_EVERY) {
            let stats = self.meter.stats();
            stats.header = header;
            self.stats.write(stats);
        }
    }

    /// Writes an event. With `Started` everything is built: from here on the process has its real-time priority.
    pub fn report(&mut self, header: Header, code: EventCode, detail: Detail) {
        if code == EventCode::Started {
            // Which configuration it has, before anything moves: the supervisor compares.
            let stats = self.meter.stats();
            stats.header = header;
            self.stats.write(stats);
            self.granted.engage();
        }
        let event = Event::new(header, code, detail);
        self.events.write(&event);
        self.log.keep(self.topic_of_events, &event);
    }
}

/// The topic `prefix/PROCESS`.
fn topic(process: Process, prefix: &str) -> Result<&'static Topic, String> {
    let name = format!("{prefix}/{}", process.name());
    Topic::find(&name).ok_or_else(|| format!("there is no topic {name}"))
}
