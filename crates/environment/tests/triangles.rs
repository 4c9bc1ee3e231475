//! The nearest point of a triangle, against the vectors of errata 1 and against what makes a point the nearest one.

use environment::{Feature, closest};
use nalgebra::Vector3;
use proptest::prelude::*;

type V = Vector3<f64>;

/// V8 of errata 1: corners, point, feature, nearest point, distance.
#[test]
fn vectors_of_the_errata() {
    let cases = [
        ([0., 0., 0., 1., 0., 0., 0.3, 0.8, 0.], [0.4, 0.2, 0.5], Feature::Face, [0.4, 0.2, 0.0], 0.5),
        (
            [0., 0., 0., 1., 0., 0., 1.5, 0.6, 0.2],
            [1.2, -0.05, 0.1],
            Feature::Edge(1),
            [1.06923076923, 0.0830769230769, 0.0276923076923],
            0.200096130743,
        ),
        (
            [0., 0., 0., 1., 0., 0., -0.5, 0.9, 0.],
            [-0.25, -0.1, 0.1],
            Feature::Edge(2),
            [-0.0165094339623, 0.0297169811321, 0.0],
            0.285209290912,
        ),
        (
            [0., 0., 0., 1., 0., 0., 0., 1., 0.],
            [0.0, -0.5, 0.2],
            Feature::Vertex(0),
            [0.0; 3],
            0.538516480713,
        ),
        (
            [0., 0., 0., 1., 0., 0., 0., 1., 0.],
            [3.0, 0.1, 0.0],
            Feature::Vertex(1),
            [1.0, 0.0, 0.0],
            2.00249843945,
        ),
        (
            [0.2, 0.1, 0.3, 1.1, -0.2, 0.5, 0.4, 0.9, -0.1],
            [1.6, 0.8, 0.9],
            Feature::Edge(1),
            [0.926699029126, 0.0723300970874, 0.35145631068],
            1.13302156382,
        ),
        (
            [0., 0., 0., 1., 0., 0., 0.5, 0.2, 0.],
            [0.2, 0.6, 0.0],
            Feature::Edge(2),
            [0.379310344828, 0.151724137931, 0.0],
            0.48280787926,
        ),
    ];
    for (corners, p, feature, point, distance) in cases {
        let corners: [V; 3] = std::array::from_fn(|i| V::from_column_slice(&corners[3 * i..3 * i + 3]));
        let p = V::from(p);
        let (found, region) = closest(&p, &corners);
        assert_eq!(region, feature, "{p:?}");
        assert!(
            (found - V::from(point)).norm() < 1e-11 && ((found - p).norm() - distance).abs() < 1e-11,
            "{found:?}"
        );
    }
}

/// A point c of a convex set is the nearest to p just when (p - c) . (v - c) <= 0 for all v of the set; for a triangle,
/// for its corners. And c is in the triangle when the three triangles it makes with the edges are together as large.
fn is_nearest(p: &V, corners: &[V; 3], c: &V, tolerance: f64) -> bool {
    let area = |a: &V, b: &V, c: &V| (b - a).cross(&(c - a)).norm() / 2.0;
    let [v0, v1, v2] = corners;
    let parts = area(c, v0, v1) + area(c, v1, v2) + area(c, v2, v0);
    let longest = (v1 - v0).norm().max((v2 - v1).norm()).max((v0 - v2).norm());
    corners.iter().all(|v| (p - c).dot(&(v - c)) <= tolerance)
        && parts - area(v0, v1, v2) <= tolerance * longest.max(1e-3)
}

fn place(range: f64) -> impl Strategy<Value = V> {
    prop::array::uniform3(-range..range).prop_map(V::from)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, ..ProptestConfig::default() })]

    #[test]
    fn any_triangle(corners in prop::array::uniform3(place(1.0)), p in place(2.0)) {
        let (u, v) = (corners[1] - corners[0], corners[2] - corners[0]);
        prop_assume!(u.cross(&v).norm() > 1e-2); // needles have a test of their own
        let (c, _) = closest(&p, &corners);
        prop_assert!(is_nearest(&p, &corners, &c, 1e-12), "{c:?}");
    }

    /// The angle at one corner from 91 to 179 degrees, in every order of corners.
    #[test]
    fn obtuse(degrees in 91.0..179.0f64, length in 0.1..1.0f64, turn in 0usize..3, p in place(2.0)) {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let mut corners = [V::zeros(), V::x(), V::new(cos, sin, 0.0) * length];
        corners.rotate_left(turn);
        let (c, _) = closest(&p, &corners);
        prop_assert!(is_nearest(&p, &corners, &c, 1e-12), "{c:?}");
    }

    /// On the edges, on their extensions and on the corners: where table 2.2 has no region.
    #[test]
    fn on_edges(corners in prop::array::uniform3(place(1.0)), k in 0usize..3, t in -1.0..2.0f64, snap in 0usize..4) {
        let (u, v) = (corners[1] - corners[0], corners[2] - corners[0]);
        prop_assume!(u.cross(&v).norm() > 1e-2);
        let t = [t, 0.0, 1.0, 0.5][snap];
        let p = corners[k] + (corners[(k + 1) % 3] - corners[k]) * t;
        let (c, _) = closest(&p, &corners);
        prop_assert!(is_nearest(&p, &corners, &c, 1e-12), "{c:?}");
        prop_assert!((0.0..=1.0).contains(&t) <= ((c - p).norm() < 1e-12));
    }

    /// Three corners on a line, two equal ones, three equal ones: the distance to the segment or point they are.
    #[test]
    fn degenerate(a in place(1.0), b in place(1.0), t in -1.0..2.0f64, kind in 0usize..5, p in place(2.0)) {
        let corners = [[a, b, a + (b - a) * t], [a, a, b], [a, b, a], [b, a, a], [a, a, a]][kind];
        let (c, _) = closest(&p, &corners);
        prop_assert!((p - c).norm().is_finite());
        prop_assert!(is_nearest(&p, &corners, &c, 1e-12), "{c:?}");
    }

    /// Needles: their normal is only known to rounding over their height.
    #[test]
    fn needles(height in -9.0..-2.0f64, foot in -0.5..1.5f64, p in place(2.0)) {
        let height = 10f64.powf(height);
        let corners = [V::zeros(), V::new(1.0, 0.3, 0.2), V::new(foot, 0.3 * foot, 0.2 * foot + height)];
        let (c, _) = closest(&p, &corners);
        let tolerance = (1e-15 / height).clamp(1e-12, 4e-8);
        prop_assert!(is_nearest(&p, &corners, &c, 4.0 * tolerance), "{c:?}");
    }
}
