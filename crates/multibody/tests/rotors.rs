//! Rotors as gyrostats against rotors as bodies: the same robot twice, once with every rotor on a joint of its own,
//! once with the rotors' inertia in the links. What a gear does to the first is the projection by v = T v_geared + b.

use crate::tree::{self, Dice, configuration, error};
use multibody::{Data, Inertia, JointKind, Model, ModelBuilder, ModelError, Rotor};
use nalgebra::{DMatrix, DVector, IsometryMatrix3, Matrix3, Vector3};
use proptest::prelude::*;

/// The robot with n joints by both routes; the r rotors are the last joints of `bodies`.
struct Pair {
    bodies: Model,
    gyros: Model,
    /// Of the rotors: joints they are geared to with their ratios, and the part of phi'' at q'' = 0.
    gears: Vec<(Vec<usize>, [f64; 3], f64)>,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    /// Speeds of the rotors and torques on them, where they are free.
    speeds: Vec<f64>,
    torques: Vec<f64>,
}

fn pair(links: usize, seed: u64, free: bool) -> Pair {
    let mut dice = Dice(seed);
    let tree = tree::builder(&mut dice, links);
    let plain = tree.build().expect("valid tree");
    let (mut with_bodies, mut locked) = (tree.clone(), tree);
    let (mut rotors, mut gears) = (Vec::new(), Vec::new());
    let names: Vec<String> = plain.link_names().map(String::from).collect();
    for joint in 0..plain.n() {
        let path = path(&plain, joint);
        let (link, joints) = if free || dice.below(4) == 0 {
            (names[dice.below(names.len())].clone(), Vec::new())
        } else {
            let mut joints = path.clone();
            joints.truncate(1 + dice.below(3));
            let carrier = plain.parent_joint(*joints.last().unwrap());
            let stator = above(&plain, carrier, dice.below(3));
            let fits = |l: &&String| plain.frame(l, [0.0; 3]).unwrap().joint() == stator;
            (names.iter().find(fits).expect("every body has a link").clone(), joints)
        };
        let name = format!("rotor {joint}");
        let placement = IsometryMatrix3::from_parts(dice.vector(0.2).into(), dice.rotation());
        let (along, across) = (2e-3 + 1e-3 * dice.unit(), 3e-3 + 1e-3 * dice.unit());
        let inertia = Inertia {
            mass: 0.4,
            center: Vector3::z() * dice.unit() * 0.1,
            moments: Matrix3::from_diagonal(&Vector3::new(across, across, along)),
        };
        let add = |b: &mut ModelBuilder, kind| {
            b.joint(&name, &link, &name, &placement, kind, &inertia).expect("valid joint");
        };
        add(&mut with_bodies, JointKind::Revolute(Vector3::z()));
        add(&mut locked, JointKind::Fixed);
        let axis = placement.rotation * Vector3::z() * 3.0;
        rotors.push(Rotor { name, link, axis, inertia: along, joints: joints.clone() });
        gears.push((joints, [dice.unit() * 60.0, dice.unit() * 60.0, dice.unit() * 60.0], dice.unit() * 9.0));
    }
    let bodies = with_bodies.build().expect("valid tree");
    let gyros = locked.build().expect("valid tree").with_rotors(&rotors).expect("valid rotors");
    let q = configuration(&mut dice, &plain);
    let (v, a) = (dice.list(plain.nv(), 2.0), dice.list(plain.nv(), 5.0));
    let (speeds, torques) = (dice.list(rotors.len(), 200.0), dice.list(rotors.len(), 3.0));
    Pair { bodies, gyros, gears, q, v, a, speeds, torques }
}

/// A joint and those between it and the base.
fn path(model: &Model, joint: usize) -> Vec<usize> {
    std::iter::successors(Some(joint), |&j| model.parent_joint(j)).collect()
}

