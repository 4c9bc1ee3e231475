//! `table.parquet` of a sweep: all rows in the order of the walks, the same bytes whoever walked them.

use std::fmt::Display;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;

use super::columns::{Cell, CellType};

/// Rows that are in memory at a time.
const GROUP: usize = 65_536;

/// A table that is being written.
pub(super) struct Table {
    writer: SerializedFileWriter<File>,
    columns: Vec<(String, CellType)>,
    waiting: Vec<Vec<Cell>>,
    path: PathBuf,
}

impl Table {
    /// An empty table; one that was there stays until this one is whole.
    ///
    /// # Errors
    /// It cannot be written there.
    pub(super) fn create(path: &Path, columns: &[(String, CellType)]) -> Result<Self, String> {
        let fields = columns.iter().map(|(name, of)| field(name, *of).map(Arc::new));
        let begin = || {
            let fields = fields.collect::<Result<Vec<_>, _>>()?;
            let schema = Type::group_type_builder("sweep").with_fields(fields).build()?;
            let properties = WriterProperties::builder().set_created_by("gangwerk sweep".into()).build();
            SerializedFileWriter::new(File::create(beside(path))?, Arc::new(schema), Arc::new(properties))
        };
        let writer = begin().map_err(|e| problem(path, e))?;
        Ok(Self { writer, columns: columns.into(), waiting: Vec::new(), path: path.into() })
    }

    /// Adds a row.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn push(&mut self, row: Vec<Cell>) -> Result<(), String> {
        self.waiting.push(row);
        if self.waiting.len() < GROUP { Ok(()) } else { self.write().map_err(|e| problem(&self.path, e)) }
    }

    /// Puts the table in its place.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn finish(mut self) -> Result<(), String> {
        self.write().map_err(|e| problem(&self.path, e))?;
        self.writer.close().map_err(|e| problem(&self.path, e))?;
        std::fs::rename(beside(&self.path), &self.path).map_err(|e| problem(&self.path, e))
    }

    /// What waits as a group of rows, column by column.
    fn write(&mut self) -> Result<(), ParquetError> {
        let mut group = self.writer.next_row_group()?;
        let mut k = 0;
        while let Some(mut column) = group.next_column()? {
            fill(&mut column, self.columns[k].1, self.waiting.iter().map(|row| &row[k]))?;
            column.close()?;
            k += 1;
        }
        group.close()?;
        self.waiting.clear();
        Ok(())
    }
}

fn beside(path: &Path) -> PathBuf {
    path.with_extension("parquet.part")
}

fn problem(path: &Path, e: impl Display) -> String {
    format!("{}: {e}; the rows are there, so make room and start the sweep again", path.display())
}

/// A column of the schema.
fn field(name: &str, of: CellType) -> Result<Type, ParquetError> {
    let (physical, logical, repetition) = match of {
        CellType::Whole => (Physical::INT64, None, Repetition::REQUIRED),
        CellType::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String), Repetition::REQUIRED),
        CellType::YesNo => (Physical::BOOLEAN, None, Repetition::REQUIRED),
        CellType::Number => (Physical::DOUBLE, None, Repetition::OPTIONAL),
    };
    let field = Type::primitive_type_builder(name, physical).with_logical_type(logical);
    field.with_repetition(repetition).build()
}

fn fill<'r>(
    column: &mut SerializedColumnWriter<'_>,
    of: CellType,
    cells: impl Iterator<Item = &'r Cell>,
) -> Result<(), ParquetError> {
    match of {
        CellType::Whole => {
            let whole = |cell: &Cell| if let Cell::Whole(n) = cell { *n as i64 } else { 0 };
            column.typed::<Int64Type>().write_batch(&cells.map(whole).collect::<Vec<_>>(), None, None)?;
        }
        CellType::Text => {
            let text = |cell: &Cell| match cell {
                Cell::Text(text) => ByteArray::from(text.as_str()),
                _ => ByteArray::from(""),
            };
            column.typed::<ByteArrayType>().write_batch(&cells.map(text).collect::<Vec<_>>(), None, None)?;
        }
        CellType::YesNo => {
            let yes = |cell: &Cell| matches!(cell, Cell::YesNo(true));
            column.typed::<BoolType>().write_batch(&cells.map(yes).collect::<Vec<_>>(), None, None)?;
        }
        // Nulls have a level and no value.
        CellType::Number => {
            let number = |cell: &Cell| if let Cell::Number(x) = cell { *x } else { None };
            let all: Vec<Option<f64>> = cells.map(number).collect();
            let there: Vec<f64> = all.iter().flatten().copied().collect();
            let levels: Vec<i16> = all.iter().map(|x| i16::from(x.is_some())).collect();
            column.typed::<DoubleType>().write_batch(&there, Some(&levels), None)?;
        }
    }
    Ok(())
}
