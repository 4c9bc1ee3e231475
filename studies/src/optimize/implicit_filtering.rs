//! Implicit filtering (Kelley, Implicit Filtering, SIAM 2011) within bounds.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | h | size of the stencil, of the box | 1 |
//! | g | difference gradient | cost |
//! | B | model of the Hessian, by BFGS updates | cost |
//!
//! The gradient by differences of length h does not see noise that is shorter. Where the middle of the stencil is its lowest
//! point, or the gradient says so, the size has told all it can, and h is halved.

use nalgebra::{DMatrix, DVector};

use super::{Ending, Evaluations, into_box, order};

/// Sizes of the stencil: 1/2 to 1/2^8.
const SIZES: i32 = 8;
/// Steps at one size at most.
const STEPS: usize = 20;
/// A gradient this much smaller than h is none.
const FLAT: f64 = 0.01;
/// Lengths of a step that are tried at once.
const LENGTHS: [f64; 4] = [1.0, 0.5, 0.25, 0.125];

/// Searches until the smallest stencil has nothing below its middle.
pub(super) fn search(start: &DVector<f64>, on: &mut Evaluations<'_>) -> Result<(), Ending> {
    let mut x = start.clone();
    let mut cost = on.of(std::slice::from_ref(start))?[0];
    for size in 1..=SIZES {
        at_size(0.5f64.powi(size), &mut x, &mut cost, on)?;
    }
    Ok(())
}

/// Steps with a stencil of size `h`, as long as they lead down.
fn at_size(h: f64, x: &mut DVector<f64>, cost: &mut f64, on: &mut Evaluations<'_>) -> Result<(), Ending> {
    let mut before: Option<(DVector<f64>, DVector<f64>, DMatrix<f64>)> = None;
    for _ in 0..STEPS {
        let stencil = Stencil::around(x, *cost, h, on)?;
        let (lowest, least) = &stencil.lowest;
        let flat = (into_box(&*x - &stencil.gradient) - &*x).norm() <= FLAT * h;
        if !(*least < *cost) || flat {
            if *least < *cost {
                (*x, *cost) = (lowest.clone(), *least);
            }
            return Ok(());
        }
        // The first step at a size is as long as the stencil; then differences of gradients tell the Hessian.
        let g = &stencil.gradient;
        let plain = || DMatrix::identity(x.len(), x.len()) * (g.norm().max(f64::MIN_POSITIVE) / h);
        let hessian = match &before {
            Some((x0, g0, b)) => updated(b, &(&*x - x0), &(g - g0)),
            None => plain(),
        };
        let step = downhill(&hessian, x, g).unwrap_or_else(|| -g * (h / g.norm().max(f64::MIN_POSITIVE)));
        // Candidates along it, and the stencil's own lowest point.
        let candidates = LENGTHS.map(|length| into_box(&*x + &step * length));
        let costs = on.of(&candidates)?;
        let of_step = candidates.into_iter().zip(costs);
        let (to, down) = of_step
            .chain([(lowest.clone(), *least)])
            .min_by(|a, b| order(a.1).total_cmp(&order(b.1)))
            .expect("several");
        before = Some((std::mem::replace(x, to), stencil.gradient, hessian));
        *cost = down;
    }
    Ok(())
}

/// Points at h to both sides along each axis, or at the bound if that is nearer.
struct Stencil {
    gradient: DVector<f64>,
    lowest: (DVector<f64>, f64),
}

impl Stencil {
    fn around(x: &DVector<f64>, cost: f64, h: f64, on: &mut Evaluations<'_>) -> Result<Self, Ending> {
        let mut points = Vec::new();
        let mut places = Vec::new();
        for i in 0..x.len() {
            for side in [-h, h] {
                let at = (x[i] + side).clamp(0.0, 1.0);
                if at != x[i] {
                    let mut point = x.clone();
                    point[i] = at;
                    points.push(point);
                    places.push((i, at - x[i]));
                }
            }
        }
        let costs = on.of(&points)?;
        // Central differences where both sides could be evaluated, one-sided ones where one could.
        let mut slopes = vec![(0.0, 0); x.len()];
        for (&(i, away), &there) in places.iter().zip(&costs) {
            if there.is_finite() && cost.is_finite() {
                slopes[i].0 += (there - cost) / away;
                slopes[i].1 += 1;
            }
        }
        let gradient =
            DVector::from_iterator(x.len(), slopes.iter().map(|&(sum, n)| sum / f64::from(n.max(1))));
        let pairs = points.into_iter().zip(costs);
        let lowest = pairs.min_by(|a, b| order(a.1).total_cmp(&order(b.1))).unwrap_or((x.clone(), cost));
        Ok(Self { gradient, lowest })
    }
}

/// BFGS, left out where the curvature along the step is not positive.
fn updated(b: &DMatrix<f64>, s: &DVector<f64>, y: &DVector<f64>) -> DMatrix<f64> {
    let (curvature, bs) = (s.dot(y), b * s);
    let along = s.dot(&bs);
    if !(curvature > 1e-8 * s.norm() * y.norm() && along > 0.0) {
        return b.clone();
    }
    b + y * y.transpose() / curvature - &bs * bs.transpose() / along
}

/// Quasi-Newton step, in which what lies at a bound and would leave the box stays; `None` if the model has no minimum.
fn downhill(hessian: &DMatrix<f64>, x: &DVector<f64>, g: &DVector<f64>) -> Option<DVector<f64>> {
    let held = |i: usize| (x[i] <= 0.0 && g[i] > 0.0) || (x[i] >= 1.0 && g[i] < 0.0);
    let mut reduced = hessian.clone();
    let mut slope = g.clone();
    for i in (0..x.len()).filter(|&i| held(i)) {
        reduced.row_mut(i).fill(0.0);
        reduced.column_mut(i).fill(0.0);
        reduced[(i, i)] = 1.0;
        slope[i] = 0.0;
    }
    reduced.cholesky().map(|c| -c.solve(&slope))
}
