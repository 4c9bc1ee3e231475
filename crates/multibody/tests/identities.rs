//! What must hold between the results for any tree: each number by two independent routes.

mod tree;

use multibody::{Data, Frame, Model};
use nalgebra::{DVector, Matrix3xX, Matrix6xX, Vector3};
use proptest::prelude::*;
use tree::{Dice, configuration, error};

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
}

fn both(a: Vector3<f64>, b: Vector3<f64>) -> Vec<f64> {
    a.iter().chain(b.iter()).copied().collect()
}
