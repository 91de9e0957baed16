//! Import of models of another program as `.mech` texts.

use mechc_lang::check::{self, CheckOptions};
use mechc_syntax::import;
use mechc_syntax::{self as syntax, ast};
use mechc_text::diag::{Code, Diagnostics};
use mechc_text::source::{FileId, Sources};

/// Imports a model file of the course's planar engine, with the times of its settings file if there is one. Returns the text with diagnostics;
/// `None` if the language cannot express a part of the model.
#[must_use]
pub fn import_model(model: FileId, settings: Option<FileId>, sources: &Sources) -> (Option<String>, Diagnostics) {
    let (file, mut diagnostics) = import::import(model, settings, sources);
    if let Some(file) = &file {
        diagnostics.extend(errors_without_value(file, sources));
    }
    (file.filter(|_| !diagnostics.has_errors()).map(|file| syntax::format(&file)), diagnostics)
}

/// Returns the errors of formulas that have no value, which only the checker finds; spans of the tree point into the model file. All other
/// errors of the mechanism are left to `mechc check`.
fn errors_without_value(file: &ast::File, sources: &Sources) -> Diagnostics {
    let mut errors = Diagnostics::default();
    for mechanism in &file.mechanisms {
        let (_, of_check) = check::check(mechanism, &CheckOptions::default(), sources);
        errors.extend(of_check.into_iter().filter(|error| matches!(error.code, Code::E0404 | Code::E0410)));
    }
    errors
}
