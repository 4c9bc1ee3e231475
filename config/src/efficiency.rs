//! Efficiencies of a gear, from which friction parameters are fitted: `gears/NAME.toml`.

use std::f64::consts::TAU;
use std::path::Path;

use drives::fit::Efficiency;

use crate::error::ConfigError;
use crate::file::{self, ConfigReader};
use crate::section;

/// A table of efficiencies.
#[derive(Clone, Debug)]
pub struct Efficiencies {
    /// Name of the gear.
    pub name: String,
    /// Source of the figures.
    pub source: String,
    /// \[1\] N of the gear, positive.
    pub ratio: f64,
    /// Speed and load on the motor's side.
    pub points: Vec<Efficiency>,
}

/// Keys of a row: name, unit, largest value; all above 0.
const COLUMNS: [(&str, &str, f64); 3] =
    [("speed", "rpm of the motor", 1e5), ("load torque", "N m at the output", 1e5), ("efficiency", "", 1.0)];

impl Efficiencies {
    /// Reads a table: `name`, `source`, `ratio`, and `points` of speed \[rpm\], load torque \[N m\] at the output, efficiency.
    pub fn load(path: &Path) -> Result<Self, ConfigError> {
        let text = file::text(path, &mut ConfigReader::default())?;
        section::read(path, &text, |top| {
            let ratio = top.number("ratio", "", 1.0..=1000.0);
            let rows = top.rows::<3>("points", "speed [rpm], load torque [N m] at the output, efficiency");
            for (i, row) in rows.iter().enumerate() {
                for ((name, unit, most), value) in COLUMNS.iter().zip(row) {
                    if *value <= 0.0 || value > most {
                        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
                        let text = format!(
                            "row {i}: {name} = {value} is not allowed; it takes above 0 to {most}{unit}"
                        );
                        top.problem("points", text);
                    }
                }
            }
            let point = |[rpm, torque, efficiency]: [f64; 3]| Efficiency {
                speed: rpm * TAU / 60.0,
                load: torque / ratio,
                efficiency,
            };
            let points = rows.into_iter().map(point).collect();
            Self { name: top.text("name"), source: top.text("source"), ratio, points }
        })
    }
}
