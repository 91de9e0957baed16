//! Tables: piecewise cubic functions of one argument, such as the interpolating splines of the language.
//!
//! Between two knots a table is `c₀ + d (c₁ + d (c₂ + d c₃))`, with `d` the offset from the lower knot. The coefficients are formulas of
//! parameters; a table of numbers alone is folded to numbers.

use super::{Dependence, ExprId, Graph, Node, Symbol};
use crate::math;
use rustc_hash::FxHashMap;

/// Index of a table in a graph.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct TableId(pub(super) u32);

impl TableId {
    /// Returns the position among the graph's tables, from 0.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A piecewise cubic function.
#[derive(Clone, Debug)]
pub struct Table {
    /// Its name.
    pub name: String,
    /// True if it repeats; the period is the length of its range.
    pub periodic: bool,
    /// Arguments in ascending order, one more than pieces.
    pub knots: Vec<ExprId>,
    /// Values at the knots.
    pub values: Vec<ExprId>,
    /// `c₀` to `c₃` of each piece.
    pub coefficients: [Vec<ExprId>; 4],
    /// The table whose derivative with respect to its cells this is; it has the same pieces.
    pub derived_from: Option<TableId>,
    /// Kinds of symbols in its cells: parameters or none.
    pub(super) dependence: Dependence,
}

impl Table {
    /// Returns the formulas that a value is computed from: knots and coefficients.
    pub fn cells(&self) -> impl Iterator<Item = ExprId> + '_ {
        self.knots.iter().chain(self.coefficients.iter().flatten()).copied()
    }
}

