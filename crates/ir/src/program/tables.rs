//! Laying tables out: columns in runs of registers, entered by the piece that an argument lies in.

use super::compile::{Layout, Place, Reached};
use super::{Column, Op, Register, Stage, TableLayout};
use mechc_expr::{ExprId, TableId, Unary};

impl Layout<'_> {
    /// A table's value at an argument, or a derivative: `c₀ + d (c₁ + d (c₂ + d c₃))`.
    pub fn table(&mut self, stage: Stage, table: TableId, order: u8, x: ExprId) -> Register {
        let number = self.placed(table).number;
        let Reached { piece, way } = self.reached(stage, table, x);
        let mut sum = None;
        for power in (order..=3).rev() {
            let column = Column::Coefficient(power);
            let mut term = self.push(stage, |to| Op::Pick { to, table: number, column, piece });
            // what the derivatives bring down: 3·2 of c₃ for the second
            let factor: u32 = (power - order + 1..=power).map(u32::from).product();
            if factor > 1 {
                let b = self.constant(f64::from(factor));
                term = self.push(stage, |to| Op::Mul { to, a: term, b });
            }
            sum = Some(match sum {
                None => term,
                Some(sum) => {
                    let risen = self.push(stage, |to| Op::Mul { to, a: way, b: sum });
                    self.push(stage, |to| Op::Add { to, a: term, b: risen })
                }
            });
        }
        // no order is above 3
        let sum = sum.unwrap_or(way);
        if order == 3 {
            self.table_layouts[number as usize].thirds.push(sum);
        }
        sum
    }

    fn reached(&mut self, stage: Stage, table: TableId, x: ExprId) -> Reached {
        // a derivative has the pieces of its table, and is in the same one
        let table = self.graph.tables()[table.index()].derived_from.unwrap_or(table);
        if let Some(&reached) = self.reached.get(&(table, x)) {
            return reached;
        }
        let Place { number, period } = self.placed(table);
        let knots = self.table_layouts[number as usize].knots;
        let mut a = self.register(x);
        if self.graph.tables()[table.index()].periodic {
            let way = self.push(stage, |to| Op::Sub { to, a, b: knots });
            let turns = self.push(stage, |to| Op::Div { to, a: way, b: period });
            let whole = self.push(stage, |to| Op::Unary { function: Unary::Floor, to, a: turns });
            self.table_layouts[number as usize].periods.push(whole);
            let back = self.push(stage, |to| Op::Mul { to, a: period, b: whole });
            a = self.push(stage, |to| Op::Sub { to, a, b: back });
        }
        let piece = self.push(stage, |to| Op::Piece { to, table: number, a });
        let knot = self.push(stage, |to| Op::Pick { to, table: number, column: Column::Knots, piece });
        let way = self.push(stage, |to| Op::Sub { to, a, b: knot });
        let reached = Reached { piece, way };
        self.reached.insert((table, x), reached);
        reached
    }

    fn placed(&mut self, table: TableId) -> Place {
        if let Some(&place) = self.tables.get(&table) {
            return place;
        }
        let of_graph = &self.graph.tables()[table.index()];
        let knots = self.run_of(&of_graph.knots);
        let coefficients = [0, 1, 2, 3].map(|order: usize| self.run_of(&of_graph.coefficients[order]));
        let pieces = of_graph.coefficients[0].len() as u32;
        let period = self.push(Stage::Prologue, |to| Op::Sub { to, a: knots + pieces, b: knots });
        let place = Place { number: self.table_layouts.len() as u32, period };
        let (name, periods, thirds) = (of_graph.name.clone(), Vec::new(), Vec::new());
        self.table_layouts.push(TableLayout { name, pieces, knots, coefficients, periods, thirds });
        self.tables.insert(table, place);
        place
    }

    /// Cells in neighbouring registers.
    fn run_of(&mut self, cells: &[ExprId]) -> Register {
        let computed = self.place(Stage::Prologue, cells.iter().copied());
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
