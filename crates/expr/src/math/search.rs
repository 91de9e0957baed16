//! Where something happens in an interval: golden section, halving.

use super::grid::on_grid;
use super::neighbours::bisect;

/// The golden ratio's fraction: it sections intervals for their minimum, and its multiples never come close to a period.
pub const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Where something begins that is not at the first of two places and is at the second, to the last bit.
#[must_use]
pub fn boundary(low: f64, high: f64, mut is_beyond: impl FnMut(f64) -> bool) -> f64 {
    let [low, high] = bisect([low, high], usize::MAX, |place| !is_beyond(place));
    0.5 * (low + high)
}

/// Where something is crossed between two places, and how far off each of them is, by secants: the last place before it and the first one
/// behind, of those that are multiples of `grid`, a power of two, or of all doubles where that is 0; so they do not depend on where the search
/// began. `look` says of a place whether it is behind, and how far off: any measure that goes to zero at the crossing, or not a number where that
/// is not known; or nothing, which ends the search. Where secants do not close in, halves do.
///
/// Source: the Illinois method, M. Dowell and P. Jarratt, *A modified regula falsi method*, BIT 11, 1971.
pub fn close_in(
    [mut before, mut behind]: [[f64; 2]; 2],
    grid: f64,
    mut look: impl FnMut(f64) -> Option<(bool, f64)>,
) -> Option<[f64; 2]> {
    // the first and the last place that lie strictly between two others
    let inner = |from: f64, to: f64| {
        if grid > 0.0 && grid > 0.5 * f64::EPSILON * f64::max(from.abs(), to.abs()) {
            [((from / grid).floor() + 1.0) * grid, ((to / grid).ceil() - 1.0) * grid]
        } else {
            [from.next_up(), to.next_down()]
        }
    };
    let (mut widths, mut last) = ([f64::INFINITY; 2], None);
    loop {
        let [[from, off], [to, off_behind]] = [before, behind];
        let (width, [first, end]) = (to - from, inner(from, to));
        if first > end {
            return Some([from, to]);
        }
        let secant = from + width * (off / (off + off_behind));
        let is_closing = secant.is_finite() && width <= 0.5 * widths[1];
        let wanted = if is_closing { secant } else { 0.5 * from + 0.5 * to };
        let place = if grid > 0.0 { on_grid(wanted, grid) } else { wanted }.clamp(first, end);
        let (is_behind, off_here) = look(place)?;
        let (end, other) = if is_behind { (&mut behind, &mut before) } else { (&mut before, &mut behind) };
        *end = [place, off_here];
        if last.replace(is_behind) == Some(is_behind) {
            // the end that stays is counted as nearer, so that it does not stay for ever
            other[1] *= 0.5;
        }
        widths = [width, widths[0]];
    }
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
