//! Writes a log: MCAP, profile `ros2`, CDR only, LZ4 chunks, no threads.
//!
//! Every logged topic is written verbatim, at full rate, as `/gangwerk/TOPIC` with its own message type. Beside them
//! stand standard ROS 2 messages, thinned to [`STANDARD_RATE`]: they are for viewers, not for arithmetic. `/tf` and `/markers`
//! are what the robot believes, `/truth/tf` and `/truth/markers` what the simulation knows, under names that begin with `truth/`.
//!
//! Time of the log is wall time of a run in real time, simulated time otherwise; messages stand in its order, but for those
//! that come more than 0.1 s late.
//!
//! Chunks are put together in memory and written at once, so that what is in the file is always the beginning of a
//! valid log: a crash costs the chunk that was not yet written, see [`Recorder::flush`].

use crate::cdr::CdrEncoder;
use crate::definition::{definition, interface};
use crate::error::RecordingError;
use crate::links::{LinkPoses, RecordedPose};
use crate::odometry::{self, Odometry};
use crate::queue::{MessageQueue, QueuedMessage};
use crate::robot::{METADATA, RobotInfo, RunInfo, to_metadata};
use crate::standard::{self, ODOM, TRUTH, WORLD};
use crate::standard_definitions::{
    FOOT_WRENCH, IMU, JOINT_STATES, MARKERS, ROBOT_DESCRIPTION, ROSOUT, STANDARD, TF, TF_STATIC,
    TRUTH_MARKERS, TRUTH_TF,
};
use crate::{markers, rosout};
use mcap::records::{MessageHeader, Metadata};
use messages::topics::{ForType, with_type};
use messages::{ControllerState, Event, MAX_JOINTS, Plan, Record, Sensors, SimState, TOPICS, Topic, Words};
use std::any::Any;
use std::collections::BTreeMap;
use std::io::{BufWriter, Seek, Write};
use std::path::Path;

/// \[1/s\] Most standard messages of one kind per second.
pub const STANDARD_RATE: u64 = 100;
const STANDARD_PERIOD_NS: u64 = 1_000_000_000 / STANDARD_RATE;

/// \[B\] Chunks are closed at this size: about 0.1 s of a walk.
const CHUNK_SIZE: u64 = 512 * 1024;

/// Destination of a log.
pub trait Sink: Write + Seek + Send {}
impl<W: Write + Seek + Send> Sink for W {}

