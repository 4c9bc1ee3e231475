//! The process around the stabilizer: `gangwerk controller --run DIR`.

use crate::{Controller, verdict};
use config::Timeline;
use daemon::{Connect, Daemon};
use ipc::Mode;
use messages::topics::{
    CONTROLLER_STATE, JOINT_TABLES, JOINT_TARGETS, PARAMETERS_CONTROLLER, PLAN, PLANNER_TICK, SENSORS,
};
use messages::{
    Command, ControllerState, Detail, Event, EventCode, Header, JointTables, JointTargets, Live, Parameters,
    Plan, Process, Sensors,
};
use std::error::Error;
use std::path::Path;

/// Stabilizes until asked to end.
///
/// # Errors
/// The process cannot start, or, in lockstep, joint loop or planner fell silent.
pub fn main(dir: &Path, connect: Connect) -> Result<(), Box<dyn Error>> {
    let mut d = Daemon::new(Process::Controller, dir)?;
    let mut sensors = d.space.reader::<Sensors>(&SENSORS)?;
    let mut plan = d.space.reader::<Plan>(&PLAN)?;
    let mut planner_tick = d.space.reader::<Event>(&PLANNER_TICK)?;
    let mut targets = d.space.writer::<JointTargets>(&JOINT_TARGETS)?;
    let mut joint_tables = d.space.writer::<JointTables>(&JOINT_TABLES)?;
    let mut state = d.space.writer::<ControllerState>(&CONTROLLER_STATE)?;
    let bell = d.bell(&JOINT_TARGETS)?;
    let waiter = d.space.waiter(Process::Controller)?;
    let mut controller = Controller::new(&d.setup.robot, &d.setup.gait, d.setup.scene.cycle)?;
    let mut silence = PlannerSilence::default();
    let mut commands = connect(&d.space)?;
    let mut timeline = Timeline::new(&d.setup.scene, Process::Controller);
    if state.epoch() > 1 {
        timeline.drop_rest(); // started again
    }
    let mut set = d.space.writer::<Parameters>(&PARAMETERS_CONTROLLER)?;
    let mut parameters = Parameters::default();
    controller.report_parameters(&mut parameters);
    set.write(&parameters);
    d.report(Header::default(), EventCode::Started, Detail::Nothing);

    let mut header = Header::default();
    while d.wait(&waiter, "lowlevel", || sensors.refresh())? {
        let Some(measured) = sensors.held() else { continue };
        header = measured.header;
        if d.mode == Mode::Lockstep
            && !d.wait(&waiter, "planner", || {
                planner_tick.latest().is_some_and(|e| e.header.tick == header.tick)
            })?
        {
            break;
        }
        d.begin_woken(header);
        // Commands first: they hold from this cycle on.
        while let Some(live) = timeline.due(header.tick).map(Live::of_scene).or_else(|| commands.next()) {
            let event = controller.command(&live.command);
            if let Some((code, detail)) = event {
                d.report(header, code, detail);
            }
            commands.answer(&live, verdict(event));
            d.log.took(header, &live, &verdict(event));
            if !matches!(live.command, Command::Parameter(_)) {
                continue;
            }
            parameters.header = header;
            controller.report_parameters(&mut parameters);
            set.write(&parameters);
        }
        d.log.left_out(header, commands.as_mut());
        let plan = plan.latest();
        // What is read here is what the cycle can be replayed from.
        d.log.uses(0, &SENSORS, Some(measured));
        d.log.uses(1, &PLAN, plan);
        let (targets_of_cycle, state_of_cycle) = controller.step(measured, plan);
        let (new_targets, new_state) = (*targets_of_cycle, *state_of_cycle);
        state.write(&new_state);
        // Tables first: who finds the targets of a cycle finds its tables.
        if let Some(tables) = controller.tables() {
            joint_tables.write(tables);
            d.log.keep(&JOINT_TABLES, tables);
        }
        targets.write(&new_targets);
        d.log.keep(&CONTROLLER_STATE, &new_state);
        d.log.keep(&JOINT_TARGETS, &new_targets);
        for (code, detail) in controller.events().drain() {
            d.report(header, code, detail);
        }
        if silence.begins(header.tick, planner_tick.latest()) {
            d.report(header, EventCode::PlannerSilent, Detail::Nothing);
        }
        // Last: the joint loop has a higher priority, and takes the core.
        d.end(header, 0);
        d.ring(bell);
    }
    d.report(header, EventCode::Ended, Detail::Nothing);
    Ok(())
}

/// Detector of a planner that falls silent. The plan it left is walked to its end.
#[derive(Default)]
struct PlannerSilence(bool);

impl PlannerSilence {
    fn begins(&mut self, tick: u64, newest: Option<&Event>) -> bool {
        let age = newest.map_or(0, |e| tick.saturating_sub(e.header.tick));
        let silent = age > u64::from(PLANNER_TICK.stale_after);
        std::mem::replace(&mut self.0, silent) != silent && silent
    }
}
