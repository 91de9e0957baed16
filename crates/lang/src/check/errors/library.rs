//! Diagnostics of files that use each other.

use mechc_syntax::ast::Name;
use mechc_text::diag::{Applicability, Code, Diagnostic, Fix, nearest};
use mechc_text::source::Span;

/// The largest number of listed names.
const MOST_LISTED: usize = 5;

/// A name before a `.` that is not a prefix of a `use`.
pub fn no_prefix(prefix: &Name, candidates: &[&Name]) -> Diagnostic {
    let names: Vec<&str> = candidates.iter().map(|name| name.text.as_str()).collect();
    let suggestion = nearest(&prefix.text, names.iter().copied()).map(|name| Fix::suggest(prefix.span, name));
    let diagnostic = Diagnostic::new(Code::E0201, format!("no file is used as `{}`", prefix.text))
        .at(prefix.span, "not the prefix of a `use`");
    match (suggestion, names.is_empty()) {
        (Some(fix), _) => diagnostic.fix(fix),
        (None, true) => {
            diagnostic.help(format!("say so at the top of the file: `use \"FILE.mech\" as {}`", prefix.text))
        }
        (None, false) => diagnostic.help(format!("the prefixes are {}", listed(&names))),
    }
}

/// An unknown mechanism, with those that exist. `elsewhere` is the name to write for one of a used file, `further` the file that holds it
/// but is not used, with its path.
pub fn no_mechanism(
    prefix: Option<&Name>,
    name: &Name,
    candidates: &[&str],
    suggestion: Option<&str>,
    elsewhere: Option<&str>,
    further: Option<(&str, String)>,
) -> Diagnostic {
    let place = prefix.map(|prefix| format!(" in `{}`", prefix.text)).unwrap_or_default();
    let diagnostic = Diagnostic::new(Code::E0201, format!("there is no mechanism `{}`{place}", name.text))
        .at(name.span, "not declared");
    if let Some(path) = elsewhere {
        let span = prefix.map_or(name.span, |prefix| prefix.span.to(name.span));
        let message = format!("it is there as `{path}`");
        return diagnostic.fix(Fix::replace(span, path, message, Applicability::Probably));
    }
    if let Some((file, path)) = further {
        return diagnostic.help(format!("`{file}` holds it: `use \"{path}\"` at the top of the file"));
    }
    match (suggestion, candidates) {
        (Some(suggestion), _) => diagnostic.fix(Fix::suggest(name.span, suggestion)),
        (None, []) => diagnostic,
        (None, names) => diagnostic.help(format!("the mechanisms are {}", listed(names))),
    }
}

/// Mechanisms of one name in two files, with the locations of their `use`s, and a free prefix.
pub fn names_twice(names: &[&str], files: [&str; 2], [first, second]: [Span; 2], prefix: &str) -> Diagnostic {
    let which = if names.len() == 1 { "a mechanism" } else { "mechanisms" };
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    let quoted: Vec<&str> = quoted.iter().map(String::as_str).collect();
    let message = format!("`{}` and `{}` both hold {which} {}", files[0], files[1], listed(&quoted));
    let help = format!("give it a prefix, ` as {prefix}`, and write `{prefix}.{}`", names.first().unwrap_or(&"NAME"));
    Diagnostic::new(Code::E0205, message).at(second, "the second one").also(first, "the first one").fix(Fix::append(
        second,
        format!(" as {prefix}"),
        help,
        Applicability::Probably,
    ))
}

/// A prefix of two `use`s.
pub fn second_prefix(prefix: &Name, first: Span) -> Diagnostic {
    Diagnostic::new(Code::E0203, format!("two files are used as `{}`", prefix.text))
        .at(prefix.span, "the second one")
        .also(first, "the first one")
        .help("give one of them another prefix")
}

/// Files with the locations at which each uses the next one; the last one uses the first.
pub fn cycle_of_files(links: &[(&str, Span)]) -> Diagnostic {
    let message = match links {
        [(file, _)] => format!("`{file}` uses itself"),
        [(first, _), ..] => {
            let path: Vec<String> = links.iter().map(|(file, _)| format!("`{file}`")).collect();
            format!("files use each other in a circle: {} → `{first}`", path.join(" → "))
        }
        [] => String::new(),
    };
    let mut diagnostic = Diagnostic::new(Code::E0206, message);
    for (k, (_, span)) in links.iter().enumerate() {
        let next = links.get(k + 1).or(links.first()).map_or("", |(file, _)| *file);
        let text = format!("uses `{next}`");
        diagnostic = if k == 0 { diagnostic.at(*span, text) } else { diagnostic.also(*span, text) };
    }
    diagnostic.help("put what they share into a file of its own, which uses none of them")
}

fn listed(names: &[&str]) -> String {
    let text = names.iter().take(MOST_LISTED).copied().collect::<Vec<_>>().join(", ");
    match names.len().saturating_sub(MOST_LISTED) {
        0 => text,
        more => format!("{text} and {more} more"),
    }
}
