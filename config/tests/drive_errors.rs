//! What a person reads whose drives or efficiencies cannot be.

use std::fs;
use std::path::PathBuf;

use config::efficiency::Efficiencies;
use config::{Robot, Setup};

/// A file of the shipped configuration with replacements, in a directory of its own, gone when dropped.
struct Spoilt(PathBuf);

impl Spoilt {
    fn new(test: &str, file: &str, replacements: &[(&str, &str)]) -> Self {
        let to = std::env::temp_dir().join(format!("gangwerk-drives-{test}-{}", std::process::id()));
        fs::create_dir_all(&to).unwrap();
        let from = config::root(None).join(file);
        let mut text = fs::read_to_string(&from).unwrap();
        for (old, new) in replacements {
            assert!(text.contains(old), "{file} does not contain {old}");
            text = text.replacen(old, new, 1);
        }
        fs::write(to.join(from.file_name().unwrap()), text).unwrap();
        Self(to)
    }

    /// Beside Lola's file the others that it names.
    fn with_files_named(&self) {
        fs::create_dir_all(self.0.join("can")).unwrap();
        for file in ["lola.urdf", "can/lola.dbc", "can/lola_fd.dbc"] {
            fs::copy(config::root(None).join("robots/lola").join(file), self.0.join(file)).unwrap();
        }
    }
}

