//! Quintics of least acceleration (4.30): vectors of errata 2.5, an integral, optimality, refusals.

use curves::{Path, Sample, hessian, least_acceleration};

fn sample([p, v, a]: [f64; 3]) -> Sample<1> {
    Sample { position: [p], velocity: [v], acceleration: [a] }
}

/// 1/2 int p''^2 of the quintics through `knots`, by Simpson's rule.
fn cost<const K: usize>(times: &[f64; K], knots: &[Sample<1>; K]) -> f64 {
    let mut path = Path::<1, 8>::resting(times[0], [0.0]);
    for k in 1..K {
        assert!(path.push(&knots[k - 1], &knots[k], times[k]));
    }
    let mut sum = 0.0;
    for k in 1..K {
        let n = 2000;
        let h = (times[k] - times[k - 1]) / f64::from(n);
        for i in 0..=n {
            let weight = if i == 0 || i == n {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            };
            // A path is read from the left: just inside of its last knot.
            let t = (times[k - 1] + f64::from(i) * h).clamp(times[k - 1] + 1e-13, times[k] - 1e-13);
            sum += weight * h / 3.0 * path.sample(t).acceleration[0].powi(2);
        }
    }
    0.5 * sum
}

#[test]
fn hessian_is_that_of_the_integral() {
    let (h, ends) = (0.37, [[0.3, -0.2, 1.1], [-0.4, 0.9, 0.7]]);
    let x = [ends[0], ends[1]].concat();
    let m = hessian(h);
    let form: f64 =
        (0..6).flat_map(|i| (0..6).map(move |j| (i, j))).map(|(i, j)| 0.5 * x[i] * m[i][j] * x[j]).sum();
    let integral = cost(&[0.0, h], &ends.map(sample));
    assert!((form - integral).abs() < 1e-9 * integral, "{form} and {integral}");
    // Rest and steady motion cost nothing: rank 4.
    for still in [[1.0, 0.0, 0.0, 1.0, 0.0, 0.0], [0.0, 1.0, 0.0, h, 1.0, 0.0]] {
        for row in m {
            let sum: f64 = row.iter().zip(still).map(|(a, b)| a * b).sum();
            assert!(sum.abs() < 1e-9);
        }
    }
}

#[test]
fn vector_of_errata_2_5() {
    let times = [0.0, 0.25, 0.6];
    let rest = [Some(0.0); 3];
    let knots = least_acceleration(&times, &[rest, [Some(0.7), None, None], rest]).expect("well posed");
    assert!((knots[1].velocity[0] - 1.25).abs() < 1e-9);
    assert!((knots[1].acceleration[0] + 40.0).abs() < 1e-9);
    assert!((cost(&times, &knots) - 296.228571429).abs() < 1e-6);
}

#[test]
fn every_other_choice_costs_more() {
    let times = [0.1, 0.3, 0.75, 0.9];
    let free = [None; 3];
    let given =
        [[Some(0.2), Some(-1.0), Some(3.0)], [Some(0.7), None, None], free, [Some(0.0), None, Some(0.0)]];
    let knots = least_acceleration(&times, &given).expect("well posed");
    let least = cost(&times, &knots);
    for (k, row) in given.iter().enumerate() {
        for (j, value) in row.iter().enumerate() {
            if let Some(value) = value {
                assert_eq!([knots[k].position, knots[k].velocity, knots[k].acceleration][j][0], *value);
                continue;
            }
            for by in [-1e-2, 1e-2] {
                let mut other = knots;
                [&mut other[k].position, &mut other[k].velocity, &mut other[k].acceleration][j][0] += by;
                assert!(cost(&times, &other) > least);
            }
        }
    }
}

#[test]
fn too_little_given_and_times_that_do_not_ascend_are_refused() {
    let free = [None; 3];
    let position = [Some(1.0), None, None];
    assert!(least_acceleration(&[0.0, 1.0], &[free, free]).is_none());
    assert!(least_acceleration(&[0.0, 1.0], &[position, free]).is_none(), "any steady motion would do");
    assert!(least_acceleration(&[0.0, 1.0], &[position, position]).is_some());
    assert!(least_acceleration(&[0.0, 0.0], &[position, position]).is_none());
    assert!(least_acceleration(&[0.0, f64::NAN], &[position, position]).is_none());
}
