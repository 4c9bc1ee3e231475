//! Vectors of the errata (section 4), contact without slip, and smoothness; lengths there are in cm.

use super::*;
use crate::origin::PlanOrigin;
use crate::pose::PlanarPose;
use crate::sole::Sole;
use crate::steps::{Heights, StepParameters, Stride};
use messages::{LEFT, RIGHT};

/// Foot of thesis 4.3 \[m\].
const ANKLE: f64 = 0.056;
const EDGES: [f64; 2] = [-0.065, 0.125];

/// Parameters of thesis 6.2.
fn static_walk() -> Pattern {
    let gait = config::Gait::load(&config::root(None).join("gaits/archie_static.toml")).unwrap();
    gait.pattern.unwrap()
}

/// Parameters of thesis 4.3.
fn example() -> Pattern {
    Pattern {
        step_time: 2.0,
        double_support: 0.4,
        over_time: 1.2,
        low_time: 0.08,
        high_time: 1.2,
        pitch_times: [0.08, 1.9, 2.28],
        length: 0.2,
        over_length: 0.2,
        leave: 0.2,
        land: 0.3,
        end_ahead: 0.07,
        start_behind: 0.07,
        start_height: 0.542,
        ..static_walk()
    }
}

/// A walk of five equal steps, in whose third and fourth the pattern is periodic, and where that begins.
struct Walk {
    plan: Box<Plan>,
    /// \[s\] Begin of the third step.
    begin: f64,
    /// Foothold that the right foot leaves then: origin of the thesis's frame.
    at: PlanarPose,
}

impl Walk {
    fn new(pattern: Pattern) -> Self {
        let Pattern { step_time, double_support, length, width, .. } = pattern;
        let gait = config::Gait::load(&config::root(None).join("gaits/archie_static.toml")).unwrap();
        let sole = Sole::new([EDGES[0], EDGES[1], -0.03, 0.03]);
        let mut model = WalkingModel::new(&gait, [sole; 2]);
        model.model.com_forward = sole.center[0];
        let stride = |k: usize| {
            let stance = if k.is_multiple_of(2) { LEFT } else { RIGHT };
            let place = |k: f64, foot: usize| {
                PlanarPose::new(k * length, if foot == LEFT { width } else { 0.0 }, 0.0)
            };
            let begin = k as f64 * step_time;
            Stride {
                parameters: StepParameters { length, side: 0.0, turn: 0.0, duration: step_time },
                stance,
                width,
                begin,
                lift: begin + double_support,
                end: begin + step_time,
                end_cycle: 0,
                foothold: place(k as f64, stance),
                takeoff: place(k as f64 - 1.0, 1 - stance),
                landing: place(k as f64 + 1.0, 1 - stance),
                heights: Heights::default(),
            }
        };
        let strides: [Stride; 5] = std::array::from_fn(stride);
        let from = PlanOrigin {
            frame: PlanarPose::default(),
            height: 0.0,
            stance: LEFT,
            feet: [strides[0].takeoff, strides[0].foothold],
            heights: [0.0; 2],
            body: Sample::rest([-0.1, 0.0, pattern.heights[0]]),
            zmp: [0.0; 2],
            torso: Sample::rest([std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2, 0.0]),
            pitch: [Sample::rest([0.0]); 2],
            toes: [Sample::rest([0.0]); 2],
            load_left: 0.5,
            previous: strides[0].parameters,
            width,
            early: None,
            inside: None,
        };
        let end = 5.0 * step_time + double_support;
        let horizon = Horizon { from: &from, state: GaitState::Walking, strides: &strides, head: 0, end };
        let mut plan = Box::new(<Plan as messages::Record>::empty());
        plan.step_count = 5;
        for (to, s) in plan.steps.iter_mut().zip(&strides) {
            *to = messages::Step { stance: s.stance as u64, begin: s.begin, lift: s.lift, end: s.end, ..*to };
        }
        let of = PatternTrajectories::new(&pattern, &archie());
        of.lay(&model, &horizon, &mut plan);
        Self { plan, begin: strides[2].begin, at: strides[2].takeoff }
    }

