//! Model files of the course's planar engine: what they become, and what is said of those that cannot be translated.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

mod matlab;

use crate::support::random::Random;
use crate::support::{Span, run};
use mechc::Sources;
use mechc::{Code, Color, Diagnostics, Format, Severity, render};
use mechc_lang::check;
use mechc_syntax::import;
use mechc_syntax::{self as syntax, ast};
use proptest::prelude::*;
use std::fmt::Write;

/// What became of a model.
struct Imported {
    text: Option<String>,
    file: Option<ast::File>,
    diagnostics: Diagnostics,
    sources: Sources,
}

impl Imported {
    fn said(&self, format: Format) -> String {
        self.diagnostics.iter().map(|d| render(d, &self.sources, format, Color::Never)).collect()
    }

    fn errors(&self) -> Vec<String> {
        let errors = self.diagnostics.iter().filter(|d| d.severity() == Severity::Error);
        errors.map(|d| render(d, &self.sources, Format::Short, Color::Never).trim_end().to_owned()).collect()
    }
}

/// Imports, and holds the result to what every result is held to: it is formatted, and checks without a word.
fn imported(model: &str, settings: Option<&str>) -> Imported {
    let mut sources = Sources::default();
    let model = sources.add("models/wiper.adm", model);
    let settings = settings.map(|text| sources.add("wiper.acf", text));
    let (file, diagnostics) = import::import(model, settings, &sources);
    assert_eq!(file.is_none(), diagnostics.has_errors());
    let text = file.as_ref().map(syntax::format);
    if let Some(text) = &text {
        let mut sources = Sources::default();
        let id = sources.add("imported.mech", text.as_str());
        let again = syntax::parse(&sources, id).tree;
        assert_eq!(&syntax::format(&again), text, "it is formatted");
        let (_, said) = check::check(&again.mechanisms[0], &check::CheckOptions::default(), &sources);
        // constants that are not finite are told by the command
        let words = said.iter().find(|d| d.code != Code::E0404);
        let words = words.map(|d| render(d, &sources, Format::Human, Color::Never));
        assert!(words.is_none(), "{}\n{text}", words.unwrap_or_default());
    }
    Imported { text, file, diagnostics, sources }
}

/// A rocker on a turning shaft: one body, and one constraint of the given keys.
fn with_constraint(keys: &str) -> String {
    format!(
        "{{\"name\": \"one\", \"bodies\": [{{\"name\": \"a\", \"q0\": [0, 0, 0]}}, {{\"name\": \"b\", \"q0\": [1, 0, 0]}}],\n\
         \"constraints\": [{{\"name\": \"c\", {keys}}}]}}"
    )
}

fn with_formula(formula: &str) -> String {
    let quoted = serde_json::to_string(formula).expect("a string");
    with_constraint(&format!("\"type\": \"AbsoluteAngle\", \"body1\": 1, \"fun\": {quoted}"))
}

/// The translation of a MATLAB formula, or the first error.
fn translated(formula: &str) -> Result<String, String> {
    let imported = imported(&with_formula(formula), None);
    match imported.text {
        Some(text) => {
            // with the lines into which it is broken
            let mut lines = text.lines().skip_while(|line| !line.contains(" c: "));
            let first = lines.next().expect("the equation").to_owned();
            let whole =
                lines.take_while(|line| line.starts_with("     ")).fold(first, |all, line| all + " " + line.trim());
            Ok(whole.split_once(" = ").expect("an equation").1.to_owned())
        }
        None => Err(imported.said(Format::Human)),
    }
}

// ---- whole models

