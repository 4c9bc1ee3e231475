//! `gangwerk gateway`: the vision interface of a running robot.

use std::error::Error;
use std::net::SocketAddr;
use std::path::PathBuf;

use gateway::Options;
use realtime::Stop;

pub(crate) const HELP: &str = "\
She walks while velocities come in: after half a second without a valid one she comes to a stand, as with the gateway killed or hung.
From an address of this machine its own user and root are heard; from another computer who sends from the host of --to is believed: give that a network of its own.
The datagrams: docs/vision.md.";

#[derive(clap::Args)]
pub(crate) struct GatewayArguments {
    /// Run directory of the robot; it need not run yet.
    #[arg(long, value_name = "DIR", default_value_os_t = ipc::default_dir())]
    dir: PathBuf,
    /// Address for datagrams of the vision system.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:47200")]
    listen: SocketAddr,
    /// Address of the vision system, to which triggers go; datagrams from other hosts are refused.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:47201")]
    to: SocketAddr,
    /// Triggers per second, 1 to 50.
    #[arg(long, value_name = "HZ", default_value_t = 10.0, value_parser = rate)]
    rate: f64,
}

fn rate(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(hz) if (1.0..=50.0).contains(&hz) => Ok(hz),
        _ => Err("must be a number from 1 to 50".into()),
    }
}

/// Serves until Ctrl-C.
pub(crate) fn run(arguments: GatewayArguments) -> Result<(), Box<dyn Error>> {
    let GatewayArguments { dir, listen, to, rate } = arguments;
    let stop = Stop::on_signals()?;
    Ok(gateway::run(&Options { dir, listen, to, rate }, &stop, |line| println!("{line}"))?)
}
