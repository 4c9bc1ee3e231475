//! What does each component of the simulated robot cost, and what does a walk without it miss?
//!
//! Cost: one step of the model alone, in processor time, of a second of a walk. Figures: those of the whole walk. Each row is
//! type 2 with a change, or type 1 with one, beside the type itself; variants are timed in turn, so that whatever else the
//! machine does meets all of them.

use std::hint::black_box;

use chain::Chain;
use chain::figures::{Figures, Gatherer};
use config::Setup;
use config::components::{ComponentChanges, ContactModel, Selection};
use config::method::Integrator;
use realtime::clock::processor_time;
use serde_json::{Value, json};
use sim_backend::integrate::Stepper;
use sim_backend::plant::Plant;

use crate::second::Second;
use crate::sheet::{Column, fixed, plain};
use crate::{Error, Given, Sheet, Study};

/// Rounds, of which each variant's median counts.
const ROUNDS: usize = 9;
/// \[s\] Begin of the second that is timed: the robot walks periodically.
const BEGIN: f64 = 8.0;
/// Its cycles, of one step each.
const CYCLES: usize = 1000;
/// Integration steps per cycle of the whole walk.
const STEPS: u32 = 4;

const COLUMNS: &[Column] = &[
    plain("/components", "components"),
    fixed("/equations", "equations", 0),
    fixed("/step_us", "one step [us]", 2),
    fixed("/share", "of the type's [%]", 0).times(100.0),
    fixed("/force_n", "largest force of a foot [N]", 0),
    fixed("/inclination_mrad", "inclination error, rms [mrad]", 2),
    fixed("/tracking_mrad", "joint tracking error, max [mrad]", 1),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct ComponentsStudy {
    /// Scene that is walked.
    #[arg(long, default_value = "walk_1kmh")]
    pub scene: String,
}

impl Study for ComponentsStudy {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let setup = Setup::load(given.config, &self.scene)?;
        let mut variants = Vec::new();
        for (depth, changes) in changes(&setup) {
            if changes.problem(depth, &setup.robot).is_none() {
                variants.push(Variant::new(&setup, depth, changes)?);
            }
        }
        // In turn, from the other end every second time.
        for round in 0..ROUNDS {
            (given.progress)(round, ROUNDS, "timing");
            let order: Vec<usize> = (0..variants.len()).collect();
            for &i in if round % 2 == 0 { order } else { order.into_iter().rev().collect() }.iter() {
                variants[i].time();
            }
        }
        let rows: Vec<Value> = variants.iter().map(|v| v.row(&variants)).collect();
        let mut sheet = Sheet::titled(format!(
            "Components of {}, scene {}: one step of 1 ms alone; figures of the whole walk with {STEPS} steps per cycle",
            setup.robot.name, setup.scene.name
        ));
        sheet.rows("components", COLUMNS, &rows);
        Ok(sheet)
    }
}

/// Types, each beside the changes to it.
fn changes(setup: &Setup) -> Vec<(u8, ComponentChanges)> {
    let none = ComponentChanges::default;
    let [points, pads] = [ContactModel::Points, ContactModel::Pads];
    let on = |contact| ComponentChanges { contact: Some(contact), ..none() };
    // Joints that carry no weight: those of neither leg nor pelvis.
    let upper = |name: &&String| ["shoulder", "elbow", "head"].iter().any(|part| name.contains(part));
    let locked: Vec<String> = setup.robot.joints.iter().map(|j| &j.name).filter(upper).cloned().collect();
    let knees: Vec<String> =
        setup.robot.drives.iter().map(|d| &d.name).filter(|name| name.contains("hip")).cloned().collect();
    vec![
        (1, none()),
        (1, ComponentChanges { rotors: Some(false), ..none() }),
        (1, ComponentChanges { locked: locked.clone(), ..none() }),
        (1, on([pads, points])),
        (1, on([pads, pads])),
        (2, none()),
        (2, ComponentChanges { currents: Some(false), ..none() }),
        (2, ComponentChanges { friction: Some(false), ..none() }),
        (2, ComponentChanges { locked, ..none() }),
        (2, ComponentChanges { elastic: Some(Selection::Named(knees)), ..none() }),
        (2, ComponentChanges { elastic: Some(Selection::All(true)), ..none() }),
        (2, on([pads, points])),
    ]
}

/// A model and a second of a walk with it.
struct Variant {
    depth: u8,
    name: String,
    plant: Plant,
    second: Second,
    figures: Figures,
    /// \[us\] One step, of each round.
    times: Vec<f64>,
}

impl Variant {
    fn new(setup: &Setup, depth: u8, changes: ComponentChanges) -> Result<Self, Error> {
        let mut setup = setup.clone();
        setup.scene.depth = depth;
        setup.scene.components = changes;
        (setup.scene.integrator, setup.scene.substeps) = (method(depth), STEPS);
        let mut chain = Chain::new(&setup)?;
        let mut gatherer = Gatherer::default();
        let cycles = (setup.scene.duration / setup.scene.cycle).round() as usize;
        for _ in 0..cycles {
            let cycle = chain.step();
            gatherer.add(&cycle.sim_state, &cycle.controller_state);
        }
        let pose = &setup.robot.poses[&setup.scene.start_pose];
        let flat = environment::Environment::flat();
        Ok(Self {
            depth,
            name: setup.scene.model(),
            plant: Plant::new(&setup.robot, flat, setup.scene.components(), pose)?,
            second: Second::record(&setup, BEGIN, CYCLES)?,
            figures: gatherer.figures(&setup, 0.0, None),
            times: Vec::new(),
        })
    }

    /// Steps and sensors of the second, one step per cycle.
    fn time(&mut self) {
        let Self { plant, second, .. } = self;
        let mut x = second.state.clone();
        let mut stepper = Stepper::new(method(self.depth), x.len());
        let drives: Vec<Vec<_>> = (0..second.cycles()).map(|cycle| second.drives(cycle).collect()).collect();
        let begun = processor_time();
        for drives in &drives {
            second.advance(plant, &mut stepper, 1, drives, &mut x);
            black_box(plant.snapshot(second.cycle, &x, drives));
        }
        self.times.push((processor_time() - begun) as f64 * 1e-3 / drives.len() as f64);
    }

    /// \[us\]
    fn median(&self) -> f64 {
        let mut times = self.times.clone();
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    }

    fn row(&self, all: &[Self]) -> Value {
        let of_type = all.iter().find(|v| v.depth == self.depth).map_or(f64::NAN, Self::median);
        let f = &self.figures;
        let [x, y] = f.inclination_error_rms_rad.map(|e| 1e3 * e);
        json!({
            "components": self.name,
            "equations": self.plant.layout().counts().odes,
            "step_us": self.median(),
            "share": self.median() / of_type,
            "force_n": f.peak_normal_force_n,
            "inclination_mrad": x.hypot(y),
            "tracking_mrad": 1e3 * f.joint_tracking_error_max_rad,
        })
    }
}

fn method(depth: u8) -> Integrator {
    if depth > 1 { Integrator::SemiImplicit } else { Integrator::Euler }
}
