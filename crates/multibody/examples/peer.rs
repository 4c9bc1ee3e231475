//! Answers a list of states with everything this crate computes, JSON in and out; `tests/peers/with_pinocchio.py` asks.

use std::io::{Read, stdin};

use multibody::{Data, Frame, Model, Twist};
use nalgebra::{Matrix3xX, Matrix6xX, Vector3};
use serde_json::{Value, json};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut text = String::new();
    stdin().read_to_string(&mut text)?;
    let request: Value = serde_json::from_str(&text)?;
    let joints: Vec<&str> = list(&request["joints"]).iter().filter_map(Value::as_str).collect();
    let urdf = request["urdf"].as_str().ok_or("no urdf")?;
    let model = Model::from_urdf(urdf, request["base"].as_str().ok_or("no base")?, &joints)?;
    let mut frames = Vec::new();
    for f in list(&request["frames"]) {
        let offset = numbers(&f[1]);
        frames.push(model.frame(f[0].as_str().ok_or("no link")?, [offset[0], offset[1], offset[2]])?);
    }
    let mut data = Data::new(&model);
    let answers: Vec<Value> =
        list(&request["states"]).iter().map(|state| answer(&model, &mut data, &frames, state)).collect();
    println!("{}", Value::Array(answers));
    Ok(())
}

fn answer(model: &Model, d: &mut Data, frames: &[Frame], state: &Value) -> Value {
    let [q, v, a, force, wrench] = ["q", "v", "a", "force", "wrench"].map(|k| numbers(&state[k]));
    let frame = &frames[state["frame"].as_u64().unwrap_or(0) as usize];
    let (mut h, mut id, mut fd, mut articulated) = (v.clone(), v.clone(), v.clone(), v.clone());
    model.nonlinear_terms(d, &q, &v, &mut h);
    model.inverse_dynamics(d, &q, &v, &a, &mut id);
    model.forward_dynamics(d, &q, &v, &force, &mut fd);
    model.forward_dynamics_articulated(d, &q, &v, &force, &mut articulated);
    let (base_mass, base_bias) = model.base_dynamics(d, &q, &v, &a[6..]);
    let mass_matrix = rows(model.mass_matrix(d, &q));
    let mut solve = force;
    model.solve_mass_matrix(d, &mut solve);
    let mut next = q.clone();
    model.integrate(&q, &v, state["dt"].as_f64().unwrap_or(0.0), &mut next);

    model.forward_motion(d, &q, &v);
    let poses: Vec<_> = frames.iter().map(|f| model.frame_pose(d, f)).collect();
    let velocities: Vec<_> = frames.iter().map(|f| twist(model.frame_velocity(d, f))).collect();
    let biases: Vec<_> = frames.iter().map(|f| twist(model.frame_bias(d, f))).collect();
    let (mut jacobian, mut of_joints) =
        (Matrix6xX::repeat(model.nv(), f64::NAN), Matrix6xX::zeros(model.n()));
    model.frame_jacobian(d, frame, &mut jacobian);
    model.frame_jacobian_of_joints(d, frame, &mut of_joints);
    let mut generalized = vec![0.0; model.nv()];
    let (f, n) = (Vector3::from_column_slice(&wrench[..3]), Vector3::from_column_slice(&wrench[3..]));
    model.add_wrench(d, frame, &f, &n, &mut generalized);
    let cog = model.cog(d);
    let (cog_velocity, cog_bias) = model.cog_motion(d);
    let (mut cog_jacobian, mut cog_of_joints) = (Matrix3xX::zeros(model.nv()), Matrix3xX::zeros(model.n()));
    model.cog_jacobian(d, &mut cog_jacobian);
    model.cog_jacobian_of_joints(d, &mut cog_of_joints);
    let momentum = model.momentum(d);
    json!({
        "mass_matrix": mass_matrix, "nonlinear_terms": h, "inverse_dynamics": id, "forward_dynamics": fd,
        "articulated": articulated, "base_mass": rows(&base_mass), "base_bias": base_bias.as_slice(), "solve": solve,
        "positions": poses.iter().map(|p| p.translation.vector.as_slice().to_vec()).collect::<Vec<_>>(),
        "rotations": poses.iter().map(|p| rows(p.rotation.matrix())).collect::<Vec<_>>(),
        "velocities": velocities, "biases": biases,
        "jacobian": rows(&jacobian), "jacobian_of_joints": rows(&of_joints), "wrench": generalized,
        "cog": cog.as_slice(), "cog_velocity": cog_velocity.as_slice(), "cog_bias": cog_bias.as_slice(),
        "cog_jacobian": rows(&cog_jacobian), "cog_jacobian_of_joints": rows(&cog_of_joints),
        "momentum": momentum.linear.as_slice(), "angular_momentum": momentum.angular.as_slice(),
        "energy": <[f64; 2]>::from(model.energy(d)), "integrate": &next[..7],
    })
}

fn list(v: &Value) -> &[Value] {
    v.as_array().map_or(&[], Vec::as_slice)
}

fn numbers(v: &Value) -> Vec<f64> {
    list(v).iter().filter_map(Value::as_f64).collect()
}

fn twist(t: Twist) -> Vec<f64> {
    t.linear.iter().chain(t.angular.iter()).copied().collect()
}

fn rows<R: nalgebra::Dim, C: nalgebra::Dim, S: nalgebra::RawStorage<f64, R, C>>(
    m: &nalgebra::Matrix<f64, R, C, S>,
) -> Vec<Vec<f64>> {
    m.row_iter().map(|r| r.iter().copied().collect()).collect()
}
