//! What must hold for every plan, computed by other routes than the planner's.

use super::{CYCLE, SUPPORT};
use config::Gait;
use curves::Sample;
use messages::{LEFT, Plan, RIGHT};

const G: f64 = 9.81;

/// A point seen from a frame (x, y, heading) in the outer frame.
pub(crate) fn outer(frame: [f64; 3], p: [f64; 2]) -> [f64; 2] {
    let (s, c) = frame[2].sin_cos();
    [frame[0] + c * p[0] - s * p[1], frame[1] + s * p[0] + c * p[1]]
}

fn turned(frame: [f64; 3], v: [f64; 2]) -> [f64; 2] {
    outer([0.0, 0.0, frame[2]], v)
}

/// Convex hull of points, counter-clockwise (monotone chain).
pub(crate) fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
    let cross =
        |o: [f64; 2], a: [f64; 2], b: [f64; 2]| (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut h: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while h.len() > 1 && cross(h[h.len() - 2], h[h.len() - 1], p) <= 1e-12 {
                h.pop();
            }
            h.push(p);
        }
        h.pop();
        h
    };
    let mut lower = chain(&mut points.iter().copied());
    lower.extend(chain(&mut points.iter().rev().copied()));
    lower
}

/// Distance to the edge of a convex polygon, positive inside.
pub(crate) fn inside(polygon: &[[f64; 2]], p: [f64; 2]) -> f64 {
    (0..polygon.len())
        .map(|i| {
            let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
            let e = [b[0] - a[0], b[1] - a[1]];
            (e[0] * (p[1] - a[1]) - e[1] * (p[0] - a[0])) / e[0].hypot(e[1])
        })
        .fold(f64::INFINITY, f64::min)
}

pub(crate) fn sole(i: usize, pose: [f64; 3]) -> Vec<[f64; 2]> {
    let [back, front, right, left] = SUPPORT[i];
    [[back, right], [front, right], [front, left], [back, left]].into_iter().map(|c| outer(pose, c)).collect()
}

pub(crate) fn foot(plan: &Plan, i: usize, t: f64) -> [f64; 3] {
    let p = plan.feet[i].sample(t).position;
    [p[0], p[1], p[3]]
}

/// The foot in the air at `t`.
pub(crate) fn swinging(plan: &Plan, t: f64) -> Option<usize> {
    let s = plan.steps[..plan.step_count as usize].iter().find(|s| t > s.lift + 1e-9 && t < s.end - 1e-9);
    s.map(|s| 1 - s.stance as usize)
}

/// Support polygon at `t`.
pub(crate) fn support(plan: &Plan, t: f64) -> Vec<[f64; 2]> {
    let up = swinging(plan, t);
    hull((0..2).filter(|&i| Some(i) != up).flat_map(|i| sole(i, foot(plan, i, t))).collect())
}

/// Instants of a plan \[s\].
pub(crate) fn instants(plan: &Plan, spacing: f64) -> impl Iterator<Item = f64> {
    let n = (plan.end() / spacing) as usize;
    (0..=n).map(move |k| k as f64 * spacing)
}

/// Zero-moment point, at the height of the planned one, of three masses that move as the plan says.
pub(crate) fn implied_zmp(plan: &Plan, gait: &Gait, t: f64) -> [f64; 2] {
    let m_l = gait.model.leg_mass;
    let m_b = 1.0 - 2.0 * m_l;
    let com = plan.body.sample(t);
    let legs = [0, 1].map(|i| plan.feet[i].sample(t));
    let [ground] = plan.zmp_height.sample(t).0;
    let (mut force, mut moment) = (0.0, [0.0; 2]);
    let mut add = |m: f64, r: [f64; 3], a: [f64; 3]| {
        force += m * (a[2] + G);
        for d in 0..2 {
            moment[d] += m * (r[d] * (a[2] + G) - (r[2] - ground) * a[d]);
        }
    };
    let three = |s: &Sample<4>| {
        let (p, a) = (s.position, s.acceleration);
        ([p[0], p[1], p[2] + gait.model.leg_height], [a[0], a[1], a[2]])
    };
    let (l0, l1) = (three(&legs[0]), three(&legs[1]));
    add(m_l, l0.0, l0.1);
    add(m_l, l1.0, l1.1);
    let body =
        |c: [f64; 3], a: [f64; 3], b: [f64; 3]| std::array::from_fn(|d| (c[d] - m_l * (a[d] + b[d])) / m_b);
    add(m_b, body(com.position, l0.0, l1.0), body(com.acceleration, l0.1, l1.1));
    moment.map(|x| x / force)
}

