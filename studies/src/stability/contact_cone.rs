//! How much of the cone of all contact points a wrench uses up: both feet, at any height, on any slope (thesis 3.3.3).
//!
//! | symbol | name | unit | frame |
//! |---|---|---|---|
//! | p_i, n_i | place of a contact point, normal of the ground there | m, 1 | world |
//! | f_i | force of the ground at it; in its friction cone: its tangential part is at most mu n_i . f_i | N | world |
//! | w | sum of the f_i: force F, moment about the mean of the p_i | N, N m | world |
//! | w_0 | F_z upward, at the mean of the p_i | N, N m | world |
//! | k | what lies between w_0 and w could grow k times until no f_i bear it | 1 | |
//!
//! ```text
//! maximize k     subject to     sum of the wrenches of f_i = w_0 + k (w - w_0),     every f_i in its cone
//! ```
//!
//! The margin is 1 - 1/k: 1 in the middle, 0 on the border, negative where the wrench cannot be borne. Of a flat sole that
//! touches at its four corners it is what the closed form in [`super::cone`] says, but for the friction pyramids that one
//! takes instead of cones. A second-order cone program; the library is Clarabel.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT::SecondOrderConeT,
    SupportedConeT::ZeroConeT,
};
use contact::frame::frame;
use messages::ContactPoint;
use nalgebra::{Matrix3, Vector3};

use super::points::{LEAST_FORCE, Load};

/// \[m\] Length by which moments are made forces: of a foot.
const LENGTH: f64 = 0.1;

/// 1 - 1/k of the wrench `ground` on these contact points; none if the ground does not push or nothing touches it, or if not
/// even w_0 can be borne.
pub fn margin(contacts: &[ContactPoint], ground: &Load, mu: f64) -> Option<f64> {
    let f_z = ground.force.z;
    if !(f_z > LEAST_FORCE && f_z.is_finite() && mu > 0.0) || contacts.is_empty() {
        return None;
    }
    let places: Vec<Vector3<f64>> = contacts.iter().map(|c| Vector3::from(c.place)).collect();
    let middle = places.iter().sum::<Vector3<f64>>() / places.len() as f64;
    // All in units of F_z and of the foot: the program sees numbers about one.
    let moment = ground.moment_about(&middle) / (LENGTH * f_z);
    let tangential = ground.force / f_z - Vector3::z();
    let away: Vec<f64> = tangential.iter().chain(&moment).copied().collect();
    if away.iter().all(|x| x.abs() < 1e-12) {
        return Some(1.0);
    }
    let frames: Vec<Matrix3<f64>> = contacts.iter().map(|c| frame(&Vector3::from(c.normal))).collect();
    let arms: Vec<Vector3<f64>> = places.iter().map(|p| (p - middle) / LENGTH).collect();
    largest(&arms, &frames, &away, mu).map(|k| 1.0 - 1.0 / k)
}

