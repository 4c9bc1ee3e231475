//! Metadata of a log: robot, scene, configuration, software.

use std::collections::BTreeMap;

/// The robot of a log: all that a reader needs to draw it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RobotInfo {
    /// Name of the robot.
    pub name: String,
    /// Joint names in the order of every array of joints.
    pub joints: Vec<String>,
    /// Text of the URDF.
    pub urdf: String,
    /// Link that is the floating base.
    pub torso: String,
    /// \[m\] Origin of the inertial measurement unit in the torso frame.
    pub imu: [f64; 3],
    /// Right and left foot.
    pub feet: [FootInfo; 2],
    /// \[m, m, rad\] Pose of the frame `odom` in the simulated world; zeros of a real robot.
    pub odom: [f64; 3],
}

/// One foot of [`RobotInfo`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FootInfo {
    /// Link that carries the sole frame.
    pub link: String,
    /// \[m\] Origin of the sole frame in that link.
    pub sole: [f64; 3],
    /// \[m\] Support rectangle in the sole frame: x back, x front, y right, y left.
    pub support: [f64; 4],
    /// Link whose wrench the force/torque sensor measures.
    pub sensor_link: String,
    /// \[m\] Origin of the sensor frame in that link.
    pub sensor: [f64; 3],
}

/// The run of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunInfo {
    /// Name of the scene; empty on a real robot.
    pub scene: String,
    /// Hash of the configuration.
    pub config_hash: u64,
    /// Version of the software that ran.
    pub software: String,
    /// Git commit that it was built from; empty: unknown.
    pub commit: String,
    /// Seed of everything random.
    pub seed: u64,
    /// \[ns\] Bus cycle.
    pub cycle_ns: u64,
    /// Of a run in real time; none in simulated time, which begins at 0, so that equal runs give equal logs.
    pub clock: Option<WallClock>,
}

/// Host and start time of a run in real time.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct WallClock {
    /// \[ns\] Since 1970, at its start.
    pub unix_ns: u64,
    /// \[ns\] CLOCK_MONOTONIC at that instant: stamps of records count by it.
    pub monotonic_ns: u64,
    /// Name of the machine.
    pub host: String,
}

impl WallClock {
    /// \[ns\] Wall time at a stamp; both clocks are compared once, so that time in a log never jumps.
    pub fn unix_ns(&self, stamp_ns: u64) -> u64 {
        (self.unix_ns + stamp_ns).saturating_sub(self.monotonic_ns)
    }

    /// \[ns\] The stamp at a wall time.
    pub(crate) fn stamp_ns(&self, unix_ns: u64) -> u64 {
        (unix_ns + self.monotonic_ns).saturating_sub(self.unix_ns)
    }

    /// The start as a date (RFC 3339).
    pub fn date(&self) -> String {
        let start = std::time::UNIX_EPOCH + std::time::Duration::from_nanos(self.unix_ns);
        humantime::format_rfc3339_nanos(start).to_string()
    }
}

/// Names of the sides in topics, frames and metadata; index as everywhere: right, left.
pub(crate) const SIDES: [&str; 2] = ["right", "left"];

/// Name of the metadata record.
pub(crate) const METADATA: &str = "gangwerk";

/// Both as the text pairs of a metadata record. The URDF travels as `/robot_description`.
pub(crate) fn to_metadata(robot: &RobotInfo, run: &RunInfo) -> BTreeMap<String, String> {
    let mut map = BTreeMap::from([
        ("scene".into(), run.scene.clone()),
        ("config_hash".into(), format!("{:016x}", run.config_hash)),
        ("software".into(), run.software.clone()),
        ("robot".into(), robot.name.clone()),
        ("joints".into(), robot.joints.join(" ")),
        ("torso".into(), robot.torso.clone()),
        ("imu".into(), numbers(&robot.imu)),
        ("odom".into(), numbers(&robot.odom)),
        ("commit".into(), run.commit.clone()),
        ("seed".into(), run.seed.to_string()),
        ("cycle_ns".into(), run.cycle_ns.to_string()),
    ]);
    if let Some(clock) = &run.clock {
        map.insert("started".into(), clock.date());
        map.insert("started_monotonic_ns".into(), clock.monotonic_ns.to_string());
        map.insert("host".into(), clock.host.clone());
    }
    for (side, foot) in SIDES.iter().zip(&robot.feet) {
        map.insert(format!("{side}_foot.link"), foot.link.clone());
        map.insert(format!("{side}_foot.sole"), numbers(&foot.sole));
        map.insert(format!("{side}_foot.support"), numbers(&foot.support));
        map.insert(format!("{side}_foot.sensor_link"), foot.sensor_link.clone());
        map.insert(format!("{side}_foot.sensor"), numbers(&foot.sensor));
    }
    map
}

/// The inverse of [`to_metadata`]; what is missing stays empty.
pub(crate) fn from_metadata(map: &BTreeMap<String, String>) -> (RobotInfo, RunInfo) {
    let text = |key: &str| map.get(key).cloned().unwrap_or_default();
    let foot = |side: &str| FootInfo {
        link: text(&format!("{side}_foot.link")),
        sole: parse(&text(&format!("{side}_foot.sole"))),
        support: parse(&text(&format!("{side}_foot.support"))),
        sensor_link: text(&format!("{side}_foot.sensor_link")),
        sensor: parse(&text(&format!("{side}_foot.sensor"))),
    };
    let robot = RobotInfo {
        name: text("robot"),
        joints: text("joints").split_whitespace().map(String::from).collect(),
        urdf: String::new(),
        torso: text("torso"),
        imu: parse(&text("imu")),
        odom: parse(&text("odom")),
        feet: SIDES.map(foot),
    };
    let run = RunInfo {
        scene: text("scene"),
        config_hash: u64::from_str_radix(&text("config_hash"), 16).unwrap_or(0),
        software: text("software"),
        commit: text("commit"),
        seed: text("seed").parse().unwrap_or(0),
        cycle_ns: text("cycle_ns").parse().unwrap_or(0),
        clock: clock(&text("started"), &text("started_monotonic_ns"), text("host")),
    };
    (robot, run)
}

fn clock(started: &str, monotonic_ns: &str, host: String) -> Option<WallClock> {
    let start = humantime::parse_rfc3339(started).ok()?.duration_since(std::time::UNIX_EPOCH).ok()?;
    Some(WallClock { unix_ns: start.as_nanos() as u64, monotonic_ns: monotonic_ns.parse().ok()?, host })
}

fn numbers(values: &[f64]) -> String {
    values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")
}

fn parse<const N: usize>(text: &str) -> [f64; N] {
    let mut values = text.split_whitespace().map(|word| word.parse().unwrap_or(0.0));
    std::array::from_fn(|_| values.next().unwrap_or(0.0))
}
