//! From the parser's pairs to the tree of declarations.

use super::ast::{Expr, Feature, FeatureKind, File, Item, ItemKind, Mechanism, Name, TableRows};
use super::{depth, errors, formula, recover};
use crate::diag::{Diagnostic, Diagnostics};
use crate::source::{FileId, Source, Sources, Span};
use pest::Parser;
use pest::iterators::{Pair, Pairs};
use std::borrow::Cow;
use unicode_normalization::UnicodeNormalization;

pub(super) use grammar::Rule;

/// The generated parser, in a module of its own because its items carry no documentation.
#[allow(missing_docs)]
mod grammar {
    #[derive(pest_derive::Parser)]
    #[grammar = "../grammar/mech.pest"]
    pub struct Grammar;
}

/// Stack that the deepest text may take, in bytes.
const STACK: usize = 16 << 20;

/// So many faults of one text are told; each costs another reading.
const MOST_FAULTS: usize = 20;

/// A fault is rare and large; the way without one should be quick.
pub(super) type Built<T> = Result<T, Box<Diagnostic>>;

/// The tree of a file.
///
/// # Errors
/// The faults of the text: nested too deep, not of the grammar, or without any mechanism. After one the reading goes on
/// behind the declaration that holds it.
pub fn parse(sources: &Sources, file: FileId) -> Result<File, Diagnostics> {
    let mut source = Cow::Borrowed(sources.get(file));
    let mut faults = Diagnostics::default();
    let (mut last, mut stays) = (None, false);
    // keywords that were taken for names: every use of them is a fault, and none of its own
    let mut bad_names: Vec<String> = Vec::new();
    loop {
        let read = on_a_deep_stack(&source, file, |reader| {
            let mechanisms = reader.read(Rule::file)?.filter(|pair| pair.as_rule() == Rule::mechanism);
            mechanisms.map(|pair| reader.mechanism(pair)).collect::<Built<Vec<Mechanism>>>()
        });
        let fault = match read {
            Ok(mechanisms) if faults.is_empty() && mechanisms.is_empty() => {
                return Err(errors::no_mechanism(sources.end_of(file)).into());
            }
            Ok(mechanisms) if faults.is_empty() => return Ok(File { mechanisms }),
            Ok(_) => return Err(sorted(faults)),
            Err(fault) => fault,
        };
        let fault = within(fault, sources.get(file).text.len());
        let at = fault.labels.first().map_or(0, |label| label.span.start as usize);
        if last == Some(at) {
            // the declaration before it was not to blame, the one that begins there is
            if std::mem::replace(&mut stays, true) {
                return Err(sorted(faults));
            }
        } else {
            if !recover::uses_bad_name(&source.text, at, &bad_names) {
                faults.push(*fault);
            }
            bad_names.extend(recover::bad_name(&source.text, at));
            stays = false;
        }
        last = Some(at);
        if faults.len() == MOST_FAULTS || !recover::blank(&mut source.to_mut().text, at, stays) {
            return Err(sorted(faults));
        }
    }
}

/// Keeps a fault in the text, though a brace was put behind its end.
fn within(mut fault: Box<Diagnostic>, length: usize) -> Box<Diagnostic> {
    for label in &mut fault.labels {
        (label.span.start, label.span.end) = (label.span.start.min(length as u32), label.span.end.min(length as u32));
    }
    fault
}

fn sorted(mut faults: Diagnostics) -> Diagnostics {
    faults.sort_by_place();
    faults
}

/// A formula alone, as the command line takes it.
///
/// # Errors
/// As [`parse`].
pub fn parse_expression(sources: &Sources, file: FileId) -> Result<Expr, Diagnostics> {
    on_a_deep_stack(sources.get(file), file, |reader| {
        let mut pairs = reader.read(Rule::expression_only)?;
        reader.next_expr(&mut pairs)
    })
    .map_err(|fault| (*fault).into())
}

/// A name as it is compared: in NFC.
#[must_use]
pub fn normalized(name: &str) -> String {
    name.nfc().collect()
}

/// Whether a text can stand where a name is wanted: an identifier, and no keyword.
#[must_use]
pub fn is_name(text: &str) -> bool {
    let pair = grammar::Grammar::parse(Rule::name, text).ok().and_then(|mut pairs| pairs.next());
    pair.is_some_and(|pair| pair.as_str().len() == text.len())
}

fn on_a_deep_stack<T>(source: &Source, file: FileId, work: impl FnOnce(&Reader<'_>) -> Built<T>) -> Built<T> {
    depth::measure(&source.text, file)?;
    stacker::maybe_grow(STACK, STACK, || work(&Reader { source, file }))
}

/// Builds the nodes of one text.
pub(super) struct Reader<'a> {
    source: &'a Source,
    file: FileId,
}

