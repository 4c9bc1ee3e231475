//! States of a drive as in CiA 402 (IEC 61800-7-201), from both sides of the bus. Pure: one call per bus cycle.
//!
//! ```text
//!  Not ready ─1─► Switch on disabled ─2─► Ready ─3─► Switched on ─4─► Operation enabled ─11─► Quick stop
//!      ▲ 0               ▲▲▲  ▲ ◄──7──────  ▲ ◄──6───────  ▲ ◄────5────────  │  ◄────────16────────  │
//!    start               │││  └15── Fault   └──────────────┼───────8─────────┤                       │
//!                        ││└─────────────────10────────────┘                 │                       │
//!                        │└──────────────────────────────────────9───────────┘                       │
//!                        └─────────────────────────────────────────────────────────────────12────────┘
//!  every state ─13─► Fault reaction ─14─► Fault
//! ```
//!
//! | bit of the controlword | name | bit of the statusword | name |
//! |---|---|---|---|
//! | 0 | switch on | 0 | ready to switch on |
//! | 1 | enable voltage | 1, 2 | switched on, operation enabled |
//! | 2 | quick stop (0: stop) | 3 | fault |
//! | 3 | enable operation | 4 | voltage at the power stage |
//! | 7 | fault reset (edge) | 5 | quick stop (0: stops) |
//! | | | 6 | switch on disabled |
//! | | | 7 | warning |
//! | | | 15 | angle known: the drive has its reference (maker's own bit) |
//!
//! Where the standard leaves a choice, it is made as a biped needs it. *Enable operation* in state Ready does transitions
//! 3 and 4 at once. Quick stop brakes on the ramp and then holds (option code 6): a leg that lets go is a fall. A supply
//! that goes off is no fault but transitions 9, 10 and 12: who took it away says why. Switching on takes a supply and, for
//! transition 4 and for staying there, what the drive itself demands ([`DriveInputs::permit`]): a reference for its angle.
//! A bus that falls silent under torque is a fault (abort connection option code 0x6007 = 1); a drive without torque waits.

/// States of a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DriveState {
    /// The drive starts.
    NotReady,
    /// No voltage may be switched on.
    SwitchOnDisabled,
    /// Voltage may be switched on.
    Ready,
    /// Power stage ready, no torque.
    SwitchedOn,
    /// Targets are followed.
    OperationEnabled,
    /// Brakes on the ramp, then holds.
    QuickStop,
    /// Brakes on the ramp because of a fault.
    FaultReaction,
    /// No torque. Only the edge of a fault reset leads out.
    Fault,
}

/// Controlword: shutdown, transitions 2, 6, 8.
pub const SHUTDOWN: u16 = 0x06;
/// Controlword: switch on, and disable operation: transitions 3, 5.
pub(crate) const SWITCH_ON: u16 = 0x07;
/// Controlword: enable operation, transitions 3 and 4, 16.
pub const ENABLE_OPERATION: u16 = 0x0F;
/// Controlword: disable voltage, transitions 7, 9, 10, 12.
pub const DISABLE_VOLTAGE: u16 = 0x00;
/// Controlword: quick stop, transition 11; elsewhere 7, 10.
pub(crate) const QUICK_STOP: u16 = 0x02;
/// Bit of the controlword whose rising edge resets a fault, transition 15.
const RESET: u16 = 1 << 7;
/// Controlword: fault reset. Its other bits mean nothing there, and keep it three bits away from [`DISABLE_VOLTAGE`].
pub const FAULT_RESET: u16 = RESET | SHUTDOWN;

/// The controlwords that [`controlword`] gives: whatever else a drive is sent is a bent one.
pub const WORDS: [u16; 5] = [DISABLE_VOLTAGE, QUICK_STOP, SHUTDOWN, ENABLE_OPERATION, FAULT_RESET];

/// Bit of the statusword: voltage at the power stage.
pub const VOLTAGE: u16 = 1 << 4;
/// Bit of the statusword: warning.
pub const WARNING: u16 = 1 << 7;
/// Bit of the statusword: the drive knows its angle.
pub const REFERENCED: u16 = 1 << 15;

