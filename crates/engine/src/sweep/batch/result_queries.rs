//! The values along a motion that the results of a mechanism need, and their evaluation in lanes.

use super::{CHUNK, FEWEST_STEPS, LANES, PerLane, ZERO};
use crate::analysis::{Computed, Sampled, SmoothFormula, SmoothFormulas, Started, Times, moved};
use crate::limits::curve::MOVED;
use crate::solver::{Solver, VariantLanes};
use mechc_expr::ExprId;
use mechc_expr::math::Vectors;
use mechc_ir::program::{LaneMachine, LaneValues, Op, Register};
use mechc_ir::structure::Determined;
use mechc_ir::{ConstraintSystem, ReductionKind};
use std::array::from_fn;
use std::sync::Arc;

/// Minimum number of steps over the span if formulas contain lengths.
const FEWEST_STEPS_OF_LENGTHS: f64 = 64.0;

/// The queries that the results of a mechanism consist of.
pub(super) struct ResultQueries {
    /// The solver for the coordinates that the quantities contain.
    pub solver: Solver,
    determined: Arc<Determined>,
    quantities: SmoothFormulas,
    /// By quantity, stage and input: the column of the input.
    columns: Vec<Vec<Vec<u32>>>,
    /// The queries, without duplicates.
    pub queries: Vec<Query>,
    /// By reduction: its query, as an index, and which number of the answer it is.
    reductions: Vec<(usize, Answer)>,
    /// The first and the last time (s).
    pub interval: [f64; 2],
    vectors: Vectors,
}

/// A query for a value of a quantity along the motion.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Query {
    /// The quantity, as an index.
    pub quantity: usize,
    pub kind: QueryKind,
}

/// The value that a query is for.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum QueryKind {
    /// The largest value, or the smallest one.
    Extreme { largest: bool },
    /// The value at the first time.
    First,
    /// The value at the last time.
    Last,
    /// The value at a time, a formula of parameters (s).
    At(ExprId),
    /// The integral over the interval.
    Integral,
}

/// The number of an answer that a reduction returns.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Answer {
    Time,
    Value,
    /// The value divided by the length of the interval.
    Mean,
}

impl ResultQueries {
    /// Collects the queries of a mechanism with its nominal parameters, over the interval of `times`. The solver keeps the columns for which
    /// `is_kept` holds as well. Returns `None` if results are to be computed for each variant alone.
    pub fn new(
        determined: &Arc<Determined>,
        started: &mut Started,
        times: &Times,
        is_kept: &dyn Fn(u32) -> bool,
        vectors: Vectors,
    ) -> Option<ResultQueries> {
        let interval = times.interval().filter(|[from, to]| from < to)?;
        let quantities = SmoothFormulas::of(determined.system())?;
        let layout = *started.solver()?.layout();
        let stage_columns = |stage: &Computed| -> Vec<u32> {
            stage.inputs().iter().map(|&(_, k, order)| layout.coordinate(k, order)).collect()
        };
        let columns = |quantity: &SmoothFormula| quantity.stages().iter().map(stage_columns).collect();
        let columns: Vec<Vec<Vec<u32>>> = quantities.each().iter().map(columns).collect();
        let all: Vec<u32> = columns.iter().flatten().flatten().copied().collect();
        let solver = started.solver_of_variants(&|column| is_kept(column) || all.contains(&column))?;
        let (mut queries, mut reductions) = (Vec::new(), Vec::new());
        for &(quantity, kind) in quantities.reductions() {
            let (kind, answer) = match kind {
                ReductionKind::Extreme { largest, when: true } => (QueryKind::Extreme { largest }, Answer::Time),
                ReductionKind::Extreme { largest, when: false } => (QueryKind::Extreme { largest }, Answer::Value),
                ReductionKind::First => (QueryKind::First, Answer::Value),
                ReductionKind::Last => (QueryKind::Last, Answer::Value),
                ReductionKind::At(at) => (QueryKind::At(at), Answer::Value),
                ReductionKind::Mean => (QueryKind::Integral, Answer::Mean),
                ReductionKind::Integral => (QueryKind::Integral, Answer::Value),
            };
            let query = Query { quantity, kind };
            let existing = queries.iter().position(|other| *other == query);
            reductions.push((existing.unwrap_or(queries.len()), answer));
            if existing.is_none() {
                queries.push(query);
            }
        }
        Some(ResultQueries {
            solver,
            determined: Arc::clone(determined),
            quantities,
            columns,
            queries,
            reductions,
            interval,
            vectors,
        })
    }

    fn system(&self) -> &ConstraintSystem {
        self.determined.system()
    }

    /// Returns the number of quantities.
    pub fn quantity_count(&self) -> usize {
        self.quantities.each().len()
    }

    /// Returns whether the second derivative of a quantity is computed.
    pub fn has_second_derivative(&self, quantity: usize) -> bool {
        self.quantities.each()[quantity].roots().len() > 2
    }

    /// Returns whether a quantity is a length, which has a kink at zero.
    pub fn is_length(&self, quantity: usize) -> bool {
        self.quantities.each()[quantity].is_length()
    }

    /// Evaluates a formula of parameters for one lane (SI).
    pub fn value(&self, formula: ExprId, params: &[PerLane], lane: usize) -> f64 {
        SmoothFormulas::value(self.system(), (formula, false), |k| params[k as usize].0[lane], &[])
    }

