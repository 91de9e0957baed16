//! Code that follows the motion: the mechanism as the accompanying runtime files access it.

use super::Writer;
use crate::equations::{FunctionSpec, Given};
use crate::print::{Head, Page};
use crate::solution::Solution;
use mechc_expr::{Dependence, ExprId};

impl Writer<'_> {
    /// Prints the code that follows the motion.
    pub fn motion(&self, solution: &Solution<'_>, page: &mut Page) {
        let columns = solution.columns();
        page.constant("Number of results at a time.", "pub const COLUMNS: usize", &columns.to_string());
        Self::times(solution, page);
        self.scales(solution, page);
        self.measured(page);
        self.model("params", "Params", "parameters", solution, page);
        self.solved(solution, page);
        self.boundary_search(page);
        self.timed(solution, page);
        self.sensitivity(solution, page);
        self.forces(solution, page);
    }

    /// Prints the solved system, along time or signals.
    pub fn solved(&self, solution: &Solution<'_>, page: &mut Page) {
        self.requires("solution", "Solved");
        self.requires("equations", "Equations");
        self.solved_for(solution, page);
        self.sides(page);
        page.docs("What solves the equations at a time.");
        let runtime = if self.equations.is_input_driven { "super::runtime" } else { "runtime" };
        page.line(&format!("type Solution = {runtime}::solution::Solution<Model>;\n"));
        page.text(&solution.function(false));
        if self.has_sides() || self.equations.is_input_driven {
            self.functions_on_sides(solution.motion.blocks.is_some(), page);
        }
        self.equations(page);
        self.branches(solution, page);
        self.checks(page);
        self.checked(page);
        self.solves(solution, page);
        self.pivoting(solution, page);
    }

    /// Returns a call of a function of the equations with the arguments `more`, time, parameters and branches.
    pub fn call(&self, function: &str, more: &[&str], given: Given) -> String {
        let mut arguments = more.to_vec();
        arguments.extend(["t", self.given()]);
        if given != Given::None && self.has_sides() {
            arguments.push("sides");
        }
        format!("{function}({})", arguments.join(", "))
    }

    /// Prints a method that calls a function of the equations, with additional arguments before the time.
    pub fn method(
        &self,
        page: &mut Page,
        name: &str,
        function: &str,
        more: &[(&str, &str)],
        result: &str,
        given: Given,
    ) {
        let mut arguments = vec![("&self", "")];
        arguments.extend(more);
        arguments.push(("t", "f64"));
        let is_read = self.has_sides() && given == Given::All;
        match given {
            Given::None => {}
            _ => arguments.push((if is_read { "sides" } else { "_sides" }, "&Sides")),
        }
        let names: Vec<&str> = more.iter().map(|(name, _)| *name).collect();
        let given = if is_read { Given::All } else { Given::None };
        page.function(&Head { kind: "fn", name, arguments: &arguments, result }, |page| {
            page.line(&self.call(function, &names, given));
        });
    }

    /// Prints the methods for the equations.
    fn equations(&self, page: &mut Page) {
        page.item("impl Equations for Model", |page| {
            page.line("type Q = Q;");
            page.line("type Entries = [f64; ENTRIES];");
            page.line("type Sides = Sides;\n");
            let pattern = Head { kind: "fn", name: "pattern", arguments: &[], result: "&'static [(usize, usize)]" };
            page.function(&pattern, |page| page.line("&PHI_Q_PATTERN"));
            let scales = Head { kind: "fn", name: "scales", arguments: &[], result: "&'static Q" };
            page.function(&scales, |page| page.line("&SCALES"));
            let kinds = [("phi", "Q"), ("phi_q", "Self::Entries"), ("nu", "Q")];
            for (name, result) in kinds {
                self.method(page, name, &self.on_sides(name), &[("q", "&Q")], result, Given::All);
            }
            let more = [("q", "&Q"), ("qd", "&Qd")];
            self.method(page, "gamma", &self.on_sides("gamma"), &more, "Qdd", Given::All);
        });
    }

    /// Prints the methods that solve the equations.
    fn solves(&self, solution: &Solution<'_>, page: &mut Page) {
        let (file, name, along) = if self.equations.is_input_driven {
            ("input_path", "Slopes", "Slopes<Q, SIGNALS>")
        } else {
            ("state", "Time", "Time")
        };
        self.requires(file, name);
        let measures = if self.unit.system.measures().is_empty() { "()" } else { "Measures" };
        page.item("impl Solved for Model", |page| {
            page.line("type Tears = [f64; TEARS];");
            page.line("type Turns = [bool; TURNS];");
            page.line(&format!("type Measures = {measures};"));
            page.line(&format!("type Joined = [f64; {}];", if solution.joined.is_empty() { "0" } else { "JOINED" }));
            page.line(&format!("type Along = {along};\n"));
            for (name, of, value) in [("tear_scales", "Tears", "&TEAR_SCALES"), ("turned", "Turns", "&TURNED")] {
                let head = Head { kind: "fn", name, arguments: &[], result: &format!("&'static Self::{of}") };
                page.function(&head, |page| page.line(value));
            }
            page.line("#[rustfmt::skip]");
            let q = if solution.motion.solver.tears().is_empty() { "_q" } else { "q" };
            let head = Head { kind: "fn", name: "tears", arguments: &[(q, "&Q")], result: "Self::Tears" };
            page.function(&head, |page| Self::tears(solution, page));
            let (name, call) = if self.has_sides() { ("sides", "sides, ") } else { ("_sides", "") };
            let given =
                [("&self", ""), ("guess", "&Self::Tears"), ("t", "f64"), (name, "&Sides"), ("at", "&mut Solution")];
            page.function(&Head { kind: "fn", name: "solve", arguments: &given, result: "" }, |page| {
                page.line(&format!("solve(guess, t, self, {call}at);"));
            });
            if solution.motion.blocks.is_some() {
                self.pivoted(page);
            }
        });
    }

    /// Prints the methods for the measures of a solution.
    fn measured(&self, page: &mut Page) {
        if self.unit.system.measures().is_empty() {
            return;
        }
        self.requires("measured", "Measured");
        let names = ["values", "rates", "accelerations"];
        page.item("impl Measured for Measures", |page| {
            page.block("const ZERO: Self = Self", |page| {
                for (name, length) in names.iter().zip(["MEASURES", "RATES", "ACCELERATIONS"]) {
                    page.line(&format!("{name}: [0.0; {length}],"));
                }
            });
            page.end_statement();
            if self.equations.has_varied() || self.measures_hold_forces() {
                page.line("#[rustfmt::skip]");
                page.list("const IS_VARIED: &'static [bool] = &[", &self.is_varied(), "];");
                page.blank();
            }
            for (kind, name, of) in [("&self", "lists", "&"), ("&mut self", "lists_mut", "&mut ")] {
                let head = Head { kind: "fn", name, arguments: &[(kind, "")], result: &format!("[{of}[f64]; 3]") };
                let all = names.map(|name| format!("{of}self.{name}"));
                page.function(&head, |page| page.line(&format!("[{}]", all.join(", "))));
            }
        });
    }

    /// Returns which of the measures, their rates and their accelerations hold derivatives by inputs and parameters, or forces.
    fn is_varied(&self) -> Vec<String> {
        let (graph, measures) = (self.unit.system.graph(), self.unit.system.measures());
        let is_varied = |id: ExprId| {
            let dependence = graph.dependence(id);
            (dependence.highest_varied_order().is_some() || dependence.on(Dependence::FORCES)).to_string()
        };
        let values = measures.iter().map(|measure| is_varied(measure.value));
        let rates = measures.iter().filter_map(|measure| measure.first.map(is_varied));
        let accelerations = measures.iter().filter_map(|measure| measure.second.map(is_varied));
        values.chain(rates).chain(accelerations).collect()
    }

    /// Prints the structure of the mechanism: its parameters, and the values that follow from these alone.
    pub fn model(&self, field: &str, of: &str, what: &str, solution: &Solution<'_>, page: &mut Page) {
        let registers = solution.derived_registers();
        if !registers.is_empty() {
            let docs = "Number of values that follow from the parameters alone.";
            page.constant(docs, "const DERIVED: usize", &registers.len().to_string());
            self.equations.function(
                &FunctionSpec {
                    has_time: false,
                    given: Given::None,
                    ..FunctionSpec::new("derived", "What follows from the parameters alone.", &registers, "DERIVED")
                },
                page,
            );
        }
        let more = if registers.is_empty() { "" } else { ", and what follows from these alone" };
        page.docs(&format!("The mechanism with its {what}{more}."));
        page.line("#[derive(Clone, Copy, Debug)]");
        page.item("pub struct Model", |page| {
            page.line(&format!("{field}: {of},"));
            if !registers.is_empty() {
                page.line("derived: [f64; DERIVED],");
            }
        });
    }

    /// Prints the construction of a mechanism from its arguments.
    pub fn making(solution: &Solution<'_>, field: &str, value: &str, page: &mut Page) {
        if solution.derived.is_empty() {
            page.line(&format!("Self {{ {field}: {value} }}"));
        } else {
            page.block("Self", |page| {
                page.line(&format!("{field}: {value},"));
                page.line(&format!("derived: derived({field}),"));
            });
        }
    }

    /// Prints the motion along time.
    fn timed(&self, solution: &Solution<'_>, page: &mut Page) {
        let estimates = &self.unit.program.outputs.estimates;
        let docs = "Where the file's poses put the coordinates, roughly: what is not closed yet.";
        let spec = FunctionSpec::new("drawn", docs, estimates, "N");
        self.equations.function(&FunctionSpec { has_time: false, given: Given::None, ..spec }, page);
        self.requires("state", "Timed");
        let lead = match &self.unit.following {
            Some(_) => {
                self.requires("follow", "InputContinuation");
                "InputContinuation<following::Model, SIGNALS>"
            }
            None => "()",
        };
        page.item("impl Timed for Model", |page| {
            page.line("type Params = Params;");
            page.line(&format!("type Continuation = {lead};"));
            page.line(&format!("type Passed = [f64; {}];", if self.has_boundaries() { "BOUNDARIES" } else { "0" }));
            page.line("type Row = [f64; COLUMNS];\n");
            for name in ["START_TIME", "SPAN", "LONGEST_STEP", "SMALLEST_STEP"] {
                page.line(&format!("const {name}: f64 = {name};"));
            }
            if self.has_boundaries() {
                page.line(
                    "const WORK_OF_BOUNDARIES: usize = runtime::domain_boundaries::most_work::<Self>(BOUNDARIES);",
                );
            }
            page.blank();
            let head = Head { kind: "fn", name: "new", arguments: &[("params", "&Params")], result: "Self" };
            page.function(&head, |page| Self::making(solution, "params", "*params", page));
            let head = Head { kind: "fn", name: "params", arguments: &[("&self", "")], result: "&Params" };
            page.function(&head, |page| page.line("&self.params"));
            let head = Head { kind: "fn", name: "start", arguments: &[], result: "&'static Q" };
            page.function(&head, |page| page.line("&START"));
            let head = Head { kind: "fn", name: "drawn", arguments: &[("&self", "")], result: "Q" };
            page.function(&head, |page| page.line("drawn(&self.params)"));
            if solution.motion.blocks.is_some() {
                self.requires("pivoting", "close");
                let arguments = [("&self", ""), ("q", "&Q"), ("t", "f64"), ("work", "&mut Work")];
                let head = Head { kind: "fn", name: "closed", arguments: &arguments, result: "Option<Q>" };
                page.function(&head, |page| page.line("close(self, q, t, work)"));
            }
            if self.has_boundaries() {
                self.boundaries_along(page);
            }
        });
    }

    fn boundaries_along(&self, page: &mut Page) {
        self.requires("domain_boundaries", "first_boundary");
        self.requires("domain_boundaries", "check_boundary");
        let arguments =
            [("&self", ""), ("from", "f64"), ("to", "f64"), ("passed", "&Self::Passed"), ("work", "&mut Work")];
        let head = Head { kind: "fn", name: "first_boundary", arguments: &arguments, result: "Option<(usize, f64)>" };
        page.function(&head, |page| page.line("first_boundary(self, from, to, passed, work)"));
        let arguments = [("state", "&mut State"), ("boundary", "usize"), ("t", "f64"), ("work", "&mut Work")];
        let head = Head { kind: "fn", name: "check_boundary", arguments: &arguments, result: "Result<(), Error>" };
        page.function(&head, |page| page.line("check_boundary(state, boundary, t, work)"));
    }
}
