//! Homing: reference of a joint with an incremental encoder.
//!
//! The encoder on the motor counts from where it was switched on. A joint with an absolute encoder has its reference at
//! once: what that reads, less the pose in which it reads zero. A joint without one has a home switch, open on one side
//! of a known angle and closed on the other: the joint runs towards its edge, overruns it, and comes back over it slowly;
//! there the edge is the reference (in the manner of the homing methods 19 to 22 of CiA 402).

/// Home switch of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomeSwitch {
    /// \[rad\] Angle of its edge; it is closed above.
    pub angle: f64,
    /// \[rad/s\] Joint speed of the search, positive.
    pub fast: f64,
    /// \[rad/s\] Joint speed over the edge, positive.
    pub slow: f64,
}

/// A search for the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Homing {
    /// Towards the edge.
    Search,
    /// Back over it; whether the switch was closed when the way back began.
    Back(bool),
    /// The edge was passed in this cycle.
    Found,
}

impl Homing {
    /// One cycle: what the switch says, and the joint speed \[rad/s\] to go on with.
    pub fn step(&mut self, switch: &HomeSwitch, began_closed: bool, closed: bool) -> f64 {
        let towards = |closed: bool| if closed { -1.0 } else { 1.0 };
        *self = match *self {
            Self::Search if closed != began_closed => Self::Back(closed),
            Self::Back(was) if closed != was => Self::Found,
            same => same,
        };
        match *self {
            Self::Search => switch.fast * towards(began_closed),
            Self::Back(was) => switch.slow * towards(was),
            Self::Found => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SWITCH: HomeSwitch = HomeSwitch { angle: 0.1, fast: 0.3, slow: 0.015 };

    /// From either side the edge is met within what the joint moves in a cycle of the slow search.
    #[test]
    fn finds_the_edge_from_both_sides() {
        for start in [-0.5, 0.099, 0.1, 0.101, 0.7] {
            let (mut q, mut homing, dt) = (start, Homing::Search, 1e-3);
            let closed = |q: f64| q >= SWITCH.angle;
            let began = closed(q);
            let mut cycles = 0;
            while homing != Homing::Found && cycles < 10_000 {
                q += dt * homing.step(&SWITCH, began, closed(q));
                cycles += 1;
            }
            assert_eq!(homing, Homing::Found, "from {start}");
            assert!((q - SWITCH.angle).abs() <= SWITCH.slow * dt * 1.001, "from {start}: {q}");
        }
    }
}
