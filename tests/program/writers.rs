//! The constraint system as LaTeX and as JSON: what is written keeps its promises, and holds the same formulas.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::float_cmp)] // a test fails by panicking

use crate::support::formula_reader::{Names, parse, read};
use crate::support::random::Random;
use crate::support::tex::Meaning;
use crate::support::{compile_number, compile_with_forces, compiled, files, mechanisms, stem};
use assert_cmd::Command;
use mechc::Compiled;
use mechc_emit as emit;
use mechc_expr::{ExprId, Graph, Node, Symbol, TableId};
use mechc_ir::{ConstraintSystem, Mechanics};
use serde_json::Value;
use std::cell::RefCell;
use std::collections::HashMap;
use std::fs;

struct Emitted {
    name: String,
    compiled: Compiled,
}

/// Examples, reference cases and stages, each mechanism of theirs.
fn all() -> Vec<Emitted> {
    let paths = ["examples", "tests/cases", "tests/forces", "tests/stages", "tests/following"]
        .map(|folder| files(folder, "mech"));
    let paths = paths.concat();
    let mut list = Vec::new();
    for path in paths {
        let text = fs::read_to_string(&path).expect("a text");
        for number in 0..mechanisms(&text).len() {
            let compiled = compile_with_forces(&path, &text, number).or_else(|| compile_number(&path, &text, number).0);
            let folder = stem(path.parent().expect("a folder"));
            let name = format!("{folder}/{}", stem(&path));
            // derivatives by inputs and parameters are for `run` and code
            let is_wanted = |compiled: &Compiled| compiled.inside().0.system().variations().is_empty();
            list.extend(compiled.filter(is_wanted).map(|compiled| Emitted { name, compiled }));
        }
    }
    assert!(list.len() >= 75, "{} systems", list.len());
    list
}

fn written(name: &str, text: &str) -> (String, String) {
    let (compiled, file) = (compiled(name, text), format!("{name}.mech"));
    (compiled.latex(&file), compiled.json(&file))
}

#[test]
fn goldens_match_emission() {
    for name in ["everything", "odd_names", "slider_crank", "tables"] {
        let text = fs::read_to_string(format!("tests/stages/{name}/input.mech")).expect("a text");
        let (latex, json) = written(name, &text);
        for (ending, emitted) in [("tex", latex), ("json", json)] {
            let path = format!("tests/emitted/{name}.{ending}");
            if std::env::var_os("UPDATE_GOLDENS").is_some() {
                fs::write(&path, &emitted).expect("written");
            }
            let golden = fs::read_to_string(&path).expect("a golden");
            assert!(golden == emitted, "{path} is not what is emitted now; UPDATE_GOLDENS=1 cargo test writes it");
        }
    }
}

/// The keys of an object, in order, and what kind of value each has.
const LAYOUT: &[(&str, &[(&str, &str)])] = &[
    ("params", &[("name", "text"), ("value", "number"), ("unit", "text")]),
    (
        "inputs",
        &[
            ("name", "text"),
            ("line", "count"),
            ("unit", "text"),
            ("value", "text"),
            ("rate", "text"),
            ("acceleration", "text"),
        ],
    ),
    (
        "tables",
        &[("name", "text"), ("periodic", "flag"), ("knots", "list"), ("values", "list"), ("coefficients", "list")],
    ),
    ("bodies", &[("name", "text"), ("line", "count")]),
    (
        "coordinates",
        &[
            ("name", "text"),
            ("owner", "object"),
            ("kind", "text"),
            ("unit", "text"),
            ("scale", "number"),
            ("estimate", "text"),
        ],
    ),
    ("declarations", &[("name", "text"), ("kind", "text"), ("joint", "text?"), ("rows", "count"), ("line", "count")]),
    ("terms", &[("name", "text"), ("value", "text")]),
    ("rows", &[("name", "text"), ("declaration", "count"), ("unit", "text"), ("phi", "text")]),
    ("phi_q", &[("row", "count"), ("column", "count"), ("value", "text")]),
    ("mass_matrix", &[("row", "count"), ("column", "count"), ("value", "text")]),
    ("reactions", &[("name", "text"), ("line", "count"), ("unit", "text"), ("value", "text")]),
    (
        "measures",
        &[
            ("name", "text"),
            ("line", "count"),
            ("unit", "text"),
            ("value", "text"),
            ("first", "text?"),
            ("second", "text?"),
        ],
    ),
    ("conditions", &[("owner", "text"), ("kind", "text"), ("table", "text?"), ("positive", "text")]),
    ("watches", &[("declaration", "count"), ("kind", "text"), ("value", "text")]),
    ("left_out", &[("declaration", "count"), ("unit", "text"), ("phi", "text")]),
];

