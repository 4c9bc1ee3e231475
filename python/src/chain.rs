//! `gangwerk.Chain`: a whole robot in one process, step by step.

use std::path::PathBuf;

use messages::command::PushCommand;
use messages::command_text::CommandInfo;
use messages::{Command, GaitState, Words};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arguments::{real, vector, whole, wrong};
use crate::command::{self, refused};
use crate::configuration::{self, SceneChanges};
use crate::observed::{LATEST, MOST_CYCLES, ObservedWalk};
use crate::parameters;
use crate::plan::Plan;
use crate::walk::{Told, Walk};

/// Something a process told.
#[pyclass(frozen, get_all, module = "gangwerk")]
struct Event {
    time: f64,
    tick: u64,
    process: &'static str,
    name: String,
    text: String,
}

#[pymethods]
impl Event {
    fn __repr__(&self) -> String {
        format!("{:.3} s {}: {}", self.time, self.process, self.text)
    }
}

/// State of a walk, for `Chain.restore`. It lives in the memory of this interpreter and cannot be pickled.
#[pyclass(frozen, module = "gangwerk")]
struct State(Walk);

#[pymethods]
impl State {
    fn __repr__(&self) -> String {
        format!("<gangwerk.State of {} at {:.3} s>", self.0.setup.scene.name, self.0.time())
    }
}

/// A whole robot in one process, what `gangwerk sim` runs: planner, stabilizer, joint loop, watchdog and simulated robot.
///
/// `scene`: a name (`scenes()`) or the path of a scene file. `depth` (1 to 5), `integrator` ("euler", "rk4", "semi_implicit",
/// "bdf"), `substeps` per bus cycle and `seed` stand in for those of the scene. `config`: configuration directory; without it
/// the one that `gangwerk config where` names, or the set inside the package. Equal chains give the same bytes.
/// A chain is for one thread at a time; others run while it steps.
#[pyclass(module = "gangwerk")]
struct Chain {
    observed: ObservedWalk,
    /// The scene is not what its files say.
    changed: bool,
}

impl Chain {
    fn of(walk: Walk, changed: bool) -> Self {
        Self { observed: ObservedWalk::new(walk), changed }
    }

    fn setup(&self) -> &config::Setup {
        &self.observed.walk.setup
    }

    fn answered(&mut self, py: Python<'_>, command: &Command) -> PyResult<&'static str> {
        let answer = self.observed.walk.command(command);
        answer.map_err(|(code, text)| refused(py, command, code, &text))
    }
}

#[pymethods]
impl Chain {
    #[new]
    #[pyo3(signature = (scene, *, depth=None, seed=None, integrator=None, substeps=None, config=None))]
    fn new(
        py: Python<'_>,
        scene: &str,
        depth: Option<&Bound<'_, PyAny>>,
        seed: Option<&Bound<'_, PyAny>>,
        integrator: Option<&str>,
        substeps: Option<&Bound<'_, PyAny>>,
        config: Option<PathBuf>,
    ) -> PyResult<Self> {
        let changes = SceneChanges { depth, seed, integrator, substeps };
        let setup = configuration::setup(py, scene, &changes, &configuration::directory(config)?)?;
        let changed = !changes.are_none();
        let walk = py.detach(|| Walk::new(setup).map_err(|error| error.to_string()));
        Ok(Self::of(walk.map_err(wrong)?, changed))
    }

    fn __repr__(&self) -> String {
        let scene = &self.setup().scene;
        format!("<gangwerk.Chain {}, {}, at {:.3} s>", scene.name, scene.method(), self.observed.walk.time())
    }

    // Time.

    /// Runs n bus cycles.
    #[pyo3(signature = (n=None))]
    fn step(&mut self, py: Python<'_>, n: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let cycles = n.map_or(Ok(1), |n| whole("n", n, [0, MOST_CYCLES]))?;
        self.observed.advance(py, cycles, |_| true)
    }

    /// Runs until this time [s], or the end of the scene; ends 2 s after a fall, as `gangwerk sim` does. Gives `figures()`.
    #[pyo3(signature = (until=None))]
    fn run<'py>(
        &mut self,
        py: Python<'py>,
        until: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let cycles = self.observed.cycles_until(until)?;
        self.observed.advance(py, cycles, |walk| !walk.is_over())?;
        self.figures(py)
    }

