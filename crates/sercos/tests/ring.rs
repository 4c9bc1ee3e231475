//! Nine slaves in a ring of two veth pairs between two network namespaces, 1 kHz: start, cables pulled and plugged, and
//! what is wrong with an interface. Needs root; elsewhere left out and said so, but a failure where CI is true.

mod veth;

use realtime::clock;
use sercos::{Near, RingEvent, SocketError, Stage};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use veth::{ADDRESSES, CYCLE, DATA, FAR, LOSSES, NEAR, Veth, setup};

/// Timeout of a telegram \[ns\]: the host sometimes stops everybody.
const PATIENCE: u64 = 100_000_000;

/// Namespaces, unless this machine has none.
fn namespaces(tag: &str) -> Option<Veth> {
    if let Some(reason) = veth::lacks() {
        assert_ne!(std::env::var("CI").as_deref(), Ok("true"), "left out: {reason}");
        println!("left out: {reason}");
        return None;
    }
    Some(Veth::new(tag).unwrap())
}

/// Cycles of 1 ms; the longest run without data from a station.
struct Loop {
    near: Near,
    next: u64,
    number: u8,
    runs: [u32; ADDRESSES.len()],
    events: Vec<RingEvent>,
}

impl Loop {
    fn cycles(&mut self, count: u32) -> u32 {
        let mut longest = 0;
        for _ in 0..count {
            self.number = self.number.wrapping_add(1);
            for i in 0..ADDRESSES.len() {
                self.near.master_mut().set_command(i, &[self.number; DATA]);
            }
            let stage = self.cycle();
            assert_eq!(stage, Stage::Running);
            for (i, run) in self.runs.iter_mut().enumerate() {
                match self.near.master().feedback(i) {
                    Some(data) => {
                        assert_eq!(data, [self.number.wrapping_add(1); DATA], "of this cycle");
                        *run = 0;
                    }
                    None => *run += 1,
                }
                longest = longest.max(*run);
            }
        }
        longest
    }

    fn cycle(&mut self) -> Stage {
        self.next = (self.next + CYCLE).max(clock::now());
        clock::sleep_until(self.next);
        self.near.send();
        let stage = self.near.receive_all(PATIENCE);
        while let Some(event) = self.near.master_mut().take_event() {
            self.events.push(event);
        }
        stage
    }
}

#[test]
fn a_ring_between_namespaces_breaks_and_is_closed_again() {
    let Some(veth) = namespaces("ring") else { return };
    let stop = Arc::new(AtomicBool::new(false));
    let slaves = veth.slaves(&stop, || {});
    let mut ring = Loop {
        near: veth.master(true),
        next: clock::now(),
        number: 0,
        runs: [0; ADDRESSES.len()],
        events: Vec::new(),
    };
    while !matches!(ring.cycle(), Stage::Running) {
        assert!(!matches!(ring.near.master().stage(), Stage::Failed(_)), "{:?}", ring.near.master().stage());
    }
    assert!(!ring.events.iter().any(|e| !matches!(e, RingEvent::Phase(_))), "{:?}", ring.events);
    ring.cycles(5); // slaves have data of their own from the first answer on
    let (first, last) = (ADDRESSES[0], ADDRESSES[ADDRESSES.len() - 1]);
    // Pulled at the slaves' side, and at the master's, where the slaves learn of it by silence only.
    let right = (Some(last), None);
    for (link, ends) in [(FAR[1], right), (FAR[0], (None, Some(first))), (NEAR[1], right)] {
        ring.events.clear();
        assert_eq!(ring.cycles(300), 0, "a closed ring loses nothing");
        assert_eq!(ring.events, []);

        veth.set(link, "down");
        let lost = ring.cycles(200);
        assert!(lost <= LOSSES.into(), "{link} pulled: {lost} cycles lost, {LOSSES} permitted");
        assert_eq!(ring.events, [RingEvent::RingBroken(ends.0, ends.1)], "{link}");

        ring.events.clear();
        veth.set(link, "up");
        let lost = ring.cycles(1500); // Linux takes up to a second to see the link
        assert!(lost <= LOSSES.into(), "{link} plugged: {lost} cycles lost, {LOSSES} permitted");
        assert_eq!(ring.events, [RingEvent::RingClosed], "{link}");
        assert!(!ring.near.master().is_broken());
    }
    let counts = ring.near.master().counts();
    stop.store(true, Ordering::Relaxed);
    slaves.thread.join().unwrap();
    let seen = [slaves.foreign, slaves.malformed].map(|count| count.load(Ordering::Relaxed));
    assert_eq!((counts.malformed, counts.foreign, seen), (0, 0, [0, 0]));
}

#[test]
fn each_thing_wrong_with_an_interface_has_its_message() {
    let Some(veth) = namespaces("errors") else { return };
    drop(veth.master(false));
    let opened =
        |first: &str| Near::open(first, None, setup()).err().map_or(String::new(), |e| e.to_string());
    assert_eq!(opened(NEAR[0]), "", "this one is all right");
    assert!(
        opened("nobody0").contains("there is no interface nobody0; see `ip link`"),
        "{}",
        opened("nobody0")
    );
    assert!(opened("").contains("is no name of an interface"));
    assert!(opened("a_name_that_is_far_too_long").contains("1 to 15 bytes"));
    assert!(opened("lo").contains("the interface lo is switched off; ip link set lo up"), "{}", opened("lo"));
    let up = Command::new("ip").args(["-n", veth.near(), "link", "set", "lo", "up"]).status();
    assert!(up.unwrap().success());
    assert!(opened("lo").contains("lo is no Ethernet interface"), "{}", opened("lo"));
}

/// This test starts itself again without the capability.
#[test]
fn no_permission_has_its_message() {
    const CHILD: &str = "SERCOS_TEST_WITHOUT_CAPABILITY";
    if std::env::var_os(CHILD).is_some() {
        let error = sercos::Socket::open("lo").err().expect("a socket without permission");
        assert!(matches!(error, SocketError::Permission(_)), "{error}");
        assert!(error.to_string().contains("setcap cap_net_raw+ep"), "{error}");
        return;
    }
    if !rustix::process::geteuid().is_root() {
        let error = sercos::Socket::open("lo").err().expect("a socket without permission");
        assert!(matches!(error, SocketError::Permission(_)), "{error}");
        return;
    }
    let own = std::env::current_exe().unwrap();
    let output = Command::new("setpriv")
        .args(["--bounding-set", "-net_raw", "--"])
        .arg(own)
        .args(["--exact", "no_permission_has_its_message"])
        .env(CHILD, "1")
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}
