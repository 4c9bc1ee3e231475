//! Reads a log, also one that ends in the middle because its writer was killed.

use crate::cdr::{CdrDecoder, decode};
use crate::composer::channel_name;
use crate::definition::definition;
use crate::error::RecordingError;
use crate::lengths;
use crate::links::RecordedPose;
use crate::robot::{METADATA, RobotInfo, RunInfo, from_metadata};
use crate::standard::{ODOM, TRUTH, WORLD};
use crate::standard_definitions::{ROBOT_DESCRIPTION, TF, TF_STATIC};
use mcap::McapError;
use mcap::records::{Channel, Record as Entry, SchemaHeader};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use messages::record::Read as _;
use messages::{Record, Topic};
use std::collections::HashMap;
use std::io::Read;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// \[B\] No record of ours is longer; a longer one is damage, not a reason to ask for memory.
pub(crate) const LONGEST_RECORD: usize = 64 * 1024 * 1024;

/// A log on disk.
#[derive(Clone, Debug)]
pub struct Log {
    path: PathBuf,
    robot: RobotInfo,
    run: RunInfo,
}

/// One message as it stands in the file.
#[derive(Clone, Copy, Debug)]
pub struct LogMessage<'a> {
    /// Name of the channel.
    pub channel: &'a str,
    /// Definition of its type.
    pub definition: &'a [u8],
    /// Number of the record of its topic; of standard messages their own count.
    pub number: u32,
    /// \[ns\]
    pub log_time_ns: u64,
    /// CDR with encapsulation header.
    pub payload: &'a [u8],
}

/// Ending of the log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogEnd {
    /// With its index, as it should.
    Complete,
    /// In the middle: its writer was killed or the file was cut. Holds the number of messages before the cut.
    Truncated(u64),
}

/// One frame of `/tf`.
#[derive(Clone, Debug, PartialEq)]
pub struct Transform {
    /// Frame the pose is given in.
    pub parent: String,
    /// The frame.
    pub child: String,
    /// parent_from_child
    pub pose: RecordedPose,
}

/// All frames of the robot in `odom` at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameTree {
    /// \[ns\] As in the headers of records.
    pub stamp_ns: u64,
    /// Parents before their children.
    pub transforms: Vec<Transform>,
}

impl Log {
    /// Root of [`Log::frames`]: where the robot believes that it was first.
    pub const ODOM: &'static str = ODOM;

    /// Opens a log and reads what it says about itself.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let (mut about, mut urdf) = (None, None);
        walk(path, |seen| {
            match seen {
                LogContent::Metadata(name, map) if name == METADATA => about = Some(from_metadata(map)),
                LogContent::Message(m) if m.channel == ROBOT_DESCRIPTION.topic => {
                    urdf = CdrDecoder::new(m.payload).map(|mut d| d.string().to_string());
                }
                _ => {}
            }
            if about.is_some() && urdf.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })?;
        let (mut robot, run) = about.ok_or_else(|| RecordingError::Foreign(path.into()))?;
        robot.urdf = urdf.unwrap_or_default();
        Ok(Self { path: path.into(), robot, run })
    }

    /// Its file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The robot.
    pub fn robot(&self) -> &RobotInfo {
        &self.robot
    }

    /// The run.
    pub fn run(&self) -> &RunInfo {
        &self.run
    }

    /// Shows every file that was put into the log, up to the first message.
    ///
    /// # Errors
    /// The file cannot be read, or is damaged.
    pub fn each_attachment(&self, mut see: impl FnMut(&str, &[u8])) -> Result<(), RecordingError> {
        walk(&self.path, |seen| match seen {
            LogContent::Attachment(name, bytes) => {
                see(name, bytes);
                ControlFlow::Continue(())
            }
            LogContent::Message(_) => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        })?;
        Ok(())
    }

    /// Shows every message in the order of the file.
    pub fn each(&self, mut see: impl FnMut(LogMessage<'_>)) -> Result<LogEnd, RecordingError> {
        walk(&self.path, |seen| {
            if let LogContent::Message(message) = seen {
                see(message);
            }
            ControlFlow::Continue(())
        })
    }

    /// Shows every record of a topic in the order of the file.
    pub fn each_record<T: Record>(
        &self,
        topic: &Topic,
        mut see: impl FnMut(&T),
    ) -> Result<LogEnd, RecordingError> {
        let (channel, ours) = (channel_name(topic.name), definition::<T>());
        let mut same_layout = true;
        let end = self.each(|message| {
            if message.channel == channel {
                match decode::<T>(message.payload) {
                    Some(record) if message.definition == ours.as_bytes() => see(&record),
                    _ => same_layout = false,
                }
            }
        })?;
        if !same_layout {
            return Err(self.other_layout(topic));
        }
        Ok(end)
    }

    /// The error that a topic was written with another layout than this program's.
    pub fn other_layout(&self, topic: &Topic) -> RecordingError {
        let known = Topic::find(topic.name);
        RecordingError::OtherLayout {
            path: self.path.clone(),
            topic: known.map_or("", |t| t.name),
            record: known.map_or("", |t| t.type_name),
            software: self.run.software.clone(),
        }
    }

    /// All records of a topic.
    pub fn records<T: Record>(&self, topic: &Topic) -> Result<Vec<T>, RecordingError> {
        let mut records = Vec::new();
        self.each_record(topic, |record: &T| records.push(*record))?;
        Ok(records)
    }

    /// The frames of `/tf` and `/tf_static` as the robot believes them to be, [`Self::ODOM`] being their root.
    ///
    /// # Errors
    /// The file cannot be read, or is damaged.
    pub fn frames(&self) -> Result<Vec<FrameTree>, RecordingError> {
        let (mut trees, mut still) = (Vec::new(), Vec::new());
        let believed = |t: &Transform| t.parent != WORLD && !t.child.starts_with(TRUTH);
        self.each(|message| {
            let moves = message.channel == TF.topic;
            if !moves && message.channel != TF_STATIC.topic {
                return;
            }
            let mut transforms = read_transforms(message.payload);
            transforms.retain(believed);
            if !moves {
                still = transforms;
            } else if !transforms.is_empty() {
                transforms.extend_from_slice(&still);
                let clock = self.run.clock.as_ref();
                let stamp_ns = clock.map_or(message.log_time_ns, |clock| clock.stamp_ns(message.log_time_ns));
                trees.push(FrameTree { stamp_ns, transforms });
            }
        })?;
        Ok(trees)
    }
}

