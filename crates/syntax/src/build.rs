//! Conversion of the parser's pairs to the tree of declarations.

use super::ast::{
    Binding, ColumnName, ColumnWord, ComparedSide, DrawnPose, Expr, ExprKind, Factor, Feature, FeatureKind, IndexRange,
    Item, ItemKind, MechanismName, Name, Part, Requirement, TableRows, UnitFactor, UsedFile, WrittenUnit,
};
use super::grammar::{Grammar, Rule};
use super::lexer::Token;
use super::{depth, errors, formula};
use mechc_text::diag::Diagnostic;
use mechc_text::source::{FileId, Source, Span};
use pest::Parser;
use pest::iterators::Pair;
use std::ops::Range;
use unicode_normalization::UnicodeNormalization;

/// Longest name, in characters.
const LONGEST_NAME: usize = 200;

/// Result with a boxed diagnostic, which is rare and large.
pub(super) type Built<T> = Result<T, Box<Diagnostic>>;

/// Builds the nodes of a piece of text.
pub(super) struct Builder<'a> {
    piece: &'a Piece<'a>,
}

/// Head of a mechanism or body, up to its brace.
#[derive(Clone)]
pub(super) struct Head {
    pub name: Name,
    pub ranges: Vec<IndexRange>,
    /// Pose behind `at`.
    pub pose: Option<DrawnPose>,
}

/// A piece of a text, from the beginning of its first token to the end of its last one.
pub(super) struct Piece<'a> {
    source: &'a Source,
    file: FileId,
    tokens: &'a [Token<'a>],
    /// Range in bytes.
    pub range: Range<usize>,
}

/// Reasons why a piece cannot be read.
pub(super) enum PieceError {
    /// A violation of the grammar.
    ByGrammar(Box<pest::error::Error<Rule>>),
    /// An error of the tree builder.
    Else(Box<Diagnostic>),
}

impl<'a> Piece<'a> {
    /// Creates the piece of some adjacent tokens; without tokens it is the end of the text.
    pub fn new(source: &'a Source, file: FileId, tokens: &'a [Token<'a>]) -> Piece<'a> {
        let start = tokens.first().map_or(source.text.len(), |first| first.start);
        Piece { source, file, tokens, range: start..tokens.last().map_or(start, Token::end) }
    }

    /// Parses a piece by a rule that matches from its start, and builds a node.
    pub fn read<T>(
        &self,
        rule: Rule,
        make: impl FnOnce(&Builder<'_>, Pair<'_, Rule>) -> Built<T>,
    ) -> Result<T, PieceError> {
        let text = &self.source.text[self.range.clone()];
        let builder = Builder { piece: self };
        depth::measure(self.tokens, self.file).map_err(PieceError::Else)?;
        let pairs = Grammar::parse(rule, text).map_err(|error| PieceError::ByGrammar(Box::new(error)))?;
        let pair = pairs.into_iter().next().ok_or_else(|| PieceError::Else(builder.truncated()))?;
        make(&builder, pair).map_err(PieceError::Else)
    }

    /// Returns the diagnostic for a piece; `with_fix_it` requests a search for suggestions.
    pub fn fault(&self, refused: PieceError, with_fix_it: bool) -> Box<Diagnostic> {
        match refused {
            PieceError::Else(fault) => fault,
            PieceError::ByGrammar(error) => {
                Box::new(errors::from_pest(&error, self.source, self.file, self.range.start, with_fix_it))
            }
        }
    }
}

/// Returns a name in NFC, in which names are compared.
#[must_use]
pub fn normalized(name: &str) -> String {
    if name.is_ascii() { name.to_owned() } else { name.nfc().collect() }
}

/// Returns whether a text can be a name: an identifier that is not a keyword.
#[must_use]
pub fn is_name(text: &str) -> bool {
    let pair = Grammar::parse(Rule::name, text).ok().and_then(|mut pairs| pairs.next());
    pair.is_some_and(|pair| pair.as_str().len() == text.len()) && text.chars().count() <= LONGEST_NAME
}

impl Builder<'_> {
    /// Returns the span of a pair, without trailing white space and comments.
    pub(super) fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        let Piece { file, tokens, ref range, .. } = *self.piece;
        let (start, mut end) = (range.start + pair.as_span().start(), range.start + pair.as_span().end());
        // a comment that was taken in was so with the end of its line
        if pair.as_str().ends_with(char::is_whitespace) {
            let behind = tokens.partition_point(|token| token.start < end);
            end = tokens[..behind].last().map_or(end, Token::end);
        }
        Span { file, start: start as u32, end: end as u32 }
    }

