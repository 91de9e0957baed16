//! The catalogue: a page per code whose examples do what it says of them, a place that raises it, a test that shows it, and
//! the index of all of them. `cargo test --test listed E0203` runs what is about one page.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support;

use crate::named_tests::Tests;
use crate::support::{Span, files, run, stem};
use mechc::{Code, Severity};
use std::fs;

/// The parts of a page below its introduction; the last one may be missing.
const PARTS: [&str; 4] = ["An example that fails", "Why", "Mended", "See also"];

/// The parts that hold an example, one each.
const EXAMPLES: [&str; 2] = ["An example that fails", "Mended"];

/// The longest line of prose and of a file.
const WIDTH: usize = 110;

/// A page, taken apart.
struct Page {
    title: String,
    /// Heading, prose and fenced blocks; the introduction has no heading.
    parts: Vec<Part>,
}

#[derive(Default)]
struct Part {
    heading: String,
    prose: String,
    blocks: Vec<Block>,
}

#[derive(Default)]
struct Block {
    language: String,
    text: String,
}

impl Page {
    fn read(text: &str) -> Page {
        let mut lines = text.lines();
        let title = lines.next().unwrap_or_default().to_owned();
        let mut parts = vec![Part::default()];
        while let Some(line) = lines.next() {
            let part = parts.last_mut().expect("never empty");
            if let Some(heading) = line.strip_prefix("## ") {
                parts.push(Part { heading: heading.to_owned(), ..Part::default() });
            } else if let Some(language) = line.strip_prefix("```") {
                let text = lines.by_ref().take_while(|line| *line != "```").map(|line| line.to_owned() + "\n");
                part.blocks.push(Block { language: language.to_owned(), text: text.collect() });
            } else {
                part.prose += line;
                part.prose += "\n";
            }
        }
        Page { title, parts }
    }

    /// The example of a part; `None` for one in words.
    fn example(&self, heading: &str) -> Option<&Block> {
        self.parts.iter().find(|part| part.heading == heading)?.blocks.first()
    }
}

/// What is wrong with the form of a page.
fn faults_of_form(code: Code, text: &str) -> Vec<String> {
    let page = Page::read(text);
    let mut faults = Vec::new();
    let mut wants = |right: bool, what: String| {
        if !right {
            faults.push(what);
        }
    };
    wants(
        page.title == format!("# {code}: {}", code.title()),
        "the first line is not the catalogue's title".to_owned(),
    );
    let headings: Vec<&str> = page.parts.iter().skip(1).map(|part| part.heading.as_str()).collect();
    wants(headings == PARTS || headings == PARTS[..3], format!("the parts are {headings:?}"));
    for Part { heading, prose, blocks } in &page.parts {
        let example = EXAMPLES.contains(&heading.as_str());
        wants(example || !prose.trim().is_empty(), format!("`{heading}` says nothing"));
        let right = blocks.len() == usize::from(example);
        wants(right, format!("`{heading}` has {} fenced blocks", blocks.len()));
        for block in blocks {
            let known = matches!(block.language.as_str(), "mech" | "console");
            wants(known, format!("`{heading}` has a block of `{}`", block.language));
        }
        // what a session prints is as wide as it is
        let files = blocks.iter().filter(|block| block.language == "mech").flat_map(|block| block.text.lines());
        for line in prose.lines().chain(files) {
            wants(line.chars().count() <= WIDTH, format!("a long line: {line}"));
            wants(line.trim_end() == line && !line.contains('\t'), format!("blanks or tabs: {line:?}"));
        }
        for named in codes_in(prose) {
            wants(Code::named(&named).is_some(), format!("there is no code {named}"));
        }
    }
    wants(text.ends_with('\n') && !text.ends_with("\n\n"), "the last line does not end the page".to_owned());
    faults
}

/// What looks like a code in a text, in order.
fn codes_in(text: &str) -> Vec<String> {
    let looks_right = |word: &&str| {
        word.len() == 5 && word.starts_with(['E', 'W', 'N']) && word[1..].bytes().all(|byte| byte.is_ascii_digit())
    };
    text.split(|c: char| !c.is_alphanumeric()).filter(looks_right).map(str::to_owned).collect()
}

/// The codes that an example raises.
fn raised(code: Code, example: &Block) -> Vec<String> {
    if example.language == "console" {
        // the sessions are held against what is printed by `tests/listed/sessions.rs`
        return example.text.lines().filter(|line| !line.starts_with("$ ")).flat_map(codes_in).collect();
    }
    let outcome = run(&format!("{code}.mech"), &example.text, Span::default());
    outcome.codes().into_iter().map(str::to_owned).collect()
}

/// Codes that another one cannot do without: what was left out ceases to hold.
const COME_ALONG: &[(&str, &str)] = &[("E0611", "W0502")];

/// What is wrong with the examples of a page.
fn faults_of_examples(code: Code) -> Vec<String> {
    let page = Page::read(code.page());
    let mut faults = Vec::new();
    if let Some(failing) = page.example(EXAMPLES[0]) {
        let codes = raised(code, failing);
        let other = |one: &String| one != code.as_str() && !COME_ALONG.contains(&(code.as_str(), one));
        if !codes.iter().any(|one| one == code.as_str()) || codes.iter().any(other) {
            faults.push(format!("the failing example raises {codes:?}"));
        }
    }
    if let Some(mended) = page.example(EXAMPLES[1]) {
        let codes = raised(code, mended);
        if !codes.is_empty() {
            faults.push(format!("the mended example raises {codes:?}"));
        } else if mended.language == "mech" && run("mended.mech", &mended.text, Span::default()).rows.is_empty() {
            faults.push("the mended example has no analysis".to_owned());
        }
    }
    faults
}

