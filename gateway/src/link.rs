//! Link to the broker: commands of the vision system out, answers and the command lease back.
//!
//! A walk lasts as long as velocities come in: after half a second without a valid one the lease is given back, and she comes
//! to a stand. With this program dead or hung the lease runs out or goes with the connection, and she does the same. When
//! somebody else stops her, this stops her once more, behind its own velocities, and gives the lease back.

use std::path::Path;
use std::time::Duration;

use broker::StreamClient;
use broker::stream_client::{IDLE, News};
use messages::Command;
use messages::command::Domain;
use realtime::clock::SECOND;

use crate::Cause;
use crate::gate::Gate;
use crate::steering::{NAME, Parting, Passage, Steering};

/// Longest silence towards the broker while she walks \[ns\]: the lease lasts for 500 ms.
const PING: u64 = SECOND / 10;

/// Connection to the broker of a robot.
pub(crate) struct Link {
    client: StreamClient,
}

impl Link {
    /// Connects to the broker of the robot in this run directory.
    ///
    /// # Errors
    /// It does not answer.
    pub(crate) fn connect(dir: &Path) -> Result<Self, String> {
        let mut client = StreamClient::connect(dir, NAME)?;
        client.subscribe(&[Domain::Walk, Domain::System])?;
        Ok(Self { client })
    }

    /// Passes a command on, if it is to.
    ///
    /// # Errors
    /// The connection is lost.
    pub(crate) fn give(
        &mut self,
        steering: &mut Steering,
        command: &Command,
        now: u64,
    ) -> Result<Passage, String> {
        let passage = steering.admit(command, now);
        if passage == Passage::Send {
            let sequence = self.client.send(command)?;
            steering.sent(sequence, command, now);
        }
        Ok(passage)
    }

    /// One look: what the broker says, which the gate counts, silence of the vision system, heartbeats.
    ///
    /// # Errors
    /// The connection is lost.
    pub(crate) fn look(
        &mut self,
        steering: &mut Steering,
        gate: &mut Gate,
        now: u64,
        say: &mut dyn FnMut(String),
    ) -> Result<(), String> {
        // A millisecond, in which this client says nothing by itself.
        while let Some(news) = self.client.news(Duration::from_millis(1))? {
            match news {
                News::Answer(answer) => match steering.answered(answer, now, say) {
                    Some(true) => gate.accepted += 1,
                    Some(false) => gate.count(Cause::Robot),
                    None => {}
                },
                News::Command(by @ (Command::Stop | Command::End | Command::EmergencyStop)) => {
                    steering.stopped(&by, now, say);
                }
                News::Lease(_, holder) => steering.held_by(&holder, say),
                _ => {}
            }
        }
        match steering.part() {
            Some(Parting::Stop) => {
                let sequence = self.client.send(&Command::Stop)?;
                steering.sent(sequence, &Command::Stop, now);
            }
            Some(Parting::Lease) => {
                self.client.give_lease()?;
            }
            None => {}
        }
        if steering.falls_silent(now) {
            // Without the lease she stops for want of it; a stop could be that of somebody else's walk.
            self.client.give_lease()?;
            say("no velocity for half a second: she comes to a stand".into());
        }
        self.client.keep_alive(if steering.walks() { PING } else { IDLE })?;
        steering.check_answers(now)
    }
}
