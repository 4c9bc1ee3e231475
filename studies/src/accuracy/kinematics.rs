//! Kinematics in the loop: Newton steps of the inverse kinematics in a control cycle, and look-up tables of the drives.
//!
//! The controller integrates joint speeds (5.38), one step in a cycle, and feeds the drift back. Here both feet follow
//! a step of the swing foot that is known as a function of time; the error is that of the feet's way.

use std::error::Error;
use std::f64::consts::PI;
use std::hint::black_box;

use config::{Robot, Setup};
use controller::inverse_kinematics::{InverseKinematics, JointVector, TaskJacobian, TaskVector};
use controller::task_space::TaskSpace;
use drives::Transmission;
use drives::lookup::LookupTable;
use messages::{LEFT, MAX_JOINTS, RIGHT};
use nalgebra::{Matrix3, Vector3};

use super::order::in_ms;
use super::{AccuracyInput, Cost, ErrorChart, Point, cost};

/// \[s\] Length of a step, and the cycles it is followed in.
const STEP: f64 = 0.8;
const CYCLES: [f64; 5] = [1e-3, 2e-3, 4e-3, 8e-3, 16e-3];
/// \[m\] Way of the swing foot forwards, and how high it is lifted; the stance foot goes back as far.
const WAY: [f64; 2] = [0.15, 0.05];
/// Points in each direction of a table.
const TABLES: [usize; 7] = [5, 9, 17, 33, 65, 129, 257];

/// Both charts.
///
/// # Errors
/// A configuration is wrong.
pub fn charts(given: &AccuracyInput<'_>) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let setup = Setup::load(given.config, "walk_1kmh")?;
    let mut charts = vec![inverse(&setup)?];
    charts.extend(tables(&setup.robot)?);
    Ok(charts)
}

/// What is done in a cycle.
#[derive(Clone, Copy)]
enum TrackingMethod {
    /// Joint speeds of the feet's speed at the cycle's begin, and the gain \[1/s\] on the drift.
    Speeds(f64),
    /// So many Newton steps to where the feet are to be at its end.
    Newton(usize),
}

fn inverse(setup: &Setup) -> Result<ErrorChart, Box<dyn Error>> {
    let mut chart = ErrorChart::new(
        "inverse_kinematics",
        "Steps of the inverse kinematics in a cycle",
        "error of the feet [m, rad]",
    )
    .over(Cost::PerCall)
    .about(
        "A step of 0.8 s: greatest error of a sole's position and orientation against the centre of gravity.",
    );
    let gain = setup.gait.control.drift_gain;
    let ways = [
        ("speeds alone", TrackingMethod::Speeds(0.0)),
        ("speeds with drift fed back", TrackingMethod::Speeds(gain)),
        ("1 Newton step", TrackingMethod::Newton(1)),
        ("2 Newton steps", TrackingMethod::Newton(2)),
        ("3 Newton steps", TrackingMethod::Newton(3)),
    ];
    for (name, way) in ways {
        for cycle in CYCLES {
            let mut leg = Following::new(setup)?;
            let (error, seconds) = cost::of(|| leg.follow(cycle, way));
            chart.add(Point {
                scene: "step of 0.8 s".into(),
                method: name.into(),
                step: Some(cycle),
                solver: Some(in_ms(cycle)),
                cpu_us: Some(1e6 * seconds / (STEP / cycle).round()),
                error: error.max(f64::EPSILON), // of metres: nothing less can be drawn
                ..Point::default()
            });
        }
    }
    Ok(chart)
}

/// A robot whose feet follow a way.
struct Following {
    space: TaskSpace,
    kinematics: InverseKinematics,
    pose: Vec<f64>,
    /// Where the feet are against the centre of gravity at the begin.
    begin: [(Vector3<f64>, Matrix3<f64>); 2],
    jacobian: TaskJacobian,
}