    /// Torso at `t` \[s\] of the pattern, in its frame.
    fn torso(&self, t: f64) -> Sample<3> {
        let mut body = self.plan.body.sample(self.begin + t);
        body.position[0] -= self.at.x;
        body
    }

    /// Ankle of a foot and its pitch.
    fn ankle(&self, foot: usize, t: f64) -> [f64; 4] {
        let (sole, pitch) = self.plan.sole(foot, self.begin + t, EDGES);
        let ([x, y, z, _], [angle]) = (sole.position, pitch.position);
        let (s, c) = angle.sin_cos();
        [x - self.at.x + ANKLE * s, y, z + ANKLE * c, angle]
    }
}

/// Values of the errata, printed with twelve digits \[cm\], against ours \[m\].
#[track_caller]
fn near(is: &[f64], printed: &[f64]) {
    for (i, (is, printed)) in is.iter().zip(printed).enumerate() {
        assert!((100.0 * is - printed).abs() < 2e-10, "component {i}: {} is {printed}", 100.0 * is);
    }
}

/// V9, V9b, V9c.
#[test]
fn the_torso_of_the_static_walk() {
    let walk = Walk::new(static_walk());
    for (t, x, y) in [
        (0.0, 6.5, -2.0),
        (1.2, 9.0703125, 0.173828125),
        (2.4, 17.5, 8.5),
        (3.6, 25.9296875, 16.826171875),
        (4.8, 28.5, 19.0),
        (6.0, 29.0, 19.0),
        (14.4, 42.5, 8.5),
    ] {
        near(&walk.torso(t).position[..2], &[x, y]);
    }
    near(&[walk.torso(7.0).velocity[0]], &[0.416666666667]);
    for (t, z) in [(0.0, 54.198971042757), (0.96, 54.0), (4.8, 55.590662887628), (10.0, 56.290401136208)] {
        near(&[walk.torso(t).position[2]], &[z]);
    }
    let walk = Walk::new(Pattern { height: TorsoHeight::Spline, start_height: 0.542, ..static_walk() });
    for (t, z) in
        [(1.2, 54.016538130382), (2.4, 54.409385126241), (4.8, 56.010115939194), (10.0, 55.794533001890)]
    {
        near(&[walk.torso(t).position[2]], &[z]);
    }
}

/// V8, and the quintic beside it.
#[test]
fn the_torso_of_the_example_forward() {
    let spline = Walk::new(Pattern { forward: TorsoForward::Spline, ..example() });
    for (t, x) in [(0.1, 8.453125), (0.4, 13.0), (0.8, 17.25), (1.2, 20.0), (1.6, 22.75), (2.0, 27.0)] {
        near(&[spline.torso(t).position[0]], &[x]);
    }
    for (t, v) in [(0.1, 15.15625), (0.4, 13.75), (0.8, 8.125), (1.2, 6.25), (2.0, 13.75)] {
        near(&[spline.torso(t).velocity[0]], &[v]);
    }
    // Printed as linear where the spline would overshoot: never backwards.
    let linear = Walk::new(Pattern { end_ahead: 0.03, start_behind: 0.02, ..example() });
    let backwards = (0..4000).filter(|&i| linear.torso(f64::from(i) * 1e-3).velocity[0] < 0.0).count();
    assert_eq!(backwards, 0);
    let spline = Walk::new(Pattern {
        end_ahead: 0.03,
        start_behind: 0.02,
        forward: TorsoForward::Spline,
        ..example()
    });
    let ahead = (400..2000).map(|i| 100.0 * spline.torso(f64::from(i) * 1e-3).position[0]);
    let (least, most) = ahead.fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
    assert!((least - 17.624).abs() < 1e-3 && (most - 23.376).abs() < 1e-3, "{least} {most}");
}

