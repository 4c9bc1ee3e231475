//! Costs whose minima are known.

use std::f64::consts::TAU;

use super::*;

const METHODS: [Optimizer; 2] = [Optimizer::ImplicitFiltering, Optimizer::CmaEs];

fn point(numbers: &[f64]) -> DVector<f64> {
    DVector::from_column_slice(numbers)
}

fn found(
    method: Optimizer,
    cost: &(dyn Fn(&DVector<f64>) -> f64 + Sync),
    start: &[f64],
    most: usize,
    seed: u64,
) -> (Evaluation, Ending, usize) {
    let mut evaluations = Evaluations::new(cost, most);
    let ending = method.search(&point(start), seed, &mut evaluations);
    assert!(evaluations.all.iter().all(|e| e.point.iter().all(|x| (0.0..=1.0).contains(x))));
    (evaluations.best().unwrap().clone(), ending, evaluations.all.len())
}

/// A quadratic in turned axes, whose curvatures differ by a factor of 100, with its minimum at (0.7, 0.3, 0.55).
fn bowl(x: &DVector<f64>) -> f64 {
    let d = x - point(&[0.7, 0.3, 0.55]);
    let (a, b, c) = (d[0] + d[1] + d[2], d[0] - d[1], d[0] + d[1] - 2.0 * d[2]);
    a * a / 3.0 + 10.0 * b * b / 2.0 + 100.0 * c * c / 6.0
}

#[test]
fn the_minimum_of_a_bowl_is_found_and_chance_does_not_find_it() {
    let off = |method, seed| {
        let (best, ending, _) = found(method, &bowl, &[0.1, 0.9, 0.2], 600, seed);
        ((&best.point - point(&[0.7, 0.3, 0.55])).norm(), ending)
    };
    // Curvatures that differ by 100 hide a valley of 10 times the smallest stencil, 1/256, from points along the axes.
    for (method, near) in [(Optimizer::ImplicitFiltering, 0.02), (Optimizer::CmaEs, 0.005)] {
        for seed in 1..=5 {
            let (off, ending) = off(method, seed);
            assert!(off < near && ending == Ending::Converged, "{method:?}, seed {seed}: {off}, {ending:?}");
        }
    }
    assert!((1..=5).all(|seed| off(Optimizer::Random, seed).0 > 0.02));
}

/// Noise with steeper slopes than the round bowl under it: what it hides is left, not more.
#[test]
fn short_noise_is_filtered() {
    const NOISE: f64 = 0.05;
    let round = |x: &DVector<f64>| 2.0 * (x - point(&[0.7, 0.3, 0.55])).norm_squared();
    let noisy = |x: &DVector<f64>| round(x) + NOISE * (x.sum() * TAU * 20.0).sin();
    let starts = [[0.1, 0.9, 0.2], [0.9, 0.9, 0.9], [0.2, 0.1, 0.3]];
    for start in starts {
        for method in METHODS {
            let (best, ..) = found(method, &noisy, &start, 600, 4);
            let left = round(&best.point);
            assert!(left < 5.0 * NOISE, "{method:?} from {start:?}: {left}");
        }
    }
}

#[test]
fn a_minimum_in_a_corner_is_reached() {
    let slope = |x: &DVector<f64>| x[0] - 2.0 * x[1] + 3.0 * x[2];
    let (best, ..) = found(Optimizer::ImplicitFiltering, &slope, &[0.5, 0.5, 0.5], 200, 1);
    assert_eq!(best.point, point(&[0.0, 1.0, 0.0]));
    let (best, ..) = found(Optimizer::CmaEs, &slope, &[0.5, 0.5, 0.5], 600, 1);
    assert!((best.point - point(&[0.0, 1.0, 0.0])).norm() < 0.02);
}

/// Half of the box cannot be evaluated, and the minimum lies at its border.
#[test]
fn points_that_cannot_be_evaluated_are_left_out() {
    let half = |x: &DVector<f64>| if x[0] > 0.6 { f64::NAN } else { bowl(x) };
    // By hand: of the bowl over x, y = 0.6 - 0.7 the rest is free, and its least is where both derivatives are 0.
    let least = (0..=100u32)
        .flat_map(|i| {
            (0..=100u32).map(move |k| bowl(&point(&[0.6, f64::from(i) / 100.0, f64::from(k) / 100.0])))
        })
        .fold(f64::INFINITY, f64::min);
    for method in METHODS {
        let (best, ..) = found(method, &half, &[0.1, 0.9, 0.2], 1000, 3);
        assert!(best.cost < 1.2 * least + 1e-3, "{method:?}: {} instead of {least}", best.cost);
    }
}

/// A narrow well in a plain gives neither of them a hint: where methods fail.
#[test]
fn a_well_without_a_slope_around_it_is_missed() {
    let well = |x: &DVector<f64>| if (x - point(&[0.81, 0.17, 0.33])).norm() < 0.02 { 0.0 } else { 1.0 };
    for method in METHODS {
        assert_eq!(found(method, &well, &[0.5, 0.5, 0.5], 300, 1).0.cost, 1.0, "{method:?}");
    }
}

/// Many wells, each as wide as a stencil of a size in between: difference gradients end in one that is not the deepest.
#[test]
fn one_of_many_wells_holds_implicit_filtering() {
    let wells = |x: &DVector<f64>| {
        let d = x - point(&[0.83, 0.71]);
        0.5 * d.norm_squared() - d.map(|d| (TAU * 7.0 * d).cos()).sum()
    };
    let held = (0..8).filter(|&k| {
        let start = [0.05 + 0.03 * f64::from(k), 0.3 - 0.02 * f64::from(k)];
        let (best, ending, _) = found(Optimizer::ImplicitFiltering, &wells, &start, 600, 1);
        assert_eq!(ending, Ending::Converged);
        (best.point - point(&[0.83, 0.71])).norm() > 0.1
    });
    assert!(held.count() >= 4);
}

#[test]
fn no_more_evaluations_than_allowed_and_the_same_ones_each_time() {
    for method in [Optimizer::ImplicitFiltering, Optimizer::CmaEs, Optimizer::Random] {
        for most in [1, 7, 30] {
            let (first, ending, count) = found(method, &bowl, &[0.1, 0.9, 0.2], most, 9);
            assert!(count <= most && ending == Ending::OutOfEvaluations);
            assert_eq!(found(method, &bowl, &[0.1, 0.9, 0.2], most, 9).0, first);
        }
    }
    let drawn = |seed| found(Optimizer::CmaEs, &bowl, &[0.1, 0.9, 0.2], 30, seed).0;
    assert_ne!(drawn(1), drawn(2));
}

/// An affine change of the axes is learned: 1e4 between the curvatures of turned axes is no more than a few times as hard as none.
#[test]
fn cma_es_learns_the_shape_of_a_valley() {
    let steep = |x: &DVector<f64>| {
        let d = x - point(&[0.45, 0.6, 0.5, 0.4]);
        let turned = [d[0] + d[1], d[0] - d[1], d[2] + d[3], d[2] - d[3]];
        turned.iter().zip([1.0, 1e2, 1e3, 1e4]).map(|(t, c)| c * t * t).sum::<f64>()
    };
    for seed in 1..=5 {
        let (best, ending, count) = found(Optimizer::CmaEs, &steep, &[0.2, 0.8, 0.3, 0.7], 2000, seed);
        assert!(best.cost < 1e-4 && ending == Ending::Converged, "{} after {count}", best.cost);
    }
}
