//! The camera head against the robot's kinematics, and what it cannot look at.

use super::*;
use config::root;
use messages::command::{FixateCommand, HeadJointsCommand};

const DT: f64 = 1e-3;

fn lola() -> Robot {
    Robot::load(&root(None).join("robots/lola")).unwrap()
}

fn gaze(change: impl Fn(&mut Head)) -> Gaze {
    let mut robot = lola();
    change(robot.head.as_mut().unwrap());
    Gaze::new(&robot).unwrap().unwrap()
}

fn still() -> TorsoMotion {
    TorsoMotion {
        origin: [0.0; 3],
        height: 0.0,
        turn: 0.0,
        rotation: Matrix3::identity(),
        position: Vector3::zeros(),
        velocity: Vector3::zeros(),
        omega: Vector3::zeros(),
    }
}

/// Angles of the joints \[rad\] after `seconds` of looking.
fn look(gaze: &mut Gaze, torso: &TorsoMotion, seconds: f64, from: [f64; 2]) -> [f64; 2] {
    let (mut angle, mut speed) = ([0.0; 25], JointVector::zeros());
    (angle[gaze.head.pan], angle[gaze.head.tilt]) = (from[0], from[1]);
    for _ in 0..(seconds / DT) as usize {
        let mut given = JointVector::zeros();
        gaze.drive(torso, DT, &angle, &speed, &mut given);
        for j in 0..25 {
            angle[j] += 0.5 * DT * (speed[j] + given[j]);
        }
        speed = given;
    }
    [angle[gaze.head.pan], angle[gaze.head.tilt]]
}

fn fixate(gaze: &mut Gaze, point: [f64; 3]) -> bool {
    gaze.command(&Command::Fixate(FixateCommand { point }))
}

#[test]
fn vectors_of_the_errata() {
    let on_axes = gaze(|h| {
        h.camera = [0.0; 3];
        h.vergence = Some((0, 0.24));
    });
    let [pan, tilt, _] = on_axes.angles(&Vector3::new(2.0, 0.3, -1.3)).unwrap();
    assert!((pan - 0.148889947609).abs() < 1e-12 && (tilt + 0.571303151839).abs() < 1e-12);
    let [_, _, vergence] = on_axes.angles(&Vector3::new(2.4, 0.0, 0.0)).unwrap();
    assert!((vergence - 0.0999167914439).abs() < 1e-12);
    // 2 m ahead and 1 m to the left: what is printed gives a pan of zero.
    let [pan, tilt, _] = on_axes.angles(&Vector3::new(2.0, 1.0, 0.0)).unwrap();
    assert!((pan.to_degrees() - 26.565).abs() < 1e-3 && tilt == 0.0);
}

/// Independent route: the angles put into the robot's kinematics turn the optical axis through the point.
#[test]
fn the_optical_axis_passes_the_point_wherever_the_cameras_sit() {
    let mut robot = lola();
    for camera in [[0.0; 3], [0.055, 0.0, 0.04], [0.02, 0.03, -0.06]] {
        robot.head.as_mut().unwrap().camera = camera;
        let gaze = Gaze::new(&robot).unwrap().unwrap();
        let mut kinematics = TaskSpace::new(&robot).unwrap();
        for k in 0..500 {
            let x = |step: f64| (f64::from(k) * step).sin();
            let point = Vector3::new(2.0 * x(1.3), 2.0 * x(2.9), 1.5 * x(0.7));
            let Some([pan, tilt, _]) = gaze.angles(&(point - gaze.centre)) else { continue };
            let mut q = vec![0.0; robot.joints.len()];
            let head = robot.head.as_ref().unwrap();
            (q[head.pan], q[head.tilt]) = (pan, tilt);
            kinematics.update(&q);
            let link = kinematics.link(&head.link).unwrap();
            let sight = point - (link.position + link.rotation * Vector3::from(camera));
            let axis = link.rotation.column(0).into_owned();
            assert!(axis.cross(&sight).norm() < 1e-12 && axis.dot(&sight) > 0.0, "{camera:?} {point:?}");
        }
    }
}

