//! What a control cycle must not do is done here on purpose, once each, and must be reported.

use messages::CycleStats;
use realtime::{CycleMeter, Period, clock};

#[global_allocator]
static ALLOCATOR: realtime::CountingAllocator = realtime::CountingAllocator;

const CYCLES: u64 = 100;
/// \[ns\]
const PERIOD: u64 = 200_000;

/// Runs cycles on a real clock; `work` is called in each with its number, `delay` is added to each wake-up.
fn measure(delay: u64, mut work: impl FnMut(u64)) -> CycleStats {
    let mut meter = CycleMeter::new(0, false, 7);
    let mut period = Period::new(clock::now(), PERIOD, 1000);
    let mut stats = CycleStats::default();
    // The first round touches all that the second one uses.
    for round in 0..2 {
        if round == 1 {
            meter.arm();
        }
        for n in 0..CYCLES {
            clock::sleep_until(period.planned() + delay);
            meter.begin(period.planned(), clock::now());
            if round == 1 {
                work(n);
            }
            let skipped = period.finish(clock::now()).skipped();
            meter.end(clock::now(), skipped);
        }
        stats = *meter.stats();
    }
    stats
}

#[test]
fn a_clean_cycle_reports_nothing() {
    let mut x = 1.0f64;
    let stats = measure(0, |n| x = std::hint::black_box(x + n as f64));
    assert_eq!(stats.cycles, CYCLES);
    assert_eq!(stats.allocations, [0, 0]);
    assert_eq!(stats.page_faults, [0, 0]);
    assert_eq!((stats.config_hash, stats.degraded), (7, 0));
}

#[test]
fn one_allocation_is_seen() {
    let stats = measure(0, |n| {
        if n == 42 {
            std::hint::black_box(Box::new(n));
        }
    });
    assert_eq!(stats.allocations, [1, 1]);
}

#[test]
fn another_threads_allocations_are_not() {
    use std::sync::atomic::{AtomicBool, Ordering};
    let done = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !done.load(Ordering::Relaxed) {
                std::hint::black_box(vec![1u8; 1000]);
            }
        });
        let stats = measure(0, |_| ());
        done.store(true, Ordering::Relaxed);
        assert_eq!(stats.allocations, [0, 0]);
    });
}

#[test]
fn one_page_fault_is_seen() {
    let mut fresh = fresh_pages();
    let stats = measure(0, |n| {
        if n == 42 {
            std::hint::black_box(&mut fresh)[4096 * 100] = 1;
        }
    });
    assert_eq!(stats.page_faults, [1, 0]);
}

#[test]
fn constant_lateness_is_seen() {
    // Every interval is exactly one period; only the comparison with the plan shows the delay.
    let delay = 100_000;
    let stats = measure(delay, |_| ());
    assert!(stats.lateness_ns[0] >= delay, "{:?}", stats.lateness_ns);
}

#[test]
fn one_overrun_is_seen() {
    let stats = measure(0, |n| {
        if n == 42 {
            let end = clock::now() + 10 * PERIOD + PERIOD / 2;
            while clock::now() < end {}
        }
    });
    assert!(stats.overruns >= 1 && stats.skipped >= 10, "{} {}", stats.overruns, stats.skipped);
    assert!(stats.execution_ns[3] >= 10 * PERIOD);
}

/// Memory that nobody has touched yet.
fn fresh_pages() -> Box<[u8]> {
    // Large enough for a mapping of its own, which the kernel fills in page by page; zeroed, so that nothing writes.
    vec![0u8; 64 << 20].into_boxed_slice()
}
