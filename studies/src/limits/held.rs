//! The simulated robot with its supply on and all joints told to stay where they are.

use codec::frames::{DriveCommand, encode_targets};
use codec::layout::FrameLayout;
use config::scene::Scene;
use drives::cia402::{ENABLE_OPERATION, SHUTDOWN};
use messages::{BusFrames, EventCode, JointMode, JointTargets, Power, SimState};
use sim_backend::SimBackend;

use super::{Bench, Result};

/// Robot, and what the bus tells it.
pub(super) struct HeldRobot {
    pub(super) sim: SimBackend,
    layout: FrameLayout,
    command: DriveCommand,
    frames: BusFrames,
    power: Power,
}

impl HeldRobot {
    /// The robot of `scene` in its start pose.
    pub(super) fn new(bench: &Bench, scene: &Scene) -> Result<Self> {
        let robot = &bench.setup.robot;
        let mut targets = JointTargets { mode: JointMode::Hold as u64, ..JointTargets::default() };
        targets.angle[..bench.pose().len()].copy_from_slice(bench.pose());
        Ok(Self {
            sim: SimBackend::new(robot, scene)?,
            layout: robot.layout.clone(),
            command: DriveCommand { targets, ..DriveCommand::default() },
            frames: BusFrames::default(),
            power: Power { on: 1, arming: 1, ..Power::default() },
        })
    }

    /// One bus cycle.
    pub(super) fn step(&mut self) -> (&BusFrames, &SimState) {
        self.command.targets.header.tick += 1;
        self.power.toggle += 1;
        let word = if self.power.toggle == 1 { SHUTDOWN } else { ENABLE_OPERATION };
        self.command.control.fill(word.into());
        encode_targets(&self.layout, &self.command, &mut self.frames);
        self.sim.step(Some(&self.frames), Some(&self.power))
    }

    /// The first event of the next `cycles`.
    pub(super) fn first_event(&mut self, cycles: usize) -> Option<EventCode> {
        for _ in 0..cycles {
            self.step();
            if let Some((event, _)) = self.sim.events().pop() {
                return Some(event);
            }
        }
        None
    }
}
