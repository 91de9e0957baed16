//! What everybody calls who wants the motion: thin functions, with what is to be known of them.

use super::Writer;
use crate::emit::print::{Head, Page};

/// What is said of a step.
const STEP: &str = "Moves a state to time `t` (s), in steps as short as the motion asks for: position, velocity
and acceleration are those of the branch that it is on, whichever way `t` lies.

It takes [`MOST_STEPS`] steps at most, and mostly one; [`step_within`] takes as many as it is
allowed. What a driver does and undoes within a
step, by formulas without branches, is not seen: no step is longer than [`LONGEST_STEP`].";

const AT_THE_END: &str = "At the end of the file's analysis the formulas of time take their earlier branches, as
`mechc run` has it; at any other time where they change, the later ones.";

const STEP_WITHIN: &str =
    "As [`step`], in so many steps at most, for those who have a deadline: each solves the equations
about once, and one that has to be made shorter counts as well.

# Errors
Why it cannot get there; the state stays at the last time that it could reach. Where that is
[`Error::TooFar`] the same call goes on from there.";

const ASSEMBLE: &str = "Brings the mechanism to its first time with some parameters, along the branch that the file's
parameters give.

# Errors
It cannot be assembled with these, or not on that branch.";

impl Writer<'_> {
    pub fn doors(&self, page: &mut Page) {
        for file in ["state", "assemble", "step"] {
            self.equations.uses.borrow_mut().file(file);
        }
        page.line("pub use runtime::error::Error;");
        page.line("pub use runtime::limits::MOST_STEPS;\n");
        self.equations.uses.borrow_mut().limit("MOST_STEPS");
        page.constant("The mechanism at a time.", "pub type State", "runtime::state::State<Model>");
        self.of_state(page);
        page.docs(ASSEMBLE);
        let head = Head {
            kind: "pub fn",
            name: "assemble",
            arguments: &[("params", "&Params")],
            result: "Result<State, Error>",
        };
        page.function(&head, |page| page.line("runtime::assemble::assemble(params)"));
        page.docs(STEP);
        let (of_time, _) = self.switches();
        if of_time && self.unit.motion.as_ref().is_some_and(|motion| motion.to.is_some()) {
            page.docs(AT_THE_END);
        }
        page.docs("\n# Errors\nWhy it cannot get there; the state stays at the last time that it could reach.");
        let arguments = [("t", "f64"), ("state", "&mut State"), ("most", "usize")];
        let head = |name, arguments| Head { kind: "pub fn", name, arguments, result: "Result<(), Error>" };
        page.function(&head("step", &arguments[..2]), |page| page.line("step_within(t, state, MOST_STEPS)"));
        page.docs(STEP_WITHIN);
        page.function(&head("step_within", &arguments), |page| page.line("runtime::step::step_within(t, state, most)"));
    }

    /// What a state of this mechanism has beside what every state has.
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
