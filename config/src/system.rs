//! The run-time system: one table of processes, and the limits that keep it safe.

use std::net::SocketAddr;
use std::path::Path;

use messages::Process;

use crate::error::ConfigError;
use crate::file::{self, ConfigReader};
use crate::section::{self, NOT_NEGATIVE, POSITIVE, Section};

/// `system.toml`.
#[derive(Clone, Debug)]
pub struct System {
    /// One row per process, in the order of [`Process::ALL`].
    pub processes: Vec<ProcessRow>,
    /// All processes, in the order in which `gangwerk run` starts them; each has built everything before the next begins.
    pub start_order: Vec<Process>,
    /// Cycles without a reset after which the watchdog cuts the motor supply.
    pub watchdog_missed: u32,
    /// Cycles without a move of the watchdog's toggle after which the relay of the motor supply falls. A watchdog that missed
    /// so many of its own cycles has lost the relay, and knows it.
    pub toggle_missed: u32,
    /// Cycles without new joint targets after which lowlevel begins a controlled stop.
    pub targets_missed: u32,
    /// Leaky bucket of overruns: +1 per overrun, -1 per good cycle; full means controlled stop.
    pub overrun_bucket: u32,
    /// \[rad\] Following error at rest that trips the motor supply.
    pub following_error: f64,
    /// \[s\] Following error that is allowed in addition, per rad/s of joint speed.
    pub following_time: f64,
    /// Address and port on which the broker serves TCP; port 0: one that the system chooses; none: no TCP.
    pub tcp_listen: Option<SocketAddr>,
    /// File of keys for clients on the network, relative to the configuration directory; empty: none.
    pub tcp_keys: String,
    /// \[s\] Timeout after which a process names a missing peer and ends.
    pub peer_timeout: f64,
    /// Tolerances of lowlevel for bus faults.
    pub bus: BusLimits,
    /// Thread of the watchdog that listens for the emergency stop.
    pub emergency_stop: ThreadRow,
}

/// Scheduling of a thread beside a process's own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ThreadRow {
    /// Core it is bound to; none: wherever there is room.
    pub core: Option<usize>,
    /// SCHED_FIFO priority 1..98; 0: the ordinary scheduler.
    pub priority: u8,
}

/// Tolerances of lowlevel for bus faults: `[bus]`.
#[derive(Clone, Copy, Debug)]
pub struct BusLimits {
    /// \[1\] Cycles without a node's frames in which its joints are taken to move on at their last speed.
    pub carried_on: u32,
    /// \[1\] Cycles without a node's frames after which a controlled stop begins.
    pub missed: u32,
    /// \[rad\] Jump of a joint angle from one reading to the next that is no reading, of a joint at rest.
    pub jump: f64,
    /// \[1\] Jump that is allowed in addition, over the joint's speed limit times the time since it was read last.
    pub jump_speed: f64,
    /// \[1\] Change of one component of a force alone in one cycle that is no reading, over the robot's weight.
    pub jump_force: f64,
}

/// Scheduling of one process.
#[derive(Clone, Debug)]
pub struct ProcessRow {
    /// Which process.
    pub process: Process,
    /// Core it is bound to; none: wherever there is room.
    pub core: Option<usize>,
    /// SCHED_FIFO priority 1..98; 0: the ordinary scheduler.
    pub priority: u8,
    /// \[ns\] Time after the start of a cycle by which the process must have answered; 0: none.
    pub deadline_ns: u64,
}

impl System {
    /// Reads `system.toml`.
    pub fn load(path: &Path) -> Result<Self, ConfigError> {
        Self::load_with(path, &mut ConfigReader::default())
    }

    pub(crate) fn load_with(path: &Path, reader: &mut ConfigReader) -> Result<Self, ConfigError> {
        let text = file::text(path, reader)?;
        section::read(path, &text, Self::build)
    }

