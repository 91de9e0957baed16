//! What loads may do between two states of which all is known.
//!
//! Of forces only values are known, and those only at states that were solved for. What inertia makes of them goes as smoothly as the motion,
//! but a load is any formula: between two states it may strike and be gone again. What it can be there is what its formula can be.

use crate::program::{Program, Range, Ranges, Register, Registers, Stage};
use crate::tolerances::results::loads::{LITTLE, ROUNDINGS, SEEN};

/// What loads may do in a cell that its ends and its middle do not tell.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Hidden {
    Nothing,
    Something,
    /// A load may be as large as it likes.
    Anything,
}

/// All loads of a mechanism.
pub(super) struct Loads {
    each: Vec<Load>,
}

struct Load {
    value: Register,
    ranges: Ranges,
    /// The largest magnitude that was seen.
    largest: f64,
    /// How far rounding may be off, the most that was seen.
    rounding: f64,
}

impl Loads {
    /// Of a program that leaves their values in some registers; its prologue must have been run.
    pub fn new(program: &Program, registers: &Registers, values: &[Register]) -> Loads {
        let load = |&value: &Register| {
            let ranges = Ranges::new(program, registers, &[value], Stage::Measures, false);
            Load { value, ranges, largest: 0.0, rounding: 0.0 }
        };
        Loads { each: values.iter().map(load).collect() }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.each.len()
    }

    /// Their values at a state that the program has just been run at, and that time and all that they hold were set to.
    pub fn values(&mut self, program: &Program, registers: &Registers) -> Vec<f64> {
        let value = |load: &mut Load| {
            let (value, range) = (registers.get(load.value), load.ranges.range(program, registers, 0));
            load.largest = load.largest.max(value.abs());
            let width = range.high - range.low;
            load.rounding = load.rounding.max(if range.is_resolved && width.is_finite() { width } else { 0.0 });
            value
        };
        self.each.iter_mut().map(value).collect()
    }

    /// Lets time be anywhere between two times (s).
    pub fn set_times(&mut self, times: [f64; 2]) {
        self.each.iter_mut().for_each(|load| load.ranges.set_times(times));
    }

    /// Lets what they hold be anywhere between two values.
    pub fn set(&mut self, register: Register, range: [f64; 2]) {
        self.each.iter_mut().for_each(|load| load.ranges.set(register, range));
    }

    /// What they may do beyond what is told of each: between which values it seems to stay.
    pub fn hidden(&mut self, program: &Program, registers: &Registers, told: impl Fn(usize) -> [f64; 2]) -> Hidden {
        let mut hidden = Hidden::Nothing;
        for (k, load) in self.each.iter_mut().enumerate() {
            let range = load.ranges.range(program, registers, 0);
            let beyond = beyond(range, told(k));
            if !beyond.is_finite() {
                return Hidden::Anything;
            }
            let is_smooth = range.is_resolved && !range.crosses_knots;
            let most = if is_smooth { SEEN } else { LITTLE };
            if beyond > f64::max(most * load.largest, ROUNDINGS * load.rounding) {
                hidden = Hidden::Something;
            }
        }
        hidden
    }
}

/// How far a range goes beyond what is told; no number or infinite where it has no end.
fn beyond(range: Range, [low, high]: [f64; 2]) -> f64 {
    let [below, above] = [low - range.low, range.high - high];
    // what is infinite or no number on one side is so in the sum
    if (below + above).is_finite() { below.max(above).max(0.0) } else { f64::INFINITY }
}
