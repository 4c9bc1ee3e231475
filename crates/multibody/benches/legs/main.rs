//! Times a leg in closed form, accuracy beside speed, beside Pinocchio's iterative inverse kinematics in C++ when given.
//!
//! `cargo bench -p multibody --bench legs`, or `tests/peers/pinocchio_legs_bench.sh` with the peer. A time is that of one call in a
//! batch over 1024 random postures of the left leg of tables 3.1 (thesis of 2013); printed are the minimum (no noise), the
//! median and the 90th percentile of 301 batches. Error: largest difference \[rad\] from the angles that the pose was made
//! from. The peer begins 0.02 rad off in every joint, as from a point of a plan before, and at one bent posture for all.
#![allow(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![allow(missing_docs, reason = "not a library")]

use std::error::Error;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;
use std::hint::black_box;
use std::process::{Command, Stdio};
use std::time::Instant;

use multibody::{ClosedFormLeg, DhRow};
use nalgebra::{Matrix3, Vector3};

const POSTURES: usize = 1024;
const BATCHES: usize = 301;

/// a \[m\], alpha \[rad\], d \[m\].
const ROWS: [[f64; 3]; 6] = [
    [0.08, FRAC_PI_2, 0.0],
    [0.26, 0.0, 0.0],
    [0.30, 0.0, -0.074],
    [0.0, -FRAC_PI_2, 0.0],
    [0.0, -FRAC_PI_2, 0.0],
    [0.056, 0.0, 0.04],
];

type Pose = (Matrix3<f64>, Vector3<f64>);

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let peer = arguments.iter().position(|a| a == "--peer").and_then(|k| arguments.get(k + 1));
    let leg = ClosedFormLeg::new(&ROWS.map(|[a, alpha, d]| DhRow { a, alpha, d, theta: 0.0 }))?;
    let postures = postures();
    let poses: Vec<Pose> = postures.iter().map(|q| leg.pose(q)).collect();

    println!("leg of six joints, us per call{:12}min  median     p90       error", "");
    let mut error = 0.0_f64;
    for (q, (r, p)) in postures.iter().zip(&poses) {
        let back = leg.angles(r, p)?;
        error = q.iter().zip(back).fold(error, |m, (a, b)| m.max((a - b).abs()));
    }
    row(
        "closed form, angles",
        times(&poses, |(r, p)| {
            let _ = black_box(leg.angles(r, p));
        }),
        error,
    );
    row(
        "product of rows, pose",
        times(&postures, |q| {
            black_box(leg.pose(q));
        }),
        0.0,
    );
    if let Some(peer) = peer {
        run(peer, &postures, &poses)?;
    }
    Ok(())
}

/// Within Archie's software ranges.
fn postures() -> Vec<[f64; 6]> {
    let mut seed = 1u64;
    let mut unit = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let posture = |_| {
        let q = [23.0, 58.0, 43.0, 68.0, 28.0, 18.0].map(|half| half * unit());
        [q[0], q[1], q[2] - 45.0, q[3] + 30.0, q[4] + 90.0, q[5]].map(f64::to_radians)
    };
    // The hip over the ankle, as it is in walking.
    let high = |q: &[f64; 6]| 0.26 * q[1].cos() + 0.30 * (q[1] + q[2]).cos() > 0.2;
    (0..).map(posture).filter(high).take(POSTURES).collect()
}

fn times<T>(cases: &[T], mut call: impl FnMut(&T)) -> [f64; 3] {
    let batch = |_| {
        let start = Instant::now();
        cases.iter().for_each(&mut call);
        start.elapsed().as_secs_f64() * 1e6 / cases.len() as f64
    };
    let mut times: Vec<f64> = (0..BATCHES + 20).map(batch).skip(20).collect();
    times.sort_by(f64::total_cmp);
    [times[0], times[BATCHES / 2], times[BATCHES * 9 / 10]]
}

fn row(name: &str, [min, median, p90]: [f64; 3], error: f64) {
    println!("{name:38}{min:8.3}{median:8.3}{p90:8.3}{error:12.1e}");
}

/// Rows, then for each posture its angles and pose, as the peer reads them; it prints rows of the same table.
fn run(peer: &str, postures: &[[f64; 6]], poses: &[Pose]) -> Result<(), Box<dyn Error>> {
    let file = std::env::temp_dir().join(format!("multibody_legs_{}", std::process::id()));
    let mut text = String::new();
    for numbers in &ROWS {
        writeln!(text, "{:?} {:?} {:?}", numbers[0], numbers[1], numbers[2])?;
    }
    for (q, (r, p)) in postures.iter().zip(poses) {
        for x in q.iter().chain(r.transpose().iter()).chain(p.iter()) {
            assert!(x.abs() < PI);
            write!(text, "{x:?} ")?;
        }
        text.push('\n');
    }
    std::fs::write(&file, text)?;
    let answer = Command::new(peer).arg(&file).stdout(Stdio::inherit()).status()?;
    std::fs::remove_file(&file)?;
    if answer.success() { Ok(()) } else { Err(format!("{peer}: {answer}").into()) }
}
