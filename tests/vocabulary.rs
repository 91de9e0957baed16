//! The words of the language: one table each, which the grammar and the fuzzers' dictionary agree with.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use mechc::vocabulary::{self, Category, KEYWORDS, Keyword, Role};
use std::collections::BTreeSet;
use std::fs;

/// The words in quotes of one rule of the grammar.
fn words_of_rule(rule: &str) -> BTreeSet<String> {
    let grammar = fs::read_to_string("grammar/mech.pest").expect("the grammar");
    let from = grammar.find(&format!("\n{rule} ")).unwrap_or_else(|| panic!("no rule {rule}"));
    let text = &grammar[from + 1..];
    let text = &text[..text.find("}\n").expect("its end")];
    text.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

fn keywords(wanted: impl Fn(&Keyword) -> bool) -> BTreeSet<String> {
    KEYWORDS.iter().filter(|keyword| wanted(keyword)).map(|keyword| keyword.word.name.to_owned()).collect()
}

#[test]
fn the_grammar_has_the_keywords_of_the_table() {
    assert_eq!(words_of_rule("reserved"), keywords(Keyword::is_reserved));
    assert_eq!(words_of_rule("separator"), keywords(|keyword| keyword.role == Role::Separator));
    let grammar = fs::read_to_string("grammar/mech.pest").expect("the grammar");
    for keyword in KEYWORDS.iter().filter(|keyword| keyword.role != Role::Side) {
        let (name, prefix) = (keyword.word.name, if keyword.is_reserved() { "kw_" } else { "" });
        let rule = grammar.lines().find(|line| line.starts_with(&format!("{prefix}{name} ")));
        assert!(rule.is_some_and(|rule| rule.contains(&format!("\"{name}\""))), "no rule for `{name}`: {rule:?}");
    }
    let features = words_of_rule("feature");
    assert!(features.is_empty(), "the features are rules, named as their keywords");
    let feature = grammar.lines().find(|line| line.starts_with("feature ")).expect("the rule");
    let named: BTreeSet<String> = feature
        .split(['{', '|', '}'])
        .skip(1)
        .map(|rule| rule.trim().to_owned())
        .filter(|rule| !rule.is_empty())
        .collect();
    assert_eq!(named, keywords(|keyword| keyword.role == Role::Feature));
}

#[test]
fn no_name_stands_twice_in_a_table() {
    let mut seen = BTreeSet::new();
    for word in vocabulary::words() {
        let is_of_functions = matches!(word.category, Category::Function | Category::Motion | Category::Quantity);
        let space = if is_of_functions { "called".to_owned() } else { format!("{:?}", word.category) };
        assert!(seen.insert((space, word.name)), "`{}` stands twice", word.name);
        assert!(!word.forms.is_empty() && word.forms.iter().all(|form| form.contains(word.name)), "{word:?}");
        assert!(!word.meaning.is_empty() && !word.meaning.ends_with('.'), "{word:?}");
    }
    assert!(seen.len() > 90, "only {} words", seen.len());
}

#[test]
fn the_dictionary_of_the_fuzzers_has_every_word() {
    let dictionary = fs::read_to_string("fuzz/mech.dict").expect("the dictionary");
    let escaped = |name: &str| -> String {
        name.bytes().map(|b| if b.is_ascii() { char::from(b).to_string() } else { format!("\\x{b:02x}") }).collect()
    };
    let missing: Vec<&str> = vocabulary::words()
        .map(|word| word.name)
        .filter(|name| !dictionary.lines().any(|line| line == format!("\"{}\"", escaped(name))))
        .collect();
    assert!(missing.is_empty(), "fuzz/mech.dict lacks {missing:?}");
}
