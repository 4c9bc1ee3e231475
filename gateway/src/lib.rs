//! Vision interface (thesis 6.2): `gangwerk gateway`, `docs/vision.md`.
//!
//! Two-way UDP beside a running robot. Out, at a rate: a trigger, with where the robot is and how it stands. In: velocities, points
//! to look at, boxes that lie in the way. A client of the broker and an observer of topics: no process of the robot knows of it.
//!
//! | module | what |
//! |---|---|
//! | `wire` | datagrams as bytes |
//! | `cause` | why one is refused |
//! | `owner` | which user of this machine it comes from |
//! | `gate` | whose, how old, in order, how many |
//! | `steering` | which commands are passed on, and when a stop holds |
//! | `link` | client of the broker: commands out, answers and lease back |
//! | `sight` | pose and odometry from sensors and stabilizer |
//! | `observer` | these of a running robot |
//! | `trigger` | what a vision system is told |

mod cause;
pub mod gate;
mod link;
mod observer;
pub mod owner;
pub mod sight;
mod steering;
pub mod trigger;
pub mod wire;

use std::error::Error;
use std::fmt::Write;
use std::io::{self, ErrorKind};
use std::net::{SocketAddr, UdpSocket};
use std::path::PathBuf;
use std::time::Duration;

use config::Setup;
use ipc::Run;
use messages::Command;
use realtime::Stop;
use realtime::clock::{SECOND, now};

pub use cause::Cause;
use gate::Gate;
use link::Link;
use observer::Observer;
use sight::Sight;
pub use steering::SILENCE;
use steering::{Passage, Steering};
use trigger::{Frames, Odometry, Trigger, flag};

/// Between two looks for a robot, and between two lines about refusals \[ns\].
const SEARCH: u64 = SECOND / 4;
const LINE: u64 = SECOND;
/// Longest wait for a datagram \[ns\].
const LOOK: u64 = SECOND / 200;
/// Datagrams that are taken before the next look at anything else.
const MOST: usize = 64;
/// Longest datagram that is read; none that is sound is as long.
const LONGEST: usize = 512;

/// Sink of lines for the operator.
pub type Say = fn(&str);

/// Options of the program.
#[derive(Clone, Debug)]
pub struct Options {
    /// Run directory.
    pub dir: PathBuf,
    /// Address for datagrams of the vision system.
    pub listen: SocketAddr,
    /// Address of the vision system, for triggers. Datagrams from other hosts are refused.
    pub to: SocketAddr,
    /// \[1/s\] Triggers.
    pub rate: f64,
}

/// Robot that runs.
struct Robot {
    supervisor: u32,
    observer: Observer,
    /// As the newest trigger told of it.
    sight: Option<Sight>,
    /// Outlives the link: a stop holds when the broker is started again.
    steering: Steering,
    /// None: the broker is not there.
    link: Option<Link>,
}

impl Robot {
    fn open(supervisor: u32, run: &Run) -> Result<Self, Box<dyn Error>> {
        let setup = Setup::load(&run.config, &run.scene)?;
        let observer = Observer::open(&run.dir, &setup)?;
        Ok(Self { supervisor, observer, sight: None, steering: Steering::default(), link: None })
    }
}

/// The gateway.
struct Gateway<'a> {
    options: &'a Options,
    socket: UdpSocket,
    /// Address of the socket.
    listen: SocketAddr,
    gate: Gate,
    robot: Option<Robot>,
    say: Say,
    /// Last line about the robot.
    said: String,
    /// Counts of refusals that were told.
    told: [u64; Cause::ALL.len()],
    /// Last line about triggers that cannot be sent.
    unsent: String,
    sequence: u64,
    next_search: u64,
    next_line: u64,
}

/// Serves the robot of a directory, and the next one after it, until `stop`; lines for the operator go to `say`.
///
/// # Errors
/// The address cannot be listened on.
pub fn run(options: &Options, stop: &Stop, say: Say) -> Result<(), String> {
    let listen = options.listen;
    let refused = |e| format!("cannot listen on {listen}: {e}; another address: --listen");
    let socket = UdpSocket::bind(listen).map_err(refused)?;
    let listen = socket.local_addr().map_err(refused)?;
    let mut gateway = Gateway {
        options,
        socket,
        listen,
        gate: Gate::default(),
        robot: None,
        say,
        said: String::new(),
        told: [0; _],
        unsent: String::new(),
        sequence: 0,
        next_search: 0,
        next_line: 0,
    };
    say(&format!("triggers to {}, {} per second; datagrams on {listen}", options.to, options.rate));
    let period = (1e9 / options.rate) as u64;
    let mut due = now();
    while !stop.asked() {
        gateway.wait(due);
        // Somebody's stop is heard before what has come after it.
        gateway.look();
        gateway.receive();
        if now() >= due {
            gateway.trigger();
            // Cycles that a busy machine missed are not caught up on.
            due = (due + period).max(now());
        }
    }
    Ok(())
}

