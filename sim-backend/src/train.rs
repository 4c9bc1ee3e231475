//! Drive trains with their local controllers: from joint targets to torques, by motor, gear and friction (thesis 2.4).
//!
//! How each motor is controlled, and by what it sees of its joints, is data of the drive: `local_control`.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | c | speed of the motor by the speeds of its joints, d phi / d q | 1 |
//! | w | speed of the rotor relative to its housing, c q' or N th' | rad/s |
//! | K_v | gain of the speed loop of a cascade | A s/rad |
//! | U, I, R, L, k_M | voltage, current, resistance, inductance, constant of the motor (2.57) | V, A, Ohm, H, N m/A |
//! | T_f | friction torque on the motor shaft (2.61), (2.68) | N m |
//! | T | torque of the elastic gear on its output side (2.69) | N m |

use std::error::Error;

use config::Robot;
use config::robot::{Drive as Description, Joint};
use drives::{Elasticity, Gear, Law, NoLoadTorque, OutOfDomain, Sampling, Transmission};
use multibody::{Damper, Data, Model, Rotor};

use crate::drive::Motion;
use crate::implicit::Step;
use crate::local_control::Sampler;
use crate::resolution::Coarse;

/// \[rad/s\] Speed of a rotor over which explicit methods see dry friction change its sign.
pub(crate) const SLOW: f64 = 1.0;

/// All drives of a robot.
#[derive(Clone)]
pub struct Train {
    pub(crate) shafts: Vec<Shaft>,
    elastic: usize,
    pub(crate) fault: Option<Fault>,
    /// What an implicit step adds to the mass matrix, one per drive.
    pub(crate) dampers: Vec<Damper>,
}

/// A drive outside of what its model holds for; what it did last goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    /// Number of the drive.
    pub drive: usize,
    /// What is wrong.
    pub why: Why,
}

/// Why a drive has a [`Fault`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Why {
    /// The linkage is at its dead point, or beyond, or outside of the controller's look-up table.
    Linkage(OutOfDomain),
    /// The friction has no unique load torque.
    Friction(NoLoadTorque),
    /// An implicit step did not find out whether the shaft sticks or turns.
    Unsettled,
}

/// One motor with its gear.
#[derive(Clone)]
pub(crate) struct Shaft {
    pub(crate) drive: Description,
    /// Place among the motors.
    pub(crate) motor: usize,
    /// Joints it moves; those behind the first `coupled` are not used.
    pub(crate) joints: [usize; 3],
    pub(crate) coupled: usize,
    /// Place among the elastic rotors, and the spring.
    pub(crate) elastic: Option<(usize, Elasticity)>,
    /// Inertia the motor feels of a hanging robot, on its shaft \[kg m^2\].
    pub(crate) inertia: f64,
    pub(crate) speed_gain: f64,
    pub(crate) gear: Gear,
    /// Speed w \[rad/s\].
    pub(crate) speed: f64,
    /// What the position loop of a cascade asks of the speed, and how far that is from the speed seen \[rad/s\].
    pub(crate) wanted: f64,
    pub(crate) lag: f64,
    /// What a sampled law holds.
    pub(crate) sampler: Sampler,
    /// Of a controller with coarse numbers.
    pub(crate) coarse: Option<Coarse>,
    /// Of an implicit step, see there.
    pub(crate) step: Step,
}

/// What the shafts are told from outside: joints, rotors, references.
pub struct Given<'a> {
    /// \[rad\], \[rad/s\] Joint angles and speeds.
    pub joint: (&'a [f64], &'a [f64]),
    /// \[rad\], \[rad/s\] Rotors behind elastic gears.
    pub rotor: (&'a [f64], &'a [f64]),
    /// \[A\]
    pub current: &'a [f64],
    /// How the joints are to move.
    pub reference: &'a [Motion],
    /// Whether the motor supply is on; without it no motor has torque.
    pub powered: bool,
    /// Drives without torque all the same, one bit each.
    pub off: u64,
    /// Drives whose brakes are closed, one bit each.
    pub braked: u64,
    /// Drives held from outside, one bit each.
    pub held: u64,
}

impl Given<'_> {
    /// Whether a drive's power stage is on.
    pub(crate) fn drives(&self, drive: usize) -> bool {
        self.powered && self.off >> drive & 1 == 0
    }

    /// Torque up to which a shaft is held now \[N m\]: by its brake, or by who holds the joint as its motor could.
    pub(crate) fn brake(&self, shaft: &Shaft) -> f64 {
        if self.held >> shaft.motor & 1 == 1 {
            return shaft.drive.motor.torque(shaft.drive.current_limit);
        }
        let closed = self.braked >> shaft.motor & 1 == 1;
        shaft.drive.brake.filter(|_| closed).map_or(0.0, |brake| brake.torque)
    }
}

