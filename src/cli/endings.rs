//! The form of an output: as `--format` says, or by its ending.

use super::failure::{Failure, unusable};
use mechc_text::diag::Diagnostic;
use std::path::Path;

/// The form that is said, else that of the ending, else the usual one: a name without an ending, `-` and what is no file, as
/// `/dev/null`, say nothing. Each form comes with its ending.
pub(super) fn form<F: Copy>(said: Option<F>, output: &str, forms: &[(&str, F)], usual: F) -> Result<F, Failure> {
    let ending = Path::new(output).extension().map(|ending| ending.to_string_lossy()).filter(|e| !e.is_empty());
    match (said.or_else(|| known(output, forms)), ending) {
        (Some(form), _) => Ok(form),
        (None, Some(ending)) if !is_special(output) => Err(unknown(output, &ending, forms).into()),
        (None, _) => Ok(usual),
    }
}

/// The form that the ending of a file's name says.
pub(super) fn known<F: Copy>(output: &str, forms: &[(&str, F)]) -> Option<F> {
    let ending = Path::new(output).extension()?.to_string_lossy();
    forms.iter().find(|(known, _)| ending.eq_ignore_ascii_case(known)).map(|(_, form)| *form)
}

/// Whether it is there and no file, but a pipe or a device.
pub(super) fn is_special(output: &str) -> bool {
    Path::new(output).metadata().is_ok_and(|found| !found.is_file() && !found.is_dir())
}

/// The endings, as they are told.
pub(super) fn listed<F>(forms: &[(&str, F)]) -> String {
    let endings: Vec<String> = forms.iter().map(|(ending, _)| format!("`.{ending}`")).collect();
    match endings.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => endings.concat(),
    }
}

fn unknown<F>(output: &str, ending: &str, forms: &[(&str, F)]) -> Diagnostic {
    unusable(format!("`{output}` ends in `.{ending}`, which is not written here"))
        .help(format!("the endings are {}; `--format` writes one of these forms under any name", listed(forms)))
}

#[cfg(test)]
mod tests {
    use super::form;

    #[test]
    fn forms_go_by_what_is_said_then_by_the_ending() {
        let forms = [("csv", 1), ("json", 2)];
        let of = |said, output| form(said, output, &forms, 1).ok();
        for (output, wanted) in [("a.csv", 1), ("a.JSON", 2), ("-", 1), ("a", 1), ("a.", 1), (".json", 1), ("b.x/a", 1)]
        {
            assert_eq!(of(None, output), Some(wanted), "{output}");
        }
        for output in ["a.xlsx", "a.csv.gz", "a.json ", "run.2", "no/such/a.png", "a.c\u{e9}v"] {
            assert_eq!(of(None, output), None, "{output}");
            assert_eq!(of(Some(2), output), Some(2), "{output}");
        }
        assert_eq!(of(Some(2), "a.csv"), Some(2), "what is said counts");
    }
}
