//! Whatever comes in: off is safe, and on needs both edges.

use messages::{Command, EventCode, WatchdogReset};
use proptest::prelude::*;
use watchdog::{Inputs, Supply, Watchdog};

const LIMIT: u32 = 3;
const QUIET: u32 = 10;

/// Steps a watchdog as if the joint loop wrote one record per cycle; the relay follows a cycle later.
struct Rig {
    dog: Watchdog,
    reset: WatchdogReset,
    alive: bool,
    /// Own cycles missed before the next one.
    skipped: u64,
    /// The next look comes late in its cycle.
    late: bool,
    relay_works: bool,
}

impl Rig {
    fn new() -> Self {
        Self {
            dog: Watchdog::new(LIMIT, QUIET),
            reset: WatchdogReset::default(),
            alive: true,
            skipped: 0,
            late: false,
            relay_works: true,
        }
    }

    fn step(&mut self, commands: &[Command]) -> bool {
        self.reset.header.tick += u64::from(self.alive);
        let (skipped, late) = (std::mem::take(&mut self.skipped), std::mem::take(&mut self.late));
        let power = *self.dog.step(&Inputs { reset: Some(&self.reset), commands, skipped, late });
        self.reset.supply = u64::from(power.on == 1 && self.relay_works);
        assert_eq!(power.on == 1, self.dog.supply() == Supply::On);
        assert!(power.on == 0 || power.reason == 0);
        power.on == 1
    }

    fn pause(&mut self) {
        for _ in 0..watchdog_pause() {
            self.step(&[]);
        }
    }

    fn on() -> Self {
        let mut rig = Self::new();
        rig.step(&[]);
        assert!(!rig.step(&[Command::Reset]));
        assert!(rig.step(&[Command::Enable]));
        rig
    }

    fn reason(&self) -> EventCode {
        match self.dog.supply() {
            Supply::Off(reason) => reason,
            other => panic!("{other:?}"),
        }
    }
}

fn watchdog_pause() -> u32 {
    watchdog::PAUSE + 1
}

#[test]
fn starts_off_and_needs_both_edges_in_order() {
    let mut rig = Rig::new();
    assert!(!rig.step(&[]));
    assert!(!rig.step(&[Command::Enable]), "enable alone");
    rig.pause();
    assert!(!rig.step(&[Command::Reset]), "reset alone");
    assert!(rig.step(&[Command::Enable]));
    // Both in one cycle, in this order, are two edges; in the other order they are not.
    let mut rig = Rig::new();
    rig.step(&[]);
    assert!(rig.step(&[Command::Reset, Command::Enable]));
    let mut rig = Rig::new();
    rig.step(&[]);
    assert!(!rig.step(&[Command::Enable, Command::Reset]));
}

#[test]
fn silence_cuts_after_the_limit_and_stays_cut() {
    let mut rig = Rig::on();
    rig.alive = false;
    for missed in 1..LIMIT {
        assert!(rig.step(&[]), "cycle {missed} without a reset is within the limit");
    }
    assert!(!rig.step(&[]));
    assert_eq!(rig.reason(), EventCode::ResetMissed);
    // Life returns, power does not.
    rig.alive = true;
    for _ in 0..10_000 {
        assert!(!rig.step(&[]));
    }
    assert!(!rig.step(&[Command::Reset]));
    assert!(rig.step(&[Command::Enable]));
}

/// A core that stands still for 1.4 ms: the watchdog looks 0.9 ms late, once more in time while the joint loop is at work,
/// and then hears it. A limit of 2 cycles cut the supply there.
#[test]
fn one_late_look_is_no_evidence_against_the_joint_loop() {
    let mut rig = Rig::on();
    for _ in 0..100 {
        (rig.alive, rig.late) = (false, true);
        assert!(rig.step(&[]));
        for _ in 1..LIMIT {
            assert!(rig.step(&[]));
        }
        rig.alive = true;
        assert!(rig.step(&[]));
    }
    // A watchdog that is always late is not patient for ever.
    rig.alive = false;
    for _ in 0..LIMIT {
        rig.late = true;
        assert!(rig.step(&[]));
    }
    rig.late = true;
    assert!(!rig.step(&[]));
    assert_eq!(rig.reason(), EventCode::ResetMissed);
}

