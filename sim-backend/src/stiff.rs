//! Backward differentiation formulas of variable order and step for stiff equations, from the library diffsol; the thesis
//! uses LSODE, of the same family. Not for real time: it allocates, and how long it takes depends on the motion.
//!
//! Dry friction with a jump at rest and other sliding modes make every such method take ever smaller steps. A guard ends
//! that: it counts evaluations, and names the state whose rate jumped to and fro.
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | x, x' | state, its rate f(t, x) | |
//! | J | df/dx, by differences of f; kept from call to call until Newton's method does not converge with it | |

use std::cell::RefCell;
use std::fmt;

use diffsol::{
    BdfState, NalgebraLU, NalgebraMat, OdeBuilder, OdeEquations, OdeSolverMethod, OdeSolverProblem,
};
use diffsol::{OdeEquationsImplicit, OdeSolverState, OdeSolverStopReason, VectorCommon};

type Matrix = NalgebraMat<f64>;
type Lu = NalgebraLU<f64>;

/// f: `rate(t, x, dx)` writes the derivative.
pub type Rate<'a> = dyn FnMut(f64, &[f64], &mut [f64]) + 'a;

/// Accuracy and cost of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StiffLimits {
    /// Error of a step in each state, relative to it and absolute in its unit.
    pub tolerance: f64,
    /// Evaluations of f in one call of [`Stiff::advance`].
    pub most_calls: u32,
    /// \[s\] Steps are not smaller than this.
    pub least_step: f64,
}

impl StiffLimits {
    /// For parts of a motion not longer than some milliseconds.
    pub fn of_tolerance(tolerance: f64) -> Self {
        Self { tolerance, most_calls: 20_000, least_step: 1e-13 }
    }
}

/// Cost of a motion so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effort {
    /// Evaluations of f, those for J included.
    pub calls: u32,
    /// Steps that were accepted.
    pub steps: u32,
    /// \[s\] The smallest of them.
    pub smallest: f64,
}

/// The method went no further.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaveUp {
    /// \[s\] How far it came; the state is that of this time.
    pub time: f64,
    /// Number of the state whose rate jumped to and fro most, or was NaN or infinite.
    pub state: usize,
    /// Why it gave up.
    pub why: GiveUpReason,
    /// Cost until then.
    pub effort: Effort,
}

/// Why an adaptive method gives up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GiveUpReason {
    /// As many evaluations as it was allowed.
    Calls,
    /// Even the smallest step was not accurate enough.
    Step,
    /// A rate is NaN or infinite.
    NotFinite,
}

impl fmt::Display for GaveUp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time, state, effort, why } = self;
        match why {
            GiveUpReason::NotFinite => write!(f, "rate of state {state} is no number at {time} s"),
            GiveUpReason::Calls => {
                write!(f, "{} evaluations, and only at {time} s: state {state} chatters", effort.calls)
            }
            GiveUpReason::Step => {
                write!(f, "no step is small enough at {time} s: state {state} chatters or jumps")
            }
        }?;
        write!(f, "; take integrator = \"semi_implicit\", or a larger tolerance")
    }
}

impl std::error::Error for GaveUp {}

/// The method, with what it keeps from call to call.
#[derive(Clone, Debug)]
pub struct Stiff {
    limits: StiffLimits,
    /// J by columns; empty while there is none.
    jacobian: Vec<f64>,
}

impl Stiff {
    /// For states of any length.
    pub fn new(limits: StiffLimits) -> Self {
        Self { limits, jacobian: Vec::new() }
    }

    /// Advances `x` from `t` \[s\] by `h` \[s\] > 0; `rate(t, x, dx)` writes the derivative, which may have jumps over t
    /// between calls, not within.
    ///
    /// # Errors
    /// [`GaveUp`]; then `x` is the state of its time, and finite if it was at the beginning.
    pub fn advance(&mut self, t: f64, h: f64, x: &mut [f64], rate: &mut Rate<'_>) -> Result<Effort, GaveUp> {
        // The library asks for f and J in turns: both need the one guard, which borrows f.
        let n = x.len();
        let kept = std::mem::take(&mut self.jacobian);
        let watch = RefCell::new(RateGuard::new(n, self.limits.most_calls, rate, kept));
        let start = x.to_vec();
        let StiffLimits { tolerance, least_step, .. } = self.limits;
        let problem = OdeBuilder::<Matrix>::new()
            .t0(t)
            .rtol(tolerance)
            .atol([tolerance])
            .rhs_implicit(
                |x, _, t, dx| watch.borrow_mut().rate(t, x, dx),
                |x, _, t, v, jv| watch.borrow_mut().times_jacobian(t, x, v, jv),
            )
            .init(move |_, _, x| x.copy_from_slice(&start), n)
            .build();
        let (mut time, mut effort) = (t, Effort { smallest: f64::INFINITY, ..Effort::default() });
        let arrived = problem.is_ok_and(|mut problem| {
            // Failed steps end by the guard's count and by their length, hardly by their number.
            problem.ode_options.min_timestep = least_step;
            problem.ode_options.max_error_test_failures = 200;
            problem.ode_options.max_nonlinear_solver_failures = usize::MAX;
            drive(&problem, t + h, x, &mut time, &mut effort)
        });
        let watch = watch.into_inner();
        effort.calls = watch.calls;
        if arrived {
            self.jacobian = watch.jacobian;
            return Ok(effort);
        }
        let (state, why) = watch.verdict();
        Err(GaveUp { time, state, why, effort })
    }
}

