//! Symbolic elimination of a block of `Φ_q` in a given order.

use super::order::Order;
use super::tape::{Tape, Value};

/// A row of a block: the columns of its entries within the block, with their values.
pub(super) type Line = Vec<(u32, Value)>;

/// The factors of a block of `Φ_q`. Rows and columns are counted within the block.
pub(super) struct Factors {
    pivots: Vec<(u32, u32)>,
    inverses: Vec<Value>,
    /// By pivot: the rows below it with their multipliers, and the other entries of its row.
    lower: Vec<Line>,
    upper: Vec<Line>,
    /// The last two unknowns, if they are solved together.
    pair: Option<TwoByTwo>,
}

/// Two equations for two unknowns with the inverse of their determinant, solved by Cramer's rule (G. Cramer, 1750): one division instead of two in
/// sequence.
struct TwoByTwo {
    rows: [u32; 2],
    columns: [u32; 2],
    entries: [[Value; 2]; 2],
    inverse: Value,
}

/// The inverse of a pivot, or of the determinant of the last two, with its rows and columns.
pub(super) struct Inverse {
    pub value: Value,
    pub positions: Vec<(u32, u32)>,
}

impl Factors {
    /// Factorizes one equation for one unknown.
    pub fn single(tape: &mut Tape, slope: Value) -> Factors {
        Factors {
            pivots: vec![(0, 0)],
            inverses: vec![tape.recip(slope)],
            lower: vec![Line::new()],
            upper: vec![Line::new()],
            pair: None,
        }
    }

    /// Eliminates rows in an order. `weight`, if given, returns the number of the weight by which a multiplier of one row for another is checked.
    pub fn new(
        tape: &mut Tape,
        mut rows: Vec<Line>,
        order: &Order,
        mut weight: Option<impl FnMut(u32, u32) -> u32>,
    ) -> Factors {
        let mut factors = Factors {
            pivots: order.pivots.clone(),
            inverses: Vec::with_capacity(rows.len()),
            lower: Vec::with_capacity(rows.len()),
            upper: Vec::with_capacity(rows.len()),
            pair: None,
        };
        for (k, (&(row, column), below)) in order.pivots.iter().zip(&order.below).enumerate() {
            if k + 2 == order.pivots.len() {
                factors.pair = TwoByTwo::new(tape, order, &rows);
                if factors.pair.is_some() {
                    break;
                }
            }
            let mut line = std::mem::take(&mut rows[row as usize]);
            let pivot = take_entry(&mut line, column);
            let inverse = tape.recip(pivot.unwrap_or(Value::ZERO));
            let mut lower = Vec::with_capacity(below.len());
            for &other in below {
                let target = &mut rows[other as usize];
                let Some(entry) = take_entry(target, column) else {
                    continue;
                };
                let multiplier = match &mut weight {
                    Some(weight) => tape.multiplier(entry, inverse, || weight(row, other)),
                    None => tape.mul(entry, inverse),
                };
                subtract_multiple(tape, target, multiplier, &line);
                lower.push((other, multiplier));
            }
            factors.inverses.push(inverse);
            factors.lower.push(lower);
            factors.upper.push(line);
        }
        factors
    }

    /// Returns the inverse of each pivot, and last that of the 2 × 2 determinant, if there is one.
    pub fn inverses(&self) -> Vec<Inverse> {
        let singles = self.pivots.iter().zip(&self.inverses);
        let mut all: Vec<Inverse> =
            singles.map(|(&position, &value)| Inverse { value, positions: vec![position] }).collect();
        if let Some(TwoByTwo { rows, columns, inverse, .. }) = self.pair {
            let positions = rows.into_iter().zip(columns).collect();
            all.push(Inverse { value: inverse, positions });
        }
        all
    }

    /// Solves `A x = right`, from `right` by rows to the solution by columns.
    pub fn solve(&self, tape: &mut Tape, mut right: Vec<Value>) -> Vec<Value> {
        for (&(row, _), lower) in self.pivots.iter().zip(&self.lower) {
            let value = right[row as usize];
            for &(other, multiplier) in lower {
                let product = tape.mul(multiplier, value);
                right[other as usize] = tape.sub(right[other as usize], product);
            }
        }
        let mut solution = vec![Value::ZERO; right.len()];
        if let Some(pair) = &self.pair {
            pair.solve(tape, &right, &mut solution);
        }
        for (k, &(row, column)) in self.pivots[..self.inverses.len()].iter().enumerate().rev() {
            let mut sum = right[row as usize];
            for &(other, value) in &self.upper[k] {
                let product = tape.mul(value, solution[other as usize]);
                sum = tape.sub(sum, product);
            }
            solution[column as usize] = tape.mul(sum, self.inverses[k]);
        }
        solution
    }

