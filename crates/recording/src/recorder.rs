//! Writes a log: MCAP, profile `ros2`, CDR only, LZ4 chunks, no threads.
//!
//! Every logged topic is written verbatim, at full rate, as `/gangwerk/TOPIC` with its own message type. Beside them
//! stand standard ROS 2 messages, thinned to [`STANDARD_RATE`]: they are for viewers, not for arithmetic.
//!
//! Chunks are put together in memory and written at once, so that what is in the file is always the beginning of a
//! valid log: a crash costs the chunk that was not yet written, see [`Recorder::flush`].

use crate::cdr::Encoder;
use crate::definition::{definition, interface};
use crate::error::RecordingError;
use crate::links::{LinkPoses, Pose};
use crate::robot::{METADATA, RobotInfo, RunInfo, to_metadata};
use crate::standard;
use crate::standard_definitions::{FOOT_WRENCH, IMU, JOINT_STATES, MARKERS, ROBOT_DESCRIPTION, STANDARD, TF};
use mcap::records::{MessageHeader, Metadata};
use messages::topics::{ForType, with_type};
use messages::{Record, Sensors, SimState, TOPICS, Topic};
use std::any::Any;
use std::collections::BTreeMap;
use std::io::{BufWriter, Seek, Write};
use std::path::Path;

/// \[1/s\] Most standard messages of one kind per second.
pub const STANDARD_RATE: u64 = 100;
const STANDARD_PERIOD_NS: u64 = 1_000_000_000 / STANDARD_RATE;

/// \[B\] Chunks are closed at this size: about 0.1 s of a walk.
const CHUNK_SIZE: u64 = 512 * 1024;

/// Where a log can be written to.
pub trait Sink: Write + Seek + Send {}
impl<W: Write + Seek + Send> Sink for W {}

/// A log being written.
pub struct Recorder {
    mcap: mcap::Writer<Box<dyn Sink>>,
    robot: RobotInfo,
    links: Option<Box<dyn LinkPoses>>,
    poses: Vec<Pose>,
    channels: Vec<Channel>,
    encoder: Encoder,
    described: bool,
    next_sensors_ns: u64,
    next_state_ns: u64,
}

struct Channel {
    topic: &'static str,
    id: u16,
    sequence: u32,
}

/// Name of the channel that carries a topic: ROS 2 names know no hyphen.
pub fn channel_name(topic: &str) -> String {
    format!("/gangwerk/{}", topic.replace('-', "_"))
}

impl Recorder {
    /// Makes the file; an existing one is overwritten.
    pub fn create(path: &Path, robot: &RobotInfo, run: &RunInfo) -> Result<Self, RecordingError> {
        let file = std::fs::File::create(path).map_err(|e| RecordingError::Create(path.into(), e))?;
        Self::to(Box::new(BufWriter::new(file)), robot, run)
    }

    /// Writes to something else than a file.
    pub fn to(sink: Box<dyn Sink>, robot: &RobotInfo, run: &RunInfo) -> Result<Self, RecordingError> {
        let mut mcap = options().create(sink).map_err(RecordingError::write)?;
        let metadata = Metadata { name: METADATA.into(), metadata: to_metadata(robot, run) };
        mcap.write_metadata(&metadata).map_err(RecordingError::write)?;
        let mut recorder = Self {
            mcap,
            robot: robot.clone(),
            links: None,
            poses: Vec::new(),
            channels: Vec::new(),
            encoder: Encoder::new(),
            described: false,
            next_sensors_ns: 0,
            next_state_ns: 0,
        };
        recorder.add_channels()?;
        Ok(recorder)
    }