/// Returns the piece that contains an argument: the one that begins at the last knot not above it.
#[must_use]
pub fn piece(pieces: usize, knot: impl Fn(usize) -> f64, x: f64) -> usize {
    let (mut low, mut high) = (0, pieces);
    while high - low > 1 {
        let middle = usize::midpoint(low, high);
        if knot(middle) <= x {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

impl Graph {
    /// Returns the tables, by index.
    #[must_use]
    pub fn tables(&self) -> &[Table] {
        &self.tables
    }

    /// Adds the natural or periodic cubic spline through points: at least two, or three if periodic, where the last point repeats the first value.
    ///
    /// Source: C. de Boor, *A Practical Guide to Splines*, 1978, chapter IV.
    pub fn spline(&mut self, name: &str, periodic: bool, points: &[[ExprId; 2]]) -> TableId {
        let knots: Vec<ExprId> = points.iter().map(|point| point[0]).collect();
        let values: Vec<ExprId> = points.iter().map(|point| point[1]).collect();
        let widths: Vec<ExprId> = knots.windows(2).map(|pair| self.sub(pair[1], pair[0])).collect();
        let slopes: Vec<ExprId> = (0..widths.len())
            .map(|k| {
                let rise = self.sub(values[k + 1], values[k]);
                self.div(rise, widths[k])
            })
            .collect();
        let bends = if periodic { self.periodic_bends(&widths, &slopes) } else { self.natural_bends(&widths, &slopes) };
        let mut coefficients = [values[..widths.len()].to_vec(), Vec::new(), Vec::new(), Vec::new()];
        let [two, three, six] = [2.0, 3.0, 6.0].map(|c| self.constant(c));
        for k in 0..widths.len() {
            // c₁ = slope − h (2 M + M₊)/6, c₂ = M/2, c₃ = (M₊ − M)/(6 h)
            let (bend, next) = (bends[k], bends[k + 1]);
            let double = self.mul(two, bend);
            let sum = self.add(double, next);
            let weighted = self.mul(widths[k], sum);
            let share = self.div(weighted, six);
            coefficients[1].push(self.sub(slopes[k], share));
            coefficients[2].push(self.div(bend, two));
            let change = self.sub(next, bend);
            let width = self.mul(two, widths[k]);
            let width = self.mul(three, width);
            coefficients[3].push(self.div(change, width));
        }
        self.add_table(Table {
            name: name.to_owned(),
            periodic,
            knots,
            values,
            coefficients,
            derived_from: None,
            dependence: Dependence::default(),
        })
    }

    pub(super) fn add_table(&mut self, mut table: Table) -> TableId {
        table.dependence = table.cells().fold(table.dependence, |all, cell| all.or(self.dependence(cell)));
        self.tables.push(table);
        TableId(self.tables.len() as u32 - 1)
    }

    /// Copies the tables of another graph into this one, which has none yet; see [`Graph::import`].
    pub fn import_tables(
        &mut self,
        from: &Graph,
        copied: &mut FxHashMap<ExprId, ExprId>,
        mut replace: impl FnMut(&mut Graph, Symbol) -> ExprId,
    ) {
        for table in &from.tables {
            let cells: Vec<ExprId> = table.cells().chain(table.values.iter().copied()).collect();
            self.import(from, &cells, copied, &mut replace);
            let rebuilt = |list: &[ExprId]| list.iter().map(|cell| copied[cell]).collect::<Vec<ExprId>>();
            let [c0, c1, c2, c3] = &table.coefficients;
            self.add_table(Table {
                name: table.name.clone(),
                periodic: table.periodic,
                knots: rebuilt(&table.knots),
                values: rebuilt(&table.values),
                coefficients: [c0, c1, c2, c3].map(|list| rebuilt(list)),
                derived_from: table.derived_from,
                dependence: Dependence::default(),
            });
        }
    }

    /// Returns `6 (slope − slope before)`, the right side of the equation for the second derivative at a knot.
    fn bend_right_side(&mut self, before: ExprId, after: ExprId) -> ExprId {
        let six = self.constant(6.0);
        let change = self.sub(after, before);
        self.mul(six, change)
    }

    /// Returns `2 (h₋ + h)`.
    fn double_width(&mut self, before: ExprId, after: ExprId) -> ExprId {
        let two = self.constant(2.0);
        let sum = self.add(before, after);
        self.mul(two, sum)
    }

    /// Returns the second derivatives at the knots, zero at both ends: the solution of `h₋ M₋ + 2 (h₋ + h) M + h M₊ = 6 (s − s₋)` by
    /// elimination from left to right.
    fn natural_bends(&mut self, widths: &[ExprId], slopes: &[ExprId]) -> Vec<ExprId> {
        let zero = self.constant(0.0);
        let mut pivots: Vec<ExprId> = Vec::new();
        let mut rights: Vec<ExprId> = Vec::new();
        for k in 1..widths.len() {
            let mut pivot = self.double_width(widths[k - 1], widths[k]);
            let mut right = self.bend_right_side(slopes[k - 1], slopes[k]);
            if let (Some(&above), Some(&right_above)) = (pivots.last(), rights.last()) {
                let factor = self.div(widths[k - 1], above);
                let (a, b) = (self.mul(factor, widths[k - 1]), self.mul(factor, right_above));
                (pivot, right) = (self.sub(pivot, a), self.sub(right, b));
            }
            pivots.push(pivot);
            rights.push(right);
        }
        let mut bends = vec![zero; widths.len() + 1];
        for k in (1..widths.len()).rev() {
            let carried = self.mul(widths[k], bends[k + 1]);
            let rest = self.sub(rights[k - 1], carried);
            bends[k] = self.div(rest, pivots[k - 1]);
        }
        bends
    }

    /// Returns the second derivatives at the knots of a periodic spline: the same equations on a ring, with the last unknown as a separate
    /// column until the end.
    fn periodic_bends(&mut self, widths: &[ExprId], slopes: &[ExprId]) -> Vec<ExprId> {
        let n = widths.len();
        let zero = self.constant(0.0);
        let before = |k: usize| if k == 0 { n - 1 } else { k - 1 };
        let diagonal: Vec<ExprId> = (0..n).map(|k| self.double_width(widths[before(k)], widths[k])).collect();
        let mut rights: Vec<ExprId> = (0..n).map(|k| self.bend_right_side(slopes[before(k)], slopes[k])).collect();
        let mut pivots = diagonal;
        // the column of the last unknown, and the last row
        let mut column = vec![zero; n];
        let mut row = vec![zero; n];
        column[0] = widths[n - 1];
        row[0] = widths[n - 1];
        column[n - 2] = self.add(column[n - 2], widths[n - 2]);
        row[n - 2] = self.add(row[n - 2], widths[n - 2]);
        for k in 0..n - 1 {
            if k + 1 < n - 1 {
                let factor = self.div(widths[k], pivots[k]);
                let [a, b, c] = [widths[k], column[k], rights[k]].map(|above| self.mul(factor, above));
                pivots[k + 1] = self.sub(pivots[k + 1], a);
                column[k + 1] = self.sub(column[k + 1], b);
                rights[k + 1] = self.sub(rights[k + 1], c);
            }
            let factor = self.div(row[k], pivots[k]);
            let [b, c] = [column[k], rights[k]].map(|above| self.mul(factor, above));
            pivots[n - 1] = self.sub(pivots[n - 1], b);
            rights[n - 1] = self.sub(rights[n - 1], c);
            if k + 1 < n - 1 {
                let a = self.mul(factor, widths[k]);
                row[k + 1] = self.sub(row[k + 1], a);
            }
        }
        let mut bends = vec![zero; n + 1];
        bends[n - 1] = self.div(rights[n - 1], pivots[n - 1]);
        for k in (0..n - 1).rev() {
            let far = self.mul(column[k], bends[n - 1]);
            let mut rest = self.sub(rights[k], far);
            if k + 1 < n - 1 {
                let near = self.mul(widths[k], bends[k + 1]);
                rest = self.sub(rest, near);
            }
            bends[k] = self.div(rest, pivots[k]);
        }
        bends[n] = bends[0];
        bends
    }

    /// Returns a table, or its derivative of an order up to 3, at an argument.
    pub fn table(&mut self, table: TableId, order: u8, x: ExprId) -> ExprId {
        let node = Node::Table(table, order, x);
        let is_number = |id: ExprId| self.as_const(id).is_some();
        if is_number(x) && self.tables[table.index()].cells().all(is_number) {
            let number = |id: ExprId| self.as_const(id).unwrap_or(f64::NAN);
            let value = self.table_value(table, order, number(x), number);
            return self.folded(value, node);
        }
        self.intern(node)
    }

    /// Returns the value of a table or of one of its derivatives at an argument, from the values of its cells.
    pub(super) fn table_value(&self, table: TableId, order: u8, x: f64, cell: impl Fn(ExprId) -> f64) -> f64 {
        let Table { knots, coefficients, periodic, .. } = &self.tables[table.index()];
        let pieces = coefficients[0].len();
        let knot = |k: usize| cell(knots[k]);
        let x = if *periodic {
            let period = knot(pieces) - knot(0);
            x - period * math::floor((x - knot(0)) / period)
        } else {
            x
        };
        if x.is_nan() {
            return x;
        }
        let k = piece(pieces, knot, x);
        let d = x - knot(k);
        let [c0, c1, c2, c3] = [0, 1, 2, 3].map(|j: usize| cell(coefficients[j][k]));
        match order {
            0 => c0 + d * (c1 + d * (c2 + d * c3)),
            1 => c1 + d * (2.0 * c2 + d * (3.0 * c3)),
            2 => 2.0 * c2 + d * (6.0 * c3),
            _ => 6.0 * c3,
        }
    }
}
