//! Model depth: the whole chain walks on models of type 1 to 5, and each type is held against type 5.
//!
//! The reference is type 5 in the limit of small steps, from walks with steps of 0.0125 ms, 0.025 ms and 0.05 ms
//! (`reference.rs`); the order that these three show of each quantity is measured beside the method's.
//!
//! | chart | difference from type 5 of |
//! |---|---|
//! | inclination | direction of the torso's axis, root mean square over time \[rad\] |
//! | force | normal force of each foot, root mean square over time \[N\] |
//! | torque | greatest torque of a joint, toes left out \[N m\] |
//! | current | greatest current of a motor, which type 1 does not have \[A\] |
//! | tracking | greatest distance of a joint from its target \[rad\], which is zero for type 1 |
//!
//! Torques are those of the gears' output sides: what the motion of the bodies takes less what the ground gives, with
//! speeds and accelerations by central differences over a bus cycle, alike for all types. A point's note has the figure
//! itself; of inclination and force it has the greatest difference.

use std::error::Error;

use config::Setup;
use config::method::Integrator;
use messages::{JointTargets, SimState};
use multibody::{Data, Frame, Model};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use realtime::clock::{now, processor_time};

use sim_backend::external_plant::ExternalPlant;

use super::{AccuracyInput, ConvergenceOrder, ErrorChart, Point};
use chain::Chain;

/// Differences below this, in any unit, are rounding of what the bus carries.
const LEAST: f64 = 1e-6;
/// Scenes, from when to when each is looked at, and when its push comes \[s\]; scenes are not walked to their end.
const SCENES: [(&str, [f64; 2], f64); 5] = [
    ("stand", [0.5, 3.0], 0.0),
    ("walk_1kmh", [4.0, 8.0], 0.0),
    ("walk_2kmh", [4.0, 8.0], 0.0),
    ("board", [4.0, 9.0], 0.0),
    ("push", [4.5, 7.5], 5.5),
];
/// Types and steps in a cycle; the reference is extrapolated from the last ones.
const MODELS: [(u8, u32); 12] =
    [(1, 4), (1, 10), (2, 4), (2, 10), (3, 4), (3, 10), (4, 4), (5, 4), (5, 10), (5, 20), (5, 40), (5, 80)];

/// The plant behind a socket, if there is one.
const PLANT: (u8, u32) = (0, 0);

/// Charts, and their units in notes.
const QUANTITIES: [(&str, &str, &str); 5] = [
    ("inclination", "inclination, rms over time [rad]", "rad"),
    ("force", "normal force of a foot, rms over time [N]", "N"),
    ("torque", "peak torque of a joint [N m]", "N m"),
    ("current", "peak current of a motor [A]", "A"),
    ("tracking", "greatest tracking error of a joint [rad]", "rad"),
];

/// Charts of all scenes.
///
/// # Errors
/// A configuration is wrong.
pub fn charts(given: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let mut all = Vec::new();
    for (scene, span, push) in SCENES {
        let title = format!("Model depth: difference from type 5, {scene}");
        let mut charts =
            QUANTITIES.map(|(name, what, _)| ErrorChart::new(&format!("depth_{scene}.{name}"), &title, what));
        let walks = given
            .plant
            .map(|_| PLANT)
            .into_iter()
            .chain(MODELS)
            .map(|model| WalkOutputs::new(given, scene, (span, push), model))
            .collect::<Result<Vec<_>, _>>()?;
        let [.., coarse, middle, fine] = &walks[..] else { continue };
        let [reference, coarser] =
            [(fine, middle), (middle, coarse)].map(|(fine, coarse)| WalkOutputs::limit(fine, coarse));
        let [begin, end] = span;
        charts[0].about = format!(
            "The whole chain on each type, {begin} s to {end} s. Reference: type 5 in the limit of small steps, by 0.0125 ms and 0.025 ms."
        );
        for (chart, known) in charts.iter_mut().zip(reference.differences(&coarser)) {
            chart.measure += &known.map_or(String::new(), |(error, ..)| format!(", known to {error:.0e}"));
        }
        for walk in &walks {
            let values = walk.differences(&reference);
            for ((chart, value), (_, _, unit)) in charts.iter_mut().zip(values).zip(QUANTITIES) {
                let Some((error, itself, of_reference)) = value else { continue };
                let note = if walk.fell { "fell".into() } else { note(itself, of_reference, unit) };
                let error = error.max(LEAST);
                chart.add(Point { error, note: Some(note), diverged: walk.fell, ..walk.point(scene) });
            }
        }
        // The order by three steps, each half of the one before: how much less the second halving changes than the first.
        let changes = [coarse.differences(middle), middle.differences(fine)];
        for (k, chart) in charts.iter_mut().enumerate() {
            let [first, second] = changes.map(|c| c[k].map_or(f64::NAN, |(change, ..)| change));
            let (chart_name, method) =
                (chart.name.clone(), "semi_implicit, type 5, 0.05 ms to 0.0125 ms".into());
            let measured = (first / second).log2();
            chart.orders.push(ConvergenceOrder { chart: chart_name, method, predicted: 1.0, measured });
        }
        all.extend(charts);
    }
    Ok(all)
}