/// Steps to `end`; true if it got there. `x` and `time` are those of the last good step.
fn drive<'a, E>(
    problem: &'a OdeSolverProblem<E>,
    end: f64,
    x: &mut [f64],
    time: &mut f64,
    effort: &mut Effort,
) -> bool
where
    E: OdeEquations<T = f64, M = Matrix, V = diffsol::NalgebraVec<f64>, C = diffsol::NalgebraContext>
        + OdeEquationsImplicit
        + 'a,
{
    let begun = BdfState::new_and_consistent::<Lu, E>(problem, 1).and_then(|s| problem.bdf_solver::<Lu>(s));
    let Ok(mut solver) = begun else { return false };
    if solver.set_stop_time(end).is_err() {
        return false;
    }
    loop {
        let Ok(reason) = solver.step() else { return false };
        // A step that is not finite is not taken over, so that `x` stays good.
        let state = solver.state();
        let y = state.y.inner().as_slice();
        if y.iter().any(|y| !y.is_finite()) {
            return false;
        }
        x.copy_from_slice(y);
        effort.steps += 1;
        effort.smallest = effort.smallest.min(state.t - *time);
        *time = state.t;
        if matches!(reason, OdeSolverStopReason::TstopReached) {
            return true;
        }
    }
}

/// The second distance of a difference over the first.
const FURTHER: f64 = 8.0;

/// Derivative by differences over a distance and over one that is eight times as long. Where they do not agree there is a
/// jump or a corner within. A jump must not pass for a slope: Newton's method would take the smallest correction for
/// convergence, and a wrong motion for a right one.
fn slope(near: f64, far: f64) -> f64 {
    let (a, b) = (near.abs(), far.abs());
    match () {
        () if a > 0.5 * FURTHER * b => 0.0,
        () if b > 2.0 * a => near,
        () => far,
    }
}

/// f as the library calls it, with the guard.
struct RateGuard<'a, 'b> {
    inner: &'a mut Rate<'b>,
    calls: u32,
    most_calls: u32,
    not_finite: Option<usize>,
    /// Last rates, their last changes, and the sum of changes that undid the one before.
    last: Vec<f64>,
    change: Vec<f64>,
    to_and_fro: Vec<f64>,
    jacobian: Vec<f64>,
    /// J was used, and is asked for anew because it was no good.
    used: bool,
    near: Vec<f64>,
    moved: Vec<f64>,
}

impl<'a, 'b> RateGuard<'a, 'b> {
    fn new(n: usize, most_calls: u32, inner: &'a mut Rate<'b>, jacobian: Vec<f64>) -> Self {
        let zero = || vec![0.0; n];
        let (calls, not_finite, used) = (0, None, jacobian.len() != n * n);
        let (last, change, to_and_fro, near, moved) = (zero(), zero(), zero(), zero(), zero());
        Self { inner, calls, most_calls, not_finite, last, change, to_and_fro, jacobian, used, near, moved }
    }

    /// f, or NaN once there were too many calls, with which the library ends.
    fn evaluate(&mut self, t: f64, x: &[f64], dx: &mut [f64]) {
        if self.calls >= self.most_calls || self.not_finite.is_some() {
            dx.fill(f64::NAN);
            return;
        }
        self.calls += 1;
        (self.inner)(t, x, dx);
        if x.iter().all(|x| x.is_finite()) {
            self.not_finite = dx.iter().position(|dx| !dx.is_finite());
        }
    }

    fn rate(&mut self, t: f64, x: &[f64], dx: &mut [f64]) {
        self.evaluate(t, x, dx);
        for i in 0..dx.len() {
            let change = dx[i] - self.last[i];
            if change * self.change[i] < 0.0 {
                self.to_and_fro[i] += change.abs().min(self.change[i].abs());
            }
            (self.last[i], self.change[i]) = (dx[i], change);
        }
    }

    /// J v. The library asks for J column by column, v being unit vectors from the first to the last.
    fn times_jacobian(&mut self, t: f64, x: &[f64], v: &[f64], jv: &mut [f64]) {
        let n = x.len();
        if v[0] == 1.0 && v[1..].iter().all(|v| *v == 0.0) {
            if self.used {
                self.differentiate(t, x);
            }
            self.used = true;
        }
        jv.fill(0.0);
        for (j, v) in v.iter().enumerate().filter(|(_, v)| **v != 0.0) {
            for (jv, d) in jv.iter_mut().zip(&self.jacobian[n * j..n * (j + 1)]) {
                *jv += v * d;
            }
        }
    }

    /// J by differences to one side, over two distances; see [`slope`].
    fn differentiate(&mut self, t: f64, x: &[f64]) {
        let n = x.len();
        self.jacobian.resize(n * n, 0.0);
        let (mut near, mut moved) = (std::mem::take(&mut self.near), std::mem::take(&mut self.moved));
        let mut here = vec![0.0; n];
        self.evaluate(t, x, &mut here);
        near.copy_from_slice(x);
        for j in 0..n {
            for far in [false, true] {
                let distance = f64::EPSILON.sqrt() * x[j].abs().max(1.0);
                near[j] = x[j] + if far { FURTHER * distance } else { distance };
                self.evaluate(t, &near, &mut moved);
                for i in 0..n {
                    let found = (moved[i] - here[i]) / (near[j] - x[j]);
                    let kept = &mut self.jacobian[n * j + i];
                    *kept = if far { slope(*kept, found) } else { found };
                }
            }
            near[j] = x[j];
        }
        (self.near, self.moved) = (near, moved);
    }

    fn verdict(&self) -> (usize, GiveUpReason) {
        if let Some(state) = self.not_finite {
            return (state, GiveUpReason::NotFinite);
        }
        let by_size = |a: &usize, b: &usize| self.to_and_fro[*a].total_cmp(&self.to_and_fro[*b]);
        let state = (0..self.to_and_fro.len()).max_by(by_size).unwrap_or(0);
        (state, if self.calls >= self.most_calls { GiveUpReason::Calls } else { GiveUpReason::Step })
    }
}
