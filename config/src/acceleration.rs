//! Acceleration limits of the joints: what their drives can do.
//!
//! A motor accelerates its own rotor with at most a = k_M I_max / J, whatever hangs behind its gear. With the ratio
//! c = d phi / d q, the joint then has a / |c|: no more than that can be asked of it, and with a limb behind the gear it is less.
//! A linkage's ratio changes with its angles. A joint that two motors share has the limit of the slower one.

use crate::drive::Drive;
use crate::joint::Joint;
use drives::{Gear, Transmission};

/// \[1\] Times what its drives can accelerate it alone, a joint may be asked for: when a foot lands, the ground pushes it where
/// it goes, at most with what the drives can just hold.
pub const WITH_LOAD: f64 = 2.0;
/// Angles per joint at which a linkage is looked at, over the joint's range.
const ANGLES: usize = 17;

/// \[rad/s^2\] Most that these drives can accelerate joint `j` at these angles \[rad\] of all joints; infinite for a joint
/// without a drive.
pub(crate) fn at(drives: &[Drive], j: usize, angles: &[f64]) -> f64 {
    let of_drive = |drive: &Drive| {
        let mut q = [0.0; 3];
        for (q, &joint) in q.iter_mut().zip(&drive.joints) {
            *q = angles[joint];
        }
        let gear = drive.transmission.at(q, [0.0; 3]).ok()?;
        most(drive, &gear, j)
    };
    drives.iter().filter_map(of_drive).fold(f64::INFINITY, f64::min)
}

/// \[rad/s^2\] Least of these limits over the range of each joint.
pub(crate) fn least(drives: &[Drive], joints: &[Joint]) -> Vec<f64> {
    let mut limits = vec![f64::INFINITY; joints.len()];
    for drive in drives {
        let angle = |slot: usize, i: usize| {
            let [low, high] = drive.joints.get(slot).map_or([0.0; 2], |&j| joints[j].range);
            low + (high - low) * i as f64 / (ANGLES - 1) as f64
        };
        for (i, k) in (0..ANGLES).flat_map(|i| (0..ANGLES).map(move |k| (i, k))) {
            let q = match drive.transmission {
                Transmission::Ankle(_) => [0.0, angle(1, i), angle(2, k)],
                _ => [angle(0, i), 0.0, 0.0],
            };
            let Ok(gear) = drive.transmission.at(q, [0.0; 3]) else { continue };
            for &j in &drive.joints {
                limits[j] = limits[j].min(most(drive, &gear, j).unwrap_or(f64::INFINITY));
            }
        }
    }
    limits
}

/// a / |c| of one drive; none for a joint that it does not move.
fn most(drive: &Drive, gear: &Gear, j: usize) -> Option<f64> {
    let slot = drive.joints.iter().position(|&joint| joint == j)?;
    // A knee only carries the screws of its ankle along: a drive of its own moves it.
    let carried = matches!(drive.transmission, Transmission::Ankle(_)) && slot == 0;
    let a = drive.motor.torque(drive.current_limit) / drive.rotor_inertia;
    (!carried).then(|| a / gear.ratio[slot].abs())
}

#[cfg(test)]
mod tests {
    use crate::robot::{Joint, Robot};
    use crate::root;

    fn lola() -> Robot {
        Robot::load(&root(None).join("robots/lola")).unwrap()
    }

    /// By hand from robot.toml: torque constant, current, rotor, ratio.
    #[test]
    fn a_geared_joint_has_its_motors_acceleration_over_the_ratio() {
        let robot = lola();
        let hip = robot.joint("right_hip_flexion").unwrap();
        let by_hand = 0.147 * 50.0 / 3.2e-4 / 50.0;
        assert!((robot.joints[hip].acceleration / by_hand - 1.0).abs() < 1e-12);
        assert!((robot.acceleration(hip, &robot.poses["stand"]) / by_hand - 1.0).abs() < 1e-12);
    }

    /// A motor that turns at its limit, through the linkage, moves the joint with that acceleration: by differences of the
    /// motors' angles, which know nothing of ratios.
    #[test]
    fn a_linkages_limit_is_that_of_its_motors_angle() {
        let robot = lola();
        for (name, motor) in
            [("right_knee_flexion", 0.147 * 50.0 / 3.2e-4), ("right_ankle_flexion", 0.0495 * 30.0 / 5.2e-5)]
        {
            let j = robot.joint(name).unwrap();
            for pose in ["stand", "crouch", "straight"] {
                let pose = &robot.poses[pose];
                let angle = |drive: &crate::drive::Drive, by: f64| {
                    let mut q = [0.0; 3];
                    for (q, &k) in q.iter_mut().zip(&drive.joints) {
                        *q = pose[k] + if k == j { by } else { 0.0 };
                    }
                    drive.transmission.at(q, [0.0; 3]).unwrap().angle
                };
                // Behind a knee there are ankle screws that only go with it: the drive in the joint's own row counts.
                let drive = &robot.drives[j];
                let way = (angle(drive, 1e-5) - angle(drive, -1e-5)) / 2e-5;
                let limit = robot.acceleration(j, pose);
                assert!((limit * way.abs() / motor - 1.0).abs() < 1e-2, "{name}: {limit}, {way}");
                // The range is looked at in steps.
                assert!(robot.joints[j].acceleration <= 1.01 * limit, "{name}");
            }
        }
    }

    /// Stabilizer and joint loop ask at angles that differ by the tracking error: of 10 mrad, more than any walk has. For that
    /// the stabilizer leaves 3 %.
    #[test]
    fn angles_that_lag_change_a_limit_by_less_than_three_percent() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        for name in ["lola", "johnnie", "archie"] {
            let robot = Robot::load(&root(None).join("robots").join(name)).unwrap();
            for _ in 0..2000 {
                let at = |j: &Joint| j.range[0] + (j.range[1] - j.range[0]) * random();
                let at: Vec<_> = robot.joints.iter().map(at).collect();
                let lagging: Vec<_> = at.iter().map(|q| q + 0.010 * (2.0 * random() - 1.0)).collect();
                for (j, joint) in robot.joints.iter().enumerate() {
                    let (limit, other) = (robot.acceleration(j, &at), robot.acceleration(j, &lagging));
                    assert!(limit == other || (limit / other - 1.0).abs() < 0.03, "{name} {}", joint.name);
                }
            }
        }
    }
}
