//! The support polygon: convex hull of the loaded soles.

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

    #[test]
    fn points_that_are_not_numbers_are_left_out() {
        let hull = convex_hull(&[[0.0, 0.0], [f64::NAN, 1.0], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(hull.len(), 3);
    }
}
