//! The words of the vocabulary, as each editor wants them written.

use super::holds;
use mechc_text::vocabulary::{
    CONSTANTS, FUNCTIONS, JOINTS, KEYWORDS, Keyword, NamedConstant, QUANTITIES, REDUCTIONS, Role, UNITS, declares_name,
};
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// The widest line of words.
const WIDTH: usize = 110;

fn keywords(wanted: impl Fn(&Keyword) -> bool) -> Vec<&'static str> {
    KEYWORDS.iter().filter(|keyword| wanted(keyword)).map(|keyword| keyword.word.name).collect()
}

fn with_role(role: Role) -> Vec<&'static str> {
    keywords(|keyword| keyword.role == role)
}

/// The words of a list by its name.
fn list(name: &str) -> Vec<&'static str> {
    match name {
        "reserved" => keywords(Keyword::is_reserved),
        "declarations" => keywords(Keyword::begins_declaration),
        "formula" => with_role(Role::Formula),
        "separators" => with_role(Role::Separator),
        "openers" => keywords(|keyword| keyword.role.is_opener() && declares_name(keyword.word.name)),
        // what opens a declaration without a name is told by what follows, as what stands between parts is
        "places" => keywords(|keyword| {
            let is_nameless = keyword.role.is_opener() && !declares_name(keyword.word.name);
            is_nameless || matches!(keyword.role, Role::Separator | Role::Place)
        }),
        "all_openers" => keywords(|keyword| keyword.role.is_opener()),
        "sides" => with_role(Role::Side),
        "joints" => JOINTS.iter().map(|joint| joint.word.name).collect(),
        "quantities" => QUANTITIES.iter().map(|quantity| quantity.word.name).collect(),
        "reductions" => REDUCTIONS.iter().map(|reduction| reduction.word.name).collect(),
        "functions" => FUNCTIONS.iter().map(|function| function.word.name).collect(),
        "motions" => FUNCTIONS.iter().filter(|one| one.is_motion()).map(|function| function.word.name).collect(),
        "constants" => {
            CONSTANTS.iter().filter(|one| one.stands_for != NamedConstant::Ground).map(|one| one.word.name).collect()
        }
        "units" => UNITS.iter().map(|unit| unit.word.name).collect(),
        "called" => {
            let all: BTreeSet<&str> = ["quantities", "reductions", "functions"].into_iter().flat_map(list).collect();
            all.into_iter().collect()
        }
        _ => panic!("no list is called {name}"),
    }
}

/// Words side by side, in lines that begin with an indent.
fn lines<'a>(words: impl IntoIterator<Item = &'a str>, between: &str, indent: &str) -> String {
    let mut text = indent.to_owned();
    let mut length = indent.len();
    let mut words = words.into_iter().peekable();
    while let Some(word) = words.next() {
        let end = if words.peek().is_some() { between } else { "" };
        if length > indent.len() && length + word.chars().count() + end.len() > WIDTH {
            text = format!("{}\n{indent}", text.trim_end());
            length = indent.len();
        }
        text += word;
        text += end;
        length += word.chars().count() + end.len();
    }
    text
}

fn quoted(words: &[&str], mark: char) -> Vec<String> {
    words.iter().map(|word| format!("{mark}{word}{mark}")).collect()
}

/// A text with the lists between its marks, `<words NAME>` to `</words>`, as `render` writes them.
fn filled(text: &str, render: impl Fn(&str) -> String) -> String {
    let mut made = String::new();
    let mut lines = text.lines();
    let mut marks = 0;
    while let Some(line) = lines.next() {
        made += &format!("{line}\n");
        let Some((_, name)) = line.split_once("<words ") else { continue };
        marks += 1;
        made += render(name.trim_end_matches('>')).trim_end();
        let end = lines.find(|line| line.contains("</words>")).expect("every list has its end");
        made += &format!("\n{end}\n");
    }
    assert!(marks > 0, "no list is marked");
    made
}

#[test]
fn tree_sitter_grammar() {
    holds("tree-sitter/grammar.js", |text| {
        filled(text, |name| {
            let words = quoted(&list(if name == "openers" { "all_openers" } else { name }), '\'');
            let lines = lines(words.iter().map(String::as_str), ", ", "  ");
            format!("const {} = [\n{lines},\n];", name.to_uppercase())
        })
    });
}

/// Where a word of a list stands, as a pattern of the tree.
fn pattern(list: &str) -> (&'static str, &'static str) {
    match list {
        "constants" => ("(reference) @constant.builtin", "@constant.builtin"),
        "units" => ("(reference) @type.builtin", "@type.builtin"),
        "joints" => ("(joint value: (call name: (identifier) @function.builtin))", "@function.builtin"),
        "sides" => ("(joint value: (call arguments: (arguments (reference) @constant.builtin)))", "@constant.builtin"),
        _ => ("(call name: (identifier) @function.builtin)", "@function.builtin"),
    }
}

#[test]
fn tree_sitter_highlights() {
    holds("tree-sitter/queries/highlights.scm", |text| {
        filled(text, |name| {
            let words = quoted(&list(name), '"');
            let lines = lines(words.iter().map(String::as_str), " ", "    ");
            let (pattern, capture) = pattern(name);
            format!("({pattern}\n  (#any-of? {capture}\n{lines}))")
        })
    });
}

