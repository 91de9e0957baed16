//! Operands of lines of emitted code: numbers, and expressions that hold one.

use super::text::literal;
use std::fmt::{self, Display, Formatter};

/// Number of characters beyond which an operand is bound to a variable, for legible lines.
const LONGEST: usize = 20;

/// Names of arguments of a function.
pub(super) type Arguments = &'static [&'static str];

/// A number, or an expression for one.
#[derive(Clone, Debug)]
pub(super) enum Operand {
    Number(f64),
    /// Text of a variable or of an element of an array.
    Held {
        text: String,
        /// Arguments to which the text refers.
        of: Arguments,
    },
}

impl Operand {
    /// Returns an operand that holds a number within the arguments of a function.
    pub fn new(text: String, of: Arguments) -> Operand {
        Operand::Held { text, of }
    }

    /// Creates an operand that is a local variable.
    pub fn local(text: String) -> Operand {
        Operand::new(text, &[])
    }

    /// Returns the arguments to which the operand refers.
    pub fn arguments(&self) -> Arguments {
        match self {
            Operand::Number(_) => &[],
            Operand::Held { of, .. } => of,
        }
    }

    /// Returns whether the operand is short enough for a formula, without a variable.
    pub fn is_short(&self) -> bool {
        match self {
            Operand::Number(value) => literal(*value).len() <= LONGEST,
            Operand::Held { text, .. } => text.len() <= LONGEST,
        }
    }

    /// Returns the negated operand; 0 stays 0, as its sign does not matter.
    pub fn negated(&self) -> Operand {
        match self {
            Operand::Number(value) if *value == 0.0 => Operand::Number(0.0),
            Operand::Number(value) => Operand::Number(-value),
            Operand::Held { text, of } => Operand::new(format!("-{text}"), of),
        }
    }

    /// Returns the absolute value as an expression.
    pub fn absolute(&self) -> String {
        match self {
            Operand::Number(value) if value.is_sign_negative() => format!("({self}).abs()"),
            _ => format!("{self}.abs()"),
        }
    }
}

impl Display for Operand {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Operand::Number(value) => f.write_str(&literal(*value)),
            Operand::Held { text, .. } => f.write_str(text),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Operand;

    #[test]
    fn operand_signs_match_numbers() {
        let (number, held) = (Operand::Number(-2.5), Operand::new("q[1]".to_owned(), &["q"]));
        assert_eq!([number.negated(), held.negated()].map(|of| of.to_string()), ["2.5", "-q[1]"]);
        assert_eq!([number.absolute(), held.absolute()], ["(-2.5).abs()", "q[1].abs()"]);
        assert_eq!(Operand::Number(-0.0).negated().to_string(), "0.0");
        assert_eq!(held.negated().arguments(), ["q"]);
        assert!(held.is_short() && !Operand::local("m.follows.of_a_long_name".to_owned()).is_short());
    }
}
