//! Floquet multipliers of a Poincaré map by regression over random disturbances (thesis 3.5).
//!
//! | symbol | name |
//! |---|---|
//! | x | disturbance of the periodic motion where it crosses the section, in steps of each state |
//! | y_1, y_2 | deviation from the mean of all motions one and two periods later, in the same steps |
//! | V | leading directions of y_1: what a period leaves of any disturbance |
//! | J | least squares of V^T y_2 = J V^T y_1 over all disturbances |
//! | lambda_i | eigenvalues of J: what a period leaves of a deviation |
//!
//! A robot that touches down in another time step after every disturbance has a map with jumps, which has no derivative: finite
//! differences across a jump mean nothing. Its slope over disturbances that are larger than the jumps does. How well that
//! is known, a bootstrap over the disturbances tells, and how much of y_2 a linear map explains. Two sizes of disturbances must
//! agree: otherwise the answer is that it cannot be told.

use nalgebra::{Complex, DMatrix};

use chain::parallel;

use crate::random::Random;

/// Directions of y_1 that are looked at: at most so many, each at least this share of the first.
const DIRECTIONS: (usize, f64) = (8, 0.03);
/// Resamplings of the bootstrap, and the shares of them below and above the interval.
const RESAMPLED: usize = 400;
const TAIL: f64 = 0.025;
/// \[1\] A linear map that explains less of y_2 says nothing.
const EXPLAINED: f64 = 0.5;
/// \[1\] An interval that is wider says nothing.
const WIDEST: f64 = 0.5;

/// Multipliers for one size of disturbances.
#[derive(Clone, Debug, serde::Serialize)]
pub(crate) struct Multipliers {
    /// \[1\] Root mean square of the disturbances of each state, in steps.
    pub size: f64,
    /// |lambda|_max.
    pub largest: f64,
    /// Its interval of 95 %.
    pub interval: [f64; 2],
    /// lambda_i (real, imaginary), largest first.
    pub values: Vec<[f64; 2]>,
    /// \[1\] Share of y_2 that J explains.
    pub explained: f64,
    /// \[1\] Root mean square of y_1, y_2 over all states, in steps.
    pub left: [f64; 2],
}

/// What two sizes of disturbances say together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Both intervals hold a common value.
    Known,
    /// They do not; but both end below one, and the deviation becomes less: disturbances of
    /// these sizes are forgotten.
    BelowOne,
    /// Too little is known, or something does not die away.
    CannotTell,
}

impl Verdict {
    pub(crate) fn of(found: &[Multipliers; 2]) -> Self {
        let [a, b] = found.each_ref().map(|m| m.interval);
        let narrow = found.iter().all(|m| m.interval[1] - m.interval[0] < WIDEST);
        let linear = found.iter().all(|m| m.explained > EXPLAINED);
        let agree = a[0].max(b[0]) <= a[1].min(b[1]);
        // What a linear map leaves open must die away, too: jumps of their own do not.
        let shrinks = found.iter().all(|m| m.left[1] < m.left[0]);
        if narrow && linear && agree {
            Self::Known
        } else if narrow && linear && shrinks && a[1].max(b[1]) < 1.0 {
            Self::BelowOne
        } else {
            Self::CannotTell
        }
    }

    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Known => "known",
            Self::BelowOne => "below one, no single number",
            Self::CannotTell => "cannot be told",
        }
    }
}

/// States one and two periods after a disturbance, any origin; none if the motion ended.
pub(crate) type Map<'a> = dyn Fn(&[f64]) -> Option<[Vec<f64>; 2]> + Sync + 'a;

