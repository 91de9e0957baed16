//! Interval evaluation in lanes: encloses registers over a stretch of time for several variants at once. Rounding is ignored, unlike in
//! `interval_eval`: what is compared with these enclosures is far coarser.

use super::interval_eval::{Enclosure, Interval, binary_range, unary_range};
use super::{Column, LaneValues, Machine, Op, Program, Register};
use mechc_expr::math::sin_cos_lanes;
use mechc_expr::{Binary, Comparison, Unary};
use std::array::from_fn;

/// Enclosures of registers that depend on parameters and time alone, a lane for each variant. Branches and tables have no enclosure.
#[derive(Clone, Debug)]
pub struct LaneEnclosure<const W: usize> {
    operations: Vec<Op>,
    /// The registers that the operations read and do not compute, but for the time.
    operands: Vec<Register>,
    time: Register,
    /// By register: the lower and the upper ends.
    values: Vec<[LaneValues<W>; 2]>,
}

impl<const W: usize> LaneEnclosure<W> {
    /// Creates the enclosure, for several variants, of the registers that one variant's enclosure computes.
    #[must_use]
    pub fn of(single: &Enclosure, program: &Program) -> Self {
        let is_computed = |register: &Register| single.operations.iter().any(|op| op.writes().contains(register));
        let read = single.operations.iter().flat_map(|&op| program.reads(op));
        let mut operands: Vec<Register> =
            read.filter(|register| *register != single.time && !is_computed(register)).collect();
        operands.sort_unstable();
        operands.dedup();
        LaneEnclosure::new(single.operations.clone(), operands, single.time, &single.values)
    }

    /// Creates the enclosure of the results of operations; `constants` holds the values of registers that no lane changes.
    fn new(operations: Vec<Op>, operands: Vec<Register>, time: Register, constants: &[Interval]) -> Self {
        let values = constants.iter().map(|of| [LaneValues([of.low; W]), LaneValues([of.high; W])]).collect();
        LaneEnclosure { operations, operands, time, values }
    }

    /// Returns the registers that [`Self::load`] reads.
    #[must_use]
    pub fn operands(&self) -> &[Register] {
        &self.operands
    }

    /// Copies the operands from the registers of a program.
    pub fn load(&mut self, registers: &[LaneValues<W>]) {
        for &operand in &self.operands {
            self.values[operand as usize] = [registers[operand as usize]; 2];
        }
    }

    /// Encloses all values between two times (s), in the first `parts` parts of `P` lanes. A value without an enclosure becomes NaN or
    /// infinite.
    #[inline(always)]
    #[allow(clippy::inline_always)] // compiled for several vector instruction sets
    pub fn enclose<const P: usize>(&mut self, parts: usize, [from, to]: [f64; 2]) {
        let LaneEnclosure { operations, time, values, .. } = self;
        values[*time as usize] = [LaneValues([from; W]), LaneValues([to; W])];
        let mut machine = LaneIntervals::<W, P> { values, parts, part: 0 };
        for op in &*operations {
            match *op {
                // equal operands are correlated, which products of intervals ignore
                Op::Mul { to, a, b } if a == b => machine.square(to, a),
                op => op.run(&mut machine),
            }
        }
    }

    /// Returns the lower and the upper ends of a register.
    #[inline]
    #[must_use]
    pub fn range(&self, register: Register) -> &[LaneValues<W>; 2] {
        &self.values[register as usize]
    }
}

/// Machine on registers that hold an interval for each lane.
struct LaneIntervals<'v, const W: usize, const P: usize> {
    values: &'v mut [[LaneValues<W>; 2]],
    parts: usize,
    part: usize,
}

/// Lower and upper ends, by lane.
type Ends<const P: usize> = [[f64; P]; 2];

#[allow(clippy::inline_always)] // as in `LaneMachine`
impl<const W: usize, const P: usize> LaneIntervals<'_, W, P> {
    #[inline(always)]
    fn square(&mut self, to: Register, a: Register) {
        for part in 0..self.parts {
            self.part = part;
            let [low, high] = self.read(a);
            let least: [f64; P] = from_fn(|k| larger(larger(low[k], -high[k]), 0.0));
            let most: [f64; P] = from_fn(|k| larger(-low[k], high[k]));
            self.write(to, [least.map(|x| x * x), most.map(|x| x * x)]);
        }
    }

    /// Encloses a function lane by lane.
    #[inline(always)]
    fn by_lane(range: impl Fn(usize) -> Interval) -> Ends<P> {
        let ranges: [Interval; P] = from_fn(range);
        [ranges.map(|of| of.low), ranges.map(|of| of.high)]
    }
}

