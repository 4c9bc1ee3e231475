//! What is simulated: nothing that a scene does not name is computed.

use messages::Command;
use messages::command::PushCommand;

/// `scenes/NAME.toml`.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Name of the file without its extension.
    pub name: String,
    /// What the scene shows, one sentence.
    pub about: String,
    /// Name of the robot's directory.
    pub robot: String,
    /// Name of the gait file.
    pub gait: String,
    /// Modelling depth; type 1 is the reduced model (thesis table 2.4).
    pub depth: u8,
    /// Integrator of the simulated robot.
    pub integrator: Integrator,
    /// \[1\] Integration steps per bus cycle.
    pub substeps: u32,
    /// \[s\] Bus cycle.
    pub cycle: f64,
    /// Name of the joint pose the robot starts in, standing on the ground.
    pub start_pose: String,
    /// \[s\]
    pub duration: f64,
    /// Seed of everything random.
    pub seed: u64,
    /// Commands by time \[s\], ascending.
    pub commands: Vec<(f64, Command)>,
    /// Pushes at the torso by time \[s\], ascending.
    pub pushes: Vec<(f64, PushCommand)>,
}

/// How the equations of motion are integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// Explicit Euler, first order.
    Euler,
    /// Classical Runge-Kutta, fourth order between contact changes.
    RungeKutta4,
}
