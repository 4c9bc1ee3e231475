//! Poses and motions of bodies and frames.
//!
//! | symbol | name | unit | axes |
//! |---|---|---|---|
//! | a | rotation world_from_body | 1 | |
//! | r | origin of the body | m | world |
//! | e | axis of the body's joint along its coordinate | 1 | world |
//! | w, v | angular velocity, velocity of the origin (2.1), (2.3) | rad/s, m/s | world |
//! | dw, dv | the same, differentiated, for v' = 0: the products J' v of (2.2), (2.4) | | world |
//!
//! The thesis carries velocities in body axes and gives no recursion for the products; here they are those of errata
//! F1, in world axes, where the "- w_rel x" terms vanish.

use nalgebra::{IsometryMatrix3, UnitQuaternion, Vector3};

use crate::body::JointKernel;
use crate::data::{BodyMotion, BodyPlace, Data, with_turn};
use crate::model::{Frame, Model};
use crate::space::{Mat3, V3, ZERO};
use crate::turn::Turn;

/// A velocity, or an acceleration, of a frame: of its origin and of its rotation. World axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// \[m/s\], \[m/s^2\]
    pub linear: Vector3<f64>,
    /// \[rad/s\], \[rad/s^2\]
    pub angular: Vector3<f64>,
}

/// The bodies between the base and some frames, for queries about these frames alone; made once by [`Model::limbs`].
#[derive(Clone, Debug)]
pub struct Limbs {
    /// Parents first, without the base.
    bodies: Vec<usize>,
}

impl Model {
    /// Poses of all bodies at `q`. Motions in `data` are then stale.
    pub fn forward_kinematics(&self, data: &mut Data, q: &[f64]) {
        self.set_position(data, q);
        self.forward_kinematics_here(data);
    }

    /// [`Model::forward_kinematics`] at the configuration that `data` has.
    pub fn forward_kinematics_here(&self, data: &mut Data) {
        let Data { joints, oblique, places, base, origin, .. } = data;
        places[0] = BodyPlace { a: *base, r: *origin, e: ZERO };
        for (k, body) in self.bodies.iter().enumerate().skip(1) {
            let (p, j) = (places[body.parent], &joints[k]);
            with_turn!(body, j, &oblique[k], t => {
                let a = t.chain(p.a);
                places[k] = BodyPlace { a, r: p.r + p.a * j.r, e: t.column_of(&a) * body.sign };
            });
        }
    }

    /// Poses, velocities and velocity-product accelerations of all bodies at `q`, `v`.
    pub fn forward_motion(&self, data: &mut Data, q: &[f64], v: &[f64]) {
        self.forward_kinematics(data, q);
        self.motion(data, v);
    }

    /// Velocities and velocity-product accelerations of all bodies, the poses being known.
    pub fn motion(&self, data: &mut Data, v: &[f64]) {
        assert_eq!(v.len(), self.nv(), "length of v");
        let Data { places, motions, spins, .. } = data;
        self.rotor_speeds(spins, v);
        motions[0] = base_motion(&places[0], v);
        for (k, (body, &qd)) in self.bodies.iter().skip(1).zip(&v[6..]).enumerate() {
            let d = places[k + 1].r - places[body.parent].r;
            motions[k + 1] = carried_on(&motions[body.parent], body.kind, d, places[k + 1].e * qd);
        }
    }

    /// Poses, velocities and velocity-product accelerations of the bodies of some limbs at the configuration that `data`
    /// has; those of all other bodies are then stale.
    pub fn limb_motion_here(&self, data: &mut Data, limbs: &Limbs, v: &[f64]) {
        assert_eq!(v.len(), self.nv(), "length of v");
        let Data { joints, oblique, places, motions, base, origin, .. } = data;
        places[0] = BodyPlace { a: *base, r: *origin, e: ZERO };
        motions[0] = base_motion(&places[0], v);
        for &k in &limbs.bodies {
            let (body, j) = (&self.bodies[k], &joints[k]);
            let p = places[body.parent];
            let d = p.a * j.r;
            with_turn!(body, j, &oblique[k], t => {
                let a = t.chain(p.a);
                places[k] = BodyPlace { a, r: p.r + d, e: t.column_of(&a) * body.sign };
            });
            motions[k] = carried_on(&motions[body.parent], body.kind, d, places[k].e * v[k + 5]);
        }
    }

    /// The limbs that carry some frames.
    pub fn limbs(&self, frames: &[Frame]) -> Limbs {
        let mut needed = vec![false; self.bodies.len()];
        for frame in frames {
            let mut k = frame.body;
            while k != 0 && !needed[k] {
                needed[k] = true;
                k = self.bodies[k].parent;
            }
        }
        Limbs { bodies: (1..needed.len()).filter(|&k| needed[k]).collect() }
    }

