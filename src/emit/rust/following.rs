//! What follows inputs: `Inputs`, `follow` and `influence` of emitted Rust.
//!
//! Its equations hold inputs as signals. What `step` does along time, it does along the straight line from signals to others, whose
//! places go from 0 to 1; it stands in a module of its own, so that nothing else changes.

use super::{SOLVER, Writer, equations, run};
use crate::emit::Following;
use crate::emit::equations::{Equations, Given, Wanted};
use crate::emit::names::{Case, Names};
use crate::emit::params::Params;
use crate::emit::solution::Solution;
use crate::emit::tables::Tables;
use crate::emit::text::{chosen, indented, one_line};
use crate::ir::Input;
use crate::program::Register;
use rustc_hash::FxHashMap;

const FOLLOW: &str = include_str!("../runtime/follow.rs");

/// Columns that the module stands in.
const INDENT: &str = "    ";

/// The inputs, and the module that follows them.
pub(super) fn module(following: &Following<'_>) -> String {
    let unit = &*following.unit;
    let Some(motion) = &unit.motion else {
        return String::new();
    };
    let tables = Tables::new(unit.program);
    let names = Names::new(unit.system, Params::new(unit.system).paths, &tables.variables());
    let equations = equations(unit, &names, &tables, true);
    let writer = Writer { unit, names: &names, equations: &equations };
    let solution = Solution::new(unit, motion, &equations);
    let module = Module { writer: &writer, solution: &solution };
    let by_text = by_text(following, &names, &tables);
    inputs(&unit.system.inputs, &names)
        + "// who needs but some of it is not told so\n#[allow(unused_imports)]\npub use following::{follow, follow_within, influence};\n\n"
        + "/// What follows inputs: along a way from 0 to 1, on which `t` is a place.\n#[rustfmt::skip]\nmod following {\n    use super::*;\n\n"
        + indented(&(writer.tables() + &by_text + &module.text()), INDENT).trim_end()
        + "\n}\n\n"
}

/// What everybody sees of inputs.
fn inputs(all: &[Input], names: &Names) -> String {
    let own: Vec<&Input> = all.iter().filter(|input| !input.is_time()).collect();
    let has_time = own.len() < all.len();
    let constants = Case::Constant.names_of_inputs(all);
    let (mut indices, mut fields, mut signals) = (String::new(), String::new(), String::new());
    for (k, input) in own.iter().enumerate() {
        let unit = if input.unit == "1" { "a pure number" } else { &input.unit };
        let docs = format!("/// `{}` ({unit})\n", one_line(&input.name));
        indices += &format!("    {docs}    pub const {}: usize = {k};\n", constants[k]);
        fields += &format!("    {docs}    pub {}: Signal,\n", names.inputs[k]);
        signals += &format!("self.{}, ", names.inputs[k]);
    }
    let count = own.len();
    let of_time = |text: &str| if has_time { text.to_owned() } else { String::new() };
    let field = of_time("    /// The time (s), which formulas hold too; its rate is 1.\n    pub t: f64,\n");
    let time = of_time("Signal { value: self.t, rate: 1.0, acceleration: 0.0 }");
    let mut made = String::new();
    for (k, name) in names.inputs.iter().take(count).enumerate() {
        made += &format!("            {name}: signal({k}),\n");
    }
    let made = made + &of_time(&format!("            t: signal({count}).value,\n"));
    INPUTS
        .replace("$indices", &indices)
        .replace("$fields", &(fields + &field))
        .replace("$made", &made)
        .replace("$all", (signals + &time).trim_end_matches(", "))
        .replace("$count", &count.to_string())
        .replace("$signals", &all.len().to_string())
}

