//! `mechc import`: the model files of the course's planar engine, translated.

use super::arguments::ImportArguments;
use super::failure::Failure;
use super::files::{self, Output};
use super::report::Reporter;
use crate::check::Surroundings;
use crate::diag::{Code, Diagnostic, Diagnostics};
use crate::source::Sources;
use crate::syntax::ast;
use crate::{check, import, syntax};

pub(super) fn import(arguments: &ImportArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    if arguments.model == "-" && arguments.acf.as_deref() == Some("-") {
        return Err(Diagnostic::new(Code::E0706, "standard input cannot be both the model and the settings")
            .help("give one of them as a file")
            .into());
    }
    let model = files::read(&arguments.model, &mut reporter.sources)?;
    let settings = arguments.acf.as_ref().map(|acf| files::read(acf, &mut reporter.sources)).transpose()?;
    let (file, mut said) = import::import(model, settings, &reporter.sources);
    if let Some(file) = &file {
        said.extend(without_value(file, &reporter.sources));
    }
    match file.filter(|_| !said.has_errors()) {
        None => Err(said.into()),
        Some(file) => {
            reporter.print(&said);
            Output::write(&arguments.output, &syntax::format(&file), &reporter.sources)
        }
    }
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
