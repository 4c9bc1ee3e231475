//! `gangwerk config`, `gangwerk scene`: where the configuration is, a copy to change, and its scenes.

use std::error::Error;
use std::path::{Path, PathBuf};

use clap::Subcommand;
use config::{BUILT_IN, ConfigDirectory};

#[derive(Subcommand)]
pub(crate) enum ConfigTask {
    /// The configuration that commands started here take, and why this one.
    Where,
    /// Write the configuration that is inside the executable to a directory, to be changed.
    Copy {
        /// The directory; it must not exist. ~/.config/gangwerk is found by itself.
        dir: PathBuf,
    },
}

#[derive(Subcommand)]
pub(crate) enum SceneTask {
    /// All scenes: length, robot, type of the model, and what they show.
    List,
}

/// Location of the configuration, or a copy of it.
///
/// # Errors
/// None is found where one is named; the copy cannot be written.
pub(crate) fn run(asked: Option<&Path>, what: ConfigTask) -> Result<(), Box<dyn Error>> {
    match what {
        ConfigTask::Where => {
            let ConfigDirectory { dir, why } = config::find(asked)?;
            println!(
                "{}: {why}",
                std::path::absolute(&dir).ok().filter(|_| !is_built_in(&dir)).unwrap_or(dir).display()
            );
        }
        ConfigTask::Copy { dir } => {
            if dir.exists() {
                return Err(format!(
                    "{}: exists, and nothing in it is overwritten; choose another place",
                    dir.display()
                )
                .into());
            }
            config::snapshot(Path::new(BUILT_IN), &dir)?;
            println!("{}: take it with `--config {0}`, or GANGWERK_CONFIG={0}", dir.display());
        }
    }
    Ok(())
}

fn is_built_in(dir: &Path) -> bool {
    dir == Path::new(BUILT_IN)
}

/// The scenes of a configuration.
///
/// # Errors
/// It has none.
pub(crate) fn scenes(config: &Path) -> Result<(), Box<dyn Error>> {
    let all = config::scenes::list(config)?;
    let width = all.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, scene) in all {
        match scene {
            Ok(scene) => {
                let depth = if scene.auto.is_some() { "auto".into() } else { scene.model() };
                println!(
                    "{name:width$}  {:5.0} s  {:8} {depth:6}  {}",
                    scene.duration, scene.robot, scene.about
                );
            }
            Err(error) => println!("{name:width$}  {error}"),
        }
    }
    println!("\ngangwerk sim NAME, or gangwerk run NAME; also with the path of a file of your own");
    Ok(())
}
