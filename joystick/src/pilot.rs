//! Rules by which hands become commands: she moves while the dead-man button is held, and never by what was held before something
//! went wrong. Pure: time and hands are arguments, commands the result.

use config::joystick::ButtonFunction;
use messages::Command;
use messages::command::{StepCommand, VelocityCommand};
use realtime::clock::SECOND;

use crate::pad::{Hands, velocity};

/// Least time between two velocities \[ns\].
const EVERY: u64 = SECOND / 20;
/// Time after which a device that was plugged in, or is read again after a standstill, tells presses of now \[ns\].
const SETTLE: u64 = SECOND / 2;
/// Age from which a press is too old to be meant \[ns\].
const STALE: u64 = SECOND / 2;

/// Commands that the robot takes, and their ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ability {
    /// Ranges of forward, left \[m/s\] and turn \[rad/s\].
    pub velocities: [[f64; 2]; 3],
    /// \[s\] Duration of a step on the spot.
    pub on_the_spot: f64,
}

/// A thing to be done at the broker.
#[derive(Clone, Debug, PartialEq)]
pub enum Deed {
    /// Take the command lease.
    Take,
    /// Give it back.
    Give,
    /// Send a command.
    Send(Command),
    /// Do the next step of the start-up.
    Next,
    /// Tell that the dead-man button must be held for this.
    NeedsDeadMan(ButtonFunction),
    /// Tell that the dead-man button must be released first.
    NeedsRelease,
}

/// The pilot's state.
#[derive(Clone, Debug)]
pub struct Pilot {
    ability: Ability,
    hands: Hands,
    /// True while the hands steer: the dead-man button is held, and has been pressed since anything went wrong.
    steers: bool,
    /// True if it must be released before it counts.
    spent: bool,
    /// True if the sticks must come to their centre before they count.
    parked: bool,
    /// Velocity that was sent last.
    sent: [f64; 3],
    /// Earliest time of the next one \[ns\].
    next: u64,
    /// Time until which a press of the dead-man button may be older than its report \[ns\].
    settles: u64,
}

impl Pilot {
    /// Of a robot; a dead-man button that is held already must be released first.
    pub fn new(ability: Ability) -> Self {
        Self {
            ability,
            hands: Hands::default(),
            steers: false,
            spent: true,
            parked: false,
            sent: [0.0; 3],
            next: 0,
            settles: 0,
        }
    }

    /// True if the lease is to be kept.
    pub fn steers(&self) -> bool {
        self.steers
    }

    /// Hands have changed, and these buttons were pressed at the time `at`; now it is `now` \[ns\].
    pub fn hands(&mut self, hands: Hands, pressed: &[ButtonFunction], at: u64, now: u64) -> Vec<Deed> {
        let mut deeds = Vec::new();
        let press = hands.dead_man && !self.hands.dead_man;
        self.hands = hands;
        self.spent |= press && at < self.settles;
        if !hands.dead_man {
            deeds.extend(self.let_go());
            self.spent = false;
        } else if press && self.spent {
            deeds.push(Deed::NeedsRelease);
        } else if !self.spent && !self.steers {
            (self.steers, self.parked, self.sent) = (true, false, [0.0; 3]);
            deeds.push(Deed::Take);
        }
        for &function in pressed {
            let stale = now > at + STALE;
            match function {
                // It passes whatever the state, and however late.
                ButtonFunction::Stop => {
                    (self.parked, self.sent) = (true, [0.0; 3]);
                    deeds.push(Deed::Send(Command::Stop));
                }
                // The reader has sent it on its way.
                ButtonFunction::DeadMan | ButtonFunction::EmergencyStop => {}
                _ if stale => {}
                _ if !self.steers => deeds.push(Deed::NeedsDeadMan(function)),
                ButtonFunction::Next => deeds.push(Deed::Next),
                ButtonFunction::Stand => deeds.push(Deed::Send(Command::Stand)),
                ButtonFunction::Walk => {
                    let duration = self.ability.on_the_spot;
                    let step = StepCommand { length: 0.0, side: 0.0, turn: 0.0, duration };
                    deeds.extend([Deed::Send(Command::Step(step)), Deed::Send(Command::Start)]);
                    // She goes on until the sticks move.
                    self.sent = [0.0; 3];
                }
            }
        }
        deeds.extend(self.due(now));
        deeds
    }

    /// The gamepad is gone, or the program ends: a stop, as after a release. One that comes again with its button held is no press.
    pub fn let_go(&mut self) -> Vec<Deed> {
        self.spent = true;
        if std::mem::take(&mut self.steers) {
            vec![Deed::Send(Command::Stop), Deed::Give]
        } else {
            Vec::new()
        }
    }

    /// A gamepad was plugged in at `now`: a button that is held then tells a press, too, with its first report.
    pub fn arrived(&mut self, now: u64) {
        self.hands = Hands::default();
        self.settles = now + SETTLE;
    }

