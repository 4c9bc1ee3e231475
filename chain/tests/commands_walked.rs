//! Velocities at the corners of what is accepted: walked, or taken back to what can be walked, and told.

use chain::{Chain, parallel};
use config::method::{Integrator, Method};
use config::{Setup, root};
use messages::command::VelocityCommand;
use messages::{Command, Detail, EventCode};

/// \[s\] The command, and the end of the walk.
const TIMES: [f64; 2] = [3.0, 13.0];

/// \[m/s, m/s, rad/s\] Drawn from the corners of the ranges of Lola's gait; all were accepted, and all but one felled her.
const VELOCITIES: [[f64; 3]; 8] = [
    [-0.249, -0.137, 0.0],
    [0.389, -0.173, 0.314],
    [0.0, -0.144, -0.337],
    [0.130, 0.176, -0.277],
    [0.233, 0.166, -0.127],
    [0.402, 0.186, 0.210],
    [0.0, -0.275, 0.0],
    [-0.016, -0.233, -0.194],
];

/// Walks at this velocity, with sensors that err; whether she fell, and the steps that she said she would walk instead.
fn walk([forward, left, turn]: [f64; 3]) -> (bool, Vec<Detail>) {
    let mut setup = Setup::load(&root(None), "walk_2kmh_sensors").unwrap();
    setup.scene.choose(Method { depth: 1, integrator: Integrator::Euler, substeps: 1 });
    setup.scene.commands.retain(|(_, command)| *command == Command::Stand);
    let mut chain = Chain::new(&setup).unwrap();
    let [begin, end] = TIMES.map(|time| (time / chain.cycle()) as u64);
    let mut told = Vec::new();
    for tick in 0..end {
        if tick == begin {
            chain.command(&Command::Velocity(VelocityCommand { forward, left, turn }));
        }
        let c = chain.step();
        told.extend(c.events.iter().filter(|e| e.1 == EventCode::CommandShortened).map(|e| e.2));
        if c.sim_state.fallen == 1 || c.refused > 0 {
            return (true, told);
        }
    }
    (chain.step().power.on == 0, told)
}

/// `an accepted command can be walked`: ranges hold together, and what is taken back is told, once.
#[test]
fn velocities_at_the_corners_of_the_ranges_are_walked_or_taken_back() {
    let walked = parallel::map(VELOCITIES.len(), |k| walk(VELOCITIES[k]));
    for (velocity, (fell, told)) in VELOCITIES.iter().zip(walked) {
        assert!(!fell, "{velocity:?}, steps {told:?}");
        let [Detail::Steps { length, side, turn, duration }] = told[..] else {
            panic!("{velocity:?}: {told:?}");
        };
        // In the same direction: all by one factor, of which rounding to millimetres leaves something.
        let walks = [length, side, turn].map(|x| f64::from(x) / f64::from(duration));
        let share = (walks[0] * velocity[0] + walks[1] * velocity[1] + walks[2] * velocity[2])
            / velocity.iter().map(|x| x * x).sum::<f64>();
        assert!(share > 0.3 && share < 1.0, "{velocity:?}: {share}");
        let off = (0..3).map(|i| (walks[i] - share * velocity[i]).abs()).fold(0.0, f64::max);
        assert!(off < 2e-3, "{velocity:?}: {walks:?}");
    }
}

/// Velocities drawn from the whole ranges, each number by itself, from a seed that nothing was tuned with: all of them are walked.
#[test]
fn velocities_drawn_at_random_are_walked() {
    let limits = Setup::load(&root(None), "walk_2kmh_sensors").unwrap().gait.limits;
    let mut seed = 9001_u64;
    let mut within = |[low, high]: [f64; 2]| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (low + (high - low) * (seed >> 11) as f64 / (1u64 << 53) as f64) / limits.duration[1]
    };
    let drawn: Vec<_> = (0..20).map(|_| [limits.length, limits.side, limits.turn].map(&mut within)).collect();
    let walked = parallel::map(drawn.len(), |k| walk(drawn[k]));
    for (velocity, (fell, told)) in drawn.iter().zip(walked) {
        assert!(!fell, "{velocity:?}, steps {told:?}");
    }
}
