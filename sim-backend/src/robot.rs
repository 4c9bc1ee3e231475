//! One bus cycle of the simulated robot. Pure: frames in, frames out.
//!
//! ```text
//! frames ──► injector ──► joints: commands, drive electronics, references ──► body: equations of motion ──► fall?
//!               ▲                                                              ▲ loads: pushes, crane        │
//! frames ◄──────┴──────── instruments: sensors, truth ◄────────────────────────┴─────────────────────────────┘
//! ```

use std::error::Error;

use config::bus_fault::{BusFault, FrameDirection};
use config::{Robot, Scene};
use fieldbus::Injector;
use messages::command::{LowerCommand, PushCommand};
use messages::{BusFrames, Detail, EventCode, EventQueue, Power, SimState};
use nalgebra::Vector3;

use crate::body::SimulatedBody;
use crate::fall::FallWatch;
use crate::inputs::DriveSwitches;
use crate::instruments::Instruments;
use crate::joints::SimulatedJoints;
use crate::loads::Loads;
use crate::plant::{Plant, PlantInputs};
use crate::power::PowerLine;
use crate::{sample_grid, step_limit, stiff};

/// Cycles without their frames that are caught up on at most: by then every drive has come to rest by itself.
const MOST_OVERWRITTEN: u64 = 100;

/// \[1\] Force on a foot in weights of the robot, from which on its numbers are no robot's.
const IMPLAUSIBLE: f64 = 100.0;

/// A robot in simulation.
#[derive(Clone)]
pub struct SimBackend {
    robot: Robot,
    scene: Scene,
    power: PowerLine,
    /// Faults of the bus, if the scene has any.
    injector: Option<Injector>,
    joints: SimulatedJoints,
    loads: Loads,
    body: SimulatedBody,
    fall: FallWatch,
    instruments: Instruments,
    cycles: u64,
    events: EventQueue,
}

impl SimBackend {
    /// The robot of a scene in its start pose. The relay of its motor supply falls in the first cycle without a moved toggle.
    ///
    /// # Errors
    /// The robot's data do not fit together or do not allow the depth of the scene, or an object cannot be read.
    pub fn new(robot: &Robot, scene: &Scene) -> Result<Self, Box<dyn Error>> {
        if scene.auto.is_some() {
            return Err(
                format!("scene `{}`: no model has been chosen for depth = \"auto\" yet", scene.name).into()
            );
        }
        sample_grid::check(robot, scene)?;
        step_limit::check(robot, scene)?;
        stiff::check(scene)?;
        // The body first: the crane hooks in where its centre of gravity is, and the sensors know what hangs on them.
        let mut body = SimulatedBody::new(robot, scene)?;
        let joints = SimulatedJoints::new(robot, scene);
        let (plant, state) = body.parts();
        let loads = Loads::new(scene, plant, state, joints.references());
        let instruments = Instruments::new(robot, scene, plant)?;
        let mut sim = Self {
            power: PowerLine::falling_after(1),
            injector: Injector::new(&scene.bus_faults, &robot.layout, scene.cycle, scene.seed)?,
            fall: FallWatch::new(body.height()),
            robot: robot.clone(),
            scene: scene.clone(),
            joints,
            loads,
            body,
            instruments,
            cycles: 0,
            events: EventQueue::default(),
        };
        // The first cycle looks at readings of the robot at rest.
        sim.measure(0.0, &PlantInputs::default(), false);
        Ok(sim)
    }

    /// Events that were not taken yet.
    pub fn events(&mut self) -> &mut EventQueue {
        &mut self.events
    }

    /// Brings about these faults of the bus from now on, instead of the scene's; times count from the start.
    ///
    /// # Errors
    /// A fault names a local controller that the robot does not have.
    pub fn inject(&mut self, faults: &[BusFault]) -> Result<(), String> {
        let Self { robot, scene, injector, .. } = self;
        *injector = Injector::new(faults, &robot.layout, scene.cycle, scene.seed)?;
        Ok(())
    }

