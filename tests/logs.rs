//! Time and origin in logs: a log lasts as long as its scene, begins on the day it was made, stands in the order of time and
//! says what made it.
//!
//! Regression: records without a stamp made the logs of real time begin in 1970 and last as long as the machine was up.

use harness::{Site, WALK, turn};
use realtime::clock;
use recording::{Log, RunInfo};

const EXE: &str = harness::executable!();
/// \[s\] Of the scene.
const DURATION: f64 = 4.0;
/// \[s\]
const TOLERANCE: f64 = 1.0;

struct Found {
    run: RunInfo,
    /// \[ns\] First and last time of the log.
    span: [u64; 2],
    /// Share of messages that stand behind a later one.
    late: f64,
}

fn read(site: &Site, name: &str) -> Found {
    let log = Log::open(&site.path(name)).unwrap();
    let (mut span, mut late, mut count) = ([u64::MAX, 0], 0.0, 0.0);
    let end = log.each(|m| {
        count += 1.0;
        late += f64::from(u8::from(m.log_time_ns < span[1]));
        span = [span[0].min(m.log_time_ns), span[1].max(m.log_time_ns)];
    });
    end.unwrap();
    Found { run: log.run().clone(), span, late: late / count }
}

fn check(found: &Found) {
    let duration = (found.span[1] - found.span[0]) as f64 * 1e-9;
    println!("{duration:.3} s, {:.5} of the messages behind a later one", found.late);
    assert!((duration - DURATION).abs() < TOLERANCE, "{duration} s");
    assert!(found.late < 0.01, "{} of the messages stand behind a later one", found.late);
    assert_eq!((found.run.scene.as_str(), found.run.seed, found.run.cycle_ns), ("walk", 1, 1_000_000));
    assert!(found.run.commit.len() >= 40 || found.run.commit.is_empty(), "{:?}", found.run.commit);
}

fn site() -> Site {
    let site = Site::patient(EXE);
    site.scene("walk", DURATION, WALK);
    site
}

#[test]
fn a_log_of_real_time_lasts_as_long_as_its_scene_and_begins_today() {
    let (_turn, site) = (turn(), site());
    let before = clock::unix_ns();
    let _ = site.run("walk", &[]).end(); // on a busy machine she may lose her supply
    let found = read(&site, "walk.mcap");
    check(&found);
    assert!(found.span[0] >= before && found.span[1] <= clock::unix_ns(), "{:?}", found.span);
    let start = found.run.clock.expect("real time has a date");
    assert!(start.unix_ns >= before && start.unix_ns <= found.span[0] && !start.host.is_empty(), "{start:?}");
}

#[test]
fn a_log_of_simulated_time_begins_at_zero_and_names_no_day() {
    let site = site();
    site.run("walk", &["--lockstep"]).end().well();
    let log = |name: &str| site.path(name).display().to_string();
    for name in ["sim.mcap", "again.mcap"] {
        site.gangwerk(&["sim", "walk", "--log", &log(name)]).well();
    }
    for name in ["walk.mcap", "sim.mcap"] {
        let found = read(&site, name);
        check(&found);
        assert_eq!((found.span[0], found.run.clock), (0, None), "{name}");
    }
    let bytes = |name: &str| std::fs::read(site.path(name)).unwrap();
    assert!(bytes("sim.mcap") == bytes("again.mcap"), "two logs of one scene differ");
}