impl Drop for Spoilt {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The error of Lola's file with these replacements holds these texts and no more problems.
fn refused(test: &str, replacements: &[(&str, &str)], wanted: &[&str]) {
    let spoilt = Spoilt::new(test, "robots/lola/robot.toml", replacements);
    let error = Robot::load(&spoilt.0).unwrap_err();
    for text in wanted {
        assert!(error.to_string().contains(text), "{text}\nis not in\n{error}");
    }
    assert_eq!(error.problems.len(), wanted.len(), "{error}");
}

#[test]
fn names_that_do_not_exist() {
    refused(
        "names",
        &[
            ("gear = \"hfuc_20_100\"", "gear = \"hfuc_20_10\""),
            ("motor = \"cha_25\"", "motor = \"cha_255\""),
            ("flexion = \"right_ankle_flexion\"", "flexion = \"right_ankle_flexoin\""),
        ],
        &[
            "drive[0].gear: there is no [gear.hfuc_20_10]; the nearest is `hfuc_20_100`",
            "drive[4].motor: there is no [motor.cha_255]; the nearest is `cha_25`",
            "drive[6].ankle.flexion: there is no joint `right_ankle_flexoin`; the nearest is `right_ankle_flexion`",
        ],
    );
}

#[test]
fn values_that_cannot_be() {
    refused(
        "values",
        &[
            ("ratio = -100.0", "ratio = 0.5"),
            (
                "stiffness = [4.7e3, 6.1e3, 7.1e3], knees = [2.0, 6.9]",
                "stiffness = [4.7e3, 6.1e3, -7.1e3], knees = [7.0, 6.9]",
            ),
            ("axis = [0.0, 0.0, 1.0]", "axis = [0.0, 0.5, 1.0]"),
            ("lead = 0.010", "lead = 0.0"),
            ("efficiency = [0.860, 0.858]", "efficiency = [1.2, 0.858]"),
        ],
        &[
            "gear.hfuc_11_100.ratio: 0.5 is not allowed; a gear's ratio is at least 1, or at most -1",
            "gear.hfuc_14_100.elasticity.stiffness[2]: -7100 is not allowed; it takes a number from 1e-9 to 1e9 N m/rad",
            "gear.hfuc_14_100.elasticity.knees: its lower end 7 must lie below its upper end 6.9 N m",
            "drive[0].axis: has the length 1.118034; it takes a unit vector",
            "drive[5].knee.lead: 0 is not allowed; a screw's lead is not zero",
            "drive[5].knee.efficiency[0]: 1.2 is not allowed; it takes a number from 0.01 to 1",
        ],
    );
}

#[test]
fn brakes_that_cannot_be() {
    refused(
        "brakes",
        &[
            ("current_limit = 30.0", "current_limit = 30.0\nbrake = { torque = 0.0, delay = 0.02 }"),
            ("current_limit = 50.0", "current_limit = 50.0\nbrake = { torque = 5.0, dellay = 1.5 }"),
        ],
        &[
            "drive[0].brake.torque: 0 is not allowed; it takes a number from 1e-9 to 1e9 N m",
            "drive[4].brake.delay: missing; it takes a number from 0 to 1 s",
            "drive[4].brake.dellay: unknown key; the nearest known one is `delay`",
        ],
    );
    refused(
        "brake-delay",
        &[("current_limit = 30.0", "current_limit = 30.0\nbrake = { torque = 5.0, delay = 1.5 }")],
        &["drive[0].brake.delay: 1.5 is not allowed; it takes a number from 0 to 1 s"],
    );
}

/// A coupler of 50 mm stands across the screw within the ankle's range; a lever straight behind the pivot has its dead
/// point within the knee's.
#[test]
fn linkages_with_dead_points_in_the_range() {
    refused(
        "dead",
        &[
            ("coupler = 0.180", "coupler = 0.010"),
            ("attachment = [0.0349, 0.0, 0.0548]", "attachment = [0.0602, 0.0, -0.0244]"),
        ],
        &[
            "drive[5].knee.attachment: knee linkage at its dead point: lever = ",
            "drive[6].ankle.attachment: ankle linkage at its dead point: margin D = ",
        ],
    );
}

/// HFUC-32-50 has a load torque up to 1601 rad/s of the motor: 32 rad/s of the joint.
#[test]
fn joint_too_fast_for_the_friction_of_its_gear() {
    refused(
        "fast",
        &[(
            "name = \"right_hip_flexion\"\nrange_deg = [-87.0, 39.9]\nspeed_limit = 9.4",
            "name = \"right_hip_flexion\"\nrange_deg = [-87.0, 39.9]\nspeed_limit = 33.0",
        )],
        &[
            "drive[4].gear: its friction holds below 1601 rad/s of the motor, but speed_limit of `right_hip_flexion` asks for 1650",
        ],
    );
}

#[test]
fn drives_in_another_order() {
    let (a, b) = (
        "name = \"pelvis_rotation\"\njoint = \"pelvis_rotation\"",
        "name = \"pelvis_adduction\"\njoint = \"pelvis_adduction\"",
    );
    let c = "name = \"x\"\njoint = \"pelvis_rotation\"";
    refused(
        "order",
        &[(b, c), (a, b)],
        &[
            "`pelvis_adduction`, must drive joint[0], `pelvis_rotation`",
            "`x`, must drive joint[1], `pelvis_adduction`",
        ],
    );
}

#[test]
fn robot_without_drives_loads() {
    let text = fs::read_to_string(config::root(None).join("robots/lola/robot.toml")).unwrap();
    let rows = text.find("[[drive]]").unwrap();
    let end = text[rows..].find("\n[sensors").map_or(text.len(), |at| rows + at);
    let spoilt = Spoilt::new("none", "robots/lola/robot.toml", &[(&text[rows..end], "")]);
    spoilt.with_files_named();
    assert!(Robot::load(&spoilt.0).unwrap().drives.is_empty());
}

#[test]
fn efficiencies() {
    let file = "gears/hfuc_25_100.toml";
    let shipped = Efficiencies::load(&config::root(None).join(file)).unwrap();
    assert_eq!(shipped.points.len(), 40);
    assert!((shipped.points[0].load - 0.067).abs() < 1e-12 && (shipped.points[0].speed - 52.36).abs() < 1e-2);
    let replacements = [("[500, 13.4, ", "[500, -13.4, "), ("[1000, 6.7, 0.", "[1000, 6.7, 3.")];
    let spoilt = Spoilt::new("table", file, &replacements);
    let error = Efficiencies::load(&spoilt.0.join("hfuc_25_100.toml")).unwrap_err().to_string();
    for text in [
        "hfuc_25_100.toml: 2 problems",
        "points: row 1: load torque = -13.4 is not allowed; it takes above 0 to 100000 N m at the output",
        "points: row 10: efficiency = 3.",
        "is not allowed; it takes above 0 to 1",
    ] {
        assert!(error.contains(text), "{text}\nis not in\n{error}");
    }
}

#[test]
fn joint_control_that_cannot_be() {
    refused(
        "control",
        &[("feedback = \"motor\"", "feedback = \"motr\""), ("position_gain = 100.0", "position_gain = 0.0")],
        &[
            "joint_control.feedback: `motr` is not known; it takes one of ",
            "joint_control.position_gain: 0 is not allowed; it takes a number from 1e-9 to 1e9 1/s",
        ],
    );
    refused(
        "voltage",
        &[
            ("law = \"cascade\"", "law = \"voltage\"\nposition = 8.0\nspeed = 0.0"),
            ("feedback = \"motor\"\n", ""),
            ("position_gain = 100.0 # [1/s]\n", ""),
            ("speed_bandwidth = 600.0 # [rad/s] with the inertia of the hanging robot\n", ""),
            ("current_bandwidth = 3000.0 # [rad/s]\n", ""),
        ],
        &["joint_control.sampling: the law \"voltage\" is computed once per cycle; it takes \"cycle\""],
    );
}

#[test]
fn clock_of_a_drive_that_cannot_be() {
    let clock = |speed: &str, position: &str| {
        format!("sampling = \"period\"\nspeed_period = {speed}\nposition_period = {position}")
    };
    refused(
        "clock",
        &[("sampling = \"continuous\"", &clock("0.00016", "0.00032"))],
        &["joint_control.sampling: the law \"cascade\" takes \"continuous\" or \"cycle\""],
    );
    let pi = "law = \"cascade_pi\"\nspeed_integral = -1.0\nspeed_filter = nan\nfeed_forward = [1.0, 2.0]\noutput = \"amp\"";
    let law = [("law = \"cascade\"", pi), ("feedback = \"motor\"\n", "")];
    refused(
        "integral",
        &law,
        &[
            "joint_control.speed_integral: -1 is not allowed; it takes ",
            "joint_control.speed_filter: NaN is not allowed; it takes ",
            "joint_control.feed_forward[1]: 2 is not allowed; it takes ",
            "joint_control.output: `amp` is not known; it takes one of ",
            "joint_control.sampling: the law \"cascade_pi\" has a clock of its own; it takes \"period\"",
        ],
    );
    let good = "law = \"cascade_pi\"\nspeed_integral = 75.0\nspeed_filter = 0.0\nfeed_forward = [1.0, 0.0]\noutput = \"current\"";
    for (speed, position, text) in [
        (
            "0.00016",
            "0.0004",
            "position_period: 0.0004 is not allowed; it takes a whole multiple of speed_period",
        ),
        ("0.0", "0.00032", "speed_period: 0 is not allowed; it takes "),
        ("0.00032", "0.00016", "position_period: 0.00016 is not allowed; it takes a whole multiple"),
    ] {
        refused(
            "periods",
            &[
                ("law = \"cascade\"", good),
                ("feedback = \"motor\"\n", ""),
                ("sampling = \"continuous\"", &clock(speed, position)),
            ],
            &[&format!("joint_control.{text}")],
        );
    }
}

#[test]
fn resolution_that_cannot_be() {
    let coarse = "sampling = \"continuous\"\ntable_points = 1\nencoder_counts = 1";
    refused(
        "resolution",
        &[("sampling = \"continuous\"", coarse)],
        &[
            "joint_control.table_points: 1 is not allowed; it takes ",
            "joint_control.encoder_counts: 1 is not allowed; it takes ",
        ],
    );
}

/// Counts of the encoders are asked for by `[joint_control]`; toes and head have other encoders than the legs.
#[test]
fn encoders_with_counts_of_their_own() {
    let counts = |setup: &Setup| -> Vec<Option<u32>> {
        let drive = |name: &str| setup.robot.drives.iter().find(|drive| drive.name == name).unwrap();
        let names = ["left_knee_flexion", "left_toe_flexion", "head_pan"];
        names.map(|name| drive(name).control.resolution.encoder_counts).into()
    };
    let load = |scene: &str| Setup::load(&config::root(None), scene).unwrap();
    assert_eq!(counts(&load("walk_tables")), [Some(11520), Some(4000), Some(2000)]);
    assert_eq!(counts(&load("walk_2kmh_type3")), [None; 3], "nobody asked");
    refused(
        "counts",
        &[("encoder_counts = 4000", "encoder_counts = 4000.5")],
        &["motor.cha_14_toe.encoder_counts: is of type float; it takes a whole number from 2 to 16777216"],
    );
}

#[test]
fn drives_without_joint_control() {
    refused("uncontrolled", &[("[joint_control]", "[joint_contrl]")], &["joint_control: ", "joint_contrl: "]);
}

/// A row may have a law of its own, a scene one for all.
#[test]
fn joint_control_of_one_drive() {
    let own = "stator = \"right_thigh\"\njoint_control = { law = \"voltage\", position = 8.0, speed = 0.1, \
               sampling = \"cycle\", delay = 1, speed_from = \"state\" }";
    let spoilt = Spoilt::new("own", "robots/lola/robot.toml", &[("stator = \"right_thigh\"", own)]);
    spoilt.with_files_named();
    let robot = Robot::load(&spoilt.0).unwrap();
    let differ = robot.drives.iter().filter(|d| matches!(d.control.law, drives::ControlLaw::Voltage(_)));
    assert_eq!(differ.map(|d| d.name.as_str()).collect::<Vec<_>>(), ["right_knee_flexion"]);
}

#[test]
fn protection_that_cannot_be() {
    refused(
        "protection",
        &[
            ("following_error = 0.06 # [rad] at rest", "following_eror = 0.06"),
            ("following_time = 0.02 #", "following_time = -0.02 #"),
            ("over_current = 1.2 # [1]", "over_current = 0.9 # [1]"),
            ("surroundings = 25.0", "surroundings = nan"),
            ("\nwarning = 100.0", "\nwarning = 120.0"),
            ("continuous_current = 20.0 # [A]\nthermal_time = 60.0 # [s]\n", ""),
        ],
        &[
            "protection.following_error: missing; it takes a number from 1e-9 to 1e9 rad",
            "protection.following_eror: unknown key; the nearest known one is `following_error`",
            "protection.following_time: -0.02 is not allowed; it takes a number from 0 to 1e9 s",
            "protection.over_current: 0.9 is not allowed; it takes a number from 1 to 10",
            "protection.surroundings: NaN is not allowed; it takes a number from -40 to 60 deg C",
            "protection.warning: 120 deg C must lie between surroundings = NaN and temperature = 120 deg C",
            "protection.temperature: needs continuous_current and thermal_time of the motor of drive `right_hip_flexion`",
            "protection.temperature: needs continuous_current and thermal_time of the motor of drive `right_knee_flexion`",
            "protection.temperature: needs continuous_current and thermal_time of the motor of drive `left_hip_flexion`",
            "protection.temperature: needs continuous_current and thermal_time of the motor of drive `left_knee_flexion`",
        ],
    );
    refused(
        "cold",
        &[("\nwarning = 100.0", "\nwarning = 45.0"), ("surroundings = 25.0", "surroundings = 45.0")],
        &["protection.warning: 45 deg C must lie between surroundings = 45 and temperature = 120 deg C"],
    );
    refused(
        "thermal",
        &[("thermal_time = 60.0 # [s]\n", "")],
        &["motor.cha_25.thermal_time: missing; it takes a number from 1e-9 to 1e9 s"],
    );
}

#[test]
fn home_switches_that_cannot_be() {
    let pan = "[home.head_pan]\nangle_deg = 0.0\nfast = 0.3 # [rad/s]\nslow = 0.015 # [rad/s]";
    refused(
        "home",
        &[
            (pan, "[home.head_pam]\nangle_deg = 400.0\nfast = 0.3\nslow = true"),
            ("fast = 0.3 # [rad/s]", "fast = 0.0"),
        ],
        &[
            "home.head_pam: there is no joint `head_pam`; the nearest is `head_pan`",
            "home.head_pam.angle_deg: 400 is not allowed; it takes a number from -360 to 360 deg",
            "home.head_pam.slow: is of type boolean; it takes a number from 1e-9 to 1e9 rad/s",
            "home.head_tilt.fast: 0 is not allowed; it takes a number from 1e-9 to 1e9 rad/s",
        ],
    );
    refused(
        "unreachable",
        &[(pan, "[home.head_pan]\nangle_deg = -120.0\nfast = 30.0\nslow = 31.0")],
        &[
            "home.head_pan.angle_deg: -120 lies outside of the joint's range_deg [-108.0, 108.0]",
            "home.head_pan.fast: 30 rad/s is above the joint's speed_limit, 3 rad/s",
            "home.head_pan.slow: 31 rad/s must not be above fast = 30 rad/s",
        ],
    );
    refused(
        "home-type",
        &[(pan, "home.head_pan = 0.0\n[homes]")],
        &["protection.home: unknown key", "homes: unknown key; the nearest known one is `home`"],
    );
}
