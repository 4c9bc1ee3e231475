//! Walking pattern with fixed parameters (Daniali 2013, chapter 4): `[pattern]` of a gait file, in place of `[step]`,
//! `[model]`, `[limits]` and `[control]`.
//!
//! Keys are the thesis's symbols. A step is a double support `0..T_d` and a single support `T_d..T_c`; times count from
//! its begin, and those of a walk at another `T_c` are stretched with it.

use crate::gait::{CommandLimits, GaitModel, KNOT_SPACING, StepSettings};
use crate::section::{NOT_NEGATIVE, POSITIVE, Section};

/// Parameters of the pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern {
    /// \[s\] Time of a step `T_c`.
    pub step_time: f64,
    /// \[s\] Double support `T_d`.
    pub double_support: f64,
    /// \[s\] Instant `T_o` at which the swinging ankle passes `l_ao`, `H_ao`.
    pub over_time: f64,
    /// \[s\] Instant `T_min` at which the torso is lowest.
    pub low_time: f64,
    /// \[s\] Instant `T_max` at which the torso is highest.
    pub high_time: f64,
    /// \[s\] `T_1`..`T_3`: the rear foot begins to pitch, the swinging foot has its landing angle, the front foot lies flat.
    pub pitch_times: [f64; 3],
    /// \[m\] Step length `D_s`; the swinging foot goes twice as far.
    pub length: f64,
    /// \[m\] Way of the swinging ankle up to `T_o`: `l_ao`, of `2 D_s`.
    pub over_length: f64,
    /// \[m\] Height of the swinging ankle at `T_o`: `H_ao`.
    pub over_height: f64,
    /// \[rad\] Pitch, toes down, with which a foot leaves the ground: `q_b`.
    pub leave: f64,
    /// \[rad\] Pitch, toes up, with which it lands: `q_f`.
    pub land: f64,
    /// \[m\] Distance of the feet from side to side: `w_s`.
    pub width: f64,
    /// \[m\] How far the swinging foot moves outwards in passing: `w_p`.
    pub pass: f64,
    /// \[m\] How far the torso stands outside of the stance foot: `w_m`.
    pub shift: f64,
    /// \[m\] Torso in front of the stance ankle at the end of the single support: `x_ed`.
    pub end_ahead: f64,
    /// \[m\] Torso behind the stance ankle at the begin of the single support: `x_sd`.
    pub start_behind: f64,
    /// \[m\] Heights of the torso's origin `H_min`, `H_max`.
    pub heights: [f64; 2],
    /// \[m\] Its height `H_0` at the begin of a step; only of [`TorsoHeight::Spline`].
    pub start_height: f64,
    /// Course of the torso forward.
    pub forward: TorsoForward,
    /// Course of the torso's height.
    pub height: TorsoHeight,
    /// \[1\] Points of a stride in the tables of the drives: `N`.
    pub points: u64,
}

/// Course of the torso forward, `x_h`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TorsoForward {
    /// A quintic in double support, uniform in single support: never backwards.
    Linear,
    /// Periodic cubic spline: (4-13) to (4-16) with the velocity made continuous.
    Spline,
}

/// Course of the torso's height, `z_h`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TorsoHeight {
    /// Quintics from rest to rest: the bounds hold exactly.
    Quintic,
    /// Periodic cubic spline through `H_0`, `H_min`, `H_max`, which it may leave by millimetres.
    Spline,
}

impl TorsoForward {
    const WORDS: [&str; 2] = ["linear", "spline"];
}

impl TorsoHeight {
    const WORDS: [&str; 2] = ["quintic", "spline"];
}