const FIELDS: [&str; 23] = [
    "layout",
    "mechc",
    "mechanism",
    "file",
    "analysis",
    "params",
    "inputs",
    "tables",
    "bodies",
    "coordinates",
    "declarations",
    "terms",
    "rows",
    "phi_q",
    "nu",
    "gamma",
    "mass_matrix",
    "applied",
    "reactions",
    "measures",
    "conditions",
    "watches",
    "left_out",
];

fn is_of(kind: &str, value: &Value) -> bool {
    match kind {
        "text" => value.is_string(),
        "text?" => value.is_string() || value.is_null(),
        "number" => value.is_f64(),
        "count" => value.is_u64(),
        "flag" => value.is_boolean(),
        "list" => value.is_array(),
        _ => value.is_object(),
    }
}

fn list<'v>(object: &'v Value, key: &str) -> &'v [Value] {
    object[key].as_array().unwrap_or_else(|| panic!("no list `{key}`"))
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_else(|| panic!("{value} is no text"))
}

fn index(value: &Value) -> usize {
    usize::try_from(value.as_u64().expect("a count")).expect("a small one")
}

#[test]
fn json_layout_matches_its_documentation() {
    let page = fs::read_to_string("docs/emit-json.md").expect("the page");
    let schema: Value = serde_json::from_str(&fs::read_to_string("docs/emit-json.schema.json").unwrap()).expect("JSON");
    let keys = |value: &Value| -> Vec<String> { value.as_object().expect("an object").keys().cloned().collect() };
    assert_eq!(keys(&schema["properties"]), FIELDS);
    for (name, fields) in LAYOUT {
        let wanted: Vec<&str> = fields.iter().map(|(key, _)| *key).collect();
        assert_eq!(keys(&schema["properties"][name]["items"]["properties"]), wanted, "{name}");
        assert!(page.contains(&format!("`{name}`")), "{name} is not on the page");
        for (key, _) in *fields {
            assert!(page.contains(&format!("`{key}`")), "{name}.{key} is not on the page");
        }
    }
    for Emitted { name, compiled } in all() {
        let (determined, _) = compiled.inside();
        let json: Value = serde_json::from_str(&compiled.json("f.mech")).expect("JSON");
        // inputs and forces are told where there are any
        let has_inputs = !determined.system().inputs().is_empty();
        let has_forces = determined.system().forces().is_some();
        let is_there = |field: &str| match field {
            "inputs" => has_inputs,
            "mass_matrix" | "applied" | "reactions" => has_forces,
            _ => true,
        };
        let fields: Vec<&str> = FIELDS.iter().copied().filter(|field| is_there(field)).collect();
        assert_eq!(keys(&json), fields, "{name}");
        for (field, fields) in LAYOUT.iter().filter(|(field, _)| is_there(field)) {
            for item in list(&json, field) {
                assert_eq!(keys(item), fields.iter().map(|(key, _)| *key).collect::<Vec<_>>(), "{name}, {field}");
                for (key, kind) in *fields {
                    assert!(is_of(kind, &item[*key]), "{name}, {field}.{key}: {}", item[*key]);
                }
            }
        }
        counts_agree(&name, &json, determined.system());
    }
}