/// Multipliers of `map` from `samples` disturbances with a root mean square of `size` `steps` of each state.
///
/// # Errors
/// A motion ended or is not finite, or there are fewer samples than they tell directions.
pub(crate) fn multipliers(
    steps: &[f64],
    size: f64,
    samples: usize,
    map: &Map<'_>,
) -> Result<Multipliers, String> {
    let n = steps.len();
    let origin = map(&vec![0.0; n]).ok_or("the undisturbed motion ended")?;
    // Both signs of every disturbance.
    let images = parallel::map(samples, |k| {
        let mut random = random(k as u64 / 2);
        let sign = if k % 2 == 0 { size } else { -size };
        let x: Vec<f64> = steps.iter().map(|h| sign * h * random.symmetric() * 3f64.sqrt()).collect();
        map(&x)
    });
    let mut y = [DMatrix::zeros(samples, n), DMatrix::zeros(samples, n)];
    for (k, image) in images.into_iter().enumerate() {
        let image = image.ok_or_else(|| format!("the motion ended after disturbance {k} of {size} steps"))?;
        for (y, (image, origin)) in y.iter_mut().zip(image.iter().zip(&origin)) {
            for (j, ((now, then), h)) in image.iter().zip(origin).zip(steps).enumerate() {
                y[(k, j)] = (now - then) / h;
            }
        }
    }
    if !y.iter().all(|y| y.iter().all(|x| x.is_finite())) {
        return Err("the map is not finite".into());
    }
    // From their mean: the undisturbed motion has jumps of its own, which every deviation from it would carry.
    for y in &mut y {
        let mean = y.row_mean();
        y.row_iter_mut().for_each(|mut row| row -= &mean);
    }
    let left = y.each_ref().map(|y| (y.norm_squared() / (samples * n) as f64).sqrt());
    let basis = directions(&y[0])?;
    let z = y.each_ref().map(|y| y * &basis);
    // Of all of y_2 by its own regression, of which the multipliers see the part along V.
    let explained = 1.0 - (&y[1] - &z[0] * slope(&z[0], &y[1])?).norm_squared() / y[1].norm_squared();
    let values = eigenvalues(&slope(&z[0], &z[1])?)?;
    let interval = bootstrap(&z)?;
    Ok(Multipliers {
        size,
        largest: values.first().map_or(0.0, |l| l.norm()),
        interval,
        values: values.iter().map(|l| [l.re, l.im]).collect(),
        explained: if y[1].norm() > 0.0 { explained } else { 1.0 },
        left,
    })
}

/// V: leading right singular vectors of the deviations.
fn directions(y: &DMatrix<f64>) -> Result<DMatrix<f64>, String> {
    let svd =
        y.clone().try_svd(false, true, f64::EPSILON, 0).ok_or("no singular values of the deviations")?;
    let rows = svd.v_t.ok_or("no directions of the deviations")?;
    let mut order: Vec<usize> = (0..svd.singular_values.len()).collect();
    order.sort_by(|&a, &b| svd.singular_values[b].total_cmp(&svd.singular_values[a]));
    let least = DIRECTIONS.1 * order.first().map_or(0.0, |&i| svd.singular_values[i]);
    let kept =
        order.iter().take(DIRECTIONS.0).filter(|&&i| svd.singular_values[i] >= least.max(f64::MIN_POSITIVE));
    let columns: Vec<_> = kept.map(|&i| rows.row(i).transpose()).collect();
    if columns.is_empty() || y.nrows() < 4 * columns.len() {
        return Err(format!("{} disturbances are too few, or nothing is left of any of them", y.nrows()));
    }
    Ok(DMatrix::from_columns(&columns))
}

/// J^T of b = a J^T by least squares.
fn slope(a: &DMatrix<f64>, b: &DMatrix<f64>) -> Result<DMatrix<f64>, String> {
    let square = a.tr_mul(a);
    let solved = square.cholesky().map(|c| c.solve(&a.tr_mul(b)));
    solved.ok_or_else(|| "the disturbances do not tell the directions apart".into())
}

/// Largest first.
fn eigenvalues(matrix: &DMatrix<f64>) -> Result<Vec<Complex<f64>>, String> {
    let schur = nalgebra::Schur::try_new(matrix.clone(), f64::EPSILON, 300 * matrix.nrows());
    let mut values: Vec<Complex<f64>> = schur
        .ok_or("the eigenvalues of the map were not found")?
        .complex_eigenvalues()
        .iter()
        .copied()
        .collect();
    values.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
    Ok(values)
}

/// Interval of |lambda|_max: disturbances drawn with replacement, both signs of one together.
fn bootstrap(z: &[DMatrix<f64>; 2]) -> Result<[f64; 2], String> {
    let pairs = z[0].nrows() / 2;
    let mut random = random(u64::MAX);
    let mut found = Vec::with_capacity(RESAMPLED);
    for _ in 0..RESAMPLED {
        let drawn: Vec<usize> = (0..pairs)
            .flat_map(|_| {
                let k = ((random.symmetric() + 1.0) * 0.5 * pairs as f64) as usize;
                [2 * k.min(pairs - 1), 2 * k.min(pairs - 1) + 1]
            })
            .collect();
        let [a, b] = z.each_ref().map(|z| z.select_rows(&drawn));
        found.push(eigenvalues(&slope(&a, &b)?)?.first().map_or(0.0, |l| l.norm()));
    }
    found.sort_by(f64::total_cmp);
    let at = |share: f64| found[((RESAMPLED - 1) as f64 * share).round() as usize];
    Ok([at(TAIL), at(1.0 - TAIL)])
}

