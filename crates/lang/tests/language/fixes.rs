//! Every change of a text that a diagnostic proposes mends what it speaks of and breaks nothing: each fix of every page's failing
//! example and of every small input is made alone, and the text is checked again.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support;
use crate::support::{Span, files, is_error, run_in, stem};
use mechc::{Applicability, Code, Diagnostic, Diagnostics, Fix, Parsed, Sources, fixed};
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

/// A text with the file it is in, or stands for.
struct Case {
    path: PathBuf,
    text: String,
}

/// All that is said of a text: of what cannot be read, of the rest of it, and of its motion if nothing is wrong with either.
fn messages(case: &Case) -> (Sources, Diagnostics) {
    let name = case.path.file_name().expect("a name").to_string_lossy().into_owned();
    let outcome = run_in(case.path.parent().expect("a folder"), &name, &case.text, Span::default());
    (outcome.sources, outcome.diagnostics)
}

/// How often an error of a code is said, by what tells it from others.
type Counts = BTreeMap<(Code, String), usize>;

fn counted<'d>(diagnostics: impl Iterator<Item = &'d Diagnostic>, what: impl Fn(&Diagnostic) -> String) -> Counts {
    let mut counts = Counts::new();
    for diagnostic in diagnostics {
        *counts.entry((diagnostic.code, what(diagnostic))).or_default() += 1;
    }
    counts
}

/// The line that a fault of the syntax is on.
fn line(diagnostic: &Diagnostic, sources: &Sources) -> String {
    let span = diagnostic.labels[0].span;
    let source = sources.get(span.file);
    let range = source.line_range(source.line_index(span.start as usize)).expect("a line");
    source.text[range].to_owned()
}

/// What cannot be seen before a declaration can be read, by the name of the file: `x` is a quantity there.
const HIDDEN: &[(&str, &str)] = &[("several_mistakes", "expected a number, found a function")];

/// What is wrong with a text after one of its fixes was made.
fn fault_of(
    case: &Case,
    (sources, before): (&Sources, &Diagnostics),
    mended: &Diagnostic,
    text: String,
) -> Option<String> {
    let mended_case = Case { path: case.path.clone(), text };
    let (sources_after, after) = messages(&mended_case);
    let own = (mended.code, mended.message.as_str());
    let times = |list: &Diagnostics| list.iter().filter(|one| (one.code, one.message.as_str()) == own).count();
    if times(&after) >= times(before) {
        return Some(format!("{own:?} is still said of:\n{}", mended_case.text));
    }
    let message = |one: &Diagnostic| one.message.clone();
    let (old, new) = (counted(before.iter(), message), counted(after.iter().filter(|one| is_error(one)), message));
    // what could stand before a fault of the syntax depends on what is read there, but it is still that fault
    let is_of_syntax = |one: &&Diagnostic| one.code == Code::E0101;
    let old_lines = counted(before.iter().filter(&is_of_syntax), |one| line(one, sources));
    let new_lines = counted(after.iter().filter(&is_of_syntax), |one| line(one, &sources_after));
    let is_more = |old: &Counts, what: &(Code, String), count: usize| count > old.get(what).copied().unwrap_or(0);
    let came = after.iter().filter(|one| is_error(one)).find(|one| {
        let (what, hidden) = ((one.code, message(one)), (stem(&case.path), one.message.as_str()));
        let is_new = is_more(&old, &what, new[&what]);
        let is_on_new_line = || {
            let what = (one.code, line(one, &sources_after));
            is_more(&old_lines, &what, new_lines[&what])
        };
        is_new && (!is_of_syntax(one) || is_on_new_line()) && !HIDDEN.contains(&(&hidden.0, hidden.1))
    })?;
    Some(format!("instead of {own:?}, {} {} is said of:\n{}", came.code, came.message, mended_case.text))
}

