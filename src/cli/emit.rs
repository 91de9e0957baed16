//! `mechc emit`: the mechanism as Rust, its constraint system as LaTeX or JSON.

use super::arguments::{Content, EmitArguments, EmitFormat};
use super::failure::Failure;
use super::files::Output;
use super::input;
use super::report::Reporter;
use super::timings::Timings;
use crate::diag::{Code, Diagnostic};
use crate::emit::{self, Unit};
use crate::program::Program;
use crate::structure::Determined;
use std::path::Path;

pub(super) fn emit(arguments: &EmitArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let determined = input::determined(&arguments.input, false, reporter, &mut Timings::new(false))?;
    // the name without its folder: the same output wherever the file lies
    let file = Path::new(&arguments.input.file).file_name().map_or("-".into(), |name| name.to_string_lossy());
    let text = match format(arguments) {
        EmitFormat::Rust => rust(&determined, arguments, &file, reporter)?,
        EmitFormat::Latex => emit::latex(determined.system(), &file),
        EmitFormat::Json => emit::json(determined.system(), &reporter.sources, &file),
    };
    Output::write(&arguments.output, &text)
}

fn rust(
    determined: &Determined,
    arguments: &EmitArguments,
    file: &str,
    reporter: &mut Reporter,
) -> Result<String, Failure> {
    let program = Program::new(determined.system());
    let motion = match arguments.with {
        Content::Equations => None,
        Content::Solver => {
            let (motion, remarks) = crate::motion(determined, &program)?;
            reporter.print(&remarks);
            Some(motion.ok_or_else(too_large)?)
        }
    };
    let sources = &reporter.sources;
    Ok(emit::rust(&Unit {
        system: determined.system(),
        program: &program,
        sources,
        file,
        motion,
        lanes: arguments.lanes,
    }))
}

fn too_large() -> Diagnostic {
    Diagnostic::new(Code::E0706, "the solver of this mechanism would take too many operations")
        .help("leave it out with `--with equations`")
}

/// As it is said, or by the ending of the output.
fn format(arguments: &EmitArguments) -> EmitFormat {
    let ending = Path::new(&arguments.output).extension();
    let ends_in = |wanted: &str| ending.is_some_and(|ending| ending.eq_ignore_ascii_case(wanted));
    match arguments.format {
        Some(format) => format,
        None if ends_in("tex") => EmitFormat::Latex,
        None if ends_in("json") => EmitFormat::Json,
        None => EmitFormat::Rust,
    }
}
