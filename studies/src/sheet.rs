//! What a study found, in one form: facts, and tables whose columns are data. It becomes text, Markdown and JSON, and knows
//! where its pictures are.

use std::path::Path;

use drawing::Figure;
use serde::Serialize;
use serde_json::{Map, Value};

/// Facts and tables of a study.
#[derive(Clone, Debug, Default)]
pub struct Sheet {
    facts: Map<String, Value>,
    parts: Vec<SheetPart>,
}

/// What people read, from top to bottom.
#[derive(Clone, Debug)]
enum SheetPart {
    Line(String),
    Table(&'static [Column], Vec<Value>),
}

/// Column of a table: a field of its rows, and how it is written.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// JSON pointer into a row: "/rms_rad/0".
    path: &'static str,
    head: &'static str,
    times: f64,
    digits: Digits,
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Digits {
    /// As they are.
    All,
    /// With so many decimals.
    Fixed(usize),
    /// With so many decimals and an exponent.
    Scientific(usize),
    /// With six decimals, or an exponent where these would not do.
    Six,
}

/// A column of words or whole numbers.
pub const fn plain(path: &'static str, head: &'static str) -> Column {
    Column { path, head, times: 1.0, digits: Digits::All }
}

/// A column of numbers with so many decimals.
pub const fn fixed(path: &'static str, head: &'static str, decimals: usize) -> Column {
    Column { digits: Digits::Fixed(decimals), ..plain(path, head) }
}

/// A column of numbers with so many decimals and an exponent.
pub(crate) const fn scientific(path: &'static str, head: &'static str, decimals: usize) -> Column {
    Column { digits: Digits::Scientific(decimals), ..plain(path, head) }
}

/// A column of numbers with six decimals, or an exponent where these would not do.
pub const fn six(path: &'static str, head: &'static str) -> Column {
    Column { digits: Digits::Six, ..plain(path, head) }
}

impl Column {
    /// The same in another unit: what is written is so many times the number.
    pub const fn times(self, times: f64) -> Self {
        Self { times, ..self }
    }

    fn cell(&self, row: &Value) -> String {
        self.write(row.pointer(self.path).unwrap_or(&Value::Null))
    }

    fn write(&self, value: &Value) -> String {
        match value {
            Value::Null => "-".into(),
            Value::Bool(yes) => if *yes { "yes" } else { "no" }.into(),
            Value::String(text) => text.clone(),
            Value::Number(number) if self.times == 1.0 && !number.is_f64() => number.to_string(),
            Value::Number(number) => self.number(self.times * number.as_f64().unwrap_or(f64::NAN)),
            Value::Array(all) => {
                let separator = if all.iter().any(Value::is_string) { ", " } else { " " };
                all.iter().map(|one| self.write(one)).collect::<Vec<_>>().join(separator)
            }
            Value::Object(fields) => {
                let one = |(name, value)| format!("{name} {}", self.write(value));
                fields.iter().map(one).collect::<Vec<_>>().join(", ")
            }
        }
    }

    fn number(&self, x: f64) -> String {
        match self.digits {
            Digits::All => x.to_string(),
            Digits::Fixed(n) => format!("{x:.n$}"),
            Digits::Scientific(n) => format!("{x:.n$e}"),
            Digits::Six if x == 0.0 || (1e-3..1e6).contains(&x.abs()) => format!("{x:.6}"),
            Digits::Six => format!("{x:.4e}"),
        }
    }
}

impl Sheet {
    /// A sheet with one line above everything.
    pub(crate) fn titled(title: impl Into<String>) -> Self {
        Self { parts: vec![SheetPart::Line(title.into())], ..Self::default() }
    }

    /// A fact for other programs, under its key.
    pub(crate) fn fact(&mut self, key: &str, value: impl Serialize) {
        self.facts.insert(key.into(), of(value));
    }

    /// All fields of a record as facts.
    pub fn facts(&mut self, record: impl Serialize) {
        if let Value::Object(fields) = of(record) {
            self.facts.extend(fields);
        }
    }

    /// A line for people.
    pub fn line(&mut self, text: impl Into<String>) {
        self.parts.push(SheetPart::Line(text.into()));
    }

    /// A table for people.
    pub fn table<R: Serialize>(&mut self, columns: &'static [Column], rows: &[R]) {
        self.parts.push(SheetPart::Table(columns, rows.iter().map(of).collect()));
    }

    /// A table for people, whose rows other programs find under its key.
    pub fn rows<R: Serialize>(&mut self, key: &str, columns: &'static [Column], rows: &[R]) {
        self.fact(key, rows);
        self.table(columns, rows);
    }

