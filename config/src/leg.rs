//! Legs in closed form: `[leg.right]`, `[leg.left]`, the map between their angles and the robot's joints, and what the URDF
//! says to it.
//!
//! A row holds a link of Denavit and Hartenberg and the joint that turns about its axis: theta = `theta_deg` + `sign` q.
//! Frame {0} has its origin in that of the foot's link, x up, z forward, while the sole is flat; frame {6} is that of the
//! torso's origin, x to the right, y back, z down.

use std::f64::consts::PI;

use multibody::{ClosedFormLeg, Data, DhRow, Model, check_rotation};
use nalgebra::{Matrix3, Matrix6xX, Vector3};

pub use multibody::LegError;

use crate::joint::{Joint, joint_index};
use crate::robot::{Foot, Robot};
use crate::section::Section;

/// Leg of six joints whose angles are found in closed form.
#[derive(Clone, Debug)]
pub struct Leg {
    /// Joints of the robot, from the foot on: the order of all angles here.
    pub joints: [usize; 6],
    /// Leg in the angles of the thesis.
    pub form: ClosedFormLeg,
    rows: [DhRow; 6],
    /// +1 or -1: theta counted along the robot's joint, or against it.
    signs: [f64; 6],
    /// \[rad\] Software ranges of the joints.
    ranges: [[f64; 2]; 6],
    /// \[m\] Origin of frame {0} in the sole frame.
    ankle: Vector3<f64>,
}

/// Axes of frame {0} in the sole frame, columns; thesis, figures 3.1, 3.2, 4.9.
const SOLE_FROM_0: Matrix3<f64> = Matrix3::new(0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0);
/// Axes of frame {6} in the torso's; thesis, figure 4.10.
const TORSO_FROM_6: Matrix3<f64> = Matrix3::new(0.0, -1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0);
/// \[rad\] A joint this far outside of its range still stands at its end: rounding of a pose taken from there.
const RANGE_TOLERANCE: f64 = 1e-9;
/// \[m, rad\] Most that rows and URDF may differ.
const URDF_TOLERANCE: f64 = 1e-9;

impl Leg {
    /// Angles \[rad\] of the joints [`Leg::joints`], in the robot's signs, for poses of the sole frame and of the torso: rotation
    /// and position \[m\] of each in one common frame, x forward, y left, z up.
    ///
    /// # Errors
    ///
    /// No such angles: every case of [`LegError`].
    pub fn angles(
        &self,
        sole: (&Matrix3<f64>, &Vector3<f64>),
        torso: (&Matrix3<f64>, &Vector3<f64>),
    ) -> Result<[f64; 6], LegError> {
        check_rotation(sole.0)?;
        check_rotation(torso.0)?;
        let common_from_0 = sole.0 * SOLE_FROM_0;
        let ankle = sole.1 + sole.0 * self.ankle;
        let rotation = common_from_0.tr_mul(&(torso.0 * TORSO_FROM_6));
        let theta = self.form.angles(&rotation, &common_from_0.tr_mul(&(torso.1 - ankle)))?;
        let q = self.from_theta(&theta);
        for ((&joint, &value), &range) in self.joints.iter().zip(&q).zip(&self.ranges) {
            if value < range[0] - RANGE_TOLERANCE || value > range[1] + RANGE_TOLERANCE {
                return Err(LegError::JointLimit { joint, value, range });
            }
        }
        Ok(q)
    }

    /// Rotation and position \[m\] of the sole frame in the torso at angles `q` \[rad\] of the joints [`Leg::joints`], in the
    /// robot's signs; within their ranges or not.
    pub fn sole_in_torso(&self, q: &[f64; 6]) -> (Matrix3<f64>, Vector3<f64>) {
        let (rotation, position) = self.form.pose(&self.theta(q));
        let torso_from_0 = TORSO_FROM_6 * rotation.transpose();
        let torso_from_sole = torso_from_0 * SOLE_FROM_0.transpose();
        (torso_from_sole, -(torso_from_0 * position) - torso_from_sole * self.ankle)
    }

    /// \[m\] Origins of the frames {0} to {6} in the sole frame at angles `q` \[rad\]: ankle, its second axis, knee, hip (three
    /// times), torso.
    pub fn chain_in_sole(&self, q: &[f64; 6]) -> [Vector3<f64>; 7] {
        let theta = self.theta(q);
        let (mut turn, mut at) = (SOLE_FROM_0, self.ankle);
        let mut origins = [at; 7];
        for (k, row) in self.rows.iter().enumerate() {
            let (rotation, shift) = row.transform(theta[k]);
            at += turn * shift;
            turn *= rotation;
            origins[k + 1] = at;
        }
        origins
    }

