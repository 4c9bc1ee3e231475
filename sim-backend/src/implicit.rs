//! The drive trains in an implicit step: motors, controllers, springs and dry friction at the end of the step.
//!
//! Over a step h each drive is linear in the speed w+ at its end: its shaft gives `T0 - b w+`, with the current and the
//! elastic gear eliminated, so b goes to the mass matrix and nothing of it limits the step. Dry friction is set-valued:
//! a shaft either sticks (w+ = 0, friction inside of its cone) or turns (friction C against the direction), found by
//! trying, as for the contact points; that is the proximal point of (2.44), (2.45) with each state solved exactly.

use drives::{Cascade, Elasticity, Law, NoLoadTorque, Side, Sliding};
use multibody::{Data, Model};

use crate::local_control::Output;
use crate::train::{Fault, Given, Shaft, Train, Why};

/// How many times the shaft's inertia per step a sticking shaft resists.
const STICKING: f64 = 1e7;
/// Rounds after which the states of friction are taken as they are.
const ROUNDS: usize = 12;

/// A torque over one step: `t - b w - link v`, w the speed at its end, v that of the link behind an elastic gear, as the
/// motor would turn with it.
#[derive(Clone, Copy, Default)]
struct Line {
    t: f64,
    b: f64,
    link: f64,
}

/// What dry friction does during a step.
#[derive(Clone, Copy, Default, PartialEq)]
enum Slip {
    /// The shaft sticks.
    #[default]
    Sticks,
    /// It turns in the direction +1 or -1.
    Turns(f64),
}

/// A shaft over one step.
#[derive(Clone, Copy, Default)]
pub(crate) struct Step {
    motor: Line,
    /// Level of dry friction of the gear \[N m\], and with the brake.
    dry: f64,
    coulomb: f64,
    viscous: f64,
    slip: Slip,
    /// Speed at the end, and v \[rad/s\].
    end: f64,
    link: f64,
    /// Torque on a rotor behind an elastic gear \[N m\], and what of it turns the rotor along with its stator.
    torque: f64,
    along: f64,
    /// The torque that the model was told of.
    set: f64,
}

impl Train {
    /// Solves M a = `force` - (bias, contact: all in `force`) with the drives at the end of a step `h` \[s\].
    ///
    /// In: generalized force without the drives, mass matrix in `data`. Out: acceleration in `out`. Which shafts stick is
    /// found in rounds; if these end before, the shaft that goes to and fro is a [`Fault`].
    pub fn solve(
        &mut self,
        h: f64,
        given: &Given<'_>,
        model: &Model,
        data: &mut Data,
        force: &[f64],
        out: &mut [f64],
    ) {
        for s in &mut self.shafts {
            if let Err(why) = s.begin(h, given) {
                self.fault.get_or_insert(Fault { drive: s.motor, why: Why::Friction(why) });
            }
        }
        for round in 1..=ROUNDS {
            out.copy_from_slice(force);
            for (s, damper) in self.shafts.iter().zip(&mut self.dampers) {
                let (line, ratio) = s.line(h, given);
                // The speed at the end of the step, but for what the acceleration adds.
                let mut now = if s.elastic.is_some() { 0.0 } else { h * s.gear.bias };
                for i in 0..s.coupled {
                    now += ratio[i] * given.joint.1[s.joints[i]];
                }
                let push = line.t - line.b * now;
                for i in 0..s.coupled {
                    out[6 + s.joints[i]] += ratio[i] * push;
                }
                damper.set(ratio, h * line.b);
            }
            model.solve_damped(data, &self.dampers, out);
            for s in &mut self.shafts {
                s.finish(h, given, &out[6..]);
            }
            let Some(wrong) = self.shafts.iter().position(|s| !s.is_settled(h)) else { return };
            if round == ROUNDS {
                self.fault.get_or_insert(Fault { drive: wrong, why: Why::Unsettled });
                return;
            }
            for s in self.shafts.iter_mut().filter(|s| !s.is_settled(h)) {
                s.change();
            }
        }
    }

