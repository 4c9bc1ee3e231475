//! Rules by which a vision system steers: which of its commands are passed on, and when it has to show first that it knows of a stop.
//!
//! They belong to the robot and not to a connection: a stop holds, also when the broker is started again. Pure: time is an argument.

use broker::Awaited;
use broker::identity::is_own;
use broker::stream_client::Answer;
use messages::Command;
use messages::command_answer::code;
use realtime::clock::SECOND;

/// Name at the broker.
pub(crate) const NAME: &str = "gangwerk gateway";
/// Silence of the vision system after which she comes to a stand \[ns\].
pub const SILENCE: u64 = SECOND / 2;
/// Answers of the protocol to a velocity after which it is not for the vision system to go on by itself: somebody else holds
/// the lease, she does not stand, not in this state, fallen or stopped.
const NOT_YOURS: [u8; 4] = [code::LEASE_HELD, code::NOT_STANDING, code::NOT_NOW, code::EVENT];

/// What becomes of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Passage {
    /// It goes to the broker.
    Send,
    /// There is nothing that it would change.
    Needless,
    /// She was stopped or taken over by somebody else, and it is none that ends that.
    Held,
}

/// What a hold leaves to do at the broker, one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Parting {
    /// The lease is given back, so that nothing of ours keeps it.
    Lease,
    /// She is stopped: a velocity of ours may have come to the robot behind somebody else's stop, and this stop comes behind that
    /// velocity, on the same connection. The lease goes when it is answered.
    Stop,
}

/// State of the steering.
#[derive(Default)]
pub(crate) struct Steering {
    /// True if the broker has said that this program holds the lease.
    mine: bool,
    /// Time of the last velocity that moves her \[ns\]; none: she need not walk.
    walks: Option<u64>,
    /// Time of the last command that took the lease, if it was free \[ns\]; none: given back since, or somebody else's.
    took: Option<u64>,
    /// Why no velocity is passed on until one of zero comes.
    held: Option<String>,
    parting: Option<Parting>,
    /// Commands that are not answered yet.
    awaited: Awaited<Command>,
}

impl Steering {
    /// True: velocities move her.
    pub(crate) const fn has_lease(&self) -> bool {
        self.mine
    }

    /// True: a velocity of zero has to come first.
    pub(crate) const fn is_held(&self) -> bool {
        self.held.is_some()
    }

    /// True: she walks as the vision system says.
    pub(crate) const fn walks(&self) -> bool {
        self.walks.is_some()
    }

    /// What becomes of a command.
    pub(crate) fn admit(&mut self, command: &Command, now: u64) -> Passage {
        match command {
            Command::Velocity(_) if !command.is_unbounded() => self.admit_stop(),
            _ if self.is_held() && command.needs_lease() => Passage::Held,
            Command::Velocity(_) => {
                self.walks = Some(now);
                Passage::Send
            }
            _ => Passage::Send,
        }
    }

    /// A velocity of zero stops a walk of one's own; that of somebody else is not ended from here.
    fn admit_stop(&mut self) -> Passage {
        self.held = None;
        let walked = self.walks.take().is_some();
        // What is on its way to the broker may have the lease before anybody has told us.
        let on_its_way = || self.awaited.iter().any(Command::needs_lease);
        if self.mine || walked || on_its_way() { Passage::Send } else { Passage::Needless }
    }

    /// A command went to the broker with this number.
    pub(crate) fn sent(&mut self, sequence: u64, command: &Command, now: u64) {
        if command.needs_lease() {
            self.took = Some(now);
        }
        self.awaited.insert(sequence, *command, now);
    }

    /// Takes an answer; whether it accepts a command of the vision system, if it is one to such.
    pub(crate) fn answered(&mut self, answer: Answer, now: u64, say: &mut dyn FnMut(String)) -> Option<bool> {
        let command = self.awaited.take(&answer)?;
        if command == Command::Stop {
            // That of a hold, which may be over by now.
            self.parting = self.parting.max(self.is_held().then_some(Parting::Lease));
            return None;
        }
        let (code, name) = (answer.code, command.name());
        let refused = answer.accepted().err();
        if let Some(why) = &refused {
            let line = format!("{name} refused: {why}");
            if matches!(command, Command::Velocity(_)) && NOT_YOURS.contains(&code) {
                self.hold(line, self.steered(now).then_some(Parting::Lease), say);
            } else {
                say(line);
            }
        }
        Some(refused.is_none())
    }

    /// Number of commands of the vision system that are not answered yet.
    pub(crate) fn unanswered(&self) -> usize {
        self.awaited.iter().filter(|command| **command != Command::Stop).count()
    }

    /// Looks whether an answer is overdue.
    ///
    /// # Errors
    /// One is.
    pub(crate) fn check_answers(&self, now: u64) -> Result<(), String> {
        self.awaited.check(now)
    }

    /// The command lease has changed hands.
    pub(crate) fn held_by(&mut self, holder: &str, say: &mut dyn FnMut(String)) {
        self.mine = is_own(holder, NAME);
        if self.mine || holder.is_empty() {
            return;
        }
        // The broker refuses what comes of ours now, and a stop would be one of somebody else's walk.
        (self.took, self.parting) = (None, None);
        if self.walks() {
            self.hold(format!("{holder} steers"), None, say);
        }
    }

