//! The functions and constants of MATLAB that have a counterpart, as a table of formulas of the language.

use super::Built;
use super::term::Term;
use crate::ast::{Expr, ExprKind, Factor};
use crate::import::build;
use crate::import::errors;
use crate::parse_expression;
use mechc_text::diag::{Diagnostic, nearest};
use mechc_text::source::{Sources, Span};

/// Each function with the number of its arguments and what it means in the language; `a` and `b` are the arguments.
const FUNCTIONS: &[(&str, usize, &str)] = &[
    ("sin", 1, "sin(a)"),
    ("cos", 1, "cos(a)"),
    ("tan", 1, "tan(a)"),
    ("sec", 1, "1 / cos(a)"),
    ("csc", 1, "1 / sin(a)"),
    ("cot", 1, "1 / tan(a)"),
    ("asin", 1, "asin(a)"),
    ("acos", 1, "acos(a)"),
    ("atan", 1, "atan(a)"),
    ("atan2", 2, "atan2(a, b)"),
    ("sind", 1, "sin(a * 1 deg)"),
    ("cosd", 1, "cos(a * 1 deg)"),
    ("tand", 1, "tan(a * 1 deg)"),
    ("asind", 1, "asin(a) / 1 deg"),
    ("acosd", 1, "acos(a) / 1 deg"),
    ("atand", 1, "atan(a) / 1 deg"),
    ("atan2d", 2, "atan2(a, b) / 1 deg"),
    ("sinpi", 1, "sin(pi * a)"),
    ("cospi", 1, "cos(pi * a)"),
    ("deg2rad", 1, "a * 1 deg"),
    ("rad2deg", 1, "a / 1 deg"),
    ("sinh", 1, "sinh(a)"),
    ("cosh", 1, "cosh(a)"),
    ("tanh", 1, "tanh(a)"),
    ("sech", 1, "1 / cosh(a)"),
    ("csch", 1, "1 / sinh(a)"),
    ("coth", 1, "1 / tanh(a)"),
    ("exp", 1, "exp(a)"),
    ("expm1", 1, "exp(a) - 1"),
    ("log", 1, "ln(a)"),
    ("log1p", 1, "ln(1 + a)"),
    ("log2", 1, "ln(a) / ln(2)"),
    ("log10", 1, "log10(a)"),
    ("sqrt", 1, "sqrt(a)"),
    ("hypot", 2, "hypot(a, b)"),
    ("abs", 1, "abs(a)"),
    ("sign", 1, "sign(a)"),
    ("heaviside", 1, "(1 + sign(a)) / 2"),
    ("min", 2, "min(a, b)"),
    ("max", 2, "max(a, b)"),
    ("mod", 2, "mod(a, b)"),
    ("rem", 2, "sign(a) * mod(abs(a), abs(b))"),
    ("floor", 1, "a - mod(a, 1)"),
    ("ceil", 1, "a + mod(-a, 1)"),
    ("fix", 1, "sign(a) * (abs(a) - mod(abs(a), 1))"),
    ("round", 1, "sign(a) * (abs(a) + 0.5 - mod(abs(a) + 0.5, 1))"),
    ("plus", 2, "a + b"),
    ("minus", 2, "a - b"),
    ("times", 2, "a * b"),
    ("mtimes", 2, "a * b"),
    ("rdivide", 2, "a / b"),
    ("mrdivide", 2, "a / b"),
    ("ldivide", 2, "b / a"),
    ("mldivide", 2, "b / a"),
    ("power", 2, "a ^ b"),
    ("mpower", 2, "a ^ b"),
    ("uminus", 1, "-a"),
    ("uplus", 1, "a"),
];

/// Returns whether a name has a meaning in a formula.
pub(super) fn is_known(name: &str) -> bool {
    matches!(name, "t" | "pi") || FUNCTIONS.iter().any(|(function, ..)| *function == name)
}

/// Returns a name that is not called.
pub(super) fn constant(name: &str, span: Span) -> Built<Term> {
    let expression = match name {
        "t" | "pi" => build::word(name, span),
        "eps" => build::number(f64::EPSILON, span),
        "true" => build::number(1.0, span),
        "false" => build::number(0.0, span),
        _ => return Err(Box::new(no_constant(name, span))),
    };
    Ok(Term::number(expression))
}

