//! Steps a batch of variants, a lane for each: from the nominal parameters to those of each variant, then from time to time. Newton's iterates
//! lie on a grid (see `mechc_runtime::grid`), so an exact solution on the same branch has the bits that it has alone. Only accepted steps are taken; a
//! variant whose steps are rejected too often leaves the batch.

use super::acceptance::{LaneStates, Rejections, TrackedDerivatives, check_step};
use super::context::{BatchContext, RowPlan};
use super::lane_signals::LaneSignals;
use super::path_signals::PathSignals;
use super::row_collector::RowCollector;
use super::{CHUNK, LANES, NEARLY, PerLane, ZERO, active_chunks};
use crate::limits::step_control::CRUMB;
use crate::solver::{Solver, VariantBatch, VariantLanes};
use mechc_expr::math::{slope_weights, weigh};
use mechc_ir::program::LaneValues;
use std::array::from_fn;

/// Relative difference up to which steps have the same length.
const ALIKE: f64 = 1e-9;
/// Maximum number of times that one variant may shorten the steps of its batch.
const PATIENCE: u32 = 16;
/// Number of steps before longer ones are tried; each rejected step adds as many, so that a motion which stays fast keeps its patience longer.
const CALM_STEPS: u32 = 6;
/// Numbers of continuation steps to a variant's parameters, tried in turn.
const PARTS_OF_WAY: [u32; 6] = [1, 2, 4, 8, 16, 32];

/// The largest number of states that a motion is extrapolated from.
const MAX_NODES: usize = 4;

impl TrackedDerivatives {
    /// Returns the largest number of states that a motion with these derivatives is extrapolated from.
    const fn nodes(self) -> usize {
        match self {
            TrackedDerivatives::Velocities => 4,
            TrackedDerivatives::Accelerations => 3,
        }
    }
}

/// A batch of variants on its path.
pub(super) struct BatchStepper {
    /// The program's registers that depend on parameters alone.
    pub registers: Vec<PerLane>,
    params: Vec<PerLane>,
    /// Registers of the solver for steps between output times.
    step_lanes: VariantLanes<LANES>,
    /// The present states, those before from the latest to the earliest, and the states that a step leads to.
    pub now: Box<LaneStates>,
    before: [Box<LaneStates>; MAX_NODES - 1],
    next: Box<LaneStates>,
    /// The number of these states, without `next`, that lie on the motion.
    node_count: usize,
    extrapolation: Extrapolation,
    guesses: Vec<PerLane>,
    signals: Option<LaneSignals>,
    path_signals: Option<PathSignals>,
    /// The present step length (s), its limit (s), and the number of steps of that length so far.
    step_length: f64,
    max_step: f64,
    steps_taken: u32,
    /// The number of steps of one length before longer ones are tried.
    calm_steps: u32,
    /// The lanes that go on, and the number of leading chunks that hold them.
    pub active: [bool; LANES],
    chunks: usize,
    /// By lane, the number of rejected steps that are left.
    patience: [u32; LANES],
}

/// Hermite extrapolation from the last states, as weights.
#[derive(Default)]
struct Extrapolation {
    /// The length of the step, and the ages of the states before (s).
    spans: [f64; MAX_NODES],
    /// By state, the weights of value, velocity and acceleration.
    weights: [[f64; 3]; MAX_NODES],
}

impl Extrapolation {
    /// Computes the weights for a step from the last `node_count` states, if the spans differ from those of the last step.
    fn update(&mut self, derivatives: TrackedDerivatives, node_count: usize, spans: [f64; MAX_NODES]) {
        let is_equal = |(span, before): (&f64, &f64)| (span - before).abs() <= ALIKE * before;
        // the error in the guess is far below a cell of the grid
        if spans.iter().zip(&self.spans).all(is_equal) {
            return;
        }
        let [h, back @ ..] = spans;
        (self.spans, self.weights) = (spans, [[0.0; 3]; MAX_NODES]);
        let mut nodes = [0.0; MAX_NODES];
        nodes[1..].iter_mut().zip(back).for_each(|(node, back)| *node = -back);
        let weigh = match derivatives {
            TrackedDerivatives::Velocities => slope_weights,
            TrackedDerivatives::Accelerations => weigh,
        };
        weigh(&nodes[..node_count], h, &mut self.weights);
    }
}

