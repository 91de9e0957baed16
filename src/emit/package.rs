//! A mechanism as a whole crate: the Rust module with its manifest, its page, a test that holds it against the interpreter,
//! and a benchmark.
//!
//! What the interpreter computes is handed in; this room knows of no analysis.

use super::Unit;
use super::names::{Case, Namer, is_keyword};
use super::params::Params;
use super::rust::{self, Module};
use super::text::{lines, literal, one_line};
use crate::ir::Measure;
use std::fmt::Display;

/// The version of `libm` that the interpreter runs with; `Cargo.toml` pins the same.
const LIBM: &str = "0.2.16";

const MANIFEST: &str = include_str!("package/Cargo.toml.txt");
const LIB: &str = include_str!("package/lib.rs");
const PAGE: &str = include_str!("package/README.md.txt");
const TEST: &str = include_str!("package/reference.rs");
const BENCHMARK: &str = include_str!("package/steps.rs");

/// Names that a crate can have, but that would be mistaken for another one or that a system keeps for itself.
const TAKEN: &[&str] = &[
    "alloc",
    "aux",
    "build",
    "con",
    "core",
    "deps",
    "examples",
    "incremental",
    "libm",
    "nul",
    "prn",
    "proc_macro",
    "std",
    "test",
];

/// The motion as the interpreter has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Names of a row's columns.
    pub columns: Vec<String>,
    /// Rows of it, at least one: the first and the last, and some in between, in order (s, m, rad).
    pub rows: Vec<Vec<f64>>,
    /// Output times after the first, up to that of the last row.
    pub steps: u64,
    /// From one output time to the next (s).
    pub every: f64,
    /// Why it ends before the analysis does.
    pub stopped: Option<String>,
}

/// A file of a crate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Where it goes in the crate, with `/`.
    pub path: &'static str,
    /// What is in it; one of the first lines has [`MARK`].
    pub text: String,
}

/// What every file of a crate holds near its beginning, and by which it can be told from one that somebody wrote.
pub const MARK: &str = "ritten by mechc ";

/// The files of a crate, for a unit with its motion. It has the name of its folder, as cargo's own have; where that cannot be a
/// crate's, the next to it that can.
#[must_use]
pub fn package(unit: &Unit<'_>, reference: &Reference, folder: &str) -> Vec<File> {
    let Module { text: module, needs_libm } = rust::module(unit);
    let writer = Writer { unit, reference, name: crate_name(folder), needs_libm };
    vec![
        File { path: "Cargo.toml", text: writer.manifest() },
        File { path: "README.md", text: writer.page() },
        File { path: "src/lib.rs", text: writer.filled(LIB, &[]) },
        File { path: "src/mechanism.rs", text: module },
        File { path: "tests/reference.rs", text: writer.test() },
        File { path: "benches/steps.rs", text: writer.benchmark() },
    ]
}

/// A valid name of a crate, out of a folder's: in small letters, as crates are named.
fn crate_name(folder: &str) -> String {
    let is_part = |part: &str| part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let may_stay = folder.starts_with(|c: char| c.is_ascii_alphabetic()) && folder.split('-').all(is_part);
    let wanted = if may_stay { folder.to_lowercase() } else { Namer::default().snake(folder) };
    let plain = wanted.trim_end_matches('_');
    let is_taken = TAKEN.contains(&plain.replace('-', "_").as_str());
    if is_keyword(plain) || is_taken { format!("{plain}_mechanism") } else { wanted }
}

/// What a page says of the crate that some modules ask for.
const WITH_LIBM: &str = "It asks for the crate `libm`, for
elementary functions with the same bits on every platform. Where cargo does not have that yet, `cargo fetch` gets it, once.";

