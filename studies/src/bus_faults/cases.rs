//! The faults that are tried, and what is demanded of each.

use std::ops::RangeInclusive;

use config::Setup;
use config::bus_fault::{BusFault, FaultKind, FrameDirection};
use messages::EventCode;

use super::trial::FaultTrial;
use super::{FaultCaseRow, TrialEnd};

/// Local controllers of a joint that carries the robot, of one it can do without, and of the force sensor's foot.
const KNEE: &str = "shank_left";
const ARM: &str = "arm_left";
/// \[cycle\] Lengths of bursts.
pub(super) const BURSTS: [u32; 8] = [1, 2, 5, 10, 15, 20, 30, 50];
/// \[s\] For as long as the robot is watched.
const FOR_EVER: f64 = 1e3;
/// \[s\] Two strides.
const WHILE: f64 = 3.0;
/// \[cycle\] All joints rest so soon after a stop began.
const AT_REST: u64 = 150;

/// One case.
pub(super) struct Case {
    pub(super) name: String,
    pub(super) faults: Vec<BusFault>,
    pub(super) demand: InstantDemand,
}

/// What is demanded at every instant.
#[derive(Default)]
pub(super) struct InstantDemand {
    /// Noticed within so many cycles.
    noticed: Option<u64>,
    /// Stopped or switched off, for this reason, in these cycles; none: must not be.
    reacts: Option<(EventCode, RangeInclusive<u64>)>,
    /// Told besides.
    told: Vec<EventCode>,
    /// Where nothing must stop it: it may yet fall, if its joints are braked before.
    may_fall: bool,
    /// Supply off within so many cycles.
    power_off: Option<u64>,
}

impl InstantDemand {
    /// The robot walks on; this is told.
    fn walks(told: &[EventCode]) -> Self {
        Self { told: told.to_vec(), ..Self::default() }
    }

    /// The same, of a fault beyond all reason: it may fall, but not with joints in motion.
    fn bears(told: &[EventCode]) -> Self {
        Self { may_fall: true, ..Self::walks(told) }
    }

    /// The robot is stopped.
    fn stops(why: EventCode, cycles: RangeInclusive<u64>) -> Self {
        Self { noticed: Some(1), reacts: Some((why, cycles)), ..Self::default() }
    }

    /// Noticed later than in the first cycle: nothing is missing yet.
    fn noticed_in(self, cycles: u64) -> Self {
        Self { noticed: Some(cycles), ..self }
    }

    fn and_power_off(self, cycles: u64) -> Self {
        Self { power_off: Some(cycles), ..self }
    }

    fn and_tells(mut self, told: &[EventCode]) -> Self {
        self.told.extend(told);
        self
    }

    /// What of it is not met.
    pub(super) fn unmet(&self, row: &FaultCaseRow, trials: &[FaultTrial]) -> Vec<String> {
        let mut unmet = Vec::new();
        let mut demand = |met: bool, text: String| {
            if !met {
                unmet.push(text);
            }
        };
        if let Some(most) = self.noticed {
            demand(row.noticed_cycles.is_some_and(|n| n <= most), format!("noticed within {most} cycles"));
        }
        for code in self.told.iter().chain(self.reacts.iter().map(|(code, _)| code)) {
            demand(trials.iter().all(|t| t.log.contains(code)), format!("{code:?} told"));
        }
        match &self.reacts {
            None if self.may_fall => {
                demand(row.end < TrialEnd::Fell, "joints at rest before it falls".into());
            }
            None => demand(row.end == TrialEnd::Walks, "walks on".into()),
            Some((code, cycles)) => {
                let in_time = |t: &FaultTrial| t.reacted.is_some_and(|n| cycles.contains(&n));
                demand(trials.iter().all(in_time), format!("{code:?} in cycles {cycles:?}"));
                demand(row.end < TrialEnd::Fell, "joints at rest before it falls".into());
                demand(
                    row.at_rest_cycles.is_some_and(|n| n <= AT_REST),
                    format!("at rest in {AT_REST} cycles"),
                );
            }
        }
        if let Some(most) = self.power_off {
            demand(row.power_off_cycles.is_some_and(|n| n <= most), format!("power off in {most} cycles"));
        }
        unmet
    }
}

/// A burst of so many cycles, both ways: of the knee's line, or of all.
pub(super) fn burst(cycles: u32, knee: bool) -> BusFault {
    let fault = BusFault { cycles, ..BusFault::new(FaultKind::Lost, 0.0, 1e-6) };
    if knee { on(KNEE, fault) } else { fault }
}

fn on(node: &str, fault: BusFault) -> BusFault {
    BusFault { node: Some(node.into()), ..fault }
}

fn to_drives(fault: BusFault) -> BusFault {
    BusFault { way: Some(FrameDirection::ToDrives), ..fault }
}

fn from_drives(fault: BusFault) -> BusFault {
    BusFault { way: Some(FrameDirection::FromDrives), ..fault }
}

fn share(share: f64, fault: BusFault) -> BusFault {
    BusFault { share, ..fault }
}

fn cycles(cycles: u32, fault: BusFault) -> BusFault {
    BusFault { cycles, ..fault }
}

