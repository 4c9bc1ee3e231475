//! Outline of a robot as points on the shapes of its URDF, to see whether it touches something.
//!
//! Not of the simulated ground contact, which knows soles alone: a torso or an arm that goes through a wall meets no force there.

use config::Robot;
use environment::{Environment, Surface};
use messages::SimState;
use multibody::{Data, Frame, Model};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion, Vector3};
use urdf_rs::Geometry;

use crate::Error;

/// \[m\] Points of an outline are no farther apart.
const APART: f64 = 0.04;

/// Outline of a robot.
pub(super) struct Outline {
    model: Model,
    data: Data,
    q: Vec<f64>,
    /// Name and frame of a link, and points \[m\] on it.
    links: Vec<(String, Frame, Vec<Vector3<f64>>)>,
}

impl Outline {
    /// That of a robot.
    ///
    /// # Errors
    /// Its files do not fit together, or a shape is a mesh.
    pub(super) fn new(robot: &Robot) -> Result<Self, Error> {
        let model = robot.model()?;
        let mut links = Vec::new();
        for link in &urdf_rs::read_from_string(&robot.urdf)?.links {
            let mut points = Vec::new();
            for visual in &link.visual {
                let ([x, y, z], [roll, pitch, yaw]) = (visual.origin.xyz.0, visual.origin.rpy.0);
                let rotation = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
                let pose = Isometry3::from_parts(Translation3::new(x, y, z), rotation);
                points.extend(
                    surface(&visual.geometry)?.into_iter().map(|p| (pose * nalgebra::Point3::from(p)).coords),
                );
            }
            if !points.is_empty() {
                links.push((link.name.clone(), model.frame(&link.name, [0.0; 3])?, points));
            }
        }
        let (data, q) = (Data::new(&model), model.neutral());
        Ok(Self { model, data, q, links })
    }

    /// Name of the object that the robot touches or is in, and of its own link.
    pub(super) fn touched(
        &mut self,
        truth: &SimState,
        environment: &Environment,
    ) -> Option<(String, String)> {
        let joints = self.q.len() - 7;
        self.q[7..].copy_from_slice(&truth.joint_angle[..joints]);
        self.model.forward_kinematics(&mut self.data, &self.q);
        let [x, y, z, w] = truth.orientation;
        let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
        let torso = Isometry3::from_parts(Translation3::from(truth.position), rotation);
        for (name, frame, points) in &self.links {
            let pose = self.model.frame_pose(&self.data, frame);
            for p in points {
                let at = torso * (pose * nalgebra::Point3::from(*p));
                let hit = environment.query(at.coords.into());
                if let (Surface::Object(i), true) = (hit.surface, hit.gap <= 0.0) {
                    return Some((environment.objects()[i].name().to_owned(), name.clone()));
                }
            }
        }
        None
    }
}

/// Points on a shape \[m\], about its own origin.
fn surface(geometry: &Geometry) -> Result<Vec<Vector3<f64>>, Error> {
    let steps = |length: f64| (length / APART).ceil().max(1.0) as usize;
    let along = |k: usize, n: usize, half: f64| half * (2.0 * k as f64 / n as f64 - 1.0);
    let mut points = Vec::new();
    let mut add = |x: f64, y: f64, z: f64| points.push(Vector3::new(x, y, z));
    match geometry {
        Geometry::Box { size } => {
            let n = size.0.map(steps);
            let half = size.0.map(|s| 0.5 * s);
            for (i, j, k) in grid(n) {
                let on = |k: usize, n: usize| k == 0 || k == n;
                if on(i, n[0]) || on(j, n[1]) || on(k, n[2]) {
                    add(along(i, n[0], half[0]), along(j, n[1], half[1]), along(k, n[2], half[2]));
                }
            }
        }
        Geometry::Cylinder { radius, length } | Geometry::Capsule { radius, length } => {
            // The ends of a capsule are taken as flat, and as far out.
            let cap = if matches!(geometry, Geometry::Capsule { .. }) { *radius } else { 0.0 };
            let n = [steps(std::f64::consts::TAU * radius), steps(*radius), steps(length + 2.0 * cap)];
            for (i, j, k) in grid(n) {
                if j == n[1] || k == 0 || k == n[2] {
                    let (angle, r) =
                        (std::f64::consts::TAU * i as f64 / n[0] as f64, radius * j as f64 / n[1] as f64);
                    add(r * angle.cos(), r * angle.sin(), along(k, n[2], 0.5 * length + cap));
                }
            }
        }
        Geometry::Sphere { radius } => {
            let n = [steps(std::f64::consts::TAU * radius), steps(std::f64::consts::PI * radius)];
            for (i, j, _) in grid([n[0], n[1], 0]) {
                let (a, b) = (
                    std::f64::consts::TAU * i as f64 / n[0] as f64,
                    std::f64::consts::PI * j as f64 / n[1] as f64,
                );
                add(radius * b.sin() * a.cos(), radius * b.sin() * a.sin(), radius * b.cos());
            }
        }
        Geometry::Mesh { filename, .. } => {
            return Err(format!("{filename}: outlines of meshes are not read").into());
        }
    }
    Ok(points)
}

/// All whole numbers from 0 to `n`, along three axes.
fn grid(n: [usize; 3]) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..=n[0]).flat_map(move |i| (0..=n[1]).flat_map(move |j| (0..=n[2]).map(move |k| (i, j, k))))
}
