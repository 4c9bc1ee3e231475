//! Link to the broker: commands of the vision system out, answers and the command lease back.
//!
//! A walk lasts as long as velocities come in: after half a second without a valid one the lease is given back, and she comes
//! to a stand. With this program dead or hung the lease runs out or goes with the connection, and she does the same.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use broker::StreamClient;
use broker::stream_client::{Answer, News};
use messages::Command;
use messages::command::Domain;
use realtime::clock::SECOND;

/// Name at the broker.
const NAME: &str = "gangwerk gateway";
/// Silence of the vision system after which she comes to a stand \[ns\].
pub const SILENCE: u64 = SECOND / 2;
/// Between two signs of life while she walks, and while she does not: those keep the connection open \[ns\].
const PING: u64 = SECOND / 10;
const IDLE: u64 = 20 * SECOND;
/// Time that the broker has for an answer \[ns\].
const PATIENCE: u64 = 3 * SECOND;
/// Answers of the protocol to a velocity after which it is not for the vision system to go on by itself: somebody else holds
/// the lease, she does not stand, not in this state, fallen or stopped.
const NOT_YOURS: [u8; 4] = [9, 31, 32, 33];

/// Connection to the broker of a robot.
pub(crate) struct Link {
    client: StreamClient,
    /// True if the broker has said that this program holds the lease.
    mine: bool,
    /// Time of the last velocity that moves her \[ns\]; none: she need not walk.
    walks: Option<u64>,
    /// Why no velocity is passed on until one of zero comes.
    held: Option<String>,
    /// Number of a frame, name of its command, and when its answer is given up \[ns\].
    awaited: BTreeMap<u64, (&'static str, u64)>,
    next_ping: u64,
}

impl Link {
    /// Connects to the broker of the robot in this run directory.
    ///
    /// # Errors
    /// It does not answer.
    pub(crate) fn connect(dir: &Path) -> Result<Self, String> {
        let mut client = StreamClient::connect(dir, NAME)?;
        client.subscribe(&[Domain::Walk, Domain::System])?;
        let awaited = BTreeMap::new();
        Ok(Self { client, mine: false, walks: None, held: None, awaited, next_ping: 0 })
    }

    /// True: velocities move her.
    pub(crate) const fn has_lease(&self) -> bool {
        self.mine
    }

    /// True: a velocity of zero has to come first.
    pub(crate) const fn is_held(&self) -> bool {
        self.held.is_some()
    }

    /// Passes a command on; false: she was stopped or taken over by somebody else, and it is none that ends that.
    ///
    /// # Errors
    /// The connection is lost.
    pub(crate) fn give(&mut self, command: &Command, now: u64) -> Result<bool, String> {
        if let Command::Velocity(_) = command {
            if command.is_unbounded() {
                if self.held.is_some() {
                    return Ok(false);
                }
                self.walks = Some(now);
            } else {
                self.held = None;
                self.walks = None;
                // A stop of one's own walk; that of somebody else is not ended from here.
                if !self.mine {
                    return Ok(true);
                }
            }
        }
        let sequence = self.client.send(command)?;
        self.awaited.insert(sequence, (command.name(), now + PATIENCE));
        Ok(true)
    }

    /// One look: what the broker says, silence of the vision system, signs of life. Refusals of the robot, in words.
    ///
    /// # Errors
    /// The connection is lost.
    pub(crate) fn look(&mut self, now: u64, say: &mut dyn FnMut(String)) -> Result<u64, String> {
        let mut refused = 0;
        // A millisecond, in which this client says nothing by itself.
        while let Some(news) = self.client.news(Duration::from_millis(1))? {
            match news {
                News::Answer(answer) if answer.sequence == 0 => return Err(answer.text),
                News::Answer(answer) => refused += u64::from(self.answered(answer, say)),
                News::Command(by @ (Command::Stop | Command::End | Command::EmergencyStop)) => {
                    self.hold(format!("stopped by somebody else ({})", by.name()), say);
                }
                News::Lease(_, holder) => self.held_by(&holder, say),
                _ => {}
            }
        }
        if self.walks.is_some_and(|last| now.saturating_sub(last) > SILENCE) {
            self.walks = None;
            // Without the lease she stops for want of it; a stop could be that of somebody else's walk.
            self.client.give_lease()?;
            say("no velocity for half a second: she comes to a stand".into());
        }
        let pause = if self.walks.is_some() { PING } else { IDLE };
        self.next_ping = self.next_ping.min(now + pause);
        if now >= self.next_ping {
            self.client.ping()?;
            self.next_ping = now + pause;
        }
        match self.awaited.values().any(|(_, until)| now > *until) {
            true => Err("the broker does not answer; it may have to be started again".into()),
            false => Ok(refused),
        }
    }

    /// Takes an answer; true: it is a refusal.
    fn answered(&mut self, answer: Answer, say: &mut dyn FnMut(String)) -> bool {
        let Some((name, _)) = self.awaited.remove(&answer.sequence) else { return false };
        let code = answer.code;
        let Err(why) = answer.accepted() else { return false };
        if name == "walk/velocity" && NOT_YOURS.contains(&code) {
            self.hold(format!("{name} refused: {why}"), say);
        } else {
            say(format!("{name} refused: {why}"));
        }
        true
    }

    /// The command lease has changed hands.
    fn held_by(&mut self, holder: &str, say: &mut dyn FnMut(String)) {
        self.mine = holder.contains(NAME) && holder.contains(&format!("pid {})", std::process::id()));
        if !self.mine && !holder.is_empty() && self.walks.is_some() {
            self.hold(format!("{holder} steers"), say);
        }
    }

    /// From now on the vision system does not steer, until it has shown that it knows.
    fn hold(&mut self, why: String, say: &mut dyn FnMut(String)) {
        self.walks = None;
        if self.held.as_ref() != Some(&why) {
            say(format!("{why}: velocities are refused until one of zero comes"));
        }
        self.held = Some(why);
    }
}
