//! `table.parquet` of a sweep: all rows in the order of the walks, the same bytes whoever walked them.

use std::path::Path;
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;

use super::columns::{Cell, CellType};

/// Writes rows as a table of these columns; a table that was there stays until the new one is whole.
///
/// # Errors
/// It cannot be written there.
pub(super) fn write<'r>(
    path: &Path,
    columns: &[(String, CellType)],
    rows: impl Iterator<Item = &'r Vec<Cell>> + Clone,
) -> Result<(), String> {
    let beside = path.with_extension("parquet.part");
    let problem =
        |e: String| format!("{}: {e}; the rows are there, so start the sweep again", path.display());
    written(&beside, columns, rows).map_err(|e| problem(e.to_string()))?;
    std::fs::rename(&beside, path).map_err(|e| problem(e.to_string()))
}

fn written<'r>(
    path: &Path,
    columns: &[(String, CellType)],
    rows: impl Iterator<Item = &'r Vec<Cell>> + Clone,
) -> Result<(), ParquetError> {
    let fields = columns.iter().map(|(name, of)| field(name, *of).map(Arc::new));
    let fields = fields.collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("sweep").with_fields(fields).build()?;
    let properties = WriterProperties::builder().set_created_by("gangwerk sweep".into()).build();
    let file = std::fs::File::create(path)?;
    let mut writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    let mut k = 0;
    while let Some(mut column) = group.next_column()? {
        let cells = rows.clone().map(|row| &row[k]);
        fill(&mut column, columns[k].1, cells)?;
        column.close()?;
        k += 1;
    }
    group.close()?;
    writer.close()?;
    Ok(())
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
