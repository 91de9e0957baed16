//! Which times are printed.

/// Output times, ascending.
#[derive(Clone, PartialEq, Debug)]
pub struct Times {
    from: f64,
    kind: Kind,
}

#[derive(Clone, PartialEq, Debug)]
enum Kind {
    Grid { every: f64, to: f64, last: u64 },
    Listed(Vec<f64>),
}

impl Times {
    /// `from + k·every` for all k up to `to`; a time within 1e-9 of a step of `to` is `to` itself. `None` where there
    /// are more times than numbers that tell them apart.
    #[must_use]
    pub fn grid(from: f64, to: f64, every: f64) -> Option<Times> {
        let steps = (to - from) / every;
        let nearest = steps.round();
        let last = if (steps - nearest).abs() <= 1e-9 { nearest } else { crate::math::floor(steps) };
        // also false for what is not a number
        if !(0.0..9e15).contains(&last) || (last > 0.0 && from + every <= from) {
            return None;
        }
        #[allow(clippy::cast_sign_loss)] // not below zero, as just seen
        let last = last as u64;
        Some(Times { from, kind: Kind::Grid { every, to, last } })
    }

    /// Only these times, sorted and each once; followed from `from`.
    #[must_use]
    pub fn listed(from: f64, mut times: Vec<f64>) -> Times {
        times.sort_by(f64::total_cmp);
        times.dedup();
        Times { from, kind: Kind::Listed(times) }
    }

    /// Where the motion begins (s).
    #[must_use]
    pub fn from(&self) -> f64 {
        self.from
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> u64 {
        match &self.kind {
            Kind::Grid { last, .. } => last + 1,
            Kind::Listed(times) => times.len() as u64,
        }
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// From the first to the last (s).
    #[must_use]
    pub fn span(&self) -> f64 {
        match &self.kind {
            Kind::Grid { to, .. } => to - self.from,
            Kind::Listed(times) => times.last().map_or(0.0, |last| last - self.from),
        }
    }

    /// In order.
    pub fn iter(&self) -> impl Iterator<Item = f64> {
        (0..self.len()).map(|k| match &self.kind {
            Kind::Grid { every, to, last } => {
                let t = self.from + k as f64 * every;
                if k == *last && (t - to).abs() <= 1e-9 * every { *to } else { t }
            }
            Kind::Listed(times) => times[k as usize],
        })
    }
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
    fn listed_times_are_sorted_and_unique() {
        let listed = Times::listed(0.0, vec![2.0, 1.0, 2.0]);
        assert_eq!(listed.iter().collect::<Vec<_>>(), [1.0, 2.0]);
    }
}
