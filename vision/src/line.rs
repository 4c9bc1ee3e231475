//! Datagrams of a vision system: a trigger in, numbered answers out (`docs/vision.md`).

use gateway::trigger::Trigger;
use gateway::wire::Datagram;
use messages::Command;
use messages::command::VelocityCommand;

use crate::pilot::Answer;

/// Sender of answers.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    sender: u64,
    sequence: u64,
}

impl Line {
    /// Of a program with this number.
    pub const fn new(sender: u64) -> Self {
        Self { sender, sequence: 0 }
    }

    /// The datagram that stops her.
    pub fn stop(&mut self, trigger: &Trigger) -> Vec<u8> {
        let velocity = VelocityCommand { forward: 0.0, left: 0.0, turn: 0.0 };
        self.datagrams(trigger, &Answer { velocity, look: None }).pop().unwrap_or_default()
    }

    /// The datagrams of an answer to `trigger`: where to go, and where to look.
    pub fn datagrams(&mut self, trigger: &Trigger, answer: &Answer) -> Vec<Vec<u8>> {
        let commands = [answer.look.map(Command::Fixate), Some(Command::Velocity(answer.velocity))];
        let encoded = commands.into_iter().flatten().filter_map(|command| {
            self.sequence += 1;
            Datagram { sender: self.sender, sequence: self.sequence, stamp: trigger.stamp, command }.encode()
        });
        encoded.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gateway::Cause;
    use gateway::trigger::{Frames, Odometry};
    use messages::command::FixateCommand;

    #[test]
    fn answers_are_numbered_and_name_their_trigger() {
        let refused = [0; Cause::ALL.len()];
        let (odometry, frames) = (Odometry::UNKNOWN, Frames::UNKNOWN);
        let trigger = Trigger {
            sender: 1,
            sequence: 7,
            stamp: 123,
            cycle: 5,
            flags: 1,
            gait: 1,
            odometry,
            frames,
            accepted: 0,
            refused,
        };
        let velocity = VelocityCommand { forward: 0.2, left: 0.0, turn: -0.1 };
        let look = FixateCommand { point: [2.0, 0.5, 0.0] };
        let mut line = Line::new(9);
        let mut sent = line.datagrams(&trigger, &Answer { velocity, look: Some(look) });
        sent.push(line.stop(&trigger));
        let read: Vec<Datagram> = sent.iter().map(|bytes| Datagram::decode(bytes).unwrap()).collect();
        let still = VelocityCommand { forward: 0.0, left: 0.0, turn: 0.0 };
        let commands = [Command::Fixate(look), Command::Velocity(velocity), Command::Velocity(still)];
        for ((datagram, command), sequence) in read.iter().zip(commands).zip(1..) {
            assert_eq!(*datagram, Datagram { sender: 9, sequence, stamp: 123, command });
        }
        assert_eq!(read.len(), 3);
    }
}
