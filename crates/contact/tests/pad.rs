//! A pad on a segment: statics, relaxation, force and moment, sticking and sliding, an edge, bad data.

use crate::sole::{ALPHA, Sole};
use contact::point::PointState;
use contact::{CouplingMethod, Ground, SegmentMotion, Settings};
use nalgebra::Vector3;

fn sharp(friction: f64) -> Settings {
    Settings { tolerance: 1e-9, sweeps: 100_000, ..Settings::of_friction(friction) }
}

/// The free layer relaxes as exp(-t/alpha), every shape of it.
#[test]
fn a_free_layer_relaxes_with_alpha() {
    let mut sole = Sole::new(0.3);
    let start: Vec<f64> = (0..sole.d.len()).map(|k| 1e-3 * (k as f64).sin()).collect();
    sole.d.clone_from(&start);
    let outcome = sole.rates(1.0, &SegmentMotion::default(), &sharp(0.7));
    assert_eq!((outcome.force, outcome.moment), (Vector3::zeros(), Vector3::zeros()));
    assert!(sole.dd.iter().zip(&start).all(|(dd, d)| *dd == -d / ALPHA));
}

/// F1: explicit Euler on the free layer decays below h = 2 alpha and grows above, within 0.1 %.
#[test]
fn explicit_euler_ends_at_two_alpha() {
    let grows = |h: f64| {
        let mut sole = Sole::new(0.3);
        sole.d.fill(1e-3);
        for _ in 0..20_000 {
            sole.step_on(h, &|_| None, &SegmentMotion::default(), &sharp(0.7));
        }
        sole.d.iter().any(|d| d.abs() > 1e-3)
    };
    assert!(!grows(2.0 * ALPHA * 0.999) && grows(2.0 * ALPHA * 1.001));
}

/// Pressed flat on the ground by a way that stands still, the pad carries its block stiffness times the way.
#[test]
fn a_pressed_pad_carries_its_stiffness() {
    for method in [CouplingMethod::GaussSeidel, CouplingMethod::Velocity] {
        let mut sole = Sole::new(0.3);
        let (way, h) = (1e-3, 1e-3);
        for _ in 0..300 {
            sole.step(h, -way, &SegmentMotion::default(), &Settings { method, ..sharp(2.0) });
        }
        let outcome = sole.rates(-way, &SegmentMotion::default(), &Settings { method, ..sharp(2.0) });
        let want = sole.pad.layer().block_stiffness(2) * way;
        assert!(outcome.report.converged && outcome.report.unique);
        assert!(
            (outcome.force.z / want - 1.0).abs() < 1e-6,
            "{method:?}: {} N, not {want} N",
            outcome.force.z
        );
        // The pad stands 0.1 m ahead and 0.05 m to the left: T = r x F, with the moment arm of its middle.
        let at = Vector3::new(0.1, 0.05, 0.0);
        assert!((outcome.moment.xy() - at.cross(&outcome.force).xy()).norm() < 1e-9 * want);
        assert!(outcome.force.xy().norm() < 1e-9 * want);
    }
}

/// Power that goes into the layer is power that leaves it: f.(d' + d/alpha) is the dissipation and more, so
/// f.d' = d'.B d' + d'.K d, with the segment's power -F.v - T.omega as the third term where nothing slides.
#[test]
fn power_of_the_segment_is_that_of_the_layer() {
    let mut sole = Sole::new(0.45);
    for k in 0..60 {
        let twist =
            SegmentMotion { linear: Vector3::new(0.01, 0.0, -0.02), angular: Vector3::new(0.02, 0.1, -0.05) };
        let gap = -2e-5 * f64::from(k);
        let settings = Settings { recovery: 0.0, ..sharp(5.0) };
        let outcome = sole.rates(gap, &twist, &settings);
        let power = outcome.force.dot(&twist.linear) + outcome.moment.dot(&twist.angular);
        let d = nalgebra::DVector::from_column_slice(&sole.d);
        let dd = nalgebra::DVector::from_column_slice(&sole.dd);
        let stored = (dd.transpose() * sole.pad.layer().stiffness() * &d)[0];
        let lost = ALPHA * (dd.transpose() * sole.pad.layer().stiffness() * &dd)[0];
        let slides = sole.memory.states().contains(&PointState::Slip);
        let scale = stored.abs() + lost + power.abs();
        if !slides {
            assert!((power + stored + lost).abs() < 1e-9 * scale, "{k}: {power} {stored} {lost} W");
        } else {
            assert!(power + stored + lost <= 1e-9 * scale, "{k}: friction gives {} W", power + stored + lost);
        }
        sole.step(1e-3, gap, &twist, &settings);
    }
}

