//! Motion: orientations (F22), straight knees (F23), energy over a minute.

use controller::inverse_kinematics::{InverseKinematics, JointVector, TaskJacobian, TaskVector};
use controller::task_space::TaskSpace;
use messages::RIGHT;
use multibody::{Data, Model};
use nalgebra::{UnitQuaternion, Vector3};

use crate::search::slope;

use super::LimitRule::{AtLeast, AtMost, Within};
use super::{Bench, Finding, Findings, Result, row, stepper};

pub(super) fn all(bench: &Bench) -> Findings {
    let mut findings = vec![orientation(bench)?];
    findings.extend(knee(bench)?);
    findings.push(oscillator());
    findings.extend(flight(bench)?);
    Ok(findings)
}

/// F22: a quaternion turns through upright like anywhere, where the thesis's z-x-z angles have a pole: their rates lose a
/// factor of 2/theta. The robot's own configuration, by the rates of the model.
fn orientation(bench: &Bench) -> Result<Finding> {
    let model = bench.setup.robot.model()?;
    // A turn of 1 rad/s through upright in steps of 10 ms, against the rotation itself; error h^4 w^5 t/1920.
    let (mut x, mut v) = (model.neutral(), vec![0.0; model.nv()]);
    (x[4], x[6], v[4]) = ((-0.25_f64).sin(), (-0.25_f64).cos(), 1.0);
    let (mut method, h) = (stepper(x.len()), 1e-2);
    for _ in 0..100 {
        method.runge_kutta_4(0.0, h, &mut x, |_, x, rate| model.configuration_rate(x, &v, rate));
    }
    let q = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(x[6], x[3], x[4], x[5]));
    let error = q.angle_to(&UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 0.5));
    let regime = "quaternion, Runge-Kutta 4 at 10 ms, 1 rad/s through upright: error after 1 s";
    Ok(row("F22", "rad", Within(1e-3)).of(regime, [h.powi(4) / 1920.0, error]))
}

/// F23: 0.1 m/s along the leg take a knee speed of 0.1/(dl/dq), without bound as the knee straightens.
fn knee(bench: &Bench) -> Findings {
    let robot = &bench.setup.robot;
    let mut space = TaskSpace::new(robot)?;
    let legs = ["hip", "knee", "ankle"];
    let free: Vec<bool> = robot.joints.iter().map(|j| legs.iter().any(|leg| j.name.contains(leg))).collect();
    let ik = InverseKinematics::new(&robot.joints, &free, 0.0);
    let bent = robot.joint("right_knee_flexion").ok_or("no joint right_knee_flexion")?;
    let model = robot.model()?;
    // Knee speed by the leg's shortening, that of the inverse kinematics, and whether it damped.
    let mut at = |q: f64| {
        let mut angles = bench.pose().to_vec();
        angles[bent] = q;
        space.update(&angles);
        let mut jacobian = TaskJacobian::zeros();
        space.task_jacobian(&mut jacobian);
        for foot in 0..2 {
            let sole = space.sole_jacobian(foot);
            jacobian.view_mut((6 * foot, 0), (6, angles.len())).copy_from(sole);
        }
        let (leg, shorter) = leg(&model, &angles, bent)?;
        let mut xd = TaskVector::zeros();
        xd.fixed_rows_mut::<3>(6 * RIGHT).copy_from(&(leg * -0.1));
        let task = ik.factorise(&jacobian);
        let speed = ik.speeds(&task, &xd, &JointVector::zeros(), &angles, 1.0)[bent];
        Ok::<_, Box<dyn std::error::Error>>((0.1 / shorter, speed, task.damped))
    };
    let mut findings = Vec::new();
    for q in [0.5, 0.1, 0.05] {
        let (predicted, speed, damped) = at(q)?;
        let regime = format!("knee at {q} rad, 0.1 m/s along the leg: its speed");
        let finding = row("F23", "rad/s", Within(1e-3)).of(regime, [predicted, speed]);
        findings.push(if damped { finding.says("damped without need", false) } else { finding });
    }
    // Nearly straight: the speed must be far less than asked for.
    let (wanted, speed, damped) = at(1e-4)?;
    let regime = "knee at 1e-4 rad: the speed asked for, over the damped one";
    findings.push(
        row("F23", "", AtLeast)
            .of(regime, [10.0, wanted / speed.abs()])
            .says("damped: true, counted as limited", damped),
    );
    Ok(findings)
}

