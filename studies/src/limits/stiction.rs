//! Dry friction as a sign chatters, as a ramp it creeps; as a set it rests (F5, F6).

use ::drives::{Friction, HarmonicFriction};
use codec::frames::decode_sensors;
use config::drive::Drive;
use config::method::Integrator;
use config::scene::Scene;
use sim_backend::stiff::{GiveUpReason, Stiff, StiffLimits};

use crate::search::slope;

use super::LimitRule::{AtMost, Within};
use super::held::HeldRobot;
use super::{Bench, Findings, Result, row};

/// A gear of dry friction only \[N m\], a rotor \[kg m^2\], a step \[s\].
const GEAR: HarmonicFriction = HarmonicFriction { starting: 0.1, load: 0.0, viscous: 0.0, coupled: 0.0 };
const INERTIA: f64 = 3e-4;
const STEP: f64 = 1e-3;
/// \[N m\] What turns the rotor: less than the friction, and no fraction of it, so that no cycle closes.
const MOTOR: f64 = 0.1 * std::f64::consts::FRAC_1_SQRT_2;

/// F6: explicit Euler jumps over rest by h (T_0 + T)/J, an implicit step ends there.
pub(super) fn chatter(_: &Bench) -> Findings {
    let friction = Friction::Harmonic(GEAR);
    let (mut sign, mut implicit) = (0.5, 0.5);
    let (mut largest, mut left) = (0.0_f64, 0.0_f64);
    for i in 0..10_000 {
        sign += STEP / INERTIA * (MOTOR + friction.torque(sign, MOTOR, 0.0)?);
        let law = friction.sliding(implicit, MOTOR)?;
        implicit = law.speed_after(implicit + STEP / INERTIA * MOTOR, STEP / INERTIA);
        if i > 100 {
            (largest, left) = (largest.max(sign.abs()), left.max(implicit.abs()));
        }
    }
    let predicted = STEP * (GEAR.starting + MOTOR) / INERTIA;
    let [at_rest, chatter] = [[0.0, left], [predicted, largest]];
    Ok(vec![
        row("F6", "rad/s", Within(2e-3))
            .of("explicit Euler with sign(w) T_0: chatter h (T_0 + T)/J", chatter),
        row("F6", "rad/s", AtMost).of("implicit step on the same rotor: speed", at_rest),
    ])
}

/// F6: a ramp instead of the sign lets a loaded rotor creep with w_eps T/T_0.
pub(super) fn smoothed_sign(_: &Bench) -> Findings {
    let (ramp, mut speed) = (1.0, 0.0);
    for _ in 0..100_000 {
        speed += 1e-4 / INERTIA * (MOTOR + Friction::Harmonic(GEAR).torque(speed, MOTOR, ramp)?);
    }
    let numbers = [ramp * MOTOR / GEAR.starting, speed];
    let regime = "ramp of 1 rad/s instead of the sign: rotor below its friction creeps";
    Ok(vec![row("F6", "rad/s", Within(1e-3)).of(regime, numbers)])
}

