//! Speed against accuracy: `gangwerk study accuracy`.
//!
//! A chart is one question: what does a method cost, and how far is it from a reference that is exact or converged? Each
//! part below adds charts; what all have in common is here. A new part is a module and a line in [`PARTS`].

mod boundary;
pub mod cost;
mod distance;
mod flight;
pub mod gallery;
mod joint;
pub mod kinematics;
pub mod landing;
pub mod methods;
pub mod models;
pub mod order;
mod pads;
pub mod peers;
mod picture;
pub mod planner;
mod reference;
mod slip;
mod solver;
mod stiction;
pub mod system;
mod touchdown;
pub mod walking;

use std::path::{Path, PathBuf};

use serde::{Deserialize, Deserializer, Serialize};
use serde_json::json;

use crate::search::slope;
use crate::sheet::{self, Column, fixed, plain};
use crate::{Error, Sheet, Study};
pub use order::{ConvergenceOrder, StabilityLimit};
pub use peers::Peers;

/// What a part makes its charts from.
pub struct AccuracyInput<'a> {
    /// Directory of the configuration.
    pub config: &'a Path,
    /// What other programs did in the same scenes.
    pub peers: &'a Peers,
    /// Socket of another simulator, which walks the scenes of the depth charts, too.
    pub plant: Option<&'a Path>,
}

/// A part's charts.
pub type Part = fn(&AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Error>;

/// All parts, with their names for `--only`.
pub const PARTS: &[(&str, Part)] = &[
    ("flight", flight::PART),
    ("touchdown", touchdown::PART),
    ("slip", slip::PART),
    ("stiction", stiction::PART),
    ("joint", joint::PART),
    ("solver", solver::PART),
    ("pads", pads::PART),
    ("distance", distance::PART),
    ("walking", walking::charts),
    ("landing", landing::charts),
    ("models", models::charts),
    ("planner", planner::charts),
    ("kinematics", kinematics::charts),
];

/// One simulation with one method, or one kind of call.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Point {
    /// Name of its chart.
    pub chart: String,
    /// What moves.
    pub scene: String,
    /// Type of model, or program.
    pub model: String,
    /// Integrator or solver.
    pub method: String,
    /// \[s\] Step, of a method that has one.
    pub step: Option<f64>,
    /// What else was varied: a tolerance, a number of knots.
    pub solver: Option<String>,
    /// \[s/s\] Processor time by simulated time.
    pub cpu_s_per_s: Option<f64>,
    /// \[us\] Processor time of one call, of what is called and not simulated.
    pub cpu_us: Option<f64>,
    /// \[1/s\] Evaluations of the right-hand side in a simulated second.
    pub calls_per_s: Option<f64>,
    /// In the unit that `measure` names; NaN if there is none.
    #[serde(deserialize_with = "nan_of_null")]
    pub error: f64,
    /// What the error is of, and its unit.
    pub measure: String,
    /// The motion was lost: by numbers out of range, or as the note says.
    pub diverged: bool,
    /// What the method said about it.
    pub note: Option<String>,
}

/// What a chart has along x.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Cost {
    /// Processor time by simulated time.
    #[default]
    PerSecond,
    /// Processor time of one call.
    PerCall,
    /// Evaluations of the right-hand side in a simulated second.
    Calls,
}

/// Points that belong on one pair of axes.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct ErrorChart {
    /// Name; charts with the same text before a dot share a picture.
    pub name: String,
    /// One line above the axes.
    pub title: String,
    /// One sentence below the title of the picture: scene, reference.
    pub about: String,
    /// What the error is of, and its unit.
    pub measure: String,
    /// What is along x.
    pub cost: Cost,
    /// Points of a method are not steps on a way: no lines between them.
    pub scattered: bool,
    /// What was found.
    #[serde(skip)]
    pub points: Vec<Point>,
    /// Orders of convergence, measured beside predicted.
    #[serde(skip)]
    pub orders: Vec<ConvergenceOrder>,
    /// Largest stable steps of the methods that have one.
    #[serde(skip)]
    pub limits: Vec<StabilityLimit>,
}

