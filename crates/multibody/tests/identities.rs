//! What must hold between the results for any tree: each number by two independent routes.

use crate::tree::{self, Dice, configuration, error};
use multibody::{Data, Frame, Model};
use nalgebra::{DVector, Matrix3xX, Matrix6xX, Vector3};
use proptest::prelude::*;

struct Case {
    model: Model,
    data: Data,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

fn case(links: usize, seed: u64) -> Case {
    let mut dice = Dice(seed);
    let model = tree::random(&mut dice, links);
    let q = configuration(&mut dice, &model);
    let (v, a) = (dice.list(model.nv(), 2.0), dice.list(model.nv(), 5.0));
    Case { data: Data::new(&model), model, q, v, a }
}

impl Case {
    fn last_frame(&self) -> Frame {
        let link = self.model.link_names().last().expect("a base").to_owned();
        self.model.frame(&link, [0.1, -0.2, 0.3]).expect("the link exists")
    }

    /// The configuration after moving for `dt` with constant v' = `a`: second order in dt on both sides.
    fn moved(&self, dt: f64) -> (Vec<f64>, Vec<f64>) {
        let v: Vec<f64> = self.v.iter().zip(&self.a).map(|(v, a)| v + a * dt).collect();
        let mean: Vec<f64> = self.v.iter().zip(&v).map(|(a, b)| 0.5 * (a + b)).collect();
        let mut q = self.q.clone();
        self.model.integrate(&self.q, &mean, dt, &mut q);
        (q, v)
    }

