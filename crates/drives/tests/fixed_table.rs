//! Fixed-point tables against the linkage itself and against the table in floating point: order two down to the predicted
//! rounding, ends of ranges, and nothing beyond them.

use crate::linkages;
use drives::fixed_table::{FixedTable, OutOfTable, Reading, whole_angle};
use drives::lookup::LookupTable;
use drives::{Ankle, AnkleGeometry, OutOfDomain, Transmission};
use proptest::prelude::*;

const KNEE: [[f64; 2]; 3] = [[-0.07, 2.09], [0.0; 2], [0.0; 2]];
const ANKLE: [[f64; 2]; 3] = [[-0.07, 2.09], [-0.41, 0.41], [-0.85, 0.76]];
/// \[rad\] What 1 is in a joint angle.
const UNIT: f64 = 1.0 / (1u64 << 29) as f64;

fn linkages() -> [(Transmission, [[f64; 2]; 3]); 3] {
    let ankle = |share| Transmission::Ankle(linkages::ankle(share));
    [(linkages::knee(1.0), KNEE), (ankle(1.0), ANKLE), (ankle(-1.0), ANKLE)]
}

/// Joint angles over the ranges as whole numbers, ends included, which share no cell with a table.
fn places(joints: usize, ranges: [[f64; 2]; 3]) -> Vec<[i32; 3]> {
    let fine = if joints == 3 { 97 } else { 9973 };
    let at = |k: usize, i: usize| {
        let [lo, hi] = ranges[k];
        whole_angle(lo + (hi - lo) * i as f64 / fine as f64).unwrap()
    };
    let second = if joints == 3 { fine } else { 0 };
    let all = (0..=fine).flat_map(|i| (0..=second).map(move |j| (i, j)));
    all.map(|(i, j)| if joints == 3 { [at(0, i * 31 % fine), at(1, i), at(2, j)] } else { [at(0, i), 0, 0] })
        .collect()
}

/// Largest errors of motor angle \[rad\] and ratios \[1\].
fn errors(transmission: &Transmission, ranges: [[f64; 2]; 3], table: &FixedTable) -> [f64; 2] {
    let units = table.ratio_units();
    let mut worst = [0.0_f64; 2];
    for q in places(transmission.joints(), ranges) {
        let exact = transmission.at(q.map(|q| f64::from(q) * UNIT), [0.0; 3]).unwrap();
        let Reading { angle, ratio } = table.at(q).unwrap();
        worst[0] = worst[0].max((f64::from(angle) * table.angle_unit() - exact.angle).abs());
        let missed = (0..3).map(|k| (f64::from(ratio[k]) * units[k] - exact.ratio[k]).abs());
        worst[1] = missed.fold(worst[1], f64::max);
    }
    worst
}

fn table(transmission: &Transmission, ranges: [[f64; 2]; 3], points: usize) -> FixedTable {
    FixedTable::new(transmission, ranges, [points; 2]).unwrap()
}

#[test]
fn order_two() {
    for (transmission, ranges) in linkages() {
        let [coarse, fine] =
            [17, 65].map(|n| errors(&transmission, ranges, &table(&transmission, ranges, n)));
        for k in 0..2 {
            let order = (coarse[k] / fine[k]).ln() / 4.0_f64.ln();
            assert!((order - 2.0).abs() < 0.15, "order {order}: {coarse:?}, {fine:?}");
        }
    }
}

/// At most the sum of h²/8 times the second derivatives, and hardly less for the knee, where the worst place is met.
#[test]
fn error_of_the_angle_is_the_predicted_one() {
    for (transmission, ranges) in linkages() {
        let ankle = transmission.joints() == 3;
        let dimensions: &[usize] = if ankle { &[1, 2] } else { &[0] };
        for points in [9, 33] {
            let predicted: f64 = dimensions
                .iter()
                .map(|&k| {
                    let h = (ranges[k][1] - ranges[k][0]) / (points - 1) as f64;
                    let speed = [0, 1, 2].map(|i| if i == k { 1.0 } else { 0.0 });
                    let bend = |q: [i32; 3]| {
                        let q = q.map(|q| f64::from(q) * UNIT);
                        transmission.at(q, speed).unwrap().bias.abs()
                    };
                    h * h / 8.0
                        * places(transmission.joints(), ranges).into_iter().map(bend).fold(0.0, f64::max)
                })
                .sum();
            let [angle, _] = errors(&transmission, ranges, &table(&transmission, ranges, points));
            assert!(angle < 1.001 * predicted, "{points} points: {angle} rad, predicted {predicted}");
            assert!(angle > if ankle { 0.3 } else { 0.8 } * predicted, "{points}: {angle}, {predicted}");
        }
    }
}

