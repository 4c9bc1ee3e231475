//! Soles of a plan in motion: footprints and pitch as one.

use crate::Plan;
use curves::Sample;

impl Plan {
    /// Sole frame of `foot` at plan time `t` \[s\]: x, y, z \[m\] and heading \[rad\] of its origin; and its pitch \[rad\].
    /// `edges` \[m\] are the rear and the front edge of the sole in its frame.
    pub fn sole(&self, foot: usize, t: f64, edges: [f64; 2]) -> (Sample<4>, Sample<1>) {
        let (flat, pitch) = (self.feet[foot].sample(t), self.pitch[foot].sample(t));
        let sole = if self.pitch_height != 0.0 && self.swings(foot, t) {
            pitched(&flat, &pitch, [0.0, self.pitch_height])
        } else {
            rolled(&flat, &pitch, edges)
        };
        (sole, pitch)
    }
}

/// Sole frame of a foot whose footprint is at `flat` and whose sole is pitched about one of its edges \[m\]: toes down
/// about the front one, toes up about the rear one. That edge stays in the footprint: the rolling condition (4.5).
fn rolled(flat: &Sample<4>, pitch: &Sample<1>, [rear, front]: [f64; 2]) -> Sample<4> {
    pitched(flat, pitch, [if pitch.position[0] < 0.0 { rear } else { front }, 0.0])
}

/// Sole frame of a foot that would be at `flat`, pitched about a point of it: \[m\] forward of its origin and over it.
fn pitched(flat: &Sample<4>, pitch: &Sample<1>, [ahead, over]: [f64; 2]) -> Sample<4> {
    let (angle, rate, second) = (pitch.position[0], pitch.velocity[0], pitch.acceleration[0]);
    if angle == 0.0 && rate == 0.0 && second == 0.0 {
        return *flat;
    }
    // Way of the sole's origin while it turns about the point, forward and up, with both derivatives.
    let (s, c) = angle.sin_cos();
    let (x, z) = (ahead, over);
    let (turns, swings) = (c * rate * rate + s * second, c * second - s * rate * rate);
    let forward = [x * (1.0 - c) - z * s, x * s * rate - z * c * rate, x * turns - z * swings];
    let up = [x * s + z * (1.0 - c), x * c * rate + z * s * rate, x * swings + z * turns];
    // The same along the axes of the planning frame, in which the foot's heading may turn meanwhile.
    let (sin, cos) = flat.position[3].sin_cos();
    let (turn, turning) = (flat.velocity[3], flat.acceleration[3]);
    let mut sole = *flat;
    for (d, axis, across) in [(0, cos, -sin), (1, sin, cos)] {
        sole.position[d] += forward[0] * axis;
        sole.velocity[d] += forward[1] * axis + forward[0] * turn * across;
        sole.acceleration[d] += forward[2] * axis + (2.0 * forward[1] * turn + forward[0] * turning) * across
            - forward[0] * turn * turn * axis;
    }
    sole.position[2] += up[0];
    sole.velocity[2] += up[1];
    sole.acceleration[2] += up[2];
    sole
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The edge stays where it is and the derivatives are those of the positions, on a foot that turns meanwhile.
    #[test]
    fn a_foot_rolls_over_its_edge_without_slipping() {
        let edges = [-0.255, 0.035];
        let flat = |t: f64| Sample {
            position: [0.3, 0.1, 0.02, 0.4 + 0.5 * t + t * t],
            velocity: [0.0, 0.0, 0.0, 0.5 + 2.0 * t],
            acceleration: [0.0, 0.0, 0.0, 2.0],
        };
        for (sign, edge) in [(1.0, edges[1]), (-1.0, edges[0])] {
            let pitch = |t: f64| Sample {
                position: [sign * (0.1 + 0.8 * t - t * t)],
                velocity: [sign * (0.8 - 2.0 * t)],
                acceleration: [sign * -2.0],
            };
            let at = |t: f64| rolled(&flat(t), &pitch(t), edges);
            let (t, h) = (0.1, 1e-4);
            let [now, before, after] = [at(t), at(t - h), at(t + h)];
            for d in 0..3 {
                let rate = (after.position[d] - before.position[d]) / (2.0 * h);
                let second = (after.velocity[d] - before.velocity[d]) / (2.0 * h);
                assert!((now.velocity[d] - rate).abs() < 1e-7, "{d}: {} is {rate}", now.velocity[d]);
                assert!((now.acceleration[d] - second).abs() < 1e-6, "{d}");
            }
            // The edge in the world: sole frame, heading, pitch.
            let (angle, heading) = (pitch(t).position[0], flat(t).position[3]);
            let forward = edge * angle.cos();
            let p = now.position;
            let touching =
                [p[0] + forward * heading.cos(), p[1] + forward * heading.sin(), p[2] - edge * angle.sin()];
            let footprint = [0.3 + edge * heading.cos(), 0.1 + edge * heading.sin(), 0.02];
            for d in 0..3 {
                assert!((touching[d] - footprint[d]).abs() < 1e-15);
            }
            assert!(p[2] > 0.02, "no part of the sole is under the ground");
        }
        assert_eq!(rolled(&flat(0.1), &Sample::rest([0.0]), edges), flat(0.1));
    }

    /// Archie's ankle, 5.6 cm over a sole that ends 12.5 cm in front of it and 6.5 cm behind, on the toe and on the heel \[cm\]:
    /// errata of his thesis, V7.
    #[test]
    fn ankle_of_a_foot_on_its_toe_and_on_its_heel() {
        for (angle, [forward, up]) in
            [(0.2f64, [1.361716029437, 7.971739470849]), (-0.3, [-1.945225977987, 7.270765682402])]
        {
            let sole = rolled(&Sample::rest([0.0; 4]), &Sample::rest([angle]), [-0.065, 0.125]);
            let [x, _, z, _] = sole.position;
            let ankle = [x + 0.056 * angle.sin(), z + 0.056 * angle.cos()];
            for (is, printed) in ankle.into_iter().zip([forward, up]) {
                assert!((100.0 * is - printed).abs() < 1e-11, "{angle}: {is} is {printed}");
            }
        }
    }

    /// A foot that swings pitches about its ankle, and passes zero without a jump of it; about its edges, it would jump.
    #[test]
    fn a_foot_pitches_about_its_ankle() {
        let ankle = 0.056;
        let flat = Sample::rest([0.3, 0.1, 0.02, 0.4]);
        for angle in [-0.3, -1e-3, 0.0, 1e-3, 0.2] {
            let pitch = Sample { position: [angle], velocity: [-0.61], acceleration: [1.5] };
            let sole = pitched(&flat, &pitch, [0.0, ankle]);
            let (s, c) = angle.sin_cos();
            let (heading, p) = (flat.position[3], sole.position);
            let over = [p[0] + ankle * s * heading.cos(), p[1] + ankle * s * heading.sin(), p[2] + ankle * c];
            for (is, must) in over.into_iter().zip([0.3, 0.1, 0.02 + ankle]) {
                assert!((is - must).abs() < 1e-15, "{angle}: {is} is {must}");
            }
            // Its velocity is that of a point under a resting ankle.
            let forward = sole.velocity[0] * heading.cos() + sole.velocity[1] * heading.sin();
            assert!(
                (forward - 0.61 * ankle * c).abs() < 1e-15
                    && (sole.velocity[2] + 0.61 * ankle * s).abs() < 1e-15
            );
        }
    }
}
