//! One walk of the scorecard: set up, walked to its end or its fall, judged.

use ::drives::Sampling;
use config::Setup;
use config::method::Integrator;
use config::method::Method;
use messages::{Command, EventCode, Process};
use realtime::clock::thread_time;

use super::entries::ScorecardEntry;
use super::{Result, ScorecardOptions, ScorecardRow};
use chain::Chain;
use chain::figures::{Figures, Gatherer};

/// \[s\] Integration step of type 1, and of the types with motors, of which a shorter one changes no figure by more than
/// a few percent.
const STEPS: [f64; 2] = [2.5e-4, 1e-4];

/// A walk and how it ended.
pub(crate) struct Walked {
    pub(crate) figures: Figures,
    /// What ended it before its time, if anything did.
    pub(crate) ended: Option<String>,
}

impl Walked {
    /// The same in the sense of the scorecard: to its end, and on its feet.
    pub(super) fn well(&self) -> bool {
        self.ended.is_none()
    }
}

/// The scene of an entry with the entry's model and this bus cycle \[s\].
pub(super) fn set_up(order: &ScorecardOptions<'_>, scene: &str, depth: u8, cycle: f64) -> Result<Setup> {
    let mut setup = Setup::load(order.config, scene).map_err(|e| e.to_string())?;
    let integrator = if depth == 1 { Integrator::Euler } else { Integrator::SemiImplicit };
    let mut step = STEPS[usize::from(depth > 1)];
    // Drives that sample by themselves do so where a step ends.
    if let (true, Some(Sampling::Period(sampled))) =
        (depth > 1, setup.robot.drives.first().map(|d| d.control.sampling))
    {
        step = sampled.speed / (sampled.speed / step).ceil();
    }
    setup.scene.choose(Method { depth, integrator, substeps: (cycle / step).round() as u32 });
    setup.scene.cycle = cycle;
    setup.scene.seed = order.seed;
    Ok(setup)
}

/// One walk.
pub(crate) fn walk(setup: &Setup) -> Result<Walked> {
    let begun = thread_time();
    let mut chain = Chain::new(setup).map_err(|e| e.to_string())?;
    let mut gatherer = Gatherer::default();
    let mut ended = None;
    for _ in 0..(setup.scene.duration / setup.scene.cycle).round() as u64 {
        let c = chain.step();
        gatherer.add(&c.sim_state, &c.controller_state);
        ended = c.events.iter().find_map(|&(who, code, _)| end(who, code, c.sim_state.time));
        if ended.is_some() {
            break;
        }
    }
    let cpu = (thread_time() - begun) as f64 * 1e-9;
    Ok(Walked { figures: gatherer.figures(setup, cpu, None), ended })
}

/// What a walk does not go on after.
fn end(who: Process, code: EventCode, time: f64) -> Option<String> {
    let what = match code {
        EventCode::Fallen => "falls",
        EventCode::Lifted => "lifts off",
        EventCode::SafeStop => "is stopped by the joint loop",
        EventCode::PowerOff => "loses the motor supply",
        EventCode::CommandRefused => "does not take the command",
        EventCode::Diverged | EventCode::ForceImplausible => "simulation diverges",
        _ => return None,
    };
    Some(format!("{what} at {time:.1} s ({})", who.name()))
}

/// The walk of an entry with this bus cycle \[s\].
pub(super) fn of_entry(order: &ScorecardOptions<'_>, entry: &ScorecardEntry, cycle: f64) -> Result<Setup> {
    let mut setup = set_up(order, entry.scene, entry.depth, cycle)?;
    tell(&mut setup.scene.commands, entry.told);
    Ok(setup)
}

/// Puts `told` in the place of the first command to walk; the others to walk are left out. Without any, nothing changes.
fn tell(commands: &mut Vec<(f64, Command)>, told: &[Command]) {
    let walks = |c: &Command| matches!(c, Command::Start | Command::Step(_) | Command::Velocity(_));
    if told.is_empty() {
        return;
    }
    if let Some(first) = commands.iter().position(|(_, c)| walks(c)) {
        let time = commands[first].0;
        commands.retain(|(_, c)| !walks(c));
        commands.splice(first..first, told.iter().map(|c| (time, *c)));
    }
}

/// All rows of an entry with one bus cycle.
pub(super) fn rows(
    order: &ScorecardOptions<'_>,
    entry: &ScorecardEntry,
    cycle: f64,
) -> Result<Vec<ScorecardRow>> {
    let walked = walk(&of_entry(order, entry, cycle)?)?;
    let f = &walked.figures;
    let row = |demand: &super::demand::Demand| {
        let ours = walked.well().then(|| demand.what.of(f));
        ScorecardRow {
            entry: entry.name.into(),
            scene: entry.scene.into(),
            what: demand.what.name().into(),
            demanded: demand.text(),
            ours,
            unit: demand.what.unit().into(),
            goal: demand.goal(ours),
            note: walked.ended.clone().unwrap_or_default(),
            depth: f.depth.clone(),
            cycle_s: cycle,
            cpu_s: f.cpu_s,
            published: demand.published.into(),
        }
    };
    Ok(entry.demands.iter().map(row).collect())
}
