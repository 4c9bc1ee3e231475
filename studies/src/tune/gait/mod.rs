//! Tuning of a gait, `gangwerk tune gait`: numbers of its file, free within bounds, for the least cost of a simulated walk
//! (thesis 5.6).
//!
//! | file | what |
//! |---|---|
//! | `parameters` | which numbers are free, and the gait's file with others |
//! | `cost` | the walk, and its cost as named terms |
//! | `robustness` | two of the terms: unknown ground and pushes |
//! | `picture` | cost over evaluations, and its slices through the optimum |

mod cost;
mod parameters;
mod picture;
mod robustness;
#[cfg(test)]
mod tests;

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use config::Setup;
use nalgebra::DVector;
use serde::Serialize;

use crate::optimize::{Ending, Evaluation, Evaluations, Optimizer};
use crate::sheet::{Column, fixed, make, plain, six};
use crate::{Error, Given, Sheet, Study};
use cost::{GROUND, PUSHES, SETTLED, SPAN, TERMS, WalkCost, WeightedTerm};
use parameters::{FixedNumber, FreeNumber, Parameters, forward};
use robustness::Trials;

const SEARCHES: &[Column] = &[
    plain("/method", "method"),
    plain("/evaluations", "evaluations"),
    plain("/no_walk", "of which no walk"),
    plain("/ending", "ended"),
    six("/cost", "least cost"),
    plain("/near", "evaluations to within 1 %"),
];
const VALUES: &[Column] = &[
    plain("/key", "number"),
    plain("/range", "bounds"),
    six("/start", "start"),
    six("/best", "best"),
    plain("/at_bound", "at a bound"),
];
const TERM_COLUMNS: &[Column] = &[
    plain("/name", "term"),
    plain("/unit", "unit"),
    fixed("/weight", "weight", 3),
    six("/start", "start"),
    six("/best", "best"),
];

/// The arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct TuneGait {
    /// Scene whose gait it is; it walks on from its commands, without its pushes.
    #[arg(long, default_value = "johnnie_25kmh")]
    pub scene: String,
    /// Number of the gait's file that is free, as in model.com_height=0.74:0.82@0.76: bounds, and where the search starts
    /// (default: where the file has it); step.length is the step length at the scene's speed, its duration goes with it.
    #[arg(long, value_name = "KEY=LOW:HIGH[@START]", required = true)]
    pub free: Vec<FreeNumber>,
    /// Another number of the gait's file, as in limits.duration.0=0.5.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<FixedNumber>,
    /// Terms of the cost with their weights: inclination, zmp, landing, joint_speed; ground and pushes, which take many walks each.
    #[arg(long, value_name = "TERM[=WEIGHT]", value_delimiter = ',', default_value = "inclination")]
    pub cost: Vec<WeightedTerm>,
    /// Methods, each from the start with as many evaluations.
    #[arg(long, value_enum, value_delimiter = ',', default_value = "implicit-filtering")]
    pub methods: Vec<Optimizer>,
    /// Walks that a method may try; one of 20 s takes a core about a second.
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub evaluations: u32,
    /// Seed of the methods that draw numbers, and of the places and pushes.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Random places of each kind of unknown ground (boards of 2 cm, steps up and down of 4 cm, slopes of 5 deg, height fields of
    /// 3 cm) at each speed, of the term `ground`.
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub places: u64,
    /// Random pushes at each speed, of the term `pushes`.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub pushes: u64,
    /// Speeds (km/h) of the terms `ground` and `pushes`; default: the scene's.
    #[arg(long, value_delimiter = ',', value_parser = crate::ground::size)]
    pub speeds: Vec<f64>,
    /// Points of each slice of the cost through the best point; 0: none.
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub slices: u32,
    /// Directory of the tuned gait's file and the pictures.
    #[arg(long, value_name = "DIR", default_value = "runs/tune")]
    pub out: PathBuf,
}

/// Outcome of one method.
#[derive(Serialize)]
struct Search {
    method: Optimizer,
    evaluations: usize,
    /// Of which the robot fell, or did not walk as told.
    no_walk: usize,
    ending: Ending,
    cost: f64,
    /// Evaluations until the cost was within 1 % of the least of all methods.
    near: Option<usize>,
    /// Least cost after each evaluation.
    history: Vec<f64>,
    #[serde(skip)]
    best: Evaluation,
}

/// A free number at the start and at the best point.
#[derive(Serialize)]
struct Value {
    key: String,
    range: [f64; 2],
    start: f64,
    best: f64,
    at_bound: bool,
}

/// Costs along one number, the others at the best point.
#[derive(Serialize)]
struct Slice {
    key: String,
    best: f64,
    /// Value of the number, and cost; none where there was no walk.
    points: Vec<(f64, Option<f64>)>,
}

