//! Signals in lanes: whether what time alone decides keeps within its values at the ends of a step.

use super::acceptance::Rejections;
use super::{LANES, PerLane, ZERO};
use crate::analysis::SignalBounds;
use mechc_ir::program::{Enclosure, Program, Register, Registers};

/// The signals that a batch checks, and what they are computed from.
pub(super) struct BatchSignals {
    bounds: SignalBounds,
    /// The registers that lanes load, each of which depends on parameters alone.
    pub operands: Vec<Register>,
}

impl BatchSignals {
    /// Returns the signals of a mechanism; `None` if it has none.
    pub fn new(program: &Program, bounds: SignalBounds) -> Option<BatchSignals> {
        if bounds.all.is_empty() {
            return None;
        }
        let mut operands = bounds.enclosure.operands(program);
        operands.sort_unstable();
        operands.dedup();
        Some(BatchSignals { bounds, operands })
    }
}

/// The values of signals at both ends of a step, by signal.
pub(super) struct LaneSignals {
    enclosure: Enclosure,
    /// True if the signals of all active lanes are equal, so that those of the first one serve all.
    are_common: bool,
    ends: [Vec<PerLane>; 2],
}

impl LaneSignals {
    /// Creates memory for the signals of a batch.
    pub fn new(signals: &BatchSignals) -> LaneSignals {
        let count = signals.bounds.all.len();
        LaneSignals {
            enclosure: signals.bounds.enclosure.clone(),
            are_common: false,
            ends: [vec![ZERO; count], vec![ZERO; count]],
        }
    }

    /// Evaluates the signals of the active lanes at the first time `t` (s). `registers` are those of the program, by lane.
    pub fn begin(
        &mut self,
        (program, scalars): (&Program, &Registers),
        signals: &BatchSignals,
        registers: &[PerLane],
        active: &[bool; LANES],
        t: f64,
    ) {
        let Some(first) = active.iter().position(|&is_active| is_active) else { return };
        let is_common = |&register: &Register| {
            let values = &registers[register as usize].0;
            (0..LANES).filter(|&lane| active[lane]).all(|lane| values[lane].to_bits() == values[first].to_bits())
        };
        self.are_common = signals.operands.iter().all(is_common);
        for lane in self.lanes(active) {
            let slot = self.slot(lane);
            self.load(signals, registers, lane);
            self.enclosure.enclose(program, scalars, [t; 2]);
            for (index, signal) in signals.bounds.all.iter().enumerate() {
                self.ends[0][index].0[slot] = middle(self.enclosure.range(signal.register));
            }
        }
    }

    /// Rejects the active lanes in which a signal may leave its values at the times `from` and `to` (s).
    pub fn check(
        &mut self,
        (program, scalars): (&Program, &Registers),
        signals: &BatchSignals,
        registers: &[PerLane],
        active: &[bool; LANES],
        [from, to]: [f64; 2],
        rejections: &mut Rejections,
    ) {
        for lane in self.lanes(active) {
            let slot = self.slot(lane);
            self.load(signals, registers, lane);
            self.enclosure.enclose(program, scalars, [to; 2]);
            for (index, signal) in signals.bounds.all.iter().enumerate() {
                self.ends[1][index].0[slot] = middle(self.enclosure.range(signal.register));
            }
            self.enclosure.enclose(program, scalars, [from, to]);
            let leaves = |index: usize| {
                let range = self.enclosure.range(signals.bounds.all[index].register);
                signals.bounds.may_leave_ends(index, range, [0, 1].map(|end| self.ends[end][index].0[slot]))
            };
            if (0..signals.bounds.all.len()).any(leaves) {
                let rejected = if self.are_common { 0..LANES } else { lane..lane + 1 };
                rejections.0.0[rejected].iter_mut().for_each(|count| *count += 1.0);
            }
        }
    }

    /// Makes the last end of a step the first one of the next.
    pub fn commit(&mut self) {
        self.ends.swap(0, 1);
    }

    /// Returns the active lanes whose signals are evaluated.
    fn lanes(&self, active: &[bool; LANES]) -> impl Iterator<Item = usize> + use<> {
        let (active, count) = (*active, if self.are_common { 1 } else { LANES });
        (0..LANES).filter(move |&lane| active[lane]).take(count)
    }

    /// Returns where the values of a lane are kept: those that all lanes share stand first, whichever lanes are active.
    fn slot(&self, lane: usize) -> usize {
        if self.are_common { 0 } else { lane }
    }

    fn load(&mut self, signals: &BatchSignals, registers: &[PerLane], lane: usize) {
        for &register in &signals.operands {
            self.enclosure.set_all(register, &[[registers[register as usize].0[lane], 0.0]]);
        }
    }
}

fn middle([low, high]: [f64; 2]) -> f64 {
    0.5 * (low + high)
}