/// Least distance of the planned zero-moment point to the edge of the support polygon.
pub(crate) fn zmp_margin(plan: &Plan) -> f64 {
    instants(plan, 0.005)
        .map(|t| inside(&support(plan, t), plan.zmp.sample(t).0))
        .fold(f64::INFINITY, f64::min)
}

/// Least distance of the zero-moment point of the planned motion to the edge of the support polygon.
pub(crate) fn implied_margin(plan: &Plan, gait: &Gait) -> f64 {
    instants(plan, 0.005)
        .map(|t| inside(&support(plan, t), implied_zmp(plan, gait, t)))
        .fold(f64::INFINITY, f64::min)
}

/// Largest distance between planned and implied zero-moment point.
pub(crate) fn zmp_error(plan: &Plan, gait: &Gait) -> f64 {
    instants(plan, 0.005)
        .map(|t| {
            let (a, b) = (plan.zmp.sample(t).0, implied_zmp(plan, gait, t));
            (a[0] - b[0]).hypot(a[1] - b[1])
        })
        .fold(0.0, f64::max)
}

/// Least distance of the centre of pressure of a loaded foot to the edge of its sole (gap 15).
pub(crate) fn sole_margin(plan: &Plan) -> f64 {
    instants(plan, 0.005)
        .map(|t| {
            let rho = plan.load_left.sample(t).position[0];
            assert!((-1e-12..=1.0 + 1e-12).contains(&rho), "load factor {rho} at {t}");
            let (r, l) = (foot(plan, RIGHT, t), foot(plan, LEFT, t));
            let p = plan.zmp.sample(t).0;
            // (4.64): both feet carry their share of the moment that is left about the weighted middle.
            let e = [0, 1].map(|d| p[d] - (1.0 - rho) * r[d] - rho * l[d]);
            let mut least = f64::INFINITY;
            for (i, f, load) in [(RIGHT, r, 1.0 - rho), (LEFT, l, rho)] {
                if load > 1e-9 {
                    least = least.min(inside(&sole(i, [0.0, 0.0, f[2]]), e));
                }
            }
            least
        })
        .fold(f64::INFINITY, f64::min)
}

/// Least lateral gap between the soles' rectangles: negative if they overlap.
pub(crate) fn feet_gap(plan: &Plan) -> f64 {
    instants(plan, 0.01)
        .map(|t| {
            let (a, b) = (sole(0, foot(plan, 0, t)), sole(1, foot(plan, 1, t)));
            // Separating axis: rectangles are apart if an edge of one separates them.
            let apart = |p: &[[f64; 2]], q: &[[f64; 2]]| {
                (0..4)
                    .map(|i| {
                        let (u, v) = (p[i], p[(i + 1) % 4]);
                        let n = [v[1] - u[1], u[0] - v[0]];
                        let len = n[0].hypot(n[1]);
                        q.iter()
                            .map(|c| (n[0] * (c[0] - u[0]) + n[1] * (c[1] - u[1])) / len)
                            .fold(f64::MAX, f64::min)
                    })
                    .fold(f64::MIN, f64::max)
            };
            apart(&a, &b).max(apart(&b, &a))
        })
        .fold(f64::INFINITY, f64::min)
}

/// Largest difference of position, velocity and acceleration between two plans where the second one begins.
pub(crate) fn seam(before: &Plan, after: &Plan) -> f64 {
    seam_of(before, after, CYCLE)
}

