//! One drive in an implicit step: motor, controller, spring and dry friction at the end of the step.
//!
//! Over a step h a drive is linear in the speed w+ at its end: its shaft gives `T0 - b w+`, with the current and the
//! elastic gear eliminated, so b goes to the mass matrix and nothing of it limits the step. Dry friction is set-valued:
//! a shaft either sticks (w+ = 0, friction inside of its cone) or turns (friction C against the direction), found by
//! trying, as for the contact points; that is the proximal point of (2.44), (2.45) with each state solved exactly.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | w, w+ | speed of the shaft at begin and end of the step | rad/s |
//! | v | speed that the motor would have, did it turn with the link behind an elastic gear | rad/s |
//! | T0, b | torque at w+ = 0, and what of it is lost per speed | N m, N m s |
//! | C | level of dry friction and brake | N m |
//! | A, B | speed of an elastic rotor at the end, th'+ = A + B q'+ | rad/s, 1 |

use drives::{Cascade, ControlLaw, Elasticity, GearSide, NoLoadTorque, Sliding};
use multibody::{Data, Model};

use crate::local_control::{ControllerOutput, MotorController};
use crate::shaft::{Shaft, TrainInputs};

/// \[1\] Resistance of a sticking shaft, in its inertia per step.
const STICKING: f64 = 1e7;

/// A torque over one step: `t - b w+ - link v`.
#[derive(Clone, Copy, Default)]
struct TorqueLine {
    t: f64,
    b: f64,
    link: f64,
}

/// State of dry friction during a step.
#[derive(Clone, Copy, Default, PartialEq)]
enum ShaftFriction {
    /// The shaft sticks.
    #[default]
    Sticks,
    /// It turns in the direction +1 or -1.
    Turns(f64),
}

/// A drive as its joints see it over one step: torque `t - b w+`, along these ratios.
pub(crate) struct JointLine {
    pub(crate) t: f64,
    pub(crate) b: f64,
    pub(crate) ratio: [f64; 3],
}

/// Scratch of one drive over one step. What is here at its end is the guess that the next step begins with.
#[derive(Clone, Copy, Default)]
pub(crate) struct ShaftStep {
    motor: TorqueLine,
    /// Level of dry friction of the gear \[N m\], and C.
    dry: f64,
    coulomb: f64,
    viscous: f64,
    slip: ShaftFriction,
    /// w+ and v \[rad/s\].
    end: f64,
    link: f64,
    /// Torque on a rotor behind an elastic gear \[N m\], and what of it turns the rotor along with its stator.
    torque: f64,
    along: f64,
    /// The torque that the model was given.
    set: f64,
    /// \[A\] Current of a motor whose current has no state.
    steady: f64,
}

impl ShaftStep {
    /// Motor and friction as functions of the speed at the end of the step.
    pub(crate) fn begin(
        &mut self,
        h: f64,
        shaft: &Shaft,
        controller: &MotorController,
        inputs: &TrainInputs<'_>,
    ) -> Result<(), NoLoadTorque> {
        let on = inputs.switches.has_torque(shaft.motor);
        let state = inputs.current.get(shaft.motor).copied();
        let current = if on { state.unwrap_or_else(|| controller.steady_current(shaft)) } else { 0.0 };
        // Friction depends on the load, which is taken from the beginning of the step: within one it changes little.
        let found = shaft.drive.friction.sliding(shaft.speed, shaft.drive.motor.torque(current));
        let before = Sliding { dry: self.dry, viscous: self.viscous };
        let Sliding { dry, viscous } = *found.as_ref().unwrap_or(&before);
        // Power stage off: open terminals, no torque.
        let motor = if on { motor_line(h, shaft, controller, state) } else { TorqueLine::default() };
        let coulomb = dry + shaft.holding_torque(&inputs.switches);
        *self = Self { motor, dry, coulomb, viscous, ..*self };
        found.map(|_| ())
    }