/// Lists have the lengths, and numbers point to what there is.
fn counts_agree(name: &str, json: &Value, system: &ConstraintSystem) {
    let length = |key: &str| list(json, key).len();
    let m = system.rows().len();
    assert_eq!([length("rows"), length("nu"), length("gamma"), length("coordinates")], [m; 4], "{name}");
    assert_eq!(length("phi_q"), system.phi_q().entries().len());
    let declared: usize = list(json, "declarations").iter().map(|item| index(&item["rows"])).sum();
    assert_eq!(declared, m, "{name}");
    for (k, entry) in list(json, "phi_q").iter().enumerate() {
        assert_eq!(index(&entry["row"]), system.phi_q().row_of(k));
        assert!(index(&entry["column"]) < m);
    }
    for row in list(json, "rows") {
        let declaration = &list(json, "declarations")[index(&row["declaration"])];
        assert!(text(&row["name"]).starts_with(text(&declaration["name"])));
    }
    for coordinate in list(json, "coordinates") {
        let owner = coordinate["owner"].as_object().expect("an owner");
        let (key, number) = owner.iter().next().expect("one key");
        let of = if key == "body" { "bodies" } else { "declarations" };
        let owner = text(&list(json, of)[index(number)]["name"]);
        assert!(text(&coordinate["name"]).starts_with(&format!("{owner}.")), "{name}: {coordinate}");
    }
    for table in list(json, "tables") {
        let pieces = list(table, "knots").len() - 1;
        assert_eq!(list(table, "values").len(), pieces + 1);
        assert!(list(table, "coefficients").iter().all(|list| list.as_array().expect("a list").len() == pieces));
    }
}

/// Names of a system and of the terms before, words with dots and primes under other names.
struct Known<'k> {
    words: &'k [String],
    symbols: &'k HashMap<String, ExprId>,
    tables: &'k HashMap<String, TableId>,
}

impl Known<'_> {
    fn whole<'w>(&'w self, word: &'w str) -> &'w str {
        word.strip_prefix("word_of_test_")
            .map_or(word, |number| &self.words[number.parse::<usize>().expect("a number")])
    }
}

impl Names for Known<'_> {
    fn symbol(&self, _: &mut Graph, word: &str) -> ExprId {
        let word = self.whole(word);
        *self.symbols.get(word).unwrap_or_else(|| panic!("what is `{word}`?"))
    }

    fn table(&self, word: &str) -> Option<(TableId, u8)> {
        let word = self.whole(word);
        let name = word.trim_end_matches('\'');
        self.tables.get(name).map(|&table| (table, u8::try_from(word.len() - name.len()).expect("a few")))
    }
}

/// The formula of a text. `crank.phi.d` and `lift''` are no words of the grammar, and are given others.
fn formula(
    graph: &mut Graph,
    text: &str,
    symbols: &HashMap<String, ExprId>,
    tables: &HashMap<String, TableId>,
) -> ExprId {
    let (mut plain, mut words) = (String::new(), Vec::new());
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        // the numbers of a copy are part of its name: `up[0].phi`
        let mut is_inside = false;
        let mut is_name = |c: char| {
            is_inside = c == '[' || is_inside && c != ']';
            is_inside || c == ']' || c.is_alphanumeric() || !c.is_ascii() || matches!(c, '_' | '.' | '\'')
        };
        let end = rest.find(|c| !is_name(c)).unwrap_or(rest.len()).max(first.len_utf8());
        let word = &rest[..end];
        if !first.is_ascii_digit() && word.contains(['.', '\'', '[']) {
            plain += &format!("word_of_test_{}", words.len());
            words.push(word.to_owned());
        } else {
            plain += word;
        }
        rest = &rest[end..];
    }
    read(graph, &parse(&plain), &Known { words: &words, symbols, tables })
}

