//! Bounds of loads between two states.
//!
//! Forces are available only as values at solved states. Their inertial part is as smooth as the motion, but a load is an arbitrary formula, which
//! may have a short pulse between two states. The range of its formula bounds it there.

use mechc_ir::program::{Program, Range, Ranges, Register, Registers};

/// A smooth load may exceed its predicted range between two states by this part of the largest value so far.
const SEEN: f64 = 0.25;
/// Margin for a load of which only its bounds are known, as a part of the largest value so far.
const LITTLE: f64 = 1e-12;
/// Rounding of a load between states, in multiples of its rounding at states.
const ROUNDINGS: f64 = 4.0;

/// A bound of the deviation of loads in a cell from the values at its ends and in its middle.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Hidden {
    /// No load exceeds its bounds noticeably.
    Nothing,
    /// A load may exceed its bounds by this much.
    AtMost(f64),
    /// A load has no bound.
    Unbounded,
}

/// All loads of a mechanism; their ranges are those of the formulas 1, 2, … in [`Ranges`].
pub(super) struct Loads {
    each: Vec<Load>,
}

struct Load {
    value: Register,
    /// The largest magnitude so far.
    largest: f64,
    /// The largest effect of rounding so far.
    rounding: f64,
}

impl Loads {
    /// Returns the loads whose values a program leaves in some registers.
    pub fn new(values: &[Register]) -> Loads {
        let load = |&value: &Register| Load { value, largest: 0.0, rounding: 0.0 };
        Loads { each: values.iter().map(load).collect() }
    }

    /// Returns the number of loads.
    pub fn count(&self) -> usize {
        self.each.len()
    }

    /// Returns the values of all loads from the registers of a program that has been run, and records their magnitudes.
    pub fn values(&mut self, registers: &Registers) -> Vec<f64> {
        let value = |load: &mut Load| {
            let value = registers.get(load.value);
            load.largest = load.largest.max(value.abs());
            value
        };
        self.each.iter_mut().map(value).collect()
    }

    /// Records the effect of rounding on the loads at the state that the ranges were set to.
    pub fn record_rounding(&mut self, program: &Program, registers: &Registers, ranges: &mut Ranges) {
        for (k, load) in self.each.iter_mut().enumerate() {
            let range = ranges.range(program, registers, 1 + k);
            let width = range.high - range.low;
            load.rounding = load.rounding.max(if range.is_resolved && width.is_finite() { width } else { 0.0 });
        }
    }

    /// Returns how far loads may exceed `bounds`, the expected interval of each.
    pub fn hidden(
        &mut self,
        program: &Program,
        registers: &Registers,
        ranges: &mut Ranges,
        bounds: impl Fn(usize) -> [f64; 2],
    ) -> Hidden {
        let mut hidden = Hidden::Nothing;
        for (k, load) in self.each.iter().enumerate() {
            let range = ranges.range(program, registers, 1 + k);
            let beyond = beyond(range, bounds(k));
            if !beyond.is_finite() {
                return Hidden::Unbounded;
            }
            let most = if range.is_resolved { SEEN } else { LITTLE };
            if beyond > f64::max(most * load.largest, ROUNDINGS * load.rounding) {
                let so_far = if let Hidden::AtMost(most) = hidden { most } else { 0.0 };
                hidden = Hidden::AtMost(beyond.max(so_far));
            }
        }
        hidden
    }
}

/// Returns how far a range exceeds an interval; infinite if the range is unbounded.
fn beyond(range: Range, [low, high]: [f64; 2]) -> f64 {
    let [below, above] = [low - range.low, range.high - high];
    // the sum is finite only if both terms are
    if (below + above).is_finite() { below.max(above).max(0.0) } else { f64::INFINITY }
}
