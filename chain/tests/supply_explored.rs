//! Every order of edges, stalls, deaths, lost and late records between watchdog, relay and joint loop, up to some cycles: the
//! real steps of watchdog and relay, explored breadth first.
//!
//! Beside them an observer keeps the plain rule, and shares nothing with them: the relay closes only after a reset edge and
//! then an enable edge that came since the watchdog last said off, or since it last fell by itself; a stop that a running watchdog was given is never lost.

use std::collections::HashSet;

use messages::{Command, EventCode, Power, WatchdogReset};
use sim_backend::power::PowerLine;
use watchdog::{Inputs, Supply, Watchdog};

/// Own cycles without a heartbeat, cycles that make an edge, cycles for the relay to close: short, for a small world.
const LIMIT: u32 = 2;
const PAUSE: u32 = 1;
const CLOSING: u32 = 1;
/// Cycles of a history, so that the search is over in seconds; `GANGWERK_DEPTH` says another number.
const DEPTH: usize = 6;
/// Cycles of silence after which the relay falls.
const QUIET: u32 = 3;
/// Times that the watchdog may die and be started again.
const RESTARTS: u64 = 1;

/// Commands that an operator may send within one cycle.
const SAID: [&[Command]; 9] = [
    &[],
    &[Command::Reset],
    &[Command::Enable],
    &[Command::EmergencyStop],
    &[Command::Reset, Command::Enable],
    &[Command::Enable, Command::Reset],
    &[Command::EmergencyStop, Command::Reset, Command::Enable],
    &[Command::Reset, Command::EmergencyStop, Command::Enable],
    &[Command::Reset, Command::Enable, Command::EmergencyStop],
];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Dog {
    Runs,
    RunsLate,
    Stops,
    Dies,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Loop {
    Runs,
    /// It runs, and its record says that something is wrong.
    Trips,
    Stops,
}

/// A relay as it was before it knew of arming numbers, to see the search find what was wrong with it.
#[derive(Clone, Copy)]
enum Relay {
    Real(PowerLine),
    ClosesByItself { toggle: u64, quiet: u32, on: bool },
}

impl Relay {
    fn step(&mut self, power: &Power) -> bool {
        match self {
            Self::Real(line) => line.step(Some(power)),
            Self::ClosesByItself { toggle, quiet, on } => {
                if power.toggle == *toggle {
                    *quiet += 1;
                } else {
                    (*toggle, *quiet, *on) = (power.toggle, 0, power.on == 1);
                }
                *on &= *quiet < 3 && power.on == 1;
                *on
            }
        }
    }
}

/// One state of the world.
#[derive(Clone)]
struct World {
    dog: Watchdog,
    epoch: u64,
    /// Cycles that the watchdog missed since its last one.
    skipped: u64,
    relay: Relay,
    closed: bool,
    /// The newest records, as they lie in shared memory.
    power: Power,
    reset: WatchdogReset,
    /// What the joint loop will measure in its next cycle: the relay a cycle ago.
    measured: u64,
    /// The observer: edges since the relay last opened, each with the cycles since the last of its kind, and whether a stop
    /// was given since then.
    observer: Observer,
    ignores_own_stall: bool,
}

#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
struct Observer {
    since_reset: u32,
    since_enable: u32,
    /// 0: no edge since the relay opened; 1: a reset edge; 2: then an enable edge.
    edges: u8,
    /// A stop was given to a running watchdog, and no pair of edges since.
    stopped: bool,
    /// A living watchdog said on last.
    on: bool,
}

impl Observer {
    fn hear(&mut self, commands: &[Command]) {
        self.since_reset = (self.since_reset + 1).min(PAUSE);
        self.since_enable = (self.since_enable + 1).min(PAUSE);
        for command in commands {
            match command {
                Command::Reset if std::mem::take(&mut self.since_reset) >= PAUSE => {
                    self.edges = self.edges.max(1);
                }
                Command::Enable if std::mem::take(&mut self.since_enable) >= PAUSE && self.edges >= 1 => {
                    (self.edges, self.stopped) = (2, false);
                }
                Command::EmergencyStop => (self.edges, self.stopped) = (0, true),
                _ => {}
            }
        }
    }
}

impl World {
    fn new(relay: Relay, ignores_own_stall: bool) -> Self {
        let far = Observer { since_reset: PAUSE, since_enable: PAUSE, ..Observer::default() };
        Self {
            dog: new_dog(),
            epoch: 1,
            skipped: 0,
            relay,
            closed: false,
            power: Power::default(),
            reset: WatchdogReset::default(),
            measured: 0,
            observer: far,
            ignores_own_stall,
        }
    }

    /// One bus cycle; what the observer has against it.
    fn step(
        &mut self,
        joints: Loop,
        dog: Dog,
        relay_sees: bool,
        said: &'static [Command],
    ) -> Option<&'static str> {
        if joints != Loop::Stops {
            // Only that it is another one matters.
            self.reset.header.tick = 1 - self.reset.header.tick;
            self.reset.supply = self.measured;
            self.reset.trip = if joints == Loop::Trips { EventCode::FollowingError as u64 } else { 0 };
        }
        match dog {
            Dog::Stops => self.skipped += 1,
            Dog::Dies => {
                (self.dog, self.skipped, self.epoch) = (new_dog().restarted(), 0, self.epoch + 1);
                // Its last record counts until the relay has fallen; the next one begins with a pause.
                let Observer { edges, stopped, .. } = self.observer;
                self.observer = Observer { edges, stopped, ..Observer::default() };
            }
            Dog::Runs | Dog::RunsLate => {
                let skipped = if self.ignores_own_stall { 0 } else { std::mem::take(&mut self.skipped) };
                self.observer.hear(said);
                let late = dog == Dog::RunsLate;
                self.power =
                    *self.dog.step(&Inputs { reset: Some(&self.reset), commands: said, skipped, late });
                self.power.header.epoch = self.epoch;
                self.skipped = 0;
                // A trip counts for its whole cycle, an emergency stop from its place among the commands on.
                let told = said.contains(&Command::EmergencyStop);
                if self.observer.on && self.power.on == 0 && !told {
                    self.observer.edges = 0;
                }
                self.observer.on = self.power.on == 1;
            }
        }
        let was = self.closed;
        if relay_sees {
            self.closed = self.relay.step(&self.power);
        }
        self.measured = u64::from(self.closed);
        let fault = match (was, self.closed) {
            (false, true) if self.observer.edges < 2 => Some("closed without both edges since it opened"),
            (_, true) if self.observer.stopped && relay_sees => Some("closed after a stop"),
            _ => None,
        };
        // It fell by itself. Told to, it went off when it was told.
        if was && !self.closed && self.power.on == 1 {
            self.observer.edges = 0;
        }
        fault
    }

    /// All that decides what can happen next, with numbers counted from each other.
    fn key(&self) -> impl std::hash::Hash + Eq + use<> {
        let relay = match self.relay {
            Relay::Real(line) => {
                let (quiet, toggle, (epoch, arming)) = line.state();
                let newer = (self.power.header.epoch, self.power.arming).cmp(&(epoch, arming));
                (quiet, self.power.toggle == toggle, newer, self.epoch > epoch)
            }
            Relay::ClosesByItself { toggle, quiet, .. } => {
                (u64::from(quiet.min(3)), self.power.toggle == toggle, std::cmp::Ordering::Equal, false)
            }
        };
        // For which reason it is off makes no difference, but none is one: nothing was on yet.
        let mut dog = self.dog.state();
        if matches!(dog.supply, Supply::Off(reason) if reason != EventCode::None) {
            dog.supply = Supply::Off(EventCode::SafeStop);
        }
        // Whether the watchdog's next number differs from the one that lies in shared memory.
        let published = (self.power.on, self.power.header.epoch == self.epoch);
        (
            (dog, self.epoch, self.skipped.min(3)),
            (relay, self.closed, published, self.measured),
            (self.reset.header.tick, self.reset.supply, self.reset.trip, self.observer),
        )
    }
}

