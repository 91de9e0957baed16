//! Signals on the paths of variants: terms of the equations that depend on the fraction of a path alone, and not linearly. Between the ends of a
//! part of the path they must not do more than these show.

use super::acceptance::Rejections;
use super::lane_program::LaneProgram;
use super::lane_signals::LaneSignals;
use super::{LANES, PerLane};
use crate::sweep::continuation::ContinuationBase;
use mechc_expr::math::Vectors;
use mechc_ir::program::LaneValues;

/// The equations on the paths of a batch, in which the fraction of the path stands for time, and their signals.
#[derive(Clone)]
pub(super) struct PathSignals {
    program: LaneProgram,
    registers: Vec<PerLane>,
    signals: LaneSignals,
    /// All parameters: the nominal ones, then where those that the path changes end, then first and last time if it changes the time.
    params: Vec<PerLane>,
    /// The number of nominal parameters, and the indices of those that the path changes.
    nominal_count: usize,
    continued: Vec<u32>,
}

impl PathSignals {
    /// Returns the signals on paths to the first time `t` (s); `None` if there are none.
    pub fn new(base: &ContinuationBase, t: f64, vectors: Vectors) -> Option<PathSignals> {
        let (system, bounds) = (base.compiled_path(), base.signals_on_path()?);
        let signals = LaneSignals::new(&system.program, bounds, vectors)?;
        let (_, nominal) = base.nominal();
        let params = base.path_params(nominal, t);
        let program = LaneProgram::new(&system.program, &params, signals.operands());
        Some(PathSignals {
            registers: program.new_registers(),
            program,
            signals,
            params: params.iter().map(|&value| LaneValues([value; LANES])).collect(),
            nominal_count: nominal.len(),
            continued: base.continued_params().to_vec(),
        })
    }

    /// Evaluates the signals at the beginning of the paths to parameters (SI), in the leading `chunks`.
    pub fn begin(&mut self, targets: &[PerLane], chunks: usize) {
        for (end, &param) in self.params[self.nominal_count..].iter_mut().zip(&self.continued) {
            *end = targets[param as usize];
        }
        self.program.load(&mut self.registers, &self.params, chunks);
        self.signals.begin(&self.registers, chunks, 0.0);
    }

    /// Rejects the lanes in which a signal may leave the values at the ends of a part, given by its fractions of the path; the next part begins
    /// where it ends.
    pub fn check_part(&mut self, chunks: usize, fractions: [f64; 2], rejections: &mut Rejections) {
        self.signals.check(chunks, fractions, rejections);
        self.signals.commit();
    }
}
