//! Sight of a robot: its pose and odometry, from what sensors and stabilizer say.

use std::error::Error;

use config::Setup;
use messages::command::{Command, FixateCommand};
use messages::{ControllerState, Sensors};
use multibody::{Data, Frame, Model};
use recording::{RecordedPose, odometry};

use crate::trigger::{Frames, Odometry};

/// Bound of the error of the place: share of the way.
const PLACE_SHARE: f64 = 0.05;
/// Bound of the error of the heading: of a walk at all \[rad\], per metre of its way \[rad/m\], and share of its turn.
const HEADING_ERROR: f64 = 0.03;
const HEADING_PER_WAY: f64 = 0.02;
const HEADING_SHARE: f64 = 0.1;

/// A robot at one instant.
#[derive(Clone, Copy)]
pub struct Sight {
    /// Bus cycle.
    pub cycle: u64,
    /// A [`GaitState`](messages::GaitState).
    pub gait: u64,
    /// Place of the planning frame.
    pub odometry: Odometry,
    /// Poses of the robot.
    pub frames: Frames,
    /// \[m, m, rad\] @I_0 Place and heading of the torso as the camera head reckons them, less those of the odometry.
    head_offset: [f64; 3],
}

impl Sight {
    /// Command for a robot seen so: a point to look at, told where the odometry has I_0, is put where the head has it.
    pub fn command(&self, command: &Command) -> Command {
        let Command::Fixate(FixateCommand { point }) = command else { return *command };
        let [dx, dy, turn] = self.head_offset;
        let torso = odometry::frame(self.odometry.place).then(&self.frames.torso).position;
        if torso.iter().any(|x| x.is_nan()) {
            return *command;
        }
        let (sin, cos) = turn.sin_cos();
        let [x, y] = [0, 1].map(|i| point[i] - torso[i]);
        let around = [torso[0] + dx + cos * x - sin * y, torso[1] + dy + sin * x + cos * y];
        Command::Fixate(FixateCommand { point: [around[0], around[1], point[2]] })
    }
}

/// Who sees a robot, and remembers the way that it has gone.
pub struct Witness {
    kinematics: Kinematics,
    way: Way,
}

impl Witness {
    /// Of a robot that has not been seen yet.
    ///
    /// # Errors
    /// Its files do not fit together.
    pub fn new(setup: &Setup) -> Result<Self, Box<dyn Error>> {
        Ok(Self { kinematics: Kinematics::new(setup)?, way: Way::default() })
    }

    /// The robot as sensors and stabilizer say, in a plan whose frame is at this `height` \[m\].
    pub fn see(&mut self, sensors: &Sensors, state: &ControllerState, height: f64) -> Sight {
        let planning = odometry::planning_frame(state, height);
        Sight {
            cycle: state.header.tick,
            gait: state.gait,
            odometry: self.way.to(state.origin, planning.position[2]),
            frames: self.kinematics.frames(sensors, state, &planning),
            head_offset: state.head_offset,
        }
    }
}

/// Way of the robot so far. The planning frame goes from foot to foot: between its last two places is her middle.
#[derive(Default)]
struct Way {
    /// \[m, m, rad\] @I_0 The last two places of the planning frame, the newest first; none before the first look.
    places: Option<[[f64; 3]; 2]>,
    /// \[m\]
    length: f64,
    /// \[rad\] Both ways are counted.
    turn: f64,
}

impl Way {
    /// The planning frame is here now, at this height \[m\].
    fn to(&mut self, place: [f64; 3], height: f64) -> Odometry {
        let [x, y, heading] = place;
        // An observer that came after the begin of the walk knows the straight line, at least.
        let [last, before] = *self.places.get_or_insert_with(|| {
            (self.length, self.turn) = (x.hypot(y), heading.abs());
            [place; 2]
        });
        if place != last {
            self.length += 0.5 * (x - before[0]).hypot(y - before[1]);
            self.turn += (heading - last[2]).abs();
            self.places = Some([place, last]);
        }
        let walked = self.length > 0.0 || self.turn > 0.0;
        let heading_error = HEADING_PER_WAY * self.length + HEADING_SHARE * self.turn;
        Odometry {
            place: [x, y, height, heading],
            place_error: PLACE_SHARE * self.length,
            heading_error: heading_error + if walked { HEADING_ERROR } else { 0.0 },
            way: self.length,
        }
    }
}

/// Kinematics of the robot.
struct Kinematics {
    model: Model,
    data: Data,
    q: Vec<f64>,
    soles: [Frame; 2],
    /// None: it has no camera head.
    camera: Option<Frame>,
}

impl Kinematics {
    fn new(setup: &Setup) -> Result<Self, Box<dyn Error>> {
        let robot = &setup.robot;
        let model = robot.model()?;
        let [right, left] = [0, 1].map(|i| model.frame(&robot.feet[i].link, robot.feet[i].sole));
        let camera = robot.head.as_ref().map(|head| model.frame(&head.link, head.camera)).transpose()?;
        let (data, q) = (Data::new(&model), model.neutral());
        Ok(Self { data, q, soles: [right?, left?], camera, model })
    }