/// What the text says of inputs: their values, rates and accelerations by its formulas.
fn by_text(following: &Following<'_>, names: &Names, tables: &Tables) -> String {
    let program = following.by_text;
    let outputs: Vec<Register> = program.inputs.all_signals().collect();
    let equations = Equations {
        program,
        names,
        tables,
        constants: program.constants().iter().copied().collect(),
        sides: FxHashMap::default(),
        is_led: false,
        book: None,
    };
    let text = equations.function(&Wanted {
        name: "by_text",
        docs: "Value, rate and acceleration of each signal by the text's formulas.",
        is_public: false,
        orders: 0,
        has_time: true,
        varied: false,
        outputs: &outputs,
        length: "3 * SIGNALS",
        negated: false,
        given: Given::None,
    });
    text.replacen("fn by_text(", "pub(super) fn by_text(", 1)
}

struct Module<'m> {
    writer: &'m Writer<'m>,
    solution: &'m Solution<'m>,
}

impl Module<'_> {
    fn text(&self) -> String {
        let Module { writer, solution } = self;
        let (unit, equations) = (writer.unit, writer.equations);
        let (of_time, has_motion) = writer.switches();
        let solve = if equations.book.is_some() { writer.large(solution, &[]) } else { solution.function(false) };
        let mut wanted = writer.wanted(solution, &solve);
        wanted.push(("time", unit.system.inputs.iter().any(Input::is_time)));
        let mut text = chosen(FOLLOW, &wanted) + "\n" + &solution.constants(&solve, false) + &self.pattern();
        text += &writer.left_out_limits();
        text += &self.model();
        text += &of_led(&chosen(SOLVER, &wanted));
        text += "\n";
        text += &solution.tears();
        text += &match &equations.book {
            Some(book) => {
                let template = writer.large(solution, &wanted);
                run(equations).replace("Inputs<'", "Arrays<'")
                    + "\n"
                    + &solution.as_numbers(&template.replace("Inputs<'", "Arrays<'"), &mut book.borrow_mut())
            }
            None => solve,
        };
        text += &of_led(&writer.sensitivity(solution, &wanted).replacen(
            "pub fn sensitivity",
            "pub(super) fn sensitivity",
            1,
        ));
        text += &of_led(&(writer.conditions() + &writer.watches() + &writer.sides(of_time, has_motion, &wanted)));
        text = writer.filled(&text, solution);
        text += &self.functions();
        if let Some(book) = &equations.book {
            text += &book.borrow().print(equations);
            text = text.replace("Inputs<'", "Arrays<'");
        }
        text
    }

    /// Where the entries of the Jacobian stand.
    fn pattern(&self) -> String {
        let system = self.writer.unit.system;
        let mut text = format!("const ENTRIES: usize = {};\n\n", system.phi_q.entries().len());
        text += "/// Row and column of each value that `phi_q` gives.\nstatic PHI_Q_PATTERN: [(usize, usize); ENTRIES] = [\n";
        for row in 0..system.rows.len() {
            for (column, _) in system.phi_q.row(row) {
                text += &format!("    ({row}, {column}),\n");
            }
        }
        text += "];\n\n";
        if self.writer.equations.has_varied() {
            let count = 3 * system.variations().len() * system.coordinates.len();
            text += &format!("const VARIED: usize = {count};\n\n");
            text += &self.writer.is_by_two();
        }
        if !system.checks.is_empty() {
            text += &format!("const LEFT_OUT: usize = {};\n\n", system.checks.len());
        }
        text
    }

    /// The way of the signals, with what follows from parameters alone.
    fn model(&self) -> String {
        let registers = self.solution.known_registers();
        if registers.is_empty() {
            return MODEL.to_owned();
        }
        let wanted = Wanted {
            name: "known",
            docs: "What follows from the parameters alone.",
            is_public: false,
            orders: 0,
            has_time: false,
            varied: false,
            outputs: &registers,
            length: "KNOWN",
            negated: false,
            given: Given::None,
        };
        let known = self.writer.equations.function(&wanted);
        format!("const KNOWN: usize = {};\n\n", registers.len())
            + &MODEL
                .replace("    way: Way,\n", "    way: Way,\n    known: [f64; KNOWN],\n")
                .replace("Self { way: way.clone() }", "Self { way: way.clone(), known: known(way) }")
            + &known
    }

    /// The functions of the equations, on branches of formulas that are given where there are any.
    fn functions(&self) -> String {
        let (writer, outputs) = (self.writer, &self.writer.unit.program.outputs);
        let (sides, has_pivoting) = (writer.has_sides(), self.solution.motion.blocks.is_some());
        let kinds = [
            ("phi", 1, &outputs.phi, "N"),
            ("phi_q", 1, &outputs.phi_q, "ENTRIES"),
            ("nu", 1, &outputs.nu, "N"),
            ("gamma", 2, &outputs.gamma, "N"),
            ("left_out", 1, &outputs.checks, "LEFT_OUT"),
        ];
        let mut text = String::new();
        for (of, orders, outputs, length) in kinds.into_iter().filter(|(_, _, outputs, _)| !outputs.is_empty()) {
            text += &writer.equations.function(&Wanted {
                name: &if sides { format!("{of}_with") } else { of.to_owned() },
                docs: &format!("As [`super::{of}`], with the signals of a way."),
                is_public: false,
                orders,
                has_time: true,
                varied: false,
                outputs,
                length,
                negated: false,
                given: Given::All,
            });
        }
        text += &writer.held_apart("signal", &outputs.check_slopes.signals, "SIGNALS");
        if has_pivoting {
            text += &writer.rights("signal", &outputs.by_signal, "SIGNALS");
            text += &of_led(&writer.measures().replace("pub fn measures", "fn measures"));
            text += &writer.varied(Given::All);
        }
        text
    }
}