    /// Central difference of a function of (q, v) along v and a.
    fn rate(&mut self, f: impl Fn(&Model, &mut Data, &[f64], &[f64]) -> Vec<f64>) -> Vec<f64> {
        const H: f64 = 1e-5;
        let ((q1, v1), (q0, v0)) = (self.moved(H), self.moved(-H));
        let (f1, f0) = (f(&self.model, &mut self.data, &q1, &v1), f(&self.model, &mut self.data, &q0, &v0));
        f1.iter().zip(&f0).map(|(a, b)| (a - b) / (2.0 * H)).collect()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn forward_dynamics_undoes_inverse_dynamics(links in 0usize..20, seed: u64) {
        let Case { model, mut data, q, v, a } = case(links, seed);
        let (mut force, mut by_matrix, mut by_bodies) = (v.clone(), v.clone(), v.clone());
        model.inverse_dynamics(&mut data, &q, &v, &a, &mut force);
        model.forward_dynamics(&mut data, &q, &v, &force, &mut by_matrix);
        model.forward_dynamics_articulated(&mut data, &q, &v, &force, &mut by_bodies);
        prop_assert!(error(&by_matrix, &a) < 1e-9, "mass matrix: {}", error(&by_matrix, &a));
        prop_assert!(error(&by_bodies, &a) < 1e-9, "articulated: {}", error(&by_bodies, &a));
    }

    #[test]
    fn inverse_dynamics_is_mass_matrix_and_nonlinear_terms(links in 0usize..20, seed: u64) {
        let Case { model, mut data, q, v, a } = case(links, seed);
        let (mut force, mut h) = (v.clone(), v.clone());
        model.inverse_dynamics(&mut data, &q, &v, &a, &mut force);
        model.nonlinear_terms(&mut data, &q, &v, &mut h);
        let (m_tt, bias) = model.base_dynamics(&mut data, &q, &v, &a[6..]);
        let m = model.mass_matrix(&mut data, &q).clone();
        prop_assert_eq!(&m, &m.transpose());
        prop_assert!(m.clone().cholesky().is_some());
        let sum = &m * DVector::from_column_slice(&a) + DVector::from_column_slice(&h);
        prop_assert!(error(&force, sum.as_slice()) < 1e-12);
        // (2.80): the base's rows, joints prescribed.
        let base = m_tt * DVector::from_column_slice(&a[..6]).fixed_rows::<6>(0) + bias;
        prop_assert!(error(base.as_slice(), &force[..6]) < 1e-12);
        let mut x = force.clone();
        model.solve_mass_matrix(&mut data, &mut x);
        prop_assert!(error((m * DVector::from_vec(x)).as_slice(), &force) < 1e-10);
    }

    #[test]
    fn power_of_the_forces_is_the_rate_of_energy(links in 0usize..20, seed: u64) {
        let mut c = case(links, seed);
        let mut force = c.v.clone();
        c.model.inverse_dynamics(&mut c.data, &c.q, &c.v, &c.a, &mut force);
        let power: f64 = force.iter().zip(&c.v).map(|(f, v)| f * v).sum();
        let rate = c.rate(|m, d, q, v| {
            m.forward_motion(d, q, v);
            let (kinetic, potential) = m.energy(d);
            vec![kinetic + potential]
        });
        prop_assert!((rate[0] - power).abs() < 1e-6 * (1.0 + power.abs()), "{} {power}", rate[0]);
    }

    #[test]
    fn frames_move_as_their_jacobians_say(links in 0usize..20, seed: u64) {
        let mut c = case(links, seed);
        let f = c.last_frame();
        c.model.forward_motion(&mut c.data, &c.q, &c.v);
        let mut j = Matrix6xX::repeat(c.model.nv(), f64::NAN);
        c.model.frame_jacobian(&c.data, &f, &mut j);
        let velocity = &j * DVector::from_column_slice(&c.v);
        let twist = c.model.frame_velocity(&c.data, &f);
        prop_assert!(error(velocity.as_slice(), &both(twist.linear, twist.angular)) < 1e-13);
        let bias = c.model.frame_bias(&c.data, &f);
        let acceleration = &j * DVector::from_column_slice(&c.a)
            + DVector::from_column_slice(&both(bias.linear, bias.angular));

        let rate = c.rate(|m, d, q, v| {
            m.forward_motion(d, q, v);
            let (at, t) = (m.frame_position(d, &f), m.frame_velocity(d, &f));
            [both(at, t.linear), t.angular.as_slice().to_vec()].concat()
        });
        prop_assert!(error(&rate[..3], &velocity.as_slice()[..3]) < 1e-7);
        prop_assert!(error(&rate[3..], acceleration.as_slice()) < 1e-7);
        let pose = |m: &Model, d: &mut Data, q: &[f64]| { m.forward_kinematics(d, q); m.frame_pose(d, &f).rotation };
        let (q1, q0) = (c.moved(1e-5).0, c.moved(-1e-5).0);
        let turned = pose(&c.model, &mut c.data, &q1) * pose(&c.model, &mut c.data, &q0).inverse();
        let m = turned.matrix();
        let turn = Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12) / 4e-5;
        prop_assert!(error(turn.as_slice(), &velocity.as_slice()[3..]) < 1e-7);
    }

    #[test]
    fn wrenches_act_by_the_transposed_jacobian(links in 0usize..20, seed: u64) {
        let Case { model, mut data, q, v, a } = case(links, seed);
        let f = model.frame(model.link_names().last().unwrap(), [0.2, 0.1, -0.1]).unwrap();
        model.forward_kinematics(&mut data, &q);
        let (force, moment) = (Vector3::from_column_slice(&v[..3]), Vector3::from_column_slice(&v[3..6]));
        let mut generalized = a.clone();
        model.add_wrench(&data, &f, &force, &moment, &mut generalized);
        let mut wide = Matrix6xX::zeros(model.nv());
        let mut j = Matrix6xX::zeros(model.n());
        model.frame_jacobian(&data, &f, &mut wide);
        model.frame_jacobian_of_joints(&data, &f, &mut j);
        prop_assert_eq!(&wide.columns(6, model.n()).into_owned(), &j);
        let expected = wide.transpose() * DVector::from_column_slice(&both(force, moment)) + DVector::from_vec(a);
        prop_assert!(error(&generalized, expected.as_slice()) < 1e-13);
    }

