//! Backward differentiation formulas of variable order and step for stiff equations, from the library diffsol; the thesis
//! uses LSODE, of the same family. Not for real time: it allocates, and how long it takes depends on the motion.
//!
//! Dry friction with a jump at rest and other sliding modes make every such method take ever smaller steps. A guard ends
//! that: it counts evaluations, and names the state whose rate jumped to and fro.
//!
//! A robot's accelerations answer to nearly every state, so no two columns of J can share an evaluation; its zeros save work
//! where equations are solved (`sparse_lu.rs`).
//!
//! | symbol | name | unit |
//! |---|---|---|
//! | x, x' | state, its rate f(t, x) | |
//! | J | df/dx, by differences of f; kept from call to call until Newton's method does not converge with it | |

use std::cell::RefCell;
use std::fmt;

use diffsol::{Bdf, BdfState, NalgebraContext, NalgebraMat, NalgebraVec, OdeBuilder};
use diffsol::{OdeEquationsImplicit, OdeSolverMethod, OdeSolverState, OdeSolverStopReason, VectorCommon};

use config::Scene;
use config::components::ContactModel;
use config::method::Integrator;

use crate::sparse_lu::{Factors, SparseLu};

type Matrix = NalgebraMat<f64>;
type Vector = NalgebraVec<f64>;
type Solver<'a, E> = Bdf<'a, E, SparseLu>;

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

/// The method, with what it keeps from call to call: order, step and history, J, and the factors of its equations.
#[derive(Clone)]
pub struct Stiff {
    limits: StiffLimits,
    /// J by columns; empty while there is none.
    jacobian: Vec<f64>,
    factors: Factors,
    /// End of the last call, with its history; none if the method has to begin anew.
    kept: Option<CallEnd>,
}

/// End of a call.
#[derive(Clone)]
struct CallEnd {
    state: BdfState<Vector>,
    /// f there, as that call had it.
    rate: Vec<f64>,
}

impl CallEnd {
    /// True if a motion goes on from here: at `x`, with the rate `dx`.
    fn goes_on(&self, x: &[f64], dx: &[f64], tolerance: f64) -> bool {
        let state = self.state.as_ref();
        let y = state.y.inner().as_slice();
        y.len() == x.len()
            && (0..x.len()).all(|i| {
                let allowed = tolerance * (1.0 + x[i].abs());
                (x[i] - y[i]).abs() <= allowed && (dx[i] - self.rate[i]).abs() * state.h <= allowed
            })
    }
}

/// Refuses a scene with pads, for which the method is of no use: they bring nearly a thousand states, and a second of standing
/// on them takes some hundred times as long as with semi-implicit steps.
///
/// # Errors
/// It has some.
pub(crate) fn check(scene: &Scene) -> Result<(), String> {
    let pads = scene.components().contact.contains(&ContactModel::Pads);
    if scene.integrator != Integrator::Bdf || !pads {
        return Ok(());
    }
    Err(format!(
        "scene `{}`: integrator = \"bdf\" with depth = {}: pads bring nearly a thousand states, and a second of standing \
         takes more than a minute; take integrator = \"semi_implicit\", or depth = 3 or less and no pads",
        scene.name, scene.depth
    ))
}

impl Stiff {
    /// For states of any length.
    pub fn new(limits: StiffLimits) -> Self {
        Self { limits, jacobian: Vec::new(), factors: Factors::default(), kept: None }
    }

