//! Signals: what the equations of a position take from time alone, as the right side of a driver.

use super::{Op, Program, Register, Stage};
use crate::tolerances::steps::signals_in_a_row::MOST_IN_A_ROW;

/// A value that time alone decides, and the equations it enters.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Signal {
    /// Where it stands.
    pub register: Register,
    /// Rows of `Φ`.
    pub rows: Vec<usize>,
    /// Equations that were left out, and are checked.
    pub checks: Vec<usize>,
}

impl Program {
    /// The signals that are more than a straight line over time.
    #[must_use]
    pub fn signals(&self) -> Vec<Signal> {
        let is_bent = self.bent();
        let mut signals: Vec<Signal> = Vec::new();
        let mut signal_of: Vec<Option<usize>> = vec![None; self.registers()];
        // by register of the position: the signals behind it
        let mut behind: Vec<Vec<usize>> = vec![Vec::new(); self.registers()];
        for &op in self.stage(Stage::Position) {
            let mut found: Vec<usize> = Vec::new();
            for register in self.reads(op) {
                if is_bent[register as usize] {
                    let index = *signal_of[register as usize].get_or_insert_with(|| {
                        signals.push(Signal { register, rows: Vec::new(), checks: Vec::new() });
                        signals.len() - 1
                    });
                    found.push(index);
                }
                found.extend_from_slice(&behind[register as usize]);
            }
            found.sort_unstable();
            found.dedup();
            found.truncate(MOST_IN_A_ROW);
            for register in op.writes() {
                behind[register as usize].clone_from(&found);
            }
        }
        for (row, &phi) in self.outputs.phi.iter().enumerate() {
            behind[phi as usize].iter().for_each(|&index| signals[index].rows.push(row));
        }
        for (check, &phi) in self.outputs.checks.iter().enumerate() {
            behind[phi as usize].iter().for_each(|&index| signals[index].checks.push(check));
        }
        signals.retain(|signal| !signal.rows.is_empty() || !signal.checks.is_empty());
        signals
    }

    /// Which registers depend on time alone, and not as a straight line.
    fn bent(&self) -> Vec<bool> {
        const STRAIGHT: u32 = 1;
        // the degree in time
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
        degree.iter().map(|&degree| degree > STRAIGHT).collect()
    }
}
