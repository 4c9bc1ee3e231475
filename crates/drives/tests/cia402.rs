//! The states of a drive against the tables of the profile, and what must hold on every way through them.

use drives::cia402::{
    DriveFault, DriveInputs, DriveState, DriveStateMachine, ENABLE_OPERATION, WORDS, Wanted, controlword,
    state_of, status_of,
};
use proptest::prelude::*;

const STATES: [DriveState; 8] = [
    DriveState::NotReady,
    DriveState::SwitchOnDisabled,
    DriveState::Ready,
    DriveState::SwitchedOn,
    DriveState::OperationEnabled,
    DriveState::QuickStop,
    DriveState::FaultReaction,
    DriveState::Fault,
];

/// A cycle with supply, reference and this controlword.
fn told(control: u16) -> DriveInputs {
    DriveInputs { control: Some(control), supply: true, permit: true, fault: None, still: false }
}

/// A drive in a state, by the profile's own way.
fn drive_in(state: DriveState) -> DriveStateMachine {
    let mut drive = DriveStateMachine::default();
    let words: &[u16] = match state {
        DriveState::NotReady => &[],
        DriveState::SwitchOnDisabled => &[0x00],
        DriveState::Ready => &[0x00, 0x06],
        DriveState::SwitchedOn => &[0x00, 0x06, 0x07],
        DriveState::QuickStop => &[0x00, 0x06, 0x0F, 0x02],
        DriveState::OperationEnabled | DriveState::FaultReaction | DriveState::Fault => &[0x00, 0x06, 0x0F],
    };
    for &word in words {
        drive.step(&told(word));
    }
    if matches!(state, DriveState::FaultReaction | DriveState::Fault) {
        drive.step(&DriveInputs { fault: Some(DriveFault::FollowingError), ..told(0x0F) });
    }
    if state == DriveState::Fault {
        drive.step(&DriveInputs { still: true, ..told(0x0F) });
    }
    assert_eq!(drive.state(), state);
    drive
}

/// The table of the profile as the Python package canopen 2 has it (`canopen.profiles.p402.State402.TRANSITIONTABLE`):
/// from, to, controlword.
const TRANSITIONS: [(DriveState, DriveState, u16); 15] = [
    (DriveState::Ready, DriveState::SwitchOnDisabled, 0x00), // 7
    (DriveState::OperationEnabled, DriveState::SwitchOnDisabled, 0x00), // 9
    (DriveState::SwitchedOn, DriveState::SwitchOnDisabled, 0x00), // 10
    (DriveState::QuickStop, DriveState::SwitchOnDisabled, 0x00), // 12
    (DriveState::NotReady, DriveState::SwitchOnDisabled, 0x00), // 1
    (DriveState::SwitchOnDisabled, DriveState::Ready, 0x06), // 2
    (DriveState::SwitchedOn, DriveState::Ready, 0x06),       // 6
    (DriveState::OperationEnabled, DriveState::Ready, 0x06), // 8
    (DriveState::Ready, DriveState::SwitchedOn, 0x07),       // 3
    (DriveState::OperationEnabled, DriveState::SwitchedOn, 0x07), // 5
    (DriveState::SwitchedOn, DriveState::OperationEnabled, 0x0F), // 4
    (DriveState::QuickStop, DriveState::OperationEnabled, 0x0F), // 16
    (DriveState::OperationEnabled, DriveState::QuickStop, 0x02), // 11
    (DriveState::Fault, DriveState::SwitchOnDisabled, 0x80), // 15
    (DriveState::Ready, DriveState::OperationEnabled, 0x0F), // 3 and 4 at once
];

#[test]
fn every_transition_of_the_profile_is_there() {
    for (from, to, word) in TRANSITIONS {
        assert_eq!(drive_in(from).step(&told(word)), to, "{from:?} with {word:#04x}");
    }
    let still = DriveInputs { still: true, ..told(0x00) };
    assert_eq!(drive_in(DriveState::FaultReaction).step(&still), DriveState::Fault); // 14
    for state in STATES {
        let mut drive = drive_in(state);
        let after = drive.step(&DriveInputs { fault: Some(DriveFault::OverTemperature), ..told(0x0F) }); // 13
        assert!(matches!(after, DriveState::FaultReaction | DriveState::Fault), "{state:?}");
    }
}

