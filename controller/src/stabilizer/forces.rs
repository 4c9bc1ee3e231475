//! The force half of figure 5.8: what the feet shall press, and how their motion changes it (5.2)-(5.30).

use messages::Sensors;
use nalgebra::{Matrix3, Matrix6, Rotation3, SMatrix, Vector2, Vector3, Vector6};

use super::Controller;
use super::task::pitched;
use crate::contact::{Contact, Signs, felt_load};
use crate::contact_force::{FootWrench, Support, distribute, stabilize};
use crate::estimate::Estimate;
use crate::following::Desired;
use crate::force_control::{Compliance, Forces, Guide, contact_stiffness};
use crate::inverse_kinematics::Factorised;

/// \[m\] Contact points this far above the lowest one of their foot count as open.
const OPEN: f64 = 0.004;

impl Controller {
    /// Contact forces: what the plan wants with the stabilizing part, and what is measured (5.2)-(5.22).
    pub(super) fn forces(&mut self, now: &Desired, end: &Desired, estimate: &Estimate) -> Forces {
        let error = Vector2::from_fn(|i, _| now.torso.position[i] - estimate.angles[i]);
        let rate = Vector2::from_fn(|i, _| now.torso.velocity[i] - estimate.rates[i]);
        let height = now.com.position[2] - estimate.com.z;
        let height_rate = now.com.velocity[2] - estimate.com_velocity.z;
        let stabilizing = stabilize(&self.control, error, rate, height, height_rate);
        let nothing = (Vector3::zeros(), 0.0);
        let felt = |at: &Desired| felt_load(at.load, &self.contacts);
        let mut modified = self.foot_forces(now, felt(now), stabilizing);
        keep_ground(&mut modified, &self.contacts, self.control.force_blend[1]);
        let planned = coordinates(&self.foot_forces(now, felt(now), nothing));
        let planned_next = coordinates(&self.foot_forces(end, felt(end), nothing));
        if self.control.planned_deformation > 0.0 {
            self.planned_force = [now, end].map(|at| coordinates(&self.foot_forces(at, at.load, nothing)));
        }
        for (i, w) in modified.iter().enumerate() {
            self.state.wrench_desired[i].force = w.force.into();
            self.state.wrench_desired[i].moment = w.moment.into();
        }
        Forces {
            desired: coordinates(&modified),
            desired_rate: (planned_next - planned) / self.dt,
            measured: self.filtered,
        }
    }

    /// lambda_d1 in the sensor frames, whose axes are those of the flat soles (5.20), (5.21).
    fn foot_forces(&self, at: &Desired, load: [f64; 2], stabilizing: (Vector3<f64>, f64)) -> [FootWrench; 2] {
        let mass = self.desired.mass();
        let com = Vector3::from(at.com.position);
        let force = (Vector3::from(at.com.acceleration) - multibody::GRAVITY) * mass;
        let supports: [Support; 2] = std::array::from_fn(|i| self.support(at, load[i], i));
        let wrenches = distribute(
            &self.control,
            mass * -multibody::GRAVITY.z,
            (force, at.zmp.into(), com),
            stabilizing,
            &supports,
        );
        std::array::from_fn(|i| {
            let back = Rotation3::from_axis_angle(&Vector3::z_axis(), -supports[i].heading);
            FootWrench { force: back * wrenches[i].force, moment: back * wrenches[i].moment }
        })
    }

