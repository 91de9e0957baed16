//! Diagnostics as text: for readers through `codespan-reporting`, as one line each, or as JSON.
//!
//! No other file uses the rendering library.

use super::{Diagnostic, Edit, Fix, Label, Severity};
use crate::source::{FileId, Source, Sources, Span, is_control};
use codespan_reporting::diagnostic as rich;
use codespan_reporting::files::{Error, Files};
use codespan_reporting::term;
use serde_json::{Value, json};
use std::borrow::Cow;
use std::ops::Range;

/// Length limit of a line that is shown with labels (bytes): a longer one would flood the terminal.
const LONGEST_LINE: usize = 500;

/// Output format of diagnostics.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Format {
    /// With source lines.
    #[default]
    Human,
    /// One line each: `file:line:column: error[E0201]: message`.
    Short,
    /// One JSON object per line.
    Json,
}

/// Use of terminal colours in the human format.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Color {
    /// Plain text.
    #[default]
    Never,
    /// ANSI colours.
    Always,
}

/// Renders a diagnostic with its line ends.
#[must_use]
pub fn render(diagnostic: &Diagnostic, sources: &Sources, format: Format, color: Color) -> String {
    match format {
        Format::Human if has_short_lines(diagnostic, sources) => human(&without_controls(diagnostic), sources, color),
        Format::Human => without_lines(&without_controls(diagnostic), sources),
        Format::Short => short(&without_controls(diagnostic), sources),
        Format::Json => format!("{}\n", escape_controls(as_json(diagnostic, sources).to_string())),
    }
}

/// Replaces control characters by visible ones, for example the escape character by `␛`.
#[must_use]
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(is_control) {
        return Cow::Borrowed(text);
    }
    let picture = |c: char| match c as u32 {
        _ if !is_control(c) => c,
        code @ 0..0x20 => char::from_u32(0x2400 + code).unwrap_or(char::REPLACEMENT_CHARACTER),
        0x7f => '\u{2421}',
        _ => char::REPLACEMENT_CHARACTER,
    };
    Cow::Owned(text.replace("\r\n", "\n").chars().map(picture).collect())
}

/// Replaces control characters by others of the same number of bytes, which keeps offsets of labels valid.
fn mask_controls(text: &str) -> Cow<'_, str> {
    if !text.contains(is_control) {
        return Cow::Borrowed(text);
    }
    let other = |c: char| match c.len_utf8() {
        // the carriage return of a line end is handled below
        _ if !is_control(c) || c == '\r' => c,
        1 => '?',
        2 => '¿',
        _ => char::REPLACEMENT_CHARACTER,
    };
    let shown: String = text.chars().map(other).collect();
    // a carriage return without a line feed would overwrite its line
    let lines: Vec<&str> = shown.split("\r\n").collect();
    Cow::Owned(lines.into_iter().map(|line| line.replace('\r', "?")).collect::<Vec<_>>().join("\r\n"))
}

/// Replaces the control characters in all texts of a diagnostic.
fn without_controls(diagnostic: &Diagnostic) -> Cow<'_, Diagnostic> {
    let texts = || {
        let labels = diagnostic.labels.iter().map(|label| &label.text);
        labels.chain(&diagnostic.notes).chain(&diagnostic.help).chain([&diagnostic.message])
    };
    if !texts().any(|text| text.contains(is_control)) {
        return Cow::Borrowed(diagnostic);
    }
    let mut shown = diagnostic.clone();
    let labels = shown.labels.iter_mut().map(|label| &mut label.text);
    for text in labels.chain(&mut shown.notes).chain(&mut shown.help).chain([&mut shown.message]) {
        *text = visible(text).into_owned();
    }
    Cow::Owned(shown)
}

/// Escapes control characters in JSON.
fn escape_controls(json: String) -> String {
    if !json.contains(is_control) {
        return json;
    }
    let escape = |c: char| if is_control(c) { format!("\\u{:04x}", c as u32) } else { c.to_string() };
    json.chars().map(escape).collect()
}

/// Renders a fix that was applied, as one line: ``file:line:column: message: `**` → `^` ``.
#[must_use]
pub fn render_applied(fix: &Fix, sources: &Sources, format: Format) -> String {
    if format == Format::Json {
        return format!("{}\n", escape_controls(json!({ "fixed": fix_as_json(fix, sources) }).to_string()));
    }
    let location = fix.edits.first().map_or(String::new(), |edit| format!("{}: ", location(edit.span, sources)));
    let edits: Vec<String> = fix.edits.iter().map(|edit| describe_edit(edit, sources)).collect();
    format!("{location}{}: {}\n", visible(&fix.message), visible(&edits.join(", ")))
}

/// Length limit of the changed text that is shown (characters).
const LONGEST_EDIT: usize = 30;

fn describe_edit(edit: &Edit, sources: &Sources) -> String {
    let shown = |text: &str| {
        let text = text.trim();
        let line = text.lines().next().unwrap_or_default();
        let start: String = line.chars().take(LONGEST_EDIT).collect();
        if start.len() < text.len() { format!("`{start}…`") } else { format!("`{start}`") }
    };
    let [old, new] = [sources.text(edit.span), edit.text.as_str()];
    match (old.trim().is_empty(), new.trim().is_empty()) {
        (true, _) => format!("{} put in", shown(new)),
        (_, true) => format!("{} taken out", shown(old)),
        _ => format!("{} → {}", shown(old), shown(new)),
    }
}

impl Severity {
    /// Returns the severity in a word.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        }
    }
}

