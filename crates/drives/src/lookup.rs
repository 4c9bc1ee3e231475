//! Tables of a linkage with linear interpolation, as in Lola's local controllers, which have no floating point unit
//! (thesis 5.5.2): motor angle and ratios over the joints' ranges, made once. A knee takes one dimension, an ankle two; the
//! share of the knee in an ankle's motor is linear and stays outside.
//!
//! The error of linear interpolation falls with the square of the number of points (`tests/lookup.rs`).

use crate::{OutOfDomain, Transmission};

/// Motor angle and ratios of a transmission on a grid.
#[derive(Clone, Debug)]
pub struct LookupTable {
    /// Grid of every dimension: lower end \[rad\], distance of the points \[rad\], number of points.
    grid: [(f64, f64, usize); 2],
    /// Angle \[rad\] and the ratios by the table's joints, the second joint's index running fastest.
    rows: Vec<[f64; 3]>,
    /// Share of the joint that an ankle's motor is driven past.
    knee: f64,
    /// True if the table's joints are the second and third one.
    ankle: bool,
}

impl LookupTable {
    /// Table over `ranges` \[rad\] with so many `points`, at least 2; of a transmission on one joint only the first of both is
    /// used, an ankle takes adduction and flexion.
    pub fn new(
        transmission: &Transmission,
        ranges: [[f64; 2]; 2],
        points: [usize; 2],
    ) -> Result<Self, OutOfDomain> {
        let ankle = transmission.joints() == 3;
        let axis = |k: usize| {
            let n = points[k].max(2);
            (ranges[k][0], (ranges[k][1] - ranges[k][0]) / (n - 1) as f64, n)
        };
        let grid = [axis(0), if ankle { axis(1) } else { (0.0, 1.0, 1) }];
        // Row by row. An ankle turns with the knee at a constant ratio, so the knee needs no axis.
        let mut rows = Vec::with_capacity(grid[0].2 * grid[1].2);
        let mut knee = 0.0;
        for i in 0..grid[0].2 {
            for j in 0..grid[1].2 {
                let q = [grid[0].0 + i as f64 * grid[0].1, grid[1].0 + j as f64 * grid[1].1];
                let at = if ankle { [0.0, q[0], q[1]] } else { [q[0], 0.0, 0.0] };
                let gear = transmission.at(at, [0.0; 3])?;
                let [a, b, c] = gear.ratio;
                rows.push(if ankle { [gear.angle, b, c] } else { [gear.angle, a, 0.0] });
                knee = if ankle { a } else { 0.0 };
            }
        }
        Ok(Self { grid, rows, knee, ankle })
    }

    /// Motor angle \[rad\] and ratios at joint angles `q` \[rad\], joints as in [`Transmission::at`]; an error outside of the
    /// table.
    pub fn at(&self, q: [f64; 3]) -> Result<(f64, [f64; 3]), OutOfDomain> {
        let [x, y] = if self.ankle { [q[1], q[2]] } else { [q[0], 0.0] };
        let ((i, s), (j, t)) = (cell(x, self.grid[0])?, cell(y, self.grid[1])?);
        let n = self.grid[1].2;
        let (lower, upper) = (i * n, (i + 1) * n);
        let next = (j + 1).min(n - 1);
        let corners = [lower + j, lower + next, upper + j, upper + next].map(|k| self.rows[k]);
        let weights = [(1.0 - s) * (1.0 - t), (1.0 - s) * t, s * (1.0 - t), s * t];
        let mean = |k: usize| (0..4).map(|c| weights[c] * corners[c][k]).sum::<f64>();
        let (angle, a, b) = (mean(0), mean(1), mean(2));
        Ok(if self.ankle { (angle + self.knee * q[0], [self.knee, a, b]) } else { (angle, [a, 0.0, 0.0]) })
    }

    /// Number of numbers in the table.
    pub fn size(&self) -> usize {
        self.rows.len() * if self.ankle { 3 } else { 2 }
    }
}

/// The cell of a coordinate, and how far in it the coordinate lies, from 0 to 1.
fn cell(x: f64, (lower, step, points): (f64, f64, usize)) -> Result<(usize, f64), OutOfDomain> {
    if points == 1 {
        return Ok((0, 0.0));
    }
    let (at, last) = ((x - lower) / step, (points - 1) as f64);
    let beyond = 1e-9 * last; // rounding at the ends of the range
    if !(at >= -beyond && at <= last + beyond) {
        return Err(if x.is_finite() { OutOfDomain::Table { angle: x } } else { OutOfDomain::NotFinite });
    }
    let at = at.clamp(0.0, last);
    let i = (at as usize).min(points - 2);
    Ok((i, at - i as f64))
}