/// The body some joints nearer to the base, given by its joint.
fn above(model: &Model, mut joint: Option<usize>, steps: usize) -> Option<usize> {
    for _ in 0..steps {
        joint = joint.and_then(|j| model.parent_joint(j));
    }
    joint
}

impl Pair {
    /// T, b: speeds of `bodies` are T v + (free speeds), accelerations T v' + b.
    fn gear(&self) -> (DMatrix<f64>, DVector<f64>) {
        let (nv, r) = (self.gyros.nv(), self.gears.len());
        let mut t = DMatrix::identity(nv + r, nv);
        let mut b = DVector::zeros(nv + r);
        for (k, (joints, ratio, bias)) in self.gears.iter().enumerate() {
            joints.iter().zip(ratio).for_each(|(j, c)| t[(nv + k, 6 + j)] = *c);
            b[nv + k] = if joints.is_empty() { 0.0 } else { *bias };
        }
        (t, b)
    }

    fn data(&self) -> Data {
        let mut data = Data::new(&self.gyros);
        for (k, (joints, ratio, bias)) in self.gears.iter().enumerate() {
            if joints.is_empty() {
                data.set_free_rotor(k, self.speeds[k], self.torques[k]);
            } else {
                data.set_gear(k, *ratio, *bias);
            }
        }
        data
    }

    /// Coordinates of `bodies`, the rotors' angles being of no account, and their speeds.
    fn full(&self) -> (Vec<f64>, Vec<f64>) {
        let mut q = self.q.clone();
        q.extend(self.speeds.iter().map(|s| s * 0.1));
        let mut v = self.gear().0 * DVector::from_column_slice(&self.v);
        for (k, (joints, ..)) in self.gears.iter().enumerate() {
            if joints.is_empty() {
                v[self.gyros.nv() + k] = self.speeds[k];
            }
        }
        (q, v.as_slice().to_vec())
    }

