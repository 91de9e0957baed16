//! Formatting changes no token but spaces and a comma behind the last item of a list, loses no comment, and changes nothing when it is
//! done twice. The project's own texts are formatted.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support;

use crate::support::blocks::blocks;
use crate::support::files;
use crate::support::random::Random;
use crate::support::shape::file_shape;
use mechc::{Edit, Parsed, Sources, Span};
use mechc_syntax::parse;
use proptest::prelude::*;
use std::fs;
use std::path::PathBuf;

/// A text without its white space and the commas behind last items; and its comments.
fn essence(text: &str) -> (String, Vec<String>) {
    let parsed = Parsed::new("text", text);
    let (mut rest, mut at, mut comments) = (String::new(), 0, Vec::new());
    for comment in &parsed.trivia().comments {
        rest += &text[at..comment.span.start as usize];
        comments.push(parsed.sources().text(comment.span).to_owned());
        at = comment.span.end as usize;
    }
    rest += &text[at..];
    rest.retain(|c| !c.is_whitespace());
    (rest.replace(",)", ")").replace(",]", "]"), comments)
}

fn shape_of(text: &str) -> String {
    let mut sources = Sources::default();
    let file = sources.add("text", text);
    format!("{:?}", file_shape(&parse(&sources, file).tree))
}

/// A text with edits made, which are in order and do not overlap.
fn edited(text: &str, edits: &[Edit]) -> String {
    let (mut out, mut at) = (String::new(), 0);
    for Edit { span, text: new } in edits {
        assert!(at <= span.start as usize && span.start <= span.end, "{edits:?}");
        assert_ne!(&text[span.start as usize..span.end as usize], new, "nothing changes");
        out += &text[at..span.start as usize];
        out += new;
        at = span.end as usize;
    }
    out + &text[at..]
}

/// The text formatted, if it follows the grammar, after a check of all that holds of every text.
fn formatted(text: &str) -> Option<String> {
    let parsed = Parsed::new("text", text);
    let once = parsed.formatted()?;
    assert_eq!(edited(text, &parsed.formatting()), once, "by edits, of\n{text}");
    assert_eq!(essence(&once), essence(text), "{text}\n{once}");
    assert_eq!(shape_of(&once), shape_of(text), "{text}\n{once}");
    let again = Parsed::new("text", &once);
    assert!(again.faults().is_empty(), "{text}\n{once}");
    let twice = again.formatted().expect("it has no faults");
    let unlike = twice.lines().zip(once.lines()).find(|(a, b)| a != b);
    assert!(twice == once, "formatted twice, the second becomes the first of {unlike:?}, from\n{text}");
    assert!(again.formatting().is_empty());
    let has_no_ends = |line: &str| line.trim_end() == line && !line.contains('\t');
    assert!(once.lines().all(|line| has_no_ends(line) || line.contains("//")), "{once}");
    assert!(!once.contains("\n\n\n") && !once.starts_with('\n') && !once.ends_with("\n\n"), "{once}");
    Some(once)
}

#[track_caller]
fn becomes(text: &str, wanted: &str) {
    assert_eq!(formatted(text).as_deref(), Some(wanted));
}

#[track_caller]
fn stays(text: &str) {
    becomes(text, text);
}

/// All texts at hand, with their names.
fn texts() -> Vec<(String, String)> {
    let mut texts = Vec::new();
    for folder in ["examples", "tests", "benches", "crates/engine/tests"] {
        for path in files(folder, "mech") {
            // some are no text, on purpose
            if let Ok(text) = fs::read_to_string(&path) {
                let text = text.trim_start_matches('\u{feff}').to_owned();
                texts.push((path.display().to_string(), text));
            }
        }
    }
    texts.extend(documentation());
    texts
}

/// The mechanisms of all pages.
fn documentation() -> Vec<(String, String)> {
    let mut pages = vec![support::root().join("README.md")];
    pages.extend(files("docs", "md"));
    pages.extend(support::sources("md"));
    // packages of others have pages too
    let is_own = |page: &PathBuf| page.components().all(|part| part.as_os_str() != "node_modules");
    pages.extend(files("editors", "md").into_iter().filter(is_own));
    let page = |path: PathBuf| (path.display().to_string(), fs::read_to_string(&path).expect("a page"));
    let mech = |(path, page): (String, String)| {
        let blocks = blocks(&page).into_iter().filter(|(language, _)| language == "mech");
        blocks.map(move |(_, block)| (path.clone(), block)).collect::<Vec<_>>()
    };
    pages.into_iter().map(page).flat_map(mech).collect()
}

// ---- the project's own texts

