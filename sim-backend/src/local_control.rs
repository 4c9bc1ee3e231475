//! Local controllers: from the encoders of a shaft to the current or voltage that the law sets (thesis 5.5).
//!
//! ```text
//! cascade   w_d = c q'_d + K_x c (q_d - q_a),   I_d = K_v (w_d - w_b),   U = R I_d + k_M w + L w_c (I_d - I)
//! voltage   U = C c (q_d - q) + D (w_d - w) + k_M w_d,   w_d = c q'_d                                  (5.40)
//! ```
//!
//! The third, `cascade_pi`, with its integral and its own clock: `servo.rs`.
//!
//! Between two cycles of the bus the references are the cubic through the targets of both, angle and speed
//! ([`crate::drive::JointCubic`]). Controllers that count and look up instead of measuring and computing: `resolution.rs`.
//!
//! a, b: sides of an elastic gear that are measured; behind a rigid one both are the same. A law is computed at every
//! instant, or with the references of an instant and then held: once per bus cycle, or by the drive's own clock.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | c | speed of the motor by the speeds of its joints | 1 |
//! | q_d, q | references of the joints, joints or rotors in units of joints | rad |
//! | w_d, w | speed of the shaft, wanted and seen | rad/s |
//! | K_x, K_v, w_c, C, D | gains, see [`drives::JointControl`]; `K_v = w_v J/k_M` | |

use config::robot::{Drive as DriveData, Joint};
use drives::{ControlLaw, GearSide, JointControl, OutOfDomain, Sampled, Sampling};

use crate::inputs::Substep;
use crate::resolution::{Angles, Coarse};
use crate::servo::Servo;
use crate::shaft::{Shaft, TrainInputs};

/// Readings of a shaft in units of its motor, on the link's side and on the motor's.
pub(crate) struct ShaftReadings {
    /// c q'_d \[rad/s\].
    pub(crate) wanted: f64,
    /// c (q_d - q) \[rad\].
    pub(crate) error: [f64; 2],
    /// \[rad/s\]
    speed: [f64; 2],
}

/// Output of a controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ControllerOutput {
    /// That of its law at each instant.
    Continuous,
    /// A current I_d \[A\].
    Current(f64),
    /// A voltage U \[V\].
    Voltage(f64),
}

/// Memory of a sampled controller.
#[derive(Clone, Copy, Debug)]
struct Sampler {
    output: ControllerOutput,
    /// Computed, and not yet put out.
    next: ControllerOutput,
    /// \[rad\] Angles of the joints at the last sample, by side.
    last: Option<[[f64; 3]; 2]>,
}

/// Controller of one motor.
#[derive(Clone)]
pub(crate) struct MotorController {
    /// K_v \[A s/rad\].
    pub(crate) speed_gain: f64,
    /// Speed that the position loop of a cascade asks for, and its distance from the speed seen \[rad/s\].
    pub(crate) wanted: f64,
    pub(crate) lag: f64,
    /// Memory of a law that is sampled once per cycle, and what any sampled one holds.
    sampler: Sampler,
    /// Memory of a law with a clock of its own.
    servo: Option<Servo>,
    /// Counts and tables, if it has them.
    coarse: Option<Coarse>,
}

impl Sampler {
    /// Of a controller that has measured nothing: no current, terminals shorted.
    fn new(control: &JointControl) -> Self {
        let output = match (control.sampling, control.law) {
            (Sampling::Continuous, _) => ControllerOutput::Continuous,
            (_, law) if law.current_bandwidth().is_some() => ControllerOutput::Current(0.0),
            _ => ControllerOutput::Voltage(0.0),
        };
        Self { output, next: output, last: None }
    }
}

impl MotorController {
    /// Controller of a drive that moves some of `joints`; its speed loop is tuned later.
    ///
    /// # Errors
    /// Its linkage has no look-up table where it needs one.
    pub(crate) fn new(drive: &DriveData, joints: &[Joint]) -> Result<Self, String> {
        let coarse = Coarse::new(drive, joints)?;
        let sampler = Sampler::new(&drive.control);
        Ok(Self { speed_gain: 0.0, wanted: 0.0, lag: 0.0, sampler, servo: Servo::new(drive, joints), coarse })
    }

