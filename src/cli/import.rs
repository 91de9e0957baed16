//! `mechc import`: translates the model files of the course's planar engine.

use super::arguments::ImportArguments;
use super::failure::{Failure, unusable};
use super::files::{self, Output};
use super::report::Reporter;

pub(super) fn import(arguments: &ImportArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    if arguments.model == "-" && arguments.acf.as_deref() == Some("-") {
        return Err(unusable("standard input cannot be both the model and the settings")
            .help("give one of them as a file")
            .into());
    }
    let model = files::read(&arguments.model, &mut reporter.sources)?;
    let settings = arguments.acf.as_ref().map(|acf| files::read(acf, &mut reporter.sources)).transpose()?;
    let (text, diagnostics) = mechc_pipeline::import_model(model, settings, &reporter.sources);
    let text = reporter.require(text, diagnostics)?;
    Output::write(&arguments.output, &text, &reporter.protected())
}
