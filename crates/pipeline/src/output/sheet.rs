//! Tables of variants: columns of whole numbers, numbers and words, written block by block. Any thread can format a block; the writer keeps the
//! order.

use super::TableFormat;
use super::cells::{Cells, SheetColumn};
use super::text::quoted;
use std::io::{self, Write};

#[cfg(feature = "parquet")]
use super::parquet::ParquetWriter;

/// Columns and format of a table: CSV, JSON lines, or Parquet.
#[derive(Clone, Debug)]
pub struct Sheet {
    format: TableFormat,
    columns: Vec<SheetColumn>,
    /// For each column, the text before its cell in a line.
    before: Vec<String>,
}

/// A formatted block.
pub enum Made {
    /// Text of the lines.
    Text(Vec<u8>),
    /// Columns.
    Cells(Vec<Cells>),
}

impl Sheet {
    /// Makes a table of columns.
    #[must_use]
    pub fn new(format: TableFormat, columns: Vec<SheetColumn>) -> Sheet {
        let before = |(k, column): (usize, &SheetColumn)| {
            if format == TableFormat::Json {
                let key = serde_json::Value::from(column.name.as_str());
                format!("{}{key}:", if k > 0 { "," } else { "{" })
            } else {
                (if k > 0 { "," } else { "" }).to_owned()
            }
        };
        Sheet { before: columns.iter().enumerate().map(before).collect(), format, columns }
    }

    /// Returns the columns.
    #[must_use]
    pub fn columns(&self) -> &[SheetColumn] {
        &self.columns
    }

    /// Formats a block, given by the cells of all columns.
    #[must_use]
    #[cfg_attr(not(feature = "parquet"), allow(clippy::needless_pass_by_value))] // Parquet keeps them
    pub fn made(&self, cells: Vec<Cells>) -> Made {
        match self.format {
            TableFormat::Csv | TableFormat::Json => Made::Text(self.text(&cells)),
            #[cfg(feature = "parquet")]
            TableFormat::Parquet => Made::Cells(cells),
        }
    }

    fn text(&self, cells: &[Cells]) -> Vec<u8> {
        let (is_json, rows) = (self.format == TableFormat::Json, cells.first().map_or(0, Cells::count));
        let mut text = Vec::with_capacity(rows * cells.len() * 16);
        let mut number = zmij::Buffer::new();
        for row in 0..rows {
            for (before, cells) in self.before.iter().zip(cells) {
                text.extend_from_slice(before.as_bytes());
                match cells {
                    // as text, so that whole numbers beyond 2^53 are exact
                    Cells::Whole(cells) => text.extend_from_slice(cells[row].to_string().as_bytes()),
                    Cells::Numbers(cells) if cells[row].is_finite() => {
                        text.extend_from_slice(number.format_finite(cells[row]).as_bytes());
                    }
                    Cells::Numbers(_) => text.extend_from_slice(if is_json { b"null" } else { b"" }),
                    Cells::Words(cells) if is_json => {
                        text.push(b'"');
                        text.extend_from_slice(cells[row].as_bytes());
                        text.push(b'"');
                    }
                    Cells::Words(cells) => text.extend_from_slice(cells[row].as_bytes()),
                }
            }
            text.extend_from_slice(if is_json { b"}\n" } else { b"\n" });
        }
        text
    }
}

/// Writes a table block by block.
pub struct SheetWriter<W: Write + Send> {
    form: Form<W>,
}

enum Form<W: Write + Send> {
    Text(W),
    #[cfg(feature = "parquet")]
    Parquet(Box<ParquetWriter<W>>),
}

impl<W: Write + Send> SheetWriter<W> {
    /// Begins a table; only Parquet has units.
    ///
    /// # Errors
    /// The underlying writer fails.
    pub fn new(mut out: W, sheet: &Sheet) -> io::Result<SheetWriter<W>> {
        let form = match sheet.format {
            TableFormat::Csv => {
                let names: Vec<String> = sheet.columns.iter().map(|column| quoted(&column.name)).collect();
                writeln!(out, "{}", names.join(","))?;
                Form::Text(out)
            }
            TableFormat::Json => Form::Text(out),
            #[cfg(feature = "parquet")]
            TableFormat::Parquet => Form::Parquet(Box::new(ParquetWriter::new(out, &sheet.columns)?)),
        };
        Ok(SheetWriter { form })
    }