#[test]
fn vim() {
    holds("vim/syntax/mech.vim", |text| {
        filled(text, |name| {
            let keywords = |group: &str| {
                // a word that stands between parts too is told by what is around it
                let words = list(name).into_iter().filter(|word| !list("places").contains(word));
                lines(words, " ", &format!("syntax keyword {group} "))
            };
            // a call is told by its parenthesis
            let calls = |group: &str| format!("syntax match {group} /\\v<%({})>\\ze\\s*\\(/", list(name).join("|"));
            match name {
                "declarations" => keywords("mechDeclaration"),
                "formula" => keywords("mechFormula"),
                "constants" => keywords("mechConstant"),
                "units" => keywords("mechUnit"),
                "called" => calls("mechFunction"),
                "joints" => calls("mechJoint"),
                "contextual" => contextual_in_vim(),
                _ => panic!("{name}"),
            }
        })
    });
}

/// What follows tells whether such a word is one or a name.
fn contextual_in_vim() -> String {
    let places = [list("openers"), list("places")].concat().join("|");
    let sides = list("sides").join("|");
    format!(
        "syntax match mechPlace /\\v<%({places})>\\ze\\s+[^-+*\\/^=<>: \\t]/\n\
         syntax match mechPlace /\\v[^=,(]\\s\\zsmirrored>\\ze\\s*$/\n\
         syntax match mechConstant /\\v,\\s*\\zs%({sides})>\\ze\\s*\\)/"
    )
}

#[test]
fn emacs() {
    holds("emacs/mech-mode.el", |text| {
        filled(text, |_| {
            let names =
                ["declarations", "formula", "openers", "places", "sides", "joints", "called", "constants", "units"];
            let definition = |name: &&str| {
                let words = quoted(&list(name), '"');
                let lines = lines(words.iter().map(String::as_str), " ", "    ");
                format!("(defconst mech-mode-{name}\n  '({})\n  \"Words of the language.\")\n", lines.trim_start())
            };
            names.iter().map(definition).collect()
        })
    });
}

/// The regular expression of a list in the grammar of VS Code.
fn in_text_mate(list_name: &str) -> String {
    let any = list(list_name).join("|");
    match list_name {
        // the ground is a body too, and has a rule of its own
        "declarations" => format!(r"(?<![\w.])(?!ground)(?:{any})(?!\w)"),
        "formula" => format!(r"(?<![\w.])(?:{any})(?!\w)"),
        "openers" => format!(r"(?<![\w.])({any})\s+([\p{{L}}_]\w*)(?=\s*[=:\[])"),
        "joints" => format!(r"(:)\s*({any})(?=\s*\()"),
        // as a name it stands before an operator or a bracket
        "separators" | "places" => {
            format!(r#"(?<![\w.])(?:{any})(?=\s+(?:[\w(.\["]|-\S))(?!\s+(?:{}|in)(?!\w))"#, list("formula").join("|"))
        }
        "sides" => format!(r"(,)\s*({any})(?=\s*\))"),
        "constants" | "units" => format!(r"(?<![\w.])(?:{any})(?!\w)(?!\s*[(=:])"),
        _ => format!(r"(?<![\w.])(?:{any})(?=\s*\()"),
    }
}

/// A number with its unit: `in` is none before another unit, in which something is printed.
fn numbers_in_text_mate() -> String {
    let units = list("units").join("|");
    let number = r"(?<!\w)((?:\d+(?:\.\d+)?|\.\d+)(?:[eE][+-]?\d+)?)";
    format!(r"{number}(?:\s*((?!in\s+(?:1\s*/|(?:{units})(?!\w)))(?:{units})(?!\w))(\^-?\d+)?)?")
}

#[test]
fn text_mate() {
    holds("vscode/syntaxes/mech.tmLanguage.json", |text| {
        let mut grammar: Value = serde_json::from_str(text).expect("JSON");
        let mut set = |place: &str, regex: String| {
            *grammar.pointer_mut(&format!("/repository/{place}/match")).expect(place) = json!(regex);
        };
        set("reserved/patterns/0", in_text_mate("declarations"));
        set("reserved/patterns/1", in_text_mate("formula"));
        set("numbers/patterns/0", numbers_in_text_mate());
        let of_their_own = ["openers", "joints", "places", "sides", "motions", "reductions", "quantities", "functions"];
        for name in of_their_own.into_iter().chain(["constants", "units"]) {
            set(&format!("{name}/patterns/0"), in_text_mate(name));
        }
        serde_json::to_string_pretty(&grammar).expect("JSON") + "\n"
    });
}

/// What the tests of the extension and of the editors look up: each word with a text that shows it.
#[test]
fn words_with_their_examples() {
    holds("test/words.json", |_| {
        let words: Vec<Value> = mechc::words()
            .map(|word| json!({ "name": word.name, "category": format!("{:?}", word.category), "example": word.example() }))
            .collect();
        serde_json::to_string_pretty(&words).expect("JSON") + "\n"
    });
}
