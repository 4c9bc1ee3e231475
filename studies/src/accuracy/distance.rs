//! Distance from a mesh: how many triangles a round obstacle needs, and what a query costs then (chart of triangles).

use std::collections::BTreeMap;
use std::error::Error;

use environment::Mesh;
use nalgebra::Vector3;

use super::{AccuracyInput, Cost, ErrorChart, Part, Point, cost};

pub(super) const PART: Part = charts;

/// \[m\] Radius of the ball.
const RADIUS: f64 = 0.25;
/// Halvings of an octahedron's edges: 32 to 131,072 triangles.
const LEVELS: std::ops::RangeInclusive<usize> = 1..=7;
/// Nodes under both feet of Lola on pads, all of them.
const QUERIES: usize = 288;

fn charts(_: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let mut chart = ErrorChart::new(
        "distance",
        "Triangles of a round obstacle",
        "largest error of the distance [m]",
    )
    .over(Cost::PerCall)
    .about("Ball of 0.25 m radius, 288 points within 5 cm of it; time of one query. Reference: closed form.");
    for level in LEVELS {
        let mesh = ball(level)?;
        let points: Vec<Vector3<f64>> = (0..QUERIES).map(point).collect();
        let (gaps, seconds) = cost::of(|| {
            points.iter().map(|p| mesh.nearest(p).map_or(f64::NAN, |n| n.gap)).collect::<Vec<_>>()
        });
        let error = |(p, gap): (&Vector3<f64>, &f64)| (gap - (p.norm() - RADIUS)).abs();
        chart.add(Point {
            scene: "ball".into(),
            model: "mesh".into(),
            method: "hierarchy".into(),
            solver: Some(format!("{} triangles", mesh.len())),
            cpu_us: Some(seconds * 1e6 / QUERIES as f64),
            error: points.iter().zip(&gaps).map(error).fold(0.0, f64::max),
            ..Point::default()
        });
    }
    Ok(vec![chart])
}

/// Points all around the ball, inside and outside.
fn point(i: usize) -> Vector3<f64> {
    let t = i as f64;
    let direction = Vector3::new((1.7 * t).sin(), (2.3 * t + 0.4).cos(), (0.9 * t + 1.1).sin()).normalize();
    direction * (RADIUS + 0.05 * (3.1 * t).sin())
}

/// An octahedron whose faces were divided in four so many times, corners on the ball.
fn ball(levels: usize) -> Result<Mesh, Box<dyn Error>> {
    let mut corners: Vec<Vector3<f64>> =
        [Vector3::x(), Vector3::y(), Vector3::z()].into_iter().flat_map(|axis| [axis, -axis]).collect();
    let mut faces: Vec<[u32; 3]> =
        vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    for _ in 0..levels {
        let mut middles: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                corners.push((corners[a as usize] + corners[b as usize]).normalize());
                corners.len() as u32 - 1
            })
        };
        let mut finer = Vec::with_capacity(4 * faces.len());
        for &[a, b, c] in &faces {
            let (d, e, f) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
        faces = finer;
    }
    let vertices: Vec<[f64; 3]> = corners.iter().map(|c| (c * RADIUS).into()).collect();
    Ok(Mesh::new(&vertices, &faces)?)
}
