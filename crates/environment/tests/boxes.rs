//! Ground and boxes, against the closed form of the distance to a box.

use environment::{Environment, Hit, Mesh, Object, Pose, REACH, Schedule, Surface};
use proptest::prelude::*;

fn object(name: &str, size: [f64; 3], pose: Pose) -> Object {
    Object::new(name, Mesh::cuboid(size).unwrap(), None, Schedule::fixed(pose))
}

/// A board of 0.4 x 0.3 m, 20 mm thick, lying on the ground.
fn board() -> Environment {
    let pose = Pose::new([0.0, 0.0, 0.01], [0.0; 3]);
    Environment::new(vec![object("board", [0.4, 0.3, 0.02], pose)])
}

#[test]
fn flat_ground_is_the_height() {
    let hit = Environment::flat().query([3.0, -2.0, -0.001]);
    assert_eq!(hit, Hit { gap: -0.001, normal: [0.0, 0.0, 1.0], surface: Surface::Ground });
}

/// Turned by pitch alone it falls along x; roll raises the left.
#[test]
fn tilted_ground_is_the_distance_to_its_plane() {
    let slope = Environment::flat().tilted([0.0, 0.1]);
    let hit = slope.query([2.0, 5.0, -2.0 * 0.1_f64.tan()]);
    assert!(hit.gap.abs() < 1e-15 && hit.surface == Surface::Ground, "{hit:?}");
    assert_eq!(hit.normal, [0.1_f64.sin(), 0.0, 0.1_f64.cos()]);
    let hit = Environment::flat().tilted([0.2, 0.0]).query([7.0, 1.0, 0.2_f64.tan() + 0.01 / 0.2_f64.cos()]);
    assert!((hit.gap - 0.01).abs() < 1e-15 && hit.normal[1] < 0.0, "{hit:?}");
    assert_eq!(Environment::flat().tilted([0.0; 2]).query([1.0; 3]), Environment::flat().query([1.0; 3]));
    // The board lies on the level ground; the slope comes out of it further up.
    let mut board = board().tilted([0.0, -0.2]);
    assert_eq!(board.query([0.19, 0.0, 0.06]).surface, Surface::Ground);
    assert_eq!(board.query([0.0, 0.0, 0.021]).surface, Surface::Object(0));
    assert!(board.advance(1.0, &[false], &[]).is_empty());
}

/// A platform over ground that lies lower: its top, flush with the origin, is a surface to stand on, and beside it is the drop.
#[test]
fn ground_below_the_origin_leaves_a_drop_beside_a_platform() {
    let platform = object("platform", [2.0, 2.0, 0.5], Pose::new([0.0, 0.0, -0.25], [0.0; 3]));
    let environment = Environment::new(vec![platform]).at_height(-0.04);
    for (p, surface, gap) in [
        ([0.5, 0.0, -1e-3], Surface::Object(0), -1e-3),
        ([0.5, 0.0, 2e-3], Surface::Object(0), 2e-3),
        ([1.02, 0.0, -0.041], Surface::Ground, -1e-3),
        ([3.0, 0.0, 0.0], Surface::Ground, 0.04),
    ] {
        let hit = environment.query(p);
        assert_eq!(hit.surface, surface, "{p:?}");
        assert!((hit.gap - gap).abs() < 1e-12 && hit.normal == [0.0, 0.0, 1.0], "{p:?}: {hit:?}");
    }
    let tilted = Environment::flat().at_height(-0.3).tilted([0.0, 0.1]);
    assert!(tilted.query([1.0, 0.0, -0.3 - 0.1_f64.tan()]).gap.abs() < 1e-15);
    assert_eq!(Environment::flat().at_height(0.0).query([1.0; 3]), Environment::flat().query([1.0; 3]));
}

/// Signed distance to a box of half extent `h` at the origin.
fn box_distance(p: [f64; 3], h: [f64; 3]) -> f64 {
    let q: [f64; 3] = std::array::from_fn(|i| p[i].abs() - h[i]);
    let outside = q.iter().map(|x| x.max(0.0).powi(2)).sum::<f64>().sqrt();
    outside + q.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b)).min(0.0)
}

