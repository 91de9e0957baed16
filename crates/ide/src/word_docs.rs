//! Documentation of the words of the language, in Markdown.

use super::numbers::with_unit;
use mechc_pipeline::Formula;
use mechc_text::source::Sources;
use mechc_text::vocabulary::{Category, Function, JointSpec, Unit, Word};

/// Formats the documentation of a word: its forms, its meaning and details.
pub(super) fn word_docs(word: &Word) -> String {
    let mut parts = vec![format!("```mech\n{}\n```", word.forms.join("\n")), word.meaning.to_owned()];
    parts.extend((!word.letters.is_empty()).then(|| word.letters.to_owned()));
    parts.extend(JointSpec::named(word.name).filter(|_| word.category == Category::Joint).map(JointSpec::counts));
    parts.extend(in_si(word));
    parts.extend((!word.more.is_empty()).then(|| word.more.to_owned()));
    parts.extend(derivatives(word));
    parts.join("\n\n")
}

fn in_si(word: &Word) -> Option<String> {
    let unit = Unit::named(word.name).filter(|_| word.category == Category::Unit)?;
    let si = unit.dimension.display_unit();
    Some(format!("`1 {} = {}`", word.name, with_unit(unit.to_si(1.0, 1), &si)))
}

/// Formats the derivatives of a function of one number.
fn derivatives(word: &Word) -> Option<String> {
    let function = Function::named(word.name).filter(|_| word.category == Category::Function)?;
    let is_unary = (function.least, function.most) == (1, 1);
    let formula = Formula::parse(&format!("{}(t)", word.name), &mut Sources::default()).ok().filter(|_| is_unary)?;
    Some(format!("With its derivatives:\n\n```mech\n{}\n```", formula.text().trim_end()))
}
