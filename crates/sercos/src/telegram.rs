//! A telegram, and where its fields are while nothing is configured: CP0, CP1 and CP2.

use crate::header::{CommunicationPhase, HEADER, MAX_FRAME, TelegramHeader, TelegramKind};

/// One telegram with its headers.
#[derive(Clone, Copy)]
pub(crate) struct Telegram {
    bytes: [u8; MAX_FRAME],
    len: usize,
}

impl Telegram {
    /// Begins a telegram with `len` bytes of zeros behind its headers; `len` at most [`crate::header::MAX_DATA`].
    pub(crate) fn begin(&mut self, header: &TelegramHeader, len: usize) {
        self.len = HEADER + len;
        self.bytes[HEADER..HEADER + len].fill(0);
        header.write(&mut self.bytes);
    }

    /// An empty place for a telegram.
    pub(crate) const EMPTY: Self = Self { bytes: [0; MAX_FRAME], len: 0 };

    /// Copies a received frame; frames longer than a telegram are cut.
    pub(crate) fn copy_from(&mut self, frame: &[u8]) {
        self.len = frame.len().min(MAX_FRAME);
        self.bytes[..self.len].copy_from_slice(&frame[..self.len]);
    }

    /// All bytes, as on the wire.
    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes[..self.len]
    }

    /// All bytes, as on the wire.
    pub(crate) fn bytes_mut(&mut self) -> &mut [u8] {
        &mut self.bytes[..self.len]
    }

    /// Payload behind the headers.
    pub(crate) fn data(&self) -> &[u8] {
        &self.bytes[HEADER.min(self.len)..self.len]
    }

    /// Payload behind the headers.
    pub(crate) fn data_mut(&mut self) -> &mut [u8] {
        let len = self.len;
        &mut self.bytes[HEADER.min(len)..len]
    }
}

/// Length of the data of a telegram before anything is configured \[B\].
pub(crate) fn early_len(kind: TelegramKind, phase: CommunicationPhase) -> usize {
    match (kind, phase) {
        (TelegramKind::Mdt, CommunicationPhase::Cp0) => cp0::MDT,
        (TelegramKind::At, CommunicationPhase::Cp0) => cp0::AT,
        _ => cp12::LEN,
    }
}

/// Sixteen bits at `at`, little endian; 0 beyond the end.
pub fn word(data: &[u8], at: usize) -> u16 {
    data.get(at..at + 2).map_or(0, |b| u16::from_le_bytes([b[0], b[1]]))
}

/// Writes sixteen bits at `at`; nothing beyond the end.
pub(crate) fn set_word(data: &mut [u8], at: usize, value: u16) {
    if let Some(place) = data.get_mut(at..at + 2) {
        place.copy_from_slice(&value.to_le_bytes());
    }
}

/// Thirty-two bits at `at`, little endian; 0 beyond the end.
pub fn long(data: &[u8], at: usize) -> u32 {
    u32::from(word(data, at)) | u32::from(word(data, at + 2)) << 16
}

/// Writes thirty-two bits at `at`; nothing beyond the end.
pub(crate) fn set_long(data: &mut [u8], at: usize, value: u32) {
    set_word(data, at, value as u16);
    set_word(data, at + 2, (value >> 16) as u16);
}

/// CP0: the slaves write their addresses in the order in which the telegram passes them.
pub mod cp0 {
    use super::{set_word, word};

    /// Length of MDT0: the communication version and reserve \[B\].
    pub const MDT: usize = 40;
    /// Length of AT0: sequence counter and 511 addresses \[B\].
    pub const AT: usize = 1024;
    /// Most slaves with two telegrams of each kind in CP1 and CP2: 256 places, of which the first is the master's.
    pub(crate) const SLAVES: usize = 255;
    /// Communication version: addresses are given (bit 0), two telegrams of each kind (bits 17-16), fast switch (bit 21).
    pub const VERSION: u32 = 1 | 1 << 21;

    /// Empties AT0 for the slaves.
    pub fn clear(at: &mut [u8]) {
        at.fill(0xFF);
        set_word(at, 0, 1);
    }

    /// Writes a slave's address at the next place and counts it; the place is its topology address, from 1.
    pub fn enter(at: &mut [u8], address: u16) -> Option<u16> {
        let place = word(at, 0) & 0x1FF;
        if place == 0 || usize::from(place) > SLAVES || at.len() < AT {
            return None;
        }
        set_word(at, 2 * usize::from(place), address);
        set_word(at, 0, place + 1);
        Some(place)
    }

    /// The addresses that were written, in their order.
    pub fn addresses(at: &[u8]) -> impl Iterator<Item = u16> + '_ {
        let count = usize::from(word(at, 0) & 0x1FF).saturating_sub(1).min(SLAVES);
        (1..=count).map(|place| word(at, 2 * place))
    }
}

/// CP1 and CP2: every telegram serves 128 slaves, telegram n those with the topology addresses from 128 n.
pub mod cp12 {
    /// Slaves of one telegram.
    pub(crate) const GROUP: usize = 128;
    /// Length of a service channel \[B\].
    pub const SERVICE: usize = 6;
    /// Length of device control or status with its reserve \[B\].
    pub const DEVICE: usize = 4;
    /// Length of every telegram \[B\].
    pub const LEN: usize = GROUP * (SERVICE + DEVICE);

    /// Telegram of a slave with this topology address, and where in its data its service channel is.
    pub fn service(topology: u16) -> (usize, usize) {
        (usize::from(topology) / GROUP, usize::from(topology) % GROUP * SERVICE)
    }

    /// Telegram of a slave with this topology address, and where in its data its control or status is.
    pub fn device(topology: u16) -> (usize, usize) {
        (usize::from(topology) / GROUP, GROUP * SERVICE + usize::from(topology) % GROUP * DEVICE)
    }
}
