//! The process: `gangwerk dashboard`.
//!
//! tokio serves HTTP and sockets on one thread. Beside it are ordinary threads: the observer, the emergency stop, the look at
//! the command lease, one operator per page that commands, the starter of runs if it may start some, and the watcher for Foxglove if
//! it is asked for. Of a recording there is one thread, which reads it.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use ipc::StopName;
use realtime::Stop;
use tokio::net::{TcpListener, TcpSocket};
use tokio::runtime::Runtime;
use tokio::sync::watch;
use watchdog::stop_request::{StopOutcome, stop};

use crate::admission::Admission;
use crate::description::RobotFiles;
use crate::door::{self, Door};
use crate::foxglove::{self, Lobby, ViewerDoor, ViewerNotice, Watcher};
use crate::observer::{Notice, Observer};
use crate::operator::{answer, watch_lease};
use crate::replay::{Player, Recorded, side_by_side};
use crate::socket::Sockets;
use crate::starter::{StartOptions, Starter, StarterCall};
use crate::subscribers::Outbox;

/// Address unless another one is asked for.
pub const ADDRESS: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 8720);
/// File of the run directory with the address of the page.
pub const URL_FILE: &str = "dashboard.url";
/// Page of the run directory that leads there: a browser's command line, which everybody may read, names it instead of the token.
pub const LINK_FILE: &str = "dashboard.html";
/// Address of the door for Foxglove unless another one is asked for: the port that Foxglove proposes.
pub const FOXGLOVE_ADDRESS: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 8765);
/// File of the run directory with the address for Foxglove.
pub const FOXGLOVE_FILE: &str = "foxglove.url";
/// Bytes of the kernel's that wait for one page: who does not read is noticed soon.
const SEND_BUFFER: u32 = 64 << 10;
/// Connections that wait to be taken.
const WAITING: u32 = 128;
/// Between two looks whether to end.
const LOOK: Duration = Duration::from_millis(50);

/// Options of the server.
#[derive(Clone, Debug)]
pub struct Options {
    /// Run directory.
    pub dir: PathBuf,
    /// Address; none: [`ADDRESS`], or another port if that one is taken.
    pub listen: Option<SocketAddr>,
    /// Start of runs from the page; none: it can start nothing.
    pub start: Option<StartOptions>,
    /// Door for Foxglove, which a recording has not.
    pub foxglove: Option<FoxgloveAddress>,
}

/// Address of the door for Foxglove; none: [`FOXGLOVE_ADDRESS`], or another port if that one is taken.
pub type FoxgloveAddress = Option<SocketAddr>;

/// Addresses of a server, with their token.
#[derive(Clone, Debug)]
pub struct Addresses {
    /// Of the page.
    pub page: String,
    /// For Foxglove.
    pub foxglove: Option<String>,
}

/// Serves the robot of a directory until `stop`. `ready` is told the addresses.
///
/// # Errors
/// The address is taken or not on the loopback interface, the run directory is not private, or there is no such scene to start.
pub fn serve(options: &Options, stop: &Stop, ready: impl FnOnce(&Addresses)) -> Result<(), String> {
    options.start.as_ref().map_or(Ok(()), StartOptions::check)?;
    let server = Server::open(options)?;
    // Threads that wait, each for its own.
    let (observer, notices) = channel();
    let (stops, requests) = channel();
    let (files, robot_files) = watch::channel(RobotFiles::default());
    let dir = options.dir.clone();
    let own = dir.clone();
    let watching = spawn("observer", move || Observer::new(own, notices, files).run())?;
    let (way, own) = (observer.clone(), dir.clone());
    spawn("lease", move || watch_lease(&own, &way))?;
    let own = dir.clone();
    spawn("stop", move || answer_stops(&own, &requests))?;
    let starter = options.start.as_ref().map(|start| Starter::open(&dir, start, observer.clone()));
    let sockets = Sockets::new(Some(dir), observer, stops, starter.transpose()?);
    server.serve(sockets, robot_files, watching, stop, ready)
}

