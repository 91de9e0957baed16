//! Derivatives by what formulas are made of: by parameters, which tables are made of too.

use super::table::{Table, TableId};
use super::{Dependence, ExprId, Graph, Symbol, Unary};
use rustc_hash::FxHashMap;

/// What the name of a table's derivative by what its cells hold ends in, which no other table's does.
pub const VARIED_TABLE: &str = " varied";

/// The derivatives of tables by what their cells hold, along one direction.
pub(super) type VariedTables = FxHashMap<TableId, VariedTable>;

/// The derivative of a table by what its cells hold.
#[derive(Clone, Copy, Debug)]
pub(super) struct VariedTable {
    /// At a fixed argument within the table's range; none where nothing of the table changes.
    table: Option<TableId>,
    /// How the period changes, if the table repeats and it does.
    period: Option<ExprId>,
}

impl Graph {
    /// As [`Graph::derivatives`] along a direction in which parameters change: the numbers that tables are made of change with them.
    pub fn variations(
        &mut self,
        roots: &[ExprId],
        mut direction: impl FnMut(&mut Graph, Symbol) -> Option<ExprId>,
    ) -> Vec<ExprId> {
        self.along(roots, &mut direction, &mut Some(VariedTables::default()))
    }

    /// How a table, or its derivative of an order, changes at an argument with what its cells hold; `None` where it does not.
    pub(super) fn derivative_by_cells(
        &mut self,
        (table, order, x): (TableId, u8, ExprId),
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
            let (way, length) = (self.sub(x, first), self.sub(last, first));
            let turns = self.div(way, length);
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

    /// With `f = c₀ + d (c₁ + d (c₂ + d c₃))`, `d = x − k`, along a direction `′`:
    /// `f′ = (c₀′ − k′c₁) + d ((c₁′ − 2k′c₂) + d ((c₂′ − 3k′c₃) + d c₃′))`.
    fn varied_table(
        &mut self,
        table: TableId,
        direction: &mut impl FnMut(&mut Graph, Symbol) -> Option<ExprId>,
    ) -> VariedTable {
        let nothing = VariedTable { table: None, period: None };
        let of = self.tables[table.index()].clone();
        if !of.dependence.on(Dependence::PARAMS) {
            return nothing;
        }
        let mut changed = |graph: &mut Graph, cells: &[ExprId]| graph.along(cells, direction, &mut None);
        let knots = changed(self, &of.knots);
        let [c0, c1, c2, c3] = [0, 1, 2, 3].map(|order: usize| changed(self, &of.coefficients[order]));
        let values = changed(self, &of.values);
        if [&knots, &c0, &c1, &c2, &c3].into_iter().flatten().all(|&cell| self.is_zero(cell)) {
            return nothing;
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
        VariedTable { table: Some(self.known_or_added(derived)), period }
    }

    /// The same table is the same, whoever asks for it.
    fn known_or_added(&mut self, table: Table) -> TableId {
        let is_same = |known: &Table| {
            known.derived_from == table.derived_from
                && known.name == table.name
                && known.coefficients == table.coefficients
        };
        match self.tables.iter().position(is_same) {
            Some(at) => TableId(at as u32),
            None => self.add_table(table),
        }
    }
}