    /// Where a foot carries, as planned.
    fn support(&self, at: &Desired, load: f64, foot: usize) -> Support {
        let (sole, sensor) = (self.desired.sole(foot), self.desired.sensor(foot));
        let offset = sole.rotation.transpose() * (sensor.position - sole.position); // sensor seen from the sole
        let [x, y, z, heading] = at.feet[foot].position;
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), heading);
        let tilted = pitched(at.pitch[foot].position[0]) * offset;
        let [back, front, right, left] = self.robot.feet[foot].support;
        Support {
            sensor: Vector3::new(x, y, z) + turn * tilted,
            load,
            sole: [back - offset.x, front - offset.x, right - offset.y, left - offset.y],
            height: offset.z,
            heading,
        }
    }

    /// Measured (F_z, T_x, T_y) of both feet at the sensors, in the axes of their soles: those of the sensors unless the
    /// toes bend (5.20), (5.21).
    pub(super) fn force_coordinates(&self, sensors: &Sensors) -> Vector6<f64> {
        let wrenches = std::array::from_fn(|i| {
            let w = &sensors.foot_wrench[i];
            let turn = self.measured.sole(i).rotation.transpose() * self.measured.sensor(i).rotation;
            FootWrench { force: turn * Vector3::from(w.force), moment: turn * Vector3::from(w.moment) }
        });
        coordinates(&wrenches)
    }

    /// Which feet are felt, what resists them, and how they are to move apart from forces.
    pub(super) fn feel(&mut self, sensors: &Sensors, now: &Desired, end: &Desired, estimate: &Estimate) {
        let a = (self.dt / self.control.force_filter).min(1.0);
        self.filtered += (self.force_coordinates(sensors) - self.filtered) * a;
        for foot in 0..2 {
            let rise = now.feet[foot].velocity[2];
            let signs =
                Signs { load: [now.load[foot], end.load[foot]], rise, force: self.filtered[3 * foot] };
            self.contacts[foot].update(&self.control, &signs);
            let k = self.stiffness(foot, end.pitch[foot].position[0]);
            if k != self.stiffness[foot] {
                self.stiffness[foot] = k;
                self.compliance[foot] = Compliance::new(&k);
            }
            let target = self.inclination_target(foot, now, estimate);
            self.guides[foot] = Guide { contact: self.contacts[foot], rise, target };
        }
    }

    /// K of a foot on the contact points that the plan has on the ground: all of a flat foot, one edge of a pitched
    /// one, those of the toe segment while the toe bends (5.23).
    fn stiffness(&self, foot: usize, pitch: f64) -> Matrix3<f64> {
        let (sole, sensor) = (self.desired.sole(foot), self.desired.sensor(foot));
        let sensor = sole.rotation.transpose() * (sensor.position - sole.position);
        let (s, c) = pitch.sin_cos();
        let points = self.desired.contact_points(foot).map(|p| (p, c * p.z - s * p.x));
        let lowest = points.clone().fold(f64::INFINITY, |low, (_, height)| low.min(height));
        let closed = points.map(|(p, height)| (p, (1.0 - (height - lowest) / OPEN).clamp(0.0, 1.0)));
        contact_stiffness(closed, sensor, self.robot.contact.normal_stiffness)
    }

    /// Swing foot modification for an upper body that leans: where the plan wants it over the ground (4.9).
    fn inclination_target(&self, foot: usize, now: &Desired, estimate: &Estimate) -> Vector3<f64> {
        let error = |i: usize| now.torso.position[i] - estimate.angles[i];
        // Rotation that takes the torso back, in the planning frame's axes for a heading of zero: phi_x rises with
        // pitch, phi_y falls with roll.
        let (s, c) = now.torso.position[2].sin_cos();
        let (roll, pitch) = (-error(1), error(0));
        let turn = Vector3::new(c * roll - s * pitch, s * roll + c * pitch, 0.0);
        let place = |f: usize| {
            let [x, y, ..] = now.feet[f].position;
            Vector3::new(x, y, 0.0)
        };
        let lift = turn.cross(&(place(foot) - place(1 - foot))).z;
        let (s, c) = now.feet[foot].position[3].sin_cos();
        let of_foot = Vector3::new(c * turn.x + s * turn.y, -s * turn.x + c * turn.y, 0.0);
        Vector3::new(lift, of_foot.x, of_foot.y) * self.control.inclination_compensation
    }

    /// Deformation of a sole under the planned forces and its rate (z, roll, pitch), as far as the foot trajectories
    /// are to have it (4.9).
    pub(super) fn deformation(&self, foot: usize) -> [Vector3<f64>; 2] {
        let share = self.control.planned_deformation;
        if share == 0.0 {
            return [Vector3::zeros(); 2];
        }
        let [now, end] = self.planned_force.map(|f| f.fixed_rows::<3>(3 * foot).into_owned());
        let by = self.compliance[foot].inverse * share;
        [by * end, by * (end - now) / self.dt]
    }

    /// N: lift, roll and pitch of both soles against the torso per unit of modification, through the inverse
    /// kinematics (5.30).
    pub(super) fn sole_motion(&self, task: &Factorised, torso: &Matrix3<f64>, end: &Desired) -> Matrix6<f64> {
        let axes: [Matrix3<f64>; 2] = std::array::from_fn(|i| self.foot_axes(torso, end, i));
        let mut unit = SMatrix::<f64, 12, 6>::zeros();
        for foot in 0..2 {
            let (x, y, z) = (axes[foot].column(0), axes[foot].column(1), axes[foot].column(2));
            unit.fixed_view_mut::<3, 1>(6 * foot, 3 * foot).copy_from(&z);
            unit.fixed_view_mut::<3, 1>(6 * foot + 3, 3 * foot + 1).copy_from(&x);
            unit.fixed_view_mut::<3, 1>(6 * foot + 3, 3 * foot + 2).copy_from(&y);
        }
        let speeds = self.ik.columns(task, &unit);
        let mut motion = Matrix6::zeros();
        for foot in 0..2 {
            let rows = axes[foot].transpose();
            let mut of_foot = SMatrix::<f64, 3, 6>::zeros();
            for (j, twist) in
                self.desired.sole_jacobian(foot).column_iter().enumerate().filter(|(j, _)| self.free[*j])
            {
                let (linear, turn) = (rows * twist.fixed_rows::<3>(0), rows * twist.fixed_rows::<3>(3));
                of_foot += Vector3::new(linear.z, turn.x, turn.y) * speeds.row(j);
            }
            motion.fixed_rows_mut::<3>(3 * foot).copy_from(&of_foot);
        }
        motion
    }
}

/// A foot that has come before its load presses with at least `press` \[N\], which the other foot need not carry: without
/// it the foot leaves the ground again, and strikes when its load comes.
fn keep_ground(wrenches: &mut [FootWrench; 2], contacts: &[Contact; 2], press: f64) {
    for (foot, _) in contacts.iter().enumerate().filter(|(_, contact)| contact.waits) {
        let lack = (press - wrenches[foot].force.z).max(0.0);
        wrenches[foot].force.z += lack;
        wrenches[1 - foot].force.z -= lack;
    }
}

/// (F_z, T_x, T_y) of both feet.
fn coordinates(wrenches: &[FootWrench; 2]) -> Vector6<f64> {
    Vector6::from_fn(|i, _| {
        let w = &wrenches[i / 3];
        [w.force.z, w.moment.x, w.moment.y][i % 3]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_foot_that_waits_for_its_load_presses_and_the_sum_stays() {
        let wrench = |z| FootWrench { force: Vector3::new(1.0, 2.0, z), moment: Vector3::new(3.0, 4.0, 0.0) };
        let contact = |waits| Contact { waits, ..Contact::default() };
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