#[test]
fn json_formulas_match_the_system() {
    for Emitted { name, compiled } in all() {
        let (determined, _) = compiled.inside();
        let mut system = determined.system().clone();
        let mechanics = system.mechanics();
        let json: Value = serde_json::from_str(&compiled.json("f.mech")).expect("JSON");
        let mut graph = system.graph().clone();
        let mut symbols: HashMap<String, ExprId> = HashMap::new();
        for (_, node) in system.graph().nodes() {
            if let Node::Symbol(symbol) = node {
                let id = graph.symbol(symbol);
                let word = match symbol {
                    Symbol::Time => "t".to_owned(),
                    Symbol::Multiplier(row) => format!("lambda[{row}]"),
                    symbol => system.symbol_name(symbol),
                };
                assert!(symbols.insert(word, id).is_none(), "{name}: two symbols of one name");
            }
        }
        let tables: HashMap<String, TableId> = system
            .graph()
            .nodes()
            .filter_map(|(_, node)| match node {
                Node::Table(table, ..) => Some((system.graph().tables()[table.index()].name.clone(), table)),
                _ => None,
            })
            .collect();
        for term in list(&json, "terms") {
            let id = formula(&mut graph, text(&term["value"]), &symbols, &tables);
            assert!(symbols.insert(text(&term["name"]).to_owned(), id).is_none(), "{name}: {term}");
        }
        let mut same = |value: &Value, id: ExprId| {
            let back = formula(&mut graph, text(value), &symbols, &tables);
            assert_eq!(back, id, "{name}: {value}");
        };
        for (k, row) in system.rows().iter().enumerate() {
            same(&json["rows"][k]["phi"], row.phi);
            same(&json["nu"][k], system.nu()[k]);
            same(&json["gamma"][k], system.gamma()[k]);
        }
        for (k, (_, id)) in system.phi_q().entries().iter().enumerate() {
            same(&json["phi_q"][k]["value"], *id);
        }
        if let Some(Mechanics { mass_matrix, applied }) = &mechanics {
            for (entry, (_, id)) in list(&json, "mass_matrix").iter().zip(mass_matrix.entries()) {
                same(&entry["value"], *id);
            }
            for (text, id) in list(&json, "applied").iter().zip(applied) {
                same(text, *id);
            }
            for (item, of) in list(&json, "reactions").iter().zip(system.reactions()) {
                same(&item["value"], of.value);
            }
        }
        for (k, coordinate) in system.coordinates().iter().enumerate() {
            same(&json["coordinates"][k]["estimate"], coordinate.estimate);
        }
        for (measure, item) in system.measures().iter().zip(list(&json, "measures")) {
            same(&item["value"], measure.value);
            for (key, derivative) in [("first", measure.first), ("second", measure.second)] {
                match derivative {
                    Some(id) => same(&item[key], id),
                    None => assert!(item[key].is_null()),
                }
            }
        }
        for (table, item) in system.graph().tables().iter().zip(list(&json, "tables")) {
            let columns = [&table.knots, &table.values].into_iter().chain(&table.coefficients);
            let texts = [&item["knots"], &item["values"]].into_iter().chain(list(item, "coefficients"));
            for (ids, texts) in columns.zip(texts) {
                for (id, text) in ids.iter().zip(texts.as_array().expect("a list")) {
                    same(text, *id);
                }
            }
        }
        for (condition, item) in system.conditions().iter().zip(list(&json, "conditions")) {
            same(&item["positive"], condition.positive);
        }
        for (watch, item) in system.monitors().iter().zip(list(&json, "watches")) {
            same(&item["value"], watch.value);
        }
        for (check, item) in system.checks().iter().zip(list(&json, "left_out")) {
            same(&item["phi"], check.phi);
        }
    }
}

/// Braces close, delimiters come in pairs, and there is no letter that pdflatex does not know.
fn is_sound(name: &str, document: &str) {
    assert!(document.is_ascii(), "{name} holds {:?}", document.chars().find(|c| !c.is_ascii()));
    let count = |what: &str| document.matches(what).count();
    for [open, close] in [
        [r"\left", r"\right"],
        [r"\begin{", r"\end{"],
        [r"\biggl", r"\biggr"],
        [r"\lvert", r"\rvert"],
        [r"\lfloor", r"\rfloor"],
    ] {
        assert_eq!(count(open), count(close), "{name}: {open} and {close}");
    }
    let mut depth = 0_i32;
    let mut before = ' ';
    for c in document.chars() {
        match c {
            '{' if before != '\\' => depth += 1,
            '}' if before != '\\' => depth -= 1,
            _ => {}
        }
        assert!(depth >= 0, "{name}");
        // the second of two is no escape
        before = if before == '\\' && c == '\\' { ' ' } else { c };
    }
    assert_eq!(depth, 0, "{name}");
    for bad in ["NaN", "inf}", "--", "+ -", "- -", "{}^", r"\frac{}"] {
        assert_eq!(count(bad), 0, "{name}: {bad}");
    }
}

