//! From a list of triangles to a solid: corners joined, degenerate triangles left out, closed and oriented or refused,
//! pseudo-normals of edges and corners.

use std::collections::HashMap;

use nalgebra::Vector3;

use crate::MeshError;
use crate::point_triangle::degenerate;
use crate::triangle::Triangle;

/// More triangles than any floor needs; a file that says so is broken.
pub(crate) const MOST_TRIANGLES: usize = 2_000_000;
/// \[m\] Larger coordinates are a file in other units than it was taken for.
const LARGEST: f64 = 1e4;

/// Repairs of a mesh while it was built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshRepairs {
    /// Triangles without area that were left out.
    pub degenerate: usize,
    /// All triangles were wound the other way round, and were turned.
    pub inside_out: bool,
}

pub(crate) struct Solid {
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) repairs: MeshRepairs,
}

pub(crate) fn solid(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Solid, MeshError> {
    check_numbers(vertices, triangles)?;
    let joined = join(vertices);
    let numbers: Vec<[u32; 3]> = triangles
        .iter()
        .map(|t| t.map(|i| joined[i as usize]))
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    let mut repairs = MeshRepairs { degenerate: triangles.len() - numbers.len(), inside_out: false };
    let at = |i: u32| Vector3::from(vertices[i as usize]);
    let edges = closed(&numbers, &at)?;
    let volume: f64 = numbers.iter().map(|t| at(t[0]).dot(&at(t[1]).cross(&at(t[2])))).sum::<f64>() / 6.0;
    if volume == 0.0 {
        return Err(MeshError::Empty);
    }
    repairs.inside_out = volume < 0.0;
    let solid = normals(&numbers, &at, &edges, volume.signum());
    repairs.degenerate += numbers.len() - solid.len();
    if solid.is_empty() {
        return Err(MeshError::Empty);
    }
    Ok(Solid { triangles: solid, repairs })
}

fn check_numbers(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<(), MeshError> {
    for (i, v) in vertices.iter().enumerate() {
        if !v.iter().all(|x| x.abs() <= LARGEST) {
            return Err(MeshError::Coordinate { vertex: i, at: *v, largest: LARGEST });
        }
    }
    if triangles.len() > MOST_TRIANGLES || vertices.len() > 3 * MOST_TRIANGLES {
        return Err(MeshError::TooMany { triangles: triangles.len(), most: MOST_TRIANGLES });
    }
    for (i, t) in triangles.iter().enumerate() {
        if let Some(&v) = t.iter().find(|v| **v as usize >= vertices.len()) {
            return Err(MeshError::Number { triangle: i, vertex: v, vertices: vertices.len() });
        }
    }
    Ok(())
}

/// For each vertex the first one at the same place.
fn join(vertices: &[[f64; 3]]) -> Vec<u32> {
    let mut first = HashMap::with_capacity(vertices.len());
    // Adding zero makes -0 to 0, so that equal numbers have equal bits.
    let key = |v: &[f64; 3]| v.map(|x| (x + 0.0).to_bits());
    vertices.iter().enumerate().map(|(i, v)| *first.entry(key(v)).or_insert(i as u32)).collect()
}

/// The triangle left of each directed edge.
type SolidEdges = HashMap<(u32, u32), u32>;

/// Every edge must belong to two triangles that pass it in opposite directions.
fn closed(numbers: &[[u32; 3]], at: &impl Fn(u32) -> Vector3<f64>) -> Result<SolidEdges, MeshError> {
    let mut edges = SolidEdges::with_capacity(3 * numbers.len());
    let ends = |a, b| (at(a).into(), at(b).into());
    for (i, t) in numbers.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if edges.insert((a, b), i as u32).is_some() {
                let (from, to) = ends(a, b);
                return Err(MeshError::Orientation { from, to });
            }
        }
    }
    for t in numbers {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if !edges.contains_key(&(b, a)) {
                let (from, to) = ends(a, b);
                return Err(MeshError::Open { from, to });
            }
        }
    }
    Ok(edges)
}

fn normals(
    numbers: &[[u32; 3]],
    at: &impl Fn(u32) -> Vector3<f64>,
    edges: &SolidEdges,
    sign: f64,
) -> Vec<Triangle> {
    let face = |t: &[u32; 3]| {
        let (ab, ac) = (at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
        let n = if degenerate(&ab, &ac) { Vector3::zeros() } else { ab.cross(&ac).normalize() };
        n * sign
    };
    let faces: Vec<Vector3<f64>> = numbers.iter().map(face).collect();
    let mut around: HashMap<u32, Vector3<f64>> = HashMap::new();
    for (t, n) in numbers.iter().zip(&faces) {
        for k in 0..3 {
            let (u, v) = (at(t[(k + 1) % 3]) - at(t[k]), at(t[(k + 2) % 3]) - at(t[k]));
            *around.entry(t[k]).or_insert_with(Vector3::zeros) += n * u.angle(&v);
        }
    }
    let unit = |n: Vector3<f64>, instead: &Vector3<f64>| n.try_normalize(1e-12).unwrap_or(*instead);
    let build = |(t, n): (&[u32; 3], &Vector3<f64>)| {
        if *n == Vector3::zeros() {
            return None;
        }
        let beside = |k: usize| faces[edges[&(t[(k + 1) % 3], t[k])] as usize];
        let (mut corners, mut edge_normals, mut vertex_normals) = (
            t.map(at),
            std::array::from_fn(|k| unit(n + beside(k), n)),
            std::array::from_fn(|k| unit(around[&t[k]], n)),
        );
        if sign < 0.0 {
            // a, c, b: the edges are then ac, cb, ba.
            corners.swap(1, 2);
            edge_normals = [edge_normals[2], edge_normals[1], edge_normals[0]];
            vertex_normals.swap(1, 2);
        }
        Some(Triangle { corners, normal: *n, edge_normals, vertex_normals })
    };
    numbers.iter().zip(&faces).filter_map(build).collect()
}
