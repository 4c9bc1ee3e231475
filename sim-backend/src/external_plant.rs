//! External plant: another simulator at the far end of the chain, in place of the simulated robot.
//!
//! It is asked once per bus cycle, over a Unix socket, and everything waits for it. What crosses the socket, and in which
//! order, is docs/external_plant.md. On this side of it: the frames of the bus, the motor supply's relay, electronics and
//! references of the drives, pushes of the scene, and whether the robot has fallen.

use std::error::Error;
use std::io::{self, ErrorKind, Read, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::time::Duration;

use codec::frames::encode_sensors;
use config::components::JointModel;
use config::method::{Integrator, Method};
use config::terrain::{ObjectShape, TerrainObject, TerrainPose};
use config::{Robot, Scene, Setup};
use messages::{
    BusFrames, Detail, EventCode, EventQueue, Header, MAX_CONTACTS, Power, Sensors, SimState, Wrench,
};
use realtime::clock::now;
use serde_json::{Value, json};

use crate::SimBackend;
use crate::fall::FallWatch;
use crate::inputs::DriveSwitches;
use crate::joints::SimulatedJoints;
use crate::loads::Loads;
use crate::power::PowerLine;

/// Version of the protocol.
pub const VERSION: u64 = 1;

/// \[1\] Most that the norm of an orientation differs from 1.
const UNIT: f64 = 1e-3;
/// \[SI\] Numbers of an answer are not larger.
const MOST: f64 = 1e6;

/// Task of a drive in a cycle, on the socket.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum DriveTask {
    /// No torque.
    Off = 0,
    /// Leads its joint to the target by the end of the cycle.
    Follow = 1,
    /// Had no torque yet: whoever set the robot up holds the joint where it is.
    Held = 2,
}

/// Robot behind a socket.
pub struct ExternalPlant {
    stream: UnixStream,
    name: String,
    /// \[s\] Time it may take for an answer.
    timeout: f64,
    /// \[s\] Bus cycle.
    cycle: f64,
    robot: Robot,
    power: PowerLine,
    joints: SimulatedJoints,
    loads: Loads,
    fall: FallWatch,
    cycles: u64,
    bytes: Vec<u8>,
    readings: Sensors,
    frames: BusFrames,
    state: SimState,
    events: EventQueue,
}

impl ExternalPlant {
    /// The robot of a scene behind the socket at `path`, after its first readings. Answers may take the system's
    /// `peer_timeout`.
    ///
    /// # Errors
    /// The scene asks for what only our own simulated robot has, or the first readings do not come.
    pub fn connect(path: &Path, setup: &Setup) -> Result<Self, Box<dyn Error>> {
        let Setup { scene, robot, system, .. } = setup;
        let name = format!("external plant at {}", path.display());
        if let Some(key) = ours_alone(scene) {
            let why = "only the simulated robot of this program has that";
            return Err(format!("scene {}: `{key}` and an {name}: {why}", scene.name).into());
        }
        // Where it is to stand is where ours would.
        let mut ideal = scene.clone();
        ideal.choose(Method { depth: 1, integrator: Integrator::Euler, substeps: 1 });
        let ours = SimBackend::new(robot, &ideal)?;
        let start = ours.state();
        let stream = UnixStream::connect(path).map_err(|e| format!("{name}: cannot be reached: {e}"))?;
        let limit = Some(Duration::from_secs_f64(system.peer_timeout));
        stream.set_read_timeout(limit)?;
        stream.set_write_timeout(limit)?;
        let mut plant = Self {
            stream,
            name,
            timeout: system.peer_timeout,
            cycle: scene.cycle,
            robot: robot.clone(),
            power: PowerLine::falling_after(system.toggle_missed),
            joints: SimulatedJoints::new(robot, scene),
            loads: Loads::of_pushes(scene),
            fall: FallWatch::new(start.position[2]),
            cycles: 0,
            bytes: Vec::new(),
            readings: Sensors::default(),
            frames: BusFrames::default(),
            state: SimState::default(),
            events: EventQueue::default(),
        };
        plant.bytes = format!("{}\n", hello(robot, scene, start)).into();
        plant.send(0)?;
        plant.step(None, None)?;
        Ok(plant)
    }

