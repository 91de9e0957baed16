//! Searches in an interval: secants, golden section, bisection.

use super::grid::on_grid;
use super::neighbours::bisect;

/// Fraction of the golden section. Its multiples never come close to a period.
pub const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Returns where a predicate becomes true between two positions, to the last bit. It is false at `low` and true at `high`.
#[must_use]
pub fn boundary(low: f64, high: f64, mut is_beyond: impl FnMut(f64) -> bool) -> f64 {
    let [low, high] = bisect([low, high], usize::MAX, |x| !is_beyond(x));
    0.5 * (low + high)
}

/// Encloses a crossing between two positions by secants, with bisection where secants converge slowly. Returns the last position before it
/// and the first one behind it, of the multiples of `grid`, a power of two, or of all doubles if `grid` is 0; the result does not depend on
/// the start of the search. Each start is a position with its distance from the crossing. `look` returns whether a position is behind the
/// crossing, and its distance: any measure that vanishes at the crossing, or NaN if unknown. `None` from `look` ends the search.
/// Source: the Illinois method, M. Dowell and P. Jarratt, *A modified regula falsi method*, BIT 11, 1971.
pub fn enclose_root(
    [mut before, mut behind]: [[f64; 2]; 2],
    grid: f64,
    mut look: impl FnMut(f64) -> Option<(bool, f64)>,
) -> Option<[f64; 2]> {
    // Returns the first and the last position strictly between two others.
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
        let target = if is_closing { secant } else { 0.5 * from + 0.5 * to };
        let x = if grid > 0.0 { on_grid(target, grid) } else { target }.clamp(first, end);
        let (is_behind, off_here) = look(x)?;
        let (end, other) = if is_behind { (&mut behind, &mut before) } else { (&mut before, &mut behind) };
        *end = [x, off_here];
        if last.replace(is_behind) == Some(is_behind) {
            // halving the distance of the end that stays moves the next secant towards it
            other[1] *= 0.5;
        }
        widths = [width, widths[0]];
    }
}

/// An interval that is narrowed to the minimum of a function by golden section.
#[derive(Clone, Copy, Debug)]
pub struct GoldenSection {
    /// Lower end, with the value there.
    pub low: [f64; 2],
    /// Upper end, with the value there.
    pub high: [f64; 2],
    left: [f64; 2],
    right: [f64; 2],
}

impl GoldenSection {
    /// Evaluates a function at two inner positions. Each end is a position with its value.
    ///
    /// # Errors
    /// Errors of the function.
    pub fn new<E>(
        low: [f64; 2],
        high: [f64; 2],
        mut value: impl FnMut(f64) -> Result<f64, E>,
    ) -> Result<GoldenSection, E> {
        let length = GOLDEN * (high[0] - low[0]);
        let (left, right) = (high[0] - length, low[0] + length);
        Ok(GoldenSection { low, high, left: [left, value(left)?], right: [right, value(right)?] })
    }

    /// Removes the section that cannot contain the minimum.
    ///
    /// # Errors
    /// Errors of the function.
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

    /// Returns the least value at the inner positions.
    #[must_use]
    pub fn least(&self) -> f64 {
        f64::min(self.left[1], self.right[1])
    }

    /// Returns the middle of the interval.
    #[must_use]
    pub fn middle(&self) -> f64 {
        0.5 * (self.low[0] + self.high[0])
    }
}

/// A depth-first bisection of an interval, from its start to its end.
pub struct Halving<const N: usize> {
    /// Sections still to be visited, the first one last.
    open: [[f64; 2]; N],
    count: usize,
    looked_at: usize,
    finest: f64,
    most: usize,
}

impl<const N: usize> Halving<N> {
    /// Creates a bisection to sections no shorter than `finest`. After about `most` visits no more sections are halved.
    #[must_use]
    pub fn new(whole: [f64; 2], finest: f64, most: usize) -> Halving<N> {
        let mut open = [[0.0; 2]; N];
        open[0] = whole;
        Halving { open, count: 1, looked_at: 0, finest, most }
    }

    /// Returns the next section.
    pub fn next_part(&mut self) -> Option<[f64; 2]> {
        self.count = self.count.checked_sub(1)?;
        self.looked_at += 1;
        Some(self.open[self.count])
    }

    /// Replaces the section that was just visited by its halves, unless it is short enough; returns whether it did.
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

/// Returns the upper median of some numbers; 0 for an empty list.
#[must_use]
pub fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
}
