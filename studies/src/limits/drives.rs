//! Drives: load torques without a solution, elasticity as printed, linkages at their dead points (F12, F14, F15, F24).

use ::drives::{
    Ankle, AnkleGeometry, Friction, HarmonicFriction, KneeGeometry, NoLoadTorque, OutOfDomain, ScrewFriction,
    Transmission,
};
use config::robot::Drive as Description;
use nalgebra::Vector3;
use sim_backend::drive::JointCubic;
use sim_backend::plant::PlantInputs;
use sim_backend::train::FaultCause;

use crate::search::{Width, border, slope};

use super::LimitRule::{AtMost, Within};
use super::{Bench, Findings, Result, largest_stable, row};

/// A gear whose share of the load is the speed \[rad/s\] times 1e-3.
const COUPLED: HarmonicFriction = HarmonicFriction { starting: 0.0, load: 0.0, viscous: 0.0, coupled: 1e-3 };
/// Gears of table C.1 in the robot's file, and their names in the catalogue.
const GEARS: [(&str, &str); 2] = [("hfuc_25_100", "HFUC-25-100"), ("hfuc_32_50", "HFUC-32-50")];

/// Friction of a gear of the robot.
pub(super) fn gear(bench: &Bench, name: &str) -> Result<HarmonicFriction> {
    let drive = bench.setup.robot.drives.iter().find(|d| d.gear == name);
    match drive.map(|d| d.friction) {
        Some(Friction::Harmonic(friction)) => Ok(friction),
        _ => Err(format!("no drive of the robot has the gear `{name}`").into()),
    }
}

/// F12: a driven load is amplified by 1/(1 - c), and beyond c = 1 there is no answer.
pub(super) fn load_torque(bench: &Bench) -> Findings {
    let amplified = -COUPLED.load_torque(990.0, -1.0, 0.0)?;
    let beyond = COUPLED.load_torque(1001.0, -1.0, 0.0);
    let mut findings = vec![
        row("F12", "", Within(1e-9))
            .of("load torque (2.64), c = 0.99: amplification 1/(1 - c)", [100.0, amplified])
            .says("beyond c = 1: NoLoadTorque", matches!(beyond, Err(NoLoadTorque { share }) if share > 1.0)),
    ];
    for (key, name) in GEARS {
        let gear = gear(bench, key)?;
        let found = largest_stable(0.0, 4000.0, |w| gear.load_torque(w, -1.0, 0.0).is_ok())?;
        let limit = Friction::Harmonic(gear).speed_limit();
        let predicted = (1.0 - gear.load) / gear.coupled;
        let regime = format!("{name}: speed (1 - mu)/gamma at which (2.64) ends");
        findings.push(
            row("F12", "rad/s", Within(1e-3))
                .of(regime, [predicted, found])
                .says("Friction::speed_limit, NoLoadTorque", (limit / predicted - 1.0).abs() < 1e-12),
        );
    }
    Ok(findings)
}

/// F14: no friction gives power, within the catalogue and beyond, where it has no answer.
pub(super) fn passivity(bench: &Bench) -> Findings {
    let screw = Friction::Screw(ScrewFriction { direct: 0.86, indirect: 0.858 });
    let gears = GEARS.map(|(key, _)| gear(bench, key).map(Friction::Harmonic));
    let laws = gears.into_iter().chain([Ok(screw)]).collect::<Result<Vec<_>>>()?;
    let (mut most, mut without, mut beyond) = (f64::NEG_INFINITY, 0, 0);
    for law in laws {
        for w in (-120..=120).map(|k| 25.0 * f64::from(k)) {
            for motor in (-50..=50).map(|k| 0.4 * f64::from(k)) {
                beyond += usize::from(w.abs() > law.speed_limit());
                match law.torque(w, motor, 0.0) {
                    Ok(torque) => most = most.max(torque * w),
                    Err(_) => without += 1,
                }
            }
        }
    }
    Ok(vec![
        row("F14", "W", AtMost)
            .of("friction (2.61), (2.68), +-3000 rad/s, +-20 N m: largest power", [0.0, most])
            .says("NoLoadTorque beyond c = 1", without == beyond && beyond > 0),
    ])
}

/// F15: (2.69) is continuous at its knees; as printed it would jump by K_1 T_1/K_0, 10.9 N m.
pub(super) fn elasticity(bench: &Bench) -> Findings {
    let spring = bench.setup.robot.drives.iter().find_map(|d| d.elasticity).ok_or("no elastic drive")?;
    let [t1, t2] = spring.knees;
    let jump = |t: f64| {
        let at = spring.torsion(t);
        (spring.torque(at * (1.0 + 1e-15)) - spring.torque(at * (1.0 - 1e-15))).abs()
    };
    Ok(vec![
        row("F15", "N m", AtMost).of("elasticity (2.69): jump at its knees", [5e-13, jump(t1).max(jump(t2))]),
    ])
}

