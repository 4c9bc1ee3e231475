//! The steps of four processes: which recorded input goes where, in the order of their daemons.

use std::error::Error;

use config::{BusAddress, Setup};
use controller::Controller;

use lowlevel::JointLoop;
use messages::topics::{
    CONTROLLER_STATE, FRAMES_IN, FRAMES_OUT, JOINT_TABLES, JOINT_TARGETS, PARAMETERS_CONTROLLER,
    PARAMETERS_PLANNER, PLAN, POWER, SENSORS, WATCHDOG_RESET,
};
use messages::{
    BusFrames, Command, CommandTaken, ControllerState, CycleInputs, EventCode, JointTables, JointTargets,
    Parameters, Plan, Process, Sensors, WatchdogReset,
};
use planner::Planner;
use planner::obstacles::KnownObstacles;
use watchdog::Watchdog;

use super::problem::ReplayProblem;
use super::tape::Tape;

/// One process.
pub(super) trait Part {
    /// Records written before its first cycle.
    fn begin(&mut self, _: &mut Tape) -> Result<(), ReplayProblem> {
        Ok(())
    }

    /// One cycle: fetches what it used, steps, holds what it made against the log.
    fn cycle(
        &mut self,
        tape: &mut Tape,
        inputs: &CycleInputs,
        commands: &[CommandTaken],
    ) -> Result<(), ReplayProblem>;
}

/// The process as it is when it begins.
pub(super) fn of(process: Process, setup: &Setup, bus: &BusAddress) -> Result<Box<dyn Part>, Box<dyn Error>> {
    let Setup { scene, robot, gait, system, .. } = setup;
    // Each part is built as its daemon builds it, from the configuration in the log.
    Ok(match process {
        Process::Planner => {
            let mut planner = Planner::of(gait, robot).map_err(|fault| fault.of_gait(&scene.gait))?;
            planner.see(KnownObstacles::new(setup.known_obstacles()?));
            Box::new(Planning {
                planner,
                parameters: Parameters::default(),
                dt: scene.cycle,
                state: None,
                made: Box::default(),
            })
        }
        Process::Controller => Box::new(Stabilizing {
            controller: Controller::new(robot, gait, scene.cycle)?,
            parameters: Parameters::default(),
            sensors: None,
            plan: None,
        }),
        Process::Lowlevel => Box::new(Driving {
            joints: JointLoop::new(robot, system, scene.cycle),
            real_bus: *bus != BusAddress::Shared,
            targets: None,
            frames: None,
            tables: None,
        }),
        Process::Watchdog => Box::new(Guarding {
            watchdog: Watchdog::new(system.watchdog_missed, system.toggle_missed),
            reset: None,
        }),
        other => {
            return Err(format!(
                "{} cannot be replayed; planner, controller, lowlevel and watchdog can",
                other.name()
            )
            .into());
        }
    })
}

/// The command of a record.
fn command(taken: &CommandTaken) -> Result<Command, ReplayProblem> {
    let unknown =
        || ReplayProblem::Broken(format!("command {}/{} of the log is unknown", taken.domain, taken.id));
    taken.command().ok_or_else(unknown)
}

struct Planning {
    planner: Planner,
    parameters: Parameters,
    dt: f64,
    state: Option<Box<ControllerState>>,
    made: Box<Plan>,
}

impl Part for Planning {
    fn begin(&mut self, tape: &mut Tape) -> Result<(), ReplayProblem> {
        self.planner.report_parameters(&mut self.parameters);
        tape.compare(&PARAMETERS_PLANNER, &self.parameters)
    }

    fn cycle(
        &mut self,
        tape: &mut Tape,
        inputs: &CycleInputs,
        commands: &[CommandTaken],
    ) -> Result<(), ReplayProblem> {
        tape.fetch(&CONTROLLER_STATE, inputs.used[0], &mut self.state)?;
        let commands = commands.iter().map(command).collect::<Result<Vec<_>, _>>()?;
        let output = self.planner.step(inputs.header.tick, self.dt, self.state.as_deref(), &commands);
        if let Some(plan) = output.plan {
            *self.made = *plan;
            self.made.header = inputs.header;
            tape.compare(&PLAN, &*self.made)?;
        }
        output.events.drain().try_for_each(|(code, detail)| tape.event(inputs.header, code, detail))?;
        if commands.iter().any(|command| matches!(command, Command::WalkParameter(_))) {
            self.parameters.header = inputs.header;
            self.planner.report_parameters(&mut self.parameters);
            tape.compare(&PARAMETERS_PLANNER, &self.parameters)?;
        }
        Ok(())
    }
}