/// Why a drive has a fault: error codes of CiA 301 and 402.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u16)]
pub enum DriveFault {
    /// Current above what the power stage allows.
    OverCurrent = 0x2310,
    /// Winding too hot.
    OverTemperature = 0x4310,
    /// Heartbeat of the master missing (CiA 301: life guard or heartbeat).
    Heartbeat = 0x8130,
    /// The joint does not follow.
    FollowingError = 0x8611,
    /// A table of points was at its end before the motion was: the queue is empty (0xFF00: of the maker, 0x34 his number).
    QueueEmpty = 0xFF34,
}

impl DriveFault {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::OverCurrent, Self::OverTemperature, Self::Heartbeat, Self::FollowingError, Self::QueueEmpty];

    /// The fault of an error code.
    pub fn from_code(code: u16) -> Option<Self> {
        Self::ALL.into_iter().find(|fault| *fault as u16 == code)
    }

    /// True if the power stage may still brake on the ramp; otherwise it lets go at once.
    pub const fn ramps(self) -> bool {
        !matches!(self, Self::OverCurrent)
    }

    /// In words.
    pub const fn text(self) -> &'static str {
        match self {
            Self::OverCurrent => "over-current",
            Self::OverTemperature => "winding too hot",
            Self::Heartbeat => "no frames on the bus",
            Self::FollowingError => "following error",
            Self::QueueEmpty => "table ended in motion",
        }
    }
}

/// Inputs of one cycle of a drive.
#[derive(Clone, Copy, Debug, Default)]
pub struct DriveInputs {
    /// The controlword, if one came in this cycle; otherwise the last one holds, without an edge.
    pub control: Option<u16>,
    /// Voltage of the motor supply.
    pub supply: bool,
    /// True if the drive may go to Operation enabled: its angle is known, or it is to find it out.
    pub permit: bool,
    /// Fault in this cycle.
    pub fault: Option<DriveFault>,
    /// The joint has come to rest.
    pub still: bool,
}

/// The drive's side.
#[derive(Clone, Copy, Debug)]
pub struct DriveStateMachine {
    state: DriveState,
    control: u16,
    error: Option<DriveFault>,
    supply: bool,
}

impl Default for DriveStateMachine {
    fn default() -> Self {
        Self { state: DriveState::NotReady, control: 0, error: None, supply: false }
    }
}

impl DriveStateMachine {
    /// The state.
    pub fn state(&self) -> DriveState {
        self.state
    }

    /// The last fault, until it is reset.
    pub fn error(&self) -> Option<DriveFault> {
        self.error
    }

    /// True if the power stage drives the motor; otherwise it has no torque, and a brake holds it if there is one.
    pub fn drives(&self) -> bool {
        matches!(self.state, DriveState::OperationEnabled | DriveState::QuickStop | DriveState::FaultReaction)
    }

    /// True if the joint brakes on the ramp instead of following its targets.
    pub fn ramps(&self) -> bool {
        matches!(self.state, DriveState::QuickStop | DriveState::FaultReaction)
    }

    /// One cycle.
    pub fn step(&mut self, inputs: &DriveInputs) -> DriveState {
        let before = self.control;
        self.control = inputs.control.unwrap_or(self.control & !RESET);
        self.supply = inputs.supply;
        let reset = self.control & !before & RESET != 0;
        let brakes = inputs.supply && inputs.fault.is_none_or(DriveFault::ramps);
        self.state = match (self.state, inputs.fault) {
            (DriveState::FaultReaction, _) if inputs.still || !brakes => DriveState::Fault, // 14
            (DriveState::FaultReaction, _) => DriveState::FaultReaction,
            (DriveState::Fault, None) if reset => {
                self.error = None;
                DriveState::SwitchOnDisabled // 15
            }
            (DriveState::Fault, _) => DriveState::Fault,
            (_, Some(fault)) => {
                self.error = Some(fault);
                // 13, and 14 at once if nothing can brake, or nothing moves.
                if self.drives() && brakes { DriveState::FaultReaction } else { DriveState::Fault }
            }
            (DriveState::NotReady, None) => DriveState::SwitchOnDisabled, // 0, 1: the self-test is passed
            (state, None) => self.command(state, inputs),
        };
        self.state
    }

