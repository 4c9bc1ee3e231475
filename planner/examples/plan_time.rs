//! How long plans take, and how well their motion meets their zero-moment point.
//!
//! `cargo run --release -p planner --example plan_time`

#[allow(dead_code, reason = "the tests use all of it")]
#[path = "../tests/robot/mod.rs"]
mod robot;

use messages::Command;
use messages::command::{BoxCommand, VelocityCommand};
use planner::boundary::{BoundarySolver, EndConditions, PlanarState};
use planner::closed_form::ClosedForm;
use planner::collocation::Collocation;
use planner::pose::PlanarPose;
use planner::sole::Sole;
use planner::zmp::ZmpProblem;
use realtime::clock;
use robot::{Robot, checks};
use std::hint::black_box;

/// Calls that are timed one by one.
const CALLS: usize = 3000;

fn main() {
    println!("speed    spacing  points  error of the zero-moment point   time per plan: median   p99");
    let cases = [(1.0, 0.08), (2.0, 0.3), (2.0, 0.16), (2.0, 0.08), (2.0, 0.06), (3.0, 0.08)];
    for (kmh, spacing) in cases {
        whole_plan(kmh, spacing);
    }
    // Looks at triangles grow with what lies near.
    println!("\nplans on a way with boxes that were told (4.3.3)             median   p99");
    for boxes in [0, 1, 32] {
        row(&format!("{boxes} boxes"), over_boxes(boxes));
    }
    println!("\nsolution of the boundary value problem alone (4.6.5)        median   p99");
    for (steps, per_step) in [(5, 8), (20, 8)] {
        let points = steps * per_step;
        let row = |name: &str, solver: &mut dyn BoundarySolver| {
            row(&format!("{name}, {points} points, {steps} steps"), solution(solver, steps, per_step));
        };
        row("closed form", &mut *Box::new(ClosedForm::new()));
        row("collocation", &mut *Box::new(Collocation::new()));
    }
    println!("\nreference of the zero-moment point (4.6.4)                   median   p99");
    for steps in [3, 7, 20] {
        let begin = chain(steps);
        row(&format!("direct, {steps} steps"), timed(|| black_box(begin).solve_directly()));
        row(&format!("sweeps, {steps} steps"), timed(|| black_box(begin).relax(2000)));
    }
}

fn row(what: &str, [median, p99]: [f64; 2]) {
    println!("{what:58} {median:6.2} us {p99:6.2} us");
}

fn whole_plan(kmh: f64, spacing: f64) {
    let mut gait = robot::gait();
    gait.model.spacing = spacing;
    let mut r = Robot::new(&gait);
    r.stand();
    r.step(&[Command::Velocity(VelocityCommand { forward: kmh / 3.6, left: 0.0, turn: 0.0 })]);
    let mut times = Vec::new();
    while times.len() < 300 {
        let made = r.plans.len();
        r.step(&[]);
        if r.plans.len() > made && r.plans.len() > 10 {
            times.push(r.took);
        }
    }
    let plan = r.plans.last().expect("made");
    let error = checks::zmp_error(plan, &gait) * 1e3;
    let [median, p99] = spread(times);
    let points = plan.body.pieces + 2;
    println!(
        "{kmh} km/h   {spacing:.2} s   {points:3}     {error:8.3} mm                       {median:6.1} us   {p99:6.1} us"
    );
}

/// Plans of a walk over low boxes, 1.5 m apart, all of them in her way or behind her.
fn over_boxes(count: u32) -> [f64; 2] {
    let mut r = Robot::new(&robot::gait());
    r.stand();
    let told = |k: u32| {
        let (base, size) = ([1.2 + 1.5 * f64::from(k), 0.0, 0.0], [0.06, 1.0, 0.05]);
        Command::Box(BoxCommand { id: 1 + k, base, yaw: 0.1, size, lifetime: 60.0 })
    };
    let mut times = Vec::new();
    // Ten minutes, should they leave no way.
    for cycle in 0..600_000u32 {
        if cycle % 50_000 < count {
            r.step(&[told(cycle % 50_000)]);
        }
        let made = r.plans.len();
        r.step(&[Command::Velocity(VelocityCommand { forward: 1.0 / 3.6, left: 0.0, turn: 0.0 })]);
        if r.plans.len() > made && r.plans.len() > 2 && times.len() < 300 {
            times.push(r.took);
        }
    }
    spread(times)
}

fn spread(mut times: Vec<f64>) -> [f64; 2] {
    times.sort_by(f64::total_cmp);
    [times[times.len() / 2], times[times.len() * 99 / 100]]
}

/// Median and p99 \[us\].
fn timed<T>(mut call: impl FnMut() -> T) -> [f64; 2] {
    let mut times = Vec::with_capacity(CALLS);
    for _ in 0..CALLS {
        let start = clock::now();
        black_box(call());
        times.push((clock::now() - start) as f64 * 1e-3);
    }
    spread(times)
}

/// Steps straight on: two phases each.
fn chain(steps: usize) -> ZmpProblem {
    let sole = Sole { center: [0.0; 2], half: [0.1, 0.03] };
    let mut chain = ZmpProblem::new();
    let foot = |k: usize| PlanarPose::new(0.4 * k as f64, if k.is_multiple_of(2) { -0.1 } else { 0.1 }, 0.0);
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
    chain
}

const BEGIN: PlanarState = PlanarState { r: [0.01, -0.05], v: [0.2, 0.15] };

/// Solution with amplitudes of both ends, and the motion at every point.
fn solution(solver: &mut dyn BoundarySolver, steps: usize, per_step: usize) -> [f64; 2] {
    let mut reference = chain(steps);
    reference.solve();
    let om2 = 9.81 / 0.9;
    // The modifications rise and fall between knots, so that the closed form holds, too.
    let spacing = 0.8 / per_step as f64;
    let end = 0.8 * steps as f64;
    let trapezoid = |t: f64, at: f64| ((t - at) / spacing).min((at + 0.8 - t) / spacing).clamp(0.0, 1.0);
    let problem = solver.problem_mut();
    problem.n = steps * per_step + 1;
    let knot = |i: usize| {
        let (t, p) = (spacing * i as f64, reference.at(spacing * i as f64));
        (t, [-om2 * p[0], -om2 * p[1], -om2 * trapezoid(t, 0.0), -om2 * trapezoid(t, end - 0.8)])
    };
    for i in 0..problem.n {
        let ((t, f), (_, next)) = (knot(i), knot(i + 1));
        (problem.t[i], problem.om2[i], problem.f[i]) = (t, om2, f);
        problem.half[i] = std::array::from_fn(|k| 0.5 * (f[k] + next[k]));
    }
    let target = PlanarState { r: [0.4 * steps as f64, -0.02], v: [0.2, 0.1] };
    timed(|| {
        solver.solve();
        let gamma = solver.ends().amplitudes(&BEGIN, &target);
        let ends = EndConditions { begin: BEGIN.r, end: target.r, gamma };
        (0..solver.problem().n).map(|i| solver.motion(i, &ends)[0][0]).sum::<f64>()
    })
}
