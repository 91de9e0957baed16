//! Solvers whose operations are written as numbers.

use super::Writer;
use crate::emit::print::{Head, Page};
use crate::emit::solution::Solution;
use crate::emit::tape::Book;
use crate::solver::Solver;

impl Writer<'_> {
    /// The function that solves.
    pub fn solver_as_numbers(&self, solution: &Solution<'_>, book: &mut Book, page: &mut Page) {
        page.docs("Position, velocity and acceleration at a time, by the operations of [`SOLVE`].");
        self.listed(solution, "solve", &[], page, |page| {
            page.line("listed::solve::<Numbers, REGISTERS>(&LISTING, guess, &inputs, at);");
        });
        solution.listing(&solution.motion.solver, "", book, page);
    }

    /// The same with the derivatives by parameters.
    pub fn sensitive_solver_as_numbers(&self, solution: &Solution<'_>, book: &mut Book, page: &mut Page) {
        let Some(solver): Option<&Solver> = solution.motion.sensitive.as_ref() else {
            return;
        };
        self.uses("listed_more", "WithMore");
        page.docs("As [`solve`], with the derivatives of the coordinates by parameters.");
        self.listed(solution, "solve_by_params", &[("by", "&mut [Q; PARAMS]")], page, |page| {
            let first = solution.first_of_more();
            page.line(&format!("let mut all = WithMore {{ at, more: by.as_flattened_mut(), first: {first} }};"));
            page.line("listed::solve::<Numbers, REGISTERS_BY_PARAMS>(&LISTING_BY_PARAMS, guess, &inputs, &mut all);");
        });
        solution.listing(solver, "_BY_PARAMS", book, page);
    }

    /// The same with what joints exert and drivers supply.
    pub fn forced_solver_as_numbers(&self, solution: &Solution<'_>, book: &mut Book, page: &mut Page) {
        let Some(solver): Option<&Solver> = solution.motion.forced.as_ref() else {
            return;
        };
        self.uses("listed_more", "WithMore");
        page.docs("As [`solve`], with what joints exert and drivers supply.");
        self.listed(solution, "solve_with_forces", &[("forces", "&mut Forces")], page, |page| {
            page.line(&format!("let mut all = WithMore {{ at, more: forces, first: {} }};", solution.first_of_more()));
            page.line(
                "listed::solve::<Numbers, REGISTERS_WITH_FORCES>(&LISTING_WITH_FORCES, guess, &inputs, &mut all);",
            );
        });
        solution.listing(solver, "_WITH_FORCES", book, page);
    }

    /// A function that runs a listing.
    fn listed(
        &self,
        solution: &Solution<'_>,
        name: &str,
        more: &[(&str, &str)],
        page: &mut Page,
        run: impl FnOnce(&mut Page),
    ) {
        self.uses("tables", "Arrays");
        let runtime = if self.equations.is_led { "super::runtime" } else { "runtime" };
        let (is_led, has_params) = (self.equations.is_led, !self.unit.system.params().is_empty());
        let model = if solution.known.is_empty() && !has_params && !is_led { "_m" } else { "m" };
        let mut arguments = vec![("guess", "&[f64; TEARS]"), ("t", "f64"), (model, "&Model")];
        arguments.extend(self.has_sides().then_some(("sides", "&Sides")));
        arguments.push(("at", "&mut Solution"));
        arguments.extend(more);
        page.line("#[rustfmt::skip]");
        page.function(&Head { kind: "fn", name, arguments: &arguments, result: "" }, |page| {
            page.line(&format!("use {runtime}::listed;\n"));
            page.line("at.begin(t);");
            let params = match (has_params, is_led) {
                (false, _) => "&[]",
                (true, false) => "&m.params.list()",
                (true, true) => "&m.way.params.list()",
            };
            let known = if solution.known.is_empty() { "&[]" } else { "&m.known" };
            let sides = if self.has_sides() { "sides" } else { "&[]" };
            let time = if is_led { "&m.way.list::<{ 3 * SIGNALS }>(t)" } else { "&[t]" };
            if is_led {
                self.equations.uses.borrow_mut().file("way_list");
            }
            page.line(&format!(
                "let inputs: Arrays<'_> = [{params}, {known}, {sides}, {time}, &[], &[], &[], &[], &[], &[]];"
            ));
            run(page);
        });
    }
}
