//! Several mistakes in one text: each is told, and none that is only the consequence of another one.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic)] // a test fails by panicking

use crate::support;
use mechc::{Choice, Memory, Parsed, Severity, words};
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// `(line, code)` of everything that is said of a text up to its check, whichever of its mechanisms it is said of.
fn reported(text: &str) -> Vec<(usize, &'static str)> {
    let parsed = Parsed::new("text.mech", text);
    let names: Vec<Option<String>> = parsed.mechanisms().map(|name| Some(name.to_owned())).collect();
    let mut places = BTreeSet::new();
    let mut list = Vec::new();
    for mechanism in if names.is_empty() { vec![None] } else { names } {
        let checked = parsed.check(&Choice { mechanism, ..Choice::default() }, &Memory::default());
        for diagnostic in checked.diagnostics().iter().filter(|d| d.severity() != Severity::Note) {
            let place = diagnostic.labels.first().map(|label| label.span);
            if places.insert((place, diagnostic.code.as_str(), diagnostic.message.clone())) {
                let line = place.map_or(0, |span| checked.sources().get(span.file).position(span.start).0);
                list.push((line, diagnostic.code.as_str()));
            }
        }
    }
    list.sort_unstable();
    list
}

/// `(line, code)` of every marker.
fn markers(text: &str) -> Vec<(usize, &str)> {
    let marked = text.lines().enumerate().filter_map(|(k, line)| Some((k + 1, line.split_once("//~ ")?.1)));
    let mut list: Vec<(usize, &str)> =
        marked.flat_map(|(line, codes)| codes.split_whitespace().map(move |code| (line, code))).collect();
    list.sort_unstable();
    list
}

fn check(text: &str) {
    assert_eq!(reported(text), markers(text), "{text}");
}

#[test]
fn four_mistakes_of_four_kinds_are_four_diagnostics() {
    let with = |driven: &str| {
        format!(
            "mechanism four_bar {{
    ground {{ point A = (0, 0) point D = (300 mm, 0) }}
    body crank at (0, 0, 60 deg) {{ point A = (0, 0) point B = (100 mm, 0) }}
    body rod at (50 mm, 87 mm, 0 deg) {{ point B = (0, 0) point C = (250 mm, 0) }}
    body rocker at (300 mm, 0, 90 deg) {{ point D = (0, 0) point C = (150 mm, 0) }}
    joint main: revolute(ground.A, crank.A)
    joint elbow: revolute(crank.B rod.B) //~ E0101
    joint wrist: revolute(rod.E, rocker.C) //~ E0201
    joint rest: revolute(ground.D, rocker.D)
    driver motor: rotation({driven}) = 600 mm * t //~ E0402
    measure way = x(rocket.C) //~ E0201
    analysis from 0 s to 1 s every 0.1 s
}}
"
        )
    };
    // of a joint that is broken it is known all the same that its rotation is an angle
    for broken in ["elbow", "wrist"] {
        check(&with(broken));
    }
    check(&with("main").replace("E0402", "E0401"));
}

#[test]
fn reserved_names_are_reported_once() {
    for (word, code) in [("pi", "E0204"), ("tau", "E0204"), ("driver", "E0101"), ("table", "E0101"), ("else", "E0101")]
    {
        check(&format!(
            "mechanism press {{
    param speed = 10 mm/s
    ground {{ point O = (0, 0) axis way = O along (1, 0) }}
    body {word} at (0, 0, 0 deg) {{ point O = (0, 0) axis way = O along (1, 0) }} //~ {code}
    joint guide: translational({word}.way, ground.way)
    driver feed: displacement(guide) = speed * t
    measure place = x({word}.O)
    analysis from 0 s to 1 s every 0.1 s
}}
"
        ));
        check(&format!(
            "mechanism press {{
    param {word} = 30 //~ {code}
    param twice = 2 * {word}
    ground {{ point O = (0, 0) axis way = O along (1, 0) }}
    body slide at ({word}, 0, 0) {{ point O = (0, 0) axis way = (twice, {word}) along (1, 0) }}
    joint guide: translational(slide.way, ground.way)
    driver feed: displacement(guide) = {word} * t
    measure place = x(slide.O) + {word}
    analysis from 0 s to 1 s every 0.1 s
}}
"
        ));
        check(&format!(
            "mechanism crank {{
    ground {{ point O = (0, 0) }}
    body arm {{ point O = (0, 0) }}
    joint {word}: revolute(ground.O, arm.O) //~ {code}
    driver motor: rotation({word}) = 2 rad/s * t
    measure turned = der(rotation({word}))
    analysis from 0 s to 1 s every 0.1 s
}}
"
        ));
    }
    for word in ["t", "pi", "sin", "x"] {
        check(&format!(
            "mechanism crank {{
    fn {word}(u) = 3 * u //~ E0204
    ground {{ point O = (0, 0) }}
    body arm at (0, 0, {word}(2)) {{ point O = (0, 0) }}
    joint pin: revolute(ground.O, arm.O)
    driver motor: rotation(pin) = {word}(0.3)
    analysis from 0 s to 1 s every 0.1 s
}}
"
        ));
    }
}

