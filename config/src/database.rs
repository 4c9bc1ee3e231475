//! Any DBC file, to look at traffic with: which signals a frame carries, in numbers, units and words.
//!
//! Layouts of our robots, which move joints, are read by [`crate::dbc`] and refuse most of what is allowed here: both byte
//! orders, up to 64 bits, floating point, multiplexed signals (also extended ones), identifiers of 29 bits.

use std::collections::HashMap;
use std::path::Path;

use can_dbc::{
    AttributeValue, ByteOrder, Dbc, MessageId, MultiplexIndicator, SignalExtendedValueType, ValueDescription,
    ValueType,
};

use crate::error::ConfigError;

/// Messages by identifier.
#[derive(Clone, Debug, Default)]
pub struct Database {
    messages: HashMap<u32, Described>,
}

/// A message.
#[derive(Clone, Debug)]
pub struct Described {
    /// Its name.
    pub name: String,
    /// \[B\] Its length.
    pub len: u64,
    /// Comment in the file (`CM_`); may be empty.
    pub comment: String,
    /// \[s\] Time from one to the next (`GenMsgCycleTime`).
    pub cycle: Option<f64>,
    fields: Vec<Field>,
}

/// Value of one signal in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carried<'a> {
    /// Name of the signal.
    pub name: &'a str,
    /// Its value in [`Carried::unit`].
    pub value: f64,
    /// The same as an integer, where it is one without scale and offset: more digits than a floating point number has.
    pub exact: Option<i128>,
    /// Its unit as the file writes it; empty if there is none.
    pub unit: &'a str,
    /// The word for this value, if the file has one (`VAL_`).
    pub word: Option<&'a str>,
}

/// A signal.
#[derive(Clone, Debug)]
struct Field {
    name: String,
    unit: String,
    /// Places of its bits, the most significant first: 8 x byte + bit.
    bits: Vec<usize>,
    number: SignalFormat,
    factor: f64,
    offset: f64,
    words: Vec<(i64, String)>,
    /// Index of the signal that switches it, and the values with which it is there.
    switch: Option<(usize, Vec<(u64, u64)>)>,
}

/// Number format of a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
enum SignalFormat {
    Unsigned,
    Signed,
    Single,
    Double,
}

impl Database {
    /// Reads a DBC file, in UTF-8 or, as most tools write them, Latin-1.
    ///
    /// # Errors
    /// It cannot be read, or is no DBC file; where.
    pub fn load(path: &Path) -> Result<Self, ConfigError> {
        let wrong = |text: String| ConfigError::of_file(path, text);
        let bytes = std::fs::read(path).map_err(|e| wrong(format!("cannot be read: {e}")))?;
        let text = String::from_utf8(bytes)
            .unwrap_or_else(|e| e.as_bytes().iter().map(|byte| char::from(*byte)).collect());
        Self::read(&text).map_err(wrong)
    }

    /// Reads the text of a DBC file.
    ///
    /// # Errors
    /// It is none; where.
    pub fn read(text: &str) -> Result<Self, String> {
        let dbc = Dbc::try_from(text).map_err(|e| format!("this is not a DBC file: {e}"))?;
        let known = Details::of(&dbc);
        // Signals without a message stand in one of this name.
        let there = dbc.messages.iter().filter(|m| m.name != "VECTOR__INDEPENDENT_SIG_MSG");
        let messages = there.map(|m| {
            let fields = m.signals.iter().filter_map(|s| known.field(m, s)).collect();
            let comment = dbc.message_comment(m.id).unwrap_or_default().to_owned();
            let cycle = match dbc.resolved_message_attribute(m.id, "GenMsgCycleTime") {
                Some(AttributeValue::Double(ms)) => Some(ms * 1e-3),
                Some(AttributeValue::Uint(ms)) => Some(*ms as f64 * 1e-3),
                _ => None,
            };
            let cycle = cycle.filter(|cycle| *cycle > 0.0);
            (m.id.raw(), Described { name: m.name.clone(), len: m.size, comment, cycle, fields })
        });
        Ok(Self { messages: messages.collect() })
    }

    /// The message of an identifier; bit 31 is set for one of 29 bits, as in SocketCAN's `can_id`.
    pub fn message(&self, id: u32) -> Option<&Described> {
        self.messages.get(&id)
    }
}

impl Described {
    /// The signals of a frame with this payload: those that lie within it, and of multiplexed ones those that are there.
    pub fn carries<'a>(&'a self, data: &'a [u8]) -> impl Iterator<Item = Carried<'a>> {
        self.fields
            .iter()
            .filter(|field| self.is_there(field, data, 0))
            .filter_map(|field| field.carried(data))
    }

