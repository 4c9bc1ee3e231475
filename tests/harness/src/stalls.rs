//! Stalls of the machine itself, whatever runs on it: a test in real time blames them neither on robots nor on what it does to
//! them.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::thread::{self, JoinHandle};

use realtime::clock::{now, sleep_until};
use realtime::{ThreadSchedule, prepare_side_thread};

/// Above the priority of every process of a robot.
const PRIORITY: u8 = 95;
const PERIOD_NS: u64 = 1_000_000;

/// On each core a thread that nothing but the machine can hold up, until this is dropped.
pub struct Stalls {
    longest_ns: Arc<AtomicU64>,
    over: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

impl Stalls {
    /// Begins to watch.
    pub fn watch() -> Self {
        let cores = thread::available_parallelism().map_or(1, usize::from);
        let (longest_ns, over) = (Arc::<AtomicU64>::default(), Arc::<AtomicBool>::default());
        let threads = (0..cores).map(|core| {
            let (longest, over) = (Arc::clone(&longest_ns), Arc::clone(&over));
            thread::spawn(move || {
                // Without the right to it, it is an ordinary thread, and other work counts as a stall.
                let _granted = prepare_side_thread(&ThreadSchedule { priority: PRIORITY, core: Some(core) });
                while !over.load(Relaxed) {
                    let wakes = now() + PERIOD_NS;
                    sleep_until(wakes);
                    longest.fetch_max(now().saturating_sub(wakes), Relaxed);
                }
            })
        });
        let threads = threads.collect();
        Self { longest_ns, over, threads }
    }

    /// Longest stall of a core since the beginning \[s\].
    pub fn longest(&self) -> f64 {
        self.longest_ns.load(Relaxed) as f64 * 1e-9
    }
}

impl Drop for Stalls {
    fn drop(&mut self) {
        self.over.store(true, Relaxed);
        self.threads.drain(..).for_each(|thread| drop(thread.join()));
    }
}
