//! Contact: fixed points with too large factors, nearly incompressible rubber, much friction, cones, penetration (F8-F11).
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | W | velocities of the sole's nodes by their forces | m/(N s) |
//! | D | diagonal of what the r-factors are made of | m/(N s) |
//! | lambda | eigenvalues of D^-1 W | 1 |
//! | gamma | scale of the r-factors (2.48), (2.49) | 1 |

use ::contact::coupling::Coupling;
use ::contact::hexahedron::{LinearElasticity, Volume};
use ::contact::point::{self, ContactLaw, PointState};
use ::contact::solver::solve;
use ::contact::{CouplingMethod, Layer, Material, Memory, Settings, SolverReport};
use nalgebra::{DMatrix, DVector, Vector3};

use super::LimitRule::{AtLeast, AtMost, Within};
use super::{Bench, Findings, Result, largest_stable, row};

/// A pad of the thesis's size, 36 nodes free.
fn layer(poisson: f64) -> Result<Layer> {
    let elasticity = LinearElasticity { modulus: 6e5, poisson };
    let size = [0.06, 0.04, 0.012];
    Ok(Layer::new(&Material {
        size,
        bricks: [5, 5, 1],
        elasticity,
        volume: Volume::Full,
        damping_time: 0.008,
    })?)
}

/// Eigenvalues of D^-1 W, and condition of W.
fn spectrum(layer: &Layer) -> (DVector<f64>, f64) {
    let n = 3 * layer.contacts();
    let w = DMatrix::from_column_slice(n, n, layer.coupling().inverse());
    let scale = |k: usize| {
        let g = layer.coupling().free_mobility(k / 3);
        let (a, b, c) = (g[(0, 0)], g[(1, 1)], g[(0, 1)]);
        if k % 3 == 2 { g[(2, 2)] } else { 0.5 * (a + b) + (0.5 * (a - b)).hypot(c) }
    };
    let even = DMatrix::from_fn(n, n, |i, j| w[(i, j)] / (scale(i) * scale(j)).sqrt());
    let values = w.symmetric_eigenvalues();
    (even.symmetric_eigenvalues(), values.max() / values.min())
}

/// A sole pressed on the ground with some shear and spin: evenly and hard, so that it sticks for enough friction.
fn press(coupling: &Coupling, memory: &mut Memory, shear: f64, settings: &Settings) -> SolverReport {
    memory.begin();
    for i in 0..coupling.nodes() {
        let x = i as f64;
        let c = Vector3::new(shear + 1e-3 * x.sin(), 1e-3 * (2.0 * x).sin(), -0.1 + 1e-3 * (3.0 * x).sin());
        memory.set(i, c, Some(Vector3::z()));
    }
    solve(coupling, memory, settings)
}

fn settings(method: CouplingMethod, gamma: f64, tolerance: f64, friction: f64) -> Settings {
    Settings { method, gamma, tolerance, sweeps: 30_000, ..Settings::of_friction(friction) }
}

/// F8: Jacobi's iteration ends where gamma lambda_max = 2; above it runs in circles, and says so.
pub(super) fn fixed_point(_: &Bench) -> Findings {
    let finding = |poisson: f64| {
        let layer = layer(poisson)?;
        let predicted = 2.0 / spectrum(&layer).0.max();
        let run = |gamma: f64| {
            let mut memory = Memory::new(layer.coupling());
            let settings = Settings { sweeps: 4000, ..settings(CouplingMethod::Jacobi, gamma, 1e-3, 10.0) };
            let report = press(layer.coupling(), &mut memory, 0.0, &settings);
            (report, memory.forces().iter().all(|f| f.norm() < 1e6))
        };
        let measured = largest_stable(0.8 * predicted, 1.1 * predicted, |gamma| run(gamma).0.converged)?;
        let (beyond, bounded) = run(1.05 * predicted);
        let regime = format!("Jacobi, nu = {poisson}: largest gamma 2/lambda_max(D^-1 W)");
        Ok(row("F8", "", Within(0.005))
            .of(regime, [predicted, measured])
            .says("converged: false, residual", !beyond.converged && beyond.residual > 1.0 && bounded))
    };
    [0.0, 0.3, 0.45, 0.49].map(finding).into_iter().collect()
}

/// F9: condition of W towards nu = 1/2 (reference: 29 and 345), and what it costs: a sweep leaves 1 - gamma lambda_min.
pub(super) fn incompressible(_: &Bench) -> Findings {
    let mut findings = Vec::new();
    for (poisson, condition) in [(0.3, 29.0), (0.49, 345.0)] {
        let layer = layer(poisson)?;
        let (values, found) = spectrum(&layer);
        let gamma = 1.8 / values.max();
        let sweeps = |tolerance| {
            let mut memory = Memory::new(layer.coupling());
            let settings = settings(CouplingMethod::Jacobi, gamma, tolerance, 10.0);
            f64::from(press(layer.coupling(), &mut memory, 0.0, &settings).sweeps)
        };
        let left = values.iter().map(|l| (1.0 - gamma * l).abs()).fold(0.0, f64::max);
        let numbers = [(1e-4_f64).ln() / left.ln(), sweeps(1e-7) - sweeps(1e-3)];
        let regime = format!("layer of nu = {poisson}: condition of W");
        findings.push(row("F9", "", Within(0.02)).of(regime, [condition, found]));
        let regime = format!("Jacobi, nu = {poisson}: sweeps for four more digits");
        findings.push(row("F9", "", Within(0.01)).of(regime, numbers));
    }
    Ok(findings)
}

