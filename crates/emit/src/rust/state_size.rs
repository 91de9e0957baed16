//! Memory of a state and work of a call, for callers that reserve both without Rust.
//!
//! A state consists of numbers of 8 bytes and flags of one, so its size is equal on all platforms. The code for C does not compile if the
//! size is too small.

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
    /// Returns the words of a state without its input path: the mechanism, two solutions, the step size, the passed boundaries, and the
    /// kind of assembly.
    pub fn words(&self, solution: &Solution<'_>) -> usize {
        let of_model = self.unit.system.params().len() + solution.derived.len();
        of_model + 2 * self.words_of_solution(solution) + self.boundaries().count() + 2 + words_of(2) + words_of(1)
    }

    /// Returns the words of the input path: the mechanism along signals, two solutions, the step size, the largest changes, the target.
    pub fn words_of_input_path(&self, solution: &Solution<'_>) -> usize {
        let signals = self.unit.system.inputs().len();
        let of_path = self.unit.system.params().len() + 4 * signals;
        let of_track = 2 * self.words_of_solution(solution) + 1 + words_of(2);
        of_path + solution.derived.len() + of_track + signals + (signals + 1) + words_of(1)
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

/// Upper bounds of the steps of calls and of their evaluations, by the names of their constants. They equal those that `work.rs` and
/// similar files of `runtime` compute, for callers without Rust.
pub(crate) type Bounds = Vec<(&'static str, usize)>;

/// Upper bounds of the evaluations of steps.
#[derive(Clone, Copy)]
pub(super) struct Work {
    /// Evaluations of the switches of time on both sides.
    sides: usize,
    /// Evaluations to reach a state.
    reaching: usize,
    /// Evaluations to check that a state is regular.
    regular: usize,
    /// Evaluations of a step.
    pub step: usize,
}

impl Writer<'_> {
    /// Returns the bounds for a step along time, or along signals.
    pub fn work(&self) -> Work {
        const OF_FINDING: usize = 3;
        let (of_time, of_motion) = self.switches();
        let sides = usize::from(of_time);
        let reaching = sides + OF_FINDING * if of_motion { MOST_BRANCHES } else { 1 };
        let of_edge = (2 + MOST_HALVINGS) * sides;
        let step = of_edge + reaching + 1 + OF_FINDING * sides;
        Work { sides, reaching, regular: 1 + 2 * sides, step }
    }

    /// Returns the bounds of a mechanism, with those of its input path.
    pub fn bounds(&self, path: Option<Work>) -> Bounds {
        let work = self.work();
        let most_work = self.boundaries().count() * (MOST_HALVINGS + 3) + 2 + 2 * MOST_LOOKS * work.reaching;
        let of_step = work.step + if self.has_boundaries() { most_work } else { 0 };
        let of_path_step = path.map_or(0, |path| path.step + 1);
        let to_follow = |path: Work| 1 + path.sides + path.reaching + path.regular + path.reaching + 2;
        let to_take_up = path.map_or(0, |path| to_follow(path) + 1 + work.sides + work.reaching);
        let of_parts = (2 + FIRST_PARTS + MOST_PARTS) * (2 * work.sides + work.reaching + 1);
        let mut bounds = vec![
            ("MOST_STEPS", MOST_STEPS),
            ("MOST_WORK", MOST_STEPS * of_step.max(of_path_step) + to_take_up + work.regular),
            ("MOST_WORK_TO_ASSEMBLE", of_parts + work.sides + (1 + MOST_SHORTER) * MOST_TRIALS),
        ];
        if let Some(path) = path {
            bounds.push(("MOST_STEPS_TO_FOLLOW", MOST_STEPS_TO_FOLLOW));
            bounds.push(("MOST_WORK_TO_FOLLOW", MOST_STEPS_TO_FOLLOW * of_path_step + to_follow(path)));
        }
        bounds
    }
}

/// Returns the number of words that some flags take.
fn words_of(answers: usize) -> usize {
    answers.div_ceil(WORD)
}
