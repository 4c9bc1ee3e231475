//! Instruments of the simulated robot: from its true motion to the readings on the bus, and the truth beside them.

use std::error::Error;

use codec::frames::encode_answers;
use config::{Robot, Scene};
use messages::{
    BusFrames, ContactPoint, Detail, EventCode, EventQueue, Header, Imu, Sensors, SimState, Wrench,
};
use multibody::Frame;
use nalgebra::Vector3;

use crate::body::SimulatedBody;
use crate::joints::SimulatedJoints;
use crate::layout::orientation;
use crate::plant::{Plant, PlantInputs, Snapshot};
use crate::sensors::{SensorSet, Truth, carried};

/// Sensors of one robot, with the records that they fill.
#[derive(Clone)]
pub(crate) struct Instruments {
    sensors: SensorSet,
    /// Frames of the force sensors; right, left.
    force_frames: [Frame; 2],
    /// \[m\] @torso Inertial measurement unit.
    imu: Vector3<f64>,
    readings: Sensors,
    frames: BusFrames,
    state: SimState,
}

impl Instruments {
    /// Sensors of a robot in a scene, on which nothing was measured yet.
    ///
    /// # Errors
    /// A force sensor is on no link of the robot.
    pub(crate) fn new(robot: &Robot, scene: &Scene, plant: &Plant) -> Result<Self, Box<dyn Error>> {
        let frame = |i: usize| plant.model().frame(&robot.feet[i].sensor_link, robot.feet[i].sensor);
        let force_frames = [frame(0)?, frame(1)?];
        let hanging =
            carried::hanging(plant.model(), &force_frames, &plant.of_moving(&robot.poses[&scene.start_pose]));
        Ok(Self {
            sensors: SensorSet::new(
                &scene.sensors,
                robot,
                &hanging,
                scene.seed,
                (scene.cycle, scene.substeps),
            ),
            force_frames,
            imu: Vector3::from(robot.imu),
            readings: Sensors::default(),
            frames: BusFrames::default(),
            state: SimState::default(),
        })
    }

    /// Newest readings.
    pub(crate) fn readings(&self) -> &Sensors {
        &self.readings
    }

    /// Readings as frames of the bus.
    pub(crate) fn frames(&self) -> &BusFrames {
        &self.frames
    }

    /// The same, for faults of the bus.
    pub(crate) fn frames_mut(&mut self) -> &mut BusFrames {
        &mut self.frames
    }

    /// The truth beside them.
    pub(crate) fn state(&self) -> &SimState {
        &self.state
    }

    /// Begins the records of a cycle.
    pub(crate) fn stamp(&mut self, header: Header) {
        self.readings.header = header;
        self.state.header = header;
    }

    /// Writes the readings on the bus.
    pub(crate) fn encode(&mut self, robot: &Robot, joints: &mut SimulatedJoints) {
        let replies = joints.replies(&self.readings.drive_error);
        encode_answers(&robot.layout, &self.readings, &replies, &mut self.frames);
    }

    /// Writes readings and truth at `time` \[s\]; false if a reading is NaN and none may go on the bus.
    pub(crate) fn measure(
        &mut self,
        time: f64,
        body: &mut SimulatedBody,
        joints: &SimulatedJoints,
        snapshot: &Snapshot,
        inputs: &PlantInputs,
        events: &mut EventQueue,
    ) -> bool {
        let (plant, x) = body.parts();
        let mut seen = self.see(plant, x, joints.motions().len());
        (self.state.joint_angle, self.state.motor_angle) = (seen.joint_angle, seen.motor_angle);
        plant.hold_locked(&mut self.state.joint_angle);
        plant.hold_locked(&mut self.state.motor_angle);
        add_reading_errors(joints, &mut seen);
        let report = self.sensors.measure(&seen, &mut self.readings);
        joints.electronics().report(&mut self.readings);
        self.write_truth(time, plant, x, snapshot, inputs);
        if report.invalid > 0 {
            events.push(EventCode::SensorNotFinite, Detail::Count(report.invalid.into()));
        }
        if report.clipped > 0 {
            events.push(EventCode::SensorClipped, Detail::Count(report.clipped.into()));
        }
        report.invalid == 0
    }

    /// True if [`Instruments::observe`] is to see the steps within a cycle.
    pub(crate) fn is_analogue(&self) -> bool {
        self.sensors.is_analogue()
    }

