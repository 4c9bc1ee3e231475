//! What other programs did in the same scenes: files that `sh tests/peers/mujoco.sh --points FILE` wrote.

use std::path::Path;

use serde::Deserialize;
use serde_json::Value;

use super::Point;

/// Points of one program.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Peers {
    /// Name of the program.
    #[serde(default)]
    pub peer: String,
    /// Its version.
    #[serde(default)]
    pub version: Value,
    /// What it found; the fields are described in tests/peers/mujoco/peer.c.
    #[serde(default)]
    pub points: Vec<Value>,
}

impl Peers {
    /// Reads a file.
    ///
    /// # Errors
    /// It cannot be read or is no such file.
    pub fn load(path: &Path) -> Result<Self, String> {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        serde_json::from_str(&text).map_err(|e| {
            format!("{}: {e}; sh tests/peers/mujoco.sh --points FILE writes such a file", path.display())
        })
    }

    /// Points whose text fields are as listed: `&[("scene", "flight"), ("initial", "chain")]`.
    pub fn of<'a>(&'a self, fields: &'a [(&'a str, &'a str)]) -> impl Iterator<Item = &'a Value> {
        self.points.iter().filter(move |p| fields.iter().all(|(key, value)| p[*key] == **value))
    }

    /// A point of the program as one of ours, its error by `error` of its final state (empty if it diverged).
    pub fn point(&self, found: &Value, error: impl Fn(&[f64]) -> f64) -> Point {
        let state: Vec<f64> = found["state"]
            .as_array()
            .map(|s| s.iter().filter_map(Value::as_f64).collect())
            .unwrap_or_default();
        let diverged = found["diverged"] == true || state.is_empty();
        Point {
            scene: found["scene"].as_str().unwrap_or_default().into(),
            model: self.peer.clone(),
            method: format!("{} {}", self.peer, found["integrator"].as_str().unwrap_or_default()),
            step: found["step_s"].as_f64(),
            cpu_s_per_s: found["cpu_s_per_s"].as_f64(),
            error: if diverged { f64::NAN } else { error(&state) },
            diverged,
            ..Point::default()
        }
    }
}