    /// Returns the text of a span.
    pub(super) fn text(&self, span: Span) -> &str {
        &self.piece.source.text[span.start as usize..span.end as usize]
    }

    pub(super) fn name(&self, pair: &Pair<'_, Rule>) -> Built<Name> {
        let name = Name { text: normalized(pair.as_str()), span: self.span(pair) };
        if name.text.len() > LONGEST_NAME && name.text.chars().count() > LONGEST_NAME {
            return Err(Box::new(errors::long_name(name.span, LONGEST_NAME)));
        }
        Ok(name)
    }

    /// Returns the diagnostic for a pair that the grammar does not produce.
    pub(super) fn truncated(&self) -> Box<Diagnostic> {
        let end = self.piece.source.text.len() as u32;
        let span = Span { file: self.piece.file, start: end, end };
        Box::new(errors::misplaced(span, "a declaration is not complete", "more was expected before this"))
    }

    /// Returns the only significant child of a pair.
    pub(super) fn only<'i>(&self, pair: Pair<'i, Rule>) -> Built<Pair<'i, Rule>> {
        pair.into_inner().next().ok_or_else(|| self.truncated())
    }

    /// Builds `use "FILE.mech" as PREFIX`.
    pub(super) fn use_file(&self, pair: Pair<'_, Rule>) -> Built<UsedFile> {
        let span = self.span(&pair);
        let (mut path, mut prefix) = (None, None);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::string => path = Some(self.unquoted_name(&part)),
                Rule::use_prefix => prefix = Some(self.name(&self.only(part)?)?),
                _ => {}
            }
        }
        Ok(UsedFile { docs: self.docs_above(span.start), span, path, prefix, is_broken: false })
    }

    /// Returns the text between the quotes of a string, with the span of the string.
    fn unquoted_name(&self, string: &Pair<'_, Rule>) -> Name {
        Name { text: unquoted(string.as_str()).to_owned(), span: self.span(string) }
    }

    /// Builds a declaration without a block.
    pub(super) fn plain_item(&self, pair: Pair<'_, Rule>) -> Built<Item> {
        let span = self.span(&pair);
        let docs = self.docs_above(span.start);
        let rule = pair.as_rule();
        let ranges = self.ranges(&pair)?;
        let mut inner = significant(pair);
        let kind = match rule {
            Rule::param => ItemKind::Param { name: self.next_name(&mut inner)?, value: self.next_expr(&mut inner)? },
            Rule::function => ItemKind::Function {
                name: self.next_name(&mut inner)?,
                argument: self.next_name(&mut inner)?,
                value: self.next_expr(&mut inner)?,
            },
            Rule::input => ItemKind::Input { name: self.next_name(&mut inner)?, value: self.next_expr(&mut inner)? },
            Rule::table => self.table(&mut inner)?,
            Rule::part => ItemKind::Part(Box::new(self.part(&mut inner)?)),
            Rule::joint => self.joint(&mut inner)?,
            Rule::driver | Rule::constraint => ItemKind::Equation {
                driver: rule == Rule::driver,
                name: self.next_name(&mut inner)?,
                left: self.next_expr(&mut inner)?,
                right: self.next_expr(&mut inner)?,
            },
            Rule::gravity => ItemKind::Gravity { acceleration: self.next_expr(&mut inner)? },
            Rule::load => ItemKind::Load {
                name: self.next_name(&mut inner)?,
                force: self.next_expr(&mut inner)?,
                on: self.next_expr(&mut inner)?,
            },
            Rule::measure => ItemKind::Measure {
                name: self.next_name(&mut inner)?,
                value: self.next_expr(&mut inner)?,
                unit: self.printed(inner.next())?,
            },
            Rule::trace => ItemKind::Trace {
                name: self.next_name(&mut inner)?,
                point: self.next_expr(&mut inner)?,
                unit: self.printed(inner.next())?,
            },
            Rule::result => ItemKind::Result {
                name: self.next_name(&mut inner)?,
                value: self.next_expr(&mut inner)?,
                unit: self.printed(inner.next())?,
            },
            Rule::require => ItemKind::Requirement(Box::new(self.requirement(inner)?)),
            Rule::analysis => ItemKind::Analysis {
                from: self.next_expr(&mut inner)?,
                to: self.next_expr(&mut inner)?,
                every: self.next_expr(&mut inner)?,
            },
            _ => return Err(self.truncated()),
        };
        Ok(Item { docs, span, ranges, kind })
    }

    fn requirement<'i>(&self, inner: impl Iterator<Item = Pair<'i, Rule>>) -> Built<Requirement> {
        let (mut name, mut sign, mut sides, mut signs) = (None, None, Vec::new(), Vec::new());
        for pair in inner {
            match pair.as_rule() {
                Rule::name => name = Some(self.name(&pair)?),
                Rule::comparison => sign = Some((formula::comparison_sign(&pair), self.span(&pair))),
                _ => {
                    signs.push(sign.take());
                    sides.push(formula::build(self, pair, 0)?);
                }
            }
        }
        let mut sides = sides.into_iter().zip(signs);
        let (first, _) = sides.next().ok_or_else(|| self.truncated())?;
        let (mut rest, mut within) = (Vec::new(), None);
        for (side, sign) in sides {
            match sign {
                Some((sign, span)) => rest.push(ComparedSide { sign, span, right: side }),
                None => within = Some(side),
            }
        }
        Ok(Requirement { name, first, rest, within })
    }

    fn part<'i>(&self, inner: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Built<Part> {
        let name = self.next_name(inner)?;
        let mechanism = inner.next().ok_or_else(|| self.truncated())?;
        let start = self.span(&mechanism);
        let mut part = Part {
            name,
            mechanism: self.mechanism_name(mechanism)?,
            bindings: Vec::new(),
            on: None,
            at: None,
            mirrored: None,
            call_span: start,
        };
        for pair in inner {
            match pair.as_rule() {
                Rule::binding => part.bindings.push(self.binding(pair)?),
                Rule::call_end => part.call_span = start.to(self.span(&pair)),
                Rule::carrier => part.on = Some(self.carrier(pair)?),
                Rule::paren => part.at = Some(formula::build_operand(self, pair, 0)?),
                Rule::mirrored => part.mirrored = Some(self.span(&pair)),
                _ => {}
            }
        }
        Ok(part)
    }

    fn mechanism_name(&self, pair: Pair<'_, Rule>) -> Built<MechanismName> {
        let mut words = significant(pair);
        let first = self.next_name(&mut words)?;
        Ok(match words.next() {
            Some(second) => MechanismName { prefix: Some(first), name: self.name(&second)? },
            None => MechanismName { prefix: None, name: first },
        })
    }

    fn binding(&self, pair: Pair<'_, Rule>) -> Built<Binding> {
        let span = self.span(&pair);
        let mut inner = significant(pair).peekable();
        let name = self.next_name(&mut inner)?;
        let coordinate = inner.next_if(|pair| pair.as_rule() == Rule::word);
        let coordinate = coordinate.map(|word| self.name(&word)).transpose()?;
        Ok(Binding { name, coordinate, value: self.next_expr(&mut inner)?, span })
    }

    fn carrier(&self, pair: Pair<'_, Rule>) -> Built<Expr> {
        let inner = pair.into_inner().next().ok_or_else(|| self.truncated())?;
        if inner.as_rule() == Rule::ground_word {
            let name = self.name(&inner)?;
            return Ok(Expr { span: name.span, kind: ExprKind::Name(name) });
        }
        formula::build_operand(self, inner, 0)
    }

    /// Builds the head of a mechanism or body.
    pub(super) fn head(&self, pair: Pair<'_, Rule>) -> Built<Head> {
        let ranges = self.ranges(&pair)?;
        let mut inner = significant(pair);
        let name = self.next_name(&mut inner)?;
        let at = self.last_expr(&mut inner)?;
        let toward = self.last_expr(&mut inner)?;
        Ok(Head { name, ranges, pose: at.map(|at| DrawnPose { at, toward }) })
    }

    /// Builds the index ranges `[k in 0..n]` behind a name, if present.
    fn ranges(&self, pair: &Pair<'_, Rule>) -> Built<Vec<IndexRange>> {
        let ranges = pair.clone().into_inner().nth(2).filter(|pair| pair.as_rule() == Rule::ranges);
        let Some(ranges) = ranges else { return Ok(Vec::new()) };
        ranges.into_inner().filter(|pair| pair.as_rule() == Rule::range).map(|pair| self.range(pair)).collect()
    }

    fn range(&self, pair: Pair<'_, Rule>) -> Built<IndexRange> {
        let is_closed = pair.clone().into_inner().any(|part| part.as_rule() == Rule::through);
        let mut inner = significant(pair);
        let index = self.next_name(&mut inner)?;
        let (from, to) = (self.next_expr(&mut inner)?, self.next_expr(&mut inner)?);
        Ok(IndexRange { index, from, to, is_closed })
    }

    /// Builds a formula that is the whole text.
    pub(super) fn whole_formula(&self, pair: Pair<'_, Rule>) -> Built<Expr> {
        self.next_expr(&mut pair.into_inner())
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
        let path = self.unquoted_name(&string);
        let (mut columns, mut units) = (None, Vec::new());
        for pair in inner {
            match pair.as_rule() {
                Rule::columns => columns = Some(self.columns(pair)?),
                Rule::unit_product => units.push(self.unit_product(pair)?),
                _ => {}
            }
        }
        Ok(TableRows::File { path, columns, units: units.try_into().ok() })
    }

    fn columns(&self, pair: Pair<'_, Rule>) -> Built<[ColumnName; 2]> {
        let columns = pair.into_inner().filter(|pair| pair.as_rule() == Rule::column);
        let columns = columns.map(|pair| self.column(pair)).collect::<Built<Vec<_>>>()?;
        columns.try_into().map_err(|_| self.truncated())
    }

    fn column(&self, pair: Pair<'_, Rule>) -> Built<ColumnName> {
        let inner = self.only(pair)?;
        let span = self.span(&inner);
        let kind = if inner.as_rule() == Rule::string {
            ColumnWord::Named(unquoted(inner.as_str()).to_owned())
        } else {
            let number = inner.as_str().parse().ok().filter(|number| *number > 0);
            ColumnWord::Number(number.ok_or_else(|| Box::new(errors::column_number(span)))?)
        };
        Ok(ColumnName { kind, span })
    }

    /// Builds the unit behind `in`, if present.
    fn printed(&self, pair: Option<Pair<'_, Rule>>) -> Built<Option<WrittenUnit>> {
        let product = pair.and_then(|pair| pair.into_inner().find(|pair| pair.as_rule() == Rule::unit_product));
        product.map(|pair| self.unit_product(pair)).transpose()
    }

    fn unit_product(&self, pair: Pair<'_, Rule>) -> Built<WrittenUnit> {
        let (mut factors, mut factor): (Vec<UnitFactor>, Factor) = (Vec::new(), Factor::Times);
        for pair in pair.into_inner() {
            if pair.as_rule() != Rule::unit_factor {
                factor = if pair.as_str().ends_with('*') { Factor::Times } else { Factor::Divide };
                continue;
            }
            let mut parts = pair.into_inner();
            let name = self.next_name(&mut parts)?;
            let (power, end) = match parts.next() {
                Some(power) => (formula::unit_power(self, &power)?, self.span(&power)),
                None => (1, name.span),
            };
            let span = name.span.to(end);
            factors.push(UnitFactor { name, power, factor, span });
        }
        match (factors.first(), factors.last()) {
            (Some(first), Some(last)) => Ok(WrittenUnit { span: first.span.to(last.span), factors }),
            _ => Err(self.truncated()),
        }
    }

    fn joint<'i>(&self, inner: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Built<ItemKind> {
        let name = self.next_name(inner)?;
        let call = inner.next().ok_or_else(|| self.truncated())?;
        let call_span = self.span(&call);
        let mut parts = call.into_inner();
        let kind = self.next_name(&mut parts)?;
        if let Some(window) = parts.clone().find(|part| part.as_rule() == Rule::window) {
            let (message, label) = ("a joint takes no window", "a part of the analysis");
            return Err(Box::new(errors::misplaced(self.span(&window), message, label)));
        }
        let arguments = self.list(parts, 1)?;
        Ok(ItemKind::Joint { name, kind, arguments, call_span })
    }

    /// Builds a feature of a body or the ground.
    pub(super) fn feature(&self, pair: Pair<'_, Rule>) -> Built<Feature> {
        let span = self.span(&pair);
        let docs = self.docs_above(span.start);
        let rule = pair.as_rule();
        if rule == Rule::mass {
            return self.mass(pair, docs);
        }
        let along = pair.clone().into_inner().any(|p| p.as_rule() == Rule::along);
        let mut inner = significant(pair);
        let name = self.next_name(&mut inner)?;
        let kind = match rule {
            Rule::point => FeatureKind::Point { at: self.last_expr(&mut inner)? },
            Rule::axis if along => FeatureKind::AxisAlong {
                origin: Box::new(self.next_expr(&mut inner)?),
                direction: Box::new(self.next_operand(&mut inner)?),
            },
            Rule::axis => FeatureKind::AxisTo {
                origin: Box::new(self.next_expr(&mut inner)?),
                target: Box::new(self.next_expr(&mut inner)?),
            },
            Rule::circle => FeatureKind::Circle {
                center: Box::new(self.next_expr(&mut inner)?),
                radius: Box::new(self.next_expr(&mut inner)?),
            },
            Rule::curve => FeatureKind::Curve {
                argument: self.next_name(&mut inner)?,
                at: Box::new(self.next_expr(&mut inner)?),
                estimate: self.last_expr(&mut inner)?.map(Box::new),
            },
            _ => return Err(self.truncated()),
        };
        Ok(Feature { docs, span, name, kind })
    }

    /// Builds `mass M at (x, y) inertia I`.
    fn mass(&self, pair: Pair<'_, Rule>, docs: Vec<String>) -> Built<Feature> {
        let span = self.span(&pair);
        let has_place = pair.clone().into_inner().any(|part| part.as_rule() == Rule::at);
        let mut inner = significant(pair);
        let mass = Box::new(self.next_expr(&mut inner)?);
        let at = if has_place { self.last_expr(&mut inner)?.map(Box::new) } else { None };
        let kind = FeatureKind::Mass { mass, at, inertia: self.last_expr(&mut inner)?.map(Box::new) };
        let nameless = Name { text: String::new(), span: Span { end: span.start + "mass".len() as u32, ..span } };
        Ok(Feature { docs, span, name: nameless, kind })
    }

    /// Builds the formulas of a list.
    pub(super) fn list<'i>(&self, pairs: impl Iterator<Item = Pair<'i, Rule>>, depth: usize) -> Built<Vec<Expr>> {
        collect_exact(pairs.filter(|pair| pair.as_rule() == Rule::expr).map(|pair| formula::build(self, pair, depth)))
    }

    fn next_name<'i>(&self, pairs: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Built<Name> {
        pairs.next().ok_or_else(|| self.truncated()).and_then(|pair| self.name(&pair))
    }

    fn next_expr<'i>(&self, pairs: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Built<Expr> {
        let pair = pairs.next().ok_or_else(|| self.truncated())?;
        formula::build(self, pair, 0)
    }

    /// Builds an optional last formula.
    fn last_expr<'i>(&self, pairs: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Built<Option<Expr>> {
        pairs.next().map(|pair| formula::build(self, pair, 0)).transpose()
    }

    fn next_operand<'i>(&self, pairs: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Built<Expr> {
        let pair = pairs.next().ok_or_else(|| self.truncated())?;
        formula::build_operand(self, pair, 0)
    }

    fn docs_above(&self, start: u32) -> Vec<String> {
        docs_above(&self.piece.source.text, start as usize)
    }
}