/// F24: near the end of an ankle's coupler its ratio grows as distance^-1/2; beyond there is an error with a margin.
pub(super) fn ankle(bench: &Bench) -> Findings {
    let drives = &bench.setup.robot.drives;
    let transmission = drives.iter().map(|d| d.transmission).find(|t| matches!(t, Transmission::Ankle(_)));
    let Some(Transmission::Ankle(real)) = transmission else { return Err("no ankle linkage".into()) };
    // The robot's own coupler reaches everywhere in the ankle's range; a shorter one ends there.
    let geometry = *real.geometry();
    let at = |ankle: &Ankle, flexion: f64| Transmission::Ankle(*ankle).at([0.0, 0.0, flexion], [0.0; 3]);
    let short = |coupler: f64| Ankle::new(&AnkleGeometry { coupler, ..geometry });
    let least = largest_stable(0.0, geometry.coupler, |l| short(l).is_err())?;
    let ankle = short(least + 0.3 * Vector3::from(geometry.attachment).norm())?;
    let angles = (1..150).flat_map(|k| [0.01, -0.01].map(|step| step * f64::from(k)));
    let end = angles.into_iter().find(|q| at(&ankle, *q).is_err()).ok_or("the coupler reaches everywhere")?;
    let toward = end.signum();
    let dead = border([0.0, end], Width::Exact, |q| Result::Ok(at(&ankle, q).is_ok()))?;
    let ratio = |d: f64| at(&ankle, dead[0] - toward * d).map(|gear| [d, gear.ratio[2].abs()]);
    let points = [1e-7, 1e-6, 1e-5].into_iter().map(ratio).collect::<std::result::Result<Vec<_>, _>>()?;
    let beyond = at(&ankle, dead[0] + toward * 1e-3);
    let told = matches!(beyond, Err(OutOfDomain::Coupler { margin }) if margin < 0.0);
    let regime = "ankle, coupler near its end: power of the distance in the ratio";
    Ok(vec![
        row("F24", "", Within(0.01))
            .of(regime, [-0.5, slope(&points)])
            .says("OutOfDomain::Coupler, margin D < 0", told),
    ])
}

/// \[rad\] Where the lever of a knee's screw vanishes: l^2 = const + 2 (A cos q + B sin q) has its extremum.
fn dead_angle(g: &KneeGeometry) -> f64 {
    let axis = Vector3::from(g.axis);
    let (base, nut) = (Vector3::from(g.joint) - Vector3::from(g.pivot), Vector3::from(g.attachment));
    let across = nut - axis * axis.dot(&nut);
    let q = base.dot(&axis.cross(&nut)).atan2(base.dot(&across));
    // The one that bending the knee arrives at.
    if q > 0.0 { q } else { q + std::f64::consts::PI }
}

/// The robot of type 2 with a knee driven into its dead point: where it is told, and that all rates stay finite.
pub(super) fn dead_point(bench: &Bench) -> Findings {
    let is_knee = |d: &&Description| matches!(d.transmission, Transmission::Knee(_));
    let Some(drive) = bench.setup.robot.drives.iter().find(is_knee) else {
        return Err("no knee linkage".into());
    };
    let Transmission::Knee(knee) = drive.transmission else { return Err("no knee linkage".into()) };
    let mut plant = bench.plant(2)?;
    let still: Vec<JointCubic> = bench.pose().iter().map(|&q| JointCubic::resting(q)).collect();
    let rest = plant.standing(bench.pose());
    let mut rate = vec![0.0; rest.len()];
    let mut finite = true;
    let mut fault = |q: f64| {
        let mut x = rest.clone();
        x[7 + drive.joints[0]] = q;
        plant.rate(0.0, &x, &still, &PlantInputs::POWERED, &mut rate);
        finite &= rate.iter().all(|r| r.is_finite());
        plant.take_fault()
    };
    let predicted = dead_angle(knee.geometry());
    let found = largest_stable(0.0, predicted + 1.0, |q| fault(q).is_none())?;
    let why = fault(predicted + 0.01).map(|f| f.why);
    let told =
        matches!(why, Some(FaultCause::Linkage(OutOfDomain::Lever { margin })) if margin < 0.0) && finite;
    let regime = "type 2, knee bent to the dead point of its screw";
    Ok(vec![
        row("D1", "rad", Within(1e-3))
            .of(regime, [predicted, found])
            .says("DriveFault: Lever; rates finite", told),
    ])
}
