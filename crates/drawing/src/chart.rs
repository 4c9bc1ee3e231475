//! One pair of axes with what is drawn between them.

use crate::canvas::{Anchor, Canvas, Letters, Pen, Pixel};
use crate::color::{BLACK, Color, GREY, LIGHT};
use crate::peaks;
use crate::text::{self, Weight};
use crate::ticks::{powers, ticks};

/// A point in the units of the axes.
pub type Point = [f64; 2];

/// Something drawn between the axes; later ones lie on top.
#[derive(Clone, Debug)]
enum Mark {
    Line { points: Vec<Point>, pen: Pen },
    Area { outline: Vec<Point>, fill: Color },
    Dots { points: Vec<Point>, radius: f32, color: Color },
    Note { at: Point, text: String, color: Color },
    Label { at: Point, text: String, color: Color },
}

#[derive(Clone, Copy, Debug)]
enum LegendKey {
    Line(Pen),
    Patch(Color),
    Dot(Color),
}

/// Axes with title, units, grid and legend.
#[derive(Clone, Debug)]
pub struct Chart {
    title: String,
    labels: [String; 2],
    marks: Vec<Mark>,
    legend: Vec<(String, LegendKey)>,
    equal: bool,
    logarithmic: bool,
    height: f32,
    least_height: f64,
    robust: bool,
}

const LEFT: f32 = 120.0;
const RIGHT: f32 = 36.0;
const TOP: f32 = 62.0;
const BOTTOM: f32 = 78.0;

const LABEL: Letters = Letters { color: BLACK, size: 21.0, weight: Weight::Regular };
pub(crate) const TICK: Letters = Letters { color: GREY, size: 19.0, weight: Weight::Regular };
const TITLE: Letters = Letters { color: BLACK, size: 22.0, weight: Weight::Bold };

impl Chart {
    /// An empty chart; labels say quantity and unit: `"time [s]"`.
    pub fn new(title: &str, x_label: &str, y_label: &str) -> Self {
        Self {
            title: title.into(),
            labels: [x_label.into(), y_label.into()],
            marks: Vec::new(),
            legend: Vec::new(),
            equal: false,
            logarithmic: false,
            height: 300.0,
            least_height: 0.0,
            robust: false,
        }
    }

    /// Height of the area between the axes, in pixels.
    pub fn height(mut self, pixels: f32) -> Self {
        self.height = pixels;
        self
    }

    /// The y axis covers at least this much, so that noise around zero does not fill the picture.
    pub fn at_least(mut self, y_units: f64) -> Self {
        self.least_height = y_units;
        self
    }

    /// The y axis shows what the lines do all but a hundredth of their time, and half as much again; peaks beyond are cut
    /// off, marked at the edge, and their values written there.
    pub fn robust(mut self) -> Self {
        self.robust = true;
        self
    }

    /// Its title, and whether nothing would be seen but the axes.
    pub(crate) fn emptiness(&self) -> (&str, bool) {
        let seen = |points: &[Point]| points.iter().any(|p| p[0].is_finite() && p[1].is_finite());
        let empty = !self.marks.iter().any(|mark| match mark {
            Mark::Line { points, .. } | Mark::Dots { points, .. } | Mark::Area { outline: points, .. } => {
                seen(points)
            }
            Mark::Note { .. } | Mark::Label { .. } => false,
        });
        (&self.title, empty)
    }

    /// Both axes in the same scale, for maps; the height follows from the data.
    pub fn equal(mut self) -> Self {
        self.equal = true;
        self
    }

    /// Both axes logarithmic; points that are not positive are left out.
    pub fn logarithmic(mut self) -> Self {
        self.logarithmic = true;
        self
    }

    /// A line; a point that is not finite is a gap.
    pub fn line(&mut self, name: &str, points: Vec<Point>, color: Color) -> &mut Self {
        self.styled(name, points, Pen { color, width: 2.5, dashed: false })
    }

    /// A dashed line.
    pub fn dashed(&mut self, name: &str, points: Vec<Point>, color: Color) -> &mut Self {
        self.styled(name, points, Pen { color, width: 2.5, dashed: true })
    }

    /// A line drawn with any pen.
    pub fn styled(&mut self, name: &str, points: Vec<Point>, pen: Pen) -> &mut Self {
        self.key(name, LegendKey::Line(pen));
        self.marks.push(Mark::Line { points, pen });
        self
    }

    /// A filled polygon.
    pub fn area(&mut self, name: &str, outline: Vec<Point>, fill: Color) -> &mut Self {
        self.key(name, LegendKey::Patch(fill));
        self.marks.push(Mark::Area { outline, fill });
        self
    }

