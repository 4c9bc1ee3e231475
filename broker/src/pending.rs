//! Commands on their way to the process that decides, and those that wait behind them.
//!
//! A process gets no more commands at once than its rings hold, so that none of them is lost; the others wait here, those
//! of a higher class first, else in their order, and are held against their age again when their turn comes. What is not answered within
//! `ANSWER_TIME` is given up: by then it is too old to take effect.

use std::collections::VecDeque;

use messages::Command;

/// Commands that one process has not answered yet, at most.
pub(crate) const AT_ONCE: usize = 96;
/// Longest time for an answer \[ns\].
pub(crate) const ANSWER_TIME: u64 = 300_000_000;

/// One command of which the verdict is not known.
#[derive(Clone, Debug)]
pub(crate) struct Asked {
    pub(crate) origin: u32,
    pub(crate) sequence: u64,
    pub(crate) command: Command,
    /// Member that decides.
    pub(crate) decider: u32,
    given_up_ns: u64,
}

/// One command that waits for its turn.
pub(crate) struct Queued {
    pub(crate) origin: u32,
    pub(crate) sequence: u64,
    pub(crate) class: usize,
    pub(crate) decider: u32,
    pub(crate) command: Command,
    pub(crate) bytes: Vec<u8>,
}

/// All of them.
#[derive(Default)]
pub(crate) struct Pending {
    asked: VecDeque<Asked>,
    queued: VecDeque<Queued>,
}

impl Pending {
    /// Commands of `origin` without an answer.
    pub(crate) fn of(&self, origin: u32) -> usize {
        self.asked.iter().filter(|a| a.origin == origin).count()
            + self.queued.iter().filter(|q| q.origin == origin).count()
    }

    /// Whether `decider` has room for one more of this class, and nothing waits before it.
    pub(crate) fn has_room(&self, decider: u32, class: usize) -> bool {
        let before = |q: &Queued| q.decider == decider && q.class <= class;
        self.outstanding(decider) < AT_ONCE && !self.queued.iter().any(before)
    }

    fn outstanding(&self, decider: u32) -> usize {
        self.asked.iter().filter(|a| a.decider == decider).count()
    }

    pub(crate) fn wait_in_line(&mut self, queued: Queued) {
        self.queued.push_back(queued);
    }

    /// The next command whose process has room again: what floods one class holds up no higher one.
    pub(crate) fn next_in_line(&mut self) -> Option<Queued> {
        if self.queued.is_empty() {
            return None;
        }
        let ready = self.queued.iter().enumerate().filter(|(_, q)| self.outstanding(q.decider) < AT_ONCE);
        let (at, _) = ready.min_by_key(|(_, q)| q.class)?;
        self.queued.remove(at)
    }

    pub(crate) fn ask(&mut self, origin: u32, sequence: u64, command: Command, decider: u32, now_ns: u64) {
        self.asked.push_back(Asked { origin, sequence, command, decider, given_up_ns: now_ns + ANSWER_TIME });
    }

    /// The command that `decider` answers.
    pub(crate) fn answered(&mut self, decider: u32, origin: u32, sequence: u64) -> Option<Asked> {
        let same = |a: &Asked| (a.decider, a.origin, a.sequence) == (decider, origin, sequence);
        let at = self.asked.iter().position(same)?;
        self.asked.remove(at)
    }

    /// The next command whose answer is overdue. Deadlines stand in the order in which the commands were asked.
    pub(crate) fn overdue(&mut self, now_ns: u64) -> Option<Asked> {
        if self.asked.front().is_some_and(|a| now_ns > a.given_up_ns) { self.asked.pop_front() } else { None }
    }

    /// Drops what `origin` has waiting, because its connection is closed; stops stay. Numbers and commands.
    pub(crate) fn drop_of(&mut self, origin: u32) -> Vec<(u64, Command)> {
        let goes = |q: &Queued| q.origin == origin && !q.command.always_passes();
        let gone = self.queued.iter().filter(|q| goes(q)).map(|q| (q.sequence, q.command)).collect();
        self.queued.retain(|q| !goes(q));
        gone
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::command::VelocityCommand;

    const WALK: Command = Command::Velocity(VelocityCommand { forward: 0.4, left: 0.0, turn: 0.0 });

    fn queued(origin: u32, sequence: u64, command: Command) -> Queued {
        Queued { origin, sequence, class: 1, decider: 1, command, bytes: Vec::new() }
    }

    #[test]
    fn who_has_enough_to_do_gets_the_rest_later_and_in_order() {
        let mut pending = Pending::default();
        for n in 0..AT_ONCE as u64 {
            assert!(pending.has_room(1, 1));
            pending.ask(9, n, WALK, 1, 0);
        }
        assert!(!pending.has_room(1, 1) && pending.has_room(2, 1));
        pending.wait_in_line(queued(9, 96, WALK));
        pending.wait_in_line(queued(9, 97, WALK));
        assert!(pending.next_in_line().is_none());
        assert!(pending.answered(1, 9, 0).is_some() && pending.answered(1, 9, 0).is_none(), "once");
        assert!(!pending.has_room(1, 1), "somebody waits before it");
        assert_eq!(pending.next_in_line().map(|q| q.sequence), Some(96));
        assert_eq!(pending.of(9), AT_ONCE - 1 + 1);
    }

    #[test]
    fn a_closed_connection_loses_what_waits_but_no_stop() {
        let mut pending = Pending::default();
        for (n, command) in [WALK, Command::Stop, WALK].into_iter().enumerate() {
            pending.wait_in_line(queued(9, n as u64, command));
        }
        assert_eq!(pending.drop_of(9), [(0, WALK), (2, WALK)]);
        assert_eq!(pending.next_in_line().map(|q| q.command), Some(Command::Stop));
    }

    #[test]
    fn what_is_not_answered_in_time_is_given_up() {
        let mut pending = Pending::default();
        pending.ask(9, 1, WALK, 1, 100);
        assert!(pending.overdue(100 + ANSWER_TIME).is_none());
        assert_eq!(pending.overdue(101 + ANSWER_TIME).map(|a| a.sequence), Some(1));
        assert!(pending.answered(1, 9, 1).is_none(), "too late");
    }
}
