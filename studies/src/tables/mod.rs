//! Look-up tables of the local controllers (thesis 5.5.2): error over size, time beside direct computation, and what a walk
//! loses by them, by the counts of the encoders and by a slower bus.
//!
//! | file | what |
//! |---|---|
//! | `linkage` | one knee and one ankle: errors, bytes, times |
//! | `walking` | the scene `walk_tables` with other tables and cycles, Johnnie's voltage law with other cycles |
//! | `picture` | both as charts |

mod linkage;
mod picture;
mod walking;

use std::path::PathBuf;

use crate::sheet::{Column, fixed, plain, scientific};
use crate::{Error, Given, Sheet, Study};

use linkage::{Linkage, Size};
use walking::TableWalk;

/// A table of one size; pairs: in integers, in floating point.
const SIZES: &[Column] = &[
    plain("/points", "points"),
    plain("/bytes", "bytes"),
    scientific("/angle_rad/0", "angle [rad]: integers", 2),
    scientific("/angle_rad/1", "f64", 2),
    scientific("/rounding_rad", "rounding", 0),
    scientific("/predicted_rad", "predicted", 2),
    scientific("/ratio/0", "ratio [1]: integers", 1),
    scientific("/ratio/1", "f64", 1),
    scientific("/joint_rad", "joint [rad]", 1),
    fixed("/ns/0", "time [ns]: int.", 1),
    fixed("/ns/1", "f64", 1),
];
/// A walk: tracking errors, largest and root mean square, and largest inclination.
const WALKS: &[Column] = &[
    plain("/what", "walk, errors in mrad"),
    fixed("/cycle_s", "cycle [ms]", 1).times(1e3),
    fixed("/hip_knee_rad", "hip and knee: link", 2).times(1e3),
    fixed("/motor_side_rad", "motor", 2).times(1e3),
    fixed("/rms_rad/0", "rms: knee", 3).times(1e3),
    fixed("/rms_rad/1", "ankle", 3).times(1e3),
    fixed("/inclination_rad", "inclination", 1).times(1e3),
    plain("/fell", "fell"),
];

/// The study's arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Tables {
    /// Directory of the picture.
    #[arg(long, value_name = "DIR", default_value = "runs/study/tables")]
    pub out: PathBuf,
}

impl Study for Tables {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let tell = |what: &str| (given.progress)(0, 0, what);
        tell("tables of a knee and an ankle");
        let linkages = linkage::all(given.config)?;
        let walks = walking::all(given.config, &tell)?;
        let mut sheet = Sheet::default();
        sheet.fact("linkages", &linkages);
        for linkage in &linkages {
            sheet.line(format!("{}: without a table {:.0} ns", linkage.name, linkage.direct_ns));
            sheet.table(SIZES, &linkage.sizes);
            sheet.line("");
        }
        sheet.rows("walks", WALKS, &walks);
        sheet.draw(&self.out, "tables.png", &picture::figure(&linkages, &walks))?;
        Ok(sheet)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the study says of a size is what theory says: order two, and the rounding of 32 bits where it ends.
    #[test]
    fn order_two_until_the_bits_end() {
        let linkages = linkage::of_sizes(&config::root(None), &[17, 65, 65537], &[9, 33]).unwrap();
        for l in &linkages {
            let [a, b] = [&l.sizes[0], &l.sizes[1]];
            for k in 0..2 {
                let order = (a.angle_rad[k] / b.angle_rad[k]).ln() / 4.0_f64.ln();
                assert!((order - 2.0).abs() < 0.2, "{} {k}: {order}", l.name);
            }
            assert!(l.sizes.iter().all(|s| s.angle_rad[0] < 1.01 * s.predicted_rad), "{l:#?}");
        }
        let finest = &linkages[0].sizes[2];
        assert!(finest.angle_rad[0] > 3.0 * finest.angle_rad[1], "integers end before: {finest:#?}");
    }
}
