//! The command line: arguments to pipeline, diagnostics to the terminal, results to files.
//!
//! The only module that touches files, the environment and the terminal. A file per command.

mod arguments;
mod check;
mod contributions;
mod dump;
mod emit;
mod endings;
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
mod licenses;
#[cfg(feature = "lsp")]
mod lsp;
mod progress;
mod report;
mod results;
mod run;
mod spared;
mod summary;
mod sweep;
mod times;
mod timings;
mod tolerance;
mod usage;
mod view;

use arguments::{Arguments, Command, Messages};
use clap::Parser;
use failure::Failure;
use report::Reporter;
use std::process::ExitCode;

/// Runs the command that the process was called with.
#[must_use]
pub fn main() -> ExitCode {
    interrupts::watch();
    let arguments = Arguments::try_parse().unwrap_or_else(|error| usage::with_tip(error).exit());
    // nothing but the option asks for them
    let Some(command) = arguments.command else {
        return ExitCode::from(reported(&Messages::default(), |_| licenses::print()));
    };
    ExitCode::from(match command {
        Command::Check(check) => reported(&check.input.messages, |reporter| check::check(&check, reporter)),
        Command::Fmt(fmt) => reported(&fmt.messages, |reporter| fmt::fmt(&fmt, reporter)),
        Command::Emit(emit) => reported(&emit.input.messages, |reporter| emit::emit(&emit, reporter)),
        Command::Dump(dump) => reported(&dump.input.messages, |reporter| dump::dump(&dump, reporter)),
        Command::Run(run) => reported(&run.input.messages, |reporter| run::run(&run, reporter)),
        Command::Sweep(sweep) => reported(&sweep.input.messages, |reporter| sweep::sweep(&sweep, reporter)),
        Command::Tolerance(of) => reported(&of.input.messages, |reporter| tolerance::tolerance(&of, reporter)),
        Command::View(view) => reported(&view.input.messages, |reporter| view::view(&view, reporter)),
        Command::Formula(formula) => reported(&formula.messages, |reporter| formula::formula(&formula, reporter)),
        Command::Explain(explain) => reported(&explain.messages, |_| explain::explain(&explain)),
        Command::Import(import) => reported(&import.messages, |reporter| import::import(&import, reporter)),
        #[cfg(feature = "lsp")]
        Command::Lsp(lsp) => serve(&lsp),
    })
}

/// Serves an editor; gives the exit code that the protocol wants.
#[cfg(feature = "lsp")]
fn serve(arguments: &arguments::LspArguments) -> u8 {
    let mut ended_well = false;
    let code = reported(&Messages::default(), |_| {
        ended_well = lsp::lsp(arguments)?;
        Ok(())
    });
    if ended_well { code } else { code.max(1) }
}

/// Does a command's work and says why it ended; gives the exit code.
fn reported(messages: &Messages, work: impl FnOnce(&mut Reporter) -> Result<(), Failure>) -> u8 {
    let mut reporter = Reporter::new(messages);
    let result = work(&mut reporter);
    reporter.finish(result)
}
