//! Where methods fail: each with a number that was predicted, and what the program says when it happens.
//!
//! A method is driven to its limit through the public interface of its crate; the limit is measured (by bisection, by a
//! slope, by counting) and held against a prediction from theory: eigenvalues, closed forms, spectral radii. A row is
//! good if the prediction is met and if the program reports the failure instead of going on with a plausible number.
//!
//! | file | what fails |
//! |---|---|
//! | `steps` | explicit steps against contact layers, servos, circuits (F1-F4) |
//! | `stiction` | signs of dry friction (F5, F6) |
//! | `touchdown` | orders of convergence at a contact (F7) |
//! | `contact` | fixed points, nearly incompressible rubber, much friction, penetration (F8-F11) |
//! | `drives` | load torques, elasticity, linkages at their dead points (F12-F15, F24) |
//! | `joint` | gains of joint control (J1-J3), drawn by `joint_chart` |
//! | `planning` | initial values instead of boundary values, collocation (F16, F20) |
//! | `motion` | Euler angles, straight knees, energy over a minute (F22, F23) |
//! | `geometry` | nearest points, edges (F25) |
//! | `signals` | quantised speeds, numbers that are none (F26) |

mod contact;
mod drives;
mod geometry;
mod held;
mod joint;
mod joint_chart;
mod linear;
mod motion;
mod planning;
mod signals;
mod steps;
mod stiction;
mod touchdown;

use std::error::Error;
use std::path::Path;

use config::Setup;
use config::scene::Integrator;
use environment::Environment;
use serde::Serialize;
use sim_backend::integrate::Stepper;
use sim_backend::plant::Plant;

pub use joint_chart::draw;

/// One method at its limit.
#[derive(Clone, Debug, Serialize)]
pub struct Finding {
    /// Name in the list of failures.
    pub id: &'static str,
    /// Method, regime and what is measured.
    pub regime: String,
    /// Unit of the numbers.
    pub unit: &'static str,
    /// What theory says.
    pub predicted: f64,
    /// What was found.
    pub measured: f64,
    /// How the two are compared.
    pub rule: Rule,
    /// How the program tells it; empty where the method does not fail.
    pub reported: String,
    /// Whether it did tell.
    pub told: bool,
}

/// How a measured number is compared with the predicted one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Rule {
    /// Relative deviation at most this.
    Within(f64),
    /// Not more than predicted.
    AtMost,
    /// Not less than predicted.
    AtLeast,
}

/// All findings.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// In the order of the files.
    pub findings: Vec<Finding>,
}

type Result<T> = std::result::Result<T, Box<dyn Error>>;
/// What a check has found.
type Findings = Result<Vec<Finding>>;

/// What the checks work on: Lola standing.
struct Bench {
    setup: Setup,
}

/// The checks, in the order of the report.
const CHECKS: [fn(&Bench) -> Findings; 30] = [
    steps::free_layer,
    steps::mass_on_layer,
    steps::whole_robot,
    steps::servo,
    steps::circuit,
    stiction::adaptive,
    stiction::chatter,
    stiction::smoothed_sign,
    stiction::at_rest,
    touchdown::order,
    contact::fixed_point,
    contact::incompressible,
    contact::friction,
    contact::cone,
    contact::creep,
    contact::penetration,
    drives::load_torque,
    drives::fixed_point,
    drives::passivity,
    drives::elasticity,
    drives::ankle,
    drives::dead_point,
    joint::continuous,
    joint::sampled,
    joint::friction,
    planning::collocation,
    motion::all,
    geometry::nearest,
    geometry::edge,
    signals::all,
];

/// Drives every method to its limit, with the robot of scene `stand`.
///
/// # Errors
/// A configuration or robot is wrong.
pub fn run(config: &Path) -> Result<Report> {
    let bench = Bench { setup: Setup::load(config, "stand")? };
    let mut findings = Vec::new();
    for check in CHECKS {
        findings.extend(check(&bench)?);
    }
    Ok(Report { findings })
}

impl Bench {
    /// \[rad\] Joint angles in which the robot stands.
    fn pose(&self) -> &[f64] {
        &self.setup.robot.poses[&self.setup.scene.start_pose]
    }

