//! The support polygon: convex hull of what carries, and how far inside of it a point lies.

use messages::SimState;

/// A point on the ground \[m\].
pub type Point = [f64; 2];

/// Corners of a support rectangle (x back, x front, y right, y left) of a sole at (x, y, z, heading),
/// counter-clockwise.
pub fn sole_corners(sole: &[f64; 4], support: &[f64; 4]) -> [Point; 4] {
    let [back, front, right, left] = *support;
    let (sin, cos) = sole[3].sin_cos();
    [[front, left], [back, left], [back, right], [front, right]]
        .map(|[x, y]| [sole[0] + cos * x - sin * y, sole[1] + sin * x + cos * y])
}

/// Convex hull, counter-clockwise, without points on its edges (Andrew's monotone chain).
pub fn convex_hull(points: &[Point]) -> Vec<Point> {
    let mut sorted: Vec<Point> =
        points.iter().copied().filter(|p| p[0].is_finite() && p[1].is_finite()).collect();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut hull = chain(sorted.iter().copied());
    hull.extend(chain(sorted.into_iter().rev()));
    hull
}

/// Support of the simulated robot: hull of the contact points that carry, seen from above. A foot whose heel is up stands
/// on its toe only.
pub fn support_polygon(state: &SimState) -> Vec<Point> {
    convex_hull(&state.carrying().iter().map(|c| [c.place[0], c.place[1]]).collect::<Vec<_>>())
}

/// \[m\] @world Mean height of the contact points that carry: the plane of contact. None in the air.
pub fn contact_height(state: &SimState) -> Option<f64> {
    let carrying = state.carrying();
    (!carrying.is_empty()).then(|| carrying.iter().map(|c| c.place[2]).sum::<f64>() / carrying.len() as f64)
}

/// Zero-moment point of both feet of the simulated robot in the plane of contact (3.6); none while nothing carries it.
pub fn zero_moment_point(state: &SimState) -> Option<Point> {
    let z = contact_height(state)?;
    let (mut force, mut moment) = (0.0, [0.0; 2]);
    for (wrench, sole) in state.foot_wrench.iter().zip(&state.feet) {
        let ([fx, fy, fz], above) = (wrench.force, sole[2] - z);
        force += fz;
        moment[0] += wrench.moment[0] + sole[1] * fz - above * fy;
        moment[1] += wrench.moment[1] + above * fx - sole[0] * fz;
    }
    (force > 0.0).then(|| [-moment[1] / force, moment[0] / force])
}

/// \[m\] Distance of a point to the edge of a convex polygon (counter-clockwise), negative outside; a polygon without an
/// area has no inside. None of no polygon or of a point that is none.
pub fn margin(polygon: &[Point], p: Point) -> Option<f64> {
    if polygon.is_empty() || !p.iter().all(|x| x.is_finite()) {
        return None;
    }
    let mut inside = if polygon.len() < 3 { f64::NEG_INFINITY } else { f64::INFINITY };
    let mut nearest = f64::INFINITY;
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (e, d) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
        let length = e[0].hypot(e[1]).max(f64::MIN_POSITIVE);
        inside = inside.min((e[0] * d[1] - e[1] * d[0]) / length);
        let along = ((e[0] * d[0] + e[1] * d[1]) / (length * length).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        nearest = nearest.min((d[0] - along * e[0]).hypot(d[1] - along * e[1]));
    }
    Some(if inside >= 0.0 { inside } else { -nearest })
}

/// One half of the hull, without its last point, which begins the other half.
fn chain(points: impl Iterator<Item = Point>) -> Vec<Point> {
    let mut half: Vec<Point> = Vec::new();
    for p in points {
        while half.len() >= 2 && !turns_left(half[half.len() - 2], half[half.len() - 1], p) {
            half.pop();
        }
        half.push(p);
    }
    half.pop();
    half
}