    /// The stripe between two lines over the same x; where a bound is not finite there is a gap.
    pub fn band(&mut self, name: &str, x: &[f64], lo: &[f64], hi: &[f64], fill: Color) -> &mut Self {
        let whole = |i: &usize| lo[*i].is_finite() && hi[*i].is_finite();
        let all: Vec<usize> = (0..x.len()).collect();
        for run in all.split(|i| !whole(i)).filter(|run| !run.is_empty()) {
            let there = run.iter().map(|&i| [x[i], lo[i]]);
            let back = run.iter().rev().map(|&i| [x[i], hi[i]]);
            self.area(name, there.chain(back).collect(), fill);
        }
        self
    }

    /// Dots.
    pub fn dots(&mut self, name: &str, points: Vec<Point>, radius: f32, color: Color) -> &mut Self {
        self.key(name, LegendKey::Dot(color));
        self.marks.push(Mark::Dots { points, radius, color });
        self
    }

    /// A word beside a point.
    pub fn note(&mut self, at: Point, text: &str, color: Color) -> &mut Self {
        self.marks.push(Mark::Note { at, text: text.into(), color });
        self
    }

    /// Small words to the upper right of a point.
    pub fn label(&mut self, at: Point, text: &str, color: Color) -> &mut Self {
        self.marks.push(Mark::Label { at, text: text.into(), color });
        self
    }

    /// Each name stands once in the legend; an empty one not at all.
    fn key(&mut self, name: &str, key: LegendKey) {
        if !name.is_empty() && self.legend.iter().all(|(known, _)| known != name) {
            self.legend.push((name.into(), key));
        }
    }

    /// Position of a point along the axes: itself, or the powers of ten; NaN where there is none.
    fn scaled(&self, p: Point) -> Point {
        let power = |x: f64| if x > 0.0 { x.log10() } else { f64::NAN };
        if self.logarithmic { p.map(power) } else { p }
    }

    /// Smallest rectangle around everything drawn, with a little room; `[lo, hi]` of x and of y.
    fn ranges(&self) -> [[f64; 2]; 2] {
        // Notes and labels find room where there is some; they ask for none.
        let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for mark in &self.marks {
            let points = match mark {
                Mark::Line { points, .. }
                | Mark::Dots { points, .. }
                | Mark::Area { outline: points, .. } => points,
                Mark::Note { .. } | Mark::Label { .. } => continue,
            };
            for p in points.iter().map(|p| self.scaled(*p)).filter(|p| p[0].is_finite() && p[1].is_finite()) {
                for k in 0..2 {
                    range[k] = [range[k][0].min(p[k]), range[k][1].max(p[k])];
                }
            }
        }
        if self.logarithmic {
            return range.map(|[lo, hi]| if lo <= hi { [lo - 0.25, hi + 0.25] } else { [0.0, 1.0] });
        }
        let [x, y] = range.map(|[lo, hi]| if lo <= hi { [lo, hi] } else { [0.0, 1.0] });
        let y = if self.robust { peaks::cut(y, self.line_values(), self.least_height) } else { y };
        let x = if x[0] == x[1] { [x[0] - 0.5, x[1] + 0.5] } else { x };
        // A constant line gets a height, so that its rounding errors do not fill the chart.
        let least = self.least_height.max(1e-9 * y[0].abs().max(y[1].abs())).max(1e-12);
        let (middle, half) = ((y[0] + y[1]) / 2.0, ((y[1] - y[0]) / 2.0).max(least / 2.0) * 1.08);
        let room = if self.equal { 0.02 * (x[1] - x[0]) } else { 0.0 };
        [[x[0] - room, x[1] + room], [middle - half - room, middle + half + room]]
    }

    /// All y of lines.
    fn line_values(&self) -> Vec<f64> {
        let lines = self.marks.iter().filter_map(|mark| match mark {
            Mark::Line { points, .. } => Some(points),
            _ => None,
        });
        lines.flatten().map(|p| p[1]).filter(|y| y.is_finite()).collect()
    }

    /// Height of the whole chart on a figure of that width, both in pixels.
    pub(crate) fn full_height(&self, width: u32) -> f32 {
        TOP + self.inner_height(width) + BOTTOM
    }

    fn inner_height(&self, width: u32) -> f32 {
        if !self.equal {
            return self.height;
        }
        let [x, y] = self.ranges();
        let scale = f64::from(width as f32 - LEFT - RIGHT) / (x[1] - x[0]);
        ((y[1] - y[0]) * scale).clamp(200.0, 1000.0) as f32
    }

    /// Draws the chart, its top edge at `top`.
    pub(crate) fn draw(&self, canvas: &mut Canvas, width: u32, top: f32) {
        let view = self.view(width, top);
        self.draw_grid(canvas, &view);
        canvas.clip(Some(view.pixels));
        for mark in &self.marks {
            self.draw_mark(canvas, &view, mark);
        }
        self.draw_labels(canvas, &view);
        canvas.clip(None);
        if self.robust {
            let lines = self.marks.iter().filter_map(|mark| match mark {
                Mark::Line { points, pen } => Some((points.as_slice(), pen.color)),
                _ => None,
            });
            peaks::draw(canvas, &view, lines);
        }
        self.draw_frame(canvas, &view);
        self.draw_legend(canvas, &view);
    }

