//! Channels and messages of a log, apart from its file.
//!
//! [`Recorder`](crate::Recorder) puts them into a log, a server of a running robot sends them to viewers: both say the same.

use std::any::Any;

use messages::topics::{ForType, with_type};
use messages::{ControllerState, Event, MAX_JOINTS, Plan, Record, Sensors, SimState, TOPICS, Topic, Words};

use crate::cdr::CdrEncoder;
use crate::definition::{definition, interface};
use crate::links::{LinkPoses, RecordedPose};
use crate::odometry::{self, Odometry};
use crate::robot::{RobotInfo, RunInfo};
use crate::standard::{self, ODOM, TRUTH, WORLD};
use crate::standard_definitions::{
    FOOT_WRENCH, IMU, JOINT_STATES, MARKERS, ROBOT_DESCRIPTION, ROSOUT, STANDARD, TF, TF_STATIC,
    TRUTH_MARKERS, TRUTH_TF,
};
use crate::time::LogTime;
use crate::{markers, rosout};

/// Encoding of every message.
pub const ENCODING: &str = "cdr";
/// Encoding of every definition.
pub const SCHEMA_ENCODING: &str = "ros2msg";
/// \[1/s\] Most standard messages of one kind per second.
pub const STANDARD_RATE: u64 = 100;
const STANDARD_PERIOD_NS: u64 = 1_000_000_000 / STANDARD_RATE;

/// Name of the channel that carries a topic: ROS 2 names know no hyphen.
pub fn channel_name(topic: &str) -> String {
    format!("/gangwerk/{}", topic.replace('-', "_"))
}

/// One row of the table of channels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogChannel {
    /// Topic whose records it carries, or a standard channel's own name.
    pub topic: &'static str,
    /// Name: `/gangwerk/TOPIC`, or a standard one.
    pub name: String,
    /// ROS 2 interface, such as `gangwerk_msgs/msg/Sensors`.
    pub interface: String,
    /// Definition of the interface and of its parts.
    pub definition: String,
    /// Quality of service with which players send it again; empty: their own choice.
    pub quality: &'static str,
    /// Topics whose records its messages are made from; none: it is said once, by [`Composer::describe`].
    pub sources: Vec<&'static str>,
}

/// Every channel, standard ones first, in an order that never changes between runs: a message names its channel by its place.
pub fn channels() -> Vec<LogChannel> {
    let standard = STANDARD.iter().map(|standard| LogChannel {
        topic: standard.topic,
        name: standard.topic.into(),
        interface: standard.interface.into(),
        definition: standard.definition(),
        quality: standard.quality(),
        sources: standard.sources.iter().map(|topic| topic.name).collect(),
    });
    let logged = TOPICS.iter().filter(|topic| topic.logged);
    standard.chain(logged.filter_map(|topic| with_type(topic.name, Describe))).collect()
}

struct Describe;

impl ForType<LogChannel> for Describe {
    fn call<T: Record>(self, topic: &'static Topic) -> LogChannel {
        LogChannel {
            topic: topic.name,
            name: channel_name(topic.name),
            interface: interface::<T>(),
            definition: definition::<T>(),
            quality: "",
            sources: vec![topic.name],
        }
    }
}

/// One message, ready to be written or sent.
#[derive(Clone, Copy, Debug)]
pub struct ComposedMessage<'a> {
    /// Place of its channel in [`channels`].
    pub channel: usize,
    /// \[ns\] Stamp of its record; 0: it has none. [`LogTime`] makes the time of the log of it.
    pub stamp_ns: u64,
    /// CDR with encapsulation header.
    pub payload: &'a [u8],
}

/// Receiver of messages.
pub type Out<'a> = dyn FnMut(ComposedMessage<'_>) + 'a;

/// Maker of all messages of one run.
pub struct Composer {
    /// Topics of the channels, by their places.
    topics: Vec<&'static str>,
    robot: RobotInfo,
    links: Option<Box<dyn LinkPoses>>,
    poses: Vec<RecordedPose>,
    encoder: CdrEncoder,
    words: Words,
    odometry: Odometry,
    time: LogTime,
    /// \[ns\] Bus cycle: how much later than its stamp the simulated state is what it says.
    cycle_ns: u64,
    /// Stamps from which the next standard messages of sensors, stabilizer and simulation are due \[ns\].
    next_ns: [u64; 3],
}