    /// Begins a push now.
    pub fn push(&mut self, push: &PushCommand) {
        self.push_above(push, 0.0);
    }

    /// Begins a push now, `above` \[m\] the torso's own centre of gravity along the torso's z axis.
    pub fn push_above(&mut self, push: &PushCommand, above: f64) {
        self.loads.push(push, self.time(), above);
    }

    /// Lowers the crane from now on; whether there is one.
    pub fn lower(&mut self, way: &LowerCommand) -> bool {
        self.loads.lower(way)
    }

    /// The truth about the robot, after the last step.
    pub fn state(&self) -> &SimState {
        self.instruments.state()
    }

    /// State of the equations of motion, as [`crate::layout`] has it.
    pub fn integrated(&self) -> &[f64] {
        self.body.state()
    }

    /// The same, for studies that disturb it between two cycles.
    pub fn integrated_mut(&mut self) -> &mut [f64] {
        self.body.state_mut()
    }

    /// \[N m\] Torques of the joints' drives by inverse dynamics, as [`Plant::joint_torques`] has them.
    pub fn joint_torques(&mut self, torque: &mut [f64]) {
        self.body.parts().0.joint_torques(torque);
    }

    /// Places of its numbers.
    pub fn layout(&self) -> &crate::layout::StateLayout {
        self.body.plant().layout()
    }

    /// Simulated time \[s\].
    pub fn time(&self) -> f64 {
        self.cycles as f64 * self.scene.cycle
    }

    /// The same with a relay that falls after so many cycles without a moved toggle.
    pub fn with_relay(self, quiet: u32) -> Self {
        Self { power: PowerLine::falling_after(quiet), ..self }
    }

    /// One bus cycle: follows the newest targets, lets time pass, answers with what the sensors see.
    ///
    /// A robot that falls goes on falling until its torso meets the ground, and stays there at rest: only soles have a
    /// contact in this model.
    pub fn step(&mut self, frames: Option<&BusFrames>, power: Option<&Power>) -> (&BusFrames, &SimState) {
        let powered = self.power.step(power);
        // Off and without a reason: the watchdog has seen a reset edge.
        let reset = matches!(power, Some(Power { on: 0, reason: 0, .. }));
        self.step_powered(frames, powered, reset)
    }

    /// A bus cycle of the past, which was missed: the relay, a device of its own, is as it is. Where frames were overwritten
    /// before they came here, time passes without them.
    pub fn step_late(&mut self, frames: Option<&BusFrames>) -> (&BusFrames, &SimState) {
        let before = self.instruments.readings().header.tick;
        let gap = frames.map_or(0, |f| f.header.tick.saturating_sub(before + 1));
        for _ in 0..gap.min(MOST_OVERWRITTEN) {
            self.step_powered(None, self.power.is_closed(), false);
        }
        self.step_powered(frames, self.power.is_closed(), false)
    }

    fn step_powered(
        &mut self,
        frames: Option<&BusFrames>,
        powered: bool,
        reset: bool,
    ) -> (&BusFrames, &SimState) {
        if self.injector.is_some() {
            return self.step_with_faults(frames, powered, reset);
        }
        self.advance(frames, powered);
        (self.instruments.frames(), self.instruments.state())
    }

    /// The same with a bus that has faults: each way once per tick.
    fn step_with_faults(
        &mut self,
        frames: Option<&BusFrames>,
        powered: bool,
        reset: bool,
    ) -> (&BusFrames, &SimState) {
        let Some(mut injector) = self.injector.take() else {
            return (self.instruments.frames(), self.instruments.state());
        };
        let new = frames.filter(|f| f.header.tick > self.instruments.readings().header.tick);
        if let Some(frames) = new.filter(|_| reset) {
            injector.reset(frames.header.tick);
        }
        let passed = new.map(|frames| injector.pass(FrameDirection::ToDrives, frames));
        self.advance(passed, powered);
        let answer = self.instruments.frames_mut();
        *answer = *injector.pass(FrameDirection::FromDrives, answer);
        self.injector = Some(injector);
        (self.instruments.frames(), self.instruments.state())
    }

