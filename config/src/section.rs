//! The typed reader over TOML: what a file may say is what is asked of it.
//!
//! A [`Section`] is one table of the file. Each question (`number`, `text`, ...) names a key, and for numbers the unit
//! and the allowed range. What is wrong is noted down and a stand-in returned (NaN for numbers, so that no rule between
//! fields fires on top of it); [`read`] hands all problems out together. A key nobody asked for is refused with the
//! nearest one somebody did ask for.

use std::cell::RefCell;
use std::ops::RangeInclusive;
use std::path::Path;

use messages::nearest;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{ConfigError, Problem};
use crate::questions::{self, Question};

/// Everything above zero, for lengths, masses, times.
pub(crate) const POSITIVE: RangeInclusive<f64> = 1e-9..=1e9;
/// Everything from zero on.
pub(crate) const NOT_NEGATIVE: RangeInclusive<f64> = 0.0..=1e9;

type Value<'t> = Spanned<DeValue<'t>>;

/// State shared by all sections of one file.
struct File<'t> {
    path: &'t Path,
    text: &'t str,
    problems: RefCell<Vec<Problem>>,
}

impl File<'_> {
    fn note(&self, at: usize, key: String, text: String) {
        let line = 1 + self.text[..at.min(self.text.len())].matches('\n').count();
        self.problems.borrow_mut().push(Problem { line, key, text });
    }
}

/// One table of a file.
pub(crate) struct Section<'a, 't> {
    file: &'a File<'t>,
    /// Name with the tables around it; empty at the top.
    name: String,
    /// Offset of the table \[byte\].
    at: usize,
    table: &'a DeTable<'t>,
    asked: RefCell<Vec<String>>,
}

/// Reads `text` with `build`; either everything was right or all problems come back.
pub(crate) fn read<T>(
    path: &Path,
    text: &str,
    build: impl FnOnce(&Section<'_, '_>) -> T,
) -> Result<T, ConfigError> {
    let file = File { path, text, problems: RefCell::default() };
    let value = match DeTable::parse(text) {
        Ok(table) => {
            let top = Section::new(&file, String::new(), 0, table.get_ref());
            Some(build(&top))
        }
        Err(e) => {
            let at = e.span().map_or(0, |span| span.start);
            file.note(at, String::new(), format!("not TOML: {}", e.message()));
            None
        }
    };
    let mut problems = file.problems.into_inner();
    problems.sort_by_key(|p| p.line);
    match value {
        Some(value) if problems.is_empty() => Ok(value),
        _ => Err(ConfigError { file: path.to_owned(), problems }),
    }
}

impl<'a, 't> Section<'a, 't> {
    fn new(file: &'a File<'t>, name: String, at: usize, table: &'a DeTable<'t>) -> Self {
        Self { file, name, at, table, asked: RefCell::default() }
    }

    fn path(&self, key: &str) -> String {
        if self.name.is_empty() { key.to_owned() } else { format!("{}.{key}", self.name) }
    }

    /// Notes a broken rule at `key`, or at the table itself if the key is not there.
    pub(crate) fn problem(&self, key: &str, text: impl Into<String>) {
        let at = self.table.get(key).map_or(self.at, |v| v.span().start);
        self.file.note(at, self.path(key), text.into());
    }

    /// True if nothing of the file was found wrong so far: rules between keys may be looked at.
    pub(crate) fn is_sound(&self) -> bool {
        self.file.problems.borrow().is_empty()
    }

    /// Is the key there? Asked for one that may be left out.
    #[track_caller]
    pub(crate) fn has(&self, key: &str) -> bool {
        self.tell(key, "", true);
        self.is_there(key)
    }

    fn is_there(&self, key: &str) -> bool {
        self.asked.borrow_mut().push(key.to_owned());
        self.table.contains_key(key)
    }

    /// Tells who lists the keys what this one takes, and where it is asked for.
    #[track_caller]
    fn tell(&self, key: &str, wanted: &str, may_be_left_out: bool) {
        let place = std::panic::Location::caller();
        questions::tell(|| Question {
            file: self.file.path.to_owned(),
            path: self.path(key),
            takes: wanted.to_owned(),
            may_be_left_out,
            source: place.file(),
            line: place.line() as usize,
        });
    }

    #[track_caller]
    fn get(&self, key: &str, wanted: &str) -> Option<&'a Value<'t>> {
        self.tell(key, wanted, false);
        let found = self.is_there(key).then(|| &self.table[key]);
        if found.is_none() {
            self.problem(key, format!("missing; it takes {wanted}"));
        }
        found
    }

    fn wrong_type(&self, key: &str, value: &Value<'_>, wanted: &str) {
        let is = value.get_ref().type_str();
        self.file.note(value.span().start, key.to_owned(), format!("is of type {is}; it takes {wanted}"));
    }

    /// A number in `range`, or NaN.
    #[track_caller]
    pub(crate) fn number(&self, key: &str, unit: &str, range: RangeInclusive<f64>) -> f64 {
        match self.get(key, &number_in(unit, &range)) {
            Some(value) => self.number_of(&self.path(key), value, unit, &range),
            None => f64::NAN,
        }
    }

