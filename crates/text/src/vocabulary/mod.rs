//! Words of the language, one table for each kind: spelling, meaning and an example of each.
//!
//! The parser, the names of a mechanism, messages, the formatter and `mechc explain` all use these tables. This module does not depend on
//! trees or texts; the effect of a word is in the crates that implement it.

mod constants;
mod dimension;
mod free_names;
mod functions;
mod joints;
mod keywords;
mod page;
mod quantities;
mod reductions;
mod synonyms;
mod topics;
mod units;

pub use constants::{CONSTANTS, Constant, NamedConstant};
pub use dimension::Dimension;
pub use free_names::{SubstituteKind, substitute_name};
pub use functions::{FUNCTIONS, Function, Group};
pub use joints::{ArgumentSpec, FeatureWord, JOINTS, JointMotion, JointSpec, JointSymbol, ReactionKind, Spacing};
pub use keywords::{KEYWORDS, Keyword, Role, continues_declaration, declares_name, is_declaration, is_feature};
pub use page::{OVERVIEWS, page};
pub use quantities::{MOST_ARGUMENTS, MeasuredQuantity, QUANTITIES, QuantityArgument, QuantityKind, QuantityWord};
pub use reductions::{REDUCTIONS, ReductionWord};
pub use synonyms::{Position, SYNONYMS, Synonym, is_ground};
pub use topics::{topic, topics};
pub use units::{CompoundUnit, UNITS, Unit};

/// Documentation of a word.
#[derive(Debug)]
pub struct Word {
    /// Spelling.
    pub name: &'static str,
    /// Category.
    pub category: Category,
    /// Forms of use, several where something may be left out: `revolute(P, Q)`.
    pub forms: &'static [&'static str],
    /// Meaning of the letters in the forms, where needed: "c and d circles".
    pub letters: &'static str,
    /// Meaning, in one line without a full stop.
    pub meaning: &'static str,
    /// Further facts such as equations, smoothness and dimensions, in Markdown.
    pub more: &'static str,
    /// Example.
    pub example: Example,
}

/// Category of a word.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Category {
    /// Begins or joins the parts of a declaration or formula.
    Keyword,
    /// Function of numbers.
    Function,
    /// Function of numbers that goes from one value to another.
    Motion,
    /// Function of points, bodies or joints that is a number.
    Quantity,
    /// Function of a formula in a result that is a number for the whole analysis.
    Reduction,
    /// Joins two bodies.
    Joint,
    /// Follows a number.
    Unit,
    /// Has one value, or is always defined.
    Constant,
}

/// Text of a mechanism that checks without diagnostics.
#[derive(Clone, Copy, Debug)]
pub enum Example {
    /// Declarations next to an arm that turns about `ground.O` and has a point `tip`; `main` is its joint. A `driver motor` among them
    /// replaces the arm's driver.
    Arm(&'static str),
    /// All declarations.
    Whole(&'static str),
    /// Declarations of a mechanism, and the text of another one that it uses.
    Using(&'static str, &'static str),
    /// Example of another word.
    Of(&'static str),
}

impl Word {
    /// Returns the forms for a message: "`weld(P, Q)` or `weld(P, Q, angle)`".
    #[must_use]
    pub fn written(&self) -> String {
        let quoted: Vec<String> = self.forms.iter().map(|form| format!("`{form}`")).collect();
        let forms = match quoted.split_last() {
            None => String::new(),
            Some((last, [])) => last.clone(),
            Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
        };
        if self.letters.is_empty() { forms } else { format!("{forms}, {}", self.letters) }
    }
}

/// Returns all words; several may have one name.
pub fn words() -> impl Iterator<Item = &'static Word> {
    let keywords = KEYWORDS.iter().map(|keyword| &keyword.word);
    let functions = FUNCTIONS.iter().map(|function| &function.word);
    let quantities = QUANTITIES.iter().map(|quantity| &quantity.word);
    let reductions = REDUCTIONS.iter().map(|reduction| &reduction.word);
    let joints = JOINTS.iter().map(|joint| &joint.word);
    let constants = CONSTANTS.iter().map(|constant| &constant.word);
    let units = UNITS.iter().map(|unit| &unit.word);
    keywords.chain(joints).chain(quantities).chain(functions).chain(reductions).chain(constants).chain(units)
}

/// Returns whether a name is reserved for a function or quantity. Some quantities give way to declarations of the user.
#[must_use]
pub fn is_called(name: &str) -> bool {
    Function::named(name).is_some() || QuantityWord::named(name).is_some_and(|quantity| !quantity.gives_way())
}

/// Returns whether a function or table of the user may replace the function of this name.
#[must_use]
pub fn gives_way(name: &str) -> bool {
    Function::named(name).is_some_and(|function| function.gives_way)
}

/// Returns whether a name of more than one letter is that of a function or quantity with one argument. A single letter may be anything.
#[must_use]
pub fn is_one_argument_function(name: &str) -> bool {
    let function = Function::named(name).is_some_and(|function| (function.least, function.most) == (1, 1));
    let quantity = QuantityWord::named(name).is_some_and(|quantity| {
        !quantity.gives_way() && quantity.word.forms.first().is_some_and(|form| !form.contains(','))
    });
    name.len() > 1 && (function || quantity)
}
