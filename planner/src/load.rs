//! Load factors: how much each foot carries (thesis 4.8, (4.62); gap 15).

use curves::{Path, Sample};

/// Load factor rho of the left foot over time.
pub type LoadPath = Path<1, 16>;

/// Appends a change of the left foot's load to `to` between the present end (or `begin`) and `end`: the smoothstep
/// quintic, at rest on both sides.
pub fn shift(path: &mut LoadPath, from: f64, to: f64, end: f64) {
    path.push(&Sample::rest([from]), &Sample::rest([to]), end);
}
