//! Equations along a homotopy, whose parameter from 0 to 1 takes the place of time.

use super::{ConstraintSystem, Written};
use mechc_expr::Symbol;

/// A change of the equations along a straight line, with parameter `s` from 0 to 1.
#[derive(Clone, PartialEq, Debug)]
pub enum Homotopy {
    /// Time is constant, and the residuals of some rows change linearly: `Φ(q, t) = from + (to − from) s`.
    Residuals {
        /// The constant time (s).
        t: f64,
        /// Rows of `Φ`, each with its residuals at `s = 0` and `s = 1`.
        lines: Vec<(usize, [f64; 2])>,
    },
    /// Time changes from one value to another (s).
    Time([f64; 2]),
}

impl ConstraintSystem {
    /// Returns the equations along a homotopy, without measures, results and forces.
    #[must_use]
    pub fn along(&self, homotopy: &Homotopy) -> ConstraintSystem {
        let mut written = Written {
            name: self.name.clone(),
            span: self.span,
            graph: self.graph.clone(),
            params: self.params.clone(),
            has_signals: false,
            bodies: self.bodies.clone(),
            points: self.points.clone(),
            coordinates: self.coordinates.clone(),
            declarations: self.declarations.clone(),
            rows: self.rows.clone(),
            forces: None,
            variations: None,
            measures: Vec::new(),
            conditions: self.conditions.clone(),
            watches: self.watches.clone(),
            open_contacts: Vec::new(),
            fits: self.fits.clone(),
            parts: Vec::new(),
            parts_with_derivatives: Vec::new(),
            length: self.length,
            analysis: None,
        };
        let graph = &mut written.graph;
        let s = graph.symbol(Symbol::Time);
        let time = match homotopy {
            Homotopy::Residuals { t, .. } => graph.constant(*t),
            Homotopy::Time(ends) => {
                let ends = ends.map(|t| graph.constant(t));
                graph.line(ends, s)
            }
        };
        written.substitute(|graph, symbol| match symbol {
            Symbol::Time => time,
            other => graph.symbol(other),
        });
        if let Homotopy::Residuals { lines, .. } = homotopy {
            let graph = &mut written.graph;
            for &(row, ends) in lines {
                let ends = ends.map(|value| graph.constant(value));
                let left = graph.line(ends, s);
                let phi = &mut written.rows[row].phi;
                *phi = graph.sub(*phi, left);
            }
        }
        let mut system = ConstraintSystem::of(written, false);
        (system.axes, system.circles) = (self.axes.clone(), self.circles.clone());
        debug_assert_eq!(system.validate(), Ok(()));
        system
    }
}
