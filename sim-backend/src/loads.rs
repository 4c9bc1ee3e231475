//! Loads on the torso: pushes of the scene and by command, and the crane.

use config::Scene;
use messages::command::{LowerCommand, PushCommand};
use nalgebra::Vector3;

use crate::crane::CraneRope;
use crate::drive::JointCubic;
use crate::external_forces::ExternalForces;
use crate::layout::orientation;
use crate::plant::Plant;

/// Loads on the torso of one robot.
#[derive(Clone)]
pub(crate) struct Loads {
    /// Pushes of the scene: begin \[s\], and what is pushed.
    scripted: Vec<(f64, PushCommand)>,
    /// The newest push by command, when it ends \[s\], and how far above the torso's centre of gravity it acts \[m\].
    commanded: Option<(PushCommand, f64, f64)>,
    crane: Option<CraneRope>,
}

impl Loads {
    /// Loads of a scene, whose robot is in this state at rest.
    pub(crate) fn new(scene: &Scene, plant: &mut Plant, state: &[f64], references: &[JointCubic]) -> Self {
        Self {
            crane: scene.crane.map(|crane| hooked(&crane, plant, state, references)),
            ..Self::of_pushes(scene)
        }
    }

    /// Pushes of a scene alone.
    pub(crate) fn of_pushes(scene: &Scene) -> Self {
        Self { scripted: scene.pushes.clone(), commanded: None, crane: None }
    }

    /// Begins a push at `time` \[s\], `above` \[m\] the torso's own centre of gravity along the torso's z axis.
    pub(crate) fn push(&mut self, push: &PushCommand, time: f64, above: f64) {
        self.commanded = Some((*push, time + push.duration, above));
    }

    /// Lowers the crane from now on; whether there is one.
    pub(crate) fn lower(&mut self, way: &LowerCommand) -> bool {
        self.crane.as_mut().map(|crane| crane.lower(way.distance)).is_some()
    }

    /// Forces during the cycle of `dt` \[s\] that begins at `time` \[s\] in this state.
    pub(crate) fn step(&mut self, time: f64, dt: f64, state: &[f64]) -> ExternalForces {
        let middle = time + 0.5 * dt; // mid-cycle: rounding adds no cycle and takes none
        let (push, push_moment) = (self.push_at(middle), self.moment_at(middle, state));
        ExternalForces { push, push_moment, rope: self.crane.as_mut().map(|crane| crane.step(state, dt)) }
    }

    /// Moment of the pushes at t \[s\] about the torso's own centre of gravity \[N m\].
    fn moment_at(&self, t: f64, state: &[f64]) -> [f64; 3] {
        let Some((push, _, above)) = self.commanded.filter(|(_, until, above)| t < *until && *above != 0.0)
        else {
            return [0.0; 3];
        };
        let arm = orientation(state) * Vector3::new(0.0, 0.0, above);
        arm.cross(&Vector3::from(push.force)).into()
    }

    /// Sum of the pushes at t \[s\] \[N\].
    pub(crate) fn push_at(&self, t: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        let scripted = self.scripted.iter().filter(|(at, p)| *at <= t && t < at + p.duration).map(|(_, p)| p);
        let commanded = self.commanded.iter().filter(|(_, until, _)| t < *until).map(|(p, ..)| p);
        for p in scripted.chain(commanded) {
            for k in 0..3 {
                sum[k] += p.force[k];
            }
        }
        sum
    }
}

/// The crane of a scene with its hook above the centre of gravity, which hangs in balance.
fn hooked(
    crane: &config::crane::Crane,
    plant: &mut Plant,
    state: &[f64],
    references: &[JointCubic],
) -> CraneRope {
    let snapshot = plant.snapshot(0.0, state, references);
    let torso = Vector3::from_column_slice(&state[..3]);
    let mut hook = snapshot.com - torso;
    hook.z = crane.hook;
    CraneRope::new(crane, hook, torso + hook, plant.model().mass())
}
