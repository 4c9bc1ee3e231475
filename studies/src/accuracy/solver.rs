//! Contact of one pad of 36 nodes: Jacobi, Gauss-Seidel and sweeps over velocities, for rubber more and less compressible
//! and ground more and less slippery (chart 5).

use std::error::Error;

use contact::coupling::Coupling;
use contact::hexahedron::{LinearElasticity, Volume};
use contact::solver::solve;
use contact::{CouplingMethod, Layer, Material, Memory, Settings, SolverReport};
use nalgebra::Vector3;

use super::{AccuracyInput, Cost, ErrorChart, Part, Point, cost};

pub(super) const PART: Part = charts;

/// Solutions that are timed together.
const TOGETHER: usize = 20;
const TOLERANCES: [f64; 6] = [1e1, 1e-1, 1e-3, 1e-5, 1e-7, 1e-9];

fn charts(_: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let mut charts = Vec::new();
    for poisson in [0.3, 0.45] {
        let layer = layer(poisson)?;
        for friction in [0.3, 0.8] {
            charts.push(chart(&layer, poisson, friction));
        }
    }
    Ok(charts)
}

fn chart(layer: &Layer, poisson: f64, friction: f64) -> ErrorChart {
    let mut chart = ErrorChart::new(
        &format!("contact.nu{poisson}mu{friction}"),
        "Contact of one pad, 36 nodes that stick, slide and lift off; cold start",
        &format!("nu {poisson}, mu {friction}: largest error of a force / largest force"),
    )
    .over(Cost::PerCall)
    .about("Each point a tolerance of the residual. Reference: velocity sweeps to 1e-13.");
    let settings = |method, gamma, tolerance| Settings {
        method,
        gamma,
        tolerance,
        sweeps: 3000,
        ..Settings::of_friction(friction)
    };
    let mut memory = Memory::new(layer.coupling());
    rolled(layer.coupling(), &mut memory, &settings(CouplingMethod::Velocity, 1.0, 1e-13));
    let exact = memory.forces().to_vec();
    let largest = exact.iter().map(|f| f.norm()).fold(0.0, f64::max);
    for (name, method, gamma) in [
        ("Jacobi, gamma 0.7", CouplingMethod::Jacobi, 0.7),
        ("Gauss-Seidel, gamma 1", CouplingMethod::GaussSeidel, 1.0),
        ("Gauss-Seidel, gamma 1.5", CouplingMethod::GaussSeidel, 1.5),
        ("velocity sweeps", CouplingMethod::Velocity, 1.0),
        ("fastest, as in a walk", CouplingMethod::Fastest, 1.0),
    ] {
        for tolerance in TOLERANCES {
            let settings = settings(method, gamma, tolerance);
            let (report, seconds) = cost::of(|| {
                (0..TOGETHER)
                    .map(|_| rolled(layer.coupling(), &mut memory, &settings))
                    .last()
                    .unwrap_or_default()
            });
            let difference = memory.forces().iter().zip(&exact).map(|(a, b)| (a - b).norm());
            chart.add(Point {
                scene: "pad".into(),
                model: format!("nu {poisson}, mu {friction}"),
                method: name.into(),
                solver: Some(format!("{tolerance:.0e}")),
                cpu_us: Some(seconds * 1e6 / TOGETHER as f64),
                error: difference.fold(0.0, f64::max) / largest,
                diverged: !report.converged,
                note: (!report.converged)
                    .then(|| format!("residual {:.1e} after {} sweeps", report.residual, report.sweeps)),
                ..Point::default()
            });
        }
    }
    chart
}

fn layer(poisson: f64) -> Result<Layer, Box<dyn Error>> {
    let elasticity = LinearElasticity { modulus: 4.643e5, poisson };
    let (size, bricks) = ([0.06, 0.04, 0.012], [5, 5, 1]);
    Ok(Layer::new(&Material { size, bricks, elasticity, volume: Volume::Mean, damping_time: 0.008 })?)
}

/// The pad as it is when the foot rolls and turns: one edge lifts off, the middle slides, the other edge sticks.
pub(super) fn rolled(coupling: &Coupling, memory: &mut Memory, settings: &Settings) -> SolverReport {
    memory.clear();
    memory.begin();
    let side = coupling.nodes().isqrt();
    let share = |k: usize| k as f64 / (side - 1) as f64;
    for i in 0..coupling.nodes() {
        let (along, across) = (share(i % side), share(i / side));
        let c = Vector3::new(0.03 * along - 0.01, 0.02 * (across - 0.5), 0.04 * along - 0.03);
        memory.set(i, c, Some(Vector3::z()));
    }
    solve(coupling, memory, settings)
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact::point::PointState;

    #[test]
    fn the_problem_has_nodes_of_every_kind_and_one_answer() {
        let layer = layer(0.3).unwrap();
        let mut memory = Memory::new(layer.coupling());
        let of = |method, memory: &mut Memory| {
            let settings = Settings { method, tolerance: 1e-9, sweeps: 5000, ..Settings::of_friction(0.3) };
            assert!(rolled(layer.coupling(), memory, &settings).converged);
            memory.forces().to_vec()
        };
        let a = of(CouplingMethod::GaussSeidel, &mut memory);
        let b = of(CouplingMethod::Velocity, &mut memory);
        for kind in [PointState::Open, PointState::Stick, PointState::Slip] {
            assert!(memory.states().contains(&kind), "no node is {kind:?}");
        }
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).norm() < 1e-6));
    }
}
