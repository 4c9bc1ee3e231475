//! A plant with its state and drives, and what follows from the state alone: energy, momentum and power, put together
//! from the parts' own data, not by the plant.
#![allow(dead_code, reason = "each test uses its part")]

use config::Robot;
use config::method::Integrator;
use config::robot::Drive as Motor;
use drives::Gear;
use environment::Environment;
use multibody::{Data, Frame, Momentum};
use nalgebra::Vector3;
use sim_backend::drive::{JointCubic, JointMotion};
use sim_backend::integrate::Stepper;
use sim_backend::plant::{Plant, PlantInputs, Snapshot, orientation};

/// \[rad/s\] Speed over which explicit methods see dry friction change its sign.
const SLOW: f64 = 1.0;

pub(crate) struct Rig {
    pub(crate) robot: Robot,
    pub(crate) plant: Plant,
    pub(crate) depth: u8,
    pub(crate) pose: Vec<f64>,
    pub(crate) x: Vec<f64>,
    pub(crate) drives: Vec<JointCubic>,
    pub(crate) inputs: PlantInputs,
    data: Data,
}

/// Sums over all drives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Flow {
    /// \[W\] Motors by (2.58): k_M I times speed.
    pub(crate) motors: f64,
    /// \[W\] Friction of gears, negative.
    pub(crate) friction: f64,
    /// \[W\] Brakes, negative.
    pub(crate) brakes: f64,
    /// \[W\] R I^2
    pub(crate) heat: f64,
}

pub(crate) fn lola() -> Robot {
    Robot::load(&config::root(None).join("robots/lola")).unwrap()
}

impl Rig {
    pub(crate) fn new(depth: u8) -> Self {
        Self::of(lola(), depth, Environment::flat())
    }

    pub(crate) fn of(robot: Robot, depth: u8, environment: Environment) -> Self {
        let pose = robot.poses["stand"].clone();
        let mut plant = Plant::new(&robot, environment, depth, &pose).unwrap();
        let x = plant.standing(&pose);
        let drives = pose.iter().map(|&q| JointCubic::resting(q)).collect();
        let data = Data::new(plant.model());
        let inputs = PlantInputs::POWERED;
        Self { robot, plant, depth, pose, x, drives, inputs, data }
    }

    /// Lifts the robot by a metre, its contact layer at rest.
    pub(crate) fn in_the_air(mut self) -> Self {
        self.x[2] += 1.0;
        let layer = self.plant.layout().layer();
        self.x[layer].fill(0.0);
        self
    }

    /// Every joint begins to move to a place of its own, within `duration` \[s\].
    pub(crate) fn moving(mut self, size: f64, duration: f64) -> Self {
        for (j, d) in self.drives.iter_mut().enumerate() {
            let from = JointMotion { angle: self.pose[j], ..JointMotion::default() };
            let way = size * (1.0 + 1.7 * j as f64).sin();
            *d = JointCubic::follow(from, self.pose[j] + way, 0.0, duration);
        }
        self
    }

    /// Speeds, twists of gears, currents and node displacements as in the middle of a wild motion.
    pub(crate) fn shaken(mut self, seed: u32) -> Self {
        let mut number = seed;
        let mut dice = move || {
            number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(number >> 8) / f64::from(1 << 23) - 1.0
        };
        let l = *self.plant.layout();
        for (range, size) in [
            (3..7, 0.05),
            (7..l.pose().end, 0.05),
            (l.speed(), 0.5),
            (l.rotor_angle(), 0.05),
            (l.rotor_speed(), 0.5),
            (l.current(), 3.0),
            (l.layer(), 3e-4),
        ] {
            for i in range {
                self.x[i] += size * dice();
            }
        }
        for (e, at) in l.rotor_angle().enumerate() {
            let joint = self.elastic()[e].joints[0];
            self.x[at] = self.x[7 + joint] + 2e-3 * dice();
        }
        let unit = orientation(&self.x);
        self.x[3..7].copy_from_slice(unit.coords.as_slice());
        self
    }

    pub(crate) fn rate(&mut self, t: f64, x: &[f64]) -> Vec<f64> {
        let mut dx = vec![0.0; x.len()];
        self.plant.rate(t, x, &self.drives, &self.inputs, &mut dx);
        dx
    }

    /// Steps from `t0` to `end` \[s\] of the drives' motion.
    pub(crate) fn run(&mut self, integrator: Integrator, t0: f64, end: f64, steps: u32) {
        let mut stepper = Stepper::new(integrator, self.x.len());
        let h = (end - t0) / f64::from(steps);
        for i in 0..steps {
            let Self { plant, x, drives, inputs, .. } = self;
            stepper.step(plant, t0 + f64::from(i) * h, h, x, drives, inputs);
        }
    }

    pub(crate) fn snapshot(&mut self, t: f64) -> Snapshot {
        self.plant.snapshot(t, &self.x, &self.drives)
    }

    /// Drives whose gears are elastic in this type, in the order of their rotors.
    fn elastic(&self) -> Vec<&Motor> {
        let soft = self.depth == 3 || self.depth == 5;
        self.robot.drives.iter().filter(|d| soft && d.elasticity.is_some()).collect()
    }

    /// Joint angles and speeds, type 1 at `t` \[s\] of its references.
    fn joints(&self, t: f64, x: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let l = self.plant.layout();
        if l.joints > 0 {
            return (x[l.pose()][7..].to_vec(), x[l.speed()][6..].to_vec());
        }
        self.drives.iter().map(|d| d.at(t)).map(|m| (m.angle, m.speed)).unzip()
    }

