//! Times the dynamics of Lola, accuracy beside speed, beside Pinocchio's C++ in the same run when it is given.
//!
//! `cargo bench -p multibody`, or `tests/peers/pinocchio_bench.sh` with the peer. A time is that of one call in a batch
//! over 128 random states; printed are the minimum (no noise), the median and the 90th percentile of 301 batches.
//! Accuracy of M: largest |v^T M v / 2 - kinetic energy| relative; of h and M: M v' + h against inverse dynamics; of the
//! forward dynamics: inverse dynamics of the result against the force. With a peer also the largest difference from it.
#![allow(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![allow(missing_docs, reason = "not a library")]

mod peer;

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use multibody::{Data, Model};
use nalgebra::{DVector, Matrix6xX};

const STATES: usize = 128;
const BATCHES: usize = 301;

struct State {
    q: Vec<f64>,
    v: Vec<f64>,
    force: Vec<f64>,
}

/// Times in microseconds, and a relative error.
struct Row {
    name: &'static str,
    times: [f64; 3],
    error: Option<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let peer = arguments.iter().position(|a| a == "--peer").and_then(|k| arguments.get(k + 1));
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/robots/lola/lola.urdf");
    // Pinocchio has its fast kernels for +x, +y, +z only; with Lola's axes turned positive both can use theirs.
    let urdf = std::fs::read_to_string(path)?
        .replace("<axis xyz=\"-1 0 0", "<axis xyz=\"1 0 0")
        .replace("<axis xyz=\"0 -1 0", "<axis xyz=\"0 1 0");
    let robot = urdf_rs::read_from_string(&urdf)?;
    let movable = robot.joints.iter().filter(|j| j.joint_type != urdf_rs::JointType::Fixed);
    let names: Vec<&str> = movable.map(|j| j.name.as_str()).collect();
    let model = Model::from_urdf(&urdf, "torso", &names)?;
    let states = states(&model);

    let before = measure_all(&model, &states);
    let Some(peer) = peer else {
        print_table(&before, None);
        return Ok(());
    };
    // Twice each, in turn, so that a slow moment of the machine hits both.
    let (theirs, results) = peer::run(peer, &robot, &names, &states)?;
    let rows = best(before, measure_all(&model, &states));
    let (again, _) = peer::run(peer, &robot, &names, &states)?;
    print_table(&rows, Some(&best(theirs, again)));
    peer::print_differences(&model, &states, &results);
    Ok(())
}

fn states(model: &Model) -> Vec<State> {
    let mut seed = 1u64;
    let mut random = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let mut list = |n: usize, size: f64| -> Vec<f64> { (0..n).map(|_| random() * size).collect() };
    let state = |_| {
        let mut q = list(model.nq(), 1.5);
        let norm = q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
        q[3..7].iter_mut().for_each(|x| *x /= norm);
        State { q, v: list(model.nv(), 2.0), force: list(model.nv(), 50.0) }
    };
    (0..STATES).map(state).collect()
}

fn measure(name: &'static str, states: &[State], error: Option<f64>, mut call: impl FnMut(&State)) -> Row {
    let mut times: Vec<f64> = (0..BATCHES + 20)
        .map(|_| {
            let start = Instant::now();
            states.iter().for_each(&mut call);
            start.elapsed().as_secs_f64() * 1e6 / states.len() as f64
        })
        .skip(20)
        .collect();
    times.sort_by(f64::total_cmp);
    Row { name, times: [times[0], times[BATCHES / 2], times[BATCHES * 9 / 10]], error }
}