    fn plant(&self, depth: u8) -> Result<Plant> {
        Plant::new(&self.setup.robot, Environment::flat(), depth, self.pose())
    }
}

impl Finding {
    fn new(id: &'static str, regime: &str, unit: &'static str, numbers: [f64; 2], rule: Rule) -> Self {
        let [predicted, measured] = numbers;
        Self {
            id,
            regime: regime.into(),
            unit,
            predicted,
            measured,
            rule,
            reported: String::new(),
            told: true,
        }
    }

    /// What the program says about it, and whether it did.
    fn says(mut self, what: &str, told: bool) -> Self {
        (self.reported, self.told) = (what.into(), told);
        self
    }

    /// Relative deviation; from a prediction of zero the number itself.
    pub fn deviation(&self) -> f64 {
        let size = if self.predicted == 0.0 { 1.0 } else { self.predicted.abs() };
        (self.measured - self.predicted) / size
    }

    /// Whether the prediction is met and the failure is reported.
    pub fn ok(&self) -> bool {
        let met = match self.rule {
            Rule::Within(most) => self.deviation().abs() <= most,
            Rule::AtMost => self.measured <= self.predicted,
            Rule::AtLeast => self.measured >= self.predicted,
        };
        met && self.told
    }
}

impl Report {
    /// Findings that are not as predicted, or not reported.
    pub fn failed(&self) -> impl Iterator<Item = &Finding> {
        self.findings.iter().filter(|f| !f.ok())
    }
}

/// Largest step between `low` (stable) and `high` (not) that is stable, by bisection to 1e-4 of itself.
fn largest_stable(low: f64, high: f64, mut stable: impl FnMut(f64) -> bool) -> f64 {
    let (mut low, mut high) = (low, high);
    while high - low > 1e-4 * high {
        let middle = 0.5 * (low + high);
        *(if stable(middle) { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// Explicit methods for `n` states; which one, says the call.
fn stepper(n: usize) -> Stepper {
    Stepper::new(Integrator::Euler, n)
}

/// Slope of log y over log x by least squares.
fn slope(points: &[[f64; 2]]) -> f64 {
    let logs: Vec<[f64; 2]> = points.iter().map(|p| p.map(f64::ln)).collect();
    let n = logs.len() as f64;
    let mean: [f64; 2] = std::array::from_fn(|k| logs.iter().map(|p| p[k]).sum::<f64>() / n);
    let sum = |k: usize| logs.iter().map(|p| (p[0] - mean[0]) * (p[k] - mean[k])).sum::<f64>();
    sum(1) / sum(0)
}

/// The report as lines for people.
pub fn table(report: &Report) -> String {
    let mut text = format!(
        "{:5}{:74}{:>13}{:>13} {:10}{:>10}{:>10}  {:38}ok",
        "id", "method and regime", "predicted", "measured", "unit", "deviation", "allowed", "reported as"
    );
    for f in &report.findings {
        let (deviation, allowed) = match f.rule {
            Rule::Within(most) => (format!("{:+.2} %", 100.0 * f.deviation()), percent(most)),
            Rule::AtMost => (String::new(), "at most".into()),
            Rule::AtLeast => (String::new(), "at least".into()),
        };
        text += &format!(
            "\n{:5}{:74}{:>13}{:>13} {:10}{deviation:>10}{allowed:>10}  {:38}{}",
            f.id,
            f.regime,
            number(f.predicted),
            number(f.measured),
            f.unit,
            if f.told { f.reported.clone() } else { format!("NOT: {}", f.reported) },
            if f.ok() { "yes" } else { "NO" }
        );
    }
    text
}

/// A share as people write it.
fn percent(share: f64) -> String {
    if share > 0.0 && share < 1e-4 {
        format!("{:.0e} %", 100.0 * share)
    } else {
        format!("{} %", (1e4 * share).round() / 1e2)
    }
}

/// Six digits, without noise.
fn number(x: f64) -> String {
    if x == 0.0 || (1e-3..1e6).contains(&x.abs()) { format!("{x:.6}") } else { format!("{x:.4e}") }
}
