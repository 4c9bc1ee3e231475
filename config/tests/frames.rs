//! DBC files made from `robot.toml`: the shipped ones are those, and a robot needs none.

use std::fs;
use std::path::PathBuf;

use config::Robot;
use config::dbc::read;
use config::dbc_writer::{FrameForm, LocalController, dbc_text};
use proptest::prelude::*;

fn shipped(name: &str) -> PathBuf {
    config::root(None).join("robots").join(name)
}

/// A shipped robot without its DBC files, its `robot.toml` changed.
fn without_files(test: &str, name: &str, change: impl FnOnce(String) -> String) -> Result<Robot, String> {
    let dir = std::env::temp_dir().join(format!("gangwerk-frames-{test}-{}", std::process::id()));
    fs::create_dir_all(&dir).unwrap();
    let text = fs::read_to_string(shipped(name).join("robot.toml")).unwrap();
    let is_file = |line: &&str| line.starts_with("classic = \"can/") || line.starts_with("fd = \"can/");
    assert_eq!(text.lines().filter(is_file).count(), 2);
    let of_tables = |line: &&str| {
        ["[can.tables]", "file = \"can/", "sampling_us", "playback"].iter().any(|key| line.starts_with(key))
    };
    let text: Vec<&str> = text.lines().filter(|line| !is_file(line) && !of_tables(line)).collect();
    fs::write(dir.join("robot.toml"), change(text.join("\n"))).unwrap();
    let urdf = format!("{name}.urdf");
    fs::copy(shipped(name).join(&urdf), dir.join(&urdf)).unwrap();
    let robot = Robot::load(&dir).map_err(|error| error.to_string());
    fs::remove_dir_all(&dir).unwrap();
    robot
}

/// `gangwerk robot frames NAME` writes them; the classic files of Johnnie and Archie describe drives that were bought.
#[test]
fn shipped_files_are_those_that_the_robots_file_gives() {
    let (fd, classic) = (("_fd", FrameForm::Fd), ("", FrameForm::Classic));
    for (name, (ending, form)) in [("lola", fd), ("lola", classic), ("johnnie", fd), ("archie", fd)] {
        let robot = Robot::load(&shipped(name)).unwrap();
        let made = dbc_text(name, &robot.can.nodes, robot.can.motor_side, form).unwrap();
        let file = shipped(name).join(format!("can/{name}{ending}.dbc"));
        let text = fs::read_to_string(&file).unwrap();
        let other = made.lines().zip(text.lines()).find(|(made, there)| made != there);
        assert!(made == text, "{}: `gangwerk robot frames {name}` writes {other:?}", file.display());
    }
}

#[test]
fn a_robot_without_files_has_the_same_frames() {
    let (with, without) =
        (Robot::load(&shipped("lola")).unwrap(), without_files("same", "lola", |t| t).unwrap());
    assert_eq!(with.layout, without.layout);
    assert_eq!(with.classic, without.classic);
    assert_eq!(with.spare, without.spare);
}

#[test]
fn classic_frames_that_have_no_room_are_missing_with_a_reason() {
    let archie = without_files("room", "archie", |text| text).unwrap();
    assert_eq!(archie.layout.nodes, ["leg_right", "leg_left"]);
    let why = archie.classic.unwrap_err();
    assert!(why.contains("`leg_right` has 6 joints") && why.contains("room for 3"), "{why}");
}

#[test]
fn what_the_local_controllers_lack_is_named() {
    for (test, old, new, said) in [
        ("lacks", "\"right_hip_flexion\", \"right_toe", "\"right_toe", "right_hip_flexion_target is missing"),
        ("twice", "[\"head_pan\", \"head_tilt\"]", "[\"head_pan\", \"head_pan\"]", "head_pan_target"),
        ("foreign", "[\"head_pan\", \"head_tilt\"]", "[\"head_pan\", \"head_roll\"]", "no joint `head_roll`"),
        ("sensor", "[\"imu\"]", "[\"gyro\"]", "no sensor `gyro`; there is right_foot, left_foot, imu"),
        ("bare", "sensors = [\"imu\"]\n", "", "imu_rate_x is missing"),
    ] {
        let change = |text: String| {
            assert!(text.contains(old), "{old}");
            text.replace(old, new)
        };
        let error = without_files(test, "lola", change).map(|_| ()).unwrap_err();
        assert!(error.contains("robot.toml") && error.contains(said), "{test}: {error}");
    }
}

proptest! {
    /// However joints and sensors are dealt to local controllers: the reader takes the file, so that every number is there
    /// once, no two share a bit, and every frame has a length that its bus knows.
    #[test]
    fn every_division_into_local_controllers_gives_a_file(
        sizes in prop::collection::vec(1usize..=6, 1..=12),
        places in prop::array::uniform3(0usize..100),
        motor_side: bool,
    ) {
        let joints: Vec<String> = (0..sizes.iter().sum::<usize>().min(32)).map(|j| format!("j{j}")).collect();
        let mut left = joints.as_slice();
        let mut nodes = Vec::new();
        for (n, &size) in sizes.iter().enumerate() {
            let (mine, rest) = left.split_at(size.min(left.len()));
            left = rest;
            if !mine.is_empty() {
                nodes.push(LocalController { name: format!("n{n}"), joints: mine.into(), sensors: vec![] });
            }
        }
        for (sensor, place) in ["right_foot", "left_foot", "imu"].into_iter().zip(places) {
            let count = nodes.len();
            nodes[place % count].sensors.push(sensor.to_owned());
        }
        let names: Vec<&str> = joints.iter().map(String::as_str).collect();
        for form in [FrameForm::Fd, FrameForm::Classic] {
            match dbc_text("robot", &nodes, motor_side, form) {
                Ok(text) => {
                    let layout = read(&text, &names).unwrap();
                    prop_assert_eq!(layout.is_classic(), form == FrameForm::Classic);
                }
                Err(why) => {
                    prop_assert!(form == FrameForm::Classic && sizes.iter().any(|n| *n > 3), "{}", why);
                }
            }
        }
    }
}