    /// Output that is held now; [`ControllerOutput::Continuous`]: none is held.
    pub(crate) fn output(&self) -> ControllerOutput {
        self.sampler.output
    }

    /// Takes a new state: returns the speed w of the shaft \[rad/s\], and keeps its distance from the wanted one, with
    /// the gear as it is.
    ///
    /// The second result is an error where a joint is to be, or is, where the drive has no numbers for it; it goes on with
    /// those it had.
    pub(crate) fn load(&mut self, shaft: &Shaft, inputs: &TrainInputs<'_>) -> (f64, Result<(), OutOfDomain>) {
        if self.servo.is_some() {
            // It looks when its clock ticks.
            let speed = |i: usize| shaft.gear.ratio[i] * shaft.at(GearSide::Motor, i, inputs).1;
            return ((0..shaft.coupled).map(speed).sum(), Ok(()));
        }
        let looked = self.look(shaft, inputs);
        let seen = self.read(shaft, inputs);
        if let ControlLaw::Cascade(cascade) = shaft.drive.control.law {
            let feedback = cascade.feedback;
            self.wanted = cascade.speed_wanted(seen.error[feedback.position() as usize], seen.wanted);
            self.lag = self.wanted - seen.speed[feedback.speed() as usize];
        }
        // Without supply nobody computes.
        let looked = if inputs.switches.powered { looked } else { Ok(()) };
        (seen.speed[GearSide::Motor as usize], looked)
    }

    /// Gives the joints' angles to a controller with coarse numbers.
    fn look(&mut self, shaft: &Shaft, inputs: &TrainInputs<'_>) -> Result<(), OutOfDomain> {
        let Some(coarse) = &mut self.coarse else { return Ok(()) };
        let angles =
            |of: &dyn Fn(usize) -> f64| [0, 1, 2].map(|i| if i < shaft.coupled { of(i) } else { 0.0 });
        let at = Angles {
            reference: angles(&|i| inputs.reference[shaft.joints[i]].angle),
            measured: [GearSide::Link, GearSide::Motor].map(|side| angles(&|i| shaft.at(side, i, inputs).0)),
        };
        coarse.look(&shaft.drive.transmission, &at)
    }

    /// Clock of the drive itself: measures and computes if the beginning of the integration step is one of its instants, at the
    /// state of [`MotorController::load`].
    ///
    /// The result is an error as there.
    pub(crate) fn tick(
        &mut self,
        shaft: &Shaft,
        step: Substep,
        inputs: &TrainInputs<'_>,
    ) -> Result<(), OutOfDomain> {
        if !self.is_due(step) {
            return Ok(());
        }
        let looked = self.look(shaft, inputs);
        let seen = self.read(shaft, inputs);
        if let Some(servo) = &mut self.servo {
            self.sampler.output = servo.sample(shaft, self.speed_gain, step, &seen, inputs);
        }
        if inputs.switches.powered { looked } else { Ok(()) }
    }

    /// True if the beginning of a step is an instant of the drive's own clock.
    pub(crate) fn is_due(&self, step: Substep) -> bool {
        self.servo.as_ref().is_some_and(|servo| servo.is_due(step))
    }

    /// Measures and computes once, at the state of [`MotorController::load`]; `cycle` \[s\] since the last time.
    pub(crate) fn sample(&mut self, shaft: &Shaft, cycle: f64, inputs: &TrainInputs<'_>) {
        let Sampling::Cycle(sampled) = shaft.drive.control.sampling else { return };
        let seen = self.read_sample(shaft, cycle, inputs, sampled);
        let motor = GearSide::Motor as usize;
        let output = match shaft.drive.control.law {
            ControlLaw::Cascade(cascade) => {
                let feedback = cascade.feedback;
                let wanted = cascade.speed_wanted(seen.error[feedback.position() as usize], seen.wanted);
                ControllerOutput::Current(self.speed_gain * (wanted - seen.speed[feedback.speed() as usize]))
            }
            // Never: it has a clock of its own.
            ControlLaw::CascadePi(_) => return,
            ControlLaw::Voltage(law) => {
                let motor_seen = (seen.error[motor], seen.speed[motor]);
                ControllerOutput::Voltage(law.voltage(
                    &shaft.drive.motor,
                    motor_seen.0,
                    seen.wanted,
                    motor_seen.1,
                ))
            }
        };
        // A controller that needs the whole cycle for computing puts out what it found in the last one.
        self.sampler.output = if sampled.delay { self.sampler.next } else { output };
        self.sampler.next = output;
    }

