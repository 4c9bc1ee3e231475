//! Methods against one another, and where they fail: closed form and collocation, direct construction and sweeps.

use planner::boundary::{BoundaryProblem, BoundarySolver, EndConditions, MAX_KNOTS, PlanarState};
use planner::closed_form::ClosedForm;
use planner::collocation::Collocation;
use planner::pose::PlanarPose;
use planner::sole::{Hull, Sole};
use planner::verdict::PlanVerdict;
use planner::zmp::{MAX_NODES, ZmpProblem};

const G: f64 = 9.81;
const HEIGHT: f64 = 0.9;

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} instead of {b}");
}

/// Numbers in [0, 1) that are the same in every run.
fn dice(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Steps straight on, `steps` of them, from one foot to the next: the zero-moment point's way.
fn walk(steps: usize, step: f64) -> ZmpProblem {
    let sole = Sole { center: [0.0; 2], half: [0.1, 0.03] };
    let mut chain = ZmpProblem::new();
    let foot = |k: usize| PlanarPose::new(step * k as f64, if k.is_multiple_of(2) { -0.1 } else { 0.1 }, 0.0);
    chain.fix(0.0, [0.0, -0.1]);
    for k in 1..=steps {
        let begin = 0.8 * (k - 1) as f64;
        chain.hold(begin + 0.16, &sole, &foot(k));
        if k < steps {
            chain.hold(begin + 0.8, &sole, &foot(k));
        }
    }
    let end = foot(steps);
    chain.fix(0.8 * steps as f64, [end.x, end.y]);
    assert_eq!(chain.solve(), PlanVerdict::Sound);
    chain
}

/// A state from which the walk can begin.
const BEGIN: PlanarState = PlanarState { r: [0.01, -0.05], v: [0.2, 0.15] };

/// One mass over the zero-moment point `p`, which may be moved by a hat of unit height between the instants `hat`.
fn pose(problem: &mut BoundaryProblem, knots: &[f64], p: impl Fn(f64) -> [f64; 2], hat: [f64; 3]) {
    let om2 = G / HEIGHT;
    let rise = |t: f64| ((t - hat[0]) / (hat[1] - hat[0])).min((hat[2] - t) / (hat[2] - hat[1])).max(0.0);
    let forces = |t: f64| {
        let [x, y] = p(t);
        [-om2 * x, -om2 * y, -om2 * rise(t), 0.0]
    };
    problem.n = knots.len();
    for (i, &t) in knots.iter().enumerate() {
        (problem.t[i], problem.om2[i], problem.f[i]) = (t, om2, forces(t));
        if let Some(next) = knots.get(i + 1) {
            problem.half[i] = forces(0.5 * (t + next));
        }
    }
}

/// The motion that begins with `begin` and ends at `goal`: the hat's amplitude is what meets the velocity.
fn ends(solver: &dyn BoundarySolver, begin: &PlanarState, goal: [f64; 2]) -> EndConditions {
    let slope = solver.ends().slopes[0];
    let gamma = [0, 1].map(|d| {
        let rest = begin.v[d] - slope[d] - slope[4] * begin.r[d] - slope[5] * goal[d];
        rest / slope[2]
    });
    EndConditions { begin: begin.r, end: goal, gamma: [gamma, [0.0; 2]] }
}

/// Straight lines through points.
fn lines(points: &[(f64, [f64; 2])], t: f64) -> [f64; 2] {
    let k = points.iter().position(|p| t < p.0).unwrap_or(points.len() - 1).max(1);
    let (a, b) = (points[k - 1], points[k]);
    [0, 1].map(|d| a.1[d] + (b.1[d] - a.1[d]) * (t - a.0) / (b.0 - a.0))
}

#[test]
fn closed_form_of_errata_2_6() {
    let times = [0.0, 0.1, 0.2, 0.8, 1.0, 1.6];
    let y = [0.0, 0.0, 0.08, 0.08, -0.08, -0.08];
    // The second axis has the numbers of the errata, the first one their double.
    let points: Vec<_> = times.into_iter().zip(y.map(|y| [2.0 * y, y])).collect();
    let knots = [0.0, 0.1, 0.2, 0.5, 0.8, 1.0, 1.6];
    let mut c = Box::new(ClosedForm::new());
    pose(&mut c.problem, &knots, |t| lines(&points, t), [0.0, 0.1, 0.2]);
    assert_eq!(c.solve(), PlanVerdict::Sound);
    let begin = PlanarState { r: [0.02, 0.01], v: [-0.04, -0.02] };
    let ends = ends(&*c, &begin, [0.0; 2]);
    let ([r, v, _], [r1, v1, _]) = (c.motion(3, &ends), c.motion(1, &ends));
    let w = (G / HEIGHT).sqrt();
    for (k, of) in [2.0, 1.0].into_iter().enumerate() {
        let free = ends.gamma[0][k];
        let s = free / 0.1 / w;
        close(free, of * -0.156265565435, 1e-12 * of);
        close(r[k], of * 0.042106936327, 1e-12 * of);
        close(v[k], of * -0.00584284513789, 1e-12 * of);
        close(0.5 * (r1[k] + v1[k] / w - free - s), of * 0.331974869599, 1e-12 * of); // a
        close(0.5 * (begin.r[k] - begin.v[k] / w + s), of * -0.228628462389, 1e-12 * of); // b
    }
}

/// Knots of the walk of some steps, no farther than `spacing` apart.
fn knots_of(reference: &ZmpProblem, spacing: f64) -> (Vec<f64>, [f64; 3]) {
    let mut marks: Vec<f64> = reference.nodes().iter().map(|n| n.time).collect();
    marks.insert(1, 0.5 * (marks[0] + marks[1]));
    let mut knots = vec![marks[0]];
    for w in marks.windows(2) {
        let n = ((w[1] - w[0]) / spacing - 1e-9).ceil().max(1.0) as usize;
        knots.extend((1..=n).map(|k| w[0] + (w[1] - w[0]) * k as f64 / n as f64));
    }
    (knots, [marks[0], marks[1], marks[2]])
}

/// 20 steps: the conditions at both ends are met, and from each knot the pendulum, by its own exponentials, comes to the
/// next one.
#[test]
fn closed_form_is_a_solution() {
    let reference = walk(20, 0.4);
    let (knots, hat) = knots_of(&reference, 0.1);
    let mut c = Box::new(ClosedForm::new());
    pose(&mut c.problem, &knots, |t| reference.at(t), hat);
    assert_eq!(c.solve(), PlanVerdict::Sound);
    let goal = [8.0, -0.02];
    let ends = ends(&*c, &BEGIN, goal);
    let w = (G / HEIGHT).sqrt();
    let p = |i: usize, d: usize| -(c.problem.f[i][d] + ends.gamma[0][d] * c.problem.f[i][2]) / (w * w);
    let ([r, v, _], [last, _, _]) = (c.motion(0, &ends), c.motion(knots.len() - 1, &ends));
    for d in 0..2 {
        close(r[d], BEGIN.r[d], 1e-12);
        close(v[d], BEGIN.v[d], 1e-12);
        close(last[d], goal[d], 1e-12);
    }
    for i in 0..knots.len() - 1 {
        let h = knots[i + 1] - knots[i];
        let ([r, v, _], [next, fast, _]) = (c.motion(i, &ends), c.motion(i + 1, &ends));
        for d in 0..2 {
            let s = (p(i + 1, d) - p(i, d)) / h;
            let (off, rate) = (r[d] - p(i, d), v[d] - s);
            let (sinh, cosh) = ((w * h).sinh(), (w * h).cosh());
            close(next[d], p(i + 1, d) + off * cosh + rate / w * sinh, 1e-10);
            close(fast[d], s + w * off * sinh + rate * cosh, 1e-10);
        }
    }
}

/// Largest distance between collocation with knots `spacing` apart and the closed form, on the same problem.
fn distance(steps: usize, spacing: f64) -> f64 {
    let reference = walk(steps, 0.4);
    let (knots, hat) = knots_of(&reference, spacing);
    let goal = [0.4 * steps as f64, -0.02];
    let solved = |solver: &mut dyn BoundarySolver| {
        pose(solver.problem_mut(), &knots, |t| reference.at(t), hat);
        assert_eq!(solver.solve(), PlanVerdict::Sound);
        let ends = ends(solver, &BEGIN, goal);
        (0..knots.len()).map(|i| solver.motion(i, &ends)).collect::<Vec<_>>()
    };
    let a = solved(&mut *Box::new(ClosedForm::new()));
    let b = solved(&mut *Box::new(Collocation::new()));
    let mut worst = 0.0f64;
    for ([r, v, _], [q, u, _]) in a.iter().zip(&b) {
        for d in 0..2 {
            worst = worst.max((r[d] - q[d]).abs()).max(0.1 * (v[d] - u[d]).abs());
        }
    }
    worst
}

#[test]
fn closed_form_and_collocation_agree() {
    for steps in [3, 4] {
        let e = [0.04, 0.02].map(|h| distance(steps, h));
        assert!(e[1] < 2e-6 && e[0] / e[1] > 10.0, "{steps} steps: {e:?}"); // fourth order: 16
    }
    assert!(distance(20, 0.1) < 2e-3);
}

/// e^{w t} overflows after 215 s at this height (errata on (4.44)); here nothing grows.
#[test]
fn no_horizon_is_too_long() {
    let naive = (G / HEIGHT).sqrt() * 300.0;
    assert!(naive.exp().is_infinite());
    for (begin, length) in [(0.0, 300.0), (1e6, 300.0), (0.0, 1e5)] {
        let knots = [0.0, 0.05, 0.1, 0.5 * length, length].map(|t| begin + t);
        let mut c = Box::new(ClosedForm::new());
        pose(&mut c.problem, &knots, |_| [0.1, 0.02], [knots[0], knots[1], knots[2]]);
        assert_eq!(c.solve(), PlanVerdict::Sound);
        let ends = ends(&*c, &BEGIN, [0.3, -0.1]);
        let ([r, v, _], [middle, ..], [last, ..]) =
            (c.motion(0, &ends), c.motion(3, &ends), c.motion(4, &ends));
        for d in 0..2 {
            close(r[d], BEGIN.r[d], 1e-9);
            close(v[d], BEGIN.v[d], 1e-8);
            close(last[d], [0.3, -0.1][d], 1e-9);
            close(middle[d], [0.1, 0.02][d], 1e-9);
        }
    }
}

#[test]
fn closed_form_tells_what_is_wrong() {
    let verdict = |change: fn(&mut BoundaryProblem)| {
        let mut c = Box::new(ClosedForm::new());
        let knots: Vec<f64> = (0..21).map(|i| 0.08 * f64::from(i)).collect();
        pose(&mut c.problem, &knots, |_| [0.1, 0.02], [0.0, 0.08, 0.16]);
        change(&mut c.problem);
        c.solve()
    };
    assert_eq!(verdict(|_| ()), PlanVerdict::Sound);
    assert_eq!(verdict(|p| p.n = 2), PlanVerdict::Degenerate);
    assert_eq!(verdict(|p| p.n = MAX_KNOTS + 1), PlanVerdict::Degenerate);
    assert_eq!(verdict(|p| p.t[7] = p.t[6]), PlanVerdict::Degenerate);
    assert_eq!(verdict(|p| p.om2[9] = 0.0), PlanVerdict::Falling);
    assert_eq!(verdict(|p| p.om2[9] *= 1.01), PlanVerdict::NotOneMass, "the body climbs");
    assert_eq!(verdict(|p| p.half[9][1] += 0.01), PlanVerdict::NotOneMass, "a leg swings");
    assert_eq!(verdict(|p| p.f[9][0] = f64::NAN), PlanVerdict::NotFinite);
    assert_eq!(verdict(|p| p.t[9] = f64::NAN), PlanVerdict::NotFinite);
}

/// Chains of turned rectangles of random size.
fn random_chain(random: &mut impl FnMut() -> f64, feet: usize) -> ZmpProblem {
    let mut chain = ZmpProblem::new();
    let (mut t, mut x) = (0.0, 0.0);
    chain.fix(t, [random() * 0.1, random() * 0.1]);
    for _ in 0..feet {
        x += random() * 0.6;
        let at = PlanarPose::new(x, random() - 0.5, random() - 0.5);
        let sole = Sole { center: [0.02, 0.0], half: [0.05 + 0.1 * random(), 0.03] };
        for _ in 0..2 {
            t += 0.1 + random() * 0.6;
            chain.hold(t, &sole, &at);
        }
    }
    chain.fix(t + 0.3, [x, 0.0]);
    chain
}

#[test]
fn direct_construction_and_sweeps_agree() {
    let mut random = dice(11);
    let mut unsettled = 0;
    for k in 0..2000 {
        let mut direct = random_chain(&mut random, 2 + k % 8);
        let mut swept = direct;
        assert_eq!(swept.relax(100_000), PlanVerdict::Sound);
        if !direct.solve_directly() {
            unsettled += 1;
            continue;
        }
        for (a, b) in direct.nodes().iter().zip(swept.nodes()) {
            close(a.p[0], b.p[0], 1e-6); // sweeps stop when a step is below 1e-9, which is not where they would end
            close(a.p[1], b.p[1], 1e-6);
        }
    }
    assert!(unsettled <= 2, "{unsettled} of 2000 do not settle");
}

/// The triangle of errata 2.10 is no rectangle; its two boxes are: a taut string, by hand.
#[test]
fn direct_construction_is_a_taut_string() {
    let mut c = ZmpProblem::new();
    let box_at = |x: f64, y: f64| (Sole { center: [0.0; 2], half: [0.1, 0.05] }, PlanarPose::new(x, y, 0.0));
    c.fix(0.0, [0.0, 0.0]);
    let (sole, at) = box_at(0.1, 0.3); // y in [0.25, 0.35], x in [0, 0.2]
    c.hold(1.0, &sole, &at);
    let (sole, at) = box_at(0.6, -0.3); // y in [-0.35, -0.25], x in [0.5, 0.7]
    c.hold(2.0, &sole, &at);
    c.fix(4.0, [0.8, 0.0]);
    assert_eq!(c.solve(), PlanVerdict::Sound);
    // x: straight from (1, 0.2) to the end is (2, 0.4), outside of [0.5, 0.7]: the string bends at both boxes.
    for (node, p) in c.nodes()[1..3].iter().zip([[0.2, 0.25], [0.5, -0.25]]) {
        close(node.p[0], p[0], 1e-12);
        close(node.p[1], p[1], 1e-12);
    }
}

#[test]
fn reference_tells_what_is_wrong() {
    let sole = Sole { center: [0.0; 2], half: [0.1, 0.03] };
    let here = PlanarPose::default();
    let chain = |sole: &Sole, t: [f64; 3], p: f64| {
        let mut c = ZmpProblem::new();
        c.fix(t[0], [p, 0.0]);
        c.hold(t[1], sole, &here);
        c.fix(t[2], [0.1, 0.0]);
        c
    };
    assert_eq!(chain(&sole, [0.0, 1.0, 2.0], 0.0).solve(), PlanVerdict::Sound);
    let empty = Sole { half: [0.1, -1e-6], ..sole };
    assert_eq!(chain(&empty, [0.0, 1.0, 2.0], 0.0).solve(), PlanVerdict::NoSupport);
    assert_eq!(chain(&sole, [0.0, 1.0, 1.0], 0.0).solve(), PlanVerdict::Degenerate);
    assert_eq!(chain(&sole, [0.0, f64::NAN, 1.0], 0.0).solve(), PlanVerdict::NotFinite);
    assert_eq!(chain(&sole, [0.0, 1.0, 2.0], f64::NAN).solve(), PlanVerdict::NotFinite);
    assert_eq!(ZmpProblem::new().solve(), PlanVerdict::Degenerate);
    let mut long = ZmpProblem::new();
    for k in 0..=MAX_NODES {
        long.hold(k as f64, &sole, &here);
    }
    assert_eq!(long.solve(), PlanVerdict::TooLong);
    let mut slow = walk(20, 0.4);
    for _ in 0..3 {
        assert_eq!(slow.relax(0), PlanVerdict::Unsettled);
    }
}

/// A problem with constant right-hand sides: `change` may spoil it.
fn problem(change: impl Fn(&mut Collocation)) -> PlanVerdict {
    let mut c = Box::new(Collocation::new());
    c.problem.n = 21;
    for i in 0..21 {
        c.problem.t[i] = 0.08 * i as f64;
        c.problem.om2[i] = G / HEIGHT;
        c.problem.f[i] = [1.0; 4];
        c.problem.half[i] = [1.0; 4];
    }
    change(&mut c);
    c.solve()
}

#[test]
fn collocation_tells_what_is_wrong() {
    assert_eq!(problem(|_| ()), PlanVerdict::Sound);
    assert_eq!(problem(|c| c.problem.n = 2), PlanVerdict::Degenerate);
    assert_eq!(problem(|c| c.problem.n = MAX_KNOTS + 1), PlanVerdict::Degenerate);
    assert_eq!(problem(|c| c.problem.t[7] = c.problem.t[6]), PlanVerdict::Degenerate);
    assert_eq!(problem(|c| c.problem.t[7] = c.problem.t[5]), PlanVerdict::Degenerate);
    // The body falls freely, or faster: z.. + g <= 0.
    assert_eq!(problem(|c| c.problem.om2[9] = 0.0), PlanVerdict::Falling);
    assert_eq!(problem(|c| c.problem.om2[0] = -0.1), PlanVerdict::Falling);
    assert_eq!(problem(|c| c.problem.om2[20] = -0.1), PlanVerdict::Falling);
    for (i, k) in [(0, 0), (9, 1), (20, 3)] {
        assert_eq!(problem(|c| c.problem.f[i][k] = f64::NAN), PlanVerdict::NotFinite);
        assert_eq!(problem(|c| c.problem.half[i.min(19)][k] = f64::INFINITY), PlanVerdict::NotFinite);
    }
    assert_eq!(problem(|c| c.problem.om2[9] = f64::NAN), PlanVerdict::NotFinite);
    assert_eq!(problem(|c| c.problem.t[9] = f64::NAN), PlanVerdict::NotFinite);
}

/// Meeting the divergent component leaves the rest to die out: from the end on, along the same zero-moment point, the
/// way comes back to the one with the full state, and until there it needs smaller amplitudes.
#[test]
fn divergent_component_is_met() {
    let om2 = G / HEIGHT;
    let w = om2.sqrt();
    let trapezoid = |t: f64, at: f64| ((t - at) / 0.16).min((at + 0.8 - t) / 0.16).clamp(0.0, 1.0);
    let mut c = Box::new(Collocation::new());
    c.problem.n = 81;
    for i in 0..81 {
        let t = 0.02 * i as f64;
        let forces =
            |t: f64| [-om2 * 0.1 * t, -om2 * 0.05, -om2 * trapezoid(t, 0.0), -om2 * trapezoid(t, 0.8)];
        (c.problem.t[i], c.problem.om2[i], c.problem.f[i], c.problem.half[i]) =
            (t, om2, forces(t), forces(t + 0.01));
    }
    assert_eq!(c.solve(), PlanVerdict::Sound);
    let begin = PlanarState { r: [0.02, 0.03], v: [0.1, -0.1] };
    let target = PlanarState { r: [0.2, 0.04], v: [0.15, 0.1] };
    let full = EndConditions { begin: begin.r, end: target.r, gamma: c.ends().amplitudes(&begin, &target) };
    let loose = c.ends().divergent_ends(&begin, &target);
    for d in 0..2 {
        for ends in [&full, &loose] {
            let [r, v, _] = c.motion(0, ends);
            close(r[d], begin.r[d], 1e-12);
            close(v[d], begin.v[d], 1e-10);
            let [r, v, _] = c.motion(80, ends);
            close(r[d] + v[d] / w, target.r[d] + target.v[d] / w, 1e-10);
        }
        let size = |e: &EndConditions| e.gamma[0][d].hypot(e.gamma[1][d]);
        assert!(size(&loose) <= size(&full) + 1e-12);
    }
}

/// Hull of two soles against supporting lines in many directions.
#[test]
fn hull_of_two_soles() {
    let mut random = dice(3);
    for _ in 0..500 {
        let sole = Sole { center: [-0.1, 0.01], half: [0.15, 0.05] };
        let poses = [0, 1].map(|_| PlanarPose::new(random() - 0.5, random() - 0.5, 6.0 * random()));
        let hull = Hull::of((&sole, &poses[0]), (&sole, &poses[1]));
        let p = [random() - 0.5, random() - 0.5];
        let corners: Vec<_> = poses.iter().flat_map(|q| sole.corners(q)).collect();
        // Least distance of p to a supporting line, by directions.
        let mut least = f64::INFINITY;
        for k in 0..20_000 {
            let (s, c) = (k as f64 * std::f64::consts::TAU / 20_000.0).sin_cos();
            let far = corners.iter().map(|q| c * q[0] + s * q[1]).fold(f64::NEG_INFINITY, f64::max);
            least = least.min(far - c * p[0] - s * p[1]);
        }
        if least > 0.0 {
            close(hull.margin(p), least, 3e-4);
        } else {
            assert!(hull.margin(p) <= 1e-12); // outside, edges go on for ever
        }
    }
}