#[test]
fn no_power_while_the_joint_loop_is_silent() {
    let mut dog = Watchdog::new(LIMIT, QUIET);
    for _ in 0..1000 {
        let commands = &[Command::Reset, Command::Enable];
        let power = dog.step(&Inputs { reset: None, commands, ..Inputs::default() });
        assert_eq!((power.on, power.toggle), (0, 0));
    }
}

#[test]
fn trip_request_and_emergency_stop_cut_at_once() {
    let mut rig = Rig::on();
    rig.reset.trip = EventCode::FollowingError as u64;
    assert!(!rig.step(&[]));
    assert_eq!(rig.reason(), EventCode::FollowingError);
    // As long as the request stands, nothing helps.
    rig.pause();
    assert!(!rig.step(&[Command::Reset, Command::Enable]));
    assert_eq!(rig.reason(), EventCode::FollowingError, "the first reason is kept");

    let mut rig = Rig::on();
    assert!(!rig.step(&[Command::EmergencyStop]));
    assert_eq!(rig.reason(), EventCode::EmergencyStop);

    let mut rig = Rig::on();
    rig.reset.trip = EventCode::Ended as u64;
    assert!(!rig.step(&[]));
    assert_eq!(rig.reason(), EventCode::Ended, "an orderly end is none that was missed");

    let mut rig = Rig::on();
    rig.reset.trip = 123_456;
    assert!(!rig.step(&[]), "a trip that is no code is a trip");
}

#[test]
fn an_emergency_stop_beats_the_commands_around_it() {
    let mut rig = Rig::new();
    rig.step(&[]);
    assert!(!rig.step(&[Command::Reset, Command::Enable, Command::EmergencyStop]));
    assert!(!rig.step(&[Command::Enable]));
}

#[test]
fn a_held_button_does_not_re_arm() {
    let mut rig = Rig::on();
    let held = [Command::Reset, Command::Enable];
    // Held while on: no effect, and no edge later.
    for _ in 0..1000 {
        assert!(rig.step(&held));
    }
    rig.step(&[Command::EmergencyStop]);
    for k in 0..10_000u32 {
        assert!(!rig.step(if k % 100 == 0 { &held } else { &[] }), "cycle {k}");
    }
    rig.pause();
    assert!(rig.step(&held));
}

/// Regression: a watchdog that was stopped for 100 ms went on as if nothing had been, and so did the supply, which had
/// fallen meanwhile.
#[test]
fn a_watchdog_that_missed_its_own_cycles_trips_itself() {
    for skipped in 0..200 {
        let mut rig = Rig::on();
        rig.skipped = skipped;
        let on = rig.step(&[]);
        assert_eq!(on, skipped < u64::from(QUIET), "{skipped} cycles missed");
        if !on {
            assert_eq!(rig.reason(), EventCode::WatchdogSilent);
            assert!((0..1000).all(|_| !rig.step(&[])), "it comes back by edges only");
            assert!(!rig.step(&[Command::Reset]) && rig.step(&[Command::Enable]));
        }
    }
}

/// A machine that stands still for two cycles stops watchdog and joint loop alike, and the watchdog wakes first.
#[test]
fn a_joint_loop_is_not_blamed_for_what_both_missed() {
    let mut rig = Rig::on();
    (rig.alive, rig.skipped) = (false, 2);
    assert!(rig.step(&[]));
    rig.alive = true;
    assert!((0..100).all(|_| rig.step(&[])));
}

/// A relay that fell by itself, a fuse, a switch in the line: nothing comes back when it is closed again.
#[test]
fn a_supply_that_is_measured_off_is_off() {
    let mut rig = Rig::on();
    rig.step(&[]);
    rig.reset.supply = 0;
    assert!(!rig.step(&[]));
    assert_eq!(rig.reason(), EventCode::SupplyLost);
    assert!((0..1000).all(|_| !rig.step(&[])));

    let mut rig = Rig::new();
    rig.relay_works = false;
    rig.step(&[Command::Reset, Command::Enable]);
    let cycles = (0..10_000).take_while(|_| rig.step(&[])).count();
    assert_eq!(cycles, 500, "a relay that does not close is given half a second");
    assert_eq!(rig.reason(), EventCode::SupplyLost);
}

/// A supply that is on although it is off here was armed by somebody else: it is not taken over.
#[test]
fn a_closed_relay_is_not_armed() {
    let mut rig = Rig::new();
    rig.step(&[]);
    rig.reset.supply = 1;
    assert!(!rig.step(&[Command::Reset, Command::Enable]));
    rig.pause();
    assert!(!rig.step(&[]));
    assert!(rig.step(&[Command::Enable]));
}

