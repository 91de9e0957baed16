//! The format of an output: from `--format`, or from the extension of its name.

use super::failure::{Failure, unusable};
use mechc_text::diag::Diagnostic;
use std::path::Path;

/// Returns the format of the option, else that of the extension, else the default. A name without an extension, `-` and devices such as
/// `/dev/null` have the default format.
pub(super) fn choose<F: Copy>(
    option: Option<F>,
    output: &str,
    formats: &[(&str, F)],
    default: F,
) -> Result<F, Failure> {
    let ending = Path::new(output).extension().map(|ending| ending.to_string_lossy()).filter(|e| !e.is_empty());
    match (option.or_else(|| by_extension(output, formats)), ending) {
        (Some(format), _) => Ok(format),
        (None, Some(ending)) if !is_special(output) => Err(unknown(output, &ending, formats).into()),
        (None, _) => Ok(default),
    }
}

/// Returns the format of a file name's extension.
pub(super) fn by_extension<F: Copy>(output: &str, formats: &[(&str, F)]) -> Option<F> {
    let ending = Path::new(output).extension()?.to_string_lossy();
    formats.iter().find(|(extension, _)| ending.eq_ignore_ascii_case(extension)).map(|(_, format)| *format)
}

/// Returns whether an output exists and is a pipe or a device.
pub(super) fn is_special(output: &str) -> bool {
    Path::new(output).metadata().is_ok_and(|found| !found.is_file() && !found.is_dir())
}

/// Lists the extensions for a message.
pub(super) fn list_extensions<F>(formats: &[(&str, F)]) -> String {
    let endings: Vec<String> = formats.iter().map(|(ending, _)| format!("`.{ending}`")).collect();
    match endings.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => endings.concat(),
    }
}

fn unknown<F>(output: &str, ending: &str, formats: &[(&str, F)]) -> Diagnostic {
    unusable(format!("`{output}` ends in `.{ending}`, which is not written here")).help(format!(
        "the endings are {}; `--format` writes one of these forms under any name",
        list_extensions(formats)
    ))
}

#[cfg(test)]
mod tests {
    use super::choose;

    #[test]
    fn the_option_comes_before_the_extension() {
        let formats = [("csv", 1), ("json", 2)];
        let of = |option, output| choose(option, output, &formats, 1).ok();
        for (output, expected) in
            [("a.csv", 1), ("a.JSON", 2), ("-", 1), ("a", 1), ("a.", 1), (".json", 1), ("b.x/a", 1)]
        {
            assert_eq!(of(None, output), Some(expected), "{output}");
        }
        for output in ["a.xlsx", "a.csv.gz", "a.json ", "run.2", "no/such/a.png", "a.c\u{e9}v"] {
            assert_eq!(of(None, output), None, "{output}");
            assert_eq!(of(Some(2), output), Some(2), "{output}");
        }
        assert_eq!(of(Some(2), "a.csv"), Some(2), "the option decides");
    }
}
