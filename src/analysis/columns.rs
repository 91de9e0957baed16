//! What the columns of a row, and the results, hold: names, units, kinds.

use crate::ir::{ConstraintSystem, Measure, Outcome};

/// The unit that a column is printed in.
#[derive(Clone, PartialEq, Debug)]
pub struct ColumnUnit {
    /// `mm/s`; `1` for a pure number.
    pub text: String,
    /// What SI is divided by, multiplied with and divided by to be in this unit.
    scale: [f64; 3],
}

impl ColumnUnit {
    fn si(text: impl Into<String>) -> ColumnUnit {
        ColumnUnit { text: text.into(), scale: [1.0; 3] }
    }

    /// What SI is divided by, multiplied with and divided by to be in this unit.
    #[must_use]
    pub fn scale(&self) -> [f64; 3] {
        self.scale
    }

    /// A value in SI, in this unit.
    #[must_use]
    pub fn printed(&self, value: f64) -> f64 {
        value / self.scale[0] * self.scale[1] / self.scale[2]
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
    /// What the text measures or traces.
    Measure,
    /// A derivative of that.
    Rate,
    /// A derivative with something else than time.
    Variation,
}

/// What a result's columns hold, in the order of [`columns`].
pub fn kinds(system: &ConstraintSystem) -> Vec<ColumnKind> {
    let mut kinds = vec![ColumnKind::Time];
    let of_bodies = 3 * system.bodies.len();
    for order in 0..3 {
        let kind = |k: usize| if k < of_bodies { ColumnKind::Body } else { ColumnKind::Joint };
        kinds.extend((0..system.coordinates.len()).map(kind));
        let measures = system.measures.iter().filter(|of| of.has(order));
        kinds.extend(measures.map(|_| if order == 0 { ColumnKind::Measure } else { ColumnKind::Rate }));
    }
    kinds.extend(system.appended().iter().map(|_| ColumnKind::Variation));
    kinds
}

/// Units of a result's columns, in the order of [`columns`].
pub fn units(system: &ConstraintSystem) -> Vec<ColumnUnit> {
    let mut units = vec![ColumnUnit::si("s")];
    for (order, per) in ["", "/s", "/s^2"].into_iter().enumerate() {
        let coordinates = system.coordinates.iter().map(|coordinate| match coordinate.kind.unit() {
            "" => "1",
            unit => unit,
        });
        units.extend(coordinates.map(|unit| ColumnUnit::si(unit.to_owned() + per)));
        let measures = system.measures.iter().filter(|of| of.has(order));
        let unit = |of: &Measure| ColumnUnit { text: of.units.printed[order].clone(), scale: of.units.scale };
        units.extend(measures.map(unit));
    }
    units.extend(system.appended().iter().map(|of| ColumnUnit { text: of.unit.clone(), scale: of.scale }));
    units
}

/// Names of the results, and the units in which they are told, in order.
pub fn results(system: &ConstraintSystem) -> Vec<(String, ColumnUnit)> {
    let outcomes = system.results.outcomes.iter();
    let unit = |outcome: &Outcome| ColumnUnit { text: outcome.units.printed[0].clone(), scale: outcome.units.scale };
    outcomes.map(|outcome| (outcome.name.clone(), unit(outcome))).collect()
}

/// Names of a result's columns, in order.
pub fn columns(system: &ConstraintSystem) -> Vec<String> {
    let coordinates = || system.coordinates.iter().map(|coordinate| coordinate.name.clone());
    let mut columns = vec!["t".to_owned()];
    columns.extend(coordinates());
    columns.extend(system.measures.iter().map(|measure| measure.name.clone()));
    columns.extend(coordinates().map(|name| name + ".d"));
    columns.extend(system.measures.iter().filter(|m| m.first.is_some()).map(|m| format!("{}.d", m.name)));
    columns.extend(coordinates().map(|name| name + ".dd"));
    columns.extend(system.measures.iter().filter(|m| m.second.is_some()).map(|m| format!("{}.dd", m.name)));
    columns.extend(system.appended().iter().map(|column| column.name.clone()));
    columns
}
