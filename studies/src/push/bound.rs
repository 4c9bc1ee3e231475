//! Bound of a survived push: what a linear pendulum with the robot's soles, and with the reach and the timing of its steps, is
//! caught from in one step, by whoever knows of the push beforehand.
//!
//! ```text
//! xi' = w (xi - p) + a/w       p anywhere in the box around the soles that stand, a while the push lasts
//! ```
//! Caught: when the foot has landed xi is in the box around its sole and the other one. Everything is wider than it really is, and
//! axes are taken one by one: no such pendulum survives more in one step. A walk that takes several may.

use config::gait::Reaction;
use config::{Robot, Setup};
use messages::{ControllerState, LEFT, RIGHT};
use multibody::GRAVITY_ACCELERATION as GRAVITY;

use super::instants::{DURATION, Instant};

/// Landings in time that are tried.
const TRIED: usize = 64;
/// \[N s/kg\] The bound is found within this.
const RESOLUTION: f64 = 1e-3;
/// \[N s/kg\] Nothing survives that.
const MOST: f64 = 4.0;

/// The pendulum at an instant.
#[derive(Clone, Debug)]
pub(super) struct Pendulum {
    /// \[1/s\] Its rate.
    w: f64,
    /// \[m\] Divergent component, and places of both feet.
    xi: [f64; 2],
    feet: [[f64; 2]; 2],
    /// \[m\] Sole of each foot about its place: from, to by axis.
    soles: [[[f64; 2]; 2]; 2],
    /// Foot that carries, or will carry, the single support, and when that begins and ends \[s\]; none: both stand.
    swing: Option<(usize, [f64; 2])>,
    rules: Reaction,
}

/// Load of the left foot at which it, or the other one, swings.
fn carries(state: &ControllerState) -> Option<usize> {
    match state.load_left {
        load if load >= 1.0 => Some(LEFT),
        load if load <= 0.0 => Some(RIGHT),
        _ => None,
    }
}

impl Pendulum {
    /// That of a robot at an instant of its walk; none of a gait without steps that react.
    pub(super) fn of(setup: &Setup, start: &Instant) -> Option<Self> {
        let rules = setup.gait.reaction?;
        let mut chain = start.chain.clone();
        let cycle = chain.cycle();
        let state = chain.step().controller_state;
        // The undisturbed walk says when its single supports are: this one, or the next, and how long the one after it lasts.
        let mut supports: Vec<(usize, [f64; 2])> = Vec::new();
        let mut last = None;
        for k in 0..(4.0 / cycle) as usize {
            let now = carries(&chain.step().controller_state);
            let time = k as f64 * cycle;
            match (now, supports.last_mut()) {
                (Some(foot), _) if now != last => supports.push((foot, [time; 2])),
                (Some(_), Some(support)) => support.1[1] = time,
                _ => {}
            }
            last = now;
        }
        let swing = supports.first().map(|&(foot, [begin, end])| {
            let lasts = supports.get(1).map_or(0.0, |(_, [begin, end])| end - begin);
            // One that runs has begun before.
            if begin == 0.0 { (foot, [end - lasts, end]) } else { (foot, [begin, end]) }
        });
        Some(Self {
            w: (GRAVITY / (state.com[2] - state.feet[RIGHT][2].min(state.feet[LEFT][2]))).sqrt(),
            xi: state.dcm,
            feet: state.feet.map(|f| [f[0], f[1]]),
            soles: soles(&setup.robot),
            swing,
            rules,
        })
    }

    /// \[N s/kg\] Largest impulse in this direction from which it is caught.
    pub(super) fn bound(&self, direction: [f64; 2]) -> f64 {
        let (mut good, mut bad) = (0.0, MOST);
        while bad - good > RESOLUTION {
            let middle = 0.5 * (good + bad);
            if self.is_caught(direction.map(|d| d * middle)) { good = middle } else { bad = middle }
        }
        good
    }

    /// After a push of this impulse \[N s/kg\] now.
    fn is_caught(&self, impulse: [f64; 2]) -> bool {
        let both = [0, 1].map(|d| around(self.sole(RIGHT, d), self.sole(LEFT, d)));
        let in_box = |r: f64, until: [f64; 2], supports: [[[f64; 2]; 2]; 2], goal: [[f64; 2]; 2]| {
            (0..2).all(|d| {
                let [low, high] = self.reached(d, r, impulse[d], until, supports);
                low <= goal[d][1] && high >= goal[d][0]
            })
        };
        let landings = |stance: usize, lift: f64, [first, last]: [f64; 2]| {
            let alone = [0, 1].map(|d| self.sole(stance, d));
            (0..=TRIED).any(|k| {
                let r = first + (last - first) * k as f64 / TRIED as f64;
                let goal = [0, 1].map(|d| self.landing(stance, d, r - lift.max(0.0)));
                in_box(r, [lift.max(0.0), r], [both, alone], goal)
            })
        };
        let Reaction { swing: shortest, wait, .. } = self.rules;
        match self.swing {
            // Both feet stand: as they are, or either one swings.
            None => {
                in_box(DURATION, [DURATION; 2], [both, both], both)
                    || [RIGHT, LEFT]
                        .into_iter()
                        .any(|stance| landings(stance, 0.0, [shortest, shortest + wait]))
            }
            Some((stance, [lift, end])) => {
                let first = (lift + shortest).max(DURATION);
                landings(stance, lift, [first, (end + wait).max(first)])
                    || lift > DURATION && in_box(DURATION, [DURATION; 2], [both, both], both)
            }
        }
    }

