//! Head of a telegram: Ethernet header, then type, phase and checksum.
//!
//! | bytes | field |
//! |---|---|
//! | 0..6 | destination, always broadcast |
//! | 6..12 | source: the master; slaves leave it as it is |
//! | 12..14 | EtherType 0x88CD |
//! | 14 | type: bit 7 channel (0 P, 1 S), bit 6 kind (0 MDT, 1 AT), bit 5 cycle counter valid, bits 3-0 number 0..3 |
//! | 15 | phase: bit 7 switch in progress, bits 6-4 cycle counter, bits 3-0 phase 0..4 |
//! | 16..20 | CRC-32 of the bytes 0..16, little endian |

use crate::crc::crc32;

/// EtherType of Sercos III.
pub(crate) const ETHERTYPE: u16 = 0x88CD;
/// Ethernet header and Sercos header \[B\].
pub const HEADER: usize = 20;
/// Longest data field behind the headers \[B\].
pub const MAX_DATA: usize = 1494;
/// Shortest data field: Ethernet pads to it \[B\].
pub const MIN_DATA: usize = 40;
/// Longest telegram without the frame check sequence \[B\].
pub(crate) const MAX_FRAME: usize = HEADER + MAX_DATA;
/// Telegrams of one kind in a cycle, at most.
pub(crate) const TELEGRAMS: usize = 4;
/// The cycle counter counts modulo this.
pub const CYCLES: u8 = 8;

/// Hardware address of an Ethernet port.
pub type Mac = [u8; 6];

const EVERYBODY: Mac = [0xFF; 6];

/// The two directions around the ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RingChannel {
    /// Primary: sent by the master's first port.
    P,
    /// Secondary: sent by the master's second port.
    S,
}

/// Writer of the data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TelegramKind {
    /// Master data telegram.
    Mdt,
    /// Acknowledge telegram: sent empty by the master, filled by the slaves it passes.
    At,
}

/// Communication phase.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum CommunicationPhase {
    /// Stations in their order.
    Cp0,
    /// Service channels and device control for everybody.
    Cp1,
    /// Parameters of communication.
    Cp2,
    /// Parameters of the application; telegrams as configured.
    Cp3,
    /// Operation.
    Cp4,
}

impl CommunicationPhase {
    /// All phases in their order.
    pub const ALL: [Self; 5] = [Self::Cp0, Self::Cp1, Self::Cp2, Self::Cp3, Self::Cp4];

    /// The phase after this one.
    pub fn next(self) -> Option<Self> {
        Self::ALL.get(self as usize + 1).copied()
    }
}

/// Head of a telegram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TelegramHeader {
    /// Hardware address of the master's port.
    pub source: Mac,
    /// Direction.
    pub channel: RingChannel,
    /// Kind.
    pub kind: TelegramKind,
    /// @range 0..3 Number among those of its kind.
    pub number: u8,
    /// Phase; while switching, the one to come.
    pub phase: CommunicationPhase,
    /// A switch of the phase is in progress.
    pub switching: bool,
    /// @range 0..7 Cycle counter, if the master counts.
    pub cycle: Option<u8>,
}

/// Reason why a frame is no telegram.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Malformed {
    /// Another EtherType: not ours, and no error of the bus.
    Foreign,
    /// Shorter than its headers, or longer than Ethernet allows \[B\].
    Length(usize),
    /// The checksum does not fit.
    Checksum,
    /// Not sent to everybody.
    Destination,
    /// No such communication phase.
    Phase(u8),
    /// No such telegram number.
    Number(u8),
}

impl TelegramHeader {
    /// Reads the head of a frame.
    ///
    /// # Errors
    /// Says in what way the frame is no telegram. Never panics.
    pub fn read(frame: &[u8]) -> Result<Self, Malformed> {
        // From the outside in: Ethernet, length, checksum, then fields, so that the error names the first thing wrong.
        if frame.len() < 14 || u16::from_be_bytes([frame[12], frame[13]]) != ETHERTYPE {
            return Err(Malformed::Foreign);
        }
        if frame.len() < HEADER || frame.len() > MAX_FRAME {
            return Err(Malformed::Length(frame.len()));
        }
        if crc32(&frame[..16]).to_le_bytes() != frame[16..HEADER] {
            return Err(Malformed::Checksum);
        }
        if frame[..6] != EVERYBODY {
            return Err(Malformed::Destination);
        }
        let (kind, phase) = (frame[14], frame[15]);
        let number = kind & 0x0F;
        if usize::from(number) >= TELEGRAMS {
            return Err(Malformed::Number(number));
        }
        let known = CommunicationPhase::ALL.get(usize::from(phase & 0x0F));
        let mut source = [0; 6];
        source.copy_from_slice(&frame[6..12]);
        // Type byte: channel, telegram, cycle valid, number; phase byte: switching, cycle, phase.
        Ok(Self {
            source,
            channel: if kind & 0x80 == 0 { RingChannel::P } else { RingChannel::S },
            kind: if kind & 0x40 == 0 { TelegramKind::Mdt } else { TelegramKind::At },
            number,
            phase: *known.ok_or(Malformed::Phase(phase & 0x0F))?,
            switching: phase & 0x80 != 0,
            cycle: (kind & 0x20 != 0).then_some(phase >> 4 & 7),
        })
    }

    /// Writes the head of `frame`, which has room for it, with the checksum.
    pub fn write(&self, frame: &mut [u8]) {
        frame[..6].copy_from_slice(&EVERYBODY);
        frame[6..12].copy_from_slice(&self.source);
        frame[12..14].copy_from_slice(&ETHERTYPE.to_be_bytes());
        frame[14] = u8::from(self.channel == RingChannel::S) << 7
            | u8::from(self.kind == TelegramKind::At) << 6
            | u8::from(self.cycle.is_some()) << 5
            | self.number & 0x0F;
        frame[15] = u8::from(self.switching) << 7 | (self.cycle.unwrap_or(0) & 7) << 4 | self.phase as u8;
        let crc = crc32(&frame[..16]);
        frame[16..HEADER].copy_from_slice(&crc.to_le_bytes());
    }

    /// Whether this is the head of MDT0, the master's beat: the MST.
    pub(crate) fn is_beat(&self) -> bool {
        self.kind == TelegramKind::Mdt && self.number == 0
    }
}