#[test]
fn every_pair_of_edges_has_its_own_number() {
    let mut rig = Rig::new();
    let mut numbers = Vec::new();
    for _ in 0..5 {
        rig.pause();
        rig.step(&[Command::EmergencyStop]);
        rig.step(&[Command::Reset, Command::Enable]);
        numbers.push(rig.dog.step(&Inputs { reset: Some(&rig.reset), ..Inputs::default() }).arming);
    }
    assert_eq!(numbers, [1, 2, 3, 4, 5]);
}

#[test]
fn a_restarted_joint_loop_is_alive() {
    let mut rig = Rig::on();
    // Counts its ticks from the start again, with a new epoch.
    rig.reset.header.epoch += 1;
    rig.reset.header.tick = 0;
    assert!(rig.step(&[]));
}

#[test]
fn toggle_moves_only_while_on() {
    let mut rig = Rig::on();
    let mut last = rig.dog.step(&Inputs { reset: Some(&rig.reset), ..Inputs::default() }).toggle;
    for _ in 0..100 {
        rig.reset.header.tick += 1;
        let toggle = rig.dog.step(&Inputs { reset: Some(&rig.reset), ..Inputs::default() }).toggle;
        assert_eq!(toggle, last + 1);
        last = toggle;
    }
    for _ in 0..100 {
        let commands = &[Command::EmergencyStop];
        let input = Inputs { reset: Some(&rig.reset), commands, ..Inputs::default() };
        assert_eq!(rig.dog.step(&input).toggle, last);
    }
}

/// One cycle of a random history: (joint loop alive, trip, commands).
type Cycle = (bool, u64, Vec<Command>);

fn history() -> impl Strategy<Value = Vec<Cycle>> {
    let command = prop_oneof![
        3 => Just(Command::Reset),
        3 => Just(Command::Enable),
        1 => Just(Command::EmergencyStop),
        1 => Just(Command::Start),
    ];
    let cycle = (
        prop::bool::weighted(0.9),
        prop_oneof![20 => Just(0u64), 1 => any::<u64>(), 1 => 0..30u64],
        prop::collection::vec(command, 0..4),
    );
    // Runs of quiet cycles between the eventful ones, so that edges happen.
    let quiet = (0..600usize).prop_map(|n| vec![(true, 0, vec![]); n]);
    prop::collection::vec((prop::collection::vec(cycle, 0..4), quiet), 1..20)
        .prop_map(|parts| parts.into_iter().flat_map(|(a, b)| a.into_iter().chain(b)).collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Checked against the plain rule, kept apart from the implementation: power goes on only in a cycle with an
    /// Enable, after a Reset, with no trip, silence or emergency stop since that Reset, and never in a held button.
    #[test]
    fn no_way_on_without_both_edges(history in history()) {
        let mut rig = Rig::new();
        let mut was_on = false;
        // Cycles since the last Reset and Enable commands; whether a Reset edge stands.
        let (mut since_reset, mut since_enable) = (u32::MAX / 2, u32::MAX / 2);
        let mut reset_stands = false;
        rig.step(&[]);
        let mut silent = 0;
        for (alive, trip, commands) in history {
            rig.alive = alive;
            rig.reset.trip = trip;
            let on = rig.step(&commands);
            silent = if alive { 0 } else { silent + 1 };
            (since_reset, since_enable) = (since_reset + 1, since_enable + 1);
            let fault = trip != 0 || silent >= LIMIT;
            if fault {
                reset_stands = false;
                prop_assert!(!on, "on with trip {trip} after {silent} silent cycles");
            }
            let mut may_switch_on = false;
            for command in &commands {
                match command {
                    Command::EmergencyStop => { reset_stands = false; may_switch_on = false; }
                    Command::Reset => {
                        reset_stands |= since_reset >= watchdog::PAUSE && !fault;
                        since_reset = 0;
                    }
                    Command::Enable => {
                        may_switch_on |= since_enable >= watchdog::PAUSE && reset_stands && !fault;
                        since_enable = 0;
                    }
                    _ => {}
                }
            }
            if commands.contains(&Command::EmergencyStop) && !may_switch_on {
                prop_assert!(!on, "on in the cycle of an emergency stop");
            }
            if on && !was_on {
                prop_assert!(may_switch_on, "on without both edges");
            }
            was_on = on;
        }
    }
}
