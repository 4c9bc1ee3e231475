//! Quintics, splines and polylines: vectors of errata 2, smoothness at random knots, refusals.

use curves::reference::Spline;
use curves::{Path, Polyline, Sample};

/// Numbers in [0, 1) that are the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} instead of {b}");
}

fn sample(p: f64, v: f64, a: f64) -> Sample<1> {
    Sample { position: [p], velocity: [v], acceleration: [a] }
}

#[test]
fn quintic_of_errata_2_5() {
    let mut path = Path::<1, 4>::resting(0.0, [0.0]);
    assert!(path.push(&sample(0.0, 0.1, -0.2), &sample(0.3, -0.1, 0.5), 0.4));
    for (c, expected) in path.coefficients[0][0].into_iter().zip([0.0, 0.1, -0.1, 47.0, -179.21875, 181.25]) {
        close(c, expected, 1e-10);
    }
    let mut path = Path::<1, 4>::resting(0.0, [0.0]);
    assert!(path.push(&Sample::rest([0.0]), &Sample::rest([0.05]), 0.5));
    for (c, expected) in path.coefficients[0][0].into_iter().zip([0.0, 0.0, 0.0, 4.0, -12.0, 9.6]) {
        close(c, expected, 1e-12);
    }
    close(path.sample(0.25).velocity[0], 0.1875, 1e-12);
    let peak = (0..=5000).map(|k| path.sample(k as f64 * 1e-4).acceleration[0]).fold(0.0, f64::max);
    close(peak, 1.15470053838, 1e-6);
}

#[test]
fn paths_are_c2_at_random_knots() {
    let mut random = Random(1);
    for _ in 0..500 {
        let mut path = Path::<2, 8>::resting(random.next(), [0.0; 2]);
        let any = |r: &mut Random| Sample {
            position: [r.next(), -r.next()],
            velocity: [r.next() - 0.5, r.next()],
            acceleration: [5.0 * r.next(), -r.next()],
        };
        let mut last = any(&mut random);
        let mut knots = Vec::new();
        for _ in 0..8 {
            let next = any(&mut random);
            let end = path.end() + 0.05 + random.next();
            assert!(path.push(&last, &next, end));
            knots.push((end, next));
            last = next;
        }
        // Seen from the left, a piece reaches what it was told; from the right, the next one starts there.
        for (t, expected) in &knots[..7] {
            for (s, tolerance) in [(path.sample(t - 1e-9), 1e-5), (path.sample(*t), 1e-9)] {
                for d in 0..2 {
                    close(s.position[d], expected.position[d], tolerance);
                    close(s.velocity[d], expected.velocity[d], tolerance);
                    close(s.acceleration[d], expected.acceleration[d], 1e3 * tolerance);
                }
            }
        }
        let after = path.sample(path.end() + 1.0);
        for d in 0..2 {
            close(after.position[d], knots[7].1.position[d], 1e-9);
        }
        assert_eq!((after.velocity, after.acceleration), ([0.0; 2], [0.0; 2]));
    }
}

#[test]
fn paths_refuse_what_they_cannot_hold() {
    let rest = Sample::rest([1.0]);
    let mut path = Path::<1, 2>::resting(0.0, [1.0]);
    assert!(!path.push(&rest, &rest, 0.0), "zero length");
    assert!(!path.push(&rest, &rest, -1.0), "backwards");
    assert!(!path.push(&rest, &rest, f64::NAN), "no end");
    assert!(path.push(&rest, &rest, 1.0));
    assert!(path.push(&rest, &rest, 2.0));
    assert!(!path.push(&rest, &rest, 3.0), "full");
    assert_eq!(path.end(), 2.0);
    path.restart(5.0, [2.0]);
    assert_eq!((path.end(), path.sample(9.0)), (5.0, Sample::rest([2.0])));
}

#[test]
fn polylines_join_points_and_refuse_the_rest() {
    let mut line = Polyline::<1, 3>::empty();
    assert_eq!(line.sample(1.0), ([0.0], [0.0]));
    assert!(line.push(0.0, [1.0]));
    assert!(line.push(2.0, [2.0]));
    assert!(!line.push(2.0, [3.0]), "zero length");
    assert!(!line.push(f64::NAN, [3.0]), "no time");
    assert!(line.push(3.0, [0.0]));
    assert!(!line.push(4.0, [0.0]), "full");
    assert_eq!(line.sample(1.0), ([1.5], [0.5]));
    assert_eq!(line.sample(-1.0), ([1.0], [0.0]));
    assert_eq!(line.sample(9.0), ([0.0], [0.0]));
    line.clear();
    assert!(line.push(-1.0, [7.0]));
    assert_eq!(line.sample(0.0), ([7.0], [0.0]));
}

