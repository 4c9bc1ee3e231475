//! Trigger: pose and odometry of the robot, as a vision system is told with each trigger of its cameras (thesis 6.2).

use recording::RecordedPose;

use crate::Cause;

/// Numbers of a trigger: planning frame, its uncertainty, and four poses.
pub const NUMBERS: usize = 4 + 3 + 4 * 7;

/// Flags of a trigger.
pub mod flag {
    /// A robot runs, and the numbers are its.
    pub const ROBOT: u64 = 1;
    /// The gateway holds the command lease: velocities move her.
    pub const LEASE: u64 = 2;
    /// Somebody else has stopped her or taken her over: velocities are refused until one of zero comes.
    pub const HELD: u64 = 4;
}

/// Place and heading of the planning frame, and how far they may be off: shares of the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Odometry {
    /// \[m, m, m, rad\] @I_0 Origin and heading of I_i.
    pub place: [f64; 4],
    /// \[m\] Bound of its error, along the ground.
    pub place_error: f64,
    /// \[rad\] Bound of its error.
    pub heading_error: f64,
    /// \[m\] Way that she has gone.
    pub way: f64,
}

/// Poses in the planning frame I_i. NaN: not known.
#[derive(Clone, Copy, Debug)]
pub struct Frames {
    /// Middle between the cameras, x along their axes.
    pub camera: RecordedPose,
    /// Torso.
    pub torso: RecordedPose,
    /// Soles, right and left.
    pub soles: [RecordedPose; 2],
}

/// A trigger.
#[derive(Clone, Copy, Debug)]
pub struct Trigger {
    /// Process id of the gateway.
    pub sender: u64,
    /// Number of the trigger.
    pub sequence: u64,
    /// \[ns\] CLOCK_MONOTONIC of the robot's machine.
    pub stamp: u64,
    /// Bus cycle of the numbers.
    pub cycle: u64,
    /// See [`flag`].
    pub flags: u64,
    /// A [`GaitState`](messages::GaitState).
    pub gait: u64,
    /// Place of the planning frame.
    pub odometry: Odometry,
    /// Poses of the robot.
    pub frames: Frames,
    /// Datagrams accepted so far.
    pub accepted: u64,
    /// Datagrams refused so far, by [`Cause`].
    pub refused: [u64; Cause::ALL.len()],
}

impl Odometry {
    /// Nothing is known.
    pub const UNKNOWN: Self =
        Self { place: [f64::NAN; 4], place_error: f64::NAN, heading_error: f64::NAN, way: f64::NAN };
}

impl Frames {
    /// Nothing is known.
    pub const UNKNOWN: Self = {
        let none = RecordedPose { position: [f64::NAN; 3], orientation: [f64::NAN; 4] };
        Self { camera: none, torso: none, soles: [none; 2] }
    };
}

impl Trigger {
    /// Its numbers in their order.
    pub(crate) fn numbers(&self) -> [f64; NUMBERS] {
        let Odometry { place, place_error, heading_error, way } = self.odometry;
        let Frames { camera, torso, soles: [right, left] } = self.frames;
        let mut all = [0.0; NUMBERS];
        let poses = [camera, torso, right, left];
        let poses = poses.iter().flat_map(|p| p.position.iter().chain(&p.orientation));
        let numbers = place.iter().chain([&place_error, &heading_error, &way]).chain(poses);
        all.iter_mut().zip(numbers).for_each(|(to, from)| *to = *from);
        all
    }
}

/// What a trigger's numbers say, the inverse of [`Trigger::numbers`].
pub(crate) fn parts(numbers: &[f64; NUMBERS]) -> (Odometry, Frames) {
    let mut rest = numbers.iter().copied();
    let mut next = || rest.next().unwrap_or(f64::NAN);
    let place = std::array::from_fn(|_| next());
    let odometry = Odometry { place, place_error: next(), heading_error: next(), way: next() };
    let mut pose = || {
        let position = std::array::from_fn(|_| next());
        RecordedPose { position, orientation: std::array::from_fn(|_| next()) }
    };
    let (camera, torso) = (pose(), pose());
    (odometry, Frames { camera, torso, soles: [pose(), pose()] })
}
