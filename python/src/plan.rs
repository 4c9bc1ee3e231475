//! `gangwerk.Plan`: what the planner makes of a command, sampled.

use messages::command::StepCommand;
use messages::{Command, GaitState};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

use crate::arguments::{array, wrong};
use crate::command::{self, refused};
use crate::configuration::{self, SceneChanges};
use crate::matrix::table;
use crate::walk::Walk;

/// \[s\] Latest time at which a plan is sampled; it rests long before.
const LATEST: f64 = 1e6;
/// \[s\] Longest time of standing up, and of waiting for the plan of a command.
const PATIENCE: f64 = 20.0;

/// Trajectories from the start of the plan until the robot stands, in its planning frame.
#[pyclass(frozen, module = "gangwerk")]
pub(crate) struct Plan {
    plan: Box<messages::Plan>,
    /// \[s\] Bus cycle.
    cycle: f64,
}

impl Plan {
    /// A plan of a robot with this bus cycle \[s\].
    pub(crate) fn new(plan: &messages::Plan, cycle: f64) -> Self {
        Self { plan: Box::new(*plan), cycle }
    }
}

#[pymethods]
impl Plan {
    /// Number of the plan.
    #[getter]
    fn id(&self) -> u64 {
        self.plan.id
    }

    /// Time at which it begins [s].
    #[getter]
    fn start(&self) -> f64 {
        self.plan.start_tick as f64 * self.cycle
    }

    /// Its length [s]: from then on the robot rests.
    #[getter]
    fn end(&self) -> f64 {
        self.plan.end()
    }

    /// State of the walk in its first step.
    #[getter]
    fn state(&self) -> String {
        format!("{:?}", GaitState::from(self.plan.state)).to_lowercase()
    }

    /// Planning frame where the robot was first: x, y, z [m] and heading [rad].
    #[getter]
    fn origin(&self) -> [f64; 4] {
        let [x, y, heading] = self.plan.origin;
        [x, y, self.plan.height, heading]
    }

    /// Steps: stance foot; begin of the double support, lift and end of the swing [s]; foothold and landing (x, y [m], heading [rad]).
    #[getter]
    fn steps<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let used = (self.plan.step_count as usize).min(self.plan.steps.len());
        let step = |step: &messages::Step| {
            let found = PyDict::new(py);
            found.set_item("stance", if step.stance == 0 { "right" } else { "left" })?;
            found.set_item("begin", step.begin)?;
            found.set_item("lift", step.lift)?;
            found.set_item("end", step.end)?;
            found.set_item("foothold", step.foothold)?;
            found.set_item("landing", step.landing)?;
            Ok(found)
        };
        self.plan.steps[..used].iter().map(step).collect()
    }

    /// Trajectories at these times since the start [s]: com [m] with com_velocity [m/s] and com_acceleration [m/s^2]; torso
    /// (inclinations, heading [rad]); feet (right, left; x, y, z [m], heading [rad]); pitch [rad]; zmp [m]; load_left [1].
    fn sample<'py>(&self, py: Python<'py>, times: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        let times = array("times", times, &[usize::MAX], [-LATEST, LATEST])?;
        let plan = &self.plan;
        let found = PyDict::new(py);
        let rows = |width: &[usize], row: &dyn Fn(f64, &mut Vec<f64>)| {
            let mut numbers = Vec::with_capacity(times.len() * width.iter().product::<usize>());
            times.iter().for_each(|&t| row(t, &mut numbers));
            let shape = std::iter::once(times.len()).chain(width.iter().copied()).collect();
            table(py, numbers, shape)
        };
        // Body and its derivatives, then everything that is placed, then what is on the ground.
        found.set_item("time", rows(&[], &|t, to| to.push(t))?)?;
        found.set_item("com", rows(&[3], &|t, to| to.extend(plan.body.sample(t).position))?)?;
        found.set_item("com_velocity", rows(&[3], &|t, to| to.extend(plan.body.sample(t).velocity))?)?;
        found.set_item(
            "com_acceleration",
            rows(&[3], &|t, to| to.extend(plan.body.sample(t).acceleration))?,
        )?;
        found.set_item("torso", rows(&[3], &|t, to| to.extend(plan.torso.sample(t).position))?)?;
        let feet = |t: f64, to: &mut Vec<f64>| {
            plan.feet.iter().for_each(|foot| to.extend(foot.sample(t).position));
        };
        found.set_item("feet", rows(&[2, 4], &feet)?)?;
        let pitch = |t: f64, to: &mut Vec<f64>| {
            plan.pitch.iter().for_each(|foot| to.extend(foot.sample(t).position));
        };
        found.set_item("pitch", rows(&[2], &pitch)?)?;
        found.set_item("zmp", rows(&[2], &|t, to| to.extend(plan.zmp.sample(t).0))?)?;
        found.set_item("load_left", rows(&[], &|t, to| to.extend(plan.load_left.sample(t).position))?)?;
        Ok(found)
    }

    fn __repr__(&self) -> String {
        format!(
            "<gangwerk.Plan {}: {}, {} steps, {:.2} s>",
            self.plan.id,
            self.state(),
            self.plan.step_count,
            self.end()
        )
    }
}