impl<'a> Reader<'a> {
    /// The pairs inside one rule that matches the whole text.
    fn read(&self, rule: Rule) -> Built<Pairs<'a, Rule>> {
        let pairs = grammar::Grammar::parse(rule, &self.source.text)
            .map_err(|error| Box::new(errors::from_pest(&error, self.source, self.file)))?;
        match pairs.into_iter().next() {
            Some(pair) => Ok(pair.into_inner()),
            None => Err(self.truncated()),
        }
    }

    /// A pair's place, without the white space and comments that the parser may have taken in behind it.
    pub(super) fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        let start = pair.as_span().start();
        let mut last = pair.clone();
        while !ends_with_a_token(last.as_rule()) {
            match last.into_inner().next_back() {
                Some(inner) => last = inner,
                None => return Span { file: self.file, start: start as u32, end: pair.as_span().end() as u32 },
            }
        }
        Span { file: self.file, start: start as u32, end: last.as_span().end() as u32 }
    }

    /// The words that a span covers.
    pub(super) fn text(&self, span: Span) -> &str {
        &self.source.text[span.start as usize..span.end as usize]
    }

    pub(super) fn name(&self, pair: &Pair<'_, Rule>) -> Name {
        Name { text: normalized(pair.as_str()), span: self.span(pair) }
    }

    /// What cannot happen while the grammar is what this file believes it to be.
    pub(super) fn truncated(&self) -> Box<Diagnostic> {
        let end = self.source.text.len() as u32;
        let span = Span { file: self.file, start: end, end };
        Box::new(errors::misplaced(span, "a declaration is not complete", "more was expected before this"))
    }

    fn mechanism(&self, pair: Pair<'_, Rule>) -> Built<Mechanism> {
        let span = self.span(&pair);
        let docs = self.docs_above(span.start);
        let mut inner = significant(pair);
        let name = self.next_name(&mut inner)?;
        let items = inner.map(|item| self.item(item)).collect::<Built<Vec<_>>>()?;
        Ok(Mechanism { docs, name, span, items })
    }

    fn item(&self, pair: Pair<'_, Rule>) -> Built<Item> {
        let span = self.span(&pair);
        let docs = self.docs_above(span.start);
        let rule = pair.as_rule();
        let mut inner = significant(pair);
        let kind = match rule {
            Rule::param => ItemKind::Param { name: self.next_name(&mut inner)?, value: self.next_expr(&mut inner)? },
            Rule::function => ItemKind::Function {
                name: self.next_name(&mut inner)?,
                argument: self.next_name(&mut inner)?,
                value: self.next_expr(&mut inner)?,
            },
            Rule::table => self.table(&mut inner)?,
            Rule::ground => ItemKind::Ground { features: self.features(inner)? },
            Rule::body => self.body(inner)?,
            Rule::joint => self.joint(&mut inner)?,
            Rule::driver | Rule::constraint => ItemKind::Equation {
                driver: rule == Rule::driver,
                name: self.next_name(&mut inner)?,
                left: self.next_expr(&mut inner)?,
                right: self.next_expr(&mut inner)?,
            },
            Rule::measure => {
                ItemKind::Measure { name: self.next_name(&mut inner)?, value: self.next_expr(&mut inner)? }
            }
            Rule::analysis => ItemKind::Analysis {
                from: self.next_expr(&mut inner)?,
                to: self.next_expr(&mut inner)?,
                every: self.next_expr(&mut inner)?,
            },
            _ => return Err(self.truncated()),
        };
        Ok(Item { docs, span, kind })
    }

    fn table<'i>(&self, inner: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Built<ItemKind> {
        let name = self.next_name(inner)?;
        let mut periodic = false;
        for pair in inner {
            match pair.as_rule() {
                Rule::periodic => periodic = true,
                Rule::table_rows => {
                    let rows = pair.into_inner().map(|row| formula::build(self, row, 0)).collect::<Built<Vec<_>>>()?;
                    return Ok(ItemKind::Table { name, periodic, rows: TableRows::Listed(rows) });
                }
                Rule::table_file => {
                    let rows = self.table_file(pair)?;
                    return Ok(ItemKind::Table { name, periodic, rows });
                }
                _ => {}
            }
        }
        Err(self.truncated())
    }

    fn table_file(&self, pair: Pair<'_, Rule>) -> Built<TableRows> {
        let mut inner = pair.into_inner();
        let string = inner.next().ok_or_else(|| self.truncated())?;
        let path = Name { text: string.as_str().trim_matches('"').to_owned(), span: self.span(&string) };
        let mut units = inner.map(|unit| self.name(&unit));
        let units = match (units.next(), units.next()) {
            (Some(first), Some(second)) => Some([first, second]),
            _ => None,
        };
        Ok(TableRows::File { path, units })
    }

    fn body<'i>(&self, inner: impl Iterator<Item = Pair<'i, Rule>>) -> Built<ItemKind> {
        let mut inner = inner.peekable();
        let name = self.next_name(&mut inner)?;
        let pose = match inner.next_if(|pair| pair.as_rule() == Rule::paren) {
            Some(pair) => Some(formula::build_operand(self, pair, 0)?),
            None => None,
        };
        Ok(ItemKind::Body { name, pose, features: self.features(inner)? })
    }

    fn joint<'i>(&self, inner: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Built<ItemKind> {
        let name = self.next_name(inner)?;
        let call = inner.next().ok_or_else(|| self.truncated())?;
        let call_span = self.span(&call);
        let mut parts = call.into_inner();
        let kind = self.next_name(&mut parts)?;
        let arguments = self.list(parts, 1)?;
        Ok(ItemKind::Joint { name, kind, arguments, call_span })
    }

    fn features<'i>(&self, pairs: impl Iterator<Item = Pair<'i, Rule>>) -> Built<Vec<Feature>> {
        pairs.map(|pair| self.feature(pair)).collect()
    }

    fn feature(&self, pair: Pair<'_, Rule>) -> Built<Feature> {
        let span = self.span(&pair);
        let docs = self.docs_above(span.start);
        let rule = pair.as_rule();
        let along = pair.clone().into_inner().any(|p| p.as_rule() == Rule::along);
        let mut inner = significant(pair);
        let name = self.next_name(&mut inner)?;
        let kind = match rule {
            Rule::point => FeatureKind::Point { at: self.next_operand(&mut inner)? },
            Rule::axis if along => FeatureKind::AxisAlong {
                origin: self.next_operand(&mut inner)?,
                direction: self.next_operand(&mut inner)?,
            },
            Rule::axis => {
                FeatureKind::AxisTo { origin: self.next_operand(&mut inner)?, target: self.next_operand(&mut inner)? }
            }
            Rule::circle => {
                FeatureKind::Circle { center: self.next_operand(&mut inner)?, radius: self.next_expr(&mut inner)? }
            }
            Rule::curve => FeatureKind::Curve {
                argument: self.next_name(&mut inner)?,
                at: self.next_operand(&mut inner)?,
                estimate: inner.next().map(|e| formula::build(self, e, 0)).transpose()?,
            },
            _ => return Err(self.truncated()),
        };
        Ok(Feature { docs, span, name, kind })
    }

    /// The formulas of a list, without its commas and brackets.
    pub(super) fn list<'i>(&self, pairs: impl Iterator<Item = Pair<'i, Rule>>, depth: usize) -> Built<Vec<Expr>> {
        pairs.filter(|pair| pair.as_rule() == Rule::expr).map(|pair| formula::build(self, pair, depth)).collect()
    }

    fn next_name<'i>(&self, pairs: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Built<Name> {
        pairs.next().map(|pair| self.name(&pair)).ok_or_else(|| self.truncated())
    }

    fn next_expr<'i>(&self, pairs: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Built<Expr> {
        let pair = pairs.next().ok_or_else(|| self.truncated())?;
        formula::build(self, pair, 0)
    }

    fn next_operand<'i>(&self, pairs: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Built<Expr> {
        let pair = pairs.next().ok_or_else(|| self.truncated())?;
        formula::build_operand(self, pair, 0)
    }

    /// The `///` lines directly above a declaration that begins its line.
    fn docs_above(&self, start: u32) -> Vec<String> {
        let text = &self.source.text[..start as usize];
        let line_start = text.rfind('\n').map_or(0, |at| at + 1);
        if !text[line_start..].trim().is_empty() {
            return Vec::new();
        }
        let mut docs: Vec<String> = text[..line_start]
            .lines()
            .rev()
            .map_while(|line| line.trim_start().strip_prefix("///"))
            .map(|line| line.strip_prefix(' ').unwrap_or(line).trim_end().to_owned())
            .collect();
        docs.reverse();
        docs
    }
}

