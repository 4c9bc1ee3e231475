//! A run directory with a broker process in it. The processes are this test program, started again in another role.

#![allow(dead_code, reason = "each test file uses its part")]

use std::net::{Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::Duration;

use broker::daemon::Tcp;
use broker::stream_client::News;
use broker::{Client, StreamClient};
use ipc::{Run, Space};
use messages::command::Domain;
use messages::{Command, Process};
use realtime::clock::now;
use rustix::process::{Pid, Signal, kill_process};

const ROLE: &str = "GANGWERK_TEST_ROLE";
const DIR: &str = "GANGWERK_TEST_DIR";

/// Ended and removed at the end of the test.
pub(crate) struct System {
    run: Run,
    broker: Option<Killed>,
    pub(crate) space: Space,
    _dir: RemoveDir,
}

struct RemoveDir(PathBuf);

/// A process that does not outlive its test.
pub(crate) struct Killed(pub(crate) Child);

impl Drop for Killed {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Drop for RemoveDir {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

impl System {
    pub(crate) fn start(name: &str) -> Self {
        let mut system = Self::without_broker(name);
        system.start_broker();
        system
    }

    pub(crate) fn without_broker(name: &str) -> Self {
        let dir = std::env::temp_dir().join(format!("gangwerk-broker-{}-{name}", std::process::id()));
        let _ = std::fs::remove_dir_all(&dir);
        let space = Space::create(&dir).expect("space");
        let run = Run::bare(&dir);
        run.save().expect("run");
        Self { run, broker: None, space, _dir: RemoveDir(dir) }
    }

    /// Starts the broker and waits until it answers.
    pub(crate) fn start_broker(&mut self) {
        self.broker = Some(self.spawn("broker"));
        wait_for("the broker", || {
            StreamClient::connect(self.dir(), "start").is_ok_and(|mut c| c.statistics().is_ok())
        });
    }

    pub(crate) fn signal_broker(&mut self, signal: Signal) {
        let Killed(broker) = self.broker.as_mut().expect("it was started");
        kill_process(Pid::from_child(broker), signal).expect("signal");
    }

    /// SIGKILL. The supervisor's `clear_dead` belongs before the next start.
    pub(crate) fn kill_broker(&mut self) {
        drop(self.broker.take());
    }

    /// This program in another role.
    pub(crate) fn spawn(&self, role: &str) -> Killed {
        let child = std::process::Command::new(std::env::current_exe().expect("own path"))
            .args(["--exact", "process", "--nocapture"])
            .env(ROLE, role)
            .env(DIR, &self.run.dir)
            .stdout(Stdio::null())
            .spawn()
            .expect("process");
        Killed(child)
    }

    /// A client of this process, once the broker knows it.
    pub(crate) fn client(&self, name: &str, domains: &[Domain]) -> Client {
        let client = Client::start(name, domains, &self.space).expect("client");
        wait_for("the registration", || client.statistics().connected);
        client
    }

    pub(crate) fn dir(&self) -> &Path {
        &self.run.dir
    }

    /// A client on the socket.
    pub(crate) fn stream(&self) -> StreamClient {
        StreamClient::connect(self.dir(), "test").expect("connection")
    }

    /// Address on which TCP is served.
    pub(crate) fn tcp(&self) -> SocketAddr {
        let text = std::fs::read_to_string(self.dir().join(broker::doors::TCP_FILE)).expect("address");
        text.trim().parse().expect("address")
    }

    /// The broker's line about a client, if it knows it.
    pub(crate) fn line_about(&self, name: &str) -> Option<String> {
        self.stream().statistics().expect("statistics").into_iter().find(|line| line.starts_with(name))
    }
}

/// Reading of a client that only tests need.
pub(crate) trait Receive {
    /// The next command of the domains subscribed to; other news are passed over.
    fn receive(&mut self, timeout: Duration) -> Result<Option<Command>, String>;
}

impl Receive for StreamClient {
    fn receive(&mut self, timeout: Duration) -> Result<Option<Command>, String> {
        let until = now() + timeout.as_nanos() as u64;
        loop {
            let left = Duration::from_nanos(until.saturating_sub(now()));
            match self.news(left.max(Duration::from_millis(1)))? {
                Some(News::Command(command)) => return Ok(Some(command)),
                Some(_) => {}
                None => return Ok(None),
            }
        }
    }
}

pub(crate) fn pause(ms: u64) {
    std::thread::park_timeout(Duration::from_millis(ms));
}

/// Looks every 2 ms, for 20 s at most: a bound for a hanging test, not a measurement.
pub(crate) fn wait_for(what: &str, mut come: impl FnMut() -> bool) {
    for _ in 0..10_000 {
        if come() {
            return;
        }
        pause(2);
    }
    panic!("{what} did not come");
}

/// Body of a started process; does nothing in the test run itself.
pub(crate) fn play_role(other: impl Fn(&str, &Space)) {
    let Ok(role) = std::env::var(ROLE) else { return };
    let var = |name| std::env::var(name).expect("set by the test");
    let run = Run::load(var(DIR).as_ref()).expect("run");
    if role.starts_with("broker") {
        let keys = run.dir.join("keys");
        let tcp = Tcp { address: Some((Ipv4Addr::LOCALHOST, 0).into()), keys: keys.exists().then_some(keys) };
        let stop = realtime::Stop::default();
        if role == "broker that ends" {
            let stop = stop.clone();
            std::thread::spawn(move || {
                pause(100);
                stop.ask();
            });
        }
        if let Err(reason) = broker::daemon::serve(&run, &tcp, &stop) {
            eprintln!("{reason}");
            std::process::exit(2);
        }
        return;
    }
    other(&role, &run.enter(Process::Observer).expect("space"));
}
