//! RealtimeSanitizer sees an allocation in an armed cycle, and none outside. `tests/rtsan` runs it.

use std::hint::black_box;
use std::process::Command;

/// The process that is looked at: this program again.
#[test]
fn cycle() {
    let Ok(place) = std::env::var("GANGWERK_ALLOCATES") else { return };
    let mut meter = realtime::CycleMeter::new(0, false, 0);
    meter.arm();
    meter.begin(0, 0);
    if place == "inside" {
        black_box(Box::new(black_box(1)));
    }
    meter.end(0, 0);
    black_box(Box::new(black_box(2)));
}

#[test]
fn an_allocation_in_a_cycle_is_reported() {
    let Ok(runtime) = std::env::var("GANGWERK_RTSAN") else {
        println!("not run: without GANGWERK_RTSAN, the runtime as a shared library; tests/rtsan makes it");
        return;
    };
    for (place, reported) in [("inside", true), ("outside", false)] {
        let said = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "cycle", "--nocapture"])
            .env("GANGWERK_ALLOCATES", place)
            .env("LD_PRELOAD", &runtime)
            .env("RTSAN_OPTIONS", "halt_on_error=false")
            .output()
            .unwrap();
        let text = String::from_utf8_lossy(&said.stderr).into_owned();
        assert_eq!(text.contains("RealtimeSanitizer: unsafe-library-call"), reported, "{place}: {text}");
    }
}
