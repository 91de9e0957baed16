//! `mechc fmt`: texts in the one style.

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

/// A text that is not formatted, with what it is to be.
struct Change {
    name: String,
    old: String,
    new: String,
}

/// Formats all files that can be, and says what is wrong with the others.
pub(super) fn fmt(arguments: &FmtArguments, reporter: &mut Reporter) -> Result<(), Failure> {
    let (mut faults, mut diffs) = (Diagnostics::default(), String::new());
    for file in folders::files_of(&arguments.files) {
        let made = file.and_then(|name| {
            let change = change(&name, reporter)?;
            if arguments.check {
                diffs += &diff(&change);
                return Ok(());
            }
            replace(&name, &change, reporter)
        });
        match made {
            Ok(()) => {}
            Err(Failure::Said(said)) => faults.extend(said),
            Err(gone @ Failure::ReaderGone) => return Err(gone),
        }
    }
    if !diffs.is_empty() {
        // who reads a diff from a pipe applies it
        let is_seen = std::io::stdout().is_terminal();
        files::print(&if is_seen { visible(&diffs) } else { Cow::Owned(diffs) })?;
        reporter.end_with(INPUT);
    }
    if faults.has_errors() { Err(faults.into()) } else { Ok(()) }
}

/// Reads a file, or standard input for `-`.
fn change(name: &str, reporter: &mut Reporter) -> Result<Change, Failure> {
    let (file, has_mark) = files::read_to_replace(name, &mut reporter.sources)?;
    let source = reporter.sources.get(file);
    // alone: all texts together are only needed to speak of one
    let new = Parsed::of(&source.name, &source.text).formatted();
    let faults = || Parsed::of_source(reporter.sources.clone(), file, Path::new(name)).faults().clone();
    let new = new.ok_or_else(faults)?;
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
        if !reporter.is_for_programs() {
            Reporter::say(&format!("formatted `{name}`\n"));
        }
    }
    Ok(())
}

/// What stands for a `\r`, which is a line's end for the comparison and none for `patch`: no text holds it.
const NO_CHARACTER: &str = "\u{fdd0}";

/// What would change, as `patch` takes it; nothing if nothing would.
fn diff(change: &Change) -> String {
    let [old, new] = [&change.old, &change.new].map(|text| text.replace('\r', NO_CHARACTER));
    // a tab ends a name that holds spaces
    let end = if change.name.contains(char::is_whitespace) { "\t" } else { "" };
    let name = format!("{}{end}", change.name);
    let diff = TextDiff::from_lines(&old, &new);
    diff.unified_diff().header(&name, &name).to_string().replace(NO_CHARACTER, "\r")
}
