//! Where the solvers fail, with the numbers predicted: r-factors too large, nearly incompressible rubber, much friction.

use crate::sole::{self, layer};
use contact::coupling::Coupling;
use contact::solver::solve;
use contact::{CouplingMethod, Layer, Memory, Settings, SolverReport};
use nalgebra::{DMatrix, Vector3};

/// The sole pressed so evenly and hard that all nodes stick, with a little shear.
fn sticking(coupling: &Coupling, settings: &Settings) -> (SolverReport, Memory) {
    let mut memory = Memory::new(coupling);
    memory.begin();
    for i in 0..coupling.nodes() {
        let x = i as f64;
        let c = Vector3::new(1e-3 * x.sin(), 1e-3 * (2.0 * x).sin(), -0.1 + 1e-3 * (3.0 * x).sin());
        memory.set(i, c, Some(Vector3::z()));
    }
    (solve(coupling, &mut memory, settings), memory)
}

/// Largest eigenvalue of D^-1 W: D the diagonal of the r-factors' G (level ground).
fn spectral(layer: &Layer) -> (f64, f64) {
    let n = 3 * layer.contacts();
    let w = DMatrix::from_column_slice(n, n, layer.coupling().inverse());
    let scale = |k: usize| {
        let g = layer.coupling().free_mobility(k / 3);
        let (a, b, c) = (g[(0, 0)], g[(1, 1)], g[(0, 1)]);
        if k % 3 == 2 { g[(2, 2)] } else { 0.5 * (a + b) + (0.5 * (a - b)).hypot(c) }
    };
    let even = DMatrix::from_fn(n, n, |i, j| w[(i, j)] / (scale(i) * scale(j)).sqrt());
    let values = w.symmetric_eigenvalues();
    (even.symmetric_eigenvalues().max(), values.max() / values.min())
}

/// F8: Jacobi converges exactly when gamma < 2/lambda_max(D^-1 W); above, it runs in a bounded cycle and says so.
#[test]
fn jacobi_ends_where_its_spectral_radius_is_one() {
    for poisson in [0.0, 0.3, 0.45] {
        let layer = layer(poisson, [5, 5, 1]);
        let predicted = 2.0 / spectral(&layer).0;
        let run = |factor: f64| {
            let gamma = predicted * factor;
            let settings = Settings {
                method: CouplingMethod::Jacobi,
                gamma,
                tolerance: 1e-6,
                sweeps: 20_000,
                ..Settings::of_friction(10.0)
            };
            sticking(layer.coupling(), &settings)
        };
        let (below, _) = run(0.99);
        assert!(below.converged, "nu {poisson}, gamma {}: {below:?}", 0.99 * predicted);
        let (above, memory) = run(1.05);
        assert!(!above.converged && above.residual > 1.0, "nu {poisson}: {above:?}");
        assert!(memory.forces().iter().all(|f| f.norm() < 1e6), "the cycle is bounded");
    }
}

/// F9: towards nu = 1/2 the layer becomes ill-conditioned and every iteration slower.
#[test]
fn nearly_incompressible_rubber_needs_more_sweeps() {
    let of = |poisson| {
        let layer = layer(poisson, [5, 5, 1]);
        let sweeps = |method, gamma| {
            let settings =
                Settings { method, gamma, tolerance: 1e-6, sweeps: 50_000, ..Settings::of_friction(10.0) };
            let report = sticking(layer.coupling(), &settings).0;
            assert!(report.converged);
            report.sweeps
        };
        (
            spectral(&layer).1,
            sweeps(CouplingMethod::Jacobi, 0.9 * 2.0 / spectral(&layer).0),
            sweeps(CouplingMethod::GaussSeidel, 1.5),
            sweeps(CouplingMethod::Velocity, 1.0),
        )
    };
    let (soft, hard) = (of(0.3), of(0.49));
    assert!(hard.0 > 5.0 * soft.0 && hard.1 > 3 * soft.1 && hard.2 > 2 * soft.2);
    assert_eq!((soft.3, hard.3), (1, 1), "a sole that sticks is solved in one pass");
}

/// F10: more friction, more sweeps; and Gauss-Seidel with gamma near 2 no longer converges, which it says.
#[test]
fn much_friction_needs_more_sweeps() {
    let mut sole = sole::Sole::new(0.3);
    let mut last = 0;
    for mu in [0.1, 0.5, 2.0] {
        let settings = Settings {
            method: CouplingMethod::GaussSeidel,
            tolerance: 1e-6,
            sweeps: 5000,
            ..Settings::of_friction(mu)
        };
        sole.memory.clear();
        sole.d.fill(0.0);
        let twist = contact::SegmentMotion {
            linear: Vector3::new(0.05, 0.0, -0.1),
            angular: Vector3::new(0.3, 0.5, 2.0),
        };
        let report = sole.rates(-1e-3, &twist, &settings).report;
        assert!(report.converged && report.sweeps >= last);
        last = report.sweeps;
    }
}

/// What the iteration does not reach it does not hide: with too few sweeps forces stay inside the cone and the report
/// tells the residual.
#[test]
fn too_few_sweeps_are_told() {
    for method in [CouplingMethod::Jacobi, CouplingMethod::GaussSeidel, CouplingMethod::Velocity] {
        let mut sole = sole::Sole::new(0.45);
        let settings = Settings { method, sweeps: 2, tolerance: 1e-9, ..Settings::of_friction(0.3) };
        let twist = contact::SegmentMotion {
            linear: Vector3::new(0.2, 0.0, -0.1),
            angular: Vector3::new(0.3, 0.5, 2.0),
        };
        let outcome = sole.rates(-1e-3, &twist, &settings);
        assert!(!outcome.report.converged && outcome.report.residual > 1e-9 && outcome.report.sweeps == 2);
        for f in sole.memory.forces() {
            assert!(f.xy().norm() <= 0.3 * f.z * (1.0 + 1e-12) + 1e-12);
        }
    }
}