#[test]
fn formatting_loses_no_text() {
    let whole = texts().iter().filter(|(_, text)| formatted(text).is_some()).count();
    assert!(whole > 400, "only {whole} texts follow the grammar");
}

#[test]
fn examples_cases_and_documentation_are_formatted() {
    let mut own: Vec<(String, String)> = documentation();
    let folders = ["examples/", "tests/cases/", "tests/cases_composed/"];
    own.extend(texts().into_iter().filter(|(name, _)| folders.iter().any(|folder| name.contains(folder))));
    let (mut looked_at, mut unlike) = (0, Vec::new());
    for (name, text) in own {
        let Some(formatted) = Parsed::new(&name, &text).formatted() else { continue };
        looked_at += 1;
        if formatted != text {
            unlike.push(name);
        }
    }
    assert!(looked_at > 200, "only {looked_at} texts");
    assert!(unlike.is_empty(), "not formatted:\n{}", unlike.join("\n"));
}

// ---- texts that nobody wrote

#[test]
fn comments_before_dropped_commas_stay() {
    becomes(
        "mechanism m {\n    param a = max(1, 2 // c\n    , )\n}\n",
        "mechanism m {\n    param a = max(1, 2   // c\n        )\n}\n",
    );
}

/// Behind a comma a bracket that stands apart from `from` begins a time, and one that does not is that of a call.
#[test]
fn windows_have_one_space_between_their_words() {
    becomes(
        "mechanism m {\n    result a = max(  x(b.P) ,from 1 s   to(2 s),)\n    result c = max(y,from  (1 s)) - max(y, from(2), to -from)\n}\n",
        "mechanism m {\n    result a = max(x(b.P), from 1 s to (2 s))\n    result c = max(y, from (1 s)) - max(y, from(2), to - from)\n}\n",
    );
}

/// What may stand between two tokens instead of a space, or of nothing.
const BETWEEN: [&str; 9] =
    ["", " ", "  ", "\n", "\n\n\n", "\t", " \r\n ", " // a comment\n", "\n  // ein Wort: größer 🙂\n"];

/// A text with other white space, and more comments, beside some brackets, commas and spaces.
fn respaced(text: &str, seed: u64) -> String {
    let mut random = Random::new(seed);
    let comments = Parsed::new("text", text).trivia().comments.clone();
    let is_comment = |at: usize| comments.iter().any(|c| (c.span.start as usize..=c.span.end as usize).contains(&at));
    let (mut out, mut is_quoted) = (String::new(), false);
    for (at, c) in text.char_indices() {
        is_quoted ^= c == '"' && !is_comment(at);
        let is_free = !is_quoted && !is_comment(at);
        let rate = 4 + (seed % 40) as usize;
        if is_free && random.below(rate) == 0 && "(){}[], \n".contains(c) {
            let between = BETWEEN[random.below(BETWEEN.len())];
            match c {
                ' ' | '\n' if between.is_empty() => out.push(c),
                ' ' | '\n' => out += between,
                _ if random.below(2) == 0 => out += &format!("{between}{c}"),
                _ => out += &format!("{c}{between}"),
            }
        } else {
            out.push(c);
        }
    }
    out
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 250, max_shrink_iters: 0, max_global_rejects: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn formatting_loses_no_perturbed_text(seed in any::<u64>()) {
        let texts = [
            include_str!("../../../../tests/format/everything.mech"),
            include_str!("../../../../tests/stages/everything/input.mech"),
            include_str!("../../../../examples/table_driven.mech"),
            include_str!("../../../../examples/engine.mech"),
            include_str!("../../../../examples/film_claw.mech"),
            include_str!("../../../../tests/cases/unicode.mech"),
        ];
        let text = respaced(texts[(seed % 6) as usize].trim_start_matches('\u{feff}'), seed / 6);
        // no comment can stand within `in 1 / mm`
        prop_assume!(formatted(&text).is_some());
    }
}

/// A text with a stretch taken out, said twice, or replaced by a sign.
fn damaged(text: &str, random: &mut Random) -> String {
    let places: Vec<usize> = text.char_indices().map(|(at, _)| at).collect();
    let from = random.below(places.len());
    let to = (from + 1 + random.below(12)).min(places.len() - 1);
    let (before, gone, behind) = (&text[..places[from]], &text[places[from]..places[to]], &text[places[to]..]);
    match random.below(4) {
        0 => format!("{before}{behind}"),
        1 => format!("{before}{gone}{gone}{behind}"),
        _ => format!("{before}{}{behind}", ["{", "}", "(", ")", "\"", "joint", "=", "// "][random.below(8)]),
    }
}

