//! Everything a run needs: a scene and the files it names.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use messages::{Command, nearest};

use crate::error::{ConfigError, Problem};
use crate::file::{self, ConfigReader};
use crate::method::Method;
use crate::section::listed;
use crate::{Gait, Robot, Scene, System, scenes};

/// A scene, the robot and gait it names, and the run-time system; each fits the others.
#[derive(Clone, Debug)]
pub struct Setup {
    /// What is simulated.
    pub scene: Scene,
    /// The robot of the scene.
    pub robot: Robot,
    /// The gait of the scene.
    pub gait: Gait,
    /// The run-time system.
    pub system: System,
    /// FNV-1a, 64 bits, over the bytes of all files that were read.
    pub hash: u64,
    /// Those files as they were read, by their names in the configuration directory: [`Setup::load`] from a copy of them
    /// is this one again.
    pub files: Arc<[(String, Vec<u8>)]>,
}

/// Numbers by their keys ([`crate::edit`]) that take the place of those in a scene's file and its gait's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SetupNumbers {
    /// Those of the scene.
    pub scene: Vec<(String, f64)>,
    /// Those of the gait.
    pub gait: Vec<(String, f64)>,
}

/// A scene's files as they were read, and its robot: whatever happens to them on the disk, each [`Setup`] from here is of these.
#[derive(Clone, Debug)]
pub struct SetupFiles {
    root: PathBuf,
    path: PathBuf,
    /// All but the robot's.
    files: Vec<file::Read>,
    robot: Robot,
    robot_files: Vec<file::Read>,
}

impl SetupFiles {
    /// Reads the scene of that name in the configuration directory `root`, or of that path, and all it names; see
    /// [`crate::find`].
    ///
    /// # Errors
    /// A file cannot be read, or is wrong by itself.
    pub fn read(root: &Path, scene: &str) -> Result<Self, ConfigError> {
        let path = scenes::locate(root, scene)?;
        let (mut reader, mut robot_reader) = (ConfigReader::default(), ConfigReader::default());
        let scene = Scene::load_with(&path, root, &mut reader)?;
        let robot = Robot::load_with(&root.join("robots").join(&scene.robot), &mut robot_reader)?;
        Gait::load_with(&gait_path(root, &scene.gait), &mut reader)?;
        System::load_with(&root.join("system.toml"), &mut reader)?;
        Ok(Self { root: root.into(), path, files: reader.files, robot, robot_files: robot_reader.files })
    }

    /// The scene's file.
    pub fn scene_path(&self) -> &Path {
        &self.path
    }

    /// What they say with other numbers, each in the place of one that stands there.
    ///
    /// # Errors
    /// A file has no such number, or is wrong with it, or does not fit the others.
    pub fn setup(&self, numbers: &SetupNumbers) -> Result<Setup, ConfigError> {
        let (root, path) = (&self.root, &self.path);
        let mut reader = ConfigReader::of_files(self.files.clone());
        reader.edit(path, &numbers.scene)?;
        let scene = Scene::load_with(path, root, &mut reader)?;
        // The robot, and what the scene makes of it.
        self.robot_files.iter().for_each(|(path, bytes)| reader.keep(path, bytes));
        let mut robot = self.robot.clone();
        if let Some(control) = scene.joint_control {
            robot.drives.iter_mut().for_each(|drive| drive.set_control(control));
        }
        if scene.plays_tables {
            robot.play_tables().map_err(|text| ConfigError::of_file(path, format!("points: {text}")))?;
        }
        let gait = gait_path(root, &scene.gait);
        reader.edit(&gait, &numbers.gait)?;
        let gait = Gait::load_with(&gait, &mut reader)?;
        let system = System::load_with(&root.join("system.toml"), &mut reader)?;
        // Names as in the configuration directory, from wherever the scene is.
        let name = |file: &Path| match file.strip_prefix(root) {
            Err(_) if file == path => format!("scenes/{}.toml", scene.name),
            inside => inside.unwrap_or(file).display().to_string(),
        };
        let files = reader.files.into_iter().map(|(path, bytes)| (name(&path), bytes)).collect();
        Setup { scene, robot, gait, system, hash: reader.hash, files }.checked(path.clone())
    }
}