    fn view(&self, width: u32, top: f32) -> PlotView {
        let height = self.inner_height(width);
        let pixels = [[LEFT, top + TOP], [width as f32 - RIGHT, top + TOP + height]];
        let mut ranges = self.ranges();
        if self.equal {
            // One scale for both: the axis with room to spare shows more.
            let size = [f64::from(pixels[1][0] - pixels[0][0]), f64::from(height)];
            let scale = (0..2).map(|k| (ranges[k][1] - ranges[k][0]) / size[k]).fold(0.0, f64::max);
            for k in 0..2 {
                let middle = (ranges[k][0] + ranges[k][1]) / 2.0;
                ranges[k] = [middle - scale * size[k] / 2.0, middle + scale * size[k] / 2.0];
            }
        }
        PlotView { ranges, pixels }
    }

    fn draw_grid(&self, canvas: &mut Canvas, view: &PlotView) {
        let [[left, top], [right, bottom]] = view.pixels;
        let pen = Pen { color: LIGHT, width: 1.0, dashed: false };
        for (x, label) in self.ticks(view.ranges[0], 10) {
            let x = view.place([x, 0.0])[0];
            canvas.line(&[[x, top], [x, bottom]], pen);
            canvas.text([x, bottom + 27.0], &label, TICK, Anchor::Middle);
        }
        for (y, label) in self.ticks(view.ranges[1], (((bottom - top) / 55.0) as usize).max(2)) {
            let y = view.place([0.0, y])[1];
            canvas.line(&[[left, y], [right, y]], pen);
            canvas.text([left - 10.0, y + 7.0], &label, TICK, Anchor::Right);
        }
    }

    fn ticks(&self, [lo, hi]: [f64; 2], wanted: usize) -> Vec<(f64, String)> {
        if self.logarithmic { powers(lo, hi, wanted) } else { ticks(lo, hi, wanted) }
    }

    fn draw_mark(&self, canvas: &mut Canvas, view: &PlotView, mark: &Mark) {
        let place = |points: &[Point]| points.iter().map(|p| view.place(self.scaled(*p))).collect::<Vec<_>>();
        match mark {
            Mark::Line { points, pen } => canvas.line(&thin(&place(points)), *pen),
            Mark::Area { outline, fill } => canvas.fill(&place(outline), *fill),
            Mark::Dots { points, radius, color } => {
                let seen = place(points).into_iter().filter(|p| p[0].is_finite() && p[1].is_finite());
                seen.for_each(|p| canvas.dot(p, *radius, *color));
            }
            Mark::Note { at, text, color } => {
                let [x, y] = view.place(self.scaled(*at));
                canvas.text([x, y], text, Letters { color: *color, ..TICK }, Anchor::Middle);
            }
            Mark::Label { .. } => {}
        }
    }

    /// Labels where nothing is written yet: to the upper right of their points, or the upper left, or below. One that finds no
    /// room is left out.
    fn draw_labels(&self, canvas: &mut Canvas, view: &PlotView) {
        const SIZE: f32 = 15.0;
        let [[left, _], [right, _]] = view.pixels;
        let mut taken: Vec<[f32; 4]> = Vec::new();
        for mark in &self.marks {
            let Mark::Label { at, text, color } = mark else { continue };
            let ([x, y], width) = (view.place(self.scaled(*at)), text::width(text, SIZE, TICK.weight));
            let places = [-6.0, 18.0].map(|down| [x + 8.0, x - 8.0 - width].map(|x| [x, y + down]));
            let found = places.as_flattened().iter().find(|[x, y]| {
                let free = |t: &[f32; 4]| *x > t[2] || x + width < t[0] || y - SIZE > t[3] || *y < t[1];
                *x > left && x + width < right && taken.iter().all(free)
            });
            if let Some(&[x, y]) = found {
                taken.push([x, y - SIZE, x + width, y]);
                canvas.text([x, y], text, Letters { color: *color, size: SIZE, ..TICK }, Anchor::Left);
            }
        }
    }

    fn draw_frame(&self, canvas: &mut Canvas, view: &PlotView) {
        let [[left, top], [right, bottom]] = view.pixels;
        let pen = Pen { color: GREY, width: 1.5, dashed: false };
        canvas.line(&[[left, top], [left, bottom], [right, bottom], [right, top], [left, top]], pen);
        canvas.text([left, top - 18.0], &self.title, TITLE, Anchor::Left);
        canvas.text([(left + right) / 2.0, bottom + 58.0], &self.labels[0], LABEL, Anchor::Middle);
        canvas.text_upwards([30.0, (top + bottom) / 2.0], &self.labels[1], LABEL, Anchor::Middle);
    }