#[inline(always)]
#[allow(clippy::inline_always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline(always)]
#[allow(clippy::inline_always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Returns the ends of a lane as an interval.
fn interval<const P: usize>([low, high]: &Ends<P>, k: usize) -> Interval {
    Interval { low: low[k], high: high[k] }
}

#[allow(clippy::inline_always)] // as in `LaneMachine`
impl<const W: usize, const P: usize> Machine for LaneIntervals<'_, W, P> {
    type Value = Ends<P>;

    #[inline(always)]
    fn parts(&self) -> usize {
        self.parts
    }

    #[inline(always)]
    fn go_to(&mut self, part: usize) {
        self.part = part;
    }

    #[inline(always)]
    fn read(&mut self, register: Register) -> Ends<P> {
        let [low, high] = &self.values[register as usize];
        [*low.part(self.part), *high.part(self.part)]
    }

    #[inline(always)]
    fn write(&mut self, register: Register, [from, to]: Ends<P>) {
        let [low, high] = &mut self.values[register as usize];
        (*low.part_mut(self.part), *high.part_mut(self.part)) = (from, to);
    }

    #[inline(always)]
    fn add(&mut self, [a, b]: Ends<P>, [c, d]: Ends<P>) -> Ends<P> {
        [from_fn(|k| a[k] + c[k]), from_fn(|k| b[k] + d[k])]
    }

    #[inline(always)]
    fn sub(&mut self, [a, b]: Ends<P>, [c, d]: Ends<P>) -> Ends<P> {
        [from_fn(|k| a[k] - d[k]), from_fn(|k| b[k] - c[k])]
    }

    #[inline(always)]
    fn mul(&mut self, [a, b]: Ends<P>, [c, d]: Ends<P>) -> Ends<P> {
        let low = from_fn(|k| smaller(smaller(a[k] * c[k], a[k] * d[k]), smaller(b[k] * c[k], b[k] * d[k])));
        [low, from_fn(|k| larger(larger(a[k] * c[k], a[k] * d[k]), larger(b[k] * c[k], b[k] * d[k])))]
    }

    #[inline(always)]
    fn div(&mut self, a: Ends<P>, b: Ends<P>) -> Ends<P> {
        let inverse = self.recip(b);
        self.mul(a, inverse)
    }

    #[inline(always)]
    fn neg(&mut self, [low, high]: Ends<P>) -> Ends<P> {
        [high.map(|x| -x), low.map(|x| -x)]
    }

    #[inline(always)]
    fn recip(&mut self, [low, high]: Ends<P>) -> Ends<P> {
        // across a pole there is no enclosure
        let pole: [f64; P] = from_fn(|k| if low[k] * high[k] > 0.0 { 0.0 } else { f64::NAN });
        [from_fn(|k| 1.0 / high[k] + pole[k]), from_fn(|k| 1.0 / low[k] + pole[k])]
    }

    /// Encloses sine and cosine as `interval_eval` does.
    #[inline(always)]
    fn sin_cos(&mut self, [low, high]: Ends<P>) -> [Ends<P>; 2] {
        let middle: [f64; P] = from_fn(|k| 0.5 * (low[k] + high[k]));
        let reach: [f64; P] = from_fn(|k| 0.5 * (high[k] - low[k]));
        let (sin, cos) = sin_cos_lanes(&middle);
        [[sin, cos], [cos, sin]].map(|[value, slope]| {
            let off: [f64; P] = from_fn(|k| reach[k] * smaller(slope[k].abs() + 0.5 * reach[k], 1.0));
            [from_fn(|k| larger(value[k] - off[k], -1.0)), from_fn(|k| smaller(value[k] + off[k], 1.0))]
        })
    }

    #[inline(always)]
    fn unary(&mut self, function: Unary, a: Ends<P>) -> Ends<P> {
        match function {
            Unary::Sin => self.sin_cos(a)[0],
            Unary::Cos => self.sin_cos(a)[1],
            _ => Self::by_lane(|k| unary_range(function, interval(&a, k))),
        }
    }

    #[inline(always)]
    fn binary(&mut self, function: Binary, a: Ends<P>, b: Ends<P>) -> Ends<P> {
        Self::by_lane(|k| binary_range(function, interval(&a, k), interval(&b, k)))
    }

    fn compare(&mut self, _: Comparison, _: Ends<P>, _: Ends<P>) -> Ends<P> {
        [[f64::NAN; P]; 2]
    }

    fn and(&mut self, _: Ends<P>, _: Ends<P>) -> Ends<P> {
        [[f64::NAN; P]; 2]
    }

    fn or(&mut self, _: Ends<P>, _: Ends<P>) -> Ends<P> {
        [[f64::NAN; P]; 2]
    }

    fn not(&mut self, _: Ends<P>) -> Ends<P> {
        [[f64::NAN; P]; 2]
    }

    fn select(&mut self, _: Ends<P>, _: Ends<P>, _: Ends<P>) -> Ends<P> {
        [[f64::NAN; P]; 2]
    }

    fn either(&mut self, _: Ends<P>, _: Ends<P>, _: Ends<P>) -> Ends<P> {
        [[f64::NAN; P]; 2]
    }

    fn piece(&mut self, _: u32, _: Ends<P>) -> Ends<P> {
        [[f64::NAN; P]; 2]
    }

    fn pick(&mut self, _: u32, _: Column, _: Ends<P>) -> Ends<P> {
        [[f64::NAN; P]; 2]
    }
}