/// A template of what is given parameters, for what is given a way.
fn of_led(text: &str) -> String {
    text.replace("&m.params", "&m.way").replace("p: &Params", "p: &Way")
}

const MODEL: &str = "/// A way, with what follows from its parameters alone.
#[derive(Clone, Debug)]
struct Model {
    way: Way,
}

impl Model {
    fn new(way: &Way) -> Self {
        Self { way: way.clone() }
    }
}

";

const INPUTS: &str = "/// What is given of an input, in SI: its value, and how that changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Signal {
    /// The value.
    pub value: f64,
    /// Its first time derivative.
    pub rate: f64,
    /// Its second time derivative.
    pub acceleration: f64,
}

/// Number of inputs.
pub const INPUTS: usize = $count;

/// Number of signals: time is one where formulas hold it beside inputs.
const SIGNALS: usize = $signals;

/// Where each input stands in what [`influence`] gives.
pub mod input {
$indices}

/// What comes from outside.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inputs {
$fields}

impl Inputs {
    /// What the text's formulas say at a time (s).
    #[must_use]
    pub fn at(t: f64, params: &Params) -> Self {
        let all = following::by_text(t, params);
        let get = |k: usize| all.get(k).copied().unwrap_or(f64::NAN);
        let order = |order: usize| core::array::from_fn(|k| get(3 * k + order));
        Self::of(&order(0), &order(1), &order(2))
    }

    #[rustfmt::skip]
    fn of(values: &[f64; SIGNALS], rates: &[f64; SIGNALS], accelerations: &[f64; SIGNALS]) -> Self {
        let of = |list: &[f64; SIGNALS], k: usize| list.get(k).copied().unwrap_or(f64::NAN);
        let signal = |k: usize| Signal {
            value: of(values, k),
            rate: of(rates, k),
            acceleration: of(accelerations, k),
        };
        Self {
$made        }
    }

    /// Values, rates and accelerations.
    #[rustfmt::skip]
    fn lists(&self) -> ([f64; SIGNALS], [f64; SIGNALS], [f64; SIGNALS]) {
        let all = [$all];
        (all.map(|of| of.value), all.map(|of| of.rate), all.map(|of| of.acceleration))
    }

    fn are_finite(&self) -> bool {
        let (values, rates, accelerations) = self.lists();
        let mut all = values.iter().chain(&rates).chain(&accelerations);
        all.all(|value| value.is_finite())
    }
}

";
