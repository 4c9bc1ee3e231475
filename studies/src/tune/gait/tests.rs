//! Tuned walks of Johnnie.

use config::method::{Integrator, Method};

use super::*;
use crate::figures_of_thesis::Thesis;

fn given<'a>(root: &'a std::path::Path) -> Given<'a> {
    Given { config: root, progress: &|_, _, _| () }
}

fn study(free: &[&str], out: &str) -> TuneGait {
    TuneGait {
        scene: "johnnie_25kmh".into(),
        free: free.iter().map(|text| text.parse().unwrap()).collect(),
        set: Vec::new(),
        cost: vec!["inclination".parse().unwrap()],
        methods: vec![Optimizer::ImplicitFiltering],
        evaluations: 12,
        seed: 1,
        places: 1,
        pushes: 4,
        speeds: Vec::new(),
        slices: 0,
        out: std::env::temp_dir().join(format!("gangwerk-tune-{out}-{}", std::process::id())),
    }
}

/// The cost of the walk as shipped is that of figure 4.17, which another study computes; a few walks find a cheaper one, and the
/// gait's file that is written walks as it says.
#[test]
fn johnnie_walks_with_less_sway() {
    let root = config::root(None);
    let study = study(&["model.leg_mass=0.0:0.15"], "sway");
    let sheet = study.run(&given(&root)).unwrap().json();
    let thesis = Thesis { figure: Some("4.17".into()), depth: 1, out: study.out.clone() };
    let shipped = &thesis.run(&given(&root)).unwrap().json()["figures"][0]["walks"][0]["cost_rad2_s"];
    let (start, best) = (&sheet["terms"][0]["start"], &sheet["terms"][0]["best"]);
    let [start, best, shipped] = [start, best, shipped].map(|x| x.as_f64().unwrap());
    assert!((start / shipped - 1.0).abs() < 1e-3, "{start} instead of {shipped}");
    assert!(best < start, "{best} instead of {start}");
    let text = std::fs::read_to_string(sheet["gait"].as_str().unwrap()).unwrap();
    assert!(text.starts_with("# Tuned by `gangwerk tune gait`") && text.contains("# How Johnnie walks."));
    let setup = Setup::load(&root, "johnnie_25kmh").unwrap().with_gait(&text).unwrap();
    assert_eq!(setup.gait.model.leg_mass, sheet["values"][0]["best"].as_f64().unwrap());
    assert_eq!(cost::walk(&setup, &study.cost, &study.trials(&setup).unwrap()).unwrap().terms[0], best);
    std::fs::remove_dir_all(&study.out).unwrap();
}

/// The step length at the scene's speed takes its duration with it.
#[test]
fn a_step_is_as_long_as_its_speed_says() {
    let setup = Setup::load(&config::root(None), "johnnie_25kmh").unwrap();
    let free = ["step.length=0.44:0.48".parse().unwrap()];
    let parameters = Parameters::new(&setup, &[], &free).unwrap();
    assert!((parameters.start().unwrap()[0] - 0.425).abs() < 1e-12);
    let [speed, length, duration] =
        parameters.setup_at(&DVector::repeat(1, 1.0)).unwrap().gait.step.by_speed[3];
    assert_eq!((speed, length), (0.6945, 0.48));
    assert!((duration - 0.48 / 0.6945).abs() < 1e-15);
}

/// Ground and pushes cost what is not survived, and are held against others in the table and in the file; a scene that walks nowhere
/// has none.
#[test]
#[ignore = "long"]
fn ground_and_pushes_cost_what_is_not_survived() {
    let root = config::root(None);
    let mut study = TuneGait {
        scene: "walk_2kmh".into(),
        cost: ["ground=2", "pushes"].map(|text| text.parse().unwrap()).to_vec(),
        evaluations: 1,
        methods: vec![Optimizer::Random],
        ..study(&["step.swing_height=0.05:0.08"], "robust")
    };
    let sheet = study.run(&given(&root)).unwrap().json();
    let share = |name: &str| {
        let mut rows = sheet["terms"].as_array().unwrap().iter();
        rows.find(|row| row["name"] == name).unwrap()["best"].as_f64().unwrap()
    };
    let (ground, pushes) = (share("ground"), share("pushes"));
    assert!((sheet["searches"][0]["cost"].as_f64().unwrap() - 2.0 * ground - pushes).abs() < 1e-12);
    // One place of five kinds, and four pushes.
    assert!((5.0 * ground).fract() < 1e-9 && (4.0 * pushes).fract() < 1e-9, "{ground} {pushes}");
    let text = std::fs::read_to_string(sheet["gait"].as_str().unwrap()).unwrap();
    for name in ["ground, others", "pushes, others"] {
        assert!((0.0..=1.0).contains(&share(name)) && text.contains(&format!("# {name}: ")), "{text}");
    }
    std::fs::remove_dir_all(&study.out).unwrap();
    study.scene = "stand".into();
    let told = study.run(&given(&root)).unwrap_err().to_string();
    assert_eq!(told, "scene stand: without walk/velocity it has neither ground nor pushes");
}