/// What holds `follow` against `step`. Positions alone: at an edge of an input's formula the rates have two sides.
const FOLLOW: &str = "#[test]
fn to_follow_what_the_text_says_is_to_step() -> Result<(), Error> {
    let params = $params;
    let mut state = assemble(&params)?;
    for [t, ..] in ROWS {
        step(t, &mut state)?;
        let mut led = state.clone();
        follow(&Inputs::at(t, &params), &mut led)?;
        for (a, b) in led.q().iter().zip(state.q()) {
            let is_same = (a - b).abs() <= 1e-9 * (1.0 + b.abs());
            assert!(is_same, \"{a:?} is not {b:?} at {t} s\");
        }
    }
    Ok(())
}

";

/// What a page says of inputs.
const INPUTS: &str = "Each is a `Signal`: its `value`, its `rate` and its `acceleration`, in SI. `step` takes what the text's formulas say of
them, `follow` what it is given; after an error the state is as it was. Where formulas hold the time too, it is a plain number `t`.
";

struct Writer<'w> {
    unit: &'w Unit<'w>,
    reference: &'w Reference,
    /// The crate's.
    name: String,
    needs_libm: bool,
}

impl Writer<'_> {
    /// A template with its places filled: those that several have, and more.
    fn filled(&self, template: &str, more: &[(&str, String)]) -> String {
        let system = &self.unit.system;
        let version = env!("CARGO_PKG_VERSION");
        let shared = [
            ("package", self.name.clone()),
            // what it is called in code
            ("library", self.name.replace('-', "_")),
            ("mechanism", system.name.clone()),
            ("mark", format!("W{MARK}{version} from `{}`.", one_line(self.unit.file))),
            ("params", if system.params.is_empty() { "Params" } else { "Params::default()" }.to_owned()),
        ];
        let mut pieces = template.split('$');
        let mut text = pieces.next().unwrap_or_default().to_owned();
        // each place once, so that what is filled in is never taken for a place
        for piece in pieces {
            let end = piece.find(|c: char| !c.is_ascii_lowercase()).unwrap_or(piece.len());
            let (place, rest) = piece.split_at(end);
            let found = shared.iter().chain(more).find(|(name, _)| *name == place);
            debug_assert!(found.is_some(), "nothing is known for `{place}`");
            text += found.map_or("", |(_, value)| value);
            text += rest;
        }
        text
    }

    fn manifest(&self) -> String {
        let dependencies = if self.needs_libm {
            format!("# The very version that mechc computes with: the same bits.\nlibm = \"={LIBM}\"\n")
        } else {
            String::new()
        };
        self.filled(MANIFEST, &[("dependencies", dependencies)])
    }

    fn test(&self) -> String {
        let Reference { columns, rows, .. } = self.reference;
        let names: Vec<String> = columns.iter().map(|name| format!("{name:?}")).collect();
        let row = |row: &Vec<f64>| {
            let values: Vec<String> = row.iter().copied().map(literal).collect();
            format!("    [\n{}    ],\n", lines(&values, "    "))
        };
        let is_followed = self.unit.following.is_some();
        let (uses, follow) = if is_followed { ("Inputs, ", FOLLOW) } else { ("", "") };
        let more_uses = if is_followed { ", follow" } else { "" };
        let more = [
            ("uses", uses.to_owned()),
            ("more", more_uses.to_owned()),
            ("follow", self.filled(follow, &[])),
            ("names", lines(&names, "")),
            ("count", rows.len().to_string()),
            ("rows", rows.iter().map(row).collect()),
        ];
        self.filled(TEST, &more)
    }

    fn benchmark(&self) -> String {
        // without a step it measures what going nowhere costs
        let steps = self.reference.steps.clamp(1, u64::from(u32::MAX));
        let more = [
            ("steps", steps.to_string()),
            ("every", literal(self.reference.every)),
            ("last", literal(self.times().last().copied().unwrap_or_default())),
        ];
        self.filled(BENCHMARK, &more)
    }

    /// The times of the rows (s).
    fn times(&self) -> Vec<f64> {
        self.reference.rows.iter().filter_map(|row| row.first().copied()).collect()
    }

    fn page(&self) -> String {
        let stopped = self.reference.stopped.as_deref();
        let end = stopped.map(|why| format!("\nThe motion ends before the file's analysis does: {}.", in_prose(why)));
        let needs = if self.needs_libm { WITH_LIBM } else { "It asks for no other crate." };
        let (imports, shown) = self.shown();
        let times = self.times();
        let some = match times.as_slice() {
            [first, .., last] => vec![*first, times[times.len() / 2], *last],
            few => few.to_vec(),
        };
        let some: Vec<String> = some.into_iter().map(literal).collect();
        let more = [
            ("imports", imports.to_owned()),
            ("times", some.join(", ")),
            ("shown", shown),
            ("needs", needs.to_owned()),
            ("calls", self.calls()),
            ("parameters", self.parameters() + &self.inputs()),
            ("bodies", self.bodies()),
            ("coordinates", self.coordinates()),
            ("measures", self.measures()),
            ("end", end.unwrap_or_default()),
        ];
        self.filled(PAGE, &more)
    }

    /// What the example prints, and what it needs for it.
    fn shown(&self) -> (&'static str, String) {
        let system = self.unit.system;
        let names = Case::Constant.names(system.measures.iter().map(|of| of.name.as_str()));
        if let Some(name) = names.first() {
            return ("Params, assemble, measure, step", format!("state.measures().values[measure::{name}]"));
        }
        if let Some(name) = Case::Camel.names(system.bodies.iter().map(|body| body.name.as_str())).first() {
            return ("Body, Params, assemble, step", format!("state.pose(Body::{name})"));
        }
        ("Params, assemble, step", "state.q()".to_owned())
    }

    /// What can be asked of a state, depending on what there is.
    fn calls(&self) -> String {
        let system = self.unit.system;
        let mut text = String::new();
        if !system.bodies.is_empty() {
            text += "| `state.pose(body)`, `velocity(body)`, `acceleration(body)` | those of a body, as `x`, `y` and `phi` |\n";
        }
        if !system.measures.is_empty() {
            text += "| `state.measures()` | the measures with their first and second time derivatives |\n";
        }
        if self.unit.following.is_some() {
            text += "| `follow(&inputs, &mut state)` | leads a state to `Inputs`, along the straight line between them; `follow_within` in so many steps at most |\n";
            text += "| `Inputs::at(t, &params)`, `state.inputs()` | what the text's formulas say at a time; where a state is |\n";
            text += "| `influence(&state)` | the derivatives of the coordinates by each input, by the numbers in `input` |\n";
        }
        if self.unit.motion.as_ref().is_some_and(|motion| motion.sensitive.is_some()) {
            text += "| `sensitivity(&params, &state)` | those by each parameter, by the numbers in `param` |\n";
        }
        if let Some(lanes) = self.unit.lanes {
            text += &format!(
                "| `lanes::assemble`, `lanes::step_each` | the same for {lanes} variants or times at once |\n"
            );
        }
        text
    }

    fn parameters(&self) -> String {
        let params = &self.unit.system.params;
        let Some(first) = params.first() else {
            return "The mechanism has none: `assemble(&Params)`.\n".to_owned();
        };
        let names = Params::new(self.unit.system).paths;
        let rows = params.iter().zip(&names).map(|(param, name)| {
            [format!("`{name}`"), format!("`{}`", param.name), unit(&param.unit()), literal(param.value)]
        });
        let rows: String = rows.map(|cells| line(&cells)).collect();
        let (field, value) = (&names[0], literal(first.value));
        let sets = if field.contains('.') {
            format!("`let mut params = Params::default(); params.{field} = {value};`")
        } else {
            format!("`Params {{ {field}: {value}, ..Params::default() }}`")
        };
        format!(
            "Those of the file by default; {sets} sets one.\n\n\
             | field of `Params` | parameter | unit | default |\n| --- | --- | --- | --- |\n{rows}"
        )
    }

    /// The fields of `Inputs`; nothing where there are none.
    fn inputs(&self) -> String {
        let inputs = &self.unit.system.inputs;
        if self.unit.following.is_none() {
            return String::new();
        }
        let names = Case::Snake.names_of_inputs(inputs);
        let rows: String = inputs
            .iter()
            .zip(names)
            .map(|(input, name)| line(&[format!("`{name}`"), format!("`{}`", input.name), unit(&input.unit)]))
            .collect();
        format!("\n## Inputs\n\n{INPUTS}\n| field of `Inputs` | input | unit |\n| --- | --- | --- |\n{rows}")
    }

    fn bodies(&self) -> String {
        let bodies = &self.unit.system.bodies;
        if bodies.is_empty() {
            return String::new();
        }
        let names = Case::Camel.names(bodies.iter().map(|body| body.name.as_str()));
        let rows: String = bodies
            .iter()
            .zip(names)
            .map(|(body, name)| line(&[format!("`Body::{name}`"), format!("`{}`", body.name)]))
            .collect();
        format!("## Bodies\n\n| name | body |\n| --- | --- |\n{rows}\n")
    }

    fn coordinates(&self) -> String {
        let coordinates = &self.unit.system.coordinates;
        let names = Case::Constant.names(coordinates.iter().map(|coordinate| coordinate.name.as_str()));
        let rows = coordinates.iter().zip(names).map(|(coordinate, name)| {
            let index = format!("`coordinate::{name}`");
            [index, format!("`{}`", coordinate.name), unit(coordinate.kind.unit())]
        });
        rows.map(|cells| line(&cells)).collect()
    }

    fn measures(&self) -> String {
        let measures = &self.unit.system.measures;
        if measures.is_empty() {
            return String::new();
        }
        // those of each module, by measure
        let indices = |module: &str, has: fn(&Measure) -> bool| {
            let mut names =
                Case::Constant.names(measures.iter().filter(|of| has(of)).map(|of| of.name.as_str())).into_iter();
            let mut index = || names.next().map_or_else(String::new, |name| format!("`{module}::{name}`"));
            measures.iter().map(|of| if has(of) { index() } else { String::new() }).collect::<Vec<String>>()
        };
        let values = indices("measure", |_| true);
        let rates = indices("measure_rate", |of| of.first.is_some());
        let accelerations = indices("measure_acceleration", |of| of.second.is_some());
        let mut rows = String::new();
        for (k, measure) in measures.iter().enumerate() {
            let [value, rate, acceleration] = [&values, &rates, &accelerations].map(|list| list[k].clone());
            rows += &line(&[format!("`{}`", measure.name), unit(&measure.units.si), value, rate, acceleration]);
        }
        format!(
            "## Measures\n\n`values`, `rates` and `accelerations` of `state.measures()`, by these indices. They are in SI, whatever \
             unit a table has them in:\n\n| measure | unit | value | first derivative | second derivative |\n\
             | --- | --- | --- | --- | --- |\n{rows}\n"
        )
    }
}