    /// The stages of one cycle, in the order of the drawing above.
    fn advance(&mut self, frames: Option<&BusFrames>, powered: bool) {
        let dt = self.scene.cycle;
        let (had_fallen, events_before) = (self.fall.has_fallen(), self.events.len());
        let forces = self.loads.step(self.time(), dt, self.body.state());
        let mut inputs = PlantInputs { forces, switches: DriveSwitches::default() };
        if !self.fall.lies() {
            inputs.switches = self.begin_cycle(frames, powered);
            let Self { body, joints, instruments, .. } = self;
            let observe = instruments
                .is_analogue()
                .then_some(|plant: &mut Plant, x: &[f64]| instruments.observe(plant, x, joints));
            let lost = body.advance(joints.references(), &inputs, observe);
            self.end_cycle(lost);
        }
        self.cycles += 1;
        if let Some(frames) = frames {
            self.instruments.stamp(frames.header);
        }
        if self.measure(dt, &inputs, powered) {
            self.instruments.encode(&self.robot, &mut self.joints);
        }
        if had_fallen {
            // Sensors out of range and contacts that are not found say nothing new of a robot on its way down.
            self.events.retain_from(events_before, |code| {
                matches!(code, EventCode::Diverged | EventCode::ForceImplausible)
            });
        }
    }

    /// Commands to references; which drives have torque.
    fn begin_cycle(&mut self, frames: Option<&BusFrames>, powered: bool) -> DriveSwitches {
        let model = self.body.plant().components().joints;
        let (switches, stopped) = self.joints.begin_cycle(
            &self.robot,
            model,
            frames,
            powered,
            self.instruments.readings(),
            self.scene.cycle,
        );
        if let Some(node) = stopped {
            self.events.push(EventCode::NodeStopped, Detail::Node(node));
        }
        switches
    }

    /// Checks and tidies the state the steps have left; `lost`: the first that was not finite.
    fn end_cycle(&mut self, lost: Option<usize>) {
        if let Some(lost) = lost {
            self.events.push(EventCode::Diverged, Detail::Number(lost as u64));
            self.come_to_rest();
        }
        self.body.normalize();
        self.joints.end_cycle(self.scene.cycle);
        let time = (self.cycles + 1) as f64 * self.scene.cycle;
        self.body.finish(time, &mut self.events);
    }

    /// The ground takes all motion.
    fn come_to_rest(&mut self) {
        self.fall.end();
        self.body.come_to_rest();
        self.joints.come_to_rest();
    }

    /// Readings and truth, `dt` \[s\] after the beginning of the references; false if a reading is NaN and must not go on the
    /// bus.
    ///
    /// Forces first, for they are those of the motion; a robot that comes to rest on the ground does so after that.
    fn measure(&mut self, dt: f64, inputs: &PlantInputs, powered: bool) -> bool {
        let snapshot = self.body.snapshot(dt, self.joints.references());
        let Self { joints, body, .. } = self;
        joints.look(|j| body.plant().joint(j));
        // Before the fall: a robot that its own numbers throw has not fallen.
        let load = snapshot.foot_wrench.iter().map(|w| Vector3::from(w.force).norm()).fold(0.0, f64::max);
        if load > IMPLAUSIBLE * self.body.weight() && !self.fall.lies() {
            self.events.push(EventCode::ForceImplausible, Detail::Newtons(load as u64));
            self.come_to_rest();
        }
        if self.fall.begins(self.body.state(), dt) {
            self.events.push(EventCode::Fallen, Detail::Nothing);
        }
        if self.fall.lands(self.body.state()) {
            self.come_to_rest();
        }
        let time = self.time();
        let Self { instruments, body, joints, events, .. } = self;
        let valid = instruments.measure(time, body, joints, &snapshot, inputs, events);
        self.instruments.note(powered, self.fall.has_fallen());
        valid
    }
}