/// The faults of all fixes of a text, and how many fixes there are.
fn faults_of(case: &Case) -> (usize, Vec<String>) {
    let (sources, before) = messages(case);
    let (mut count, mut faults) = (0, Vec::new());
    let fixes: Vec<(&Diagnostic, &Fix)> =
        before.iter().flat_map(|found| found.fixes.iter().map(move |fix| (found, fix))).collect();
    for (mended, fix) in fixes {
        let file = fix.edits.first().expect("a change").span.file;
        // what stands in a table's own file is not of this text
        if sources.get(file).text != case.text.trim_start_matches('\u{feff}') {
            continue;
        }
        let (text, made) = fixed(&sources, file, [fix]);
        assert_eq!(made.len(), 1, "{}: the edits of `{}` overlap", case.path.display(), fix.message);
        count += 1;
        faults.extend(
            fault_of(case, (&sources, &before), mended, text)
                .map(|fault| format!("{}: `{}`: {fault}", case.path.display(), fix.message)),
        );
    }
    (count, faults)
}

/// The first block of a mechanism in a page: the example that fails.
fn failing_example(page: &str) -> Option<String> {
    let example = page.split("\n## ").find(|part| part.starts_with("An example that fails"))?;
    let (_, text) = example.split_once("```mech\n")?;
    Some(text.split_once("```")?.0.to_owned())
}

fn cases() -> Vec<Case> {
    let pages = Code::ALL.iter().filter_map(|code| {
        Some(Case {
            path: support::root().join("crates/text/src/diag/explain").join(format!("{code}.mech")),
            text: failing_example(code.page())?,
        })
    });
    let inputs = files("tests/ui", "mech")
        .into_iter()
        .map(|path| Case { text: fs::read_to_string(&path).expect("a text"), path });
    pages.chain(inputs).collect()
}

#[test]
fn fixes_apply_without_new_errors() {
    let (mut count, mut faults) = (0, Vec::new());
    for case in cases() {
        let (of_case, found) = faults_of(&case);
        count += of_case;
        faults.extend(found);
    }
    assert!(faults.is_empty(), "{} of {count}:\n{}", faults.len(), faults.join("\n\n"));
    assert!(count > LEAST, "only {count} fixes were made");
}

/// So many fixes are offered for the examples and inputs at least.
const LEAST: usize = 80;

/// A text after all changes that always apply, made until there are none.
fn mended(text: &str) -> String {
    let mut text = text.to_owned();
    for _ in 0..32 {
        let parsed = Parsed::new("text.mech", &text);
        let fixes = parsed.faults().iter().flat_map(|fault| &fault.fixes);
        let certain = fixes.filter(|fix| fix.applies == Applicability::Always);
        let (next, made) = fixed(parsed.sources(), parsed.file(), certain);
        if made.is_empty() {
            break;
        }
        text = next;
    }
    text
}

