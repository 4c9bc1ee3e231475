//! Tables of a linkage in scaled 32-bit integers, as in Lola's local controllers, which have no floating point unit
//! (thesis 5.5.2). Made once, off-line, in floating point; read with integers only, of 32 bits, products of 64.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | q | joint angle | 2^-29 rad, as on the bus: within ±4 rad |
//! | φ | angle of the motor, share of the knee included | 2^-a rad, see [`FixedTable::angle_unit`] |
//! | ∂φ/∂q | ratio | 2^-r, one r for each joint |
//! | h | distance of the points, the same whole number everywhere | 2^-29 rad |
//!
//! a and r are as large as the largest number in its column allows, so that 31 bits and a sign are used. An angle between two
//! points is met by linear interpolation, the weights in 30 bits. Its error is that of [`LookupTable`](crate::lookup::LookupTable),
//! at most h²/8 times the second derivative in each dimension, until the table is so fine that rounding is more:
//! [`FixedTable::rounding`].

use std::fmt;

use crate::{OutOfDomain, Transmission};

/// 1 rad of a joint angle.
const ANGLE: f64 = (1u64 << 29) as f64;
/// Bits of a weight.
const WEIGHT: u32 = 30;
/// Largest number in a table; rounding while it is read goes beyond it by less than what is left of 31 bits.
const MOST: f64 = (i32::MAX - 4) as f64;
/// More bits behind the point than this are of no use to anyone.
const FINEST: i32 = 30;

/// Motor angle and ratios of a transmission on a grid, in integers.
#[derive(Clone, Debug)]
pub struct FixedTable {
    axes: [TableAxis; 2],
    /// Angle and the ratios by the table's joints, the second joint's index running fastest.
    rows: Vec<[i32; 3]>,
    /// Bits behind the point of the columns.
    bits: [i32; 3],
    /// Share of the joint that an ankle's motor is driven past, and its bits.
    knee: (i32, i32),
    /// True if the table's joints are the second and third one.
    ankle: bool,
}

/// Grid of one dimension \[2^-29 rad\].
#[derive(Clone, Copy, Debug)]
struct TableAxis {
    lower: i64,
    step: i64,
    points: usize,
}

/// Entry of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// \[[`FixedTable::angle_unit`]\] Angle of the motor.
    pub angle: i32,
    /// \[[`FixedTable::ratio_units`]\] By joints as in [`Transmission::at`]; 0 behind the last one.
    pub ratio: [i32; 3],
}

/// Why it says nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutOfTable {
    /// A joint angle lies outside of the table.
    Beyond {
        /// Which joint, as in [`Transmission::at`].
        joint: usize,
        /// \[2^-29 rad\]
        angle: i32,
    },
    /// The angle of the motor does not fit 32 bits: the knee is far outside of the range that the table was made for.
    Overflow {
        /// \[[`FixedTable::angle_unit`]\]
        angle: i64,
    },
}

impl FixedTable {
    /// Table over `ranges` \[rad\] of the joints as in [`Transmission::at`], with so many `points`, at least 2, in each of its
    /// dimensions: one for a transmission on one joint; adduction and flexion for an ankle, whose knee's range chooses the
    /// scale of the angle.
    ///
    /// # Errors
    /// The linkage has a dead point in a range, or a range is empty, not finite, beyond ±4 rad or shorter than its points
    /// are many.
    pub fn new(
        transmission: &Transmission,
        ranges: [[f64; 2]; 3],
        points: [usize; 2],
    ) -> Result<Self, OutOfDomain> {
        let ankle = transmission.joints() == 3;
        let first = if ankle { 1 } else { 0 };
        let second = if ankle { TableAxis::new(ranges[2], points[1])? } else { TableAxis::POINT };
        let axes = [TableAxis::new(ranges[first], points[0])?, second];
        let mut rows = Vec::with_capacity(axes[0].points * axes[1].points);
        let mut share = 0.0;
        for i in 0..axes[0].points {
            for j in 0..axes[1].points {
                let (x, y) = (axes[0].at(i), axes[1].at(j));
                let at = if ankle { [0.0, x, y] } else { [x, 0.0, 0.0] };
                let gear = transmission.at(at, [0.0; 3])?;
                let [a, b, c] = gear.ratio;
                share = if ankle { a } else { 0.0 };
                rows.push(if ankle { [gear.angle, b, c] } else { [gear.angle, a, 0.0] });
            }
        }
        let knee = if ankle { share * largest(ranges[0]) } else { 0.0 };
        let column = |k: usize| rows.iter().fold(0.0_f64, |m, row| m.max(row[k].abs()));
        let knee_bits = bits(share)?;
        // A share of the knee is shifted right to the angle's scale, never left.
        let angle_bits = bits(column(0) + knee.abs())?.min(knee_bits + 29);
        let bits = [angle_bits, bits(column(1))?, bits(column(2))?];
        let row = |row: &[f64; 3]| [0, 1, 2].map(|k| scaled(row[k], bits[k]));
        Ok(Self {
            axes,
            rows: rows.iter().map(row).collect(),
            bits,
            knee: (scaled(share, knee_bits), knee_bits),
            ankle,
        })
    }

