//! Deeply nested texts and all stages that process them: each must work with a small stack on every platform.

use mechc::{
    Cancel, Choice, Code, Color, Compiled, Diagnostics, Format, Memory, Parsed, Redundant, RunOptions, RustOptions,
    Sources, TableFormat, TableWriter, Times, import_model, render,
};

/// A text that is nested as deeply as possible in one way.
pub struct Deep {
    pub name: &'static str,
    pub text: String,
    /// True for a model file of another program.
    pub is_foreign: bool,
}

/// Number of levels that a text may have; the outermost construct sometimes takes one of them.
const LEVELS: usize = 195;

/// Length of a chain: far more than the frames of any stack.
const MEMBERS: usize = if cfg!(debug_assertions) { 1_500 } else { 3_000 };

/// Returns a text for each way of nesting.
pub fn deep_texts() -> Vec<Deep> {
    let nested = |open: &str, inner: &str, close: &str, levels: usize| {
        format!("{}{inner}{}", open.repeat(levels), close.repeat(levels))
    };
    let drivers = [
        ("parentheses", nested("(", "t", ")", LEVELS)),
        ("sums and products in parentheses", nested("1 / (2 + 1 * (", "t", "))", LEVELS / 2)),
        ("calls", nested("sin(", "t", ")", LEVELS)),
        ("calls of several arguments", nested("1 / max(1, 2 - atan2(1 + t, ", "t", "))", LEVELS / 2)),
        ("signs", nested("-(", "t", ")", LEVELS / 2)),
        ("exponents", format!("t + {}2", "1.01^".repeat(LEVELS))),
        ("branches", nested("if t < 1 then (", "t", ") else 1", LEVELS / 2)),
        ("last branches", format!("{}t{}", "if t < -1 then 1 else 1 * (".repeat(LEVELS / 2), ")".repeat(LEVELS / 2))),
        ("conditions", nested("(if t < ", "t", " then t else 2 * t)", LEVELS / 2)),
        ("negated conditions", format!("if {}(t < 3) then t else 1", "not ".repeat(LEVELS))),
        (
            "joined conditions",
            format!("if {} then t else 1", nested("t < 2 and (t < 3 or (", "t < 4", "))", LEVELS / 2)),
        ),
        ("a long sum", format!("t{}", " + sin(t)".repeat(MEMBERS))),
        ("a long sum of others", joined(0..MEMBERS, |k| format!("sin({k} * t) / {MEMBERS} + ")) + "t"),
        ("a long product", format!("t{}", " * (1 + t / 1e9) / (1 + t / 1e9)".repeat(MEMBERS))),
        ("a long choice", joined(0..MEMBERS, |k| format!("if t < -{k} then {k} else ")) + "t"),
        ("a long list of arguments", format!("min(t{})", ", 3 + t".repeat(MEMBERS))),
        ("a long polynomial", format!("poly(t, 0{})", ", 0.001".repeat(MEMBERS))),
    ];
    let mut deepest: Vec<Deep> =
        drivers.into_iter().map(|(name, driver)| Deep { name, text: driven("", &driver), is_foreign: false }).collect();
    let own = |name, text| Deep { name, text, is_foreign: false };
    deepest.push(own("functions", driven(&chain("fn f", "(u)", "u", |before| format!("f{before}(u + 1e-9)")), "f(t)")));
    let sines = chain("fn f", "(u)", "u", |before| format!("sin(f{before}(u)) + u"));
    deepest.push(own("functions of functions", driven(&sines, "f(t)")));
    let outwards = chain("fn f", "(u)", "u", |before| format!("f{before}(cos(u) * u)"));
    deepest.push(own("functions of formulas", driven(&outwards, "f(t)")));
    let branching = chain("fn f", "(u)", "u", |before| format!("if u < 1 then f{before}(u + 1e-9) else f{before}(u)"));
    deepest.push(own("functions with branches", driven(&branching, "f(t)")));
    let deep =
        chain("fn f", "(u)", "u", |before| format!("{}f{before}(u + 1e-9){}", "(1 * ".repeat(99), ")".repeat(99)));
    deepest.push(own("deep functions", driven(&deep, "f(t)")));
    deepest
        .push(own("params", driven(&chain("param f", "", "0.5", |before| format!("cos(f{before}) + 1e-3")), "f * t")));
    let measures = chain_of(500, "measure f", "", "angle(bar)", |before| format!("sin(f{before}) + 1"));
    deepest.push(own("measures", driven(&measures, "t")));
    deepest.push(Deep {
        name: "a foreign formula",
        text: foreign(&nested("sin(", "t", ")", LEVELS)),
        is_foreign: true,
    });
    deepest.push(own("parts in parts", parts_in_parts(32)));
    let signs = format!("{}t", "-".repeat(LEVELS));
    deepest.push(Deep { name: "foreign signs", text: foreign(&signs), is_foreign: true });
    deepest
}

