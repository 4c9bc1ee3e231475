//! A place: ground of one kind, drawn at random from a seed, where the undisturbed walk would step on it.
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | x, y | along the way and to its left; the robot starts at 0 and walks along x | m | world |
//! | angle | about z, counter-clockwise from x | rad | world |

use std::f64::consts::{FRAC_PI_4, PI, TAU};

use config::plant_mismatch::Payload;

use super::footprint::{Footprint, Rectangle};
use super::kind::GroundKind;
use crate::random::Random;

/// \[m\] Where on the way edges and the beginnings of slopes lie. The walk repeats itself by then, and its longest stride
/// (1.3 m) is longer than that by little, so that any phase of it is met.
pub(super) const ALONG: [f64; 2] = [2.0, 3.2];
/// \[m\] Length and width of boards, and of patches of another friction.
const BOARD: [[f64; 2]; 2] = [[0.1, 0.6], [0.2, 1.2]];
const PATCH: [[f64; 2]; 2] = [[0.3, 1.5], [0.6, 1.5]];
/// \[m\] How much larger than the part of the sole without support a hole is.
const BEYOND: f64 = 0.02;
/// \[m\] @torso Where a payload is, from the torso's centre of gravity.
const LOAD: [[f64; 2]; 3] = [[-0.15, 0.15], [-0.05, 0.05], [-0.15, 0.15]];
/// No robot here has more.
const MOST_JOINTS: usize = messages::MAX_JOINTS;
/// Nodes of a height field along and across its way.
pub(super) const NODES: [usize; 2] = [11, 11];

/// Ground at a place, with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Place {
    /// From an edge through (x, 0) on the ground is higher by this, or lower.
    Step { x: f64, angle: f64, height: f64 },
    /// A board.
    Board { area: Rectangle, height: f64 },
    /// A hole.
    Hole { area: Rectangle },
    /// A slope that begins at x and rises by `slope` \[1\] in the direction `angle`.
    Slope { x: f64, angle: f64, slope: f64 },
    /// Heights \[m\] at [`NODES`], y by y from x on.
    Field { x: f64, heights: Vec<f64> },
    /// A patch of this friction \[1\].
    Patch { area: Rectangle, friction: f64 },
    /// Level ground, and a robot that does not weigh what it is believed to.
    Robot(Masses),
}

/// What a robot weighs over what it is believed to.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Masses {
    /// \[1\] Of the torso, and of the bodies behind its joints by their indices, repeated.
    pub(super) factors: Vec<f64>,
    /// \[m\] @torso
    pub(super) cog_shift: [f64; 3],
    pub(super) payload: Option<Payload>,
}

impl Place {
    /// The place of a seed: `size` in SI, `steps` those of the undisturbed walk within [`ALONG`].
    pub(super) fn draw(kind: GroundKind, size: f64, steps: &[Footprint], seed: u64) -> Self {
        let mut random = Random(seed);
        let x = random.within(ALONG);
        let step = &steps[((random.unit() * steps.len() as f64) as usize).min(steps.len() - 1)];
        match kind {
            GroundKind::StepUp | GroundKind::StepDown => {
                let angle = random.within([-FRAC_PI_4, FRAC_PI_4]);
                let height = if kind == GroundKind::StepUp { size } else { -size };
                Self::Step { x, angle, height }
            }
            GroundKind::Board => Self::Board { area: under(step, BOARD, &mut random), height: size },
            GroundKind::HalfFoothold => Self::Hole { area: missing(step, size, random.within([0.0, TAU])) },
            GroundKind::Slope => Self::Slope { x, angle: random.within([-PI, PI]), slope: size.tan() },
            GroundKind::HeightField => {
                let rim = |k: usize| k == 0 || k == NODES[0] - 1;
                let count = NODES[0] * NODES[1];
                let height = |k: usize| {
                    let height = random.within([-size, size]);
                    if rim(k / NODES[1]) { 0.0 } else { height }
                };
                Self::Field { x, heights: (0..count).map(height).collect() }
            }
            GroundKind::LowFriction => Self::Patch { area: under(step, PATCH, &mut random), friction: size },
            GroundKind::Masses | GroundKind::Weight | GroundKind::TorsoCog | GroundKind::Payload => {
                Self::Robot(Masses::draw(kind, size, &mut random))
            }
        }
    }
}

