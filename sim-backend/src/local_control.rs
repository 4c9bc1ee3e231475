//! Local controllers at work: what encoders see of a shaft, and what its law makes of it (thesis 5.5).
//!
//! ```text
//! cascade   w_d = c q'_d + K_x c (q_d - q_a),   I_d = K_v (w_d - w_b),   U = R I_d + k_M w + L w_c (I_d - I)
//! voltage   U = C c (q_d - q) + D (w_d - w) + k_M w_d,   w_d = c q'_d                                  (5.40)
//! ```
//!
//! Between two cycles of the bus the references are the cubic through the targets of both, angle and speed
//! ([`crate::drive::Drive`]). Controllers that count and look up instead of measuring and computing: `resolution.rs`.
//!
//! a, b: sides of an elastic gear that are measured; behind a rigid one both are the same. A law is computed at every
//! instant, or once per bus cycle with the references of that instant, and then held.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | c | speed of the motor by the speeds of its joints | 1 |
//! | q_d, q | references of the joints, joints or rotors in units of joints | rad |
//! | w_d, w | speed of the shaft, wanted and seen | rad/s |
//! | K_x, K_v, w_c, C, D | gains, see [`drives::JointControl`]; `K_v = w_v J/k_M` | |

use drives::{JointControl, Law, OutOfDomain, Sampled, Sampling, Side};

use crate::resolution::Angles;
use crate::train::{Given, Shaft};

/// What is seen of a shaft, in units of its motor; on the link's side and on the motor's.
struct Seen {
    /// c q'_d \[rad/s\].
    wanted: f64,
    /// c (q_d - q) \[rad\].
    error: [f64; 2],
    /// \[rad/s\]
    speed: [f64; 2],
}

/// What a controller puts out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Output {
    /// What its law says at each instant.
    Follow,
    /// A current I_d \[A\].
    Current(f64),
    /// A voltage U \[V\].
    Voltage(f64),
}

/// What a sampled controller remembers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sampler {
    output: Output,
    /// Computed, and not yet put out.
    next: Output,
    /// \[rad\] Angles of the joints at the last sample, by side.
    last: Option<[[f64; 3]; 2]>,
}

impl Sampler {
    /// Of a controller that has measured nothing: no current, terminals shorted.
    pub(crate) fn new(control: &JointControl) -> Self {
        let output = match (control.sampling, control.law) {
            (Sampling::Continuous, _) => Output::Follow,
            (Sampling::Cycle(_), Law::Cascade(_)) => Output::Current(0.0),
            (Sampling::Cycle(_), Law::Voltage(_)) => Output::Voltage(0.0),
        };
        Self { output, next: output, last: None }
    }

    /// What is put out now.
    pub(crate) fn output(&self) -> Output {
        self.output
    }
}

impl Shaft {
    /// Speed, and how far it is from the wanted one, with the gear as it is.
    ///
    /// # Errors
    /// A joint is to be, or is, where the drive has no numbers for it; it goes on with those it had.
    pub(crate) fn load(&mut self, given: &Given<'_>) -> Result<(), OutOfDomain> {
        let looked = self.look(given);
        let seen = self.seen(given);
        self.speed = seen.speed[Side::Motor as usize];
        if let Law::Cascade(cascade) = self.drive.control.law {
            let feedback = cascade.feedback;
            self.wanted = cascade.speed_wanted(seen.error[feedback.position() as usize], seen.wanted);
            self.lag = self.wanted - seen.speed[feedback.speed() as usize];
        }
        if given.powered { looked } else { Ok(()) } // without supply nobody computes
    }

    /// What a controller with coarse numbers sees.
    fn look(&mut self, given: &Given<'_>) -> Result<(), OutOfDomain> {
        let Some(mut coarse) = self.coarse.take() else { return Ok(()) };
        let angles =
            |of: &dyn Fn(usize) -> f64| [0, 1, 2].map(|i| if i < self.coupled { of(i) } else { 0.0 });
        let at = Angles {
            reference: angles(&|i| given.reference[self.joints[i]].angle),
            measured: [Side::Link, Side::Motor].map(|side| angles(&|i| self.at(side, i, given).0)),
        };
        let looked = coarse.look(&self.drive.transmission, &at);
        self.coarse = Some(coarse);
        looked
    }

