//! MATLAB formulas of `t` to formulas of the language.
//!
//! All values are real scalars, so that `.*` is `*`, and a transposing `'` does nothing. Where MATLAB groups otherwise than the language (`2^3^2` is
//! `(2^3)^2`), the tree says what MATLAB means; the parentheses come with its printing. What has no counterpart is refused with its place. Values are
//! not computed here: that a constant is infinite is for `check` to find.

mod functions;
mod parser;
mod term;
mod tokens;

use super::errors;
use super::value::Quoted;
use crate::ast::{Expr, ExprKind};
use crate::{DEEPEST, format, parse_expression};
use mechc_text::diag::Diagnostic;
use mechc_text::source::Sources;

/// A formula of the language, with the places of the MATLAB text that it comes from.
pub(super) struct Formula {
    pub expression: Expr,
    /// True if it contains `t`.
    pub uses_time: bool,
}

/// A fault is rare and large; the way without one should be quick.
type Built<T> = Result<T, Box<Diagnostic>>;

/// The largest formula that is written, in parts.
const LARGEST: usize = 100_000;

/// Translates a formula.
pub(super) fn translate(text: &Quoted) -> Built<Formula> {
    let tokens = tokens::tokens(text)?;
    let place = text.place(0, text.text.len());
    if tokens.is_empty() {
        let help = "a formula of `t`, or a number: `\"fun\": \"0\"`";
        return Err(Box::new(errors::fault(text.span, "the formula is empty", "no formula").help(help)));
    }
    if text.text.trim() == "NONE" {
        let help = "only joints need none; write a formula of `t`, or a number: `\"fun\": \"0\"`";
        return Err(Box::new(errors::fault(place, "the constraint has no formula", "no formula").help(help)));
    }
    let expression = parser::parse(&tokens, text)?;
    let size = measure(&expression);
    // the language counts parentheses that only its text has: what it reads back is what counts
    if size.height > DEEPEST || !reads_back(&expression) {
        return Err(Box::new(errors::formula_too_deep(place)));
    }
    Ok(Formula { expression, uses_time: size.uses_time })
}

fn reads_back(expression: &Expr) -> bool {
    let mut sources = Sources::default();
    let file = sources.add("formula", format::expression(expression));
    parse_expression(&sources, file).is_ok()
}

/// Size of a formula.
struct Size {
    parts: usize,
    height: usize,
    uses_time: bool,
}

fn measure(e: &Expr) -> Size {
    let mut size = Size { parts: 0, height: 0, uses_time: false };
    let mut open = vec![(e, 1)];
    while let Some((e, height)) = open.pop() {
        size.parts += 1;
        size.height = size.height.max(height);
        size.uses_time |= matches!(&e.kind, ExprKind::Name(name) if name.text == "t");
        open.extend(e.children().into_iter().map(|child| (child, height + 1)));
    }
    size
}