/// A message as a part of a page: its names stay in backticks.
fn in_prose(message: &str) -> String {
    message.split('`').map(one_line).collect::<Vec<String>>().join("`")
}

/// A unit as a reader wants it.
fn unit(unit: &str) -> String {
    if matches!(unit, "" | "1") { "a pure number".to_owned() } else { unit.to_owned() }
}

/// A line of a table.
fn line<T: Display>(cells: &[T]) -> String {
    let cells: Vec<String> = cells.iter().map(ToString::to_string).collect();
    format!("| {} |\n", cells.join(" | "))
}

#[cfg(test)]
mod tests {
    use super::{LIBM, PAGE, crate_name};

    #[test]
    fn names_of_crates_are_valid() {
        let cases = [
            ("slider_crank", "slider_crank"),
            ("Peaucellier", "peaucellier"),
            ("é", "u00e9"),
            ("type", "type_mechanism"),
            ("Self", "self_mechanism"),
            ("core", "core_mechanism"),
            ("_", "unnamed"),
            ("", "unnamed"),
            ("_3rpr", "n3rpr"),
            ("3rpr", "n3rpr"),
            ("ends_", "ends_"),
            ("type_", "type_mechanism"),
            ("slider-crank", "slider-crank"),
            ("four  bar (2)", "four_bar_u00282u0029"),
            ("proc-macro", "proc-macro_mechanism"),
            ("a__b", "a__b"),
            ("-x", "u002dx"),
        ];
        for (folder, name) in cases {
            assert_eq!(crate_name(folder), name);
        }
    }

    #[test]
    fn libm_is_the_one_that_is_used_here() {
        let pinned = format!("\nlibm = \"={LIBM}\"\n");
        assert!(include_str!("../../Cargo.toml").contains(&pinned), "{pinned}");
    }

    #[test]
    fn the_page_has_every_error() {
        let state = include_str!("runtime/error.rs");
        let arms = state.lines().filter_map(|line| line.trim().strip_prefix("Error::")?.split_once(" => \""));
        let mut count = 0;
        for (error, text) in arms {
            let text = text.trim_end_matches("\",");
            assert!(PAGE.contains(&format!("| `Error::{error}` | {text}")), "{error}: {text}");
            count += 1;
        }
        assert!(count >= 4, "{count} errors");
    }
}
