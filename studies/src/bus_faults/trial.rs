//! One fault at one instant of the walk.

use config::bus_fault::BusFault;
use messages::{EventCode, Process, SimState};

use super::{TrialEnd, is_reaction};
use chain::{Chain, Cycle};

/// \[s\] How long the robot is watched.
const WATCHED: f64 = 5.0;
/// \[rad/s\] Slower than this, a joint rests.
const RESTS: f64 = 0.01;

/// \[cycle\] Joints that have not moved for so long rest.
const RESTED: u64 = 10;

/// What happened, in cycles from the first one that the fault strikes.
#[derive(Clone, Debug, Default)]
pub(super) struct FaultTrial {
    /// Lowlevel told something.
    pub(super) noticed: Option<u64>,
    /// A stop or power off began.
    pub(super) reacted: Option<u64>,
    /// From the reaction until all joints rest for good.
    pub(super) at_rest: Option<u64>,
    /// The supply was off.
    pub(super) power_off: Option<u64>,
    /// What the log names, each once, with the first detail.
    pub(super) log: Vec<EventCode>,
    pub(super) fell: Option<u64>,
}

impl FaultTrial {
    pub(super) fn end(&self) -> TrialEnd {
        match (self.fell, self.at_rest, self.reacted) {
            (Some(_), Some(_), _) => TrialEnd::FellBraked,
            (Some(_), None, _) => TrialEnd::Fell,
            (None, _, Some(_)) => TrialEnd::Stands,
            (None, _, None) => TrialEnd::Walks,
        }
    }
}

/// The faults, their times counted from now on, on a walk.
///
/// # Errors
/// A fault names an unknown node.
pub(super) fn run(start: &Chain, faults: &[BusFault]) -> Result<FaultTrial, String> {
    let mut chain = start.clone();
    let dt = chain.cycle();
    let now = chain.tick() + 1;
    let mut faults = faults.to_vec();
    faults.iter_mut().for_each(|fault| fault.time += now as f64 * dt);
    chain.parts().0.inject(&faults)?;
    let mut trial = FaultTrial::default();
    let (mut before, mut moved, mut last) = (None, 0, 0);
    for cycle in 0..(WATCHED / dt) as u64 {
        let c = chain.step();
        trial.note(cycle, c);
        if trial.fell.is_some() {
            break; // a fallen robot is frozen: that its joints rest then says nothing
        }
        if before.replace(c.sim_state).is_some_and(|before| moves(&before, &c.sim_state, dt)) {
            moved = cycle;
        }
        last = cycle;
    }
    let rests = last >= moved + RESTED;
    trial.at_rest = trial.reacted.filter(|_| rests).map(|reacted| (moved + 1).saturating_sub(reacted));
    Ok(trial)
}

impl FaultTrial {
    fn note(&mut self, cycle: u64, c: &Cycle) {
        for &(process, code, _) in &c.events {
            if process == Process::Lowlevel {
                self.noticed.get_or_insert(cycle);
            }
            if is_reaction(code) {
                self.reacted.get_or_insert(cycle);
            }
            if self.belongs(process, code) && !self.log.contains(&code) {
                self.log.push(code);
            }
        }
        if c.power.on == 0 {
            self.power_off.get_or_insert(cycle);
        }
        if c.sim_state.fallen == 1 {
            self.fell.get_or_insert(cycle);
        }
    }

    /// Whether an event has to do with the fault: a walk tells more.
    fn belongs(&self, process: Process, code: EventCode) -> bool {
        process == Process::Lowlevel
            || is_reaction(code)
            || matches!(code, EventCode::NodeStopped | EventCode::Fallen | EventCode::SensorNotFinite)
    }
}

fn moves(before: &SimState, now: &SimState, dt: f64) -> bool {
    before.joint_angle.iter().zip(&now.joint_angle).any(|(a, b)| (a - b).abs() > RESTS * dt)
}
