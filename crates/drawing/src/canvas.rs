//! A picture made of lines, polygons, circles and text; pixels, y down.

use crate::color::{Color, WHITE};
use crate::text::{self, Weight};
use std::path::Path;
use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Rect, Stroke, StrokeDash, Transform,
};

/// A point on the canvas, in pixels.
pub(crate) type Pixel = [f32; 2];

/// Alignment of text relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// Begins there.
    Left,
    /// Its middle is there.
    Middle,
    /// Ends there.
    Right,
}

/// Style of a line.
#[derive(Clone, Copy, Debug)]
pub struct Pen {
    /// Colour.
    pub color: Color,
    /// Width in pixels.
    pub width: f32,
    /// Dashes instead of a whole line.
    pub dashed: bool,
}

/// Letters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Letters {
    pub(crate) color: Color,
    /// In pixels.
    pub(crate) size: f32,
    pub(crate) weight: Weight,
}

/// The picture.
pub(crate) struct Canvas {
    pixels: Pixmap,
    clip: Option<tiny_skia::Mask>,
}

impl Canvas {
    /// A white picture.
    pub(crate) fn new(width: u32, height: u32) -> Self {
        let mut pixels = Pixmap::new(width.max(1), height.max(1)).expect("no side is zero");
        pixels.fill(paint_color(WHITE));
        Self { pixels, clip: None }
    }

    /// Draws only inside of the rectangle from now on; `None`: everywhere.
    pub(crate) fn clip(&mut self, rectangle: Option<[Pixel; 2]>) {
        self.clip = rectangle.and_then(|[a, b]| {
            let mut mask = tiny_skia::Mask::new(self.pixels.width(), self.pixels.height())?;
            let path = PathBuilder::from_rect(Rect::from_ltrb(a[0], a[1], b[0], b[1])?);
            mask.fill_path(&path, FillRule::Winding, true, Transform::identity());
            Some(mask)
        });
    }

    /// Joins the points; a point that is not finite is a gap.
    pub(crate) fn line(&mut self, points: &[Pixel], pen: Pen) {
        for run in points.split(|p| !(p[0].is_finite() && p[1].is_finite())) {
            if let Some(path) = polyline(run, false) {
                let dash = pen
                    .dashed
                    .then(|| StrokeDash::new(vec![4.0 * pen.width, 3.0 * pen.width], 0.0))
                    .flatten();
                let stroke = Stroke {
                    width: pen.width,
                    line_cap: if pen.dashed { LineCap::Butt } else { LineCap::Round },
                    line_join: LineJoin::Round,
                    dash,
                    ..Stroke::default()
                };
                self.pixels.stroke_path(
                    &path,
                    &paint(pen.color),
                    &stroke,
                    Transform::identity(),
                    self.clip.as_ref(),
                );
            }
        }
    }

    /// Fills a polygon.
    pub(crate) fn fill(&mut self, points: &[Pixel], color: Color) {
        if points.iter().any(|p| !(p[0].is_finite() && p[1].is_finite())) {
            return;
        }
        if let Some(path) = polyline(points, true) {
            let clip = self.clip.as_ref();
            self.pixels.fill_path(&path, &paint(color), FillRule::Winding, Transform::identity(), clip);
        }
    }

    /// Fills a circle.
    pub(crate) fn dot(&mut self, at: Pixel, radius: f32, color: Color) {
        if let Some(path) = PathBuilder::from_circle(at[0], at[1], radius) {
            let clip = self.clip.as_ref();
            self.pixels.fill_path(&path, &paint(color), FillRule::Winding, Transform::identity(), clip);
        }
    }

    /// Writes a line of text; `at` lies on its base line.
    pub(crate) fn text(&mut self, at: Pixel, line: &str, letters: Letters, anchor: Anchor) {
        self.write(line, letters, anchor, Transform::from_translate(at[0], at[1]));
    }

    /// Writes a line of text from bottom to top.
    pub(crate) fn text_upwards(&mut self, at: Pixel, line: &str, letters: Letters, anchor: Anchor) {
        self.write(line, letters, anchor, Transform::from_rotate(-90.0).post_translate(at[0], at[1]));
    }

    fn write(&mut self, line: &str, letters: Letters, anchor: Anchor, place: Transform) {
        let width = text::width(line, letters.size, letters.weight);
        let shift = match anchor {
            Anchor::Left => 0.0,
            Anchor::Middle => -width / 2.0,
            Anchor::Right => -width,
        };
        if let Some(path) = text::outline(line, letters.size, letters.weight) {
            let place = place.pre_translate(shift, 0.0);
            self.pixels.fill_path(&path, &paint(letters.color), FillRule::Winding, place, self.clip.as_ref());
        }
    }

    /// Writes a PNG file.
    pub(crate) fn save(&self, path: &Path) -> Result<(), String> {
        let png = self.pixels.encode_png().map_err(|e| format!("{}: {e}", path.display()))?;
        std::fs::write(path, png).map_err(|e| format!("{}: {e}", path.display()))
    }
}

fn polyline(points: &[Pixel], closed: bool) -> Option<tiny_skia::Path> {
    let (first, rest) = points.split_first()?;
    let mut path = PathBuilder::new();
    path.move_to(first[0], first[1]);
    for p in rest {
        path.line_to(p[0], p[1]);
    }
    if closed {
        path.close();
    }
    path.finish()
}

fn paint_color(Color(r, g, b, a): Color) -> tiny_skia::Color {
    tiny_skia::Color::from_rgba8(r, g, b, a)
}

fn paint(color: Color) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(paint_color(color));
    paint
}
