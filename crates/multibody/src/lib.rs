//! Floating-base trees of rigid bodies: kinematics and dynamics for control and simulation.
//!
//! A [`Model`] is read from a URDF once and never changes; a [`Data`] holds all scratch, one per user, and nothing
//! allocates after it is made. See [`Model`] for coordinates and frames. Chapter 2 of Buschmann's thesis with a
//! quaternion in place of the z-x-z Euler angles, which are singular in the upright pose (errata, appendix D).
//!
//! ```
//! use multibody::{Data, Model};
//! # let urdf = r#"<robot name="r"><link name="base"><inertial><mass value="2"/>
//! #   <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
//! #   <link name="leg"><inertial><origin xyz="0 0 -0.2"/><mass value="1"/>
//! #   <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
//! #   <joint name="hip" type="continuous"><parent link="base"/><child link="leg"/><axis xyz="0 1 0"/></joint></robot>"#;
//! let model = Model::from_urdf(urdf, "base", &["hip"])?;
//! let mut data = Data::new(&model);
//! let foot = model.frame("leg", [0.0, 0.0, -0.4])?;
//! let mut q = model.neutral();
//! q[7] = std::f64::consts::FRAC_PI_2;
//! model.forward_kinematics(&mut data, &q);
//! assert!((model.frame_position(&data, &foot).x + 0.4).abs() < 1e-12);
//! # Ok::<(), multibody::ModelError>(())
//! ```

mod altered;
mod body;
mod builder;
mod centroid;
mod configuration;
mod damper;
mod data;
mod error;
mod forward;
mod gyro;
mod inertia;
mod inverse;
mod jacobian;
mod kinematics;
mod leg;
mod leg_error;
mod mass;
mod model;
mod reduced;
mod reference;
mod rotor;
mod space;
mod sparsity;
mod trigonometry;
mod turn;
mod urdf;

pub use builder::{JointKind, ModelBuilder};
pub use centroid::Momentum;
pub use damper::Damper;
pub use data::Data;
pub use error::ModelError;
pub use inertia::Inertia;
pub use kinematics::{Limbs, Twist};
pub use leg::{ClosedFormLeg, DhRow, LegError, LegRowError, check_rotation};
pub use model::{Frame, GRAVITY, GRAVITY_ACCELERATION, Model};
pub use rotor::Rotor;