    #[test]
    fn centre_of_gravity_moves_as_its_jacobian_says(links in 0usize..20, seed: u64) {
        let mut c = case(links, seed);
        c.model.forward_motion(&mut c.data, &c.q, &c.v);
        c.model.cog(&mut c.data);
        let mut j = Matrix3xX::repeat(c.model.nv(), f64::NAN);
        let mut of_joints = Matrix3xX::zeros(c.model.n());
        c.model.cog_jacobian(&c.data, &mut j);
        c.model.cog_jacobian_of_joints(&c.data, &mut of_joints);
        prop_assert_eq!(&j.columns(6, c.model.n()).into_owned(), &of_joints);
        let (velocity, bias) = c.model.cog_motion(&c.data);
        prop_assert!(error((&j * DVector::from_column_slice(&c.v)).as_slice(), velocity.as_slice()) < 1e-13);
        let acceleration = &j * DVector::from_column_slice(&c.a) + bias;
        let rate = c.rate(|m, d, q, v| {
            m.forward_motion(d, q, v);
            both(m.cog(d), m.cog_motion(d).0)
        });
        prop_assert!(error(&rate[..3], velocity.as_slice()) < 1e-7);
        prop_assert!(error(&rate[3..], acceleration.as_slice()) < 1e-7);
    }

    /// (3.1), (3.3): momentum changes by the external forces only, here gravity and the wrench on the base.
    #[test]
    fn momentum_obeys_the_laws_of_newton_and_euler(links in 0usize..20, seed: u64) {
        let mut c = case(links, seed);
        let mut force = c.v.clone();
        c.model.inverse_dynamics(&mut c.data, &c.q, &c.v, &c.a, &mut force);
        c.model.forward_motion(&mut c.data, &c.q, &c.v);
        let base = c.model.frame_pose(&c.data, &c.model.frame("link 0", [0.0; 3]).unwrap());
        let f = base.rotation * Vector3::from_column_slice(&force[..3]);
        let n = base.rotation * Vector3::from_column_slice(&force[3..6]);
        let arm = base.translation.vector - c.model.cog(&mut c.data);
        let rate = c.rate(|m, d, q, v| {
            m.forward_motion(d, q, v);
            let p = m.momentum(d);
            both(p.linear, p.angular)
        });
        let weight = multibody::GRAVITY * c.model.mass();
        prop_assert!(error(&rate, &both(f + weight, n + arm.cross(&f))) < 1e-6);
    }

    /// The functions that go on from a configuration give to the bit what those that take it give.
    #[test]
    fn here_is_where_the_configuration_was_taken(links in 0usize..20, seed: u64) {
        let mut c = case(links, seed);
        let (model, mut d) = (&c.model, Data::new(&c.model));
        let (mut x, mut y) = (c.v.clone(), c.v.clone());
        model.set_position(&mut d, &c.q);
        model.inverse_dynamics(&mut c.data, &c.q, &c.v, &c.a, &mut x);
        model.inverse_dynamics_here(&mut d, &c.v, &c.a, &mut y);
        prop_assert_eq!(&x, &y);
        model.nonlinear_terms(&mut c.data, &c.q, &c.v, &mut x);
        model.nonlinear_terms_here(&mut d, &c.v, &mut y);
        prop_assert_eq!(&x, &y);
        model.forward_dynamics(&mut c.data, &c.q, &c.v, &c.a, &mut x);
        model.forward_dynamics_here(&mut d, &c.v, &c.a, &mut y);
        prop_assert_eq!(&x, &y);
        prop_assert_eq!(model.mass_matrix(&mut c.data, &c.q), model.mass_matrix_here(&mut d));
        let base = model.base_dynamics(&mut c.data, &c.q, &c.v, &c.a[6..]);
        prop_assert_eq!(base, model.base_dynamics_here(&mut d, &c.v, &c.a[6..]));
        let frame = c.last_frame();
        model.limb_motion_here(&mut d, &model.limbs(&[frame]), &c.v);
        c.model.forward_motion(&mut c.data, &c.q, &c.v);
        let seen = |d: &Data| {
            let (p, t, b) = (model.frame_pose(d, &frame), model.frame_velocity(d, &frame), model.frame_bias(d, &frame));
            [p.rotation.matrix().as_slice(), &both(t.linear, t.angular), &both(b.linear, b.angular)].concat()
        };
        prop_assert!(error(&seen(&d), &seen(&c.data)) < 1e-13);
        let at = |d: &Data| model.frame_position(d, &frame);
        prop_assert_eq!(at(&d), at(&c.data));
        model.forward_kinematics_here(&mut d);
        prop_assert_eq!(model.cog(&mut d), model.cog(&mut c.data));
    }

