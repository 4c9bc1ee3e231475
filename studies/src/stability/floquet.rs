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
use messages::Command;
use messages::command::PushCommand;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::Serialize;

use super::poincare::{self, Multipliers};
use crate::push::stride;
use crate::sheet::{Column, fixed, plain, scientific};
use crate::{Error, Given, Sheet, Study};
use chain::Chain;

/// Scenes shown unless another one is asked for.
const SCENES: [&str; 2] = ["walk_1kmh", "walk_2kmh"];
/// \[s\] When the section is first looked at: the walk repeats itself by then.
const SETTLED: f64 = 20.0;
/// The larger steps over the smaller ones.
const FACTOR: f64 = 2.0;
/// \[N s\] Push of the check.
const PUSH: f64 = 2.0;
/// Disturbance of all states in the other check, in steps.
const SHAKE: f64 = 20.0;
/// Strides of the checks.
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
    /// Steps of the differences over those of the table in docs/stability.md.
    #[arg(long, default_value_t = 1.0)]
    pub step: f64,
}

/// The gait of a scene.
const GAIT: &[Column] = &[
    plain("/scene", "scene"),
    fixed("/period_s", "stride [s]", 3),
    plain("/states", "states"),
    scientific("/residual/0", "tilt changes by [rad]", 1),
    scientific("/residual/1", "velocity by [m/s]", 1),
    fixed("/largest", "|lambda|_max", 4),
    fixed("/largest_with_larger_steps", "with larger steps", 4),
    fixed("/spread", "J changes by [%]", 1).times(100.0),
    fixed("/asymmetry", "one-sided by [%]", 1).times(100.0),
    plain("/smooth", "smooth"),
    fixed("/decay", "second stride leaves", 4),
];
/// What is left of one step of a group of states after a stride, at most, and with larger steps; its share of the slowest
/// mode.
const LEFT: &[Column] = &[
    plain("/0", "of one step of"),
    fixed("/1/0", "is left after a stride", 3),
    fixed("/1/1", "of a larger one", 3),
    fixed("/2", "share of the slowest mode [%]", 0).times(100.0),
];
/// Numbers by rank or by stride.
const LISTS: &[Column] = &[plain("/0", ""), scientific("/1", "", 2)];

