//! A landing is held against the pendulum itself, walked in small steps of time, and against a search on a grid.

use super::*;
use crate::footsteps::StepDemand;
use crate::origin::PlanOrigin;
use crate::skills::{Script, Skill};
use crate::steps::StepParameters;
use crate::walk::Builder;
use config::gait::Reaction;
use config::{Gait, Robot, root};
use curves::Sample;
use messages::{GaitState, LEFT, RIGHT};
use std::f64::consts::FRAC_PI_2;

/// \[1/s\]
const W: f64 = 3.57;

/// Lola's first steps on the spot, the room of her reaction, and a stance sole.
fn walk() -> (PlannedWalk, Reaction, Sole) {
    steps_of(0.0)
}

/// The same with steps of `length` \[m\].
fn steps_of(length: f64) -> (PlannedWalk, Reaction, Sole) {
    let gait = Gait::load(&root(None).join("gaits/lola.toml")).unwrap();
    let robot = Robot::load(&root(None).join("robots/lola")).unwrap();
    let soles = [0, 1].map(|i| Sole::new(robot.feet[i].support));
    let (width, ahead) = (gait.step.width, gait.model.com_forward);
    let from = PlanOrigin {
        frame: PlanarPose::default(),
        height: 0.0,
        stance: RIGHT,
        feet: [PlanarPose::default(), PlanarPose::new(0.0, width, 0.0)],
        heights: [0.0; 2],
        body: Sample::rest([ahead, 0.5 * width, gait.model.com_height]),
        zmp: [ahead, 0.5 * width],
        torso: Sample::rest([FRAC_PI_2, FRAC_PI_2, 0.0]),
        pitch: [Sample::rest([0.0]); 2],
        toes: [Sample::rest([0.0]); 2],
        load_left: 0.5,
        previous: StepParameters::on_the_spot(1.2),
        width,
        early: None,
        inside: None,
    };
    // Out of standing, the left foot first.
    let mut walk = PlannedWalk::new();
    let wish = StepParameters { length, ..StepParameters::on_the_spot(1.2) };
    let demand = StepDemand {
        from: &from,
        state: GaitState::Starting,
        wish,
        share: 1.0,
        skill: Skill::Walk,
        script: Script::NONE,
    };
    Builder::new(&gait, soles).walk(&demand, &mut walk);
    assert_eq!(walk.strides[0].stance, RIGHT);
    (walk, gait.reaction.unwrap(), soles[RIGHT])
}

/// \[m\] Divergent component of the plan at `t` \[s\].
fn planned(walk: &PlannedWalk, t: f64) -> [f64; 2] {
    let c = walk.plan.body.sample(t);
    [0, 1].map(|d| c.position[d] + c.velocity[d] / W)
}

/// \[m\] How far the divergent component is off, relative to the foot, where it lands: Euler steps of 0.1 ms over the
/// zero-moment point of the plan's own motion, which is shifted within the sole as far as it helps.
fn left_over(walk: &PlannedWalk, t: f64, error: [f64; 2], landing: &Landing, sole: &Sole) -> [f64; 2] {
    let s = &walk.strides[0];
    let (now, end) = (planned(walk, t), planned(walk, s.end));
    let growth = (W * (s.end - t)).exp();
    let to = [landing.pose.x - s.landing.x, landing.pose.y - s.landing.y];
    std::array::from_fn(|d| {
        let p = (end[d] - now[d] * growth) / (1.0 - growth);
        let half = [0.5, 0.8][d] * sole.half[d];
        let [low, high] = [sole.center[d] - half, sole.center[d] + half];
        let fall = |p: f64| {
            let (mut xi, steps) = (now[d] + error[d], (landing.rest / 1e-4).round() as usize);
            (0..steps).for_each(|_| xi += 1e-4 * W * (xi - p));
            xi - end[d] - to[d]
        };
        // Linear in p: the best one lies where it vanishes, or at an end.
        let [at_low, at_high] = [fall(low.min(p)), fall(high.max(p))];
        if at_low * at_high <= 0.0 {
            0.0
        } else if at_low.abs() < at_high.abs() {
            at_low
        } else {
            at_high
        }
    })
}

fn swings(place: [f64; 2]) -> SwingFoot {
    SwingFoot { place, loaded: 0.0 }
}