/// Random numbers whose seeds are far from each other.
fn random(seed: u64) -> Random {
    Random(seed.wrapping_mul(0xD1B5_4A32_D192_ED03))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both sizes of a map that is applied once and once more.
    fn both(steps: &[f64], once: &(dyn Fn(&[f64]) -> Vec<f64> + Sync)) -> ([Multipliers; 2], Verdict) {
        let map = |x: &[f64]| {
            let y = once(x);
            let z = once(&y);
            Some([y, z])
        };
        let found = [1.0, 2.0].map(|size| multipliers(steps, size, 300, &map).unwrap());
        let verdict = Verdict::of(&found);
        (found, verdict)
    }

    fn holds(m: &Multipliers, expected: f64) -> bool {
        m.interval[0] - 1e-9 <= expected && expected <= m.interval[1] + 1e-9
    }

    /// A linear map with a real multiplier, a complex pair, and two states that vanish; then with jumps at every deviation, of
    /// a third of what is left, as of contacts that are felt in one time step or the next.
    #[test]
    fn a_linear_map_has_its_eigenvalues_with_jumps_or_without() {
        let (r, a) = (0.6_f64, 1.1_f64);
        for jump in [0.0, 0.3] {
            let map = |x: &[f64]| {
                let jumps = |k: usize| jump * (1e7 * (x[0] + x[1] + x[2] + k as f64 * 1e-4)).sin().signum();
                vec![
                    -0.8 * x[0] + 0.5 * x[1] + 1e-3 * jumps(0),
                    r * (a.cos() * x[1] - a.sin() * x[2]) + 1e-3 * jumps(1),
                    r * (a.sin() * x[1] + a.cos() * x[2]) + 3.0 * x[3] + 1e-3 * jumps(2),
                    x[4],
                    0.0,
                ]
            };
            let (found, verdict) = both(&[1e-3; 5], &map);
            assert_eq!(verdict, Verdict::Known, "{found:?}");
            assert!(found.iter().all(|m| holds(m, 0.8)), "jumps of {jump}: {found:?}");
            assert!(found.iter().all(|m| m.interval[1] - m.interval[0] < 0.25), "{found:?}");
            // The complex pair, by its size.
            let width = 1e-9 + 0.2 * jump;
            for m in &found {
                let pair: Vec<_> = m.values.iter().filter(|l| l[1].abs() > 0.3).collect();
                assert_eq!(pair.len(), 2, "{m:?}");
                assert!((pair[0][0].hypot(pair[0][1]) - r).abs() < width, "{m:?}");
            }
        }
    }

    /// phi'' = -sin(phi) - 2 d phi' over a period of the section, about the equilibrium: e^{-d T}.
    #[test]
    fn a_damped_pendulum_has_the_multipliers_of_its_closed_form() {
        let (d, period) = (0.1_f64, 2.0_f64);
        let flow = |x: &[f64]| {
            let rate = |x: [f64; 2]| [x[1], -x[0].sin() - 2.0 * d * x[1]];
            let (mut x, n) = ([x[0], x[1]], 500);
            let h = period / f64::from(n);
            let ahead = |x: [f64; 2], k: [f64; 2], h: f64| [x[0] + h * k[0], x[1] + h * k[1]];
            for _ in 0..n {
                let a = rate(x);
                let b = rate(ahead(x, a, h / 2.0));
                let c = rate(ahead(x, b, h / 2.0));
                let e = rate(ahead(x, c, h));
                x = [0, 1].map(|i| x[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + e[i]));
            }
            x.to_vec()
        };
        let (found, verdict) = both(&[1e-3, 1e-3], &flow);
        assert_eq!(verdict, Verdict::Known);
        let w = (1.0_f64 - d * d).sqrt() * period;
        for l in &found[0].values {
            assert!((l[0] - (-d * period).exp() * w.cos()).abs() < 1e-5, "{l:?}");
            assert!((l[1].abs() - (-d * period).exp() * w.sin()).abs() < 1e-5, "{l:?}");
        }
    }

    /// Speed after an impact of a rimless wheel, spokes 2 `half` \[rad\] apart, on a slope \[rad\]; the next spoke's contact is felt
    /// at the end of the time step of `h` \[s\] in which it comes.
    fn rimless(omega: f64, half: f64, slope: f64, h: f64) -> f64 {
        let (mut phi, mut omega) = (slope - half, omega);
        while phi < slope + half {
            let turn = |phi: f64| multibody::GRAVITY_ACCELERATION * phi.sin(); // of unit length
            let middle = phi + 0.5 * h * omega;
            omega += h * turn(middle);
            phi = middle + 0.5 * h * omega;
        }
        omega * (2.0 * half).cos()
    }

    /// The rimless wheel: its multiplier is cos(2 half)^2, by conservation of energy and of angular momentum about the spoke that
    /// lands. Slopes of differences that are as small as its time steps are something else altogether.
    #[test]
    fn a_rimless_wheel_has_its_multiplier_though_contact_waits_for_a_time_step() {
        let mut held = 0;
        for (half, slope) in [(0.26_f64, 0.08), (0.35, 0.15), (0.4, 0.2)] {
            let expected = (2.0 * half).cos().powi(2);
            for h in [1e-4, 1e-3] {
                let mut omega = 2.0;
                (0..200).for_each(|_| omega = rimless(omega, half, slope, h));
                let map = |x: &[f64]| vec![rimless(omega + x[0], half, slope, h) - omega];
                let (found, verdict) = both(&[0.03], &map);
                assert_eq!(verdict, Verdict::Known, "{found:?}");
                assert!(
                    found.iter().all(|m| (m.largest / expected - 1.0).abs() < 0.02),
                    "{expected} {found:?}"
                );
                held += found.iter().filter(|m| holds(m, expected)).count();
                assert!(found.iter().all(|m| m.interval[1] - m.interval[0] < 0.1), "{found:?}");
            }
            // As differences: the jumps of the coarse step over a step of 1e-5.
            let mut omega = 2.0;
            (0..200).for_each(|_| omega = rimless(omega, half, slope, 1e-3));
            let worst = (0..2000).map(|k| {
                let at = omega + 1e-5 * f64::from(k);
                let d = rimless(at + 5e-6, half, slope, 1e-3) - rimless(at - 5e-6, half, slope, 1e-3);
                (d / 1e-5 - expected).abs()
            });
            assert!(worst.fold(0.0, f64::max) > 10.0);
        }
        assert!(held >= 10, "{held} of 12 intervals of 95 %");
    }

    /// Where there is no slope, none is told: jumps larger than what is left, and growth that comes with size.
    #[test]
    fn a_map_without_a_slope_has_no_multipliers() {
        let (found, verdict) = both(&[1e-3], &|x| vec![0.3 * x[0] + 3e-3 * (1e8 * x[0]).sin().signum()]);
        assert_eq!(verdict, Verdict::CannotTell, "{found:?}");
        // Sizes that are answered differently, one of them by growth.
        let (found, verdict) = both(&[1e-3], &|x| vec![0.3 * x[0] + 4e5 * x[0].powi(3)]);
        assert_eq!(verdict, Verdict::CannotTell, "{found:?}");
    }

    /// An interval of 95 % holds the value in nearly all of many trials.
    #[test]
    fn the_interval_holds_the_multiplier_as_often_as_it_says() {
        let held = (0..60).filter(|trial| {
            let shift = 0.1 * f64::from(*trial);
            let once = |x: &[f64]| vec![0.7 * x[0] + 4e-4 * (1e7 * x[0] + shift).sin(), 0.2 * x[1]];
            let map = |x: &[f64]| {
                let y = once(x);
                let z = once(&y);
                Some([y, z])
            };
            holds(&multipliers(&[1e-3, 1e-3], 1.0, 60, &map).unwrap(), 0.7)
        });
        let held = held.count();
        assert!(held >= 51, "{held} of 60");
    }

    #[test]
    fn a_motion_that_ends_is_named() {
        let ends = |x: &[f64]| (x[0] < 0.5).then(|| [x.to_vec(), x.to_vec()]);
        assert!(multipliers(&[1.0], 1.0, 20, &ends).unwrap_err().contains("ended after disturbance"));
        let nan = |_: &[f64]| Some([vec![f64::NAN], vec![f64::NAN]]);
        assert!(multipliers(&[1.0], 1.0, 20, &nan).unwrap_err().contains("not finite"));
    }
}
