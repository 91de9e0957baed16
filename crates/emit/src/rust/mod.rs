//! A mechanism as one Rust file: its equations and solver.

mod branch_conditions;
mod constants;
mod entry_points;
mod following;
mod forces;
mod functions;
mod indices;
mod lanes;
mod motion;
mod parameters;
mod pivoting;
mod sensitivity;
mod state_size;

use super::TranslationUnit;
use super::equations::Equations;
use super::names::Names;
use super::params::Params;
use super::print::Page;
use super::runtime_files::RuntimeDeps;
use super::solution::Solution;
use super::tables::Tables;
use super::text::one_line;
use mechc_text::source::Span;
use state_size::Bounds;
use std::cell::RefCell;

/// Emitted Rust module.
pub(super) struct Module {
    pub text: String,
    /// True if it needs the crate `libm`.
    pub needs_libm: bool,
    /// Words of 8 bytes that a state takes; 0 without a solver.
    pub words: usize,
    /// Upper bounds of the steps of calls, and of their evaluations.
    pub bounds: Bounds,
}

/// Returns one Rust module, self-contained except for the `libm` crate if a formula needs it.
#[must_use]
pub fn rust(unit: &TranslationUnit<'_>) -> String {
    module(unit).text
}

/// Returns the module with its requirements.
pub(super) fn module(unit: &TranslationUnit<'_>) -> Module {
    let tables = Tables::new(unit.program);
    let names = Names::new(unit.system, Params::new(unit.system).paths, &tables.variables());
    let equations = equations(unit, &names, &tables, false);
    let writer = Writer { unit, names: &names, equations: &equations };
    let mut body = Page::default();
    writer.parameters(&mut body);
    writer.indices(&mut body);
    writer.tables(&mut body);
    writer.functions(&mut body);
    let (mut words, mut work_to_follow) = (0, None);
    if let Some(motion) = &unit.motion {
        let solution = Solution::new(unit, motion, &equations);
        writer.entry_points(&mut body);
        writer.motion(&solution, &mut body);
        writer.lanes(&solution, &mut body);
        words = writer.words(&solution);
    }
    if let Some(following) = &unit.following {
        let (deps, words_of_input_path, work) = following::module(following, &mut body);
        words += words_of_input_path;
        work_to_follow = work;
        equations.deps.borrow_mut().include(&deps);
    }
    let bounds = if unit.motion.is_some() { writer.bounds(work_to_follow) } else { Bounds::new() };
    let deps = equations.deps.take();
    let mut page = Page::default();
    writer.header(deps.needs_libm(), &mut page);
    deps.print("runtime", &mut page);
    page.text(&body.done());
    deps.print_runtime(&mut page);
    Module { text: page.done().trim_end().to_owned() + "\n", needs_libm: deps.needs_libm(), words, bounds }
}

/// Returns the source of the functions of a unit's equations; those driven by inputs are given these.
fn equations<'u>(
    unit: &TranslationUnit<'u>,
    names: &'u Names,
    tables: &'u Tables,
    is_input_driven: bool,
) -> Equations<'u> {
    let switches = unit.program.switches().iter().enumerate();
    Equations {
        program: unit.program,
        names,
        tables,
        constants: unit.program.constants().iter().copied().collect(),
        sides: switches.map(|(k, switch)| (switch.to, k)).collect(),
        is_input_driven,
        deps: RefCell::new(RuntimeDeps::default()),
    }
}

/// Source of the module of a mechanism, or of the module that follows its inputs.
struct Writer<'w> {
    unit: &'w TranslationUnit<'w>,
    names: &'w Names,
    equations: &'w Equations<'w>,
}

impl Writer<'_> {
    fn header(&self, needs_libm: bool, page: &mut Page) {
        let system = self.unit.system;
        let (n, entries) = (system.coordinates().len(), system.phi_q().entries().len());
        let (name, file) = (one_line(system.name()), one_line(self.unit.file));
        page.line(&format!(
            "//! Kinematics of mechanism `{name}`, written by mechc {} from `{file}`.",
            env!("CARGO_PKG_VERSION")
        ));
        page.line("//!");
        let mut facts = vec![
            format!("coordinates `q`: {n} (m, rad), equations `phi = 0`: {}", system.rows().len()),
            format!("`phi_q`: {entries} entries that do not vanish, see [`PHI_Q_PATTERN`]"),
            format!("parameters: {}; those that follow from others are worked out", system.params().len()),
        ];
        if !system.checks().is_empty() {
            facts.push(format!(
                "equations that were left out as redundant: {}, see [`left_out`]",
                system.checks().len()
            ));
        }
        if self.unit.motion.is_some() {
            facts.push("the motion: [`assemble`], then [`step`] from time to time".to_owned());
        }
        if self.unit.has_forces() {
            facts.push("the forces: [`forces`] of a state".to_owned());
        }
        if self.unit.following.is_some() {
            facts.push("the motion by its inputs: [`follow`] from [`Inputs`] to others".to_owned());
        }
        let needs = if needs_libm {
            "needs the crate `libm`, for elementary functions with the same bits on every platform"
        } else {
            "needs no other crate"
        };
        facts.push(needs.to_owned());
        facts.push("needs no heap and no standard library; nothing in it panics".to_owned());
        for fact in facts {
            page.line(&format!("//! - {fact}"));
        }
        page.line("//!");
        page.line("//! This code carries no licence of mechc's: use, change and pass it on as you like.");
        page.blank();
        // a parameter of 3.14 is no approximation of pi, and a formula may hold what the parameters make trivial
        page.line("#![allow(clippy::approx_constant, clippy::eq_op, clippy::neg_multiply)]");
        page.line("#![allow(clippy::excessive_precision, clippy::large_const_arrays)]");
        if self.equations.has_varied() {
            page.line("#![allow(clippy::too_many_arguments)]");
        }
        page.blank();
    }

    /// Returns the line of a declaration, for a comment.
    fn line(&self, span: Span) -> String {
        format!(", line {}", self.unit.sources.get(span.file).position(span.start).0)
    }

    /// Records the use of an item of a runtime file.
    fn requires(&self, file: &'static str, name: &'static str) {
        self.equations.deps.borrow_mut().name(file, name);
    }

    fn has_sides(&self) -> bool {
        !self.equations.sides.is_empty()
    }

    /// Returns whether time alone decides branches of formulas, and whether the motion does.
    fn switches(&self) -> (bool, bool) {
        let switches = self.unit.program.switches();
        (switches.iter().any(|switch| switch.on_time), switches.iter().any(|switch| !switch.on_time))
    }

    /// Returns the expression for the parameters or the input path that methods of the mechanism pass to functions of the equations.
    fn given(&self) -> &'static str {
        if self.equations.is_input_driven { "&self.path" } else { "&self.params" }
    }

    /// Returns the name of a function of the equations whose branches are given.
    fn on_sides(&self, name: &str) -> String {
        if self.has_sides() { format!("{name}_with") } else { name.to_owned() }
    }
}
