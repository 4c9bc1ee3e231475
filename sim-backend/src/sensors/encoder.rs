//! Joint encoders (thesis 2.5.1, figure 2.21): counts, static bias, speed by finite differences.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | q | angle of the joint; motor sides are divided by the gear ratio | rad |
//! | delta | 2 pi over the counts per turn | rad |
//! | b | bias: error of calibration | rad |
//! | T | cycle | s |
//!
//! Reading: delta floor(q/delta) + b, always below the true angle, on average by half a count. An encoder of Q bits has
//! 2^Q counts, not 2^Q - 1 as printed (errata 1, V15). The speed of a difference is at most delta/T wrong, root mean
//! square delta/(T sqrt 6) over all speeds, and lags by T/2.

use std::f64::consts::TAU;

use config::Robot;
use messages::{Joints, MAX_JOINTS};

use super::delay_line::DelayLine;

/// Encoder of one joint.
#[derive(Clone, Copy, Debug)]
struct Encoder {
    /// \[rad\] delta; 0: not quantised.
    step: f64,
    /// \[rad\] b
    bias: f64,
    /// \[rad\] Reading of the last cycle.
    last: Option<f64>,
}

impl Encoder {
    fn read(&self, angle: f64) -> f64 {
        let counted = if self.step > 0.0 { (angle / self.step).floor() * self.step } else { angle };
        if self.bias == 0.0 { counted } else { counted + self.bias }
    }
}

/// The encoders of one side of all joints.
#[derive(Clone, Debug)]
pub(crate) struct Encoders {
    encoders: Vec<Encoder>,
    /// \[s\] Cycle T of the differences; none: the speed is measured by itself.
    difference: Option<f64>,
    line: DelayLine<[Joints; 2]>,
}

impl Encoders {
    /// Encoders for the joints of `robot`, read once per `cycle` \[s\] of steps of `step` \[s\].
    pub(crate) fn new(errors: &config::sensors::EncoderErrors, robot: &Robot, cycle: f64, step: f64) -> Self {
        let encoder = |joint: &config::robot::Joint| Encoder {
            step: errors.counts.of(&joint.name).map_or(0.0, |counts| TAU / counts),
            bias: errors.bias.of(&joint.name).unwrap_or(0.0),
            last: None,
        };
        Self {
            encoders: robot.joints.iter().take(MAX_JOINTS).map(encoder).collect(),
            difference: errors.speed_by_difference.then_some(cycle),
            line: DelayLine::new(errors.delay, step),
        }
    }

    /// Angles \[rad\] and speeds \[rad/s\] at the end of one more step.
    pub(crate) fn observe(&mut self, [angle, speed]: [&Joints; 2]) {
        self.line.push([*angle, *speed]);
    }

    /// Reads all angles \[rad\] and speeds \[rad/s\]; the joints beyond the robot's stay as they are in `out`.
    ///
    /// The first difference is that of a joint at rest. An angle that is not finite is read as NaN, and so are the two
    /// speeds that would need it.
    pub(crate) fn measure(&mut self, [angles, speeds]: [&mut Joints; 2]) {
        for (j, encoder) in self.encoders.iter_mut().enumerate() {
            let angle = self.line.chord(|x| x[0][j]);
            let now = if angle.is_finite() { encoder.read(angle) } else { f64::NAN };
            angles[j] = now;
            speeds[j] = match self.difference {
                Some(cycle) => (now - encoder.last.unwrap_or(now)) / cycle,
                None => self.line.chord(|x| x[1][j]),
            };
            encoder.last = Some(now);
        }
    }
}
