//! Random numbers that are the same on every machine, and in every run with the same seed.
//!
//! Integers by xoshiro256++ (Blackman and Vigna), seeded by splitmix64; Gaussian numbers by Marsaglia's polar method.
//! Only operations that IEEE 754 rounds correctly are used: the logarithm of the system's library differs from machine
//! to machine in its last bit, so `ln` sums its own series.
//!
//! Each signal has its own stream: switching one error on does not change the noise of another.

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct Noise {
    state: [u64; 4],
    /// Second number of the last pair.
    spare: Option<f64>,
}

impl Noise {
    /// Stream number `stream` of `seed`.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut x = seed;
        let mut x = splitmix(&mut x) ^ stream;
        Self { state: std::array::from_fn(|_| splitmix(&mut x)), spare: None }
    }

    /// Next 64 bits.
    fn bits(&mut self) -> u64 {
        let s = &mut self.state;
        let result = s[0].wrapping_add(s[3]).rotate_left(23).wrapping_add(s[0]);
        let t = s[1] << 17;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= t;
        s[3] = s[3].rotate_left(45);
        result
    }

    /// Uniform in [-1, 1), a multiple of 2^-52.
    pub(crate) fn symmetric(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Gaussian, mean 0, standard deviation 1. At most 6.1 after about 10^9 numbers; never infinite.
    pub(crate) fn gaussian(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        loop {
            // Ends: 4 of 14 pairs fall outside of the circle, and no state of the generator repeats.
            let (u, v) = (self.symmetric(), self.symmetric());
            let s = u * u + v * v;
            if s > 0.0 && s < 1.0 {
                let r = (-2.0 * ln(s) / s).sqrt();
                self.spare = Some(v * r);
                return u * r;
            }
        }
    }
}

/// Steps the state and gives the next number of splitmix64.
fn splitmix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Natural logarithm of a normal positive number: ln(m 2^e) = e ln 2 + 2 artanh((m - 1) / (m + 1)).
fn ln(x: f64) -> f64 {
    let bits = x.to_bits();
    let (mut m, mut e) = (f64::from_bits(bits & !(0x7ff << 52) | 0x3ff << 52), (bits >> 52) as f64 - 1023.0);
    if m > std::f64::consts::SQRT_2 {
        (m, e) = (0.5 * m, e + 1.0);
    }
    let s = (m - 1.0) / (m + 1.0);
    // |s| <= 0.172: the term after these is below 1e-19
    let series = (0..12).rev().fold(0.0, |sum, k| sum * s * s + 1.0 / f64::from(2 * k + 1));
    e * std::f64::consts::LN_2 + 2.0 * s * series
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First numbers of the reference implementations.
    #[test]
    fn are_xoshiro_and_splitmix() {
        let mut noise = Noise { state: [1, 2, 3, 4], spare: None };
        let first: [u64; 4] = std::array::from_fn(|_| noise.bits());
        assert_eq!(first, [41_943_041, 58_720_359, 3_588_806_011_781_223, 3_591_011_842_654_386]);
        let mut state = 1_234_567;
        assert_eq!(splitmix(&mut state), 6_457_827_717_110_365_317);
        assert_eq!(splitmix(&mut state), 3_203_168_211_198_807_973);
    }

    #[test]
    fn logarithm_is_the_librarys_to_its_last_bits() {
        let mut noise = Noise::new(1, 0);
        for _ in 0..20_000 {
            let x = noise.symmetric().abs().powi(1 + (noise.bits() % 8) as i32);
            if x >= f64::MIN_POSITIVE {
                assert!((ln(x) - x.ln()).abs() <= 4.0 * f64::EPSILON * x.ln().abs().max(1e-3), "{x}");
            }
        }
    }

    /// Moments and tails of 400 000 numbers, within four standard errors of each.
    #[test]
    fn is_gaussian() {
        let n = 400_000;
        let mut noise = Noise::new(42, 7);
        let x: Vec<f64> = (0..n).map(|_| noise.gaussian()).collect();
        let mean = |f: &dyn Fn(f64) -> f64| x.iter().map(|x| f(*x)).sum::<f64>() / f64::from(n);
        let within = |value: f64, expected: f64, variance: f64| {
            let error = (variance / f64::from(n)).sqrt();
            assert!((value - expected).abs() < 4.0 * error, "{value}, not {expected} +- {error}");
        };
        within(mean(&|x| x), 0.0, 1.0);
        within(mean(&|x| x * x), 1.0, 2.0);
        within(mean(&|x| x * x * x), 0.0, 15.0);
        within(mean(&|x| x.powi(4)), 3.0, 96.0);
        for (limit, p) in [(1.0, 0.317_310_508), (2.0, 0.045_500_264), (3.0, 0.002_699_796)] {
            within(mean(&|x| f64::from(x.abs() > limit)), p, p * (1.0 - p));
        }
    }

    /// White: no correlation between neighbours, nor between streams, nor between seeds.
    #[test]
    fn streams_are_white_and_independent() {
        let n = 100_000;
        let row = |seed, stream| {
            let mut noise = Noise::new(seed, stream);
            (0..=n).map(|_| noise.gaussian()).collect::<Vec<f64>>()
        };
        let correlation = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / n as f64;
        let limit = 4.0 / (n as f64).sqrt();
        let x = row(1, 0);
        assert!(correlation(&x[..n], &x[1..]).abs() < limit);
        for other in [row(1, 1), row(2, 0), row(0, 1)] {
            assert!(correlation(&x, &other).abs() < limit);
        }
        assert_eq!(x, row(1, 0));
    }
}
