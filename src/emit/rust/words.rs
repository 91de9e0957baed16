//! How much memory a state takes, for those who reserve it without asking Rust.
//!
//! All in it are numbers of 8 bytes and answers of one, so that it is the same everywhere. The code for C does not compile where this is
//! too little.

use super::Writer;
use crate::emit::solution::Solution;

/// Bytes of a word.
const WORD: usize = 8;

impl Writer<'_> {
    /// Words of a state, but for what leads it: the mechanism, two solutions, how far steps go, which rims were passed.
    pub fn words(&self, solution: &Solution<'_>) -> usize {
        let of_model = self.unit.system.params().len() + solution.known.len();
        of_model + 2 * self.words_of_solution(solution) + self.rims().count() + 2 + words_of(2)
    }

    /// Words of what leads it: the mechanism on a way of signals, two solutions, how far it goes.
    pub fn words_of_lead(&self, solution: &Solution<'_>) -> usize {
        let of_way = self.unit.system.params().len() + 4 * self.unit.system.inputs().len();
        of_way + solution.known.len() + 2 * self.words_of_solution(solution) + 1 + words_of(3)
    }

    fn words_of_solution(&self, solution: &Solution<'_>) -> usize {
        let (n, outputs) = (self.unit.system.coordinates().len(), &self.unit.program.outputs);
        let of_measures = outputs.measures.len() + outputs.measures_d.len() + outputs.measures_dd.len();
        let signals = if self.equations.is_led { self.unit.system.inputs().len() } else { 0 };
        let answers = outputs.watches.len() + solution.motion.solver.turns().len() + 2;
        let numbers = 3 + 3 * n + of_measures + solution.joined.len() + self.equations.sides.len();
        numbers + signals * (n + 1) + words_of(answers)
    }
}

/// Words that some answers take.
fn words_of(answers: usize) -> usize {
    answers.div_ceil(WORD)
}
