//! The parameters of a slave: what the master reads and writes through the service channel.

use crate::header::{CommunicationPhase, TELEGRAMS, TelegramKind};
use crate::idn::{self, Attribute, Idn, ValueShape, code};
use crate::layout::{CONNECTION, DEVICE, DataPlace, SERVICE};
use crate::telegram::{set_word, word};

/// Longest value on the wire \[B\]: a list of four words behind its two lengths.
pub(crate) const VALUE: usize = 12;

/// A value as it is on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WireValue {
    bytes: [u8; VALUE],
    len: usize,
}

impl WireValue {
    /// Two bytes.
    pub fn word(value: u16) -> Self {
        let mut bytes = [0; VALUE];
        set_word(&mut bytes, 0, value);
        Self { bytes, len: 2 }
    }

    /// Four bytes.
    pub fn long(value: u32) -> Self {
        let mut bytes = [0; VALUE];
        bytes[..4].copy_from_slice(&value.to_le_bytes());
        Self { bytes, len: 4 }
    }

    /// A list of four words.
    pub fn words(values: [u16; TELEGRAMS]) -> Self {
        let mut bytes = [0; VALUE];
        set_word(&mut bytes, 0, 8);
        set_word(&mut bytes, 2, 8);
        for (i, value) in values.into_iter().enumerate() {
            set_word(&mut bytes, 4 + 2 * i, value);
        }
        Self { bytes, len: VALUE }
    }

    /// Data received; none if longer than any value.
    pub fn received(bytes: &[u8]) -> Option<Self> {
        let mut value = Self { bytes: [0; VALUE], len: bytes.len() };
        value.bytes.get_mut(..bytes.len())?.copy_from_slice(bytes);
        Some(value)
    }

    /// The bytes on the wire.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes[..self.len]
    }

    /// The first four bytes as a number.
    pub fn number(&self) -> u32 {
        u32::from_le_bytes([self.bytes[0], self.bytes[1], self.bytes[2], self.bytes[3]])
    }

    /// Word `i` of a list.
    pub fn item(&self, i: usize) -> u16 {
        word(&self.bytes, 4 + 2 * i)
    }

    /// Its shape, by its length.
    pub fn shape(&self) -> ValueShape {
        match self.len {
            2 => ValueShape::Word,
            4 => ValueShape::Long,
            _ => ValueShape::Words,
        }
    }
}

/// Acknowledgement of a procedure command: set, enabled and finished.
pub(crate) const COMMAND_DONE: u16 = 3;
/// Acknowledgement of a procedure command that failed.
pub(crate) const COMMAND_FAILED: u16 = 0xF;

struct SlaveParameter {
    idn: Idn,
    attribute: Attribute,
    value: WireValue,
    /// Acknowledgement, of a procedure command.
    state: u16,
    /// The procedure command succeeded; cancelling it does not change that.
    passed: bool,
    fixed: bool,
}

/// All parameters of a slave.
pub(crate) struct SlaveParameters {
    all: Vec<SlaveParameter>,
    command: usize,
    feedback: usize,
}

impl SlaveParameters {
    /// Parameters of a slave with this address that takes `command` and gives `feedback` bytes in a cycle.
    pub(crate) fn new(address: u16, command: usize, feedback: usize) -> Self {
        let mut all = Vec::new();
        let mut add = |idn, value: WireValue, fixed: bool| {
            let writable = !fixed;
            let attribute = Attribute::new(value.shape(), false, writable, false, false);
            all.push(SlaveParameter { idn, attribute, value, state: 0, passed: false, fixed });
        };
        // Timing and places in the telegrams, written by the master in CP2; the address is the slave's own.
        add(idn::ADDRESS, WireValue::word(address), true);
        add(idn::CYCLE_TIME, WireValue::long(0), false);
        add(idn::AT_TIME, WireValue::long(0), false);
        add(idn::BEAT_LOSSES, WireValue::word(0), false);
        for offset in
            [idn::CONTROL_OFFSET, idn::STATUS_OFFSET, idn::MDT_SERVICE_OFFSET, idn::AT_SERVICE_OFFSET]
        {
            add(offset, WireValue::word(0), false);
        }
        add(idn::MDT_LENGTHS, WireValue::words([0; TELEGRAMS]), false);
        add(idn::AT_LENGTHS, WireValue::words([0; TELEGRAMS]), false);
        // One connection in each direction.
        for (instance, setup, len) in
            [(idn::COMMAND, idn::CONSUMER, command), (idn::FEEDBACK, idn::PRODUCER, feedback)]
        {
            let element = |element| idn::connection(instance, element);
            add(element(idn::SETUP), WireValue::word(setup), true);
            add(element(idn::LENGTH), WireValue::word((len + CONNECTION) as u16), true);
            add(element(idn::NUMBER), WireValue::word(0), false);
            add(element(idn::ASSIGNMENT), WireValue::word(0), false);
            add(element(idn::PRODUCER_TIME), WireValue::long(0), false);
            add(element(idn::LOSSES), WireValue::word(0), false);
        }
        // Procedure commands by which the master asks whether the next phase may begin.
        for idn in [idn::CHECK_CP3, idn::CHECK_CP4] {
            let (cp2, cp3) = (idn == idn::CHECK_CP3, idn == idn::CHECK_CP4);
            let attribute = Attribute::new(ValueShape::Word, true, cp2, cp3, false);
            all.push(SlaveParameter {
                idn,
                attribute,
                value: WireValue::word(0),
                state: 0,
                passed: false,
                fixed: false,
            });
        }
        Self { all, command, feedback }
    }

