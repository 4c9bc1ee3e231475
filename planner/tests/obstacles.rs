//! Steps over obstacles and onto platforms, fixed distances, with a controller that follows perfectly.

use crate::robot::checks::*;
use crate::robot::{self, Robot, SUPPORT};
use config::Gait;
use messages::command::{DistanceCommand, PlatformCommand, VelocityCommand};
use messages::{Command, Detail, EventCode, GaitState, Plan};
use planner::obstacles::KnownObstacles;

/// Least and greatest x and the height of a bar across the way \[m\].
type Bar = [f64; 3];

const SLOW: Command = Command::Velocity(VelocityCommand { forward: 1.0 / 3.6, left: 0.0, turn: 0.0 });

fn see(bars: &[Bar]) -> KnownObstacles {
    let mut obstacles = KnownObstacles::default();
    for [begin, end, top] in bars {
        let (a, b) = ([*begin, -1.0], [*end, 1.0]);
        let corner = |i: usize, z: f64| {
            [if i & 1 == 0 { a[0] } else { b[0] }, if i & 2 == 0 { a[1] } else { b[1] }, z]
        };
        // Front, back and top: a soup need not be closed.
        let quad = |c: [[f64; 3]; 4]| [[c[0], c[1], c[2]], [c[0], c[2], c[3]]];
        let sides = [
            [corner(0, 0.0), corner(2, 0.0), corner(2, *top), corner(0, *top)],
            [corner(1, 0.0), corner(3, 0.0), corner(3, *top), corner(1, *top)],
            [corner(0, *top), corner(1, *top), corner(3, *top), corner(2, *top)],
        ];
        obstacles.add(sides.into_iter().flat_map(quad));
    }
    obstacles
}

/// Least distance of the soles, walking straight, from a bar, along x or z: negative if one is inside.
fn clearance(plan: &Plan, bar: &Bar) -> f64 {
    let [begin, end, top] = *bar;
    instants(plan, 0.004)
        .flat_map(|t| (0..2).map(move |i| (i, plan.feet[i].sample(t).position)))
        .map(|(i, p)| {
            let x = plan.origin[0] + p[0];
            let (back, front) = (x + SUPPORT[i][0], x + SUPPORT[i][1]);
            let z = plan.height + p[2];
            (begin - front).max(back - end).max(z - top)
        })
        .fold(f64::INFINITY, f64::min)
}

/// What holds for every plan, on level ground or not.
fn check(r: &Robot, gait: &Gait) {
    for p in &r.plans {
        assert!(zmp_margin(p) > -1e-6, "plan {}: {}", p.id, zmp_margin(p));
        if p.step_count > 0 {
            let error = zmp_error(p, gait);
            // Far ahead, where knots are 0.15 s apart, high swings are followed less closely.
            assert!(error < 8e-3, "plan {}: motion misses its zero-moment point by {error} m", p.id);
        }
        assert!(unrest(p, gait) < 1e-9, "plan {} does not end standing", p.id);
    }
    for pair in r.plans.windows(2) {
        let seam = seam(&pair[0], &pair[1]);
        assert!(seam < 1e-9, "plans {} and {} differ by {seam}", pair[0].id, pair[1].id);
    }
}

/// Walks towards bars for some time and stops.
fn walk_at(bars: &[Bar], known: bool) -> Robot {
    let mut r = Robot::new(&robot::gait());
    if known {
        r.planner.see(see(bars));
    }
    r.stand();
    r.step(&[SLOW, Command::Start]);
    r.run(14.0);
    r.step(&[Command::Stop]);
    r.run(8.0);
    assert!(r.time() > r.active.end());
    r
}

/// Where the robot stands: x of its right sole, and of the middle between the soles.
fn place(r: &Robot) -> f64 {
    outer(r.active.origin, [r.state.feet[0][0], 0.0])[0]
}

fn middle(r: &Robot) -> f64 {
    outer(r.active.origin, [0.5 * (r.state.feet[0][0] + r.state.feet[1][0]), 0.0])[0]
}

/// Heights of both soles, and of the centre of gravity.
fn heights(r: &Robot) -> [f64; 3] {
    [r.state.feet[0][2], r.state.feet[1][2], r.state.com[2]].map(|z| r.active.height + z)
}