/// Declarations as they are typed, and as they are meant.
const MEANT: &[(&str, &str)] = &[
    ("param a = 3;", "param a = 3"),
    ("param a = 3;param b = 4;;", "param a = 3\nparam b = 4"),
    ("    param a = 3; param b = 4;", "    param a = 3\n    param b = 4"),
    ("body b { point P = (0, 0); point Q = (1, 0); }", "body b { point P = (0, 0) point Q = (1, 0) }"),
    ("param a = 2 ** 3", "param a = 2 ^ 3"),
    ("param a = 2**3 + 4**2", "param a = 2^3 + 4^2"),
    ("param a = 3 # mm", "param a = 3 // mm"),
    ("param a = 3 ## mm", "param a = 3 // mm"),
    ("param a = 3 /* mm */", "param a = 3 // mm"),
    ("/* one\n * two\n */\nparam a = 3", "// one\n// two\nparam a = 3"),
    ("/** one */\nparam a = 3", "/// one\nparam a = 3"),
    ("/**\n * one\n * two\n */\nparam a = 3", "/// one\n/// two\nparam a = 3"),
    ("# one\nparam a = 3", "// one\nparam a = 3"),
    ("param a = 5 − 3 − 1 // −", "param a = 5 - 3 - 1 // −"),
    ("param a = 2 × 3 ÷ 4 · 5", "param a = 2 * 3 / 4 * 5"),
    ("param a = 30° / 2", "param a = 30 deg / 2"),
    ("param a = 30 °", "param a = 30 deg"),
    ("param a = 5² + 2³", "param a = 5^2 + 2^3"),
    ("param a = +3 * +4", "param a = 3 * 4"),
    ("param a = 0,5 mm", "param a = 0.5 mm"),
    ("param a = 2. * 3", "param a = 2.0 * 3"),
    ("param a == 3", "param a = 3"),
    ("param a : 3", "param a = 3"),
    ("param a 3", "param a = 3"),
    ("param a = if 1 = 2 then 3 else 4", "param a = if 1 == 2 then 3 else 4"),
    ("driver d: rotation(j) == 2 * t", "driver d: rotation(j) = 2 * t"),
    ("param a: 3", "param a = 3"),
    ("param a:3", "param a = 3"),
    ("param a := 3", "param a = 3"),
    ("joint j := revolute(a.P, b.P)", "joint j: revolute(a.P, b.P)"),
    ("driver d := rotation(j) = 2 * t", "driver d: rotation(j) = 2 * t"),
    ("driver d rotation(j) = 2 * t", "driver d: rotation(j) = 2 * t"),
    ("measure a x(b.P)", "measure a = x(b.P)"),
    ("joint revolute j(a.P, b.P)", "joint j: revolute(a.P, b.P)"),
    ("joint j = revolute(a.P, b.P)", "joint j: revolute(a.P, b.P)"),
    ("joint j revolute{a.P, b.P}", "joint j: revolute(a.P, b.P)"),
    ("joint j: revolute[a.P, b.P]", "joint j: revolute(a.P, b.P)"),
    ("joint j: revolute(a.P; b.P)", "joint j: revolute(a.P, b.P)"),
    ("joint j: revolute(a.P, b.P", "joint j: revolute(a.P, b.P)"),
    ("table q = spline [(1, 2); (3, 4)]", "table q = spline [(1, 2), (3, 4)]"),
    ("table q = spline [(1, 2) (3, 4)]", "table q = spline [(1, 2), (3, 4)]"),
    ("table q = spline [(1, 2), (3, 4)", "table q = spline [(1, 2), (3, 4)]"),
    ("body b at (0, 0, 30 deg { point P = (0, 0) }", "body b at (0, 0, 30 deg) { point P = (0, 0) }"),
    ("body b {\n    point P = (0, 0) // here", "body b {\n    point P = (0, 0) // here\n}"),
];

/// Declarations of which it is not sure what is meant: nothing is changed.
const OPEN: &[&str] = &[
    "param a = 1,000 mm",
    "param a = 2 r",
    "param a = alpha°",
    "param a = sin(2 + 3",
    "param crank length = 3",
    "driver d: if t == 1 then 2 else 3",
    "param a = 3 /* mm */ + 2",
    "param a = 3 /* mm",
    "pram a = 3",
    // what is closed further on is closed
    "measure a = x(ground)",
    "measure a = angle(ground)",
    "measure a = distance(ground, (a, 0))",
    "joint j: revolute(ground, ground)",
    "joint j: revolute(\n    ground,\n    b.P\n)",
    "measure a = max(param, 3)",
    // what is called is no name
    "measure der(x(b.P)) / 1 mm",
    "measure abs(x(b.P))",
    "measure (x(b.P))",
    "joint revolute(a.P, b.P)",
    "joint hinge j(a.P, b.P)",
    "param crank length",
    "param f(3)",
    // one of the two is a decimal point
    "measure a = max(1,5; 2)",
    "measure a = max(1; max(1,5))",
    "measure a = poly(t; 0,5; 1, 2)",
    "body b { point P = (0,5; 1,5) }",
    "table q = spline [(0;0,5), (1;1,5)]",
    "table q = spline [(0;0,5); (1;1,5)]",
    "joint j: weld(a.P; b.P",
    // a name goes on
    "param a#b = 4",
    "param #1 = 4",
    "param a # b = 4",
    "param a–b = 3",
    "param a−b = 3",
];

