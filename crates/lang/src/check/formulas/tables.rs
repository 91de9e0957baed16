//! Tables: their rows from a list or a file, and their calls.

use super::Formulas;
use super::dimensions::require_dimension;
use super::display_units::compound;
use super::quantities::describe;
use super::table_file::{self, Picked};
use super::value::{Context, Dim, Value};
use crate::check::errors::{self, Reporter};
use crate::model::{Condition, ConditionKind, Dimension};
use mechc_expr::{ExprId, TableId};
use mechc_syntax::ast::{ColumnName, ColumnWord, Expr, ExprKind, Name, TableRows, WrittenUnit};
use mechc_syntax::normalized;
use mechc_text::diag::Diagnostic;
use mechc_text::source::{FileId, Span};
use mechc_text::vocabulary::CompoundUnit;

/// The distance beyond its range, relative to the range, up to which an argument counts as the end because of rounding.
const AT_THE_END: f64 = 1e-12;

/// The allowed difference of a periodic table's ends, relative to its largest value, because of rounding.
const SAME: f64 = 1e-12;

/// The state of a table.
pub(super) struct TableState<'a> {
    pub name: &'a Name,
    pub periodic: bool,
    pub rows: &'a TableRows,
    /// True if it holds a unit, directly or through names.
    pub dimensional: bool,
    /// The table in the graph, if it is valid.
    pub made: Option<Made>,
}

/// A table in the graph.
#[derive(Clone, Copy)]
pub(super) struct Made {
    id: TableId,
    /// The dimensions of the argument and of the value.
    columns: [Dim; 2],
    /// The first and the last argument.
    range: [ExprId; 2],
    periodic: bool,
}

/// A row with its location.
struct Row {
    cells: [ExprId; 2],
    /// The argument in the file, in its own unit.
    written: Option<f64>,
    span: Span,
}

impl<'a> Formulas<'a> {
    pub(in crate::check) fn table(&mut self, k: usize) {
        let (name, periodic, rows_written) = (self.tables[k].name, self.tables[k].periodic, self.tables[k].rows);
        let read = match rows_written {
            TableRows::Listed(rows) => self.listed_rows(rows),
            TableRows::File { path, columns, units } => self.file_rows(path, columns.as_ref(), units.as_ref()),
        };
        let Some((rows, columns)) = read else {
            return;
        };
        self.tables[k].dimensional = columns.iter().any(|dim| matches!(dim, Dim::Of(d) if !d.is(Dimension::PURE)));
        let file = match rows_written {
            TableRows::File { path, .. } => Some(path.span),
            TableRows::Listed(_) => None,
        };
        if !self.rows_are_sound(name, periodic, &rows, columns[1], file) {
            return;
        }
        let points: Vec<[ExprId; 2]> = rows.iter().map(|row| row.cells).collect();
        let (Some(first), Some(last)) = (points.first(), points.last()) else {
            return;
        };
        let range = [first[0], last[0]];
        let id = self.model.graph.spline(&name.text, periodic, &points);
        self.tables[k].made = Some(Made { id, columns, range, periodic });
    }

    /// Reads `[(a, b), …]`. The dimensions of each column are judged as a whole.
    fn listed_rows(&mut self, rows: &'a [Expr]) -> Option<(Vec<Row>, [Dim; 2])> {
        let mut pairs = Vec::new();
        for row in rows {
            match &row.kind {
                ExprKind::Tuple(parts) if parts.len() == 2 => pairs.push([&parts[0], &parts[1]]),
                ExprKind::Tuple(parts) => {
                    self.reporter.report(errors::row_of(row.span, parts.len()));
                }
                _ => self.reporter.report(errors::wrong_kind(row.span, "a row `(argument, value)`", describe(row))),
            }
        }
        if pairs.len() < rows.len() {
            return None;
        }
        let first = self.listed_column(pairs.iter().map(|pair| pair[0]), "the arguments of a table");
        let second = self.listed_column(pairs.iter().map(|pair| pair[1]), "the values of a table");
        let ((first, a), (second, b)) = (first?, second?);
        let cells = first.into_iter().zip(second).zip(rows);
        Some((cells.map(|((x, y), row)| Row { cells: [x, y], written: None, span: row.span }).collect(), [a, b]))
    }

