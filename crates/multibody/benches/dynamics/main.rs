//! Times the dynamics of Lola, accuracy beside speed, beside Pinocchio's C++ in the same run when it is given.
//!
//! `cargo bench -p multibody`, or `tests/peers/pinocchio_bench.sh` with the peer. A time is that of one call in a batch
//! over 128 random states; printed are the minimum (no noise), the median and the 90th percentile of 301 batches. A second
//! table is Lola with 16 motor rotors on joints of their own, 46 degrees of freedom; its last row has the same rotors as
//! gyrostats. Accuracy of M: largest |v^T M v / 2 - kinetic energy| relative; of h and M: M v' + h against inverse
//! dynamics; of the forward dynamics: inverse dynamics of the result against the force. With a peer also the largest
//! difference from it.
#![allow(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![allow(missing_docs, reason = "not a library")]

mod peer;
mod robot;

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use multibody::{Data, Model};
use nalgebra::{DVector, Matrix3xX, Matrix6xX};
use robot::Robot;

const STATES: usize = 128;
const BATCHES: usize = 301;

struct State {
    q: Vec<f64>,
    v: Vec<f64>,
    force: Vec<f64>,
}

/// Times in microseconds, and a relative error.
struct Row {
    name: String,
    times: [f64; 3],
    error: Option<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let peer = arguments.iter().position(|a| a == "--peer").and_then(|k| arguments.get(k + 1));
    let lola = Robot::lola()?;
    compare("Lola, 24 joints", &lola, peer, |s| measure_all(&lola, s))?;
    let elastic = lola.with_rotor_bodies(16)?;
    let gyrostats = lola.with_gyrostats(16)?;
    compare("Lola with 16 rotors", &elastic, peer, |s| {
        let mut rows = measure_all(&elastic, s);
        rows.push(measure_gyrostats(&gyrostats));
        rows
    })
}

/// Twice each, in turn, so that a slow moment of the machine hits both.
fn compare(
    title: &str,
    robot: &Robot,
    peer: Option<&String>,
    ours: impl Fn(&[State]) -> Vec<Row>,
) -> Result<(), Box<dyn Error>> {
    let states = states(&robot.model);
    let before = ours(&states);
    println!("{title}, us per call");
    let Some(peer) = peer else {
        print_table(&before, &[]);
        return Ok(());
    };
    let (theirs, results) = peer::run(peer, robot, &states)?;
    let rows = best(before, ours(&states));
    let (again, _) = peer::run(peer, robot, &states)?;
    print_table(&rows, &best(theirs, again));
    peer::print_differences(&robot.model, &states, &results);
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

fn measure(name: &str, states: &[State], error: Option<f64>, mut call: impl FnMut(&State)) -> Row {
    let mut times: Vec<f64> = (0..BATCHES + 20)
        .map(|_| {
            let start = Instant::now();
            states.iter().for_each(&mut call);
            start.elapsed().as_secs_f64() * 1e6 / states.len() as f64
        })
        .skip(20)
        .collect();
    times.sort_by(f64::total_cmp);
    Row { name: name.into(), times: [times[0], times[BATCHES / 2], times[BATCHES * 9 / 10]], error }
}

fn measure_all(robot: &Robot, states: &[State]) -> Vec<Row> {
    let model = &robot.model;
    let (mut d, mut x) = (Data::new(model), vec![0.0; model.nv()]);
    let accuracy = accuracy(model, states);
    let zero = vec![0.0; model.n()];
    let (feet, limbs) = (&robot.feet, model.limbs(&robot.soles));
    let mut jacobians = feet.map(|_| Matrix6xX::zeros(model.nv()));
    let mut of_cog = Matrix3xX::zeros(model.nv());
    vec![
        measure("mass_matrix", states, Some(accuracy[0]), |s| {
            black_box(model.mass_matrix(&mut d, &s.q));
        }),
        measure("inverse_dynamics", states, Some(accuracy[1]), |s| {
            model.inverse_dynamics(&mut d, &s.q, &s.v, &s.force, black_box(&mut x));
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
        measure("foot_jacobians", states, None, |s| {
            model.forward_kinematics(&mut d, &s.q);
            for (foot, jacobian) in feet.iter().zip(&mut jacobians) {
                model.frame_jacobian(&d, foot, black_box(jacobian));
            }
        }),
        measure("cog_jacobian", states, None, |s| {
            model.forward_kinematics(&mut d, &s.q);
            model.cog(&mut d);
            model.cog_jacobian(&d, black_box(&mut of_cog));
        }),
        measure("set_position", states, None, |s| model.set_position(black_box(&mut d), &s.q)),
        measure("forward_kinematics", states, None, |s| model.forward_kinematics(black_box(&mut d), &s.q)),
        measure("forward_motion", states, None, |s| model.forward_motion(black_box(&mut d), &s.q, &s.v)),
        measure("base_dynamics", states, None, |s| {
            black_box(model.base_dynamics(&mut d, &s.q, &s.v, &zero));
        }),
        // One right-hand side of simulation type 1 but for contacts: soles, base dynamics, solution.
        measure("reduced_model", states, None, |s| {
            model.set_position(&mut d, &s.q);
            model.limb_motion_here(&mut d, &limbs, &s.v);
            let (m, bias) = model.base_dynamics_here(&mut d, &s.v, &zero);
            black_box(m.cholesky().map(|c| c.solve(&-bias)));
        }),
    ]
}

/// Forward dynamics with the rotors' accelerations, the same degrees of freedom as with bodies.
fn measure_gyrostats(model: &Model) -> Row {
    let (mut d, mut x) = (Data::new(model), vec![0.0; model.nv()]);
    let rotors = model.rotor_names().len();
    let mut accelerations = vec![0.0; rotors];
    measure("forward_gyrostats", &states(model), None, |s| {
        for k in 0..rotors {
            d.set_free_rotor(k, s.v[k], s.force[k]);
        }
        model.forward_dynamics(&mut d, &s.q, &s.v, &s.force, black_box(&mut x));
        for (k, a) in accelerations.iter_mut().enumerate() {
            *a = model.rotor_acceleration(&d, k);
        }
        black_box(&accelerations);
    })
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

fn print_table(rows: &[Row], theirs: &[Row]) {
    println!(
        "{:22}{:>8}{:>8}{:>8}{:>12}   Pinocchio: min, median, p90, ratio of medians",
        "", "min", "median", "p90", "error"
    );
    for r in rows {
        let error = r.error.map_or(String::new(), |e| format!("{e:.1e}"));
        print!("{:22}{:8.3}{:8.3}{:8.3}{error:>12}", r.name, r.times[0], r.times[1], r.times[2]);
        // Gyrostats stand against the fastest that the peer has for bodies.
        let same = if r.name == "forward_gyrostats" { "forward_articulated" } else { &r.name };
        if let Some(t) = theirs.iter().find(|t| t.name == same) {
            let [min, median, p90] = t.times;
            print!("   {min:8.3}{median:8.3}{p90:8.3}  {:.2}", r.times[1] / median);
        }
        println!();
    }
}
