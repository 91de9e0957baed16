//! Conditions that decide the branches of formulas, and checks that must hold on them.

use super::Writer;
use crate::equations::{FunctionSpec, Given};
use crate::print::{Head, Page};
use crate::solution::Solution;
use crate::text::{constant, literal};
use mechc_ir::program::{BoundaryRegisters, Register};

impl Writer<'_> {
    /// Prints the functions that determine the branches of formulas.
    pub fn sides(&self, page: &mut Page) {
        let switches = self.unit.program.switches();
        let docs = "Number of places where formulas have branches.";
        page.constant(docs, "const SIDES: usize", &switches.len().to_string());
        let docs = "Which branch is taken at each: what a comparison gives, the number of a piece.";
        page.constant(docs, "type Sides", "[f64; SIDES]");
        let (of_time, of_motion) = self.switches();
        if of_time {
            let zero = self.zero();
            let only: Vec<Register> =
                switches.iter().map(|switch| if switch.on_time { switch.to } else { zero }).collect();
            let docs = "The branches that time alone decides, the others as 0.";
            self.equations.function(&spec_of_sides("sides_of_time", docs, 0, &only, Given::None), page);
        }
        if of_motion {
            let is_of_time: Vec<String> = switches.iter().map(|switch| switch.on_time.to_string()).collect();
            page.text(&constant("Which of them time alone decides.", "IS_OF_TIME", "bool", "SIDES", &is_of_time));
            let all: Vec<Register> = switches.iter().map(|switch| switch.to).collect();
            let docs = "The branches at a position, those of time being known.";
            self.equations.function(&spec_of_sides("sides_of_motion", docs, 1, &all, Given::OfTime), page);
        }
    }

    /// Returns a register that holds 0, or one that no function computes.
    fn zero(&self) -> Register {
        let zero =
            self.equations.constants.iter().filter(|(_, value)| value.to_bits() == 0).map(|(register, _)| *register);
        zero.min().unwrap_or(Register::MAX)
    }

    /// Prints the conditions that decide the branches, for the solver of the equations.
    pub fn branches(&self, solution: &Solution<'_>, page: &mut Page) {
        self.requires("equations", "Branches");
        let (of_time, of_motion) = self.switches();
        if !of_time && !of_motion {
            page.line("impl Branches for Model {}\n");
            return;
        }
        page.item("impl Branches for Model", |page| {
            if of_time {
                page.line("const OF_TIME: bool = true;");
            }
            if of_motion {
                page.line("const OF_MOTION: bool = true;");
            }
            if let Some(to) = solution.motion.to.filter(|_| !self.equations.is_input_driven) {
                page.line(&format!("const END: Option<f64> = Some({});", literal(to)));
            }
            page.blank();
            if of_time {
                self.method(page, "sides_of_time", "sides_of_time", &[], "Sides", Given::None);
            }
            if of_motion {
                let head = Head { kind: "fn", name: "is_of_time", arguments: &[], result: "&'static [bool]" };
                page.function(&head, |page| page.line("&IS_OF_TIME"));
                self.method(page, "sides_of_motion", "sides_of_motion", &[("q", "&Q")], "Sides", Given::All);
            }
        });
    }

    /// Prints the functions for the conditions that must hold in addition to the equations.
    pub fn checks(&self, page: &mut Page) {
        let (outputs, watches) = (self.open_conditions(), &self.unit.program.outputs.watches);
        let mut function = |name: &str, docs: &str, outputs: &[Register], length: &str| {
            self.equations
                .function(&FunctionSpec { orders: 1, ..FunctionSpec::new(name, docs, outputs, length) }, page);
        };
        if !outputs.is_empty() {
            let docs = "Distances, and places within intervals and tables: all must be positive.";
            function("conditions", docs, &outputs, &outputs.len().to_string());
        }
        if !watches.is_empty() {
            let docs = "What keeps its sign along a branch of the motion.";
            function("monitors", docs, watches, &watches.len().to_string());
        }
        let checks = self.unit.system.checks();
        if !checks.is_empty() {
            let scales: Vec<String> = checks.iter().map(|check| literal(check.scale)).collect();
            let docs = "What each equation that was left out is judged against.";
            page.text(&constant(docs, "LEFT_OUT_SCALES", "f64", "LEFT_OUT", &scales));
        }
    }

    /// Returns the formulas that must be positive, without those that are constant.
    fn open_conditions(&self) -> Vec<Register> {
        let is_open = |register: &&Register| !self.equations.constants.contains_key(register);
        self.unit.program.outputs.conditions.iter().filter(is_open).copied().collect()
    }

    /// Returns whether any checks must hold in addition to the equations.
    pub fn has_checks(&self) -> bool {
        let is_left_out = !self.unit.system.checks().is_empty();
        let has_monitors = !self.unit.system.monitors().is_empty();
        self.has_sides() || is_left_out || has_monitors || self.has_boundaries() || !self.open_conditions().is_empty()
    }

    /// Prints the checks that must hold, for the solver of the equations.
    pub fn checked(&self, page: &mut Page) {
        self.requires("equations", "Checks");
        let watches = self.unit.program.outputs.watches.len();
        let call = |name: &str, given: Given| self.call(name, &["q"], given);
        let answer = |page: &mut Page, name: &str, result: &str, body: [&str; 2]| {
            let sides = if self.has_sides() { "sides" } else { "_sides" };
            let arguments = [("&self", ""), ("q", "&Q"), ("t", "f64"), (sides, "&Sides")];
            page.function(&Head { kind: "fn", name, arguments: &arguments, result }, |page| {
                for line in body {
                    page.line(line);
                }
            });
        };
        page.item("impl Checks for Model", |page| {
            page.line(&format!("type Monitors = [bool; {watches}];"));
            if !self.unit.system.checks().is_empty() {
                page.line("const HAS_REDUNDANT_ROWS: bool = true;");
            }
            page.blank();
            if !self.open_conditions().is_empty() {
                let all = format!("let all = {};", call("conditions", Given::All));
                answer(page, "conditions_hold", "bool", [&all, "all.iter().all(|value| *value > 0.0)"]);
            }
            if !self.unit.system.checks().is_empty() {
                self.requires("redundant_rows", "redundant_rows_hold");
                let left = format!("let left = {};", call(&self.on_sides("left_out"), Given::All));
                answer(page, "redundant_rows_hold", "bool", [&left, "redundant_rows_hold(&left, &LEFT_OUT_SCALES)"]);
            }
            if watches > 0 {
                self.requires("monitors", "positive");
                let all = format!("let all = {};", call("monitors", Given::All));
                answer(page, "monitors", "Self::Monitors", [&all, "positive(&all)"]);
            }
        });
    }

    /// Returns whether formulas of time may leave the domain of their functions.
    pub fn has_boundaries(&self) -> bool {
        self.boundaries().next().is_some()
    }

    pub fn boundaries(&self) -> impl Iterator<Item = &BoundaryRegisters> {
        let is_input_driven = self.equations.is_input_driven;
        self.unit
            .program
            .outputs
            .domain_boundaries
            .iter()
            .filter(move |boundary| boundary.is_of_time() && !is_input_driven)
    }

    /// Prints the search for times at which formulas of time reach the boundary of their domain, if any may.
    pub fn boundary_search(&self, page: &mut Page) {
        if !self.has_boundaries() {
            return;
        }
        let outputs: Vec<Register> = self
            .boundaries()
            .map(|boundary| boundary.gauge)
            .chain(self.boundaries().filter_map(|boundary| boundary.slope))
            .collect();
        let docs = "Number of places where a formula of time may end.";
        page.constant(docs, "const BOUNDARIES: usize", &self.boundaries().count().to_string());
        self.equations.function(
            &FunctionSpec {
                given: Given::None,
                ..FunctionSpec::new(
                    "domain_gauges",
                    "Quantities that are zero where a formula of time may end, and then their slopes.",
                    &outputs,
                    "2 * BOUNDARIES",
                )
            },
            page,
        );
        self.requires("domain_boundaries", "BoundedDomain");
        page.item("impl BoundedDomain for Model", |page| {
            page.line("type Gauges = [f64; 2 * BOUNDARIES];\n");
            self.method(page, "gauges", "domain_gauges", &[], "Self::Gauges", Given::None);
        });
    }
}

/// Returns the specification of a function that determines branches of formulas.
fn spec_of_sides<'f>(
    name: &'f str,
    docs: &'f str,
    orders: usize,
    outputs: &'f [Register],
    given: Given,
) -> FunctionSpec<'f> {
    FunctionSpec { orders, given, ..FunctionSpec::new(name, docs, outputs, "SIDES") }
}
