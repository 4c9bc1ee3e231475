//! Times the eight pads of Lola, 108 degrees of freedom each, with sweeps and residuals beside the times.
//!
//! `cargo bench -p contact`. One evaluation is all eight pads, one after the other; from one to the next the state has
//! moved on by 1 ms (warm), or the memory is cleared before (cold). Printed are minimum, median and 90th percentile over
//! the states of a scene, each the least of 5 runs; sweeps are the mean of a pad, the residual is the worst.
#![allow(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![allow(missing_docs, reason = "not a library")]

use std::f64::consts::TAU;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use contact::hexahedron::{LinearElasticity, Volume};
use contact::{CouplingMethod, Ground, Layer, Material, Memory, Pad, SegmentMotion, Settings};
use nalgebra::Vector3;

const PADS: usize = 8;
const STATES: usize = 200;
const RUNS: usize = 5;

/// What one pad sees at one instant.
struct Instance {
    d: Vec<f64>,
    ground: Vec<Option<Ground>>,
    twist: SegmentMotion,
}

/// Motion of the foot and the ground below; `(time, x of a node) -> height`.
struct Scene {
    name: &'static str,
    friction: f64,
    shear: f64,
    /// \[m\] Ground only ahead of here.
    edge: f64,
}

const SCENES: [Scene; 5] = [
    Scene { name: "standing, swaying", friction: 0.7, shear: 0.002, edge: -1.0 },
    Scene { name: "rolling, partly sliding", friction: 0.3, shear: 0.03, edge: -1.0 },
    Scene { name: "sliding", friction: 0.2, shear: 0.3, edge: -1.0 },
    Scene { name: "on an edge", friction: 0.7, shear: 0.005, edge: 0.1 },
    Scene { name: "on its last row of nodes", friction: 0.7, shear: 0.005, edge: 0.125 },
];

fn layer(poisson: f64) -> Arc<Layer> {
    let elasticity = LinearElasticity { modulus: 4.643e5, poisson };
    let size = [0.06, 0.04, 0.012];
    let material =
        Material { size, bricks: [5, 5, 1], elasticity, volume: Volume::Mean, damping_time: 0.008 };
    Arc::new(Layer::new(&material).expect("the material is good"))
}

/// Pressure of 60 kg on eight pads, turning and shearing with 2 Hz; states 1 ms apart of steps of 0.1 ms.
fn record(pad: &Pad, scene: &Scene, phase: f64) -> Vec<Instance> {
    let settings = Settings::of_friction(scene.friction);
    let (n, m) = (pad.layer().contacts(), pad.layer().nodes());
    let (mut memory, mut d, mut dd) = (pad.memory(), vec![0.0; 3 * m], vec![0.0; 3 * m]);
    let mut states = Vec::new();
    let h = 1e-4;
    let (mut x, mut angle) = (Vector3::new(0.0, 0.0, -5.9e-4), 0.0);
    for step in 0..3000 + 10 * STATES {
        let t = h * step as f64;
        let swing = (TAU * 2.0 * t + phase).sin();
        let twist = SegmentMotion {
            linear: Vector3::new(scene.shear, 0.3 * scene.shear, 1e-3) * swing,
            angular: Vector3::new(0.0, 0.03 * swing, 0.1 * scene.shear * swing),
        };
        let ground: Vec<_> = (0..n)
            .map(|i| {
                let place = pad.place(i);
                let gap = x.z - angle * place.x + d[3 * i + 2];
                (place.x > scene.edge).then_some(Ground { gap, normal: Vector3::z() })
            })
            .collect();
        if step >= 3000 && step % 10 == 0 {
            states.push(Instance { d: d.clone(), ground: ground.clone(), twist });
        }
        pad.solve(&mut memory, &d, &ground, &twist, &settings, &mut dd);
        d.iter_mut().zip(&dd).for_each(|(d, dd)| *d += h * dd);
        x += twist.linear * h;
        angle += twist.angular.y * h;
    }
    states
}

struct Row {
    times: Vec<f64>,
    sweeps: f64,
    residual: f64,
    kinds: [usize; 3],
}

fn measure(pads: &[Pad], seen: &[Vec<Instance>], settings: &Settings, cold: bool) -> Row {
    let mut memories: Vec<Memory> = pads.iter().map(Pad::memory).collect();
    let mut dd = vec![0.0; 3 * pads[0].layer().nodes()];
    let mut row = Row { times: vec![f64::INFINITY; STATES], sweeps: 0.0, residual: 0.0, kinds: [0; 3] };
    // Times: of several runs the shortest, since whatever else the machine does only adds.
    for run in 0..RUNS {
        for k in 0..STATES {
            if cold {
                memories.iter_mut().for_each(Memory::clear);
            }
            let start = Instant::now();
            for ((pad, memory), seen) in pads.iter().zip(&mut memories).zip(seen) {
                let Instance { d, ground, twist } = &seen[k];
                black_box(pad.solve(memory, black_box(d), ground, twist, settings, &mut dd));
            }
            row.times[k] = row.times[k].min(start.elapsed().as_secs_f64() * 1e6);
            for memory in memories.iter().filter(|_| run == 0) {
                memory.states().iter().for_each(|s| row.kinds[*s as usize] += 1);
            }
        }
    }
    // Sweeps and residuals in a run of their own, which is not timed.
    memories.iter_mut().for_each(Memory::clear);
    for k in 0..STATES {
        for ((pad, memory), seen) in pads.iter().zip(&mut memories).zip(seen) {
            if cold {
                memory.clear();
            }
            let Instance { d, ground, twist } = &seen[k];
            let report = pad.solve(memory, d, ground, twist, settings, &mut dd).report;
            row.sweeps += f64::from(report.sweeps);
            row.residual = row.residual.max(report.residual);
        }
    }
    row.sweeps /= (STATES * PADS) as f64;
    row.times.sort_by(f64::total_cmp);
    row
}

fn main() {
    println!(
        "eight pads, microseconds: least, median, 90 %; sweeps; residual (of 0.1 N, 1 mm/s); open/stick/slip %"
    );
    for poisson in [0.3] {
        let layer = layer(poisson);
        let pads: Vec<Pad> =
            (0..PADS).map(|_| Pad::new(layer.clone(), Vector3::new(0.1, 0.05, 0.0))).collect();
        for scene in &SCENES {
            // Eight pads, each an eighth of a period later than the one before: not all in the same state.
            let seen: Vec<_> =
                (0..PADS).map(|k| record(&pads[k], scene, k as f64 * TAU / PADS as f64)).collect();
            println!("\nnu = {poisson}, {}", scene.name);
            for (method, tolerance, cold) in [
                (CouplingMethod::GaussSeidel, 1e-3, false),
                (CouplingMethod::Velocity, 1e-3, false),
                (CouplingMethod::Fastest, 1e-3, false),
                (CouplingMethod::Fastest, 1e-6, false),
                (CouplingMethod::Fastest, 1e-3, true),
            ] {
                let settings = Settings { method, tolerance, ..Settings::of_friction(scene.friction) };
                let row = measure(&pads, &seen, &settings, cold);
                let at = |q: usize| row.times[(STATES - 1) * q / 100];
                let part = row.kinds.map(|k| k * 100 / row.kinds.iter().sum::<usize>().max(1));
                let start = if cold { "cold" } else { "warm" };
                println!(
                    "{:<12} {tolerance:.0e} {start}: {:7.1} {:7.1} {:7.1}; {:5.1}; {:.1e}; {part:?}",
                    format!("{method:?}"),
                    at(0),
                    at(50),
                    at(90),
                    row.sweeps,
                    row.residual
                );
            }
        }
    }
}
