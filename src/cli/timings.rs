//! `--timings`: the time that each stage of a run takes.

use std::time::{Duration, Instant};

/// The stages of a run, in order.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Phase {
    Parse,
    Check,
    Prove,
    Program,
    Solve,
    Results,
    Write,
}

const PHASES: [(Phase, &str); 7] = [
    (Phase::Parse, "parse"),
    (Phase::Check, "check"),
    (Phase::Prove, "prove"),
    (Phase::Program, "program"),
    (Phase::Solve, "solve"),
    (Phase::Results, "results"),
    (Phase::Write, "write"),
];

/// A clock that is read at the end of each phase, if `--timings` is given.
pub(super) struct Timings {
    last: Option<Instant>,
    spent: [Duration; PHASES.len()],
}

impl Timings {
    /// Starts the clock, if it is enabled.
    pub fn new(is_enabled: bool) -> Timings {
        Timings { last: is_enabled.then(Instant::now), spent: [Duration::ZERO; PHASES.len()] }
    }

    /// Adds the time since the last reading to a phase.
    pub fn end(&mut self, phase: Phase) {
        if let Some(last) = &mut self.last {
            let now = Instant::now();
            self.spent[phase as usize] += now - *last;
            *last = now;
        }
    }

    /// Formats the seconds of each phase, and the time of solving per output time; empty if the clock is not enabled.
    pub fn text(&self, rows: u64) -> String {
        if self.last.is_none() {
            return String::new();
        }
        let mut text = String::new();
        // most files have no results
        let is_spent = |(phase, _): &(Phase, &str)| *phase != Phase::Results || !self.spent[*phase as usize].is_zero();
        for (phase, name) in PHASES.into_iter().filter(is_spent) {
            text += &format!("{name:<8} {:>12.6} s\n", self.spent[phase as usize].as_secs_f64());
        }
        let solve = self.spent[Phase::Solve as usize].as_secs_f64();
        let per_step = solve / rows.max(1) as f64 * 1e9;
        text + &format!("{rows} times, {per_step:.0} ns per step\n")
    }
}
