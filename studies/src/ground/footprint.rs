//! Footprints of the undisturbed walk, and rectangles on the ground.

use chain::Chain;
use config::Setup;
use messages::{LEFT, RIGHT};
use recording::polygon::sole_corners;

use super::place::ALONG;
use crate::Error;

/// Where a sole stands.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Footprint {
    /// \[m\] @world Its corners, counter-clockwise.
    pub(super) corners: [[f64; 2]; 4],
}

/// A rectangle on the ground.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Rectangle {
    /// \[m\] @world
    pub(super) middle: [f64; 2],
    /// \[rad\] Of its length, counter-clockwise from x.
    pub(super) angle: f64,
    /// \[m\] Length and width.
    pub(super) size: [f64; 2],
}

impl Footprint {
    /// \[m\] @world The point at these shares of the first side and the one that ends where it begins.
    pub(super) fn point(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let [a, b, _, d] = &self.corners;
        std::array::from_fn(|k| a[k] + u * (b[k] - a[k]) + v * (d[k] - a[k]))
    }
}

impl Rectangle {
    /// Whether a point \[m\] @world lies inside.
    #[cfg(test)]
    pub(super) fn holds(&self, [x, y]: [f64; 2]) -> bool {
        let (sin, cos) = self.angle.sin_cos();
        let [dx, dy] = [x - self.middle[0], y - self.middle[1]];
        let [along, across] = [dx * cos + dy * sin, dy * cos - dx * sin];
        along.abs() <= 0.5 * self.size[0] && across.abs() <= 0.5 * self.size[1]
    }
}

/// Where the soles of the undisturbed walk stand within [`ALONG`].
///
/// # Errors
/// The robot does not get so far.
pub(super) fn footprints(setup: &Setup) -> Result<Vec<Footprint>, Error> {
    let mut chain = Chain::new(setup)?;
    let (mut stance, mut found) = (None, Vec::new());
    for _ in 0..(setup.scene.duration / setup.scene.cycle) as u64 {
        let c = chain.step();
        let carries = match c.controller_state.load_left {
            load if load >= 1.0 => Some(LEFT),
            load if load <= 0.0 => Some(RIGHT),
            _ => None,
        };
        // A foot that begins to carry alone lies flat.
        if let Some(foot) = carries.filter(|_| carries != stance) {
            stance = carries;
            let corners = sole_corners(&c.sim_state.feet[foot], &setup.robot.feet[foot].support);
            let x = corners.iter().map(|p| p[0]).sum::<f64>() / 4.0;
            if x > ALONG[1] {
                return Ok(found);
            }
            if x > ALONG[0] {
                found.push(Footprint { corners });
            }
        }
    }
    Err(format!("scene {}: the robot does not get {} m far by itself", setup.scene.name, ALONG[1]).into())
}