    /// Torques on the rotor joints of `bodies`.
    fn torque(&self) -> DVector<f64> {
        let mut f = DVector::zeros(self.bodies.nv());
        for (k, (joints, ..)) in self.gears.iter().enumerate() {
            if joints.is_empty() {
                f[self.gyros.nv() + k] = self.torques[k];
            }
        }
        f
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    /// M, h and inverse dynamics of the whole are what the constraint makes of those with bodies, and forward dynamics,
    /// free rotors included, meets the equations with bodies row by row.
    #[test]
    fn gyrostats_are_rotor_bodies_under_their_gears(links in 1usize..12, seed: u64) {
        let p = pair(links, seed, false);
        let (mut d, mut full) = (p.data(), Data::new(&p.bodies));
        let ((t, b), (q, v)) = (p.gear(), p.full());
        let nv = p.gyros.nv();
        let force = DVector::from_column_slice(&p.a);
        let mut a = vec![0.0; nv];
        p.gyros.forward_dynamics(&mut d, &p.q, &p.v, force.as_slice(), &mut a);
        let mut a_full = &t * DVector::from_column_slice(&a) + &b;
        for (k, (joints, ..)) in p.gears.iter().enumerate() {
            if joints.is_empty() {
                a_full[nv + k] = p.gyros.rotor_acceleration(&d, k);
            }
        }
        let mut needed = vec![0.0; p.bodies.nv()];
        p.bodies.inverse_dynamics(&mut full, &q, &v, a_full.as_slice(), &mut needed);
        let needed = DVector::from_vec(needed);
        prop_assert!(error((t.transpose() * &needed).as_slice(), force.as_slice()) < 1e-9);
        for (k, (joints, ..)) in p.gears.iter().enumerate() {
            if joints.is_empty() {
                prop_assert!((needed[nv + k] - p.torques[k]).abs() < 1e-8 * (1.0 + needed.amax()));
            }
        }

        // With the rotors' accelerations known their torques are, and the same force comes from inverse dynamics.
        let mut back = vec![0.0; nv];
        p.gyros.inverse_dynamics(&mut d, &p.q, &p.v, &a, &mut back);
        prop_assert!(error(&back, force.as_slice()) < 1e-9);
        let mut h = vec![0.0; nv];
        p.gyros.nonlinear_terms(&mut d, &p.q, &p.v, &mut h);
        let (m_tt, bias) = p.gyros.base_dynamics(&mut d, &p.q, &p.v, &a[6..]);
        let m = p.gyros.mass_matrix(&mut d, &p.q).clone();
        let sum = &m * DVector::from_column_slice(&a) + DVector::from_vec(h);
        prop_assert!(error(&back, sum.as_slice()) < 1e-10);
        let base = m_tt * DVector::from_column_slice(&a[..6]).fixed_rows::<6>(0) + bias;
        prop_assert!(error(base.as_slice(), &back[..6]) < 1e-10);

        p.gyros.forward_motion(&mut d, &p.q, &p.v);
        p.bodies.forward_motion(&mut full, &q, &v);
        let (ours, theirs) = (p.gyros.momentum(&d), p.bodies.momentum(&full));
        prop_assert!(error(ours.angular.as_slice(), theirs.angular.as_slice()) < 1e-12);
        prop_assert!(error(ours.linear.as_slice(), theirs.linear.as_slice()) < 1e-12);
        let (ours, theirs) = (<[f64; 2]>::from(p.gyros.energy(&d)), <[f64; 2]>::from(p.bodies.energy(&full)));
        prop_assert!(error(&ours, &theirs) < 1e-12);
    }

    /// Geared only: the mass matrix is T^T M T, entry by entry.
    #[test]
    fn mass_matrix_is_projected(links in 1usize..12, seed: u64) {
        let p = pair(links, seed, false);
        let (mut d, mut full) = (p.data(), Data::new(&p.bodies));
        let ((t, _), (q, _)) = (p.gear(), p.full());
        let m_full = p.bodies.mass_matrix(&mut full, &q).clone();
        // A free rotor's row is eliminated: it adds nothing to M but what its body without it would have.
        let nv = p.gyros.nv();
        let free: Vec<usize> = (0..p.gears.len()).filter(|&k| p.gears[k].0.is_empty()).map(|k| nv + k).collect();
        let mut projected = t.transpose() * &m_full * &t;
        for &k in &free {
            let row = (m_full.row(k) * &t).transpose();
            projected -= &row * row.transpose() / m_full[(k, k)];
        }
        let ours = p.gyros.mass_matrix(&mut d, &p.q);
        prop_assert!(error(ours.as_slice(), projected.as_slice()) < 1e-11);
    }

    /// Free rotors with torques on them: the same accelerations as with bodies.
    #[test]
    fn free_rotors_accelerate_as_bodies(links in 1usize..12, seed: u64) {
        let p = pair(links, seed, true);
        let (mut d, mut full) = (p.data(), Data::new(&p.bodies));
        let (q, v) = p.full();
        let nv = p.gyros.nv();
        let mut force = p.torque();
        force.rows_mut(0, nv).copy_from_slice(&p.a);
        let (mut a, mut a_full) = (vec![0.0; nv], vec![0.0; v.len()]);
        p.bodies.forward_dynamics(&mut full, &q, &v, force.as_slice(), &mut a_full);
        p.gyros.forward_dynamics(&mut d, &p.q, &p.v, &p.a, &mut a);
        a.extend((0..p.gears.len()).map(|k| p.gyros.rotor_acceleration(&d, k)));
        prop_assert!(error(&a, &a_full) < 1e-8, "{}", error(&a, &a_full));
    }
}

/// Two links and a motor in the base whose gear has a ratio that changes with both joints: phi = f(q_0, q_1).
fn linkage() -> Model {
    let mut dice = Dice(5);
    let mut inertia = || Inertia {
        mass: 2.0 + dice.unit(),
        center: dice.vector(0.1),
        moments: Matrix3::from_diagonal(&Vector3::new(0.02, 0.03, 0.025)),
    };
    let at = |x: f64| IsometryMatrix3::translation(x, 0.1, -0.3);
    let mut b = ModelBuilder::new("torso", inertia());
    b.joint("hip", "torso", "thigh", &at(0.05), JointKind::Revolute(Vector3::x()), &inertia()).unwrap();
    let knee = Vector3::new(0.3, 1.0, 0.1);
    b.joint("knee", "thigh", "shank", &at(0.0), JointKind::Revolute(knee), &inertia()).unwrap();
    b.build().expect("valid tree")
}

fn motor(joints: &[usize]) -> Rotor {
    Rotor {
        name: "motor".into(),
        link: "torso".into(),
        axis: Vector3::new(0.2, -1.0, 0.5),
        inertia: 1e-3,
        joints: joints.to_vec(),
    }
}

/// phi = 30 sin(q0) + 20 q1 q0: its ratios at q, and the part of phi'' at q'' = 0.
fn transmission(q: &[f64], v: &[f64]) -> ([f64; 3], f64) {
    let ((q0, q1), (v0, v1)) = ((q[7], q[8]), (v[6], v[7]));
    ([30.0 * q0.cos() + 20.0 * q1, 20.0 * q0, 0.0], -30.0 * q0.sin() * v0 * v0 + 40.0 * v0 * v1)
}

#[test]
fn power_is_the_rate_of_energy_with_a_ratio_that_changes() {
    let model = linkage().with_rotors(&[motor(&[0, 1])]).unwrap();
    let mut d = Data::new(&model);
    let mut dice = Dice(8);
    let q = configuration(&mut dice, &model);
    let (v, a) = (dice.list(8, 2.0), dice.list(8, 5.0));
    let mut energy = |h: f64| {
        let vh: Vec<f64> = v.iter().zip(&a).map(|(v, a)| v + a * h).collect();
        let mean: Vec<f64> = v.iter().zip(&vh).map(|(v, w)| 0.5 * (v + w)).collect();
        let mut qh = q.clone();
        model.integrate(&q, &mean, h, &mut qh);
        let (ratio, bias) = transmission(&qh, &vh);
        d.set_gear(0, ratio, bias);
        model.forward_motion(&mut d, &qh, &vh);
        let (kinetic, potential) = model.energy(&d);
        kinetic + potential
    };
    let rate = (energy(1e-5) - energy(-1e-5)) / 2e-5;
    let (ratio, bias) = transmission(&q, &v);
    d.set_gear(0, ratio, bias);
    let mut force = v.clone();
    model.inverse_dynamics(&mut d, &q, &v, &a, &mut force);
    let power: f64 = force.iter().zip(&v).map(|(f, v)| f * v).sum();
    assert!((rate - power).abs() < 1e-7 * power.abs(), "{rate} W and {power} W");
    let speed = ratio[0] * v[6] + ratio[1] * v[7];
    assert!((d.rotor_speed(0) - speed).abs() < 1e-12 * speed.abs());
}

/// State of the linkage in free flight with the motor behind a spring at joint 0: phi = angle, spring = N q - phi.
#[derive(Clone)]
struct Flight {
    q: Vec<f64>,
    v: Vec<f64>,
    angle: f64,
    speed: f64,
}

const RATIO: f64 = 50.0;

impl Flight {
    fn start() -> Flight {
        let q = vec![0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.3, -0.5];
        let v = vec![0.1, -0.2, 2.0, 0.5, -0.8, 0.4, 1.0, -2.0];
        Flight { angle: RATIO * q[7], speed: RATIO * v[6], q, v }
    }