#[test]
fn a_bad_name_hides_no_other_mistake() {
    check(
        "mechanism crank {
    param driver = 3 //~ E0101
    ground { point O = (0, 0) }
    body arm { point O = (0, 0) }
    joint pin: revolute(ground.O arm.O) //~ E0101
    driver 5: rotation(pin) = 3 * t //~ E0101
    param q =
    driver motor: rotation(pin) = 3 * t //~ E0101
}
",
    );
}

// ---- pairs of mistakes

fn is_word_part(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The words of a text without its comments.
fn words_of(text: &str) -> Vec<&str> {
    let code = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    code.flat_map(|line| line.split(|c| !is_word_part(c))).filter(|word| !word.is_empty()).collect()
}

/// The words of the language.
fn vocabulary() -> BTreeSet<&'static str> {
    words().map(|word| word.name).collect()
}

/// A mechanism with mistakes, and what its text is made of.
#[derive(Clone)]
struct Mistaken {
    name: String,
    /// The names of its own.
    declared: BTreeSet<String>,
    /// Words that it uses and does not declare.
    others: BTreeSet<String>,
    /// Its declarations without its ground and analysis.
    items: String,
    /// What stands in the ground's braces, with the rest of the line behind them.
    ground: (String, String),
    analysis: String,
}

/// Names behind the keyword of a declaration, and the arguments of functions and curves.
fn declared_in(text: &str) -> BTreeSet<String> {
    let keywords = [
        "param",
        "fn",
        "table",
        "body",
        "joint",
        "driver",
        "constraint",
        "measure",
        "point",
        "axis",
        "circle",
        "curve",
    ];
    let mut names = BTreeSet::new();
    let words = words_of(text);
    for (k, word) in words.iter().enumerate().filter(|(_, word)| keywords.contains(word)) {
        names.extend(words.get(k + 1).map(|name| (*name).to_owned()));
        if ["fn", "curve"].contains(word) {
            names.extend(words.get(k + 2).map(|name| (*name).to_owned()));
        }
    }
    names.into_iter().filter(|name| !name.starts_with(|c: char| c.is_ascii_digit())).collect()
}

impl Mistaken {
    /// A text of one mechanism whose braces are all there, taken apart.
    fn of(text: &str) -> Option<Mistaken> {
        let lines: Vec<&str> = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
        let (first, rest) = lines.split_first()?;
        let name = first.strip_prefix("mechanism ")?.strip_suffix(" {")?.to_owned();
        let (last, inside) = rest.split_last()?;
        // words are told apart as ASCII has them here
        if *last != "}" || !text.is_ascii() {
            return None;
        }
        let is_ground = |line: &&&str| line.trim_start().starts_with("ground");
        let is_analysis = |line: &&&str| line.trim_start().starts_with("analysis");
        let [ground] = inside.iter().filter(is_ground).collect::<Vec<_>>()[..] else { return None };
        let (features, behind) = ground.trim().strip_prefix("ground {")?.split_once('}')?;
        let mut analyses = inside.iter().filter(is_analysis);
        let analysis = analyses.next().copied().unwrap_or_default().to_owned();
        if analyses.next().is_some() {
            return None;
        }
        let mut items = String::new();
        for line in inside.iter().filter(|line| !is_ground(line) && !is_analysis(line)) {
            writeln!(items, "{line}").unwrap();
        }
        let code = items.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<String>();
        if code.matches('{').count() != code.matches('}').count() {
            return None;
        }
        let declared = declared_in(text);
        let others = words_of(text).into_iter().map(str::to_owned).filter(|word| !declared.contains(word)).collect();
        Some(Mistaken { name, declared, others, items, ground: (features.to_owned(), behind.to_owned()), analysis })
    }

    /// The same with other names of its own.
    fn renamed(&self) -> Mistaken {
        let taken = vocabulary();
        let rename = |text: &str| {
            let mut out = String::new();
            let mut rest = text;
            while let Some(c) = rest.chars().next() {
                let length =
                    if is_word_part(c) { rest.find(|c| !is_word_part(c)).unwrap_or(rest.len()) } else { c.len_utf8() };
                let (word, behind) = rest.split_at(length);
                out += word;
                if self.declared.contains(word) && !taken.contains(word) {
                    out += "_2";
                }
                rest = behind;
            }
            out
        };
        Mistaken {
            name: format!("{}_2", self.name),
            declared: self.declared.iter().map(|name| rename(name)).collect(),
            others: self.others.clone(),
            items: rename(&self.items),
            ground: (rename(&self.ground.0), rename(&self.ground.1)),
            analysis: rename(&self.analysis),
        }
    }

