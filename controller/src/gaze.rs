//! Camera head (thesis 4.7): looks at a point in space whatever the robot does, or moves to given angles.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | P | point to look at | m | I_0 |
//! | C | where the axes of pan and tilt meet | m | torso |
//! | c | middle between the cameras, from C | m | what tilts |
//! | r | from C to P (4.56) | m | torso |
//! | pan, tilt | to the left, upwards | rad | |
//!
//! P is carried through odometry (4.55) and the measured pose of the torso, so that the head makes up for what the robot
//! does, planned or not. Corrections (errata 2.11): (4.57), (4.58) hold in axes with y up; in the torso's, z up, pan is
//! atan2(y, x) and tilt atan2(z, hypot(x, y)). And the cameras sit beside the axes (c), which the thesis leaves out: 4 cm
//! are 20 mrad at 2 m. With c the optical axis, x of what tilts, still meets P exactly:
//! R_tilt^T R_pan^T r = (d, c_y, c_z) with d > c_x.
//!
//! The heading of the stance foot is planned, not measured, and soles turn on the ground: measured, 20 mrad to and fro in
//! every step at 2 km/h, and 27 mrad for good when Lola starts. So within `heading_time` the head believes the IMU's heading,
//! and over longer times odometry's; and it reckons where it is by the way of odometry, turned into that heading.

use config::Robot;
use config::limbs::Head;
use messages::{Command, Detail, EventCode, EventQueue};
use multibody::ModelError;
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::f64::consts::TAU;

use crate::inverse_kinematics::JointVector;
use crate::saccade::{self, AXES, AxisLimits, AxisState, Target};
use crate::task_space::TaskSpace;

/// Pose and motion of the torso as measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TorsoMotion {
    /// \[m, m, rad\] @I_0 The planning frame.
    pub origin: [f64; 3],
    /// \[m\] @I_0 Its height.
    pub height: f64,
    /// \[rad\] Heading of the torso in the planning frame less the one that the IMU says.
    pub turn: f64,
    /// Planning frame from torso.
    pub rotation: Matrix3<f64>,
    /// \[m\] @I Torso's origin.
    pub position: Vector3<f64>,
    /// \[m/s\] @torso Its velocity.
    pub velocity: Vector3<f64>,
    /// \[rad/s\] @torso
    pub omega: Vector3<f64>,
}

/// Goal of the head.
#[derive(Clone, Copy, Debug, PartialEq)]
enum HeadGoal {
    /// Nobody has asked yet.
    None,
    Point(Vector3<f64>),
    Angles([f64; AXES]),
}

/// Way of getting there.
#[derive(Clone, Copy, Debug, PartialEq)]
enum GazeMode {
    Pursuit,
    /// With this time left \[s\].
    Saccade(f64),
}

/// One joint of the head: pan, tilt, vergence in their directions of the table above.
#[derive(Clone, Copy, Debug)]
struct HeadAxis {
    joint: usize,
    /// Of the joint's angle against the one above.
    sign: f64,
    range: [f64; 2],
    comfort: f64,
}

/// The camera head of one robot.
#[derive(Clone)]
pub(crate) struct Gaze {
    head: Head,
    /// Joints of the robot, for events.
    joints: usize,
    axes: [Option<HeadAxis>; AXES],
    /// C \[m\] @torso
    centre: Vector3<f64>,
    goal: HeadGoal,
    mode: GazeMode,
    /// \[rad/s^2\] Of the last cycle.
    acceleration: [f64; AXES],
    /// \[rad\] Heading in I_0 less the one that the IMU says, over a longer time.
    turn: Option<f64>,
    /// \[m\] @I_0 Torso by odometry.
    odometry: Option<Vector3<f64>>,
    /// \[m, m, rad\] @I_0 Place and heading of the torso as the head believes them, less odometry's.
    offset: [f64; 3],
    /// Obstacle to looking at the point, as in [`EventCode::GazeHeld`].
    held: Option<usize>,
    /// News of the point and of the way there.
    events: EventQueue,
}