    /// The transition table without faults.
    fn command(&self, state: DriveState, inputs: &DriveInputs) -> DriveState {
        use DriveState::{OperationEnabled, QuickStop, Ready, SwitchOnDisabled, SwitchedOn};
        let word = self.control & 0x0F;
        let is = |wanted: u16, mask: u16| word & mask == wanted;
        let (shutdown, switch_on) = (is(SHUTDOWN, 0x07), is(SWITCH_ON, 0x0F));
        let enable = is(ENABLE_OPERATION, 0x0F);
        let (disable, quick) = (is(DISABLE_VOLTAGE, 0x02), is(QUICK_STOP, 0x06));
        let on = inputs.supply;
        match state {
            SwitchOnDisabled if shutdown => Ready,                              // 2
            Ready if disable || quick => SwitchOnDisabled,                      // 7
            Ready if enable && on && inputs.permit => OperationEnabled,         // 3, 4
            Ready if (switch_on || enable) && on => SwitchedOn,                 // 3
            SwitchedOn if disable || quick || !on => SwitchOnDisabled,          // 10
            SwitchedOn if shutdown => Ready,                                    // 6
            SwitchedOn if enable && inputs.permit => OperationEnabled,          // 4
            OperationEnabled | QuickStop if disable || !on => SwitchOnDisabled, // 9, 12
            OperationEnabled | QuickStop if !inputs.permit => SwitchedOn,       // 5, by itself
            OperationEnabled if quick => QuickStop,                             // 11
            OperationEnabled if shutdown => Ready,                              // 8
            OperationEnabled if switch_on => SwitchedOn,                        // 5
            QuickStop if enable && inputs.permit => OperationEnabled,           // 16
            same => same,
        }
    }

    /// The statusword of the state, with voltage; [`WARNING`] and [`REFERENCED`] are the caller's to add.
    pub fn statusword(&self) -> u16 {
        status_of(self.state) | if self.supply { VOLTAGE } else { 0 }
    }
}

/// Bits 0 to 3, 5 and 6 of a state's statusword; bit 5 is free in the upper four and 0 there.
pub const fn status_of(state: DriveState) -> u16 {
    match state {
        DriveState::NotReady => 0x00,
        DriveState::SwitchOnDisabled => 0x40,
        DriveState::Ready => 0x21,
        DriveState::SwitchedOn => 0x23,
        DriveState::OperationEnabled => 0x27,
        DriveState::QuickStop => 0x07,
        DriveState::FaultReaction => 0x0F,
        DriveState::Fault => 0x08,
    }
}

/// The state of a statusword; none if its bits name no state.
pub const fn state_of(status: u16) -> Option<DriveState> {
    match (status & 0x4F, status & 0x6F) {
        (0x00, _) => Some(DriveState::NotReady),
        (0x40, _) => Some(DriveState::SwitchOnDisabled),
        (0x0F, _) => Some(DriveState::FaultReaction),
        (0x08, _) => Some(DriveState::Fault),
        (_, 0x21) => Some(DriveState::Ready),
        (_, 0x23) => Some(DriveState::SwitchedOn),
        (_, 0x27) => Some(DriveState::OperationEnabled),
        (_, 0x07) => Some(DriveState::QuickStop),
        _ => None,
    }
}

/// Demand of the master on a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// No torque, ready to be switched on.
    Ready,
    /// Targets are followed.
    Operation,
    /// Brake and hold.
    Stop,
    /// A fault is forgotten; no torque, as with [`Wanted::Ready`].
    Reset,
}

/// The master's side: the controlword that leads a drive with this statusword one step towards what is wanted.
///
/// A drive with a fault gets none but [`DISABLE_VOLTAGE`] until [`Wanted::Reset`] asks for more; it lets bit 7 fall, so
/// that the reset is an edge.
pub fn controlword(status: u16, wanted: Wanted) -> u16 {
    match (state_of(status), wanted) {
        (Some(DriveState::Fault), Wanted::Reset) => FAULT_RESET,
        (Some(DriveState::Fault | DriveState::FaultReaction), _) => DISABLE_VOLTAGE,
        (_, Wanted::Ready | Wanted::Reset) => SHUTDOWN,
        (Some(DriveState::OperationEnabled | DriveState::QuickStop), Wanted::Stop) => QUICK_STOP,
        (_, Wanted::Stop) => SHUTDOWN,
        (Some(DriveState::Ready | DriveState::SwitchedOn | DriveState::OperationEnabled), _) => {
            ENABLE_OPERATION
        }
        (Some(DriveState::QuickStop), _) => ENABLE_OPERATION,
        (_, Wanted::Operation) => SHUTDOWN,
    }
}
