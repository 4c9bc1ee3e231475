//! `gangwerk faults`: faults F1 to F40 against a walking robot, fault → expected → observed → time; every instant drawn from a
//! seed.
//!
//! Runs are real ones, started as `gangwerk run` does, and judged by what the processes wrote. A run that was disturbed from
//! outside before or beside its fault is done again, twice at most, and the table says so. What nobody tries is red.
//!
//! | file | what |
//! |---|---|
//! | `table` | the faults and what is expected |
//! | `deaths`, `bystanders`, `starts`, `simulated` | the scenarios that try them |
//! | `robot`, `lab`, `scene` | a robot that is hurt, and what is seen of it |
//! | `long` | random kills and stops |
//! | `text` | the table for people |

mod bystanders;
mod deaths;
mod lab;
mod long;
mod robot;
mod scene;
mod simulated;
mod starts;
mod table;
mod text;

use serde::Serialize;

use lab::{FaultObservation, Found, Lab, Random};
pub use long::long;
pub use table::{FAULTS, Fault, Proof};
pub use text::{line, markdown};

/// Runs of one scenario that may be spoilt from outside.
const ATTEMPTS: u32 = 3;

/// Which faults one run, or a few, bring about.
struct Scenario(&'static [&'static str], fn(&mut Lab) -> Found);

const SCENARIOS: [Scenario; 20] = [
    Scenario(&["F1"], deaths::planner_killed),
    Scenario(&["F2"], deaths::controller_killed),
    Scenario(&["F3"], deaths::lowlevel_killed),
    Scenario(&["F4"], deaths::watchdog_killed),
    Scenario(&["F7"], deaths::watchdog_stopped),
    Scenario(&["F8"], deaths::planner_hangs),
    Scenario(&["F36"], deaths::planner_crashes),
    Scenario(&["F31"], deaths::operator_killed),
    Scenario(&["F33"], deaths::spinner),
    Scenario(
        &["F5", "F6", "F10", "F11", "F12", "F13", "F14", "F20", "F21", "F26", "F29", "F30"],
        bystanders::all,
    ),
    Scenario(&["F38"], bystanders::dying_broker),
    Scenario(&["F15", "F16", "F17"], simulated::bus_faults),
    Scenario(&["F39"], simulated::dead_peer),
    Scenario(&["F40"], simulated::signals),
    Scenario(&["F19"], starts::long_up),
    Scenario(&["F22"], starts::unknown_key),
    Scenario(&["F23"], starts::full_disk),
    Scenario(&["F24"], starts::full_memory),
    Scenario(&["F25", "F37"], starts::supervisor_killed),
    Scenario(&["F28"], starts::death_at_start),
];

/// Two more, apart from the rest: they take rights away.
const UNPRIVILEGED: [Scenario; 2] =
    [Scenario(&["F34"], starts::few_descriptors), Scenario(&["F35"], starts::no_rights)];

/// Result of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FaultVerdict {
    /// As expected.
    Met,
    /// Not as expected, or not tried by anything.
    NotMet,
    /// Cannot be done to a running robot; what bounds it stands in its row.
    NotApplicable,
}

/// A line of the table.
#[derive(Clone, Debug, Serialize)]
pub struct FaultRow {
    /// Number, as `F3`.
    pub fault: &'static str,
    /// Fault injected.
    pub name: &'static str,
    /// Expected behaviour.
    pub expected: &'static str,
    /// Observed behaviour, or its bound.
    pub observed: String,
    /// From the fault to the reaction, in bus cycles.
    pub cycles: Option<u64>,
    /// The same in time \[ms\].
    pub ms: Option<f64>,
    /// Whether that is as expected.
    pub verdict: FaultVerdict,
    /// Unmet part of the expectation.
    pub unmet: Vec<String>,
    /// Runs that were disturbed from outside and done again, and by what.
    pub repeated: Vec<String>,
}

/// Faults to try.
#[derive(Clone, Debug)]
pub struct FaultsOptions {
    /// The executable `gangwerk`.
    pub exe: String,
    /// Seed of all instants.
    pub seed: u64,
    /// Only these faults, as `F3`; none: all.
    pub only: Vec<String>,
}

