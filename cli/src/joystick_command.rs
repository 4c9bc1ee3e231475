//! `gangwerk joystick`: a gamepad that walks a running robot, without a browser.

use std::error::Error;
use std::path::{Path, PathBuf};

use config::Joystick;
use joystick::{Options, Source};
use realtime::Stop;

pub(crate) const HELP: &str = "\
She moves only while the dead-man button is held (left shoulder button, L1): left stick forward and sideways, right stick turns. Released,
unplugged, killed or hung, she comes to a stand. B or circle is the emergency stop, always. The layout is joystick.toml of the
configuration: docs/joystick.md.";

#[derive(clap::Args)]
pub(crate) struct JoystickArguments {
    /// Run directory of the robot; it need not run yet.
    #[arg(long, value_name = "DIR", default_value_os_t = ipc::default_dir())]
    dir: PathBuf,
    /// Gamepad, such as /dev/input/event5; default: the only one that is plugged in.
    #[arg(long, value_name = "DEVICE")]
    device: Option<PathBuf>,
    /// Layout of sticks and buttons; default: joystick.toml of the configuration.
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Take the command lease from whoever holds it.
    #[arg(long)]
    take_over: bool,
    /// Raw input events of a file or pipe instead of a device.
    #[arg(long, value_name = "FILE", hide = true, conflicts_with = "device")]
    events: Option<PathBuf>,
}

/// Steers until Ctrl-C.
pub(crate) fn run(arguments: JoystickArguments, config: &Path) -> Result<(), Box<dyn Error>> {
    let JoystickArguments { dir, device, map, take_over, events } = arguments;
    let stop = Stop::on_signals()?;
    let layout = map.map_or_else(|| Joystick::of_config(config), |file| Joystick::load(&file))?;
    let source = match (device, events) {
        (Some(device), _) => Source::Device(device),
        (None, Some(events)) => Source::Recorded(events),
        (None, None) => Source::Search,
    };
    Ok(joystick::run(&Options { dir, source, layout, take_over }, &stop, |line| println!("{line}"))?)
}