    fn listed_column<'e>(
        &mut self,
        cells: impl Iterator<Item = &'e Expr> + Clone,
        what: &'static str,
    ) -> Option<(Vec<ExprId>, Dim)> {
        let judged = cells.clone().any(|cell| self.is_dimensional(cell));
        let context = Context { judged, ..Context::constant("a table") };
        let mut column = Some(Vec::new());
        let mut all: Option<(Span, Value)> = None;
        for cell in cells {
            let Some(value) = self.formula(cell, &context) else {
                column = None;
                continue;
            };
            match &mut all {
                Some((span, column_so_far)) if column_so_far.dim != Dim::Any => {
                    match self.unify(&format!("{what} are"), (*span, *column_so_far), (cell.span, value), &context) {
                        Some(dim) => column_so_far.dim = dim,
                        None => column = None,
                    }
                }
                _ => all = Some((cell.span, value)),
            }
            if let Some(column) = &mut column {
                column.push(value.id);
            }
        }
        Some((column?, all.map_or(Dim::PLAIN, |(_, all)| all.dim.of_term())))
    }

    /// Reads `"file.csv" columns 1, 3 (unit, unit)`.
    fn file_rows(
        &mut self,
        path: &Name,
        columns: Option<&[ColumnName; 2]>,
        units: Option<&[WrittenUnit; 2]>,
    ) -> Option<(Vec<Row>, [Dim; 2])> {
        let units = match units {
            None => [None, None],
            Some(written) => {
                let [first, second] =
                    written.each_ref().map(|unit| compound(&mut self.reporter, unit, errors::not_a_unit_of_a_column));
                [Some(first?), Some(second?)]
            }
        };
        let file = self.file_of_table(path)?;
        let picked = match columns {
            None => Picked::Both,
            Some(columns) => picked(&mut self.reporter, path, columns, file)?,
        };
        let (rows, faults) = table_file::read(self.reporter.sources.get(file), file, picked);
        if !faults.is_empty() {
            for fault in faults {
                self.reporter.report(fault.also(path.span, "named here"));
            }
            return None;
        }
        let mut cell = |unit: Option<&CompoundUnit>, value: f64| {
            let si = unit.map_or(value, |unit| unit.to_si(value));
            self.model.graph.constant(si)
        };
        let rows: Vec<Row> = rows
            .into_iter()
            .map(|(values, span)| {
                let cells = [0, 1].map(|k: usize| cell(units[k].as_ref(), values[k]));
                Row { cells, written: Some(values[0]), span }
            })
            .collect();
        if rows.is_empty() {
            self.reporter.report(errors::empty_table_file(path));
            return None;
        }
        let dims = units.map(|unit| unit.map_or(Dim::PLAIN, |unit| Dim::Of(unit.dimension())));
        Some((rows, dims))
    }

    /// Returns the file's text that a table names, if it could be read.
    fn file_of_table(&mut self, path: &Name) -> Option<FileId> {
        match self.options.files.get(&(path.span.file, path.text.clone())) {
            Some(Ok(file)) => Some(*file),
            Some(Err(diagnostic)) => {
                let named = "named here";
                let diagnostic = diagnostic.as_ref().clone();
                self.reporter.report(if diagnostic.labels.is_empty() {
                    diagnostic.at(path.span, named)
                } else {
                    diagnostic.also(path.span, named)
                });
                None
            }
            None => {
                self.reporter.report(errors::no_table_file(path));
                None
            }
        }
    }

    /// Checks that there are enough rows, arguments ascend, and a periodic table ends with its first value.
    fn rows_are_sound(&mut self, name: &Name, periodic: bool, rows: &[Row], values: Dim, file: Option<Span>) -> bool {
        let dimension = values.settled();
        let named = |diagnostic: Diagnostic| match file {
            Some(span) => diagnostic.also(span, "named here"),
            None => diagnostic,
        };
        let least = if periodic { 3 } else { 2 };
        if rows.len() < least {
            self.reporter.report(errors::too_few_rows(name, periodic, least, rows.len()));
            return false;
        }
        let values: Vec<[f64; 2]> =
            rows.iter().map(|row| row.cells.map(|id| self.constant_value(id).unwrap_or(f64::NAN))).collect();
        for k in 1..rows.len() {
            let (before, here) = (values[k - 1][0], values[k][0]);
            if here.is_nan() || here <= before {
                let reported = [rows[k].written.unwrap_or(here), rows[k - 1].written.unwrap_or(before)];
                self.reporter.report(named(errors::not_rising(name, reported, [rows[k].span, rows[k - 1].span])));
                return false;
            }
        }
        let (first, last) = (values[0][1], values[values.len() - 1][1]);
        let largest = values.iter().fold(0.0, |m: f64, v| m.max(v[1].abs()));
        if periodic && (last - first).abs() > SAME * largest {
            let ends = [rows[rows.len() - 1].span, rows[0].span];
            self.reporter.report(named(errors::ends_differ(name, ends, [last, first], dimension)));
            return false;
        }
        true
    }

    /// Evaluates a call such as `lift(e)`.
    pub(super) fn table_call(
        &mut self,
        k: usize,
        e: &Expr,
        arguments: &[Expr],
        context: &Context<'_>,
    ) -> Option<Value> {
        let name = self.tables[k].name;
        let [written] = arguments else {
            self.reporter.report(errors::argument_count(&name.text, None, e.span, "one argument", arguments.len()));
            return None;
        };
        let argument = self.number(written, context)?;
        let made = self.tables[k].made?;
        let expected = made.columns[0].settled();
        require_dimension(
            &mut self.reporter,
            &format!("the argument of `{}`", name.text),
            expected,
            written.span,
            argument.dim,
            context,
        )?;
        if !made.periodic {
            self.within(name, made, argument.id, written.span, context)?;
        }
        Some(Value { id: self.model.graph.table(made.id, 0, argument.id), dim: made.columns[1] })
    }

    /// Requires that an argument lies in a table's range: immediately if it is constant, else along the motion.
    fn within(&mut self, name: &Name, made: Made, x: ExprId, span: Span, context: &Context<'_>) -> Option<()> {
        let [first, last] = made.range;
        let ends = [self.constant_value(first)?, self.constant_value(last)?];
        if let Some(value) = self.constant_value(x) {
            let slack = AT_THE_END * (ends[1] - ends[0]);
            if !self.branch.is_untaken && (value < ends[0] - slack || value > ends[1] + slack) {
                self.reporter.report(errors::out_of_table(name, value, ends, made.columns[0].settled(), span));
                return None;
            }
        }
        if self.model.graph.dependence(x).is_constant() {
            return Some(());
        }
        let graph = &mut self.model.graph;
        let length = graph.sub(last, first);
        let slack = graph.constant(AT_THE_END);
        let slack = graph.mul(slack, length);
        let ways = [graph.sub(x, first), graph.sub(last, x)];
        for distance in ways {
            let room = self.model.graph.add(distance, slack);
            let one = self.model.graph.constant(1.0);
            let positive = self.branch.guard.map_or(room, |guard| self.model.graph.select(guard, room, one));
            let owner = context.place.to_owned();
            self.model.conditions.push(Condition { positive, kind: ConditionKind::Range(made.id), span, owner });
        }
        Some(())
    }
}

