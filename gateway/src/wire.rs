//! Datagrams as bytes (`docs/vision.md`): a head of 32 bytes, and then numbers, all little endian.
//!
//! | bytes | head |
//! |---|---|
//! | 0..4 | `GWVI` |
//! | 4..6 | version, u16 |
//! | 6..8 | kind, u16 |
//! | 8..16 | sender, u64 |
//! | 16..24 | sequence, u64 |
//! | 24..32 | stamp \[ns\], u64: of a trigger its own, otherwise that of the trigger that is answered |
//!
//! There is no checksum of our own: those of UDP and Ethernet find what the network bends, and what a faulty program writes
//! would pass any; length, version and ranges catch that.

use messages::Command;
use messages::command_text::CommandInfo;

use crate::Cause;
use crate::trigger::{self, NUMBERS, Trigger};

/// Version of this layout.
pub const VERSION: u16 = 1;
/// Bytes of the head.
pub const HEAD: usize = 32;
const MAGIC: [u8; 4] = *b"GWVI";
/// Commands that a vision system may give, by kind from 1 on; kind 0 is the trigger. Their numbers are the fields of the
/// table of commands.
pub const KINDS: [&str; 4] = ["walk/velocity", "head/fixate", "vision/box", "vision/gone"];
/// Bytes of a trigger.
pub const TRIGGER: usize = HEAD + 24 + 8 * NUMBERS + 8 * (1 + Cause::ALL.len());

/// Datagram of a vision system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Datagram {
    /// Number that the sender has given itself.
    pub sender: u64,
    /// Number of the datagram.
    pub sequence: u64,
    /// \[ns\] Stamp of the trigger that it answers.
    pub stamp: u64,
    /// Its command, in the ranges of any use.
    pub command: Command,
}

/// Splits the little-endian number off at the beginning.
fn take<const N: usize>(bytes: &mut &[u8]) -> Option<[u8; N]> {
    let (first, rest) = bytes.split_first_chunk()?;
    *bytes = rest;
    Some(*first)
}

impl Datagram {
    /// The datagram of these bytes.
    ///
    /// # Errors
    /// The first that is wrong: length, version, a number that is none, a number out of its range.
    pub fn decode(mut bytes: &[u8]) -> Result<Self, Cause> {
        let all = &mut bytes;
        let mut word = || take(all).map(u64::from_le_bytes).ok_or(Cause::Malformed);
        let [magic, versions, sender, sequence, stamp] = {
            let first = word()?;
            [first & 0xffff_ffff, first >> 32, word()?, word()?, word()?]
        };
        if magic != u64::from(u32::from_le_bytes(MAGIC)) {
            return Err(Cause::Malformed);
        }
        let (version, kind) = (versions as u16, (versions >> 16) as usize);
        if version != VERSION {
            return Err(Cause::Version);
        }
        // Behind the head: as many numbers as the kind has, each of them finite and in its range.
        let name = kind.checked_sub(1).and_then(|k| KINDS.get(k)).ok_or(Cause::Malformed)?;
        let info = CommandInfo::find(name).ok_or(Cause::Malformed)?;
        if bytes.len() != 8 * info.fields.len() {
            return Err(Cause::Malformed);
        }
        let (numbers, _) = bytes.as_chunks();
        let values: Vec<f64> = numbers.iter().map(|n| f64::from_le_bytes(*n)).collect();
        if values.iter().any(|x| !x.is_finite()) {
            return Err(Cause::NotFinite);
        }
        let command = info.command(&values).map_err(|_| Cause::Range)?;
        Ok(Self { sender, sequence, stamp, command })
    }

    /// Its bytes; none if a vision system may not give this command.
    pub fn encode(&self) -> Option<Vec<u8>> {
        let info = self.command.info();
        let kind = 1 + KINDS.iter().position(|name| *name == info.name)?;
        let mut bytes = head(kind as u16, self.sender, self.sequence, self.stamp);
        (0..info.fields.len()).for_each(|i| bytes.extend(self.command.value(i).to_le_bytes()));
        Some(bytes)
    }
}