    fn build(top: &Section<'_, '_>) -> Self {
        let system = Self {
            processes: top.table("process", processes).unwrap_or_default(),
            start_order: start_order(top),
            watchdog_missed: top.integer("watchdog_missed", 1..=1000) as u32,
            toggle_missed: top.integer("toggle_missed", 1..=1000) as u32,
            targets_missed: top.integer("targets_missed", 1..=1000) as u32,
            overrun_bucket: top.integer("overrun_bucket", 1..=100_000) as u32,
            following_error: top.number("following_error", "rad", POSITIVE),
            following_time: top.number("following_time", "s", NOT_NEGATIVE),
            tcp_listen: tcp_listen(top),
            tcp_keys: top.text("tcp_keys"),
            peer_timeout: top.number("peer_timeout", "s", POSITIVE),
            bus: top.table("bus", BusLimits::build).unwrap_or_default(),
            emergency_stop: top.table("emergency_stop", ThreadRow::build).unwrap_or_default(),
        };
        // Whoever runs above the emergency stop can keep it from running.
        let (own, rows) = (system.emergency_stop.priority, &system.processes);
        let above = |row: &&ProcessRow| row.priority > 0 && row.priority >= own;
        if let Some(row) = rows.iter().find(above).filter(|_| top.has("emergency_stop")) {
            let (name, priority) = (row.process.name(), row.priority);
            top.problem(
                "emergency_stop",
                format!("priority = {own} must be above {priority}, that of {name}"),
            );
        }
        system
    }

    /// The row of a process; none for observers.
    pub fn process(&self, process: Process) -> Option<&ProcessRow> {
        self.processes.iter().find(|row| row.process == process)
    }
}

impl BusLimits {
    fn build(table: &Section<'_, '_>) -> Self {
        let built = Self {
            carried_on: table.integer("carried_on", 0..=100) as u32,
            missed: table.integer("missed", 1..=1000) as u32,
            jump: table.number("jump", "rad", 1e-3..=1.0),
            jump_speed: table.number("jump_speed", "", 1.0..=100.0),
            jump_force: table.number("jump_force", "", 0.1..=100.0),
        };
        if built.carried_on > built.missed {
            let text =
                format!("{} cycles are more than missed = {}, the stop", built.carried_on, built.missed);
            table.problem("carried_on", text);
        }
        built
    }
}

impl Default for BusLimits {
    /// A stand-in for a table that is missing: nothing is borne.
    fn default() -> Self {
        Self { carried_on: 0, missed: 1, jump: f64::NAN, jump_speed: f64::NAN, jump_force: f64::NAN }
    }
}

impl ThreadRow {
    fn build(row: &Section<'_, '_>) -> Self {
        Self {
            core: row.has("core").then(|| row.integer("core", 0..=1023) as usize),
            priority: row.integer("priority", 0..=98) as u8,
        }
    }
}

/// `tcp_listen = "127.0.0.1:7411"`, or empty.
fn tcp_listen(top: &Section<'_, '_>) -> Option<SocketAddr> {
    let text = top.text("tcp_listen");
    let address = text.parse().ok();
    if address.is_none() && !text.is_empty() {
        let must = "must be ADDRESS:PORT, for example \"127.0.0.1:7411\" (port 0: the system chooses), or empty: no TCP";
        top.problem("tcp_listen", format!("`{text}` {must}"));
    }
    address
}

/// Every process once.
fn start_order(top: &Section<'_, '_>) -> Vec<Process> {
    let names = top.texts("start_order");
    let process = |name: &String| Process::ALL.into_iter().find(|p| p.name() == name);
    let order: Vec<Process> = names.iter().filter_map(process).collect();
    let once = |process| order.iter().filter(|p| **p == process).count() == 1;
    let whole = names.len() == order.len() && Process::ALL.into_iter().all(once);
    if !whole && top.has("start_order") {
        let all = Process::ALL.map(Process::name).join(", ");
        top.problem("start_order", format!("must name each process once: {all}"));
    }
    order
}

/// One table `[process.NAME]` for each process.
fn processes(table: &Section<'_, '_>) -> Vec<ProcessRow> {
    let row = |process: Process| table.table(process.name(), |row| ProcessRow::build(row, process));
    Process::ALL.into_iter().filter_map(row).collect()
}

impl ProcessRow {
    fn build(row: &Section<'_, '_>, process: Process) -> Self {
        Self {
            process,
            core: row.has("core").then(|| row.integer("core", 0..=1023) as usize),
            priority: row.integer("priority", 0..=98) as u8,
            deadline_ns: row.integer("deadline_ns", 0..=1_000_000_000),
        }
    }
}
