//! What must hold of texts with parts and of what is repeated, as two runs that agree.

use super::composed::{Composed, PartOf, column_by_hand};
use mechc::{Cancel, Choice, Memory, Parsed, Redundant, RunOptions, Times};
use std::time::{Duration, Instant};

/// How far a number of a part may be from what it is alone: of the larger of its range and the way of its mount. (Where a mechanism is
/// nearly singular rounding of the mount's pose is multiplied.)
const SAME: f64 = 1e-9;

/// Nearer to a singular position than this nothing is compared.
const CLEAR: f64 = 1e-3;

/// Beyond this (m, rad) the sum of a coordinate and its mount's loses digits that are compared.
const LARGEST: f64 = 1e4;

/// Rows are asked for so long.
const PATIENCE: Duration = Duration::from_millis(400);

/// What became of a mechanism.
struct Outcome {
    /// Of all that was said.
    codes: Vec<&'static str>,
    said: String,
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
    /// By their names; none where the rows took too long for them to be asked for.
    results: Option<Vec<(String, Option<f64>)>>,
    /// Whether all rows were asked for.
    is_whole: bool,
    /// How far its start is from a singular position.
    conditioning: f64,
    times: Option<Times>,
}

fn outcome(text: &str, choice: &Choice, times: Option<&Times>) -> Outcome {
    let checked = Parsed::new("text.mech", text).check(choice, &Memory::default());
    let mut outcome = Outcome {
        codes: Vec::new(),
        said: String::new(),
        columns: Vec::new(),
        rows: Vec::new(),
        results: None,
        is_whole: true,
        conditioning: 0.0,
        times: None,
    };
    outcome.say(checked.diagnostics().iter());
    let (compiled, said) = checked.compile(Redundant::LeftOut, &Cancel::default());
    outcome.say(said.iter());
    let Some(compiled) = compiled else { return outcome };
    let few = |[from, to, _]: [f64; 3]| {
        let part = |k: u32| from + (to - from) * f64::from(k) / 8.0;
        let listed = || Times::listed(from, (0..8).map(part).chain([to]).collect());
        Times::grid(from, to, (to - from) / 8.0).unwrap_or_else(listed)
    };
    let times = times.cloned().or_else(|| compiled.analysis().map(few));
    let times = times.unwrap_or_else(|| few([0.0, 1.0, 0.1]));
    let (run, said) = compiled.run(&times, &RunOptions::default());
    outcome.times = Some(times);
    outcome.say(said.iter());
    let Some(mut run) = run else { return outcome };
    outcome.conditioning = run.assembly().conditioning;
    outcome.columns = run.columns().to_vec();
    let begun = Instant::now();
    while let Some(row) = run.next_row() {
        match row {
            Ok(row) => outcome.rows.push(row.to_vec()),
            Err(why) => outcome.say(why.diagnostics.iter()),
        }
        if begun.elapsed() > PATIENCE {
            outcome.is_whole = false;
            return outcome;
        }
    }
    if begun.elapsed() < PATIENCE / 10 {
        let names = compiled.results().into_iter().map(|(name, _)| name);
        outcome.results = run.results().map(|answers| names.zip(answers.values).collect());
    }
    outcome
}

impl Outcome {
    fn say<'d>(&mut self, diagnostics: impl Iterator<Item = &'d mechc::Diagnostic>) {
        for diagnostic in diagnostics {
            self.codes.push(diagnostic.code.as_str());
            self.said += &format!("{} {}; ", diagnostic.code.as_str(), diagnostic.message);
        }
    }

    fn column(&self, name: &str) -> Option<Vec<f64>> {
        let at = self.columns.iter().position(|column| column == name)?;
        Some(self.rows.iter().map(|row| row[at]).collect())
    }

    fn is_sound(&self) -> bool {
        self.is_whole && !self.codes.iter().any(|code| code.starts_with('E'))
    }
}