impl Masses {
    fn draw(kind: GroundKind, size: f64, random: &mut Random) -> Self {
        let mut masses = Self { factors: vec![1.0], cog_shift: [0.0; 3], payload: None };
        match kind {
            GroundKind::Masses => {
                masses.factors = (0..=MOST_JOINTS).map(|_| random.within([1.0 - size, 1.0 + size])).collect();
            }
            GroundKind::Weight => {
                masses.factors = vec![if random.unit() < 0.5 { 1.0 - size } else { 1.0 + size }];
            }
            GroundKind::TorsoCog => masses.cog_shift = [(); 3].map(|()| random.within([-size, size])),
            _ => {
                masses.payload =
                    Some(Payload { mass: size, position: LOAD.map(|range| random.within(range)) });
            }
        }
        masses
    }
}

/// A rectangle of a size within these limits at any angle, some point of which lies under some point of the sole.
fn under(step: &Footprint, limits: [[f64; 2]; 2], random: &mut Random) -> Rectangle {
    let size = limits.map(|range| random.within(range));
    let angle = random.within([-PI, PI]);
    let [u, v, s, t] = [(); 4].map(|()| random.unit());
    let [x, y] = step.point([u, v]);
    let (sin, cos) = angle.sin_cos();
    let [along, across] = [(s - 0.5) * size[0], (t - 0.5) * size[1]];
    Rectangle { middle: [x - cos * along + sin * across, y - sin * along - cos * across], angle, size }
}

/// What of a sole has no support, and a little more, if this share of its length in the direction `angle` has none.
fn missing(step: &Footprint, share: f64, angle: f64) -> Rectangle {
    let (sin, cos) = angle.sin_cos();
    let range = |of: &dyn Fn(&[f64; 2]) -> f64| {
        let each = step.corners.iter().map(of);
        each.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], a| [lo.min(a), hi.max(a)])
    };
    let [near, far] = range(&|[x, y]| x * cos + y * sin);
    let [right, left] = range(&|[x, y]| y * cos - x * sin);
    let (edge, far) = (far - share * (far - near), far + BEYOND);
    let (a, b) = (0.5 * (edge + far), 0.5 * (right + left));
    Rectangle {
        middle: [a * cos - b * sin, a * sin + b * cos],
        angle,
        size: [far - edge, left - right + 2.0 * BEYOND],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: Footprint = Footprint { corners: [[2.0, 0.1], [2.3, 0.1], [2.3, 0.2], [2.0, 0.2]] };

    #[test]
    fn the_same_seed_is_the_same_place_and_others_are_not() {
        for kind in GroundKind::all() {
            let of = |seed| Place::draw(kind, kind.in_si(kind.sizes()[0]), &[STEP], seed);
            assert_eq!(of(7), of(7));
            assert!((8..20).any(|seed| of(7) != of(seed)), "{kind:?}");
        }
    }

    /// Whatever the angle, the share of the sole's points beyond the edge is about the one that was asked for.
    #[test]
    fn half_a_foothold_is_half_of_it() {
        for seed in 0..40 {
            let Place::Hole { area } = Place::draw(GroundKind::HalfFoothold, 0.5, &[STEP], seed) else {
                panic!()
            };
            let n = 200;
            let points = (0..n * n).map(|k| [k % n, k / n].map(|i| (i as f64 + 0.5) / n as f64));
            let over = points.filter(|at| area.holds(STEP.point(*at))).count();
            let share = over as f64 / (n * n) as f64;
            assert!((share - 0.5).abs() < 0.01, "{share} of the sole, seed {seed}");
        }
    }

    /// A board that no sole would have touched says nothing.
    #[test]
    fn boards_and_patches_lie_under_a_sole() {
        for (kind, seed) in [GroundKind::Board, GroundKind::LowFriction]
            .into_iter()
            .flat_map(|kind| (0..50).map(move |seed| (kind, seed)))
        {
            let (Place::Board { area, .. } | Place::Patch { area, .. }) =
                Place::draw(kind, 0.02, &[STEP], seed)
            else {
                panic!()
            };
            let n = 100;
            let mut points = (0..=n * n).map(|k| [k % n, k / n].map(|i| i as f64 / (n - 1) as f64));
            assert!(points.any(|at| area.holds(STEP.point(at))), "{area:?}");
        }
    }
}
