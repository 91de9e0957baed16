//! `mechc dump`: what the compiler sees, readable.

use super::arguments::{DumpArguments, Stage};
use super::failure::Failure;
use super::files::Output;
use super::input;
use super::report::Reporter;
use crate::lower;
use crate::syntax;

pub(super) fn dump(arguments: &DumpArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let text = match arguments.stage {
        Stage::Ast => syntax::format(&input::tree(&arguments.input, reporter)?),
        Stage::Model => input::model(&arguments.input, reporter)?.to_string(),
        // the equations can be looked at even where they are too many or too few
        Stage::Ir => lower::lower(&input::model(&arguments.input, reporter)?).to_string(),
    };
    Output::write(&arguments.output, &text, &reporter.sources)
}
