//! `gangwerk dashboard --replay LOG`: the log, and the configuration that its pictures are made with.

use std::error::Error;
use std::path::Path;

use config::Setup;
use dashboard::description::RobotFiles;
use dashboard::replay::Recorded;
use recording::IndexedLog;

use crate::replay::Unpacked;

/// A log with its configuration: from the files in it, else that of `scene` in the directory `asked` of `--config`.
///
/// # Errors
/// The file is no log; it has no configuration in it, and no scene stands in for it.
pub fn recorded(path: &Path, scene: Option<&str>, asked: Option<&Path>) -> Result<Recorded, Box<dyn Error>> {
    let log = IndexedLog::open(path)?;
    let about = log.about();
    let unpacked = Unpacked::of(about)?;
    let (shown, mut missing) = (path.display(), Vec::new());
    let hint = "--scene SCENE names one that stands in for it, for example --scene demo";
    let (setup, folder) = match scene {
        None if unpacked.is_empty() => {
            return Err(format!("{shown}: no configuration in it; {hint}").into());
        }
        None => {
            let setup = unpacked.setup(about);
            let told =
                |e| format!("{shown}: its configuration is cut off, or not of this version: {e}; {hint}");
            (setup.map_err(told)?, unpacked.path.clone())
        }
        Some(scene) => {
            let root = config::find(asked)?.dir;
            missing.push(format!("configuration: that of scene {scene} stands in for the log's"));
            (Setup::load(&root, scene)?, root)
        }
    };
    let (ours, theirs) = (setup.hash, about.run().config_hash);
    if ours != theirs {
        missing.push(format!(
            "configuration: {ours:016x} is not the run's ({theirs:016x}); what is drawn by it may differ"
        ));
    }
    let mut robot = setup.robot.clone();
    // The log's own description, whatever the configuration says by now.
    if !about.robot().urdf.is_empty() {
        robot.urdf.clone_from(&about.robot().urdf);
    }
    let files = RobotFiles::of(&robot, &folder.join("robots").join(&robot.name));
    Ok(Recorded { setup, run: unpacked.run.clone(), files, missing, log })
}