/// Sink of problems: key and text.
type Note<'a> = &'a mut dyn FnMut(String, String);

/// File of the gait with this name, which may have dots.
pub fn gait_path(root: &Path, name: &str) -> PathBuf {
    root.join("gaits").join(format!("{name}.toml"))
}

impl Setup {
    /// Reads the scene of that name in the configuration directory `root`, or of that path, and all it names; see
    /// [`crate::find`].
    pub fn load(root: &Path, scene: &str) -> Result<Self, ConfigError> {
        SetupFiles::read(root, scene)?.setup(&SetupNumbers::default())
    }

    fn checked(self, file: PathBuf) -> Result<Self, ConfigError> {
        let problems = self.problems();
        if problems.is_empty() { Ok(self) } else { Err(ConfigError { file, problems }) }
    }

    /// Name of the gait's file in [`files`](Self::files), and its text.
    pub fn gait_file(&self) -> (String, &str) {
        let name = format!("gaits/{}.toml", self.scene.gait);
        let bytes = self.files.iter().find(|(file, _)| *file == name).map_or(&[][..], |(_, bytes)| bytes);
        (name, std::str::from_utf8(bytes).unwrap_or_default())
    }

    /// The same with another text of the gait's file.
    ///
    /// # Errors
    /// The text is no gait, or one that does not fit the scene.
    pub fn with_gait(mut self, text: &str) -> Result<Self, ConfigError> {
        let (name, _) = self.gait_file();
        self.gait = Gait::of_text(Path::new(&name), text)?;
        let bytes = |(file, old): &(String, Vec<u8>)| {
            (file.clone(), if *file == name { text.as_bytes().to_vec() } else { old.clone() })
        };
        self.files = self.files.iter().map(bytes).collect();
        self.hash = file::hash_of(self.files.iter().map(|(_, bytes)| bytes.as_slice()));
        self.checked(name.into())
    }

    /// The same with the frames of classic CAN, or those of CAN FD that every other bus carries.
    ///
    /// # Errors
    /// The robot has no frames of classic CAN.
    pub fn on_bus(mut self, classic: bool) -> Result<Self, String> {
        if classic {
            self.robot.layout = self.robot.classic.clone()?;
        }
        Ok(self)
    }

    /// The same with a method instead of the scene's; one whose depth is "auto" needs it.
    ///
    /// # Errors
    /// There is none, and the scene does not say one; or the scene changes components that a model of this depth lacks.
    pub fn with_method(mut self, method: Option<Method>) -> Result<Self, String> {
        if let Some(method) = method {
            let (name, depth) = (&self.scene.name, method.depth);
            if let Some((key, why)) = self.scene.components.problem(depth, &self.robot) {
                return Err(format!("scene {name}: components.{key} with depth {depth}: {why}"));
            }
            self.scene.choose(method);
        }
        match self.scene.auto {
            None => Ok(self),
            Some(_) => Err(format!(
                "scene {}: its depth is \"auto\", and nobody has chosen yet; `gangwerk sim` and `gangwerk run` do",
                self.scene.name
            )),
        }
    }