impl Following {
    fn new(setup: &Setup) -> Result<Self, Box<dyn Error>> {
        let robot = &setup.robot;
        let mut space = TaskSpace::new(robot)?;
        let pose = robot.poses[&setup.scene.start_pose].clone();
        space.update(&pose);
        let begin = [RIGHT, LEFT].map(|foot| place(&space, foot));
        let free = space.leg_joints(robot);
        let kinematics = InverseKinematics::new(&robot.joints, &free, 0.0);
        Ok(Self { space, kinematics, pose, begin, jacobian: TaskJacobian::zeros() })
    }

    /// Greatest error on the way.
    fn follow(&mut self, cycle: f64, way: TrackingMethod) -> f64 {
        let mut q = self.pose.clone();
        let mut worst = 0.0f64;
        self.space.update(&q);
        for k in 0..(STEP / cycle).round() as usize {
            let (now, next) = (k as f64 * cycle, (k + 1) as f64 * cycle);
            match way {
                TrackingMethod::Speeds(gain) => {
                    let wanted = self.speed(now) + gain * self.error(now);
                    self.step(&mut q, &wanted, cycle);
                }
                TrackingMethod::Newton(steps) => {
                    for _ in 0..steps {
                        let wanted = self.error(next);
                        self.step(&mut q, &wanted, 1.0);
                    }
                }
            }
            worst = worst.max(self.error(next).amax());
        }
        worst
    }

    fn step(&mut self, q: &mut [f64], wanted: &TaskVector, h: f64) {
        self.space.task_jacobian(&mut self.jacobian);
        let factorised = self.kinematics.factorise(&self.jacobian);
        let speeds = self.kinematics.speeds(&factorised, wanted, &JointVector::zeros(), q, 1.0);
        for (q, speed) in q.iter_mut().zip(speeds.iter().take(MAX_JOINTS)) {
            *q += h * speed;
        }
        self.space.update(q);
    }

    /// Distance from where the feet are to be at `t` \[s\].
    fn error(&self, t: f64) -> TaskVector {
        let mut error = TaskVector::zeros();
        for foot in [RIGHT, LEFT] {
            let (position, rotation) = place(&self.space, foot);
            let (p0, r0) = self.begin[foot];
            let r = r0 * rotation.transpose();
            // The axis times the sine of the angle, which small angles keep to all digits.
            let turn = 0.5 * Vector3::new(r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12);
            error.fixed_rows_mut::<3>(6 * foot).copy_from(&(p0 + way(foot, t).0 - position));
            error.fixed_rows_mut::<3>(6 * foot + 3).copy_from(&turn);
        }
        error
    }

    fn speed(&self, t: f64) -> TaskVector {
        let mut speed = TaskVector::zeros();
        for foot in [RIGHT, LEFT] {
            speed.fixed_rows_mut::<3>(6 * foot).copy_from(&way(foot, t).1);
        }
        speed
    }
}

fn place(space: &TaskSpace, foot: usize) -> (Vector3<f64>, Matrix3<f64>) {
    let sole = space.sole(foot);
    (sole.position - space.com(), sole.rotation)
}

/// Way and speed of a foot at `t` \[s\], torso axes: the right one swings.
fn way(foot: usize, t: f64) -> (Vector3<f64>, Vector3<f64>) {
    let (w, [along, lift]) = (PI / STEP, WAY);
    let (s, c) = (w * t).sin_cos();
    let forward = if foot == RIGHT { along } else { -along };
    let up = if foot == RIGHT { lift } else { 0.0 };
    // Height sin^2, forwards as a half wave from rest to rest.
    let position = Vector3::new(0.5 * forward * (1.0 - c), 0.0, up * s * s);
    (position, Vector3::new(0.5 * forward * w * s, 0.0, 2.0 * up * w * s * c))
}

