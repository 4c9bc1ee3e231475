//! The command `gangwerk`. Without arguments it shows the demonstration scene.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use cli::run::{Order, Outcome};
use daemon::Commands;
use ipc::{Mode, Space};
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
        /// Where log and pictures go.
        #[arg(long, value_name = "DIR", default_value = "runs/latest")]
        out: PathBuf,
        /// No log and no pictures.
        #[arg(long)]
        no_log: bool,
        /// Log, but draw no pictures.
        #[arg(long)]
        no_plots: bool,
        /// Where the processes meet; a second robot needs another one.
        #[arg(long, value_name = "DIR", default_value = cli::RUN_DIR)]
        dir: PathBuf,
    },
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
    },
    /// Look at the topics of a running robot, or send it commands.
    Topic {
        #[command(subcommand)]
        what: TopicTask,
        /// Where the processes meet.
        #[arg(long, global = true, value_name = "DIR", default_value = cli::RUN_DIR)]
        dir: PathBuf,
    },
    /// Parameters of the running stabilizer: list, read, set.
    Param {
        #[command(subcommand)]
        what: ParamTask,
        /// Where the processes meet.
        #[arg(long, global = true, value_name = "DIR", default_value = cli::RUN_DIR)]
        dir: PathBuf,
    },
    /// Draw the pictures of a log.
    Plot {
        /// An MCAP file.
        log: PathBuf,
        /// Where the pictures go; default: beside the log.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
    /// Speed against accuracy, and where methods fail.
    Study {
        #[command(subcommand)]
        what: StudyTask,
        /// End with one JSON object on standard output instead of a table.
        #[arg(long, global = true)]
        json: bool,
    },
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

#[derive(clap::Args)]
struct Place {
    /// The run directory.
    #[arg(long)]
    run: PathBuf,
}

#[derive(Subcommand)]
enum ParamTask {
    /// All parameters with unit, range and meaning; of a running robot also their values.
    List,
    /// The value of one.
    Get {
        /// Name of the parameter.
        name: String,
    },
    /// Another value, from the next cycle on.
    Set {
        /// Name of the parameter.
        name: String,
        /// In its unit and range.
        #[arg(allow_negative_numbers = true)]
        value: f64,
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
    /// Send a command, for example: walk/velocity forward=0.3
    Pub {
        /// Name of the command.
        command: String,
        /// field=number ...
        fields: Vec<String>,
    },
}

#[derive(Subcommand)]
enum StudyTask {
    /// Which impulse the walking robot survives.
    Push {
        /// Only this scene; default: walking in place and at 1 km/h.
        #[arg(long)]
        scene: Option<String>,
        /// How many instants of a stride are tried.
        #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=1000))]
        instants: u64,
    },
    /// Which method is cheapest for a given accuracy: charts of processor time against error.
    Accuracy {
        /// Only these charts: flight, touchdown, slip, stiction, joint, solver, ...
        #[arg(long, value_name = "PART")]
        only: Option<String>,
        /// What MuJoCo found in the same scenes; `sh tests/peers/mujoco.sh --points FILE` writes it.
        #[arg(long, value_name = "FILE")]
        peers: Option<PathBuf>,
        /// Where pictures and accuracy.json go.
        #[arg(long, value_name = "DIR", default_value = "runs/study/accuracy")]
        out: PathBuf,
    },
    /// How fast simulation, planner and stabilizer are, and how accurate at that speed.
    Speed,
    /// Where methods fail: predicted and measured limits, and how each failure is reported.
    Limits,
    /// Figures of the thesis that compare two walks: 5.2, 4.17, 9.1.
    Thesis {
        /// Only this figure.
        #[arg(long)]
        figure: Option<String>,
        /// Type of the model: 1, reduced; 2, with motors; 3, with elastic gears.
        #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=3))]
        depth: u8,
        /// Where the pictures go.
        #[arg(long, value_name = "DIR", default_value = "runs/thesis")]
        out: PathBuf,
    },
    /// How well the processes keep real time, beside cyclictest before and after.
    Realtime {
        /// The scene that is run.
        #[arg(long, default_value = "walk_60s")]
        scene: String,
        /// How long cyclictest runs \[s\]; 0: not at all.
        #[arg(long, default_value_t = 20)]
        cyclictest: u64,
        /// Where the log goes.
        #[arg(long, value_name = "DIR", default_value = "runs/realtime")]
        out: PathBuf,
    },
}

fn main() -> ExitCode {
    tracing_subscriber::fmt().with_writer(std::io::stderr).without_time().with_target(false).init();
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
        out: "runs/latest".into(),
        no_log: false,
        no_plots: false,
        dir: cli::RUN_DIR.into(),
    });
    match task {
        Task::Run { scene, lockstep, out, no_log, no_plots, dir } => {
            let mode = if lockstep { Mode::Lockstep } else { Mode::RealTime };
            let log = (!no_log).then(|| out.join(format!("{scene}.mcap")));
            run(Order { mode, scene, method: None, config, dir, log, progress: true }, no_plots)
        }
        Task::Sim { scene, json, log } => sim(&config, &scene, json, log),
        Task::Topic { what, dir } => {
            realtime::end_with_reader();
            match what {
                TopicTask::List => cli::topic::list(),
                TopicTask::Echo { topic, once } => cli::topic::echo(&dir, &topic, once.then_some(1))?,
                TopicTask::Hz { topic, seconds } => cli::topic::hz(&dir, &topic, seconds)?,
                TopicTask::Pub { command, fields } => cli::topic::publish(&dir, &command, &fields)?,
            }
            Ok(ExitCode::SUCCESS)
        }
        Task::Param { what, dir } => {
            realtime::end_with_reader();
            match what {
                ParamTask::List => cli::param::list(&dir),
                ParamTask::Get { name } => cli::param::get(&dir, &name)?,
                ParamTask::Set { name, value } => cli::param::set(&dir, &name, value)?,
            }
            Ok(ExitCode::SUCCESS)
        }
        Task::Plot { log, out } => {
            let out = out.unwrap_or_else(|| log.with_extension(""));
            draw(&log, &out)?;
            Ok(ExitCode::SUCCESS)
        }
        Task::Study { what, json } => study(&config, what, json),
        Task::FitFriction { file, out, json } => {
            fit_friction(&file, out, json)?;
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
        Task::Broker(p) => broker::daemon::main(&p.run, None)?,
        Task::Watchdog(p) => {
            watchdog::daemon::main(&p.run, Box::new(|s: &Space| commands("watchdog", &[Domain::System], s)))?;
        }
        Task::SimBackend(p) => {
            sim_backend::daemon::main(
                &p.run,
                Box::new(|s: &Space| commands("sim-backend", &[Domain::Sim], s)),
            )?;
        }
        Task::Logger(p) => logger::daemon::run(&ipc::Run::load(&p.run)?, &Stop::on_signals()?)?,
        Task::Planner(p) => {
            planner::daemon::main(&p.run, Box::new(|s: &Space| commands("planner", &[Domain::Walk], s)))?;
        }
        Task::Controller(p) => {
            let connect = |s: &Space| commands("controller", &[Domain::Stabilize], s);
            controller::daemon::main(&p.run, Box::new(connect))?;
        }
        Task::Lowlevel(p) => lowlevel::daemon::main(&p.run)?,
        _ => {}
    }
    Ok(ExitCode::SUCCESS)
}

/// Live commands of these domains, through the broker.
fn commands(name: &str, domains: &[Domain], space: &Space) -> Result<Commands, String> {
    let mut client = broker::Client::start(name, domains, space)?;
    Ok(Box::new(move || client.received().next()))
}

fn run(mut order: Order, no_plots: bool) -> Result<ExitCode, Box<dyn Error>> {
    if let Some(directory) = order.log.as_ref().and_then(|log| log.parent()) {
        std::fs::create_dir_all(directory)
            .map_err(|e| format!("{}: {e}; choose another place with --out", directory.display()))?;
    }
    let (setup, choice) = cli::choose::load(&order.config, &order.scene, true)?;
    order.method = choice.map(|choice| choice.method);
    let Outcome { died, interrupted } = cli::run::run(&order)?;
    if let Some(log) = &order.log {
        let figures = cli::run::figures_of(log, &setup)?;
        println!("{}", cli::figures::table(&figures));
        if !no_plots {
            draw(log, log.parent().unwrap_or(log))?;
        }
    }
    for (process, status) in &died {
        eprintln!("{} died during the run: {}", process.name(), cli::run::how_it_died(status));
    }
    Ok(match (died.is_empty(), interrupted) {
        (false, _) => ExitCode::FAILURE,
        (true, true) => ExitCode::from(130),
        (true, false) => ExitCode::SUCCESS,
    })
}

fn sim(
    config: &std::path::Path,
    scene: &str,
    json: bool,
    log: Option<PathBuf>,
) -> Result<ExitCode, Box<dyn Error>> {
    let (setup, choice) = cli::choose::load(config, scene, !json)?;
    let bar = if json {
        indicatif::ProgressBar::hidden()
    } else {
        indicatif::ProgressBar::new(setup.scene.duration as u64)
    };
    let mut figures = cli::sim::run(&setup, log.as_deref(), |t| bar.set_position(t as u64))?;
    figures.depth_reason = choice.map(|choice| choice.reason());
    bar.finish_and_clear();
    if json {
        println!("{}", serde_json::to_string(&figures)?);
    } else {
        println!("{}", cli::figures::table(&figures));
    }
    Ok(ExitCode::SUCCESS)
}

fn study(config: &std::path::Path, what: StudyTask, json: bool) -> Result<ExitCode, Box<dyn Error>> {
    use studies::{cycles, figures_of_thesis, limits, push, speed};
    let (object, table) = match what {
        StudyTask::Accuracy { only, peers, out } => {
            let report = accuracy_study(config, only.as_deref(), peers.as_deref(), &out)?;
            (serde_json::to_string(&report)?, studies::accuracy::table(&report))
        }
        StudyTask::Push { scene, instants } => {
            let report = push::run(config, scene.as_deref(), instants as usize)?;
            (serde_json::to_string(&report)?, push::table(&report))
        }
        StudyTask::Limits => {
            let report = limits::run(config)?;
            (serde_json::to_string(&report)?, limits::table(&report))
        }
        StudyTask::Speed => {
            let report = speed::run(config)?;
            (serde_json::to_string(&report)?, speed::table(&report))
        }
        StudyTask::Thesis { figure, depth, out } => {
            let report = figures_of_thesis::run(config, figure.as_deref(), depth, &out)?;
            (serde_json::to_string(&report)?, figures_of_thesis::table(&report))
        }
        StudyTask::Realtime { scene, cyclictest, out } => {
            let report = realtime_study(config, scene, cyclictest, &out)?;
            (serde_json::to_string(&report)?, cycles::table(&report))
        }
    };
    println!("{}", if json { object } else { table });
    Ok(ExitCode::SUCCESS)
}

/// The charts of accuracy, with progress on standard error.
fn accuracy_study(
    config: &std::path::Path,
    only: Option<&str>,
    peers: Option<&std::path::Path>,
    out: &std::path::Path,
) -> Result<studies::accuracy::Report, Box<dyn Error>> {
    let peers = peers.map(studies::accuracy::Peers::load).transpose()?.unwrap_or_default();
    let bar = indicatif::ProgressBar::new(0);
    bar.set_style(indicatif::ProgressStyle::with_template("{wide_bar} {pos}/{len} {msg}")?);
    let report = studies::accuracy::run(config, &peers, out, only, |done, of, part| {
        bar.set_length(of as u64);
        bar.set_position(done as u64);
        bar.set_message(part.to_string());
    })?;
    bar.finish_and_clear();
    Ok(report)
}

/// cyclictest, the scene with all processes, cyclictest again: on the core and with the priority of the joint loop.
fn realtime_study(
    config: &std::path::Path,
    scene: String,
    seconds: u64,
    out: &std::path::Path,
) -> Result<studies::cycles::Report, Box<dyn Error>> {
    let (setup, choice) = cli::choose::load(config, &scene, true)?;
    let row = setup.system.process(messages::Process::Lowlevel);
    let (core, priority) = row.map_or((0, 0), |row| (row.core.unwrap_or(0), row.priority));
    let cyclictest = || {
        let found = (seconds > 0).then(|| studies::cycles::cyclictest(core, priority, seconds))?;
        found.inspect_err(|error| tracing::warn!("{error}")).ok()
    };
    std::fs::create_dir_all(out)
        .map_err(|e| format!("{}: {e}; choose another place with --out", out.display()))?;
    let log = out.join(format!("{scene}.mcap"));
    let before = cyclictest();
    let (mode, dir, config) = (Mode::RealTime, cli::RUN_DIR.into(), config.to_path_buf());
    let method = choice.map(|choice| choice.method);
    cli::run::run(&Order { mode, scene, method, config, dir, log: Some(log.clone()), progress: false })?;
    let after = cyclictest();
    let fell = cli::run::figures_of(&log, &setup)?.fell;
    Ok(studies::cycles::Report {
        cyclictest_us: [before, after],
        fell,
        processes: studies::cycles::of_log(&log)?,
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

fn fit_friction(file: &std::path::Path, out: Option<PathBuf>, json: bool) -> Result<(), Box<dyn Error>> {
    let report = cli::fit_friction::run(file)?;
    println!("{}", if json { report.json() } else { report.table() });
    let beside = || file.file_stem().map(|stem| PathBuf::from(stem).with_extension("png"));
    if let Some(out) = out.or_else(|| if json { None } else { beside() }) {
        report.draw(&out)?;
        if !json {
            println!("{}", out.display());
        }
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
