//! `mechc explain`: the page of a diagnostic's code or of a word of the language, or the list of all codes.

use super::arguments::ExplainArguments;
use super::failure::{Failure, unusable};
use super::files;
use mechc_text::diag::{Code, Diagnostic, nearest};
use mechc_text::vocabulary::{self, OVERVIEWS, Synonym, topics};

pub(super) fn explain(arguments: &ExplainArguments) -> Result<(), Failure> {
    match &arguments.name {
        None => files::print(&list()),
        Some(name) => match (Code::named(name), vocabulary::page(name)) {
            (Some(code), _) => files::print(code.page()),
            (None, Some(page)) => files::print(&page),
            (None, None) => Err(unknown(name).into()),
        },
    }
}

/// Lists the codes with their titles, by area.
fn list() -> String {
    let mut text = String::new();
    for area in Code::ALL.chunk_by(|a, b| a.area() == b.area()) {
        let gap = if text.is_empty() { "" } else { "\n" };
        text += &format!("{gap}{}\n", area.first().map_or("", |code| code.area()));
        for code in area {
            text += &format!("  {code}  {}\n", code.title());
        }
    }
    text
}

fn unknown(name: &str) -> Diagnostic {
    let diagnostic = unusable(format!("there is no code and no word `{name}`"));
    let mut synonyms = Synonym::all_of(name).map(|synonym| (synonym.message(&[]), synonym.means())).peekable();
    if synonyms.peek().is_some() {
        return synonyms.fold(diagnostic, |diagnostic, (message, means)| {
            let pages: Vec<String> = means.map(|word| format!("`mechc explain {word}`")).collect();
            let end = if message.ends_with('?') { "" } else { ";" };
            diagnostic.help(if pages.is_empty() {
                message
            } else {
                format!("{message}{end} see {}", pages.join(" and "))
            })
        });
    }
    let words = vocabulary::words().map(|word| word.name).chain(OVERVIEWS.iter().copied()).chain(topics());
    let code = nearest(&name.to_uppercase(), Code::ALL.iter().map(|code| code.as_str()));
    if ["comment", "comments", "//", "///", "#"].contains(&name) {
        return diagnostic
            .help("a comment begins with `//` and ends with its line; `///` above a declaration documents it");
    }
    // a short name is similar to many words, so its first letter must agree
    let is_likely = |word: &&str| name.chars().count() > 5 || name.chars().next() == word.chars().next();
    match code.or_else(|| nearest(name, words).filter(is_likely)) {
        Some(suggestion) => diagnostic.help(format!("was `{suggestion}` meant? `mechc explain` lists all codes")),
        None => diagnostic
            .help(format!("`mechc explain` lists all codes; the words are listed by {}", overviews()))
            .help(format!("there are pages on {}", topics().collect::<Vec<_>>().join(", "))),
    }
}

/// Lists the commands that show overviews: `mechc explain functions` and others.
fn overviews() -> String {
    let names: Vec<String> = OVERVIEWS.iter().map(|name| format!("`mechc explain {name}`")).collect();
    names.join(", ")
}
