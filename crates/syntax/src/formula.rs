//! Conversion of the parser's flat rows of operands and operators to the tree of a formula.
//!
//! Precedence, loosest first: `or`, `and`, `not`, comparisons, `+ -`, `* /`, unary `-`, `^` (right-associative). `depth` counts the
//! nesting, so that no tree is deeper than [`DEEPEST`].

use super::ast::{ComparisonSign, Expr, ExprKind, Factor, PathSegment, Sign, Window};
use super::build::{Builder, Built};
use super::grammar::Rule;
use super::lexer::tokens;
use super::{DEEPEST, errors};
use mechc_text::source::Span;
use pest::iterators::Pair;
use std::iter::Peekable;

/// Builds a formula of the rule `expr`.
pub(super) fn build(builder: &Builder<'_>, pair: Pair<'_, Rule>, depth: usize) -> Built<Expr> {
    within(depth, builder.span(&pair))?;
    let span = builder.span(&pair);
    let mut inner = pair.into_inner().peekable();
    match inner.next_if(|first| first.as_rule() == Rule::conditional) {
        Some(first) => conditional(builder, first, depth),
        None => Row { builder, tokens: inner, end: span }.either(depth),
    }
}

/// Builds an operand: a literal, a call, a name, or parentheses.
pub(super) fn build_operand(builder: &Builder<'_>, pair: Pair<'_, Rule>, depth: usize) -> Built<Expr> {
    let span = builder.span(&pair);
    within(depth, span)?;
    let kind = match pair.as_rule() {
        Rule::literal => literal(builder, pair)?,
        Rule::word => ExprKind::Name(builder.name(&pair)?),
        Rule::member => path(builder, pair, depth)?,
        Rule::call => {
            let mut parts = pair.into_inner();
            let name = builder.name(&parts.next().ok_or_else(|| builder.truncated())?)?;
            let window = parts.clone().find(|part| part.as_rule() == Rule::window);
            let arguments = builder.list(parts, depth + 1)?;
            let window = window.map(|window| build_window(builder, window, depth + 1).map(Box::new)).transpose()?;
            ExprKind::Call { name, arguments, window }
        }
        Rule::paren => {
            let mut parts = builder.list(pair.into_inner(), depth + 1)?;
            match parts.pop() {
                Some(only) if parts.is_empty() => ExprKind::Paren(Box::new(only)),
                Some(last) => {
                    parts.push(last);
                    ExprKind::Tuple(parts)
                }
                None => return Err(builder.truncated()),
            }
        }
        _ => return Err(builder.truncated()),
    };
    Ok(Expr { kind, span })
}

/// Builds a window: `from A to B`, or one of both.
fn build_window(builder: &Builder<'_>, pair: Pair<'_, Rule>, depth: usize) -> Built<Window> {
    let span = builder.span(&pair);
    let mut window = Window { from: None, to: None, span };
    let mut is_first = true;
    for part in pair.into_inner() {
        match part.as_rule() {
            Rule::to => is_first = false,
            Rule::expr => {
                let bound = if is_first { &mut window.from } else { &mut window.to };
                *bound = Some(build(builder, part, depth)?);
            }
            _ => {}
        }
    }
    Ok(window)
}

/// Builds a path, such as `a.b`, with optional indices in brackets.
fn path(builder: &Builder<'_>, pair: Pair<'_, Rule>, depth: usize) -> Built<ExprKind> {
    let mut segments: Vec<PathSegment> = Vec::new();
    for part in pair.into_inner() {
        match segments.last_mut() {
            Some(last) if part.as_rule() == Rule::indices => {
                last.indices = builder.list(part.into_inner(), depth + 1)?;
            }
            _ => segments.push(PathSegment { name: builder.name(&part)?, indices: Vec::new() }),
        }
    }
    let is_plain = segments.len() == 2 && segments.iter().all(|segment| segment.indices.is_empty());
    Ok(match (is_plain, segments.pop(), segments.pop()) {
        (true, Some(feature), Some(owner)) => ExprKind::Member { owner: owner.name, feature: feature.name },
        (_, Some(last), before) => {
            segments.extend(before);
            segments.push(last);
            ExprKind::Path(segments)
        }
        (_, None, _) => return Err(builder.truncated()),
    })
}

