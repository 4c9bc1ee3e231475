//! Laws of joint position control (thesis 5.5), written for the motor's shaft.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | q_d, q'_d | where a joint is to be, and how fast | rad, rad/s |
//! | w_d, w, e | speed wanted and seen, error of the angle; of the shaft | rad/s, rad |
//! | C, D | gains of the voltage law | V/rad, V s/rad |
//! | K_p, K_d | gains of PD control: torque by angle and by speed | N m/rad, N m s/rad |
//! | K_x, w_v, w_c | gains of a cascade: position, bandwidths of speed and current | 1/s, rad/s, rad/s |
//!
//! A cascade of position and speed is PD control of the torque with K_d = w_v J and K_p = K_x K_d, J the inertia that its
//! speed loop is tuned for. What it feeds back makes it (5.43), (5.45) or (5.49).

use crate::{CascadeOutput, CascadePi, Motor};

/// Control of one drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointControl {
    /// The law.
    pub law: ControlLaw,
    /// When it is computed.
    pub sampling: Sampling,
    /// Resolution.
    pub resolution: Resolution,
}

/// Resolution with which a local controller sees its motor and computes the reference. The default is exact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Resolution {
    /// Points in each dimension of the [`FixedTable`](crate::FixedTable) of a linkage, by which the motor's angle and speed
    /// are found from the joints'; none: the linkage itself. Linear gears need no table.
    pub table_points: Option<u32>,
    /// \[1\] Counts in a turn of the motor by which its angle is seen; none: all of it.
    pub encoder_counts: Option<u32>,
}

/// A law of joint control.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ControlLaw {
    /// Position, speed and current, one inside of the other: Lola's servo drives (thesis 5.5.2).
    Cascade(Cascade),
    /// The same with an integral in the speed loop, sampled: Archie's servo drives (Daniali 2013, 5.3).
    CascadePi(CascadePi),
    /// Angle of the motor to voltage: Johnnie, who has no current sensors (thesis 5.5.1).
    Voltage(VoltageLaw),
}

/// Gains of a cascade, and what it feeds back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cascade {
    /// Sides of the gear that are measured.
    pub feedback: Feedback,
    /// \[1/s\] K_x.
    pub position_gain: f64,
    /// \[rad/s\] w_v, with the inertia of a hanging robot.
    pub speed_bandwidth: f64,
    /// \[rad/s\] w_c.
    pub current_bandwidth: f64,
}

/// Which side of the gear angle and speed are measured on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feedback {
    /// Both on the link's side (5.43).
    Link,
    /// Both on the motor's side (5.45).
    Motor,
    /// Angle on the link's, speed on the motor's (5.49).
    LinkMotor,
}

/// A side of a gear; of a rigid gear both see the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GearSide {
    /// Joint.
    Link,
    /// Rotor.
    Motor,
}

/// (5.40).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoltageLaw {
    /// \[V/rad\] C, on the angle of the motor.
    pub position: f64,
    /// \[V s/rad\] D.
    pub speed: f64,
}

/// When a law is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sampling {
    /// So often that nobody sees the steps: the drive's own processor.
    Continuous,
    /// Once per bus cycle, and held until the next.
    Cycle(Sampled),
    /// By a clock of the drive's own, and held until its next tick.
    Period(SamplePeriods),
}

/// Periods of a law with a clock of its own. Bus cycles are whole multiples of the position loop's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplePeriods {
    /// \[s\] Of the speed loop.
    pub speed: f64,
    /// Samples of the speed loop in one of the position loop.
    pub position_every: u32,
}

/// A law computed once per cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sampled {
    /// True if what was computed acts one cycle later.
    pub delay: bool,
    /// True if speeds are differences of the angles of two cycles.
    pub difference: bool,
}

impl Feedback {
    /// All of them, in the order of [`Feedback::WORDS`].
    pub const ALL: [Self; 3] = [Self::Link, Self::Motor, Self::LinkMotor];
    /// Their names in configuration files.
    pub const WORDS: [&str; 3] = ["link", "motor", "link_motor"];

    /// Side of the angle sensor.
    pub fn position(self) -> GearSide {
        if self == Self::Motor { GearSide::Motor } else { GearSide::Link }
    }

    /// Side of the speed sensor.
    pub fn speed(self) -> GearSide {
        if self == Self::Link { GearSide::Link } else { GearSide::Motor }
    }
}

impl Cascade {
    /// \[rad/s\] Speed that the position loop asks of the shaft: w_d + K_x e.
    pub fn speed_wanted(&self, error: f64, wanted: f64) -> f64 {
        wanted + self.position_gain * error
    }
}

impl ControlLaw {
    /// \[rad/s\] Bandwidth of the current loop; none: the law puts out a voltage.
    pub fn current_bandwidth(&self) -> Option<f64> {
        match self {
            Self::Cascade(cascade) => Some(cascade.current_bandwidth),
            Self::CascadePi(CascadePi { output: CascadeOutput::Current(bandwidth), .. }) => Some(*bandwidth),
            Self::CascadePi(_) | Self::Voltage(_) => None,
        }
    }

    /// \[rad/s\] Bandwidth of the speed loop, which is tuned to an inertia; none without one.
    pub fn speed_bandwidth(&self) -> Option<f64> {
        match self {
            Self::Cascade(cascade) => Some(cascade.speed_bandwidth),
            Self::CascadePi(cascade) => Some(cascade.speed_bandwidth),
            Self::Voltage(_) => None,
        }
    }

    /// Side of the gear whose angle the law controls.
    pub fn position_side(&self) -> GearSide {
        match self {
            Self::Cascade(cascade) => cascade.feedback.position(),
            Self::CascadePi(_) | Self::Voltage(_) => GearSide::Motor,
        }
    }
}

impl VoltageLaw {
    /// \[V\] C e + D (w_d - w) + k_M w_d.
    pub fn voltage(&self, motor: &Motor, error: f64, wanted: f64, speed: f64) -> f64 {
        self.position * error + self.speed * (wanted - speed) + motor.torque_constant * wanted // (5.40)
    }
}