fn adapted(t: f64, error: [f64; 2]) -> (PlannedWalk, Sole, Option<Landing>) {
    let (walk, rules, sole) = walk();
    let foot = walk.plan.feet[LEFT].sample(t).position;
    let body = Divergence { w: W, error };
    let landing = adapt(&rules, &walk, (0, t), &body, &swings([foot[0], foot[1]]), &sole);
    (walk, sole, landing)
}

/// Where it says that the landing catches the body, the pendulum is where the plan wants it over the foot that has landed.
#[test]
fn the_pendulum_is_caught_where_it_is_said_to_be() {
    let (walk, rules, _) = walk();
    let s = walk.strides[0];
    let mut caught = 0;
    for k in 0..200 {
        let share = |n: usize| f64::from((k * n % 97) as u32) / 97.0;
        let t = s.lift + (s.end - s.lift - rules.rest) * share(31);
        let error = [0.3 * (share(17) - 0.5), 0.3 * (share(53) - 0.5)];
        let (walk, sole, Some(landing)) = adapted(t, error) else { continue };
        let off = left_over(&walk, t, error, &landing, &sole);
        if landing.catches {
            caught += 1;
            for d in 0..2 {
                assert!(
                    off[d].abs() < rules.tolerance[d] + 2e-3,
                    "{k}: {error:?} at {t:.3} s leaves {off:?}"
                );
            }
        }
        // Boxes.
        let [near, far] = rules.width;
        assert!(landing.pose.y >= near.min(s.landing.y) - 1e-12 && landing.pose.y <= far + 1e-12);
        // Only over the stance foot, which is the right one, is time to wait.
        let longest = s.end - t + if error[1] < -rules.error { rules.wait } else { 0.0 };
        assert!(landing.rest >= rules.rest - 1e-9 && landing.rest <= longest + 1e-9);
    }
    assert!(caught > 60, "{caught} of 200");
}

/// A push towards the swing foot: it lands farther out and earlier. Over the stance foot: not across it. None: as planned.
#[test]
fn a_foot_lands_where_the_body_falls() {
    let (walk, rules, _) = walk();
    let s = walk.strides[0];
    let t = s.lift + 0.3 * (s.end - s.lift);
    let out = adapted(t, [0.0, 0.08]).2.unwrap();
    assert!(out.pose.y > s.landing.y + 0.02 && out.rest < s.end - t - 0.05, "{out:?}");
    let over = adapted(t, [0.0, -0.2]).2.unwrap();
    assert!(over.pose.y >= rules.width[0] - 1e-12 && over.pose.y < s.landing.y, "{over:?}");
    let ahead = adapted(t, [0.15, 0.0]).2.unwrap();
    let back = adapted(t, [-0.15, 0.0]).2.unwrap();
    assert!(ahead.pose.x > s.landing.x && back.pose.x < s.landing.x, "{ahead:?} {back:?}");
    assert_eq!(adapted(t, [0.0; 2]).2, None);
    assert_eq!(adapted(t, [0.9 * rules.error; 2]).2, None, "that is the stabilizer's");
    assert_eq!(adapted(s.end - 0.5 * rules.rest, [0.3; 2]).2, None, "too late for another foothold");
}

/// While the swing foot still carries, a push ahead or back is answered, by a swing of the shortest time at least, and no farther than
/// its speed allows; one that goes to a side as well is left to both soles.
#[test]
fn a_foot_that_carries_answers_pushes_along_the_way_only() {
    let (walk, rules, sole) = walk();
    let (t, loaded) = (walk.strides[0].lift - 0.1, 0.06);
    let [x, y, ..] = walk.plan.feet[LEFT].sample(t).position;
    let foot = SwingFoot { place: [x, y], loaded };
    for ahead in [-0.3, -0.2, 0.2, 0.3] {
        let answer = |side: f64| {
            adapt(&rules, &walk, (0, t), &Divergence { w: W, error: [ahead, side] }, &foot, &sole)
        };
        let landing = answer(0.0).unwrap();
        assert!(landing.rest >= loaded + rules.swing - 1e-9, "{ahead}: {landing:?}");
        assert!(landing.pose.x.signum() == ahead.signum(), "{ahead}: {landing:?}");
        assert!(
            (landing.pose.x - x).abs() <= rules.speed * (landing.rest - loaded) + 1e-9,
            "{ahead}: {landing:?}"
        );
        assert_eq!((answer(0.2), answer(-0.2)), (None, None));
    }
}

