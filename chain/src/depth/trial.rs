//! The begin of a scene, simulated with one method, and how two of these differ.

use std::error::Error;

use config::Setup;
use config::method::Method;
use config::tolerance::Output;
use messages::SimState;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use realtime::clock::processor_time;

use crate::Chain;
use crate::ending::is_doubt;

/// What a scene did with one method: the outputs of every cycle.
pub struct MethodTrial {
    /// The method.
    pub method: Method,
    /// \[s\] Processor time it took.
    pub cpu_s: f64,
    /// Whether the robot fell.
    pub fell: bool,
    /// Whether the simulation itself failed: it diverged, or a drive, the contact or the integrator left its model.
    lost: bool,
    /// \[rad\] Inclination about x and y.
    inclination: Vec<[f64; 2]>,
    /// \[N\] Force on each foot.
    force: Vec<[[f64; 3]; 2]>,
    /// \[rad\] Joints, all of one cycle after the other.
    angle: Vec<f64>,
    /// \[N m\] The same: of motors with their gears, or, without these, by inverse dynamics.
    torque: Vec<f64>,
    /// \[A\] Motors; empty without any.
    current: Vec<f64>,
    /// \[m\] Torso at the end of the trial.
    position: [f64; 3],
}

impl MethodTrial {
    /// Simulates the first `cycles` bus cycles of a scene, everything in the loop.
    ///
    /// # Errors
    /// The robot lacks what the method's type needs, or the configuration is wrong.
    pub fn run(setup: &Setup, method: Method, cycles: usize) -> Result<Self, Box<dyn Error>> {
        let mut setup = setup.clone();
        setup.scene.choose(method);
        // What a step that is too long does is what a trial is for.
        setup.scene.force_step = true;
        let mut chain = Chain::new(&setup)?;
        let mut trial = Self {
            method,
            cpu_s: 0.0,
            fell: false,
            lost: false,
            inclination: Vec::with_capacity(cycles),
            force: Vec::with_capacity(cycles),
            angle: Vec::with_capacity(cycles * setup.robot.joints.len()),
            torque: Vec::new(),
            current: Vec::new(),
            position: [0.0; 3],
        };
        let begun = processor_time();
        for _ in 0..cycles {
            let cycle = chain.step();
            trial.lost |= cycle.events.iter().any(|(_, code, _)| is_doubt(*code));
            let sim = cycle.sim_state;
            trial.add(&setup, &sim);
            if method.depth > 1 {
                trial.add_motors(&setup, chain.robot().integrated());
            } else {
                let n = setup.robot.joints.len();
                trial.torque.resize(trial.torque.len() + n, 0.0);
                let first = trial.torque.len() - n;
                chain.parts().0.joint_torques(&mut trial.torque[first..]);
            }
        }
        trial.cpu_s = (processor_time() - begun) as f64 * 1e-9;
        Ok(trial)
    }

    fn add(&mut self, setup: &Setup, sim: &SimState) {
        let [x, y, z, w] = sim.orientation;
        let up = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).inverse() * Vector3::z();
        self.inclination.push([up.y.atan2(up.z), (-up.x).atan2(up.z)]);
        self.force.push([sim.foot_wrench[0].force, sim.foot_wrench[1].force]);
        self.angle.extend_from_slice(&sim.joint_angle[..setup.robot.joints.len()]);
        self.position = sim.position;
        self.fell |= sim.fallen == 1;
    }

    /// Currents end the state vector; the joints' angles and speeds stand as [`sim_backend::layout`] says.
    fn add_motors(&mut self, setup: &Setup, state: &[f64]) {
        let (robot, n) = (&setup.robot, setup.robot.joints.len());
        let (angle, speed) = (&state[7..7 + n], &state[13 + n..13 + 2 * n]);
        let current = &state[state.len() - robot.drives.len()..];
        let first = self.torque.len();
        self.torque.resize(first + n, 0.0);
        for (drive, current) in robot.drives.iter().zip(current) {
            let at = |x: &[f64]| std::array::from_fn(|i| drive.joints.get(i).map_or(0.0, |&j| x[j]));
            // A drive beyond its dead point is an event of its own, and moves nothing.
            let ratio = drive.transmission.at(at(angle), at(speed)).map_or([0.0; 3], |gear| gear.ratio);
            for (&joint, ratio) in drive.joints.iter().zip(ratio) {
                self.torque[first + joint] += ratio * drive.motor.torque(*current);
            }
        }
        self.current.extend_from_slice(current);
    }

    /// How far `other` is from this in one output, in its unit; infinite if either is lost or fell, or
    /// if one of them has no such output.
    pub fn distance(&self, other: &Self, output: Output) -> f64 {
        let missing = output.needs_motors() && (self.current.is_empty() || other.current.is_empty());
        if missing || self.lost || other.lost || self.fell || other.fell {
            return f64::INFINITY;
        }
        match output {
            Output::Inclination => largest(self.inclination.as_flattened(), other.inclination.as_flattened()),
            Output::FootForce => (0..2).map(|foot| self.force_rms(other, foot)).fold(0.0, f64::max),
            Output::JointAngle => largest(&self.angle, &other.angle),
            Output::JointTorque => largest(&self.torque, &other.torque),
            Output::MotorCurrent => largest(&self.current, &other.current),
            Output::Position => (Vector3::from(self.position) - Vector3::from(other.position)).norm(),
        }
    }

    fn force_rms(&self, other: &Self, foot: usize) -> f64 {
        let square = |(a, b): (&[[f64; 3]; 2], &[[f64; 3]; 2])| {
            (Vector3::from(a[foot]) - Vector3::from(b[foot])).norm_squared()
        };
        let sum: f64 = self.force.iter().zip(&other.force).map(square).sum();
        (sum / self.force.len().max(1) as f64).sqrt()
    }
}

/// Largest difference; a difference that is no number is infinite.
fn largest(a: &[f64], b: &[f64]) -> f64 {
    let difference = |(a, b): (&f64, &f64)| (a - b).abs();
    a.iter().zip(b).map(difference).map(|d| if d.is_nan() { f64::INFINITY } else { d }).fold(0.0, f64::max)
}
