//! A mechanism as a whole crate: the Rust module with its manifest, its page, a test that holds it against the interpreter,
//! and a benchmark.
//!
//! What the interpreter computes is handed in; this module knows no analysis.

use super::errors::ERRORS;
use super::names::{Case, Namer, is_keyword};
use super::params::Params;
use super::rust;
use super::text::{lines, literal, one_line, unit};
use super::{CrateFile, TranslationUnit, c};
use mechc_ir::Measure;
use std::fmt::Display;

/// Text near the beginning of every emitted file, which distinguishes it from a file written by hand.
pub const MARK: &str = "ritten by mechc ";

/// Files that only some crates have, as folder and ending of the name: an earlier emission may have left one there.
pub const NOT_IN_ALL: [(&str, &str); 2] = [("include", ".h"), ("src", "unsafe_c.rs")];

/// Version of `libm` that the interpreter uses; `Cargo.toml` pins the same.
const LIBM: &str = "0.2.16";

/// Valid names of crates that clash with standard crates, or that operating systems reserve.
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

/// Motion that the interpreter computed, as reference for the emitted test.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Names of a row's columns.
    pub columns: Vec<String>,
    /// Rows, at least one: the first, the last, and some in between, in order (s, m, rad).
    pub rows: Vec<Vec<f64>>,
    /// Forces of joints and drivers for each row; empty lists if there are no masses and loads.
    pub forces: Vec<Vec<f64>>,
    /// Output times after the first, up to that of the last row.
    pub steps: u64,
    /// Interval between output times (s).
    pub every: f64,
    /// Reason why the motion ends before the analysis, if it does.
    pub stopped: Option<String>,
}

/// Returns the files of a crate for a unit with its motion. The crate is named after its folder as with cargo, or by the closest valid
/// name.
#[must_use]
pub fn package(unit: &TranslationUnit<'_>, reference: &Reference, folder: &str) -> Vec<CrateFile> {
    let module = rust::module(unit);
    let name = crate_name(folder);
    let writer = Writer { unit, reference, library: name.replace('-', "_"), name, module: &module };
    let file = |path: &str, text: String| CrateFile { path: path.to_owned(), text };
    let mut files = vec![
        file("Cargo.toml", writer.manifest()),
        file("README.md", writer.page()),
        file("src/lib.rs", writer.library()),
        file("tests/reference.rs", writer.test()),
        file("benches/steps.rs", writer.benchmark()),
        file("examples/work.rs", writer.example()),
    ];
    if unit.for_c {
        files.extend(c::files(unit, &module, &writer.library, &writer.mark()));
    }
    files.push(file("src/mechanism.rs", module.text));
    files
}

/// Returns a valid name of a crate, in lower case, derived from the name of a folder.
fn crate_name(folder: &str) -> String {
    let is_part = |part: &str| part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let may_stay = folder.starts_with(|c: char| c.is_ascii_alphabetic()) && folder.split('-').all(is_part);
    let wanted = if may_stay { folder.to_lowercase() } else { Namer::default().snake(folder) };
    let plain = wanted.trim_end_matches('_');
    let is_taken = TAKEN.contains(&plain.replace('-', "_").as_str());
    if is_keyword(plain) || is_taken { format!("{plain}_mechanism") } else { wanted }
}

/// Paragraph of the README about `libm`.
const WITH_LIBM: &str = "It asks for the crate `libm`, for
elementary functions with the same bits on every platform. Where cargo does not have that yet, `cargo fetch` gets it, once.";

