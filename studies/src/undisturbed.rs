//! The undisturbed walk of a scene: on which type and how fast, its stride, and whether another walk still is like it.
//!
//! One rule for all studies that disturb a walk: the robot is on its feet and supplied, it walks, and over one stride
//! it gets as far, as far sideways and as much round as it did undisturbed. To be on one's feet is not enough.

use chain::ending::is_doubt;
use chain::{Chain, Cycle};
use config::Setup;
use config::components::JointModel;
use config::method::{Integrator, Method};
use drives::Sampling;
use messages::{Command, EventCode, GaitState, LEFT, RIGHT};

use crate::Error;
use crate::way::Way;

/// Share of its way by which a stride may differ from the undisturbed one, and \[m, m, rad\] what is allowed besides:
/// 10 mm/s, for a walk on the spot too.
const BACK: (f64, [f64; 3]) = (0.05, [0.02, 0.02, 0.02]);
/// \[s\] How long the robot must go on after a disturbance, before its gait is looked at.
pub(crate) const AFTER: f64 = 6.0;
/// \[s\] Integration steps with which walks of all types are the same but for millimetres.
pub(crate) const STEP: f64 = 2.5e-4;

/// A stride of the undisturbed walk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stride {
    /// Ticks in which it begins and ends.
    pub(crate) ticks: [u64; 2],
    /// \[m, m, rad\] Its way: see [`Way`].
    way: [f64; 3],
    /// What the robot is doing over it.
    gait: GaitState,
}

/// Simulates the scene on another type, with steps of this length \[s\], or the next shorter ones that begin at every sample of
/// the drives it computes.
pub(crate) fn on_type(setup: &mut Setup, depth: u8, step: f64) {
    let integrator = if depth == 1 { Integrator::Euler } else { Integrator::SemiImplicit };
    let substeps = (setup.scene.cycle / step).round().max(1.0) as u32;
    setup.scene.choose(Method { depth, integrator, substeps });
    if setup.scene.components().joints == JointModel::Motors {
        let samples = setup.robot.drives.iter().filter_map(|drive| match drive.control.sampling {
            Sampling::Period(periods) => Some((setup.scene.cycle / periods.speed).round().max(1.0) as u32),
            _ => None,
        });
        setup.scene.substeps = samples.fold(substeps, u32::next_multiple_of);
    }
}

/// Walks forward at this speed \[km/h\] from the scene's own velocity command on.
///
/// # Errors
/// It has none.
pub(crate) fn walk_at(setup: &mut Setup, kmh: f64) -> Result<(), String> {
    let mut told = false;
    for (_, command) in &mut setup.scene.commands {
        if let Command::Velocity(velocity) = command {
            (velocity.forward, told) = (kmh / 3.6, true);
        }
    }
    let name = &setup.scene.name;
    told.then_some(()).ok_or_else(|| {
        format!("scene {name}: a speed was asked for, but it has no walk/velocity; take one that does, such as walk_1kmh")
    })
}

/// Leaves out what would disturb or end the walk of a scene; its strides after `settled` \[s\] can be watched.
pub(crate) fn walk_on(setup: &mut Setup, settled: f64) {
    setup.scene.pushes.clear();
    setup.scene.commands.retain(|(_, command)| *command != Command::Stop);
    setup.scene.duration = setup.scene.duration.max(settled + 10.0);
}

/// 2 s of standing after `settled` \[s\], to be held against like a stride.
pub(crate) fn standing(setup: &Setup, settled: f64) -> Stride {
    let ticks = [settled, settled + 2.0].map(|time| (time / setup.scene.cycle) as u64);
    Stride { ticks, way: [0.0; 3], gait: GaitState::Standing }
}

/// The first stride after `settled` \[s\].
pub(crate) fn stride(setup: &Setup, settled: f64) -> Result<Stride, Error> {
    let mut chain = Chain::new(setup)?;
    let (mut stance, mut begins, mut way) = (LEFT, Vec::new(), Way::default());
    for tick in 1..=(setup.scene.duration / setup.scene.cycle) as u64 {
        let c = chain.step();
        if c.sim_state.fallen == 1 {
            return Err(format!("scene {}: the robot falls without a push", setup.scene.name).into());
        }
        let (now, gait) = (c.controller_state.load_left, GaitState::from(c.controller_state.gait));
        // A stride begins where the right foot takes all of the load from the left one.
        let carries = if now >= 1.0 {
            LEFT
        } else if now <= 0.0 {
            RIGHT
        } else {
            stance
        };
        if carries == RIGHT && stance == LEFT && gait == GaitState::Walking && c.sim_state.time >= settled {
            begins.push(tick);
        }
        stance = carries;
        if !begins.is_empty() {
            way.add(&c.sim_state, setup.scene.cycle);
        }
        if let [begin, end] = begins[..] {
            return Ok(Stride { ticks: [begin, end], way: way.gone, gait: GaitState::Walking });
        }
    }
    Err(format!("scene {}: no whole stride of walking after {settled} s", setup.scene.name).into())
}

impl Stride {
    /// Mean speed forward \[m/s\] in cycles of this length \[s\].
    pub(crate) fn speed(&self, cycle: f64) -> f64 {
        self.way[0] / ((self.ticks[1] - self.ticks[0]) as f64 * cycle)
    }

    /// Whether the robot walks, or stands if it stood, and its next stride, which `see` sees, is like this one, whatever its phase.
    pub(crate) fn is_repeated(&self, chain: &mut Chain, mut see: impl FnMut(&Cycle)) -> bool {
        let (mut way, cycle) = (Way::default(), chain.cycle());
        for _ in 0..self.ticks[1] - self.ticks[0] {
            let c = chain.step();
            see(c);
            let goes_on = GaitState::from(c.controller_state.gait) == self.gait && c.power.on == 1;
            if ended(c) || !goes_on {
                return false;
            }
            way.add(&c.sim_state, cycle);
        }
        let (share, besides) = BACK;
        (0..3).all(|i| (way.gone[i] - self.way[i]).abs() <= share * self.way[i].abs() + besides[i])
    }
}

/// Whether the robot fell in this cycle, or a process stopped it.
pub(crate) fn ended(cycle: &Cycle) -> bool {
    let ends = |code| {
        matches!(code, EventCode::Fallen | EventCode::Lifted | EventCode::SafeStop | EventCode::PowerOff)
    };
    cycle.sim_state.fallen == 1 || cycle.events.iter().any(|&(_, code, _)| ends(code))
}

/// Whether the simulation says in this cycle that it is not to be trusted.
pub(crate) fn doubted(cycle: &Cycle) -> bool {
    cycle.events.iter().any(|&(_, code, _)| is_doubt(code))
}

#[cfg(test)]
mod tests {
    use super::*;
    use config::root;

    /// Steps of 0.25 ms in a cycle of 3.52 ms miss the samples of Archie's drives, 22 in a cycle: types 2 and 3 were refused.
    #[test]
    fn steps_begin_at_the_samples_of_the_drives() {
        for (scene, depth, substeps) in
            [("archie_walk", 1, 4), ("archie_walk", 2, 22), ("archie_walk", 3, 22), ("walk_1kmh", 3, 4)]
        {
            let mut setup = Setup::load(&root(None), scene).unwrap();
            on_type(&mut setup, depth, if depth == 1 { 1e-3 } else { STEP });
            assert_eq!(setup.scene.substeps, substeps, "{scene}, type {depth}");
            assert!(Chain::new(&setup).is_ok(), "{scene}, type {depth}");
        }
    }
}