    /// Lease or time was lost, or somebody else stopped her: nothing moves before the dead-man button was released. False: the
    /// hands did not steer, and nothing is lost.
    pub fn lapse(&mut self) -> bool {
        self.spent |= self.steers;
        std::mem::take(&mut self.steers)
    }

    /// The program stood still until `now`: what was pressed meanwhile is told only then. False: the hands did not steer.
    pub fn stood(&mut self, now: u64) -> bool {
        self.settles = now + SETTLE;
        self.lapse()
    }

    /// The last velocity has not arrived: it is due again.
    pub fn forget(&mut self) {
        self.sent = [f64::NAN; 3];
    }

    /// Velocity that is due at `now`, if the sticks have changed since the last one.
    pub fn due(&mut self, now: u64) -> Option<Deed> {
        let wanted = velocity(self.hands.sticks, &self.ability.velocities);
        self.parked &= wanted != [0.0; 3];
        if !self.steers || self.parked || wanted == self.sent || now < self.next {
            return None;
        }
        (self.sent, self.next) = (wanted, now + EVERY);
        let [forward, left, turn] = wanted;
        Some(Deed::Send(Command::Velocity(VelocityCommand { forward, left, turn })))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ABILITY: Ability =
        Ability { velocities: [[-0.28, 0.94], [-0.14, 0.14], [-0.49, 0.49]], on_the_spot: 0.8 };
    const STOP: [Deed; 2] = [Deed::Send(Command::Stop), Deed::Give];

    fn hands(dead_man: bool, forward: f64) -> Hands {
        Hands { dead_man, sticks: [forward, 0.0, 0.0], held: [false; 6] }
    }

    fn walk(forward: f64) -> Deed {
        Deed::Send(Command::Velocity(VelocityCommand { forward, left: 0.0, turn: 0.0 }))
    }

    /// A pilot whose hands have held the dead-man button since the time 0.
    fn steering() -> Pilot {
        let mut pilot = Pilot::new(ABILITY);
        assert_eq!(pilot.hands(hands(false, 0.0), &[], 0, 0), []);
        assert_eq!(pilot.hands(hands(true, 0.0), &[], 0, 0), [Deed::Take]);
        pilot
    }

    #[test]
    fn sticks_walk_her_while_the_button_is_held_and_a_release_stops_her() {
        let mut pilot = steering();
        assert_eq!(pilot.hands(hands(true, 0.5), &[], 1, 1), [walk(0.47)]);
        assert_eq!(pilot.hands(hands(true, 0.5), &[], 2, 2), [], "no change");
        assert_eq!(pilot.hands(hands(true, 1.0), &[], 3, 3), [], "too soon");
        assert_eq!((pilot.due(EVERY), pilot.due(EVERY + 1)), (None, Some(walk(0.94))));
        assert_eq!(pilot.due(SECOND), None);
        pilot.forget();
        assert_eq!(pilot.due(SECOND), Some(walk(0.94)), "it has not arrived");
        assert_eq!(pilot.hands(hands(false, 1.0), &[], 9, 9), STOP);
        assert_eq!(pilot.hands(hands(false, 0.3), &[], 9, 9 * EVERY), [], "sticks alone do nothing");
    }

    /// A button held through a loss does not count, however the sticks move.
    #[test]
    fn after_a_lapse_the_button_must_be_released() {
        let mut pilot = Pilot::new(ABILITY);
        let held = pilot.hands(hands(true, 1.0), &[], 1, 1);
        assert_eq!(held, [Deed::NeedsRelease], "held when the program began");
        let mut pilot = {
            pilot.hands(hands(false, 1.0), &[], 2, 2);
            pilot
        };
        assert_eq!(pilot.hands(hands(true, 1.0), &[], 3, 3), [Deed::Take, walk(0.94)]);
        assert!(pilot.lapse() && !pilot.lapse());
        assert_eq!(pilot.hands(hands(true, 0.2), &[], 4, SECOND), []);
        assert_eq!(pilot.hands(hands(false, 0.2), &[], 5, SECOND), []);
        assert_eq!(pilot.hands(hands(true, 0.2), &[], 6, 2 * SECOND), [Deed::Take, walk(0.18)]);
        // News of a walk that is over does not make the next press void.
        assert_eq!(pilot.hands(hands(false, 0.2), &[], 7, 3 * SECOND), STOP);
        assert!(!pilot.lapse());
        assert_eq!(pilot.hands(hands(true, 0.2), &[], 8, 3 * SECOND), [Deed::Take, walk(0.18)]);
        // Unplugged, and there again with the button held, which its first report tells as a press.
        assert_eq!(pilot.let_go(), STOP);
        pilot.arrived(9);
        assert_eq!(pilot.hands(hands(false, 0.0), &[], 9, 9), []);
        assert_eq!(pilot.hands(hands(true, 0.9), &[], 10, 4 * SECOND), [Deed::NeedsRelease]);
        assert_eq!(pilot.hands(hands(true, 0.8), &[], 9 + SETTLE, 5 * SECOND), []);
        assert_eq!(pilot.hands(hands(false, 0.8), &[], 9 + SETTLE, 5 * SECOND), []);
        assert_eq!(pilot.hands(hands(true, 0.2), &[], 9 + SETTLE, 5 * SECOND), [Deed::Take, walk(0.18)]);
    }

    /// The reader stood still, too: whatever waits for it has the time at which it goes on.
    #[test]
    fn a_press_made_in_a_standstill_does_not_count() {
        for mut pilot in [steering(), Pilot::new(ABILITY)] {
            pilot.hands(hands(false, 0.0), &[], 0, 0);
            assert!(!pilot.stood(SECOND));
            assert_eq!(pilot.hands(hands(false, 1.0), &[], SECOND + 1, SECOND + 1), []);
            assert_eq!(pilot.hands(hands(true, 1.0), &[], SECOND + 2, SECOND + 2), [Deed::NeedsRelease]);
            assert_eq!(pilot.hands(hands(true, 0.5), &[], 2 * SECOND, 2 * SECOND), [], "held since then");
            assert_eq!(pilot.hands(hands(false, 0.5), &[], 2 * SECOND, 2 * SECOND), []);
            assert_eq!(pilot.hands(hands(true, 0.5), &[], 3 * SECOND, 3 * SECOND), [Deed::Take, walk(0.47)]);
            assert!(pilot.stood(4 * SECOND), "hands that steered before the standstill");
            assert_eq!(pilot.hands(hands(true, 0.4), &[], 5 * SECOND, 5 * SECOND), []);
        }
    }

    #[test]
    fn buttons_do_what_they_say_and_all_but_stop_need_the_dead_man() {
        use ButtonFunction::{Next, Stand, Stop, Walk};
        let mut pilot = steering();
        let all = pilot.hands(hands(true, 0.0), &[Walk, Stand, Next], 1, 1);
        let step = Command::Step(StepCommand { length: 0.0, side: 0.0, turn: 0.0, duration: 0.8 });
        let sent = [step, Command::Start, Command::Stand].map(Deed::Send);
        assert_eq!((&all[..3], &all[3..]), (&sent[..], &[Deed::Next][..]));
        // Stopped with the stick held: it must come back to its centre.
        assert_eq!(pilot.hands(hands(true, 1.0), &[Stop], 2, 2), [Deed::Send(Command::Stop)]);
        assert_eq!(pilot.hands(hands(true, 0.7), &[], 3, SECOND), []);
        assert_eq!(pilot.hands(hands(true, 0.0), &[], 4, SECOND), []);
        assert_eq!(pilot.hands(hands(true, 0.7), &[], 5, SECOND), [walk(0.65)]);
        let mut pilot = Pilot::new(ABILITY);
        for function in [Walk, Stand, Next] {
            assert_eq!(pilot.hands(hands(false, 0.0), &[function], 1, 1), [Deed::NeedsDeadMan(function)]);
            assert_eq!(pilot.hands(hands(false, 0.0), &[function], 1, 2 + STALE), [], "said long ago");
        }
        assert_eq!(pilot.hands(hands(false, 0.0), &[Stop], 1, 2 + STALE), [Deed::Send(Command::Stop)]);
    }

    proptest! {
        /// Whatever hands do and whatever is lost: never more than twenty velocities in a second, none without the button, each walk
        /// is followed by a stop, and lapses alone send nothing.
        #[test]
        fn velocities_are_bounded_and_end(moves in proptest::collection::vec((any::<bool>(), -1.0..1.0f64, 0..SECOND / 10, 0..20), 1..400)) {
            let (mut pilot, mut now, mut times, mut walks) = (Pilot::new(ABILITY), 0, Vec::new(), false);
            for (dead_man, forward, later, chance) in moves {
                now += later;
                if chance == 0 {
                    // The caller's connection is gone, and with it the lease: she stands.
                    pilot.lapse();
                    walks = false;
                }
                for deed in pilot.hands(hands(dead_man, forward), &[], now, now) {
                    match deed {
                        Deed::Send(Command::Velocity(v)) => {
                            prop_assert!(dead_man && v.forward >= -0.28 && v.forward <= 0.94);
                            times.push(now);
                            walks = v.forward != 0.0;
                        }
                        Deed::Send(Command::Stop) => walks = false,
                        _ => {}
                    }
                }
                prop_assert!(dead_man || !walks, "released, and not stopped");
            }
            prop_assert!(times.windows(21).all(|w| w[20] - w[0] >= SECOND), "{times:?}");
        }
    }
}
