//! Derivatives of formulas through the cells of tables, for directions in which parameters vary.

use super::table::{Table, TableId};
use super::{Dependence, ExprId, Graph, Symbol, Unary};
use rustc_hash::FxHashMap;

/// Suffix for the name of a table's derivative with respect to its cells; no other name ends so.
pub const VARIED_TABLE: &str = " varied";

/// Derivatives of tables with respect to their cells, along one direction.
pub(super) type VariedTables = FxHashMap<TableId, VariedTable>;

/// Derivative of a table with respect to its cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct VariedTable {
    /// Derivative at a fixed argument within the table's range; `None` if no cell varies.
    table: Option<TableId>,
    /// Derivative of the period, if the table repeats and the period varies.
    period: Option<ExprId>,
}

impl Graph {
    /// Returns the derivatives of the roots along a direction in which parameters vary, and the cells of tables with them.
    pub fn variations(
        &mut self,
        roots: &[ExprId],
        mut direction: impl FnMut(&mut Graph, Symbol) -> Option<ExprId>,
    ) -> Vec<ExprId> {
        self.along(roots, &mut direction, &mut Some(VariedTables::default()))
    }

    /// Returns the derivative of a table, or of its derivative of an order, through its cells at an argument; `None` if it vanishes.
    pub(super) fn derivative_by_cells(
        &mut self,
        table: TableId,
        order: u8,
        x: ExprId,
        direction: &mut impl FnMut(&mut Graph, Symbol) -> Option<ExprId>,
        varied: &mut Option<VariedTables>,
    ) -> Option<ExprId> {
        let tables = varied.as_mut()?;
        let VariedTable { table: derived, period } =
            *tables.entry(table).or_insert_with(|| self.varied_table(table, direction));
        let by_pieces = derived.map(|derived| self.table(derived, order, x));
        let by_period = period.filter(|_| order < 3).map(|period| {
            // f(x) = P(x − n L): n stays, L changes
            let (first, last) = self.ends(table);
            let (offset, length) = (self.sub(x, first), self.sub(last, first));
            let turns = self.div(offset, length);
            let whole = self.unary(Unary::Floor, turns);
            let moved = self.mul(whole, period);
            let slope = self.table(table, order + 1, x);
            let share = self.mul(slope, moved);
            self.neg(share)
        });
        match (by_pieces, by_period) {
            (Some(a), Some(b)) => Some(self.add(a, b)),
            (one, other) => one.or(other),
        }
    }

    fn ends(&self, table: TableId) -> (ExprId, ExprId) {
        let knots = &self.tables[table.index()].knots;
        (knots[0], knots[knots.len() - 1])
    }

    /// Returns the derivative of a table along a direction `′`. With `f = c₀ + d (c₁ + d (c₂ + d c₃))` and `d = x − k` it is `f′ = (c₀′ −
    /// k′c₁) + d ((c₁′ − 2k′c₂) + d ((c₂′ − 3k′c₃) + d c₃′))`.
    fn varied_table(
        &mut self,
        table: TableId,
        direction: &mut impl FnMut(&mut Graph, Symbol) -> Option<ExprId>,
    ) -> VariedTable {
        let unchanged = VariedTable { table: None, period: None };
        let of = self.tables[table.index()].clone();
        if !of.dependence.on(Dependence::PARAMS) {
            return unchanged;
        }
        let mut changed = |graph: &mut Graph, cells: &[ExprId]| graph.along(cells, direction, &mut None);
        let knots = changed(self, &of.knots);
        let [c0, c1, c2, c3] = [0, 1, 2, 3].map(|order: usize| changed(self, &of.coefficients[order]));
        let values = changed(self, &of.values);
        if [&knots, &c0, &c1, &c2, &c3].into_iter().flatten().all(|&cell| self.is_zero(cell)) {
            return unchanged;
        }
        let mut moved = |change: &[ExprId], power: f64, slopes: &[ExprId]| -> Vec<ExprId> {
            let cells = change.iter().zip(&knots).zip(slopes);
            cells
                .map(|((&change, &knot), &slope)| {
                    let times = self.constant(power);
                    let steep = self.mul(times, slope);
                    let share = self.mul(knot, steep);
                    self.sub(change, share)
                })
                .collect()
        };
        let [_, s1, s2, s3] = &of.coefficients;
        let coefficients = [moved(&c0, 1.0, s1), moved(&c1, 2.0, s2), moved(&c2, 3.0, s3), c3];
        let period = of.periodic.then(|| self.sub(knots[knots.len() - 1], knots[0]));
        let period = period.filter(|&period| !self.is_zero(period));
        let derived = Table {
            name: of.name.clone() + VARIED_TABLE,
            derived_from: of.derived_from.or(Some(table)),
            values,
            coefficients,
            ..of
        };
        VariedTable { table: Some(self.find_or_add(derived)), period }
    }

    /// Returns the id of a table, which is added unless the graph contains it.
    fn find_or_add(&mut self, table: Table) -> TableId {
        let is_same = |other: &Table| {
            other.derived_from == table.derived_from
                && other.name == table.name
                && other.coefficients == table.coefficients
        };
        match self.tables.iter().position(is_same) {
            Some(index) => TableId(index as u32),
            None => self.add_table(table),
        }
    }
}
