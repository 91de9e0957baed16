//! The columns of the table, as they are shown.

use super::rows::{Holds, holds};
use crate::{ConstraintSystem, Coordinate, Outcome, Owner, Units};

/// A column of the table.
#[derive(Clone, PartialEq, Debug)]
pub struct Column {
    /// `crank.phi.d`
    pub name: String,
    /// The unit that it is printed in; rows are in SI.
    pub unit: ColumnUnit,
    /// What it holds.
    pub kind: ColumnKind,
}

/// The unit that a column is printed in.
#[derive(Clone, PartialEq, Debug)]
pub struct ColumnUnit {
    /// `mm/s`; `1` for a pure number.
    pub text: String,
    /// What SI is divided by, multiplied with and divided by to be in this unit.
    scale: [f64; 3],
    /// Whether that changes nothing.
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

    /// That of a value, or of its time derivative of some order.
    fn of(units: &Units, order: usize) -> ColumnUnit {
        ColumnUnit::new(units.printed[order].clone(), units.scale)
    }

    /// What SI is divided by, multiplied with and divided by to be in this unit.
    #[must_use]
    pub fn scale(&self) -> [f64; 3] {
        self.scale
    }

    /// Whether it is that of SI.
    #[must_use]
    pub fn is_si(&self) -> bool {
        self.is_si
    }

    /// Values in SI, in this unit from then on.
    pub fn print_all(&self, values: &mut [f64]) {
        for value in values {
            *value = self.printed(*value);
        }
    }

    /// A value in SI, in this unit.
    #[must_use]
    pub fn printed(&self, value: f64) -> f64 {
        // one is divided by and multiplied with in vain, which takes as long as a digit
        if self.is_si { value } else { value / self.scale[0] * self.scale[1] / self.scale[2] }
    }
}

/// What a column holds.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ColumnKind {
    /// Time.
    Time,
    /// A coordinate of a body, or its derivative.
    Body,
    /// A coordinate that a joint brings along, or its derivative.
    Joint,
    /// What a joint exerts, or a constraint or driver supplies.
    Reaction,
    /// What the text measures or traces.
    Measure,
    /// A derivative of that.
    Rate,
    /// A derivative with something else than time.
    Variation,
}

/// What stands behind a name, by how often it is differentiated by time; and behind a unit.
const ENDINGS: [(&str, &str); 3] = [("", ""), (".d", "/s"), (".dd", "/s^2")];

/// The columns of the table, in order.
#[must_use]
pub fn columns(system: &ConstraintSystem) -> Vec<Column> {
    holds(system).into_iter().filter_map(|holds| column(system, holds)).collect()
}

/// The column of the table that holds something; none where that is not of the table.
fn column(system: &ConstraintSystem, holds: Holds) -> Option<Column> {
    Some(match holds {
        Holds::Time => Column { name: "t".to_owned(), unit: ColumnUnit::si("s"), kind: ColumnKind::Time },
        Holds::Coordinate { index, order } => of_coordinate(&system.coordinates()[index], order),
        Holds::Reaction(index) => {
            let of = &system.reactions()[index];
            let unit = ColumnUnit::si(of.unit.clone());
            Column { name: of.name.clone(), unit, kind: ColumnKind::Reaction }
        }
        Holds::Measure { index, order } => {
            let measure = &system.measures()[index];
            let name = measure.name.clone() + ENDINGS[order].0;
            let kind = if order == 0 { ColumnKind::Measure } else { ColumnKind::Rate };
            Column { name, unit: ColumnUnit::of(&measure.units, order), kind }
        }
        Holds::Appended(index) => {
            let of = &system.appended()[index];
            let unit = ColumnUnit::new(of.unit.clone(), of.scale);
            Column { name: of.name.clone(), unit, kind: ColumnKind::Variation }
        }
        Holds::Slope { .. } | Holds::Varied | Holds::Multiplier => return None,
    })
}

fn of_coordinate(coordinate: &Coordinate, order: usize) -> Column {
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

/// Names of the results, and the units in which they are told, in order.
#[must_use]
pub fn results(system: &ConstraintSystem) -> Vec<(String, ColumnUnit)> {
    let result = |outcome: &Outcome| (outcome.name.clone(), ColumnUnit::of(&outcome.units, 0));
    system.results().outcomes.iter().map(result).collect()
}
