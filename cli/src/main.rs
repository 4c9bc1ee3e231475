//! The command `gangwerk`. Without arguments it shows the demonstration scene.

// println! and eprintln! here do not panic: a result that cannot be written is an error, a remark is dropped.
#[macro_use(println, eprintln)]
extern crate terminal;

mod fault_table;
mod run_command;
mod study;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use cli::run::Order;
use daemon::Commands;
use fieldbus::Address;
use ipc::{Mode, Space};
use messages::Process;
use messages::command::Domain;
use realtime::{CountingAllocator, Grade, Stop};

/// Counts what control cycles allocate: nothing, after they are armed.
#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

/// Walking control for biped robots: plan, stabilize, drive the joints, guard, record.
#[derive(Parser)]
#[command(version, about)]
struct Arguments {
    #[command(subcommand)]
    task: Option<Task>,
    /// Configuration directory; default: the one of the source tree.
    #[arg(long, global = true, value_name = "DIR")]
    config: Option<PathBuf>,
}

#[derive(Subcommand)]
enum Task {
    /// Run a scene with all processes: broker, watchdog, simulated robot, logger, planner, stabilizer, joint loop.
    Run {
        /// Name of a file in config/scenes, without .toml.
        scene: String,
        /// Simulated time: every process waits for the others, and two runs are bit for bit the same.
        #[arg(long)]
        lockstep: bool,
        /// Field bus: shm, can:vcan0 (all lines), can:vcan0-8 (one each), canfd:INTERFACES, sercos:INTERFACES.
        #[arg(long, default_value = "shm")]
        bus: Address,
        /// No simulated robot: somebody else is at the far end of the bus, a robot or a replay.
        #[arg(long)]
        no_robot: bool,
        /// Where log and pictures go.
        #[arg(long, value_name = "DIR", default_value = "runs/latest")]
        out: PathBuf,
        /// No log and no pictures.
        #[arg(long)]
        no_log: bool,
        /// Refuse to arm if a process does not get the scheduling and the locked memory that it asks for.
        #[arg(long, value_name = "required", value_parser = ["required"])]
        rt: Option<String>,
        /// Log, but draw no pictures.
        #[arg(long)]
        no_plots: bool,
        /// Where the processes meet; a second robot needs another one.
        #[arg(long, value_name = "DIR", default_value_os_t = ipc::default_dir())]
        dir: PathBuf,
    },
    /// Emergency stop: cut the motor supply of a robot at once. See `gangwerk estop --help`.
    Estop,
    /// Run a scene in one process, as fast as possible.
    Sim {
        /// Name of a file in config/scenes, without .toml.
        scene: String,
        /// End with one JSON object on standard output.
        #[arg(long)]
        json: bool,
        /// Write a log.
        #[arg(long, value_name = "FILE")]
        log: Option<PathBuf>,
        /// Write the traffic of the bus: candump log, or MCAP if it ends in .mcap.
        #[arg(long, value_name = "FILE")]
        can: Option<PathBuf>,
        /// Frames of classic CAN on the bus, instead of those of CAN FD.
        #[arg(long)]
        classic: bool,
    },
    /// Look at the topics of a running robot, or send it commands.
    Topic {
        #[command(subcommand)]
        what: TopicTask,
        /// Where the processes meet.
        #[arg(long, global = true, value_name = "DIR", default_value_os_t = ipc::default_dir())]
        dir: PathBuf,
    },
    /// Parameters of the running stabilizer: list, read, set.
    Param {
        #[command(subcommand)]
        what: ParamTask,
        /// Where the processes meet.
        #[arg(long, global = true, value_name = "DIR", default_value_os_t = ipc::default_dir())]
        dir: PathBuf,
    },
    /// Traffic of the joint loop's bus: record, replay, look at it, hold it against a log.
    Can {
        #[command(subcommand)]
        what: cli::can::Task,
    },
    /// Draw the pictures of a log.
    Plot {
        /// An MCAP file.
        log: PathBuf,
        /// Where the pictures go; default: beside the log.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// What a log holds besides the walk, or a log without an end made whole.
    Log {
        #[command(subcommand)]
        what: LogTask,
    },
    /// Feed the recorded inputs of processes to their real steps: every record they wrote comes out again, bit for bit, or the
    /// first field that differs is named.
    Replay {
        /// An MCAP file of `gangwerk run`.
        log: PathBuf,
        /// planner, controller, lowlevel or watchdog; default: all four, one after the other.
        #[arg(long, value_name = "NAME")]
        process: Option<String>,
    },
    /// How near the walk of a log came to the limits of its contact: zero-moment point, foot rotation, wrench cone.
    Stability {
        /// An MCAP file of a simulated robot.
        log: PathBuf,
        /// Where the pictures go; default: beside the log.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Coefficient of friction; default: that of the log's robot in the configuration.
        #[arg(long, value_name = "MU")]
        friction: Option<f64>,
        /// One JSON object on standard output instead of a table.
        #[arg(long)]
        json: bool,
    },
    /// Speed against accuracy, and where methods fail.
    Study {
        #[command(subcommand)]
        what: study::Task,
        /// End with one JSON object on standard output instead of a table.
        #[arg(long, global = true)]
        json: bool,
    },
    /// Walk everything the robots are to be able to do, and hold it against what is demanded and what others reached.
    Scorecard {
        /// Only entries whose name contains this, for example: "2 km/h", push.
        #[arg(long, value_name = "NAME")]
        only: Option<String>,
        /// Only bus cycles of 1 ms, and pushes at two instants.
        #[arg(long)]
        quick: bool,
        /// Seed of everything random.
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// One JSON object on standard output instead of a table.
        #[arg(long)]
        json: bool,
        /// Where scorecard.txt, scorecard.json, and logs and pictures of some of the walks go.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// Faults F1 to F40 against a walking robot: expected, observed, time. Exit code 1 if one is not as expected.
    Faults(fault_table::Arguments),
    /// Fit friction parameters of a gear to a table of efficiencies, with the older model beside the newer one.
    FitFriction {
        /// A table, for example config/gears/hfuc_25_100.toml.
        file: PathBuf,
        /// Where the picture goes; default: the table's name with .png, in the current directory.
        #[arg(long, value_name = "PNG")]
        out: Option<PathBuf>,
        /// One JSON object on standard output, and no picture unless --out is given.
        #[arg(long)]
        json: bool,
    },
    /// Time that it takes to tell another process something, over topics, raw iceoryx2, the operating system, the broker.
    Latency {
        /// Rounds of all ways; each takes about 12 s.
        #[arg(long, default_value_t = 3)]
        rounds: usize,
        /// Picture of the distributions.
        #[arg(long, value_name = "PNG")]
        png: Option<PathBuf>,
        /// One JSON object on standard output instead of a table.
        #[arg(long)]
        json: bool,
    },
    /// The other process of `gangwerk latency`.
    #[command(hide = true)]
    LatencyEnd { way: String, dir: PathBuf, core: String },
    /// What this machine gives to real time, what is missing, and how to get it.
    Doctor,
    /// One process of a run; `gangwerk run` starts them.
    #[command(hide = true)]
    Broker(Place),
    #[command(hide = true)]
    Watchdog(Place),
    #[command(hide = true)]
    SimBackend(Place),
    #[command(hide = true)]
    Logger(Place),
    #[command(hide = true)]
    Planner(Place),
    #[command(hide = true)]
    Controller(Place),
    #[command(hide = true)]
    Lowlevel(Place),
}

#[derive(Subcommand)]
enum LogTask {
    /// What it is of; every command with its sender and its answer; of a crash record, how and where the process ended.
    Show {
        /// An MCAP file.
        log: PathBuf,
    },
    /// Give a log its end and index that the death of its logger cost: all that is whole is kept.
    Repair {
        /// An MCAP file.
        log: PathBuf,
    },
}

#[derive(clap::Args)]
struct Place {
    /// The run directory.
    #[arg(long)]
    run: PathBuf,
}

#[derive(Subcommand)]
enum ParamTask {
    /// The parameters of all processes of a running robot: value, unit, range, meaning, default.
    List,
    /// The value of one.
    Get {
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
}

#[derive(Subcommand)]
enum TopicTask {
    /// All topics and all commands.
    List,
    /// Print records as they come.
    Echo {
        /// Name of the topic.
        topic: String,
        /// Only one.
        #[arg(long)]
        once: bool,
    },
    /// How often a topic is written.
    Hz {
        /// Name of the topic.
        topic: String,
        /// For how long to count \[s\].
        #[arg(long, default_value_t = 2.0)]
        seconds: f64,
    },
    /// Send a command and tell its answer, for example: walk/velocity forward=0.3
    ///
    /// Who moves the robot holds the command lease: a walk goes on for as long as this program runs and ends with it.
    Pub {
        /// Name of the command.
        command: String,
        /// field=number ...
        fields: Vec<String>,
        /// For a walk without an end: stop after so many seconds; without it, at Ctrl-C.
        #[arg(long = "for", value_name = "SECONDS")]
        seconds: Option<f64>,
        /// Take the command lease from whoever holds it.
        #[arg(long)]
        take_over: bool,
    },
}

fn main() -> ExitCode {
    // Before anything else, and without it.
    if let Some(code) = cli::estop::main(std::env::args_os()) {
        return code;
    }
    tracing_subscriber::fmt().with_writer(|| terminal::Quiet).without_time().with_target(false).init();
    let arguments = Arguments::parse();
    match perform(arguments) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn perform(arguments: Arguments) -> Result<ExitCode, Box<dyn Error>> {
    let config = config::root(arguments.config.as_deref());
    let task = arguments.task.unwrap_or(Task::Run {
        scene: "demo".into(),
        lockstep: false,
        bus: Address::Shared,
        no_robot: false,
        out: "runs/latest".into(),
        no_log: false,
        no_plots: false,
        rt: None,
        dir: ipc::default_dir(),
    });
    match task {
        Task::Run { scene, lockstep, bus, no_robot, out, no_log, no_plots, rt, dir } => {
            let mode = if lockstep { Mode::Lockstep } else { Mode::RealTime };
            let log = (!no_log).then(|| out.join(format!("{scene}.mcap")));
            let (robot, rt_required) = (!no_robot, rt.is_some());
            let order = Order { mode, scene, method: None, config, bus, robot, dir, log, rt_required };
            run_command::run(order, no_plots)
        }
        Task::Estop => Ok(ExitCode::FAILURE), // done before the command line was parsed
        Task::Sim { scene, json, log, can, classic } => sim(&config, &scene, json, log, can, classic),
        Task::Topic { what, dir } => {
            realtime::end_with_reader();
            match what {
                TopicTask::List => cli::topic::list(),
                TopicTask::Echo { topic, once } => cli::topic::echo(&dir, &topic, once.then_some(1))?,
                TopicTask::Hz { topic, seconds } => cli::topic::hz(&dir, &topic, seconds)?,
                TopicTask::Pub { command, fields, seconds, take_over } => {
                    let order = cli::operator::Order { command, fields, seconds, take_over };
                    cli::operator::publish(&dir, &order)?;
                }
            }
            Ok(ExitCode::SUCCESS)
        }
        Task::Param { what, dir } => {
            realtime::end_with_reader();
            match what {
                ParamTask::List => cli::param::list(&dir)?,
                ParamTask::Get { name } => cli::param::get(&dir, &name)?,
                ParamTask::Set { name, value, take_over } => cli::param::set(&dir, &name, value, take_over)?,
            }
            Ok(ExitCode::SUCCESS)
        }
        Task::Can { what } => {
            cli::can::run(&config, what)?;
            Ok(ExitCode::SUCCESS)
        }
        Task::Plot { log, out } => {
            let out = out.unwrap_or_else(|| log.with_extension(""));
            draw(&log, &out)?;
            Ok(ExitCode::SUCCESS)
        }
        Task::Log { what } => {
            realtime::end_with_reader();
            match what {
                LogTask::Show { log } => cli::log::show(&log)?,
                LogTask::Repair { log } => println!("{}", cli::log::mend(&log)?),
            }
            Ok(ExitCode::SUCCESS)
        }
        Task::Replay { log, process } => cli::replay::main(&log, process.as_deref()),
        Task::Stability { log, out, friction, json } => {
            let out = out.unwrap_or_else(|| log.with_extension(""));
            study::stability(&config, &log, &out, friction, json)
        }
        Task::Study { what, json } => study::run(&config, what, json),
        Task::Scorecard { only, quick, seed, json, out } => {
            let order = studies::scorecard::Order { config: &config, only: only.as_deref(), quick, seed };
            cli::scorecard::main(&order, json, out.as_deref())?;
            Ok(ExitCode::SUCCESS)
        }
        Task::Faults(arguments) => fault_table::run(&arguments),
        Task::FitFriction { file, out, json } => {
            cli::fit_friction::main(&file, out, json)?;
            Ok(ExitCode::SUCCESS)
        }
        Task::Latency { rounds, png, json } => cli::latency::main(rounds, png.as_deref(), json),
        Task::LatencyEnd { way, dir, core } => {
            cli::latency::answer(&way, &dir, &core)?;
            Ok(ExitCode::SUCCESS)
        }
        Task::Doctor => Ok(doctor()),
        process => daemon(process),
    }
}

/// The processes of a run. Each ends when the supervisor does.
fn daemon(task: Task) -> Result<ExitCode, Box<dyn Error>> {
    Stop::with_parent()?;
    match task {
        Task::Broker(p) => {
            last_words(&p.run, Process::Broker)?;
            broker::daemon::main(&p.run)?;
        }
        Task::Watchdog(p) => {
            watchdog::daemon::main(&p.run, Box::new(|s: &Space| commands("watchdog", &[Domain::System], s)))?;
        }
        Task::SimBackend(p) => {
            sim_backend::daemon::main(
                &p.run,
                Box::new(|s: &Space| commands("sim-backend", &[Domain::Sim], s)),
            )?;
        }
        Task::Logger(p) => {
            last_words(&p.run, Process::Logger)?;
            logger::daemon::run(&ipc::Run::load(&p.run)?, &Stop::on_signals()?)?;
        }
        Task::Planner(p) => {
            planner::daemon::main(&p.run, Box::new(|s: &Space| commands("planner", &[Domain::Walk], s)))?;
        }
        Task::Controller(p) => {
            let connect = |s: &Space| commands("controller", &[Domain::Stabilize, Domain::Head], s);
            controller::daemon::main(&p.run, Box::new(connect))?;
        }
        Task::Lowlevel(p) => {
            let connect = |s: &Space| commands("lowlevel", &[Domain::System, Domain::Joint], s);
            lowlevel::daemon::main(&p.run, Box::new(connect))?;
        }
        _ => {}
    }
    Ok(ExitCode::SUCCESS)
}

/// Of a process without cycles: where it was, if it dies.
fn last_words(dir: &std::path::Path, process: Process) -> Result<(), Box<dyn Error>> {
    let path = ipc::Run::load(dir)?.box_of(process)?;
    Ok(realtime::black_box::say_last_words(&path).map_err(|e| format!("{}: {e}", path.display()))?)
}

/// Live commands of these domains, through the broker.
fn commands(name: &str, domains: &[Domain], space: &Space) -> Result<Commands, String> {
    Ok(Box::new(broker::Client::start(name, domains, space)?))
}

fn sim(
    config: &std::path::Path,
    scene: &str,
    json: bool,
    log: Option<PathBuf>,
    can: Option<PathBuf>,
    classic: bool,
) -> Result<ExitCode, Box<dyn Error>> {
    let (setup, choice) = cli::choose::load(config, scene, !json)?;
    let setup = setup.on_bus(classic);
    let bar = if json {
        indicatif::ProgressBar::hidden()
    } else {
        indicatif::ProgressBar::new(setup.scene.duration as u64)
    };
    let mut figures = cli::sim::run(&setup, log.as_deref(), can.as_deref(), |t| bar.set_position(t as u64))?;
    figures.depth_reason = choice.map(|choice| choice.reason());
    bar.finish_and_clear();
    println!("{}", if json { serde_json::to_string(&figures)? } else { cli::figures::table(&figures) });
    Ok(ExitCode::SUCCESS)
}

fn draw(log: &std::path::Path, out: &std::path::Path) -> Result<(), Box<dyn Error>> {
    let pictures = cli::plot::run(log, out)?;
    for path in &pictures.written {
        println!("{}", path.display());
    }
    for reason in &pictures.skipped {
        eprintln!("not drawn: {reason}");
    }
    Ok(())
}

fn doctor() -> ExitCode {
    let checks = realtime::preflight();
    for c in &checks {
        let mark = match c.grade {
            Grade::Good => "good   ",
            Grade::Fair => "fair   ",
            Grade::Missing => "missing",
        };
        println!("{mark}  {:28} {}", c.what, c.found);
        if !c.advice.is_empty() {
            println!("         {:28} → {}", "", c.advice);
        }
    }
    let missing = checks.iter().any(|c| c.grade == Grade::Missing);
    if missing { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
