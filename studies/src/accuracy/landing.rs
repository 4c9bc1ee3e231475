//! The whole robot lands: dropped by 10 mm on flat ground, and on a board under half of one foot. The drives hold the pose.
//!
//! | chart | error of |
//! |---|---|
//! | peak | greatest normal force of both feet at the end of a step \[N\] |
//! | impulse | the ground's impulse: momentum at the end and what gravity gave \[N s\] |
//! | state | torso's position \[m\] and orientation \[rad\], joint angles \[rad\] at the end: the greatest |
//!
//! Touchdown is a jump of the force, after which every method with fixed steps is of first order.

use std::error::Error;

use config::scene::FRICTION_RAMP;
use config::{Robot, Setup};
use environment::{Environment, Mesh, Object, Pose, Schedule};
use messages::RIGHT;
use multibody::Data;
use serde_json::Value;
use sim_backend::drive::JointCubic;
use sim_backend::integrate::Stepper;
use sim_backend::plant::{Plant, orientation};

use super::methods::{IntegrationMethod, beyond};
use super::reference::{limit, limits};
use super::walking::greatest;
use super::{AccuracyInput, ErrorChart, Peers, Point, cost};
use crate::second::POWERED;

/// \[s\] Steps are parts of it, as of a bus cycle.
const CYCLE: f64 = 1e-3;
/// \[m\] Height from which the robot drops.
const DROP: f64 = 0.01;
/// \[m\] The board: height, and half of length and width; an edge is below the middle of the sole.
const BOARD: [f64; 3] = [0.02, 0.1, 0.06];

/// Tolerances of the adaptive method, and the type up to which it takes part.
const TOLERANCES: [f64; 3] = [1e-4, 1e-6, 1e-8];
const ADAPTIVE: u8 = 2;
/// Beyond these errors a robot has fallen or its numbers have run away: of impulse \[N s\] and pose \[m, rad\].
const LOST: [f64; 2] = [10.0, 0.5];

/// Scenes with their cycles, and types of model.
const LANDINGS: [(&str, usize, u8); 8] = [
    ("settle", 500, 1),
    ("settle", 500, 2),
    ("settle", 300, 3),
    ("settle", 200, 4),
    ("edge", 200, 1),
    ("edge", 200, 2),
    ("edge", 200, 3),
    ("edge", 150, 4),
];

/// Charts of all landings.
///
/// # Errors
/// The robot's configuration is wrong.
pub fn charts(given: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let setup = Setup::load(given.config, "stand")?;
    let mut charts = Vec::new();
    for (scene, cycles, depth) in LANDINGS {
        let fall = Fall::new(&setup, scene, cycles, depth)?;
        let found = fall.charts(&setup, scene, depth)?;
        let overlaid = (scene == "settle" && depth == 2).then(|| overlay(&found[0], given.peers)).flatten();
        charts.extend(found.into_iter().chain(overlaid));
    }
    Ok(charts)
}

/// A robot above the ground, and what its drives hold.
struct Fall {
    environment: Environment,
    state: Vec<f64>,
    drives: Vec<JointCubic>,
    pose: Vec<f64>,
    cycles: usize,
}

/// What is compared.
#[derive(Clone, Debug)]
struct LandingOutcome {
    peak: f64,
    impulse: f64,
    state: Vec<f64>,
}

impl Fall {
    fn new(setup: &Setup, scene: &str, cycles: usize, depth: u8) -> Result<Self, Box<dyn Error>> {
        let (robot, pose) = (&setup.robot, &setup.robot.poses[&setup.scene.start_pose]);
        let mut plant = Plant::new(robot, Environment::flat(), depth, pose)?;
        let mut state = plant.standing(pose);
        let drives: Vec<JointCubic> = pose.iter().map(|&q| JointCubic::resting(q)).collect();
        let sole = plant.snapshot(0.0, &state, &drives).feet[RIGHT];
        let layer = plant.layout().layer();
        state[layer].fill(0.0);
        let height = if scene == "edge" { BOARD[0] } else { 0.0 };
        state[2] += height + DROP - sole[2];
        let environment = if scene == "edge" { board(robot, sole)? } else { Environment::flat() };
        Ok(Self { environment, state, drives, pose: pose.clone(), cycles })
    }

