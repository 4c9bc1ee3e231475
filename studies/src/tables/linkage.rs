//! Tables of a knee and an ankle over the ranges of their joints, in integers and in floating point, against the linkages
//! themselves.

use std::error::Error;
use std::hint::black_box;
use std::path::Path;

use config::Robot;
use config::robot::Drive;
use drives::fixed_table::whole_angle;
use drives::lookup::LookupTable;
use drives::{FixedTable, Transmission};
use serde::Serialize;

use crate::accuracy::cost;

/// Points in each dimension of the tables.
const KNEE: [usize; 11] = [5, 9, 17, 33, 65, 129, 257, 1025, 4097, 16385, 65537];
const ANKLE: [usize; 8] = [5, 9, 17, 33, 65, 129, 257, 1025];
/// Places at which errors and times are measured.
const PLACES: usize = 20_000;
/// \[rad\] What 1 is in a joint angle.
const UNIT: f64 = 1.0 / (1u64 << 29) as f64;

/// One linkage with tables of several sizes.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Linkage {
    /// Of which joint.
    pub name: &'static str,
    /// \[ns\] One evaluation without a table, median.
    pub direct_ns: f64,
    /// By size.
    pub sizes: Vec<Size>,
}

/// A table of one size; pairs: in integers, in floating point.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Size {
    /// In each dimension.
    pub points: usize,
    /// Of the table in integers.
    pub bytes: usize,
    /// \[rad\] Largest error of the motor's angle.
    pub angle_rad: [f64; 2],
    /// \[rad\] What interpolation and rounding make at most of it, by theory.
    pub predicted_rad: f64,
    /// \[rad\] The part of rounding.
    pub rounding_rad: f64,
    /// \[1\] Largest error of a ratio.
    pub ratio: [f64; 2],
    /// \[rad\] Largest error of the motor's angle in units of the joint: over the largest ratio there.
    pub joint_rad: f64,
    /// \[ns\] One evaluation, median.
    pub ns: [f64; 2],
}

/// Everything.
pub(super) fn all(config: &Path) -> Result<Vec<Linkage>, Box<dyn Error>> {
    of_sizes(config, &KNEE, &ANKLE)
}

/// Lola's right knee and inner ankle motor.
pub(super) fn of_sizes(
    config: &Path,
    knee: &[usize],
    ankle: &[usize],
) -> Result<Vec<Linkage>, Box<dyn Error>> {
    let robot = Robot::load(&config.join("robots").join("lola"))?;
    let mut linkages = Vec::new();
    for (name, sizes) in [("knee", knee), ("ankle", ankle)] {
        let of = |d: &&Drive| match d.transmission {
            Transmission::Harmonic { .. } => false,
            Transmission::Knee(_) => name == "knee",
            Transmission::Ankle(_) => name == "ankle",
        };
        if let Some(drive) = robot.drives.iter().find(of) {
            linkages.push(LinkageBench::new(&robot, drive)?.measured(name, sizes)?);
        }
    }
    Ok(linkages)
}

/// A linkage, and where it is evaluated.
struct LinkageBench {
    transmission: Transmission,
    /// \[rad\] Of its joints.
    ranges: [[f64; 2]; 3],
    /// \[2^-29 rad\], and the same \[rad\].
    whole: Vec<[i32; 3]>,
    places: Vec<[f64; 3]>,
}

impl LinkageBench {
    fn new(robot: &Robot, drive: &Drive) -> Result<Self, Box<dyn Error>> {
        let ranges = [0, 1, 2].map(|i| drive.joints.get(i).map_or([0.0; 2], |j| robot.joints[*j].range));
        let whole = (1..=PLACES).map(|i| place(i, ranges)).collect::<Result<Vec<_>, _>>()?;
        let places = whole.iter().map(|q| q.map(|q| f64::from(q) * UNIT)).collect();
        Ok(Self { transmission: drive.transmission, ranges, whole, places })
    }

