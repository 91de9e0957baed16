//! Code that follows inputs: `Inputs`, `follow` and `influence` of emitted Rust.
//!
//! In its equations inputs are signals. It steps along the straight line between two values of the signals as `step` does along time,
//! with a parameter from 0 to 1. It is a separate module, so that other code does not depend on it.

use super::indices::numbered;
use super::state_size::Work;
use super::{Writer, equations};
use crate::Following;
use crate::equations::{Equations, FunctionSpec, Given};
use crate::limits::follow::{LARGEST_SHIFT_OF_INPUT, LARGEST_TURN_OF_INPUT};
use crate::names::{Case, Names};
use crate::params::Params;
use crate::print::{Head, Page};
use crate::runtime_files::RuntimeDeps;
use crate::solution::Solution;
use crate::tables::Tables;
use crate::text::{literal, one_line, unit};
use mechc_ir::Input;
use mechc_ir::program::Register;
use rustc_hash::FxHashMap;
use std::cell::RefCell;

/// Documentation of `follow`.
const FOLLOW: &str = "Leads a state from its inputs to others, along the straight line between them, in as many steps
as the branch asks for; their rates and accelerations there decide velocities and accelerations.

It takes [`MOST_STEPS_TO_FOLLOW`] steps at most, and mostly one: [`MOST_WORK_TO_FOLLOW`]
evaluations, whatever it is given. A kink of a formula on the way is passed. What a measure makes
of more than the accelerations of inputs has no value. [`step`] goes on by the text's formulas: it
first leads back to what these say of the inputs at the state's time.

# Errors
Why it cannot get there; the state is then bit for bit as it was. [`Error::TooFar`] is told at
once of an input that changes by more than `State::largest_change`.";

const FOLLOW_WITHIN: &str =
    "As [`follow`], in so many steps at most, for those who have a deadline: [`most_work`] says how
many evaluations that are. A step that has to be made shorter counts as well. What these steps do
not reach is on its way: the same call goes on from there, and inputs, coordinates and measures of
the state are those of the place that it has come to.

# Errors
Why it cannot get there; the state is then bit for bit as it was.";

const LARGEST_CHANGE: &str =
    "By input: the largest change that a call takes, by the numbers in [`input`]. One that asks for
more is refused at once, as a value that an encoder never had. At first half a turn of an angle,
and of a length twice the largest body; infinite where an input is neither.";

/// Prints the inputs and the module that follows them. Returns its dependencies, the words that it takes of a state, and the work of a step.
pub(super) fn module(following: &Following<'_>, page: &mut Page) -> (RuntimeDeps, usize, Option<Work>) {
    let unit = &*following.unit;
    let Some(motion) = &unit.motion else {
        return (RuntimeDeps::default(), 0, None);
    };
    let tables = Tables::new(unit.program);
    let names = Names::new(unit.system, Params::new(unit.system).paths, &tables.variables());
    let equations = equations(unit, &names, &tables, true);
    let writer = Writer { unit, names: &names, equations: &equations };
    let mut body = Page::default();
    writer.tables(&mut body);
    let mut deps = by_formulas(following, &names, &tables, &mut body);
    let solution = Solution::new(unit, motion, &equations);
    writer.input_driven(&solution, &mut body);
    let words = writer.words_of_input_path(&solution);
    deps.add(&equations.deps.take());
    let inputs = Inputs { all: unit.system.inputs(), names: &names, for_c: unit.for_c };
    inputs.print(page);
    inputs.entry_points(!unit.system.checks().is_empty(), page);
    page.docs("What follows inputs: along a way from 0 to 1, on which `t` is a place.");
    page.line("#[rustfmt::skip]");
    page.item("mod following", |page| {
        page.line("use super::*;\n");
        deps.print("super::runtime", page);
        page.text(&body.done());
    });
    deps.file("follow");
    deps.limit("MOST_STEPS_TO_FOLLOW");
    (deps, words, Some(writer.work()))
}

