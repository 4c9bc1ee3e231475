//! A gamepad that walks a running robot, without a browser (thesis 7.3): `gangwerk joystick`, `docs/joystick.md`.
//!
//! | module | what |
//! |---|---|
//! | `find` | which input device is the gamepad |
//! | `source` | thread that reads it, or events that were recorded |
//! | `pad` | values of sticks and buttons, and what they mean by a layout |
//! | `pilot` | rules by which hands become commands |
//! | `start_up` | next step of the start-up |
//! | `desk` | client of the broker: commands out, answers and lease back |
//!
//! The layout is `config::joystick`, the same as the page's. An emergency stop goes from the reader to a thread of its own and
//! from there to the watchdog, whatever the others wait for.

mod desk;
pub mod find;
pub mod pad;
pub mod pilot;
pub mod source;
pub mod start_up;

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};

use config::Joystick;
use ipc::StopName;
use realtime::Stop;
use watchdog::stop_request::stop as stop_robots;

use desk::Desk;
pub use desk::Say;
pub use source::Source;

/// Options of the program.
#[derive(Clone, Debug)]
pub struct Options {
    /// Run directory.
    pub dir: PathBuf,
    /// Gamepad.
    pub source: Source,
    /// Layout.
    pub layout: Joystick,
    /// Take the lease from whoever holds it.
    pub take_over: bool,
}

/// Steers the robot of a directory, and the next one after it, until `stop`; lines for the operator go to `say`.
///
/// # Errors
/// There is no gamepad, or it cannot be opened: what to do.
pub fn run(options: &Options, stop: &Stop, say: Say) -> Result<(), String> {
    let Options { dir, source, layout, take_over } = options;
    source.check()?;
    let (stops, asked) = channel();
    let own = dir.clone();
    spawn("stop", move || answer_stops(&own, &asked, say))?;
    let (pad, news) = channel();
    let (from, by) = (source.clone(), layout.clone());
    spawn("gamepad", move || from.read(&by, &pad, &stops))?;

    let mut desk = Desk::new(dir.clone(), layout, *take_over, say);
    while !stop.asked() {
        let first = news.recv_timeout(desk.wait());
        // The time first: what was held while this program stood still does not count.
        desk.look();
        match first {
            Ok(first) => std::iter::once(first).chain(news.try_iter()).for_each(|news| desk.hear(news)),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    desk.end();
    Ok(())
}

fn spawn(name: &str, run: impl FnOnce() + Send + 'static) -> Result<(), String> {
    let spawned = std::thread::Builder::new().name(name.into()).spawn(run);
    spawned.map(drop).map_err(|e| format!("thread {name}: {e}"))
}

/// Asks for the emergency stop at every press, and says what came of it. Presses that wait share one.
fn answer_stops(dir: &Path, presses: &Receiver<()>, say: Say) {
    while presses.recv().is_ok() {
        while presses.try_recv().is_ok() {}
        for stopped in stop_robots(&[StopName::own(dir)]) {
            say(&format!("emergency stop: {}", stopped.outcome));
        }
    }
}
