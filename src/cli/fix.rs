//! `mechc check --fix`: makes the changes of the text that its diagnostics propose and that always apply.

use super::arguments::Input;
use super::failure::Failure;
use super::files::{self, Output};
use super::input;
use super::report::Reporter;
use crate::check::{self, Surroundings};
use crate::diag::{Applies, Diagnostics, Fix, fixed};
use crate::source::{FileId, Sources};
use crate::syntax;

/// A change may let another one be seen; a text that still changes after so many rounds is left as it is then.
const MOST_ROUNDS: usize = 32;

/// Mends a command's file, says what was changed, and gives the text as it is then.
///
/// The file is replaced whole or not at all; what came from standard input goes to standard output.
pub(super) fn fix(input: &Input, reporter: &mut Reporter) -> Result<FileId, Failure> {
    let (first, has_mark) = files::read_with_mark(&input.file, &mut reporter.sources)?;
    let (mut file, mut made) = (first, Vec::new());
    for _ in 0..MOST_ROUNDS {
        let fixes = fixes(file, input, &mut reporter.sources);
        let (text, now) = fixed(&reporter.sources, file, &fixes);
        if now.is_empty() {
            break;
        }
        made.extend(now.into_iter().cloned());
        let name = reporter.sources.get(file).name.clone();
        file = reporter.sources.add(name, text);
    }
    if file != first || input.file == "-" {
        let mark = if has_mark { "\u{feff}" } else { "" };
        Output::write(&input.file, &format!("{mark}{}", reporter.sources.get(file).text))?;
    }
    reporter.made(&made);
    Ok(file)
}

/// The changes that always apply: those of the syntax, and where there are none, those of what the declarations mean.
fn fixes(file: FileId, input: &Input, sources: &mut Sources) -> Vec<Fix> {
    let parsed = syntax::parse(sources, file);
    let fixes = that_always_apply(parsed.faults);
    if !fixes.is_empty() {
        return fixes;
    }
    let mut found = check::check_file(&parsed.tree);
    for mechanism in &parsed.tree.mechanisms {
        let files = input::table_files(mechanism, &input.file, sources);
        let (_, said) = check::check(mechanism, &Surroundings { settings: Vec::new(), files }, sources);
        found.extend(said);
    }
    that_always_apply(found)
}

fn that_always_apply(diagnostics: Diagnostics) -> Vec<Fix> {
    diagnostics.into_iter().flat_map(|found| found.fixes).filter(|fix| fix.applies == Applies::Always).collect()
}
