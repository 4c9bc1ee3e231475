//! Force targets of the feet (figure 5.8), (5.2)-(5.22).

use nalgebra::{Rotation3, Vector2, Vector3, Vector6};

use super::contacts::{Footing, force_coordinates};
use super::cycle::{ControlCycle, pitched};
use crate::contact::{FootContact, felt_load};
use crate::contact_force::{FootWrench, Support, distribute, stabilize};
use crate::force_control::{Compliance, ForceTargets};
use crate::plan_follower::Desired;

/// Force targets of this cycle.
pub(super) struct FootForces {
    /// Targets of the force controller.
    pub(super) targets: ForceTargets,
    /// lambda_d1 as wrenches at the sensors.
    pub(super) wrenches: [FootWrench; 2],
    /// Planned deformation of each sole and its rate (z, roll, pitch) \[m, rad, rad; per s\].
    pub(super) deformation: [[Vector3<f64>; 2]; 2],
}

/// Force targets: those of the plan with the stabilizing part, beside the measured forces (5.2)-(5.22).
pub(super) fn force_targets(cycle: &ControlCycle<'_>, footing: &Footing) -> FootForces {
    let ControlCycle { control, now, end, estimate, .. } = *cycle;
    // Stabilizing force and moment, from the errors of inclination and height.
    let error = Vector2::from_fn(|i, _| now.torso.position[i] - estimate.angles[i]);
    let rate = Vector2::from_fn(|i, _| now.torso.velocity[i] - estimate.rates[i]);
    let height = now.body.position[2] - estimate.com.z;
    let height_rate = now.body.velocity[2] - estimate.com_velocity.z;
    let stabilizing = stabilize(control, error, rate, height, height_rate);

    // A foot that finds no ground has no load: the targets are those of the feet that are felt.
    let contacts = footing.contacts();
    let felt = |at: &Desired| felt_load(at.load, &contacts);
    let touch = contacts.map(|c| c.felt * c.force_share());
    let mut wrenches = foot_forces(cycle, now, (felt(now), touch), stabilizing);
    keep_ground(&mut wrenches, &contacts, control.force_blend[1]);

    // The feed forward is the rate of the plan alone; stabilizing it would feed noise forward.
    let nothing = (Vector3::zeros(), 0.0);
    let planned = |at: &Desired, load| force_coordinates(&foot_forces(cycle, at, (load, [0.0; 2]), nothing));
    let desired_rate = (planned(end, felt(end)) - planned(now, felt(now))) / cycle.dt;
    let deformation = if control.planned_deformation > 0.0 {
        let forces = [now, end].map(|at| planned(at, at.load));
        [0, 1].map(|foot| deformation(cycle, &footing.feet[foot].0, &forces, foot))
    } else {
        [[Vector3::zeros(); 2]; 2]
    };
    FootForces {
        targets: ForceTargets {
            desired: force_coordinates(&wrenches),
            desired_rate,
            measured: footing.measured,
        },
        wrenches,
        deformation,
    }
}

/// lambda_d1 in the sensor frames, whose axes are those of the flat soles (5.20), (5.21), of feet with this load, as far as each is
/// felt to touch.
fn foot_forces(
    cycle: &ControlCycle<'_>,
    at: &Desired,
    (load, touch): ([f64; 2], [f64; 2]),
    stabilizing: (Vector3<f64>, f64),
) -> [FootWrench; 2] {
    let mass = cycle.kinematics.mass();
    let com = Vector3::from(at.body.position);
    let force = (Vector3::from(at.body.acceleration) - multibody::GRAVITY) * mass;
    let supports: [Support; 2] = std::array::from_fn(|i| support(cycle, at, (load[i], touch[i]), i));
    let wrenches = distribute(
        cycle.control,
        mass * multibody::GRAVITY_ACCELERATION,
        (force, at.zmp.into(), com),
        stabilizing,
        &supports,
    );
    std::array::from_fn(|i| {
        let back = Rotation3::from_axis_angle(&Vector3::z_axis(), -supports[i].heading);
        FootWrench { force: back * wrenches[i].force, moment: back * wrenches[i].moment }
    })
}

/// Support of a foot, as planned.
fn support(cycle: &ControlCycle<'_>, at: &Desired, (load, felt): (f64, f64), foot: usize) -> Support {
    let offset = cycle.sensor_from_sole(foot);
    let [x, y, z, heading] = at.feet[foot].position;
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), heading);
    let tilted = pitched(at.pitch[foot].position[0]) * offset;
    let [back, front, right, left] = cycle.robot.feet[foot].support;
    Support {
        sensor: Vector3::new(x, y, z) + turn * tilted,
        load,
        felt,
        sole: [back - offset.x, front - offset.x, right - offset.y, left - offset.y],
        height: offset.z,
        heading,
    }
}

/// Deformation of a sole under the planned `forces` (now, end of the cycle) and its rate (z, roll, pitch), as far as the
/// foot trajectories are to have it (4.9).
fn deformation(
    cycle: &ControlCycle<'_>,
    compliance: &Compliance,
    forces: &[Vector6<f64>; 2],
    foot: usize,
) -> [Vector3<f64>; 2] {
    let [now, end] = forces.map(|f| f.fixed_rows::<3>(3 * foot).into_owned());
    let by = compliance.inverse * cycle.control.planned_deformation;
    [by * end, by * (end - now) / cycle.dt]
}

/// A foot that has come before its load presses with at least `press` \[N\], which the other foot need not carry: without
/// it the foot leaves the ground again, and strikes when its load comes (scene `holes`: 0.61 weights over the desired force
/// instead of 0.36).
fn keep_ground(wrenches: &mut [FootWrench; 2], contacts: &[FootContact; 2], press: f64) {
    for (foot, _) in contacts.iter().enumerate().filter(|(_, contact)| contact.waits) {
        let lack = (press - wrenches[foot].force.z).max(0.0);
        wrenches[foot].force.z += lack;
        wrenches[1 - foot].force.z -= lack;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_foot_that_waits_for_its_load_presses_and_the_sum_stays() {
        let wrench = |z| FootWrench { force: Vector3::new(1.0, 2.0, z), moment: Vector3::new(3.0, 4.0, 0.0) };
        let contact = |waits| FootContact { waits, ..FootContact::default() };
        for (forces, waits, expected) in [
            ([600.0, 0.0], [false, true], [550.0, 50.0]),
            ([600.0, 0.0], [false, false], [600.0, 0.0]),
            ([80.0, 520.0], [true, false], [80.0, 520.0]),
        ] {
            let mut wrenches = forces.map(wrench);
            keep_ground(&mut wrenches, &waits.map(contact), 50.0);
            assert_eq!(wrenches, expected.map(wrench));
        }
    }
}
