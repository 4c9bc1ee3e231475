//! Identification numbers of parameters, their attributes, and the codes of errors in the service channel.

use std::fmt;

/// Identification number: structure instance, structure element, and number of a standard parameter.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Idn(pub u32);

impl Idn {
    /// S-0-`number`.`instance`.`element`.
    pub const fn standard(number: u16, instance: u8, element: u8) -> Self {
        Self((instance as u32) << 24 | (element as u32) << 16 | (number as u32 & 0xFFF))
    }
}

impl fmt::Display for Idn {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let kind = if self.0 & 0x8000 == 0 { 'S' } else { 'P' };
        let (set, number) = (self.0 >> 12 & 7, self.0 & 0xFFF);
        write!(f, "{kind}-{set}-{number:04}.{}.{}", self.0 >> 24, self.0 >> 16 & 0xFF)
    }
}

impl fmt::Debug for Idn {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// Check before CP3 (procedure command).
pub(crate) const CHECK_CP3: Idn = Idn::standard(127, 0, 0);
/// Check before CP4 (procedure command).
pub(crate) const CHECK_CP4: Idn = Idn::standard(128, 0, 0);
/// Cycle time tScyc \[ns\].
pub const CYCLE_TIME: Idn = Idn::standard(1002, 0, 0);
/// Beats in a row that a slave may miss in CP3 and CP4 \[1\].
pub(crate) const BEAT_LOSSES: Idn = Idn::standard(1003, 0, 0);
/// Time of AT0 in the cycle, t1 \[ns\].
pub(crate) const AT_TIME: Idn = Idn::standard(1006, 0, 0);
/// Place of C-DEV.
pub(crate) const CONTROL_OFFSET: Idn = Idn::standard(1009, 0, 0);
/// Lengths of the MDTs \[B\].
pub(crate) const MDT_LENGTHS: Idn = Idn::standard(1010, 0, 0);
/// Place of S-DEV.
pub(crate) const STATUS_OFFSET: Idn = Idn::standard(1011, 0, 0);
/// Lengths of the ATs \[B\].
pub(crate) const AT_LENGTHS: Idn = Idn::standard(1012, 0, 0);
/// Offset of the service channel in the MDT.
pub(crate) const MDT_SERVICE_OFFSET: Idn = Idn::standard(1013, 0, 0);
/// Offset of the service channel in the AT.
pub(crate) const AT_SERVICE_OFFSET: Idn = Idn::standard(1014, 0, 0);
/// Sercos address \[1\].
pub const ADDRESS: Idn = Idn::standard(1040, 0, 0);

/// The connection with the data for the slave.
pub const COMMAND: u8 = 0;
/// The connection with the data of the slave.
pub(crate) const FEEDBACK: u8 = 1;

/// An element of a connection, S-0-1050.
pub const fn connection(instance: u8, element: u8) -> Idn {
    Idn::standard(1050, instance, element)
}

/// Element 1 of a connection: what it is.
pub(crate) const SETUP: u8 = 1;
/// Element 2 of a connection: its number.
pub(crate) const NUMBER: u8 = 2;
/// Element 3 of a connection: telegram and offset.
pub(crate) const ASSIGNMENT: u8 = 3;
/// Element 5 of a connection: its length with C-CON \[B\].
pub const LENGTH: u8 = 5;
/// Element 10 of a connection: cycle time of its producer \[ns\].
pub(crate) const PRODUCER_TIME: u8 = 10;
/// Element 11 of a connection: losses in a row that its consumer permits \[1\].
pub const LOSSES: u8 = 11;

/// Set-up of a connection that the slave consumes: active, container, synchronous with the cycle.
pub(crate) const CONSUMER: u16 = 0x8010;
/// Set-up of a connection that the slave produces.
pub(crate) const PRODUCER: u16 = 0xC010;

/// Element of a parameter in the service channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Element {
    /// Nothing: the channel is closed.
    Close,
    /// The identification number; read: state of a procedure command.
    Idn,
    /// Storage.
    Attribute,
    /// The value.
    Data,
}

impl Element {
    /// Its number in the control word.
    pub(crate) const fn number(self) -> u16 {
        match self {
            Self::Close => 0,
            Self::Idn => 1,
            Self::Attribute => 3,
            Self::Data => 7,
        }
    }
}

/// Shape of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueShape {
    /// Two bytes.
    Word,
    /// Four bytes.
    Long,
    /// Actual length, greatest length (two bytes each, \[B\]), then words.
    Words,
}

/// Attribute of a parameter: length in bits 18-16, procedure command in bit 19, write protection in bits 28 to 30.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attribute(pub u32);

impl Attribute {
    /// Attribute of a parameter that can be written in the phases that `cp2`, `cp3`, `cp4` say.
    pub const fn new(shape: ValueShape, command: bool, cp2: bool, cp3: bool, cp4: bool) -> Self {
        let length = match shape {
            ValueShape::Word => 1,
            ValueShape::Long => 2,
            ValueShape::Words => 5,
        };
        let protected = (!cp2 as u32) << 28 | (!cp3 as u32) << 29 | (!cp4 as u32) << 30;
        Self(1 | length << 16 | (command as u32) << 19 | protected)
    }

    /// Shape of the value, if it is one that is known here.
    pub fn shape(self) -> Option<ValueShape> {
        match self.0 >> 16 & 7 {
            1 => Some(ValueShape::Word),
            2 => Some(ValueShape::Long),
            5 => Some(ValueShape::Words),
            _ => None,
        }
    }

    /// Whether it is a procedure command.
    pub(crate) fn is_command(self) -> bool {
        self.0 & 1 << 19 != 0
    }

    /// Whether it must not be written in CP`phase`.
    pub fn protected_in(self, phase: crate::CommunicationPhase) -> bool {
        match phase {
            crate::CommunicationPhase::Cp0 | crate::CommunicationPhase::Cp1 => true,
            phase => self.0 >> (26 + phase as u32) & 1 != 0,
        }
    }
}

/// Codes of errors in the service channel.
pub mod code {
    /// The channel is not open.
    pub(crate) const NOT_OPEN: u16 = 0x0001;
    /// There is no such parameter.
    pub(crate) const NO_IDN: u16 = 0x1001;
    /// The attribute is only read.
    pub(crate) const ATTRIBUTE_FIXED: u16 = 0x3004;
    /// Fewer data than the parameter has.
    pub(crate) const TOO_SHORT: u16 = 0x7002;
    /// More data than the parameter has.
    pub(crate) const TOO_LONG: u16 = 0x7003;
    /// The value is only read.
    pub(crate) const READ_ONLY: u16 = 0x7004;
    /// The value is not written in this phase.
    pub(crate) const PROTECTED: u16 = 0x7005;
    /// The value makes no sense.
    pub(crate) const INVALID: u16 = 0x7008;
}
