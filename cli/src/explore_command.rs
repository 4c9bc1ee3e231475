//! `gangwerk explore`: a vision system that walks a simulated robot about.

use std::error::Error;
use std::net::SocketAddr;
use std::path::PathBuf;

use realtime::Stop;
use realtime::clock::SECOND;
use vision::Speeds;
use vision::program::{End, Options};

pub(crate) const HELP: &str = "\
gangwerk run room --stay, then gangwerk gateway, then this, each in a terminal of its own: she walks about the room until Ctrl-C, and
stands when this, or the gateway, ends or hangs. What she sees: docs/vision.md.";

#[derive(clap::Args)]
pub(crate) struct ExploreArguments {
    /// Run directory of the simulated robot, whose world its camera sees.
    #[arg(long, value_name = "DIR", default_value_os_t = ipc::default_dir())]
    dir: PathBuf,
    /// Address to which the gateway sends triggers.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:47201")]
    listen: SocketAddr,
    /// Speed ahead (m/s), 0.05 to 0.5.
    #[arg(long, value_name = "M/S", default_value_t = 0.3, value_parser = |text: &str| within(text, [0.05, 0.5]))]
    forward: f64,
    /// Speed of turns on the spot (rad/s), 0.05 to 0.4.
    #[arg(long, value_name = "RAD/S", default_value_t = 0.25, value_parser = |text: &str| within(text, [0.05, 0.4]))]
    turn: f64,
    /// Time from a picture to what is done about it (ms), 0 to 400.
    #[arg(long, value_name = "MS", default_value_t = 200.0, value_parser = |text: &str| within(text, [0.0, 400.0]))]
    delay: f64,
    /// Time after which it stops her and ends (s); without it: Ctrl-C.
    #[arg(long, value_name = "S", value_parser = |text: &str| within(text, [0.1, 1e6]))]
    seconds: Option<f64>,
    /// Seed of the camera's errors.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

fn within(text: &str, [low, high]: [f64; 2]) -> Result<f64, String> {
    match text.parse() {
        Ok(x) if (low..=high).contains(&x) => Ok(x),
        _ => Err(format!("must be a number from {low} to {high}")),
    }
}

/// Explores until Ctrl-C.
pub(crate) fn run(arguments: ExploreArguments) -> Result<(), Box<dyn Error>> {
    let ExploreArguments { dir, listen, forward, turn, delay, seconds, seed } = arguments;
    let options = Options {
        dir,
        listen,
        speeds: Speeds { forward, turn },
        delay: (1e-3 * delay * SECOND as f64) as u64,
        time: seconds.map(|s| (s * SECOND as f64) as u64),
        seed,
    };
    let stop = Stop::on_signals()?;
    match vision::program::run(&options, &stop, |line| println!("{line}"))? {
        End::Asked => println!("she was told to stop"),
        End::Held => println!("somebody else has stopped her: she is not started again from here"),
    }
    Ok(())
}