    fn charts(&self, setup: &Setup, scene: &str, depth: u8) -> Result<[ErrorChart; 3], Box<dyn Error>> {
        let mut plant = Plant::new(&setup.robot, self.environment.clone(), depth, &self.pose)?;
        let mut methods = IntegrationMethod::all(depth);
        methods.retain(|m| m.tolerance.is_none_or(|t| depth <= ADAPTIVE && TOLERANCES.contains(&t)));
        let references = IntegrationMethod::references(depth).map(|r| self.outcome(&mut plant, &r));
        let [reference, coarser] = limits(&references, LandingOutcome::limit);
        let title = match scene {
            "edge" => format!("Landing on the edge of a board under the right foot, type {depth}"),
            _ => format!("Dropped by 10 mm, type {depth}"),
        };
        let name = |what| format!("{scene}_type{depth}.{what}");
        let about = about(&reference, &coarser, self.cycles);
        let mut charts = [
            ErrorChart::new(&name("peak"), &title, "error of the peak of the normal force [N]").about(&about),
            ErrorChart::new(&name("impulse"), &title, "error of the ground's impulse [N s]"),
            ErrorChart::new(&name("state"), &title, "error of pose at the end [m, rad]"),
        ];
        for method in methods {
            plant.set_friction_ramp(method.ramp.unwrap_or(FRICTION_RAMP));
            let (gave_up, seconds) = cost::of(|| {
                let mut gave_up = false;
                self.run(&mut plant, &method, |_, stepper, _| gave_up |= stepper.take_gave_up().is_some());
                gave_up
            });
            let errors = self.outcome(&mut plant, &method).errors(&reference);
            // The adaptive method looks up once in a cycle, too seldom to see a peak.
            let unseen = usize::from(method.tolerance.is_some());
            let named = method.point(scene, depth, CYCLE);
            let stable = method.limit(&setup.robot, depth, &self.pose)?;
            let gave_up = gave_up.then(|| "gave up, and went on with semi_implicit steps".to_owned());
            let note = gave_up.or_else(|| beyond(named.step, stable));
            for (chart, error) in charts.iter_mut().zip(errors).skip(unseen) {
                if let Some(stable) = stable {
                    chart.limit(&named.method, stable);
                }
                let cpu_s_per_s = Some(seconds / (self.cycles as f64 * CYCLE));
                chart.add(Point { cpu_s_per_s, note: note.clone(), error, ..named.clone() });
            }
        }
        Ok(charts)
    }

    /// Lets the robot fall; `seen` is told of every step. The state at the end.
    fn run(
        &self,
        plant: &mut Plant,
        method: &IntegrationMethod,
        mut seen: impl FnMut(&mut Plant, &mut Stepper, &[f64]),
    ) -> Vec<f64> {
        let mut x = self.state.clone();
        let mut stepper = method.stepper(x.len());
        let h = CYCLE / f64::from(method.steps);
        for _ in 0..self.cycles {
            for i in 0..method.steps {
                stepper.step(plant, f64::from(i) * h, h, &mut x, &self.drives, &POWERED);
                seen(plant, &mut stepper, &x);
            }
        }
        x
    }

    fn outcome(&self, plant: &mut Plant, method: &IntegrationMethod) -> LandingOutcome {
        let mut peak = 0.0f64;
        let state = self.run(plant, method, |plant, _, x| {
            let wrench = plant.snapshot(CYCLE, x, &self.drives).foot_wrench;
            peak = peak.max(wrench.iter().map(|w| w.force[2]).sum());
        });
        LandingOutcome { peak, impulse: self.impulse(plant, &state), state: self.coordinates(plant, &state) }
    }

