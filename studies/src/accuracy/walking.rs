//! Walking, local errors: what a method adds in ten control periods.
//!
//! Errors of a closed loop grow and shrink with what the stabilizer makes of them; so each method begins every sample where
//! the reference is, with the recorded joint targets, and is judged at its end: late enough that a step which is not stable
//! shows, and that an adaptive method has come to its order. The error is the mean over the samples of the greatest
//! component's:
//!
//! | chart | components |
//! |---|---|
//! | pose | torso's position \[m\] and orientation \[rad\], joint angles \[rad\] |
//! | force | normal force of each foot \[N\] |

use std::error::Error;

use config::Setup;
use config::method::Integrator;
use config::scene::FRICTION_RAMP;
use sim_backend::drive::JointCubic;
use sim_backend::integrate::Stepper;
use sim_backend::plant::{Plant, orientation};
use sim_backend::terrain;

use super::methods::{IntegrationMethod, beyond};
use super::reference::{limit, limits};
use super::{AccuracyInput, ErrorChart, Point, cost};
use crate::second::Second;

/// \[s\] The gait is periodic by then.
const BEGIN: f64 = 8.0;
/// Cycles that are walked ...
const CYCLES: usize = 1000;
/// ... of which so many are sampled; fewer where the contact takes long.
const SAMPLES: usize = 50;
const FEW: usize = 25;
/// Cycles of a sample.
const LENGTH: usize = 10;
/// Steps in a cycle with which the state is brought from sample to sample.
const BETWEEN: u32 = 20;

/// \[m, rad\] Beyond this error of the pose a robot is lost.
const LOST: f64 = 0.5;

/// Scenes and types of model.
const WALKS: [(&str, u8); 11] = [
    ("walk_1kmh", 1),
    ("walk_1kmh", 2),
    ("walk_1kmh", 3),
    ("walk_1kmh", 4),
    ("walk_1kmh", 5),
    ("walk_2kmh", 1),
    ("walk_2kmh", 2),
    ("walk_2kmh", 3),
    ("walk_3kmh", 1),
    ("walk_3kmh", 2),
    ("walk_3kmh", 3),
];

/// Charts of all walks.
///
/// # Errors
/// A scene cannot be loaded, or a robot falls.
pub fn charts(given: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let mut charts = Vec::new();
    for (scene, depth) in WALKS {
        charts.extend(walk(given, scene, depth)?);
    }
    Ok(charts)
}

/// Samples of a walk: how the joints are to move in each cycle, where each begins and where it is to end.
struct Samples {
    drives: Vec<Vec<Vec<JointCubic>>>,
    begins: Vec<Vec<f64>>,
    ends: Vec<PeriodEnd>,
    /// Ends as the coarser steps of the reference have them.
    coarser: Vec<PeriodEnd>,
}

/// Where a sample ended.
#[derive(Clone)]
struct PeriodEnd {
    state: Vec<f64>,
    force: [f64; 2],
}

fn walk(given: &AccuracyInput<'_>, scene: &str, depth: u8) -> Result<[ErrorChart; 2], Box<dyn Error>> {
    let mut setup = Setup::load(given.config, scene)?;
    setup.scene.depth = depth;
    if depth > 1 {
        (setup.scene.integrator, setup.scene.substeps) = (Integrator::SemiImplicit, 10);
    }
    let second = Second::record(&setup, BEGIN, CYCLES)?;
    let pose = &setup.robot.poses[&setup.scene.start_pose];
    let mut plant = Plant::new(&setup.robot, terrain::environment(&setup.scene)?, depth, pose)?;
    let samples = Samples::new(&second, &mut plant, depth);
    let title = format!("Walking: {scene}, model of type {depth}");
    let known = mean(samples.ends.iter().zip(&samples.coarser).map(|(a, b)| errors(&plant, a, b)));
    let about = format!(
        "Mean of greatest errors after 10 ms from the reference, which is {} and known to {:.0e} and {:.0e} N. Numbers: ramps [rad/s].",
        if depth == 1 { "RK4" } else { "dry friction as it is" },
        known[0],
        known[1]
    );
    let name = |what| format!("{scene}_type{depth}.{what}");
    let mut charts = [
        ErrorChart::new(&name("pose"), &title, "error of pose after 10 ms [m, rad]").about(&about),
        ErrorChart::new(&name("force"), &title, "error of the normal force [N]"),
    ];
    for method in IntegrationMethod::all(depth) {
        let (point, errors) = samples.judge(&second, &mut plant, &method);
        let named = method.point(scene, depth, second.cycle);
        let stable = method.limit(&setup.robot, depth, pose)?;
        let note = point.note.clone().or_else(|| beyond(named.step, stable));
        for (chart, error) in charts.iter_mut().zip(errors) {
            if let Some(stable) = stable {
                chart.limit(&named.method, stable);
            }
            chart.add(Point { cpu_s_per_s: point.cpu_s_per_s, note: note.clone(), error, ..named.clone() });
        }
    }
    Ok(charts)
}

