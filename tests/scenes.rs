//! Every shipped scene, walked to its end and held against what it promises.

use harness::{Site, root};
use serde_json::Value;
use std::f64::consts::TAU;

const EXE: &str = harness::executable!();

/// \[rad\] Largest inclination error of an undisturbed walk.
const INCLINATION: f64 = 0.03;
/// \[rad\] The same on ground that the robot does not know of.
const UNKNOWN_GROUND: f64 = 0.06;
/// Share of the commanded speed that the walking speed may differ by.
const SPEED: f64 = 0.03;
/// Share of its length by which a closed path may miss its beginning.
const CLOSING: f64 = 0.05;

/// \[N\] Lola's.
const WEIGHT: f64 = 597.3;

/// The figures of a scene, after what holds for each: done to its end, on its feet, upright, fast.
fn figures(scene: &str, seconds: f64) -> Value {
    figures_within(scene, seconds, INCLINATION)
}

/// The same with another limit of the inclination error \[rad\].
fn figures_within(scene: &str, seconds: f64, inclination: f64) -> Value {
    let said = Site::new(EXE).gangwerk(&["sim", scene, "--json"]).well();
    let f: Value = serde_json::from_str(&said.out).unwrap_or_else(|e| panic!("{e}: {}", said.out));
    assert_eq!(f["scene"], scene);
    assert_eq!(f["fell"], false, "{f:#}");
    assert!((number(&f, "duration_s") - seconds).abs() < 0.01, "{f:#}");
    for axis in 0..2 {
        let error = f["inclination_error_max_rad"][axis].as_f64().unwrap();
        assert!(error <= inclination, "{scene}: {error} rad about axis {axis}");
    }
    f
}

fn number(figures: &Value, key: &str) -> f64 {
    figures[key].as_f64().unwrap_or_else(|| panic!("{key} of {figures:#}"))
}

/// Walks at this speed \[km/h\], to within [`SPEED`].
fn walks(figures: &Value, kmh: f64) {
    let is = 3.6 * number(figures, "mean_speed_m_s");
    assert!((is - kmh).abs() <= SPEED * kmh, "{is} km/h instead of {kmh}");
}

#[test]
fn stand() {
    let f = figures("stand", 10.0);
    assert_eq!(f["steps"], 0);
}

#[test]
fn walk_1kmh() {
    walks(&figures("walk_1kmh", 20.0), 1.0);
}

#[test]
fn walk_2kmh() {
    walks(&figures("walk_2kmh", 20.0), 2.0);
}

/// The cycle of 3.5 ms that her CAN lines leave room for. `tests/vcan` walks it over such lines. No force peak where a foot
/// lands (thesis 8.3): it once left the ground again and was put down at the speed of a search, with 1.3 of its load.
#[test]
fn can_2kmh() {
    let f = figures("can_2kmh", 20.0);
    walks(&f, 2.0);
    assert!(number(&f, "landing_peak_ratio") < 1.0, "{f:#}");
}

#[test]
fn walk_3kmh() {
    walks(&figures("walk_3kmh", 20.0), 3.0);
}

#[test]
fn walk_4kmh() {
    walks(&figures("walk_4kmh", 20.0), 4.0);
}

#[test]
fn walk_5kmh() {
    walks(&figures("walk_5kmh", 20.0), 5.0);
}

#[test]
fn walk_60s() {
    walks(&figures("walk_60s", 64.0), 1.0);
}

#[test]
fn walk_sideways() {
    let f = figures("walk_sideways", 20.0);
    walks(&f, 0.7);
    let [x, y] = [0, 1].map(|i| f["end_pose"][i].as_f64().unwrap());
    assert!(y > 1.9 && x.abs() < CLOSING * y, "sideways is to the left: {x}, {y}");
}

/// The same walk on every type of model: with motors, elastic gears, pads of finite elements.
#[test]
fn walk_type2() {
    walks(&figures("walk_type2", 20.0), 1.0);
}

/// Her motors' currents have no states, her head does not move.
#[test]
fn walk_without_currents() {
    let figures = figures("walk_without_currents", 20.0);
    walks(&figures, 1.0);
    assert!(
        figures["depth"].as_str().unwrap().starts_with("type 2, without currents, locked head_pan head_tilt")
    );
}

#[test]
fn walk_type3() {
    walks(&figures("walk_type3", 20.0), 1.0);
}

/// Hip flexion and knee: largest tracking error \[rad\] on the link's side and on the motor's.
fn tracking(figures: &Value) -> [f64; 2] {
    ["hip_knee_tracking_error_max_rad", "hip_knee_motor_side_error_max_rad"].map(|key| number(figures, key))
}

/// Lost, late, repeated and bent frames, a cable that slips, an arm that falls silent: she walks on.
#[test]
fn bus_faults() {
    let f = figures("bus_faults", 16.0);
    walks(&f, 2.0);
}

/// Thesis 8.1.1: hip flexion and knee follow within 8e-3 rad at 2 km/h, here on both sides of the gears.
#[test]
fn walk_2kmh_type3() {
    let f = figures("walk_2kmh_type3", 20.0);
    walks(&f, 2.0);
    let errors = tracking(&f);
    assert!(errors[0] < 8e-3 && errors[1] < 8e-3, "{errors:?}");
}