    /// Advances `x` from `t` \[s\] by `h` \[s\] > 0; `rate(t, x, dx)` writes the derivative, which may have jumps over t
    /// between calls, not within.
    ///
    /// Where `x` is what the last call left, and its rate too, the method goes on with its order and step; the rate may have
    /// a kink there. Changes of `x` below the tolerance, as by a quaternion made of unit length, do not count, and are
    /// lost.
    ///
    /// # Errors
    /// [`GaveUp`]; then `x` is the state of its time, and finite if it was at the beginning.
    pub fn advance(&mut self, t: f64, h: f64, x: &mut [f64], rate: &mut Rate<'_>) -> Result<Effort, GaveUp> {
        // The library asks for f and J in turns: both need the one guard, which borrows f.
        let n = x.len();
        let jacobian = std::mem::take(&mut self.jacobian);
        let watch = RefCell::new(RateGuard::new(n, self.limits.most_calls, rate, jacobian));
        let lu = SparseLu::new(std::mem::take(&mut self.factors));
        let start = x.to_vec();
        let StiffLimits { tolerance, least_step, .. } = self.limits;
        // The library's clock runs on from call to call, which its history goes by.
        let mut dx = vec![0.0; n];
        let kept = self.kept.take().filter(|kept| {
            watch.borrow_mut().evaluate(t, x, &mut dx);
            kept.goes_on(x, &dx, tolerance)
        });
        let begun = kept.as_ref().map_or(t, |kept| kept.state.as_ref().t);
        let shift = t - begun;
        let problem = OdeBuilder::<Matrix>::new()
            .t0(begun)
            .rtol(tolerance)
            .atol([tolerance])
            .rhs_implicit(
                |x, _, t, dx| watch.borrow_mut().rate(t + shift, x, dx),
                |x, _, t, v, jv| watch.borrow_mut().times_jacobian(t + shift, x, v, jv),
            )
            .init(move |_, _, x| x.copy_from_slice(&start), n)
            .build();
        let (mut time, mut effort) = (begun, Effort { smallest: f64::INFINITY, ..Effort::default() });
        let end = problem.ok().and_then(|mut problem| {
            // Failed steps end by the guard's count and by their length, hardly by their number.
            problem.ode_options.min_timestep = least_step;
            problem.ode_options.max_error_test_failures = 200;
            problem.ode_options.max_nonlinear_solver_failures = usize::MAX;
            let anew = || BdfState::new_and_consistent::<SparseLu, _>(&problem, 1);
            let state = kept.map_or_else(anew, |kept| Ok(kept.state)).ok()?;
            drive(Solver::new(&problem, state, lu.clone()).ok()?, begun + h, x, &mut time, &mut effort)
        });
        let mut watch = watch.into_inner();
        self.factors = lu.into_factors();
        if let Some(state) = end {
            watch.evaluate(t + h, x, &mut dx);
            effort.calls = watch.calls;
            (self.jacobian, self.kept) = (watch.jacobian, Some(CallEnd { state, rate: dx }));
            return Ok(effort);
        }
        effort.calls = watch.calls;
        let (state, why) = watch.verdict();
        Err(GaveUp { time: time + shift, state, why, effort })
    }
}

/// Steps to `end`; the library's state if it got there. `x` and `time` are those of the last good step.
fn drive<'a, E>(
    mut solver: Solver<'a, E>,
    end: f64,
    x: &mut [f64],
    time: &mut f64,
    effort: &mut Effort,
) -> Option<BdfState<Vector>>
where
    E: OdeEquationsImplicit<T = f64, M = Matrix, V = Vector, C = NalgebraContext> + 'a,
{
    loop {
        // What is left is shared by two steps if it is less than two: a short last one would be the next call's first.
        let (left, h) = (end - *time, solver.state().h);
        let stop = if left > 1.01 * h && left < 2.0 * h { *time + 0.5 * left } else { end };
        solver.set_stop_time(stop).ok()?;
        let reason = solver.step().ok()?;
        // A step that is not finite is not taken over, so that `x` stays good.
        let state = solver.state();
        let y = state.y.inner().as_slice();
        if y.iter().any(|y| !y.is_finite()) {
            return None;
        }
        x.copy_from_slice(y);
        effort.steps += 1;
        effort.smallest = effort.smallest.min(state.t - *time);
        *time = state.t;
        if stop == end && matches!(reason, OdeSolverStopReason::TstopReached) {
            return Some(solver.into_state());
        }
    }
}

/// The second distance of a difference over the first.
const FURTHER: f64 = 8.0;

/// \[1\] Share by which an entry of J may differ from the one before and count as the same.
const ALIKE: f64 = 0.3;
/// \[1/s\] Differences of entries that are rounding errors.
const ROUNDING: f64 = 1.0;

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
        let had_one = self.jacobian.len() == n * n;
        self.jacobian.resize(n * n, 0.0);
        let (mut near, mut moved) = (std::mem::take(&mut self.near), std::mem::take(&mut self.moved));
        let mut here = vec![0.0; n];
        self.evaluate(t, x, &mut here);
        near.copy_from_slice(x);
        for j in 0..n {
            let mut seems_same = had_one;
            for far in [false, true] {
                // A column that is much what it was has no jump within.
                if far && seems_same {
                    break;
                }
                let distance = f64::EPSILON.sqrt() * x[j].abs().max(1.0);
                near[j] = x[j] + if far { FURTHER * distance } else { distance };
                self.evaluate(t, &near, &mut moved);
                for i in 0..n {
                    let found = (moved[i] - here[i]) / (near[j] - x[j]);
                    let kept = &mut self.jacobian[n * j + i];
                    seems_same &= (found - *kept).abs() <= ALIKE * (found.abs() + kept.abs()) + ROUNDING;
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
