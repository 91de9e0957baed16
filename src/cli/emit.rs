//! `mechc emit`: the mechanism as Rust, a module or a whole crate, its constraint system as LaTeX or JSON.

use super::arguments::{Content, EmitArguments, EmitFormat};
use super::endings;
use super::failure::Failure;
use super::files::{self, Output};
use super::input;
use super::report::Reporter;
use super::timings::Timings;
use crate::diag::{Code, Diagnostic};
use crate::emit::{self, MARK, Motion, Unit};
use crate::program::Program;
use crate::source::Sources;
use crate::structure::Determined;
use std::path::Path;

/// The forms by their endings.
const FORMS: [(&str, EmitFormat); 3] =
    [("rs", EmitFormat::Rust), ("tex", EmitFormat::Latex), ("json", EmitFormat::Json)];

pub(super) fn emit(arguments: &EmitArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let format = endings::form(arguments.format, &arguments.output, &FORMS, EmitFormat::Rust)?;
    if arguments.folder.is_some() {
        can_be_a_crate(arguments)?;
    }
    if arguments.lanes.is_some() {
        can_have_lanes(arguments, format)?;
    }
    let determined =
        input::determined(&arguments.input, arguments.allow_redundant, reporter, &mut Timings::new(false))?;
    // the name without its folder: the same output wherever the file lies
    let file = Path::new(&arguments.input.file).file_name().map_or("-".into(), |name| name.to_string_lossy());
    if let Some(folder) = &arguments.folder {
        return package(&determined, arguments, folder, &file, reporter);
    }
    let text = match format {
        EmitFormat::Rust => rust(&determined, arguments, &file, reporter)?,
        EmitFormat::Latex => emit::latex(determined.system(), &file),
        EmitFormat::Json => emit::json(determined.system(), &reporter.sources, &file),
    };
    Output::write(&arguments.output, &text, &reporter.sources)
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
        Content::Solver => Some(motion(determined, &program, reporter)?),
    };
    let sources = &reporter.sources;
    Ok(emit::rust(&unit(determined, &program, sources, file, motion, arguments)?))
}

/// What is emitted.
fn unit<'u>(
    determined: &'u Determined,
    program: &'u Program,
    sources: &'u Sources,
    file: &'u str,
    motion: Option<Motion>,
    arguments: &EmitArguments,
) -> Result<Unit<'u>, Failure> {
    let (system, lanes, largest_straight) = (determined.system(), arguments.lanes, emit::LARGEST_STRAIGHT);
    let unit = Unit { system, program, sources, file, motion, lanes, largest_straight };
    if lanes.is_some() && emit::is_large(&unit) {
        return Err(Diagnostic::new(
            Code::E0706,
            format!("lanes are for mechanisms of up to {largest_straight} operations"),
        )
        .help("leave `--lanes` out")
        .into());
    }
    Ok(unit)
}

/// A crate: where the motion stops on its way, it is written with what there is, as a table is.
fn package(
    determined: &Determined,
    arguments: &EmitArguments,
    folder: &str,
    file: &str,
    reporter: &mut Reporter,
) -> Result<(), Failure> {
    let program = Program::new(determined.system());
    let motion = Some(motion(determined, &program, reporter)?);
    let (reference, said) = crate::reference(determined, &program)?;
    let sources = &reporter.sources;
    let unit = unit(determined, &program, sources, file, motion, arguments)?;
    let name = folder_name(folder).unwrap_or_else(|| determined.system().name.clone());
    let crate_files = emit::package(&unit, &reference, &name);
    files::write_all(folder, crate_files.iter().map(|file| (file.path, file.text.as_str())), MARK, sources)?;
    if said.has_errors() {
        return Err(said.into());
    }
    reporter.print(&said);
    Ok(())
}

/// What a folder is called, `.` too; the root has no name.
fn folder_name(folder: &str) -> Option<String> {
    let named = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
    named(Path::new(folder)).or_else(|| named(&Path::new(folder).canonicalize().ok()?))
}

fn motion(determined: &Determined, program: &Program, reporter: &Reporter) -> Result<Motion, Failure> {
    let (motion, remarks) = crate::motion(determined, program)?;
    reporter.print(&remarks);
    Ok(motion.ok_or_else(too_large)?)
}

/// What has no lanes.
fn can_have_lanes(arguments: &EmitArguments, format: EmitFormat) -> Result<(), Failure> {
    if format != EmitFormat::Rust || arguments.with == Content::Equations {
        return Err(Diagnostic::new(Code::E0706, "lanes are for Rust code with the solver")
            .help("leave `--lanes` out, or `--format` and `--with`")
            .into());
    }
    Ok(())
}

/// What a crate cannot be made of.
fn can_be_a_crate(arguments: &EmitArguments) -> Result<(), Failure> {
    if matches!(arguments.format, Some(EmitFormat::Latex | EmitFormat::Json)) {
        return Err(Diagnostic::new(Code::E0706, "a crate is written in Rust only")
            .help("leave `--format` out, or name a file with `-o` instead of a folder with `--crate`")
            .into());
    }
    if arguments.with == Content::Equations {
        return Err(Diagnostic::new(Code::E0706, "a crate needs the solver, by which it is tested")
            .help("leave `--with` out, or name a file with `-o` instead of a folder with `--crate`")
            .into());
    }
    Ok(())
}

fn too_large() -> Diagnostic {
    Diagnostic::new(Code::E0706, "the solver of this mechanism would take too many operations")
        .help("leave it out with `--with equations`, in a file that `-o` names")
}