impl Composer {
    /// Of a robot in a run.
    pub fn new(robot: &RobotInfo, run: &RunInfo) -> Self {
        Self {
            topics: channels().iter().map(|channel| channel.topic).collect(),
            robot: robot.clone(),
            links: None,
            poses: Vec::new(),
            encoder: CdrEncoder::new(),
            words: Words { joints: robot.joints.clone(), ..Words::default() },
            odometry: Odometry::default(),
            time: LogTime::new(run.clock.clone()),
            cycle_ns: run.cycle_ns,
            next_ns: [0; 3],
        }
    }

    /// With the pose of every link as `/tf`. Without it there is the true torso alone.
    pub fn with_links(mut self, links: Box<dyn LinkPoses>) -> Self {
        self.poses = vec![RecordedPose::IDENTITY; links.links().len()];
        self.links = Some(links);
        self
    }

    /// Place of the channel of a topic; none: it is not logged.
    pub fn place(&self, topic: &str) -> Option<usize> {
        self.topics.iter().position(|known| *known == topic)
    }

    /// Messages that are said once: the robot, and the frames that never move.
    pub fn describe(&mut self, out: &mut Out<'_>) {
        standard::text(&mut self.encoder, &self.robot.urdf);
        self.put(ROBOT_DESCRIPTION.topic, 0, out);
        let links = match &mut self.links {
            Some(links) => {
                links.poses(&RecordedPose::IDENTITY, &[0.0; MAX_JOINTS], &mut self.poses);
                links.links()
            }
            None => &[],
        };
        standard::tf_static(&mut self.encoder, self.time.at(0), &self.robot, links, &self.poses);
        self.put(TF_STATIC.topic, 0, out);
    }

    /// Messages of one record: its own, if its topic is logged, then the standard ones that follow from it.
    pub fn compose<T: Record>(&mut self, topic: &Topic, record: &T, out: &mut Out<'_>) {
        self.encoder.encode(record);
        self.put(topic.name, record.header().stamp_ns, out);
        let any: &dyn Any = record;
        if let Some(sensors) = any.downcast_ref::<Sensors>() {
            self.show_sensors(sensors, out);
        } else if let Some(state) = any.downcast_ref::<ControllerState>() {
            self.show_state(state, out);
        } else if let Some(plan) = any.downcast_ref::<Plan>() {
            self.odometry.plan(plan);
        } else if let Some(state) = any.downcast_ref::<SimState>() {
            self.show_truth(state, out);
        } else if let Some(event) = any.downcast_ref::<Event>().filter(|_| topic.name.starts_with("events/"))
        {
            let stamp = self.time.at(event.header.stamp_ns);
            rosout::log(&mut self.encoder, stamp, topic.writer.name(), event, &self.words);
            self.put(ROSOUT.topic, event.header.stamp_ns, out);
        }
    }

    fn show_sensors(&mut self, sensors: &Sensors, out: &mut Out<'_>) {
        let stamp = sensors.header.stamp_ns;
        if !due(&mut self.next_ns[0], stamp) {
            return;
        }
        // Joints, inertial measurement unit and feet, as they were measured.
        let time = self.time.at(stamp);
        let mut torques = [f64::NAN; MAX_JOINTS];
        let known = self.links.as_mut().is_some_and(|links| links.torques(sensors, &mut torques));
        let torques = known.then_some(&torques);
        standard::joint_state(&mut self.encoder, time, &self.robot, sensors, torques);
        self.put(JOINT_STATES.topic, stamp, out);
        standard::imu(&mut self.encoder, time, sensors);
        self.put(IMU.topic, stamp, out);
        for (foot, channel) in FOOT_WRENCH.iter().enumerate() {
            standard::foot_wrench(&mut self.encoder, time, sensors, foot);
            self.put(channel.topic, stamp, out);
        }
        if let Some((sensors, state)) = self.odometry.sensors(sensors) {
            self.show_believed(&sensors, &state, out);
        }
    }