#[test]
fn every_document_is_sound() {
    for Emitted { name, compiled } in all() {
        let (determined, _) = compiled.inside();
        let system = determined.system();
        let document = compiled.latex("a_b%c.mech");
        is_sound(&name, &document);
        for row in 1..=system.rows().len() {
            assert!(document.contains(&format!("\\Phi_{{{row}}}")), "{name}: no row {row}");
        }
        // a term is written out once, and none without need
        let mut number = 1;
        while document.contains(&format!("\\mathcal{{T}}_{{{number}}}")) {
            let written = document.matches(&format!("\\entry{{\\mathcal{{T}}_{{{number}}}}}")).count();
            assert_eq!(written, 1, "{name}: term {number}");
            number += 1;
        }
    }
}

/// The arguments of each `\entry` of a part of a document, the relation taken off.
fn entries(text: &str) -> impl Iterator<Item = (&str, &str)> + Clone {
    text.lines().filter_map(|line| line.strip_prefix(r"\entry{")).map(|line| {
        let (left, right) = line.split_once("}{").expect("two arguments");
        let right = right.strip_suffix('}').expect("an end");
        let right = right.strip_prefix('=').or_else(|| right.strip_prefix(r"\Leftrightarrow")).expect("a relation");
        (left, right.trim_start_matches(r"\nobreak "))
    })
}

fn section<'d>(document: &'d str, title: &str) -> &'d str {
    let begin = format!("\\subsection*{{{title}}}");
    let part = document.split_once(&begin).map_or("", |(_, part)| part);
    part.split(r"\subsection*").next().unwrap_or("")
}

/// What the symbols of a document stand for at a point.
fn symbols(document: &str, system: &ConstraintSystem, value: &dyn Fn(Symbol) -> f64) -> HashMap<String, f64> {
    let mut symbols = HashMap::from([("t".to_owned(), value(Symbol::Time))]);
    for (k, (name, _)) in entries(section(document, "Parameters")).enumerate() {
        assert!(symbols.insert(name.to_owned(), value(Symbol::Param(k as u32))).is_none(), "{name} twice");
    }
    let listed = section(document, "Coordinates").split("$q_").skip(1);
    for (index, text) in listed.enumerate() {
        let (_, text) = text.split_once(" = ").expect("a symbol");
        let (name, _) = text.split_once('$').expect("an end");
        let (letter, owner) = name.split_once('_').expect("an owner");
        for order in 0..=3 {
            let dots = "d".repeat(usize::from(order));
            let name = if order == 0 { name.to_owned() } else { format!("\\{dots}ot{{{letter}}}_{owner}") };
            let value = value(Symbol::Coordinate { index: index as u32, order });
            assert!(symbols.insert(name, value).is_none(), "two coordinates of one symbol");
        }
    }
    assert_eq!(symbols.len(), 1 + system.params().len() + 4 * system.coordinates().len());
    for row in 0..system.rows().len() {
        symbols.insert(format!("\\lambda_{{{}}}", row + 1), value(Symbol::Multiplier(row as u32)));
    }
    symbols
}

/// A number that is the same wherever it is made, in (-1, 1).
fn some_number(symbol: Symbol, seed: u64) -> f64 {
    let number = match symbol {
        Symbol::Coordinate { index, order } => 10 + 4 * u64::from(index) + u64::from(order),
        Symbol::Multiplier(row) => 100_000 + u64::from(row),
        _ => 1,
    };
    Random::new(number * 1000 + seed).between(-1.0, 1.0)
}

#[test]
fn typeset_formulas_match_the_system() {
    for Emitted { name, compiled } in all() {
        let (determined, _) = compiled.inside();
        for seed in 0..3 {
            values_agree(&name, determined.system(), seed);
        }
    }
    let text = disc("-(a - t)^2 / -(b * -t) * -3 - (if t < a then -(t - a) else b) / (-2) ^ 3 + 2^-t^2 * (t + b)^-2");
    values_agree("signs", compiled("disc", &text).inside().0.system(), 0);
}