#[test]
fn unambiguous_mistakes_are_fixed() {
    // whatever comes before and behind, and whatever the ends of lines
    for (before, behind) in
        [("", ""), ("param before = 1\n", "\nparam behind = 2"), ("// é\n", "\nanalysis from 0 to 1 every 1")]
    {
        for end in ["\n", "\r\n"] {
            let whole = |text: &str| format!("mechanism m {{\n{before}{text}{behind}\n}}\n").replace('\n', end);
            for (typed, meant) in MEANT {
                // the brace of a body is missed where a declaration follows
                if *meant == *typed || typed.starts_with("body b {\n") && behind.is_empty() {
                    continue;
                }
                assert_eq!(mended(&whole(typed)), whole(meant), "{typed}");
                assert_eq!(mended(&whole(meant)), whole(meant), "nothing is wrong with it");
            }
            for typed in OPEN {
                assert_eq!(mended(&whole(typed)), whole(typed), "it is not sure what is meant");
            }
        }
    }
}

/// Slips of the pen: what stands in a text, and what is typed instead.
const SLIPS: &[(&str, &str)] = &[
    (" = ", " == "),
    ("\n", ";\n"),
    ("^", "**"),
    ("//", "#"),
    (" * ", " × "),
    (" / ", " ÷ "),
    ("-", "−"),
    (" deg", "°"),
    (".", ","),
    (")\n", "\n"),
    (") ", " "),
    ("]", ""),
    (": ", " "),
    (" = ", " "),
    (", ", "; "),
    ("= ", "= +"),
    ("}\n", "\n"),
    ("revolute(", "revolute{"),
    ("0.", "0,"),
    (": revolute", " = revolute"),
    (" = ", " := "),
    (" = ", ": "),
    (": ", " := "),
    ("\n    ", "; "),
];

/// Longer texts hold nothing that the shorter ones do not (bytes).
const LONGEST: usize = 4_000;

/// A text but for its white space and comments.
fn without_blanks(text: &str) -> String {
    text.lines().filter_map(|line| line.split("//").next()).flat_map(str::split_whitespace).collect()
}

#[test]
fn typos_are_fixed_or_left() {
    let mut undone = vec![0; SLIPS.len()];
    let mut state = 1_u64;
    for path in files("examples", "mech").into_iter().chain(files("tests/cases", "mech")) {
        let text = fs::read_to_string(&path).expect("a text");
        let text = text.trim_start_matches('\u{feff}');
        if text.len() > LONGEST {
            continue;
        }
        for (k, (right, wrong)) in SLIPS.iter().enumerate() {
            let places: Vec<usize> = text.match_indices(right).map(|(at, _)| at).collect();
            if places.is_empty() {
                continue;
            }
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let at = places[(state >> 33) as usize % places.len()];
            let slipped = format!("{}{wrong}{}", &text[..at], &text[at + right.len()..]);
            let now = mended(&slipped);
            // what still has faults was left to its writer, and what needed no change was no slip
            if !Parsed::new("text.mech", &now).faults().is_empty() || now == slipped {
                continue;
            }
            assert_eq!(without_blanks(&now), without_blanks(text), "{}: `{right}` typed as `{wrong}`", path.display());
            undone[k] += 1;
        }
    }
    let never: Vec<&(&str, &str)> =
        SLIPS.iter().zip(&undone).filter(|(_, count)| **count == 0).map(|(slip, _)| slip).collect();
    assert!(never.len() <= 2, "never undone: {never:?}, of {undone:?}");
}

/// What a finger puts into a text.
const CHARACTERS: &[&str] = &[
    ";", "#", ",", "(", ")", "[", "]", "{", "}", "=", ":", ":=", "==", "**", "/*", "*/", "°", "²", "–", "+", ".", "\"",
    "ground", "\n",
];

