//! Where each state of a model is, and how many there are: thesis tables 2.4 and 2.5.
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

/// Components of a model and their states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
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
pub struct Counts {
    /// Mechanical degrees of freedom.
    pub mechanical: usize,
    /// Degrees of freedom of the contact layer.
    pub contact: usize,
    /// Electrical degrees of freedom.
    pub electrical: usize,
    /// Ordinary differential equations of first order.
    pub odes: usize,
}

impl Layout {
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

    /// Counts as in the thesis's tables.
    pub fn counts(&self) -> Counts {
        let mechanical = 6 + self.joints + self.elastic;
        let (contact, electrical) = (3 * self.nodes, self.motors);
        Counts { mechanical, contact, electrical, odes: 2 * mechanical + contact + electrical }
    }
}

fn after(before: &Range<usize>, n: usize) -> Range<usize> {
    before.end..before.end + n
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_follow_each_other_without_gaps() {
        let l = Layout { joints: 24, elastic: 16, nodes: 16, motors: 24 };
        let ranges = [l.pose(), l.speed(), l.rotor_angle(), l.rotor_speed(), l.layer(), l.current()];
        assert!(ranges.windows(2).all(|w| w[0].end == w[1].start));
        assert_eq!(l.counts().odes + 1, l.len());
    }
}
