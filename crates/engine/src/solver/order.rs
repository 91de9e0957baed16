//! The order in which the unknowns of a block are eliminated, with pivots chosen for few entries and for size (H. M. Markowitz, *Management Science*
//! 3, 1957).

use crate::limits::solver::LEAST_PIVOT;

/// Smallest pivot when it is chosen, as a part of the largest entry in its column.
const THRESHOLD: f64 = 0.25;
/// Number of rows among which a pivot is chosen.
const CANDIDATES: usize = 4;

/// An entry of a block.
#[derive(Clone, Copy, Debug)]
pub struct BlockEntry {
    /// Its row within the block.
    pub row: u32,
    /// Its column within the block.
    pub column: u32,
    /// Its scaled value where the order is chosen.
    pub value: f64,
    /// True for a number, which is independent of position and parameters and so a good pivot.
    pub is_number: bool,
}

/// An order of elimination.
#[derive(Clone, Debug)]
pub struct Order {
    /// Row and column of each pivot.
    pub pivots: Vec<(u32, u32)>,
    /// By pivot: the rows that it is eliminated from.
    pub below: Vec<Vec<u32>>,
    /// By pivot: the other columns of its row.
    pub right: Vec<Vec<u32>>,
}

impl Order {
    /// Chooses an order for a block of size `n`, whose pattern must not be singular.
    #[must_use]
    pub fn new(n: usize, entries: &[BlockEntry]) -> Order {
        let mut elimination = Elimination::new(n, entries);
        for _ in 0..n {
            elimination.step();
        }
        elimination.order
    }
}

/// The cost of a pivot: fill-in, whether it is not a number, and its size, negated.
type Cost = (usize, bool, f64);

/// An entry of a row during the elimination.
#[derive(Clone, Copy)]
struct RowEntry {
    column: u32,
    value: f64,
    /// True while it is a number.
    is_number: bool,
}

/// A numerical elimination that chooses the order.
struct Elimination {
    /// By row: its remaining entries.
    rows: Vec<Vec<RowEntry>>,
    /// By column: the rows that use it, eliminated ones included.
    users: Vec<Vec<u32>>,
    is_eliminated: Vec<bool>,
    order: Order,
    /// Rows by their number of entries when they were sorted in; outdated entries remain.
    by_length: Vec<Vec<u32>>,
}

impl Elimination {
    fn new(n: usize, entries: &[BlockEntry]) -> Elimination {
        let (mut rows, mut users) = (vec![Vec::new(); n], vec![Vec::new(); n]);
        for entry in entries {
            let BlockEntry { column, value, is_number, .. } = *entry;
            rows[entry.row as usize].push(RowEntry { column, value, is_number });
            users[entry.column as usize].push(entry.row);
        }
        let order = Order { pivots: Vec::new(), below: Vec::new(), right: Vec::new() };
        let by_length = vec![Vec::new(); n + 1];
        let mut elimination = Elimination { rows, users, is_eliminated: vec![false; n], order, by_length };
        (0..n as u32).for_each(|row| elimination.sort_in(row));
        elimination
    }

    fn sort_in(&mut self, row: u32) {
        let length = self.rows[row as usize].len();
        self.by_length[length].push(row);
    }

    /// Eliminates one unknown.
    fn step(&mut self) {
        let Some((row, column)) = self.choose_pivot() else {
            return;
        };
        self.is_eliminated[row as usize] = true;
        let pivot_row = std::mem::take(&mut self.rows[row as usize]);
        let pivot = pivot_row.iter().find(|entry| entry.column == column).map_or(LEAST_PIVOT, |entry| entry.value);
        let pivot = if pivot.abs() < LEAST_PIVOT { LEAST_PIVOT } else { pivot };
        let users = std::mem::take(&mut self.users[column as usize]);
        let below: Vec<u32> = users.into_iter().filter(|&user| !self.is_eliminated[user as usize]).collect();
        for &other in &below {
            let entries = &mut self.rows[other as usize];
            let Some(at) = entries.iter().position(|entry| entry.column == column) else {
                continue;
            };
            let multiplier = entries.swap_remove(at).value / pivot;
            for &RowEntry { column: c, value, .. } in pivot_row.iter().filter(|entry| entry.column != column) {
                if let Some(entry) = entries.iter_mut().find(|entry| entry.column == c) {
                    entry.value -= multiplier * value;
                    entry.is_number = false;
                } else {
                    entries.push(RowEntry { column: c, value: -multiplier * value, is_number: false });
                    self.users[c as usize].push(other);
                }
            }
        }
        for &row in &below {
            self.sort_in(row);
        }
        self.order.pivots.push((row, column));
        self.order.below.push(below);
        self.order.right.push(pivot_row.into_iter().map(|entry| entry.column).filter(|&c| c != column).collect());
    }

    /// Returns the pivot with the least fill-in among the shortest rows; on a tie a number, and then the largest.
    fn choose_pivot(&mut self) -> Option<(u32, u32)> {
        let shortest = self.shortest_rows();
        let mut best: Option<(Cost, (u32, u32))> = None;
        for &row in &shortest {
            let entries = &self.rows[row as usize];
            for &RowEntry { column, value, is_number } in entries {
                let (count, largest) = self.column_usage(column);
                if value == 0.0 || value.abs() < THRESHOLD * largest {
                    continue;
                }
                let cost = ((entries.len() - 1) * (count - 1), !is_number, -value.abs());
                if best.is_none_or(|(least_cost, _)| cost < least_cost) {
                    best = Some((cost, (row, column)));
                }
            }
        }
        best.map(|(_, pivot)| pivot).or_else(|| self.largest_entry())
    }

    /// Returns up to [`CANDIDATES`] of the shortest rows that are left.
    fn shortest_rows(&mut self) -> Vec<u32> {
        let mut shortest: Vec<u32> = Vec::with_capacity(CANDIDATES);
        for length in 0..self.by_length.len() {
            let bucket = &mut self.by_length[length];
            let mut k = bucket.len();
            while k > 0 && shortest.len() < CANDIDATES {
                k -= 1;
                let row = bucket[k];
                if self.is_eliminated[row as usize] || self.rows[row as usize].len() != length {
                    // a row whose length has changed has been sorted in a second time
                    bucket.swap_remove(k);
                } else if !shortest.contains(&row) {
                    shortest.push(row);
                }
            }
            if shortest.len() == CANDIDATES {
                break;
            }
        }
        shortest
    }

    /// Returns the number of remaining rows that use a column, and its largest entry in them.
    fn column_usage(&self, column: u32) -> (usize, f64) {
        let left = self.users[column as usize].iter().filter(|&&row| !self.is_eliminated[row as usize]);
        let values = left.filter_map(|&row| self.rows[row as usize].iter().find(|entry| entry.column == column));
        values.fold((0, 0.0), |(count, largest), entry| (count + 1, f64::max(largest, entry.value.abs())))
    }

    /// Returns the largest entry of all, for when the shortest rows hold no pivot that is large enough.
    fn largest_entry(&self) -> Option<(u32, u32)> {
        let left = (0..self.rows.len()).filter(|&row| !self.is_eliminated[row]);
        let entries = left.flat_map(|row| self.rows[row].iter().map(move |entry| (row as u32, entry)));
        let largest = entries.max_by(|(_, a), (_, b)| a.value.abs().total_cmp(&b.value.abs()));
        largest.map(|(row, entry)| (row, entry.column))
    }
}