/// A walk that falls costs more than any walk, and the more the sooner.
#[test]
fn a_fall_is_no_walk() {
    let fallen = |at| WalkCost { terms: [f64::NAN; TERMS.len()], cost: cost::NO_WALK * (2.0 - at / 20.0) };
    assert!(!fallen(20.0).walked() && fallen(3.0).cost > fallen(9.0).cost);
    let mut setup = Setup::load(&config::root(None), "johnnie_25kmh").unwrap();
    setup.gait.control.inclination_p = [0.0; 2];
    setup.gait.control.inclination_d = [0.0; 2];
    let none = Trials { speeds: Vec::new(), places: 1, pushes: 1, seed: 1 };
    let walk = cost::walk(&setup, &["inclination".parse().unwrap()], &none).unwrap();
    assert!(!walk.walked() && walk.terms[0].is_nan() && walk.cost > cost::NO_WALK, "{walk:?}");
}

/// Regression: a walk of a simulation that is not to be trusted cost as little as any other.
#[test]
fn a_walk_that_is_not_to_be_trusted_is_none() {
    let mut setup = Setup::load(&config::root(None), "walk_2kmh").unwrap();
    // Too few steps in a cycle for the feet of type 3; the robot walks as told all the same.
    setup.scene.choose(Method { depth: 3, integrator: Integrator::SemiImplicit, substeps: 2 });
    setup.scene.force_step = true; // it is refused otherwise
    let none = Trials { speeds: Vec::new(), places: 1, pushes: 1, seed: 1 };
    let walk = cost::walk(&setup, &["inclination".parse().unwrap()], &none).unwrap();
    assert!(!walk.walked(), "{walk:?}");
}

#[test]
fn what_cannot_be_tuned_is_named() {
    let root = config::root(None);
    let run = |free: &[&str], set: &[&str]| {
        let mut study = study(free, "refused");
        study.set = set.iter().map(|text| text.parse().unwrap()).collect();
        study.run(&given(&root)).unwrap_err().to_string()
    };
    for (free, set, expected) in [
        (&["model.leg_mas=0:0.1"][..], &[][..], "--free model.leg_mas: there is no `leg_mas`"),
        (
            &["model.leg_mass=0.1:0.2"],
            &[],
            "--free model.leg_mass: 0.082 of the gait lies outside of 0.1 to 0.2; say @START",
        ),
        (&["model.leg_mass=0:0.1", "model.leg_mass=0:0.1"], &[], "--free model.leg_mass: named twice"),
        (&["model.leg_mass=0:0.1"], &["model.height=1"], "--set model.height: there is no `height`"),
        (
            &["step.length=0.3:0.4@0.35"],
            &["step.by_speed.3.0=0.7"],
            "--free step.length: step.by_speed has no row for 0.6945 m/s, only for 0, 0.2778, 0.5556, 0.7",
        ),
    ] {
        assert_eq!(run(free, set), expected);
    }
    // The file's own checks, at the bounds.
    let beyond = run(&["model.leg_mass=0:2@0.1"], &[]);
    assert!(
        beyond.starts_with("--free model.leg_mass = 2: gaits/johnnie.toml: line ")
            && beyond.contains("leg_mass"),
        "{beyond}"
    );
    for text in ["x", "x=1", "x=1:1", "x=2:1", "x=a:1", "x=0:1@2", "x=0:inf"] {
        assert!(text.parse::<FreeNumber>().is_err(), "{text}");
    }
    for text in ["sway", "inclination=0", "inclination=x", "inclination=inf"] {
        assert!(text.parse::<WeightedTerm>().is_err(), "{text}");
    }
}
