//! Charts one below the other on one picture.

use crate::canvas::{Anchor, Canvas, Letters};
use crate::chart::Chart;
use crate::color::{BLACK, GREY};
use crate::text::Weight;
use std::path::Path;

const WIDTH: u32 = 1600;
const HEAD: f32 = 96.0;

/// A picture with a title, a line of explanation and charts.
#[derive(Clone, Debug)]
pub struct Figure {
    title: String,
    about: String,
    charts: Vec<Chart>,
}

impl Figure {
    /// A figure without charts yet.
    pub fn new(title: &str, about: &str) -> Self {
        Self { title: title.into(), about: about.into(), charts: Vec::new() }
    }

    /// Adds a chart below the others.
    pub fn with(mut self, chart: Chart) -> Self {
        self.charts.push(chart);
        self
    }

    /// Title of the first chart in which nothing would be seen.
    pub fn empty_chart(&self) -> Option<&str> {
        self.charts.iter().map(Chart::emptiness).find(|(_, empty)| *empty).map(|(title, _)| title)
    }

    /// Draws everything into a PNG file.
    pub fn save(&self, path: &Path) -> Result<(), String> {
        let heights: Vec<f32> = self.charts.iter().map(|c| c.full_height(WIDTH)).collect();
        let mut canvas = Canvas::new(WIDTH, (HEAD + heights.iter().sum::<f32>()).ceil() as u32);
        let title = Letters { color: BLACK, size: 32.0, weight: Weight::Bold };
        let about = Letters { color: GREY, size: 21.0, weight: Weight::Regular };
        canvas.text([36.0, 50.0], &self.title, title, Anchor::Left);
        canvas.text([36.0, 84.0], &self.about, about, Anchor::Left);
        let mut top = HEAD;
        for (chart, height) in self.charts.iter().zip(heights) {
            chart.draw(&mut canvas, WIDTH, top);
            top += height;
        }
        canvas.save(path)
    }
}
