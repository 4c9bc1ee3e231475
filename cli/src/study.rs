//! `gangwerk study ...`: what can be asked, and who answers.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Subcommand;
use cli::run::Order;
use config::BusAddress;
use ipc::Mode;
use terminal::Console;

/// Which study.
#[derive(Subcommand)]
pub(super) enum Task {
    /// Which impulse the walking robot survives.
    Push {
        /// Only this scene; default: walking in place and at 1 km/h.
        #[arg(long)]
        scene: Option<String>,
        /// How many instants of a stride are tried.
        #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=1000))]
        instants: u64,
    },
    /// Which disturbances and errors a gait survives: pushes, wrong sensors, wrong ground, delay.
    Viability {
        /// Another scene than walk_1kmh.
        #[arg(long)]
        scene: Option<String>,
        /// How many instants of a stride are pushed at.
        #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u64).range(1..=100))]
        instants: u64,
        /// Two instants, and borders four times as coarse.
        #[arg(long)]
        quick: bool,
        /// Where the picture goes.
        #[arg(long, value_name = "DIR", default_value = "runs/study/viability")]
        out: PathBuf,
    },
    /// How fast a gait forgets a small disturbance: eigenvalues of its Poincaré map.
    Floquet {
        /// Only this scene; default: walking at 1 and 2 km/h.
        #[arg(long)]
        scene: Option<String>,
        /// Steps of the differences over those of the table in docs/stability.md.
        #[arg(long, default_value_t = 1.0)]
        step: f64,
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
    Limits {
        /// Where the picture of stable joint control goes.
        #[arg(long, value_name = "DIR", default_value = "runs/study/limits")]
        out: PathBuf,
    },
    /// Look-up tables of the local controllers: error over size, time, and what a walk loses by them.
    Tables {
        /// Where the picture goes.
        #[arg(long, value_name = "DIR", default_value = "runs/study/tables")]
        out: PathBuf,
    },
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
    /// Vertical moments of the soles and how far they turn, with arms that swing and with arms that do not.
    ArmSwing {
        /// Type of the model: 1, reduced; 2, with motors; 3, with elastic gears.
        #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=3))]
        depth: u8,
        /// Where the pictures go.
        #[arg(long, value_name = "DIR", default_value = "runs/study/arm_swing")]
        out: PathBuf,
    },
    /// What the field bus costs: load of its lines, time of its frames, accuracy of the walk.
    Bus,
    /// How punctual a bus cycle over CAN lines is, beside cyclictest in the same run: both ends on this machine.
    Lines {
        /// The lines, classic CAN or CAN FD.
        #[arg(long, default_value = "can:vcan0-8")]
        bus: BusAddress,
        /// Whose frames they carry.
        #[arg(long, default_value = "lola")]
        robot: String,
        /// Bus cycle, in ms.
        #[arg(long, value_name = "MS", default_value_t = 3.5)]
        cycle: f64,
        /// How long, in s; cyclictest runs as long before, and again beside it.
        #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=3600))]
        seconds: u64,
    },
    /// What the walking robot does when the bus fails: lost, late, corrupted frames, silent nodes, cables.
    BusFaults {
        /// The walk.
        #[arg(long, default_value = studies::bus_faults::SCENE)]
        scene: String,
        /// At how many instants of a stride each fault begins.
        #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u64).range(1..=100))]
        instants: u64,
    },
    /// Processes of a walking robot that are stopped for 2 to 1000 ms and go on.
    Stalls {
        /// The walk.
        #[arg(long, default_value = "walk_1kmh")]
        scene: String,
        /// Random instants for each process and duration.
        #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=1000))]
        instants: u64,
        /// Seed of the instants.
        #[arg(long, default_value_t = 1)]
        seed: u64,
    },
    /// How well the processes keep real time, beside cyclictest before and after.
    Realtime {
        /// The scene that is run.
        #[arg(long, default_value = "walk_60s")]
        scene: String,
        /// How long cyclictest runs, in s; 0: not at all.
        #[arg(long, default_value_t = 20)]
        cyclictest: u64,
        /// Where the log goes.
        #[arg(long, value_name = "DIR", default_value = "runs/realtime")]
        out: PathBuf,
    },
}

/// Carries out a study and prints what it found.
pub(super) fn run(config: &Path, what: Task, json: bool) -> Result<ExitCode, Box<dyn Error>> {
    use studies::stability::{floquet, viability};
    use studies::{arm_swing, bus_faults, cycles, figures_of_thesis, limits, push, speed, stalls};
    let (object, table) = match what {
        Task::Accuracy { only, peers, out } => {
            let report = accuracy_study(config, only.as_deref(), peers.as_deref(), &out)?;
            (serde_json::to_string(&report)?, studies::accuracy::table(&report))
        }
        Task::Push { scene, instants } => {
            let report = push::run(config, scene.as_deref(), instants as usize)?;
            (serde_json::to_string(&report)?, push::table(&report))
        }
        Task::Viability { scene, instants, quick, out } => {
            let report = viability_study(config, scene.as_deref(), instants, quick, &out)?;
            (serde_json::to_string(&report)?, viability::table(&report))
        }
        Task::Floquet { scene, step } => {
            let tell = |scene: &str| eprintln!("{scene} ...");
            let report = floquet::run(config, scene.as_deref(), step, tell)?;
            (serde_json::to_string(&report)?, floquet::table(&report))
        }
        Task::Limits { out } => {
            let report = limits::run(config)?;
            tracing::info!("{}", limits::draw(&out)?);
            (serde_json::to_string(&report)?, limits::table(&report))
        }
        Task::Bus => {
            let report = studies::bus::run(config)?;
            (serde_json::to_string(&report)?, studies::bus::table(&report))
        }
        Task::Lines { bus, robot, cycle, seconds } => {
            let report = lines_study(config, bus, robot, cycle, seconds)?;
            (serde_json::to_string(&report)?, studies::lines::table(&report))
        }
        Task::Tables { out } => {
            let report = studies::tables::run(config, |what| eprintln!("{what} ..."))?;
            tracing::info!("{}", studies::tables::draw(&report, &out)?);
            (serde_json::to_string(&report)?, studies::tables::table(&report))
        }
        Task::Speed => {
            let report = speed::run(config)?;
            (serde_json::to_string(&report)?, speed::table(&report))
        }
        Task::Thesis { figure, depth, out } => {
            let report = figures_of_thesis::run(config, figure.as_deref(), depth, &out)?;
            (serde_json::to_string(&report)?, figures_of_thesis::table(&report))
        }
        Task::ArmSwing { depth, out } => {
            let report = arm_swing::run(config, depth, &out)?;
            (serde_json::to_string(&report)?, arm_swing::table(&report))
        }
        Task::BusFaults { scene, instants } => {
            let report = bus_faults::run(config, &scene, instants as usize)?;
            (serde_json::to_string(&report)?, bus_faults::table(&report))
        }
        Task::Stalls { scene, instants, seed } => {
            let trials = stalls::run(config, &scene, &stalls::MILLIS, instants as usize, seed)?;
            (serde_json::to_string(&trials)?, stalls::table(&trials))
        }
        Task::Realtime { scene, cyclictest, out } => {
            let report = realtime_study(config, scene, cyclictest, &out)?;
            (serde_json::to_string(&report)?, cycles::table(&report))
        }
    };
    println!("{}", if json { object } else { table });
    Ok(ExitCode::SUCCESS)
}

/// How punctual a cycle over CAN lines is.
fn lines_study(
    config: &Path,
    bus: BusAddress,
    robot: String,
    cycle_ms: f64,
    seconds: u64,
) -> Result<studies::lines::Report, Box<dyn Error>> {
    let BusAddress::Can { fd, interfaces } = bus else {
        return Err(format!("--bus {bus}: must be can:INTERFACES or canfd:INTERFACES").into());
    };
    if !(0.1..=1000.0).contains(&cycle_ms) {
        return Err(format!("--cycle {cycle_ms}: must be 0.1 to 1000 ms").into());
    }
    let order = studies::lines::Order { robot, interfaces, fd, cycle: cycle_ms * 1e-3, seconds };
    studies::lines::run(config, &order)
}

/// What a gait survives, with progress on standard error.
fn viability_study(
    config: &Path,
    scene: Option<&str>,
    instants: u64,
    quick: bool,
    out: &Path,
) -> Result<studies::stability::viability::Report, Box<dyn Error>> {
    let bar = indicatif::ProgressBar::new(0);
    let tell = |done: usize, of: usize| {
        bar.set_length(of as u64);
        bar.set_position(done as u64);
    };
    let instants = if quick { 2 } else { instants as usize };
    let report = studies::stability::viability::run(config, scene, (instants, quick), out, &tell)?;
    bar.finish_and_clear();
    Ok(report)
}

/// What a log says about the stability of its walk.
pub(super) fn stability(
    config: &Path,
    log: &Path,
    out: &Path,
    friction: Option<f64>,
    json: bool,
) -> Result<ExitCode, Box<dyn Error>> {
    use studies::stability::log::{robot_of, run, table};
    let friction = match friction {
        Some(friction) if friction > 0.0 && friction.is_finite() => friction,
        Some(friction) => return Err(format!("--friction {friction}: it takes a positive number").into()),
        None => config::Robot::load(&config.join("robots").join(robot_of(log)?))?.contact.friction,
    };
    let report = run(log, friction, Some(out))?;
    println!("{}", if json { serde_json::to_string(&report)? } else { table(&report) });
    Ok(ExitCode::SUCCESS)
}

/// The charts of accuracy, with progress on standard error.
fn accuracy_study(
    config: &Path,
    only: Option<&str>,
    peers: Option<&Path>,
    out: &Path,
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
    config: &Path,
    scene: String,
    seconds: u64,
    out: &Path,
) -> Result<studies::cycles::Report, Box<dyn Error>> {
    let (setup, choice) = cli::choose::load(config, &scene, true)?;
    let row = setup.system.process(messages::Process::Lowlevel);
    let (core, priority) = row.map_or((0, 0), |row| (row.core.unwrap_or(0), row.priority));
    let cyclictest = || {
        let found = (seconds > 0).then(|| realtime::cyclictest(Some(core), priority, seconds))?;
        found.inspect_err(|error| tracing::warn!("{error}")).ok()
    };
    std::fs::create_dir_all(out)
        .map_err(|e| format!("{}: {e}; choose another place with --out", out.display()))?;
    let log = out.join(format!("{scene}.mcap"));
    let before = cyclictest();
    let (mode, dir, config) = (Mode::RealTime, ipc::default_dir(), config.to_path_buf());
    let method = choice.map(|choice| choice.method);
    let order = Order {
        bus: BusAddress::Shared,
        robot: true,
        mode,
        paced: false,
        scene,
        method,
        config,
        dir,
        log: Some(log.clone()),
        rt_required: false,
    };
    let stop = realtime::Stop::on_signals()?;
    cli::run::run(&order, stop, &Console::start(None, realtime::clock::now)?)?;
    let after = cyclictest();
    let fell = cli::run::figures_of(&log, &setup)?.fell;
    Ok(studies::cycles::Report {
        cyclictest_us: [before, after],
        fell,
        processes: studies::cycles::of_log(&log)?,
    })
}