    /// Motor and friction together.
    fn shaft_line(&self, h: f64, shaft: &Shaft) -> TorqueLine {
        let Self { motor: TorqueLine { t, b, link }, coulomb, viscous, slip, .. } = *self;
        match slip {
            ShaftFriction::Turns(s) => TorqueLine { t: t - s * coulomb, b: b + viscous, link },
            ShaftFriction::Sticks => TorqueLine { t, b: b + STICKING * shaft.inertia / h, link },
        }
    }

    /// The drive as its joints see it: behind an elastic gear the spring, with the rotor eliminated.
    pub(crate) fn joint_line(&self, h: f64, shaft: &Shaft, inputs: &TrainInputs<'_>) -> JointLine {
        let line = self.shaft_line(h, shaft);
        let Some((e, spring)) = &shaft.elastic else {
            return JointLine { t: line.t, b: line.b, ratio: shaft.gear.ratio };
        };
        let twist = inputs.joint.0[shaft.joints[0]] - inputs.rotor.0[*e];
        let (free, share) = self.rotor(h, shaft, inputs, (*e, spring), line);
        let stiff = spring.tangent(twist) * h;
        let (t, b) = (stiff * free - spring.torque(twist), stiff * (1.0 - share));
        JointLine { t, b, ratio: [1.0, 0.0, 0.0] }
    }

    /// Rotor behind an elastic gear: A and B of th'+ = A + B q'+.
    fn rotor(
        &self,
        h: f64,
        shaft: &Shaft,
        inputs: &TrainInputs<'_>,
        (e, spring): (usize, &Elasticity),
        line: TorqueLine,
    ) -> (f64, f64) {
        // In units of the joint: inertia and damping N^2 times, torques N times.
        let n = shaft.gear.ratio[0];
        let inertia = shaft.drive.rotor_inertia * n * n;
        let twist = inputs.joint.0[shaft.joints[0]] - inputs.rotor.0[e];
        // The spring at the end of the step: its torque now, and its tangent by what both sides turn meanwhile.
        let stiff = h * h * spring.tangent(twist);
        let total = inertia + h * n * n * line.b + stiff;
        // What turns the stator turns the rotor along, and is not the motor's to give.
        let driving = n * (line.t - self.along) + spring.torque(twist);
        let free = inertia * inputs.rotor.1[e] + h * driving;
        (free / total, (stiff - h * n * n * line.link) / total)
    }

    /// Speed of the shaft at the end of the step for joint accelerations `a`.
    pub(crate) fn finish(&mut self, h: f64, shaft: &Shaft, inputs: &TrainInputs<'_>, a: &[f64]) {
        self.end = match &shaft.elastic {
            None => {
                let change: f64 = (0..shaft.coupled).map(|i| shaft.gear.ratio[i] * a[shaft.joints[i]]).sum();
                shaft.speed + h * (change + shaft.gear.bias)
            }
            Some((e, spring)) => {
                let (free, share) = self.rotor(h, shaft, inputs, (*e, spring), self.shaft_line(h, shaft));
                let joint = inputs.joint.1[shaft.joints[0]] + h * a[shaft.joints[0]];
                let end = shaft.gear.ratio[0] * (free + share * joint);
                self.link = shaft.gear.ratio[0] * joint;
                self.torque = shaft.drive.rotor_inertia * (end - shaft.speed) / h + self.along;
                end
            }
        };
    }

    /// True if friction does what it was taken to do.
    pub(crate) fn is_settled(&self, h: f64, shaft: &Shaft) -> bool {
        match self.slip {
            ShaftFriction::Turns(s) => s * self.end >= 0.0,
            ShaftFriction::Sticks => STICKING * shaft.inertia / h * self.end.abs() <= self.coulomb,
        }
    }

    /// The other state of friction.
    pub(crate) fn change(&mut self) {
        self.slip = match self.slip {
            ShaftFriction::Turns(_) => ShaftFriction::Sticks,
            ShaftFriction::Sticks => ShaftFriction::Turns(self.end.signum()),
        };
    }

    /// True if friction holds the shaft at the end of the step.
    pub(crate) fn sticks(&self) -> bool {
        self.slip == ShaftFriction::Sticks
    }