/// A body that lags behind while both feet carry is said to be held by the one behind, as far as a pendulum is whose zero-moment
/// point is that far back until the lift-off, and then within the sole in front; no farther. It is answered all the same: a step is
/// only given the time to become needless.
#[test]
fn the_foot_behind_holds_a_body_that_lags() {
    let (walk, rules, sole) = steps_of(0.3);
    let (k, s) = (1, walk.strides[1]);
    assert!(s.takeoff.x < s.foothold.x - 0.1, "{s:?}");
    for before in [0.05, 0.1, 0.15] {
        let t = s.lift - before;
        let [x, y, ..] = walk.plan.feet[1 - s.stance].sample(t).position;
        let foot = SwingFoot { place: [x, y], loaded: 0.06 };
        let holds = |lag: f64| {
            let body = Divergence { w: W, error: [-lag, 0.0] };
            adapt(&rules, &walk, (k, t), &body, &foot, &sole).is_none_or(|landing| landing.held)
        };
        let most = (1..100).map(|i| 0.005 * f64::from(i)).take_while(|&lag| holds(lag)).last().unwrap();
        // The pendulum, with all that can be done.
        let (now, end) = (planned(&walk, t)[0], planned(&walk, s.end)[0]);
        let growth = (W * (s.end - t)).exp();
        let planned_zmp = (end - now * growth) / (1.0 - growth);
        let heel = s.foothold.x + sole.center[0] - 0.7 * sole.half[0];
        let behind = s.takeoff.x - s.foothold.x;
        let left = |lag: f64| {
            let (mut xi, dt) = (now - lag, 1e-4);
            for i in 0..((s.end - t) / dt).round() as usize {
                let back = if (i as f64) * dt < before { behind } else { 0.0 };
                xi += dt * W * (xi - heel.min(planned_zmp) - back);
            }
            xi - end
        };
        let tolerance = rules.tolerance[0];
        assert!(left(most) > -tolerance - 0.01, "{before} s, {most} m: {}", left(most));
        assert!(left(most + 0.01) < -tolerance, "{before} s, {most} m: {}", left(most + 0.01));
        let body = Divergence { w: W, error: [-most, 0.0] };
        let landing = adapt(&rules, &walk, (k, t), &body, &foot, &sole).unwrap();
        assert!(landing.held && landing.pose.x < s.landing.x, "{before} s, {most} m: {landing:?}");
    }
}

/// A push over the stance foot that its outer edge can just stop: the body comes back late, and the swing waits for it. Walked
/// with the planned time, the same pendulum is not back.
#[test]
fn a_foot_waits_for_a_body_that_comes_back() {
    let (walk, rules, sole) = walk();
    let s = walk.strides[0];
    let mut waited = 0;
    for k in 0..40 {
        let t = s.lift + (0.1 + 0.015 * f64::from(k)) * (s.end - s.lift);
        let error = [0.0, -0.07];
        let Some(landing) = adapted(t, error).2 else { continue };
        let rest = s.end - t;
        if landing.rest < rest + 0.05 {
            continue;
        }
        waited += 1;
        let [_, is] = left_over(&walk, t, error, &landing, &sole);
        let [_, was] = left_over(&walk, t, error, &Landing { rest, ..landing }, &sole);
        assert!(is.abs() < was.abs(), "{k}: waiting leaves {is} m instead of {was}");
        assert!(landing.catches && is.abs() < rules.tolerance[1] + 2e-3, "{k}: {is} m, {landing:?}");
    }
    assert!(waited > 5, "{waited} of 40");
}