    /// Gear and speed of every motor against its stator.
    pub(crate) fn motors(&self, t: f64, x: &[f64]) -> Vec<(Gear, f64)> {
        let l = self.plant.layout();
        let (q, v) = self.joints(t, x);
        let mut elastic = 0;
        let mut motor = |d: &Motor| {
            let at = |x: &[f64]| std::array::from_fn(|i| d.joints.get(i).map_or(0.0, |&j| x[j]));
            let gear = d.transmission.at(at(&q), at(&v)).unwrap();
            if self.elastic().iter().any(|e| e.name == d.name) {
                elastic += 1;
                return (gear, gear.ratio[0] * x[l.rotor_speed()][elastic - 1]);
            }
            (gear, gear.speed(at(&v)))
        };
        self.robot.drives.iter().map(&mut motor).collect()
    }

    fn load(&mut self, t: f64, x: &[f64]) {
        let (q, v) = self.joints(t, x);
        let l = *self.plant.layout();
        let pose: Vec<f64> =
            x[..3].iter().chain(orientation(x).coords.as_slice()).chain(&q).copied().collect();
        let twist: Vec<f64> = x[l.speed()][..6].iter().chain(&v).copied().collect();
        for (k, (gear, speed)) in self.motors(t, x).into_iter().enumerate() {
            if self.elastic().iter().any(|e| e.name == self.robot.drives[k].name) {
                self.data.set_free_rotor(k, speed, 0.0);
            } else {
                self.data.set_gear(k, gear.ratio, gear.bias);
            }
        }
        self.plant.model().forward_motion(&mut self.data, &pose, &twist);
    }

    /// \[J\] Kinetic and potential energy of bodies and rotors, and that of the springs.
    pub(crate) fn energy(&mut self, t: f64, x: &[f64]) -> f64 {
        self.load(t, x);
        let (kinetic, potential) = self.plant.model().energy(&self.data);
        let l = self.plant.layout();
        let spring = |(e, d): (usize, &Motor)| {
            d.elasticity.unwrap().energy(x[7 + d.joints[0]] - x[l.rotor_angle()][e])
        };
        let springs: f64 = self.elastic().into_iter().enumerate().map(spring).sum();
        kinetic + potential + springs
    }

    /// \[J\] L I^2 / 2 of all motors.
    pub(crate) fn magnetic(&self, x: &[f64]) -> f64 {
        let current = &x[self.plant.layout().current()];
        self.robot.drives.iter().zip(current).map(|(d, i)| 0.5 * d.motor.inductance * i * i).sum()
    }

    pub(crate) fn momentum(&mut self, t: f64, x: &[f64]) -> Momentum {
        self.load(t, x);
        self.plant.model().cog(&mut self.data);
        self.plant.model().momentum(&self.data)
    }

    pub(crate) fn cog(&mut self, t: f64, x: &[f64]) -> Vector3<f64> {
        self.load(t, x);
        self.plant.model().cog(&mut self.data)
    }

    /// What the motors do.
    pub(crate) fn flow(&self, t: f64, x: &[f64]) -> Flow {
        let current = &x[self.plant.layout().current()];
        let mut sum = Flow::default();
        for ((d, i), (_, speed)) in self.robot.drives.iter().zip(current).zip(self.motors(t, x)) {
            let driving = if self.inputs.switches.powered { d.motor.torque(*i) } else { 0.0 };
            sum.motors += driving * speed;
            sum.friction += d.friction.torque(speed, driving, SLOW).unwrap() * speed;
            sum.heat += d.motor.resistance * i * i;
            if let Some(brake) = d.brake.filter(|_| self.inputs.switches.braked != 0) {
                sum.brakes -= brake.torque * (speed / SLOW).clamp(-1.0, 1.0) * speed;
            }
        }
        sum
    }

    /// Contact points in the order of their states: where the first of them is in the state vector, and its frame.
    fn points(&self) -> Vec<(usize, Frame)> {
        // They come link by link, links in the order in which they first appear.
        let all: Vec<&(String, [f64; 3])> = self.robot.feet.iter().flat_map(|f| &f.points).collect();
        let mut links: Vec<&str> = Vec::new();
        for (link, _) in &all {
            if !links.contains(&link.as_str()) {
                links.push(link);
            }
        }
        let sorted = links.iter().flat_map(|&l| all.iter().filter(move |(link, _)| link == l));
        let frame = |(link, place): &(String, [f64; 3])| self.plant.model().frame(link, *place).unwrap();
        let first = self.plant.layout().layer().start;
        sorted.enumerate().map(|(i, p)| (first + 3 * i, frame(p))).collect()
    }

    /// \[m\] @world Deformed contact points.
    pub(crate) fn nodes(&mut self, t: f64, x: &[f64]) -> Vec<Vector3<f64>> {
        self.load(t, x);
        let model = self.plant.model();
        let at = |(i, f): (usize, Frame)| {
            model.frame_position(&self.data, &f) + Vector3::from_column_slice(&x[i..i + 3])
        };
        self.points().into_iter().map(at).collect()
    }

    /// \[W\] Power of the ground on the robot, from the layer's states alone: f = B d' + K d (2.37) at every point.
    pub(crate) fn ground(&mut self, t: f64, x: &[f64], dx: &[f64]) -> f64 {
        self.load(t, x);
        let c = self.robot.contact;
        let k = [c.tangential_stiffness, c.tangential_stiffness, c.normal_stiffness];
        let power = |(at, point): (usize, Frame)| {
            let f = Vector3::from_fn(|i, _| k[i] * (c.damping_time * dx[at + i] + x[at + i]));
            let twist = self.plant.model().frame_velocity(&self.data, &point);
            let d = Vector3::from_column_slice(&x[at..at + 3]);
            f.dot(&(twist.linear + twist.angular.cross(&d))) // (2.39) with the deformed node
        };
        self.points().into_iter().map(power).sum()
    }
}
