//! Public entry points to the motion: thin functions, with their documentation.

use super::Writer;
use crate::print::{Head, Page};

/// Documentation of `step`.
const STEP: &str = "Moves a state to time `t` (s), in steps as short as the motion asks for: position, velocity
and acceleration are those of the branch that it is on, whichever way `t` lies.

It takes [`MOST_STEPS`] steps at most, and mostly one: [`MOST_WORK`] evaluations, whatever it is
given. What a driver does and undoes within a
step, by formulas without branches, is not seen: no step is longer than [`LONGEST_STEP`].";

const AT_THE_END: &str = "At the end of the file's analysis the formulas of time take their earlier branches, as
`mechc run` has it; at any other time where they change, the later ones.";

const STEP_WITHIN: &str =
    "As [`step`], in so many steps at most, for those who have a deadline: [`most_work`] says how many
evaluations that are. A step that has to be made shorter counts as well. What these steps do not
reach is on its way: the same call goes on from there.

# Errors
Why it cannot get there; the state is then bit for bit as it was.";

const ASSEMBLE: &str = "Brings the mechanism to its first time with some parameters: along the branch that the file's
parameters give, where a short way leads there; else from the poses that the file draws with these
parameters, as `mechc run --set` does. `State::assembly` says which way it went.

# Errors
It cannot be assembled with these.";

const COUNTED: &str =
    "The same functions, which add the evaluations that they do to those of a [`Work`]: for tests of a
deadline, and for tables of what calls cost.";

impl Writer<'_> {
    pub fn entry_points(&self, page: &mut Page) {
        for file in ["state", "assemble", "step"] {
            self.equations.deps.borrow_mut().file(file);
        }
        page.line("pub use runtime::error::Error;");
        page.line("pub use runtime::limits::MOST_STEPS;");
        page.line("pub use runtime::state::Assembly;");
        page.line("pub use runtime::work::{Progress, Work};\n");
        self.equations.deps.borrow_mut().limit("MOST_STEPS");
        page.constant("The mechanism at a time.", "pub type State", "runtime::state::State<Model>");
        self.of_state(page);
        let docs = "Evaluations that any call takes at most that is not told how many steps it may take.";
        page.constant(docs, "pub const MOST_WORK: usize", "most_work(MOST_STEPS)");
        let docs = "Evaluations that [`assemble`] takes at most.";
        let value = "runtime::assemble::most_work::<Model>()";
        page.constant(docs, "pub const MOST_WORK_TO_ASSEMBLE: usize", value);
        page.docs("Evaluations that a call takes at most that may take so many steps.");
        page.line("#[must_use]");
        let head = Head { kind: "pub const fn", name: "most_work", arguments: &[("most", "usize")], result: "usize" };
        page.function(&head, |page| page.line("runtime::step::most_work::<Model>(most)"));
        page.docs(ASSEMBLE);
        let (params, state) = (("params", "&Params"), ("state", "&mut State"));
        let head = Head { kind: "pub fn", name: "assemble", arguments: &[params], result: "Result<State, Error>" };
        page.function(&head, |page| page.line("counted::assemble(params, &mut Work::default())"));
        page.docs(STEP);
        let (of_time, _) = self.switches();
        if of_time && self.unit.motion.as_ref().is_some_and(|motion| motion.to.is_some()) {
            page.docs(AT_THE_END);
        }
        page.docs("\n# Errors\nWhy it cannot get there; the state is then bit for bit as it was.");
        let arguments = [("t", "f64"), state, ("most", "usize")];
        let head = Head { kind: "pub fn", name: "step", arguments: &arguments[..2], result: "Result<(), Error>" };
        page.function(&head, |page| page.line("counted::step(t, state, &mut Work::default())"));
        page.docs(STEP_WITHIN);
        let result = "Result<Progress, Error>";
        let head = Head { kind: "pub fn", name: "step_within", arguments: &arguments, result };
        page.function(&head, |page| page.line("counted::step_within(t, state, most, &mut Work::default())"));
        page.docs(COUNTED);
        page.line("#[rustfmt::skip]");
        page.item("pub mod counted", |page| {
            page.line("#![allow(clippy::missing_errors_doc)] // they are those of the functions outside\n");
            page.line("use super::*;\n");
            self.counted(page);
        });
    }

    /// Prints the entry points that count their work.
    fn counted(&self, page: &mut Page) {
        let (state, most, work) = (("state", "&mut State"), ("most", "usize"), ("work", "&mut Work"));
        let [nothing, progress] = ["Result<(), Error>", "Result<Progress, Error>"];
        let mut function = |name, arguments: &[(&str, &str)], result, does: &str| {
            page.docs("The same, counted.");
            page.function(&Head { kind: "pub fn", name, arguments, result }, |page| page.line(does));
        };
        let assembled = "Result<State, Error>";
        function("assemble", &[("params", "&Params"), work], assembled, "runtime::assemble::assemble(params, work)");
        let t = ("t", "f64");
        function("step", &[t, state, work], nothing, "runtime::step::step(t, state, MOST_STEPS, work)");
        let does = "runtime::step::step_within(t, state, most, work)";
        function("step_within", &[t, state, most, work], progress, does);
        if self.unit.following.is_some() {
            let inputs = ("inputs", "&Inputs");
            let does = "runtime::follow::follow(&inputs.signals(), state, MOST_STEPS_TO_FOLLOW, work)";
            function("follow", &[inputs, state, work], nothing, does);
            let does = "runtime::follow::follow_within(&inputs.signals(), state, most, work)";
            function("follow_within", &[inputs, state, most, work], progress, does);
        }
    }

    /// Prints the methods of a state that depend on this mechanism.
    fn of_state(&self, page: &mut Page) {
        let (has_bodies, has_inputs) = (!self.unit.system.bodies().is_empty(), self.unit.following.is_some());
        if !has_bodies && !has_inputs {
            return;
        }
        page.item("impl State", |page| {
            let poses = [
                ("pose", "Where a body is (m, m, rad).", "q"),
                ("velocity", "How fast a body moves (m/s, m/s, rad/s).", "qd"),
                ("acceleration", "How a body's velocity changes (m/s^2, m/s^2, rad/s^2).", "qdd"),
            ];
            for (name, docs, of) in poses.into_iter().filter(|_| has_bodies) {
                page.docs(docs);
                page.line("#[must_use]");
                let head = Head { kind: "pub fn", name, arguments: &[("&self", ""), ("body", "Body")], result: "Pose" };
                page.function(&head, |page| page.line(&format!("Pose::of(self.{of}(), body)")));
            }
            if has_inputs {
                page.docs("The inputs: what they were followed to, or what their formulas say at this time.");
                page.line("#[must_use]");
                let head = Head { kind: "pub fn", name: "inputs", arguments: &[("&self", "")], result: "Inputs" };
                page.function(&head, |page| page.line("Inputs::of(&runtime::follow::signals(self))"));
            }
        });
    }
}
