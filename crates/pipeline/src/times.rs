//! Times to compute: what options request, over the analysis of the text.

use mechc_engine::analysis::Times;
use mechc_lang::check;
use mechc_lang::model::Dimension;
use mechc_syntax as syntax;
use mechc_text::diag::{Code, Diagnostic, Error, readable};
use mechc_text::source::Sources;

/// Returns the time (s) that an option gives as a number of seconds, or as a formula with units.
///
/// # Errors
/// The text does not follow the grammar, or is no time.
pub fn seconds(option: &str, text: &str, sources: &mut Sources) -> Result<f64, Error> {
    let file = sources.add_option(option, text);
    let time = syntax::parse_expression(sources, file)
        .and_then(|formula| check::constant(&formula, &format!("the value of `{option}`"), Dimension::TIME, sources));
    time.map_err(|why| Error::new(why, sources))
}

/// First time, last time and step (s), as far as they are given; and single times.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct RequestedTimes {
    /// First time.
    pub from: Option<f64>,
    /// Last time.
    pub to: Option<f64>,
    /// Step between output times.
    pub every: Option<f64>,
    /// Single times, followed from the first time; empty for all times of the interval.
    pub at: Vec<f64>,
}

impl RequestedTimes {
    /// Reads the values of the options `--from`, `--to`, `--every` and `--at`: numbers of seconds, or formulas with units.
    ///
    /// # Errors
    /// A value is no time.
    pub fn from_options(
        [from, to, every]: [&Option<String>; 3],
        at: &[String],
        sources: &mut Sources,
    ) -> Result<RequestedTimes, Error> {
        let mut time = |option: &str, text: &String| seconds(option, text, sources);
        let mut given = |option: &str, text: &Option<String>| text.as_ref().map(|text| time(option, text)).transpose();
        let [from, to, every] = [given("--from", from)?, given("--to", to)?, given("--every", every)?];
        let at = at.iter().map(|text| time("--at", text)).collect::<Result<_, _>>()?;
        Ok(RequestedTimes { from, to, every, at })
    }

    /// Completes the times by those of the text's analysis: first time, last time and step (s).
    ///
    /// # Errors
    /// The step is not positive.
    pub fn over(&self, analysis: Option<[f64; 3]>) -> Result<RequestedTimes, Error> {
        let from = self.from.or(analysis.map(|[from, ..]| from));
        let to = self.to.or(analysis.map(|[_, to, _]| to));
        let every = self.every.or(analysis.map(|[.., every]| every));
        if let Some(step) = every.filter(|step| *step <= 0.0) {
            return Err(unusable(format!("the step must be positive, it is {} s", readable(step))).into());
        }
        Ok(RequestedTimes { from, to, every, at: self.at.clone() })
    }

    /// Returns the single times if there are any, else those of the interval.
    ///
    /// # Errors
    /// The times are not given, or cannot be computed.
    pub fn times(&self) -> Result<Times, Error> {
        match self.listed()? {
            Some(times) => Ok(times),
            None => self.grid(),
        }
    }

    /// Returns all times of the interval if it is given, else the single times.
    ///
    /// # Errors
    /// See [`RequestedTimes::times`].
    pub fn whole(&self) -> Result<Times, Error> {
        let has_interval = self.from.is_some() && self.to.is_some() && self.every.is_some();
        match self.listed()? {
            Some(listed) if !has_interval => Ok(listed),
            _ => self.grid(),
        }
    }

    /// Returns the single times, if there are any.
    ///
    /// # Errors
    /// One of them is before the first time.
    pub fn listed(&self) -> Result<Option<Times>, Error> {
        let Some(earliest) = self.at.iter().copied().reduce(f64::min) else { return Ok(None) };
        let from = self.from.unwrap_or(earliest);
        if earliest < from {
            let [earliest, from] = [earliest, from].map(readable);
            let message = format!("`--at` {earliest} s is before the start of the analysis at {from} s");
            return Err(unusable(message).help("start earlier with `--from`").into());
        }
        Ok(Some(Times::listed(from, self.at.clone()).within_analysis_to(self.to)))
    }

    /// Returns all times of the interval.
    ///
    /// # Errors
    /// The interval is not given, or its times cannot be computed.
    pub fn grid(&self) -> Result<Times, Error> {
        let (Some(from), Some(to), Some(every)) = (self.from, self.to, self.every) else {
            let diagnostic = Diagnostic::new(Code::E0705, "it is not said which times to compute").help(
                "add `analysis from 0 s to 1 s every 10 ms` to the file,\nor give `--from T --to T --every H`, or `--at T`",
            );
            return Err(diagnostic.into());
        };
        let [first, last, step] = [from, to, every].map(readable);
        if to < from {
            let message = format!("the analysis would end at {last} s, before its start at {first} s");
            return Err(unusable(message).into());
        }
        let too_small = || unusable(format!("a step of {step} s is too small to get from {first} s to {last} s"));
        Times::grid(from, to, every).ok_or_else(|| too_small().into())
    }
}

fn unusable(message: String) -> Diagnostic {
    Diagnostic::new(Code::E0706, message)
}
