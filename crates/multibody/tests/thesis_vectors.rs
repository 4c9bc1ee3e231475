//! Vectors V1 and F13 of the errata: a root with z-x-z Euler angles, two segments and a motor that turns -100 times as
//! fast as the joint it drives.
//!
//! Here the base has a quaternion and the motor is a body on a joint of its own. The thesis's coordinates come back by
//! v = T(q) q', with F2's J_R,u for the root and -100 for the motor: M = T^T M_ours T, h = T^T (M_ours T' q' + h_ours).
//! With the motor as a rotor of the torso the rows of its joint fall away, and the same numbers must come.
//! V12 (a three-degree system without bodies) and V14 (centre of pressure) have no counterpart in this crate.

use multibody::{Data, Inertia, JointKind, Model, ModelBuilder, Rotor};
use nalgebra::{DMatrix, DVector, IsometryMatrix3, Matrix3, Rotation3, UnitQuaternion, Vector3};
use serde_json::Value;

struct Robot {
    model: Model,
    data: Data,
    q: Vec<f64>,
    v: DVector<f64>,
    /// T (9 x 8) and T' q'.
    t: DMatrix<f64>,
    bias: DVector<f64>,
}

#[test]
fn mass_matrix_and_nonlinear_terms() {
    let vectors = vectors();
    let f = &vectors["F1_F2_F6"];
    for r in [robot(f), robot_with_rotor(f)] {
        check_dynamics(f, r);
    }
}

fn check_dynamics(f: &Value, mut r: Robot) {
    let m_ours = r.model.mass_matrix(&mut r.data, &r.q).clone();
    let m = r.t.transpose() * &m_ours * &r.t;
    near("M", m.as_slice(), &flat(&f["M"]), 1e-12);
    let mut h_ours = vec![0.0; r.model.nv()];
    r.model.nonlinear_terms(&mut r.data, &r.q, r.v.as_slice(), &mut h_ours);
    let h = r.t.transpose() * (m_ours * &r.bias + DVector::from_vec(h_ours));
    near("h", h.as_slice(), &flat(&f["h"]), 1e-12);
    let forces = &m * DVector::from_vec(flat(&f["qdd"])) + &h;
    near("M q'' + h", forces.as_slice(), &flat(&f["tau_id"]), 1e-12);
    let free = m.lu().solve(&-h).expect("M is regular");
    near("free fall", free.as_slice(), &flat(&f["acc_free"]), 1e-11);
}

#[test]
fn velocities_and_velocity_products_of_the_bodies() {
    let vectors = vectors();
    let f = &vectors["F1_F2_F6"];
    let mut r = robot(f);
    r.model.forward_motion(&mut r.data, &r.q, r.v.as_slice());
    for (k, body) in f["kin"].as_array().expect("a list").iter().enumerate() {
        let frame = r.model.frame(&format!("body {k}"), [0.0; 3]).expect("the body exists");
        let a_ki = r.model.frame_pose(&r.data, &frame).rotation.inverse();
        let a_rows: Vec<f64> = a_ki.matrix().transpose().iter().copied().collect();
        near("A_kI", &a_rows, &flat(&body["A_kI"]), 1e-12);
        let t = r.model.frame_velocity(&r.data, &frame);
        let (v, w) = (a_ki * t.linear, a_ki * t.angular);
        near("v", v.as_slice(), &flat(&body["v"]), 1e-12);
        near("w", w.as_slice(), &flat(&body["w"]), 1e-12);
        let mut j = nalgebra::Matrix6xX::zeros(9);
        r.model.frame_jacobian(&r.data, &frame, &mut j);
        let thesis = &j * &r.t;
        let rows = |from: usize| -> Vec<f64> {
            let part = a_ki.matrix() * thesis.fixed_rows::<3>(from);
            part.transpose().iter().copied().collect()
        };
        near("J_T", &rows(0), &flat(&body["JT"]), 1e-12);
        near("J_R", &rows(3), &flat(&body["JR"]), 1e-12);
        // F1: bT and bR differentiate components, ours the vectors: the difference is w x v.
        let (own, product) = (r.model.frame_bias(&r.data, &frame), &j * &r.bias);
        let b_t = a_ki * (own.linear + product.fixed_rows::<3>(0)) - w.cross(&v);
        let b_r = a_ki * (own.angular + product.fixed_rows::<3>(3));
        near("J_T' q'", b_t.as_slice(), &flat(&body["JTq_qd"]), 1e-12);
        near("J_R' q'", b_r.as_slice(), &flat(&body["JRq_qd"]), 1e-11);
    }
}

