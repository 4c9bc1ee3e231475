//! What a simulation costs: processor time of this process, which does nothing else meanwhile.

use realtime::clock::processor_time;

/// Runs of which the median counts.
const REPEATS: usize = 5;
/// \[s\] Runs as long as this are not repeated.
const LONG: f64 = 0.5;

/// Result of `run`, and its processor time \[s\]: the median of some runs, or that of one if it takes long.
pub fn of<T>(mut run: impl FnMut() -> T) -> (T, f64) {
    let mut times = Vec::with_capacity(REPEATS);
    loop {
        let begun = processor_time();
        let result = run();
        times.push((processor_time() - begun) as f64 * 1e-9);
        if times.len() == REPEATS || times.iter().sum::<f64>() > LONG {
            times.sort_by(f64::total_cmp);
            return (result, times[times.len() / 2]);
        }
    }
}
