//! `gangwerk topic`: its words on the command line.

use std::error::Error;
use std::path::Path;

use clap::Subcommand;
use cli::operator::{self, OperatorRequest};
use cli::topic::{self, Echo, Measure};

#[derive(Subcommand)]
pub(crate) enum TopicTask {
    /// All topics and all commands.
    List,
    /// Type, writer, readers, rate and fields of a topic, with units; or the fields of a command.
    Info {
        /// Name of the topic or command.
        name: String,
    },
    /// Type of a topic.
    Type {
        /// Name of the topic.
        topic: String,
    },
    /// Print records as they come; events of all processes: `gangwerk topic echo events`.
    Echo {
        /// Name of the topic, or events.
        topic: String,
        /// Only this field, or those inside of it, for example joint_angle.right_knee_flexion; may be repeated.
        #[arg(long = "field", value_name = "FIELD")]
        fields: Vec<String>,
        /// A table of comma-separated values, all digits.
        #[arg(long)]
        csv: bool,
        /// End after so many records.
        #[arg(short = 'n', long, value_name = "RECORDS", value_parser = clap::value_parser!(u64).range(1..))]
        count: Option<u64>,
        /// Only one.
        #[arg(long, conflicts_with = "count")]
        once: bool,
    },
    /// How often a topic is written; mean, least, greatest and standard deviation of the period.
    Hz(Listen),
    /// How many bytes per second a topic is.
    Bw(Listen),
    /// How old records are when they come.
    Delay(Listen),
    /// Send a command and tell its answer, for example: walk/velocity forward=0.3
    ///
    /// A program that moves the robot holds the command lease: a walk goes on for as long as this program runs and ends with it.
    Pub {
        /// Name of the command.
        command: String,
        /// field=number ...
        fields: Vec<String>,
        /// For a walk without an end: stop after so many seconds; without it, at Ctrl-C.
        #[arg(long = "for", value_name = "SECONDS")]
        seconds: Option<f64>,
        /// Send it again so many times per second, until Ctrl-C or --times.
        #[arg(long, value_name = "HZ", conflicts_with = "seconds")]
        rate: Option<f64>,
        /// Send it so many times, once per second without --rate.
        #[arg(long, value_name = "COUNT", conflicts_with = "seconds", value_parser = clap::value_parser!(u64).range(1..))]
        times: Option<u64>,
        /// Send it once and end with its answer; a walk without an end stops then.
        #[arg(short = '1', long, conflicts_with_all = ["seconds", "rate", "times"])]
        once: bool,
        /// Take the command lease from whoever holds it.
        #[arg(long)]
        take_over: bool,
    },
}

#[derive(clap::Args)]
pub(crate) struct Listen {
    /// Name of the topic.
    topic: String,
    /// For how long, in seconds.
    #[arg(long, default_value_t = 2.0)]
    seconds: f64,
}

pub(crate) fn run(dir: &Path, what: TopicTask) -> Result<(), Box<dyn Error>> {
    let measure = |what, l: Listen| topic::measure(dir, &l.topic, what, l.seconds);
    match what {
        TopicTask::List => topic::list(),
        TopicTask::Info { name } => topic::info(&name)?,
        TopicTask::Type { topic } => topic::type_of(&topic)?,
        TopicTask::Echo { topic, fields, csv, count, once } => {
            topic::echo(dir, &topic, &Echo { fields, csv, count: count.or(once.then_some(1)) })?;
        }
        TopicTask::Hz(listen) => measure(Measure::Rate, listen)?,
        TopicTask::Bw(listen) => measure(Measure::Bandwidth, listen)?,
        TopicTask::Delay(listen) => measure(Measure::Delay, listen)?,
        TopicTask::Pub { command, fields, seconds, rate, times, once, take_over } => {
            let times = if once { Some(1) } else { times };
            operator::publish(dir, &OperatorRequest { command, fields, seconds, rate, times, take_over })?;
        }
    }
    Ok(())
}