    /// Somebody else has stopped her, by this command.
    pub(crate) fn stopped(&mut self, by: &Command, now: u64, say: &mut dyn FnMut(String)) {
        let parting = self.steered(now).then_some(Parting::Stop);
        self.hold(format!("stopped by somebody else ({})", by.name()), parting, say);
    }

    /// True: the lease is ours, or what takes it may still be on its way to the robot.
    fn steered(&self, now: u64) -> bool {
        self.mine || self.took.is_some_and(|at| now.saturating_sub(at) < SECOND)
    }

    /// What a hold leaves to do at the broker, once.
    pub(crate) fn part(&mut self) -> Option<Parting> {
        let parting = self.parting.take();
        if parting == Some(Parting::Lease) {
            (self.mine, self.took) = (false, None);
        }
        parting
    }

    /// True once if the vision system has been silent for so long that she is to stand.
    pub(crate) fn falls_silent(&mut self, now: u64) -> bool {
        self.walks.take_if(|last| now.saturating_sub(*last) > SILENCE).is_some()
    }

    /// From now on the vision system does not steer, until it has shown that it knows.
    fn hold(&mut self, why: String, parting: Option<Parting>, say: &mut dyn FnMut(String)) {
        self.walks = None;
        self.parting = self.parting.max(parting);
        if self.held.as_ref() != Some(&why) {
            say(format!("{why}: velocities are refused until one of zero comes"));
        }
        self.held = Some(why);
    }