fn has_its_form(code: Code) {
    assert_eq!(faults_of_form(code, code.page()), [""; 0]);
}

fn has_examples_that_raise_what_it_is_about_and_mended_they_raise_nothing(code: Code) {
    assert_eq!(faults_of_examples(code), [""; 0]);
}

fn faults_of_a_page_are_found() {
    let good = Code::E0203.page();
    let faulty = [
        good.replace("# E0203", "# E0204"),
        good.replace("## Why", "## Wherefore"),
        good.replace("```mech", "```text"),
        good.replacen("```mech", "```mech\n```\n```mech", 1),
        good.replace("E0204", "E0299"),
        good.replace("E0204", &"word ".repeat(30)),
        good.trim_end().to_owned(),
    ];
    assert_eq!(faults_of_form(Code::E0203, good), [""; 0]);
    for text in faulty {
        assert!(!faults_of_form(Code::E0203, &text).is_empty(), "nothing is found in:\n{text}");
    }
}

fn no_page_is_without_a_code() {
    let pages: Vec<String> = files("crates/text/src/diag/explain", "md").iter().map(|path| stem(path)).collect();
    let mut codes: Vec<&str> = Code::ALL.iter().map(|code| code.as_str()).collect();
    codes.sort_unstable();
    assert_eq!(pages, codes);
}

fn has_the_severity_of_its_letter(code: Code) {
    let wanted = match code.as_str().as_bytes()[0] {
        b'E' => Severity::Error,
        b'W' => Severity::Warning,
        _ => Severity::Note,
    };
    assert_eq!(code.severity(), wanted);
}

fn every_code_is_raised_somewhere() {
    let sources: String = support::sources("rs")
        .iter()
        .filter(|path| !path.ends_with("diag/codes.rs"))
        .map(|path| fs::read_to_string(path).expect("a text"))
        .collect();
    for code in Code::ALL {
        // as the first argument of what makes a diagnostic, rather than compared with one
        assert!(sources.contains(&format!("Code::{code},")), "nothing raises {code}");
    }
}

/// Codes that a file alone cannot raise; the sessions in `tests/program/cli.rs` do.
const OF_THE_COMMAND_LINE: &[&str] = &[
    "E0102", "E0509", "E0611", "E0612", "W0502", "W0602", "E0701", "E0702", "E0703", "E0704", "E0705", "E0706",
    "E0613", "N0606", "E0707", "E0708", "W0701", "N0701", "N0702",
];

fn every_code_is_shown_by_a_test() {
    let snapshots: String =
        files("tests/ui", "snap").iter().map(|path| fs::read_to_string(path).expect("a text")).collect();
    let sessions: String = std::iter::once("tests/program/cli.rs".into())
        // the session of `explain` lists all codes, and shows none at work
        .chain(files("tests/cli", "trycmd").into_iter().filter(|path| stem(path) != "explain"))
        .map(|path| fs::read_to_string(path).expect("a text"))
        .collect();
    for code in Code::ALL {
        let code = code.as_str();
        let shown = if OF_THE_COMMAND_LINE.contains(&code) {
            sessions.contains(code)
        } else {
            snapshots.contains(&format!("[{code}]"))
        };
        assert!(shown, "no test shows {code}");
    }
}

fn is_printed_as_it_is(code: Code) {
    for name in [code.to_string(), code.as_str().to_lowercase()] {
        let mut mechc = assert_cmd::Command::new(env!("CARGO_BIN_EXE_mechc"));
        mechc.args(["explain", &name]).assert().success().stdout(code.page()).stderr("");
    }
}

/// The whole catalogue as a page of the documentation.
fn index() -> String {
    let mut text = "# All codes\n\n\
        Every message of `mechc` has a code, which never changes its meaning: `E` for an error, `W` for a warning, `N` for a \
        note.\nEach code has a page with an example that fails, the reason and the mend; `mechc explain E0203` prints \
        it.\n\n\
        The list is generated: `UPDATE_GOLDENS=1 cargo test --test listed` writes it.\n"
        .to_owned();
    for area in Code::ALL.chunk_by(|a, b| a.area() == b.area()) {
        let (first, rest) = area[0].area().split_at(1);
        text += &format!(
            "\n## {}{rest}\n\n| code | severity | what it means |\n| --- | --- | --- |\n",
            first.to_uppercase()
        );
        for code in area {
            let severity = match code.severity() {
                Severity::Error => "error",
                Severity::Warning => "warning",
                Severity::Note => "note",
            };
            text +=
                &format!("| [{code}](../crates/text/src/diag/explain/{code}.md) | {severity} | {} |\n", code.title());
        }
    }
    text
}

fn the_index_is_that_of_the_catalogue() {
    support::golden::holds("docs/codes.md", &index());
}

/// Lists the tests of this file.
pub fn list(tests: &mut Tests) {
    let codes = || Code::ALL.iter().map(|code| (code.to_string(), *code));
    tests.each("form", codes(), 70, has_its_form);
    tests.each("examples", codes(), 70, has_examples_that_raise_what_it_is_about_and_mended_they_raise_nothing);
    tests.each("severity", codes(), 70, has_the_severity_of_its_letter);
    tests.each("printed", codes(), 70, is_printed_as_it_is);
    tests.add("faults_of_a_page_are_found", faults_of_a_page_are_found);
    tests.add("no_page_is_without_a_code", no_page_is_without_a_code);
    tests.add("every_code_is_raised_somewhere", every_code_is_raised_somewhere);
    tests.add("every_code_is_shown_by_a_test", every_code_is_shown_by_a_test);
    tests.add("the_index_is_that_of_the_catalogue", the_index_is_that_of_the_catalogue);
}
