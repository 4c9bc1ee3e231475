//! Reports of the joint loop: one event in a cycle, and what was reported already.

use config::Robot;
use drives::cia402;
use messages::{EventCode, MAX_JOINTS, Sensors};

/// \[s\] Minimum time without a limit before the same joint's limit is reported again.
const QUIET: f64 = 1.0;

/// Reports of the joint loop.
#[derive(Clone)]
pub(crate) struct Reports {
    event: Option<(EventCode, u64)>,
    /// Tick at which each joint was held back last.
    limited: [Option<u64>; MAX_JOINTS],
    /// Drives with a fault that was reported.
    named: [bool; MAX_JOINTS],
}

impl Reports {
    /// Nothing was reported yet.
    pub(crate) fn new() -> Self {
        Self { event: None, limited: [None; MAX_JOINTS], named: [false; MAX_JOINTS] }
    }

    /// The event since the last call.
    pub(crate) fn take(&mut self) -> Option<(EventCode, u64)> {
        self.event.take()
    }

    /// Reports this, whatever else was to be reported.
    pub(crate) fn set(&mut self, code: EventCode, detail: u64) {
        self.event = Some((code, detail));
    }

    /// Reports the joints (bits) that are held back at `tick`, with cycles of `dt` \[s\]: each once, until it was not for
    /// [`QUIET`]; in the next cycle if something else is reported in this one.
    pub(crate) fn limits(&mut self, held: u64, tick: u64, dt: f64) {
        for j in (0..MAX_JOINTS).filter(|j| held >> j & 1 == 1) {
            let quiet = |last: u64| tick.saturating_sub(last) as f64 * dt > QUIET;
            let begins = self.limited[j].is_none_or(quiet);
            if begins && self.event.is_some() {
                continue;
            }
            if begins {
                self.event = Some((EventCode::TargetLimited, j as u64));
            }
            self.limited[j] = Some(tick);
        }
    }

    /// Reports drives with a fault, each once, one in a cycle: those that the robot `spares`, so that nobody stops, and
    /// those whose frames come back after the stop.
    pub(crate) fn drive_faults(&mut self, robot: &Robot, sensors: &Sensors, spares: impl Fn(usize) -> bool) {
        for j in 0..robot.joints.len() {
            let Some(detail) = drive_fault(sensors, j) else {
                self.named[j] = false;
                continue;
            };
            let code = if spares(j) { EventCode::DriveHeld } else { EventCode::DriveTripped };
            let reports = !self.named[j] && self.event.is_none();
            if reports {
                self.event = Some((code, detail));
            }
            // The one that stopped the joints was reported in this cycle.
            self.named[j] |= reports || self.event == Some((EventCode::DriveTripped, detail));
        }
    }
}

/// Fault of the drive of joint `j`: joint and error code, as in [`EventCode::DriveTripped`].
pub(crate) fn drive_fault(sensors: &Sensors, j: usize) -> Option<u64> {
    let state = cia402::state_of(sensors.drive_status[j] as u16);
    let broken = matches!(state, Some(cia402::DriveState::Fault | cia402::DriveState::FaultReaction));
    broken.then(|| j as u64 + (u64::from(sensors.drive_error[j]) << 16))
}
