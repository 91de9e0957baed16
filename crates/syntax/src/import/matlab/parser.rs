//! Parser of formulas with MATLAB's precedences.
//!
//! Loosest first, all from the left: `||`, `&&`, `|`, `&`, comparisons, `+ -`, `* /`, signs and `~`, `^` and `'`. A
//! sign behind `^` belongs to the exponent.

use super::functions;
use super::term::Term;
use super::tokens::{Token, TokenKind};
use super::{Built, LARGEST, measure};
use crate::DEEPEST;
use crate::ast::{ComparisonSign, Expr, ExprKind, Factor, Sign};
use crate::import::build;
use crate::import::errors;
use crate::import::value::Quoted;
use mechc_text::source::Span;

/// Operation of an infix operator.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Infix {
    Or,
    And,
    Compare(ComparisonSign),
    Sum(Sign),
    Product(Factor),
    LeftDivision,
    Power,
}

/// The infix operators with their precedences.
const INFIX: &[(&str, u8, Infix)] = &[
    ("||", 1, Infix::Or),
    ("&&", 2, Infix::And),
    ("|", 3, Infix::Or),
    ("&", 4, Infix::And),
    ("<", 5, Infix::Compare(ComparisonSign::Less)),
    ("<=", 5, Infix::Compare(ComparisonSign::LessEqual)),
    (">", 5, Infix::Compare(ComparisonSign::Greater)),
    (">=", 5, Infix::Compare(ComparisonSign::GreaterEqual)),
    ("==", 5, Infix::Compare(ComparisonSign::Equal)),
    ("~=", 5, Infix::Compare(ComparisonSign::NotEqual)),
    ("+", 6, Infix::Sum(Sign::Plus)),
    ("-", 6, Infix::Sum(Sign::Minus)),
    ("*", 7, Infix::Product(Factor::Times)),
    (".*", 7, Infix::Product(Factor::Times)),
    ("/", 7, Infix::Product(Factor::Divide)),
    ("./", 7, Infix::Product(Factor::Divide)),
    ("\\", 7, Infix::LeftDivision),
    (".\\", 7, Infix::LeftDivision),
    ("^", POWER, Infix::Power),
    (".^", POWER, Infix::Power),
];

/// Binding strength of a sign; looser operators do not enter its operand.
const SIGN: u8 = 8;
const POWER: u8 = 9;

/// Parses the tokens of a formula.
pub(super) fn parse(tokens: &[Token<'_>], text: &Quoted) -> Built<Expr> {
    let end = text.place(text.text.len(), text.text.len());
    let mut parser = Parser { tokens, at: 0, end };
    let term = parser.term(0, 0)?;
    match parser.peek() {
        None => Ok(term.into_number()),
        Some(token) => Err(Box::new(parser.unexpected(token))),
    }
}

struct Parser<'a> {
    tokens: &'a [Token<'a>],
    at: usize,
    end: Span,
}