    /// Events that were not taken yet.
    pub fn events(&mut self) -> &mut EventQueue {
        &mut self.events
    }

    /// Newest readings as frames of the bus.
    pub fn frames(&self) -> &BusFrames {
        &self.frames
    }

    /// One bus cycle, as [`SimBackend::step`].
    ///
    /// # Errors
    /// No answer, or one that is none.
    pub fn step(
        &mut self,
        frames: Option<&BusFrames>,
        power: Option<&Power>,
    ) -> Result<(&BusFrames, &SimState), String> {
        let powered = self.power.step(power);
        let header = frames.map_or(Header::default(), |f| f.header);
        let push = self.loads.push_at((self.cycles as f64 + 0.5) * self.cycle);
        let (switches, stopped) = self.joints.begin_cycle(
            &self.robot,
            JointModel::Motors,
            frames,
            powered,
            &self.readings,
            self.cycle,
        );
        if let Some(node) = stopped {
            self.events.push(EventCode::NodeStopped, Detail::Node(node));
        }
        // The socket: there and back.
        self.write_targets(header.tick, powered, push, &switches);
        self.send(header.tick)?;
        let numbers = self.receive(header.tick)?;
        self.read_answer(header.tick, &numbers)?;
        self.joints.end_cycle(self.cycle);
        self.cycles += 1;
        // What goes with the readings.
        self.joints.electronics().report(&mut self.readings);
        (self.readings.header, self.state.header) = (header, header);
        (self.readings.power, self.state.power) = (u64::from(powered), u64::from(powered));
        (self.state.time, self.state.push) = (self.cycles as f64 * self.cycle, push);
        encode_sensors(&self.robot.layout, &self.readings, &mut self.frames);
        let pose = [&self.state.position[..], &self.state.orientation[..]].concat();
        if self.fall.begins(&pose, self.cycle) {
            self.events.push(EventCode::Fallen, Detail::Nothing);
        }
        self.state.fallen = u64::from(self.fall.has_fallen());
        Ok((&self.frames, &self.state))
    }

    /// Message of a cycle: see the page.
    fn write_targets(&mut self, tick: u64, powered: bool, push: [f64; 3], switches: &DriveSwitches) {
        let goals: Vec<_> = self.joints.references().iter().map(|r| r.at(self.cycle)).collect();
        let task = |j: usize| match () {
            () if switches.is_held(j) => DriveTask::Held,
            () if switches.has_torque(j) => DriveTask::Follow,
            () => DriveTask::Off,
        };
        let numbers = [f64::from(u8::from(powered))]
            .into_iter()
            .chain(push)
            .chain(goals.iter().map(|goal| goal.angle))
            .chain(goals.iter().map(|goal| goal.speed))
            .chain((0..goals.len()).map(|j| f64::from(task(j) as u8)));
        let count = 4 + 3 * goals.len() as u64;
        self.bytes.clear();
        self.bytes.extend([tick, count].into_iter().flat_map(u64::to_le_bytes));
        self.bytes.extend(numbers.flat_map(f64::to_le_bytes));
    }

    fn send(&mut self, tick: u64) -> Result<(), String> {
        self.stream.write_all(&self.bytes).map_err(|e| self.broken(tick, &e))
    }