impl Pattern {
    pub(crate) fn build(table: &Section<'_, '_>) -> Self {
        let time = |key: &str| table.number(key, "s", NOT_NEGATIVE);
        let length = |key: &str| table.number(key, "m", NOT_NEGATIVE);
        let (step_time, double_support) =
            (table.number("T_c", "s", POSITIVE), table.number("T_d", "s", POSITIVE));
        let forward = [TorsoForward::Linear, TorsoForward::Spline][table.word("x_h", &TorsoForward::WORDS)];
        let height = [TorsoHeight::Quintic, TorsoHeight::Spline][table.word("z_h", &TorsoHeight::WORDS)];
        // A foot that stays flat needs no times of its pitch.
        let (leave, land) = (table.number("q_b", "rad", 0.0..=0.8), table.number("q_f", "rad", 0.0..=0.8));
        let rolls = leave > 0.0 || land > 0.0 || table.has("T_1");
        let pattern = Self {
            step_time,
            double_support,
            over_time: time("T_o"),
            low_time: time("T_min"),
            high_time: time("T_max"),
            pitch_times: if rolls {
                ["T_1", "T_2", "T_3"].map(time)
            } else {
                [0.0, step_time, step_time + double_support]
            },
            length: table.number("D_s", "m", POSITIVE),
            over_length: length("l_ao"),
            over_height: length("H_ao"),
            leave,
            land,
            width: table.number("w_s", "m", POSITIVE),
            pass: length("w_p"),
            shift: table.number("w_m", "m", -0.5..=0.5),
            end_ahead: table.number("x_ed", "m", -0.5..=0.5),
            start_behind: table.number("x_sd", "m", -0.5..=0.5),
            heights: [table.number("H_min", "m", POSITIVE), table.number("H_max", "m", POSITIVE)],
            // Where another key is wrong, z_h may be: then nobody knows whether H_0 is one too many.
            start_height: if height == TorsoHeight::Spline || !table.is_sound() && table.has("H_0") {
                table.number("H_0", "m", POSITIVE)
            } else {
                0.0
            },
            forward,
            height,
            points: table.integer("N", 2..=1024),
        };
        let front_flat = (rolls && table.has("T_4")).then(|| time("T_4"));
        if let Some((key, problem)) = pattern.first_problem(front_flat).filter(|_| table.is_sound()) {
            table.problem(key, problem);
        }
        pattern
    }

    /// First key that does not fit the others, and why; `front_flat` \[s\] is `T_4`, if it is given: it says the same as
    /// `T_3` of the other foot, (4-32).
    fn first_problem(&self, front_flat: Option<f64>) -> Option<(&'static str, String)> {
        self.disorder().or_else(|| {
            let [first, _, third] = self.pitch_times;
            let must = third - self.step_time - first;
            front_flat.filter(|is| (is - must).abs() > 1e-9).map(|is| {
                ("T_4", format!("{is} s must be T_3 - T_c - T_1 = {must:.4} s: both feet walk alike"))
            })
        })
    }

    /// First key whose value breaks an order that needs no robot, and why.
    #[must_use]
    pub fn disorder(&self) -> Option<(&'static str, String)> {
        let [low, high] = self.heights;
        let [first, second, third] = self.pitch_times;
        let (cycle, support) = (self.step_time, self.double_support);
        let rules: [(&'static str, f64, &str, f64, &str, f64); 11] = [
            ("T_d", support, "0", 0.0, "T_c", cycle),
            ("T_o", self.over_time, "T_d", support, "T_c", cycle),
            ("T_min", self.low_time, "0", 0.0, "T_max", self.high_time),
            ("T_max", self.high_time, "T_min", self.low_time, "T_c", cycle),
            ("T_1", first, "0", 0.0, "T_d", support),
            ("T_2", second, "T_d", support, "T_c", cycle),
            ("T_3", third, "T_c", cycle, "T_c + T_d", cycle + support),
            ("l_ao", self.over_length, "0", 0.0, "2 D_s", 2.0 * self.length),
            ("H_min", low, "0", 0.0, "H_max", high),
            ("w_s", self.width, "0", 0.0, "1 m", 1.0),
            ("T_min", self.low_time, "0", 0.0, "T_d", support),
        ];
        // T_1, T_2 and T_3 may lie on the bounds; NaN fails every comparison.
        let closed =
            |key: &str| key.starts_with("T_") && key.as_bytes().last().is_some_and(u8::is_ascii_digit);
        rules.into_iter().find_map(|(key, value, least, low, most, high)| {
            let inside =
                if closed(key) { value >= low && value <= high } else { value > low && value < high };
            (!inside).then(|| (key, format!("{value} must lie between {least} ({low}) and {most} ({high})")))
        })
    }

    /// Steps as the planner's sequence wants them: equal ones, with half a step at both ends.
    pub(crate) fn step(&self) -> StepSettings {
        let speed = self.length / self.step_time;
        StepSettings {
            width: self.width,
            width_min: self.width,
            swing_height: self.over_height,
            double_support: self.double_support / self.step_time,
            start_time: self.double_support,
            swing_lag: 0.0,
            swing_lead: 0.0,
            first_length: self.length,
            change: [2.0 * self.length, 1.0, 1.0],
            change_duration: self.step_time,
            by_speed: vec![[0.0, 0.0, self.step_time], [speed, self.length, self.step_time]],
        }
    }

    /// Commands that a pattern takes: straight on, no longer steps than its own.
    pub(crate) fn limits(&self) -> CommandLimits {
        let time = self.step_time;
        CommandLimits {
            length: [0.0, self.length],
            side: [0.0; 2],
            turn: [0.0; 2],
            duration: [time, time],
            side_duration: time,
        }
    }

    /// Where the torso stands: as low as it walks.
    pub(crate) fn model(&self) -> GaitModel {
        GaitModel { com_height: self.heights[0], spacing: KNOT_SPACING, ..GaitModel::default() }
    }
}