fn values_agree(name: &str, system: &ConstraintSystem, seed: u64) {
    let mut system = system.clone();
    let mechanics = system.mechanics();
    let document = emit::latex(&system, mechanics.as_ref(), true, "f.mech");
    let value = |symbol: Symbol| match symbol {
        Symbol::Param(k) => system.params()[k as usize].value,
        symbol => some_number(symbol, seed),
    };
    let names: Vec<String> = entries(section(&document, "Tables")).map(|(name, _)| name.to_owned()).collect();
    let table = |name: &str, order: usize, x: f64| -> Option<f64> {
        let at = names.iter().position(|known| known == name)?;
        let mut nodes = system.graph().nodes();
        let table = nodes.find_map(|(_, node)| match node {
            Node::Table(table, ..) if table.index() == at => Some(table),
            _ => None,
        });
        let mut graph = system.graph().clone();
        let argument = graph.symbol(Symbol::Named(0));
        let id = graph.table(table?, u8::try_from(order).ok()?, argument);
        Some(graph.value(id, |symbol| if symbol == Symbol::Named(0) { x } else { value(symbol) }))
    };
    let terms = entries(&document).filter(|(name, _)| name.starts_with(r"\mathcal"));
    let meaning = Meaning {
        symbols: symbols(&document, &system, &value),
        terms: terms.map(|(name, text)| (name.to_owned(), text.to_owned())).collect(),
        table: &table,
        known: RefCell::default(),
    };
    let agrees = |what: &str, text: &str, id: ExprId| {
        let (got, wanted) = (meaning.value(text), system.graph().value(id, value));
        let is_same = (got - wanted).abs() <= 1e-8 * (1.0 + wanted.abs()) || !wanted.is_finite();
        assert!(is_same, "{name}, {what}: {got} for {wanted}, {text}");
    };
    let equations = section(&document, "Equations");
    for (k, row) in system.rows().iter().enumerate() {
        let of = |letter: &str, id: ExprId| {
            let wanted = format!("{letter}_{{{}}}", k + 1);
            // some of the right sides that vanish stand in one equation
            match entries(equations).find(|(name, _)| *name == wanted) {
                Some((_, text)) if text.ends_with("= 0") => agrees(&wanted, "0", id),
                Some((_, text)) => agrees(&wanted, text, id),
                None => agrees(&wanted, "0", id),
            }
        };
        of(r"\Phi", row.phi);
        of(r"\nu", system.nu()[k]);
        of(r"\gamma", system.gamma()[k]);
        let mut cells = cells(equations, k + 1);
        for &(column, id) in system.phi_q().row(k) {
            let symbol = column_symbol(&document, column as usize);
            let text = cells.remove(symbol).unwrap_or_else(|| panic!("{name}: no column {symbol}"));
            agrees(symbol, text, id);
        }
        assert!(cells.values().all(|text| *text == "0"), "{name}: {cells:?}");
    }
    if let Some(mechanics) = &mechanics {
        forces_agree(&system, mechanics, section(&document, "Forces"), &agrees);
    }
    for (measure, (_, text)) in system
        .measures()
        .iter()
        .zip(entries(section(&document, "Measures")).filter(|(name, _)| !name.starts_with(r"\mathcal")))
    {
        agrees(&measure.name, text, measure.value);
    }
}

/// The entries of `M` and `Q` that do not vanish, and what joints exert.
fn forces_agree(
    system: &ConstraintSystem,
    Mechanics { mass_matrix, applied }: &Mechanics,
    section: &str,
    agrees: &dyn Fn(&str, &str, ExprId),
) {
    let typeset: HashMap<&str, &str> =
        entries(section).flat_map(|(names, text)| names.split(" = ").map(move |name| (name, text))).collect();
    let of = |name: &str, id: ExprId| agrees(name, typeset.get(name).copied().unwrap_or("0"), id);
    for row in 0..mass_matrix.rows() {
        for &(column, id) in mass_matrix.row(row) {
            of(&format!("M_{{{},{}}}", row + 1, column + 1), id);
        }
    }
    for (k, &id) in applied.iter().enumerate() {
        of(&format!("Q_{{{}}}", k + 1), id);
    }
    let texts = entries(section).filter(|(name, _)| name.starts_with(r"\text"));
    assert_eq!(texts.clone().count(), system.reactions().len());
    for (reaction, (_, text)) in system.reactions().iter().zip(texts) {
        agrees(&reaction.name, text, reaction.value);
    }
}