impl Trigger {
    /// The trigger of these bytes: the other end's part.
    ///
    /// # Errors
    /// It is none of this version.
    pub fn decode(mut bytes: &[u8]) -> Result<Self, Cause> {
        if bytes.len() != TRIGGER || bytes[..4] != MAGIC || bytes[6..8] != [0; 2] {
            return Err(Cause::Malformed);
        }
        if bytes[4..6] != VERSION.to_le_bytes() {
            return Err(Cause::Version);
        }
        bytes = &bytes[8..];
        let mut word = || take(&mut bytes).map_or(0, u64::from_le_bytes);
        let [sender, sequence, stamp, cycle, flags, gait] = std::array::from_fn(|_| word());
        let (odometry, frames) = trigger::parts(&std::array::from_fn(|_| f64::from_bits(word())));
        let accepted = word();
        let refused = std::array::from_fn(|_| word());
        Ok(Self { sender, sequence, stamp, cycle, flags, gait, odometry, frames, accepted, refused })
    }

    /// Its bytes.
    pub fn encode(&self) -> Vec<u8> {
        let mut bytes = head(0, self.sender, self.sequence, self.stamp);
        [self.cycle, self.flags, self.gait].iter().for_each(|n| bytes.extend(n.to_le_bytes()));
        self.numbers().iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend(self.accepted.to_le_bytes());
        self.refused.iter().for_each(|n| bytes.extend(n.to_le_bytes()));
        bytes
    }
}

