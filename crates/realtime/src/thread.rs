//! Makes the calling thread a real-time thread, as far as this machine lets it, and says how far that was.

use rustix::mm::{MlockAllFlags, mlockall};
use rustix::process::{Resource, getrlimit};
use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
use std::fs::File;
use std::io::Write;

/// Stack and heap touched beforehand \[B\].
const STACK: usize = 1 << 20;
const HEAP: usize = 16 << 20;
/// The same of a side thread \[B\].
const SIDE_STACK: usize = 64 << 10;
/// Memory that must be lockable before anything is locked: later mappings fail if the limit is met \[B\].
const LOCKABLE: u64 = 1 << 30;

/// Scheduling that a thread asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ThreadSchedule {
    /// SCHED_FIFO priority 1..98; 0: the ordinary scheduler, and nothing is locked or touched.
    pub priority: u8,
    /// Core to be bound to; none: any.
    pub core: Option<usize>,
}

impl ThreadSchedule {
    /// Scheduling for lockstep: none.
    pub const ORDINARY: Self = Self { priority: 0, core: None };
}

/// Grant.
#[derive(Debug, Default)]
pub struct Granted {
    /// All memory, present and future, stays in RAM.
    pub locked: bool,
    /// SCHED_FIFO priority as read back; 0: ordinary.
    pub priority: u8,
    /// The core as read back.
    pub core: Option<usize>,
    /// The processor does not go to sleep states while this lives.
    pub awake: bool,
    /// Requests that were not granted, with the reason and what to do.
    pub missing: Vec<String>,
    _awake: Option<File>,
}

impl Granted {
    /// Whether anything asked for was not granted.
    pub fn degraded(&self) -> bool {
        !self.missing.is_empty()
    }
}

impl Granted {
    /// Gives the real-time priority back until [`Granted::engage`]: who builds for milliseconds at the priority of
    /// a running joint loop, of another robot or of the one that this process replaces, stops it for as long.
    pub fn stand_back(&self) {
        if self.priority > 0 {
            schedule(libc::SCHED_OTHER, 0);
        }
    }

    /// Takes the priority that was granted.
    pub fn engage(&self) {
        if self.priority > 0 {
            schedule(libc::SCHED_FIFO, self.priority);
        }
    }
}

/// Prepares the calling thread; before its ports are made, so that they are locked too.
///
/// Threads it starts later are ordinary ones on the same core. Nothing fails here: what is missing is listed.
pub fn prepare_thread(schedule: &ThreadSchedule) -> Granted {
    let mut granted = Granted::default();
    if schedule.priority > 0 {
        granted.locked = lock_memory(&mut granted.missing);
        touch_heap();
        touch_stack();
        granted.awake = stay_awake(&mut granted);
    }
    if let Some(core) = schedule.core {
        granted.core = bind(core, &mut granted.missing);
    }
    if schedule.priority > 0 {
        granted.priority = fifo(schedule.priority, &mut granted.missing);
    }
    granted
}

/// Prepares a second real-time thread of a process whose memory [`prepare_thread`] has locked already: its stack is touched,
/// and it runs at `schedule`. Without a core it may run on any, also if the thread that started it is bound to one.
pub fn prepare_side_thread(schedule: &ThreadSchedule) -> Granted {
    let mut granted = Granted::default();
    if schedule.priority == 0 {
        return granted;
    }
    touch_some_stack();
    match schedule.core {
        Some(core) => granted.core = bind(core, &mut granted.missing),
        None => run_on_any_core(),
    }
    granted.priority = fifo(schedule.priority, &mut granted.missing);
    granted
}

/// Lets the calling thread run on any core that this machine, and who started the program, leave to it: one that works for a
/// control process and must not starve behind the chain of processes on its core.
pub fn run_on_any_core() {
    let mut cores = CpuSet::new();
    (0..CpuSet::MAX_CPU).for_each(|core| cores.set(core));
    // What fails leaves it where it is.
    let _ = sched_setaffinity(None, &cores);
}