fn new_dog() -> Watchdog {
    Watchdog::new(LIMIT, QUIET).with_timing(PAUSE, CLOSING)
}

/// Explores until nothing is new, a history is as long as it may be, or a fault is found: states, and the fault with how many cycles lead to it.
fn explore(start: World) -> (usize, Option<(&'static str, usize)>) {
    let mut seen = HashSet::from([start.key()]);
    let mut front = vec![start];
    let mut cycles = 0;
    let deepest = std::env::var("GANGWERK_DEPTH").ok().and_then(|n| n.parse().ok()).unwrap_or(DEPTH);
    while !front.is_empty() && cycles < deepest {
        cycles += 1;
        let mut next = Vec::new();
        for world in &front {
            for joints in [Loop::Runs, Loop::Trips, Loop::Stops] {
                for dog in [Dog::Runs, Dog::RunsLate, Dog::Stops, Dog::Dies] {
                    if dog == Dog::Dies && world.epoch > RESTARTS {
                        continue;
                    }
                    for relay_sees in [true, false] {
                        // A watchdog that does not run hears nothing: too old commands are dropped before they come here.
                        let all =
                            if matches!(dog, Dog::Runs | Dog::RunsLate) { &SAID[..] } else { &SAID[..1] };
                        for said in all {
                            let mut world = world.clone();
                            if let Some(fault) = world.step(joints, dog, relay_sees, said) {
                                println!("{fault}: at last {joints:?} {dog:?} {relay_sees} {said:?}");
                                return (seen.len(), Some((fault, cycles)));
                            }
                            if seen.insert(world.key()) {
                                next.push(world);
                            }
                        }
                    }
                }
            }
        }
        front = next;
    }
    (seen.len(), None)
}

#[test]
fn no_order_of_anything_switches_the_supply_on_by_itself() {
    let (states, fault) = explore(World::new(Relay::Real(PowerLine::falling_after(QUIET)), false));
    println!("{states} states, {fault:?}");
    assert_eq!(fault, None);
    assert!(states > 10_000, "{states} states are not all of them");
}

/// Seen red: the relay that closes as soon as the toggle moves, with a watchdog that ignores its own stall.
#[test]
fn the_search_finds_the_relay_that_closed_by_itself() {
    let relay = Relay::ClosesByItself { toggle: 0, quiet: 0, on: false };
    let (_, fault) = explore(World::new(relay, true));
    let (fault, cycles) = fault.expect("the hole that was there");
    println!("{fault}, after {cycles} cycles");
    assert_eq!(fault, "closed without both edges since it opened");
}

/// The arming number alone keeps the relay open even beside a watchdog that ignores its own stall; without the number a
/// watchdog that notices it is not enough, because the record it writes as it wakes up is still that of before.
#[test]
fn either_half_alone() {
    let (_, fault) = explore(World::new(Relay::Real(PowerLine::falling_after(QUIET)), true));
    assert_eq!(fault, None);
    let relay = Relay::ClosesByItself { toggle: 0, quiet: 0, on: false };
    let (_, fault) = explore(World::new(relay, false));
    println!("{fault:?}");
}

#[test]
fn a_supply_can_be_switched_on_at_all() {
    let mut world = World::new(Relay::Real(PowerLine::falling_after(QUIET)), false);
    world.step(Loop::Runs, Dog::Runs, true, &[]);
    world.step(Loop::Runs, Dog::Runs, true, &[Command::Reset, Command::Enable]);
    assert!(world.closed && world.dog.supply() == Supply::On);
}