    fn show_state(&mut self, state: &ControllerState, out: &mut Out<'_>) {
        if !due(&mut self.next_ns[1], state.header.stamp_ns) {
            return;
        }
        if let Some((sensors, state)) = self.odometry.state(state) {
            self.show_believed(&sensors, &state, out);
        }
    }

    /// The robot as its sensors and its stabilizer know it.
    fn show_believed(&mut self, sensors: &Sensors, state: &ControllerState, out: &mut Out<'_>) {
        let stamp = sensors.header.stamp_ns;
        let (time, plan) = (self.time.at(stamp), self.odometry.planned(state));
        markers::believed(&mut self.encoder, time, &self.robot, (sensors, state), &plan);
        self.put(MARKERS.topic, stamp, out);
        // Links in the torso frame first: the torso is put where the stance foot says.
        let Some(links) = &mut self.links else { return };
        links.poses(&RecordedPose::IDENTITY, &sensors.joint_angle, &mut self.poses);
        let foot = &self.robot.feet[0];
        let Some(at) = links.links().iter().position(|link| link.name == foot.link) else { return };
        let sole = self.poses[at].then(&RecordedPose::moved(foot.sole));
        let Some(torso) = odometry::torso(sensors, state, plan.height, &sole) else { return };
        links.poses(&torso, &sensors.joint_angle, &mut self.poses);
        standard::tf(&mut self.encoder, time, ODOM, "", links.links(), &self.poses);
        self.put(TF.topic, stamp, out);
    }

    /// The simulated robot as it is: at the end of its cycle, when the next one measures it.
    fn show_truth(&mut self, state: &SimState, out: &mut Out<'_>) {
        let stamp = state.header.stamp_ns + self.cycle_ns;
        if state.header.stamp_ns == 0 || !due(&mut self.next_ns[2], stamp) {
            return;
        }
        let time = self.time.at(stamp);
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
        self.put(TRUTH_TF.topic, stamp, out);
        markers::truth(&mut self.encoder, time, state);
        self.put(TRUTH_MARKERS.topic, stamp, out);
    }

    /// Hands out what the encoder holds; a topic that is not logged is left out.
    fn put(&self, topic: &str, stamp_ns: u64, out: &mut Out<'_>) {
        if let Some(channel) = self.place(topic) {
            out(ComposedMessage { channel, stamp_ns, payload: self.encoder.payload() });
        }
    }
}

/// True if the next standard message is due, on the grid of full periods.
fn due(next_ns: &mut u64, stamp_ns: u64) -> bool {
    let due = stamp_ns >= *next_ns;
    if due {
        *next_ns = (stamp_ns / STANDARD_PERIOD_NS + 1) * STANDARD_PERIOD_NS;
    }
    due
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Channels on which a record of a topic is heard.
    struct Heard<'a>(&'a mut Composer);

    impl ForType<Vec<usize>> for Heard<'_> {
        fn call<T: Record>(self, topic: &'static Topic) -> Vec<usize> {
            let (mut record, mut heard) = (T::empty(), Vec::new());
            record.header_mut().stamp_ns = 5_000_000;
            self.0.compose(topic, &record, &mut |message| heard.push(message.channel));
            heard
        }
    }

    /// Whoever follows the sources of a channel misses none of its messages, and each channel has some.
    #[test]
    fn messages_come_from_the_sources_of_their_channel() {
        let channels = channels();
        let mut composer = Composer::new(&RobotInfo::default(), &RunInfo::default());
        let mut spoken = vec![false; channels.len()];
        for topic in TOPICS {
            for channel in with_type(topic.name, Heard(&mut composer)).unwrap() {
                let LogChannel { name, sources, .. } = &channels[channel];
                assert!(
                    sources.contains(&topic.name),
                    "{name} is heard from {}, not only {sources:?}",
                    topic.name
                );
                spoken[channel] = true;
            }
        }
        composer.describe(&mut |message| {
            assert!(channels[message.channel].sources.is_empty(), "{}", channels[message.channel].name);
            spoken[message.channel] = true;
        });
        let silent: Vec<&str> =
            channels.iter().zip(&spoken).filter(|(_, spoken)| !**spoken).map(|(c, _)| c.topic).collect();
        // Links are not known here.
        assert_eq!(silent, ["/tf"]);
    }
}