const WIPER: &str = r#"{
  "name": "wind-screen wiper",
  "gravity": [0, -9.81],
  "vis": {"xlim": [-1, 1]},
  "bodies": [
    {"name": "crank", "id": 7, "mass": 0.2, "jbar": 1e-3, "q0": [0.02, 0, 0], "qd0": [0, 0, 1]},
    {"name": "Long Rod", "id": 8, "mass": 0.5, "jbar": 0.1, "q0": [187/935, 0.04, 2*(3+0.5)], "qd0": [0, 0, 0]},
    {"name": "rocker", "id": 9, "mass": 0.5, "jbar": 0.1, "q0": [0.4, .05, 1.5], "qd0": [0, 0, 0]}
  ],
  "constraints": [
    {"name": "absX", "type": "AbsoluteX", "body1": 1, "sP1": [-0.02, 0], "fun": "0"},
    {"name": "absY", "type": "AbsoluteY", "body1": 1, "sP1": [-0.02, -0], "fun": "0"},
    {"name": "rev", "type": "RevoluteJoint", "body1": 1, "sP1": [0.02, 0], "body2": 2, "sP2": [-0.2, 0], "fun": "NONE"},
    {"name": "rev_1", "type": "RevoluteJoint", "body1": 2, "sP1": [0.2, 0], "body2": 3, "sP2": [0, 0.05], "fun": "t"},
    {"name": "absX", "type": "AbsoluteX", "body1": 3, "sP1": [0, -0.05], "fun": "0.4"},
    {"name": "down", "type": "AbsoluteY", "body1": 3, "sP1": [0, -0.05], "fun": "-1e-3"},
    {"type": "AbsoluteAngle", "body1": 1, "fun": "pi./2 + 2*pi*t'"}
  ],
  "forces": [{"name": "spring", "type": "TSDA"}, {}]
}"#;

const TIMES: &str = r#"{"simulation": "Kinematics", "tend": 0.5, "stepSize": 0.01, "outputSteps": 50}"#;

#[test]
fn a_wiper_is_imported() {
    let imported = imported(WIPER, Some(TIMES));
    insta::assert_snapshot!("wiper", imported.text.as_ref().expect("a text"));
    insta::assert_snapshot!("wiper_said", imported.said(Format::Human));
    assert_eq!(imported.file.expect("a tree").mechanisms[0].items.len(), 3 + 7 + 1);
    let rows = run("wiper", &imported.text.expect("a text"), Span::default()).expect_success().rows;
    assert_eq!(rows.len(), 51);
}

const RACK: &str = r#"{"name": "driver", "bodies": [
    {"name": "rail", "q0": [0.1, 0.3, 0]}, {"name": "wheel", "q0": [0, 0, 0]}, {"name": "block", "q0": [1, 0.3, 7]}],
  "constraints": [
    {"name": "mesh", "type": "RackPinion", "body1": 1, "sP1": [0.3, 0], "sQ1": [0.1, 0.7], "body2": 2, "sP2": [0, 0],
     "theta1": -3.5, "theta2": 0, "R2": 0.3, "fun": "0"},
    {"name": "slide", "type": "TranslationalJoint", "body1": 1, "sP1": [0, 0], "vP1": [3, 0], "body2": 3, "sP2": [0, 0],
     "vP2": [-0.5, 1e-3], "fun": "NONE"},
    {"name": "slide2", "type": "TranslationalJoint", "body1": 3, "sP1": [0, 0], "vP1": [0, 1], "body2": 1, "sP2": [0, 1],
     "vP2": [1, 0]},
    {"name": "mesh_distance", "type": "AbsoluteAngle", "body1": 2, "fun": "-20"},
    {"name": "turn", "type": "AbsoluteX", "body1": 3, "sP1": [1, 1], "fun": "sind(90*t)"}]}"#;