fn human(diagnostic: &Diagnostic, sources: &Sources, color: Color) -> String {
    let severity = match diagnostic.severity() {
        Severity::Note => rich::Severity::Note,
        Severity::Warning => rich::Severity::Warning,
        Severity::Error => rich::Severity::Error,
    };
    let labels = diagnostic.labels.iter().map(rich_label).collect();
    let notes = diagnostic.notes.iter().map(|text| aligned("note", text));
    let help = diagnostic.help.iter().map(|text| aligned("help", text));
    let rich = rich::Diagnostic::new(severity)
        .with_code(diagnostic.code.as_str())
        .with_message(&diagnostic.message)
        .with_labels(labels)
        .with_notes(notes.chain(help).collect());
    let config = term::Config::default();
    let mut out = term::termcolor::Buffer::no_color();
    if color == Color::Always {
        out = term::termcolor::Buffer::ansi();
    }
    match term::emit_to_write_style(&mut out, &config, sources, &rich) {
        Ok(()) => String::from_utf8_lossy(out.as_slice()).into_owned(),
        // the span is not in the text: render everything else
        Err(_) => without_lines(diagnostic, sources),
    }
}

fn rich_label(label: &Label) -> rich::Label<FileId> {
    let range = label.span.start as usize..label.span.end as usize;
    let rich = if label.primary {
        rich::Label::primary(label.span.file, range)
    } else {
        rich::Label::secondary(label.span.file, range)
    };
    rich.with_message(&label.text)
}

/// Formats `word: text`, with further lines of the text indented below the first.
fn aligned(word: &str, text: &str) -> String {
    let indent = format!("\n{}", " ".repeat(word.len() + 2));
    format!("{word}: {}", text.replace('\n', &indent))
}

fn has_short_lines(diagnostic: &Diagnostic, sources: &Sources) -> bool {
    diagnostic.labels.iter().all(|label| {
        let source = sources.get(label.span.file);
        let first = source.line_index(label.span.start as usize);
        let last = source.line_index(label.span.end as usize);
        [first, last].into_iter().filter_map(|line| source.line_range(line)).all(|range| range.len() <= LONGEST_LINE)
    })
}

fn short(diagnostic: &Diagnostic, sources: &Sources) -> String {
    let location =
        diagnostic.labels.first().map_or(String::new(), |label| format!("{}: ", location(label.span, sources)));
    format!("{location}{}[{}]: {}\n", diagnostic.severity().as_str(), diagnostic.code, diagnostic.message)
}

fn without_lines(diagnostic: &Diagnostic, sources: &Sources) -> String {
    let mut text = short(diagnostic, sources);
    for label in diagnostic.labels.iter().filter(|label| !label.text.is_empty()) {
        text += &format!("  {}: {}\n", location(label.span, sources), label.text);
    }
    for note in &diagnostic.notes {
        text += &format!("  = {}\n", aligned("note", note));
    }
    for help in &diagnostic.help {
        text += &format!("  = {}\n", aligned("help", help));
    }
    text + "\n"
}

fn location(span: Span, sources: &Sources) -> String {
    let source = sources.get(span.file);
    let (line, column) = source.position(span.start);
    format!("{}:{line}:{column}", visible(&source.name))
}

fn as_json(diagnostic: &Diagnostic, sources: &Sources) -> Value {
    let labels: Vec<Value> = diagnostic
        .labels
        .iter()
        .map(|label| {
            let source = sources.get(label.span.file);
            json!({
                "file": source.name,
                "start": json_position(source, label.span.start),
                "end": json_position(source, label.span.end),
                "primary": label.primary,
                "text": label.text,
            })
        })
        .collect();
    let fixes: Vec<Value> = diagnostic.fixes.iter().map(|fix| fix_as_json(fix, sources)).collect();
    json!({
        "code": diagnostic.code.as_str(),
        "severity": diagnostic.severity().as_str(),
        "message": diagnostic.message,
        "labels": labels,
        "notes": diagnostic.notes,
        "help": diagnostic.help,
        "fixes": fixes,
        "data": diagnostic.data,
    })
}

fn fix_as_json(fix: &Fix, sources: &Sources) -> Value {
    let edits: Vec<Value> = fix
        .edits
        .iter()
        .map(|edit| {
            let source = sources.get(edit.span.file);
            json!({
                "file": source.name,
                "start": json_position(source, edit.span.start),
                "end": json_position(source, edit.span.end),
                "text": edit.text,
            })
        })
        .collect();
    json!({ "message": fix.message, "applies": fix.applies.as_str(), "edits": edits })
}

fn json_position(source: &Source, offset: u32) -> Value {
    let (line, column) = source.position(offset);
    json!({ "line": line, "column": column })
}

impl<'a> Files<'a> for Sources {
    type FileId = FileId;
    type Name = Cow<'a, str>;
    type Source = Cow<'a, str>;

    fn name(&'a self, id: FileId) -> Result<Cow<'a, str>, Error> {
        Ok(visible(&self.get(id).name))
    }

    fn source(&'a self, id: FileId) -> Result<Cow<'a, str>, Error> {
        let source = self.get(id);
        Ok(if source.has_controls { mask_controls(&source.text) } else { Cow::Borrowed(&source.text) })
    }

    fn line_index(&'a self, id: FileId, byte_index: usize) -> Result<usize, Error> {
        Ok(self.get(id).line_index(byte_index))
    }

    fn line_range(&'a self, id: FileId, line: usize) -> Result<Range<usize>, Error> {
        let given = line;
        let max = self.get(id).line_index(usize::MAX);
        self.get(id).line_range(line).ok_or(Error::LineTooLarge { given, max })
    }
}
