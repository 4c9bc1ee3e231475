//! Bodies of the simulated robot in motion: equations of motion, their state, and the method that takes it on.

use std::error::Error;

use config::{Robot, Scene};
use messages::{Detail, EventCode, EventQueue};

use crate::chatter::ChatterWatch;
use crate::drive::JointCubic;
use crate::integrate::Stepper;
use crate::layout::orientation;
use crate::plant::{Plant, PlantInputs, Snapshot, Substep};
use crate::terrain;

/// Plant with its state and the method of its time steps.
#[derive(Clone)]
pub(crate) struct SimulatedBody {
    plant: Plant,
    stepper: Stepper,
    chatter: ChatterWatch,
    /// State that began to chatter in this cycle.
    chatters: Option<usize>,
    state: Vec<f64>,
    /// State at the beginning of the cycle.
    last_good: Vec<f64>,
    /// State at the beginning of the step.
    before: Vec<f64>,
    /// Length of a cycle \[s\], and steps in it.
    cycle: f64,
    substeps: u32,
}

impl SimulatedBody {
    /// The robot of a scene in its start pose: standing, or hanging on a crane.
    ///
    /// # Errors
    /// The robot's data do not fit together or do not allow the depth of the scene, or an object cannot be read.
    pub(crate) fn new(robot: &Robot, scene: &Scene) -> Result<Self, Box<dyn Error>> {
        let pose = &robot.poses[&scene.start_pose];
        let real = with_plant_mismatch(robot, scene);
        let mut plant = Plant::new(&real, terrain::environment(scene)?, scene.components(), pose)?;
        plant.weigh(&scene.plant_mismatch)?;
        plant.set_friction_ramp(scene.friction_ramp);
        let state = match &scene.crane {
            None => plant.standing(pose),
            Some(crane) => plant.hanging(pose, crane.height),
        };
        Ok(Self {
            stepper: stepper(scene, state.len()),
            chatter: ChatterWatch::new(&state[plant.layout().speed()]),
            chatters: None,
            last_good: state.clone(),
            before: state.clone(),
            state,
            plant,
            cycle: scene.cycle,
            substeps: scene.substeps,
        })
    }

    /// The equations of motion.
    pub(crate) fn plant(&self) -> &Plant {
        &self.plant
    }

    /// State of the equations of motion, as [`crate::layout`] has it.
    pub(crate) fn state(&self) -> &[f64] {
        &self.state
    }

    /// The same, to be disturbed.
    pub(crate) fn state_mut(&mut self) -> &mut [f64] {
        &mut self.state
    }

    /// \[N\] Weight of the robot.
    pub(crate) fn weight(&self) -> f64 {
        self.plant.model().mass() * -multibody::GRAVITY.z
    }

    /// \[m\] Height of the torso.
    pub(crate) fn height(&self) -> f64 {
        self.state[2]
    }

    /// One cycle of time passes. Returns the first state that is not finite, if there is one: then the state is that of
    /// the beginning of the cycle. `observe` sees each step but the last, whose end is that of the cycle.
    pub(crate) fn advance(
        &mut self,
        references: &[JointCubic],
        inputs: &PlantInputs,
        mut observe: Option<impl FnMut(&mut Plant, &[f64])>,
    ) -> Option<usize> {
        let Self { plant, stepper, chatter, state, last_good, before, .. } = self;
        let speed = plant.layout().speed();
        last_good.copy_from_slice(state);
        plant.sample(self.cycle, state, references, inputs);
        let h = self.cycle / f64::from(self.substeps);
        for i in 1..=self.substeps {
            before.copy_from_slice(state);
            plant.tick(Substep { index: i - 1, h }, state, references, inputs);
            stepper.step(plant, f64::from(i - 1) * h, h, state, references, inputs);
            // Whoever holds a robot in its start pose is stiffer than any explicit step bears, and lets go.
            if inputs.switches.held == 0 {
                self.chatters =
                    chatter.look(&state[speed.clone()]).map(|i| speed.start + i).or(self.chatters);
            } else {
                chatter.restart(&state[speed.clone()]);
            }
            if let (Some(observe), true) = (&mut observe, i < self.substeps) {
                plant.note_step(h, before, state);
                plant.look(f64::from(i) * h, state, references);
                observe(plant, state);
            }
        }
        let lost = state.iter().position(|x| !x.is_finite());
        if lost.is_some() {
            state.copy_from_slice(last_good);
            before.copy_from_slice(last_good);
        }
        plant.note_step(h, before, state);
        lost
    }

    /// The ground takes all motion.
    pub(crate) fn come_to_rest(&mut self) {
        let layout = self.plant.layout();
        for moving in [layout.speed(), layout.rotor_speed(), layout.current()] {
            self.state[moving].fill(0.0);
        }
        self.plant.note_rest();
    }

    /// Makes the quaternion of the torso a unit one again.
    pub(crate) fn normalize(&mut self) {
        let unit = orientation(&self.state);
        self.state[3..7].copy_from_slice(unit.coords.as_slice());
    }

    /// Moves the objects to `time` \[s\], and reports what went wrong or changed in this cycle, the gravest first.
    pub(crate) fn finish(&mut self, time: f64, events: &mut EventQueue) {
        if let Some(state) = self.chatters.take() {
            events.push(EventCode::StepTooLong, Detail::Number(state as u64));
        }
        if let Some(gave_up) = self.stepper.take_gave_up() {
            events.push(EventCode::IntegratorGaveUp, Detail::Number(gave_up.state as u64));
        }
        if let Some(fault) = self.plant.take_fault() {
            events.push(EventCode::DriveFault, Detail::Number(fault.drive as u64));
        }
        let contact = self.plant.take_contact_report();
        if !contact.converged {
            events.push(EventCode::ContactNotConverged, Detail::Count(contact.sweeps.into()));
        }
        // An object that would run into the robot waits; those that come and go by the scene's schedule are no news.
        for event in self.plant.advance(time) {
            match *event {
                environment::ObjectEvent::Refused(i) => {
                    events.push(EventCode::ObjectHeld, Detail::Number(i as u64));
                }
                environment::ObjectEvent::Resumed(i) => {
                    events.push(EventCode::ObjectResumed, Detail::Number(i as u64));
                }
                environment::ObjectEvent::Appeared(_) | environment::ObjectEvent::Vanished(_) => {}
            }
        }
    }

    /// Places and forces at the end of a cycle of `dt` \[s\].
    pub(crate) fn snapshot(&mut self, dt: f64, references: &[JointCubic]) -> Snapshot {
        self.plant.snapshot(dt, &self.state, references)
    }

    /// Plant and state, for sensors that ask for more than a snapshot.
    pub(crate) fn parts(&mut self) -> (&mut Plant, &[f64]) {
        (&mut self.plant, &self.state)
    }
}

/// The soles as they are, where that is not what the robot's software believes.
pub(crate) fn with_plant_mismatch(robot: &Robot, scene: &Scene) -> Robot {
    let (mut robot, factor) = (robot.clone(), scene.plant_mismatch.contact_stiffness);
    robot.contact.normal_stiffness *= factor;
    robot.contact.tangential_stiffness *= factor;
    if let Some(pads) = &mut robot.contact.pads {
        pads.modulus *= factor;
    }
    robot
}

fn stepper(scene: &Scene, states: usize) -> Stepper {
    let stepper = Stepper::new(scene.integrator, states);
    match scene.tolerance {
        Some(tolerance) => stepper.with_tolerance(tolerance),
        None => stepper,
    }
}
