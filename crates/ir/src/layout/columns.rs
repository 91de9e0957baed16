//! The columns of the table for display.

use super::rows::{ColumnContent, holds};
use crate::{ConstraintSystem, Coordinate, Outcome, Owner, Units};

/// A column of the table.
#[derive(Clone, PartialEq, Debug)]
pub struct Column {
    /// Name, such as `crank.phi.d`.
    pub name: String,
    /// Unit of the printed values; rows hold SI values.
    pub unit: ColumnUnit,
    /// Kind of its content.
    pub kind: ColumnKind,
}

/// Unit of the printed values of a column.
#[derive(Clone, PartialEq, Debug)]
pub struct ColumnUnit {
    /// Text, such as `mm/s`; `1` for a pure number.
    pub text: String,
    /// Factors `[a, b, c]` from SI to this unit: `value / a * b / c`.
    scale: [f64; 3],
    /// True if all factors are 1.
    is_si: bool,
}

impl ColumnUnit {
    fn new(text: String, scale: [f64; 3]) -> ColumnUnit {
        let is_si = scale.map(f64::to_bits) == [1.0_f64.to_bits(); 3];
        ColumnUnit { text, scale, is_si }
    }

    fn si(text: impl Into<String>) -> ColumnUnit {
        ColumnUnit::new(text.into(), [1.0; 3])
    }

    /// Creates the unit of a value, or of its time derivative of an order.
    #[must_use]
    pub fn from_units(units: &Units, order: usize) -> ColumnUnit {
        ColumnUnit::new(units.printed[order].clone(), units.scale)
    }

    /// Returns the factors `[a, b, c]` from SI to this unit: `value / a * b / c`.
    #[must_use]
    pub fn scale(&self) -> [f64; 3] {
        self.scale
    }

    /// Returns whether this is the SI unit.
    #[must_use]
    pub fn is_si(&self) -> bool {
        self.is_si
    }

    /// Converts SI values to this unit in place.
    pub fn print_all(&self, values: &mut [f64]) {
        for value in values {
            *value = self.printed(*value);
        }
    }

    /// Converts an SI value to this unit.
    #[must_use]
    pub fn printed(&self, value: f64) -> f64 {
        // skips divisions by 1, which take as long as printing a digit
        if self.is_si { value } else { value / self.scale[0] * self.scale[1] / self.scale[2] }
    }
}

/// Kinds of columns.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ColumnKind {
    /// Time.
    Time,
    /// A coordinate of a body, or its derivative.
    Body,
    /// A coordinate that a joint adds, or its derivative.
    Joint,
    /// An effect of a joint, or an effort of a constraint or driver.
    Reaction,
    /// A measure or trace.
    Measure,
    /// A time derivative of a measure or trace.
    Rate,
    /// A derivative with respect to an input or parameter.
    Variation,
}

/// Suffixes of names and of units, by the order of the time derivative.
const ENDINGS: [(&str, &str); 3] = [("", ""), (".d", "/s"), (".dd", "/s^2")];

/// Returns the columns of the table, in order.
#[must_use]
pub fn columns(system: &ConstraintSystem) -> Vec<Column> {
    holds(system).into_iter().filter_map(|holds| column(system, holds)).collect()
}

/// Returns the column of the table with a content; `None` if the table does not show it.
fn column(system: &ConstraintSystem, holds: ColumnContent) -> Option<Column> {
    Some(match holds {
        ColumnContent::Time => Column { name: "t".to_owned(), unit: ColumnUnit::si("s"), kind: ColumnKind::Time },
        ColumnContent::Coordinate { index, order } => coordinate_column(&system.coordinates()[index], order),
        ColumnContent::Reaction(index) => {
            let of = &system.reactions()[index];
            let unit = ColumnUnit::si(of.unit.clone());
            Column { name: of.name.clone(), unit, kind: ColumnKind::Reaction }
        }
        ColumnContent::Measure { index, order } => {
            let measure = &system.measures()[index];
            let name = measure.name.clone() + ENDINGS[order].0;
            let kind = if order == 0 { ColumnKind::Measure } else { ColumnKind::Rate };
            Column { name, unit: ColumnUnit::from_units(&measure.units, order), kind }
        }
        ColumnContent::DerivativeColumn(index) => {
            let of = &system.derivative_columns()[index];
            let unit = ColumnUnit::new(of.unit.clone(), of.scale);
            Column { name: of.name.clone(), unit, kind: ColumnKind::Variation }
        }
        ColumnContent::Slope { .. } | ColumnContent::Varied | ColumnContent::Multiplier => return None,
    })
}

fn coordinate_column(coordinate: &Coordinate, order: usize) -> Column {
    let (ending, per) = ENDINGS[order];
    let unit = match coordinate.kind.unit() {
        "" => "1",
        unit => unit,
    };
    let kind = match coordinate.owner {
        Owner::Body(_) => ColumnKind::Body,
        Owner::Joint(_) => ColumnKind::Joint,
    };
    Column { name: coordinate.name.clone() + ending, unit: ColumnUnit::si(unit.to_owned() + per), kind }
}

/// Returns the names and units of the results, in order.
#[must_use]
pub fn results(system: &ConstraintSystem) -> Vec<(String, ColumnUnit)> {
    let result = |outcome: &Outcome| (outcome.name.clone(), ColumnUnit::from_units(&outcome.units, 0));
    system.results().outcomes.iter().map(result).collect()
}
