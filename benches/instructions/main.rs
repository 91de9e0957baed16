//! Work whose instructions `.ci/instructions` counts. Counts of two sizes tell what one row, variant or sine costs.
//!
//! ```text
//! mechc-instructions rows FILE COUNT
//! mechc-instructions variants FILE PARAM FROM..TO COUNT
//! mechc-instructions sines COUNT
//! ```

use mechc::{
    Cancel, Checked, Choice, Compiled, Memory, Parsed, Redundant, RunOptions, SweepOptions, Times, VaryOptions,
};
use std::error::Error;
use std::hint::black_box;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["rows", file, count] => rows(file, count.parse()?),
        ["variants", file, param, range, count] => variants(file, &format!("{param}={range}:{count}")),
        ["sines", count] => {
            sines(count.parse()?);
            Ok(())
        }
        _ => Err("rows FILE COUNT, variants FILE PARAM FROM..TO COUNT, or sines COUNT".into()),
    }
}

/// Computes rows at evenly spaced times over the analysis of a text.
fn rows(file: &str, count: usize) -> Result<(), Box<dyn Error>> {
    let choice = Choice::default();
    let (_, compiled) = compile(file, &choice)?;
    let [from, to, _] = compiled.analysis().ok_or("no analysis")?;
    let times = Times::grid(from, to, (to - from) / count as f64).ok_or("too many rows")?;
    let (run, _) = compiled.run(&times, &RunOptions::default());
    let mut run = run.ok_or("the mechanism does not assemble")?;
    let mut computed = 0;
    while let Some(row) = run.next_row() {
        black_box(row.map_err(|why| why.to_string())?);
        computed += 1;
    }
    if computed > count { Ok(()) } else { Err("the motion ended early".into()) }
}

/// Computes the results of variants on one thread.
fn variants(file: &str, param: &str) -> Result<(), Box<dyn Error>> {
    let choice =
        Choice { lead: true, results: vec!["largest = max(abs(der(der(travel))))".to_owned()], ..Choice::default() };
    let (checked, compiled) = compile(file, &choice)?;
    let vary = VaryOptions { params: vec![param.to_owned()], ..VaryOptions::default() };
    let variants = checked.variants(&vary, &choice, &Memory::default()).map_err(|_| "the variants are refused")?;
    let options = SweepOptions { jobs: Some(1), ..SweepOptions::default() };
    let sweep = checked.sweep(&compiled, &variants, &options, |block| block).map_err(|why| why.to_string())?;
    for block in sweep {
        black_box(block.results);
    }
    Ok(())
}

fn compile(file: &str, choice: &Choice) -> Result<(Checked, Compiled), Box<dyn Error>> {
    let text = std::fs::read_to_string(file)?;
    let checked = Parsed::new(file, &text).check(choice, &Memory::default());
    let (compiled, _) = checked.compile(Redundant::Refused, &Cancel::default());
    let compiled = compiled.ok_or("the mechanism does not compile")?;
    Ok((checked, compiled))
}

fn sines(count: u32) {
    let mut sum = 0.0;
    for k in 0..count {
        sum += libm::sin(f64::from(k) * 1e-3);
    }
    black_box(sum);
}
