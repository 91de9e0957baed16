//! The words of the language, one table for each kind: how a word is written, what it means, and an example.
//!
//! What the parser, the names of a mechanism, the messages, the formatter and the pages of `mechc explain` know of words
//! they have from here. This module knows no tree and no text; what a word does stands in the crates that do it.

mod constants;
mod dimension;
mod functions;
mod joints;
mod keywords;
mod other_names;
mod page;
mod quantities;
mod reductions;
mod synonyms;
mod topics;
mod units;

pub use constants::{CONSTANTS, Constant, StandsFor};
pub use dimension::Dimension;
pub use functions::{FUNCTIONS, Function, Group};
pub use joints::{JOINTS, JointKind, JointWord};
pub use keywords::{KEYWORDS, Keyword, Role, is_before_a_name, is_declaration, is_feature};
pub use other_names::{KindOfName, another_name};
pub use page::{OVERVIEWS, page};
pub use quantities::{QUANTITIES, QuantityWord};
pub use reductions::{REDUCTIONS, ReductionWord};
pub use synonyms::{Place, SYNONYMS, Synonym, is_ground};
pub use topics::{topic, topics};
pub use units::{CompoundUnit, UNITS, Unit};

/// A word, as a reader is told of it.
#[derive(Debug)]
pub struct Word {
    /// As it is written.
    pub name: &'static str,
    /// What it is.
    pub category: Category,
    /// How it is written with what belongs to it, several ways where something may be left out: `revolute(P, Q)`.
    pub forms: &'static [&'static str],
    /// What the letters of the forms are, where that has to be said: "c and d circles".
    pub letters: &'static str,
    /// What it means, in one line without a full stop.
    pub meaning: &'static str,
    /// What is to be known beyond that: equations, smoothness, dimensions. Markdown.
    pub more: &'static str,
    /// A mechanism that shows it.
    pub example: Example,
}

/// What a word is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Category {
    /// Begins or joins the parts of a declaration or formula.
    Keyword,
    /// Is called with numbers.
    Function,
    /// Is called with numbers, and goes from one value to another.
    Motion,
    /// Is called with points, bodies or joints, and is a number.
    Quantity,
    /// Is called with a formula in a result, and is a number for the whole analysis.
    Reduction,
    /// Joins two bodies.
    Joint,
    /// Follows a number.
    Unit,
    /// Has one value, or is always there.
    Constant,
}

/// The text of a mechanism that checks without a word of complaint.
#[derive(Clone, Copy, Debug)]
pub enum Example {
    /// Declarations beside an arm that turns about `ground.O` and has a point `tip`; `main` is its joint. A driver among
    /// them takes the place of the arm's own.
    Arm(&'static str),
    /// All declarations.
    Whole(&'static str),
    /// A mechanism, and the declarations of another one that uses it.
    Using(&'static str, &'static str),
    /// That of another word.
    Of(&'static str),
}

impl Word {
    /// How it is written, for a message: "`weld(P, Q)` or `weld(P, Q, angle)`".
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

/// Every word; a name may stand for several.
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

/// Whether a name is that of a function or quantity, and so cannot be that of the user's unless it gives way; some quantities give way.
#[must_use]
pub fn is_called(name: &str) -> bool {
    Function::named(name).is_some() || QuantityWord::named(name).is_some_and(|quantity| !quantity.gives_way)
}

/// Whether a function or table of the file may have the name of this function, and then means itself.
#[must_use]
pub fn gives_way(name: &str) -> bool {
    Function::named(name).is_some_and(|function| function.gives_way)
}

/// Whether a name of a mechanism's space is taken by a constant, the ground or a unit that does not give way.
#[must_use]
pub fn is_taken(name: &str) -> bool {
    Constant::named(name).is_some() || Unit::named(name).is_some_and(|unit| !unit.gives_way)
}

/// Whether a name is that of a function or quantity of one argument, and says so: a letter alone may be anything.
#[must_use]
pub fn is_one_argument_function(name: &str) -> bool {
    let function = Function::named(name).is_some_and(|function| (function.least, function.most) == (1, 1));
    let quantity = QuantityWord::named(name).is_some_and(|quantity| {
        !quantity.gives_way && quantity.word.forms.first().is_some_and(|form| !form.contains(','))
    });
    name.len() > 1 && (function || quantity)
}