/// Lines of a manifest about libraries for C.
const KINDS: &str = "crate-type = [\"lib\", \"staticlib\", \"cdylib\"]\n";
const FEATURES: &str = "[features]
default = [\"std\"]
# Takes what a library for C asks for besides from the standard library; without it, it brings that along.
std = []

";
const ABORT: &str = "panic = \"abort\"

[profile.dev]
panic = \"abort\"
";

/// Additions to the module in a crate for C.
const STD: &str = "#[cfg(feature = \"std\")]\nextern crate std;\n\n";
const C: &str = "#[allow(unsafe_code)] // what C calls\n#[rustfmt::skip]\nmod unsafe_c;\n";

/// Code of the example that counts the work of inputs.
const WORK_OF_FOLLOW: &str = "    for change in [1e-3, 1.0, 3.0, 1e6] {
        let (mut state, mut work) = (before.clone(), Work::default());
        let mut inputs = Inputs::at(START_TIME, &PARAMS);
        SIGNALS
        let result = counted::follow(&inputs, &mut state, &mut work);
        println!(
            \"follow by {change}: {} of {MOST_WORK_TO_FOLLOW}, {result:?}\",
            work.evaluations
        );
    }
";

/// Paragraph of a page about inputs.
const INPUTS: &str = "Each is a `Signal`: its `value`, its `rate` and its `acceleration`, in SI. `step` takes what the text's formulas say of
them, `follow` what it is given. An input that changes by more than `state.largest_change()` is `TooFar` at once; `set_largest_change` sets that.
Where formulas hold the time too, it is a plain number `t`.
";

struct Writer<'w> {
    unit: &'w TranslationUnit<'w>,
    reference: &'w Reference,
    /// Name of the crate.
    name: String,
    /// Name of the crate in Rust code.
    library: String,
    module: &'w rust::Module,
}

