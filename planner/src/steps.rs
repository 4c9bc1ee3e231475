//! Step sequence: footholds on the standard circular path (thesis 4.3; errata 2.1, 2.2; gaps 1, 2).
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | L_x, L_y | step length forward and to the left | m |
//! | phi | turn to the left per step | rad |
//! | W_c, W_n | width with which the current stance foot was placed, and of the next one | m |
//! | nu | +1 on the right foot, -1 on the left | 1 |
//! | p_fc | middle of the foot in the sole frame | m |
//!
//! Thesis (4.1) and (4.2) are one formula without cancellation here; (4.3) is added to the result, where it is exact.

use crate::pose::{PlanarPose, rotate};
use crate::sole::Sole;
use config::gait;
use messages::Detail;

/// Most steps a plan can hold: the plan's load factors have room for seven.
pub(crate) const MAX_STEPS: usize = 7;

/// \[m\] Rounding of footholds.
pub(crate) const ROUNDING: f64 = 1e-6;

/// Parameters of a step (table 4.1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepParameters {
    /// \[m\] L_x
    pub length: f64,
    /// \[m\] L_y
    pub side: f64,
    /// \[rad\] phi_step
    pub turn: f64,
    /// \[s\] T_step
    pub duration: f64,
}

impl StepParameters {
    /// The same for an event.
    pub(crate) fn detail(&self) -> Detail {
        let thousandths = |x: f64| (x * 1e3).round();
        let [length, side, turn] = self.way().map(|x| thousandths(x) as i16);
        Detail::Steps { length, side, turn, duration: thousandths(self.duration) as u16 }
    }

    /// Stepping on the spot.
    pub(crate) const fn on_the_spot(duration: f64) -> Self {
        Self { length: 0.0, side: 0.0, turn: 0.0, duration }
    }

    /// \[m, m, rad\] Length, side and turn.
    pub fn way(&self) -> [f64; 3] {
        [self.length, self.side, self.turn]
    }

    /// The same on `share` of its way, in the same time.
    pub(crate) fn shortened(&self, share: f64) -> Self {
        Self { length: self.length * share, side: self.side * share, turn: self.turn * share, ..*self }
    }

    /// The parameters nearest to `wish` that differ from these by at most `share` of the largest change per step.
    pub fn towards(&self, wish: &Self, step: &gait::StepSettings, share: f64) -> Self {
        let near = |now: f64, wish: f64, most: f64| now + (wish - now).clamp(-most * share, most * share);
        Self {
            length: near(self.length, wish.length, step.change[0]),
            side: near(self.side, wish.side, step.change[1]),
            turn: near(self.turn, wish.turn, step.change[2]),
            duration: near(self.duration, wish.duration, step.change_duration),
        }
    }

    /// The same, with length, side and turn on the straight line to `wish`: all between two steps that can be walked can be,
    /// too, while one number that grows before another one shrinks may ask for more than both.
    pub(crate) fn straight_towards(&self, wish: &Self, step: &gait::StepSettings, share: f64) -> Self {
        let (now, to) = (self.way(), wish.way());
        let most = (0..3).map(|i| step.change[i] * share / (to[i] - now[i]).abs()).fold(1.0, f64::min);
        let [length, side, turn] = [0, 1, 2].map(|i| now[i] + most * (to[i] - now[i]));
        Self { length, side, turn, ..self.towards(wish, step, share) }
    }
}

/// Heights of a step \[m\], over the planning frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Heights {
    /// Of the ground under the stance foot.
    pub foothold: f64,
    /// Of the ground the swing foot comes from.
    pub takeoff: f64,
    /// Of the ground the swing foot lands on.
    pub landing: f64,
    /// Lift of the swing foot over the higher one of its footholds.
    pub lift: f64,
    /// `true` if a skill asks for them; others are as the ground was found.
    pub of_skill: bool,
}

/// One step of a sequence. Times in s from the start of the plan; poses in its planning frame.
#[derive(Clone, Copy, Debug)]
pub struct Stride {
    /// Parameters of the step; zero length for one that closes the feet.
    pub parameters: StepParameters,
    /// Foot that carries the single support.
    pub stance: usize,
    /// \[m\] Width W_n with which the swing foot is placed.
    pub width: f64,
    /// Start of the double support.
    pub begin: f64,
    /// Start of the swing.
    pub lift: f64,
    /// Landing.
    pub end: f64,
    /// Landing, in cycles from the start of the plan.
    pub end_cycle: u64,
    /// Pose of the stance foot.
    pub foothold: PlanarPose,
    /// Pose that the swing foot comes from.
    pub takeoff: PlanarPose,
    /// Pose in which the swing foot lands.
    pub landing: PlanarPose,
    /// Heights of these three, and of the swing.
    pub heights: Heights,
}

