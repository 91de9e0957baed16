//! A result table as Parquet: a column of 64-bit floating-point numbers for each of its own, with their units as
//! the key `units` of its metadata. All but the first, the time, may
//! miss some.

use parquet::basic::{Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::io::{self, Write};
use std::sync::Arc;

/// Numbers that are gathered before they are written: 128 MB.
const GROUP: usize = 1 << 24;

/// Writes a table; rows are gathered, since the format stores column after column.
pub(super) struct ParquetWriter<W: Write + Send> {
    file: SerializedFileWriter<W>,
    columns: usize,
    /// Row after row.
    gathered: Vec<f64>,
    column: Vec<f64>,
    /// By row: 1 where the column has a number.
    levels: Vec<i16>,
}

impl<W: Write + Send> ParquetWriter<W> {
    pub fn new(out: W, columns: &[String], units: &[&str]) -> io::Result<ParquetWriter<W>> {
        let field = |(k, name): (usize, &String)| {
            let column = Type::primitive_type_builder(name, Physical::DOUBLE);
            let repetition = if k == 0 { Repetition::REQUIRED } else { Repetition::OPTIONAL };
            Ok(Arc::new(column.with_repetition(repetition).build()?))
        };
        let fields =
            columns.iter().enumerate().map(field).collect::<Result<Vec<_>, ParquetError>>().map_err(into_io)?;
        let schema = Type::group_type_builder("rows").with_fields(fields).build().map_err(into_io)?;
        let properties = WriterProperties::builder()
            .set_created_by(format!("mechc {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(Some(vec![KeyValue::new("units".to_owned(), serde_json::json!(units).to_string())]))
            // hardly any number comes twice
            .set_dictionary_enabled(false)
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .build();
        let file = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties)).map_err(into_io)?;
        Ok(ParquetWriter { file, columns: columns.len(), gathered: Vec::new(), column: Vec::new(), levels: Vec::new() })
    }

    pub fn row(&mut self, values: &[f64]) -> io::Result<()> {
        self.gathered.extend_from_slice(values);
        if self.gathered.len() + self.columns > GROUP { self.write_group() } else { Ok(()) }
    }

    /// Ends the table and gives the writer back, flushed.
    pub fn finish(mut self) -> io::Result<W> {
        self.write_group()?;
        let mut out = self.file.into_inner().map_err(into_io)?;
        out.flush()?;
        Ok(out)
    }

    fn write_group(&mut self) -> io::Result<()> {
        if self.gathered.is_empty() {
            return Ok(());
        }
        let mut group = self.file.next_row_group().map_err(into_io)?;
        let mut k = 0;
        while let Some(mut column) = group.next_column().map_err(into_io)? {
            self.column.clear();
            let values = self.gathered.iter().copied().skip(k).step_by(self.columns);
            self.levels.clear();
            if k > 0 {
                self.levels.extend(values.clone().map(|value| i16::from(value.is_finite())));
                self.column.extend(values.filter(|value| value.is_finite()));
            } else {
                self.column.extend(values);
            }
            let levels = (k > 0).then_some(self.levels.as_slice());
            column.typed::<DoubleType>().write_batch(&self.column, levels, None).map_err(into_io)?;
            column.close().map_err(into_io)?;
            k += 1;
        }
        group.close().map_err(into_io)?;
        self.gathered.clear();
        Ok(())
    }
}

/// What went wrong underneath, a full disk say, as it was told there.
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
    use super::{GROUP, ParquetWriter};
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::RowAccessor;

    fn read(bytes: Vec<u8>) -> SerializedFileReader<bytes::Bytes> {
        SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap()
    }

    #[test]
    fn what_is_written_reads_back_to_the_same_bits() {
        let columns = ["t".to_owned(), "rod.phi.dd".to_owned()];
        let mut writer = ParquetWriter::new(Vec::new(), &columns, &[]).unwrap();
        let rows = [[0.0, 0.1 + 0.2], [1.0, -5e-324], [2.0, f64::MAX]];
        for row in &rows {
            writer.row(row).unwrap();
        }
        let reader = read(writer.finish().unwrap());
        let schema = reader.metadata().file_metadata().schema_descr();
        let names: Vec<String> = schema.columns().iter().map(|column| column.name().to_owned()).collect();
        assert_eq!(names, columns);
        let found: Vec<[u64; 2]> = reader
            .get_row_iter(None)
            .unwrap()
            .map(|row| row.unwrap())
            .map(|row| [0, 1].map(|k| row.get_double(k).unwrap().to_bits()))
            .collect();
        assert_eq!(found, rows.map(|row| row.map(f64::to_bits)));
    }

    #[test]
    fn the_units_are_metadata() {
        let columns = ["t".to_owned(), "lift".to_owned()];
        let writer = ParquetWriter::new(Vec::new(), &columns, &["s", "mm"]).unwrap();
        let reader = read(writer.finish().unwrap());
        let pairs = reader.metadata().file_metadata().key_value_metadata().unwrap();
        let units = pairs.iter().find(|pair| pair.key == "units").unwrap();
        assert_eq!(units.value.as_deref(), Some(r#"["s","mm"]"#));
    }

    #[test]
    fn what_is_missing_is_null() {
        let columns = ["t".to_owned(), "gain".to_owned()];
        let mut writer = ParquetWriter::new(Vec::new(), &columns, &[]).unwrap();
        for row in [[0.0, 1.5], [1.0, f64::NAN], [2.0, f64::INFINITY], [3.0, 2.5]] {
            writer.row(&row).unwrap();
        }
        let reader = read(writer.finish().unwrap());
        let found: Vec<Option<f64>> =
            reader.get_row_iter(None).unwrap().map(|row| row.unwrap().get_double(1).ok()).collect();
        assert_eq!(found, [Some(1.5), None, None, Some(2.5)]);
    }

    #[test]
    fn a_long_table_is_written_in_groups() {
        let columns: Vec<String> = (0..1000).map(|k| format!("c{k}")).collect();
        let mut writer = ParquetWriter::new(Vec::new(), &columns, &[]).unwrap();
        let row: Vec<f64> = (0..1000).map(f64::from).collect();
        let rows = GROUP / 1000 + 10;
        (0..rows).for_each(|_| writer.row(&row).unwrap());
        let reader = read(writer.finish().unwrap());
        assert_eq!(reader.num_row_groups(), 2);
        assert_eq!(reader.metadata().file_metadata().num_rows(), i64::try_from(rows).unwrap());
    }

    #[test]
    fn a_table_without_rows_is_a_table() {
        let reader = read(ParquetWriter::new(Vec::new(), &["t".to_owned()], &[]).unwrap().finish().unwrap());
        assert_eq!(reader.metadata().file_metadata().num_rows(), 0);
    }
}
