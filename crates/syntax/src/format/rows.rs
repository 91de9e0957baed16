//! Rows of a tree: the pieces that begin a line of their own, in order, with all comments.
//!
//! Each token of the text is in one row, or behind one. Text that the tree lacks or marks as broken stays as it was written.

use super::layout::{INDENT, WIDTH};
use super::words;
use crate::ast::{Feature, FeatureKind, File, Item, ItemKind, Mechanism, UsedFile};
use crate::lexer::Token;
use mechc_text::source::Span;
use rustc_hash::FxHashSet;
use std::ops::Range;

/// A line of its own, or several if it is broken.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Row {
    pub tokens: Range<usize>,
    /// The comment behind it, on its line.
    pub behind: Option<usize>,
    /// Indentation in columns.
    pub indent: usize,
    pub kind: Kind,
    /// True if a blank line stands before it.
    pub is_apart: bool,
    /// The byte at which the unit behind `in` begins.
    pub printed: Option<usize>,
}

/// Kinds of rows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Comment,
    /// A declaration, whose columns are those of its neighbours of the same kind.
    Declaration(Group),
    /// The head of a block, up to the opening brace.
    Head,
    /// The brace that closes it.
    End,
    /// Stays as it is.
    Kept,
}

/// Declarations that are of one kind.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Group {
    Uses,
    Params,
    Functions,
    Tables,
    Inputs,
    Parts,
    Blocks,
    Joints,
    Constraints,
    Drivers,
    Gravity,
    Loads,
    Measures,
    Results,
    Requirements,
    Analysis,
    Features,
    Masses,
}

impl Group {
    /// Returns the group of a declaration; `None` for a broken one.
    pub fn of(kind: &ItemKind) -> Option<Group> {
        Some(match kind {
            ItemKind::Param { .. } => Group::Params,
            ItemKind::Function { .. } => Group::Functions,
            ItemKind::Table { .. } => Group::Tables,
            ItemKind::Input { .. } => Group::Inputs,
            ItemKind::Part(_) => Group::Parts,
            ItemKind::Ground { .. } | ItemKind::Body { .. } => Group::Blocks,
            ItemKind::Joint { .. } => Group::Joints,
            ItemKind::Equation { driver: false, .. } => Group::Constraints,
            ItemKind::Equation { driver: true, .. } => Group::Drivers,
            ItemKind::Gravity { .. } => Group::Gravity,
            ItemKind::Load { .. } => Group::Loads,
            ItemKind::Measure { .. } | ItemKind::Trace { .. } => Group::Measures,
            ItemKind::Result { .. } => Group::Results,
            ItemKind::Requirement(_) => Group::Requirements,
            ItemKind::Analysis { .. } => Group::Analysis,
            ItemKind::Broken { .. } => return None,
        })
    }
}

/// Returns the rows of a text. `faults` are the bytes of its syntax errors, in order.
pub(super) fn rows(file: &File, tokens: &[Token<'_>], names: &FxHashSet<&str>, faults: &[usize]) -> Vec<Row> {
    let mut rows = Rows { tokens, names, faults, at: 0, made: Vec::new() };
    let mut mechanisms = file.mechanisms.iter().peekable();
    for used in &file.uses {
        while let Some(before) = mechanisms.next_if(|before| before.span.start < used.span.start) {
            rows.mechanism(before);
        }
        rows.used(used);
    }
    mechanisms.for_each(|mechanism| rows.mechanism(mechanism));
    rows.up_to(usize::MAX, 0);
    rows.made
}

struct Rows<'a> {
    tokens: &'a [Token<'a>],
    names: &'a FxHashSet<&'a str>,
    faults: &'a [usize],
    /// The token that comes next.
    at: usize,
    made: Vec<Row>,
}

