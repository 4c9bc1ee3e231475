//! How a run ended: whether the robot was still doing what it is told to, and if not, since when and why.

use std::fmt;

use messages::{Detail, EventCode, GaitState, Words};

use crate::Cycle;

/// \[s\] For so long a run of a simulated robot goes on after it fell: it then lies still.
pub const AFTER_FALL: f64 = 2.0;

/// What ended the walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WalkEnd {
    /// The scene was done.
    Done,
    /// Somebody asked for the end, and the robot came to a stand.
    Asked,
    /// The robot fell.
    Fell,
    /// The simulation lost its numbers.
    Diverged,
    /// The motor supply went off for this reason and stayed off.
    PowerOff(EventCode),
    /// The joints were brought to rest for this reason, and held.
    Stopped(EventCode),
}

impl fmt::Display for WalkEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Done => write!(f, "done"),
            Self::Asked => write!(f, "asked"),
            Self::Fell => write!(f, "fell"),
            Self::Diverged => write!(f, "diverged"),
            Self::PowerOff(reason) => write!(f, "power_off: {reason:?}"),
            Self::Stopped(reason) => write!(f, "stopped: {reason:?}"),
        }
    }
}

/// Gathers, event by event and cycle by cycle, how a run ends.
#[derive(Clone, Debug, Default)]
pub struct Ending {
    /// Somebody asked for the end.
    pub asked: bool,
    /// The robot did not come to a stand when somebody did.
    pub unfinished: bool,
    /// Commands of the scene that were refused, or accepted out of standing and then not to be walked.
    pub refused: u64,
    fell: Option<f64>,
    diverged: Option<f64>,
    /// Events that say that the simulation is not to be trusted, each kind once, with their times.
    doubts: Vec<(f64, EventCode, Detail)>,
    off: Option<(f64, EventCode)>,
    stopped: Option<(f64, EventCode)>,
    /// The last event that a stop comes of.
    stop: Option<(f64, EventCode)>,
    time: f64,
    powered: bool,
    stands: bool,
}

impl Ending {
    /// Something happened at `time` \[s\]; the same event may be told by several processes.
    pub fn tell(&mut self, time: f64, code: EventCode, detail: Detail) {
        if is_doubt(code) && self.doubts.iter().all(|doubt| doubt.1 != code) {
            self.doubts.push((time, code, detail));
        }
        let reason = if let Detail::Cause(reason) = detail { reason } else { EventCode::None };
        match code {
            EventCode::Fallen => self.fell = self.fell.or(Some(time)),
            EventCode::Diverged | EventCode::ForceImplausible => self.diverged = self.diverged.or(Some(time)),
            EventCode::PowerOff => self.off = Some((time, reason)),
            // Armed again: what was before is over, but for a fall.
            EventCode::PowerOn => (self.off, self.stopped) = (None, None),
            // Out of standing there is no plan that is kept: nothing of the command was done.
            EventCode::PlanKept if self.stands => self.refused += 1,
            code if stops(code) => self.stop = Some((time, code)),
            _ => {}
        }
    }

    /// One cycle that begins at `time` \[s\]: whether the supply is measured on, and where in a walk the robot is.
    pub fn see(&mut self, time: f64, powered: bool, gait: GaitState) {
        (self.time, self.powered, self.stands) = (time, powered, gait == GaitState::Standing);
        match gait {
            GaitState::Fallen => self.fell = self.fell.or(Some(time)),
            GaitState::Halted => {
                let why = self.stop.unwrap_or((time, EventCode::SafeStop));
                self.stopped = self.stopped.or(Some(why));
            }
            // It moves again; without supply nothing tells.
            _ if powered => self.stopped = None,
            _ => {}
        }
    }

    /// Everything of a cycle that ends at `time` \[s\].
    pub fn follow(&mut self, time: f64, cycle: &Cycle) {
        cycle.events.iter().for_each(|&(_, code, detail)| self.tell(time, code, detail));
        self.refused += cycle.refused;
        // The simulation knows of a fall that the robot does not notice.
        let fallen = cycle.sim_state.fallen == 1;
        let gait = if fallen { GaitState::Fallen } else { cycle.controller_state.gait.into() };
        self.see(time, cycle.sensors.power == 1, gait);
    }

    /// True if a run of a simulated robot is over at `time` \[s\] before its scene is.
    pub fn is_over(&self, time: f64) -> bool {
        self.fell.or(self.diverged).is_some_and(|fell| time > fell + AFTER_FALL)
    }

    /// When it fell \[s\]; none: it did not.
    pub fn fell(&self) -> Option<f64> {
        self.fell
    }

