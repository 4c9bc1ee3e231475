//! `gangwerk robot`: files of a robot that are made from its `robot.toml`.

use std::error::Error;
use std::path::{Path, PathBuf};

use clap::Subcommand;
use config::Robot;
use config::dbc_writer::{FrameForm, WRITTEN_BY, dbc_text};

#[derive(Subcommand)]
pub(crate) enum RobotTask {
    /// Write the DBC files of a robot's bus, classic CAN and CAN FD, from the local controllers in its robot.toml.
    ///
    /// On shared memory and CAN FD a robot needs no file: without one its frames are those written here. Files that this
    /// command did not write are left alone.
    Frames {
        /// Name of the robot's directory in robots/.
        name: String,
        /// Directory for NAME.dbc and NAME_fd.dbc; without it, can/ beside robot.toml.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// Writes the files, and names each.
///
/// # Errors
/// The robot's files are wrong or name no local controllers; a file cannot be written.
pub(crate) fn run(config: &Path, what: RobotTask) -> Result<(), Box<dyn Error>> {
    let RobotTask::Frames { name, out } = what;
    let place = config.join("robots").join(&name);
    let Robot { can, .. } = Robot::load(&place)?;
    if can.nodes.is_empty() {
        let file = place.join("robot.toml");
        return Err(format!("{}: can: no [[can.node]], so there is nothing to write", file.display()).into());
    }
    let out = out.unwrap_or_else(|| place.join("can"));
    std::fs::create_dir_all(&out).map_err(|e| format!("{}: {e}", out.display()))?;
    for (form, ending) in [(FrameForm::Fd, "_fd"), (FrameForm::Classic, "")] {
        let path = out.join(format!("{name}{ending}.dbc"));
        let text = match dbc_text(&name, &can.nodes, can.motor_side, form) {
            Ok(text) => text,
            Err(why) if form == FrameForm::Classic => {
                println!("{}: not written: {why}", path.display());
                continue;
            }
            Err(why) => return Err(why.into()),
        };
        if std::fs::read_to_string(&path).is_ok_and(|there| !there.contains(WRITTEN_BY)) {
            println!("{}: left alone: `gangwerk robot frames` did not write it", path.display());
            continue;
        }
        std::fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))?;
        println!("{}", path.display());
    }
    Ok(())
}