    /// What the scene says that robot or gait cannot do.
    fn problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        let note = &mut |key: String, text: String| problems.push(Problem { line: 0, key, text });
        self.check_start_pose(note);
        self.check_points(note);
        self.check_commands(note);
        self.check_sensors(note);
        self.check_parts(note);
        self.check_components(note);
        self.check_drives(note);
        self.check_plant_mismatch(note);
        self.check_bus_faults(note);
        problems
    }

    /// The robot has the pose.
    fn check_start_pose(&self, note: Note<'_>) {
        let (scene, poses) = (&self.scene, &self.robot.poses);
        if !poses.contains_key(&scene.start_pose) {
            let names: Vec<&str> = poses.keys().map(String::as_str).collect();
            let (pose, robot) = (&scene.start_pose, &scene.robot);
            let near =
                nearest(pose, &names).map_or(String::new(), |name| format!("; the nearest is `{name}`"));
            let text = format!("robot {robot} has no pose `{pose}`{near}; there is {}", listed(&names));
            note("start_pose".to_owned(), text);
        }
    }

    /// Tables come from plans that need no correction.
    fn check_points(&self, note: Note<'_>) {
        let scene = &self.scene;
        let Some(tables) = &self.robot.tables else { return };
        match &self.gait.pattern {
            None => {
                note("points".to_owned(), format!("gait {} has no [pattern] to make tables of", scene.gait));
            }
            Some(pattern) => {
                if let Some((key, text)) = tables.problem(pattern, scene.cycle) {
                    note("points".to_owned(), format!("gait {}, pattern.{key} = {text}", scene.gait));
                }
            }
        }
    }

    /// Commands lie within the gait.
    fn check_commands(&self, note: Note<'_>) {
        let scene = &self.scene;
        for (i, (time, command)) in scene.commands.iter().enumerate() {
            if let Some(text) = self.beyond_gait(command) {
                note(format!("command[{i}]"), format!("at {time} s: {text} of gait {}", scene.gait));
            }
        }
    }

    /// Sensors name joints of the robot.
    fn check_sensors(&self, note: Note<'_>) {
        for (key, text) in self.scene.sensors.unknown_joints(&self.scene.robot, &self.joint_names()) {
            note(key, text);
        }
    }

    /// Commands and gait are to parts that the robot and the scene have: head, arms, crane.
    fn check_parts(&self, note: Note<'_>) {
        let scene = &self.scene;
        let to_head = |c: &Command| c.address().0 == messages::command::Domain::Head;
        if let Some(i) = scene.commands.iter().position(|(_, c)| to_head(c) && self.robot.head.is_none()) {
            let name = scene.commands[i].1.name();
            note(format!("command[{i}]"), format!("{name}: robot {} has no [head]", scene.robot));
        }
        if self.gait.arm_swing.is_some() && self.robot.arms.is_none() {
            let (gait, robot) = (&scene.gait, &scene.robot);
            note("gait".to_owned(), format!("gait {gait} has arm_swing, but robot {robot} has no [arms]"));
        }
        let lowers = |c: &Command| matches!(c, Command::Lower(_)) && scene.crane.is_none();
        if let Some(i) = scene.commands.iter().position(|(_, c)| lowers(c)) {
            note(format!("command[{i}]"), "sim/lower: the scene has no [crane]".to_owned());
        }
    }

    /// Components are those of the robot, and fit together.
    fn check_components(&self, note: Note<'_>) {
        let scene = &self.scene;
        if let Some((key, text)) = scene.components.problem(scene.depth, &self.robot) {
            note(format!("components.{key}"), text);
        }
    }

    /// State of the drives at the start, and what it needs of the robot.
    fn check_drives(&self, note: Note<'_>) {
        let scene = &self.scene;
        if scene.drives.is_some() && self.robot.protection.is_none() {
            note("drives".to_owned(), format!("robot {} has no [protection]", scene.robot));
        }
        let homeless = self.robot.homes.iter().all(Option::is_none);
        if scene.drives.as_ref().is_some_and(|drives| drives.homing) && homeless {
            let text = format!("robot {} has no [home.JOINT]: every joint knows its angle", scene.robot);
            note("drives.homing".to_owned(), text);
        }
    }

    /// Plant mismatch names joints of the robot.
    fn check_plant_mismatch(&self, note: Note<'_>) {
        let (robot, mismatch, joints) = (&self.scene.robot, &self.scene.plant_mismatch, self.joint_names());
        let named = [
            ("joint_offset_rad", &mismatch.joint_offset),
            ("drive_clock_ppm", &mismatch.drive_clock),
            ("mass_factor", &mismatch.mass_factor),
        ];
        for (key, (name, _)) in named.iter().flat_map(|(key, of)| of.own.iter().map(move |own| (key, own))) {
            if !joints.contains(&name.as_str()) {
                let near = nearest(name, &joints).unwrap_or("none");
                let text = format!("robot {robot} has no joint `{name}`; the nearest is `{near}`");
                note(format!("plant_mismatch.{key}"), text);
            }
        }
    }

    /// Bus faults name local controllers of the robot.
    fn check_bus_faults(&self, note: Note<'_>) {
        let robot = &self.scene.robot;
        let nodes: Vec<&str> = self.robot.layout.nodes.iter().map(String::as_str).collect();
        for (i, fault) in self.scene.bus_faults.iter().enumerate() {
            if let Some(name) = fault.node.as_deref().filter(|name| !nodes.contains(name)) {
                let near = nearest(name, &nodes).unwrap_or("none");
                let text = format!("robot {robot} has no local controller `{name}`; the nearest is `{near}`");
                note(format!("bus_fault[{i}].node"), text);
            }
        }
    }

    fn joint_names(&self) -> Vec<&str> {
        self.robot.joints.iter().map(|joint| joint.name.as_str()).collect()
    }

    /// Why the gait would refuse a command.
    fn beyond_gait(&self, command: &Command) -> Option<String> {
        let limits = &self.gait.limits;
        let outside = |name: &str, x: f64, [lo, hi]: [f64; 2]| {
            (x < lo || x > hi).then(|| format!("{name} = {x} lies outside of limits.{name} [{lo}, {hi}]"))
        };
        // A scene is refused when it is loaded rather than in the middle of its walk.
        match command {
            Command::Step(step) => outside("length", step.length, limits.length)
                .or_else(|| outside("side", step.side, limits.side))
                .or_else(|| outside("turn", step.turn, limits.turn))
                .or_else(|| outside("duration", step.duration, limits.duration)),
            Command::Velocity(v) => {
                let most = self.gait.step.by_speed.last().map_or(0.0, |row| row[0]);
                let rate = |name: &str, x: f64, [lo, hi]: [f64; 2], unit: &str| {
                    (x < lo || x > hi).then(|| format!("{name} = {x} lies outside of [{lo}, {hi}] {unit}"))
                };
                let [forward, left, turn] = self.gait.fastest();
                (v.forward.abs() > most)
                    .then(|| format!("forward = {} is beyond by_speed's {most} m/s", v.forward))
                    .or_else(|| rate("forward", v.forward, forward, "m/s"))
                    .or_else(|| rate("left", v.left, left, "m/s"))
                    .or_else(|| rate("turn", v.turn, turn, "rad/s"))
            }
            Command::Platform(p) => {
                let most = self.gait.obstacles.map_or(0.0, |o| o.height);
                (p.height.abs() > most)
                    .then(|| format!("height = {} is beyond obstacles.height = {most} m", p.height))
            }
            Command::Distance(d) => {
                let [back, forward] = self.gait.fastest()[0];
                let (most, way) = if d.distance < 0.0 { (-back, "backward") } else { (forward, "forward") };
                (d.speed > most).then(|| format!("speed = {} is beyond the {most:.4} m/s {way}", d.speed))
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edited_files_are_what_a_log_holds() {
        let root = crate::root(None);
        let numbers = SetupNumbers {
            scene: vec![("push.0.force.1".into(), -35.5)],
            gait: vec![("control.height_p".into(), 9000.0)],
        };
        let setup = SetupFiles::read(&root, "push").unwrap().setup(&numbers).unwrap();
        assert_eq!((setup.scene.pushes[0].1.force[1], setup.gait.control.height_p), (-35.5, 9000.0));
        let copy = std::env::temp_dir().join(format!("gangwerk-edited-{}", std::process::id()));
        for (name, bytes) in setup.files.iter() {
            let file = copy.join(name);
            std::fs::create_dir_all(file.parent().unwrap()).unwrap();
            std::fs::write(file, bytes).unwrap();
        }
        let read = SetupFiles::read(&copy, "push").unwrap();
        assert_eq!(Setup::load(&copy, "push").unwrap().hash, setup.hash);
        // They are read once.
        std::fs::remove_dir_all(&copy).unwrap();
        let again = read.setup(&SetupNumbers::default()).unwrap();
        assert_eq!((again.hash, again.files), (setup.hash, setup.files));
        assert_ne!(Setup::load(&root, "push").unwrap().hash, setup.hash);
    }
}
