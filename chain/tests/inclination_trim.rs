//! Standing levels the inclination: of a robot whose IMU is mounted askew, or whose torso is heavier on one side than its software
//! believes, the stabilizer learns what is wrong. Held against the truth of the simulated robot: its inclination, and
//! where its centre of gravity is.

use chain::{Chain, parallel};
use config::{Setup, root};
use messages::{Command, GaitState};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// \[rad\] Largest bias about each axis; robots.
const BIAS: f64 = 0.02;
const ROBOTS: usize = 12;
/// \[s\] Of standing, the first two of which she stands up.
const STANDS: f64 = 8.0;
/// \[rad\] Inclination that may be left. Five times what noise and steps of the sensors are.
const LEFT: f64 = 1e-3;

/// A number of `[-1, 1]`.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Stands for so long; the chain then.
fn stand(change: impl Fn(&mut Setup)) -> Chain {
    let mut setup = Setup::load(&root(None), "walk_2kmh_sensors").unwrap();
    setup.scene.commands.retain(|(_, command)| *command == Command::Stand);
    setup.scene.duration = STANDS + 1.0;
    change(&mut setup);
    let mut chain = Chain::new(&setup).unwrap();
    for _ in 0..(STANDS / chain.cycle()) as u64 {
        chain.step();
    }
    chain
}

#[test]
fn a_bias_of_the_imu_is_learned() {
    let mut seed = 2611;
    let biases: Vec<[f64; 2]> = (0..ROBOTS).map(|_| [0, 1].map(|_| BIAS * random(&mut seed))).collect();
    let seen = parallel::map(ROBOTS, |k| {
        let [roll, pitch] = biases[k];
        let mut chain = stand(|setup| setup.scene.sensors.imu.bias = [roll, pitch, 0.0]);
        let c = chain.step();
        assert_eq!(c.controller_state.gait, GaitState::Standing as u64);
        let [x, y, z, w] = c.sim_state.orientation;
        let up = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).inverse() * Vector3::z();
        ([up.y.atan2(up.z), -up.x.atan2(up.z)], c.controller_state.inclination_trim)
    });
    for (bias, (lean, trim)) in biases.iter().zip(seen) {
        for i in 0..2 {
            assert!(lean[i].abs() < LEFT, "bias {bias:?} leaves {lean:?} rad, trim {trim:?}");
            assert!((trim[i] - bias[i]).abs() < LEFT, "bias {bias:?}: trim {trim:?}");
        }
    }
}

/// The centre of gravity comes to stand where the plan wants it, in the middle between the feet, to a tenth of the shift.
#[test]
fn a_torso_that_is_heavier_on_one_side_is_brought_over_the_feet() {
    let shifts = [[0.0, 0.03, 0.0], [0.03, 0.0, 0.0], [-0.02, -0.02, 0.0]];
    let at = |shift: [f64; 3]| {
        let mut chain = stand(|setup| setup.scene.plant_mismatch.torso_cog_shift = shift);
        let c = chain.step();
        [0, 1].map(|d| c.sim_state.com[d] - 0.5 * (c.sim_state.feet[0][d] + c.sim_state.feet[1][d]))
    };
    let all: Vec<[f64; 2]> =
        parallel::map(shifts.len() + 1, |k| at(if k == 0 { [0.0; 3] } else { shifts[k - 1] }));
    for (shift, is) in shifts.iter().zip(&all[1..]) {
        let off = (is[0] - all[0][0]).hypot(is[1] - all[0][1]);
        assert!(
            off < 0.1 * shift[0].hypot(shift[1]),
            "{shift:?}: {off} m beside that of a robot as described"
        );
    }
}
