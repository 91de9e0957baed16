//! Memory of a state and work of a call, for callers that reserve both without Rust.
//!
//! All in it are numbers of 8 bytes and answers of one, so that it is the same everywhere. The code for C does not compile where this is
//! too little.

use super::Writer;
use crate::limits::assemble::{FIRST_PARTS, MOST_PARTS};
use crate::limits::close::{MOST_SHORTER, MOST_TRIALS};
use crate::limits::follow::MOST_STEPS_TO_FOLLOW;
use crate::limits::looks::MOST_LOOKS;
use crate::limits::reach::MOST_BRANCHES;
use crate::limits::step::MOST_STEPS;
use crate::solution::Solution;
use mechc_engine::limits::domain_boundaries::MOST_HALVINGS;

/// Bytes of a word.
const WORD: usize = 8;

impl Writer<'_> {
    /// Words of a state, but for what leads it: the mechanism, two solutions, how far steps go, which boundaries were passed, how it was
    /// assembled.
    pub fn words(&self, solution: &Solution<'_>) -> usize {
        let of_model = self.unit.system.params().len() + solution.derived.len();
        of_model + 2 * self.words_of_solution(solution) + self.boundaries().count() + 2 + words_of(2) + words_of(1)
    }

    /// Words of what leads it: the mechanism on a way of signals, two solutions, how far it goes, what it takes, where it was going.
    pub fn words_of_lead(&self, solution: &Solution<'_>) -> usize {
        let signals = self.unit.system.inputs().len();
        let of_way = self.unit.system.params().len() + 4 * signals;
        let of_track = 2 * self.words_of_solution(solution) + 1 + words_of(2);
        of_way + solution.derived.len() + of_track + signals + (signals + 1) + words_of(1)
    }

    fn words_of_solution(&self, solution: &Solution<'_>) -> usize {
        let (n, outputs) = (self.unit.system.coordinates().len(), &self.unit.program.outputs);
        let of_measures = outputs.measures.len() + outputs.measures_d.len() + outputs.measures_dd.len();
        let signals = if self.equations.is_input_driven { self.unit.system.inputs().len() } else { 0 };
        let answers = outputs.watches.len() + solution.motion.solver.turns().len() + 2;
        let numbers = 3 + 3 * n + of_measures + solution.joined.len() + self.equations.sides.len();
        numbers + signals * (n + 1) + words_of(answers)
    }
}

/// Upper bounds of the steps of calls and of their evaluations, by the names of their constants; the same as `work.rs` and
/// its like in `runtime` say, for those who do not ask Rust.
pub(crate) type Bounds = Vec<(&'static str, usize)>;

/// Evaluations that steps take at most.
#[derive(Clone, Copy)]
pub(super) struct Work {
    /// To look at the switches of time on both sides.
    sides: usize,
    /// To reach a state.
    reaching: usize,
    /// To see that a state is regular.
    regular: usize,
    /// To take a step.
    pub step: usize,
}

impl Writer<'_> {
    /// Evaluations of a step along time, or along signals.
    pub fn work(&self) -> Work {
        const OF_FINDING: usize = 3;
        let (of_time, of_motion) = self.switches();
        let sides = usize::from(of_time);
        let reaching = sides + OF_FINDING * if of_motion { MOST_BRANCHES } else { 1 };
        let of_edge = (2 + MOST_HALVINGS) * sides;
        let step = of_edge + reaching + 1 + OF_FINDING * sides;
        Work { sides, reaching, regular: 1 + 2 * sides, step }
    }

    /// The bounds of a mechanism, with what its inputs take.
    pub fn bounds(&self, lead: Option<Work>) -> Bounds {
        let work = self.work();
        let most_work = self.boundaries().count() * (MOST_HALVINGS + 3) + 2 + 2 * MOST_LOOKS * work.reaching;
        let of_step = work.step + if self.has_boundaries() { most_work } else { 0 };
        let of_lead_step = lead.map_or(0, |lead| lead.step + 1);
        let to_follow = |lead: Work| 1 + lead.sides + lead.reaching + lead.regular + lead.reaching + 2;
        let to_take_up = lead.map_or(0, |lead| to_follow(lead) + 1 + work.sides + work.reaching);
        let of_parts = (2 + FIRST_PARTS + MOST_PARTS) * (2 * work.sides + work.reaching + 1);
        let mut bounds = vec![
            ("MOST_STEPS", MOST_STEPS),
            ("MOST_WORK", MOST_STEPS * of_step.max(of_lead_step) + to_take_up + work.regular),
            ("MOST_WORK_TO_ASSEMBLE", of_parts + work.sides + (1 + MOST_SHORTER) * MOST_TRIALS),
        ];
        if let Some(lead) = lead {
            bounds.push(("MOST_STEPS_TO_FOLLOW", MOST_STEPS_TO_FOLLOW));
            bounds.push(("MOST_WORK_TO_FOLLOW", MOST_STEPS_TO_FOLLOW * of_lead_step + to_follow(lead)));
        }
        bounds
    }
}

/// Words that some answers take.
fn words_of(answers: usize) -> usize {
    answers.div_ceil(WORD)
}
