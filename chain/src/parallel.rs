//! The same work on many cases, on all cores.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::ScopedJoinHandle;

/// `work` of 0 to n - 1, in this order whoever does it.
pub fn map<T: Send>(n: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    let mut found: Vec<(usize, T)> = std::thread::scope(|scope| {
        let each = || {
            let mut mine = Vec::new();
            loop {
                let k = next.fetch_add(1, Ordering::Relaxed);
                if k >= n {
                    return mine;
                }
                mine.push((k, work(k)));
            }
        };
        let threads: Vec<_> = (0..workers).map(|_| scope.spawn(each)).collect();
        let join = |t: ScopedJoinHandle<'_, _>| t.join().unwrap_or_else(|panic| resume_unwind(panic));
        threads.into_iter().flat_map(join).collect()
    });
    found.sort_by_key(|(k, _)| *k);
    found.into_iter().map(|(_, x)| x).collect()
}
