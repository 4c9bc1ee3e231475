//! `gangwerk.Model`: kinematics and dynamics of a robot.

use std::path::PathBuf;

use multibody::{Data, Frame};
use nalgebra::{Matrix3xX, Matrix6xX};
use numpy::{PyArray1, PyArrayDyn};
use pyo3::prelude::*;

use crate::arguments::{GREATEST, array, real, unknown_name, vector, wrong};
use crate::configuration;
use crate::matrix::{matrix, table};

/// Deviation of a quaternion's length from 1 that is rounding.
const UNIT: f64 = 1e-6;
/// Range of everything that is given.
const RANGE: [f64; 2] = [-GREATEST, GREATEST];

/// Kinematics and dynamics of a robot of the configuration: a tree of rigid bodies whose base, the torso, floats.
///
/// q: position of the base in the world [m], quaternion (x, y, z, w), joint coordinates [rad, m]; 7 + n numbers. v: velocity [m/s]
/// and angular velocity [rad/s] of the base in base axes, joint speeds; 6 + n. A generalized force has the shape of v: force [N]
/// and moment [N m] at the base's origin in base axes, joint torques. Numbers up to 1e6. Frames are links, by name, with an
/// offset [m] in the link; their velocities and Jacobians have world axes. Results are copies.
#[pyclass(module = "gangwerk")]
struct Model {
    model: multibody::Model,
    data: Data,
    name: String,
    urdf: String,
    links: Vec<String>,
    /// Joint angles by name of the pose.
    poses: Vec<(String, Vec<f64>)>,
}

type Array<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;

impl Model {
    fn of(model: multibody::Model, (name, urdf): (String, String), poses: Vec<(String, Vec<f64>)>) -> Self {
        let links = model.link_names().map(String::from).collect();
        Self { data: Data::new(&model), model, name, urdf, links, poses }
    }

    /// Configuration: finite, and its quaternion of unit length.
    fn q(&self, q: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
        let q = array("q", q, &[self.model.nq()], RANGE)?;
        let length = q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
        if (length - 1.0).abs() > UNIT {
            let text = "the quaternion (x, y, z, w) of the base must have the length 1";
            return Err(wrong(format!("q[3:7] = {:?}: {text}, within {UNIT}; it has {length}", &q[3..7])));
        }
        Ok(q)
    }

    /// Velocity, acceleration or generalized force.
    fn tangent(&self, name: &str, v: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
        array(name, v, &[self.model.nv()], RANGE)
    }

    fn frame(&self, link: &str, offset: Option<&Bound<'_, PyAny>>) -> PyResult<Frame> {
        let offset = offset.map_or(Ok([0.0; 3]), |offset| vector("offset", offset, RANGE))?;
        let unknown = |_| {
            unknown_name("link", link, &self.links, &format!("link must be one of {}", self.links.join(", ")))
        };
        self.model.frame(link, offset).map_err(unknown)
    }

    /// Poses of all bodies.
    fn place(&mut self, q: &Bound<'_, PyAny>) -> PyResult<()> {
        let q = self.q(q)?;
        self.model.forward_kinematics(&mut self.data, &q);
        Ok(())
    }
}

#[pymethods]
impl Model {
    #[new]
    #[pyo3(signature = (robot, *, config=None))]
    fn new(robot: &str, config: Option<PathBuf>) -> PyResult<Self> {
        let robot = configuration::robot(robot, &configuration::directory(config)?)?;
        let model = robot.model().map_err(wrong)?;
        Ok(Self::of(model, (robot.name, robot.urdf), robot.poses.into_iter().collect()))
    }