/// F10: with much friction Gauss-Seidel fails near gamma = 2 and says so; what converges is the same from any start.
pub(super) fn friction(_: &Bench) -> Findings {
    let layer = layer(0.3)?;
    let coupling = layer.coupling();
    let run = |mu: f64, gamma: f64, warm: bool| {
        let mut memory = Memory::new(coupling);
        let settings = Settings { sweeps: 5000, ..settings(CouplingMethod::GaussSeidel, gamma, 1e-6, mu) };
        if warm {
            press(coupling, &mut memory, -0.2, &settings); // forces of another problem
        }
        let report = press(coupling, &mut memory, 0.2, &settings);
        (report, memory)
    };
    let (few, many) = (run(0.3, 1.0, false).0, run(2.0, 1.0, false));
    let other = run(2.0, 1.0, true);
    let apart = many.1.forces().iter().zip(other.1.forces()).map(|(a, b)| (a - b).norm());
    let apart = apart.fold(0.0, f64::max);
    let (beyond, _) = run(2.0, 1.95, false);
    let counts = [f64::from(few.sweeps), f64::from(many.0.sweeps)];
    Ok(vec![
        row("F10", "", AtLeast)
            .of("Gauss-Seidel, mu = 2: sweeps, against those of mu = 0.3", counts)
            .says("converged, sweeps", many.0.converged),
        row("F10", "N", AtMost)
            .of("mu = 2 from two starts: largest difference of a force", [2e-7, apart])
            .says("unique: true", many.0.unique),
        row("F10", "", AtLeast)
            .of("Gauss-Seidel, mu = 2, gamma = 1.95: residual", [1e-6, beyond.residual])
            .says("converged: false, residual", !beyond.converged),
    ])
}

/// F11: friction of a sliding node in every direction; a pyramid would be up to 41 % too large, or 29 % too small.
pub(super) fn cone(_: &Bench) -> Findings {
    let law = ContactLaw {
        stiffness: [4e4, 4e4, 6e4],
        damping: [300.0, 300.0, 500.0],
        friction: 0.3,
        recovery: 0.0,
    };
    let error = |degrees: i32| {
        let (s, c) = f64::from(degrees).to_radians().sin_cos();
        let a = point::solve(&law, [0.0; 3], [0.5 * c, 0.5 * s, -0.1], -1e-9);
        let against = a.force[0] * s - a.force[1] * c;
        let wrong = (a.force[0].hypot(a.force[1]) / (law.friction * a.force[2]) - 1.0).abs();
        if a.state == PointState::Slip { wrong.max(against.abs() / a.force[2]) } else { f64::INFINITY }
    };
    let largest = (0..=45).map(error).fold(0.0, f64::max);
    let regime = "sliding node, 0 to 45 degrees: size and direction of friction, error";
    Ok(vec![row("F11", "", AtMost).of(regime, [2e-15, largest])])
}

/// F11: a block that sticks on an incline of 20 degrees stays: way in 5 s after it came to rest.
pub(super) fn creep(_: &Bench) -> Findings {
    let law = ContactLaw {
        stiffness: [4e4, 4e4, 6e4],
        damping: [300.0, 300.0, 500.0],
        friction: 0.8,
        recovery: 200.0,
    };
    let (mass, h, tilt) = (10.0, 1e-3, 20_f64.to_radians());
    let pull = [multibody::GRAVITY_ACCELERATION * tilt.sin(), 0.0, multibody::GRAVITY.z * tilt.cos()];
    let (mut r, mut v, mut d, mut before) = ([0.0; 3], [0.0; 3], [0.0; 3], 0.0);
    for i in 0..10_000 {
        let a = point::solve(&law, d, v, r[2] + d[2]);
        for k in 0..3 {
            r[k] += h * v[k];
            v[k] += h * (pull[k] + a.force[k] / mass);
            d[k] += h * a.rate[k];
        }
        if i == 5000 {
            before = r[0] + d[0];
        }
    }
    let regime = "block that sticks on 20 degrees, explicit Euler at 1 ms: creep in 5 s";
    Ok(vec![row("F11", "m", AtMost).of(regime, [0.0, (r[0] + d[0] - before).abs()])])
}

/// A node left 1 mm inside of the ground by a too long step: time constant with which it is taken out, 1/200 s, which is
/// also the longest step that does not throw it into the air (from where its spring presses it in again).
pub(super) fn penetration(_: &Bench) -> Findings {
    let law = ContactLaw { stiffness: [6e4; 3], damping: [500.0; 3], friction: 0.6, recovery: 200.0 };
    // A foot held where it is. What is left of the penetration, and whether the node stayed on the ground.
    let run = |h: f64, steps: usize| {
        let (mut d, mut stays) = (0.0, true);
        for _ in 0..steps {
            let a = point::solve(&law, [0.0, 0.0, d], [0.0; 3], d - 1e-3);
            stays &= a.state != PointState::Open;
            d += h * a.rate[2];
        }
        ((d - 1e-3).abs(), stays)
    };
    let (h, steps) = (1e-6, 5000);
    let time = -h * steps as f64 / (run(h, steps).0 / 1e-3).ln();
    let longest = largest_stable(1e-4, 0.1, |h| run(h, 1000).1)?;
    let of = |regime, measured, most| row("P1", "s", Within(most)).of(regime, [1.0 / law.recovery, measured]);
    Ok(vec![
        of("penetration of 1 mm: time constant of its recovery", time, 1e-3),
        of("penetration of 1 mm: largest Euler step that does not lift the node off", longest, 2e-3),
    ])
}
