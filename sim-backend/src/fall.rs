//! Fall of the simulated robot: from too much tilt to lying on the ground.

use nalgebra::Vector3;

use crate::layout::orientation;

/// Tilt of the torso \[rad\] from which a robot counts as fallen; it is also fallen below half its initial height.
const FALLEN_TILT: f64 = std::f64::consts::FRAC_PI_4;
/// Share of its initial height below which a fallen robot's torso lies on the ground.
const LYING: f64 = 0.25;

/// Fall of one robot.
#[derive(Clone, Copy)]
pub(crate) struct FallWatch {
    /// \[m\]
    initial_height: f64,
    fallen: bool,
    /// It lies on the ground, or its numbers are lost: nothing moves any more.
    lies: bool,
}

impl FallWatch {
    /// Of a robot that stands or hangs with its torso at `height` \[m\].
    pub(crate) fn new(height: f64) -> Self {
        Self { initial_height: height, fallen: false, lies: false }
    }

    /// True if it has fallen.
    pub(crate) fn has_fallen(&self) -> bool {
        self.fallen
    }

    /// True if it lies.
    pub(crate) fn lies(&self) -> bool {
        self.lies
    }

    /// Nothing of it moves any more.
    pub(crate) fn end(&mut self) {
        (self.fallen, self.lies) = (true, true);
    }

    /// Looks at a state: whether the robot has just fallen.
    pub(crate) fn begins(&mut self, state: &[f64]) -> bool {
        let up = orientation(state) * Vector3::z();
        // A tilt that is NaN is a fall too.
        let stands = up.z > FALLEN_TILT.cos() && state[2] > 0.5 * self.initial_height;
        let begins = !stands && !self.fallen;
        self.fallen |= begins;
        begins
    }

    /// True if a fallen robot has just come to the ground.
    pub(crate) fn lands(&self, state: &[f64]) -> bool {
        self.fallen && !self.lies && state[2] < LYING * self.initial_height
    }
}