fn head(kind: u16, sender: u64, sequence: u64, stamp: u64) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(kind.to_le_bytes());
    [sender, sequence, stamp].iter().for_each(|n| bytes.extend(n.to_le_bytes()));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::command::{BoxCommand, FixateCommand, GoneCommand, VelocityCommand};
    use proptest::prelude::*;

    fn all() -> [Datagram; 4] {
        let commands = [
            Command::Velocity(VelocityCommand { forward: 0.3, left: -0.1, turn: 0.2 }),
            Command::Fixate(FixateCommand { point: [3.0, 0.5, 1.2] }),
            Command::Box(BoxCommand {
                id: 7,
                base: [1.5, 0.25, 0.0],
                yaw: 0.3,
                size: [0.06, 1.2, 0.1],
                lifetime: 2.0,
            }),
            Command::Gone(GoneCommand { id: 7 }),
        ];
        commands.map(|command| Datagram { sender: 9, sequence: 4, stamp: 1_000_000_007, command })
    }

    /// Bytes as the page says, put together by hand.
    #[test]
    fn a_velocity_is_the_pages_bytes() {
        let velocity = Datagram {
            sender: 258,
            sequence: 3,
            stamp: 1,
            command: Command::Velocity(VelocityCommand { forward: 0.5, left: -2.0_f64.recip(), turn: 0.0 }),
        };
        #[rustfmt::skip]
        let bytes = [
            b'G', b'W', b'V', b'I', 1, 0, 1, 0,
            2, 1, 0, 0, 0, 0, 0, 0,
            3, 0, 0, 0, 0, 0, 0, 0,
            1, 0, 0, 0, 0, 0, 0, 0,
            0, 0, 0, 0, 0, 0, 0xe0, 0x3f,
            0, 0, 0, 0, 0, 0, 0xe0, 0xbf,
            0, 0, 0, 0, 0, 0, 0, 0,
        ];
        assert_eq!(velocity.encode().unwrap(), bytes);
        assert_eq!(Datagram::decode(&bytes), Ok(velocity));
    }

    #[test]
    fn what_is_written_is_read() {
        for datagram in all() {
            assert_eq!(Datagram::decode(&datagram.encode().unwrap()), Ok(datagram));
        }
        let stop = Datagram { command: Command::Stop, ..all()[0] };
        assert_eq!(stop.encode(), None, "not a command of a vision system");
    }

    /// Each fault of one field, and its cause.
    #[test]
    fn each_fault_has_its_cause() {
        for datagram in all() {
            let sound = datagram.encode().unwrap();
            let with = |at: usize, new: &[u8]| {
                let mut bytes = sound.clone();
                bytes[at..at + new.len()].copy_from_slice(new);
                Datagram::decode(&bytes)
            };
            // Length and head.
            for cut in 0..sound.len() {
                assert_eq!(Datagram::decode(&sound[..cut]), Err(Cause::Malformed), "{cut} bytes");
            }
            assert_eq!(Datagram::decode(&[&sound[..], &[0]].concat()), Err(Cause::Malformed));
            assert_eq!(Datagram::decode(&[&sound[..], &[0; 8]].concat()), Err(Cause::Malformed));
            assert_eq!(with(0, b"GWVJ"), Err(Cause::Malformed));
            for version in [0u16, 2, 256, u16::MAX] {
                assert_eq!(with(4, &version.to_le_bytes()), Err(Cause::Version));
            }
            for kind in [0u16, 5, 256, u16::MAX] {
                assert_eq!(with(6, &kind.to_le_bytes()), Err(Cause::Malformed), "kind {kind}");
            }
            // Numbers.
            for (i, field) in datagram.command.info().fields.iter().enumerate() {
                let number = |x: f64| with(HEAD + 8 * i, &x.to_le_bytes());
                for none in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    assert_eq!(number(none), Err(Cause::NotFinite), "{}", field.name);
                }
                let [low, high] = field.range;
                for beyond in [low - 1.0, high + 1.0, f64::MAX, f64::MIN] {
                    assert_eq!(number(beyond), Err(Cause::Range), "{} = {beyond}", field.name);
                }
                assert!(number(low).is_ok() && number(high).is_ok(), "{}", field.name);
                if field.is_whole() {
                    assert_eq!(number(1.5), Err(Cause::Range), "{}", field.name);
                }
            }
        }
    }

    proptest! {
        #[test]
        fn random_bytes_are_refused(bytes in prop::collection::vec(any::<u8>(), 0..500)) {
            prop_assert!(Datagram::decode(&bytes).is_err());
            prop_assert!(Trigger::decode(&bytes).is_err());
        }

        /// Whatever follows a sound head is a trigger, and the same bytes again.
        #[test]
        fn a_trigger_is_read_as_it_was_written(rest in prop::collection::vec(any::<u8>(), TRIGGER - 8), cut in 0..TRIGGER) {
            let bytes = [&head(0, 0, 0, 0)[..8], &rest].concat();
            prop_assert_eq!(Trigger::decode(&bytes).unwrap().encode(), bytes.clone());
            prop_assert!(Trigger::decode(&bytes[..cut]).is_err());
            for (at, wrong, cause) in [(0, b'x', Cause::Malformed), (4, 2, Cause::Version), (6, 1, Cause::Malformed)] {
                let mut other = bytes.clone();
                other[at] = wrong;
                prop_assert_eq!(Trigger::decode(&other).err(), Some(cause));
            }
        }

        /// Behind a sound head: never a panic, and what is taken is in its ranges and the same bytes again.
        #[test]
        fn random_numbers_are_refused_or_in_range(
            kind in 0u16..6,
            numbers in prop::collection::vec(prop_oneof![any::<f64>(), -2.0..2.0f64, 1.0..40.0f64], 0..12),
        ) {
            let mut bytes = head(kind, 1, 2, 3);
            numbers.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
            if let Ok(datagram) = Datagram::decode(&bytes) {
                prop_assert!(datagram.command.check().is_ok());
                prop_assert_eq!(datagram.encode().unwrap(), bytes);
            }
        }

        #[test]
        fn flipped_bits_are_refused_or_another_datagram(which in 0usize..4, bit in any::<usize>()) {
            let mut bytes = all()[which].encode().unwrap();
            let bit = bit % (8 * bytes.len());
            bytes[bit / 8] ^= 1 << (bit % 8);
            if let Ok(datagram) = Datagram::decode(&bytes) {
                prop_assert_eq!(datagram.encode().unwrap(), bytes);
            }
        }
    }
}