/// The rates of the targets are the derivatives of the targets along the torso's motion.
#[test]
fn targets_move_as_the_torso_makes_them() {
    let mut gaze = gaze(|_| ());
    let (omega, velocity) = (Vector3::new(0.2, -0.3, 0.5), Vector3::new(0.6, 0.1, -0.05));
    let point = Vector3::new(1.5, 0.8, 1.0);
    let at = |t: f64| TorsoMotion {
        origin: [0.4, -0.2, 0.3],
        height: 0.1,
        turn: 0.0,
        rotation: *Rotation3::new(omega * t).matrix(), // about a fixed axis: omega is the same in both frames
        position: Vector3::new(0.0, 0.0, 0.9) + velocity * t,
        velocity: Rotation3::new(omega * t).transpose() * velocity,
        omega,
    };
    let now = [AxisState::default(); AXES];
    let (t, h) = (0.2, 1e-5);
    let target = gaze.targets(&at(t), &point, &now, h);
    let angles = |gaze: &Gaze, t: f64| gaze.angles(&gaze.seen(&at(t), &point).0).unwrap();
    let (before, after) = (angles(&gaze, t - h), angles(&gaze, t + h));
    for i in 0..2 {
        assert!((target[i].p - after[i]).abs() < 1e-9, "where it will be at the end of the cycle");
        assert!((target[i].v - (after[i] - before[i]) / (2.0 * h)).abs() < 1e-4);
    }
}

/// The sole turns by 50 mrad under a robot that then walks 3 m, turning by 0.4 rad, over footholds whose frames jump:
/// odometry ends 0.15 m beside, the head does not.
#[test]
fn the_way_is_reckoned_with_the_heading_that_is_believed() {
    let mut gaze = gaze(|h| h.heading_time = 1e9);
    gaze.stabilized(&still(), DT);
    let (slip, steps) = (0.05, 3000);
    let (mut real, mut believed) = (Vector3::<f64>::zeros(), Vector3::<f64>::zeros());
    let about_z = |angle| Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
    let mut seen = Vector3::zeros();
    let mut torso = still();
    let point = Vector3::new(4.0, 1.0, 0.9);
    for k in 1..=steps {
        let heading = 0.4 * f64::from(k) / f64::from(steps);
        let ahead = Vector3::new(1e-3, 0.0, 0.0);
        real += about_z(heading + slip) * ahead;
        believed += about_z(heading) * ahead;
        let frame = f64::from(k / 700); // a foothold every 0.7 m
        let origin = [0.7 * frame, 0.02 * frame, 0.1 * frame];
        let rotation = *about_z(heading - origin[2]).matrix();
        let position = about_z(-origin[2]) * (believed - Vector3::new(origin[0], origin[1], 0.0));
        let measured = TorsoMotion { origin, turn: -origin[2] - slip, rotation, position, ..still() };
        torso = gaze.stabilized(&measured, DT);
        seen = gaze.seen(&torso, &point).0 + gaze.centre;
    }
    let expected = about_z(-0.4 - slip) * (point - real);
    assert!((real - believed).norm() > 0.14);
    assert!((seen - expected).norm() < 1e-4, "{seen} {expected}");
    // A point that was seen where odometry has her is found again by who is told by how much that is beside.
    let [dx, dy, turn] = gaze.offset();
    let told = believed + Vector3::new(dx, dy, 0.0) + about_z(turn) * (point - believed);
    let found = gaze.seen(&torso, &told).0 + gaze.centre;
    assert!((found - about_z(-0.4) * (point - believed)).norm() < 1e-9, "{found}");
}

#[test]
fn what_cannot_be_looked_at_is_held_and_said() {
    let torso = still();
    let [pan, tilt] = {
        let h = gaze(|_| ()).head;
        [h.pan, h.tilt]
    };
    let ranges = lola().joints;
    // Behind: the end of the range on the side that is nearer; above: as high as it goes.
    for (point, joint) in [([-2.0, 0.3, 0.5], pan), ([1.0, 0.2, 3.0], tilt)] {
        let mut gaze = gaze(|_| ());
        assert!(fixate(&mut gaze, point));
        let q = look(&mut gaze, &torso, 3.0, [0.0, 0.0]);
        let held = if joint == pan { q[0] } else { q[1] };
        assert!((held - ranges[joint].range[1]).abs() < 1e-3, "{q:?}");
        assert_eq!(gaze.held, Some(joint));
        assert_eq!(gaze.events().pop(), Some((EventCode::GazeHeld, Detail::Joint(joint))), "said once");
        assert!(matches!(gaze.events().pop(), Some((EventCode::Saccade, _))));
        look(&mut gaze, &torso, 0.5, q);
        assert_eq!(gaze.events().pop(), None);
    }
    // On the axis of pan, in the cameras, nearer than allowed: the head stays where it is.
    let centre = gaze(|_| ()).centre;
    for r in [[0.0, 0.0, 1.0], [0.0; 3], [0.055, 0.0, 0.04], [0.2, 0.0, 0.04]] {
        let mut gaze = gaze(|_| ());
        assert!(fixate(&mut gaze, (centre + Vector3::from(r)).into()));
        assert_eq!(look(&mut gaze, &torso, 0.5, [0.3, -0.1]), [0.3, -0.1], "{r:?}");
        assert_eq!(gaze.events().pop(), Some((EventCode::GazeHeld, Detail::Joint(gaze.joints))));
    }
    // And resumed when the point comes within reach.
    let mut gaze = gaze(|_| ());
    fixate(&mut gaze, [-2.0, 0.3, 0.5]);
    look(&mut gaze, &torso, 3.0, [0.0, 0.0]);
    gaze.events().pop();
    let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), 2.5);
    look(&mut gaze, &TorsoMotion { rotation: *turned.matrix(), ..torso }, 2.0, [1.88, 0.0]);
    assert_eq!(gaze.held, None);
}

