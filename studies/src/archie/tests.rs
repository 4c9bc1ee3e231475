use super::statics::{Deviation, Statics};
use super::*;
use messages::JointTargets;
use messages::MAX_JOINTS;

/// Statics on one foot against the closed form: the edge of the sole, drawn in by 1 - m g h / K.
#[test]
fn edge_of_a_soft_sole_is_drawn_in() {
    let setup = open_loop(&config::root(None), STEPS, |_| ()).unwrap();
    let pattern = setup.gait.pattern.unwrap();
    let mut statics = Statics::new(&setup.robot, &setup.gait).unwrap();
    // The torso passes the middle of the sole a third into a single support.
    let t = pattern.step_time + pattern.double_support + 2.0;
    let (weight, [aside, ahead, height]) = statics.over_stance(t).unwrap();
    let half = setup.robot.feet[0].support[3];
    let stiffness = 4.0 * setup.robot.contact.normal_stiffness * half * half;
    assert!(ahead.abs() < 0.05, "{ahead} m");
    let edge = half * (1.0 - weight * height / stiffness);
    let closed = ((edge - aside.abs()) / height).atan();
    let (mut stands, mut tips) = (0.0, 0.3);
    for _ in 0..30 {
        let middle = 0.5 * (stands + tips);
        let mut wrong = Deviation::NONE;
        // Downhill towards the side on which the centre of gravity is.
        wrong.slope[0] = -middle * aside.signum();
        let holds = statics.stands(t, &wrong).unwrap();
        *(if holds { &mut stands } else { &mut tips }) = middle;
    }
    assert!((stands / closed - 1.0).abs() < 0.1, "{stands} rad, closed form {closed} rad, {aside} m");
}

#[test]
fn late_drives_play_the_same_path() {
    let mut late = LateDrives::new(0.01, 0.2);
    let mut lag = [0.0; MAX_JOINTS];
    (lag[1], lag[2]) = (0.1234, 9.0);
    for k in 0..200 {
        let mut targets = JointTargets::default();
        let t = 0.01 * f64::from(k);
        targets.angle = [3.0 * t; MAX_JOINTS];
        late.delay(&mut targets, &lag);
        assert!((targets.angle[0] - 3.0 * t).abs() < 1e-12);
        assert!((targets.angle[1] - 3.0 * (t - 0.1234).max(0.0)).abs() < 1e-12 || t < 0.14);
        assert!(targets.angle[2] <= targets.angle[1], "longer than it remembers: as late as it can");
    }
}

/// The short form of the study, on type 1: less than predicted is walked, twice as much is not.
#[test]
fn zero_and_ground_are_borne_as_predicted() {
    let root = config::root(None);
    let mut setup = open_loop(&root, 2, |_| ()).unwrap();
    setup.scene.depth = 1;
    let bench = Bench::new(setup, LANDINGS[1].min(1)).unwrap();
    let all = causes(&bench.setup);
    let found = |name: &str, side: usize| {
        let cause = all.iter().find(|cause| cause.name == name).unwrap();
        (cause, predicted(cause, cause.tried[side], &bench).unwrap())
    };
    let cases =
        [("zero of left ankle adduction", 1), ("zero of right hip adduction", 0)].map(|(n, s)| found(n, s));
    let walked = parallel::map(4, |k| {
        let (cause, x) = cases[k / 2];
        (cause.name.clone(), k % 2 == 0, bench.bears(cause, [0.6, 2.0][k % 2] * x))
    });
    for (name, borne, is) in walked {
        assert_eq!(is, borne, "{name}");
    }
}
