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
//! | `drives` | load torques, elasticity, linkages at their dead points (F12, F14, F15, F24) |
//! | `joint` | gains of joint control (J1-J3), drawn by `joint_chart` |
//! | `servo` | bandwidth of a sampled cascade with an integral (J4) |
//! | `planning` | horizon and order of the collocation (F16, F20) |
//! | `motion` | orientations, straight knees, energy over a minute (F22, F23) |
//! | `geometry` | nearest points, edges (F25) |
//! | `signals` | quantised speeds, numbers that are none (F26) |

mod contact;
mod drives;
mod geometry;
mod held;
mod joint;
mod joint_chart;
mod motion;
mod planning;
mod servo;
mod signals;
mod steps;
mod stiction;
mod touchdown;

use std::path::{Path, PathBuf};

use config::Setup;
use config::method::Integrator;
use environment::Environment;
use serde::Serialize;
use serde_json::json;
use sim_backend::integrate::Stepper;
use sim_backend::plant::Plant;

use crate::search::{Width, middle};
use crate::sheet::{Column, plain, six};
use crate::{Error, Given, Sheet, Study};

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
    pub rule: LimitRule,
    /// How the program tells it; empty where it says nothing.
    pub reported: String,
    /// Whether it did tell.
    pub told: bool,
}

/// How a measured number is compared with the predicted one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LimitRule {
    /// Relative deviation at most this.
    Within(f64),
    /// Not more than predicted.
    AtMost,
    /// Not less than predicted.
    AtLeast,
}

type Result<T> = std::result::Result<T, Error>;
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
    drives::passivity,
    drives::elasticity,
    drives::ankle,
    drives::dead_point,
    joint::continuous,
    joint::sampled,
    joint::friction,
    servo::cascade,
    planning::collocation,
    motion::all,
    geometry::nearest,
    geometry::edge,
    signals::all,
];

const COLUMNS: &[Column] = &[
    plain("/id", "id"),
    plain("/regime", "method and regime"),
    six("/predicted", "predicted"),
    six("/measured", "measured"),
    plain("/unit", "unit"),
    plain("/deviation", "deviation"),
    plain("/allowed", "allowed"),
    plain("/said", "reported as"),
    plain("/ok", "ok"),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct LimitsStudy {
    /// Directory of the picture of stable joint control.
    #[arg(long, value_name = "DIR", default_value = "runs/study/limits")]
    pub out: PathBuf,
}

impl Study for LimitsStudy {
    fn run(&self, given: &Given<'_>) -> Result<Sheet> {
        let mut sheet = sheet(&run(given.config)?);
        sheet.draw(&self.out, "joint_control.png", &joint_chart::figure())?;
        Ok(sheet)
    }
}

/// Drives every method to its limit, with the robot of scene `stand`.
///
/// # Errors
/// A configuration or robot is wrong, or there is no limit where it was looked for.
pub fn run(config: &Path) -> Result<Vec<Finding>> {
    let bench = Bench { setup: Setup::load(config, "stand")? };
    let found = chain::parallel::map(CHECKS.len(), |k| CHECKS[k](&bench).map_err(|e| e.to_string()));
    let found: std::result::Result<Vec<_>, _> = found.into_iter().collect();
    Ok(found?.concat())
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

/// What is the same of several findings.
#[derive(Clone, Copy, Debug)]
struct LimitRow {
    id: &'static str,
    unit: &'static str,
    rule: LimitRule,
}

const fn row(id: &'static str, unit: &'static str, rule: LimitRule) -> LimitRow {
    LimitRow { id, unit, rule }
}

impl LimitRow {
    /// Method and regime, with what was predicted and what was measured.
    fn of(self, regime: impl Into<String>, [predicted, measured]: [f64; 2]) -> Finding {
        let Self { id, unit, rule } = self;
        Finding {
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
}

impl Finding {
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
            LimitRule::Within(most) => self.deviation().abs() <= most,
            LimitRule::AtMost => self.measured <= self.predicted,
            LimitRule::AtLeast => self.measured >= self.predicted,
        };
        met && self.told
    }
}

/// Largest step between `low` (stable) and `high` (not) that is stable, by bisection to 1e-4 of itself.
fn largest_stable(low: f64, high: f64, mut stable: impl FnMut(f64) -> bool) -> Result<f64> {
    middle([low, high], Width::Share(1e-4), |x| Ok(stable(x)))
}

/// Explicit methods for `n` states; which one, says the call.
fn stepper(n: usize) -> Stepper {
    Stepper::new(Integrator::Euler, n)
}

/// The findings as docs/limits.md holds them.
pub fn sheet(findings: &[Finding]) -> Sheet {
    let row = |f: &Finding| {
        let (deviation, allowed) = match f.rule {
            LimitRule::Within(most) => (format!("{:+.2} %", 100.0 * f.deviation()), percent(most)),
            LimitRule::AtMost => (String::new(), "at most".into()),
            LimitRule::AtLeast => (String::new(), "at least".into()),
        };
        let mut row = json!(f);
        (row["deviation"], row["allowed"], row["ok"]) = (deviation.into(), allowed.into(), f.ok().into());
        row["said"] = match (f.told, f.reported.as_str()) {
            (true, "") => "nothing".into(),
            (true, said) => said.into(),
            (false, said) => format!("NOT: {said}").into(),
        };
        row
    };
    let mut sheet = Sheet::default();
    sheet.fact("findings", findings);
    sheet.table(COLUMNS, &findings.iter().map(row).collect::<Vec<_>>());
    sheet
}

/// A share as people write it.
fn percent(share: f64) -> String {
    if share > 0.0 && share < 1e-4 {
        format!("{:.0e} %", 100.0 * share)
    } else {
        format!("{} %", (1e4 * share).round() / 1e2)
    }
}
