//! The words of the language: one table each, which the grammar and the fuzzers' dictionary agree with.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::{Span, compile, compiled, run, text_of};
use mechc_ir::DeclarationKind;
use mechc_text::vocabulary::{self, Category, KEYWORDS, Keyword, OVERVIEWS, Position, Role, SYNONYMS, Synonym};
use proptest::prelude::*;
use std::collections::BTreeSet;

/// The words in quotes of one rule of the grammar.
fn words_of_rule(rule: &str) -> BTreeSet<String> {
    let grammar = text_of("grammar/mech.pest");
    let from = grammar.find(&format!("\n{rule} ")).unwrap_or_else(|| panic!("no rule {rule}"));
    let text = &grammar[from + 1..];
    let text = &text[..text.find("}\n").expect("its end")];
    text.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

fn keywords(wanted: impl Fn(&Keyword) -> bool) -> BTreeSet<String> {
    KEYWORDS.iter().filter(|keyword| wanted(keyword)).map(|keyword| keyword.word.name.to_owned()).collect()
}

#[test]
fn the_page_on_the_language_lists_the_words_of_both_roles() {
    let page = text_of("docs/language.md").split_whitespace().collect::<Vec<_>>().join(" ");
    let listed = |before: &str| -> BTreeSet<String> {
        let list = page.split(before).nth(1).and_then(|list| list.split('`').nth(1)).unwrap_or_default();
        list.split(' ').map(str::to_owned).collect()
    };
    assert_eq!(listed("where one can begin, and are names elsewhere:"), keywords(|keyword| keyword.role.is_opener()));
    assert_eq!(listed("Behind a number these are not its unit:"), keywords(|keyword| keyword.role == Role::Separator));
}

#[test]
fn the_grammar_has_the_keywords_of_the_table() {
    assert_eq!(words_of_rule("reserved"), keywords(Keyword::is_reserved));
    assert_eq!(words_of_rule("separator"), keywords(|keyword| keyword.role == Role::Separator));
    assert_eq!(words_of_rule("opener"), keywords(|keyword| keyword.role.is_opener()));
    let grammar = text_of("grammar/mech.pest");
    for keyword in KEYWORDS.iter().filter(|keyword| keyword.role != Role::Side) {
        let name = keyword.word.name;
        // what may be a name elsewhere has a rule of either kind
        let is_rule = |prefix: &str| grammar.lines().find(|line| line.starts_with(&format!("{prefix}{name} ")));
        let rule = is_rule("kw_").or_else(|| is_rule("").filter(|_| !keyword.is_reserved()));
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
    assert_eq!(named, keywords(|keyword| matches!(keyword.role, Role::Feature | Role::FeatureOpener)));
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
fn every_example_of_a_page_checks_and_runs_without_a_word() {
    for word in vocabulary::words() {
        let example = word.example();
        let page = vocabulary::page(word.name).expect("a page");
        assert!(page.contains(word.name), "{page}");
        let (compiled, outcome) = compile(word.name, &example);
        assert!(compiled.is_some() && outcome.diagnostics.is_empty(), "{}: {example}", word.name);
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
fn joint_counts_match_their_pages() {
    for joint in vocabulary::JOINTS {
        let (determined, _) = compiled(joint.word.name, &joint.word.example()).inside();
        let system = determined.system();
        let is_it = |kind| kind == DeclarationKind::Joint(joint);
        let number = system.declarations().find(|declaration| is_it(declaration.kind)).expect("the joint");
        let rows = system.rows().iter().filter(|row| row.declaration == number).count();
        assert_eq!(rows, joint.rows.len(), "{}", joint.word.name);
        let name = &system.declarations()[number].name;
        let own: Vec<&str> =
            system.coordinates().iter().filter_map(|c| c.name.strip_prefix(&format!("{name}."))).collect();
        let reported: Vec<&str> = joint.coordinates.iter().map(|(name, _)| *name).collect();
        assert_eq!(own, reported, "{}", joint.word.name);
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
fn pages_on_more_than_words_have_one_form_and_examples_that_run() {
    let all: Vec<&str> = vocabulary::topics().collect();
    assert!(
        ["parts", "inputs", "samples", "files", "repetition", "by", "names", "view"]
            .iter()
            .all(|name| all.contains(name))
    );
    assert_eq!(vocabulary::page("range"), vocabulary::page("repetition"));
    assert_eq!(vocabulary::page("vary"), vocabulary::page("view"));
    for name in all {
        assert!(
            vocabulary::words().all(|word| word.name != name) && !OVERVIEWS.contains(&name),
            "{name} is a word too"
        );
        let page = vocabulary::page(name).expect("a page");
        assert!(page.starts_with("# ") && page.ends_with('\n') && !page.contains("\n\n\n"), "{page}");
        assert!(page.contains("\n## An example\n") && page.contains("\n## What to look at\n"), "{page}");
        for line in page.lines() {
            assert!(line.trim_end() == line && line.chars().count() <= 130, "{name}: {line:?}");
        }
        // what it speaks of besides has a page as well
        for other in page.split("`mechc explain ").skip(1).filter_map(|rest| rest.split('`').next()) {
            assert!(vocabulary::page(other).is_some() || other.starts_with('E'), "{name} speaks of {other}");
        }
        for block in page.split("```mech\n").skip(1).filter_map(|rest| rest.split("```").next()) {
            let outcome = run("block.mech", block, Span::default()).expect_success();
            assert!(!outcome.rows.is_empty(), "no rows of:\n{block}");
        }
    }
}

#[test]
fn words_are_listed_by_kind() {
    let lists: String = OVERVIEWS.iter().map(|name| vocabulary::page(name).expect("a page")).collect();
    for word in vocabulary::words() {
        let begins = |line: &str| line.trim_start().starts_with(word.name);
        assert!(lists.lines().any(begins), "`{}` is in no list", word.name);
    }
}

// ---- what others call it

/// The code in a text, in order.
fn code_in(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// An arm, with a table, two joints and two points of one frame, and what is declared beside them.
fn with(declarations: &str) -> String {
    format!(
        "mechanism m {{
    ground {{ point Q = (0, 20 mm) axis way = (0, 0) along (1, 0) }}
    body b at (0, 20 mm, 0) {{ point O = (0, 0) point P = (100 mm, 0) }}
    body slide {{ axis way = (0, 0) along (1, 0) }}
    joint joint_b: revolute(ground.Q, b.O)
    joint guide: translational(ground.way, slide.way)
    driver motor: rotation(joint_b) = t + 1
    driver piston: displacement(guide) = 0.1 * t
    {declarations}
    analysis from 0 to 1 every 0.5
}}"
    )
}

/// Words of others, called with arguments, and the value that they have there.
#[allow(clippy::unreadable_literal, clippy::approx_constant)] // as another program prints them
const VALUES: &[(&str, &[&str], f64)] = &[
    ("sind", &["30"], 0.49999999999999994),
    ("cosd", &["20 * 2"], 0.766044443118978),
    ("tand", &["-10"], -0.17632698070846498),
    ("asind", &["0.5"], 30.0),
    ("acosd", &["0.5"], 60.0),
    ("atand", &["-1"], -45.0),
    ("atan2d", &["-1", "-1"], -135.0),
    ("cotd", &["30"], 1.7320508075688774),
    ("secd", &["30"], 1.1547005383792515),
    ("cscd", &["30"], 2.0),
    ("acot", &["-2"], 2.677945044588987),
    ("asec", &["1 + 2"], 1.2309594173407747),
    ("acsc", &["1 + 2"], 0.3398369094541219),
    ("coth", &["0.3"], 3.4327384303217414),
    ("sech", &["0.3"], 0.9566279119002483),
    ("csch", &["0.3"], 3.283853396698424),
    ("log1p", &["0.5"], 0.4054651081081644),
    ("expm1", &["0.5"], 0.6487212707001282),
    ("exp10", &["1 + 1"], 100.0),
    ("exp2", &["-1"], 0.5),
    ("cot", &["0.3"], 3.2327281437658275),
    ("sec", &["0.3"], 1.0467516015380856),
    ("csc", &["0.3"], 3.383863361824123),
    ("asinh", &["1 - 0.3"], 0.6526665660823557),
    ("acosh", &["1 + 0.3"], 0.7564329108569596),
    ("atanh", &["1 - 1.5"], -0.5493061443340548),
    ("sqr", &["1 + 2"], 9.0),
    ("cube", &["-2"], -8.0),
    ("pow", &["1 + 1", "1 + 2"], 8.0),
    ("cbrt", &["3 * 9"], 3.0),
    ("root", &["32", "2 + 3"], 2.0),
    ("log2", &["4 + 4"], 3.0),
    ("lg", &["1000"], 3.0),
    ("loge", &["2"], 0.6931471805599453),
    ("radians", &["90"], 1.5707963267948966),
    ("radians", &["45 * 2"], 1.5707963267948966),
    ("degrees", &["pi / 2"], 90.0),
    ("floor", &["2.7"], 2.0),
    ("ceil", &["2.7"], 3.0),
    ("round", &["2.7"], 3.0),
    ("trunc", &["2.7"], 2.0),
    ("frac", &["2.7"], 0.7000000000000002),
    ("rem", &["2.7", "2"], 0.7000000000000002),
    ("fmod", &["2.7", "0 - 2"], 0.7000000000000002),
    ("sgn", &["2.7"], 1.0),
    ("fabs", &["2.7"], 2.7),
    ("clamp", &["2.7", "-1", "2"], 2.0),
    ("fmin", &["2.7", "1"], 1.0),
    ("fmax", &["2.7", "1"], 2.7),
    ("modulo", &["2.7", "2"], 0.7000000000000002),
    ("floor", &["1 - 3.7"], -3.0),
    ("ceil", &["1 - 3.7"], -2.0),
    ("round", &["1 - 3.7"], -3.0),
    ("trunc", &["1 - 3.7"], -2.0),
    ("frac", &["1 - 3.7"], 0.2999999999999998),
    ("rem", &["1 - 3.7", "2"], -0.7000000000000002),
    ("fmod", &["1 - 3.7", "0 - 2"], -0.7000000000000002),
    ("sgn", &["1 - 3.7"], -1.0),
    ("fabs", &["1 - 3.7"], 2.7),
    ("clamp", &["1 - 3.7", "-1", "2"], -1.0),
    ("fmin", &["1 - 3.7", "1"], -2.7),
    ("fmax", &["1 - 3.7", "1"], 1.0),
    ("modulo", &["1 - 3.7", "2"], 1.2999999999999998),
    ("floor", &["2.0"], 2.0),
    ("ceil", &["2.0"], 2.0),
    ("round", &["2.0"], 2.0),
    ("trunc", &["2.0"], 2.0),
    ("frac", &["2.0"], 0.0),
    ("rem", &["2.0", "2"], 0.0),
    ("fmod", &["2.0", "0 - 2"], 0.0),
    ("sgn", &["2.0"], 1.0),
    ("fabs", &["2.0"], 2.0),
    ("clamp", &["2.0", "-1", "2"], 2.0),
    ("fmin", &["2.0", "1"], 1.0),
    ("fmax", &["2.0", "1"], 2.0),
    ("modulo", &["2.0", "2"], 0.0),
    ("floor", &["1 - 3.0"], -2.0),
    ("ceil", &["1 - 3.0"], -2.0),
    ("round", &["1 - 3.0"], -2.0),
    ("trunc", &["1 - 3.0"], -2.0),
    ("frac", &["1 - 3.0"], 0.0),
    ("rem", &["1 - 3.0", "2"], -0.0),
    ("fmod", &["1 - 3.0", "0 - 2"], -0.0),
    ("sgn", &["1 - 3.0"], -1.0),
    ("fabs", &["1 - 3.0"], 2.0),
    ("clamp", &["1 - 3.0", "-1", "2"], -1.0),
    ("fmin", &["1 - 3.0", "1"], -2.0),
    ("fmax", &["1 - 3.0", "1"], 1.0),
    ("modulo", &["1 - 3.0", "2"], 0.0),
    ("floor", &["2.5"], 2.0),
    ("ceil", &["2.5"], 3.0),
    ("round", &["2.5"], 3.0),
    ("trunc", &["2.5"], 2.0),
    ("frac", &["2.5"], 0.5),
    ("rem", &["2.5", "2"], 0.5),
    ("fmod", &["2.5", "0 - 2"], 0.5),
    ("sgn", &["2.5"], 1.0),
    ("fabs", &["2.5"], 2.5),
    ("clamp", &["2.5", "-1", "2"], 2.0),
    ("fmin", &["2.5", "1"], 1.0),
    ("fmax", &["2.5", "1"], 2.5),
    ("modulo", &["2.5", "2"], 0.5),
    ("floor", &["1 - 3.4"], -3.0),
    ("ceil", &["1 - 3.4"], -2.0),
    ("round", &["1 - 3.4"], -2.0),
    ("trunc", &["1 - 3.4"], -2.0),
    ("frac", &["1 - 3.4"], 0.6000000000000001),
    ("rem", &["1 - 3.4", "2"], -0.3999999999999999),
    ("fmod", &["1 - 3.4", "0 - 2"], -0.3999999999999999),
    ("sgn", &["1 - 3.4"], -1.0),
    ("fabs", &["1 - 3.4"], 2.4),
    ("clamp", &["1 - 3.4", "-1", "2"], -1.0),
    ("fmin", &["1 - 3.4", "1"], -2.4),
    ("fmax", &["1 - 3.4", "1"], 1.0),
    ("modulo", &["1 - 3.4", "2"], 1.6),
];

#[test]
fn synonym_suggestions_have_the_right_value() {
    for &(word, arguments, value) in VALUES {
        let messages = Synonym::of(Position::Call, word).unwrap_or_else(|| panic!("{word}")).message(arguments);
        let formula = *code_in(&messages).last().expect("a formula");
        let outcome = run(word, &with(&format!("measure v = {formula}")), Span::default()).expect_success();
        let found = outcome.column("v")[0];
        assert!(
            (found - value).abs() < 1e-12 * value.abs().max(1.0),
            "{word}({arguments:?}), {messages}: {found}, not {value}"
        );
    }
}

#[test]
fn only_existing_names_are_suggested() {
    // one for each kind of argument
    let of_kinds: [&[&str]; 7] =
        [&["0.4", "0.3", "0.6"], &["1.4"], &["b.P", "ground.Q"], &["b", "b"], &["joint_b"], &["guide"], &["motor"]];
    let checks = |measure: &str| run("said", &with(measure), Span::default()).succeeded();
    for synonym in SYNONYMS {
        for word in synonym.means() {
            assert!(
                vocabulary::page(word).is_some(),
                "{:?} mean `{word}`, which is no word",
                synonym.names().collect::<Vec<_>>()
            );
        }
        let messages = synonym.message(&[]);
        assert!(!messages.ends_with('.') && !messages.contains(['{', '}']), "{messages}");
        assert_eq!(code_in(&messages).len() * 2, messages.matches('`').count(), "{messages}");
        for name in synonym.names() {
            assert_eq!(name, name.to_lowercase(), "they are compared in small letters");
            let is_one = vocabulary::words().any(|word| {
                word.name == name
                    && match synonym.position {
                        Position::Joint => word.category == Category::Joint,
                        Position::Call => vocabulary::is_called(name),
                        Position::Unit => word.category == Category::Unit,
                        Position::Declaration => Keyword::named(name).is_some_and(Keyword::begins_declaration),
                        Position::Number => word.category == Category::Constant,
                    }
            });
            // `min` is a function, and no unit
            assert!(!is_one, "`{name}` is a word of the language");
        }
        // what is called is called by its name, and what is written out can be evaluated
        let called = |code: &str| -> Vec<String> {
            let names = code.split('(').rev().skip(1).map(|before| {
                let start = before.rfind(|c: char| !c.is_alphanumeric() && c != '_').map_or(0, |at| at + 1);
                before[start..].to_owned()
            });
            names.filter(|name| !name.is_empty()).collect()
        };
        for name in code_in(&messages).into_iter().flat_map(called) {
            let is_joint = vocabulary::JOINTS.iter().any(|joint| joint.word.name == name);
            let is_quantity = vocabulary::QuantityWord::named(&name).is_some();
            let is_reduction = vocabulary::REDUCTIONS.iter().any(|reduction| reduction.word.name == name);
            assert!(is_joint || is_quantity || is_reduction || vocabulary::is_called(&name), "{messages}: `{name}`");
        }
        if synonym.position == Position::Call && !messages.ends_with('?') {
            for k in 0..code_in(&messages).len() {
                let works = of_kinds.iter().any(|arguments| {
                    let messages = synonym.message(arguments);
                    let code = code_in(&messages)[k]
                        .replace("joint)", "joint_b)")
                        .replace("(u, u0, v0, u1, v1)", "(t, 0, 0, 1, 1)");
                    let code = code.replace("(u, u0, c0, c1)", "(t, 0, 0, 1)");
                    let is_word = vocabulary::page(&code).is_some() || synonym.names().any(|name| name == code);
                    let measure = if code.contains("table ") { code } else { format!("measure v = {code}") };
                    let result = measure.replace("measure", "result");
                    is_word || checks(&measure) || checks(&measure.replace("< 1 s", "< 1")) || checks(&result)
                });
                assert!(works, "{messages}: number {k}");
            }
        }
    }
}

#[test]
fn synonyms_are_unique() {
    let mut seen = BTreeSet::new();
    for synonym in SYNONYMS {
        for name in synonym.names() {
            assert!(seen.insert((format!("{:?}", synonym.position), name)), "`{name}` stands twice");
        }
    }
}

// ---- names that are units

/// Formulas of a pure number NAME and an argument `u`, numbers with units of angle and rate among them. No product begins with a number
/// and its unit: NAME could be the unit there.
fn formula() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        4 => Just("NAME".to_owned()),
        2 => (1..20_i32).prop_map(|n| format!("{n}")),
        1 => (1..20_i32).prop_map(|n| format!("{n} mrad")),
        1 => (1..20_i32).prop_map(|n| format!("({n} Hz / 3 Hz)")),
        2 => Just("u".to_owned()),
    ];
    leaf.prop_recursive(3, 12, 3, |inner| {
        prop_oneof![
            (inner.clone(), prop_oneof![Just("+"), Just("-"), Just("*")], inner.clone())
                .prop_map(|(a, operator, b)| format!("(({a}) {operator} {b})")),
            inner.clone().prop_map(|a| format!("sin({a})")),
            (inner.clone(), inner.clone(), inner).prop_map(|(a, b, c)| format!("(if {a} < {b} then {c} else NAME)")),
        ]
    })
}

/// The rows of a mechanism in which NAME and ARG have these names.
fn rows(text: &str, name: &str, argument: &str) -> Vec<Vec<f64>> {
    let text = text.replace("NAME", name).replace("ARG", argument);
    run("named", &text, Span::default()).expect_success().rows
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn names_win_over_units(formula in formula(), of_curve in formula(), unit in prop_oneof![Just("Hz"), Just("mrad"), Just("m")]) {
        let over = |argument: &str| formula.replace('u', argument);
        let declarations = [
            // a parameter, plain and with a dimension
            format!("param NAME = 0.75 measure v = {}", over("angle(b)")),
            format!("param NAME = 3 mm measure v = NAME / 1 mm * 2 mm measure w = hypot(NAME, x(b.P)) + {} * 1 mm", over("1").replace("NAME", "(NAME / 1 mm)")),
            // a function, and its argument
            format!("fn NAME(ARG) = {} measure v = NAME(angle(b)) + NAME(2 * angle(b))", over("ARG").replace("NAME", "ARG")),
            format!("fn f(ARG) = 2 * ARG + {} measure v = f(angle(b)) measure w = f(1 s / 1 s) * 1 mm", over("ARG").replace("NAME", "ARG")),
            // the argument of a curve, whose formula is judged with its other coordinate
            format!(
                "body c {{ point O = (0, 0) curve NAME(ARG) = (10 mm * cos(ARG), 10 mm * sin(ARG) + 0.001 mm * cos({})) }}
                 joint NAME: revolute(b.P, c.O) driver d: rotation(NAME) = {}",
                of_curve.replace("NAME", "ARG").replace('u', "ARG"), over("1").replace("NAME", "2")
            ),
            // what is plain stays plain
            "fn g(ARG) = 2 * ARG + ARG^2 measure NAME = g(angle(b)) + 3 * x(b.P)
             body c { point O = (0, 0) curve k(ARG) = (cos(ARG), 0.1 * sin(ARG)) }
             joint j: revolute(b.P, c.O) driver d: rotation(j) = 2"
                .to_owned(),
            // a measure, and a table
            format!("measure NAME = {} measure v = 2 * NAME measure w = der(NAME)", over("angle(b)").replace("NAME", "3")),
            format!("table NAME = spline [(0, 1), (1, 3), (2, 2)] measure v = NAME(angle(b)) + NAME(1 + sin({})^2 / 2)", over("angle(b)").replace("NAME", "2")),
        ];
        for declared in declarations {
            let text = with(&declared);
            let wanted = rows(&text, "own_name", "own_argument");
            // to the bit
            let bits = |rows: Vec<Vec<f64>>| rows.into_iter().flatten().map(f64::to_bits).collect::<Vec<_>>();
            prop_assert_eq!(bits(rows(&text, unit, if unit == "Hz" { "mrad" } else { "Hz" })), bits(wanted), "{}", text);
        }
    }

    // not 1, which stands elsewhere in the text that is replaced
    #[test]
    fn yielding_units_apply_without_a_name(number in 2..1000_i32, power in 1..4_i32) {
        let text = |hertz: &str, milliradian: &str| with(&format!(
            "measure v = {number} {hertz}^{power} * 1 s^{power} + {number} * {milliradian} + sin({number} {milliradian}) + 2 * {hertz} / (3 * {hertz})"
        ));
        let wanted = text("s", "rad").replace(&format!("{number} s^{power}"), &format!("{number} s^-{power}"));
        let wanted = wanted.replace(&format!("{number} rad"), &format!("{}", f64::from(number) / 1e3));
        let wanted = wanted.replace("* rad", "* 0.001").replace("2 * s / (3 * s)", "2 / 3");
        let bits = |text: &str| -> Vec<u64> { rows(text, "", "").into_iter().flatten().map(f64::to_bits).collect() };
        prop_assert_eq!(bits(&text("Hz", "mrad")), bits(&wanted));
    }
}