    /// When the simulation lost its numbers \[s\]; none: it did not.
    pub fn diverged(&self) -> Option<f64> {
        self.diverged
    }

    /// Events that say that the simulation is not to be trusted, as sentences.
    pub fn doubts(&self) -> Vec<String> {
        let sentence = |&(time, code, detail): &(f64, EventCode, Detail)| {
            format!("at {time:.3} s: {}", Words::default().sentence(code as u64, detail.pack()))
        };
        self.doubts.iter().map(sentence).collect()
    }

    /// What ended the walk, and when \[s\]: of several causes the first.
    pub fn end(&self) -> (WalkEnd, f64) {
        if let Some(time) = self.diverged {
            return (WalkEnd::Diverged, time); // nothing before it can be trusted either
        }
        let fell = self.fell.map(|time| (WalkEnd::Fell, time));
        let off = self.off.filter(|_| !self.powered).map(|(time, why)| (WalkEnd::PowerOff(why), time));
        let stopped = self.stopped.map(|(time, why)| (WalkEnd::Stopped(why), time));
        let orderly = (if self.asked { WalkEnd::Asked } else { WalkEnd::Done }, self.time);
        let causes = [fell, off, stopped].into_iter().flatten();
        causes.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or(orderly)
    }
}

/// True for events after which a simulation says nothing about the robot.
pub fn is_doubt(code: EventCode) -> bool {
    use EventCode::{
        ContactNotConverged, Diverged, DriveFault, ForceImplausible, IntegratorGaveUp, StepTooLong,
    };
    matches!(
        code,
        ContactNotConverged | Diverged | DriveFault | ForceImplausible | IntegratorGaveUp | StepTooLong
    )
}

/// Whether a controlled stop can come of this.
fn stops(code: EventCode) -> bool {
    use EventCode::{
        BusOff, BusSilent, DriveNotEnabled, DriveTripped, Lifted, NodeSilent, SafeStop, SensorNotFinite,
        TargetNotFinite, TargetsStale, TooManyOverruns,
    };
    matches!(
        code,
        BusOff
            | BusSilent
            | DriveNotEnabled
            | DriveTripped
            | Lifted
            | NodeSilent
            | SafeStop
            | SensorNotFinite
            | TargetNotFinite
            | TargetsStale
            | TooManyOverruns
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(events: &[(f64, EventCode, EventCode)], powered: bool, gait: GaitState) -> (String, f64) {
        let mut ending = Ending::default();
        events.iter().for_each(|&(time, code, detail)| ending.tell(time, code, Detail::Cause(detail)));
        ending.see(20.0, powered, gait);
        let (end, time) = ending.end();
        (end.to_string(), time)
    }

    /// Regression: a walk that could not be planned counted as done, at 0 m/s.
    #[test]
    fn what_cannot_be_walked_out_of_standing_is_not_done() {
        for (gait, refused) in [(GaitState::Standing, 1), (GaitState::Walking, 0)] {
            let mut ending = Ending::default();
            ending.see(3.0, true, gait);
            ending.tell(3.001, EventCode::PlanKept, Detail::Plan(1));
            assert_eq!(ending.refused, refused, "{gait:?}");
        }
    }

    #[test]
    fn the_first_cause_that_is_not_mended_ended_the_run() {
        use EventCode::{
            EmergencyStop, Fallen, FollowingError, None, PowerOff, PowerOn, SafeStop, TargetsStale,
        };
        let on = (0.04, PowerOn, None);
        let off = (17.6, PowerOff, FollowingError);
        let table: [(&[_], _, _, _, _); 8] = [
            (&[on], true, GaitState::Standing, "done", 20.0),
            (&[on, (9.0, Fallen, None), (9.0, SafeStop, None)], true, GaitState::Fallen, "fell", 9.0),
            (&[on, off], false, GaitState::Idle, "power_off: FollowingError", 17.6),
            // It fell because of the supply.
            (&[on, off, (18.0, Fallen, None)], false, GaitState::Fallen, "power_off: FollowingError", 17.6),
            (&[on, (5.0, TargetsStale, None)], true, GaitState::Halted, "stopped: TargetsStale", 5.0),
            // Armed again.
            (
                &[on, (5.0, PowerOff, EmergencyStop), (6.0, PowerOn, None)],
                true,
                GaitState::Standing,
                "done",
                20.0,
            ),
            // The supply goes off behind the joint loop, which has ended.
            (&[on, off], true, GaitState::Standing, "done", 20.0),
            (&[], true, GaitState::Fallen, "fell", 20.0),
        ];
        for (events, powered, gait, by, at) in table {
            assert_eq!(after(events, powered, gait), (by.to_owned(), at), "{events:?}");
        }
    }
}