/// V10 and V11.
#[test]
fn the_right_foot_of_both() {
    let walk = Walk::new(static_walk());
    for (t, at) in [
        (5.5, [0.331846684004, -0.125591206561, 5.760756744399]),
        (6.6, [4.6875, -1.5625, 7.6]),
        (10.0, [43.808108520043, -2.000457247371, 8.160585276635]),
    ] {
        near(&walk.ankle(RIGHT, t)[..3], &at);
    }
    let walk = Walk::new(example());
    for (t, at, pitch) in [
        (0.2, [0.327006825144, 0.0, 6.279190804944], 0.055041503906),
        (0.8, [4.892863645702, -1.5625, 9.274381747987], 0.139065679012),
        (1.6, [34.705973264670, -1.5625, 8.704840544873], -0.27104),
        (2.1, [38.579224843992, 0.0, 6.914584223522], -0.226091063247),
    ] {
        let ankle = walk.ankle(RIGHT, t);
        near(&ankle[..3], &at);
        assert!((ankle[3] - pitch).abs() < 1e-11, "{t} s: {} is {pitch}", ankle[3]);
    }
    // The left foot does the same half a stride later, on the other side.
    for t in [0.3, 1.1, 1.7] {
        let (right, left) = (walk.ankle(RIGHT, t), walk.ankle(LEFT, t + 2.0));
        near(&[left[0] - 0.2, left[2], left[3]], &[100.0 * right[0], 100.0 * right[2], 100.0 * right[3]]);
        near(&[left[1]], &[17.0 - 100.0 * right[1]]);
    }
}

/// While a sole is on the ground, the edge it rolls about stays where it is, and nothing of it is in the ground.
#[test]
fn a_sole_on_the_ground_neither_slips_nor_sinks() {
    for pattern in [static_walk(), example()] {
        let walk = Walk::new(pattern);
        let cycle = 2.0 * pattern.step_time;
        for foot in [RIGHT, LEFT] {
            let mut stood: Option<[f64; 2]> = None;
            for i in 0..20_000 {
                let t = cycle * f64::from(i) / 20_000.0;
                if walk.plan.swings(foot, walk.begin + t) {
                    stood = None;
                    continue;
                }
                let [x, y, z, angle] = walk.ankle(foot, t);
                let (s, c) = angle.sin_cos();
                // Edges seen from the ankle, and the footprint that each of them belongs to.
                let at = EDGES.map(|edge| [x - ANKLE * s + edge * c, z - ANKLE * c - edge * s]);
                let rolls = usize::from(angle >= 0.0);
                let footprint = [at[rolls][0] - EDGES[rolls], y];
                assert!(at[rolls][1].abs() < 1e-14 && at[1 - rolls][1] > -1e-14, "{t} s: {at:?}");
                let was = *stood.get_or_insert(footprint);
                assert!((0..2).all(|d| (was[d] - footprint[d]).abs() < 1e-14), "{t} s slips");
            }
        }
    }
}

