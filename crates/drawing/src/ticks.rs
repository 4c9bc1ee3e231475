//! Ticks of an axis and their labels.

/// Round numbers 1, 2, 5 x 10^k inside of the range, about `wanted` of them, each with its text.
pub(crate) fn ticks(lo: f64, hi: f64, wanted: usize) -> Vec<(f64, String)> {
    let step = round_step((hi - lo) / wanted.max(1) as f64);
    if !(step > 0.0 && step.is_finite() && lo.is_finite()) {
        return Vec::new();
    }
    let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    let (first, last) = ((lo / step).ceil() as i64, (hi / step).floor() as i64);
    (first..=last.min(first + 100)).map(|k| (k as f64 * step, number(k as f64 * step, decimals))).collect()
}

/// Powers of ten inside of the range of exponents, at most about `wanted` of them, each with its text.
pub(crate) fn powers(lo: f64, hi: f64, wanted: usize) -> Vec<(f64, String)> {
    let every = ((hi - lo) / wanted.max(1) as f64).ceil().max(1.0);
    if !(every.is_finite() && lo.is_finite()) {
        return Vec::new();
    }
    let (first, last) = ((lo / every).ceil() as i64, (hi / every).floor() as i64);
    (first..=last.min(first + 100)).map(|k| (k as f64 * every, power(k * every as i64))).collect()
}

/// 10 to this power, in figures where that is short.
fn power(exponent: i64) -> String {
    match exponent {
        0..=4 => 10i64.pow(exponent as u32).to_string(),
        -3..=-1 => number(10f64.powi(exponent as i32), -exponent as usize),
        _ => format!("1e{}", number(exponent as f64, 0)),
    }
}

/// The one of 1, 2, 5 x 10^k that is nearest in proportion.
fn round_step(step: f64) -> f64 {
    let power = 10f64.powf(step.log10().floor());
    let factor = match step / power {
        f if f < 2f64.sqrt() => 1.0,
        f if f < 10f64.sqrt() => 2.0,
        f if f < 50f64.sqrt() => 5.0,
        _ => 10.0,
    };
    factor * power
}

/// With a true minus sign, and none before zero.
fn number(x: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", x.abs());
    let zero = text.bytes().all(|b| matches!(b, b'0' | b'.'));
    if x < 0.0 && !zero { format!("\u{2212}{text}") } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(lo: f64, hi: f64, wanted: usize) -> Vec<String> {
        ticks(lo, hi, wanted).into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn marks_are_round_and_inside() {
        assert_eq!(texts(-0.012, 0.021, 4), ["\u{2212}0.01", "0.00", "0.01", "0.02"]);
        assert_eq!(texts(0.0, 20.0, 10), ["0", "2", "4", "6", "8", "10", "12", "14", "16", "18", "20"]);
        assert_eq!(texts(120.0, 1130.0, 5), ["200", "400", "600", "800", "1000"]);
    }

    #[test]
    fn powers_of_ten_are_written_short() {
        let texts: Vec<String> = powers(-7.2, 5.9, 20).into_iter().map(|(_, text)| text).collect();
        let low = ["1e\u{2212}7", "1e\u{2212}6", "1e\u{2212}5", "1e\u{2212}4", "0.001", "0.01", "0.1"];
        assert_eq!(texts, [&low[..], &["1", "10", "100", "1000", "10000", "1e5"]].concat());
        assert_eq!(powers(-16.0, 0.0, 5).len(), 5);
    }

    #[test]
    fn ranges_that_are_none_have_no_marks() {
        for (lo, hi) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
            assert!(ticks(lo, hi, 5).is_empty(), "{lo} {hi}");
        }
    }
}
