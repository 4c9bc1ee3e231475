//! `gangwerk fit-friction`: parameters of both friction models from a table of efficiencies (2.62), their errors, and a
//! picture like the thesis's figures 2.18 and 2.19.

use std::collections::BTreeMap;
use std::error::Error;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use config::efficiency::Efficiencies;
use drawing::color::{BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION};
use drawing::{Chart, Color, Figure, Point};
use drives::HarmonicFriction;
use drives::fit::{self, CubicFriction, Efficiency, Fit, FitError};
use serde::Serialize;

/// Both models fitted to one table.
#[derive(Clone, Debug)]
pub struct FrictionReport {
    data: Efficiencies,
    cubic: Fit<CubicFriction>,
    coupled: Fit<HarmonicFriction>,
}

/// One model as `--json` prints it; parameters in SI units on the motor's side.
#[derive(Serialize)]
struct FittedModel {
    parameters: BTreeMap<&'static str, f64>,
    largest_error: f64,
    rms_error: f64,
}

const COLORS: [Color; 6] = [BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY];

/// Reads a table and fits both models to it.
pub fn run(file: &Path) -> Result<FrictionReport, String> {
    let data = Efficiencies::load(file).map_err(|e| e.to_string())?;
    let place = |e: FitError| format!("{}: points: {e}", file.display());
    let cubic = fit::cubic(&data.points).map_err(place)?;
    let coupled = fit::coupled(&data.points).map_err(place)?;
    Ok(FrictionReport { data, cubic, coupled })
}

