//! Tables as CSV or JSON: rows are collected and formatted in blocks, by several threads if there are many.

use mechc_parallel::{OrderedPipeline, default_jobs};
use std::io::{self, Write};
use std::mem;

/// Numbers that are formatted at once: 64 kB of them, twice that of text.
const AT_ONCE: usize = 1 << 13;
/// This many threads format text as fast as one thread computes rows.
const MAX_JOBS: usize = 4;
/// Numbers that are formatted side by side: each is copied after the processor has stored its digits.
const BATCH: usize = 8;

/// Returns the name of a column in CSV. Names hold no quotes; those of pairs hold a comma (RFC 4180).
pub(super) fn quoted(name: &str) -> String {
    if name.contains(',') { format!("\"{name}\"") } else { name.to_owned() }
}

/// Writes a table as text, row by row.
pub(super) struct TextWriter<W> {
    out: W,
    marks: Marks,
    /// Rows that are not formatted yet.
    gathered: Rows,
    /// Formats rows on other threads; made for the second block, as most tables are small.
    relay: Option<OrderedPipeline<Rows, Vec<u8>>>,
    has_rows: bool,
}

/// Numbers of rows.
#[derive(Default)]
struct Rows {
    numbers: Vec<f64>,
    count: usize,
}

/// Text around numbers.
#[derive(Clone, Copy)]
struct Marks {
    /// Text before and after a row.
    row: [&'static str; 2],
    /// Text in place of a number that is not finite.
    missing: &'static str,
}

const CSV: Marks = Marks { row: ["", "\n"], missing: "" };
const JSON: Marks = Marks { row: [",\n[", "]"], missing: "null" };

impl<W: Write> TextWriter<W> {
    pub fn csv(mut out: W, columns: &[String]) -> io::Result<TextWriter<W>> {
        writeln!(out, "{}", columns.iter().map(|name| quoted(name)).collect::<Vec<_>>().join(","))?;
        Ok(TextWriter::new(out, CSV))
    }

    pub fn json(mut out: W, columns: &[String], units: &[&str]) -> io::Result<TextWriter<W>> {
        let [columns, units] = [serde_json::json!(columns), serde_json::json!(units)];
        write!(out, "{{\"columns\": {columns}, \"units\": {units}, \"rows\": [")?;
        Ok(TextWriter::new(out, JSON))
    }

    fn new(out: W, marks: Marks) -> TextWriter<W> {
        TextWriter { out, marks, gathered: Rows::default(), relay: None, has_rows: false }
    }

    pub fn row(&mut self, values: &[f64]) -> io::Result<()> {
        self.gathered.numbers.extend_from_slice(values);
        self.gathered.count += 1;
        if self.gathered.numbers.len() < AT_ONCE { Ok(()) } else { self.make_text() }
    }

    /// Formats the collected rows, and writes what is ready.
    fn make_text(&mut self) -> io::Result<()> {
        let next = Rows { numbers: Vec::with_capacity(self.gathered.numbers.len()), count: 0 };
        let rows = mem::replace(&mut self.gathered, next);
        if let Some(relay) = &mut self.relay {
            let text = relay.give(rows);
            return text.map_or(Ok(()), |text| self.write(&text));
        }
        let marks = self.marks;
        self.relay = Some(OrderedPipeline::new(default_jobs().min(MAX_JOBS), move |rows: Rows| marks.text(&rows)));
        self.write(&marks.text(&rows))
    }

    fn write(&mut self, text: &[u8]) -> io::Result<()> {
        // the first row of JSON has no separator before it
        let is_first = !mem::replace(&mut self.has_rows, true);
        self.out.write_all(text.strip_prefix(b",").filter(|_| is_first && self.marks.is_json()).unwrap_or(text))
    }

    pub fn finish(mut self) -> io::Result<W> {
        while let Some(text) = self.relay.as_mut().and_then(OrderedPipeline::take) {
            self.write(&text)?;
        }
        if self.gathered.count > 0 {
            self.write(&self.marks.text(&self.gathered))?;
        }
        if self.marks.is_json() {
            self.out.write_all(b"\n]}\n")?;
        }
        self.out.flush()?;
        Ok(self.out)
    }
}

impl Marks {
    fn is_json(self) -> bool {
        !self.row[0].is_empty()
    }

    /// Formats rows.
    fn text(self, rows: &Rows) -> Vec<u8> {
        let width = rows.numbers.len().checked_div(rows.count).unwrap_or(0);
        let mut text = Vec::with_capacity(rows.numbers.len() * 20 + rows.count * 4);
        let mut numbers = Numbers::default();
        for row in 0..rows.count {
            text.extend_from_slice(self.row[0].as_bytes());
            numbers.write(&rows.numbers[row * width..][..width], self.missing, &mut text);
            text.extend_from_slice(self.row[1].as_bytes());
        }
        text
    }
}

/// Formats numbers, each as the shortest decimal that reads back to it.
pub(super) struct Numbers([zmij::Buffer; BATCH]);

impl Default for Numbers {
    fn default() -> Numbers {
        Numbers(std::array::from_fn(|_| zmij::Buffer::new()))
    }
}

impl Numbers {
    /// Appends numbers to a text, separated by commas; `missing` stands for those that are not finite.
    pub fn write(&mut self, values: &[f64], missing: &str, text: &mut Vec<u8>) {
        for (group, values) in values.chunks(BATCH).enumerate() {
            let mut written = [missing; BATCH];
            for ((written, buffer), &value) in written.iter_mut().zip(&mut self.0).zip(values) {
                if value.is_finite() {
                    *written = buffer.format_finite(value);
                }
            }
            for (k, written) in written[..values.len()].iter().enumerate() {
                if group + k > 0 {
                    text.push(b',');
                }
                text.extend_from_slice(written.as_bytes());
            }
        }
    }
}