    /// Theta_1 to theta_6 \[rad\] of the thesis for the robot's angles \[rad\], both in the order of [`Leg::joints`].
    pub fn theta(&self, q: &[f64; 6]) -> [f64; 6] {
        std::array::from_fn(|k| self.rows[k].theta + self.signs[k] * q[k])
    }

    /// The robot's angles \[rad\], within half a turn, for theta_1 to theta_6 \[rad\].
    pub fn from_theta(&self, theta: &[f64; 6]) -> [f64; 6] {
        std::array::from_fn(|k| match self.signs[k] * (theta[k] - self.rows[k].theta) {
            q if q > PI => q - 2.0 * PI,
            q if q <= -PI => q + 2.0 * PI,
            q => q,
        })
    }

    fn build(table: &Section<'_, '_>, joints: &[Joint], foot: &Foot) -> Option<Self> {
        let names: Vec<&str> = joints.iter().map(|joint| joint.name.as_str()).collect();
        let rows = table.tables("rows", |row| {
            let length = |key| row.number(key, "m", -2.0..=2.0);
            let angle = |key| row.number(key, "deg", -180.0..=180.0).to_radians();
            let sign = row.number("sign", "", -1.0..=1.0);
            if sign.abs() < 1.0 {
                row.problem("sign", format!("{sign} is not allowed; it takes 1 or -1"));
            }
            let link = DhRow {
                a: length("a"),
                alpha: angle("alpha_deg"),
                d: length("d"),
                theta: angle("theta_deg"),
            };
            (joint_index(row, "joint", &row.text("joint"), &names), sign, link)
        });
        let Ok(all) = <[_; 6]>::try_from(rows) else {
            table.problem("rows", "has not six rows; the closed form takes one for each joint of a leg");
            return None;
        };
        let rows = all.map(|(.., link)| link);
        let numbers = rows.iter().flat_map(|row| [row.a, row.alpha, row.d, row.theta]);
        if numbers.chain(all.map(|(_, sign, _)| sign)).any(f64::is_nan) {
            return None; // said already
        }
        let form = ClosedFormLeg::new(&rows).map_err(|e| table.problem("rows", e.to_string())).ok()?;
        let mut of_rows = [0; 6];
        for (of_row, (joint, ..)) in of_rows.iter_mut().zip(&all) {
            *of_row = (*joint)?;
        }
        Some(Self {
            joints: of_rows,
            form,
            rows,
            signs: all.map(|(_, sign, _)| sign),
            ranges: of_rows.map(|joint| joints[joint].range),
            ankle: -Vector3::from(foot.sole),
        })
    }

    /// Axes of the joints at angles of zero, in the sole frame: direction along the robot's joint, and a point \[m\] on it.
    fn axes_at_zero(&self) -> [(Vector3<f64>, Vector3<f64>); 6] {
        // Frame of the row before, in frame {0}. Theta turns the torso on the foot, the robot's joint the foot on the torso.
        let mut frame = (Matrix3::identity(), Vector3::zeros());
        std::array::from_fn(|k| {
            let axis = (SOLE_FROM_0 * frame.0.column(2) * -self.signs[k], self.ankle + SOLE_FROM_0 * frame.1);
            let (turn, shift) = self.rows[k].transform(self.rows[k].theta);
            frame = (frame.0 * turn, frame.1 + frame.0 * shift);
            axis
        })
    }
}

/// `[leg]`: both legs.
pub(crate) fn build(table: &Section<'_, '_>, joints: &[Joint], feet: &[Foot; 2]) -> Option<[Leg; 2]> {
    let leg = |side, foot| table.table(side, |leg| Leg::build(leg, joints, foot)).flatten();
    let (right, left) = (leg("right", &feet[0]), leg("left", &feet[1]));
    Some([right?, left?])
}

/// Whether rows and URDF are one robot: for each leg the chain of joints, the sole at zero, and each joint's axis there.
/// A chain of turning joints is given by these (product of exponentials), so they agree in every pose.
pub(crate) fn compare_with_urdf(robot: &Robot, model: &Model) -> Result<(), String> {
    let Some(legs) = &robot.legs else { return Ok(()) };
    let names: Vec<&str> = robot.joints.iter().map(|joint| joint.name.as_str()).collect();
    for ((side, leg), foot) in ["right", "left"].into_iter().zip(legs).zip(&robot.feet) {
        compare(leg, foot, model, &names).map_err(|text| format!("leg.{side}.{text}"))?;
    }
    Ok(())
}

