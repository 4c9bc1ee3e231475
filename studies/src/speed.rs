//! How fast is each part, and how accurate is it at that speed?
//!
//! What a part is given is recorded from a walk of the whole chain and replayed through the part alone. Time is
//! processor time of this process, which does nothing else meanwhile; reading it costs a few tenths of a microsecond,
//! which stay in the figures.

use std::hint::black_box;

use config::{Gait, Setup, Timeline};
use controller::Controller;
use messages::{Command, ControllerState, GaitState, JointTargets, MAX_JOINTS, Plan, Process, Sensors};
use planner::Planner;
use planner::pattern_check::walk_of;
use realtime::clock::processor_time;
use serde::Serialize;
use serde_json::{Value, json};

use crate::sheet::{Column, fixed, plain};
use crate::{Error, Given, Sheet, Study, simulation_speed};
use chain::Chain;

/// Runs of which the fastest counts, where the work is the same each time.
const REPEATS: usize = 5;

/// A walk's control cycles: processor times, median, p99 and largest.
const CYCLES: &[Column] = &[
    plain("/walk", "control cycle, processor time [us]"),
    plain("/cycles", "cycles"),
    plain("/same_targets", "replay is the chain's, bit for bit"),
    fixed("/both_us", "planner + stabilizer: median, p99, max", 2),
    fixed("/stabilizer_us", "stabilizer", 2),
    fixed("/planner_us", "planner", 2),
];
/// Plans of a walk with knots at most `spacing` apart.
const PLANS: &[Column] = &[
    fixed("/spacing_s", "a new walking plan: spacing [s]", 3),
    plain("/points", "points"),
    fixed("/time_us", "median, p99, max [us]", 2),
    fixed("/zmp_error_m", "error of its zero-moment point [mm]", 3).times(1e3),
];
/// A scene with everything in the loop.
const CHAIN: &[Column] =
    &[plain("/scene", "whole chain in one process"), fixed("/real_time_factor", "real time [1]", 0)];

/// A walk that is a pattern (Daniali 2013).
const PATTERN: &[Column] = &[
    plain("/walk", "a pattern"),
    fixed("/plan_us", "cycle with a new plan: median, p99, max [us]", 2),
    fixed("/stride_us", "legs at all points of a stride [us]", 1),
    plain("/legs", "leg solutions"),
];

/// \[s\] Of a walk as slow as Archie's: two of its steps.
const SLOW_WALK: f64 = 40.0;

/// Plans of a walk with knots at most `spacing` apart.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Plans {
    /// \[s\]
    spacing_s: f64,
    /// Collocation points of head and tail of a walking plan, the most that occurred.
    pub(crate) points: u64,
    /// \[us\] The planner's cycle in which a walking plan is made: median, p99, largest.
    pub(crate) time_us: [f64; 3],
    /// \[m\] How far three masses that move as planned miss the planned zero-moment point: largest over the plan.
    pub(crate) zmp_error_m: f64,
}

/// The study; it has no arguments.
#[derive(clap::Args, Clone, Debug)]
pub struct Speed {}

impl Study for Speed {
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
        let [stand, walk, fast, mut all] =
            ["stand", "walk_1kmh", "walk_2kmh", "gaze"].map(|scene| Setup::load(given.config, scene));
        let (stand, walk, fast) = (stand?, walk?, fast?);
        if let Ok(all) = &mut all {
            all.gait.arm_swing = Some(1.0);
            all.scene.name += ", arms swinging";
        }
        // Each part alone, from its own recording of the walk.
        let simulation = simulation_speed::run(&stand, &walk)?;
        let recording = Recording::new(&walk)?;
        let plans = [0.75, 1.0, 1.5, 2.0, 3.0]
            .map(|times| plan_times(&walk, &recording, times * walk.gait.model.spacing));
        let mut cycles = vec![cycle_times(&walk, &recording)?];
        for setup in [fast, all?] {
            cycles.push(cycle_times(&setup, &Recording::new(&setup)?)?);
        }
        let mut slow = Setup::load(given.config, "archie_static")?;
        slow.scene.duration = SLOW_WALK;
        slow.scene.commands.retain(|(time, _)| *time < SLOW_WALK);
        let slow_recording = Recording::new(&slow)?;
        cycles.push(cycle_times(&slow, &slow_recording)?);
        let mut sheet = Sheet::titled(
            "Models alone, 1 s with recorded joint targets, sensors every cycle; errors against fine Runge-Kutta steps",
        );
        sheet.rows("simulation", simulation_speed::COLUMNS, &simulation);
        sheet.line("");
        sheet.rows("chain", CHAIN, &[whole_chain(&stand)?, whole_chain(&walk)?, whole_chain(&slow)?]);
        sheet.line("");
        sheet.rows("cycles", CYCLES, &cycles);
        sheet.line("");
        sheet.rows("plans", PLANS, &plans);
        sheet.line("");
        sheet.rows("pattern", PATTERN, &[pattern_times(&slow, &slow_recording)?]);
        Ok(sheet)
    }
}