struct Stabilizing {
    controller: Controller,
    parameters: Parameters,
    sensors: Option<Box<Sensors>>,
    plan: Option<Box<Plan>>,
}

impl Part for Stabilizing {
    fn begin(&mut self, tape: &mut Tape) -> Result<(), ReplayProblem> {
        self.controller.report_parameters(&mut self.parameters);
        tape.compare(&PARAMETERS_CONTROLLER, &self.parameters)
    }

    fn cycle(
        &mut self,
        tape: &mut Tape,
        inputs: &CycleInputs,
        commands: &[CommandTaken],
    ) -> Result<(), ReplayProblem> {
        let header = inputs.header;
        tape.fetch(&SENSORS, inputs.used[0], &mut self.sensors)?;
        tape.fetch(&PLAN, inputs.used[1], &mut self.plan)?;
        for taken in commands {
            let command = command(taken)?;
            if let Some((code, detail)) = self.controller.command(&command) {
                tape.event(header, code, detail)?;
            }
            if matches!(command, Command::Parameter(_)) {
                self.parameters.header = header;
                self.controller.report_parameters(&mut self.parameters);
                tape.compare(&PARAMETERS_CONTROLLER, &self.parameters)?;
            }
        }
        let measured = self
            .sensors
            .as_deref()
            .ok_or_else(|| ReplayProblem::Broken("a cycle of the controller without sensor data".into()))?;
        let (targets, state) = self.controller.step(measured, self.plan.as_deref());
        tape.compare(&CONTROLLER_STATE, state)?;
        tape.compare(&JOINT_TARGETS, targets)?;
        if let Some(tables) = self.controller.tables() {
            tape.compare(&JOINT_TABLES, tables)?;
        }
        for (code, detail) in self.controller.events().drain() {
            tape.event(header, code, detail)?;
        }
        Ok(())
    }
}

struct Driving {
    joints: JointLoop,
    real_bus: bool,
    targets: Option<Box<JointTargets>>,
    frames: Option<Box<BusFrames>>,
    tables: Option<Box<JointTables>>,
}

impl Part for Driving {
    fn begin(&mut self, tape: &mut Tape) -> Result<(), ReplayProblem> {
        if self.real_bus {
            tape.on_real_bus();
        }
        Ok(())
    }

    fn cycle(
        &mut self,
        tape: &mut Tape,
        inputs: &CycleInputs,
        commands: &[CommandTaken],
    ) -> Result<(), ReplayProblem> {
        let header = inputs.header;
        tape.fetch(&JOINT_TARGETS, inputs.used[0], &mut self.targets)?;
        tape.fetch(&FRAMES_IN, inputs.used[1], &mut self.frames)?;
        tape.fetch(&JOINT_TABLES, inputs.used[2], &mut self.tables)?;
        let sensors = self.joints.receive(header.tick, header.stamp_ns, self.frames.as_deref());
        tape.compare(&SENSORS, sensors)?;
        if let Some(tables) = &self.tables {
            self.joints.take_tables(tables);
        }
        for taken in commands {
            // Answers are not compared: what follows from them is in the records.
            let _ = self.joints.command(&command(taken)?);
        }
        let cause = EventCode::from_number(inputs.cause).filter(|&cause| cause != EventCode::None);
        let (frames, reset) = self.joints.send(self.targets.as_deref(), cause);
        tape.compare(&FRAMES_OUT, frames)?;
        tape.compare(&WATCHDOG_RESET, reset)?;
        for (code, detail) in self.joints.events().drain() {
            tape.event(header, code, detail)?;
        }
        Ok(())
    }
}

struct Guarding {
    watchdog: Watchdog,
    reset: Option<Box<WatchdogReset>>,
}

impl Part for Guarding {
    fn cycle(
        &mut self,
        tape: &mut Tape,
        inputs: &CycleInputs,
        commands: &[CommandTaken],
    ) -> Result<(), ReplayProblem> {
        tape.fetch(&WATCHDOG_RESET, inputs.used[0], &mut self.reset)?;
        let commands = commands.iter().map(command).collect::<Result<Vec<_>, _>>()?;
        let before = self.watchdog.supply();
        let power = self.watchdog.step(&watchdog::Inputs {
            reset: self.reset.as_deref(),
            commands: &commands,
            skipped: inputs.skipped,
            late: inputs.late == 1,
        });
        tape.compare(&POWER, power)?;
        match watchdog::supply_event(before, self.watchdog.supply()) {
            Some((code, detail)) => tape.event(inputs.header, code, detail),
            None => Ok(()),
        }
    }
}
