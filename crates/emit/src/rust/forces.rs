//! What joints exert and drivers supply: where it stands, what it follows from, and what gives it.

use super::Writer;
use super::indices::numbered;
use crate::equations::{Given, Wanted};
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
    /// Where forces stand, and what they follow from; nothing where nobody asks for them.
    pub fn force_indices(&self, page: &mut Page) {
        let reactions = self.unit.system.reactions();
        if reactions.is_empty() {
            return;
        }
        let names = Case::Constant.names(reactions.iter().map(|of| of.name.as_str()));
        let said =
            reactions.iter().map(|of| format!("`{}` ({}){}", one_line(&of.name), unit(&of.unit), self.line(of.span)));
        numbered(
            page,
            "Where each force and moment that a joint exerts, and what each driver supplies, stands in [`Forces`].",
            "force",
            said.zip(&names),
        );
        page.constant("How many they are.", "pub const FORCES: usize", &reactions.len().to_string());
        page.constant(
            "What joints exert on their second bodies, and what drivers supply.",
            "pub type Forces",
            "[f64; FORCES]",
        );
    }

    /// The functions that everybody may call.
    pub fn force_functions(&self, page: &mut Page) {
        if self.equations.has_forces() {
            self.needed(Given::None, page);
            self.exerted(true, page);
        }
    }

    /// What multipliers have to hold.
    pub fn needed(&self, given: Given, page: &mut Page) {
        let is_public = given == Given::None;
        let name = if is_public { "needed".to_owned() } else { self.on_sides("needed") };
        let wanted = Wanted::of(&name, NEEDED, &self.unit.program.outputs.forces, "N");
        let orders = if self.forces_hold_jerk() { 4 } else { 3 };
        self.equations.function(&Wanted { is_public, orders, given, ..wanted }, page);
    }

    /// Whether loads hold third derivatives of the coordinates.
    fn forces_hold_jerk(&self) -> bool {
        let (system, is_third) = (self.unit.system, |of: Dependence| of.highest_order() == Some(3));
        system.required_forces().iter().any(|&of| is_third(system.graph().dependence(of)))
    }

    /// What multipliers exert; nothing where no columns are made of that.
    fn exerted(&self, is_public: bool, page: &mut Page) {
        let outputs = &self.unit.program.outputs.reactions;
        if !outputs.is_empty() {
            let wanted = Wanted::of("exerted", EXERTED, outputs, "FORCES");
            let wanted = Wanted { is_public, orders: 1, multipliers: true, given: Given::None, ..wanted };
            self.equations.function(&wanted, page);
        }
    }

    /// Whether measures hold forces.
    pub fn measures_hold_forces(&self) -> bool {
        let graph = self.unit.system.graph();
        self.unit.system.measures().iter().any(|of| graph.dependence(of.value).on(Dependence::FORCES))
    }

    /// What gives them; nothing where there are no masses and loads.
    pub fn forces(&self, solution: &Solution<'_>, page: &mut Page) {
        if solution.motion.forced.is_none() {
            return;
        }
        let is_led = self.equations.is_led;
        if !is_led {
            page.docs(FORCES);
            page.line("#[must_use]");
            let head = Head { kind: "pub fn", name: "forces", arguments: &[("state", "&State")], result: "Forces" };
            let (file, name) = match self.unit.following {
                Some(_) => ("forces_led", "forces_led"),
                None => ("forces", "forces"),
            };
            self.equations.uses.borrow_mut().file(file);
            page.function(&head, |page| page.line(&format!("runtime::{file}::{name}(state)")));
        }
        match &self.equations.book {
            Some(book) => self.forced_solver_as_numbers(solution, &mut book.borrow_mut(), page),
            None => page.text(&solution.forced_function().unwrap_or_default()),
        }
        let has_pivoting = solution.motion.blocks.is_some();
        if has_pivoting && is_led {
            self.exerted(false, page);
        }
        self.uses("forces", "Forced");
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
        self.uses("error", "Fault");
        self.uses("pivoted_forces", "forces_with_pivoting");
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

    /// The transposed matrix, for elimination with partial pivoting; nothing where nobody asks for forces.
    pub fn transposed(&self, tables: &BlockTables, page: &mut Page) {
        if !self.equations.has_forces() {
            return;
        }
        self.uses("pivoting", "Transposed");
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

    /// What elimination with partial pivoting asks for.
    pub fn pivoted_multipliers(&self, page: &mut Page) {
        if !self.equations.has_forces() {
            return;
        }
        let head = Head { kind: "fn", name: "transposed", arguments: &[], result: "Option<&'static Transposed>" };
        page.function(&head, |page| page.line("Some(&ACROSS)"));
        let own = ["q", "qd", "qdd", "qddd"];
        let (orders, own) =
            if self.forces_hold_jerk() { ("[q, qd, qdd, qddd]", &own[..]) } else { ("[q, qd, qdd, _]", &own[..3]) };
        self.right_side(page, "needed", &[(orders, "[&Q; 4]")], own, "Q");
    }
}
