//! The data that all batches of a mechanism share. Batches are for equations that are smooth everywhere, away from singular positions; all
//! other cases are left to variants that are computed alone.

use super::acceptance::{LaneStates, TrackedCoordinate, TrackedDerivatives, singular_distance};
use super::lane_program::LaneProgram;
use super::lane_signals::LaneSignals;
use super::path_signals::PathSignals;
use super::result_queries::ResultQueries;
use super::{LANES, NEARLY, PerLane, ZERO};
use crate::analysis::{Started, Times};
use crate::solver::{Solver, VariantBatch, VariantLanes};
use crate::sweep::continuation::{CompiledSystem, ContinuationBase};
use mechc_expr::math::Vectors;
use mechc_ir::CoordinateKind;
use mechc_ir::layout::RowLayout;
use mechc_ir::program::{LaneValues, Program, Register, Stage};
use std::ops::Range;

/// Largest residual, relative to that of a variant on its own: rounding leaves orders of magnitude less.
const CERTAIN_RESIDUAL: f64 = 1e-3;
/// Largest residual between output times, relative to that of a variant on its own.
const RESIDUAL_OF_STEP: f64 = 1e4;
/// Largest distance of dense rows, as a part of the span; their velocities alone extrapolate and judge steps.
const DENSE_PART_OF_SPAN: f64 = 1.0 / 64.0;
/// Largest motion between dense rows at the start, scaled.
const DENSE_MOTION: f64 = 0.04;
/// Relative change of parameters for difference quotients of the mechanism's position.
const BESIDE: f64 = 1e-6;

/// The data that all batches of a mechanism share: its solvers, its requests, and its nominal state.
pub struct BatchContext {
    /// The program, of which the solvers and the signals load what depends on parameters alone.
    pub(super) program: LaneProgram,
    /// The nominal parameters, and the indices of those that variants change.
    pub(super) nominal_params: Vec<f64>,
    varied_params: Vec<u32>,
    /// The solver for steps between output times.
    pub(super) step_solver: Solver,
    /// The requested rows, or `None` without a request for rows.
    pub(super) rows: Option<RowPlan>,
    /// The queries for results, or `None` if there are no results or they are to be computed for each variant alone.
    pub(super) queries: Option<ResultQueries>,
    /// The derivatives that steps compute, and the coordinates that the acceptance test compares.
    pub(super) derivatives: TrackedDerivatives,
    pub(super) tracked: Vec<TrackedCoordinate>,
    /// By tear: its index among the tracked coordinates.
    pub(super) tears: Vec<usize>,
    /// By row of `Φ`: the inverse of the bound on its residual, for steps and for rows.
    pub(super) bounds: [Vec<f64>; 2],
    /// The nominal state: the tracked coordinates, and the values whose signs distinguish branches.
    q: Vec<f64>,
    branch_values: Vec<f64>,
    /// By varied parameter and tear: the derivative of the tear there.
    tear_slopes: Vec<Vec<f64>>,
    /// The factor that makes a smallest pivot an estimated distance to a singular position.
    pub(super) pivot_scale: f64,
    /// Estimated distance of the nominal state to a singular position.
    nominal_distance: f64,
    /// The signals that steps check, and those that paths check; `None` if there are none.
    pub(super) signals: Option<LaneSignals>,
    pub(super) path_signals: Option<PathSignals>,
    /// The nominal first time, and that of the variants (s); paths change the time if they differ.
    nominal_time: f64,
    pub(super) from: f64,
    pub(super) vectors: Vectors,
}

/// The requested rows and the solver for them.
pub(super) struct RowPlan {
    pub solver: Solver,
    pub times: Times,
    /// The requested columns.
    pub columns: Vec<u32>,
    /// By column but the times: whether it is equal for all variants.
    pub is_common: Vec<bool>,
}

