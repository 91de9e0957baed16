//! Files of one editor that are made of those of another one, and what else agrees.

use super::holds;
use mechc::{Cancel, Choice, Memory, Parsed, Redundant};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;

/// The queries of the tree-sitter grammar.
const QUERIES: [&str; 6] = ["folds", "highlights", "indents", "injections", "locals", "textobjects"];

/// What Helix calls otherwise; longer names before those that they begin with.
const IN_HELIX: [(&str, &str); 14] = [
    ("@keyword.conditional", "@keyword.control.conditional"),
    ("@string.special.path", "@string.special"),
    ("@number", "@constant.numeric"),
    ("@property", "@variable.other.member"),
    ("@module", "@namespace"),
    ("@function.call", "@function"),
    ("@comment.documentation", "@comment.line.documentation"),
    ("@indent.begin", "@indent"),
    ("@indent.branch", "@outdent"),
    ("@function.outer", "@function.around"),
    ("@function.inner", "@function.inside"),
    ("@class.outer", "@class.around"),
    ("@class.inner", "@class.inside"),
    ("markdown_inline", "markdown.inline"),
];

fn query(name: &str) -> String {
    fs::read_to_string(format!("editors/tree-sitter/queries/{name}.scm")).expect("a query")
}

/// A query with the names that Helix has.
fn in_helix(query: &str) -> String {
    let query = query.replace("Neovim and tree-sitter's own command use", "Helix uses");
    let query = query.replace("@parameter.inner", "@parameter.inside").replace("@comment.outer", "@comment.around");
    let renamed = IN_HELIX.iter().fold(query, |query, (from, to)| query.replace(from, to));
    let lines = renamed.lines().filter(|line| !line.contains("@indent.end") && !line.contains("@indent.auto"));
    lines.map(|line| line.to_owned() + "\n").collect()
}

#[test]
fn neovim_has_the_queries_of_the_grammar() {
    for name in QUERIES {
        holds(&format!("neovim/queries/mech/{name}.scm"), |_| query(name));
    }
}

#[test]
fn helix_queries_match_the_grammar() {
    // it folds by indentation
    for name in QUERIES.into_iter().filter(|name| *name != "folds") {
        holds(&format!("helix/queries/mech/{name}.scm"), |_| in_helix(&query(name)));
    }
}

/// `tree-sitter generate` was run since the grammar was changed.
#[test]
fn the_parser_is_that_of_the_grammar() {
    let generated: Value = serde_json::from_str(&read("tree-sitter/src/grammar.json")).expect("JSON");
    let grammar = read("tree-sitter/grammar.js");
    let (_, words) = grammar.split_once("const RESERVED = [").expect("the words");
    let (words, _) = words.split_once(']').expect("their end");
    let wanted: BTreeSet<&str> = words.split('\'').skip(1).step_by(2).collect();
    let reserved = generated["reserved"]["global"].as_array().expect("words");
    let found: BTreeSet<&str> = reserved.iter().filter_map(|word| word["value"].as_str()).collect();
    assert_eq!(wanted, found, "`tree-sitter generate` in editors/tree-sitter makes the parser anew");
    let rules: BTreeSet<&str> = generated["rules"].as_object().expect("rules").keys().map(String::as_str).collect();
    let (_, written) = grammar.split_once("rules: {").expect("the rules");
    let written: BTreeSet<&str> = written
        .lines()
        .filter_map(|line| line.strip_prefix("    ")?.split_once(": "))
        .filter(|(name, rule)| !name.starts_with([' ', '/']) && (rule.starts_with('$') || rule.starts_with('_')))
        .map(|(name, _)| name)
        .collect();
    assert_eq!(written, rules, "`tree-sitter generate` in editors/tree-sitter makes the parser anew");
}

/// The rules of the language's grammar that are nodes of the editors' one, too.
#[test]
fn the_grammars_have_the_same_declarations() {
    let grammar = fs::read_to_string("grammar/mech.pest").expect("the grammar");
    let rule = |name: &str| -> BTreeSet<String> {
        let (_, rule) = grammar.split_once(&format!("\n{name} ")).expect(name);
        let (rule, _) = rule.split_once("}\n").expect("its end");
        rule.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
            .filter(|word| word.len() > 1)
            .map(str::to_owned)
            .collect()
    };
    let generated: Value = serde_json::from_str(&read("tree-sitter/src/grammar.json")).expect("JSON");
    let members = |name: &str| -> BTreeSet<String> {
        let members = generated["rules"][name]["members"].as_array().expect("a choice");
        members.iter().filter_map(|member| member["name"].as_str()).map(str::to_owned).collect()
    };
    let mut items = rule("plain_item");
    items.extend(rule("item").into_iter().filter(|name| name != "plain_item"));
    assert_eq!(members("_item"), items);
    assert_eq!(members("_feature"), rule("feature"));
}

/// A snippet with the text of its stops: `${2:40 mm}` is `40 mm`, `$0` nothing.
fn typed(snippet: &str) -> String {
    let mut text = String::new();
    let mut rest = snippet;
    while let Some((before, stop)) = rest.split_once('$') {
        text += before;
        let (inner, behind) = match stop.strip_prefix('{') {
            Some(stop) => stop.split_once('}').expect("the stop ends"),
            None => ("", stop.trim_start_matches(|c: char| c.is_ascii_digit())),
        };
        text += inner.split_once(':').map_or("", |(_, proposed)| proposed);
        rest = behind;
    }
    text + rest
}

#[test]
fn every_snippet_follows_the_grammar() {
    let snippets: Value = serde_json::from_str(&read("vscode/snippets/mech.json")).expect("JSON");
    let snippets = snippets.as_object().expect("snippets by their names");
    for (name, snippet) in snippets {
        let body = &snippet["body"];
        let lines = body.as_array().map_or_else(|| vec![body], |lines| lines.iter().collect());
        let body = typed(&lines.iter().filter_map(|line| line.as_str()).collect::<Vec<_>>().join("\n"));
        let text = match name.as_str() {
            "mechanism" | "fourbar" => body,
            "if" => format!("mechanism a {{ param b = {body} }}"),
            "mass" => format!("mechanism a {{ body b {{ {body} }} }}"),
            _ => format!("mechanism a {{ {body} }}"),
        };
        let parsed = Parsed::new(name, &text);
        assert!(parsed.faults().is_empty(), "{name}: {text}");
        if name == "fourbar" {
            let checked = parsed.check(&Choice::default(), &Memory::default());
            let (compiled, messages) = checked.compile(Redundant::Refused, &Cancel::default());
            assert!(compiled.is_some() && messages.is_empty() && checked.diagnostics().is_empty(), "{text}");
        }
    }
    assert!(snippets.len() > 5, "only {} snippets", snippets.len());
}

fn read(path: &str) -> String {
    fs::read_to_string(format!("editors/{path}")).expect("the file")
}
