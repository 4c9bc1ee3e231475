//! `[can.tables]` of a robot: drives that play tables of points by themselves, in scenes with `points = "tables"`.
//!
//! ```toml
//! [can.tables]
//! file = "can/archie_tables.dbc" # frames: no targets, telegrams of the drives' interpreters instead
//! sampling_us = 320 # [us] T_s of the position controllers: WS[28]
//! playback = "sync" # each SYNC sets the time of a table; "free": each drive's own clock does
//! ```

use codec::layout::FrameLayout;
use codec::room::telegrams_per_cycle;
use drives::point_table::{MOST_POINTS, MOST_SPACING};

use crate::pattern::Pattern;
use crate::section::Section;

/// Words of `playback`.
const PLAYBACK: [&str; 2] = ["sync", "free"];

/// Clock by which a drive plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Playback {
    /// The bus's: each SYNC is a cycle later than the one before.
    Sync,
    /// The drive's own, from the SYNC on with which it begins.
    Free,
}

/// Drives that play tables.
#[derive(Clone, Debug, PartialEq)]
pub struct TableDrives {
    /// DBC file of the drives' frames, beside `robot.toml`.
    pub file: String,
    /// \[us\] Sampling period T_s of the drives' position controllers.
    pub sampling_us: u32,
    /// Clock by which the drives play.
    pub playback: Playback,
}

impl TableDrives {
    pub(crate) fn build(table: &Section<'_, '_>) -> Self {
        Self {
            file: table.text("file"),
            sampling_us: table.integer("sampling_us", 50..=10_000) as u32,
            playback: [Playback::Sync, Playback::Free][table.word("playback", &PLAYBACK)],
        }
    }

    /// \[1\] Samples in a bus cycle \[s\].
    pub fn samples(&self, cycle: f64) -> f64 {
        let samples = cycle * 1e6 / f64::from(self.sampling_us);
        let whole = samples.round();
        // Rounding of the cycle is no drift.
        if (samples - whole).abs() < 1e-9 * whole { whole } else { samples }
    }

    /// Bus cycles \[s\] between a record of tables with so many points and the earliest `start_tick` that it may have: points
    /// are checked, loaded, and the begin is announced.
    pub fn lead(&self, layout: &FrameLayout, cycle: f64, points: usize) -> u64 {
        points.div_ceil(POINTS_CHECKED) as u64 + self.upload(layout, cycle, points) + SLACK + BEGIN_AHEAD
    }

    /// Bus cycles \[s\] in which so many points are brought to all drives.
    pub fn upload(&self, layout: &FrameLayout, cycle: f64, points: usize) -> u64 {
        let per_cycle = telegrams_per_cycle(layout, cycle).max(1);
        let drives = |line| {
            let commands = layout.messages.iter().filter(|m| m.to_drives && m.node == line);
            commands.filter(|m| m.interpreter().is_some()).count()
        };
        let most = (0..layout.nodes.len()).map(drives).max().unwrap_or(0);
        (most * (points + REGISTERS)).div_ceil(per_cycle) as u64
    }

    /// Bus cycles \[s\] between a plan of so many points and its earliest start: its tables are filled, then brought.
    pub fn plan_lead(&self, layout: &FrameLayout, cycle: f64, points: usize) -> u64 {
        points.div_ceil(POINTS_FILLED) as u64 + self.lead(layout, cycle, points)
    }

    /// \[s\] Time from point to point of a pattern's tables.
    pub fn period(&self, pattern: &Pattern) -> f64 {
        f64::from(self.spacing(pattern)) * f64::from(self.sampling_us) * 1e-6
    }

    /// \[1\] Samples from point to point of a pattern's tables: m = 2 T_c / (N T_s), the nearest from 1 to 256.
    pub fn spacing(&self, pattern: &Pattern) -> u32 {
        (self.exact_spacing(pattern).round() as u32).clamp(1, MOST_SPACING)
    }

    /// \[1\] Points of a plan of a pattern that is `end` \[s\] long, the last one twice.
    pub fn points(&self, pattern: &Pattern, end: f64) -> usize {
        (end / self.period(pattern) - ROUNDING).ceil() as usize + 2
    }

    fn exact_spacing(&self, pattern: &Pattern) -> f64 {
        2e6 * pattern.step_time / (pattern.points as f64 * f64::from(self.sampling_us))
    }

    /// First key of a pattern whose tables cannot be played in bus cycles of `cycle` \[s\], and why.
    pub fn problem(&self, pattern: &Pattern, cycle: f64) -> Option<(&'static str, String)> {
        let Pattern { step_time, points, .. } = *pattern;
        let (m, near) = (self.exact_spacing(pattern), self.spacing(pattern));
        let [samples, cycles] = [f64::from(near) / self.samples(cycle), step_time / cycle];
        let is_whole = |x: f64| (x - x.round()).abs() < ROUNDING * x;
        if !(is_whole(m) && m.round() == f64::from(near)) {
            let [sampling, can] = [f64::from(self.sampling_us), 0.5 * points as f64 * self.period(pattern)];
            return Some((
                "T_c",
                format!(
                    "{step_time} s would be N m T_s / 2 with N = {points}, T_s = {sampling} us and m = {m:.3}, which must be \
                     whole, from 1 to {MOST_SPACING}; the nearest that can be played is {can:.6} s, with m = {near}"
                ),
            ));
        }
        if points % 2 == 1 {
            return Some((
                "N",
                format!("{points} must be even: a new plan takes over at a point, after a step"),
            ));
        }
        if samples < 1.0 {
            let period = 1e3 * self.period(pattern);
            return Some((
                "N",
                format!(
                    "{points} points are {period:.3} ms apart, and must be a bus cycle, {} ms; fewer",
                    1e3 * cycle
                ),
            ));
        }
        let whole = (cycles.round() * cycle * 1e6).round() / 1e6;
        (!is_whole(cycles)).then(|| {
            ("T_c", format!("{step_time} s must be whole bus cycles of {} ms: {whole} s", 1e3 * cycle))
        })
    }
}

/// \[1\] Rounding of times in points or cycles.
const ROUNDING: f64 = 1e-9;
/// Most points of a plan: two of them have room in a drive, the next one beside the one that is played.
pub const PLAN_POINTS: usize = MOST_POINTS / 2;
/// Points of a plan that are filled in one cycle.
pub const POINTS_FILLED: usize = 16;

/// Commands to a drive with a table, besides its points: the question for the sampling period, four registers, the choice.
pub const REGISTERS: usize = 6;
/// Points of all joints that are checked in one cycle before anything is sent.
pub const POINTS_CHECKED: usize = 32;
/// \[1\] Cycles before its first one at which the begin of tables is announced to the drives: their answers have half of them.
pub const BEGIN_AHEAD: u64 = 20;
/// \[1\] Cycles for answers that take longer than one.
const SLACK: u64 = 10;