impl Train {
    /// The drives of `robot`, whose rotors `model` has; gears with elasticity are elastic if `elastic`. The speed loops are
    /// tuned for the robot hanging in the pose `hanging` \[rad\].
    ///
    /// # Errors
    /// The drives do not belong to the model, or a linkage has no look-up table where its controller needs one.
    pub fn new(robot: &Robot, model: &Model, elastic: bool, hanging: &[f64]) -> Result<Self, Box<dyn Error>> {
        let mut count = 0;
        let shaft = |(k, d): (usize, &Description)| Shaft::new(d, &robot.joints, k, elastic, &mut count);
        let mut shafts = robot.drives.iter().enumerate().map(shaft).collect::<Result<Vec<_>, _>>()?;
        tune(&mut shafts, model, hanging);
        let dampers = robot.drives.iter().map(|d| model.damper(&d.joints)).collect::<Result<_, _>>()?;
        Ok(Self { shafts, elastic: count, fault: None, dampers })
    }

    /// Elastic gears.
    pub fn elastic(&self) -> usize {
        self.elastic
    }

    /// Motors.
    pub fn motors(&self) -> usize {
        self.shafts.len()
    }

    /// The sampled controllers measure at the state of [`Train::load`] and compute what they hold for a cycle \[s\].
    pub fn sample(&mut self, cycle: f64, given: &Given<'_>) {
        for s in &mut self.shafts {
            s.sample(cycle, given);
        }
    }

    /// Whether a controller is sampled.
    pub fn is_sampled(&self) -> bool {
        self.shafts.iter().any(|s| s.drive.control.sampling != Sampling::Continuous)
    }

    /// Gains K_v of the speed loops, one per motor; 0 without one \[A s/rad\].
    pub fn speed_gains(&self) -> impl Iterator<Item = f64> + '_ {
        self.shafts.iter().map(|s| s.speed_gain)
    }

    /// Sets them.
    pub fn set_speed_gains(&mut self, gains: impl IntoIterator<Item = f64>) {
        for (s, gain) in self.shafts.iter_mut().zip(gains) {
            s.speed_gain = gain;
        }
    }

    /// The first fault since the last call.
    pub fn take_fault(&mut self) -> Option<Fault> {
        self.fault.take()
    }

    /// Sets the gears for the joints' angles and speeds.
    pub fn load(&mut self, given: &Given<'_>, data: &mut Data) {
        for (k, s) in self.shafts.iter_mut().enumerate() {
            if s.is_linkage() {
                let of_joints = |x: &[f64]| s.joints.map(|j| x[j]);
                let at = s.drive.transmission.at(of_joints(given.joint.0), of_joints(given.joint.1));
                match at {
                    Ok(gear) => s.gear = gear,
                    Err(why) => _ = self.fault.get_or_insert(Fault { drive: k, why: Why::Linkage(why) }),
                }
                data.set_gear(k, s.gear.ratio, s.gear.bias);
            }
            if let Err(why) = s.load(given) {
                self.fault.get_or_insert(Fault { drive: k, why: Why::Linkage(why) });
            }
        }
    }

    /// Tells the model the ratios that never change.
    pub fn set_constant_gears(&self, data: &mut Data) {
        for (k, s) in self.shafts.iter().enumerate().filter(|(_, s)| s.elastic.is_none()) {
            data.set_gear(k, s.gear.ratio, s.gear.bias);
        }
    }

    /// Torques and rates at the state of [`Train::load`], dry friction smoothed: what explicit methods integrate.
    ///
    /// Adds to the joints' torques; writes the currents' rates.
    pub fn explicit(&mut self, given: &Given<'_>, data: &mut Data, torque: &mut [f64], rate: &mut [f64]) {
        for (k, s) in self.shafts.iter().enumerate() {
            let current = given.current[k];
            // Power stage off: open terminals, at the voltage the motor induces; what current is left makes no torque.
            let motor = &s.drive.motor;
            let (voltage, driving) = if given.drives(k) {
                (s.voltage(current), motor.torque(current))
            } else {
                (motor.torque_constant * s.speed, 0.0)
            };
            rate[k] = motor.current_rate(current, voltage, s.speed); // (2.57)
            let friction = s.drive.friction.torque(s.speed, driving, SLOW).unwrap_or_else(|why| {
                self.fault.get_or_insert(Fault { drive: k, why: Why::Friction(why) });
                0.0
            });
            let brake = given.brake(s) * (s.speed / SLOW).clamp(-1.0, 1.0);
            s.apply(given, driving + friction - brake, data, torque);
        }
    }

    /// Sets the gears for prescribed joints: rotors turn with them, and nothing else of the drives is computed.
    pub fn load_prescribed(&mut self, q: &[f64], qd: &[f64], data: &mut Data) {
        for (k, s) in self.shafts.iter_mut().enumerate().filter(|(_, s)| s.is_linkage()) {
            let at = |x: &[f64]| s.joints.map(|j| x[j]);
            match s.drive.transmission.at(at(q), at(qd)) {
                Ok(gear) => data.set_gear(k, gear.ratio, gear.bias),
                Err(why) => _ = self.fault.get_or_insert(Fault { drive: k, why: Why::Linkage(why) }),
            }
        }
    }

    /// Rotor angles with relaxed gears.
    pub fn relax(&self, joints: &[f64], rotor: &mut [f64]) {
        for s in &self.shafts {
            if let Some((e, _)) = s.elastic.filter(|_| !rotor.is_empty()) {
                rotor[e] = joints[s.joints[0]];
            }
        }
    }

    /// Angles and speeds of the motors, in units of the joints they move most: where an elastic gear has its rotor, that;
    /// else the joint.
    pub fn motor_side(&self, rotor: (&[f64], &[f64]), angle: &mut [f64], speed: &mut [f64]) {
        for s in &self.shafts {
            if let Some((e, _)) = s.elastic.filter(|_| !rotor.0.is_empty()) {
                (angle[s.joints[0]], speed[s.joints[0]]) = (rotor.0[e], rotor.1[e]);
            }
        }
    }

    /// Rates of the elastic rotors' speeds, after the forward dynamics.
    pub fn rotor_rates(&self, model: &Model, data: &Data, rate: &mut [f64]) {
        for (k, s) in self.shafts.iter().enumerate() {
            if let Some((e, _)) = s.elastic {
                rate[e] = model.rotor_acceleration(data, k) / s.gear.ratio[0];
            }
        }
    }
}

