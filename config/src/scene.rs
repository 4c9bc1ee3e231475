//! Scene file. Only the effects it names are simulated.

use std::path::Path;

use drives::JointControl;
use messages::command::{Domain, PushCommand};
use messages::command_text::{COMMANDS, CommandInfo};
use messages::{Command, MAX_MOVING};

use crate::bus_fault::BusFault;
use crate::components::{ComponentChanges, Components, JointModel};
use crate::crane::{Crane, DriveStart};
use crate::error::ConfigError;
use crate::file::{self, ConfigReader};
use crate::joint_control;
use crate::method::{Integrator, Method};
use crate::plant_mismatch::PlantMismatch;
use crate::section::{self, NOT_NEGATIVE, POSITIVE, Section};
use crate::sensors::SensorErrors;
use crate::terrain::{self, TerrainObject};
use crate::tolerance::Tolerance;

/// Seed of a scene that says none.
pub const SEED: u64 = 1;

/// \[rad/s\] Ramp of dry friction of a scene that says none.
pub const FRICTION_RAMP: f64 = 1.0;

/// Words of `points`: how drives are told where to go.
const POINTS: [&str; 2] = ["every_cycle", "tables"];

/// `scenes/NAME.toml`.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Name of the file without its extension.
    pub name: String,
    /// Purpose of the scene in one sentence.
    pub about: String,
    /// Name of the robot's directory.
    pub robot: String,
    /// Name of the gait file.
    pub gait: String,
    /// Accuracy that `depth = "auto"` must reach. While this is there, depth, integrator and steps are stand-ins that nothing may
    /// be simulated with: [`Scene::choose`] them.
    pub auto: Option<Tolerance>,
    /// Modelling depth; type 1 is the reduced model (thesis table 2.4).
    pub depth: u8,
    /// Changes to the components of that type.
    pub components: ComponentChanges,
    /// Integrator of the simulated robot.
    pub integrator: Integrator,
    /// \[1\] Integration steps per bus cycle.
    pub substeps: u32,
    /// Steps that are longer than the stable ones are taken all the same.
    pub force_step: bool,
    /// \[1\] Error of a step of the adaptive integrator, relative and absolute; the others have none.
    pub tolerance: Option<f64>,
    /// \[rad/s\] Speed of a rotor over which dry friction changes its sign for integrators that cannot let it stick: all but
    /// "semi_implicit". [`FRICTION_RAMP`] if the scene says none; narrower is nearer to the law, and stiffer.
    pub friction_ramp: f64,
    /// \[s\] Bus cycle.
    pub cycle: f64,
    /// Drives play tables of points by themselves, instead of following a point in every cycle.
    pub plays_tables: bool,
    /// Name of the joint pose the robot starts in, standing on the ground.
    pub start_pose: String,
    /// \[s\]
    pub duration: f64,
    /// Seed of everything random: noise of sensors, faults of the bus; [`SEED`] if the scene says none.
    pub seed: u64,
    /// Objects on the ground.
    pub objects: Vec<TerrainObject>,
    /// Errors of the sensors.
    pub sensors: SensorErrors,
    /// Joint control of all drives, instead of the robot's.
    pub joint_control: Option<JointControl>,
    /// Plant mismatch: differences from the model of the robot's software.
    pub plant_mismatch: PlantMismatch,
    /// Crane that holds the robot at the start; none: it stands.
    pub crane: Option<Crane>,
    /// Drives as they are at switch-on; none: they know their angles, and nothing protects them.
    pub drives: Option<DriveStart>,
    /// Commands by time \[s\], ascending.
    pub commands: Vec<(f64, Command)>,
    /// Pushes at the torso by time \[s\], ascending.
    pub pushes: Vec<(f64, PushCommand)>,
    /// Faults of the field bus by time, ascending.
    pub bus_faults: Vec<BusFault>,
}

impl Scene {
    /// Reads a scene file.
    pub fn load(path: &Path) -> Result<Self, ConfigError> {
        let root = path.parent().and_then(Path::parent).unwrap_or(Path::new("."));
        Self::load_with(path, root, &mut ConfigReader::default())
    }