#[test]
fn momentum_and_energy() {
    let vectors = vectors();
    let (f, momentum) = (&vectors["F1_F2_F6"], &vectors["F13_mom"]);
    for mut r in [robot(f), robot_with_rotor(f)] {
        r.model.forward_motion(&mut r.data, &r.q, r.v.as_slice());
        near("CoG", r.model.cog(&mut r.data).as_slice(), &flat(&momentum["C"]), 1e-12);
        let ours = r.model.momentum(&r.data);
        near("p", ours.linear.as_slice(), &flat(&momentum["p"]), 1e-12);
        near("L", ours.angular.as_slice(), &flat(&momentum["L"]), 1e-12);
        let (kinetic, potential) = r.model.energy(&r.data);
        near("E", &[kinetic + potential], &[123.182471126], 1e-11);
    }
}

/// V2 (F9): the motor's torque of 0.7 Nm acts between torso and rotor, so the base feels none of it. The rotor as a body
/// answers with its own acceleration -100 q'' when the joint's force is T^T (0 .. 0.7 .. 0).
#[test]
fn motor_torque_reacts_on_the_stator() {
    let vectors = vectors();
    let f = &vectors["F1_F2_F6"];
    let full = robot(f);
    let mut torque = DVector::zeros(9);
    torque[7] = 0.7;
    let q = full.t.transpose() * torque;
    near("Q", q.as_slice(), &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -70.0, 0.0], 1e-14);
    let mut r = robot_with_rotor(f);
    let mut force = vec![0.0; 8];
    force[6] = q[6];
    let mut a = force.clone();
    r.model.forward_dynamics(&mut r.data, &r.q, r.v.as_slice(), &force, &mut a);
    let m = DMatrix::from_row_slice(8, 8, &flat(&f["M"]));
    let h = DVector::from_vec(flat(&f["h"]));
    let thesis = &r.t * m.lu().solve(&(q - h)).expect("M is regular") + &r.bias;
    near("v'", &a, thesis.as_slice(), 1e-10);
}

fn vectors() -> Value {
    serde_json::from_str(include_str!("vectors/errata_1.json")).expect("JSON")
}

