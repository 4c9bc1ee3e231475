//! Speed against accuracy, and where methods fail: `gangwerk study ...`.
//!
//! The table of studies is [`SimulatedStudy`]; beside it stand the [`scorecard`], which walks everything that is to walk,
//! [`stability::log`], which judges a log, and [`sweep`]s, whose questions are in files of their own.
//!
//! They work on [`chain`], a whole robot in one process; [`second`] replays a part of it. A study is a struct of its arguments
//! that implements [`Study`], and a row in [`SimulatedStudy`]; what it finds is a [`Sheet`].

pub mod accuracy;
pub mod archie;
pub mod arm_swing;
pub mod bus;
pub mod bus_faults;
pub mod commands;
pub mod components;
pub mod cycles;
pub mod exploration;
pub mod figures_of_thesis;
pub mod ground;
pub mod hours;
mod joint_bench;
pub mod limits;
pub mod lines;
mod optimize;
pub mod points;
pub mod push;
mod random;
pub mod scorecard;
mod search;
pub mod second;
pub mod servo;
pub mod sheet;
pub mod simulation_speed;
pub mod speed;
pub mod stability;
pub mod stalls;
pub mod sweep;
pub mod tables;
pub mod tune;
mod undisturbed;
mod way;

use std::path::Path;

pub use sheet::Sheet;

/// Why a study could not be carried out.
pub type Error = Box<dyn std::error::Error>;

/// What a study is given besides its arguments.
pub struct Given<'a> {
    /// Directory of the configuration.
    pub config: &'a Path,
    /// Told how many pieces of work are done, of how many (0: unknown), and which one is next.
    pub progress: &'a (dyn Fn(usize, usize, &str) + Sync),
}

/// A question with its arguments.
pub trait Study {
    /// Finds the answer.
    ///
    /// # Errors
    /// A configuration or an argument is wrong, a robot falls that should not, or a picture cannot be written.
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Error>;
}

/// The table of studies: what `gangwerk study --help` says, name, type.
macro_rules! studies {
    ($($(#[$about:meta])* $name:ident: $study:ty,)*) => {
        /// All studies.
        #[derive(clap::Subcommand, Debug)]
        pub enum SimulatedStudy {
            $($(#[$about])* $name($study),)*
        }

        impl Study for SimulatedStudy {
            fn run(&self, given: &Given<'_>) -> Result<Sheet, Error> {
                match self {
                    $(Self::$name(study) => study.run(given),)*
                }
            }
        }
    };
}

studies! {
    /// Which impulse the walking robot survives.
    Push: push::Push,
    /// Falls of the walking robot in hours of random pushes.
    Hours: hours::Hours,
    /// How often the robot walks over ground that it was not told of, and as a robot that differs from what it was told.
    Ground: ground::GroundStudy,
    /// How the robot gets about in rooms that she sees, and nobody has told her of.
    Exploration: exploration::Exploration,
    /// How many random timelines of commands the robot walks to their ends.
    Commands: commands::RandomCommands,
    /// Which disturbances and errors a gait survives: pushes, wrong sensors, wrong ground, delay.
    Viability: stability::viability::Viability,
    /// How fast a gait forgets a small disturbance: eigenvalues of its Poincaré map.
    Floquet: stability::floquet::Floquet,
    /// Which method is cheapest for a given accuracy: charts of processor time against error.
    Accuracy: accuracy::Accuracy,
    /// What each component of the simulated robot costs, and what a walk without it misses.
    Components: components::ComponentsStudy,
    /// How fast simulation, planner and stabilizer are, and how accurate at that speed.
    Speed: speed::Speed,
    /// Sampling time, integral and integration step of drives with a clock of their own: speed and error of a walk.
    Servo: servo::Servo,
    /// What makes Archie fall in his own walk, predicted beside measured, and what the stabilizer cures.
    Archie: archie::Archie,
    /// Where methods fail: predicted and measured limits, and how each failure is reported.
    Limits: limits::LimitsStudy,
    /// Look-up tables of the local controllers: error over size, time, and what a walk loses by them.
    Tables: tables::Tables,
    /// Tables that drives play: error of the cubics over the points of a stride, and time of their upload.
    Points: points::Points,
    /// Figures of the thesis that compare two walks: 5.2, 4.17, 9.1.
    Thesis: figures_of_thesis::Thesis,
    /// Vertical moments of the soles and how far they turn, with arms that swing and with arms that do not.
    ArmSwing: arm_swing::ArmSwingStudy,
    /// What the field bus costs: load of its lines, time of its frames, accuracy of the walk.
    Bus: bus::BusCost,
    /// How punctual a bus cycle over CAN lines is, beside cyclictest in the same run: both ends on this machine.
    Lines: lines::Punctuality,
    /// What the walking robot does when the bus fails: lost, late, corrupted frames, silent nodes, cables.
    BusFaults: bus_faults::BusFaults,
    /// Processes of a walking robot that are stopped for 2 to 1000 ms and go on.
    Stalls: stalls::Stalls,
}
