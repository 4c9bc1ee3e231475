//! Contacts of the feet (figure 5.8): what they resist, and their position-control inputs.

use messages::Sensors;
use nalgebra::{Matrix3, Vector2, Vector3, Vector6};

use super::cycle::ControlCycle;
use crate::contact::{FootContact, Signs};
use crate::contact_force::FootWrench;
use crate::force_control::{Compliance, FootReference, contact_stiffness};
use crate::task_space::TaskSpace;

/// \[m\] Contact points this far above the lowest one of their foot count as open.
const OPEN: f64 = 0.004;

/// Contacts of both feet, right and left.
#[derive(Clone)]
pub(super) struct FootContacts {
    contacts: [FootContact; 2],
    /// K of each foot, and K^+ that was made of it.
    stiffness: [Matrix3<f64>; 2],
    compliance: [Compliance; 2],
    /// Measured (F_z, T_x, T_y), filtered \[N, N m\].
    pub(super) filtered: Vector6<f64>,
}

/// Contacts of this cycle.
pub(super) struct Footing {
    /// Compliance and position-control inputs: right, left.
    pub(super) feet: [(Compliance, FootReference); 2],
    /// Measured (F_z, T_x, T_y), filtered \[N, N m\].
    pub(super) measured: Vector6<f64>,
}

impl Footing {
    pub(super) fn contacts(&self) -> [FootContact; 2] {
        [self.feet[0].1.contact, self.feet[1].1.contact]
    }
}

impl FootContacts {
    pub(super) fn new() -> Self {
        Self {
            contacts: [FootContact::default(); 2],
            stiffness: [Matrix3::zeros(); 2],
            compliance: [Compliance::new(&Matrix3::zeros()); 2],
            filtered: Vector6::zeros(),
        }
    }

    /// Both feet swing, and the filter begins with what is `measured`.
    pub(super) fn reset(&mut self, measured: Vector6<f64>) {
        self.contacts = [FootContact::default(); 2];
        self.filtered = measured;
    }

    /// One cycle with these `measured` forces \[N, N m\].
    pub(super) fn update_contacts(&mut self, cycle: &ControlCycle<'_>, measured: Vector6<f64>) -> Footing {
        let a = (cycle.dt / cycle.control.force_filter).min(1.0);
        self.filtered += (measured - self.filtered) * a;
        let feet = [0, 1].map(|foot| {
            let rise = cycle.now.feet[foot].velocity[2];
            let load = [cycle.now.load[foot], cycle.end.load[foot]];
            self.contacts[foot].update(cycle.control, &Signs { load, rise, force: self.filtered[3 * foot] });
            // A decomposition, made anew only where toes or a pitched sole change which points carry.
            let k = stiffness(cycle, foot);
            if k != self.stiffness[foot] {
                self.stiffness[foot] = k;
                self.compliance[foot] = Compliance::new(&k);
            }
            let target = inclination_target(cycle, foot);
            (self.compliance[foot], FootReference { contact: self.contacts[foot], rise, target })
        });
        Footing { feet, measured: self.filtered }
    }
}

/// K of a foot on the contact points that the plan has on the ground: all of a flat foot, one edge of a pitched
/// one, those of the toe segment while the toe bends (5.23).
fn stiffness(cycle: &ControlCycle<'_>, foot: usize) -> Matrix3<f64> {
    let (s, c) = cycle.end.pitch[foot].position[0].sin_cos();
    let points = cycle.kinematics.contact_points(foot).map(|p| (p, c * p.z - s * p.x));
    let lowest = points.clone().fold(f64::INFINITY, |low, (_, height)| low.min(height));
    let closed = points.map(|(p, height)| (p, (1.0 - (height - lowest) / OPEN).clamp(0.0, 1.0)));
    contact_stiffness(closed, cycle.sensor_from_sole(foot), cycle.robot.contact.normal_stiffness)
}

/// Swing foot modification for an upper body that leans: where the plan wants it over the ground (4.9).
fn inclination_target(cycle: &ControlCycle<'_>, foot: usize) -> Vector3<f64> {
    let now = cycle.now;
    let error = |i: usize| now.torso.position[i] - cycle.estimate.angles[i];
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
    // Soles come down as the ground lies that was learned.
    let ground = Vector2::new(cycle.slope.y, -cycle.slope.x);
    let lies = Vector3::new(0.0, c * ground.x + s * ground.y, -s * ground.x + c * ground.y);
    Vector3::new(lift, of_foot.x, of_foot.y) * cycle.control.inclination_compensation + lies
}

/// Measured (F_z, T_x, T_y) of both feet at the sensors, in the axes of their soles: those of the sensors unless the
/// toes bend (5.20), (5.21).
pub(super) fn measured_forces(kinematics: &TaskSpace, sensors: &Sensors) -> Vector6<f64> {
    let wrenches = std::array::from_fn(|i| {
        let w = &sensors.foot_wrench[i];
        let turn = kinematics.sole(i).rotation.transpose() * kinematics.sensor(i).rotation;
        FootWrench { force: turn * Vector3::from(w.force), moment: turn * Vector3::from(w.moment) }
    });
    force_coordinates(&wrenches)
}

/// (F_z, T_x, T_y) of both feet.
pub(super) fn force_coordinates(wrenches: &[FootWrench; 2]) -> Vector6<f64> {
    Vector6::from_fn(|i, _| {
        let w = &wrenches[i / 3];
        [w.force.z, w.moment.x, w.moment.y][i % 3]
    })
}