impl Gaze {
    /// The head of a robot, if it has one.
    ///
    /// # Errors
    /// The cameras' link is unknown, or its joints are not a pan and a tilt whose axes meet.
    pub(crate) fn new(robot: &Robot) -> Result<Option<Self>, ModelError> {
        let Some(head) = robot.head.clone() else { return Ok(None) };
        let (centre, signs) = geometry(robot, &head)?;
        let axis = |(joint, sign): (usize, f64)| {
            let j = &robot.joints[joint];
            let (a, b) = (sign * j.range[0], sign * j.range[1]);
            HeadAxis { joint, sign, range: [a.min(b), a.max(b)], comfort: sign * j.comfort }
        };
        let vergence = head.vergence.map(|(joint, _)| (joint, 1.0));
        Ok(Some(Self {
            // Ranges and comfort in the directions of the table above.
            axes: [Some((head.pan, signs[0])), Some((head.tilt, signs[1])), vergence].map(|a| a.map(axis)),
            head,
            joints: robot.joints.len(),
            centre,
            goal: HeadGoal::None,
            mode: GazeMode::Pursuit,
            acceleration: [0.0; AXES],
            turn: None,
            odometry: None,
            offset: [0.0; 3],
            held: None,
            events: EventQueue::default(),
        }))
    }

    /// Events that were not taken yet.
    pub(crate) fn events(&mut self) -> &mut EventQueue {
        &mut self.events
    }

    /// \[m, m, rad\] @I_0 Place and heading of the torso as the head believes them, less odometry's.
    pub(crate) fn offset(&self) -> [f64; 3] {
        self.offset
    }

    /// Takes a command to the head; `false` if it cannot be done and nothing changes.
    pub(crate) fn command(&mut self, command: &Command) -> bool {
        let goal = match command {
            Command::Fixate(f) => HeadGoal::Point(f.point.into()),
            Command::HeadJoints(h) => HeadGoal::Angles([h.pan, h.tilt, self.comfort(2)]),
            Command::HeadRest => HeadGoal::Angles([0, 1, 2].map(|i| self.comfort(i))),
            _ => return false,
        };
        let possible = match goal {
            HeadGoal::Point(p) => p.iter().all(|x| x.is_finite()),
            HeadGoal::Angles(angles) => self.axes.iter().zip(angles).all(|(axis, angle)| {
                axis.is_none_or(|a| angle >= a.range[0] && angle <= a.range[1]) // no NaN is
            }),
            HeadGoal::None => true,
        };
        if possible {
            self.goal = goal;
            self.held = None;
        }
        possible
    }

    fn comfort(&self, axis: usize) -> f64 {
        self.axes[axis].map_or(0.0, |a| a.comfort)
    }

    /// The joints are at rest, wherever they are.
    pub(crate) fn halt(&mut self) {
        self.mode = GazeMode::Pursuit;
        self.acceleration = [0.0; AXES];
        self.turn = None;
    }

    /// Speeds of the head's joints at the end of this cycle of `dt` \[s\], from the angles and speeds commanded at its
    /// beginning.
    pub(crate) fn drive(
        &mut self,
        torso: &TorsoMotion,
        dt: f64,
        angle: &[f64],
        speed: &JointVector,
        given: &mut JointVector,
    ) {
        let torso = &self.stabilized(torso, dt);
        // The motion goes on from what was commanded, not from what is measured: the joints' lag is not fed back.
        let mut now = [AxisState::default(); AXES];
        for (i, axis) in self.axes.iter().enumerate() {
            let Some(HeadAxis { joint, sign, .. }) = *axis else { continue };
            now[i] = AxisState { p: sign * angle[joint], v: sign * speed[joint], a: self.acceleration[i] };
        }
        // Nobody has asked: the head goes to its comfort like any joint without a task.
        let targets = match self.goal {
            HeadGoal::None => return,
            HeadGoal::Angles(angles) => angles.map(|p| Target { p, v: 0.0 }),
            HeadGoal::Point(point) => self.targets(torso, &point, &now, dt),
        };
        let next = self.follow(&now, &targets, dt);
        for (i, axis) in self.axes.iter().enumerate() {
            let Some(HeadAxis { joint, sign, .. }) = *axis else { continue };
            given[joint] = sign * next[i].0;
            self.acceleration[i] = next[i].1;
        }
    }