    /// What the free rotors do to their stators: the torque that the step before found.
    pub fn free_rotors(&mut self, data: &mut Data) {
        for s in self.shafts.iter_mut().filter(|s| s.elastic.is_some()) {
            s.step.set = s.step.torque;
            data.set_free_rotor(s.motor, s.speed, s.step.torque);
        }
    }

    /// Notes how the stators of the free rotors turn, after the acceleration has been taken to the bodies.
    pub fn turn_along(&mut self, model: &Model, data: &Data) {
        for s in self.shafts.iter_mut().filter(|s| s.elastic.is_some()) {
            s.step.along = s.step.set - s.drive.rotor_inertia * model.rotor_acceleration(data, s.motor);
        }
    }

    /// What friction does now, to be restored after a trial.
    pub(crate) fn steps(&self) -> impl Iterator<Item = Step> + '_ {
        self.shafts.iter().map(|s| s.step)
    }

    /// Restores what [`Train::steps`] gave.
    pub(crate) fn restore(&mut self, steps: &[Step]) {
        for (s, step) in self.shafts.iter_mut().zip(steps) {
            s.step = *step;
        }
    }

    /// Moves currents and rotors to the end of the step, after [`Train::solve`].
    pub fn end(&self, h: f64, current: &mut [f64], rotor: (&mut [f64], &mut [f64])) {
        for (k, s) in self.shafts.iter().enumerate() {
            let Line { t, b, link } = s.step.motor;
            current[k] = (t - b * s.step.end - link * s.step.link) / s.drive.motor.torque_constant;
            if let Some((e, _)) = s.elastic {
                rotor.1[e] = s.step.end / s.gear.ratio[0];
                rotor.0[e] += h * rotor.1[e];
            }
        }
    }

    /// Whether a drive's only joint is held by friction at the end of the step.
    pub fn held_joints(&self) -> impl Iterator<Item = usize> + '_ {
        let held =
            |s: &&Shaft| s.step.slip == Slip::Sticks && s.elastic.is_none() && s.drive.joints.len() == 1;
        self.shafts.iter().filter(held).map(|s| s.joints[0])
    }
}

impl Shaft {
    /// Motor and friction as functions of the speed at the end of the step.
    fn begin(&mut self, h: f64, given: &Given<'_>) -> Result<(), NoLoadTorque> {
        let on = given.drives(self.motor);
        let current = if on { given.current[self.motor] } else { 0.0 };
        let found = self.drive.friction.sliding(self.speed, self.drive.motor.torque(current));
        let before = Sliding { dry: self.step.dry, viscous: self.step.viscous };
        let Sliding { dry, viscous } = *found.as_ref().unwrap_or(&before);
        // Power stage off: open terminals, no torque.
        let motor = if on { self.motor_line(h, current) } else { Line::default() };
        self.step = Step { motor, dry, coulomb: dry + given.brake(self), viscous, ..self.step };
        found.map(|_| ())
    }

    /// Torque of the motor: (2.57) and the control laws, implicit.
    fn motor_line(&self, h: f64, current: f64) -> Line {
        let motor = &self.drive.motor;
        let constant = motor.torque_constant;
        let at_voltage = |voltage: f64| {
            let a = 1.0 / (1.0 + h / motor.time_constant());
            let per = h / motor.inductance * a * constant;
            Line { t: constant * a * current + per * voltage, b: per * constant, link: 0.0 }
        };
        let voltage = self.voltage(current);
        let Law::Cascade(cascade) = self.drive.control.law else { return at_voltage(voltage) };
        if voltage.abs() >= self.drive.voltage_limit {
            return at_voltage(voltage);
        }
        let a = 1.0 / (1.0 + h * (cascade.current_bandwidth + 1.0 / motor.time_constant()));
        let held = self.sampler.output() != Output::Follow;
        if held || (self.speed_gain * self.lag).abs() >= self.drive.current_limit {
            let t = constant * (a * current + (1.0 - a) * self.wanted_current());
            return Line { t, ..Line::default() };
        }
        let share = constant * (1.0 - a) * self.speed_gain;
        let [link, b] = self.seen_at_the_end(h, &cascade).map(|seen| share * seen);
        Line { t: constant * a * current + share * self.wanted, b, link }
    }

