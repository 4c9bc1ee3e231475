//! The thread that owns the terminal.

use crate::fold::Fold;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::time::Duration;

/// Lines that wait for the terminal; further ones are dropped and counted.
const QUEUE: usize = 1024;
/// Between two looks whether a window of folded lines is over.
const LOOK: Duration = Duration::from_millis(100);

enum Item {
    /// A line for the operator.
    Line(String),
    /// Progress of the run \[1/10 s\], and a word on it.
    Progress(u64, String),
    /// The result of the run, for standard output, and where to say that it is written.
    Result(String, SyncSender<bool>),
    /// The end: everything handed over before is on the terminal.
    Flush(SyncSender<bool>),
}

/// The way to the terminal. Cheap to copy; no call waits, but for [`Console::result`] and [`Console::flush`], for a bounded
/// time.
#[derive(Clone)]
pub struct Console {
    queue: SyncSender<Item>,
    dropped: Arc<AtomicU64>,
}

impl Console {
    /// Starts the thread. `length`: a progress bar up to this; none: lines only. `now`: the monotonic clock \[ns\].
    ///
    /// # Errors
    /// The thread cannot be started.
    pub fn start(length: Option<u64>, now: fn() -> u64) -> std::io::Result<Self> {
        let (queue, items) = sync_channel(QUEUE);
        let dropped = Arc::new(AtomicU64::new(0));
        let owner = Owner { fold: Fold::default(), bar: bar(length), dropped: dropped.clone(), told: 0, now };
        std::thread::Builder::new().name("console".into()).spawn(move || owner.run(&items))?;
        Ok(Self { queue, dropped })
    }

    /// Shows a line, or counts it as dropped.
    pub fn say(&self, line: impl Into<String>) {
        self.put(Item::Line(line.into()));
    }

    /// Shows how far the run is.
    pub fn progress(&self, position: u64, message: String) {
        // An old picture of the bar is no loss.
        let _ = self.queue.try_send(Item::Progress(position, message));
    }

    /// Writes a result on standard output; whether it was written within `patience`.
    pub fn result(&self, text: String, patience: Duration) -> bool {
        self.answered(|done| Item::Result(text, done), patience)
    }

    /// Waits until everything is on the terminal; false if that took longer than `patience`.
    pub fn flush(&self, patience: Duration) -> bool {
        self.answered(Item::Flush, patience)
    }

    fn answered(&self, item: impl FnOnce(SyncSender<bool>) -> Item, patience: Duration) -> bool {
        let (done, answer) = sync_channel(1);
        self.put(item(done)) && answer.recv_timeout(patience).unwrap_or(false)
    }

    fn put(&self, item: Item) -> bool {
        let taken = self.queue.try_send(item).is_ok();
        self.dropped.fetch_add(u64::from(!taken), Relaxed);
        taken
    }
}

/// State of the thread.
struct Owner {
    fold: Fold,
    bar: ProgressBar,
    dropped: Arc<AtomicU64>,
    /// Dropped lines that were told.
    told: u64,
    now: fn() -> u64,
}

impl Owner {
    fn run(mut self, items: &Receiver<Item>) {
        loop {
            match items.recv_timeout(LOOK) {
                Ok(Item::Line(line)) => {
                    if self.fold.admit(&line) {
                        self.show(&line);
                    }
                }
                Ok(Item::Progress(position, message)) => {
                    self.bar.set_position(position);
                    self.bar.set_message(message);
                }
                Ok(Item::Result(text, done)) => {
                    self.bar.finish_and_clear();
                    let mut out = std::io::stdout().lock();
                    let written = writeln!(out, "{text}").and_then(|()| out.flush());
                    let _ = done.send(written.is_ok());
                }
                Ok(Item::Flush(done)) => {
                    self.tell_hidden(true);
                    self.bar.finish_and_clear();
                    let _ = done.send(true);
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            self.tell_hidden(false);
        }
    }

    /// Lines folded, and lines dropped because the terminal did not keep up.
    fn tell_hidden(&mut self, last: bool) {
        for line in self.fold.summary((self.now)(), last) {
            self.show(&line);
        }
        let dropped = self.dropped.load(Relaxed);
        if dropped > self.told {
            self.show(&format!("... {} lines dropped: the terminal did not take them", dropped - self.told));
            self.told = dropped;
        }
    }

    fn show(&self, line: &str) {
        if self.bar.is_hidden() {
            crate::print::to_terminal(format!("{line}\n").as_bytes());
        } else {
            self.bar.println(line);
        }
    }
}

fn bar(length: Option<u64>) -> ProgressBar {
    let Some(length) = length else { return ProgressBar::hidden() };
    let bar = ProgressBar::new(length);
    match ProgressStyle::with_template("{elapsed:>4} {wide_bar} {msg}") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}
