//! All drive trains in an implicit step: which shafts stick and which turn, and the accelerations that follow. One drive:
//! [`crate::implicit`].

use multibody::{Data, Model};

use crate::shaft::TrainInputs;
use crate::train::{DriveTrain, FaultCause, Train, TrainFault};

/// Rounds after which the states of friction are taken as they are.
const ROUNDS: usize = 12;

impl Train {
    /// Solves M a = `force` - (bias, contact: all in `force`) with the drives at the end of a step `h` \[s\].
    ///
    /// In: generalized force without the drives, mass matrix in `data`. Out: acceleration in `out`. Which shafts stick is
    /// found in rounds; if these end before, the shaft that goes to and fro is a [`TrainFault`].
    pub fn solve(
        &mut self,
        h: f64,
        inputs: &TrainInputs<'_>,
        model: &Model,
        data: &mut Data,
        force: &[f64],
        out: &mut [f64],
    ) {
        // Motors and friction as lines over the speed at the end; what sticks is guessed as the last step left it.
        for DriveTrain { shaft, controller, step } in &mut self.drives {
            if let Err(why) = step.begin(h, shaft, controller, inputs) {
                let why = FaultCause::Friction(why);
                self.fault.get_or_insert(TrainFault { drive: shaft.motor, why });
            }
        }
        for round in 1..=ROUNDS {
            // Each drive gives its torque at the speed of the beginning, and a damper for what the step adds to that.
            out.copy_from_slice(force);
            for (DriveTrain { shaft, step, .. }, damper) in self.drives.iter().zip(&mut self.dampers) {
                let line = step.joint_line(h, shaft, inputs);
                // The speed at the end of the step, but for what the acceleration adds.
                let mut now = if shaft.elastic.is_some() { 0.0 } else { h * shaft.gear.bias };
                for i in 0..shaft.coupled {
                    now += line.ratio[i] * inputs.joint.1[shaft.joints[i]];
                }
                let push = line.t - line.b * now;
                for i in 0..shaft.coupled {
                    out[6 + shaft.joints[i]] += line.ratio[i] * push;
                }
                damper.set(line.ratio, h * line.b);
            }
            model.solve_damped(data, &self.dampers, out);
            // Every guess that the result contradicts is turned round, all of them at once: a round costs a
            // factorization, and shafts hardly disturb each other.
            for DriveTrain { shaft, step, .. } in &mut self.drives {
                step.finish(h, shaft, inputs, &out[6..]);
            }
            let Some(wrong) = self.drives.iter().position(|d| !d.step.is_settled(h, &d.shaft)) else {
                return;
            };
            if round == ROUNDS {
                self.fault.get_or_insert(TrainFault { drive: wrong, why: FaultCause::Unsettled });
                return;
            }
            for d in self.drives.iter_mut().filter(|d| !d.step.is_settled(h, &d.shaft)) {
                d.step.change();
            }
        }
    }

    /// Gives the model the torques between free rotors and their stators that the step before found.
    pub(crate) fn free_rotors(&mut self, data: &mut Data) {
        for d in self.drives.iter_mut().filter(|d| d.shaft.elastic.is_some()) {
            d.step.give_free_rotor(&d.shaft, data);
        }
    }

    /// Notes how the stators of the free rotors turn, after the acceleration has been taken to the bodies.
    pub(crate) fn turn_along(&mut self, model: &Model, data: &Data) {
        for d in self.drives.iter_mut().filter(|d| d.shaft.elastic.is_some()) {
            d.step.turn_along(&d.shaft, model, data);
        }
    }

    /// Moves currents and rotors to the end of the step, after [`Train::solve`].
    pub fn end(&mut self, h: f64, current: &mut [f64], rotor: (&mut [f64], &mut [f64])) {
        for (k, DriveTrain { shaft, step, .. }) in self.drives.iter_mut().enumerate() {
            match current.get_mut(k) {
                Some(current) => *current = step.current(shaft),
                None => step.note_current(step.current(shaft)),
            }
            if let Some((e, _)) = shaft.elastic {
                rotor.1[e] = step.end_speed() / shaft.gear.ratio[0];
                rotor.0[e] += h * rotor.1[e];
            }
        }
    }

    /// Joints whose only drive is held by friction at the end of the step.
    pub(crate) fn held_joints(&self) -> impl Iterator<Item = usize> + '_ {
        let held =
            |d: &&DriveTrain| d.step.sticks() && d.shaft.elastic.is_none() && d.shaft.drive.joints.len() == 1;
        self.drives.iter().filter(held).map(|d| d.shaft.joints[0])
    }
}
