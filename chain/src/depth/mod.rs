//! `depth = "auto"`: the cheapest model and step that are as accurate as a scene asks.
//!
//! Methods are tried in the order of what they cost, on the begin of the scene with everything in the loop ([`trial`]); those
//! whose step the scene would be refused with are left out.
//! What a method is off by is estimated from differences to the next finer ones, for every output that the scene names:
//!
//! ```text
//! error = 2 |this step - half of it| + |this - next deeper type| + |that - next deeper type| + ...
//! ```
//!
//! | term | why |
//! |---|---|
//! | step | a method of first order at step h is off by twice its difference to h/2, as extrapolation has it |
//! | model | 1 lacks drives (2); 2 lacks elastic gears (3); 3 and 4 lack what the other has (5) |
//!
//! The deepest type the robot has data for is the truth, as nothing here knows better. All legs on the way to it count: the
//! difference to the next type alone is no bound, since pads change the feet of a type 1 model more than motors do. Their
//! sum is one (all outputs are norms of differences), up to the steps of the deepest type. A leg is not simulated once the
//! ones before it are too long, so that a strict scene costs no trials of deep types for shallow ones.
//! `chain/tests/depth.rs` holds estimates against that truth.
//!
//! A scene is tried from its begin until [`WALKING`] seconds after the last thing that it makes happen: command, push, fault
//! of the bus; one with objects, which a robot meets at any time, to its end. `tolerance.trial` says otherwise, and then the
//! reason names what was not seen. The order of methods is a table, and no clock decides: every run chooses alike.

pub mod trial;

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write;

use config::method::Integrator::{self, Euler, SemiImplicit};
use config::method::Method;
use config::tolerance::Output;
use config::{Robot, Scene, Setup};
use serde::Serialize;
use sim_backend::step_limit;

use self::trial::MethodTrial;

/// \[s\] Trial after the last thing that a scene makes happen.
pub const WALKING: f64 = 3.0;
/// By how much the difference to half the step underestimates the error of a method of first order: 1 / (1 - 1/2).
const FIRST_ORDER: f64 = 2.0;
/// Integrator of each type, and how many steps per cycle are tried.
const STEPS: [(u8, Integrator, &[u32]); 5] = [
    (1, Euler, &[1, 2, 4, 8]),
    (2, SemiImplicit, &[1, 2, 4, 10]),
    (3, SemiImplicit, &[1, 2, 4, 10]),
    (4, SemiImplicit, &[2, 4, 10]),
    (5, SemiImplicit, &[2, 4, 10]),
];
/// Processor time of a step of each type, type 1 = 1, as measured once for Lola walking; only the order is taken from it.
const COST: [f64; 5] = [1.0, 1.9, 2.0, 11.5, 12.0];
/// Steps per cycle of the deeper types that a method is held against.
const DEEPER_STEPS: u32 = 10;

/// What was chosen, and why.
#[derive(Clone, Debug, Serialize)]
pub struct Choice {
    /// The method.
    #[serde(serialize_with = "as_text")]
    pub method: Method,
    /// \[s\] How much of the scene was tried.
    pub trial_s: f64,
    /// \[s\] The last thing that the scene makes happen, if that was not tried.
    pub not_seen_s: Option<f64>,
    /// Methods in the order in which they were tried, the chosen one last.
    pub tried: Vec<Tried>,
    /// Trials that were simulated, of these methods and of finer ones.
    pub trials: usize,
    /// \[s\] Processor time of all of them.
    pub cpu_s: f64,
}

/// A method that was tried.
#[derive(Clone, Debug, Serialize)]
pub struct Tried {
    /// The method.
    #[serde(serialize_with = "as_text")]
    pub method: Method,
    /// What it is off by, for every output of the scene's tolerance.
    pub estimates: Vec<Estimate>,
}

/// An error, estimated.
#[derive(Clone, Debug, Serialize)]
pub struct Estimate {
    /// Name of the output.
    pub output: &'static str,
    /// Unit of the numbers.
    pub unit: &'static str,
    /// Share of the step.
    pub step: f64,
    /// Share of the model.
    pub model: f64,
    /// Whether that is all of it; else what was found was too much already.
    pub complete: bool,
    /// What is allowed.
    pub tolerance: f64,
}

fn as_text<S: serde::Serializer>(method: &Method, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(method)
}

impl Estimate {
    /// The whole error, in its unit; at least this, if not complete.
    pub fn error(&self) -> f64 {
        self.step + self.model
    }

    /// The whole error as a multiple of what is allowed.
    fn excess(&self) -> f64 {
        self.error() / self.tolerance
    }
}

impl Tried {
    /// Largest error as a multiple of what is allowed.
    pub fn excess(&self) -> f64 {
        self.estimates.iter().map(Estimate::excess).fold(0.0, f64::max)
    }