    /// Motor angle and ratios at joint angles `q` \[2^-29 rad\], joints as in [`Transmission::at`]. Integers only.
    pub fn at(&self, q: [i32; 3]) -> Result<Reading, OutOfTable> {
        if !self.ankle {
            let (i, s) = self.axes[0].cell(q[0]).ok_or(OutOfTable::Beyond { joint: 0, angle: q[0] })?;
            let [angle, ratio, _] = mean(&self.rows[i], &self.rows[i + 1], s);
            return Ok(Reading { angle, ratio: [ratio, 0, 0] });
        }
        let (i, s) = self.axes[0].cell(q[1]).ok_or(OutOfTable::Beyond { joint: 1, angle: q[1] })?;
        let (j, t) = self.axes[1].cell(q[2]).ok_or(OutOfTable::Beyond { joint: 2, angle: q[2] })?;
        let n = self.axes[1].points;
        let (lower, upper) = (&self.rows[i * n + j..], &self.rows[(i + 1) * n + j..]);
        let [angle, a, b] = mean(&mean(&lower[0], &lower[1], t), &mean(&upper[0], &upper[1], t), s);
        let (share, bits) = self.knee;
        let driven = shifted(i64::from(share) * i64::from(q[0]), bits + 29 - self.bits[0]);
        let angle = i64::from(angle) + driven;
        let angle = i32::try_from(angle).map_err(|_| OutOfTable::Overflow { angle })?;
        Ok(Reading { angle, ratio: [share, a, b] })
    }

    /// Motor angle \[rad\] and ratios at joint angles `q` \[rad\]: to integers, [`FixedTable::at`], and back.
    pub fn at_angles(&self, q: [f64; 3]) -> Result<(f64, [f64; 3]), OutOfDomain> {
        let mut angles = [0; 3];
        for (k, angle) in angles.iter_mut().enumerate().take(if self.ankle { 3 } else { 1 }) {
            *angle = whole_angle(q[k])?;
        }
        let found = self.at(angles).map_err(|refused| match refused {
            OutOfTable::Beyond { joint, .. } => OutOfDomain::Table { angle: q[joint] },
            OutOfTable::Overflow { .. } => OutOfDomain::Table { angle: q[0] },
        })?;
        let units = self.ratio_units();
        let ratio = [0, 1, 2].map(|k| f64::from(found.ratio[k]) * units[k]);
        Ok((f64::from(found.angle) * self.angle_unit(), ratio))
    }

    /// \[rad\] What 1 is in the motor's angle.
    pub fn angle_unit(&self) -> f64 {
        unit(self.bits[0])
    }

    /// \[1\] What 1 is in the ratio by each joint.
    pub fn ratio_units(&self) -> [f64; 3] {
        let [_, a, b] = self.bits.map(unit);
        if self.ankle { [unit(self.knee.1), a, b] } else { [a, 1.0, 1.0] }
    }

    /// \[rad\] Most that rounding adds to the motor's angle at whole joint angles: of the table's numbers, of the means and
    /// of their weights, and of the knee's share.
    pub fn rounding(&self) -> f64 {
        let n = self.axes[1].points;
        let far = |a: &[i32; 3], b: &[i32; 3]| f64::from(a[0].abs_diff(b[0])) * unit(WEIGHT as i32 + 1);
        let along = |stride: usize| {
            let pairs = self.rows.iter().zip(self.rows.iter().skip(stride)).enumerate();
            let inside = pairs.filter(|(k, _)| stride == n || k % n + 1 < n);
            inside.fold(0.0_f64, |m, (_, (a, b))| m.max(far(a, b)))
        };
        let knee = if self.ankle { 0.5 + 0.5 * unit(self.knee.1) * 4.0 / self.angle_unit() } else { 0.0 };
        let means = if self.ankle { 1.0 + along(1) } else { 0.5 };
        (0.5 + means + along(n) + knee) * self.angle_unit()
    }