    fn moved(&self, rate: &Rate, h: f64) -> Flight {
        let add = |x: &[f64], d: &[f64]| x.iter().zip(d).map(|(x, d)| x + h * d).collect::<Vec<f64>>();
        let mut q = add(&self.q, &rate.q);
        let norm = q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
        q[3..7].iter_mut().for_each(|x| *x /= norm);
        let v = add(&self.v, &rate.v);
        Flight { q, v, angle: self.angle + h * rate.angle, speed: self.speed + h * rate.speed }
    }
}

struct Rate {
    q: Vec<f64>,
    v: Vec<f64>,
    angle: f64,
    speed: f64,
}

fn rate(model: &Model, d: &mut Data, x: &Flight, stiffness: f64) -> Rate {
    let torque = stiffness * (RATIO * x.q[7] - x.angle);
    let mut force = vec![0.0; 8];
    force[6] = -RATIO * torque;
    d.set_free_rotor(0, x.speed, torque);
    let (mut q, mut v) = (x.q.clone(), x.v.clone());
    model.forward_dynamics(d, &x.q, &x.v, &force, &mut v);
    model.configuration_rate(&x.q, &x.v, &mut q);
    Rate { q, v, angle: x.speed, speed: model.rotor_acceleration(d, 0) }
}

/// Classical Runge-Kutta over `time`.
fn fly(model: &Model, stiffness: f64, time: f64, steps: usize) -> Flight {
    let (mut d, mut x, h) = (Data::new(model), Flight::start(), time / steps as f64);
    for _ in 0..steps {
        let k1 = rate(model, &mut d, &x, stiffness);
        let k2 = rate(model, &mut d, &x.moved(&k1, h / 2.0), stiffness);
        let k3 = rate(model, &mut d, &x.moved(&k2, h / 2.0), stiffness);
        let k4 = rate(model, &mut d, &x.moved(&k3, h), stiffness);
        let mean = |a: &[f64], b: &[f64], c: &[f64], e: &[f64]| -> Vec<f64> {
            (0..a.len()).map(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + e[i]) / 6.0).collect()
        };
        let one = |a: f64, b: f64, c: f64, e: f64| (a + 2.0 * b + 2.0 * c + e) / 6.0;
        let k = Rate {
            q: mean(&k1.q, &k2.q, &k3.q, &k4.q),
            v: mean(&k1.v, &k2.v, &k3.v, &k4.v),
            angle: one(k1.angle, k2.angle, k3.angle, k4.angle),
            speed: one(k1.speed, k2.speed, k3.speed, k4.speed),
        };
        x = x.moved(&k, h);
    }
    x
}

