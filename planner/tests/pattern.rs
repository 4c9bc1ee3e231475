//! Archie's own walk: what the planner lets go out, and what it refuses.

use config::pattern::{Pattern, TorsoHeight};
use config::{Gait, LegError, Robot};
use messages::command::{StepCommand, VelocityCommand};
use messages::{
    Command, ControllerState, EventCode, GaitState, LEFT, MAX_JOINTS, Plan, RIGHT, Reason, Record,
};
use planner::Planner;
use planner::pattern_check::PatternFault;

/// \[s\]
const CYCLE: f64 = 3.2e-3;
const SPLINE: TorsoHeight = TorsoHeight::Spline;

fn gait() -> Gait {
    Gait::load(&config::root(None).join("gaits/archie_static.toml")).unwrap()
}

fn archie() -> Robot {
    Robot::load(&config::root(None).join("robots/archie")).unwrap()
}

fn pattern() -> Pattern {
    gait().pattern.unwrap()
}

fn verdict(robot: &Robot, pattern: Pattern) -> Result<(), PatternFault> {
    Planner::of(&Gait::from(pattern), robot).map(drop)
}

/// Planner of a robot that does what it is told.
struct Walker {
    robot: Robot,
    planner: Planner,
    tick: u64,
    state: ControllerState,
    active: Box<Plan>,
    next: Option<Box<Plan>>,
    plans: Vec<Box<Plan>>,
    /// Leg angles of the last cycle.
    angles: [f64; MAX_JOINTS],
    /// \[1\] Largest speed of a joint, over its limit.
    fastest: f64,
    events: Vec<EventCode>,
}

impl Walker {
    /// Standing nearly straight, the feet `width` \[m\] apart.
    fn new(width: f64) -> Self {
        Self::with(&gait(), width)
    }

    fn with(gait: &Gait, width: f64) -> Self {
        let robot = archie();
        let mut state = ControllerState::empty();
        state.feet = [[0.0, -0.5 * width, 0.0, 0.0], [0.0, 0.5 * width, 0.0, 0.0]];
        state.torso = [0.0, 0.0, 0.65];
        Self {
            planner: Planner::of(gait, &robot).unwrap(),
            robot,
            tick: 0,
            state,
            active: Box::new(Plan::empty()),
            next: None,
            plans: Vec::new(),
            angles: [0.0; MAX_JOINTS],
            fastest: 0.0,
            events: Vec::new(),
        }
    }

    fn step(&mut self, commands: &[Command]) -> Vec<Result<(), Reason>> {
        self.tick += 1;
        let out = self.planner.step(self.tick, CYCLE, Some(&self.state), commands);
        let answers = out.answers.to_vec();
        self.events.extend(out.events.drain().map(|(code, _)| code));
        if let Some(plan) = out.plan {
            self.next = Some(Box::new(*plan));
            self.plans.push(Box::new(*plan));
        }
        self.state.header.tick = self.tick;
        if let Some(plan) = self.next.take_if(|plan| plan.start_tick == self.tick) {
            self.active = plan;
        }
        if self.active.id > 0 {
            self.follow();
        }
        answers
    }

    fn time(&self) -> f64 {
        (self.tick - self.active.start_tick) as f64 * CYCLE
    }

    fn follow(&mut self) {
        let t = self.time();
        self.state.plan_id = self.active.id;
        self.state.gait = self.active.state;
        self.state.origin = self.active.origin;
        self.state.torso = self.active.body.sample(t).position;
        self.state.feet = [0, 1].map(|foot| self.active.feet[foot].sample(t).position);
        let mut angles = self.angles;
        self.robot.angles_of_plan(&self.active, t, &mut angles).unwrap();
        for (joint, (now, before)) in self.robot.joints.iter().zip(angles.iter().zip(self.angles)) {
            if self.active.id > 1 {
                self.fastest = self.fastest.max(((now - before) / CYCLE).abs() / joint.speed_limit);
            }
        }
        self.angles = angles;
    }

    fn run(&mut self, seconds: f64) {
        for _ in 0..(seconds / CYCLE) as u64 {
            self.step(&[]);
        }
    }
}

fn forward(forward: f64) -> Command {
    Command::Velocity(VelocityCommand { forward, left: 0.0, turn: 0.0 })
}

