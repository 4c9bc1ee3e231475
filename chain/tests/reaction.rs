//! Steps that react to pushes: they catch her where she would fall, and do nothing to a walk that nobody disturbs.

use chain::Chain;
use config::{Setup, root};
use messages::command::PushCommand;
use messages::{EventCode, GaitState};

/// \[s\] Length of a push, and how long she is watched after it.
const PUSH: f64 = 0.1;
const WATCHED: f64 = 6.0;

fn setup(scene: &str, reacts: bool) -> Setup {
    let mut setup = Setup::load(&root(None), scene).unwrap();
    setup.scene.pushes.clear();
    assert!(setup.gait.reaction.is_some());
    setup.gait.reaction = setup.gait.reaction.filter(|_| reacts);
    setup
}

/// Walks on for [`WATCHED`] after a push of `impulse` \[N s\] at `time` \[s\]; `None` if she falls or stops, otherwise how many
/// steps were changed.
fn pushed(setup: &Setup, time: f64, impulse: [f64; 2]) -> Option<usize> {
    let mut chain = Chain::new(setup).unwrap();
    let (cycle, mut adapted) = (chain.cycle(), 0);
    for tick in 0..((time + PUSH + WATCHED) / cycle) as u64 {
        if tick == (time / cycle) as u64 {
            let [x, y] = impulse.map(|i| i / PUSH);
            chain.push(&PushCommand { force: [x, y, 0.0], duration: PUSH });
        }
        let c = chain.step();
        let changes = |code| matches!(code, EventCode::StepAdapted | EventCode::StepStretched);
        adapted += c.events.iter().filter(|(_, code, _)| changes(*code)).count();
        if c.sim_state.fallen == 1 {
            return None;
        }
    }
    let c = chain.step();
    let walks = GaitState::from(c.controller_state.gait) == GaitState::Walking && c.power.on == 1;
    walks.then_some(adapted)
}

/// Instants \[s\] of a stride of 1.6 s, drawn from a seed.
fn instants(mut seed: u64, count: usize) -> Vec<f64> {
    let mut draw = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..count).map(|_| 8.0 + 1.6 * draw()).collect()
}

/// 0.15 N s/kg to either side, at any time of a stride: more than footholds and times that are fixed bear.
#[test]
fn pushes_to_the_side_are_caught_by_steps() {
    let [with, without] = [true, false].map(|reacts| setup("push", reacts));
    let impulse = 0.15 * with.robot.total_mass;
    let (mut caught, mut fell, mut adapted) = (0, 0, 0);
    for time in instants(11, 6) {
        for side in [impulse, -impulse] {
            if let Some(steps) = pushed(&with, time, [0.0, side]) {
                caught += 1;
                adapted += usize::from(steps > 0);
            }
            fell += usize::from(pushed(&without, time, [0.0, side]).is_none());
        }
    }
    assert_eq!(caught, 12, "{adapted} of them with steps that were changed");
    assert!(fell >= 3 && adapted >= fell, "{fell} fall without reaction, {adapted} needed one");
}

/// Nobody pushes: bit for bit the same walk, whether she would react or not. Ideal and erring sensors, types 1 and 3.
#[test]
fn a_walk_that_nobody_disturbs_is_the_same_with_the_reaction_armed() {
    for scene in [
        "walk_2kmh",
        "walk_2kmh_sensors",
        "walk_2kmh_type3",
        "can_2kmh",
        "walk_tables",
        "bus_faults",
        "startup",
    ] {
        let walked = [true, false].map(|reacts| {
            let mut chain = Chain::new(&setup(scene, reacts)).unwrap();
            (0..(14.0 / chain.cycle()) as u64).for_each(|_| _ = chain.step());
            let angles = chain.step().joint_targets.angle.map(f64::to_bits);
            (angles, chain.robot().integrated().to_vec())
        });
        assert!(walked[0] == walked[1], "{scene}");
    }
}
