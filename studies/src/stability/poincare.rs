//! Poincaré maps by finite differences, and their Floquet multipliers (thesis 3.5).
//!
//! | symbol | name |
//! |---|---|
//! | x | deviation from the periodic motion where it crosses the section |
//! | P | where a motion that begins at x crosses it next |
//! | J | dP/dx at x = 0, by central differences |
//! | lambda_i | eigenvalues of J: what is left of a deviation after one period |
//!
//! Eigenvalues say something for smooth maps only. Two things tell whether P was smooth over the steps taken: how
//! much J changes with the step, and how much forward and backward differences differ.

use nalgebra::{Complex, DMatrix, DVector};

use chain::parallel;

/// Forward and backward differences, or two steps, may differ by this share for a map to count as smooth.
const SMOOTH: f64 = 0.1;
/// Sweeps of the eigenvalue iteration, per state.
const SWEEPS: usize = 300;
/// Largest multipliers that are looked for, and powers of J that separate them from the others.
const KEPT: usize = 12;
const POWERS: usize = 100;

/// J for one size of steps.
#[derive(Clone, Debug)]
pub struct Jacobian {
    /// In units of the steps: of each state one step is one.
    pub matrix: DMatrix<f64>,
    /// \[1\] Difference of forward and backward differences over their mean, of the whole matrix.
    pub asymmetry: f64,
}

/// What the differences of two step sizes say.
#[derive(Clone, Debug)]
pub(crate) struct Multipliers {
    /// lambda_i with the smaller step (real, imaginary), largest first.
    pub values: Vec<[f64; 2]>,
    /// |lambda|_max with the smaller and with the larger step.
    pub largest: [f64; 2],
    /// \[1\] Change of J from one step size to the other, over J.
    pub spread: f64,
    /// \[1\] Asymmetry of both.
    pub asymmetry: [f64; 2],
    /// \[1\] What is left after a period of a step of each state alone, in steps; smaller and larger steps.
    pub left: [Vec<f64>; 2],
    /// \[1\] Share of each state in the mode of the largest multiplier; the sum is 1.
    pub shares: Vec<f64>,
}

impl Multipliers {
    /// Whether the map was smooth over the steps taken; otherwise its multipliers mean nothing.
    pub(crate) fn smooth(&self) -> bool {
        self.spread < SMOOTH && self.asymmetry.iter().all(|a| *a < SMOOTH)
    }
}

/// Multipliers of `map`, which takes a deviation and answers with the state it leads to (any origin), or none if the
/// motion ended. `steps` are those of each state; the larger ones are `factor` times as large.
///
/// # Errors
/// A motion ended, or no eigenvalues were found.
pub(crate) fn multipliers(
    steps: &[f64],
    factor: f64,
    map: &(dyn Fn(&[f64]) -> Option<Vec<f64>> + Sync),
) -> Result<Multipliers, String> {
    let small = jacobian(steps, 1.0, map)?;
    let large = jacobian(steps, factor, map)?;
    let values = eigenvalues(&small.matrix)?;
    let other = eigenvalues(&large.matrix)?;
    let most = |v: &[Complex<f64>]| v.first().map_or(0.0, |l| l.norm());
    let spread = (&large.matrix - &small.matrix).norm() / small.matrix.norm().max(f64::MIN_POSITIVE);
    Ok(Multipliers {
        largest: [most(&values), most(&other)],
        spread,
        asymmetry: [small.asymmetry, large.asymmetry],
        left: [&small, &large].map(|j| j.matrix.column_iter().map(|c| c.norm()).collect()),
        shares: shares(&small.matrix, values.first().copied().unwrap_or_default()),
        values: values.iter().map(|l| [l.re, l.im]).collect(),
    })
}