    /// Bytes of the table.
    pub fn bytes(&self) -> usize {
        self.rows.len() * 4 * if self.ankle { 3 } else { 2 }
    }
}

impl TableAxis {
    /// The dimension that a table on one joint lacks.
    const POINT: Self = Self { lower: 0, step: 1, points: 1 };

    fn new([lo, hi]: [f64; 2], points: usize) -> Result<Self, OutOfDomain> {
        let points = points.max(2);
        // Outwards, so that the ends are inside.
        let (lower, upper) = (i64::from(floor(lo)?), i64::from(ceil(hi)?));
        let step = (upper - lower + points as i64 - 2) / (points as i64 - 1);
        if upper - lower < points as i64 - 1 {
            return Err(OutOfDomain::Table { angle: hi });
        }
        Ok(Self { lower, step, points })
    }

    /// \[rad\] The i-th point.
    fn at(&self, i: usize) -> f64 {
        (self.lower + i as i64 * self.step) as f64 / ANGLE
    }

    /// The cell of a coordinate, and how far in it the coordinate lies; none outside of the grid.
    fn cell(&self, x: i32) -> Option<(usize, i64)> {
        let (inside, cells) = (i64::from(x) - self.lower, self.points as i64 - 1);
        if inside < 0 || inside > cells * self.step {
            return None;
        }
        let at = ((inside << WEIGHT) + self.step / 2) / self.step; // below 2^63: inside is below 2^33
        let i = (at >> WEIGHT).min(cells - 1);
        Some((i as usize, at - (i << WEIGHT)))
    }
}

/// A joint angle \[rad\] in 2^-29 rad, to the nearest.
///
/// # Errors
/// It is NaN, or beyond ±4 rad.
pub fn whole_angle(q: f64) -> Result<i32, OutOfDomain> {
    whole((q * ANGLE).round(), q)
}

fn floor(q: f64) -> Result<i32, OutOfDomain> {
    whole((q * ANGLE).floor(), q)
}

fn ceil(q: f64) -> Result<i32, OutOfDomain> {
    whole((q * ANGLE).ceil(), q)
}

fn whole(scaled: f64, q: f64) -> Result<i32, OutOfDomain> {
    if !q.is_finite() {
        return Err(OutOfDomain::NotFinite);
    }
    let fits = (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&scaled);
    if fits { Ok(scaled as i32) } else { Err(OutOfDomain::Table { angle: q }) }
}

/// Linear interpolation of all columns, to the nearest; the weight of `b` in 2^-30.
fn mean(a: &[i32; 3], b: &[i32; 3], weight: i64) -> [i32; 3] {
    // Below 2^32 times 2^30; the mean lies between a and b.
    [0, 1, 2].map(|k| {
        let (a, b) = (i64::from(a[k]), i64::from(b[k]));
        (a + shifted((b - a) * weight, WEIGHT as i32)) as i32
    })
}

/// x 2^-bits, to the nearest.
fn shifted(x: i64, bits: i32) -> i64 {
    if bits <= 0 { x } else { (x + (1 << (bits - 1))) >> bits }
}

/// As many bits behind the point as numbers up to `most` leave of 31.
fn bits(most: f64) -> Result<i32, OutOfDomain> {
    if !most.is_finite() {
        return Err(OutOfDomain::NotFinite);
    }
    let most = most.abs();
    let bits = if most > 0.0 { (MOST / most).log2().floor() as i32 } else { FINEST };
    Ok(bits.min(FINEST))
}

fn unit(bits: i32) -> f64 {
    (-f64::from(bits)).exp2()
}

fn scaled(x: f64, bits: i32) -> i32 {
    (x / unit(bits)).round() as i32
}

fn largest([lo, hi]: [f64; 2]) -> f64 {
    lo.abs().max(hi.abs())
}

impl fmt::Display for OutOfTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Beyond { joint, angle } => {
                let angle = f64::from(*angle) / ANGLE;
                write!(f, "joint {joint} of the linkage at {angle:.4} rad lies outside of the look-up table")
            }
            Self::Overflow { angle } => {
                write!(f, "angle of the motor, {angle}, does not fit the 32 bits of the look-up table")
            }
        }
    }
}

impl std::error::Error for OutOfTable {}
