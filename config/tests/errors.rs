//! What a person reads who made a mistake: the whole text, because the text is what is promised.

use std::fs;
use std::path::{Path, PathBuf};

use config::{ConfigError, Gait, Robot, Scene, Setup, System};

/// A configuration that a test may spoil; gone when dropped. Gait, scenes and system are those of `tests/fixture`, so
/// that lines stay where they are when the shipped ones are tuned.
pub(crate) struct Copy(pub(crate) PathBuf);

impl Copy {
    pub(crate) fn new(test: &str) -> Self {
        let to = std::env::temp_dir().join(format!("gangwerk-config-{test}-{}", std::process::id()));
        let shipped = config::root(None);
        let fixture = shipped.join("tests/fixture");
        for (from, directory) in [
            (&fixture, ""),
            (&fixture, "gaits"),
            (&fixture, "scenes"),
            (&shipped, "robots/lola"),
            (&shipped, "robots/lola/can"),
        ] {
            fs::create_dir_all(to.join(directory)).unwrap();
            let files = fs::read_dir(from.join(directory)).unwrap().map(Result::unwrap);
            for file in files.filter(|file| file.path().is_file()) {
                fs::copy(file.path(), to.join(directory).join(file.file_name())).unwrap();
            }
        }
        Self(to)
    }

    pub(crate) fn path(&self, file: &str) -> PathBuf {
        self.0.join(file)
    }

    /// Replaces the first `from` in a file; it must be there.
    pub(crate) fn spoil(self, file: &str, from: &str, to: &str) -> Self {
        let text = fs::read_to_string(self.path(file)).unwrap();
        assert!(text.contains(from), "{file} does not contain {from}");
        fs::write(self.path(file), text.replacen(from, to, 1)).unwrap();
        self
    }

    fn gait(&self) -> ConfigError {
        Gait::load(&self.path("gaits/lola.toml")).unwrap_err()
    }

    pub(crate) fn scene(&self, name: &str) -> ConfigError {
        Setup::load(&self.0, name).unwrap_err()
    }

    pub(crate) fn robot(&self) -> ConfigError {
        Robot::load(&self.path("robots/lola")).unwrap_err()
    }
}

