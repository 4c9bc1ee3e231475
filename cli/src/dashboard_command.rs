//! `gangwerk dashboard`: the page of the operator's desk.

use std::error::Error;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use dashboard::daemon::LINK_FILE;
use dashboard::starter::StartOptions;
use dashboard::{Addresses, Options};
use realtime::Stop;

#[derive(clap::Args)]
pub(crate) struct DashboardArguments {
    /// Run directory of the robot; it need not run yet. Default: the one of `gangwerk run`.
    #[arg(long, value_name = "DIR")]
    dir: Option<PathBuf>,
    /// Show this log in place of a running robot: docs/replay.md.
    #[arg(long, value_name = "LOG")]
    replay: Option<PathBuf>,
    /// Show another log of the same robot beside it.
    #[arg(long, value_name = "LOG", requires = "replay")]
    against: Option<PathBuf>,
    /// Scene, by name or path, that stands in for a configuration that is not in the log.
    #[arg(long, value_name = "SCENE", requires = "replay")]
    scene: Option<String>,
    /// Let the page start and end runs of scenes with a simulated robot; with a SCENE: start it at once.
    #[arg(long, value_name = "SCENE", num_args = 0..=1, conflicts_with = "replay")]
    start: Option<Option<String>>,
    /// Address on the loopback interface; default: 127.0.0.1:8720, or any free port if that is taken.
    #[arg(long, value_name = "ADDRESS")]
    listen: Option<SocketAddr>,
    /// Serve Foxglove and Lichtblick, too, at this address on the loopback interface; without one: 127.0.0.1:8765, or any free port
    /// if that is taken: docs/foxglove.md.
    #[arg(long, value_name = "ADDRESS", conflicts_with = "replay")]
    foxglove: Option<Option<SocketAddr>>,
    /// Print the address only, and open no browser.
    #[arg(long)]
    no_open: bool,
    /// End with the process that started it.
    #[arg(long, hide = true)]
    with_parent: bool,
}

/// Serves the page until Ctrl-C.
pub(crate) fn run(arguments: DashboardArguments, config: Option<&Path>) -> Result<(), Box<dyn Error>> {
    let DashboardArguments { dir, replay, against, scene, start, listen, foxglove, no_open, with_parent } =
        arguments;
    let stop = Stop::on_signals()?;
    if with_parent {
        Stop::with_parent()?;
    }
    let dir = dir.unwrap_or_else(|| if replay.is_some() { replay_dir() } else { ipc::default_dir() });
    let start = match start {
        None => None,
        Some(first) => {
            Some(StartOptions { command: std::env::current_exe()?, config: config::find(config)?.dir, first })
        }
    };
    let options = Options { dir: dir.clone(), listen, start, foxglove };
    let ready = |addresses: &Addresses| {
        println!("{}", addresses.page);
        if let Some(url) = &addresses.foxglove {
            println!("Foxglove, Lichtblick: {url}");
        }
        if !no_open {
            open(&dir.join(LINK_FILE));
        }
    };
    match replay {
        None => dashboard::serve(&options, &stop, ready)?,
        Some(log) => {
            let film = |path: PathBuf| cli::film::recorded(&path, scene.as_deref(), config);
            let (log, other) = (film(log)?, against.map(film).transpose()?);
            dashboard::serve_recording(&options, log, other, &stop, ready)?;
        }
    }
    Ok(())
}

/// Directory for the address of a replay: not a robot's.
fn replay_dir() -> PathBuf {
    let mut dir = ipc::default_dir().into_os_string();
    dir.push("-replay");
    dir.into()
}

/// Shows the page in the desktop's browser, if there is a desktop. The address that was printed is for everybody else.
fn open(link: &Path) {
    let desktop = ["DISPLAY", "WAYLAND_DISPLAY"].iter().any(|name| std::env::var_os(name).is_some());
    if desktop {
        let mut command = Command::new("xdg-open");
        command.arg(link).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        if let Err(e) = command.spawn() {
            eprintln!("no browser was opened (xdg-open: {e}); open the address above");
        }
    }
}