    /// Above the axes, from the right, so that it never hides data.
    fn draw_legend(&self, canvas: &mut Canvas, view: &PlotView) {
        let [[_, top], [mut x, _]] = view.pixels;
        let y = top - 18.0;
        for (name, key) in self.legend.iter().rev() {
            canvas.text([x, y], name, LABEL, Anchor::Right);
            x -= text::width(name, LABEL.size, LABEL.weight) + 8.0;
            let middle = y - 7.0;
            match *key {
                LegendKey::Line(pen) => {
                    canvas.line(&[[x - 34.0, middle], [x, middle]], Pen { width: pen.width.max(2.5), ..pen });
                }
                LegendKey::Dot(color) => canvas.dot([x - 10.0, middle], 6.0, color),
                LegendKey::Patch(color) => {
                    let (l, t, b) = (x - 30.0, middle - 9.0, middle + 9.0);
                    canvas.fill(&[[l, t], [x, t], [x, b], [l, b]], color);
                }
            }
            x -= 62.0;
        }
    }
}

/// Units to pixels.
pub(crate) struct PlotView {
    pub(crate) ranges: [[f64; 2]; 2],
    pub(crate) pixels: [Pixel; 2],
}

impl PlotView {
    pub(crate) fn place(&self, p: Point) -> Pixel {
        let share = |k: usize| ((p[k] - self.ranges[k][0]) / (self.ranges[k][1] - self.ranges[k][0])) as f32;
        let [[left, top], [right, bottom]] = self.pixels;
        [left + share(0) * (right - left), bottom + share(1) * (top - bottom)]
    }
}

/// Leaves out points that cannot be seen: of all that fall into one column of pixels one after the other, the first,
/// lowest, highest and last stay.
fn thin(points: &[Pixel]) -> Vec<Pixel> {
    let mut kept = Vec::new();
    for column in points.chunk_by(|a, b| a[0].is_finite() && b[0].is_finite() && a[0].floor() == b[0].floor())
    {
        if column.len() <= 4 || column.iter().any(|p| !p[1].is_finite()) {
            kept.extend_from_slice(column);
            continue;
        }
        let last = column.len() - 1;
        let extreme =
            |sign: f32| (0..=last).max_by(|&a, &b| (sign * column[a][1]).total_cmp(&(sign * column[b][1])));
        let mut stay = [0, extreme(-1.0).unwrap_or(0), extreme(1.0).unwrap_or(0), last];
        stay.sort_unstable();
        kept.extend(stay.map(|i| column[i]));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_extremes_and_gaps() {
        let mut points: Vec<Pixel> = (0..1000).map(|i| [5.0 + 0.0009 * i as f32, (i % 7) as f32]).collect();
        points[500][1] = 99.0;
        points[600][1] = -99.0;
        let thinned = thin(&points);
        assert!(thinned.len() == 4 && thinned.contains(&points[500]) && thinned.contains(&points[600]));
        points[700][1] = f32::NAN;
        assert!(thin(&points).iter().any(|p| p[1].is_nan()));
    }

    #[test]
    fn equal_axes_have_one_scale() {
        let mut chart = Chart::new("", "", "").equal();
        chart.line("", vec![[0.0, 0.0], [4.0, 1.0]], BLACK);
        let view = chart.view(1600, 0.0);
        let (o, x, y) = (view.place([0.0, 0.0]), view.place([1.0, 0.0]), view.place([0.0, 1.0]));
        assert!(((x[0] - o[0]) - (o[1] - y[1])).abs() < 0.01);
    }

    #[test]
    fn decades_are_equally_far_apart_and_zero_is_left_out() {
        let mut chart = Chart::new("", "", "").logarithmic();
        chart.line("", vec![[1e-3, 1e-9], [1.0, 0.0], [1e2, 1e-2]], BLACK);
        assert_eq!(chart.ranges(), [[-3.25, 2.25], [-9.25, -1.75]]);
        let view = chart.view(1600, 0.0);
        let x = [1e-2, 1e-1, 1.0].map(|x| view.place(chart.scaled([x, 1e-4]))[0]);
        assert!((x[1] - x[0] - (x[2] - x[1])).abs() < 1e-3);
        chart.draw(&mut Canvas::new(300, 300), 300, 0.0);
    }

    #[test]
    fn a_chart_of_nothing_can_be_drawn() {
        let mut chart = Chart::new("nothing", "x", "y");
        chart.line("a", vec![], BLACK).band("b", &[0.0], &[f64::NAN], &[1.0], LIGHT);
        chart.draw(&mut Canvas::new(300, 300), 300, 0.0);
        assert_eq!(chart.ranges()[0], [0.0, 1.0]);
    }
}