/// Position, velocity and acceleration are continuous: at each instant of a fine grid they are what the instant before and
/// its derivatives lead to.
#[test]
fn courses_are_smooth() {
    for pattern in [
        static_walk(),
        example(),
        Pattern { forward: TorsoForward::Spline, height: TorsoHeight::Spline, ..example() },
    ] {
        let walk = Walk::new(pattern);
        let h = pattern.step_time / 200_000.0;
        // A jump of an acceleration by a thousandth of its largest would be seen.
        let course = |t: f64| {
            let body = walk.plan.body.sample(t);
            let soles = [0, 1].map(|foot| walk.plan.sole(foot, t, EDGES));
            let mut all: Vec<[f64; 3]> = Vec::with_capacity(13);
            let component = |p: &[f64], v: &[f64], a: &[f64], d: usize| [p[d], v[d], a[d]];
            all.extend((0..3).map(|d| component(&body.position, &body.velocity, &body.acceleration, d)));
            for (s, pitch) in &soles {
                all.extend((0..4).map(|d| component(&s.position, &s.velocity, &s.acceleration, d)));
                all.push(component(&pitch.position, &pitch.velocity, &pitch.acceleration, 0));
            }
            all
        };
        let largest = (0..4000).flat_map(|i| course(walk.begin + f64::from(i) * pattern.step_time / 2000.0));
        let largest = largest.map(|x| x[2].abs()).fold(0.0, f64::max);
        let mut last = course(walk.begin - h);
        for i in 0..400_000 {
            let now = course(walk.begin + f64::from(i) * h);
            for (d, (a, b)) in last.iter().zip(&now).enumerate() {
                let t = f64::from(i) * h;
                assert!(
                    (b[1] - a[1] - 0.5 * h * (a[2] + b[2])).abs() < 1e-3 * h * largest,
                    "{d} at {t}: velocity"
                );
                assert!((b[2] - a[2]).abs() < 2e-3 * largest, "{d} at {t}: acceleration {} {}", a[2], b[2]);
            }
            last = now;
        }
    }
}

/// Evidence of what is printed: (4-13) to (4-16) with their numerator let the torso's velocity jump.
#[test]
fn the_printed_numerator_lets_the_velocity_jump() {
    for (p, jump) in [(example(), 0.125), (static_walk(), 0.0347)] {
        let (cycle, double, way) = (p.step_time, p.double_support, p.length);
        let single = cycle - double;
        let printed = way - p.end_ahead - p.start_behind;
        // Their slopes at T_d, from both sides.
        let before = printed / (double * double * single) * (2.0 - 3.0) * double * double
            + (way - p.start_behind - p.end_ahead) / double;
        let after = printed / (double * single * single) * (3.0 - 2.0) * single * single
            + (p.end_ahead + p.start_behind) / single;
        assert!(((before - after).abs() - jump).abs() < 5e-5, "{} m/s", before - after);
    }
}

fn archie() -> Robot {
    Robot::load(&config::root(None).join("robots/archie")).unwrap()
}

impl Walk {
    /// Thesis angles of a leg at `t` \[s\] of the pattern.
    fn theta(&self, robot: &Robot, foot: usize, t: f64) -> Result<[f64; 6], config::LegError> {
        self.theta_under(robot, foot, t, self.plan.body.sample(self.begin + t).position)
    }

    /// The same with the torso at `body` \[m\].
    fn theta_under(
        &self,
        robot: &Robot,
        foot: usize,
        t: f64,
        body: [f64; 3],
    ) -> Result<[f64; 6], config::LegError> {
        let (sole, pitch) = self.plan.sole(foot, self.begin + t, EDGES);
        let [x, y, z, _] = sole.position;
        let turned = nalgebra::Rotation3::from_axis_angle(&Vector3::y_axis(), pitch.position[0]);
        let body = Vector3::from(body);
        let leg = &robot.legs.as_ref().unwrap()[foot];
        let upright = Matrix3::identity();
        Ok(leg.theta(&leg.angles((turned.matrix(), &Vector3::new(x, y, z)), (&upright, &body))?))
    }
}

