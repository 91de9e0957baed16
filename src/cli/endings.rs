//! The form of an output: as `--format` says, or by its ending.

use super::failure::Failure;
use crate::diag::{Code, Diagnostic};
use std::path::Path;

/// The form that is said, else that of the ending, else the usual one: a name without an ending, `-` and what is no file, as
/// `/dev/null`, say nothing. Each form comes with its ending.
pub(super) fn form<F: Copy>(said: Option<F>, output: &str, forms: &[(&str, F)], usual: F) -> Result<F, Failure> {
    let path = Path::new(output);
    let ending = path.extension().map(|ending| ending.to_string_lossy()).filter(|ending| !ending.is_empty());
    let of = |ending: &str| forms.iter().find(|(known, _)| ending.eq_ignore_ascii_case(known)).map(|(_, form)| *form);
    let is_special = || path.metadata().is_ok_and(|found| !found.is_file() && !found.is_dir());
    match (said, ending) {
        (Some(form), _) => Ok(form),
        (None, None) => Ok(usual),
        (None, Some(ending)) => match of(&ending) {
            Some(form) => Ok(form),
            None if is_special() => Ok(usual),
            None => Err(unknown(output, &ending, forms).into()),
        },
    }
}

fn unknown<F>(output: &str, ending: &str, forms: &[(&str, F)]) -> Diagnostic {
    let endings: Vec<String> = forms.iter().map(|(ending, _)| format!("`.{ending}`")).collect();
    let listed = match endings.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => endings.concat(),
    };
    Diagnostic::new(Code::E0706, format!("`{output}` ends in `.{ending}`, which is not written here"))
        .help(format!("the endings are {listed}; `--format` writes one of these forms under any name"))
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
