//! Public functions for the equations, their derivatives and the measures.

use super::Writer;
use crate::equations::{FunctionSpec, Given};
use crate::names::{MULTIPLIERS, VARIED};
use crate::print::{Head, Page};
use crate::text::one_line;
use mechc_ir::program::Register;

/// Largest number of coordinates for which the Jacobian is also emitted as a full matrix.
const LARGEST_DENSE: usize = 64;

/// Documentation of the function for the equations that were left out.
const LEFT_OUT: &str = "The residual of the equations that were left out (m, m^2 or rad): nothing, as long as they follow from the others.";

/// Documentation of the right sides for derivatives by inputs and parameters.
const VARIED_RIGHT: &str =
    "Right sides of the equations `phi_q x = varied_right` for each list of `N` of [`VARIED`]. Those by one are found
before those by two, those of `q` before those of `qd` and these before those of `qdd`: what is not found yet
may be anything.";

/// Function for the equations or one of their derivatives.
struct Kind<'k> {
    name: &'k str,
    docs: &'k str,
    /// Number of arrays of coordinates that it is given, from the coordinates to their highest derivative.
    orders: usize,
    outputs: &'k [Register],
    length: &'k str,
}

impl Writer<'_> {
    /// Returns the functions of the equations, including residuals of left-out ones.
    fn kinds(&self) -> Vec<Kind<'_>> {
        let outputs = &self.unit.program.outputs;
        let kind = |name, docs, orders, outputs, length| Kind { name, docs, orders, outputs, length };
        let docs = "The Jacobian: the values of its entries, in the order of [`PHI_Q_PATTERN`] (the equation's unit per m or\nrad).";
        let mut kinds = vec![
            kind("phi", "The residual of the equations, each in its unit: see [`row`].", 1, &outputs.phi[..], "N"),
            kind("phi_q", docs, 1, &outputs.phi_q, "ENTRIES"),
        ];
        let docs = "The partial derivative of `phi` by time (the equation's unit per s).";
        kinds.push(kind("phi_t", docs, 1, outputs.nu(), "N"));
        let docs = "Right side of the velocity equation `phi_q qd = nu` (the equation's unit per s).";
        kinds.push(kind("nu", docs, 1, outputs.nu(), "N"));
        let docs = "Right side of the acceleration equation `phi_q qdd = gamma` (the equation's unit per s^2).";
        kinds.push(kind("gamma", docs, 2, outputs.gamma(), "N"));
        if !outputs.jerk().is_empty() {
            kinds.push(kind("jerk", "Right side of the jerk equation `phi_q qddd = jerk`.", 3, outputs.jerk(), "N"));
        }
        if !outputs.checks.is_empty() {
            kinds.push(kind("left_out", LEFT_OUT, 1, &outputs.checks, "LEFT_OUT"));
        }
        kinds
    }

    /// Prints the public functions.
    pub fn functions(&self, page: &mut Page) {
        self.left_out(page);
        for Kind { name, docs, orders, outputs, length } in self.kinds() {
            self.equations.function(
                &FunctionSpec {
                    is_public: true,
                    orders,
                    negated: name == "phi_t",
                    given: Given::None,
                    ..FunctionSpec::new(name, docs, outputs, length)
                },
                page,
            );
        }
        if self.unit.system.coordinates().len() <= LARGEST_DENSE {
            dense(page);
        }
        self.varied_lists(page);
        self.varied(Given::None, page);
        self.force_functions(page);
        self.measures("pub fn", page);
    }

    /// Prints those functions of the equations on given branches that a solution needs.
    pub fn functions_on_sides(&self, has_pivoting: bool, page: &mut Page) {
        let is_input_driven = self.equations.is_input_driven;
        for Kind { name, orders, outputs, length, .. } in self.kinds() {
            let is_wanted = match name {
                "phi_t" => false,
                "jerk" => has_pivoting && !is_input_driven,
                _ => true,
            };
            if !is_wanted {
                continue;
            }
            let (of, with) = if is_input_driven { ("super::", "the signals of a way") } else { ("", "") };
            let docs = if is_input_driven {
                format!("As [`{of}{name}`], with {with}.")
            } else {
                format!("As [`{name}`], on branches of formulas that are given.")
            };
            self.equations.function(
                &FunctionSpec { orders, ..FunctionSpec::new(&self.on_sides(name), &docs, outputs, length) },
                page,
            );
        }
        if has_pivoting {
            if self.equations.has_forces() {
                self.needed(Given::All, page);
            }
            self.varied(Given::All, page);
        }
    }

    /// Prints which equations were left out.
    fn left_out(&self, page: &mut Page) {
        let system = self.unit.system;
        if system.checks().is_empty() {
            return;
        }
        page.docs("Number of equations that were left out, since they follow from the others. Those of:");
        for of in system.checks().chunk_by(|a, b| a.declaration == b.declaration) {
            let declaration = &system.declarations()[of[0].declaration];
            let (kind, name, line) = (declaration.kind.noun(), &declaration.name, self.line(declaration.span));
            page.docs(&format!("- {kind} `{name}`: {}{line}", of.len()));
        }
        page.line(&format!("pub const LEFT_OUT: usize = {};\n", system.checks().len()));
    }

    /// Prints which derivatives by inputs and parameters measures hold.
    fn varied_lists(&self, page: &mut Page) {
        let (system, variations) = (self.unit.system, &self.unit.program.outputs.variations);
        if variations.is_empty() {
            return;
        }
        page.docs(
            "Number of derivatives of the coordinates by inputs and parameters that measures hold. For each of the\n\
             following one behind the other: those of `q`, of `qd` and of `qdd`. By",
        );
        for variation in system.variations() {
            let (first, second) = variation.by;
            let by = [Some(first), second].into_iter().flatten();
            let names = by.map(|by| one_line(&system.variables()[by as usize].name));
            page.docs(&format!("- {}", names.collect::<Vec<String>>().join(" and ")));
        }
        let count = variations.iter().flatten().flatten().count();
        page.line(&format!("pub const VARIED: usize = {count};\n"));
    }

    /// Prints the right sides of the equations for the derivatives by inputs and parameters that measures hold, if any.
    fn varied(&self, given: Given, page: &mut Page) {
        let variations = &self.unit.program.outputs.variations;
        if variations.is_empty() {
            return;
        }
        let outputs: Vec<Register> = variations.iter().flatten().flatten().copied().collect();
        let is_public = given == Given::None;
        self.equations.function(
            &FunctionSpec {
                is_public,
                orders: 3,
                varied: true,
                given,
                ..FunctionSpec::new(
                    &if is_public { "varied_right".to_owned() } else { self.on_sides("varied_right") },
                    VARIED_RIGHT,
                    &outputs,
                    "VARIED",
                )
            },
            page,
        );
    }

    /// Prints the measures with their derivatives.
    pub fn measures(&self, kind: &str, page: &mut Page) {
        let (system, outputs) = (self.unit.system, &self.unit.program.outputs);
        if system.measures().is_empty() {
            return;
        }
        let (has_jerk, has_varied) = (system.jerk().is_some(), self.equations.has_varied());
        let has_forces = self.measures_hold_forces();
        let p = if self.equations.is_input_driven { "&Path" } else { "&Params" };
        let given = [("q", "&Q", true), ("qd", "&Qd", true), ("qdd", "&Qdd", true), ("qddd", "&[f64; N]", has_jerk)];
        let more = [(VARIED, "&[f64; VARIED]", has_varied), (MULTIPLIERS, "&[f64; N]", has_forces)];
        let given = given.into_iter().chain(more).chain([("t", "f64", true), ("p", p, true)]);
        let arguments: Vec<(&str, &str)> =
            given.filter(|(.., is_given)| *is_given).map(|(name, of, _)| (name, of)).collect();
        let jerk = if has_jerk { ", and their third derivatives" } else { "" };
        let varied = if has_varied { ",\nand the derivatives of [`VARIED`]" } else { "" };
        let forces = if has_forces { ",\nand the multipliers of [`needed`]" } else { "" };
        page.docs(&format!(
            "The measures with their time derivatives, from the coordinates, their velocities and\naccelerations{jerk}{varied}{forces}."
        ));
        page.function(&Head { kind, name: "measures", arguments: &arguments, result: "Measures" }, |page| {
            let names: Vec<&str> = arguments.iter().map(|(name, _)| *name).collect();
            page.line(&format!("let mut all = all_measures({}).into_iter();", names.join(", ")));
            page.line("let mut next = || all.next().unwrap_or(f64::NAN) + 0.0;");
            page.block("Measures", |page| {
                for name in ["values", "rates", "accelerations"] {
                    page.line(&format!("{name}: core::array::from_fn(|_| next()),"));
                }
            });
        });
        let all: Vec<Register> =
            [&outputs.measures, &outputs.measures_d, &outputs.measures_dd].into_iter().flatten().copied().collect();
        self.equations.function(
            &FunctionSpec {
                orders: if has_jerk { 4 } else { 3 },
                varied: true,
                multipliers: has_forces,
                given: Given::None,
                ..FunctionSpec::new(
                    "all_measures",
                    "The measures, their rates and their accelerations, one behind the other.",
                    &all,
                    &all.len().to_string(),
                )
            },
            page,
        );
    }
}

/// Prints the Jacobian as a matrix.
fn dense(page: &mut Page) {
    page.docs("The Jacobian as a full matrix, row by row.");
    let arguments = [("q", "&[f64; N]"), ("t", "f64"), ("p", "&Params")];
    let head = Head { kind: "pub fn", name: "phi_q_dense", arguments: &arguments, result: "[[f64; N]; N]" };
    page.function(&head, |page| {
        page.line("let mut full = [[0.0; N]; N];");
        page.block("for (&(row, column), value) in PHI_Q_PATTERN.iter().zip(phi_q(q, t, p))", |page| {
            let entry = "if let Some(entry) = full.get_mut(row).and_then(|line| line.get_mut(column))";
            page.block(entry, |page| page.line("*entry = value;"));
        });
        page.line("full");
    });
}