/// No landing on a fine grid is better.
#[test]
fn the_search_finds_the_best_landing() {
    let (walk, rules, sole) = walk();
    let s = walk.strides[0];
    for (share, error) in [(0.1, [0.05, 0.06]), (0.5, [-0.1, 0.1]), (0.7, [0.2, -0.12])] {
        let t = s.lift + share * (s.end - s.lift);
        let foot = walk.plan.feet[LEFT].sample(t).position;
        let body = Divergence { w: W, error };
        let found = adapt(&rules, &walk, (0, t), &body, &swings([foot[0], foot[1]]), &sole).unwrap();
        let cost = |landing: &Landing| {
            let off = left_over(&walk, t, error, landing, &sole);
            let moved = [landing.pose.x - s.landing.x, landing.pose.y - s.landing.y];
            let late = s.end - t - landing.rest;
            (0..2).map(|d| moved[d].powi(2) + OFFSET * off[d].powi(2)).sum::<f64>() + HASTE * late * late
        };
        let best = cost(&found);
        // Landings, and times that are shorter than planned: waiting catches none of these errors.
        for k in 0..21 * 21 * 21 {
            let at = |n: i32| f64::from(k / n % 21) / 20.0;
            let reach = rules.speed * (s.end - t);
            let x = foot[0] + reach * (2.0 * at(1) - 1.0);
            let y = rules.width[0] + at(21) * (rules.width[1] - rules.width[0]);
            let shortest = rules.rest.max(rules.swing - (t - s.lift));
            let rest = shortest + at(441) * (s.end - t - shortest);
            let near = |u: f64, foot: f64| (u - foot).abs() <= rules.speed * rest;
            let inside = x >= rules.length[0] && x <= rules.length[1] && near(x, foot[0]) && near(y, foot[1]);
            let pose = PlanarPose { x, y, ..s.landing };
            let other = cost(&Landing { pose, rest, catches: false, held: false });
            assert!(
                !inside || other > best - 1e-4,
                "{x:.3} {y:.3} {rest:.3}: {other} beats {best} of {found:?}"
            );
        }
    }
}

/// Out of standing, the pendulum walks in steps of 0.1 ms over the place of the stance sole that suits it best. Where it is said to
/// be caught, it is at the landing as far ahead of the foot as it would rest, and over it, but for the tolerance; where not, no
/// landing in the room of the reaction, at no time, would be better by more than the search leaves open.
#[test]
fn a_body_that_topples_is_caught_where_it_is_said_to_be() {
    let (_, rules, sole) = walk();
    let (width, ahead, swing) = (0.21, -0.13, 0.64);
    let feet = [PlanarPose::default(), PlanarPose::new(0.0, 0.2, 0.0)];
    // What is left over after landing at `at` after `r` seconds, with the best place for the zero-moment point.
    let left_over = |xi: [f64; 2], at: [f64; 2], r: f64| {
        [0, 1].map(|d| {
            let goal = at[d] + [ahead, 0.0][d];
            let ends = [-1.0, 1.0].map(|side| {
                let p = sole.center[d] + side * 0.8 * sole.half[d];
                let mut x = xi[d];
                (0..(r * 1e4) as usize).for_each(|_| x += 1e-4 * W * (x - p));
                x - goal
            });
            0.0f64.clamp(ends[0].min(ends[1]), ends[0].max(ends[1]))
        })
    };
    let (mut caught, mut lost) = (0, 0);
    for k in 0..60 {
        let xi = [-0.45 + 0.013 * f64::from(k), 0.08 + 0.001 * f64::from(k % 20)];
        let body = Toppling { w: W, xi, ahead };
        let found = step_out(&rules, &body, (RIGHT, &sole), [&feet[0], &feet[1]], (width, swing));
        let enough = |rest: [f64; 2], more: f64| (0..2).all(|d| rest[d].abs() <= rules.tolerance[d] + more);
        let at = [found.pose.x, found.pose.y];
        assert!((rules.swing..=swing).contains(&found.rest), "{k}: {}", found.rest);
        assert!(at[0] >= rules.length[0] && at[0] <= rules.length[1], "{k}: {at:?}");
        assert!(at[1] >= rules.width[0] && at[1] <= rules.width[1], "{k}: {at:?}");
        if found.catches {
            caught += 1;
            assert!(enough(left_over(xi, at, found.rest), 2e-3), "{k}");
        } else {
            lost += 1;
            let any = (0..20 * 20).any(|n| {
                let [u, v] = [n % 20, n / 20].map(|i| f64::from(i) / 19.0);
                let at = [
                    rules.length[0] + u * (rules.length[1] - rules.length[0]),
                    rules.width[0] + v * (rules.width[1] - rules.width[0]),
                ];
                enough(left_over(xi, at, rules.swing), -2e-3)
            });
            assert!(!any, "{k}: {xi:?} could be caught");
        }
    }
    assert!(caught > 15 && lost > 15, "{caught} caught, {lost} lost");
}