#[test]
fn free_flight_with_a_spinning_rotor_keeps_momentum_and_energy() {
    let model = linkage().with_rotors(&[motor(&[])]).unwrap();
    let mut d = Data::new(&model);
    let (stiffness, time) = (0.02, 0.4);
    let mut observe = |x: &Flight| {
        d.set_free_rotor(0, x.speed, 0.0);
        model.forward_motion(&mut d, &x.q, &x.v);
        let (kinetic, potential) = model.energy(&d);
        let stretch = RATIO * x.q[7] - x.angle;
        (kinetic + potential + 0.5 * stiffness * stretch * stretch, model.momentum(&d))
    };
    let (energy, before) = observe(&Flight::start());
    let (kept, after) = observe(&fly(&model, stiffness, time, 800));
    assert!((kept - energy).abs() < 1e-8 * energy, "{energy} J, then {kept} J");
    let turned = (after.angular - before.angular).norm() / before.angular.norm();
    assert!(turned < 1e-8, "angular momentum changed by {turned}");
    let pulled = before.linear + multibody::GRAVITY * (model.mass() * time);
    assert!((after.linear - pulled).norm() < 1e-9 * pulled.norm());
}

/// A free rotor behind a spring becomes a geared one as the spring stiffens, with an error that falls as 1 / K.
#[test]
fn stiff_spring_is_a_gear() {
    let (free, mut geared) = (linkage().with_rotors(&[motor(&[])]).unwrap(), Flight::start());
    let model = linkage().with_rotors(&[motor(&[0])]).unwrap();
    let mut d = Data::new(&model);
    d.set_gear(0, [RATIO, 0.0, 0.0], 0.0);
    let (time, steps) = (0.05, 2000);
    let zero = [0.0; 8];
    for _ in 0..steps {
        // Midpoint rule: its error is far below the spring's.
        let h = time / f64::from(steps);
        let slope = |d: &mut Data, x: &Flight| {
            let (mut q, mut v) = (x.q.clone(), x.v.clone());
            model.forward_dynamics(d, &x.q, &x.v, &zero, &mut v);
            model.configuration_rate(&x.q, &x.v, &mut q);
            Rate { q, v, angle: 0.0, speed: 0.0 }
        };
        let k = slope(&mut d, &geared);
        let k = slope(&mut d, &geared.moved(&k, h / 2.0));
        geared = geared.moved(&k, h);
    }
    let mut last = f64::INFINITY;
    for stiffness in [1.0, 10.0, 100.0] {
        let x = fly(&free, stiffness, time, 20_000);
        let off = (x.q[7] - geared.q[7]).abs();
        assert!(off < 0.2 * last, "stiffness {stiffness}: {off} rad, before {last} rad");
        last = off;
    }
    // Suddenly loaded, the spring stretches to at most twice J phi'' / K (phi'' with the stator's part, here at the end).
    let mut v = geared.v.clone();
    model.forward_dynamics(&mut d, &geared.q, &geared.v, &zero, &mut v);
    let stretch = 2.0 * 1e-3 * (RATIO * v[6]).abs() / 100.0;
    assert!(last < stretch / RATIO, "{last} rad, {stretch} rad");
}