    /// Everything as after switching on.
    pub(crate) fn reset(&mut self) {
        for p in self.all.iter_mut().filter(|p| !p.fixed) {
            p.value = match p.value.shape() {
                ValueShape::Word => WireValue::word(0),
                ValueShape::Long => WireValue::long(0),
                ValueShape::Words => WireValue::words([0; TELEGRAMS]),
            };
            (p.state, p.passed) = (0, false);
        }
    }

    /// Place of a parameter in the table.
    pub(crate) fn find(&self, idn: Idn) -> Option<usize> {
        self.all.iter().position(|p| p.idn == idn)
    }

    /// Attribute of parameter `i`.
    pub(crate) fn attribute(&self, i: usize) -> Attribute {
        self.all[i].attribute
    }

    /// Value of parameter `i`.
    pub(crate) fn value(&self, i: usize) -> WireValue {
        self.all[i].value
    }

    /// Acknowledgement of parameter `i` as a procedure command.
    pub(crate) fn state(&self, i: usize) -> u16 {
        self.all[i].state
    }

    /// Writes parameter `i` in this phase; a procedure command is executed at once.
    ///
    /// # Errors
    /// The code for the service channel; nothing is written.
    pub(crate) fn write(&mut self, i: usize, bytes: &[u8], phase: CommunicationPhase) -> Result<(), u16> {
        let p = &self.all[i];
        if p.fixed {
            return Err(code::READ_ONLY);
        }
        if p.attribute.protected_in(phase) {
            return Err(code::PROTECTED);
        }
        if bytes.len() < p.value.bytes().len() {
            return Err(code::TOO_SHORT);
        }
        let value = WireValue::received(bytes).filter(|v| v.bytes().len() == p.value.bytes().len());
        let value = value.ok_or(code::TOO_LONG)?;
        if value.shape() == ValueShape::Words && word(value.bytes(), 0) != 8 {
            return Err(code::INVALID);
        }
        self.all[i].value = value;
        if self.all[i].attribute.is_command() {
            self.execute(i);
        }
        Ok(())
    }

    /// Sets or cancels a procedure command.
    fn execute(&mut self, i: usize) {
        self.all[i].state = match self.all[i].value.number() & 3 {
            3 if self.is_ready() => COMMAND_DONE,
            3 => COMMAND_FAILED,
            _ => 0,
        };
        if self.all[i].state != 0 {
            self.all[i].passed = self.all[i].state == COMMAND_DONE;
        }
    }

    fn get(&self, idn: Idn) -> WireValue {
        self.find(idn).map_or(WireValue::word(0), |i| self.all[i].value)
    }

    fn place(&self, idn: Idn) -> (TelegramKind, DataPlace) {
        DataPlace::read(self.get(idn).number() as u16)
    }

    /// Whether the master's parameters can be worked with: a permitted cycle time, and every field within its telegram.
    pub(crate) fn is_ready(&self) -> bool {
        let fits = |idn, kind: Option<TelegramKind>, lengths: Idn, len| {
            let (found, place) = self.place(idn);
            let room = usize::from(self.get(lengths).item(place.telegram));
            kind.is_none_or(|kind| kind == found) && place.offset + len <= room
        };
        let assignment = |instance| idn::connection(instance, idn::ASSIGNMENT);
        let (mdt, at) = (idn::MDT_LENGTHS, idn::AT_LENGTHS);
        is_cycle_time(self.get(idn::CYCLE_TIME).number())
            && fits(idn::CONTROL_OFFSET, None, mdt, DEVICE)
            && fits(idn::MDT_SERVICE_OFFSET, None, mdt, SERVICE)
            && fits(idn::STATUS_OFFSET, None, at, DEVICE)
            && fits(idn::AT_SERVICE_OFFSET, None, at, SERVICE)
            && fits(assignment(idn::COMMAND), Some(TelegramKind::Mdt), mdt, CONNECTION + self.command)
            && fits(assignment(idn::FEEDBACK), Some(TelegramKind::At), at, CONNECTION + self.feedback)
    }

    /// The places that the master has given.
    pub(crate) fn places(&self) -> crate::layout::StationPlaces {
        let place = |idn| self.place(idn).1;
        crate::layout::StationPlaces {
            mdt_service: place(idn::MDT_SERVICE_OFFSET),
            at_service: place(idn::AT_SERVICE_OFFSET),
            control: place(idn::CONTROL_OFFSET),
            status: place(idn::STATUS_OFFSET),
            command: place(idn::connection(idn::COMMAND, idn::ASSIGNMENT)),
            feedback: place(idn::connection(idn::FEEDBACK, idn::ASSIGNMENT)),
        }
    }

    /// Whether this procedure command was executed without error.
    pub(crate) fn passed(&self, command: Idn) -> bool {
        self.find(command).is_some_and(|i| self.all[i].passed)
    }

    /// Beats in a row that may be missed.
    pub(crate) fn beat_losses(&self) -> u32 {
        self.get(idn::BEAT_LOSSES).number()
    }

    /// Losses in a row that the connection with the data for the slave permits.
    pub(crate) fn command_losses(&self) -> u32 {
        self.get(idn::connection(idn::COMMAND, idn::LOSSES)).number()
    }
}

/// Whether this is a cycle time of Sercos III \[ns\]: 31.25, 62.5, 125 µs, or a multiple of 250 µs up to 65 ms.
pub(crate) fn is_cycle_time(ns: u32) -> bool {
    [31_250, 62_500, 125_000].contains(&ns)
        || (250_000..=65_000_000).contains(&ns) && ns.is_multiple_of(250_000)
}
