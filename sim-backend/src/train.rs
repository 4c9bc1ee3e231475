//! Drive trains with their local controllers: from joint targets to torques, by motor, gear and friction (thesis 2.4).
//!
//! A train is a shaft ([`crate::shaft`]), its controller (`local_control.rs`) and the scratch of an implicit step
//! (`implicit.rs`, all of them together `train_step.rs`). The control law is data of the drive.
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
use config::robot::Drive as DriveData;
use config::scene::FRICTION_RAMP;
use drives::{NoLoadTorque, OutOfDomain, Sampling};
use multibody::{Damper, Data, Model, Rotor};

use crate::implicit::ShaftStep;
use crate::inputs::Substep;
use crate::local_control::MotorController;
use crate::shaft::{Shaft, TrainInputs};

/// All drives of a robot.
#[derive(Clone)]
pub struct Train {
    pub(crate) drives: Vec<DriveTrain>,
    elastic: usize,
    /// Currents have states of their own; else a motor has that of its voltage and speed at once.
    electrical: bool,
    /// \[rad/s\] Speed of a rotor over which [`Train::explicit`] changes the sign of dry friction.
    pub(crate) friction_ramp: f64,
    pub(crate) fault: Option<TrainFault>,
    /// Share of each drive in the mass matrix of an implicit step.
    pub(crate) dampers: Vec<Damper>,
}

/// One drive.
#[derive(Clone)]
pub(crate) struct DriveTrain {
    pub(crate) shaft: Shaft,
    pub(crate) controller: MotorController,
    /// Scratch of an implicit step.
    pub(crate) step: ShaftStep,
}

/// A drive outside of what its model holds for; what it did last goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrainFault {
    /// Number of the drive.
    pub drive: usize,
    /// Cause.
    pub why: FaultCause,
}

/// Cause of a [`TrainFault`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FaultCause {
    /// The linkage is at its dead point, or beyond, or outside of the controller's look-up table.
    Linkage(OutOfDomain),
    /// The friction has no unique load torque.
    Friction(NoLoadTorque),
    /// An implicit step did not find out whether the shaft sticks or turns.
    Unsettled,
}

impl Train {
    /// The drives of `robot`, whose rotors `model` has. The speed loops are tuned for the robot hanging in the pose
    /// `hanging` \[rad\].
    ///
    /// # Errors
    /// The drives do not belong to the model, or a linkage has no look-up table where its controller needs one.
    pub fn new(
        robot: &Robot,
        model: &Model,
        electrical: bool,
        hanging: &[f64],
    ) -> Result<Self, Box<dyn Error>> {
        let mut elastic = 0;
        let mut drive = |(k, data): (usize, &DriveData)| {
            let controller = MotorController::new(data, &robot.joints)?;
            let shaft = Shaft::new(data, k, data.elasticity.map(|spring| (elastic, spring)));
            elastic += usize::from(data.elasticity.is_some());
            Ok::<_, String>(DriveTrain { shaft, controller, step: ShaftStep::default() })
        };
        let mut drives = robot.drives.iter().enumerate().map(&mut drive).collect::<Result<Vec<_>, _>>()?;
        tune(&mut drives, model, hanging);
        let dampers = robot.drives.iter().map(|d| model.damper(&d.joints)).collect::<Result<_, _>>()?;
        Ok(Self { drives, elastic, electrical, friction_ramp: FRICTION_RAMP, fault: None, dampers })
    }

    /// Elastic gears.
    pub fn elastic(&self) -> usize {
        self.elastic
    }

    /// Motors whose currents have states.
    pub fn motors(&self) -> usize {
        if self.electrical { self.drives.len() } else { 0 }
    }

    /// The sampled controllers measure at the state of [`Train::load`] and compute what they hold for a cycle \[s\].
    pub fn sample(&mut self, cycle: f64, inputs: &TrainInputs<'_>) {
        for DriveTrain { shaft, controller, .. } in &mut self.drives {
            controller.sample(shaft, cycle, inputs);
        }
    }

    /// The controllers with a clock of their own measure and compute, those whose instant is the beginning of the step, at the
    /// state of [`Train::load`].
    pub fn tick(&mut self, step: Substep, inputs: &TrainInputs<'_>) {
        let Self { drives, fault, .. } = self;
        for (drive, DriveTrain { shaft, controller, .. }) in drives.iter_mut().enumerate() {
            if let Err(why) = controller.tick(shaft, step, inputs) {
                _ = fault.get_or_insert(TrainFault { drive, why: FaultCause::Linkage(why) });
            }
        }
    }

