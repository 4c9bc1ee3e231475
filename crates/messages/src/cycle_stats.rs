//! `cycle_stats/PROCESS`: how well a process keeps its cycle.

use crate::{Header, record};

/// Octaves by which times of cycles are counted.
pub const OCTAVES: usize = 20;
/// Binary logarithm of the end of the first one \[ns\].
pub const FIRST_OCTAVE: usize = 10;

record! {
    /// Frame errors of the field bus since start.
    part BusCounters {
        /// \[1\] Frames that did not come in their cycle.
        lost: u64,
        /// \[1\] Frames of an earlier cycle.
        late: u64,
        /// \[1\] Frames that came a second time.
        duplicated: u64,
        /// \[1\] Frames of wrong length or unknown identifier, and readings that cannot be.
        refused: u64,
        /// \[1\] Error frames.
        error_frames: u64,
        /// \[1\] Number of times a line was lost because its controller left the bus.
        bus_off: u64,
    }
}

record! {
    /// Cycle statistics since start. Written by every cyclic process, a few times per second.
    record CycleStats {
        /// Tick of the last cycle counted.
        header: Header,
        /// \[1\] Cycles since arming.
        cycles: u64,
        /// \[1\] Cycles that ended after their deadline.
        overruns: u64,
        /// \[1\] Whole periods skipped because of overruns.
        skipped: u64,
        /// \[ns\] Wake-up after the planned time: p50, p99, p99.9, max.
        lateness_ns: [u64; 4],
        /// \[ns\] Execution time: p50, p99, p99.9, max.
        execution_ns: [u64; 4],
        /// \[1\] Cycles by octaves of lateness: below 2^10 ns, from there below 2^11 ns, and so on; the last one from 2^28 ns on.
        lateness_octaves: [u64; OCTAVES],
        /// \[1\] Cycles by octaves of execution time, as above.
        execution_octaves: [u64; OCTAVES],
        /// \[1\] Minor and major page faults since arming.
        page_faults: [u64; 2],
        /// \[1\] Heap allocations and frees on the cycle's thread since arming.
        allocations: [u64; 2],
        /// \[1\] Hash of the configuration the process runs with.
        config_hash: u64,
        /// \[1\] 1 if real-time scheduling was asked for and not granted.
        degraded: u64,
        /// Counters of the field bus; of lowlevel only.
        bus: BusCounters,
    }
}
