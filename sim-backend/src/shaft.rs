//! Shaft of one motor with its gear: which joints it moves, at which ratio, and what holds it.

use config::robot::Drive as DriveData;
use drives::{Elasticity, Gear, GearSide, Transmission};
use multibody::Data;

use crate::drive::JointMotion;
use crate::inputs::DriveSwitches;

/// Inputs of the drive trains: joints, rotors, currents of the state, references of the joints.
pub struct TrainInputs<'a> {
    /// \[rad\], \[rad/s\] Joint angles and speeds.
    pub joint: (&'a [f64], &'a [f64]),
    /// \[rad\], \[rad/s\] Rotors behind elastic gears.
    pub rotor: (&'a [f64], &'a [f64]),
    /// \[A\]
    pub current: &'a [f64],
    /// References of the joints.
    pub reference: &'a [JointMotion],
    /// Drives with and without torque.
    pub switches: DriveSwitches,
}

/// One motor with its gear.
#[derive(Clone)]
pub(crate) struct Shaft {
    pub(crate) drive: DriveData,
    /// Place among the motors.
    pub(crate) motor: usize,
    /// Joints it moves; those behind the first `coupled` are not used.
    pub(crate) joints: [usize; 3],
    pub(crate) coupled: usize,
    /// Place among the elastic rotors, and the spring.
    pub(crate) elastic: Option<(usize, Elasticity)>,
    /// Inertia the motor feels of a hanging robot, on its shaft \[kg m^2\].
    pub(crate) inertia: f64,
    pub(crate) gear: Gear,
    /// Speed w \[rad/s\].
    pub(crate) speed: f64,
}

impl Shaft {
    /// Shaft of the motor number `motor`; `elastic`: place among the elastic rotors, and the spring.
    pub(crate) fn new(drive: &DriveData, motor: usize, elastic: Option<(usize, Elasticity)>) -> Self {
        let first = drive.joints[0];
        let joint = |i: usize| drive.joints.get(i).copied().unwrap_or(first);
        Self {
            motor,
            joints: [joint(0), joint(1), joint(2)],
            coupled: drive.joints.len().min(3),
            elastic,
            inertia: drive.rotor_inertia,
            gear: drive.transmission.at([0.0; 3], [0.0; 3]).unwrap_or_default(),
            speed: 0.0,
            drive: drive.clone(),
        }
    }

    /// True if the ratio changes with the joints.
    pub(crate) fn is_linkage(&self) -> bool {
        !matches!(self.drive.transmission, Transmission::Harmonic { .. })
    }

    /// Angle and speed of the i-th joint, or of the rotor that moves it, in units of the joint.
    pub(crate) fn at(&self, side: GearSide, i: usize, inputs: &TrainInputs<'_>) -> (f64, f64) {
        match self.elastic.as_ref().filter(|_| side == GearSide::Motor) {
            Some((e, _)) => (inputs.rotor.0[*e], inputs.rotor.1[*e]),
            None => (inputs.joint.0[self.joints[i]], inputs.joint.1[self.joints[i]]),
        }
    }

    /// Torque up to which the shaft is held now \[N m\]: by its brake, or by who holds the joint as its motor could.
    pub(crate) fn holding_torque(&self, switches: &DriveSwitches) -> f64 {
        if switches.is_held(self.motor) {
            return self.drive.motor.torque(self.drive.current_limit);
        }
        let closed = switches.is_braked(self.motor);
        self.drive.brake.filter(|_| closed).map_or(0.0, |brake| brake.torque)
    }

    /// Hands the torque of the shaft on to the joints, through the gear.
    pub(crate) fn apply(&self, inputs: &TrainInputs<'_>, shaft: f64, data: &mut Data, torque: &mut [f64]) {
        match &self.elastic {
            None => {
                for i in 0..self.coupled {
                    torque[self.joints[i]] += self.gear.ratio[i] * shaft;
                }
            }
            Some((e, spring)) => {
                let twist = spring.torque(inputs.joint.0[self.joints[0]] - inputs.rotor.0[*e]);
                torque[self.joints[0]] -= twist; // (2.70)
                data.set_free_rotor(self.motor, self.speed, shaft + twist / self.gear.ratio[0]);
            }
        }
    }
}