impl RowPlan {
    /// Plans rows at `times`. The solver keeps the requested columns and those that steps track; `varies` tells the program's registers that
    /// may differ between variants.
    fn new(
        started: &mut Started,
        times: &Times,
        columns: Option<&[usize]>,
        is_tracked: &dyn Fn(u32) -> bool,
        varies: &dyn Fn(Register) -> bool,
    ) -> Option<RowPlan> {
        let columns: Vec<u32> = columns.unwrap_or_default().iter().map(|&column| column as u32).collect();
        let solver = started.solver_of_variants(&|column| is_tracked(column) || columns.contains(&column))?;
        let is_common = solver.lane_invariant_columns(varies);
        Some(RowPlan { solver, times: times.clone(), columns, is_common })
    }
}

/// A request for rows and results of all variants.
pub struct BatchRequest<'w> {
    /// The output times and the columns of rows; no columns if only results are requested.
    pub rows: (&'w Times, Option<&'w [usize]>),
    /// True if results are requested.
    pub results: bool,
    /// The parameters that variants change, as indices, but for `rates`.
    pub params: &'w [u32],
    /// The parameters, as indices, that variants change and that move nothing at the first time: rates of inputs.
    pub rates: &'w [u32],
}

impl BatchContext {
    /// Prepares batches of a mechanism that is started with its nominal parameters. Returns `None` if variants are to be computed alone.
    #[must_use]
    pub fn of(
        base: &ContinuationBase,
        started: &Started,
        request: &BatchRequest<'_>,
        vectors: Vectors,
    ) -> Option<BatchContext> {
        let mut started = started.clone();
        let (times, columns) = request.rows;
        if times.is_empty() || !started.is_smooth() || !base.is_smooth_in(request.params) {
            return None;
        }
        // results are found between steps, which must show all of the motion; without them rows alone are worth a batch
        let is_plain = started.is_plain();
        if columns.is_none() && !is_plain {
            return None;
        }
        let (CompiledSystem { determined, program }, nominal_params) = base.nominal();
        let indices = tracked_indices(&started);
        let tracked = tracked_coordinates(&started, &indices)?;
        let derivatives = required_derivatives(&mut started, request, &indices);
        let is_tracked =
            |column: u32| tracked.iter().any(|coordinate| coordinate.columns[..derivatives.orders()].contains(&column));
        let varied_params = [request.params, request.rates].concat();
        let queries = if request.results && is_plain {
            ResultQueries::new(determined, &mut started, times, &is_tracked, vectors)
        } else {
            None
        };
        // a variant with all its results has completed the motion, so rows need not show that, but only that loads have values
        let rows = if columns.is_none() && queries.is_some() && determined.system().forces().is_none() {
            None
        } else {
            let varies = varying_registers(program, &varied_params);
            let multipliers = checked_multipliers(&started);
            let is_checked = |column: u32| is_tracked(column) || multipliers.contains(&column);
            Some(RowPlan::new(&mut started, times, columns, &is_checked, &|register| varies[register as usize])?)
        };
        let step_solver = started.solver_of_variants(&is_tracked)?;
        let tears = step_solver.tears().iter().map(|&tear| indices.iter().position(|&k| k == tear as usize));
        let tears = tears.collect::<Option<Vec<usize>>>()?;
        let row_solver = rows.as_ref().map(|rows| &rows.solver);
        let solvers = [Some(&step_solver), row_solver, queries.as_ref().map(|queries| &queries.solver)];
        let signals = LaneSignals::new(program, &started.signal_bounds(), vectors);
        let operands = signals.iter().flat_map(|signals| signals.operands().iter().copied());
        let loaded: Vec<Register> = solvers.into_iter().flatten().flat_map(Solver::loads).chain(operands).collect();
        let bounds = started.bounds();
        let inverse_bounds = |factor: f64| bounds.iter().map(|bound| 1.0 / (factor * bound)).collect();
        let mut context = BatchContext {
            program: LaneProgram::new(program, nominal_params, &loaded),
            nominal_params: nominal_params.to_vec(),
            varied_params,
            step_solver,
            rows,
            queries,
            derivatives,
            tracked,
            tears,
            bounds: [RESIDUAL_OF_STEP, CERTAIN_RESIDUAL].map(inverse_bounds),
            q: indices.iter().map(|&k| started.q()[k]).collect(),
            branch_values: Vec::new(),
            tear_slopes: Vec::new(),
            pivot_scale: 1.0,
            nominal_distance: 1.0,
            signals,
            path_signals: PathSignals::new(base, times.from(), vectors),
            nominal_time: base.nominal_time(),
            from: times.from(),
            vectors,
        };
        context.measure_nominal_state(&mut started)?;
        Some(context)
    }

