//! Asking for the emergency stop, and waiting for the answer that the supply is off: the other end of [`crate::estop`].
//!
//! It needs no configuration, no shared memory and no broker.

use std::fmt;
use std::time::Duration;

use ipc::{StopAnswer, StopButton, StopName};
use realtime::clock;

/// Timeout for an answer, and period of the repeated question \[ns\].
const PATIENCE: u64 = clock::SECOND;
const REPEAT: u64 = clock::SECOND / 20;
/// Between two looks for an answer.
const LOOK: Duration = Duration::from_millis(2);

/// Answer of one robot.
#[derive(Clone, Debug)]
pub struct Stopped {
    /// Which.
    pub name: StopName,
    /// Its result.
    pub outcome: StopOutcome,
}

/// Answer of a robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StopOutcome {
    /// Its supply is off since this tick.
    Off {
        /// Tick of the first power record that said so.
        tick: u64,
        /// \[ns\] From the request to that record; none: it was off before.
        after_ns: Option<u64>,
    },
    /// It is not known to be off, and why.
    Failed(String),
}

impl fmt::Display for StopOutcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Off { tick, after_ns: Some(ns) } => {
                write!(f, "power off at tick {tick}, {} us after the request", ns / 1000)
            }
            Self::Off { tick, after_ns: None } => write!(f, "power was off already, since tick {tick}"),
            Self::Failed(why) => write!(f, "NOT KNOWN TO BE OFF: {why}"),
        }
    }
}

/// Asks all of them first, then waits for the answers.
pub fn stop(names: &[StopName]) -> Vec<Stopped> {
    let begun = clock::now();
    let failed = |text: String| Some(StopOutcome::Failed(text));
    let mut asked: Vec<(StopName, Result<StopButton, _>, Option<StopOutcome>)> =
        names.iter().map(|name| (name.clone(), StopButton::new(name), None)).collect();
    let (mut next, mut pending) = (begun, false);
    while asked.iter().any(|(.., outcome)| outcome.is_none()) && clock::now() < begun + PATIENCE {
        let repeat = clock::now() >= next;
        next += if repeat { REPEAT } else { 0 };
        for (_, button, outcome) in asked.iter_mut().filter(|(.., outcome)| outcome.is_none()) {
            match button {
                Err(e) => *outcome = failed(format!("no socket: {e}")),
                Ok(button) if repeat => {
                    // A full queue is no error: it is full of requests.
                    if let Err(e) = button.press() {
                        *outcome = failed(format!("nobody listens, so no watchdog runs there: {e}"));
                    }
                }
                Ok(_) => {}
            }
            match button.as_ref().ok().and_then(|button| button.answer(LOOK)) {
                Some(StopAnswer::Off { tick, stamp_ns }) => {
                    *outcome = Some(StopOutcome::Off { tick, after_ns: stamp_ns.checked_sub(begun) });
                }
                Some(StopAnswer::Pending) => pending = true,
                None => {}
            }
        }
    }
    let silent = if pending {
        "it has the request, but no cycle of its watchdog has acted on it: its time stands still"
    } else {
        "no answer: its watchdog hangs; without it the relay falls by itself"
    };
    let outcome = |o: Option<StopOutcome>| o.unwrap_or_else(|| StopOutcome::Failed(silent.into()));
    asked.into_iter().map(|(name, _, o)| Stopped { name, outcome: outcome(o) }).collect()
}
