//! The words of the language: one table each, which the grammar and the fuzzers' dictionary agree with.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod support;

use mechc::ir::DeclarationKind;
use mechc::source::Sources;
use mechc::vocabulary::{self, Category, KEYWORDS, Keyword, OVERVIEWS, Role};
use std::collections::BTreeSet;
use std::fs;
use support::{Span, compile, run};

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

#[test]
fn every_example_of_a_page_checks_and_runs_without_a_word() {
    for word in vocabulary::words() {
        let example = word.example();
        let page = vocabulary::page(word.name).expect("a page");
        assert!(page.contains(word.name), "{page}");
        let mut sources = Sources::default();
        let (determined, diagnostics) = compile(&mut sources, word.name, &example);
        assert!(determined.is_some() && diagnostics.is_empty(), "{}: {example}", word.name);
        assert!(example.contains(word.name), "the example of `{}` does not show it:\n{example}", word.name);
        // nor is anything to be said of its motion
        let analysis = if example.contains("analysis") { "" } else { "analysis from 0 s to 1 s every 0.1 s\n}" };
        let example = example
            .strip_suffix("}\n")
            .filter(|_| !analysis.is_empty())
            .map_or(example.clone(), |e| e.to_owned() + analysis);
        let outcome = run(word.name, &example, Span { to: Some(1.0), every: Some(0.1) });
        assert!(outcome.diagnostics.is_empty() && outcome.rows.len() == 11, "{}: {}", word.name, outcome.text());
    }
}

#[test]
fn joints_have_as_many_equations_and_coordinates_as_their_pages_say() {
    for joint in vocabulary::JOINTS {
        let mut sources = Sources::default();
        let (determined, _) = compile(&mut sources, joint.word.name, &joint.word.example());
        let determined = determined.expect("determined");
        let system = determined.system();
        let (number, _) = system
            .declarations
            .iter()
            .enumerate()
            .find(
                |(_, declaration)| matches!(declaration.kind, DeclarationKind::Joint(kind) if kind == joint.word.name),
            )
            .expect("the joint");
        let rows = system.rows.iter().filter(|row| row.declaration == number).count();
        assert_eq!(rows, joint.equations, "{}", joint.word.name);
        let name = &system.declarations[number].name;
        let own: Vec<&str> =
            system.coordinates.iter().filter_map(|c| c.name.strip_prefix(&format!("{name}."))).collect();
        let told: Vec<&str> = joint.coordinates.iter().map(|(name, _)| *name).collect();
        assert_eq!(own, told, "{}", joint.word.name);
    }
}

#[test]
fn pages_are_text_of_one_form() {
    let words = vocabulary::words().map(|word| word.name);
    for name in words.chain(OVERVIEWS.iter().copied()) {
        let page = vocabulary::page(name).expect("a page");
        assert!(page.starts_with("# ") && page.ends_with('\n') && !page.ends_with("\n\n"), "{page}");
        assert!(!page.contains("\n\n\n") && !page.contains(".."), "{page}");
        for line in page.lines() {
            assert!(line.trim_end() == line && line.chars().count() <= 130, "{name}: {line:?}");
        }
    }
    assert!(vocabulary::page("prismatic").is_none());
}

#[test]
fn every_word_stands_in_the_list_of_its_kind() {
    let lists: String = OVERVIEWS.iter().map(|name| vocabulary::page(name).expect("a page")).collect();
    for word in vocabulary::words() {
        let begins = |line: &str| line.trim_start().starts_with(word.name);
        assert!(lists.lines().any(begins), "`{}` is in no list", word.name);
    }
}