/// What is repeated means what it means written out: the same is said of both, and their rows have the same bits. Gives whether rows were
/// compared.
///
/// # Panics
/// They differ.
pub fn repetition_is_what_is_written_out(composed: &Composed) -> bool {
    let choice = Choice { mechanism: Some("whole".to_owned()), ..Choice::default() };
    let [ranges, by_hand] = [&composed.text, &composed.by_hand].map(|text| outcome(text, &choice, None));
    let texts = || format!("{}\n---- by hand:\n{}", composed.text, composed.by_hand);
    // what is wrong in every copy is told once, but for each declaration by hand
    let [some, all] = [&ranges, &by_hand].map(|outcome| {
        let mut codes = outcome.codes.clone();
        codes.sort_unstable();
        codes.dedup();
        codes
    });
    // by what decides how often something is repeated there is no derivative
    if some.contains(&"E0310") && all != some {
        return false;
    }
    if ranges.is_whole && by_hand.is_whole || ranges.columns.is_empty() {
        assert_eq!(some, all, "{}\n---- {}\n---- {}", texts(), ranges.said, by_hand.said);
    }
    let columns: Vec<String> = ranges.columns.iter().map(|column| column_by_hand(column)).collect();
    assert_eq!(columns, by_hand.columns, "{}", texts());
    for (one, other) in ranges.rows.iter().zip(&by_hand.rows) {
        for ((one, other), column) in one.iter().zip(other).zip(&columns) {
            let is_same = one.to_bits() == other.to_bits() || one.is_nan() && other.is_nan();
            assert!(is_same, "{column}: {one:e} with ranges, {other:e} by hand\n{}", texts());
        }
    }
    if let (Some(some), Some(all)) = (&ranges.results, &by_hand.results) {
        let bits = |(name, value): &(String, Option<f64>)| (column_by_hand(name), value.map(f64::to_bits));
        let [some, all] = [some, all].map(|results| results.iter().map(bits).collect::<Vec<_>>());
        assert_eq!(some, all, "{}", texts());
    }
    !ranges.rows.is_empty()
}

/// A part is what it is alone, seen from its own ground. Gives whether rows were compared.
///
/// # Panics
/// It is something else.
pub fn a_part_is_what_it_is_alone(part: &PartOf) -> bool {
    let choice = Choice {
        mechanism: Some(part.mechanism.clone()),
        set: part.set.clone(),
        inputs: part.inputs.clone(),
        ..Choice::default()
    };
    let alone = outcome(&part.text, &choice, None);
    let is_near =
        part.distance < LARGEST && alone.rows.iter().flatten().all(|value| value.is_nan() || value.abs() < LARGEST);
    if !alone.is_sound() || !is_near || alone.conditioning < CLEAR {
        return false;
    }
    let around = Choice { mechanism: Some(part.around.to_owned()), ..Choice::default() };
    let whole = outcome(&part.text, &around, alone.times.as_ref());
    if !whole.is_whole {
        return false;
    }
    let told =
        || format!("{}\n---- {:?} {:?}\n---- {}\n---- {}", part.text, part.set, part.inputs, alone.said, whole.said);
    assert_eq!(whole.rows.len(), alone.rows.len(), "{}", told());
    let prefix = format!("{}.", part.name);
    for column in &whole.columns {
        let Some(own) = column.strip_prefix(&prefix) else { continue };
        // a body's table is that of the frame around
        let base = own.trim_end_matches(".dd").trim_end_matches(".d");
        let is_measure = !base.contains('.');
        let (Some(want), Some(got), true) = (alone.column(own), whole.column(column), is_measure) else { continue };
        let finite = want.iter().filter(|value| value.is_finite());
        let (low, high) = finite.fold((0.0_f64, 0.0_f64), |(low, high), value| (low.min(*value), high.max(*value)));
        let size = (high - low).max(part.distance);
        let order = own.len() - base.len();
        let tolerance = if order == 0 { SAME * size } else { 1e-6 * (size + 1.0 + part.distance) };
        for (want, got) in want.iter().zip(&got) {
            let is_same = want.to_bits() == got.to_bits() || want.is_nan() && got.is_nan();
            assert!(is_same || (want - got).abs() <= tolerance, "{own}: {want:e} alone, {got:e} as a part\n{}", told());
        }
    }
    let (Some(wanted), Some(all)) = (&alone.results, &whole.results) else { return true };
    for (name, want) in wanted {
        let path = format!("{prefix}{name}");
        let got = all.iter().find(|(other, _)| *other == path).and_then(|(_, got)| *got);
        let size = want.unwrap_or_default().abs().max(part.distance) + 1.0;
        let is_same = want.is_none() || want.zip(got).is_some_and(|(want, got)| (want - got).abs() <= 1e-7 * size);
        assert!(is_same, "{name}: {want:?} alone, {got:?} as a part\n{}", told());
    }
    true
}