fn column_symbol(document: &str, column: usize) -> &str {
    let text = section(document, "Coordinates").split("$q_").nth(column + 1).expect("a coordinate");
    let (_, text) = text.split_once(" = ").expect("a symbol");
    text.split_once('$').expect("an end").0
}

/// The cells of a row of the Jacobian, by the symbols on top of their columns.
fn cells(equations: &str, row: usize) -> HashMap<&str, &str> {
    let mut cells = HashMap::new();
    for matrix in equations.split(r"\columns{").skip(1) {
        let mut lines = matrix.lines();
        let head = lines.next().expect("a head").trim_end_matches(r" \\ \hline");
        let begin = format!("\\row{{{row}}} & ");
        for line in lines.take_while(|line| *line != "}") {
            let line = line.trim_start_matches(r"\tall ").trim_end_matches(r" \\");
            if let Some(line) = line.strip_prefix(&begin) {
                cells.extend(head.split(" & ").skip(1).zip(line.split(" & ")));
            }
        }
    }
    cells
}

/// A disc that turns by a formula.
fn disc(formula: &str) -> String {
    format!(
        "mechanism disc {{ param a = 2 param b = 3 table lift = spline [(0, 0), (1, a)]
            ground {{ point O = (0, 0) }} body wheel {{ point O = (0, 0) }}
            joint axle: revolute(ground.O, wheel.O)
            driver motor: angle(wheel) = t
            measure it = {formula} }}"
    )
}

/// How a measure is typeset; terms in lines of their own.
fn typeset(formula: &str) -> String {
    let (document, _) = written("disc", &disc(formula));
    let (_, measures) = document.split_once(r"\subsection*{Measures}").expect("measures");
    let lines = measures.lines().filter_map(|line| line.strip_prefix(r"\entry{"));
    let lines: Vec<String> = lines
        .map(|line| {
            let (name, text) = line.split_once("}{").expect("two arguments");
            let text = text.strip_suffix('}').expect("an argument").replace(r"\nobreak ", " ");
            if name.contains("it") { text[2..].to_owned() } else { format!("{name} {text}") }
        })
        .collect();
    lines.join("; ").replace(r" \, ", " ")
}

