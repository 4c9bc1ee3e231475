//! `gangwerk can`: traffic of the joint loop's bus, recorded, replayed, looked at and held against logs.

pub mod check;
mod decoder;
mod dictionary;
pub mod dump;
mod file;
mod load_picture;
pub mod record;
pub mod replay;
mod source;
pub mod stat;

use std::error::Error;
use std::path::{Path, PathBuf};

use clap::Subcommand;

/// Task on the traffic of a bus.
#[derive(Subcommand)]
pub enum CanTask {
    /// Record interfaces to a file: candump log, or MCAP if it ends in .mcap. Ctrl-C ends it.
    Record(record::RecordOptions),
    /// Play a recording on interfaces of this machine.
    Replay(replay::ReplayOptions),
    /// Print the frames of a file or of interfaces; with a robot also what they carry.
    Dump(dump::DumpOptions),
    /// Count the frames of a file or of interfaces: rates, periods, bus load, gaps.
    Stat(stat::StatOptions),
    /// Hold a recording against the log of the run it was made in: same sensor data, same target frames, bit for bit.
    Check(check::CheckOptions),
    /// Write a recording as another file: candump log, or MCAP if it ends in .mcap.
    Convert {
        /// A candump log, ASC, TRC or an MCAP file.
        from: PathBuf,
        /// The other one.
        to: PathBuf,
        /// Leave broken lines out, and tell how many.
        #[arg(long)]
        lenient: bool,
    },
}

/// Which frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum Only {
    /// Frames that lowlevel sends.
    ToDrives,
    /// Frames that the local controllers answer.
    FromDrives,
}

/// Does it.
///
/// # Errors
/// A file, an interface or the configuration cannot be used.
pub fn run(config: &Path, task: CanTask) -> Result<(), Box<dyn Error>> {
    match task {
        CanTask::Record(order) => record::run(config, &order),
        CanTask::Replay(order) => replay::run(config, &order),
        CanTask::Dump(order) => {
            realtime::end_with_reader();
            dump::run(config, &order)
        }
        CanTask::Stat(order) => {
            realtime::end_with_reader();
            stat::run(config, &order)
        }
        CanTask::Check(order) => check::run(config, &order),
        CanTask::Convert { from, to, lenient } => {
            let capture = file::read(&from, lenient)?;
            file::write(&to, &capture)?;
            println!("{}: {} frames of {}", to.display(), capture.frames.len(), capture.lines.join(", "));
            Ok(())
        }
    }
}
