//! Maximum matching of equations to coordinates, and the blocks that follow from it.
//!
//! The matching grows by augmenting paths, each found by a depth-first search with a look-ahead (I. S. Duff, *On
//! algorithms for obtaining a maximum transversal*, 1981); the blocks are the strongly connected components of the
//! matched graph (R. Tarjan, 1972), which come out in an order of solution. Neither recurses.

use super::Block;
use crate::ir::SparseRows;

const NONE: u32 = u32::MAX;

/// Which row is matched to which column.
pub(super) struct Matching {
    row_of_column: Vec<u32>,
    column_of_row: Vec<u32>,
}

/// A matching with as many rows as possible.
pub(super) fn maximum(pattern: &SparseRows, rows: usize, columns: usize) -> Matching {
    let mut matching = Matching { row_of_column: vec![NONE; columns], column_of_row: vec![NONE; rows] };
    // cheap assignments never need undoing: each row's look-ahead pointer only moves on
    let mut ahead = vec![0; rows];
    let mut visited = vec![NONE; rows];
    let mut path: Vec<(u32, usize)> = Vec::new();
    for start in 0..rows as u32 {
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
    /// Gives the path's last row a free column, and each earlier row the column of the one after it.
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

    /// Rows among which there is one too many: all that alternating paths reach from the unmatched ones.
    pub fn overdetermined_rows(&self, pattern: &SparseRows) -> Vec<u32> {
        let mut open: Vec<u32> = unmatched(&self.column_of_row);
        let mut seen = vec![false; self.column_of_row.len()];
        while let Some(row) = open.pop() {
            if std::mem::replace(&mut seen[row as usize], true) {
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
        marked(&seen)
    }

    /// Columns that nothing fixes: all that alternating paths reach from the unmatched ones.
    pub fn free_columns(&self, pattern: &SparseRows) -> Vec<u32> {
        let columns = self.row_of_column.len();
        let mut users: Vec<Vec<u32>> = vec![Vec::new(); columns];
        for row in 0..self.column_of_row.len() {
            for &(column, _) in pattern.row(row) {
                users[column as usize].push(row as u32);
            }
        }
        let mut open: Vec<u32> = unmatched(&self.row_of_column);
        let mut seen = vec![false; columns];
        while let Some(column) = open.pop() {
            if std::mem::replace(&mut seen[column as usize], true) {
                continue;
            }
            open.extend(
                users[column as usize]
                    .iter()
                    .map(|&row| self.column_of_row[row as usize])
                    .filter(|&matched| matched != NONE),
            );
        }
        marked(&seen)
    }

    /// The irreducible blocks, each after those that its equations need.
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
                    blocks.push(Block { rows: members, columns });
                }
            }
        }
        blocks
    }
}

fn unmatched(partners: &[u32]) -> Vec<u32> {
    (0..partners.len() as u32).filter(|&k| partners[k as usize] == NONE).collect()
}

fn marked(seen: &[bool]) -> Vec<u32> {
    (0..seen.len() as u32).filter(|&k| seen[k as usize]).collect()
}
