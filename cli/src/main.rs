//! The command `gangwerk`. Without arguments it shows the demonstration scene.

// println! and eprintln! here do not panic: a result that cannot be written is an error, a remark is dropped.
#[macro_use(println, eprintln)]
extern crate terminal;

mod config_command;
mod console_command;
mod dashboard_command;
mod desk;
mod explore_command;
mod fault_table;
mod gateway_command;
mod joystick_command;
mod log_command;
mod param_command;
mod reference;
mod robot_command;
mod run_command;
mod sim_command;
mod study;
mod sweep_command;
mod topic_command;
mod words;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};
use daemon::Connect;
use messages::Process;
use realtime::{CountingAllocator, Grade, Stop};

/// Counts what control cycles allocate: nothing, after they are armed.
#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

/// Walking control for biped robots: plan, stabilize, drive the joints, guard, record.
#[derive(Parser)]
#[command(name = "gangwerk", version = cli::VERSION, about)]
struct Arguments {
    #[command(subcommand)]
    task: Option<GangwerkTask>,
    /// Configuration directory; default: see `gangwerk config where`.
    #[arg(long, global = true, value_name = "DIR")]
    config: Option<PathBuf>,
}

#[derive(Subcommand)]
enum GangwerkTask {
    /// Run a scene with all processes: broker, watchdog, simulated robot, logger, planner, stabilizer, joint loop.
    #[command(after_help = cli::exit::HELP)]
    Run(run_command::RunArguments),
    /// Emergency stop: cut the motor supply of a robot at once. See `gangwerk estop --help`.
    Estop,
    /// Run a scene in one process, as fast as possible.
    #[command(after_help = cli::exit::HELP)]
    Sim(sim_command::SimArguments),
    /// Look at the topics of a running robot, or send it commands.
    Topic {
        #[command(subcommand)]
        what: topic_command::TopicTask,
        /// Run directory.
        #[arg(long, global = true, value_name = "DIR", default_value_os_t = ipc::default_dir())]
        dir: PathBuf,
    },
    /// Parameters of a running robot: list, read, set, write to a file.
    Param {
        #[command(subcommand)]
        what: param_command::ParamTask,
        /// Run directory.
        #[arg(long, global = true, value_name = "DIR", default_value_os_t = ipc::default_dir())]
        dir: PathBuf,
    },
    /// See, steer, tune and plot a robot in a browser; waits for one if none runs.
    Dashboard(dashboard_command::DashboardArguments),
    /// Walk a robot with a gamepad; waits for one if none runs.
    #[command(after_help = joystick_command::HELP)]
    Joystick(joystick_command::JoystickArguments),
    /// Vision interface over UDP: where the robot is goes out, velocities and boxes come in; waits for a robot if none runs.
    #[command(after_help = gateway_command::HELP)]
    Gateway(gateway_command::GatewayArguments),
    /// Vision system that walks a simulated robot about a room, at its gateway.
    #[command(after_help = explore_command::HELP)]
    Explore(explore_command::ExploreArguments),
    /// Interactive Python shell with a client `robot` of the running robot; needs the Python package: docs/python.md.
    Console(console_command::ConsoleArguments),
    /// The configuration that is taken, or a copy of the built-in one.
    Config {
        #[command(subcommand)]
        what: config_command::ConfigTask,
    },
    /// Scenes that can be walked.
    Scene {
        #[command(subcommand)]
        what: config_command::SceneTask,
    },
    /// Files of a robot that are made from its robot.toml.
    Robot {
        #[command(subcommand)]
        what: robot_command::RobotTask,
    },
    /// Traffic of the joint loop's bus: record, replay, look at it, hold it against a log.
    Can {
        #[command(subcommand)]
        what: cli::can::CanTask,
    },
    /// Draw the pictures of a log.
    Plot {
        /// An MCAP file.
        log: PathBuf,
        /// Directory of the pictures; default: beside the log.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// What a log holds: overview, commands and events, tables, differences; or a log without an end made whole.
    Log {
        #[command(subcommand)]
        what: log_command::LogTask,
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
        /// Directory of the pictures; default: beside the log.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Coefficient of friction; default: that of the log's robot in the configuration.
        #[arg(long, value_name = "MU")]
        friction: Option<f64>,
        #[command(flatten)]
        form: study::SheetForm,
    },
    /// Speed against accuracy, and where methods fail.
    Study {
        #[command(subcommand)]
        what: study::StudyTask,
        #[command(flatten)]
        form: study::SheetForm,
    },
    /// Tune the drive of a joint on a simulated bench, or a gait in simulation.
    Tune {
        #[command(subcommand)]
        what: study::TuneTask,
        #[command(flatten)]
        form: study::SheetForm,
    },
    /// Walk scenes again and again with other numbers and seeds: a table of all walks, and maps of what was survived.
    #[command(after_help = sweep_command::HELP)]
    Sweep(sweep_command::SweepArguments),
    /// Walk everything the robots are to be able to do, and hold it against what is demanded and what others reached.
    Scorecard {
        /// Only entries whose name contains this, for example: "2 km/h", push.
        #[arg(long, value_name = "NAME")]
        only: Option<String>,
        /// Only bus cycles of 1 ms, pushes at two instants, and two places of each kind of ground.
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
    Faults(fault_table::FaultTableArguments),
    /// Draw the walk of a gait on a robot that does as it is told: stick figures, trajectories, joint angles, and what cannot be walked.
    Preview {
        /// Name of a gait, for example archie_static or lola, or path of a gait file.
        gait: PathBuf,
        /// Name of the robot.
        #[arg(long, default_value = "archie")]
        robot: String,
        /// Speed [m/s] of a balanced gait; default: its longest steps.
        #[arg(long)]
        speed: Option<f64>,
        /// Where the pictures go.
        #[arg(long, value_name = "DIR", default_value = "preview")]
        out: PathBuf,
    },
    /// Fit friction parameters of a gear to a table of efficiencies, with the older model beside the newer one.
    FitFriction {
        /// A table, for example config/gears/hfuc_25_100.toml.
        file: PathBuf,
        /// Path of the picture; default: the table's name with .png, in the current directory.
        #[arg(long, value_name = "PNG")]
        out: Option<PathBuf>,
        /// One JSON object on standard output, and no picture unless --out is given.
        #[arg(long)]
        json: bool,
    },
    /// Time that it takes to tell another process something, over topics, raw iceoryx2, the operating system, the broker.
    Latency {
        /// Rounds of all ways; each takes about 12 s.
        #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u64).range(1..=1000))]
        rounds: u64,
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
    /// Completions for a shell, for example: gangwerk completions bash >~/.local/share/bash-completion/completions/gangwerk
    Completions {
        /// Which shell.
        shell: clap_complete::Shell,
    },
    /// Write man pages, one for each command.
    Man {
        /// Directory for them, for example ~/.local/share/man/man1; it is made.
        dir: PathBuf,
    },
    /// Pages of the book's reference, for docs/reference; in a clone of the repository only.
    #[command(hide = true)]
    Reference { dir: PathBuf },
    /// One process of a run; `gangwerk run` starts them.
    #[command(hide = true)]
    Broker(RunArgument),
    #[command(hide = true)]
    Watchdog(RunArgument),
    #[command(hide = true)]
    SimBackend(RunArgument),
    #[command(hide = true)]
    Logger(RunArgument),
    #[command(hide = true)]
    Planner(RunArgument),
    #[command(hide = true)]
    Controller(RunArgument),
    #[command(hide = true)]
    Lowlevel(RunArgument),
}

impl GangwerkTask {
    /// Whether it only tells something. What moves a robot or guards it does not end because nobody reads any more.
    fn only_tells(&self) -> bool {
        use GangwerkTask::{
            Broker, Console, Controller, Dashboard, Explore, Faults, Gateway, Joystick, Latency, Logger,
            Lowlevel, Planner, Run, SimBackend, Watchdog,
        };
        let moves = matches!(
            self,
            Run(_)
                | Self::Sim(sim_command::SimArguments { plant: Some(_), .. })
                | Faults(_)
                | Console(_)
                | Dashboard(_)
                | Gateway(_)
                | Explore(_)
                | Joystick(_)
                | Latency { .. }
                | Self::LatencyEnd { .. }
        );
        let guards = matches!(self, Broker(_) | Controller(_) | Logger(_) | Lowlevel(_) | Planner(_));
        !(moves || guards || matches!(self, SimBackend(_) | Watchdog(_)))
    }
}

#[derive(clap::Args)]
struct RunArgument {
    /// The run directory.
    #[arg(long)]
    run: PathBuf,
}

fn main() -> ExitCode {
    // Before anything else, and without it.
    if let Some(code) = cli::estop::main(std::env::args_os()) {
        return code;
    }
    realtime::last_words::abort_at_panic();
    realtime::ignore_sigxfsz();
    tracing_subscriber::fmt().with_writer(|| terminal::Quiet).without_time().with_target(false).init();
    let arguments = Arguments::parse();
    config::embed(cli::shipped::files());
    // A result that nobody reads any more (`| head`) ends a command quietly; a robot goes on.
    if arguments.task.as_ref().is_some_and(GangwerkTask::only_tells) {
        realtime::end_with_reader();
    }
    match perform(arguments) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn perform(arguments: Arguments) -> Result<ExitCode, Box<dyn Error>> {
    let asked = arguments.config.as_deref();
    let config = || config::find(asked).map(|found| found.dir);
    let done = |result: Result<(), Box<dyn Error>>| result.map(|()| ExitCode::SUCCESS);
    let task =
        arguments.task.unwrap_or_else(|| GangwerkTask::Run(run_command::RunArguments::demonstration()));
    match task {
        GangwerkTask::Run(arguments) => run_command::main(arguments, config()?),
        // Done before the command line was parsed, unless it was found only now.
        GangwerkTask::Estop => Ok(cli::estop::run(std::iter::empty())),
        GangwerkTask::Sim(arguments) => sim_command::run(&config()?, &arguments),
        GangwerkTask::Topic { what, dir } => done(topic_command::run(&dir, what)),
        GangwerkTask::Dashboard(arguments) => done(dashboard_command::run(arguments, asked)),
        GangwerkTask::Joystick(arguments) => done(joystick_command::run(arguments, &config()?)),
        GangwerkTask::Gateway(arguments) => done(gateway_command::run(arguments)),
        GangwerkTask::Explore(arguments) => done(explore_command::run(arguments)),
        GangwerkTask::Param { what, dir } => done(param_command::run(&dir, what)),
        GangwerkTask::Console(arguments) => done(console_command::run(&arguments)),
        GangwerkTask::Config { what } => done(config_command::run(asked, what)),
        GangwerkTask::Scene { what: config_command::SceneTask::List } => {
            done(config_command::scenes(&config()?))
        }
        GangwerkTask::Robot { what } => done(robot_command::run(&config()?, what)),
        GangwerkTask::Can { what } => {
            cli::can::run(&config()?, what)?;
            Ok(ExitCode::SUCCESS)
        }
        GangwerkTask::Plot { log, out } => {
            let out = out.unwrap_or_else(|| log.with_extension(""));
            draw(&log, &out)?;
            Ok(ExitCode::SUCCESS)
        }
        GangwerkTask::Log { what } => log_command::run(what),
        GangwerkTask::Replay { log, process } => cli::replay::main(&log, process.as_deref()),
        GangwerkTask::Stability { log, out, friction, form } => {
            let out = out.unwrap_or_else(|| log.with_extension(""));
            study::stability(&config()?, &log, &out, friction, &form)
        }
        GangwerkTask::Study { what, form } => study::run(&config()?, &what, &form),
        GangwerkTask::Tune { what, form } => study::tune(&config()?, &what, &form),
        GangwerkTask::Sweep(arguments) => sweep_command::main(&config()?, &arguments),
        GangwerkTask::Scorecard { only, quick, seed, json, out } => {
            let config = config()?;
            let order =
                cli::scorecard::ScorecardOptions { config: &config, only: only.as_deref(), quick, seed };
            cli::scorecard::main(&order, json, out.as_deref())?;
            Ok(ExitCode::SUCCESS)
        }
        GangwerkTask::Faults(arguments) => fault_table::run(&arguments),
        GangwerkTask::Preview { gait, robot, speed, out } => {
            let preview = cli::preview::of_files(&config()?, &gait, &robot, speed, &out)?;
            preview.files.iter().for_each(|file| println!("{}", file.display()));
            match preview.fault {
                None => Ok(ExitCode::SUCCESS),
                Some(fault) => Err(fault.into()),
            }
        }
        GangwerkTask::FitFriction { file, out, json } => {
            cli::fit_friction::main(&file, out, json)?;
            Ok(ExitCode::SUCCESS)
        }
        GangwerkTask::Latency { rounds, png, json } => {
            cli::latency::main(rounds as usize, png.as_deref(), json)
        }
        GangwerkTask::LatencyEnd { way, dir, core } => {
            cli::latency::answer(&way, &dir, &core)?;
            Ok(ExitCode::SUCCESS)
        }
        GangwerkTask::Doctor => Ok(doctor()),
        GangwerkTask::Completions { shell } => done(words::completions(shell, Arguments::command())),
        GangwerkTask::Man { dir } => done(words::man_pages(&dir, Arguments::command())),
        GangwerkTask::Reference { dir } => done(reference::write(&dir, Arguments::command())),
        process => daemon(process),
    }
}

/// The processes of a run. Each ends when the supervisor does.
fn daemon(task: GangwerkTask) -> Result<ExitCode, Box<dyn Error>> {
    Stop::with_parent()?;
    match task {
        GangwerkTask::Broker(p) => {
            last_words(&p.run, Process::Broker)?;
            broker::daemon::main(&p.run)?;
        }
        GangwerkTask::Watchdog(p) => watchdog::daemon::main(&p.run, commands(Process::Watchdog))?,
        GangwerkTask::SimBackend(p) => sim_backend::daemon::main(&p.run, commands(Process::SimBackend))?,
        GangwerkTask::Logger(p) => {
            last_words(&p.run, Process::Logger)?;
            logger::daemon::run(&ipc::Run::load(&p.run)?, &Stop::on_signals()?)?;
        }
        GangwerkTask::Planner(p) => planner::daemon::main(&p.run, commands(Process::Planner))?,
        GangwerkTask::Controller(p) => controller::daemon::main(&p.run, commands(Process::Controller))?,
        GangwerkTask::Lowlevel(p) => {
            let done = lowlevel::daemon::main(&p.run, commands(Process::Lowlevel))?;
            // Asked to end before the scene was done: no success, unless it is the supervisor who asked.
            return Ok(if done { ExitCode::SUCCESS } else { cli::exit::Exit::Interrupted.into() });
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

/// Live commands of a process's domains, through the broker.
fn commands(process: Process) -> Connect<'static> {
    Box::new(move |space| {
        let client = broker::Client::start(process.name(), process.command_domains(), space)?;
        Ok(Box::new(client))
    })
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