    /// Gives the model the torque on a free rotor that the step before found.
    pub(crate) fn give_free_rotor(&mut self, shaft: &Shaft, data: &mut Data) {
        self.set = self.torque;
        data.set_free_rotor(shaft.motor, shaft.speed, self.torque);
    }

    /// Notes how the stator of a free rotor turns, after the acceleration has been taken to the bodies.
    pub(crate) fn turn_along(&mut self, shaft: &Shaft, model: &Model, data: &Data) {
        self.along = self.set - shaft.drive.rotor_inertia * model.rotor_acceleration(data, shaft.motor);
    }

    /// Current of the motor at the end of the step \[A\].
    pub(crate) fn current(&self, shaft: &Shaft) -> f64 {
        let TorqueLine { t, b, link } = self.motor;
        (t - b * self.end - link * self.link) / shaft.drive.motor.torque_constant
    }

    /// Keeps the current \[A\] of a motor whose current has no state.
    pub(crate) fn note_current(&mut self, current: f64) {
        self.steady = current;
    }

    /// \[A\] What was kept.
    pub(crate) fn steady_current(&self) -> f64 {
        self.steady
    }

    /// w+ \[rad/s\].
    pub(crate) fn end_speed(&self) -> f64 {
        self.end
    }
}

/// Torque of the motor: (2.57) and the control laws, implicit; without a state of its own the current follows at once.
fn motor_line(h: f64, shaft: &Shaft, controller: &MotorController, state: Option<f64>) -> TorqueLine {
    let motor = &shaft.drive.motor;
    let constant = motor.torque_constant;
    let current = state.unwrap_or_else(|| controller.steady_current(shaft));
    // A voltage that does not change: the current of the end by (2.57), with the motor's own damping.
    let at_voltage = |voltage: f64| {
        if state.is_none() {
            let per = constant / motor.resistance;
            return TorqueLine { t: per * voltage, b: per * constant, link: 0.0 };
        }
        let a = 1.0 / (1.0 + h / motor.time_constant());
        let per = h / motor.inductance * a * constant;
        TorqueLine { t: constant * a * current + per * voltage, b: per * constant, link: 0.0 }
    };
    let voltage = controller.voltage(shaft, current);
    let law = shaft.drive.control.law;
    let Some(bandwidth) = law.current_bandwidth() else { return at_voltage(voltage) };
    // At its limit the voltage no longer answers to the current, and the loops are open.
    if voltage.abs() >= shaft.drive.voltage_limit {
        return at_voltage(voltage);
    }
    // The current loop closes within the step: the current goes from what it was to what is asked for.
    let closing = 1.0 / (1.0 + h * (bandwidth + 1.0 / motor.time_constant()));
    let a = if state.is_some() { closing } else { 0.0 };
    let held = controller.output() != ControllerOutput::Continuous;
    let open = held || (controller.speed_gain * controller.lag).abs() >= shaft.drive.current_limit;
    // Held by the sampler, or at its limit: what is asked for does not depend on the speed.
    let (ControlLaw::Cascade(cascade), false) = (law, open) else {
        let t = constant * (a * current + (1.0 - a) * controller.wanted_current(shaft));
        return TorqueLine { t, ..TorqueLine::default() };
    };
    // Else speed and position loop close within the step, too.
    let share = constant * (1.0 - a) * controller.speed_gain;
    let [link, b] = lost_lag(h, shaft, &cascade).map(|seen| share * seen);
    TorqueLine { t: constant * a * current + share * controller.wanted, b, link }
}

/// Loss of the lag at the end of a step to the speeds of link and rotor: K_x h of a side that gives the angle, 1 of one
/// that gives the speed.
fn lost_lag(h: f64, shaft: &Shaft, cascade: &Cascade) -> [f64; 2] {
    let mut seen = [0.0; 2];
    // Behind a stiff gear both sides are the motor's.
    let mut add = |side: GearSide, x: f64| seen[if shaft.elastic.is_some() { side as usize } else { 1 }] += x;
    add(cascade.feedback.position(), h * cascade.position_gain);
    add(cascade.feedback.speed(), 1.0);
    seen
}
