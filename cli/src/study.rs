//! `gangwerk study ...`: what can be asked, and who answers.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Subcommand;
use cli::choose::OtherMethod;
use cli::run::RunOptions;
use config::BusAddress;
use indicatif::{ProgressBar, ProgressStyle};
use ipc::Mode;
use studies::{Given, Sheet, Study};
use terminal::Console;

/// Which study.
#[derive(Subcommand)]
pub(super) enum StudyTask {
    #[command(flatten)]
    Simulated(studies::SimulatedStudy),
    /// How well the processes keep real time, beside cyclictest before and after.
    Realtime(Realtime),
}

/// What is tuned.
#[derive(Subcommand)]
pub(super) enum TuneTask {
    /// Gains of its cascade: the procedure of the thesis (6.1.2) step by step, and a placement by model.
    Joint(studies::tune::TuneJoint),
    /// Numbers of a gait within bounds, for the least cost of a simulated walk (thesis 5.6).
    Gait(studies::tune::TuneGait),
}

/// In which form a sheet is printed.
#[derive(clap::Args)]
pub(super) struct SheetForm {
    /// One JSON object instead of a table.
    #[arg(long, global = true)]
    json: bool,
    /// Tables in Markdown, as the pages in docs hold them.
    #[arg(long, global = true, conflicts_with = "json")]
    markdown: bool,
}

/// A scene that is run with all processes.
#[derive(clap::Args)]
pub(super) struct Realtime {
    /// The scene that is run.
    #[arg(long, default_value = "walk_60s")]
    scene: String,
    /// Duration of cyclictest, in s; 0: it does not run.
    #[arg(long, default_value_t = 20)]
    cyclictest: u64,
    /// Directory of the log.
    #[arg(long, value_name = "DIR", default_value = "runs/realtime")]
    out: PathBuf,
}

/// Carries out a study, with progress on standard error, and prints what it found.
pub(super) fn run(config: &Path, what: &StudyTask, form: &SheetForm) -> Result<ExitCode, Box<dyn Error>> {
    match what {
        StudyTask::Simulated(study) => answer(config, study, form),
        StudyTask::Realtime(study) => answer(config, study, form),
    }
}

/// Carries out a tuning in the same way.
pub(super) fn tune(config: &Path, what: &TuneTask, form: &SheetForm) -> Result<ExitCode, Box<dyn Error>> {
    match what {
        TuneTask::Joint(joint) => answer(config, joint, form),
        TuneTask::Gait(gait) => answer(config, gait, form),
    }
}

fn answer(config: &Path, study: &dyn Study, form: &SheetForm) -> Result<ExitCode, Box<dyn Error>> {
    let bar = ProgressBar::new(0).with_style(ProgressStyle::with_template("{wide_bar} {pos}/{len} {msg}")?);
    let progress = |done: usize, of: usize, next: &str| {
        if of == 0 {
            return eprintln!("{next} ...");
        }
        bar.set_length(of as u64);
        bar.set_position(done as u64);
        bar.set_message(next.to_string());
    };
    let sheet = study.run(&Given { config, progress: &progress });
    bar.finish_and_clear();
    print(&sheet?, form);
    Ok(ExitCode::SUCCESS)
}

pub(super) fn print(sheet: &Sheet, form: &SheetForm) {
    let text = match form {
        SheetForm { json: true, .. } => sheet.json().to_string(),
        SheetForm { markdown: true, .. } => sheet.markdown(),
        SheetForm { .. } => sheet.text(),
    };
    println!("{text}");
}

/// What a log says about the stability of its walk.
pub(super) fn stability(
    config: &Path,
    log: &Path,
    out: &Path,
    friction: Option<f64>,
    form: &SheetForm,
) -> Result<ExitCode, Box<dyn Error>> {
    use studies::stability::log::{robot_of, run};
    let friction = match friction {
        Some(friction) if friction > 0.0 && friction.is_finite() => friction,
        Some(friction) => return Err(format!("--friction {friction}: it takes a positive number").into()),
        None => config::Robot::load(&config.join("robots").join(robot_of(log)?))?.contact.friction,
    };
    print(&run(log, friction, Some(out))?, form);
    Ok(ExitCode::SUCCESS)
}

impl Study for Realtime {
    /// cyclictest, the scene with all processes, cyclictest again: on the core and with the priority of the joint loop.
    fn run(&self, given: &Given<'_>) -> Result<Sheet, Box<dyn Error>> {
        let (setup, choice) = cli::choose::load(given.config, &self.scene, true)?;
        // What the machine does without a robot, on the joint loop's terms.
        let row = setup.system.process(messages::Process::Lowlevel);
        let (core, priority) = row.map_or((0, 0), |row| (row.core.unwrap_or(0), row.priority));
        let seconds = self.cyclictest;
        let cyclictest = || {
            let found = (seconds > 0).then(|| realtime::cyclictest(Some(core), priority, seconds))?;
            found.inspect_err(|error| tracing::warn!("{error}")).ok()
        };
        studies::sheet::make(&self.out)?;
        let log = self.out.join(format!("{}.mcap", config::scenes::name(&self.scene)));
        // The machine may change meanwhile, so it is measured before and after.
        let before = cyclictest();
        let order = RunOptions {
            bus: BusAddress::Shared,
            robot: true,
            mode: Mode::RealTime,
            paced: false,
            stays: false,
            scene: self.scene.clone(),
            method: choice.map(OtherMethod::from),
            config: given.config.to_path_buf(),
            dir: ipc::default_dir(),
            log: Some(log.clone()),
            rt_required: false,
        };
        let stop = realtime::Stop::on_signals()?;
        cli::run::run(&order, stop, &Console::start(None, realtime::clock::now)?)?;
        let after = cyclictest();
        let fell = cli::run::figures_of(&log, &setup)?.fell;
        studies::cycles::sheet(&log, [before, after], fell)
    }
}
