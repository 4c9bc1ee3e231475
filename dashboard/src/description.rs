//! Description of a run, told once to a page: robot, scene, layout of the state, fields, commands, parameters.

use config::joystick::{ButtonFunction, STICKS, Stick};
use config::registry::{Change, ParameterEntry};
use config::terrain::{ObjectShape, TerrainObject};
use config::{Joystick, Robot, Setup};
use ipc::{Mode, Run};
use messages::command_text::{COMMANDS, CommandInfo};
use serde_json::{Map, Value, json};

use crate::plotting::PlotField;
use crate::state::LayoutEntry;

/// Version of the protocol between server and page.
pub const VERSION: u32 = 1;

/// The message `hello` of a run, the `number`-th of this server.
///
/// # Errors
/// The mesh of an object cannot be read.
pub fn hello(
    number: u64,
    run: &Run,
    setup: &Setup,
    layout: &[LayoutEntry],
    fields: &[PlotField],
    parameters: &[(ParameterEntry, f64)],
) -> Result<Value, String> {
    let mode = if run.mode == Mode::Lockstep { "lockstep" } else { "real-time" };
    let state = layout.iter().map(|e| json!({"name": e.name, "count": e.count, "unit": e.unit}));
    let fields = fields.iter().map(|f| json!({"name": f.name, "unit": f.unit}));
    Ok(json!({
        "type": "hello", "version": VERSION, "run": number, "mode": mode, "cycle": setup.scene.cycle,
        "robot": robot(&setup.robot),
        "scene": scene(run, setup)?,
        "state": state.collect::<Vec<_>>(),
        "fields": fields.collect::<Vec<_>>(),
        "commands": COMMANDS.iter().map(command).collect::<Vec<_>>(),
        "parameters": parameters.iter().map(parameter).collect::<Vec<_>>(),
        "gait": gait(setup),
        "joystick": joystick(run),
    }))
}

fn robot(robot: &Robot) -> Value {
    let joint = |j: &config::robot::Joint| {
        let [low, high] = j.range;
        json!({"name": j.name, "low": low, "high": high, "speed": j.speed_limit})
    };
    let foot = |f: &config::robot::Foot| json!({"link": f.link, "sole": f.sole, "support": f.support, "sensor_link": f.sensor_link, "sensor": f.sensor});
    json!({
        "name": robot.name, "mass_kg": robot.total_mass, "torso_link": robot.torso,
        "joints": robot.joints.iter().map(joint).collect::<Vec<_>>(),
        "feet": robot.feet.iter().map(foot).collect::<Vec<_>>(),
    })
}

fn scene(run: &Run, setup: &Setup) -> Result<Value, String> {
    let scene = &setup.scene;
    let objects = scene.objects.iter().map(object).collect::<Result<Vec<_>, _>>()?;
    let mismatch = &scene.plant_mismatch;
    Ok(json!({
        "name": scene.name, "about": scene.about, "model": model(run, setup), "simulated": run.robot,
        "crane": scene.crane.is_some(), "duration": scene.duration, "objects": objects,
        "ground": {"height": mismatch.ground_height, "tilt": mismatch.ground_tilt},
    }))
}

/// The method of simulation in words.
pub fn model(run: &Run, setup: &Setup) -> String {
    run.method.clone().unwrap_or_else(|| setup.scene.model())
}

/// Surface of an object in its own frame.
fn object(object: &TerrainObject) -> Result<Value, String> {
    let mesh = object.shape.mesh().map_err(|e| format!("object {}: {e}", object.name))?;
    let kind = match object.shape {
        ObjectShape::Box(_) => "box",
        ObjectShape::Mesh { .. } => "mesh",
    };
    // Corners that triangles share stay apart: flat shading wants them so.
    let corners = mesh.faces().flatten().flat_map(<[f64; 3]>::from);
    let vertices: Vec<f32> = corners.map(|x| x as f32).collect();
    let triangles: Vec<usize> = (0..vertices.len() / 3).collect();
    Ok(json!({"name": object.name, "kind": kind, "vertices": vertices, "triangles": triangles}))
}

