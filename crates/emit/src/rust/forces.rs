//! Forces of joints and drivers: their indices, equations and functions.

use super::Writer;
use super::indices::numbered;
use crate::equations::{FunctionSpec, Given};
use crate::names::Case;
use crate::print::{Head, Page};
use crate::solution::Solution;
use crate::text::{constant, one_line, unit};
use mechc_engine::solver::BlockTables;
use mechc_expr::Dependence;

const NEEDED: &str = "What the multipliers of the equations have to hold: `phi_q^T multipliers = needed`, by coordinate (N where that is a
length, N m where it is an angle). It is what the inertia of the bodies asks for, less weights and loads.";

const EXERTED: &str =
    "What joints exert and drivers supply, by the numbers in [`force`], from the coordinates and the multipliers of
[`needed`].";

const FORCES: &str =
    "What joints exert and drivers supply at a state, by the numbers in [`force`]; `NAN` close to a singular
position, where there is none.";

impl Writer<'_> {
    /// Prints the positions of forces and their equations, if forces are requested.
    pub fn force_indices(&self, page: &mut Page) {
        let reactions = self.unit.system.reactions();
        if reactions.is_empty() {
            return;
        }
        let names = Case::Constant.names(reactions.iter().map(|of| of.name.as_str()));
        let descriptions =
            reactions.iter().map(|of| format!("`{}` ({}){}", one_line(&of.name), unit(&of.unit), self.line(of.span)));
        numbered(
            page,
            "Where each force and moment that a joint exerts, and what each driver supplies, stands in [`Forces`].",
            "force",
            descriptions.zip(&names),
        );
        page.constant("How many they are.", "pub const FORCES: usize", &reactions.len().to_string());
        page.constant(
            "What joints exert on their second bodies, and what drivers supply.",
            "pub type Forces",
            "[f64; FORCES]",
        );
    }

    /// Prints the public functions.
    pub fn force_functions(&self, page: &mut Page) {
        if self.equations.has_forces() {
            self.needed(Given::None, page);
            self.exerted(true, page);
        }
    }

    /// Prints the loads that multipliers have to balance.
    pub fn needed(&self, given: Given, page: &mut Page) {
        let is_public = given == Given::None;
        let name = if is_public { "needed".to_owned() } else { self.on_sides("needed") };
        let spec = FunctionSpec::new(&name, NEEDED, &self.unit.program.outputs.forces, "N");
        let orders = if self.forces_hold_jerk() { 4 } else { 3 };
        self.equations.function(&FunctionSpec { is_public, orders, given, ..spec }, page);
    }

    /// Returns whether loads hold third derivatives of the coordinates.
    fn forces_hold_jerk(&self) -> bool {
        let (system, is_third) = (self.unit.system, |of: Dependence| of.highest_order() == Some(3));
        system.required_forces().iter().any(|&of| is_third(system.graph().dependence(of)))
    }

    /// Prints the forces that multipliers exert, if columns need them.
    fn exerted(&self, is_public: bool, page: &mut Page) {
        let outputs = &self.unit.program.outputs.reactions;
        if !outputs.is_empty() {
            let spec = FunctionSpec::new("exerted", EXERTED, outputs, "FORCES");
            let spec = FunctionSpec { is_public, orders: 1, multipliers: true, given: Given::None, ..spec };
            self.equations.function(&spec, page);
        }
    }

    /// Returns whether measures hold forces.
    pub fn measures_hold_forces(&self) -> bool {
        let graph = self.unit.system.graph();
        self.unit.system.measures().iter().any(|of| graph.dependence(of.value).on(Dependence::FORCES))
    }

    /// Prints the functions that give forces, if there are masses or loads.
    pub fn forces(&self, solution: &Solution<'_>, page: &mut Page) {
        if solution.motion.forced.is_none() {
            return;
        }
        let is_input_driven = self.equations.is_input_driven;
        if !is_input_driven {
            page.docs(FORCES);
            page.line("#[must_use]");
            let head = Head { kind: "pub fn", name: "forces", arguments: &[("state", "&State")], result: "Forces" };
            let (file, name) = match self.unit.following {
                Some(_) => ("input_driven_forces", "input_driven_forces"),
                None => ("forces", "forces"),
            };
            self.equations.deps.borrow_mut().file(file);
            page.function(&head, |page| page.line(&format!("runtime::{file}::{name}(state)")));
        }
        page.text(&solution.forced_function().unwrap_or_default());
        let has_pivoting = solution.motion.blocks.is_some();
        if has_pivoting && is_input_driven {
            self.exerted(false, page);
        }
        self.requires("forces", "Forced");
        page.item("impl Forced for Model", |page| {
            page.line("type Forces = Forces;\n");
            page.line("#[rustfmt::skip]");
            let (name, call) = if self.has_sides() { ("sides", "sides, ") } else { ("_sides", "") };
            page.line(&format!(
                "fn solve_with_forces(&self, guess: &Self::Tears, t: f64, {name}: &Sides, at: &mut Solution, forces: &mut Forces) {{"
            ));
            page.line(&format!("    solve_with_forces(guess, t, self, {call}at, forces);"));
            page.line("}\n");
            if has_pivoting {
                self.pivoted_forces(page);
            }
        });
    }

    fn pivoted_forces(&self, page: &mut Page) {
        self.requires("error", "Fault");
        self.requires("pivoted_forces", "forces_with_pivoting");
        let arguments = [("&self", ""), ("from", "&Solution"), ("at", "&mut Solution"), ("forces", "&mut Forces")];
        let head = Head { kind: "fn", name: "pivoted_forces", arguments: &arguments, result: "Result<(), Fault>" };
        page.function(&head, |page| {
            page.line(&format!(
                "let exerted = |q: &Q, multipliers: &Q| exerted(q, multipliers, from.t, {});",
                self.given()
            ));
            page.line("forces_with_pivoting(self, from, at, forces, exerted)");
        });
    }

    /// Prints the transposed matrix for elimination with partial pivoting, if forces are requested.
    pub fn transposed(&self, tables: &BlockTables, page: &mut Page) {
        if !self.equations.has_forces() {
            return;
        }
        self.requires("pivoting", "Transposed");
        let (transposed, places) = tables.transposed();
        let places: Vec<String> = places.iter().map(usize::to_string).collect();
        let docs = "The place of each entry of the transposed Jacobian in the Jacobian.";
        page.text(&constant(docs, "PLACES", "usize", "ENTRIES", &places));
        let docs = "How the transposed equations fall apart into blocks.";
        Self::table_of_blocks("TRANSPOSED", docs, &transposed, page);
        page.docs("The transposed Jacobian.");
        page.block("static ACROSS: Transposed = Transposed", |page| {
            page.line("blocks: &TRANSPOSED,");
            page.line("places: &PLACES,");
        });
        page.end_statement();
    }

    /// Prints the functions that elimination with partial pivoting needs.
    pub fn pivoted_multipliers(&self, page: &mut Page) {
        if !self.equations.has_forces() {
            return;
        }
        let head = Head { kind: "fn", name: "transposed", arguments: &[], result: "Option<&'static Transposed>" };
        page.function(&head, |page| page.line("Some(&ACROSS)"));
        let names = ["q", "qd", "qdd", "qddd"];
        let (orders, names) =
            if self.forces_hold_jerk() { ("[q, qd, qdd, qddd]", &names[..]) } else { ("[q, qd, qdd, _]", &names[..3]) };
        self.right_side(page, "needed", &[(orders, "[&Q; 4]")], names, "Q");
    }
}
