//! Letters as outlines: Noto Sans (SIL Open Font License 1.1), embedded, so that nothing is asked of the system.

use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, MetadataProvider};
use tiny_skia::{Path, PathBuilder};

/// Weight of the letters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Weight {
    /// Labels.
    Regular,
    /// Titles.
    Bold,
}

impl Weight {
    fn font(self) -> FontRef<'static> {
        let bytes = match self {
            Self::Regular => notosans::REGULAR_TTF,
            Self::Bold => notosans::BOLD_TTF,
        };
        FontRef::new(bytes).expect("the embedded font is sound: a test reads it")
    }
}

/// Width of a line of text of that size, both in pixels.
pub(crate) fn width(text: &str, size: f32, weight: Weight) -> f32 {
    let font = weight.font();
    let metrics = GlyphMetrics::new(&font, Size::new(size), LocationRef::default());
    let glyphs = font.charmap();
    text.chars().filter_map(|c| metrics.advance_width(glyphs.map(c).unwrap_or_default())).sum()
}

/// Outline of a line of text, its base line beginning at the origin; y points down. None for blanks.
pub(crate) fn outline(text: &str, size: f32, weight: Weight) -> Option<Path> {
    let font = weight.font();
    let (glyphs, outlines) = (font.charmap(), font.outline_glyphs());
    let metrics = GlyphMetrics::new(&font, Size::new(size), LocationRef::default());
    let mut pen = PathPen { path: PathBuilder::new(), x: 0.0 };
    for c in text.chars() {
        let id = glyphs.map(c).unwrap_or_default();
        if let Some(glyph) = outlines.get(id) {
            // A glyph that cannot be drawn leaves a gap.
            let _ = glyph.draw(DrawSettings::unhinted(Size::new(size), LocationRef::default()), &mut pen);
        }
        pen.x += metrics.advance_width(id).unwrap_or(0.0);
    }
    pen.path.finish()
}

struct PathPen {
    path: PathBuilder,
    x: f32,
}

impl OutlinePen for PathPen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.x + x, -y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.x + x, -y);
    }
    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.path.quad_to(self.x + cx, -cy, self.x + x, -y);
    }
    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        self.path.cubic_to(self.x + ax, -ay, self.x + bx, -by, self.x + x, -y);
    }
    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn embedded_fonts_have_every_letter_a_figure_needs() {
        for weight in [Weight::Regular, Weight::Bold] {
            let glyphs = weight.font().charmap();
            for c in "AZaz09 .,:;()[]/%+-−°²·…→".chars() {
                assert!(c == '→' || glyphs.map(c).is_some(), "{c}");
            }
        }
    }

    #[test]
    fn outlines_are_as_wide_as_they_say() {
        let text = "inclination error [rad]";
        let bounds = outline(text, 20.0, Weight::Regular).unwrap().bounds();
        assert!((bounds.width() - width(text, 20.0, Weight::Regular)).abs() < 4.0);
        assert!(outline("  ", 20.0, Weight::Regular).is_none());
    }
}