impl FrictionReport {
    fn rows(&self) -> [(&'static str, FittedModel); 2] {
        let (old, new) = (&self.cubic, &self.coupled);
        let (a, b) = (&old.friction, &new.friction);
        let row = |parameters: [(&'static str, f64); 4], largest_error, rms_error| FittedModel {
            parameters: parameters.into(),
            largest_error,
            rms_error,
        };
        [
            (
                "(2.60)",
                row(
                    [("T_0", a.starting), ("mu", a.load), ("b", a.viscous), ("g", a.cubic)],
                    old.largest,
                    old.rms,
                ),
            ),
            (
                "(2.61)",
                row(
                    [("T_0", b.starting), ("mu", b.load), ("b", b.viscous), ("gamma", b.coupled)],
                    new.largest,
                    new.rms,
                ),
            ),
        ]
    }

    /// Parameters and errors for people.
    pub fn table(&self) -> String {
        let mut text = format!(
            "{}: {} efficiencies; {}\nT_0 [N m], mu [1], b [N m s/rad], gamma [s/rad], g [N m s^3/rad^3], all on the motor's side\n",
            self.data.name,
            self.data.points.len(),
            self.data.source
        );
        for (model, row) in self.rows() {
            let parameters: Vec<String> =
                row.parameters.iter().map(|(name, x)| format!("{name} = {x:.3e}")).collect();
            text += &format!(
                "{model}  {}   largest error {:.2e}, rms {:.2e}\n",
                parameters.join(", "),
                row.largest_error,
                row.rms_error
            );
        }
        // A model without an error leaves no share of it.
        if self.cubic.largest > 0.0 {
            let share = self.coupled.largest / self.cubic.largest * 100.0;
            text += &format!("(2.61) leaves {share:.1} % of the largest error of (2.60)\n");
        }
        text.truncate(text.trim_end().len());
        text
    }

    /// The same as one JSON object.
    pub fn json(&self) -> String {
        let [(_, old), (_, new)] = self.rows();
        serde_json::json!({ "gear": self.data.name, "source": self.data.source, "cubic": old, "coupled": new })
            .to_string()
    }

    /// Draws both models over the data.
    pub fn draw(&self, out: &Path) -> Result<(), String> {
        let about = format!("{}: {}", self.data.name, self.data.source);
        let (old, new) = (self.cubic.friction, self.coupled.friction);
        let title = |text: &str, largest: f64| format!("{text}: largest error {largest:.2e}");
        let old_title = title("Model (2.60), without a term in load and speed", self.cubic.largest);
        let new_title = title("Model (2.61)", self.coupled.largest);
        Figure::new("Efficiency of a harmonic drive", &about)
            .with(self.chart(&old_title, |w, t| old.efficiency(w, t)))
            .with(self.chart(&new_title, |w, t| new.efficiency(w, t)))
            .save(out)
    }

    /// Efficiency over load, one colour per speed: dots are data, lines the model.
    fn chart(&self, title: &str, model: impl Fn(f64, f64) -> f64) -> Chart {
        let points = &self.data.points;
        let mut speeds: Vec<f64> = points.iter().map(|p| p.speed).collect();
        speeds.sort_by(f64::total_cmp);
        speeds.dedup();
        let most = points.iter().map(|p| p.load).fold(0.0, f64::max);
        let least = points.iter().map(|p| p.load).fold(most, f64::min);
        let output = |load: f64| load * self.data.ratio;
        let mut chart = Chart::new(title, "load torque at the output [N m]", "efficiency").height(420.0);
        for (speed, color) in speeds.into_iter().zip(COLORS.into_iter().cycle()) {
            let name = format!("{:.0} rpm", speed * 60.0 / TAU);
            let loads = (0..=100).map(|i| least + (most - least) * f64::from(i) / 100.0);
            let line: Vec<Point> = loads.map(|load| [output(load), model(speed, load)]).collect();
            let dots = points.iter().filter(|p| p.speed == speed);
            let dots: Vec<Point> = dots.map(|p: &Efficiency| [output(p.load), p.efficiency]).collect();
            chart.line(&name, line, color).dots("", dots, 5.0, color);
        }
        chart
    }
}

/// `gangwerk fit-friction`: table or JSON, and the picture.
///
/// # Errors
/// See [`run`]; or the picture cannot be written.
pub fn main(file: &Path, out: Option<PathBuf>, json: bool) -> Result<(), Box<dyn Error>> {
    let report = run(file)?;
    println!("{}", if json { report.json() } else { report.table() });
    let beside = || file.file_stem().map(|stem| PathBuf::from(format!("{}.png", stem.to_string_lossy())));
    if let Some(out) = out.or_else(|| if json { None } else { beside() }) {
        report.draw(&out)?;
        if !json {
            println!("{}", out.display());
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shipped table is table C.1, rounded: its row for HFUC-25-100 comes back, the older model misses by 4.3 %.
    #[test]
    fn shipped_table() {
        let report = run(&config::root(None).join("gears/hfuc_25_100.toml")).unwrap();
        let gear = report.coupled.friction;
        assert!((gear.starting / 0.104 - 1.0).abs() < 1e-3 && gear.load < 1e-3);
        assert!((gear.viscous / 8.94e-5 - 1.0).abs() < 1e-2 && (gear.coupled / 6.58e-4 - 1.0).abs() < 1e-2);
        let table = report.table();
        for part in ["(2.60)", "largest error 4.30e-2", "(2.61)", "largest error 4.84e-4", "not measured"] {
            assert!(table.contains(part), "{part}\nis not in\n{table}");
        }
        assert!(report.json().contains("\"gamma\":0.00065"));
    }

    /// Regression: efficiencies of 1 leave no error to share, and the last line said "NaN %".
    #[test]
    fn no_error_leaves_no_share_of_it() {
        let mut report = run(&config::root(None).join("gears/hfuc_25_100.toml")).unwrap();
        assert!(report.table().ends_with("% of the largest error of (2.60)"));
        (report.cubic.largest, report.coupled.largest) = (0.0, 0.0);
        let table = report.table();
        assert!(!table.contains("leaves") && !table.contains("NaN") && !table.ends_with('\n'), "{table}");
    }
}