fn note(itself: f64, of_reference: f64, unit: &str) -> String {
    if of_reference.is_finite() {
        format!("{itself:.4} {unit}, type 5: {of_reference:.4} {unit}")
    } else {
        format!("at most {itself:.4} {unit}")
    }
}

/// What is looked at of a walk.
struct WalkOutputs {
    model: (u8, u32),
    /// \[s\] Bus cycle.
    cycle: f64,
    fell: bool,
    cpu_s_per_s: f64,
    /// Torso's axis, world axes, in each cycle.
    axis: Vec<Vector3<f64>>,
    /// \[N\]
    force: Vec<[f64; 2]>,
    /// \[N m\]
    torque: f64,
    /// \[A\]
    current: Option<f64>,
    /// \[rad\]
    tracking: f64,
}

impl WalkOutputs {
    fn new(
        given: &AccuracyInput<'_>,
        scene: &str,
        ([from, end], push): ([f64; 2], f64),
        (depth, steps): (u8, u32),
    ) -> Result<Self, Box<dyn Error>> {
        let mut setup = Setup::load(given.config, scene)?;
        let plant = given.plant.filter(|_| (depth, steps) == PLANT);
        if plant.is_none() {
            setup.scene.depth = depth;
            setup.scene.integrator = if depth == 1 { Integrator::Euler } else { Integrator::SemiImplicit };
            setup.scene.substeps = steps;
        }
        setup.scene.pushes.iter_mut().for_each(|(time, _)| *time = push);
        setup.scene.commands.retain(|(time, _)| *time < end);
        let cycle = setup.scene.cycle;
        let cycles = (end / cycle) as usize;
        let mut chain = Chain::new(&setup)?;
        let mut plant = plant.map(|socket| ExternalPlant::connect(socket, &setup)).transpose()?;
        let (mut states, mut targets) = (Vec::with_capacity(cycles), Vec::with_capacity(cycles));
        let mut current = None;
        // A plant's processor time is its own; what can be seen of it is how long everything took.
        let clock = if plant.is_some() { now } else { processor_time };
        let begun = clock();
        for _ in 0..cycles {
            let c = match &mut plant {
                Some(plant) => chain.step_with(plant)?,
                None => chain.step(),
            };
            for i in c.sensors.motor_current.iter().filter(|i| i.is_finite() && c.sim_state.time > from) {
                current = Some(i.abs().max(current.unwrap_or(0.0)));
            }
            states.push(c.sim_state);
            targets.push(c.joint_targets);
        }
        let cpu = (clock() - begun) as f64 * 1e-9;
        states.retain(|s| s.time > from);
        let torque = Torques::new(&setup)?.greatest(&states, cycle);
        let begin = cycles - states.len();
        Ok(Self {
            model: (depth, steps),
            cycle,
            fell: states.last().is_some_and(|s| s.fallen == 1),
            cpu_s_per_s: cpu / end,
            axis: states.iter().map(axis).collect(),
            force: states.iter().map(|s| s.foot_wrench.map(|w| w.force[2])).collect(),
            torque,
            current: current.filter(|_| depth > 1),
            tracking: tracking(&states, &targets[begin..], setup.robot.joints.len()),
        })
    }