/// What the table does not name leaves the state alone, or takes a shorter way to no torque.
#[test]
fn no_controlword_leads_anywhere_else() {
    for from in STATES {
        for word in 0..=0xFF {
            let to = drive_in(from).step(&told(word));
            let named = TRANSITIONS.iter().any(|t| t.0 == from && t.1 == to);
            let off = matches!(from, DriveState::Ready | DriveState::SwitchedOn)
                && to == DriveState::SwitchOnDisabled;
            assert!(to == from || named || off, "{from:?} with {word:#04x} went to {to:?}");
        }
    }
}

/// Masks and values of canopen's `SW_MASK`.
#[test]
fn statuswords_are_those_of_the_profile() {
    let masks: [(DriveState, u16, u16); 8] = [
        (DriveState::NotReady, 0x4F, 0x00),
        (DriveState::SwitchOnDisabled, 0x4F, 0x40),
        (DriveState::Ready, 0x6F, 0x21),
        (DriveState::SwitchedOn, 0x6F, 0x23),
        (DriveState::OperationEnabled, 0x6F, 0x27),
        (DriveState::Fault, 0x4F, 0x08),
        (DriveState::FaultReaction, 0x4F, 0x0F),
        (DriveState::QuickStop, 0x6F, 0x07),
    ];
    for (state, mask, value) in masks {
        assert_eq!(status_of(state) & mask, value);
    }
    for status in 0..=u16::MAX {
        let named: Vec<DriveState> = masks.iter().filter(|m| status & m.1 == m.2).map(|m| m.0).collect();
        assert_eq!(state_of(status), named.first().copied(), "{status:#06x}");
        assert!(named.len() < 2);
    }
}

#[test]
fn the_master_leads_every_drive_to_operation_but_out_of_no_fault() {
    for from in STATES {
        let mut drive = drive_in(from);
        let mut cycles = 0;
        while drive.state() != DriveState::OperationEnabled && cycles < 10 {
            let still =
                DriveInputs { still: true, ..told(controlword(drive.statusword(), Wanted::Operation)) };
            drive.step(&still);
            cycles += 1;
        }
        let broken = matches!(from, DriveState::Fault | DriveState::FaultReaction);
        assert_eq!(drive.state() == DriveState::OperationEnabled, !broken, "{from:?}");
        assert!(broken || cycles <= 3, "{from:?}: {cycles} cycles");
        if broken {
            drive.step(&told(controlword(drive.statusword(), Wanted::Reset)));
            assert_eq!((drive.state(), drive.error()), (DriveState::SwitchOnDisabled, None));
        }
    }
}

#[test]
fn quick_stop_brakes_holds_and_is_left_only_when_told() {
    let mut drive = drive_in(DriveState::QuickStop);
    for _ in 0..1000 {
        drive.step(&DriveInputs { still: true, ..told(controlword(drive.statusword(), Wanted::Stop)) });
    }
    assert!(drive.state() == DriveState::QuickStop && drive.drives() && drive.ramps());
    drive.step(&DriveInputs { control: None, ..told(0) });
    assert_eq!(drive.state(), DriveState::QuickStop, "silence is no command");
}

/// A drive that does not know its angle stays where the brake holds it, whatever the master says.
#[test]
fn without_a_reference_nothing_is_enabled() {
    let mut drive = DriveStateMachine::default();
    for _ in 0..10 {
        let word = controlword(drive.statusword(), Wanted::Operation);
        drive.step(&DriveInputs { permit: false, ..told(word) });
    }
    assert!(drive.state() == DriveState::SwitchedOn && !drive.drives());
    drive.step(&told(ENABLE_OPERATION));
    assert_eq!(drive.state(), DriveState::OperationEnabled);
    drive.step(&DriveInputs { permit: false, ..told(ENABLE_OPERATION) });
    assert_eq!(drive.state(), DriveState::SwitchedOn, "a reference that is lost disables");
}