/// `tf2_msgs/TFMessage`.
fn read_transforms(payload: &[u8]) -> Vec<Transform> {
    let Some(mut d) = CdrDecoder::new(payload) else { return Vec::new() };
    let mut transforms = Vec::new();
    for _ in 0..d.u32() {
        let _stamp = (d.i32(), d.u32());
        let (parent, child) = (d.string().to_string(), d.string().to_string());
        let position = std::array::from_fn(|_| d.f64());
        let orientation = std::array::from_fn(|_| d.f64());
        if d.ran_dry() {
            break;
        }
        transforms.push(Transform { parent, child, pose: RecordedPose { position, orientation } });
    }
    transforms
}

/// Content of a file.
pub(crate) enum LogContent<'a> {
    Metadata(&'a str, &'a std::collections::BTreeMap<String, String>),
    Attachment(&'a str, &'a [u8]),
    Schema(&'a SchemaHeader, &'a [u8]),
    Channel(&'a Channel),
    Message(LogMessage<'a>),
}

/// Schemas and channels that a file has described so far.
#[derive(Default)]
pub(crate) struct Described {
    schemas: HashMap<u16, Vec<u8>>,
    channels: HashMap<u16, (String, u16)>,
    /// Number of messages so far.
    messages: u64,
}

impl Described {
    /// Shows a record, if it is one that a log is read for.
    ///
    /// # Errors
    /// Why it is damaged.
    pub(crate) fn show(
        &mut self,
        (opcode, data): (u8, &[u8]),
        see: &mut dyn FnMut(LogContent<'_>) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, String> {
        if !lengths::is_read(opcode) {
            return Ok(ControlFlow::Continue(()));
        }
        if !lengths::fit(opcode, data) {
            return Err(lengths::LONG_STRING.into());
        }
        // Schemas and channels are kept: messages name theirs by number.
        Ok(match mcap::parse_record(opcode, data).map_err(|e| e.to_string())? {
            Entry::Schema { header, data } => {
                let flow = see(LogContent::Schema(&header, &data));
                self.schemas.insert(header.id, data.into_owned());
                flow
            }
            Entry::Channel(channel) => {
                let flow = see(LogContent::Channel(&channel));
                self.channels.insert(channel.id, (channel.topic, channel.schema_id));
                flow
            }
            Entry::Attachment { header, data, .. } => see(LogContent::Attachment(&header.name, &data)),
            Entry::Metadata(metadata) => see(LogContent::Metadata(&metadata.name, &metadata.metadata)),
            Entry::Message { header, data } => {
                self.messages += 1;
                let Some((channel, schema)) = self.channels.get(&header.channel_id) else {
                    return Err(format!("it belongs to the unknown channel {}", header.channel_id));
                };
                let definition = self.schemas.get(schema).map_or(&[][..], Vec::as_slice);
                see(LogContent::Message(LogMessage {
                    channel,
                    definition,
                    number: header.sequence,
                    log_time_ns: header.log_time,
                    payload: &data,
                }))
            }
            _ => ControlFlow::Continue(()),
        })
    }
}

/// Walks over the file until its end, a cut, or a break.
pub(crate) fn walk(
    path: &Path,
    mut see: impl FnMut(LogContent<'_>) -> ControlFlow<()>,
) -> Result<LogEnd, RecordingError> {
    let mut file = std::fs::File::open(path).map_err(|e| RecordingError::Read(path.into(), e))?;
    let options = LinearReaderOptions::default()
        .with_validate_chunk_crcs(true)
        .with_record_length_limit(LONGEST_RECORD);
    let mut reader = LinearReader::new_with_options(options);
    let (mut described, mut bytes, mut begun) = (Described::default(), 0u64, false);
    while let Some(event) = reader.next_event() {
        let record = match event {
            Ok(LinearReadEvent::Record { opcode, data }) => (opcode, data),
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                // What a record claims to be long is not yet there to be read.
                let wanted = wanted.clamp(64 * 1024, 1024 * 1024);
                let got =
                    file.read(reader.insert(wanted)).map_err(|e| RecordingError::Read(path.into(), e))?;
                bytes += got as u64;
                reader.notify_read(got);
                continue;
            }
            Err(McapError::BadMagic) if !begun => {
                return Err(RecordingError::not_a_log(path, "it does not begin like one"));
            }
            Err(McapError::UnexpectedEof) if bytes < mcap::MAGIC.len() as u64 => {
                return Err(RecordingError::not_a_log(path, format!("it has only {bytes} bytes")));
            }
            Err(McapError::UnexpectedEof) => return Ok(LogEnd::Truncated(described.messages)),
            Err(e) => return Err(RecordingError::Damaged(path.into(), described.messages, e.to_string())),
        };
        begun = true;
        let shown = described.show(record, &mut see);
        let flow = shown.map_err(|why| RecordingError::Damaged(path.into(), described.messages, why))?;
        if flow.is_break() {
            return Ok(LogEnd::Complete);
        }
    }
    Ok(LogEnd::Complete)
}