    /// The limit of small steps, by two walks of which one has steps twice as long.
    fn limit(fine: &Self, coarse: &Self) -> Self {
        let of = |f: f64, c: f64| 2.0 * f - c;
        let pairs = fine.force.iter().zip(&coarse.force);
        Self {
            fell: fine.fell || coarse.fell,
            axis: fine.axis.iter().zip(&coarse.axis).map(|(f, c)| (2.0 * f - c).normalize()).collect(),
            force: pairs.map(|(f, c)| [of(f[0], c[0]), of(f[1], c[1])]).collect(),
            torque: of(fine.torque, coarse.torque),
            current: fine.current.zip(coarse.current).map(|(f, c)| of(f, c)),
            tracking: of(fine.tracking, coarse.tracking),
            ..*fine
        }
    }

    /// Difference, own figure and that of the reference, by quantity.
    fn differences(&self, reference: &Self) -> [Option<(f64, f64, f64)>; 5] {
        let tilt = self.axis.iter().zip(&reference.axis).map(|(a, b)| a.cross(b).norm());
        let force = self.force.iter().zip(&reference.force);
        let force = force.flat_map(|(a, b)| [0, 1].map(|foot| (a[foot] - b[foot]).abs()));
        let peak = |a: f64, b: f64| ((a - b).abs(), a, b);
        [
            Some(over_time(tilt)),
            Some(over_time(force)),
            Some(peak(self.torque, reference.torque)),
            self.current.zip(reference.current).map(|(a, b)| peak(a, b)),
            Some(peak(self.tracking, reference.tracking)),
        ]
    }

    fn point(&self, scene: &str) -> Point {
        let (depth, steps) = self.model;
        let (model, method) = match (self.model, depth) {
            (PLANT, _) => ("external plant".into(), "wall time"),
            (_, 1) => ("type 1".into(), "euler"),
            _ => (format!("type {depth}"), "semi_implicit"),
        };
        Point {
            scene: scene.into(),
            model,
            method: method.into(),
            step: (self.model != PLANT).then(|| self.cycle / f64::from(steps)),
            cpu_s_per_s: Some(self.cpu_s_per_s),
            ..Point::default()
        }
    }
}

/// Root mean square and greatest of differences.
fn over_time(differences: impl Iterator<Item = f64>) -> (f64, f64, f64) {
    let (mut n, mut square, mut most) = (0.0, 0.0, 0.0f64);
    for d in differences {
        (n, square, most) = (n + 1.0, square + d * d, most.max(d));
    }
    ((square / n).sqrt(), most, f64::NAN)
}

fn orientation(s: &SimState) -> UnitQuaternion<f64> {
    let [x, y, z, w] = s.orientation;
    UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
}

fn axis(s: &SimState) -> Vector3<f64> {
    orientation(s) * Vector3::z()
}

/// \[rad\] Greatest distance of a joint from where it was told to be at the end of the cycle.
fn tracking(states: &[SimState], targets: &[JointTargets], joints: usize) -> f64 {
    let of = |s: &SimState, t: &JointTargets| {
        (0..joints).map(|j| (s.joint_angle[j] - t.angle[j]).abs()).fold(0.0, f64::max)
    };
    states.iter().zip(targets).map(|(s, t)| of(s, t)).fold(0.0, f64::max)
}

/// Torques of joints from motion and contact, by inverse dynamics without rotors.
struct Torques {
    model: Model,
    data: Data,
    soles: [Frame; 2],
    /// Whether a joint counts.
    wanted: Vec<bool>,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    force: Vec<f64>,
}