    /// Whether the signals that switch a field let it be there.
    fn is_there(&self, field: &Field, data: &[u8], depth: usize) -> bool {
        let Some((by, values)) = &field.switch else { return true };
        let switch = &self.fields[*by];
        // A circle of switches in a bent file ends, too.
        depth < self.fields.len()
            && self.is_there(switch, data, depth + 1)
            && switch
                .raw(data)
                .is_some_and(|raw| values.iter().any(|(low, high)| (*low..=*high).contains(&raw)))
    }
}

impl Field {
    /// The bits as a number; none if the payload ends before them.
    fn raw(&self, data: &[u8]) -> Option<u64> {
        self.bits.iter().try_fold(0, |raw: u64, &bit| {
            let byte = data.get(bit / 8)?;
            Some(raw << 1 | u64::from(byte >> (bit % 8) & 1))
        })
    }

    fn carried(&self, data: &[u8]) -> Option<Carried<'_>> {
        let raw = self.raw(data)?;
        let unused = 64 - self.bits.len() as u32;
        let whole = match self.number {
            SignalFormat::Signed => i128::from((raw << unused) as i64 >> unused),
            _ => i128::from(raw),
        };
        let (number, is_whole) = match self.number {
            SignalFormat::Single => (f64::from(f32::from_bits(raw as u32)), false),
            SignalFormat::Double => (f64::from_bits(raw), false),
            SignalFormat::Unsigned | SignalFormat::Signed => (whole as f64, true),
        };
        let plain = is_whole && self.factor == 1.0 && self.offset == 0.0;
        let word = self.words.iter().find(|(value, _)| is_whole && i128::from(*value) == whole);
        Some(Carried {
            name: &self.name,
            value: number * self.factor + self.offset,
            exact: plain.then_some(whole),
            unit: &self.unit,
            word: word.map(|(_, word)| word.as_str()),
        })
    }
}

/// Name of the signal that switches another one, and the ranges of its values with which that one is there.
type Switch<'a> = (&'a str, Vec<(u64, u64)>);

