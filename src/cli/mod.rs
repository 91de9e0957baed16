//! The command line: arguments to pipeline, diagnostics to the terminal, results to files.
//!
//! This module alone touches files, the environment and the terminal. Each command has a file.

mod arguments;
mod check;
mod dump;
mod emit;
mod explain;
mod failure;
mod files;
mod fix;
mod fmt;
mod folders;
mod formula;
mod import;
mod input;
mod interrupts;
#[cfg(feature = "lsp")]
mod lsp;
mod output_format;
mod progress;
mod protected_paths;
mod report;
mod results;
mod run;
mod summary;
mod sweep;
mod timings;
mod tolerance;
mod tolerance_table;
mod usage;
mod view;

use arguments::{Arguments, Command, Messages};
use clap::Parser;
use failure::Failure;
use mechc_draw::view::page;
use report::Reporter;
use std::process::ExitCode;

/// Licences of the crates (`tests/program/licenses.rs` writes the file).
const CRATE_LICENSES: &str = include_str!("licenses.txt");

/// Runs the command that the process was called with.
#[must_use]
pub fn main() -> ExitCode {
    interrupts::watch();
    let arguments = Arguments::try_parse().unwrap_or_else(|error| usage::with_tip(error).exit());
    // without a command the only option is `--licenses`
    let Some(command) = arguments.command else {
        return ExitCode::from(run_command(&Messages::default(), |_| print_licenses()));
    };
    ExitCode::from(match command {
        Command::Check(check) => run_command(&check.input.messages, |reporter| check::check(&check, reporter)),
        Command::Fmt(fmt) => run_command(&fmt.messages, |reporter| fmt::fmt(&fmt, reporter)),
        Command::Emit(emit) => run_command(&emit.input.messages, |reporter| emit::emit(&emit, reporter)),
        Command::Dump(dump) => run_command(&dump.input.messages, |reporter| dump::dump(&dump, reporter)),
        Command::Run(run) => run_command(&run.input.messages, |reporter| run::run(&run, reporter)),
        Command::Sweep(sweep) => run_command(&sweep.input.messages, |reporter| sweep::sweep(&sweep, reporter)),
        Command::Tolerance(tolerance) => {
            run_command(&tolerance.input.messages, |reporter| tolerance::tolerance(&tolerance, reporter))
        }
        Command::View(view) => run_command(&view.input.messages, |reporter| view::view(&view, reporter)),
        Command::Formula(formula) => run_command(&formula.messages, |reporter| formula::formula(&formula, reporter)),
        Command::Explain(explain) => run_command(&explain.messages, |_| explain::explain(&explain)),
        Command::Import(import) => run_command(&import.messages, |reporter| import::import(&import, reporter)),
        #[cfg(feature = "lsp")]
        Command::Lsp(lsp) => serve(&lsp),
    })
}

/// Serves an editor; returns the exit code that the protocol requires.
#[cfg(feature = "lsp")]
fn serve(arguments: &arguments::LspArguments) -> u8 {
    let mut ended_well = false;
    let code = run_command(&Messages::default(), |_| {
        ended_well = lsp::lsp(arguments)?;
        Ok(())
    });
    if ended_well { code } else { code.max(1) }
}

/// Runs a command and prints why it failed; returns the exit code.
fn run_command(messages: &Messages, work: impl FnOnce(&mut Reporter) -> Result<(), Failure>) -> u8 {
    let mut reporter = Reporter::new(messages);
    let result = work(&mut reporter);
    reporter.finish(result)
}

/// Prints the notices that the licences of dependencies require.
fn print_licenses() -> Result<(), Failure> {
    let program = concat!("mechc ", env!("CARGO_PKG_VERSION"), ": ", env!("CARGO_PKG_LICENSE"));
    let pages = page::NOTICES.trim_end();
    let library = "It is built with the standard library of Rust: MIT OR Apache-2.0, https://github.com/rust-lang/rust";
    files::print(&format!(
        "{program}\n{library}\n\n\nIn the pages that `mechc view` writes\n\n{pages}\n\n\n{CRATE_LICENSES}"
    ))
}