    /// Targets of the joints at the end of the cycle to look at a point; where they are if that cannot be done.
    fn targets(
        &mut self,
        torso: &TorsoMotion,
        point: &Vector3<f64>,
        now: &[AxisState; AXES],
        dt: f64,
    ) -> [Target; AXES] {
        let (r, rate) = self.seen(torso, point);
        let here = now.map(|s| Target { p: s.p, v: 0.0 });
        let looks = self.angles(&r).zip(self.angles(&(r + rate * dt)));
        let Some((begin, end)) = looks else {
            self.hold(Some(self.joints));
            return here;
        };
        // An axis at the end of its range waits there until the point comes back.
        let (mut targets, mut held) = (here, None);
        for (i, axis) in self.axes.iter().enumerate() {
            let Some(HeadAxis { joint, range, .. }) = *axis else { continue };
            let (p, inside) = reached(end[i], now[i].p, range);
            let turned = end[i] - begin[i];
            let v = (turned - TAU * (turned / TAU).round()) / dt;
            targets[i] = Target { p, v: if inside { v } else { 0.0 } };
            held = held.or((!inside).then_some(joint));
        }
        self.hold(held);
        targets
    }

    /// The torso with the IMU's heading at short times, odometry's at long ones, and where that heading has led it.
    fn stabilized(&mut self, torso: &TorsoMotion, dt: f64) -> TorsoMotion {
        let [x, y, heading] = torso.origin;
        let now = heading + torso.turn;
        let before = self.turn.filter(|turn| turn.is_finite()).unwrap_or(now);
        let wrapped = |angle: f64| angle - TAU * (angle / TAU).round();
        let turn = before + wrapped(now - before) * (dt / self.head.heading_time).min(1.0);
        self.turn = Some(turn);
        let about_z = |angle: f64| Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
        let turned = wrapped(turn - now);
        let more = about_z(turned);
        let mut odometry = about_z(heading) * torso.position + Vector3::new(x, y, 0.0);
        odometry.z = 0.0;
        let way = self.odometry.replace(odometry).map_or(Vector3::zeros(), |last| odometry - last);
        let aside = more * way - way;
        let offset = [self.offset[0] + aside.x, self.offset[1] + aside.y, turned];
        if offset.iter().all(|a| a.is_finite()) {
            self.offset = offset;
        }
        let origin = [x + self.offset[0], y + self.offset[1], heading];
        TorsoMotion { origin, rotation: more * torso.rotation, ..*torso }
    }

    /// From C to P and its rate, torso axes (4.55), (4.56).
    fn seen(&self, torso: &TorsoMotion, point: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let [x, y, heading] = torso.origin;
        let back = Rotation3::from_axis_angle(&Vector3::z_axis(), -heading);
        let planned = back * (point - Vector3::new(x, y, torso.height)); // (4.55)
        let from_torso = torso.rotation.transpose() * (planned - torso.position);
        let rate = -torso.velocity - torso.omega.cross(&from_torso);
        (from_torso - self.centre, rate)
    }

    /// Pan, tilt and vergence that bring the optical axis through r; none if r is too near, or not finite.
    fn angles(&self, r: &Vector3<f64>) -> Option<[f64; AXES]> {
        let [cx, cy, cz] = self.head.camera;
        let level = r.x.hypot(r.y);
        let ahead = ((level - cy) * (level + cy)).max(0.0).sqrt();
        let distance = ((ahead.hypot(r.z) - cz) * (ahead.hypot(r.z) + cz)).max(0.0).sqrt() - cx; // from c to P
        if !(distance >= self.head.nearest && level > cy.abs() && distance.is_finite()) {
            return None;
        }
        let pan = r.y.atan2(r.x) - (cy / level).asin(); // (4.57)
        let tilt = r.z.atan2(ahead) - (cz / ahead.hypot(r.z)).asin(); // (4.58)
        let baseline = self.head.vergence.map_or(0.0, |(_, baseline)| baseline);
        Some([pan, tilt, 2.0 * (0.5 * baseline).atan2(distance)]) // (4.59)
    }

