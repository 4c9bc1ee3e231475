//! The run-time system: one table of processes, and the limits that keep it safe.

use messages::Process;

/// `system.toml`.
#[derive(Clone, Debug)]
pub struct System {
    /// One row per process, in the order of [`Process::ALL`].
    pub processes: Vec<ProcessRow>,
    /// Cycles without a reset after which the watchdog cuts the motor supply.
    pub watchdog_missed: u32,
    /// Cycles without new joint targets after which lowlevel begins a controlled stop.
    pub targets_missed: u32,
    /// Leaky bucket of overruns: +1 per overrun, -1 per good cycle; full means controlled stop.
    pub overrun_bucket: u32,
    /// \[rad\] Following error at rest that trips the motor supply ...
    pub following_error: f64,
    /// \[s\] ... plus this much per rad/s of joint speed.
    pub following_time: f64,
    /// TCP port of the broker on the loopback interface; 0: none.
    pub tcp_port: u16,
    /// \[s\] How long a process waits for a missing peer before it names it and ends.
    pub peer_timeout: f64,
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