/// A solver for the states of a batch, with its registers.
pub(super) struct LaneSolver<'s> {
    pub solver: &'s Solver,
    pub lanes: &'s mut VariantLanes<LANES>,
    /// True if the solution must have the bits that it has alone.
    pub is_exact: bool,
}

impl<'s> LaneSolver<'s> {
    /// Creates the exact solver for requested rows.
    pub fn for_rows(rows: &'s RowPlan, collector: &'s mut RowCollector) -> LaneSolver<'s> {
        LaneSolver { solver: &rows.solver, lanes: &mut collector.lanes, is_exact: true }
    }
}

impl BatchStepper {
    /// Creates a stepper at the nominal state, without active lanes.
    pub fn new(context: &BatchContext) -> BatchStepper {
        BatchStepper {
            registers: context.program.new_registers(),
            params: context.nominal_params.iter().map(|&value| LaneValues([value; LANES])).collect(),
            step_lanes: context.new_lanes(&context.step_solver, |_| 1),
            now: context.nominal_states(),
            before: from_fn(|_| context.nominal_states()),
            next: context.nominal_states(),
            node_count: 0,
            extrapolation: Extrapolation::default(),
            guesses: vec![ZERO; context.tears.len()],
            signals: context.signals.clone(),
            path_signals: context.path_signals.clone(),
            step_length: 0.0,
            max_step: 0.0,
            steps_taken: 0,
            calm_steps: CALM_STEPS,
            active: [false; LANES],
            chunks: 0,
            patience: [0; LANES],
        }
    }

    /// Continues the `active` lanes to their parameters (SI) at the first time, and solves for that state. Steps of the motion from there are
    /// at most `max_step` (s) long.
    pub fn begin(
        &mut self,
        context: &BatchContext,
        params: &[PerLane],
        active: [bool; LANES],
        max_step: f64,
        solver: &mut LaneSolver<'_>,
    ) {
        (self.active, self.patience) = (active, [PATIENCE; LANES]);
        self.chunks = active_chunks(&active);
        (self.max_step, self.steps_taken, self.calm_steps) = (max_step, 0, CALM_STEPS);
        self.step_length = self.max_step;
        self.active = self.continue_to(context, params);
        solver.lanes.load(solver.solver, context.program.parts(), &self.registers, self.chunks);
        for (guess, &tear) in self.guesses.iter_mut().zip(&context.tears) {
            *guess = self.now.tracked[tear][0];
        }
        let rejections = self.solve_at(context, context.from, None, Some(solver));
        rejections.lanes().for_each(|k| self.active[k] = false);
        self.commit();
        if let Some(signals) = &mut self.signals {
            signals.begin(&self.registers, self.chunks, context.from);
        }
        self.node_count = 1;
    }

    /// Continues all active lanes to their parameters, each in as few parts as it needs; returns the lanes that get there.
    fn continue_to(&mut self, context: &BatchContext, targets: &[PerLane]) -> [bool; LANES] {
        let (mut open, mut has_arrived) = (self.active, [false; LANES]);
        let mut reached = context.nominal_states();
        for parts in PARTS_OF_WAY {
            let arrived = self.continue_in_parts(context, parts, targets, open);
            for k in (0..LANES).filter(|&k| arrived[k]) {
                (open[k], has_arrived[k]) = (false, true);
                reached.copy_lane(&self.now, k);
            }
            if !open.contains(&true) {
                break;
            }
        }
        self.now = reached;
        self.load(context, targets, 1.0);
        has_arrived
    }

