//! Reductions: what a result computes from a formula over the whole analysis, or over a window of it.

use super::{Category, Example, Word};

/// A reduction.
#[derive(Debug)]
pub struct ReductionWord {
    /// Documentation.
    pub word: Word,
    /// Arguments in words.
    pub takes: &'static str,
    /// Number of arguments.
    pub arguments: usize,
}

impl ReductionWord {
    /// Returns whether the last argument is the time of evaluation.
    #[must_use]
    pub fn takes_time(&self) -> bool {
        self.arguments > 1
    }

    /// Returns the reduction of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static ReductionWord> {
        REDUCTIONS.iter().find(|reduction| reduction.word.name == name)
    }
}

const fn reduction(
    name: &'static str,
    forms: &'static [&'static str],
    meaning: &'static str,
    more: &'static str,
    example: &'static str,
) -> ReductionWord {
    let word =
        Word { name, category: Category::Reduction, forms, letters: "", meaning, more, example: Example::Arm(example) };
    ReductionWord { word, takes: "one argument", arguments: 1 }
}

/// All reductions. Apart from `max` and `min`, each gives way to a function or table of the mechanism with its name.
pub static REDUCTIONS: &[ReductionWord] = &[
    reduction(
        "max",
        &["max(e)", "max(e, from A to B)"],
        "the largest value of a formula in the whole analysis, or in a window",
        "With one argument, in a `result`; with two it compares them: `max(max(a, b))` is the largest of both. It is found between the \
         rows too, to 1e-9 of the range.",
        "result top = max(y(arm.tip)) in mm\nanalysis from 0 s to 1 s every 10 ms",
    ),
    reduction(
        "min",
        &["min(e)", "min(e, from A to B)"],
        "the least value of a formula in the whole analysis, or in a window",
        "With one argument, in a `result`; with two it compares them. It is found between the rows too, to 1e-9 of the range.",
        "result bottom = min(y(arm.tip)) in mm\nanalysis from 0 s to 1 s every 10 ms",
    ),
    reduction(
        "argmax",
        &["argmax(e)", "argmax(e, from A to B)"],
        "the time at which a formula is largest",
        "The first, of several that agree to 1e-9 of the range; where the formula rests there, the beginning of that.",
        "result when = argmax(y(arm.tip))\nanalysis from 0 s to 1 s every 10 ms",
    ),
    reduction(
        "argmin",
        &["argmin(e)", "argmin(e, from A to B)"],
        "the time at which a formula is least",
        "The first, of several that agree to 1e-9 of the range; where the formula rests there, the beginning of that.",
        "result when = argmin(x(arm.tip))\nanalysis from 0 s to 1 s every 10 ms",
    ),
    reduction(
        "mean",
        &["mean(e)", "mean(e, from A to B)"],
        "the mean of a formula over the time of the analysis, or of a window",
        "Its integral over the length of the analysis or window; of a single time, its value.",
        "result level = mean(y(arm.tip)) in mm\nanalysis from 0 s to 1 s every 10 ms",
    ),
    reduction(
        "rms",
        &["rms(e)", "rms(e, from A to B)"],
        "the root of the mean square of a formula over the time of the analysis, or of a window",
        "Of a single time, the magnitude of its value.",
        "result effort = rms(der(x(arm.tip))) in mm/s\nanalysis from 0 s to 1 s every 10 ms",
    ),
    reduction(
        "integral",
        &["integral(e)", "integral(e, from A to B)"],
        "the integral of a formula over the time of the analysis, or of a window",
        "In the unit of the formula times seconds.",
        "result way = integral(speed(arm.tip)) in mm\nanalysis from 0 s to 1 s every 10 ms",
    ),
    reduction(
        "first",
        &["first(e)", "first(e, from A to B)"],
        "the value of a formula at the first time of the analysis, or of a window",
        "",
        "result start = first(x(arm.tip)) in mm\nanalysis from 0 s to 1 s every 10 ms",
    ),
    reduction(
        "last",
        &["last(e)", "last(e, from A to B)"],
        "the value of a formula at the end of the analysis, or of a window",
        "At the analysis' `to`, also where the last row is earlier.",
        "result end = last(x(arm.tip)) in mm\nanalysis from 0 s to 1 s every 10 ms",
    ),
    ReductionWord {
        takes: "a formula and a time",
        arguments: 2,
        ..reduction(
            "at",
            &["at(e, T)"],
            "the value of a formula at a time",
            "The time lies within the analysis. It is a formula of params, other results and reductions.",
            "result halfway = at(x(arm.tip), 0.5 s) in mm\nanalysis from 0 s to 1 s every 10 ms",
        )
    },
];