impl Gateway<'_> {
    /// Waits for a datagram, but not beyond the next trigger, and leaves it where it is.
    fn wait(&self, due: u64) {
        let wait = Duration::from_nanos(due.saturating_sub(now()).clamp(1000, LOOK));
        if self.socket.set_nonblocking(false).is_ok() && self.socket.set_read_timeout(Some(wait)).is_ok() {
            let _ = self.socket.peek_from(&mut [0]);
        }
    }

    /// Takes datagrams that have come.
    fn receive(&mut self) {
        if self.socket.set_nonblocking(true).is_err() {
            return;
        }
        let mut bytes = [0; LONGEST];
        for _ in 0..MOST {
            match self.socket.recv_from(&mut bytes) {
                Ok((length, from)) => self.take(&bytes[..length], from),
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                Err(_) => return,
            }
        }
    }

    fn take(&mut self, bytes: &[u8], from: SocketAddr) {
        if from.ip() != self.options.to.ip() || !owner::is_trusted(from) {
            return self.gate.count(Cause::Sender);
        }
        if let Ok(command) = self.gate.admit(bytes, from, now()) {
            self.give(&command);
        }
    }

    /// Passes a command on to the robot, if there is one.
    fn give(&mut self, command: &Command) {
        let given = self.robot.as_mut().and_then(|Robot { link, steering, sight, .. }| {
            let command = sight.map_or(*command, |sight| sight.command(command));
            link.as_mut().map(|link| link.give(steering, &command, now()))
        });
        match given {
            None => self.gate.count(Cause::Robot),
            // Counted when it is answered.
            Some(Ok(Passage::Send)) => {}
            Some(Ok(Passage::Needless)) => self.gate.accepted += 1,
            Some(Ok(Passage::Held)) => self.gate.count(Cause::Held),
            Some(Err(why)) => {
                self.gate.count(Cause::Robot);
                self.lose(&why);
            }
        }
    }

    /// One look: at the robot, at the broker, and what there is to say.
    fn look(&mut self) {
        if now() >= self.next_search {
            self.search();
            self.next_search = now() + SEARCH;
        }
        if let Some(Robot { link: Some(link), steering, .. }) = &mut self.robot {
            let say = self.say;
            if let Err(why) = link.look(steering, &mut self.gate, now(), &mut |line| say(&line)) {
                self.lose(&why);
            }
        }
        if now() >= self.next_line && self.told != self.gate.refused {
            self.tell_refusals();
            self.next_line = now() + LINE;
        }
    }

    /// Looks whether the robot is still there, or a new one, and its broker.
    fn search(&mut self) {
        let dir = &self.options.dir;
        let supervisor = ipc::supervisor(dir);
        if self.robot.as_ref().is_some_and(|robot| supervisor != Some(robot.supervisor)) {
            // Its ports go before the next run makes others in their place.
            self.give_up_answers();
            self.robot = None;
        }
        let line = match &mut self.robot {
            Some(Robot { link: Some(_), .. }) => return,
            Some(Robot { link, .. }) => match Link::connect(dir) {
                Ok(new) => {
                    *link = Some(new);
                    format!("robot in {}: connected", dir.display())
                }
                Err(why) => format!("the robot in {} does not answer: {why}", dir.display()),
            },
            None => match ipc::find_robot(dir, Robot::open) {
                Ok(robot) => {
                    self.robot = Some(robot);
                    return self.search();
                }
                Err(why) => why.to_string(),
            },
        };
        if self.said != line {
            (self.say)(&line);
            self.said = line;
        }
    }

    /// The connection to the broker is over; with it went the lease.
    fn lose(&mut self, why: &str) {
        let say = self.say;
        say(why);
        self.give_up_answers();
        if let Some(robot) = &mut self.robot {
            robot.link = None;
            robot.steering.disconnected(&mut |line| say(&line));
        }
        self.said.clear();
    }

    /// What was not answered is counted as refused by the robot: nobody answers it any more.
    fn give_up_answers(&mut self) {
        let unanswered = self.robot.as_ref().map_or(0, |robot| robot.steering.unanswered());
        (0..unanswered).for_each(|_| self.gate.count(Cause::Robot));
    }

    /// Refusals since the last time, by cause.
    fn tell_refusals(&mut self) {
        let mut line = "refused:".to_owned();
        let news = Cause::ALL.iter().zip(self.gate.refused).zip(self.told);
        for ((cause, now), before) in news.filter(|((_, now), before)| now > before) {
            let _ = write!(line, " {} {}", now - before, cause.name());
        }
        (self.say)(&line);
        self.told = self.gate.refused;
    }

    /// Sends a trigger. One that is lost on the way is as one of a camera: the next one comes.
    fn trigger(&mut self) {
        self.sequence += 1;
        let stamp = now();
        let steering = self.robot.as_ref().map(|robot| &robot.steering);
        let lease = if steering.is_some_and(Steering::has_lease) { flag::LEASE } else { 0 };
        let held = if steering.is_some_and(Steering::is_held) { flag::HELD } else { 0 };
        // What is answered is meant as it was seen now.
        let sight = self.robot.as_mut().and_then(|robot| {
            robot.sight = robot.observer.look();
            robot.sight
        });
        let robot = if sight.is_some() { flag::ROBOT } else { 0 };
        let trigger = Trigger {
            sender: std::process::id().into(),
            sequence: self.sequence,
            stamp,
            cycle: sight.map_or(0, |s| s.cycle),
            flags: robot | lease | held,
            gait: sight.map_or(0, |s| s.gait),
            odometry: sight.map_or(Odometry::UNKNOWN, |s| s.odometry),
            frames: sight.map_or(Frames::UNKNOWN, |s| s.frames),
            accepted: self.gate.accepted,
            refused: self.gate.refused,
        };
        self.gate.triggered(stamp);
        if let Err(e) = self.socket.send_to(&trigger.encode(), self.options.to)
            && e.kind() != ErrorKind::WouldBlock
        {
            self.tell_unsent(&e);
        }
    }

    /// A trigger that cannot even be sent has a reason that lasts, mostly an address; each is said once.
    fn tell_unsent(&mut self, why: &io::Error) {
        let to = self.options.to;
        let port = self.listen.port();
        let any = if to.is_ipv4() { format!("0.0.0.0:{port}") } else { format!("[::]:{port}") };
        let line = format!(
            "triggers cannot be sent from {} to {to}: {why}; --listen must be an address with a way there, such as {any}",
            self.listen
        );
        if self.unsent != line {
            (self.say)(&line);
            self.unsent = line;
        }
    }
}
