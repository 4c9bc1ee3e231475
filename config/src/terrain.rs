//! Objects on the ground of a scene: boxes and meshes, some of them moving.

use std::error::Error;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use environment::Mesh;

use crate::error::ConfigError;
use crate::file::{self, ConfigReader};
use crate::section::{NOT_NEGATIVE, POSITIVE, Section};

/// One `[[object]]` of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct TerrainObject {
    /// In messages.
    pub name: String,
    /// Kind.
    pub shape: ObjectShape,
    /// Pose at the beginning.
    pub pose: TerrainPose,
    /// \[1\] Coefficient of friction, if not that of the robot's soles.
    pub friction: Option<f64>,
    /// \[s\] First moment it is there.
    pub appears: f64,
    /// \[s\] First moment it is not there any more; infinite if it stays.
    pub vanishes: f64,
    /// The planner knows of it: an obstacle to step over.
    pub known: bool,
    /// \[m\] Nearer to the robot's feet it does not move, unless that takes it away from them.
    pub keeps_clear: f64,
    /// Later poses, by time \[s\], ascending; it moves straight from one pose to the next.
    pub poses: Vec<(f64, TerrainPose)>,
}

/// The surface of an object.
#[derive(Clone, Debug, PartialEq)]
pub enum ObjectShape {
    /// \[m\] Lengths along x, y and z; its origin is the centre.
    Box([f64; 3]),
    /// A file in `objects/`.
    Mesh {
        /// The file.
        file: PathBuf,
        /// Contents.
        bytes: Arc<[u8]>,
        /// \[m\] One unit of the file.
        scale: f64,
    },
}

/// Pose of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TerrainPose {
    /// \[m\] @world
    pub position: [f64; 3],
    /// \[rad\] Roll, pitch and yaw: turned about x, then y, then z of the world.
    pub rotation: [f64; 3],
}

impl TerrainObject {
    /// It is not always there, or not always at the same place.
    pub fn moves(&self) -> bool {
        !self.poses.is_empty() || self.appears > 0.0 || self.vanishes.is_finite()
    }
}

impl ObjectShape {
    /// Its surface.
    ///
    /// # Errors
    /// The file of a mesh cannot be read.
    pub fn mesh(&self) -> Result<Mesh, Box<dyn Error>> {
        Ok(match self {
            Self::Box(size) => Mesh::cuboid(*size)?,
            Self::Mesh { file, bytes, scale } => Mesh::parse(file, bytes, *scale)?,
        })
    }
}

const PLACE: std::ops::RangeInclusive<f64> = -1e3..=1e3;

/// One `[[object]]`.
pub(crate) fn object(row: &Section<'_, '_>) -> TerrainObject {
    let optional = |key: &str, unit, range, default| {
        if row.has(key) { row.number(key, unit, range) } else { default }
    };
    let object = TerrainObject {
        name: row.text("name"),
        shape: shape(row),
        pose: pose(row),
        friction: row.has("friction").then(|| row.number("friction", "", 0.0..=10.0)),
        appears: optional("appears", "s", NOT_NEGATIVE, 0.0),
        vanishes: optional("vanishes", "s", POSITIVE, f64::INFINITY),
        known: row.flag("known"),
        keeps_clear: optional("keeps_clear", "m", 0.0..=10.0, 0.0),
        poses: row.tables("pose", |row| (row.number("time", "s", POSITIVE), pose(row))),
    };
    if object.vanishes <= object.appears {
        row.problem("vanishes", format!("must be later than it appears, {} s", object.appears));
    }
    // Moving objects are for contact and cameras only: the planner does not follow them.
    let moves = object.moves();
    if object.known && moves {
        row.problem("known", "the planner knows only what stays where it is from the beginning to the end");
    }
    for pair in object.poses.windows(2) {
        if pair[1].0 <= pair[0].0 {
            let text =
                format!("its time {} s must be later than {} s of the one above it", pair[1].0, pair[0].0);
            row.problem("pose", text);
        }
    }
    object
}

fn shape(row: &Section<'_, '_>) -> ObjectShape {
    match (row.has("box"), row.has("mesh")) {
        (true, false) => ObjectShape::Box(row.numbers("box", "m", 1e-3..=1e3)),
        (false, true) => {
            let file = PathBuf::from(row.text("mesh"));
            if !file.components().all(|part| matches!(part, Component::Normal(_))) {
                row.problem("mesh", "must lie in the directory `objects` of the configuration");
            }
            let scale = if row.has("scale") { row.number("scale", "m", POSITIVE) } else { 1.0 };
            ObjectShape::Mesh { file, bytes: Arc::default(), scale }
        }
        _ => {
            row.problem(
                "box",
                "an object takes either `box`, three lengths in m, or `mesh`, a file in `objects`",
            );
            ObjectShape::Box([f64::NAN; 3])
        }
    }
}

fn pose(row: &Section<'_, '_>) -> TerrainPose {
    let rotation =
        if row.has("rotation") { row.numbers("rotation", "deg", -360.0..=360.0) } else { [0.0; 3] };
    TerrainPose { position: row.numbers("position", "m", PLACE), rotation: rotation.map(f64::to_radians) }
}

/// Reads the files of meshes in `objects/` of the configuration directory `root`, with `reader`.
pub(crate) fn find(
    objects: &mut [TerrainObject],
    root: &Path,
    reader: &mut ConfigReader,
) -> Result<(), ConfigError> {
    for object in objects {
        if let ObjectShape::Mesh { file, bytes, .. } = &mut object.shape {
            *file = root.join("objects").join(&*file);
            *bytes = file::include(file, reader)?.into();
        }
    }
    Ok(())
}
