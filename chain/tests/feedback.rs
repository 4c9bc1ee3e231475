//! Figure 5.8: both feedback paths walk, on the model with motors and elastic gears.

use chain::Chain;
use config::Setup;
use config::gait::StabilizerGains;

/// Root mean square of the inclination errors \[rad\] over a walk of some steps, `None` if the robot falls.
fn walk(scene: &str, set: impl Fn(&mut StabilizerGains)) -> Option<f64> {
    let mut setup = Setup::load(&config::root(None), scene).unwrap();
    set(&mut setup.gait.control);
    let mut chain = Chain::new(&setup).unwrap();
    let (mut square, mut cycles) = (0.0, 0.0);
    for _ in 0..(10.0 / setup.scene.cycle) as u64 {
        let c = chain.step();
        if c.sim_state.fallen == 1 {
            return None;
        }
        if c.sim_state.time > 4.0 {
            square += c.controller_state.inclination_error.iter().map(|e| e * e).sum::<f64>();
            cycles += 1.0;
        }
    }
    Some((square / cycles).sqrt())
}

/// "Experiments with both versions showed similar performance", the first being more robust: it takes a higher gain.
#[test]
fn both_feedback_paths_walk_alike_and_the_first_takes_the_higher_gain() {
    let path_1 = walk("walk_type3", |_| {}).expect("feedback path 1 walks");
    let path_2 =
        walk("walk_type3", |c| (c.feedback, c.drift_gain) = (2, 10.0)).expect("feedback path 2 walks");
    println!("rms of the inclination errors: path 1 {path_1:.5} rad, path 2 {path_2:.5} rad");
    assert!(path_2 < 2.0 * path_1 && path_1 < 2.0 * path_2, "{path_1} {path_2}");
    let stiff = walk("walk_type3", |c| (c.feedback, c.drift_gain) = (2, 100.0));
    assert!(stiff.is_none_or(|rms| rms > 2.0 * path_1), "{stiff:?}");
}

/// Section 4.9: the soles' deformation is compensated in the trajectories or by force control.
#[test]
fn both_compensations_of_the_soles_deformation_walk_alike() {
    let force = walk("walk_type3", |_| {}).expect("compensation by force control walks");
    let set = |c: &mut StabilizerGains| (c.force_feed_forward, c.planned_deformation) = (0.0, 1.0);
    let trajectory = walk("walk_type3", set).expect("compensation in the trajectories walks");
    println!(
        "rms of the inclination errors: by force control {force:.5} rad, in the trajectories {trajectory:.5} rad"
    );
    assert!((force - trajectory).abs() < 0.5 * force, "{force} {trajectory}");
}
