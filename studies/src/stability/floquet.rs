//! `gangwerk study floquet`: the Poincaré map of a simulated gait.
//!
//! The section is the cycle in which a stride of two steps begins: the plan asks the right foot to carry alone. The
//! walk is driven by time, so every motion crosses it after the same number of cycles. Type 1 only: its joints follow.
//!
//! | state | number | unit of a step |
//! |---|---|---|
//! | height of the torso, its tilt (roll, pitch) | 1 + 2 | m, rad |
//! | velocity, angular velocity of the torso | 3 + 3 | m/s, rad/s |
//! | displacement of every contact node, in the torso's heading | 3 each | m |
//! | joint targets, which the inverse kinematics integrates | one per joint | rad |
//! | modification Delta x_lambda (5.33) | 6 | m, rad |
//! | filtered forces of the feet | 6 | N, N m |
//!
//! Left out is where the robot is on the ground and where it heads: nothing feeds that back, the map does not change with it,
//! and its three multipliers are 1. Plans depend on plans alone, and joints on their targets of the cycle before.

use config::Setup;
use messages::command::PushCommand;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::Serialize;

use super::poincare::{self, Multipliers, Verdict};
use crate::sheet::{Column, fixed, plain, scientific};
use crate::undisturbed::{stride, walk_on};
use crate::{Error, Given, Sheet, Study};
use chain::Chain;

/// Scenes shown unless another one is asked for.
const SCENES: [&str; 2] = ["walk_1kmh", "walk_2kmh"];
/// \[s\] When the section is first looked at: the walk repeats itself by then.
const SETTLED: f64 = 20.0;
/// The larger disturbances over the smaller ones.
const FACTOR: f64 = 2.0;
/// \[N s\] Push of the check.
const PUSH: f64 = 2.0;
/// Strides of the check.
const STRIDES: usize = 8;

/// Groups of states: name, step.
const GROUPS: [(&str, f64); 8] = [
    ("height", 2e-5),
    ("tilt", 1e-4),
    ("velocity", 2e-4),
    ("turn rate", 2e-4),
    ("contact nodes", 1e-6),
    ("joint targets", 1e-5),
    ("modification", 2e-5),
    ("filtered forces", 0.2),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Floquet {
    /// Only this scene; default: walking at 1 and 2 km/h.
    #[arg(long)]
    pub scene: Option<String>,
    /// Size of the smaller disturbances: root mean square of each state, in steps of the table in docs/stability.md.
    #[arg(long, default_value_t = 10.0)]
    pub size: f64,
    /// Disturbances of each size.
    #[arg(long, default_value_t = 300, value_parser = clap::value_parser!(u64).range(40..=100_000))]
    pub disturbances: u64,
}

/// The gait of a scene, by size of the disturbances.
const GAIT: &[Column] = &[
    plain("/scene", "scene"),
    fixed("/period_s", "stride [s]", 3),
    plain("/states", "states"),
    fixed("/found/size", "disturbed by [steps]", 0),
    fixed("/found/left/0", "left after one stride", 3),
    fixed("/found/left/1", "after two", 4),
    fixed("/found/explained", "linear [%]", 0).times(100.0),
    fixed("/found/largest", "|lambda|_max", 3),
    fixed("/found/interval", "interval of 95 %", 3),
    plain("/verdict", "verdict"),
];
/// Numbers by rank or by stride.
const LISTS: &[Column] = &[plain("/0", ""), scientific("/1", "", 2)];

/// The gait of one scene under disturbances of one size.
#[derive(Clone, Debug, Serialize)]
struct FloquetRow {
    /// Name of the scene.
    scene: String,
    /// \[s\] A stride.
    period_s: f64,
    /// \[1\] States of the map.
    states: usize,
    found: Multipliers,
    /// What both sizes say together.
    verdict: &'static str,
}

impl Study for Floquet {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let scenes: Vec<&str> = self.scene.as_deref().map_or(SCENES.to_vec(), |scene| vec![scene]);
        let (mut rows, mut pushes) = (Vec::new(), Vec::new());
        for scene in scenes {
            (given.progress)(0, 0, scene);
            let (found, pushed) = of_scene(Setup::load(given.config, scene)?, self)?;
            rows.extend(found);
            pushes.push((scene, pushed));
        }
        // A table of all scenes; below it, scene by scene, every multiplier and a push for comparison.
        let mut sheet = Sheet::titled(format!(
            "Floquet multipliers of the gait: what a stride leaves of a small deviation, by regression over {} random \
             disturbances of all states",
            self.disturbances
        ));
        sheet.rows("rows", GAIT, &rows);
        for (scene, pushed) in &pushes {
            sheet.line(format!("\n{scene}"));
            let of_scene = rows.iter().filter(|row| row.scene == *scene);
            let values = of_scene.map(|row| {
                let size: Vec<f64> = row.found.values.iter().map(|[a, b]| a.hypot(*b)).collect();
                (format!("|lambda_i|, disturbed by {} steps", row.found.size), size)
            });
            let push = (format!("a push of {PUSH} N s leaves, stride by stride [steps]"), pushed.clone());
            sheet.table(LISTS, &values.chain([push]).collect::<Vec<_>>());
        }
        sheet.fact("pushed", &pushes);
        Ok(sheet)
    }
}

