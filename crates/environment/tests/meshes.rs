//! Distances to meshes: closed forms, gradients, the hierarchy against looking at every triangle.

use std::collections::HashMap;
use std::path::Path;

use environment::{Environment, Mesh, Object, Pose, Schedule, Surface};
use nalgebra::Vector3;
use proptest::prelude::*;

/// The unit sphere: an octahedron whose triangles are divided `levels` times.
fn sphere(levels: usize) -> Mesh {
    let mut vertices: Vec<[f64; 3]> =
        vec![[1., 0., 0.], [-1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [0., 0., 1.], [0., 0., -1.]];
    let mut triangles: Vec<[u32; 3]> =
        vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    for _ in 0..levels {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let sum: Vector3<f64> =
                    Vector3::from(vertices[a as usize]) + Vector3::from(vertices[b as usize]);
                vertices.push(sum.normalize().into());
                vertices.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (d, e, f) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
            })
            .collect();
    }
    Mesh::new(&vertices, &triangles).unwrap()
}

fn shipped(name: &str) -> Mesh {
    Mesh::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/objects").join(name), 1.0).unwrap()
}

/// Each division halves the largest triangles as seen in a plane from the centre, tan rho = sqrt(2) / 2^levels at their
/// corners; so the surface lies at most 1 - cos rho = 3.9 mm inside the sphere.
#[test]
fn a_sphere() {
    let mesh = sphere(4);
    assert_eq!(mesh.len(), 2048);
    let deepest = 1.0 - (2f64.sqrt() / 16.0).atan().cos();
    for i in 0..2000 {
        let p = [11, 7, 5].map(|k| f64::from(i * k % 101) / 50.0 - 1.0);
        let p = Vector3::from(p);
        let gap = mesh.nearest(&p).unwrap().gap;
        let round = p.norm() - 1.0;
        assert!((-1e-12..deepest + 1e-12).contains(&(gap - round)), "{p:?}: {gap} {round}");
    }
}

/// An acute ridge, 6 degrees: beside it the normal of one face alone calls points inside that are not.
#[test]
fn beside_an_acute_edge_is_outside() {
    let (vertices, triangles) = (
        [[0., -1., 0.], [0., 1., 0.], [-1., -1., 0.05], [-1., 1., 0.05], [-1., -1., -0.05], [-1., 1., -0.05]],
        [[0, 1, 3], [0, 3, 2], [1, 0, 4], [1, 4, 5], [2, 3, 5], [2, 5, 4], [0, 2, 4], [1, 5, 3]],
    );
    let mesh = Mesh::new(&vertices, &triangles).unwrap();
    for degrees in [-85.0f64, -45.0, 0.0, 45.0, 85.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let found = mesh.nearest(&Vector3::new(0.01 * cos, 0.3, 0.01 * sin)).unwrap();
        assert!((found.gap - 0.01).abs() < 1e-15, "{degrees}: {found:?}");
        assert!((found.normal - Vector3::new(cos, 0.0, sin)).norm() < 1e-12);
    }
}

/// Above the diagonal that divides a flat face in two triangles, the normal is that of the face, bit for bit.
#[test]
fn an_edge_within_a_plane_is_no_edge() {
    let mesh = Mesh::cuboid([0.4, 0.6, 0.02]).unwrap();
    for i in -49..50 {
        let (x, y) = (0.004 * f64::from(i), 0.006 * f64::from(i));
        for p in [Vector3::new(x, y, 0.0101), Vector3::new(x, -y, 0.0101)] {
            let found = mesh.nearest(&p).unwrap();
            assert_eq!(found.normal, Vector3::z(), "{p:?}: {found:?}");
        }
    }
}

proptest! {
    #[test]
    fn the_hierarchy_misses_nothing(p in prop::array::uniform3(-1.5..1.5f64)) {
        for mesh in [sphere(2), shipped("stairs.obj"), shipped("uneven.obj")] {
            let (a, b) = (mesh.nearest(&p.into()).unwrap(), mesh.nearest_by_search(&p.into()).unwrap());
            prop_assert!((a.gap.abs() - b.gap.abs()).abs() < 1e-15 && a.gap.signum() == b.gap.signum(), "{a:?} {b:?}");
        }
    }

    /// The normal is the gradient of the distance, of length 1, except where two surfaces are as near.
    #[test]
    fn normals_are_gradients(p in prop::array::uniform3(-1.5..1.5f64)) {
        for mesh in [sphere(1), shipped("stairs.obj")] {
            let h = 1e-5;
            let p = Vector3::from(p);
            let found = mesh.nearest(&p).unwrap();
            let ends: Vec<[_; 2]> = (0..3)
                .map(|k| [h, -h].map(|d| mesh.nearest(&(p + Vector3::ith(k, d))).unwrap()))
                .collect();
            let one_place = ends.iter().flatten().all(|e| (e.point - found.point).norm() < 3.0 * h);
            prop_assume!(one_place && found.gap.abs() > 1e-2);
            let gradient = Vector3::from_fn(|k, _| (ends[k][0].gap - ends[k][1].gap) / (2.0 * h));
            prop_assert!((found.normal.norm() - 1.0).abs() < 1e-14);
            prop_assert!((gradient - found.normal).norm() < 1e-3, "{gradient:?} {found:?}");
        }
    }
}

/// Stairs: each tread is found at its height, a toe against a riser is held back, the joint of two treads is one floor.
#[test]
fn stairs() {
    let object = Object::new("stairs", shipped("stairs.obj"), Some(0.4), Schedule::fixed(Pose::identity()));
    let environment = Environment::new(vec![object]);
    for (x, z) in [(0.15, 0.1), (0.45, 0.2), (0.9, 0.3)] {
        let hit = environment.query([x, 0.1, z - 1e-4]);
        assert_eq!((hit.surface, hit.normal), (Surface::Object(0), [0.0, 0.0, 1.0]));
        assert!((hit.gap + 1e-4).abs() < 1e-15);
        assert_eq!(environment.friction(hit.surface), Some(0.4));
    }
    let toe = environment.query([0.3 + 1e-4, 0.0, 0.15]);
    assert_eq!(toe.normal, [-1.0, 0.0, 0.0]);
    assert!((toe.gap + 1e-4).abs() < 1e-15);
    let before = environment.query([-0.05, 0.0, 1e-5]);
    assert_eq!((before.surface, environment.friction(before.surface)), (Surface::Ground, None));
}

/// Uneven ground: a point below any grid point of the mesh finds the hill above it, and its normal is nearly upright.
#[test]
fn hills() {
    let mesh = shipped("uneven.obj");
    assert!(mesh.bounds().hi.z <= 0.015 && mesh.bounds().lo.z == -0.02);
    let object = Object::new("hills", mesh, None, Schedule::fixed(Pose::identity()));
    let environment = Environment::new(vec![object]);
    for i in 1..20 {
        let hit = environment.query([0.1 * f64::from(i) - 0.03, 0.21, 0.0005]);
        assert_eq!(hit.surface, Surface::Object(0), "{i}: {hit:?}");
        assert!(hit.normal[2] > 0.95, "{hit:?}");
    }
}