    /// A scene file that may lie outside of the configuration directory `root`, in which its objects are.
    pub(crate) fn load_with(
        path: &Path,
        root: &Path,
        reader: &mut ConfigReader,
    ) -> Result<Self, ConfigError> {
        let text = file::text(path, reader)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut scene = section::read(path, &text, |top| Self::build(top, name))?;
        terrain::find(&mut scene.objects, root, reader)?;
        Ok(scene)
    }

    fn build(top: &Section<'_, '_>, name: String) -> Self {
        let (method, auto) = method(top);
        let Method { depth, integrator, substeps } = method;
        // `tolerance` is a number for the adaptive integrator, or a table for depth "auto".
        let adaptive = auto.is_none() && top.has("tolerance") && !top.is_table("tolerance");
        if auto.is_none() && top.is_table("tolerance") {
            top.problem(
                "tolerance",
                "a table of tolerances needs depth = \"auto\", which chooses type and steps",
            );
        }
        let scene = Self {
            name,
            about: top.text("about"),
            robot: top.text("robot"),
            gait: top.text("gait"),
            components: components(top, auto.is_some()),
            auto,
            depth,
            integrator,
            substeps,
            force_step: top.has("force_step") && top.flag("force_step"),
            tolerance: adaptive.then(|| top.number("tolerance", "1", 1e-12..=1e-2)),
            friction_ramp: friction_ramp(top),
            cycle: top.number("cycle", "s", 1e-4..=0.02),
            plays_tables: top.has("points") && top.word("points", &POINTS) == 1,
            start_pose: top.text("start_pose"),
            duration: top.number("duration", "s", POSITIVE),
            seed: if top.has("seed") { top.integer("seed", 0..=u64::MAX) } else { SEED },
            objects: top.tables("object", terrain::object),
            sensors: sensors(top),
            joint_control: top
                .has("joint_control")
                .then(|| top.table("joint_control", joint_control::build))
                .flatten(),
            plant_mismatch: plant_mismatch(top),
            crane: top.has("crane").then(|| top.table("crane", Crane::build)).flatten(),
            drives: top.has("drives").then(|| top.table("drives", DriveStart::build)).flatten(),
            commands: top.tables("command", command),
            pushes: top.tables("push", push),
            bus_faults: top.tables("bus_fault", BusFault::build),
        };
        if (scene.integrator == Integrator::Bdf) != scene.tolerance.is_some() {
            top.problem("tolerance", "the integrator \"bdf\" needs a tolerance, and no other one has one");
        }
        let components = scene.components();
        let friction = components.joints == JointModel::Motors && components.friction;
        let has_ramp = scene.auto.is_none() && friction && integrator != Integrator::SemiImplicit;
        if top.has("friction_ramp") && !has_ramp {
            top.problem(
                "friction_ramp",
                "it is for \"euler\", \"rk4\" and \"bdf\" on types 2 to 5; others see dry friction as it is, or none",
            );
        }
        let moving = scene.objects.iter().filter(|o| o.moves()).count();
        if moving > MAX_MOVING {
            top.problem(
                "object",
                format!("{moving} of them move, appear or vanish; at most {MAX_MOVING} can"),
            );
        }
        // Rows stand in the order of time, as everything that plays them expects.
        scene.check_times(top, "command", scene.commands.iter().map(|(time, _)| *time));
        scene.check_times(top, "push", scene.pushes.iter().map(|(time, _)| *time));
        scene.check_times(top, "bus_fault", scene.bus_faults.iter().map(|fault| fault.time));
        scene
    }

    /// Components of the simulated robot: those of its type, as far as the scene does not change them.
    pub fn components(&self) -> Components {
        self.components.applied(self.depth)
    }

    /// Name of the model: "type 2, without currents".
    pub fn model(&self) -> String {
        format!("type {}{}", self.depth, self.components)
    }

    /// Method of simulation.
    pub fn method(&self) -> Method {
        Method { depth: self.depth, integrator: self.integrator, substeps: self.substeps }
    }

    /// Simulates the scene with `method` from now on.
    pub fn choose(&mut self, method: Method) {
        Method { depth: self.depth, integrator: self.integrator, substeps: self.substeps } = method;
        self.auto = None;
    }