    /// Returns the number of results.
    pub fn result_count(&self) -> usize {
        self.system().results().outcomes.len()
    }

    /// Writes the results of one lane (SI; NaN without a value). `answers` holds time (s) and value by query.
    pub fn write_results(&self, answers: &[[f64; 2]], params: &[PerLane], lane: usize, results: &mut [f64]) {
        let [from, to] = self.interval;
        let number = |&(query, answer): &(usize, Answer)| match (answers[query], answer) {
            ([time, _], Answer::Time) => time,
            ([_, value], Answer::Value) => value,
            ([_, value], Answer::Mean) => value / (to - from),
        };
        let reductions: Vec<f64> = self.reductions.iter().map(number).collect();
        for (outcome, result) in self.system().results().outcomes.iter().zip(results) {
            let param = |k: u32| params[k as usize].0[lane];
            let formula = (outcome.value, outcome.unknown_is_false);
            let value = SmoothFormulas::value(self.system(), formula, param, &reductions);
            // −0 would surprise a reader
            *result = if value.is_finite() { value + 0.0 } else { f64::NAN };
        }
    }

    /// Returns new registers for a quantity, by stage.
    pub fn registers(&self, quantity: usize) -> Vec<Vec<PerLane>> {
        let of_stage = |stage: &Computed| {
            let (program, registers) = stage.program();
            (0..program.registers() as Register).map(|register| LaneValues([registers.get(register); LANES])).collect()
        };
        self.quantities.each()[quantity].stages().iter().map(of_stage).collect()
    }

    /// Computes the registers of a quantity that depend on parameters alone.
    pub fn load(&self, quantity: usize, registers: &mut [Vec<PerLane>], params: &[PerLane]) {
        for (stage, registers) in self.quantities.each()[quantity].stages().iter().zip(registers) {
            let first = stage.program().0.inputs.params as usize;
            registers[first..first + params.len()].copy_from_slice(params);
            self.run(stage, stage.operations()[0], registers);
        }
    }

    /// Evaluates a quantity at the solution of a position.
    pub fn evaluate(&self, quantity: usize, registers: &mut [Vec<PerLane>], solution: &VariantLanes<LANES>) {
        self.compute(quantity, registers, |_, column| *solution.column(column));
    }

    /// Returns the magnitude of the terms that the `value` of a quantity is a sum of: evaluates it with all coordinates changed by a small
    /// factor each, by one of several patterns.
    pub fn term_magnitude(
        &self,
        quantity: usize,
        value: &PerLane,
        registers: &mut [Vec<PerLane>],
        solution: &VariantLanes<LANES>,
        pattern: usize,
    ) -> PerLane {
        self.compute(quantity, registers, |k, column| {
            let factor = moved(k as usize, pattern as u32);
            LaneValues(solution.column(column).0.map(|value| value * factor))
        });
        let [changed, ..] = self.tower(quantity, registers);
        LaneValues(from_fn(|lane| (changed.0[lane] - value.0[lane]).abs() / MOVED))
    }

    /// Evaluates a quantity; `coordinate` returns the values of an input, by coordinate and column.
    fn compute(&self, quantity: usize, registers: &mut [Vec<PerLane>], coordinate: impl Fn(u32, u32) -> PerLane) {
        for (k, stage) in self.quantities.each()[quantity].stages().iter().enumerate() {
            let (before, from_here) = registers.split_at_mut(k);
            for (&(register, index, _), &column) in stage.inputs().iter().zip(&self.columns[quantity][k]) {
                from_here[0][register as usize] = coordinate(index, column);
            }
            for &(register, from) in stage.taken() {
                from_here[0][register as usize] = before[k - 1][from as usize];
            }
            self.run(stage, stage.operations()[1], &mut from_here[0]);
        }
    }

    /// Runs operations of a stage.
    fn run(&self, stage: &Computed, operations: &[Op], registers: &mut [PerLane]) {
        let (program, scalars) = stage.program();
        let mut machine = LaneMachine::<LANES, CHUNK>::new(registers, LANES / CHUNK, (program, scalars));
        self.vectors.run(
            #[inline(always)]
            || operations.iter().for_each(|op| op.run(&mut machine)),
        );
    }

    /// Returns the limit of step lengths (s).
    pub fn max_step(&self) -> f64 {
        let [from, to] = self.interval;
        let has_lengths = self.quantities.each().iter().any(SmoothFormula::is_length);
        (to - from) / if has_lengths { FEWEST_STEPS_OF_LENGTHS } else { FEWEST_STEPS }
    }

    /// Returns value, first and second derivative of a quantity after [`Self::evaluate`]; 0 for a derivative that is not computed.
    pub fn tower(&self, quantity: usize, registers: &[Vec<PerLane>]) -> [PerLane; 3] {
        let (roots, last) = (self.quantities.each()[quantity].roots(), registers.len() - 1);
        [0, 1, 2].map(|order| roots.get(order).map_or(ZERO, |&root| registers[last][root as usize]))
    }

    /// Returns value and derivatives of a quantity for one lane; NaN for a derivative that is not computed.
    pub fn sample(&self, quantity: usize, registers: &[Vec<PerLane>], lane: usize) -> Sampled {
        let (roots, last) = (self.quantities.each()[quantity].roots(), registers.len() - 1);
        let value = |order: usize| roots.get(order).map_or(f64::NAN, |&root| registers[last][root as usize].0[lane]);
        Sampled { value: value(0), first: value(1), second: value(2) }
    }
}
