//! `gangwerk param`: its words on the command line.

use std::error::Error;
use std::path::{Path, PathBuf};

use clap::Subcommand;
use cli::param;

#[derive(Subcommand)]
pub(crate) enum ParamTask {
    /// The parameters of all processes of a running robot: value, unit, range, meaning, default.
    List,
    /// The value of one.
    Get {
        /// Name of the parameter.
        name: String,
    },
    /// Everything about one.
    Describe {
        /// Name of the parameter.
        name: String,
    },
    /// Another value, from the next cycle of its process on; refused if it is fixed at start.
    Set {
        /// Name of the parameter.
        name: String,
        /// In its unit and range.
        #[arg(allow_negative_numbers = true)]
        value: f64,
        /// Take the command lease from whoever holds it.
        #[arg(long)]
        take_over: bool,
    },
    /// Write all values to a file; those that are fixed at start as remarks.
    Dump {
        /// The file, lines of `name = value`; it is overwritten.
        file: PathBuf,
    },
    /// Set all values that a file holds and the robot has not; nothing is set if one of them cannot be.
    Load {
        /// The file, as `gangwerk param dump` writes it.
        file: PathBuf,
        /// Take the command lease from whoever holds it.
        #[arg(long)]
        take_over: bool,
    },
}

pub(crate) fn run(dir: &Path, what: ParamTask) -> Result<(), Box<dyn Error>> {
    match what {
        ParamTask::List => param::list(dir),
        ParamTask::Get { name } => param::get(dir, &name),
        ParamTask::Describe { name } => param::describe(dir, &name),
        ParamTask::Set { name, value, take_over } => param::set(dir, &[(name, value)], take_over),
        ParamTask::Dump { file } => param::dump(dir, &file),
        ParamTask::Load { file, take_over } => param::load(dir, &file, take_over),
    }
}
