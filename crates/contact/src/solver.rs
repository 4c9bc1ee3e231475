//! Forces between coupled nodes and the ground, by the method of the settings.
//!
//! The problem is one [`Coupling`] and, per node, c and the normal of the ground if it touches; both stand in the
//! [`Memory`], which also holds the answer. What a pad adds is where they come from: [`crate::pad`].

use crate::coupling::Coupling;
use crate::frame::frame;
use crate::law::{CouplingMethod, Settings, SolverReport};
use crate::memory::Memory;
use crate::point::PointState;
use crate::{prox, velocity};

/// Sweeps over velocities are the faster ones when at least this share of the nodes touches ...
const FEW: f64 = 0.25;
/// ... and at most this share of those slid in the last call (`benches/pads.rs`).
const MANY: f64 = 0.7;

/// Finds forces and velocities of the nodes that were [set](Memory::set), starting from those of the last call.
pub fn solve(coupling: &Coupling, memory: &mut Memory, settings: &Settings) -> SolverReport {
    let slid = memory.active.iter().filter(|i| memory.states[**i] == PointState::Slip).count() as f64;
    let touch = memory.active.len() as f64;
    let most = touch > FEW * coupling.nodes() as f64 && slid < MANY * touch;
    let mut before = 0;
    if settings.method == CouplingMethod::Velocity || (settings.method == CouplingMethod::Fastest && most) {
        let report = velocity::solve(coupling, memory, settings);
        if report.converged || settings.method == CouplingMethod::Velocity {
            return report;
        }
        before = report.sweeps;
    }
    for k in 0..memory.active.len() {
        let i = memory.active[k];
        memory.frames[i] = frame(&memory.normals[i]);
    }
    let report = prox::solve(coupling, memory, settings);
    SolverReport { sweeps: before + report.sweeps, ..report }
}