fn no_constant(name: &str, span: Span) -> Diagnostic {
    let refused = |message: &str, help: &str| {
        let fault = errors::fault(span, message, "cannot be translated");
        fault.help_if((!help.is_empty()).then(|| help.to_owned()))
    };
    match name {
        "i" | "j" | "I" | "J" => {
            refused(&format!("`{name}` is the imaginary unit, and formulas have real values only"), "")
        }
        "e" => refused("MATLAB has no constant `e`", "write `exp(1)`"),
        "Inf" | "inf" | "NaN" | "nan" => refused(&format!("`{name}` is not a finite number"), ""),
        "T" | "time" => refused(&format!("`{name}` has no value here"), "time is called `t`"),
        "PI" | "Pi" => refused(&format!("`{name}` has no value here"), "write `pi`"),
        _ => match FUNCTIONS.iter().find(|(function, ..)| *function == name) {
            Some((_, 1, _)) => refused(&format!("`{name}` needs an argument"), &format!("write `{name}(…)`")),
            Some(_) => refused(&format!("`{name}` needs arguments"), &format!("write `{name}(…, …)`")),
            None => {
                let near =
                    nearest(name, ["t", "pi"].into_iter().chain(FUNCTIONS.iter().map(|(function, ..)| *function)));
                let help =
                    near.map_or("a formula may use `t` and `pi`".to_owned(), |near| format!("was `{near}` meant?"));
                refused(&format!("`{name}` has no value here"), &help)
            }
        },
    }
}

/// Returns a call in the language's words.
pub(super) fn call(name: &str, name_span: Span, arguments: &[Expr], span: Span) -> Built<Expr> {
    let Some(&(_, count, formula)) = FUNCTIONS.iter().find(|(function, ..)| *function == name) else {
        let near = nearest(name, FUNCTIONS.iter().map(|(function, ..)| *function));
        let is_constant = matches!(name, "t" | "pi");
        let help = if is_constant {
            Some(format!("a product is written with `*`: `{name}*(…)`"))
        } else {
            near.map(|near| format!("was `{near}` meant?"))
        };
        let message = format!("the function `{name}` cannot be translated");
        return Err(Box::new(errors::fault(name_span, message, "no counterpart").help_if(help)));
    };
    if arguments.len() != count {
        let expected = if count == 1 { "one argument" } else { "two arguments" };
        let message = format!("`{name}` takes {expected} here, found {}", arguments.len());
        return Err(Box::new(errors::fault(span, message, format!("expected {expected}"))));
    }
    let mut sources = Sources::default();
    let file = sources.add("function", formula);
    let meaning = parse_expression(&sources, file);
    // the table's formulas are of the language, as its tests show
    meaning.map(|meaning| with_arguments(&meaning, arguments, span)).map_err(|_| {
        Box::new(errors::fault(name_span, format!("the function `{name}` cannot be translated"), "no counterpart"))
    })
}

/// Returns a formula of the table with the arguments in their places.
fn with_arguments(e: &Expr, arguments: &[Expr], span: Span) -> Expr {
    let inside = |e: &Expr| Box::new(with_arguments(e, arguments, span));
    let kind = match &e.kind {
        ExprKind::Name(name) => {
            let position = ["a", "b"].iter().position(|argument| name.text == *argument);
            match position.and_then(|position| arguments.get(position)) {
                Some(argument) => return argument.clone(),
                None => ExprKind::Name(build::name(&name.text, span)),
            }
        }
        ExprKind::Call { name, arguments: list, .. } => {
            let mut list: Vec<Expr> = list.iter().map(|e| with_arguments(e, arguments, span)).collect();
            // a literal has no sign
            if name.text == "abs" && matches!(list.as_slice(), [Expr { kind: ExprKind::Literal { .. }, .. }]) {
                return list.remove(0);
            }
            return build::call(&name.text, list, span);
        }
        ExprKind::Paren(e) => return *inside(e),
        ExprKind::Negate(e) => ExprKind::Negate(inside(e)),
        ExprKind::Sum(first, rest) => {
            ExprKind::Sum(inside(first), rest.iter().map(|(sign, e)| (*sign, *inside(e))).collect())
        }
        ExprKind::Product(first, rest) => {
            let rest = rest.iter().map(|(factor, e)| (*factor, *inside(e))).collect();
            in_degrees(*inside(first), rest)
        }
        ExprKind::Power(base, exponent) => ExprKind::Power(inside(base), inside(exponent)),
        other => other.clone(),
    };
    Expr { kind, span }
}

/// Returns a product; `90 * 1 deg` becomes `90 deg`, and `90 * t * 1 deg` becomes `90 deg * t`.
fn in_degrees(first: Expr, rest: Vec<(Factor, Expr)>) -> ExprKind {
    let [(Factor::Times, Expr { kind: ExprKind::Literal { unit: unit @ Some(_), .. }, .. })] = rest.as_slice() else {
        return ExprKind::Product(Box::new(first), rest);
    };
    let with_unit = |e: &Expr| match e.kind {
        ExprKind::Literal { value, unit: None } => {
            Some(Expr { kind: ExprKind::Literal { value, unit: unit.clone() }, span: e.span })
        }
        _ => None,
    };
    if let Some(quantity) = with_unit(&first) {
        return quantity.kind;
    }
    match first.kind {
        ExprKind::Product(number, factors) => match with_unit(&number) {
            Some(quantity) => ExprKind::Product(Box::new(quantity), factors),
            None => {
                ExprKind::Product(Box::new(Expr { kind: ExprKind::Product(number, factors), span: first.span }), rest)
            }
        },
        _ => ExprKind::Product(Box::new(first), rest),
    }
}
