//! `/rosout`: events in words, for the log panels of viewers.

use messages::record::Visit;
use messages::{Event, EventCode};

use crate::cdr::Encoder;

/// Numbers of `rcl_interfaces/Log`.
#[derive(Clone, Copy)]
enum Level {
    Debug = 10,
    Info = 20,
    Warn = 30,
    Error = 40,
}

/// `rcl_interfaces/Log` of an event that `process` told.
pub(crate) fn log(e: &mut Encoder, stamp_ns: u64, process: &str, event: &Event) {
    let code = EventCode::from_number(event.code);
    e.begin().stamp(stamp_ns);
    e.u8(code.map_or(Level::Warn, level) as u8);
    e.string(process);
    e.string(&sentence(code, event));
    // File, function and line are those of a program, not of a robot.
    e.string("");
    e.string("");
    e.u32(0);
}

/// How much it matters.
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

/// `power off: following error`.
fn sentence(code: Option<EventCode>, event: &Event) -> String {
    let Some(code) = code else { return format!("event {} ({})", event.code, event.detail) };
    let reason = EventCode::from_number(event.detail).filter(|reason| *reason != EventCode::None);
    match (code, reason) {
        (EventCode::PowerOff | EventCode::SafeStop, Some(reason)) => {
            format!("{}: {}", words(code), words(reason))
        }
        _ if event.detail == 0 => words(code),
        _ => format!("{} ({})", words(code), event.detail),
    }
}

/// `FollowingError`: following error.
fn words(code: EventCode) -> String {
    let mut text = String::new();
    for c in format!("{code:?}").chars() {
        if c.is_uppercase() && !text.is_empty() {
            text.push(' ');
        }
        text.extend(c.to_lowercase());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_event_is_a_line_in_words() {
        let event = |code: EventCode, detail: u64| Event { code: code as u64, detail, ..Event::default() };
        let text = |event: Event| sentence(EventCode::from_number(event.code), &event);
        let off = event(EventCode::PowerOff, EventCode::FollowingError as u64);
        assert_eq!(text(off), "power off: following error");
        assert_eq!(text(event(EventCode::ControlLimited, 3)), "control limited (3)");
        assert_eq!(text(event(EventCode::Fallen, 0)), "fallen");
        assert_eq!(text(Event { code: 9999, ..Event::default() }), "event 9999 (0)");
    }
}