impl Study for TuneGait {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let setup = Setup::load(given.config, &self.scene)?;
        let parameters = Parameters::new(&setup, &self.set, &self.free)?;
        // The place of the results, before anything takes long.
        make(&self.out)?;
        let start = parameters.start()?;
        let done = AtomicUsize::new(0);
        let most = self.evaluations as usize;
        let trials = self.trials(&parameters.setup_at(&start)?)?;
        let walks = self.methods.len() * most + self.slices as usize * self.free.len();
        let at = |point: &DVector<f64>| -> Result<WalkCost, Error> {
            cost::walk(&parameters.setup_at(point)?, &self.cost, &trials)
        };
        let told = |what: &str, point: &DVector<f64>| {
            (given.progress)(done.fetch_add(1, Ordering::Relaxed), walks, what);
            // A gait that the file's own checks refuse is no walk, either.
            at(point).map_or(f64::INFINITY, |walk| walk.cost)
        };

        let mut searches = Vec::new();
        for (k, &method) in self.methods.iter().enumerate() {
            let name = method.name();
            let cost = |point: &DVector<f64>| told(&name, point);
            let mut evaluations = Evaluations::new(&cost, most);
            let ending = method.search(&start, self.seed, &mut evaluations);
            searches.push(Search::of(method, ending, &evaluations)?);
            done.store((k + 1) * most, Ordering::Relaxed);
        }
        let cheapest = searches.iter().min_by(|a, b| a.cost.total_cmp(&b.cost));
        let best = cheapest.ok_or("no method was named")?.best.clone();
        for search in &mut searches {
            search.near = search.history.iter().position(|&c| c <= 1.01 * best.cost).map(|k| k + 1);
        }
        let slices = self.slices(&parameters, &best, &|point| told("slices", point));
        let walks = [at(&start)?, at(&best.point)?];
        let setups = [parameters.setup_at(&start)?, parameters.setup_at(&best.point)?];
        let others = self.held_against(&trials.others(), &setups);
        self.sheet(&parameters, (&start, &best), (&walks, &trials.speeds, &others), (&searches, &slices))
    }
}

impl Search {
    fn of(method: Optimizer, ending: Ending, evaluations: &Evaluations<'_>) -> Result<Self, Error> {
        let costs = evaluations.all.iter().map(|e| e.cost);
        let best = evaluations
            .best()
            .ok_or_else(|| format!("{}: no gait within the bounds can be tried", method.name()))?;
        Ok(Self {
            method,
            evaluations: evaluations.all.len(),
            no_walk: costs.clone().filter(|&c| !(c < cost::NO_WALK)).count(),
            ending,
            cost: best.cost,
            near: None,
            history: costs
                .scan(f64::INFINITY, |least, c| {
                    *least = least.min(c);
                    Some(*least)
                })
                .collect(),
            best: best.clone(),
        })
    }
}

impl TuneGait {
    /// Places and pushes of the search.
    fn trials(&self, setup: &Setup) -> Result<Trials, Error> {
        let told = forward(setup).map(|speed| 3.6 * speed);
        let speeds = if self.speeds.is_empty() { told.into_iter().collect() } else { self.speeds.clone() };
        if told.is_none() && self.robust().next().is_some() {
            return Err(format!(
                "scene {}: without walk/velocity it has neither ground nor pushes",
                self.scene
            )
            .into());
        }
        Ok(Trials { speeds, places: self.places, pushes: self.pushes, seed: self.seed })
    }

    /// Terms of the cost that take walks of their own.
    fn robust(&self) -> impl Iterator<Item = usize> {
        [GROUND, PUSHES].into_iter().filter(|&term| self.cost.iter().any(|t| t.term == term))
    }

    /// Ground and pushes on which nothing was tuned, for rows of the table of terms; none where the robot does not walk.
    fn held_against(&self, trials: &Trials, setups: &[Setup; 2]) -> Vec<serde_json::Value> {
        let row = |term: usize| {
            let (name, unit, about) = TERMS[term];
            let [start, best] = setups.each_ref().map(|setup| trials.share(term, setup).ok());
            serde_json::json!({ "name": format!("{name}, others"), "unit": unit, "about": about, "weight": 0.0, "start": start, "best": best })
        };
        self.robust().map(row).collect()
    }