/// Returns the comparison that an operator means.
pub(super) fn comparison_sign(operator: &Pair<'_, Rule>) -> ComparisonSign {
    match operator.as_str() {
        "<" => ComparisonSign::Less,
        "<=" => ComparisonSign::LessEqual,
        ">" => ComparisonSign::Greater,
        ">=" => ComparisonSign::GreaterEqual,
        "==" => ComparisonSign::Equal,
        _ => ComparisonSign::NotEqual,
    }
}

fn within(depth: usize, span: Span) -> Built<()> {
    if depth > DEEPEST { Err(Box::new(errors::too_deep(span, DEEPEST))) } else { Ok(()) }
}

fn literal(builder: &Builder<'_>, pair: Pair<'_, Rule>) -> Built<ExprKind> {
    let mut parts = pair.into_inner();
    let number = parts.next().ok_or_else(|| builder.truncated())?;
    let value = number.as_str().parse().map_err(|_| builder.truncated())?;
    let Some(unit) = parts.next() else {
        return Ok(ExprKind::Literal { value, unit: None });
    };
    let name = builder.name(&unit)?;
    let power = match parts.next() {
        None => 1,
        Some(power) => unit_power(builder, &power)?,
    };
    Ok(ExprKind::Literal { value, unit: Some((name, power)) })
}

/// Builds the power of a unit, from its `^` on.
pub(super) fn unit_power(builder: &Builder<'_>, pair: &Pair<'_, Rule>) -> Built<i32> {
    // comments may stand between
    let digits: String =
        tokens(pair.as_str()).into_iter().map(|token| token.text).filter(|&text| text != "^").collect();
    let whole: Option<i32> = digits.parse().ok().filter(|p: &i32| (-100..=100).contains(p));
    whole.ok_or_else(|| {
        let (message, label) = ("the power of a unit is between -100 and 100", "too large");
        Box::new(errors::misplaced(builder.span(pair), message, label))
    })
}

fn conditional(builder: &Builder<'_>, pair: Pair<'_, Rule>, depth: usize) -> Built<Expr> {
    let span = builder.span(&pair);
    let mut parts = pair
        .into_inner()
        .filter(|part| part.as_rule() == Rule::expr)
        .map(|part| build(builder, part, depth + 1))
        .collect::<Built<Vec<_>>>()?;
    let otherwise = parts.pop().ok_or_else(|| builder.truncated())?;
    let mut parts = parts.into_iter();
    let mut arms = Vec::new();
    while let (Some(condition), Some(value)) = (parts.next(), parts.next()) {
        arms.push((condition, value));
    }
    Ok(Expr { kind: ExprKind::If { arms, otherwise: Box::new(otherwise) }, span })
}

/// Operands and operators in a row, read from the left, with one method per precedence level.
struct Row<'a, 'i, I: Iterator<Item = Pair<'i, Rule>>> {
    builder: &'a Builder<'a>,
    tokens: Peekable<I>,
    end: Span,
}

