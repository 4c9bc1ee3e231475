//! Records as NumPy arrays: fields by name, with unit and shape.
//!
//! A field is a number or an array of a record: `com` (3), `foot_wrench.force` (2 x 3; right, left), `joint_angle` (the
//! robot's joints). Its name is that of its numbers without their indices.

use std::collections::HashMap;

use messages::fields::{FieldValue, numbers};
use messages::{Field, Record, Visit};
use numpy::{PyArray, PyArrayMethods};
use pyo3::prelude::*;

use crate::arguments::unknown_name;

/// Place of a number that no column takes.
const NOWHERE: u32 = u32::MAX;

/// A field of a record.
#[derive(Clone, Debug)]
pub(crate) struct RecordField {
    /// Name.
    pub(crate) name: String,
    /// Units, one for all numbers or one for each of the last index.
    pub(crate) unit: String,
    /// Shape; empty: a number.
    pub(crate) shape: Vec<usize>,
    /// Counts and codes, which are no measure.
    pub(crate) is_whole: bool,
    /// Places of its numbers in the record, ascending.
    places: Vec<usize>,
}

impl RecordField {
    /// Count of its numbers.
    pub(crate) fn width(&self) -> usize {
        self.places.len()
    }
}

/// The fields of a record type of a robot with these joints.
pub(crate) fn fields<T: Record>(joints: &[String]) -> Vec<RecordField> {
    let index_of: HashMap<&str, usize> =
        joints.iter().enumerate().map(|(j, name)| (name.as_str(), j)).collect();
    let mut found: Vec<(RecordField, Vec<&str>)> = Vec::new();
    let mut by_name: HashMap<String, usize> = HashMap::new();
    for number in numbers(&T::empty(), joints) {
        let (name, indices) = parts(&number.name, &index_of);
        let at = *by_name.entry(name.clone()).or_insert_with(|| {
            let shape = vec![0; indices.len()];
            let is_whole = matches!(number.value, FieldValue::Whole(_));
            let field = RecordField { name, unit: String::new(), shape, is_whole, places: Vec::new() };
            found.push((field, Vec::new()));
            found.len() - 1
        });
        let (field, units) = &mut found[at];
        field.places.push(number.place);
        field.shape.iter_mut().zip(&indices).for_each(|(n, i)| *n = (*n).max(i + 1));
        units.push(number.unit);
    }
    // One unit if all are the same, otherwise those of the last axis.
    let finished = |(mut field, units): (RecordField, Vec<&str>)| {
        let last = *field.shape.last().unwrap_or(&1);
        let differ = units.iter().any(|unit| *unit != units[0]);
        field.unit = if differ { units[..last].join(", ") } else { units[0].to_owned() };
        field
    };
    found.into_iter().map(finished).collect()
}

/// `foot_wrench.left.force[2]` as `foot_wrench.force` and 1, 2.
fn parts(name: &str, joints: &HashMap<&str, usize>) -> (String, Vec<usize>) {
    let (mut words, mut indices) = (Vec::new(), Vec::new());
    for segment in name.split('.') {
        let (word, rest) = segment.split_once('[').unwrap_or((segment, ""));
        match (["right", "left"].iter().position(|side| *side == word), joints.get(word)) {
            (Some(index), _) | (None, Some(&index)) => indices.push(index),
            (None, None) => words.push(word),
        }
        indices.extend(rest.split(['[', ']']).filter_map(|number| number.parse::<usize>().ok()));
    }
    (words.join("."), indices)
}

/// The field of that name.
pub(crate) fn find<'a>(fields: &'a [RecordField], topic: &str, name: &str) -> PyResult<&'a RecordField> {
    fields.iter().find(|field| field.name == name).ok_or_else(|| {
        let known: Vec<&str> = fields.iter().map(|field| field.name.as_str()).collect();
        unknown_name("field", name, &known, &format!("{topic} has {}", known.join(", ")))
    })
}

/// Numbers of some fields, record after record.
pub(crate) struct Columns {
    fields: Vec<RecordField>,
    /// Field that takes the number of a place.
    target: Vec<u32>,
    numbers: Vec<Numbers>,
    rows: usize,
}

/// Numbers of one field.
enum Numbers {
    Real(Vec<f64>),
    Whole(Vec<u64>),
}

impl Columns {
    /// No rows yet.
    pub(crate) fn new(fields: Vec<RecordField>) -> Self {
        let places = fields.iter().flat_map(|field| &field.places).max().map_or(0, |last| last + 1);
        let mut target = vec![NOWHERE; places];
        for (i, field) in fields.iter().enumerate() {
            field.places.iter().for_each(|&place| target[place] = i as u32);
        }
        let none = |field: &RecordField| {
            if field.is_whole { Numbers::Whole(Vec::new()) } else { Numbers::Real(Vec::new()) }
        };
        Self { numbers: fields.iter().map(none).collect(), target, fields, rows: 0 }
    }

    /// Takes a record.
    pub(crate) fn add<T: Field>(&mut self, record: &T) {
        self.rows += 1;
        record.visit(&mut Picker { columns: self, place: 0 });
    }

    /// Count of numbers so far.
    pub(crate) fn len(&self) -> usize {
        self.rows * self.fields.iter().map(RecordField::width).sum::<usize>()
    }

    /// The arrays by their fields, rows first; the memory is handed over and not copied.
    pub(crate) fn arrays<'py>(self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let Self { fields, numbers, rows, .. } = self;
        let array = |(field, numbers): (RecordField, Numbers)| {
            let shape: Vec<usize> = std::iter::once(rows).chain(field.shape).collect();
            let array = match numbers {
                Numbers::Real(x) => PyArray::from_vec(py, x).reshape(shape)?.into_any(),
                Numbers::Whole(n) => PyArray::from_vec(py, n).reshape(shape)?.into_any(),
            };
            Ok((field.name, array))
        };
        fields.into_iter().zip(numbers).map(array).collect()
    }

    /// The only row of the only field: an array, or a number.
    pub(crate) fn value<'py>(self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (_, array) = self.arrays(py)?.remove(0);
        array.get_item(0)
    }

    /// The real numbers of the only field.
    pub(crate) fn reals(&self) -> &[f64] {
        match self.numbers.first() {
            Some(Numbers::Real(x)) => x,
            _ => &[],
        }
    }
}

struct Picker<'a> {
    columns: &'a mut Columns,
    place: usize,
}

impl Picker<'_> {
    fn column(&mut self) -> Option<&mut Numbers> {
        let target = self.columns.target.get(self.place).copied().unwrap_or(NOWHERE);
        self.place += 1;
        self.columns.numbers.get_mut(target as usize)
    }
}

impl Visit for Picker<'_> {
    fn f64(&mut self, value: f64) {
        if let Some(Numbers::Real(column)) = self.column() {
            column.push(value);
        }
    }
    fn u64(&mut self, value: u64) {
        if let Some(Numbers::Whole(column)) = self.column() {
            column.push(value);
        }
    }
    fn u32(&mut self, value: u32) {
        self.u64(value.into());
    }
    fn i32(&mut self, value: i32) {
        self.f64(value.into());
    }
    fn u8(&mut self, value: u8) {
        self.u64(value.into());
    }
}
