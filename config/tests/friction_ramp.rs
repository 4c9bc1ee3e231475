//! Ramp in place of dry friction, of a scene that asks for one.

use config::{ConfigError, Scene, root, scene::FRICTION_RAMP};

/// The shipped scene `stand` with another method.
fn scene(test: &str, method: &str) -> Result<Scene, ConfigError> {
    let stand = std::fs::read_to_string(root(None).join("scenes/stand.toml")).unwrap();
    let key = |line: &&str| ["depth", "integrator", "substeps"].iter().any(|key| line.starts_with(key));
    let rest: Vec<&str> = stand.lines().filter(|line| !key(line)).collect();
    let path = std::env::temp_dir().join(format!("gangwerk-ramp-{test}-{}.toml", std::process::id()));
    std::fs::write(&path, format!("{method}\n{}", rest.join("\n"))).unwrap();
    let scene = Scene::load(&path);
    let _ = std::fs::remove_file(path);
    scene
}

const EXPLICIT: &str = "depth = 2\nintegrator = \"rk4\"\nsubsteps = 100\n";

#[test]
fn a_scene_that_says_none_has_the_default() {
    assert_eq!(scene("default", EXPLICIT).unwrap().friction_ramp, FRICTION_RAMP);
    let semi_implicit = "depth = 2\nintegrator = \"semi_implicit\"\nsubsteps = 4";
    assert_eq!(scene("as_it_is", semi_implicit).unwrap().friction_ramp, FRICTION_RAMP);
}

#[test]
fn a_width_is_read_in_its_range() {
    let of = |test, width| scene(test, &format!("{EXPLICIT}friction_ramp = {width}"));
    assert_eq!(of("narrow", "0.01").unwrap().friction_ramp, 0.01);
    for (test, width) in [("zero", "0.0"), ("wide", "1000.0"), ("negative", "-1.0")] {
        let error = of(test, width).unwrap_err().to_string();
        assert!(error.contains("line 4: friction_ramp") && error.contains("rad/s"), "{error}");
    }
}

#[test]
fn who_sees_dry_friction_as_it_is_has_no_ramp() {
    for (test, method) in [
        ("sticks", "depth = 2\nintegrator = \"semi_implicit\"\nsubsteps = 4"),
        ("reduced", "depth = 1\nintegrator = \"euler\"\nsubsteps = 4"),
    ] {
        let error = scene(test, &format!("{method}\nfriction_ramp = 0.1")).unwrap_err().to_string();
        assert!(error.contains("line 4: friction_ramp: it is for"), "{error}");
    }
}
