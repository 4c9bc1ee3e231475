//! Sources of frames: a file, or interfaces of this machine.

use std::error::Error;
use std::path::Path;
use std::time::Duration;

use config::interface_names;
use fieldbus::capture::Captured;
use fieldbus::tap::Tap;
use realtime::{Stop, clock};

/// Between two looks whether to end.
const LOOK: Duration = Duration::from_millis(50);
/// Frames that are still taken at the end.
const MOST_LEFT: usize = 10_000;

/// Whether the text means a file rather than interfaces.
pub(super) fn is_file(text: &str) -> bool {
    text.contains('/') || text.ends_with(".log") || text.ends_with(".mcap") || Path::new(text).is_file()
}

/// Listens until Ctrl-C, or for some seconds; shows every frame as it comes.
pub(super) fn listen(
    names: &[String],
    seconds: Option<f64>,
    mut see: impl FnMut(Option<&Captured>) -> Result<(), Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    let stop = Stop::on_signals()?;
    let tap = Tap::open(names)?;
    eprintln!("listening on {}; Ctrl-C ends it", names.join(", "));
    let end = seconds.map(|s| clock::now() + (s * 1e9) as u64);
    while !stop.asked() && end.is_none_or(|end| clock::now() < end) {
        let left = end.map_or(LOOK, |end| LOOK.min(Duration::from_nanos(end.saturating_sub(clock::now()))));
        see(tap.next(left)?.as_ref())?;
    }
    // What was heard until now; a line that goes on speaking does not keep us.
    for _ in 0..MOST_LEFT {
        match tap.next(Duration::ZERO)? {
            Some(frame) => see(Some(&frame))?,
            None => break,
        }
    }
    Ok(())
}

/// The interfaces of a list.
pub(super) fn names(list: &str) -> Result<Vec<String>, Box<dyn Error>> {
    Ok(interface_names(list)?)
}

/// A duration as somebody typed it.
pub(super) fn seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| format!("`{text}` is not a number of seconds"))?;
    let sensible = seconds > 0.0 && seconds <= 1e9;
    sensible.then_some(seconds).ok_or_else(|| format!("{seconds} s: above 0, at most 1e9"))
}