    /// The connection to the broker is over, and with it the lease. Nobody knows who stops her until there is another one.
    pub(crate) fn disconnected(&mut self, say: &mut dyn FnMut(String)) {
        *self = Self { held: self.held.take(), ..Self::default() };
        self.hold("nobody's stop is heard without the broker".into(), None, say);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use broker::awaited::PATIENCE;
    use messages::command::{FixateCommand, GoneCommand, VelocityCommand};

    const WALK: Command = Command::Velocity(VelocityCommand { forward: 0.3, left: 0.0, turn: 0.0 });
    const ZERO: Command = Command::Velocity(VelocityCommand { forward: 0.0, left: 0.0, turn: 0.0 });
    const LOOK: Command = Command::Fixate(FixateCommand { point: [1.0, 0.0, 1.0] });

    fn own() -> String {
        format!("{NAME} (pid {})", std::process::id())
    }

    fn accepted(sequence: u64) -> Answer {
        Answer { sequence, code: 0, text: "planner".into() }
    }

    /// Gives a command, which goes to the broker if it is to.
    fn give(steering: &mut Steering, command: Command, sequence: u64) -> Passage {
        let passage = steering.admit(&command, 1000);
        if passage == Passage::Send {
            steering.sent(sequence, &command, 1000);
        }
        passage
    }

    /// A person's stop, and then the broker died and was started again: she walked off by a velocity that was repeated all the time.
    #[test]
    fn a_stop_holds_when_the_broker_is_started_again() {
        let mut steering = Steering::default();
        assert_eq!(give(&mut steering, WALK, 1), Passage::Send);
        steering.held_by(&own(), &mut |_| {});
        steering.stopped(&Command::Stop, 1000, &mut |_| {});
        assert_eq!(give(&mut steering, WALK, 2), Passage::Held);
        steering.disconnected(&mut |_| {});
        let overdue = steering.check_answers(u64::MAX).is_err();
        assert!(!steering.has_lease() && !overdue, "both went with the connection");
        assert_eq!(give(&mut steering, WALK, 1), Passage::Held);
        assert_eq!(give(&mut steering, ZERO, 1), Passage::Needless);
        assert_eq!(give(&mut steering, WALK, 1), Passage::Send);
    }

    /// Whoever stops her while there is no connection is not heard.
    #[test]
    fn a_lost_connection_holds_whether_she_walks_or_not() {
        for command in [WALK, ZERO] {
            let mut steering = Steering::default();
            let mut said = Vec::new();
            give(&mut steering, command, 1);
            steering.disconnected(&mut |line| said.push(line));
            assert!(steering.is_held() && !steering.walks(), "{command:?}");
            assert!(said[0].contains("until one of zero comes"), "{said:?}");
            assert!(!steering.falls_silent(u64::MAX), "nothing to give back");
        }
    }

    /// The lease is told some milliseconds after the velocity that takes it: a zero within them was accepted and thrown away.
    #[test]
    fn a_zero_stops_what_is_still_on_its_way() {
        for command in [WALK, LOOK] {
            let mut steering = Steering::default();
            assert_eq!(give(&mut steering, command, 1), Passage::Send);
            assert_eq!(give(&mut steering, ZERO, 2), Passage::Send, "{command:?}");
            assert!(!steering.walks());
            // Answered, and the lease told: it is still ours.
            steering.answered(accepted(1), 1000, &mut |_| {});
            steering.answered(accepted(2), 1000, &mut |_| {});
            steering.held_by(&own(), &mut |_| {});
            assert_eq!(give(&mut steering, ZERO, 3), Passage::Send);
        }
        // Accepted, and the lease not told yet.
        let mut steering = Steering::default();
        give(&mut steering, WALK, 1);
        steering.answered(accepted(1), 1000, &mut |_| {});
        assert_eq!(give(&mut steering, ZERO, 2), Passage::Send);
    }

    #[test]
    fn a_zero_does_not_end_somebody_elses_walk() {
        let mut steering = Steering::default();
        assert_eq!(give(&mut steering, ZERO, 1), Passage::Needless);
        // A box on its way takes no lease.
        give(&mut steering, Command::Gone(GoneCommand { id: 1 }), 1);
        assert_eq!(give(&mut steering, ZERO, 2), Passage::Needless);
        // Taken over, and so held; the zero frees it and goes nowhere.
        give(&mut steering, WALK, 2);
        steering.answered(accepted(2), 1000, &mut |_| {});
        steering.held_by("somebody (pid 1)", &mut |_| {});
        assert_eq!(give(&mut steering, WALK, 3), Passage::Held);
        assert_eq!(give(&mut steering, ZERO, 3), Passage::Needless);
        assert!(!steering.is_held());
    }

    /// A velocity came to the robot behind a person's stop, before that was heard here, and boxes kept the lease: she walked on.
    #[test]
    fn a_hold_stops_what_came_behind_somebody_elses_stop_and_gives_the_lease_back() {
        for told in [true, false] {
            let mut steering = Steering::default();
            give(&mut steering, WALK, 1);
            if told {
                steering.held_by(&own(), &mut |_| {});
            }
            steering.stopped(&Command::Stop, 1000 + SECOND - 1, &mut |_| {});
            assert_eq!((steering.part(), steering.part()), (Some(Parting::Stop), None), "{told}");
            steering.sent(2, &Command::Stop, 1000 + SECOND);
            assert_eq!(steering.unanswered(), 1, "the walk alone is the vision system's");
            assert_eq!(steering.answered(accepted(2), 1000 + SECOND, &mut |_| {}), None);
            assert_eq!((steering.part(), steering.has_lease()), (Some(Parting::Lease), false), "{told}");
            // Heard again, and nothing is left to do; a look would take the lease, a box takes none.
            steering.stopped(&Command::EmergencyStop, 1001 + SECOND, &mut |_| {});
            assert_eq!(steering.part(), None, "{told}");
            assert_eq!(give(&mut steering, LOOK, 3), Passage::Held);
            assert_eq!(give(&mut steering, Command::Gone(GoneCommand { id: 1 }), 3), Passage::Send);
        }
    }

    #[test]
    fn a_hold_stops_no_walk_of_somebody_else() {
        // A second after the last velocity its lease is over; and who has taken her over has the walk in his hands.
        let mut steering = Steering::default();
        steering.stopped(&Command::Stop, 1000, &mut |_| {});
        assert_eq!(steering.part(), None, "nothing was sent");
        give(&mut steering, ZERO, 1);
        give(&mut steering, WALK, 1);
        steering.stopped(&Command::Stop, 1000 + SECOND, &mut |_| {});
        assert_eq!(steering.part(), None, "long ago");
        give(&mut steering, ZERO, 2);
        give(&mut steering, WALK, 3);
        steering.stopped(&Command::Stop, 1000, &mut |_| {});
        steering.held_by("somebody (pid 1)", &mut |_| {});
        assert_eq!(steering.part(), None, "taken over since");
        // The vision system has seen the stop and walks on before ours is answered.
        let mut steering = Steering::default();
        give(&mut steering, WALK, 1);
        steering.stopped(&Command::Stop, 1000, &mut |_| {});
        assert_eq!(steering.part(), Some(Parting::Stop));
        steering.sent(2, &Command::Stop, 1000);
        give(&mut steering, ZERO, 3);
        give(&mut steering, WALK, 4);
        steering.answered(accepted(2), 1000, &mut |_| {});
        assert_eq!(steering.part(), None);
    }

    #[test]
    fn refusals_hold_a_velocity_and_silence_gives_the_lease_back_once() {
        let mut steering = Steering::default();
        for (code, holds) in [(9, true), (30, false), (31, true), (20, false)] {
            give(&mut steering, ZERO, 1);
            give(&mut steering, WALK, 2);
            let answer = Answer { sequence: 2, code, text: "no".into() };
            assert_eq!(steering.answered(answer, 1000, &mut |_| {}), Some(false));
            assert_eq!(steering.is_held(), holds, "{code}");
            // Boxes went on renewing the lease of a walk that was refused.
            assert_eq!(steering.part(), holds.then_some(Parting::Lease), "{code}");
        }
        give(&mut steering, ZERO, 3);
        give(&mut steering, WALK, 4);
        assert!(!steering.falls_silent(1000 + SILENCE));
        assert!(steering.falls_silent(1001 + SILENCE));
        assert!(!steering.falls_silent(1001 + SILENCE));
        assert!(steering.check_answers(1000 + PATIENCE).is_ok());
        assert!(steering.check_answers(1001 + PATIENCE).is_err());
    }
}
