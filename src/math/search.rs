/// The golden ratio's fraction: it sections intervals for their minimum, and its multiples never come close to a period.
pub const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Where something ceases to hold that holds at the first of two places and not at the second: two neighbouring doubles, or what
/// so many halvings leave of the interval.
#[must_use]
pub fn bisect([mut low, mut high]: [f64; 2], most: usize, mut holds: impl FnMut(f64) -> bool) -> [f64; 2] {
    for _ in 0..most {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    [low, high]
}

/// Where something begins that is not at the first of two places and is at the second, to the last bit.
#[must_use]
pub fn boundary(low: f64, high: f64, mut is_beyond: impl FnMut(f64) -> bool) -> f64 {
    let [low, high] = bisect([low, high], usize::MAX, |place| !is_beyond(place));
    0.5 * (low + high)
}

/// An interval that is sectioned for the least value of a function.
#[derive(Clone, Copy, Debug)]
pub struct GoldenSection {
    /// The ends, with the function there.
    pub low: [f64; 2],
    /// As [`GoldenSection::low`].
    pub high: [f64; 2],
    left: [f64; 2],
    right: [f64; 2],
}

impl GoldenSection {
    /// Begins between two places with the function there.
    ///
    /// # Errors
    /// The function's own.
    pub fn new<E>(
        low: [f64; 2],
        high: [f64; 2],
        mut value: impl FnMut(f64) -> Result<f64, E>,
    ) -> Result<GoldenSection, E> {
        let way = GOLDEN * (high[0] - low[0]);
        let (left, right) = (high[0] - way, low[0] + way);
        Ok(GoldenSection { low, high, left: [left, value(left)?], right: [right, value(right)?] })
    }

    /// Leaves the part out that cannot hold the least value.
    ///
    /// # Errors
    /// The function's own.
    pub fn narrow<E>(&mut self, value: impl FnOnce(f64) -> Result<f64, E>) -> Result<(), E> {
        if self.left[1] < self.right[1] {
            (self.high, self.right) = (self.right, self.left);
            let left = self.high[0] - GOLDEN * (self.high[0] - self.low[0]);
            self.left = [left, value(left)?];
        } else {
            (self.low, self.left) = (self.left, self.right);
            let right = self.low[0] + GOLDEN * (self.high[0] - self.low[0]);
            self.right = [right, value(right)?];
        }
        Ok(())
    }

    /// The least value that has been met.
    #[must_use]
    pub fn least(&self) -> f64 {
        f64::min(self.left[1], self.right[1])
    }

    /// The middle of what is left.
    #[must_use]
    pub fn middle(&self) -> f64 {
        0.5 * (self.low[0] + self.high[0])
    }
}

/// An interval whose parts are looked at from its start to its end, each of which may be halved.
pub struct Halving<const N: usize> {
    /// What is still to be looked at, the first part last.
    open: [[f64; 2]; N],
    count: usize,
    looked_at: usize,
    finest: f64,
    most: usize,
}

impl<const N: usize> Halving<N> {
    /// Into parts that are no smaller than `finest`, of which about `most` are looked at before no more are made.
    #[must_use]
    pub fn new(whole: [f64; 2], finest: f64, most: usize) -> Halving<N> {
        let mut open = [[0.0; 2]; N];
        open[0] = whole;
        Halving { open, count: 1, looked_at: 0, finest, most }
    }

    /// The next part.
    pub fn next_part(&mut self) -> Option<[f64; 2]> {
        self.count = self.count.checked_sub(1)?;
        self.looked_at += 1;
        Some(self.open[self.count])
    }

    /// Puts both halves of the part that was just looked at before what comes behind it, unless it is small enough.
    pub fn halve(&mut self, [a, b]: [f64; 2]) -> bool {
        let middle = 0.5 * (a + b);
        let is_large = b - a > self.finest && self.looked_at < self.most && middle > a && middle < b;
        if !is_large || self.count + 2 > N {
            return false;
        }
        self.open[self.count] = [middle, b];
        self.open[self.count + 1] = [a, middle];
        self.count += 2;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::{GoldenSection, Halving, bisect, boundary};
    use std::convert::Infallible;

    #[test]
    fn neighbours_are_found() {
        let [low, high] = bisect([0.0, 2.0], usize::MAX, |x| x * x < 2.0);
        assert_eq!(low.next_up(), high);
        assert!(low * low < 2.0 && high * high >= 2.0);
        assert!((boundary(0.0, 2.0, |x| x * x >= 2.0) - high).abs() <= high - low);
        assert_eq!(bisect([0.0, 1.0], 2, |_| true), [0.75, 1.0]);
    }

    #[test]
    fn a_section_keeps_the_least_value() {
        let mut value = |x: f64| Ok::<f64, Infallible>((x - 0.3) * (x - 0.3));
        let Ok(mut section) = GoldenSection::new([0.0, 0.09], [1.0, 0.49], &mut value);
        for _ in 0..40 {
            let Ok(()) = section.narrow(&mut value);
            assert!(section.low[0] <= 0.3 && section.high[0] >= 0.3);
        }
        assert!((section.middle() - 0.3).abs() < 1e-7 && section.least() < 1e-14);
    }

    #[test]
    fn parts_come_in_their_order_and_no_finer_than_is_meant() {
        let mut parts = Halving::<8>::new([0.0, 1.0], 0.2, 100);
        let mut seen = Vec::new();
        while let Some(part) = parts.next_part() {
            if !parts.halve(part) {
                seen.push(part);
            }
        }
        let eighths: Vec<[f64; 2]> = (0..8).map(|k| [f64::from(k) / 8.0, f64::from(k + 1) / 8.0]).collect();
        assert_eq!(seen, eighths);
        let mut parts = Halving::<8>::new([0.0, 1.0], 0.2, 1);
        assert_eq!(parts.next_part(), Some([0.0, 1.0]));
        assert!(!parts.halve([0.0, 1.0]) && parts.next_part().is_none(), "no more are looked at than are meant");
    }
}