/// The first plan that the standing robot of a scene makes for a walking command: `plan("walk_2kmh", "walk/velocity", forward=0.3)`.
#[pyfunction]
#[pyo3(signature = (scene, command, *, config=None, **values))]
fn plan(
    py: Python<'_>,
    scene: &str,
    command: &str,
    config: Option<PathBuf>,
    values: Option<&Bound<'_, PyDict>>,
) -> PyResult<Plan> {
    let asked = command::of(command, values)?;
    if !command.starts_with("walk/")
        || matches!(asked, Command::Stop | Command::Stand | Command::WalkParameter(_))
    {
        return Err(wrong(format!(
            "command = '{command}': nothing is planned for it; take walk/velocity, walk/step, walk/start, walk/distance or walk/platform"
        )));
    }
    let mut setup =
        configuration::setup(py, scene, &SceneChanges::default(), &configuration::directory(config)?)?;
    // A robot that has nothing to do but to stand up.
    setup.scene.commands = vec![(0.1, Command::Stand)];
    setup.scene.pushes.clear();
    let standing = py.detach(|| standing(setup)).map_err(wrong)?;
    let mut walk = standing;
    let before = walk.chain.plan().id;
    let mut all = vec![asked];
    if let Command::Step(StepCommand { .. }) = asked {
        all.push(Command::Start);
    }
    for command in &all {
        walk.command(command).map_err(|(code, text)| refused(py, command, code, &text))?;
    }
    let made = py.detach(|| until(&mut walk, |walk| walk.chain.plan().id > before));
    if !made {
        let told: Vec<String> = walk.told.iter().map(|told| format!("{:?}", told.code)).collect();
        return Err(wrong(format!("{command}: no plan was made; events: {}", told.join(", "))));
    }
    Ok(Plan::new(walk.chain.plan(), walk.chain.cycle()))
}

/// The walk of a scene as soon as the robot stands.
fn standing(setup: config::Setup) -> Result<Walk, String> {
    let mut walk = Walk::new(setup).map_err(|error| error.to_string())?;
    let stands = |walk: &Walk| {
        let plan = walk.chain.plan();
        let end = plan.start_tick as f64 * walk.chain.cycle() + plan.end();
        plan.id > 0 && walk.time() > end + 0.1
    };
    if until(&mut walk, stands) {
        Ok(walk)
    } else {
        Err("the robot of this scene does not come to a stand".into())
    }
}

/// Runs until this is so; false if it is not in time.
fn until(walk: &mut Walk, done: impl Fn(&Walk) -> bool) -> bool {
    let end = walk.time() + PATIENCE;
    while walk.time() < end && !walk.is_over() {
        walk.step();
        if done(walk) {
            return true;
        }
    }
    false
}

/// Classes and functions of this file, added to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Plan>()?;
    module.add_function(wrap_pyfunction!(plan, module)?)
}