    /// Model of a URDF, its text or its path. `base`: link that floats, the root; `joints`: order of the joints, parents first.
    #[staticmethod]
    #[pyo3(signature = (urdf, *, base=None, joints=None))]
    fn from_urdf(urdf: &str, base: Option<String>, joints: Option<Vec<String>>) -> PyResult<Self> {
        let text = if urdf.contains('<') {
            urdf.to_owned()
        } else {
            std::fs::read_to_string(urdf)
                .map_err(|e| wrong(format!("urdf = '{urdf}': must be the text or the path of a URDF: {e}")))?
        };
        let (root, order) = multibody::Model::urdf_order(&text).map_err(wrong)?;
        let (base, joints) = (base.unwrap_or(root), joints.unwrap_or(order));
        let joints: Vec<&str> = joints.iter().map(String::as_str).collect();
        let model = multibody::Model::from_urdf(&text, &base, &joints).map_err(wrong)?;
        Ok(Self::of(model, (base, text), Vec::new()))
    }

    /// Number of joints.
    #[getter]
    fn n(&self) -> usize {
        self.model.n()
    }

    /// Length of q: 7 + n.
    #[getter]
    fn nq(&self) -> usize {
        self.model.nq()
    }

    /// Length of v: 6 + n.
    #[getter]
    fn nv(&self) -> usize {
        self.model.nv()
    }

    /// Mass of the whole robot [kg].
    #[getter]
    fn mass(&self) -> f64 {
        self.model.mass()
    }

    /// Text of the URDF.
    #[getter]
    fn urdf(&self) -> &str {
        &self.urdf
    }

    /// Names of the joints in the order of q.
    #[getter]
    fn joint_names(&self) -> Vec<String> {
        self.model.joint_names().to_vec()
    }

    /// Names of the links: the frames.
    #[getter]
    fn link_names(&self) -> Vec<String> {
        self.links.clone()
    }

    /// Names of the poses that the robot's file has.
    #[getter]
    fn pose_names(&self) -> Vec<&str> {
        self.poses.iter().map(|(name, _)| name.as_str()).collect()
    }

