//! The meaning of a name that stands alone in a formula. The formula reader and the symbol table share this rule.

use mechc_text::vocabulary::{Constant, Unit};

/// The meaning of a name that stands alone.
#[derive(Clone, Copy)]
pub(in crate::check) enum BareName<T> {
    /// The argument of the function or curve.
    Argument,
    /// A constant of the language, `t` or `ground`.
    Constant(&'static Constant),
    /// A unit without a number, after an operator.
    Unit(&'static Unit),
    /// The declaration of that name.
    Declared(T),
    /// No known meaning.
    Unknown,
}

/// Returns the meaning of a name, in order of precedence; `declared` is the declaration of that name.
pub(in crate::check) fn resolve_bare_name<T>(name: &str, argument: Option<&str>, declared: Option<T>) -> BareName<T> {
    if argument == Some(name) {
        return BareName::Argument;
    }
    if let Some(constant) = Constant::named(name) {
        return BareName::Constant(constant);
    }
    match (declared, Unit::named(name)) {
        // A declaration with the name of a unit shadows that unit.
        (Some(declared), _) => BareName::Declared(declared),
        (None, Some(unit)) => BareName::Unit(unit),
        (None, None) => BareName::Unknown,
    }
}
