//! Charts as PNG files, without any system package: outlines by tiny-skia, letters from an embedded font.

mod canvas;
mod chart;
pub mod color;
mod figure;
mod text;
mod ticks;

pub use canvas::Pen;
pub use chart::{Chart, Point};
pub use color::Color;
pub use figure::Figure;
