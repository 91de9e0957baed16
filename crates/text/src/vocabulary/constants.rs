//! Constants: names with the same meaning in every mechanism.

use super::{Category, Example, Word};
use std::f64::consts::{PI, TAU};

/// A constant.
#[derive(Debug)]
pub struct Constant {
    /// Documentation.
    pub word: Word,
    /// Meaning.
    pub stands_for: NamedConstant,
}

/// Meaning of a constant.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum NamedConstant {
    /// Time (s).
    Time,
    /// Pure number.
    Number(f64),
    /// Body that does not move.
    Ground,
}

impl NamedConstant {
    /// Returns a noun for messages.
    #[must_use]
    pub fn noun(self) -> &'static str {
        match self {
            NamedConstant::Time => "time",
            NamedConstant::Number(_) => "a constant",
            NamedConstant::Ground => "the body that does not move",
        }
    }
}

impl Constant {
    /// Returns the constant of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Constant> {
        CONSTANTS.iter().find(|constant| constant.word.name == name)
    }

    /// Returns the names of the constants that formulas may contain.
    pub fn in_formulas() -> impl Iterator<Item = &'static str> {
        CONSTANTS.iter().filter(|one| one.stands_for != NamedConstant::Ground).map(|one| one.word.name)
    }
}

const fn constant(
    name: &'static str,
    stands_for: NamedConstant,
    form: &'static [&'static str],
    meaning: &'static str,
    more: &'static str,
    example: &'static str,
) -> Constant {
    let example = Example::Arm(example);
    Constant {
        word: Word { name, category: Category::Constant, forms: form, letters: "", meaning, more, example },
        stands_for,
    }
}

/// All constants.
pub static CONSTANTS: &[Constant] = &[
    constant(
        "t",
        NamedConstant::Time,
        &["t"],
        "time, in seconds",
        "It may stand in drivers and measures, and in a `fn` that is used there; a constraint, a place and a length cannot depend \
         on it.",
        "driver motor: rotation(main) = 30 deg + 90 deg/s * t",
    ),
    constant(
        "pi",
        NamedConstant::Number(PI),
        &["pi"],
        "half a turn, 3.141592653589793",
        "",
        "driver motor: rotation(main) = pi / 3 * sin(t)",
    ),
    constant(
        "tau",
        NamedConstant::Number(TAU),
        &["tau"],
        "a whole turn, 2π = 6.283185307179586",
        "",
        "driver motor: rotation(main) = tau / 4 * sin(t)",
    ),
    constant(
        "ground",
        NamedConstant::Ground,
        &["ground.P"],
        "the body that does not move",
        "It has no coordinates. Its points, axes, circles and curves are declared in `ground { … }`; a literal point `(x, y)` in a \
         quantity is on it too.",
        "measure reach = distance(ground.O, arm.tip)",
    ),
];
