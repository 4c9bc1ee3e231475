//! The crash record: what a process left in its black box, saved as a log of its own by who survives.
//!
//! `crash-PROCESS-TIME.mcap` holds the records of the last two seconds that the process read and wrote, and a text: how it
//! ended, in which cycle, what it said, and where it was. `gangwerk log show` prints that text.

use std::fmt::Write as _;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::Duration;

use config::Setup;
use ipc::Run;
use logger::Origin;
use messages::topics::{ForType, with_type};
use messages::{Process, Record, TOPICS, Topic};
use realtime::black_box::{BlackBoxEntry, Left};
use realtime::{clock, last_words};
use recording::{Recorder, RecordingError};
use terminal::Console;

use super::Cause;

/// The attachment with the text.
pub const TEXT: &str = "crash";

/// Between two looks at what is being written.
const LOOK: Duration = Duration::from_millis(2);

/// Directory of crash records.
pub(super) struct Crashes {
    setup: Setup,
    origin: Origin,
    place: PathBuf,
    console: Console,
    writing: Vec<JoinHandle<()>>,
}

impl Crashes {
    /// Beside the log; a run without a log leaves them among the temporary files.
    pub(super) fn new(setup: &Setup, run: &Run, console: &Console) -> Self {
        let log = run.log.as_deref();
        let beside = log.and_then(Path::parent).filter(|dir| !dir.as_os_str().is_empty());
        let place = match (beside, log) {
            (Some(dir), _) => dir.into(),
            (None, Some(_)) => PathBuf::from("."),
            (None, None) => std::env::temp_dir(),
        };
        Self {
            setup: setup.clone(),
            origin: Origin::of(run),
            place,
            console: console.clone(),
            writing: Vec::new(),
        }
    }

    /// Saves what a dead process left. `seen`: what was found out about it while it lived.
    pub(super) fn save(&mut self, memory: &File, process: Process, cause: &Cause, seen: &str) {
        let Ok(left) = Left::of(memory) else { return }; // died before it had one
        let text = report(process, cause, seen, &left, clock::now());
        let path = self.place.join(format!("crash-{}-{}.mcap", process.name(), clock::unix_ns() / 1_000_000));
        let (setup, origin, console) = (self.setup.clone(), self.origin.clone(), self.console.clone());
        // Not here: who looks after the others has no time for it.
        let write = move || match write(&path, (&setup, &origin), &text, &left.entries) {
            Ok(()) => console.say(format!("{}: its last seconds are in {}", process.name(), path.display())),
            Err(error) => console.say(format!("{}: its last seconds are lost: {error}", process.name())),
        };
        self.writing.extend(std::thread::Builder::new().name("crash".into()).spawn(write));
    }

    /// Waits until all are written, at most so long \[ns\]: a disk may hold one up for ever.
    pub(super) fn finish(&mut self, patience: u64) {
        let until = clock::now() + patience;
        while self.writing.iter().any(|thread| !thread.is_finished()) && clock::now() < until {
            std::thread::park_timeout(LOOK);
        }
        let unwritten = self.writing.drain(..).filter(|thread| !thread.is_finished()).count();
        if unwritten > 0 {
            self.console.say(format!("{unwritten} crash records are not written: the disk takes none"));
        }
    }
}

fn write(
    path: &Path,
    (setup, origin): (&Setup, &Origin),
    text: &str,
    entries: &[BlackBoxEntry],
) -> Result<(), RecordingError> {
    let mut recorder = logger::recorder(path, setup, origin)?;
    recorder.attach(TEXT, text.as_bytes())?;
    for entry in entries {
        let Some(topic) = TOPICS.get(entry.kind as usize) else { continue };
        with_type(topic.name, Put { recorder: &mut recorder, entry }).unwrap_or(Ok(()))?;
    }
    recorder.finish()
}

struct Put<'a> {
    recorder: &'a mut Recorder,
    entry: &'a BlackBoxEntry,
}

impl ForType<Result<(), RecordingError>> for Put<'_> {
    fn call<T: Record>(self, topic: &'static Topic) -> Result<(), RecordingError> {
        self.recorder.write(topic, &self.entry.record::<T>())
    }
}

/// Pending message.
fn report(process: Process, cause: &Cause, seen: &str, left: &Left, now: u64) -> String {
    let mut text = String::new();
    let ms = |ns: u64| now.saturating_sub(ns) as f64 * 1e-6;
    // A String takes everything.
    let _ = writeln!(text, "process  {}", process.name());
    let _ = writeln!(text, "reason   {} {cause}", process.name());
    if left.signal > 0 {
        let _ = writeln!(text, "signal   {}, address {:#x}", left.signal, left.address);
    }
    if !left.message.is_empty() {
        let _ = writeln!(text, "panic    {}", left.message.replace('\n', "\n         "));
    }
    if left.cycles > 0 {
        let place = if left.begun_ns > left.ended_ns { "in it" } else { "between two cycles" };
        let _ = writeln!(text, "cycle    {}, begun {:.1} ms before; {place}", left.cycles, ms(left.begun_ns));
    }
    let ticks = left.entries.first().map_or(0, |e| e.tick)..=left.entries.last().map_or(0, |e| e.tick);
    let _ = writeln!(text, "records  {}, ticks {} to {}", left.entries.len(), ticks.start(), ticks.end());
    if !seen.is_empty() {
        let _ = writeln!(text, "seen     {seen}");
    }
    let _ = writeln!(text, "stack    {}", stack(&left.frames));
    text
}

/// Functions and lines, innermost first. This program is the one that died, loaded elsewhere.
fn stack(frames: &[i64]) -> String {
    if frames.is_empty() {
        return "none: a process that is killed or stopped does not say where it is".into();
    }
    let mut text = String::new();
    for (n, offset) in frames.iter().enumerate() {
        let at = last_words::anchor().wrapping_add_signed(*offset as isize);
        let mut known = false;
        backtrace::resolve(at as *mut _, |symbol| {
            let name = symbol.name().map_or_else(|| "?".into(), |name| format!("{name:#}"));
            let line = symbol.filename().map_or_else(String::new, |file| {
                format!(" at {}:{}", file.display(), symbol.lineno().unwrap_or(0))
            });
            let _ = write!(text, "\n  {n:2} {name}{line}");
            known = true;
        });
        if !known {
            let _ = write!(text, "\n  {n:2} in a library");
        }
    }
    text
}

/// State of a hung process from /proc, and where in the kernel it waits.
pub(super) fn look(pid: u32) -> String {
    let read = |name: &str| std::fs::read_to_string(format!("/proc/{pid}/{name}")).unwrap_or_default();
    let status = read("status");
    let line = |key: &str| status.lines().find_map(|l| l.strip_prefix(key)).map_or("?", str::trim);
    let wait = read("wchan");
    let wait =
        if wait.is_empty() || wait == "0" { "not in the kernel".into() } else { format!("waits in {wait}") };
    format!("state {}, {wait}; {} voluntary switches", line("State:"), line("voluntary_ctxt_switches:"))
}