/// From standing straight into the crouch, half a step, steps, half a step, standing: on time, without a jump.
#[test]
fn walks_and_stops_wherever_it_is_told_to() {
    for walked in [1.0, 7.0, 14.0, 29.0, 40.0] {
        let mut r = Walker::new(0.17);
        r.step(&[Command::Stand]);
        r.run(3.0);
        assert!((r.state.torso[2] - pattern().heights[0]).abs() < 1e-12);
        assert_eq!(r.step(&[forward(0.25 / 12.0)]), [Ok(())]);
        r.run(walked);
        r.step(&[Command::Stop]);
        r.run(31.0);
        assert!(r.time() > r.active.end(), "stands, told after {walked} s");
        // Steps of D_s, as many as were begun, and one that closes the feet.
        let begun = (walked / 12.0).floor() + 1.0;
        assert!((r.active.origin[0] + r.state.feet[LEFT][0] - begun * 0.25).abs() < 1e-12, "{walked} s");
        let [right, left] = [RIGHT, LEFT].map(|foot| r.state.feet[foot]);
        assert!((right[0] - left[0]).abs() < 1e-12 && (left[1] - right[1] - 0.17).abs() < 1e-12);
        assert!(r.fastest < 0.25, "no joint jumps: {} of its speed limit", r.fastest);
        for pair in r.plans.windows(2) {
            let t = (pair[1].start_tick - pair[0].start_tick) as f64 * CYCLE;
            let (a, b) = (pair[0].body.sample(t), pair[1].body.sample(0.0));
            let rates = a.velocity.iter().zip(b.velocity).chain(a.acceleration.iter().zip(b.acceleration));
            assert!(
                rates.into_iter().all(|(a, b)| (a - b).abs() < 1e-12),
                "plans {} and {}",
                pair[0].id,
                pair[1].id
            );
        }
        assert!(r.plans.iter().all(|plan| {
            let end = plan.body.sample(plan.end());
            end.velocity == [0.0; 3] && plan.step_count as usize <= plan.steps.len()
        }));
        assert_eq!(r.plans.last().map(|plan| plan.state), Some(GaitState::Stopping as u64));
    }
}

/// From feet as far apart as all joints at zero put them a leg is too short for a whole first step: it is made smaller, and
/// the walk goes on.
#[test]
fn feet_far_apart_step_as_far_as_legs_reach() {
    let mut r = Walker::new(0.26);
    r.step(&[Command::Stand]);
    r.run(3.0);
    r.step(&[forward(0.25 / 12.0)]);
    r.run(40.0);
    let first = &r.plans[1].steps[0];
    assert!(first.landing[0] < 0.2, "{first:?}");
    let length = r.plans.last().map(|plan| plan.steps[0].landing[0] - plan.steps[0].foothold[0]);
    assert!(length.is_some_and(|length| (length - 0.25).abs() < 1e-12), "{length:?}");
    assert!((r.state.feet[LEFT][1] - r.state.feet[RIGHT][1]).abs() < 0.17 + 2.0 * 0.05 + 1e-12);
}

/// A pattern goes straight on, no faster than its own steps.
#[test]
fn what_a_pattern_cannot_do_is_refused_with_its_limit() {
    let mut r = Walker::new(0.17);
    r.step(&[Command::Stand]);
    r.run(3.0);
    let velocity =
        |forward: f64, left: f64, turn: f64| Command::Velocity(VelocityCommand { forward, left, turn });
    for (command, field) in [
        (velocity(0.02, 0.0, 0.01), 2),
        (velocity(0.02, 0.001, 0.0), 1),
        (velocity(0.0209, 0.0, 0.0), 0),
        (velocity(-0.01, 0.0, 0.0), 0),
        (velocity(f64::NAN, 0.0, 0.0), 0),
        (Command::Step(StepCommand { length: 0.2, side: 0.0, turn: 0.02, duration: 12.0 }), 2),
        (Command::Step(StepCommand { length: 0.2, side: 0.0, turn: 0.0, duration: 2.0 }), 3),
    ] {
        let plans = r.plans.len();
        let answers = r.step(std::slice::from_ref(&command));
        assert!(
            matches!(answers[0], Err(Reason::Limit { field: f, .. }) if f == field),
            "{command:?}: {answers:?}"
        );
        r.run(1.0);
        assert_eq!(r.plans.len(), plans, "nothing moves");
    }
}

