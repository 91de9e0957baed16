//! Output times, and the time span of an analysis.

use crate::limits::edges::{AHEAD, LONGEST_AHEAD, SLACK};
use mechc_expr::math::neighbours;
use mechc_ir::limits::DEFAULT_SPAN;

/// An output time within this part of a step from the last time is the last time.
const AT_THE_LAST: f64 = 1e-9;
/// Larger numbers of steps are not exact.
const MOST: f64 = 9e15;

/// Output times, ascending.
#[derive(Clone, PartialEq, Debug)]
pub struct Times {
    from: f64,
    kind: Kind,
}

#[derive(Clone, PartialEq, Debug)]
enum Kind {
    Grid {
        every: f64,
        to: f64,
        last: u64,
    },
    /// Listed times of an analysis that ends at the last of them or later.
    Listed {
        times: Vec<f64>,
        to: f64,
    },
}

impl Times {
    /// Returns `from + k·every` for all k up to `to`; a time within 1e-9 of a step of `to` is `to` itself. `None` if there
    /// are more times than numbers that tell them apart.
    #[must_use]
    pub fn grid(from: f64, to: f64, every: f64) -> Option<Times> {
        let steps = (to - from) / every;
        let nearest = steps.round();
        let last = if (steps - nearest).abs() <= AT_THE_LAST { nearest } else { mechc_expr::math::floor(steps) };
        // also false for what is not a number
        if !(0.0..MOST).contains(&last) || (last > 0.0 && from + every <= from) {
            return None;
        }
        #[allow(clippy::cast_sign_loss)] // not below zero, as just seen
        let last = last as u64;
        Some(Times { from, kind: Kind::Grid { every, to, last } })
    }

    /// Returns only these times, sorted and without duplicates; followed from `from`.
    #[must_use]
    pub fn listed(from: f64, mut times: Vec<f64>) -> Times {
        times.sort_by(f64::total_cmp);
        times.dedup();
        Times { from, kind: Kind::Listed { times, to: from } }
    }

    /// Extends the analysis to a time (s), if none of the output times is later.
    #[must_use]
    pub fn within_analysis_to(mut self, end: Option<f64>) -> Times {
        if let (Kind::Listed { to, .. }, Some(end)) = (&mut self.kind, end) {
            *to = to.max(end);
        }
        self
    }

    /// Returns when the analysis ends (s), which may be later than the last output time: at a switch there the earlier side counts.
    #[must_use]
    pub fn end(&self) -> f64 {
        match &self.kind {
            Kind::Grid { to, .. } => *to,
            Kind::Listed { times, to } => times.last().map_or(*to, |last| to.max(*last)),
        }
    }

    /// Returns the time up to which the motion is followed (s): the end of a grid, the last of a list.
    #[must_use]
    pub fn last(&self) -> f64 {
        match &self.kind {
            Kind::Grid { to, .. } => *to,
            Kind::Listed { times, .. } => times.last().copied().unwrap_or(self.from),
        }
    }

    /// Returns when the motion begins (s).
    #[must_use]
    pub fn from(&self) -> f64 {
        self.from
    }

    /// Returns the first and last time of the analysis (s), or `None` for listed times: the last time may be later than the last that is printed.
    #[must_use]
    pub fn interval(&self) -> Option<[f64; 2]> {
        match &self.kind {
            Kind::Grid { to, .. } => Some([self.from, *to]),
            Kind::Listed { .. } => None,
        }
    }

    /// Returns the number of output times.
    #[must_use]
    pub fn len(&self) -> u64 {
        match &self.kind {
            Kind::Grid { last, .. } => last + 1,
            Kind::Listed { times, .. } => times.len() as u64,
        }
    }

    /// Returns whether there are no output times.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the time from the start of the motion to the last output time (s).
    #[must_use]
    pub fn span(&self) -> f64 {
        match &self.kind {
            Kind::Grid { to, .. } => to - self.from,
            Kind::Listed { times, .. } => times.last().map_or(0.0, |last| last - self.from),
        }
    }

    /// Returns the widest gap between output times, the start of the motion included (s).
    #[must_use]
    pub fn widest_gap(&self) -> f64 {
        match &self.kind {
            Kind::Grid { every, .. } => *every,
            Kind::Listed { times, .. } => {
                let before = std::iter::once(&self.from).chain(times);
                before.zip(times).map(|(before, t)| t - before).fold(0.0, f64::max)
            }
        }
    }