fn command(info: &CommandInfo) -> Value {
    let field = |f: &messages::command_text::FieldInfo| {
        let [low, high] = f.range;
        json!({"name": f.name, "unit": f.unit, "low": low, "high": high, "default": f.default, "about": f.about})
    };
    let fields: Vec<Value> = info.fields.iter().map(field).collect();
    let needs_lease = info.example().needs_lease();
    json!({"name": info.name, "about": info.about, "needs_lease": needs_lease, "fields": fields})
}

fn parameter((entry, value): &(ParameterEntry, f64)) -> Value {
    let limit = |x: f64| (x.is_finite() && x.abs() < f64::MAX).then_some(x);
    let change = match entry.change {
        Change::Live(_) => "live",
        Change::File(_) => "fixed",
        Change::Constant => "constant",
    };
    json!({
        "name": entry.full_name(), "unit": entry.unit, "low": limit(entry.range[0]), "high": limit(entry.range[1]),
        "default": entry.default, "value": value, "change": change, "about": entry.about,
    })
}

/// Walking commands that the gait admits.
fn gait(setup: &Setup) -> Value {
    let (gait, limits) = (&setup.gait, &setup.gait.limits);
    let fastest = gait.step.by_speed.last().map(|row| row[0]);
    let [forward, left, turn] = gait.velocities();
    json!({
        "speed": fastest, "velocity": {"forward": forward, "left": left, "turn": turn}, "on_the_spot": gait.on_the_spot(),
        "length": limits.length, "side": limits.side, "turn": limits.turn, "duration": limits.duration,
    })
}

/// Layout of a gamepad with which the run was started, or what is wrong with its file.
fn joystick(run: &Run) -> Value {
    let layout = match Joystick::of_config(&run.config) {
        Ok(layout) => layout,
        Err(e) => return json!({"problem": e.to_string()}),
    };
    let stick = |s: &Stick| json!({"axis": s.control.name, "reverse": s.reverse, "share": s.share});
    let names = |f: &ButtonFunction| layout.button(*f).iter().map(|c| c.name).collect::<Vec<_>>();
    let sticks = STICKS.iter().zip(&layout.sticks).map(|(name, s)| ((*name).to_owned(), stick(s)));
    let buttons = ButtonFunction::ALL.iter().map(|f| (f.name().to_owned(), json!(names(f))));
    json!({
        "dead_zone": layout.dead_zone, "sticks": sticks.collect::<Map<_, _>>(), "buttons": buttons.collect::<Map<_, _>>(),
    })
}

/// Files of a robot as a page may fetch them: its URDF, and the meshes that it names.
#[derive(Clone, Debug, Default)]
pub struct RobotFiles {
    /// Text of the URDF, in which meshes have the names below.
    pub urdf: String,
    /// Name under `/meshes/`, and contents.
    pub meshes: Vec<(String, Vec<u8>)>,
}

impl RobotFiles {
    /// Of this robot, whose files are in `folder`.
    pub fn of(robot: &Robot, folder: &std::path::Path) -> Self {
        let (mut urdf, mut meshes) = (String::new(), Vec::new());
        let mut rest = robot.urdf.as_str();
        while let Some((before, after)) = rest.split_once("filename=\"") {
            let Some((name, behind)) = after.split_once('"') else { break };
            urdf += before;
            let file = Self::inside(folder, name);
            let extension = file.as_deref().and_then(|f| f.extension()?.to_str()).unwrap_or("none");
            let served = format!("{}.{extension}", meshes.len());
            urdf += &format!("filename=\"/meshes/{served}\"");
            // One that cannot be read has no outline, and the robot is shown without it.
            match file.map(std::fs::read) {
                Some(Ok(bytes)) => meshes.push((served, bytes)),
                _ => {
                    tracing::warn!("mesh {name} of robot {} cannot be read; it is not shown", robot.name);
                    meshes.push((served, Vec::new()));
                }
            }
            rest = behind;
        }
        urdf += rest;
        Self { urdf, meshes }
    }

    /// A file named in a URDF, if that leads nowhere else than into the robot's folder.
    fn inside(folder: &std::path::Path, name: &str) -> Option<std::path::PathBuf> {
        let name = name.strip_prefix("package://").map_or(name, |n| n.split_once('/').map_or(n, |(_, n)| n));
        let path = std::path::Path::new(name);
        let plain = path.components().all(|part| matches!(part, std::path::Component::Normal(_)));
        plain.then(|| folder.join(path))
    }
}