#[test]
fn damaged_pieces_stay_unformatted() {
    let texts = texts();
    let (mut random, mut refused) = (Random::new(7), 0);
    for _ in 0..600 {
        let (_, text) = &texts[random.below(texts.len())];
        if !(20..6_000).contains(&text.len()) {
            continue;
        }
        let text = damaged(text, &mut random);
        let parsed = Parsed::new("text", &text);
        let partly = edited(&text, &parsed.formatting());
        assert_eq!(essence(&partly), essence(&text), "{text}\n{partly}");
        if parsed.faults().is_empty() {
            formatted(&text);
            continue;
        }
        assert_eq!(parsed.formatted(), None, "{text}");
        refused += 1;
    }
    assert!(refused > 300, "only {refused} texts were broken");
}

// ---- how it looks

#[test]
fn comments_keep_their_position() {
    stays(
        "// the file
/// the mechanism
mechanism arm {   // its head
    // above r

    /// documents r
    param r    = 30 mm +   // within
        2 mm   // behind r
    param long = 1 mm   // behind long

    ground {
        point O = (0, 0)   // behind O
        // at the end of the ground
    }   // behind the ground
    body b {
        // nothing yet
    }

    // at the end
}   // behind the mechanism

// behind all
",
    );
}

#[test]
fn columns_are_of_neighbours_of_one_kind() {
    becomes(
        "mechanism m{param a=1 mm param länge=a*2 // of a
  param 长=-a^2
fn f(u)=u

  fn longer(u)=f( u )
joint j:revolute(ground.O,b.O) joint long[k in 0 .. 2] : weld ( ground.O , b.P[k],)
driver d:angle(b)=30 deg / s*t
measure w=x(b.O)in mm / s ^ 2 trace wide=b.O}",
        "mechanism m {
    param a     = 1 mm
    param länge = a * 2   // of a
    param 长    = -a^2
    fn f(u) = u

    fn longer(u) = f(u)
    joint j:               revolute(ground.O, b.O)
    joint long[k in 0..2]: weld(ground.O, b.P[k])
    driver d: angle(b) = 30 deg/s * t
    measure w    = x(b.O) in mm/s^2
    trace   wide = b.O
}
",
    );
}

#[test]
fn a_body_stays_on_one_line_if_it_fits() {
    stays(
        "mechanism m {
    ground { point O = (0, 0)  axis way = O along (0, 1) }
    body a    at (0, 0, 1)   { point O = (0, 0)  point P }
    body long at (1 m, 0, 0) { point P = (0, 0) }

    body b {}
}
",
    );
    becomes(
        "mechanism m { body b { }\nbody c {\npoint P }\nbody d { point A = (123456789012 mm, 123456789012 mm) point B = (123456789012 mm, 123456789012 mm) } }",
        "mechanism m {
    body b {}
    body c {
        point P
    }
    body d {
        point A = (123456789012 mm, 123456789012 mm)
        point B = (123456789012 mm, 123456789012 mm)
    }
}
",
    );
}

#[test]
fn long_formulas_are_broken_behind_operators() {
    becomes(
        "mechanism m {
    measure a = first_of_all(one, two, three) * second_of_them(four, five) + third_of_all * fourth_of_all_that_are
    measure b = greatest_of_them(first_of_all(one, two), second_of_them(four, five), third_of_all, fourth_of_all)
    fn law(u) = if u < 1 s then 2 * u^2 / 1 s else if u < 2 s then 3 * u - 1 s else 2 * u + 10 s - 4 * (u - 2 s)
    table t = spline [(0 s, 0 mm), (1 s, 10 mm), (2 s, 20 mm), (3 s, 30 mm), (4 s, 40 mm), (5 s, 50 mm)]
    part p: mechanism_of_others(one = 123456 mm, two = 123456 mm, three = 123456 mm, four = 123456 mm) on b at (0, 0, 0)
}",
        "mechanism m {
    measure a = first_of_all(one, two, three) * second_of_them(four, five) +
        third_of_all * fourth_of_all_that_are
    measure b = greatest_of_them(first_of_all(one, two), second_of_them(four, five), third_of_all,
        fourth_of_all)
    fn law(u) = if u < 1 s then 2 * u^2 / 1 s
        else if u < 2 s then 3 * u - 1 s
        else 2 * u + 10 s - 4 * (u - 2 s)
    table t = spline [
        (0 s, 0 mm),
        (1 s, 10 mm),
        (2 s, 20 mm),
        (3 s, 30 mm),
        (4 s, 40 mm),
        (5 s, 50 mm),
    ]
    part p: mechanism_of_others(
        one = 123456 mm,
        two = 123456 mm,
        three = 123456 mm,
        four = 123456 mm,
    ) on b at (0, 0, 0)
}
",
    );
}

