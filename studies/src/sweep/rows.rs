//! `rows.tsv` of a sweep: a line for each walk as soon as it is done, in no order. A sweep that is killed at any instant finds every whole
//! line again, and goes on.
//!
//! The first line says which program, sweep and configuration they are from, the second one names the columns.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::hash::{DefaultHasher, Hasher};
use std::io::{BufRead, BufReader};
use std::os::unix::fs::FileExt;
use std::path::{Path, PathBuf};

use super::columns::{self, Cell, CellType};

/// Name in the directory of results.
pub(super) const NAME: &str = "rows.tsv";

/// Where a row is in the file \[byte\], and the hash of its line.
struct RowPlace {
    begin: u64,
    length: usize,
    hash: u64,
}

/// The rows so far, on disk: memory holds a few words of each.
pub(super) struct Rows {
    file: File,
    path: PathBuf,
    /// \[byte\] End of the last whole line.
    end: u64,
    columns: Vec<(String, CellType)>,
    /// Walks of the sweep.
    walks: u64,
    /// By the number of the walk.
    found: BTreeMap<u64, RowPlace>,
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
        let file =
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
        let mut lines = BufReader::new(file.try_clone().map_err(problem)?);
        let mut rows = Self { file, path, end: 0, columns, walks, found: BTreeMap::new() };
        let names: Vec<&str> = rows.columns.iter().map(|(name, _)| name.as_str()).collect();
        let mut head = vec![names.join("\t"), format!("# {identity}")];
        // Lines up to one that was cut off, which is walked again.
        let (mut line, mut number) = (Vec::new(), 0);
        loop {
            line.clear();
            lines.read_until(b'\n', &mut line).map_err(|e| format!("{}: {e}", rows.path.display()))?;
            number += 1;
            let Some(text) = line.strip_suffix(b"\n") else { break };
            let text = std::str::from_utf8(text)
                .map_err(|e| format!("{}: line {number}: {e}", rows.path.display()))?;
            match head.pop() {
                Some(wanted) if text == wanted => {}
                Some(wanted) => return Err(rows.foreign(number, text, &wanted)),
                None => {
                    let taken = rows.take(text);
                    taken.map_err(|why| format!("{}: line {number}: {why}", rows.path.display()))?;
                }
            }
            rows.end += line.len() as u64;
        }
        // A file that is not of a sweep may have no whole line at all.
        if let Some(wanted) = head.last().filter(|wanted| !wanted.as_bytes().starts_with(&line)) {
            return Err(rows.foreign(number, &String::from_utf8_lossy(&line), wanted));
        }
        rows.file.set_len(rows.end).map_err(|e| format!("{}: {e}", rows.path.display()))?;
        while let Some(missing) = head.pop() {
            rows.write(&missing)?;
        }
        Ok(rows)
    }

    /// What to say of a file whose line of that number is another one.
    fn foreign(&self, number: usize, is: &str, wanted: &str) -> String {
        let (path, is): (_, String) = (self.path.display(), is.chars().take(500).collect());
        format!(
            "{path}: line {number}: holds rows of `{is}`, but this is `{wanted}`; go on with that one, or choose another place with --out"
        )
    }

    /// How many walks are done.
    pub(super) fn count(&self) -> usize {
        self.found.len()
    }

    /// All rows, in the order of their walks.
    pub(super) fn each(&self) -> impl Iterator<Item = Result<Vec<Cell>, String>> {
        self.found.values().map(|place| {
            let mut bytes = vec![0; place.length];
            let path = self.path.display();
            self.file.read_exact_at(&mut bytes, place.begin).map_err(|e| format!("{path}: {e}"))?;
            let row = columns::row(&String::from_utf8_lossy(&bytes), &self.columns);
            row.ok_or_else(|| format!("{path}: was changed meanwhile"))
        })
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
        let mut hash = DefaultHasher::new();
        hash.write(line.as_bytes());
        let place = RowPlace { begin: self.end, length: line.len(), hash: hash.finish() };
        match self.found.get(&walk) {
            None => {}
            Some(known) if known.hash == place.hash => return Ok(false),
            Some(_) => {
                return Err(format!("walk {walk} came out in two ways; walks are to be the same everywhere"));
            }
        }
        self.found.insert(walk, place);
        Ok(true)
    }

    fn write(&mut self, line: &str) -> Result<(), String> {
        let bytes = format!("{line}\n").into_bytes();
        if let Err(e) = self.file.write_all_at(&bytes, self.end) {
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
