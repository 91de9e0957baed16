//! Constants: columns of tables, and reference sizes of coordinates.

use super::Writer;
use crate::print::Page;
use crate::solution::Solution;
use crate::tables::numbers;
use crate::text::{constant, literal, one_line};
use mechc_engine::limits::step_control::{FEWEST_STEPS, SMALLEST_STEP};
use mechc_expr::VARIED_TABLE;
use mechc_ir::program::{Column, STAGES};

/// Number of coordinates of Newton's method beyond which a table holds them.
const MOST_TEARS_IN_LINE: usize = 64;

impl Writer<'_> {
    /// Prints the columns of tables that are constant.
    pub fn tables(&self, page: &mut Page) {
        let program = self.unit.program;
        for (number, table) in program.tables().iter().enumerate() {
            for column in Column::ALL {
                let number = number as u32;
                // how a table varies has the pieces of that table
                let is_left_out = table.name.ends_with(VARIED_TABLE) && !self.is_looked_into(number, column);
                let Some(values) = numbers(program, &self.equations.constants, number, column).filter(|_| !is_left_out)
                else {
                    continue;
                };
                let what = match column {
                    Column::Knots => "where its pieces begin, and where the last one ends".to_owned(),
                    Column::Coefficient(order) => format!("coefficient {order} of each piece"),
                };
                page.docs(&format!("Table `{}`: {what}.", one_line(&table.name)));
                page.line("#[rustfmt::skip]");
                let name = self.equations.tables.of(number, column);
                let values: Vec<String> = values.into_iter().map(literal).collect();
                page.list(&format!("static {name}: [f64; {}] = [", values.len()), &values, "];");
                page.blank();
            }
        }
    }

    /// Returns whether an operation reads a column of a table.
    fn is_looked_into(&self, table: u32, column: Column) -> bool {
        let mut all = STAGES.iter().flat_map(|stage| self.unit.program.stage(*stage));
        all.any(|&op| op.column() == Some((table, column)))
    }

    /// Prints the times of the file's analysis.
    pub fn times(solution: &Solution<'_>, page: &mut Page) {
        let (from, to) = (solution.motion.from, solution.motion.to);
        let span = to.map_or(1.0, |to| if to > from { to - from } else { 1.0 });
        let docs = "The first time of the file's analysis (s), at which the mechanism is assembled.";
        page.constant(docs, "pub const START_TIME: f64", &literal(from));
        page.constant("How long the file's analysis takes (s).", "const SPAN: f64", &literal(span));
        page.constant("The longest step (s).", "pub const LONGEST_STEP: f64", &literal(span / FEWEST_STEPS));
        page.constant("The shortest step (s).", "const SMALLEST_STEP: f64", &literal(SMALLEST_STEP * span));
    }

    /// Prints the scales of the coordinates, and the start of the motion.
    pub fn scales(&self, solution: &Solution<'_>, page: &mut Page) {
        let coordinates = self.unit.system.coordinates();
        debug_assert_eq!(solution.motion.q.len(), coordinates.len());
        let scales: Vec<String> = coordinates.iter().map(|coordinate| literal(coordinate.scale)).collect();
        let docs = "What a change of each coordinate is judged against.";
        page.text(&constant(docs, "SCALES", "f64", "N", &scales));
        let start: Vec<String> = solution.motion.q.iter().copied().map(literal).collect();
        page.text(&constant("The assembled position (m, rad).", "START", "f64", "N", &start));
    }

    /// Prints the subjects of the solver's function: coordinates that Newton solves for, blocks whose determinants change.
    pub fn solved_for(&self, solution: &Solution<'_>, page: &mut Page) {
        let (solver, coordinates) = (&solution.motion.solver, self.unit.system.coordinates());
        let tears = solver.tears();
        let docs = "Number of coordinates that Newton solves for; the others follow.";
        page.constant(docs, "const TEARS: usize", &tears.len().to_string());
        let scales: Vec<String> = tears.iter().map(|&tear| literal(coordinates[tear as usize].scale)).collect();
        let docs = "What a change of each of them is judged against (m, or 1 rad).";
        page.text(&constant(docs, "TEAR_SCALES", "f64", "TEARS", &scales));
        let docs = "Number of blocks of equations whose determinants change with the position.";
        page.constant(docs, "const TURNS: usize", &solver.turns().len().to_string());
        let turned: Vec<String> = solver.turns().iter().map(|turn| turn.is_negative.to_string()).collect();
        let docs = "Whether they are negative where all pivots are positive.";
        page.text(&constant(docs, "TURNED", "bool", "TURNS", &turned));
        if !solution.joined.is_empty() {
            let docs = "Number of values that measures join, beside those that are given out.";
            page.constant(docs, "const JOINED: usize", &solution.joined.len().to_string());
        }
    }

    /// Prints a function's body that selects the coordinates that Newton solves for.
    pub fn tears(solution: &Solution<'_>, page: &mut Page) {
        let tears = solution.motion.solver.tears();
        if tears.len() > MOST_TEARS_IN_LINE {
            let columns: Vec<String> = tears.iter().map(u32::to_string).collect();
            page.line("#[rustfmt::skip]");
            page.list("const COLUMNS: [usize; TEARS] = [", &columns, "];");
            page.line("COLUMNS.map(|column| q.get(column).copied().unwrap_or(f64::NAN))");
        } else if tears.is_empty() {
            page.line("[]");
        } else {
            let tears: Vec<String> = tears.iter().map(|tear| format!("q[{tear}]")).collect();
            page.list("[", &tears, "]");
        }
    }
}