/// What looks like something else to a reader, or would be something else to the parser.
#[test]
fn significant_spaces_are_kept() {
    let formula = |text: &str| {
        let text = format!("mechanism m {{\n    param h = 3\n    measure a = {text}\n}}\n");
        let formatted = formatted(&text).unwrap_or_else(|| panic!("{text}"));
        formatted.split_once("measure a = ").expect("a formula").1.trim_end_matches("\n}\n").to_owned()
    };
    for (text, wanted) in [
        ("50 mm^-1", "50 mm^-1"),
        ("((a))*- -b", "((a)) * --b"),
        ("30deg / s*t", "30 deg/s * t"),
        ("9.81m/ s^2/ kg", "9.81 m/s^2/kg"),
        ("9.81m/ s^2/ gauge", "9.81 m/s^2 / gauge"),
        ("a/30 deg/s", "a / 30 deg / s"),
        ("30 deg/h", "30 deg / h"),
        ("(30 deg)/s", "(30 deg) / s"),
        ("2 in/3 in in in", "2 in / 3 in in in"),
        ("5 in in 1 /mm", "5 in in 1/mm"),
        ("not(a)and a<=b", "not (a) and a <= b"),
        ("f ( a ,(b , ) , )", "f(a, (b))"),
        ("2^ -x^2", "2^-x^2"),
        ("1E+3+.5", "1E+3 + .5"),
    ] {
        assert_eq!(formula(text), wanted);
    }
}

#[test]
fn line_ends_follow_the_first_line() {
    becomes("mechanism m {\r\nparam a=1 // c\n}\n", "mechanism m {\r\n    param a = 1   // c\r\n}\r\n");
    becomes("mechanism m {\nparam a=1\r\n}", "mechanism m {\n    param a = 1\n}\n");
}

// ---- parts of a text

/// The text with the edits made that `of` gives.
fn with_edits(text: &str, of: impl Fn(&Parsed) -> Vec<Edit>) -> String {
    edited(text, &of(&Parsed::new("text", text)))
}

#[test]
fn intact_pieces_of_broken_texts_are_formatted() {
    let text = "mechanism m {
  param a=1
  param   broken = 3 +
  param long=2
joint j revolute( ground.O ,b.O )
  body b at (0 {
point P=(0,0)
    }
body c {
point  Q=(0,0)
axis  = Q
} }
";
    let wanted = "mechanism m {
    param a = 1
  param   broken = 3 +
    param long = 2
joint j revolute( ground.O ,b.O )
  body b at (0 {
        point P = (0, 0)
    }
    body c {
        point Q = (0, 0)
axis  = Q
    }
}
";
    assert_eq!(with_edits(text, Parsed::formatting), wanted);
    assert_eq!(with_edits(wanted, Parsed::formatting), wanted);
}

#[test]
fn lines_of_a_text_are_formatted_alone() {
    let text = "mechanism m {\nparam a=1\nparam long=2\nbody b{point P=(0,0)\n}\nbody c{point Q=(0,0)\n}\n}\n";
    let at = |part: &str| text.find(part).expect("a part") as u32;
    let in_span = |start: u32, end: u32| {
        with_edits(text, |parsed| parsed.formatting_in(Span { start, end, ..parsed.sources().end_of(parsed.file()) }))
    };
    let first = text.replace("param a=1", "    param a    = 1");
    assert_eq!(in_span(at("a=1"), at("a=1") + 1), first);
    let next = at("param long");
    assert_eq!(in_span(at("param a=1"), next), first, "a whole line was chosen, up to where the next one begins");
    assert_eq!(in_span(next, next), text.replace("param long=2", "    param long = 2"), "a cursor where a line begins");
    let block = text.replace("body b{point P=(0,0)\n}", "    body b {\n        point P = (0, 0)\n    }");
    let brace = at("}\nbody c") + 1;
    assert_eq!(with_edits(text, |parsed| parsed.formatting_at_brace(brace)), block);
    assert_eq!(with_edits(text, |parsed| parsed.formatting_at_brace(brace - 1)), text, "there is no brace");
    let all = Parsed::new("text", text).formatted().expect("it follows the grammar");
    assert_eq!(with_edits(text, |parsed| parsed.formatting_at_brace(text.len() as u32 - 1)), all);
}

/// A cursor stays where it is if nothing around it changes.
#[test]
fn edits_are_small() {
    let text = "mechanism m {\n    param a = 1\n\n\n    param b =2\n}\n";
    let edits = Parsed::new("text", text).formatting();
    let small: Vec<(u32, u32, &str)> = edits.iter().map(|e| (e.span.start, e.span.end, e.text.as_str())).collect();
    assert_eq!(small, [(31, 32, ""), (45, 45, " ")]);
}