/// V12 and V13.
#[test]
fn joint_angles_are_those_of_the_errata() {
    let robot = archie();
    let near = |walk: &Walk, foot: usize, t: f64, printed: [f64; 6]| {
        let theta = walk.theta(&robot, foot, t).unwrap();
        for (joint, (is, printed)) in theta.iter().zip(printed).enumerate() {
            assert!(
                (is - printed).abs() < 2e-12,
                "{t} s, foot {foot}, theta{}: {is} is {printed}",
                joint + 1
            );
        }
    };
    let walk = Walk::new(Pattern { height: TorsoHeight::Spline, start_height: 0.542, ..static_walk() });
    let r = [0.283186047715, -0.833790283634, 1.272847359397, -0.439057075763, 1.287610279080, 0.0];
    let l = [0.112690931193, 0.147148833420, -0.985790696316, 0.838641862896, 1.458105395602, 0.0];
    near(&walk, RIGHT, 0.0, r);
    near(&walk, LEFT, 0.0, l);
    let r = [-0.109027189655, -0.693094643512, 0.285645504041, 0.407449139471, 1.679823516450, 0.0];
    let l = [-0.273889126023, 0.713603450158, -1.181063870519, 0.467460420360, 1.844685452818, 0.0];
    near(&walk, RIGHT, 4.8, r);
    near(&walk, LEFT, 4.8, l);
    let r = [-0.217361522395, -0.835777323310, 1.332153592851, -0.496376269542, 1.788157849190, 0.0];
    let l = [-0.269057029738, 0.702462807624, -1.106665838056, 0.404203030432, 1.839853356533, 0.0];
    near(&walk, RIGHT, 8.4, r);
    near(&walk, LEFT, 8.4, l);
    let walk = Walk::new(Pattern { height: TorsoHeight::Spline, ..example() });
    let r =
        [-0.114721486738, -0.728422795244, 1.287109843497, -0.357399035676, 1.683221238291, 0.022888159639];
    let l = [-0.282608728200, 0.527807411375, -1.261775955966, 0.733968544591, 1.853405054995, 0.0];
    near(&walk, RIGHT, 0.4, r);
    near(&walk, LEFT, 0.4, l);
    let r =
        [-0.114127781522, -0.780497967627, 1.258676303173, -0.780025946862, 1.679805992721, -0.033861318311];
    near(&walk, RIGHT, 2.0, r);
}

/// All points of a stride can be reached, on a fine grid too; with the spline printed for `x_h` those of 6.2 cannot, and
/// as many of them as the errata count.
#[test]
fn points_in_reach() {
    let robot = archie();
    let beyond = |pattern: Pattern, points: u32| {
        let walk = Walk::new(pattern);
        let at = |i: u32| 2.0 * pattern.step_time * f64::from(i) / f64::from(points);
        let failures =
            (0..points).flat_map(|i| [RIGHT, LEFT].map(|foot| walk.theta(&robot, foot, at(i)).err()));
        let all: Vec<_> = failures.flatten().collect();
        assert!(all.iter().all(|why| matches!(why, config::LegError::TooFar { .. })), "{:?}", all.first());
        all.len()
    };
    for height in [TorsoHeight::Quintic, TorsoHeight::Spline] {
        for pattern in [static_walk(), example()] {
            let pattern = Pattern { height, start_height: 0.542, ..pattern };
            assert_eq!((beyond(pattern, 300), beyond(pattern, 20_000)), (0, 0), "{height:?}");
        }
    }
    let spline = Pattern {
        forward: TorsoForward::Spline,
        height: TorsoHeight::Spline,
        start_height: 0.542,
        ..static_walk()
    };
    assert_eq!(beyond(spline, 300), 22);
}

/// Torso forward \[m\] at `t` \[s\] of a stride by (4-13), (4-14) as they are printed; the stride begins with its rear ankle at 0.
fn printed_forward(p: &Pattern, t: f64) -> f64 {
    let (cycle, double, way) = (p.step_time, p.double_support, p.length);
    let single = cycle - double;
    let printed = way - p.end_ahead - p.start_behind;
    let step = (t / cycle).floor();
    let t = t - step * cycle;
    let [before, x] = if t > double {
        let (a, b) = (t - double, cycle - t);
        let cubic = a.powi(3) - b.powi(3) + single * single * (b - a);
        let ends = (way - p.start_behind) * b + (way + p.end_ahead) * a;
        [step, printed / (double * single * single) * cubic + ends / single]
    } else {
        // Printed for T_c < t < T_c + T_d: the step before.
        let (a, b) = (t, double - t);
        let cubic = b.powi(3) - a.powi(3) + double * double * (a - b);
        let ends = p.end_ahead * b + (way - p.start_behind) * a;
        [step - 1.0, way + printed / (double * double * single) * cubic + ends / double]
    };
    before * way + x
}

