//! Links and joints of `robot.toml` that are not those of the URDF, or not those of the limb they are named for.

use crate::errors::{Copy, text};

#[test]
fn links_and_joints_are_those_of_the_urdf() {
    let file = "robots/lola/robot.toml";
    let copy = Copy::new("links")
        .spoil(file, "sensor_link = \"right_foot\"", "sensor_link = \"right_fot\"")
        .spoil(file, "link = \"head\"", "link = \"haed\"");
    let error = text(&copy.robot());
    for line in [
        "robot.toml: 2 problems",
        "foot.right.sensor_link: the URDF has no link `right_fot`; the nearest is `right_foot`",
        "head.link: the URDF has no link `haed`",
    ] {
        assert!(error.contains(line), "{line}\nis not in\n{error}");
    }
}

/// Names that exist, each where another one belongs.
#[test]
fn limbs_are_what_they_are_named_for() {
    let file = "robots/lola/robot.toml";
    for (from, to, problem) in [
        (
            "sensor_link = \"left_foot\"",
            "sensor_link = \"right_foot\"",
            "foot.left.sensor_link: `right_foot` is no part of this leg alone",
        ),
        (
            "toe = \"left_toe_flexion\"",
            "toe = \"head_pan\"",
            "foot.left.toe: joint `head_pan` is not the one that moves `left_toe`, which carries the sole",
        ),
        (
            "left = \"left_shoulder_flexion\"",
            "left = \"left_toe_flexion\"",
            "arms.left: joint `left_toe_flexion` moves a foot",
        ),
        (
            "left = \"left_shoulder_flexion\"",
            "left = \"right_shoulder_flexion\"",
            "arms.left: joint `right_shoulder_flexion` is named twice",
        ),
        (
            "support_x = [-0.255, 0.035]",
            "support_x = [-0.255, 0.05]",
            "foot.right.support_x: [-0.255, 0.05] m reaches beyond the contact points, which lie from -0.2550 to 0.0350 m",
        ),
    ] {
        let copy = Copy::new("limbs").spoil(file, from, to);
        let error = text(&copy.robot());
        assert!(error.contains(problem), "{problem}\nis not in\n{error}");
    }
    let copy = Copy::new("prismatic").spoil(
        "robots/lola/lola.urdf",
        "name=\"pelvis_rotation\" type=\"revolute\"",
        "name=\"pelvis_rotation\" type=\"prismatic\"",
    );
    let error = text(&copy.robot());
    assert!(error.contains("joint[0]: `pelvis_rotation` is prismatic in the URDF"), "{error}");
}