/// Prints the inputs by the formulas of the text: values, rates and accelerations. Returns the dependencies of that code.
fn by_formulas(following: &Following<'_>, names: &Names, tables: &Tables, page: &mut Page) -> RuntimeDeps {
    let program = following.by_text;
    let outputs: Vec<Register> = program.inputs.all_signals().collect();
    let equations = Equations {
        program,
        names,
        tables,
        constants: program.constants().iter().copied().collect(),
        sides: FxHashMap::default(),
        is_input_driven: false,
        deps: RefCell::default(),
    };
    equations.function(
        &FunctionSpec {
            given: Given::None,
            ..FunctionSpec::new(
                "by_formulas",
                "Value, rate and acceleration of each signal by the text's formulas.",
                &outputs,
                "3 * SIGNALS",
            )
        },
        page,
    );
    equations.deps.into_inner()
}

impl Writer<'_> {
    /// Prints the model of the mechanism along signals.
    fn input_driven(&self, solution: &Solution<'_>, page: &mut Page) {
        let system = self.unit.system;
        page.constant(
            "The path of the signals.",
            "type Path",
            "super::runtime::input_path::InputPath<Params, SIGNALS>",
        );
        page.line(&format!("const ENTRIES: usize = {};\n", system.phi_q().entries().len()));
        self.pattern("", "Row and column of each value that `phi_q` gives.", page);
        if self.equations.has_varied() {
            let count = 3 * system.variations().len() * system.coordinates().len();
            page.line(&format!("const VARIED: usize = {count};\n"));
        }
        if !system.checks().is_empty() {
            page.line(&format!("const LEFT_OUT: usize = {};\n", system.checks().len()));
        }
        self.model("path", "Path", "path", solution, page);
        self.solved(solution, page);
        self.left_out_slopes("signal", &self.unit.program.outputs.check_slopes.inputs, page);
        self.along_signals(solution, page);
        self.sensitivity(solution, page);
        self.forces(solution, page);
    }

    /// Returns the default of the largest change per call, for each signal.
    fn largest_changes(&self) -> Vec<f64> {
        let system = self.unit.system;
        let lengths = system.coordinates().iter().filter(|of| of.kind.unit() == "m").map(|of| of.scale);
        let longest = lengths.fold(0.0, f64::max);
        let of = |input: &Input| match input.unit().as_str() {
            _ if input.is_time() => f64::INFINITY,
            "rad" | "1" => LARGEST_TURN_OF_INPUT,
            "m" if longest > 0.0 => LARGEST_SHIFT_OF_INPUT * longest,
            _ => f64::INFINITY,
        };
        system.inputs().iter().map(of).collect()
    }

    /// Prints the motion along signals.
    fn along_signals(&self, solution: &Solution<'_>, page: &mut Page) {
        self.requires("input_path", "InputDriven");
        self.requires("input_path", "Signals");
        page.item("impl InputDriven<SIGNALS> for Model", |page| {
            page.line("type Params = Params;\n");
            let changes = self.largest_changes().into_iter().map(literal).collect::<Vec<_>>().join(", ");
            page.line(&format!("const LARGEST_CHANGE: [f64; SIGNALS] = [{changes}];\n"));
            let head = Head { kind: "fn", name: "new", arguments: &[("path", "&Path")], result: "Self" };
            page.function(&head, |page| Self::making(solution, "path", "*path", page));
            let head = Head { kind: "fn", name: "path", arguments: &[("&self", "")], result: "&Path" };
            page.function(&head, |page| page.line("&self.path"));
            let head = Head { kind: "fn", name: "path_mut", arguments: &[("&mut self", "")], result: "&mut Path" };
            page.function(&head, |page| page.line("&mut self.path"));
            let arguments = [("params", "&Params"), ("t", "f64")];
            let head = Head { kind: "fn", name: "by_formulas", arguments: &arguments, result: "Signals<SIGNALS>" };
            page.function(&head, |page| {
                page.line("let all = by_formulas(t, params);");
                page.line("let get = |k: usize| all.get(k).copied().unwrap_or(f64::NAN);");
                page.line("core::array::from_fn(|order| core::array::from_fn(|k| get(3 * k + order)))");
            });
            if !self.unit.system.checks().is_empty() {
                let arguments = [("&self", ""), ("by", "&mut [Q; SIGNALS]"), ("at", "&Solution")];
                let head = Head { kind: "fn", name: "reject_drift", arguments: &arguments, result: "" };
                let with = if self.has_sides() { "&self.path, &at.sides" } else { "&self.path" };
                page.function(&head, |page| self.reject_drift("signal", with, page));
            }
        });
    }
}

