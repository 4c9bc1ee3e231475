//! Speeds from counts (F26), and numbers that are none, from wherever they come.

use config::method::Integrator;
use config::scene::Scene;
use config::sensors::PerJoint;
use lowlevel::JointLoop;
use messages::command::PushCommand;
use messages::{EventCode, JointMode, JointTargets, MAX_JOINTS, Wrench};
use sim_backend::sensors::{SensorSet, Truth};

use super::LimitRule::{AtMost, Within};
use super::held::HeldRobot;
use super::{Bench, Finding, Findings, Result, row};

pub(super) fn all(bench: &Bench) -> Findings {
    let mut findings = quantised_speed(bench)?;
    findings.push(target(bench));
    for depth in 1..=3 {
        for (name, force) in [("NaN", f64::NAN), ("1e300", 1e300)] {
            findings.push(push(bench, depth, name, force)?);
        }
    }
    Ok(findings)
}

/// F26: differences of an angle of 16 bit every millisecond: error delta/T at most, delta/(T sqrt 6) on average.
fn quantised_speed(bench: &Bench) -> Findings {
    let robot = &bench.setup.robot;
    let (cycle, bits) = (1e-3, 65_536.0);
    let mut errors = config::SensorErrors::default();
    errors.encoder.counts = PerJoint { all: Some(bits), own: Vec::new() };
    errors.encoder.speed_by_difference = true;
    let hanging = [Wrench { force: [0.0; 3], moment: [0.0; 3] }; 2];
    let mut sensors = SensorSet::new(&errors, robot, &hanging, 1, (cycle, 1));
    let (mut truth, mut seen) = (Truth::default(), messages::Sensors::default());
    let (mut square, mut largest, n, mut angle) = (0.0, 0.0_f64, 200_000, 0.0);
    for i in 0..n {
        // Slowly through all speeds from -1 to 1 rad/s.
        let speed = (1e-4 * f64::from(i)).sin();
        angle += speed * cycle;
        truth.joint_angle = [angle; MAX_JOINTS];
        sensors.measure(&truth, &mut seen);
        let error = if i == 0 { 0.0 } else { seen.joint_speed[0] - speed };
        square += error * error;
        largest = largest.max(error.abs());
    }
    let delta = std::f64::consts::TAU / bits;
    let [mean, most] =
        [[delta / (cycle * 6f64.sqrt()), (square / f64::from(n)).sqrt()], [delta / cycle, largest]];
    Ok(vec![
        row("F26", "rad/s", Within(0.05))
            .of("speed from differences, 16 bit, 1 kHz: root mean square error", mean),
        row("F26", "rad/s", Within(2e-3)).of("speed from differences, 16 bit, 1 kHz: largest error", most),
    ])
}

/// Joint targets that are no numbers, into the joint loop: largest number that goes out on the bus.
fn target(bench: &Bench) -> Finding {
    let robot = &bench.setup.robot;
    let mut joints = JointLoop::new(robot, &bench.setup.system, bench.setup.scene.cycle);
    let mut told = false;
    let mut out = codec::frames::DriveCommand::default();
    let mut largest = 0.0_f64;
    let mut answer = messages::BusFrames::default();
    let mut sensors = messages::Sensors { power: 1, ..Default::default() };
    sensors.drive_status.fill(u32::from(
        drives::cia402::status_of(drives::cia402::DriveState::OperationEnabled) | drives::cia402::REFERENCED,
    ));
    for tick in 1..20 {
        sensors.header.tick = tick;
        sensors.joint_angle[..bench.pose().len()].copy_from_slice(bench.pose());
        codec::frames::encode_sensors(&robot.layout, &sensors, &mut answer);
        joints.receive(tick, tick * 1_000_000, Some(&answer));
        let mut targets = JointTargets { mode: JointMode::Track as u64, ..JointTargets::default() };
        targets.header.tick = tick;
        targets.angle = sensors.joint_angle;
        // At rest for ten cycles, so that there is something good to go on with.
        if tick > 10 {
            targets.angle[3] = f64::NAN;
            targets.speed[4] = 1e300;
        }
        let (frames, _) = joints.send(Some(&targets), None);
        codec::frames::decode_targets(&robot.layout, frames, &mut out);
        let wrong = |j: usize| (out.targets.angle[j] - bench.pose()[j]).abs();
        largest = (0..bench.pose().len()).map(wrong).fold(largest, f64::max);
        told |= joints.events().drain().any(|(code, _)| code == EventCode::TargetNotFinite);
    }
    let regime = "joint targets NaN and 1e300: way that goes out on the bus";
    row("N1", "rad", AtMost).of(regime, [8e-9, largest]).says("TargetNotFinite, joint", told)
}

/// A push that no simulation survives: numbers that are not finite in any record after it.
fn push(bench: &Bench, depth: u8, name: &str, force: f64) -> Result<Finding> {
    let integrator = if depth == 1 { Integrator::Euler } else { Integrator::SemiImplicit };
    let scene = Scene { depth, integrator, substeps: 4, ..bench.setup.scene.clone() };
    let mut held = HeldRobot::new(bench, &scene)?;
    let mut seen = messages::Sensors::default();
    let (mut bad, mut events) = (0, Vec::new());
    for cycle in 0..100 {
        if cycle == 50 {
            held.sim.push(&PushCommand { force: [force, 0.0, 0.0], duration: 0.01 });
        }
        let (frames, truth) = held.step();
        codec::frames::decode_sensors(&bench.setup.robot.layout, frames, &mut seen);
        let pose = truth.position.iter().chain(&truth.orientation).chain(&truth.velocity).chain(&truth.com);
        let feet = truth.foot_wrench.iter().flat_map(|w| w.force.iter().chain(&w.moment));
        let rest = truth.angular_velocity.iter().chain(&truth.joint_angle).chain(truth.feet.iter().flatten());
        bad += pose.chain(feet).chain(rest).filter(|x| !x.is_finite()).count();
        events.extend(held.sim.events().drain().map(|(code, _)| code));
    }
    let regime = format!("type {depth}, push of {name} N: numbers in the records that are none");
    let said = events.first().map_or("nothing".into(), |code| format!("{code:?}"));
    let told = events.contains(&EventCode::Diverged);
    Ok(row("N2", "", AtMost).of(regime, [0.0, bad as f64]).says(&said, told))
}