    /// Also writes the pose of every link as `/tf`. Without it `/tf` holds the torso alone.
    pub fn with_links(mut self, links: Box<dyn LinkPoses>) -> Self {
        self.poses = vec![Pose::IDENTITY; links.links().len()];
        self.links = Some(links);
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

    /// All channels in the order of the table, so that equal runs give equal files.
    fn add_channels(&mut self) -> Result<(), RecordingError> {
        for standard in STANDARD {
            self.add_channel(standard.topic, standard.topic, standard.interface, &standard.definition())?;
        }
        for topic in TOPICS.iter().filter(|t| t.logged) {
            if let Some((interface, text)) = with_type(topic.name, Describe) {
                self.add_channel(topic.name, &channel_name(topic.name), &interface, &text)?;
            }
        }
        Ok(())
    }

    fn add_channel(
        &mut self,
        topic: &'static str,
        name: &str,
        interface: &str,
        definition: &str,
    ) -> Result<(), RecordingError> {
        let schema = self
            .mcap
            .add_schema(interface, "ros2msg", definition.as_bytes())
            .map_err(RecordingError::write)?;
        let metadata = BTreeMap::from([("offered_qos_profiles".to_string(), String::new())]);
        let id = self.mcap.add_channel(schema, name, "cdr", &metadata).map_err(RecordingError::write)?;
        self.channels.push(Channel { topic, id, sequence: 0 });
        Ok(())
    }

    /// Writes a record of a logged topic, and the standard messages that follow from it. Time is that of its header.
    pub fn write<T: Record>(&mut self, topic: &Topic, record: &T) -> Result<(), RecordingError> {
        let next = self.channels.iter().find(|c| c.topic == topic.name).map_or(0, |c| c.sequence);
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
        let stamp = record.header().stamp_ns;
        if !self.described {
            self.described = true;
            standard::text(&mut self.encoder, &self.robot.urdf);
            self.put(ROBOT_DESCRIPTION.topic, stamp)?;
        }
        self.encoder.encode(record);
        if let Some(channel) = self.channels.iter_mut().find(|c| c.topic == topic.name) {
            channel.sequence = number;
        }
        self.put(topic.name, stamp)?;
        let any: &dyn Any = record;
        if let Some(sensors) = any.downcast_ref::<Sensors>() {
            self.write_sensors(sensors)?;
        } else if let Some(state) = any.downcast_ref::<SimState>() {
            self.write_state(state)?;
        }
        Ok(())
    }

    fn write_sensors(&mut self, sensors: &Sensors) -> Result<(), RecordingError> {
        let stamp = sensors.header.stamp_ns;
        if !due(&mut self.next_sensors_ns, stamp) {
            return Ok(());
        }
        standard::joint_state(&mut self.encoder, &self.robot, sensors);
        self.put(JOINT_STATES.topic, stamp)?;
        standard::imu(&mut self.encoder, sensors);
        self.put(IMU.topic, stamp)?;
        for (foot, channel) in FOOT_WRENCH.iter().enumerate() {
            standard::foot_wrench(&mut self.encoder, sensors, foot);
            self.put(channel.topic, stamp)?;
        }
        Ok(())
    }

    fn write_state(&mut self, state: &SimState) -> Result<(), RecordingError> {
        let stamp = state.header.stamp_ns;
        if !due(&mut self.next_state_ns, stamp) {
            return Ok(());
        }
        let links = match &mut self.links {
            Some(links) => {
                links.poses(state, &mut self.poses);
                links.links()
            }
            None => &[],
        };
        standard::tf(&mut self.encoder, &self.robot, state, links, &self.poses);
        self.put(TF.topic, stamp)?;
        standard::markers(&mut self.encoder, &self.robot, state);
        self.put(MARKERS.topic, stamp)
    }

    /// Writes what the encoder holds; a topic that is not logged is left out.
    fn put(&mut self, topic: &str, stamp_ns: u64) -> Result<(), RecordingError> {
        let Some(channel) = self.channels.iter_mut().find(|c| c.topic == topic) else {
            return Ok(());
        };
        let header = MessageHeader {
            channel_id: channel.id,
            sequence: channel.sequence,
            log_time: stamp_ns,
            publish_time: stamp_ns,
        };
        channel.sequence = channel.sequence.wrapping_add(1);
        self.mcap.write_to_known_channel(&header, self.encoder.payload()).map_err(RecordingError::write)
    }

    /// Closes the chunk and hands everything to the operating system: what was written so far survives the death of
    /// this process.
    pub fn flush(&mut self) -> Result<(), RecordingError> {
        self.mcap.flush().map_err(RecordingError::write)
    }

    /// Writes the index and closes the log.
    pub fn finish(mut self) -> Result<(), RecordingError> {
        self.mcap.finish().map_err(RecordingError::write)?;
        self.mcap.into_inner().flush().map_err(RecordingError::write)
    }
}

/// How every log is written.
pub(crate) fn options() -> mcap::WriteOptions {
    mcap::WriteOptions::new()
        .profile("ros2")
        .library("gangwerk")
        .compression(Some(mcap::Compression::Lz4))
        .chunk_size(Some(CHUNK_SIZE))
        .disable_seeking(true)
}

/// Whether the next standard message is due, on the grid of full periods.
fn due(next_ns: &mut u64, stamp_ns: u64) -> bool {
    let due = stamp_ns >= *next_ns;
    if due {
        *next_ns = (stamp_ns / STANDARD_PERIOD_NS + 1) * STANDARD_PERIOD_NS;
    }
    due
}

struct Describe;

impl ForType<(String, String)> for Describe {
    fn call<T: Record>(self, _: &'static Topic) -> (String, String) {
        (interface::<T>(), definition::<T>())
    }
}
