//! A mechanism as one Rust file: its equations, and what solves them.

mod doors;
mod following;
mod forces;
mod functions;
mod indices;
mod lanes;
mod large;
mod motion;
mod parameters;
mod pivoting;
mod sensitivity;
mod sides;
mod statics;
mod words;

use super::TranslationUnit;
use super::equations::Equations;
use super::goods::Uses;
use super::names::Names;
use super::params::Params;
use super::print::Page;
use super::solution::Solution;
use super::tables::{Tables, numbers};
use super::text::one_line;
use mechc_ir::program::{Column, STAGES};
use mechc_text::source::Span;
use std::cell::RefCell;
use words::Bounds;

/// A Rust module.
pub(super) struct Module {
    pub text: String,
    /// Whether it asks for the crate `libm`.
    pub needs_libm: bool,
    /// Words of 8 bytes that a state takes; 0 where nothing is solved.
    pub words: usize,
    /// How many steps calls take at most, and how many evaluations these are.
    pub bounds: Bounds,
}

/// One Rust module, self-contained but for the `libm` crate where a formula asks for it.
#[must_use]
pub fn rust(unit: &TranslationUnit<'_>) -> String {
    module(unit).text
}

/// The same, with what it asks for.
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
    let (mut words, mut lead) = (0, None);
    if let Some(motion) = &unit.motion {
        let solution = Solution::new(unit, motion, &equations);
        writer.doors(&mut body);
        writer.motion(&solution, &mut body);
        writer.lanes(&solution, &mut body);
        words = writer.words(&solution);
    }
    equations.print_book(&mut body);
    if let Some(following) = &unit.following {
        let (uses, words_of_lead, work) = following::module(following, &mut body);
        words += words_of_lead;
        lead = work;
        equations.uses.borrow_mut().include(&uses);
    }
    let bounds = if unit.motion.is_some() { writer.bounds(lead) } else { Bounds::new() };
    let uses = equations.uses.take();
    let mut page = Page::default();
    writer.header(uses.needs_libm(), &mut page);
    uses.print("runtime", &mut page);
    page.text(&body.done());
    uses.goods(&mut page);
    Module { text: page.done().trim_end().to_owned() + "\n", needs_libm: uses.needs_libm(), words, bounds }
}

/// What the functions of a unit's equations are written from; led ones are given their inputs.
fn equations<'u>(unit: &TranslationUnit<'u>, names: &'u Names, tables: &'u Tables, is_led: bool) -> Equations<'u> {
    let switches = unit.program.switches().iter().enumerate();
    Equations {
        program: unit.program,
        names,
        tables,
        constants: unit.program.constants().iter().copied().collect(),
        sides: switches.map(|(k, switch)| (switch.to, k)).collect(),
        is_led,
        book: is_large(unit).then(RefCell::default),
        uses: RefCell::new(Uses::default()),
    }
}

/// Whether a mechanism is so large that its operations are written as numbers. Tables that depend on parameters are not.
#[must_use]
pub fn is_large(unit: &TranslationUnit<'_>) -> bool {
    let of_program: usize = STAGES.iter().map(|stage| unit.program.stage(*stage).len()).sum();
    let of_motion =
        |motion: &super::EmittedMotion| motion.sensitive.as_ref().unwrap_or(&motion.solver).instructions().len();
    let of_solver = unit.motion.as_ref().map_or(0, of_motion);
    let constants = unit.program.constants().iter().copied().collect();
    let is_constant =
        |table: u32| Column::ALL.iter().all(|&column| numbers(unit.program, &constants, table, column).is_some());
    of_program + of_solver > unit.largest_straight && (0..unit.program.tables().len() as u32).all(is_constant)
}

/// What the module of a mechanism is written from, or what follows its inputs.
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
        let mut said = vec![
            format!("coordinates `q`: {n} (m, rad), equations `phi = 0`: {}", system.rows().len()),
            format!("`phi_q`: {entries} entries that do not vanish, see [`PHI_Q_PATTERN`]"),
            format!("parameters: {}; those that follow from others are worked out", system.params().len()),
        ];
        if !system.checks().is_empty() {
            said.push(format!(
                "equations that were left out as redundant: {}, see [`left_out`]",
                system.checks().len()
            ));
        }
        if self.unit.motion.is_some() {
            said.push("the motion: [`assemble`], then [`step`] from time to time".to_owned());
        }
        if self.unit.has_forces() {
            said.push("the forces: [`forces`] of a state".to_owned());
        }
        if self.unit.following.is_some() {
            said.push("the motion by its inputs: [`follow`] from [`Inputs`] to others".to_owned());
        }
        let needs = if needs_libm {
            "needs the crate `libm`, for elementary functions with the same bits on every platform"
        } else {
            "needs no other crate"
        };
        said.push(needs.to_owned());
        said.push("needs no heap and no standard library; nothing in it panics".to_owned());
        for said in said {
            page.line(&format!("//! - {said}"));
        }
        page.line("//!");
        page.line("//! This code carries no licence of mechc's: use, change and pass it on as you like.");
        page.blank();
        // a parameter of 3.14 is no approximation of pi, and a formula may hold what the parameters make trivial
        page.line("#![allow(clippy::approx_constant, clippy::eq_op)]");
        page.line("#![allow(clippy::excessive_precision, clippy::large_const_arrays)]");
        if self.equations.has_varied() {
            page.line("#![allow(clippy::too_many_arguments)]");
        }
        page.blank();
    }

    /// Where something is declared, for a comment.
    fn line(&self, span: Span) -> String {
        format!(", line {}", self.unit.sources.get(span.file).position(span.start).0)
    }

    /// Notes that a thing of a file that goes along is named.
    fn uses(&self, file: &'static str, name: &'static str) {
        self.equations.uses.borrow_mut().name(file, name);
    }

    fn has_sides(&self) -> bool {
        !self.equations.sides.is_empty()
    }

    /// Whether time alone decides branches of formulas, and whether the motion does.
    fn switches(&self) -> (bool, bool) {
        let switches = self.unit.program.switches();
        (switches.iter().any(|switch| switch.on_time), switches.iter().any(|switch| !switch.on_time))
    }

    /// The parameters, or the way, that functions of the equations are given by a method of the mechanism.
    fn given(&self) -> &'static str {
        if self.equations.is_led { "&self.way" } else { "&self.params" }
    }

    /// What a function of the equations is called whose branches are given.
    fn on_sides(&self, name: &str) -> String {
        if self.has_sides() { format!("{name}_with") } else { name.to_owned() }
    }
}