/// A text with one place of it changed: a word left out, said twice or put in another's place, or a character put in.
fn damaged(text: &str, next: &mut impl FnMut(usize) -> usize) -> String {
    let is_start = |at: &usize| text.is_char_boundary(*at);
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let words: Vec<&str> = text.split(|c: char| !is_word(c)).filter(|word| !word.is_empty()).collect();
    let at = (0..=next(text.len())).rev().find(is_start).unwrap_or(0);
    let begin =
        text[..at].rfind(|c: char| !is_word(c)).map_or(0, |k| k + text[k..].chars().next().map_or(1, char::len_utf8));
    let end = text[at..].find(|c: char| !is_word(c)).map_or(text.len(), |k| at + k);
    let word = &text[begin..end];
    match next(8) {
        0 => format!("{}{}", &text[..begin], &text[end..]),
        1 => format!("{}{word} {word}{}", &text[..begin], &text[end..]),
        2 => format!("{}{}{}", &text[..begin], words[next(words.len())], &text[end..]),
        // a character gone
        3 => format!("{}{}", &text[..at], text[at..].chars().skip(1).collect::<String>()),
        4 => format!("{}{}{}", &text[..at], CHARACTERS[next(CHARACTERS.len())], &text[at..]),
        _ => {
            let (right, wrong) = SLIPS[next(SLIPS.len())];
            text[..at].to_owned() + &text[at..].replacen(right, wrong, 1)
        }
    }
}

/// What a certain fix made worse.
fn worse_by_a_fix(text: &str) -> Option<String> {
    let parsed = Parsed::new("text.mech", text);
    let place =
        |parsed: &Parsed, fault: &Diagnostic| parsed.sources().get(parsed.file()).position(fault.labels[0].span.start);
    for fault in parsed.faults().iter() {
        for fix in fault.fixes.iter().filter(|fix| fix.applies == Applicability::Always) {
            let (mended, made) = fixed(parsed.sources(), parsed.file(), [fix]);
            let after = Parsed::new("text.mech", &mended);
            let (before, now) = (parsed.faults().len(), after.faults().len());
            let is_same =
                |one: &&Diagnostic| one.message == fault.message && place(&after, one) == place(&parsed, fault);
            if now > before || made.len() != 1 {
                return Some(format!("`{}` of `{}` makes {before} faults {now}", fix.message, fault.message));
            }
            // what is behind it may be the same again
            if after.faults().iter().any(|one| is_same(&one)) && now == before && mended.len() >= text.len() {
                return Some(format!("`{}` leaves `{}`", fix.message, fault.message));
            }
        }
    }
    None
}

/// So many damaged texts are tried, and so many of them have a fix that always applies at least.
const DAMAGES: [usize; 2] = [3_000, 600];

#[test]
fn a_certain_fix_never_makes_a_damaged_text_worse() {
    let mut state = 1_u64;
    let mut next = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below.max(1)
    };
    let texts: Vec<String> = files("examples", "mech")
        .into_iter()
        .chain(files("tests/cases", "mech"))
        .map(|path| fs::read_to_string(path).expect("a text"))
        .filter(|text| text.len() <= LONGEST)
        .collect();
    let (mut mended, mut faults) = (0, Vec::new());
    for _ in 0..DAMAGES[0] {
        let mut text = texts[next(texts.len())].clone();
        for _ in 0..=next(2) {
            text = damaged(&text, &mut next);
        }
        let parsed = Parsed::new("text.mech", &text);
        let has_certain =
            parsed.faults().iter().any(|fault| fault.fixes.iter().any(|fix| fix.applies == Applicability::Always));
        mended += usize::from(has_certain);
        faults.extend(worse_by_a_fix(&text).map(|fault| format!("{fault}\n{text}")));
    }
    assert!(faults.is_empty(), "{} of {mended}:\n{}", faults.len(), faults[..faults.len().min(5)].join("\n\n"));
    assert!(mended >= DAMAGES[1], "only {mended} texts had a certain fix");
}

#[test]
fn certain_fixes_keep_comments() {
    for declaration in [
        "param a // the crank\n : 3 mm",
        "param a = abs(2) // note\n && 3",
        "measure q // note\n := 3",
        "constraint q // note\n = angle(b) = 3",
        "analysis from 0 s, // note\n to 1 s every 0.1 s",
        "analysis from 0 s to 1 s // note\n , every 0.1 s",
    ] {
        let text = format!(
            "mechanism m {{\n ground {{ point O = (0, 0) }}\n body b {{ point O = (0, 0) }}\n {declaration}\n}}\n"
        );
        let comment = declaration.split("//").nth(1).and_then(|text| text.lines().next()).expect("a comment");
        assert!(mended(&text).contains(&format!("//{comment}")), "{text}\n{}", mended(&text));
    }
}
