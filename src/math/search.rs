//! Where something happens in an interval: golden section, halving.

use super::neighbours::bisect;

/// The golden ratio's fraction: it sections intervals for their minimum, and its multiples never come close to a period.
pub const GOLDEN: f64 = 0.618_033_988_749_894_9;

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

/// Returns the upper median of some numbers; 0 if there are none.
#[must_use]
pub fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
}
