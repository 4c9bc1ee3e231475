//! Everything that is wrong with one file, reported at once.

use std::fmt;
use std::path::PathBuf;

/// A configuration file that cannot be used, with all of its problems in the order of its lines.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ConfigError {
    /// The file.
    pub file: PathBuf,
    /// At least one.
    pub problems: Vec<Problem>,
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Line in the file, from 1; 0 if the file as a whole is meant.
    pub line: usize,
    /// Key with the tables around it, as in `step.width`; empty if no key is meant.
    pub key: String,
    /// Problem, and what would be right.
    pub text: String,
}

impl ConfigError {
    /// A problem with the file as a whole.
    pub(crate) fn of_file(file: impl Into<PathBuf>, text: impl Into<String>) -> Self {
        Self { file: file.into(), problems: vec![Problem { line: 0, key: String::new(), text: text.into() }] }
    }
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = self.file.display();
        match self.problems.as_slice() {
            [one] => write!(f, "{file}: {one}"),
            all => {
                write!(f, "{file}: {} problems", all.len())?;
                all.iter().try_for_each(|problem| write!(f, "\n  {problem}"))
            }
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line > 0 {
            write!(f, "line {}: ", self.line)?;
        }
        if !self.key.is_empty() {
            write!(f, "{}: ", self.key)?;
        }
        f.write_str(&self.text)
    }
}

impl std::error::Error for ConfigError {}