#[test]
fn nan_and_angles_out_of_range_are_refused_and_change_nothing() {
    let mut gaze = gaze(|_| ());
    assert!(fixate(&mut gaze, [2.0, 0.5, 1.0]));
    let goal = gaze.goal;
    assert!(!fixate(&mut gaze, [2.0, f64::NAN, 1.0]));
    assert!(!fixate(&mut gaze, [f64::INFINITY, 0.0, 1.0]));
    for (pan, tilt) in [(1.9, 0.0), (0.0, 0.2), (f64::NAN, 0.0)] {
        assert!(!gaze.command(&Command::HeadJoints(HeadJointsCommand { pan, tilt })));
    }
    assert!(!gaze.command(&Command::Stop));
    assert_eq!(gaze.goal, goal);
}

/// A torso that is nowhere (NaN) leaves the head where it is.
#[test]
fn a_pose_that_is_no_number_moves_nothing() {
    let mut gaze = gaze(|_| ());
    fixate(&mut gaze, [2.0, 0.5, 1.0]);
    let lost = TorsoMotion { position: Vector3::repeat(f64::NAN), ..still() };
    assert_eq!(look(&mut gaze, &lost, 0.1, [0.3, -0.1]), [0.3, -0.1]);
}

/// A point behind that sways from side to side does not make the head swing from end to end.
#[test]
fn nearest_angle_in_range_then_the_present_side() {
    let range = [-1.885, 1.885];
    assert_eq!(reached(1.0, 0.5, range), (1.0, true));
    for back in [3.0, 3.1, -3.1, -3.0] {
        assert_eq!(reached(back, 1.885, range), (1.885, false), "{back}");
        assert_eq!(reached(back, -1.885, range), (-1.885, false), "{back}");
    }
    let (angle, inside) = reached(-1.8, 1.885, range);
    assert!((angle + 1.8).abs() < 1e-12 && inside, "reachable on the other side");
}

/// The third joint, which Lola's public model lacks, in the place of one of hers.
#[test]
fn vergence_follows_the_distance() {
    let joint = lola().joint("left_elbow_flexion").unwrap();
    let mut gaze = gaze(|h| h.vergence = Some((joint, 0.24)));
    let point = gaze.centre + Vector3::new(1.455, 0.0, 0.04);
    fixate(&mut gaze, point.into());
    let (mut angle, mut speed) = ([0.0; 25], JointVector::zeros());
    for _ in 0..1000 {
        let mut given = JointVector::zeros();
        gaze.drive(&still(), DT, &angle, &speed, &mut given);
        (0..25).for_each(|j| angle[j] += 0.5 * DT * (speed[j] + given[j]));
        speed = given;
    }
    assert!((angle[joint] - 2.0 * (0.12f64 / 1.4).atan()).abs() < 1e-6, "{}", angle[joint]);
}

#[test]
fn axes_that_are_no_pan_and_tilt_are_refused() {
    let mut robot = lola();
    let elbow = robot.joint("left_elbow_flexion").unwrap();
    robot.head.as_mut().unwrap().pan = elbow;
    assert!(matches!(Gaze::new(&robot), Err(ModelError::Unsuitable(..))));
    robot.head = None;
    assert!(Gaze::new(&robot).unwrap().is_none());
}
