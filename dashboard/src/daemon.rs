//! The process: `gangwerk dashboard`.
//!
//! tokio serves HTTP and sockets on one thread. Beside it are ordinary threads: the observer, the emergency stop, the look at
//! the command lease, one operator per page that commands, and the starter of runs if it may start some. Of a recording there is one thread, which reads it.

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
use crate::guests::Outbox;
use crate::observer::{Notice, Observer};
use crate::operator::{answer, watch_lease};
use crate::replay::{Player, Recorded, side_by_side};
use crate::socket::Hall;
use crate::starter::{StartOptions, Starter, StarterCall};

/// Address unless another one is asked for.
pub const ADDRESS: SocketAddr = SocketAddr::new(IpAddr::V4(Ipv4Addr::LOCALHOST), 8720);
/// File of the run directory with the address of the page.
pub const URL_FILE: &str = "dashboard.url";
/// Page of the run directory that leads there: a browser's command line, which everybody may read, names it instead of the token.
pub const LINK_FILE: &str = "dashboard.html";
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
}

/// Serves the robot of a directory until `stop`. `ready` is told the address of the page, with its token.
///
/// # Errors
/// The address is taken or not on the loopback interface, the run directory is not private, or there is no such scene to start.
pub fn serve(options: &Options, stop: &Stop, ready: impl FnOnce(&str)) -> Result<(), String> {
    options.start.as_ref().map_or(Ok(()), StartOptions::check)?;
    let house = House::open(options)?;
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
    let hall = Hall::new(Some(dir), observer, stops, starter.transpose()?);
    house.serve(hall, robot_files, watching, stop, ready)
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
    ready: impl FnOnce(&str),
) -> Result<(), String> {
    let (player, notices) = channel();
    let (stops, _) = channel();
    let films = side_by_side(log, other)?;
    let files = films.first().map(|film| film.files.clone()).unwrap_or_default();
    let (_files, robot_files) = watch::channel(files);
    let house = House::open(options)?;
    let watching = spawn("player", move || Player::new(films, notices).run())?;
    house.serve(Hall::new(None, player, stops, None), robot_files, watching, stop, ready)
}

/// Server with its address, before anybody comes.
struct House {
    runtime: Runtime,
    listener: TcpListener,
    admission: Admission,
    dir: PathBuf,
    url: String,
}

impl House {
    /// Takes the address, and leaves it in the run directory.
    fn open(options: &Options) -> Result<Self, String> {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        let runtime = runtime.map_err(|e| format!("no runtime: {e}"))?;
        let entered = runtime.enter();
        let listener = listen(options.listen)?;
        let address = listener.local_addr().map_err(|e| e.to_string())?;
        drop(entered);
        let admission = Admission::new(address)?;
        let url = admission.url();
        publish(&options.dir, &url)?;
        Ok(Self { runtime, listener, admission, dir: options.dir.clone(), url })
    }

    /// Serves the pages that come, until `stop` or the end of the thread that has something for them.
    fn serve(
        self,
        hall: Hall,
        files: watch::Receiver<RobotFiles>,
        watching: JoinHandle<()>,
        stop: &Stop,
        ready: impl FnOnce(&str),
    ) -> Result<(), String> {
        let Self { runtime, listener, admission, dir, url } = self;
        let hall = Arc::new(hall);
        let door = Arc::new(Door { admission, hall: hall.clone(), files });
        ready(&url);
        runtime.block_on(async {
            let serving = tokio::spawn(door::serve(listener, door));
            while !stop.asked() && !watching.is_finished() {
                tokio::time::sleep(LOOK).await;
            }
            // The run that was started here ends first: pages see its robot come to a stand, and can cut its supply.
            if let Some(starter) = &hall.starter {
                stop.taken();
                starter.call(StarterCall::Leave);
                while !starter.is_finished() {
                    if stop.taken() {
                        starter.call(StarterCall::Leave);
                    }
                    tokio::time::sleep(LOOK).await;
                }
            }
            serving.abort();
        });
        // Open sockets go with the runtime, and with them the operators and their leases.
        drop(runtime);
        let _ = hall.observer.send(Notice::End);
        let ended = watching.join().map_err(|_| "the observer's thread ended by an error".to_owned());
        ipc::withdraw_file(&dir, LINK_FILE, &link(&url));
        ipc::withdraw_file(&dir, URL_FILE, &line(&url));
        ended
    }
}

/// Leaves the address in the run directory, for its user only.
fn publish(dir: &Path, url: &str) -> Result<(), String> {
    let put = |name, text: &str| ipc::publish_file(dir, name, text).map_err(|e| e.to_string());
    put(URL_FILE, &line(url))?;
    put(LINK_FILE, &link(url))
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

/// Takes the address.
fn listen(asked: Option<SocketAddr>) -> Result<TcpListener, String> {
    match asked {
        Some(address) if !address.ip().is_loopback() => Err(format!(
            "--listen {address}: must be an address of the loopback interface, such as 127.0.0.1:8720; \
             from another machine: ssh -L 8720:127.0.0.1:8720"
        )),
        Some(address) => bind(address)
            .map_err(|e| format!("--listen {address}: {e}; another port, or 0 for any: 127.0.0.1:0")),
        None => bind(ADDRESS)
            .or_else(|_| bind(SocketAddr::new(ADDRESS.ip(), 0)))
            .map_err(|e| format!("no port of {} is free: {e}", ADDRESS.ip())),
    }
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
        let error = listen(Some("0.0.0.0:0".parse().unwrap())).unwrap_err();
        assert!(error.contains("loopback") && error.contains("ssh -L"), "{error}");
    }
}
