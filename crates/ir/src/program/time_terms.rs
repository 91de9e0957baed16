//! Time-dependent terms of the position equations, such as the right side of a driver.

use super::{Op, Program, Register, Stage};

/// Maximum number of time-dependent terms that are tracked per equation.
const MOST_PER_ROW: usize = 8;

/// A value that depends on time alone, with the equations that contain it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Signal {
    /// Register of the value.
    pub register: Register,
    /// Rows of `Φ`.
    pub rows: Vec<usize>,
    /// Indices of left-out equations, which are checked.
    pub checks: Vec<usize>,
}

impl Program {
    /// Returns the time-dependent values of the equations that are not linear in time.
    #[must_use]
    pub fn signals(&self) -> Vec<Signal> {
        let is_nonlinear = self.nonlinear_in_time();
        let mut signals: Vec<Signal> = Vec::new();
        let mut signal_of: Vec<Option<usize>> = vec![None; self.registers()];
        // by register of the position stage: the signals that it depends on
        let mut signals_behind: Vec<Vec<usize>> = vec![Vec::new(); self.registers()];
        for &op in self.stage(Stage::Position) {
            let mut indices: Vec<usize> = Vec::new();
            for register in self.reads(op) {
                if is_nonlinear[register as usize] {
                    let index = *signal_of[register as usize].get_or_insert_with(|| {
                        signals.push(Signal { register, rows: Vec::new(), checks: Vec::new() });
                        signals.len() - 1
                    });
                    indices.push(index);
                }
                indices.extend_from_slice(&signals_behind[register as usize]);
            }
            indices.sort_unstable();
            indices.dedup();
            indices.truncate(MOST_PER_ROW);
            for register in op.writes() {
                signals_behind[register as usize].clone_from(&indices);
            }
        }
        for (row, &phi) in self.outputs.phi.iter().enumerate() {
            signals_behind[phi as usize].iter().for_each(|&index| signals[index].rows.push(row));
        }
        for (check, &phi) in self.outputs.checks.iter().enumerate() {
            signals_behind[phi as usize].iter().for_each(|&index| signals[index].checks.push(check));
        }
        signals.retain(|signal| !signal.rows.is_empty() || !signal.checks.is_empty());
        signals
    }

    /// Returns for each register whether it depends on time alone, and not linearly.
    fn nonlinear_in_time(&self) -> Vec<bool> {
        const LINEAR: u32 = 1;
        // polynomial degree in time; `u32::MAX` for no polynomial
        let mut degree: Vec<u32> = vec![0; self.registers()];
        degree[self.inputs.time as usize] = 1;
        for &op in self.stage(Stage::Time) {
            let of = |register: Register| degree[register as usize];
            let highest = self.reads(op).map(of).max().unwrap_or(0);
            let result = match op {
                Op::Add { .. } | Op::Sub { .. } | Op::Neg { .. } | Op::Copy { .. } => highest,
                Op::Mul { a, b, .. } => of(a).saturating_add(of(b)),
                Op::Div { a, b, .. } if of(b) == 0 => of(a),
                _ if highest == 0 => 0,
                _ => u32::MAX,
            };
            for register in op.writes() {
                degree[register as usize] = result;
            }
        }
        degree.iter().map(|&degree| degree > LINEAR).collect()
    }
}
