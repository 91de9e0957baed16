//! Tables in emitted code: columns of numbers as statics, columns of parameters as local arrays.

use super::names::Namer;
use mechc_ir::program::{Column, Program, Register};
use rustc_hash::FxHashMap;

/// Names of the columns of a program's tables.
pub(super) struct Tables {
    names: FxHashMap<(u32, Column), String>,
}

impl Tables {
    pub fn new(program: &Program) -> Tables {
        let mut namer = Namer::default();
        let mut names = FxHashMap::default();
        for (number, table) in program.tables().iter().enumerate() {
            for column in Column::ALL {
                let what = match column {
                    Column::Knots => "knots".to_owned(),
                    Column::Coefficient(order) => format!("c{order}"),
                };
                names.insert((number as u32, column), namer.constant(&format!("{} {what}", table.name)));
            }
        }
        Tables { names }
    }

    /// Returns the names of columns in a body that builds them, in order: `lift_knots`.
    pub fn variables(&self) -> Vec<String> {
        let mut all: Vec<String> = self.names.values().map(|name| name.to_lowercase()).collect();
        all.sort_unstable();
        all
    }

    /// Returns the name of a column's static: `LIFT_KNOTS`.
    pub fn of(&self, table: u32, column: Column) -> &str {
        self.names.get(&(table, column)).map_or("", String::as_str)
    }
}

/// Returns the numbers of a column; `None` if it depends on parameters.
pub(super) fn numbers(
    program: &Program,
    constants: &FxHashMap<Register, f64>,
    table: u32,
    column: Column,
) -> Option<Vec<f64>> {
    let mut cells = program.tables()[table as usize].column(column);
    cells.all(|register| constants.contains_key(&register)).then(|| {
        let cells = program.tables()[table as usize].column(column);
        cells.filter_map(|register| constants.get(&register).copied()).collect()
    })
}