    /// world_from_frame, after [`Model::forward_kinematics`].
    pub fn frame_pose(&self, data: &Data, frame: &Frame) -> IsometryMatrix3<f64> {
        let p = &data.places[frame.body];
        let r: Vector3<f64> = (p.r + p.a * frame.r).into();
        IsometryMatrix3::from_parts(r.into(), (p.a * frame.rotation).into())
    }

    /// The same as position \[m\] and quaternion (x, y, z, w).
    pub fn frame_place(&self, data: &Data, frame: &Frame) -> ([f64; 3], [f64; 4]) {
        let pose = self.frame_pose(data, frame);
        let turn = UnitQuaternion::from_rotation_matrix(&pose.rotation);
        (pose.translation.vector.into(), turn.coords.into())
    }

    /// \[m\] Origin of a frame in the world, after [`Model::forward_kinematics`].
    pub fn frame_position(&self, data: &Data, frame: &Frame) -> Vector3<f64> {
        let p = &data.places[frame.body];
        (p.r + p.a * frame.r).into()
    }

    /// \[m\] Origin of a joint in the world, after [`Model::forward_kinematics`].
    pub fn joint_position(&self, data: &Data, joint: usize) -> Vector3<f64> {
        data.places[joint + 1].r.into()
    }

    /// Velocity of a frame's origin and its angular velocity (2.1), (2.3), after [`Model::forward_motion`].
    pub fn frame_velocity(&self, data: &Data, frame: &Frame) -> Twist {
        let m = &data.motions[frame.body];
        let d = data.places[frame.body].a * frame.r;
        Twist { linear: (m.v + m.w.cross(d)).into(), angular: m.w.into() }
    }

    /// J' v: acceleration of a frame when v' = 0 (2.2), (2.4), after [`Model::forward_motion`]. The acceleration is
    /// J v' plus this.
    pub fn frame_bias(&self, data: &Data, frame: &Frame) -> Twist {
        let m = &data.motions[frame.body];
        let d = data.places[frame.body].a * frame.r;
        let dv = m.dv + m.dw.cross(d) + m.w.cross(m.w.cross(d));
        Twist { linear: dv.into(), angular: m.dw.into() }
    }

    /// Adds J^T (force, moment) to a generalized force: a force \[N\] at the frame's origin and a moment \[N m\], world
    /// axes, that act on the frame's body. Needs [`Model::forward_kinematics`].
    pub fn add_wrench(
        &self,
        data: &Data,
        frame: &Frame,
        force: &Vector3<f64>,
        moment: &Vector3<f64>,
        generalized: &mut [f64],
    ) {
        let (f, n) = (V3::from(*force), V3::from(*moment));
        let place = &data.places[frame.body];
        let at = place.r + place.a * frame.r;
        let mut k = frame.body;
        while k != 0 {
            let (p, body) = (&data.places[k], &self.bodies[k]);
            generalized[5 + k] += match body.kind {
                JointKernel::Along(_) => p.e.dot(f),
                _ => p.e.dot(n + (at - p.r).cross(f)),
            };
            k = body.parent;
        }
        let base = &data.places[0];
        add(&mut generalized[..3], base.a, f);
        add(&mut generalized[3..6], base.a, n + (at - base.r).cross(f));
    }
}

/// The base's motion from v.
#[inline(always)]
fn base_motion(place: &BodyPlace, v: &[f64]) -> BodyMotion {
    let (w, vel) = (place.a * V3::from_slice(&v[3..]), place.a * V3::from_slice(v));
    BodyMotion { w, v: vel, dw: ZERO, dv: w.cross(vel) }
}

/// A body's motion from that of its parent `p`, whose origin is -d away; e has the length of the joint's speed.
#[inline(always)]
fn carried_on(p: &BodyMotion, kind: JointKernel, d: V3, e: V3) -> BodyMotion {
    let mut m = BodyMotion {
        w: p.w,
        v: p.v + p.w.cross(d),
        dw: p.dw,
        dv: p.dv + p.dw.cross(d) + p.w.cross(p.w.cross(d)),
    };
    if let JointKernel::Along(_) = kind {
        m.v += e;
        m.dv += p.w.cross(e) * 2.0;
    } else {
        m.w += e;
        m.dw += p.w.cross(e);
    }
    m
}

fn add(out: &mut [f64], a: Mat3, world: V3) {
    for (o, x) in out.iter_mut().zip(a.t_mul(world).array()) {
        *o += x;
    }
}