    /// Saves a picture in a folder, which is made, and says where it is.
    ///
    /// # Errors
    /// It cannot be written there.
    pub fn draw(&mut self, out: &Path, name: &str, figure: &Figure) -> Result<String, String> {
        make(out)?;
        let path = out.join(name);
        figure.save(&path)?;
        let path = path.display().to_string();
        self.line(path.as_str());
        let pictures = self.facts.entry("pictures").or_insert_with(|| Value::Array(Vec::new()));
        pictures.as_array_mut().expect("a list").push(Value::from(path.as_str()));
        Ok(path)
    }

    /// All facts as one object.
    pub fn json(&self) -> Value {
        Value::Object(self.facts.clone())
    }

    /// Lines and tables, columns side by side.
    pub fn text(&self) -> String {
        self.written(aligned)
    }

    /// Lines and tables as a document holds them.
    pub fn markdown(&self) -> String {
        self.written(|columns, rows| {
            let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
            let head = row(columns.iter().map(|c| c.head.into()).collect());
            let escaped = |c: &Column, r| c.cell(r).replace('|', "\\|");
            let body = rows.iter().map(|r| row(columns.iter().map(|c| escaped(c, r)).collect()));
            format!("\n{head}|{}\n{}", "---|".repeat(columns.len()), body.collect::<String>())
        })
    }

    fn written(&self, table: impl Fn(&[Column], &[Value]) -> String) -> String {
        let one = |part: &SheetPart| match part {
            SheetPart::Line(text) => format!("{text}\n"),
            SheetPart::Table(columns, rows) => table(columns, rows),
        };
        self.parts.iter().map(one).collect::<String>().trim_end().to_owned()
    }
}

/// Makes the folder where results go.
///
/// # Errors
/// It cannot be made.
pub fn make(out: &Path) -> Result<(), String> {
    std::fs::create_dir_all(out)
        .map_err(|e| format!("{}: {e}; choose another place with --out", out.display()))
}

/// What other programs read; numbers that are none are null.
fn of(value: impl Serialize) -> Value {
    serde_json::to_value(value).unwrap_or_default()
}

/// Words to the left, numbers to the right, as wide as the widest.
fn aligned(columns: &[Column], rows: &[Value]) -> String {
    let cells: Vec<Vec<String>> = rows.iter().map(|r| columns.iter().map(|c| c.cell(r)).collect()).collect();
    let wide = |text: &str| text.chars().count();
    let width = |k: usize| cells.iter().map(|r| wide(&r[k])).fold(wide(columns[k].head), usize::max);
    let widths: Vec<usize> = (0..columns.len()).map(width).collect();
    let words =
        |c: &Column| !rows.iter().any(|r| r.pointer(c.path).is_some_and(|v| v.is_number() || v.is_array()));
    let left: Vec<bool> = columns.iter().map(words).collect();
    let line = |texts: &mut dyn Iterator<Item = &str>| {
        let cell = |(k, text): (usize, &str)| {
            let w = widths[k];
            if left[k] { format!("{text:w$}  ") } else { format!("{text:>w$}  ") }
        };
        texts.enumerate().map(cell).collect::<String>().trim_end().to_owned() + "\n"
    };
    let head = if columns.iter().all(|c| c.head.is_empty()) {
        String::new()
    } else {
        line(&mut columns.iter().map(|c| c.head))
    };
    head + &cells.iter().map(|r| line(&mut r.iter().map(String::as_str))).collect::<String>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Row {
        name: &'static str,
        error_m: f64,
        each: [f64; 2],
        fell: bool,
    }

    const COLUMNS: &[Column] = &[
        plain("/name", "a|b"),
        fixed("/error_m", "error [mm]", 1).times(1e3),
        scientific("/each", "each", 0),
        plain("/fell", "fell"),
    ];

    fn sheet() -> Sheet {
        let mut sheet = Sheet::titled("Two rows");
        let row = |name, error_m| Row { name, error_m, each: [1.0, 20.0], fell: false };
        sheet.rows("rows", COLUMNS, &[row("x", 0.0123), row("long", f64::NAN)]);
        sheet.fact("mass_kg", 60.9);
        sheet
    }

    #[test]
    fn text_has_its_columns_side_by_side() {
        let text = "Two rows\na|b   error [mm]     each  fell\nx           12.3  1e0 2e1  no\nlong           -  1e0 2e1  no";
        assert_eq!(sheet().text(), text);
    }

    #[test]
    fn markdown_has_a_row_for_a_row() {
        assert!(
            sheet()
                .markdown()
                .ends_with("|---|---|---|---|\n| x | 12.3 | 1e0 2e1 | no |\n| long | - | 1e0 2e1 | no |")
        );
    }

    #[test]
    fn other_programs_find_every_number_as_it_is() {
        let json = sheet().json();
        assert_eq!(json.pointer("/rows/0/error_m"), Some(&Value::from(0.0123)));
        assert_eq!(json.pointer("/rows/1/error_m"), Some(&Value::Null));
        assert_eq!(json.pointer("/mass_kg"), Some(&Value::from(60.9)));
    }
}