fn measure_all(model: &Model, states: &[State]) -> Vec<Row> {
    let mut d = Data::new(model);
    let mut x = vec![0.0; model.nv()];
    let accuracy = accuracy(model, states);
    let zero = vec![0.0; model.n()];
    let foot = model.frame(model.link_names().last().expect("a link"), [0.0; 3]).expect("the link exists");
    let mut jacobian = Matrix6xX::zeros(model.n());
    vec![
        measure("mass_matrix", states, Some(accuracy[0]), |s| {
            black_box(model.mass_matrix(&mut d, &s.q));
        }),
        measure("nonlinear_terms", states, Some(accuracy[1]), |s| {
            model.nonlinear_terms(&mut d, &s.q, &s.v, black_box(&mut x));
        }),
        measure("forward_matrix", states, Some(accuracy[2]), |s| {
            model.forward_dynamics(&mut d, &s.q, &s.v, &s.force, black_box(&mut x));
        }),
        measure("forward_articulated", states, Some(accuracy[3]), |s| {
            model.forward_dynamics_articulated(&mut d, &s.q, &s.v, &s.force, black_box(&mut x));
        }),
        measure("base_dynamics", states, None, |s| {
            black_box(model.base_dynamics(&mut d, &s.q, &s.v, &zero));
        }),
        measure("forward_kinematics", states, None, |s| model.forward_kinematics(black_box(&mut d), &s.q)),
        measure("forward_motion", states, None, |s| model.forward_motion(black_box(&mut d), &s.q, &s.v)),
        measure("frame_jacobian", states, None, |_| {
            model.frame_jacobian_of_joints(&d, black_box(&foot), &mut jacobian);
        }),
    ]
}

/// Errors of M, h, and forward dynamics by both routes, by identities between them.
fn accuracy(model: &Model, states: &[State]) -> [f64; 4] {
    let mut d = Data::new(model);
    let mut worst = [0.0_f64; 4];
    let (mut h, mut a, mut f) = (vec![0.0; model.nv()], vec![0.0; model.nv()], vec![0.0; model.nv()]);
    for s in states {
        let v = DVector::from_column_slice(&s.v);
        let m = model.mass_matrix(&mut d, &s.q).clone();
        model.forward_motion(&mut d, &s.q, &s.v);
        let kinetic = model.energy(&d).0;
        worst[0] = worst[0].max((0.5 * v.dot(&(&m * &v)) - kinetic).abs() / kinetic);
        model.nonlinear_terms(&mut d, &s.q, &s.v, &mut h);
        model.inverse_dynamics(&mut d, &s.q, &s.v, &s.force, &mut f);
        let sum = m * DVector::from_column_slice(&s.force) + DVector::from_column_slice(&h);
        worst[1] = worst[1].max(difference(sum.as_slice(), &f));
        model.forward_dynamics(&mut d, &s.q, &s.v, &s.force, &mut a);
        model.inverse_dynamics(&mut d, &s.q, &s.v, &a, &mut f);
        worst[2] = worst[2].max(difference(&f, &s.force));
        model.forward_dynamics_articulated(&mut d, &s.q, &s.v, &s.force, &mut a);
        model.inverse_dynamics(&mut d, &s.q, &s.v, &a, &mut f);
        worst[3] = worst[3].max(difference(&f, &s.force));
    }
    worst
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    let scale = b.iter().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
    a.iter().zip(b).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs())) / scale
}

fn best(a: Vec<Row>, b: Vec<Row>) -> Vec<Row> {
    a.into_iter().zip(b).map(|(a, b)| if a.times[1] <= b.times[1] { a } else { b }).collect()
}

fn print_table(rows: &[Row], theirs: Option<&[Row]>) {
    println!("Lola, 24 joints, us per call");
    println!(
        "{:22}{:>8}{:>8}{:>8}{:>12}   Pinocchio: min, median, p90, ratio of medians",
        "", "min", "median", "p90", "error"
    );
    for (k, r) in rows.iter().enumerate() {
        let error = r.error.map_or(String::new(), |e| format!("{e:.1e}"));
        print!("{:22}{:8.3}{:8.3}{:8.3}{error:>12}", r.name, r.times[0], r.times[1], r.times[2]);
        match theirs.and_then(|t| t.get(k)) {
            Some(t) => println!(
                "   {:8.3}{:8.3}{:8.3}  {:.2}",
                t.times[0],
                t.times[1],
                t.times[2],
                r.times[1] / t.times[1]
            ),
            None => println!(),
        }
    }
}