    fn sufficient(&self) -> bool {
        self.excess() <= 1.0
    }

    /// Whether no step makes this type sufficient: smaller ones change it by less than its model is off.
    fn hopeless(&self) -> bool {
        self.estimates.iter().any(|e| e.model - e.step > e.tolerance)
    }

    /// The errors as text.
    fn errors(&self) -> String {
        let one = |e: &Estimate| {
            let at_least = if e.complete { "" } else { "at least " };
            format!("{} {at_least}{:.2e} of {:.2e} {}", e.output, e.error(), e.tolerance, e.unit)
        };
        self.estimates.iter().map(one).collect::<Vec<_>>().join(", ")
    }
}

impl Choice {
    /// Why it is this method, in one line.
    pub fn reason(&self) -> String {
        let Some((chosen, before)) = self.tried.split_last() else { return self.method.to_string() };
        let (method, errors) = (self.method, chosen.errors());
        let mut text = format!("{method} (estimated error: {errors}); ");
        if before.is_empty() {
            text += "the cheapest method that was tried";
        } else {
            let names: Vec<String> =
                before.iter().map(|t| format!("{} {:.1}", t.method, t.excess())).collect();
            let _ = write!(text, "cheaper ones, times the tolerance: {}", names.join("; "));
        }
        let (trials, cpu) = (self.trials, self.cpu_s);
        let _ = write!(text, "; {trials} trials of {:.1} s took {cpu:.1} s", self.trial_s);
        if let Some(time) = self.not_seen_s {
            let _ =
                write!(text, "; what happens until {time:.1} s was not tried: tolerance.trial ends before");
        }
        text
    }
}

/// Chooses the method for a scene whose depth is "auto"; `trying` is told each method before it is simulated.
///
/// # Errors
/// The scene leaves nothing open, its robot cannot be simulated, or no method is accurate enough: then how near they came.
pub fn choose(setup: &Setup, trying: impl FnMut(&str)) -> Result<Choice, Box<dyn Error>> {
    let tolerance = setup.scene.auto.as_ref().ok_or("this scene says its depth itself")?;
    let types = Types::of(&setup.robot);
    if tolerance.needs_motors() && !types.has(2) {
        let robot = &setup.robot.name;
        return Err(format!(
            "scene {}: tolerance: motor_current needs motors, and robot `{robot}` has no [[drive]]",
            setup.scene.name
        )
        .into());
    }
    let mut trials = Trials::new(setup, trying);
    let mut tried: Vec<Tried> = Vec::new();
    for method in by_cost() {
        let useless = tolerance.needs_motors() && method.depth == 1;
        let hopeless = tried.iter().any(|t| t.method.depth == method.depth && t.hopeless());
        if useless || hopeless || !types.has(method.depth) || is_too_long(setup, method)? {
            continue;
        }
        let found = Tried { method, estimates: estimate(&mut trials, &types, method, &tolerance.outputs)? };
        let sufficient = found.sufficient();
        tried.push(found);
        if sufficient {
            return Ok(trials.choice(method, tried));
        }
    }
    Err(too_strict(setup, &tried, trials.seconds()).into())
}

/// True if the scene would be refused with the step of a method.
fn is_too_long(setup: &Setup, method: Method) -> Result<bool, Box<dyn Error>> {
    let mut scene = setup.scene.clone();
    scene.choose(method);
    Ok(step_limit::exceeded(&setup.robot, &scene)?.is_some())
}

/// What one method is estimated to be off by on a scene whose depth is "auto".
///
/// # Errors
/// The scene leaves nothing open, or its robot cannot be simulated with the method.
pub fn judge(setup: &Setup, method: Method) -> Result<Tried, Box<dyn Error>> {
    let tolerance = setup.scene.auto.as_ref().ok_or("this scene says its depth itself")?;
    let mut trials = Trials::new(setup, |_| ());
    let estimates = estimate(&mut trials, &Types::of(&setup.robot), method, &tolerance.outputs)?;
    Ok(Tried { method, estimates })
}

/// What a method is off by; deeper types are simulated as long as it may still suffice.
///
/// # Errors
/// The robot cannot be simulated.
fn estimate(
    trials: &mut Trials<'_, impl FnMut(&str)>,
    types: &Types,
    method: Method,
    outputs: &[(Output, f64)],
) -> Result<Vec<Estimate>, Box<dyn Error>> {
    let half = Method { substeps: 2 * method.substeps, ..method };
    let mut estimates = Vec::with_capacity(outputs.len());
    for &(output, tolerance) in outputs {
        let step = FIRST_ORDER * trials.distance(method, half, output)?;
        let (output, unit) = (output.word(), output.unit());
        estimates.push(Estimate { output, unit, step, model: 0.0, complete: false, tolerance });
    }
    let mut from = method;
    while let Some(depth) = types.deeper(from.depth) {
        if estimates.iter().any(|e| e.excess() > 1.0) {
            return Ok(estimates);
        }
        let to = Method { depth, integrator: SemiImplicit, substeps: DEEPER_STEPS };
        for (estimate, &(output, _)) in estimates.iter_mut().zip(outputs) {
            estimate.model += trials.distance(from, to, output)?;
        }
        from = to;
    }
    estimates.iter_mut().for_each(|e| e.complete = true);
    Ok(estimates)
}

