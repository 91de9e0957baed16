//! Runs a mechanism and prints a row per output time, then a result for the whole motion.
//!
//! Arguments set parameters: `cargo run --example run_mechanism -- rod_length=200mm`. With `rod_length=48mm` the rod is shorter than
//! the crank, and the motion ends in a dead point.

use mechc::{
    Cancel, Choice, Color, Diagnostic, Error, Format, Memory, Parsed, Redundant, RunOptions, Sources, Times, render,
};

const COLUMNS: [&str; 4] = ["t", "crank.phi", "travel", "travel.dd"];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let choice = Choice {
        set: std::env::args().skip(1).collect(),
        results: vec!["peak = max(abs(der(der(travel))))".to_owned()],
        ..Choice::default()
    };
    // A text may name other files, which it reads through a `World`; this text names none.
    let world = Memory::default();
    let checked = Parsed::new("slider_crank.mech", include_str!("slider_crank.mech")).check(&choice, &world);
    report(checked.diagnostics().iter(), checked.sources());
    let (compiled, diagnostics) = checked.compile(Redundant::Refused, &Cancel::default());
    let compiled = compiled.ok_or_else(|| Error::new(diagnostics, checked.sources()))?;

    // `compiled.times()` has the times of the text's own analysis.
    let times = Times::grid(0.0, 0.04, 0.005).ok_or("the step is too small")?;
    let (run, diagnostics) = compiled.run(&times, &RunOptions::default());
    let mut run = run.ok_or_else(|| Error::new(diagnostics, compiled.sources()))?;

    let position = |name: &str| run.columns().iter().position(|column| column == name);
    let columns: Vec<usize> = COLUMNS.into_iter().map(position).collect::<Option<_>>().ok_or("a column is missing")?;
    println!("{}", COLUMNS.map(|name| format!("{name:>10}")).join(" "));
    while let Some(row) = run.next_row() {
        // numbers are in SI: s, rad, m, m/s^2; the motion may end early, as in a dead point
        let row = row?;
        println!("{}", columns.iter().map(|&at| format!("{:10.4}", row[at])).collect::<Vec<_>>().join(" "));
    }
    report(run.take_warnings().iter(), compiled.sources());

    let answers = run.results().ok_or("the motion has no results")?;
    report(&answers.notes, compiled.sources());
    for ((name, _), value) in compiled.results().iter().zip(answers.values) {
        println!("{name} = {}", value.map_or("without a value".to_owned(), |value| format!("{value:.4}")));
    }
    Ok(())
}

/// Writes diagnostics to standard error, with the lines of the text that they point to.
fn report<'d>(diagnostics: impl IntoIterator<Item = &'d Diagnostic>, sources: &Sources) {
    for diagnostic in diagnostics {
        eprint!("{}", render(diagnostic, sources, Format::Human, Color::Never));
    }
}
