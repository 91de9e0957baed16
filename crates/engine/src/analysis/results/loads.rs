//! What loads may do between two states.
//!
//! Of forces only values are known, and those only at states that were solved for. What inertia makes of them goes as smoothly as the motion,
//! but a load is any formula: between two states it may strike and be gone again. What it can be there is what its formula can be.

use mechc_ir::program::{Program, Range, Ranges, Register, Registers};

/// A smooth load may exceed its predicted range between two states by this part of the largest value so far.
const SEEN: f64 = 0.25;
/// Margin for a load of which only its bounds are known, as a part of the largest value so far.
const LITTLE: f64 = 1e-12;
/// Rounding of a load between states, in multiples of its rounding at states.
const ROUNDINGS: f64 = 4.0;

/// A bound of what loads do in a cell beyond what its ends and its middle show.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Hidden {
    Nothing,
    /// A load may exceed its bounds by this much.
    AtMost(f64),
    /// A load has no bound.
    Unbounded,
}

/// All loads of a mechanism. Their ranges are those of the formulas 1, 2, … of a [`Ranges`].
pub(super) struct Loads {
    each: Vec<Load>,
}

struct Load {
    value: Register,
    /// The largest magnitude that was seen.
    largest: f64,
    /// The largest effect of rounding that was seen.
    rounding: f64,
}

impl Loads {
    /// Loads whose values a program leaves in some registers.
    pub fn new(values: &[Register]) -> Loads {
        let load = |&value: &Register| Load { value, largest: 0.0, rounding: 0.0 };
        Loads { each: values.iter().map(load).collect() }
    }

    /// Returns the number of loads.
    pub fn count(&self) -> usize {
        self.each.len()
    }

    /// Returns their values at a state that the program has just been run at.
    pub fn values(&mut self, registers: &Registers) -> Vec<f64> {
        let value = |load: &mut Load| {
            let value = registers.get(load.value);
            load.largest = load.largest.max(value.abs());
            value
        };
        self.each.iter_mut().map(value).collect()
    }

    /// Records what rounding makes of them at a state that ranges were set to.
    pub fn look_at_rounding(&mut self, (program, registers): (&Program, &Registers), ranges: &mut Ranges) {
        for (k, load) in self.each.iter_mut().enumerate() {
            let range = ranges.range(program, registers, 1 + k);
            let width = range.high - range.low;
            load.rounding = load.rounding.max(if range.is_resolved && width.is_finite() { width } else { 0.0 });
        }
    }

    /// Returns how far loads may go beyond `bounds`, the interval in which each seems to stay.
    pub fn hidden(
        &mut self,
        (program, registers): (&Program, &Registers),
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

/// Returns how far a range goes beyond an interval; infinite if the range has no end.
fn beyond(range: Range, [low, high]: [f64; 2]) -> f64 {
    let [below, above] = [low - range.low, range.high - high];
    // what is infinite or no number on one side is so in the sum
    if (below + above).is_finite() { below.max(above).max(0.0) } else { f64::INFINITY }
}