    /// Numbers of the answer to cycle `tick`.
    fn receive(&mut self, tick: u64) -> Result<Vec<f64>, String> {
        let (mut head, by) = ([[0; 8]; 2], now() + (1e9 * self.timeout) as u64);
        read_by(&mut self.stream, head.as_flattened_mut(), by).map_err(|e| self.broken(tick, &e))?;
        let ([of, count], expected) = (head.map(u64::from_le_bytes), answer_len(self.robot.joints.len()));
        if of != tick {
            return Err(self.wrong(tick, &format!("answered cycle {of}")));
        }
        if count != expected as u64 {
            return Err(self.wrong(tick, &format!("{count} numbers instead of {expected}")));
        }
        self.bytes.resize(8 * expected, 0);
        read_by(&mut self.stream, &mut self.bytes, by).map_err(|e| self.broken(tick, &e))?;
        Ok(self.bytes.as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect())
    }

    /// Takes readings and truth over.
    fn read_answer(&mut self, tick: u64, numbers: &[f64]) -> Result<(), String> {
        let n = self.robot.joints.len();
        let mut rest = numbers;
        let mut problem = None;
        let mut take = |name: &str, out: &mut [f64], may_be_nan: bool| {
            let (now, later) = rest.split_at(out.len());
            out.copy_from_slice(now);
            rest = later;
            if let Some(i) = now.iter().position(|x| !(x.abs() <= MOST || may_be_nan && x.is_nan())) {
                problem = problem.take().or(Some(format!("{name}[{i}] is {:?}, which no robot has", now[i])));
            }
        };
        let s = &mut self.readings;
        take("joint_angle", &mut s.joint_angle[..n], false);
        take("joint_speed", &mut s.joint_speed[..n], false);
        take("motor_angle", &mut s.motor_angle[..n], false);
        take("motor_speed", &mut s.motor_speed[..n], false);
        take("motor_current", &mut s.motor_current[..n], true);
        for Wrench { force, moment } in &mut s.foot_wrench {
            take("foot_wrench", force, false);
            take("foot_wrench", moment, false);
        }
        take("imu.orientation", &mut s.imu.orientation, false);
        take("imu.angular_velocity", &mut s.imu.angular_velocity, false);
        take("imu.acceleration", &mut s.imu.acceleration, false);
        // The truth, which no controller sees.
        let truth = &mut self.state;
        take("position", &mut truth.position, false);
        take("orientation", &mut truth.orientation, false);
        take("velocity", &mut truth.velocity, false);
        take("angular_velocity", &mut truth.angular_velocity, false);
        take("com", &mut truth.com, false);
        for Wrench { force, moment } in &mut truth.foot_wrench {
            take("ground_wrench", force, false);
            take("ground_wrench", moment, false);
        }
        truth.feet.iter_mut().for_each(|foot| take("feet", foot, false));
        let mut contacts = [0.0];
        take("contacts", &mut contacts, false);
        for point in &mut truth.contact {
            take("contact.place", &mut point.place, false);
            take("contact.normal", &mut point.normal, false);
        }
        // A count, which the cast saturates.
        truth.contacts = contacts[0] as u64;
        if truth.contacts as f64 != contacts[0] || truth.contacts > MAX_CONTACTS as u64 {
            problem = problem.or(Some(format!("contacts is {}; it takes 0 to {MAX_CONTACTS}", contacts[0])));
        }
        for orientation in [s.imu.orientation, truth.orientation] {
            let norm = orientation.iter().map(|x| x * x).sum::<f64>().sqrt();
            if !((norm - 1.0).abs() <= UNIT) {
                problem = problem.or(Some(format!("an orientation has the norm {norm}")));
            }
        }
        (truth.joint_angle, truth.motor_angle) = (s.joint_angle, s.motor_angle);
        self.joints.look(|j| (s.joint_angle[j], s.joint_speed[j]));
        problem.map_or(Ok(()), |problem| Err(self.wrong(tick, &problem)))
    }

    fn wrong(&self, tick: u64, what: &str) -> String {
        format!("{}: {what}, in cycle {tick}", self.name)
    }

    fn broken(&self, tick: u64, error: &io::Error) -> String {
        let what = match error.kind() {
            ErrorKind::WouldBlock | ErrorKind::TimedOut => {
                format!("did not answer within {} s", self.timeout)
            }
            ErrorKind::UnexpectedEof | ErrorKind::BrokenPipe | ErrorKind::ConnectionReset => {
                "closed the connection".into()
            }
            _ => error.to_string(),
        };
        self.wrong(tick, &what)
    }
}