    /// Readings at a sample.
    fn read_sample(
        &mut self,
        shaft: &Shaft,
        cycle: f64,
        inputs: &TrainInputs<'_>,
        sampled: Sampled,
    ) -> ShaftReadings {
        let mut seen = self.read(shaft, inputs);
        let angles = [GearSide::Link, GearSide::Motor].map(|side| {
            let place = |i: usize| if i < shaft.coupled { shaft.at(side, i, inputs).0 } else { 0.0 };
            [place(0), place(1), place(2)]
        });
        // A first difference is that of a shaft at rest.
        let last = self.sampler.last.replace(angles).unwrap_or(angles);
        if sampled.difference {
            for side in 0..2 {
                let turned = |i: usize| shaft.gear.ratio[i] * (angles[side][i] - last[side][i]);
                seen.speed[side] = (0..shaft.coupled).map(turned).sum::<f64>() / cycle;
            }
            // A controller that counts differentiates counts, not the angles behind them.
            if let Some(coarse) = &mut self.coarse {
                seen.speed[GearSide::Motor as usize] = coarse.speed(cycle);
            }
        }
        seen
    }

    /// Readings at an instant.
    fn read(&self, shaft: &Shaft, inputs: &TrainInputs<'_>) -> ShaftReadings {
        let mut seen = ShaftReadings { wanted: 0.0, error: [0.0; 2], speed: [0.0; 2] };
        for i in 0..shaft.coupled {
            let (c, reference) = (shaft.gear.ratio[i], &inputs.reference[shaft.joints[i]]);
            seen.wanted += c * reference.speed;
            for side in [GearSide::Link, GearSide::Motor] {
                let (angle, speed) = shaft.at(side, i, inputs);
                seen.error[side as usize] += c * (reference.angle - angle);
                seen.speed[side as usize] += c * speed;
            }
        }
        if let Some(coarse) = &self.coarse {
            let speed = |i: usize| coarse.ratio()[i] * inputs.reference[shaft.joints[i]].speed;
            seen.wanted = (0..shaft.coupled).map(speed).sum();
            seen.error = coarse.error();
        }
        seen
    }

    /// Current the speed loop asks for \[A\].
    pub(crate) fn wanted_current(&self, shaft: &Shaft) -> f64 {
        let limit = shaft.drive.current_limit;
        let wanted = match self.sampler.output {
            ControllerOutput::Current(held) => held,
            _ => self.speed_gain * self.lag,
        };
        wanted.clamp(-limit, limit)
    }

    /// Current \[A\] of a motor whose inductance is neglected: what the speed loop asks for, as far as the voltage reaches.
    pub(crate) fn steady_current(&self, shaft: &Shaft) -> f64 {
        let motor = &shaft.drive.motor;
        let voltage = match self.sampler.output {
            ControllerOutput::Voltage(held) => held,
            _ => motor.voltage(self.wanted_current(shaft), shaft.speed),
        };
        let limit = shaft.drive.voltage_limit;
        motor.steady_current(voltage.clamp(-limit, limit), shaft.speed)
    }

    /// Voltage that the controller sets \[V\].
    pub(crate) fn voltage(&self, shaft: &Shaft, current: f64) -> f64 {
        let motor = &shaft.drive.motor;
        let voltage = match (self.sampler.output, shaft.drive.control.law.current_bandwidth()) {
            (ControllerOutput::Voltage(held), _) => held,
            (_, Some(bandwidth)) => {
                motor.loop_voltage(bandwidth, self.wanted_current(shaft), current, shaft.speed)
            }
            // Never: a law without a current loop is sampled, its output a voltage.
            (_, None) => 0.0,
        };
        voltage.clamp(-shaft.drive.voltage_limit, shaft.drive.voltage_limit)
    }
}