    /// Measures and computes once, at the state of [`Shaft::load`]; `cycle` \[s\] since the last time.
    pub(crate) fn sample(&mut self, cycle: f64, given: &Given<'_>) {
        let Sampling::Cycle(sampled) = self.drive.control.sampling else { return };
        let seen = self.sampled(cycle, given, sampled);
        let motor = Side::Motor as usize;
        let output = match self.drive.control.law {
            Law::Cascade(cascade) => {
                let feedback = cascade.feedback;
                let wanted = cascade.speed_wanted(seen.error[feedback.position() as usize], seen.wanted);
                Output::Current(self.speed_gain * (wanted - seen.speed[feedback.speed() as usize]))
            }
            Law::Voltage(law) => {
                let motor_seen = (seen.error[motor], seen.speed[motor]);
                Output::Voltage(law.voltage(&self.drive.motor, motor_seen.0, seen.wanted, motor_seen.1))
            }
        };
        self.sampler.output = if sampled.delay { self.sampler.next } else { output };
        self.sampler.next = output;
    }

    /// What is seen at a sample.
    fn sampled(&mut self, cycle: f64, given: &Given<'_>, sampled: Sampled) -> Seen {
        let mut seen = self.seen(given);
        let angles = [Side::Link, Side::Motor].map(|side| {
            let place = |i: usize| if i < self.coupled { self.at(side, i, given).0 } else { 0.0 };
            [place(0), place(1), place(2)]
        });
        // A first difference is that of a shaft at rest.
        let last = self.sampler.last.replace(angles).unwrap_or(angles);
        if sampled.difference {
            for side in 0..2 {
                let turned = |i: usize| self.gear.ratio[i] * (angles[side][i] - last[side][i]);
                seen.speed[side] = (0..self.coupled).map(turned).sum::<f64>() / cycle;
            }
            if let Some(coarse) = &mut self.coarse {
                seen.speed[Side::Motor as usize] = coarse.speed(cycle);
            }
        }
        seen
    }

    fn seen(&self, given: &Given<'_>) -> Seen {
        let mut seen = Seen { wanted: 0.0, error: [0.0; 2], speed: [0.0; 2] };
        for i in 0..self.coupled {
            let (c, reference) = (self.gear.ratio[i], &given.reference[self.joints[i]]);
            seen.wanted += c * reference.speed;
            for side in [Side::Link, Side::Motor] {
                let (angle, speed) = self.at(side, i, given);
                seen.error[side as usize] += c * (reference.angle - angle);
                seen.speed[side as usize] += c * speed;
            }
        }
        if let Some(coarse) = &self.coarse {
            let speed = |i: usize| coarse.ratio()[i] * given.reference[self.joints[i]].speed;
            seen.wanted = (0..self.coupled).map(speed).sum();
            seen.error = coarse.error();
        }
        seen
    }

    /// Angle and speed of the i-th joint, or of the rotor that moves it, in units of the joint.
    fn at(&self, side: Side, i: usize, given: &Given<'_>) -> (f64, f64) {
        match self.elastic.as_ref().filter(|_| side == Side::Motor) {
            Some((e, _)) => (given.rotor.0[*e], given.rotor.1[*e]),
            None => (given.joint.0[self.joints[i]], given.joint.1[self.joints[i]]),
        }
    }

    /// Current the speed loop asks for \[A\].
    pub(crate) fn wanted_current(&self) -> f64 {
        let limit = self.drive.current_limit;
        let wanted = match self.sampler.output {
            Output::Current(held) => held,
            _ => self.speed_gain * self.lag,
        };
        wanted.clamp(-limit, limit)
    }

    /// Voltage that the controller sets \[V\].
    pub(crate) fn voltage(&self, current: f64) -> f64 {
        let voltage = match (self.sampler.output, self.drive.control.law) {
            (Output::Voltage(held), _) => held,
            (_, Law::Cascade(c)) => c.voltage(&self.drive.motor, self.wanted_current(), current, self.speed),
            // Never: a voltage law is sampled, its output a voltage.
            (_, Law::Voltage(_)) => 0.0,
        };
        voltage.clamp(-self.drive.voltage_limit, self.drive.voltage_limit)
    }
}