fn compare(leg: &Leg, foot: &Foot, model: &Model, names: &[&str]) -> Result<(), String> {
    let sole = model.frame(&foot.link, foot.sole).map_err(|e| format!("rows: {e}"))?;
    // The chain: one row for each joint from the foot to the torso.
    let mut next = sole.joint();
    for (row, &joint) in leg.joints.iter().enumerate() {
        if next != Some(joint) {
            let there = next.map_or("no further joint".into(), |j| format!("joint `{}`", names[j]));
            let (named, link) = (names[joint], &foot.link);
            return Err(format!(
                "rows[{row}]: joint `{named}`, but from `{link}` to the torso the URDF has {there} here"
            ));
        }
        next = model.parent_joint(joint);
    }
    if let Some(further) = next {
        return Err(format!("rows: joint `{}` of the URDF comes before the torso, too", names[further]));
    }

    // Each axis at zero: direction, and distance of the rows' point from the URDF's axis, seen from the sole, so that a wrong
    // length shows at the first axis behind it.
    let mut data = Data::new(model);
    model.forward_kinematics(&mut data, &model.neutral());
    let mut jacobian = Matrix6xX::zeros(model.n());
    model.frame_jacobian_of_joints(&data, &sole, &mut jacobian);
    let pose = model.frame_pose(&data, &sole);
    let sole_from_torso = pose.rotation.matrix().transpose();
    for (row, ((direction, point), &joint)) in leg.axes_at_zero().iter().zip(&leg.joints).enumerate() {
        let column = jacobian.column(joint);
        let axis: Vector3<f64> = sole_from_torso * column.fixed_rows::<3>(3);
        // The sole's velocity is axis x (sole - any point of the axis), and the sole is the origin here.
        let beside = (axis.cross(point) + sole_from_torso * column.fixed_rows::<3>(0)).norm();
        let turned = axis.cross(direction).norm().atan2(axis.dot(direction));
        let name = names[joint];
        if turned > URDF_TOLERANCE {
            let turned = turned.to_degrees();
            return Err(format!(
                "rows[{row}]: joint `{name}` turns about an axis of the URDF that is {turned:.6} deg off the one here; \
                 correct `sign` (180 deg: it is reversed), or angles of the rows before it"
            ));
        }
        if beside > URDF_TOLERANCE {
            let mm = 1e3 * beside;
            return Err(format!(
                "rows[{row}]: the axis of joint `{name}` in the URDF is {mm:.6} mm beside the one here; correct lengths \
                 of the rows before it"
            ));
        }
    }

    // The torso behind the last axis.
    let (rotation, position) = leg.sole_in_torso(&[0.0; 6]);
    let off = 1e3 * (position - pose.translation.vector).norm();
    let turned = (rotation - pose.rotation.matrix()).amax();
    if off > 1e3 * URDF_TOLERANCE || turned > URDF_TOLERANCE {
        return Err(format!(
            "rows[5]: with all joints at zero the torso of the URDF is {off:.6} mm and {turned:.6} rad off the one here; \
             correct lengths or `theta_deg` of the last rows"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    /// Frame {0} of a foot with its toes down, and frame {6} of a torso that turns, leans to its left and forward, in the world:
    /// errata of Archie's thesis, V14. Products of rotations about x, y and z as he stands.
    #[test]
    fn orientations_of_foot_and_torso() {
        let about = |axis: Vector3<f64>, angle: f64| *Rotation3::new(axis * angle).matrix();
        let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
        let foot = about(y, 0.2) * SOLE_FROM_0;
        let torso = about(z, 0.1) * about(x, -0.05) * about(y, 0.08) * TORSO_FROM_6;
        #[rustfmt::skip]
        let printed = [
            Matrix3::new(0.198669330795, 0.0, 0.980066577841, 0.0, -1.0, 0.0, 0.980066577841, 0.0, -0.198669330795),
            Matrix3::new(
                0.099708650872, -0.992220591383, -0.074541820315,
                -0.993760669166, -0.095540003756, -0.057548589053,
                0.049979169271, 0.079814821411, -0.995555963732,
            ),
        ];
        for (is, printed) in [foot, torso].into_iter().zip(printed) {
            assert!((is - printed).amax() < 1e-12, "{is}");
        }
    }
}
