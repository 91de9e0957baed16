//! What both targets share: the pipeline over one text, with all that must hold of whatever comes out of it.

pub mod composed;
pub mod generate;
pub mod oracles;
#[path = "../../tests/support/shape.rs"]
mod shape;

use mechc::{
    Cancel, Choice, Color, Compiled, Diagnostic, Format, Memory, Parsed, Redundant, Run, RunOptions, RustOptions,
    Sources, Times, render,
};
use mechc_ir::program::{FrozenSwitches, Program, Stage};
use mechc_ir::structure::Determined;
use mechc_syntax::{self as syntax, ast};
use shape::file_shape;
use std::time::{Duration, Instant};

/// Texts longer than this (bytes) are passed over: what is long takes long, and finds nothing that is not found shorter.
pub const LONGEST: usize = 8192;

/// Mechanisms of one file that are followed.
const MOST_MECHANISMS: usize = 2;

/// Larger systems are proven, but not moved.
const MOST_COORDINATES: usize = 90;

/// Parts of the file's span at which rows are asked for. A motion may be as fast as its file says: the first are so near
/// to the start that even such a one gets there, and the last are only asked for if those before them took no time.
const PARTS: [f64; 6] = [0.0, 1e-6, 1e-4, 1e-2, 0.1, 1.0];

/// What the rows so far may have taken for the next one to be asked for.
const PATIENCE: Duration = Duration::from_millis(20);

/// What may be left of an equation where a row is printed, scaled. The analysis promises 1e-12 on one side of every
/// edge; both sides agree to 1e-9.
const OPEN: f64 = 2e-9;

/// How far beside an edge its sides are looked at, as a part of the time (s).
const BESIDE: f64 = 1e-9;

/// What became of a text.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Ran {
    /// It follows the grammar.
    pub is_read: bool,
    /// Mechanisms without a mistake.
    pub sound: usize,
    /// Those that are determined.
    pub determined: usize,
    /// Those that assemble.
    pub started: usize,
    /// Rows computed.
    pub rows: usize,
}

/// A text through all stages.
///
/// # Panics
/// Something does not hold that must hold of every text.
pub fn run(text: &str) -> Ran {
    let mut ran = Ran::default();
    let parsed = Parsed::new("text.mech", text);
    if !parsed.faults().is_empty() {
        assert!(parsed.faults().has_errors(), "refused without a reason");
        say(parsed.faults().iter(), parsed.sources());
    }
    ran.is_read = parsed.faults().is_empty();
    if ran.is_read {
        let mut sources = Sources::default();
        let file = sources.add("text.mech", text);
        reads_back(&syntax::parse(&sources, file).tree);
    }
    let names: Vec<String> = parsed.mechanisms().map(str::to_owned).collect();
    for name in names.into_iter().take(MOST_MECHANISMS) {
        follow(&parsed, name, &mut ran);
    }
    ran
}

/// What is formatted is the same tree, and stays as it is when formatted again.
fn reads_back(tree: &ast::File) {
    let once = syntax::format(tree);
    let mut sources = Sources::default();
    let file = sources.add("formatted.mech", once.as_str());
    let again = syntax::parse(&sources, file);
    if tree.mechanisms.is_empty() {
        return;
    }
    assert!(again.faults.is_empty(), "the formatted text is refused: {:?}\n{once}", again.faults);
    let again = again.tree;
    assert_eq!(file_shape(&again), file_shape(tree), "another tree:\n{once}");
    assert_eq!(syntax::format(&again), once, "formatting twice is not formatting once");
}

/// Every diagnostic can be rendered in every form.
fn say<'d>(diagnostics: impl Iterator<Item = &'d Diagnostic>, sources: &Sources) {
    for diagnostic in diagnostics {
        for format in [Format::Human, Format::Short, Format::Json] {
            let said = render(diagnostic, sources, format, Color::Never);
            assert!(said.contains(diagnostic.code.as_str()), "a diagnostic without its code: {said}");
        }
        for label in &diagnostic.labels {
            let text = &sources.get(label.span.file).text;
            assert!(
                text.get(label.span.start as usize..label.span.end as usize).is_some(),
                "a label beside the text: {label:?}"
            );
        }
    }
}