/// The same with cycles of another length \[s\].
pub(crate) fn seam_of(before: &Plan, after: &Plan, cycle: f64) -> f64 {
    let t = (after.start_tick - before.start_tick) as f64 * cycle;
    let mut worst = 0.0f64;
    let mut compare = |a: f64, b: f64| worst = worst.max((a - b).abs());
    let planar = |frame: [f64; 3], p: &[f64], v: &[f64], a: &[f64]| {
        [outer(frame, [p[0], p[1]]), turned(frame, [v[0], v[1]]), turned(frame, [a[0], a[1]])]
    };
    let (c0, c1) = (before.body.sample(t), after.body.sample(0.0));
    let a = planar(before.origin, &c0.position, &c0.velocity, &c0.acceleration);
    let b = planar(after.origin, &c1.position, &c1.velocity, &c1.acceleration);
    for k in 0..3 {
        for d in 0..2 {
            compare(a[k][d], b[k][d]);
        }
    }
    compare(before.height + c0.position[2], after.height + c1.position[2]);
    compare(c0.velocity[2], c1.velocity[2]);
    compare(c0.acceleration[2], c1.acceleration[2]);
    for i in 0..2 {
        let (f0, f1) = (before.feet[i].sample(t), after.feet[i].sample(0.0));
        let a = planar(before.origin, &f0.position, &f0.velocity, &f0.acceleration);
        let b = planar(after.origin, &f1.position, &f1.velocity, &f1.acceleration);
        for k in 0..3 {
            for d in 0..2 {
                compare(a[k][d], b[k][d]);
            }
        }
        compare(before.height + f0.position[2], after.height + f1.position[2]);
        compare(f0.position[3] + before.origin[2], f1.position[3] + after.origin[2]);
        compare(f0.velocity[3], f1.velocity[3]);
    }
    for i in 0..2 {
        let rolls = [
            (&before.pitch[i].sample(t), &after.pitch[i].sample(0.0)),
            (&before.toes[i].sample(t), &after.toes[i].sample(0.0)),
        ];
        for (a, b) in rolls {
            compare(a.position[0], b.position[0]);
            compare(a.velocity[0], b.velocity[0]);
            compare(a.acceleration[0], b.acceleration[0]);
        }
    }
    let (u0, u1) = (before.torso.sample(t), after.torso.sample(0.0));
    for d in 0..3 {
        let shift = if d == 2 { after.origin[2] - before.origin[2] } else { 0.0 };
        compare(u0.position[d], u1.position[d] + shift);
        compare(u0.velocity[d], u1.velocity[d]);
        compare(u0.acceleration[d], u1.acceleration[d]);
    }
    compare(before.load_left.sample(t).position[0], after.load_left.sample(0.0).position[0]);
    let (p0, p1) =
        (outer(before.origin, before.zmp.sample(t).0), outer(after.origin, after.zmp.sample(0.0).0));
    compare(p0[0], p1[0]);
    compare(p0[1], p1[1]);
    let (h0, h1) = (before.zmp_height.sample(t).0, after.zmp_height.sample(0.0).0);
    compare(before.height + h0[0], after.height + h1[0]);
    worst
}

/// How far from standing a plan ends: motion, distance of the centre of gravity from where it should stand, and of the
/// feet from standing side by side.
pub(crate) fn unrest(plan: &Plan, gait: &Gait) -> f64 {
    let end = plan.end();
    let c = plan.body.sample(end - 1e-12);
    let mut worst = c.velocity.iter().chain(&c.acceleration).map(|x| x.abs()).fold(0.0, f64::max);
    let (r, l) = (foot(plan, RIGHT, end), foot(plan, LEFT, end));
    let (s, co) = (0.5 * (r[2] + l[2])).sin_cos();
    let goal =
        [0.5 * (r[0] + l[0]) + co * gait.model.com_forward, 0.5 * (r[1] + l[1]) + s * gait.model.com_forward];
    worst = worst.max((c.position[0] - goal[0]).hypot(c.position[1] - goal[1]));
    if plan.step_count > 0 {
        let d = turned([0.0, 0.0, -r[2]], [l[0] - r[0], l[1] - r[1]]);
        worst = worst.max(d[0].abs()).max((d[1] - gait.step.width).abs()).max((l[2] - r[2]).abs());
    }
    worst
}
