//! Admission of datagrams, one after the other, before anybody hears of them: whose they are, how old, in order, how many.
//!
//! A datagram that fails here changes nothing but a count. Time is an argument.

use std::collections::VecDeque;
use std::net::SocketAddr;

use messages::Command;
use realtime::Bucket;
use realtime::clock::SECOND;

use crate::Cause;
use crate::wire::Datagram;

/// Time after its last valid datagram for which nobody else is heard \[ns\].
pub const SESSION: u64 = SECOND;
/// Age of a stamp from which on its answer is refused \[ns\].
pub const MAX_AGE: u64 = SECOND / 2;
/// Datagrams per second of a session in the long run; as many velocities of zero besides.
pub const RATE: u64 = 100;
/// Datagrams at once.
pub const BURST: u64 = 50;

/// Who is heard.
#[derive(Clone, Copy, Debug)]
struct Session {
    /// Address and number of the sender.
    who: (SocketAddr, u64),
    /// Highest number so far.
    sequence: u64,
    /// Time of the last valid datagram \[ns\].
    last: u64,
}

/// The gate.
#[derive(Debug)]
pub struct Gate {
    session: Option<Session>,
    /// Stamps of triggers that may still be answered \[ns\].
    stamps: VecDeque<u64>,
    /// For velocities of zero, and for everything else: a stop comes through, whatever came too often.
    zeros: Bucket,
    others: Bucket,
    /// Datagrams that were accepted in the end, which whoever comes after the gate counts: each is counted once.
    pub accepted: u64,
    /// Datagrams that were refused, by [`Cause`].
    pub refused: [u64; Cause::ALL.len()],
}

impl Default for Gate {
    /// Nobody has been heard.
    fn default() -> Self {
        let (zeros, others) = (Bucket::full(RATE, BURST), Bucket::full(RATE, BURST));
        Self { session: None, stamps: VecDeque::new(), zeros, others, accepted: 0, refused: [0; _] }
    }
}

impl Gate {
    /// A trigger with this stamp goes out.
    pub fn triggered(&mut self, stamp: u64) {
        self.stamps.push_back(stamp);
        self.stamps.retain(|old| stamp - old <= MAX_AGE);
    }

    /// The command of a datagram that came from there.
    ///
    /// # Errors
    /// Why it is refused, which has been counted; one that is admitted has not.
    pub fn admit(&mut self, bytes: &[u8], from: SocketAddr, now: u64) -> Result<Command, Cause> {
        let admitted = Datagram::decode(bytes).and_then(|datagram| self.check(&datagram, from, now));
        admitted.inspect_err(|cause| self.count(*cause))
    }

    /// A refusal; also of who comes after the gate.
    pub fn count(&mut self, cause: Cause) {
        self.refused[cause as usize] += 1;
    }

