//! `mechc dump`: prints the tree, the model or the constraint system.

use super::arguments::{DumpArguments, Stage};
use super::failure::Failure;
use super::files::{Disk, Output};
use super::input;
use super::report::Reporter;
use mechc_text::diag::visible;

pub(super) fn dump(arguments: &DumpArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let text = match arguments.stage {
        Stage::Ast => {
            let parsed = input::parsed(&arguments.input, reporter)?;
            reporter.named_files.extend(parsed.named_files(&Disk));
            parsed.formatted().ok_or_else(|| parsed.faults().clone())?
        }
        Stage::Model => input::model(&arguments.input, reporter)?.model_text().unwrap_or_default(),
        // the equations need not be as many as the coordinates
        Stage::Ir => input::model(&arguments.input, reporter)?.equations_text().unwrap_or_default(),
    };
    Output::write(&arguments.output, &visible(&text), &reporter.protected())
}
