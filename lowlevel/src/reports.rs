//! Reports of the joint loop: its events, and what was reported already.

use config::Robot;
use drives::cia402;
use messages::{Detail, EventCode, EventQueue, MAX_JOINTS, Sensors};

/// \[s\] Minimum time without a limit before the same joint's limit is reported again.
const QUIET: f64 = 1.0;

/// Reports of the joint loop.
#[derive(Clone)]
pub(crate) struct Reports {
    events: EventQueue,
    /// Tick at which each joint was held back last.
    limited: [Option<u64>; MAX_JOINTS],
    /// Drives with a fault that was reported.
    named: [bool; MAX_JOINTS],
    /// Joints whose following error was reported, since the supply is on.
    strayed: [bool; MAX_JOINTS],
}

impl Reports {
    /// Nothing was reported yet.
    pub(crate) fn new() -> Self {
        Self {
            events: EventQueue::default(),
            limited: [None; MAX_JOINTS],
            named: [false; MAX_JOINTS],
            strayed: [false; MAX_JOINTS],
        }
    }

    /// Events that were not taken yet.
    pub(crate) fn events(&mut self) -> &mut EventQueue {
        &mut self.events
    }

    /// Reports the cause of a stop.
    pub(crate) fn stop(&mut self, code: EventCode, detail: Detail) {
        if let Detail::Drive { joint, .. } = detail {
            self.named[joint] = true;
        }
        self.events.push(code, detail);
    }

    /// Reports the joints (bits) that are held back at `tick`, with cycles of `dt` \[s\]: each once, until it was not for
    /// [`QUIET`].
    pub(crate) fn limits(&mut self, held: u64, tick: u64, dt: f64) {
        for j in (0..MAX_JOINTS).filter(|j| held >> j & 1 == 1) {
            let quiet = |last: u64| tick.saturating_sub(last) as f64 * dt > QUIET;
            if self.limited[j].is_none_or(quiet) {
                self.events.push(EventCode::TargetLimited, Detail::Joint(j));
            }
            self.limited[j] = Some(tick);
        }
    }

    /// Reports a joint that is not where it was commanded to be, once.
    pub(crate) fn following_error(&mut self, j: usize) {
        if !std::mem::replace(&mut self.strayed[j], true) {
            self.events.push(EventCode::FollowingError, Detail::Joint(j));
        }
    }

    /// Following errors are reported anew: the supply is off.
    pub(crate) fn forget_following_errors(&mut self) {
        self.strayed = [false; MAX_JOINTS];
    }

    /// Reports drives with a fault, each once: those that the robot `spares`, so that nobody stops, and those whose frames
    /// come back after the stop.
    pub(crate) fn drive_faults(&mut self, robot: &Robot, sensors: &Sensors, spares: impl Fn(usize) -> bool) {
        for j in 0..robot.joints.len() {
            let Some(detail) = drive_fault(sensors, j) else {
                self.named[j] = false;
                continue;
            };
            if !std::mem::replace(&mut self.named[j], true) {
                let code = if spares(j) { EventCode::DriveHeld } else { EventCode::DriveTripped };
                self.events.push(code, detail);
            }
        }
    }
}

/// Fault of the drive of joint `j`, if it has one.
pub(crate) fn drive_fault(sensors: &Sensors, j: usize) -> Option<Detail> {
    let state = cia402::state_of(sensors.drive_status[j] as u16);
    let broken = matches!(state, Some(cia402::DriveState::Fault | cia402::DriveState::FaultReaction));
    broken.then(|| Detail::Drive { joint: j, error: sensors.drive_error[j] as u16 })
}
