//! Maximum matching of equations to coordinates, and the blocks that follow from it.
//!
//! Rows and columns with a single free partner are matched first, as no other choice is better (R. Karp and M. Sipser, *Maximum matchings in sparse
//! random graphs*, 1981); for an open chain of bodies that matches everything. The rest grows by augmenting paths, each found by a depth-first search
//! with a look-ahead (I. S. Duff, *On algorithms for obtaining a maximum transversal*, 1981). The blocks are the strongly connected components of the
//! matched graph (R. Tarjan, 1972), which come out in an order of solution. Neither algorithm recurses.

use super::{Block, Subsystem};
use crate::SparseRows;

const NONE: u32 = u32::MAX;

/// A matching of rows and columns.
pub(super) struct Matching {
    row_of_column: Vec<u32>,
    column_of_row: Vec<u32>,
}

/// The rows that contain each column.
struct Users {
    starts: Vec<usize>,
    rows: Vec<u32>,
}

impl Users {
    fn new(pattern: &SparseRows, rows: usize, columns: usize) -> Users {
        let mut starts = vec![0; columns + 1];
        for &(column, _) in pattern.entries() {
            starts[column as usize + 1] += 1;
        }
        for k in 0..columns {
            starts[k + 1] += starts[k];
        }
        let mut next = starts.clone();
        let mut users = vec![0; pattern.entries().len()];
        for row in 0..rows {
            for &(column, _) in pattern.row(row) {
                users[next[column as usize]] = row as u32;
                next[column as usize] += 1;
            }
        }
        Users { starts, rows: users }
    }

    fn of(&self, column: u32) -> &[u32] {
        &self.rows[self.starts[column as usize]..self.starts[column as usize + 1]]
    }
}

/// Matches rows and columns that have a single free partner, repeatedly.
struct Singles<'p> {
    pattern: &'p SparseRows,
    users: Users,
    /// Numbers of free columns of each row and of free rows of each column.
    row_choices: Vec<u32>,
    column_choices: Vec<u32>,
    single_rows: Vec<u32>,
    single_columns: Vec<u32>,
    matching: Matching,
}

impl<'p> Singles<'p> {
    fn new(pattern: &'p SparseRows, rows: usize, columns: usize) -> Singles<'p> {
        let users = Users::new(pattern, rows, columns);
        let row_choices: Vec<u32> = (0..rows).map(|row| pattern.row(row).len() as u32).collect();
        let column_choices: Vec<u32> = (0..columns as u32).map(|column| users.of(column).len() as u32).collect();
        let single = |choices: &[u32]| (0..choices.len() as u32).filter(|&k| choices[k as usize] == 1).collect();
        Singles {
            single_rows: single(&row_choices),
            single_columns: single(&column_choices),
            pattern,
            users,
            row_choices,
            column_choices,
            matching: Matching { row_of_column: vec![NONE; columns], column_of_row: vec![NONE; rows] },
        }
    }

    fn run(mut self) -> Matching {
        loop {
            if let Some(row) = self.single_rows.pop() {
                let entries = self.pattern.row(row as usize).iter();
                let free = entries.map(|&(column, _)| column).find(|&column| self.matching.is_free_column(column));
                self.join(row, free.unwrap_or(NONE));
            } else if let Some(column) = self.single_columns.pop() {
                let free = self.users.of(column).iter().copied().find(|&row| self.matching.is_free_row(row));
                self.join(free.unwrap_or(NONE), column);
            } else {
                return self.matching;
            }
        }
    }

    fn join(&mut self, row: u32, column: u32) {
        if row == NONE || column == NONE || !self.matching.is_free_row(row) || !self.matching.is_free_column(column) {
            return;
        }
        self.matching.column_of_row[row as usize] = column;
        self.matching.row_of_column[column as usize] = row;
        for &user in self.users.of(column) {
            self.row_choices[user as usize] -= 1;
            if self.row_choices[user as usize] == 1 {
                self.single_rows.push(user);
            }
        }
        for &(used, _) in self.pattern.row(row as usize) {
            self.column_choices[used as usize] -= 1;
            if self.column_choices[used as usize] == 1 {
                self.single_columns.push(used);
            }
        }
    }
}

/// Returns a matching with as many rows as possible.
pub(super) fn maximum(pattern: &SparseRows, rows: usize, columns: usize) -> Matching {
    let mut matching = Singles::new(pattern, rows, columns).run();
    // the look-ahead pointer of a row only moves on, since a matched column stays matched
    let mut ahead = vec![0; rows];
    let mut visited = vec![NONE; rows];
    let mut path: Vec<(u32, usize)> = Vec::new();
    for start in unmatched(&matching.column_of_row) {
        path.clear();
        path.push((start, 0));
        visited[start as usize] = start;
        while let Some(&(row, next)) = path.last() {
            let entries = pattern.row(row as usize);
            let cheap = &mut ahead[row as usize];
            while *cheap < entries.len() && matching.row_of_column[entries[*cheap].0 as usize] != NONE {
                *cheap += 1;
            }
            if let Some(&(free, _)) = entries.get(*cheap) {
                matching.augment(pattern, &path, free);
                break;
            }
            let Some(&(column, _)) = entries.get(next) else {
                path.pop();
                continue;
            };
            if let Some(top) = path.last_mut() {
                top.1 += 1;
            }
            let owner = matching.row_of_column[column as usize];
            if visited[owner as usize] != start {
                visited[owner as usize] = start;
                path.push((owner, 0));
            }
        }
    }
    matching
}

impl Matching {
    fn is_free_row(&self, row: u32) -> bool {
        self.column_of_row[row as usize] == NONE
    }

