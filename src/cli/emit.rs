//! `mechc emit`: the mechanism as Rust, a module or a whole crate, with a header for C on request; its constraint system as LaTeX or JSON.

use super::arguments::{Content, EmitArguments, EmitFormat};
use super::endings;
use super::failure::{Failure, unusable};
use super::files::{self, Output};
use super::input;
use super::report::Reporter;
use mechc_emit::{MARK, NOT_IN_ALL};
use mechc_pipeline::{Compiled, RustOptions};
use mechc_text::diag::{Code, Diagnostic, Severity};
use std::path::Path;

/// The forms by their endings.
const FORMS: [(&str, EmitFormat); 3] =
    [("rs", EmitFormat::Rust), ("tex", EmitFormat::Latex), ("json", EmitFormat::Json)];

pub(super) fn emit(arguments: &EmitArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let format = endings::form(arguments.format, &arguments.output, &FORMS, EmitFormat::Rust)?;
    if arguments.folder.is_some() {
        can_be_a_crate(arguments)?;
    } else if arguments.ffi {
        return Err(unusable("functions for C are a part of a crate")
            .help("name a folder for it with `--crate DIR`, or leave `--ffi` out")
            .into());
    }
    if arguments.lanes.is_some() {
        can_have_lanes(arguments, format)?;
    }
    let parsed = input::parsed(&arguments.input, reporter)?;
    let checked = input::checked(&parsed, &arguments.input, reporter)?;
    let (compiled, said) = input::proven(&checked, arguments.allow_redundant);
    // the name without its folder: the same output wherever the file lies
    let file = Path::new(&arguments.input.file).file_name().map_or("-".into(), |name| name.to_string_lossy());
    if format != EmitFormat::Rust && compiled.is_none() && said.iter().all(is_of_counts) {
        let text = if format == EmitFormat::Json { checked.json(&file) } else { checked.latex(&file) };
        Output::write(&arguments.output, &text.unwrap_or_default(), &reporter.spared())?;
        if !reporter.is_for_programs() {
            Reporter::say("the mechanism is not determined, and the document says so: `mechc check` tells why\n");
        }
        return Ok(());
    }
    let compiled = reporter.settle(compiled, said)?;
    let options = RustOptions {
        with_motion: arguments.with != Content::Equations,
        with_sensitivities: arguments.with == Content::Sensitivities,
        lanes: arguments.lanes,
        for_c: arguments.ffi,
        ..RustOptions::of(&*file)
    };
    if let Some(folder) = &arguments.folder {
        return package(&compiled, folder, &options, reporter);
    }
    let text = match format {
        EmitFormat::Rust => {
            let (text, said) = compiled.rust(&options);
            reporter.settle(text, said)?
        }
        EmitFormat::Latex => compiled.latex(&file),
        EmitFormat::Json => compiled.json(&file),
    };
    Output::write(&arguments.output, &text, &reporter.spared())
}

/// Whether something is said of the number of equations and coordinates alone: these can be written all the same.
fn is_of_counts(said: &Diagnostic) -> bool {
    said.severity() != Severity::Error || matches!(said.code, Code::E0502 | Code::E0503)
}

/// A crate: where the motion stops on its way, it is written with what there is, as a table is.
fn package(compiled: &Compiled, folder: &str, options: &RustOptions, reporter: &Reporter) -> Result<(), Failure> {
    let name = folder_name(folder).unwrap_or_else(|| compiled.name().to_owned());
    let (crate_files, said) = compiled.package(&name, options);
    let Some(crate_files) = crate_files else {
        return Err(said.into());
    };
    let texts = || crate_files.iter().map(|file| (file.path.as_str(), file.text.as_str()));
    files::write_all(folder, texts(), MARK, &reporter.spared())?;
    let written: Vec<&str> = texts().map(|(path, _)| path).collect();
    for removed in files::remove_left(folder, &NOT_IN_ALL, &written, MARK)? {
        Reporter::say(&format!("removed `{removed}`, which is no longer a part of the crate\n"));
    }
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

/// What has no lanes.
fn can_have_lanes(arguments: &EmitArguments, format: EmitFormat) -> Result<(), Failure> {
    if format != EmitFormat::Rust || arguments.with == Content::Equations {
        return Err(unusable("lanes are for Rust code with the solver")
            .help("leave `--lanes` out, or `--format` and `--with`")
            .into());
    }
    Ok(())
}

/// What a crate cannot be made of.
fn can_be_a_crate(arguments: &EmitArguments) -> Result<(), Failure> {
    if matches!(arguments.format, Some(EmitFormat::Latex | EmitFormat::Json)) {
        return Err(unusable("a crate is written in Rust only")
            .help("leave `--format` out, or name a file with `-o` instead of a folder with `--crate`")
            .into());
    }
    if arguments.with == Content::Equations {
        return Err(unusable("a crate needs the solver, by which it is tested")
            .help("leave `--with` out, or name a file with `-o` instead of a folder with `--crate`")
            .into());
    }
    Ok(())
}
