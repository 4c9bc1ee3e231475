//! Coupled nodes: vector V7 of errata 1, the law on random problems, all methods against each other and against a dense
//! solver of another kind.

use crate::problem::{Problem, exact};
use contact::coupling::Coupling;
use contact::solver::solve;
use contact::{CouplingMethod, Memory, Settings};
use nalgebra::{DMatrix, Vector3};

const METHODS: [CouplingMethod; 4] =
    [CouplingMethod::Jacobi, CouplingMethod::GaussSeidel, CouplingMethod::Velocity, CouplingMethod::Fastest];

fn sharp(friction: f64, method: CouplingMethod) -> Settings {
    let gamma = if method == CouplingMethod::Jacobi { 0.5 } else { 1.0 };
    Settings { method, gamma, tolerance: 1e-9, sweeps: 100_000, ..Settings::of_friction(friction) }
}

#[test]
fn three_nodes_of_the_errata() {
    let chain = DMatrix::from_row_slice(3, 3, &[4.0, -1.0, 0.0, -1.0, 4.0, -1.0, 0.0, -1.0, 4.0]) * 50.0;
    let b = chain.kronecker(&DMatrix::identity(3, 3));
    let kd = [1.0, 2.0, 30.0, -2.0, 1.0, 10.0, 0.0, -1.0, 5.0];
    let w = [0.05, 0.0, -0.2, 0.25, -0.05, -0.1, 0.0, 0.1, 0.4];
    let f = [-5.74031199018, 1.51742660702, 65.0, -11.7238300368, 2.55965022367, 20.0, 0.0, 0.0, 0.0];
    let coupling = Coupling::new(&b).unwrap();
    // c = w - B^-1 K d
    let free = b.clone().cholesky().unwrap().solve(&DMatrix::from_column_slice(9, 1, &kd));
    for (method, sweeps) in METHODS.into_iter().zip([47, 13, 13, 13]) {
        let mut memory = Memory::new(&coupling);
        memory.begin();
        for i in 0..3 {
            let c = Vector3::from_fn(|k, _| w[3 * i + k] - free[3 * i + k]);
            memory.set(i, c, Some(Vector3::z()));
        }
        let gamma = if method == CouplingMethod::Jacobi { 0.7 } else { 1.0 };
        let report = solve(&coupling, &mut memory, &Settings { gamma, ..sharp(0.6, method) });
        assert!(report.converged && report.unique, "{method:?}: {report:?}");
        assert!(report.sweeps <= sweeps + 2, "{method:?}: {} sweeps", report.sweeps);
        for (got, want) in memory.forces().iter().flat_map(|f| f.iter().copied().collect::<Vec<_>>()).zip(f) {
            assert!((got - want).abs() < 1e-8, "{method:?}: {got} for {want}");
        }
    }
}

/// Four routes to one number: forces on random problems on which the law has one solution.
#[test]
fn all_methods_agree_with_a_dense_newton_method() {
    let mut kinds = [0; 3];
    for seed in 0..200 {
        let problem = Problem::random(seed, 1 + seed as usize % 6, 0.3);
        let oracle = exact(&problem).unwrap_or_else(|| panic!("seed {seed}: the oracle does not converge"));
        let coupling = Coupling::new(&problem.s).unwrap();
        for method in METHODS {
            let mut memory = Memory::new(&coupling);
            problem.set(&mut memory);
            let report = solve(&coupling, &mut memory, &sharp(problem.mu, method));
            assert!(report.converged, "seed {seed}, {method:?}: {report:?}");
            problem.check(&memory, 1e-8);
            for (f, want) in memory.forces().iter().zip(&oracle) {
                assert!(
                    (f - want).norm() < 1e-6 * (1.0 + want.norm()),
                    "seed {seed}, {method:?}: {f} for {want}"
                );
            }
            memory.states().iter().for_each(|s| kinds[*s as usize] += 1);
        }
    }
    assert!(kinds.iter().all(|k| *k > 100), "open, stick, slip: {kinds:?}");
}

/// Without friction the law is a linear complementarity problem: all sets of open nodes are tried.
#[test]
fn without_friction_it_is_the_linear_complementarity_problem() {
    for seed in 0..100 {
        let mut problem = Problem::random(seed, 5, 0.3);
        problem.mu = 0.0;
        let want = problem.enumerated();
        let coupling = Coupling::new(&problem.s).unwrap();
        for method in METHODS {
            let mut memory = Memory::new(&coupling);
            problem.set(&mut memory);
            assert!(solve(&coupling, &mut memory, &sharp(0.0, method)).converged, "seed {seed}, {method:?}");
            for ((f, n), want) in memory.forces().iter().zip(&problem.normals).zip(&want) {
                assert!(
                    (f - n * *want).norm() < 1e-6 * (1.0 + want),
                    "seed {seed}, {method:?}: {f} for {want}"
                );
            }
        }
    }
}

/// F10: with much friction on slanting ground the law of a node may have several solutions, and then the report says
/// so; where it does not, two starts agree.
#[test]
fn two_starts_agree_or_the_report_says_that_they_need_not() {
    let (mut flagged, mut agreed) = (0, 0);
    for seed in 0..200 {
        let mut problem = Problem::random(seed, 4, 1.0);
        problem.mu = 2.0;
        let coupling = Coupling::new(&problem.s).unwrap();
        let run = |start: u64| {
            let mut memory = Memory::new(&coupling);
            if start > 0 {
                let other = Problem::random(start, 4, 1.0);
                other.set(&mut memory);
                solve(&coupling, &mut memory, &sharp(2.0, CouplingMethod::GaussSeidel));
            }
            problem.set(&mut memory);
            let report = solve(
                &coupling,
                &mut memory,
                &Settings { sweeps: 5000, ..sharp(2.0, CouplingMethod::GaussSeidel) },
            );
            (report, memory)
        };
        let ((a, one), (b, two)) = (run(0), run(1000 + seed));
        if !a.unique || !a.converged || !b.converged {
            flagged += 1;
            continue;
        }
        agreed += 1;
        for (f, g) in one.forces().iter().zip(two.forces()) {
            assert!((f - g).norm() < 1e-5 * (1.0 + f.norm()), "seed {seed}: {f} {g}");
        }
    }
    assert!(flagged > 20 && agreed > 20, "{flagged} flagged, {agreed} agreed");
}
