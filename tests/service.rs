//! A run as a service: what a service manager hears, and whether the unit is one that systemd takes.

use harness::{Signal, Site, doze, root, shared_turn};
use realtime::clock;
use std::os::unix::net::UnixDatagram;
use std::process::Command;
use std::time::Duration;

const EXE: &str = harness::executable!();

/// \[s\] Watchdog timeout of the service manager.
const PATIENCE: f64 = 0.9;

/// The service manager's end of the line.
struct Manager(UnixDatagram);

impl Manager {
    /// Next line of output, within some seconds.
    fn hear(&self, seconds: f64) -> Option<String> {
        self.0.set_read_timeout(Some(Duration::from_secs_f64(seconds))).unwrap();
        let mut said = [0; 256];
        let len = self.0.recv(&mut said).ok()?;
        Some(String::from_utf8_lossy(&said[..len]).trim().to_owned())
    }

    /// How many heartbeats come in some seconds; none of them may come later than the manager bears.
    fn signs(&self, seconds: f64) -> usize {
        let until = clock::now() + (seconds * 1e9) as u64;
        let mut count = 0;
        while clock::now() < until {
            assert_eq!(self.hear(PATIENCE).as_deref(), Some("WATCHDOG=1"));
            count += 1;
        }
        count
    }
}

#[test]
fn a_service_manager_hears_ready_alive_and_stopping() {
    let _turn = shared_turn();
    let site = Site::patient(EXE);
    let manager = Manager(UnixDatagram::bind(site.path("notify")).unwrap());
    site.scene("wait", 100_000.0, "");
    let socket = format!("NOTIFY_SOCKET={}", site.path("notify").display());
    let patience = format!("WATCHDOG_USEC={}", (PATIENCE * 1e6) as u64);
    let arguments = site.run_arguments("wait", &["--lockstep", "--no-log"]);
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let run = site.start_under(&["env", &socket, &patience], &arguments);

    assert_eq!(manager.hear(20.0).as_deref(), Some("READY=1"), "everything has been started");
    assert!(manager.signs(3.0) >= 6);
    // A supervisor that hangs falls silent.
    run.signal_supervisor(Signal::STOP);
    doze(0.1);
    while manager.hear(0.01).is_some() {}
    assert_eq!(manager.hear(2.0 * PATIENCE), None);
    run.signal_supervisor(Signal::CONT);
    assert!(manager.signs(1.0) >= 1);

    run.signal_supervisor(Signal::TERM);
    let mut said = manager.hear(PATIENCE);
    while said.as_deref() == Some("WATCHDOG=1") {
        said = manager.hear(PATIENCE);
    }
    assert_eq!(said.as_deref(), Some("STOPPING=1"));
    assert_eq!(run.end().code, Some(130));
}

/// systemd's own opinion, where it is installed.
#[test]
fn systemd_takes_the_unit() {
    let text = std::fs::read_to_string(root().join("config/systemd/gangwerk@.service")).unwrap();
    let site = Site::new(EXE);
    let unit = site.path("gangwerk@stand.service");
    std::fs::write(&unit, text.replace("/usr/local/bin/gangwerk", EXE).replace("User=gangwerk", "User=root"))
        .unwrap();
    let Ok(said) = Command::new("systemd-analyze").args(["verify", "--man=no"]).arg(&unit).output() else {
        println!("not looked at: systemd-analyze is not installed");
        return;
    };
    let errors = String::from_utf8_lossy(&said.stderr);
    let ours: Vec<&str> = errors.lines().filter(|line| line.contains("gangwerk")).collect();
    assert!(ours.is_empty(), "{ours:?}");
}