impl Samples {
    fn new(second: &Second, plant: &mut Plant, depth: u8) -> Self {
        let every = second.cycles() / if depth > 3 { FEW } else { SAMPLES };
        let references = IntegrationMethod::references(depth);
        let between = IntegrationMethod::stepping(references[0].integrator, BETWEEN);
        let mut x = second.state.clone();
        let mut stepper = between.stepper(x.len());
        let drives: Vec<Vec<JointCubic>> = (0..second.cycles()).map(|k| second.drives(k).collect()).collect();
        let mut samples =
            Self { drives: Vec::new(), begins: Vec::new(), ends: Vec::new(), coarser: Vec::new() };
        for cycle in 0..second.cycles() {
            if cycle % every == 0 {
                let drives = &drives[cycle..cycle + LENGTH];
                let ends = references.map(|r| {
                    let mut end = x.clone();
                    replay(second, plant, &mut r.stepper(x.len()), r.steps, drives, &mut end);
                    PeriodEnd::new(plant, second.cycle, drives, end)
                });
                let [end, coarser] = limits(&ends, PeriodEnd::limit);
                samples.ends.push(end);
                samples.coarser.push(coarser);
                samples.begins.push(x.clone());
                samples.drives.push(drives.to_vec());
            }
            second.advance(plant, &mut stepper, between.steps, &drives[cycle], &mut x);
        }
        samples
    }

    /// What a method costs, and its errors of pose and force.
    fn judge(&self, second: &Second, plant: &mut Plant, method: &IntegrationMethod) -> (Point, [f64; 2]) {
        plant.set_friction_ramp(method.ramp.unwrap_or(FRICTION_RAMP));
        let mut states = self.begins.clone();
        let (gave_up, seconds) = cost::of(|| {
            let (mut gave_up, mut stepper) = (0, method.stepper(second.state.len()));
            for ((x, begin), drives) in states.iter_mut().zip(&self.begins).zip(&self.drives) {
                x.copy_from_slice(begin);
                replay(second, plant, &mut stepper, method.steps, drives, x);
                gave_up += usize::from(stepper.take_gave_up().is_some());
            }
            gave_up
        });
        let n = states.len();
        let ends: Vec<PeriodEnd> = states
            .into_iter()
            .zip(&self.drives)
            .map(|(x, drives)| PeriodEnd::new(plant, second.cycle, drives, x))
            .collect();
        let sums = mean(ends.iter().zip(&self.ends).map(|(end, reference)| errors(plant, end, reference)));
        // What has run away has no error, but is lost.
        let sums = if sums[0] < LOST { sums } else { [f64::NAN; 2] };
        let point = Point {
            cpu_s_per_s: Some(seconds / ((n * LENGTH) as f64 * second.cycle)),
            note: (gave_up > 0).then(|| format!("gave up in {gave_up} of {n} samples")),
            ..Point::default()
        };
        (point, sums)
    }
}

/// Advances `x` by the cycles of a sample.
fn replay(
    second: &Second,
    plant: &mut Plant,
    stepper: &mut Stepper,
    steps: u32,
    drives: &[Vec<JointCubic>],
    x: &mut [f64],
) {
    for drives in drives {
        second.advance(plant, stepper, steps, drives, x);
    }
}

/// Means of pairs; NaN if one is no number.
fn mean(pairs: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    let (n, sums) = pairs.fold((0.0, [0.0; 2]), |(n, [a, b]), [c, d]| (n + 1.0, [a + c, b + d]));
    sums.map(|sum| sum / n)
}

impl PeriodEnd {
    fn new(plant: &mut Plant, cycle: f64, drives: &[Vec<JointCubic>], state: Vec<f64>) -> Self {
        let force = plant.snapshot(cycle, &state, &drives[LENGTH - 1]).foot_wrench.map(|w| w.force[2]);
        Self { state, force }
    }

    fn limit(fine: &Self, coarse: &Self) -> Self {
        let force = [0, 1].map(|foot| 2.0 * fine.force[foot] - coarse.force[foot]);
        Self { state: limit(&fine.state, &coarse.state), force }
    }
}

/// Greatest errors of pose and force; NaN if one is no number.
fn errors(plant: &Plant, a: &PeriodEnd, b: &PeriodEnd) -> [f64; 2] {
    let turned = orientation(&a.state).angle_to(&orientation(&b.state));
    let joints = 7..plant.layout().pose().end;
    let moved = (0..3).chain(joints).map(|i| (a.state[i] - b.state[i]).abs());
    let pressed = (0..2).map(|foot| (a.force[foot] - b.force[foot]).abs());
    [greatest(moved.chain([turned])), greatest(pressed)]
}

/// The greatest; NaN if one is no number.
pub(super) fn greatest(errors: impl Iterator<Item = f64>) -> f64 {
    errors.fold(0.0, |most, e| if e <= most { most } else { e + 0.0 * most })
}

#[cfg(test)]
mod tests {
    use super::greatest;

    #[test]
    fn one_error_that_is_no_number_makes_all_none() {
        assert_eq!(greatest([1.0, 3.0, 2.0].into_iter()), 3.0);
        assert!(greatest([1.0, f64::NAN, 2.0].into_iter()).is_nan());
        assert!(greatest([f64::NAN].into_iter()).is_nan());
    }
}
