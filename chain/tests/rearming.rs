//! Power off in mid-motion, then a reset and an enable edge, and nothing else: the robot stays as it is.
//!
//! Regression: the plan went on while the power was off, and the joints chased it with 11.5 rad/s when it came back.

use chain::Chain;
use config::method::Integrator;
use config::{Setup, root};
use messages::Command;

/// Instants of the five scenes together.
const INSTANTS: usize = 100;
/// \[rad/s\]
const STILL: f64 = 0.05;
/// Share of the weight by which a foot's load differs from that of a robot that stays without power.
const LOAD: f64 = 0.1;
/// \[rad\] From this inclination on a robot without power topples.
const TOPPLES: f64 = 0.2;
/// Cycles watched after the supply is on again.
const WATCHED: u64 = 2000;

struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }
}

/// Largest joint speed \[rad/s\] and largest difference of a foot's load [weights] after the supply is on again.
fn enabled_again(chain: &Chain, pause: u64, weight: f64) -> (f64, f64) {
    let mut off = chain.clone();
    off.command(&Command::EmergencyStop);
    for _ in 0..pause {
        off.step();
    }
    assert_eq!(off.robot().state().power, 0, "the emergency stop acts");
    let mut on = off.clone();
    on.command(&Command::Reset);
    for _ in 0..20 {
        on.step();
        off.step();
    }
    on.command(&Command::Enable);
    let (mut speed, mut load, mut was_on, mut topples) = (0.0f64, 0.0f64, false, false);
    let mut before = *on.robot().state();
    for cycle in 0..WATCHED {
        let (now, twin) = (on.step().sim_state, off.step().sim_state);
        was_on |= now.power == 1;
        assert!(now.power == 1 || cycle < 10, "the supply is on, and stays on");
        for (a, b) in before.joint_angle.iter().zip(&now.joint_angle) {
            speed = speed.max(((b - a) / on.cycle()).abs());
        }
        // Two that topple for want of power meet the ground each in its own way.
        let [x, y, ..] = twin.orientation;
        topples |= 1.0 - 2.0 * (x * x + y * y) < TOPPLES.cos();
        for (a, b) in now.foot_wrench.iter().zip(&twin.foot_wrench).filter(|_| !topples) {
            load = load.max((a.force[2] - b.force[2]).abs() / weight);
        }
        before = now;
    }
    assert!(was_on);
    (speed, load)
}

/// `count` random instants of a scene, each in its own copy of one run; a fallen robot is not one of them.
fn scene(name: &str, count: usize, seed: u64) -> Vec<(f64, f64)> {
    let mut setup = Setup::load(&root(None), name).unwrap();
    // Joints that follow their targets: what moves was told to. A motor that takes over from its brake yields a little.
    (setup.scene.depth, setup.scene.integrator) = (1, Integrator::Euler);
    let weight = setup.robot.total_mass * 9.81;
    let cycles = (setup.scene.duration / setup.scene.cycle) as u64;
    let mut random = Random(seed);
    let mut at: Vec<u64> = (0..count).map(|_| 300 + random.below(cycles - 600)).collect();
    at.sort_unstable();
    let mut chain = Chain::new(&setup).unwrap();
    let mut found = Vec::new();
    for instant in at {
        while chain.tick() < instant {
            chain.step();
        }
        let pause = 50 + random.below(1450);
        let (speed, load) = enabled_again(&chain, pause, weight);
        println!("{name} tick {instant:6} pause {pause:5}: {speed:.4} rad/s, {load:.4} weights");
        found.push((speed, load));
    }
    found
}

#[test]
fn enabling_again_at_random_instants_moves_nothing() {
    let scenes = ["walk_1kmh", "walk_2kmh", "walk_curve", "platform", "stand"];
    let found: Vec<(f64, f64)> = std::thread::scope(|s| {
        let threads: Vec<_> = scenes
            .iter()
            .zip(1..)
            .map(|(name, seed)| s.spawn(move || scene(name, INSTANTS / scenes.len(), seed)))
            .collect();
        threads.into_iter().flat_map(|t| t.join().unwrap()).collect()
    });
    let worst = found.iter().fold((0.0f64, 0.0f64), |w, x| (w.0.max(x.0), w.1.max(x.1)));
    println!("{} instants: at most {:.4} rad/s, {:.4} weights", found.len(), worst.0, worst.1);
    assert_eq!(found.len(), INSTANTS);
    assert!(found.iter().all(|(speed, load)| *speed < STILL && *load < LOAD), "{worst:?}");
}