impl<'a> Parser<'a> {
    fn peek(&self) -> Option<Token<'a>> {
        self.tokens.get(self.at).copied()
    }

    fn sign(&mut self, expected: &str) -> Option<Token<'a>> {
        let token = self.peek().filter(|token| matches!(token.kind, TokenKind::Sign(sign) if sign == expected))?;
        self.at += 1;
        Some(token)
    }

    fn unexpected(&self, token: Token<'_>) -> mechc_text::diag::Diagnostic {
        let is_operand = matches!(token.kind, TokenKind::Number(_) | TokenKind::Name(_)) || token.text == "(";
        let help = (is_operand && self.at > 0).then(|| "a product is written with `*`".to_owned());
        let message = format!("expected an operator, found `{}`", token.text);
        errors::fault(token.span, message, "expected an operator").help_if(help)
    }

    /// Parses an operand and the infix operators behind it whose precedence is at least `loosest`; `depth` limits nesting.
    fn term(&mut self, loosest: u8, depth: usize) -> Built<Term> {
        let mut left = self.operand(depth)?;
        while let Some(token) = self.peek() {
            let TokenKind::Sign(sign) = token.kind else { break };
            let Some(&(_, precedence, infix)) = INFIX.iter().find(|(name, ..)| *name == sign) else { break };
            if precedence < loosest {
                break;
            }
            self.at += 1;
            let right = if infix == Infix::Power { self.exponent(depth)? } else { self.term(precedence + 1, depth)? };
            left = join(left, infix, right);
            // a chain of powers or comparisons grows at its left, where nothing else counts its depth
            let grows = matches!(infix, Infix::Power | Infix::Compare(_) | Infix::LeftDivision);
            if grows && measure(left.expression()).height > DEEPEST {
                return Err(Box::new(errors::formula_too_deep(token.span)));
            }
        }
        Ok(left)
    }

    /// Parses signs and `~` with the operand that they apply to, or a primary.
    fn operand(&mut self, depth: usize) -> Built<Term> {
        let Some(token) = self.peek() else {
            let message = "expected a value, found the end of the formula";
            return Err(Box::new(errors::fault(self.end, message, "expected a value")));
        };
        if depth > DEEPEST {
            return Err(Box::new(errors::formula_too_deep(token.span)));
        }
        let TokenKind::Sign(sign @ ("-" | "+" | "~")) = token.kind else {
            return self.primary(depth);
        };
        self.at += 1;
        let operand = self.term(SIGN, depth + 1)?;
        Ok(signed(sign, operand, token.span))
    }

    /// Parses the exponent behind `^`: signs with a primary, so that the next `^` takes the whole power as its base.
    fn exponent(&mut self, depth: usize) -> Built<Term> {
        let mut signs = Vec::new();
        while let Some(token) = self.peek() {
            let TokenKind::Sign(sign @ ("-" | "+" | "~")) = token.kind else { break };
            signs.push((sign, token.span));
            self.at += 1;
        }
        if let Some((_, span)) = signs.get(DEEPEST.saturating_sub(depth)) {
            return Err(Box::new(errors::formula_too_deep(*span)));
        }
        let exponent = match self.peek() {
            Some(_) => self.primary(depth)?,
            None => self.operand(depth)?,
        };
        if let (Some((sign, _)), Some(next)) = (signs.first(), self.peek())
            && matches!(next.text, "^" | ".^")
        {
            let message = format!("a power whose exponent has a `{sign}` cannot stand before another `{}`", next.text);
            let help = "say with parentheses what is meant: `(a^-b)^c` or `a^-(b^c)`";
            return Err(Box::new(errors::fault(next.span, message, "groups in two ways").help(help)));
        }
        Ok(signs.into_iter().rev().fold(exponent, |exponent, (sign, span)| signed(sign, exponent, span)))
    }

    /// Parses a number, a name, a call or parentheses, with transpositions behind it.
    fn primary(&mut self, depth: usize) -> Built<Term> {
        let Some(token) = self.peek() else {
            return self.operand(depth);
        };
        self.at += 1;
        let term = match token.kind {
            TokenKind::Number(value) => Term::number(build::number(value, token.span)),
            TokenKind::Name(_) => match self.sign("(") {
                None => functions::constant(token.text, token.span)?,
                Some(open) => {
                    let (arguments, close) = self.arguments(open, depth + 1)?;
                    let span = token.span.to(close);
                    let call = functions::call(token.text, token.span, &arguments, span)?;
                    if measure(&call).parts > LARGEST {
                        return Err(Box::new(errors::formula_too_large(token.span)));
                    }
                    Term::number(call)
                }
            },
            TokenKind::Sign("(") => {
                let inner = self.term(0, depth + 1)?;
                self.close(token)?;
                inner
            }
            TokenKind::Sign(_) => {
                let message = format!("expected a value, found `{}`", token.text);
                let help = (token.text == "'").then(|| "text has no value here".to_owned());
                return Err(Box::new(errors::fault(token.span, message, "expected a value").help_if(help)));
            }
        };
        while self.sign("'").or_else(|| self.sign(".'")).is_some() {}
        Ok(term)
    }

    fn arguments(&mut self, open: Token<'_>, depth: usize) -> Built<(Vec<Expr>, Span)> {
        let mut arguments = Vec::new();
        if let Some(close) = self.sign(")") {
            return Ok((arguments, close.span));
        }
        loop {
            arguments.push(self.term(0, depth)?.into_number());
            if self.sign(",").is_none() {
                return Ok((arguments, self.close(open)?));
            }
        }
    }

    fn close(&mut self, open: Token<'_>) -> Built<Span> {
        if let Some(close) = self.sign(")") {
            return Ok(close.span);
        }
        Err(Box::new(match self.peek() {
            Some(token) => self.unexpected(token),
            None => errors::fault(open.span, "this `(` is not closed", "opened here"),
        }))
    }
}

