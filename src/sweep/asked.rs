//! What results ask of variants that go side by side.

use super::each::{Each, LANES, ZERO};
use crate::analysis::{Sampled, SmoothFormula, SmoothFormulas, Started, Times, moved};
use crate::expr::ExprId;
use crate::ir::{ConstraintSystem, ReductionKind};
use crate::math::Vectors;
use crate::program::{LaneMachine, LaneValues, Op, Register};
use crate::solver::{Abreast, Solver};
use crate::structure::Determined;
use crate::tolerances::results::formulas::MOVED;
use std::array::from_fn;
use std::sync::Arc;

/// What results ask.
pub(super) struct Asked {
    /// For the coordinates that formulas hold.
    pub solver: Solver,
    determined: Arc<Determined>,
    quantities: SmoothFormulas,
    /// By quantity, by what it is computed from: the column of that.
    columns: Vec<Vec<u32>>,
    /// What is looked for along the motion, each once.
    pub wanted: Vec<Wanted>,
    /// By reduction: which of these it is, and whether the time of that.
    reductions: Vec<(usize, bool)>,
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
        let columns = |quantity: &SmoothFormula| -> Vec<u32> {
            quantity.inputs().iter().map(|&(_, k, order)| layout.coordinate(k, order)).collect()
        };
        let columns: Vec<Vec<u32>> = quantities.each().iter().map(columns).collect();
        let solver = started
            .solver_of_variants(&|column| is_kept(column) || columns.iter().flatten().any(|&of| of == column))?;
        let (mut wanted, mut reductions) = (Vec::new(), Vec::new());
        for &(quantity, kind) in quantities.reductions() {
            let (what, when) = match kind {
                ReductionKind::Extreme { largest, when } => (What::Extreme { largest }, when),
                ReductionKind::First => (What::First, false),
                ReductionKind::Last => (What::Last, false),
                ReductionKind::At(at) => (What::At(at), false),
                ReductionKind::Mean | ReductionKind::Integral => return None,
            };
            let this = Wanted { quantity, what };
            let known = wanted.iter().position(|other| *other == this);
            reductions.push((known.unwrap_or(wanted.len()), when));
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

    /// A formula of parameters for one variant (SI).
    pub fn value(&self, formula: ExprId, params: &[Each], lane: usize) -> f64 {
        SmoothFormulas::value(self.system(), formula, |k| params[k as usize].0[lane], &[])
    }

    /// How many results there are.
    pub fn results(&self) -> usize {
        self.system().results().outcomes.len()
    }

    /// The results of one variant, from time (s) and value of all that was looked for.
    pub fn write_results(&self, found: &[[f64; 2]], (params, lane): (&[Each], usize), results: &mut [f64]) {
        let number = |&(wanted, when): &(usize, bool)| found[wanted][usize::from(!when)];
        let reductions: Vec<f64> = self.reductions.iter().map(number).collect();
        for (outcome, result) in self.system().results().outcomes.iter().zip(results) {
            let of = |k: u32| params[k as usize].0[lane];
            let value = SmoothFormulas::value(self.system(), outcome.value, of, &reductions);
            // −0 would surprise a reader
            *result = if value.is_finite() { value + 0.0 } else { f64::NAN };
        }
    }

    /// Registers for a quantity.
    pub fn registers(&self, quantity: usize) -> Vec<Each> {
        let (program, registers) = self.quantities.each()[quantity].program();
        (0..program.registers() as Register).map(|register| LaneValues([registers.get(register); LANES])).collect()
    }

    /// Computes what of a quantity depends on parameters alone.
    pub fn load(&self, quantity: usize, registers: &mut [Each], params: &[Each]) {
        let quantity = &self.quantities.each()[quantity];
        let first = quantity.program().0.inputs.params as usize;
        registers[first..first + params.len()].copy_from_slice(params);
        self.run(quantity, quantity.operations()[0], registers);
    }

    /// Computes a quantity from the coordinates that were solved for.
    pub fn look(&self, number: usize, registers: &mut [Each], from: &Abreast<LANES>) {
        let quantity = &self.quantities.each()[number];
        for (&(register, ..), &column) in quantity.inputs().iter().zip(&self.columns[number]) {
            registers[register as usize] = *from.column(column);
        }
        self.run(quantity, quantity.operations()[1], registers);
    }

    /// The size of the numbers that a value of a quantity is a sum of: by moving all coordinates a little, in one of some ways.
    pub fn weight(
        &self,
        (number, value): (usize, &Each),
        registers: &mut [Each],
        from: &Abreast<LANES>,
        way: usize,
    ) -> Each {
        let quantity = &self.quantities.each()[number];
        for (&(register, k, _), &column) in quantity.inputs().iter().zip(&self.columns[number]) {
            let factor = moved(k as usize, way as u32);
            registers[register as usize].0 = from.column(column).0.map(|value| value * factor);
        }
        self.run(quantity, quantity.operations()[1], registers);
        let there = &registers[quantity.roots()[0] as usize];
        LaneValues(from_fn(|lane| (there.0[lane] - value.0[lane]).abs() / MOVED))
    }

    /// Runs operations of a quantity.
    fn run(&self, quantity: &SmoothFormula, operations: &[Op], registers: &mut [Each]) {
        let (program, scalars) = quantity.program();
        let mut machine = LaneMachine { v: registers, program, scalars };
        self.vectors.run(
            #[inline(always)]
            || operations.iter().for_each(|op| op.run(&mut machine)),
        );
    }

    /// Value and derivatives of a quantity that was looked at; 0 where the second one is not known.
    pub fn tower(&self, quantity: usize, registers: &[Each]) -> [Each; 3] {
        let roots = self.quantities.each()[quantity].roots();
        [0, 1, 2].map(|order| roots.get(order).map_or(ZERO, |&root| registers[root as usize]))
    }

    /// The same of one variant, as turns are settled by it.
    pub fn sample(&self, quantity: usize, registers: &[Each], lane: usize) -> Sampled {
        let roots = self.quantities.each()[quantity].roots();
        let value = |order: usize| roots.get(order).map_or(f64::NAN, |&root| registers[root as usize].0[lane]);
        Sampled { value: value(0), first: value(1), second: value(2) }
    }
}
