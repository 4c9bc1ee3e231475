//! Every order of what an operator says, what drives answer and what breaks, from a robot without power to one that stands:
//! the real joint loop with its start-up, watchdog, relay and drives together, explored to the end.
//!
//! Times are short, so that the world is finite: what a history may be is bounded by nothing but the number of faults in it
//! (`GANGWERK_FAULTS`, 1 by default). `rules.rs` holds what must be true whatever happens.

mod robot;
mod rules;
mod world;

use std::collections::HashMap;
use std::sync::LazyLock;

use config::{Robot, System};
use messages::{Command, StartUp};
use robot::{JOINTS, NEEDED};
use world::{Happens, World};

/// Faults of one history.
const FAULTS: u8 = 1;

static SMALL: LazyLock<(Robot, System)> = LazyLock::new(robot::small);

/// A state that was reached: from which other one, how, with how many faults left.
struct Reached {
    from: u64,
    by: Happens,
    left: u8,
}

/// Every history with at most so many faults, breadth first, those with the fewest faults before the others.
struct Search {
    seen: HashMap<u64, Reached>,
    steps: u64,
    fault: Option<(&'static str, Vec<Happens>)>,
}

impl Search {
    fn explore(faults: u8) -> Self {
        let mut search = Self { seen: HashMap::new(), steps: 0, fault: None };
        let happens = Happens::all();
        let starts = HashMap::from([true, false].map(World::new).map(|w| (w.key(), w)));
        // States to be gone on from: with as many faults as now, and with one more.
        let mut front: Vec<u64> = starts.keys().copied().collect();
        let mut with_less = Vec::new();
        for left in (0..=faults).rev() {
            while !front.is_empty() {
                let mut next = Vec::new();
                for from in front {
                    // A world is large: it is made again from its history.
                    let (start, story) = search.story(from);
                    let mut world = starts[&start].clone();
                    story.iter().for_each(|by| world.step(*by).expect("nothing was wrong with it before"));
                    for &(by, cost) in happens.iter().filter(|(by, cost)| *cost <= left && world.may(*by)) {
                        let mut world = world.clone();
                        search.steps += 1;
                        if let Err(fault) = world.step(by) {
                            search.fault = Some((fault, [story, vec![by]].concat()));
                            return search;
                        }
                        let (key, left) = (world.key(), left - cost);
                        let new = search.seen.get(&key).is_none_or(|reached| reached.left < left);
                        if new && !starts.contains_key(&key) {
                            search.seen.insert(key, Reached { from, by, left });
                            if cost == 0 { next.push(key) } else { with_less.push(key) }
                        }
                    }
                }
                front = next;
            }
            front = std::mem::take(&mut with_less);
            front.retain(|key| search.seen[key].left + 1 == left);
        }
        search
    }

    /// Start of a state's history, and the steps from there.
    fn story(&self, mut key: u64) -> (u64, Vec<Happens>) {
        let mut story = Vec::new();
        while let Some(reached) = self.seen.get(&key) {
            story.push(reached.by);
            key = reached.from;
        }
        story.reverse();
        (key, story)
    }
}

fn faults() -> u8 {
    std::env::var("GANGWERK_FAULTS").ok().and_then(|n| n.parse().ok()).unwrap_or(FAULTS)
}

#[test]
fn nothing_is_led_before_its_time_and_no_stop_is_lost() {
    let search = Search::explore(faults());
    println!("{} states, {} steps, at most {} faults", search.seen.len(), search.steps, faults());
    assert_eq!(search.fault, None);
    assert!(search.seen.len() > 10_000, "these are not all");
}
/// Equality of states, tested: random histories, in which each state is left in each way once, and what comes
/// of it held against what came of it before.
#[test]
fn equal_states_act_alike() {
    let happens = Happens::all();
    let mut random = 1u64;
    let mut below = |n: usize| {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 33) as usize % n
    };
    let mut came = HashMap::new();
    let mut again = 0;
    for history in 0..500 {
        let mut world = World::new(history % 2 == 0);
        for _ in 0..40 {
            // Mostly what an operator does.
            let i = if below(4) > 0 { below(8) } else { below(happens.len()) };
            let (by, _) = happens[i];
            if !world.may(by) {
                continue;
            }
            let before = world.key();
            let fault = world.step(by).err();
            let after = (world.key(), fault);
            if let Some(then) = came.insert((before, i), after) {
                again += 1;
                assert_eq!(then, after, "{by:?} in {}", world.show());
            }
            if fault.is_some() {
                break;
            }
        }
    }
    println!("{} states and ways, {again} met again", came.len());
}

/// Reset and enable; then the joints are led, at once or after homing, and the robot stands once its feet carry.
#[test]
fn the_robot_stands_up_at_all() {
    const ON: Happens = Happens::Said(&[Command::Reset, Command::Enable]);
    const HOME: Happens = Happens::Said(&[Command::Home]);
    const ZERO: Happens = Happens::Said(&[Command::ZeroForce]);
    let calm = |world: &mut World, cycles| (0..cycles).for_each(|_| world.step(Happens::Nothing).unwrap());
    for known in [true, false] {
        let mut world = World::new(known);
        world.step(ON).unwrap();
        calm(&mut world, 5);
        assert_eq!(world.led(), if known { JOINTS } else { 0 });
        if !known {
            assert_eq!(world.start_up(), StartUp::NotHomed);
            world.step(HOME).unwrap();
            calm(&mut world, 10);
            assert_eq!(world.led(), JOINTS);
        }
        assert_eq!(world.start_up(), StartUp::Hanging);
        world.step(ZERO).unwrap();
        calm(&mut world, 4);
        assert_eq!(world.start_up(), StartUp::Zeroed);
        world.step(Happens::Crane).unwrap();
        calm(&mut world, 4);
        assert_eq!(world.start_up(), StartUp::Standing);
        // It goes on without the joint that it spares, and not without one that it needs.
        world.step(Happens::Fault(JOINTS - 1)).unwrap();
        calm(&mut world, 4);
        assert_eq!((world.start_up(), world.led()), (StartUp::Standing, NEEDED));
        world.step(Happens::Fault(0)).unwrap();
        calm(&mut world, 4);
        assert_eq!(world.start_up(), StartUp::Stopped);
    }
}