    /// True if a controller is sampled once per cycle.
    pub(crate) fn is_sampled(&self) -> bool {
        self.drives.iter().any(|d| matches!(d.shaft.drive.control.sampling, Sampling::Cycle(_)))
    }

    /// True if the beginning of a step is an instant of a controller's own clock.
    pub(crate) fn is_due(&self, step: Substep) -> bool {
        self.drives.iter().any(|d| d.controller.is_due(step))
    }

    /// Gains K_v of the speed loops, one per motor; 0 without one \[A s/rad\].
    pub fn speed_gains(&self) -> impl Iterator<Item = f64> + '_ {
        self.drives.iter().map(|d| d.controller.speed_gain)
    }

    /// Sets them.
    pub fn set_speed_gains(&mut self, gains: impl IntoIterator<Item = f64>) {
        for (d, gain) in self.drives.iter_mut().zip(gains) {
            d.controller.speed_gain = gain;
        }
    }

    /// The first fault since the last call.
    pub fn take_fault(&mut self) -> Option<TrainFault> {
        self.fault.take()
    }

    /// Sets the gears for the joints' angles and speeds.
    pub fn load(&mut self, inputs: &TrainInputs<'_>, data: &mut Data) {
        let Self { drives, fault, .. } = self;
        for (drive, DriveTrain { shaft, controller, .. }) in drives.iter_mut().enumerate() {
            let mut note = |why| _ = fault.get_or_insert(TrainFault { drive, why: FaultCause::Linkage(why) });
            if shaft.is_linkage() {
                let of_joints = |x: &[f64]| shaft.joints.map(|j| x[j]);
                let at = shaft.drive.transmission.at(of_joints(inputs.joint.0), of_joints(inputs.joint.1));
                match at {
                    Ok(gear) => shaft.gear = gear,
                    Err(why) => note(why), // the gear of the last state goes on
                }
                data.set_gear(drive, shaft.gear.ratio, shaft.gear.bias);
            }
            let (speed, looked) = controller.load(shaft, inputs);
            shaft.speed = speed;
            if let Err(why) = looked {
                note(why);
            }
        }
    }

    /// Gives the model the ratios that never change.
    pub(crate) fn set_constant_gears(&self, data: &mut Data) {
        let stiff = self.drives.iter().enumerate().filter(|(_, d)| d.shaft.elastic.is_none());
        for (k, DriveTrain { shaft, .. }) in stiff {
            data.set_gear(k, shaft.gear.ratio, shaft.gear.bias);
        }
    }

    /// Torques and rates at the state of [`Train::load`], dry friction smoothed: what explicit methods integrate.
    ///
    /// Adds to the joints' torques; writes the currents' rates.
    pub fn explicit(
        &mut self,
        inputs: &TrainInputs<'_>,
        data: &mut Data,
        torque: &mut [f64],
        rate: &mut [f64],
    ) {
        let ramp = self.friction_ramp;
        for (drive, DriveTrain { shaft, controller, step }) in self.drives.iter_mut().enumerate() {
            let current = match inputs.current.get(drive) {
                Some(current) => *current,
                None => controller.steady_current(shaft),
            };
            // Power stage off: open terminals, at the voltage the motor induces; what current is left makes no torque.
            let motor = &shaft.drive.motor;
            let (voltage, driving) = if inputs.switches.has_torque(drive) {
                (controller.voltage(shaft, current), motor.torque(current))
            } else {
                (motor.torque_constant * shaft.speed, 0.0)
            };
            match rate.get_mut(drive) {
                Some(rate) => *rate = motor.current_rate(current, voltage, shaft.speed), // (2.57)
                None => step.note_current(driving / motor.torque_constant),
            }
            let friction = shaft.drive.friction.torque(shaft.speed, driving, ramp).unwrap_or_else(|why| {
                self.fault.get_or_insert(TrainFault { drive, why: FaultCause::Friction(why) });
                0.0
            });
            // A closed brake is dry friction, too, and is smoothed in the same way.
            let brake = shaft.holding_torque(&inputs.switches) * (shaft.speed / ramp).clamp(-1.0, 1.0);
            shaft.apply(inputs, driving + friction - brake, data, torque);
        }
    }

    /// Sets the gears for prescribed joints: rotors turn with them, and nothing else of the drives is computed.
    pub(crate) fn load_prescribed(&mut self, q: &[f64], qd: &[f64], data: &mut Data) {
        let Self { drives, fault, .. } = self;
        let linkages = drives.iter().enumerate().filter(|(_, d)| d.shaft.is_linkage());
        for (drive, DriveTrain { shaft, .. }) in linkages {
            let at = |x: &[f64]| shaft.joints.map(|j| x[j]);
            match shaft.drive.transmission.at(at(q), at(qd)) {
                Ok(gear) => data.set_gear(drive, gear.ratio, gear.bias),
                Err(why) => {
                    _ = fault.get_or_insert(TrainFault { drive, why: FaultCause::Linkage(why) });
                }
            }
        }
    }

    /// Rotor angles with relaxed gears.
    pub fn relax(&self, joints: &[f64], rotor: &mut [f64]) {
        for DriveTrain { shaft, .. } in &self.drives {
            if let Some((e, _)) = shaft.elastic {
                rotor[e] = joints[shaft.joints[0]];
            }
        }
    }

    /// Joints behind elastic gears, with the places of their rotors.
    pub(crate) fn rotors(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.drives.iter().filter_map(|d| d.shaft.elastic.as_ref().map(|(e, _)| (d.shaft.joints[0], *e)))
    }

    /// \[A\] Current of each motor in the step that led here, of those without states of their own.
    pub(crate) fn steady_currents(&self) -> impl Iterator<Item = f64> + '_ {
        self.drives.iter().map(|d| d.step.steady_current())
    }

    /// Rates of the elastic rotors' speeds, after the forward dynamics.
    pub(crate) fn rotor_rates(&self, model: &Model, data: &Data, rate: &mut [f64]) {
        for (k, DriveTrain { shaft, .. }) in self.drives.iter().enumerate() {
            if let Some((e, _)) = shaft.elastic {
                rate[e] = model.rotor_acceleration(data, k) / shaft.gear.ratio[0];
            }
        }
    }
}

