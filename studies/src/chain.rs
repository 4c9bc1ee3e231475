//! All steps of the chain in one process: lockstep without processes.
//!
//! The order of a cycle is the order in which data flow, and the same as between processes in lockstep:
//! sensors → planner → controller → joint loop → watchdog → simulated robot → sensors.

use std::error::Error;

use config::{Setup, Timeline};
use controller::Controller;
use lowlevel::JointLoop;
use messages::command::Domain;
use messages::{
    BusFrames, Command, ControllerState, EventCode, JointTargets, Parameters, Plan, Power, Process, Sensors,
    SimState,
};
use planner::Planner;
use sim_backend::SimBackend;
use watchdog::{Inputs, Watchdog};

/// Everything one cycle wrote, by topic.
#[derive(Clone, Debug, Default)]
pub struct Cycle {
    /// `sensors`
    pub sensors: Sensors,
    /// `plan`, in the cycle in which it was made.
    pub plan: Option<Box<Plan>>,
    /// `joint_targets`
    pub joint_targets: JointTargets,
    /// `controller_state`
    pub controller_state: ControllerState,
    /// `power`
    pub power: Power,
    /// `sim_state`
    pub sim_state: SimState,
    /// `events/PROCESS`
    pub events: Vec<(Process, EventCode, u64)>,
}

/// The processes of a scene, each a library's step.
#[derive(Clone)]
pub struct Chain {
    dt: f64,
    walk: Timeline,
    system: Timeline,
    head: Timeline,
    joint: Timeline,
    simulated: Timeline,
    due: Vec<Command>,
    planner: Planner,
    controller: Controller,
    joint_loop: JointLoop,
    watchdog: Watchdog,
    sim: SimBackend,
    tick: u64,
    answer: BusFrames,
    cycle: Cycle,
    plan: Box<Plan>,
}

impl Chain {
    /// Builds every part of a scene.
    ///
    /// # Errors
    /// The configuration does not fit together, or leaves the depth open.
    pub fn new(setup: &Setup) -> Result<Self, Box<dyn Error>> {
        let Setup { scene, robot, gait, system, .. } = &setup.clone().with_method(None)?;
        let mut sim = SimBackend::new(robot, scene)?;
        let mut planner = Planner::of(gait, robot);
        planner.see(planner::vision::known(setup)?);
        let answer = *sim.step(None, None).0;
        Ok(Self {
            dt: scene.cycle,
            walk: Timeline::new(scene, &[Domain::Walk]),
            system: Timeline::new(scene, &[Domain::System]),
            head: Timeline::new(scene, &[Domain::Head]),
            joint: Timeline::new(scene, &[Domain::System, Domain::Joint]),
            simulated: Timeline::new(scene, &[Domain::Sim]),
            due: Vec::with_capacity(64),
            planner,
            controller: Controller::new(robot, gait, scene.cycle)?,
            joint_loop: JointLoop::new(robot, system, scene.cycle),
            watchdog: Watchdog::new(system.watchdog_missed),
            sim,
            tick: 0,
            answer,
            cycle: Cycle::default(),
            plan: Box::default(),
        })
    }

    /// What the stabilizer is set to.
    pub fn parameters(&self) -> Parameters {
        let mut parameters = Parameters::default();
        self.controller.report_parameters(&mut parameters);
        parameters
    }

    /// Begins a push of the simulated robot now.
    pub fn push(&mut self, push: &messages::command::PushCommand) {
        self.sim.push(push);
    }

    /// What the drives were told in the last cycle.
    pub fn told(&self) -> &BusFrames {
        self.joint_loop.told()
    }

    /// What they answered; before the first cycle: where the joints are.
    pub fn answer(&self) -> &BusFrames {
        &self.answer
    }

    /// The simulated robot.
    pub fn robot(&self) -> &SimBackend {
        &self.sim
    }

    /// Simulated robot and stabilizer, for studies that disturb them between two cycles.
    pub fn parts(&mut self) -> (&mut SimBackend, &mut Controller) {
        (&mut self.sim, &mut self.controller)
    }

    /// \[s\] Bus cycle.
    pub fn cycle(&self) -> f64 {
        self.dt
    }

    /// \[1\] Bus cycles so far.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// One bus cycle.
    pub fn step(&mut self) -> &Cycle {
        self.tick += 1;
        let (tick, stamp) = (self.tick, (self.tick as f64 * self.dt * 1e9).round() as u64);
        let c = &mut self.cycle;
        c.events.clear();

        c.sensors = *self.joint_loop.receive(tick, stamp, Some(&self.answer));
        c.plan = None;
        let seen = (tick > 1).then_some(&c.controller_state);
        take_due(&mut self.walk, tick, &mut self.due);
        let output = self.planner.step(tick, self.dt, seen, &self.due);
        if let Some(plan) = output.plan {
            *self.plan = *plan;
            self.plan.header = c.sensors.header;
            c.plan = Some(self.plan.clone());
        }
        c.events.extend(output.events.iter().map(|&(code, detail)| (Process::Planner, code, detail)));

        take_due(&mut self.head, tick, &mut self.due);
        let said = self.due.iter().filter_map(|command| self.controller.command(command));
        c.events.extend(said.map(|(code, detail)| (Process::Controller, code, detail)));
        let (targets, state) = self.controller.step(&c.sensors, (self.plan.id > 0).then_some(&*self.plan));
        (c.joint_targets, c.controller_state) = (*targets, *state);
        let told = std::iter::from_fn(|| self.controller.take_event());
        c.events.extend(told.map(|(code, detail)| (Process::Controller, code, detail)));

        take_due(&mut self.joint, tick, &mut self.due);
        self.due.iter().for_each(|command| self.joint_loop.command(command));
        let (frames, reset) = self.joint_loop.send(Some(&c.joint_targets), None);
        take_due(&mut self.system, tick, &mut self.due);
        let before = self.watchdog.supply();
        c.power = *self.watchdog.step(&Inputs { reset: Some(reset), commands: &self.due });
        let event = watchdog::supply_event(before, self.watchdog.supply());
        c.events.extend(event.map(|(code, detail)| (Process::Watchdog, code, detail)));
        take_due(&mut self.simulated, tick, &mut self.due);
        for command in &self.due {
            if let Command::Lower(way) = command
                && !self.sim.lower(way)
            {
                let refused = (EventCode::CommandRefused, u64::from(command.address().1));
                c.events.push((Process::SimBackend, refused.0, refused.1));
            }
        }
        let (answer, sim_state) = self.sim.step(Some(frames), Some(&c.power));
        (self.answer, c.sim_state) = (*answer, *sim_state);
        let told = std::iter::from_fn(|| self.joint_loop.take_event());
        c.events.extend(told.map(|(code, detail)| (Process::Lowlevel, code, detail)));
        c.events.extend(self.sim.take_event().map(|(code, detail)| (Process::SimBackend, code, detail)));
        c
    }
}

fn take_due(timeline: &mut Timeline, tick: u64, due: &mut Vec<Command>) {
    due.clear();
    due.extend(std::iter::from_fn(|| timeline.due(tick)));
}