/// A table so fine that interpolation errs less than rounding: what is left is at most what was predicted, and a good part
/// of it.
#[test]
fn ends_at_the_predicted_rounding() {
    let knee = linkages::knee(1.0);
    let table = table(&knee, KNEE, 1 << 17);
    let [angle, _] = errors(&knee, KNEE, &table);
    let floor = table.rounding();
    assert!(floor < 2.0 * table.angle_unit() && table.angle_unit() < 1e-7, "{floor}");
    assert!(angle < 1.05 * floor && angle > 0.5 * floor, "{angle} rad, predicted {floor}");
}

/// All 31 bits are used, whatever the linkage.
#[test]
fn scales_use_the_bits() {
    for (transmission, ranges) in linkages() {
        let table = table(&transmission, ranges, 33);
        let largest = |of: &dyn Fn(Reading) -> i32| {
            let all = places(transmission.joints(), ranges).into_iter();
            all.map(|q| of(table.at(q).unwrap()).unsigned_abs()).max().unwrap()
        };
        // The knee's share is added to the angle, so that both together may stay one bit below.
        let angle = largest(&|r| r.angle);
        assert!(angle > 1 << 28, "{angle}");
        let joints = transmission.joints();
        for k in if joints == 3 { 1..3 } else { 0..1 } {
            let ratio = largest(&|r| r.ratio[k]);
            assert!(ratio > 1 << 29, "{k}: {ratio}");
        }
    }
}

/// With the same points, the table in floating point says the same but for rounding and the place of the grid.
#[test]
fn agrees_with_floating_point() {
    for (transmission, ranges) in linkages() {
        let joints = transmission.joints();
        let pair = if joints == 3 { [ranges[1], ranges[2]] } else { [ranges[0]; 2] };
        let (fixed, real) =
            (table(&transmission, ranges, 33), LookupTable::new(&transmission, pair, [33; 2]).unwrap());
        let inside = places(joints, ranges.map(|[lo, hi]| [lo + 1e-6, hi - 1e-6]));
        for q in inside.into_iter().map(|q| q.map(|q| f64::from(q) * UNIT)) {
            let ((angle, ratio), (wanted, ratios)) = (fixed.at_angles(q).unwrap(), real.at(q).unwrap());
            assert!((angle - wanted).abs() < 2e-6, "{q:?}: {angle}, {wanted}");
            assert!((0..3).all(|k| (ratio[k] - ratios[k]).abs() < 1e-6), "{q:?}: {ratio:?}, {ratios:?}");
        }
    }
}

/// Both ends are inside, and a unit beyond is not; the grid may end up to a unit per cell later.
#[test]
fn ends_of_the_ranges() {
    let knee = linkages::knee(1.0);
    let knees = table(&knee, KNEE, 9);
    let [lo, hi] = KNEE[0].map(|q| (q / UNIT) as i32);
    for q in [lo, hi] {
        let exact = knee.at([f64::from(q) * UNIT, 0.0, 0.0], [0.0; 3]).unwrap();
        let found = knees.at([q, i32::MAX, i32::MIN]).unwrap(); // joints that it does not have are not read
        assert!((f64::from(found.angle) * knees.angle_unit() - exact.angle).abs() < 1e-6);
    }
    for q in [lo - 2, hi + 9, i32::MIN, i32::MAX] {
        assert_eq!(knees.at([q, 0, 0]), Err(OutOfTable::Beyond { joint: 0, angle: q }));
    }
    let ankles = table(&Transmission::Ankle(linkages::ankle(1.0)), ANKLE, 9);
    for extreme in [i32::MIN, i32::MAX] {
        assert_eq!(ankles.at([0, extreme, 0]), Err(OutOfTable::Beyond { joint: 1, angle: extreme }));
        assert_eq!(ankles.at([0, 0, extreme]), Err(OutOfTable::Beyond { joint: 2, angle: extreme }));
    }
    for word in ["joint 2", "4.0000 rad", "outside of the look-up table"] {
        assert!(ankles.at([0, 0, i32::MAX]).unwrap_err().to_string().contains(word));
    }
}

