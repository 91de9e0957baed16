//! Tables as Parquet: numbers that may be missing are 64-bit floating-point, whole numbers 64-bit integers, words texts. The units are the key
//! `units` of the metadata.

use super::cells::{Cells, Kind, SheetColumn};
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::{ColumnPath, Type};
use std::io::{self, Write};
use std::sync::Arc;

/// Cells that are collected before they are written: 32 MB of numbers.
const GROUP: usize = 1 << 22;

/// Writes a table; rows are collected, since the format stores columns.
pub(super) struct ParquetWriter<W: Write + Send> {
    file: SerializedFileWriter<W>,
    gathered: Vec<Cells>,
    rows: usize,
    /// Numbers of a column that are not missing.
    there: Vec<f64>,
    /// For each row, 1 if the column has a number.
    levels: Vec<i16>,
}

impl<W: Write + Send> ParquetWriter<W> {
    pub fn new(out: W, columns: &[SheetColumn]) -> io::Result<ParquetWriter<W>> {
        let fields = columns.iter().enumerate().map(|(k, column)| Ok(Arc::new(field(k, column)?)));
        let fields = fields.collect::<Result<Vec<_>, ParquetError>>().map_err(into_io)?;
        let schema = Type::group_type_builder("rows").with_fields(fields).build().map_err(into_io)?;
        let units: Vec<&str> = columns.iter().map(|column| column.unit.as_str()).collect();
        let mut properties = WriterProperties::builder()
            .set_created_by(format!("mechc {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(Some(vec![KeyValue::new("units".to_owned(), serde_json::json!(units).to_string())]))
            // few numbers repeat
            .set_dictionary_enabled(false)
            .set_statistics_enabled(EnabledStatistics::Chunk);
        for column in columns.iter().filter(|column| column.kind == Kind::Word) {
            properties = properties.set_column_dictionary_enabled(ColumnPath::new(vec![column.name.clone()]), true);
        }
        let file = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties.build())).map_err(into_io)?;
        let gathered = columns.iter().map(|column| Cells::none(column.kind)).collect();
        Ok(ParquetWriter { file, gathered, rows: 0, there: Vec::new(), levels: Vec::new() })
    }

    /// Writes a row of numbers.
    pub fn row(&mut self, values: &[f64]) -> io::Result<()> {
        for (column, &value) in self.gathered.iter_mut().zip(values) {
            if let Cells::Numbers(numbers) = column {
                numbers.push(value);
            }
        }
        self.gathered(1)
    }

    /// Writes rows, column by column.
    pub fn block(&mut self, cells: Vec<Cells>) -> io::Result<()> {
        let rows = cells.first().map_or(0, Cells::count);
        for pair in self.gathered.iter_mut().zip(cells) {
            match pair {
                (Cells::Whole(all), Cells::Whole(more)) => all.extend(more),
                (Cells::Numbers(all), Cells::Numbers(more)) => all.extend(more),
                (Cells::Words(all), Cells::Words(more)) => all.extend(more),
                _ => return Err(io::Error::other("a column of another kind")),
            }
        }
        self.gathered(rows)
    }

    fn gathered(&mut self, more: usize) -> io::Result<()> {
        self.rows += more;
        if (self.rows + 1) * self.gathered.len() > GROUP { self.write_group() } else { Ok(()) }
    }

    /// Ends the table and returns the writer, flushed.
    pub fn finish(mut self) -> io::Result<W> {
        self.write_group()?;
        let mut out = self.file.into_inner().map_err(into_io)?;
        out.flush()?;
        Ok(out)
    }

    fn write_group(&mut self) -> io::Result<()> {
        if std::mem::take(&mut self.rows) == 0 {
            return Ok(());
        }
        let mut group = self.file.next_row_group().map_err(into_io)?;
        for (k, cells) in self.gathered.iter_mut().enumerate() {
            let Some(mut column) = group.next_column().map_err(into_io)? else { break };
            // the first column has no missing number
            let has_levels = k > 0;
            match cells {
                Cells::Numbers(numbers) => {
                    self.there.clear();
                    self.there.extend(numbers.iter().filter(|value| !has_levels || value.is_finite()));
                    self.levels.clear();
                    self.levels.extend(numbers.iter().map(|value| i16::from(value.is_finite())));
                    write(&mut column, &self.there, has_levels.then_some(self.levels.as_slice()))?;
                    numbers.clear();
                }
                Cells::Whole(numbers) => {
                    write_whole(&mut column, numbers)?;
                    numbers.clear();
                }
                Cells::Words(words) => {
                    write_words(&mut column, words)?;
                    words.clear();
                }
            }
            column.close().map_err(into_io)?;
        }
        group.close().map_err(into_io).map(|_| ())
    }
}

/// Returns a column of the schema; the first one has no missing number.
fn field(k: usize, column: &SheetColumn) -> Result<Type, ParquetError> {
    let builder = |physical| Type::primitive_type_builder(&column.name, physical);
    match column.kind {
        Kind::Whole => builder(Physical::INT64).with_repetition(Repetition::REQUIRED),
        Kind::Number if k == 0 => builder(Physical::DOUBLE).with_repetition(Repetition::REQUIRED),
        Kind::Number => builder(Physical::DOUBLE).with_repetition(Repetition::OPTIONAL),
        Kind::Word => builder(Physical::BYTE_ARRAY)
            .with_logical_type(Some(LogicalType::String))
            .with_repetition(Repetition::REQUIRED),
    }
    .build()
}