/// The rotors of a robot's drives, in their order.
pub(crate) fn rotors(robot: &Robot) -> Vec<Rotor> {
    let turns_by_itself = |d: &DriveData| d.elasticity.is_some();
    let rotor = |d: &DriveData| Rotor {
        name: d.name.clone(),
        link: d.stator.clone(),
        axis: nalgebra::Vector3::from(d.axis),
        inertia: d.rotor_inertia,
        joints: if turns_by_itself(d) { Vec::new() } else { d.joints.clone() },
    };
    robot.drives.iter().map(rotor).collect()
}

/// Sets the gains of the speed loops for the inertia that each motor feels of the robot hanging in a pose.
fn tune(drives: &mut [DriveTrain], model: &Model, hanging: &[f64]) {
    let mut data = Data::new(model);
    let mut q = model.neutral();
    q[7..].copy_from_slice(hanging);
    for (k, DriveTrain { shaft, .. }) in drives.iter_mut().enumerate() {
        // A pose beyond a dead point is refused where the robot is loaded.
        if let Ok(gear) = shaft.drive.transmission.at(shaft.joints.map(|j| hanging[j]), [0.0; 3]) {
            shaft.gear = gear;
        }
        if shaft.elastic.is_none() {
            data.set_gear(k, shaft.gear.ratio, 0.0);
        }
    }
    model.mass_matrix(&mut data, &q);
    for DriveTrain { shaft, controller, .. } in drives {
        // A unit torque of the motor accelerates it by c M^-1 c.
        let mut x = vec![0.0; model.nv()];
        for i in 0..shaft.coupled {
            x[6 + shaft.joints[i]] += shaft.gear.ratio[i];
        }
        let c = x.clone();
        model.solve_mass_matrix(&mut data, &mut x);
        shaft.inertia = 1.0 / x.iter().zip(&c).map(|(x, c)| x * c).sum::<f64>();
        if shaft.elastic.is_some() {
            shaft.inertia += shaft.drive.rotor_inertia; // not in the mass matrix
        }
        // Inertia of link and rotor: K_r I_m K_r is in the mass matrix, or added above (errata 3, (5-4)).
        if let Some(bandwidth) = shaft.drive.control.law.speed_bandwidth() {
            controller.speed_gain = bandwidth * shaft.inertia / shaft.drive.motor.torque_constant;
        }
    }
}