/// F6: the robot of type 2 whose supply goes off while it stands, without brakes, and with gears whose dry friction is more
/// than their loads: largest change of an angle in 10 s. Drives of one joint rest exactly; the ankles' pairs are held by a
/// damper of 1e7 J/h, which gives way to the load by the angle predicted, here of each motor alone. The loads are those of motors without friction.
pub(super) fn at_rest(bench: &Bench) -> Findings {
    const STIFFNESS: f64 = 1e7;
    let scene =
        Scene { depth: 2, integrator: Integrator::SemiImplicit, substeps: 4, ..bench.setup.scene.clone() };
    let seconds = 10.0;
    let cycles = |seconds: f64| (seconds / scene.cycle) as usize;
    let standing = |friction: fn(&Drive) -> Friction| {
        let mut setup = bench.setup.clone();
        for drive in &mut setup.robot.drives {
            (drive.friction, drive.brake) = (friction(drive), None);
        }
        let bench = Bench { setup };
        let mut held = HeldRobot::new(&bench, &scene)?;
        for _ in 0..cycles(2.0) {
            held.step();
        }
        Result::Ok((held, bench))
    };
    // Loads of the motors by their currents, where no friction carries a part of them.
    let (mut free, bench_free) = standing(|_| Friction::Free)?;
    let layout = bench_free.setup.robot.layout.clone();
    let mut sensors = messages::Sensors::default();
    decode_sensors(&layout, free.step().0, &mut sensors);
    // Held by friction alone.
    let (mut held, bench) = standing(|drive| {
        let starting = 0.3 * drive.motor.torque(drive.current_limit);
        Friction::Harmonic(HarmonicFriction { starting, load: 0.0, viscous: 0.0, coupled: 0.0 })
    })?;
    let mut rest = |seconds: f64| {
        (0..cycles(seconds)).for_each(|_| _ = held.sim.step(None, None));
        held.sim.state().joint_angle
    };
    let (before, after) = (rest(0.5), rest(seconds));
    let fell = held.sim.state().fallen == 1;
    let (mut single, mut coupled, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (j, drive) in bench.setup.robot.drives.iter().enumerate() {
        let moved = (after[j] - before[j]).abs(); // drive j moves joint j
        if drive.joints.len() == 1 {
            single = single.max(moved);
            continue;
        }
        let h = scene.cycle / f64::from(scene.substeps);
        let load = drive.motor.torque(sensors.motor_current[j]).abs();
        // On the motor; the joint moves less by the gear ratio.
        let angle = |joint: &usize| bench.pose()[*joint];
        let angles = [angle(&drive.joints[0]), angle(&drive.joints[1]), angle(&drive.joints[2])];
        let ratio = drive.transmission.at(angles, [0.0; 3])?.ratio[2].abs();
        most = most.max(seconds * load * h / (STIFFNESS * drive.rotor_inertia * ratio));
        coupled = coupled.max(moved);
    }
    Ok(vec![
        row("F6", "rad", AtMost)
            .of(
                "semi-implicit, type 2 held by dry friction alone: joints of one drive creep in 10 s",
                [0.0, single],
            )
            .says("", !fell),
        row("F6", "rad", Within(0.1))
            .of("semi-implicit, type 2 held by dry friction alone: ankles creep in 10 s", [most, coupled])
            .says("", !fell),
    ])
}

/// F5: an adaptive method at a sign takes steps in proportion to its tolerance; its guard ends that and names the speed.
pub(super) fn adaptive(_: &Bench) -> Findings {
    // A joint of 1 kg m^2 with the friction of an HFUC-25-100 under half of it, at rest.
    let (friction, load, seconds) = (10.4, 5.2, 0.02);
    let mut rate = |_: f64, x: &[f64], dx: &mut [f64]| {
        (dx[0], dx[1]) = (x[1], load - friction * (f64::from(x[1] > 0.0) - f64::from(x[1] < 0.0)));
    };
    let mut advance = |tolerance: f64, most_calls: u32| {
        let limits = StiffLimits { most_calls, ..StiffLimits::of_tolerance(tolerance) };
        Stiff::new(limits).advance(0.0, seconds, &mut [0.0, 0.0], &mut rate)
    };
    let mut points = Vec::new();
    for tolerance in [1e-3, 1e-4, 1e-5] {
        points.push([tolerance, f64::from(advance(tolerance, 10_000_000)?.calls)]);
    }
    let ended = advance(1e-6, 20_000);
    let told = matches!(ended, Err(gave_up) if gave_up.why == GiveUpReason::Calls && gave_up.state == 1);
    let regime = "BDF on sign(w) T_0 at rest: power of the tolerance in its evaluations";
    let numbers = [-1.0, slope(&points)];
    Ok(vec![row("F5", "", Within(0.02)).of(regime, numbers).says("GaveUp: calls, state that chatters", told)])
}