    fn text(&self) -> String {
        let (features, behind) = &self.ground;
        format!("mechanism {} {{\nground {{{features}}}{behind}\n{}{}\n}}\n", self.name, self.items, self.analysis)
    }

    /// One mechanism with the declarations of both, if they do not meddle with each other.
    fn with(&self, other: &Mistaken) -> Option<Mistaken> {
        let is_apart = self.declared.is_disjoint(&other.declared)
            && self.declared.is_disjoint(&other.others)
            && self.others.is_disjoint(&other.declared);
        let grounds = match (self.ground.1.trim(), other.ground.1.trim()) {
            (behind, "") | ("", behind) => (format!("{}{}", self.ground.0, other.ground.0), format!(" {behind}")),
            _ => return None,
        };
        let analysis = match (self.analysis.contains("//~"), other.analysis.contains("//~")) {
            (true, true) => return None,
            (false, true) => &other.analysis,
            _ => &self.analysis,
        };
        is_apart.then(|| Mistaken {
            name: self.name.clone(),
            declared: self.declared.union(&other.declared).cloned().collect(),
            others: self.others.union(&other.others).cloned().collect(),
            // a misspelt keyword spoils the declaration before it too, which shall have no mistake of its own
            items: format!("{}    param between_both = 1\n{}", self.items, other.items),
            ground: grounds,
            analysis: analysis.clone(),
        })
    }
}

/// Whether a declaration has no name: what is not declared elsewhere may be what it would have declared, and is not told.
fn has_nameless(text: &str) -> bool {
    let is_named = ["mechanism", "param", "fn", "table", "body", "joint", "driver", "constraint", "measure"];
    text.lines().any(|line| {
        let line = line.trim_start();
        let keyword = is_named.iter().find(|word| line.starts_with(**word));
        let behind = keyword.map_or("", |word| &line[word.len()..]);
        keyword.is_some()
            && !behind.starts_with(is_word_part)
            && !behind.trim_start().starts_with(|c: char| c.is_alphabetic() || c == '_')
    })
}

/// Every input of the tests of single mistakes that can be put beside another one.
fn inputs() -> Vec<Mistaken> {
    let root = support::root().join("tests/ui");
    let mut list = Vec::new();
    for folder in ["syntax", "names", "kinds", "values", "elements", "synonyms"] {
        let mut paths: Vec<_> =
            std::fs::read_dir(root.join(folder)).unwrap().map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        for path in paths.into_iter().filter(|path| path.extension().is_some_and(|ending| ending == "mech")) {
            let input = Mistaken::of(&std::fs::read_to_string(&path).unwrap());
            // what is told of a whole mechanism, or later, is not that of a declaration; and in what is nested too deep nothing
            // is read, a misspelt keyword behind it neither
            list.extend(input.filter(|input| {
                let text = input.text();
                let markers = markers(&text);
                !markers.is_empty()
                    && markers.iter().all(|(_, code)| !code.contains('5') && !["E0103", "W0402"].contains(code))
                    && !has_nameless(&text)
                    && reported(&text) == markers
            }));
        }
    }
    list
}

/// How many pairs are tried.
const PAIRS: usize = 300;

/// The next number of a sequence that looks random.
fn next(state: &mut u64) -> usize {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 33) as usize
}

#[test]
fn two_mistakes_give_two_reports() {
    let inputs = inputs();
    assert!(inputs.len() > 100, "only {} inputs", inputs.len());
    let renamed: Vec<Mistaken> = inputs.iter().map(Mistaken::renamed).collect();
    let (mut state, mut together) = (7, 0);
    let mut failed = Vec::new();
    let mut check = |text: &str| {
        let marked = markers(text);
        // in metres beside lengths in millimetres, a text without units looks as if it had lost them
        let is_of_the_pair = |one: &(usize, &str)| one.1 == "W0402" && !marked.contains(one);
        if !reported(text).into_iter().filter(|one| !is_of_the_pair(one)).eq(marked.iter().copied()) {
            failed.push(format!("{text}\ntold   {:?}\nwanted {:?}", reported(text), markers(text)));
        }
    };
    for _ in 0..PAIRS {
        let (a, b) = (next(&mut state) % inputs.len(), next(&mut state) % inputs.len());
        check(&format!("{}{}", inputs[a].text(), renamed[b].text()));
        // a name that is unknown is told once, and so it is where an input stands beside itself
        if let Some(both) = inputs[a].with(&renamed[b]).filter(|_| a != b) {
            together += 1;
            check(&both.text());
        }
    }
    assert!(together > PAIRS / 3, "only {together} pairs were put into one mechanism");
    assert!(
        failed.is_empty(),
        "{} of {} pairs, the first:\n{}",
        failed.len(),
        together + PAIRS,
        failed[..failed.len().min(6)].join("\n\n")
    );
}