/// The same with the angle of the link and the speed of the motor (5.49), whose gains end at the stiffness of the gears.
#[test]
fn walk_link_motor() {
    let f = figures("walk_link_motor", 20.0);
    walks(&f, 2.0);
    let errors = tracking(&f);
    assert!(errors[0] < 15e-3, "{errors:?}");
}

/// The same with look-up tables in integers, counts, and targets every 3.5 ms as CAN carries them.
#[test]
fn walk_tables() {
    let f = figures("walk_tables", 20.0);
    walks(&f, 2.0);
    let errors = tracking(&f);
    assert!(errors[0] < 8e-3 && errors[1] < 8e-3, "{errors:?}");
}

/// Johnnie's motors under voltage control (5.40), in his control cycle: they follow as Lola's do, and feet land softly.
#[test]
fn johnnie_type3() {
    let f = figures("johnnie_type3", 21.0);
    walks(&f, 2.0);
    let errors = tracking(&f);
    assert!(errors[0] < 8e-3 && errors[1] < 8e-3, "{errors:?}");
    assert!(number(&f, "landing_peak_ratio") < 1.0, "{f:#}");
}

#[test]
fn walk_type4() {
    walks(&figures("walk_type4", 20.0), 1.0);
}

#[test]
fn walk_type5() {
    walks(&figures("walk_type5", 20.0), 1.0);
}

#[test]
fn walk_2kmh_sensors() {
    walks(&figures("walk_2kmh_sensors", 20.0), 2.0);
}

#[test]
fn board() {
    walks(&figures("board", 20.0), 1.0);
}

/// Type 3: early contact, an edge under the foot, a step down. Standing half on the edge she leans by more than
/// [`UNKNOWN_GROUND`] before a step catches her; what is demanded is that she then walks as told.
#[test]
fn board_2cm() {
    let f = figures_within("board_2cm", 20.0, f64::INFINITY);
    walks(&f, 1.0);
    assert!(f["end_pose"][0].as_f64().unwrap() > 3.4, "over the board and on: {f:#}");
}

/// The same board on heels.
#[test]
fn heel_strike() {
    let f = figures_within("heel_strike", 20.0, UNKNOWN_GROUND);
    assert!(f["end_pose"][0].as_f64().unwrap() > 3.4, "over the board and on: {f:#}");
}

/// Tilted ground, soft soles, a knee that reads wrong.
#[test]
fn plant_mismatch() {
    let f = figures_within("plant_mismatch", 20.0, UNKNOWN_GROUND);
    walks(&f, 2.0);
}

#[test]
fn holes() {
    let f = figures_within("holes", 24.0, UNKNOWN_GROUND);
    assert!(f["end_pose"][0].as_f64().unwrap() > 3.9, "over the holes and on: {f:#}");
}

#[test]
fn uneven() {
    let f = figures("uneven", 20.0);
    assert!(number(&f, "mean_speed_m_s") > 0.08 && number(&f, "steps") > 10.0, "{f:#}");
}

#[test]
fn stairs() {
    assert_eq!(figures("stairs", 5.0)["steps"], 0);
}

#[test]
fn passing_box() {
    let f = figures("passing_box", 12.0);
    assert!(number(&f, "steps") > 5.0 && number(&f, "distance_m") < 0.02, "stays where it is: {f:#}");
}

/// Nobody walks her: she stands in it. How she gets about: `studies/src/exploration`.
#[test]
fn room() {
    let f = figures("room", 20.0);
    assert_eq!(f["steps"], 0);
}

/// Stays where it is, with motors and elastic gears.
#[test]
fn walk_in_place() {
    let f = figures("walk_in_place", 20.0);
    let [x, y] = [0, 1].map(|i| f["end_pose"][i].as_f64().unwrap());
    assert!(number(&f, "steps") > 9.0 && x.hypot(y) < 0.1, "{f:#}");
}

#[test]
fn walk_backwards() {
    let f = figures("walk_backwards", 20.0);
    walks(&f, 0.54);
    assert!(f["end_pose"][0].as_f64().unwrap() < -1.5, "{f:#}");
}

/// Turns by what is commanded, and on the spot.
#[test]
fn walk_turn() {
    let f = figures("walk_turn", 20.0);
    let turn = number(&f, "step_turn_rad");
    let told = 0.2 * number(&f, "step_duration_s");
    assert!((turn - told).abs() <= SPEED * told, "{turn} rad per step instead of {told}");
    assert!(number(&f, "distance_m") < 0.2, "{f:#}");
}

/// Over a bar of 10 cm that the simulation has as well. `chain/tests/steps_over.rs` sees that it is not touched.
#[test]
fn obstacle() {
    let f = figures("obstacle", 20.0);
    assert!(f["end_pose"][0].as_f64().unwrap() > 3.0, "gets over it: {f:#}");
    assert!(number(&f, "peak_normal_force_n") < 1.8 * WEIGHT, "{f:#}");
}

