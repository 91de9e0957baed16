//! Import of models of another program as `.mech` texts.

use mechc_lang::check::{self, Surroundings};
use mechc_syntax::import;
use mechc_syntax::{self as syntax, ast};
use mechc_text::diag::{Code, Diagnostics};
use mechc_text::source::{FileId, Sources};

/// Imports a model file of the course's planar engine, with the times of its settings file if there is one. Returns the text with diagnostics;
/// `None` if the language cannot express a part of the model.
#[must_use]
pub fn imported(model: FileId, settings: Option<FileId>, sources: &Sources) -> (Option<String>, Diagnostics) {
    let (file, mut said) = import::import(model, settings, sources);
    if let Some(file) = &file {
        said.extend(without_value(file, sources));
    }
    (file.filter(|_| !said.has_errors()).map(|file| syntax::format(&file)), said)
}

/// Returns the errors of formulas that have no value, which only the checker finds; spans of the tree point into the model file. All other
/// errors of the mechanism are left to `mechc check`.
fn without_value(file: &ast::File, sources: &Sources) -> Diagnostics {
    let mut found = Diagnostics::default();
    for mechanism in &file.mechanisms {
        let (_, said) = check::check(mechanism, &Surroundings::default(), sources);
        found.extend(said.into_iter().filter(|one| matches!(one.code, Code::E0404 | Code::E0410)));
    }
    found
}
