//! Formulas as text, with the parentheses that their meaning needs and no others.
//!
//! [`Level`] says how tightly a form binds. A form that binds more loosely than its place allows gets parentheses;
//! those of the tree itself count for nothing, so that a tree which was never written down prints right as well.

use crate::ast::{ComparisonSign, Expr, ExprKind, Factor, Sign, Window};
use mechc_text::vocabulary::Unit;

/// Binding strength of a form, loosest first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    If,
    Or,
    And,
    Not,
    Compare,
    Sum,
    Product,
    Negate,
    Power,
    /// A number with its unit, which can be neither base nor exponent of a power.
    Quantity,
    Operand,
}

impl Level {
    fn of(e: &Expr) -> Level {
        match &e.kind {
            ExprKind::If { .. } => Level::If,
            ExprKind::Or(_) => Level::Or,
            ExprKind::And(_) => Level::And,
            ExprKind::Not(_) => Level::Not,
            ExprKind::Compare(..) => Level::Compare,
            ExprKind::Sum(..) => Level::Sum,
            ExprKind::Product(..) => Level::Product,
            // no text has a negative literal, but a tree of another origin may
            ExprKind::Literal { value, .. } if value.is_sign_negative() => Level::Negate,
            ExprKind::Negate(_) => Level::Negate,
            ExprKind::Power(..) => Level::Power,
            ExprKind::Literal { unit: Some(_), .. } => Level::Quantity,
            ExprKind::Literal { unit: None, .. }
            | ExprKind::Name(_)
            | ExprKind::Member { .. }
            | ExprKind::Path(_)
            | ExprKind::Call { .. }
            | ExprKind::Paren(_)
            | ExprKind::Tuple(_) => Level::Operand,
        }
    }
}

/// Returns a formula as text, which reads back as the same formula.
///
/// A number is written as the shortest decimal that reads back to the same `f64`. Sums, products and `else if` chains
/// that nest where it changes nothing (`(a + b) + c`) become flat.
#[must_use]
pub fn expression(e: &Expr) -> String {
    let mut text = String::new();
    write(&mut text, e, Level::If);
    text
}

/// Writes a formula into a place where nothing looser than `loosest` can stand.
fn write(text: &mut String, e: &Expr, loosest: Level) {
    let e = e.bare();
    if Level::of(e) < loosest {
        in_parentheses(text, e);
    } else {
        write_bare(text, e);
    }
}

fn in_parentheses(text: &mut String, e: &Expr) {
    *text += "(";
    write_bare(text, e);
    *text += ")";
}

fn write_bare(text: &mut String, e: &Expr) {
    match &e.kind {
        ExprKind::Literal { value, unit } => {
            *text += &number(*value);
            if let Some((unit, power)) = unit {
                *text += &format!(" {}", unit.text);
                if *power != 1 {
                    *text += &format!("^{power}");
                }
            }
        }
        ExprKind::Name(name) => *text += &name.text,
        ExprKind::Member { owner, feature } => *text += &format!("{}.{}", owner.text, feature.text),
        ExprKind::Path(segments) => {
            for (k, segment) in segments.iter().enumerate() {
                *text += if k > 0 { "." } else { "" };
                *text += &segment.name.text;
                if !segment.indices.is_empty() {
                    let indices: Vec<String> = segment.indices.iter().map(expression).collect();
                    *text += &format!("[{}]", indices.join(", "));
                }
            }
        }
        ExprKind::Call { name, arguments, window } => {
            *text += &name.text;
            write_list(text, arguments, window.as_deref());
        }
        ExprKind::Tuple(list) => write_list(text, list, None),
        ExprKind::Paren(inner) => write(text, inner, Level::If),
        ExprKind::Negate(inner) => {
            *text += "-";
            write(text, inner, Level::Negate);
        }
        ExprKind::Not(inner) => {
            *text += "not ";
            write(text, inner, Level::Not);
        }
        ExprKind::Sum(first, rest) => write_sum(text, first, rest),
        ExprKind::Product(first, rest) => {
            write_product(text, first, rest);
        }
        ExprKind::Power(base, exponent) => {
            write(text, base, Level::Operand);
            *text += "^";
            write_exponent(text, exponent);
        }
        ExprKind::Compare(left, comparison, right) => {
            write(text, left, Level::Sum);
            *text += &format!(" {} ", comparison_sign(*comparison));
            write(text, right, Level::Sum);
        }
        ExprKind::And(list) => write_chain(text, list, " and ", Level::And),
        ExprKind::Or(list) => write_chain(text, list, " or ", Level::Or),
        ExprKind::If { arms, otherwise } => {
            for (condition, value) in arms {
                *text += "if ";
                write(text, condition, Level::If);
                *text += " then ";
                write(text, value, Level::If);
                *text += " else ";
            }
            write(text, otherwise, Level::If);
        }
    }
}