    /// Continues from the nominal parameters in equal parts; returns the lanes out of `open` that get there.
    fn continue_in_parts(
        &mut self,
        context: &BatchContext,
        parts: u32,
        targets: &[PerLane],
        mut open: [bool; LANES],
    ) -> [bool; LANES] {
        (self.now, self.before[0]) = (context.nominal_states(), context.nominal_states());
        if let Some(signals) = &mut self.path_signals {
            signals.begin(targets, self.chunks);
        }
        for part in 1..=parts {
            let ends = [part - 1, part].map(|end| f64::from(end) / f64::from(parts));
            self.load(context, targets, ends[1]);
            if part == 1 {
                context.write_first_guesses(&self.params, &mut self.guesses);
            } else {
                // linear extrapolation
                for (guess, &tear) in self.guesses.iter_mut().zip(&context.tears) {
                    let (now, before) = (&self.now.tracked[tear][0].0, &self.before[0].tracked[tear][0].0);
                    guess.0 = from_fn(|k| now[k] + (now[k] - before[k]));
                }
            }
            let mut rejections = self.solve_at(context, context.time_on_path(ends[1]), None, None);
            if let Some(signals) = &mut self.path_signals {
                signals.check_part(self.chunks, ends, &mut rejections);
            }
            rejections.lanes().for_each(|k| open[k] = false);
            self.commit();
        }
        open
    }

    /// Loads the parameters at a fraction of the path from the nominal ones to `targets`.
    fn load(&mut self, context: &BatchContext, targets: &[PerLane], fraction: f64) {
        for ((param, target), &nominal) in self.params.iter_mut().zip(targets).zip(&context.nominal_params) {
            param.0 =
                if fraction < 1.0 { target.0.map(|target| nominal + fraction * (target - nominal)) } else { target.0 };
        }
        context.program.load(&mut self.registers, &self.params, self.chunks);
        self.step_lanes.load(&context.step_solver, context.program.parts(), &self.registers, self.chunks);
    }

    /// Advances to a time (s), in as many steps as that takes. The state there is computed by `solver`; with `at_every_step` those before it
    /// are too. Calls `show` for each state that `solver` computed.
    pub fn advance_to(
        &mut self,
        context: &BatchContext,
        t: f64,
        solver: &mut LaneSolver<'_>,
        at_every_step: bool,
        mut show: impl FnMut(&BatchStepper, &VariantLanes<LANES>),
    ) {
        while self.now.t < t && self.active.contains(&true) {
            let left = t - self.now.t;
            let is_last = self.step_length >= CRUMB * left;
            // equal steps, so that no tiny one is left
            let next = if is_last { t } else { self.now.t + left / -mechc_expr::math::floor(-left / self.step_length) };
            let h = next - self.now.t;
            let is_shown = is_last || at_every_step;
            if !self.try_step(context, next, is_shown.then_some(&mut *solver)) {
                (self.step_length, self.steps_taken) = (0.5 * h, 0);
                self.calm_steps += CALM_STEPS;
                continue;
            }
            if is_shown {
                show(self, solver.lanes);
            }
            if 2.0 * h > self.step_length {
                self.steps_taken += 1;
                if self.steps_taken == self.calm_steps {
                    (self.step_length, self.steps_taken) = ((2.0 * self.step_length).min(self.max_step), 0);
                }
            }
        }
    }

    /// Tries a step to a time (s); returns whether it was taken. Lanes that have rejected too many steps become inactive instead.
    fn try_step(&mut self, context: &BatchContext, t: f64, solver: Option<&mut LaneSolver<'_>>) -> bool {
        let h = t - self.now.t;
        self.extrapolate(context, h);
        let mut rejections = self.solve_at(context, t, Some(h), solver);
        if let Some(signals) = &mut self.signals {
            signals.check(self.chunks, [self.now.t, t], &mut rejections);
        }
        let mut is_taken = true;
        for k in rejections.lanes() {
            if self.active[k] && self.patience[k] > 0 {
                self.patience[k] -= 1;
                is_taken = false;
            } else {
                self.active[k] = false;
                // the others need not go as slowly
                self.calm_steps = CALM_STEPS;
            }
        }
        if is_taken {
            self.commit();
            if let Some(signals) = &mut self.signals {
                signals.commit();
            }
        }
        is_taken
    }

