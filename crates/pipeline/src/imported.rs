//! Model files of another program as `.mech` text.

use mechc_lang::check::{self, Surroundings};
use mechc_syntax::import;
use mechc_syntax::{self as syntax, ast};
use mechc_text::diag::{Code, Diagnostics};
use mechc_text::source::{FileId, Sources};

/// A model file of the course's planar engine, with the times of a settings file if there is one, as a text; with what is to be said of
/// it. Nothing where something of it cannot be said in the language.
#[must_use]
pub fn imported(model: FileId, settings: Option<FileId>, sources: &Sources) -> (Option<String>, Diagnostics) {
    let (file, mut said) = import::import(model, settings, sources);
    if let Some(file) = &file {
        said.extend(without_value(file, sources));
    }
    (file.filter(|_| !said.has_errors()).map(|file| syntax::format(&file)), said)
}

/// Formulas that have no value, which only the checker can tell; the tree's places are those of the model file, so that
/// it points there. Whatever else it may say of the mechanism is for `mechc check` to say.
fn without_value(file: &ast::File, sources: &Sources) -> Diagnostics {
    let mut found = Diagnostics::default();
    for mechanism in &file.mechanisms {
        let (_, said) = check::check(mechanism, &Surroundings::default(), sources);
        found.extend(said.into_iter().filter(|one| matches!(one.code, Code::E0404 | Code::E0410)));
    }
    found
}
