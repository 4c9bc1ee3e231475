//! A joint with the dry friction of the gear HFUC-25-100 that sticks, slides and turns round (chart 4).
//!
//! ```text
//! J w' = A sin(2 pi t) - T_f,   T_f = T_0 sgn w, at rest whatever holds it up to T_0
//! ```
//!
//! J = 1 kg m^2, T_0 = 10.4 N m, A = 14 N m: the joint rests in every half period. Exact: pieces in closed form between
//! the times at which it lets go and stops. The problem is "stiction_rests" of tests/peers/lsoda.py.

use std::error::Error;
use std::f64::consts::TAU;

use drives::Sliding;

use crate::search::{NoBorder, Width, middle};

use super::system::{SteppingMethod, System, SystemMotion, Times, largest};
use super::{AccuracyInput, Cost, ErrorChart, Part, Point};

pub(super) const PART: Part = charts;

const T_0: f64 = 10.4;
const A: f64 = 14.0;
const TIMES: Times = Times { every: 0.01, count: 200 };
const STEPS: [f64; 8] = [1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 2e-5];

fn charts(_: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let about = "14 N m of load at 1 Hz against 10.4 N m of dry friction, 2 s. Reference: closed form between events.";
    let title = "A joint that sticks and slides";
    let measure = "largest error of the angle [rad]";
    let mut calls = ErrorChart::new("stiction.calls", title, measure).over(Cost::Calls).about(about);
    let mut time = ErrorChart::new("stiction.time", title, measure).about(about);
    let exact = exact();
    let mut add = |method: SteppingMethod, name: &str, joint: &mut StickingJoint, solver: Option<String>| {
        let (motion, mut point) = method.measure(joint, &[0.0, 0.0], TIMES);
        let error = largest(&motion, &exact, |a, b| (a[0] - b[0]).abs());
        point =
            Point { scene: "joint".into(), model: "friction".into(), method: name.into(), error, ..point };
        point.solver = solver.or(point.solver);
        calls.add(point.clone());
        time.add(point);
    };
    for h in STEPS {
        add(SteppingMethod::Euler(h), "sign, Euler", &mut StickingJoint { smooth: 0.0 }, None);
        add(SteppingMethod::Own("prox", h), "prox, Euler", &mut StickingJoint { smooth: 0.0 }, None);
    }
    for smooth in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
        add(
            SteppingMethod::Bdf(1e-8),
            "tanh, BDF",
            &mut StickingJoint { smooth },
            Some(format!("{smooth:.0e} rad/s")),
        );
    }
    for tolerance in [1e-2, 1e-3, 1e-4, 1e-5] {
        add(SteppingMethod::Bdf(tolerance), "sign, BDF", &mut StickingJoint { smooth: 0.0 }, None);
    }
    calls.expect_order("prox, Euler", 1.0, 1e-5..=2e-3);
    calls.expect_order("sign, Euler", 1.0, 1e-5..=2e-3);
    Ok(vec![calls, time])
}

/// x = (angle, speed).
struct StickingJoint {
    /// \[rad/s\] Speed over which friction changes its sign; 0: at once.
    smooth: f64,
}

fn load(t: f64) -> f64 {
    A * (TAU * t).sin()
}

impl System for StickingJoint {
    fn rate(&mut self, t: f64, x: &[f64], dx: &mut [f64]) {
        let sign = match x[1] {
            0.0 => 0.0,
            w if self.smooth == 0.0 => w.signum(),
            w => (w / self.smooth).tanh(),
        };
        (dx[0], dx[1]) = (x[1], load(t) - T_0 * sign);
    }

    /// Friction of the end of the step, as in the drives of the simulated robot.
    fn own_step(&mut self, t: f64, h: f64, x: &mut [f64]) {
        x[1] = Sliding { dry: T_0, viscous: 0.0 }.speed_after(x[1] + h * load(t + h), h);
        x[0] += h * x[1];
    }
}

/// The motion at the times: symmetric, since each half period begins at rest and ends so.
fn exact() -> SystemMotion {
    let go = (T_0 / A).asin() / TAU;
    let speed = |t: f64| A / TAU * ((TAU * go).cos() - (TAU * t).cos()) - T_0 * (t - go);
    let slides = |t: f64| Ok::<_, NoBorder>(speed(t) > 0.0);
    let stop = middle([0.25, 0.5 + go], Width::Exact, slides).expect("it comes to rest once");
    let way = |t: f64| {
        let s = t.clamp(go, stop) - go;
        let swing = ((TAU * (go + s)).sin() - (TAU * go).sin()) / TAU;
        A / TAU * (s * (TAU * go).cos() - swing) - 0.5 * T_0 * s * s
    };
    let seen = (1..=TIMES.count).map(|k| {
        let t = k as f64 * TIMES.every;
        let (halves, rest) = ((t / 0.5 + 1e-9).floor(), t % 0.5);
        let rest = if rest > 0.5 - 1e-9 { 0.0 } else { rest };
        // Odd halves go back what even ones went.
        let q = if halves % 2.0 == 0.0 { way(rest) } else { way(0.5) - way(rest) };
        vec![q, f64::NAN]
    });
    SystemMotion { seen: seen.collect(), ..SystemMotion::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times of letting go and stopping, and the end, as tests/peers/lsoda.py has them.
    #[test]
    fn exact_motion_is_that_of_the_peer() {
        let motion = exact();
        assert!(motion.seen[199][0].abs() < 1e-14 && motion.seen[12][0] == 0.0 && motion.seen[13][0] > 0.0);
        let (a, b) = (motion.seen[48][0], motion.seen[50][0]);
        assert!(
            b > a && motion.seen[62][0] == b && motion.seen[64][0] < b,
            "rests from 0.4906 s to 0.6333 s"
        );
    }

    #[test]
    fn the_implicit_step_is_of_first_order_and_rests() {
        let error = |h| {
            let motion =
                SteppingMethod::Own("prox", h).run(&mut StickingJoint { smooth: 0.0 }, &[0.0, 0.0], TIMES);
            assert_eq!(motion.seen[59][1], 0.0);
            largest(&motion, &exact(), |a, b| (a[0] - b[0]).abs())
        };
        // tests/peers/lsoda.py, prox_euler: 5.5500e-4 and 2.7757e-4.
        assert!((error(1e-3) - 5.54999e-4).abs() < 1e-8 && (error(5e-4) - 2.77568e-4).abs() < 1e-8);
    }

    /// The reference of charts without a closed form, where there is one: between events nothing is left of the first order,
    /// and the estimate of its error holds.
    #[test]
    fn the_extrapolated_motion_is_the_exact_one_within_its_estimate() {
        use crate::accuracy::reference::{limit, limits};
        for h in [1e-3, 2.5e-4] {
            let run = |h| {
                let mut joint = StickingJoint { smooth: 0.0 };
                SteppingMethod::Own("prox", h).run(&mut joint, &[0.0, 0.0], TIMES).seen
            };
            let of = |fine: &Vec<Vec<f64>>, coarse: &Vec<Vec<f64>>| {
                fine.iter().zip(coarse).map(|(f, c)| limit(f, c)).collect::<Vec<_>>()
            };
            let motions = [run(h), run(2.0 * h), run(4.0 * h)];
            let apart = |a: &[Vec<f64>], b: &[Vec<f64>]| {
                a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f64::max)
            };
            let [reference, coarser] = limits(&motions, of);
            let (error, estimate) = (apart(&reference, &exact().seen), apart(&reference, &coarser));
            assert!(
                error < estimate && error < 0.05 * apart(&motions[0], &exact().seen),
                "{error} {estimate}"
            );
        }
    }
}