/// A knee outside of its range is right as long as the sum fits, and is told when it does not: nothing wraps.
#[test]
fn overflow_is_told() {
    let outer = Ankle::new(&AnkleGeometry { knee_share: 60.0, ..*linkages::ankle(-1.0).geometry() }).unwrap();
    let narrow = [[-0.1, 0.1], ANKLE[1], ANKLE[2]];
    let (table, exact) = (table(&Transmission::Ankle(outer), narrow, 9), Transmission::Ankle(outer));
    let (mut told, mut fitted) = (0, 0);
    for (x, y) in [(-0.41, -0.85), (0.41, 0.76), (-0.41, 0.76), (0.0, 0.0), (0.41, -0.85)] {
        for knee in [i32::MIN, -(1 << 30), 1 << 30, i32::MAX] {
            let q = [knee, whole_angle(x).unwrap(), whole_angle(y).unwrap()];
            let wanted = exact.at(q.map(|q| f64::from(q) * UNIT), [0.0; 3]).unwrap().angle;
            let fits = (wanted / table.angle_unit()).abs() < f64::from(i32::MAX);
            match table.at(q) {
                Ok(found) => {
                    assert!((f64::from(found.angle) * table.angle_unit() - wanted).abs() < 0.5, "{q:?}");
                    fitted += 1;
                }
                Err(refused) => {
                    assert!(!fits && matches!(refused, OutOfTable::Overflow { .. }), "{q:?}: {refused}");
                    told += 1;
                }
            }
        }
    }
    assert!(told > 0 && fitted > 0, "{told} told, {fitted} fitted");
}

#[test]
fn what_is_no_angle() {
    let knee = linkages::knee(1.0);
    let table = table(&knee, KNEE, 17);
    assert_eq!(table.at_angles([f64::NAN, 0.0, 0.0]), Err(OutOfDomain::NotFinite));
    assert_eq!(table.at_angles([f64::INFINITY, 0.0, 0.0]), Err(OutOfDomain::NotFinite));
    assert_eq!(table.at_angles([4.5, 0.0, 0.0]), Err(OutOfDomain::Table { angle: 4.5 }));
    assert_eq!(table.at_angles([2.2, 0.0, 0.0]), Err(OutOfDomain::Table { angle: 2.2 }));
    assert!(table.at_angles([1.0, f64::NAN, f64::NAN]).is_ok(), "a knee has one joint");
    assert_eq!(whole_angle(-4.0), Ok(i32::MIN));
    assert!(whole_angle(4.0).is_err());
}

#[test]
fn tables_that_cannot_be() {
    let knee = linkages::knee(1.0);
    let made = |range: [f64; 2], points: usize| {
        FixedTable::new(&knee, [range, [0.0; 2], [0.0; 2]], [points; 2]).map(|t| t.bytes())
    };
    assert_eq!(made([0.0, 1.0], 9), Ok(9 * 8));
    assert_eq!(made([0.0, 1.0], 0), Ok(2 * 8), "two points at least");
    assert!(matches!(made([0.0, 3.1], 9), Err(OutOfDomain::Lever { .. })), "beyond its dead point");
    assert_eq!(made([1.0, 0.0], 9), Err(OutOfDomain::Table { angle: 0.0 }));
    assert_eq!(made([0.0, 5.0], 9), Err(OutOfDomain::Table { angle: 5.0 }));
    assert_eq!(made([0.0, f64::NAN], 9), Err(OutOfDomain::NotFinite));
    assert_eq!(made([0.0, 10.0 * UNIT], 17), Err(OutOfDomain::Table { angle: 10.0 * UNIT }));
    assert_eq!(table(&Transmission::Ankle(linkages::ankle(1.0)), ANKLE, 9).bytes(), 81 * 12);
}

proptest! {
    /// Any three integers: an answer near the linkage's own, or a refusal.
    #[test]
    fn any_integers(q in any::<[i32; 3]>(), near in any::<[i32; 3]>()) {
        let ankle = Transmission::Ankle(linkages::ankle(1.0));
        let table = table(&ankle, ANKLE, 33);
        for q in [q, [q[0], near[1] >> 3, near[2] >> 3]] {
            let exact = ankle.at(q.map(|q| f64::from(q) * UNIT), [0.0; 3]);
            if let Ok(found) = table.at(q) {
                let wanted = exact.unwrap().angle;
                prop_assert!((f64::from(found.angle) * table.angle_unit() - wanted).abs() < 0.1);
            }
        }
    }

    /// From one joint angle to the next the motor's angle never jumps, also not between two cells.
    #[test]
    fn nothing_jumps(at in -37_000_000_i32..1_122_000_000, points in 2_usize..300) {
        let knee = linkages::knee(1.0);
        let table = table(&knee, KNEE, points);
        let [a, b] = [at, at + 1].map(|q| table.at([q, 0, 0]).unwrap());
        let slope = f64::from(a.ratio[0].abs().max(b.ratio[0].abs())) * table.ratio_units()[0];
        let most = slope * UNIT / table.angle_unit() + 2.0;
        prop_assert!(f64::from(a.angle.abs_diff(b.angle)) < 2.0 * most, "{} {}", a.angle, b.angle);
    }
}
