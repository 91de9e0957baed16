//! The times that a command computes: those of its options over those of the file.

use super::arguments::Interval;
use super::failure::Failure;
use mechc_pipeline::AskedTimes;
use mechc_text::source::Sources;

/// As the options of a command say, with what the file's analysis says beside them.
pub(super) fn asked(
    (interval, at): (&Interval, &[String]),
    analysis: Option<[f64; 3]>,
    sources: &mut Sources,
) -> Result<AskedTimes, Failure> {
    Ok(said((interval, at), sources)?.over(analysis)?)
}

/// As the options of a command say.
pub(super) fn said((interval, at): (&Interval, &[String]), sources: &mut Sources) -> Result<AskedTimes, Failure> {
    Ok(AskedTimes::of([&interval.from, &interval.to, &interval.every], at, sources)?)
}
