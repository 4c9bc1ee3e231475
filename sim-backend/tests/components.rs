//! Components of the simulated robot: types are sets of them, and what is left out is not computed.

use crate::rig::lola;
use codec::frames::{DriveCommand, decode_sensors, encode_targets};
use config::components::{Components, ContactModel, JointModel, Selection};
use config::method::Integrator;
use config::{Robot, Setup};
use environment::Environment;
use messages::{BusFrames, JointMode, JointTargets, Power, Sensors};
use sim_backend::SimBackend;
use sim_backend::drive::{JointCubic, JointMotion};
use sim_backend::integrate::Stepper;
use sim_backend::plant::{Plant, PlantInputs};
use sim_backend::step_limit::step_limit;

/// Joints of head and arms: they move nothing that stands on the ground.
const UPPER: [&str; 5] =
    ["left_shoulder_flexion", "left_shoulder_adduction", "left_elbow_flexion", "head_pan", "head_tilt"];

/// State after 50 ms in which all joints but `resting` begin to move.
fn moved(
    robot: &Robot,
    components: impl Into<Components>,
    (integrator, steps): (Integrator, u32),
    resting: &[&str],
) -> (Plant, Vec<f64>) {
    let pose = &robot.poses["stand"];
    let mut plant = Plant::new(robot, Environment::flat(), components, pose).unwrap();
    let mut x = plant.standing(pose);
    let cubic = |(j, &q): (usize, &f64)| {
        let way = if resting.contains(&robot.joints[j].name.as_str()) { 0.0 } else { 1e-3 };
        let from = JointMotion { angle: q, ..JointMotion::default() };
        JointCubic::follow(from, q + way * (1.0 + j as f64).sin(), 0.0, 0.05)
    };
    let drives: Vec<JointCubic> = pose.iter().enumerate().map(cubic).collect();
    let mut stepper = Stepper::new(integrator, x.len());
    let h = 0.05 / f64::from(steps);
    for i in 0..steps {
        stepper.step(&mut plant, f64::from(i) * h, h, &mut x, &drives, &PlantInputs::POWERED);
    }
    plant.look(0.05, &x, &drives);
    (plant, x)
}

const IMPLICIT: (Integrator, u32) = (Integrator::SemiImplicit, 100);

#[test]
fn types_are_sets_of_components() {
    let robot = lola();
    let changed = |depth: u8, change: fn(&mut Components)| {
        let mut components = Components::from(depth);
        change(&mut components);
        moved(&robot, components, IMPLICIT, &[]).1
    };
    let elastic = |c: &mut Components| c.elastic = Selection::All(true);
    assert_eq!(changed(2, elastic), moved(&robot, 3, IMPLICIT, &[]).1);
    let on_points = |c: &mut Components| c.contact = [ContactModel::Points; 2];
    assert_eq!(changed(4, on_points), moved(&robot, 2, IMPLICIT, &[]).1);
    assert_eq!(changed(5, on_points), moved(&robot, 3, IMPLICIT, &[]).1);
    // Every gear with a spring by its name is all of them.
    let springs = robot.drives.iter().filter(|d| d.elasticity.is_some()).map(|d| d.name.clone());
    let named = Components { elastic: Selection::Named(springs.collect()), ..Components::from(2) };
    assert_eq!(moved(&robot, named, IMPLICIT, &[]).1, moved(&robot, 3, IMPLICIT, &[]).1);
}

/// Some gears of type 3 are stiff, some soles of type 4 points: as many states as these have.
#[test]
fn what_is_left_out_has_no_states() {
    let robot = lola();
    let counts = |components: Components| {
        let plant = Plant::new(&robot, Environment::flat(), components, &robot.poses["stand"]).unwrap();
        (plant.layout().elastic, plant.layout().nodes, plant.layout().motors, plant.layout().joints)
    };
    let pads = counts(Components::from(4)).1;
    let (_, points, motors, joints) = counts(Components::from(2));
    let one = Components { contact: [ContactModel::Pads, ContactModel::Points], ..Components::from(1) };
    assert_eq!(counts(one).1, (pads + points) / 2);
    let knees = ["right_knee_flexion", "left_hip_flexion"].map(str::to_owned).to_vec();
    let two = Components { elastic: Selection::Named(knees.clone()), ..Components::from(2) };
    let has_spring = |name: &&String| robot.drives.iter().any(|d| d.name == **name && d.elasticity.is_some());
    assert_eq!(counts(two).0, knees.iter().filter(has_spring).count());
    assert_eq!(counts(Components { currents: false, ..Components::from(2) }).2, 0);
    let locked = Components { locked: UPPER.map(str::to_owned).to_vec(), ..Components::from(2) };
    let (_, _, fewer_motors, fewer_joints) = counts(locked);
    assert_eq!([motors - fewer_motors, joints - fewer_joints], [UPPER.len(); 2]);
}