    /// Solves at the nominal state for the scale of pivots, the branch values and, by finite differences, the slopes of tears.
    fn measure_nominal_state(&mut self, started: &mut Started) -> Option<()> {
        let (mut lanes, mut loaded) = (self.new_lanes(&self.step_solver, |_| 1), self.program.new_registers());
        let nominal: Vec<PerLane> = self.nominal_params.iter().map(|&value| LaneValues([value; LANES])).collect();
        self.solve_near_nominal(&mut lanes, &mut loaded, &nominal)?;
        self.branch_values = lanes.branch_values().iter().map(|inverse| inverse.0[0]).collect();
        // pivots of rows of unit norm overestimate the singular value, if only by little, so the scale is at most 1
        self.pivot_scale = f64::min(1.0, started.conditioning() * lanes.max_inverse_pivots().0[0].max(1.0));
        self.nominal_distance = singular_distance(self.pivot_scale, lanes.max_inverse_pivots().0[0]);
        let position = |lanes: &VariantLanes<LANES>, tear: usize| lanes.column(self.tracked[tear].columns[0]).0[0];
        let here: Vec<f64> = self.tears.iter().map(|&tear| position(&lanes, tear)).collect();
        let mut tear_slopes = Vec::with_capacity(self.varied_params.len());
        for &param in &self.varied_params {
            let (mut perturbed, nominal) = (nominal.clone(), self.nominal_params[param as usize]);
            let value = if nominal == 0.0 { BESIDE } else { nominal * (1.0 + BESIDE) };
            perturbed[param as usize].0 = [value; LANES];
            let is_solved = self.solve_near_nominal(&mut lanes, &mut loaded, &perturbed).is_some();
            let slope = |(&tear, here): (&usize, &f64)| (position(&lanes, tear) - here) / (value - nominal);
            // slopes only make guesses, for which 0 will do
            let or_zero = |slope: f64| if is_solved && slope.is_finite() { slope } else { 0.0 };
            tear_slopes.push(self.tears.iter().zip(&here).map(slope).map(or_zero).collect());
        }
        self.tear_slopes = tear_slopes;
        Some(())
    }

    /// Solves with parameters close to the nominal ones, from the nominal state. Returns `None` if the solution is rejected.
    fn solve_near_nominal(
        &self,
        lanes: &mut VariantLanes<LANES>,
        loaded: &mut [PerLane],
        params: &[PerLane],
    ) -> Option<()> {
        self.program.load(loaded, params, 1);
        lanes.load(&self.step_solver, self.program.parts(), loaded, 1);
        let tears: Vec<PerLane> = self.tears.iter().map(|&tear| LaneValues([self.q[tear]; LANES])).collect();
        let [bounds, _] = &self.bounds;
        let times = [self.nominal_time; LANES];
        let batch = VariantBatch { times, tears: &tears, loaded, bounds, chunks: 1, loose_bound: NEARLY };
        lanes.run(&self.step_solver, self.program.parts(), &batch);
        let mut rejections = ZERO;
        lanes.add_rejections(&mut rejections);
        (rejections.0[0] == 0.0).then_some(())
    }

    /// Returns the nominal state in all lanes.
    pub(super) fn nominal_states(&self) -> Box<LaneStates> {
        Box::new(LaneStates::at_rest(self.nominal_time, &self.q, &self.branch_values, self.nominal_distance))
    }

    /// Returns the time (s) at a fraction of the path of a variant.
    pub(super) fn time_on_path(&self, fraction: f64) -> f64 {
        let gone = fraction * (self.from - self.nominal_time);
        if fraction < 1.0 { self.nominal_time + gone } else { self.from }
    }