/// k; infinite if nothing bounds it, none without a solution.
///
/// Variables: f_i in the axes of each contact (tangential, tangential, normal), then k.
fn largest(arms: &[Vector3<f64>], frames: &[Matrix3<f64>], away: &[f64], mu: f64) -> Option<f64> {
    let contacts = arms.len();
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for (i, (arm, axes)) in arms.iter().zip(frames).enumerate() {
        for (axis, (row, size)) in [(1, 1.0), (2, 1.0), (0, mu)].into_iter().enumerate() {
            // The wrench of a unit force along this axis, and its place in (mu f_n, f_t1, f_t2).
            let force = axes.column(axis).into_owned();
            rows.extend(0..6);
            values.extend(force.iter().chain(&arm.cross(&force)));
            rows.push(6 + 3 * i + row);
            values.push(-size);
            starts.push(rows.len());
        }
    }
    rows.extend(0..6);
    values.extend(away.iter().map(|x| -x));
    starts.push(rows.len());
    let (n, m) = (3 * contacts + 1, 3 * contacts + 6);
    let equations = CscMatrix::new(m, n, starts, rows, values);
    let (mut right, mut cost) = (vec![0.0; m], vec![0.0; n]);
    right[2] = 1.0; // w_0
    cost[n - 1] = -1.0;
    let cones: Vec<_> =
        std::iter::once(ZeroConeT(6)).chain((0..contacts).map(|_| SecondOrderConeT(3))).collect();
    let settings = DefaultSettings { verbose: false, ..DefaultSettings::default() };
    let none = CscMatrix::zeros((n, n));
    let mut solver = DefaultSolver::new(&none, &cost, &equations, &right, &cones, settings).ok()?;
    solver.solve();
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => Some(solver.solution.x[n - 1]),
        SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => Some(f64::INFINITY),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::cone;
    use super::*;
    use nalgebra::{DMatrix, Vector6};

    const MU: f64 = 0.7;
    const HALF: [f64; 2] = [0.15, 0.04];

    fn contact(place: [f64; 3], normal: [f64; 3]) -> ContactPoint {
        ContactPoint { place, normal: Vector3::from(normal).normalize().into() }
    }

    fn sole([x0, x1]: [f64; 2], y: f64, z: f64) -> Vec<ContactPoint> {
        let corners = [[x0, -HALF[1]], [x0, HALF[1]], [x1, -HALF[1]], [x1, HALF[1]]];
        corners.map(|[x, side]| contact([x, y + side, z], [0.0, 0.0, 1.0])).to_vec()
    }

    /// A wrench about the origin.
    fn load(force: [f64; 3], moment: [f64; 3]) -> Load {
        Load { force: force.into(), moment: moment.into() }
    }

    fn near(contacts: &[ContactPoint], load: &Load, expected: f64) {
        let found = margin(contacts, load, MU).unwrap();
        assert!((found - expected).abs() < 1e-6, "{found}, expected {expected}");
    }

    struct Dice(u64);

    impl Dice {
        fn uniform(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
        }
    }

    /// Sliding and tipping of one flat sole are those of the closed form; turning about the vertical asks for mu hypot(X, Y)
    /// of each corner, where pyramids along the sides allow mu (X + Y).
    #[test]
    fn one_flat_sole_has_its_closed_form_limits() {
        let sole = sole([-HALF[0], HALF[0]], 0.0, 0.0);
        near(&sole, &load([0.0, 0.0, 100.0], [0.0; 3]), 1.0);
        near(&sole, &load([30.0, 40.0, 100.0], [0.0; 3]), 1.0 - 50.0 / 70.0);
        near(&sole, &load([0.0, 0.0, 100.0], [4.0, 0.0, 0.0]), 0.0);
        near(&sole, &load([0.0, 0.0, 100.0], [0.0, 7.5, 0.0]), 0.5);
        near(&sole, &load([0.0, 0.0, 100.0], [0.0, 0.0, 5.0]), 1.0 - 5.0 / (70.0 * HALF[0].hypot(HALF[1])));
        assert!(margin(&sole, &load([0.0, 0.0, 100.0], [0.0, 30.0, 0.0]), MU).unwrap() < 0.0);
    }

    /// Any wrench on a flat sole: the cone lies in the pyramids of the closed form, and holds those of mu/sqrt(2).
    #[test]
    fn one_flat_sole_lies_between_two_closed_forms() {
        let sole = sole([-HALF[0], HALF[0]], 0.0, 0.0);
        let mut dice = Dice(99);
        for _ in 0..300 {
            let force = [0.4 * dice.uniform(), 0.4 * dice.uniform(), 1.0];
            let moment = [0.06 * dice.uniform(), 0.2 * dice.uniform(), 0.1 * dice.uniform()];
            let found = margin(&sole, &load(force, moment), MU).unwrap();
            let closed = |mu| cone::margin(&force.into(), &moment.into(), HALF, mu).unwrap().0;
            let (narrow, wide) = (closed(MU / 2f64.sqrt()), closed(MU));
            assert!(found < wide + 1e-6 && found > narrow - 1e-6, "{narrow} {found} {wide}");
        }
    }

    /// Least distance of a wrench to the cone of forces along 32 directions of every contact's cone: least squares with shares
    /// that are not negative (Lawson and Hanson's active set).
    fn distance(contacts: &[ContactPoint], load: &Load, at: &Vector3<f64>) -> f64 {
        let wrench = |f: &Vector3<f64>, t: Vector3<f64>| {
            let t = t / 0.1;
            Vector6::new(f.x, f.y, f.z, t.x, t.y, t.z)
        };
        let edges = contacts.iter().flat_map(|c| {
            let (n, arm) = (Vector3::from(c.normal), Vector3::from(c.place) - at);
            let side = n.cross(&Vector3::new(0.3, 0.8, 0.1)).normalize();
            (0..32).map(move |k| {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 32.0).sin_cos();
                let f = n + MU * (cos * side + sin * n.cross(&side));
                wrench(&f, arm.cross(&f))
            })
        });
        let edges: Vec<Vector6<f64>> = edges.collect();
        let wanted = wrench(&load.force, load.moment_about(at));
        // Edges that take part, with their shares.
        let (mut part, mut share): (Vec<usize>, Vec<f64>) = (Vec::new(), Vec::new());
        for _ in 0..500 {
            let sum: Vector6<f64> = part.iter().zip(&share).map(|(&i, x)| edges[i] * *x).sum();
            let rest = wanted - sum;
            let others = (0..edges.len()).filter(|i| !part.contains(i));
            let next = others.max_by(|&a, &b| edges[a].dot(&rest).total_cmp(&edges[b].dot(&rest))).unwrap();
            if edges[next].dot(&rest) < 1e-9 {
                return rest.norm();
            }
            part.push(next);
            share.push(0.0);
            // Their best shares; those that would be negative leave, on the way there.
            loop {
                let matrix = DMatrix::from_fn(6, part.len(), |i, j| edges[part[j]][i]);
                let best = matrix.svd(true, true).solve(&wanted, 1e-12).unwrap();
                if best.iter().all(|x| *x > 0.0) {
                    share = best.iter().copied().collect();
                    break;
                }
                let falling = share.iter().zip(best.iter()).filter(|(_, best)| **best <= 0.0);
                let way = falling.map(|(x, best)| x / (x - best)).fold(1.0, f64::min);
                share.iter_mut().zip(best.iter()).for_each(|(x, best)| *x += way * (best - *x));
                let keep: Vec<bool> = share.iter().map(|x| *x > 1e-13).collect();
                let mut kept = keep.iter();
                part.retain(|_| *kept.next().unwrap());
                share.retain(|x| *x > 1e-13);
            }
        }
        panic!("no end of the active set");
    }

    /// The other route, where no closed form exists: feet on two steps of a stair, and on the two sides of a groove. A wrench a
    /// little inside of the border can be made of forces in the cones, one a little outside cannot.
    #[test]
    fn the_border_is_what_forces_in_the_cones_can_bear() {
        let stair = [sole([-0.15, 0.15], -0.1, 0.0), sole([0.1, 0.4], 0.1, 0.15)].concat();
        let mut groove = [sole([-0.15, 0.15], -0.1, 0.0), sole([-0.15, 0.15], 0.1, 0.0)].concat();
        for (i, c) in groove.iter_mut().enumerate() {
            *c = contact(c.place, [0.0, if i < 4 { 0.4 } else { -0.4 }, 1.0]);
        }
        let mut dice = Dice(7);
        for (name, contacts) in [("stair", stair), ("groove", groove)] {
            let middle =
                contacts.iter().map(|c| Vector3::from(c.place)).sum::<Vector3<f64>>() / contacts.len() as f64;
            for _ in 0..12 {
                let mut about = || [0.4 * dice.uniform(), 0.4 * dice.uniform(), 0.15 * dice.uniform()];
                let (force, moment) = (Vector3::from(about()), Vector3::from(about()) * 0.4);
                let at = |k: f64| {
                    let f = Vector3::new(k * force.x, k * force.y, 1.0);
                    Load { force: f, moment: k * moment + middle.cross(&f) }
                };
                let k = 1.0 / (1.0 - margin(&contacts, &at(1.0), MU).unwrap());
                // 32 edges miss half a per cent of the cone.
                let (inside, outside) = (
                    distance(&contacts, &at(0.98 * k), &middle),
                    distance(&contacts, &at(1.02 * k), &middle),
                );
                assert!(inside < 1e-6 && outside > 1e-3, "{name}: {inside:e} {outside:e}");
            }
        }
    }

    /// A foot of which only the front half is on a platform: what the flat sole takes for its middle is the edge.
    #[test]
    fn a_foot_on_the_edge_of_a_platform_is_nearer_to_tipping_than_its_sole() {
        let (whole, front) = (sole([-HALF[0], HALF[0]], 0.0, 0.0), sole([0.0, HALF[0]], 0.0, 0.0));
        for (x, on_sole, on_edge) in
            [(0.0, 1.0, 0.0), (0.03, 0.8, 0.4), (0.075, 0.5, 1.0), (-0.03, 0.8, -0.4)]
        {
            let pushed = load([0.0, 0.0, 100.0], [0.0, -100.0 * x, 0.0]);
            near(&whole, &pushed, on_sole);
            near(&front, &pushed, on_edge);
        }
    }

    /// Two feet in a groove: pushed aside, they wedge where flat ground would let them slide.
    #[test]
    fn feet_in_a_groove_bear_more_than_on_flat_ground() {
        let flat = [sole([-0.15, 0.15], -0.1, 0.0), sole([-0.15, 0.15], 0.1, 0.0)].concat();
        let mut groove = flat.clone();
        for (i, c) in groove.iter_mut().enumerate() {
            *c = contact(c.place, [0.0, if i < 4 { 0.4 } else { -0.4 }, 1.0]);
        }
        let pushed = load([0.0, 65.0, 100.0], [0.0; 3]);
        near(&flat, &pushed, 1.0 - 65.0 / 70.0);
        assert!(margin(&groove, &pushed, MU).unwrap() > 0.15, "{:?}", margin(&groove, &pushed, MU));
    }

    #[test]
    fn nothing_to_stand_on_is_no_margin() {
        let sole = sole([-0.1, 0.1], 0.0, 0.0);
        assert_eq!(margin(&[], &load([0.0, 0.0, 1.0], [0.0; 3]), MU), None);
        assert_eq!(margin(&sole, &load([0.0, 0.0, -1.0], [0.0; 3]), MU), None);
        assert_eq!(margin(&sole, &load([0.0, 0.0, f64::NAN], [0.0; 3]), MU), None);
        assert_eq!(margin(&sole, &load([0.0, 0.0, 1.0], [0.0; 3]), 0.0), None);
        // A wall carries no weight without friction that reaches.
        let wall = [contact([0.0; 3], [1.0, 0.0, 0.0]), contact([0.0, 0.1, 0.0], [1.0, 0.0, 0.0])];
        assert_eq!(margin(&wall, &load([0.0, 0.0, 1.0], [0.1, 0.0, 0.0]), MU), None);
    }
}