/// F11: a pad that slides along any direction is held back by exactly mu times its load against the sliding, node by
/// node: the cone is round.
#[test]
fn the_cone_is_round() {
    for degrees in (0..=45).step_by(5) {
        let angle = f64::from(degrees).to_radians();
        let direction = Vector3::new(angle.cos(), angle.sin(), 0.0);
        for method in [CouplingMethod::GaussSeidel, CouplingMethod::Velocity] {
            let settings = Settings { method, tolerance: 1e-12, ..sharp(0.4) };
            let mut sole = Sole::new(0.3);
            let twist = SegmentMotion { linear: direction * 0.2, angular: Vector3::zeros() };
            for _ in 0..300 {
                sole.step(1e-3, -5e-4, &twist, &settings);
            }
            let outcome = sole.rates(-5e-4, &twist, &settings);
            assert!(outcome.report.converged, "{:?}", outcome.report);
            assert!(sole.memory.states().iter().all(|s| *s == PointState::Slip || *s == PointState::Open));
            let want = -0.4 * outcome.force.z * direction;
            let error = (outcome.force - Vector3::z() * outcome.force.z - want).norm() / want.norm();
            assert!(error < 1e-9, "{degrees} deg, {method:?}: {error:e}");
        }
    }
}

/// A pad pushed sideways more and more sticks without creep until the first node gives way, and slides as a whole when
/// the force reaches mu N; backwards it is the same.
#[test]
fn sticking_goes_over_to_sliding_at_the_friction_limit() {
    let (mu, way) = (0.5, 1e-3);
    let mut sole = Sole::new(0.3);
    for _ in 0..300 {
        sole.step(1e-3, -way, &SegmentMotion::default(), &sharp(mu));
    }
    let slow = SegmentMotion { linear: Vector3::new(1e-3, 0.0, 0.0), angular: Vector3::zeros() };
    let (mut all_stick, mut all_slip) = (0, 0);
    for k in 0..8000 {
        let outcome = sole.step(1e-3, -way, &slow, &sharp(mu));
        assert!(outcome.report.converged);
        let load = mu * outcome.force.z;
        assert!(-outcome.force.x <= load * (1.0 + 1e-12));
        if sole.memory.states().iter().all(|s| *s == PointState::Stick) {
            all_stick += 1;
            let creep = (0..36).map(|i| (slow.linear.x + sole.dd[3 * i]).abs()).fold(0.0, f64::max);
            assert!(creep < 1e-15, "creeps with {creep:e} m/s");
        }
        if sole.memory.states().iter().all(|s| *s == PointState::Slip) {
            all_slip += 1;
            // Sideways nodes let go of their displacement over a way of sliding mu p/k_T, here 0.5 mm or 0.5 s: after 7 s
            // e^-14 of it is left, and all pull the same way.
            assert!(
                k < 7000 || (-outcome.force.x / load - 1.0).abs() < 1e-6,
                "{} of {load} N",
                outcome.force.x
            );
        }
    }
    assert!(all_slip > 1000, "{all_stick} steps of sticking, {all_slip} of sliding");
}

