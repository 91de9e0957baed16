//! Layout of tables: columns in runs of registers, entered by the piece that contains an argument.

use super::compile::{Layout, TablePiece, TablePlacement};
use super::{Column, Op, Register, Stage, TableLayout};
use mechc_expr::{ExprId, TableId, Unary};

impl Layout<'_> {
    /// Emits a table's value at an argument, or a derivative: `c₀ + d (c₁ + d (c₂ + d c₃))`.
    pub fn table(&mut self, stage: Stage, table: TableId, order: u8, x: ExprId) -> Register {
        let number = self.placement(table).number;
        let TablePiece { piece, offset } = self.piece_at(stage, table, x);
        let mut sum = None;
        for power in (order..=3).rev() {
            let column = Column::Coefficient(power);
            let mut term = self.push(stage, |to| Op::Pick { to, table: number, column, piece });
            // factor of the derivative: 3·2 for c₃ in the second one
            let factor: u32 = (power - order + 1..=power).map(u32::from).product();
            if factor > 1 {
                let b = self.constant(f64::from(factor));
                term = self.push(stage, |to| Op::Mul { to, a: term, b });
            }
            sum = Some(match sum {
                None => term,
                Some(sum) => {
                    let product = self.push(stage, |to| Op::Mul { to, a: offset, b: sum });
                    self.push(stage, |to| Op::Add { to, a: term, b: product })
                }
            });
        }
        // the order is at most 3
        let sum = sum.unwrap_or(offset);
        if order == 3 {
            self.table_layouts[number as usize].thirds.push(sum);
        }
        sum
    }

    fn piece_at(&mut self, stage: Stage, table: TableId, x: ExprId) -> TablePiece {
        // a derived table has the pieces of its base table
        let table = self.graph.tables()[table.index()].derived_from.unwrap_or(table);
        if let Some(&piece) = self.table_pieces.get(&(table, x)) {
            return piece;
        }
        let TablePlacement { number, period } = self.placement(table);
        let knots = self.table_layouts[number as usize].knots;
        let mut a = self.register(x);
        if self.graph.tables()[table.index()].periodic {
            let from_start = self.push(stage, |to| Op::Sub { to, a, b: knots });
            let turns = self.push(stage, |to| Op::Div { to, a: from_start, b: period });
            let whole = self.push(stage, |to| Op::Unary { function: Unary::Floor, to, a: turns });
            self.table_layouts[number as usize].periods.push(whole);
            let back = self.push(stage, |to| Op::Mul { to, a: period, b: whole });
            a = self.push(stage, |to| Op::Sub { to, a, b: back });
        }
        let piece = self.push(stage, |to| Op::Piece { to, table: number, a });
        let knot = self.push(stage, |to| Op::Pick { to, table: number, column: Column::Knots, piece });
        let offset = self.push(stage, |to| Op::Sub { to, a, b: knot });
        let piece_at = TablePiece { piece, offset };
        self.table_pieces.insert((table, x), piece_at);
        piece_at
    }

    fn placement(&mut self, table: TableId) -> TablePlacement {
        if let Some(&placement) = self.tables.get(&table) {
            return placement;
        }
        let source = &self.graph.tables()[table.index()];
        let knots = self.consecutive(&source.knots);
        let coefficients = [0, 1, 2, 3].map(|order: usize| self.consecutive(&source.coefficients[order]));
        let pieces = source.coefficients[0].len() as u32;
        let period = self.push(Stage::Prologue, |to| Op::Sub { to, a: knots + pieces, b: knots });
        let placement = TablePlacement { number: self.table_layouts.len() as u32, period };
        let (name, periods, thirds) = (source.name.clone(), Vec::new(), Vec::new());
        self.table_layouts.push(TableLayout { name, pieces, knots, coefficients, periods, thirds });
        self.tables.insert(table, placement);
        placement
    }

    /// Lays cells out in consecutive registers and returns the first.
    fn consecutive(&mut self, cells: &[ExprId]) -> Register {
        let computed = self.emit_all(Stage::Prologue, cells.iter().copied());
        let registers: Vec<Register> = cells.iter().map(|_| self.fresh()).collect();
        for ((&cell, &to), a) in cells.iter().zip(&registers).zip(computed) {
            match self.graph.as_const(cell) {
                Some(value) => self.constants.push((to, value)),
                None => self.operations[Stage::Prologue as usize].push(Op::Copy { to, a }),
            }
        }
        registers.first().copied().unwrap_or_default()
    }
}