    /// Returns the output time of a number, counted from 0 (s), which must be below `len`.
    #[must_use]
    pub fn at(&self, number: u64) -> f64 {
        match &self.kind {
            Kind::Grid { every, to, last } => {
                let t = self.from + number as f64 * every;
                if number == *last && number > 0 && (t - to).abs() <= AT_THE_LAST * every { *to } else { t }
            }
            Kind::Listed { times, .. } => times[number as usize],
        }
    }

    /// Returns the number of the first output time later than `t` (s), searched from number `from` on.
    #[must_use]
    pub fn first_after(&self, t: f64, from: u64) -> u64 {
        let (mut low, mut high) = (from, from);
        let mut step = 1;
        while high < self.len() && self.at(high) <= t {
            low = high + 1;
            high += step;
            step *= 2;
        }
        high = high.min(self.len());
        while low < high {
            let middle = low + (high - low) / 2;
            if self.at(middle) <= t { low = middle + 1 } else { high = middle }
        }
        low
    }

    /// Iterates over the output times in ascending order.
    pub fn iter(&self) -> impl Iterator<Item = f64> {
        (0..self.len()).map(|number| self.at(number))
    }
}

/// Time of assembly, and the span of the analysis from there on.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Horizon {
    /// The first time (s).
    pub from: f64,
    /// Time from there to the last one (s); it is the scale for what is near in time.
    pub span: f64,
}

impl Horizon {
    /// Returns the horizon of output times.
    #[must_use]
    pub fn of(times: &Times) -> Horizon {
        let span = times.span();
        Horizon { from: times.from(), span: if span > 0.0 { span } else { DEFAULT_SPAN } }
    }

    /// Returns the horizon of an analysis: first time, last time, step (s); else from 0 on.
    #[must_use]
    pub fn of_analysis(analysis: Option<[f64; 3]>) -> Horizon {
        let [from, to, _] = analysis.unwrap_or([0.0, DEFAULT_SPAN, 0.0]);
        Horizon { from, span: to - from }
    }

    /// Returns the horizon of equal span that begins at another time (s).
    #[must_use]
    pub fn beginning(self, from: f64) -> Horizon {
        Horizon { from, ..self }
    }
}

/// Returns a time on the later side of whatever happens within rounding of `t` (s).
pub fn shortly_after(t: f64) -> f64 {
    neighbours::shortly_after(t, SLACK)
}

/// Returns a time just behind a start at `t`, for a motion over a span (s): what happens up to there happens at the start.
pub fn behind_start(t: f64, span: f64) -> f64 {
    shortly_after(t) + f64::min(AHEAD * span, LONGEST_AHEAD)
}

#[cfg(test)]
mod tests {
    use super::Times;

    fn times(from: f64, to: f64, every: f64) -> Vec<f64> {
        Times::grid(from, to, every).unwrap().iter().collect()
    }

    #[test]
    fn the_end_is_included_where_the_grid_meets_it() {
        assert_eq!(times(0.0, 0.3, 0.1), [0.0, 0.1, 0.2, 0.3]);
        assert_eq!(times(0.0, 0.35, 0.1).last(), Some(&(3.0 * 0.1)));
        assert_eq!(times(1.0, 1.0, 0.1), [1.0]);
        assert!(Times::grid(1e20, 2e20, 1.0).is_none(), "steps that do not change the time");
    }

    #[test]
    fn the_first_time_after_another_is_found() {
        let grid = Times::grid(0.0, 1.0, 0.1).unwrap();
        for (t, expected) in [(-1.0, 0), (0.0, 1), (0.05, 1), (0.1, 2), (0.99, 10), (1.0, 11), (9.0, 11)] {
            for from in 0..=expected {
                assert_eq!(grid.first_after(t, from), expected, "t = {t}, from {from}");
            }
        }
    }

    #[test]
    fn listed_times_are_sorted_and_unique() {
        let listed = Times::listed(0.0, vec![2.0, 1.0, 2.0]);
        assert_eq!(listed.iter().collect::<Vec<_>>(), [1.0, 2.0]);
    }
}
