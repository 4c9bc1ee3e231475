//! Nearest points of triangles against a search of all candidates (F25); a node that rounds the edge of a board.

use environment::{Environment, Mesh, Object, Pose, Schedule, Surface, closest};
use nalgebra::Vector3;

use super::LimitRule::{AtMost, Within};
use super::{Bench, Findings, row};

/// Numbers from -1 to 1, the same in every run.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn point(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.next())
    }
}

/// Distance by trying the plane and every edge.
fn by_search(p: &Vector3<f64>, c: &[Vector3<f64>; 3]) -> f64 {
    let edge = |k: usize| {
        let (v, u) = (c[k], c[(k + 1) % 3] - c[k]);
        let t = ((p - v).dot(&u) / u.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (p - v - u * t).norm()
    };
    let n = (c[1] - c[0]).cross(&(c[2] - c[0]));
    let inside = (0..3).all(|k| (c[(k + 1) % 3] - c[k]).cross(&(p - c[k])).dot(&n) >= 0.0);
    let edges = (0..3).map(edge).fold(f64::INFINITY, f64::min);
    if inside && n.norm() > 1e-9 { edges.min(((p - c[0]).dot(&n) / n.norm()).abs()) } else { edges }
}

/// F25: any triangle, obtuse, flat and vanishing ones, from any side.
pub(super) fn nearest(_: &Bench) -> Findings {
    let mut dice = Dice(25);
    let mut most = 0.0_f64;
    for i in 0..200_000 {
        let (a, b, p) = (dice.point(), dice.point(), dice.point() * 2.0);
        let c = match i % 4 {
            0 => dice.point(),
            1 => a + (b - a) * (0.5 + 0.5 * dice.next()) + dice.point() * 1e-2, // obtuse, or nearly flat
            2 => a + (b - a) * (2.0 * dice.next()),                             // on a line
            _ => a,                                                             // an edge only
        };
        let corners = [a, b, c];
        most = most.max(((p - closest(&p, &corners).0).norm() - by_search(&p, &corners)).abs());
    }
    let regime = "nearest point of 200 000 triangles, all regions and degenerate ones: error";
    Ok(vec![row("F25", "m", AtMost).of(regime, [8e-15, most])])
}

/// A node that rounds the upper edge of a board at a distance of 2 mm, a quarter of a circle: gap and normal are continuous.
pub(super) fn edge(_: &Bench) -> Findings {
    let board = Mesh::cuboid([0.4, 0.3, 0.02])?;
    let pose = Pose::new([0.0, 0.0, 0.01], [0.0; 3]);
    let ground = Environment::new(vec![Object::new("board", board, None, Schedule::fixed(pose))]);
    let (radius, steps) = (2e-3, 1000);
    let turn = std::f64::consts::FRAC_PI_2 / f64::from(steps);
    let at = |k: i32| {
        let (s, c) = (turn * f64::from(k)).sin_cos();
        ground.query([0.2 + radius * s, 0.0, 0.02 + radius * c])
    };
    let (mut gap, mut largest, mut on_board) = (0.0_f64, 0.0_f64, true);
    for k in 1..=steps {
        let [before, now] = [at(k - 1), at(k)];
        gap = gap.max((now.gap - radius).abs());
        largest = largest.max(Vector3::from(before.normal).angle(&Vector3::from(now.normal)));
        on_board &= now.surface == Surface::Object(0);
    }
    let lost = ground.query([f64::NAN, 0.0, 0.02]);
    Ok(vec![
        row("E1", "m", AtMost)
            .of("node around the edge of a board, 2 mm away: error of the gap", [1e-16, gap])
            .says("no number: Surface::Far", lost.surface == Surface::Far && on_board),
        row("E1", "rad", Within(1e-6))
            .of("node around the edge, 1000 steps: largest turn of the normal", [turn, largest]),
    ])
}
