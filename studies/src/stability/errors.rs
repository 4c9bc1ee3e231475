//! Errors that a robot or its world can have: what is wrong, by how much it is tried, and how it gets into a scene.

use config::Setup;
use config::sensors::PerJoint;
use config::terrain::{ObjectShape, TerrainObject, TerrainPose};

/// \[m\] Where the board lies, how long and wide it is; as in the scene `board`.
const BOARD: (f64, [f64; 2]) = (1.2, [0.4, 1.2]);
/// Joints whose calibration is wrong, of one leg, so far as a robot has them.
const JOINTS: [&str; 4] =
    ["right_hip_adduction", "right_knee_flexion", "right_ankle_flexion", "right_ankle_adduction"];

/// Puts an error of a size into a scene.
type Apply = dyn Fn(&mut Setup, f64) + Sync;

/// An error that a scene can have.
pub(super) struct ErrorSource {
    pub(super) name: String,
    pub(super) unit: &'static str,
    /// Tried at most, in the unit; zero on a side that does not exist.
    pub(super) tried: [f64; 2],
    /// Bisection ends with brackets this narrow, in the unit.
    pub(super) resolution: f64,
    /// The number is a power of two.
    pub(super) factor: bool,
    pub(super) apply: Box<Apply>,
}

impl ErrorSource {
    pub(super) fn new(
        name: impl Into<String>,
        unit: &'static str,
        tried: [f64; 2],
        resolution: f64,
        apply: impl Fn(&mut Setup, f64) + Sync + 'static,
    ) -> Self {
        Self { name: name.into(), unit, tried, resolution, factor: false, apply: Box::new(apply) }
    }
}

/// All errors that make sense for a scene in which the robot gets `way` \[m\] far.
pub(super) fn kinds(setup: &Setup, way: f64) -> Vec<ErrorSource> {
    let mut all = Vec::new();
    // What the robot believes of itself: inclination, zeros of its joints. Then the ground, the soles, the sensors' delay.
    for (axis, name) in ["roll", "pitch"].into_iter().enumerate() {
        all.push(ErrorSource::new(format!("IMU bias, {name}"), "deg", [-20.0, 20.0], 0.1, move |s, x| {
            s.scene.sensors.imu.bias[axis] = x.to_radians();
        }));
    }
    for joint in JOINTS.into_iter().filter(|joint| setup.robot.joint(joint).is_some()) {
        let name = format!("calibration of {}", joint.replace('_', " "));
        all.push(ErrorSource::new(name, "deg", [-20.0, 20.0], 0.1, move |s, x| {
            let own = vec![(joint.to_string(), x.to_radians())];
            s.scene.plant_mismatch.joint_offset = PerJoint { all: None, own };
        }));
    }
    for (axis, name) in ["roll", "pitch"].into_iter().enumerate() {
        all.push(ErrorSource::new(
            format!("tilt of the ground, {name}"),
            "deg",
            [-15.0, 15.0],
            0.1,
            move |s, x| {
                s.scene.plant_mismatch.ground_tilt[axis] = x.to_radians();
            },
        ));
    }
    if setup.scene.depth == 3 || setup.scene.depth == 5 {
        let gears = ErrorSource::new("stiffness of the gears, factor", "1", [-8.0, 6.0], 0.1, |s, x| {
            for elasticity in s.robot.drives.iter_mut().filter_map(|drive| drive.elasticity.as_mut()) {
                elasticity.stiffness.iter_mut().for_each(|k| *k *= x.exp2());
            }
        });
        all.push(ErrorSource { factor: true, ..gears });
    }
    let stiffness = ErrorSource::new("stiffness of the soles, factor", "1", [-8.0, 6.0], 0.1, |s, x| {
        s.scene.plant_mismatch.contact_stiffness = x.exp2();
        // The stiffer the layer, the shorter the steps that it allows; else they would be the border, and not the robot.
        s.scene.substeps = (f64::from(s.scene.substeps) * x.exp2().max(1.0)).ceil() as u32;
    });
    all.push(ErrorSource { factor: true, ..stiffness });
    all.push(ErrorSource::new("delay of all sensors", "ms", [0.0, 100.0], 1.0, |s, x| {
        let (delay, sensors) = (x.round() * 1e-3, &mut s.scene.sensors);
        (sensors.encoder.delay, sensors.motor_encoder.delay) = (delay, delay);
        (sensors.force_torque.delay, sensors.imu.delay) = (delay, delay);
    }));
    if way > BOARD.0 + 0.5 * BOARD.1[0] {
        all.push(ErrorSource::new("height of a board in the way", "mm", [0.0, 100.0], 0.5, |s, x| {
            s.scene.objects.push(board(x * 1e-3));
        }));
    }
    all
}

fn board(height: f64) -> TerrainObject {
    let (x, [length, width]) = BOARD;
    TerrainObject {
        name: "board".into(),
        shape: ObjectShape::Box([length, width, height]),
        pose: TerrainPose { position: [x, 0.0, 0.5 * height], rotation: [0.0; 3] },
        friction: None,
        appears: 0.0,
        vanishes: f64::INFINITY,
        keeps_clear: 0.0,
        known: false,
        poses: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use chain::Chain;
    use config::method::Integrator;

    /// Regression: on soles of 3.67 times the stiffness type 3 fell by the steps of the simulation.
    #[test]
    fn stiffer_soles_are_tried_in_steps_that_are_stable_on_them() {
        for (depth, integrator) in [(1, Integrator::Euler), (3, Integrator::SemiImplicit)] {
            let mut setup = Setup::load(&config::root(None), "walk_1kmh").unwrap();
            (setup.scene.depth, setup.scene.integrator) = (depth, integrator);
            let kinds = kinds(&setup, 0.0);
            let soles = kinds.iter().find(|kind| kind.name == "stiffness of the soles, factor").unwrap();
            for x in [soles.tried[0], 0.0, 2.5, soles.tried[1]] {
                let mut setup = setup.clone();
                (soles.apply)(&mut setup, x);
                assert!(Chain::new(&setup).is_ok(), "type {depth}, {} times", x.exp2());
            }
        }
    }
}