/// The gait of one scene.
#[derive(Clone, Debug, Serialize)]
struct FloquetRow {
    /// Name of the scene.
    scene: String,
    /// \[s\] A stride.
    period_s: f64,
    /// \[1\] States of the map.
    states: usize,
    /// \[rad, m/s\] What tilt and velocity change by from one stride to the next without a disturbance.
    residual: [f64; 2],
    /// |lambda|_max with the smaller steps.
    largest: f64,
    /// The same with steps four times as large.
    largest_with_larger_steps: f64,
    /// \[1\] Change of the map's Jacobian with the step.
    spread: f64,
    /// \[1\] Difference of forward and backward differences, smaller and larger steps.
    asymmetry: [f64; 2],
    /// Whether the map is smooth enough for its multipliers to mean something.
    smooth: bool,
    /// The ten largest multipliers: real, imaginary.
    multipliers: Vec<[f64; 2]>,
    /// What is left of one step of a state after a stride, in steps, the most of each group: smaller and larger steps.
    left: Vec<(&'static str, [f64; 2])>,
    /// What the mode of the largest one consists of: group of states, share.
    made_of: Vec<(&'static str, f64)>,
    /// \[1\] Deviation after a small push, stride by stride, in steps of the states.
    pushed: Vec<f64>,
    /// \[1\] The same with all states disturbed.
    shaken: Vec<f64>,
    /// \[1\] What the second stride leaves of the latter; where it is far above its floor, |lambda|_max or less.
    decay: f64,
}

impl Study for Floquet {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let scenes: Vec<&str> = self.scene.as_deref().map_or(SCENES.to_vec(), |scene| vec![scene]);
        let mut rows = Vec::new();
        for scene in scenes {
            (given.progress)(0, 0, scene);
            rows.push(of_scene(Setup::load(given.config, scene)?, self.step)?);
        }
        let mut sheet = Sheet::titled(format!(
            "Floquet multipliers of the gait: what is left of a small deviation after one stride; larger steps are {FACTOR} \
             times as large"
        ));
        sheet.rows("rows", GAIT, &rows);
        for row in &rows {
            sheet.line(format!("\n{}", row.scene));
            // By group of states: what a step of it leaves, and its share of the mode that leaves most.
            let share = |name| row.made_of.iter().find(|made| made.0 == name).map(|made| made.1);
            sheet.table(
                LEFT,
                &row.left.iter().map(|left| (left.0, left.1, share(left.0))).collect::<Vec<_>>(),
            );
            // Stride by stride, for who wants to see the decay itself.
            let size: Vec<f64> = row.multipliers.iter().map(|[a, b]| a.hypot(*b)).collect();
            let push = format!("a push of {PUSH} N s leaves, stride by stride");
            sheet.table(
                LISTS,
                &[("|lambda_i|", &size), (push.as_str(), &row.pushed), ("all states disturbed", &row.shaken)],
            );
            if !row.smooth {
                sheet.line("NOT SMOOTH, the multipliers are no proof");
            }
        }
        Ok(sheet)
    }
}

fn of_scene(mut setup: Setup, step: f64) -> Result<FloquetRow, Error> {
    walk_on(&mut setup);
    let (begin, end) = stride(&setup, SETTLED)?;
    let mut chain = Chain::new(&setup)?;
    if chain.robot().layout().joints > 0 {
        return Err(format!("scene {}: only type 1 has a Poincaré map here", setup.scene.name).into());
    }
    (0..begin).for_each(|_| _ = chain.step());
    let period = end - begin;
    let section = PoincareSection::of(&mut chain, step);
    let start = &chain;
    let map = |x: &[f64]| {
        let mut chain = start.clone();
        section.disturb(&mut chain, x);
        after(&mut chain, period).then(|| section.observe(&mut chain))
    };
    let found = poincare::multipliers(&section.steps, FACTOR, &map)?;
    let nominal =
        (section.observe(&mut start.clone()), map(&vec![0.0; section.steps.len()]).unwrap_or_default());
    let change = |group: usize| {
        let at = section.groups.iter().zip(nominal.0.iter().zip(&nominal.1)).filter(|(g, _)| **g == group);
        at.map(|(_, (a, b))| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    let falls = "the robot falls after the small disturbance of the check";
    let pushed = section.apart(PoincareSection::pushed(start), start, period).ok_or(falls)?;
    let shaken = section.apart(section.shaken(start), start, period).ok_or(falls)?;
    Ok(FloquetRow {
        scene: setup.scene.name.clone(),
        period_s: period as f64 * setup.scene.cycle,
        states: section.steps.len(),
        residual: [change(1), change(2)],
        largest: found.largest[0],
        largest_with_larger_steps: found.largest[1],
        spread: found.spread,
        asymmetry: found.asymmetry,
        smooth: found.smooth(),
        made_of: section.made_of(&found),
        left: section.left(&found),
        multipliers: found.values.into_iter().take(10).collect(),
        decay: shaken[1] / shaken[0],
        pushed,
        shaken,
    })
}

/// The scene without pushes and without an end of its walk.
fn walk_on(setup: &mut Setup) {
    setup.scene.pushes.clear();
    setup.scene.commands.retain(|(_, command)| *command != Command::Stop);
    setup.scene.duration = setup.scene.duration.max(SETTLED + 10.0);
}

/// Lets time pass; false if the robot fell.
fn after(chain: &mut Chain, cycles: u64) -> bool {
    (0..cycles).all(|_| chain.step().sim_state.fallen == 0)
}

/// What is disturbed and looked at.
struct PoincareSection {
    /// Group of every state.
    groups: Vec<usize>,
    /// Its step.
    steps: Vec<f64>,
}

impl PoincareSection {
    fn of(chain: &mut Chain, step: f64) -> Self {
        let (sim, controller) = chain.parts();
        let memory = controller.memory().map(|m| m.len());
        let counts = [1, 2, 3, 3, sim.layout().layer().len(), memory[0], memory[1], memory[2]];
        let groups: Vec<usize> = counts.iter().enumerate().flat_map(|(g, n)| vec![g; *n]).collect();
        let steps = groups.iter().map(|g| step * GROUPS[*g].1).collect();
        Self { groups, steps }
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

    /// The walk with every state disturbed by up to some of its steps.
    fn shaken(&self, start: &Chain) -> Chain {
        let mut chain = start.clone();
        let by: Vec<f64> =
            self.steps.iter().enumerate().map(|(i, h)| SHAKE * h * (1.0 + 2.3 * i as f64).sin()).collect();
        self.disturb(&mut chain, &by);
        chain
    }

    /// The longest column of the Jacobian in each group.
    fn left(&self, found: &Multipliers) -> Vec<(&'static str, [f64; 2])> {
        let most = |g: usize, k: usize| {
            let of_group = self.groups.iter().zip(&found.left[k]).filter(|(group, _)| **group == g);
            of_group.map(|(_, x)| *x).fold(0.0, f64::max)
        };
        GROUPS.iter().enumerate().map(|(g, (name, _))| (*name, [most(g, 0), most(g, 1)])).collect()
    }

    /// Shares of the groups in the slowest mode, largest first.
    fn made_of(&self, found: &Multipliers) -> Vec<(&'static str, f64)> {
        let sum =
            |g: usize| self.groups.iter().zip(&found.shares).filter(|(k, _)| **k == g).map(|(_, s)| s).sum();
        let mut all: Vec<(&'static str, f64)> =
            GROUPS.iter().enumerate().map(|(g, (name, _))| (*name, sum(g))).collect();
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        all
    }
}

/// Heading about the vertical, and the rest of the orientation as a rotation vector without a vertical part.
fn parts(x: &[f64]) -> (UnitQuaternion<f64>, Vector3<f64>) {
    let o = UnitQuaternion::from_quaternion(Quaternion::new(x[6], x[3], x[4], x[5]));
    let heading = UnitQuaternion::from_quaternion(Quaternion::new(o.w, 0.0, 0.0, o.k));
    (heading, (heading.inverse() * o).scaled_axis())
}