/// Tries them, and hands each row to `told` as soon as it is known; rows in the order of the faults' numbers.
///
/// # Errors
/// A fault of `only` that there is not.
pub fn run(order: &FaultsOptions, mut told: impl FnMut(&FaultRow)) -> Result<Vec<FaultRow>, String> {
    if let Some(unknown) = order.only.iter().find(|id| !FAULTS.iter().any(|f| f.id == id.as_str())) {
        return Err(format!("there is no fault {unknown}: F1 to F40"));
    }
    let wanted = |id: &str| order.only.is_empty() || order.only.iter().any(|only| only == id);
    let mut rows = Vec::new();
    for (n, Scenario(faults, play)) in SCENARIOS.iter().chain(&UNPRIVILEGED).enumerate() {
        if faults.iter().any(|id| wanted(id)) {
            // Each scenario has numbers of its own: leaving one out changes no other.
            let mut lab = Lab { exe: order.exe.clone(), random: Random(order.seed.wrapping_add(n as u64)) };
            let (seen, repeated) = played(&mut lab, faults, *play);
            let new = seen.into_iter().filter(|s| wanted(s.fault)).map(|seen| row(seen, &repeated));
            rows.extend(new.inspect(&mut told));
        }
    }
    for fault in FAULTS.iter().filter(|f| wanted(f.id)) {
        if !rows.iter().any(|r| r.fault == fault.id) {
            let row = untried(fault);
            told(&row);
            rows.push(row);
        }
    }
    rows.sort_by_key(|row| FAULTS.iter().position(|f| f.id == row.fault));
    Ok(rows)
}

/// Plays a scenario until it was not disturbed, or is as expected all the same.
fn played(
    lab: &mut Lab,
    faults: &[&'static str],
    play: fn(&mut Lab) -> Found,
) -> (Vec<FaultObservation>, Vec<String>) {
    let mut repeated = Vec::new();
    loop {
        let (seen, disturbed) = play(lab).unwrap_or_else(|error| {
            let failed = |id: &&'static str| FaultObservation::new(id, "-").demand(false, error.clone());
            (faults.iter().map(failed).collect(), Some(format!("no result: {error}")))
        });
        match disturbed.filter(|_| seen.iter().any(|s| !s.unmet.is_empty())) {
            Some(why) if repeated.len() + 1 < ATTEMPTS as usize => repeated.push(why),
            _ => return (seen, repeated),
        }
    }
}

fn row(seen: FaultObservation, repeated: &[String]) -> FaultRow {
    let fault = FAULTS.iter().find(|f| f.id == seen.fault).unwrap_or(&FAULTS[0]);
    FaultRow {
        observed: seen.reaction,
        cycles: seen.cycles,
        ms: seen.ms,
        verdict: if seen.unmet.is_empty() { FaultVerdict::Met } else { FaultVerdict::NotMet },
        unmet: seen.unmet,
        repeated: repeated.to_vec(),
        ..untried(fault)
    }
}

/// The row of a fault that no scenario has tried.
fn untried(fault: &Fault) -> FaultRow {
    let (observed, verdict, unmet) = match fault.proof {
        Proof::Bounded(why) => (why.to_owned(), FaultVerdict::NotApplicable, Vec::new()),
        Proof::Tried => ("-".to_owned(), FaultVerdict::NotMet, vec!["nothing tries it".to_owned()]),
    };
    let Fault { id, name, expected, .. } = *fault;
    FaultRow {
        fault: id,
        name,
        expected,
        observed,
        cycles: None,
        ms: None,
        verdict,
        unmet,
        repeated: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fault is brought about by one scenario, or it says why by none.
    #[test]
    fn every_fault_is_tried_once_or_says_why_not() {
        let tried: Vec<&str> = SCENARIOS.iter().chain(&UNPRIVILEGED).flat_map(|s| s.0).copied().collect();
        for (n, fault) in FAULTS.iter().enumerate() {
            assert_eq!(fault.id, format!("F{}", n + 1));
            let times = tried.iter().filter(|id| **id == fault.id).count();
            let wanted = usize::from(matches!(fault.proof, Proof::Tried));
            assert_eq!(times, wanted, "{}", fault.id);
        }
    }

    #[test]
    fn an_unmet_demand_is_red() {
        let seen = FaultObservation::new("F3", "-").demand(false, "stands");
        assert_eq!(row(seen, &[]).verdict, FaultVerdict::NotMet);
        let seen = FaultObservation::new("F3", "-").demand(true, "stands");
        assert_eq!(row(seen, &[]).verdict, FaultVerdict::Met);
    }

    #[test]
    fn a_fault_that_nothing_tries_is_red() {
        let row = untried(&Fault { id: "F1", name: "", expected: "", proof: Proof::Tried });
        assert_eq!(row.verdict, FaultVerdict::NotMet);
    }
}
