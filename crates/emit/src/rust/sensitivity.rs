//! The derivatives of the coordinates by parameters.

use super::Writer;
use super::indices::numbered;
use crate::equations::FunctionSpec;
use crate::names::Case;
use crate::print::{Head, Page};
use crate::solution::Solution;
use crate::text::{constant, one_line};
use mechc_ir::program::Register;

impl Writer<'_> {
    /// Prints the functions that give sensitivities, if requested.
    pub fn sensitivity(&self, solution: &Solution<'_>, page: &mut Page) {
        let (params, is_input_driven) = (self.unit.system.params(), self.equations.is_input_driven);
        if solution.motion.sensitive.is_none() || (params.is_empty() && is_input_driven) {
            return;
        }
        if !is_input_driven {
            page.constant("Number of parameters.", "pub const PARAMS: usize", &params.len().to_string());
            let names = Case::Constant.names(params.iter().map(|param| param.name.as_str()));
            let descriptions = params.iter().map(|param| format!("`{}` ({})", one_line(&param.name), param.unit()));
            numbered(
                page,
                "Where each parameter stands in what [`sensitivity`] gives.",
                "param",
                descriptions.zip(&names),
            );
            self.public_sensitivity(page);
        }
        if params.is_empty() {
            return;
        }
        page.text(&solution.sensitive_function().unwrap_or_default());
        let has_pivoting = solution.motion.blocks.is_some();
        if has_pivoting {
            self.rights("param", self.unit.program.outputs.by_params(), "PARAMS", page);
        }
        self.left_out_slopes("param", &self.unit.program.outputs.check_slopes.params, page);
        self.requires("sensitivity", "Sensitive");
        page.item("impl Sensitive<PARAMS> for Model", |page| {
            page.line("#[rustfmt::skip]");
            let (name, call) = if self.has_sides() { ("sides", "sides, ") } else { ("_sides", "") };
            page.line(&format!(
                "fn solve_by_params(&self, guess: &Self::Tears, t: f64, {name}: &Sides, at: &mut Solution, by: &mut [Q; PARAMS]) {{"
            ));
            page.line(&format!("    solve_by_params(guess, t, self, {call}at, by);"));
            page.line("}\n");
            if has_pivoting {
                self.pivoted_by_params(page);
            }
            if !self.unit.system.checks().is_empty() {
                let (sides, given) = (if self.has_sides() { "sides" } else { "_sides" }, self.given());
                let arguments = [("&self", ""), ("by", "&mut [Q; PARAMS]"), ("at", "&Solution"), (sides, "&Sides")];
                let head = Head { kind: "fn", name: "reject_drift_by_params", arguments: &arguments, result: "" };
                let sides = if self.has_sides() { ", sides" } else { "" };
                page.function(&head, |page| self.reject_drift("param", &format!("{given}{sides}"), page));
            }
        });
    }

    fn pivoted_by_params(&self, page: &mut Page) {
        self.requires("error", "Fault");
        self.requires("pivoted_derivatives", "derivatives_with_pivoting");
        let arguments = [("&self", ""), ("from", "&Solution"), ("at", "&mut Solution"), ("by", "&mut [Q; PARAMS]")];
        let head = Head { kind: "fn", name: "pivoted_by_params", arguments: &arguments, result: "Result<(), Fault>" };
        let sides = if self.has_sides() { ", &from.sides" } else { "" };
        page.function(&head, |page| {
            page.line(&format!("let rights = |q: &Q| rights_by_param(q, from.t, {}{sides});", self.given()));
            page.line("derivatives_with_pivoting(self, from, at, by, rights)");
        });
    }

    /// Prints a call that sets derivatives to NaN in whose direction a left-out equation ceases to hold; `with` are the
    /// further arguments of `left_out_slopes_by_…`.
    pub fn reject_drift(&self, by: &str, with: &str, page: &mut Page) {
        self.requires("constraint_drift", "reject_drift");
        page.line(&format!("let slopes = left_out_slopes_by_{by}(&at.q, at.t, {with});"));
        page.line("reject_drift::<Self, _, _>(by, &LEFT_OUT_PATTERN, &slopes, &LEFT_OUT_SCALES);");
    }

    /// Prints the sparsity pattern of the Jacobian of equations that were left out.
    pub fn left_out_pattern(&self, page: &mut Page) {
        let pattern = &self.unit.system.check_slopes().pattern;
        let entries: Vec<String> = pattern.iter().map(|entry| format!("{entry:?}")).collect();
        let docs = "Row and column of the slopes of each equation that was left out.";
        page.text(&constant(docs, "LEFT_OUT_PATTERN", "(usize, usize)", &entries.len().to_string(), &entries));
    }

    /// Prints the derivatives of equations that were left out, if any.
    pub fn left_out_slopes(&self, by: &str, lists: &[Vec<Register>], page: &mut Page) {
        let slopes = &self.unit.program.outputs.check_slopes;
        if self.unit.system.checks().is_empty() {
            return;
        }
        if by == "signal" || !self.equations.is_input_driven {
            self.left_out_pattern(page);
        }
        let all: Vec<Register> = slopes.coordinates.iter().chain(lists.iter().flatten()).copied().collect();
        self.equations.function(
            &FunctionSpec {
                orders: 1,
                ..FunctionSpec::new(
                    &format!("left_out_slopes_by_{by}"),
                    &format!(
                        "How the equations that were left out change with the coordinates, and then with each {by}."
                    ),
                    &all,
                    &all.len().to_string(),
                )
            },
            page,
        );
    }

    /// Prints the public function `sensitivity`.
    fn public_sensitivity(&self, page: &mut Page) {
        let head =
            |arguments| Head { kind: "pub fn", name: "sensitivity", arguments, result: "Result<[Q; PARAMS], Error>" };
        if self.unit.system.params().is_empty() {
            page.docs("The derivatives of the coordinates by each parameter: there is none.\n\n# Errors\nNever; of mechanisms with parameters there are some.");
            return page.function(&head(&[("_", "&Params"), ("_", "&State")]), |page| page.line("Ok([])"));
        }
        page.docs(
            "The derivatives of the coordinates by each parameter, by the numbers in [`param`], at the\n\
             position that some parameters have next to that of a state; mostly the state's own. After\n\
             [`step`] what the text's formulas of inputs make of a parameter counts as well.",
        );
        if self.unit.following.is_some() {
            page.docs("Where inputs have led, they stay what they are.");
        }
        page.line("///");
        if !self.unit.system.checks().is_empty() {
            page.docs(
                "Where a parameter alone cannot change, because an equation that was left out would cease to hold,\n\
                 its derivatives are `NAN`.",
            );
            page.line("///");
        }
        page.docs("# Errors\nWhy there are none: with these parameters there is no such position.");
        page.function(&head(&[("params", "&Params"), ("state", "&State")]), |page| {
            let (file, name) = match self.unit.following {
                Some(_) => ("input_driven_sensitivity", "input_driven_sensitivity"),
                None => ("sensitivity", "sensitivity"),
            };
            self.equations.deps.borrow_mut().file(file);
            page.line(&format!("runtime::{file}::{name}(params, state)"));
        });
    }
}