fn turns_left(a: Point, b: Point, c: Point) -> bool {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hull_of_two_soles_leaves_out_inner_corners() {
        let support = [-0.125, 0.25, -0.0625, 0.0625]; // exact in binary
        let right = sole_corners(&[0.0, -0.125, 0.0, 0.0], &support);
        let left = sole_corners(&[0.0, 0.125, 0.0, 0.0], &support);
        let hull = convex_hull(&[right, left].concat());
        assert_eq!(hull, [[-0.125, -0.1875], [0.25, -0.1875], [0.25, 0.1875], [-0.125, 0.1875]]);
    }

    #[test]
    fn corners_turn_with_the_foot() {
        let corners = sole_corners(&[1.0, 2.0, 0.0, std::f64::consts::FRAC_PI_2], &[-0.1, 0.2, -0.05, 0.06]);
        // The front left corner (0.2, 0.06) turned by 90 degrees is (-0.06, 0.2).
        assert!((corners[0][0] - 0.94).abs() < 1e-12 && (corners[0][1] - 2.2).abs() < 1e-12);
    }

    /// Distances of a square by hand; a line or a point has no inside, nothing has no distance.
    #[test]
    fn margin_is_the_distance_to_the_edge() {
        let square = [[-0.2, -0.05], [0.2, -0.05], [0.2, 0.05], [-0.2, 0.05]];
        for (p, expected) in
            [([0.0, 0.0], 0.05), ([0.19, 0.0], 0.01), ([0.25, 0.0], -0.05), ([0.3, 0.15], -0.1f64.hypot(0.1))]
        {
            assert!((margin(&square, p).unwrap() - expected).abs() < 1e-15, "{p:?}");
        }
        assert!((margin(&square[..2], [0.0, 0.0]).unwrap() + 0.05).abs() < 1e-15);
        assert_eq!(margin(&square[..2], [0.1, -0.05]), Some(0.0));
        assert!((margin(&square[..1], [-0.2, 0.0]).unwrap() + 0.05).abs() < 1e-15);
        assert_eq!((margin(&[], [0.0; 2]), margin(&square, [f64::NAN, 0.0])), (None, None));
    }

    /// A foot on its toe, 2 cm of it: the heel of the sole is no support, and the zero-moment point is where the force acts,
    /// at whatever height the sole frame is.
    #[test]
    fn a_heel_that_is_up_carries_nothing() {
        let mut state = SimState { contacts: 4, ..SimState::default() };
        for (k, [x, y]) in [[0.1, -0.04], [0.1, 0.04], [0.12, -0.04], [0.12, 0.04]].into_iter().enumerate() {
            (state.contact[k].place, state.contact[k].normal) = ([x, y, 0.3], [0.0, 0.0, 1.0]);
        }
        state.contact[4].place = [9.0; 3]; // behind those that carry
        // The force acts at (0.115, 0.01) of the plane of contact; the sole frame is 5 cm above and 1 cm beside.
        let (force, lever): ([f64; 3], [f64; 3]) = ([30.0, -20.0, 600.0], [0.015, 0.01, -0.05]);
        state.feet[1] = [0.1, 0.0, 0.35, 0.0];
        state.foot_wrench[1].force = force;
        state.foot_wrench[1].moment = [
            lever[1] * force[2] - lever[2] * force[1],
            lever[2] * force[0] - lever[0] * force[2],
            lever[0] * force[1] - lever[1] * force[0],
        ];
        let p = zero_moment_point(&state).unwrap();
        assert!((p[0] - 0.115).abs() < 1e-12 && (p[1] - 0.01).abs() < 1e-12, "{p:?}");
        assert!((margin(&support_polygon(&state), p).unwrap() - 0.005).abs() < 1e-12);
        state.contacts = 0;
        assert!(support_polygon(&state).is_empty() && zero_moment_point(&state).is_none());
    }

    #[test]
    fn points_that_are_not_numbers_are_left_out() {
        let hull = convex_hull(&[[0.0, 0.0], [f64::NAN, 1.0], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(hull.len(), 3);
    }
}
