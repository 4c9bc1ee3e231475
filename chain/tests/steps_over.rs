//! Feet on their way touch nothing: neither the bar that is stepped over nor the edge of the platform.

use chain::Chain;
use config::{Setup, root};

/// Largest force \[N\] on a foot that is moved forward in the air; each of them was lifted over `high` \[m\] at some time.
fn force_on_the_way(scene: &str, high: f64) -> f64 {
    const SPEED: f64 = 0.2; // [m/s]
    let setup = Setup::load(&root(None), scene).expect("a shipped scene");
    let mut chain = Chain::new(&setup).expect("a shipped scene");
    let (mut force, mut lifted, mut before) = (0.0f64, [0.0f64; 2], [0.0f64; 2]);
    for _ in 0..(setup.scene.duration / setup.scene.cycle) as u64 {
        let cycle = chain.step();
        let state = &cycle.controller_state;
        for foot in 0..2 {
            let load = if foot == 0 { 1.0 - state.load_left } else { state.load_left };
            let x = state.feet_desired[foot][0];
            let moved = (x - before[foot]) / setup.scene.cycle;
            before[foot] = x;
            // A new planning frame is no motion: then the foot has landed.
            if load == 0.0 && moved > SPEED && moved < 10.0 {
                lifted[foot] = lifted[foot].max(state.feet_desired[foot][2]);
                force = cycle.sim_state.foot_wrench[foot].force.iter().fold(force, |f, x| f.max(x.abs()));
            }
        }
    }
    assert!(lifted.iter().all(|z| *z > high), "{scene}: {lifted:?}");
    force
}

#[test]
fn a_bar_is_not_touched() {
    assert_eq!(force_on_the_way("obstacle", 0.12), 0.0);
}

#[test]
fn the_edge_of_a_platform_is_not_touched() {
    assert_eq!(force_on_the_way("platform", 0.05), 0.0);
}