    /// Newton and Euler for what a frame's body carries: for the base that is all, and for the last link, if it moves by a
    /// joint of its own, what the robot has more than the robot without it.
    #[test]
    fn carried_wrench_changes_the_momentum_of_what_is_carried(links in 1usize..20, seed: u64) {
        let mut c = case(links, seed);
        let mut force = c.v.clone();
        c.model.inverse_dynamics(&mut c.data, &c.q, &c.v, &c.a, &mut force);
        c.model.forward_motion(&mut c.data, &c.q, &c.v);
        let base = c.model.frame("link 0", [0.0; 3]).unwrap();
        let (f, n) = c.model.carried_wrench(&c.data, &base);
        let to_base = c.model.frame_pose(&c.data, &base).rotation.inverse();
        prop_assert!(error(&both(to_base * f, to_base * n), &force[..6]) < 1e-12);

        let frame = c.last_frame();
        let (f, n) = c.model.carried_wrench(&c.data, &frame);
        let at = c.model.frame_position(&c.data, &frame);
        let mut outside = vec![0.0; c.model.nv()];
        c.model.add_wrench(&c.data, &frame, &f, &n, &mut outside);
        if let Some(joint) = frame.joint() {
            prop_assert!((outside[6 + joint] - force[6 + joint]).abs() < 1e-12 * (1.0 + f.norm() + n.norm()));
        }
        let rest = tree::random(&mut Dice(seed), links - 1);
        if rest.n() + 1 == c.model.n() {
            let mut d = Data::new(&rest);
            let all = c.model.cog(&mut c.data) * c.model.mass();
            let of_link = c.rate(|m, data, q, v| {
                let mut d = Data::new(&rest);
                m.forward_motion(data, q, v);
                rest.forward_motion(&mut d, &q[..rest.nq()], &v[..rest.nv()]);
                let (whole, rest) = (about(m, data, at), about(&rest, &mut d, at));
                whole.iter().zip(rest).map(|(a, b)| a - b).collect()
            });
            let mass = c.model.mass() - rest.mass();
            rest.forward_kinematics(&mut d, &c.q[..rest.nq()]);
            let moment = all - rest.cog(&mut d) * rest.mass();
            let weight = multibody::GRAVITY * mass;
            let needed = both(f + weight, n + (moment - at * mass).cross(&multibody::GRAVITY));
            prop_assert!(error(&of_link, &needed) < 1e-6, "{of_link:?} {needed:?}");
        }
    }
}

/// Momentum, and moment of momentum about a point.
fn about(model: &Model, data: &mut Data, at: Vector3<f64>) -> Vec<f64> {
    let p = model.momentum(data);
    both(p.linear, p.angular + (model.cog(data) - at).cross(&p.linear))
}

fn both(a: Vector3<f64>, b: Vector3<f64>) -> Vec<f64> {
    a.iter().chain(b.iter()).copied().collect()
}
