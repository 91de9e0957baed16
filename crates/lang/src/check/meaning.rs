//! What a name means where it stands alone in a formula: asked by the reader of formulas, and by the table of who uses which name.

use mechc_text::vocabulary::{Constant, Unit};

/// What a name means.
#[derive(Clone, Copy)]
pub(super) enum Alone<T> {
    /// The argument of the function or curve around it.
    Argument,
    /// A constant of the language, or `t`, or `ground`.
    Constant(&'static Constant),
    /// A unit behind an operator.
    Unit(&'static Unit),
    /// What is declared by that name.
    Declared(T),
    /// Nothing that is known.
    Unknown,
}

/// In the order in which a formula knows them: `declared` tells what the mechanism has by a name.
pub(super) fn alone<T>(name: &str, argument: Option<&str>, declared: Option<T>) -> Alone<T> {
    if argument == Some(name) {
        return Alone::Argument;
    }
    if let Some(constant) = Constant::named(name) {
        return Alone::Constant(constant);
    }
    match (declared, Unit::named(name)) {
        // a declared name that is a unit too is either a fault, or a unit that gives way
        (Some(declared), _) => Alone::Declared(declared),
        (None, Some(unit)) => Alone::Unit(unit),
        (None, None) => Alone::Unknown,
    }
}
