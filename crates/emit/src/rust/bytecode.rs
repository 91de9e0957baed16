//! Solvers whose operations are encoded as numbers.

use super::Writer;
use crate::bytecode::ConstantPool;
use crate::print::{Head, Page};
use crate::solution::Solution;
use mechc_engine::solver::Solver;

/// Results that a solver gives in addition to the motion.
struct More {
    /// Name of the function.
    name: &'static str,
    what: &'static str,
    /// Argument that it is written to, with its type.
    argument: (&'static str, &'static str),
    /// The argument as a list.
    list: &'static str,
    /// Suffix of its constants.
    ending: &'static str,
}

impl Writer<'_> {
    /// Prints the solver's function.
    pub fn solver_as_numbers(&self, solution: &Solution<'_>, pool: &mut ConstantPool, page: &mut Page) {
        page.docs("Position, velocity and acceleration at a time, by the operations of [`SOLVE`].");
        self.listed(solution, "solve", &[], page, |page| {
            page.line("bytecode_solver::solve::<Numbers, REGISTERS>(&LISTING, guess, &inputs, at);");
        });
        solution.listing(&solution.motion.solver, "", pool, page);
    }

    /// Prints the solver that also gives the derivatives by parameters, as numbers.
    pub fn sensitive_solver_as_numbers(&self, solution: &Solution<'_>, pool: &mut ConstantPool, page: &mut Page) {
        let more = More {
            name: "solve_by_params",
            what: "the derivatives of the coordinates by parameters",
            argument: ("by", "&mut [Q; PARAMS]"),
            list: "by.as_flattened_mut()",
            ending: "_BY_PARAMS",
        };
        self.solver_with_more_as_numbers(solution, solution.motion.sensitive.as_ref(), &more, pool, page);
    }

    /// Prints the solver that also gives the forces of joints and drivers, as numbers.
    pub fn forced_solver_as_numbers(&self, solution: &Solution<'_>, pool: &mut ConstantPool, page: &mut Page) {
        let more = More {
            name: "solve_with_forces",
            what: "what joints exert and drivers supply",
            argument: ("forces", "&mut Forces"),
            list: "forces",
            ending: "_WITH_FORCES",
        };
        self.solver_with_more_as_numbers(solution, solution.motion.forced.as_ref(), &more, pool, page);
    }

    fn solver_with_more_as_numbers(
        &self,
        solution: &Solution<'_>,
        solver: Option<&Solver>,
        More { name, what, argument, list, ending }: &More,
        pool: &mut ConstantPool,
        page: &mut Page,
    ) {
        let Some(solver) = solver else {
            return;
        };
        self.requires("extra_results", "ExtendedResults");
        page.docs(&format!("As [`solve`], with {what}."));
        self.listed(solution, name, &[*argument], page, |page| {
            let first = solution.first_of_more();
            page.line(&format!("let mut all = ExtendedResults {{ at, more: {list}, first: {first} }};"));
            page.line(&format!(
                "bytecode_solver::solve::<Numbers, REGISTERS{ending}>(&LISTING{ending}, guess, &inputs, &mut all);"
            ));
        });
        solution.listing(solver, ending, pool, page);
    }

    /// Prints a function that interprets a listing.
    fn listed(
        &self,
        solution: &Solution<'_>,
        name: &str,
        more: &[(&str, &str)],
        page: &mut Page,
        run: impl FnOnce(&mut Page),
    ) {
        self.requires("bytecode_interpreter", "Arrays");
        let runtime = if self.equations.is_input_driven { "super::runtime" } else { "runtime" };
        let (is_input_driven, has_params) = (self.equations.is_input_driven, !self.unit.system.params().is_empty());
        let model = if solution.derived.is_empty() && !has_params && !is_input_driven { "_m" } else { "m" };
        let mut arguments = vec![("guess", "&[f64; TEARS]"), ("t", "f64"), (model, "&Model")];
        arguments.extend(self.has_sides().then_some(("sides", "&Sides")));
        arguments.push(("at", "&mut Solution"));
        arguments.extend(more);
        page.line("#[rustfmt::skip]");
        page.function(&Head { kind: "fn", name, arguments: &arguments, result: "" }, |page| {
            page.line(&format!("use {runtime}::bytecode_solver;\n"));
            page.line("at.begin(t);");
            let params = match (has_params, is_input_driven) {
                (false, _) => "&[]",
                (true, false) => "&m.params.list()",
                (true, true) => "&m.path.params.list()",
            };
            let derived = if solution.derived.is_empty() { "&[]" } else { "&m.derived" };
            let sides = if self.has_sides() { "sides" } else { "&[]" };
            let time = if is_input_driven { "&m.path.list::<{ 3 * SIGNALS }>(t)" } else { "&[t]" };
            if is_input_driven {
                self.equations.deps.borrow_mut().file("input_list");
            }
            page.line(&format!(
                "let inputs: Arrays<'_> = [{params}, {derived}, {sides}, {time}, &[], &[], &[], &[], &[], &[]];"
            ));
            run(page);
        });
    }
}
