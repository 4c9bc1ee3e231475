//! Drive with a clock of its own ([`drives::CascadePi`]): when it measures, what it sees, what it keeps. Its integral, held
//! speed and estimator are memory of the sampler, not states of the equations of motion.

use std::f64::consts::TAU;

use config::robot::{Drive, Joint};
use drives::{
    CascadeMemory, CascadeOutput, CascadePi, ControlLaw, GearSide, SamplePeriods, Sampling, ServoMotor,
    ServoReference, SpeedEstimator,
};

use crate::inputs::Substep;
use crate::local_control::{ControllerOutput, ShaftReadings};
use crate::shaft::{Shaft, TrainInputs};

/// Sampled cascade of one motor.
#[derive(Clone)]
pub(crate) struct Servo {
    law: CascadePi,
    periods: SamplePeriods,
    /// \[rad/s\] Fastest speed of each of its joints.
    fastest: [f64; 3],
    memory: CascadeMemory,
    estimator: SpeedEstimator,
}

impl Servo {
    /// Servo of a drive that moves some of `joints`, if the drive has one.
    pub(crate) fn new(drive: &Drive, joints: &[Joint]) -> Option<Self> {
        let (ControlLaw::CascadePi(law), Sampling::Period(periods)) =
            (drive.control.law, drive.control.sampling)
        else {
            return None;
        };
        let count = drive.control.resolution.encoder_counts.map_or(0.0, |counts| TAU / f64::from(counts));
        Some(Self {
            law,
            periods,
            fastest: [0, 1, 2].map(|i| drive.joints.get(i).map_or(0.0, |&j| joints[j].speed_limit)),
            memory: CascadeMemory::default(),
            estimator: SpeedEstimator::new(count, law.speed_filter),
        })
    }

    /// Integration steps of `h` \[s\] from one sample of the speed loop to the next.
    fn steps(&self, h: f64) -> u32 {
        (self.periods.speed / h).round().max(1.0) as u32
    }

    /// True if the speed loop is sampled at the beginning of the step.
    pub(crate) fn is_due(&self, Substep { index, h }: Substep) -> bool {
        index.is_multiple_of(self.steps(h))
    }

    /// One sample, at such a step.
    pub(crate) fn sample(
        &mut self,
        shaft: &Shaft,
        speed_gain: f64,
        Substep { index, h }: Substep,
        seen: &ShaftReadings,
        inputs: &TrainInputs<'_>,
    ) -> ControllerOutput {
        // The period of the law, but for steps that were forced not to fit.
        let steps = self.steps(h);
        let period = f64::from(steps) * h;
        let Self { law, periods, memory, .. } = self;
        // Position loop.
        let mut reference = ServoReference { speed: seen.wanted, acceleration: 0.0 };
        let mut fastest = 0.0;
        for i in 0..shaft.coupled {
            let ratio = shaft.gear.ratio[i];
            reference.acceleration += ratio * inputs.reference[shaft.joints[i]].acceleration;
            fastest += ratio.abs() * self.fastest[i];
        }
        if (index / steps).is_multiple_of(periods.position_every) {
            law.sample_position(memory, seen.error[GearSide::Motor as usize], reference, fastest);
        }
        // Speed loop.
        let angles =
            [0, 1, 2].map(|i| if i < shaft.coupled { shaft.at(GearSide::Motor, i, inputs).0 } else { 0.0 });
        let angle = shaft.drive.transmission.at(angles, [0.0; 3]).map_or(f64::NAN, |gear| gear.angle);
        let speed = self.estimator.sample(angle, period);
        let servo = ServoMotor {
            motor: &shaft.drive.motor,
            speed_gain,
            current_limit: shaft.drive.current_limit,
            voltage_limit: shaft.drive.voltage_limit,
        };
        let output = law.sample_speed(memory, servo, period, reference, speed);
        // Without torque nothing answers to the integral.
        if !inputs.switches.has_torque(shaft.motor) {
            memory.integral = 0.0;
        }
        match law.output {
            CascadeOutput::Current(_) => ControllerOutput::Current(output),
            CascadeOutput::Voltage => ControllerOutput::Voltage(output),
        }
    }
}