    fn check(&mut self, datagram: &Datagram, from: SocketAddr, now: u64) -> Result<Command, Cause> {
        // Strangers first, so that they cost nobody else's rate.
        let who = (from, datagram.sender);
        let session = self.session.filter(|s| now - s.last <= SESSION);
        if session.is_some_and(|s| s.who != who) {
            return Err(Cause::Sender);
        }
        // A stamp of ours, so that nobody answers what has not been asked yet.
        let fresh = |stamp: &u64| *stamp == datagram.stamp && now - stamp <= MAX_AGE;
        if !self.stamps.iter().any(fresh) {
            return Err(Cause::Age);
        }
        if session.is_some_and(|s| datagram.sequence <= s.sequence) {
            return Err(Cause::Order);
        }
        let command = datagram.command;
        let is_zero = matches!(command, Command::Velocity(_)) && !command.is_unbounded();
        let bucket = if is_zero { &mut self.zeros } else { &mut self.others };
        if !bucket.take(now) {
            return Err(Cause::Rate);
        }
        self.session = Some(Session { who, sequence: datagram.sequence, last: now });
        Ok(command)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::command::VelocityCommand;

    const WALK: Command = Command::Velocity(VelocityCommand { forward: 0.3, left: 0.0, turn: 0.0 });
    const ZERO: Command = Command::Velocity(VelocityCommand { forward: 0.0, left: 0.0, turn: 0.0 });
    const STAMP: u64 = 10 * SECOND;

    fn at(port: u16) -> SocketAddr {
        SocketAddr::from(([127, 0, 0, 1], port))
    }

    fn gate() -> Gate {
        let mut gate = Gate::default();
        gate.triggered(STAMP);
        gate
    }

    /// Offers a datagram of a sender at the port 1.
    fn offer(gate: &mut Gate, sequence: u64, stamp: u64, now: u64) -> Result<Command, Cause> {
        tell(gate, WALK, sequence, stamp, now)
    }

    fn tell(
        gate: &mut Gate,
        command: Command,
        sequence: u64,
        stamp: u64,
        now: u64,
    ) -> Result<Command, Cause> {
        let datagram = Datagram { sender: 5, sequence, stamp, command };
        gate.admit(&datagram.encode().unwrap(), at(1), now)
    }

    #[test]
    fn an_answer_is_refused_at_its_age_and_not_before() {
        let mut gate = gate();
        assert_eq!(offer(&mut gate, 1, STAMP, STAMP + MAX_AGE), Ok(WALK));
        assert_eq!(offer(&mut gate, 2, STAMP, STAMP + MAX_AGE + 1), Err(Cause::Age));
        // Neither of the future, nor of a time in which there was no trigger.
        for stamp in [0, STAMP - 1, STAMP + 1, u64::MAX] {
            assert_eq!(offer(&mut gate, 3, stamp, STAMP + 2), Err(Cause::Age), "{stamp}");
        }
        assert_eq!((gate.accepted, gate.refused[Cause::Age as usize]), (0, 5), "accepted: in the end");
    }

    #[test]
    fn doubles_replays_and_latecomers_are_refused() {
        let mut gate = gate();
        assert_eq!(offer(&mut gate, 7, STAMP, STAMP + 1), Ok(WALK));
        for sequence in [7, 6, 0] {
            assert_eq!(offer(&mut gate, sequence, STAMP, STAMP + 2), Err(Cause::Order));
        }
        assert_eq!(offer(&mut gate, 8, STAMP, STAMP + 3), Ok(WALK));
        // A session that is over leaves no numbers behind, but then the stamps of its datagrams are too old.
        let later = STAMP + 3 + SESSION + 1;
        assert_eq!(offer(&mut gate, 7, STAMP, later), Err(Cause::Age));
        gate.triggered(later);
        assert_eq!(offer(&mut gate, 1, later, later), Ok(WALK));
    }

    #[test]
    fn the_first_sender_holds_the_session_until_it_is_silent() {
        let mut gate = gate();
        assert_eq!(offer(&mut gate, 1, STAMP, STAMP), Ok(WALK));
        let other = |gate: &mut Gate, sender: u64, port: u16, now: u64| {
            gate.triggered(now);
            let datagram = Datagram { sender, sequence: 99, stamp: now, command: WALK };
            gate.admit(&datagram.encode().unwrap(), at(port), now)
        };
        // Neither somebody else, nor the same from elsewhere, nor another one from there.
        for (sender, port) in [(6, 2), (5, 2), (6, 1)] {
            assert_eq!(other(&mut gate, sender, port, STAMP + SESSION), Err(Cause::Sender));
        }
        assert_eq!(other(&mut gate, 6, 2, STAMP + SESSION + 1), Ok(WALK));
        assert_eq!(other(&mut gate, 5, 1, STAMP + SESSION + 2), Err(Cause::Sender), "now it is the other's");
    }

    #[test]
    fn a_flood_is_cut_to_the_rate() {
        let mut gate = gate();
        let (mut sequence, mut taken) = (0, 0);
        let seconds = 3;
        for ms in 0..1000 * seconds {
            let now = STAMP + ms * SECOND / 1000;
            gate.triggered(now);
            for _ in 0..5 {
                sequence += 1;
                taken += u64::from(offer(&mut gate, sequence, now, now).is_ok());
            }
        }
        assert!((BURST + RATE * seconds - 1..=BURST + RATE * seconds).contains(&taken), "{taken}");
        assert_eq!(gate.refused[Cause::Rate as usize], sequence - taken);
        // Strangers do not use it up: a stranger's flood, and then the session's own.
        let now = STAMP + seconds * SECOND + SECOND / 2;
        gate.triggered(now);
        for _ in 0..1000 {
            let datagram = Datagram { sender: 6, sequence: 1, stamp: now, command: WALK };
            assert_eq!(gate.admit(&datagram.encode().unwrap(), at(2), now), Err(Cause::Sender));
        }
        assert_eq!(offer(&mut gate, sequence + 1, now, now), Ok(WALK));
    }

    /// 32 boxes with each trigger used up the rate, and every zero after them was refused.
    #[test]
    fn a_zero_passes_after_a_flood_of_anything_else() {
        let mut gate = gate();
        let mut sequence = 0;
        let mut next = || {
            sequence += 1;
            sequence
        };
        while offer(&mut gate, next(), STAMP, STAMP).is_ok() {}
        assert_eq!(gate.refused[Cause::Rate as usize], 1);
        // As many as of anything else, so that a flood of them does not reach the broker either.
        for _ in 0..BURST {
            assert_eq!(tell(&mut gate, ZERO, next(), STAMP, STAMP), Ok(ZERO));
        }
        assert_eq!(tell(&mut gate, ZERO, next(), STAMP, STAMP), Err(Cause::Rate));
    }
}
