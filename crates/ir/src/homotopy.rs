//! Equations along a homotopy: its parameter, which goes from 0 to 1, stands in the place of time.

use super::{ConstraintSystem, Written};
use mechc_expr::Symbol;

/// What a homotopy changes along a straight line, `s` being its parameter.
#[derive(Clone, PartialEq, Debug)]
pub enum Homotopy {
    /// Time stands still, and the residuals of some rows go from one value to another: `Φ(q, t) = from + (to − from) s`.
    Residuals {
        /// That time (s).
        t: f64,
        /// Rows of `Φ`, each with its residual at both ends.
        lines: Vec<(usize, [f64; 2])>,
    },
    /// Time goes from one time to another (s).
    Time([f64; 2]),
}

impl ConstraintSystem {
    /// The equations along a homotopy, without what is asked of the motion: measures, results, forces.
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
            asking_parts: Vec::new(),
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