/// Returns mechanisms that are parts of each other; each measures the inner one and passes its input on.
fn parts_in_parts(levels: usize) -> String {
    let outer = |level: usize| {
        let inner = level + 1;
        let first = if level == 0 { "input turn = 2 * t" } else { "input turn = t" };
        format!(
            "mechanism m{level} {{ {first} part a: m{inner}(turn = turn) at (1, 0, 0.1) mirrored measure x{level} = a.x{inner} + 2 * angle(a.ground) }}\n"
        )
    };
    let last = format!(
        "mechanism m{levels} {{ input turn = t body b {{ point O = (0, 0) point P = (1, 0) }} joint j: revolute((0, 0), b.O) \
         driver d: rotation(j) = turn measure x{levels} = x(b.P) }}\n"
    );
    (0..levels).map(outer).collect::<String>() + &last
}

/// Returns a chain of declarations, each of which uses the one before; the last is `f`.
fn chain(word: &str, argument: &str, first: &str, next: impl Fn(usize) -> String) -> String {
    chain_of(MEMBERS, word, argument, first, next)
}

fn chain_of(members: usize, word: &str, argument: &str, first: &str, next: impl Fn(usize) -> String) -> String {
    let list = joined(1..members, |k| format!("{word}{k}{argument} = {}\n", next(k - 1)));
    format!("{word}0{argument} = {first}\n{list}{word}{argument} = {}\n", next(members - 1))
}

fn joined(members: std::ops::Range<usize>, each: impl Fn(usize) -> String) -> String {
    members.map(each).collect::<Vec<_>>().concat()
}

fn driven(declarations: &str, driver: &str) -> String {
    format!(
        "mechanism pendulum {{
            {declarations}
            body bar {{ point O = (0, 0) }}
            joint pin: revolute((0, 0), bar.O)
            driver motor: rotation(pin) = {driver}
            analysis from 0 to 0.2 every 0.1
        }}"
    )
}

fn foreign(formula: &str) -> String {
    format!(
        r#"{{"name": "pendulum", "bodies": [{{"name": "bar", "q0": [0, 0, 0]}}], "constraints": [
            {{"name": "x", "type": "AbsoluteX", "body1": 1, "sP1": [0, 0], "fun": "0"}},
            {{"name": "y", "type": "AbsoluteY", "body1": 1, "sP1": [0, 0], "fun": "0"}},
            {{"name": "motor", "type": "AbsoluteAngle", "body1": 1, "fun": "{formula}"}}
        ]}}"#
    )
}

/// Runs all stages on a text. Returns its diagnostics, or its table and the sizes of all other outputs.
pub fn run_all_stages(deep: &Deep) -> Result<String, String> {
    let text = if deep.is_foreign { translated(deep)? } else { deep.text.clone() };
    let parsed = Parsed::new(deep.name, &text);
    let (made, sources) = ways(&parsed);
    made.map_err(|said| in_words(&said, &sources))
}

fn in_words(said: &Diagnostics, sources: &Sources) -> String {
    said.iter().map(|one| render(one, sources, Format::Human, Color::Never)).collect()
}

fn translated(deep: &Deep) -> Result<String, String> {
    let mut sources = Sources::default();
    let file = sources.add(deep.name, deep.text.as_str());
    let (text, said) = import_model(file, None, &sources);
    text.ok_or_else(|| in_words(&said, &sources))
}

fn ways(parsed: &Parsed) -> (Result<String, Diagnostics>, Sources) {
    let checked = parsed.check(&Choice::default(), &Memory::default());
    let sources = checked.sources().clone();
    let (Some(model), Some(equations)) = (checked.model_text(), checked.equations_text()) else {
        return (Err(checked.diagnostics().clone()), sources);
    };
    let (compiled, said) = checked.compile(Redundant::Refused, &Cancel::default());
    let Some(compiled) = compiled else { return (Err(said), sources) };
    let (emitted, said) = compiled.rust(&RustOptions::new("deep"));
    let is_too_large = said.iter().any(|diagnostic| diagnostic.code == Code::E0706);
    let Some(emitted) = emitted.or_else(|| is_too_large.then(String::new)) else { return (Err(said), sources) };
    let (latex, json) = (compiled.latex("deep"), compiled.json("deep"));
    let formatted = parsed.formatted().unwrap_or_default();
    let sizes = [&formatted, &model, &equations, &emitted, &latex, &json].map(String::len);
    (table(&compiled).map(|table| format!("{table}\n{sizes:?}\n")), sources)
}

/// Returns the rows of a mechanism's own analysis.
pub fn table(compiled: &Compiled) -> Result<String, Diagnostics> {
    let [from, to, every] = compiled.analysis().unwrap_or([0.0, 1.0, 0.1]);
    let times = Times::grid(from, to, every).unwrap_or_else(|| Times::listed(from, vec![from]));
    let (run, said) = compiled.run(&times, &RunOptions::default());
    let rows = run.ok_or(said)?.collect::<Result<Vec<Vec<f64>>, _>>().map_err(|why| why.diagnostics)?;
    // writing to a vector cannot fail
    let (mut text, units) = (Vec::new(), compiled.units());
    let writer = TableWriter::new(&mut text, TableFormat::Csv, &compiled.columns(), &[]).and_then(|mut writer| {
        rows.iter().try_for_each(|row| {
            let printed: Vec<f64> = units.iter().zip(row).map(|(unit, value)| unit.printed(*value)).collect();
            writer.row(&printed)
        })?;
        writer.finish().map(|_| ())
    });
    debug_assert!(writer.is_ok());
    Ok(String::from_utf8_lossy(&text).into_owned())
}
