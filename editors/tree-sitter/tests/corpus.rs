//! The corpus in `test/corpus`, which `tree-sitter test` takes too. `UPDATE_GOLDENS=1 cargo test --test corpus` writes its trees.

mod support;

use std::fs;
use support::{root, tree};

/// A tree, a node a line.
fn printed(text: &str) -> String {
    let tree = tree(text).root_node().to_sexp();
    let mut printed = String::new();
    let (mut depth, mut quote) = (0, None);
    for (index, c) in tree.char_indices() {
        let is_quoted = quote.is_some();
        match c {
            '"' | '\'' if quote.is_none_or(|open| open == c) => quote = if is_quoted { None } else { Some(c) },
            '(' if !is_quoted => depth += 1,
            ')' if !is_quoted => depth -= 1,
            _ => {}
        }
        // a child, or the field that it stands in, begins a line
        let rest = &tree[index + 1..];
        let is_before_node = rest.starts_with('(') || rest.split_once(' ').is_some_and(|(word, _)| word.ends_with(':'));
        if c == ' ' && !is_quoted && is_before_node && !tree[..index].ends_with(':') {
            printed += &format!("\n{}", "  ".repeat(depth));
        } else {
            printed.push(c);
        }
    }
    printed
}

#[test]
fn every_text_of_the_corpus_has_its_tree() {
    let rule = "=".repeat(80) + "\n";
    let between = format!("\n\n{}\n\n", "-".repeat(80));
    let mut texts = 0;
    for entry in fs::read_dir(root().join("editors/tree-sitter/test/corpus")).expect("the corpus") {
        let path = entry.expect("a file").path();
        let written = fs::read_to_string(&path).expect("a text");
        let mut made = String::new();
        let is_broken = path.ends_with("faults.txt");
        let mut parts = written.split(&rule).skip(1);
        while let (Some(name), Some(rest)) = (parts.next(), parts.next()) {
            let (text, _) = rest.split_once(&between).expect("a text and its tree");
            let tree = printed(&format!("{text}\n"));
            let has_fault = tree.contains("(ERROR") || tree.contains("(MISSING");
            assert!(is_broken || !has_fault, "{name}: {tree}");
            made += &format!("{rule}{name}{rule}{text}{between}{tree}\n\n");
            texts += 1;
        }
        let made = format!("{}\n", made.trim_end());
        if std::env::var_os("UPDATE_GOLDENS").is_some() {
            fs::write(&path, &made).expect("written");
        }
        let golden = fs::read_to_string(&path).expect("a text");
        assert!(golden == made, "{}: the trees are others:\n{made}", path.display());
    }
    assert!(texts >= 15, "only {texts} texts");
}