#[test]
fn bars_are_stepped_over_wherever_they_lie() {
    for k in 0..12 {
        let bar = [1.2 + 0.05 * k as f64, 1.26 + 0.05 * k as f64, 0.1];
        let r = walk_at(&[bar], true);
        assert!(r.events.is_empty(), "{k}: {:?}", r.events);
        check(&r, &robot::gait());
        let least = r.plans.iter().map(|p| clearance(p, &bar)).fold(f64::INFINITY, f64::min);
        assert!(least > 0.005, "{k}: {least} m");
        assert!(place(&r) > bar[1] + 0.2, "{k}: ends at {}", place(&r));
    }
}

/// What the test above sees if nothing is done about it.
#[test]
fn an_unknown_bar_is_stepped_on() {
    let bar = [1.3, 1.36, 0.1];
    let r = walk_at(&[bar], false);
    assert!(r.plans.iter().map(|p| clearance(p, &bar)).fold(f64::INFINITY, f64::min) < -0.02);
}

#[test]
fn two_bars_with_room_between_them_are_stepped_over_and_without_room_are_one() {
    let bars = [[1.3, 1.36, 0.1], [2.0, 2.05, 0.05]];
    let r = walk_at(&bars, true);
    assert!(r.events.is_empty() && place(&r) > 2.3, "{:?}", r.events);
    for bar in &bars {
        assert!(r.plans.iter().all(|p| clearance(p, bar) > 0.005));
    }
    let bars = [[1.3, 1.36, 0.1], [1.6, 1.65, 0.05]];
    let r = walk_at(&bars, true);
    assert_eq!(r.events.len(), 1);
    assert_eq!((r.events[0].1, r.events[0].2), (EventCode::ObstacleTooLong, Detail::Millimetres(350)));
    assert!(place(&r) + SUPPORT[0][1] < 1.3, "stands before them: {}", place(&r));
}

#[test]
fn what_cannot_be_stepped_over_is_stopped_at_and_named() {
    for (bar, code, detail) in [
        ([1.5, 1.56, 0.3], EventCode::ObstacleTooHigh, 300),
        ([1.5, 1.8, 0.1], EventCode::ObstacleTooLong, 300),
    ] {
        let r = walk_at(&[bar], true);
        assert_eq!(
            r.events.iter().map(|e| (e.1, e.2)).collect::<Vec<_>>(),
            [(code, Detail::Millimetres(detail))]
        );
        check(&r, &robot::gait());
        let at = place(&r) + SUPPORT[0][1];
        assert!(at < bar[0] && at > 0.5, "stands before it: toes at {at}");
        assert!(r.plans.iter().all(|p| clearance(p, &bar) > 0.0));
    }
    // In front of the toes it is not even started.
    let r = walk_at(&[[0.1, 0.6, 0.1]], true);
    assert!(r.events.iter().any(|e| e.1 == EventCode::ObstacleTooLong) && place(&r).abs() < 0.02);
}

fn distance(distance: f64, speed: f64) -> Command {
    Command::Distance(DistanceCommand { distance, speed, acceleration: 0.3 })
}

#[test]
fn fixed_distances_end_where_they_should() {
    for (d, speed) in [(0.05, 0.3), (0.37, 0.3), (1.0, 0.5), (3.0, 0.6), (5.21, 0.8), (-0.7, 0.15)] {
        let gait = robot::gait();
        let mut r = Robot::new(&gait);
        r.stand();
        let begin = middle(&r);
        r.step(&[distance(d, speed)]);
        r.run(9.0 + 2.0 * d.abs() / speed);
        assert!(r.time() > r.active.end(), "{d}: stands");
        check(&r, &gait);
        assert!(r.events.is_empty(), "{:?}", r.events);
        let walked = middle(&r) - begin;
        assert!((walked - d).abs() < 1e-9, "{d}: walked {walked}");
    }
}

#[test]
fn skills_wait_for_each_other() {
    let gait = robot::gait();
    let mut r = Robot::new(&gait);
    r.stand();
    r.step(&[distance(1.0, 0.3)]);
    r.run(3.0);
    r.step(&[distance(0.5, 0.3)]);
    r.run(25.0);
    assert!((middle(&r) - 1.5).abs() < 0.02, "both: {}", middle(&r));
    // Normal walking is stopped first.
    r.step(&[SLOW, Command::Start]);
    r.run(5.0);
    r.step(&[distance(-0.2, 0.1)]);
    r.run(20.0);
    assert!(r.time() > r.active.end() && r.events.is_empty());
    let standing = r.plans.iter().filter(|p| p.state == GaitState::Starting as u64).count();
    assert_eq!(standing, 4, "every one from standing");
    check(&r, &gait);
}

