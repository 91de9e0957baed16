//! The order of solution as text: which coordinates follow from which equations, and which are solved for together.

use super::Determined;
use crate::{ConstraintSystem, DeclarationId, Owner};
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// Number of steps that are shown at most.
const LONGEST: usize = 40;

/// One step of the solution: it needs no coordinates but its own and those of earlier steps.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Step {
    /// Rows of `Φ`, ascending.
    pub rows: Vec<u32>,
    /// Coordinates, ascending.
    pub columns: Vec<u32>,
    /// True if no part of it can be solved for alone.
    pub together: bool,
}

/// Combines blocks to steps: the single-coordinate blocks of a body or joint form one step where an order of solution allows it.
#[must_use]
pub fn steps(determined: &Determined) -> Vec<Step> {
    let mut planner = Planner::new(determined);
    let mut steps = Vec::new();
    while let Some(blocks) = planner.next() {
        let mut step = Step { rows: Vec::new(), columns: Vec::new(), together: false };
        for block in blocks {
            let block = &determined.blocks()[block];
            step.rows.extend(&block.rows);
            step.columns.extend(&block.columns);
            step.together |= block.rows.len() > 1;
        }
        step.rows.sort_unstable();
        step.columns.sort_unstable();
        steps.push(step);
    }
    steps
}

/// Chooses the next step among groups of blocks: the single-coordinate blocks of one body or joint form a group, and so does every larger block.
struct Planner {
    /// Group of each block, followed by the blocks that it depends on, and whether it is done.
    group: Vec<usize>,
    needs: Vec<Vec<usize>>,
    is_done: Vec<bool>,
    /// Blocks that depend on each block.
    needed_by: Vec<Vec<usize>>,
    /// Blocks of each group in order, followed by the number of its open dependencies on other groups.
    members: Vec<Vec<usize>>,
    open: Vec<usize>,
    /// Groups that are not done: number of open dependencies, first block, group.
    waiting: BTreeSet<(usize, usize, usize)>,
    /// All blocks before this index are done.
    first: usize,
}

impl Planner {
    fn new(determined: &Determined) -> Planner {
        let (system, blocks) = (determined.system(), determined.blocks());
        let mut block_of_column = vec![0; system.coordinates().len()];
        for (number, block) in blocks.iter().enumerate() {
            for &column in &block.columns {
                block_of_column[column as usize] = number;
            }
        }
        let (mut group, mut members): (Vec<usize>, Vec<Vec<usize>>) = (Vec::new(), Vec::new());
        let mut group_of_owner = FxHashMap::<Owner, usize>::default();
        let (mut needs, mut needed_by) = (Vec::new(), vec![Vec::new(); blocks.len()]);
        for (number, block) in blocks.iter().enumerate() {
            let group_of_block = match block.columns.as_slice() {
                [column] => {
                    let owner = system.coordinates()[*column as usize].owner;
                    *group_of_owner.entry(owner).or_insert(members.len())
                }
                _ => members.len(),
            };
            if group_of_block == members.len() {
                members.push(Vec::new());
            }
            members[group_of_block].push(number);
            group.push(group_of_block);
            let entries = block.rows.iter().flat_map(|&row| system.phi_q().row(row as usize));
            let mut needed: Vec<usize> = entries.map(|&(column, _)| block_of_column[column as usize]).collect();
            needed.sort_unstable();
            needed.dedup();
            needed.retain(|&other| other != number);
            for &other in &needed {
                needed_by[other].push(number);
            }
            needs.push(needed);
        }
        let is_done = vec![false; blocks.len()];
        let mut open = vec![0; members.len()];
        for (number, needed) in needs.iter().enumerate() {
            open[group[number]] += needed.iter().filter(|&&other| group[other] != group[number]).count();
        }
        let waiting = (0..members.len()).map(|group| (open[group], members[group][0], group)).collect();
        Planner { group, needs, is_done, needed_by, members, open, waiting, first: 0 }
    }

