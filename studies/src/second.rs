//! A second of motion from the chain: where it begins and what the joints were told in each cycle, to be replayed through
//! one model with other methods. Nothing but the simulated robot differs then.

use std::error::Error;

use config::Setup;
use messages::JointTargets;
use sim_backend::drive::{JointCubic, JointMotion};
use sim_backend::integrate::Stepper;
use sim_backend::plant::{Plant, PlantInputs};

use chain::Chain;

/// What the drives are supplied with while a second is replayed: motors on, nobody pushes.
pub const POWERED: PlantInputs = PlantInputs::POWERED;

/// A second of motion.
pub struct Second {
    /// State of the equations of motion at its begin.
    pub state: Vec<f64>,
    /// \[s\] Bus cycle.
    pub cycle: f64,
    joints: usize,
    /// Of the cycle before, and of all cycles.
    targets: Vec<JointTargets>,
}

impl Second {
    /// `cycles` cycles of a scene from `begin` \[s\] on.
    ///
    /// # Errors
    /// A configuration or robot is wrong, or the robot falls.
    pub fn record(setup: &Setup, begin: f64, cycles: usize) -> Result<Self, Box<dyn Error>> {
        let mut chain = Chain::new(setup)?;
        let before = (0..(begin / setup.scene.cycle).round() as usize)
            .fold(JointTargets::default(), |_, _| chain.step().joint_targets);
        let state = chain.robot().integrated().to_vec();
        let mut targets = vec![before];
        targets.extend((0..cycles).map(|_| chain.step().joint_targets));
        if chain.robot().state().fallen == 1 {
            return Err(format!(
                "scene {}: the robot falls on the model {}",
                setup.scene.name,
                setup.scene.model()
            )
            .into());
        }
        Ok(Self { state, cycle: setup.scene.cycle, joints: setup.robot.joints.len(), targets })
    }

    /// Number of its cycles.
    pub fn cycles(&self) -> usize {
        self.targets.len() - 1
    }

    /// How the joints are to move in a cycle.
    pub fn drives(&self, cycle: usize) -> impl Iterator<Item = JointCubic> + '_ {
        let [from, to] = [&self.targets[cycle], &self.targets[cycle + 1]];
        (0..self.joints).map(move |j| {
            let before = JointMotion { angle: from.angle[j], speed: from.speed[j], acceleration: 0.0 };
            JointCubic::follow(before, to.angle[j], to.speed[j], self.cycle)
        })
    }

    /// Advances `x` by a cycle in `steps` steps.
    pub fn advance(
        &self,
        plant: &mut Plant,
        stepper: &mut Stepper,
        steps: u32,
        drives: &[JointCubic],
        x: &mut [f64],
    ) {
        let h = self.cycle / f64::from(steps);
        for i in 0..steps {
            stepper.step(plant, f64::from(i) * h, h, x, drives, &POWERED);
        }
    }
}