#[test]
fn formulas_are_typeset_by_precedence() {
    let cases = [
        ("(a + b) * t", r"t (a + b)"),
        ("a - (b - t)", r"t + a - b"),
        ("-(a + b) * t", r"-t (a + b)"),
        ("a / (b * t)", r"\frac{a}{b t}"),
        ("a / b / t", r"\frac{a}{t b}"),
        ("a / (b / t)", r"\frac{a t}{b}"),
        ("(a + b) / (a - t)", r"\frac{a + b}{a - t}"),
        ("-a / b", r"-\frac{a}{b}"),
        ("sin(t)^2 + cos(t + a)^2", r"\sin^{2} t + \cos^{2}(a + t)"),
        ("sin(t)^-2", r"\frac{1}{\sin^{2} t}"),
        ("sin(t) * a * (t + b)", r"a (t + b) \sin t"),
        ("(-t)^3", r"-t^{3}"),
        ("(a + t)^2", r"(a + t)^{2}"),
        ("(a / b)^t", r"\left( \frac{a}{b} \right)^{t}"),
        ("2^(a + t)", r"2^{a + t}"),
        ("(a^t)^b", r"(a^{t})^{b}"),
        ("exp(t)^2", r"(\exp t)^{2}"),
        ("sqrt(t / a)", r"\sqrt{\frac{t}{a}}"),
        ("abs(t - a)", r"\lvert t - a\rvert "),
        ("max(a, min(b, t, 1), sqrt(t))", r"\max(a,\, \min(b,\, t,\, 1),\, \sqrt{t})"),
        ("hypot(t, a + b)", r"\sqrt{(a + b)^{2} + t^{2}}"),
        ("atan2(-t, a)", r"\operatorname{atan2}(-t,\, a)"),
        ("mod(t, a) - sign(t)", r"\operatorname{mod}(t,\, a) - \operatorname{sgn}(t)"),
        ("log10(t)^2 + ln(a * t) + acos(sin(t))", r"\log_{10}^{2} t + \ln(a t) + \arccos(\sin t)"),
        ("lift(t / 2)", r"\mathrm{lift}\left( \frac{t}{2} \right)"),
        ("angle(wheel) * der(der(angle(wheel)))", r"\ddot{\phi}_{\mathrm{wheel}} \phi_{\mathrm{wheel}}"),
        ("2 * pi * t / 3", r"\tfrac{2\pi}{3} t"),
        ("0.1 * t - 1e-9", r"0.1 t - 10^{-9}"),
        (
            "if t < 1 then a else if t <= 2 and not t == a or t > b then t else 0",
            r"\begin{cases} a & \text{if } t < 1 \\ t & \text{if } \mathcal{T}_{1} \\ 0 & \text{otherwise} \end{cases}; \mathcal{T}_{1} \Leftrightarrow (t \le 2\text{ and }\allowbreak \text{not }(t = a))\text{ or }\allowbreak b < t",
        ),
        (
            "1 + (if t < 1 then a else b)",
            r"1 + \mathcal{T}_{1}; \mathcal{T}_{1} = \begin{cases} a & \text{if } t < 1 \\ b & \text{otherwise} \end{cases}",
        ),
    ];
    let mut wrong = String::new();
    for (formula, wanted) in cases {
        let text = typeset(formula);
        is_sound(formula, &written("disc", &disc(formula)).0);
        if text != wanted {
            wrong += &format!("{formula}\n  is    {text}\n  wants {wanted}\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn shared_parts_are_written_once() {
    // each calls the one before twice: 2^40 parts, if they were written out
    let mut functions = "fn f0(u) = sin(u) + u ".to_owned();
    for k in 1..40 {
        functions += &format!("fn f{k}(u) = f{0}(u) * cos(f{0}(u)) + 1 / (2 + f{0}(u)) ", k - 1);
    }
    let text = disc("f39(t)").replace("param a", &format!("{functions} param a"));
    let (latex, json) = written("disc", &text);
    assert!(latex.len() < 40_000 && json.len() < 80_000, "{} and {} bytes", latex.len(), json.len());
    is_sound("f39", &latex);
    // the text of a whole part holds its operand twice
    let parts: Vec<String> =
        (1..40).map(|k| format!("fn f{k}(u) = f{0}(u) / 2 - mod(f{0}(u) / 2, 1) ", k - 1)).collect();
    let parts = parts.concat();
    let text = disc("f39(t)").replace("param a", &format!("fn f0(u) = 1000 * u {parts} param a"));
    let (latex, json) = written("disc", &text);
    assert!(latex.len() < 20_000 && json.len() < 20_000, "{} and {} bytes", latex.len(), json.len());
    // nesting, and a sum, as deep and as long as they may be
    let deep = format!("{}t{}", "sin(a + ".repeat(190), ")".repeat(190));
    let long: Vec<String> = (1..3000).map(|k| format!("sin({k} * t) / (a + {k})")).collect();
    for formula in [deep, long.join(" + "), long.join(" * ")] {
        let (latex, json) = written("disc", &disc(&formula));
        is_sound("deep or long", &latex);
        assert!(latex.len() < 400_000 && json.len() < 1_500_000, "{} and {} bytes", latex.len(), json.len());
    }
}

#[test]
fn format_follows_ending_or_option() {
    let folder = tempfile::tempdir().expect("a folder");
    let emitted = |name: &str, more: &[&str]| -> String {
        let out = folder.path().join(name);
        let output = Command::new(env!("CARGO_BIN_EXE_mechc"))
            .args(["emit", "examples/slider_crank.mech", "-o", &out.to_string_lossy()])
            .args(more)
            .output()
            .expect("it runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        fs::read_to_string(out).expect("written")
    };
    let [rust, latex, json] = ["a.rs", "a.TEX", "a.json"].map(|name| emitted(name, &[]));
    assert!(rust.starts_with("//! ") && latex.starts_with("% ") && json.starts_with('{'));
    assert_eq!(emitted("a", &[]), rust);
    assert_eq!(emitted("a.json", &["--format", "rust"]), rust);
    assert_eq!(emitted("a.rs", &["--format", "latex"]), latex);
    assert_eq!(emitted("a", &["--format", "json"]), json);
}