fn follow(parsed: &Parsed, name: String, ran: &mut Ran) {
    // no files: what the fuzzer makes up must not read any
    let checked = parsed.check(&Choice { mechanism: Some(name), ..Choice::default() }, &Memory::default());
    say(checked.diagnostics().iter(), checked.sources());
    assert_ne!(checked.is_sound(), checked.diagnostics().has_errors(), "refused without a reason, or an error unheard");
    let _ = (checked.symbols(), checked.model_text(), checked.equations_text());
    if !checked.is_sound() {
        return;
    }
    ran.sound += 1;
    let compiled = [Redundant::Refused, Redundant::LeftOut].into_iter().find_map(|redundant| {
        let (compiled, said) = checked.compile(redundant, &Cancel::default());
        say(said.iter(), checked.sources());
        assert_ne!(compiled.is_some(), said.has_errors(), "refused without a reason, or an error unheard");
        compiled
    });
    let Some(compiled) = compiled else { return };
    ran.determined += 1;
    let (emitted, said) = compiled.rust(&RustOptions { with_motion: false, ..RustOptions::new("text.mech") });
    let (determined, program) = compiled.inside();
    // derivatives of forces are not emitted, nor are large mechanisms
    let is_refused = || said.iter().any(|one| one.code.as_str() == "E0706");
    assert!(emitted.map_or_else(is_refused, |text| text.contains("pub fn phi")), "no code");
    if determined.system().coordinates().len() > MOST_COORDINATES {
        return;
    }
    let [from, to, _] = compiled.analysis().unwrap_or([0.0, 1.0, 0.1]);
    let times = PARTS.map(|part| if part == 1.0 { to } else { from + part * (to - from) });
    let times = Times::listed(from, times.to_vec());
    let (run, said) = compiled.run(&times, &RunOptions::default());
    say(said.iter(), compiled.sources());
    assert!(run.is_some() || said.has_errors(), "not begun without a reason");
    if let Some(run) = run {
        ran.started += 1;
        ran.rows += rows(&compiled, &determined, &program, run);
    }
}

/// A few rows, each finite and on `Φ`.
fn rows(compiled: &Compiled, determined: &Determined, program: &Program, mut run: Run) -> usize {
    let begun = Instant::now();
    assert!(run.assembly().conditioning > 0.0, "started in a singular position");
    let (times, columns) = (run.times().clone(), run.columns().to_vec());
    let mut known = 0;
    while let Some(row) = run.next_row() {
        let t = times.at(known as u64);
        match row {
            Ok(row) => {
                assert_eq!(row.len(), columns.len(), "a row is as long as its header");
                assert_eq!(row[0].to_bits(), t.to_bits(), "a row is at its time");
                let n = determined.system().coordinates().len();
                let measures = determined.system().measures();
                let firsts = measures.iter().filter(|measure| measure.first.is_some()).count();
                let (q, rest) = row[1..].split_at(n);
                let (qd, rest) = rest[measures.len()..].split_at(n);
                let qdd = &rest[firsts..][..n];
                // a measure may have no value, a coordinate always has
                let mut moving = q.iter().chain(qd).chain(qdd);
                assert!(moving.all(|value| value.is_finite()), "not finite: {columns:?} {row:?}");
                holds(determined, program, t, q, qd);
                known += 1;
            }
            Err(why) => {
                say(why.diagnostics.iter(), compiled.sources());
                break;
            }
        }
        if begun.elapsed() > PATIENCE {
            break;
        }
    }
    say(run.take_warnings().iter(), compiled.sources());
    known
}

/// The equations hold at a row, computed anew. On an edge its formulas may have a value of their own (`sign(0)`), and
/// what counts is one of its sides.
fn holds(determined: &Determined, program: &Program, t: f64, q: &[f64], qd: &[f64]) {
    let found = [0.0, BESIDE, -BESIDE].map(|ahead| open(determined, program, t, q, qd, ahead * (1.0 + t.abs())));
    assert!(found.iter().any(Option::is_none), "open at {t} s: {}", found[0].as_deref().unwrap_or_default());
}

/// The equation that does not hold, if there is one; the switches as they are some time (s) later or before.
fn open(determined: &Determined, program: &Program, t: f64, q: &[f64], qd: &[f64], ahead: f64) -> Option<String> {
    let system = determined.system();
    let params: Vec<f64> = system.params().iter().map(|param| param.value).collect();
    let mut registers = program.start(&params);
    let mut evaluate = |ahead: f64| {
        registers.set(program.inputs.time, t + ahead);
        let q: Vec<f64> = q.iter().zip(qd).map(|(q, qd)| q + ahead * qd).collect();
        registers.set_all(program.inputs.coordinates[0], &q);
        program.run(Stage::Time, &mut registers);
        program.run(Stage::Position, &mut registers);
        registers.freeze(FrozenSwitches { time: true, motion: true });
    };
    evaluate(ahead);
    evaluate(0.0);
    (0..system.rows().len()).find_map(|row| {
        let slopes = || system.phi_q().range(row).zip(system.phi_q().row(row));
        let slope = |position: usize| registers.get(program.outputs.phi_q[position]);
        let norm = slopes().map(|(k, &(column, _))| slope(k) * system.coordinates()[column as usize].scale);
        let norm = norm.map(|s| s * s).sum::<f64>().sqrt();
        let steps = slopes().map(|(k, &(column, _))| (slope(k) * q[column as usize]).abs());
        let terms = program.outputs.terms[row].iter().map(|&register| registers.get(register).abs());
        let rounding = 64.0 * f64::EPSILON * terms.chain(steps).fold(0.0, f64::max);
        let off = registers.get(program.outputs.phi[row]).abs();
        // also where it is no number
        let holds = off <= OPEN * norm + rounding;
        (!holds).then(|| format!("`{}` by {off}, norm {norm}", system.declaration_of(row).name))
    })
}