impl Shaft {
    fn new(
        drive: &Description,
        joints: &[Joint],
        motor: usize,
        elastic: bool,
        count: &mut usize,
    ) -> Result<Self, String> {
        let coarse = Coarse::new(drive, joints)?;
        let first = drive.joints[0];
        let joint = |i: usize| drive.joints.get(i).copied().unwrap_or(first);
        let mut place = || {
            *count += 1;
            *count - 1
        };
        Ok(Self {
            motor,
            joints: [joint(0), joint(1), joint(2)],
            coupled: drive.joints.len().min(3),
            elastic: drive.elasticity.filter(|_| elastic).map(|spring| (place(), spring)),
            inertia: drive.rotor_inertia,
            speed_gain: 0.0,
            gear: drive.transmission.at([0.0; 3], [0.0; 3]).unwrap_or_default(),
            speed: 0.0,
            wanted: 0.0,
            lag: 0.0,
            sampler: Sampler::new(&drive.control),
            coarse,
            step: Step::default(),
            drive: drive.clone(),
        })
    }

    /// Whether the ratio changes with the joints.
    fn is_linkage(&self) -> bool {
        !matches!(self.drive.transmission, Transmission::Harmonic { .. })
    }

    /// Hands the torque of the shaft on to the joints, through the gear.
    fn apply(&self, given: &Given<'_>, shaft: f64, data: &mut Data, torque: &mut [f64]) {
        match &self.elastic {
            None => {
                for i in 0..self.coupled {
                    torque[self.joints[i]] += self.gear.ratio[i] * shaft;
                }
            }
            Some((e, spring)) => {
                let twist = spring.torque(given.joint.0[self.joints[0]] - given.rotor.0[*e]);
                torque[self.joints[0]] -= twist; // (2.70)
                data.set_free_rotor(self.motor, self.speed, shaft + twist / self.gear.ratio[0]);
            }
        }
    }
}

/// The rotors of a robot's drives, in their order.
pub(crate) fn rotors(robot: &Robot, elastic: bool) -> Vec<Rotor> {
    let rotor = |d: &Description| Rotor {
        name: d.name.clone(),
        link: d.stator.clone(),
        axis: nalgebra::Vector3::from(d.axis),
        inertia: d.rotor_inertia,
        joints: if elastic && d.elasticity.is_some() { Vec::new() } else { d.joints.clone() },
    };
    robot.drives.iter().map(rotor).collect()
}

/// Sets the gains of the speed loops for the inertia that each motor feels of the robot hanging in a pose.
fn tune(shafts: &mut [Shaft], model: &Model, hanging: &[f64]) {
    let mut data = Data::new(model);
    let mut q = model.neutral();
    q[7..].copy_from_slice(hanging);
    for (k, s) in shafts.iter_mut().enumerate() {
        // A pose beyond a dead point is refused where the robot is loaded.
        if let Ok(gear) = s.drive.transmission.at(s.joints.map(|j| hanging[j]), [0.0; 3]) {
            s.gear = gear;
        }
        if s.elastic.is_none() {
            data.set_gear(k, s.gear.ratio, 0.0);
        }
    }
    model.mass_matrix(&mut data, &q);
    for s in shafts {
        let mut x = vec![0.0; model.nv()];
        for i in 0..s.coupled {
            x[6 + s.joints[i]] += s.gear.ratio[i];
        }
        let c = x.clone();
        model.solve_mass_matrix(&mut data, &mut x);
        s.inertia = 1.0 / x.iter().zip(&c).map(|(x, c)| x * c).sum::<f64>();
        if s.elastic.is_some() {
            s.inertia += s.drive.rotor_inertia; // not in the mass matrix
        }
        if let Law::Cascade(cascade) = s.drive.control.law {
            s.speed_gain = cascade.speed_bandwidth * s.inertia / s.drive.motor.torque_constant;
        }
    }
}
