//! Monitor of distances that a joint needs to stay what they are at the start, and does not hold: those of a belt's pulleys.

use crate::analysis::explain::{Warning, WarningCause};
use crate::analysis::follow::warnings::Warnings;
use crate::analysis::state::State;
use crate::limits::assembly::AGREES;
use mechc_expr::ExprId;
use mechc_ir::ConstraintSystem;
use mechc_ir::layout::RowLayout;
use mechc_ir::program::{Program, Register, Registers, Stage};

/// A distance that must not change.
struct Spacing {
    /// Index of the fit.
    index: usize,
    register: Register,
    at_start: f64,
    /// Largest change that is rounding (m).
    least: f64,
    /// The time of the row with the largest change (s), and the distance there (m).
    farthest: Option<[f64; 2]>,
    is_reported: bool,
}

/// Checks the distances in rows.
pub struct SpacingMonitor {
    program: Program,
    registers: Registers,
    spacings: Vec<Spacing>,
    /// Columns of the coordinates in a row.
    first: usize,
    count: usize,
}

impl SpacingMonitor {
    /// Returns the monitor of the distances from a state on; `None` without any.
    pub fn new(system: &ConstraintSystem, state: &State) -> Option<SpacingMonitor> {
        let fits = system.fits().iter().enumerate().filter(|(_, fit)| fit.wanted.is_none());
        let (indices, formulas): (Vec<usize>, Vec<ExprId>) = fits.map(|(index, fit)| (index, fit.distance)).unzip();
        if indices.is_empty() {
            return None;
        }
        let count = system.coordinates().len();
        let counts = [system.params().len(), count, 0, system.rows().len()];
        let (program, registers) = Program::of_formulas(system.graph(), counts, &formulas);
        let spacings = indices.into_iter().zip(registers).map(|(index, register)| {
            let fit = &system.fits()[index];
            let [at_start, radius] = [fit.distance, fit.radius].map(|id| system.value_at(id, &state.q));
            Spacing { index, register, at_start, least: AGREES * radius, farthest: None, is_reported: false }
        });
        let (spacings, first) = (spacings.collect(), RowLayout::new(system).coordinates[0] as usize);
        Some(SpacingMonitor { registers: program.start(&system.param_values()), program, spacings, first, count })
    }

    /// Checks a row.
    pub fn look(&mut self, row: &[f64]) {
        self.registers.set_all(self.program.inputs.coordinates[0], &row[self.first..self.first + self.count]);
        self.program.run(Stage::Measures, &mut self.registers);
        for spacing in &mut self.spacings {
            let distance = self.registers.get(spacing.register);
            let before = spacing.farthest.map_or(spacing.least, |[_, before]| (before - spacing.at_start).abs());
            if (distance - spacing.at_start).abs() > before {
                spacing.farthest = Some([row[0], distance]);
            }
        }
    }

    /// Warns of each distance that has changed, once.
    pub fn report(&mut self, warnings: &mut Warnings) {
        for spacing in self.spacings.iter_mut().filter(|spacing| !spacing.is_reported) {
            if let Some([t, distance]) = spacing.farthest {
                spacing.is_reported = true;
                let cause = WarningCause::SpacingChanges { index: spacing.index, distance, at_start: spacing.at_start };
                warnings.push(Warning { t, cause });
            }
        }
    }
}