    /// \[N s\] What the ground gave: momentum now, and what gravity took.
    fn impulse(&self, plant: &Plant, x: &[f64]) -> f64 {
        let (model, l) = (plant.model(), plant.layout());
        let (mut q, mut v) = (model.neutral(), vec![0.0; model.nv()]);
        q[7..].copy_from_slice(&self.pose);
        q[..7 + l.joints].copy_from_slice(&x[l.pose()]);
        q[3..7].copy_from_slice(orientation(x).coords.as_slice());
        v[..6 + l.joints].copy_from_slice(&x[l.speed()]);
        let mut data = Data::new(model);
        model.forward_motion(&mut data, &q, &v);
        let time = self.cycles as f64 * CYCLE;
        model.mass() * (model.cog_motion(&data).0.z - multibody::GRAVITY.z * time)
    }

    /// Position, turn from the begin, joint angles.
    fn coordinates(&self, plant: &Plant, x: &[f64]) -> Vec<f64> {
        let turn = (orientation(&self.state).inverse() * orientation(x)).scaled_axis();
        let joints = &x[7..plant.layout().pose().end];
        x[..3].iter().chain(turn.iter()).chain(joints).copied().collect()
    }
}

impl LandingOutcome {
    fn limit(fine: &Self, coarse: &Self) -> Self {
        let of = |f: f64, c: f64| 2.0 * f - c;
        let (peak, impulse) = (of(fine.peak, coarse.peak), of(fine.impulse, coarse.impulse));
        Self { peak, impulse, state: limit(&fine.state, &coarse.state) }
    }

    fn errors(&self, reference: &Self) -> [f64; 3] {
        let state = greatest(self.state.iter().zip(&reference.state).map(|(a, b)| (a - b).abs()));
        let impulse = (self.impulse - reference.impulse).abs();
        if impulse < LOST[0] && state < LOST[1] {
            [(self.peak - reference.peak).abs(), impulse, state]
        } else {
            [f64::NAN; 3]
        }
    }
}

/// A board whose edge is below the middle of the sole: under its front half.
fn board(robot: &Robot, sole: [f64; 4]) -> Result<Environment, Box<dyn Error>> {
    let [height, half, width] = BOARD;
    let [back, front, ..] = robot.feet[RIGHT].support;
    let at = [sole[0] + 0.5 * (back + front) + half, sole[1], 0.5 * height];
    let mesh = Mesh::cuboid([2.0 * half, 2.0 * width, height])?;
    let fixed = Schedule::fixed(Pose::new(at, [0.0; 3]));
    Ok(Environment::new(vec![Object::new("board", mesh, None, fixed)]))
}

/// What the reference is, what it says, and how well that is known.
fn about(reference: &LandingOutcome, coarser: &LandingOutcome, cycles: usize) -> String {
    let [peak, impulse, state] = reference.errors(coarser);
    format!(
        "{} s. Reference of all methods: dry friction as it is, extrapolated; peak {:.1} N, impulse {:.3} N s, known to {peak:.0e} N, \
         {impulse:.0e} N s, {state:.0e}. Numbers: ramps [rad/s].",
        cycles as f64 * CYCLE,
        reference.peak,
        reference.impulse
    )
}

/// Another program's points beside ours, each against its own smallest step of the same integrator.
fn overlay(ours: &ErrorChart, peers: &Peers) -> Option<ErrorChart> {
    let title = format!("Dropped by 10 mm, type 2 and {}", peers.peer);
    let mut chart = ErrorChart::new("settle_peers.peak", &title, &ours.measure).about(&format!(
        "{}: soft contact, position servos; so each integrator against its own smallest step, and not against ours.",
        peers.peer
    ));
    for integrator in ["Euler", "implicitfast", "RK4"] {
        let scene = [("scene", "settle"), ("model", "lola_layer"), ("integrator", integrator)];
        let step = |p: &Value| p["step_s"].as_f64().unwrap_or(f64::INFINITY);
        let mut found: Vec<&Value> = peers.of(&scene).collect();
        found.sort_by(|a, b| step(a).total_cmp(&step(b)));
        let (finest, rest) = found.split_first()?;
        let reference = finest["peak_normal_n"].as_f64()?;
        for point in rest {
            let peak = point["peak_normal_n"].as_f64().unwrap_or(f64::NAN);
            chart.add(peers.point(point, |_| (peak - reference).abs()));
        }
    }
    ours.points.iter().for_each(|p| chart.add(p.clone()));
    Some(chart)
}
