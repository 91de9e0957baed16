//! Gaps between the tokens of a formatted text, and the edits that create them.

use super::columns::{self, Cells};
use super::groups::{Grouped, grouped};
use super::layout::lay_out;
use super::rows::{Kind, Row, rows};
use super::words::{Word, declared, words};
use crate::lexer::{Lexer, Token};
use crate::parse::ParsedText;
use mechc_text::diag::Edit;
use mechc_text::source::{FileId, Span};
use rustc_hash::FxHashSet;
use std::ops::Range;

/// The text before a token.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Gap {
    /// The present text.
    Kept,
    Spaces(usize),
    /// The end of a line, and blank lines, before a line with an indentation.
    Lines {
        ends: usize,
        indent: usize,
    },
}

/// Change of a comma behind the last item of a list.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Comma {
    Unchanged,
    Dropped,
    /// Behind the token.
    Added,
}

/// A text with what is to stand between its tokens.
pub(super) struct Formatted<'a> {
    tokens: Vec<Token<'a>>,
    rows: Vec<Row>,
    /// One for each token.
    gaps: Vec<Gap>,
    /// One for each token.
    commas: Vec<Comma>,
    /// Number of examined items.
    pub steps: usize,
}

/// A declaration on its way to lines.
struct Line {
    words: Vec<Word>,
    cells: Option<Cells>,
}

