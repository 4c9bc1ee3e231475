//! `gangwerk sim`: its arguments, and what is printed of it.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Arguments of `gangwerk sim`.
#[derive(clap::Args)]
pub(crate) struct SimArguments {
    /// Name of a scene, see `gangwerk scene list`, or path of a scene file.
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
    /// Unix socket of another simulator (external plant), which has the robot instead of ours: docs/external_plant.md.
    #[arg(long, value_name = "SOCKET")]
    pub(crate) plant: Option<PathBuf>,
}

/// A scene in one process, its figures and its exit code.
pub(crate) fn run(config: &Path, arguments: &SimArguments) -> Result<ExitCode, Box<dyn Error>> {
    let SimArguments { scene, json, log, can, classic, plant } = arguments;
    let (setup, choice) = cli::choose::load(config, scene, !json)?;
    let setup = setup.on_bus(*classic)?;
    let bar = if *json {
        indicatif::ProgressBar::hidden()
    } else {
        indicatif::ProgressBar::new(setup.scene.duration as u64)
    };
    let (plant, log, can) = (plant.as_deref(), log.as_deref(), can.as_deref());
    let (mut figures, exit) = cli::sim::run(&setup, plant, log, can, |t| bar.set_position(t as u64))?;
    figures.depth_reason = choice.map(|choice| choice.reason());
    bar.finish_and_clear();
    if *json {
        println!("{}", serde_json::to_string(&figures)?);
    } else {
        println!("{}", chain::figures::table(&figures));
    }
    Ok(exit.into())
}
