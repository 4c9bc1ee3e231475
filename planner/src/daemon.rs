//! The process around the planner: `gangwerk planner --run DIR`.

use crate::Planner;
use crate::gait::MAX_COMMANDS;
use crate::lease::WalkLease;
use crate::obstacles::KnownObstacles;
use config::Timeline;
use daemon::{Connect, Daemon};
use ipc::Mode;
use messages::topics::{CONTROLLER_STATE, PARAMETERS_PLANNER, PLAN, PLANNER_TICK, SENSORS};
use messages::{
    Command, ControllerState, Detail, Event, EventCode, Header, Live, Parameters, Plan, Process, Sensors,
};
use realtime::clock;
use std::error::Error;
use std::path::Path;

/// Commands of one cycle; the rest waits for the next.
struct Inbox {
    live: [Live; MAX_COMMANDS],
    commands: [Command; MAX_COMMANDS],
    count: usize,
}

impl Default for Inbox {
    fn default() -> Self {
        let none = Command::Stop;
        Self { live: [Live::of_scene(none); MAX_COMMANDS], commands: [none; MAX_COMMANDS], count: 0 }
    }
}

impl Inbox {
    fn add(&mut self, live: Live) {
        (self.live[self.count], self.commands[self.count]) = (live, live.command);
        self.count += 1;
    }

    fn is_full(&self) -> bool {
        self.count == MAX_COMMANDS
    }

    fn live(&self) -> &[Live] {
        &self.live[..self.count]
    }

    fn commands(&self) -> &[Command] {
        &self.commands[..self.count]
    }
}

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
    let mut lease = WalkLease::default();
    let mut timeline = Timeline::new(&d.setup.scene, Process::Planner);
    let mut planner =
        Planner::of(&d.setup.gait, &d.setup.robot).map_err(|fault| fault.of_gait(&d.setup.scene.gait))?;
    planner.see(KnownObstacles::new(d.setup.known_obstacles()?));
    let mut made = Box::new(Plan::default());
    if plan.epoch() > 1 {
        timeline.drop_rest(); // started again
    }
    let mut set = d.space.writer::<Parameters>(&PARAMETERS_PLANNER)?;
    let mut parameters = Parameters::default();
    planner.report_parameters(&mut parameters);
    set.write(&parameters);
    d.report(Header::default(), EventCode::Started, Detail::Nothing);

    let mut header = Header::default();
    while d.wait(&waiter, "lowlevel", || sensors.refresh())? {
        header = sensors.held().map_or(header, |s| s.header);
        d.begin_woken(header);
        // A walk whose operator is gone ends first; then the scene's commands, then live ones.
        let mut inbox = Inbox::default();
        if let Some(grant) = lease.lost(commands.lease(), clock::now()) {
            d.report(header, EventCode::LeaseLost, Detail::Number(grant.into()));
            inbox.add(Live::of_scene(Command::Stop));
        }
        while !inbox.is_full()
            && let Some(live) = timeline.due(header.tick).map(Live::of_scene).or_else(|| commands.next())
        {
            // Whoever steers a robot that stays is not overruled by what is left of the scene.
            let looks =
                matches!(live.command, Command::WalkParameter(_) | Command::Box(_) | Command::Gone(_));
            let steers = live.stamp.origin != 0 && !looks;
            if d.stays && steers {
                timeline.drop_rest();
            }
            inbox.add(live);
        }
        d.log.left_out(header, commands.as_mut());
        let state = state.latest();
        d.log.uses(0, &CONTROLLER_STATE, state);
        let output = planner.step(header.tick, d.setup.scene.cycle, state, inbox.commands());
        // Every command is answered, whatever became of it.
        for (live, &verdict) in inbox.live().iter().zip(output.answers) {
            lease.follow(live, verdict);
            commands.answer(live, verdict);
            d.log.took(header, live, &verdict);
        }
        if let Some(new) = output.plan {
            *made = *new;
            made.header = header;
            plan.write(&made);
            d.log.keep(&PLAN, &*made);
        }
        for (code, detail) in output.events.drain() {
            d.report(header, code, detail);
        }
        if inbox.commands().iter().any(|command| matches!(command, Command::WalkParameter(_))) {
            parameters.header = header;
            planner.report_parameters(&mut parameters);
            set.write(&parameters);
        }
        // The controller waits for this in lockstep, and takes it for the planner's heartbeat in real time.
        planner_tick.write(&Event { header, ..Event::default() });
        if d.mode == Mode::Lockstep {
            d.ring(bell);
        }
        d.end(header, 0);
    }
    d.report(header, EventCode::Ended, Detail::Nothing);
    Ok(())
}