fn lock_memory(missing: &mut Vec<String>) -> bool {
    if let Some(limit) = getrlimit(Resource::Memlock).current
        && limit < LOCKABLE
        && !has_capability(CAP_IPC_LOCK)
    {
        missing.push(format!(
            "memory is not locked: the limit is {} KiB (ulimit -l unlimited, or memlock in /etc/security/limits.conf)",
            limit >> 10
        ));
        return false;
    }
    match mlockall(MlockAllFlags::CURRENT | MlockAllFlags::FUTURE) {
        Ok(()) => true,
        Err(e) => {
            missing.push(format!("memory is not locked: {e} (needs CAP_IPC_LOCK or ulimit -l unlimited)"));
            false
        }
    }
}

/// Freed memory stays with the process, so that what was touched once never faults again.
fn touch_heap() {
    // SAFETY: mallopt sets two integers of the C library's allocator; -1 and 0 are documented values.
    unsafe {
        libc::mallopt(libc::M_TRIM_THRESHOLD, -1);
        libc::mallopt(libc::M_MMAP_MAX, 0);
    }
    let mut block = vec![0u8; HEAP];
    for page in block.chunks_mut(4096) {
        page[0] = 1;
    }
    std::hint::black_box(&block);
}

#[inline(never)]
fn touch_stack() {
    let mut block = [0u8; STACK];
    for page in block.chunks_mut(4096) {
        page[0] = 1;
    }
    std::hint::black_box(&block);
}

/// The part of its stack that a thread of few calls needs.
#[inline(never)]
fn touch_some_stack() {
    std::hint::black_box(&mut [1u8; SIDE_STACK]);
}

fn stay_awake(granted: &mut Granted) -> bool {
    let open = || {
        let mut file = File::options().write(true).open("/dev/cpu_dma_latency")?;
        file.write_all(&0i32.to_ne_bytes())?;
        Ok::<_, std::io::Error>(file)
    };
    match open() {
        Ok(file) => {
            granted._awake = Some(file);
            true
        }
        Err(e) => {
            granted
                .missing
                .push(format!("the processor may sleep: /dev/cpu_dma_latency: {e} (give write access)"));
            false
        }
    }
}

fn bind(core: usize, missing: &mut Vec<String>) -> Option<usize> {
    let bound = || {
        if core >= CpuSet::MAX_CPU {
            return Err(rustix::io::Errno::INVAL);
        }
        let mut set = CpuSet::new();
        set.set(core);
        sched_setaffinity(None, &set)?;
        let got = sched_getaffinity(None)?;
        if got.count() == 1 && got.is_set(core) { Ok(core) } else { Err(rustix::io::Errno::INVAL) }
    };
    bound()
        .map_err(|e| missing.push(format!("not bound to core {core}: {e} (this machine may not have it)")))
        .ok()
}

fn fifo(priority: u8, missing: &mut Vec<String>) -> u8 {
    if !schedule(libc::SCHED_FIFO, priority) {
        missing.push(format!(
            "no SCHED_FIFO priority {priority}: {} (needs CAP_SYS_NICE or rtprio in /etc/security/limits.conf)",
            std::io::Error::last_os_error()
        ));
    }
    scheduler_priority()
}

/// Sets policy and priority of the calling thread; whether that was allowed. Threads it starts are ordinary ones.
fn schedule(policy: i32, priority: u8) -> bool {
    let param = libc::sched_param { sched_priority: i32::from(priority) };
    // SAFETY: `param` is a valid `sched_param` that outlives the call; 0 means the calling thread.
    unsafe { libc::sched_setscheduler(0, policy | libc::SCHED_RESET_ON_FORK, &param) == 0 }
}

/// SCHED_FIFO priority of this thread, 0 if it is an ordinary one.
fn scheduler_priority() -> u8 {
    let mut param = libc::sched_param { sched_priority: 0 };
    // SAFETY: `param` is writable and 0 means the calling thread; both calls only read the scheduler's state.
    let policy = unsafe {
        libc::sched_getparam(0, &mut param);
        libc::sched_getscheduler(0)
    };
    if policy & !libc::SCHED_RESET_ON_FORK == libc::SCHED_FIFO { param.sched_priority as u8 } else { 0 }
}

pub(crate) const CAP_IPC_LOCK: u32 = 14;
pub(crate) const CAP_SYS_NICE: u32 = 23;

/// Whether this process has an effective capability.
pub(crate) fn has_capability(number: u32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let set = status.lines().find_map(|line| line.strip_prefix("CapEff:"));
    set.and_then(|hex| u64::from_str_radix(hex.trim(), 16).ok()).is_some_and(|set| set >> number & 1 == 1)
}