impl Stride {
    /// No step.
    pub const NONE: Self = Self {
        parameters: StepParameters::on_the_spot(0.0),
        stance: 0,
        width: 0.0,
        begin: 0.0,
        lift: 0.0,
        end: 0.0,
        end_cycle: 0,
        foothold: PlanarPose::new(0.0, 0.0, 0.0),
        takeoff: PlanarPose::new(0.0, 0.0, 0.0),
        landing: PlanarPose::new(0.0, 0.0, 0.0),
        heights: Heights { foothold: 0.0, takeoff: 0.0, landing: 0.0, lift: 0.0, of_skill: false },
    };

    /// The same step seen from `frame`, on ground of the height `ground` \[m\]; its times stay.
    pub(crate) fn seen(&self, frame: &PlanarPose, ground: f64) -> Self {
        let [foothold, takeoff, landing] =
            [&self.foothold, &self.takeoff, &self.landing].map(|pose| frame.relative(pose));
        let mut heights = self.heights;
        for z in [&mut heights.foothold, &mut heights.takeoff, &mut heights.landing] {
            *z -= ground;
        }
        Self { foothold, takeoff, landing, heights, ..*self }
    }

    /// A step down of a skill?
    pub(crate) fn descends(&self) -> bool {
        self.heights.of_skill && self.heights.landing < self.heights.foothold - ROUNDING
    }

    /// Is the swing foot lifted over something, or onto it?
    pub(crate) fn is_high(&self, step: &gait::StepSettings) -> bool {
        let h = &self.heights;
        h.lift > step.swing_height + ROUNDING || h.of_skill && (h.landing - h.takeoff).abs() > ROUNDING
    }
}

/// nu of a stance foot: +1 right, -1 left.
pub fn nu(stance: usize) -> f64 {
    if stance == messages::RIGHT { 1.0 } else { -1.0 }
}

fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-8 { 1.0 } else { x.sin() / x }
}

/// \[m\] Middle of the next foothold, seen from the middle of the stance foot (4.1).
pub fn displacement(p: &StepParameters, w_c: f64, w_n: f64, nu: f64) -> [f64; 2] {
    let phi = p.turn;
    let b = p.side + nu * w_n / 2.0;
    [
        p.length * sinc(phi) - b * phi.sin(),
        nu * w_c / 2.0 + b * phi.cos() + p.length * (phi / 2.0).sin() * sinc(phi / 2.0),
    ] // (4.1)
}

/// Pose of the next foothold in the frame of the stance foot, turning about the middle of the foot (4.1), (4.3).
pub fn next_foothold(p: &StepParameters, w_c: f64, w_n: f64, nu: f64, sole: &Sole) -> PlanarPose {
    let [x, y] = displacement(p, w_c, w_n, nu);
    let c = sole.center;
    let rc = rotate(p.turn, c);
    PlanarPose::new(x + c[0] - rc[0], y + c[1] - rc[1], p.turn) // (4.3)
}

/// Lateral distance that keeps two turned soles as far apart as `width_min` keeps parallel ones (4.4).
pub fn required_distance(turn: f64, width_min: f64, sole: &Sole) -> f64 {
    width_min + sole.half[0] * turn.sin().abs() - sole.half[1] * (1.0 - turn.cos())
}

/// Width W_n of the next foothold (4.4): at least `step.width`, wide enough for this step (errata 2.2), and at least
/// half of what two equal steps need, so that widths of a steady turn do not alternate.
///
/// The foot left behind becomes the swing foot: seen from the new one it must not stand in its own way either, which
/// (4.4) does not look at. It turns while it passes, so it needs as much room as at its foothold.
pub fn next_width(p: &StepParameters, w_c: f64, nu: f64, step: &gait::StepSettings, sole: &Sole) -> f64 {
    let (s, c) = p.turn.sin_cos();
    let need = required_distance(p.turn, step.width_min, sole);
    let bound = |w_c: f64| 2.0 * (need - nu * displacement(p, w_c, 0.0, nu)[1]) / c; // (4.4)
    let together = bound(0.0) / (1.0 + 1.0 / c);
    let [x, y] = displacement(p, w_c, 0.0, nu);
    let behind = 2.0 * (need - nu * (c * y - s * x));
    step.width.max(bound(w_c)).max(together).max(behind)
}
