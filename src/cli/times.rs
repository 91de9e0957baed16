//! The times that a command computes: those of its options over those of the file.

use super::arguments::Interval;
use super::failure::{Failure, unusable};
use super::input;
use crate::analysis::Times;
use crate::diag::{Code, Diagnostic, readable};
use crate::source::Sources;

/// Only the times of `--at`, followed from the start, if there are any; else those of the interval.
pub(super) fn asked(
    (interval, at): (&Interval, &[String]),
    analysis: Option<[f64; 3]>,
    sources: &mut Sources,
) -> Result<Times, Failure> {
    let bounds = Bounds::of(interval, analysis, sources)?;
    match bounds.listed(at, sources)? {
        Some(times) => Ok(times),
        None => bounds.grid(),
    }
}

/// First time, last time and step (s), as far as they are said.
#[derive(Clone, Copy)]
pub(super) struct Bounds {
    from: Option<f64>,
    to: Option<f64>,
    every: Option<f64>,
}

impl Bounds {
    pub fn of(interval: &Interval, analysis: Option<[f64; 3]>, sources: &mut Sources) -> Result<Bounds, Failure> {
        let mut given = |option: &str, text: &Option<String>| {
            text.as_ref().map(|text| input::time(option, text, sources)).transpose()
        };
        let from = given("--from", &interval.from)?.or(analysis.map(|[from, ..]| from));
        let to = given("--to", &interval.to)?.or(analysis.map(|[_, to, _]| to));
        let every = given("--every", &interval.every)?.or(analysis.map(|[.., every]| every));
        if let Some(step) = every.filter(|step| *step <= 0.0) {
            return Err(unusable(format!("the step must be positive, it is {} s", readable(step))).into());
        }
        Ok(Bounds { from, to, every })
    }

    /// Whether it is said from when to when and how often.
    pub fn are_known(&self) -> bool {
        self.from.is_some() && self.to.is_some() && self.every.is_some()
    }

    /// The times of `--at`, if there are any.
    pub fn listed(&self, at: &[String], sources: &mut Sources) -> Result<Option<Times>, Failure> {
        let listed = at.iter().map(|text| input::time("--at", text, sources)).collect::<Result<Vec<f64>, Failure>>()?;
        let Some(earliest) = listed.iter().copied().reduce(f64::min) else { return Ok(None) };
        let from = self.from.unwrap_or(earliest);
        if earliest < from {
            return Err(unusable(format!(
                "`--at` {} s is before the start of the analysis at {} s",
                readable(earliest),
                readable(from)
            ))
            .help("start earlier with `--from`")
            .into());
        }
        Ok(Some(Times::listed(from, listed)))
    }

    /// All times of the analysis, or where it is not said which these are, those of `--at`.
    pub fn whole(&self, listed: Option<&Times>) -> Result<Times, Failure> {
        match listed {
            Some(listed) if !self.are_known() => Ok(listed.clone()),
            _ => self.grid(),
        }
    }

    /// All times of the analysis.
    pub fn grid(&self) -> Result<Times, Failure> {
        let (Some(from), Some(to), Some(every)) = (self.from, self.to, self.every) else {
            return Err(Diagnostic::new(Code::E0705, "it is not said which times to compute")
                .help(
                    "add `analysis from 0 s to 1 s every 10 ms` to the file,\nor give `--from T --to T --every H`, or `--at T`",
                )
                .into());
        };
        let [first, last, step] = [from, to, every].map(readable);
        if to < from {
            return Err(unusable(format!("the analysis would end at {last} s, before its start at {first} s")).into());
        }
        Times::grid(from, to, every).ok_or_else(|| {
            unusable(format!("a step of {step} s is too small to get from {first} s to {last} s")).into()
        })
    }
}
