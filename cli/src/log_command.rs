//! `gangwerk log`: its words on the command line.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Subcommand;
use cli::topic::Echo;

#[derive(Subcommand)]
pub(crate) enum LogTask {
    /// Origin, length, and number of messages per channel.
    Info {
        /// An MCAP file.
        log: PathBuf,
    },
    /// Every command with its sender and its answer, every event; of a crash record, how and where the process ended.
    Show {
        /// An MCAP file.
        log: PathBuf,
    },
    /// Print the records of a topic as a table of comma-separated values, with names of joints, all digits.
    Export {
        /// An MCAP file.
        log: PathBuf,
        /// Name of the topic, for example sensors.
        topic: String,
        /// Only this field, or those inside of it; may be repeated.
        #[arg(long = "field", value_name = "FIELD")]
        fields: Vec<String>,
        /// The format: there is no other one.
        #[arg(long, default_value_t = true)]
        csv: bool,
    },
    /// Hold the records of two logs against each other, bit for bit: exit code 1 if they differ, and where they do first.
    Compare {
        /// An MCAP file.
        a: PathBuf,
        /// Another one.
        b: PathBuf,
    },
    /// Give a log the end that the death of its logger cost; of a damaged one keep every whole chunk, and the original as LOG.damaged.
    Repair {
        /// An MCAP file.
        log: PathBuf,
    },
}

pub(crate) fn run(what: LogTask) -> Result<ExitCode, Box<dyn Error>> {
    match what {
        LogTask::Info { log } => cli::log::info(&log)?,
        LogTask::Show { log } => cli::log::show(&log)?,
        LogTask::Export { log, topic, fields, csv } => {
            cli::log::export(&log, &topic, &Echo { fields, csv, count: None })?;
        }
        LogTask::Compare { a, b } => {
            let same = cli::log::compare(&a, &b)?;
            return Ok(if same { ExitCode::SUCCESS } else { ExitCode::FAILURE });
        }
        LogTask::Repair { log } => println!("{}", cli::log::mend(&log)?),
    }
    Ok(ExitCode::SUCCESS)
}