    fn number_of(&self, key: &str, value: &Value<'_>, unit: &str, range: &RangeInclusive<f64>) -> f64 {
        let x = match value.get_ref() {
            DeValue::Float(x) => x.as_str().parse().unwrap_or(f64::NAN),
            DeValue::Integer(n) => i64::from_str_radix(n.as_str(), n.radix()).map_or(f64::NAN, |n| n as f64),
            _ => {
                self.wrong_type(key, value, &number_in(unit, range));
                return f64::NAN;
            }
        };
        if range.contains(&x) {
            return x;
        }
        let text = format!("{x} is not allowed; it takes {}", number_in(unit, range));
        self.file.note(value.span().start, key.to_owned(), text);
        f64::NAN
    }

    /// `N` numbers in `range`, NaN where one is wrong.
    #[track_caller]
    pub(crate) fn numbers<const N: usize>(
        &self,
        key: &str,
        unit: &str,
        range: RangeInclusive<f64>,
    ) -> [f64; N] {
        let wanted = format!("{N} numbers, each {}", number_in(unit, &range));
        match self.get(key, &wanted) {
            Some(value) => self.array_of(&self.path(key), value, unit, &range),
            None => [f64::NAN; N],
        }
    }

    fn array_of<const N: usize>(
        &self,
        key: &str,
        value: &Value<'_>,
        unit: &str,
        range: &RangeInclusive<f64>,
    ) -> [f64; N] {
        let wanted = format!("{N} numbers, each {}", number_in(unit, range));
        match value.get_ref() {
            DeValue::Array(items) if items.len() == N => {
                std::array::from_fn(|i| self.number_of(&format!("{key}[{i}]"), &items[i], unit, range))
            }
            DeValue::Array(items) => {
                let text = format!("has {} entries; it takes {wanted}", items.len());
                self.file.note(value.span().start, key.to_owned(), text);
                [f64::NAN; N]
            }
            _ => {
                self.wrong_type(key, value, &wanted);
                [f64::NAN; N]
            }
        }
    }

    /// Numbers in `range`, at least one.
    #[track_caller]
    pub(crate) fn list(&self, key: &str, unit: &str, range: RangeInclusive<f64>) -> Vec<f64> {
        let name = self.path(key);
        let items = self.items(key, &format!("a list of numbers, each {}", number_in(unit, &range)));
        let number = |(i, item)| self.number_of(&format!("{name}[{i}]"), item, unit, &range);
        items.iter().enumerate().map(number).collect()
    }

    /// Two numbers in `range`, ascending.
    #[track_caller]
    pub(crate) fn interval(&self, key: &str, unit: &str, range: RangeInclusive<f64>) -> [f64; 2] {
        let [lo, hi] = self.numbers(key, unit, range);
        if lo >= hi {
            self.problem(key, format!("its lower end {lo} must lie below its upper end {hi} {unit}"));
        }
        [lo, hi]
    }

    /// Rows of `N` numbers each; at least one row.
    #[track_caller]
    pub(crate) fn rows<const N: usize>(&self, key: &str, meaning: &str) -> Vec<[f64; N]> {
        let name = self.path(key);
        self.items(key, &format!("a list of rows, each {meaning}"))
            .iter()
            .enumerate()
            .map(|(i, row)| self.array_of(&format!("{name}[{i}]"), row, "", &(-1e9..=1e9)))
            .collect()
    }

    /// A whole number in `range`; its lower end if the entry is wrong.
    #[track_caller]
    pub(crate) fn integer(&self, key: &str, range: RangeInclusive<u64>) -> u64 {
        let wanted = format!("a whole number from {} to {}", range.start(), range.end());
        let Some(value) = self.get(key, &wanted) else { return *range.start() };
        let DeValue::Integer(n) = value.get_ref() else {
            self.wrong_type(&self.path(key), value, &wanted);
            return *range.start();
        };
        match u64::from_str_radix(n.as_str(), n.radix()) {
            Ok(n) if range.contains(&n) => n,
            _ => {
                self.problem(key, format!("{} is not allowed; it takes {wanted}", n.as_str()));
                *range.start()
            }
        }
    }

    /// A string; empty if the entry is wrong.
    #[track_caller]
    pub(crate) fn text(&self, key: &str) -> String {
        let Some(value) = self.get(key, "a string") else { return String::new() };
        let text = value.get_ref().as_str();
        if text.is_none() {
            self.wrong_type(&self.path(key), value, "a string");
        }
        text.unwrap_or_default().to_owned()
    }

    /// A list of strings.
    #[track_caller]
    pub(crate) fn texts(&self, key: &str) -> Vec<String> {
        let name = self.path(key);
        let items = self.items(key, "a list of strings").iter().enumerate();
        let text = |(i, item): (usize, &Value<'_>)| match item.get_ref().as_str() {
            Some(text) => text.to_owned(),
            None => {
                self.wrong_type(&format!("{name}[{i}]"), item, "a string");
                String::new()
            }
        };
        items.map(text).collect()
    }

