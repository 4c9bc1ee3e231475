//! Speed against accuracy: `gangwerk study accuracy`.
//!
//! A chart is one question: what does a method cost, and how far is it from a reference that is exact or converged? Each
//! part below adds charts; what all have in common is here. A new part is a module and a line in [`PARTS`].

mod boundary;
pub mod cost;
mod flight;
mod joint;
pub mod kinematics;
pub mod landing;
pub mod methods;
pub mod models;
pub mod order;
pub mod peers;
mod picture;
pub mod planner;
mod slip;
mod solver;
mod stiction;
pub mod system;
mod touchdown;
pub mod walking;

use std::error::Error;
use std::path::Path;

use serde::Serialize;

pub use order::Order;
pub use peers::Peers;

/// What a part makes its charts from.
pub struct Given<'a> {
    /// Directory of the configuration.
    pub config: &'a Path,
    /// What other programs did in the same scenes.
    pub peers: &'a Peers,
}

/// A part's charts.
pub type Part = fn(&Given<'_>) -> Result<Vec<Chart>, Box<dyn Error>>;

/// All parts, with their names for `--only`.
pub const PARTS: &[(&str, Part)] = &[
    ("flight", flight::PART),
    ("touchdown", touchdown::PART),
    ("slip", slip::PART),
    ("stiction", stiction::PART),
    ("joint", joint::PART),
    ("solver", solver::PART),
    ("walking", walking::charts),
    ("landing", landing::charts),
    ("models", models::charts),
    ("planner", planner::charts),
    ("kinematics", kinematics::charts),
];

/// One simulation with one method, or one kind of call.
#[derive(Clone, Debug, Default, Serialize)]
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
    /// What else was varied, with its value: "tolerance 1e-6".
    pub solver: Option<String>,
    /// \[s/s\] Processor time by simulated time.
    pub cpu_s_per_s: Option<f64>,
    /// \[us\] Processor time of one call, of what is called and not simulated.
    pub cpu_us: Option<f64>,
    /// \[1/s\] Evaluations of the right-hand side in a simulated second.
    pub calls_per_s: Option<f64>,
    /// In the unit that `measure` names; NaN if there is none.
    pub error: f64,
    /// What the error is of, and its unit.
    pub measure: String,
    /// The motion was lost: by numbers out of range, or as the note says.
    pub diverged: bool,
    /// What the method said about it.
    pub note: Option<String>,
}

/// What a chart has along x.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
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
#[derive(Clone, Debug, Default)]
pub struct Chart {
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
    pub points: Vec<Point>,
    /// Orders of convergence, measured beside predicted.
    pub orders: Vec<Order>,
}

impl Chart {
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
    pub fn scattered(self) -> Self {
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

    /// Measures the order of a method by its points with steps in `steps` \[s\], beside the predicted one.
    pub fn expect_order(&mut self, method: &str, predicted: f64, steps: std::ops::RangeInclusive<f64>) {
        let of_method = self.points.iter().filter(|p| p.method == method && !p.diverged);
        let pairs = of_method.filter_map(|p| Some((p.step.filter(|h| steps.contains(h))?, p.error)));
        let measured = order::slope(&pairs.collect::<Vec<_>>());
        self.orders.push(Order { chart: self.name.clone(), method: method.into(), predicted, measured });
    }
}

/// Everything that was found.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// All charts' points.
    pub points: Vec<Point>,
    /// All charts' orders.
    pub orders: Vec<Order>,
    /// Pictures that were drawn.
    pub pictures: Vec<String>,
}

/// Makes the charts of all parts, or of `only` one, and writes pictures and `accuracy.json` to `out`. `progress` is told
/// parts done, all parts, and the next one's name.
///
/// # Errors
/// A configuration is wrong, there is no such part, or `out` cannot be written.
pub fn run(
    config: &Path,
    peers: &Peers,
    out: &Path,
    only: Option<&str>,
    mut progress: impl FnMut(usize, usize, &str),
) -> Result<Report, Box<dyn Error>> {
    let wanted: Vec<_> = PARTS.iter().filter(|(name, _)| only.is_none_or(|only| only == *name)).collect();
    if wanted.is_empty() {
        let names: Vec<_> = PARTS.iter().map(|(name, _)| *name).collect();
        return Err(format!("no part {}; there are {}", only.unwrap_or(""), names.join(", ")).into());
    }
    std::fs::create_dir_all(out)
        .map_err(|e| format!("{}: {e}; choose another place with --out", out.display()))?;
    let mut charts = Vec::new();
    for (done, (name, part)) in wanted.iter().enumerate() {
        progress(done, wanted.len(), name);
        charts.extend(part(&Given { config, peers })?);
    }
    let mut report = Report { pictures: picture::draw(&charts, out)?, ..Report::default() };
    for chart in charts {
        report.points.extend(chart.points);
        report.orders.extend(chart.orders);
    }
    let path = out.join("accuracy.json");
    std::fs::write(&path, serde_json::to_string_pretty(&report)?)
        .map_err(|e| format!("{}: {e}; choose another place with --out", path.display()))?;
    Ok(report)
}

/// The report as text: what was lost, the orders, and where the pictures are.
pub fn table(report: &Report) -> String {
    let mut text = format!("{} points\n", report.points.len());
    for p in report.points.iter().filter(|p| p.diverged) {
        let step = p.step.map_or(String::new(), |h| format!(" {}", order::in_ms(h)));
        let note = p.note.as_deref().unwrap_or("diverged");
        text += &format!("  {:24} {} {}{step}: {note}\n", p.chart, p.model, p.method);
    }
    text += "orders of convergence         measured  predicted\n";
    for o in &report.orders {
        text += &format!("  {:24} {:24} {:6.2} {:6.2}\n", o.chart, o.method, o.measured, o.predicted);
    }
    text + &report.pictures.join("\n")
}
