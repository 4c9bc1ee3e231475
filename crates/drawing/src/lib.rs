//! Charts as PNG files, without any system package: outlines by tiny-skia, letters from an embedded font.

mod canvas;
mod chart;
pub mod color;
mod difference;
mod figure;
mod peaks;
mod text;
mod ticks;

pub use canvas::Pen;
pub use chart::{Chart, Point};
pub use color::Color;
pub use difference::difference;
pub use figure::Figure;
