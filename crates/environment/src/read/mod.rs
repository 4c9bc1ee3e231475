//! Meshes from files: which reader, limits before anything is believed, and one kind of error.
//!
//! | ending | format | read by | axes of the format |
//! |---|---|---|---|
//! | stl | STL, text and binary | `stl_io` | z up (no unit, no axes: taken as they are) |
//! | obj | Wavefront OBJ | `tobj` | z up (as they are) |
//! | gltf, glb | glTF 2.0 | `gltf` | y up: turned to z up |
//! | wrl | VRML 97 indexed face sets | [`vrml`] | y up: turned to z up |

mod gltf;
mod lines;
mod obj;
mod stl;
mod vrml;

use std::fmt;
use std::path::{Path, PathBuf};

use crate::topology::MOST_TRIANGLES;
use crate::{Mesh, MeshError};

/// A file that is no mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadError {
    /// The file.
    pub file: PathBuf,
    /// Line or element; empty if the file as a whole is meant.
    pub place: String,
    /// Fault, and what would be right.
    pub text: String,
}

/// Fault of a file, with its place.
#[derive(Debug)]
struct FileFault {
    place: String,
    text: String,
}

/// Vertices and triangles as a file has them.
#[derive(Debug, Default)]
struct Soup {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

/// \[byte\] The largest file that is read: a binary STL of as many triangles as a mesh may have, and some to spare.
const LARGEST_FILE: u64 = 128 << 20;

impl Mesh {
    /// Reads the solid in a file, by its ending; lengths in the file times `scale` are m. The axes are z up, see the
    /// table of this module.
    pub fn read(file: &Path, scale: f64) -> Result<Self, ReadError> {
        let bytes = bytes(file).map_err(|fault| fault.of(file))?;
        Self::parse(file, &bytes, scale)
    }

    /// The same from the bytes of the file; buffers of a glTF file are read beside it.
    pub fn parse(file: &Path, bytes: &[u8], scale: f64) -> Result<Self, ReadError> {
        let error = |fault: FileFault| fault.of(file);
        let mut soup = match ending(file).as_str() {
            "stl" => stl::read(bytes),
            "obj" => obj::read(bytes),
            "gltf" | "glb" => gltf::read(bytes, file.parent().unwrap_or(Path::new("."))),
            "wrl" => vrml::read(bytes),
            other => Err(FileFault::whole(format!(
                "`.{other}` is no format of meshes; there are .stl, .obj, .gltf, .glb and .wrl"
            ))),
        }
        .map_err(error)?;
        soup.vertices.iter_mut().flatten().for_each(|x| *x *= scale);
        Self::new(&soup.vertices, &soup.triangles)
            .map_err(|e: MeshError| error(FileFault::whole(e.to_string())))
    }
}

fn ending(file: &Path) -> String {
    file.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

fn bytes(file: &Path) -> Result<Vec<u8>, FileFault> {
    let cannot = |e| FileFault::whole(format!("cannot be read: {e}"));
    let size = std::fs::metadata(file).map_err(cannot)?.len();
    if size > LARGEST_FILE {
        let most = LARGEST_FILE >> 20;
        return Err(FileFault::whole(format!("is larger than {most} MiB; export it coarser")));
    }
    std::fs::read(file).map_err(cannot)
}

impl FileFault {
    fn whole(text: impl Into<String>) -> Self {
        Self { place: String::new(), text: text.into() }
    }

    fn of(self, file: &Path) -> ReadError {
        ReadError { file: file.to_owned(), place: self.place, text: self.text }
    }

    fn at(place: impl fmt::Display, text: impl Into<String>) -> Self {
        Self { place: place.to_string(), text: text.into() }
    }
}

impl Soup {
    /// Adds a triangle of vertices that are there; refuses more than a mesh may have.
    fn push(&mut self, triangle: [u32; 3]) -> Result<(), FileFault> {
        if self.triangles.len() >= MOST_TRIANGLES {
            return Err(FileFault::whole(format!(
                "has more than {MOST_TRIANGLES} triangles; export it coarser"
            )));
        }
        self.triangles.push(triangle);
        Ok(())
    }
}

/// y up, x to the right, as in glTF and VRML, to z up.
fn upright([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x, -z, y]
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.file.display())?;
        if !self.place.is_empty() {
            write!(f, "{}: ", self.place)?;
        }
        f.write_str(&self.text)
    }
}

impl std::error::Error for ReadError {}
