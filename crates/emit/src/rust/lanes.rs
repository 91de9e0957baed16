//! Several variants of the mechanism, or several times, at once.

use super::Writer;
use crate::print::{Head, Page};
use crate::solution::Solution;
use crate::text::{constant, literal};

impl Writer<'_> {
    /// Prints the module for several lanes, if requested.
    pub fn lanes(&self, solution: &Solution<'_>, page: &mut Page) {
        let Some(lanes) = self.unit.lanes else {
            return;
        };
        // the module of lanes has its own `use` items
        let of_one = self.equations.deps.take();
        let mut body = Page::of_module();
        self.inside(solution, lanes, &mut body);
        let deps = self.equations.deps.replace(of_one);
        self.equations.deps.borrow_mut().include(&deps);
        page.docs(
            "The same for several variants of the mechanism, or several times, at once: in loops over the\n\
             lanes that a compiler turns into vector instructions. Each lane has the bits that it would have\n\
             alone.",
        );
        page.item("pub mod lanes", |page| {
            page.line("// what is done in every lane reads best, and vectorises best, with the lane's number");
            page.line("#![allow(clippy::needless_range_loop)]\n");
            page.line("use super::*;\n");
            deps.print("super::runtime", page);
            page.text(&body.done());
        });
    }

    /// Prints the content of the module.
    fn inside(&self, solution: &Solution<'_>, lanes: usize, page: &mut Page) {
        self.requires("lane_solutions", "Laned");
        page.constant("Lanes that are worked on together.", "pub const LANES: usize", &lanes.to_string());
        page.constant("A number in each lane.", "pub type Each", "[f64; LANES]");
        let docs = "As many mechanisms, each with its own parameters, at a time of its own.";
        self.equations.deps.borrow_mut().file("lanes");
        page.constant(docs, "pub type States", "super::runtime::lanes::States<Model, LANES>");
        let docs = "What solves the equations in every lane.";
        page.constant(docs, "type Solutions", "super::runtime::lane_solutions::Solutions<Model, LANES>");
        if solution.has_newton() {
            let cells: Vec<String> = solution.cells().into_iter().map(literal).collect();
            let docs = "The width of a cell of the grid of each coordinate that Newton solves for.";
            page.text(&constant(docs, "TEAR_CELLS", "f64", "TEARS", &cells));
        }
        self.public_functions(page);
        self.laned(solution, page);
        page.text(&solution.function(true));
    }

    /// Prints the public functions.
    fn public_functions(&self, page: &mut Page) {
        let each = "[Result<(), Error>; LANES]";
        page.docs(
            "Brings the mechanisms to the first time, each with its own parameters; says of each lane why\n\
             it cannot be assembled, if it cannot. Such a lane has the parameters of the file.\n\n\
             # Errors\nNot even the file's own mechanism can be assembled.",
        );
        let (arguments, result) = ([("params", "&[Params; LANES]")], format!("Result<(States, {each}), Error>"));
        let head = Head { kind: "pub fn", name: "assemble", arguments: &arguments, result: &result };
        page.line("#[rustfmt::skip]");
        page.function(&head, |page| page.line("super::runtime::lanes::assemble_each(params)"));
        page.docs(
            "Moves every lane to a time of its own (s). A lane that asks for more than one step, as any\n\
             does that has further to go than [`LONGEST_STEP`], goes its way alone.\n\n\
             What comes back says of each lane whether it has got there, and if not, why; it stays at the\n\
             last time that it could reach.",
        );
        let arguments = [("t", "&Each"), ("states", "&mut States")];
        let head = Head { kind: "pub fn", name: "step_each", arguments: &arguments, result: each };
        page.function(&head, |page| page.line("super::runtime::lanes::step_each(t, states)"));
        if self.unit.following.is_some() {
            self.equations.deps.borrow_mut().file("lane_following");
            page.docs(
                "Leads every lane to inputs of its own, each with the bits that it would have alone, one after\n\
                 the other: lanes that follow share no vector instructions.\n\n\
                 What comes back says of each lane whether it has got there, and if not, why; it stays as it was.",
            );
            let arguments = [("inputs", "&[Inputs; LANES]"), ("states", "&mut States")];
            let head = Head { kind: "pub fn", name: "follow_each", arguments: &arguments, result: each };
            page.function(&head, |page| {
                page.line("let signals = inputs.each_ref().map(Inputs::signals);");
                page.line("super::runtime::lane_following::follow_each(&signals, states)");
            });
        }
    }

    /// Prints the implementation of `Laned` for the mechanism.
    fn laned(&self, solution: &Solution<'_>, page: &mut Page) {
        let length = |is_there: bool, length: &'static str| if is_there { length } else { "0" };
        let has_measures = !self.unit.system.measures().is_empty();
        page.item("impl Laned<LANES> for Model", |page| {
            let types = [
                ("Coordinates", "Each", "N"),
                ("Guesses", "Each", "TEARS"),
                ("Values", "Each", length(has_measures, "MEASURES")),
                ("Rates", "Each", length(has_measures, "RATES")),
                ("Accelerations", "Each", length(has_measures, "ACCELERATIONS")),
                ("OfJoined", "Each", length(!solution.joined.is_empty(), "JOINED")),
                ("Signs", "[u64; LANES]", "TURNS"),
            ];
            for (name, of, length) in types {
                page.line(&format!("type {name} = [{of}; {length}];"));
            }
            page.blank();
            page.line(&format!("const HAS_CHECKS: bool = {};\n", self.has_checks()));
            page.line("#[rustfmt::skip]");
            let q = if solution.has_newton() { "q" } else { "_q" };
            let head = Head { kind: "fn", name: "tears_of", arguments: &[(q, "&[Each; N]")], result: "[Each; TEARS]" };
            page.function(&head, |page| {
                let tears: Vec<String> =
                    solution.motion.solver.tears().iter().map(|tear| format!("q[{tear}]")).collect();
                if tears.is_empty() { page.line("[]") } else { page.list("[", &tears, "]") }
            });
            let (name, call) = if self.has_sides() { ("sides", "sides, ") } else { ("_sides", "") };
            let arguments = [
                ("guess", "&[Each; TEARS]"),
                ("t", "&Each"),
                ("models", "&[Model; LANES]"),
                (name, "&[Sides; LANES]"),
                ("at", "&mut Solutions"),
            ];
            page.function(&Head { kind: "fn", name: "solve_each", arguments: &arguments, result: "" }, |page| {
                page.line(&format!("solve(guess, t, models, {call}at);"));
            });
        });
    }
}
