//! Fall of the simulated robot: from too much tilt to lying on the ground.

use nalgebra::Vector3;

use crate::layout::orientation;

/// Tilt of the torso \[rad\] from which a robot counts as fallen; it is also fallen below half its initial height.
const FALLEN_TILT: f64 = std::f64::consts::FRAC_PI_4;
/// \[rad\] Tilt that is a fall if it lasts: the robot lies on a foot that should not carry.
const LEANING: f64 = 0.2;
/// \[s\] How long it must last.
const LEANING_TIME: f64 = 1.0;
/// Share of its initial height below which a fallen robot's torso lies on the ground.
const LYING: f64 = 0.25;

/// Fall of one robot.
#[derive(Clone, Copy)]
pub(crate) struct FallWatch {
    /// \[m\]
    initial_height: f64,
    /// \[s\] For how long the torso has leaned.
    leaning: f64,
    fallen: bool,
    /// It lies on the ground, or its numbers are lost: nothing moves any more.
    lies: bool,
}

impl FallWatch {
    /// Of a robot that stands or hangs with its torso at `height` \[m\].
    pub(crate) fn new(height: f64) -> Self {
        Self { initial_height: height, leaning: 0.0, fallen: false, lies: false }
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

    /// Looks at a state, `dt` \[s\] after the last one: whether the robot has just fallen.
    pub(crate) fn begins(&mut self, state: &[f64], dt: f64) -> bool {
        let up = orientation(state) * Vector3::z();
        self.leaning = if up.z < LEANING.cos() { self.leaning + dt } else { 0.0 };
        // A tilt that is NaN is a fall too.
        let stands = up.z > FALLEN_TILT.cos() && state[2] > 0.5 * self.initial_height;
        let begins = (!stands || self.leaning > LEANING_TIME) && !self.fallen;
        self.fallen |= begins;
        begins
    }

    /// True if a fallen robot has just come to the ground.
    pub(crate) fn lands(&self, state: &[f64]) -> bool {
        self.fallen && !self.lies && state[2] < LYING * self.initial_height
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;

    /// State of a floating base at 1 m, rolled by `angle` \[rad\].
    fn rolled(angle: f64) -> [f64; 7] {
        let q = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angle);
        [0.0, 0.0, 1.0, q.i, q.j, q.k, q.w]
    }

    /// A robot that leans by 0.30 rad for good lies on a foot; one that sways that far for half a second does not.
    #[test]
    fn leaning_for_long_is_a_fall() {
        let mut watch = FallWatch::new(1.0);
        let mut begins = |angle: f64, seconds: f64| {
            (0..(100.0 * seconds) as u32).any(|_| watch.begins(&rolled(angle), 0.01))
        };
        assert!(!begins(0.3, 0.6) && !begins(0.1, 0.2) && !begins(0.3, 0.6), "swayed");
        assert!(begins(0.3, 0.6), "leaned for 1.2 s");
    }

    #[test]
    fn too_much_tilt_is_a_fall_at_once() {
        let mut watch = FallWatch::new(1.0);
        assert!(watch.begins(&rolled(0.8), 0.01) && watch.has_fallen() && !watch.begins(&rolled(0.8), 0.01));
    }
}