    /// \[m\] Sole of a foot along an axis: from, to.
    fn sole(&self, foot: usize, axis: usize) -> [f64; 2] {
        self.soles[foot][axis].map(|x| self.feet[foot][axis] + x)
    }

    /// \[m\] Box of both soles along an axis, once the other foot has landed wherever it gets in a swing of `time` \[s\].
    fn landing(&self, stance: usize, axis: usize, time: f64) -> [f64; 2] {
        let [near, far] = self.rules.width;
        let side = if stance == RIGHT { [near, far] } else { [-far, -near] };
        let room = [self.rules.length, side][axis].map(|x| self.feet[stance][axis] + x);
        let (from, reach) = (self.feet[1 - stance][axis], self.rules.speed * time);
        let [low, high] = room.map(|x| x.clamp(from - reach, from + reach));
        let [back, front] = self.soles[1 - stance][axis];
        around(self.sole(stance, axis), [low + back, high + front])
    }

    /// \[m\] Divergent component along an axis after `r` \[s\], from, to: the zero-moment point is anywhere in the first of
    /// `supports` until the first time of `until` \[s\], and then in the second one until the second.
    fn reached(
        &self,
        axis: usize,
        r: f64,
        impulse: f64,
        until: [f64; 2],
        supports: [[[f64; 2]; 2]; 2],
    ) -> [f64; 2] {
        let grown = |since: f64| (self.w * (r - since)).exp();
        let pushed = impulse / DURATION / (self.w * self.w) * (grown(0.0) - grown(DURATION.min(r)));
        let free = self.xi[axis] * grown(0.0) + pushed;
        let [first, second] = until.map(|t| t.min(r));
        let shares = [grown(0.0) - grown(first), grown(first) - grown(second)];
        [1, 0].map(|end| free - (0..2).map(|i| shares[i] * supports[i][axis][end]).sum::<f64>())
    }
}

/// \[m\] Soles about their frames, by axis: from, to.
fn soles(robot: &Robot) -> [[[f64; 2]; 2]; 2] {
    [RIGHT, LEFT].map(|i| {
        let [back, front, right, left] = robot.feet[i].support;
        [[back, front], [right, left]]
    })
}

/// Both intervals, and what lies between them.
fn around(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Lola on her right foot, which has carried her alone for 0.1 of 0.64 s.
    fn lola() -> Pendulum {
        let setup = Setup::load(&config::root(None), "push").unwrap();
        Pendulum {
            w: 3.57,
            xi: [-0.13, 0.03],
            feet: [[0.0, 0.0], [0.0, 0.21]],
            soles: soles(&setup.robot),
            swing: Some((RIGHT, [-0.1, 0.54])),
            rules: setup.gait.reaction.unwrap(),
        }
    }

    /// Pendulums walked in steps of 1 ms, whose zero-moment points and landings are drawn at random, or put where they do most:
    /// none is caught from more than the bound, and the best ones are from nearly as much.
    #[test]
    fn no_pendulum_survives_more_and_one_survives_as_much() {
        let (p, mut random) = (lola(), Random(7));
        for direction in [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]] {
            let bound = p.bound(direction);
            let axis = usize::from(direction[0] == 0.0);
            let mut survives = |impulse: f64, best: bool| {
                let [back, front] = p.sole(RIGHT, axis);
                // The body is pushed over one edge: there the zero-moment point does most, early or late.
                let edge = if direction[axis] > 0.0 { front } else { back };
                let at = if best { edge } else { back + random.unit() * (front - back) };
                let [first, last] = [0.35, 0.94];
                let end = if best { first } else { first + random.unit() * (last - first) };
                let mut xi = p.xi[axis];
                for k in 0..(end * 1e3) as usize {
                    let force = if k < 100 { impulse / 0.1 * direction[axis] } else { 0.0 };
                    xi += 1e-3 * (p.w * (xi - at) + force / p.w);
                }
                let [low, high] = p.landing(RIGHT, axis, end);
                (low..=high).contains(&xi)
            };
            assert!(survives(0.97 * bound - 0.01, true), "{direction:?}: not {bound}");
            for _ in 0..2000 {
                assert!(!survives(1.03 * bound + 0.01, false), "{direction:?}: more than {bound}");
            }
        }
    }

    /// Standing, the bound to the side without a step is what the soles hold: the impulse over the rate, less what grows while the
    /// push lasts.
    #[test]
    fn a_standing_pendulum_is_held_by_its_soles() {
        let mut p = lola();
        (p.swing, p.xi) = (None, [-0.13, 0.105]);
        p.rules.width = [0.15, 0.21]; // no room for a step to the side
        let held = 0.145 * p.w * (p.w * 0.1) / ((p.w * 0.1).exp() - 1.0) * (p.w * 0.1).exp();
        assert!((p.bound([0.0, 1.0]) - held).abs() < 0.01, "{} {held}", p.bound([0.0, 1.0]));
    }
}