    /// Solves `Aᵀ x = right`, from `right` by columns to the solution by rows.
    pub fn solve_transposed(&self, tape: &mut Tape, mut right: Vec<Value>) -> Vec<Value> {
        let mut solution = vec![Value::ZERO; right.len()];
        for ((&(row, column), &inverse), upper) in self.pivots.iter().zip(&self.inverses).zip(&self.upper) {
            let unknown = tape.mul(right[column as usize], inverse);
            solution[row as usize] = unknown;
            for &(other, value) in upper {
                let product = tape.mul(value, unknown);
                right[other as usize] = tape.sub(right[other as usize], product);
            }
        }
        if let Some(pair) = &self.pair {
            pair.solve_transposed(tape, &right, &mut solution);
        }
        for (&(row, _), lower) in self.pivots.iter().zip(&self.lower).rev() {
            for &(other, multiplier) in lower {
                let product = tape.mul(multiplier, solution[other as usize]);
                solution[row as usize] = tape.sub(solution[row as usize], product);
            }
        }
        solution
    }

    /// Returns whether the permutation of rows to pivot columns is odd.
    pub fn is_odd(&self) -> bool {
        is_odd(&self.pivots)
    }
}

impl TwoByTwo {
    /// Solves for the last two unknowns together, if both equations contain both and no entry is a number; else returns `None`.
    fn new(tape: &mut Tape, order: &Order, rows: &[Line]) -> Option<TwoByTwo> {
        let &[.., (upper, first), (lower, second)] = order.pivots.as_slice() else {
            return None;
        };
        let entry = |row: u32, column: u32| {
            let entry = rows[row as usize].iter().find(|(other, _)| *other == column).map(|(_, value)| *value);
            entry.filter(|value| matches!(value, Value::Register { .. }))
        };
        let entries = [[entry(upper, first)?, entry(upper, second)?], [entry(lower, first)?, entry(lower, second)?]];
        let (down, up) = (tape.mul(entries[0][0], entries[1][1]), tape.mul(entries[0][1], entries[1][0]));
        let determinant = tape.sub(down, up);
        let inverse = tape.recip(determinant);
        Some(TwoByTwo { rows: [upper, lower], columns: [first, second], entries, inverse })
    }

    fn solve(&self, tape: &mut Tape, right: &[Value], solution: &mut [Value]) {
        let right = self.rows.map(|row| right[row as usize]);
        self.by_cramer(tape, self.entries, right, self.columns, solution);
    }

    /// Solves the transposed equations.
    fn solve_transposed(&self, tape: &mut Tape, right: &[Value], solution: &mut [Value]) {
        let [[a, b], [c, d]] = self.entries;
        let right = self.columns.map(|column| right[column as usize]);
        self.by_cramer(tape, [[a, c], [b, d]], right, self.rows, solution);
    }

    fn by_cramer(
        &self,
        tape: &mut Tape,
        [[a, b], [c, d]]: [[Value; 2]; 2],
        [upper, lower]: [Value; 2],
        unknowns: [u32; 2],
        solution: &mut [Value],
    ) {
        let products = [[(d, upper), (b, lower)], [(a, lower), (c, upper)]];
        for (unknown, [(x, p), (y, q)]) in unknowns.into_iter().zip(products) {
            let (plus, minus) = (tape.mul(x, p), tape.mul(y, q));
            let difference = tape.sub(plus, minus);
            solution[unknown as usize] = tape.mul(difference, self.inverse);
        }
    }
}

/// Removes the entry of a column from a row.
fn take_entry(line: &mut Line, column: u32) -> Option<Value> {
    line.iter().position(|(other, _)| *other == column).map(|at| line.swap_remove(at).1)
}

/// Subtracts a multiple of one row from another.
fn subtract_multiple(tape: &mut Tape, target: &mut Line, multiplier: Value, line: &[(u32, Value)]) {
    for &(column, value) in line {
        let product = tape.mul(multiplier, value);
        match target.iter_mut().find(|(other, _)| *other == column) {
            Some((_, entry)) => *entry = tape.sub(*entry, product),
            None => target.push((column, product.negated())),
        }
    }
}

/// Returns whether the permutation of rows to columns is odd.
fn is_odd(pivots: &[(u32, u32)]) -> bool {
    let mut column_of = vec![0; pivots.len()];
    for &(row, column) in pivots {
        column_of[row as usize] = column as usize;
    }
    let mut is_odd = false;
    for row in 0..column_of.len() {
        while column_of[row] != row {
            let other = column_of[row];
            column_of.swap(row, other);
            is_odd = !is_odd;
        }
    }
    is_odd
}