/// Evidence of what is printed: with that x_h and the spline of z_h 32 of the 600 points of 6.2 are beyond the legs' reach.
#[test]
fn the_printed_torso_is_out_of_reach() {
    // V8.
    near(&[printed_forward(&example(), 0.1), printed_forward(&example(), 0.8)], &[8.359375, 18.75]);
    let pattern = Pattern { height: TorsoHeight::Spline, start_height: 0.542, ..static_walk() };
    let (robot, walk) = (archie(), Walk::new(pattern));
    let beyond = |i: u32| {
        let t = 2.0 * pattern.step_time * f64::from(i) / 300.0;
        let [_, y, z] = walk.plan.body.sample(walk.begin + t).position;
        let body = [walk.at.x + printed_forward(&pattern, t), y, z];
        [RIGHT, LEFT].map(|foot| {
            let far = walk.theta_under(&robot, foot, t, body);
            usize::from(matches!(far, Err(config::LegError::TooFar { .. })))
        })
    };
    assert_eq!((0..300).flat_map(beyond).sum::<usize>(), 32);
}

/// Ranges \[deg\] and largest speeds \[deg/s\] of the right leg over 300 points: errata, section 3, to the last printed digit.
#[test]
fn ranges_and_speeds_of_the_joints() {
    let robot = archie();
    let spline = |p: Pattern| Pattern { height: TorsoHeight::Spline, start_height: 0.542, ..p };
    type Printed = [[f64; 5]; 6]; // least, greatest, speed, half of the last digit of the range, and of the speed
    let example_of: Printed = [
        [-12.5, 16.2, 108.0, 0.05, 0.5],
        [-51.1, -28.8, 121.0, 0.05, 0.5],
        [64.4, 77.2, 26.0, 0.05, 0.5],
        [-46.4, -17.5, 48.0, 0.05, 0.5],
        [-16.2, 12.5, 108.0, 0.05, 0.5],
        [-2.24, 1.31, 21.0, 0.005, 0.5],
    ];
    let static_of: Printed = [
        [-12.5, 16.2, 9.0, 0.05, 0.05],
        [-55.7, -7.9, 19.7, 0.05, 0.05],
        [11.4, 77.2, 28.8, 0.05, 0.05],
        [-48.5, 25.5, 22.7, 0.05, 0.05],
        [-16.2, 12.5, 9.0, 0.05, 0.05],
        [0.0, 0.0, 0.0, 1e-9, 1e-9],
    ];
    for (pattern, printed) in [(spline(example()), example_of), (spline(static_walk()), static_of)] {
        let walk = Walk::new(pattern);
        let spacing = 2.0 * pattern.step_time / 300.0;
        let angles = |i: u32| {
            let mut theta = walk.theta(&robot, RIGHT, f64::from(i % 300) * spacing).unwrap();
            theta[4] -= std::f64::consts::FRAC_PI_2;
            theta.map(f64::to_degrees)
        };
        for (joint, [least, greatest, speed, digit, speed_digit]) in printed.into_iter().enumerate() {
            let all = || (0..300).map(|i| angles(i)[joint]);
            let (low, high) = all().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(x), b.max(x)));
            let name = joint + 1;
            assert!(
                (low - least).abs() < 1.01 * digit && (high - greatest).abs() < 1.01 * digit,
                "theta {name}: {low} {high}"
            );
            let rate = |i: u32| (angles(i + 1)[joint] - angles(i)[joint]).abs() / spacing;
            let fastest = (0..300).map(rate).fold(0.0, f64::max);
            assert!((fastest - speed).abs() < 1.01 * speed_digit, "theta {name}: {fastest} deg/s");
        }
    }
}