/// Serves a log, and perhaps another one beside it, until `stop`: no robot, no broker, no emergency stop.
///
/// # Errors
/// As [`serve`]; or a log cannot be shown.
pub fn serve_recording(
    options: &Options,
    log: Recorded,
    other: Option<Recorded>,
    stop: &Stop,
    ready: impl FnOnce(&Addresses),
) -> Result<(), String> {
    let (player, notices) = channel();
    let (stops, _) = channel();
    let films = side_by_side(log, other)?;
    let files = films.first().map(|film| film.files.clone()).unwrap_or_default();
    let (_files, robot_files) = watch::channel(files);
    let server = Server::open(options)?;
    let watching = spawn("player", move || Player::new(films, notices).run())?;
    server.serve(Sockets::new(None, player, stops, None), robot_files, watching, stop, ready)
}

/// Server with its addresses, before anybody comes.
struct Server {
    runtime: Runtime,
    listener: TcpListener,
    admission: Admission,
    /// Door for Foxglove.
    second: Option<(TcpListener, Admission)>,
    dir: PathBuf,
    addresses: Addresses,
}

impl Server {
    /// Takes the addresses, and leaves them in the run directory.
    fn open(options: &Options) -> Result<Self, String> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        let runtime = runtime.map_err(|e| format!("no runtime: {e}"))?;
        let entered = runtime.enter();
        let (listener, address) = listen("--listen", options.listen, ADDRESS)?;
        let admission = Admission::new(address)?;
        let second = options.foxglove.map(|asked| {
            let (listener, address) = listen("--foxglove", asked, FOXGLOVE_ADDRESS)?;
            Ok::<_, String>((listener, admission.at(address)))
        });
        let second = second.transpose()?;
        drop(entered);
        let foxglove = second.as_ref().map(|(_, admission)| admission.viewer_url());
        let addresses = Addresses { page: admission.url(), foxglove };
        publish(&options.dir, &addresses)?;
        Ok(Self { runtime, listener, admission, second, dir: options.dir.clone(), addresses })
    }

    /// Serves the pages that come, until `stop` or the end of the thread that has something for them.
    fn serve(
        self,
        sockets: Sockets,
        files: watch::Receiver<RobotFiles>,
        watching: JoinHandle<()>,
        stop: &Stop,
        ready: impl FnOnce(&Addresses),
    ) -> Result<(), String> {
        let Self { runtime, listener, admission, second, dir, addresses } = self;
        let sockets = Arc::new(sockets);
        // Doors, and the threads behind them.
        let (watcher, notices) = channel();
        let mut threads = vec![watching];
        let mut doors = vec![(listener, door::router(Door { admission, sockets: sockets.clone(), files }))];
        if let Some((listener, admission)) = second {
            let own = dir.clone();
            threads.push(spawn("foxglove", move || Watcher::new(own, notices).run())?);
            let lobby = Lobby::new(sockets.clone(), watcher.clone());
            doors.push((listener, foxglove::door::router(ViewerDoor { admission, lobby })));
        }
        ready(&addresses);
        let beats = sockets.beats.clone();
        runtime.block_on(async {
            tokio::spawn(async move { beats.keep().await });
            for (listener, router) in doors {
                tokio::spawn(door::serve(listener, router));
            }
            while !stop.asked() && !threads.iter().any(JoinHandle::is_finished) {
                tokio::time::sleep(LOOK).await;
            }
            // The run that was started here ends first: pages see its robot come to a stand, and can cut its supply.
            if let Some(starter) = &sockets.starter {
                stop.taken();
                starter.call(StarterCall::Leave);
                while !starter.is_finished() {
                    if stop.taken() {
                        starter.call(StarterCall::Leave);
                    }
                    tokio::time::sleep(LOOK).await;
                }
            }
        });
        // Doors and open sockets go with the runtime, and with them the operators and their leases.
        drop(runtime);
        let _ = (sockets.observer.send(Notice::End), watcher.send(ViewerNotice::End));
        let ended: Vec<_> = threads.into_iter().map(JoinHandle::join).collect();
        withdraw(&dir, &addresses);
        let failed = ended.iter().any(Result::is_err);
        if failed { Err("a thread that reads topics ended by an error".into()) } else { Ok(()) }
    }
}