const KNOTS: [f64; 6] = [0.0, 0.1, 0.25, 0.45, 0.7, 1.0];
const POINTS: [f64; 6] = [0.0, 0.2, -0.1, 0.3, 0.5, 0.1];

#[test]
fn spline_of_errata_2_15() {
    let spline = Spline::<8>::new(&KNOTS).expect("ascending");
    let m = spline.curvatures(&POINTS);
    let expected = [0.0, -63.90843149, 53.0281049666, -17.6670437657, -7.62112641689, 0.0];
    for (m, e) in m.into_iter().zip(expected) {
        close(m, e, 1e-8);
    }
    let c = spline.coefficients(2, &POINTS, &m);
    for (c, e) in c.into_iter().zip([-58.9126239436, 26.5140524833, -0.946305538919, -0.1]) {
        close(c, e, 1e-9);
    }
    let g = spline.gradient(0.33);
    let value =
        [0.0601030145738, -0.233733945565, 0.817864909829, 0.410686683969, -0.0633960737339, 0.008475410927];
    let slope =
        [-0.0428029546816, 0.166455934873, -5.8286240323, 6.32708325015, -0.718117166877, 0.0960049688339];
    for k in 0..6 {
        close(g.value[k], value[k], 1e-11);
        close(g.slope[k], slope[k], 1e-10);
    }
    let s = spline.sample(&POINTS, &m, 0.33);
    close(s.value, -0.0361777706794, 1e-12);
    close(s.slope, 2.16482047869, 1e-10);
}

#[test]
fn splines_are_c2_and_linear_in_their_control_points() {
    let mut random = Random(7);
    for _ in 0..200 {
        let n = 2 + (random.next() * 14.0) as usize;
        let mut t = random.next() - 0.5;
        let knots: Vec<f64> = (0..n)
            .map(|_| {
                t += 0.02 + random.next();
                t
            })
            .collect();
        let p: Vec<f64> = (0..n).map(|_| random.next() - 0.5).collect();
        let spline = Spline::<16>::new(&knots).expect("ascending");
        let m = spline.curvatures(&p);
        assert_eq!((m[0], m[n - 1]), (0.0, 0.0));
        for i in 0..n {
            close(spline.sample(&p, &m, knots[i]).value, p[i], 1e-12);
            if i > 0 && i + 1 < n {
                let (left, right) = (spline.coefficients(i - 1, &p, &m), spline.coefficients(i, &p, &m));
                let h = knots[i] - knots[i - 1];
                let [a, b, c, _] = left;
                let scale = 1.0 + m[i].abs();
                close(c + h * (2.0 * b + 3.0 * a * h), right[2], 1e-10 * scale);
                close(2.0 * b + 6.0 * a * h, 2.0 * right[1], 1e-10 * scale);
            }
        }
        for _ in 0..5 {
            let t = knots[0] + random.next() * (knots[n - 1] - knots[0]);
            let (s, g) = (spline.sample(&p, &m, t), spline.gradient(t));
            let dot = |g: &[f64]| g.iter().zip(&p).map(|(g, p)| g * p).sum::<f64>();
            let scale = 1.0 + m.iter().fold(0.0f64, |x, m| x.max(m.abs()));
            close(dot(&g.value), s.value, 1e-11 * scale);
            close(dot(&g.slope), s.slope, 1e-11 * scale);
            close(dot(&g.curvature), s.curvature, 1e-11 * scale);
        }
    }
}

#[test]
fn splines_refuse_knots_that_do_not_ascend() {
    assert!(Spline::<4>::new(&[0.0]).is_none(), "one knot");
    assert!(Spline::<4>::new(&[0.0, 1.0, 1.0]).is_none(), "zero length");
    assert!(Spline::<4>::new(&[0.0, f64::NAN, 1.0]).is_none(), "not a number");
    assert!(Spline::<4>::new(&[0.0, f64::INFINITY]).is_none(), "no end");
    assert!(Spline::<4>::new(&[0.0, 1.0, 2.0, 3.0, 4.0]).is_none(), "full");
    let straight = Spline::<4>::new(&[0.0, 2.0]).expect("two knots");
    let m = straight.curvatures(&[1.0, 3.0]);
    close(straight.sample(&[1.0, 3.0], &m, 0.5).value, 1.5, 1e-15);
    assert!(straight.curvatures(&[1.0])[0].is_nan(), "a control point is missing");
}
