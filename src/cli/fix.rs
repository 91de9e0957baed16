//! `mechc check --fix`: applies the fixes of a text's diagnostics that always apply.

use super::arguments::Input;
use super::failure::Failure;
use super::files::{self, Disk, Output};
use super::input;
use super::report::Reporter;
use mechc_pipeline::{Choice, Parsed};
use mechc_text::diag::fixed;

/// The maximum number of rounds; a fix may reveal another one.
const MAX_ROUNDS: usize = 32;

/// Fixes a command's file, prints what was changed, and returns the fixed text.
///
/// The file is replaced whole or not at all; standard input goes to standard output.
pub(super) fn fix(input: &Input, reporter: &mut Reporter) -> Result<Parsed, Failure> {
    let (first, has_mark) = files::read_with_mark(&input.file, &mut reporter.sources)?;
    let read = |file, reporter: &Reporter| Parsed::from_source(reporter.sources.clone(), file, input::path(input));
    let (mut parsed, mut applied) = (read(first, reporter), Vec::new());
    for _ in 0..MAX_ROUNDS {
        let fixes = parsed.certain_fixes(&Disk);
        let (text, new) = fixed(&reporter.sources, parsed.file(), &fixes);
        if new.is_empty() {
            break;
        }
        applied.extend(new.into_iter().cloned());
        let name = reporter.sources.get(first).name.clone();
        let file = reporter.sources.add(name, text);
        parsed = read(file, reporter);
    }
    if parsed.file() != first || input.file == "-" {
        let mark = if has_mark { "\u{feff}" } else { "" };
        let text = format!("{mark}{}", reporter.sources.get(parsed.file()).text);
        Output::replace(&input.file, &text).map_err(|why| with_diagnostics(why, &read(first, reporter), reporter))?;
    }
    reporter.print_fixes(&applied, first);
    Ok(parsed)
}

/// Adds the diagnostics of the unchanged text to the reason why the fixed one could not be written.
fn with_diagnostics(why: Failure, original: &Parsed, reporter: &mut Reporter) -> Failure {
    let Failure::Reported(mut diagnostics, _) = why else { return why };
    let checked = original.check(&Choice::default(), &Disk);
    reporter.sources = checked.sources().clone();
    diagnostics.extend(checked.diagnostics().iter().cloned());
    diagnostics.into()
}