/// J with steps `scale` times as large, column by column on all cores.
///
/// # Errors
/// A motion ended.
pub fn jacobian(
    steps: &[f64],
    scale: f64,
    map: &(dyn Fn(&[f64]) -> Option<Vec<f64>> + Sync),
) -> Result<Jacobian, String> {
    let n = steps.len();
    let image = |column: usize, sign: f64| {
        let mut x = vec![0.0; n];
        x[column] = sign * scale * steps[column];
        let y = map(&x)
            .ok_or_else(|| format!("the motion ended after a step of {:e} of state {column}", x[column]))?;
        Ok::<_, String>(DVector::from_iterator(n, y.iter().zip(steps).map(|(y, h)| y / (scale * h))))
    };
    let middle = image(0, 0.0)?;
    let columns = parallel::map(n, |j| (image(j, 1.0), image(j, -1.0)));
    let (mut matrix, mut bend) = (DMatrix::zeros(n, n), 0.0);
    for (j, (plus, minus)) in columns.into_iter().enumerate() {
        let (plus, minus) = (plus?, minus?);
        bend += (&plus + &minus - 2.0 * &middle).norm_squared();
        matrix.set_column(j, &((plus - minus) / 2.0));
    }
    let asymmetry = bend.sqrt() / matrix.norm().max(f64::MIN_POSITIVE);
    Ok(Jacobian { matrix, asymmetry })
}

/// The largest ones, largest first.
///
/// Most states of a walking robot are forgotten within a stride, and their block of J is nothing but rounding errors, on
/// which the QR algorithm does not converge. So J is first reduced to the subspace in which powers of J live.
fn eigenvalues(matrix: &DMatrix<f64>) -> Result<Vec<Complex<f64>>, String> {
    if !matrix.iter().all(|x| x.is_finite()) {
        return Err("the map is not finite".into());
    }
    let n = matrix.nrows();
    for kept in (1..=n.min(KEPT)).rev() {
        let mut basis = DMatrix::from_fn(n, kept, |i, j| ((1 + i) as f64 * (2.0 + j as f64)).sin()).qr().q();
        for _ in 0..POWERS {
            basis = (matrix * &basis).qr().q();
        }
        let reduced = basis.tr_mul(&(matrix * &basis));
        if let Some(schur) = nalgebra::Schur::try_new(reduced, f64::EPSILON, SWEEPS * kept) {
            let mut values: Vec<Complex<f64>> = schur.complex_eigenvalues().iter().copied().collect();
            values.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
            return Ok(values);
        }
    }
    Err("the eigenvalues of the map were not found".into())
}

