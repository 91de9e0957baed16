//! What results ask of variants that go side by side.

use super::each::{Each, LANES, PART, ZERO};
use crate::analysis::{Computed, Sampled, SmoothFormula, SmoothFormulas, Started, Times, moved};
use crate::solver::{Abreast, Solver};
use mechc_expr::ExprId;
use mechc_expr::math::Vectors;
use mechc_ir::program::{LaneMachine, LaneValues, Op, Register};
use mechc_ir::structure::Determined;
use mechc_ir::tolerances::results::curve::MOVED;
use mechc_ir::tolerances::solving::course::FEWEST_STEPS_OF_LENGTHS;
use mechc_ir::tolerances::solving::variants::FEWEST_STEPS;
use mechc_ir::{ConstraintSystem, ReductionKind};
use std::array::from_fn;
use std::sync::Arc;

/// What results ask.
pub(super) struct Asked {
    /// For the coordinates that formulas hold.
    pub solver: Solver,
    determined: Arc<Determined>,
    quantities: SmoothFormulas,
    /// By quantity, by stage, by what that is computed from: the column of that.
    columns: Vec<Vec<Vec<u32>>>,
    /// What is looked for along the motion, each once.
    pub wanted: Vec<Wanted>,
    /// By reduction: which of these it is, and which number of that.
    reductions: Vec<(usize, Number)>,
    /// The first and the last time (s).
    pub interval: [f64; 2],
    vectors: Vectors,
}

/// Something that is looked for along the motion.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Wanted {
    /// Which quantity.
    pub quantity: usize,
    pub what: What,
}

/// Which place of a quantity's course.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum What {
    /// The largest value, or the least one.
    Extreme { largest: bool },
    /// The first.
    First,
    /// The last.
    Last,
    /// That at a time, a formula of parameters (s).
    At(ExprId),
    /// The integral over the whole of it.
    Integral,
}

/// Which number of what has been found.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Number {
    Time,
    Value,
    /// The value over the time of the analysis.
    Mean,
}

impl Asked {
    /// Of a mechanism that stands with its own values, over the analysis of some times, with some columns kept beside; none where results had
    /// better be found alone.
    pub fn of(
        determined: &Arc<Determined>,
        started: &mut Started,
        times: &Times,
        (is_kept, vectors): (&dyn Fn(u32) -> bool, Vectors),
    ) -> Option<Asked> {
        let interval = times.interval().filter(|[from, to]| from < to)?;
        let quantities = SmoothFormulas::of(determined.system())?;
        let layout = *started.solver()?.layout();
        let of_stage = |stage: &Computed| -> Vec<u32> {
            stage.inputs().iter().map(|&(_, k, order)| layout.coordinate(k, order)).collect()
        };
        let columns = |quantity: &SmoothFormula| quantity.stages().iter().map(of_stage).collect();
        let columns: Vec<Vec<Vec<u32>>> = quantities.each().iter().map(columns).collect();
        let all: Vec<u32> = columns.iter().flatten().flatten().copied().collect();
        let solver = started.solver_of_variants(&|column| is_kept(column) || all.contains(&column))?;
        let (mut wanted, mut reductions) = (Vec::new(), Vec::new());
        for &(quantity, kind) in quantities.reductions() {
            let (what, number) = match kind {
                ReductionKind::Extreme { largest, when: true } => (What::Extreme { largest }, Number::Time),
                ReductionKind::Extreme { largest, when: false } => (What::Extreme { largest }, Number::Value),
                ReductionKind::First => (What::First, Number::Value),
                ReductionKind::Last => (What::Last, Number::Value),
                ReductionKind::At(at) => (What::At(at), Number::Value),
                ReductionKind::Mean => (What::Integral, Number::Mean),
                ReductionKind::Integral => (What::Integral, Number::Value),
            };
            let this = Wanted { quantity, what };
            let known = wanted.iter().position(|other| *other == this);
            reductions.push((known.unwrap_or(wanted.len()), number));
            if known.is_none() {
                wanted.push(this);
            }
        }
        Some(Asked {
            solver,
            determined: Arc::clone(determined),
            quantities,
            columns,
            wanted,
            reductions,
            interval,
            vectors,
        })
    }

    fn system(&self) -> &ConstraintSystem {
        self.determined.system()
    }

    /// How many quantities there are.
    pub fn count(&self) -> usize {
        self.quantities.each().len()
    }

    /// Whether the second derivative of a quantity is known.
    pub fn knows_bends(&self, quantity: usize) -> bool {
        self.quantities.each()[quantity].roots().len() > 2
    }

    /// Whether a quantity is a length.
    pub fn is_length(&self, quantity: usize) -> bool {
        self.quantities.each()[quantity].is_length()
    }

    /// A formula of parameters for one variant (SI).
    pub fn value(&self, formula: ExprId, params: &[Each], lane: usize) -> f64 {
        SmoothFormulas::value(self.system(), (formula, false), |k| params[k as usize].0[lane], &[])
    }