/// A motor without inductance has the current of its voltage at once: the limit of a current loop that is a hundred times as
/// fast on a hundredth of the inductance.
#[test]
fn motors_without_currents_are_the_limit_of_fast_currents() {
    let with = |robot: &Robot, currents: bool| {
        let components = Components { currents, friction: false, ..Components::from(2) };
        moved(robot, components, (Integrator::SemiImplicit, 5000), &[]).1
    };
    let mut fast = lola();
    for drive in &mut fast.drives {
        drive.motor.inductance /= 100.0;
        if let drives::ControlLaw::Cascade(cascade) = &mut drive.control.law {
            cascade.current_bandwidth *= 100.0;
        }
    }
    let (robot, n) = (lola(), lola().joints.len());
    let distance = |a: &[f64], b: &[f64]| (0..7 + n).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
    let (limit, fast, slow) = (with(&robot, false), with(&fast, true), with(&robot, true));
    let (near, far) = (distance(&limit, &fast), distance(&limit, &slow));
    assert!(far > 1e-7 && near < 0.05 * far, "{near} {far}");
    // Explicit methods find the same currents, and implicit steps of half the length half the distance to them.
    let components = Components { currents: false, friction: false, ..Components::from(2) };
    let of = |integrator, steps| moved(&robot, components.clone(), (integrator, steps), &[]).1;
    let explicit = of(Integrator::RungeKutta4, 2000);
    let [whole, half] = [500, 1000].map(|steps| distance(&of(Integrator::SemiImplicit, steps), &explicit));
    assert!((0.45..0.55).contains(&(half / whole)), "{half} {whole}");
}

/// The step that limits explicit methods is that of what is computed.
#[test]
fn explicit_steps_are_limited_by_what_is_computed() {
    let robot = lola();
    let limit = |components: Components| {
        step_limit(&robot, components, &robot.poses["stand"], Integrator::Euler).unwrap().unwrap().step
    };
    let (all, without) = (Components::from(2), Components { currents: false, ..Components::from(2) });
    let (all, without) = (limit(all), limit(without));
    assert!(without > 1.2 * all, "{without} {all}");
}

/// Joints that are locked are joints that rest where they follow their targets: the same motion of the torso.
#[test]
fn locked_joints_are_joints_at_rest() {
    let robot = lola();
    let method = (Integrator::Euler, 1000);
    let free = Components { rotors: false, ..Components::from(1) };
    let locked = Components { locked: UPPER.map(str::to_owned).to_vec(), ..free.clone() };
    let ((plant, a), (_, b)) =
        (moved(&robot, free, method, &UPPER), moved(&robot, locked.clone(), method, &UPPER));
    assert_eq!(a.len(), b.len());
    let most = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(most < 1e-9, "{most}");
    // Whoever reads them finds each at its own place, a locked one where it is told to be.
    let (second, _) = moved(&robot, locked, method, &[]);
    let (all, _) = moved(&robot, 1, method, &[]);
    for j in 0..robot.joints.len() {
        assert_eq!(second.joint(j), all.joint(j), "{}", robot.joints[j].name);
        assert!(j > 20 || plant.joint(j).0.is_finite());
    }
}

/// A locked joint is read where it is told to be, stands where it was locked, and its drive takes no current: no drive of a
/// standing robot is at fault.
#[test]
fn locked_joints_stand_still_and_are_no_fault() {
    let mut setup = Setup::load(&config::root(None), "walk_without_currents").unwrap();
    setup.scene.drives = Some(config::crane::DriveStart { homing: false });
    let mut sim = SimBackend::new(&setup.robot, &setup.scene).unwrap();
    let head = setup.robot.joint("head_pan").unwrap();
    let mut targets = JointTargets { mode: JointMode::Track as u64, ..JointTargets::default() };
    targets.angle[..setup.robot.joints.len()].copy_from_slice(&setup.robot.poses["stand"]);
    let (mut frames, mut sensors) = (BusFrames::default(), Sensors::default());
    for tick in 1..=300 {
        targets.header.tick = tick;
        targets.angle[head] = 1e-4 * tick as f64;
        let control = [if tick == 1 { 0x06 } else { 0x0F }; messages::MAX_JOINTS];
        encode_targets(
            &setup.robot.layout,
            &DriveCommand { targets, control, ..DriveCommand::default() },
            &mut frames,
        );
        let power = Power { toggle: tick, on: 1, arming: 1, ..Power::default() };
        let (answer, truth) = sim.step(Some(&frames), Some(&power));
        assert_eq!(truth.joint_angle[head], setup.robot.poses["stand"][head], "in cycle {tick}");
        decode_sensors(&setup.robot.layout, answer, &mut sensors);
    }
    assert!((sensors.joint_angle[head] - 0.03).abs() < 2e-4, "{}", sensors.joint_angle[head]);
    assert_eq!((sensors.motor_current[head], sensors.drive_error), (0.0, [0; messages::MAX_JOINTS]));
}