/// |left eigenvector| times |right eigenvector|, state by state, by inverse iteration beside `lambda`.
fn shares(matrix: &DMatrix<f64>, lambda: Complex<f64>) -> Vec<f64> {
    let n = matrix.nrows();
    let beside = lambda * Complex::new(1.0 + 1e-9, 1e-9) + Complex::new(1e-12, 0.0);
    let shifted = matrix.map(|x| Complex::new(x, 0.0)) - DMatrix::identity(n, n) * beside;
    let vector = |of: DMatrix<Complex<f64>>| {
        let lu = of.lu();
        let mut v = DVector::from_fn(n, |i, _| Complex::new(1.0 + (i as f64 * 0.7).sin(), 0.0));
        for _ in 0..5 {
            let next = lu.solve(&v)?;
            let norm = next.norm();
            v = next.unscale(norm);
        }
        Some(v)
    };
    let (Some(right), Some(left)) = (vector(shifted.clone()), vector(shifted.transpose())) else {
        return vec![f64::NAN; n];
    };
    let products: Vec<f64> = right.iter().zip(left.iter()).map(|(a, b)| a.norm() * b.norm()).collect();
    let sum: f64 = products.iter().sum();
    products.into_iter().map(|p| p / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear map with a real multiplier, a complex pair and two that vanish in a Jordan block.
    #[test]
    fn a_linear_map_has_its_eigenvalues() {
        let (r, a) = (0.6_f64, 1.1_f64);
        let map = |x: &[f64]| {
            Some(vec![
                -0.8 * x[0] + 5.0 * x[1],
                r * (a.cos() * x[1] - a.sin() * x[2]),
                r * (a.sin() * x[1] + a.cos() * x[2]) + 3.0 * x[3],
                x[4],
                0.0,
            ])
        };
        let found = multipliers(&[1e-3, 1e-5, 1e-4, 1e-3, 1.0], 4.0, &map).unwrap();
        assert!((found.largest[0] - 0.8).abs() < 1e-9 && (found.largest[1] - 0.8).abs() < 1e-9);
        assert!((found.values[0][0] + 0.8).abs() < 1e-9 && found.values[0][1] == 0.0);
        for pair in &found.values[1..3] {
            assert!((pair[0].hypot(pair[1]) - r).abs() < 1e-9 && (pair[0] - r * a.cos()).abs() < 1e-9);
        }
        assert!(found.values[3..].iter().all(|l| l[0].hypot(l[1]) < 1e-6), "{:?}", found.values);
        assert!(found.smooth() && found.spread < 1e-9, "{found:?}");
        // The mode of -0.8 is the first state alone: its left eigenvector has others, its right one has not.
        assert!(found.shares[0] > 0.99, "{:?}", found.shares);
    }

    /// phi'' = -sin(phi) - 2 d phi' over a period of the section, about the equilibrium: e^{-d T} e^{+-i w T}.
    #[test]
    fn a_damped_pendulum_has_the_multipliers_of_its_closed_form() {
        let (d, period) = (0.1_f64, 2.0_f64);
        let flow = |x: &[f64]| {
            let rate = |x: [f64; 2]| [x[1], -x[0].sin() - 2.0 * d * x[1]];
            let (mut x, n) = ([x[0], x[1]], 2000);
            let h = period / f64::from(n);
            let ahead = |x: [f64; 2], k: [f64; 2], h: f64| [x[0] + h * k[0], x[1] + h * k[1]];
            for _ in 0..n {
                let a = rate(x);
                let b = rate(ahead(x, a, h / 2.0));
                let c = rate(ahead(x, b, h / 2.0));
                let e = rate(ahead(x, c, h));
                x = [0, 1].map(|i| x[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + e[i]));
            }
            Some(x.to_vec())
        };
        let found = multipliers(&[1e-3, 1e-3], 4.0, &flow).unwrap();
        let w = (1.0_f64 - d * d).sqrt() * period;
        let decay = (-d * period).exp();
        for l in &found.values {
            assert!(
                (l[0] - decay * w.cos()).abs() < 1e-5 && (l[1].abs() - decay * w.sin()).abs() < 1e-5,
                "{l:?}"
            );
        }
        assert!(found.smooth() && (found.largest[0] - found.largest[1]).abs() < 1e-5);
    }

    /// An early contact: beyond a small deviation the map has another slope. Where the kink lies between the steps, two
    /// step sizes disagree; where it lies at the periodic motion itself, forward and backward differences do.
    #[test]
    fn a_kink_is_told() {
        for (kink, name) in [(2e-4, "between the steps"), (0.0, "at the periodic motion")] {
            let map = move |x: &[f64]| Some(vec![0.3 * x[0] + 0.6 * (x[0] - kink).max(0.0)]);
            let found = multipliers(&[1e-4], 4.0, &map).unwrap();
            assert!(!found.smooth(), "{name}: {found:?}");
        }
        let far = |x: &[f64]| Some(vec![0.3 * x[0] + 0.6 * (x[0] - 1e-2).max(0.0)]);
        assert!(multipliers(&[1e-4], 4.0, &far).unwrap().smooth());
    }

    #[test]
    fn a_motion_that_ends_is_named() {
        let map = |x: &[f64]| (x[1] < 0.5).then(|| x.to_vec());
        let error = multipliers(&[1e-3, 1.0], 2.0, &map).unwrap_err();
        assert!(error.contains("state 1"), "{error}");
        let nan = |_: &[f64]| Some(vec![f64::NAN]);
        assert!(multipliers(&[1.0], 2.0, &nan).unwrap_err().contains("not finite"));
    }
}
