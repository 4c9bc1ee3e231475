//! Where something ends, and how fast it grows: one bisection and one slope for all studies.

use std::fmt;

/// The ends of a bisection do not differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NoBorder {
    /// The end that is not as it must be.
    pub end: f64,
    /// Whether it holds there.
    pub holds: bool,
}

impl fmt::Display for NoBorder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = if self.holds { "still holds" } else { "does not hold" };
        write!(f, "no border between the ends of the search: it {what} at {}", self.end)
    }
}

impl std::error::Error for NoBorder {}

impl From<NoBorder> for String {
    fn from(none: NoBorder) -> Self {
        none.to_string()
    }
}

/// How narrow the bracket of a bisection becomes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Width {
    /// In the unit of what is searched.
    Absolute(f64),
    /// As a share of its upper end.
    Share(f64),
    /// No number lies between the ends.
    Exact,
}

/// Border between `good`, where `holds`, and `bad`, where it does not: the last value on either side.
///
/// # Errors
/// It does not hold at `good` or does at `bad`, or `holds` fails.
pub(crate) fn border<E: From<NoBorder>>(
    [mut good, mut bad]: [f64; 2],
    width: Width,
    mut holds: impl FnMut(f64) -> Result<bool, E>,
) -> Result<[f64; 2], E> {
    for (end, wanted) in [(good, true), (bad, false)] {
        if holds(end)? != wanted {
            return Err(NoBorder { end, holds: !wanted }.into());
        }
    }
    loop {
        let middle = 0.5 * (good + bad);
        let wide = match width {
            Width::Absolute(most) => (bad - good).abs() > most,
            Width::Share(most) => (bad - good).abs() > most * bad.max(good),
            Width::Exact => true,
        };
        if !wide || middle == good || middle == bad {
            return Ok([good, bad]);
        }
        *(if holds(middle)? { &mut good } else { &mut bad }) = middle;
    }
}

/// Middle of the last bracket about the [`border`].
///
/// # Errors
/// As there.
pub(crate) fn middle<E: From<NoBorder>>(
    ends: [f64; 2],
    width: Width,
    holds: impl FnMut(f64) -> Result<bool, E>,
) -> Result<f64, E> {
    border(ends, width, holds).map(|[good, bad]| 0.5 * (good + bad))
}

/// Slope of log y over log x by least squares; NaN of fewer than two points.
pub(crate) fn slope(points: &[[f64; 2]]) -> f64 {
    let logs: Vec<[f64; 2]> = points.iter().map(|p| p.map(f64::ln)).collect();
    let n = logs.len() as f64;
    let mean: [f64; 2] = std::array::from_fn(|k| logs.iter().map(|p| p[k]).sum::<f64>() / n);
    let sum = |k: usize| logs.iter().map(|p| (p[0] - mean[0]) * (p[k] - mean[k])).sum::<f64>();
    sum(1) / sum(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edge(ends: [f64; 2], width: Width, at: f64) -> Result<[f64; 2], NoBorder> {
        border(ends, width, |x| Ok(x < at))
    }

    #[test]
    fn bisection_ends_on_both_sides_of_the_border() {
        let [good, bad] = edge([0.0, 128.0], Width::Absolute(0.25), 17.3).unwrap();
        assert!(good < 17.3 && bad >= 17.3 && bad - good <= 0.25, "{good} {bad}");
        let [good, bad] = edge([0.0, 128.0], Width::Exact, 17.3).unwrap();
        assert_eq!((good.next_up(), bad), (bad, 17.3));
        let [good, bad] = border([1.0, -1.0], Width::Exact, |x| Ok::<_, NoBorder>(x > 0.25)).unwrap();
        assert_eq!((bad, good), (0.25, 0.25f64.next_up()));
    }

    #[test]
    fn ends_that_do_not_differ_are_an_error() {
        let never = edge([1.0, 2.0], Width::Exact, 0.5).unwrap_err();
        assert_eq!(never, NoBorder { end: 1.0, holds: false });
        assert_eq!(edge([1.0, 2.0], Width::Exact, 9.0), Err(NoBorder { end: 2.0, holds: true }));
    }

    #[test]
    fn slope_of_a_power_is_its_exponent() {
        let points = [1e-3, 2e-3, 5e-3, 1e-2].map(|h: f64| [h, 7.0 * h.powf(2.5)]);
        assert!((slope(&points) - 2.5).abs() < 1e-12);
        assert!(slope(&points[..1]).is_nan() && slope(&[]).is_nan());
    }
}
