//! Walking, local errors: what a method adds in one control period.
//!
//! Errors of a closed loop grow and shrink with what the stabilizer makes of them; so each method begins every sampled
//! control period where the reference is, with the recorded joint targets, and is judged at its end. The error is the mean
//! over the sampled periods of the greatest component's:
//!
//! | chart | components |
//! |---|---|
//! | pose | torso's position \[m\] and orientation \[rad\], joint angles \[rad\] |
//! | force | normal force of each foot \[N\] |

use std::error::Error;

use config::Setup;
use config::method::Integrator;
use sim_backend::drive::JointCubic;
use sim_backend::plant::{Plant, orientation};
use sim_backend::terrain;

use super::methods::IntegrationMethod;
use super::{AccuracyInput, ErrorChart, Point, cost};
use crate::second::Second;

/// \[s\] The gait is periodic by then.
const BEGIN: f64 = 8.0;
/// Cycles that are walked ...
const CYCLES: usize = 1000;
/// ... of which so many are sampled; fewer where the contact takes long.
const SAMPLES: usize = 50;
const FEW: usize = 25;
/// Steps in a cycle with which the state is brought from sample to sample.
const BETWEEN: u32 = 20;

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

/// Sampled periods of a walk: how the joints are to move, where each begins and where it is to end.
struct Samples {
    drives: Vec<Vec<JointCubic>>,
    begins: Vec<Vec<f64>>,
    ends: Vec<PeriodEnd>,
}

/// Where a period ended.
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
    let methods = IntegrationMethod::all(depth);
    let samples = [false, true].map(|exact_friction| {
        let wanted = methods.iter().any(|m| m.exact_friction() == exact_friction);
        wanted.then(|| Samples::new(&second, &mut plant, exact_friction, depth))
    });
    let title = format!("Walking: {scene}, model of type {depth}");
    let about = about(&samples, &plant);
    let name = |what| format!("{scene}_type{depth}.{what}");
    let mut charts = [
        ErrorChart::new(&name("pose"), &title, "error of pose in a period [m, rad]").about(&about),
        ErrorChart::new(&name("force"), &title, "error of the normal force [N]"),
    ];
    for method in methods {
        let Some(samples) = &samples[usize::from(method.exact_friction())] else { continue };
        let (point, errors) = samples.judge(&second, &mut plant, &method);
        for (chart, error) in charts.iter_mut().zip(errors) {
            let named = method.point(scene, depth, second.cycle);
            chart.add(Point { cpu_s_per_s: point.cpu_s_per_s, note: point.note.clone(), error, ..named });
        }
    }
    Ok(charts)
}

/// What the references are, and how far they are from each other.
fn about(samples: &[Option<Samples>; 2], plant: &Plant) -> String {
    let mut text = "Each sampled period begins at the reference; mean of greatest errors.".to_owned();
    if let [Some(smooth), Some(exact)] = samples {
        let apart = smooth.ends.iter().zip(&exact.ends).map(|(a, b)| errors(plant, a, b)[0]);
        text += &format!(
            " Friction is smoothed but for semi_implicit: {:.0e} apart at most.",
            apart.fold(0.0, f64::max)
        );
    }
    text
}

impl Samples {
    fn new(second: &Second, plant: &mut Plant, exact_friction: bool, depth: u8) -> Self {
        let wanted = if depth > 3 { FEW } else { SAMPLES };
        let between = IntegrationMethod::stepping(
            IntegrationMethod::reference(exact_friction, depth, 1).integrator,
            BETWEEN,
        );
        let reference = IntegrationMethod::reference(exact_friction, depth, if depth > 3 { 4 } else { 10 });
        let mut x = second.state.clone();
        let mut steppers = [between, reference].map(|m| m.stepper(x.len()));
        let mut samples = Self { drives: Vec::new(), begins: Vec::new(), ends: Vec::new() };
        for cycle in 0..second.cycles() {
            let drives: Vec<JointCubic> = second.drives(cycle).collect();
            if cycle % (second.cycles() / wanted) == 0 {
                let mut end = x.clone();
                second.advance(plant, &mut steppers[1], reference.steps, &drives, &mut end);
                samples.ends.push(PeriodEnd::new(plant, second.cycle, &drives, end));
                samples.begins.push(x.clone());
                samples.drives.push(drives.clone());
            }
            second.advance(plant, &mut steppers[0], between.steps, &drives, &mut x);
        }
        samples
    }

    /// What a method costs, and its errors of pose and force.
    fn judge(&self, second: &Second, plant: &mut Plant, method: &IntegrationMethod) -> (Point, [f64; 2]) {
        let mut stepper = method.stepper(second.state.len());
        let mut states = self.begins.clone();
        let (gave_up, seconds) = cost::of(|| {
            let mut gave_up = 0;
            for ((x, begin), drives) in states.iter_mut().zip(&self.begins).zip(&self.drives) {
                x.copy_from_slice(begin);
                second.advance(plant, &mut stepper, method.steps, drives, x);
                gave_up += usize::from(stepper.take_gave_up().is_some());
            }
            gave_up
        });
        let n = states.len();
        let mut sums = [0.0; 2];
        for ((x, drives), reference) in states.into_iter().zip(&self.drives).zip(&self.ends) {
            let end = PeriodEnd::new(plant, second.cycle, drives, x);
            for (sum, error) in sums.iter_mut().zip(errors(plant, &end, reference)) {
                *sum += error / n as f64;
            }
        }
        let point = Point {
            cpu_s_per_s: Some(seconds / (n as f64 * second.cycle)),
            note: (gave_up > 0).then(|| format!("gave up in {gave_up} of {n} periods")),
            ..Point::default()
        };
        (point, sums)
    }
}

impl PeriodEnd {
    fn new(plant: &mut Plant, cycle: f64, drives: &[JointCubic], state: Vec<f64>) -> Self {
        let force = plant.snapshot(cycle, &state, drives).foot_wrench.map(|w| w.force[2]);
        Self { state, force }
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