    /// Frames in the planning frame: measured joints and inclination, on the foot that the stabilizer knows the place of.
    fn frames(
        &mut self,
        sensors: &Sensors,
        state: &ControllerState,
        odom_from_planning: &RecordedPose,
    ) -> Frames {
        // The torso is put at the origin.
        let joints = self.q.len() - 7;
        self.q[7..].copy_from_slice(&sensors.joint_angle[..joints]);
        self.model.forward_kinematics(&mut self.data, &self.q);
        let pose = |frame: &Frame| {
            let (position, orientation) = self.model.frame_place(&self.data, frame);
            RecordedPose { position, orientation }
        };
        let soles = self.soles.each_ref().map(pose);
        let height = odom_from_planning.position[2];
        let Some(torso) = odometry::torso(sensors, state, height, &soles[0]) else { return Frames::UNKNOWN };
        let torso = torso.seen_from(odom_from_planning);
        Frames {
            camera: self.camera.as_ref().map_or(Frames::UNKNOWN.camera, |frame| torso.then(&pose(frame))),
            torso,
            soles: soles.map(|sole| torso.then(&sole)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_of_odometry_grows_with_the_way_and_never_shrinks() {
        let mut way = Way::default();
        let still = way.to([0.0; 3], 0.0);
        assert_eq!((still.place_error, still.heading_error, still.way), (0.0, 0.0, 0.0));
        // Out and back by steps of 0.3 m from foot to foot: the place is the first one, the error is that of the way.
        let mut before = still;
        for k in (0..=10).chain((0..10).rev()) {
            let foot = if k % 2 == 0 { 0.1 } else { -0.1 };
            let now = way.to([0.3 * f64::from(k), foot, 0.0], 0.0);
            assert!(now.place_error >= before.place_error && now.heading_error >= before.heading_error);
            // Looked at again while she stands on it.
            assert_eq!(way.to([0.3 * f64::from(k), foot, 0.0], 0.0), now);
            before = now;
        }
        assert!((before.way - 6.0).abs() < 0.5, "{} m", before.way);
        assert!((before.place_error - 0.05 * before.way).abs() < 1e-12);
        let turned = way.to([0.0, 0.1, -0.5], 0.0);
        assert!(turned.heading_error > before.heading_error + 0.04);
        assert_eq!(Way::default().to([3.0, 4.0, 0.0], 0.0).way, 5.0, "began to look late");
    }

    /// The head has I_0 turned and moved beside odometry's: what is seen to the left and ahead of the torso stays there.
    #[test]
    fn a_point_is_told_where_the_head_has_it() {
        let frames = Frames { torso: RecordedPose::moved([0.2, -0.1, 0.9]), ..Frames::UNKNOWN };
        let odometry = Odometry { place: [3.0, -2.0, 0.1, 0.4], ..Odometry::UNKNOWN };
        for head_offset in [[0.0; 3], [0.7, -0.3, 0.0], [0.0, 0.0, -0.5], [-1.2, 0.4, 3.0]] {
            let sight = Sight { cycle: 1, gait: 3, odometry, frames, head_offset };
            // Both have the torso somewhere, and the point as far ahead and to the left of it.
            let believed = |[dx, dy, turn]: [f64; 3]| {
                let torso = odometry::frame(odometry.place).then(&frames.torso);
                let [x, y, z] = torso.position;
                odometry::frame([x + dx, y + dy, z, torso.heading() + turn])
            };
            let seen = [1.5, 0.6, -0.9];
            let point = believed([0.0; 3]).place(seen);
            let told = sight.command(&Command::Fixate(FixateCommand { point }));
            let Command::Fixate(FixateCommand { point: told }) = told else { panic!("{told:?}") };
            let expected = believed(head_offset).place(seen);
            let off = told.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-12, "{head_offset:?}: {told:?}, not {expected:?}");
        }
        let unknown = Sight { cycle: 0, gait: 0, odometry, frames: Frames::UNKNOWN, head_offset: [0.0; 3] };
        let far = Command::Fixate(FixateCommand { point: [9.0, 0.0, 1.0] });
        assert_eq!(unknown.command(&far), far);
        assert_eq!(unknown.command(&Command::Stop), Command::Stop);
    }

    /// Standing, soles are level under the torso, and the cameras over it look ahead.
    #[test]
    fn frames_of_a_standing_robot_are_where_she_has_them() {
        let setup = Setup::load(&config::root(None), "walk_1kmh").unwrap();
        let mut kinematics = Kinematics::new(&setup).unwrap();
        let mut sensors = Sensors::default();
        sensors.imu.orientation = [0.0, 0.0, 0.0, 1.0];
        let pose = &setup.robot.poses[&setup.scene.start_pose];
        sensors.joint_angle[..pose.len()].copy_from_slice(pose);
        let state = ControllerState {
            origin: [3.0, -2.0, 0.4],
            feet: [[0.1, -0.12, 0.0, 0.0], [0.1, 0.12, 0.0, 0.0]],
            ..ControllerState::default()
        };
        let planning = odometry::planning_frame(&state, 0.0);
        let Frames { camera, torso, soles: [right, left] } = kinematics.frames(&sensors, &state, &planning);
        let near = |pose: &RecordedPose, wanted: [f64; 3], by: f64| {
            let off = pose.position.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < by, "{pose:?} is {off} m away from {wanted:?}");
        };
        near(&right, [0.1, -0.12, 0.0], 1e-9);
        assert!((left.position[1] - 0.12).abs() < 0.05 && left.position[2].abs() < 1e-3, "{left:?}");
        assert!(torso.position[2] > 0.7 && torso.heading().abs() < 1e-9, "{torso:?}");
        let ahead = camera.place([1.0, 0.0, 0.0])[0] - camera.position[0];
        assert!(camera.position[2] > torso.position[2] && ahead > 0.5, "{camera:?}");
    }
}
