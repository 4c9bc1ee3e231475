//! Objects in time: what is planned happens, but never to an object that is touched.

use environment::{Environment, Mesh, Object, ObjectEvent, Pose, Schedule, Surface};

fn at(x: f64) -> Pose {
    Pose::new([x, 0.0, 0.05], [0.0; 3])
}

/// A cube of 0.1 m on the ground.
fn cube(schedule: Schedule) -> Environment {
    let mesh = Mesh::cuboid([0.1; 3]).unwrap();
    Environment::new(vec![Object::new("cube", mesh, None, schedule)])
}

fn on_top(environment: &Environment, x: f64) -> Surface {
    environment.query([x, 0.0, 0.0999]).surface
}

#[test]
fn appears_moves_and_vanishes() {
    let mut environment = cube(Schedule::new(1.0, 5.0, at(0.0), &[(2.0, at(0.0)), (4.0, at(1.0))]));
    assert_eq!(environment.query([0.0, 0.0, 0.05]).surface, Surface::Ground);
    assert_eq!(environment.advance(0.5, &[false], &[]), &[]);
    assert_eq!(environment.advance(1.0, &[false], &[]), &[ObjectEvent::Appeared(0)]);
    assert_eq!(on_top(&environment, 0.0), Surface::Object(0));
    assert_eq!(environment.advance(3.0, &[false], &[]), &[]);
    assert!((environment.objects()[0].pose().position.x - 0.5).abs() < 1e-15);
    assert_eq!((on_top(&environment, 0.0), on_top(&environment, 0.5)), (Surface::Ground, Surface::Object(0)));
    assert_eq!(environment.advance(5.0, &[false], &[]), &[ObjectEvent::Vanished(0)]);
    assert!(!environment.objects()[0].is_present());
}

/// Touched from 2.5 s to 3.5 s: refused once, then one second late, without a jump.
#[test]
fn a_touched_object_waits() {
    let mut environment = cube(Schedule::new(0.0, 5.0, at(0.0), &[(2.0, at(0.0)), (4.0, at(1.0))]));
    let mut events = Vec::new();
    let mut last = 0.0;
    for i in 0..=70 {
        let time = 0.1 * f64::from(i);
        let touched = i > 25 && i <= 35;
        events.extend(environment.advance(time, &[touched], &[]).iter().map(|e| (i, *e)));
        let x = environment.objects()[0].pose().position.x;
        assert!((x - last).abs() < 0.051 && (!touched || x == last), "{time} s: {x} m");
        last = x;
    }
    let (vanished, rest) = events.split_last().unwrap();
    assert_eq!(rest, [(26, ObjectEvent::Refused(0)), (36, ObjectEvent::Resumed(0))]);
    assert!(vanished.1 == ObjectEvent::Vanished(0) && (60..=61).contains(&vanished.0), "{vanished:?}");
}

/// Standing on something that does not change is no reason to refuse anything.
#[test]
fn a_touched_object_that_rests_is_not_refused() {
    let turned = Pose::new([0.0, 0.0, 0.05], [0.1, 0.2, 0.3]);
    let mut environment = cube(Schedule::new(0.0, f64::INFINITY, turned, &[(1.0, turned), (3.0, turned)]));
    for i in 0..40 {
        assert_eq!(environment.advance(0.1 * f64::from(i), &[true], &[]), &[]);
    }
}

#[test]
fn it_does_not_appear_around_a_foot_nor_run_into_it() {
    let node = [[0.0, 0.0, 0.05]];
    let mut environment = cube(Schedule::new(1.0, f64::INFINITY, at(0.0), &[]));
    let mut events = Vec::new();
    for i in 0..=50 {
        let nodes: &[[f64; 3]] = if i < 30 { &node } else { &[] };
        events.extend(environment.advance(0.0625 * f64::from(i), &[false], nodes).iter().map(|e| (i, *e)));
    }
    assert_eq!(
        events,
        [(16, ObjectEvent::Refused(0)), (30, ObjectEvent::Resumed(0)), (30, ObjectEvent::Appeared(0))]
    );

    let mut environment = cube(Schedule::new(0.0, f64::INFINITY, at(-1.0), &[(1.0, at(1.0))]));
    for i in 0..100 {
        environment.advance(0.01 * f64::from(i), &[false], &node);
        assert!(environment.query(node[0]).gap >= 0.0);
    }
    assert!((environment.objects()[0].pose().position.x + 0.06).abs() < 1e-9, "stops before the foot");
}

#[test]
fn time_that_is_no_number_or_runs_back_changes_nothing() {
    let mut environment = cube(Schedule::new(1.0, 5.0, at(0.0), &[]));
    environment.advance(2.0, &[], &[]);
    for time in [f64::NAN, 0.0, -1.0] {
        assert_eq!(environment.advance(time, &[], &[]), &[]);
        assert!(environment.objects()[0].is_present());
    }
}

/// A foot stands in its way: it waits at its distance, a foot that comes nearer does not move it, and it goes on when that is gone.
#[test]
fn who_keeps_clear_waits_for_feet_and_goes_on() {
    let mesh = Mesh::cuboid([0.1; 3]).unwrap();
    let person = Object::new("person", mesh, None, Schedule::new(0.0, 100.0, at(0.0), &[(2.0, at(2.0))]));
    let mut environment = Environment::new(vec![person.keeping_clear(0.5)]);
    let mut seen = Vec::new();
    for i in 0..=400 {
        let foot = match i {
            0..200 => [1.2, 0.0, 0.05],
            200..300 => [0.9, 0.0, 0.05],
            _ => [9.0, 0.0, 0.05],
        };
        environment.advance(0.01 * f64::from(i), &[false], &[foot]);
        seen.push(environment.objects()[0].pose().position.x);
        let delays: Vec<f64> = environment.delays().collect();
        assert!((0.01 * f64::from(i) - delays[0] - seen[i as usize]).abs() < 1e-9);
    }
    // Its face is 0.05 m ahead of its middle.
    assert!((seen[199] - 0.65).abs() < 0.02 && seen[299] == seen[199], "{} {}", seen[199], seen[299]);
    assert!((seen[400] - (seen[299] + 1.0)).abs() < 0.03, "{}", seen[400]);
    // The same place by what is told of it.
    let mut other = environment.clone();
    other.place_at(4.0, &environment.delays().collect::<Vec<_>>());
    assert_eq!(other.objects()[0].pose(), environment.objects()[0].pose());
}

/// One who is nearer already may go away, and not nearer.
#[test]
fn who_keeps_clear_may_go_away() {
    for (way, moves) in [(1.0, true), (-1.0, false)] {
        let mesh = Mesh::cuboid([0.1; 3]).unwrap();
        let person = Object::new("person", mesh, None, Schedule::new(0.0, 9.0, at(0.0), &[(1.0, at(way))]));
        let mut environment = Environment::new(vec![person.keeping_clear(0.5)]);
        environment.advance(0.5, &[false], &[[-0.3, 0.0, 0.05]]);
        assert_eq!(environment.objects()[0].pose().position.x != 0.0, moves, "{way}");
    }
}