/// Public items about inputs.
struct Inputs<'i> {
    all: &'i [Input],
    names: &'i Names,
    /// True if C can access them too.
    for_c: bool,
}

impl Inputs<'_> {
    /// Returns the inputs other than time, which comes after them.
    fn without_time(&self) -> impl Iterator<Item = (&Input, &String)> {
        self.all.iter().zip(&self.names.inputs).filter(|(input, _)| !input.is_time())
    }

    /// Prints the attribute for C layout if C accesses the structure.
    fn as_in_c(&self, page: &mut Page) {
        if self.for_c {
            page.line("#[repr(C)]");
        }
    }

    fn has_time(&self) -> bool {
        self.all.iter().any(Input::is_time)
    }

    fn print(&self, page: &mut Page) {
        page.docs("What is given of an input, in SI: its value, and how that changes.");
        page.line("#[derive(Clone, Copy, Debug, Default, PartialEq)]");
        self.as_in_c(page);
        page.item("pub struct Signal", |page| {
            let fields = [
                ("value", "The value."),
                ("rate", "Its first time derivative."),
                ("acceleration", "Its second time derivative."),
            ];
            for (name, docs) in fields {
                page.docs(docs);
                page.line(&format!("pub {name}: f64,"));
            }
        });
        page.constant("Number of inputs.", "pub const INPUTS: usize", &self.without_time().count().to_string());
        let docs = "Number of signals: time is one where formulas hold it beside inputs.";
        page.constant(docs, "const SIGNALS: usize", &self.all.len().to_string());
        let constants = Case::Constant.names_of_inputs(self.all);
        let descriptions =
            |(input, _): (&Input, &String)| format!("`{}` ({})", one_line(&input.name), unit(&input.unit()));
        numbered(
            page,
            "Where each input stands in what [`influence`] gives.",
            "input",
            self.without_time().map(descriptions).zip(&constants),
        );
        page.docs("What comes from outside.");
        page.line("#[derive(Clone, Copy, Debug, Default, PartialEq)]");
        self.as_in_c(page);
        page.item("pub struct Inputs", |page| {
            for (input, name) in self.without_time() {
                page.docs(&format!("`{}` ({})", one_line(&input.name), unit(&input.unit())));
                page.line(&format!("pub {name}: Signal,"));
            }
            if self.has_time() {
                page.docs("The time (s), which formulas hold too; its rate is 1.");
                page.line("pub t: f64,");
            }
        });
        page.item("impl Inputs", |page| self.methods(page));
    }

    fn methods(&self, page: &mut Page) {
        page.docs("What the text's formulas say at a time (s).");
        page.line("#[must_use]");
        let arguments = [("t", "f64"), ("params", "&Params")];
        let head = Head { kind: "pub fn", name: "at", arguments: &arguments, result: "Self" };
        page.function(&head, |page| {
            page.line("use runtime::input_path::InputDriven;\n");
            page.line("Self::of(&following::Model::by_formulas(params, t))");
        });
        page.line("#[rustfmt::skip]");
        let arguments = [("[values, rates, accelerations]", "&[[f64; SIGNALS]; 3]")];
        let head = Head { kind: "fn", name: "of", arguments: &arguments, result: "Self" };
        page.function(&head, |page| {
            page.block("Self", |page| {
                for (k, (_, name)) in self.without_time().enumerate() {
                    let signal = format!("value: values[{k}], rate: rates[{k}], acceleration: accelerations[{k}]");
                    page.line(&format!("{name}: Signal {{ {signal} }},"));
                }
                if self.has_time() {
                    page.line(&format!("t: values[{}],", self.all.len() - 1));
                }
            });
        });
        page.docs("Values, rates and accelerations.");
        page.line("#[rustfmt::skip]");
        let head = Head { kind: "fn", name: "signals", arguments: &[("&self", "")], result: "[[f64; SIGNALS]; 3]" };
        page.function(&head, |page| {
            let mut all: Vec<String> = self.without_time().map(|(_, name)| format!("self.{name}")).collect();
            if self.has_time() {
                all.push("Signal { value: self.t, rate: 1.0, acceleration: 0.0 }".to_owned());
            }
            page.line(&format!("let all = [{}];", all.join(", ")));
            page.line("[all.map(|of| of.value), all.map(|of| of.rate), all.map(|of| of.acceleration)]");
        });
    }

    /// Prints the public functions.
    fn entry_points(&self, is_left_out: bool, page: &mut Page) {
        page.item("impl runtime::follow::Follows<following::Model, SIGNALS> for Model", |page| {
            page.line(&format!("const HAS_TIME: bool = {};", self.has_time()));
        });
        let arguments = [("inputs", "&Inputs"), ("state", "&mut State"), ("most", "usize")];
        let head = |name, arguments, result| Head { kind: "pub fn", name, arguments, result };
        page.line("pub use runtime::limits::MOST_STEPS_TO_FOLLOW;\n");
        let docs = "Evaluations that [`follow`] takes at most.";
        let value = "runtime::follow::most_work::<following::Model, SIGNALS>(MOST_STEPS_TO_FOLLOW)";
        page.docs(docs);
        page.line("#[rustfmt::skip]");
        page.line(&format!("pub const MOST_WORK_TO_FOLLOW: usize = {value};\n"));
        page.docs(FOLLOW);
        let follow = head("follow", &arguments[..2], "Result<(), Error>");
        page.function(&follow, |page| page.line("counted::follow(inputs, state, &mut Work::default())"));
        page.docs(FOLLOW_WITHIN);
        let follow_within = head("follow_within", &arguments, "Result<Progress, Error>");
        page.function(&follow_within, |page| {
            page.line("counted::follow_within(inputs, state, most, &mut Work::default())");
        });
        page.item("impl State", |page| {
            page.docs(LARGEST_CHANGE);
            page.line("#[must_use]");
            let head =
                Head { kind: "pub fn", name: "largest_change", arguments: &[("&self", "")], result: "[f64; INPUTS]" };
            let given = if self.has_time() { "[all @ .., _]" } else { "all" };
            page.function(&head, |page| {
                page.line(&format!("let {given} = runtime::follow::largest_change(self);"));
                page.line("*all");
            });
            page.docs("Sets it; a state keeps that, and its clones do.");
            let arguments = [("&mut self", ""), ("largest", "[f64; INPUTS]")];
            let head = Head { kind: "pub fn", name: "set_largest_change", arguments: &arguments, result: "" };
            page.function(&head, |page| {
                page.line(&format!("let {given} = runtime::follow::largest_change_mut(self);"));
                page.line("*all = largest;");
            });
        });
        page.docs(
            "The derivatives of the coordinates by each input, by the numbers in [`input`]: for a constant\n\
             shift of it, along the branch that the state is on.",
        );
        if is_left_out {
            page.docs(
                "Where an input alone cannot change, because an equation that was left out would cease to hold, its\n\
                 derivatives are `NAN`.",
            );
        }
        page.docs("\n# Errors\nThe equations cannot be solved with the inputs as signals.");
        let influence = head("influence", &[("state", "&State")], "Result<[Q; INPUTS], Error>");
        page.function(&influence, |page| {
            if self.has_time() {
                page.line("let [by @ .., _] = runtime::follow::influence(state)?;");
                page.line("Ok(by)");
            } else {
                page.line("runtime::follow::influence(state)");
            }
        });
    }
}