/// Returns the number of a column in a file's first line, from 0.
fn position_of(path: &Name, column: &ColumnName, header: &[&str]) -> Result<usize, Box<Diagnostic>> {
    let at = match &column.kind {
        ColumnWord::Number(number) => Some(*number as usize - 1).filter(|at| *at < header.len()),
        ColumnWord::Named(name) => {
            let mut found = (0..header.len()).filter(|&at| normalized(header[at]) == normalized(name));
            let first = found.next();
            if let (Some(first), Some(second)) = (first, found.next()) {
                return Err(Box::new(errors::column_twice(path, column.span, name, [first, second])));
            }
            first
        }
    };
    at.ok_or_else(|| Box::new(errors::no_column(path, column, header)))
}

/// Returns the numbers of the two columns that a text names.
fn picked(reporter: &mut Reporter<'_>, path: &Name, columns: &[ColumnName; 2], file: FileId) -> Option<Picked> {
    let header = table_file::first_line(reporter.sources.get(file));
    let cells = columns.each_ref().map(|column| match position_of(path, column, &header) {
        Ok(at) => Some(at),
        Err(diagnostic) => {
            reporter.report(*diagnostic);
            None
        }
    });
    let by_name = columns.iter().any(|column| matches!(column.kind, ColumnWord::Named(_)));
    Some(Picked::Two { cells: [cells[0]?, cells[1]?], by_name })
}
