//! Signals in lanes: whether what time alone decides keeps within its values at the ends of a step.

// loops over lane indices read best, and vectorise best
#![allow(clippy::needless_range_loop)]

use super::acceptance::Rejections;
use super::{CHUNK, LANES, PerLane, ZERO};
use crate::analysis::SignalBounds;
use mechc_expr::math::Vectors;
use mechc_ir::program::{LaneEnclosure, Program};

/// The signals of a batch, with their values at both ends of a step, and conditions that time alone decides.
#[derive(Clone)]
pub(super) struct LaneSignals {
    bounds: SignalBounds,
    enclosure: LaneEnclosure<LANES>,
    ends: [Vec<PerLane>; 2],
    vectors: Vectors,
}

impl LaneSignals {
    /// Returns the signals and conditions of a mechanism; `None` if it has none.
    pub fn new(program: &Program, bounds: &SignalBounds, vectors: Vectors) -> Option<LaneSignals> {
        let count = bounds.all.len();
        let ends = [vec![ZERO; count], vec![ZERO; count]];
        let has_any = count > 0 || !bounds.conditions.is_empty();
        let enclosure = LaneEnclosure::of(&bounds.enclosure, program);
        has_any.then(|| LaneSignals { bounds: bounds.clone(), enclosure, ends, vectors })
    }

    /// Returns the registers of the program that they are computed from, which depend on parameters alone.
    pub fn operands(&self) -> &[u32] {
        self.enclosure.operands()
    }

    /// Evaluates the signals at the first time `t` (s), in the leading `chunks`. `registers` are those of the program.
    pub fn begin(&mut self, registers: &[PerLane], chunks: usize, t: f64) {
        self.enclosure.load(registers);
        self.evaluate(0, chunks, t);
    }

    /// Rejects the lanes of the leading `chunks` in which a signal may leave its values at both times (s), or a condition fail between them.
    pub fn check(&mut self, chunks: usize, times: [f64; 2], rejections: &mut Rejections) {
        self.evaluate(1, chunks, times[1]);
        let LaneSignals { bounds, enclosure, ends: [before, after], vectors } = self;
        vectors.run(
            #[inline(always)]
            || {
                enclosure.enclose::<CHUNK>(chunks, times);
                let ends = before.iter().zip(&*after);
                for ((signal, &bound), (before, after)) in bounds.all.iter().zip(bounds.bounds()).zip(ends) {
                    let range = enclosure.range(signal.register);
                    for chunk in 0..chunks {
                        let [low, high] = range.each_ref().map(|end| *end.part::<CHUNK>(chunk));
                        let [a, b] = [before, after].map(|end| *end.part::<CHUNK>(chunk));
                        let counts = rejections.0.part_mut::<CHUNK>(chunk);
                        for k in 0..CHUNK {
                            let (least, most) = if a[k] < b[k] { (a[k], b[k]) } else { (b[k], a[k]) };
                            let (is_below, is_above) = (high[k] - most <= bound, least - low[k] <= bound);
                            counts[k] += if is_below & is_above { 0.0 } else { 1.0 };
                        }
                    }
                }
                for &condition in &bounds.conditions {
                    let [low, _] = enclosure.range(condition);
                    for (count, &low) in rejections.0.0.iter_mut().zip(&low.0).take(chunks * CHUNK) {
                        *count += if low > 0.0 { 0.0 } else { 1.0 };
                    }
                }
            },
        );
    }

    /// Makes the last end of a step the first one of the next.
    pub fn commit(&mut self) {
        self.ends.swap(0, 1);
    }

    /// Evaluates the signals at a time (s), for an end of a step.
    fn evaluate(&mut self, end: usize, chunks: usize, t: f64) {
        let LaneSignals { bounds, enclosure, ends, vectors } = self;
        vectors.run(
            #[inline(always)]
            || {
                enclosure.enclose::<CHUNK>(chunks, [t; 2]);
                for (value, signal) in ends[end].iter_mut().zip(&bounds.all) {
                    *value = enclosure.range(signal.register)[0];
                }
            },
        );
    }
}