/// What `accuracy.json` holds.
#[derive(Deserialize)]
struct Recorded {
    charts: Vec<ErrorChart>,
    points: Vec<Point>,
    orders: Vec<ConvergenceOrder>,
    limits: Vec<StabilityLimit>,
}

impl Recorded {
    /// Charts with what belongs to each.
    fn charts(self) -> Vec<ErrorChart> {
        let Self { mut charts, points, orders, limits } = self;
        for chart in &mut charts {
            chart.points = points.iter().filter(|p| p.chart == chart.name).cloned().collect();
            chart.orders = orders.iter().filter(|o| o.chart == chart.name).cloned().collect();
            chart.limits = limits.iter().filter(|l| l.chart == chart.name).cloned().collect();
        }
        charts
    }
}

/// JSON has no NaN.
fn nan_of_null<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

impl ErrorChart {
    /// An empty chart: "flight.energy", "Free flight of Lola", "energy drift \[J\]".
    pub fn new(name: &str, title: &str, measure: &str) -> Self {
        Self { name: name.into(), title: title.into(), measure: measure.into(), ..Self::default() }
    }

    /// The same with something else along x.
    pub fn over(mut self, cost: Cost) -> Self {
        self.cost = cost;
        self
    }

    /// The same without lines.
    pub(crate) fn scattered(self) -> Self {
        Self { scattered: true, ..self }
    }

    /// The same with a sentence about it.
    pub fn about(mut self, about: &str) -> Self {
        self.about = about.into();
        self
    }

    /// Adds a point; chart and measure are filled in.
    pub fn add(&mut self, point: Point) {
        let diverged = point.diverged || !point.error.is_finite();
        self.points.push(Point {
            chart: self.name.clone(),
            measure: self.measure.clone(),
            diverged,
            ..point
        });
    }

    /// Notes the largest stable step \[s\] of a method.
    pub(crate) fn limit(&mut self, method: &str, step: f64) {
        if self.limits.iter().all(|limit| limit.method != method) {
            self.limits.push(StabilityLimit { chart: self.name.clone(), method: method.into(), step });
        }
    }

    /// Measures the order of a method by its points with steps in `steps` \[s\], beside the predicted one.
    pub(crate) fn expect_order(
        &mut self,
        method: &str,
        predicted: f64,
        steps: std::ops::RangeInclusive<f64>,
    ) {
        let of_method = self.points.iter().filter(|p| p.method == method && !p.diverged);
        let pairs = of_method.filter_map(|p| Some([p.step.filter(|h| steps.contains(h))?, p.error]));
        let measured = slope(&pairs.collect::<Vec<_>>());
        self.orders.push(ConvergenceOrder {
            chart: self.name.clone(),
            method: method.into(),
            predicted,
            measured,
        });
    }
}

/// Points that were lost.
const LOST: &[Column] =
    &[plain("/chart", "lost"), plain("/model", "model"), plain("/method", "method"), plain("/note", "")];
