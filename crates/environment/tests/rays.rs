//! Rays against the same way found by walking: in steps as long as nothing can be nearer.

use environment::{Environment, Mesh, Object, Pose, Schedule};
use nalgebra::Vector3;
use proptest::prelude::*;

type V = Vector3<f64>;

/// \[m\] What counts as met, and as far as rays go.
const MET: f64 = 1e-7;
const FAR: f64 = 8.0;

/// A box and a tetrahedron over the ground.
fn world(places: [[f64; 3]; 2], turns: [[f64; 3]; 2]) -> Environment {
    let cuboid = Mesh::cuboid([0.6, 0.4, 0.9]).unwrap();
    let corners = [[0.0, 0.0, 0.0], [0.7, 0.0, 0.0], [0.0, 0.8, 0.1], [0.1, 0.1, 0.9]];
    let tetrahedron = Mesh::new(&corners, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
    let meshes = [cuboid, tetrahedron].into_iter().zip(places.into_iter().zip(turns));
    let object = |(mesh, (place, turn))| Object::new("", mesh, None, Schedule::fixed(Pose::new(place, turn)));
    Environment::new(meshes.map(object).collect())
}

/// Distance of the nearest surface from `p`; of solids that are pierced, inside as well.
fn gap(environment: &Environment, p: V) -> f64 {
    let of = |object: &Object| {
        let local = object.pose().rotation.inverse() * (p - object.pose().position);
        object.mesh().nearest(&local).unwrap().gap.abs()
    };
    environment.objects().iter().map(of).fold(p.z.abs(), f64::min)
}

fn walked(environment: &Environment, from: V, along: V) -> f64 {
    let mut way = 0.0;
    for _ in 0..100_000 {
        let free = gap(environment, from + along * way);
        if free < MET || way > FAR {
            break;
        }
        way += free;
    }
    way
}

proptest! {
    #[test]
    fn a_ray_gets_as_far_as_who_walks_along_it(
        places in prop::array::uniform2(prop::array::uniform3(-1.0..1.0)),
        turns in prop::array::uniform2(prop::array::uniform3(-3.0..3.0)),
        from in (-3.0..3.0, -3.0..3.0, 0.05..2.0),
        to in (-2.0..2.0, -2.0..2.0, -1.0..2.0),
    ) {
        let environment = world(places, turns);
        let (from, to) = (V::new(from.0, from.1, from.2), V::new(to.0, to.1, to.2));
        prop_assume!((to - from).norm() > 0.1);
        let along = (to - from).normalize();
        let way = walked(&environment, from, along);
        match environment.ray(&from, &along, FAR) {
            // A ray that grazes a surface is met by who walks where he comes near it.
            Some(found) => prop_assert!(way <= found + MET && (found - way < 1e-3 || gap(&environment, from + along * way) < MET), "{found} {way}"),
            None => prop_assert!(way > FAR || gap(&environment, from + along * way) < MET, "{way}"),
        }
        // And where it ends is a surface.
        if let Some(found) = environment.ray(&from, &along, FAR) {
            prop_assert!(gap(&environment, from + along * found) < 1e-9);
            prop_assert_eq!(environment.ray(&from, &along, found), None, "not nearer than this");
        }
    }
}

#[test]
fn rays_along_faces_and_axes_and_from_inside() {
    let environment = Environment::new(vec![Object::new(
        "",
        Mesh::cuboid([1.0; 3]).unwrap(),
        None,
        Schedule::fixed(Pose::new([2.0, 0.0, 0.5], [0.0; 3])),
    )]);
    let ray = |from: [f64; 3], along: [f64; 3]| environment.ray(&V::from(from), &V::from(along), FAR);
    assert_eq!(ray([0.0, 0.0, 0.5], [1.0, 0.0, 0.0]), Some(1.5));
    assert_eq!(ray([2.0, 0.0, 0.5], [1.0, 0.0, 0.0]), Some(0.5), "from inside");
    assert_eq!(ray([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]), Some(1.0), "the ground");
    assert_eq!(ray([0.0, 0.0, 1.0], [1.0, 0.0, 0.0]), Some(1.5), "along the upper face: its edge");
    assert_eq!(ray([0.0, 0.0, 1.0 + 1e-9], [1.0, 0.0, 0.0]), None, "above it");
    assert_eq!(ray([0.0, 0.5, 0.5], [1.0, 0.0, 0.0]), Some(1.5), "through an edge");
    assert_eq!(ray([4.0, 0.0, 0.5], [1.0, 0.0, 0.0]), None, "behind");
    assert_eq!(ray([0.0, 0.0, 0.5], [f64::NAN; 3]), None);
    let tilted = Environment::flat().tilted([0.0, 0.1]);
    let down = tilted.ray(&V::new(1.0, 0.0, 1.0), &-V::z(), FAR).unwrap();
    assert!((down - (1.0 + 0.1_f64.tan())).abs() < 1e-12, "{down}");
}