/// On the edge of a board only the nodes above it carry; the moment shows where they are.
#[test]
fn an_edge_carries_where_it_is() {
    for method in [CouplingMethod::GaussSeidel, CouplingMethod::Velocity, CouplingMethod::Fastest] {
        let settings = Settings { method, ..sharp(0.7) };
        let mut sole = Sole::new(0.45);
        let edge = |x: f64| (x > 0.1).then_some(Ground { gap: -1e-3, normal: Vector3::z() });
        for _ in 0..200 {
            sole.step_on(1e-3, &edge, &SegmentMotion::default(), &settings);
        }
        let outcome = sole.step_on(1e-3, &edge, &SegmentMotion::default(), &settings);
        assert!(outcome.report.converged, "{method:?}: {:?}", outcome.report);
        for (i, f) in sole.memory.forces().iter().enumerate() {
            let on = sole.pad.place(i).x > 0.1;
            assert!(on || *f == Vector3::zeros(), "node {i} carries {f} beside the board");
        }
        let centre = -outcome.moment.y / outcome.force.z;
        assert!(outcome.force.z > 20.0 && (0.1..0.13).contains(&centre), "{outcome:?}");
    }
}

/// Two bricks in height: with the rates found, B d' + K d (2.37), multiplied out, is zero at every node inside and the
/// force of the ground on the sole, within the cone.
#[test]
fn nodes_inside_of_a_high_pad_carry_no_force() {
    for bricks in [[3, 2, 2], [2, 2, 3]] {
        let mut sole = Sole::of_bricks(0.4, bricks);
        sole.d.iter_mut().zip(1..).for_each(|(d, k)| *d = 3e-4 * f64::from(k).sin());
        let twist = SegmentMotion {
            linear: Vector3::new(0.05, -0.02, -0.04),
            angular: Vector3::new(0.1, -0.2, 0.05),
        };
        let outcome = sole.rates(-2e-4, &twist, &sharp(0.6));
        assert!(outcome.report.converged && outcome.force.z > 1.0, "{outcome:?}");
        let layer = sole.pad.layer();
        let sum: Vec<f64> = sole.d.iter().zip(&sole.dd).map(|(d, dd)| d + ALPHA * dd).collect();
        let f = layer.stiffness() * nalgebra::DVector::from_vec(sum);
        let (at_sole, inside) = f.as_slice().split_at(3 * layer.contacts());
        assert!(!inside.is_empty() && inside.iter().all(|f| f.abs() < 1e-8), "{inside:?}");
        let mut total = Vector3::zeros();
        for f in at_sole.chunks_exact(3) {
            assert!(f[2] > -1e-6 && f[0].hypot(f[1]) < 0.6 * f[2] + 1e-6, "{f:?}");
            total += Vector3::from_column_slice(f);
        }
        assert!((total - outcome.force).norm() < 1e-8, "{total} and {}", outcome.force);
    }
}

/// Nothing that is not a number comes out, and the report says that it went in.
#[test]
fn bad_data_are_told() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for place in 0..4 {
            let mut sole = Sole::new(0.3);
            let mut twist = SegmentMotion { linear: Vector3::new(0.0, 0.0, -0.1), angular: Vector3::zeros() };
            let mut ground = Ground { gap: -1e-3, normal: Vector3::z() };
            match place {
                0 => sole.d[5] = bad,
                1 => twist.angular.y = bad,
                2 => ground.gap = bad,
                _ => ground.normal.x = bad,
            }
            let outcome = sole.step_on(0.0, &|_| Some(ground), &twist, &sharp(0.7));
            assert!(outcome.force.iter().chain(outcome.moment.iter()).chain(&sole.dd).all(|x| x.is_finite()));
            assert!(!outcome.report.converged, "{bad} at {place}");
            // And the next call, with good data, is none the worse.
            sole.d.fill(0.0);
            let outcome = sole.rates(-1e-3, &SegmentMotion::default(), &sharp(0.7));
            assert!(outcome.report.converged && outcome.force.z > 0.0);
        }
    }
}
