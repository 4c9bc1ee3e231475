//! How fast he walks under the stabilizer, forward and to the side.

use std::path::Path;

use chain::parallel;
use messages::Command;
use serde::Serialize;

use super::trial::{Foothold, stabilized, walk};
use crate::Error;
use crate::sheet::{Column, fixed, plain};

/// Speeds that are told \[m/s\], forward and to the left.
const TOLD: [(&str, &[f64]); 2] = [
    ("forward", &[0.0208, 0.05, 0.1, 0.15, 0.2083, 0.23, 0.25]),
    ("to the left", &[0.02, 0.06, 0.1, 0.12, 0.14, 0.18, 0.22]),
];
/// Landings before speed is measured, and after.
const SETTLES: usize = 4;

pub(super) const COLUMNS: &[Column] = &[
    plain("/direction", "direction"),
    fixed("/told", "told [cm/s]", 2).times(100.0),
    fixed("/reached", "reached [cm/s]", 2).times(100.0),
    fixed("/tilt", "largest tilt [mrad]", 0).times(1e3),
    plain("/ended", "ended"),
];

/// A walk under the stabilizer.
#[derive(Clone, Debug, Serialize)]
pub struct CuredSpeed {
    /// Direction.
    pub direction: &'static str,
    /// \[m/s\] Told, reached.
    pub told: f64,
    /// \[m/s\]
    pub reached: f64,
    /// \[rad\] Largest tilt.
    pub tilt: f64,
    /// How the walk ended.
    pub ended: String,
}

/// Walks at all speeds.
///
/// # Errors
/// The scene is wrong.
pub(super) fn speeds(config: &Path) -> Result<Vec<CuredSpeed>, Error> {
    let setup = stabilized(config)?;
    let cases: Vec<(usize, f64)> =
        TOLD.iter().enumerate().flat_map(|(d, (_, all))| all.iter().map(move |v| (d, *v))).collect();
    Ok(parallel::map(cases.len(), |k| {
        let ((d, told), mut setup) = (cases[k], setup.clone());
        for (_, command) in &mut setup.scene.commands {
            if let Command::Velocity(velocity) = command {
                (velocity.forward, velocity.left) = if d == 0 { (told, 0.0) } else { (0.0, told) };
            }
        }
        let walked = walk(&setup);
        CuredSpeed {
            direction: TOLD[d].0,
            told,
            reached: reached(&walked.landings, d),
            tilt: walked.tilt,
            ended: walked.ended,
        }
    }))
}

/// \[m/s\] Mean speed along axis `d` over whole strides in the middle of the walk; NaN without two.
fn reached(landings: &[Foothold], d: usize) -> f64 {
    let last = landings.len().saturating_sub(SETTLES);
    let middle = landings.get(SETTLES..last.max(SETTLES)).unwrap_or_default();
    let foot = middle.first().map(|l| l.foot);
    let same: Vec<&Foothold> = middle.iter().filter(|l| Some(l.foot) == foot).collect();
    match (same.first(), same.last()) {
        (Some(a), Some(b)) if b.landed > a.landed => (b.place[d] - a.place[d]) / (b.landed - a.landed),
        _ => f64::NAN,
    }
}
