//! Spells options of the command as in Python: `--lead` is `lead=True`, `--set rod=80mm` is `set={'rod': '80mm'}`.

use mechc::{Diagnostic, OptionText, Sources};

/// Options without a value.
const FLAGS: [&str; 8] =
    ["lead", "reactions", "pass-bifurcations", "allow-redundant", "rows", "yes", "verify", "normal"];

/// Options of the form `NAME=FORMULA`, with their keywords.
const MAPPINGS: [(&str, &str); 5] =
    [("set", "set"), ("input", "inputs"), ("result", "results"), ("tol", "tol"), ("vary", "vary")];

/// Options whose keywords have another name.
const RENAMED: [(&str, &str); 2] = [("from", "from_"), ("sample", "samples")];

/// Options that Python lacks, with the command that has them.
const OF_COMMAND: [(&str, &str); 1] = [("with", "mechc emit")];

/// Returns a diagnostic with options spelled as in Python.
pub fn in_python(diagnostic: &Diagnostic) -> Diagnostic {
    let spell =
        |options: &[OptionText<'_>]| options.iter().map(|option| spelled(*option)).collect::<Vec<_>>().join(", ");
    diagnostic.clone().with_options_spelled(spell)
}

/// Returns source texts in which those of options have the names of keywords.
pub fn with_keywords(sources: &Sources) -> Sources {
    sources.with_option_names(|source| match source.strip_prefix("--") {
        // the name of what is set may follow
        Some(option) => match option.split_once(' ') {
            Some((option, rest)) => format!("{} {rest}", keyword(option)),
            None => keyword(option),
        },
        None => source.to_owned(),
    })
}

/// Returns the keyword of an option.
fn keyword(option: &str) -> String {
    let renamed = MAPPINGS.iter().chain(&RENAMED).find(|(name, _)| *name == option);
    renamed.map_or_else(|| option.replace('-', "_"), |(_, keyword)| (*keyword).to_owned())
}

/// Returns an option with its value as a keyword argument.
fn spelled(OptionText { name: option, value }: OptionText<'_>) -> String {
    if let Some((_, command)) = OF_COMMAND.iter().find(|(name, _)| *name == option) {
        return format!("{command} --{option} {value}").trim_end().to_owned();
    }
    let name = keyword(option);
    if FLAGS.contains(&option) {
        return format!("{name}=True");
    }
    if let Some(table) = value.strip_prefix('@').filter(|_| option == "vary") {
        return format!("variants={}", quoted(table));
    }
    if !MAPPINGS.iter().any(|(mapping, _)| *mapping == option) {
        return if value.is_empty() { name } else { format!("{name}={}", literal(value)) };
    }
    match value.split_once('=') {
        None => format!("{name}={{{}}}", literal(value)),
        Some((key, formula)) => {
            let formula = formula.trim();
            let formula = formula.strip_prefix('\'').and_then(|inner| inner.strip_suffix('\'')).unwrap_or(formula);
            format!("{name}={{{}: {}}}", quoted(key.trim()), values(option, formula))
        }
    }
}

/// Returns the value, the range of a sweep, or the tolerance of a param as Python writes it.
fn values(option: &str, formula: &str) -> String {
    match (option, formula.split_once("..")) {
        ("tol", Some((low, high))) => format!("({}, {})", literal(low), literal(high)),
        ("vary", Some((first, last))) => {
            let (last, count) = last.split_once(':').map_or((last, None), |(last, count)| (last, Some(count)));
            let parts: Vec<String> = [first, last].into_iter().chain(count).map(literal).collect();
            format!("mechc.between({})", parts.join(", "))
        }
        ("vary", None) if formula.contains(',') => {
            format!("[{}]", formula.split(',').map(literal).collect::<Vec<_>>().join(", "))
        }
        _ => literal(formula),
    }
}

/// Returns a value as Python writes it: numbers, and single capital letters as placeholders, as they are; anything else as a string.
fn literal(value: &str) -> String {
    let is_number = value.starts_with(|c: char| c.is_ascii_digit() || "+-".contains(c)) && value.parse::<f64>().is_ok();
    let is_letter = value.len() == 1 && value.starts_with(|c: char| c.is_ascii_uppercase());
    match value {
        "" | "…" => "…".to_owned(),
        _ if is_number || is_letter => value.to_owned(),
        _ => quoted(value),
    }
}

fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\\', "\\\\").replace('\'', "\\'"))
}
