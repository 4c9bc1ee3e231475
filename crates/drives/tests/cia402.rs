//! The states of a drive against the tables of the profile, and what must hold on every way through them.

use drives::cia402::{
    DriveInputs, DriveStateMachine, ENABLE_OPERATION, Fault, State, WORDS, Wanted, controlword, state_of,
    status_of,
};
use proptest::prelude::*;

const STATES: [State; 8] = [
    State::NotReady,
    State::SwitchOnDisabled,
    State::Ready,
    State::SwitchedOn,
    State::OperationEnabled,
    State::QuickStop,
    State::FaultReaction,
    State::Fault,
];

/// A cycle with supply, reference and this controlword.
fn told(control: u16) -> DriveInputs {
    DriveInputs { control: Some(control), supply: true, permit: true, fault: None, still: false }
}

/// A drive in a state, by the profile's own way.
fn drive_in(state: State) -> DriveStateMachine {
    let mut drive = DriveStateMachine::default();
    let words: &[u16] = match state {
        State::NotReady => &[],
        State::SwitchOnDisabled => &[0x00],
        State::Ready => &[0x00, 0x06],
        State::SwitchedOn => &[0x00, 0x06, 0x07],
        State::QuickStop => &[0x00, 0x06, 0x0F, 0x02],
        State::OperationEnabled | State::FaultReaction | State::Fault => &[0x00, 0x06, 0x0F],
    };
    for &word in words {
        drive.step(&told(word));
    }
    if matches!(state, State::FaultReaction | State::Fault) {
        drive.step(&DriveInputs { fault: Some(Fault::FollowingError), ..told(0x0F) });
    }
    if state == State::Fault {
        drive.step(&DriveInputs { still: true, ..told(0x0F) });
    }
    assert_eq!(drive.state(), state);
    drive
}

/// The table of the profile as the Python package canopen 2 has it (`canopen.profiles.p402.State402.TRANSITIONTABLE`):
/// from, to, controlword.
const TRANSITIONS: [(State, State, u16); 15] = [
    (State::Ready, State::SwitchOnDisabled, 0x00),            // 7
    (State::OperationEnabled, State::SwitchOnDisabled, 0x00), // 9
    (State::SwitchedOn, State::SwitchOnDisabled, 0x00),       // 10
    (State::QuickStop, State::SwitchOnDisabled, 0x00),        // 12
    (State::NotReady, State::SwitchOnDisabled, 0x00),         // 1
    (State::SwitchOnDisabled, State::Ready, 0x06),            // 2
    (State::SwitchedOn, State::Ready, 0x06),                  // 6
    (State::OperationEnabled, State::Ready, 0x06),            // 8
    (State::Ready, State::SwitchedOn, 0x07),                  // 3
    (State::OperationEnabled, State::SwitchedOn, 0x07),       // 5
    (State::SwitchedOn, State::OperationEnabled, 0x0F),       // 4
    (State::QuickStop, State::OperationEnabled, 0x0F),        // 16
    (State::OperationEnabled, State::QuickStop, 0x02),        // 11
    (State::Fault, State::SwitchOnDisabled, 0x80),            // 15
    (State::Ready, State::OperationEnabled, 0x0F),            // 3 and 4 at once
];

#[test]
fn every_transition_of_the_profile_is_there() {
    for (from, to, word) in TRANSITIONS {
        assert_eq!(drive_in(from).step(&told(word)), to, "{from:?} with {word:#04x}");
    }
    let still = DriveInputs { still: true, ..told(0x00) };
    assert_eq!(drive_in(State::FaultReaction).step(&still), State::Fault); // 14
    for state in STATES {
        let mut drive = drive_in(state);
        let after = drive.step(&DriveInputs { fault: Some(Fault::OverTemperature), ..told(0x0F) }); // 13
        assert!(matches!(after, State::FaultReaction | State::Fault), "{state:?}");
    }
}

/// What the table does not name leaves the state alone, or takes a shorter way to no torque.
#[test]
fn no_controlword_leads_anywhere_else() {
    for from in STATES {
        for word in 0..=0xFF {
            let to = drive_in(from).step(&told(word));
            let named = TRANSITIONS.iter().any(|t| t.0 == from && t.1 == to);
            let off = matches!(from, State::Ready | State::SwitchedOn) && to == State::SwitchOnDisabled;
            assert!(to == from || named || off, "{from:?} with {word:#04x} went to {to:?}");
        }
    }
}