/// A log being written.
pub struct Recorder {
    mcap: mcap::Writer<Box<dyn Sink>>,
    robot: RobotInfo,
    links: Option<Box<dyn LinkPoses>>,
    poses: Vec<RecordedPose>,
    channels: Vec<Channel>,
    encoder: CdrEncoder,
    words: Words,
    queue: MessageQueue,
    odometry: Odometry,
    described: bool,
    /// \[ns\] Bus cycle: how much later than its stamp the simulated state is what it says.
    cycle_ns: u64,
    /// Stamps from which the next standard messages of sensors, stabilizer and simulation are due \[ns\].
    next_ns: [u64; 3],
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
            encoder: CdrEncoder::new(),
            words: Words { joints: robot.joints.clone(), ..Words::default() },
            queue: MessageQueue::new(run.clock.clone()),
            odometry: Odometry::default(),
            described: false,
            cycle_ns: run.cycle_ns,
            next_ns: [0; 3],
        };
        recorder.add_channels()?;
        Ok(recorder)
    }

    /// Also writes the pose of every link as `/tf`. Without it there is the true torso alone.
    pub fn with_links(mut self, links: Box<dyn LinkPoses>) -> Self {
        self.poses = vec![RecordedPose::IDENTITY; links.links().len()];
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
            let text = standard.definition();
            self.add_channel(
                standard.topic,
                standard.topic,
                (standard.interface, &text),
                standard.quality(),
            )?;
        }
        for topic in TOPICS.iter().filter(|t| t.logged) {
            if let Some((interface, text)) = with_type(topic.name, Describe) {
                self.add_channel(topic.name, &channel_name(topic.name), (&interface, &text), "")?;
            }
        }
        Ok(())
    }

    fn add_channel(
        &mut self,
        topic: &'static str,
        name: &str,
        (interface, definition): (&str, &str),
        quality: &str,
    ) -> Result<(), RecordingError> {
        let schema = self
            .mcap
            .add_schema(interface, "ros2msg", definition.as_bytes())
            .map_err(RecordingError::write)?;
        let metadata = BTreeMap::from([("offered_qos_profiles".to_string(), quality.to_string())]);
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
        if !self.described {
            self.described = true;
            self.describe();
        }
        self.encoder.encode(record);
        if let Some(channel) = self.channels.iter_mut().find(|c| c.topic == topic.name) {
            channel.sequence = number;
        }
        self.put(topic.name, record.header().stamp_ns);
        let any: &dyn Any = record;
        if let Some(sensors) = any.downcast_ref::<Sensors>() {
            self.show_sensors(sensors);
        } else if let Some(state) = any.downcast_ref::<ControllerState>() {
            self.show_state(state);
        } else if let Some(plan) = any.downcast_ref::<Plan>() {
            self.odometry.plan(plan);
        } else if let Some(state) = any.downcast_ref::<SimState>() {
            self.show_truth(state);
        } else if let Some(event) = any.downcast_ref::<Event>().filter(|_| topic.name.starts_with("events/"))
        {
            let stamp = self.queue.time(event.header.stamp_ns);
            rosout::log(&mut self.encoder, stamp, topic.writer.name(), event, &self.words);
            self.put(ROSOUT.topic, event.header.stamp_ns);
        }
        while let Some((time, message)) = self.queue.next() {
            self.write_to_file(time, &message)?;
        }
        Ok(())
    }

    /// What is said once: the robot, and the frames that never move.
    fn describe(&mut self) {
        standard::text(&mut self.encoder, &self.robot.urdf);
        self.put(ROBOT_DESCRIPTION.topic, 0);
        let links = match &mut self.links {
            Some(links) => {
                links.poses(&RecordedPose::IDENTITY, &[0.0; MAX_JOINTS], &mut self.poses);
                links.links()
            }
            None => &[],
        };
        standard::tf_static(&mut self.encoder, self.queue.time(0), &self.robot, links, &self.poses);
        self.put(TF_STATIC.topic, 0);
    }

    fn show_sensors(&mut self, sensors: &Sensors) {
        let stamp = sensors.header.stamp_ns;
        if !due(&mut self.next_ns[0], stamp) {
            return;
        }
        let time = self.queue.time(stamp);
        let mut torques = [f64::NAN; MAX_JOINTS];
        let known = self.links.as_mut().is_some_and(|links| links.torques(sensors, &mut torques));
        let torques = known.then_some(&torques);
        standard::joint_state(&mut self.encoder, time, &self.robot, sensors, torques);
        self.put(JOINT_STATES.topic, stamp);
        standard::imu(&mut self.encoder, time, sensors);
        self.put(IMU.topic, stamp);
        for (foot, channel) in FOOT_WRENCH.iter().enumerate() {
            standard::foot_wrench(&mut self.encoder, time, sensors, foot);
            self.put(channel.topic, stamp);
        }
        if let Some((sensors, state)) = self.odometry.sensors(sensors) {
            self.show_believed(&sensors, &state);
        }
    }

    fn show_state(&mut self, state: &ControllerState) {
        if !due(&mut self.next_ns[1], state.header.stamp_ns) {
            return;
        }
        if let Some((sensors, state)) = self.odometry.state(state) {
            self.show_believed(&sensors, &state);
        }
    }

    /// The robot as its sensors and its stabilizer know it.
    fn show_believed(&mut self, sensors: &Sensors, state: &ControllerState) {
        let stamp = sensors.header.stamp_ns;
        let (time, plan) = (self.queue.time(stamp), self.odometry.planned(state));
        markers::believed(&mut self.encoder, time, &self.robot, (sensors, state), &plan);
        self.put(MARKERS.topic, stamp);
        let Some(links) = &mut self.links else { return };
        links.poses(&RecordedPose::IDENTITY, &sensors.joint_angle, &mut self.poses);
        let foot = &self.robot.feet[0];
        let Some(at) = links.links().iter().position(|link| link.name == foot.link) else { return };
        let sole = self.poses[at].then(&RecordedPose::moved(foot.sole));
        let Some(torso) = odometry::torso(sensors, state, plan.height, &sole) else { return };
        links.poses(&torso, &sensors.joint_angle, &mut self.poses);
        standard::tf(&mut self.encoder, time, ODOM, "", links.links(), &self.poses);
        self.put(TF.topic, stamp);
    }

    /// The simulated robot as it is: at the end of its cycle, when the next one measures it.
    fn show_truth(&mut self, state: &SimState) {
        let stamp = state.header.stamp_ns + self.cycle_ns;
        if state.header.stamp_ns == 0 || !due(&mut self.next_ns[2], stamp) {
            return;
        }
        let time = self.queue.time(stamp);
        let torso = RecordedPose { position: state.position, orientation: state.orientation };
        match &mut self.links {
            Some(links) => {
                links.poses(&torso, &state.joint_angle, &mut self.poses);
                standard::tf(&mut self.encoder, time, WORLD, TRUTH, links.links(), &self.poses);
            }
            None => {
                let name = format!("{TRUTH}{}", self.robot.torso);
                standard::tf_of_torso(&mut self.encoder, time, WORLD, &name, &torso);
            }
        }
        self.put(TRUTH_TF.topic, stamp);
        markers::truth(&mut self.encoder, time, state);
        self.put(TRUTH_MARKERS.topic, stamp);
    }

    /// Queues what the encoder holds; a topic that is not logged is left out.
    fn put(&mut self, topic: &str, stamp_ns: u64) {
        let Some(at) = self.channels.iter().position(|c| c.topic == topic) else { return };
        let sequence = self.channels[at].sequence;
        self.channels[at].sequence = sequence.wrapping_add(1);
        self.queue
            .add(stamp_ns, QueuedMessage { channel: at, sequence, payload: self.encoder.payload().into() });
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
