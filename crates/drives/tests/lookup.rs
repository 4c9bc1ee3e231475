//! Look-up tables: the error falls with the square of the points, is the one that theory predicts, and ends at the edge.

use crate::linkages;
use drives::lookup::LookupTable;
use drives::{OutOfDomain, Transmission};

const KNEE: [[f64; 2]; 2] = [[-0.07, 2.09], [0.0; 2]];
const ANKLE: [[f64; 2]; 2] = [[-0.41, 0.41], [-0.85, 0.76]];

/// Largest errors of motor angle \[rad\] and ratios \[1\] over a grid that shares no cell with the table.
fn errors(transmission: &Transmission, ranges: [[f64; 2]; 2], points: usize) -> [f64; 2] {
    let table = LookupTable::new(transmission, ranges, [points; 2]).unwrap();
    let fine = 97;
    let at = |[lo, hi]: [f64; 2], i: usize| lo + (hi - lo) * i as f64 / fine as f64;
    let mut worst = [0.0_f64; 2];
    for (i, j) in (0..=fine).flat_map(|i| (0..=fine).map(move |j| (i, j))) {
        let (a, b) = (at(ranges[0], i), at(ranges[1], j));
        let q = if transmission.joints() == 3 { [0.7, a, b] } else { [a, 0.0, 0.0] };
        let (exact, (angle, ratio)) = (transmission.at(q, [0.0; 3]).unwrap(), table.at(q).unwrap());
        worst[0] = worst[0].max((angle - exact.angle).abs());
        let ratios = (0..3).map(|k| (ratio[k] - exact.ratio[k]).abs());
        worst[1] = ratios.fold(worst[1], f64::max);
    }
    worst
}

#[test]
fn order_two() {
    for (transmission, ranges) in
        [(linkages::knee(1.0), KNEE), (Transmission::Ankle(linkages::ankle(1.0)), ANKLE)]
    {
        let (coarse, fine) = (errors(&transmission, ranges, 17), errors(&transmission, ranges, 65));
        for k in 0..2 {
            let order = (coarse[k] / fine[k]).ln() / 4.0_f64.ln();
            assert!((order - 2.0).abs() < 0.15, "order {order}: {coarse:?}, {fine:?}");
        }
    }
}

/// Linear interpolation errs by up to h²/8 of the largest second derivative: of φ that is the bias at speed 1.
#[test]
fn error_of_the_angle_is_the_predicted_one() {
    let knee = linkages::knee(1.0);
    let bend = |i: usize| {
        let q = -0.07 + 2.16 * i as f64 / 200.0;
        knee.at([q, 0.0, 0.0], [1.0, 0.0, 0.0]).unwrap().bias.abs()
    };
    let most = (0..=200).map(bend).fold(0.0, f64::max);
    let h: f64 = 2.16 / 64.0;
    let [angle, _] = errors(&knee, KNEE, 65);
    let predicted = h * h / 8.0 * most;
    assert!(angle < 1.001 * predicted && angle > 0.8 * predicted, "{angle} rad instead of {predicted}");
}

#[test]
fn edges() {
    let ankle = Transmission::Ankle(linkages::ankle(-1.0));
    let table = LookupTable::new(&ankle, ANKLE, [9, 9]).unwrap();
    for q in [[0.0, -0.41, -0.85], [1.0, 0.41, 0.76], [-1.0, -0.41, 0.76]] {
        let (exact, (angle, ratio)) = (ankle.at(q, [0.0; 3]).unwrap(), table.at(q).unwrap());
        assert!((angle - exact.angle).abs() < 1e-9 && (ratio[2] - exact.ratio[2]).abs() < 1e-9);
    }
    assert_eq!(table.at([0.0, 0.42, 0.0]), Err(OutOfDomain::Table { angle: 0.42 }));
    assert_eq!(table.at([0.0, 0.0, f64::NAN]), Err(OutOfDomain::NotFinite));
    assert_eq!(table.size(), 243);
    assert!(LookupTable::new(&linkages::knee(1.0), [[0.0, 3.0], [0.0; 2]], [9, 1]).is_err());
}