/// Onto 15 cm and down again.
#[test]
fn platform() {
    let f = figures("platform", 30.0);
    assert!(f["end_pose"][0].as_f64().unwrap() > 2.3, "gets down behind it: {f:#}");
    assert!(number(&f, "steps") > 8.0, "{f:#}");
}

#[test]
fn distance() {
    let stood = figures("stand", 10.0);
    let f = figures("distance", 20.0);
    let x = |f: &Value| f["end_pose"][0].as_f64().unwrap();
    let walked = x(&f) - x(&stood);
    assert!((walked - 3.0).abs() < 0.01, "{walked} m");
}

#[test]
fn johnnie_2kmh() {
    walks(&figures("johnnie_2kmh", 21.0), 2.0);
}

#[test]
fn johnnie_motor_encoders() {
    walks(&figures("johnnie_motor_encoders", 21.0), 2.0);
}

#[test]
fn johnnie_25kmh() {
    walks(&figures("johnnie_25kmh", 21.0), 2.5);
}

/// Pushed twice by 2 N s, which 20 kg feel as Lola would 6.
#[test]
fn archie_stand() {
    let f = figures("archie_stand", 10.0);
    assert_eq!(f["steps"], 0);
    for axis in 0..2 {
        // Standing without a push reaches 0.7 mrad: the pushes were there.
        assert!(f["inclination_error_max_rad"][axis].as_f64().unwrap() > 0.003, "{f:#}");
    }
}

/// With the steps of his thesis (6.2), ten times as fast.
#[test]
fn archie_walk() {
    let f = figures("archie_walk", 20.0);
    walks(&f, 0.75);
    assert!((number(&f, "step_length_m") - 0.25).abs() < 0.01, "{f:#}");
}

/// As his thesis reports it: 0.25 m in 12 s, without a look at the world.
#[test]
fn archie_static() {
    let f = figures("archie_static", 160.0);
    let speed = number(&f, "step_length_m") / number(&f, "step_duration_s");
    assert!((speed - 0.25 / 12.0).abs() < 0.02 * 0.25 / 12.0, "{f:#}");
    assert!(number(&f, "steps") > 9.0, "{f:#}");
}

/// The same steps, played by the drives from tables: into the walk, from plan to plan, to a stand two steps on.
#[test]
fn archie_tables() {
    let f = figures("archie_tables", 55.0);
    assert_eq!((&f["steps"], &f["ended_by"]), (&3.into(), &"done".into()));
    let [x, y] = [0, 1].map(|i| f["end_pose"][i].as_f64().unwrap());
    assert!((x - 0.5).abs() < 0.05 && y.abs() < 0.01, "{f:#}");
}

/// From his crane: every joint finds its angle at a switch, and the drives that protect themselves let him make some steps.
#[test]
fn archie_startup() {
    assert!(number(&figures("archie_startup", 18.0), "steps") >= 4.0);
}

/// The model is chosen, the same one every time, and it says why.
#[test]
fn walk_auto() {
    let f = figures("walk_auto", 6.0);
    assert_eq!(f["depth"], figures("walk_auto", 6.0)["depth"]);
    let reason = f["depth_reason"].as_str().unwrap();
    assert!(reason.starts_with("type ") && reason.contains("estimated error: inclination "), "{reason}");
    assert!(number(&f, "steps") > 2.0, "{f:#}");
}

/// A full circle: back where it began, facing where it faced.
#[test]
fn walk_curve() {
    let f = figures("walk_curve", 43.0);
    let length = number(&f, "distance_m");
    assert!(length > 6.0, "{length} m are no circle of 1.1 m radius");
    let [x, y, heading] = [0, 1, 2].map(|i| f["end_pose"][i].as_f64().unwrap());
    assert!(x.hypot(y) <= CLOSING * length, "ends at {x}, {y}");
    assert!(heading.abs() <= CLOSING * TAU, "faces {heading} rad");
}

#[test]
fn push() {
    let f = figures("push", 20.0);
    // The same walk on the spot without a push reaches 11 mrad: the push was there.
    assert!(f["inclination_error_max_rad"][1].as_f64().unwrap() > 0.012, "{f:#}");
}

/// From the crane to a walk; what is told and refused on the way: `chain/tests/start_up.rs`.
#[test]
fn startup() {
    walks(&figures("startup", 30.0), 1.0);
}

#[test]
fn demo() {
    let f = figures("demo", 34.0);
    let heading = f["end_pose"][2].as_f64().unwrap();
    assert!(number(&f, "steps") > 20.0 && heading > 1.0, "walks and turns: {f:#}");
}

/// Where she looks meanwhile: `chain/tests/gaze.rs`.
#[test]
fn gaze() {
    walks(&figures("gaze", 20.0), 2.0);
}

/// No scene is shipped without a test here.
#[test]
fn every_shipped_scene_is_tested() {
    let tests = std::fs::read_to_string(root().join("tests/scenes.rs")).unwrap();
    for entry in std::fs::read_dir(root().join("config/scenes")).unwrap().flatten() {
        let path = entry.path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        assert!(tests.contains(&format!("\nfn {name}() {{")), "scene {name} has no test");
    }
}