const ORDERS: &[Column] = &[
    plain("/chart", "orders of convergence"),
    plain("/method", "method"),
    fixed("/measured", "measured", 2),
    fixed("/predicted", "predicted", 2),
];
const LIMITS: &[Column] = &[
    plain("/chart", "limits of stability"),
    plain("/method", "method"),
    plain("/step", "largest stable step"),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Accuracy {
    /// Only these charts: flight, touchdown, slip, stiction, joint, solver, ...
    #[arg(long, value_name = "PART")]
    pub only: Option<String>,
    /// Results of MuJoCo in the same scenes; `sh tests/peers/mujoco.sh --points FILE` writes it.
    #[arg(long, value_name = "FILE")]
    pub peers: Option<PathBuf>,
    /// Socket of an external plant, one more row beside types 1 to 5: tests/peers/mujoco/walk.py --serve SOCKET.
    #[arg(long, value_name = "SOCKET")]
    pub plant: Option<PathBuf>,
    /// Measures nothing: draws the pictures and the page of this accuracy.json again.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["only", "peers", "plant"])]
    pub from: Option<PathBuf>,
    /// Where pictures, accuracy.json and their page go.
    #[arg(long, value_name = "DIR", default_value = "runs/study/accuracy")]
    pub out: PathBuf,
}

impl Study for Accuracy {
    fn run(&self, given: &crate::Given<'_>) -> Result<Sheet, Error> {
        let peers = self.peers.as_deref().map(Peers::load).transpose()?.unwrap_or_default();
        let only = self.only.as_deref();
        let wanted: Vec<_> = PARTS.iter().filter(|(name, _)| only.is_none_or(|only| only == *name)).collect();
        if wanted.is_empty() {
            let names: Vec<_> = PARTS.iter().map(|(name, _)| *name).collect();
            return Err(format!("no part {}; there are {}", only.unwrap_or(""), names.join(", ")).into());
        }
        // A place that cannot be written is told before hours of work, not after.
        sheet::make(&self.out)?;
        let mut charts = match &self.from {
            Some(file) => recorded(file)?,
            None => Vec::new(),
        };
        let wanted = if self.from.is_some() { Vec::new() } else { wanted };
        for (done, (name, part)) in wanted.iter().enumerate() {
            (given.progress)(done, wanted.len(), name);
            charts.extend(part(&AccuracyInput {
                config: given.config,
                peers: &peers,
                plant: self.plant.as_deref(),
            })?);
        }
        let sheet = sheet(&charts, &self.out)?;
        let json = sheet.json();
        for (name, text) in
            [("accuracy.json", serde_json::to_string(&json)?), ("README.md", gallery::page(&json, |_| true))]
        {
            let path = self.out.join(name);
            std::fs::write(&path, text)
                .map_err(|e| format!("{}: {e}; choose another place with --out", path.display()))?;
        }
        Ok(sheet)
    }
}

/// Charts of an earlier run.
fn recorded(file: &Path) -> Result<Vec<ErrorChart>, Error> {
    let told = |e: &dyn std::fmt::Display| format!("{}: {e}", file.display());
    let text = std::fs::read_to_string(file).map_err(|e| told(&e))?;
    let recorded: Recorded = serde_json::from_str(&text).map_err(|e| told(&e))?;
    Ok(recorded.charts())
}

/// What was lost, the orders, and where the pictures are.
fn sheet(charts: &[ErrorChart], out: &Path) -> Result<Sheet, Error> {
    let points: Vec<&Point> = charts.iter().flat_map(|chart| &chart.points).collect();
    let orders: Vec<&ConvergenceOrder> = charts.iter().flat_map(|chart| &chart.orders).collect();
    let lost = |p: &&&Point| {
        let step = p.step.map_or(String::new(), |h| format!(" {}", order::in_ms(h)));
        let (method, note) = (format!("{}{step}", p.method), p.note.as_deref().unwrap_or("diverged"));
        json!({ "chart": p.chart, "model": p.model, "method": method, "note": note })
    };
    let mut sheet = Sheet::titled(format!("{} points", points.len()));
    sheet.fact("points", &points);
    sheet.fact("charts", charts);
    let lost: Vec<_> = points.iter().filter(|p| p.diverged).map(|p| lost(&p)).collect();
    if !lost.is_empty() {
        sheet.table(LOST, &lost);
    }
    sheet.rows("orders", ORDERS, &orders);
    let limits: Vec<&StabilityLimit> = charts.iter().flat_map(|chart| &chart.limits).collect();
    sheet.fact("limits", &limits);
    let limit =
        |l: &&StabilityLimit| json!({ "chart": l.chart, "method": l.method, "step": order::in_ms(l.step) });
    sheet.table(LIMITS, &limits.iter().map(limit).collect::<Vec<_>>());
    picture::draw(charts, out, &mut sheet)?;
    Ok(sheet)
}
