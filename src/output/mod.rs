//! Result tables as text.
//!
//! Numbers are written as the shortest decimal that reads back to the same `f64`.

use std::io::{self, Write};

/// The forms of a result table.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum TableFormat {
    /// A header, then a row per time.
    #[default]
    Csv,
    /// `{"columns": […], "rows": [[…], …]}`
    Json,
}

/// Writes a table row by row.
pub struct TableWriter<W: Write> {
    out: W,
    format: TableFormat,
    number: zmij::Buffer,
    rows: u64,
}

impl<W: Write> TableWriter<W> {
    /// Begins a table with its columns' names.
    ///
    /// # Errors
    /// As the writer underneath.
    pub fn new(mut out: W, format: TableFormat, columns: &[String]) -> io::Result<TableWriter<W>> {
        match format {
            // a name holds neither comma nor quote
            TableFormat::Csv => writeln!(out, "{}", columns.join(","))?,
            TableFormat::Json => write!(out, "{{\"columns\": {}, \"rows\": [", serde_json::json!(columns))?,
        }
        Ok(TableWriter { out, format, number: zmij::Buffer::new(), rows: 0 })
    }

    /// Writes a row of finite numbers.
    ///
    /// # Errors
    /// As the writer underneath.
    pub fn row(&mut self, values: &[f64]) -> io::Result<()> {
        if self.format == TableFormat::Json {
            self.out.write_all(if self.rows == 0 { b"\n[" } else { b",\n[" })?;
        }
        self.rows += 1;
        for (k, &value) in values.iter().enumerate() {
            if k > 0 {
                self.out.write_all(b",")?;
            }
            self.out.write_all(self.number.format_finite(value).as_bytes())?;
        }
        self.out.write_all(match self.format {
            TableFormat::Csv => b"\n",
            TableFormat::Json => b"]",
        })
    }

    /// Ends the table and gives the writer back, flushed.
    ///
    /// # Errors
    /// As the writer underneath.
    pub fn finish(mut self) -> io::Result<W> {
        if self.format == TableFormat::Json {
            self.out.write_all(b"\n]}\n")?;
        }
        self.out.flush()?;
        Ok(self.out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(format: TableFormat, rows: &[&[f64]]) -> String {
        let columns = ["t".to_owned(), "a.x".to_owned()];
        let mut writer = TableWriter::new(Vec::new(), format, &columns).unwrap();
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
    fn json_is_json() {
        let text = written(TableFormat::Json, &[&[0.0, 1.5], &[1.0, -2e30]]);
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(value["columns"][1], "a.x");
        assert_eq!(value["rows"][1][1], -2e30);
        let empty: serde_json::Value = serde_json::from_str(&written(TableFormat::Json, &[])).unwrap();
        assert_eq!(empty["rows"].as_array().unwrap().len(), 0);
    }
}