impl<'i, I: Iterator<Item = Pair<'i, Rule>>> Row<'_, 'i, I> {
    fn infix(&mut self, operators: &[&str]) -> Option<Pair<'i, Rule>> {
        let is_infix = |rule| matches!(rule, Rule::infix | Rule::arithmetic);
        self.tokens.next_if(|pair| is_infix(pair.as_rule()) && operators.contains(&pair.as_str()))
    }

    /// Consumes a prefix operator if it comes next.
    fn prefix(&mut self, operator: &str) -> Option<Pair<'i, Rule>> {
        self.tokens.next_if(|pair| pair.as_rule() == Rule::prefix && pair.as_str() == operator)
    }

    fn either(&mut self, depth: usize) -> Built<Expr> {
        let (first, mut rest) = (self.both(depth)?, Vec::new());
        while self.infix(&["or"]).is_some() {
            rest.push(self.both(depth)?);
        }
        Ok(flat(first, rest, ExprKind::Or))
    }

    fn both(&mut self, depth: usize) -> Built<Expr> {
        let (first, mut rest) = (self.negation(depth)?, Vec::new());
        while self.infix(&["and"]).is_some() {
            rest.push(self.negation(depth)?);
        }
        Ok(flat(first, rest, ExprKind::And))
    }

    fn negation(&mut self, depth: usize) -> Built<Expr> {
        match self.prefix("not") {
            Some(not) => {
                let span = self.builder.span(&not);
                within(depth + 1, span)?;
                let inner = self.negation(depth + 1)?;
                let span = span.to(inner.span);
                Ok(Expr { kind: ExprKind::Not(Box::new(inner)), span })
            }
            None => self.comparison(depth),
        }
    }

    fn comparison(&mut self, depth: usize) -> Built<Expr> {
        const OPERATORS: &[&str] = &["<", "<=", ">", ">=", "==", "!="];
        let left = self.sum(depth)?;
        let Some(operator) = self.infix(OPERATORS) else {
            return Ok(left);
        };
        let comparison = comparison_sign(&operator);
        let right = self.sum(depth)?;
        if let Some(second) = self.infix(OPERATORS) {
            return Err(Box::new(errors::chained_comparison(
                self.builder.span(&second),
                right.span,
                self.builder.text(right.span),
            )));
        }
        let span = left.span.to(right.span);
        Ok(Expr { kind: ExprKind::Compare(Box::new(left), comparison, Box::new(right)), span })
    }

    fn sum(&mut self, depth: usize) -> Built<Expr> {
        let first = self.product(depth)?;
        let mut rest = Vec::new();
        while let Some(operator) = self.infix(&["+", "-"]) {
            let sign = if operator.as_str() == "+" { Sign::Plus } else { Sign::Minus };
            rest.push((sign, self.product(depth)?));
        }
        let Some((_, last)) = rest.last() else {
            return Ok(first);
        };
        let span = first.span.to(last.span);
        Ok(Expr { kind: ExprKind::Sum(Box::new(first), rest), span })
    }

    fn product(&mut self, depth: usize) -> Built<Expr> {
        let first = self.signed(depth)?;
        let mut rest = Vec::new();
        while let Some(operator) = self.infix(&["*", "/"]) {
            let factor = if operator.as_str() == "*" { Factor::Times } else { Factor::Divide };
            rest.push((factor, self.signed(depth)?));
        }
        let Some((_, last)) = rest.last() else {
            return Ok(first);
        };
        let span = first.span.to(last.span);
        Ok(Expr { kind: ExprKind::Product(Box::new(first), rest), span })
    }

    fn signed(&mut self, depth: usize) -> Built<Expr> {
        match self.prefix("-") {
            Some(minus) => {
                let span = self.builder.span(&minus);
                within(depth + 1, span)?;
                let inner = self.signed(depth + 1)?;
                let span = span.to(inner.span);
                Ok(Expr { kind: ExprKind::Negate(Box::new(inner)), span })
            }
            None => self.power(depth),
        }
    }

    fn power(&mut self, depth: usize) -> Built<Expr> {
        let base = self.operand(depth)?;
        let Some(operator) = self.infix(&["^"]) else {
            return Ok(base);
        };
        within(depth + 1, self.builder.span(&operator))?;
        if let ExprKind::Literal { unit: Some((_, 1)), .. } = base.kind {
            let literal = &self.builder.text(base.span);
            if !literal.contains('^') {
                return Err(Box::new(errors::unit_power(self.builder.span(&operator), base.span, literal)));
            }
        }
        let exponent = self.signed(depth + 1)?;
        let mut bare = &exponent;
        while let ExprKind::Negate(inner) = &bare.kind {
            bare = inner;
        }
        let base_of_exponent = if let ExprKind::Power(inner, _) = &bare.kind { inner } else { bare };
        if let ExprKind::Literal { unit: Some(_), .. } = base_of_exponent.kind {
            return Err(Box::new(errors::quantity_as_exponent(base_of_exponent.span)));
        }
        let span = base.span.to(exponent.span);
        Ok(Expr { kind: ExprKind::Power(Box::new(base), Box::new(exponent)), span })
    }

    fn operand(&mut self, depth: usize) -> Built<Expr> {
        match self.tokens.next() {
            // `2 * not a`: a condition where a number must stand
            Some(pair) if pair.as_rule() == Rule::prefix => {
                let span = self.builder.span(&pair);
                Err(Box::new(errors::misplaced(
                    span,
                    "`not` cannot stand inside an operator without parentheses",
                    "a condition begins here",
                )))
            }
            Some(pair) => build_operand(self.builder, pair, depth),
            None => Err(Box::new(errors::misplaced(self.end, "a formula is not complete", "an operand is missing"))),
        }
    }
}

/// Returns a single operand as it is, several as one form.
fn flat(first: Expr, mut rest: Vec<Expr>, form: fn(Vec<Expr>) -> ExprKind) -> Expr {
    let Some(last) = rest.last() else {
        return first;
    };
    let span = first.span.to(last.span);
    rest.insert(0, first);
    Expr { kind: form(rest), span }
}