impl<'a> Formatted<'a> {
    pub fn of(parsed: &ParsedText, text: &'a str) -> Formatted<'a> {
        let tokens: Vec<Token<'a>> = Lexer::new(text, 0).collect();
        let names = declared(&tokens);
        let mut faults: Vec<usize> =
            parsed.faults.iter().flat_map(|fault| &fault.labels).map(|label| label.span.start as usize).collect();
        faults.sort_unstable();
        let rows = rows(&parsed.tree, &tokens, &names, &faults);
        let count = tokens.len();
        let (gaps, commas) = (vec![Gap::Kept; count], vec![Comma::Unchanged; count]);
        let mut formatted = Formatted { tokens, rows, gaps, commas, steps: count };
        formatted.lay_out(&names);
        formatted
    }

    fn lay_out(&mut self, names: &FxHashSet<&str>) {
        let rows = std::mem::take(&mut self.rows);
        let lines: Vec<Line> = rows.iter().map(|row| self.line(row, names)).collect();
        let mut spaces: Vec<usize> = vec![0; self.tokens.len()];
        for (row, line) in rows.iter().zip(&lines) {
            for (k, word) in line.words.iter().enumerate() {
                spaces[row.tokens.start + k] = word.spaces;
            }
        }
        let mut cells: Vec<Option<Cells>> = Vec::new();
        let mut all_words: Vec<Vec<Word>> = Vec::new();
        for line in lines {
            cells.push(line.cells);
            all_words.push(line.words);
        }
        let are_of_one_kind = |a: Kind, b: Kind| a == b && matches!(a, Kind::Declaration(_));
        for run in columns::runs(&rows, are_of_one_kind) {
            self.steps += run.len();
            columns::align(&rows[run.clone()], &cells[run], &mut spaces);
        }
        let ends: Vec<Option<usize>> =
            rows.iter().zip(&all_words).map(|(row, words)| self.row(row, words, &spaces)).collect();
        let are_declarations = |a: Kind, b: Kind| [a, b].iter().all(|kind| matches!(kind, Kind::Declaration(_)));
        for run in columns::runs(&rows, are_declarations) {
            self.steps += run.len();
            let before = columns::before_comments(&rows[run.clone()], &ends[run.clone()]);
            for (row, spaces) in rows[run].iter().zip(before) {
                if let Some(comment) = row.behind {
                    self.gaps[comment] = Gap::Spaces(spaces);
                }
            }
        }
        self.rows = rows;
    }

    fn line(&self, row: &Row, names: &FxHashSet<&str>) -> Line {
        match row.kind {
            Kind::Comment | Kind::Kept => Line { words: Vec::new(), cells: None },
            Kind::Head | Kind::End => Line { words: words(&self.tokens, names, row.tokens.clone(), None), cells: None },
            Kind::Declaration(_) => {
                let words = words(&self.tokens, names, row.tokens.clone(), row.printed);
                let cells = Cells::of(&words, &self.tokens[row.tokens.clone()]);
                Line { words, cells: Some(cells) }
            }
        }
    }

    /// Lays out a row. Returns the column at which it ends; `None` if it has several lines, is a comment, or is kept as it is.
    fn row(&mut self, row: &Row, words: &[Word], spaces: &[usize]) -> Option<usize> {
        if row.kind == Kind::Kept {
            return None;
        }
        let start = row.tokens.start;
        let ends = if start == 0 { 0 } else { 1 + usize::from(row.is_apart) };
        self.gaps[start] = Gap::Lines { ends, indent: row.indent };
        let tokens = &self.tokens[row.tokens.clone()];
        if words.is_empty() {
            return None;
        }
        let grouped = grouped(words, tokens, &spaces[row.tokens.clone()]);
        let laid = lay_out(&grouped.nodes, row.indent);
        self.steps += laid.steps + grouped.nodes.len();
        for (k, node) in grouped.nodes.iter().enumerate() {
            let gap = match (node, laid.lines[k]) {
                (_, Some(indent)) => Gap::Lines { ends: 1, indent },
                (super::layout::Node::Space(spaces) | super::layout::Node::Gap(spaces), None) => Gap::Spaces(*spaces),
                _ => continue,
            };
            self.gaps[start + grouped.tokens[k]] = gap;
        }
        self.set_last_commas(start, words, &grouped, &laid.is_broken);
        (!laid.has_lines).then_some(laid.column)
    }

    /// Adds the comma behind the last item of each list with one item per line, and drops it elsewhere.
    fn set_last_commas(&mut self, start: usize, words: &[Word], grouped: &Grouped, is_broken: &[bool]) {
        for (k, _) in words.iter().enumerate().filter(|(_, word)| word.is_last_comma) {
            self.commas[start + k] = Comma::Dropped;
        }
        for list in grouped.lists.iter().filter(|list| is_broken[list.node]) {
            match list.comma {
                Some(comma) => self.commas[start + comma] = Comma::Unchanged,
                None => self.commas[start + list.last] = Comma::Added,
            }
        }
    }

    /// Returns the whole text, formatted.
    pub fn text(&self, text: &str) -> String {
        let (mut out, mut at) = (String::with_capacity(text.len() + text.len() / 8), 0);
        self.each_change(
            text,
            |_| true,
            |range, new| {
                out += &text[at..range.start];
                out += new;
                at = range.end;
            },
        );
        out + &text[at..]
    }

    /// Returns the edits in the rows that `selects` accepts by their byte range.
    pub fn edits(&self, text: &str, file: FileId, selects: impl Fn(Range<usize>) -> bool) -> Vec<Edit> {
        let mut edits = Vec::new();
        self.each_change(text, selects, |range, new| {
            let span = Span { file, start: range.start as u32, end: range.end as u32 };
            edits.push(Edit { span, text: new.to_owned() });
        });
        edits
    }

    /// Calls `change` for each part of the text that changes, in order, with its byte range and new text.
    fn each_change(
        &self,
        text: &str,
        selects: impl Fn(Range<usize>) -> bool,
        mut change: impl FnMut(Range<usize>, &str),
    ) {
        let line_end = if text.find('\n').is_some_and(|at| text[..at].ends_with('\r')) { "\r\n" } else { "\n" };
        let mut new = String::new();
        // the end of what stands before, and what is put behind it
        let (mut end, mut comma) = (0, "");
        for row in &self.rows {
            let last = row.behind.unwrap_or(row.tokens.end - 1);
            let is_selected = selects(self.tokens[row.tokens.start].start..self.tokens[last].end());
            for k in row.tokens.clone().chain(row.behind) {
                let token = self.tokens[k];
                if self.commas[k] == Comma::Dropped && is_selected {
                    continue;
                }
                new.clear();
                new += comma;
                comma = if self.commas[k] == Comma::Added && is_selected { "," } else { "" };
                let is_kept = self.write_gap(k, line_end, &mut new);
                if is_selected && !is_kept {
                    minimal(text, end..token.start, &new, &mut change);
                }
                end = token.end();
            }
        }
        let is_kept = self.rows.last().is_none_or(|row| row.kind == Kind::Kept);
        if !is_kept && selects(end..text.len()) {
            minimal(text, end..text.len(), line_end, &mut change);
        }
    }

    /// Writes the gap before a token, or returns true if it is kept as it is.
    fn write_gap(&self, k: usize, line_end: &str, out: &mut String) -> bool {
        match self.gaps[k] {
            Gap::Kept => return true,
            Gap::Spaces(count) => out.extend(std::iter::repeat_n(' ', count)),
            Gap::Lines { ends, indent } => {
                (0..ends).for_each(|_| *out += line_end);
                out.extend(std::iter::repeat_n(' ', indent));
            }
        }
        false
    }
}

/// Calls `change` with the smallest range in which old and new text differ, if they do.
fn minimal(text: &str, range: Range<usize>, new: &str, change: &mut impl FnMut(Range<usize>, &str)) {
    let old = &text[range.clone()];
    if old == new {
        return;
    }
    let same = |a: (char, char)| a.0 == a.1;
    let before: usize = old.chars().zip(new.chars()).take_while(|&pair| same(pair)).map(|(c, _)| c.len_utf8()).sum();
    let (old_rest, new_rest) = (&old[before..], &new[before..]);
    let pairs = old_rest.chars().rev().zip(new_rest.chars().rev());
    let behind: usize = pairs.take_while(|&pair| same(pair)).map(|(c, _)| c.len_utf8()).sum();
    change(range.start + before..range.end - behind, &new_rest[..new_rest.len() - behind]);
}
