//! Sweeps of texts, and single runs of each variant.

#![allow(dead_code)] // not every test uses all of it

use mechc::{
    Cancel, Checked, Choice, Code, Compiled, Memory, Parsed, Redundant, RunOptions, Status, SweepOptions, Swept,
    Variants, VaryOptions, World,
};

/// A crank-rocker of two bodies.
pub const ROCKER: &str = "mechanism rocker {
    param crank_length = 30 mm
    param coupler_length = 90 mm
    param rocker_length = 70 mm
    param pen = (45 mm, 20 mm)
    ground { point O = (0, 0)  point C = (100 mm, 0) }
    body crank at (0, 0, 30 deg) { point O = (0, 0)  point A = (crank_length, 0) }
    body coupler at (26 mm, 15 mm, 40 deg) { point A = (0, 0)  point B = (coupler_length, 0)  point P = pen }
    joint main:  revolute(ground.O, crank.O)
    joint left:  revolute(crank.A, coupler.A)
    joint right: revolute_revolute(coupler.B, ground.C, rocker_length)
    driver motor: rotation(main) = 30 deg + 1 rev/s * t
    measure height = y(coupler.P) in mm
    analysis from 0 s to 0.9 s every 50 ms
}";

/// A mechanism for sweeps.
pub struct Subject {
    pub parsed: Parsed,
    pub choice: Choice,
    pub checked: Checked,
    pub compiled: Compiled,
}

/// Reads a text with a choice.
pub fn subject(text: &str, choice: Choice) -> Subject {
    let parsed = Parsed::new("text.mech", text);
    let choice = Choice { lead: true, ..choice };
    let checked = parsed.check(&choice, &Memory::default());
    let (compiled, said) = checked.compile(Redundant::Refused, &Cancel::default());
    let compiled = compiled.unwrap_or_else(|| panic!("{:?} {said:?}", checked.diagnostics()));
    Subject { parsed, choice, checked, compiled }
}

impl Subject {
    /// Returns the variants of a sweep.
    pub fn variants(&self, vary: &VaryOptions) -> Variants {
        self.variants_in(vary, &Memory::default()).unwrap_or_else(|said| panic!("{said}"))
    }

    /// Returns the variants of a sweep, with the files of a world.
    pub fn variants_in(&self, vary: &VaryOptions, world: &dyn World) -> Result<Variants, String> {
        let messages = |why: mechc::Error| {
            why.diagnostics.iter().map(|diagnostic| diagnostic.message.clone()).collect::<Vec<_>>().join("; ")
        };
        self.checked.variants(vary, &self.choice, world).map_err(messages)
    }

    /// Runs a sweep and joins its blocks.
    pub fn sweep(&self, variants: &Variants, options: &SweepOptions) -> Swept {
        let mut blocks = self.checked.sweep(&self.compiled, variants, options, |block| block).expect("times are said");
        let mut all = blocks.next().expect("a block");
        for block in blocks {
            assert_eq!(block.first, all.first + all.len() as u64, "blocks follow each other");
            join(&mut all, block);
        }
        all
    }

    /// Returns what `run --lead --set` computes for a variant: its status, its results, and its rows up to where it stops.
    pub fn run_single(&self, settings: Vec<String>) -> (Status, Vec<f64>, Vec<Vec<f64>>) {
        let count = self.compiled.results().len();
        let nothing = vec![f64::NAN; count];
        let set = self.choice.set.iter().cloned().chain(settings).collect();
        let checked = self.parsed.check(&Choice { set, ..self.choice.clone() }, &Memory::default());
        let stopped = |said: &mechc::Diagnostics| {
            let error = said.iter().find(|said| said.is_error() && said.code != Code::E0612);
            Status::Stopped(error.expect("an error").code)
        };
        let (compiled, said) = checked.compile(Redundant::Refused, &Cancel::default());
        let Some(compiled) = compiled else {
            let said = if checked.is_sound() { said } else { checked.diagnostics().clone() };
            return (stopped(&said), nothing, Vec::new());
        };
        let (run, said) = compiled.run(&compiled.times().expect("an analysis"), &RunOptions::default());
        let Some(mut run) = run else { return (stopped(&said), nothing, Vec::new()) };
        let is_reassembled = said.iter().any(|said| said.code == Code::E0612);
        let mut rows = Vec::new();
        while let Some(row) = run.next_row() {
            match row {
                Ok(row) => rows.push(row.to_vec()),
                Err(why) => return (Status::Stopped(why.first().expect("an error").code), nothing, rows),
            }
        }
        let results =
            run.results().unwrap_or_default().values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect();
        (if is_reassembled { Status::Reassembled } else { Status::Ok }, results, rows)
    }

