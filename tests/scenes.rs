//! Every shipped scene, walked to its end and held against what it promises.

use harness::{Site, root};
use serde_json::Value;
use std::f64::consts::TAU;

const EXE: &str = env!("CARGO_BIN_EXE_gangwerk");

/// \[rad\] Largest inclination error of an undisturbed walk.
const INCLINATION: f64 = 0.03;
/// Share of the commanded speed that the walking speed may differ by.
const SPEED: f64 = 0.03;
/// Share of its length by which a closed path may miss its beginning.
const CLOSING: f64 = 0.05;
/// Simulated time over processor time with type 1, planner and stabilizer in the loop, in an optimised build.
const REAL_TIMES: f64 = 10.0;

/// The figures of a scene, after what holds for each: done to its end, on its feet, upright, fast.
fn figures(scene: &str, seconds: f64) -> Value {
    let said = Site::new(EXE).gangwerk(&["sim", scene, "--json"]).well();
    let f: Value = serde_json::from_str(&said.out).unwrap_or_else(|e| panic!("{e}: {}", said.out));
    assert_eq!(f["scene"], scene);
    assert_eq!(f["fell"], false, "{f:#}");
    assert!((number(&f, "duration_s") - seconds).abs() < 0.01, "{f:#}");
    for axis in 0..2 {
        let error = f["inclination_error_max_rad"][axis].as_f64().unwrap();
        assert!(error <= INCLINATION, "{scene}: {error} rad about axis {axis}");
    }
    if !cfg!(debug_assertions) && f["depth"].as_str().is_some_and(|d| d.starts_with("type 1")) {
        assert!(number(&f, "real_time_factor") >= REAL_TIMES, "{f:#}");
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

#[test]
fn walk_3kmh() {
    walks(&figures("walk_3kmh", 20.0), 3.0);
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

#[test]
fn walk_type3() {
    walks(&figures("walk_type3", 20.0), 1.0);
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

#[test]
fn johnnie_2kmh() {
    walks(&figures("johnnie_2kmh", 21.0), 2.0);
}

#[test]
fn johnnie_25kmh() {
    walks(&figures("johnnie_25kmh", 21.0), 2.5);
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

#[test]
fn demo() {
    let f = figures("demo", 34.0);
    let heading = f["end_pose"][2].as_f64().unwrap();
    assert!(number(&f, "steps") > 20.0 && heading > 1.0, "walks and turns: {f:#}");
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