fn write(column: &mut SerializedColumnWriter<'_>, numbers: &[f64], levels: Option<&[i16]>) -> io::Result<()> {
    match column.untyped() {
        ColumnWriter::DoubleColumnWriter(column) => {
            column.write_batch(numbers, levels, None).map_err(into_io).map(|_| ())
        }
        _ => Err(io::Error::other("a column of another kind")),
    }
}

fn write_whole(column: &mut SerializedColumnWriter<'_>, numbers: &[u64]) -> io::Result<()> {
    let numbers: Vec<i64> = numbers.iter().map(|&number| i64::try_from(number).unwrap_or(i64::MAX)).collect();
    match column.untyped() {
        ColumnWriter::Int64ColumnWriter(column) => {
            column.write_batch(&numbers, None, None).map_err(into_io).map(|_| ())
        }
        _ => Err(io::Error::other("a column of another kind")),
    }
}

fn write_words(column: &mut SerializedColumnWriter<'_>, words: &[&'static str]) -> io::Result<()> {
    let words: Vec<ByteArray> = words.iter().map(|&word| ByteArray::from(word)).collect();
    match column.untyped() {
        ColumnWriter::ByteArrayColumnWriter(column) => {
            column.write_batch(&words, None, None).map_err(into_io).map(|_| ())
        }
        _ => Err(io::Error::other("a column of another kind")),
    }
}

/// Returns the error of the underlying writer, such as a full disk, with its own text.
fn into_io(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::{GROUP, Kind, ParquetWriter, SheetColumn};
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    fn read(bytes: Vec<u8>) -> SerializedFileReader<bytes::Bytes> {
        SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap()
    }

    /// Returns columns of numbers.
    fn columns(columns: &[(&str, &str)]) -> Vec<SheetColumn> {
        let column = |(name, unit): &(&str, &str)| SheetColumn {
            name: (*name).to_owned(),
            unit: (*unit).to_owned(),
            kind: Kind::Number,
        };
        columns.iter().map(column).collect()
    }

    #[test]
    fn what_is_written_reads_back_to_the_same_bits() {
        let columns = columns(&[("t", "s"), ("rod.phi.dd", "rad/s^2")]);
        let mut writer = ParquetWriter::new(Vec::new(), &columns).unwrap();
        let rows = [[0.0, 0.1 + 0.2], [1.0, -5e-324], [2.0, f64::MAX]];
        for row in &rows {
            writer.row(row).unwrap();
        }
        let reader = read(writer.finish().unwrap());
        let schema = reader.metadata().file_metadata().schema_descr();
        let names: Vec<String> = schema.columns().iter().map(|column| column.name().to_owned()).collect();
        assert_eq!(names, ["t", "rod.phi.dd"]);
        let read_back: Vec<[u64; 2]> = reader
            .get_row_iter(None)
            .unwrap()
            .map(|row| row.unwrap())
            .map(|row| [0, 1].map(|k| row.get_double(k).unwrap().to_bits()))
            .collect();
        assert_eq!(read_back, rows.map(|row| row.map(f64::to_bits)));
    }

    #[test]
    fn the_units_are_metadata() {
        let writer = ParquetWriter::new(Vec::new(), &columns(&[("t", "s"), ("lift", "mm")])).unwrap();
        let reader = read(writer.finish().unwrap());
        let pairs = reader.metadata().file_metadata().key_value_metadata().unwrap();
        let units = pairs.iter().find(|pair| pair.key == "units").unwrap();
        assert_eq!(units.value.as_deref(), Some(r#"["s","mm"]"#));
    }

    #[test]
    fn what_is_missing_is_null() {
        let mut writer = ParquetWriter::new(Vec::new(), &columns(&[("t", "s"), ("gain", "1")])).unwrap();
        for row in [[0.0, 1.5], [1.0, f64::NAN], [2.0, f64::INFINITY], [3.0, 2.5]] {
            writer.row(&row).unwrap();
        }
        let reader = read(writer.finish().unwrap());
        let read_back: Vec<Option<f64>> =
            reader.get_row_iter(None).unwrap().map(|row| row.unwrap().get_double(1).ok()).collect();
        assert_eq!(read_back, [Some(1.5), None, None, Some(2.5)]);
    }

    #[test]
    fn a_long_table_is_written_in_groups() {
        let names: Vec<String> = (0..1000).map(|k| format!("c{k}")).collect();
        let columns = columns(&names.iter().map(|name| (name.as_str(), "1")).collect::<Vec<_>>());
        let mut writer = ParquetWriter::new(Vec::new(), &columns).unwrap();
        let row: Vec<f64> = (0..1000).map(f64::from).collect();
        let rows = GROUP / 1000 + 10;
        (0..rows).for_each(|_| writer.row(&row).unwrap());
        let reader = read(writer.finish().unwrap());
        assert_eq!(reader.num_row_groups(), 2);
        assert_eq!(reader.metadata().file_metadata().num_rows(), i64::try_from(rows).unwrap());
    }

    #[test]
    fn a_table_without_rows_is_a_table() {
        let reader = read(ParquetWriter::new(Vec::new(), &columns(&[("t", "s")])).unwrap().finish().unwrap());
        assert_eq!(reader.metadata().file_metadata().num_rows(), 0);
    }
}
