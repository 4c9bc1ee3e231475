//! Sine and cosine of many angles at once.
//!
//! The system's `sincos` takes as long as a fifth of the inverse dynamics, and gives other last bits on other
//! processors, so that logs would differ between machines. This one has no branches, so that the compiler works on two
//! angles at a time, and uses only additions and multiplications in fixed order.
//!
//! x = n pi/2 + r with |r| <= pi/4, sine and cosine of r by Taylor's series, whose first neglected terms, r^19/19! and
//! r^18/18!, are below 2e-18. pi/2 is the sum of three numbers of which the first two have 33 bits, so that their
//! products with n < 2^20 are exact.

/// \[rad\] Beyond this angle n has too many bits and the standard library takes over.
const RANGE: f64 = 1e6;

const HALF_PI: [f64; 3] = [1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21];
const TWO_OVER_PI: f64 = std::f64::consts::FRAC_2_PI;

/// Adding and subtracting it rounds to an integer, whose last bits are then those of the sum.
const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52

/// Sine and cosine of every angle \[rad\]; the slices have one length.
#[inline]
pub(crate) fn sin_cos(angles: &[f64], sin: &mut [f64], cos: &mut [f64]) {
    if angles.iter().fold(0.0, |m: f64, x| m.max(x.abs())) > RANGE {
        for ((x, s), c) in angles.iter().zip(sin).zip(cos) {
            (*s, *c) = x.sin_cos();
        }
        return;
    }
    for ((x, s), c) in angles.iter().zip(sin).zip(cos) {
        (*s, *c) = reduced(*x);
    }
}

#[inline(always)]
fn reduced(x: f64) -> (f64, f64) {
    let shifted = x * TWO_OVER_PI + ROUND;
    let n = shifted - ROUND;
    let r = ((x - n * HALF_PI[0]) - n * HALF_PI[1]) - n * HALF_PI[2];
    let (s, c) = (sine(r), cosine(r));
    // Quarter turns: odd n swaps the two; bit 1 of n turns the sine's sign, of n + 1 the cosine's.
    let k = shifted.to_bits();
    let swap = (k & 1).wrapping_neg();
    let (sb, cb) = (s.to_bits(), c.to_bits());
    let differ = (sb ^ cb) & swap;
    let sin = (sb ^ differ) ^ ((k & 2) << 62);
    let cos = (cb ^ differ) ^ ((k.wrapping_add(1) & 2) << 62);
    (f64::from_bits(sin), f64::from_bits(cos))
}

/// sin r = r - r^3/3! + ... + r^17/17!
#[inline(always)]
fn sine(r: f64) -> f64 {
    const K: [f64; 8] = [
        -1.0 / 6.0,
        1.0 / 120.0,
        -1.0 / 5_040.0,
        1.0 / 362_880.0,
        -1.0 / 39_916_800.0,
        1.0 / 6_227_020_800.0,
        -1.0 / 1_307_674_368_000.0,
        1.0 / 355_687_428_096_000.0,
    ];
    let z = r * r;
    r + r * z * series(&K, z)
}

/// cos r = 1 - r^2/2! + ... + r^16/16!; the rounding error of 1 - z/2 is put back.
#[inline(always)]
fn cosine(r: f64) -> f64 {
    const K: [f64; 7] = [
        1.0 / 24.0,
        -1.0 / 720.0,
        1.0 / 40_320.0,
        -1.0 / 3_628_800.0,
        1.0 / 479_001_600.0,
        -1.0 / 87_178_291_200.0,
        1.0 / 20_922_789_888_000.0,
    ];
    let z = r * r;
    let half = 0.5 * z;
    let w = 1.0 - half;
    w + (((1.0 - w) - half) + z * z * series(&K, z))
}

/// Horner's scheme.
#[inline(always)]
fn series<const N: usize>(k: &[f64; N], z: f64) -> f64 {
    let mut sum = k[N - 1];
    for i in (0..N - 1).rev() {
        sum = sum * z + k[i];
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::sin_cos;

    /// Largest error against the system's library, in units of the last place of 1.
    fn worst(angles: &[f64]) -> f64 {
        let (mut s, mut c) = (vec![0.0; angles.len()], vec![0.0; angles.len()]);
        sin_cos(angles, &mut s, &mut c);
        let mut worst = 0.0_f64;
        for (k, x) in angles.iter().enumerate() {
            worst = worst.max((s[k] - x.sin()).abs()).max((c[k] - x.cos()).abs());
        }
        worst / f64::EPSILON
    }

    #[test]
    fn agrees_with_the_standard_library() {
        let grid =
            |range: f64| (0..200_001).map(|k| range * (k as f64 / 100_000.0 - 1.0)).collect::<Vec<_>>();
        for range in [1e-300, 1e-8, 0.1, 4.0, 100.0, 1e4, 1e6] {
            assert!(worst(&grid(range)) <= 1.0, "range {range}: {}", worst(&grid(range)));
        }
        assert_eq!(worst(&grid(1e9)), 0.0);
    }

    #[test]
    fn keeps_small_angles_and_quarter_turns() {
        let (mut s, mut c) = ([0.0; 4], [0.0; 4]);
        sin_cos(&[1e-30, std::f64::consts::FRAC_PI_2, std::f64::consts::PI, 0.0], &mut s, &mut c);
        assert_eq!((s[0], s[3], c[3]), (1e-30, 0.0, 1.0));
        assert!((c[1] - 6.123233995736766e-17).abs() < 1e-25);
        assert!((s[2] - 1.2246467991473532e-16).abs() < 1e-25);
    }

    #[test]
    fn what_is_no_number_stays_none() {
        let (mut s, mut c) = ([0.0; 3], [0.0; 3]);
        sin_cos(&[f64::NAN, 0.5, f64::INFINITY], &mut s, &mut c);
        assert!(s[0].is_nan() && c[0].is_nan() && s[2].is_nan() && c[2].is_nan());
        sin_cos(&[f64::NAN, 0.5, 1.0], &mut s, &mut c);
        assert!(s[0].is_nan() && (s[1] - 0.5_f64.sin()).abs() < 1e-15);
    }
}