/// With motors, too: the stiffer the drives that hold joints, the nearer these are to locked ones.
#[test]
fn locked_joints_are_joints_that_are_held() {
    let components = Components { friction: false, ..Components::from(2) };
    let locked = Components { locked: UPPER.map(str::to_owned).to_vec(), ..components.clone() };
    let torso = |robot: &Robot, components: &Components| {
        moved(robot, components.clone(), (Integrator::SemiImplicit, 1000), &UPPER).1[..7].to_vec()
    };
    let apart = |stiffer: f64| {
        let mut robot = lola();
        let upper = |drive: &&mut config::robot::Drive| UPPER.contains(&drive.name.as_str());
        for drive in robot.drives.iter_mut().filter(upper) {
            if let drives::ControlLaw::Cascade(cascade) = &mut drive.control.law {
                cascade.position_gain *= stiffer;
                cascade.speed_bandwidth *= stiffer;
            }
        }
        let (held, locked) = (torso(&robot, &components), torso(&robot, &locked));
        held.iter().zip(&locked).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    // What is left of both is how far the joints fall until their motors have a current.
    let [soft, stiff] = [1.0, 4.0].map(apart);
    assert!(stiff < 0.4 * soft, "{soft} {stiff}");
}

/// Each foot on elements of its own carries its half.
#[test]
fn a_foot_on_pads_and_one_on_points_share_the_weight() {
    let robot = lola();
    let components =
        Components { contact: [ContactModel::Pads, ContactModel::Points], ..Components::from(1) };
    let pose = &robot.poses["stand"];
    let mut plant = Plant::new(&robot, Environment::flat(), components, pose).unwrap();
    let mut x = plant.standing(pose);
    let drives: Vec<JointCubic> = pose.iter().map(|&q| JointCubic::resting(q)).collect();
    let mut stepper = Stepper::new(Integrator::Euler, x.len());
    for _ in 0..3000 {
        stepper.step(&mut plant, 0.0, 5e-4, &mut x, &drives, &PlantInputs::POWERED);
    }
    let weight = plant.model().mass() * multibody::GRAVITY_ACCELERATION;
    let [right, left] = plant.snapshot(0.0, &x, &drives).foot_wrench.map(|w| w.force[2]);
    assert!((right + left - weight).abs() < 0.01 * weight, "{right} {left} of {weight}");
    assert!(right.min(left) > 0.35 * weight, "{right} {left} of {weight}");
}

/// A scene with components of its own walks as told, and its figures name them.
#[test]
fn a_scene_says_its_components() {
    let setup = Setup::load(&config::root(None), "walk_without_currents").unwrap();
    let components = setup.scene.components();
    assert_eq!((components.joints, components.currents), (JointModel::Motors, false));
    assert_eq!(components.locked, ["head_pan", "head_tilt"]);
    assert_eq!(setup.scene.model(), "type 2, without currents, locked head_pan head_tilt");
}

/// Torques by inverse dynamics are those of the motors, where gears have no friction: of a robot whose joints move, by its
/// currents.
#[test]
fn torques_by_inverse_dynamics_are_those_of_the_motors() {
    let robot = lola();
    let n = robot.joints.len();
    let components = Components { friction: false, ..Components::from(2) };
    let method = (Integrator::RungeKutta4, 10_000);
    let (mut plant, x) = moved(&robot, components, method, &[]);
    // The acceleration of one more step, with references that stay where they have come to.
    let h = 5e-6;
    let ends = |(j, &q): (usize, &f64)| JointCubic::resting(q + 1e-3 * (1.0 + j as f64).sin());
    let drives: Vec<JointCubic> = robot.poses["stand"].iter().enumerate().map(ends).collect();
    let mut after = x.clone();
    let mut stepper = Stepper::new(Integrator::RungeKutta4, x.len());
    stepper.step(&mut plant, 0.0, h, &mut after, &drives, &PlantInputs::POWERED);
    plant.note_step(h, &x, &after);
    plant.look(0.0, &after, &drives);
    let mut found = vec![0.0; n];
    plant.joint_torques(&mut found);
    // By the currents, which end the state.
    let mut expected = vec![0.0; n];
    let current = &after[plant.layout().current()];
    for (drive, current) in robot.drives.iter().zip(current) {
        let at = |of: usize| std::array::from_fn(|i| drive.joints.get(i).map_or(0.0, |&j| after[of + j]));
        let gear = drive.transmission.at(at(7), at(13 + n)).unwrap();
        for (&joint, ratio) in drive.joints.iter().zip(gear.ratio) {
            expected[joint] += ratio * drive.motor.torque(*current);
        }
    }
    let most = expected.iter().fold(0.0, |most, t| f64::max(most, t.abs()));
    let apart = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(most > 20.0 && apart < 1e-3 * most, "{apart} of {most} N m: {found:?} {expected:?}");
}
