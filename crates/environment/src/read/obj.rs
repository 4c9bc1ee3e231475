//! Wavefront OBJ: positions and faces; polygons are taken as convex. Materials, normals and texture are left out.

use super::lines::LineReader;
use super::{FileFault, Soup};

pub(super) fn read(bytes: &[u8]) -> Result<Soup, FileFault> {
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_lines: true,
        ignore_points: true,
        ..Default::default()
    };
    let mut lines = LineReader::new(bytes);
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut lines, &options, no_materials).map_err(|e| {
        use tobj::LoadError::{FaceNormalOutOfBounds, FaceTexCoordOutOfBounds, FaceVertexOutOfBounds};
        let place = match e {
            // Faces are looked at when their object is complete.
            FaceVertexOutOfBounds | FaceNormalOutOfBounds | FaceTexCoordOutOfBounds => "object up to line",
            _ => "line",
        };
        FileFault::at(format!("{place} {}", lines.line), format!("{e}; export it again"))
    })?;
    let mut soup = Soup::default();
    for model in models {
        let first = soup.vertices.len() as u32;
        for v in model.mesh.positions.chunks_exact(3) {
            if !v.iter().all(|x| x.is_finite()) {
                let place = format!("object `{}`", model.name);
                return Err(FileFault::at(
                    place,
                    format!("a vertex is at {v:?}, which is no place; export it again"),
                ));
            }
            soup.vertices.push([v[0], v[1], v[2]]);
        }
        for t in model.mesh.indices.chunks_exact(3) {
            soup.push([first + t[0], first + t[1], first + t[2]])?;
        }
    }
    Ok(soup)
}
