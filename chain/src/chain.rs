//! All steps of the chain in one process: lockstep without processes.
//!
//! The order of a cycle is the order in which data flow, and the same as between processes in lockstep:
//! sensors → planner → controller → joint loop → watchdog → simulated robot → sensors.

use std::collections::VecDeque;
use std::error::Error;

use config::{Setup, Timeline};
use controller::Controller;
use lowlevel::JointLoop;
use messages::{
    BusFrames, Command, ControllerState, Detail, EventCode, JointTargets, Parameters, Plan, Power, Process,
    Reason, Sensors, SimState, Verdict, WatchdogReset,
};
use planner::Planner;
use planner::gait::MAX_COMMANDS;
use planner::obstacles::KnownObstacles;
use sim_backend::SimBackend;
use sim_backend::external_plant::ExternalPlant;
use watchdog::{Inputs, Watchdog};

/// Cycles that a simulated robot which was stopped catches up on: as many as the rings of the bus hold.
const BUS_DEPTH: usize = messages::topics::BUS_TX.depth;

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
    pub events: Vec<(Process, EventCode, Detail)>,
    /// Commands that were refused.
    pub refused: u64,
    /// Commands that were taken, each with the answer of [the process that decides](Command::decided_by).
    pub answers: Vec<(Command, Verdict)>,
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
    /// Cycles so far, of those that the joint loop did not run too.
    elapsed: u64,
    /// Cycles that the watchdog missed since its last one.
    skipped: u64,
    reset: WatchdogReset,
    /// What the simulated robot has not done yet: the frames of a cycle, if there were any.
    bus: VecDeque<Option<BusFrames>>,
    answer: BusFrames,
    /// Whether it is one that the joint loop has not seen.
    answered: bool,
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
        let mut sim = SimBackend::new(robot, scene)?.with_relay(system.toggle_missed);
        let mut planner = Planner::of(gait, robot).map_err(|fault| fault.of_gait(&scene.gait))?;
        planner.see(KnownObstacles::new(setup.known_obstacles()?));
        let answer = *sim.step(None, None).0;
        Ok(Self {
            dt: scene.cycle,
            walk: Timeline::new(scene, Process::Planner),
            system: Timeline::new(scene, Process::Watchdog),
            head: Timeline::new(scene, Process::Controller),
            joint: Timeline::new(scene, Process::Lowlevel),
            simulated: Timeline::new(scene, Process::SimBackend),
            due: Vec::with_capacity(64),
            planner,
            controller: Controller::new(robot, gait, scene.cycle)?,
            joint_loop: JointLoop::new(robot, system, scene.cycle),
            watchdog: Watchdog::new(system.watchdog_missed, system.toggle_missed),
            sim,
            tick: 0,
            elapsed: 0,
            skipped: 0,
            reset: WatchdogReset::default(),
            bus: VecDeque::with_capacity(BUS_DEPTH + 1),
            answer,
            answered: true,
            cycle: Cycle::default(),
            plan: Box::default(),
        })
    }

    /// What planner and stabilizer are set to.
    pub fn parameters(&self) -> [Parameters; 2] {
        let mut parameters = [Parameters::default(); 2];
        self.planner.report_parameters(&mut parameters[0]);
        self.controller.report_parameters(&mut parameters[1]);
        parameters
    }

    /// Begins a push of the simulated robot now.
    pub fn push(&mut self, push: &messages::command::PushCommand) {
        self.sim.push(push);
    }

    /// Begins a push now, `above` \[m\] the torso's own centre of gravity along the torso's z axis.
    pub fn push_above(&mut self, push: &messages::command::PushCommand, above: f64) {
        self.sim.push_above(push, above);
    }

    /// A live command: whoever hears its domain takes it in the next cycle that it runs.
    pub fn command(&mut self, command: &Command) {
        if let Command::Push(push) = command {
            return self.push(push);
        }
        let hearers =
            [&mut self.walk, &mut self.system, &mut self.head, &mut self.joint, &mut self.simulated];
        hearers.into_iter().for_each(|timeline| timeline.insert(command));
    }

    /// Records that the last cycle wrote.
    pub fn last(&self) -> &Cycle {
        &self.cycle
    }

    /// The newest plan; its id is 0 before the first one.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// What the drives were told in the last cycle.
    pub fn told(&self) -> &BusFrames {
        self.joint_loop.commanded()
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
        self.step_without(&[])
    }

    /// One bus cycle in which what the controller says to the joints is altered on its way.
    pub fn step_altered(&mut self, alter: &mut dyn FnMut(&mut JointTargets)) -> &Cycle {
        self.software(&[], alter);
        let told = Some(*self.joint_loop.commanded());
        self.bus.push_back(told);
        self.simulate();
        self.tell();
        &self.cycle
    }

    /// One bus cycle with another robot in place of the simulated one, which stands still.
    ///
    /// # Errors
    /// The other one's.
    pub fn step_with(&mut self, plant: &mut ExternalPlant) -> Result<&Cycle, String> {
        if self.tick == 0 {
            self.answer = *plant.frames();
        }
        self.software(&[], &mut |_| ());
        let c = &mut self.cycle;
        let (answer, state) = plant.step(Some(self.joint_loop.commanded()), Some(&c.power))?;
        (self.answer, self.answered, c.sim_state) = (*answer, true, *state);
        c.events.extend(plant.events().drain().map(|(code, detail)| (Process::SimBackend, code, detail)));
        self.tell();
        Ok(&self.cycle)
    }

    /// One bus cycle of real time in which these processes do not run, as after a SIGSTOP; the others go on with what is
    /// there. A process that runs again finds the newest records, as between processes; the simulated robot catches up on what it
    /// missed. Ticks are counted by the joint loop and stand still without it.
    pub fn step_without(&mut self, stopped: &[Process]) -> &Cycle {
        let runs = |process: Process| !stopped.contains(&process);
        self.software(stopped, &mut |_| ());
        let told = runs(Process::Lowlevel).then(|| *self.joint_loop.commanded());
        self.bus.push_back(told);
        if runs(Process::SimBackend) {
            self.simulate();
        } else if self.bus.len() > BUS_DEPTH {
            self.bus.pop_front(); // overwritten before it came to it
        }
        self.tell();
        &self.cycle
    }

    /// Everything of a cycle but the robot.
    fn software(&mut self, stopped: &[Process], alter: &mut dyn FnMut(&mut JointTargets)) {
        let runs = |process: Process| !stopped.contains(&process);
        self.elapsed += 1;
        self.cycle.events.clear();
        self.cycle.refused = 0;
        self.cycle.answers.clear();
        self.cycle.plan = None;
        if runs(Process::Lowlevel) {
            self.tick += 1;
            self.measure();
            // Both are woken by new sensor data.
            if runs(Process::Planner) {
                self.make_plan();
            }
            if runs(Process::Controller) {
                self.stabilize();
                alter(&mut self.cycle.joint_targets);
            }
            self.drive_joints();
        }
        if runs(Process::Watchdog) {
            self.guard();
        } else {
            self.skipped += 1;
        }
    }

    /// First half of the joint loop's cycle.
    fn measure(&mut self) {
        let stamp = (self.elapsed as f64 * self.dt * 1e9).round() as u64;
        let answer = std::mem::take(&mut self.answered).then_some(&self.answer);
        self.cycle.sensors = *self.joint_loop.receive(self.tick, stamp, answer);
    }

    fn make_plan(&mut self) {
        let c = &mut self.cycle;
        // As many as the process takes in a cycle; the rest is due in the next one.
        self.due.clear();
        self.due.extend(std::iter::from_fn(|| self.walk.due(self.tick)).take(MAX_COMMANDS));
        let seen = (self.tick > 1).then_some(&c.controller_state);
        let output = self.planner.step(self.tick, self.dt, seen, &self.due);
        c.refused += output.answers.iter().filter(|answer| answer.is_err()).count() as u64;
        c.answers.extend(self.due.iter().copied().zip(output.answers.iter().copied()));
        if let Some(plan) = output.plan {
            *self.plan = *plan;
            self.plan.header = c.sensors.header;
            c.plan = Some(self.plan.clone());
        }
        c.events.extend(output.events.drain().map(|(code, detail)| (Process::Planner, code, detail)));
    }

    fn stabilize(&mut self) {
        let c = &mut self.cycle;
        take_due(&mut self.head, self.tick, &mut self.due);
        for command in &self.due {
            let said = self.controller.command(command);
            let verdict = controller::verdict(said);
            c.refused += u64::from(verdict.is_err());
            c.answers.push((*command, verdict));
            c.events.extend(said.map(|(code, detail)| (Process::Controller, code, detail)));
        }
        let (targets, state) = self.controller.step(&c.sensors, (self.plan.id > 0).then_some(&*self.plan));
        (c.joint_targets, c.controller_state) = (*targets, *state);
        if let Some(tables) = self.controller.tables() {
            self.joint_loop.take_tables(tables);
        }
        let events = self.controller.events().drain();
        c.events.extend(events.map(|(code, detail)| (Process::Controller, code, detail)));
    }

    /// Second half of the joint loop's cycle.
    fn drive_joints(&mut self) {
        take_due(&mut self.joint, self.tick, &mut self.due);
        for command in &self.due {
            // A refusal is told as an event.
            let verdict = self.joint_loop.command(command);
            if command.decided_by() == Process::Lowlevel.name() {
                self.cycle.refused += u64::from(verdict.is_err());
                self.cycle.answers.push((*command, verdict));
            }
        }
        self.reset = *self.joint_loop.send(Some(&self.cycle.joint_targets), None).1;
    }

    fn guard(&mut self) {
        take_due(&mut self.system, self.tick, &mut self.due);
        let before = self.watchdog.supply();
        let inputs = Inputs {
            reset: Some(&self.reset),
            commands: &self.due,
            skipped: self.skipped,
            late: self.skipped > 0,
        };
        self.cycle.power = *self.watchdog.step(&inputs);
        self.skipped = 0;
        let after = self.watchdog.supply();
        for command in &self.due {
            let verdict = watchdog::verdict(command, before, after);
            self.cycle.refused += u64::from(verdict.is_err());
            self.cycle.answers.push((*command, verdict));
        }
        let event = watchdog::supply_event(before, after);
        self.cycle.events.extend(event.map(|(code, detail)| (Process::Watchdog, code, detail)));
    }

    /// The simulated robot, by one cycle; after a stall by all those that it missed.
    fn simulate(&mut self) {
        let c = &mut self.cycle;
        take_due(&mut self.simulated, self.tick, &mut self.due);
        for command in &self.due {
            let Command::Lower(way) = command else { continue };
            let message = Detail::Message(command.address().1.into());
            if self.sim.lower(way) {
                c.answers.push((*command, Ok(())));
            } else {
                c.events.push((Process::SimBackend, EventCode::CommandRefused, message));
                c.answers.push((
                    *command,
                    Err(Reason::Event { code: EventCode::CommandRefused, detail: message }),
                ));
                c.refused += 1;
            }
        }
        self.answered = true;
        while self.bus.len() > 1 {
            self.sim.step_late(self.bus.pop_front().flatten().as_ref());
        }
        let frames = self.bus.pop_front().flatten();
        let (answer, sim_state) = self.sim.step(frames.as_ref(), Some(&c.power));
        (self.answer, c.sim_state) = (*answer, *sim_state);
    }

    /// What joint loop and simulated robot have to report.
    fn tell(&mut self) {
        let c = &mut self.cycle;
        let events = self.joint_loop.events().drain();
        c.events.extend(events.map(|(code, detail)| (Process::Lowlevel, code, detail)));
        let events = self.sim.events().drain();
        c.events.extend(events.map(|(code, detail)| (Process::SimBackend, code, detail)));
    }
}

fn take_due(timeline: &mut Timeline, tick: u64, due: &mut Vec<Command>) {
    due.clear();
    due.extend(std::iter::from_fn(|| timeline.due(tick)));
}