/// Fills `bytes` until the time `by` \[ns\].
fn read_by(stream: &mut UnixStream, mut bytes: &mut [u8], by: u64) -> io::Result<()> {
    while !bytes.is_empty() {
        let left = by.checked_sub(now()).filter(|left| *left > 0).ok_or(ErrorKind::TimedOut)?;
        stream.set_read_timeout(Some(Duration::from_nanos(left)))?;
        match stream.read(bytes) {
            Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
            Ok(count) => bytes = &mut bytes[count..],
            Err(e) if e.kind() == ErrorKind::Interrupted => {}
            Err(e) => return Err(e),
        }
    }
    Ok(())
}

/// \[1\] Numbers of an answer, for a robot with so many joints.
pub fn answer_len(joints: usize) -> usize {
    5 * joints + 12 + 10 + 16 + 12 + 8 + 1 + 6 * MAX_CONTACTS
}

/// A table of the scene that asks for something of our own simulated robot.
fn ours_alone(scene: &Scene) -> Option<&'static str> {
    let asked = [
        ("crane", scene.crane.is_some()),
        ("drives", scene.drives.is_some()),
        ("bus_fault", !scene.bus_faults.is_empty()),
        ("plant_mismatch", scene.plant_mismatch != Default::default()),
        ("sensors", scene.sensors != Default::default()),
        ("joint_control", scene.joint_control.is_some()),
        ("components", !scene.components.is_empty()),
    ];
    asked.into_iter().find(|(_, asked)| *asked).map(|(key, _)| key)
}

/// \[kg m^2\] Rotors as their joints feel them at angles `q` \[rad\].
fn rotor_inertia(robot: &Robot, q: &[f64]) -> Vec<f64> {
    let mut inertia = vec![0.0; robot.joints.len()];
    for drive in &robot.drives {
        let mut angle = [0.0; 3];
        angle.iter_mut().zip(&drive.joints).for_each(|(angle, &j)| *angle = q[j]);
        let ratio = drive.transmission.at(angle, [0.0; 3]).unwrap_or_default().ratio;
        for (&j, ratio) in drive.joints.iter().zip(ratio) {
            inertia[j] += drive.rotor_inertia * ratio * ratio;
        }
    }
    inertia
}

/// The first line on the socket.
fn hello(robot: &Robot, scene: &Scene, start: &SimState) -> Value {
    let joints: Vec<&str> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
    json!({
        "gangwerk_plant": VERSION,
        "robot": scene.robot,
        "scene": scene.name,
        "cycle": scene.cycle,
        "duration": scene.duration,
        "joints": joints,
        "joint_angle": robot.poses[&scene.start_pose],
        "rotor_inertia": rotor_inertia(robot, &robot.poses[&scene.start_pose]),
        "position": start.position,
        "orientation": start.orientation,
        "answer": answer_len(robot.joints.len()),
        "objects": scene.objects.iter().map(object).collect::<Vec<_>>(),
    })
}

fn object(object: &TerrainObject) -> Value {
    let pose = |pose: &TerrainPose| json!({ "position": pose.position, "rotation": pose.rotation });
    let mut value = json!({
        "name": object.name,
        "pose": pose(&object.pose),
        "friction": object.friction,
        "appears": object.appears,
        "vanishes": object.vanishes, // null: never
        "keeps_clear": object.keeps_clear,
        "poses": object.poses.iter().map(|(time, at)| json!({ "time": time, "pose": pose(at) })).collect::<Vec<_>>(),
    });
    match &object.shape {
        ObjectShape::Box(size) => value["box"] = json!(size),
        ObjectShape::Mesh { file, scale, .. } => {
            (value["mesh"], value["scale"]) = (json!(file.display().to_string()), json!(scale));
        }
    }
    value
}