fn platform(distance: f64, height: f64) -> Command {
    Command::Platform(PlatformCommand { distance, height })
}

#[test]
fn platforms_are_climbed_on_and_off() {
    for ahead in [0.1, 0.5, 1.3] {
        for height in [0.15, 0.08, -0.1] {
            let gait = robot::gait();
            let mut r = Robot::new(&gait);
            r.stand();
            r.step(&[platform(ahead, height)]);
            r.run(14.0);
            assert!(r.time() > r.active.end());
            check(&r, &gait);
            assert!(r.events.is_empty(), "{:?}", r.events);
            let stands = [height, height, height + gait.model.com_height];
            assert!(heights(&r).iter().zip(stands).all(|(z, h)| (z - h).abs() < 1e-9), "{:?}", heights(&r));
            // No foothold over the edge, whichever way.
            for p in &r.plans {
                for i in 0..2 {
                    let s = p.feet[i].sample(p.end()).position;
                    let (x, z) = (p.origin[0] + s[0] - 0.005, p.height + s[2]);
                    let before = x + SUPPORT[i][1] < ahead && z.abs() < 1e-9;
                    let behind = x + SUPPORT[i][0] > ahead && (z - height).abs() < 1e-9;
                    assert!(before || behind, "{ahead}, {height}: foot {i} ends at {x}, {z}");
                }
            }
            // And back.
            r.step(&[platform(0.6, -height)]);
            r.run(14.0);
            assert!(heights(&r)[0].abs() < 1e-9 && r.events.is_empty(), "{:?}", r.events);
            check(&r, &gait);
        }
    }
}

#[test]
fn a_stop_on_the_way_to_a_platform_stands_before_it_or_on_it() {
    for k in 0..14 {
        let gait = robot::gait();
        let mut r = Robot::new(&gait);
        r.stand();
        r.step(&[platform(1.0, 0.15)]);
        r.run(0.3 + 0.5 * k as f64);
        r.step(&[Command::Stop]);
        r.run(12.0);
        assert!(r.time() > r.active.end());
        let [right, left, _] = heights(&r);
        let soles = [right, left];
        let toes = place(&r) + SUPPORT[0][1];
        let low = toes < 1.0 && soles.iter().all(|z| z.abs() < 1e-9);
        let high = place(&r) + SUPPORT[0][0] > 1.0 && soles.iter().all(|z| (z - 0.15).abs() < 1e-9);
        assert!(low || high, "{k}: toes at {toes}, soles at {soles:?}");
        check(&r, &gait);
    }
}

#[test]
fn what_no_skill_can_do_is_refused_and_named() {
    let gait = robot::gait();
    let mut r = Robot::new(&gait);
    r.step(&[distance(1.0, 0.3)]);
    assert_eq!(r.events.pop().map(|e| e.1), Some(EventCode::CommandRefused), "not before it stands");
    r.stand();
    let before = r.plans.len();
    for (command, code) in [
        (platform(0.5, 0.3), EventCode::ObstacleTooHigh),
        (platform(0.5, f64::NAN), EventCode::ObstacleTooHigh),
        (platform(0.03, 0.1), EventCode::NoFoothold),
        (platform(f64::NAN, 0.1), EventCode::NoFoothold),
        (distance(f64::NAN, 0.3), EventCode::NoFoothold),
    ] {
        r.events.clear();
        r.step(&[command]);
        let codes: Vec<_> = r.events.iter().map(|e| e.1).collect();
        assert_eq!(codes, [code, EventCode::CommandRefused], "{command:?}");
    }
    // Too fast is told with the answer.
    for command in [distance(1.0, 5.0), distance(-1.0, 0.8)] {
        r.events.clear();
        r.step(&[command]);
        assert_eq!(
            r.events.iter().map(|e| e.1).collect::<Vec<_>>(),
            [EventCode::CommandRefused],
            "{command:?}"
        );
    }
    r.run(3.0);
    assert_eq!(r.plans.len(), before);
    // A gait that does not say how stays on level ground.
    let mut r = Robot::new(&Gait { obstacles: None, ..gait });
    r.stand();
    r.step(&[platform(0.5, 0.1)]);
    assert_eq!(r.events[0].1, EventCode::ObstacleTooHigh);
}
