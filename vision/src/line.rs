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
