//! State vector of a model: places and number of its states, thesis tables 2.4 and 2.5.
//!
//! | states | name | unit | frame | in the state vector |
//! |---|---|---|---|---|
//! | r | origin of the torso | m | world | pose |
//! | o | quaternion world_from_torso (x, y, z, w) | 1 | | pose |
//! | q | joint angles, if joints have dynamics of their own | rad | | pose |
//! | v, w | velocity of the origin, angular velocity | m/s, rad/s | torso | speed |
//! | q' | joint speeds | rad/s | | speed |
//! | th, th' | rotors behind elastic gears, divided by the gear ratio | rad, rad/s | | rotor |
//! | d | displacement of each contact node | m | points: world, pads: segment | layer |
//! | I | motor currents | A | | current |
//!
//! The thesis counts Euler angles; the fourth component of the quaternion is redundant and is not counted here either.

use std::ops::Range;

use nalgebra::UnitQuaternion;

/// Components of a model and their states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateLayout {
    /// Joints with dynamics of their own.
    pub joints: usize,
    /// Elastic gears.
    pub elastic: usize,
    /// Contact nodes.
    pub nodes: usize,
    /// Motors with electrical dynamics.
    pub motors: usize,
}

/// A column of thesis table 2.4 or 2.5.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateCounts {
    /// Mechanical degrees of freedom.
    pub mechanical: usize,
    /// Degrees of freedom of the contact layer.
    pub contact: usize,
    /// Electrical degrees of freedom.
    pub electrical: usize,
    /// Ordinary differential equations of first order.
    pub odes: usize,
}

impl StateLayout {
    /// Length of the state vector.
    pub fn len(&self) -> usize {
        self.current().end
    }

    /// A model always has a torso.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// r, o, q: what the multibody model calls q.
    pub fn pose(&self) -> Range<usize> {
        0..7 + self.joints
    }

    /// v, w, q': what the multibody model calls v.
    pub fn speed(&self) -> Range<usize> {
        after(&self.pose(), 6 + self.joints)
    }

    /// th
    pub fn rotor_angle(&self) -> Range<usize> {
        after(&self.speed(), self.elastic)
    }

    /// th'
    pub fn rotor_speed(&self) -> Range<usize> {
        after(&self.rotor_angle(), self.elastic)
    }

    /// d
    pub fn layer(&self) -> Range<usize> {
        after(&self.rotor_speed(), 3 * self.nodes)
    }

    /// I
    pub fn current(&self) -> Range<usize> {
        after(&self.layer(), self.motors)
    }

    /// Name of the state of this number: "speed of joint 3".
    pub fn name(&self, state: usize) -> String {
        const AXES: [&str; 4] = ["x", "y", "z", "w"];
        let parts = [
            (self.pose(), ["position", "orientation", "angle of joint"]),
            (self.speed(), ["velocity", "angular velocity", "speed of joint"]),
        ];
        // Pose and speed begin with the torso's six, its quaternion one more; joints follow.
        for (range, [first, second, joint]) in parts {
            let k = state.wrapping_sub(range.start);
            match k {
                _ if !range.contains(&state) => {}
                0..3 => return format!("{first} {} of the torso", AXES[k]),
                _ if k < range.len() - self.joints => {
                    return format!("{second} {} of the torso", AXES[k - 3]);
                }
                _ => return format!("{joint} {}", k + self.joints - range.len()),
            }
        }
        let d = state.wrapping_sub(self.layer().start);
        match state {
            _ if self.rotor_angle().contains(&state) => {
                format!("angle of elastic rotor {}", state - self.rotor_angle().start)
            }
            _ if self.rotor_speed().contains(&state) => {
                format!("speed of elastic rotor {}", state - self.rotor_speed().start)
            }
            _ if self.layer().contains(&state) => {
                format!("displacement {} of contact node {}", AXES[d % 3], d / 3)
            }
            _ => format!("current of motor {}", state.wrapping_sub(self.current().start)),
        }
    }

    /// Counts as in the thesis's tables.
    pub fn counts(&self) -> StateCounts {
        let mechanical = 6 + self.joints + self.elastic;
        let (contact, electrical) = (3 * self.nodes, self.motors);
        StateCounts { mechanical, contact, electrical, odes: 2 * mechanical + contact + electrical }
    }
}

/// world_from_torso of a state; the quaternion is normalised here, so that integrators need not.
pub fn orientation(x: &[f64]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(x[6], x[3], x[4], x[5]))
}

/// Rate of the quaternion, o' = o w / 2, components x, y, z, w.
pub(crate) fn quaternion_rate(x: &[f64], w: &[f64]) -> [f64; 4] {
    let o = nalgebra::Quaternion::new(x[6], x[3], x[4], x[5]);
    let w = nalgebra::Quaternion::new(0.0, w[0], w[1], w[2]);
    (o * w * 0.5).coords.into()
}

fn after(before: &Range<usize>, n: usize) -> Range<usize> {
    before.end..before.end + n
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_follow_each_other_without_gaps() {
        let l = StateLayout { joints: 24, elastic: 16, nodes: 16, motors: 24 };
        let ranges = [l.pose(), l.speed(), l.rotor_angle(), l.rotor_speed(), l.layer(), l.current()];
        assert!(ranges.windows(2).all(|w| w[0].end == w[1].start));
        assert_eq!(l.counts().odes + 1, l.len());
    }

    #[test]
    fn states_have_names() {
        let l = StateLayout { joints: 24, elastic: 16, nodes: 16, motors: 24 };
        for (state, name) in [
            (2, "position z of the torso"),
            (6, "orientation w of the torso"),
            (7, "angle of joint 0"),
            (l.speed().start + 5, "angular velocity z of the torso"),
            (l.speed().end - 1, "speed of joint 23"),
            (l.rotor_angle().start + 2, "angle of elastic rotor 2"),
            (l.rotor_speed().start, "speed of elastic rotor 0"),
            (l.layer().end - 1, "displacement z of contact node 15"),
            (l.len() - 1, "current of motor 23"),
        ] {
            assert_eq!(l.name(state), name);
        }
    }
}