    /// Returns options for rows with all columns.
    pub fn all_columns(&self) -> SweepOptions {
        SweepOptions { columns: Some((0..self.compiled.columns().len()).collect()), ..SweepOptions::default() }
    }
}

/// Appends a block to others.
pub fn join(all: &mut Swept, block: Swept) {
    all.statuses.extend(block.statuses);
    all.stopped.extend(block.stopped);
    all.lengths.extend(block.lengths);
    all.abreast += block.abreast;
    all.answered += block.answered;
    for (all, more) in [(&mut all.params, block.params), (&mut all.results, block.results)] {
        all.iter_mut().zip(more).for_each(|(all, more)| all.extend(more));
    }
    all.columns.iter_mut().zip(&block.columns).for_each(|(all, more)| all.extend(more.iter().copied()));
}

/// Returns the bits of numbers; all NaNs are equal.
pub fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|number| if number.is_nan() { u64::MAX } else { number.to_bits() }).collect()
}

/// Returns statuses, lengths and bits of a block.
pub fn bits_of(block: &Swept) -> (Vec<Status>, Vec<usize>, Vec<Vec<u64>>) {
    let told = block.params.iter().chain(&block.results).chain([&block.stopped]).map(Vec::as_slice);
    let columns = told.chain(block.columns.iter().map(|column| &**column));
    (block.statuses.clone(), block.lengths.clone(), columns.map(bits).collect())
}

/// Returns whether numbers have equal bits.
pub fn have_equal_bits(found: &[f64], known: &[f64]) -> bool {
    bits(found) == bits(known)
}

/// Compares each variant with a single run, and returns each status with its count.
pub fn compare(subject: &Subject, variants: &Variants) -> Vec<(Status, usize)> {
    compare_all(subject, variants).0
}

/// Compares each variant with a single run, and returns each status with its count, and the number of variants that ran in batches.
pub fn compare_all(subject: &Subject, variants: &Variants) -> (Vec<(Status, usize)>, usize) {
    let block = subject.sweep(variants, &subject.all_columns());
    let (mut first_row, mut found) = (0, Vec::new());
    for k in 0..block.len() {
        let settings = variants.settings(k as u64);
        let (status, results, rows) = subject.run_single(settings.clone());
        assert_eq!(block.statuses[k], status, "{settings:?}");
        let swept: Vec<f64> = block.results.iter().map(|column| column[k]).collect();
        assert_eq!(bits(&swept), bits(&results), "{settings:?}");
        assert_eq!(block.lengths[k], rows.len(), "{settings:?}");
        for (at, row) in rows.iter().enumerate() {
            let swept: Vec<f64> = block.columns.iter().map(|column| column[first_row + at]).collect();
            assert_eq!(bits(&swept), bits(row), "{settings:?}, row {at}");
        }
        first_row += rows.len();
        match found.iter_mut().find(|(known, _)| *known == status) {
            Some((_, count)) => *count += 1,
            None => found.push((status, 1)),
        }
    }
    assert!(block.columns.iter().all(|column| column.len() == first_row));
    (found, block.abreast)
}

/// Returns options that vary some parameters.
pub fn vary(params: &[&str]) -> VaryOptions {
    VaryOptions { params: params.iter().map(|&param| param.to_owned()).collect(), ..VaryOptions::default() }
}

/// Returns the count of a status.
pub fn count(found: &[(Status, usize)], wanted: Status) -> usize {
    found.iter().find(|(status, _)| *status == wanted).map_or(0, |(_, count)| *count)
}