/// Masks and values of canopen's `SW_MASK`.
#[test]
fn statuswords_are_those_of_the_profile() {
    let masks: [(State, u16, u16); 8] = [
        (State::NotReady, 0x4F, 0x00),
        (State::SwitchOnDisabled, 0x4F, 0x40),
        (State::Ready, 0x6F, 0x21),
        (State::SwitchedOn, 0x6F, 0x23),
        (State::OperationEnabled, 0x6F, 0x27),
        (State::Fault, 0x4F, 0x08),
        (State::FaultReaction, 0x4F, 0x0F),
        (State::QuickStop, 0x6F, 0x07),
    ];
    for (state, mask, value) in masks {
        assert_eq!(status_of(state) & mask, value);
    }
    for status in 0..=u16::MAX {
        let named: Vec<State> = masks.iter().filter(|m| status & m.1 == m.2).map(|m| m.0).collect();
        assert_eq!(state_of(status), named.first().copied(), "{status:#06x}");
        assert!(named.len() < 2);
    }
}

#[test]
fn the_master_leads_every_drive_to_operation_but_out_of_no_fault() {
    for from in STATES {
        let mut drive = drive_in(from);
        let mut cycles = 0;
        while drive.state() != State::OperationEnabled && cycles < 10 {
            let still =
                DriveInputs { still: true, ..told(controlword(drive.statusword(), Wanted::Operation)) };
            drive.step(&still);
            cycles += 1;
        }
        let broken = matches!(from, State::Fault | State::FaultReaction);
        assert_eq!(drive.state() == State::OperationEnabled, !broken, "{from:?}");
        assert!(broken || cycles <= 3, "{from:?}: {cycles} cycles");
        if broken {
            drive.step(&told(controlword(drive.statusword(), Wanted::Reset)));
            assert_eq!((drive.state(), drive.error()), (State::SwitchOnDisabled, None));
        }
    }
}

#[test]
fn quick_stop_brakes_holds_and_is_left_only_when_told() {
    let mut drive = drive_in(State::QuickStop);
    for _ in 0..1000 {
        drive.step(&DriveInputs { still: true, ..told(controlword(drive.statusword(), Wanted::Stop)) });
    }
    assert!(drive.state() == State::QuickStop && drive.drives() && drive.ramps());
    drive.step(&DriveInputs { control: None, ..told(0) });
    assert_eq!(drive.state(), State::QuickStop, "silence is no command");
}

/// A drive that does not know its angle stays where the brake holds it, whatever the master says.
#[test]
fn without_a_reference_nothing_is_enabled() {
    let mut drive = DriveStateMachine::default();
    for _ in 0..10 {
        let word = controlword(drive.statusword(), Wanted::Operation);
        drive.step(&DriveInputs { permit: false, ..told(word) });
    }
    assert!(drive.state() == State::SwitchedOn && !drive.drives());
    drive.step(&told(ENABLE_OPERATION));
    assert_eq!(drive.state(), State::OperationEnabled);
    drive.step(&DriveInputs { permit: false, ..told(ENABLE_OPERATION) });
    assert_eq!(drive.state(), State::SwitchedOn, "a reference that is lost disables");
}

#[test]
fn a_fault_of_the_power_stage_lets_go_at_once() {
    let fault = |fault| DriveInputs { fault: Some(fault), ..told(ENABLE_OPERATION) };
    assert_eq!(drive_in(State::OperationEnabled).step(&fault(Fault::OverCurrent)), State::Fault);
    let mut drive = drive_in(State::OperationEnabled);
    assert_eq!(drive.step(&fault(Fault::OverTemperature)), State::FaultReaction);
    assert_eq!(drive.error(), Some(Fault::OverTemperature));
    assert_eq!(Fault::from_code(Fault::OverTemperature as u16), Some(Fault::OverTemperature));
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
                let resets = ill.state() != State::Fault && well.state() == State::Fault;
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
    let fault = prop_oneof![9 => Just(None), 1 => prop::sample::select(Fault::ALL.to_vec()).prop_map(Some)];
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
            broken |= drive.state() == State::Fault;
            if before == State::Fault && drive.state() != State::Fault {
                prop_assert!(edge && inputs.fault.is_none() && drive.state() == State::SwitchOnDisabled);
                broken = false;
            }
            prop_assert!(!(broken && drive.drives()));
            prop_assert_eq!(drive.error().is_some(), matches!(drive.state(), State::Fault | State::FaultReaction));
        }
    }

    /// Without supply, or without reference in Operation enabled, no torque in the same cycle.
    #[test]
    fn no_torque_without_supply(way in prop::collection::vec(any_inputs(), 1..200)) {
        let mut drive = DriveStateMachine::default();
        for inputs in &way {
            drive.step(inputs);
            prop_assert!(inputs.supply || !drive.drives());
            prop_assert!(inputs.permit || drive.state() != State::OperationEnabled);
        }
    }
}