fn signed(sign: &str, operand: Term, at: Span) -> Term {
    match sign {
        "~" => operand.not(),
        // unary plus makes a number of a truth value, as every arithmetic operator does
        "+" => Term::number(operand.into_number()),
        _ => {
            let operand = operand.into_number();
            let span = at.to(operand.span);
            Term::number(Expr { kind: ExprKind::Negate(Box::new(operand)), span })
        }
    }
}

fn join(left: Term, infix: Infix, right: Term) -> Term {
    let span = left.expression().span.to(right.expression().span);
    let kind = match infix {
        Infix::Or => return Term::truth(conditions(left, right, span, true)),
        Infix::And => return Term::truth(conditions(left, right, span, false)),
        Infix::Compare(comparison) => {
            let (left, right) = (Box::new(left.into_number()), Box::new(right.into_number()));
            return Term::truth(Expr { kind: ExprKind::Compare(left, comparison, right), span });
        }
        Infix::Sum(sign) => sum(left.into_number(), sign, right.into_number()),
        Infix::Product(factor) => product(left.into_number(), factor, right.into_number()),
        Infix::LeftDivision => product(right.into_number(), Factor::Divide, left.into_number()),
        Infix::Power => ExprKind::Power(Box::new(left.into_number()), Box::new(right.into_number())),
    };
    Term::number(Expr { kind, span })
}

/// Returns `a or b`, or `a and b`; a chain of one operator stays flat.
fn conditions(left: Term, right: Term, span: Span, either: bool) -> Expr {
    let left = left.into_condition();
    let right = right.into_condition();
    let kind = match (left.kind, either) {
        (ExprKind::Or(mut list), true) => {
            list.push(right);
            ExprKind::Or(list)
        }
        (ExprKind::And(mut list), false) => {
            list.push(right);
            ExprKind::And(list)
        }
        (kind, either) => {
            let list = vec![Expr { kind, span: left.span }, right];
            if either { ExprKind::Or(list) } else { ExprKind::And(list) }
        }
    };
    Expr { kind, span }
}

/// Returns `a + b`; a further term extends the sum.
pub(super) fn sum(left: Expr, sign: Sign, right: Expr) -> ExprKind {
    match left.kind {
        ExprKind::Sum(first, mut rest) => {
            rest.push((sign, right));
            ExprKind::Sum(first, rest)
        }
        _ => ExprKind::Sum(Box::new(left), vec![(sign, right)]),
    }
}

/// Returns `a * b`; a further factor extends the product.
pub(super) fn product(left: Expr, factor: Factor, right: Expr) -> ExprKind {
    match left.kind {
        ExprKind::Product(first, mut rest) => {
            rest.push((factor, right));
            ExprKind::Product(first, rest)
        }
        _ => ExprKind::Product(Box::new(left), vec![(factor, right)]),
    }
}
