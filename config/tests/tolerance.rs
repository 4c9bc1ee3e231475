//! What `depth = "auto"` of a scene becomes, and what is said about wrong ones.

use config::method::Integrator;
use config::method::Method;
use config::tolerance::{Output, Tolerance};
use config::{ConfigError, Scene, Setup, root};

/// Seven lines, then what the test says about depth.
const TOP: &str = "about = \"A test.\"\nrobot = \"lola\"\ngait = \"lola\"\ncycle = 0.001\nstart_pose = \"stand\"\n\
                   duration = 1.0\nseed = 1\n";

fn scene(test: &str, depth: &str) -> Result<Scene, ConfigError> {
    let path = std::env::temp_dir().join(format!("gangwerk-tolerance-{test}-{}.toml", std::process::id()));
    std::fs::write(&path, format!("{TOP}{depth}")).unwrap();
    let scene = Scene::load(&path);
    let _ = std::fs::remove_file(path);
    scene
}

/// The problems of a scene, without the file's name.
fn problems(test: &str, depth: &str) -> Vec<String> {
    let error = scene(test, depth).unwrap_err();
    error.problems.iter().map(ToString::to_string).collect()
}

#[test]
fn outputs_and_trial() {
    let text = "depth = \"auto\"\n[tolerance]\nmotor_current = 5\ninclination = 0.01\ntrial = 4.0";
    let outputs = vec![(Output::Inclination, 0.01), (Output::MotorCurrent, 5.0)];
    let wanted = Tolerance { outputs, trial: Some(4.0) };
    assert!(wanted.needs_motors());
    assert_eq!(scene("outputs", text).unwrap().auto, Some(wanted));
}

#[test]
fn a_chosen_method_replaces_the_stand_in() {
    let mut scene = scene("chosen", "depth = \"auto\"\n[tolerance]\nposition = 0.01").unwrap();
    let method = Method { depth: 3, integrator: Integrator::SemiImplicit, substeps: 4 };
    scene.choose(method);
    assert_eq!((scene.method(), scene.auto), (method, None));
}

#[test]
fn a_depth_that_is_said_needs_no_choice() {
    let setup = Setup::load(&root(None), "stand").unwrap();
    assert_eq!(setup.scene.auto, None);
    assert!(setup.with_method(None).is_ok());
}

#[test]
fn an_open_depth_is_not_simulated() {
    let setup = Setup::load(&root(None), "walk_auto").unwrap();
    assert_eq!(
        setup.clone().with_method(None).unwrap_err(),
        "scene walk_auto: its depth is \"auto\", and nobody has chosen yet; `gangwerk sim` and `gangwerk run` do"
    );
    let method = Method { depth: 1, integrator: Integrator::Euler, substeps: 2 };
    assert_eq!(setup.with_method(Some(method)).unwrap().scene.method(), method);
}

#[test]
fn wrong_depths() {
    let steps = "integrator = \"euler\"\nsubsteps = 4\n";
    assert_eq!(
        problems("word", "depth = \"atuo\"\n[tolerance]\nposition = 0.01"),
        ["line 8: depth: `atuo` is not allowed; it takes a whole number from 1 to 5, or \"auto\""]
    );
    assert_eq!(
        problems("steps", &format!("depth = \"auto\"\n{steps}[tolerance]\nposition = 0.01")),
        [
            "line 9: integrator: depth \"auto\" chooses it; leave it out",
            "line 10: substeps: depth \"auto\" chooses it; leave it out"
        ]
    );
    assert_eq!(
        problems("table", &format!("depth = 1\n{steps}[tolerance]\nposition = 0.01")),
        ["line 11: tolerance: a table of tolerances needs depth = \"auto\", which chooses type and steps"]
    );
}

#[test]
fn wrong_tolerances() {
    let all = "`inclination`, `foot_force`, `joint_angle`, `joint_torque`, `motor_current`, `position`";
    assert_eq!(
        problems("missing", "depth = \"auto\""),
        [format!("line 1: tolerance: missing; depth \"auto\" takes a table with at least one of {all}")]
    );
    assert_eq!(
        problems("empty", "depth = \"auto\"\n[tolerance]\ntrial = 3.0"),
        [format!("line 9: tolerance: names no output; it takes at least one of {all}")]
    );
    assert_eq!(
        problems("misspelt", "depth = \"auto\"\n[tolerance]\nposition = 0.01\nfoot_forces = 1.0"),
        ["line 11: tolerance.foot_forces: unknown key; the nearest known one is `foot_force`"]
    );
    assert_eq!(
        problems("range", "depth = \"auto\"\n[tolerance]\nposition = 0.0\ntrial = 600"),
        [
            "line 10: tolerance.position: 0 is not allowed; it takes a number from 1e-9 to 1e9 m",
            "line 11: tolerance.trial: 600 is not allowed; it takes a number from 0.1 to 60 s"
        ]
    );
}
