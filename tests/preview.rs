//! `gangwerk preview`: pictures of a pattern, and what it breaks.

use cli::preview::{of_files, preview};
use config::{Gait, Robot};
use std::path::{Path, PathBuf};

fn out(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("preview-{name}"))
}

#[test]
fn a_pattern_is_drawn() {
    let preview =
        of_files(&config::root(None), Path::new("archie_static"), "archie", None, &out("static")).unwrap();
    assert_eq!((preview.fault, preview.files.len()), (None, 5));
    for file in preview.files {
        assert!(std::fs::metadata(&file).unwrap().len() > 10_000, "{}", file.display());
    }
}

/// Pictures are drawn of a pattern that cannot be walked too, with gaps, and the rule it breaks is named.
#[test]
fn what_cannot_be_walked_is_drawn_and_named() {
    let root = config::root(None);
    let mut pattern = Gait::load(&root.join("gaits/archie_static.toml")).unwrap().pattern.unwrap();
    (pattern.length, pattern.over_length) = (0.30, 0.30);
    let robot = Robot::load(&root.join("robots/archie")).unwrap();
    let drawn = preview(&Gait::from(pattern), &robot, None, "too long", &out("long")).unwrap();
    let fault = drawn.fault.unwrap().to_string();
    assert!(fault.contains("leg") && fault.contains("s after the begin"), "{fault}");
    assert_eq!(drawn.files.len(), 5);
}

/// Balanced gaits are planned, followed and drawn in the same way, on legs without a closed form too.
#[test]
fn balanced_gaits_are_drawn() {
    for (robot, speed) in [("lola", Some(0.5556)), ("johnnie", None), ("archie", None)] {
        let preview = of_files(&config::root(None), Path::new(robot), robot, speed, &out(robot)).unwrap();
        assert_eq!((preview.fault, preview.files.len()), (None, 5), "{robot}");
        for file in preview.files {
            assert!(std::fs::metadata(&file).unwrap().len() > 10_000, "{}", file.display());
        }
    }
}

/// Legs that are too short, and a joint that is too slow, are named with value and bound.
#[test]
fn what_a_balanced_gait_cannot_walk_is_named() {
    let root = config::root(None);
    let (mut gait, mut robot) = (
        Gait::load(&root.join("gaits/johnnie.toml")).unwrap(),
        Robot::load(&root.join("robots/johnnie")).unwrap(),
    );
    gait.model.com_height += 0.1;
    let fault = preview(&gait, &robot, None, "too high", &out("high")).unwrap().fault.unwrap();
    assert!(fault.contains("from where it is planned (at most"), "{fault}");
    gait.model.com_height -= 0.1;
    let knee = robot.joint("right_knee_flexion").unwrap();
    robot.joints[knee].speed_limit = 1.0;
    let fault = preview(&gait, &robot, None, "too fast", &out("fast")).unwrap().fault.unwrap();
    assert!(fault.contains("joint right_knee_flexion is held at 1.000 rad/s by its limit"), "{fault}");
}

#[test]
fn a_pattern_needs_legs_in_closed_form() {
    let refused =
        of_files(&config::root(None), Path::new("archie_static"), "lola", None, &out("none")).map(|_| ());
    let refused = refused.unwrap_err();
    assert!(refused.contains("the robot has no [leg.right] and [leg.left]"), "{refused}");
}

#[test]
fn a_speed_that_a_gait_has_no_steps_for_is_refused() {
    for (gait, robot, speed, why) in [
        ("lola", "lola", 9.0, "the gait has no steps for this speed"),
        ("lola", "lola", f64::NAN, "the gait has no steps for this speed"),
        ("lola", "lola", 0.0, "the robot makes no whole stride: nothing is planned"),
        ("archie_static", "archie", 0.02, "a pattern has a speed of its own: leave out --speed"),
    ] {
        let refused = of_files(&config::root(None), Path::new(gait), robot, Some(speed), &out("refused"));
        assert_eq!(refused.map(|_| ()).unwrap_err(), why, "{gait}, {speed} m/s");
    }
}
