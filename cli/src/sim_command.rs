//! `gangwerk sim`: what is printed of it.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

/// A scene in one process, its figures and its exit code.
pub(crate) fn run(
    config: &Path,
    scene: &str,
    json: bool,
    log: Option<&Path>,
    can: Option<&Path>,
    classic: bool,
    plant: Option<&Path>,
) -> Result<ExitCode, Box<dyn Error>> {
    let (setup, choice) = cli::choose::load(config, scene, !json)?;
    let setup = setup.on_bus(classic)?;
    let bar = if json {
        indicatif::ProgressBar::hidden()
    } else {
        indicatif::ProgressBar::new(setup.scene.duration as u64)
    };
    let (mut figures, exit) = cli::sim::run(&setup, plant, log, can, |t| bar.set_position(t as u64))?;
    figures.depth_reason = choice.map(|choice| choice.reason());
    bar.finish_and_clear();
    if json {
        println!("{}", serde_json::to_string(&figures)?);
    } else {
        println!("{}", chain::figures::table(&figures));
    }
    Ok(exit.into())
}
