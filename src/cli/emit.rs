//! `mechc emit`: the constraint system as Rust.

use super::arguments::EmitArguments;
use super::failure::Failure;
use super::files::Output;
use super::input;
use super::report::Reporter;
use super::timings::Timings;
use crate::emit;
use crate::program::Program;
use std::path::Path;

pub(super) fn emit(arguments: &EmitArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let determined = input::determined(&arguments.input, false, reporter, &mut Timings::new(false))?;
    let program = Program::new(determined.system());
    // the name without its folder: the same output wherever the file lies
    let file = Path::new(&arguments.input.file).file_name().map_or("-".into(), |name| name.to_string_lossy());
    Output::write(&arguments.output, &emit::rust(determined.system(), &program, &file))
}
