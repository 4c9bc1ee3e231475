//! The poses of Lola's links, as they go into `/tf`.

use config::Robot;
use logger::{Kinematics, robot_info};
use messages::MAX_JOINTS;
use multibody::Data;
use recording::{LinkPoses, RecordedPose};

fn lola() -> Robot {
    Robot::load(&config::root(None).join("robots/lola")).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn links_form_one_tree_with_parents_first() {
    let robot = lola();
    let kinematics = Kinematics::new(&robot).unwrap();
    let links = kinematics.links();
    assert_eq!(links.iter().filter(|l| l.parent.is_none()).count(), 1);
    assert_eq!((links[0].name.as_str(), links[0].parent), (robot.torso.as_str(), None));
    for (k, link) in links.iter().enumerate() {
        assert!(link.parent.is_none_or(|p| p < k), "{}", link.name);
    }
    let parent = |name: &str| {
        let link = links.iter().find(|l| l.name == name).unwrap();
        links[link.parent.unwrap()].name.clone()
    };
    let info = robot_info(&robot);
    assert_eq!(info.joints.len(), robot.joints.len());
    for foot in info.feet {
        // Up from the sole's link to the upper body.
        let mut at = foot.link;
        let mut steps = 0;
        while at != robot.torso && steps < 20 {
            at = parent(&at);
            steps += 1;
        }
        assert!((6..20).contains(&steps), "{steps}");
    }
}

#[test]
fn poses_are_those_of_the_model() {
    let robot = lola();
    let model = robot.model().unwrap();
    let mut data = Data::new(&model);
    let mut kinematics = Kinematics::new(&robot).unwrap();
    let (sin, cos) = 0.3f64.sin_cos();
    let base = RecordedPose { position: [1.0, 2.0, 3.0], orientation: [0.6 * sin, 0.0, 0.8 * sin, cos] };
    let angles: [f64; MAX_JOINTS] = std::array::from_fn(|k| 0.1 * (k as f64 + 1.0).sin());
    let mut poses = vec![RecordedPose::IDENTITY; kinematics.links().len()];
    kinematics.poses(&base, &angles, &mut poses);
    let mut q = vec![0.0; model.nq()];
    q[..3].copy_from_slice(&base.position);
    q[3..7].copy_from_slice(&base.orientation);
    q[7..].copy_from_slice(&angles[..model.n()]);
    model.forward_kinematics(&mut data, &q);
    for (link, pose) in kinematics.links().iter().zip(&poses) {
        // Through a point off all axes, so that a wrong turn shows.
        let point = [0.3, -0.2, 0.5];
        let expected = model.frame_position(&data, &model.frame(&link.name, point).unwrap());
        for (a, b) in pose.place(point).iter().zip(expected.iter()) {
            assert!((a - b).abs() < 1e-12, "{}: {a} {b}", link.name);
        }
    }
    assert_eq!(poses[0].position, base.position);
}
