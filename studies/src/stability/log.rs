//! `gangwerk stability LOG`: how near a walk came to the limits of its contact, and what each measure says about it.

use std::path::Path;

use serde::Serialize;

use super::picture;
use super::walk::{self, Instant};
use crate::Sheet;
use crate::sheet::{Column, fixed, plain};

/// Distances to what must not be crossed.
const COLUMNS: &[Column] = &[
    plain("/name", "distance to the border of"),
    plain("/unit", "unit"),
    fixed("/least", "least", 4),
    fixed("/at_s", "at [s]", 3),
    fixed("/mean", "mean", 4),
    fixed("/defined", "defined [%]", 1).times(100.0),
    fixed("/outside", "outside [%]", 1).times(100.0),
];

/// What a log says.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ContactStability {
    /// \[1\] Cycles in which something carries the robot, all others being left out.
    pub(super) cycles: usize,
    /// Distances to what must not be crossed.
    pub(super) margins: Vec<Margin>,
    /// \[N m\] Largest absolute rate of the angular momentum about the centre of gravity, x, y, z.
    pub(super) momentum_rate_max_n_m: [f64; 3],
    /// \[m\] Largest distance of the point of zero rate from the zero-moment point.
    pub(super) zero_rate_from_zmp_max_m: f64,
    /// What gives way first where the wrench on a flat sole is nearest to the border of its cone.
    pub(super) nearest_border: &'static str,
    /// \[N\] Root mean square of what forces and accelerations in the log differ by.
    pub(super) imbalance_rms_n: f64,
}

/// One measure over the whole log.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Margin {
    /// Its name.
    pub(super) name: &'static str,
    /// Its unit.
    pub(super) unit: &'static str,
    /// The least value; none if it is never defined.
    pub(super) least: Option<f64>,
    /// \[s\] When that was.
    pub(super) at_s: Option<f64>,
    /// Mean over the cycles in which it is defined.
    pub(super) mean: Option<f64>,
    /// \[1\] Share of the cycles in which it is defined.
    pub(super) defined: f64,
    /// \[1\] Share of those in which it is negative.
    pub(super) outside: f64,
}

/// A measure of one cycle; NaN where it is not defined.
pub(super) type Measure = fn(&Instant) -> f64;

/// All margins: name, unit, value.
pub(super) const MARGINS: [(&str, &str, Measure); 6] = [
    ("zero-moment point", "m", |i| i.margin(i.zmp)),
    ("foot rotation indicator", "m", |i| i.margin(i.fri)),
    ("cone of all contact points", "1", |i| i.cone),
    ("cone of the nearest flat sole", "1", |i| i.sole_cone),
    ("point of zero rate (ZRAM)", "m", |i| i.margin(i.zram)),
    ("capture point (3.18)", "m", |i| i.margin(i.capture)),
];

/// Reads a log with an assumed coefficient of friction, and draws into `out` if it is given.
///
/// # Errors
/// The log cannot be read or tells nothing of a simulated robot; a picture cannot be written.
pub fn run(log: &Path, friction: f64, out: Option<&Path>) -> Result<Sheet, String> {
    let (robot, scene, instants) = walk::read(log, friction)?;
    let (robot, found) = (robot.name, judge(&instants));
    let mut sheet =
        Sheet::titled(format!("{robot}, {scene}: {} cycles with load, friction {friction}", found.cycles));
    sheet.facts(&found);
    sheet.fact("robot", &robot);
    sheet.fact("scene", &scene);
    sheet.fact("friction", friction);
    sheet.table(COLUMNS, &found.margins);
    // Below the table: causes, and the log held against itself.
    let [x, y, z] = found.momentum_rate_max_n_m;
    sheet.line(format!("what gives way first of the nearest flat sole: {}", found.nearest_border));
    sheet.line(format!(
        "angular momentum changes by at most {x:.1}, {y:.1}, {z:.1} N m; its point of zero rate is up to {:.4} m from the \
         zero-moment point",
        found.zero_rate_from_zmp_max_m
    ));
    let imbalance = found.imbalance_rms_n;
    sheet.line(format!("forces and accelerations of the log differ by {imbalance:.2} N (root mean square)"));
    if let Some(out) = out {
        for (name, figure) in
            picture::of_log(&instants, &format!("{robot}  ·  {scene}  ·  friction {friction}"))
        {
            sheet.draw(out, name, &figure)?;
        }
    }
    Ok(sheet)
}

/// The robot of a log; whoever wants its friction looks there.
///
/// # Errors
/// The file is no log.
pub fn robot_of(log: &Path) -> Result<String, String> {
    recording::Log::open(log).map(|log| log.robot().name.clone()).map_err(|e| e.to_string())
}

/// What can be said about these cycles.
pub(super) fn judge(instants: &[Instant]) -> ContactStability {
    let most = |value: &dyn Fn(&Instant) -> f64| {
        instants.iter().map(value).filter(|x| x.is_finite()).fold(0.0, |m: f64, x| m.max(x.abs()))
    };
    let of_sole = instants.iter().filter(|i| i.sole_cone.is_finite());
    let nearest = of_sole.min_by(|a, b| a.sole_cone.total_cmp(&b.sole_cone));
    let square: f64 = instants.iter().map(|i| i.imbalance * i.imbalance).sum();
    ContactStability {
        cycles: instants.len(),
        margins: MARGINS.iter().map(|m| margin(*m, instants)).collect(),
        momentum_rate_max_n_m: std::array::from_fn(|k| most(&|i| i.momentum_rate[k])),
        zero_rate_from_zmp_max_m: most(&|i| (i.zram[0] - i.zmp[0]).hypot(i.zram[1] - i.zmp[1])),
        nearest_border: nearest.and_then(|i| i.border).map_or("none", super::cone::Border::name),
        imbalance_rms_n: (square / instants.len().max(1) as f64).sqrt(),
    }
}

/// \[m, 1\] Distances to a border by which nothing is outside of it.
const ROUNDING: f64 = 1e-6;

fn margin((name, unit, value): (&'static str, &'static str, Measure), instants: &[Instant]) -> Margin {
    let defined: Vec<(f64, f64)> =
        instants.iter().map(|i| (i.time, value(i))).filter(|(_, x)| x.is_finite()).collect();
    let n = defined.len() as f64;
    let least = defined.iter().min_by(|a, b| a.1.total_cmp(&b.1));
    let outside = defined.iter().filter(|(_, x)| *x < -ROUNDING).count() as f64;
    Margin {
        name,
        unit,
        least: least.map(|l| l.1),
        at_s: least.map(|l| l.0),
        mean: (n > 0.0).then(|| defined.iter().map(|d| d.1).sum::<f64>() / n),
        defined: n / instants.len().max(1) as f64,
        outside: if n > 0.0 { outside / n } else { 0.0 },
    }
}