/// Archie with knees that may be straight: his software ranges end 2 degrees before that.
fn archie_with_straight_knees() -> Robot {
    let shipped = config::root(None).join("robots/archie");
    let copy = std::env::temp_dir().join(format!("gangwerk-straight-{}", std::process::id()));
    std::fs::create_dir_all(copy.join("can")).unwrap();
    std::fs::copy(shipped.join("archie.urdf"), copy.join("archie.urdf")).unwrap();
    for file in std::fs::read_dir(shipped.join("can")).unwrap().map(Result::unwrap) {
        std::fs::copy(file.path(), copy.join("can").join(file.file_name())).unwrap();
    }
    let text = std::fs::read_to_string(shipped.join("robot.toml")).unwrap();
    let text = text
        .replace("range_deg = [2, 88]", "range_deg = [0, 90]")
        .replace("range_deg = [-88, -2]", "range_deg = [-90, 0]");
    std::fs::write(copy.join("robot.toml"), text).unwrap();
    let robot = Robot::load(&copy);
    std::fs::remove_dir_all(&copy).unwrap();
    robot.unwrap()
}

/// Ends of reach, by bisection, are those that an independent code found; beyond them the straight leg is too short.
#[test]
fn ends_of_reach() {
    let robot = archie_with_straight_knees();
    // Each parameter, what is tried, and where reach ends [cm].
    type Set = fn(&mut Pattern, f64);
    let ends: [(&str, Set, [f64; 2], f64); 5] = [
        ("D_s", |p, x| (p.length, p.over_length) = (x, x), [0.25, 0.30], 26.156),
        ("H_max", |p, x| p.heights[1] = x, [0.57, 0.60], 58.048),
        ("w_s", |p, x| p.width = x, [0.17, 0.25], 19.638),
        ("w_m", |p, x| p.shift = x, [0.02, 0.08], 4.638),
        (
            "w_m, z_h a spline",
            |p, x| (p.shift, p.height, p.start_height) = (x, SPLINE, 0.542),
            [0.02, 0.08],
            3.282,
        ),
    ];
    for (key, set, [mut good, mut bad], end) in ends {
        let of = |x: f64| {
            let mut p = pattern();
            set(&mut p, x);
            verdict(&robot, p)
        };
        assert_eq!(of(good), Ok(()), "{key}");
        while bad - good > 1e-7 {
            let middle = 0.5 * (good + bad);
            if of(middle).is_ok() { good = middle } else { bad = middle }
        }
        let too_far = |v: &Result<(), PatternFault>| {
            matches!(v, Err(PatternFault::Leg { why: LegError::TooFar { .. }, .. }))
        };
        let found = of(bad);
        assert!(too_far(&found), "{key} = {bad}: {found:?}");
        assert!(
            (100.0 * good - end).abs() < 2.5e-3,
            "{key}: reach ends at {:.3} cm, not {end}",
            100.0 * good
        );
    }
}

/// The rule that is broken is named, with value and bound.
#[test]
fn faults_are_named() {
    let robot = archie();
    let told = |set: fn(&mut Pattern)| {
        let mut p = pattern();
        set(&mut p);
        verdict(&robot, p).unwrap_err().to_string()
    };
    for (text, words) in [
        (told(|p| p.double_support = 13.0), ["T_d", "13"]),
        (told(|p| p.over_time = f64::NAN), ["T_o", "NaN"]),
        (told(|p| p.heights = [0.57, 0.54]), ["H_min", "0.57"]),
        (told(|p| p.over_height = 0.05), ["sole would be", "in the ground"]),
        (told(|p| (p.width, p.pass) = (0.05, 0.0)), ["soles are", "w_s or w_p"]),
        (told(|p| p.heights = [0.36, 0.38]), ["right leg, 0.00 s", "knee would be bent"]),
        (told(|p| p.pass = 0.3), ["adduction", "range is"]),
        (told(|p| p.end_ahead = 0.2), ["leg, 17", "the straight leg has"]),
    ] {
        assert!(words.iter().all(|word| text.contains(word)), "{words:?}: {text}");
    }
    // A hundred times as fast as he can: all times shrink together.
    let p = pattern();
    let fast = Pattern {
        step_time: 0.12,
        double_support: 0.048,
        over_time: 0.084,
        low_time: 0.0096,
        high_time: 0.084,
        pitch_times: [0.0, 0.12, 0.12 + 0.048],
        ..p
    };
    let text = verdict(&robot, fast).unwrap_err().to_string();
    assert!(text.contains("rad/s") && text.contains("a longer T_c"), "{text}");
    // Another robot has no such legs.
    let lola = Robot::load(&config::root(None).join("robots/lola")).unwrap();
    assert_eq!(verdict(&lola, p), Err(PatternFault::NoLegs));
}

