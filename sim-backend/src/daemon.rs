//! The process around the simulated robot: `gangwerk sim-backend --run DIR`.
//!
//! It moves on with every cycle of the bus. In real time it also moves on without: the world does not wait for a dead
//! joint loop.

use crate::far_end::FarEnd;
use crate::{SimBackend, bus};
use config::Timeline;
use daemon::{Commands, Connect, Daemon};
use ipc::{Mode, Reader, Writer};
use messages::topics::{POWER, SIM_STATE};
use messages::{Command, Detail, EventCode, Header, Live, Power, Process, Reason, SimState};
use realtime::clock;
use std::error::Error;
use std::path::Path;
use std::time::Duration;

/// Periods without a cycle of the bus after which the world moves on by itself.
const PATIENCE: u64 = 2;

/// Simulates until asked to end.
///
/// # Errors
/// The process cannot start, or, in lockstep, the joint loop fell silent.
pub fn main(dir: &Path, connect: Connect) -> Result<(), Box<dyn Error>> {
    let mut d = Daemon::new(Process::SimBackend, dir)?;
    let mut ports = SimBackendPorts {
        bus: bus::open(&mut d)?,
        power: d.space.reader(&POWER)?,
        state: d.space.writer(&SIM_STATE)?,
        commands: connect(&d.space)?,
        timeline: Timeline::new(&d.setup.scene, Process::SimBackend),
    };
    if ports.state.epoch() > 1 {
        ports.timeline.drop_rest(); // started again
    }
    let mut sim = SimBackend::new(&d.setup.robot, &d.setup.scene)?.with_relay(d.setup.system.toggle_missed);
    d.report(Header::default(), EventCode::Started, Detail::Nothing);
    let (frames, _) = sim.step(None, None);
    ports.bus.answer(&d, frames);

    let mut header = Header::default();
    match d.mode {
        Mode::Lockstep => {
            while ports.bus.next(&d)? {
                d.begin(clock::now());
                header = cycle(&mut d, &mut sim, &mut ports);
            }
        }
        Mode::RealTime => {
            let period = d.period_ns();
            let mut running = false;
            let mut due = clock::now();
            while !d.stop.asked() {
                let patience = if running { PATIENCE * period } else { 20 * period };
                let new = ports.bus.refresh() || {
                    ports
                        .bus
                        .wait(Duration::from_nanos((due + patience).saturating_sub(clock::now()).max(1)));
                    ports.bus.refresh()
                };
                running |= new;
                let now = clock::now();
                if new || (running && now >= due + patience) {
                    due = if new { now } else { due + period };
                    if let Some(frames) = ports.bus.held().filter(|_| new) {
                        d.begin_woken(frames.header);
                    } else {
                        d.begin(due);
                    }
                    header = cycle(&mut d, &mut sim, &mut ports);
                } else if !running {
                    due = now;
                }
            }
        }
    }
    d.report(header, EventCode::Ended, Detail::Nothing);
    Ok(())
}

struct SimBackendPorts {
    bus: Box<dyn FarEnd>,
    power: Reader<Power>,
    state: Writer<SimState>,
    commands: Commands,
    timeline: Timeline,
}

/// One bus cycle; returns its header.
fn cycle(d: &mut Daemon, sim: &mut SimBackend, p: &mut SimBackendPorts) -> Header {
    let taken = p.bus.held().map_or(Header::default(), |frames| frames.header);
    let tick = taken.tick;
    // Commands first: those of the scene, which come by tick, then live ones.
    while let Some(live) = p.timeline.due(tick).map(Live::of_scene).or_else(|| p.commands.next()) {
        let mut verdict = Ok(());
        match live.command {
            Command::Push(push) => sim.push(&push),
            Command::Lower(way) if !sim.lower(&way) => {
                let detail = Detail::Message(live.command.address().1.into());
                let code = EventCode::CommandRefused;
                d.report(Header { tick, ..Header::default() }, code, detail);
                verdict = Err(Reason::Event { code, detail });
            }
            _ => {}
        }
        p.commands.answer(&live, verdict);
        d.log.took(taken, &live, &verdict);
    }
    d.log.left_out(taken, p.commands.as_mut());
    // A cycle that was missed while the process was stopped leaves the relay alone: the supply's record is of now.
    let frames = p.bus.held();
    let (frames, state) = match p.bus.is_late() {
        true => sim.step_late(frames),
        false => sim.step(frames, p.power.latest()),
    };
    let header = state.header;
    p.state.write(state);
    d.log.keep(&SIM_STATE, state);
    p.bus.answer(d, frames);
    for (code, detail) in sim.events().drain() {
        d.report(header, code, detail);
    }
    d.end(header, 0);
    header
}
