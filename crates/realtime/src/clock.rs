//! The monotonic clock. Wall time exists in file names and as the date of a log only: [`unix_ns`].

use rustix::thread::{ClockId, clock_nanosleep_absolute};
use rustix::time::Timespec;

/// Nanoseconds in a second.
pub const SECOND: u64 = 1_000_000_000;

/// Time since the machine started \[ns\].
pub fn now() -> u64 {
    let t = rustix::time::clock_gettime(rustix::time::ClockId::Monotonic);
    t.tv_sec as u64 * SECOND + t.tv_nsec as u64
}

/// Wall time for names of files and the dates of logs: nanoseconds since 1970.
pub fn unix_ns() -> u64 {
    let t = rustix::time::clock_gettime(rustix::time::ClockId::Realtime);
    t.tv_sec as u64 * SECOND + t.tv_nsec as u64
}

/// Sleeps until that time \[ns\]; returns at once if it has passed.
///
/// Absolute, so that neither the time between computing and sleeping nor an interruption adds up.
pub fn sleep_until(time_ns: u64) {
    let t = Timespec { tv_sec: (time_ns / SECOND) as i64, tv_nsec: (time_ns % SECOND) as i64 };
    // Interrupted by a signal: sleep on, the end is where it was.
    while clock_nanosleep_absolute(ClockId::Monotonic, &t).is_err_and(|e| e == rustix::io::Errno::INTR) {}
}

/// Processor time of this thread so far \[ns\].
pub fn thread_time() -> u64 {
    let t = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    t.tv_sec as u64 * SECOND + t.tv_nsec as u64
}

/// Processor time of this process so far \[ns\].
pub fn processor_time() -> u64 {
    let t = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    t.tv_sec as u64 * SECOND + t.tv_nsec as u64
}
