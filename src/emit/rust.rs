//! A mechanism as one Rust file: its equations, and what solves them.

mod following;

use super::Unit;
use super::code::MODULE;
use super::equations::{Equations, Given, Wanted};
use super::names::{Case, Names};
use super::params::{Of, Params};
use super::solution::Solution;
use super::tables::{Tables, numbers};
use super::text::{chosen, indented, is_called, lines, literal, one_line};
use crate::expr::{ExprId, VARIED_TABLE};
use crate::ir::{Measure, Units};
use crate::layout::RowLayout;
use crate::program::{Column, Register, Rim, STAGES};
use crate::source::Span;
use crate::tolerances::checks;
use std::cell::RefCell;

/// The sine-cosine pair and the elimination with partial pivoting, word for word as the interpreter runs them.
const SIN_COS: &str = include_str!("../math/sin_cos.rs");
const BLOCKS: &str = include_str!("../math/blocks.rs");
/// What is the same for all mechanisms but for a few lines.
const STATE: &str = include_str!("runtime/state.rs");
pub(super) const SOLVER: &str = include_str!("runtime/solver.rs");
const SIDES: &str = include_str!("runtime/sides.rs");
const MOTION: &str = include_str!("runtime/motion.rs");
const RIMS: &str = include_str!("runtime/rims.rs");
const LANES: &str = include_str!("runtime/lanes.rs");
const LARGE: &str = include_str!("runtime/large.rs");
pub(super) const RUN: &str = include_str!("runtime/tables.rs");
const WITHOUT_BRANCHES: &str = include_str!("../math/without_branches.rs");
const SENSITIVITY: &str = include_str!("runtime/sensitivity.rs");
const FUNCTIONS: &str = include_str!("runtime/functions.rs");

/// Systems up to this many coordinates get their Jacobian as a full matrix too.
const LARGEST_DENSE: usize = 64;

/// One Rust module, self-contained but for the `libm` crate where a formula asks for it.
#[must_use]
pub fn rust(unit: &Unit<'_>) -> String {
    let tables = Tables::new(unit.program);
    let names = Names::new(unit.system, Params::new(unit.system).paths, &tables.variables());
    let equations = equations(unit, &names, &tables, false);
    let writer = Writer { unit, names: &names, equations: &equations };
    let motion = unit.motion.as_ref().map(|motion| Solution::new(unit, motion, &equations));
    let mut body = writer.params() + &writer.indices() + &writer.tables();
    body += &writer.functions();
    if let Some(solution) = &motion {
        body += &writer.motion(solution);
    }
    if let Some(book) = &equations.book {
        body += &run(&equations);
        body += "\n";
        body += &book.borrow().print(&equations);
    }
    if let Some(following) = &unit.following {
        // the operations' arrays give way to what everybody sees
        body = body.replace("Inputs<'", "Arrays<'") + &following::module(following);
    }
    body += &helpers(&body);
    writer.header(body.contains("libm::")) + body.trim_end() + "\n"
}

/// What the functions of a unit's equations are written from; led ones are given their inputs.
pub(super) fn equations<'u>(unit: &Unit<'u>, names: &'u Names, tables: &'u Tables, is_led: bool) -> Equations<'u> {
    let switches = unit.program.switches().iter().enumerate();
    Equations {
        program: unit.program,
        names,
        tables,
        constants: unit.program.constants().iter().copied().collect(),
        sides: switches.map(|(k, switch)| (switch.to, k)).collect(),
        is_led,
        book: is_large(unit).then(RefCell::default),
    }
}

/// What runs operations that are written as numbers.
pub(super) fn run(equations: &Equations<'_>) -> String {
    let arrays = if equations.has_varied() { "; 9]" } else { "; 8]" };
    RUN.replace("; 8]", arrays)
}

/// Whether a mechanism is so large that its operations are written as numbers. Tables that depend on parameters are not.
#[must_use]
pub fn is_large(unit: &Unit<'_>) -> bool {
    let of_program: usize = STAGES.iter().map(|stage| unit.program.stage(*stage).len()).sum();
    let of_motion = |motion: &super::Motion| motion.sensitive.as_ref().unwrap_or(&motion.solver).instructions().len();
    let of_solver = unit.motion.as_ref().map_or(0, of_motion);
    let constants = unit.program.constants().iter().copied().collect();
    let is_constant =
        |table: u32| Column::ALL.iter().all(|&column| numbers(unit.program, &constants, table, column).is_some());
    of_program + of_solver > unit.largest_straight && (0..unit.program.tables().len() as u32).all(is_constant)
}

pub(super) struct Writer<'w> {
    pub unit: &'w Unit<'w>,
    pub names: &'w Names,
    pub equations: &'w Equations<'w>,
}

