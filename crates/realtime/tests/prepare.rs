//! What is granted is what the kernel says afterwards.

use realtime::{Stop, ThreadSchedule, prepare_thread};

fn status(key: &str) -> String {
    let text = std::fs::read_to_string("/proc/thread-self/status").unwrap();
    text.lines().find_map(|l| l.strip_prefix(key)).unwrap().trim().to_string()
}

#[test]
fn grants_are_true_or_named() {
    let granted = prepare_thread(&ThreadSchedule { priority: 10, core: Some(0) });
    let locked: u64 = status("VmLck:").split_whitespace().next().unwrap().parse().unwrap();
    assert_eq!(granted.locked, locked > 0);
    // policy is field 41 of stat, priority field 40 (proc(5)), counted after the parenthesis of field 2.
    let stat = std::fs::read_to_string("/proc/thread-self/stat").unwrap();
    let fields: Vec<&str> = stat.rsplit_once(')').unwrap().1.split_whitespace().collect();
    let (priority, policy): (u8, u8) = (fields[37].parse().unwrap(), fields[38].parse().unwrap());
    assert_eq!(granted.priority, if policy == 1 { priority } else { 0 });
    assert_eq!(granted.core.is_some(), status("Cpus_allowed_list:") == "0");
    let all = granted.locked && granted.awake && granted.priority == 10 && granted.core == Some(0);
    assert_eq!(granted.degraded(), !all, "{:?}", granted.missing);
}

#[test]
fn what_cannot_be_granted_is_named() {
    let granted = prepare_thread(&ThreadSchedule { priority: 0, core: Some(1000) });
    assert_eq!(granted.core, None);
    assert!(granted.missing[0].contains("core 1000"), "{:?}", granted.missing);
}

#[test]
fn ordinary_asks_for_nothing() {
    let granted = prepare_thread(&ThreadSchedule::ORDINARY);
    assert!(!granted.degraded() && !granted.locked && granted.priority == 0);
}

#[test]
fn a_signal_asks_to_stop_and_interrupts_nobody() {
    let stop = Stop::on_signals().unwrap();
    // This thread and all later ones block SIGINT (2), SIGUSR1 (10), SIGTERM (15), and SIGHUP (1) unless nohup ignores it.
    let [blocked, ignored] = ["SigBlk:", "SigIgn:"].map(|set| u64::from_str_radix(&status(set), 16).unwrap());
    for (signal, expected) in [(1, !ignored & 1), (2, 1), (10, 1), (15, 1)] {
        assert_eq!(blocked >> (signal - 1) & 1, expected, "signal {signal}");
    }
    let child = std::thread::spawn(|| status("SigBlk:")).join().unwrap();
    assert_eq!(u64::from_str_radix(&child, 16).unwrap() & blocked, blocked);
    assert!(!stop.asked());
    stop.clone().ask();
    assert!(stop.asked());
}

#[test]
fn preflight_looks_at_everything() {
    let checks = realtime::preflight();
    assert!(checks.len() >= 8);
    for check in &checks {
        assert!(!check.found.is_empty(), "{}", check.what);
        assert_eq!(check.advice.is_empty(), check.grade == realtime::Grade::Good, "{}", check.what);
    }
}
