//! The command line: arguments to pipeline, diagnostics to the terminal, results to files.
//!
//! The only room that touches files, the environment and the terminal. A file per command.

mod arguments;
mod check;
mod dump;
mod emit;
mod failure;
mod files;
mod input;
mod progress;
mod report;
mod run;
mod timings;

use arguments::{Arguments, Command};
use clap::Parser;
use report::Reporter;
use std::process::ExitCode;

/// Runs the command that the process was called with.
#[must_use]
pub fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match arguments.command {
        Command::Check(check) => {
            let mut reporter = Reporter::new(&check.input);
            let result = check::check(&check, &mut reporter);
            reporter.finish(result)
        }
        Command::Dump(dump) => {
            let mut reporter = Reporter::new(&dump.input);
            let result = dump::dump(&dump, &mut reporter);
            reporter.finish(result)
        }
        Command::Emit(emit) => {
            let mut reporter = Reporter::new(&emit.input);
            let result = emit::emit(&emit, &mut reporter);
            reporter.finish(result)
        }
        Command::Run(run) => {
            let mut reporter = Reporter::new(&run.input);
            let result = run::run(&run, &mut reporter);
            reporter.finish(result)
        }
    };
    ExitCode::from(result)
}