    /// One more step of the integration within a cycle, which the plant has looked at.
    pub(crate) fn observe(&mut self, plant: &mut Plant, x: &[f64], joints: &SimulatedJoints) {
        let mut seen = self.see(plant, x, joints.motions().len());
        add_reading_errors(joints, &mut seen);
        self.sensors.observe(&seen);
    }

    /// True values of all sensors in a state that the plant has looked at.
    fn see(&self, plant: &mut Plant, x: &[f64], joints: usize) -> Truth {
        let mut seen = Truth { motor_current: [f64::NAN; messages::MAX_JOINTS], ..Truth::default() };
        for j in 0..joints {
            (seen.joint_angle[j], seen.joint_speed[j]) = plant.joint(j);
        }
        // A motor turns as its joint, but where an elastic gear has a rotor of its own.
        (seen.motor_angle, seen.motor_speed) = (seen.joint_angle, seen.joint_speed);
        plant.motors(x, &mut seen.motor_angle, &mut seen.motor_speed, &mut seen.motor_current);
        self.see_forces(plant, &mut seen);
        seen.imu = self.see_imu(plant, x);
        seen
    }

    /// Wrenches on the force sensors: of the ground, moved there from the soles, and of the bodies below.
    fn see_forces(&self, plant: &mut Plant, seen: &mut Truth) {
        for i in 0..2 {
            let pose = plant.frame_pose(&self.force_frames[i]);
            let (sole, force, moment) = plant.sole_load(i);
            let moment = moment + (sole - pose.translation.vector).cross(&force);
            let back = pose.rotation.inverse();
            seen.contact[i] = Wrench { force: (back * force).into(), moment: (back * moment).into() };
        }
        if self.sensors.needs_inertia() {
            seen.inertial = plant.carried(&self.force_frames);
        }
    }

    /// Motion of the inertial measurement unit, which is not at the torso's origin.
    fn see_imu(&self, plant: &Plant, x: &[f64]) -> Imu {
        let speed = &x[plant.layout().speed()];
        let omega = Vector3::from_column_slice(&speed[3..6]);
        let (specific_force, angular_acceleration) = plant.torso_acceleration(x);
        let lever = angular_acceleration.cross(&self.imu) + omega.cross(&omega.cross(&self.imu));
        Imu {
            orientation: orientation(x).coords.into(),
            angular_velocity: omega.into(),
            acceleration: (specific_force + lever).into(),
        }
    }

    fn write_truth(&mut self, time: f64, plant: &Plant, x: &[f64], s: &Snapshot, inputs: &PlantInputs) {
        let speed = &x[plant.layout().speed()];
        let truth = &mut self.state;
        truth.time = time;
        truth.position = [x[0], x[1], x[2]];
        truth.orientation = orientation(x).coords.into();
        truth.velocity = [speed[0], speed[1], speed[2]];
        truth.angular_velocity = [speed[3], speed[4], speed[5]];
        truth.com = s.com.into();
        truth.foot_wrench = s.foot_wrench;
        truth.feet = s.feet;
        let (carrying, before) = (plant.carrying(), truth.contacts as usize);
        truth.contacts = carrying.len() as u64;
        truth.contact[..carrying.len()].copy_from_slice(carrying);
        truth.contact[carrying.len()..before.max(carrying.len())].fill(ContactPoint::default());
        truth.push = inputs.forces.push;
        truth.object_delay.iter_mut().zip(plant.object_delays()).for_each(|(to, delay)| *to = delay);
        truth.rope = inputs.forces.rope.map_or(0.0, |rope| rope.tension(x, speed));
    }

    /// Writes whether the motors have power, and whether the robot has fallen.
    pub(crate) fn note(&mut self, powered: bool, fallen: bool) {
        (self.readings.power, self.state.power) = (u64::from(powered), u64::from(powered));
        self.state.fallen = u64::from(fallen);
    }
}

/// Adds what each joint's encoders read too much.
fn add_reading_errors(joints: &SimulatedJoints, seen: &mut Truth) {
    for j in 0..joints.motions().len() {
        let error = joints.reading_error(j);
        if error != 0.0 {
            seen.joint_angle[j] += error;
            seen.motor_angle[j] += error;
        }
    }
}
