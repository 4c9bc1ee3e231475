//! The process around the planner: `gangwerk planner --run DIR`.

use crate::{Planner, vision};
use config::Timeline;
use daemon::{Connect, Daemon};
use ipc::Mode;
use messages::command::Domain;
use messages::topics::{CONTROLLER_STATE, PLAN, PLANNER_TICK, SENSORS};
use messages::{Command, ControllerState, Event, EventCode, Header, Plan, Process, Sensors};
use std::error::Error;
use std::path::Path;

/// Commands looked at per cycle; the rest waits for the next.
const MAX_COMMANDS: usize = 16;

/// Plans until asked to end.
///
/// # Errors
/// The process cannot start, or, in lockstep, the joint loop fell silent.
pub fn main(dir: &Path, connect: Connect) -> Result<(), Box<dyn Error>> {
    let mut d = Daemon::new(Process::Planner, dir)?;
    let mut sensors = d.space.reader::<Sensors>(&SENSORS)?;
    let mut state = d.space.reader::<ControllerState>(&CONTROLLER_STATE)?;
    let mut plan = d.space.writer::<Plan>(&PLAN)?;
    let mut planner_tick = d.space.writer::<Event>(&PLANNER_TICK)?;
    let bell = d.bell(&PLANNER_TICK)?;
    let waiter = d.space.waiter(Process::Planner)?;
    let mut commands = connect(&d.space)?;
    let mut timeline = Timeline::new(&d.setup.scene, &[Domain::Walk]);
    let mut planner = Planner::of(&d.setup.gait, &d.setup.robot);
    planner.see(vision::known(&d.setup)?);
    let mut made = Box::new(Plan::default());
    if plan.epoch() > 1 {
        timeline.skip_before(u64::MAX); // started again: nothing of the scene is done late
    }
    d.report(Header::default(), EventCode::Started, 0);

    let mut header = Header::default();
    while d.wait(&waiter, "lowlevel", || sensors.refresh())? {
        header = sensors.held().map_or(header, |s| s.header);
        d.begin_woken(header);
        let mut waiting = [Command::Stop; MAX_COMMANDS];
        let mut count = 0;
        while count < MAX_COMMANDS
            && let Some(command) = timeline.due(header.tick).or_else(&mut commands)
        {
            waiting[count] = command;
            count += 1;
        }
        let output = planner.step(header.tick, d.setup.scene.cycle, state.latest(), &waiting[..count]);
        if let Some(new) = output.plan {
            *made = *new;
            made.header = header;
            plan.write(&made);
        }
        for &(code, detail) in output.events {
            d.report(header, code, detail);
        }
        planner_tick.write(&Event { header, ..Event::default() });
        if d.mode == Mode::Lockstep {
            d.ring(bell);
        }
        d.end(header, 0);
    }
    d.report(header, EventCode::Ended, 0);
    Ok(())
}
