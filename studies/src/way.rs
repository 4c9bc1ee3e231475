//! Way that a robot has made: in its own axes, so that where it heads does not matter.

use messages::SimState;

/// Way of the torso, forward and to the left as it heads at each instant, and its turn.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Way {
    /// \[m, m, rad\]
    pub(crate) gone: [f64; 3],
    heading: Option<f64>,
}

impl Way {
    /// Adds a cycle of this length \[s\].
    pub(crate) fn add(&mut self, state: &SimState, cycle: f64) {
        let [x, y, z, w] = state.orientation;
        let heading = (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z));
        let before = self.heading.replace(heading).unwrap_or(heading);
        self.gone[0] += state.velocity[0] * cycle;
        self.gone[1] += state.velocity[1] * cycle;
        self.gone[2] += (heading - before).sin();
    }
}
