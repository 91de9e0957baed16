// Sparse linear equations that fall apart into blocks, each solved by elimination with partial pivoting.
//
// They serve positions at which an order of elimination that was fixed beforehand loses digits. All scaling is by powers of
// two, which round nothing.

/// The structure of a square system in block triangular form: a block's equations hold its own unknowns and those of earlier
/// blocks.
#[derive(Clone, Copy, Debug)]
pub struct Blocks<'b> {
    /// The number of equations of each block.
    pub sizes: &'b [usize],
    /// The equations, block by block.
    pub rows: &'b [usize],
    /// The unknowns, block by block.
    pub columns: &'b [usize],
    /// The index of the first entry of each equation, then the number of entries.
    pub starts: &'b [usize],
    /// The unknown of each entry.
    pub entries: &'b [usize],
    /// By unknown: its place in `columns`.
    pub places: &'b [usize],
    /// By unknown: its unit, a power of two.
    pub units: &'b [f64],
}

/// Solves `A x = right`, where `values` are the entries of `A` and `right` is given by equation.
///
/// `work` has at least [`work_of`] numbers for the largest block; with fewer, the solution stops there. Writes for each block
/// whether its determinant is negative. Returns the smallest pivot, of rows scaled so that their largest entry is in [1, 2); NaN
/// wins.
pub fn solve(
    blocks: &Blocks<'_>,
    values: &[f64],
    right: &[f64],
    x: &mut [f64],
    work: &mut [f64],
    is_negative: &mut [bool],
) -> f64 {
    let (mut smallest, mut at) = (f64::INFINITY, 0);
    for (&size, is_negative) in blocks.sizes.iter().zip(is_negative) {
        let places = at..at + size;
        at += size;
        let (Some(rows), Some(columns)) = (blocks.rows.get(places.clone()), blocks.columns.get(places.clone())) else {
            break;
        };
        let Some((matrix, solution)) = work.split_at_mut_checked(size * (size + 1)) else {
            break;
        };
        for (line, &row) in lines(matrix, size + 1).zip(rows) {
            fill(blocks, row, places.start, values, right, x, line);
        }
        let Some(solution) = solution.get_mut(..size) else {
            break;
        };
        let pivot;
        (pivot, *is_negative) = eliminate(matrix, solution);
        smallest = if pivot >= smallest { smallest } else { pivot };
        for (&column, &value) in columns.iter().zip(&*solution) {
            if let (Some(x), Some(unit)) = (x.get_mut(column), blocks.units.get(column)) {
                *x = value * unit;
            }
        }
    }
    smallest
}

/// Returns the number of `f64` that [`solve`] needs as `work` for a block of `size` equations.
#[must_use]
pub const fn work_of(size: usize) -> usize {
    size * (size + 2)
}

/// Returns the rows of a row-major matrix.
fn lines(matrix: &mut [f64], width: usize) -> impl Iterator<Item = &mut [f64]> {
    let mut left = matrix;
    core::iter::from_fn(move || {
        let (line, rest) = core::mem::take(&mut left).split_at_mut_checked(width)?;
        left = rest;
        Some(line)
    })
}

/// Writes an equation of the block whose unknowns begin at `first` into `line`, scaled, with known terms on the right side.
fn fill(blocks: &Blocks<'_>, row: usize, first: usize, values: &[f64], right: &[f64], x: &[f64], line: &mut [f64]) {
    line.fill(0.0);
    let (mut sum, mut largest) = (right.get(row).copied().unwrap_or(f64::NAN), 0.0);
    let ends = (blocks.starts.get(row), blocks.starts.get(row + 1));
    let (Some(&from), Some(&to)) = ends else {
        return;
    };
    let entries = blocks.entries.iter().zip(values).take(to).skip(from);
    let size = line.len() - 1;
    for (&column, &value) in entries {
        let place = blocks.places.get(column).map_or(usize::MAX, |place| place.wrapping_sub(first));
        let unit = blocks.units.get(column).copied().unwrap_or(1.0);
        match line.get_mut(place).filter(|_| place < size) {
            Some(entry) => {
                *entry = value * unit;
                largest = if entry.abs() > largest { entry.abs() } else { largest };
            }
            None => sum -= value * x.get(column).copied().unwrap_or(0.0),
        }
    }
    if let Some(last) = line.last_mut() {
        *last = sum;
    }
    if largest > 0.0 && largest.is_finite() {
        // the inverse of the largest power of two that is not above the largest entry
        let factor = 1.0 / f64::from_bits(largest.to_bits() & 0x7ff0_0000_0000_0000);
        for entry in line {
            *entry *= factor;
        }
    }
}

/// Solves rows that end with their right sides by elimination with partial pivoting. Returns the smallest pivot, and whether
/// the determinant is negative.
fn eliminate(matrix: &mut [f64], x: &mut [f64]) -> (f64, bool) {
    let width = x.len() + 1;
    let (mut smallest, mut is_negative) = (f64::INFINITY, false);
    let mut left = &mut *matrix;
    for k in 0..x.len() {
        let Some((first, below)) = core::mem::take(&mut left).split_at_mut_checked(width) else {
            break;
        };
        let entry = |line: &[f64]| line.get(k).copied().unwrap_or(0.0);
        for line in lines(below, width) {
            if entry(line).abs() > entry(first).abs() {
                is_negative = !is_negative;
                for (a, b) in first.iter_mut().zip(line) {
                    core::mem::swap(a, b);
                }
            }
        }
        let pivot = entry(first);
        is_negative ^= pivot < 0.0;
        smallest = if pivot.abs() >= smallest { smallest } else { pivot.abs() };
        for line in lines(below, width) {
            let factor = entry(line) / pivot;
            if factor != 0.0 {
                for (a, b) in line.iter_mut().zip(&*first).skip(k) {
                    *a -= factor * b;
                }
            }
        }
        left = below;
    }
    let mut rest = &*matrix;
    for k in (0..x.len()).rev() {
        let Some((before, line)) = rest.split_at_checked(k * width) else {
            break;
        };
        rest = before;
        let sum = line.get(width - 1).copied().unwrap_or(f64::NAN);
        let sum = line.iter().zip(&*x).skip(k + 1).fold(sum, |sum, (a, x)| sum - a * x);
        if let (Some(x), Some(pivot)) = (x.get_mut(k), line.get(k)) {
            *x = sum / pivot;
        }
    }
    (smallest, is_negative)
}
