//! Every order of what two operators send, what stalls and what dies, up to some steps: the real admission, lease, age,
//! walk lease, watchdog and relay together, explored depth first.
//!
//! Between them is a model of the ways: a stream per operator, which waits while the broker stands still and is lost when
//! it dies; a queue to each process, which waits while that process stands still; and a lease that a process knows only
//! once its courier has run. Beside them stand plain rules that share nothing with what they judge, not even the constants.

mod world;

use std::collections::HashMap;

use messages::Command;
use world::{Broken, Broker, FIRST, Frame, ON_THE_WAY, Process, SECOND, STEPS, WALK, World};

/// Steps of a history, and how often something stands still, hurries or dies in it; `GANGWERK_STEPS` and
/// `GANGWERK_STALLS` say other numbers.
const DEPTH: (u8, u8) = (5, 1);

/// The search: depth first, with a memory of what was explored how deep.
struct Search {
    /// Steps and faults that were left when a state was explored, by state.
    seen: HashMap<u64, (u8, u8)>,
    histories: u64,
    sent: Vec<[Option<Frame>; 2]>,
    runs: Vec<(u8, (Broker, Process, Process))>,
    fault: Option<&'static str>,
}

impl Search {
    /// Every history of so many steps in which at most so many times something stands still, hurries or dies.
    fn explore(broken: Broken, (steps, faults): (u8, u8)) -> Self {
        let sent = FIRST.iter().map(|f| [*f, None]).chain(SECOND[1..].iter().map(|s| [None, *s])).collect();
        let mut runs = Vec::new();
        let processes = [(0, Process::Runs), (1, Process::Hurries), (1, Process::Stops)];
        for (a, broker) in [(0, Broker::Runs), (1, Broker::Stops), (1, Broker::Dies)] {
            for (b, planner) in processes {
                runs.extend(processes.map(|(c, dog)| (a + b + c, (broker, planner, dog))));
            }
        }
        let mut search = Self { seen: HashMap::new(), histories: 0, sent, runs, fault: None };
        search.go_on(&World::new(broken), steps, faults);
        search
    }

    fn go_on(&mut self, world: &World, steps: u8, faults: u8) {
        let done = self.seen.entry(world.key()).or_default();
        if steps == 0 || (done.0 >= steps && done.1 >= faults) {
            return;
        }
        *done = (steps, faults);
        for i in 0..self.sent.len() {
            let frames = self.sent[i];
            if (0..2).any(|i| frames[i].is_some() && world.operators[i].wire.len() >= ON_THE_WAY) {
                continue;
            }
            for j in 0..self.runs.len() {
                let (cost, runs) = self.runs[j];
                for ticks in STEPS.into_iter().filter(|_| cost <= faults) {
                    let mut world = world.clone();
                    self.histories += 1;
                    if let Err(fault) = world.step(ticks, frames, runs) {
                        self.fault = Some(fault);
                    }
                    if self.fault.is_none() {
                        self.go_on(&world, steps - 1, faults - cost);
                    }
                    if self.fault.is_some() {
                        println!("{steps} steps before the end: {ticks} ticks, {frames:?}, {runs:?}");
                        return;
                    }
                }
            }
        }
    }
}

fn bounds() -> (u8, u8) {
    let number = |name: &str| std::env::var(name).ok().and_then(|n| n.parse().ok());
    (number("GANGWERK_STEPS").unwrap_or(DEPTH.0), number("GANGWERK_STALLS").unwrap_or(DEPTH.1))
}

#[test]
fn nothing_moves_without_the_lease_and_no_stop_is_lost() {
    let search = Search::explore(Broken::Nothing, bounds());
    println!("{} states, {} histories, {:?}", search.seen.len(), search.histories, bounds());
    assert_eq!(search.fault, None);
    assert!(search.seen.len() > 10_000, "these are not all");
}

#[test]
fn the_search_finds_what_is_broken_on_purpose() {
    for (broken, found) in [
        (Broken::Age, "an old command took effect"),
        (Broken::Lease, "it walks for somebody who is gone"),
        (Broken::Stop, "an emergency stop was lost"),
    ] {
        let search = Search::explore(broken, (6, 1));
        println!("{broken:?}: {:?} among {} states", search.fault, search.seen.len());
        assert_eq!(search.fault, Some(found), "{broken:?}");
    }
}

/// Without this, nothing of the above says anything.
#[test]
fn the_robot_walks_at_all() {
    let mut world = World::new(Broken::Nothing);
    let all = (Broker::Runs, Process::Runs, Process::Runs);
    for command in [Command::Stop, Command::Reset, Command::Enable, WALK] {
        world.step(1, [Some(Frame::Command(command)), None], all).unwrap();
    }
    assert!(world.walking && world.relay.is_closed());
    world.step(8, [None, None], all).unwrap();
    assert!(world.walking, "for as long as the lease lasts");
    world.step(1, [None, None], all).unwrap();
    assert!(!world.walking);
}
