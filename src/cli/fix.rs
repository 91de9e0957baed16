//! `mechc check --fix`: makes the changes of the text that its diagnostics propose and that always apply.

use super::arguments::Input;
use super::failure::Failure;
use super::files::{self, Disk, Output};
use super::input;
use super::report::Reporter;
use mechc_pipeline::{Choice, Parsed};
use mechc_text::diag::fixed;

/// A change may let another one be seen; a text that still changes after so many rounds is left as it is then.
const MOST_ROUNDS: usize = 32;

/// Mends a command's file, says what was changed, and gives the text as it is then.
///
/// The file is replaced whole or not at all; what came from standard input goes to standard output.
pub(super) fn fix(input: &Input, reporter: &mut Reporter) -> Result<Parsed, Failure> {
    let (first, has_mark) = files::read_with_mark(&input.file, &mut reporter.sources)?;
    let read = |file, reporter: &Reporter| Parsed::of_source(reporter.sources.clone(), file, input::path(input));
    let (mut parsed, mut made) = (read(first, reporter), Vec::new());
    for _ in 0..MOST_ROUNDS {
        let fixes = parsed.certain_fixes(&Disk);
        let (text, now) = fixed(&reporter.sources, parsed.file(), &fixes);
        if now.is_empty() {
            break;
        }
        made.extend(now.into_iter().cloned());
        let name = reporter.sources.get(first).name.clone();
        let file = reporter.sources.add(name, text);
        parsed = read(file, reporter);
    }
    if parsed.file() != first || input.file == "-" {
        let mark = if has_mark { "\u{feff}" } else { "" };
        let text = format!("{mark}{}", reporter.sources.get(parsed.file()).text);
        Output::replace(&input.file, &text).map_err(|why| unwritten(why, &read(first, reporter), reporter))?;
    }
    reporter.made(&made, first);
    Ok(parsed)
}

/// Why a mended text could not be written, with all that is wrong with the one that stays.
fn unwritten(why: Failure, stays: &Parsed, reporter: &mut Reporter) -> Failure {
    match why {
        Failure::Said(mut said) => {
            let checked = stays.check(&Choice::default(), &Disk);
            reporter.sources = checked.sources().clone();
            said.extend(checked.diagnostics().iter().cloned());
            Failure::Said(said)
        }
        Failure::ReaderGone => Failure::ReaderGone,
    }
}