/// Leaves the addresses in the run directory, for its user only.
fn publish(dir: &Path, addresses: &Addresses) -> Result<(), String> {
    let mut files = files(addresses);
    files.try_for_each(|(name, text)| ipc::publish_file(dir, name, &text).map_err(|e| e.to_string()))
}

fn withdraw(dir: &Path, addresses: &Addresses) {
    files(addresses).for_each(|(name, text)| ipc::withdraw_file(dir, name, &text));
}

/// Files of the run directory that tell the addresses, and their texts; the one of the page comes last: where it is, all are.
fn files(addresses: &Addresses) -> impl Iterator<Item = (&'static str, String)> {
    let Addresses { page, foxglove } = addresses;
    let second = foxglove.as_ref().map(|url| (FOXGLOVE_FILE, line(url)));
    second.into_iter().chain([(LINK_FILE, link(page)), (URL_FILE, line(page))])
}

fn line(url: &str) -> String {
    format!("{url}\n")
}

fn link(url: &str) -> String {
    format!(
        "<!doctype html><meta http-equiv=\"refresh\" content=\"0; url={url}\"><a href=\"{url}\">Gangwerk</a>\n"
    )
}

fn spawn(name: &str, run: impl FnOnce() + Send + 'static) -> Result<JoinHandle<()>, String> {
    std::thread::Builder::new().name(name.into()).spawn(run).map_err(|e| format!("thread {name}: {e}"))
}

/// Takes the address that an option asks for, or the usual one, or another port of it; and what it is.
fn listen(
    option: &str,
    asked: Option<SocketAddr>,
    usual: SocketAddr,
) -> Result<(TcpListener, SocketAddr), String> {
    let listener = match asked {
        Some(address) if !address.ip().is_loopback() => Err(format!(
            "{option} {address}: must be an address of the loopback interface, such as {usual}; \
             from another machine: ssh -L {port}:{usual}",
            port = usual.port()
        )),
        Some(address) => bind(address)
            .map_err(|e| format!("{option} {address}: {e}; another port, or 0 for any: 127.0.0.1:0")),
        None => bind(usual)
            .or_else(|_| bind(SocketAddr::new(usual.ip(), 0)))
            .map_err(|e| format!("no port of {} is free: {e}", usual.ip())),
    }?;
    let address = listener.local_addr().map_err(|e| e.to_string())?;
    Ok((listener, address))
}

fn bind(address: SocketAddr) -> std::io::Result<TcpListener> {
    let socket = if address.is_ipv4() { TcpSocket::new_v4()? } else { TcpSocket::new_v6()? };
    socket.set_reuseaddr(true)?;
    socket.set_send_buffer_size(SEND_BUFFER)?;
    socket.bind(address)?;
    socket.listen(WAITING)
}

/// Asks for the emergency stop for every request, and answers when the supply is off. Requests that wait share one.
fn answer_stops(dir: &Path, requests: &Receiver<(u64, Outbox)>) {
    while let Ok(first) = requests.recv() {
        let asked: Vec<(u64, Outbox)> = std::iter::once(first).chain(requests.try_iter()).collect();
        let outcome = stop(&[StopName::own(dir)]).into_iter().next().map(|stopped| stopped.outcome);
        let result = match outcome {
            Some(off @ StopOutcome::Off { .. }) => Ok(off.to_string()),
            Some(failed @ StopOutcome::Failed(_)) => Err(failed.to_string()),
            None => Err("NOT KNOWN TO BE OFF: nobody was asked".into()),
        };
        asked.iter().for_each(|(id, outbox)| answer(outbox, *id, &result));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_beyond_the_loopback_interface_is_refused() {
        for (option, usual) in [("--listen", ADDRESS), ("--foxglove", FOXGLOVE_ADDRESS)] {
            let error = listen(option, Some("0.0.0.0:0".parse().unwrap()), usual).unwrap_err();
            let told = [option, "loopback", &format!("ssh -L {}", usual.port())];
            assert!(told.iter().all(|part| error.contains(part)), "{error}");
        }
    }
}
