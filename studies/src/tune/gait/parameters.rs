//! Free numbers of a gait, and their bounds.

use std::str::FromStr;

use config::Setup;
use config::edit::{number_at, with_numbers};
use messages::Command;
use nalgebra::DVector;

use crate::Error;

/// Step length at the scene's speed: a row of `step.by_speed`, whose duration goes with it.
const LENGTH: &str = "step.length";

/// A number of the gait's file, and another value for it.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedNumber {
    key: String,
    value: f64,
}

/// A number of the gait's file that is free within bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeNumber {
    pub(super) key: String,
    pub(super) range: [f64; 2],
    pub(super) start: Option<f64>,
}

impl FromStr for FixedNumber {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (key, value) = text.split_once('=').ok_or("KEY=VALUE")?;
        Ok(Self { key: key.into(), value: finite(value)? })
    }
}

impl FromStr for FreeNumber {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form = "KEY=LOW:HIGH or KEY=LOW:HIGH@START";
        let (key, rest) = text.split_once('=').ok_or(form)?;
        let (range, start) = rest.split_once('@').map_or((rest, None), |(range, start)| (range, Some(start)));
        let (low, high) = range.split_once(':').ok_or(form)?;
        let range = [finite(low)?, finite(high)?];
        let start = start.map(finite).transpose()?;
        if range[0] >= range[1] {
            return Err(format!("{low}:{high}: the second one must be larger"));
        }
        if start.is_some_and(|x| x < range[0] || x > range[1]) {
            return Err(format!("the start lies outside of {low} to {high}"));
        }
        Ok(Self { key: key.into(), range, start })
    }
}

fn finite(text: &str) -> Result<f64, String> {
    let x = text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    x.ok_or_else(|| format!("`{text}` is no number"))
}

/// The numbers that are free, in a gait in which others are set.
pub(super) struct Parameters<'a> {
    setup: Setup,
    free: &'a [FreeNumber],
    /// Place and speed \[m/s\] of the row of `step.by_speed` that [`LENGTH`] stands for.
    row: Option<(usize, f64)>,
}

impl<'a> Parameters<'a> {
    /// Those of the scene `setup`.
    ///
    /// # Errors
    /// A key is none, or the gait is not one with a number at one of its bounds.
    pub(super) fn new(setup: &Setup, fixed: &[FixedNumber], free: &'a [FreeNumber]) -> Result<Self, Error> {
        if free.is_empty() {
            return Err("nothing is free; name a number of the gait with --free KEY=LOW:HIGH".into());
        }
        if let Some(twice) = free.iter().enumerate().find(|(i, p)| free[..*i].iter().any(|q| q.key == p.key))
        {
            return Err(format!("--free {}: named twice", twice.1.key).into());
        }
        let (_, text) = setup.gait_file();
        let text = with_numbers(text, fixed.iter().map(|f| (f.key.as_str(), f.value)))
            .map_err(|e| format!("--set {e}"))?;
        let setup = setup.clone().with_gait(&text)?;
        let row = if free.iter().any(|p| p.key == LENGTH) { Some(row(&setup)?) } else { None };
        let these = Self { setup, free, row };
        // Each number at both of its bounds, the others where they start.
        let start = these.start()?;
        for i in 0..free.len() {
            for end in [0.0, 1.0] {
                let mut point = start.clone();
                point[i] = end;
                these.setup_at(&point).map_err(|e| format!("--free {}: {e}", these.written(&point)))?;
            }
        }
        Ok(these)
    }

    /// Start of the search, in the unit box: that of each number, or what the file has.
    pub(super) fn start(&self) -> Result<DVector<f64>, Error> {
        let (_, text) = self.setup.gait_file();
        let mut start = DVector::zeros(self.free.len());
        for (x, p) in start.iter_mut().zip(self.free) {
            let key = self.keys(p).0;
            let value =
                p.start.map_or_else(|| number_at(text, &key).map_err(|e| format!("--free {e}")), Ok)?;
            let [low, high] = p.range;
            if value < low || value > high {
                return Err(format!(
                    "--free {}: {value} of the gait lies outside of {low} to {high}; say @START",
                    p.key
                )
                .into());
            }
            *x = (value - low) / (high - low);
        }
        Ok(start)
    }

    /// Values at a point of the unit box.
    pub(super) fn values(&self, point: &DVector<f64>) -> Vec<f64> {
        point.iter().zip(self.free).map(|(x, p)| p.range[0] + x * (p.range[1] - p.range[0])).collect()
    }

    /// The same as text: `key = value, ...`.
    pub(super) fn written(&self, point: &DVector<f64>) -> String {
        let pairs = self.free.iter().zip(self.values(point));
        pairs.map(|(p, x)| format!("{} = {x}", p.key)).collect::<Vec<_>>().join(", ")
    }

    /// Text of the gait's file at a point.
    pub(super) fn text_at(&self, point: &DVector<f64>) -> Result<String, String> {
        let (_, text) = self.setup.gait_file();
        let mut numbers = Vec::new();
        for (p, value) in self.free.iter().zip(self.values(point)) {
            let (key, duration) = self.keys(p);
            numbers.push((key, value));
            numbers.extend(duration.map(|(key, speed)| (key, value / speed)));
        }
        with_numbers(text, numbers.iter().map(|(key, x)| (key.as_str(), *x)))
    }

    /// The scene with the gait at a point.
    pub(super) fn setup_at(&self, point: &DVector<f64>) -> Result<Setup, Error> {
        Ok(self.setup.clone().with_gait(&self.text_at(point)?)?)
    }

    /// Key in the file, and of [`LENGTH`] the key of its duration with the speed \[m/s\].
    fn keys(&self, p: &FreeNumber) -> (String, Option<(String, f64)>) {
        match self.row {
            Some((row, speed)) if p.key == LENGTH => {
                (format!("step.by_speed.{row}.1"), Some((format!("step.by_speed.{row}.2"), speed)))
            }
            _ => (p.key.clone(), None),
        }
    }
}

/// The row of `step.by_speed` with the speed that the scene commands, and that speed \[m/s\].
fn row(setup: &Setup) -> Result<(usize, f64), Error> {
    let forward = forward(setup).ok_or_else(|| format!("--free {LENGTH}: the scene has no walk/velocity"))?;
    let rows = &setup.gait.step.by_speed;
    let row = rows.iter().position(|[speed, ..]| *speed > 0.0 && (speed - forward).abs() < 1e-3);
    let row = row.ok_or_else(|| {
        let speeds: Vec<String> = rows.iter().map(|[speed, ..]| speed.to_string()).collect();
        format!("--free {LENGTH}: step.by_speed has no row for {forward} m/s, only for {}", speeds.join(", "))
    })?;
    Ok((row, rows[row][0]))
}

/// \[m/s\] Speed of the scene's last velocity command.
pub(super) fn forward(setup: &Setup) -> Option<f64> {
    setup.scene.commands.iter().rev().find_map(|(_, command)| match command {
        Command::Velocity(velocity) => Some(velocity.forward),
        _ => None,
    })
}