fn write_list(text: &mut String, list: &[Expr], window: Option<&Window>) {
    *text += "(";
    write_chain(text, list, ", ", Level::If);
    if let Some(Window { from, to, .. }) = window {
        *text += ",";
        let first = text.len();
        for (word, bound) in [("from", from), ("to", to)] {
            if let Some(bound) = bound {
                let is_first = text.len() == first;
                *text += &format!(" {word} ");
                write_bound(text, bound, is_first);
            }
        }
    }
    *text += ")";
}

/// Appends a time of a window. A leading sign needs parentheses, as `from` would be read as a name otherwise.
fn write_bound(text: &mut String, bound: &Expr, is_first: bool) {
    let start = text.len();
    write(text, bound, Level::If);
    if is_first && text[start..].starts_with('-') {
        text.insert(start, '(');
        *text += ")";
    }
}

/// Operands that may nest in each other without a change of meaning, and items of a list.
fn write_chain(text: &mut String, list: &[Expr], between: &str, loosest: Level) {
    for (k, e) in list.iter().enumerate() {
        if k > 0 {
            *text += between;
        }
        write(text, e, loosest);
    }
}

fn write_sum(text: &mut String, first: &Expr, rest: &[(Sign, Expr)]) {
    write(text, first, Level::Sum);
    for (sign, e) in rest {
        *text += match sign {
            Sign::Plus => " + ",
            Sign::Minus => " - ",
        };
        // `a + (b + c)` rounds otherwise than `a + b + c`, so it keeps its parentheses
        write(text, e, Level::Product);
    }
}

/// Says whether a number with its units stands last, to which another unit may be joined: `30 deg/s * t`, but not
/// `a / 30 deg/s`, which would look like a / (30 deg/s).
fn write_product(text: &mut String, first: &Expr, rest: &[(Factor, Expr)]) -> bool {
    let mut in_quantity = if let ExprKind::Product(first, rest) = &first.bare().kind {
        write_product(text, first, rest)
    } else {
        write(text, first, Level::Product);
        is_quantity(first)
    };
    for (factor, e) in rest {
        in_quantity = match factor {
            Factor::Divide if in_quantity && is_unit(e) => {
                *text += "/";
                true
            }
            Factor::Divide => {
                *text += " / ";
                false
            }
            Factor::Times => {
                *text += " * ";
                is_quantity(e)
            }
        };
        write(text, e, Level::Negate);
    }
    in_quantity
}

fn is_quantity(e: &Expr) -> bool {
    matches!(e.bare().kind, ExprKind::Literal { unit: Some(_), .. })
}

/// Returns whether an operand looks like a unit, `s` or `s^2`, which stands behind a number without spaces, as in `9.81 m/s^2`.
fn is_unit(e: &Expr) -> bool {
    match &e.bare().kind {
        ExprKind::Name(name) => Unit::named(&name.text).is_some(),
        ExprKind::Power(base, exponent) => {
            matches!(base.bare().kind, ExprKind::Name(_)) && is_unit(base) && exponent.bare_number().is_some()
        }
        _ => false,
    }
}

/// Writes the exponent behind `^`: a sign needs no parentheses there, a unit does, also behind a sign.
fn write_exponent(text: &mut String, e: &Expr) {
    let e = e.bare();
    match &e.kind {
        ExprKind::Literal { unit: Some(_), .. } => in_parentheses(text, e),
        ExprKind::Negate(inner) => {
            *text += "-";
            write_exponent(text, inner);
        }
        _ => write(text, e, Level::Negate),
    }
}

pub(super) fn comparison_sign(comparison: ComparisonSign) -> &'static str {
    match comparison {
        ComparisonSign::Less => "<",
        ComparisonSign::LessEqual => "<=",
        ComparisonSign::Greater => ">",
        ComparisonSign::GreaterEqual => ">=",
        ComparisonSign::Equal => "==",
        ComparisonSign::NotEqual => "!=",
    }
}

/// Returns the shortest decimal that reads back to the same number.
fn number(value: f64) -> String {
    if value.is_infinite() {
        // too large a number reads as infinite, and `check` refuses it with its span
        return if value > 0.0 { "1e999" } else { "-1e999" }.to_owned();
    }
    let mut buffer = zmij::Buffer::new();
    let shortest = buffer.format(value);
    shortest.strip_suffix(".0").unwrap_or(shortest).replace("e+", "e")
}