#[test]
fn rotors_that_cannot_be_are_refused() {
    let mut b = ModelBuilder::new("torso", heavy());
    for (name, parent, child) in
        [("hip", "torso", "thigh"), ("knee", "thigh", "shank"), ("arm", "torso", "hand")]
    {
        let at = IsometryMatrix3::translation(0.0, 0.0, -0.3);
        b.joint(name, parent, child, &at, JointKind::Revolute(Vector3::y()), &heavy()).unwrap();
    }
    let model = b.build().unwrap();
    let refuse = |change: fn(&mut Rotor), reason: &str| {
        let mut rotor = motor(&[1]);
        change(&mut rotor);
        let error = model.clone().with_rotors(&[rotor]).expect_err(reason);
        assert!(matches!(error, ModelError::Rotor(..)), "{error}");
        assert!(error.to_string().contains(reason), "{error}");
    };
    refuse(|r| r.link = "tail".into(), "link `tail` does not exist");
    refuse(|r| r.link = "shank".into(), "joint `knee` is not carried by link `shank`");
    refuse(|r| r.joints = vec![7], "joint 7 does not exist");
    refuse(|r| r.joints = vec![usize::MAX], "does not exist");
    refuse(|r| r.joints = vec![1, 1], "listed twice");
    refuse(|r| r.joints = vec![0, 1, 2, 0], "at most 3");
    refuse(|r| r.joints = vec![1, 2], "different limbs");
    refuse(|r| r.axis = Vector3::zeros(), "axis");
    refuse(|r| r.axis = Vector3::new(f64::NAN, 0.0, 1.0), "axis");
    refuse(|r| r.inertia = 0.0, "must be above zero");
    refuse(|r| r.inertia = f64::NAN, "must be above zero");
    refuse(|r| r.inertia = 0.021, "must contain the inertia of its rotors");
    refuse(|r| (r.joints, r.inertia) = (vec![], 0.021), "must contain the inertia of its rotors");
    let twice = model.clone().with_rotors(&[motor(&[]), motor(&[])]).expect_err("two of a name");
    assert_eq!(twice, ModelError::Duplicate("motor".into()));
    let model = model.with_rotors(&[motor(&[0])]).expect("a good one");
    assert_eq!(model.rotor_names(), ["motor"]);
}

fn heavy() -> Inertia {
    Inertia { mass: 2.0, center: Vector3::new(0.0, 0.0, -0.1), moments: Matrix3::identity() * 0.02 }
}