    /// The cost along each number through the best point.
    fn slices(
        &self,
        parameters: &Parameters<'_>,
        best: &Evaluation,
        cost: &(dyn Fn(&DVector<f64>) -> f64 + Sync),
    ) -> Vec<Slice> {
        let points = self.slices as usize;
        let along = |i: usize| {
            let place = |k: usize| {
                let mut point = best.point.clone();
                point[i] = (k as f64 + 0.5) / points as f64;
                point
            };
            let costs = chain::parallel::map(points, |k| cost(&place(k)));
            let values = (0..points).map(|k| parameters.values(&place(k))[i]);
            Slice {
                key: self.free[i].key.clone(),
                best: parameters.values(&best.point)[i],
                points: values.zip(costs).map(|(x, c)| (x, (c < cost::NO_WALK).then_some(c))).collect(),
            }
        };
        if points == 0 { Vec::new() } else { (0..self.free.len()).map(along).collect() }
    }

    fn sheet(
        &self,
        parameters: &Parameters<'_>,
        (start, best): (&DVector<f64>, &Evaluation),
        (walks, speeds, others): (&[WalkCost; 2], &[f64], &[serde_json::Value]),
        (searches, slices): (&[Search], &[Slice]),
    ) -> Result<Sheet, Error> {
        let mut sheet = Sheet::titled(format!(
            "Gait of scene {}: cost of {SPAN} s of walking after {SETTLED} s; seed {}",
            self.scene, self.seed
        ));
        sheet.rows("searches", SEARCHES, searches);
        sheet.line("");
        let [first, last] = [start, &best.point].map(|point| parameters.values(point));
        let value = |(i, p): (usize, &FreeNumber)| Value {
            key: p.key.clone(),
            range: p.range,
            start: first[i],
            best: last[i],
            at_bound: best.point[i] < 1e-3 || best.point[i] > 1.0 - 1e-3,
        };
        let values: Vec<Value> = self.free.iter().enumerate().map(value).collect();
        sheet.rows("values", VALUES, &values);
        sheet.line("");
        let weight = |i: usize| self.cost.iter().filter(|t| t.term == i).fold(0.0, |sum, t| sum + t.weight);
        let terms: Vec<serde_json::Value> = (0..TERMS.len())
            .map(|i| {
                let (name, unit, about) = TERMS[i];
                let [start, best] = walks.map(|walk| walk.terms[i]);
                serde_json::json!({ "name": name, "unit": unit, "about": about, "weight": weight(i), "start": start, "best": best })
            })
            .chain(others.iter().cloned())
            .collect();
        sheet.rows("terms", TERM_COLUMNS, &terms);
        // The result: a gait's file, if the robot walks with it.
        if !walks[1].walked() {
            sheet.line(
                "The robot falls, or does not walk as told, wherever it was tried: no gait is written.",
            );
            return Ok(sheet);
        }
        let path = self.out.join(format!("{}_tuned.toml", config::scenes::name(&self.scene)));
        let text = self.evidence(&values, best.cost, searches, (speeds, others))
            + &parameters.text_at(&best.point)?;
        let lost = parameters.written(&best.point);
        std::fs::write(&path, text)
            .map_err(|e| format!("{}: {e}; the best gait has {lost}", path.display()))?;
        sheet.fact("gait", path.display().to_string());
        sheet.line(path.display().to_string());
        sheet.draw(&self.out, "tune_gait.png", &picture::draw(&self.scene, searches, slices))?;
        sheet.fact("slices", slices);
        Ok(sheet)
    }

    /// Comment above the gait: cost, bounds, evaluations and seed of the search.
    fn evidence(
        &self,
        values: &[Value],
        cost: f64,
        searches: &[Search],
        (speeds, others): (&[f64], &[serde_json::Value]),
    ) -> String {
        let mut text = format!(
            "# Tuned by `gangwerk tune gait` {} in scene {}: cost {cost:.6e}",
            env!("CARGO_PKG_VERSION"),
            self.scene
        );
        // What was asked for, and then what each method needed for it.
        for t in &self.cost {
            let (name, unit, about) = TERMS[t.term];
            text += &format!("\n# cost: {} x {name} [{unit}], {about}", t.weight);
        }
        for v in values {
            let [low, high] = v.range;
            text += &format!("\n# free: {} = {} in [{low}, {high}], from {}", v.key, v.best, v.start);
        }
        for s in searches {
            text += &format!(
                "\n# {}: {} evaluations, least cost {:.6e}, seed {}",
                s.method.name(),
                s.evaluations,
                s.cost,
                self.seed
            );
        }
        if !others.is_empty() {
            text += &format!(
                "\n# {} places of each ground and {} pushes at each of {speeds:?} km/h, seed {}",
                self.places, self.pushes, self.seed
            );
        }
        for row in others {
            let [name, start, best] = ["name", "start", "best"].map(|key| &row[key]);
            text += &format!("\n# {}: {start} at the start, {best} now", name.as_str().unwrap_or_default());
        }
        text + "\n\n"
    }
}
