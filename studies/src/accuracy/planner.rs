//! Planning: collocation points of the centre of gravity's way, and sweeps of the zero-moment point's.

use std::error::Error;

use config::Setup;
use messages::RIGHT;
use planner::pose::PlanarPose;
use planner::sole::Sole;
use planner::zmp::ZmpProblem;

use super::{AccuracyInput, Cost, ErrorChart, Point, boundary, cost};
use crate::speed::{Recording, plan_times};

/// Distances of knots, by that of the gait.
const SPACINGS: [f64; 6] = [0.5, 0.75, 1.0, 1.5, 2.0, 3.0];
/// Phase boundaries of a chain; a plan of three steps has 8, and there is room for 20.
const NODES: [usize; 3] = [4, 8, 20];
/// Sweeps after which the error is looked at; the planner makes at most 300.
const SWEEPS: [usize; 8] = [1, 2, 5, 10, 20, 50, 100, 300];
/// Calls of which the time is taken at once.
const CALLS: usize = 200;

/// All charts.
///
/// # Errors
/// A configuration is wrong, or the robot falls.
pub fn charts(given: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let setup = Setup::load(given.config, "walk_1kmh")?;
    Ok(vec![collocation(&setup)?, boundary::chart(), zmp(&setup)])
}

/// A walking plan's error by the distance of its knots.
fn collocation(setup: &Setup) -> Result<ErrorChart, Box<dyn Error>> {
    let recording = Recording::new(setup)?;
    let mut chart = ErrorChart::new("planner", "Collocation points of a walking plan", "error of the zero-moment point [m]")
        .over(Cost::PerCall)
        .about(
            "Scene walk_1kmh; the planner's cycle in which a plan is made, median; how far three masses that move as \
             planned miss the planned zero-moment point.",
        );
    for times in SPACINGS {
        let plans = plan_times(setup, &recording, times * setup.gait.model.spacing);
        chart.add(Point {
            scene: "walk_1kmh".into(),
            method: "collocation".into(),
            solver: Some(format!("{} points", plans.points)),
            cpu_us: Some(plans.time_us[0]),
            error: plans.zmp_error_m,
            ..Point::default()
        });
    }
    Ok(chart)
}

/// Error of projected Gauss-Seidel by its sweeps, and of direct construction.
fn zmp(setup: &Setup) -> ErrorChart {
    let mut chart = ErrorChart::new("zmp", "Sweeps for the zero-moment point's way", "distance from the optimum [m]")
        .over(Cost::PerCall)
        .about(
            "Projected Gauss-Seidel on (4.42) and direct construction over steps of 0.35 m from foot to foot, with ends in \
             the middle of the feet; reference: swept until nothing moves.",
        );
    let sole = Sole::new(setup.robot.feet[RIGHT].support).shrunk(0.01);
    for nodes in NODES {
        let begin = chain(&sole, nodes);
        let mut reference = begin;
        let mut most = 1_000_000;
        while reference.sweep(1.0) > 0.0 && most > 0 {
            most -= 1;
        }
        for sweeps in SWEEPS {
            let mut found = begin;
            let ((), seconds) = cost::of(|| {
                for _ in 0..CALLS {
                    found = begin;
                    for _ in 0..sweeps {
                        found.sweep(1.0);
                    }
                }
            });
            add(
                &mut chart,
                "projected Gauss-Seidel",
                format!("{sweeps} sweeps"),
                seconds,
                [&found, &reference],
            );
        }
        let mut found = begin;
        let (settled, seconds) = cost::of(|| {
            (0..CALLS).fold(true, |settled, _| {
                found = begin;
                settled & found.solve_directly()
            })
        });
        let what = if settled { "settled" } else { "not settled" };
        add(&mut chart, "direct construction", what.into(), seconds, [&found, &reference]);
    }
    chart
}

fn add(
    chart: &mut ErrorChart,
    method: &str,
    solver: String,
    seconds: f64,
    [found, reference]: [&ZmpProblem; 2],
) {
    let pairs = found.nodes().iter().zip(reference.nodes());
    let error = pairs.map(|(a, b)| (a.p[0] - b.p[0]).hypot(a.p[1] - b.p[1])).fold(0.0, f64::max);
    chart.add(Point {
        scene: format!("{} boundaries", found.nodes().len()),
        method: method.into(),
        solver: Some(solver),
        cpu_us: Some(1e6 * seconds / CALLS as f64),
        error: error.max(f64::EPSILON), // of metres: nothing less can be drawn
        ..Point::default()
    });
}

/// Steps straight on: each foot holds the point for two boundaries.
fn chain(sole: &Sole, nodes: usize) -> ZmpProblem {
    let mut chain = ZmpProblem::new();
    let foot = |k: usize| {
        let step = k.div_ceil(2);
        PlanarPose::new(0.35 * step as f64, if step.is_multiple_of(2) { -0.1 } else { 0.1 }, 0.0)
    };
    let last = nodes - 1;
    let time = |k: usize| (k / 2) as f64 * 0.8 + (k % 2) as f64 * 0.6;
    chain.fix(time(0), sole.middle(&foot(0)));
    for k in 1..last {
        chain.hold(time(k), sole, &foot(k));
    }
    chain.fix(time(last), sole.middle(&foot(last)));
    chain
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sweeps go to a point from which no feasible small change gets lower.
    #[test]
    fn the_reference_is_an_optimum() {
        let setup = Setup::load(&config::root(None), "walk_1kmh").unwrap();
        let sole = Sole::new(setup.robot.feet[RIGHT].support).shrunk(0.01);
        let mut chain = chain(&sole, 8);
        for _ in 0..10_000 {
            chain.sweep(1.0);
        }
        let nodes = chain.nodes().to_vec();
        let cost = |p: &[[f64; 2]]| -> f64 {
            (1..p.len())
                .map(|k| {
                    let h = nodes[k].time - nodes[k - 1].time;
                    ((p[k][0] - p[k - 1][0]).powi(2) + (p[k][1] - p[k - 1][1]).powi(2)) / h
                })
                .sum()
        };
        let best: Vec<[f64; 2]> = nodes.iter().map(|n| n.p).collect();
        for k in 1..nodes.len() - 1 {
            for step in [[1e-5, 0.0], [-1e-5, 0.0], [0.0, 1e-5], [0.0, -1e-5]] {
                let hold = nodes[k].hold.unwrap();
                let mut moved = best.clone();
                moved[k] = hold.nearest([best[k][0] + step[0], best[k][1] + step[1]]);
                assert!(cost(&moved) >= cost(&best) - 1e-13, "node {k}");
            }
        }
    }
}