/// Whether a rule's last part is a word or a bracket, which it ends with and not behind.
fn ends_with_a_token(rule: Rule) -> bool {
    !matches!(
        rule,
        Rule::expr
            | Rule::conditional
            | Rule::literal
            | Rule::unit_power
            | Rule::param
            | Rule::function
            | Rule::table
            | Rule::table_file
            | Rule::point
            | Rule::axis
            | Rule::circle
            | Rule::curve
            | Rule::joint
            | Rule::driver
            | Rule::constraint
            | Rule::measure
            | Rule::analysis
    )
}

/// The pairs that carry something: no keywords, no punctuation.
fn significant(pair: Pair<'_, Rule>) -> impl Iterator<Item = Pair<'_, Rule>> {
    pair.into_inner().filter(|pair| {
        matches!(
            pair.as_rule(),
            Rule::name
                | Rule::word
                | Rule::expr
                | Rule::paren
                | Rule::call
                | Rule::periodic
                | Rule::table_rows
                | Rule::table_file
                | Rule::param
                | Rule::function
                | Rule::table
                | Rule::ground
                | Rule::body
                | Rule::joint
                | Rule::driver
                | Rule::constraint
                | Rule::measure
                | Rule::analysis
                | Rule::point
                | Rule::axis
                | Rule::circle
                | Rule::curve
        )
    })
}