    /// Runs as `run`, and gives these fields of every cycle, or of every n-th one, by name, with `time` [s].
    #[pyo3(signature = (fields, until=None, *, every=None))]
    fn trace<'py>(
        &mut self,
        py: Python<'py>,
        fields: Vec<String>,
        until: Option<&Bound<'py, PyAny>>,
        every: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let every = every.map_or(Ok(1), |n| whole("every", n, [1, MOST_CYCLES]))?;
        self.observed.trace(py, &fields, until, every)
    }

    /// Simulated time [s]: cycles so far.
    #[getter]
    fn time(&self) -> f64 {
        self.observed.walk.time()
    }

    /// Bus cycles so far.
    #[getter]
    fn tick(&self) -> u64 {
        self.observed.walk.chain.tick()
    }

    /// Bus cycle [s].
    #[getter]
    fn cycle(&self) -> f64 {
        self.observed.walk.chain.cycle()
    }

    /// Length of the scene [s]; a chain can be stepped beyond it.
    #[getter]
    fn duration(&self) -> f64 {
        self.observed.walk.setup.scene.duration
    }

    /// Name of the scene.
    #[getter]
    fn scene(&self) -> &str {
        &self.setup().scene.name
    }

    /// Name of the robot.
    #[getter]
    fn robot(&self) -> &str {
        &self.setup().robot.name
    }

    /// Depth, integrator and steps per cycle.
    #[getter]
    fn method(&self) -> String {
        self.observed.walk.setup.scene.method().to_string()
    }

    /// Names of the joints, in the order of every array of joints.
    #[getter]
    fn joint_names(&self) -> Vec<&str> {
        self.observed.walk.setup.robot.joints.iter().map(|joint| joint.name.as_str()).collect()
    }

    // What is known of the robot.

    /// Present value of a field, `TOPIC.FIELD` as in `fields()`: a copy, or a number.
    fn get<'py>(&self, py: Python<'py>, field: &str) -> PyResult<Bound<'py, PyAny>> {
        self.observed.named(py, field)
    }

    /// Name, unit and shape of every field of `sim_state`, `sensors`, `controller_state`, `joint_targets` and `power`.
    fn fields(&self) -> Vec<(String, String, Vec<usize>)> {
        self.observed.fields.all()
    }

    /// Array of a field that every later `step`, `run` and `restore` of this chain writes anew; read only, always the same array.
    fn view<'py>(&mut self, py: Python<'py>, field: &str) -> PyResult<Bound<'py, PyAny>> {
        self.observed.view(py, field)
    }

    /// True joint angles [rad]; a copy, as all that follow.
    #[getter]
    fn joint_angle<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.observed.named(py, "sim_state.joint_angle")
    }

    /// Measured joint speeds [rad/s].
    #[getter]
    fn joint_speed<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.observed.named(py, "sensors.joint_speed")
    }

    /// Joint targets [rad].
    #[getter]
    fn joint_target<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.observed.named(py, "joint_targets.angle")
    }

    /// True origin of the torso frame in the world [m].
    #[getter]
    fn torso_position<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.observed.named(py, "sim_state.position")
    }

    /// True quaternion (x, y, z, w), world from torso.
    #[getter]
    fn torso_orientation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.observed.named(py, "sim_state.orientation")
    }

    /// True centre of gravity in the world [m].
    #[getter]
    fn com<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.observed.named(py, "sim_state.com")
    }

    /// Capture point [m], the divergent component of the measured motion, in the planning frame of the active plan; NaN where there is none.
    #[getter]
    fn capture_point<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.observed.named(py, "controller_state.dcm")
    }

    /// Zero-moment point of the measured wrenches [m] in the same frame; NaN while no foot carries.
    #[getter]
    fn zmp<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.observed.named(py, "controller_state.zmp")
    }

    /// True force of the ground on each foot in the world [N]; right, left.
    #[getter]
    fn foot_force<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.observed.named(py, "sim_state.foot_wrench.force")
    }

    /// Its moment about the foot's sole frame [N m]; right, left.
    #[getter]
    fn foot_moment<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.observed.named(py, "sim_state.foot_wrench.moment")
    }

    /// True sole frames in the world: x, y, z [m] and heading [rad]; right, left.
    #[getter]
    fn feet<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.observed.named(py, "sim_state.feet")
    }

    /// True once the robot has fallen.
    #[getter]
    fn fallen(&self) -> bool {
        self.observed.walk.fell().is_some()
    }

    /// Motor supply: true while it is on.
    #[getter]
    fn powered(&self) -> bool {
        self.observed.walk.chain.last().sim_state.power == 1
    }

    /// State of the walk: idle, standing, starting, walking, stopping, fallen or halted.
    #[getter]
    fn gait(&self) -> String {
        let cycle = self.observed.walk.chain.last();
        let gait = if self.fallen() { GaitState::Fallen } else { cycle.controller_state.gait.into() };
        format!("{gait:?}").to_lowercase()
    }

    /// The newest plan, if there is one.
    #[getter]
    fn plan(&self) -> Option<Plan> {
        let plan = self.observed.walk.chain.plan();
        (plan.id > 0).then(|| Plan::new(plan, self.observed.walk.chain.cycle()))
    }

    /// Events of all processes since the last call.
    fn events(&mut self) -> Vec<Event> {
        let cycle = self.observed.walk.chain.cycle();
        let words = Words {
            joints: self.observed.walk.setup.robot.joints.iter().map(|joint| joint.name.clone()).collect(),
            nodes: self.observed.walk.setup.robot.layout.nodes.clone(),
            ..Words::default()
        };
        let told = std::mem::take(&mut self.observed.walk.told);
        let event = |told: Told| Event {
            time: told.tick as f64 * cycle,
            tick: told.tick,
            process: told.process.name(),
            name: format!("{:?}", told.code),
            text: words.sentence(told.code as u64, told.detail.pack()),
        };
        told.into_iter().map(event).collect()
    }

    /// Figures of the walk so far, as `gangwerk sim --json` prints them, without those of processor time.
    fn figures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mut figures = serde_json::to_value(self.observed.walk.figures()).map_err(wrong)?;
        if let Some(map) = figures.as_object_mut() {
            // Those of the clock and of the command.
            ["cpu_s", "real_time_factor", "log", "depth_reason"].iter().for_each(|key| _ = map.remove(*key));
        }
        py.import("json")?.call_method1("loads", (figures.to_string(),))
    }

    // What is done to it.

    /// Gives a command, which is taken in the next cycle; the name of the process that takes it. Raises Refused with the reason and the limit. Fields with a dot: `**{"force.y": 40}`.
    #[pyo3(signature = (name, **values))]
    fn command(
        &mut self,
        py: Python<'_>,
        name: &str,
        values: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<&'static str> {
        let command = command::of(name, values)?;
        if let Command::Push(push) = command {
            return self.observed.walk.push(push, None).map(|()| command.decided_by()).map_err(wrong);
        }
        self.answered(py, &command)
    }

    /// Pushes the torso at its centre of gravity with this force in the world [N] for a duration [s], from the next cycle on or from the time `at` [s]; one push at a time.
    #[pyo3(signature = (force, duration, at=None))]
    fn push(
        &mut self,
        force: &Bound<'_, PyAny>,
        duration: &Bound<'_, PyAny>,
        at: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let fields = CommandInfo::find("sim/push").map_or(&[][..], |info| info.fields);
        let (of_force, of_duration) = (fields[0], fields[3]);
        let force = vector("force", force, of_force.range)?;
        let duration = real("duration", duration, of_duration.range, of_duration.unit)?;
        let at = at.map(|at| real("at", at, [0.0, LATEST], "s")).transpose()?;
        self.observed.walk.push(PushCommand { force, duration }, at).map_err(wrong)
    }

    /// Parameters of all processes by `process.name`, with unit, range, default and present value.
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        parameters::all(py, &self.observed.walk)
    }

    /// Present value of a parameter, in its unit.
    fn get_parameter(&self, name: &str) -> PyResult<f64> {
        parameters::value(&self.observed.walk, name)
    }

    /// Gives a parameter another value from the next cycle on; the name of the process that takes it. Raises Refused.
    fn set_parameter(
        &mut self,
        py: Python<'_>,
        name: &str,
        value: &Bound<'_, PyAny>,
    ) -> PyResult<&'static str> {
        let command = parameters::command(py, &self.observed.walk.setup, name, value)?;
        self.answered(py, &command)
    }

    // The whole state.

    /// Chain in the same state, which goes on by itself: pushes and commands to come are copied, views and log are not.
    fn copy(&self, py: Python<'_>) -> Self {
        Self::of(py.detach(|| self.observed.walk.clone()), self.changed)
    }

    fn __copy__(&self, py: Python<'_>) -> Self {
        self.copy(py)
    }

    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> Self {
        self.copy(py)
    }

    /// The whole state: `restore` goes back to it, and what follows has the same bytes as without.
    fn save(&self) -> State {
        State(self.observed.walk.clone())
    }

    /// Goes back to a state of this scene with the same depth, integrator and seed.
    fn restore(&mut self, py: Python<'_>, state: &Bound<'_, State>) -> PyResult<()> {
        let walk = &state.get().0;
        let (ours, theirs) = (&self.observed.walk.setup, &walk.setup);
        let of = |setup: &config::Setup| (setup.hash, setup.scene.seed, setup.scene.method());
        if of(ours) != of(theirs) {
            let name = |setup: &config::Setup| {
                format!("{} ({}, seed {})", setup.scene.name, setup.scene.method(), setup.scene.seed)
            };
            return Err(wrong(format!("state is one of {}: this is {}", name(theirs), name(ours))));
        }
        if self.observed.is_logged() {
            return Err(wrong("state: a log is being written, and time in it goes on; end_log() first"));
        }
        self.observed.walk = walk.clone();
        self.observed.refresh(py)
    }

    // Its log.

    /// Writes a log from now on, the file that `gangwerk sim --log` writes; before the first step only.
    fn log(&mut self, path: PathBuf) -> PyResult<()> {
        if self.changed {
            let text = "a log holds the files of its scene, and this one was changed: copy the scene, and change the copy";
            return Err(wrong(format!("path = {}: {text}", path.display())));
        }
        self.observed.begin_log(&path).map_err(wrong)
    }

    /// Ends the log with its index.
    fn end_log(&mut self) -> PyResult<()> {
        self.observed.end_log().map_err(wrong)
    }
}

/// Classes and functions of this file, added to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Chain>()?;
    module.add_class::<State>()?;
    module.add_class::<Event>()
}
