//! Nothing allocates after the model and its data are made.

mod legs;
mod tree;

use multibody::{Data, Rotor};
use nalgebra::{Matrix3xX, Matrix6xX, Vector3};
use realtime::{CountingAllocator, allocations};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn every_function_works_in_the_memory_made_at_the_start() {
    let mut dice = tree::Dice(11);
    let plain = tree::random(&mut dice, 20);
    let rotor = |name: &str, joints: &[usize]| Rotor {
        name: name.into(),
        link: "link 0".into(),
        axis: Vector3::x(),
        inertia: 1e-4,
        joints: joints.to_vec(),
    };
    let model =
        plain.clone().with_rotors(&[rotor("geared", &[0]), rotor("free", &[])]).expect("small rotors");
    let mut d = Data::new(&model);
    let q = tree::configuration(&mut dice, &model);
    let (v, a) = (dice.list(model.nv(), 1.0), dice.list(model.nv(), 1.0));
    let (mut next, mut rate, mut out) = (q.clone(), q.clone(), v.clone());
    let (mut j, mut joints) = (Matrix6xX::zeros(model.nv()), Matrix6xX::zeros(model.n()));
    let (mut c, mut c_joints) = (Matrix3xX::zeros(model.nv()), Matrix3xX::zeros(model.n()));
    let frame = model.frame("link 20", [0.1, 0.2, 0.3]).expect("the link exists");

    let limbs = model.limbs(&[frame]);

    let leg = legs::leg(1.0);
    let (stance, high) = (legs::posture(1.0, [0.1; 6]), Vector3::repeat(1e3));

    allocations::arm();
    model.integrate(&q, &v, 1e-3, &mut next);
    model.configuration_rate(&q, &v, &mut rate);
    model.forward_kinematics(&mut d, &q);
    model.forward_motion(&mut d, &q, &v);
    let seen = (model.frame_pose(&d, &frame), model.frame_velocity(&d, &frame), model.frame_bias(&d, &frame));
    model.frame_jacobian(&d, &frame, &mut j);
    model.frame_jacobian_of_joints(&d, &frame, &mut joints);
    model.add_wrench(&d, &frame, &Vector3::x(), &Vector3::y(), &mut out);
    let whole = (model.cog(&mut d), model.cog_motion(&d), model.momentum(&d), model.energy(&d));
    model.cog_jacobian(&d, &mut c);
    model.cog_jacobian_of_joints(&d, &mut c_joints);
    model.mass_matrix(&mut d, &q);
    model.nonlinear_terms(&mut d, &q, &v, &mut out);
    model.inverse_dynamics(&mut d, &q, &v, &a, &mut out);
    model.forward_dynamics(&mut d, &q, &v, &a, &mut out);
    d.set_gear(0, [50.0, 0.0, 0.0], 0.1);
    d.set_free_rotor(1, 100.0, 0.1);
    model.forward_dynamics(&mut d, &q, &v, &a, &mut out);
    let spin = model.rotor_acceleration(&d, 1);
    plain.forward_dynamics_articulated(&mut d, &q, &v, &a, &mut out);
    model.solve_mass_matrix(&mut d, &mut out);
    model.set_position(&mut d, &q);
    model.limb_motion_here(&mut d, &limbs, &v);
    model.inverse_dynamics_here(&mut d, &v, &a, &mut out);
    let carried = model.carried_wrench(&d, &frame);
    let base = model.base_dynamics(&mut d, &q, &v, &a[6..]);
    let (rotation, position) = leg.pose(&stance);
    let legs = (leg.angles(&rotation, &position), leg.angles(&rotation, &high));
    let [counted, _] = allocations::counted();
    let _ = std::hint::black_box((seen, legs, whole, base, next, rate, spin, carried));
    assert_eq!(counted, 0);

    drop(Box::new(std::hint::black_box(1)));
    assert!(allocations::counted()[0] > 0, "the counter counts");
}
