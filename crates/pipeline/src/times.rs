//! Which times to compute: what is asked for over what the file's analysis says.

use super::seconds;
use mechc_engine::analysis::Times;
use mechc_text::diag::{Code, Diagnostic, Diagnostics, readable};
use mechc_text::source::Sources;

/// First time, last time and step (s), as far as they are said; and times of their own.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct AskedTimes {
    /// The first time.
    pub from: Option<f64>,
    /// The last time.
    pub to: Option<f64>,
    /// From one output time to the next.
    pub every: Option<f64>,
    /// Only these, followed from the first time; all of the interval where there are none.
    pub at: Vec<f64>,
}

impl AskedTimes {
    /// As options say them, by their names: numbers of seconds, or formulas with units.
    ///
    /// # Errors
    /// One of them is no time.
    pub fn of(
        [from, to, every]: [&Option<String>; 3],
        at: &[String],
        sources: &mut Sources,
    ) -> Result<AskedTimes, Diagnostics> {
        let mut time = |option: &str, text: &String| seconds(option, text, sources);
        let mut given = |option: &str, text: &Option<String>| text.as_ref().map(|text| time(option, text)).transpose();
        let [from, to, every] = [given("--from", from)?, given("--to", to)?, given("--every", every)?];
        let at = at.iter().map(|text| time("--at", text)).collect::<Result<_, _>>()?;
        Ok(AskedTimes { from, to, every, at })
    }

    /// With what the file's analysis says: first time, last time and step (s).
    ///
    /// # Errors
    /// The step is not positive.
    pub fn over(&self, analysis: Option<[f64; 3]>) -> Result<AskedTimes, Box<Diagnostic>> {
        let from = self.from.or(analysis.map(|[from, ..]| from));
        let to = self.to.or(analysis.map(|[_, to, _]| to));
        let every = self.every.or(analysis.map(|[.., every]| every));
        if let Some(step) = every.filter(|step| *step <= 0.0) {
            return Err(Box::new(unusable(format!("the step must be positive, it is {} s", readable(step)))));
        }
        Ok(AskedTimes { from, to, every, at: self.at.clone() })
    }

    /// The times of their own, if there are any, else those of the interval.
    ///
    /// # Errors
    /// It is not said which times to compute, or they cannot be computed.
    pub fn times(&self) -> Result<Times, Box<Diagnostic>> {
        match self.listed()? {
            Some(times) => Ok(times),
            None => self.grid(),
        }
    }

    /// All times of the analysis, or where it is not said which these are, those of their own.
    ///
    /// # Errors
    /// As [`AskedTimes::times`].
    pub fn whole(&self) -> Result<Times, Box<Diagnostic>> {
        let is_known = self.from.is_some() && self.to.is_some() && self.every.is_some();
        match self.listed()? {
            Some(listed) if !is_known => Ok(listed),
            _ => self.grid(),
        }
    }

    /// The times of their own, if there are any.
    ///
    /// # Errors
    /// One of them is before the first time.
    pub fn listed(&self) -> Result<Option<Times>, Box<Diagnostic>> {
        let Some(earliest) = self.at.iter().copied().reduce(f64::min) else { return Ok(None) };
        let from = self.from.unwrap_or(earliest);
        if earliest < from {
            let [earliest, from] = [earliest, from].map(readable);
            let said = format!("`--at` {earliest} s is before the start of the analysis at {from} s");
            return Err(Box::new(unusable(said).help("start earlier with `--from`")));
        }
        Ok(Some(Times::listed(from, self.at.clone()).within_analysis_to(self.to)))
    }

    /// All times of the analysis.
    ///
    /// # Errors
    /// It is not said from when to when and how often, or the times cannot be computed.
    pub fn grid(&self) -> Result<Times, Box<Diagnostic>> {
        let (Some(from), Some(to), Some(every)) = (self.from, self.to, self.every) else {
            let said = Diagnostic::new(Code::E0705, "it is not said which times to compute").help(
                "add `analysis from 0 s to 1 s every 10 ms` to the file,\nor give `--from T --to T --every H`, or `--at T`",
            );
            return Err(Box::new(said));
        };
        let [first, last, step] = [from, to, every].map(readable);
        if to < from {
            let said = format!("the analysis would end at {last} s, before its start at {first} s");
            return Err(Box::new(unusable(said)));
        }
        let too_small = || unusable(format!("a step of {step} s is too small to get from {first} s to {last} s"));
        Times::grid(from, to, every).ok_or_else(|| Box::new(too_small()))
    }
}

fn unusable(message: String) -> Diagnostic {
    Diagnostic::new(Code::E0706, message)
}
