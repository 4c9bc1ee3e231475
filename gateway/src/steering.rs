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

/// State of the steering.
#[derive(Default)]
pub(crate) struct Steering {
    /// True if the broker has said that this program holds the lease.
    mine: bool,
    /// Time of the last velocity that moves her \[ns\]; none: she need not walk.
    walks: Option<u64>,
    /// Why no velocity is passed on until one of zero comes.
    held: Option<String>,
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
            Command::Velocity(_) if self.is_held() => Passage::Held,
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
        self.awaited.insert(sequence, *command, now);
    }

    /// Takes an answer; true: it is a refusal.
    pub(crate) fn answered(&mut self, answer: Answer, say: &mut dyn FnMut(String)) -> bool {
        let Some(command) = self.awaited.take(&answer) else { return false };
        let (code, name) = (answer.code, command.name());
        let Err(why) = answer.accepted() else { return false };
        if matches!(command, Command::Velocity(_)) && NOT_YOURS.contains(&code) {
            self.hold(format!("{name} refused: {why}"), say);
        } else {
            say(format!("{name} refused: {why}"));
        }
        true
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
        if !self.mine && !holder.is_empty() && self.walks() {
            self.hold(format!("{holder} steers"), say);
        }
    }

    /// True once if the vision system has been silent for so long that she is to stand.
    pub(crate) fn falls_silent(&mut self, now: u64) -> bool {
        self.walks.take_if(|last| now.saturating_sub(*last) > SILENCE).is_some()
    }

    /// From now on the vision system does not steer, until it has shown that it knows.
    pub(crate) fn hold(&mut self, why: String, say: &mut dyn FnMut(String)) {
        self.walks = None;
        if self.held.as_ref() != Some(&why) {
            say(format!("{why}: velocities are refused until one of zero comes"));
        }
        self.held = Some(why);
    }

    /// The connection to the broker is over, and with it the lease. Nobody knows who stops her until there is another one.
    pub(crate) fn disconnected(&mut self, say: &mut dyn FnMut(String)) {
        (self.mine, self.awaited) = (false, Awaited::default());
        self.hold("nobody's stop is heard without the broker".into(), say);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use broker::awaited::PATIENCE;
    use messages::command::{FixateCommand, GoneCommand, VelocityCommand};

    const WALK: Command = Command::Velocity(VelocityCommand { forward: 0.3, left: 0.0, turn: 0.0 });
    const ZERO: Command = Command::Velocity(VelocityCommand { forward: 0.0, left: 0.0, turn: 0.0 });

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
        steering.hold("stopped by somebody else (walk/stop)".into(), &mut |_| {});
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
        let look = Command::Fixate(FixateCommand { point: [1.0, 0.0, 1.0] });
        for command in [WALK, look] {
            let mut steering = Steering::default();
            assert_eq!(give(&mut steering, command, 1), Passage::Send);
            assert_eq!(give(&mut steering, ZERO, 2), Passage::Send, "{command:?}");
            assert!(!steering.walks());
            // Answered, and the lease told: it is still ours.
            steering.answered(accepted(1), &mut |_| {});
            steering.answered(accepted(2), &mut |_| {});
            steering.held_by(&own(), &mut |_| {});
            assert_eq!(give(&mut steering, ZERO, 3), Passage::Send);
        }
        // Accepted, and the lease not told yet.
        let mut steering = Steering::default();
        give(&mut steering, WALK, 1);
        steering.answered(accepted(1), &mut |_| {});
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
        steering.answered(accepted(2), &mut |_| {});
        steering.held_by("somebody (pid 1)", &mut |_| {});
        assert_eq!(give(&mut steering, WALK, 3), Passage::Held);
        assert_eq!(give(&mut steering, ZERO, 3), Passage::Needless);
        assert!(!steering.is_held());
    }

    #[test]
    fn refusals_hold_a_velocity_and_silence_gives_the_lease_back_once() {
        let mut steering = Steering::default();
        for (code, holds) in [(9, true), (30, false), (31, true), (20, false)] {
            give(&mut steering, ZERO, 1);
            give(&mut steering, WALK, 2);
            let answer = Answer { sequence: 2, code, text: "no".into() };
            assert!(steering.answered(answer, &mut |_| {}));
            assert_eq!(steering.is_held(), holds, "{code}");
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