    /// The position of a word in `words`; 0 if the entry is wrong.
    #[track_caller]
    pub(crate) fn word(&self, key: &str, words: &[&str]) -> usize {
        self.tell(key, &format!("one of {}", listed(words)), false);
        let text = self.text(key);
        words.iter().position(|word| *word == text).unwrap_or_else(|| {
            // What is missing or no string has been named.
            if self.table.get(key).is_some_and(|value| value.get_ref().as_str().is_some()) {
                self.problem(key, format!("`{text}` is not known; it takes one of {}", listed(words)));
            }
            0
        })
    }

    /// A switch: off if the key is not there.
    #[track_caller]
    pub(crate) fn flag(&self, key: &str) -> bool {
        self.tell(key, "true or false", true);
        if !self.is_there(key) {
            return false;
        }
        match self.table[key].get_ref() {
            DeValue::Boolean(on) => *on,
            _ => {
                self.wrong_type(&self.path(key), &self.table[key], "true or false");
                false
            }
        }
    }

    /// Is the key there, and a string?
    pub(crate) fn is_text(&self, key: &str) -> bool {
        self.is_there(key) && matches!(self.table[key].get_ref(), DeValue::String(_))
    }

    /// Is the key there, and a table?
    pub(crate) fn is_table(&self, key: &str) -> bool {
        self.is_there(key) && matches!(self.table[key].get_ref(), DeValue::Table(_))
    }

    /// Is the key there, and a list?
    pub(crate) fn is_list(&self, key: &str) -> bool {
        self.is_there(key) && matches!(self.table[key].get_ref(), DeValue::Array(_))
    }

    #[track_caller]
    fn items(&self, key: &str, wanted: &str) -> &'a [Value<'t>] {
        let Some(value) = self.get(key, wanted) else { return &[] };
        match value.get_ref() {
            DeValue::Array(items) if !items.is_empty() => items,
            DeValue::Array(_) => {
                self.problem(key, format!("is empty; it takes {wanted}"));
                &[]
            }
            _ => {
                self.wrong_type(&self.path(key), value, wanted);
                &[]
            }
        }
    }

    /// Reads the table `key` with `build`; nothing if it is missing.
    #[track_caller]
    pub(crate) fn table<T>(&self, key: &str, build: impl FnOnce(&Section<'a, 't>) -> T) -> Option<T> {
        let value = self.get(key, "a table")?;
        self.table_of(self.path(key), value, build)
    }

    fn table_of<T>(
        &self,
        name: String,
        value: &'a Value<'t>,
        build: impl FnOnce(&Section<'a, 't>) -> T,
    ) -> Option<T> {
        match value.get_ref() {
            DeValue::Table(table) => Some(build(&Section::new(self.file, name, value.span().start, table))),
            _ => {
                self.wrong_type(&name, value, "a table");
                None
            }
        }
    }

    /// Reads every table of the list `[[key]]` with `build`; none if the list is missing.
    #[track_caller]
    pub(crate) fn tables<T>(&self, key: &str, build: impl Fn(&Section<'a, 't>) -> T) -> Vec<T> {
        self.tell(key, "a list of tables", true);
        if !self.is_there(key) {
            return Vec::new();
        }
        let name = self.path(key);
        let items = self.items(key, "a list of tables").iter().enumerate();
        items.filter_map(|(i, item)| self.table_of(format!("{name}[{i}]"), item, &build)).collect()
    }

    /// The keys of this table, for tables whose keys are names.
    pub(crate) fn keys(&self) -> Vec<String> {
        questions::tell_named(self.file.path, &self.name);
        self.table.keys().map(|key| key.get_ref().clone().into_owned()).collect()
    }
}

impl Drop for Section<'_, '_> {
    /// Whatever nobody asked for is refused.
    fn drop(&mut self) {
        let asked = self.asked.get_mut();
        for key in self.table.keys() {
            let name: &str = key.get_ref();
            if !asked.iter().any(|known| known == name) {
                let text = match nearest(name, asked) {
                    Some(known) => format!("unknown key; the nearest known one is `{known}`"),
                    None => "unknown key".to_owned(),
                };
                let path =
                    if self.name.is_empty() { name.to_owned() } else { format!("{}.{name}", self.name) };
                self.file.note(key.span().start, path, text);
            }
        }
    }
}

/// A range, both ends included.
fn number_in(unit: &str, range: &RangeInclusive<f64>) -> String {
    let end = |x: f64| {
        let plain = x == 0.0 || (1e-4..1e6).contains(&x.abs());
        if plain { x.to_string() } else { format!("{x:e}") }
    };
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    format!("a number from {} to {}{unit}", end(*range.start()), end(*range.end()))
}

/// `a`, `b` and `c`.
pub(crate) fn listed(words: &[&str]) -> String {
    words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ")
}