    /// Writes a block.
    ///
    /// # Errors
    /// The underlying writer fails.
    pub fn write(&mut self, block: Made) -> io::Result<()> {
        match (&mut self.form, block) {
            (Form::Text(out), Made::Text(text)) => out.write_all(&text),
            #[cfg(feature = "parquet")]
            (Form::Parquet(parquet), Made::Cells(cells)) => parquet.block(cells),
            _ => Err(io::Error::other("a block of another form")),
        }
    }

    /// Ends the table and returns the writer, flushed.
    ///
    /// # Errors
    /// The underlying writer fails.
    pub fn finish(self) -> io::Result<W> {
        match self.form {
            Form::Text(mut out) => {
                out.flush()?;
                Ok(out)
            }
            #[cfg(feature = "parquet")]
            Form::Parquet(parquet) => parquet.finish(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Cells, Sheet, SheetColumn, SheetWriter};
    use crate::output::{Kind, TableFormat};

    fn sheet(format: TableFormat) -> Sheet {
        let column = |name: &str, unit: &str, kind| SheetColumn { name: name.to_owned(), unit: unit.to_owned(), kind };
        let columns = vec![
            column("variant", "1", Kind::Whole),
            column("rod", "m", Kind::Number),
            column("at (1, 2)", "1", Kind::Number),
            column("status", "1", Kind::Word),
        ];
        Sheet::new(format, columns)
    }

    fn written(format: TableFormat) -> Vec<u8> {
        let sheet = sheet(format);
        let mut writer = SheetWriter::new(Vec::new(), &sheet).unwrap();
        for first in [0, 2] {
            let cells = vec![
                Cells::Whole(vec![first, first + 1]),
                Cells::Numbers(vec![0.1, f64::NAN]),
                Cells::Numbers(vec![-2.0, f64::INFINITY]),
                Cells::Words(vec!["ok", "E0602"]),
            ];
            writer.write(sheet.made(cells)).unwrap();
        }
        writer.finish().unwrap()
    }

    #[test]
    fn csv_has_a_line_for_each_row() {
        let text = String::from_utf8(written(TableFormat::Csv)).unwrap();
        let expected = "variant,rod,\"at (1, 2)\",status\n0,0.1,-2.0,ok\n1,,,E0602\n2,0.1,-2.0,ok\n3,,,E0602\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn json_has_an_object_a_line() {
        let text = String::from_utf8(written(TableFormat::Json)).unwrap();
        let lines: Vec<serde_json::Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
        assert_eq!(lines.len(), 4);
        assert_eq!(lines[2], serde_json::json!({"variant": 2, "rod": 0.1, "at (1, 2)": -2.0, "status": "ok"}));
        assert_eq!(lines[1]["rod"], serde_json::Value::Null);
    }

    #[test]
    #[cfg(feature = "parquet")]
    fn parquet_has_whole_numbers_and_words() {
        use parquet::file::reader::{FileReader, SerializedFileReader};
        use parquet::record::RowAccessor;
        let reader = SerializedFileReader::new(bytes::Bytes::from(written(TableFormat::Parquet))).unwrap();
        let rows: Vec<_> = reader.get_row_iter(None).unwrap().map(|row| row.unwrap()).collect();
        assert_eq!(rows.iter().map(|row| row.get_long(0).unwrap()).collect::<Vec<_>>(), [0, 1, 2, 3]);
        assert_eq!(rows[1].get_double(1).ok(), None);
        assert_eq!(rows[2].get_double(1).ok(), Some(0.1));
        assert_eq!(
            rows.iter().map(|row| row.get_string(3).unwrap().as_str()).collect::<Vec<_>>(),
            ["ok", "E0602", "ok", "E0602"]
        );
    }

    #[test]
    fn a_sheet_without_rows_is_a_table() {
        for format in [TableFormat::Csv, TableFormat::Json] {
            let sheet = sheet(format);
            let text = SheetWriter::new(Vec::new(), &sheet).and_then(SheetWriter::finish).unwrap();
            assert_eq!(String::from_utf8(text).unwrap().lines().count(), usize::from(format == TableFormat::Csv));
        }
    }
}