/// However few points the tables of a stride have, what lies between them is looked at.
#[test]
fn few_points_of_tables_hide_nothing() {
    let robot = archie();
    let told = |set: fn(&mut Pattern)| {
        [2, 3, 300, 1024].map(|points| {
            let mut p = Pattern { points, ..pattern() };
            set(&mut p);
            verdict(&robot, p).map_err(|fault| fault.to_string())
        })
    };
    let all = |found: [Result<(), String>; 4], words: &str| {
        assert!(found.iter().all(|v| v.as_ref().is_err_and(|text| text.contains(words))), "{found:?}");
    };
    all(told(|p| (p.length, p.over_length) = (0.30, 0.30)), "the straight leg has");
    all(told(|p| p.over_height = 0.05), "in the ground");
    all(told(|p| p.shift = 0.08), "the straight leg has");
    assert_eq!(told(|_| ()), [const { Ok(()) }; 4]);
}

/// Drives that play tables have 1024 points for two plans: three steps and a double support of 0.45 T_c would take 520.
#[test]
fn a_plan_with_more_points_than_there_is_room_for_is_refused() {
    let mut robot = archie();
    robot.play_tables().unwrap();
    assert_eq!(verdict(&robot, pattern()), Ok(()));
    let longer = verdict(&robot, Pattern { double_support: 5.4, ..pattern() }).unwrap_err().to_string();
    assert!(longer.contains("N = 300 gives 520 points to a plan of 41.40 s"), "{longer}");
}

/// With drives that play tables plans are published as long before their start as those take, and begin after the last
/// points of the plan before.
#[test]
fn plans_leave_time_for_their_tables() {
    let mut r = Walker::new(0.17);
    r.robot.play_tables().unwrap();
    r.planner = Planner::of(&gait(), &r.robot).unwrap();
    r.step(&[Command::Stand]);
    r.run(4.0);
    r.step(&[forward(0.25 / 12.0)]);
    r.run(30.0);
    r.step(&[Command::Stop]);
    r.run(45.0);
    let tables = r.robot.tables.as_ref().unwrap();
    let least = tables.plan_lead(&r.robot.layout, CYCLE, 512);
    assert!(r.plans.len() > 4 && r.plans.iter().all(|plan| plan.start_tick - plan.header.tick >= least));
}

/// True if the legs can take all poses of a plan, on a finer grid than the planner's.
fn is_in_reach(robot: &Robot, plan: &Plan) -> bool {
    let mut angles = [0.0; MAX_JOINTS];
    let at = |i: u32| plan.end() * f64::from(i) / 3000.0;
    (0..=3000).all(|i| robot.angles_of_plan(plan, at(i), &mut angles).is_ok())
}

/// A walk out of feet nearer to one another than w_s left the legs' reach in its third plan: its second step was as much wider
/// than w_s as the stand was narrower, and no plan but the first was looked at.
#[test]
fn accepted_patterns_stay_in_reach_from_any_stand() {
    let mut state = 7_u64;
    let mut random = |low: f64, high: f64| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let robot = archie();
    let (mut accepted, mut walks) = (0, 0);
    while accepted < 24 {
        let (time, length) = (random(8.0, 16.0), random(0.2, 0.29));
        let double = time * random(0.3, 0.45);
        let set = Pattern {
            step_time: time,
            double_support: double,
            over_time: 0.7 * time,
            low_time: 0.08 * time,
            high_time: 0.7 * time,
            pitch_times: [0.0, time, time + double],
            length,
            over_length: length,
            width: random(0.15, 0.2),
            heights: [0.54, random(0.55, 0.58)],
            ..pattern()
        };
        if verdict(&robot, set).is_err() {
            continue;
        }
        accepted += 1;
        for (width, share) in [(0.15, 0.999_999), (0.16, 0.9), (0.17, 0.999_999), (0.2, 0.999_999)] {
            let mut r = Walker::with(&Gait::from(set), width);
            r.step(&[Command::Stand]);
            r.run(3.0);
            r.step(&[forward(share * length / time)]);
            r.run(4.5 * time);
            r.step(&[Command::Stop]);
            r.run(2.0 * time);
            for (k, plan) in r.plans.iter().enumerate() {
                assert!(is_in_reach(&robot, plan), "plan {k}, feet {width} m apart: {set:?}");
            }
            walks += usize::from(r.plans.len() >= 7);
        }
    }
    assert!(walks > 80, "{walks} walks of five steps and a stop");
}