/// All cases.
pub(super) fn all(setup: &Setup) -> Vec<Case> {
    let silent = u64::from(setup.system.bus.missed) + 1;
    let fault = |kind: FaultKind| BusFault::new(kind, 0.0, WHILE);
    let for_ever = |kind: FaultKind| BusFault::new(kind, 0.0, FOR_EVER);
    let brief =
        |kind: FaultKind, cycles: u32| BusFault::new(kind, 0.0, f64::from(cycles) * setup.scene.cycle);
    let case = |name: &str, fault: BusFault, demand: InstantDemand| Case {
        name: name.into(),
        faults: vec![fault],
        demand,
    };
    use EventCode::{
        BusActive, BusOff, BusPassive, BusSilent, BusWarning, DriveHeld, DriveTripped, FrameRefused,
        FramesLost, NodeBack, NodeHeld, NodeSilent,
    };
    use FaultKind::{Corrupted, Duplicated, Flipped, Late, Lost, Pulled, Reordered, Shorted, Silent};
    let lost = |rate: f64| share(rate, fault(Lost));
    let refused = || InstantDemand::walks(&[FrameRefused]);
    vec![
        case("lost 0.1 % of all frames", lost(0.001), InstantDemand::walks(&[FramesLost])),
        case("lost 1 %", lost(0.01), InstantDemand::walks(&[FramesLost])),
        case("lost 10 %", lost(0.1), InstantDemand::walks(&[FramesLost])),
        case(
            "lost for ever, from all drives",
            from_drives(for_ever(Lost)),
            InstantDemand::stops(BusSilent, silent..=silent),
        ),
        // The drives' fault is in the next answer, and believed when it is said twice.
        case(
            "lost for ever, to a knee: its drives stop by themselves",
            on(KNEE, to_drives(for_ever(Lost))),
            InstantDemand::stops(DriveTripped, silent + 1..=silent + 1).noticed_in(silent + 1),
        ),
        case("late by 1 cycle, 10 %", share(0.1, cycles(1, fault(Late))), refused()),
        case(
            "late by 5 cycles, all of a knee, for 10 cycles",
            on(KNEE, cycles(5, brief(Late, 10))),
            InstantDemand::walks(&[FrameRefused, NodeHeld, NodeBack]),
        ),
        case(
            "late by 3 cycles, all, for ever",
            cycles(3, for_ever(Late)),
            InstantDemand::stops(BusSilent, silent..=silent).and_tells(&[FrameRefused]),
        ),
        case("duplicated, all, in the same cycle", cycles(0, fault(Duplicated)), refused()),
        case("duplicated, all, 7 cycles later", cycles(7, fault(Duplicated)), refused()),
        case("reordered, all", fault(Reordered), InstantDemand::default()),
        case("corrupted 1 %", share(0.01, fault(Corrupted)), InstantDemand::walks(&[FramesLost])),
        case(
            "corrupted, all to a knee: lowlevel's controller leaves the bus",
            on(KNEE, to_drives(for_ever(Corrupted))),
            InstantDemand::stops(BusOff, 1..=17)
                .noticed_in(6)
                .and_power_off(17)
                .and_tells(&[BusWarning, BusPassive]),
        ),
        case(
            "corrupted, all from a knee: the node's controller leaves the bus",
            on(KNEE, from_drives(for_ever(Corrupted))),
            InstantDemand::stops(NodeSilent, silent..=silent).and_tells(&[BusPassive]),
        ),
        case(
            "one bit flipped unseen, 0.1 % of frames from the drives",
            share(0.001, from_drives(fault(Flipped))),
            refused(),
        ),
        case(
            "one bit flipped unseen, 1 % of frames from the drives",
            share(0.01, from_drives(fault(Flipped))),
            InstantDemand::bears(&[FrameRefused]),
        ),
        case(
            "one bit flipped unseen, 0.1 % of frames to the drives",
            share(0.001, to_drives(fault(Flipped))),
            InstantDemand::walks(&[]),
        ),
        case(
            "knee silent for 10 cycles",
            on(KNEE, brief(Silent, 10)),
            InstantDemand::walks(&[FramesLost, NodeHeld, NodeBack]),
        ),
        case(
            "knee silent for ever",
            on(KNEE, for_ever(Silent)),
            InstantDemand::stops(NodeSilent, silent..=silent),
        ),
        case(
            "knee silent for 30 cycles: its drives have stopped when it is back",
            on(KNEE, brief(Silent, 30)),
            InstantDemand::stops(NodeSilent, silent..=silent).and_tells(&[NodeBack, DriveTripped]),
        ),
        case("arm silent for ever", on(ARM, for_ever(Silent)), InstantDemand::walks(&[NodeHeld])),
        case(
            "arm silent for 30 cycles",
            on(ARM, brief(Silent, 30)),
            InstantDemand::walks(&[NodeHeld, NodeBack, DriveHeld]),
        ),
        case(
            "cable of a knee pulled for 10 cycles",
            on(KNEE, brief(Pulled, 10)),
            InstantDemand::walks(&[BusPassive, NodeBack, BusActive]),
        ),
        case(
            "cable of a knee pulled for ever",
            on(KNEE, for_ever(Pulled)),
            InstantDemand::stops(NodeSilent, silent..=silent).and_tells(&[BusPassive]),
        ),
        case(
            "cable of a knee shorted",
            on(KNEE, for_ever(Shorted)),
            InstantDemand::stops(BusOff, 1..=1).and_power_off(1),
        ),
    ]
}
