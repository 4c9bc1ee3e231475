//! Sweeps over the velocities of the nodes: the law of each solved exactly with its neighbours' velocities held.
//!
//! With the others held, f_i = S_ii y_i + s with s = sum S_ij y_j, so u_i = G f_i + (c_i - G s), G = S_ii^-1: the node of
//! errata 1, F7. Beside algorithm 1, which sweeps over forces, this has two gains. A node that sticks has y = -c however
//! hard it is pressed, so a sole that stands is solved in one pass; and a node of a layer of bricks has 8 neighbours, not
//! 35. Only nodes whose neighbours have moved are looked at again. The iteration ends with a pass that moves nothing.
//!
//! Forces are inside the cone and zero where a node is open, nodes that stick do not creep, all of it exactly; what is
//! left to the tolerance is the balance f = S y.

use nalgebra::{Vector2, Vector3};

use crate::coupling::Coupling;
use crate::frame::frame;
use crate::law::{self, Settings, SolverReport};
use crate::memory::Memory;
use crate::node;
use crate::point::PointState;

/// Finds y and f from c, starting from y and the states of the last call.
pub(crate) fn solve(coupling: &Coupling, memory: &mut Memory, settings: &Settings) -> SolverReport {
    start(memory);
    let mut report = SolverReport { unique: true, ..SolverReport::default() };
    while report.sweeps < settings.sweeps {
        let worst = sweep(coupling, memory, settings, &mut report.unique);
        report.sweeps += 1;
        report.residual = worst;
        if worst <= settings.tolerance {
            report.converged = true;
            break;
        }
    }
    report
}

/// Nodes that stuck or were open and come down stick; the others go on as they did.
fn start(memory: &mut Memory) {
    let Memory { y, c, states, touching, normals, stale, framed, .. } = memory;
    stale.fill(true);
    framed.fill(false);
    for i in 0..y.len() {
        let now = Vector3::new(y[i][0], y[i][1], y[i][2]);
        let sinks = states[i] == PointState::Open && normals[i].dot(&(now + c[i])) < 0.0;
        if touching[i] && (states[i] == PointState::Stick || sinks) {
            y[i] = [-c[i].x, -c[i].y, -c[i].z, 0.0];
            states[i] = PointState::Stick;
        }
    }
}

fn sweep(coupling: &Coupling, memory: &mut Memory, settings: &Settings, unique: &mut bool) -> f64 {
    let mut worst = 0.0f64;
    for i in 0..memory.y.len() {
        if !std::mem::replace(&mut memory.stale[i], false) {
            continue;
        }
        let s = coupling.pull(i, &memory.y);
        let y = visit(coupling, memory, settings, i, &s, unique);
        let old = Vector3::new(memory.y[i][0], memory.y[i][1], memory.y[i][2]);
        let change = y - old;
        if change == Vector3::zeros() {
            continue;
        }
        let residual = (change.norm() / law::SCALE.1).max((coupling.own(i) * change).norm() / law::SCALE.0);
        worst = worst.max(residual);
        if residual > settings.tolerance {
            memory.y[i] = [y.x, y.y, y.z, 0.0];
            for neighbour in coupling.neighbours(i) {
                memory.stale[neighbour.node] = true;
            }
        }
    }
    worst
}

/// y of node i by its law; sets its force and state.
#[inline]
fn visit(
    coupling: &Coupling,
    memory: &mut Memory,
    settings: &Settings,
    i: usize,
    s: &Vector3<f64>,
    unique: &mut bool,
) -> Vector3<f64> {
    let (g, c, n) = (coupling.held_mobility(i), memory.c[i], memory.normals[i]);
    let (f, state) = (&mut memory.f[i], &mut memory.states[i]);
    if memory.touching[i] {
        let stick = s - coupling.own(i) * c;
        let normal = n.dot(&stick);
        let square = stick.norm_squared() - normal * normal;
        if normal > 0.0 && square <= (settings.friction * normal).powi(2) {
            (*f, *state) = (stick, PointState::Stick);
            return -c;
        }
        let free = c - g * s;
        if n.dot(&free) < 0.0 {
            let (e, local) = (&mut memory.frames[i], &mut memory.mobilities[i]);
            if !std::mem::replace(&mut memory.framed[i], true) {
                *e = frame(&n);
                *local = e.transpose() * g * *e;
                *unique &= node::unique(local, settings.friction);
            }
            // A node that has slid goes on much as it did.
            let before = if *state == PointState::Slip { *f } else { stick };
            let hint = e.tr_mul(&before).xy().try_normalize(f64::MIN_POSITIVE).map_or(Vector2::x(), |t| -t);
            if let Some(force) = node::slide(local, &e.tr_mul(&free), settings.friction, hint) {
                (*f, *state) = (*e * force, PointState::Slip);
                return g * (*f - s);
            }
        }
    }
    (*f, *state) = (Vector3::zeros(), PointState::Open);
    -(g * s)
}
