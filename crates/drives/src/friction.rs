//! Friction of gears on the motor shaft: torque T_f from speed and motor torque.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | ω | speed of the rotor relative to the stator | rad/s |
//! | T_mot, T_f | motor torque, friction torque on the rotor | N m |
//! | T_l | load torque: what goes into the gear, `T_mot + T_f`; output torque over N | N m |
//! | T_0, μ, b, γ | starting torque, load share, viscous, viscous by load | N m, 1, N m s/rad, s/rad |
//! | η_D, η_I | efficiency of a screw when the motor drives, when the load drives | 1 |
//! | s | sign of ω, or ω/ω_eps where that is smaller | 1 |
//!
//! Sources: (2.61), (2.63), (2.64) with errata 1, F9: T_l in closed form, unique only while the load share
//! c = s μ + γ ω has |c| < 1; (2.65)-(2.68) with directions and the back-driven case corrected (errata 1, F9).
//! T_f ω <= 0 always.

use std::fmt;

/// Friction of one drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction {
    /// None.
    Free,
    /// Harmonic drive.
    Harmonic(HarmonicFriction),
    /// Roller screw.
    Screw(ScrewFriction),
}

/// Parameters of (2.61), all on the motor's side; none is negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HarmonicFriction {
    /// \[N m\] T_0: starts without load.
    pub starting: f64,
    /// \[1\] μ: share of the load.
    pub load: f64,
    /// \[N m s/rad\] b: viscous.
    pub viscous: f64,
    /// \[s/rad\] γ: viscous, by load.
    pub coupled: f64,
}

/// Efficiencies of (2.65), belt included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScrewFriction {
    /// \[1\] η_D: the motor drives.
    pub direct: f64,
    /// \[1\] η_I: the load drives.
    pub indirect: f64,
}

/// Friction as a law of dry and viscous friction at one load: `T_f = -s dry - viscous ω`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sliding {
    /// \[N m\] Dry part, at rest up to this size either way.
    pub dry: f64,
    /// \[N m s/rad\] Viscous part.
    pub viscous: f64,
}

/// The load torque is not unique: speed or friction are outside of what the model was made for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoLoadTorque {
    /// \[1\] c = s μ + γ ω; |c| must stay below 1.
    pub share: f64,
}

/// s: sign of the speed, as a ramp within `smooth` \[rad/s\]; 0 at rest.
fn sign(speed: f64, smooth: f64) -> f64 {
    if speed.abs() < smooth {
        speed / smooth
    } else if speed == 0.0 {
        0.0
    } else {
        speed.signum()
    }
}

impl Friction {
    /// \[N m\] T_f on the rotor at ω = `speed` \[rad/s\] and T_mot = `motor` \[N m\]; `smooth` = ω_eps \[rad/s\], 0 for the
    /// jump at rest.
    pub fn torque(&self, speed: f64, motor: f64, smooth: f64) -> Result<f64, NoLoadTorque> {
        match self {
            Self::Free => Ok(0.0),
            Self::Harmonic(harmonic) => Ok(harmonic.load_torque(speed, motor, smooth)? - motor), // (2.63)
            Self::Screw(screw) => Ok(screw.torque(speed, motor, smooth)),
        }
    }

    /// The law that holds while the load stays what it is at ω = `speed` \[rad/s\] and T_mot = `motor` \[N m\]; for implicit
    /// steps, which keep a rotor at rest where a sign would chatter.
    pub fn sliding(&self, speed: f64, motor: f64) -> Result<Sliding, NoLoadTorque> {
        Ok(match self {
            Self::Free => Sliding::default(),
            Self::Harmonic(h) => {
                let load = h.load_torque(speed, motor, 0.0)?.abs();
                Sliding { dry: h.starting + h.load * load, viscous: h.viscous + h.coupled * load }
            }
            Self::Screw(screw) => Sliding { dry: screw.part(speed * motor) * motor.abs(), viscous: 0.0 },
        })
    }

    /// \[rad/s\] Speed below which the load torque is unique.
    pub fn speed_limit(&self) -> f64 {
        match self {
            Self::Harmonic(h) if h.coupled > 0.0 => ((1.0 - h.load) / h.coupled).max(0.0),
            Self::Harmonic(h) if h.load >= 1.0 => 0.0,
            _ => f64::INFINITY,
        }
    }
}

impl HarmonicFriction {
    /// \[N m\] T_l at ω = `speed` \[rad/s\] and T_mot = `motor` \[N m\]; `smooth` as in [`Friction::torque`].
    pub fn load_torque(&self, speed: f64, motor: f64, smooth: f64) -> Result<f64, NoLoadTorque> {
        let s = sign(speed, smooth);
        let share = s * self.load + self.coupled * speed; // c
        if !(share.abs() < 1.0) {
            return Err(NoLoadTorque { share });
        }
        let free = motor - s * self.starting - self.viscous * speed; // A
        Ok(if free < 0.0 { free / (1.0 - share) } else { free / (1.0 + share) }) // (2.64)
    }

    /// \[N m\] T_f of a load torque that is known.
    pub fn torque(&self, speed: f64, load: f64, smooth: f64) -> f64 {
        let (s, load) = (sign(speed, smooth), load.abs());
        -s * (self.starting + self.load * load) - (self.viscous + self.coupled * load) * speed // (2.61)
    }
}

impl ScrewFriction {
    /// \[N m\] T_f at ω = `speed` \[rad/s\] and T_mot = `motor` \[N m\].
    pub fn torque(&self, speed: f64, motor: f64, smooth: f64) -> f64 {
        -sign(speed, smooth) * self.part(speed * motor) * motor.abs() // (2.68)
    }

    /// Friction torque over motor torque, for a motor that drives (power > 0) or is driven; at rest it would have to drive.
    fn part(&self, power: f64) -> f64 {
        if power >= 0.0 { 1.0 - self.direct } else { 1.0 / self.indirect - 1.0 }
    }
}

impl Sliding {
    /// \[rad/s\] Speed after an implicit step that without friction would have ended with the speed `free`;
    /// `mobility` = h/J \[s/(kg m^2)\]: time step over inertia of the rotor. Exactly 0 while dry friction holds.
    pub fn speed_after(&self, free: f64, mobility: f64) -> f64 {
        let left = (free.abs() - mobility * self.dry).max(0.0) / (1.0 + mobility * self.viscous);
        if left > 0.0 { left.copysign(free) } else { 0.0 }
    }
}

impl fmt::Display for NoLoadTorque {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "gear friction has no unique load torque: load share c = {:.3} lies outside of -1..1; the motor turns faster \
             than the friction model allows",
            self.share
        )
    }
}

impl std::error::Error for NoLoadTorque {}
