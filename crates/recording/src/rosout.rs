//! `/rosout`: events in words, for the log panels of viewers.

use messages::record::Visit;
use messages::{Event, EventCode, Words};

use crate::cdr::CdrEncoder;

/// Numbers of `rcl_interfaces/Log`.
#[derive(Clone, Copy)]
enum Level {
    Debug = 10,
    Info = 20,
    Warn = 30,
    Error = 40,
}

/// `rcl_interfaces/Log` of an event that `process` told.
pub(crate) fn log(e: &mut CdrEncoder, stamp_ns: u64, process: &str, event: &Event, words: &Words) {
    let code = EventCode::from_number(event.code);
    e.begin().stamp(stamp_ns);
    e.u8(code.map_or(Level::Warn, level) as u8);
    e.string(process);
    e.string(&words.sentence(event.code, event.detail));
    // File, function and line are those of a program, not of a robot.
    e.string("");
    e.string("");
    e.u32(0);
}

/// Severity.
fn level(code: EventCode) -> Level {
    use EventCode::{
        BusActive, Ended, GazeResumed, Homed, NodeBack, None, ObjectResumed, ParameterSet, PlanActive,
        PowerOn, RingClosed, Saccade, Started,
    };
    use EventCode::{
        BusOff, BusSilent, Diverged, DriveTripped, EmergencyStop, Fallen, FollowingError, Lifted, NodeSilent,
        NodeStopped, PowerOff, ResetMissed, SafeStop, SensorNotFinite, SupplyLost, TargetNotFinite,
        TargetsStale, TooManyOverruns, WatchdogSilent,
    };
    match code {
        None | PlanActive => Level::Debug,
        Started
        | Ended
        | PowerOn
        | ParameterSet
        | ObjectResumed
        | GazeResumed
        | Saccade
        | NodeBack
        | BusActive
        | RingClosed
        | Homed
        | EventCode::ForceZeroed
        | EventCode::EarlyContact => Level::Info,
        PowerOff | ResetMissed | TargetsStale | TargetNotFinite | FollowingError | BusSilent
        | TooManyOverruns | Fallen | Lifted | EmergencyStop | WatchdogSilent | SafeStop | SensorNotFinite
        | Diverged | NodeSilent | BusOff | NodeStopped | DriveTripped | SupplyLost => Level::Error,
        _ => Level::Warn,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every code that somebody adds is thought about: what cuts the power or stops the robot is an error.
    #[test]
    fn what_ends_a_walk_is_an_error_and_routine_is_none() {
        for code in [EventCode::PowerOff, EventCode::SafeStop, EventCode::Fallen, EventCode::FollowingError] {
            assert_eq!(level(code) as u8, Level::Error as u8, "{code:?}");
        }
        for code in [EventCode::Started, EventCode::PowerOn, EventCode::PlanActive] {
            assert!((level(code) as u8) < Level::Warn as u8, "{code:?}");
        }
    }
}