/// Rows of a scene, and what a push leaves stride by stride.
fn of_scene(mut setup: Setup, study: &Floquet) -> Result<(Vec<FloquetRow>, Vec<f64>), Error> {
    walk_on(&mut setup, SETTLED);
    let [begin, end] = stride(&setup, SETTLED)?.ticks;
    let mut chain = Chain::new(&setup)?;
    if chain.robot().layout().joints > 0 {
        return Err(format!("scene {}: only type 1 has a Poincaré map here", setup.scene.name).into());
    }
    (0..begin).for_each(|_| _ = chain.step());
    // The map: a copy of the walk, disturbed where a stride begins, one and two strides later.
    let period = end - begin;
    let section = PoincareSection::of(&mut chain);
    let start = &chain;
    let map = |x: &[f64]| {
        let mut chain = start.clone();
        section.disturb(&mut chain, x);
        let mut later = || after(&mut chain, period).then(|| section.observe(&mut chain));
        Some([later()?, later()?])
    };
    let of_size = |size: f64| poincare::multipliers(&section.steps, size, study.disturbances as usize, &map);
    let found = [of_size(study.size)?, of_size(FACTOR * study.size)?];
    let verdict = Verdict::of(&found).words();
    let pushed = section.apart(PoincareSection::pushed(start), start, period);
    let rows = found.map(|found| FloquetRow {
        scene: setup.scene.name.clone(),
        period_s: period as f64 * setup.scene.cycle,
        states: section.steps.len(),
        found,
        verdict,
    });
    Ok((rows.into(), pushed.ok_or("the robot falls after the small push of the check")?))
}

/// Lets time pass; false if the robot fell.
fn after(chain: &mut Chain, cycles: u64) -> bool {
    (0..cycles).all(|_| chain.step().sim_state.fallen == 0)
}

/// What is disturbed and looked at.
struct PoincareSection {
    /// Step of every state.
    steps: Vec<f64>,
}

impl PoincareSection {
    fn of(chain: &mut Chain) -> Self {
        let (sim, controller) = chain.parts();
        let memory = controller.memory().map(|m| m.len());
        let counts = [1, 2, 3, 3, sim.layout().layer().len(), memory[0], memory[1], memory[2]];
        Self { steps: GROUPS.iter().zip(counts).flat_map(|((_, h), n)| vec![*h; n]).collect() }
    }

    /// All states.
    fn observe(&self, chain: &mut Chain) -> Vec<f64> {
        let (sim, controller) = chain.parts();
        let (l, x) = (*sim.layout(), sim.integrated());
        let (heading, tilt) = parts(x);
        let mut all = vec![x[2], tilt.x, tilt.y];
        all.extend(&x[l.speed()]);
        for d in x[l.layer()].chunks_exact(3) {
            all.extend((heading.inverse() * Vector3::from_column_slice(d)).iter());
        }
        controller.memory().iter().for_each(|m| all.extend(m.iter()));
        all
    }

    /// Adds a deviation.
    fn disturb(&self, chain: &mut Chain, by: &[f64]) {
        let (sim, controller) = chain.parts();
        let l = *sim.layout();
        let x = sim.integrated_mut();
        let (heading, tilt) = parts(x);
        x[2] += by[0];
        let o = heading * UnitQuaternion::from_scaled_axis(tilt + Vector3::new(by[1], by[2], 0.0));
        x[3..7].copy_from_slice(o.coords.as_slice());
        let mut by = by[3..].iter();
        x[l.speed()].iter_mut().zip(by.by_ref().take(6)).for_each(|(x, b)| *x += b);
        for d in x[l.layer()].chunks_exact_mut(3) {
            let turned = heading * Vector3::from_iterator(by.by_ref().take(3).copied());
            d.iter_mut().zip(turned.iter()).for_each(|(d, b)| *d += b);
        }
        for memory in controller.memory() {
            memory.iter_mut().zip(by.by_ref()).for_each(|(m, b)| *m += b);
        }
    }

    /// Deviation of a walk from the undisturbed one, stride by stride, in steps; none if one falls.
    fn apart(&self, mut other: Chain, start: &Chain, period: u64) -> Option<Vec<f64>> {
        let mut walk = start.clone();
        let mut norms = Vec::new();
        for _ in 0..STRIDES {
            if !after(&mut walk, period) || !after(&mut other, period) {
                return None;
            }
            let (a, b) = (self.observe(&mut walk), self.observe(&mut other));
            let each = a.iter().zip(&b).zip(&self.steps).map(|((a, b), h)| ((a - b) / h).powi(2));
            norms.push(each.sum::<f64>().sqrt());
        }
        Some(norms)
    }

    /// The walk after a small push to the side and forward.
    fn pushed(start: &Chain) -> Chain {
        let mut chain = start.clone();
        let force = PUSH / 0.1 / 2f64.sqrt();
        chain.push(&PushCommand { force: [force, force, 0.0], duration: 0.1 });
        chain
    }
}

/// Heading about the vertical, and the rest of the orientation as a rotation vector without a vertical part.
fn parts(x: &[f64]) -> (UnitQuaternion<f64>, Vector3<f64>) {
    let o = UnitQuaternion::from_quaternion(Quaternion::new(x[6], x[3], x[4], x[5]));
    let heading = UnitQuaternion::from_quaternion(Quaternion::new(o.w, 0.0, 0.0, o.k));
    (heading, (heading.inverse() * o).scaled_axis())
}