/// All methods, the cheapest first.
fn by_cost() -> Vec<Method> {
    let cost = |m: &Method| COST[usize::from(m.depth) - 1] * f64::from(m.substeps);
    let of_type = |&(depth, integrator, steps): &(u8, Integrator, &'static [u32])| {
        steps.iter().map(move |&substeps| Method { depth, integrator, substeps })
    };
    let mut all: Vec<Method> = STEPS.iter().flat_map(of_type).collect();
    all.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
    all
}

fn too_strict(setup: &Setup, tried: &[Tried], seconds: f64) -> String {
    let scene = &setup.scene.name;
    let nearest = tried.iter().min_by(|a, b| a.excess().total_cmp(&b.excess()));
    let nearest = nearest.map_or(String::new(), |t| format!("{}: {}", t.method, t.errors()));
    format!(
        "scene {scene}: tolerance: none of {} methods is accurate enough over {seconds:.1} s; the nearest was {nearest}; \
         allow more, or say depth, integrator and substeps",
        tried.len()
    )
}

/// Types that a robot has the data for.
struct Types([bool; 5]);

impl Types {
    fn of(robot: &Robot) -> Self {
        let motors = !robot.drives.is_empty();
        let elastic = robot.drives.iter().any(|drive| drive.elasticity.is_some());
        let pads = motors && robot.contact.pads.is_some();
        Self([true, motors, elastic, pads, elastic && pads])
    }

    fn has(&self, depth: u8) -> bool {
        self.0[usize::from(depth) - 1]
    }

    /// The next deeper one.
    fn deeper(&self, depth: u8) -> Option<u8> {
        let next: &[u8] = match depth {
            1 => &[2],
            2 => &[3, 4],
            3 | 4 => &[5],
            _ => &[],
        };
        next.iter().copied().find(|&d| self.has(d))
    }
}

/// Trials that were simulated, each once.
struct Trials<'s, F> {
    setup: &'s Setup,
    cycles: usize,
    trying: F,
    done: BTreeMap<String, MethodTrial>,
}

impl<'s, F: FnMut(&str)> Trials<'s, F> {
    fn new(setup: &'s Setup, trying: F) -> Self {
        let cycles = (length(&setup.scene) / setup.scene.cycle).round() as usize;
        Self { setup, cycles, trying, done: BTreeMap::new() }
    }

    fn seconds(&self) -> f64 {
        self.cycles as f64 * self.setup.scene.cycle
    }

    fn simulate(&mut self, method: Method) -> Result<(), Box<dyn Error>> {
        let name = method.to_string();
        if !self.done.contains_key(&name) {
            (self.trying)(&name);
            self.done.insert(name, MethodTrial::run(self.setup, method, self.cycles)?);
        }
        Ok(())
    }

    fn distance(&mut self, a: Method, b: Method, output: Output) -> Result<f64, Box<dyn Error>> {
        self.simulate(a)?;
        self.simulate(b)?;
        Ok(self.done[&a.to_string()].distance(&self.done[&b.to_string()], output))
    }

    fn choice(self, method: Method, tried: Vec<Tried>) -> Choice {
        let (trials, trial_s) = (self.done.len(), self.seconds());
        let not_seen_s = Some(last_happening(&self.setup.scene)).filter(|last| *last > trial_s);
        Choice {
            method,
            trial_s,
            not_seen_s,
            tried,
            trials,
            cpu_s: self.done.values().map(|t| t.cpu_s).sum(),
        }
    }
}

/// \[s\] How much of a scene is tried.
fn length(scene: &Scene) -> f64 {
    let asked = scene.auto.as_ref().and_then(|tolerance| tolerance.trial);
    asked.unwrap_or(last_happening(scene) + WALKING).min(scene.duration)
}

/// \[s\] The last thing that a scene makes happen; its end if it has objects.
fn last_happening(scene: &Scene) -> f64 {
    if !scene.objects.is_empty() {
        return scene.duration;
    }
    let commands = scene.commands.iter().map(|(time, _)| *time);
    let pushes = scene.pushes.iter().map(|(time, push)| time + push.duration);
    let faults = scene.bus_faults.iter().map(|fault| fault.time + fault.duration);
    commands.chain(pushes).chain(faults).fold(0.0, f64::max).min(scene.duration)
}