impl Writer<'_> {
    /// Returns a line for the top of every file that marks it as emitted.
    fn mark(&self) -> String {
        format!("W{MARK}{} from `{}`.", env!("CARGO_PKG_VERSION"), one_line(self.unit.file))
    }

    /// Returns the expression for the parameters of the file.
    fn params(&self) -> &'static str {
        if self.unit.system.params().is_empty() { "Params" } else { "Params::default()" }
    }

    fn manifest(&self) -> String {
        let dependencies = if self.module.needs_libm {
            format!("# The very version that mechc computes with: the same bits.\nlibm = \"={LIBM}\"\n")
        } else {
            String::new()
        };
        let [kinds, features, abort] = if self.unit.for_c { [KINDS, FEATURES, ABORT] } else { [""; 3] };
        format!(
            include_str!("package/Cargo.toml.txt"),
            mark = self.mark(),
            package = self.name,
            mechanism = self.unit.system.name(),
            kinds = kinds,
            dependencies = dependencies,
            features = features,
            abort = abort,
        )
    }

    fn library(&self) -> String {
        let [unsafety, std, c] =
            if self.unit.for_c { ["#![deny(unsafe_code)]", STD, C] } else { ["#![forbid(unsafe_code)]", "", ""] };
        format!(include_str!("package/lib.rs.txt"), mark = self.mark(), unsafety = unsafety, std = std, c = c)
    }

    fn test(&self) -> String {
        let Reference { columns, rows, .. } = self.reference;
        let names: Vec<String> = columns.iter().map(|name| format!("{name:?}")).collect();
        let (has_inputs, has_forces) = (self.unit.following.is_some(), self.unit.has_forces());
        let uses = [if has_forces { "FORCES, " } else { "" }, if has_inputs { "Inputs, " } else { "" }].concat();
        let more = [if has_inputs { ", follow" } else { "" }, if has_forces { ", forces" } else { "" }].concat();
        format!(
            include_str!("package/reference.rs.txt"),
            mark = self.mark(),
            library = self.library,
            uses = uses,
            more = more,
            params = self.params(),
            follow = self.follows() + &self.exerts(),
            names = lines(&names, ""),
            count = rows.len(),
            rows = rows.iter().map(|row| array(row)).collect::<String>(),
        )
    }

    /// Returns the test that compares `follow` with `step`. Only positions: at an edge of an input's formula the rates have two sides.
    fn follows(&self) -> String {
        if self.unit.following.is_none() {
            return String::new();
        }
        format!(include_str!("package/follows.rs.txt"), params = self.params())
    }

    /// Returns the test that compares `forces` with the results of `run`; empty if there are none.
    fn exerts(&self) -> String {
        if !self.unit.has_forces() {
            return String::new();
        }
        format!(
            include_str!("package/exerts.rs.txt"),
            params = self.params(),
            count = self.reference.forces.len(),
            rows = self.reference.forces.iter().map(|row| array(row)).collect::<String>(),
        )
    }

    /// Returns the example that counts evaluations.
    fn example(&self) -> String {
        let (uses, follow) = if let Some(following) = &self.unit.following {
            let inputs = following.unit.system.inputs();
            let names = Case::Snake.names_of_inputs(inputs).into_iter().zip(inputs).filter(|(_, of)| !of.is_time());
            let shifts: Vec<String> = names.map(|(name, _)| format!("inputs.{name}.value += change;")).collect();
            let text = WORK_OF_FOLLOW.replace("PARAMS", self.params()).replace("SIGNALS", &shifts.join("\n        "));
            (", Inputs, MOST_WORK_TO_FOLLOW", text)
        } else {
            ("", String::new())
        };
        format!(
            include_str!("package/work.rs.txt"),
            mark = self.mark(),
            uses = imported(&self.library, &format!("Error{uses}, Params, START_TIME, Work, assemble, counted")),
            params = self.params(),
            follow = follow,
            steps = self.reference.steps.clamp(1, u64::from(u32::MAX)),
            every = literal(self.reference.every),
            last = literal(self.times().last().copied().unwrap_or_default()),
        )
    }

    /// Returns the text about the work and the memory of calls.
    fn work(&self) -> String {
        let bound = |name: &str| self.module.bounds.iter().find(|(of, _)| *of == name).map_or(0, |(_, bound)| *bound);
        let operations =
            |unit: &TranslationUnit<'_>| unit.motion.as_ref().map_or(0, |motion| motion.solver.instructions().len());
        let (bytes, of_step) = (8 * self.module.words, operations(self.unit));
        let mut rows = format!(
            "| an evaluation | about {of_step} operations, a few of them twice or three times; by pivoting, where digits get lost, several times that |\n\
             | `step`, mostly | 1 evaluation |\n\
             | `step`, at most | `MOST_WORK` = {} evaluations, in `MOST_STEPS` = {} steps |\n\
             | `assemble`, at most | `MOST_WORK_TO_ASSEMBLE` = {} evaluations |\n",
            bound("MOST_WORK"),
            bound("MOST_STEPS"),
            bound("MOST_WORK_TO_ASSEMBLE"),
        );
        if let Some(following) = &self.unit.following {
            rows += &format!(
                "| an evaluation of `follow` | about {} operations |\n\
                 | `follow`, mostly | 1 evaluation |\n\
                 | `follow`, at most | `MOST_WORK_TO_FOLLOW` = {} evaluations, in `MOST_STEPS_TO_FOLLOW` = {} steps |\n",
                operations(&following.unit),
                bound("MOST_WORK_TO_FOLLOW"),
                bound("MOST_STEPS_TO_FOLLOW"),
            );
        }
        rows + &format!(
            "| a state | {bytes} bytes |\n| the stack | about {} bytes, of a release on x86-64; `assemble` takes most |\n",
            6 * bytes + 2 * of_step
        )
    }

    fn benchmark(&self) -> String {
        format!(
            include_str!("package/steps.rs.txt"),
            mark = self.mark(),
            library = self.library,
            params = self.params(),
            // without a step it measures what going nowhere costs
            steps = self.reference.steps.clamp(1, u64::from(u32::MAX)),
            every = literal(self.reference.every),
            last = literal(self.times().last().copied().unwrap_or_default()),
        )
    }

    /// Returns the times of the rows (s).
    fn times(&self) -> Vec<f64> {
        self.reference.rows.iter().filter_map(|row| row.first().copied()).collect()
    }

    fn page(&self) -> String {
        let stopped = self.reference.stopped.as_deref();
        let end = stopped.map(|why| format!("\nThe motion ends before the file's analysis does: {}.", in_prose(why)));
        let needs = if self.module.needs_libm { WITH_LIBM } else { "It asks for no other crate." };
        let (imports, shown) = self.shown();
        let times = self.times();
        let some = match times.as_slice() {
            [first, .., last] => vec![*first, times[times.len() / 2], *last],
            few => few.to_vec(),
        };
        let some: Vec<String> = some.into_iter().map(literal).collect();
        let errors =
            ERRORS.iter().map(|error| format!("| `Error::{}` | {}{} |\n", error.name, error.message, error.more));
        let unsafety = if self.unit.for_c { "holds `unsafe` in `src/unsafe_c.rs` alone" } else { "holds no `unsafe`" };
        format!(
            include_str!("package/README.md.txt"),
            package = self.name,
            mechanism = self.unit.system.name(),
            mark = self.mark(),
            unsafety = unsafety,
            needs = needs,
            library = self.library,
            imports = imports,
            params = self.params(),
            times = some.join(", "),
            shown = shown,
            calls = self.calls(),
            parameters = self.parameters() + &self.inputs(),
            bodies = self.bodies(),
            coordinates = self.coordinates(),
            measures = self.measures() + &self.forces(),
            errors = errors.collect::<String>(),
            work = self.work(),
            end = end.unwrap_or_default(),
            c = self.for_c(),
        )
    }

    /// Returns the text about use from C; empty if the crate is not for C.
    fn for_c(&self) -> String {
        if !self.unit.for_c {
            return String::new();
        }
        let (given, params) = if self.unit.system.params().is_empty() {
            (String::new(), "")
        } else {
            (format!("    {0}_params params = {0}_params_default();\n", self.library), ", &params")
        };
        format!(
            include_str!("package/from_c.md.txt"),
            library = self.library,
            constants = self.library.to_uppercase(),
            given = given,
            params = params,
            start = literal(self.times().first().copied().unwrap_or_default()),
        )
    }

    /// Returns what the example prints, and the items that it needs for that.
    fn shown(&self) -> (&'static str, String) {
        let system = self.unit.system;
        let names = Case::Constant.names(system.measures().iter().map(|of| of.name.as_str()));
        if let Some(name) = names.first() {
            return ("Params, assemble, measure, step", format!("state.measures().values[measure::{name}]"));
        }
        if let Some(name) = Case::Camel.names(system.bodies().iter().map(|body| body.name.as_str())).first() {
            return ("Body, Params, assemble, step", format!("state.pose(Body::{name})"));
        }
        ("Params, assemble, step", "state.q()".to_owned())
    }

    /// Returns the table of calls on a state, which depends on the mechanism.
    fn calls(&self) -> String {
        let system = self.unit.system;
        let mut text = String::new();
        if !system.bodies().is_empty() {
            text += "| `state.pose(body)`, `velocity(body)`, `acceleration(body)` | those of a body, as `x`, `y` and `phi` |\n";
        }
        if !system.measures().is_empty() {
            text += "| `state.measures()` | the measures with their first and second time derivatives |\n";
        }
        if self.unit.following.is_some() {
            text += "| `follow(&inputs, &mut state)` | leads a state to `Inputs`, along the straight line between them; `follow_within` in so many steps at most: `Progress { fraction }` |\n";
            text += "| `Inputs::at(t, &params)`, `state.inputs()` | what the text's formulas say at a time; where a state is |\n";
            text += "| `influence(&state)` | the derivatives of the coordinates by each input, by the numbers in `input` |\n";
        }
        if self.unit.has_sensitivity() {
            text += "| `sensitivity(&params, &state)` | those by each parameter, by the numbers in `param` |\n";
        }
        if self.unit.has_forces() {
            text += "| `forces(&state)` | what joints exert and drivers supply, by the numbers in `force`; `NAN` close to a singular position |\n";
            text +=
                "| `needed`, `exerted` | what the multipliers of the equations have to hold, and what they exert |\n";
        }
        if let Some(lanes) = self.unit.lanes {
            text += &format!(
                "| `lanes::assemble`, `lanes::step_each` | the same for {lanes} variants or times at once |\n"
            );
        }
        text
    }

    fn parameters(&self) -> String {
        let params = self.unit.system.params();
        let Some(first) = params.first() else {
            return "The mechanism has none: `assemble(&Params)`.\n".to_owned();
        };
        let names = Params::new(self.unit.system).paths;
        let rows = params.iter().zip(&names).map(|(param, name)| {
            [format!("`{name}`"), format!("`{}`", param.name), unit(&param.unit()).to_owned(), literal(param.value)]
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

    /// Returns the fields of `Inputs`; empty if there are none.
    fn inputs(&self) -> String {
        let inputs = self.unit.system.inputs();
        if self.unit.following.is_none() {
            return String::new();
        }
        let names = Case::Snake.names_of_inputs(inputs);
        let rows: String = inputs
            .iter()
            .zip(names)
            .map(|(input, name)| {
                line(&[format!("`{name}`"), format!("`{}`", input.name), unit(&input.unit()).to_owned()])
            })
            .collect();
        format!("\n## Inputs\n\n{INPUTS}\n| field of `Inputs` | input | unit |\n| --- | --- | --- |\n{rows}")
    }

    fn bodies(&self) -> String {
        let bodies = self.unit.system.bodies();
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
        let coordinates = self.unit.system.coordinates();
        let names = Case::Constant.names(coordinates.iter().map(|coordinate| coordinate.name.as_str()));
        let rows = coordinates.iter().zip(names).map(|(coordinate, name)| {
            let index = format!("`coordinate::{name}`");
            [index, format!("`{}`", coordinate.name), unit(coordinate.kind.unit()).to_owned()]
        });
        rows.map(|cells| line(&cells)).collect()
    }

    fn forces(&self) -> String {
        if !self.unit.has_forces() {
            return String::new();
        }
        let reactions = self.unit.system.reactions();
        let names = Case::Constant.names(reactions.iter().map(|of| of.name.as_str()));
        let rows = reactions.iter().zip(names);
        let rows: String = rows
            .map(|(of, name)| line(&[format!("`force::{name}`"), format!("`{}`", of.name), unit(&of.unit).to_owned()]))
            .collect();
        format!(
            "## Forces\n\nWhat `forces(&state)` gives, by these indices: what joints exert on their second bodies, and what drivers and \
             constraints supply, as `mechc run --reactions` has it.\n\n| index | force | unit |\n| --- | --- | --- |\n{rows}\n"
        )
    }

    fn measures(&self) -> String {
        let measures = self.unit.system.measures();
        if measures.is_empty() {
            return String::new();
        }
        // indices in a module, for each measure
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
            rows +=
                &line(&[format!("`{}`", measure.name), unit(&measure.units.si).to_owned(), value, rate, acceleration]);
        }
        format!(
            "## Measures\n\n`values`, `rates` and `accelerations` of `state.measures()`, by these indices. They are in SI, whatever \
             unit a table has them in:\n\n| measure | unit | value | first derivative | second derivative |\n\
             | --- | --- | --- | --- | --- |\n{rows}\n"
        )
    }
}

/// Returns a message as Markdown; its names stay in backticks.
fn in_prose(message: &str) -> String {
    message.split('`').map(one_line).collect::<Vec<String>>().join("`")
}

/// Returns a row as an item of an array of arrays.
fn array(row: &[f64]) -> String {
    let values: Vec<String> = row.iter().copied().map(literal).collect();
    format!("    [\n{}    ],\n", lines(&values, "    "))
}

/// Returns a row of a Markdown table.
fn line<T: Display>(cells: &[T]) -> String {
    let cells: Vec<String> = cells.iter().map(ToString::to_string).collect();
    format!("| {} |\n", cells.join(" | "))
}

/// Returns the `use` item for names of a crate, formatted as rustfmt does.
fn imported(library: &str, names: &str) -> String {
    /// Columns of rustfmt's default style.
    const WIDTH: usize = 100;
    let line = format!("use {library}::{{{names}}};");
    if line.len() <= WIDTH { line } else { format!("use {library}::{{\n    {names},\n}};") }
}

#[cfg(test)]
mod tests {
    use super::{LIBM, crate_name};

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
    fn libm_version_is_pinned() {
        let pinned = format!("\nlibm = \"={LIBM}\"\n");
        assert!(include_str!("../../../Cargo.toml").contains(&pinned), "{pinned}");
    }
}