#[test]
fn a_fault_of_the_power_stage_lets_go_at_once() {
    let fault = |fault| DriveInputs { fault: Some(fault), ..told(ENABLE_OPERATION) };
    assert_eq!(
        drive_in(DriveState::OperationEnabled).step(&fault(DriveFault::OverCurrent)),
        DriveState::Fault
    );
    let mut drive = drive_in(DriveState::OperationEnabled);
    assert_eq!(drive.step(&fault(DriveFault::OverTemperature)), DriveState::FaultReaction);
    assert_eq!(drive.error(), Some(DriveFault::OverTemperature));
    assert_eq!(DriveFault::from_code(DriveFault::OverTemperature as u16), Some(DriveFault::OverTemperature));
}

/// Whatever bit of a controlword is bent: either it is none that is sent, or it gives no torque that was not told, takes
/// none from a drive that is to follow, and resets no fault.
#[test]
fn one_bent_bit_of_a_controlword_does_no_harm() {
    for from in STATES {
        for wanted in [Wanted::Ready, Wanted::Operation, Wanted::Stop, Wanted::Reset] {
            let drive = drive_in(from);
            let word = controlword(drive.statusword(), wanted);
            assert!(WORDS.contains(&word));
            let after = |word: u16| {
                let mut drive = drive;
                drive.step(&told(word));
                drive
            };
            for bent in (0..16).map(|bit| word ^ 1 << bit).filter(|bent| WORDS.contains(bent)) {
                let (well, ill) = (after(word), after(bent));
                let torque = drive.drives() || well.drives();
                assert!(torque || !ill.drives(), "{from:?}: {word:#04x} bent to {bent:#04x} drives");
                let follows = wanted == Wanted::Operation;
                assert!(!follows || ill.drives() == well.drives(), "{from:?}: {bent:#04x} lets go");
                let resets = ill.state() != DriveState::Fault && well.state() == DriveState::Fault;
                assert!(!resets, "{from:?}: {bent:#04x} resets");
            }
        }
    }
}

fn any_inputs() -> impl Strategy<Value = DriveInputs> {
    let word = prop_oneof![
        4 => prop::sample::select(vec![0x00u16, 0x02, 0x06, 0x07, 0x0F, 0x80, 0x8F, 0x86]),
        1 => any::<u16>(),
    ];
    let fault =
        prop_oneof![9 => Just(None), 1 => prop::sample::select(DriveFault::ALL.to_vec()).prop_map(Some)];
    (prop::option::of(word), any::<bool>(), prop::bool::weighted(0.9), fault, any::<bool>()).prop_map(
        |(control, supply, permit, fault, still)| DriveInputs { control, supply, permit, fault, still },
    )
}

proptest! {
    /// From a fault to torque only over the rising edge of a fault reset, and never in one cycle.
    #[test]
    fn no_way_from_fault_to_torque_without_the_edge(way in prop::collection::vec(any_inputs(), 1..200)) {
        let (mut drive, mut word, mut broken) = (DriveStateMachine::default(), 0u16, false);
        for inputs in &way {
            let before = drive.state();
            drive.step(inputs);
            let now = inputs.control.unwrap_or(word & !0x80);
            let edge = now & !word & 0x80 != 0;
            word = now;
            broken |= drive.state() == DriveState::Fault;
            if before == DriveState::Fault && drive.state() != DriveState::Fault {
                prop_assert!(edge && inputs.fault.is_none() && drive.state() == DriveState::SwitchOnDisabled);
                broken = false;
            }
            prop_assert!(!(broken && drive.drives()));
            prop_assert_eq!(drive.error().is_some(), matches!(drive.state(), DriveState::Fault | DriveState::FaultReaction));
        }
    }

    /// Without supply, or without reference in Operation enabled, no torque in the same cycle.
    #[test]
    fn no_torque_without_supply(way in prop::collection::vec(any_inputs(), 1..200)) {
        let mut drive = DriveStateMachine::default();
        for inputs in &way {
            drive.step(inputs);
            prop_assert!(inputs.supply || !drive.drives());
            prop_assert!(inputs.permit || drive.state() != DriveState::OperationEnabled);
        }
    }
}