fn robot(f: &Value) -> Robot {
    let (q8, qd) = (flat(&f["q"]), flat(&f["qd"]));
    let model = model(&f["bodies"]);
    // F2: A_uI = A_z(phi) A_x(theta) A_z(psi).
    let (sf, cf) = q8[2].sin_cos();
    let (st, ct) = q8[1].sin_cos();
    let (psi, theta, phi) = (qd[0], qd[1], qd[2]);
    let turn = |axis, a: f64| Rotation3::from_axis_angle(&axis, a);
    let (x, z) = (Vector3::x_axis(), Vector3::z_axis());
    let world_from_base = turn(z, q8[0]) * turn(x, q8[1]) * turn(z, q8[2]);
    let j_r = Matrix3::new(st * sf, cf, 0.0, st * cf, -sf, 0.0, ct, 0.0, 1.0);
    let j_r_rate = Vector3::new(
        (ct * sf * theta + st * cf * phi) * psi - sf * phi * theta,
        (ct * cf * theta - st * sf * phi) * psi - cf * phi * theta,
        -st * theta * psi,
    );
    let mut t = DMatrix::zeros(9, 8);
    t.fixed_view_mut::<3, 3>(0, 3).copy_from(world_from_base.inverse().matrix());
    t.fixed_view_mut::<3, 3>(3, 0).copy_from(&j_r);
    for (row, column, factor) in [(6, 6, 1.0), (7, 6, -100.0), (8, 7, 1.0)] {
        t[(row, column)] = factor;
    }
    let v = &t * DVector::from_vec(qd);
    let (linear, angular) = (v.fixed_rows::<3>(0).into_owned(), v.fixed_rows::<3>(3).into_owned());
    let mut bias = DVector::zeros(9);
    bias.fixed_rows_mut::<3>(0).copy_from(&-angular.cross(&linear));
    bias.fixed_rows_mut::<3>(3).copy_from(&j_r_rate);
    let mut q = q8[3..6].to_vec();
    q.extend(UnitQuaternion::from_rotation_matrix(&world_from_base).coords.iter());
    q.extend([q8[6], -100.0 * q8[6], q8[7]]);
    Robot { data: Data::new(&model), model, q, v, t, bias }
}

/// The motor as a rotor of the torso, which has its mass and its inertia.
fn robot_with_rotor(f: &Value) -> Robot {
    let full = robot(f);
    let motor = flat(&f["bodies"][2]["A0"]);
    let rotor = Rotor {
        name: "motor".into(),
        link: "body 0".into(),
        axis: Vector3::from_column_slice(&motor[6..]),
        inertia: flat(&f["bodies"][2]["Io"])[8],
        joints: vec![0],
    };
    let model = tree(&f["bodies"], true).build().expect("valid tree");
    let model = model.with_rotors(&[rotor]).expect("a rotor in the torso");
    let mut data = Data::new(&model);
    data.set_gear(0, [-100.0, 0.0, 0.0], 0.0);
    let mut q = full.q;
    q.remove(8);
    let (v, t, bias) = (full.v.remove_row(7), full.t.remove_row(7), full.bias.remove_row(7));
    Robot { model, data, q, v, t, bias }
}

fn model(bodies: &Value) -> Model {
    tree(bodies, false).build().expect("valid tree")
}

fn tree(bodies: &Value, locked: bool) -> ModelBuilder {
    let bodies = bodies.as_array().expect("a list");
    let inertia = |b: &Value| {
        let center = Vector3::from_column_slice(&flat(&b["c"]));
        Inertia::about_origin(
            b["m"].as_f64().expect("a mass"),
            center,
            Matrix3::from_row_slice(&flat(&b["Io"])),
        )
    };
    let mut builder = ModelBuilder::new("body 0", inertia(&bodies[0]));
    for (k, b) in bodies.iter().enumerate().skip(1) {
        // A0 maps parent to child components; its rows, read as columns, are parent_from_child.
        let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_column_slice(&flat(&b["A0"])));
        let placement =
            IsometryMatrix3::from_parts(Vector3::from_column_slice(&flat(&b["r"])).into(), rotation);
        let (name, parent) = (format!("body {k}"), format!("body {}", b["parent"]));
        let kind = if locked && k == 2 { JointKind::Fixed } else { JointKind::Revolute(Vector3::z()) };
        builder.joint(&name, &parent, &name, &placement, kind, &inertia(b)).expect("valid joint");
    }
    builder
}

fn flat(v: &Value) -> Vec<f64> {
    match v {
        Value::Array(list) => list.iter().flat_map(flat).collect(),
        number => vec![number.as_f64().expect("a number")],
    }
}

fn near(what: &str, ours: &[f64], theirs: &[f64], tolerance: f64) {
    assert_eq!(ours.len(), theirs.len(), "{what}");
    let scale = theirs.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
    for (a, b) in ours.iter().zip(theirs) {
        assert!((a - b).abs() <= tolerance * scale, "{what}: {ours:?} is not {theirs:?}");
    }
}