    fn measured(&self, name: &'static str, sizes: &[usize]) -> Result<Linkage, Box<dyn Error>> {
        let direct_ns = self.time(|i| {
            let _ = black_box(self.transmission.at(black_box(self.places[i]), [0.0; 3]));
        });
        let sizes = sizes.iter().map(|&points| self.size(points)).collect::<Result<_, _>>()?;
        Ok(Linkage { name, direct_ns, sizes })
    }

    fn size(&self, points: usize) -> Result<Size, Box<dyn Error>> {
        let ranges = &self.ranges;
        let grid = if self.ankle() { [ranges[1], ranges[2]] } else { [ranges[0]; 2] };
        let fixed = FixedTable::new(&self.transmission, *ranges, [points; 2])?;
        let real = LookupTable::new(&self.transmission, grid, [points; 2])?;
        let (mut angle, mut ratio, mut joint) = ([0.0_f64; 2], [0.0_f64; 2], 0.0_f64);
        for q in &self.places {
            let exact = self.transmission.at(*q, [0.0; 3])?;
            for (k, (found, ratios)) in [fixed.at_angles(*q)?, real.at(*q)?].into_iter().enumerate() {
                angle[k] = angle[k].max((found - exact.angle).abs());
                let missed = (0..3).map(|j| (ratios[j] - exact.ratio[j]).abs());
                ratio[k] = missed.fold(ratio[k], f64::max);
                let most = exact.ratio.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
                joint = if k == 0 { joint.max((found - exact.angle).abs() / most) } else { joint };
            }
        }
        let rounding_rad = fixed.rounding();
        let ns = [
            self.time(|i| {
                let _ = black_box(fixed.at(black_box(self.whole[i])));
            }),
            self.time(|i| {
                let _ = black_box(real.at(black_box(self.places[i])));
            }),
        ];
        Ok(Size {
            points,
            bytes: fixed.bytes(),
            angle_rad: angle,
            predicted_rad: self.predicted(points)? + rounding_rad,
            rounding_rad,
            ratio,
            joint_rad: joint,
            ns,
        })
    }

    fn ankle(&self) -> bool {
        self.transmission.joints() == 3
    }

    /// \[rad\] Linear interpolation errs by at most h²/8 times the second derivative, in each dimension; of the motor's angle
    /// this is its acceleration while that joint alone turns with 1 rad/s.
    fn predicted(&self, points: usize) -> Result<f64, Box<dyn Error>> {
        let dimensions: &[usize] = if self.ankle() { &[1, 2] } else { &[0] };
        let mut sum = 0.0;
        for &k in dimensions {
            let mut speed = [0.0; 3];
            speed[k] = 1.0;
            let h = (self.ranges[k][1] - self.ranges[k][0]) / (points - 1) as f64;
            let mut bend = 0.0_f64;
            for q in &self.places {
                bend = bend.max(self.transmission.at(*q, speed)?.bias.abs());
            }
            sum += h * h / 8.0 * bend;
        }
        Ok(sum)
    }

    /// \[ns\] One call, median of some runs over all places.
    fn time(&self, mut call: impl FnMut(usize)) -> f64 {
        let ((), seconds) = cost::of(|| (0..PLACES).for_each(&mut call));
        1e9 * seconds / PLACES as f64
    }
}

/// The i-th of places that cover the ranges evenly: steps of the first powers of the root of x^4 = x + 1, which no grid
/// shares.
fn place(i: usize, ranges: [[f64; 2]; 3]) -> Result<[i32; 3], drives::OutOfDomain> {
    const ROOT: f64 = 1.220_744_084_605_76;
    let mut q = [0; 3];
    for (k, q) in q.iter_mut().enumerate() {
        let share = (0.5 + i as f64 / ROOT.powi(k as i32 + 1)).fract();
        let [lo, hi] = ranges[k];
        // A unit inside of the range, so that a table which begins there has it.
        *q = whole_angle(lo + UNIT + (hi - lo - 2.0 * UNIT).max(0.0) * share)?;
    }
    Ok(q)
}