    /// Returns the blocks of the next step, in order.
    fn next(&mut self) -> Option<Vec<usize>> {
        let group = self.next_group()?;
        let mut blocks = Vec::new();
        for k in 0..self.members[group].len() {
            let block = self.members[group][k];
            if !self.is_done[block] && self.is_ready(block) {
                self.is_done[block] = true;
                blocks.push(block);
                self.release_dependents(block);
            }
        }
        if self.members[group].iter().all(|&block| self.is_done[block]) {
            self.waiting.remove(&(self.open[group], self.members[group][0], group));
        }
        Some(blocks)
    }

    /// Returns a group without open dependencies; else one that another group waits for and whose beginning is ready.
    fn next_group(&mut self) -> Option<usize> {
        let &(open, _, group) = self.waiting.first()?;
        if open == 0 {
            return Some(group);
        }
        let left = self.members[group].iter().filter(|&&block| !self.is_done[block]);
        let mut awaited = left.flat_map(|&block| &self.needs[block]).filter(|&&block| !self.is_done[block]);
        let awaited =
            awaited.find(|&&block| self.group[block] != group && self.is_ready(block)).map(|&block| self.group[block]);
        // the first open block depends on no open block
        self.first += self.is_done[self.first..].iter().take_while(|is_done| **is_done).count();
        awaited.or_else(|| self.group.get(self.first).copied())
    }

    fn is_ready(&self, block: usize) -> bool {
        self.needs[block].iter().all(|&needed| self.is_done[needed])
    }

    /// Updates the groups that depend on a block that is done.
    fn release_dependents(&mut self, block: usize) {
        let group_of_block = self.group[block];
        for &user in &self.needed_by[block] {
            let group = self.group[user];
            if group != group_of_block {
                let first = self.members[group][0];
                self.waiting.remove(&(self.open[group], first, group));
                self.open[group] -= 1;
                self.waiting.insert((self.open[group], first, group));
            }
        }
    }
}

/// Returns one line per step: `crank  from main, motor` or `rod, slider.x  together, from big, small`.
#[must_use]
pub fn order_of_solution(determined: &Determined) -> String {
    let system = determined.system();
    let steps = steps(determined);
    let shown = &steps[..steps.len().min(LONGEST)];
    let heads = shown.iter().map(|step| solved_for(system, &step.columns));
    let heads: Vec<(String, usize)> = heads.map(|names| (names.join(", "), names.len())).collect();
    let width = heads.iter().map(|(head, _)| head.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for ((head, count), step) in heads.iter().zip(shown) {
        let mut equations: Vec<DeclarationId> =
            step.rows.iter().map(|&row| system.rows()[row as usize].declaration).collect();
        equations.sort_unstable();
        equations.dedup();
        let equations: Vec<&str> = equations.into_iter().map(|k| system.declarations()[k].name.as_str()).collect();
        let how = if step.together && *count > 1 { "together, from" } else { "from" };
        // formatting with a dynamic width fails beyond 65,535
        let gap = " ".repeat(width - head.chars().count());
        text += &format!("  {head}{gap}  {how} {}\n", equations.join(", "));
    }
    if steps.len() > LONGEST {
        text += &format!("  … {} more\n", steps.len() - LONGEST);
    }
    text
}

/// Returns the names of bodies and joints whose coordinates are all present, and the names of single coordinates otherwise.
fn solved_for<'d>(system: &'d ConstraintSystem, columns: &[u32]) -> Vec<&'d str> {
    let owner = |column: u32| system.coordinates()[column as usize].owner;
    let mut names = Vec::new();
    for owned in columns.chunk_by(|&a, &b| owner(a) == owner(b)) {
        let all = system.coordinates().iter().filter(|coordinate| coordinate.owner == owner(owned[0])).count();
        if owned.len() == all {
            names.push(system.owner_name(owned[0] as usize));
        } else {
            names.extend(owned.iter().map(|&column| system.coordinates()[column as usize].name.as_str()));
        }
    }
    names
}