    fn is_free_column(&self, column: u32) -> bool {
        self.row_of_column[column as usize] == NONE
    }

    /// Assigns a free column to the last row of a path, and to each earlier row the column of the next one.
    fn augment(&mut self, pattern: &SparseRows, path: &[(u32, usize)], free: u32) {
        let mut column = free;
        for &(row, next) in path.iter().rev() {
            let previous = self.column_of_row[row as usize];
            debug_assert!(column == free || pattern.row(row as usize)[next - 1].0 == column);
            self.column_of_row[row as usize] = column;
            self.row_of_column[column as usize] = row;
            column = previous;
        }
    }

    pub fn is_perfect(&self) -> bool {
        self.column_of_row.iter().all(|&column| column != NONE) && self.row_of_column.iter().all(|&row| row != NONE)
    }

    /// Returns the overdetermined and the underdetermined part (A. Dulmage and N. Mendelsohn, *Coverings of bipartite graphs*, 1958).
    pub fn unequal_parts(&self, pattern: &SparseRows) -> [Subsystem; 2] {
        let rows = self.overdetermined_rows(pattern);
        let mut columns: Vec<u32> =
            rows.iter().flat_map(|&row| pattern.row(row as usize)).map(|&(column, _)| column).collect();
        columns.sort_unstable();
        columns.dedup();
        let free = self.free_columns(pattern);
        let mut holding: Vec<u32> = free.iter().map(|&column| self.row_of_column[column as usize]).collect();
        holding.retain(|&row| row != NONE);
        holding.sort_unstable();
        [Subsystem { rows, columns }, Subsystem { rows: holding, columns: free }]
    }

    /// Returns the overdetermined rows: those that alternating paths reach from the unmatched rows.
    fn overdetermined_rows(&self, pattern: &SparseRows) -> Vec<u32> {
        let mut open: Vec<u32> = unmatched(&self.column_of_row);
        let mut visited = vec![false; self.column_of_row.len()];
        while let Some(row) = open.pop() {
            if std::mem::replace(&mut visited[row as usize], true) {
                continue;
            }
            open.extend(
                pattern
                    .row(row as usize)
                    .iter()
                    .map(|&(column, _)| self.row_of_column[column as usize])
                    .filter(|&owner| owner != NONE),
            );
        }
        marked(&visited)
    }

    /// Returns the columns that are not fixed: those that alternating paths reach from the unmatched columns.
    fn free_columns(&self, pattern: &SparseRows) -> Vec<u32> {
        let columns = self.row_of_column.len();
        let users = Users::new(pattern, self.column_of_row.len(), columns);
        let mut open: Vec<u32> = unmatched(&self.row_of_column);
        let mut visited = vec![false; columns];
        while let Some(column) = open.pop() {
            if std::mem::replace(&mut visited[column as usize], true) {
                continue;
            }
            open.extend(
                users.of(column).iter().map(|&row| self.column_of_row[row as usize]).filter(|&matched| matched != NONE),
            );
        }
        marked(&visited)
    }

    /// Returns the irreducible blocks, each after those that its equations depend on.
    pub fn blocks(&self, pattern: &SparseRows) -> Vec<Block> {
        let rows = self.column_of_row.len();
        let mut index = vec![NONE; rows];
        let mut low = vec![0_u32; rows];
        let mut on_stack = vec![false; rows];
        let mut stack: Vec<u32> = Vec::new();
        let mut blocks = Vec::new();
        let mut count = 0;
        for start in 0..rows as u32 {
            if index[start as usize] != NONE {
                continue;
            }
            let mut calls: Vec<(u32, usize)> = vec![(start, 0)];
            while let Some(&(row, next)) = calls.last() {
                let r = row as usize;
                if next == 0 {
                    index[r] = count;
                    low[r] = count;
                    count += 1;
                    stack.push(row);
                    on_stack[r] = true;
                }
                if let Some(&(column, _)) = pattern.row(r).get(next) {
                    if let Some(top) = calls.last_mut() {
                        top.1 += 1;
                    }
                    let needed = self.row_of_column[column as usize];
                    if index[needed as usize] == NONE {
                        calls.push((needed, 0));
                    } else if on_stack[needed as usize] {
                        low[r] = low[r].min(index[needed as usize]);
                    }
                    continue;
                }
                calls.pop();
                if let Some(&(parent, _)) = calls.last() {
                    low[parent as usize] = low[parent as usize].min(low[r]);
                }
                if low[r] == index[r] {
                    let at = stack.iter().rposition(|&member| member == row).unwrap_or(0);
                    let mut members = stack.split_off(at);
                    for &member in &members {
                        on_stack[member as usize] = false;
                    }
                    members.sort_unstable();
                    let columns = members.iter().map(|&member| self.column_of_row[member as usize]).collect();
                    blocks.push(Block { rows: members, columns, explicit: false });
                }
            }
        }
        blocks
    }
}

fn unmatched(partners: &[u32]) -> Vec<u32> {
    (0..partners.len() as u32).filter(|&k| partners[k as usize] == NONE).collect()
}

fn marked(visited: &[bool]) -> Vec<u32> {
    (0..visited.len() as u32).filter(|&k| visited[k as usize]).collect()
}
