//! Orders of convergence.

use serde::{Deserialize, Serialize};

/// How fast a method's error falls with its step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConvergenceOrder {
    /// Name of the chart.
    pub chart: String,
    /// The method.
    pub method: String,
    /// What theory says.
    pub predicted: f64,
    /// What was found; NaN of fewer than two points.
    #[serde(deserialize_with = "super::nan_of_null")]
    pub measured: f64,
}

/// Largest step with which an explicit method is stable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StabilityLimit {
    /// Name of the chart.
    pub chart: String,
    /// The method.
    pub method: String,
    /// \[s\] By the eigenvalues of the linearised rates.
    pub step: f64,
}

/// A step as people write it.
pub(crate) fn in_ms(step: f64) -> String {
    let ms = step * 1e3;
    if ms < 5e-5 {
        return "0 ms".into();
    }
    let digits = (2 - ms.log10().floor() as i32).clamp(0, 4) as usize;
    let text = format!("{ms:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    format!("{text} ms")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_written_without_needless_digits() {
        assert_eq!(
            [1e-3, 5e-5, 2e-2, 1.5625e-5, 0.1, 0.0].map(in_ms),
            ["1 ms", "0.05 ms", "20 ms", "0.0156 ms", "100 ms", "0 ms"]
        );
    }
}
