//! Nodes of the tree, made rather than read.

use crate::ast::{Expr, ExprKind, Name};
use mechc_text::source::Span;

/// Notation of a zero.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Zero {
    /// `0`, which fits anything.
    Bare,
    /// `0 s`
    WithUnit,
}

/// Returns a number without a unit.
pub(super) fn number(value: f64, span: Span) -> Expr {
    signed(value, None, span)
}

/// Returns a number with its unit.
pub(super) fn quantity(value: f64, unit: &str, span: Span, zero: Zero) -> Expr {
    let without = zero == Zero::Bare && value.abs() <= 0.0;
    let unit = (!without).then(|| (name(unit, span), 1));
    signed(value, unit, span)
}

/// Returns a length: `0.2 m`, or `0`.
pub(super) fn length(value: f64, span: Span) -> Expr {
    quantity(value, "m", span, Zero::Bare)
}

/// Returns an angle: `0.5 rad`, or `0`.
pub(super) fn angle(value: f64, span: Span) -> Expr {
    quantity(value, "rad", span, Zero::Bare)
}

/// Returns a number with a sign, which is an operator: the language has no negative literals.
fn signed(value: f64, unit: Option<(Name, i32)>, span: Span) -> Expr {
    let literal = Expr { kind: ExprKind::Literal { value: value.abs(), unit }, span };
    if value < 0.0 { Expr { kind: ExprKind::Negate(Box::new(literal)), span } } else { literal }
}

/// Returns a name in the tree.
pub(super) fn name(text: &str, span: Span) -> Name {
    Name { text: text.to_owned(), span }
}

/// Returns `(a, b)`.
pub(super) fn tuple(parts: Vec<Expr>, span: Span) -> Expr {
    Expr { kind: ExprKind::Tuple(parts), span }
}

/// Returns `body.feature`.
pub(super) fn member(owner: &str, feature: &str, span: Span) -> Expr {
    Expr { kind: ExprKind::Member { owner: name(owner, span), feature: name(feature, span) }, span }
}

/// Returns `f(a, b)`.
pub(super) fn call(function: &str, arguments: Vec<Expr>, span: Span) -> Expr {
    Expr { kind: ExprKind::Call { name: name(function, span), arguments, window: None }, span }
}

/// Returns a name alone.
pub(super) fn word(text: &str, span: Span) -> Expr {
    Expr { kind: ExprKind::Name(name(text, span)), span }
}
