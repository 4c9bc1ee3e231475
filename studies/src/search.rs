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

/// Windows of a rising grid in which `holds`: lower and upper border of each, none where the grid begins or ends inside.
///
/// # Errors
/// `holds` fails.
pub(crate) fn windows<E: From<NoBorder>>(
    grid: &[f64],
    width: Width,
    on_grid: &[bool],
    mut holds: impl FnMut(f64) -> Result<bool, E>,
) -> Result<Vec<[Option<f64>; 2]>, E> {
    let mut found = Vec::new();
    let mut low = None;
    for (ends, holding) in grid.windows(2).zip(on_grid.windows(2)) {
        match holding {
            [false, true] => low = Some(middle([ends[1], ends[0]], width, &mut holds)?),
            [true, false] => {
                let high = middle([ends[0], ends[1]], width, &mut holds)?;
                found.push([low.take(), Some(high)]);
            }
            _ => {}
        }
    }
    if on_grid.last() == Some(&true) {
        found.push([low, None]);
    }
    Ok(found)
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
    fn windows_have_both_borders_but_where_the_grid_ends() {
        let grid: Vec<f64> = (0..=20).map(|k| 0.5 * f64::from(k)).collect();
        let search = |holds: &dyn Fn(f64) -> bool| {
            let on_grid: Vec<bool> = grid.iter().map(|x| holds(*x)).collect();
            let found = windows(&grid, Width::Absolute(1e-9), &on_grid, |x| Ok::<_, NoBorder>(holds(x)));
            found.unwrap().iter().map(|w| w.map(|x| x.map(|x| (1e6 * x).round() / 1e6))).collect::<Vec<_>>()
        };
        assert_eq!(search(&|x| x < 3.3), [[None, Some(3.3)]]);
        assert_eq!(search(&|x| (1.2..3.3).contains(&x)), [[Some(1.2), Some(3.3)]]);
        assert_eq!(search(&|x| !(1.1..7.7).contains(&x)), [[None, Some(1.1)], [Some(7.7), None]]);
        assert_eq!(search(&|_| false), Vec::<[Option<f64>; 2]>::new());
        // What is narrower than the grid is not seen: the grid is part of the answer.
        assert_eq!(search(&|x| (3.1..3.4).contains(&x)), Vec::<[Option<f64>; 2]>::new());
    }

    #[test]
    fn slope_of_a_power_is_its_exponent() {
        let points = [1e-3, 2e-3, 5e-3, 1e-2].map(|h: f64| [h, 7.0 * h.powf(2.5)]);
        assert!((slope(&points) - 2.5).abs() < 1e-12);
        assert!(slope(&points[..1]).is_nan() && slope(&[]).is_nan());
    }
}