#[cfg(test)]
mod tests {
    use super::{Interval, LaneEnclosure, LaneValues, Op};
    use mechc_expr::{Unary, unary_value};
    use std::array::from_fn;

    const LANES: usize = 16;

    /// `p sin(2 t) + exp(−(t − p)²) / (t + 2)`, with `t`, `p` and 2 in the first registers.
    const OPERATIONS: [Op; 10] = [
        Op::Mul { to: 3, a: 2, b: 0 },
        Op::SinCos { sin: 4, cos: 5, a: 3 },
        Op::Mul { to: 6, a: 1, b: 4 },
        Op::Sub { to: 7, a: 0, b: 1 },
        Op::Mul { to: 8, a: 7, b: 7 },
        Op::Neg { to: 9, a: 8 },
        Op::Unary { function: Unary::Exp, to: 10, a: 9 },
        Op::Add { to: 11, a: 0, b: 2 },
        Op::Div { to: 12, a: 10, b: 11 },
        Op::Add { to: 13, a: 6, b: 12 },
    ];

    fn value(p: f64, t: f64) -> f64 {
        let pulse = unary_value(Unary::Exp, -(t - p) * (t - p)) / (t + 2.0);
        p * unary_value(Unary::Sin, 2.0 * t) + pulse
    }

    #[test]
    fn enclosures_hold_all_values_and_narrow_with_the_step() {
        let constants: Vec<Interval> =
            (0..14).map(|k| if k == 2 { 2.0 } else { 0.0 }).map(|x| Interval { low: x, high: x }).collect();
        let mut enclosure = LaneEnclosure::<LANES>::new(OPERATIONS.to_vec(), vec![1], 0, &constants);
        let params: [f64; LANES] = from_fn(|lane| 0.4 * lane as f64 - 3.0);
        enclosure.load(&[LaneValues([0.0; LANES]), LaneValues(params)]);
        for (first, h) in (0..60).flat_map(|k| [1e-3, 0.1, 1.0].map(|h| (0.1 * f64::from(k) - 1.0, h))) {
            enclosure.enclose::<8>(2, [first, first + h]);
            let [low, high] = enclosure.range(13);
            for (lane, &p) in params.iter().enumerate() {
                let (low, high) = (low.0[lane], high.0[lane]);
                for sample in 0..=10 {
                    let x = value(p, first + 0.1 * f64::from(sample) * h);
                    assert!(low - 1e-12 <= x && x <= high + 1e-12, "{x} in {low}..{high} for {p} at {first}, {h}");
                }
                assert!(high - low <= 40.0 * h, "{low}..{high} for {p} at {first}, {h}");
            }
        }
        // across the pole at −2 there is no enclosure
        enclosure.enclose::<8>(2, [-2.5, -1.5]);
        let [low, high] = enclosure.range(13);
        assert!((0..LANES).all(|lane| !(high.0[lane] - low.0[lane]).is_finite()));
    }
}
