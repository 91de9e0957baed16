//! `mechc emit`: the mechanism as Rust, a module or a whole crate, with a header for C on request; its constraint system as LaTeX or JSON.

use super::arguments::{Content, EmitArguments, EmitFormat};
use super::failure::{Failure, unusable};
use super::files::{self, Output};
use super::input;
use super::output_format;
use super::report::Reporter;
use mechc_emit::{MARK, NOT_IN_ALL};
use mechc_pipeline::{Compiled, RustOptions};
use mechc_text::diag::{Code, Diagnostic, Severity};
use std::path::Path;

/// The formats by extension.
const FORMATS: [(&str, EmitFormat); 3] =
    [("rs", EmitFormat::Rust), ("tex", EmitFormat::Latex), ("json", EmitFormat::Json)];

pub(super) fn emit(arguments: &EmitArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let format = output_format::choose(arguments.format, &arguments.output, &FORMATS, EmitFormat::Rust)?;
    if arguments.folder.is_some() {
        check_crate_options(arguments)?;
    } else if arguments.ffi {
        return Err(unusable("functions for C are a part of a crate")
            .help("name a folder for it with `--crate DIR`, or leave `--ffi` out")
            .into());
    }
    if arguments.lanes.is_some() {
        check_lanes_option(arguments, format)?;
    }
    let parsed = input::parsed(&arguments.input, reporter)?;
    let checked = input::checked(&parsed, &arguments.input, reporter)?;
    let (compiled, diagnostics) = input::prove(&checked, arguments.allow_redundant);
    // the name without its folder, so that the output does not depend on where the file is
    let file = Path::new(&arguments.input.file).file_name().map_or("-".into(), |name| name.to_string_lossy());
    if format != EmitFormat::Rust && compiled.is_none() && diagnostics.iter().all(concerns_counts) {
        let text = if format == EmitFormat::Json { checked.json(&file) } else { checked.latex(&file) };
        Output::write(&arguments.output, &text.unwrap_or_default(), &reporter.protected())?;
        if !reporter.is_machine_readable() {
            Reporter::print_text(
                "the mechanism is not determined, and the document says so: `mechc check` tells why\n",
            );
        }
        return Ok(());
    }
    let compiled = reporter.require(compiled, diagnostics)?;
    let options = RustOptions {
        with_motion: arguments.with != Content::Equations,
        with_sensitivities: arguments.with == Content::Sensitivities,
        lanes: arguments.lanes,
        for_c: arguments.ffi,
        ..RustOptions::new(&*file)
    };
    if let Some(folder) = &arguments.folder {
        return package(&compiled, folder, &options, reporter);
    }
    let text = match format {
        EmitFormat::Rust => {
            let (text, diagnostics) = compiled.rust(&options);
            reporter.require(text, diagnostics)?
        }
        EmitFormat::Latex => compiled.latex(&file),
        EmitFormat::Json => compiled.json(&file),
    };
    Output::write(&arguments.output, &text, &reporter.protected())
}

/// Returns whether a diagnostic only concerns the number of equations and coordinates; such systems can be written as documents.
fn concerns_counts(diagnostic: &Diagnostic) -> bool {
    diagnostic.severity() != Severity::Error || matches!(diagnostic.code, Code::E0502 | Code::E0503)
}

/// Writes a crate. If the reference motion stops, the crate is still written, with the rows so far.
fn package(compiled: &Compiled, folder: &str, options: &RustOptions, reporter: &Reporter) -> Result<(), Failure> {
    let name = folder_name(folder).unwrap_or_else(|| compiled.name().to_owned());
    let (crate_files, diagnostics) = compiled.package(&name, options);
    let Some(crate_files) = crate_files else {
        return Err(diagnostics.into());
    };
    let texts = || crate_files.iter().map(|file| (file.path.as_str(), file.text.as_str()));
    files::write_all(folder, texts(), MARK, &reporter.protected())?;
    let written: Vec<&str> = texts().map(|(path, _)| path).collect();
    for removed in files::remove_stale(folder, &NOT_IN_ALL, &written, MARK)? {
        Reporter::print_text(&format!("removed `{removed}`, which is no longer a part of the crate\n"));
    }
    if diagnostics.has_errors() {
        return Err(diagnostics.into());
    }
    reporter.print(&diagnostics);
    Ok(())
}

/// Returns the name of a folder, also of `.`; the root has none.
fn folder_name(folder: &str) -> Option<String> {
    let named = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
    named(Path::new(folder)).or_else(|| named(&Path::new(folder).canonicalize().ok()?))
}

/// Refuses `--lanes` for output that has no lanes.
fn check_lanes_option(arguments: &EmitArguments, format: EmitFormat) -> Result<(), Failure> {
    if format != EmitFormat::Rust || arguments.with == Content::Equations {
        return Err(unusable("lanes are for Rust code with the solver")
            .help("leave `--lanes` out, or `--format` and `--with`")
            .into());
    }
    Ok(())
}

/// Refuses options that do not fit `--crate`.
fn check_crate_options(arguments: &EmitArguments) -> Result<(), Failure> {
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