impl Writer<'_> {
    fn header(&self, needs_libm: bool) -> String {
        let system = self.unit.system;
        let (n, entries) = (system.coordinates.len(), system.phi_q.entries().len());
        let mut text = format!(
            "//! Kinematics of mechanism `{}`, written by mechc {} from `{}`.\n//!\n",
            one_line(&system.name),
            env!("CARGO_PKG_VERSION"),
            one_line(self.unit.file),
        );
        text += &format!("//! - coordinates `q`: {n} (m, rad), equations `phi = 0`: {}\n", system.rows.len());
        text += &format!("//! - `phi_q`: {entries} entries that do not vanish, see [`PHI_Q_PATTERN`]\n");
        text += &format!("//! - parameters: {}; those that follow from others are worked out\n", system.params.len());
        if !system.checks.is_empty() {
            text += &format!(
                "//! - equations that were left out as redundant: {}, see [`left_out`]\n",
                system.checks.len()
            );
        }
        if self.unit.motion.is_some() {
            text += "//! - the motion: [`assemble`], then [`step`] from time to time\n";
        }
        if self.unit.following.is_some() {
            text += "//! - the motion by its inputs: [`follow`] from [`Inputs`] to others\n";
        }
        text += if needs_libm {
            "//! - needs the crate `libm`, for elementary functions with the same bits on every platform\n"
        } else {
            "//! - needs no other crate\n"
        };
        text += "//! - needs no heap and no standard library; nothing in it panics\n";
        text += "//!\n//! This code carries no licence of mechc's: use, change and pass it on as you like.\n\n";
        // a parameter of 3.14 is no approximation of pi, and a formula may hold what the parameters make trivial
        text += "#![allow(clippy::approx_constant, clippy::eq_op)]\n#![allow(clippy::excessive_precision, clippy::large_const_arrays)]\n";
        if self.equations.has_varied() {
            text += "#![allow(clippy::too_many_arguments)]\n";
        }
        text + "\n"
    }

    /// Where something is declared, for a comment.
    fn line(&self, span: Span) -> String {
        format!(", line {}", self.unit.sources.get(span.file).position(span.start).0)
    }

    fn params(&self) -> String {
        let system = self.unit.system;
        let has_motion = self.unit.motion.is_some();
        if system.params.is_empty() {
            let mut text = "/// The mechanism has no parameters.\n#[derive(Clone, Copy, Debug, Default, PartialEq)]\npub struct Params;\n\n"
                .to_owned();
            if has_motion {
                text += "impl Params {\n    fn towards(&self, _: &Self, _: f64) -> Self {\n        Self\n    }\n\n    fn is_finite(&self) -> bool {\n        true\n    }\n}\n\n";
            }
            return text;
        }
        let params = Params::new(system);
        let mut text = self.types_of_params(&params);
        text += "impl Default for Params {\n    #[rustfmt::skip]\n    fn default() -> Self {\n        ";
        text += &params.value("Self", "        ", &|param| literal(system.params[param].value));
        text += "\n    }\n}\n\n";
        if self.equations.book.is_some() {
            let fields: Vec<String> = self.names.params.iter().map(|name| format!("self.{name}")).collect();
            text += &format!(
                "impl Params {{\n    #[rustfmt::skip]\n    fn list(&self) -> [f64; {}] {{\n        [\n{}        ]\n    }}\n}}\n\n",
                fields.len(),
                lines(&fields, "        "),
            );
        }
        if has_motion {
            text += "impl Params {\n    /// Part of the way from these to others.\n    #[rustfmt::skip]\n    fn towards(&self, other: &Self, part: f64) -> Self {\n        ";
            text += &params.value("Self", "        ", &|param| {
                let path = &params.paths[param];
                format!("self.{path} + part * (other.{path} - self.{path})")
            });
            text += "\n    }\n\n    #[rustfmt::skip]\n    fn is_finite(&self) -> bool {\n        let all = [\n";
            let fields: Vec<String> = self.names.params.iter().map(|name| format!("self.{name}")).collect();
            text += &lines(&fields, "        ");
            text += "        ];\n        all.into_iter().all(f64::is_finite)\n    }\n}\n\n";
        }
        text
    }

    /// The structures of the parameters.
    fn types_of_params(&self, params: &Params) -> String {
        let mut text = String::new();
        for of in &params.types {
            text += &if of.source.is_empty() {
                "/// The parameters, in SI; those of the file by default.\n".to_owned()
            } else {
                format!("/// The parameters of a part, as `{}`, in SI.\n", of.source)
            };
            text += &format!("#[derive(Clone, Copy, Debug, PartialEq)]\npub struct {} {{\n", of.name);
            for field in &of.fields {
                let (source, name) = (one_line(&field.source), &field.name);
                text += &match &field.of {
                    Of::Number(param) => {
                        let param = &self.unit.system.params[*param];
                        format!("    /// `{source}` ({}){}\n    pub {name}: f64,\n", param.unit, self.line(param.span))
                    }
                    Of::Part(part) => {
                        format!("    /// Those of `{source}`.\n    pub {name}: {},\n", params.types[*part].name)
                    }
                    Of::Copies(part, lengths) => {
                        let inner = params.types[*part].name.clone();
                        let array = lengths.iter().rev().fold(inner, |of, length| format!("[{of}; {length}]"));
                        format!("    /// Those of `{source}`, by its numbers.\n    pub {name}: {array},\n")
                    }
                };
            }
            text += "}\n\n";
        }
        text
    }

    fn indices(&self) -> String {
        let system = self.unit.system;
        let (n, entries) = (system.coordinates.len(), system.phi_q.entries().len());
        let mut text = format!(
            "/// Number of coordinates, and of equations.\npub const N: usize = {n};\n\n\
             /// Number of entries of `phi_q` that do not vanish.\npub const ENTRIES: usize = {entries};\n\n\
             /// Coordinates (m, rad).\npub type Q = [f64; N];\n\n/// Velocities (m/s, rad/s).\npub type Qd = [f64; N];\n\n\
             /// Accelerations (m/s^2, rad/s^2).\npub type Qdd = [f64; N];\n\n\
             /// Where each coordinate stands in `q`.\npub mod coordinate {{\n"
        );
        let names = Case::Constant.names(system.coordinates.iter().map(|coordinate| coordinate.name.as_str()));
        for (k, (coordinate, name)) in system.coordinates.iter().zip(&names).enumerate() {
            let unit = match coordinate.kind.unit() {
                "" => "a pure number",
                unit => unit,
            };
            let line = self.line(system.owner_span(k));
            text += &format!("    /// `{}` ({unit}){line}\n    pub const {name}: usize = {k};\n", coordinate.name);
        }
        text += "}\n\n/// Which equation each joint, constraint or driver wrote.\npub mod row {\n";
        let rows: Vec<String> = (0..system.rows.len()).map(|k| system.row_name(k)).collect();
        let names = Case::Constant.names(rows.iter().map(String::as_str));
        for (k, (row, name)) in rows.iter().zip(&names).enumerate() {
            let declaration = system.declaration_of(k);
            let (kind, line) = (declaration.kind.noun(), self.line(declaration.span));
            text += &format!("    /// {kind} `{row}`{line}\n    pub const {name}: usize = {k};\n");
        }
        text += "}\n\n/// Row and column of each value that [`phi_q`] gives.\n#[rustfmt::skip]\n";
        text += "pub static PHI_Q_PATTERN: [(usize, usize); ENTRIES] = [\n";
        for row in 0..system.rows.len() {
            for (column, _) in system.phi_q.row(row) {
                text += &format!("    ({row}, {column}),\n");
            }
        }
        text + "];\n\n" + &self.bodies() + &self.measure_indices()
    }

    /// The bodies, and where they are.
    fn bodies(&self) -> String {
        let system = self.unit.system;
        if system.bodies.is_empty() {
            return String::new();
        }
        let names = Case::Camel.names(system.bodies.iter().map(|body| body.name.as_str()));
        let (mut variants, mut arms) = (String::new(), String::new());
        for ((id, body), name) in system.bodies.pairs().zip(&names) {
            variants += &format!("    /// `{}`{}\n    {name},\n", body.name, self.line(body.span));
            let [x, y, phi] = system.pose_of(id);
            arms += &format!("            Body::{name} => Self {{ x: q[{x}], y: q[{y}], phi: q[{phi}] }},\n");
        }
        format!(
            "/// The bodies.\n#[derive(Clone, Copy, Debug, PartialEq, Eq)]\npub enum Body {{\n{variants}}}\n\n\
             /// Where a body is, or how its place changes.\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct Pose {{\n    \
             /// (m)\n    pub x: f64,\n    /// (m)\n    pub y: f64,\n    /// (rad)\n    pub phi: f64,\n}}\n\n\
             impl Pose {{\n    /// That of a body, out of the coordinates or their derivatives.\n    #[rustfmt::skip]\n    \
             #[must_use]\n    pub fn of(q: &[f64; N], body: Body) -> Self {{\n        match body {{\n{arms}        }}\n    }}\n}}\n\n"
        )
    }

    fn measure_indices(&self) -> String {
        let measures = &self.unit.system.measures;
        if measures.is_empty() {
            return String::new();
        }
        let having = |has: fn(&Measure) -> bool| measures.iter().filter(|m| has(m)).collect::<Vec<&Measure>>();
        let lists = [having(|_| true), having(|m| m.first.is_some()), having(|m| m.second.is_some())];
        let mut text = String::new();
        let kinds = [
            ("measure", "Where each measure stands among the values, all in SI.", "MEASURES"),
            (
                "measure_rate",
                "Where the first time derivative of each measure that has one stands among the rates.",
                "RATES",
            ),
            (
                "measure_acceleration",
                "Where the second time derivative of each measure that has one stands among the accelerations.",
                "ACCELERATIONS",
            ),
        ];
        for ((module, docs, count), list) in kinds.into_iter().zip(&lists) {
            text += &format!("/// {docs}\npub mod {module} {{\n");
            let names = Case::Constant.names(list.iter().map(|measure| measure.name.as_str()));
            for (k, (measure, name)) in list.iter().zip(&names).enumerate() {
                let (line, si) = (self.line(measure.span), in_si(measure));
                text += &format!("    /// `{}`{si}{line}\n    pub const {name}: usize = {k};\n", measure.name);
            }
            text += &format!("}}\n\n/// How many they are.\npub const {count}: usize = {};\n\n", list.len());
        }
        text + MEASURES
    }

    /// The tables' columns that hold numbers alone.
    pub fn tables(&self) -> String {
        let (program, mut text) = (self.unit.program, String::new());
        for (number, table) in program.tables().iter().enumerate() {
            for column in Column::ALL {
                let number = number as u32;
                // how a table varies has the pieces of that table
                let is_left_out = table.name.ends_with(VARIED_TABLE) && !self.is_looked_into(number, column);
                let Some(values) = numbers(program, &self.equations.constants, number, column).filter(|_| !is_left_out)
                else {
                    continue;
                };
                let what = match column {
                    Column::Knots => "where its pieces begin, and where the last one ends".to_owned(),
                    Column::Coefficient(order) => format!("coefficient {order} of each piece"),
                };
                let values: Vec<String> = values.into_iter().map(literal).collect();
                text += &format!(
                    "/// Table `{}`: {what}.\n#[rustfmt::skip]\nstatic {}: [f64; {}] = [\n{}];\n\n",
                    one_line(&table.name),
                    self.equations.tables.of(number, column),
                    values.len(),
                    lines(&values, ""),
                );
            }
        }
        text
    }

    /// Whether some operation looks into a column of a table, or may by its number.
    fn is_looked_into(&self, table: u32, column: Column) -> bool {
        let all = || STAGES.iter().flat_map(|stage| self.unit.program.stage(*stage));
        self.equations.book.is_some() || all().any(|&op| op.column() == Some((table, column)))
    }

    pub fn has_sides(&self) -> bool {
        !self.equations.sides.is_empty()
    }

    /// The functions that everybody may call.
    fn functions(&self) -> String {
        let outputs = &self.unit.program.outputs;
        let kinds = [
            ("phi", "The residual of the equations (m, m^2 or rad).", 1, &outputs.phi, "N"),
            (
                "phi_q",
                "The Jacobian: the values of its entries, in the order of [`PHI_Q_PATTERN`] (the equation's unit per m or\nrad).",
                1,
                &outputs.phi_q,
                "ENTRIES",
            ),
            ("phi_t", "The partial derivative of `phi` by time (the equation's unit per s).", 1, &outputs.nu, "N"),
            (
                "nu",
                "Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).",
                1,
                &outputs.nu,
                "N",
            ),
            (
                "gamma",
                "Right side of the acceleration equation `phi_q qdd = gamma` (the equation's unit per s^2).",
                2,
                &outputs.gamma,
                "N",
            ),
        ];
        let jerk = ("jerk", "Right side of the jerk equation `phi_q qddd = jerk`.", 3, &outputs.jerk, "N");
        let left_out = ("left_out", LEFT_OUT_DOCS, 1, &outputs.checks, "LEFT_OUT");
        let kinds = kinds.into_iter().chain((!outputs.jerk.is_empty()).then_some(jerk));
        let kinds = kinds.chain((!outputs.checks.is_empty()).then_some(left_out));
        let mut text = self.left_out();
        for (name, docs, orders, outputs, length) in kinds {
            let wanted = Wanted {
                name,
                docs,
                is_public: true,
                orders,
                has_time: true,
                varied: false,
                outputs,
                length,
                negated: name == "phi_t",
                given: Given::None,
            };
            text += &self.equations.function(&wanted);
        }
        if self.unit.system.coordinates.len() <= LARGEST_DENSE {
            text += DENSE;
        }
        if !self.equations.is_led {
            text += &self.varied(Given::None);
        }
        text + &self.measures()
    }

    /// Which equations were left out.
    fn left_out(&self) -> String {
        let system = self.unit.system;
        if system.checks.is_empty() {
            return String::new();
        }
        let mut text =
            "/// Number of equations that were left out, since they follow from the others. Those of:\n".to_owned();
        for of in system.checks.chunk_by(|a, b| a.declaration == b.declaration) {
            let declaration = &system.declarations[of[0].declaration];
            let (kind, name, line) = (declaration.kind.noun(), &declaration.name, self.line(declaration.span));
            text += &format!("/// - {kind} `{name}`: {}{line}\n", of.len());
        }
        text + &format!("pub const LEFT_OUT: usize = {};\n\n", system.checks.len())
    }

    /// The right sides of the equations for the derivatives by inputs and parameters that measures hold; nothing where there are none.
    pub fn varied(&self, given: Given) -> String {
        let (system, variations) = (self.unit.system, &self.unit.program.outputs.variations);
        if variations.is_empty() {
            return String::new();
        }
        let outputs: Vec<Register> = variations.iter().flatten().flatten().copied().collect();
        let is_public = given == Given::None && !self.equations.is_led;
        let mut text = String::new();
        if is_public {
            text += "/// Number of derivatives of the coordinates by inputs and parameters that measures hold. For each of the\n\
                /// following one behind the other: those of `q`, of `qd` and of `qdd`. By\n";
            for number in 0..variations.len() as u32 {
                let name = one_line(&system.variation_name("", number));
                text += &format!("/// - {}\n", name.trim_start_matches(".by.").replace(".by.", " and "));
            }
            text += &format!("pub const VARIED: usize = {};\n\n", outputs.len());
        }
        text + &self.equations.function(&Wanted {
            name: if is_public || !self.has_sides() { "varied_right" } else { "varied_right_with" },
            docs: "Right sides of the equations `phi_q x = varied_right` for each list of `N` of [`VARIED`]. Those by one are found\nbefore those by \
                   two, those of `q` before those of `qd` and these before those of `qdd`: what is not found yet\nmay be anything.",
            is_public,
            orders: 3,
            has_time: true,
            varied: true,
            outputs: &outputs,
            length: "VARIED",
            negated: false,
            given,
        })
    }

    /// Which of the measures, their rates and their accelerations hold derivatives by inputs and parameters.
    fn is_varied(&self) -> String {
        let (graph, measures) = (&self.unit.system.graph, &self.unit.system.measures);
        let is_varied = |id: ExprId| graph.dependence(id).highest_varied_order().is_some().to_string();
        let values = measures.iter().map(|measure| is_varied(measure.value));
        let rates = measures.iter().filter_map(|measure| measure.first.map(is_varied));
        let accelerations = measures.iter().filter_map(|measure| measure.second.map(is_varied));
        let all: Vec<String> = values.chain(rates).chain(accelerations).collect();
        let docs = "Which measures, rates and accelerations are derivatives by inputs or parameters.";
        super::text::constant(docs, "IS_VARIED", "bool", "MEASURES + RATES + ACCELERATIONS", &all) + LEAVE_VARIED_OUT
    }

    /// By derivative of the coordinates: whether it is one by two.
    pub fn is_by_two(&self) -> String {
        let variations = self.unit.system.variations();
        let by_two: Vec<String> = variations.iter().map(|variation| variation.by.1.is_some().to_string()).collect();
        super::text::constant("Which lists of [`VARIED`] are by two.", "IS_BY_TWO", "bool", "VARIED / (3 * N)", &by_two)
    }

    /// The measures with their derivatives.
    pub fn measures(&self) -> String {
        let (system, outputs) = (self.unit.system, &self.unit.program.outputs);
        if system.measures.is_empty() {
            return String::new();
        }
        let all: Vec<Register> =
            [&outputs.measures, &outputs.measures_d, &outputs.measures_dd].into_iter().flatten().copied().collect();
        let orders = if system.jerk().is_some() { 4 } else { 3 };
        let wanted = Wanted {
            name: "all_measures",
            docs: "The measures, their rates and their accelerations, one behind the other.",
            is_public: false,
            orders,
            has_time: true,
            varied: true,
            outputs: &all,
            length: &all.len().to_string(),
            negated: false,
            given: Given::None,
        };
        let (more, call) = if orders == 4 { (", qddd: &[f64; N]", ", qddd") } else { ("", "") };
        let has_varied = self.equations.has_varied();
        let jerk = if orders == 4 { ", and their third derivatives" } else { "" };
        let jerk = jerk.to_owned() + if has_varied { ",\n/// and the derivatives of [`VARIED`]" } else { "" };
        let (more, call) = if has_varied {
            (format!("{more}, varied: &[f64; VARIED]"), format!("{call}, varied"))
        } else {
            (more.to_owned(), call.to_owned())
        };
        let head = format!("pub fn measures(q: &Q, qd: &Qd, qdd: &Qdd{more}, t: f64, p: &Params) -> Measures {{\n");
        format!(
            "/// The measures with their time derivatives, from the coordinates, their velocities and\n/// accelerations{jerk}.\n{head}    \
             let mut all = all_measures(q, qd, qdd{call}, t, p).into_iter();\n    \
             let mut next = || all.next().unwrap_or(f64::NAN) + 0.0;\n    Measures {{\n        \
             values: core::array::from_fn(|_| next()),\n        rates: core::array::from_fn(|_| next()),\n        \
             accelerations: core::array::from_fn(|_| next()),\n    }}\n}}\n\n"
        ) + &self.equations.function(&wanted)
    }

    /// What follows the motion.
    fn motion(&self, solution: &Solution<'_>) -> String {
        let system = self.unit.system;
        let (of_time, has_motion) = self.switches();
        let rims = self.rims_of_time();
        let conditions = self.conditions();
        let solve = match &self.equations.book {
            Some(_) => LARGE.to_owned(),
            None => solution.function(false),
        };
        let wanted = self.wanted(solution, &solve);
        let columns = RowLayout::new(system).printed;
        let mut text = format!("/// Number of results at a time.\npub const COLUMNS: usize = {columns};\n\n");
        text += &(chosen(STATE, &wanted)
            + "\n"
            + &solution.constants(&solve, self.unit.lanes.is_some() && solution.has_newton()));
        if !system.measures.is_empty() {
            text += MEASURES_IN_SOLUTION;
        }
        if self.equations.has_varied() {
            text += &self.is_varied();
            text += &self.is_by_two();
        }
        text += &self.left_out_limits();
        if let Some(to) = solution.motion.to.filter(|_| of_time) {
            text += &format!("/// The last time of the file's analysis (s).\nconst END: f64 = {};\n\n", literal(to));
        }
        text += &self.model(solution);
        text += &chosen(SOLVER, &wanted);
        text += "\n";
        text += &solution.tears();
        text += &match &self.equations.book {
            Some(book) => solution.as_numbers(&self.large(solution, &wanted), &mut book.borrow_mut()),
            None => solve,
        };
        text += &self.sensitivity(solution, &wanted);
        text += &conditions;
        text += &self.watches();
        text += &self.sides(of_time, has_motion, &wanted);
        text += &rims;
        if solution.motion.blocks.is_some() {
            text += "#[rustfmt::skip]\nmod blocks {\n\n";
            text += BLOCKS;
            text += "\n}\n\n";
        }
        if let Some(lanes) = self.unit.lanes.filter(|_| self.equations.book.is_none()) {
            text += &self.lanes(solution, lanes, &wanted);
        }
        text = self.filled(&text, solution);
        text.replace("$wanted", if of_time || !rims.is_empty() { "wanted" } else { "next" })
            .replace("$rimmed", if rims.is_empty() { "next" } else { "edge" })
            .replace("$rim_end", if of_time { "edge" } else { "wanted" })
            + &self.frozen(solution)
    }

    /// Whether time alone decides branches of formulas, and whether the motion does.
    pub fn switches(&self) -> (bool, bool) {
        let switches = self.unit.program.switches();
        (switches.iter().any(|switch| switch.on_time), switches.iter().any(|switch| !switch.on_time))
    }

    /// What stays of the templates.
    pub fn wanted(&self, solution: &Solution<'_>, solve: &str) -> Vec<(&'static str, bool)> {
        let (system, outputs) = (self.unit.system, &self.unit.program.outputs);
        let (of_time, motion) = self.switches();
        let is_led = self.equations.is_led;
        let is_open = |register: &Register| !self.equations.constants.contains_key(register);
        vec![
            ("bodies", !system.bodies.is_empty()),
            ("measures", !system.measures.is_empty()),
            ("sides", self.has_sides()),
            ("of_time", of_time),
            ("motion", motion),
            ("rims", outputs.rims.iter().any(|rim| rim.on_time) && !is_led),
            ("end", of_time && solution.motion.to.is_some() && !is_led),
            ("conditions", outputs.conditions.iter().any(is_open)),
            ("watches", !system.watches.is_empty()),
            ("left_out", !system.checks.is_empty()),
            ("pivoting", solution.motion.blocks.is_some()),
            ("newton", solution.has_newton()),
            ("grid", solution.has_newton() || solution.motion.blocks.is_some()),
            ("pivots", solve.contains("at.pivot(") && self.equations.book.is_none()),
            ("jerk", system.jerk().is_some()),
            ("params", !system.params.is_empty()),
            ("known", !solution.known.is_empty()),
            ("large", self.equations.book.is_some()),
            ("inputs", self.unit.following.is_some()),
            ("led", is_led),
            ("joined", !solution.joined.is_empty()),
            ("varied", self.equations.has_varied()),
        ]
    }

    /// What runs operations that are written as numbers.
    pub fn large(&self, solution: &Solution<'_>, wanted: &[(&str, bool)]) -> String {
        let is_led = self.equations.is_led;
        let has_params = !self.unit.system.params.is_empty();
        let known = if solution.known.is_empty() { "&[]" } else { "&m.known" };
        let sides = if self.has_sides() { "sides" } else { "&[]" };
        let model = if solution.known.is_empty() && !has_params && !is_led { "_" } else { "m" };
        let lists = if self.unit.system.measures.is_empty() { 3 } else { 6 };
        let lists = lists + usize::from(is_led) + usize::from(!solution.joined.is_empty());
        let of_signals = |text: &'static str| if is_led { text } else { "" };
        let template = chosen(LARGE, wanted)
            .replace("$known", known)
            .replace("$given_sides", sides)
            .replace("$time", if is_led { "m.way.list(t)" } else { "[t]" })
            .replace("$p.", if is_led { "m.way.params." } else { "m.params." })
            .replace("$lists", &lists.to_string())
            .replace("$varied", if self.equations.has_varied() { ", &[]" } else { "" })
            .replace("$joined", if solution.joined.is_empty() { "" } else { ", &self.joined" })
            .replace("$by_signal_mut", of_signals(", self.by_signal.as_flattened_mut()"))
            .replace("$by_signal", of_signals(", self.by_signal.as_flattened()"));
        template.replace("$m", model) + "\n"
    }

    /// Templates with the functions that they call, and what these are given.
    pub fn filled(&self, text: &str, solution: &Solution<'_>) -> String {
        let mut text = text.to_owned();
        let given = |name: &str| if self.has_sides() { format!("{name}_with") } else { name.to_owned() };
        for name in ["phi_q", "phi", "varied_right", "nu", "gamma", "jerk", "left_out"] {
            text = text.replace(&format!("${name}("), &format!("{}(", given(name)));
        }
        let sides = if self.has_sides() { ", sides" } else { "" };
        let argument = if self.has_sides() { ", sides: &Sides" } else { "" };
        let qddd = if self.unit.system.jerk().is_some() { ", &qddd" } else { "" };
        text.replace("$from", if solution.motion.blocks.is_some() { "from" } else { "_from" })
            .replace("$sides_argument", argument)
            .replace("$sides", sides)
            .replace("$qddd", qddd)
            .replace("$varied", if self.equations.has_varied() { ", &varied" } else { "" })
    }

    /// The derivatives by parameters, where these are wanted.
    pub fn sensitivity(&self, solution: &Solution<'_>, wanted: &[(&str, bool)]) -> String {
        let params = &self.unit.system.params;
        let function = match &self.equations.book {
            _ if params.is_empty() && solution.motion.sensitive.is_some() => Some(String::new()),
            None => solution.sensitive_function(),
            Some(book) => solution.sensitive_as_numbers(&self.large(solution, wanted), &mut book.borrow_mut()),
        };
        let Some(function) = function else {
            return String::new();
        };
        let mut text = String::new();
        if params.is_empty() && self.equations.is_led {
            return text;
        }
        if !self.equations.is_led {
            text += &format!("/// Number of parameters.\npub const PARAMS: usize = {};\n\n", params.len());
            text += "/// Where each parameter stands in what [`sensitivity`] gives.\npub mod param {\n";
            let names = Case::Constant.names(params.iter().map(|param| param.name.as_str()));
            for (k, (param, name)) in params.iter().zip(&names).enumerate() {
                text += &format!(
                    "    /// `{}` ({})\n    pub const {name}: usize = {k};\n",
                    one_line(&param.name),
                    param.unit
                );
            }
            text += "}\n\n";
            if params.is_empty() {
                return text + NO_SENSITIVITY;
            }
        }
        text += &chosen(SENSITIVITY, wanted);
        text += &function;
        if solution.motion.blocks.is_some() {
            text += &self.rights("param", &self.unit.program.outputs.by_param, "PARAMS");
        }
        text += &self.held_apart("param", &self.unit.program.outputs.check_slopes.params, "PARAMS");
        text
    }

    /// What tells derivatives apart in whose direction an equation that was left out would cease to hold; nothing where none was.
    pub fn held_apart(&self, by: &str, lists: &[Vec<Register>], count: &str) -> String {
        let (pattern, slopes) = (&self.unit.system.check_slopes.pattern, &self.unit.program.outputs.check_slopes);
        if self.unit.system.checks.is_empty() {
            return String::new();
        }
        let all: Vec<Register> = slopes.coordinates.iter().chain(lists.iter().flatten()).copied().collect();
        let function = self.equations.function(&Wanted {
            name: &format!("left_out_slopes_by_{by}"),
            docs: &format!(
                "How the equations that were left out change with the coordinates, and then with each {by}."
            ),
            is_public: false,
            orders: 1,
            has_time: true,
            varied: false,
            outputs: &all,
            length: &all.len().to_string(),
            negated: false,
            given: Given::All,
        });
        let entries: Vec<String> = pattern.iter().map(|entry| format!("{entry:?}")).collect();
        let (argument, call) = if self.has_sides() { (", sides: &Sides", ", sides") } else { ("", "") };
        HELD_APART
            .replace("$by", by)
            .replace("$count", count)
            .replace("$entries", &lines(&entries, "    "))
            .replace("$length", &entries.len().to_string())
            .replace("$misses", &literal(checks::MISSES))
            .replace("$of", if self.equations.is_led { "Way" } else { "Params" })
            .replace("$argument", argument)
            .replace("$call", call)
            + &function
    }

    /// The right sides for the derivatives of the coordinates by signals or parameters.
    pub fn rights(&self, by: &str, lists: &[Vec<Register>], count: &str) -> String {
        let all: Vec<Register> = lists.iter().flatten().copied().collect();
        let name = format!("all_rights_by_{by}");
        let function = self.equations.function(&Wanted {
            name: &name,
            docs: &format!("The partial derivatives of the equations by each {by}, negated, one behind the other."),
            is_public: false,
            orders: 1,
            has_time: true,
            varied: false,
            outputs: &all,
            length: &format!("N * {count}"),
            negated: false,
            given: Given::All,
        });
        let (argument, call) = if self.has_sides() { (", sides: &Sides", ", sides") } else { ("", "") };
        let of = if self.equations.is_led { "Way" } else { "Params" };
        format!(
            "/// The right sides of the equations for the derivatives of the coordinates by each {by}.\n#[rustfmt::skip]\n\
             fn rights_by_{by}(q: &Q, t: f64, p: &{of}{argument}) -> [Q; {count}] {{\n    \
             let mut all = {name}(q, t, p{call}).into_iter();\n    \
             core::array::from_fn(|_| core::array::from_fn(|_| all.next().unwrap_or(f64::NAN)))\n}}\n\n"
        ) + &function
    }

    /// The module for several lanes.
    fn lanes(&self, solution: &Solution<'_>, lanes: usize, wanted: &[(&str, bool)]) -> String {
        let solve = solution.function(true);
        let (system, switches) = (self.unit.system, self.unit.program.switches());
        let has = |what: &str| wanted.contains(&(what, true));
        let checks = !switches.is_empty()
            || !system.watches.is_empty()
            || !system.checks.is_empty()
            || has("conditions")
            || has("rims");
        let more = [("checks", checks), ("watched", solve.contains("at.watch("))];
        let wanted: Vec<(&str, bool)> = wanted.iter().copied().chain(more).collect();
        let tears: Vec<String> = solution.motion.solver.tears().iter().map(|tear| format!("q[{tear}]")).collect();
        let template = chosen(LANES, &wanted)
            .replace("$lanes", &lanes.to_string())
            .replace("$lane_sides", if self.has_sides() { ", &states.sides" } else { "" })
            .replace("$lane_tears", &format!("[{}]", tears.join(", ")));
        template + indented(&solve, MODULE).trim_end() + "\n}\n\n"
    }

    /// How far equations that were left out may be open.
    pub fn left_out_limits(&self) -> String {
        let checks = &self.unit.system.checks;
        if checks.is_empty() {
            return String::new();
        }
        let scales: Vec<String> = checks.iter().map(|check| literal(check.scale)).collect();
        let docs = "What each equation that was left out is judged against, and how far it may be open beside that.";
        super::text::constant(docs, "LEFT_OUT_SCALES", "f64", "LEFT_OUT", &scales)
            + &format!("const LARGEST_OPENING: f64 = {};\n\n", literal(checks::LARGEST_OPENING))
    }

    /// The parameters with what follows from them.
    fn model(&self, solution: &Solution<'_>) -> String {
        let registers = solution.known_registers();
        if registers.is_empty() {
            return "/// The mechanism with its parameters.\n#[derive(Clone, Debug)]\nstruct Model {\n    params: Params,\n}\n\n\
                impl Model {\n    fn new(params: &Params) -> Self {\n        Self { params: *params }\n    }\n}\n\n"
                .to_owned();
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
        format!(
            "/// Number of values that follow from the parameters alone.\nconst KNOWN: usize = {};\n\n\
             /// The mechanism with its parameters, and what follows from these alone.\n#[derive(Clone, Debug)]\nstruct Model {{\n    \
             params: Params,\n    known: [f64; KNOWN],\n}}\n\nimpl Model {{\n    fn new(params: &Params) -> Self {{\n        \
             Self {{\n            params: *params,\n            known: known(params),\n        }}\n    }}\n}}\n\n",
            registers.len()
        ) + &self.equations.function(&wanted)
    }

    /// Whether formulas that must be positive are.
    pub fn conditions(&self) -> String {
        let conditions = &self.unit.program.outputs.conditions;
        let is_open = |register: &&Register| !self.equations.constants.contains_key(register);
        let outputs: Vec<Register> = conditions.iter().filter(is_open).copied().collect();
        if outputs.is_empty() {
            return String::new();
        }
        let (argument, call) = if self.has_sides() { (", sides: &Sides", ", sides") } else { ("", "") };
        let wanted = Wanted {
            name: "conditions",
            docs: "Distances, and places within intervals and tables: all must be positive.",
            is_public: false,
            orders: 1,
            has_time: true,
            varied: false,
            outputs: &outputs,
            length: &outputs.len().to_string(),
            negated: false,
            given: Given::All,
        };
        format!(
            "/// Whether distances are positive, and places within their intervals and tables.\n\
             fn conditions_hold(q: &Q, t: f64, p: &Params{argument}) -> bool {{\n    \
             let mut all = conditions(q, t, p{call}).into_iter();\n    all.all(|value| value > 0.0)\n}}\n\n"
        ) + &self.equations.function(&wanted)
    }

    /// What keeps its sign along a branch.
    pub fn watches(&self) -> String {
        let outputs = &self.unit.program.outputs.watches;
        if outputs.is_empty() {
            return String::new();
        }
        let wanted = Wanted {
            name: "watched",
            docs: "What keeps its sign along a branch of the motion.",
            is_public: false,
            orders: 1,
            has_time: true,
            varied: false,
            outputs,
            length: "WATCHES",
            negated: false,
            given: Given::All,
        };
        format!("/// Number of quantities that keep their signs.\nconst WATCHES: usize = {};\n\n", outputs.len())
            + &self.equations.function(&wanted)
    }

    /// The branches of formulas.
    pub fn sides(&self, of_time: bool, has_motion: bool, wanted: &[(&str, bool)]) -> String {
        if !self.has_sides() {
            return String::new();
        }
        let switches = self.unit.program.switches();
        let all: Vec<Register> = switches.iter().map(|switch| switch.to).collect();
        let mut text = format!(
            "/// Number of places where formulas have branches.\nconst SIDES: usize = {};\n\n\
             /// Which branch is taken at each: what a comparison gives, the number of a piece.\ntype Sides = [f64; SIDES];\n\n",
            all.len()
        );
        let zero = self.zero();
        let only = |on_time: bool| -> Vec<Register> {
            switches.iter().map(|switch| if switch.on_time == on_time { switch.to } else { zero }).collect()
        };
        let function = |name: &str, docs: &str, orders: usize, outputs: &[Register], given: Given| {
            self.equations.function(&Wanted {
                name,
                docs,
                is_public: false,
                orders,
                has_time: true,
                varied: false,
                outputs,
                length: "SIDES",
                negated: false,
                given,
            })
        };
        if of_time {
            text += &chosen(SIDES, wanted);
            text += "\n";
            text += &function(
                "sides_of_time",
                "The branches that time alone decides, the others as 0.",
                0,
                &only(true),
                Given::None,
            );
        } else {
            text += "/// No branch is decided by time alone.\nfn sides_at(_: f64, _: &Model) -> Sides {\n    [0.0; SIDES]\n}\n\n";
        }
        if has_motion {
            let is_of_time: Vec<String> = switches.iter().map(|switch| switch.on_time.to_string()).collect();
            text +=
                &super::text::constant("Which of them time alone decides.", "IS_OF_TIME", "bool", "SIDES", &is_of_time);
            text += &chosen(MOTION, wanted);
            text += "\n";
            text += &function(
                "sides_of_motion",
                "The branches at a position, those of time being known.",
                1,
                &all,
                Given::OfTime,
            );
        }
        text
    }

    /// What looks for times at which formulas of time come to the end of what their functions take; nothing where none may.
    fn rims_of_time(&self) -> String {
        let rims: Vec<&Rim> = self.unit.program.outputs.rims.iter().filter(|rim| rim.on_time).collect();
        if rims.is_empty() {
            return String::new();
        }
        let outputs: Vec<Register> = rims.iter().map(|rim| rim.gauge).chain(rims.iter().map(|rim| rim.slope)).collect();
        let function = self.equations.function(&Wanted {
            name: "rims_of_time",
            docs: "Quantities that are zero where a formula of time may end, and then their slopes.",
            is_public: false,
            orders: 0,
            has_time: true,
            varied: false,
            outputs: &outputs,
            length: "2 * RIMS",
            negated: false,
            given: Given::None,
        });
        format!("/// Number of places where a formula of time may end.\nconst RIMS: usize = {};\n\n", rims.len())
            + RIMS
            + &function
    }

    /// A register that holds 0, or what no function computes.
    fn zero(&self) -> Register {
        let zero =
            self.equations.constants.iter().filter(|(_, value)| value.to_bits() == 0).map(|(register, _)| *register);
        zero.min().unwrap_or(Register::MAX)
    }

    /// The functions of the equations with branches that are given, where there are any.
    fn frozen(&self, solution: &Solution<'_>) -> String {
        let outputs = &self.unit.program.outputs;
        let (sides, has_pivoting) = (self.has_sides(), solution.motion.blocks.is_some());
        let mut text = String::new();
        let kinds = [
            ("phi_with", "phi", 1, &outputs.phi, "N", sides),
            ("phi_q_with", "phi_q", 1, &outputs.phi_q, "ENTRIES", sides),
            ("nu_with", "nu", 1, &outputs.nu, "N", sides),
            ("gamma_with", "gamma", 2, &outputs.gamma, "N", sides),
            ("left_out_with", "left_out", 1, &outputs.checks, "LEFT_OUT", sides && !outputs.checks.is_empty()),
            ("jerk_with", "jerk", 3, &outputs.jerk, "N", sides && has_pivoting && !outputs.jerk.is_empty()),
        ];
        for (name, of, orders, outputs, length, is_wanted) in kinds {
            if is_wanted {
                let docs = format!("As [`{of}`], on branches of formulas that are given.");
                text += &self.equations.function(&Wanted {
                    name,
                    docs: &docs,
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
        }
        if sides && has_pivoting {
            text += &self.varied(Given::All);
        }
        text
    }
}

/// What a solution needs of measures that are derivatives by inputs and parameters.
const LEAVE_VARIED_OUT: &str = "impl Measures {
    /// Close to a singular position derivatives by inputs and parameters have no value.
    fn leave_varied_out(&mut self) {
        let rest = self.rates.iter_mut().chain(&mut self.accelerations);
        for (value, is_varied) in self.values.iter_mut().chain(rest).zip(&IS_VARIED) {
            if *is_varied {
                *value = f64::NAN;
            }
        }
    }
}

";

/// The derivatives of the coordinates by parameters where there are none.
const NO_SENSITIVITY: &str = "/// The derivatives of the coordinates by each parameter: there is none.
///
/// # Errors
/// Never; of mechanisms with parameters there are some.
pub fn sensitivity(_: &Params, _: &State) -> Result<[Q; PARAMS], Error> {
    Ok([])
}

";

/// Derivatives in whose direction an equation that was left out would cease to hold have no value: `|D Φ| ≤ ε ‖Φ_q‖ Σ |D q|`, scaled.
const HELD_APART: &str = "/// Derivatives of the coordinates by each $by in whose direction an equation that was left out would cease to hold have no
/// value: the mechanism cannot be assembled beside where it is.
#[rustfmt::skip]
fn hold_apart_by_$by(by: &mut [Q; $count], q: &Q, t: f64, p: &$of$argument) {
    const ENTRIES: [(usize, usize); $length] = [
$entries    ];
    let slopes = left_out_slopes_by_$by(q, t, p$call);
    for (number, by) in by.iter_mut().enumerate() {
        let size: f64 = by.iter().zip(&SCALES).map(|(x, scale)| x.abs() / scale).sum();
        let mut off = [0.0; LEFT_OUT];
        let own = slopes.iter().skip(ENTRIES.len() + number * LEFT_OUT);
        off.iter_mut().zip(own).for_each(|(off, own)| *off = *own);
        for (&(check, column), slope) in ENTRIES.iter().zip(&slopes) {
            if let (Some(off), Some(x)) = (off.get_mut(check), by.get(column)) {
                *off += slope * x;
            }
        }
        if !off.iter().zip(&LEFT_OUT_SCALES).all(|(off, scale)| off.abs() <= $misses * scale * size) {
            *by = [f64::NAN; N];
        }
    }
}

";

/// What is said of the function that the equations left out are.
const LEFT_OUT_DOCS: &str = "The residual of the equations that were left out (m, m^2 or rad): nothing, as long as they follow from the others.";

/// What measures are given as.
const MEASURES: &str = "/// The measures with their time derivatives; `NAN` where one has no value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// By the indices in [`measure`].
    pub values: [f64; MEASURES],
    /// First time derivatives, by the indices in [`measure_rate`].
    pub rates: [f64; RATES],
    /// Second time derivatives, by the indices in [`measure_acceleration`].
    pub accelerations: [f64; ACCELERATIONS],
}

";

/// What a solution needs of them.
const MEASURES_IN_SOLUTION: &str = "impl Measures {
    const ZERO: Self = Self {
        values: [0.0; MEASURES],
        rates: [0.0; RATES],
        accelerations: [0.0; ACCELERATIONS],
    };

    fn lists(&self) -> [&[f64]; 3] {
        [&self.values, &self.rates, &self.accelerations]
    }

    /// What is not finite is no number.
    fn leave_out(&mut self) {
        let rest = self.rates.iter_mut().chain(&mut self.accelerations);
        for value in self.values.iter_mut().chain(rest) {
            if !value.is_finite() {
                *value = f64::NAN;
            }
        }
    }
}

