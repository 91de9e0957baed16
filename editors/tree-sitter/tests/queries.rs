//! The queries: they fit the grammar, and give every word of the language its colour.

mod support;

use mechc::Category;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use support::{root, texts, tree};
use tree_sitter::{Query, QueryCursor, StreamingIterator};

fn query(path: &Path) -> Query {
    let text = fs::read_to_string(path).expect("a query");
    Query::new(&tree_sitter_mech::LANGUAGE.into(), &text).unwrap_or_else(|fault| panic!("{}: {fault}", path.display()))
}

/// What a query captures in a text: words with the names of their captures.
fn captures(query: &Query, text: &str) -> BTreeSet<(String, String)> {
    let tree = tree(text);
    let mut cursor = QueryCursor::new();
    let mut found = BTreeSet::new();
    let mut captures = cursor.captures(query, tree.root_node(), text.as_bytes());
    while let Some((found_match, index)) = captures.next() {
        let capture = found_match.captures()[*index];
        let name = query.capture_names()[capture.index as usize];
        found.insert((text[capture.node.byte_range()].to_owned(), name.to_owned()));
    }
    found
}

#[test]
fn every_query_fits_the_grammar_and_finds_something() {
    let text: String = texts().into_iter().map(|one| one.text + "\n").collect();
    let mut looked_at = 0;
    for folder in ["tree-sitter/queries", "helix/queries/mech", "neovim/queries/mech"] {
        for entry in fs::read_dir(root().join("editors").join(folder)).expect("a folder") {
            let path = entry.expect("a file").path();
            let query = query(&path);
            let found: BTreeSet<String> = captures(&query, &text).into_iter().map(|(_, name)| name).collect();
            for name in query.capture_names() {
                assert!(found.contains(*name), "{}: @{name} captures nothing", path.display());
            }
            looked_at += 1;
        }
    }
    assert!(looked_at >= 15, "only {looked_at} queries");
}

#[test]
fn every_word_has_its_colour() {
    for folder in ["tree-sitter/queries", "helix/queries/mech"] {
        let query = query(&root().join("editors").join(folder).join("highlights.scm"));
        let mut without = Vec::new();
        for word in mechc::words() {
            let wanted: &[&str] = match word.category {
                Category::Keyword if ["left", "right", "crossed"].contains(&word.name) => &["constant.builtin"],
                Category::Keyword => {
                    &["keyword", "keyword.conditional", "keyword.control.conditional", "keyword.operator"]
                }
                Category::Function | Category::Motion | Category::Quantity | Category::Reduction | Category::Joint => {
                    &["function.builtin"]
                }
                Category::Unit => &["type.builtin"],
                Category::Constant => &["constant.builtin", "variable.builtin"],
            };
            // stands in the example's comment alone, because it needs a file
            let example = if word.name == "use" || word.name == "as" || word.name == "columns" {
                "use \"a.mech\" as b mechanism c { table d = spline \"e.csv\" columns 1, 2 (s, mm) }".to_owned()
            } else {
                word.example()
            };
            let found = captures(&query, &example);
            if !wanted.iter().any(|capture| found.contains(&(word.name.to_owned(), (*capture).to_owned()))) {
                without.push(word.name);
            }
        }
        assert!(without.is_empty(), "{folder}: {without:?}");
    }
}

#[test]
fn a_word_that_is_a_name_has_the_colour_of_a_name() {
    let query = query(&root().join("editors/tree-sitter/queries/highlights.scm"));
    let text = "mechanism a { param at = 1 body to at (0, 0, 0) { point in = (0, 0) } measure every = x(to.in) in mm trace input = to.in }";
    let found = captures(&query, text);
    for (word, capture) in
        [("at", "constant"), ("to", "type"), ("in", "property"), ("every", "variable"), ("input", "variable")]
    {
        assert!(found.contains(&(word.to_owned(), capture.to_owned())), "{word}: {found:?}");
    }
    for word in ["to", "every", "input"] {
        assert!(!found.contains(&(word.to_owned(), "keyword".to_owned())), "{word}");
    }
}