// ---------------------------------------------------------------------------------------------------- whole chain

fn whole_chain(setup: &Setup) -> Result<Value, Error> {
    let cycles = (setup.scene.duration / setup.scene.cycle) as usize;
    let mut best = f64::INFINITY;
    for _ in 0..REPEATS {
        let mut chain = Chain::new(setup)?;
        let begun = processor_time();
        for _ in 0..cycles {
            black_box(chain.step());
        }
        best = best.min((processor_time() - begun) as f64 * 1e-9);
    }
    let real_time_factor = cycles as f64 * setup.scene.cycle / best;
    Ok(json!({ "scene": setup.scene.name, "real_time_factor": real_time_factor }))
}

// --------------------------------------------------------------------------------------------- planner, stabilizer

/// What planner and stabilizer saw and did in each cycle of a walk.
pub(crate) struct Recording {
    pub(crate) sensors: Vec<Sensors>,
    states: Vec<ControllerState>,
    pub(crate) targets: Vec<JointTargets>,
}

impl Recording {
    pub(crate) fn new(setup: &Setup) -> Result<Self, Error> {
        let mut chain = Chain::new(setup)?;
        let mut r = Self { sensors: Vec::new(), states: Vec::new(), targets: Vec::new() };
        for _ in 0..(setup.scene.duration / setup.scene.cycle) as usize {
            let c = chain.step();
            r.sensors.push(c.sensors);
            r.states.push(c.controller_state);
            r.targets.push(c.joint_targets);
        }
        Ok(r)
    }

    /// Replays the planner's input; `seen` is told the cycle and given the planner to step.
    fn replay(
        &self,
        setup: &Setup,
        gait: &Gait,
        mut seen: impl FnMut(usize, &mut dyn FnMut(&mut Plan) -> bool),
    ) {
        let mut planner = Planner::of(gait, &setup.robot).expect("a gait that was walked");
        let mut timeline = Timeline::new(&setup.scene, Process::Planner);
        let mut due: Vec<Command> = Vec::with_capacity(16);
        for i in 0..self.sensors.len() {
            let tick = self.sensors[i].header.tick;
            due.clear();
            due.extend(std::iter::from_fn(|| timeline.due(tick)));
            let before = i.checked_sub(1).map(|k| &self.states[k]);
            seen(i, &mut |plan| {
                let made = planner.step(tick, setup.scene.cycle, before, &due).plan;
                made.inspect(|made| *plan = **made).is_some()
            });
        }
    }
}

fn cycle_times(setup: &Setup, recording: &Recording) -> Result<Value, Error> {
    let mut controller = Controller::new(&setup.robot, &setup.gait, setup.scene.cycle)?;
    let mut plan = Box::new(Plan::default());
    let (mut planning, mut stabilizing, mut both) = (Vec::new(), Vec::new(), Vec::new());
    let mut same_targets = true;
    let mut head = Timeline::new(&setup.scene, Process::Controller);
    recording.replay(setup, &setup.gait, |i, planner| {
        while let Some(command) = head.due(recording.sensors[i].header.tick) {
            controller.command(&command);
        }
        let begun = processor_time();
        planner(&mut plan);
        let planned = processor_time();
        let (targets, _) = controller.step(&recording.sensors[i], (plan.id > 0).then_some(&*plan));
        let done = processor_time();
        same_targets &= targets.angle == recording.targets[i].angle;
        if plan.id > 0 {
            planning.push(planned - begun);
            stabilizing.push(done - planned);
            both.push(done - begun);
        }
    });
    Ok(json!({
        "walk": setup.scene.name,
        "cycles": both.len(),
        "same_targets": same_targets,
        "both_us": spread(both),
        "stabilizer_us": spread(stabilizing),
        "planner_us": spread(planning),
    }))
}

/// Median, p99 and largest of durations \[ns\], in microseconds.
fn spread(mut ns: Vec<u64>) -> [f64; 3] {
    ns.sort_unstable();
    let last = ns.len().saturating_sub(1);
    [last / 2, last * 99 / 100, last].map(|k| ns.get(k).copied().unwrap_or(0) as f64 * 1e-3)
}