impl Drop for Copy {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The text of an error without the directory, which differs from run to run.
pub(crate) fn text(error: &ConfigError) -> String {
    let directory = error.file.parent().unwrap_or(Path::new("")).display().to_string();
    error.to_string().replace(&format!("{directory}/"), "")
}

#[test]
fn misspelt_key() {
    let copy = Copy::new("misspelt").spoil("gaits/lola.toml", "swing_height", "swing_heigth");
    assert_eq!(
        text(&copy.gait()),
        "lola.toml: 2 problems\n  \
         line 3: step.swing_height: missing; it takes a number from 0 to 0.5 m\n  \
         line 6: step.swing_heigth: unknown key; the nearest known one is `swing_height`"
    );
}

#[test]
fn surplus_key() {
    let copy = Copy::new("surplus").spoil("gaits/lola.toml", "[model]", "[model]\nleg_heigt = 0.2");
    assert_eq!(
        text(&copy.gait()),
        "lola.toml: line 23: model.leg_heigt: unknown key; the nearest known one is `leg_height`"
    );
}

#[test]
fn wrong_type() {
    let copy = Copy::new("type").spoil("gaits/lola.toml", "width = 0.21", "width = \"0.21\"");
    assert_eq!(
        text(&copy.gait()),
        "lola.toml: line 4: step.width: is of type string; it takes a number from 1e-9 to 1e9 m"
    );
}

#[test]
fn out_of_range() {
    let copy = Copy::new("range").spoil("gaits/lola.toml", "swing_height = 0.055", "swing_height = 55");
    assert_eq!(
        text(&copy.gait()),
        "lola.toml: line 6: step.swing_height: 55 is not allowed; it takes a number from 0 to 0.5 m"
    );
}

#[test]
fn nan_and_infinity() {
    let copy = Copy::new("nan").spoil("gaits/lola.toml", "com_height = 0.79", "com_height = nan").spoil(
        "gaits/lola.toml",
        "height_p = 1500.0",
        "height_p = inf",
    );
    assert_eq!(
        text(&copy.gait()),
        "lola.toml: 2 problems\n  \
         line 23: model.com_height: NaN is not allowed; it takes a number from 0.1 to 3 m\n  \
         line 40: control.height_p: inf is not allowed; it takes a number from 0 to 1e9 N/m"
    );
}

#[test]
fn all_problems_at_once_in_the_order_of_lines() {
    let copy = Copy::new("all")
        .spoil("gaits/lola.toml", "force_filter = 0.02", "force_filter = true")
        .spoil("gaits/lola.toml", "width = 0.21", "width = 0.1")
        .spoil("gaits/lola.toml", "[0.12, 0.1, 0.1]", "[0.12, 0.1]")
        .spoil("gaits/lola.toml", "side = [-0.2, 0.2]", "side = [0.2, -0.2]")
        .spoil("gaits/lola.toml", "friction = 0.5", "");
    assert_eq!(
        text(&copy.gait()),
        "lola.toml: 5 problems\n  \
         line 4: step.width: 0.1 m must not be below width_min = 0.16 m\n  \
         line 12: step.change: has 2 entries; it takes 3 numbers, each a number from 1e-9 to 1e9 m, m, rad\n  \
         line 22: model.friction: missing; it takes a number from 1e-9 to 1e9\n  \
         line 32: limits.side: its lower end 0.2 must lie below its upper end -0.2 m\n  \
         line 53: control.force_filter: is of type boolean; it takes a number from 0 to 1 s"
    );
}

#[test]
fn rules_of_a_gait() {
    let copy = Copy::new("rules")
        .spoil("gaits/lola.toml", "first_length = 0.3", "first_length = 0.7")
        .spoil("gaits/lola.toml", "[0.2833, 0.34, 1.2]", "[0.6, 0.34, 1.2]")
        .spoil("gaits/lola.toml", "swing_lag = 0.05", "swing_lag = 0.6");
    assert_eq!(
        text(&copy.gait()),
        "lola.toml: 4 problems\n  \
         line 3: step: first_length 0.7 is above limits.length 0.66 m\n  \
         line 3: step: swing_lag + swing_lead = 0.65 s leave nothing of a swing of 0.560 s\n  \
         line 3: step: by_speed[1]: 0.34 m in 1.2 s are 0.283 m/s, not 0.6\n  \
         line 14: step.by_speed: its speeds must ascend"
    );
}

#[test]
fn not_toml() {
    let copy = Copy::new("syntax").spoil("gaits/lola.toml", "width = 0.21", "width 0.21");
    let error = copy.gait();
    assert_eq!(error.problems[0].line, 4);
    assert!(text(&error).starts_with("lola.toml: line 4: not TOML: "), "{error}");
}

#[test]
fn missing_files() {
    let copy = Copy::new("missing");
    assert_eq!(
        text(&copy.scene("dmeo")),
        "dmeo.toml: there is no scene `dmeo`; did you mean demo? `gangwerk scene list` shows them all"
    );
    let copy = copy.spoil("robots/lola/robot.toml", "lola.urdf", "lolita.urdf");
    assert_eq!(
        text(&copy.robot()),
        "lolita.urdf: cannot be read: No such file or directory (os error 2); there is lola"
    );
    let error = System::load(&copy.path("nowhere/system.toml")).unwrap_err();
    assert!(text(&error).ends_with("is no directory either, so check --config"), "{error}");
}

#[test]
fn robot_and_its_joints() {
    let file = "robots/lola/robot.toml";
    let copy = Copy::new("joints")
        .spoil(file, "toe = \"right_toe_flexion\"", "toe = \"right_toe_flexoin\"")
        .spoil(file, "right_knee_flexion = 40", "right_knee_flexion = 140");
    let wanted = [
        "foot.right.toe: there is no joint `right_toe_flexoin`; the nearest is `right_toe_flexion`",
        "pose_deg.stand.right_knee_flexion: 140 lies outside of the joint's range_deg [0.5, 115.0]",
    ];
    let error = text(&copy.robot());
    for line in wanted {
        assert!(error.contains(line), "{line}\nis not in\n{error}");
    }
    assert!(error.starts_with("robot.toml: 2 problems"), "{error}");
}

#[test]
fn mass_that_the_urdf_does_not_have() {
    let copy = Copy::new("mass").spoil(
        "robots/lola/lola.urdf",
        "<mass value=\"0.138\"/>",
        "<mass value=\"13.80\"/>",
    );
    assert_eq!(
        text(&copy.robot()),
        "lola.urdf: its masses sum to 74.547 kg, but total_mass in robot.toml is 60.885 kg"
    );
}

#[test]
fn scene_and_its_commands() {
    let copy = Copy::new("scene")
        .spoil("scenes/demo.toml", "integrator = \"euler\"", "integrator = \"heun\"")
        .spoil("scenes/demo.toml", "time = 3.0", "time = 35.0")
        .spoil("scenes/demo.toml", "forward = 0.278", "forwards = 0.278")
        .spoil("scenes/demo.toml", "\"walk/stop\"", "\"walk/halt\"");
    assert_eq!(
        text(&copy.scene("demo")),
        "demo.toml: 6 problems\n  \
         line 5: integrator: `heun` is not known; it takes one of `euler`, `rk4`, `semi_implicit`, `bdf`\n  \
         line 12: command: command[1]: its time 35 s lies after the end of the scene, 34 s\n  \
         line 12: command: command[2]: its time 10 s lies before 35 s of the one above it\n  \
         line 18: command[1].topic: walk/velocity: give it numbers, for example forward=<m/s> left=<m/s> turn=<rad/s>\n  \
         line 19: command[1].forwards: unknown key; the nearest known one is `forward`\n  \
         line 34: command[4].topic: `walk/halt` is not known; it takes one of `system/emergency_stop`, \
         `system/reset`, `system/enable`, `system/end`, `walk/stand`, `walk/start`, `walk/stop`, `walk/step`, \
         `walk/velocity`, `walk/distance`, `walk/platform`, `joint/home`, `joint/zero_force`, `sim/lower`, `head/fixate`, `head/joints`, `head/rest`, \
         `vision/box`, `vision/gone`"
    );
}

#[test]
fn scene_that_robot_and_gait_cannot_do() {
    let copy = Copy::new("fit")
        .spoil("scenes/demo.toml", "start_pose = \"stand\"", "start_pose = \"stadn\"")
        .spoil("scenes/demo.toml", "forward = 0.555", "forward = 1.5");
    assert_eq!(
        text(&copy.scene("demo")),
        "demo.toml: 2 problems\n  \
         start_pose: robot lola has no pose `stadn`; the nearest is `stand`; there is `crouch`, `hang`, `stand`, `straight`\n  \
         command[2]: at 10 s: forward = 1.5 is beyond by_speed's 0.9429 m/s of gait lola"
    );
}

#[test]
fn sensors_of_a_scene() {
    let copy = Copy::new("sensors").spoil(
        "scenes/stand.toml",
        "seed = 1",
        "seed = 1\n\
         [sensors.encoder]\n\
         bits = { all = 17.5, right_toe_flexion = 40 }\n\
         [sensors.motor_encoder]\n\
         counts = 11520\n\
         [sensors.force_torque]\n\
         bias_compensation = true\n\
         noise = [1.0, -0.1]\n\
         inertai = true\n\
         [sensors.imu]\n\
         bandwidth = 0\n\
         rate_noise = true",
    );
    assert_eq!(
        text(&copy.scene("stand")),
        "stand.toml: 8 problems\n  \
         line 12: sensors.encoder.bits.right_toe_flexion: 40 is not allowed; it takes a number from 1 to 32 bit\n  \
         line 12: sensors.encoder.bits: 17.5 is not a whole number\n  \
         line 13: sensors.motor_encoder.gear_ratio: missing; counts are those of one turn of the motor\n  \
         line 16: sensors.force_torque.bias_compensation: takes away the weight below the sensor: it needs inertia = true\n  \
         line 17: sensors.force_torque.noise[1]: -0.1 is not allowed; it takes a number from 0 to 10000 N, N m\n  \
         line 18: sensors.force_torque.inertai: unknown key; the nearest known one is `inertia`\n  \
         line 20: sensors.imu.bandwidth: 0 is not allowed; it takes a number from 0.001 to 100000 Hz\n  \
         line 21: sensors.imu.rate_noise: is of type boolean; it takes a number from 0 to 1000 rad/s"
    );
}

#[test]
fn sensors_of_joints_that_the_robot_lacks() {
    let copy = Copy::new("sensor-joint").spoil(
        "scenes/stand.toml",
        "seed = 1",
        "seed = 1\n[sensors.encoder]\nbias_rad = { right_ankle_flexoin = -0.05 }",
    );
    assert_eq!(
        text(&copy.scene("stand")),
        "stand.toml: sensors.encoder.bias_rad: robot lola has no joint `right_ankle_flexoin`; \
         the nearest is `right_ankle_flexion`"
    );
}

#[test]
fn head_and_arms() {
    let file = "robots/lola/robot.toml";
    let copy = Copy::new("head")
        .spoil(file, "pan = \"head_pan\"", "pan = \"head_pain\"")
        .spoil(file, "saccade_speed = 2.5", "saccade_speed = 3.5")
        .spoil(file, "pursuit_speed = 2.0", "pursuit_speed = 4.0")
        .spoil(file, "nearest = 0.2", "nearest = -0.2")
        .spoil(file, "left = \"left_shoulder_flexion\"", "left = \"left_shoulder\"");
    let error = text(&copy.robot());
    for line in [
        "robot.toml: 5 problems",
        "head.pan: there is no joint `head_pain`; the nearest is `head_pan`",
        "head.saccade_speed: is above the 3 rad/s of joint `head_tilt`",
        "head.pursuit_speed: is above saccade_speed",
        "head.nearest: -0.2 is not allowed",
        "arms.left: there is no joint `left_shoulder`",
    ] {
        assert!(error.contains(line), "{line}\nis not in\n{error}");
    }
}

#[test]
fn what_a_robot_without_head_and_arms_cannot_do() {
    let copy = Copy::new("headless").spoil("gaits/lola.toml", "[step]", "arm_swing = 1.0\n[step]").spoil(
        "scenes/demo.toml",
        "topic = \"walk/stop\"",
        "topic = \"head/rest\"",
    );
    let file = copy.path("robots/lola/robot.toml");
    let text_of = fs::read_to_string(&file).unwrap();
    let (from, to) = (text_of.find("[head]").unwrap(), text_of.find("[can]").unwrap());
    fs::write(&file, text_of.replace(&text_of[from..to], "")).unwrap();
    assert_eq!(
        text(&copy.scene("demo")),
        "demo.toml: 2 problems\n  \
         command[4]: head/rest: robot lola has no [head]\n  \
         gait: gait lola has arm_swing, but robot lola has no [arms]"
    );
}

#[test]
fn what_the_software_is_not_told() {
    let copy = Copy::new("unknown").spoil(
        "scenes/stand.toml",
        "seed = 1",
        "seed = 1\n[plant_mismatch]\nground_tilt = [0.0, 50.0]\ncontact_stiffness = 0\njoint_ofset_rad = 0.1",
    );
    assert_eq!(
        text(&copy.scene("stand")),
        "stand.toml: 3 problems\n  \
         line 12: plant_mismatch.ground_tilt[1]: 50 is not allowed; it takes a number from -30 to 30 deg\n  \
         line 13: plant_mismatch.contact_stiffness: 0 is not allowed; it takes a number from 0.001 to 1000\n  \
         line 14: plant_mismatch.joint_ofset_rad: unknown key; the nearest known one is `joint_offset_rad`"
    );
    let copy = Copy::new("unknown-joint").spoil(
        "scenes/stand.toml",
        "seed = 1",
        "seed = 1\n[plant_mismatch]\njoint_offset_rad = { right_kne_flexion = 0.01 }",
    );
    assert_eq!(
        text(&copy.scene("stand")),
        "stand.toml: plant_mismatch.joint_offset_rad: robot lola has no joint `right_kne_flexion`; \
         the nearest is `right_knee_flexion`"
    );
}

#[test]
fn masses_that_cannot_be() {
    let masses = "seed = 1\n\
                  [plant_mismatch]\n\
                  ground_height = 0.1\n\
                  mass_factor = { all = 0.0 }\n\
                  payload = { mass = -8.0, position = [0.0, 0.0, 0.0] }";
    let copy = Copy::new("masses").spoil("scenes/stand.toml", "seed = 1", masses);
    let found = text(&copy.scene("stand"));
    for key in ["ground_height: 0.1", "mass_factor.all: 0", "payload.mass: -8"] {
        assert!(found.contains(&format!("plant_mismatch.{key} is not allowed")), "{key} in {found}");
    }
    let masses = "seed = 1\n[plant_mismatch]\nmass_factor = { right_kne_flexion = 1.1 }";
    let copy = Copy::new("masses-joint").spoil("scenes/stand.toml", "seed = 1", masses);
    assert!(text(&copy.scene("stand")).contains("plant_mismatch.mass_factor: robot lola has no joint"));
}

#[test]
fn crane_that_cannot_be() {
    let crane = "seed = 1\n\
                 [crane]\n\
                 height = -0.1\n\
                 hook = \"high\"\n\
                 rope = 0.0\n\
                 stifness = 6e4\n\
                 damping = nan\n\
                 speed = 2.0";
    let copy = Copy::new("crane").spoil("scenes/stand.toml", "seed = 1", crane);
    assert_eq!(
        text(&copy.scene("stand")),
        "stand.toml: 7 problems\n  \
         line 11: crane.stiffness: missing; it takes a number from 1000 to 1e7 N/m\n  \
         line 12: crane.height: -0.1 is not allowed; it takes a number from 0 to 2 m\n  \
         line 13: crane.hook: is of type string; it takes a number from 0 to 2 m\n  \
         line 14: crane.rope: 0 is not allowed; it takes a number from 0.1 to 20 m\n  \
         line 15: crane.stifness: unknown key; the nearest known one is `stiffness`\n  \
         line 16: crane.damping: NaN is not allowed; it takes a number from 0 to 100000 N s/m\n  \
         line 17: crane.speed: 2 is not allowed; it takes a number from 1e-9 to 1 m/s"
    );
    let copy = Copy::new("no-crane").spoil(
        "scenes/stand.toml",
        "topic = \"walk/stand\"",
        "topic = \"sim/lower\"\ndistance = 0.1",
    );
    assert_eq!(text(&copy.scene("stand")), "stand.toml: command[0]: sim/lower: the scene has no [crane]");
    let copy = Copy::new("crane-type").spoil("scenes/stand.toml", "seed = 1", "seed = 1\ncrane = true");
    assert_eq!(
        text(&copy.scene("stand")),
        "stand.toml: line 11: crane: is of type boolean; it takes a table"
    );
}

#[test]
fn drives_at_switch_on_that_cannot_be() {
    let drives = "seed = 1\n[drives]\nhomming = true\nhoming = 1";
    let copy = Copy::new("drives").spoil("scenes/stand.toml", "seed = 1", drives);
    assert_eq!(
        text(&copy.scene("stand")),
        "stand.toml: 2 problems\n  \
         line 12: drives.homming: unknown key; the nearest known one is `homing`\n  \
         line 13: drives.homing: is of type integer; it takes true or false"
    );
}

/// A robot that can neither protect its drives nor find references.
#[test]
fn drives_of_a_robot_without_protection_and_home_switches() {
    let copy =
        Copy::new("unprotected").spoil("scenes/stand.toml", "seed = 1", "seed = 1\n[drives]\nhoming = true");
    let file = copy.path("robots/lola/robot.toml");
    let whole = fs::read_to_string(&file).unwrap();
    let (from, to) = (whole.find("[protection]").unwrap(), whole.find("[gear.").unwrap());
    fs::write(&file, whole.replace(&whole[from..to], "")).unwrap();
    assert_eq!(
        text(&copy.scene("stand")),
        "stand.toml: 2 problems\n  \
         drives: robot lola has no [protection]\n  \
         drives.homing: robot lola has no [home.JOINT]: every joint knows its angle"
    );
}

#[test]
fn system_row_of_no_process() {
    let copy = Copy::new("system").spoil("system.toml", "[process.planner]", "[process.planer]");
    let error = System::load(&copy.path("system.toml")).unwrap_err();
    let error = text(&error);
    assert!(error.contains("process.planner: missing; it takes a table"), "{error}");
    assert!(error.contains("process.planer: unknown key; the nearest known one is `planner`"), "{error}");
}

#[test]
fn start_order_that_is_not_every_process_once() {
    for wrong in ["\"planner\", \"planner\", ", "\"planer\", ", ""] {
        let copy = Copy::new("order").spoil("system.toml", "\"planner\", ", wrong);
        let error = text(&System::load(&copy.path("system.toml")).unwrap_err());
        assert!(
            error.contains("start_order: must name each process once: broker, logger, "),
            "{wrong}: {error}"
        );
    }
}

#[test]
fn emergency_stop_below_a_process() {
    let copy = Copy::new("estop").spoil("system.toml", "priority = 85", "priority = 80");
    let error = text(&System::load(&copy.path("system.toml")).unwrap_err());
    assert!(error.contains("emergency_stop: priority = 80 must be above 80, that of watchdog"), "{error}");
}

#[test]
fn hash_changes_with_every_file() {
    let hash = |copy: &Copy| Setup::load(&copy.0, "stand").unwrap().hash;
    let untouched = hash(&Copy::new("hash"));
    assert_eq!(untouched, hash(&Copy::new("hash")));
    for (file, from) in [
        ("scenes/stand.toml", "seed = 1"),
        ("gaits/lola.toml", "[step]"),
        ("system.toml", "[process.broker]"),
        ("robots/lola/robot.toml", "[contact]"),
        ("robots/lola/lola.urdf", "<robot"),
    ] {
        let spoilt = Copy::new("hash").spoil(file, from, &format!(" {from}"));
        assert_ne!(hash(&spoilt), untouched, "{file}");
    }
}

#[test]
fn a_scene_alone() {
    let scene = Scene::load(&config::root(None).join("scenes/push.toml")).unwrap();
    assert_eq!(scene.name, "push");
    assert_eq!(scene.pushes.len(), 1);
}
