//! `rows.tsv` of a sweep: a line for each walk as soon as it is done, in no order. Who is killed at any instant finds every whole
//! line again, and goes on.
//!
//! The first line says which program, sweep and configuration they are from, the second one names the columns.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::columns::{self, Cell, CellType};

/// Name in the directory of results.
pub(super) const NAME: &str = "rows.tsv";

/// The rows so far.
pub(super) struct Rows {
    file: File,
    path: PathBuf,
    /// \[byte\] End of the last whole line.
    end: u64,
    columns: Vec<(String, CellType)>,
    /// Walks of the sweep.
    walks: u64,
    /// By the number of the walk.
    pub(super) found: BTreeMap<u64, Vec<Cell>>,
}

impl Rows {
    /// Those in a directory, which is made; nobody else may add any meanwhile.
    ///
    /// # Errors
    /// There are rows of another program, sweep or configuration; or somebody adds to them; or they cannot be read.
    pub(super) fn open(
        out: &Path,
        identity: &str,
        columns: Vec<(String, CellType)>,
        walks: u64,
    ) -> Result<Self, String> {
        crate::sheet::make(out)?;
        let path = out.join(NAME);
        let problem = |e: std::io::Error| format!("{}: {e}; choose another place with --out", path.display());
        let mut options = OpenOptions::new();
        let mut file =
            options.read(true).write(true).create(true).truncate(false).open(&path).map_err(problem)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let path = path.display();
                return Err(format!(
                    "{path}: another `gangwerk sweep` writes there; wait for it, or choose another place with --out"
                ));
            }
            Err(TryLockError::Error(e)) => return Err(problem(e)),
        }
        let mut text = Vec::new();
        file.read_to_end(&mut text).map_err(problem)?;
        let mut rows = Self { file, path, end: 0, columns, walks, found: BTreeMap::new() };
        let names: Vec<&str> = rows.columns.iter().map(|(name, _)| name.as_str()).collect();
        let head = [format!("# {identity}"), names.join("\t")];
        // A line that was cut off is walked again.
        let whole = text.iter().rposition(|b| *b == b'\n').map_or(0, |end| end + 1);
        let text = String::from_utf8_lossy(&text[..whole]).into_owned();
        let mut lines = text.lines();
        for (number, wanted) in head.iter().enumerate() {
            match lines.next() {
                Some(line) if line == wanted => {}
                Some(line) => {
                    let (path, number) = (rows.path.display(), number + 1);
                    return Err(format!(
                        "{path}: line {number}: holds rows of `{line}`, but this is `{wanted}`; go on with that one, or choose another place with --out"
                    ));
                }
                None => rows.write(wanted)?,
            }
        }
        if whole > 0 {
            rows.end = whole as u64;
        }
        for (k, line) in lines.enumerate() {
            rows.take(line).map_err(|why| format!("{}: line {}: {why}", rows.path.display(), k + 3))?;
        }
        Ok(rows)
    }

    /// Walks that are not done.
    pub(super) fn left(&self) -> impl Iterator<Item = u64> {
        (0..self.walks).filter(|walk| !self.found.contains_key(walk))
    }

    /// Adds a row; `false` if it was there.
    ///
    /// # Errors
    /// It is no row of this sweep, or another one of the same walk; or it cannot be written: what was there stays.
    pub(super) fn add(&mut self, line: &str) -> Result<bool, String> {
        if !self.take(line)? {
            return Ok(false);
        }
        self.write(line)?;
        Ok(true)
    }

    /// Takes the row of a line; `false` if it was there.
    fn take(&mut self, line: &str) -> Result<bool, String> {
        let row = columns::row(line, &self.columns);
        let row = row.ok_or_else(|| format!("`{line}` does not have the columns of the table"))?;
        let Some(&Cell::Whole(walk)) = row.first().filter(|c| matches!(c, Cell::Whole(n) if *n < self.walks))
        else {
            return Err(format!("`{line}` is no walk of this sweep, which has {}", self.walks));
        };
        match self.found.get(&walk) {
            None => {}
            Some(known) if *known == row => return Ok(false),
            Some(_) => {
                return Err(format!("walk {walk} came out in two ways; walks are to be the same everywhere"));
            }
        }
        self.found.insert(walk, row);
        Ok(true)
    }

    fn write(&mut self, line: &str) -> Result<(), String> {
        let bytes = format!("{line}\n").into_bytes();
        let written = self.file.seek(SeekFrom::Start(self.end)).and_then(|_| self.file.write_all(&bytes));
        if let Err(e) = written {
            // Half a line would not be read again anyway.
            let _ = self.file.set_len(self.end);
            let path = self.path.display();
            return Err(format!(
                "{path}: {e}; every row before it is there, so make room and start the sweep again: it goes on"
            ));
        }
        self.end += bytes.len() as u64;
        Ok(())
    }
}
