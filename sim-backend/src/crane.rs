//! Crane that holds the robot at the start: a rope with slack, from a trolley to a hook on the torso.
//!
//! F = max(0, K (l - l_0) + D l') along the rope while it is taut, l > l_0, and nothing while it is slack: a rope does not
//! push. The trolley stands still while the rope is taut and follows the hook while it is slack, so that a robot that
//! walks away is not pulled back.

use crate::layout::orientation;
use config::crane::Crane as Description;
use nalgebra::{UnitQuaternion, Vector3};

/// The rope of one moment.
#[derive(Clone, Copy, Debug)]
pub struct Rope {
    /// \[m\] @world Where it hangs.
    pub anchor: Vector3<f64>,
    /// \[m\] @torso Where it ends.
    pub hook: Vector3<f64>,
    /// \[m\] Without load.
    pub length: f64,
    /// \[N/m\]
    pub stiffness: f64,
    /// \[N s/m\]
    pub damping: f64,
}

impl Rope {
    /// Tension \[N\] in a state x with these speeds.
    pub(crate) fn tension(&self, x: &[f64], speed: &[f64]) -> f64 {
        self.in_state(x, speed).0.norm()
    }

    /// Force on the torso \[N\] and the point where it acts \[m\], both @world, in a state x with these speeds.
    pub(crate) fn in_state(&self, x: &[f64], speed: &[f64]) -> (Vector3<f64>, Vector3<f64>) {
        let [velocity, omega] = [0, 3].map(|i| Vector3::from_column_slice(&speed[i..i + 3]));
        self.pull(&Vector3::from_column_slice(&x[..3]), &orientation(x), &velocity, &omega)
    }

    /// The same for a torso at `position` \[m\] with `velocity` \[m/s\] and angular velocity `omega` \[rad/s\], both
    /// @torso.
    fn pull(
        &self,
        position: &Vector3<f64>,
        orientation: &UnitQuaternion<f64>,
        velocity: &Vector3<f64>,
        omega: &Vector3<f64>,
    ) -> (Vector3<f64>, Vector3<f64>) {
        let at = position + orientation * self.hook;
        let up = self.anchor - at;
        let length = up.norm();
        if length <= self.length {
            return (Vector3::zeros(), at);
        }
        let along = up / length;
        let rate = -along.dot(&(orientation * (velocity + omega.cross(&self.hook))));
        let force = self.stiffness * (length - self.length) + self.damping * rate;
        (along * force.max(0.0), at)
    }
}

/// The crane of one robot.
#[derive(Clone, Debug)]
pub(crate) struct CraneRope {
    rope: Rope,
    speed: f64,
    /// \[m\] Height of the trolley to be reached.
    goal: f64,
}

impl CraneRope {
    /// A crane that holds a robot of this mass \[kg\] with the hook at `at` @world: taut, and in balance.
    pub(crate) fn new(of: &Description, hook: Vector3<f64>, at: Vector3<f64>, mass: f64) -> Self {
        let stretch = mass * multibody::GRAVITY_ACCELERATION / of.stiffness;
        let anchor = at + Vector3::z() * (of.rope + stretch);
        let rope = Rope { anchor, hook, length: of.rope, stiffness: of.stiffness, damping: of.damping };
        Self { rope, speed: of.speed, goal: anchor.z }
    }

    /// Lowers by this much \[m\] from where it is to be; lifts if negative.
    pub(crate) fn lower(&mut self, distance: f64) {
        self.goal -= distance;
    }

    /// Moves for a cycle of `dt` \[s\] with the robot in this state.
    pub(crate) fn step(&mut self, state: &[f64], dt: f64) -> Rope {
        let hook = Vector3::from_column_slice(&state[..3]) + orientation(state) * self.rope.hook;
        self.follow(&hook, dt)
    }

    /// The same with the hook at `at` \[m\] @world.
    fn follow(&mut self, at: &Vector3<f64>, dt: f64) -> Rope {
        let anchor = &mut self.rope.anchor;
        anchor.z += (self.goal - anchor.z).clamp(-self.speed * dt, self.speed * dt);
        if (*anchor - at).norm() < self.rope.length {
            (anchor.x, anchor.y) = (at.x, at.y);
        }
        self.rope
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CRANE: Description =
        Description { height: 0.1, hook: 0.4, rope: 1.0, stiffness: 5e4, damping: 1e3, speed: 0.1 };

    fn pull(rope: &Rope, hook: f64, velocity: f64) -> f64 {
        let (zero, still) = (Vector3::zeros(), UnitQuaternion::identity());
        let torso = Vector3::z() * (hook - 0.4);
        rope.pull(&torso, &still, &(Vector3::z() * velocity), &zero).0.z
    }

    #[test]
    fn carries_the_weight_at_the_start_and_nothing_when_slack() {
        let hook = Vector3::z() * 0.4;
        let mut crane = CraneRope::new(&CRANE, hook, Vector3::z(), 60.0);
        let rope = crane.follow(&Vector3::z(), 1e-3);
        assert!((pull(&rope, 1.0, 0.0) - 60.0 * 9.81).abs() < 1e-9);
        assert!((pull(&rope, 1.0, -0.1) - 60.0 * 9.81 - 100.0).abs() < 1e-9, "damped");
        assert_eq!(pull(&rope, 1.0, 10.0), 0.0, "a rope does not push");
        assert_eq!(pull(&rope, 1.1, 0.0), 0.0);
    }

    #[test]
    fn lowers_at_its_speed_and_follows_a_robot_that_walks_away_once_slack() {
        let mut crane = CraneRope::new(&CRANE, Vector3::z() * 0.4, Vector3::z(), 60.0);
        let top = crane.rope.anchor.z;
        crane.lower(0.05);
        for _ in 0..250 {
            crane.follow(&Vector3::z(), 1e-3);
        }
        assert!((top - crane.rope.anchor.z - 0.025).abs() < 1e-12);
        for _ in 0..1000 {
            crane.follow(&Vector3::z(), 1e-3);
        }
        assert!((top - crane.rope.anchor.z - 0.05).abs() < 1e-12);
        let away = crane.follow(&Vector3::new(0.1, 0.0, 1.0), 1e-3);
        assert_eq!(away.anchor.x, 0.1);
        let taut = crane.follow(&Vector3::new(0.1, 0.0, 0.5), 1e-3);
        let still = crane.follow(&Vector3::new(0.5, 0.0, 0.5), 1e-3);
        assert_eq!(taut.anchor, still.anchor);
    }
}