    fn hold(&mut self, why: Option<usize>) {
        if why != self.held {
            self.held = why;
            let resumed = (EventCode::GazeResumed, Detail::Nothing);
            let (code, detail) = why.map_or(resumed, |why| (EventCode::GazeHeld, Detail::Joint(why)));
            self.events.push(code, detail);
        }
    }

    /// Speeds and accelerations at the end of the cycle: a jump if the error is large, pursuit otherwise.
    fn follow(&mut self, now: &[AxisState; AXES], targets: &[Target; AXES], dt: f64) -> [(f64, f64); AXES] {
        let limits = AxisLimits { speed: self.head.saccade_speed, acceleration: self.head.acceleration };
        // Of the beginning of the cycle, as the states are.
        let begin = targets.map(|t| Target { p: t.p - t.v * dt, ..t });
        let error = (0..AXES).map(|i| (begin[i].p - now[i].p).abs()).fold(0.0, f64::max);
        let begins = self.mode == GazeMode::Pursuit && error > self.head.saccade_error;
        let left = match self.mode {
            GazeMode::Saccade(left) => Some(left.max(dt)),
            GazeMode::Pursuit => begins.then_some(dt),
        };
        if let Some(least) = left {
            let time = saccade::duration(now, &begin, least, &limits);
            if begins {
                self.events.push(EventCode::Saccade, Detail::Microseconds((time * 1e6) as u64));
            }
            self.mode = if time > 1.5 * dt { GazeMode::Saccade(time - dt) } else { GazeMode::Pursuit };
            return std::array::from_fn(|i| saccade::jump(&now[i], &begin[i], time, dt));
        }
        let limits = AxisLimits { speed: self.head.pursuit_speed, ..limits };
        let w = self.head.pursuit_bandwidth;
        std::array::from_fn(|i| saccade::pursue(&now[i], &targets[i], w, dt, &limits))
    }
}

/// The nearest angle to `now` in the range that looks in the direction of `angle`, and `true`; if none does, the end of
/// the range that is nearer to the present one's side: a point behind the robot does not make the head swing.
fn reached(angle: f64, now: f64, [low, high]: [f64; 2]) -> (f64, bool) {
    let near = angle + TAU * ((now - angle) / TAU).round();
    let turns = [near, near - TAU, near + TAU];
    let inside = turns.into_iter().filter(|a| (low..=high).contains(a));
    match inside.min_by(|a, b| (a - now).abs().total_cmp(&(b - now).abs())) {
        Some(angle) => (angle, true),
        None => (near.clamp(low, high), false),
    }
}

/// C in the torso and the signs of pan and tilt, from the robot's kinematics; they must be what this file takes them for.
fn geometry(robot: &Robot, head: &Head) -> Result<(Vector3<f64>, [f64; 2]), ModelError> {
    let mut kinematics = TaskSpace::new(robot)?;
    let mut at = |pan: f64, tilt: f64| {
        let mut q = vec![0.0; robot.joints.len()];
        (q[head.pan], q[head.tilt]) = (pan, tilt);
        kinematics.update(&q);
        kinematics.link(&head.link)
    };
    let (zero, panned, tilted) = (at(0.0, 0.0)?, at(0.1, 0.0)?, at(0.0, 0.1)?);
    let signs = [panned.rotation[(1, 0)].signum(), tilted.rotation[(2, 0)].signum()];
    let turned = at(0.3, -0.2)?;
    let expected = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.3 * signs[0])
        * Rotation3::from_axis_angle(&Vector3::y_axis(), 0.2 * signs[1]);
    let off = (turned.rotation - expected.matrix()).abs().max() + (turned.position - zero.position).norm();
    if off > 1e-9 {
        let why = "[head] wants pan about z and tilt about y, with axes that meet in the link's origin";
        return Err(ModelError::Unsuitable(head.link.clone(), why.into()));
    }
    Ok((zero.position, signs))
}

#[cfg(test)]
mod tests;