proptest! {
    #[test]
    fn distance_to_a_box(p in prop::array::uniform3(-1.0..1.0f64), h in prop::array::uniform3(0.01..0.6f64)) {
        let mesh = Mesh::cuboid(h.map(|x| 2.0 * x)).unwrap();
        for found in [mesh.nearest(&p.into()).unwrap(), mesh.nearest_by_search(&p.into()).unwrap()] {
            prop_assert!((found.gap - box_distance(p, h)).abs() < 1e-14);
        }
    }

    /// Wherever a box stands and however it is turned, the answer turns with it.
    #[test]
    fn a_turned_box_is_a_box(
        p in prop::array::uniform3(-0.3..0.3f64), at in prop::array::uniform2(-2.0..2.0f64),
        turn in prop::array::uniform3(-3.0..3.0f64),
    ) {
        let pose = Pose::new([at[0], at[1], 5.0], turn);
        let environment = Environment::new(vec![object("box", [0.3, 0.2, 0.1], pose)]);
        let world = pose.rotation * nalgebra::Vector3::from(p) + pose.position;
        let hit = environment.query(world.into());
        let expected = box_distance(p, [0.15, 0.1, 0.05]);
        match hit.surface {
            // Inside, a face one can stand on may win over a nearer one, at most four times as deep.
            Surface::Object(0) if expected < 0.0 => {
                prop_assert!(hit.gap <= expected + 1e-12 && hit.gap >= 4.0 * expected - 1e-12);
            }
            Surface::Object(0) => prop_assert!((hit.gap - expected).abs() < 1e-12),
            Surface::Far => prop_assert!(expected >= hit.gap - 1e-12 && hit.gap > 0.0),
            other => prop_assert!(false, "{other:?}"),
        }
    }
}

#[test]
fn beside_a_board_is_the_ground_and_on_it_the_board() {
    let environment = board();
    for (p, surface, gap) in [
        ([0.19, 0.0, 0.0199], Surface::Object(0), -1e-4),
        ([0.21, 0.0, -1e-4], Surface::Ground, -1e-4),
        ([0.2001, 0.0, -1e-6], Surface::Ground, -1e-6),
        ([0.1, 0.0, 0.0], Surface::Object(0), -0.02), // deep inside: the top, not the ground or the bottom
        ([1.0, 1.0, 0.5], Surface::Ground, 0.5),
    ] {
        let hit = environment.query(p);
        assert_eq!(hit.surface, surface, "{p:?}");
        assert!((hit.gap - gap).abs() < 1e-12, "{p:?}: {hit:?}");
        assert_eq!(hit.normal, [0.0, 0.0, 1.0], "{p:?}");
    }
}

/// A foot sunk 2 mm at the board's edge is lifted, not pushed off; one that struck the side is stopped by it.
#[test]
fn the_edge_of_a_board() {
    let environment = board();
    let sunk = environment.query([0.199, 0.0, 0.018]);
    assert!(sunk.normal == [0.0, 0.0, 1.0] && (sunk.gap + 0.002).abs() < 1e-12, "{sunk:?}");
    let struck = environment.query([0.199, 0.0, 0.010]);
    assert!(struck.normal == [1.0, 0.0, 0.0] && (struck.gap + 0.001).abs() < 1e-12, "{struck:?}");
}

#[test]
fn far_away_the_gap_is_a_lower_bound() {
    let pose = Pose::new([0.0, 0.0, 2.0], [0.0; 3]);
    let environment = Environment::new(vec![object("box", [0.2, 0.2, 0.2], pose)]);
    let hit = environment.query([0.4, 0.0, 2.0]);
    assert_eq!((hit.surface, hit.gap > REACH && hit.gap <= 0.3 + 1e-12), (Surface::Far, true));
}

#[test]
fn no_number_in_no_number_out() {
    for environment in [Environment::flat(), board()] {
        for p in [[f64::NAN, 0.0, 0.0], [0.0, f64::INFINITY, 0.0], [0.0, 0.0, f64::NAN]] {
            let hit = environment.query(p);
            assert!(!hit.gap.is_nan() && hit.normal == [0.0, 0.0, 1.0], "{p:?}: {hit:?}");
        }
    }
}
