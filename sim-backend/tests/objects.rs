//! Lola on objects: gap and normal force, friction of an object, an object that wants to vanish while it is stood on.

use crate::rig::{Rig, lola};
use config::method::Integrator;
use environment::{Environment, Mesh, Object, ObjectEvent, Pose, Schedule};

/// A board of 5 mm under both feet or under the right one, which stands on it.
fn on_board(depth: u8, both: bool, friction: Option<f64>, vanishes: f64) -> Rig {
    const THICK: f64 = 0.005;
    let (size, y) = if both { ([1.0, 1.0, THICK], 0.0) } else { ([1.0, 0.5, THICK], -0.25) };
    let schedule = Schedule::new(0.0, vanishes, Pose::new([0.0, y, 0.5 * THICK], [0.0; 3]), &[]);
    let board = Object::new("board", Mesh::cuboid(size).unwrap(), friction, schedule);
    let mut rig = Rig::of(lola(), depth, Environment::new(vec![board]));
    rig.x[2] += THICK;
    rig
}

/// 5 mm under one foot, joints held: every loaded node is at the height of what is below it, and all carry the weight.
#[test]
fn a_board_under_one_foot() {
    for depth in [1, 2] {
        let mut rig = on_board(depth, false, None, f64::INFINITY);
        rig.run(Integrator::SemiImplicit, 0.0, 20.0, 20_000);
        let s = rig.snapshot(0.0);
        let weight = rig.plant.model().mass() * 9.81;
        let [right, left] = s.foot_wrench.map(|w| w.force[2]);
        assert!((right + left - weight).abs() < 0.01, "type {depth}: {right} + {left} N");
        assert!(right > 50.0 && left > 50.0, "type {depth}: {right}, {left} N");
        let x = rig.x.clone();
        let layer = rig.plant.layout().layer().start;
        let mut loaded = [0, 0];
        for (i, node) in rig.nodes(0.0, &x).into_iter().enumerate() {
            let ground = if node.y < 0.0 { 0.005 } else { 0.0 };
            assert!(node.z > ground - 1e-6, "type {depth}: node {i} is {} m deep", ground - node.z);
            if x[layer + 3 * i + 2] > 1e-5 {
                assert!((node.z - ground).abs() < 1e-6, "type {depth}: node {i} at {} m", node.z);
                loaded[usize::from(node.y > 0.0)] += 1;
            }
        }
        assert!(loaded[0] >= 3 && loaded[1] >= 3, "type {depth}: {loaded:?} nodes");
    }
}

/// A push of a tenth of the weight: on ice of friction 0.05 the feet slide, and friction takes that share of the weight
/// and no more; on a board like the ground they stay.
#[test]
fn friction_of_an_object() {
    let slide = |friction| {
        let mut rig = on_board(1, true, friction, f64::INFINITY);
        rig.run(Integrator::SemiImplicit, 0.0, 2.0, 4000);
        let m = rig.plant.model().mass();
        rig.inputs.forces.push = [0.1 * m * 9.81, 0.0, 0.0];
        let before = rig.snapshot(0.0).feet[0][0];
        rig.run(Integrator::SemiImplicit, 0.0, 0.2, 2000);
        let s = rig.snapshot(0.0);
        let tangential: f64 = s.foot_wrench.iter().map(|w| w.force[0]).sum();
        let normal: f64 = s.foot_wrench.iter().map(|w| w.force[2]).sum();
        (s.feet[0][0] - before, tangential / normal)
    };
    let (way, share) = slide(Some(0.05));
    assert!((share + 0.05).abs() < 1e-6, "friction {share}");
    // Between full friction at once and none, by Newton.
    let free = 0.5 * 9.81 * 0.2 * 0.2;
    assert!((0.005 * free..0.1 * free).contains(&way), "{way} m");
    let (way, share) = slide(None);
    assert!(way.abs() < 1e-3 && share > -0.6, "{way} m, {share}");
}

#[test]
fn what_is_stood_on_does_not_vanish() {
    for depth in [1, 4] {
        let mut rig = on_board(depth, true, None, 0.01);
        let x = rig.x.clone();
        rig.rate(0.0, &x);
        assert_eq!(rig.plant.advance(0.02), [ObjectEvent::Refused(0)], "type {depth}");
        rig.rate(0.0, &x);
        assert_eq!(rig.plant.advance(0.03), [], "type {depth}: said once");
        let mut lifted = x;
        lifted[2] += 0.1;
        rig.rate(0.0, &lifted);
        let events = rig.plant.advance(0.05).to_vec();
        assert!(events.contains(&ObjectEvent::Vanished(0)), "type {depth}: {events:?}");
    }
}

/// What a force sensor feels of the foot below it: its weight while the robot stands, nothing while it falls freely.
#[test]
fn inertia_below_the_force_sensors() {
    let sensors = |rig: &Rig| {
        let frame = |i: usize| {
            let foot = &rig.robot.feet[i];
            rig.plant.model().frame(&foot.sensor_link, foot.sensor).unwrap()
        };
        [frame(0), frame(1)]
    };
    for depth in [1, 2, 3] {
        let mut rig = Rig::new(depth);
        rig.run(Integrator::SemiImplicit, 0.0, 10.0, 40_000);
        rig.snapshot(0.0);
        let frames = sensors(&rig);
        let [right, left] = rig.plant.carried(&frames).map(|w| w.force[2].abs() / 9.81);
        assert!(
            (right - left).abs() < 0.01 && (0.3..3.0).contains(&right),
            "type {depth}: {right}, {left} kg"
        );
        let mut rig = Rig::new(1).in_the_air();
        let before = rig.x.clone();
        rig.run(Integrator::Euler, 0.0, 1e-3, 1);
        rig.plant.note_step(1e-3, &before, &rig.x);
        rig.snapshot(0.0);
        for wrench in rig.plant.carried(&frames) {
            let felt =
                wrench.force.into_iter().chain(wrench.moment).fold(0.0, |most, x| f64::max(most, x.abs()));
            assert!(felt < 1e-9, "{wrench:?}");
        }
    }
}