";

const DENSE: &str = "/// The Jacobian as a full matrix, row by row.
pub fn phi_q_dense(q: &[f64; N], t: f64, p: &Params) -> [[f64; N]; N] {
    let mut full = [[0.0; N]; N];
    for (&(row, column), value) in PHI_Q_PATTERN.iter().zip(phi_q(q, t, p)) {
        if let Some(entry) = full.get_mut(row).and_then(|line| line.get_mut(column)) {
            *entry = value;
        }
    }
    full
}

";

/// The functions of our own that the others call.
fn helpers(body: &str) -> String {
    let mut text = String::new();
    for function in FUNCTIONS.split("\n\n") {
        let name = function.split_once("fn ").and_then(|(_, rest)| rest.split_once('(')).map_or("", |(name, _)| name);
        if is_called(body, name) {
            text += function.trim_end();
            text += "\n\n";
        }
    }
    if is_called(body, "sin_cos") {
        // as the interpreter has it, to the letter
        text += "use sine_and_cosine::sin_cos;\n\n#[rustfmt::skip]\nmod sine_and_cosine {\n\n";
        text += SIN_COS;
        text += "\n}\n";
    }
    if is_called(body, "sin_cos_below_a_million") {
        text += "\nuse without_branches::sin_cos_below_a_million;\n\n#[rustfmt::skip]\nmod without_branches {\n";
        text += "use super::sine_and_cosine::{cos_near_zero, reduce_small, sin_near_zero};\n\n";
        text += WITHOUT_BRANCHES;
        text += "\n}\n";
    }
    text
}

/// What is said of a measure that tables print in another unit.
fn in_si(measure: &Measure) -> String {
    let Units { si, printed: [printed, ..], .. } = &measure.units;
    let unit = if si == "1" { "as a pure number".to_owned() } else { format!("in {si}") };
    if si == printed { String::new() } else { format!(", {unit}; tables have it in {printed}") }
}
