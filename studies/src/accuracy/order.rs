//! Orders of convergence.

use serde::Serialize;

/// How fast a method's error falls with its step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Order {
    /// Name of the chart.
    pub chart: String,
    /// The method.
    pub method: String,
    /// What theory says.
    pub predicted: f64,
    /// What was found; NaN of fewer than two points.
    pub measured: f64,
}

/// Slope of a straight line through (log step, log error), by least squares.
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(h, e)| (h.ln(), e.ln())).collect();
    let n = logs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let (above, below) = logs
        .iter()
        .fold((0.0, 0.0), |(above, below), p| (above + (p.0 - x) * (p.1 - y), below + (p.0 - x).powi(2)));
    above / below
}

/// A step as people write it.
pub fn in_ms(step: f64) -> String {
    let ms = step * 1e3;
    let digits = (2 - ms.log10().floor() as i32).max(0) as usize;
    let text = format!("{ms:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    format!("{text} ms")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slope_of_a_power_is_its_exponent() {
        let points = [1e-3, 2e-3, 5e-3, 1e-2].map(|h: f64| (h, 7.0 * h.powf(2.5)));
        assert!((slope(&points) - 2.5).abs() < 1e-12);
        assert!(slope(&points[..1]).is_nan() && slope(&[]).is_nan());
    }

    #[test]
    fn steps_are_written_without_needless_digits() {
        assert_eq!(
            [1e-3, 5e-5, 2e-2, 1.5625e-5, 0.1].map(in_ms),
            ["1 ms", "0.05 ms", "20 ms", "0.0156 ms", "100 ms"]
        );
    }
}
