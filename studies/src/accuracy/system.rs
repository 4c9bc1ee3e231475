//! A small system, moved by any method and seen at equally spaced times.

use config::method::Integrator;
use sim_backend::integrate::Stepper;
use sim_backend::stiff::{GaveUp, Stiff, StiffLimits};

use super::{Point, cost};

/// Equations of motion.
pub trait System {
    /// Writes x'(t, x).
    fn rate(&mut self, t: f64, x: &[f64], dx: &mut [f64]);

    /// A step of first order of the system's own: implicit in part, or by events.
    fn own_step(&mut self, t: f64, h: f64, x: &mut [f64]);
}

/// How it is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SteppingMethod {
    /// Explicit Euler, by steps \[s\].
    Euler(f64),
    /// The system's own step, with its name.
    Own(&'static str, f64),
    /// Classical Runge-Kutta.
    RungeKutta4(f64),
    /// Adaptive stiff method of a tolerance.
    Bdf(f64),
}

/// What is seen of a motion: states at `count` times, `every` \[s\] apart, the first one after the start.
#[derive(Clone, Copy, Debug)]
pub struct Times {
    /// \[s\]
    pub every: f64,
    /// How many.
    pub count: usize,
}

/// A motion.
#[derive(Clone, Debug, Default)]
pub struct SystemMotion {
    /// States at the times.
    pub seen: Vec<Vec<f64>>,
    /// Evaluations of the rates.
    pub calls: u64,
    /// How an adaptive method ended early.
    pub gave_up: Option<GaveUp>,
}

/// Evaluations after which an adaptive method gives up, between two times.
const MOST_CALLS: u32 = 400_000;

impl SteppingMethod {
    /// Name of its curve.
    pub fn name(&self) -> String {
        match self {
            Self::Euler(_) => "Euler".into(),
            Self::Own(name, _) => (*name).into(),
            Self::RungeKutta4(_) => "RK4".into(),
            Self::Bdf(_) => "BDF".into(),
        }
    }

    /// Moves `system` from `x`.
    pub fn run(&self, system: &mut dyn System, x: &[f64], times: Times) -> SystemMotion {
        let (mut x, mut motion) = (x.to_vec(), SystemMotion::default());
        let (mut stepper, mut stiff) = (stepper(x.len()), Stiff::new(limits(self)));
        for k in 0..times.count {
            let t = k as f64 * times.every;
            match *self {
                Self::Bdf(_) => {
                    let mut rate = |t: f64, x: &[f64], dx: &mut [f64]| system.rate(t, x, dx);
                    match stiff.advance(t, times.every, &mut x, &mut rate) {
                        Ok(effort) => motion.calls += u64::from(effort.calls),
                        Err(gave_up) => {
                            motion.calls += u64::from(gave_up.effort.calls);
                            motion.gave_up = Some(gave_up);
                            x.fill(f64::NAN);
                        }
                    }
                }
                Self::Euler(h) | Self::RungeKutta4(h) | Self::Own(_, h) => {
                    let n = (times.every / h).round() as usize;
                    for i in 0..n {
                        let t = t + i as f64 * h;
                        let rate = |t: f64, x: &[f64], dx: &mut [f64]| system.rate(t, x, dx);
                        match self {
                            Self::Euler(_) => stepper.euler(t, h, &mut x, rate),
                            Self::RungeKutta4(_) => stepper.runge_kutta_4(t, h, &mut x, rate),
                            _ => system.own_step(t, h, &mut x),
                        }
                    }
                    motion.calls += (n * if matches!(self, Self::RungeKutta4(_)) { 4 } else { 1 }) as u64;
                }
            }
            motion.seen.push(x.clone());
            if x.iter().any(|x| !x.is_finite()) {
                break;
            }
        }
        motion
    }

    /// Moves it as often as the time takes to be measured; a point without scene and error yet.
    pub fn measure(&self, system: &mut dyn System, x: &[f64], times: Times) -> (SystemMotion, Point) {
        let (motion, seconds) = cost::of(|| self.run(system, x, times));
        let duration = times.every * times.count as f64;
        let lost = motion.seen.last().is_none_or(|x| x.iter().any(|x| !x.is_finite()));
        let point = Point {
            method: self.name(),
            step: match *self {
                Self::Euler(h) | Self::RungeKutta4(h) | Self::Own(_, h) => Some(h),
                Self::Bdf(_) => None,
            },
            solver: match *self {
                Self::Bdf(tolerance) => Some(format!("{tolerance:.0e}")),
                _ => None,
            },
            cpu_s_per_s: Some(seconds / duration),
            calls_per_s: Some(motion.calls as f64 / duration),
            error: f64::NAN,
            diverged: lost,
            note: motion.gave_up.map(|g| g.to_string()),
            ..Point::default()
        };
        (motion, point)
    }
}

/// A stepper for states of `n` numbers, of which the methods for any rates are used.
pub fn stepper(n: usize) -> Stepper {
    Stepper::new(Integrator::Euler, n)
}

fn limits(method: &SteppingMethod) -> StiffLimits {
    let tolerance = if let SteppingMethod::Bdf(tolerance) = method { *tolerance } else { 1e-6 };
    StiffLimits { most_calls: MOST_CALLS, ..StiffLimits::of_tolerance(tolerance) }
}

/// Largest difference of two motions over all times, of the states that `of` takes.
pub fn largest(a: &SystemMotion, b: &SystemMotion, of: impl Fn(&[f64], &[f64]) -> f64) -> f64 {
    if a.seen.len() != b.seen.len() {
        return f64::NAN;
    }
    a.seen.iter().zip(&b.seen).map(|(a, b)| of(a, b)).fold(0.0, |e, d| if d.is_nan() { d } else { e.max(d) })
}