impl Torques {
    fn new(setup: &Setup) -> Result<Self, Box<dyn Error>> {
        let robot = &setup.robot;
        let model = robot.model()?;
        let sole = |i: usize| model.frame(&robot.feet[i].link, robot.feet[i].sole);
        let toe = |j| robot.feet.iter().any(|f| f.toe == Some(j));
        Ok(Self {
            soles: [sole(0)?, sole(1)?],
            wanted: (0..model.n()).map(|j| !toe(j)).collect(),
            data: Data::new(&model),
            q: model.neutral(),
            v: vec![0.0; model.nv()],
            a: vec![0.0; model.nv()],
            force: vec![0.0; model.nv()],
            model,
        })
    }

    /// \[N m\] The greatest one of all.
    fn greatest(&mut self, states: &[SimState], cycle: f64) -> f64 {
        let walking = states.windows(3).filter(|w| w[2].fallen == 0);
        walking.map(|w| self.at([&w[0], &w[1], &w[2]], cycle)).fold(0.0, f64::max)
    }

    /// \[N m\] The greatest one in the middle of three cycles.
    fn at(&mut self, [before, now, after]: [&SimState; 3], h: f64) -> f64 {
        let Self { model, data, soles, q, v, a, force, .. } = self;
        q[..3].copy_from_slice(&now.position);
        q[3..7].copy_from_slice(&now.orientation);
        let base = |s: &SimState, i: usize| if i < 3 { s.velocity[i] } else { s.angular_velocity[i - 3] };
        for i in 0..6 {
            (v[i], a[i]) = (base(now, i), (base(after, i) - base(before, i)) / (2.0 * h));
        }
        for j in 0..model.n() {
            let [b, n, e] = [before, now, after].map(|s| s.joint_angle[j]);
            q[7 + j] = n;
            v[6 + j] = (e - b) / (2.0 * h);
            a[6 + j] = (e - 2.0 * n + b) / (h * h);
        }
        model.forward_kinematics(data, q);
        model.inverse_dynamics_here(data, v, a, force);
        for (sole, wrench) in soles.iter().zip(&now.foot_wrench) {
            let (f, m) = (-Vector3::from(wrench.force), -Vector3::from(wrench.moment));
            model.add_wrench(data, sole, &f, &m, force);
        }
        let torques = force[6..].iter().zip(&self.wanted).filter(|(_, wanted)| **wanted);
        torques.map(|(t, _)| t.abs()).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motion that forward dynamics has made of known torques gives them back.
    #[test]
    fn torques_that_made_a_motion_are_found_in_it() {
        let setup = Setup::load(&config::root(None), "stand").unwrap();
        let mut torques = Torques::new(&setup).unwrap();
        let (model, h) = (&torques.model, 1e-5);
        let mut data = Data::new(model);
        let mut q = model.neutral();
        q[7..].copy_from_slice(&setup.robot.poses["stand"]);
        let (mut v, mut next, mut a) = (vec![0.0; model.nv()], q.clone(), vec![0.0; model.nv()]);
        let mut force: Vec<f64> =
            (0..model.nv()).map(|i| if i < 6 { 0.0 } else { (i as f64).sin() }).collect();
        force[6 + 3] = 40.0; // the greatest
        let mut states = Vec::new();
        for k in 0..6 {
            let mut s = SimState { time: 1.0 + f64::from(k) * h, ..SimState::default() };
            s.position.copy_from_slice(&q[..3]);
            s.orientation.copy_from_slice(&q[3..7]);
            s.velocity.copy_from_slice(&v[..3]);
            s.angular_velocity.copy_from_slice(&v[3..6]);
            s.joint_angle[..model.n()].copy_from_slice(&q[7..]);
            states.push(s);
            model.forward_dynamics(&mut data, &q, &v, &force, &mut a);
            for (v, a) in v.iter_mut().zip(&a) {
                *v += h * a;
            }
            model.integrate(&q, &v, h, &mut next);
            q.copy_from_slice(&next);
        }
        let found = torques.at([&states[2], &states[3], &states[4]], h);
        assert!((found - 40.0).abs() < 0.02, "{found} N m instead of 40");
    }
}