/// Tables of a knee and an ankle.
fn tables(robot: &Robot) -> Result<Vec<ErrorChart>, Box<dyn Error>> {
    let mut angle = ErrorChart::new(
        "lookup.angle",
        "Look-up tables of the drives' linkages",
        "error of the motor's angle [rad]",
    )
    .over(Cost::PerCall);
    let mut ratio = ErrorChart::new("lookup.ratio", "", "error of the ratio [1]").over(Cost::PerCall);
    let mut about = "Linear interpolation over the joints' whole ranges. Without a table:".to_owned();
    for (name, joints) in [("knee", 1), ("ankle", 3)] {
        let wanted = |d: &&config::robot::Drive| {
            d.transmission.joints() == joints && !matches!(d.transmission, Transmission::Harmonic { .. })
        };
        let Some(drive) = robot.drives.iter().find(wanted) else { continue };
        let ranges: Vec<[f64; 2]> = drive.joints.iter().map(|&j| robot.joints[j].range).collect();
        let ranges = if joints == 3 { [ranges[1], ranges[2]] } else { [ranges[0]; 2] };
        let places = places(ranges, joints);
        let transmission = &drive.transmission;
        let ((), direct) = cost::of(|| {
            for q in &places {
                let _ = black_box(transmission.at(black_box(*q), [0.0; 3]));
            }
        });
        about += &format!(" {name} {:.0} ns.", 1e9 * direct / places.len() as f64);
        for points in TABLES {
            let table = LookupTable::new(transmission, ranges, [points; 2])?;
            let ((), seconds) = cost::of(|| {
                for q in &places {
                    let _ = black_box(table.at(black_box(*q)));
                }
            });
            let mut errors = [0.0f64; 2];
            for q in &places {
                let (exact, (angle, ratio)) = (transmission.at(*q, [0.0; 3])?, table.at(*q)?);
                errors[0] = errors[0].max((angle - exact.angle).abs());
                errors[1] = (0..3).map(|k| (ratio[k] - exact.ratio[k]).abs()).fold(errors[1], f64::max);
            }
            for (chart, error) in [&mut angle, &mut ratio].into_iter().zip(errors) {
                chart.add(Point {
                    scene: name.into(),
                    method: "table".into(),
                    step: Some(1.0 / (points - 1) as f64),
                    solver: Some(format!("{points} points")),
                    cpu_us: Some(1e6 * seconds / places.len() as f64),
                    error,
                    ..Point::default()
                });
            }
        }
    }
    Ok(vec![angle.about(&about), ratio])
}

/// Joint angles over the ranges, which share no cell with a table.
fn places(ranges: [[f64; 2]; 2], joints: usize) -> Vec<[f64; 3]> {
    const FINE: usize = 83;
    let at = |[low, high]: [f64; 2], i: usize| low + (high - low) * (i as f64 + 0.37) / FINE as f64;
    let all = (0..FINE).flat_map(|i| (0..FINE).map(move |j| (i, j)));
    all.map(|(i, j)| {
        if joints == 3 {
            [0.7, at(ranges[0], i), at(ranges[1], j)]
        } else {
            [at(ranges[0], (i * 37 + j) % FINE), 0.0, 0.0]
        }
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speed_is_the_derivative_of_the_way() {
        for foot in [RIGHT, LEFT] {
            for t in [0.1, 0.33, 0.7] {
                let h = 1e-6;
                let slope = (way(foot, t + h).0 - way(foot, t - h).0) / (2.0 * h);
                assert!((slope - way(foot, t).1).amax() < 1e-8);
            }
        }
    }

    /// Speeds alone drift with the first power of the cycle; Newton's error squares with every step.
    #[test]
    fn orders() {
        let setup = Setup::load(&config::root(None), "walk_1kmh").unwrap();
        let mut leg = Following::new(&setup).unwrap();
        let mut error = |cycle, way| leg.follow(cycle, way);
        let drift = error(8e-3, TrackingMethod::Speeds(0.0)) / error(4e-3, TrackingMethod::Speeds(0.0));
        assert!((drift - 2.0).abs() < 0.2, "{drift}");
        let once = error(8e-3, TrackingMethod::Newton(1));
        let twice = error(8e-3, TrackingMethod::Newton(2));
        assert!(twice < 10.0 * once * once, "{once} {twice}");
    }
}