#[test]
fn a_rack_and_slides_are_imported() {
    let imported = imported(RACK, Some(r#"{"simulation": "Dynamics", "tend": 5, "outputSteps": 333}"#));
    insta::assert_snapshot!("rack", imported.text.as_ref().expect("a text"));
    insta::assert_snapshot!("rack_said", imported.said(Format::Human));
}

#[test]
fn names_that_are_taken_are_changed() {
    let names = [
        "t",
        "pi",
        "tau",
        "ground",
        "mechanism",
        "not",
        "m",
        "mm",
        "cm",
        "um",
        "µm",
        "μm",
        "km",
        "in",
        "ft",
        "rad",
        "deg",
        "rev",
        "s",
        "ms",
        "us",
        "µs",
        "rpm",
        "4bar",
        "a-b c",
        "",
        "_",
        "***",
        "ä ö",
        "x",
        "sin",
        "a_b_c",
        "at",
        "e\u{301}",
        "\u{200d}",
        "C",
        "C",
        "C_1",
        "\u{1f600}",
        "1",
        "--a--",
    ];
    let bodies: Vec<String> =
        names.iter().map(|name| format!("{{\"name\": {}, \"q0\": [0, 0, 0]}}", serde_json::json!(name))).collect();
    let constraints: Vec<String> = (1..=names.len())
        .map(|k| format!("{{\"name\": \"C\", \"type\": \"AbsoluteAngle\", \"body1\": {k}, \"fun\": \"t\"}}"))
        .collect();
    let model = format!("{{\"bodies\": [{}], \"constraints\": [{}]}}", bodies.join(","), constraints.join(",\n"));
    let imported = imported(&model, None);
    let text = imported.text.expect("it can be imported");
    let bodies: Vec<&str> = text.lines().filter_map(|line| line.trim().strip_prefix("body ")).collect();
    let bodies: Vec<&str> = bodies.iter().map(|line| line.split(' ').next().unwrap()).collect();
    insta::assert_snapshot!(
        "names",
        names.iter().zip(bodies).fold(String::new(), |mut list, (old, new)| {
            writeln!(list, "{old:?} -> {new}").unwrap();
            list
        })
    );
    assert!(text.starts_with("/// Imported from `wiper.adm`.\nmechanism wiper {"), "{text}");
    assert!(imported.diagnostics.iter().all(|d| d.code == Code::N0702));
    assert!(text.contains("driver C_42:"), "{text}");
}

#[test]
fn many_things_of_one_name_cost_linear_time() {
    let n = 20_000;
    let one = r#"{"name": "C", "type": "AbsoluteAngle", "body1": 1, "fun": "0"}"#;
    let constraints = vec![one; n].join(",\n");
    let model = format!(r#"{{"bodies": [{{"name": "b", "q0": [0, 0, 0]}}], "constraints": [{constraints}]}}"#);
    let mut sources = Sources::default();
    let id = sources.add("many.adm", model);
    let (file, _) = import::import(id, None, &sources);
    assert_eq!(file.expect("a tree").mechanisms[0].items.len(), n + 1);
}

#[test]
fn times_of_the_settings() {
    for (settings, wanted) in [
        (r#""tend": 5.0, "outputSteps": 500"#, "from 0 s to 5 s every 10 ms"),
        (r#""tend": 5, "outputSteps": 333"#, "from 0 s to 5 s every 5 s / 333"),
        (r#""tend": 0.1, "outputSteps": 1000"#, "from 0 s to 0.1 s every 100 us"),
        (r#""tend": 1e-3, "outputSteps": 1000"#, "from 0 s to 0.001 s every 1 us"),
        (r#""tend": 10, "outputSteps": 4"#, "from 0 s to 10 s every 2.5 s"),
        (r#""tend": 1200, "outputSteps": 10"#, "from 0 s to 1200 s every 120 s"),
        (r#""tend": 3, "outputSteps": 4"#, "from 0 s to 3 s every 750 ms"),
        (r#""tend": 1, "outputSteps": 1048576"#, "from 0 s to 1 s every 1 s / 1048576"),
        (r#""tend": 1/3, "outputSteps": 1"#, "from 0 s to 0.3333333333333333 s every 0.3333333333333333 s / 1"),
        (r#""tend": 1e300, "outputSteps": 7"#, "from 0 s to 1e300 s every 1e300 s / 7"),
        (r#""tend": 2, "tend": 1, "outputSteps": 2, "other": null"#, "from 0 s to 1 s every 500 ms"),
    ] {
        let imported = imported(&with_formula("t"), Some(&format!("{{{settings}}}")));
        let text = imported.text.unwrap_or_else(|| panic!("{settings}"));
        assert!(text.contains(&format!("analysis {wanted}\n")), "{settings}: {text}");
    }
}

// ---- formulas

const TRANSLATED: &[&str] = &[
    "0",
    "-0",
    "0.2",
    "-1.5",
    "7",
    "-7",
    "(-7)",
    "1.",
    ".5",
    "1e-3",
    "1d3",
    "1D-3",
    "+2",
    "pi",
    "-pi/2",
    "2*pi*3",
    "true",
    "t",
    "t'",
    "t.'",
    "(t)'",
    "1.*t",
    "1./t",
    "2.^t",
    "1.'*t",
    "t.*t./2",
    "t.^2",
    "2^3^2*t",
    "2^(3^2)*t",
    "-t^2",
    "(-t)^2",
    "2^-1*t",
    "2^-t",
    "2^+t",
    "2^(-t^2)",
    "2*-t",
    "-2*t",
    "-(2*t)",
    "--t",
    "+t",
    "-+t",
    "t-(1-t)",
    "t-(1+t)",
    "(t-1)+t",
    "t/(2*pi)",
    "t*(2/pi)",
    "(t*2)/pi",
    "2\\t",
    "t\\2*t",
    "sin(10*t)",
    "pi/2 + 2*pi*t",
    "t^2",
    "log(t)",
    "log10(t)",
    "log2(t)",
    "exp(-t)",
    "sqrt(t)",
    "abs(t)",
    "sign(t)",
    "atan2(t, 1)",
    "sinh(t)",
    "mod(t, 2)",
    "rem(t, 2)",
    "min(t, 1)",
    "hypot(t, 1)",
    "power(t, 3)",
    "power(t + 1, 2 - t)",
    "times(t + 1, 2)",
    "sind(30)",
    "sind(90*t)",
    "cosd(t)",
    "tand(t + 1)",
    "asind(t)",
    "rad2deg(t)",
    "deg2rad(90)",
    "floor(t)",
    "ceil(t)",
    "fix(t)",
    "round(t)",
    "heaviside(t - 1)",
    "cot(t)",
    "t < 1",
    "(t < 1)*t",
    "(t >= 1).*(t <= 2)",
    "(t > 1) & (t < 2)",
    "(t > 1) | t",
    "~(t > 1)",
    "~t",
    "~t == 1",
    "t > 1 & t < 2 | t == 3",
    "t > 1 && t < 2 || t ~= 3",
    "0 < t < 1",
    "-(t > 1)",
    "(t > 1)^2",
    "sin(t > 1)",
    "eps*t",
    "t + (t > 1) - 1",
];

#[test]
fn formulas_are_translated() {
    let text = TRANSLATED.iter().fold(String::new(), |mut text, formula| {
        let meaning = translated(formula).unwrap_or_else(|error| panic!("{formula}: {error}"));
        writeln!(text, "{formula:24} {meaning}").unwrap();
        text
    });
    insta::assert_snapshot!("formulas", text);
}

#[test]
fn formulas_without_a_counterpart_are_refused() {
    let table = [
        "",
        "  ",
        "NONE",
        "none",
        "sin",
        "sin()",
        "sin(t, 1)",
        "min(t)",
        "2t",
        "3i",
        "2e",
        "i*t",
        "e^t",
        "T",
        "PI",
        "Inf",
        "1e999",
        "x + t",
        "Sin(t)",
        "besselj(0, t)",
        "atan2(t)",
        "t(1)",
        "[1 2]",
        "t:2",
        "@(t) t",
        "t;",
        "t = 1",
        "'text'",
        "\"text\"",
        "t != 1",
        "t % c",
        "t t",
        "(t) (t)",
        "sin(t",
        "t)",
        "t +",
        "t + * 2",
        "t 2",
        "^2",
        "2^",
        "2^-",
        "2^-1^2",
        "2^-",
        "2^(",
        "sin(,)",
        "sin(t,)",
        "t ü 2",
        "1..2",
        "t..2",
        "1.5.2",
        "$",
        "t.a",
        "0x1F",
        "1__",
    ];
    let text = table.iter().fold(String::new(), |mut text, formula| {
        let imported = imported(&with_formula(formula), None);
        assert_eq!(imported.errors().len(), 1, "{formula}: {:?}", imported.text);
        let diagnostic = imported.diagnostics.iter().next().expect("an error");
        assert_eq!(diagnostic.code, Code::E0707);
        let place = imported.sources.text(diagnostic.labels[0].span);
        let help = diagnostic.help.first().map_or(String::new(), |help| format!("; {help}"));
        writeln!(text, "{formula:12} at `{place}`: {}{help}", diagnostic.message).unwrap();
        text
    });
    insta::assert_snapshot!("refused_formulas", text);
}

#[test]
fn places_in_formulas_count_escapes() {
    let model = with_constraint(r#""type": "AbsoluteAngle", "body1": 1, "fun": "\u0074 + \t\u00fc""#);
    let imported = imported(&model, None);
    let diagnostic = imported.diagnostics.iter().next().expect("an error");
    assert_eq!(imported.sources.text(diagnostic.labels[0].span), r"\u00fc");
    assert_eq!(translated("t\t+\n2").unwrap(), "t + 2");
}

#[test]
fn formulas_keep_their_value() {
    let mut random = Random::new(20_240_611);
    let mut compared = 0;
    for _ in 0..1500 {
        let formula = matlab::formula(&mut random, 4);
        let meaning = match translated(&formula) {
            Ok(meaning) => meaning,
            Err(error) if error.contains("not finite") || error.contains("groups in two ways") => continue,
            Err(error) => panic!("{formula}: {error}"),
        };
        let mut sources = Sources::default();
        let file = sources.add("formula", meaning.as_str());
        let tree = syntax::parse_expression(&sources, file).expect("a formula");
        for t in [0.0, 0.37, -1.5, 2.0] {
            // where MATLAB goes on from an infinite value, the language stops and says so
            let Some(wanted) = matlab::value(&formula, t) else { continue };
            let found = matlab::value_here(&tree, t);
            let alike = (wanted - found).abs() <= 1e-9 * wanted.abs().max(1.0);
            compared += 1;
            assert!(alike, "{formula} at {t} is {wanted}, {meaning} is {found}");
        }
    }
    assert!(compared > 2000, "{compared}");
}

#[test]
fn imports_limit_nesting() {
    let n = 100_000;
    for formula in [
        format!("{}t{}", "(".repeat(n), ")".repeat(n)),
        format!("{}t", "-".repeat(n)),
        format!("2^{}t", "-".repeat(n)),
        format!("t{}", "^1".repeat(n)),
        format!("t{}", "<1".repeat(n)),
        format!("t{}", "\\1".repeat(n)),
        format!("{}t{}", "sin(".repeat(n), ")".repeat(n)),
        format!("{}t{}", "floor(".repeat(30), ")".repeat(30)),
        format!("{}t{}", "(1|1&1<1+1*1^(".repeat(190), "))".repeat(190)),
    ] {
        let error = translated(&formula).expect_err("too deep");
        assert!(error.contains("deeper than 200") || error.contains("too large"), "{}: {error}", &formula[..20]);
    }
    for (open, close) in [("[", "]"), ("{\"a\":", "}"), ("(", ")"), ("-", ""), ("[", "")] {
        let text = format!("{}1{}", open.repeat(n), close.repeat(n));
        assert_eq!(imported(&text, None).errors().len(), 1);
    }
    translated(&format!("{}t{}", "(".repeat(190), ")".repeat(190))).expect("not too deep");
    translated(&format!("t{}", " + 1".repeat(20_000))).expect("long, not deep");
    translated(&format!("t{}'", " .* 1".repeat(20_000))).expect("long, not deep");
}

// ---- mistakes

#[test]
fn mistakes_have_their_places() {
    let body = r#""bodies": [{"name": "a", "q0": [0, 0, 0]}]"#;
    let files = [
        String::new(),
        " \n".to_owned(),
        "[]".to_owned(),
        "5".to_owned(),
        "{}".to_owned(),
        "mechanism m {}".to_owned(),
        "{\"name\": \"a\"".to_owned(),
        "{\"name\": \"a}".to_owned(),
        "{\"name\": \"a\\x\"}".to_owned(),
        "{'name': 1}".to_owned(),
        "{\"name\" 1}".to_owned(),
        "{\"name\": 1,}".to_owned(),
        "{\"a\": [1, 2,]}".to_owned(),
        "{\"a\": 1 2}".to_owned(),
        "{\"a\": 1} x".to_owned(),
        "{\"a\": 1 + }".to_owned(),
        "{\"a\": (1}".to_owned(),
        "{\"a\": NaN}".to_owned(),
        "{\"a\": 1e999}".to_owned(),
        "{\"a\": 1/0}".to_owned(),
        "{ // no\n}".to_owned(),
        "{\"a\": tru}".to_owned(),
        "{\"name\": 5, \"bodies\": {}, \"constraints\": null}".to_owned(),
        "{\"bodies\": [], \"constraints\": []}".to_owned(),
        "{\"bodies\": [5, {\"q0\": [1, 2]}, {\"name\": 1}], \"constraints\": [{}, true]}".to_owned(),
        "{\"bodies\": [{\"name\": \"a\", \"q0\": [1, 2, \"3\"]}], \"constraints\": []}".to_owned(),
        format!("{{{body}, \"constraints\": [{{\"type\": \"AbsolutX\"}}, {{\"type\": \"Weld\"}}, {{\"type\": 3}}]}}"),
    ];
    let constraints = [
        r#""type": "AbsoluteX""#,
        r#""type": "AbsoluteX", "body1": 3, "sP1": [0], "fun": 5"#,
        r#""type": "AbsoluteAngle", "body1": 0, "fun": "t""#,
        r#""type": "AbsoluteAngle", "body1": 1.5, "fun": "t""#,
        r#""type": "AbsoluteAngle", "body1": "a", "fun": "NONE""#,
        r#""type": "RevoluteJoint", "body1": 1, "body2": 1, "sP1": [0, 0], "sP2": [0, 0]"#,
        r#""type": "TranslationalJoint", "body1": 1, "body2": 2, "sP1": [0, 0], "sP2": [0, 0], "vP1": [0, 0], "vP2": [0, -0]"#,
        r#""type": "RackPinion", "body1": 1, "body2": 2, "sP1": [0, 0], "sQ1": [0, 0], "sP2": [0, 0], "theta1": 0, "theta2": 0, "R2": 1"#,
        r#""type": "RackPinion", "body1": 1, "body2": 2, "sP1": [0, 0], "sQ1": [1, 0], "sP2": [0, 0], "theta1": 0, "theta2": true, "R2": -1"#,
        r#""type": "RackPinion", "body1": 1, "body2": 2, "sP1": [0, 0], "sQ1": [1e308, 0], "sP2": [0, 0], "theta1": 0, "theta2": 0, "R2": 1"#,
    ];
    let all = files.into_iter().chain(constraints.map(with_constraint));
    let text = all.fold(String::new(), |mut text, model| {
        let imported = imported(&model, None);
        assert!(!imported.errors().is_empty(), "{model}");
        assert!(imported.diagnostics.iter().all(|d| !d.labels.is_empty()), "{model}");
        writeln!(text, "{model}\n    {}", imported.errors().join("\n    ").replace("models/wiper.adm", "")).unwrap();
        text
    });
    insta::assert_snapshot!("mistakes", text);
    let settings = [
        "",
        "[]",
        "{}",
        r#"{"tend": 0, "outputSteps": 0}"#,
        r#"{"tend": -1, "outputSteps": -5}"#,
        r#"{"tend": "5", "outputSteps": 2.5}"#,
        r#"{"simulation": "Statics", "tend": 1, "outputSteps": 1}"#,
        r#"{"simulation": 1, "tend": 1, "outputSteps": 1e300}"#,
    ];
    let text = settings.iter().fold(String::new(), |mut text, settings| {
        let imported = imported(&with_formula("t"), Some(settings));
        writeln!(text, "{settings}\n    {}", imported.errors().join("\n    ")).unwrap();
        text
    });
    insta::assert_snapshot!("mistakes_in_settings", text);
}

#[test]
fn mistakes_as_shown_to_users() {
    let model = WIPER.replace("0.4\"", "0.4*cos(phi)\"").replace("\"body2\": 3", "\"body2\": 30");
    insta::assert_snapshot!("mistakes_shown", imported(&model, None).said(Format::Human));
}

// ---- anything at all

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_formulas_are_answered(formula in "[-+*/^.'()<>=~&|,0-9etpid sin]{0,40}") {
        let _ = translated(&formula);
    }

    #[test]
    fn random_text_is_answered(text in any::<String>()) {
        imported(&text, Some(&text));
        let _ = translated(&text);
    }

    #[test]
    fn damaged_models_are_answered(at in 0..WIPER.len(), length in 0..12_usize, patch in "[-\\[\\]{}\",:0-9a-z\\\\]{0,6}") {
        let end = (at + length).min(WIPER.len());
        let mut model = WIPER.to_owned();
        model.replace_range(at..end, &patch);
        imported(&model, Some(TIMES));
    }

    #[test]
    fn points_keep_their_bits(x in any::<f64>(), y in -1e3..1e3_f64) {
        prop_assume!(x.is_finite());
        let model = with_constraint(&format!(r#""type": "AbsoluteX", "body1": 1, "sP1": [{x:e}, {y}], "fun": "{y}""#));
        let text = imported(&model, None).text.expect("a text");
        let point = text.lines().find(|line| line.contains("point")).expect("a point");
        let (_, numbers) = point.split_once('(').expect("numbers");
        let numbers: Vec<f64> = numbers.trim_end_matches(')').split(", ").map(|number| {
            number.trim_end_matches(" m").parse().expect("a number")
        }).collect();
        prop_assert_eq!(numbers, vec![x + 0.0, y + 0.0]);
    }
}
