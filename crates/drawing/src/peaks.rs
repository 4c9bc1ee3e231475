//! Peaks that are far outside of what a line does: they do not set the scale, and are not lost.

use crate::canvas::{Anchor, Canvas, Letters};
use crate::chart::{PlotView, Point, TICK};
use crate::color::Color;

/// Share of the values that a scale need not show, at each end.
const RARE: f64 = 0.005;
/// Room beyond the others, as a share of their range, before a value counts as a peak.
const ROOM: f64 = 0.5;
/// \[pixels\] Distance of two values that are written at the same edge.
const APART: f32 = 150.0;

/// The part of the range `all` that is shown of these values; all of it, unless some are far from the rest.
pub(crate) fn cut(all: [f64; 2], mut values: Vec<f64>, least: f64) -> [f64; 2] {
    if values.is_empty() {
        return all;
    }
    values.sort_by(f64::total_cmp);
    let rare = (RARE * values.len() as f64) as usize;
    let (low, high) = (values[rare], values[values.len() - 1 - rare]);
    let room = ROOM * (high - low).max(least);
    [all[0].max(low - room), all[1].min(high + room)]
}

/// Marks each stretch of a line beyond the axes with a triangle at the edge and the value furthest out, where there is
/// room for it.
pub(crate) fn draw<'a>(
    canvas: &mut Canvas,
    view: &PlotView,
    lines: impl Iterator<Item = (&'a [Point], Color)>,
) {
    let [low, high] = view.ranges[1];
    let mut written = [f32::NEG_INFINITY; 2];
    for (points, color) in lines {
        let side = |p: &Point| {
            if p[1] > high {
                1
            } else if p[1] < low {
                -1
            } else {
                0
            }
        };
        for stretch in points.chunk_by(|a, b| side(a) == side(b)).filter(|stretch| side(&stretch[0]) != 0) {
            // One triangle at the edge, where the stretch is furthest out.
            let up = side(&stretch[0]) > 0;
            let out = |p: &&Point| if up { p[1] } else { -p[1] };
            let furthest = stretch.iter().max_by(|a, b| out(a).total_cmp(&out(b))).unwrap_or(&stretch[0]);
            let [x, edge] = view.place([furthest[0], if up { high } else { low }]);
            let inwards = if up { 1.0 } else { -1.0 };
            let base = edge + inwards * 13.0;
            canvas.fill(&[[x, edge + inwards * 2.0], [x - 7.0, base], [x + 7.0, base]], color);
            // Its value beside it, unless another one stands too near at the same edge.
            let last = &mut written[usize::from(up)];
            if x > *last + APART || x < *last - APART {
                *last = x;
                let text = format!("{} at {:.2}", short(furthest[1]), furthest[0]);
                let right = x + APART > view.pixels[1][0];
                let (at, anchor) = if right { (x - 12.0, Anchor::Right) } else { (x + 12.0, Anchor::Left) };
                let y = edge + inwards * if up { 20.0 } else { 6.0 };
                canvas.text([at, y], &text, Letters { color, ..TICK }, anchor);
            }
        }
    }
}

/// A number with three digits that count, or all before the point.
fn short(x: f64) -> String {
    let digits = (2 - x.abs().max(1e-9).log10().floor() as i32).clamp(0, 9) as usize;
    format!("{x:.digits$}").replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_does_not_set_the_scale_and_a_rhythm_does() {
        let walk = |n: usize| 300.0 + 300.0 * (n as f64 * 0.01).sin();
        let plain: Vec<f64> = (0..10_000).map(walk).collect();
        assert_eq!(cut([0.0, 600.0], plain.clone(), 10.0), [0.0, 600.0]);
        let mut spike = plain;
        spike[5] = 2066.0;
        let [low, high] = cut([0.0, 2066.0], spike, 10.0);
        assert!(low == 0.0 && (890.0..=910.0).contains(&high), "{low} {high}");
        assert_eq!(cut([0.0, 1.0], Vec::new(), 1.0), [0.0, 1.0]);
    }

    #[test]
    fn values_are_written_short() {
        assert_eq!([2066.4, -0.2174, 0.000_3].map(short), ["2066", "\u{2212}0.217", "0.000300"]);
    }
}
