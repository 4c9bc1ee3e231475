//! Algorithm 1 of the thesis, corrected (errata 1, F7-GS): fixed point of (2.44), (2.45) over the forces.
//!
//! The law of node i is `lambda = prox(lambda - r u)`; each sweep puts it in force at every node, Jacobi with the
//! velocities of the last sweep, Gauss-Seidel with the newest. What is corrected: nodes are active from the ground
//! downwards (line 4), r belongs to the block of the inverse (2.48), (2.49), the iteration ends when the law holds and
//! not when forces stand still (line 23: with r too small they do at once).
//!
//! The iteration lives on the nodes at the ground; W is gathered for them when their set changes. Jacobi converges, all
//! nodes sticking, if gamma < 2/lambda_max(D^-1 W); above it runs into a limit cycle, which the report tells
//! (`tests/failures.rs`).

use nalgebra::Vector3;

use crate::coupling::Coupling;
use crate::law::{self, CouplingMethod, Settings, SolverReport};
use crate::memory::Memory;
use crate::node;
use crate::point::PointState;

/// Finds f of the active nodes from c, starting from f; leaves y of all nodes.
pub(crate) fn solve(coupling: &Coupling, memory: &mut Memory, settings: &Settings) -> SolverReport {
    gather(coupling, memory);
    start(coupling, memory);
    let mut report =
        SolverReport { unique: is_unique(coupling, memory, settings), ..SolverReport::default() };
    loop {
        let seen = match settings.method {
            CouplingMethod::Jacobi => jacobi(memory, settings),
            _ => gauss_seidel(memory, settings),
        };
        report.sweeps += 1;
        let last = report.sweeps >= settings.sweeps;
        if seen <= settings.tolerance || last {
            report.residual = residual(memory, settings);
            report.converged = report.residual <= settings.tolerance;
            if report.converged || last {
                break;
            }
        }
    }
    finish(coupling, memory, settings);
    report
}

/// W between active nodes; all of it is used as it is.
fn gather(coupling: &Coupling, memory: &mut Memory) {
    if memory.gathered == memory.active {
        return;
    }
    let Memory { active, gathered, w, .. } = memory;
    gathered.clear();
    gathered.extend_from_slice(active);
    let (rows, from) = (3 * coupling.nodes(), coupling.inverse());
    let mut to = w.iter_mut();
    for column in active.iter().flat_map(|j| (3 * j..3 * j + 3).map(|j| &from[j * rows..(j + 1) * rows])) {
        for (x, at) in active.iter().flat_map(|i| &column[3 * i..3 * i + 3]).zip(&mut to) {
            *at = *x;
        }
    }
}

/// r-factors and y = W f.
fn start(coupling: &Coupling, memory: &mut Memory) {
    let Memory { active, frames, factors, .. } = memory;
    for &i in active.iter() {
        factors[i] = law::factors(&frames[i], coupling.free_mobility(i));
    }
    rates(memory);
}

fn rates(memory: &mut Memory) {
    let Memory { active, w, rate, f, .. } = memory;
    let rate = &mut rate[..3 * active.len()];
    rate.fill(0.0);
    for (k, &i) in active.iter().enumerate() {
        add(rate, w, k, &f[i]);
    }
}

/// y += W of column k times the force.
#[inline]
fn add(rate: &mut [f64], w: &[f64], k: usize, force: &Vector3<f64>) {
    let rows = rate.len();
    let (x, rest) = w[3 * k * rows..].split_at(rows);
    let (y, rest) = rest.split_at(rows);
    for (((rate, x), y), z) in rate.iter_mut().zip(x).zip(y).zip(&rest[..rows]) {
        *rate += force.x * x + force.y * y + force.z * z;
    }
}

/// lambda and u of the active node k, both in its contact frame.
#[inline]
fn look(memory: &Memory, k: usize, i: usize) -> (Vector3<f64>, Vector3<f64>) {
    let y = Vector3::new(memory.rate[3 * k], memory.rate[3 * k + 1], memory.rate[3 * k + 2]);
    let e = &memory.frames[i];
    (e.tr_mul(&memory.f[i]), e.tr_mul(&(y + memory.c[i])))
}

fn gauss_seidel(memory: &mut Memory, settings: &Settings) -> f64 {
    let rows = 3 * memory.active.len();
    let mut worst = 0.0f64;
    for k in 0..memory.active.len() {
        let i = memory.active[k];
        let (lambda, u) = look(memory, k, i);
        let (t, n) = memory.factors[i];
        let next = law::prox(&lambda, &u, (settings.gamma * t, settings.gamma * n), settings.friction);
        worst = worst.max(law::residual(&(next - lambda), (t, n)));
        let change = memory.frames[i] * (next - lambda);
        memory.f[i] += change;
        add(&mut memory.rate[..rows], &memory.w, k, &change);
    }
    worst
}

fn jacobi(memory: &mut Memory, settings: &Settings) -> f64 {
    let mut worst = 0.0f64;
    for k in 0..memory.active.len() {
        let i = memory.active[k];
        let (lambda, u) = look(memory, k, i);
        let (t, n) = memory.factors[i];
        let next = law::prox(&lambda, &u, (settings.gamma * t, settings.gamma * n), settings.friction);
        worst = worst.max(law::residual(&(next - lambda), (t, n)));
        memory.change[i] = memory.frames[i] * (next - lambda);
    }
    for k in 0..memory.active.len() {
        let i = memory.active[k];
        let change = memory.change[i];
        memory.f[i] += change;
    }
    rates(memory);
    worst
}

/// Distance of the law from holding, whatever gamma.
fn residual(memory: &Memory, settings: &Settings) -> f64 {
    let of = |(k, &i): (usize, &usize)| {
        let (lambda, u) = look(memory, k, i);
        law::residual(
            &(law::prox(&lambda, &u, memory.factors[i], settings.friction) - lambda),
            memory.factors[i],
        )
    };
    memory.active.iter().enumerate().map(of).fold(0.0, f64::max)
}

fn is_unique(coupling: &Coupling, memory: &Memory, settings: &Settings) -> bool {
    let alone = |&i: &usize| {
        let e = &memory.frames[i];
        node::unique(&(e.transpose() * coupling.free_mobility(i) * e), settings.friction)
    };
    memory.active.iter().all(alone)
}

/// One back-substitution: y of all contact nodes, and what each does.
fn finish(coupling: &Coupling, memory: &mut Memory, settings: &Settings) {
    let (rows, w) = (3 * coupling.nodes(), coupling.inverse());
    let rate = &mut memory.rate[..rows];
    rate.fill(0.0);
    for &i in &memory.active {
        add(rate, w, i, &memory.f[i]);
    }
    for (y, rate) in memory.y.iter_mut().zip(rate.chunks_exact(3)) {
        y[..3].copy_from_slice(rate);
    }
    memory.states.fill(PointState::Open);
    for &i in &memory.active {
        let lambda = memory.frames[i].tr_mul(&memory.f[i]);
        let inside = lambda.xy().norm() < settings.friction * lambda.z * (1.0 - 1e-9);
        memory.states[i] = match lambda.z > 0.0 {
            true if inside => PointState::Stick,
            true => PointState::Slip,
            false => PointState::Open,
        };
    }
}
