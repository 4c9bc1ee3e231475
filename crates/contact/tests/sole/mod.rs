//! One pad over level ground, for tests.

use std::sync::Arc;

use contact::hexahedron::{LinearElasticity, Volume};
use contact::{Ground, Layer, Material, Memory, Pad, PadLoad, SegmentMotion, Settings};
use nalgebra::Vector3;

/// \[s\]
pub(crate) const ALPHA: f64 = 0.008;

pub(crate) struct Sole {
    pub(crate) pad: Pad,
    pub(crate) memory: Memory,
    pub(crate) d: Vec<f64>,
    pub(crate) dd: Vec<f64>,
    ground: Vec<Option<Ground>>,
}

/// A layer of a pad of Lola's size.
pub(crate) fn layer(poisson: f64, bricks: [usize; 3]) -> Layer {
    let elasticity = LinearElasticity { modulus: 4.643e5, poisson };
    let size = [0.06, 0.04, 0.012];
    Layer::new(&Material { size, bricks, elasticity, volume: Volume::Full, damping_time: ALPHA }).unwrap()
}

impl Sole {
    /// A pad of Lola's size, its middle 0.1 m ahead of and 0.05 m left of the segment's origin.
    pub(crate) fn new(poisson: f64) -> Self {
        Self::of_bricks(poisson, [5, 5, 1])
    }

    pub(crate) fn of_bricks(poisson: f64, bricks: [usize; 3]) -> Self {
        let pad = Pad::new(Arc::new(layer(poisson, bricks)), Vector3::new(0.1, 0.05, 0.0));
        let states = 3 * pad.layer().nodes();
        let ground = vec![None; pad.layer().contacts()];
        Self { memory: pad.memory(), pad, d: vec![0.0; states], dd: vec![0.0; states], ground }
    }

    /// One evaluation; the undeformed sole is `height` above level ground.
    pub(crate) fn rates(&mut self, height: f64, twist: &SegmentMotion, settings: &Settings) -> PadLoad {
        for (i, ground) in self.ground.iter_mut().enumerate() {
            *ground = Some(Ground { gap: height + self.d[3 * i + 2], normal: Vector3::z() });
        }
        self.pad.solve(&mut self.memory, &self.d, &self.ground, twist, settings, &mut self.dd)
    }

    /// One step of explicit Euler.
    pub(crate) fn step(
        &mut self,
        h: f64,
        height: f64,
        twist: &SegmentMotion,
        settings: &Settings,
    ) -> PadLoad {
        let outcome = self.rates(height, twist, settings);
        self.advance(h);
        outcome
    }

    /// The same over ground of any height: `of` says for x of a node what is below its undeformed place.
    pub(crate) fn step_on(
        &mut self,
        h: f64,
        of: &dyn Fn(f64) -> Option<Ground>,
        twist: &SegmentMotion,
        settings: &Settings,
    ) -> PadLoad {
        for i in 0..self.ground.len() {
            let below = of(self.pad.place(i).x);
            self.ground[i] = below.map(|g| Ground { gap: g.gap + self.d[3 * i + 2], ..g });
        }
        let outcome = self.pad.solve(&mut self.memory, &self.d, &self.ground, twist, settings, &mut self.dd);
        self.advance(h);
        outcome
    }

    fn advance(&mut self, h: f64) {
        for (d, dd) in self.d.iter_mut().zip(&self.dd) {
            *d += h * dd;
        }
    }
}
