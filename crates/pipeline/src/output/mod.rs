//! Result tables: as text, in which numbers are the shortest decimals that read back to the same `f64`, and as Parquet with the feature `parquet`.

mod cells;
#[cfg(feature = "parquet")]
mod parquet;
mod sheet;
mod text;

pub use cells::{Cells, Kind, SheetColumn};
#[cfg(feature = "parquet")]
use parquet::ParquetWriter;
pub use sheet::{Made, Sheet, SheetWriter};
use std::io::{self, Write};
use text::TextWriter;

/// The format of a result table.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum TableFormat {
    /// A header, then a line for each row.
    #[default]
    Csv,
    /// `{"columns": […], "units": […], "rows": [[…], …]}`
    Json,
    /// Apache Parquet, for programs that read tables by columns.
    #[cfg(feature = "parquet")]
    Parquet,
}

/// Writes a table row by row.
pub struct TableWriter<W: Write + Send> {
    form: Form<W>,
}

enum Form<W: Write + Send> {
    Text(Box<TextWriter<W>>),
    #[cfg(feature = "parquet")]
    Parquet(Box<ParquetWriter<W>>),
}

impl<W: Write + Send> TableWriter<W> {
    /// Begins a table with the names and units of its columns; CSV has no units.
    ///
    /// # Errors
    /// The underlying writer fails.
    pub fn new(out: W, format: TableFormat, columns: &[String], units: &[&str]) -> io::Result<TableWriter<W>> {
        let form = match format {
            TableFormat::Csv => Form::Text(Box::new(TextWriter::csv(out, columns)?)),
            TableFormat::Json => Form::Text(Box::new(TextWriter::json(out, columns, units)?)),
            #[cfg(feature = "parquet")]
            TableFormat::Parquet => {
                let column = |(name, unit): (&String, &&str)| SheetColumn {
                    name: name.clone(),
                    unit: (*unit).to_owned(),
                    kind: Kind::Number,
                };
                let columns: Vec<SheetColumn> = columns.iter().zip(units).map(column).collect();
                Form::Parquet(Box::new(ParquetWriter::new(out, &columns)?))
            }
        };
        Ok(TableWriter { form })
    }

    /// Writes a row; values that are not finite are missing.
    ///
    /// # Errors
    /// The underlying writer fails.
    pub fn row(&mut self, values: &[f64]) -> io::Result<()> {
        match &mut self.form {
            Form::Text(text) => text.row(values),
            #[cfg(feature = "parquet")]
            Form::Parquet(parquet) => parquet.row(values),
        }
    }

    /// Ends the table and returns the writer, flushed.
    ///
    /// # Errors
    /// The underlying writer fails.
    pub fn finish(self) -> io::Result<W> {
        match self.form {
            Form::Text(text) => text.finish(),
            #[cfg(feature = "parquet")]
            Form::Parquet(parquet) => parquet.finish(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(format: TableFormat, rows: &[&[f64]]) -> String {
        let columns = ["t".to_owned(), "a.x".to_owned()];
        let mut writer = TableWriter::new(Vec::new(), format, &columns, &["s", "mm"]).unwrap();
        for row in rows {
            writer.row(row).unwrap();
        }
        String::from_utf8(writer.finish().unwrap()).unwrap()
    }

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        let values = [0.1 + 0.2, 1e-300, -5e-324, f64::MAX, 3.0];
        let text = written(TableFormat::Csv, &[&values[..2], &values[2..4]]);
        let read: Vec<f64> =
            text.lines().skip(1).flat_map(|line| line.split(',')).map(|n| n.parse().unwrap()).collect();
        assert_eq!(read, values[..4]);
    }

    #[test]
    fn what_is_missing_is_an_empty_cell_or_null() {
        let rows: &[&[f64]] = &[&[0.0, f64::NAN], &[1.0, f64::INFINITY], &[2.0, 1.5]];
        assert_eq!(written(TableFormat::Csv, rows), "t,a.x\n0.0,\n1.0,\n2.0,1.5\n");
        let value: serde_json::Value = serde_json::from_str(&written(TableFormat::Json, rows)).unwrap();
        assert_eq!(value["rows"], serde_json::json!([[0.0, null], [1.0, null], [2.0, 1.5]]));
    }

    #[test]
    fn rows_beyond_what_is_written_at_once_come_in_order() {
        let rows: Vec<[f64; 2]> = (0..50_000).map(|k| [f64::from(k), 0.1 * f64::from(k)]).collect();
        let rows: Vec<&[f64]> = rows.iter().map(<[f64; 2]>::as_slice).collect();
        let text = written(TableFormat::Csv, &rows);
        let read = text.lines().skip(1).map(|line| line.split(',').map(|n| n.parse().unwrap()).collect::<Vec<f64>>());
        assert!(read.eq(rows.iter().map(|row| row.to_vec())));
        let value: serde_json::Value = serde_json::from_str(&written(TableFormat::Json, &rows)).unwrap();
        assert_eq!(value["rows"].as_array().unwrap().len(), rows.len());
        assert_eq!(value["rows"][49_999][0], 49_999.0);
    }

    #[test]
    fn json_is_json() {
        let text = written(TableFormat::Json, &[&[0.0, 1.5], &[1.0, -2e30]]);
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(value["columns"][1], "a.x");
        assert_eq!(value["units"], serde_json::json!(["s", "mm"]));
        assert_eq!(value["rows"][1][1], -2e30);
        let empty: serde_json::Value = serde_json::from_str(&written(TableFormat::Json, &[])).unwrap();
        assert_eq!(empty["rows"].as_array().unwrap().len(), 0);
    }
}