/// Direction from hip to ankle in the torso, and by how much the leg shortens per knee angle \[m/rad\].
fn leg(model: &Model, angles: &[f64], knee: usize) -> Result<(Vector3<f64>, f64)> {
    let (hip, ankle) = (model.frame("right_thigh", [0.0; 3])?, model.frame("right_ankle", [0.0; 3])?);
    let mut data = Data::new(model);
    let mut line = |change: f64| {
        let mut q = model.neutral();
        q[7..].copy_from_slice(angles);
        q[7 + knee] += change;
        model.forward_kinematics(&mut data, &q);
        model.frame_position(&data, &ankle) - model.frame_position(&data, &hip)
    };
    let h = 1e-5;
    let shorter = (line(-h).norm() - line(h).norm()) / (2.0 * h);
    Ok((line(0.0).normalize(), shorter))
}

/// Energy that Runge-Kutta 4 takes from an undamped swing of 1 Hz in a minute of steps of 1 ms: 1 - |R(i w h)|^2 per step.
fn oscillator() -> Finding {
    let (w, h) = (std::f64::consts::TAU, 1e-3);
    let (mut method, mut x) = (stepper(2), [1.0, 0.0]);
    for _ in 0..60_000 {
        method.runge_kutta_4(0.0, h, &mut x, |_, x, dx| (dx[0], dx[1]) = (w * x[1], -w * x[0]));
    }
    let z: f64 = w * h;
    let lost = 60_000.0 * (z.powi(6) / 72.0 - z.powi(8) / 576.0);
    row("E2", "", Within(5e-3)).of(
        "swing of 1 Hz, Runge-Kutta 4 at 1 ms: share of energy lost in a minute",
        [lost, 1.0 - (x[0] * x[0] + x[1] * x[1])],
    )
}

/// Share of its energy that the robot, thrown without gravity and drives, gains or loses in steps of `h` \[s\].
fn drift(model: &Model, h: f64, seconds: f64) -> f64 {
    let (n, nq) = (model.nv(), model.nq());
    let (mut data, mut x) = (Data::new(model), model.neutral());
    x.extend((0..n).map(|i| 0.5 * (1.7 * i as f64).sin()));
    let (mut weight, still) = (vec![0.0; n], vec![0.0; n]);
    let energy = |data: &mut Data, x: &[f64]| {
        model.forward_motion(data, &x[..nq], &x[nq..]);
        model.energy(data).0
    };
    let before = energy(&mut data, &x);
    let mut method = stepper(x.len());
    for _ in 0..(seconds / h).round() as usize {
        method.runge_kutta_4(0.0, h, &mut x, |_, x, dx| {
            let (q, v) = x.split_at(nq);
            let (dq, dv) = dx.split_at_mut(nq);
            model.configuration_rate(q, v, dq);
            model.nonlinear_terms(&mut data, q, &still, &mut weight);
            model.forward_dynamics(&mut data, q, v, &weight, dv);
        });
        let norm = x[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
        x[3..7].iter_mut().for_each(|x| *x /= norm);
    }
    (energy(&mut data, &x) / before - 1.0).abs()
}

/// The whole robot thrown: what a minute costs, and that it falls with the fourth power of the step or faster.
fn flight(bench: &Bench) -> Findings {
    let model = bench.setup.robot.model()?;
    let points = [8e-3, 4e-3].map(|h| [h, drift(&model, h, 5.0)]);
    let minute = drift(&model, 4e-3, 60.0);
    Ok(vec![
        row("E2", "", AtLeast).of(
            "robot thrown, joints free, Runge-Kutta 4: order of the drift of energy",
            [3.6, slope(&points)],
        ),
        row("E2", "", AtMost)
            .of("robot thrown, Runge-Kutta 4 at 4 ms: share of energy after a minute", [1e-6, minute]),
    ])
}
