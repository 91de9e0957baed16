// Sparse linear equations that fall apart into blocks, each solved by elimination with partial pivoting.
//
// For places where an order of elimination that was fixed beforehand loses digits. All scaling is by powers of two, which
// round nothing.

/// Equations for as many unknowns, and how they fall apart: a block's equations hold its own unknowns and those of the blocks
/// before it.
#[derive(Clone, Copy, Debug)]
pub struct Blocks<'b> {
    /// How many equations each block has.
    pub sizes: &'b [usize],
    /// The equations, block by block.
    pub rows: &'b [usize],
    /// The unknowns, block by block.
    pub columns: &'b [usize],
    /// Where the entries of each equation begin, and where those of the last one end.
    pub starts: &'b [usize],
    /// The unknown of each entry.
    pub entries: &'b [usize],
    /// By unknown: its place in `columns`.
    pub places: &'b [usize],
    /// By unknown: the power of two that it is measured by.
    pub units: &'b [f64],
}

/// Solves for `x`: the values of the entries times `x` are `right`, which is given by equation.
///
/// `work` holds as many numbers as the largest block has entries, and one more for each of its equations. Writes for each block
/// whether its determinant is negative, and gives the smallest pivot, beside rows whose largest entry is about 1; what is not a
/// number wins.
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

/// How many numbers the work for a block of a size takes.
#[must_use]
pub const fn work_of(size: usize) -> usize {
    size * (size + 2)
}

/// A matrix row by row.
fn lines(matrix: &mut [f64], width: usize) -> impl Iterator<Item = &mut [f64]> {
    let mut left = matrix;
    core::iter::from_fn(move || {
        let (line, rest) = core::mem::take(&mut left).split_at_mut_checked(width)?;
        left = rest;
        Some(line)
    })
}

/// One equation of the block whose unknowns begin at a place, scaled, with what is known brought to the right.
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
        // two over the power of two that is not above it
        let factor = 1.0 / f64::from_bits(largest.to_bits() & 0x7ff0_0000_0000_0000);
        for entry in line {
            *entry *= factor;
        }
    }
}

/// Elimination with partial pivoting of rows that end with their right sides; gives the smallest pivot, and whether the
/// determinant is negative.
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
