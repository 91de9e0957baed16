//! `mechc fmt`: formats texts.

use super::arguments::FmtArguments;
use super::failure::{Failure, INPUT};
use super::files::{self, Output};
use super::folders;
use super::report::Reporter;
use mechc_pipeline::Parsed;
use mechc_text::diag::{Diagnostics, visible};
use similar::TextDiff;
use std::borrow::Cow;
use std::io::IsTerminal;
use std::path::Path;

/// A text before and after formatting.
struct Change {
    name: String,
    old: String,
    new: String,
}

/// Formats all files that parse, and reports the errors of the others.
pub(super) fn fmt(arguments: &FmtArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let (mut errors, mut diffs) = (Diagnostics::default(), String::new());
    for file in folders::files_of(&arguments.files) {
        let result = file.and_then(|name| {
            let change = change(&name, reporter)?;
            if arguments.check {
                diffs += &diff(&change);
                return Ok(());
            }
            replace(&name, &change, reporter)
        });
        match result {
            Ok(()) => {}
            Err(closed @ Failure::ReaderClosed) => return Err(closed),
            Err(why) => errors.extend(why.into_diagnostics()),
        }
    }
    if !diffs.is_empty() {
        // a program that reads the diff from a pipe needs its exact bytes
        let is_terminal = std::io::stdout().is_terminal();
        files::print(&if is_terminal { visible(&diffs) } else { Cow::Owned(diffs) })?;
        reporter.set_exit_code(INPUT);
    }
    if errors.has_errors() { Err(errors.into()) } else { Ok(()) }
}

/// Reads a file, or standard input for `-`.
fn change(name: &str, reporter: &mut Reporter) -> Result<Change, Failure> {
    let (file, has_mark) = files::read_to_replace(name, &mut reporter.sources)?;
    let source = reporter.sources.get(file);
    // the text alone: the other texts are only needed to report errors
    let new = Parsed::new(&source.name, &source.text).formatted();
    let errors = || Parsed::from_source(reporter.sources.clone(), file, Path::new(name)).faults().clone();
    let new = new.ok_or_else(errors)?;
    let mark = if has_mark { "\u{feff}" } else { "" };
    let old = format!("{mark}{}", source.text);
    Ok(Change { name: source.name.clone(), old, new: format!("{mark}{new}") })
}

fn replace(name: &str, change: &Change, reporter: &Reporter) -> Result<(), Failure> {
    if name == "-" {
        return files::print(&change.new);
    }
    if change.new != change.old {
        Output::replace(name, &change.new)?;
        if !reporter.is_machine_readable() {
            Reporter::print_text(&format!("formatted `{name}`\n"));
        }
    }
    Ok(())
}

/// The stand-in for `\r`, which ends a line for the comparison and not for `patch`. No text contains this character.
const NO_CHARACTER: &str = "\u{fdd0}";

/// Formats the changes as a unified diff for `patch`; empty if there are none.
fn diff(change: &Change) -> String {
    let [old, new] = [&change.old, &change.new].map(|text| text.replace('\r', NO_CHARACTER));
    // `patch` needs a tab after a name that contains spaces
    let end = if change.name.contains(char::is_whitespace) { "\t" } else { "" };
    let name = format!("{}{end}", change.name);
    let diff = TextDiff::from_lines(&old, &new);
    diff.unified_diff().header(&name, &name).to_string().replace(NO_CHARACTER, "\r")
}
