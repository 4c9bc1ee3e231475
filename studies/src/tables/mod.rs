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

use std::error::Error;
use std::path::Path;

use serde::Serialize;

pub use linkage::{Linkage, Size};
pub use picture::draw;
pub use walking::Walk;

/// Everything that was measured.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Tables alone.
    pub linkages: Vec<Linkage>,
    /// Tables, counts and cycles in the loop.
    pub walks: Vec<Walk>,
}

/// Measures Lola's tables, and walks with them.
///
/// # Errors
/// A configuration is wrong, or a table cannot be made.
pub fn run(config: &Path, tell: impl Fn(&str)) -> Result<Report, Box<dyn Error>> {
    Ok(Report { linkages: linkage::all(config, &tell)?, walks: walking::all(config, &tell)? })
}

/// Heads of the columns.
const SIZES: &str = "                       angle of the motor [rad]                                ratio [1]       joint       time [ns]
  points      bytes    integers         f64  rounding    predicted   integers        f64       [rad]    int.     f64";
const WALKS: &str = "                                                                         hip and knee, largest      root mean square   inclination
                                                                 cycle        link       motor       knee      ankle       largest";

/// The report as lines for people.
pub fn table(report: &Report) -> String {
    let mut text = String::new();
    for linkage in &report.linkages {
        text += &format!("{}: without a table {:.0} ns\n{SIZES}\n", linkage.name, linkage.direct_ns);
        for s in &linkage.sizes {
            text += &format!(
                "{:>8}{:>11}{:>12.2e}{:>12.2e}{:>10.0e}{:>13.2e}{:>11.1e}{:>11.1e}{:>12.1e}{:>8.1}{:>8.1}\n",
                s.points,
                s.bytes,
                s.angle_rad[0],
                s.angle_rad[1],
                s.rounding_rad,
                s.predicted_rad,
                s.ratio[0],
                s.ratio[1],
                s.joint_rad,
                s.ns[0],
                s.ns[1]
            );
        }
        text.push('\n');
    }
    text += &format!("walks, tracking errors and inclination [mrad]\n{WALKS}");
    for w in &report.walks {
        let fell = if w.fell { ", FELL" } else { "" };
        let milli = |x: f64| 1e3 * x;
        text += &format!(
            "\n{:60}{:>7.1} ms{:>12.2}{:>12.2}{:>11.3}{:>11.3}{:>14.1}{fell}",
            w.what,
            milli(w.cycle_s),
            milli(w.hip_knee_rad),
            milli(w.motor_side_rad),
            milli(w.rms_rad[0]),
            milli(w.rms_rad[1]),
            milli(w.inclination_rad)
        );
    }
    text
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