    /// How many results there are.
    pub fn results(&self) -> usize {
        self.system().results().outcomes.len()
    }

    /// The results of one variant, from time (s) and value of all that was looked for.
    pub fn write_results(&self, found: &[[f64; 2]], (params, lane): (&[Each], usize), results: &mut [f64]) {
        let [from, to] = self.interval;
        let number = |&(wanted, number): &(usize, Number)| match (found[wanted], number) {
            ([time, _], Number::Time) => time,
            ([_, value], Number::Value) => value,
            ([_, value], Number::Mean) => value / (to - from),
        };
        let reductions: Vec<f64> = self.reductions.iter().map(number).collect();
        for (outcome, result) in self.system().results().outcomes.iter().zip(results) {
            let of = |k: u32| params[k as usize].0[lane];
            let formula = (outcome.value, outcome.unknown_is_false);
            let value = SmoothFormulas::value(self.system(), formula, of, &reductions);
            // −0 would surprise a reader
            *result = if value.is_finite() { value + 0.0 } else { f64::NAN };
        }
    }

    /// Registers for a quantity, by stage.
    pub fn registers(&self, quantity: usize) -> Vec<Vec<Each>> {
        let of_stage = |stage: &Computed| {
            let (program, registers) = stage.program();
            (0..program.registers() as Register).map(|register| LaneValues([registers.get(register); LANES])).collect()
        };
        self.quantities.each()[quantity].stages().iter().map(of_stage).collect()
    }

    /// Computes what of a quantity depends on parameters alone.
    pub fn load(&self, quantity: usize, registers: &mut [Vec<Each>], params: &[Each]) {
        for (stage, registers) in self.quantities.each()[quantity].stages().iter().zip(registers) {
            let first = stage.program().0.inputs.params as usize;
            registers[first..first + params.len()].copy_from_slice(params);
            self.run(stage, stage.operations()[0], registers);
        }
    }

    /// Computes a quantity from the coordinates that were solved for.
    pub fn look(&self, number: usize, registers: &mut [Vec<Each>], from: &Abreast<LANES>) {
        self.compute(number, registers, |_, column| *from.column(column));
    }

    /// The size of the numbers that a value of a quantity is a sum of: by moving all coordinates a little, in one of some ways.
    pub fn weight(
        &self,
        (number, value): (usize, &Each),
        registers: &mut [Vec<Each>],
        from: &Abreast<LANES>,
        way: usize,
    ) -> Each {
        self.compute(number, registers, |k, column| {
            let factor = moved(k as usize, way as u32);
            LaneValues(from.column(column).0.map(|value| value * factor))
        });
        let [there, ..] = self.tower(number, registers);
        LaneValues(from_fn(|lane| (there.0[lane] - value.0[lane]).abs() / MOVED))
    }

    /// Computes a quantity from what its coordinates are, by their numbers and columns.
    fn compute(&self, number: usize, registers: &mut [Vec<Each>], of: impl Fn(u32, u32) -> Each) {
        for (k, stage) in self.quantities.each()[number].stages().iter().enumerate() {
            let (before, own) = registers.split_at_mut(k);
            for (&(register, coordinate, _), &column) in stage.inputs().iter().zip(&self.columns[number][k]) {
                own[0][register as usize] = of(coordinate, column);
            }
            for &(register, from) in stage.taken() {
                own[0][register as usize] = before[k - 1][from as usize];
            }
            self.run(stage, stage.operations()[1], &mut own[0]);
        }
    }

    /// Runs operations of a stage.
    fn run(&self, stage: &Computed, operations: &[Op], registers: &mut [Each]) {
        let (program, scalars) = stage.program();
        let mut machine = LaneMachine::<LANES, PART>::new(registers, LANES / PART, (program, scalars));
        self.vectors.run(
            #[inline(always)]
            || operations.iter().for_each(|op| op.run(&mut machine)),
        );
    }

    /// How long steps may be (s).
    pub fn longest_step(&self) -> f64 {
        let [from, to] = self.interval;
        let has_lengths = self.quantities.each().iter().any(SmoothFormula::is_length);
        (to - from) / if has_lengths { FEWEST_STEPS_OF_LENGTHS } else { FEWEST_STEPS }
    }

    /// Value and derivatives of a quantity that was looked at; 0 where the second one is not known.
    pub fn tower(&self, quantity: usize, registers: &[Vec<Each>]) -> [Each; 3] {
        let (roots, last) = (self.quantities.each()[quantity].roots(), registers.len() - 1);
        [0, 1, 2].map(|order| roots.get(order).map_or(ZERO, |&root| registers[last][root as usize]))
    }

    /// The same of one variant, as turns are settled by it.
    pub fn sample(&self, quantity: usize, registers: &[Vec<Each>], lane: usize) -> Sampled {
        let (roots, last) = (self.quantities.each()[quantity].roots(), registers.len() - 1);
        let value = |order: usize| roots.get(order).map_or(f64::NAN, |&root| registers[last][root as usize].0[lane]);
        Sampled { value: value(0), first: value(1), second: value(2) }
    }
}
