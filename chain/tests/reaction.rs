//! Steps that react to pushes: they catch her where she would fall, and do nothing to a walk that nobody disturbs.

use chain::Chain;
use config::{Setup, root};
use messages::command::{DistanceCommand, PushCommand};
use messages::{Command, EventCode, GaitState};
use std::f64::consts::PI;

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

/// Walks, or stands, as before [`WATCHED`] after a push of `impulse` \[N s\] at `time` \[s\]; `None` if she does not, otherwise how
/// many steps were changed.
fn pushed(setup: &Setup, time: f64, impulse: [f64; 2]) -> Option<usize> {
    let mut chain = Chain::new(setup).unwrap();
    let (cycle, mut adapted, mut gait) = (chain.cycle(), 0, GaitState::Idle);
    let at = (time / cycle) as u64;
    for tick in 0..((time + PUSH + WATCHED) / cycle) as u64 {
        if tick == at {
            let [x, y] = impulse.map(|i| i / PUSH);
            chain.push(&PushCommand { force: [x, y, 0.0], duration: PUSH });
        }
        let c = chain.step();
        if tick < at {
            gait = GaitState::from(c.controller_state.gait);
        }
        let changes = |code| matches!(code, EventCode::StepAdapted | EventCode::StepStretched);
        adapted += c.events.iter().filter(|(_, code, _)| changes(*code)).count();
        if c.sim_state.fallen == 1 {
            return None;
        }
    }
    let c = chain.step();
    let as_before = GaitState::from(c.controller_state.gait) == gait && c.power.on == 1;
    as_before.then_some(adapted)
}

/// Numbers from 0 to 1, drawn from a seed.
fn draw(seed: u64) -> impl Iterator<Item = f64> {
    let next =
        |x: &u64| Some(x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407));
    std::iter::successors(Some(seed), next).skip(1).map(|x| (x >> 11) as f64 / (1u64 << 53) as f64)
}

/// Instants \[s\] of a stride of 1.6 s, drawn from a seed.
fn instants(seed: u64, count: usize) -> Vec<f64> {
    draw(seed).take(count).map(|x| 8.0 + 1.6 * x).collect()
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

/// 0.38 N s/kg backward at 2 km/h, up to 10 degrees to either side, felt while both feet carry: 0.35 is demanded at any time.
#[test]
fn pushes_back_are_caught_from_double_support() {
    let setup = setup("walk_2kmh", true);
    let mut chain = Chain::new(&setup).unwrap();
    let cycle = chain.cycle();
    let carry = |chain: &mut Chain| (0.05..0.95).contains(&chain.step().controller_state.load_left);
    let times: Vec<f64> =
        (1..(9.6 / cycle) as u64).filter(|_| carry(&mut chain)).map(|tick| tick as f64 * cycle).collect();
    let walked: Vec<f64> = times.into_iter().filter(|time| *time > 8.0).collect();
    let draws: Vec<f64> = draw(23).take(24).collect();
    let caught = draws.chunks(2).filter(|x| {
        let time = walked[(x[0] * walked.len() as f64) as usize] - 0.5 * PUSH;
        let angle = PI + (2.0 * x[1] - 1.0) * 0.17;
        let impulse = [angle.cos(), angle.sin()].map(|share| share * 0.38 * setup.robot.total_mass);
        pushed(&setup, time, impulse).is_some_and(|steps| steps > 0)
    });
    assert_eq!(caught.count(), 12);
}

/// 0.55 N s/kg forward and 0.4 backward, up to 10 degrees to either side: more than her soles can hold while she stands. She steps
/// out, and stands again. What they can hold, from anywhere, moves no foot.
#[test]
fn a_standing_robot_that_is_pushed_steps_out() {
    let [with, without] = [true, false].map(|reacts| setup("stand", reacts));
    let push = |per_kg: f64, angle: f64| {
        [angle.cos(), angle.sin()].map(|share| share * per_kg * with.robot.total_mass)
    };
    let (mut caught, mut fell) = (0, 0);
    for (k, x) in draw(5).take(12).enumerate() {
        let (per_kg, ahead) = if k % 2 == 0 { (0.55, 0.0) } else { (0.4, PI) };
        let impulse = push(per_kg, ahead + (2.0 * x - 1.0) * 0.17);
        caught += usize::from(pushed(&with, 6.0, impulse).is_some_and(|steps| steps > 0));
        fell += usize::from(pushed(&without, 6.0, impulse).is_none());
    }
    assert_eq!((caught, fell), (12, 12));
    for x in draw(6).take(8) {
        assert_eq!(pushed(&with, 6.0, push(0.2, 2.0 * PI * x)), Some(0));
    }
}

/// Regression: after a distance that she had walked to its end she stood like a post, and fell.
#[test]
fn who_has_walked_a_distance_steps_out_as_well() {
    let mut setup = setup("stand", true);
    let distance = DistanceCommand { distance: 0.5, speed: 0.25, acceleration: 0.3 };
    setup.scene.commands.push((4.0, Command::Distance(distance)));
    let mass = setup.robot.total_mass;
    for x in draw(7).take(3) {
        let angle: f64 = (2.0 * x - 1.0) * 0.17;
        let impulse = [angle.cos(), angle.sin()].map(|share| share * 0.55 * mass);
        assert!(pushed(&setup, 14.0 + x, impulse).is_some_and(|steps| steps > 0), "{angle}");
    }
}

/// More commands in a cycle than the planner takes in one: all are answered, as by its process.
#[test]
fn commands_beyond_those_of_a_cycle_are_taken_in_the_next_one() {
    let setup = setup("stand", true);
    let mut chain = Chain::new(&setup).unwrap();
    (0..(4.0 / chain.cycle()) as u64).for_each(|_| _ = chain.step());
    (0..40).for_each(|_| chain.command(&Command::Stop));
    let answered: usize = (0..3)
        .map(|_| chain.step().answers.iter().filter(|(command, _)| *command == Command::Stop).count())
        .sum();
    assert_eq!(answered, 40);
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
