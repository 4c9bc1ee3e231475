//! Traffic of CAN lines as MCAP: profile `ros2`, CDR, one channel `/can/LINE` for each line, one message for each frame.
//!
//! The message is `gangwerk_msgs/msg/CanFrame`. `can_msgs/msg/Frame` of ROS 2 has no room for CAN FD.

use crate::cdr::{CdrDecoder, CdrEncoder};
use crate::claim;
use crate::definition::PACKAGE;
use crate::error::RecordingError;
use crate::log::{LogContent, LogEnd, walk};
use crate::recorder::{Sink, options};
use crate::standard_definitions::TIME;
use mcap::records::{MessageHeader, Metadata};
use messages::record::{Read, Visit};
use std::collections::BTreeMap;
use std::io::{BufWriter, Write};
use std::ops::ControlFlow;
use std::path::Path;

/// Name of the metadata record.
const METADATA: &str = "gangwerk.can";

const DEFINITION: &str = "\
# One frame of a CAN line.
builtin_interfaces/Time stamp   # when it passed the interface
string line                     # name of the interface
uint32 id                       # as SocketCAN's can_id: bit 31 29-bit identifier, 30 remote frame, 29 error frame
uint8 form                      # 0 classic, 1 CAN FD
uint8 flags                     # CAN FD: bit 0 bit rate switch, 1 error state; classic: length code if above 8
uint8 way                       # 0 unknown, 1 received, 2 sent
uint8 len                       # bytes of data; of a remote frame the bytes it asks for
uint8[] data
";

/// One frame as the log holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CanFrame<'a> {
    /// \[ns\]
    pub stamp_ns: u64,
    /// Name of the interface.
    pub line: &'a str,
    /// Identifier with the flags of SocketCAN's `can_id`.
    pub id: u32,
    /// 0 classic, 1 CAN FD.
    pub form: u8,
    /// Flags of CAN FD, or the length code of a classic frame if it is above 8.
    pub flags: u8,
    /// 0 unknown, 1 received, 2 sent.
    pub way: u8,
    /// \[B\]
    pub len: u8,
    /// Payload.
    pub data: &'a [u8],
}

/// Writes a log of frames.
pub struct TrafficWriter {
    mcap: mcap::Writer<Box<dyn Sink>>,
    schema: u16,
    channels: Vec<(String, u16, u32)>,
    encoder: CdrEncoder,
}

fn definition() -> String {
    format!("{DEFINITION}{}\n{TIME}", "=".repeat(80))
}

/// Name of the channel of a line: ROS 2 names know letters, digits and underscores.
fn channel_name(line: &str) -> String {
    let plain: String = line.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    format!("/can/{plain}")
}

impl TrafficWriter {
    /// Makes the file; an existing one is overwritten, unless somebody writes it.
    ///
    /// # Errors
    /// It cannot be made or written.
    pub fn create(path: &Path) -> Result<Self, RecordingError> {
        let sink: Box<dyn Sink> = Box::new(BufWriter::new(claim::create(path)?));
        let mut mcap = options().create(sink).map_err(RecordingError::write)?;
        let about = BTreeMap::from([("software".into(), env!("CARGO_PKG_VERSION").into())]);
        mcap.write_metadata(&Metadata { name: METADATA.into(), metadata: about })
            .map_err(RecordingError::write)?;
        let schema = mcap
            .add_schema(&format!("{PACKAGE}/msg/CanFrame"), "ros2msg", definition().as_bytes())
            .map_err(RecordingError::write)?;
        Ok(Self { mcap, schema, channels: Vec::new(), encoder: CdrEncoder::new() })
    }

    /// Writes one frame.
    ///
    /// # Errors
    /// The log can no longer be written.
    pub fn write(&mut self, frame: &CanFrame<'_>) -> Result<(), RecordingError> {
        let e = self.encoder.begin();
        e.stamp(frame.stamp_ns);
        e.string(frame.line);
        e.u32(frame.id);
        [frame.form, frame.flags, frame.way, frame.len].into_iter().for_each(|byte| e.u8(byte));
        e.count(frame.data.len());
        frame.data.iter().for_each(|byte| e.u8(*byte));
        let at = self.channel(frame.line)?;
        let (_, id, sequence) = &mut self.channels[at];
        let header = MessageHeader {
            channel_id: *id,
            sequence: *sequence,
            log_time: frame.stamp_ns,
            publish_time: frame.stamp_ns,
        };
        *sequence = sequence.wrapping_add(1);
        self.mcap.write_to_known_channel(&header, self.encoder.payload()).map_err(RecordingError::write)
    }

    /// Index of the channel of a line, made at its first frame.
    fn channel(&mut self, line: &str) -> Result<usize, RecordingError> {
        if let Some(at) = self.channels.iter().position(|(name, ..)| name == line) {
            return Ok(at);
        }
        let metadata = BTreeMap::from([("offered_qos_profiles".to_string(), String::new())]);
        let id = self
            .mcap
            .add_channel(self.schema, &channel_name(line), "cdr", &metadata)
            .map_err(RecordingError::write)?;
        self.channels.push((line.to_owned(), id, 0));
        Ok(self.channels.len() - 1)
    }

    /// Writes the index and closes the log.
    ///
    /// # Errors
    /// The log can no longer be written.
    pub fn finish(mut self) -> Result<(), RecordingError> {
        self.mcap.finish().map_err(RecordingError::write)?;
        self.mcap.into_inner().flush().map_err(RecordingError::write)
    }
}

/// Shows every frame of a log in the order of the file.
///
/// # Errors
/// The file cannot be read, is no MCAP file, damaged, or holds no frames.
pub fn read_traffic(path: &Path, mut see: impl FnMut(&CanFrame<'_>)) -> Result<LogEnd, RecordingError> {
    let ours = definition();
    let (mut frames, mut broken) = (0u64, None);
    let end = walk(path, |seen| {
        if let LogContent::Message(message) = seen
            && message.definition == ours.as_bytes()
        {
            match decode(message.payload) {
                Some((head, data)) => see(&CanFrame { data: &data[..], ..head }),
                None => broken = broken.or(Some(frames)),
            }
            frames += 1;
        }
        ControlFlow::Continue(())
    })?;
    match broken {
        Some(at) => Err(RecordingError::Damaged(path.into(), at, "a frame that cannot be decoded".into())),
        None if frames == 0 => Err(RecordingError::NoTraffic(path.into())),
        None => Ok(end),
    }
}

/// A frame without its data, and its data.
fn decode(payload: &[u8]) -> Option<(CanFrame<'_>, Vec<u8>)> {
    let mut d = CdrDecoder::new(payload)?;
    let (seconds, nanoseconds) = (d.i32(), d.u32());
    let stamp_ns = u64::try_from(seconds).ok()? * 1_000_000_000 + u64::from(nanoseconds);
    let line = d.string();
    let id = d.u32();
    let [form, flags, way, len] = std::array::from_fn(|_| d.u8());
    let count = d.u32() as usize;
    if count > d.left() || d.ran_dry() {
        return None;
    }
    let data = (0..count).map(|_| d.u8()).collect();
    (d.left() == 0).then_some((CanFrame { stamp_ns, line, id, form, flags, way, len, data: &[] }, data))
}