    /// Writes guesses for the tears: linear in the parameters around the nominal state.
    pub(super) fn write_first_guesses(&self, params: &[PerLane], guesses: &mut [PerLane]) {
        for (index, (guess, &tear)) in guesses.iter_mut().zip(&self.tears).enumerate() {
            guess.0 = [self.q[tear]; LANES];
            for (&param, slopes) in self.varied_params.iter().zip(&self.tear_slopes) {
                let (nominal, values) = (self.nominal_params[param as usize], &params[param as usize].0);
                guess.0.iter_mut().zip(values).for_each(|(guess, value)| *guess += slopes[index] * (value - nominal));
            }
        }
    }

    /// Returns the number of rows of each variant.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows.as_ref().map_or(0, |rows| rows.times.len() as usize)
    }

    /// Returns registers for one of its solvers, which keep `rows` rows of each column that the solver stores.
    pub(super) fn new_lanes(&self, solver: &Solver, rows: impl Fn(u32) -> u32) -> VariantLanes<LANES> {
        let is_stored = solver.is_stored_column();
        VariantLanes::new(solver, |column| if is_stored(column) { rows(column) } else { 0 }, self.vectors)
    }
}

/// Returns the coordinates that the acceptance test compares, as indices: all angles, and the tears.
fn tracked_indices(started: &Started) -> Vec<usize> {
    let coordinates = started.system().coordinates();
    let is_tear = |k: usize| started.solver().is_some_and(|solver| solver.tears().contains(&(k as u32)));
    let is_tracked = |&k: &usize| is_tear(k) || coordinates[k].kind != CoordinateKind::Length;
    (0..coordinates.len()).filter(is_tracked).collect()
}

/// Returns the columns of multipliers that rows compute for their finiteness alone: a load without a value ends a motion, whichever columns are
/// requested.
fn checked_multipliers(started: &Started) -> Range<u32> {
    let (system, layout) = (started.system(), RowLayout::new(started.system()));
    let count = if system.loads().is_empty() { 0 } else { system.rows().len() as u32 };
    layout.multipliers..layout.multipliers + count
}

/// Returns the derivatives that steps need: velocities alone, which are cheapest, if only rows close to each other are requested.
fn required_derivatives(started: &mut Started, request: &BatchRequest<'_>, indices: &[usize]) -> TrackedDerivatives {
    let (times, columns) = (request.rows.0, request.rows.1.unwrap_or_default());
    let gap = times.widest_gap();
    if request.results || columns.is_empty() || gap > DENSE_PART_OF_SPAN * times.span() {
        return TrackedDerivatives::Accelerations;
    }
    // checked last, since velocities take a factorization
    let Some(velocities) = started.velocities() else { return TrackedDerivatives::Accelerations };
    let coordinates = started.system().coordinates();
    let fastest = indices.iter().map(|&k| velocities[k].abs() / coordinates[k].scale).fold(0.0, f64::max);
    if gap * fastest <= DENSE_MOTION { TrackedDerivatives::Velocities } else { TrackedDerivatives::Accelerations }
}

/// Returns tracked coordinates, given as indices, with their columns.
fn tracked_coordinates(started: &Started, indices: &[usize]) -> Option<Vec<TrackedCoordinate>> {
    let layout = *started.solver()?.layout();
    let tracked = |&k: &usize| TrackedCoordinate {
        columns: [0, 1, 2].map(|order| layout.coordinate(k as u32, order)),
        per_scale: 1.0 / started.system().coordinates()[k].scale,
    };
    Some(indices.iter().map(tracked).collect())
}

/// Returns by register whether it depends on `params` (indices) through operations of the prologue.
fn varying_registers(program: &Program, params: &[u32]) -> Vec<bool> {
    let mut varies = vec![false; program.registers()];
    for param in params {
        varies[(program.inputs.params + param) as usize] = true;
    }
    for &op in program.stage(Stage::Prologue) {
        let reads_varying = program.reads(op).any(|register| varies[register as usize]);
        op.writes().iter().for_each(|&to| varies[to as usize] |= reads_varying);
    }
    varies
}
