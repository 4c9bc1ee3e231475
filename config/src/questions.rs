//! Questions that the readers of files ask, for the reference: which keys there are, what each takes, and where it is read.
//!
//! Off but while [`listen`] works, on its own thread.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

/// A question for one key of one file.
#[derive(Clone, Debug)]
pub(crate) struct Question {
    /// File that was read.
    pub(crate) file: PathBuf,
    /// Key with the tables around it.
    pub(crate) path: String,
    /// Values that it takes, with range and unit; empty: only whether it is there was asked.
    pub(crate) takes: String,
    /// It was asked for as one that may be left out.
    pub(crate) may_be_left_out: bool,
    /// Source file that asks, and the line in it.
    pub(crate) source: &'static str,
    pub(crate) line: usize,
}

/// Questions so far, and the tables whose keys are names.
#[derive(Clone, Debug, Default)]
pub(crate) struct Heard {
    pub(crate) questions: Vec<Question>,
    pub(crate) named: Vec<(PathBuf, String)>,
}

thread_local! {
    static HEARD: RefCell<Option<Heard>> = const { RefCell::new(None) };
}

/// All questions that `work` leads to on this thread.
pub(crate) fn listen(work: impl FnOnce()) -> Heard {
    HEARD.set(Some(Heard::default()));
    work();
    HEARD.take().unwrap_or_default()
}

/// Notes a question, if somebody listens.
pub(crate) fn tell(question: impl FnOnce() -> Question) {
    HEARD.with_borrow_mut(|heard| {
        if let Some(heard) = heard {
            heard.questions.push(question());
        }
    });
}

/// Notes that the keys of the table `path` are names.
pub(crate) fn tell_named(file: &Path, path: &str) {
    HEARD.with_borrow_mut(|heard| {
        if let Some(heard) = heard {
            heard.named.push((file.into(), path.into()));
        }
    });
}