// ---------------------------------------------------------------------------------------------------------- plans

pub(crate) fn plan_times(setup: &Setup, recording: &Recording, spacing: f64) -> Plans {
    let mut gait = setup.gait.clone();
    gait.model.spacing = spacing;
    let mut plan = Box::new(Plan::default());
    let (mut times, mut points, mut error) = (Vec::new(), 0, 0.0f64);
    for repeat in 0..10 * REPEATS {
        recording.replay(setup, &gait, |_, planner| {
            let begun = processor_time();
            let made = planner(&mut plan);
            let took = processor_time() - begun;
            if made && GaitState::from(plan.state) == GaitState::Walking {
                times.push(took);
                if repeat == 0 {
                    points = points.max(plan.body.pieces + 2); // two problems, each with a point more than pieces
                    error = error.max(zmp_error(&plan, &gait));
                }
            }
        });
    }
    Plans { spacing_s: spacing, points, time_us: spread(times), zmp_error_m: error }
}

/// Plans of a pattern, and the legs in closed form at the points of its stride.
fn pattern_times(setup: &Setup, recording: &Recording) -> Result<Value, Error> {
    let (mut plan, mut planning, mut strides) = (Box::new(Plan::default()), Vec::new(), Vec::new());
    for _ in 0..10 * REPEATS {
        recording.replay(setup, &setup.gait, |_, planner| {
            let begun = processor_time();
            let made = planner(&mut plan);
            let took = processor_time() - begun;
            if made && !GaitState::from(plan.state).rests() {
                planning.push(took);
            }
        });
    }
    // The last plan closes the feet; the two before it are a stride that repeats.
    let points = setup.gait.pattern.map_or(0, |p| p.points);
    let plans = walk_of(&setup.gait, &setup.robot).map_err(|fault| fault.to_string())?;
    let stride = plans.len().checked_sub(3).and_then(|k| plans.get(k..k + 2)).unwrap_or_default();
    let mut angles = [0.0; MAX_JOINTS];
    for _ in 0..100 * REPEATS {
        let begun = processor_time();
        for walked in stride {
            for k in 0..points / 2 {
                let t = walked.end * k as f64 / (points / 2) as f64;
                setup
                    .robot
                    .angles_of_plan(&walked.plan, t, &mut angles)
                    .map_err(|(_, why)| why.to_string())?;
                black_box(&angles);
            }
        }
        strides.push(processor_time() - begun);
    }
    let name = &setup.scene.name;
    Ok(json!({ "walk": name, "plan_us": spread(planning), "stride_us": spread(strides), "legs": 2 * points }))
}

/// Largest distance of the planned zero-moment point to that of three masses that move as planned (4.35)-(4.39).
fn zmp_error(plan: &Plan, gait: &Gait) -> f64 {
    const INSTANT: f64 = 1e-3;
    let (leg, height) = (gait.model.leg_mass, gait.model.leg_height);
    let body = 1.0 - 2.0 * leg;
    let g = multibody::GRAVITY_ACCELERATION;
    let at = |t: f64| {
        let com = plan.body.sample(t);
        let feet = [plan.feet[0].sample(t), plan.feet[1].sample(t)];
        let mut trunk = (com.position, com.acceleration);
        for foot in &feet {
            for d in 0..3 {
                let lift = if d == 2 { height } else { 0.0 };
                trunk.0[d] -= leg * (foot.position[d] + lift);
                trunk.1[d] -= leg * foot.acceleration[d];
            }
        }
        let trunk = (trunk.0.map(|x| x / body), trunk.1.map(|x| x / body));
        let masses = feet.map(|f| {
            let ([x, y, z, _], [ax, ay, az, _]) = (f.position, f.acceleration);
            (leg, ([x, y, z + height], [ax, ay, az]))
        });
        let all = [masses[0], masses[1], (body, trunk)];
        let force: f64 = all.iter().map(|(m, (_, a))| m * (a[2] + g)).sum();
        let planned = plan.zmp.sample(t).0;
        let miss = [0, 1].map(|d| {
            let moment: f64 = all.iter().map(|(m, (p, a))| m * (p[d] * (a[2] + g) - p[2] * a[d])).sum();
            moment / force - planned[d]
        });
        miss[0].hypot(miss[1])
    };
    (0..(plan.body.end() / INSTANT) as usize).map(|k| at(k as f64 * INSTANT)).fold(0.0, f64::max)
}