/// Collects built nodes without spare capacity: most lists have one or two items, and large texts have many of them. The items are moved,
/// since shrinking a block may keep its size in the allocator.
fn collect_exact<T>(built: impl Iterator<Item = Built<T>>) -> Built<Vec<T>> {
    let mut all = built.collect::<Built<Vec<T>>>()?;
    let mut exact = Vec::with_capacity(all.len());
    exact.append(&mut all);
    Ok(exact)
}

/// Returns the `///` lines directly above a declaration that begins its line.
pub(super) fn docs_above(text: &str, start: usize) -> Vec<String> {
    let before = text[..start].trim_end_matches(|c: char| c != '\n' && c.is_whitespace());
    if !(before.is_empty() || before.ends_with('\n')) {
        return Vec::new();
    }
    let mut docs: Vec<String> = before
        .lines()
        .rev()
        .map_while(|line| line.trim_start().strip_prefix("///"))
        .map(|line| line.strip_prefix(' ').unwrap_or(line).trim_end().to_owned())
        .collect();
    docs.reverse();
    docs
}

/// Returns the text between the quotes of a string.
fn unquoted(string: &str) -> &str {
    string.trim_matches('"')
}

/// Returns the children of a pair except keywords and punctuation.
fn significant(pair: Pair<'_, Rule>) -> impl Iterator<Item = Pair<'_, Rule>> {
    pair.into_inner().filter(|pair| {
        matches!(
            pair.as_rule(),
            Rule::name
                | Rule::word
                | Rule::expr
                | Rule::side
                | Rule::comparison
                | Rule::paren
                | Rule::call
                | Rule::periodic
                | Rule::table_rows
                | Rule::table_file
                | Rule::printed
                | Rule::mechanism_name
                | Rule::binding
                | Rule::call_end
                | Rule::carrier
                | Rule::mirrored
        )
    })
}