    fn check_times(&self, top: &Section<'_, '_>, key: &str, times: impl Iterator<Item = f64>) {
        let mut last = 0.0;
        for (i, time) in times.enumerate() {
            if time < last {
                top.problem(
                    key,
                    format!("{key}[{i}]: its time {time} s lies before {last} s of the one above it"),
                );
            }
            if time > self.duration {
                let end = self.duration;
                top.problem(
                    key,
                    format!("{key}[{i}]: its time {time} s lies after the end of the scene, {end} s"),
                );
            }
            last = time;
        }
    }
}

/// `depth`, `integrator`, `substeps`; or a stand-in and what `depth = "auto"` is to reach.
fn method(top: &Section<'_, '_>) -> (Method, Option<Tolerance>) {
    if !top.is_text("depth") {
        let depth = top.integer("depth", 1..=5) as u8;
        let integrator = Integrator::ALL[top.word("integrator", &Integrator::WORDS)];
        return (Method { depth, integrator, substeps: top.integer("substeps", 1..=1000) as u32 }, None);
    }
    let depth = top.text("depth");
    if depth != "auto" {
        top.problem(
            "depth",
            format!("`{depth}` is not allowed; it takes a whole number from 1 to 5, or \"auto\""),
        );
    }
    for key in ["integrator", "substeps"] {
        if top.has(key) {
            top.problem(key, "depth \"auto\" chooses it; leave it out");
        }
    }
    let stand_in = Method { depth: 1, integrator: Integrator::Euler, substeps: 1 };
    (stand_in, Some(Tolerance::read(top)))
}

/// `[components]`, if it is there.
fn components(top: &Section<'_, '_>, auto: bool) -> ComponentChanges {
    let named = top.has("components").then(|| top.table("components", ComponentChanges::build));
    if auto && named.is_some() {
        top.problem("components", "depth \"auto\" chooses them; leave the table out");
    }
    named.flatten().unwrap_or_default()
}

/// `friction_ramp`, if it is there.
fn friction_ramp(top: &Section<'_, '_>) -> f64 {
    if top.has("friction_ramp") { top.number("friction_ramp", "rad/s", 1e-3..=100.0) } else { FRICTION_RAMP }
}

/// `[sensors]`, if it is there.
fn sensors(top: &Section<'_, '_>) -> SensorErrors {
    let named = top.has("sensors").then(|| top.table("sensors", SensorErrors::build));
    named.flatten().unwrap_or_default()
}

/// `[plant_mismatch]`, if it is there.
fn plant_mismatch(top: &Section<'_, '_>) -> PlantMismatch {
    let named = top.has("plant_mismatch").then(|| top.table("plant_mismatch", PlantMismatch::build));
    named.flatten().unwrap_or_default()
}

/// One `[[command]]`: `time`, the topic as `gangwerk topic` names it, and the topic's fields.
fn command(row: &Section<'_, '_>) -> (f64, Command) {
    let time = row.number("time", "s", NOT_NEGATIVE);
    let scripted: Vec<&CommandInfo> = COMMANDS.iter().filter(|info| is_scripted(&info.example())).collect();
    let names: Vec<&str> = scripted.iter().map(|info| info.name).collect();
    let info = scripted[row.word("topic", &names)];
    let mut text = String::new();
    for field in info.fields {
        if field.default.is_none() || row.has(field.name) {
            let [lo, hi] = field.range;
            text += &format!("{}={} ", field.name, row.number(field.name, field.unit, lo..=hi));
        }
    }
    let command = Command::parse(info.name, &text).unwrap_or_else(|problem| {
        if !text.contains("NaN") {
            row.problem("topic", problem);
        }
        Command::Stop
    });
    (time, command)
}

/// Whether a scene can give a command; pushes have a table of their own, and parameters are set by name.
fn is_scripted(command: &Command) -> bool {
    use Domain::{Head, Joint, System, Vision, Walk};
    match command {
        Command::WalkParameter(_) => false,
        Command::Lower(_) => true,
        other => matches!(other.address().0, System | Walk | Head | Joint | Vision),
    }
}

fn push(row: &Section<'_, '_>) -> (f64, PushCommand) {
    let force = row.numbers("force", "N", -5000.0..=5000.0);
    let push = PushCommand { force, duration: row.number("duration", "s", 0.0..=10.0) };
    (row.number("time", "s", NOT_NEGATIVE), push)
}
