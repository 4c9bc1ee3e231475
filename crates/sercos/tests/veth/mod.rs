//! Two network namespaces, joined by two veth pairs: the master's side and the slaves' side of a ring.

use realtime::clock;
use rustix::thread::{LinkNameSpaceType, move_into_link_name_space};
use sercos::{Far, MasterSetup, Near, Slave, Station};
use std::fs::File;
use std::os::fd::AsFd;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::JoinHandle;

/// Names of the interfaces on the master's side, port 1 and port 2, and on the slaves' side.
pub(crate) const NEAR: [&str; 2] = ["near1", "near2"];
pub(crate) const FAR: [&str; 2] = ["far1", "far2"];
/// Cycle time \[ns\].
pub(crate) const CYCLE: u64 = 1_000_000;
/// Cycles in a row in which data may be lost.
pub(crate) const LOSSES: u16 = 3;
/// Data each way: as many as Lola's longest local controller has \[B\].
pub(crate) const DATA: usize = 128;
/// Addresses of the slaves: one for each local controller of Lola.
pub(crate) const ADDRESSES: [u16; 9] = [11, 12, 13, 21, 22, 23, 31, 32, 40];

/// Both namespaces; they end with this.
pub(crate) struct Veth {
    near: String,
    far: String,
}

impl Veth {
    /// Makes both, with everything switched on.
    pub(crate) fn new(tag: &str) -> Result<Self, String> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let own = COUNT.fetch_add(1, Ordering::Relaxed); // tests run at the same time
        let name = |side| format!("gangwerk-{tag}-{}-{own}-{side}", std::process::id());
        let veth = Self { near: name("near"), far: name("far") };
        ip(&["netns", "add", &veth.near])?;
        ip(&["netns", "add", &veth.far])?;
        for (near, far) in NEAR.into_iter().zip(FAR) {
            let peer = ["type", "veth", "peer", "name", far, "netns", &veth.far];
            ip(&[&["-n", &veth.near, "link", "add", near][..], &peer].concat())?;
            for (namespace, link) in [(&veth.near, near), (&veth.far, far)] {
                ip(&["-n", namespace, "link", "set", link, "addrgenmode", "none"])?; // no IPv6 in between
                ip(&["-n", namespace, "link", "set", link, "up"])?;
            }
        }
        let linked = |(namespace, link): (&String, &&str)| {
            let said = Command::new("ip").args(["-n", namespace, "-br", "link", "show", link]).output();
            said.is_ok_and(|o| String::from_utf8_lossy(&o.stdout).contains(" UP "))
        };
        let ends = || NEAR.iter().map(|l| (&veth.near, l)).chain(FAR.iter().map(|l| (&veth.far, l)));
        for _ in 0..300 {
            if ends().all(linked) {
                return Ok(veth);
            }
            clock::sleep_until(clock::now() + 10_000_000); // Linux takes up to a second to see a link
        }
        Err("the links did not come up within 3 s".into())
    }

    /// Switches an interface of either side on or off: as a cable that is pulled.
    pub(crate) fn set(&self, link: &str, state: &str) {
        let namespace = if FAR.contains(&link) { &self.far } else { &self.near };
        ip(&["-n", namespace, "link", "set", link, state]).unwrap();
    }

    /// Name of the master's namespace.
    pub(crate) fn near(&self) -> &str {
        &self.near
    }

    /// A master in its namespace; the calling thread stays there.
    pub(crate) fn master(&self, ring: bool) -> Near {
        enter(&self.near);
        Near::open(NEAR[0], ring.then_some(NEAR[1]), setup()).unwrap_or_else(|e| panic!("{e}"))
    }

    /// Slaves in their namespace, in a thread of their own that ends with `stop`. They answer with what they were told,
    /// each byte one more. With `prepare`, the thread is prepared before it begins.
    pub(crate) fn slaves(&self, stop: &Arc<AtomicBool>, prepare: impl FnOnce() + Send + 'static) -> Slaves {
        let (namespace, stop) = (self.far.clone(), Arc::clone(stop));
        let (foreign, malformed) = (Arc::new(AtomicU64::new(0)), Arc::new(AtomicU64::new(0)));
        let counts = (Arc::clone(&foreign), Arc::clone(&malformed));
        let (ready, is_ready) = std::sync::mpsc::channel();
        let thread = std::thread::spawn(move || {
            enter(&namespace);
            let slaves = ADDRESSES.iter().map(|a| Slave::new(*a, DATA, DATA)).collect();
            let mut far = Far::open(FAR[0], Some(FAR[1]), slaves, true).unwrap_or_else(|e| panic!("{e}"));
            ready.send(()).unwrap();
            prepare();
            while !stop.load(Ordering::Relaxed) {
                if !far.wait(CYCLE) {
                    far.chain_mut().silence();
                }
                answer(&mut far);
            }
            let sum = |of: fn(sercos::SlaveCounts) -> u64| {
                far.chain().slaves().iter().map(|s| of(s.counts())).sum()
            };
            counts.0.store(sum(|c| c.foreign), Ordering::Relaxed);
            counts.1.store(sum(|c| c.malformed), Ordering::Relaxed);
        });
        is_ready.recv().expect("the slaves did not start");
        Slaves { thread, foreign, malformed }
    }
}

/// The slaves' thread and what they counted, once it has ended.
pub(crate) struct Slaves {
    pub(crate) thread: JoinHandle<()>,
    pub(crate) foreign: Arc<AtomicU64>,
    pub(crate) malformed: Arc<AtomicU64>,
}

fn answer(far: &mut Far) {
    let mut data = [0; DATA];
    for slave in far.chain_mut().slaves_mut() {
        if let Some(command) = slave.take_command() {
            for (place, byte) in data.iter_mut().zip(command) {
                *place = byte.wrapping_add(1);
            }
            slave.set_feedback(&data);
        }
    }
    far.answer();
}

pub(crate) fn setup() -> MasterSetup {
    let station = |address: &u16| Station { address: *address, command: DATA, feedback: DATA };
    MasterSetup {
        cycle: CYCLE as u32,
        losses: LOSSES,
        // The host may stop everybody for a while: that is no loss.
        beat_losses: 1000,
        stations: ADDRESSES.iter().map(station).collect(),
        ports: [None; 2],
    }
}

impl Drop for Veth {
    fn drop(&mut self) {
        for namespace in [&self.near, &self.far] {
            drop(ip(&["netns", "del", namespace]));
        }
    }
}

/// Moves the calling thread into a namespace.
fn enter(namespace: &str) {
    let file = File::open(format!("/run/netns/{namespace}")).unwrap();
    move_into_link_name_space(file.as_fd(), Some(LinkNameSpaceType::Network)).unwrap();
}

fn ip(arguments: &[&str]) -> Result<(), String> {
    let output = Command::new("ip").args(arguments).output().map_err(|e| format!("ip: {e}"))?;
    if output.status.success() {
        return Ok(());
    }
    Err(format!("ip {}: {}", arguments.join(" "), String::from_utf8_lossy(&output.stderr).trim()))
}

/// Why namespaces cannot be used here; none if they can.
pub(crate) fn lacks() -> Option<String> {
    if !rustix::process::geteuid().is_root() {
        return Some("not root: network namespaces cannot be made".into());
    }
    Veth::new("probe").err()
}
