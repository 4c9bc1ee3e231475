//! Names of robots and gaits, and what a URDF may look like.

use std::fs;

use config::{Robot, Setup};

use crate::errors::{Copy, text};

#[test]
fn a_robot_that_is_not_there() {
    let copy = Copy::new("no-robot").spoil("scenes/demo.toml", "robot = \"lola\"", "robot = \"lula\"");
    let said = text(&copy.scene("demo"));
    assert!(said.contains("robots/lula") || said.starts_with("lula: "), "{said}");
    assert!(said.ends_with("there is lola"), "{said}");
}

/// Regression: of `lola.slow` the file of `lola` was read.
#[test]
fn a_gait_may_have_a_dot_in_its_name() {
    let copy = Copy::new("dot").spoil("scenes/demo.toml", "gait = \"lola\"", "gait = \"lola.slow\"");
    assert!(text(&copy.scene("demo")).contains("lola.slow.toml"), "{}", copy.scene("demo"));
    let gait = fs::read_to_string(copy.path("gaits/lola.toml")).unwrap();
    let slow = gait.replacen("swing_height = 0.055", "swing_height = 0.03", 1);
    fs::write(copy.path("gaits/lola.slow.toml"), slow).unwrap();
    assert_eq!(Setup::load(&copy.0, "demo").unwrap().gait.step.swing_height, 0.03);
}

/// Regression: masses in comments were counted, and single quotes were no quotes.
#[test]
fn masses_are_those_of_the_urdf_however_it_is_written() {
    let copy = Copy::new("quotes").spoil(
        "robots/lola/lola.urdf",
        "<mass value=\"0.138\"/>",
        "<!-- <mass value=\"9.5\"/> --><mass value='0.138'/>",
    );
    Robot::load(&copy.path("robots/lola")).unwrap();
}
