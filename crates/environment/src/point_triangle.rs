//! The point of a triangle that lies nearest to a point, and the region of figure 2.15 it was found in.
//!
//! Table 2.2 of the thesis sorts the seven regions wrongly unless the right angle is at v0 (errata 1, F8): its vertex
//! regions are too large for obtuse triangles, and points on the axes of an axis-aligned triangle are in no region. Here
//! the regions are those of the vertices first, then of the edges, then of the face.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | a, b, c | corners v0, v1, v2 (2.52) | m |
//! | p | the point asked for | m |
//! | d1..d6 | projections of p - corner on the two edges from a | m^2 |
//! | va, vb, vc | barycentric coordinates of p's projection, times the squared double area | m^4 |

use nalgebra::Vector3;

/// Part of the triangle that the nearest point lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// R_0: inside.
    Face,
    /// On the edge from corner k to corner k + 1.
    Edge(u8),
    /// On corner k.
    Vertex(u8),
}

/// Nearest point \[m\] of the triangle `a`, `b`, `c` to `p`. Degenerate triangles are taken as the segments or the point
/// they are.
pub fn closest(p: &Vector3<f64>, corners: &[Vector3<f64>; 3]) -> (Vector3<f64>, Feature) {
    let [a, b, c] = corners;
    if degenerate(&(b - a), &(c - a)) {
        return closest_on_edges(p, corners);
    }
    closest_of_face(p, corners)
}

/// As [`closest`], of a triangle that is known not to be degenerate: those of a [`crate::Mesh`] are not.
#[inline]
pub(crate) fn closest_of_face(p: &Vector3<f64>, corners: &[Vector3<f64>; 3]) -> (Vector3<f64>, Feature) {
    let [a, b, c] = corners;
    let (ab, ac) = (b - a, c - a);
    let ap = p - a;
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (*a, Feature::Vertex(0));
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (*b, Feature::Vertex(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (a + ab * (d1 / (d1 - d3)), Feature::Edge(0));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (*c, Feature::Vertex(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (a + ac * (d2 / (d2 - d6)), Feature::Edge(2));
    }
    let va = d3 * d6 - d5 * d4;
    let (e, f) = (d4 - d3, d5 - d6);
    if va <= 0.0 && e >= 0.0 && f >= 0.0 {
        return (b + (c - b) * (e / (e + f)), Feature::Edge(1));
    }
    // The projection along the normal: exact to rounding in p's height, which va, vb, vc are not.
    let n = ab.cross(&ac);
    (p - n * (n.dot(&ap) / n.norm_squared()), Feature::Face)
}

/// Is the height over the longer of the two edges so small that the regions of the face cannot be told apart?
pub(crate) fn degenerate(ab: &Vector3<f64>, ac: &Vector3<f64>) -> bool {
    let longest = ab.norm_squared().max(ac.norm_squared());
    // A height of 1e-8 of the length: taking it as a segment errs by that height, taking it as a triangle by the rounding
    // of its normal, 1e-16 over the height; here the two are equal.
    ab.cross(ac).norm_squared() <= 1e-16 * longest * longest
}

/// The nearest of the three points clamped to the edges (errata 1, F8).
fn closest_on_edges(p: &Vector3<f64>, corners: &[Vector3<f64>; 3]) -> (Vector3<f64>, Feature) {
    let mut best = (corners[0], Feature::Vertex(0));
    let mut nearest = f64::INFINITY;
    for k in 0..3u8 {
        let (v, w) = (corners[usize::from(k)], corners[usize::from((k + 1) % 3)]);
        let u = w - v;
        let length = u.norm_squared();
        let t = if length > 0.0 { ((p - v).dot(&u) / length).clamp(0.0, 1.0) } else { 0.0 };
        let (point, feature) = match t {
            0.0 => (v, Feature::Vertex(k)),
            1.0 => (w, Feature::Vertex((k + 1) % 3)),
            _ => (v + u * t, Feature::Edge(k)),
        };
        let d = (p - point).norm_squared();
        if d < nearest {
            (best, nearest) = ((point, feature), d);
        }
    }
    best
}