    /// What the lag of the end of a step loses to the speeds of link and rotor: K_x h of a side that gives the angle, 1 of
    /// one that gives the speed.
    fn seen_at_the_end(&self, h: f64, cascade: &Cascade) -> [f64; 2] {
        let mut seen = [0.0; 2];
        let mut add = |side: Side, x: f64| seen[if self.elastic.is_some() { side as usize } else { 1 }] += x;
        add(cascade.feedback.position(), h * cascade.position_gain);
        add(cascade.feedback.speed(), 1.0);
        seen
    }

    /// Motor and friction together.
    fn shaft(&self, h: f64) -> Line {
        let Step { motor: Line { t, b, link }, coulomb, viscous, slip, .. } = self.step;
        match slip {
            Slip::Turns(s) => Line { t: t - s * coulomb, b: b + viscous, link },
            Slip::Sticks => Line { t, b: b + STICKING * self.inertia / h, link },
        }
    }

    /// The drive as its joints see it, and the ratios along which it works.
    fn line(&self, h: f64, given: &Given<'_>) -> (Line, [f64; 3]) {
        let shaft = self.shaft(h);
        let Some((e, spring)) = &self.elastic else { return (shaft, self.gear.ratio) };
        let twist = given.joint.0[self.joints[0]] - given.rotor.0[*e];
        let (free, share) = self.rotor(h, given, *e, spring, shaft);
        let stiff = spring.tangent(twist) * h;
        let (t, b) = (stiff * free - spring.torque(twist), stiff * (1.0 - share));
        (Line { t, b, link: 0.0 }, [1.0, 0.0, 0.0])
    }

    /// Rotor behind an elastic gear: th'+ = A + B q'+.
    fn rotor(&self, h: f64, given: &Given<'_>, e: usize, spring: &Elasticity, shaft: Line) -> (f64, f64) {
        let n = self.gear.ratio[0];
        let inertia = self.drive.rotor_inertia * n * n;
        let twist = given.joint.0[self.joints[0]] - given.rotor.0[e];
        let stiff = h * h * spring.tangent(twist);
        let total = inertia + h * n * n * shaft.b + stiff;
        let driving = n * (shaft.t - self.step.along) + spring.torque(twist);
        let free = inertia * given.rotor.1[e] + h * driving;
        (free / total, (stiff - h * n * n * shaft.link) / total)
    }

    /// Speed of the shaft at the end of the step for joint accelerations `a`.
    fn finish(&mut self, h: f64, given: &Given<'_>, a: &[f64]) {
        self.step.end = match &self.elastic {
            None => {
                let change: f64 = (0..self.coupled).map(|i| self.gear.ratio[i] * a[self.joints[i]]).sum();
                self.speed + h * (change + self.gear.bias)
            }
            Some((e, spring)) => {
                let (free, share) = self.rotor(h, given, *e, spring, self.shaft(h));
                let joint = given.joint.1[self.joints[0]] + h * a[self.joints[0]];
                let end = self.gear.ratio[0] * (free + share * joint);
                self.step.link = self.gear.ratio[0] * joint;
                self.step.torque = self.drive.rotor_inertia * (end - self.speed) / h + self.step.along;
                end
            }
        };
    }

    /// Whether friction does what it was taken to do.
    fn is_settled(&self, h: f64) -> bool {
        let Step { coulomb, slip, end, .. } = self.step;
        match slip {
            Slip::Turns(s) => s * end >= 0.0,
            Slip::Sticks => STICKING * self.inertia / h * end.abs() <= coulomb,
        }
    }

    /// The other thing that friction can do.
    fn change(&mut self) {
        self.step.slip = match self.step.slip {
            Slip::Turns(_) => Slip::Sticks,
            Slip::Sticks => Slip::Turns(self.step.end.signum()),
        };
    }
}