    /// q with the base at the origin, upright, joints at zero or in a pose of the robot's file.
    #[pyo3(signature = (pose=None))]
    fn neutral<'py>(&self, py: Python<'py>, pose: Option<&str>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut q = self.model.neutral();
        if let Some(name) = pose {
            let known = self.pose_names();
            let of = self.poses.iter().find(|(other, _)| other == name);
            let hint = format!("pose must be one of {}", known.join(", "));
            let (_, angles) = of.ok_or_else(|| unknown_name("pose", name, &known, &hint))?;
            q[7..].copy_from_slice(angles);
        }
        Ok(PyArray1::from_vec(py, q))
    }

    /// world_from_link as a 4 x 4 matrix [1, m].
    #[pyo3(signature = (q, link, offset=None))]
    fn pose<'py>(
        &mut self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        link: &str,
        offset: Option<&Bound<'py, PyAny>>,
    ) -> Array<'py> {
        let frame = self.frame(link, offset)?;
        self.place(q)?;
        matrix(py, &self.model.frame_pose(&self.data, &frame).to_homogeneous())
    }

    /// Velocity [m/s] and angular velocity [rad/s] of a frame, world axes.
    #[pyo3(signature = (q, v, link, offset=None))]
    fn velocity<'py>(
        &mut self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        link: &str,
        offset: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (frame, q, v) = (self.frame(link, offset)?, self.q(q)?, self.tangent("v", v)?);
        self.model.forward_motion(&mut self.data, &q, &v);
        let twist = self.model.frame_velocity(&self.data, &frame);
        Ok(PyArray1::from_iter(py, twist.linear.iter().chain(twist.angular.iter()).copied()))
    }

    /// Jacobian of a frame, 6 x (6 + n): rows velocity, then angular velocity, world axes.
    #[pyo3(signature = (q, link, offset=None))]
    fn jacobian<'py>(
        &mut self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        link: &str,
        offset: Option<&Bound<'py, PyAny>>,
    ) -> Array<'py> {
        let frame = self.frame(link, offset)?;
        self.place(q)?;
        let mut jacobian = Matrix6xX::zeros(self.model.nv());
        self.model.frame_jacobian(&self.data, &frame, &mut jacobian);
        matrix(py, &jacobian)
    }

    /// Centre of gravity in the world [m].
    fn com<'py>(&mut self, py: Python<'py>, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.place(q)?;
        Ok(PyArray1::from_slice(py, self.model.cog(&mut self.data).as_slice()))
    }

    /// Its Jacobian, 3 x (6 + n), world axes.
    fn com_jacobian<'py>(&mut self, py: Python<'py>, q: &Bound<'py, PyAny>) -> Array<'py> {
        self.place(q)?;
        self.model.cog(&mut self.data);
        let mut jacobian = Matrix3xX::zeros(self.model.nv());
        self.model.cog_jacobian(&self.data, &mut jacobian);
        matrix(py, &jacobian)
    }

    /// Linear momentum [kg m/s], and angular momentum about the centre of gravity [kg m^2/s], world axes.
    fn momentum<'py>(
        &mut self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (q, v) = (self.q(q)?, self.tangent("v", v)?);
        self.model.forward_motion(&mut self.data, &q, &v);
        self.model.cog(&mut self.data);
        let momentum = self.model.momentum(&self.data);
        Ok(PyArray1::from_iter(py, momentum.linear.iter().chain(momentum.angular.iter()).copied()))
    }

    /// Kinetic and potential energy [J].
    fn energy(&mut self, q: &Bound<'_, PyAny>, v: &Bound<'_, PyAny>) -> PyResult<(f64, f64)> {
        let (q, v) = (self.q(q)?, self.tangent("v", v)?);
        self.model.forward_motion(&mut self.data, &q, &v);
        Ok(self.model.energy(&self.data))
    }

    /// Mass matrix M, (6 + n) x (6 + n).
    fn mass_matrix<'py>(&mut self, py: Python<'py>, q: &Bound<'py, PyAny>) -> Array<'py> {
        let q = self.q(q)?;
        matrix(py, self.model.mass_matrix(&mut self.data, &q))
    }

    /// Coriolis and centrifugal terms and weight h: M dv/dt + h is the generalized force.
    fn nonlinear_terms<'py>(
        &mut self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
    ) -> Array<'py> {
        let (q, v, mut h) = (self.q(q)?, self.tangent("v", v)?, vec![0.0; self.model.nv()]);
        self.model.nonlinear_terms(&mut self.data, &q, &v, &mut h);
        self.generalized(py, h)
    }

    /// Generalized force for dv/dt = acceleration [m/s^2, rad/s^2].
    fn inverse_dynamics<'py>(
        &mut self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        acceleration: &Bound<'py, PyAny>,
    ) -> Array<'py> {
        let (q, v, mut force) = (self.q(q)?, self.tangent("v", v)?, vec![0.0; self.model.nv()]);
        let acceleration = self.tangent("acceleration", acceleration)?;
        self.model.inverse_dynamics(&mut self.data, &q, &v, &acceleration, &mut force);
        self.generalized(py, force)
    }

    /// dv/dt [m/s^2, rad/s^2] under a generalized force.
    fn forward_dynamics<'py>(
        &mut self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        force: &Bound<'py, PyAny>,
    ) -> Array<'py> {
        let (q, v, mut acceleration) = (self.q(q)?, self.tangent("v", v)?, vec![0.0; self.model.nv()]);
        let force = self.tangent("force", force)?;
        self.model.forward_dynamics(&mut self.data, &q, &v, &force, &mut acceleration);
        self.generalized(py, acceleration)
    }

    /// q after moving with constant v for dt [s].
    fn integrate<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        dt: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (q, v) = (self.q(q)?, self.tangent("v", v)?);
        let dt = real("dt", dt, [-1e3, 1e3], "s")?;
        let mut next = vec![0.0; self.model.nq()];
        self.model.integrate(&q, &v, dt, &mut next);
        Ok(PyArray1::from_vec(py, next))
    }

    fn __repr__(&self) -> String {
        format!("<gangwerk.Model {}: {} joints, {:.3} kg>", self.name, self.model.n(), self.model.mass())
    }
}

impl Model {
    fn generalized<'py>(&self, py: Python<'py>, numbers: Vec<f64>) -> Array<'py> {
        let length = numbers.len();
        table(py, numbers, vec![length])
    }
}

/// Classes and functions of this file, added to the module.
pub(crate) fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Model>()
}
