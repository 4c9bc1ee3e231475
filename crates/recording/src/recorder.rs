//! Writes a log: MCAP, profile `ros2`, CDR only, LZ4 chunks, no threads.
//!
//! Every logged topic is written verbatim, at full rate, as `/gangwerk/TOPIC` with its own message type. Beside them
//! stand standard ROS 2 messages, thinned to [`STANDARD_RATE`](crate::STANDARD_RATE): they are for viewers, not for
//! arithmetic. `/tf` and `/markers` are what the robot believes, `/truth/tf` and `/truth/markers` what the simulation knows,
//! under names that begin with `truth/`. [`Composer`] makes all of them.
//!
//! Time of the log is wall time of a run in real time, simulated time otherwise; messages stand in its order, but for those
//! that come more than 0.1 s late.
//!
//! Chunks are put together in memory and written at once, so that what is in the file is always the beginning of a
//! valid log: a crash costs the chunk that was not yet written, see [`Recorder::flush`].

use std::collections::BTreeMap;
use std::io::{BufWriter, Seek, Write};
use std::path::Path;

use mcap::records::{MessageHeader, Metadata};
use messages::{Record, Topic};

use crate::claim;
use crate::composer::{Composer, ENCODING, LogChannel, Out, SCHEMA_ENCODING, channels};
use crate::error::RecordingError;
use crate::links::LinkPoses;
use crate::queue::{MessageQueue, QueuedMessage};
use crate::robot::{METADATA, RobotInfo, RunInfo, to_metadata};

/// \[B\] Chunks are closed at this size: about 0.1 s of a walk.
const CHUNK_SIZE: u64 = 512 * 1024;

/// Destination of a log.
pub trait Sink: Write + Seek + Send {}
impl<W: Write + Seek + Send> Sink for W {}

/// A log being written.
pub struct Recorder {
    mcap: mcap::Writer<Box<dyn Sink>>,
    composer: Composer,
    /// By their places in [`channels`].
    channels: Vec<FileChannel>,
    queue: MessageQueue,
    described: bool,
}

/// A channel in the file.
struct FileChannel {
    id: u16,
    sequence: u32,
}

impl Recorder {
    /// Makes the file; an existing one is overwritten, unless somebody writes it.
    pub fn create(path: &Path, robot: &RobotInfo, run: &RunInfo) -> Result<Self, RecordingError> {
        Self::to(Box::new(BufWriter::new(claim::create(path)?)), robot, run)
    }

    /// Writes to something else than a file.
    pub fn to(sink: Box<dyn Sink>, robot: &RobotInfo, run: &RunInfo) -> Result<Self, RecordingError> {
        let mut mcap = options().create(sink).map_err(RecordingError::write)?;
        let metadata = Metadata { name: METADATA.into(), metadata: to_metadata(robot, run) };
        mcap.write_metadata(&metadata).map_err(RecordingError::write)?;
        let channels = file_channels(&mut mcap)?;
        let (composer, queue) = (Composer::new(robot, run), MessageQueue::new(run.clock.clone()));
        Ok(Self { mcap, composer, channels, queue, described: false })
    }

    /// Also writes the pose of every link as `/tf`. Without it there is the true torso alone.
    pub fn with_links(mut self, links: Box<dyn LinkPoses>) -> Self {
        self.composer = self.composer.with_links(links);
        self
    }

    /// Puts a file into the log; before the first record.
    ///
    /// # Errors
    /// The log can no longer be written.
    pub fn attach(&mut self, name: &str, bytes: &[u8]) -> Result<(), RecordingError> {
        let attachment = mcap::Attachment {
            log_time: 0,
            create_time: 0,
            name: name.into(),
            media_type: "text/plain".into(),
            data: bytes.into(),
        };
        self.mcap.attach(&attachment).map_err(RecordingError::write)
    }

    /// Writes a record of a logged topic, and the standard messages that follow from it. Time is that of its header.
    pub fn write<T: Record>(&mut self, topic: &Topic, record: &T) -> Result<(), RecordingError> {
        let next = self.composer.place(topic.name).map_or(0, |at| self.channels[at].sequence);
        self.write_numbered(topic, record, next)
    }

    /// The same for the record with this number of its topic: a gap between numbers shows what the log lost.
    ///
    /// # Errors
    /// The log can no longer be written.
    pub fn write_numbered<T: Record>(
        &mut self,
        topic: &Topic,
        record: &T,
        number: u32,
    ) -> Result<(), RecordingError> {
        if let Some(at) = self.composer.place(topic.name) {
            self.channels[at].sequence = number;
        }
        // Messages are numbered here and wait for their turn in time.
        let Self { composer, channels, queue, .. } = self;
        let put: &mut Out<'_> = &mut |message| {
            let channel = &mut channels[message.channel];
            let sequence = channel.sequence;
            channel.sequence = sequence.wrapping_add(1);
            let queued =
                QueuedMessage { channel: message.channel, sequence, payload: message.payload.into() };
            queue.add(message.stamp_ns, queued);
        };
        if !self.described {
            self.described = true;
            composer.describe(put);
        }
        composer.compose(topic, record, put);
        while let Some((time, message)) = self.queue.next() {
            self.write_to_file(time, &message)?;
        }
        Ok(())
    }

    fn write_to_file(&mut self, time: u64, message: &QueuedMessage) -> Result<(), RecordingError> {
        let header = MessageHeader {
            channel_id: self.channels[message.channel].id,
            sequence: message.sequence,
            log_time: time,
            publish_time: time,
        };
        self.mcap.write_to_known_channel(&header, &message.payload).map_err(RecordingError::write)
    }

    /// Closes the chunk and hands everything to the operating system: what was written so far survives the death of
    /// this process.
    pub fn flush(&mut self) -> Result<(), RecordingError> {
        while let Some((time, message)) = self.queue.drain() {
            self.write_to_file(time, &message)?;
        }
        self.mcap.flush().map_err(RecordingError::write)
    }

    /// Writes the index and closes the log.
    pub fn finish(mut self) -> Result<(), RecordingError> {
        while let Some((time, message)) = self.queue.end() {
            self.write_to_file(time, &message)?;
        }
        self.mcap.finish().map_err(RecordingError::write)?;
        self.mcap.into_inner().flush().map_err(RecordingError::write)
    }
}

/// Options of every log.
pub(crate) fn options() -> mcap::WriteOptions {
    mcap::WriteOptions::new()
        .profile("ros2")
        .library("gangwerk")
        .compression(Some(mcap::Compression::Lz4))
        .chunk_size(Some(CHUNK_SIZE))
        .disable_seeking(true)
}

/// All channels in the order of the table, so that equal runs give equal files.
fn file_channels(mcap: &mut mcap::Writer<Box<dyn Sink>>) -> Result<Vec<FileChannel>, RecordingError> {
    let add = |channel: LogChannel| {
        let schema = mcap.add_schema(&channel.interface, SCHEMA_ENCODING, channel.definition.as_bytes())?;
        let metadata = BTreeMap::from([("offered_qos_profiles".to_string(), channel.quality.to_string())]);
        let id = mcap.add_channel(schema, &channel.name, ENCODING, &metadata)?;
        Ok::<_, mcap::McapError>(FileChannel { id, sequence: 0 })
    };
    channels().into_iter().map(add).collect::<Result<_, _>>().map_err(RecordingError::write)
}