    /// Extrapolates the guesses for Newton over a step of length `h` (s), along the Hermite curve through the last states.
    fn extrapolate(&mut self, context: &BatchContext, h: f64) {
        let BatchStepper { now, before: [before, earlier, earliest], node_count, extrapolation, guesses, .. } = self;
        let derivatives = context.derivatives;
        let (states, node_count) = ([&**now, before, earlier, earliest], (*node_count).min(derivatives.nodes()));
        // states that are not on the motion may be left over from rejected lanes
        let states: [&LaneStates; MAX_NODES] = from_fn(|k| states[if k < node_count { k } else { 0 }]);
        extrapolation.update(derivatives, node_count, from_fn(|k| if k == 0 { h } else { states[0].t - states[k].t }));
        let weights = extrapolation.weights;
        context.vectors.run(
            #[inline(always)]
            || {
                for (guess, &tear) in guesses.iter_mut().zip(&context.tears) {
                    let states = states.map(|states| &states.tracked[tear]);
                    for chunk in 0..LANES / CHUNK {
                        *guess.part_mut(chunk) = match derivatives {
                            TrackedDerivatives::Velocities => weighted_sum::<
                                { TrackedDerivatives::Velocities.orders() },
                                { TrackedDerivatives::Velocities.nodes() },
                            >(weights, states, chunk),
                            TrackedDerivatives::Accelerations => weighted_sum::<
                                { TrackedDerivatives::Accelerations.orders() },
                                { TrackedDerivatives::Accelerations.nodes() },
                            >(weights, states, chunk),
                        };
                    }
                }
            },
        );
    }

    /// Solves for the states at a time (s), with `solver` or else with that of steps, and checks the step to them, of length `h` (s) if it is
    /// one in time.
    fn solve_at(
        &mut self,
        context: &BatchContext,
        t: f64,
        h: Option<f64>,
        solver: Option<&mut LaneSolver<'_>>,
    ) -> Rejections {
        let BatchStepper { registers, step_lanes, guesses, now, next, chunks, .. } = self;
        let of_steps = (&context.step_solver, step_lanes, false);
        let (solver, lanes, is_exact) =
            solver.map_or(of_steps, |solver| (solver.solver, &mut *solver.lanes, solver.is_exact));
        let [step_bounds, row_bounds] = &context.bounds;
        let (bounds, loose_bound) = if is_exact { (row_bounds, 0.0) } else { (step_bounds, NEARLY) };
        let chunks = *chunks;
        let batch = VariantBatch { times: [t; LANES], tears: guesses, loaded: registers, bounds, chunks, loose_bound };
        lanes.run(solver, context.program.parts(), &batch);
        let mut rejections = Rejections(ZERO);
        context.vectors.run(
            #[inline(always)]
            || {
                let (tracked, derivatives) = (&*context.tracked, context.derivatives);
                next.record(tracked, derivatives, context.pivot_scale, t, lanes);
                lanes.add_rejections(&mut rejections.0);
                check_step(tracked, derivatives, [now, next], h, lanes.first_corrections(), &mut rejections);
            },
        );
        rejections
    }

    /// Makes the next states the present ones.
    fn commit(&mut self) {
        self.before.rotate_right(1);
        std::mem::swap(&mut self.before[0], &mut self.now);
        std::mem::swap(&mut self.now, &mut self.next);
        self.node_count = (self.node_count + 1).min(MAX_NODES);
    }
}

/// Returns the weighted sum of the first `ORDERS` numbers of `NODES` states in a chunk of lanes. The operands are copied, for otherwise the
/// compiler does not vectorise.
#[inline(always)]
#[allow(clippy::inline_always)] // compiled for several vector instruction sets
fn weighted_sum<const ORDERS: usize, const NODES: usize>(
    weights: [[f64; 3]; MAX_NODES],
    states: [&[PerLane; 3]; MAX_NODES],
    chunk: usize,
) -> [f64; CHUNK] {
    let mut sums = [[0.0; CHUNK]; NODES];
    for (node, sum) in sums.iter_mut().enumerate() {
        let weighed = |order: usize| {
            let (values, weight) = (*states[node][order].part::<CHUNK>(chunk), weights[node][order]);
            values.map(|value| weight * value)
        };
        *sum = weighed(0);
        for order in 1..ORDERS {
            let term = weighed(order);
            for k in 0..CHUNK {
                sum[k] += term[k];
            }
        }
    }
    let mut total = sums[0];
    for sum in &sums[1..] {
        for k in 0..CHUNK {
            total[k] += sum[k];
        }
    }
    total
}