/// Attributes of the signals from further down in the file, by message and signal.
struct Details<'a> {
    words: HashMap<(MessageId, &'a str), Vec<(i64, String)>>,
    floats: HashMap<(MessageId, &'a str), SignalExtendedValueType>,
    switches: HashMap<(MessageId, &'a str), Switch<'a>>,
}

impl<'a> Details<'a> {
    fn of(dbc: &'a Dbc) -> Self {
        let words = dbc.value_descriptions.iter().filter_map(|described| match described {
            ValueDescription::Signal { message_id, name, value_descriptions } => {
                let words = value_descriptions.iter().map(|v| (v.id, v.description.clone())).collect();
                Some(((*message_id, name.as_str()), words))
            }
            ValueDescription::EnvironmentVariable { .. } => None,
        });
        let floats = dbc.signal_extended_value_type_list.iter();
        let floats = floats.map(|s| ((s.message_id, s.signal_name.as_str()), s.signal_extended_value_type));
        let switches = dbc.extended_multiplex.iter().map(|s| {
            let values = s.mappings.iter().map(|m| (m.min_value, m.max_value)).collect();
            ((s.message_id, s.signal_name.as_str()), (s.multiplexor_signal_name.as_str(), values))
        });
        Self { words: words.collect(), floats: floats.collect(), switches: switches.collect() }
    }

    /// A signal; none if it has no bits, or more than a number.
    fn field(&self, m: &can_dbc::Message, s: &'a can_dbc::Signal) -> Option<Field> {
        let key = (m.id, s.name.as_str());
        let number = match (self.floats.get(&key), s.size, s.value_type) {
            (Some(SignalExtendedValueType::IEEEfloat32Bit), 32, _) => SignalFormat::Single,
            (Some(SignalExtendedValueType::IEEEdouble64bit), 64, _) => SignalFormat::Double,
            (_, 1..=64, ValueType::Signed) => SignalFormat::Signed,
            (_, 1..=64, ValueType::Unsigned) => SignalFormat::Unsigned,
            _ => return None,
        };
        let index = |name: &str| m.signals.iter().position(|other| other.name == name);
        let first =
            || m.signals.iter().position(|s| s.multiplexer_indicator == MultiplexIndicator::Multiplexor);
        let switch = match (self.switches.get(&key), s.multiplexer_indicator) {
            (Some((by, values)), _) => index(by).map(|by| (by, values.clone())),
            (None, MultiplexIndicator::MultiplexedSignal(value))
            | (None, MultiplexIndicator::MultiplexorAndMultiplexedSignal(value)) => {
                first().map(|by| (by, vec![(value, value)]))
            }
            _ => None,
        };
        Some(Field {
            name: s.name.clone(),
            unit: s.unit.clone(),
            bits: places(s),
            number,
            factor: s.factor,
            offset: s.offset,
            words: self.words.get(&key).cloned().unwrap_or_default(),
            switch,
        })
    }
}

/// Places of the bits of a signal, the most significant first.
fn places(s: &can_dbc::Signal) -> Vec<usize> {
    let start = s.start_bit as usize;
    match s.byte_order {
        ByteOrder::LittleEndian => (start..start.saturating_add(s.size as usize)).rev().collect(),
        // Downwards within a byte, then from the top of the next one.
        ByteOrder::BigEndian => {
            let next = |bit: &usize| Some(if bit.is_multiple_of(8) { bit + 15 } else { bit - 1 });
            std::iter::successors(Some(start), next).take(s.size as usize).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"VERSION "1"

NS_ :

BS_:

BU_: A B

BO_ 100 Mixed: 8 A
 SG_ switch M : 0|4@1+ (1,0) [0|15] "" B
 SG_ intel m0 : 8|12@1- (0.5,10) [0|0] "°C" B
 SG_ motorola m1 : 15|12@0+ (1,0) [0|0] "rpm" B
 SG_ deep m2 : 8|8@1+ (1,0) [0|0] "" B

BO_ 2147484672 Wide: 16 B
 SG_ single : 0|32@1- (2,0) [0|0] "" A
 SG_ all : 64|64@1- (1,0) [0|0] "" A

VAL_ 100 switch 0 "low" 1 "high" ;
SIG_VALTYPE_ 2147484672 single : 1;
SG_MUL_VAL_ 100 deep switch 2-3, 7-7;
"#;

    fn carried<'a>(message: &'a Described, data: &'a [u8]) -> Vec<(&'a str, f64, Option<&'a str>)> {
        message.carries(data).map(|c| (c.name, c.value, c.word)).collect()
    }

    #[test]
    fn byte_orders_signs_words_and_switches() {
        let database = Database::read(TEXT).unwrap();
        let mixed = database.message(100).unwrap();
        assert_eq!((mixed.name.as_str(), mixed.len), ("Mixed", 8));
        let low = [0x10, 0xff, 0xff, 0, 0, 0, 0, 0];
        assert_eq!(carried(mixed, &low), [("switch", 0.0, Some("low")), ("intel", 9.5, None)]);
        assert_eq!(mixed.carries(&low).nth(1).unwrap().unit, "°C");
        let high = [0x01, 0xab, 0xc0, 0, 0, 0, 0, 0];
        assert_eq!(
            carried(mixed, &high),
            [("switch", 1.0, Some("high")), ("motorola", f64::from(0xabc), None)]
        );
        for (value, is_there) in [(2, true), (3, true), (4, false), (7, true)] {
            assert_eq!(carried(mixed, &[value, 5]).len() == 2, is_there, "{value}");
        }
        assert_eq!(
            carried(mixed, &[0]),
            [("switch", 0.0, Some("low"))],
            "what lies behind the end is not there"
        );
        assert!(database.message(101).is_none());
    }

    #[test]
    fn long_identifiers_floating_point_and_all_digits_of_64_bits() {
        let database = Database::read(TEXT).unwrap();
        assert!(database.message(1024).is_none(), "that identifier has 29 bits");
        let wide = database.message(0x8000_0400).unwrap();
        let mut data = [0xff; 16];
        data[..4].copy_from_slice(&1.25f32.to_le_bytes());
        data[8..].copy_from_slice(&(i64::MAX - 1).to_le_bytes());
        let found: Vec<_> = wide.carries(&data).map(|c| (c.value, c.exact)).collect();
        assert_eq!(found[0], (2.5, None));
        assert_eq!(found[1].1, Some(i128::from(i64::MAX - 1)));
    }

    #[test]
    fn what_is_no_dbc_file_says_so() {
        assert!(Database::read("date today").unwrap_err().contains("not a DBC file"));
        let said = Database::load(Path::new("/nowhere/x.dbc")).unwrap_err().to_string();
        assert!(said.contains("/nowhere/x.dbc: cannot be read"), "{said}");
    }
}