impl Rows<'_> {
    fn starts_before(&self, byte: usize) -> bool {
        self.tokens.get(self.at).is_some_and(|token| token.start < byte)
    }

    /// Returns the first token at or behind a byte, from the next one on.
    fn index_at(&self, byte: usize) -> usize {
        self.at + self.tokens[self.at..].partition_point(|token| token.start < byte)
    }

    fn has_fault(&self, range: Range<usize>) -> bool {
        let first = self.faults.partition_point(|&at| at < range.start);
        self.faults.get(first).is_some_and(|&at| at < range.end)
    }

    /// Adds the rows before a byte: comments, and unchanged text.
    fn up_to(&mut self, byte: usize, indent: usize) {
        while self.starts_before(byte) {
            if self.tokens[self.at].is_comment() { self.comment(indent) } else { self.keep(self.at + 1) }
        }
    }

    fn comment(&mut self, indent: usize) {
        let k = self.at;
        match self.made.last_mut() {
            Some(row) if self.tokens[k].lines_before == 0 => {
                if row.kind == Kind::Kept {
                    row.tokens.end = k + 1;
                } else {
                    row.behind = Some(k);
                }
                self.at += 1;
            }
            _ => self.push(k + 1, indent, Kind::Comment),
        }
    }

    /// Leaves all before a token as it is.
    fn keep(&mut self, end: usize) {
        match self.made.last_mut() {
            Some(row) if row.kind == Kind::Kept => {
                row.tokens.end = end;
                self.at = end;
            }
            _ => self.push_row(end, 0, Kind::Kept),
        }
    }

    /// Adds the tokens before one as a row. One that goes on in the line of what is kept is kept, too.
    fn push(&mut self, end: usize, indent: usize, kind: Kind) {
        let goes_on = self.tokens[self.at].lines_before == 0;
        if goes_on && self.made.last().is_some_and(|row| row.kind == Kind::Kept) {
            self.keep(end);
        } else {
            self.push_row(end, indent, kind);
        }
    }

    fn push_row(&mut self, end: usize, indent: usize, kind: Kind) {
        let is_first = self.made.last().is_none_or(|row| row.kind == Kind::Head) || kind == Kind::End;
        let is_apart = self.tokens[self.at].lines_before > 1 && !is_first;
        self.made.push(Row { tokens: self.at..end, behind: None, indent, kind, is_apart, printed: None });
        self.at = end;
    }

    /// A declaration without a block.
    fn plain(&mut self, span: Span, group: Option<Group>, indent: usize) {
        let range = span.start as usize..span.end as usize;
        if self.starts_behind(range.start) {
            return;
        }
        self.up_to(range.start, indent);
        let end = self.index_at(range.end);
        if end == self.at {
            return;
        }
        match group {
            Some(group) => self.push(end, indent, Kind::Declaration(group)),
            None => self.keep(end),
        }
    }

    /// Returns whether the next token stands behind a byte, so that a declaration that begins there is in a row already.
    fn starts_behind(&self, byte: usize) -> bool {
        self.tokens.get(self.at).is_none_or(|token| token.start > byte)
    }

    fn used(&mut self, used: &UsedFile) {
        self.plain(used.span, (!used.is_broken).then_some(Group::Uses), 0);
    }

    fn mechanism(&mut self, mechanism: &Mechanism) {
        let span = mechanism.span;
        self.up_to(span.start as usize, 0);
        let inside = mechanism.items.first().map(|item| item.span.start);
        let end = self.begin_block(span, inside, 0);
        for item in &mechanism.items {
            self.item(item);
        }
        self.end_block(span, end, 0);
    }

    fn item(&mut self, item: &Item) {
        let (ItemKind::Ground { features } | ItemKind::Body { features, .. }) = &item.kind else {
            let before = self.made.len();
            self.plain(item.span, Group::of(&item.kind), INDENT);
            if let Some(row) = self.made[before..].last_mut() {
                row.printed = printed(&item.kind);
            }
            return;
        };
        let start = item.span.start as usize;
        if self.starts_behind(start) {
            return;
        }
        self.up_to(start, INDENT);
        if !self.on_one_line(item) {
            self.block(item, features);
        }
    }

    fn block(&mut self, item: &Item, features: &[Feature]) {
        let inside = features.first().map(|feature| feature.span.start);
        let end = self.begin_block(item.span, inside, INDENT);
        for feature in features {
            let group = match feature.kind {
                FeatureKind::Broken => None,
                FeatureKind::Mass { .. } => Some(Group::Masses),
                _ => Some(Group::Features),
            };
            self.plain(feature.span, group, 2 * INDENT);
        }
        self.end_block(item.span, end, INDENT);
    }

    /// Takes a body or the ground as a line of its own, if it was one, and fits; or if there is nothing in it.
    fn on_one_line(&mut self, item: &Item) -> bool {
        let (start, end) = (item.span.start as usize, item.span.end as usize);
        let behind = self.index_at(end);
        let tokens = &self.tokens[self.at..behind];
        let (Some(last), false) = (tokens.last(), tokens.iter().any(Token::is_comment)) else { return false };
        if last.text != "}" || self.has_fault(start..end) {
            return false;
        }
        let is_empty = tokens.len() > 1 && tokens[tokens.len() - 2].text == "{";
        let fits = || {
            let words = words::words(self.tokens, self.names, self.at..behind, None);
            INDENT + words::width(&words, tokens) <= WIDTH
        };
        let is_one = is_empty || tokens[1..].iter().all(|token| token.lines_before == 0) && fits();
        if is_one {
            self.push(behind, INDENT, Kind::Declaration(Group::Blocks));
        }
        is_one
    }

    /// Adds the head of a block, if it has one without faults, and gives the token of the brace that closes it.
    fn begin_block(&mut self, span: Span, inside: Option<u32>, indent: usize) -> Option<usize> {
        let start = span.start as usize;
        let behind = self.index_at(span.end as usize);
        let before = self.index_at(inside.unwrap_or(span.end) as usize);
        let brace = (self.at..before).find(|&k| self.tokens[k].text == "{");
        let close = behind.checked_sub(1).filter(|&k| k >= self.at && self.tokens[k].text == "}");
        if let Some(brace) = brace {
            let is_empty = close == Some(brace + 1);
            let end = if is_empty { brace + 2 } else { brace + 1 };
            if self.has_fault(start..self.tokens[brace].end()) {
                self.keep(end);
            } else {
                self.push(end, indent, if is_empty { Kind::Declaration(Group::Blocks) } else { Kind::Head });
            }
        }
        close
    }

    fn end_block(&mut self, span: Span, close: Option<usize>, indent: usize) {
        let end = close.map_or(span.end as usize, |k| self.tokens[k].start);
        self.up_to(end, indent + INDENT);
        if close == Some(self.at) {
            self.push(self.at + 1, indent, Kind::End);
        }
    }
}

/// Returns the byte at which the unit behind `in` begins.
fn printed(kind: &ItemKind) -> Option<usize> {
    match kind {
        ItemKind::Measure { unit, .. } | ItemKind::Trace { unit, .. } | ItemKind::Result { unit, .. } => {
            unit.as_ref().map(|unit| unit.span.start as usize)
        }
        _ => None,
    }
}
